# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the redo panel can change after the fact: by default nothing, else that alone."""

import bpy
import pytest
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale
from body_moments.blender.write import section

from tests.blender.objects import add, after, dent, mesh_body
from tests.close import close
from tests.operators.overlapping_boxes import boxes

pytestmark = pytest.mark.usefixtures("scene")


def test_measure_options_change_only_their_settings():
    obj = add(boxes(2.0, 1.0))
    before = {
        name: getattr(obj.body_moments, name) for name in ("kind", "overlap", "density", "material")
    }
    bpy.ops.object.body_moments_measure()
    assert {name: getattr(obj.body_moments, name) for name in before} == before
    assert not obj.body_moments.is_property_set("density")
    bpy.ops.object.body_moments_measure(material="Copper", overlap="UNION")
    assert obj.body_moments.material == "Copper" and close(obj["body_mass"], 8.0 * 8960.0, rel=1e-6)
    bpy.ops.object.body_moments_measure(kind="SHELL")
    assert obj["body_method"] == "shell" and obj.body_moments.material == "Copper"


@pytest.mark.parametrize("kinds", [{"MASS"}, {"SECTION"}, {"SYMMETRY"}, {"MASS", "SECTION"}])
def test_cleared_kinds_leave_other_results_current(kinds):
    bpy.ops.mesh.primitive_plane_add()
    obj = bpy.context.object
    obj.body_moments.kind = "SHELL"
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_measure_section()
    bpy.ops.object.body_moments_find_symmetry()
    bpy.context.view_layer.update()
    assert bpy.ops.object.body_moments_clear(kinds=kinds) == {"FINISHED"}
    bpy.context.view_layer.update()
    kept = {"MASS": "body_mass" in obj, "SECTION": section.KEY in obj}
    kept["SYMMETRY"] = obj.is_property_set("body_moments_symmetry")
    assert {kind for kind in kept if not kept[kind]} == kinds
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    assert (
        staleness.stale_reason(obj, bpy.context.scene, Kind.SECTION) is None or not kept["SECTION"]
    )
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
    assert bpy.ops.object.body_moments_clear(kinds=kinds) == {"CANCELLED"}
    assert bpy.ops.object.body_moments_clear() == {"FINISHED"} and "body_mass" not in obj


def test_edit_before_clearing_makes_symmetry_stale():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_find_symmetry()
    dent(obj, 0.5)
    assert bpy.ops.object.body_moments_clear(kinds={"MASS"}) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY


def test_undo_of_clearing_stale_results_keeps_them_stale():
    obj = add(mesh_body())
    bpy.ops.object.body_moments_measure()
    bpy.ops.ed.undo_push(message="measured")
    dent(obj, 0.5)
    bpy.ops.ed.undo_push(message="edited")
    assert bpy.ops.object.body_moments_clear("EXEC_DEFAULT", True) == {"FINISHED"}
    obj = after(bpy.ops.ed.undo)
    assert "body_mass" in obj and staleness.stale_reason(obj, bpy.context.scene) == Stale.GEOMETRY
