# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a flat object by itself, and which objects have one."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat_shape import OutlineDistance, flat_shape_of
from body_moments.blender.bodies.shape.shape import register_surfaces

from tests.blender.findings import refused
from tests.blender.flat_objects import sheet
from tests.blender.objects import only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
RECTANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0)])
TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (1.0, 2.0)])


def flat(obj, **more):
    bpy.context.view_layer.update()
    return flat_shape_of(obj, bpy.context.evaluated_depsgraph_get(), **more)


def outline(shape):
    skin = OutlineDistance(shape)
    for _ in skin.build():
        pass
    return skin


def test_a_rectangle_has_its_center_its_size_and_a_wall_along_its_edges():
    obj = sheet(RECTANGLE, location=(5, 6, 7), rotation=(0.3, 0.4, 0.5), scale=(0.5, 0.5, 0.5))
    shape, middle = flat(obj), np.array([1.0, 0.25, 0.0])
    turn = np.array(obj.matrix_world.to_quaternion().to_matrix(), float)
    assert np.abs(shape.rotation - turn).max() < 1e-6 and np.abs(shape.axes[:, 2] - turn[:, 2]).max() < 1e-6
    assert np.abs(shape.center - turn @ middle - [5, 6, 7]).max() < 1e-5
    assert close(shape.size, np.sqrt((2.0**2 + 0.5**2) / 12.0), 1e-6) and close(shape.radius, np.hypot(1.0, 0.25), 1e-6)
    corners = shape.corners @ shape.axes[:, :2].T @ turn
    assert np.abs(np.abs(corners) - [1.0, 0.25, 0.0]).max() < 1e-5
    assert shape.has_surface and not shape.is_display_mesh
    (wall,) = shape.pieces()
    triangles = (wall.points[wall.all_triangles()[0]] - shape.center) @ turn
    assert close(np.abs(triangles[..., 2]), shape.size, 1e-5)
    assert np.abs(np.abs(triangles[..., :2]) - [1.0, 0.25]).max() < 1e-5
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2.0
    assert close(np.sort(areas), shape.size * np.array([0.5] * 4 + [2.0] * 4), 1e-5)
    assert close(flat(obj, unit=0.25).size, 0.25 * shape.size, 1e-12)


@pytest.mark.filterwarnings("error")
def test_the_signature_of_a_flat_shape_is_that_of_it_in_any_size_and_to_the_order_that_is_asked_for():
    obj = sheet(TRIANGLE * 0.3, scale=(1, 1, 1))
    plain = flat(obj)
    for size in (2.0**-40, 2.0**40):
        obj.scale = (size,) * 3
        found, wanted = flat(obj).signature(), plain.signature()
        assert close(found.size, size * plain.size, 1e-12) and close(wanted.size, plain.size, 1e-12)
        for name in ("invariants", "zernike", "chirality"):
            one, other = getattr(found, name), getattr(wanted, name)
            assert len(other) and np.abs(one - other).max() < 1e-9 * np.abs(other).max()
    longest, low = plain.signature(21).zernike, plain.signature(8).zernike
    assert np.array_equal(longest, plain.signature().zernike)
    assert len(low) < len(longest) and np.abs(longest[: len(low)] - low).max() < 1e-9


def test_curves_are_looked_at_as_finely_whatever_they_are_drawn_with_and_as_polygons():
    bpy.ops.curve.primitive_bezier_circle_add()
    obj = bpy.context.object
    obj.data.dimensions = "2D"
    for resolution in (2, 12):
        obj.data.resolution_u = resolution
        shape = flat(obj)
        assert len(shape.corners) == 4 * 64  # segments, each in as many steps
        (x, p), (y, q) = shape.region.points[shape.region.edges].T
        assert close(shape.moments.total, (x * q - p * y).sum() / 2.0, 1e-12)


def test_of_a_mesh_in_edit_mode_all_faces_count():
    obj = sheet([(0, 0), (1, 0), (1, 1), (0, 1), (3, 0), (3, 1)], faces=[(0, 1, 2, 3), (1, 4, 5, 2)])
    for polygon in obj.data.polygons:
        polygon.select = polygon.index == 0
    only(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    found = flat(obj).moments.total
    bpy.ops.object.mode_set(mode="OBJECT")
    assert close(found, 3.0, 1e-12)


@pytest.mark.parametrize("size", [2.0**-10, 8.0])
def test_a_flat_shape_is_seen_as_far_away_as_rounding_leaves_it(size):
    """A radius of gyration times a hundred thousandth is rounding from 4.5e10 times that radius on."""
    obj = sheet(RECTANGLE, scale=(size,) * 3)
    gyration = size * (17.0 / 12.0) ** 0.5
    for place in (4.4e10, 4.6e10):
        obj.location = (1.0, -place * gyration, 2.0)
        if place < 4.5e10:
            assert close(flat(obj).size, gyration, 1e-9)
            continue
        with refused("shape_far_from_origin", obj.name):
            flat(obj)


@pytest.mark.parametrize("sizes", [(1e-3, 1e-3), (1e-3, 4e-3), (4e-3, 1e-3), (1e3, 3e3)])
def test_a_flat_shape_of_any_size_is_turned_onto_another_one(sizes):
    small, large = (
        sheet(TRIANGLE, name, location=where, rotation=turn, scale=(size,) * 3)
        for name, size, where, turn in zip("ab", sizes, ((1, 2, 3), (-4, 5, 6)), ((0.3, 0.2, 0.1), (1.0, -0.5, 2.0)))
    )
    source, target = flat(small), flat(large)
    fit = register_surfaces(source, target, outline(source), outline(target), sizes[1] / sizes[0])
    turns = [np.array(obj.matrix_world.to_quaternion().to_matrix(), float) for obj in (small, large)]
    assert np.abs(fit.rotation @ turns[0] - turns[1]).max() < 1e-5 and not fit.is_mirror_image


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_what_is_nearly_a_square_is_one_by_the_tolerance_at_any_size(size):
    obj = sheet([(0, 0), (1, 0), (1, 1.003), (0, 1)], location=(3, 4, 5), rotation=(1, 2, 3), scale=(size,) * 3)
    shape = flat(obj)
    skin = outline(shape)
    for tolerance, group in ((1e-4, "C1"), (0.02, "C4v")):
        assert [found.group for found in shape.find_symmetries(skin, tolerance)] == [group, group]
