# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panel of moments: computed by a button, shown to order 4, copied whole."""

import csv
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.session import memory
from body_moments.blender.session.stored import computed_moments
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale
from body_moments.core.verdict import MeasureError, finding

from tests.blender import batch_files as files
from tests.blender.moments import compute, settings
from tests.blender.objects import dent
from tests.command.running import box_moment
from tests.panels.drawing import Layout, labels

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def box():
    """1 x 2 x 3, about (1, 2, 3), turned by a quarter about z."""
    obj = files.add_box(center=(0, 0, 0), size=(1, 2, 3))
    obj.location, obj.rotation_euler.z = (1, 2, 3), np.pi / 2
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj


def drawn():
    layout = Layout()
    bpy.types.VIEW3D_PT_body_moments_orders.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


def rows():
    group = bpy.context.scene.body_moments
    text = computed_moments.as_csv(
        memory.moments[bpy.context.object],
        group.moments_of,
        group.moments_about,
        group.frame,
    )
    assert text.startswith("# ") and "\r" not in text
    _, *lines = text.splitlines()
    return {
        tuple(int(row[axis]) for axis in "pqr"): tuple(
            float(row[key]) for key in ("moment", "rounding", "float32")
        )
        for row in csv.DictReader(lines)
    }


def assert_box(found, size, center, tolerance=3e-7):
    """The rotation is stored in single precision."""
    for powers, (value, *_) in found.items():
        exact = box_moment(powers, center, size)
        scale = np.prod([(abs(c) + s / 2) ** n for c, s, n in zip(center, size, powers)]) * 6.0
        assert value == pytest.approx(exact, abs=tolerance * sum(powers) * scale + 1e-12)


def test_frame_point_and_weight_change_without_computing_again(box):
    compute(6)
    assert_box(rows(), (2, 1, 3), (1, 2, 3))
    settings(moments_about="CENTER")
    assert_box(rows(), (2, 1, 3), (0, 0, 0))
    settings(frame="OBJECT")
    assert_box(rows(), (1, 2, 3), (0, 0, 0))
    settings(moments_about="ORIGIN", moments_of="SURFACE")
    surface = rows()
    assert surface[0, 0, 0][0] == pytest.approx(22.0, rel=1e-6)
    assert surface[0, 0, 2][0] == pytest.approx(2 * 2 * 2.25 + (2 * 2 + 2 * 1) * 27 / 12, rel=1e-6)
    settings(moments_about="NORMALIZED", moments_of="VOLUME")
    assert rows()[0, 0, 0][0] == pytest.approx(1.0, rel=1e-12)
    assert rows()[0, 0, 2][0] == pytest.approx(6.0 * 9.0 / 12.0 / 6.0 ** (5 / 3), rel=1e-6)
    assert labels(drawn()).count("Order 2") == 1  # without a unit


def test_computed_moments_become_stale_on_change(box):

    def reason():
        bpy.context.view_layer.update()
        return staleness.stale_reason(box, bpy.context.scene, Kind.MOMENTS)

    compute()
    assert reason() is None
    box.location.x += 1.0
    assert reason() == Stale.TRANSFORM
    compute()
    box.body_moments.overlap = "UNION"
    assert reason() == Stale.SETTINGS
    compute()
    assert reason() is None
    dent(box, 0.5)
    assert reason() == Stale.GEOMETRY
    assert Stale.GEOMETRY in " ".join(labels(drawn()))
    compute()
    assert reason() is None


def test_flat_shell_has_sheet_and_outline_moments():
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    obj = bpy.context.object
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.25
    compute(2)
    found = memory.moments[obj]
    assert found.volume.total == pytest.approx(1.0, rel=1e-9)
    assert found.flat.moments.total == pytest.approx(4.0, rel=1e-9)
    assert found.not_flat is None


def test_overflowing_moments_are_refused(box, reported):
    box.scale = (1e12, 1e12, 1e12)
    bpy.context.view_layer.update()
    settings(moments_order=30)
    assert bpy.ops.object.body_moments_compute_moments() == {"CANCELLED"}
    assert reported.values("moments_overflow") == {"order": 30}
    box.scale, box.location = (1, 1, 1), (1e15, 0, 0)
    bpy.context.view_layer.update()
    compute(30)
    settings(moments_of="VOLUME", moments_about="ORIGIN", frame="WORLD")
    with pytest.raises(MeasureError) as refusal:
        rows()
    assert refusal.value.finding == finding("moments_overflow", order=30)
    settings(moments_about="CENTER")
    assert np.isfinite(list(rows().values())).all()


def test_moments_of_undone_edit_are_stale(box):
    bpy.ops.ed.undo_push(message="As it was")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(2, 2, 2))
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.ed.undo_push(message="Twice as large")
    size, name = bpy.context.object.dimensions.x, bpy.context.object.name
    compute(2)
    while bpy.data.objects[name].dimensions.x > 0.75 * size:
        assert bpy.ops.ed.undo() == {"FINISHED"}
    obj = bpy.data.objects[name]
    bpy.context.view_layer.update()
    assert memory.moments[obj].volume.total == pytest.approx(48.0)
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.MOMENTS) == Stale.GEOMETRY
