# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wavefront .obj files: free-form surfaces, ``surf`` of B-splines and Bézier patches, rational or
not; and faces.

Advanced Visualizer, Appendix B1, Object Files (.obj), version 3.0. Each ``o`` makes a body or
begins a mesh. As in Blender's importer, Y up becomes Z up. Lines, curves, groups, normals and
textures are not read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from ..files import (
    FILE_TOO_LARGE,
    FILE_UNREADABLE,
    map_file,
    parse_decimals,
    parse_number,
    parse_whole,
)
from ..numerics import Array, Index, Int64, NDArray
from ..nurbs import Face
from ..streams import FileMesh, name_of_file, without_repeats
from ..verdict import FileError
from .findings import SURFACE_BEYOND_LIMIT, SURFACE_TRIMMED, SURFACE_UNSUPPORTED
from .obj_text import Lines, blocks, check_obj_text
from .surfaces import (
    MAX_ORDER,
    MAX_SURFACES,
    Refusals,
    SurfaceBody,
    SurfaceFile,
    SurfaceRefusedError,
    bezier_surface,
    placed_surface,
)

KIND = "surf"
MAX_DEGREE = 100  # More would repeat the knots of a short file so often that they fill the memory.
TRIMS = {"trim", "hole"}
UPRIGHT = np.array(
    [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
_WORD = re.compile(rb"(?:^|[\r\n])[ \t]*surf[ \t\\]")
_WANTED = {
    "v",
    "cstype",
    "deg",
    "surf",
    "parm",
    "end",
    "o",
    "call",
    "curv",
    "curv2",
    "bmat",
    *TRIMS,
}
_COMMENT = re.compile(rb"#[^\n]*")
_OBJECT = re.compile(rb"^[ \t\v]*o[ \t\v]+(\S[^\n]*?)\s*$", re.MULTILINE)


def has_surfaces(path: str | Path) -> bool:
    """Return whether an .obj file has a ``surf``. OSError if it cannot be opened."""
    with open(path, "rb") as file:
        rest = b"\n"
        while block := file.read(1 << 20):
            if _WORD.search(rest + block):
                return True
            rest = block[-1024:]  # A line may begin in one block and end in the next.
    return False


@dataclass
class _Element:
    """A ``surf`` statement, with the settings that are in effect at its place in the file."""

    name: str
    type: str
    rational: bool
    degrees: list[str]
    words: list[str]
    vertices: int  # Count of vertices before it, from which negative indices count back.
    body: str
    knots: dict[str, list[str]] = field(default_factory=dict)
    trimmed: bool = False


class ObjReader:
    """A reader of the surfaces of a file, or of those that Blender can hold."""

    def __init__(self, path: Path, for_blender: bool) -> None:
        self._path = path
        self._for_blender = for_blender
        self._refusals = Refusals()
        self._vertices: list[list[str]] = []
        self._elements: list[_Element] = []

    def read(self) -> SurfaceFile:
        """Read the surfaces, without a unit. FileError if no surface can be kept."""
        self._parse()
        points, weights = self._points()
        bodies: dict[str, list[Face]] = {}
        for element in self._elements:
            make = partial(_faces, element, points, weights, self._for_blender)
            patches = self._refusals.keep(KIND, element.name, make)
            bodies.setdefault(element.body, []).extend(patches)
        return self._refusals.file(
            [SurfaceBody(name, tuple(patches)) for name, patches in bodies.items()]
        )

    def _parse(self) -> None:
        kind = ""
        rational = False
        degrees = []
        body = self._path.stem
        current: _Element | None = None
        for word, rest in self._statements():
            if word == "v":
                self._vertices.append(rest)
            elif word == "o":
                body = " ".join(rest) or body
            elif word == "cstype":
                *first, kind = rest or [""]
                rational = first == ["rat"]
            elif word == "deg":
                degrees = rest
            elif word == "surf":
                if len(self._elements) >= MAX_SURFACES:
                    raise FileError(FILE_TOO_LARGE, limit=MAX_SURFACES, content="surfaces")
                name = "{} {}".format(KIND, len(self._elements) + 1)
                current = _Element(name, kind, rational, degrees, rest, len(self._vertices), body)
                self._elements.append(current)
            elif word in ("end", "curv", "curv2"):
                current = None
            elif word == "call":
                raise FileError(
                    FILE_UNREADABLE,
                    error=(
                        "it runs another one by “call”, which is not followed. Insert "
                        "the other file"
                    ),
                )
            elif current is not None and word == "parm":
                current.knots.setdefault("".join(rest[:1]), []).extend(rest[1:])
            elif current is not None and word in TRIMS:
                current.trimmed = True

    def _statements(self) -> Iterator[tuple[str, list[str]]]:
        """Yield keyword and arguments of each statement about surfaces, continued lines joined."""
        with open(self._path, encoding="utf-8", errors="replace") as file:
            before: list[str] = []
            for line in file:
                line = line.rstrip("\r\n")
                if line.endswith("\\"):
                    before.append(line[:-1])
                    continue
                line = " ".join([*before, line])
                before = []
                word, *_ = line.split(None, 1) or [""]
                if word in _WANTED:
                    yield word, line.partition("#")[0].split()[1:]

    def _points(self) -> tuple[Array, Array]:
        """Return the (n, 3) vertices and their (n,) weights, NaN for a vertex with a word that is
        no number.
        """
        table = np.full((len(self._vertices), 4), 1.0)
        for row, words in zip(table, self._vertices):
            count = 4 if len(words) in (4, 5) else 3  # with six and more, colors follow
            try:
                row[:count] = [_number(word) for word in words[:count]]
            except ValueError:
                row[:] = np.nan
        return table[:, :3], table[:, 3]


def _number(word: str) -> float:
    value = parse_number(word)
    if not math.isfinite(value):
        raise ValueError("not finite")
    return value


def _faces(element: _Element, points: NDArray, weights: NDArray, for_blender: bool) -> list[Face]:
    """Return the patches of one surface.

    ValueError, IndexError or SurfaceRefusedError if it cannot be kept.
    """
    if element.trimmed:
        raise SurfaceRefusedError(SURFACE_TRIMMED)
    if element.type not in ("bspline", "bezier"):
        raise SurfaceRefusedError(SURFACE_UNSUPPORTED, base=element.type or "cstype")
    degrees = [parse_whole(word) for word in element.degrees]
    if len(degrees) != 2 or min(degrees) < 1:
        raise ValueError("degrees")
    limit = MAX_ORDER if for_blender else MAX_DEGREE + 1
    if max(degrees) >= limit:  # before knots are repeated so often
        raise SurfaceRefusedError(
            SURFACE_BEYOND_LIMIT, quantity="order", value=max(degrees) + 1, limit=limit
        )
    part = [_number(word) for word in element.words[:4]]
    used = _indices(element.words[4:], element.vertices)
    knots = [[_number(word) for word in element.knots.get(name, [])] for name in "uv"]
    if element.type == "bezier":
        knots = [
            [row[0]] + [knot for knot in row for _ in range(degree)] + [row[-1]]
            for row, degree in zip(knots, degrees)
        ]
    orders = (degrees[0] + 1, degrees[1] + 1)
    counts = [len(row) - order for row, order in zip(knots, orders)]
    shape = counts[1], counts[0]  # the first direction runs fastest
    surface = placed_surface(
        (knots[0], knots[1]),
        orders,
        points[used].reshape(*shape, 3).swapaxes(0, 1),
        weights[used].reshape(shape).T if element.rational else None,
        UPRIGHT,
    )
    return [*bezier_surface(surface, ((part[0], part[1]), (part[2], part[3])), for_blender)]


def _indices(words: list[str], count: int) -> Int64:
    """Convert vertex references to indices from 0, or raise ValueError. count: vertices so far, for
    negative ones.
    """
    numbers = np.array([parse_whole(word.partition("/")[0]) for word in words], np.int64)
    numbers = np.where(numbers > 0, numbers - 1, numbers + count)
    if (numbers < 0).any() or (numbers >= count).any():
        raise ValueError("no such vertex")
    return numbers


def read_obj_faces(
    path: Path,
) -> tuple[Array, Int64, Int64, list]:
    """Return (n, 3) points, (k,) corners and (m,) sides of faces; of objects the first face, first
    vertex and name.
    """
    data = map_file(path) if path.stat().st_size else b""
    check_obj_text(data)
    points = [np.zeros((0, 3))]
    corners = [np.zeros(0, np.int64)]
    sides = [np.zeros(0, np.int64)]
    starts = [(0, 0, name_of_file(path))]
    counts = np.zeros(3, np.int64)
    faces = 0
    for _, text in blocks(data):
        lines = Lines(_COMMENT.sub(b"", text) if b"#" in text else text, counts)
        points.append(_read_points(lines))
        index, lengths, places = _read_faces(lines)
        corners.append(index)
        sides.append(lengths)
        if b"o" in text:
            for name in _OBJECT.finditer(lines.text):
                before = int(np.searchsorted(places, name.start()))
                vertices = int(
                    lines.before[0, np.searchsorted(lines.starts, name.start(), "right") - 1]
                )
                starts.append((faces + before, vertices, name[1].decode("utf-8", "replace")))
        counts = lines.after
        faces = faces + len(lengths)
    return np.concatenate(points), np.concatenate(corners), np.concatenate(sides), starts


def _read_points(lines: Lines) -> Array:
    """Return the (n, 3) vertices of a block."""
    values, at = parse_decimals(lines.keep(lines.kinds[0]))
    line = np.searchsorted(lines.starts, at, "right")
    first = np.flatnonzero(np.diff(line, prepend=-1))
    return values[first[:, None] + np.arange(3)]


def _read_faces(lines: Lines) -> tuple[Int64, Int64, Index]:
    """Return the (k,) vertices of the faces of a block, the (m,) counts of their corners, and their
    lines' offsets.
    """
    at, role, value = lines.indices(lines.has_kind("f"))
    at, value = at[role == 0], value[role == 0]
    line = np.searchsorted(lines.starts, at, "right") - 1
    is_backward = lines.letters[at] == ord("-")
    index = np.where(is_backward, lines.before[0, line] - value, value - 1)
    first = np.flatnonzero(np.diff(line, prepend=-1))
    return index, np.diff(first, append=len(index)), lines.starts[line[first]]


def read_obj_meshes(path: Path) -> list[FileMesh]:
    """Return one mesh for each object, in the file's own axes. Raises FileError and OSError."""
    points, corners, sides, starts = read_obj_faces(path)
    ends = np.append(0, np.cumsum(sides))
    meshes = []
    # Of an object the faces from begin to end, and the vertices from first to last, where the next
    # object begins.
    for i, (end, last, _) in enumerate([*starts[1:], (len(sides), len(points), "")]):
        begin, first, name = starts[i]
        # An object without faces is left out if it has no vertices, or if it is what stands before
        # the first “o”, whose vertices later faces may use.
        if begin == end and (first == last or i == 0 < len(starts) - 1):
            continue
        own = corners[ends[begin] : ends[end]]
        own_points = points
        if end - begin < len(sides):
            used, own = np.unique(own, return_inverse=True)
            own_points = points[used]
        meshes.append(FileMesh(name, own_points, *without_repeats(own, sides[begin:end])))
    return meshes
