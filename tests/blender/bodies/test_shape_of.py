# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of an object by itself: which objects have one, its pose, and how far its moments
go.
"""

from types import SimpleNamespace

import bmesh
import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.shape.object_shape import NoShapeError, shape_of
from body_moments.blender.bodies.shape.surface_distance import SurfaceDistance
from body_moments.core.mesh.surface import Surface
from body_moments.core.numerics.rotations import rotation_matrix

from tests.blender.boxes import box_mesh
from tests.blender.findings import refused
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, mesh_body, strip_mesh
from tests.close import close
from tests.core.bodies import rotation
from tests.core.point_groups import orbit_of

pytestmark = pytest.mark.usefixtures("scene")


def shape(obj):
    bpy.context.view_layer.update()
    return shape_of(obj, bpy.context.evaluated_depsgraph_get())


def prisms(*corners, offset=0.0):
    """Regular prisms one above the other, with these numbers of corners, the first of which is
    along x.
    """
    points, faces = [], []
    for level, count in enumerate(corners):
        first, angles = len(points), 2.0 * np.pi * np.arange(count) / count
        for z in (2.0 * level, 2.0 * level + 1.5):
            points += [(np.cos(angle) + offset, np.sin(angle), z) for angle in angles]
        faces += [
            tuple(first + i for i in range(count))[::-1],
            tuple(first + count + i for i in range(count)),
        ]
        faces += [
            (first + i, first + (i + 1) % count, first + count + (i + 1) % count, first + count + i)
            for i in range(count)
        ]
    mesh = bpy.data.meshes.new("Prisms")
    mesh.from_pydata(points, [], faces)
    return mesh


def test_grid_wire_and_wall_have_no_shape(tmp_path):
    cloud = volume_object(tmp_path / "a.vdb", vdb_grid(np.ones((3, 3, 3), "f4")))
    bpy.ops.curve.primitive_bezier_circle_add()
    wire = bpy.context.object
    wire.body_moments.kind = "WIRE"
    wall = add(box_mesh(1, 2, 3))
    wall.body_moments.kind, wall.body_moments.wall, wall.body_moments.thickness = (
        "SHELL",
        "INWARD",
        0.1,
    )
    for obj, code in (
        (cloud, "shape_of_grid"),
        (wire, "wire_unsupported"),
        (wall, "wall_unsupported"),
    ):
        with pytest.raises(NoShapeError) as caught:
            shape(obj)
        assert (caught.value.finding.code, caught.value.subject) == (code, obj.name)
        assert caught.value.measurement.mass_properties.mass > 0.0
    wall.body_moments.wall = "THIN"
    assert shape(wall).moments.measure == "area"


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 16.0])
def test_a_shape_is_seen_as_far_away_as_rounding_leaves_it(size):
    """Its largest radius of gyration is (13/12)^0.5; a hundred thousandth of that is rounding from
    4.69e10 m on.
    """
    obj = add(box_mesh(1, 2, 3), scale=(size,) * 3)
    for place, is_seen in ((4.6e10, True), (4.8e10, False)):
        obj.location = (1.0, -place * size, 2.0)
        if is_seen:
            assert close(shape(obj).size, size * (13.0 / 12.0) ** 0.5, 1e-12)
            continue
        with refused("shape_unavailable", obj.name):
            shape(obj)


@pytest.mark.filterwarnings("error")
def test_overflowing_shape_moments_are_refused():
    obj = add(mesh_body())
    for size, is_known in ((1e30, True), (1e36, False)):
        obj.scale = (size,) * 3
        if is_known:
            assert np.isfinite(shape(obj).moments.raw).all()
            continue
        with refused("object_size"):
            _ = shape(obj).moments


def test_prisms_round_to_sixth_order_have_corner_axes():
    """A prism of seven corners on one of eight: nothing but the plane of both first corners makes a
    copy of them.
    """
    obj, turn = add(prisms(7, 8)), 0.7
    rotation = np.array(
        [[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]]
    )
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


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", ["SOLID", "SHELL"])
def test_signature_is_independent_of_size_and_place(kind):
    obj, found = add(mesh_body()), []
    obj.body_moments.kind = kind
    for size in (0.2, 0.2 * 2.0**-40, 0.2 * 2.0**40):
        obj.scale, obj.location = (size,) * 3, size * np.array([3.0, 4.0, 5.0])
        one = shape(obj)
        found.append(one.signature())
        spread = one.moments.second().trace() / one.moments.total
        assert close(found[-1].size, spread**0.5, 1e-9) and close(
            found[-1].size, size / 0.2 * found[0].size, 1e-6
        )
        for name in (
            "invariants",
            "zernike",
            "chirality",
            *(["fourier"] if kind == "SOLID" else []),
        ):
            numbers, first = getattr(found[-1], name), getattr(found[0], name)
            assert np.abs(numbers - first).max() < 1e-6 * np.abs(first).max()


def test_open_sheet_has_signature_and_open_solid_none():
    plate = add(box_mesh(1, 2, 3))
    work = bmesh.new()
    work.from_mesh(plate.data)
    bmesh.ops.delete(work, geom=work.faces[:2], context="FACES")
    work.to_mesh(plate.data)
    work.free()
    plate.body_moments.kind = "SHELL"
    sheet = shape(plate)
    assert close(sheet.moments.total, sheet.measurement.area, 1e-12)
    assert close(
        sheet.signature().size ** 2, sheet.moments.second().trace() / sheet.moments.total, 1e-9
    )
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


@pytest.mark.parametrize("name", ["C1", "D2d", "S8", "C5h", "C6", "D6", "T", "O", "I"])
def test_surface_decides_the_group_of_turned_and_moved_bodies(name):
    points, faces = orbit_of(name)
    for seed, away in enumerate((0.0, 3.0, 10.0)):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata((points @ rotation(seed).T + away).tolist(), [], faces.tolist())
        obj = add(mesh, rotation=(0.3, 0.4, 0.5 * seed), scale=(1, 1, (-1.0) ** seed))
        assert shape(obj).pose()["symmetry"] == name


def test_axes_hidden_by_coarse_coordinates_have_no_bound():
    points, faces = orbit_of("I")
    mesh = bpy.data.meshes.new("I")
    mesh.from_pydata((points + 200.0).tolist(), [], faces.tolist())
    pose = shape(add(mesh)).pose()
    assert (pose["symmetry"], pose["unique"], pose["angle_bound"]) == ("I", False, np.pi)
    bpy.ops.mesh.primitive_cylinder_add(vertices=32)
    settings = bpy.context.object.body_moments
    settings.density_from, settings.density_polynomial = "POLYNOMIAL", "1000 + 100*z"
    assert shape(bpy.context.object).pose()["angle_bound"] < 1e-3  # its axis is known


@pytest.mark.parametrize("corners", range(3, 10))
def test_pose_with_one_corner_off_is_bounded_or_not_unique(corners):
    """A corner 1e-4 off leaves no symmetry but perhaps a mirror; axes that only it fixes are badly
    known.
    """
    mesh, rng = prisms(corners), np.random.default_rng(corners)
    mesh.vertices[0].co = np.array(mesh.vertices[0].co) + (0.6e-4, 0.7e-4, 0.5e-4)
    points = np.array([[*vertex.co, 1.0] for vertex in mesh.vertices])
    found = []
    for _ in range(4):
        obj = add(mesh.copy(), location=rng.normal(size=3), rotation=rng.uniform(-3, 3, 3))
        pose = shape(obj).pose()
        assert pose["symmetry"] in ("C1", "Cs", "C1 or Cs")
        placed = points @ (np.array(pose["matrix"]) @ np.array(obj.matrix_world)).T
        found.append(
            (placed[:, :3], pose["angle_bound"] * 2.0 + pose["position_bound"], pose["unique"])
        )
    for (one, bound, unique), (other, *_, also) in zip(found, found[1:]):
        assert not (unique and also) or np.abs(one - other).max() < 2.0 * bound


def test_pose_of_clear_axes_is_unique_within_its_bounds():
    mesh, found = mesh_body(), []
    points = np.array([[*vertex.co, 1.0] for vertex in mesh.vertices])
    for turn in ((0, 0, 0), (0.3, 1.4, -0.5), (2.0, -1.0, 0.7)):
        obj = add(mesh.copy(), location=turn, rotation=turn)
        pose = shape(obj).pose()
        placed = points @ (np.array(pose["matrix"]) @ np.array(obj.matrix_world)).T
        found.append(placed[:, :3])
        assert pose["unique"] and pose["angle_bound"] < 1e-3
        off = np.linalg.norm(placed - np.array([*found[0].T, np.ones(len(points))]).T, axis=1)
        assert (
            off
            <= pose["position_bound"] + pose["angle_bound"] * np.linalg.norm(placed[:, :3], axis=1)
        ).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("corners, group", [(7, "D7h"), (40, "D∞h")])
def test_plate_symmetry_follows_its_corners_at_any_place(corners, group):
    """How far rounding puts its corners out of the plane says nothing."""
    angles = 2.0 * np.pi * np.arange(corners) / corners
    mesh = bpy.data.meshes.new("Plate")
    mesh.from_pydata(
        [(np.cos(angle), np.sin(angle), 0.0) for angle in angles], [], [tuple(range(corners))]
    )
    obj = add(mesh)
    obj.body_moments.kind, obj.body_moments.thickness = "SHELL", 0.01
    for turn, where in (((0, 0, 0), (0, 0, 0)), ((0.3, 0.4, 0.5), (100, 200, 300))):
        obj.rotation_euler, obj.location = turn, where
        pose = shape(obj).pose()
        assert (pose["symmetry"], pose["symmetry_order"], pose["unique"]) == (group, 30, False)


CENTER = np.array([3.0, -2.0, 5.0])


def skin_of(*surfaces, center=CENTER, size=1.0):
    return SurfaceDistance(SimpleNamespace(center=center, size=size, pieces=lambda: iter(surfaces)))


TETRAHEDRON = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0)])


FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_surface_distance_is_that_of_nearest_face(size):
    """Points below the lowest face, turned; what single precision would take for farther is found
    exactly.
    """
    center, turn = size * CENTER, rotation_matrix([0.8, 0.1, -0.3, 0.5])
    skin = skin_of(
        Surface(center + size * TETRAHEDRON @ turn.T, triangles=FACES), center=center, size=size
    )
    heights = size * np.geomspace(1e-8, 20.0, 300)
    below = np.stack([np.full(300, 0.3 * size), np.full(300, 0.4 * size), -heights], axis=1)
    points, is_near = center + below @ turn.T, (heights > 1.1e-5 * size) & (heights < 9e-3 * size)
    found = skin.distance(points)
    assert np.array_equal(found, [skin.distance(point[None])[0] for point in points])
    assert (
        np.abs(found - heights).max() < 1e-5 * size
        and (found <= heights * (1.0 + 1e-9))[is_near].all()
    )
    for within in (1e-4 * size, 5e-3 * size, 0.05 * size, 2.0 * size):
        told = skin.distance(points, within)
        assert np.array_equal(told <= within, heights <= within)
        assert (told <= heights * (1.0 + 1e-9))[is_near & (heights > within)].all()
