# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of Wavefront .obj files: each ``o`` begins a mesh; groups, lines, normals and textures are not read.

An ``o`` with vertices and no faces is a mesh without faces. So is a file.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..streams.decimals import parse_decimals
from ..streams.file_mesh import FileMesh, name_of_file, without_repeats
from ..streams.misread import map_file
from .obj_text import Lines, blocks, check_obj_text

_COMMENT = re.compile(rb"#[^\n]*")
_OBJECT = re.compile(rb"^[ \t\v]*o[ \t\v]+(\S[^\n]*?)\s*$", re.MULTILINE)


def read_obj_meshes(path: Path) -> list[FileMesh]:
    """Return the meshes, in the file's own axes. Raises FileError and OSError."""
    return _split(*read_obj_faces(path))


def read_obj_faces(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], list]:
    """Return (n, 3) points, (k,) corners and (m,) sides of faces; of objects the first face, first vertex and name."""
    data = map_file(path) if path.stat().st_size else b""
    check_obj_text(data)
    points, corners, sides = [np.zeros((0, 3))], [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    starts, counts, faces = [(0, 0, name_of_file(path))], np.zeros(3, np.int64), 0
    for _, text in blocks(data):
        lines = Lines(_COMMENT.sub(b"", text) if b"#" in text else text, counts)
        points.append(_read_points(lines))
        index, lengths, places = _read_faces(lines)
        corners.append(index)
        sides.append(lengths)
        if b"o" in text:
            for name in _OBJECT.finditer(lines.text):
                before = int(np.searchsorted(places, name.start()))
                vertices = int(lines.before[0, np.searchsorted(lines.starts, name.start(), "right") - 1])
                starts.append((faces + before, vertices, name[1].decode("utf-8", "replace")))
        counts, faces = lines.after, faces + len(lengths)
    return np.concatenate(points), np.concatenate(corners), np.concatenate(sides), starts


def _read_points(lines: Lines) -> NDArray[np.float64]:
    """Return the (n, 3) vertices of a block."""
    is_vertex = lines.kinds[0]
    values, at, _ = parse_decimals(lines.keep(is_vertex))
    line = np.searchsorted(lines.starts, at, "right")
    first = np.flatnonzero(np.diff(line, prepend=-1))
    return values[first[:, None] + np.arange(3)]


def _read_faces(lines: Lines) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.intp]]:
    """Return the (k,) vertices of the faces of a block, the (m,) counts of their corners, and their lines' offsets."""
    is_face = lines.has_kind("f")
    at, role, value = lines.indices(is_face)
    at, value = at[role == 0], value[role == 0]
    line = np.searchsorted(lines.starts, at, "right") - 1
    is_backward = lines.letters[at] == ord("-")
    index = np.where(is_backward, lines.before[0, line] - value, value - 1)
    first = np.flatnonzero(np.diff(line, prepend=-1))
    return index, np.diff(first, append=len(index)), lines.starts[line[first]]


def _split(points: NDArray, corners: NDArray, sides: NDArray, starts: list[tuple[int, int, str]]) -> list[FileMesh]:
    """Return a mesh of each object. starts: the first face and the first vertex of each object, and its name."""
    ends = np.append(0, np.cumsum(sides))
    meshes = []
    for i, (end, last, _) in enumerate([*starts[1:], (len(sides), len(points), "")]):
        begin, first, name = starts[i]
        if begin == end and (first == last or i == 0 < len(starts) - 1):  # What follows may use the first vertices.
            continue
        own = corners[ends[begin] : ends[end]]
        own_points = points
        if end - begin < len(sides):
            used, own = np.unique(own, return_inverse=True)
            own_points = points[used]
        meshes.append(FileMesh(name, own_points, *without_repeats(own, sides[begin:end])))
    return meshes
