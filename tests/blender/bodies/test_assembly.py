# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies add up what their members weigh, each once, wherever it stands; what is given counts
as given.
"""

from fractions import Fraction

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.assembly.measure import measure_assembly
from body_moments.blender.read.assembly import MemberKind
from body_moments.blender.read.visibility import measurable_objects
from body_moments.core.verdict import MeasureError
from mathutils import Matrix

from tests.blender.boxes import box, boxes_inertia, collection, empty
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add
from tests.blender.objects import measured as measured_object
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered", "scene")


def measured(root):
    bpy.context.view_layer.update()
    return measure_assembly(root, bpy.context.evaluated_depsgraph_get())


BOXES = [
    (7850, (1, 2, 4), (8, 0, -2)),
    (1000, (2, 2, 2), (-4, 6, 1)),
    (2700, (0.5, 8, 0.25), (0, -16, 32)),
]


def test_nested_collections_total_by_exact_parallel_axes():
    root = collection()
    inner = collection("Inner", root)
    for number, (density, size, at) in enumerate(BOXES):
        box(inner if number else root, size, at, density, f"b{number}")
    assembly = measured(root)
    mass, center, tensor = boxes_inertia(BOXES)
    body = assembly.measurement.mass_properties
    assert close(body.mass, mass, 1e-14) and close(body.center, center, 1e-14)
    assert np.abs(body.inertia - tensor).max() <= 1e-14 * np.abs(tensor).max()
    assert np.abs(body.inertia - tensor).max() <= body.rounding_error["inertia"]
    assert (
        str(assembly.measurement.method) == "assembly" and assembly.measurement.type == "COLLECTION"
    )
    assert assembly.measurement.health.closed and assembly.measurement.health.components == 3
    bound, own = (
        assembly.measurement.error_bound,
        [
            part.measurement.error_bound
            for part in assembly.root.walk()
            if part.measurement is not None
        ],
    )
    for name in ("volume", "area"):
        members, value = sum(one[name] for one in own), getattr(assembly.measurement, name)
        assert len(own) == 3 and 0.0 < members < bound[name] < members + 2.0**-50 * value
        assert close(bound["input"][name], sum(one["input"][name] for one in own), 1e-12)
    (nested,) = [part for part in assembly.root.parts if part.member.name == "Inner"]
    assert close(nested.mass.total, 1000 * 8 + 2700, 1e-14)


def test_an_object_in_two_collections_counts_once():
    root = collection()
    first, second = collection("First", root), collection("Second", root)
    obj = box(first, (1, 1, 1))
    second.objects.link(obj)
    root.objects.link(obj)
    assembly = measured(root)
    assert close(assembly.measurement.mass_properties.mass, 1000.0, 1e-14)
    (found,) = [
        found for found in assembly.measurement.findings if found.code == "members_counted_before"
    ]
    assert found.values["count"] == 2


def test_hidden_and_excluded_members_are_findings():
    root = collection()
    box(root, (1, 1, 1), name="Shown")
    box(root, (1, 1, 1), name="NotRendered").hide_render = True
    box(root, (1, 1, 1), name="Disabled").hide_viewport = True
    hidden = box(root, (1, 1, 1), name="Hidden")
    excluded = collection("Excluded", root)
    box(excluded, (1, 1, 1), name="InExcluded")
    layer = bpy.context.view_layer.layer_collection.children[root.name].children["Excluded"]
    layer.exclude = True
    hidden.hide_set(True)
    lines = bpy.data.meshes.new("Lines")
    lines.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    root.objects.link(bpy.data.objects.new("Lines", lines))
    assembly = measured(root)
    assert close(assembly.measurement.mass_properties.mass, 2000.0, 1e-14)
    values = {found.code: found.values for found in assembly.measurement.findings}
    assert values["members_left_out"] == {"count": 1, "names": ["NotRendered"]}
    assert values["members_hidden"] == {"count": 1, "names": ["Hidden"]}
    assert values["members_excluded"]["count"] == 2
    assert sorted(values["members_excluded"]["names"]) == ["Disabled", "InExcluded"]
    assert values["members_not_measured"] == {"count": 1, "names": ["Lines"]}


def test_an_empty_with_its_children_is_a_body_in_its_own_frame():
    root = empty(bpy.context.scene.collection, "Root", (1, 2, 3))
    root.rotation_euler = (0.3, 0.5, 0.7)
    inner = empty(bpy.context.scene.collection, "Inner")
    inner.parent = root
    first = box(bpy.context.scene.collection, (1, 2, 4), (1, 0, 0), name="first")
    second = box(bpy.context.scene.collection, (2, 2, 2), (0, 5, 0), 2000.0, name="second")
    third = box(bpy.context.scene.collection, (1, 1, 1), (0, 0, 9), name="third")
    first.parent, second.parent, third.parent = root, inner, first
    assembly = measured(root)
    body = assembly.measurement.mass_properties
    assert close(body.mass, 8000 + 16000 + 1000, 1e-6)  # the matrices are float32
    local = assembly.measurement.in_object_frame()
    mass, center, tensor = boxes_inertia(
        [(1000, (1, 2, 4), (1, 0, 0)), (2000, (2, 2, 2), (0, 5, 0)), (1000, (1, 1, 1), (1, 0, 9))]
    )
    assert np.abs(local.center - center).max() < 1e-6 * np.abs(center).max()
    assert np.abs(local.inertia - tensor).max() < 1e-6 * np.abs(tensor).max()
    assert assembly.measurement.type == "EMPTY"
    bpy.context.scene.unit_settings.scale_length = 0.1
    local = measured(root).measurement.in_object_frame()
    assert np.abs(local.center - 0.1 * center).max() < 1e-6 * np.abs(center).max()


def test_an_instance_weighs_as_its_members_do_wherever_it_stands():
    parts = collection("Motor")
    box(parts, (1, 2, 4), (1, 0, 0), 7850.0, "steel")
    weighed = box(parts, (1, 1, 1), (0, 3, 0), name="weighed")
    weighed.body_moments.mass_from, weighed.body_moments.mass = "MASS", 4.0
    parts.instance_offset = (0, 0, 1)
    bpy.context.view_layer.layer_collection.children["Motor"].exclude = True
    root = collection()
    made = empty(root, "Instance", (10, 20, 30))
    made.instance_type, made.instance_collection = "COLLECTION", parts
    made.matrix_world = Matrix.Translation((10, 20, 30)) @ Matrix.Diagonal((2, 2, 2, 1))
    assembly = measured(root)
    steel = 7850 * 8 * 8
    body = assembly.measurement.mass_properties
    assert close(body.mass, steel + 4.0, 1e-13)
    center = (steel * np.array([12, 20, 28]) + 4.0 * np.array([10, 26, 28])) / (steel + 4.0)
    assert close(body.center, center, 1e-12)
    assert close(assembly.measurement.volume, 72.0, 1e-12) and close(
        assembly.measurement.area, 4 * 34, 1e-12
    )
    _, _, tensor = boxes_inertia(
        [(7850, (2, 4, 8), (12, 20, 28)), (Fraction(4, 8), (2, 2, 2), (10, 26, 28))]
    )
    assert np.abs(body.inertia - tensor).max() <= 1e-12 * np.abs(tensor).max()
    bound = assembly.measurement.error_bound
    made.scale = (1, 1, 1)
    plain = measured(root).measurement.error_bound
    for found, own in ((bound, plain), (bound["input"], plain["input"])):
        assert close(found["volume"], 8.0 * own["volume"], 1e-9) and close(
            found["area"], 4.0 * own["area"], 1e-9
        )
    made.scale = (2, 2, 2)
    made.body_moments.density = 500.0  # its own density: one body
    assert close(measured(root).measurement.mass_properties.mass, 500.0 * 72.0, 1e-12)


def test_an_instance_that_stretches_has_the_area_that_it_shows():
    parts = collection("Parts")
    box(parts, (1, 1, 1), density=1.0)
    root = collection()
    made = empty(root)
    made.instance_type, made.instance_collection, made.scale = "COLLECTION", parts, (1, 2, 3)
    assembly = measured(root)
    assert close(assembly.measurement.area, 2 * (2 + 3 + 6), 1e-12)
    assert close(assembly.measurement.mass_properties.mass, 6.0, 1e-12)
    own, bound = measured_object(made).error_bound, assembly.measurement.error_bound
    assert (
        own["area"] < bound["area"] < own["area"] + 22 * 2.0**-51
        and bound["input"]["area"] == own["input"]["area"]
    )
    made.scale = (1, 1, 1)
    plain = measured(root).measurement.error_bound
    for found, first in ((bound, plain), (bound["input"], plain["input"])):
        assert first["volume"] > 0.0 and close(found["volume"], 6.0 * first["volume"], 1e-9)
    made.scale = (1, 2, 3)
    parts.objects[0].body_moments.kind = "SHELL"
    with pytest.raises(MeasureError, match="no mass|has a mass"):
        measured(root)
    box(root, (1, 2, 4))
    assembly = measured(root)
    assert close(assembly.measurement.area, 28.0, 1e-12)
    (shown,) = [part for part in assembly.root.parts if part.member.name == "Empty"]
    assert shown.refusal.code == "instance_stretches_sheets" and str(shown.refusal)
    assert (shown.masses, shown.volume[0], shown.area[0]) == ({}, 0.0, 0.0)
    (found,) = [one for one in assembly.measurement.findings if one.code == "members_not_measured"]
    assert found.values == {"count": 1, "names": ["Empty"]}


def test_bought_part_has_given_mass_center_and_inertia():
    root = collection()
    part = collection("Bought", root)
    box(part, (1, 2, 4), (3, 0, 0), name="case")
    part.body_moments.mass_from, part.body_moments.mass = "MASS", 2.5
    body = measured(root).measurement.mass_properties
    _, _, tensor = boxes_inertia([(Fraction(5, 16), (1, 2, 4), (3, 0, 0))])
    assert (
        close(body.mass, 2.5, 1e-14) and np.abs(body.inertia - tensor).max() <= 1e-14 * tensor.max()
    )
    assert close(body.center[0], 3.0, 1e-14)
    part.body_moments.use_center, part.body_moments.given_center = True, (2.5, 0.25, 0)
    part.body_moments.use_inertia = True
    part.body_moments.given_inertia_diagonal, part.body_moments.given_inertia_products = (
        (3, 4, 5),
        (0.5, 0, 0.25),
    )
    assembly = measured(root)
    body = assembly.measurement.mass_properties
    assert close(body.center, [2.5, 0.25, 0], 1e-14)
    assert np.abs(body.inertia - [[3, 0.5, 0], [0.5, 4, 0.25], [0, 0.25, 5]]).max() <= 1e-14
    told = {found.code: found.values for found in assembly.measurement.findings}
    assert told["assembly_mass_given"]["sources"] == ["Bought"]
    own = [found.code for found in measured(part).measurement.findings]
    assert own == ["assembly_mass_given", "given", "given"]
    sources = [str(measured(one).measurement.density_from) for one in (root, part)]
    assert sources == ["members", "given mass"]
    part.body_moments.given_inertia_diagonal = (1, 1, 5)
    with pytest.raises(MeasureError):
        measured(part)
    box(root, (1, 1, 1))
    assembly = measured(root)
    assert close(assembly.measurement.mass_properties.mass, 1000.0, 1e-14)
    (refusal,) = [one.refusal for one in assembly.root.walk() if one.refusal is not None]
    told = {found.code: found.values for found in assembly.measurement.findings}
    assert refusal.code == "given_inertia_impossible" and "assembly_mass_given" not in told
    assert told["members_not_measured"] == {"count": 1, "names": ["Bought"]}


@pytest.mark.parametrize("with_children", [False, True])
def test_an_empty_gives_mass_center_and_inertia_in_its_own_frame(with_children):
    bpy.context.scene.unit_settings.scale_length = 0.5
    root = empty(bpy.context.scene.collection, "Root", (2, 4, 6))
    root.rotation_euler, root.scale = (0, 0, np.pi / 2), (3, 3, 3)
    lines = bpy.data.meshes.new("Lines")
    lines.from_pydata([(0, 0, 0), (1, 0, 0)], [(0, 1)], [])
    children = [add(lines, "Lines")]
    if with_children:
        children.append(box(bpy.context.scene.collection, (2, 2, 2)))
    for child in children:
        child.parent = root
    settings = root.body_moments_assembly
    settings.mass_from, settings.mass = "MASS", 2.5
    assembly = measured(root)
    # its origin was chosen
    assert [found.code for found in assembly.root.findings] == ["assembly_mass_given"]
    body = assembly.measurement.mass_properties
    assert close(body.mass, 2.5, 1e-15) and np.abs(body.center - (1, 2, 3)).max() < 1e-6
    side = 3.0 if with_children else 0.0  # m
    assert np.abs(body.inertia - 2.5 * side**2 / 6.0 * np.eye(3)).max() < 1e-5
    settings.use_center, settings.given_center = True, (1, 0, 0)
    settings.use_inertia, settings.given_inertia_diagonal = True, (3, 4, 5)
    body = measured(root).measurement.mass_properties
    assert np.abs(body.center - (1, 2.5, 3)).max() < 1e-6
    assert np.abs(body.inertia - np.diag([4, 3, 5])).max() < 1e-5


def test_instance_mass_scales_by_kind_of_member():
    """Twice as large it has 8 times a solid's mass, 4 times a sheet's, twice a wire's, and the mass
    that is given.
    """
    root, of = collection(), bpy.data.collections.new("Of")
    sheet, weighed = box(of, (1, 1, 1), name="sheet"), box(of, (1, 1, 1), name="weighed")
    box(of, (1, 1, 1), density=1.0, name="solid")
    sheet.body_moments.kind, sheet.body_moments.thickness, sheet.body_moments.density = (
        "SHELL",
        0.5,
        10.0,
    )
    weighed.body_moments.mass_from, weighed.body_moments.mass = "MASS", 500.0
    bpy.ops.curve.primitive_bezier_circle_add()
    wire = bpy.context.object
    wire.body_moments.kind, wire.body_moments.linear_density = "WIRE", 1000.0
    bpy.context.scene.collection.objects.unlink(wire)
    of.objects.link(wire)
    shown = instance(root, of)
    length = measured_object(wire).length
    for scale in (1.0, 2.0):
        shown.scale = (scale,) * 3
        mass = 1.0 * scale**3 + 30.0 * scale**2 + 1000.0 * length * scale + 500.0
        assert close(measured(root).measurement.mass_properties.mass, mass, 1e-12)
    for obj in (wire, sheet):
        of.objects.unlink(obj)
    shown.scale = (1, 2, 3)
    assert close(measured(root).measurement.mass_properties.mass, 6.0 + 500.0, 1e-12)


def test_object_has_given_center_and_inertia():
    root = collection()
    obj = box(root, (1, 2, 4), (10, 0, 0), rotation=(0, 0, np.pi / 2))
    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.0
    obj.body_moments.use_center, obj.body_moments.given_center = True, (0.25, 0.5, 0)
    obj.body_moments.use_inertia, obj.body_moments.given_inertia_diagonal = True, (4, 1, 3.5)
    empty(root, "Ballast", (-2, 0, 0), mass=1.0)
    assembly = measured(root)
    parts = {part.member.name: part.measured.measurement for part in assembly.root.parts}
    local = parts["Box"].in_object_frame()
    assert np.abs(local.center - [0.25, 0.5, 0]).max() < 1e-6
    assert np.abs(local.inertia - np.diag([4, 1, 3.5])).max() < 1e-6
    assert close(parts["Box"].volume, 8.0, 1e-6) and close(parts["Box"].density, 3.0 / 8.0, 1e-6)
    assert (
        not parts["Ballast"].mass_properties.inertia.any()
        and str(parts["Ballast"].method) == "given"
    )
    body = assembly.measurement.mass_properties
    assert close(body.mass, 4.0, 1e-14) and close(body.center[0], (3 * 9.5 - 2) / 4, 1e-6)
    obj.body_moments.given_center = (5, 0, 0)
    bpy.context.view_layer.update()
    measurement = measured(root).root.parts[1].measured.measurement
    assert "given_center" in {found.code for found in measurement.findings}


@pytest.mark.parametrize("kind", ["NONE", "COLLECTION"])
def test_empty_without_collection_is_point_or_assembly(kind):
    """Where instancing is switched off Blender keeps the collection; with it on, none may be
    chosen.
    """
    root, shown = collection(), collection("Shown")
    box(shown, (1, 1, 1), (0, 0, 0))
    point, parent = empty(root, "Point", (1, 2, 3), mass=5.0), empty(root, "Parent")
    box(root, (1, 1, 1), (0, 0, 2), name="Child").parent = parent
    for obj in (point, parent):
        obj.instance_type, obj.instance_collection = "COLLECTION", shown if kind == "NONE" else None
        obj.instance_type = kind
    parent.body_moments_assembly.mass_from, parent.body_moments_assembly.mass = "MASS", 10.0
    bpy.context.view_layer.update()
    assembly = measured(root)
    assert {part.member.name: part.member.kind for part in assembly.root.parts} == {
        "Point": MemberKind.POINT,
        "Parent": MemberKind.EMPTY,
    }
    assert close(assembly.measurement.mass_properties.mass, 15.0, 1e-14)
    assert {obj for obj in measurable_objects(bpy.context.view_layer) if obj.type == "EMPTY"} == {
        point
    }


def test_empty_of_given_mass_stands_for_its_children():
    root = collection()
    part = empty(root, "Part", (0, 0, 2))
    child = box(root, (1, 1, 1), (0, 0, 0), name="child")
    child.parent = part
    box(root, (2, 1, 1), (4, 0, 0), name="other")
    part.body_moments_assembly.mass_from, part.body_moments_assembly.mass = "MASS", 10.0
    assembly = measured(root)
    assert close(assembly.measurement.mass_properties.mass, 2010.0, 1e-14)
    assert [part.member.name for part in assembly.root.parts] == ["Part", "other"]
    child.parent = None
    assembly = measured(root)
    assert close(assembly.measurement.mass_properties.mass, 3000.0, 1e-14)
    assert [part.member.name for part in assembly.root.parts] == ["child", "other"]


@pytest.mark.parametrize("unit", [0.001, 1.0, 1000.0])
def test_units_and_places_far_away(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    root = collection()
    far = 1024.0
    for number, (density, size, at) in enumerate(BOXES):
        box(root, size, np.array(at) + far, density, f"b{number}")
    mass, center, tensor = boxes_inertia([(d, s, [v + 1024 for v in at]) for d, s, at in BOXES])
    body = measured(root).measurement.mass_properties
    assert close(body.mass, mass * unit**3, 1e-13) and close(body.center, center * unit, 1e-13)
    assert np.abs(body.inertia - tensor * unit**5).max() <= 1e-13 * np.abs(tensor).max() * unit**5


def instance(into, of, **where):
    obj = add(None, "Instance", select=False, **where)
    obj.instance_type, obj.instance_collection = "COLLECTION", of
    for other in obj.users_collection:
        other.objects.unlink(obj)
    into.objects.link(obj)
    return obj


def test_flattened_or_stretched_instances_add_nothing(tmp_path):
    root, of = collection(), bpy.data.collections.new("Of")
    box(root, (1, 2, 4))
    box(of, (1, 1, 1))
    shown = instance(root, of, location=(5, 0, 0), scale=(2, 2, 2))
    assert close(measured(root).measurement.mass_properties.mass, 16000.0, 1e-12)

    def adds_nothing(scale, code):
        shown.scale = scale
        assembly = measured(root)
        assert close(assembly.measurement.mass_properties.mass, 8000.0, 1e-12)
        assert close(assembly.measurement.volume, 8.0, 1e-12) and close(
            assembly.measurement.area, 28.0, 1e-12
        )
        (refused,) = [part for part in assembly.root.walk() if part.refusal]
        assert (refused.refusal.code, refused.masses, refused.volume[0]) == (code, {}, 0.0)

    adds_nothing((2, 0, 2), "scale_zero_axis")
    for obj in list(of.objects):
        of.objects.unlink(obj)
    cloud = volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((2, 2, 2), np.float32)))
    bpy.context.scene.collection.objects.unlink(cloud)
    of.objects.link(cloud)
    shown.scale = (2, 2, 2)
    assert close(measured(root).measurement.mass_properties.mass, 8000.0 + 64.0, 1e-6)
    adds_nothing((1, 2, 3), "only_without_surface")


def test_instance_leaves_out_operands_and_unrendered_members():
    """Whole nested collections as well, turned off in renders or in viewports."""
    root, of = collection(), bpy.data.collections.new("Of")
    box(root, (1, 2, 4))
    body = box(of, (2, 2, 2))
    cutter = box(of, (1, 1, 1), name="Cutter")
    cutter.display_type = "WIRE"
    inner = bpy.data.collections.new("Inner")
    of.children.link(inner)
    box(inner, (1, 1, 2), name="Extra")
    shown = instance(root, of, location=(5, 0, 0))
    assert close(
        measured(root).measurement.mass_properties.mass, 8000.0 + 8000.0 + 1000.0 + 2000.0, 1e-12
    )
    modifier = body.modifiers.new("Cut", "BOOLEAN")
    modifier.object, modifier.show_viewport, modifier.show_render = cutter, True, True
    for display, left in (("WIRE", True), ("BOUNDS", True), ("TEXTURED", False)):
        cutter.display_type = display
        assembly = measured(root)
        reasons = {
            part.member.name: part.member.left_out.code
            for part in assembly.root.walk()
            if part.member.left_out
        }
        assert reasons == ({"Cutter": "boolean_operand"} if left else {})
    cutter.display_type = "WIRE"
    for name in ("hide_render", "hide_viewport"):
        setattr(inner, name, True)
        assembly = measured(root)
        reasons = {
            part.member.name: part.member.left_out.code
            for part in assembly.root.walk()
            if part.member.left_out
        }
        assert reasons == {"Cutter": "boolean_operand", "Inner": "not_rendered"}
        assert close(assembly.measurement.mass_properties.mass, 8000.0 + 7000.0, 1e-6)
        setattr(inner, name, False)
    assert shown.name == "Instance"
