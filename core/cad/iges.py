# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rational B-spline surfaces (type 128) of an IGES file, Initial Graphics Exchange Specification 5.3.

They stand alone, in trimmed surfaces (144) whose curves trim nothing, or in subfigures (308, 408). Transformations
(124) and the unit of the global section are applied. Other surfaces and solids are refused by name; curves, points and
annotation bound nothing and are left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..nurbs.patch import Patch
from ..streams.findings import FILE_TOO_LARGE
from ..verdict.finding import FileError, finding
from .findings import CURVES_LEFT_OUT, SURFACE_DAMAGED, SURFACE_TRIMMED, SURFACE_UNSUPPORTED, SURFACES_HIDDEN
from .iges_text import Entry, IgesText, integers, numbers, padded
from .surfaces import MAX_SURFACES, Refusals, SurfaceBody, SurfaceFile, SurfaceRefusedError, blender_patches
from .trims import Piece, trims_nothing

MATRIX, SURFACE, TRIMMED, DEFINITION, INSTANCE = 124, 128, 144, 308, 408
MAX_DEPTH = 50  # nesting of subfigures, transformations and curves
RECURSION = "references to itself, or nested too deeply"
MAX_PIECES = 10_000  # pieces of the boundary of a surface
# Surfaces and solids that Blender's surfaces cannot represent, by the names of the specification. All other types
# are curves, points, annotation or structure.
REFUSED = {
    **{108: "Plane", 114: "Parametric Spline Surface", 118: "Ruled Surface", 120: "Surface of Revolution"},
    **{122: "Tabulated Cylinder", 140: "Offset Surface", 143: "Bounded Surface", 150: "Block", 152: "Wedge"},
    **{154: "Cylinder", 156: "Cone Frustum", 158: "Sphere", 160: "Torus", 162: "Solid of Revolution"},
    **{164: "Solid of Linear Extrusion", 168: "Ellipsoid", 180: "Boolean Tree", 184: "Solid Assembly"},
    **{186: "Manifold Solid B-Rep", 190: "Plane Surface", 192: "Cylindrical Surface", 194: "Conical Surface"},
    **{196: "Spherical Surface", 198: "Toroidal Surface", 412: "Rectangular Array", 414: "Circular Array"},
    **{416: "External Reference", 430: "Solid Instance", 510: "Face", 514: "Shell"},
}
NAMES = {SURFACE: "Rational B-Spline Surface", TRIMMED: "Trimmed Surface", INSTANCE: "Subfigure Instance", **REFUSED}
# Index of the parameter that points to the surface or solid which an entity refers to.
REFERENCES = {TRIMMED: 0, 140: 4, 143: 1, 430: 0, 510: 0}
CURVES = {100, 102, 104, 106, 110, 112, 116, 126, 130}  # Curves and points, which bound nothing.
PARAMETER_CURVE = 142
Value = TypeVar("Value")
Pair: TypeAlias = tuple[Value, Value]


def read_iges(path: Path) -> SurfaceFile:
    """Read the surfaces as one body, named after the file. FileError if no surface can be kept."""
    return _Reader(path).read()


class _Reader:
    def __init__(self, path: Path) -> None:
        self._text = IgesText(path)
        self._entries = self._text.entries
        self._refusals = Refusals()
        self._matrices: dict[int, NDArray[np.float64] | None] = {0: np.eye(4)}
        self._name, self._placed = path.stem, 0

    def read(self) -> SurfaceFile:
        used = set(self._references())
        patches: list[Patch] = []
        hidden = others = 0
        for entry in self._entries.values():
            if entry.type not in NAMES:
                others += entry.type in CURVES and not entry.dependent
            elif entry.number in used or entry.type in REFUSED and entry.dependent:
                continue
            elif entry.hidden:
                hidden += 1
            else:
                patches += self._place(entry, np.eye(4), ())
        notes = [finding(code, count=n) for code, n in ((SURFACES_HIDDEN, hidden), (CURVES_LEFT_OUT, others)) if n]
        return self._refusals.file([SurfaceBody(self._name, tuple(patches))], self._text.unit, notes)

    def _references(self) -> Iterator[int]:
        """Yield the numbers of entities that are parts of other entities, and so are not placed by themselves."""
        for entry in self._entries.values():
            if entry.type not in REFERENCES and entry.type != DEFINITION:
                continue
            try:
                fields = self._text.fields(entry)
                if entry.type == DEFINITION:
                    yield from self._members(fields)
                else:
                    yield from integers(fields[REFERENCES[entry.type] :], 1)
            except ValueError:
                continue  # It is refused when it is placed.

    @staticmethod
    def _members(fields: list[str]) -> list[int]:
        """Return the pointers to a subfigure's members, which follow its depth, its name and the member count."""
        (count,) = integers(fields[2:], 1)
        return integers(fields[3:], count)

    def _place(self, entry: Entry, above: NDArray, path: tuple[int, ...]) -> list[Patch]:
        """Return an entity's patches in place. above, path: (4, 4) matrix and pointers of the subfigures around it."""
        kind, name = NAMES[entry.type], entry.label or "D{}".format(entry.number)
        if entry.type in REFUSED:
            self._refusals.add(SURFACE_UNSUPPORTED, "{} ({})".format(kind, entry.type), name, base=kind)
            return []
        self._placed += 1
        if self._placed > MAX_SURFACES:
            raise FileError(FILE_TOO_LARGE, limit=MAX_SURFACES, content="surfaces")

        def make() -> list[Patch]:
            if entry.type == INSTANCE:
                return self._instance(entry, above, path)
            return self._trimmed(entry, above) if entry.type == TRIMMED else self._surface(entry, above)

        return self._refusals.keep("{} ({})".format(kind, entry.type), name, make)

    def _instance(self, entry: Entry, above: NDArray, path: tuple[int, ...]) -> list[Patch]:
        fields = self._text.fields(entry)
        (pointer,) = integers(fields, 1)
        x, y, z, scale = numbers(padded(fields[1:], 4))
        definition = self._entry(pointer, DEFINITION)
        if pointer in path or len(path) >= MAX_DEPTH:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault=RECURSION)
        local = np.diag([*[scale or 1.0] * 3, 1.0])
        local[:3, 3] = x, y, z
        matrix = above @ self._matrix(entry) @ local @ self._matrix(definition)
        patches = []
        for member in self._members(self._text.fields(definition)):
            one = self._entries[member]
            if one.type in NAMES and not one.hidden:
                patches += self._place(one, matrix, (*path, pointer))
        return patches

    def _entry(self, pointer: int, kind: int) -> Entry:
        entry = self._entries[pointer]
        if entry.type != kind:
            raise ValueError("another entity")
        return entry

    def _matrix(self, entry: Entry) -> NDArray[np.float64]:
        """Return the (4, 4) matrix of an entity: its transformation, followed by the ones that this refers to."""
        chain, pointer = [], entry.matrix
        while pointer not in self._matrices and len(chain) < MAX_DEPTH:
            chain.append(self._entry(pointer, MATRIX))
            pointer = chain[-1].matrix
        known = self._matrices.get(pointer)
        if known is None:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault=RECURSION)
        for one in reversed(chain):
            rows = numbers(self._text.fields(one)[:12])
            matrix = np.eye(4)
            matrix[:3] = rows.reshape(3, 4)
            known = known @ matrix
            self._matrices[one.number] = known
        if not abs(np.linalg.det(known[:3, :3])) > 0.0:
            raise SurfaceRefusedError(SURFACE_DAMAGED, fault="a transformation that flattens")
        return known

    def _surface(self, entry: Entry, above: NDArray) -> list[Patch]:
        return blender_patches(*_spline(self._text.fields(entry)), above @ self._matrix(entry))

    def _trimmed(self, entry: Entry, above: NDArray) -> list[Patch]:
        fields = self._text.fields(entry)
        pointer, has_outer, holes = integers(fields, 3)
        base = self._entries[pointer]
        if base.type != SURFACE:
            raise SurfaceRefusedError(SURFACE_UNSUPPORTED, base=NAMES.get(base.type, str(base.type)))
        *_, domain = _spline(self._text.fields(base))
        if holes or has_outer and not self._trims_nothing(fields, pointer, domain):
            raise SurfaceRefusedError(SURFACE_TRIMMED)
        return self._surface(base, above @ self._matrix(entry))

    def _trims_nothing(self, fields: list[str], surface: int, domain: Pair[Pair[float]]) -> bool:
        """Return whether the outer boundary curve just follows the boundary of the surface's domain."""
        (outer,) = integers(fields[3:], 1)
        _, base, curve, _, _ = integers(self._text.fields(self._entry(outer, PARAMETER_CURVE)), 5)
        pieces = self._pieces(curve, 0, iter(range(MAX_PIECES))) if base == surface else None
        return pieces is not None and trims_nothing(pieces, domain)

    def _pieces(self, pointer: int, depth: int, left: Iterator[int]) -> list[Piece] | None:
        """Return a curve as its lines and splines in order; None if a part is of another kind, moved, or too deep.

        depth: the number of curves around it. left: yields an item for each further piece that is allowed.
        """
        entry = self._entries.get(pointer)
        if entry is None or entry.matrix or depth >= MAX_DEPTH or next(left, None) is None:
            return None
        fields = self._text.fields(entry)
        if entry.type == 102:
            (count,) = integers(fields, 1)
            pieces = []
            for member in integers(fields[1:], count):
                part = self._pieces(member, depth + 1, left)
                if part is None:
                    return None
                pieces += part
            return pieces
        if entry.type == 110:
            ends = numbers(fields[:6]).reshape(2, 3)
            return [Piece(ends[:, :2], straight=True)]
        if entry.type == 126:
            return _spline_piece(fields)
        return None


def _spline_piece(fields: list[str]) -> list[Piece] | None:
    """Return a B-spline curve in parameter space; None if it is used in part, not clamped, or has weights ≤ 0."""
    last, degree = integers(fields, 2)
    count, knot_count = last + 1, last + degree + 2
    end = 6 + knot_count + 4 * count + 2
    if degree < 1 or count <= degree:
        raise ValueError("too few control points")
    values = numbers(fields[6:end])
    knots, part = values[:knot_count], values[-2:]
    points = values[knot_count + count : -2].reshape(count, 3)
    if (values[knot_count : knot_count + count] <= 0.0).any():
        return None
    if knots[0] != knots[degree] or knots[-1] != knots[count] or part[0] != knots[0] or part[1] != knots[-1]:
        return None
    return [Piece(points[:, :2], straight=degree == 1)]


def _spline(fields: list[str]) -> tuple[Pair[list[float]], Pair[int], NDArray, NDArray, Pair[Pair[float]]]:
    """Return knots, orders, (count_s, count_t, 3) points, (count_s, count_t) weights and domain of a surface."""
    last_s, last_t, degree_s, degree_t = integers(fields, 4)
    counts, degrees = (last_s + 1, last_t + 1), (degree_s, degree_t)
    if min(degrees) < 1:
        raise ValueError("degrees")
    knot_counts = [count + degree + 1 for count, degree in zip(counts, degrees)]
    total = counts[0] * counts[1]
    values = numbers(fields[9 : 9 + sum(knot_counts) + 4 * total + 4])
    s_knots, t_knots, weights, points, part = np.split(
        values, np.cumsum([knot_counts[0], knot_counts[1], total, 3 * total])
    )
    domain = (float(part[0]), float(part[1])), (float(part[2]), float(part[3]))
    knots, orders = (s_knots.tolist(), t_knots.tolist()), (degree_s + 1, degree_t + 1)
    # The first direction runs fastest.
    return knots, orders, points.reshape(*counts[::-1], 3).swapaxes(0, 1), weights.reshape(counts[::-1]).T, domain
