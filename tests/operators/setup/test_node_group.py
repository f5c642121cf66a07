# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group for geometry nodes finds the center that the add-on measures, at every frame,
without its handlers.
"""

import bpy
import numpy as np
import pytest

from tests.blender.objects import add, measured, mesh_body

pytestmark = pytest.mark.usefixtures("scene")
FLOAT32 = 2e-5  # of the size: what nodes lose


def center_shown(marker):
    """The middle of the marker's ball, in the world."""
    evaluated = marker.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.array([marker.matrix_world @ vertex.co for vertex in evaluated.data.vertices])
    return (points.min(axis=0) + points.max(axis=0)) / 2.0


def sizes(obj):
    return measured(obj).mass_properties.radii_of_gyration.max()


def test_node_marker_is_at_measured_center_in_every_frame():
    obj = add(
        mesh_body(), location=(10.0, -20.0, 30.0), rotation=(0.3, 0.2, 0.1), scale=(1.0, 2.0, -1.5)
    )
    array = obj.modifiers.new("Array", "ARRAY")
    array.relative_offset_displace = (1.3, 0.2, 0.0)
    obj.keyframe_insert("location", frame=1)
    obj.location.x = 40.0
    obj.keyframe_insert("location", frame=20)
    assert bpy.ops.object.body_moments_add_nodes() == {"FINISHED"}
    marker = bpy.data.objects["Body Center of Mass"]
    assert bpy.context.object == obj
    for frame in (1, 7, 20):
        bpy.context.scene.frame_set(frame)
        truth = measured(obj).mass_properties.center
        assert (
            np.abs(center_shown(marker) - truth).max()
            < FLOAT32 * sizes(obj) + 1e-6 * np.abs(truth).max()
        )
    array.count = 5
    truth = measured(obj).mass_properties.center
    assert (
        np.abs(center_shown(marker) - truth).max()
        < FLOAT32 * sizes(obj) + 1e-6 * np.abs(truth).max()
    )


def test_volume_and_mass_are_outputs():
    """Read by a node tree that puts both into a point's position."""
    obj = add(mesh_body(), location=(5.0, 0.0, 0.0))
    obj.body_moments.density = 10.0
    bpy.ops.object.body_moments_add_nodes()
    tree = bpy.data.objects["Body Center of Mass"].modifiers[0].node_group
    nodes = next(node for node in tree.nodes if node.type == "GROUP")
    place = next(node for node in tree.nodes if node.bl_idname == "GeometryNodeTransform")
    combined = tree.nodes.new("ShaderNodeCombineXYZ")
    tree.links.new(nodes.outputs["Volume"], combined.inputs[0])
    tree.links.new(nodes.outputs["Mass"], combined.inputs[1])
    tree.links.new(combined.outputs[0], place.inputs["Translation"])
    volume, mass, _ = center_shown(bpy.data.objects["Body Center of Mass"])
    assert abs(volume / measured(obj).volume - 1.0) < FLOAT32
    assert abs(mass / (10.0 * measured(obj).volume) - 1.0) < FLOAT32
