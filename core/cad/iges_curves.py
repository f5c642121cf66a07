# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of an IGES file as B-spline curves: lines (110), arcs (100), B-splines (126) and chains of them (102).

They bound faces, in space or in the parameters of a surface, whose third coordinate is zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from ..numerics.bspline import SplineSpace, clamped_space
from ..nurbs.blender_knots import bezier_curves
from ..nurbs.splines import Curve
from .iges_text import Entry, IgesText, integers, numbers

ARC, CHAIN, LINE, SPLINE = 100, 102, 110, 126
MAX_DEPTH = 50  # nesting of subfigures, transformations and curves
MAX_PIECES = 10_000  # pieces of the boundary of a surface
MAX_ARC = 2.0 * math.pi / 3.0  # radians; a quadratic piece of a circle keeps its weights away from zero


class CurveReader:
    """A reader of the curves of a file. matrix_of: returns the (4, 4) matrix of an entity."""

    def __init__(self, text: IgesText, matrix_of: Callable[[Entry], NDArray[np.float64]]) -> None:
        self._text, self._matrix_of = text, matrix_of
        self._entries: Mapping[int, Entry] = text.entries

    def read(self, pointer: int, matrix: NDArray | None) -> list[Curve] | None:
        """Return a curve as Bézier splines end to end; None if a part is of another kind, too deep, or has weights ≤ 0.

        matrix: (4, 4), of the entities around the curve; None in the parameters of a surface, where nothing is moved.
        ValueError if it is damaged.
        """
        return self._read(pointer, matrix, 0, iter(range(MAX_PIECES)))

    def _read(self, pointer: int, matrix: NDArray | None, depth: int, left: Iterator[int]) -> list[Curve] | None:
        """Return a curve, `depth` chains deep. left: yields an item for each further piece that is allowed."""
        entry = self._entries.get(pointer)
        if entry is None or depth >= MAX_DEPTH or next(left, None) is None or matrix is None and entry.matrix:
            return None
        matrix = None if matrix is None else matrix @ self._matrix_of(entry)
        fields = self._text.fields(entry)
        if entry.type == CHAIN:
            (count,) = integers(fields, 1)
            pieces = []
            for member in integers(fields[1:], count):
                part = self._read(member, matrix, depth + 1, left)
                if part is None:
                    return None
                pieces += part
            return pieces
        made = _MAKERS[entry.type](fields) if entry.type in _MAKERS else None
        return made if made is None or matrix is None else [curve.transform(matrix) for curve in made]


def _line(fields: list[str]) -> list[Curve]:
    return [Curve(clamped_space(2), numbers(fields[:6]).reshape(2, 3))]


def _arc(fields: list[str]) -> list[Curve]:
    """Return an arc, counter-clockwise, or a full circle if its ends coincide, as quadratic pieces with weights."""
    z, *plane = numbers(fields[:7]).tolist()
    center, begin, end = np.array(plane).reshape(3, 2)
    arms = begin - center, end - center
    radius, angles = math.hypot(*arms[0]), [math.atan2(y, x) for x, y in arms]
    if not radius > 0.0:
        raise ValueError("an arc without radius")
    turn = (angles[1] - angles[0]) % (2.0 * math.pi)
    turn = 2.0 * math.pi if np.array_equal(begin, end) or not turn else turn
    steps = math.ceil(turn / MAX_ARC)
    half, curves = turn / steps / 2.0, []
    for step in range(steps):
        middle = angles[0] + (2 * step + 1) * half
        ring = [(middle - half, 1.0), (middle, 1.0 / math.cos(half)), (middle + half, 1.0)]
        points = [(*(center + radius * far * np.array([math.cos(at), math.sin(at)])), z) for at, far in ring]
        curves.append(Curve(clamped_space(3), np.array(points), np.array([1.0, math.cos(half), 1.0])))
    return curves


def _spline(fields: list[str]) -> list[Curve] | None:
    """Return the used part of a B-spline curve; None if a weight is not positive."""
    last, degree = integers(fields, 2)
    count, knot_count = last + 1, last + degree + 2
    if degree < 1 or count <= degree:
        raise ValueError("too few control points")
    values = numbers(fields[6 : 6 + knot_count + 4 * count + 2])
    if len(values) < knot_count + 4 * count + 2:
        raise ValueError("too few numbers")
    knots, weights, points, part = np.split(values, np.cumsum([knot_count, count, 3 * count]))
    if (weights <= 0.0).any():
        return None
    curve = Curve(SplineSpace(tuple(knots.tolist()), degree + 1, count), points.reshape(count, 3), weights)
    return bezier_curves(curve, (float(part[0]), float(part[1])))


_MAKERS: dict[int, Callable[[list[str]], list[Curve] | None]] = {ARC: _arc, LINE: _line, SPLINE: _spline}
