# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances are read as one surface with many places, exactly those that Blender draws."""

import bpy
import numpy as np
import pytest
from body_moments.blender.read.objects import read_object
from body_moments.blender.read.visibility import measurable_objects

from tests.blender.findings import refused, said
from tests.blender.read_bodies import (
    collection,
    cube,
    depsgraph,
    drag_a_corner,
    join,
    layer_of,
    link,
    mesh,
    node,
    nodes,
    places,
    shown,
)

pytestmark = pytest.mark.usefixtures("bare_scene")


def placed(obj, location=(1.0, 2.0, 3.0), turn=(0.3, 0.4, 0.5), scale=(1.0, 2.0, -0.5)):
    obj.location, obj.rotation_euler, obj.scale = location, turn, scale
    return obj


def check(obj, count):
    """The reading has `count` places, each where Blender draws it."""
    reading = read_object(obj, depsgraph())
    mine, drawn = places(reading), shown(obj)
    assert mine.shape == drawn.shape == (count, 17)
    assert np.array_equal(mine[:, 0], drawn[:, 0])
    # Blender multiplies in float32.
    assert np.allclose(mine[:, 1:], drawn[:, 1:], rtol=0.0, atol=2e-6 * np.abs(drawn).max())
    return reading


def empty(name, instances=None):
    obj = link(name)
    if instances is not None:
        obj.instance_type = "COLLECTION"
        obj.instance_collection = instances
    return obj


def grid(tree, side):
    return node(tree, "GeometryNodeMeshGrid", {"Vertices X": side, "Vertices Y": side}).outputs[
        "Mesh"
    ]


def on_points(tree, points, instance, scale=(1.0, 1.0, 1.0)):
    turned = {"Rotation": (0.1, 0.2, 0.3), "Scale": scale}
    made = node(tree, "GeometryNodeInstanceOnPoints", turned, Points=points, Instance=instance)
    return made.outputs[0]


def test_geometry_node_instances_are_one_part():
    host = placed(cube("Host"))
    nodes(host, lambda tree, source: on_points(tree, grid(tree, 5), source, (1.0, 2.0, 3.0)))
    reading = check(host, 25)
    assert [len(part.matrices) for part in reading.parts] == [25]


def test_instances_of_instances_are_flattened():
    host = placed(cube("Host"))

    def build(tree, source):
        inner = join(tree, on_points(tree, grid(tree, 3), source, (0.5, 0.5, 0.5)), grid(tree, 2))
        return on_points(tree, grid(tree, 4), inner)

    nodes(host, build)
    reading = check(host, 16 * 10)
    assert sorted(len(part.matrices) for part in reading.parts) == [16, 144]


def test_instances_may_be_objects_collections_and_geometry():
    source = placed(cube("Source"), (5.0, 0.0, 0.0))
    members = collection("Members")
    placed(cube("First", members), (0.0, 1.0, 0.0))
    link("Second", source.data, members).location = (0.0, 0.0, 4.0)
    subdivided = cube("Subdivided", members)
    subdivided.modifiers.new("Subdivision", "SUBSURF").levels = 2
    members.instance_offset = (1.0, 0.5, 0.25)
    host = placed(cube("Host"))

    def build(tree, _source):
        one = node(tree, "GeometryNodeObjectInfo", {"Object": source, "As Instance": True}).outputs[
            "Geometry"
        ]
        real = node(
            tree, "GeometryNodeObjectInfo", {"Object": source, "As Instance": False}
        ).outputs["Geometry"]
        whole = node(tree, "GeometryNodeCollectionInfo", {"Collection": members}).outputs[0]
        each = node(
            tree, "GeometryNodeCollectionInfo", {"Collection": members, "Separate Children": True}
        ).outputs[0]
        moved = node(
            tree, "GeometryNodeTransform", {"Translation": (3.0, 3.0, 3.0)}, Geometry=whole
        ).outputs[0]
        return on_points(tree, grid(tree, 2), join(tree, one, real, whole, each, moved))

    nodes(host, build)
    check(host, 4 * (1 + 1 + 3 + 3 + 3))


def test_objects_that_share_a_mesh_share_a_part():
    members = collection("Members")
    first = cube("First", members)
    for index in range(9):
        link("Copy", first.data, members).location = (0.0, 0.0, 3.0 * index)
    cube("Other", members)
    first.data.materials.append(None)
    first.material_slots[0].link = "OBJECT"  # of which nobody has asked
    reading = check(empty("Instancer", members), 11)
    assert sorted(len(part.matrices) for part in reading.parts) == [1, 10]


def test_collection_instance_has_visible_members():
    members, inner, off = (
        collection("Members"),
        collection("Inner", False),
        collection("Off", False),
    )
    members.children.link(off)
    members.children.link(inner)
    placed(cube("Shown", members))
    cube("Inside", inner).location = (4.0, 0.0, 0.0)
    cube("Disabled", members).hide_viewport = True
    cube("In Disabled", off)
    both = cube("Both", off)
    inner.objects.link(both)
    members.objects.link(both)
    off.hide_viewport = True
    members.instance_offset = (0.0, 1.0, 0.0)
    bpy.context.scene.collection.children.unlink(members)
    check(placed(empty("Instancer", members)), 3)


def test_instances_nest_as_deep_as_blender_shows_them():
    inner = collection("0", False)
    cube("0", inner)
    for level in range(1, 12):
        outer = collection(str(level), False)
        cube(str(level), outer).location.x = 3.0
        link("Inner", None, outer).instance_type = "COLLECTION"
        outer.objects[-1].instance_collection, outer.objects[-1].location.y = inner, 3.0
        inner = outer
    check(empty("Instancer", inner), 7)


def test_self_instancing_collection_is_read_once():
    members = collection("Members")
    cube("Body", members)
    host = cube("Host", members)

    def build(tree, source):
        return join(
            tree,
            source,
            node(tree, "GeometryNodeCollectionInfo", {"Collection": members}).outputs[0],
        )

    nodes(host, build)
    check(host, 1)


@pytest.mark.parametrize("kind", ["VERTS", "FACES"])
def test_instances_on_vertices_and_faces_are_the_parents_record(kind):
    parent = placed(cube("Parent"), scale=(2.0, 2.0, 2.0))
    parent.instance_type = kind
    parent.use_instance_vertices_rotation = parent.use_instance_faces_scale = True
    child = placed(cube("Child"), (0.5, 0.0, 0.0), scale=(0.2, 0.3, 0.4))
    child.parent = parent
    child.modifiers.new("Subdivision", "SUBSURF").levels = 2
    count = 8 if kind == "VERTS" else 6
    check(parent, count + 1)
    parent.show_instancer_for_viewport = False
    reading = check(parent, count)
    assert reading.parts[0].surface.quads.shape == (96, 4)
    assert measurable_objects(bpy.context.view_layer) == [parent]
    assert said(read_object(child, depsgraph()))["instanced_by_parent"] == {"parent": "Parent"}


def test_a_curve_instanced_on_vertices_has_its_bevel():
    parent = cube("Parent")
    parent.instance_type = "VERTS"
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.2)
    bpy.context.object.data.bevel_depth = 0.05
    bpy.context.object.parent = parent
    check(parent, 9)


def test_instances_on_vertices_inside_a_collection_instance():
    members = collection("Members", False)
    cube("First", members).location.x = -9.0
    parent = placed(cube("Parent", members))
    parent.instance_type = "VERTS"
    cube("Child", members).parent = parent
    instancer = placed(empty("Instancer", members))
    check(instancer, 10)
    parent.show_instancer_for_viewport = False
    check(instancer, 9)


def test_self_hiding_host_may_instance_vertex_instancer():
    parent = placed(cube("Parent"))
    parent.instance_type = "VERTS"
    cube("Child").parent = parent
    host = cube("Host")

    def build(tree, source):
        one = node(tree, "GeometryNodeObjectInfo", {"Object": parent, "As Instance": True}).outputs[
            "Geometry"
        ]
        return join(tree, source, one)

    nodes(host, build)
    count = len(shown(host))
    host.show_instancer_for_viewport = False
    check(host, count - 1)


def test_a_hidden_instancer_on_vertices_is_refused_not_halved():
    parent = cube("Parent")
    parent.instance_type = "VERTS"
    cube("Child").parent = parent
    other = bpy.context.scene.view_layers.new("Other")
    parent.hide_set(True)
    with refused("not_shown", "Parent"):
        read_object(parent, depsgraph())
    other.update()
    assert read_object(parent, other.depsgraph).instance_count == 9


def test_particles_drawn_as_objects_are_the_emitters_record():
    source = cube("Source")
    emitter = placed(link("Emitter", mesh("Emitter")))
    settings = emitter.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count = "HAIR", 12
    settings.render_type, settings.instance_object = "OBJECT", source
    check(emitter, 13)
    emitter.show_instancer_for_viewport = False
    check(emitter, 12)
    settings.render_type = "PATH"  # which hides it as well
    with refused("not_shown", "Emitter"):
        read_object(emitter, depsgraph())
    assert not len(shown(emitter))
    emitter.show_instancer_for_viewport, settings.render_type = True, "OBJECT"
    emitter.modifiers[0].show_viewport = False
    check(emitter, 1)
    emitter.hide_set(True)  # of what shows no particles nothing is missing
    assert read_object(emitter, depsgraph()).instance_count == 1


def test_an_instancer_that_hides_itself_shows_its_instances_only():
    host = cube("Host")
    nodes(host, lambda tree, source: join(tree, on_points(tree, grid(tree, 3), source), source))
    plain = cube("Plain")
    host.show_instancer_for_viewport = plain.show_instancer_for_viewport = False
    check(host, 9)
    check(plain, 1)


@pytest.mark.parametrize("own", [True, False])
def test_instances_of_an_object_in_edit_mode_are_read(own):
    host = placed(cube("Host"))
    body = mesh("Body")
    source = link("Source", body)

    def build(tree, mine):
        points = on_points(
            tree,
            grid(tree, 3),
            node(tree, "GeometryNodeObjectInfo", {"Object": source}).outputs["Geometry"],
        )
        return join(tree, points, mine) if own else points

    nodes(host, build)
    bpy.context.view_layer.objects.active = host
    bpy.ops.object.mode_set(mode="EDIT")
    check(host, 10 if own else 9)


def test_instanced_object_in_edit_mode_has_its_edits():
    members = collection("Members")
    source = cube("Source", members)
    instancer = empty("Instancer", members)
    drag_a_corner(source)
    (part,) = read_object(instancer, depsgraph()).parts
    assert part.surface.points[0].tolist() == [-7.0, -1.0, -1.0]


def test_places_that_are_not_finite_are_counted_and_refused():
    host = cube("Host")

    def build(tree, source):
        index = tree.nodes.new("GeometryNodeInputIndex").outputs[0]
        divided = tree.nodes.new("ShaderNodeMath")
        divided.operation = "POWER"
        divided.inputs[0].default_value = 1.0e30
        tree.links.new(index, divided.inputs[1])
        made = node(tree, "GeometryNodeInstanceOnPoints", Points=grid(tree, 2), Instance=source)
        tree.links.new(divided.outputs[0], made.inputs["Scale"])
        return made.outputs[0]

    nodes(host, build)
    with refused("non_finite_instances", "Host", count=2, total=4):
        read_object(host, depsgraph())


@pytest.mark.parametrize("count", [2, 4])
def test_instances_scaled_to_nothing_are_left_out_and_said(count):
    host = cube("Host")

    def build(tree, source):
        index = tree.nodes.new("GeometryNodeInputIndex").outputs[0]
        points = node(
            tree, "GeometryNodeMeshLine", {"Count": count, "Start Location": (1.0, 0.0, 0.0)}
        ).outputs[0]
        made = node(tree, "GeometryNodeInstanceOnPoints", Points=points, Instance=source)
        tree.links.new(index, made.inputs["Scale"])
        return made.outputs[0]

    nodes(host, build)
    reading = read_object(host, depsgraph())
    assert [len(part.matrices) for part in reading.parts] == [count - 1]
    assert said(reading) == {"instances_vanished": {"count": 1}}
    assert not reading.all_singular


def test_unevaluated_instanced_object_is_read_with_modifiers():
    source = cube("Source")
    source.modifiers.new("Array", "ARRAY").count = 2
    members = collection("Members")
    members.objects.link(source)
    bpy.context.scene.collection.objects.unlink(source)
    layer_of(members).exclude = True
    reading = check(empty("Instancer", members), 1)
    assert len(reading.parts[0].surface.quads) == 12


def test_picked_instances_leave_out_others():
    """A collection's children one by one, of which the points take the second and the third."""
    members = collection("Members", False)
    for number, name in enumerate("ABC"):
        placed(cube(name, members), location=(number, 0, 0))
    host = cube("Host")

    def build(tree, source):
        info = node(
            tree, "GeometryNodeCollectionInfo", {"Collection": members, "Separate Children": True}
        )
        made = node(
            tree, "GeometryNodeInstanceOnPoints", Points=grid(tree, 2), Instance=info.outputs[0]
        )
        made.inputs["Pick Instance"].default_value = True
        index = tree.nodes.new("GeometryNodeInputIndex").outputs[0]
        chosen = tree.nodes.new("ShaderNodeMath")
        chosen.operation = "MODULO"
        chosen.inputs[1].default_value = 2.0
        tree.links.new(index, chosen.inputs[0])
        more = tree.nodes.new("ShaderNodeMath")
        more.inputs[1].default_value = 1.0
        tree.links.new(chosen.outputs[0], more.inputs[0])
        tree.links.new(more.outputs[0], made.inputs["Instance Index"])
        return made.outputs[0]

    nodes(host, build)
    check(host, 4)
