# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects: wires, and the flat regions that closed ones bound, from control points."""

from itertools import product
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat import flat_region
from body_moments.blender.bodies.measure_object import measure_body, measure_object
from body_moments.blender.read.nurbs import curves
from body_moments.blender.read.nurbs.deformation import FALLOFFS, spline_modifiers
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.moments.moments import monomials
from body_moments.core.nurbs.curve import Curve
from mathutils import Matrix

from tests.blender.characters import armature_of
from tests.blender.findings import refused, said
from tests.blender.objects import add, measured, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def bezier_area(obj):
    """The area of four cubic quarters by Green's theorem, with the handles' length k: 4 (1/2 + 3k/5 - 3k²/20)."""
    point = obj.data.splines[0].bezier_points[0]
    k = (point.handle_left - point.co).length
    return 4.0 * (0.5 + 0.6 * k - 0.15 * k * k)


def circle(kind="nurbs"):
    getattr(bpy.ops.curve, "primitive_{:s}_circle_add".format(kind))()
    return bpy.context.object


def poly(points, cyclic=False):
    data = bpy.data.curves.new("Poly", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    spline.points.foreach_set("co", np.c_[np.asarray(points, float), np.ones(len(points))].ravel())
    spline.use_cyclic_u = cyclic
    return add(data, "Poly")


def test_a_circle_is_a_wire_of_its_length():
    obj = circle()
    obj.body_moments.kind, obj.body_moments.linear_density = "WIRE", 2.5
    wire = measured(obj)
    assert str(wire.method) == "wire" and wire.volume == 0.0 and wire.area == 0.0
    assert wire.length == pytest.approx(2.0 * np.pi, rel=1e-8)
    assert wire.mass_properties.mass == pytest.approx(5.0 * np.pi, rel=1e-8)
    assert np.allclose(wire.mass_properties.principal.moments, np.array([2.5, 2.5, 5.0]) * np.pi, rtol=1e-7)
    obj.scale = (2.0, 2.0, 2.0)
    assert measured(obj).length == pytest.approx(4.0 * np.pi, rel=1e-8)
    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.0
    assert measured(obj).mass_properties.mass == pytest.approx(3.0)


@pytest.mark.parametrize("exact", [True, False])
def test_a_flat_curve_has_its_centroid_where_it_lies(exact):
    obj = circle("bezier")
    obj.data.dimensions = "2D"
    obj.location, obj.rotation_euler = (3.0, -4.0, 5.0), (0.3, 0.5, 0.7)
    bpy.context.view_layer.update()
    region = flat_region(obj, bpy.context.evaluated_depsgraph_get(), exact=exact)
    about = region.moments(2).about
    assert bool(region.curves) == exact and np.abs(region.foot(obj.location) - about).max() < 1e-5
    assert np.abs(region.plane.origin + region.plane.axes @ about - obj.location).max() < 1e-5


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("away", [0.0, 1e4])
@pytest.mark.parametrize("cyclic", [True, False])
def test_a_wire_is_closed_where_its_ends_meet_whatever_its_size_and_place(cyclic, away, size):
    obj = poly([(0, 0, 0), (1, 0, 0), (1, 1, 0)], cyclic)
    obj.body_moments.kind = "WIRE"
    obj.scale, obj.location.x = (size, size, size), away * size
    assert measured(obj).health.closed == cyclic


@pytest.mark.parametrize(
    ("gap", "place", "is_closed"),
    [
        (5e-10, {}, True),
        (2e-9, {}, False),
        (0.0, {"scale": (1e-4,) * 3, "location": (1e5, 0, 0)}, True),
        (24 * 2.0**-53 * 1e9, {"scale": (1e-4,) * 3, "location": (1e5, 0, 0)}, True),
        (48 * 2.0**-53 * 1e9, {"scale": (1e-4,) * 3, "location": (1e5, 0, 0)}, False),
    ],
)
def test_the_ends_of_a_wire_meet_to_its_size_and_to_the_rounding_of_where_it_is(gap, place, is_closed):
    obj = poly([(0, 0, 0), (1, 0, 0), (1, 1, 0), (gap, 0, 0)], False)
    obj.body_moments.kind = "WIRE"
    for name, value in place.items():
        setattr(obj, name, value)
    assert measured(obj).health.closed == is_closed


def test_an_ellipse_is_not_a_scaled_length():
    obj = circle()
    obj.body_moments.kind, obj.scale = "WIRE", (2.0, 1.0, 1.0)
    t = (np.arange(100_000) + 0.5) * (2.0 * np.pi / 100_000)
    exact = np.sqrt(4.0 * np.sin(t) ** 2 + np.cos(t) ** 2).mean() * 2.0 * np.pi
    assert measured(obj).length == pytest.approx(exact, rel=1e-8)


@pytest.mark.parametrize("bevel", [0.0, 0.1])
def test_straight_splines_are_rods(bevel):
    obj = poly([(0, 0, 0), (3, 0, 0), (3, 4, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", bevel
    rods = measured(obj)
    assert rods.length == pytest.approx(7.0)
    assert np.allclose(rods.mass_properties.center, [(1.5 * 3 + 3 * 4) / 7, 8 / 7, 0])
    obj.data.splines[0].use_cyclic_u = True
    assert measured(obj).length == pytest.approx(12.0)
    for far in (5.0, 7.0):  # each spline has points of its own
        spline = obj.data.splines.new("POLY")
        spline.points.add(1)
        spline.points.foreach_set("co", [far, 0, 0, 1, far, 0, 2, 1])
    rods = measured(obj)
    assert rods.length == pytest.approx(16.0) and rods.health.components == 3
    assert np.allclose(rods.mass_properties.center, [48 / 16, 18 / 16, 4 / 16])


@pytest.mark.parametrize("unit", [1.0, 0.25])
def test_what_float32_may_have_moved_bounds_the_length_of_wires(unit):
    """Short rods far away, of which each end may have been moved by half a unit in the last place, 2^-15 at 1000."""
    bpy.context.scene.unit_settings.scale_length = unit
    obj = poly([(1000.0, 0, 0), (1000.0, 0.5, 0)])
    obj.body_moments.kind = "WIRE"
    for k in range(1, 8):
        spline = obj.data.splines.new("POLY")
        spline.points.add(1)
        spline.points.foreach_set("co", [1000.0, 100.0 * k, 0, 1, 1000.0, 100.0 * k + 0.5, 0, 1])
    bpy.context.view_layer.update()
    body = measure_body(obj, bpy.context.evaluated_depsgraph_get()).body
    moved = 2 * 8 * 2.0**-15 * unit
    assert close(body.length.total, 4.0 * unit, 1e-12) and body.health.components == 8
    assert moved <= body.length.input_error[0] < 4.0 * moved
    assert close(body.length.input_error[1] / body.length.input_error[0], 350.25 * unit, 1e-3)


FLAGS = list(product((False, True), repeat=3))  # cyclic, with knots of Bézier pieces, to its end points


@pytest.mark.parametrize("kind", ["POLY", "BEZIER", "NURBS"])
def test_splines_and_what_blender_shows_of_them_are_the_same_curves(kind):
    """Several in one object, of every order and with all flags."""
    rng = np.random.default_rng(5)
    data = bpy.data.curves.new("Curves", "CURVE")
    data.dimensions = "3D"
    for number, (cyclic, bezier, endpoint) in enumerate(FLAGS):
        spline = data.splines.new(kind)
        points = spline.bezier_points if kind == "BEZIER" else spline.points
        points.add(6 + number % 3)
        for point in points:
            if kind == "BEZIER":
                point.handle_left, point.co, point.handle_right = rng.uniform(-1, 1, (3, 3))
            else:
                point.co = (*rng.uniform(-1, 1, 3), rng.uniform(0.5, 2))
        spline.use_cyclic_u, spline.use_bezier_u, spline.use_endpoint_u = cyclic, bezier, endpoint
        spline.order_u = 3 + number % 2
    obj = add(data)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    geometry = evaluated.evaluated_geometry()
    one, other = (
        list(curves._spline_curves(evaluated, depsgraph)),
        list(curves._shown_curves(geometry.curves, obj.name)),
    )
    assert len(one) == len(FLAGS) and sum(curve is not None for curve in one) >= 6
    for first, second in zip(one, other, strict=True):
        assert (first is None) == (second is None)
        if first is not None:
            assert (first.space.knots, first.space.order) == (second.space.knots, second.space.order)
            assert np.array_equal(first.points, second.points)
            weights = [None if curve.weights is None else curve.weights.tolist() for curve in (first, second)]
            assert weights[0] == weights[1] and (weights[0] is None) == (kind != "NURBS")


@pytest.mark.parametrize("dimensions", ["2D", "3D"])
def test_the_region_of_a_bezier_circle_is_that_of_its_curve(dimensions):
    obj = circle("bezier")
    obj.data.dimensions = dimensions
    if dimensions == "2D":
        obj.data.fill_mode = "BOTH"
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    disc = measured(obj)
    assert str(disc.method) == "NURBS shell"
    assert disc.area == pytest.approx(bezier_area(obj), rel=1e-6)
    assert disc.area / np.pi == pytest.approx(1.000191785, rel=1e-8)
    assert ("curve_not_filled" in said(disc)) == (dimensions == "3D")
    assert disc.mass_properties.inertia[0, 1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("far", [1e4, 1e6])
def test_the_region_of_an_object_far_away_is_the_same(far):
    obj = circle("bezier")
    obj.body_moments.kind = "SHELL"
    near = measured(obj).area
    obj.location = (far, far, 0.0)
    assert measured(obj).area == pytest.approx(near, rel=1e-9)


def test_moments_of_higher_order_of_a_region_are_exact_too():
    obj = circle()
    obj.body_moments.kind = "SHELL"
    found = measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(order=6))
    assert found.area_moments.about_point(np.zeros(3))[6, 0, 0] == pytest.approx(5.0 * np.pi / 64.0, rel=1e-7)


@pytest.mark.parametrize("order", [2, 5])
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, -3, 1), (1e-3, 2e-3, 1)])
def test_what_float32_may_have_moved_bounds_moments_of_a_region_of_any_order(order, scale):
    """A region grown by a thousandth changes by what points that are moved as far would change at most."""
    obj = circle()
    obj.body_moments.kind = "SHELL"
    growth = 1.001

    def moments(by):
        obj.scale = by * np.array(scale)
        bpy.context.view_layer.update()
        body = measure_body(obj, bpy.context.evaluated_depsgraph_get())
        farthest = max(np.linalg.norm(curve.points, axis=1).max() for curve in body.reading.boundary)
        return body.body.moments(order, True)[1], (growth - 1.0) * farthest / body.reading.stored

    (before, moved), (after, _) = moments(1.0), moments(growth)
    degree = monomials(order).sum(axis=1)
    change = np.abs(after.about_point(before.about).raw - before.raw)
    allowed = moved * before.input_error * growth ** (degree + 1)
    assert (change <= allowed + 1e-9 * before.total * np.max(np.abs(scale)) ** degree).all()
    assert change[0] >= 0.1 * allowed[0]


@pytest.mark.filterwarnings("error")
def test_moments_of_a_region_beyond_the_range_of_numbers_are_refused_without_a_warning_of_numpy():
    obj = circle()
    obj.body_moments.kind, obj.scale = "SHELL", (1e12, 1e12, 1e12)
    with refused("moments_overflow", order=30):
        measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(order=30))
    obj.data.dimensions = "2D"
    bpy.context.view_layer.update()
    region = flat_region(obj, bpy.context.evaluated_depsgraph_get())
    assert region.curves and np.isfinite(region.moments(4).raw).all()
    with refused("moments_overflow", order=30):
        region.moments(30)


def test_a_ring_has_its_hole():
    obj = circle()
    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
    inner = circle()
    inner.scale = (0.5, 0.5, 0.5)
    bpy.ops.object.transform_apply(scale=True)
    only(obj, inner)
    bpy.ops.object.join()
    obj.body_moments.kind = "SHELL"
    ring = measured(obj)
    assert ring.area == pytest.approx(0.75 * np.pi, rel=1e-7)
    assert str(ring.method) == "NURBS shell"


def test_what_bounds_no_region_is_measured_by_its_fill_or_refused():
    crossing = poly([(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0)], cyclic=True)
    crossing.body_moments.kind = "SHELL"
    with refused("curves_cross"):
        measured(crossing)
    crossing.data.dimensions, crossing.data.fill_mode = "2D", "BOTH"
    found = measured(crossing)
    assert str(found.method) == "shell" and found.area > 0.0  # whatever Blender fills
    assert said(found)["curve_fill_measured"]["cause"]["code"] == "curves_cross"


def test_hooks_and_keys_bend_a_wire_with_a_bevel_and_without():
    obj = circle("bezier")
    obj.body_moments.kind = "WIRE"
    plain = measured(obj).length
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Large")
    for point in key.data:
        point.co, point.handle_left, point.handle_right = (
            3.0 * np.array(value) for value in (point.co, point.handle_left, point.handle_right)
        )
    key.value = 0.5
    hook = add(None, "Hook", select=False)
    modifier = obj.modifiers.new("Hook", "HOOK")
    modifier.object = hook
    modifier.vertex_indices_set(list(range(12)))
    hook.scale = (1.5, 1.5, 1.5)
    assert measured(obj).length == pytest.approx(3.0 * plain, rel=1e-6)
    obj.data.bevel_depth = 0.1
    assert measured(obj).length == pytest.approx(3.0 * plain, rel=1e-6)


def with_nodes(obj, kind, **values):
    """A geometry node of that kind as its modifier."""
    group = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    node = group.nodes.new(kind)
    for name, value in values.items():
        if hasattr(node, name):
            setattr(node, name, value)
        else:
            next(socket for socket in node.inputs if socket.name == name and socket.enabled).default_value = value
    group.links.new(group.nodes.new("NodeGroupInput").outputs[0], node.inputs[0])
    group.links.new(node.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = group


@pytest.mark.parametrize(
    "kind, node, values, length",
    [
        ("bezier", "GeometryNodeSetSplineCyclic", {"Cyclic": False}, 0.75 * 6.2837897149),
        ("nurbs", "GeometryNodeSetSplineCyclic", {"Cyclic": False}, 1.5 * np.pi),
        ("bezier", "GeometryNodeCurveSplineType", {"spline_type": "POLY"}, 4.0 * np.sqrt(2.0)),
        ("nurbs", "GeometryNodeCurveSplineType", {"spline_type": "POLY"}, 8.0),
        ("bezier", "GeometryNodeTrimCurve", {"End": 0.5}, 6.2837897149 / 2.0),
        ("bezier", "GeometryNodeResampleCurve", {"Count": 4}, 4.0 * np.sqrt(2.0)),
    ],
)
def test_a_wire_is_the_curve_that_nodes_make_of_it(kind, node, values, length):
    """Also where they leave the number of its points as it is."""
    obj = circle(kind)
    obj.body_moments.kind = "WIRE"
    with_nodes(obj, node, **values)
    wire = measured(obj)
    assert wire.length == pytest.approx(length, rel=1e-5) and not wire.findings


@pytest.mark.parametrize("kind", ["bezier", "nurbs"])
def test_a_wire_through_its_points_is_as_long_as_what_blender_shows(kind):
    obj = circle(kind)
    obj.body_moments.kind = "WIRE"
    with_nodes(obj, "GeometryNodeCurveSplineType", spline_type="CATMULL_ROM")
    obj.data.resolution_u = 100
    wire = measured(obj)
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = np.array([vertex.co for vertex in mesh.vertices], np.float64)
    ends = np.array([edge.vertices for edge in mesh.edges])
    assert wire.length == pytest.approx(np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).sum(), rel=1e-4)


@pytest.mark.parametrize("bevel", [0.0, 0.1])
def test_a_spline_with_knots_of_its_own_is_refused(bevel, tmp_path):
    """Blender's OBJ importer makes such ones, and no interface tells them."""
    path = tmp_path / "curve.obj"
    path.write_text(
        "v 0 0 0\nv 1 2 0\nv 3 2 0\nv 4 0 0\nv 5 -1 0\ncstype bspline\ndeg 3\ncurv 0 1 1 2 3 4 5\n"
        "parm u 0 0 0 0 0.1 1 1 1 1\nend\n"
    )
    bpy.ops.wm.obj_import(filepath=str(path))
    (obj,) = bpy.context.selected_objects
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", bevel
    spline = obj.data.splines[0]
    if spline.calc_length(resolution=64) > 7.1:  # else this Blender gave it knots that are known
        with refused("unknown_knots"):
            measured(obj)
        spline.use_endpoint_u = False
        spline.use_endpoint_u = True
    assert measured(obj).length == pytest.approx(spline.calc_length(resolution=200), rel=1e-5)


def test_a_wire_whose_bevel_leaves_some_of_it_bare_is_measured_whole_and_says_so():
    obj = circle()
    obj.body_moments.kind, obj.data.bevel_depth, obj.data.bevel_factor_end = "WIRE", 0.1, 0.5
    found = measured(obj)
    assert found.length == pytest.approx(2.0 * np.pi, rel=1e-7)
    assert said(found) == {"bevel_range_ignored": {}}


def test_a_flat_region_takes_the_density_that_is_not_one_value_and_says_what_was_measured():
    obj = circle("bezier")
    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
    settings = obj.body_moments
    settings.kind, settings.thickness = "SHELL", 0.5
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "200 + 100*x"
    found = measured(obj)
    assert found.density_from.code == "density_from_polynomial"
    assert found.mass_properties.mass == pytest.approx(100.0 * np.pi, rel=5e-3)  # Blender's polygon is smaller
    assert found.mass_properties.center[0] == pytest.approx(0.125, rel=5e-3)
    assert "curve_fill_for_density" in said(found)


@pytest.mark.parametrize("source", ["POLYNOMIAL", "MATERIALS"])
def test_a_wire_has_its_linear_density_and_is_up_to_date_whatever_its_density_comes_from(source):
    from body_moments.blender.session.tracking import staleness

    obj = circle()
    obj.body_moments.kind, obj.body_moments.density_from = "WIRE", source
    obj.select_set(True)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    assert staleness.stale_reason(obj, bpy.context.scene) is None


@pytest.mark.parametrize("bevel", [0.0, 0.1])
def test_points_that_are_nowhere_are_refused(bevel):
    obj = poly([(0, 0, 0), (3, 0, 0), (3, 1, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", bevel
    obj.data.splines[0].points[1].co.y = float("nan")
    with refused("non_finite_control_points", obj.name):
        measured(obj)
    round_one = circle("bezier")
    round_one.body_moments.kind, round_one.data.bevel_depth = "WIRE", bevel
    point = round_one.data.splines[0].bezier_points[1]
    point.handle_left_type = point.handle_right_type = "FREE"
    point.handle_right.z = float("nan")
    with refused("non_finite_control_points", round_one.name):
        measured(round_one)


def hooked(obj, **settings):
    """A hook on all points, and its object, which stands at the origin."""
    target = add(None, "Target", select=False)
    modifier = obj.modifiers.new("Hook", "HOOK")
    modifier.object = target
    modifier.vertex_indices_set(list(range(len(obj.data.splines[0].points))))
    for name, value in settings.items():
        setattr(modifier, name, value)
    return target, modifier


def test_a_hook_of_a_bone_moves_as_the_bone_and_one_without_object_not_at_all():
    obj = poly([(0, 0, 0), (3, 0, 0), (3, 4, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", 0.1
    rig = armature_of(SimpleNamespace(names=("bone",), bones=np.array([[[0, 0, 0], [0, 0, 1]]])))
    target, modifier = hooked(obj)
    modifier.object, modifier.subtarget = rig, "bone"
    plain = measured(obj)  # Blender has made the hook one that moves nothing yet
    assert plain.length == pytest.approx(7.0)
    rig.pose.bones["bone"].scale = (2, 2, 2)
    rig.scale, rig.location = (1.5, 1.5, 1.5), (1, 2, 3)
    found = measured(obj)
    assert found.length == pytest.approx(21.0, rel=1e-6)
    center = 3.0 * plain.mass_properties.center + np.array([1, 2, 3])
    assert found.mass_properties.center == pytest.approx(center, rel=1e-6)
    modifier.subtarget, modifier.matrix_inverse = "gone", Matrix()
    assert measured(obj).length == pytest.approx(10.5, rel=1e-6)
    modifier.object = None
    assert measured(obj).length == pytest.approx(7.0, rel=1e-12)
    modifier.object, target.scale = target, (5, 5, 5)
    assert measured(obj).length == pytest.approx(35.0, rel=1e-6)
    modifier.vertex_indices_set([])
    assert measured(obj).length == pytest.approx(7.0, rel=1e-12)
    modifier.vertex_indices_set([0, 1, 2, 3, 9])  # of points that there were once
    assert measured(obj).length == pytest.approx(35.0, rel=1e-6)


@pytest.mark.parametrize("radius", [2.5, 1.0, 0.0])
@pytest.mark.parametrize("falloff", ["NONE", *FALLOFFS])
def test_a_hook_pulls_a_bevelled_wire_as_blender_pulls_it(falloff, radius):
    """By its strength, and less where it falls off: a radius of zero is none."""
    obj = poly([(0.5, 0, 0), (1, 0, 0), (2, 1, 0), (3, 0, 0)])
    obj.body_moments.kind = "WIRE"
    target, modifier = hooked(obj, falloff_type=falloff, falloff_radius=radius, strength=0.6)
    modifier.matrix_inverse, target.location, target.scale = Matrix(), (0.5, 1.0, 2.0), (3.0, 1.0, 1.0)
    modifier.center = (0.25, 0.0, 0.0)
    shown = measured(obj)
    obj.data.bevel_depth = 0.01
    found = measured(obj)
    assert found.length == pytest.approx(shown.length, rel=1e-5)
    assert np.abs(found.mass_properties.center - shown.mass_properties.center).max() < 1e-5


def test_only_keys_that_have_a_value_move_a_wire():
    obj = poly([(0, 0, 0), (3, 0, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", 0.1
    obj.shape_key_add(name="Basis")
    for name, x, value, mute in (("Muted", 9, 1.0, True), ("Without", np.nan, 0.0, False), ("Half", 5, 0.5, False)):
        key = obj.shape_key_add(name=name)
        key.data[1].co, key.value, key.mute = (x, 0, 0), value, mute
    blocks = obj.data.shape_keys.key_blocks
    blocks["Basis"].value, blocks["Basis"].relative_key = 1.0, blocks["Half"]
    assert measured(obj).length == pytest.approx(4.0, rel=1e-6)
    obj.show_only_shape_key, obj.active_shape_key_index = True, 3
    assert measured(obj).length == pytest.approx(5.0, rel=1e-6)


def modifier_names(obj):
    return [[modifier.name for modifier in part] for part in spline_modifiers(obj)]


def test_modifiers_move_control_points_up_to_the_first_one_that_makes_a_mesh():
    obj = poly([(0, 0, 0), (3, 0, 0)])
    for name, kind in (("Cast", "CAST"), ("Hook", "HOOK"), ("Wave", "WAVE")):
        obj.modifiers.new(name, kind).show_in_editmode = True
    assert modifier_names(obj) == [["Cast", "Hook"], ["Wave"]]
    obj.modifiers["Wave"].use_apply_on_spline = True
    assert modifier_names(obj) == [["Cast", "Hook", "Wave"], []]
    obj.modifiers.new("Array", "ARRAY")
    obj.modifiers.new("Late", "HOOK")
    obj.modifiers.move(obj.modifiers.find("Late"), 4)
    assert modifier_names(obj) == [["Cast", "Hook", "Wave"], ["Array", "Late"]]
    for name in ("Hook", "Wave"):
        obj.modifiers[name].show_viewport = False
    assert modifier_names(obj) == [[], ["Cast", "Array", "Late"]]
    obj.modifiers["Hook"].show_viewport, obj.modifiers["Hook"].show_in_editmode = True, False
    assert modifier_names(obj) == [["Cast", "Hook"], ["Array", "Late"]]
    bpy.ops.object.mode_set(mode="EDIT")
    obj.modifiers["Cast"].show_in_editmode = True
    assert "Hook" not in modifier_names(obj)[0] + modifier_names(obj)[1]
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("uniform", [False, True])
def test_the_falloff_of_a_hook_is_measured_in_the_curve_or_as_it_was_when_hooked(uniform):
    """Of two points at 1 and 3 from its center only the nearer one is within 2, unless lengths are halved first."""
    obj = poly([(1, 0, 0), (3, 0, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", 0.1
    target, modifier = hooked(obj, falloff_type="CONSTANT", falloff_radius=2.0, use_falloff_uniform=uniform)
    modifier.matrix_inverse, target.scale = Matrix.Scale(0.5, 4), (3.0, 3.0, 3.0)
    low, high = (1.5, 4.5) if uniform else (1.5, 3.0)
    found = measured(obj)
    assert found.length == pytest.approx(high - low, rel=1e-6)
    assert found.mass_properties.center[0] == pytest.approx((low + high) / 2.0, rel=1e-6)
    obj.data.bevel_depth = 0.0
    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    assert sorted(vertex.co.x for vertex in mesh.vertices) == pytest.approx([low, high], rel=1e-6)


def test_keys_that_are_not_relative_are_left_to_what_blender_shows():
    obj = poly([(0, 0, 0), (3, 0, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", 0.1
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Large")
    key.data[1].co = (6, 0, 0)
    key.value = 1.0
    assert measured(obj).length == pytest.approx(6.0)
    obj.data.shape_keys.use_relative = False
    assert measured(obj).length == pytest.approx(3.0)


def test_knots_are_known_where_they_give_the_length_that_blender_has():
    """Blender gives the length of a spline, and of its knots nothing."""
    obj = circle()
    for cyclic in (True, False):
        spline = obj.data.splines[0]
        spline.use_cyclic_u, spline.use_endpoint_u = cyclic, not cyclic
        bpy.context.view_layer.update()
        curve = curves._curve(
            "NURBS",
            cyclic,
            spline.order_u,
            spline.use_bezier_u,
            spline.use_endpoint_u,
            curves._control_points(spline),
            curves.weighted_points(spline)[:, 3].astype(float),
        )
        length = spline.calc_length(resolution=curves.STEPS_PER_POINT)
        for share, expected in (
            *((0.0, True), (0.98e-4, True), (-0.98e-4, True), (1.05e-4, False), (-1.05e-4, False)),
            *((5e-4, False), (-5e-4, False)),
        ):
            asked = []
            other = SimpleNamespace(
                points=spline.points,
                use_cyclic_u=cyclic,
                calc_length=lambda resolution, found=(1.0 + share) * length, asked=asked: (
                    asked.append(resolution) or found
                ),
            )
            assert curves._has_known_knots(other, curve) is expected, (cyclic, share)
            assert asked == [curves.STEPS_PER_POINT]
    assert curves._has_known_knots(spline, None) is True
    moved = Curve(curve.space, curve.points + (1e4, 0, 0), curve.weights)
    for share, expected in ((9e-3, True), (-9e-3, True), (15e-3, False), (-15e-3, False)):
        far = SimpleNamespace(points=spline.points, use_cyclic_u=False)
        far.calc_length = lambda resolution, found=(1.0 + share) * length: found
        assert curves._has_known_knots(far, moved) is expected  # of which float32 has fewer digits


def test_a_hook_falls_off_as_its_curve_says_from_one_to_nothing():
    """At a quarter of the radius: three quarters of the way from there."""
    near, root = 0.75, 0.75**0.5
    expected = {
        **{"CONSTANT": 1.0, "LINEAR": near, "SHARP": near**2, "ROOT": root, "INVERSE_SQUARE": 1.0 - 0.25**2},
        **{"SMOOTH": 3.0 * near**2 - 2.0 * near**3, "SPHERE": (1.0 - 0.25**2) ** 0.5},
    }
    assert FALLOFFS.keys() == expected.keys()
    for name, value in expected.items():
        ends = (1.0, 1.0 if name == "CONSTANT" else 0.0)
        assert np.abs(FALLOFFS[name](np.array([0.0, 0.25, 1.0])) - (ends[0], value, ends[1])).max() < 1e-15, name


def test_pieces_of_a_straight_line_are_straight_each_by_its_own_length():
    """What float32 leaves of a long one is more than a short one's length."""
    data = bpy.data.curves.new("Line", "CURVE")
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(2)
    way = np.array([0.3, 0.7, 0.9])
    for point, (before, at, after) in zip(spline.bezier_points, [(-1, 0, 2e-4), (5e-4, 1e-3, 200), (700, 999, 1400)]):
        point.handle_left, point.co, point.handle_right = before * way, at * way, after * way
    assert curves._is_straight(spline) is True
    spline.bezier_points[0].handle_right = 2e-4 * way + (1e-8, 0.0, 0.0)
    assert curves._is_straight(spline) is False


@pytest.mark.parametrize("size", [0.25, 1.0, 8.0])
def test_what_float32_may_have_moved_bounds_the_length_of_a_circle(size):
    """Grown by as much as a point may have been moved, it is longer by that times the full angle."""
    obj = circle()
    obj.body_moments.kind, obj.scale = "WIRE", (size, size, size)
    bpy.context.view_layer.update()
    body = measure_body(obj, bpy.context.evaluated_depsgraph_get()).body
    moved = 2.0**-24 * size
    assert 2.0 * np.pi * moved <= body.length.input_error[0] <= 40.0 * np.pi * moved
    for nothing, measure in ((body.volume, "volume"), (body.area, "area")):
        assert nothing.order == 3 and nothing.measure == measure and not nothing.raw.any()
    for nothing, measure in zip(body.moments(5, True), ("volume", "area")):
        assert nothing.order == 5 and nothing.measure == measure and not nothing.raw.any()


@pytest.mark.parametrize(("fill", "is_filled"), [("BOTH", True), ("NONE", False)])
def test_a_region_is_a_sheet_of_its_outlines_whether_it_is_filled_or_not(fill, is_filled):
    obj = circle("bezier")
    obj.data.dimensions, obj.data.fill_mode, obj.body_moments.kind = "2D", fill, "SHELL"
    found = measured(obj)
    assert ("curve_not_filled" in said(found)) == (not is_filled) and found.error_bound["estimated"]
    assert (found.health.closed, found.health.components, found.area_moments.order) == (False, 1, 3)
    body = measure_body(obj, bpy.context.evaluated_depsgraph_get()).body
    assert body.volume.measure == "volume" and not body.volume.raw.any() and body.volume.order == 3
    assert np.pi * 2.0**-24 <= body.area.input_error[0] <= 16.0 * np.pi * 2.0**-24
