# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of high order from the command line: instances, repaired surfaces, unions, shells and
frames, against the closed form of the box.
"""

import itertools
import math

import pytest

bpy = pytest.importorskip("bpy")
import bmesh
from body_moments.core.verdict import finding
from mathutils import Matrix

from tests.blender import batch_files as files
from tests.blender.batch_files import document, measured, sentence
from tests.close import close
from tests.command.running import box_moment

pytestmark = pytest.mark.usefixtures("scene")


def moments_of(*words):
    """Volume and surface moments by exponents."""
    found = measured(*words, "--surface-moments")["moments"]
    return tuple(
        {tuple(map(int, key.split(","))): value for key, value in found[weight].items()}
        for weight in ("volume", "surface")
    )


def box_surface_moment(powers, low, high):
    """Return a surface moment of the six sides of a box."""

    def one(i, n):
        return (high[i] ** (n + 1) - low[i] ** (n + 1)) / (n + 1)

    return sum(
        (low[i] ** powers[i] + high[i] ** powers[i])
        * math.prod(one(j, powers[j]) for j in range(3) if j != i)
        for i in range(3)
    )


def test_high_order_moments_of_turned_boxes_are_exact():
    box = files.add_box(center=(0, 0, 0), size=(1, 1, 1))
    box.location, box.scale = (0.5, 0.25, 0.0), (1, 2, -3)  # mirrored, unevenly scaled
    low, high = (0.0, -0.75, -1.5), (1.0, 1.25, 1.5)
    volume, surface = moments_of("--order", "12")
    assert len(volume) == len(surface) == 455
    for powers, value in volume.items():
        exact = box_moment(powers, (0.5, 0.25, 0.0), (1, 2, 3))
        assert value == pytest.approx(exact, rel=1e-12, abs=1e-13)
    for powers, value in surface.items():
        assert value == pytest.approx(box_surface_moment(powers, low, high), rel=1e-12, abs=1e-12)
    own, _ = moments_of("--order", "12", "--frame", "object")
    assert own[0, 4, 6] == pytest.approx(box_moment((0, 4, 6), (0, 0, 0), (1, 2, 3)), rel=1e-12)


@pytest.mark.parametrize("kind", ["solid", "shell"])
def test_a_flat_part_adds_its_area_to_every_order(kind):
    box = files.add_box(center=(0, 0, 0), size=(2, 2, 2))
    bm = bmesh.new()
    bm.from_mesh(box.data)
    *rim, middle = (
        bm.verts.new(place) for place in ((3, -1, 0), (4, -1, 0), (4, 1, 0), (3, 1, 0), (3.5, 0, 0))
    )
    bm.faces.new(rim)
    for one, other in zip(rim, rim[1:] + rim[:1]):  # the other side of the sheet
        bm.faces.new((other, one, middle))
    bm.to_mesh(box.data)
    bm.free()
    volume, surface = moments_of("--kind", kind, "--thickness", "1", "--order", "4")
    assert measured("--kind", kind, "--thickness", "1")["area"] == pytest.approx(28.0, rel=1e-13)
    assert surface[0, 0, 0] == pytest.approx(28.0, rel=1e-13)
    assert surface[1, 0, 0] == pytest.approx(2 * 2 * 3.5, rel=1e-13)
    assert surface[4, 0, 0] == pytest.approx(
        4 * 4 / 5 + 2 * 4 + 2 * 2 * (4**5 - 3**5) / 5, rel=1e-13
    )
    assert close(volume[0, 0, 0], 8.0 if kind == "solid" else 28.0, rel=1e-13)


def test_high_orders_of_united_shells_count_overlap_once():
    box = files.add_box(center=(0, 0, 0), size=(1, 1, 1))
    other = box.data.copy()
    other.transform(Matrix.Translation((0.5, 0, 0)))
    bm = bmesh.new()
    bm.from_mesh(box.data)
    bm.from_mesh(other)
    bm.to_mesh(box.data)
    bm.free()
    volume, surface = moments_of("--order", "5", "--overlap", "union")
    center, size = (0.25, 0, 0), (1.5, 1, 1)
    for powers in volume:
        assert volume[powers] == pytest.approx(box_moment(powers, center, size), rel=1e-6, abs=1e-6)
        exact = box_surface_moment(powers, (-0.5, -0.5, -0.5), (1.0, 0.5, 0.5))
        assert surface[powers] == pytest.approx(exact, rel=1e-6, abs=1e-6)
    each, _ = moments_of("--order", "5")
    assert each[0, 0, 0] == pytest.approx(2.0)


def test_a_thick_wall_has_moments_to_any_order():
    box = files.add_box(size=(1, 1, 1), center=(0, 0, 0))
    box.body_moments.wall = "INWARD"
    entry = measured(
        "--order",
        "20",
        "--kind",
        "shell",
        "--thickness",
        "0.1",
        "--density",
        "1000",
        "--surface-moments",
    )
    moments = entry["moments"]
    for p, q, r in itertools.product(range(0, 21, 4), repeat=3):
        if p + q + r <= 20:
            key, powers = "{},{},{}".format(p, q, r), (p, q, r)
            exact = math.prod(2 * 0.5 ** (n + 1) / (n + 1) for n in powers)
            exact -= math.prod(2 * 0.4 ** (n + 1) / (n + 1) for n in powers)
            bound = moments["error"]["volume"][key]
            # A thickness of 0.1 is no float32 number, and the box's size is one.
            assert (
                abs(moments["volume"][key] - exact) <= bound + 1e-13 * exact
                and bound < 1e-9 * exact
            )
            assert close(moments["mass"][key], 1000.0 * moments["volume"][key], rel=1e-14)
    assert close(moments["surface"]["0,0,0"], 6.0, rel=1e-13)


def test_overflowing_moments_are_an_error_beside_the_mass():
    files.add_box().scale = (1e35, 1e35, 1e35)
    bpy.context.view_layer.update()
    (plain,) = document()["objects"]
    cause = finding("moments_overflow", order=8).as_record()
    for words in ((), ("--surface-moments",)):
        found = document("--order", "8", *words)
        reason = sentence("part_unavailable", part="moments of this order", cause=cause)
        assert found["errors"] == [{"name": files.BOX_NAME, "reason": reason}]
        assert found["objects"] == [plain] and "moments" not in plain and found["status"] == "error"
    assert "moments" in document("--order", "4")["objects"][0]
