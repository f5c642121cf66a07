# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of meshes, curves and texts against closed forms, their refusals, and when they are out of date."""

import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.read.section import read_section

from tests.blender.findings import refused as refusal
from tests.blender.findings import said
from tests.blender.objects import add, mesh_body, only
from tests.close import close
from tests.panels.drawing import Layout

pytestmark = pytest.mark.usefixtures("scene")

W, T, X, Y = 0.125, 1.75, 1.0, 2.0  # an I section whose corners float32 has exactly
I_BEAM = [(-X, -Y), (X, -Y), (X, -T), (W, -T), (W, T), (X, T), (X, Y), (-X, Y), (-X, T), (-W, T), (-W, -T), (-X, -T)]
I_AREA = 4 * X * (Y - T) + 4 * W * T
I_X = (2 * X * (2 * Y) ** 3 - 2 * (X - W) * (2 * T) ** 3) / 12
I_Y = (2 * (Y - T) * (2 * X) ** 3 + 2 * T * (2 * W) ** 3) / 12


def square(x, y, size):
    return [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]


def flat_mesh(*polygons, height=0.0):
    mesh = bpy.data.meshes.new("Flat")
    starts = np.cumsum([0] + [len(polygon) for polygon in polygons])
    mesh.from_pydata(
        [(x, y, height) for polygon in polygons for x, y in polygon],
        [],
        [tuple(range(a, b)) for a, b in zip(starts, starts[1:])],
    )
    return mesh


def curve_of(*outlines, closed=True, kind="POLY"):
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    for outline in outlines:
        spline = curve.splines.new(kind)
        spline.points.add(len(outline) - 1)
        for point, (x, y) in zip(spline.points, outline):
            point.co = x, y, 0.0, 1.0
        spline.use_cyclic_u = closed
    return curve


def text_of(body):
    text = bpy.data.curves.new("Text", "FONT")
    text.body = body
    return text


def section_of(obj):
    from body_moments.operators.measure import section

    bpy.context.view_layer.update()
    return section.section_of(obj, bpy.context.evaluated_depsgraph_get())


def refused(obj, code, **values):
    with refusal(code, obj.name, **values):
        section_of(obj)
    return True


def stored(obj):
    from body_moments.blender.write import section

    return section.stored(obj)


def outdated(obj):
    from body_moments.operators.measure import section

    return section.stale_reason(obj, bpy.context.scene, stored(obj))


@pytest.mark.parametrize("data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM), lambda: curve_of(I_BEAM[::-1])])
def test_an_i_beam_is_that_of_the_tables(data):
    section, _, findings = section_of(add(data(), location=(1, 2, 3)))
    assert close(section.area, I_AREA, rel=1e-14)
    assert section.second == pytest.approx((I_X, I_Y, 0.0), rel=1e-13, abs=1e-14)
    assert close(section.principal, (I_X, I_Y), rel=1e-13) and section.angle == 0.0
    assert section.center == pytest.approx((1, 2, 3), abs=1e-14)
    assert close(section.moduli[:2], (I_X / Y, I_Y / X), rel=1e-13)
    assert section.plane.axes == pytest.approx(np.eye(3), abs=1e-15) and section.plane.x_axis_name == "X"
    assert findings == ()


@pytest.mark.parametrize("data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM)])
@pytest.mark.parametrize("rotation", [(0.3, -0.7, 1.1), (math.pi / 2, 0, 0), (0, math.pi / 2, 0)])
def test_a_turned_object_has_the_section_in_its_own_axes(data, rotation):
    obj = add(data(), location=(10, -20, 30), rotation=rotation)
    section, _, findings = section_of(obj)
    matrix = np.array(obj.matrix_world)
    assert section.plane.axes == pytest.approx(matrix[:3, :3], abs=1e-6)
    assert section.area == pytest.approx(I_AREA, rel=1e-6)  # float32 matrices
    assert section.second[:2] == pytest.approx((I_X, I_Y), rel=1e-6)
    assert abs(section.second[2]) < 1e-6 and section.angle == 0.0
    assert section.center == pytest.approx((10, -20, 30), abs=1e-12)
    assert findings == ()


@pytest.mark.parametrize("data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM)])
@pytest.mark.parametrize("scale", [(2, 2, 2), (3, 0.5, 1), (-2, 1, 1), (2, 1, -5)])
def test_scale_also_uneven_and_mirroring_is_measured(data, scale):
    section, _, _ = section_of(add(data(), scale=scale))
    assert section.plane.axes[:, 2] == pytest.approx((0, 0, np.sign(scale[2])), abs=1e-15)  # as the object's z axis
    a, b = abs(scale[0]), abs(scale[1])
    assert close(section.area, I_AREA * a * b, rel=1e-13)
    assert close(section.second[:2], (I_X * a * b**3, I_Y * b * a**3), rel=1e-13)


@pytest.mark.parametrize("data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM)])
@pytest.mark.parametrize("height", [1.0, 0.0, 1e-30])
def test_an_object_that_a_zero_scale_has_flattened_keeps_its_own_axes(data, height):
    """`decompose()` has no rotation for it, and Blender's answer is no axis of the object."""
    section, _, _ = section_of(add(data(), rotation=(0.3, 0.4, 0.5), scale=(1, 1, height)))
    assert section.second == pytest.approx((I_X, I_Y, 0.0), rel=1e-6, abs=1e-6 * I_X)
    assert section.plane.x_axis_name == "X"


@pytest.mark.parametrize("height", [1.0, 1e-15])
def test_a_sheared_object_is_measured_as_it_is_seen(height):
    parent = add(None, "Parent", scale=(2, 1, height))
    obj = add(flat_mesh(square(0, 0, 2)), rotation=(0, 0, math.pi / 4))
    obj.parent = parent
    section, _, _ = section_of(obj)
    # the square stands on a corner and is stretched to a rhombus of diagonals 4√2 and 2√2
    d, e = 4 * math.sqrt(2), 2 * math.sqrt(2)
    assert section.area == pytest.approx(d * e / 2, rel=1e-6)
    assert sorted(section.principal) == pytest.approx(sorted((d * e**3 / 48, e * d**3 / 48)), rel=1e-6)
    frame = read_section(obj, bpy.context.evaluated_depsgraph_get()).rotation
    assert np.abs(frame - np.array(obj.matrix_world.decompose()[1].to_matrix())).max() < 1e-6


def test_the_scenes_unit_makes_it_si():
    bpy.context.scene.unit_settings.scale_length = 0.001
    section, _, _ = section_of(add(flat_mesh(I_BEAM)))
    assert close(section.area, I_AREA * 1e-6, rel=1e-14)
    assert close(section.second[0], I_X * 1e-12, rel=1e-13)


def test_a_polygon_tends_to_the_circle():
    shares = []
    for n in (32, 64):
        angle = 2 * np.pi * np.arange(n) / n
        section, _, _ = section_of(add(flat_mesh(list(zip(np.cos(angle), np.sin(angle))))))
        assert section.axes_undetermined
        shares.append([1 - section.area / math.pi, 1 - section.polar / (math.pi / 2)])
    assert np.array(shares[0]) / shares[1] == pytest.approx([4.0, 4.0], rel=0.02)


def test_a_bezier_circle_is_measured_as_its_polygon_and_says_the_resolution():
    curve = bpy.data.curves.new("Circle", "CURVE")
    curve.dimensions, curve.fill_mode = "2D", "BOTH"
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(3)
    spline.use_cyclic_u = True
    for point, (x, y) in zip(spline.bezier_points, [(1, 0), (0, 1), (-1, 0), (0, -1)]):
        point.co = x, y, 0
        point.handle_left_type = point.handle_right_type = "AUTO"
    curve.resolution_u = 24
    obj = add(curve)
    bpy.context.view_layer.update()
    section, what, findings = section_of(obj)
    assert what == "Curve" and section.area == pytest.approx(math.pi, rel=3e-3)
    assert said(findings) == {"section_drawn_as_polygons": {"corners": 96, "resolution": "24"}}


def test_nested_outlines_of_a_curve_are_holes_and_islands_whichever_way_they_run():
    section, _, _ = section_of(add(curve_of(square(0, 0, 8), square(1, 1, 6), square(3, 3, 2)[::-1], square(9, 0, 1))))
    assert section.area == 64 - 36 + 4 + 1
    assert (section.outlines, section.holes) == (3, 1)


def test_holes_of_letters_count_and_letters_add_up():
    obj = add(text_of("A"))
    single, _, findings = section_of(obj)
    assert (single.outlines, single.holes) == (1, 1)
    assert said(findings)["section_drawn_as_polygons"]["resolution"] == "12"
    obj.data.body = "AA"
    both, _, _ = section_of(obj)
    assert both.area == pytest.approx(2 * single.area, rel=1e-6) and both.holes == 2
    assert both.input_error["area"] < 1e-5 * both.area


def test_a_text_on_a_curve_is_measured_where_it_is():
    path = add(curve_of([(0, 0), (5, 5), (10, 0)], closed=False), "Path")
    path.data.fill_mode = "NONE"
    obj = add(text_of("AB"))
    straight, _, _ = section_of(obj)
    obj.data.follow_curve = path
    along, _, _ = section_of(obj)
    assert along.area == pytest.approx(straight.area, rel=1e-5)
    assert np.linalg.norm(along.center - straight.center) > 0.1


def test_outlines_that_touch_are_measured_rightly_where_blender_fills_them_wrongly():
    section, _, findings = section_of(add(curve_of(square(0, 0, 4), square(4, 1, 2))))
    assert section.area == 20
    assert "section_fill_wrong" in said(findings)


@pytest.mark.parametrize(
    "outlines, code",
    [
        ([[(0, 0), (2, 2), (2, 0), (0, 2)]], "outlines_cross_at"),
        ([square(0, 0, 4), square(2, 2, 4)], "outlines_cross_at"),
        ([square(0, 0, 4), square(0, 0, 4)], "outlines_coincide"),
    ],
)
def test_outlines_that_cross_or_coincide_are_refused(outlines, code):
    assert refused(add(curve_of(*outlines)), code)


def test_lines_between_faces_that_share_no_corners_are_no_perimeter():
    found, _, findings = section_of(add(flat_mesh(square(0, 0, 2), square(2, 0, 1), square(2, 1, 1))))
    assert found.perimeter == pytest.approx(10.0, abs=1e-14) and found.area == 6.0 and not findings
    assert found.rounding_error["perimeter"] < 1e-11
    found = section_of(add(curve_of(square(0, 0, 4), square(0, 1, 2))))[0]  # a hole that touches from within
    assert found.perimeter == pytest.approx(20.0, abs=1e-14)


@pytest.mark.parametrize(
    "setting, code",
    [("extrude", "section_extruded"), ("bevel_depth", "section_extruded"), ("offset", "section_offset")],
)
@pytest.mark.parametrize("data", [lambda: curve_of(I_BEAM), lambda: text_of("A")])
def test_what_is_not_an_outline_any_more_is_refused(data, setting, code):
    obj = add(data())
    setattr(obj.data, setting, 0.1)
    assert refused(obj, code)
    setattr(obj.data, setting, 0.0)
    obj.data.bevel_object = add(curve_of(square(0, 0, 1)), "Profile")
    obj.data.bevel_mode = "ROUND"
    assert section_of(obj)[0].area > 0.0
    obj.data.bevel_mode = "OBJECT"
    assert refused(obj, "section_extruded")


def test_curves_that_enclose_nothing_are_refused_and_open_splines_left_out():
    assert refused(add(curve_of(square(0, 0, 1), closed=False)), "section_no_outline_curve")
    curve = curve_of(square(0, 0, 2), square(5, 5, 1))
    curve.splines[1].use_cyclic_u = False
    section, _, findings = section_of(add(curve))
    assert section.area == 4 and said(findings) == {"section_splines_open": {"count": 1}}
    space = curve_of(square(0, 0, 1))
    space.dimensions = "3D"
    assert refused(add(space), "section_3d_curve")
    assert refused(add(text_of("")), "section_no_outline_text")


def test_a_curve_in_edit_mode_is_measured_as_it_is_now():
    obj = add(curve_of(square(0, 0, 4)))
    bpy.ops.object.mode_set(mode="EDIT")
    obj.data.splines[0].points[0].co = -4, -4, 0, 1
    section, _, _ = section_of(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert section.area == 32


def selected(obj, chosen):
    """In Edit Mode, with the faces selected for which `chosen` holds."""
    import bmesh

    bpy.ops.object.mode_set(mode="EDIT")
    mesh = bmesh.from_edit_mesh(obj.data)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.tool_settings.mesh_select_mode = False, False, True
    for face in mesh.faces:
        face.select_set(chosen(face))
    bmesh.update_edit_mesh(obj.data)


def test_a_text_in_edit_mode_is_measured_as_it_is_now():
    obj = add(text_of("A"))
    single, _, _ = section_of(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.font.text_insert(text="A")
    double, _, _ = section_of(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert double.area == pytest.approx(2 * single.area, rel=1e-6)


def test_a_curve_with_modifiers_is_measured_as_they_leave_it():
    obj = add(curve_of(square(0, 0, 2)))
    obj.modifiers.new("Array", "ARRAY").relative_offset_displace = 1.5, 0, 0
    section, what, findings = section_of(obj)
    assert what == "All Faces" and section.area == 8 and "section_modified_fill" in said(findings)


def edited(obj):
    import bmesh

    return bmesh.from_edit_mesh(obj.data)


def test_selected_faces_of_a_body_are_a_section_in_any_plane():
    obj = add(mesh_body(), location=(3, 0, 0), rotation=(0.4, 0.2, 0.9))
    selected(obj, lambda face: face.normal.z > 0.9)
    section, what, _ = section_of(obj)
    assert what == "1 Selected Face"
    assert section.area == pytest.approx(4.5, rel=1e-6)  # the L of bodies.py
    assert section.plane.axes == pytest.approx(np.array(obj.matrix_world)[:3, :3], abs=1e-6)
    for vertex in edited(obj).verts:  # as it is now: edits that nothing has told Blender of
        vertex.co *= 2.0
    assert section_of(obj)[0].area == pytest.approx(18.0, rel=1e-6)
    selected(obj, lambda face: face.normal.z < -0.9)
    assert section_of(obj)[0].plane.axes[:, 2] == pytest.approx(-np.array(obj.matrix_world)[:3, 2], abs=1e-6)
    selected(obj, lambda face: face.normal.x < -0.9)
    assert section_of(obj)[0].plane.x_axis_name == "Y"  # the x axis stands upright on that side
    selected(obj, lambda face: abs(face.normal.z) > 0.9)
    assert refused(obj, "section_not_flat")
    assert read_section(obj, bpy.context.evaluated_depsgraph_get()).description == "2 Selected Faces"
    selected(obj, lambda face: False)
    assert refused(obj, "section_no_selected_face")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_modifiers_count_in_object_mode_and_are_said_to_be_left_out_in_edit_mode():
    obj = add(flat_mesh(square(0, 0, 2)))
    modifier = obj.modifiers.new("Array", "ARRAY")
    modifier.relative_offset_displace = 1.5, 0, 0
    section, _, findings = section_of(obj)
    assert section.area == 8 and section.outlines == 2 and section.centroid[0] == pytest.approx(2.5)
    selected(obj, lambda face: True)
    section, _, findings = section_of(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert section.area == 4 and said(findings) == {"section_without_modifiers": {"modifiers": ["Array"]}}


def test_faces_with_a_hole_between_them_and_unwelded_neighbors_have_the_right_outline():
    ring = [square(x, y, 1) for x in range(3) for y in range(3) if (x, y) != (1, 1)]
    section, _, _ = section_of(add(flat_mesh(*ring)))
    assert section.area == 8 and section.perimeter == 16
    assert (section.outlines, section.holes) == (1, 1)


def test_a_body_is_refused_and_what_is_nearly_flat_is_measured():
    assert refused(add(mesh_body()), "section_not_flat")
    mesh = flat_mesh(square(0, 0, 2))
    mesh.vertices[0].co.z = 1e-5
    section, _, findings = section_of(add(mesh))
    assert section.area == pytest.approx(4, rel=1e-9) and "section_projected_slightly" in said(findings)


def test_hidden_objects_and_infinite_points_are_refused():
    for data in (flat_mesh(I_BEAM), curve_of(I_BEAM)):
        obj = add(data)
        obj.hide_viewport = True
        assert refused(obj, "disabled_in_viewports")
    mesh = flat_mesh(I_BEAM)
    mesh.vertices[0].co.x = float("nan")
    assert refused(add(mesh), "non_finite_vertices", count=1)


def test_the_operator_stores_the_section_and_reads_it_back_to_the_last_digit():
    obj = add(curve_of(I_BEAM), location=(1, 2, 3), rotation=(0.1, 0.2, 0.3))
    truth, what, findings = section_of(obj)
    assert bpy.ops.object.body_moments_measure_section() == {"FINISHED"}
    found = stored(obj)
    assert (found.description, found.findings) == (what, findings)
    for name in (
        "area",
        "perimeter",
        "angle",
        "principal",
        "polar",
        "outlines",
        "holes",
        "rounding_error",
        "input_error",
        "axes_undetermined",
    ):
        assert getattr(found.section, name) == getattr(truth, name)
    for name in ("second", "centroid", "center", "radii", "moduli"):
        assert np.array_equal(getattr(found.section, name), getattr(truth, name))
    assert np.array_equal(found.section.plane.axes, truth.plane.axes)


def test_out_of_date_after_a_change_of_shape_place_or_unit_and_not_after_measuring():
    obj = add(flat_mesh(I_BEAM))
    update = bpy.context.view_layer.update
    bpy.ops.object.body_moments_measure_section()
    update()
    assert outdated(obj) is None
    obj.body_moments.density = 5.0
    update()
    assert outdated(obj) is None
    obj.location.x = 2.0
    update()
    assert outdated(obj) == "stale_transform"
    obj.location.x = 0.0
    update()
    assert outdated(obj) is None
    bpy.context.scene.unit_settings.scale_length = 0.5
    assert outdated(obj) == "stale_unit_scale"
    bpy.context.scene.unit_settings.scale_length = 1.0
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    update()
    assert outdated(obj) == "stale_geometry"
    bpy.ops.object.body_moments_measure_section()
    update()
    assert outdated(obj) is None


def test_body_and_section_grow_old_apart():
    from body_moments.blender.session.tracking import staleness

    obj = add(mesh_body())
    update, scene = bpy.context.view_layer.update, bpy.context.scene
    bpy.ops.object.body_moments_measure()
    selected(obj, lambda face: face.normal.z > 0.9)
    bpy.ops.object.body_moments_measure_section()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.body_moments_measure()
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    update()
    assert staleness.stale_reason(obj, scene) == outdated(obj) == "stale_geometry"
    bpy.ops.object.body_moments_measure()
    update()
    assert staleness.stale_reason(obj, scene) is None and outdated(obj) == "stale_geometry"
    selected(obj, lambda face: face.normal.z > 0.9)
    bpy.ops.object.body_moments_measure_section()
    assert outdated(obj) is None
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_section_survives_the_file_and_clear_takes_it_away(tmp_path):
    add(flat_mesh(I_BEAM))
    bpy.ops.object.body_moments_measure_section()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.object
    assert stored(obj).section.area == I_AREA and outdated(obj) is None
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    bpy.context.view_layer.update()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.object
    assert outdated(obj) == "stale_geometry"
    bpy.ops.object.body_moments_clear()
    assert stored(obj) is None and "body_section" not in obj


def drawn(closed=()):
    from body_moments.panels.measure.section import VIEW3D_PT_body_moments_section as panel

    assert panel.poll(bpy.context)
    layout = Layout(closed=closed)
    panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout.record


def region_of(obj, **options):
    from body_moments.blender.bodies.flat.flat import flat_region

    bpy.context.view_layer.update()
    return flat_region(obj, bpy.context.evaluated_depsgraph_get(), **options)


def test_outlines_that_overlap_without_a_crossing_are_refused():
    assert refused(add(curve_of(square(0, 0, 4), square(2, 0, 4))), "outlines_cross")


def test_outlines_that_touch_are_measured_by_their_polygons():
    region = region_of(add(curve_of(square(0, 0, 4), square(0, 1, 2))))
    assert not region.curves and close(region.moments(2).total, 12.0, rel=1e-14)


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 3, 1), (0.25, 0.5, 4)])
def test_what_blender_fills_is_compared_at_every_scale(scale):
    touching = add(curve_of(square(0, 0, 4), square(4, 1, 2)), scale=scale)
    assert "section_fill_wrong" in said(section_of(touching)[2])
    apart = add(curve_of(square(0, 0, 4), square(5, 1, 2)), scale=scale)
    found, _, findings = section_of(apart)
    assert not said(findings) and close(found.area, 20.0 * scale[0] * scale[1], rel=1e-6)


def edit_with_square(sheet, number):
    """Edit Mode, with one of several squares selected."""
    for kind, count in (("vertices", 4), ("edges", 4), ("polygons", 1)):
        parts = getattr(sheet.data, kind)
        parts.foreach_set("select", [i // count == number for i in range(len(parts))])
    only(sheet)
    bpy.ops.object.mode_set(mode="EDIT")


def test_points_that_are_nowhere_are_refused():
    obj = add(curve_of(square(0, 0, 4)))
    obj.data.splines[0].points[1].co.x = float("nan")
    assert refused(obj, "section_non_finite")
    sheet = add(flat_mesh(square(0, 0, 1), square(5, 0, 2)))
    sheet.data.vertices[5].co.y = float("nan")
    for number in range(2):  # the other one says how large the mesh is
        edit_with_square(sheet, number)
        assert refused(sheet, "section_non_finite")
        bpy.ops.object.mode_set(mode="OBJECT")


def test_flat_moments_beyond_the_range_of_numbers_are_refused():
    region = region_of(add(flat_mesh(square(-2, -2, 4)), scale=(1e15, 1e15, 1)))
    assert close(region.moments(2).total, 16e30, rel=1e-6)
    with refusal("moments_overflow", order=24):
        region.moments(24)


def test_curves_that_polygons_leave_out_are_left_out_of_the_region_too():
    """Of resolution 1 a lens of two points is a line there and back."""
    bpy.ops.curve.primitive_bezier_circle_add()
    obj = bpy.context.object
    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
    lens = obj.data.splines.new("BEZIER")
    lens.bezier_points.add(1)
    for point, x in zip(lens.bezier_points, (3.0, 5.0)):
        point.co, point.handle_left, point.handle_right = (x, 0, 0), (x, 2 * x - 8, 0), (x, 8 - 2 * x, 0)
    lens.use_cyclic_u = True
    both = region_of(obj)
    assert len(both.curves) == 2 and both.moments(0).total > np.pi + 1.0
    lens.resolution_u = 1
    alone = region_of(obj)
    assert not alone.curves and close(alone.moments(0).total, np.pi, rel=0.02)


def test_moments_of_a_region_of_curves_beyond_the_range_of_numbers_are_refused():
    bpy.ops.curve.primitive_bezier_circle_add()
    obj = bpy.context.object
    obj.data.dimensions, obj.data.fill_mode, obj.scale = "2D", "BOTH", (1e15, 1e15, 1.0)
    region = region_of(obj)
    assert region.curves and close(region.moments(2).total, np.pi * 1e30, rel=1e-3)
    with refusal("moments_overflow", order=24):
        region.moments(24)


@pytest.mark.parametrize("is_reversed", [False, True])
@pytest.mark.parametrize("size", [0.125, 1.0, 8.0])
def test_a_region_of_curves_scales_with_its_unit_and_its_size_whichever_way_they_run(size, is_reversed):
    bpy.ops.curve.primitive_bezier_circle_add(location=(3, 4, 5))
    obj = bpy.context.object
    obj.data.dimensions, obj.data.fill_mode = "2D", "BOTH"
    if is_reversed:
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.curve.select_all(action="SELECT")
        bpy.ops.curve.switch_direction()
        bpy.ops.object.mode_set(mode="OBJECT")
    for exact in (True, False):
        whole, scaled = region_of(obj, exact=exact), region_of(obj, exact=exact, unit=size)
        assert bool(whole.curves) == bool(scaled.curves) == exact
        assert close([scaled.stored, scaled.drawn_area], [size * whole.stored, size**2 * whole.drawn_area], rel=1e-12)
        assert close(scaled.location, size * np.array([3.0, 4.0, 5.0]), rel=1e-12)
        one, other = whole.moments(2), scaled.moments(2)
        assert one.total > 3.0 and close(other.total, size**2 * one.total, rel=1e-12)
        assert close(other.input_error[0], size**2 * one.input_error[0], rel=1e-6)
        assert one.input_error[0] >= 2.0 * np.pi * whole.stored * (1.0 - 1e-2)


@pytest.mark.parametrize("size", [0.5, 2.0])
def test_how_flat_and_how_well_filled_a_region_is_is_said_by_its_size(size):
    from body_moments.blender.bodies.flat.flat import area_findings

    def codes(off=0.0, stored=1e-9, drawn=None):
        found = SimpleNamespace(plane=SimpleNamespace(out_of_plane=off), stored=stored, drawn_area=drawn)
        return {one.code: one.values["share"] for one in area_findings(found, size**2)}

    assert not codes() and not codes(3.9e-3 * size, 1e-3 * size) and not codes(drawn=size**2)
    for share, code in ((0.9e-4, "section_projected_slightly"), (1.1e-4, "section_projected")):
        assert codes(share * size) == {code: pytest.approx(share)}
    assert codes(4.1e-3 * size, 1e-3 * size) == {"section_projected": pytest.approx(4.1e-3)}
    for share, wrong in ((1.0 + 0.9e-4, False), (1.0 - 0.9e-4, False), (1.0 + 1.1e-4, True), (1.0 - 1.1e-4, True)):
        assert codes(drawn=share * size**2) == (
            {"section_fill_wrong": pytest.approx(share, rel=1e-12)} if wrong else {}
        )
