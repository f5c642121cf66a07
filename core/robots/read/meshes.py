# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of robots as triangles: .stl, .obj, .msh, .glb and .dae, without Blender, which no
longer reads the last.

COLLADA, which a third of published robots use: geometries of triangles, polylists and polygons,
placed by the scene's nodes, in meters. Most readers of robots (RViz, MoveIt, hpp-fcl) ignore which
axis the file says is up; some obey. So the file's own axes are kept, and the rotation that it asks
for is returned beside them.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from ...cad import read_obj_faces
from ...files import (
    FILE_TOO_LARGE,
    FILE_TYPE,
    FILE_UNREADABLE,
    FILE_WITHOUT_OBJECTS,
    MALFORMED,
    GltfFile,
    map_file,
    node_matrix,
    parse_number,
    parse_numbers,
    parse_whole,
    parse_wholes,
)
from ...mesh import Surface, join_surfaces
from ...numerics import Array, Int64, NDArray, rotation_about, segment_ranges, segment_starts
from ...streams import StlFile
from ...verdict import FileError, finding, system_reason
from ..findings import MESH_UNREADABLE
from ..stated import MOST
from .xml import MAX_DEPTH, Node, parse

MAX_MESH = 1 << 30  # bytes
MAX_TRIANGLES = 50_000_000
TURNS = {
    "Y_UP": np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]),
    "X_UP": np.array([[0, -1.0, 0], [0, 0, -1.0], [1.0, 0, 0]]),
}


def read_mesh(path: Path) -> tuple[Surface, Array | None]:
    """Return a file's surface in its own coordinates and unit (meters for .dae), and the rotation
    to z up.

    The rotation is None if the file names no other axis. FileError, with the file's name, if it
    cannot be read.
    """
    try:
        return _read_mesh(path)
    except FileError as error:
        cause = error.finding
    except OSError as error:
        cause = finding(FILE_UNREADABLE, error=system_reason(error))
    except MALFORMED as error:
        cause = finding(FILE_UNREADABLE, error=type(error).__name__)
    raise FileError(MESH_UNREADABLE, name=path.name, cause=cause.as_record())


def _read_mesh(path: Path) -> tuple[Surface, Array | None]:
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(READERS))
    if path.stat().st_size > MAX_MESH:
        raise FileError(FILE_TOO_LARGE, limit=MAX_MESH, content="bytes")
    surface, upright = reader(path)
    count = len(surface.triangles)
    if not count:
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")
    if count > MAX_TRIANGLES:
        raise FileError(FILE_TOO_LARGE, limit=MAX_TRIANGLES, content="faces")
    if not np.isfinite(surface.points).all():
        raise ValueError("points")
    return surface, upright


def read_stl(path: Path) -> tuple[Surface, None]:
    """Return the surface of binary or text STL, with equal corners as one point."""
    mesh = StlFile(path).mesh()
    points = mesh.points.astype(np.float64)
    return Surface.from_triangles(points, mesh.corners.reshape(-1, 3)), None


def read_obj(path: Path) -> tuple[Surface, None]:
    """Return the surface of all objects of an OBJ; larger faces are cut into fans."""
    points, corners, sizes, _ = read_obj_faces(path)
    return Surface.from_triangles(points, fan(sizes, corners)), None


def read_msh(path: Path) -> tuple[Surface, None]:
    """Return the surface in MuJoCo's own binary format; its normals and texture coordinates are
    skipped.
    """
    data = path.read_bytes()
    counts = np.frombuffer(data, "<i4", 4)
    points, normals, coordinates, faces = counts.tolist()
    start = 16 + 4 * (3 * points + 3 * normals + 2 * coordinates)
    if counts.min() < 0 or len(data) != start + 12 * faces:
        raise ValueError("counts")
    vertices = np.frombuffer(data, "<f4", 3 * points, 16).reshape(-1, 3)
    triangles = np.frombuffer(data, "<i4", 3 * faces, start).reshape(-1, 3)
    surface = Surface.from_triangles(vertices.astype(np.float64), triangles.astype(np.int64))
    return surface, None


def read_glb(path: Path) -> tuple[Surface, None]:
    """Return the surface of a binary glTF, placed by its scene, with y up as other robot readers
    keep it.
    """
    file = GltfFile(map_file(path), str(path))
    document = file.document
    if any("compression" in name for name in document.get("extensionsRequired", ())):
        error = "it is compressed. Export it without Draco or meshopt compression"
        raise FileError(FILE_UNREADABLE, error=error)
    scene = document["scenes"][document.get("scene", 0)]
    parts = []
    waiting = [(index, np.eye(4)) for index in scene.get("nodes", [])]
    visited = 0
    while waiting:
        index, above = waiting.pop()
        visited += 1
        if visited > len(document["nodes"]):  # nodes are a tree
            raise ValueError("nodes")
        node = document["nodes"][index]
        matrix = above @ node_matrix(node)
        waiting += [(child, matrix) for child in node.get("children", [])]
        for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            if primitive.get("mode", 4) != 4:  # no triangles
                continue
            points = file.numbers(primitive["attributes"]["POSITION"])
            corners = np.arange(len(points))
            if "indices" in primitive:
                corners = file.numbers(primitive["indices"]).ravel().astype(np.int64)
            triangles = corners[: len(corners) // 3 * 3].reshape(-1, 3)
            parts.append(_placed(points, triangles, matrix))
    return _join(parts), None


def read_dae(path: Path) -> tuple[Surface, Array | None]:
    """Return a surface (meters, the file's axes), and the rotation to z up, None if z is up."""
    root = parse(path.read_bytes())
    for node in root.walk():
        node.tag = node.tag.rpartition("}")[2]  # without the namespace
    by_id = {node.get("id"): node for node in root.walk() if node.get("id")}
    unit = root.find("asset", "unit")
    scale = parse_number(unit.get("meter", "1")) if unit else 1.0
    up = root.find("asset", "up_axis")
    to_meters = np.diag([scale, scale, scale, 1.0])
    parts = [
        _placed(points, triangles, to_meters @ matrix)
        for geometry, matrix in _instances(root, by_id)
        for points, triangles in _geometry(geometry, by_id)
    ]
    return _join(parts), TURNS.get(up.text.strip() if up else "Y_UP")


def _placed(points: NDArray, triangles: NDArray, matrix: NDArray) -> Surface:
    """Return the surface of (n, 3) points and (m, 3) triangles, placed by a (4, 4) matrix."""
    return Surface.from_triangles(points, triangles).transform(matrix[:3, :3], matrix[:3, 3])


def _join(parts: Sequence[Surface]) -> Surface:
    if not parts:
        raise FileError(FILE_WITHOUT_OBJECTS, content="faces")
    return join_surfaces(parts)


def _instances(root: Node, by_id: dict[str, Node]) -> Iterator[tuple[Node, NDArray]]:
    """Yield the geometries of the scene and their (4, 4) matrices; without a scene, all geometries
    of the file.
    """
    scene = root.find("scene", "instance_visual_scene")
    visual = by_id.get(scene.get("url").removeprefix("#")) if scene else None
    if visual is None:
        for library in root.all("library_geometries"):
            yield from ((geometry, np.eye(4)) for geometry in library.all("geometry"))
        return
    waiting = [(node, np.eye(4), 0) for node in visual.all("node")]
    while waiting:
        node, above, depth = waiting.pop()
        if depth > MAX_DEPTH:
            raise ValueError("nodes")
        matrix = above @ _matrix(node)
        waiting += [(child, matrix, depth + 1) for child in node.all("node")]
        for instance in node.all("instance_node"):
            waiting.append((by_id[instance.get("url").removeprefix("#")], matrix, depth + 1))
        for instance in node.all("instance_geometry"):
            yield by_id[instance.get("url").removeprefix("#")], matrix


def _matrix(node: Node) -> Array:
    """Return the (4, 4) matrix of a node of COLLADA, from its coordinates to its parent's."""
    matrix = np.eye(4)
    for child in node.children:
        if child.tag not in ("matrix", "translate", "rotate", "scale"):
            continue
        values = np.array(parse_numbers(child.text))
        step = np.eye(4)
        if child.tag == "matrix":
            step = values.reshape(4, 4)
        elif child.tag == "translate":
            step[:3, 3] = values
        elif child.tag == "scale":
            step[:3, :3] = np.diag(values)
        else:
            step[:3, :3] = rotation_about(values[:3], np.radians(values[3]))
        matrix = matrix @ step
    return matrix


def _geometry(geometry: Node, by_id: dict[str, Node]) -> Iterator[tuple[Array, Int64]]:
    """Yield the (n, 3) points and (m, 3) triangles of each group of faces."""
    mesh = geometry.find("mesh")
    for primitives in mesh.children if mesh else ():
        if primitives.tag not in ("triangles", "polylist", "polygons"):
            continue
        inputs = primitives.all("input")
        stride = max(parse_whole(element.get("offset", "0")) for element in inputs) + 1
        vertex = next(element for element in inputs if element.get("semantic") == "VERTEX")
        points = _positions(by_id[vertex.get("source").removeprefix("#")], by_id)
        offset = parse_whole(vertex.get("offset", "0"))
        lists = [np.array(parse_wholes(element.text), np.int64) for element in primitives.all("p")]
        if not lists:
            continue
        # Each corner has one index for each input: `stride` of them.
        corners = np.concatenate(lists).reshape(-1, stride)[:, offset]
        if primitives.tag == "triangles":
            yield points, corners.reshape(-1, 3)
        elif primitives.tag == "polylist":
            counts = primitives.find("vcount")
            sizes = np.array(parse_wholes(counts.text if counts else ""), np.int64)
            if sizes.sum() != len(corners):
                raise ValueError("vcount")
            yield points, fan(sizes, corners)
        else:
            yield points, fan(np.array([len(indices) // stride for indices in lists]), corners)


def _positions(vertices: Node, by_id: dict[str, Node]) -> Array:
    """Return the (n, 3) points of an element `vertices`, or of the source itself."""
    source = vertices
    for element in vertices.all("input"):
        if element.get("semantic") == "POSITION":
            source = by_id[element.get("source").removeprefix("#")]
    array = source.find("float_array")
    accessor = source.find("technique_common", "accessor")
    stride = parse_whole(accessor.get("stride", "3")) if accessor else 3
    values = np.array(parse_numbers(array.text if array else ""))
    return values[: len(values) // stride * stride].reshape(-1, stride)[:, :3]


def fan(sizes: Int64, corners: Int64) -> Int64:
    """Return (m, 3) triangles: faces of given sizes, cut into fans about their first corners."""
    counts = np.maximum(sizes - 2, 0)
    first = np.repeat(segment_starts(sizes), counts)
    second = first + segment_ranges(counts) + 1
    return np.stack([corners[first], corners[second], corners[second + 1]], axis=1)


def checked_surface(
    texts: Sequence[str], points: NDArray, sizes: NDArray, corners: NDArray
) -> Surface:
    """Return faces of given sizes over points, three numbers each.

    ValueError, with its text, if an array is wrong.
    """
    are_points = len(points) % 3 == 0 and (np.abs(points) <= MOST).all()
    are_sizes = _are_whole(sizes) and sizes.sum() == len(corners)
    are_corners = len(corners) and _are_whole(corners) and corners.max() < len(points) // 3
    for text, is_right in zip(texts, (are_points, are_sizes, are_corners)):
        if not is_right:
            raise ValueError(text[:80])
    return Surface.from_triangles(
        points.reshape(-1, 3), fan(sizes.astype(np.int64), corners.astype(np.int64))
    )


def _are_whole(numbers: NDArray) -> bool:
    return bool(((numbers >= 0) & (numbers == np.rint(numbers))).all())


READERS: dict[str, Callable[[Path], tuple[Surface, Array | None]]] = {
    ".stl": read_stl,
    ".obj": read_obj,
    ".msh": read_msh,
    ".glb": read_glb,
    ".dae": read_dae,
}
