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
from ...mesh import Surface
from ...numerics import Array, Floats, Int64, Integers, NDArray, rotation_about
from ...streams import StlFile
from ...verdict import FileError, finding, system_reason
from ..findings import MESH_UNREADABLE
from ..stated import MOST
from .xml import MAX_DEPTH, Node, parse

Arrays = tuple[Floats, Integers]
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


def read_msh(path: Path) -> Arrays:
    """Return points and triangles of MuJoCo's own binary format; its normals and texture
    coordinates are skipped.
    """
    data = path.read_bytes()
    counts = np.frombuffer(data, "<i4", 4)
    points, normals, coordinates, faces = counts.tolist()
    start = 16 + 4 * (3 * points + 3 * normals + 2 * coordinates)
    if counts.min() < 0 or len(data) != start + 12 * faces:
        raise ValueError("counts")
    vertices = np.frombuffer(data, "<f4", 3 * points, 16).reshape(-1, 3)
    triangles = np.frombuffer(data, "<i4", 3 * faces, start).reshape(-1, 3)
    return vertices.astype(np.float64), triangles.astype(np.int64)


def read_glb(path: Path) -> Arrays:
    """Return points and triangles of a binary glTF, placed by its scene, with y up as other robot
    readers keep it.
    """
    file = GltfFile(map_file(path), str(path))
    document = file.document
    if any("compression" in name for name in document.get("extensionsRequired", ())):
        error = "it is compressed. Export it without Draco or meshopt compression"
        raise FileError(FILE_UNREADABLE, error=error)
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
        matrix = above @ node_matrix(node)
        waiting += [(child, matrix) for child in node.get("children", [])]
        for primitive in document["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ():
            if primitive.get("mode", 4) != 4:
                continue
            corners = file.numbers(primitive["attributes"]["POSITION"])
            order = np.arange(len(corners))
            if "indices" in primitive:
                order = file.numbers(primitive["indices"]).ravel().astype(np.int64)
            gathered.add(corners, order[: len(order) // 3 * 3].reshape(-1, 3), matrix)
    return gathered.arrays()


def read_dae(path: Path) -> tuple[*Arrays, Array | None]:
    """Return points (meters, the file's axes), triangles, and the rotation to z up, None if z is
    up.
    """
    root = parse(path.read_bytes())
    for node in root.walk():
        node.tag = node.tag.rpartition("}")[2]
    by_id = {node.get("id"): node for node in root.walk() if node.get("id")}
    asset = root.find("asset")
    unit = asset.find("unit") if asset else None
    scale = parse_number(unit.get("meter", "1")) if unit else 1.0
    up = asset.find("up_axis") if asset else None
    matrix = np.diag([scale, scale, scale, 1.0])
    gathered = Gathered()
    for geometry, place in _instances(root, by_id):
        for points, triangles in _geometry(geometry, by_id):
            gathered.add(points, triangles, matrix @ place)
    return *gathered.arrays(), TURNS.get(up.text.strip() if up else "Y_UP")


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


def _geometry(geometry: Node, by_id: dict[str, Node]) -> Iterator[Arrays]:
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
    source = vertices
    for element in vertices.all("input"):
        if element.get("semantic") == "POSITION":
            source = by_id[element.get("source").removeprefix("#")]
    array = source.find("float_array")
    accessor = source.find("technique_common", "accessor")
    stride = parse_whole(accessor.get("stride", "3")) if accessor else 3
    values = np.array(parse_numbers(array.text if array else ""))
    return values[: len(values) // stride * stride].reshape(-1, stride)[:, :3]


class Gathered:
    """Points and triangles of parts, each placed by a (4, 4) matrix."""

    def __init__(self) -> None:
        self._points: list[NDArray] = []
        self._triangles: list[NDArray] = []

    def add(self, points: NDArray, triangles: NDArray, matrix: NDArray) -> None:
        """Add (n, 3) points and (m, 3) triangles, whose order is reversed if the matrix mirrors."""
        turned = triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0.0 else triangles
        self._triangles.append(turned + sum(map(len, self._points)))
        self._points.append(points @ matrix[:3, :3].T + matrix[:3, 3])

    def arrays(self) -> Arrays:
        """Return all points and triangles."""
        none = np.zeros((0, 3))
        return np.concatenate([none, *self._points]), np.concatenate(
            [none.astype(np.int64), *self._triangles]
        )


def fan(sizes: Int64, corners: Int64) -> Int64:
    """Return (m, 3) triangles: faces of given sizes, cut into fans about their first corners."""
    starts = np.cumsum(sizes) - sizes
    cut = np.maximum(sizes - 2, 0)
    face = np.repeat(np.arange(len(sizes)), cut)
    step = np.arange(cut.sum()) - np.repeat(np.cumsum(cut) - cut, cut)
    first = starts[face]
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1)


def checked_surface(
    texts: Sequence[str], points: NDArray, sizes: NDArray, corners: NDArray
) -> Surface:
    """Return faces of given sizes over points, three numbers each.

    ValueError, with its text, if an array is wrong.
    """
    is_right = (
        len(points) % 3 == 0 and (np.abs(points) <= MOST).all(),
        (sizes >= 0).all() and (sizes == np.rint(sizes)).all() and sizes.sum() == len(corners),
        len(corners)
        and (corners == np.rint(corners)).all()
        and 0 <= corners.min() <= corners.max() < len(points) // 3,
    )
    for text, is_fine in zip(texts, is_right):
        if not is_fine:
            raise ValueError(text[:80])
    return Surface.from_triangles(
        points.reshape(-1, 3), fan(sizes.astype(np.int64), corners.astype(np.int64))
    )


READERS: dict[str, Callable[[Path], tuple]] = {
    ".stl": read_stl,
    ".obj": read_obj,
    ".msh": read_msh,
    ".glb": read_glb,
    ".dae": read_dae,
}
