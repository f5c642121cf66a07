# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn of a measured object stands where the object stands, in Blender's units, and says
how far it holds.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.displayed import Verdict, drawn, drawn_bone
from body_moments.blender.session.tracking.stamps import Stale
from mathutils import Matrix

from tests.blender.objects import add, dent, measure, measured, mesh_body, strip_mesh
from tests.close import close
from tests.operators.characters import character

pytestmark = pytest.mark.usefixtures("scene")


def assert_shown(obj):
    """What is shown is what measuring again gives."""
    shown, body = drawn(obj, bpy.context.scene).world, measured(obj).mass_properties
    reach = np.linalg.norm(body.radii_of_gyration) + np.linalg.norm(body.center)
    assert np.linalg.norm(shown.center - body.center) <= 1e-6 * reach
    assert close(shown.gyration, body.radii_of_gyration, 1e-6)
    assert close(np.abs((np.transpose(shown.axes) * body.principal.axes).sum(axis=0)), 1.0, 1e-5)
    assert close(shown.mass, body.mass, 1e-6)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_moved_object_is_drawn_in_place_at_once(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    obj = add(mesh_body(), location=(3, -2, 5), rotation=(0.3, -0.7, 2.1), scale=(1, 2, -0.7))
    assert drawn(obj, bpy.context.scene) is None
    measure(obj)
    assert_shown(obj)
    assert drawn(obj, bpy.context.scene) is drawn(obj, bpy.context.scene)
    obj.matrix_world = (
        Matrix.Translation((-40, 7, 1)) @ Matrix.Rotation(2.2, 4, (1, 2, -1)) @ obj.matrix_world
    )
    bpy.context.view_layer.update()
    assert_shown(obj)


def test_shown_verdict_follows_repair_doubt_and_edit():
    exact, open_strip, flipped = (
        add(mesh_body()),
        add(strip_mesh(), "Strip"),
        add(mesh_body("Flipped"), "Flipped"),
    )
    flipped.data.polygons[3].flip()
    flipped.data.update()
    measure(exact, open_strip, flipped)
    assert [drawn(obj, bpy.context.scene).verdict for obj in (exact, open_strip, flipped)] == [
        Verdict.EXACT,
        Verdict.DOUBTFUL,
        Verdict.REPAIRED,
    ]
    dent(exact, -1.0)
    shown = drawn(exact, bpy.context.scene)
    assert shown.verdict == Verdict.OUT_OF_DATE and shown.reason == Stale.GEOMETRY


def test_restored_scale_makes_results_current():
    obj = add(mesh_body(), location=(1, 2, 3))
    measure(obj)
    for scale, verdict in (
        (2.0, Verdict.OUT_OF_DATE),
        (1.0, Verdict.EXACT),
        (3.0, Verdict.OUT_OF_DATE),
        (1.0, Verdict.EXACT),
    ):
        obj.scale.x = scale
        bpy.context.view_layer.update()
        assert drawn(obj, bpy.context.scene).verdict == verdict
        obj.location.x += 1.0
        bpy.context.view_layer.update()
        assert drawn(obj, bpy.context.scene).verdict == verdict
    assert_shown(obj)


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_bone_part_is_drawn_at_its_bone_in_any_unit(unit, scene):
    scene.unit_settings.scale_length = unit
    armature, _ = character()
    assert drawn_bone(armature.pose.bones["arm.L"], scene) is None
    armature.location, armature.rotation_euler = (3, 2, 1), (0.1, 0.2, 0.3)
    bpy.ops.object.body_moments_measure_bones()
    bpy.context.view_layer.update()
    bone = armature.pose.bones["arm.L"]
    displayed = drawn_bone(bone, scene)
    shown, place = displayed.world, np.array(armature.matrix_world @ bone.matrix, np.float64)
    own = np.array(bone["body_center_of_mass"].to_list()) / unit
    assert np.abs(shown.center - unit * (place[:3, :3] @ own + place[:3, 3])).max() < 1e-5
    moments = np.array(bone["body_principal_moments"].to_list())
    assert close(shown.mass, bone["body_mass"], 1e-12) and displayed.verdict == Verdict.EXACT
    assert close(shown.mass * np.square(shown.gyration), moments, 1e-9)
    assert np.abs(np.matmul(shown.axes, np.transpose(shown.axes)) - np.eye(3)).max() < 1e-6
    armature.data.bones["arm.L"].use_deform = False
    bpy.context.view_layer.update()
    assert drawn_bone(armature.pose.bones["arm.L"], scene).verdict == Verdict.OUT_OF_DATE
