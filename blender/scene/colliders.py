# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Colliders as objects: children of their body, in a collection of their own, displayed as wire and
not rendered.

A hull has its origin at its own center, because Godot Physics and others take the origin for the
center, and its vertices along the body's own axes: so it is exact wherever the body lies, and
follows its scale. A primitive has its pose in the body's frame; its parent inverse undoes the
body's scale.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import copysign

import bmesh
import bpy
import numpy as np
from bpy.types import Context, Mesh, Object
from mathutils import Matrix

from ...core.bodies import float64_matrix
from ...core.mesh import Surface
from ...core.numerics import Array, polar_rotation, quaternion
from ...core.polyhedron import volume_and_center
from ...core.robots import Pose, Shape
from ...core.verdict import EditRefusedError
from ..read.mesh import mesh_surface
from ..settings.given import COLLIDER
from .changes import made_collection
from .empties import PLACE_RTOL
from .findings import TRANSFORM_CONSTRAINED

# odd, so that no ring lies on the equator
SEGMENTS = 32
RINGS = 17
COLLECTION = "body_moments_colliders"  # ID property of the collection
HULL, CYLINDER = "mesh", "cylinder"
PREFIXES = {"box": "UBX", "sphere": "USP", "capsule": "UCP"}  # Unreal knows no other primitives.
NAMES = {
    "NONE": "{name} Collider {number:02d}",
    "UNREAL": "{prefix}_{name}_{number:02d}",
    "GODOT": "{name}_{number:02d}-convcolonly",
    "GODOT_MESH": "{name}_{number:02d}-colonly",
    "UNITY": "{name}_Collider_{number:02d}",
}


def colliders_by_body(objects: Iterable[Object]) -> dict[Object, list[Object]]:
    """Return the colliders of each body that has any, by name."""
    by_body: dict[Object, list[Object]] = {}
    for obj in sorted(objects, key=lambda obj: obj.name):
        if COLLIDER in obj and obj.parent is not None:
            by_body.setdefault(obj.parent, []).append(obj)
    return by_body


def stretch_of(obj: Object, rotation: Array) -> Array:
    """Return the (3, 3) map from an object's own coordinates to its frame: scale and shear."""
    return rotation.T @ float64_matrix(obj.matrix_world)[:3, :3]


def as_stored(shape: Shape, stretch: Array, unit: float) -> Shape:
    """Return a shape with the vertices of its hull as a mesh of the object stores them, in the
    object's frame in m.
    """
    if shape.surface is None:
        return shape
    center, points = _origin_and_points(shape, stretch, unit)
    triangles = shape.surface.all_triangles()[0]
    stored = (points + center) @ stretch.T * unit
    return replace(shape, surface=Surface.from_triangles(stored, triangles))


def _origin_and_points(shape: Shape, stretch: Array, unit: float) -> tuple[Array, Array]:
    """Return a hull's (3,) center and its (n, 3) points from there, as its object stores them."""
    assert shape.surface is not None
    points = shape.surface.points @ shape.pose.rotation.T + shape.pose.position
    points = np.linalg.solve(stretch, points.T).T / unit
    center = volume_and_center(Surface.from_triangles(points, shape.surface.all_triangles()[0]))[1]
    if not np.isfinite(center).all():  # a flat hull has no volume
        center = points.mean(axis=0)
    center = center.astype(np.float32).astype(np.float64)
    return center, (points - center).astype(np.float32).astype(np.float64)


def collider_mesh(shape: Shape, stretch: Array, unit: float) -> Mesh:
    """Return the mesh of a hull about its center, or of a primitive in its own frame, in Blender's
    units.
    """
    mesh = bpy.data.meshes.new("Collider")
    if shape.surface is None:
        _draw_primitive(mesh, shape, unit)
    else:
        corners = shape.surface.all_triangles()[0][:, :: -1 if np.linalg.det(stretch) < 0.0 else 1]
        mesh.from_pydata(_origin_and_points(shape, stretch, unit)[1], [], corners)
    return mesh


def place_colliders(
    context: Context,
    obj: Object,
    old: Sequence[Object],
    shapes: Sequence[Shape],
    meshes: Sequence[Mesh],
    stretch: Array,
    unit: float,
    engine: str,
) -> list[Object]:
    """Give an object a collider for each shape, with the mesh of the same index, and return them.
    The objects of the `old` ones are used again, surplus ones removed. stretch: see `stretch_of`.
    engine: a key of NAMES.
    """
    collection = made_collection(context, COLLECTION, True, "Colliders")
    colliders = list(old[: len(shapes)])
    for collider in colliders:
        collider.name = "Collider"  # no name stands in the way of another
    replaced = {collider.data for collider in old}
    bpy.data.batch_remove(old[len(shapes) :])
    undo_scale = Matrix(np.linalg.inv(stretch).tolist()).to_4x4()
    for index, (shape, mesh) in enumerate(zip(shapes, meshes)):
        if index == len(colliders):
            colliders.append(bpy.data.objects.new("Collider", mesh))
            collection.objects.link(colliders[index])
        collider = colliders[index]
        collider.data = mesh
        collider.display_type = "WIRE"
        collider.hide_render = True
        collider.parent = obj
        collider.matrix_parent_inverse = undo_scale if shape.surface is None else Matrix()
        collider.matrix_basis = Matrix()
        collider.rotation_mode = "QUATERNION"
        if shape.surface is None:
            collider.location = shape.pose.position / unit
            collider.rotation_quaternion = quaternion(shape.pose.rotation)
        else:
            collider.location = _origin_and_points(shape, stretch, unit)[0]
        collider[COLLIDER] = {
            "kind": shape.kind,
            "size": [float(size) for size in shape.size],
            "mass": shape.mass,
        }
        collider.body_moments.mass_from = "MASS"
        collider.body_moments.mass = shape.mass
    for number, (collider, shape) in enumerate(zip(colliders, shapes), 1):
        names = {"name": obj.name, "number": number, "prefix": PREFIXES.get(shape.kind, "UCX")}
        collider.name = collider.data.name = NAMES[engine].format(**names)
    bpy.data.batch_remove([mesh for mesh in replaced if not mesh.users])
    if obj.type == "CURVE":
        _undo_path(context, obj, colliders)
    return colliders


def _undo_path(context: Context, curve: Object, colliders: Sequence[Object]) -> None:
    """Take back the place along a curve's path, on which the curve lays its children.

    Raises EditRefusedError if the colliders are still elsewhere.
    """
    context.view_layer.update()
    place = float64_matrix(curve.matrix_world)
    wanted = []
    for collider in colliders:
        inverse = float64_matrix(collider.matrix_parent_inverse)
        in_curve = inverse @ float64_matrix(collider.matrix_basis)
        # the curve's own place times the place along its path
        path_place = float64_matrix(collider.matrix_world) @ np.linalg.inv(in_curve)
        undone = np.linalg.solve(path_place, place @ inverse)
        collider.matrix_parent_inverse = Matrix(undone.tolist())
        wanted.append(place @ in_curve)
    context.view_layer.update()
    off = np.array([float64_matrix(collider.matrix_world) for collider in colliders]) - wanted
    if not np.abs(off).max(initial=0.0) <= PLACE_RTOL * np.abs(wanted).max(initial=1.0):
        raise EditRefusedError(TRANSFORM_CONSTRAINED, channel="location", sources=[curve.name])


def _in_body(collider: Object) -> Array:
    """Return the (4, 4) transform of a collider in its body's own coordinates."""
    if collider.parent.type == "CURVE":  # the parent inverse also undoes the place along the path
        to_body = np.linalg.inv(float64_matrix(collider.parent.matrix_world))
        return to_body @ float64_matrix(collider.matrix_world)
    return float64_matrix(collider.matrix_parent_inverse) @ float64_matrix(collider.matrix_basis)


def apply_for_bullet(collider: Object) -> None:
    """Give a collider a transform and mesh that Blender's rigid bodies take as they are.

    Bullet knows place and rotation of a child in its body, but no scale of the child, and applies
    the body's scale to its mesh.
    """
    in_body = Matrix(_in_body(collider).tolist())
    linear = in_body.to_3x3()
    rotation = in_body.to_quaternion().to_matrix()
    is_scaled = (
        max(abs(size - 1.0) for size in collider.parent.matrix_world.to_scale()) > PLACE_RTOL
    )
    off = max(abs((linear - rotation)[i][j]) for i in range(3) for j in range(3))
    if off <= PLACE_RTOL and not is_scaled:
        return
    if collider.data.users > 1:
        collider.data = collider.data.copy()
    collider.data.transform(linear.to_4x4(), shape_keys=False)
    if linear.determinant() < 0.0:
        collider.data.flip_normals()
    collider.matrix_parent_inverse = Matrix()
    collider.matrix_basis = Matrix.Translation(in_body.translation)
    collider[COLLIDER] = {"kind": HULL, "size": [], "mass": collider[COLLIDER]["mass"]}


def remove_colliders(colliders: Sequence[Object]) -> None:
    """Remove colliders with their meshes, and their collection if nothing is left in it."""
    meshes = {obj.data for obj in colliders}
    collections = {collection for obj in colliders for collection in obj.users_collection}
    bpy.data.batch_remove(colliders)
    bpy.data.batch_remove([mesh for mesh in meshes if not mesh.users])
    for collection in collections:
        if collection.get(COLLECTION) and not collection.all_objects and not collection.children:
            bpy.data.collections.remove(collection)


def read_colliders(colliders: Iterable[Object], rotation: Array, unit: float) -> list[Shape]:
    """Return colliders as shapes in the frame of their body, in m; `rotation` is that of the
    frame. Primitives that a map skews become the nearest ones.
    """
    shapes = []
    for collider in colliders:
        stored = collider[COLLIDER]
        matrix = unit * stretch_of(collider.parent, rotation) @ _in_body(collider)[:3]
        to_frame = matrix[:, :3]
        place = matrix[:, 3]
        kind = str(stored["kind"])
        size = np.array(stored["size"])
        mass = float(stored["mass"])
        if kind == HULL:
            surface = mesh_surface(collider.data, edges=False).transform(to_frame, place)
            shapes.append(Shape(kind, surface=surface, mass=mass))
            continue
        # A mirrored primitive equals itself turned by the opposite of the mirroring matrix.
        rotation_or_mirror = polar_rotation(to_frame[None])[0][0]
        pose = Pose(place, rotation_or_mirror * np.sign(np.linalg.det(rotation_or_mirror)))
        scale = np.linalg.norm(to_frame, axis=0) / unit
        if len(size) < 3:  # the radius of a ball, or the radius across and the length along z
            scale = np.array([(scale[0] * scale[1]) ** 0.5, scale[2]])[: len(size)]
        scale = np.where(np.abs(scale - 1.0) < 1e-6, 1.0, scale)  # rounding is no scale
        shapes.append(Shape(kind, tuple((size * scale).tolist()), pose, mass=mass))
    return shapes


def _draw_primitive(mesh: Mesh, shape: Shape, unit: float) -> None:
    """Make the faces of a primitive about the origin, in Blender's units."""
    made = bmesh.new()
    size = [length / unit for length in shape.size]
    if shape.kind == "box":
        bmesh.ops.create_cube(made, size=1.0, matrix=Matrix.Diagonal((*size, 1.0)))
    elif shape.kind == CYLINDER:
        radius, depth = size
        bmesh.ops.create_cone(
            made, cap_ends=True, segments=SEGMENTS, radius1=radius, radius2=radius, depth=depth
        )
    else:
        scale = Matrix.Diagonal((*(size if shape.kind == "ellipsoid" else 3 * size[:1]), 1.0))
        bmesh.ops.create_uvsphere(
            made, u_segments=SEGMENTS, v_segments=RINGS, radius=1.0, matrix=scale
        )
    # The halves of a capsule's ball move apart by the length of its cylinder.
    for vertex in made.verts if shape.kind == "capsule" else ():
        vertex.co.z += copysign(size[1] / 2.0, vertex.co.z)
    made.to_mesh(mesh)
    made.free()
