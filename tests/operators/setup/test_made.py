# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups of other files and versions, and rigid bodies of which some cannot be what was asked
for.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import node_group
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Stale

from tests.blender.objects import add, dent, mesh_body, only, seen, strip_mesh

pytestmark = pytest.mark.usefixtures("scene")


def test_linked_or_older_node_group_is_not_reused(tmp_path):
    first = node_group.center_of_mass_group()
    assert node_group.center_of_mass_group() == first
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {first})
    bpy.data.node_groups.remove(first)
    with bpy.data.libraries.load(path, link=True) as (found, names):
        names.node_groups = [*found.node_groups]
    (linked,) = names.node_groups
    assert linked[node_group.KEY] == node_group.VERSION
    plain = bpy.data.node_groups.new("Plain", "GeometryNodeTree")
    older = bpy.data.node_groups.new("Older", "GeometryNodeTree")
    older[node_group.KEY] = node_group.VERSION - 1
    made = node_group.center_of_mass_group()
    assert (
        made.library is None
        and made not in (plain, older)
        and made[node_group.KEY] == node_group.VERSION
    )
    assert node_group.center_of_mass_group() == made


@pytest.mark.parametrize("frame", ["AXES", "ORIGIN", "KEEP"])
def test_rigid_body_keeps_material_results_current(frame):
    """Blender says that its geometry has changed, and there is no digest of what the density
    was.
    """
    obj = add(mesh_body(), "Body", (1, 2, 3), (0.3, 0.2, 0.1))
    obj.data.materials.append(bpy.data.materials.new("Steel"))
    obj.body_moments.density_from = "MATERIALS"
    bpy.ops.object.body_moments_measure()
    for move in (1.0, -1.0):  # there and back
        dent(obj, move)
        assert staleness.stale_reason(obj, bpy.context.scene) == Stale.GEOMETRY
    assert bpy.ops.object.body_moments_rigid_bodies(frame=frame) == {"FINISHED"}
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene) is None


def test_of_a_compound_the_member_that_is_refused_is_named(reported):
    root = add(mesh_body(), "Root")
    for name, data, code in (
        ("Text", bpy.data.curves.new("Text", "FONT"), "rigid_body_unfit"),
        ("Strip", strip_mesh(), "open_object"),
    ):
        member = add(data, name)
        member.parent = root
        only(root, member)
        reported.clear()
        assert (
            bpy.ops.object.body_moments_rigid_bodies() == {"CANCELLED"} and root.rigid_body is None
        )
        assert reported.values("failure")["object"] == "Root" and reported[-1].values[
            "sources"
        ] == [name]
        assert reported.codes[-1] == code
        bpy.data.objects.remove(member)


def test_recalculated_faces_keep_sculpted_shape():
    """Multires keeps its moves by the corners of faces, whose order is the other way round then."""
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    obj.data.flip_normals()
    multires = obj.modifiers.new("Multires", "MULTIRES")
    bpy.ops.object.multires_subdivide(modifier=multires.name, mode="SIMPLE")
    shape = bpy.data.meshes.new_from_object(
        obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    )
    for vertex in shape.vertices:
        x, y, z = vertex.co
        vertex.co = (x + 0.2 * y * y + 0.1 * z, y + 0.15 * z * x, z + 0.1 * x + 0.05 * y)
    other = add(shape, "Shape", select=False)
    only(obj, other)
    assert bpy.ops.object.multires_reshape(modifier=multires.name) == {"FINISHED"}
    before = sorted(map(tuple, np.round(seen(obj), 4)))
    assert len(before) == 26
    multires.show_viewport = False
    only(obj)
    assert bpy.ops.object.body_moments_remedy(remedy="OUTSIDE") == {"FINISHED"}
    multires.show_viewport = True
    bpy.context.view_layer.update()
    assert np.abs(np.array(sorted(map(tuple, np.round(seen(obj), 4)))) - before).max() < 3e-4
