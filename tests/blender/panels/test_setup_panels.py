# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panels of assemblies, given parts, references and bones show what is stored, and why it no longer holds."""

from types import SimpleNamespace

import bpy
import pytest

from tests.blender.actions.assembly.test_assembly import assembly_of_boxes
from tests.blender.actions.rig.test_rig import character
from tests.blender.bodies.test_assembly import box, empty
from tests.blender.objects import only
from tests.blender.panels.test_panel import Layout, drawn, labels

pytestmark = pytest.mark.usefixtures("registered", "scene")


def panel(name):
    layout = Layout()
    getattr(bpy.types, name).draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


def test_an_assembly_shows_its_total_and_its_tree():
    root = assembly_of_boxes()
    box(root, (1, 1, 1), name="out").hide_render = True
    only(bpy.data.objects["b0"])
    bpy.ops.object.body_moments_measure_assembly()
    for record in (panel("COLLECTION_PT_body_moments"), drawn()):
        shown = labels(record)
        assert {"Robot", "Arm", "b0", "b1", "out", "88.7%", "11.3%"} <= set(shown)
        assert "Out of date" not in " ".join(shown)
    bpy.data.objects["b1"].location.x = 9.0
    bpy.context.view_layer.update()
    assert "Out of date: A member changed" in " ".join(labels(panel("COLLECTION_PT_body_moments")))
    rows = root.body_moments.rows
    rows["Arm"].is_open = False
    ui_list = SimpleNamespace(filter_name="", bitflag_filter_item=1)
    flags, _ = bpy.types.BODY_MOMENTS_UL_assembly.filter_items(ui_list, bpy.context, root.body_moments, "rows")
    assert [row.name for row, flag in zip(rows, flags) if not flag] == ["b1"]


def test_an_empty_shows_its_point_mass():
    only(empty(bpy.context.scene.collection, "Point", mass=2.0))
    assert ("prop", "use_center") in drawn() and ("prop", "given_center") not in drawn()
    bpy.context.object.body_moments.use_center = True
    assert ("prop", "given_center") in drawn()


def test_the_inertia_about_a_reference_is_shown_or_why_not():
    only(box(bpy.context.scene.collection, (1, 2, 4), (1, 0, 0)))
    bpy.ops.object.body_moments_measure()
    settings = bpy.context.scene.body_moments_reference
    settings.about = "AXIS"
    assert "About Axis" in labels(panel("VIEW3D_PT_body_moments_reference"))
    settings.second = settings.first
    assert "too near to each other" in " ".join(labels(panel("VIEW3D_PT_body_moments_reference")))


def test_bones_show_their_parts():
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    assert {"head", "arm.L"} <= set(labels(drawn()))
    armature.data.bones.active = armature.data.bones["head"]
    assert bpy.types.BONE_PT_body_moments.poll(bpy.context)
    assert "Center of Mass (Rest Frame)" in labels(panel("BONE_PT_body_moments"))
    armature.pose.bones["head"].body_moments.mass_from = "DENSITY"
    assert ("prop", "density") in panel("BONE_PT_body_moments")
