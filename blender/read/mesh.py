# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh and edit mesh to Surface, at the speed of copying arrays; digests, fast enough for every
evaluation.

`foreach_get` on an attribute is one memory copy if the buffer has the attribute's own type; the
same numbers through `vertex_values`, `loops` and `loop_triangles` cost 10 to 100 times as much. The
sizes of the faces follow from the attribute `loop_triangle_polygons`. Only n-gons need
`loop_triangles`; core/mesh/surface.py cuts quads as Blender does.
"""

from collections.abc import Callable
from itertools import chain
from typing import TypeVar

import bmesh
import bpy
import numpy as np
from bpy.types import Depsgraph, Object

from ...core.mesh import Surface
from ...core.numerics import Array, NDArray
from ...core.verdict import ReadError
from .findings import ATTRIBUTE_MISSING
from .visibility import evaluated_geometry

# One triangle read by its index costs as much as about five in a `foreach_get` of all of them.
SINGLE_ACCESS_COST = 5
FACE_CORNERS = np.arange(4)
Read = TypeVar("Read")
MAX_DIGESTED_FACES = 50_000  # faces: reading and digesting them takes 2 ms


def plain_mesh(obj, depsgraph):
    """Return the evaluated mesh of an object that only shows this mesh, or None if `read_object` is
    needed.
    """
    data, parent = obj.data, obj.parent
    if (
        obj.type != "MESH"
        or obj.mode == "SCULPT"
        or obj.instance_type != "NONE"
        or data.is_editmode
        or data.shape_keys is not None
        or len(obj.modifiers)
        or not obj.visible_get(view_layer=depsgraph.view_layer)
        or (parent is not None and parent.instance_type in {"VERTS", "FACES"})
    ):
        return None
    evaluated = obj.evaluated_get(depsgraph)
    return evaluated.data if evaluated.is_evaluated else None


def mesh_surface(mesh, *, edges: bool = True) -> Surface:
    """Return the surface of a `bpy.types.Mesh` as copied arrays, in its coordinates; edges take a
    fifth of the time.
    """
    points = vertex_points(mesh)
    corners = _attribute(mesh, ".corner_vert", "value", (len(mesh.loops),), np.int32)
    faces = _faces(mesh, corners)
    # The memory that sorting the faces took is free again: getting new memory costs more than
    # filling it.
    named = _attribute(mesh, ".corner_edge", "value", corners.shape, np.int32) if edges else None
    return Surface(points, corner_vertices=corners, corner_edges=named, **faces)


def mesh_points(mesh, corners: NDArray[np.integer]) -> NDArray[np.float32] | None:
    """Return (n, 3) points of a `bpy.types.Mesh`, or None if the vertices at its corners are not
    `corners`.
    """
    if len(mesh.loops) != len(corners) or not np.array_equal(
        _attribute(mesh, ".corner_vert", "value", corners.shape, np.int32), corners
    ):
        return None
    return vertex_points(mesh)


def vertex_points(mesh) -> NDArray[np.float32]:
    """Return the (n, 3) points of a `bpy.types.Mesh`."""
    return _attribute(mesh, "position", "vector", (len(mesh.vertices), 3), np.float32)


def _faces(mesh, corners: NDArray[np.int32]) -> dict[str, NDArray]:
    """Return the triangles and quads of a mesh, and the indices of their faces, as arguments of
    `Surface`.
    """
    faces = len(mesh.polygons)
    if not faces:
        return {}
    # No face has fewer than three corners, so three a face on average means three in each.
    if len(corners) == 3 * faces:
        return {"triangles": corners.reshape(-1, 3)}

    mesh.calc_loop_triangles()
    owners = read_array(mesh.loop_triangle_polygons, "value", (len(mesh.loop_triangles),), np.int32)
    # The owners are 0, 0, 1, 1, … if all faces are quads, and no triangle stands beside a pentagon.
    if len(corners) == 4 * faces and np.array_equal(
        owners, np.arange(2 * faces, dtype=np.int32) >> 1
    ):
        return {"quads": corners.reshape(-1, 4)}

    sizes = np.bincount(owners, minlength=faces) + 2  # corners: two more than triangles
    starts = sizes.cumsum() - sizes
    three = (sizes == 3).nonzero()[0]
    four = (sizes == 4).nonzero()[0]
    triangles = corners[starts[three][:, None] + FACE_CORNERS[:3]]
    triangle_faces = three
    if len(three) + len(four) < faces:
        ngon_triangles = (sizes.take(owners) > 4).nonzero()[0]
        triangles = np.concatenate([triangles, _loop_triangles(mesh, ngon_triangles)])
        triangle_faces = np.concatenate([three, owners[ngon_triangles]])
    return {
        "triangles": triangles,
        "triangle_faces": triangle_faces.astype(np.int32),
        "quads": corners[starts[four][:, None] + FACE_CORNERS],
        "quad_faces": four.astype(np.int32),
    }


def from_edit_mesh(mesh, read: Callable[[bpy.types.Mesh], Read]) -> Read:
    """Return the result of `read` for a mesh in Edit Mode, by a copy: a BMesh gives its elements
    one by one only.
    """
    copy = bpy.data.meshes.new("Body Moments Reading")
    try:
        bmesh.from_edit_mesh(mesh).to_mesh(copy)
        return read(copy)
    finally:
        bpy.data.meshes.remove(copy)


def face_slots(mesh) -> NDArray[np.int32]:
    """Return (f,) material indices of the faces, some of which may be beyond the last slot of the
    mesh.
    """
    if mesh.attributes.get("material_index") is None:  # then all faces have the first material
        return np.zeros(len(mesh.polygons), np.int32)
    return _attribute(mesh, "material_index", "value", (len(mesh.polygons),), np.int32)


def vertex_values(mesh, name: str) -> Array:
    """Return (n,) values of a float attribute on vertices, or raise ReadError if there is none."""
    attribute = mesh.attributes.get(name)
    if attribute is None or attribute.domain != "POINT" or attribute.data_type != "FLOAT":
        raise ReadError(ATTRIBUTE_MISSING, attribute=name)
    return _attribute(mesh, name, "value", (len(mesh.vertices),), np.float32).astype(np.float64)


def _attribute(mesh, name: str, member: str, shape: tuple[int, ...], dtype) -> NDArray:
    """Return the values of an attribute; without elements there may be no attribute either."""
    return (
        read_array(mesh.attributes[name].data, member, shape, dtype)
        if shape[0]
        else np.empty(shape, dtype)
    )


def read_array(data, member: str, shape: tuple[int, ...], dtype) -> NDArray:
    """Return a member of all elements of a collection as an array."""
    array = np.empty(shape, dtype)
    data.foreach_get(member, array.reshape(-1))
    return array


def _loop_triangles(mesh, indices: NDArray) -> NDArray[np.int32]:
    """Return the (k, 3) vertices of some loop triangles, read one by one if there are few."""
    triangles = mesh.loop_triangles
    if SINGLE_ACCESS_COST * len(indices) < len(triangles):
        vertices = chain.from_iterable(triangles[row].vertices for row in indices.tolist())
        return np.fromiter(vertices, np.int32, 3 * len(indices)).reshape(-1, 3)
    return read_array(triangles, "vertices", (len(triangles), 3), np.int32)[indices]


def shape_digest(obj: Object, depsgraph: Depsgraph) -> bytes | None:
    """Return a digest of a mesh object's faces; None for other types, modes, large meshes,
    instancers, node trees.
    """
    if not _shows_one_mesh(obj):
        return None
    try:
        geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    except ReadError:
        return None
    mesh = geometry.mesh
    if mesh is None or len(mesh.polygons) > MAX_DIGESTED_FACES:
        return None
    return mesh_surface(mesh, edges=False).digest


def read_digest(obj: Object, surface: Surface | None) -> bytes | None:
    """Return the `shape_digest` of an object whose only surface was just read."""
    if surface is None or not _shows_one_mesh(obj):
        return None
    is_large = len(surface.triangles) + len(surface.quads) > MAX_DIGESTED_FACES
    return None if is_large else surface.digest


def _shows_one_mesh(obj: Object) -> bool:
    """Return whether an object shows one mesh, without instances, outside of its edit modes."""
    return (
        obj.type == "MESH"
        and obj.mode == "OBJECT"
        and not obj.data.is_editmode
        and obj.instance_type == "NONE"
        and not len(obj.particle_systems)
        and "NODES" not in [modifier.type for modifier in obj.modifiers]
    )
