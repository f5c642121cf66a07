# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of COLLADA, which a third of published robots use and Blender 5 no longer reads.

It reads geometries of triangles, polylists and polygons, placed by the scene's nodes, in meters. Most readers of robots
(RViz, MoveIt, hpp-fcl) ignore which axis the file says is up; some obey. So the file's own axes are kept, and the
rotation that it asks for is returned beside them.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...verdict.number_text import parse_number, parse_numbers, parse_whole, parse_wholes
from ..stated import rotation_about
from .triangles import Arrays, Gathered, fan
from .xml import MAX_DEPTH, Node, parse

TURNS = {
    "Y_UP": np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]]),
    "X_UP": np.array([[0, -1.0, 0], [0, 0, -1.0], [1.0, 0, 0]]),
}


def read_dae(path: Path) -> tuple[*Arrays, NDArray[np.float64] | None]:
    """Return points (meters, the file's axes), triangles, and the rotation to z up, None if z is up."""
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
    """Yield the geometries of the scene and their (4, 4) matrices; without a scene, all geometries of the file."""
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


def _matrix(node: Node) -> NDArray[np.float64]:
    matrix = np.eye(4)
    for child in node.children:
        if child.tag not in ("matrix", "translate", "rotate", "scale"):
            continue
        values, step = np.array(parse_numbers(child.text)), np.eye(4)
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


def _positions(vertices: Node, by_id: dict[str, Node]) -> NDArray[np.float64]:
    source = vertices
    for element in vertices.all("input"):
        if element.get("semantic") == "POSITION":
            source = by_id[element.get("source").removeprefix("#")]
    array, accessor = source.find("float_array"), source.find("technique_common", "accessor")
    stride = parse_whole(accessor.get("stride", "3")) if accessor else 3
    values = np.array(parse_numbers(array.text if array else ""))
    return values[: len(values) // stride * stride].reshape(-1, stride)[:, :3]
