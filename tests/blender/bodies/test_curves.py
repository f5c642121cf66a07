# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curve objects: wires, and the flat regions that closed ones bound, from control points."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.region import flat_region
from body_moments.blender.bodies.measure_body import measure_body
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read.splines import FALLOFFS
from body_moments.blender.settings.options import MeasureOptions
from mathutils import Matrix

from tests.blender.characters import armature_of
from tests.blender.findings import refused, said
from tests.blender.objects import add, measured
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def bezier_area(obj):
    """The area of four cubic quarters by Green's theorem, with the handles' length k: 4 (1/2 + 3k/5
    - 3k²/20).
    """
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
    assert np.allclose(
        wire.mass_properties.principal.moments, np.array([2.5, 2.5, 5.0]) * np.pi, rtol=1e-7
    )
    obj.scale = (2.0, 2.0, 2.0)
    assert measured(obj).length == pytest.approx(4.0 * np.pi, rel=1e-8)
    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.0
    assert measured(obj).mass_properties.mass == pytest.approx(3.0)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("away", [0.0, 1e4])
@pytest.mark.parametrize("cyclic", [True, False])
def test_cyclic_wire_is_closed_at_any_size_and_place(cyclic, away, size):
    obj = poly([(0, 0, 0), (1, 0, 0), (1, 1, 0)], cyclic)
    obj.body_moments.kind = "WIRE"
    obj.scale, obj.location.x = (size, size, size), away * size
    assert measured(obj).health.closed == cyclic


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
def test_wire_length_bound_covers_float32(unit):
    """Short rods far away, of which each end may have been moved by half a unit in the last place,
    2^-15 at 1000.
    """
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
    assert ("section_fill" in said(disc)) == (dimensions == "3D")
    assert disc.mass_properties.inertia[0, 1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("far", [1e4, 1e6])
def test_the_region_of_an_object_far_away_is_the_same(far):
    obj = circle("bezier")
    obj.body_moments.kind = "SHELL"
    near = measured(obj).area
    obj.location = (far, far, 0.0)
    assert measured(obj).area == pytest.approx(near, rel=1e-9)


@pytest.mark.filterwarnings("error")
def test_overflowing_region_moments_are_refused():
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


def test_crossing_curve_is_measured_by_its_fill_or_refused():
    crossing = poly([(0, 0, 0), (2, 0, 0), (0, 1, 0), (2, 1, 0)], cyclic=True)
    crossing.body_moments.kind = "SHELL"
    with refused("curves_bound_nothing"):
        measured(crossing)
    crossing.data.dimensions, crossing.data.fill_mode = "2D", "BOTH"
    found = measured(crossing)
    assert str(found.method) == "shell" and found.area > 0.0  # whatever Blender fills
    assert said(found)["curve_fill_measured"]["cause"]["code"] == "curves_bound_nothing"


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
            next(
                socket for socket in node.inputs if socket.name == name and socket.enabled
            ).default_value = value
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
def test_catmull_rom_wire_has_length_of_display(kind):
    obj = circle(kind)
    obj.body_moments.kind = "WIRE"
    with_nodes(obj, "GeometryNodeCurveSplineType", spline_type="CATMULL_ROM")
    obj.data.resolution_u = 100
    wire = measured(obj)
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = np.array([vertex.co for vertex in mesh.vertices], np.float64)
    ends = np.array([edge.vertices for edge in mesh.edges])
    assert wire.length == pytest.approx(
        np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).sum(), rel=1e-4
    )


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


def test_partly_bevelled_wire_is_measured_whole():
    obj = circle()
    obj.body_moments.kind, obj.data.bevel_depth, obj.data.bevel_factor_end = "WIRE", 0.1, 0.5
    found = measured(obj)
    assert found.length == pytest.approx(2.0 * np.pi, rel=1e-7)
    assert said(found) == {"curve_measured_whole": {"ignored": "the start and end of its bevel"}}


def test_flat_region_takes_varying_density():
    obj = circle("bezier")
    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
    settings = obj.body_moments
    settings.kind, settings.thickness = "SHELL", 0.5
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "200 + 100*x"
    found = measured(obj)
    assert found.density_from.code == "density_from_polynomial"
    # Blender's polygon is smaller
    assert found.mass_properties.mass == pytest.approx(100.0 * np.pi, rel=5e-3)
    assert found.mass_properties.center[0] == pytest.approx(0.125, rel=5e-3)
    assert "display_mesh_measured" in said(found)


@pytest.mark.parametrize("source", ["POLYNOMIAL", "MATERIALS"])
def test_wire_keeps_linear_density_and_stays_current(source):
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
    with refused("control_points_invalid", obj.name):
        measured(obj)
    round_one = circle("bezier")
    round_one.body_moments.kind, round_one.data.bevel_depth = "WIRE", bevel
    point = round_one.data.splines[0].bezier_points[1]
    point.handle_left_type = point.handle_right_type = "FREE"
    point.handle_right.z = float("nan")
    with refused("control_points_invalid", round_one.name):
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


def test_hook_of_a_bone_moves_wire_with_the_bone():
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
    modifier.matrix_inverse, target.location, target.scale = (
        Matrix(),
        (0.5, 1.0, 2.0),
        (3.0, 1.0, 1.0),
    )
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
    for name, x, value, mute in (
        ("Muted", 9, 1.0, True),
        ("Without", np.nan, 0.0, False),
        ("Half", 5, 0.5, False),
    ):
        key = obj.shape_key_add(name=name)
        key.data[1].co, key.value, key.mute = (x, 0, 0), value, mute
    blocks = obj.data.shape_keys.key_blocks
    blocks["Basis"].value, blocks["Basis"].relative_key = 1.0, blocks["Half"]
    assert measured(obj).length == pytest.approx(4.0, rel=1e-6)
    obj.show_only_shape_key, obj.active_shape_key_index = True, 3
    assert measured(obj).length == pytest.approx(5.0, rel=1e-6)


def test_absolute_shape_keys_are_read_from_display():
    obj = poly([(0, 0, 0), (3, 0, 0)])
    obj.body_moments.kind, obj.data.bevel_depth = "WIRE", 0.1
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Large")
    key.data[1].co = (6, 0, 0)
    key.value = 1.0
    assert measured(obj).length == pytest.approx(6.0)
    obj.data.shape_keys.use_relative = False
    assert measured(obj).length == pytest.approx(3.0)
