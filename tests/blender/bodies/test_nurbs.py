# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface objects: Blender's evaluation reproduced, and bodies measured from their control
points.
"""

from itertools import product

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_body import measure_body
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.session import memory
from body_moments.blender.session.live import measuring as live
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.measurement.record import record
from body_moments.core.moments.exponents import monomials
from body_moments.core.nurbs import Patch, blender_space, display_parameters, display_table
from body_moments.core.verdict import Source

from tests.blender.findings import refused, said
from tests.blender.objects import add, measured, only, place
from tests.blender.spline_bodies import surface
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

BALL = 4.0 * np.pi / 3.0
# what the rounding of the primitive's control points and weights leaves of a ball
STORED = 1.0 - 1.95e-7


def primitive(name):
    getattr(bpy.ops.surface, "primitive_nurbs_surface_{:s}_add".format(name))()
    return bpy.context.object


def shown(obj):
    """(n, 3) the vertices of its display mesh."""
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co for vertex in mesh.vertices], np.float64).reshape(-1, 3)


SPACE = ("point_count_", "order_", "use_cyclic_", "use_bezier_", "use_endpoint_")
FLAGS = list(product((False, True), repeat=3))


@pytest.mark.parametrize("along_u", FLAGS)
def test_display_mesh_is_reproduced_for_all_spline_flags(along_u):
    """Every flag of u with every flag of v; the orders 2 to 6 in turn; invalid ones show nothing,
    as predicted.
    """
    rng = np.random.default_rng(FLAGS.index(along_u))
    valid = 0
    for number, along_v in enumerate(FLAGS * 4):
        count_u, count_v = rng.integers(3, 11, 2)
        orders = [int(rng.integers(2, min(6, count) + 1)) for count in (count_u, count_v)]
        points = rng.uniform(-1.0, 1.0, (count_v, count_u, 3)).astype(np.float32)
        weights = rng.uniform(0.3, 2.0, points.shape[:2]).astype(np.float32) if number % 2 else None
        cyclic, bezier, endpoint = zip(along_u, along_v)
        obj = surface(
            points,
            weights,
            orders=orders,
            cyclic=cyclic,
            bezier=bezier,
            endpoint=endpoint,
            resolution=rng.integers(1, 5, 2).tolist(),
        )
        (spline,) = obj.data.splines
        assert [spline.order_u, spline.order_v] == orders
        vertices = shown(obj)
        spaces = tuple(
            blender_space(*(getattr(spline, name + direction) for name in SPACE))
            for direction in "vu"
        )
        if None in spaces:
            assert not len(vertices)
        else:
            valid += 1
            tables = [
                display_table(space, display_parameters(space, resolution))
                for space, resolution in zip(spaces, (spline.resolution_v, spline.resolution_u))
            ]
            found = (
                Patch(spaces, points, weights).apply_weights(*tables).swapaxes(0, 1).reshape(-1, 3)
            )
            assert np.abs(found - vertices).max() <= 2e-6
        bpy.data.objects.remove(obj)
    assert valid >= 5


def test_the_sphere_is_measured_as_the_ball_that_it_is():
    ball = measured(primitive("sphere"))
    assert str(ball.method) == "NURBS exact" and not ball.findings
    assert abs(ball.volume / (BALL * STORED) - 1.0) <= 1e-8
    assert ball.display_volume / BALL < 0.988  # and its polygons 1.3 % too small
    assert (
        abs(ball.volume - BALL) <= ball.error_bound["volume"] + ball.error_bound["input"]["volume"]
    )
    assert abs(ball.area / (4.0 * np.pi) - 1.0) <= 1e-6
    entry = record(ball)
    assert entry["display_mesh"]["difference"] == pytest.approx(ball.display_volume - ball.volume)


@pytest.mark.parametrize("name", ["sphere", "torus", "cylinder"])
def test_an_uneven_mirrored_transform_maps_the_body(name):
    obj = primitive(name)
    plain = measured(obj)
    obj.location, obj.rotation_euler, obj.scale = (
        (5.0, -2.0, 8.0),
        (0.3, -1.0, 2.0),
        (1.0, 2.0, -0.5),
    )
    moved = measured(obj)
    expected = plain.volume_moments.transform(place(obj)).about_point(moved.volume_moments.about)
    assert moved.method == plain.method and said(moved).keys() == said(plain).keys()
    assert np.abs(moved.volume_moments.raw - expected.raw).max() <= 1e-12 * expected.total
    assert moved.area != pytest.approx(plain.area, rel=1e-2)
    with_mesh = obj.copy()
    bpy.context.scene.collection.objects.link(with_mesh)
    with_mesh.modifiers.new("Triangulate", "TRIANGULATE")
    obj.data.splines[0].resolution_u = obj.data.splines[0].resolution_v = 24
    assert measured(with_mesh).area == pytest.approx(moved.area, rel=3e-3)


def test_a_shell_is_thin_or_has_real_walls():
    obj = primitive("sphere")
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.1
    thin = measured(obj)
    assert str(thin.method) == "NURBS shell" and thin.volume == pytest.approx(0.4 * np.pi, rel=1e-6)
    for wall, low, high in (("INWARD", 0.9, 1.0), ("OUTWARD", 1.0, 1.1), ("CENTERED", 0.95, 1.05)):
        obj.body_moments.wall = wall
        found = measured(obj)
        assert str(found.method) == "NURBS shell"
        assert found.volume == pytest.approx(BALL * (high**3 - low**3), rel=1e-6)
        inertia = 2.0 / 3.0 * 1000.0 * 4.0 * np.pi / 5.0 * (high**5 - low**5)
        assert close(found.mass_properties.principal.moments, np.full(3, inertia), rel=1e-6)
    obj.body_moments.thickness = 3.0
    with refused("wall_thicker_than_curvature"):
        measured(obj)


def test_patch_wall_keeps_thickness_under_scale():
    obj = primitive("sphere")
    obj.body_moments.kind, obj.body_moments.wall, obj.body_moments.thickness = (
        "SHELL",
        "INWARD",
        0.1,
    )
    obj.scale = (2.0, 2.0, -2.0)
    assert measured(obj).volume == pytest.approx(BALL * (8.0 - 1.9**3), rel=1e-6)


@pytest.mark.parametrize("order", [3, 5])
@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, -2, 2), (1, 2, 3), (-1, 0.5, 4)])
def test_patch_moment_bounds_cover_float32_at_any_scale(order, kind, scale):
    """A body grown by a thousandth changes by what control points that are moved as far would
    change at most.
    """
    obj = primitive("sphere")
    obj.body_moments.kind, obj.scale = kind, scale
    growth = 1.001

    def moments(by):
        obj.scale = by * np.array(scale)
        bpy.context.view_layer.update()
        body = measure_body(obj, bpy.context.evaluated_depsgraph_get())
        volume, area = body.body.moments(order, True)
        (part,) = body.reading.parts
        farthest = max(np.linalg.norm(patch.points, axis=2).max() for patch in part.splines.patches)
        return [area] if kind == "SHELL" else [volume, area], (
            growth - 1.0
        ) * farthest / part.splines.stored

    (before, moved), (after, _) = moments(1.0), moments(growth)
    for was, now in zip(before, after):
        degree = monomials(order).sum(axis=1)
        change = np.abs(now.about_point(was.about).raw - was.raw)
        allowed = moved * was.input_error * growth ** (degree + 3)
        noise = 1e-9 * np.abs(was.total) * np.max(np.abs(scale)) ** degree
        assert (change <= allowed + noise).all()
        assert change[0] >= 0.02 * allowed[0]


def test_shape_keys_move_the_surface():
    obj = primitive("sphere")
    plain = measured(obj).volume
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Large")
    for point in key.data:
        point.co = 2.0 * point.co
    for frame, value in ((1, 0.0), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for frame in (1, 6, 11):
        bpy.context.scene.frame_set(frame)
        found = measured(obj)
        assert str(found.method) == "NURBS exact" and not found.findings
        assert found.volume == pytest.approx(plain * (1.0 + key.value) ** 3, rel=1e-6)
    assert found.volume == pytest.approx(8.0 * plain, rel=1e-12)
    key.mute = True
    assert measured(obj).volume == pytest.approx(plain, rel=1e-12)
    key.mute = False
    obj.active_shape_key_index, obj.show_only_shape_key = 1, True
    assert measured(obj).volume == pytest.approx(8.0 * plain, rel=1e-12)


@pytest.mark.parametrize(
    "falloff",
    ["NONE", "SMOOTH", "SHARP", "ROOT", "LINEAR", "SPHERE", "CONSTANT", "INVERSE_SQUARE", "CURVE"],
)
def test_hooks_move_the_surface(falloff):
    obj = primitive("sphere")
    obj.scale = (1.0, 1.0, 2.0)
    bpy.context.view_layer.update()
    hook = add(None, "Hook", select=False)
    modifier = obj.modifiers.new("Hook", "HOOK")
    modifier.object, modifier.strength = hook, 0.8
    modifier.vertex_indices_set(list(range(8, 40)))
    modifier.falloff_type, modifier.falloff_radius = falloff, 1.6
    before = measured(obj).volume
    hook.location, hook.rotation_euler, hook.scale = (
        (0.2, 0.1, 0.5),
        (0.1, 0.2, 0.3),
        (1.3, 1.0, 0.9),
    )
    found = measured(obj)
    assert str(found.method).startswith("NURBS") and abs(found.volume / before - 1.0) > 1e-3
    assert ("control_points_recovered" in said(found)) == (falloff == "CURVE")
    obj.data.splines[0].resolution_u = obj.data.splines[0].resolution_v = 32
    fine = measured(obj)
    assert fine.display_volume == pytest.approx(found.volume, rel=2e-3)
    assert fine.volume == pytest.approx(found.volume, rel=1e-5)


def test_modified_splines_are_recovered_from_display():
    obj = primitive("torus")
    obj.data.splines[0].resolution_u = obj.data.splines[0].resolution_v = 6
    plain = measured(obj)
    cast = obj.modifiers.new("Cast", "CAST")
    cast.use_apply_on_spline, cast.factor = True, 0.3
    found = measured(obj)
    assert str(found.method) == "NURBS exact" and "control_points_recovered" in said(found)
    assert abs(found.volume / plain.volume - 1.0) > 1e-2
    obj.data.splines[0].resolution_u = obj.data.splines[0].resolution_v = 40
    fine = measured(obj)
    assert fine.display_volume == pytest.approx(found.volume, rel=2e-3)
    assert fine.volume == pytest.approx(found.volume, rel=2e-5)


def loaf():
    """A cube of six patches of different resolution in one object."""

    def side(u, v, origin, count):
        s, t = np.meshgrid(np.linspace(0, 1, count[0]), np.linspace(0, 1, count[1]), indexing="ij")
        return s[..., None] * v + t[..., None] * u + origin

    x, y, z = np.eye(3)
    corner = np.array([3.0, 1.0, -2.0])
    sides = [
        side(x, y, corner, (3, 4)),
        side(x, y, corner + z, (4, 3)),
        side(y, z, corner, (3, 3)),
        side(y, z, corner + x, (5, 4)),
        side(z, x, corner, (3, 3)),
        side(z, x, corner + y, (4, 4)),
    ]
    objects = [surface(points, orders=(2, 3)) for points in sides]
    only(*objects)
    bpy.ops.object.join()
    return bpy.context.object


def test_patches_with_a_seam_between_them_are_one_body():
    found = measured(loaf())
    assert str(found.method) == "NURBS reoriented" and found.health.components == 1
    assert found.volume == pytest.approx(1.0, abs=1e-6)


def test_instances_of_a_surface_are_measured_as_it_is():
    ball = primitive("sphere")
    collection = bpy.data.collections.new("Balls")
    collection.objects.link(ball)
    bpy.context.scene.collection.children.link(collection)
    empties = []
    for scale in ((1.0, 1.0, 1.0), (2.0, 3.0, -1.0)):
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.location, empty.scale = (10.0, 0.0, 0.0), scale
        bpy.context.scene.collection.objects.link(empty)
        empties.append(empty)
    one, other = measured(empties[0]), measured(empties[1])
    assert str(one.method) == str(other.method) == "NURBS exact"
    assert one.volume == pytest.approx(BALL * STORED, rel=1e-8)
    assert other.volume == pytest.approx(6.0 * BALL * STORED, rel=1e-8)


def test_weights_of_zero_leave_the_display_mesh():
    obj = primitive("sphere")
    obj.data.splines[0].points[17].co[3] = 0.0
    obj.data.update_tag()
    found = measured(obj)
    assert not str(found.method).startswith("NURBS") and said(found)["display_mesh_measured"] == {
        "cause": "some control points have no positive weight"
    }


def test_live_numbers_follow_hooks_keys_transforms_and_frames():
    obj = primitive("sphere")
    hook = add(None, "Hook", select=False)
    modifier = obj.modifiers.new("Hook", "HOOK")
    modifier.object = hook
    modifier.vertex_indices_set(list(range(40)))
    for frame, height in ((1, 1.0), (11, 3.0)):
        hook.scale.z = height
        hook.keyframe_insert("scale", frame=frame)
    only(obj)
    bpy.ops.object.body_moments_live()
    for frame in (1, 6, 11):
        bpy.context.scene.frame_set(frame)
        assert memory.followed[obj].is_pending
        found = live.update(obj, bpy.context.evaluated_depsgraph_get()).measurement
        assert found.volume == pytest.approx(BALL * STORED * hook.scale.z, rel=1e-8)
    obj.scale = (1.0, 2.0, -1.0)
    bpy.context.view_layer.update()
    found = live.update(obj, bpy.context.evaluated_depsgraph_get()).measurement
    assert found.volume == pytest.approx(measured(obj).volume, rel=1e-12)
    bpy.ops.object.body_moments_live()


def test_patches_and_polygons_in_one_object_are_the_sum_of_both():
    """A ball of patches and a box of polygons, twice: turned, and flattened to nothing; solid,
    sheet and any order.
    """
    ball = primitive("sphere")
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(6, 0, 0))
    box = bpy.context.object
    parts = bpy.data.collections.new("Parts")
    for obj in (ball, box):
        parts.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    empty = bpy.data.objects.new("Both", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", parts
    bpy.context.scene.collection.objects.link(empty)
    empty.rotation_euler, empty.location, empty.scale = (0.3, 0.4, 0.5), (1, 2, 3), (2, 2, 2)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    solid = measure_object(empty, depsgraph, MeasureOptions(order=6, surface=True, density=1.0))
    volume, area = 8.0 * (BALL + 8.0), 4.0 * (4.0 * np.pi + 24.0)
    assert close(solid.volume, volume, 1e-6) and close(solid.area, area, 1e-6)
    assert solid.method.source == Source.POLYGONS and solid.health.components == 2
    matrix = np.array(empty.matrix_world, float)
    center = matrix[:3, :3] @ (np.array([6.0, 0, 0]) * 8.0 / (BALL + 8.0)) + matrix[:3, 3]
    assert np.abs(solid.mass_properties.center - center).max() < 1e-5
    moments, surfaces = (
        solid.volume_moments.about_point(matrix[:3, 3]),
        solid.area_moments.about_point(matrix[:3, 3]),
    )
    axis = matrix[:3, 0] / 2.0  # along which the box lies: ∫ t^n dV of both
    for n in (1, 4, 6):
        of_ball = 2.0 * np.pi * (1 / (n + 1) - 1 / (n + 3)) if n % 2 == 0 else 0.0
        of_box = 4.0 * (7.0 ** (n + 1) - 5.0 ** (n + 1)) / (n + 1)
        powers = [(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]
        count = [
            np.prod(np.arange(1, n + 1)) / np.prod([np.prod(np.arange(1, k + 1)) for k in p])
            for p in powers
        ]
        along = sum(c * moments[p] * np.prod(axis**p) for c, p in zip(count, powers))
        assert close(along, 2.0 ** (n + 3) * (of_ball + of_box), 1e-5)
        of_ball = 4.0 * np.pi / (n + 1) if n % 2 == 0 else 0.0
        of_box = 16.0 * (7.0 ** (n + 1) - 5.0 ** (n + 1)) / (2 * (n + 1)) + 4.0 * (7.0**n + 5.0**n)
        along = sum(c * surfaces[p] * np.prod(axis**p) for c, p in zip(count, powers))
        assert close(along, 2.0 ** (n + 2) * (of_ball + of_box), 1e-5)
    sheet = MeasureOptions(kind="shell", thickness=0.01, density=1.0, order=4)
    thin = measure_object(empty, depsgraph, sheet)
    assert close(thin.area, area, 1e-6) and close(thin.volume, 0.01 * area, 1e-6)
    assert (
        np.abs(
            thin.area_moments.raw - solid.area_moments.about_point(thin.area_moments.about).raw[:35]
        ).max()
        < 1e-4
    )
    for wall in ("inward", "outward", "centered"):
        with refused("wall_unsupported", "Both"):
            measure_object(
                empty, depsgraph, MeasureOptions(kind="shell", wall=wall, thickness=0.01)
            )
    empty.scale = (1, 1, 0)
    bpy.context.view_layer.update()
    with refused("zero_scale", "Both"):
        measured(empty)


def moebius_net():
    """(3, 17, 3) the control points of a Möbius band of bilinear patches."""
    turns = np.linspace(0.0, 2.0 * np.pi, 17)
    arm = np.stack(
        [np.cos(turns) * np.cos(turns / 2), np.sin(turns) * np.cos(turns / 2), np.sin(turns / 2)],
        axis=1,
    )
    middle = np.stack([3.0 * np.cos(turns), 3.0 * np.sin(turns) + 5.0, 0.0 * turns - 2.0], axis=1)
    return np.stack([middle - arm, middle, middle + arm])


def test_flat_patch_beside_polygons_adds_no_moments():
    """Of a cube whose frame third moments do not show."""
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    cube, flat = bpy.context.object, surface(moebius_net() * (1.0, 1.0, 0.0), orders=(2, 2))
    parts = bpy.data.collections.new("Parts")
    for obj in (cube, flat):
        parts.objects.link(obj)
        bpy.context.scene.collection.objects.unlink(obj)
    bpy.ops.object.collection_instance_add(collection="Parts")
    found = measure_object(
        bpy.context.object, bpy.context.evaluated_depsgraph_get(), MeasureOptions(order=4)
    )
    moments = found.volume_moments.about_point(np.zeros(3))
    assert close(
        [found.volume, moments[4, 0, 0], moments[2, 2, 0]], [8.0, 8.0 / 5.0, 8.0 / 9.0], 1e-12
    )


def instances_of(obj, *places):
    """An empty that shows a collection of the object at places: (location, scale)."""
    parts, copies = bpy.data.collections.new("Part"), bpy.data.collections.new("Copies")
    parts.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    for location, scale in places:
        one = bpy.data.objects.new("Place", None)
        one.instance_type, one.instance_collection = "COLLECTION", parts
        one.location, one.scale = location, scale
        copies.objects.link(one)
    empty = bpy.data.objects.new("All", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", copies
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.update()
    return empty


def test_patch_instances_add_up_with_unchecked_overlap():
    found = measured(
        instances_of(primitive("sphere"), ((0, 0, 0), (1, 1, 1)), ((9, 0, 0), (2, 2, 2)))
    )
    assert close(found.volume, 9.0 * BALL * STORED, 1e-7) and not said(found)
    found = measured(
        instances_of(primitive("sphere"), ((0, 0, 0), (1, 1, 1)), ((1, 0, 0), (1, 1, 1)))
    )
    assert close(found.volume, 2.0 * BALL * STORED, 1e-7)
    assert [*said(found)] == ["unchecked"]
    assert said(found)["unchecked"]["subject"].startswith("the overlap of instances")
    found = measured(
        instances_of(primitive("sphere"), ((0, 0, 0), (1, 1, 1)), ((9, 0, 0), (1, 1, 0)))
    )
    assert close(found.volume, BALL * STORED, 1e-7)
    assert said(found)["flat_surfaces"] == {"count": 1, "total": 2}


def test_patch_wall_has_moments_to_third_order():
    obj = primitive("sphere")
    obj.body_moments.kind, obj.body_moments.wall, obj.body_moments.thickness = (
        "SHELL",
        "INWARD",
        0.1,
    )
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = measure_object(obj, depsgraph, MeasureOptions(order=3, surface=True))
    assert (
        found.volume > 0.0
        and found.area_moments.order == 3
        and found.area_moments.total == found.area > 0.0
    )
    with refused("wall_unsupported", obj.name):
        measure_object(obj, depsgraph, MeasureOptions(order=4))
    body = measure_body(obj, depsgraph).body
    assert not list(body.surfaces(True)) and not list(body.surfaces(False))
    with refused("wall_unsupported"):
        body.moments(4, False)


@pytest.mark.parametrize("wall", ["INWARD", "OUTWARD", "CENTERED"])
def test_wall_of_inverted_patches_keeps_its_side(wall):
    obj = primitive("sphere")
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", wall, 0.1
    plain = measured(obj).volume
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.curve.switch_direction()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert close(measured(obj).volume, plain, rel=1e-12)
    obj.scale, settings.thickness = (0.5, 0.5, 0.5), 0.05
    assert close(measured(obj).volume, plain / 8.0, rel=1e-6)
    obj.scale = (0.5, 0.5, -0.5)
    assert close(measured(obj).volume, plain / 8.0, rel=1e-6)


def test_flattened_patches_are_a_sheet_and_no_solid():
    obj = primitive("sphere")
    obj.scale = (1.0, 1.0, 0.0)
    with refused("zero_scale", obj.name):
        measured(obj)
    obj.body_moments.kind = "SHELL"
    assert close(measured(obj).area, 2.0 * np.pi, rel=1e-3)


def test_instances_of_patches_that_overlap_are_united_too():
    empty = instances_of(primitive("sphere"), ((0, 0, 0), (1, 1, 1)), ((1, 0, 0), (1, 1, 1)))
    both = measured(empty)
    assert close(both.volume, 2.0 * BALL * STORED, 1e-7)
    assert 1.95 * BALL < both.display_volume < 2.0 * BALL
    empty.body_moments.overlap = "UNION"
    united = measured(empty)
    assert str(united.method) == "union" and "display_mesh_measured" in said(united)
    # of two balls whose centers are a radius apart
    assert close(united.volume, BALL * 27.0 / 16.0, 0.02)
