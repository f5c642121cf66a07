# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of links: binary STL, which all readers accept, or OBJ if MuJoCo would refuse the size as
STL.
"""

import re
from collections.abc import Iterable
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np

from ...files.whole_file import whole_file
from ...mesh import Surface, keep_used
from ..model import Robot
from .text import unique_names

MESH_FOLDER = "meshes"
_MARKER = b"Body Moments".ljust(80, b"\0")  # The header of our files, which may be overwritten.
_OBJ_MARKER = b"# Body Moments\n".rjust(80, b"#")  # It has the length of the other.
MOST_TRIANGLES = 200_000  # MuJoCo refuses larger STL files.
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_NOT_IN_FILES = re.compile(r"[^\w.-]", re.ASCII)


def to_stl(surface: Surface) -> bytes:
    """Return a surface in m as binary STL with zero normals, so that readers compute them from the
    corners.
    """
    triangles = surface.all_triangles()[0]
    rows = np.zeros(len(triangles), TRIANGLE)
    rows["corners"] = surface.points[triangles]
    return _MARKER + np.uint32(len(rows)).astype("<u4").tobytes() + rows.tobytes()


def to_obj(surface: Surface) -> bytes:
    """Return a surface in m as OBJ, with nine digits, which float32 needs."""
    points, triangles = keep_used(surface.points, surface.all_triangles()[0])
    stream = BytesIO(_OBJ_MARKER)
    stream.seek(0, 2)
    np.savetxt(stream, points, "v %.9g %.9g %.9g")
    np.savetxt(stream, triangles + 1, "f %d %d %d")
    return stream.getvalue()


def write_meshes(
    robot: Robot,
    output: Path,
    read: Path | None = None,
    force: bool = False,
    mesh_format: str = "stl",
) -> Robot:
    """Write the surfaces of a robot's meshes to files, and return the robot with the names of these
    files.

    output: the robot's own file; the meshes go to the folder `meshes` beside it. read: a file that
    is never replaced. OSError if a file cannot be written, or exists, is no mesh of ours, and
    `force` is False; then none is written. mesh_format: "stl", of small meshes, or "obj".
    """
    shapes = {
        (link.name, index): shape for link in robot.links for index, shape in enumerate(link.shapes)
    }
    files = mesh_files(shapes, output.stem)
    for key, shape in shapes.items():
        if shape.surface is not None and (
            mesh_format == "obj" or len(shape.surface.all_triangles()[0]) > MOST_TRIANGLES
        ):
            files[key] = files[key].removesuffix("stl") + "obj"
    surfaces = {
        files[key]: shape.surface for key, shape in shapes.items() if shape.surface is not None
    }
    for file in surfaces:
        _check_replaceable(output.parent / file, read, force)
    for file, surface in surfaces.items():
        path = output.parent / file
        for folder in (path.parent.parent, path.parent):
            folder.mkdir(exist_ok=True)
        with whole_file(path) as stream:
            stream.write((to_obj if path.suffix == ".obj" else to_stl)(surface))
    links = []
    for link in robot.links:
        named = [
            shape if shape.surface is None else replace(shape, file=files[link.name, index])
            for index, shape in enumerate(link.shapes)
        ]
        links.append(replace(link, shapes=tuple(named)))
    return replace(robot, links=tuple(links))


def mesh_files(shapes: Iterable[tuple[str, int]], stem: str) -> dict[tuple[str, int], str]:
    """Return the mesh file of each link's name and shape's index, relative to the robot's; unique
    even without case.
    """
    files = unique_names(
        shapes, lambda key: _file_name("{}_collider_{}".format(*key) if key[1] else key[0])
    )
    return {
        key: "{}/{}/{}.stl".format(MESH_FOLDER, _file_name(stem), file)
        for key, file in files.items()
    }


def _file_name(name: str) -> str:
    return _NOT_IN_FILES.sub("_", name).lower() or "_"


def _check_replaceable(path: Path, read: Path | None, force: bool) -> None:
    """Raise FileExistsError if a mesh must not replace the file `path`."""
    if not path.is_file():
        return
    if read is not None and read.exists() and path.samefile(read):
        raise FileExistsError("{} is a file that is read. Use another name".format(path))
    with open(path, "rb") as file:
        head = file.read(len(_MARKER))
    if head and head not in (_MARKER, _OBJ_MARKER) and not force:
        raise FileExistsError("{} is not a result of body_moments and would be lost".format(path))
