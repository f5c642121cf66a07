# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of robots as triangles: .stl, .obj, .glb and .dae, without Blender, which has no reader of the last."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...cad.obj import read_obj_faces
from ...mesh.surface import Surface
from ...numerics.rotations import rotation_matrix
from ...scans.findings import FILE_TYPE
from ...streams.findings import FILE_TOO_LARGE, FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...streams.stl import StlFile
from ...verdict.finding import FileError, finding, system_reason
from ..findings import MESH_UNREADABLE
from ..write.gltf import BINARY, JSON, chunks
from .dae import read_dae
from .triangles import Arrays, Gathered, fan

MAX_MESH = 1 << 30  # bytes
MAX_TRIANGLES = 50_000_000
_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_DAMAGE = (
    *(ValueError, IndexError, KeyError, TypeError, OverflowError, RecursionError, struct.error),
    AttributeError,  # JSON with a text or a number in the place of an object.
)


def read_mesh(path: Path) -> tuple[Surface, NDArray[np.float64] | None]:
    """Return a file's surface in its own coordinates and unit (meters for .dae), and the rotation to z up.

    The rotation is None if the file names no other axis. FileError, with the file's name, if it cannot be read.
    """
    try:
        return _read_mesh(path)
    except FileError as error:
        cause = error.finding
    except OSError as error:
        cause = finding(FILE_UNREADABLE, error=system_reason(error))
    except _DAMAGE as error:
        cause = finding(FILE_UNREADABLE, error=type(error).__name__)
    raise FileError(MESH_UNREADABLE, name=path.name, cause=cause.as_record())


def _read_mesh(path: Path) -> tuple[Surface, NDArray[np.float64] | None]:
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(READERS))
    if path.stat().st_size > MAX_MESH:
        raise FileError(FILE_TOO_LARGE, limit=MAX_MESH, content="bytes")
    points, triangles, *upright = reader(path)
    if not len(triangles):
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")
    if len(triangles) > MAX_TRIANGLES:
        raise FileError(FILE_TOO_LARGE, limit=MAX_TRIANGLES, content="faces")
    if triangles.min() < 0 or triangles.max() >= len(points) or not np.isfinite(points).all():
        raise ValueError("corners")
    return Surface.from_triangles(points, triangles), upright[0] if upright else None


def read_stl(path: Path) -> Arrays:
    """Return points and triangles of binary or text STL, with equal corners as one point."""
    mesh = StlFile(path).mesh()
    return mesh.points.astype(np.float64), mesh.corners.reshape(-1, 3)


def read_obj(path: Path) -> Arrays:
    """Return points and triangles of all objects of an OBJ; larger faces are cut into fans."""
    points, corners, sides, _ = read_obj_faces(path)
    return points, fan(sides, corners)


def read_glb(path: Path) -> Arrays:
    """Return points and triangles of a binary glTF, placed by its scene, with y up as other robot readers keep it."""
    data = path.read_bytes()
    parts = dict(chunks(data)) if data[:4] == b"glTF" else {}
    document, binary = json.loads(parts.get(JSON, b"")), parts.get(BINARY, b"")
    scene = document["scenes"][document.get("scene", 0)]
    gathered = Gathered()
    waiting = [(index, np.eye(4)) for index in scene.get("nodes", [])]
    visited = 0
    while waiting:
        index, above = waiting.pop()
        visited += 1
        if visited > len(document["nodes"]):  # nodes are a tree
            raise ValueError("nodes")
        node = document["nodes"][index]
        matrix = above @ _node_matrix(node)
        waiting += [(child, matrix) for child in node.get("children", [])]
        for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            if primitive.get("mode", 4) != 4:
                continue
            corners = _accessor(document, binary, primitive["attributes"]["POSITION"]).astype(np.float64)
            order = np.arange(len(corners))
            if "indices" in primitive:
                order = _accessor(document, binary, primitive["indices"]).ravel().astype(np.int64)
            gathered.add(corners, order[: len(order) // 3 * 3].reshape(-1, 3), matrix)
    return gathered.arrays()


def _node_matrix(node: dict) -> NDArray[np.float64]:
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    if "rotation" in node:
        x, y, z, w = node["rotation"]
        matrix[:3, :3] = rotation_matrix([w, x, y, z])
    matrix[:3, :3] = matrix[:3, :3] * np.array(node.get("scale", (1.0, 1.0, 1.0)), np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _accessor(document: dict, binary: bytes, index: int) -> NDArray:
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    if document["buffers"][view.get("buffer", 0)].get("uri") or "sparse" in accessor:
        raise ValueError("buffers")
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    item = np.dtype((_COMPONENTS[accessor["componentType"]], (width,)))
    stride = view.get("byteStride", item.itemsize)
    offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    count = accessor["count"]
    if count < 0 or stride < item.itemsize or offset + stride * (count - 1) + item.itemsize > len(binary):
        raise ValueError("accessor")
    rows = np.ndarray(
        (count, width), _COMPONENTS[accessor["componentType"]], binary, offset, (stride, item.base.itemsize)
    )
    return rows.copy()


READERS: dict[str, Callable[[Path], tuple]] = {".stl": read_stl, ".obj": read_obj, ".glb": read_glb, ".dae": read_dae}
