# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of an object by itself: which objects have one, its pose, and how far its moments go."""

import bmesh
import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.shape.shape import NoShapeError, shape_of, surface_shape_of

from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.findings import refused
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, mesh_body, strip_mesh
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def shape(obj):
    bpy.context.view_layer.update()
    return shape_of(obj, bpy.context.evaluated_depsgraph_get())


def prisms(*corners, offset=0.0):
    """Regular prisms one above the other, with these numbers of corners, the first of which is along x."""
    points, faces = [], []
    for level, count in enumerate(corners):
        first, angles = len(points), 2.0 * np.pi * np.arange(count) / count
        for z in (2.0 * level, 2.0 * level + 1.5):
            points += [(np.cos(angle) + offset, np.sin(angle), z) for angle in angles]
        faces += [tuple(first + i for i in range(count))[::-1], tuple(first + count + i for i in range(count))]
        faces += [
            (first + i, first + (i + 1) % count, first + count + (i + 1) % count, first + count + i)
            for i in range(count)
        ]
    mesh = bpy.data.meshes.new("Prisms")
    mesh.from_pydata(points, [], faces)
    return mesh


def test_what_has_no_shape_of_its_own_is_refused_with_its_measurement(tmp_path):
    cloud = volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((3, 3, 3), "f4")))
    bpy.ops.curve.primitive_bezier_circle_add()
    wire = bpy.context.object
    wire.body_moments.kind = "WIRE"
    wall = add(box_mesh(1, 2, 3))
    wall.body_moments.kind, wall.body_moments.wall, wall.body_moments.thickness = "SHELL", "INWARD", 0.1
    for obj, code in ((cloud, "shape_of_grid"), (wire, "shape_of_wire_or_wall"), (wall, "shape_of_wire_or_wall")):
        with pytest.raises(NoShapeError) as caught:
            shape(obj)
        assert (caught.value.finding.code, caught.value.subject) == (code, obj.name)
        assert caught.value.measurement.mass_properties.mass > 0.0
    wall.body_moments.wall = "THIN"
    assert shape(wall).moments.measure == "area"


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 16.0])
def test_a_shape_is_seen_as_far_away_as_rounding_leaves_it(size):
    """Its largest radius of gyration is (13/12)^0.5; a hundred thousandth of that is rounding from 4.69e10 m on."""
    obj = add(box_mesh(1, 2, 3), scale=(size,) * 3)
    for place, is_seen in ((4.6e10, True), (4.8e10, False)):
        obj.location = (1.0, -place * size, 2.0)
        if is_seen:
            assert close(shape(obj).size, size * (13.0 / 12.0) ** 0.5, 1e-12)
            continue
        with refused("shape_far_from_origin", obj.name):
            shape(obj)


@pytest.mark.filterwarnings("error")
def test_a_shape_whose_sixth_moments_are_no_numbers_is_refused_without_a_warning_of_numpy():
    obj = add(mesh_body())
    for size, is_known in ((1e30, True), (1e36, False)):
        obj.scale = (size,) * 3
        if is_known:
            assert np.isfinite(shape(obj).moments.raw).all()
            continue
        with refused("object_too_large"):
            _ = shape(obj).moments


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("corners", [((0, 0), (3, 0), (1, 2)), ((0, 0), (1, 0), (1, 1), (0, 1))])
def test_a_region_whose_sixth_moments_are_no_numbers_is_refused_without_a_warning_of_numpy(corners):
    """The axes of a square need them as well."""
    curve = bpy.data.curves.new("Region", "CURVE")
    curve.dimensions = "2D"
    spline = curve.splines.new("POLY")
    spline.points.add(len(corners) - 1)
    spline.points.foreach_set("co", [value for x, y in corners for value in (1e5 * x, 1e5 * y, 0.0, 1.0)])
    spline.use_cyclic_u = True
    obj = add(curve)
    obj.body_moments.kind = "SHELL"
    for size, is_known in ((1e30, True), (1e36, False)):
        obj.scale = (size,) * 3
        if is_known:
            assert shape(obj).moments.order == 6
        else:
            with refused("object_too_large"):
                shape(obj)
        with refused("signature_needs_polygons" if is_known else "object_too_large"):  # whose axes nobody asks for
            surface_shape_of(obj, bpy.context.evaluated_depsgraph_get())


def test_prisms_that_are_round_to_sixth_order_have_the_axes_that_their_corners_give():
    """A prism of seven corners on one of eight: nothing but the plane of both first corners makes a copy of them."""
    obj, turn = add(prisms(7, 8)), 0.7
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    found = []
    for angle in (0.0, turn):
        obj.rotation_euler.z = angle
        pose = shape(obj).pose()
        assert (pose["symmetry"], pose["symmetry_order"], pose["unique"]) == ("Cs", 30, True)
        found.append(np.array(pose["matrix"]))
    assert np.abs(found[1][:3, :3] @ rotation - found[0][:3, :3]).max() < 1e-5
    obj.data = prisms(7)
    assert (shape(obj).pose()["symmetry"], shape(obj).pose()["unique"]) == ("D7h", False)
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "1000 + 10*x"
    pose = shape(obj).pose()
    assert (pose["symmetry"], pose["symmetry_order"]) == (None, None)
    assert np.array(pose["matrix"]).shape == (4, 4)


def test_the_signature_of_a_sheet_stops_at_order_20():
    obj = add(mesh_body())
    sizes = {}
    for kind in ("SOLID", "SHELL"):
        obj.body_moments.kind = kind
        one = shape(obj)
        low, high = one.signature(20), one.signature(21)
        sizes[kind] = [len(found.zernike) for found in (low, high)]
        points = one.points_about_center()
        assert len(points) == len(obj.data.vertices) and close(one.signature(6).size, high.size, 1e-9)
        assert np.abs(high.zernike[: len(low.zernike)] - low.zernike).max() < 1e-9
    assert sizes["SHELL"] == 2 * sizes["SOLID"][:1] and sizes["SOLID"][1] > sizes["SOLID"][0]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
def test_the_signature_is_that_of_the_body_in_any_size_and_wherever_it_stands(kind):
    obj, found = add(mesh_body()), []
    obj.body_moments.kind = kind
    for size in (0.2, 0.2 * 2.0**-40, 0.2 * 2.0**40):
        obj.scale, obj.location = (size,) * 3, size * np.array([3.0, 4.0, 5.0])
        one = shape(obj)
        found.append(one.signature())
        spread = one.moments.second().trace() / one.moments.total
        assert close(found[-1].size, spread**0.5, 1e-9) and close(found[-1].size, size / 0.2 * found[0].size, 1e-6)
        for name in ("invariants", "zernike", "chirality", *(["fourier"] if kind == "SOLID" else [])):
            numbers, first = getattr(found[-1], name), getattr(found[0], name)
            assert np.abs(numbers - first).max() < 1e-6 * np.abs(first).max()


def test_a_sheet_that_is_open_has_a_signature_and_a_solid_that_cannot_be_closed_has_no_shape():
    plate = add(box_mesh(1, 2, 3))
    work = bmesh.new()
    work.from_mesh(plate.data)
    bmesh.ops.delete(work, geom=work.faces[:2], context="FACES")
    work.to_mesh(plate.data)
    work.free()
    plate.body_moments.kind = "SHELL"
    sheet = shape(plate)
    assert close(sheet.moments.total, sheet.measurement.area, 1e-12)
    assert close(sheet.signature().size ** 2, sheet.moments.second().trace() / sheet.moments.total, 1e-9)
    strip = add(strip_mesh())
    work = bmesh.new()
    work.from_mesh(strip.data)
    work.from_mesh(box_mesh(1, 2, 3))
    work.to_mesh(strip.data)
    work.free()
    with refused("shape_of_open_surface", strip.name):
        shape(strip)
    strip.body_moments.kind = "SHELL"
    assert shape(strip).moments.measure == "area"


def test_the_moments_of_what_patches_show_are_those_of_its_polygons():
    cube = shape(add(box_mesh(1, 2, 3)))
    assert cube.piece_moments() is cube.moments
    bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(3, 4, 5))
    one, depsgraph = shape(bpy.context.object), bpy.context.evaluated_depsgraph_get()
    mesh = bmesh.new()
    mesh.from_mesh(bpy.data.meshes.new_from_object(bpy.context.object.evaluated_get(depsgraph)))
    drawn = mesh.calc_volume()
    mesh.free()
    assert close(one.moments.total, 4.0 * np.pi / 3.0, 1e-6) and drawn < 0.99 * one.moments.total
    found = one.piece_moments()
    assert (
        found.measure == "volume" and close(found.total, drawn, 1e-5) and np.abs(found.about - [3, 4, 5]).max() < 1e-5
    )


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("corners, group", [(7, "D7h"), (40, "D∞h")])
def test_a_flat_plate_is_as_round_as_its_corners_say_wherever_it_stands(corners, group):
    """How far rounding puts its corners out of the plane says nothing."""
    angles = 2.0 * np.pi * np.arange(corners) / corners
    mesh = bpy.data.meshes.new("Plate")
    mesh.from_pydata([(np.cos(angle), np.sin(angle), 0.0) for angle in angles], [], [tuple(range(corners))])
    obj = add(mesh)
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    for turn, where in (((0, 0, 0), (0, 0, 0)), ((0.3, 0.4, 0.5), (100, 200, 300))):
        obj.rotation_euler, obj.location = turn, where
        pose = shape(obj).pose()
        assert (pose["symmetry"], pose["symmetry_order"], pose["unique"]) == (group, 30, False)
