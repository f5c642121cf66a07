# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sections of meshes, curves and texts against closed forms, their refusals, and when they are out
of date.
"""

import math

import bpy
import numpy as np
import pytest
from body_moments.blender import bodies
from body_moments.blender.bodies.flat.region import flat_region
from body_moments.blender.read.section import read_section
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale

from tests.blender.findings import refused as refusal
from tests.blender.findings import said
from tests.blender.flat_objects import I_BEAM, T, W, X, Y, flat_mesh
from tests.blender.objects import add, dent, mesh_body
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

I_AREA = 4 * X * (Y - T) + 4 * W * T
I_X = (2 * X * (2 * Y) ** 3 - 2 * (X - W) * (2 * T) ** 3) / 12
I_Y = (2 * (Y - T) * (2 * X) ** 3 + 2 * T * (2 * W) ** 3) / 12


def square(x, y, size):
    return [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]


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
    bpy.context.view_layer.update()
    return bodies.section_of(obj, bpy.context.evaluated_depsgraph_get())


def refused(obj, code, **values):
    with refusal(code, obj.name, **values):
        section_of(obj)
    return True


def stored(obj):
    from body_moments.blender.write import section

    return section.stored(obj)


def outdated(obj):

    return staleness.stale_reason(obj, bpy.context.scene, Kind.SECTION)


@pytest.mark.parametrize(
    "data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM), lambda: curve_of(I_BEAM[::-1])]
)
def test_an_i_beam_is_that_of_the_tables(data):
    section, _, findings = section_of(add(data(), location=(1, 2, 3)))
    assert close(section.area, I_AREA, rel=1e-14)
    assert section.second == pytest.approx((I_X, I_Y, 0.0), rel=1e-13, abs=1e-14)
    assert close(section.principal, (I_X, I_Y), rel=1e-13) and section.angle == 0.0
    assert section.center == pytest.approx((1, 2, 3), abs=1e-14)
    assert close(section.moduli[:2], (I_X / Y, I_Y / X), rel=1e-13)
    assert (
        section.plane.axes == pytest.approx(np.eye(3), abs=1e-15)
        and section.plane.x_axis_name == "X"
    )
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
    # as the object's z axis
    assert section.plane.axes[:, 2] == pytest.approx((0, 0, np.sign(scale[2])), abs=1e-15)
    a, b = abs(scale[0]), abs(scale[1])
    assert close(section.area, I_AREA * a * b, rel=1e-13)
    assert close(section.second[:2], (I_X * a * b**3, I_Y * b * a**3), rel=1e-13)


@pytest.mark.parametrize("data", [lambda: flat_mesh(I_BEAM), lambda: curve_of(I_BEAM)])
@pytest.mark.parametrize("height", [1.0, 0.0, 1e-30])
def test_flattened_object_keeps_its_own_section_axes(data, height):
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
    assert sorted(section.principal) == pytest.approx(
        sorted((d * e**3 / 48, e * d**3 / 48)), rel=1e-6
    )
    frame = read_section(obj, bpy.context.evaluated_depsgraph_get()).rotation
    assert np.abs(frame - np.array(obj.matrix_world.decompose()[1].to_matrix())).max() < 1e-6


def test_holes_of_letters_count_and_letters_add_up():
    obj = add(text_of("A"))
    single, _, findings = section_of(obj)
    assert (single.outlines, single.holes) == (1, 1)
    assert "drawn_as_polygons" in said(findings)
    obj.data.body = "AA"
    both, _, _ = section_of(obj)
    assert both.area == pytest.approx(2 * single.area, rel=1e-6) and both.holes == 2
    assert both.input_error["area"] < 1e-5 * both.area


def test_touching_outlines_are_measured_despite_wrong_fill():
    section, _, findings = section_of(add(curve_of(square(0, 0, 4), square(4, 1, 2))))
    assert section.area == 20
    assert "section_fill_wrong" in said(findings)


@pytest.mark.parametrize("kind", ["POLY", "NURBS"])
def test_modifier_that_only_renders_is_reported(kind):
    obj = add(curve_of(square(0, 0, 2), kind=kind))
    obj.modifiers.new("Bend", "SIMPLE_DEFORM").show_viewport = False
    bpy.context.view_layer.update()
    region = flat_region(obj, bpy.context.evaluated_depsgraph_get())
    for findings in (section_of(obj)[2], region.findings):
        (difference,) = said(findings)["render_differs"]["differences"]
        assert difference["code"] == "render_modifier_differs"


@pytest.mark.parametrize(
    "outlines, code",
    [
        ([[(0, 0), (2, 2), (2, 0), (0, 2)]], "outlines_cross"),
        ([square(0, 0, 4), square(2, 2, 4)], "outlines_cross"),
        ([square(0, 0, 4), square(0, 0, 4)], "outlines_coincide"),
    ],
)
def test_outlines_that_cross_or_coincide_are_refused(outlines, code):
    assert refused(add(curve_of(*outlines)), code)


@pytest.mark.parametrize("setting", ["extrude", "bevel_depth", "offset"])
@pytest.mark.parametrize("data", [lambda: curve_of(I_BEAM), lambda: text_of("A")])
def test_extruded_or_offset_outline_is_refused(data, setting):
    obj = add(data())
    setattr(obj.data, setting, 0.1)
    assert refused(obj, "flat_unsuitable")
    setattr(obj.data, setting, 0.0)
    obj.data.bevel_object = add(curve_of(square(0, 0, 1)), "Profile")
    obj.data.bevel_mode = "ROUND"
    assert section_of(obj)[0].area > 0.0
    obj.data.bevel_mode = "OBJECT"
    assert refused(obj, "flat_unsuitable")


def test_open_splines_are_left_out_or_refused():
    assert refused(add(curve_of(square(0, 0, 1), closed=False)), "no_section_area")
    curve = curve_of(square(0, 0, 2), square(5, 5, 1))
    curve.splines[1].use_cyclic_u = False
    section, _, findings = section_of(add(curve))
    assert section.area == 4 and said(findings) == {"section_splines_open": {"count": 1}}
    space = curve_of(square(0, 0, 1))
    space.dimensions = "3D"
    assert refused(add(space), "flat_unsuitable")
    assert refused(add(text_of("")), "no_section_area")


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
    assert section_of(obj)[0].plane.axes[:, 2] == pytest.approx(
        -np.array(obj.matrix_world)[:3, 2], abs=1e-6
    )
    selected(obj, lambda face: face.normal.x < -0.9)
    assert section_of(obj)[0].plane.x_axis_name == "Y"  # the x axis stands upright on that side
    selected(obj, lambda face: abs(face.normal.z) > 0.9)
    assert refused(obj, "section_not_flat")
    assert (
        read_section(obj, bpy.context.evaluated_depsgraph_get()).description == "2 Selected Faces"
    )
    selected(obj, lambda face: False)
    assert refused(obj, "no_section_area")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_section_modifiers_count_in_object_mode_only():
    obj = add(flat_mesh(square(0, 0, 2)))
    modifier = obj.modifiers.new("Array", "ARRAY")
    modifier.relative_offset_displace = 1.5, 0, 0
    section, _, findings = section_of(obj)
    assert section.area == 8 and section.outlines == 2 and section.centroid[0] == pytest.approx(2.5)
    selected(obj, lambda face: True)
    section, _, findings = section_of(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert section.area == 4 and said(findings) == {"modifiers_left_out": {"modifiers": ["Array"]}}


def test_body_is_no_section_and_nearly_flat_face_is():
    assert refused(add(mesh_body()), "section_not_flat")
    mesh = flat_mesh(square(0, 0, 2))
    mesh.vertices[0].co.z = 1e-5
    section, _, findings = section_of(add(mesh))
    assert (
        section.area == pytest.approx(4, rel=1e-9) and said(findings)["section_projected"]["slight"]
    )


def test_hidden_objects_and_infinite_points_are_refused():
    for data in (flat_mesh(I_BEAM), curve_of(I_BEAM)):
        obj = add(data)
        obj.hide_viewport = True
        assert refused(obj, "hidden_in_viewport")
    mesh = flat_mesh(I_BEAM)
    mesh.vertices[0].co.x = float("nan")
    assert refused(add(mesh), "non_finite_vertices", count=1)


def test_stored_section_is_read_back_exactly():
    obj = add(curve_of(I_BEAM), location=(1, 2, 3), rotation=(0.1, 0.2, 0.3))
    truth, what, findings = section_of(obj)
    assert bpy.ops.object.body_moments_measure_section() == {"FINISHED"}
    found = stored(obj)
    assert (found.description, found.findings) == (what, findings)
    for name, value in vars(truth).items():
        assert name == "plane" or np.array_equal(getattr(found.section, name), value), name
    assert np.array_equal(found.section.plane.axes, truth.plane.axes)


def test_section_is_stale_after_shape_place_or_unit_change():
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
    assert outdated(obj) == Stale.TRANSFORM
    obj.location.x = 0.0
    update()
    assert outdated(obj) is None
    bpy.context.scene.unit_settings.scale_length = 0.5
    assert outdated(obj) == Stale.UNIT_SCALE
    bpy.context.scene.unit_settings.scale_length = 1.0
    dent(obj, -1.0)
    assert outdated(obj) == Stale.GEOMETRY
    bpy.ops.object.body_moments_measure_section()
    update()
    assert outdated(obj) is None


def test_a_section_survives_the_file_and_clear_takes_it_away(tmp_path):
    add(flat_mesh(I_BEAM))
    bpy.ops.object.body_moments_measure_section()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.object
    assert stored(obj).section.area == I_AREA and outdated(obj) is None
    dent(obj, -1.0)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.context.object
    assert outdated(obj) == Stale.GEOMETRY
    bpy.ops.object.body_moments_clear()
    assert stored(obj) is None and "body_section" not in obj


def test_curve_region_moments_overflow_is_refused():
    bpy.ops.curve.primitive_bezier_circle_add()
    obj = bpy.context.object
    obj.data.dimensions, obj.data.fill_mode, obj.scale = "2D", "BOTH", (1e15, 1e15, 1.0)
    bpy.context.view_layer.update()
    region = flat_region(obj, bpy.context.evaluated_depsgraph_get())
    assert region.curves and close(region.moments(2).total, np.pi * 1e30, rel=1e-3)
    with refusal("moments_overflow", order=24):
        region.moments(24)
