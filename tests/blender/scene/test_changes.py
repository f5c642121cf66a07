# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many objects are changed with few evaluations of the scene, and none is judged by what happens to
another.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.scene import changes as side_by_side

from tests.blender.objects import add, mesh_body, only, place, seen

pytestmark = pytest.mark.usefixtures("scene")
SNAPS = ("origin_to_center", "axes_to_principal")


def run(name, **options):
    return getattr(bpy.ops.object, "body_moments_" + name)(**options)


def bodies(count):
    return [
        add(
            mesh_body(),
            "Body {:d}".format(i),
            (5 * i, i, 0),
            (0.1 * i, 0.2, 0),
            (1, 1 + 0.1 * i, 1),
        )
        for i in range(count)
    ]


@pytest.fixture
def evaluations():
    """How often the scene was evaluated with something to evaluate."""
    found = []
    note = lambda scene, depsgraph: found.append(1)  # noqa: E731
    bpy.app.handlers.depsgraph_update_post.append(note)
    yield found
    bpy.app.handlers.depsgraph_update_post.remove(note)


@pytest.mark.parametrize("collected", [False, True])
@pytest.mark.parametrize(
    "name, options",
    [*((name, {}) for name in SNAPS), ("add_empty", {}), ("set_rigid_body_mass", {"add": True})],
)
def test_evaluations_do_not_grow_with_object_count(name, options, collected, evaluations):
    taken = []
    for count in (3, 12):
        objects = bodies(count)
        if collected:  # as in every file that Blender begins with
            collect(objects)
        only(*objects)
        evaluations.clear()
        assert run(name, **options) == {"FINISHED"}
        taken.append(len(evaluations))
    assert taken[1] <= taken[0] + 1 < 25


def collect(objects):
    """Put objects into a collection of the scene's."""
    collection = bpy.data.collections.new("Members")
    bpy.context.scene.collection.children.link(collection)
    for obj in objects:
        collection.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    return collection


def wrap_around(obj, other):
    """Have the shape of an object depend on where another's is."""
    modifier = obj.modifiers.new("Shrinkwrap", "SHRINKWRAP")
    modifier.target, modifier.offset = other, 3.0
    bpy.context.view_layer.update()


@pytest.mark.parametrize("name", SNAPS)
def test_dependent_objects_are_reframed_and_stay_in_place(name):
    objects = first, second, third, last = bodies(4)
    wrap_around(second, first)
    wrap_around(third, first)
    last.parent, last.matrix_parent_inverse = second, second.matrix_world.inverted()
    bpy.context.view_layer.update()
    before, were = [seen(obj) for obj in objects], [place(obj) for obj in objects]
    only(last, third, second, first)
    assert run(name) == {"FINISHED"}
    for obj, points, was in zip(objects, before, were):
        assert np.abs(seen(obj) - points).max() < 2e-5 and np.abs(place(obj) - was).max() > 0.1


def shown_by_nodes(collection):
    """A node group that joins what a collection shows, moved from its own place, to the
    geometry.
    """
    tree = bpy.data.node_groups.new("Show", "GeometryNodeTree")
    for side in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=side, socket_type="NodeSocketGeometry")
    start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    info, join = (
        tree.nodes.new("GeometryNodeCollectionInfo"),
        tree.nodes.new("GeometryNodeJoinGeometry"),
    )
    info.transform_space = "RELATIVE"
    info.inputs["Collection"].default_value = collection
    tree.links.new(start.outputs[0], join.inputs[0])
    tree.links.new(info.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    return tree


def test_object_showing_others_is_changed_after_them():
    members = bodies(2)
    collection = collect(members)
    shower = add(mesh_body(), "Shower", (0, 9, 0))
    shower.modifiers.new("Show", "NODES").node_group = shown_by_nodes(collection)
    bpy.context.view_layer.update()
    touched = side_by_side.dependents([*members, shower])
    assert shower in touched[members[0]] and members[0] not in touched[shower]
    assert side_by_side.independent_rounds(touched.items()) == [
        [members[0]],
        [members[1]],
        [shower],
    ]


def beveled_by(obj):
    """A curve that has another one as its profile."""
    curve = bpy.data.curves.new("Rail", "CURVE")
    curve.dimensions, curve.bevel_mode, curve.bevel_object = "3D", "OBJECT", obj
    spline = curve.splines.new("POLY")
    spline.points.add(1)
    spline.points[1].co = (0, 0, 4, 1)
    return add(curve, "Rail", (0, 7, 0))


def keyed_by(obj):
    """A mesh of which a driver blends in a shape key by where another object is."""
    keyed = add(mesh_body(), "Keyed", (0, 9, 0))
    keyed.shape_key_add(name="Basis")
    keyed.shape_key_add(name="Raised").data[0].co.z += 2.0
    driver = keyed.data.shape_keys.key_blocks["Raised"].driver_add("value").driver
    driver.type = "SUM"
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].transform_type = obj, "LOC_X"
    return keyed


def scattering(obj):
    """A mesh that shows the members of another object's collection at its own place, wherever they
    are.
    """
    shower = add(mesh_body(), "Shower", (0, 9, 0))
    tree = shown_by_nodes(collect([obj]))
    info = next(node for node in tree.nodes if node.bl_idname == "GeometryNodeCollectionInfo")
    info.transform_space = "ORIGINAL"
    info.inputs["Separate Children"].default_value = info.inputs["Reset Children"].default_value = (
        True
    )
    shower.modifiers.new("Show", "NODES").node_group = tree
    return shower


@pytest.mark.parametrize("made_with", [beveled_by, keyed_by, scattering])
def test_object_shaping_another_by_its_data_is_refused(made_with, reported):
    if made_with is beveled_by:
        curve = bpy.data.curves.new("Profile", "CURVE")
        curve.dimensions = "2D"
        spline = curve.splines.new("POLY")
        spline.points.add(2)
        spline.points.foreach_set("co", [1, 1, 0, 1, 2, 1, 0, 1, 1, 2, 0, 1])
        spline.use_cyclic_u = True
        obj = add(curve, "Profile", (0, 0, 0))
        obj.body_moments.kind = "SHELL"
    else:
        obj = add(mesh_body(), "Body", (0.2, 0, 0))
    other = made_with(obj)
    bpy.context.view_layer.update()
    before, was = seen(other), place(obj)
    assert other in side_by_side.dependents([obj])[obj]
    only(obj)
    assert run("origin_to_center") == {"CANCELLED"}
    code = "dependent_shape_changes" if other.modifiers else "dependent_shape_changes"
    assert reported.values(code) == {"object": other.name}
    assert np.abs(seen(other) - before).max() < 1e-6 and np.abs(place(obj) - was).max() == 0.0


def test_refused_object_leaves_others_to_be_changed(reported):
    objects = bodies(4)
    objects[1].modifiers.new("Bend", "SIMPLE_DEFORM").angle = 1.0
    objects[2].lock_location[0] = True
    bpy.context.view_layer.update()
    before, matrices = [seen(obj) for obj in objects], [place(obj) for obj in objects]
    data = [obj.data for obj in objects]
    only(*objects)
    assert run("origin_to_center") == {"FINISHED"}
    assert reported.codes.count("failure") == 2
    failures = {
        finding.values["object"]: finding.values["cause"]
        for finding in reported
        if finding.code == "failure"
    }
    assert failures["Body 1"] == {
        "code": "modifiers_change_shape",
        "values": {"modifiers": ["Bend"]},
    }
    assert failures["Body 2"] == {"code": "channel_locked", "values": {"channel": "location"}}
    moved = [np.abs(place(obj) - matrix).max() > 0.1 for obj, matrix in zip(objects, matrices)]
    assert moved == [True, False, False, True]
    assert [obj.data for obj in objects] == data and len(bpy.data.meshes) == 4
    for obj, points in zip(objects, before):
        assert np.abs(seen(obj) - points).max() < 1e-5


def test_followed_empty_is_placed_before_its_follower():
    leader, follower = bodies(2)
    only(leader)
    run("add_empty")
    empty = next(obj for obj in bpy.data.objects if obj.type == "EMPTY")
    constraint = follower.constraints.new("COPY_LOCATION")
    constraint.target = empty
    leader.data.vertices[0].co.x -= 3.0
    leader.data.update()
    bpy.context.view_layer.update()
    only(follower, leader)
    assert run("add_empty") == {"FINISHED"}
    own = next(
        obj
        for obj in bpy.data.objects
        if obj.type == "EMPTY" and obj.get("principal_frame_of") == follower
    )
    kept = place(own)
    run("add_empty")
    assert np.abs(place(own) - kept).max() < 1e-6


def test_shared_mesh_in_shown_collection_is_reframed():
    first = add(mesh_body(), "First", (1, 2, 0))
    other, third = add(mesh_body(), "Other", (9, 0, 0)), add(first.data, "Third", (4, 5, 6))
    shower = add(mesh_body(), "Shower", (0, 20, 0))
    shower.modifiers.new("Show", "NODES").node_group = shown_by_nodes(
        collect([first, other, third])
    )
    bpy.context.view_layer.update()
    only(first)
    assert run("origin_to_center") == {"FINISHED"}
    assert first.data != third.data
