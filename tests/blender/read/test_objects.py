# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What an object gives when it is read, the findings about it, and what is refused."""

import math
import shutil

import bpy
import numpy as np
import pytest
from body_moments.blender.read.objects import read_object
from body_moments.blender.read.visibility import measurable, measurable_objects
from body_moments.core.verdict import MeasureError, Severity, finding, severity

from tests.blender import findings
from tests.blender.findings import said
from tests.blender.read_bodies import (
    activate,
    collection,
    cube,
    depsgraph,
    join,
    layer_of,
    link,
    loop_triangles,
    mesh,
    node,
    nodes,
    surface_triangles,
)

pytestmark = pytest.mark.usefixtures("bare_scene")


def read(obj):
    return read_object(obj, depsgraph())


def refused(obj, code, **values):
    with findings.refused(code, obj.name, **values):
        read(obj)
    return True


def circle_without_fill():
    bpy.ops.curve.primitive_bezier_circle_add()
    return bpy.context.object


def bevelled():
    obj = circle_without_fill()
    obj.data.bevel_depth = 0.1
    return obj


def text():
    bpy.ops.object.text_add()
    bpy.context.object.data.extrude = 0.1
    return bpy.context.object


def nurbs():
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    return bpy.context.object


def instances_of(members):
    """An empty that instances a collection."""
    obj = link("Instancer")
    obj.instance_type, obj.instance_collection = "COLLECTION", members
    return obj


def shaped(value=1.0):
    obj = cube("Shaped")
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Big")
    for point in key.data:
        point.co *= 2.0
    key.value = value
    return obj


def ball():
    data = bpy.data.metaballs.new("Ball")
    data.elements.new().co = (0.0, 0.0, 0.0)
    return link("Ball", data)


@pytest.mark.parametrize(
    "make", [cube, bevelled, text, nurbs, shaped, ball], ids=lambda make: make.__name__
)
def test_every_kind_that_shows_a_surface_is_read(make):
    obj = make()
    reading = read(obj)
    (part,) = reading.parts
    assert (reading.name, reading.type) == (obj.name, obj.type)
    evaluated = obj.evaluated_get(depsgraph())
    drawn = loop_triangles(evaluated.to_mesh())
    evaluated.to_mesh_clear()
    assert len(drawn) > 6
    assert surface_triangles(part.surface) == drawn
    assert np.array_equal(part.matrices, [[row[:] for row in obj.matrix_world]])
    assert measurable(obj)


@pytest.mark.parametrize(
    "add",
    [bpy.ops.surface.primitive_nurbs_surface_sphere_add, bpy.ops.curve.primitive_bezier_circle_add],
    ids=str,
)
def test_joined_curve_with_shape_keys_is_refused(add):
    """Join gives the keys no points, and Blender draws what lies in memory behind them."""
    add()
    other = bpy.context.object
    add()
    obj = bpy.context.object
    obj.data.extrude = 0.5
    for name in ("Basis", "Big"):
        obj.shape_key_add(name=name)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.curve.duplicate()
    assert read(obj).parts
    bpy.ops.object.mode_set(mode="OBJECT")
    assert read(obj).parts
    other.select_set(True)
    bpy.ops.object.join()
    assert len(obj.data.splines) == 3
    assert refused(obj, "shape_keys_of_other_points")


@pytest.mark.parametrize("make", [bevelled, text, ball], ids=lambda make: make.__name__)
def test_round_surfaces_are_reported_as_polygons(make):
    obj = make()
    assert said(read(obj))["drawn_as_polygons"] == {}
    if obj.type != "META":
        members = collection("Members")
        members.objects.link(obj)
        instancer = instances_of(members)
        assert said(read(instancer)) == {"drawn_as_polygons": {"sources": [obj.name]}}


def spline_object(kind, points, depth=0.0):
    data = bpy.data.curves.new("Line", "CURVE")
    data.dimensions, data.extrude, data.bevel_depth, data.bevel_resolution = "3D", 0.5, depth, 0
    spline = data.splines.new(kind)
    items = spline.bezier_points if kind == "BEZIER" else spline.points
    items.add(len(points) - 1)
    for item, point in zip(items, points):
        if kind == "BEZIER":
            item.co = point
            item.handle_left_type = item.handle_right_type = "VECTOR"
        else:
            item.co = (*point, 1.0)
    return link("Line", data)


CORNER = [(0.0, 0.1, 0.0), (3.0, 0.7, 0.3), (3.3, 4.0, 0.1), (-1.0, 2.0, 0.7)]


def drawn(obj):
    return "drawn_as_polygons" in said(read(obj))


@pytest.mark.parametrize("cyclic", [False, True])
def test_straight_bezier_spline_is_its_polygon(cyclic):
    obj = spline_object("BEZIER", CORNER)
    (spline,) = obj.data.splines
    spline.use_cyclic_u, spline.order_u = cyclic, 2  # an order that none but NURBS has
    depsgraph()
    assert not drawn(obj)
    for item, name in (
        (spline.bezier_points[0], "handle_left"),
        (spline.bezier_points[-1], "handle_right"),
    ):
        setattr(item, name + "_type", "FREE")
        setattr(item, name, item.co + item.co.orthogonal())
    assert drawn(obj) == cyclic
    spline.bezier_points[1].handle_right_type = "FREE"
    spline.bezier_points[1].handle_right.z += 0.1
    assert drawn(obj)


@pytest.mark.parametrize(
    "kind", ["LIGHT", "CAMERA", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE"]
)
def test_kinds_without_geometry_are_refused_by_name(kind):
    adders = {
        "LIGHT": lambda: bpy.ops.object.light_add(type="SUN"),
        "CAMERA": bpy.ops.object.camera_add,
        "ARMATURE": bpy.ops.object.armature_add,
        "LATTICE": lambda: bpy.ops.object.add(type="LATTICE"),
        "SPEAKER": bpy.ops.object.speaker_add,
        "LIGHT_PROBE": bpy.ops.object.lightprobe_add,
    }
    adders[kind]()
    obj = bpy.context.object
    assert refused(obj, "object_without_geometry")
    assert not measurable(obj)


def test_an_empty_without_instances_is_refused(registered):
    obj = link("Empty")
    assert refused(obj, "not_shown")
    assert not measurable(obj)
    assert refused(instances_of(collection("Hollow")), "not_shown")
    point = link("Point")
    point.body_moments.mass_from, point.body_moments.mass = "MASS", 2.0
    assert refused(point, "not_shown")


def test_objects_without_faces_are_refused_with_their_content():
    wire = link("Wire", mesh("Wire", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1), (1, 2)]))
    assert refused(wire, "only_without_surface")
    assert refused(link("Nothing", mesh("Nothing", [], [])), "no_faces")
    circle = circle_without_fill()
    assert refused(circle, "nothing_to_measure")
    assert not measurable(circle)
    circle.data.dimensions, circle.data.fill_mode = "2D", "NONE"
    assert refused(circle, "nothing_to_measure")
    assert not measurable(circle)
    circle.data.fill_mode = "BOTH"
    assert measurable(circle)
    letters = text()
    letters.data.extrude, letters.data.fill_mode = 0.0, "NONE"
    assert refused(letters, "nothing_to_measure")
    letters.data.body = " "
    assert refused(letters, "nothing_to_measure")
    wire = circle_without_fill()
    wire.modifiers.new("Array", "ARRAY")
    assert refused(wire, "only_without_surface")
    hidden = link("Hidden", mesh("Nothing", [], []))
    hidden.show_instancer_for_viewport = False  # of which it is none
    assert refused(hidden, "no_faces")
    for kind in ("pointclouds", "hair_curves", "volumes"):
        obj = link(kind, getattr(bpy.data, kind).new(kind))
        assert refused(obj, "only_without_surface" if kind == "volumes" else "no_faces")
        assert measurable(obj) == (kind == "volumes")  # as a grid of densities


def test_a_curve_may_show_a_surface_once_it_is_thick_or_modified():
    obj, profile = circle_without_fill(), circle_without_fill()
    for name in ("extrude", "bevel_depth"):
        for value in (0.1, 0.0):
            setattr(obj.data, name, value)
            assert measurable(obj) == (value > 0.0)
    for mode, shape in (("OBJECT", None), ("OBJECT", profile), ("ROUND", profile)):
        obj.data.bevel_mode, obj.data.bevel_object = mode, shape
        assert measurable(obj) == (mode == "OBJECT" and shape is not None)
    obj.modifiers.new("Array", "ARRAY")
    assert measurable(obj)


def test_a_point_cloud_with_a_surface_from_nodes_is_read():
    obj = link("Cloud", bpy.data.pointclouds.new("Cloud"))
    nodes(
        obj, lambda tree, source: join(tree, source, node(tree, "GeometryNodeMeshCube").outputs[0])
    )
    assert measurable(obj)
    assert len(read(obj).parts[0].surface.quads) == 6


# Hidden, excluded, elsewhere: Blender drops the modifiers of these without a word.


def doubled(name, where=None):
    obj = cube(name, where)
    obj.modifiers.new("Array", "ARRAY").count = 2
    return obj


@pytest.mark.parametrize("is_operand", [False, True])
def test_hidden_object_is_read_with_modifiers_and_reported(is_operand):
    obj = doubled("Hidden")
    obj.hide_set(not is_operand)
    obj.hide_viewport = is_operand
    if is_operand:
        cube("Body").modifiers.new("Boolean", "BOOLEAN").object = obj
    obj.location.x = 5.0
    reading = read(obj)
    assert len(reading.parts[0].surface.quads) == 12
    assert reading.matrix[0, 3] == 5.0
    assert said(reading)["hidden_object_measured"]["cause"]["code"] == "hidden_in_viewport"
    obj.modifiers["Array"].count = 3
    assert len(read(obj).parts[0].surface.quads) == 18


def test_hiding_is_that_of_the_given_view_layer():
    obj, scene = doubled("Body"), bpy.context.scene
    second = scene.view_layers.new("Second")
    second.update()
    for hides, cause in ((second, "hidden_in_viewport"), (bpy.context.view_layer, None)):
        for layer in (second, bpy.context.view_layer):
            obj.hide_set(layer == hides, view_layer=layer)
        second.update()
        found = said(read_object(obj, second.depsgraph)).get("hidden_object_measured")
        assert (found and found["cause"]["code"]) == cause


@pytest.mark.parametrize("name", ["Body", "Home"])
def test_disabled_or_excluded_object_is_refused(name):
    home = collection("Home")
    obj = doubled("Body", home)
    obj.hide_viewport = name == "Body"
    layer_of(home).exclude = name == "Home"
    assert refused(obj, "hidden_in_viewport", name=name)


def test_an_object_of_another_scene_or_of_none_is_refused():
    obj = doubled("Body")
    bpy.context.scene.collection.objects.unlink(obj)
    assert refused(obj, "not_in_scene", scene="Scene")
    bpy.data.scenes.new("Other").collection.objects.link(obj)
    assert refused(obj, "not_in_scene", scene="Scene")


# What the render would show is not what is read.


def test_other_levels_for_the_render_are_a_note():
    obj = cube()
    modifier = obj.modifiers.new("Smooth", "SUBSURF")
    modifier.levels, modifier.render_levels = 1, 3
    reading = read(obj)
    assert len(reading.parts[0].surface.quads) == 24
    differing = finding("render_levels_differ", name="“Smooth”", viewport=1, render=3)
    assert said(reading) == {
        "render_differs": {"differences": [differing.as_record()], "slight": True}
    }
    assert severity(reading.findings[0]) == Severity.NOTE
    assert "“Smooth”: 1 in the viewport, 3 in the render." in str(reading.findings[0])
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = (
        bpy.context.scene.render.simplify_subdivision_render
    ) = 1
    assert read(obj).findings == []


def differences(obj):
    return said(read(obj)).get("render_differs", {}).get("differences", [])


def test_modifiers_differing_in_render_are_reported():
    obj = doubled("Body")
    for place, is_shown, is_rendered in (
        ("render", False, True),
        (None, False, False),
        ("viewport", True, False),
    ):
        obj.modifiers["Array"].show_viewport = is_shown
        obj.modifiers["Array"].show_render = is_rendered
        differing = finding("render_modifier_differs", modifier="Array", place=place)
        assert differences(obj) == ([differing.as_record()] if place else [])


# Transforms.


@pytest.mark.parametrize(
    "scale, singular",
    [
        ((1, 1, 0), True),
        ((0, 0, 0), True),
        ((1e-9, 1e-9, 1e-9), False),
        ((1e-9, 1.0, 1e9), False),
        ((-1, 1, 1), False),
    ],
)
def test_flattened_object_is_singular_and_small_one_is_not(scale, singular):
    obj = cube()
    obj.scale, obj.rotation_euler = scale, (0.4, 0.5, 0.6)
    found = read(obj)
    assert (found.all_singular, found.singular_instance_count) == (singular, int(singular))


def test_a_transform_that_is_not_finite_is_refused():
    obj = cube()
    obj.location.x = math.nan
    assert refused(obj, "non_finite_transform")


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_coordinates_that_are_not_finite_are_counted_and_refused(value):
    obj = cube()
    points = np.array([vertex.co[:] for vertex in obj.data.vertices], np.float32)
    points[2, 1] = points[5, 0] = value
    obj.data.attributes["position"].data.foreach_set("vector", points.ravel())
    obj.data.update()
    with pytest.raises(MeasureError) as caught:
        read(obj)
    assert caught.value.finding == finding("non_finite_vertices", count=2, total=8)
    assert caught.value.finding.elements.tolist() == [2, 5]


# Data of others, modes, and nothing changed.


def test_linked_objects_and_collections_are_read(tmp_path):
    home = collection("Library")
    doubled("Linked", home)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {home})
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    cube("Linked").location.x = 9.0
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.collections = ["Library"]
    (linked,) = here.collections
    bpy.context.scene.collection.children.link(linked)
    (obj,) = linked.objects
    assert obj.library is not None
    reading = read(obj)
    assert len(reading.parts[0].surface.quads) == 12
    assert reading.matrix[0, 3] == 0.0
    instancer = instances_of(linked)
    assert len(read(instancer).parts[0].surface.quads) == 12
    assert len(measurable_objects(bpy.context.view_layer)) == 3
    earlier = str(tmp_path / "a library.blend")
    shutil.copyfile(path, earlier)
    with bpy.data.libraries.load(earlier, link=True) as (_there, here):
        here.collections = ["Library"]
    bpy.context.scene.collection.children.link(here.collections[0])
    own = bpy.data.objects["Linked", None]
    assert measurable_objects(bpy.context.view_layer) == [
        instancer,
        own,
        *here.collections[0].objects,
        obj,
    ]


@pytest.mark.parametrize(
    "mode", ["SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "EDIT", "OBJECT"]
)
def test_reading_keeps_mode_selection_and_active_object(mode):
    obj, other = doubled("Body"), cube("Other")
    activate(obj)
    bpy.ops.object.mode_set(mode=mode)
    reading = read(obj)
    assert len(reading.parts[0].surface.quads) == 12
    read(other)
    assert obj.mode == mode
    assert bpy.context.view_layer.objects.active == obj
    assert bpy.context.selected_objects == [obj]
    assert ("read_in_mode" in said(reading)) == (mode in {"EDIT", "SCULPT"})
    obj.modifiers.clear()
    assert ("read_in_mode" in said(read(obj))) == (mode == "EDIT")


@pytest.mark.parametrize("instanced", [False, True])
def test_sculpted_multires_levels_are_refused(instanced):
    obj = cube("Sculpted")
    activate(obj)
    modifier = obj.modifiers.new("Levels", "MULTIRES")
    bpy.ops.object.multires_subdivide(modifier="Levels")
    whole = read(obj).parts[0].surface.box
    asked = obj
    if instanced:
        asked = instances_of(bpy.data.collections.new("Made"))
        asked.instance_collection.objects.link(obj)
    bpy.ops.object.mode_set(mode="SCULPT")
    unreadable = finding("sculpted_mesh")
    if instanced:
        unreadable = finding("object_unreadable", object="Sculpted", cause=unreadable.as_record())
    assert refused(asked, unreadable.code, **unreadable.values)
    modifier.sculpt_levels = 0
    assert np.array_equal(read(asked).parts[0].surface.box, [[-1.0] * 3, [1.0] * 3])
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(read(asked).parts[0].surface.box, whole)


@pytest.mark.parametrize(
    "blended, edited, half, expected",
    [
        (False, 0, 1.0, finding("edit_mode_single_shape_key", shape_key="Basis")),
        (False, 1, 2.0, finding("edit_mode_single_shape_key", shape_key="Big")),
        (True, 0, 1.5, None),
        (True, 1, 1.5, None),
    ],
)
def test_edit_mode_reads_the_shape_keys_that_it_shows(blended, edited, half, expected):
    obj = shaped(0.5)
    obj.active_shape_key_index, obj.use_shape_key_edit_mode = edited, blended
    activate(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    other = link("Other", obj.data)
    reading = read(obj)
    assert reading.parts[0].surface.box[1].tolist() == [half] * 3
    single = [] if blended else [expected]
    assert reading.findings == [finding("read_in_mode", mode="Edit Mode"), *single]
    # which is not the one that is edited
    assert "edit_mode_single_shape_key" not in said(read(other))


def test_members_of_hidden_collection_are_not_listed():
    members = collection("Members")
    member = cube("Member", members)
    instancer = instances_of(members)
    aside = cube("Aside")
    aside.hide_set(True)
    layer, other = bpy.context.view_layer, bpy.context.scene.view_layers.new("Other")
    assert measurable_objects(layer) == [aside, instancer, member]
    layer_of(members).hide_viewport = True
    assert measurable_objects(layer) == [aside, instancer]
    assert measurable_objects(other) == [aside, instancer, member]
    bpy.data.objects.remove(aside)
    layer_of(members).exclude = True
    assert measurable_objects(layer) == [instancer]
    assert len(read(member).parts) == 1
