# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Densities that are not one number: materials, polynomials and vertex attributes, from settings to
what is said.
"""

import math

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.session.tracking import staleness, stamps
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.density.polynomial import parse_polynomial
from body_moments.core.inertia.mass_properties import combine
from body_moments.core.verdict import MeasureError, finding

from tests.blender import batch_files
from tests.blender.findings import refused, said
from tests.blender.measured_boxes import add, box, measure
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

STEEL, CORK = 7820.0, 240.0


def material(name, density=0.0):
    made = bpy.data.materials.new(name)
    made.body_moments.density = density
    return made


def by_material(obj, *materials, faces=None, others=1000.0):
    """Give an object materials, and the slot of each face."""
    for one in materials:
        obj.data.materials.append(one)
    if faces is not None:
        obj.data.polygons.foreach_set("material_index", faces)
    obj.body_moments.density_from, obj.body_moments.density = "MATERIALS", others
    bpy.context.view_layer.update()
    return obj


def by_polynomial(obj, text, frame="OBJECT"):
    obj.body_moments.density_from = "POLYNOMIAL"
    obj.body_moments.density_polynomial, obj.body_moments.density_frame = text, frame
    return obj


def by_attribute(obj, values, name="density", kind="FLOAT", domain="POINT"):
    attribute = obj.data.attributes.new(name, kind, domain)
    attribute.data.foreach_set("value", values)
    obj.body_moments.kind, obj.body_moments.density_from = "SHELL", "ATTRIBUTE"
    obj.body_moments.density_attribute, obj.body_moments.thickness = name, 0.01
    bpy.context.view_layer.update()
    return obj


def dumbbell(**transform):
    """A steel and a cork cube of 1 m, their centres 4 m apart."""
    obj = add(box((0, 0, 0), (1, 1, 1)), box((4, 0, 0), (5, 1, 1)), **transform)
    return by_material(
        obj, material("Steel", STEEL), material("Cork", CORK), faces=[0] * 6 + [1] * 6
    )


@pytest.mark.parametrize(
    "transform",
    [
        {"scale": (-1, 1, 1)},
        {"scale": (2, 0.5, 3)},
        {"location": (1e4, 0, 0), "rotation_euler": (0.3, 0.5, -1.0)},
    ],
)
def test_materials_follow_every_transform(transform):
    """The truth is the sum of two bodies of one density each."""
    obj = dumbbell(**transform)
    found = measure(obj).mass_properties
    parts = []
    for low, density in (((0, 0, 0), STEEL), ((4, 0, 0), CORK)):
        high = tuple(value + 1 for value in low)
        parts.append(measure(add(box(low, high), **transform), density=density).mass_moments)
    truth = combine(parts)
    assert (
        abs(found.mass - truth.mass)
        <= found.rounding_error["mass"] + truth.rounding_error["mass"]
        < 1e-12 * truth.mass
    )
    assert (
        np.linalg.norm(found.center - truth.center)
        <= found.rounding_error["center"] + truth.rounding_error["center"]
        < 1e-9
    )
    bound = found.rounding_error["inertia"] + truth.rounding_error["inertia"]
    assert np.linalg.norm(found.inertia - truth.inertia) <= bound < 1e-9 * np.trace(truth.inertia)


def test_a_shell_takes_its_materials_by_face():
    """A cube whose bottom is of steel: 5 faces of cork, the centre below the middle."""
    obj = add(box((0, 0, 0), (1, 1, 1)))
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    down = [polygon.normal.z < -0.5 for polygon in obj.data.polygons]
    by_material(
        obj, material("Cork", CORK), material("Steel", STEEL), faces=[int(one) for one in down]
    )
    found = measure(obj)
    mass = 0.01 * (5 * CORK + STEEL)
    assert str(found.method) == "shell" and close(found.mass_properties.mass, mass, rel=1e-14)
    z = (4 * CORK * 0.5 + CORK * 1.0) / (5 * CORK + STEEL)
    assert close(found.mass_properties.center, [0.5, 0.5, z], rel=1e-13)
    assert found.density == pytest.approx(mass / 0.06, rel=1e-14)


def test_the_mean_by_area_is_that_of_the_areas_as_they_are_seen():
    """A unit cube scaled to 1 x 2 x 3 is the box of 1 x 2 x 3, beside another place with another
    scale.
    """
    cork, steel = material("Cork", CORK), material("Steel", STEEL)
    cube = by_material(
        add(box((0, 0, 0), (1, 1, 1)), scale=(1, 2, 3)), cork, steel, faces=[1, 0, 0, 0, 0, 0]
    )
    same = by_material(add(box((0, 0, 0), (1, 2, 3))), cork, steel, faces=[1, 0, 0, 0, 0, 0])
    mass = measure(same).mass_properties.mass
    assert measure(cube).mass_properties.mass == pytest.approx(mass, rel=1e-13)
    group = bpy.data.collections.new("Group")
    group.objects.link(cube)
    other = bpy.data.objects.new("Other", cube.data)
    other.location.x = 10.0
    group.objects.link(other)
    empty = bpy.data.objects.new("Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    empty.body_moments.density_from = "MATERIALS"
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    assert measure(empty).mass_properties.mass == pytest.approx(
        mass + (5 * CORK + STEEL) / 6, rel=1e-13
    )


def test_faces_without_a_density_take_the_objects_and_it_is_said():
    obj = add(box((0, 0, 0), (1, 1, 1)), box((4, 0, 0), (5, 1, 1)))
    by_material(
        obj, material("Steel", STEEL), material("Paint"), faces=[0] * 6 + [1] * 6, others=500.0
    )
    found = measure(obj)
    assert found.mass_properties.mass == pytest.approx(STEEL + 500.0, rel=1e-14)
    lacking = {"count": 6, "total": 12, "density": 500.0, "materials": ["Paint"]}
    assert said(found) == {"object_density_used": lacking}
    assert [part["code"] for part in found.density_from.values["materials"]] == [
        "density_of_material",
        "density_of_others",
    ]
    obj.body_moments.density = 0.0
    with refused("material_without_density", count=6, total=12):
        measure(obj)
    bare = add(box())
    bare.body_moments.density_from = "MATERIALS"
    lacking = {"count": 6, "total": 6, "density": 1000.0, "materials": "none"}
    assert said(measure(bare)) == {"object_density_used": lacking}


def test_empty_material_slot_takes_density_of_object():
    obj = by_material(
        add(box((0, 0, 0), (1, 1, 1)), box((4, 0, 0), (5, 1, 1))),
        material("Steel", STEEL),
        material("Cork", CORK),
        faces=[0] * 6 + [7] * 6,
    )
    assert measure(obj).mass_properties.mass == pytest.approx(STEEL + CORK, rel=1e-14)
    obj.data.materials[1] = None
    bpy.context.view_layer.update()
    assert measure(obj).mass_properties.mass == pytest.approx(STEEL + 1000.0, rel=1e-14)
    for slot, name in zip(obj.material_slots, ("Cork", "Steel")):
        slot.link, slot.material = "OBJECT", bpy.data.materials[name]
        bpy.context.view_layer.update()
        last = 1000.0 if name == "Cork" else STEEL
        assert measure(obj).mass_properties.mass == pytest.approx(CORK + last, rel=1e-14)


def test_cavity_subtracts_outer_material_and_insert_adds():
    hole = box((1, 1, 1), (3, 3, 3), turned=True)
    obj = by_material(
        add(box((0, 0, 0), (4, 4, 4)), hole),
        material("Steel", STEEL),
        material("Cork", CORK),
        faces=[0] * 6 + [1] * 6,
    )
    found = measure(obj)
    assert found.mass_properties.mass == pytest.approx(STEEL * 56, rel=1e-14)
    assert "cavity_material_ignored" in said(found)
    insert = by_material(
        add(box((0, 0, 0), (4, 4, 4)), box((1, 1, 1), (3, 3, 3))),
        bpy.data.materials["Steel"],
        bpy.data.materials["Cork"],
        faces=[0] * 6 + [1] * 6,
    )
    found = measure(insert)
    assert found.mass_properties.mass == pytest.approx(STEEL * 64 + CORK * 8, rel=1e-14)
    assert "overlapping_densities" in said(found)
    insert.body_moments.kind, insert.body_moments.thickness = "SHELL", 0.01
    assert "overlapping_densities" not in said(measure(insert))
    same = by_material(
        add(box((0, 0, 0), (4, 4, 4)), box((1, 1, 1), (3, 3, 3))), bpy.data.materials["Steel"]
    )
    assert "overlapping_densities" not in said(measure(same))
    inner = [box((i, 1, 1), (i + 0.5, 3, 3)) for i in (1, 2)]
    beside = [box((x, 0, 0), (x + 2, 1, 1)) for x in (10, 11)]
    faces = [0] * 18 + [1] * 12
    both = by_material(
        add(box((0, 0, 0), (4, 4, 4)), *inner, *beside), *insert.data.materials, faces=faces
    )
    found = measure(both)
    assert found.health.nested_components == found.health.overlapping_components == 2
    assert "overlapping_densities" in said(found)


def test_united_shells_have_no_materials():
    obj = dumbbell()
    obj.body_moments.overlap = "UNION"
    with refused("union_lacks"):
        measure(obj)


def test_collection_members_bring_their_materials():
    steel, cork = material("Steel", STEEL), material("Cork", CORK)
    group = bpy.data.collections.new("Group")
    mesh_of = by_material(add(box((0, 0, 0), (1, 1, 1))), cork)
    second = bpy.data.objects.new("Second", mesh_of.data)
    second.location.x = 4.0
    for obj in (mesh_of, second):
        group.objects.link(obj)
    second.material_slots[0].link, second.material_slots[0].material = "OBJECT", steel
    empty = bpy.data.objects.new("Instancer", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    empty.body_moments.density_from = "MATERIALS"
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    found = measure(empty)
    assert found.mass_properties.mass == pytest.approx(STEEL + CORK, rel=1e-14)
    assert close(
        found.mass_properties.center[0], (CORK * 0.5 + STEEL * 4.5) / (STEEL + CORK), rel=1e-14
    )
    second.location.x = (
        0.5  # their boxes meet: they are compared as one surface, each with its material
    )
    bpy.context.view_layer.update()
    assert measure(empty).mass_properties.mass == pytest.approx(STEEL + CORK, rel=1e-6)


def nodes(obj, build):
    """A geometry nodes modifier; build(tree) returns the socket of the output."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    source, out = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    tree.links.new(build(tree, source.outputs[0]), out.inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    bpy.context.view_layer.update()
    return tree


def test_material_set_by_modifier_counts_and_makes_stale():
    steel = material("Steel", STEEL)
    obj = by_material(add(box((0, 0, 0), (1, 1, 1))), material("Cork", CORK))

    def build(tree, geometry):
        node = tree.nodes.new("GeometryNodeSetMaterial")
        node.inputs["Material"].default_value = steel
        tree.links.new(geometry, node.inputs["Geometry"])
        return node.outputs[0]

    nodes(obj, build)
    assert measure(obj).mass_properties.mass == pytest.approx(STEEL, rel=1e-14)
    obj.select_set(True)
    bpy.ops.object.body_moments_measure()
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    steel.body_moments.density = 8000.0
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene) == stamps.Stale.SETTINGS


def test_geometry_nodes_instances_bring_their_materials():
    steel = material("Steel", STEEL)
    obj = by_material(add(box((0, 0, 0), (1, 1, 1))), material("Cork", CORK))

    def build(tree, geometry):
        cube, paint = (
            tree.nodes.new("GeometryNodeMeshCube"),
            tree.nodes.new("GeometryNodeSetMaterial"),
        )
        paint.inputs["Material"].default_value = steel
        tree.links.new(cube.outputs[0], paint.inputs["Geometry"])
        line, on = (
            tree.nodes.new("GeometryNodeMeshLine"),
            tree.nodes.new("GeometryNodeInstanceOnPoints"),
        )
        line.inputs["Count"].default_value = 3
        line.inputs["Start Location"].default_value = (5, 0, 0)
        line.inputs["Offset"].default_value = (5, 0, 0)
        tree.links.new(line.outputs[0], on.inputs["Points"])
        tree.links.new(paint.outputs[0], on.inputs["Instance"])
        join = tree.nodes.new("GeometryNodeJoinGeometry")
        tree.links.new(geometry, join.inputs[0])
        tree.links.new(on.outputs[0], join.inputs[0])
        return join.outputs[0]

    nodes(obj, build)
    assert measure(obj).mass_properties.mass == pytest.approx(CORK + 3 * STEEL, rel=1e-14)


def test_materials_in_edit_mode_and_of_text():
    obj = dumbbell()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    assert measure(obj).mass_properties.mass == pytest.approx(STEEL + CORK, rel=1e-14)
    bpy.ops.object.mode_set(mode="OBJECT")
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body, curve.extrude = "I", 0.1
    curve.materials.append(bpy.data.materials["Steel"])
    text = bpy.data.objects.new("Text", curve)
    bpy.context.scene.collection.objects.link(text)
    text.body_moments.density_from = "MATERIALS"
    bpy.context.view_layer.update()
    assert measure(text).density == pytest.approx(STEEL, rel=1e-14)


# Polynomials


def test_coefficients_are_the_same_density():
    obj = add(box())
    source = measure(by_polynomial(obj, "1000 + 20*z")).density_from
    assert source == finding("density_from_polynomial", polynomial="1000 + 20*z", frame="object")
    assert str(source) == "polynomial 1000 + 20*z, in object coordinates"
    one = measure(obj).mass_properties
    other = measure(by_polynomial(obj, "1000, 0, 0, 20")).mass_properties
    assert one.mass == other.mass and np.array_equal(one.inertia, other.inertia)
    # A decimal comma makes two coefficients, too: it is reported as what it was read.
    source = measure(by_polynomial(obj, "1000,5")).density_from
    assert source == finding(
        "density_from_polynomial", polynomial="(1000,5) · (1, x, y, z, …)", frame="object"
    )


def boxes_mass(low, high, density):
    """(mass, centre) of a box with a density of z."""
    z, weight = np.polynomial.legendre.leggauss(8)
    z = (low[2] + high[2]) / 2.0 + (high[2] - low[2]) / 2.0 * z
    weight = weight / 2.0 * (high[2] - low[2]) * density(z)
    area = (high[0] - low[0]) * (high[1] - low[1])
    return area * weight.sum(), (weight * z).sum() / weight.sum()


@pytest.mark.parametrize(
    "frame, scale, place",
    [
        ("OBJECT", (1, 1, 1), (10, 20, 30)),
        ("WORLD", (1, 1, 1), (10, 20, 30)),
        ("OBJECT", (1, 1, 2), (0, 0, 5)),
        ("WORLD", (1, 2, 4), (0, 0, 5)),
        ("OBJECT", (-1, 1, 1), (0, 0, 7)),
        ("OBJECT", (1, 1, -1), (0, 0, 7)),
        ("WORLD", (1, 1, -1), (0, 0, 7)),
    ],
)
def test_coordinates_are_the_objects_own_or_the_worlds(frame, scale, place):
    """Own coordinates are meters along the axes as they are drawn: scaled they are not, mirrored
    they are.
    """
    obj = by_polynomial(
        add(box((0, 0, 1), (1, 2, 3)), location=place, scale=scale), "5 + z**2", frame
    )
    found = measure(obj).mass_properties
    size, sign = np.abs(scale), np.sign(scale[2])
    local = [np.array((0, 0, 1)) * size, np.array((1, 2, 3)) * size]
    if frame == "OBJECT":
        mass, z = boxes_mass(*local, lambda z: 5.0 + z**2)
    else:
        mass, z = boxes_mass(*local, lambda z: 5.0 + (place[2] + sign * z) ** 2)
    assert found.mass == pytest.approx(mass, rel=1e-12)
    assert found.center[2] == pytest.approx(place[2] + sign * z, rel=1e-12)


def test_sheared_object_names_its_density_axes():
    parent = add(box(), name="Parent", scale=(3, 1, 1))
    child = by_polynomial(
        add(box((0, 0, 0), (1, 1, 1)), name="Child", rotation_euler=(0, 0, 0.7)), "1000 + 10*z"
    )
    child.parent = parent
    bpy.context.view_layer.update()
    found = measure(child)
    assert found.mass_properties.mass == pytest.approx(found.volume * 1005.0, rel=1e-6)
    assert "sheared_density_axes" in said(found)
    assert not measure(by_polynomial(child, "1000 + 10*z", "WORLD")).findings  # whose axes are not


@pytest.mark.parametrize("apart", [5.0, 0.5])
def test_each_instance_has_the_density_in_its_own_coordinates(apart):
    """Also where their boxes meet and they are compared as one surface."""
    rod = by_polynomial(add(box((0, 0, 0), (1, 1, 2))), "100 + 50*z")
    group = bpy.data.collections.new("Group")
    group.objects.link(rod)
    flipped = bpy.data.objects.new("Flipped", rod.data)
    flipped.location, flipped.rotation_euler = (apart, 1.0, 2.0), (np.pi, 0.0, 0.0)
    group.objects.link(flipped)
    empty = by_polynomial(bpy.data.objects.new("Instancer", None), "100 + 50*z")
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    found = measure(empty).mass_properties
    one = 2.0 * 150.0
    z = (100.0 * 2.0 + 50.0 * 8.0 / 3.0) / one
    assert found.mass == pytest.approx(2 * one, rel=1e-6)
    assert found.center[2] == pytest.approx(1.0, abs=1e-6)  # one the right way up, one upside down
    empty.body_moments.density_frame = "WORLD"
    assert measure(empty).mass_properties.center[2] == pytest.approx(z, rel=1e-6)


def test_a_shell_with_a_polynomial_density():
    """A unit square sheet in z = 0 with ρ = 10 + x²: ∫ = 10 + 1/3, and so on; unevenly scaled it is
    another sheet.
    """
    square = {"points": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], "faces": [(0, 1, 2, 3)]}
    for scale in ((1, 1, 1), (1, 3, 1), (2, 2, 2), (-1, 1, 1), (1, 1, 0)):
        obj = by_polynomial(add(square, scale=scale), "10 + x**2")
        obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
        a, b = abs(scale[0]), scale[1]
        found = measure(obj).mass_properties
        mass = 0.01 * b * (10 * a + a**3 / 3)
        assert close(found.mass, mass, rel=1e-13)
        assert close(abs(found.center[0]), (5 * a**2 + a**4 / 4) / (10 * a + a**3 / 3), rel=1e-13)


@pytest.mark.parametrize("text", ["1000 - 900*z", "x**2 - 0.2", "(z - 1)**2 + x**2 + y**2 - 0.02"])
def test_a_negative_density_is_refused_with_its_place(text):
    """The last one is negative only deep inside."""
    obj = by_polynomial(add(box((-1, -1, 0), (1, 1, 2))), text)
    with pytest.raises(MeasureError) as caught:
        measure(obj)
    values = caught.value.finding.values
    assert (
        caught.value.finding.code == "density_negative"
        and values["density"] < 0.0
        and values["frame"] == "object"
    )
    assert parse_polynomial(text)(np.array([values["point"]]))[0] == pytest.approx(
        values["density"]
    )


def test_possibly_negative_density_is_a_finding():
    ring = add(box((-1, -1, 0), (1, 1, 1)))
    found = measure(by_polynomial(ring, "(x**2 + y**2)*z"))
    assert not found.findings
    found = measure(
        by_polynomial(ring, "(x - 0.9993)**2 + (y - 0.9131)**2 + (z - 0.0717)**2 - 0.0001")
    )
    assert said(found) == {"density_possibly_negative": {}}
    assert not measure(by_polynomial(ring, "500*z")).findings


@pytest.mark.parametrize(("segments", "size"), [(128, 1.0), (16, 0.001)])
def test_density_falling_to_zero_at_surface_is_allowed(segments, size):
    bpy.ops.mesh.primitive_uv_sphere_add(
        segments=segments, ring_count=segments // 2, scale=(size, size, size)
    )
    ball = bpy.context.object
    text = "1000*(1 - (x**2 + y**2 + z**2)/{:g}**2)"
    found = measure(by_polynomial(ball, text.format(size)))
    assert close(found.mass_properties.mass, 8 / 15 * math.pi * 1000 * size**3, rel=0.01)
    assert said(found) == {"density_possibly_negative": {}}
    with refused("density_negative"):
        measure(by_polynomial(ball, text.format(0.99999 * size)))


def test_unreadable_polynomial_is_refused_with_its_part():
    with refused("polynomial_part", part="sin(z)"):
        measure(by_polynomial(add(box()), "1000 + sin(z)"))
    with refused("mass_overflow"):
        measure(by_polynomial(add(box()), "1e199*x**17 + 1"))
    with refused("zero_quantity"):
        measure(by_polynomial(add(box()), "0"))


def test_united_shells_take_a_polynomial():
    obj = by_polynomial(
        add(box((0, 0, 0), (1, 1, 1)), box((0.5, 0, 0), (1.5, 1, 1)), location=(3, 0, 0)),
        "100 + 10*x",
    )
    obj.body_moments.overlap = "UNION"
    assert measure(obj).mass_properties.mass == pytest.approx(100 * 1.5 + 10 * 1.5**2 / 2, rel=1e-6)
    obj.body_moments.density_frame = "WORLD"
    assert measure(obj).mass_properties.mass == pytest.approx(
        100 * 1.5 + 10 * (4.5**2 - 9) / 2, rel=1e-6
    )
    obj.body_moments.density_frame, obj.rotation_euler = "OBJECT", (0.0, 0.0, math.pi)
    bpy.context.scene.unit_settings.scale_length = 0.5
    mass = (100 * 0.75 + 10 * 0.75**2 / 2) * 0.25
    assert measure(obj).mass_properties.mass == pytest.approx(mass, rel=1e-6)


# Vertex attributes


def sheet(n=4, **transform):
    """The unit square in z = 0, in n x n quads."""
    points = [(i / n, j / n, 0.0) for i in range(n + 1) for j in range(n + 1)]
    at = [[i * (n + 1) + j for j in range(n + 1)] for i in range(n + 1)]
    faces = [
        (at[i][j], at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]) for i in range(n) for j in range(n)
    ]
    return add({"points": points, "faces": faces}, name="Sheet", **transform), np.array(points)


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 2, 2), (1, 3, 1), (-1, 1, 1)])
def test_a_sheet_with_a_density_that_rises_along_x(scale):
    obj, points = sheet(scale=scale)
    by_attribute(obj, 8.0 + 4.0 * points[:, 0])
    found = measure(obj)
    body, area = found.mass_properties, abs(scale[0]) * scale[1]
    assert close(body.mass, 0.01 * area * 10.0, rel=1e-13)
    assert close(abs(body.center[0]), abs(scale[0]) * (8 / 2 + 4 / 3) / 10.0, rel=1e-13)
    assert (
        found.density_from == finding("density_from_attribute", attribute="density")
        and not found.findings
    )
    assert found.error_bound["input"]["center_of_mass"] > 0.0


@pytest.mark.parametrize(
    "value, code",
    [
        (-1.0, "attribute_values"),
        (float("nan"), "attribute_values"),
        (float("inf"), "attribute_values"),
    ],
)
def test_values_that_are_no_density_are_refused(value, code):
    obj, points = sheet()
    values = np.ones(len(points))
    values[[0, 3]] = value
    with pytest.raises(MeasureError) as caught:
        measure(by_attribute(obj, values))
    assert caught.value.finding == finding(code, attribute="density", count=2)
    assert caught.value.finding.elements.tolist() == [0, 3]


def test_missing_or_mistyped_attribute_is_refused():
    obj, points = sheet()
    by_attribute(obj, np.ones(len(points)))
    obj.body_moments.density_attribute = "mass"
    with refused("attribute_missing", attribute="mass"):
        measure(obj)
    by_attribute(obj, np.ones(16), name="per_face", domain="FACE")
    with refused("attribute_missing", attribute="per_face"):
        measure(obj)
    obj.body_moments.density_attribute = ""
    with refused("density_source_missing"):
        measure(obj)
    cube = by_attribute(add(box()), np.ones(8))
    cube.body_moments.kind = "SOLID"
    with refused("density_attribute_of_solid"):
        measure(cube)


def test_an_attribute_is_read_as_modifiers_leave_it():
    obj, points = sheet(2)
    by_attribute(obj, 8.0 + 4.0 * points[:, 0])
    obj.modifiers.new("Subdivide", "SUBSURF").subdivision_type = "SIMPLE"
    bpy.context.view_layer.update()
    assert measure(obj).mass_properties.mass == pytest.approx(0.1, rel=1e-6)


# What is told and kept


def test_the_table_gives_a_blender_material_its_density():
    made = material("Cork")
    assert bpy.ops.material.body_moments_set_density(material="Steel, Carbon", target="Cork") == {
        "FINISHED"
    }
    assert (
        made.body_moments.density == pytest.approx(7820.0)
        and made.body_moments.material == "Steel, Carbon"
    )
    made.body_moments.density = 10.0
    assert made.body_moments.material == ""
    with pytest.raises(RuntimeError, match="No local material “Nothing”"):
        bpy.ops.material.body_moments_set_density(material="Steel, Carbon", target="Nothing")


def test_object_of_placed_density_is_not_snapped(capfd):
    obj = by_polynomial(add(box()), "1000 + 20*z")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    for operator in (
        bpy.ops.object.body_moments_origin_to_center,
        bpy.ops.object.body_moments_axes_to_principal,
    ):
        place = obj.matrix_world.copy()
        operator()
        assert str(finding("density_coordinates", frame="object")) in capfd.readouterr().out
        assert obj.matrix_world == place
    obj.body_moments.density_frame = "WORLD"
    center = measure(obj).mass_properties.center
    assert bpy.ops.object.body_moments_origin_to_center() == {"FINISHED"}
    assert np.allclose(obj.location, center, atol=1e-6)
    assert np.allclose(measure(obj).mass_properties.center, center, atol=1e-6)
    place = obj.matrix_world.copy()
    bpy.ops.object.body_moments_align_to_world()
    assert (
        str(finding("density_coordinates", frame="world")) in capfd.readouterr().out
        and obj.matrix_world == place
    )


def test_command_line_density_overrides_materials(tmp_path):
    dumbbell()
    path = batch_files.save(tmp_path / "dumbbell.blend")
    entry = batch_files.measured(path)
    assert entry["mass"] == pytest.approx(STEEL + CORK, rel=1e-13)
    assert entry["density_from"] == "materials: Cork 240 kg/m³, Steel 7820 kg/m³"
    entry = batch_files.measured(path, "--density", "10")
    assert entry["mass"] == pytest.approx(20.0, rel=1e-13) and "density_from" not in entry
    assert batch_files.measured(path, "--mass", "7")["mass"] == pytest.approx(7.0)
    batch_files.measured(path, "--density", "10", "--write")
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.data.objects["Box"].body_moments.density_from == "VALUE"
    assert measure(bpy.data.objects["Box"]).mass_properties.mass == pytest.approx(20.0)


@pytest.mark.parametrize("order", [None, 3, 5])
def test_open_body_of_uniform_sources_has_equal_moments(order):
    """By one material, by a polynomial that is one number, and by one value; closed to the same
    point.
    """
    points = np.random.default_rng(0).uniform(1.0, 2.0, (7, 3)).tolist()
    faces = [(0, 1, 2), (1, 3, 2), (2, 3, 4), (3, 5, 4), (4, 5, 6), (0, 2, 6), (2, 5, 6)]
    found = []
    for source in ("VALUE", "MATERIALS", "POLYNOMIAL"):
        obj = add({"points": points, "faces": faces})
        by_material(obj, bpy.data.materials.get("Cork") or material("Cork", CORK))
        settings = obj.body_moments
        settings.density_from, settings.density_polynomial, settings.density = (
            source,
            str(CORK),
            CORK,
        )
        bpy.context.view_layer.update()
        found.append(
            measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(order=order))
        )
    plain = found[0].volume_moments
    assert str(found[0].method) == "open"
    for varied in found[1:]:
        mass = varied.higher_mass or varied.mass_moments[0]
        assert mass.order == (order or 3) and (varied.higher_mass is not None) == (order == 5)
        moments = mass.about_point(plain.about).truncate(plain.order)
        apart = np.abs(moments.raw - CORK * plain.truncate(moments.order).raw).max()
        assert apart <= 1e-9 * CORK * np.abs(plain.raw).max()
        assert close(varied.mass_properties.mass, CORK * found[0].volume, rel=1e-12)


def test_shell_ignores_negative_density_inside():
    obj = by_polynomial(
        add(box((-1, -1, 0), (1, 1, 2))), "(z - 1)**2 + x**2 + y**2 - 0.02", "WORLD"
    )
    with pytest.raises(MeasureError) as caught:
        measure(obj)
    assert caught.value.finding.values["frame"] == "world"
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    assert measure(obj).mass_properties.mass > 0.0
    obj.body_moments.density_polynomial = "1 - x"
    obj.body_moments.thickness = 0.0
    with refused("zero_quantity"):  # before it is weighed
        measure(by_polynomial(obj, "x", "WORLD"))
