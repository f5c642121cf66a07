# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From an object to its numbers: closed forms through every transform, kind, unit and overlap, and
nothing touched.
"""

from fractions import Fraction

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies import union

from tests.blender.findings import refused, said
from tests.blender.measured_boxes import add, box, collection_of, measure
from tests.close import close
from tests.core.bodies import bar

pytestmark = pytest.mark.usefixtures("scene")


def world(obj):
    return np.array(obj.matrix_world, np.float64)


TRANSFORMS = {
    "plain": {},
    "moved": {"location": (100, -200, 300)},
    "turned": {"rotation_euler": (0.3, 0.5, -1.0)},
    "uneven": {"scale": (2, 0.5, 3), "rotation_euler": (0.1, 0.2, 0.3)},
    "mirrored": {"scale": (-1, 1, 1), "location": (1, 2, 3)},
    "tiny": {"scale": (1e-6, 1e-6, 1e-6)},
    "huge": {"scale": (1e6, 1e6, 1e6)},
}


@pytest.mark.parametrize("name", TRANSFORMS)
def test_a_box_is_exact_through_every_transform(name):
    """The truth is the affine law on the box's exact moments with the matrix that Blender holds."""
    obj = add(box(), **TRANSFORMS[name])
    matrix = world(obj)
    linear, volume = matrix[:3, :3], 6.0 * abs(np.linalg.det(matrix[:3, :3]))
    second = linear @ np.diag([1 / 12, 4 / 12, 9 / 12]) @ linear.T * volume * 1000.0
    found = measure(obj)
    body = found.mass_properties
    assert str(found.method) == "exact" and not found.findings
    assert close(found.volume, volume, rel=1e-13)
    assert abs(found.volume - volume) <= found.error_bound["volume"] + 1e-15 * volume
    center = linear @ (0.5, 1.0, 1.5) + matrix[:3, 3]
    assert np.allclose(body.center, center, rtol=0, atol=1e-13 * np.abs(center).max())
    inertia = np.trace(second) * np.eye(3) - second
    assert np.allclose(body.inertia, inertia, rtol=0, atol=1e-13 * np.trace(second))
    axes = body.principal.axes
    assert np.linalg.det(axes) == pytest.approx(1.0, abs=1e-12)
    assert np.allclose(
        axes.T @ inertia @ axes, np.diag(body.principal.moments), atol=1e-12 * np.trace(second)
    )
    faces = linear @ np.diag([1, 2, 3])
    area = 2 * sum(np.linalg.norm(np.cross(faces[:, i], faces[:, (i + 1) % 3])) for i in range(3))
    assert abs(found.area - area) <= found.error_bound["area"] + found.error_bound["input"]["area"]


def test_shear_from_a_parent_is_measured():
    parent = add(box(), name="Parent", scale=(3, 1, 1))
    child = add(box((0, 0, 0), (1, 1, 1)), name="Child", rotation_euler=(0, 0, 0.7))
    child.parent = parent
    bpy.context.view_layer.update()
    linear = world(child)[:3, :3]
    assert abs(linear.T @ linear - np.diag(np.diag(linear.T @ linear))).max() > 0.1  # it is sheared
    found = measure(child)
    assert close(found.volume, abs(np.linalg.det(linear)), rel=1e-13)
    sides = [np.linalg.norm(np.cross(linear[:, i], linear[:, (i + 1) % 3])) for i in range(3)]
    assert found.area == pytest.approx(2 * sum(sides), rel=1e-6)


def test_the_object_frame_has_unit_scale():
    obj = add(box(), scale=(2, 2, 2), location=(5, 6, 7), rotation_euler=(0, 0, np.pi / 2))
    local = measure(obj).in_object_frame()
    assert np.allclose(local.center, (1, 2, 3), atol=1e-6)
    assert np.allclose(np.diag(local.inertia), np.array([52, 40, 20]) / 12 * 48 * 1000, rtol=1e-6)


@pytest.mark.parametrize("unit", [0.001, 0.3048, 1.0, 1000.0])
def test_numbers_are_si_at_every_unit_scale(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    found = measure(add(box()), density=2.0)
    body = found.mass_properties
    assert close(found.volume, 6 * unit**3, rel=1e-13)
    assert close(found.area, 22 * unit**2, rel=1e-12)
    assert close(body.center, np.array([0.5, 1, 1.5]) * unit, rel=1e-13)
    assert close(np.diag(body.inertia), np.array([13, 10, 5]) * unit**5, rel=1e-12)


def test_a_shell_has_the_mass_of_its_sheet():
    found = measure(add(box((0, 0, 0), (1, 1, 1))), kind="shell", thickness=0.01, density=1000.0)
    assert str(found.method) == "shell" and not found.findings
    assert found.mass_properties.mass == pytest.approx(60.0, rel=1e-13)
    # a hollow cube of side s has I = 5/18 m s²
    assert close(np.diag(found.mass_properties.inertia), 60.0 * 5 / 18, rel=1e-12)


def test_an_unevenly_scaled_shell_is_measured_as_it_lies():
    even = measure(add(box((0, 0, 0), (1, 2, 3))), kind="shell", thickness=0.01)
    uneven = measure(add(box((0, 0, 0), (1, 1, 1)), scale=(1, 2, 3)), kind="shell", thickness=0.01)
    assert uneven.area == pytest.approx(even.area, rel=1e-12)
    assert np.allclose(
        uneven.mass_properties.inertia, even.mass_properties.inertia, rtol=1e-12, atol=1e-12
    )


def test_overlapping_shells_are_summed_with_a_warning_or_united():
    obj = add(box((0, 0, 0), (1, 1, 1)), box((0.5, 0, 0), (1.5, 1, 1)))
    signed, united = measure(obj), measure(obj, overlap="union")
    assert signed.volume == pytest.approx(2.0) and signed.health.overlapping_components
    assert said(signed) == {"components_overlap": {"count": 2}} and "union_by_boolean" in said(
        united
    )
    assert str(united.method) == "union" and united.volume == pytest.approx(1.5, rel=1e-6)
    assert np.allclose(
        np.diag(united.mass_properties.inertia),
        np.array([0.25, 0.40625, 0.40625]) * 1000,
        rtol=1e-5,
    )
    assert united.health.overlapping_components  # the input's


@pytest.mark.parametrize("solver", ["MANIFOLD", "EXACT"])
@pytest.mark.parametrize("scale", [1.0, (-1e-3, 2e-3, 1e-3)])
def test_union_of_many_shells_has_exact_volume_and_area(solver, scale, monkeypatch):
    if solver == "EXACT":  # as in a Blender that was built without the other solver
        monkeypatch.setattr(union, "_by_manifold", lambda layers: None)
    obj = add(
        box((0, 0, 0), (2, 2, 2)),
        box((1, 1, 1), (3, 3, 3)),
        box((0.25, 0.25, 0.25), (0.75, 0.75, 0.75)),  # within the first
        box((10, 10, 10), (11, 11, 11)),
        box((11, 10, 10), (12, 11, 11)),  # touches the one before
        box((20, 20, 20), (23, 23, 23)),
        box((21, 21, 21), (22, 22, 22), turned=True),  # its cavity
        box((21.5, 21.25, 21.25), (24, 21.75, 21.75)),  # from there through the wall
        box((30, 0, 0), (31, 1, 1)),
        scale=np.broadcast_to(scale, 3),
    )
    found = measure(obj, overlap="union")
    assert close(found.volume, 44.375 * np.prod(np.abs(scale) * np.ones(3)), 1e-6)
    if scale == 1.0:
        assert close(found.area, 42.0 + 10.0 + 63.0 + 6.0, 1e-6)
    assert str(found.method) == "union" and found.health.closed


def test_distant_brick_is_exact_within_input_bound():
    """The truth of the stored coordinates in rationals; the 5 cm that were meant lie within the
    input bound.
    """
    obj = add(box((1000.0, 1000.0, 0.0), (1000.05, 1000.05, 0.05)))
    found = measure(obj)
    points = np.array([vertex.co[:] for vertex in obj.data.vertices])
    low, high = points.min(axis=0), points.max(axis=0)
    stored = [Fraction(float(h)) - Fraction(float(a)) for a, h in zip(low, high)]
    assert close(found.volume, float(stored[0] * stored[1] * stored[2]), rel=1e-13)
    assert (
        1e-13 < abs(found.volume - 0.05**3) < found.error_bound["input"]["volume"] < 0.1 * 0.05**3
    )


def test_measuring_changes_nothing():
    obj = add(box())
    obj.modifiers.new("", "SUBSURF")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    points = np.array([vertex.co[:] for vertex in obj.data.vertices])
    kinds = ("objects", "meshes", "scenes", "collections", "node_groups")
    before = [len(getattr(bpy.data, kind)) for kind in kinds]
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    assert np.array_equal(points, [vertex.co[:] for vertex in obj.data.vertices])
    assert [len(getattr(bpy.data, kind)) for kind in kinds] == before
    assert obj.select_get() and bpy.context.object == obj and obj.mode == "OBJECT"


def test_zero_scale_and_zero_density_are_refused():
    flat = add(box(), scale=(1, 1, 0))
    with refused("zero_scale"):
        measure(flat)
    weightless = add(box())
    weightless.body_moments.density = 0.0
    with refused("zero_quantity"):
        measure(weightless)


def test_principal_frames_of_copies_turn_with_the_copies():
    l_prism = (box((0, 0, 0), (3, 1, 1)), box((0, 1, 0), (1, 4, 1)), box((0, 0, 1), (1, 1, 2.5)))
    first = measure(add(*l_prism))
    second = measure(add(*l_prism, rotation_euler=(1.0, 2.0, 3.0), location=(7, 8, 9)))
    turn = second.rotation
    assert np.allclose(
        turn.T @ second.mass_properties.principal.axes,
        first.mass_properties.principal.axes,
        atol=1e-5,
    )
    assert np.allclose(
        second.in_object_frame().inertia, first.in_object_frame().inertia, rtol=1e-5, atol=1e-2
    )


def test_members_of_a_collection_are_compared_with_each_other():
    unit = box((0, 0, 0), (1, 1, 1))
    apart = measure(collection_of(add(unit), add(unit, location=(3, 0, 0))))
    assert apart.volume == pytest.approx(2.0) and not apart.findings
    both = collection_of(add(unit), add(unit, location=(0.5, 0, 0)))
    overlapping = measure(both)
    assert overlapping.volume == pytest.approx(2.0) and overlapping.health.overlapping_components
    assert said(overlapping) == {"components_overlap": {"count": 2}}
    sheets = measure(both, kind="shell", thickness=0.01)
    assert not sheets.findings and not sheets.health.overlapping_components


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (1e-4, 2e-4, 1e-4)])
def test_a_cavity_is_one_within_its_own_mesh_only(scale):
    """The part inside is measured as outward, whichever way its faces look."""
    housing, insert, volume = (
        box((0, 0, 0), (2, 2, 2)),
        {"low": (0.5, 0.5, 0.5), "high": (1.5, 1.5, 1.5)},
        abs(np.prod(scale)),
    )
    for turned in (False, True):
        name = "Turned insert" if turned else "Insert"
        part = add(box(**insert, turned=turned), name=name, scale=scale)
        members = (add(housing, name="Housing", scale=scale), part)
        found = measure(collection_of(*members))
        assert close(found.volume, 9.0 * volume, rel=1e-6)
        assert str(found.method) == ("reoriented" if turned else "exact")
        expected = (
            {"inverted_components": {"count": 1, "total": 1, "sources": [name]}} if turned else {}
        )
        nested = {"components_nested": {"count": 1}}
        assert said(found) == {**expected, **nested}
        assert found.health.nested_components == 1 and not found.health.cavities
        (inside,) = [one for one in found.findings if one.code == "components_nested"]
        assert inside.elements == [[face, name] for face in range(6)]
    hollow = add(housing, box(**insert, turned=True), name="Hollow", scale=scale)
    found = measure(hollow)
    assert close(found.volume, 7.0 * volume, rel=1e-6) and said(found) == {
        "cavities_subtracted": {"count": 1}
    }


def test_body_in_cavity_of_another_is_not_nested():
    hollow = add(box((0, 0, 0), (4, 4, 4)), box((1, 1, 1), (3, 3, 3), turned=True), name="Hollow")
    found = measure(collection_of(hollow, add(box((1.5, 1.5, 1.5), (2.5, 2.5, 2.5)), name="Core")))
    assert close(found.volume, 57.0, rel=1e-12)
    assert said(found) == {"cavities_subtracted": {"count": 1, "sources": ["Hollow"]}}
    hollow = add(box((0, 0, 0), (4, 4, 4)), box((1, 1, 1), (3, 3, 3), turned=True))
    found = measure(collection_of(hollow, add(box((1.5, 1.5, 1.5), (3.5, 2.5, 2.5)))))
    assert close(found.volume, 58.0, rel=1e-12)
    assert said(found)["components_overlap"] == {"count": 2}


def test_touching_instances_are_not_called_overlapping():
    unit = box((0, 0, 0), (1, 1, 1))
    found = measure(collection_of(*(add(unit, location=(i, 0, 0)) for i in range(5))))
    assert found.volume == pytest.approx(5.0) and not found.findings


def test_ground_below_instances_adds_no_volume():
    ground = {"points": [(x, y, 0) for x in (-9, 9) for y in (-9, 9)], "faces": [(0, 2, 3, 1)]}
    boxes = [add(box((0, 0, 1), (1, 1, 2)), location=(i, 0, 0)) for i in (0, 3)]
    found = measure(collection_of(add(ground), *boxes))
    assert str(found.method) == "exact" and found.volume == pytest.approx(2.0)
    assert found.area == pytest.approx(18.0**2 + 12.0)
    assert said(found)["flat_surfaces"] == {"count": 1, "total": 3} and not found.health.closed


def test_faces_without_area_are_not_sent_from_solid_to_shell():
    line = {"points": [(0, 0, 0), (1, 0, 0), (2, 0, 0)], "faces": [(0, 1, 2)]}
    for kind in ("solid", "shell"):
        with refused("no_face_area"):
            measure(add(line), kind=kind)


def test_union_of_a_sheet_is_refused():
    sheet = {"points": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], "faces": [(0, 1, 2, 3)]}
    with refused("no_volume"):
        measure(add(sheet), overlap="union")


def test_body_of_negative_inertia_is_refused():
    outline = [(1, -1), (1, 1), (-0.04, -0.04), (-10, -0.04), (-10, 0.04), (-0.04, 0.04)]
    points = [(x, y, z) for z in (0, 1) for x, y in outline] + [(0.3, 0, 0), (0.3, 0, 1)]
    n = len(outline)
    faces = [(i, (i + 1) % n, (i + 1) % n + n, i + n) for i in range(n)]
    faces += [
        face
        for i in range(n)
        for face in (((i + 1) % n, i, 2 * n), (i + n, (i + 1) % n + n, 2 * n + 1))
    ]
    with refused("negative_inertia"):
        measure(add({"points": points, "faces": faces}))


def test_a_thin_plate_keeps_its_axes_apart():
    """What float32 leaves of its thickness says nothing of the moments in its plane."""
    turn = (0.3, 0.5, 0.7)
    found = measure(add(box((0, 0, 0), (1, 2, 1e-5)), rotation_euler=turn)).mass_properties
    assert found.principal.symmetry == "asymmetric"
    axes = found.principal.axes
    assert np.allclose(
        axes.T @ found.inertia @ axes,
        np.diag(found.principal.moments),
        atol=1e-9 * found.inertia.max(),
    )


def test_input_bounds_are_finite_for_far_and_uneven_bodies():
    far = measure(
        add(box((2e6, 4e6, 4e6), (2e6 + 1, 4e6 + 1, 4e6 + 1))), kind="shell", thickness=0.01
    )
    assert not np.isnan(
        [far.error_bound["input"][name] for name in far.error_bound["input"] if name != "input"]
    ).any()
    uneven = measure(
        add(box((1 / 3,) * 3, (4 / 3,) * 3), scale=(1, 2, 3)), kind="shell", thickness=0.01
    )
    assert abs(uneven.area - 22.0) < uneven.error_bound["input"]["area"] < 1e-4
    assert uneven.error_bound["input"]["inertia"] > 0.0


def test_the_bound_of_a_union_covers_blenders_rounding():
    obj = add(box((0, 0, 0), (1, 1, 1)), rotation_euler=(0.3, 0.5, 0.7))
    found = measure(obj, overlap="union")
    assert (
        abs(found.volume - abs(np.linalg.det(world(obj)[:3, :3])))
        < found.error_bound["input"]["volume"]
        < 1e-5
    )


def test_a_unit_scale_is_used_in_double_precision():
    foot = 0.3048006096012192
    assert close(measure(add(box()), unit_scale=foot).volume, 6 * foot**3, rel=1e-13)
    assert close(measure(add(box()), unit_scale=1e-10).volume, 6e-30, rel=1e-13)


def test_inverted_or_open_body_is_repaired_before_union():
    assert measure(add(box(turned=True)), overlap="union").volume == pytest.approx(6.0, rel=1e-6)
    open_box = box((0, 0, 0), (1, 1, 1))
    open_box["faces"] = open_box["faces"][:-1]
    found = measure(add(open_box), overlap="union")
    assert found.volume == pytest.approx(1.0, rel=1e-6) and "holes_capped" in said(found)


@pytest.mark.parametrize("bevel", [0.0, 0.01])
def test_every_letter_is_closed(bevel):
    text = bpy.data.curves.new("Text", "FONT")
    text.extrude, text.bevel_depth = 0.1, bevel
    # k's bevels overlap
    text.body = "ABCDEFGHIJKLMNOPQRSTUVWXYZ\nabcdefghijlmnopqrstuvwxyz\n0123456789&@%é"
    obj = bpy.data.objects.new("Text", text)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    found = measure(obj)
    assert str(found.method) == "exact" and found.health.closed
    if not bevel:
        mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        front = sum(face.area for face in mesh.polygons if face.center.z > 0.0999)
        assert found.volume == pytest.approx(0.2 * front, rel=1e-6)


def test_self_crossing_bar_is_found_and_monkey_is_not():
    bpy.ops.mesh.primitive_monkey_add()
    assert not [code for code in said(measure(bpy.context.object)) if code.startswith("self_")]
    bent = bar(1.25)
    part = add({"points": bent[0].tolist(), "faces": bent[1].tolist()})
    signed, united = measure(part), measure(part, overlap="union")
    share = said(signed)["self_intersection"]["share"]
    assert 0.15 < share < 0.25 and signed.health.self_intersection == "found"
    assert close(united.volume, 0.8 * signed.volume, rel=0.01) and "union_by_boolean" in said(
        united
    )


@pytest.mark.filterwarnings("error")
def test_bodies_at_range_ends_are_exact_or_refused():
    large, small = (add(box((0, 0, 0), (size,) * 3), scale=(size,) * 3) for size in (1e30, 1e-35))
    sides = [np.float64(np.float32(size)) ** 2 for size in (1e30, 1e-35)]
    found = measure(large)
    assert (
        close(found.volume, sides[0] ** 3, 1e-15)
        and np.isfinite(found.mass_properties.inertia).all()
    )
    with refused("object_size"):
        measure(small)
    for obj in (large, small):
        obj.select_set(True)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    assert close(large["body_volume"], sides[0] ** 3, 1e-15) and "body_volume" not in small


def test_united_instances_have_no_coordinates_of_their_own():
    unit = box((0, 0, 0), (1, 1, 1))
    obj = collection_of(add(unit), add(unit, location=(0.5, 0, 0)))
    settings = obj.body_moments
    settings.overlap, settings.density_from, settings.density_polynomial = (
        "UNION",
        "POLYNOMIAL",
        "100 + 10*x",
    )
    settings.density_frame = "WORLD"
    assert measure(obj).mass_properties.mass == pytest.approx(100 * 1.5 + 10 * 1.5**2 / 2, rel=1e-6)
    settings.density_frame = "OBJECT"
    with refused("union_lacks", obj.name):
        measure(obj)
