# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of IGES files as B-spline curves.

Lines (110), arcs (100), conics (104), B-splines (126) and chains of them (102) bound faces, in
space or in the parameters of a surface, whose third coordinate is zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from ..numerics import NDArray, SplineSpace, clamped_space, lengths
from ..nurbs import Curve, bezier_curves
from .iges_entities import MAX_DEPTH, IgesText, Places, integers, numbers
from .iges_types import ARC, CHAIN, CONIC, LINE, SPLINE_CURVE
from .sweeps import conic_pieces

MAX_PIECES = 10_000  # entities of one curve of a boundary, chains included


class CurveReader:
    """A reader of the curves of a file."""

    def __init__(self, text: IgesText, places: Places) -> None:
        self._text = text
        self._places = places
        self._rounding = 0.0
        self._entities_left = 0

    def take_rounding(self) -> float:
        """Return the largest effect of the decimals on points of the curves in space that were read
        since the last call.
        """
        rounding = self._rounding
        self._rounding = 0.0
        return rounding

    def read(self, pointer: int, matrix: NDArray | None) -> list[Curve] | None:
        """Return a curve as Bézier splines end to end; None if a part is of another kind, too deep,
        or has weights ≤ 0.

        matrix: (4, 4), of the entities around the curve; None in the parameters of a surface, where
        nothing is moved. ValueError if it is damaged.
        """
        self._entities_left = MAX_PIECES
        return self._read_part(pointer, matrix, 0)

    def _read_part(self, pointer: int, matrix: NDArray | None, depth: int) -> list[Curve] | None:
        """Return a part of a curve within `depth` chains, or None."""
        entry = self._text.entries.get(pointer)
        if entry is None or depth >= MAX_DEPTH or not self._entities_left:
            return None
        if matrix is None and entry.matrix:
            return None
        self._entities_left -= 1
        turning = 0.0
        if matrix is not None:
            own_matrix, turning = self._places.matrix_and_turning(entry)
            matrix = matrix @ own_matrix
        fields = self._text.fields(entry)
        if entry.type == CHAIN:
            return self._read_chain(fields, matrix, depth)
        curves = _MAKERS[entry.type](fields) if entry.type in _MAKERS else None
        if matrix is None:
            return curves
        # The decimals of a curve that cannot be read count, too: they tell how fine the file is.
        reach = max((float(lengths(curve.points).max()) for curve in curves or ()), default=0.0)
        moved = self._local_rounding(entry.type, fields, curves or ()) + turning * reach
        self._rounding = max(self._rounding, float(np.linalg.norm(matrix[:3, :3], 2)) * moved)
        return None if curves is None else [curve.transform(matrix) for curve in curves]

    def _read_chain(
        self, fields: list[str], matrix: NDArray | None, depth: int
    ) -> list[Curve] | None:
        """Return the curves of all members of a chain within `depth` others, or None."""
        (count,) = integers(fields, 1)
        chain = []
        for member in integers(fields[1:], count):
            curves = self._read_part(member, matrix, depth + 1)
            if curves is None:
                return None
            chain += curves
        return chain

    def _local_rounding(self, kind: int, fields: list[str], curves: Sequence[Curve]) -> float:
        """Return the effect of the decimals of a simple curve's numbers on its points."""
        if kind == CONIC and curves:
            return self._text.rounding(fields[6:]) + self._conic_rounding(fields, curves)
        # Two fifths of a spline's numbers are knots and weights, which stand before its points.
        first = 6 + 2 * len(fields[6:]) // 5 if kind == SPLINE_CURVE else 0
        return self._text.rounding(fields[first:])

    def _conic_rounding(self, fields: list[str], curves: Sequence[Curve]) -> float:
        """Return the effect of the decimals of a conic's coefficients on its points: that on the
        value of its equation, divided by the equation's slope.
        """
        a, b, c, d, e, _ = numbers(fields[:6])
        x, y, _ = np.concatenate([curve.points[[0, -1]] for curve in curves]).T
        terms = np.abs([x * x, x * y, y * y, x, y, np.ones_like(x)])
        value_error = np.array([self._text.rounding([field]) for field in fields[:6]]) @ terms
        slope = np.hypot(2.0 * a * x + b * y + d, b * x + 2.0 * c * y + e)
        return float((value_error / np.maximum(slope, 1e-300)).max())


def _line(fields: list[str]) -> list[Curve]:
    return [Curve(clamped_space(2), numbers(fields[:6]).reshape(2, 3))]


def _arc(fields: list[str]) -> list[Curve]:
    z, *plane = numbers(fields[:7]).tolist()
    return _circle_arc(z, *np.array(plane).reshape(3, 2))


def _circle_arc(z: float, center: NDArray, begin: NDArray, end: NDArray) -> list[Curve]:
    """Return an arc, counter-clockwise, or a full circle if its ends coincide, as quadratic pieces
    with weights.
    """
    arms = begin - center, end - center
    radius = math.hypot(*arms[0])
    angles = [math.atan2(y, x) for x, y in arms]
    if not radius > 0.0:
        raise ValueError("an arc without radius")
    turn = (angles[1] - angles[0]) % (2.0 * math.pi)
    turn = 2.0 * math.pi if np.array_equal(begin, end) or not turn else turn
    frame = np.eye(4)
    frame[:3, 3] = *center, z
    return conic_pieces(frame, (radius, radius), (angles[0], angles[0] + turn))


def _conic(fields: list[str]) -> list[Curve] | None:
    """Return an arc of an ellipse, counter-clockwise, of a parabola or of a hyperbola; None for
    other conics.
    """
    a, b, c, d, e, f, z, *ends = numbers(fields[:11]).tolist()
    begin, end = np.array(ends).reshape(2, 2)
    # The conic is p @ form @ p = 0 for p = (x, y, 1).
    form = np.array([[a, b / 2.0, d / 2.0], [b / 2.0, c, e / 2.0], [d / 2.0, e / 2.0, f]])
    is_ellipse = np.linalg.det(form[:2, :2]) > 1e-14 * np.trace(form[:2, :2]) ** 2
    return (_ellipse_arc if is_ellipse else _open_arc)(form, z, begin, end)


def _ellipse_arc(form: NDArray, z: float, begin: NDArray, end: NDArray) -> list[Curve] | None:
    """Return an arc of an ellipse of a (3, 3) form, counter-clockwise, or None if the form has no
    points.
    """
    square = form[:2, :2]
    center = -np.linalg.solve(2.0 * square, 2.0 * form[2, :2])
    # Scaled so that (p - center) @ square @ (p - center) is 1 on the ellipse.
    square = square / (center @ square @ center - form[2, 2])
    if not np.trace(square) > 0.0:
        return None
    # The ellipse is the image of the unit circle under this map.
    matrix = np.eye(4)
    matrix[:2, :2] = np.linalg.inv(np.linalg.cholesky(square).T)
    matrix[:2, 3] = center
    on_circle = [np.linalg.solve(matrix[:2, :2], place - center) for place in (begin, end)]
    return [curve.transform(matrix) for curve in _circle_arc(z, np.zeros(2), *on_circle)]


def _open_arc(form: NDArray, z: float, begin: NDArray, end: NDArray) -> list[Curve] | None:
    """Return an arc of a parabola or a hyperbola of a (3, 3) form, or None if its ends are not on
    one branch.
    """
    first, last = np.append(begin, 1.0), np.append(end, 1.0)
    meet = np.cross(form @ first, form @ last)  # of the tangents at both ends
    if not meet[2]:
        return None
    meet /= meet[2]
    # The tangents and both ends leave the form of first + 2 w meet + last at
    # 2 first @ form @ last + 4 w² meet @ form @ meet, which is zero on the conic.
    squared_weight = -float(first @ form @ last) / (2.0 * float(meet @ form @ meet) or math.inf)
    if not squared_weight > 0.0:
        return None
    points = np.array([first, meet, last])
    points[:, 2] = z
    return [Curve(clamped_space(3), points, np.array([1.0, math.sqrt(squared_weight), 1.0]))]


def _spline(fields: list[str]) -> list[Curve] | None:
    """Return the used part of a B-spline curve; None if a weight is not positive."""
    last, degree = integers(fields, 2)
    count = last + 1
    knot_count = count + degree + 1
    if degree < 1 or count <= degree:
        raise ValueError("too few control points")
    values = numbers(fields[6 : 6 + knot_count + 4 * count + 2])
    if len(values) < knot_count + 4 * count + 2:
        raise ValueError("too few numbers")
    knots, weights, points, used_part = np.split(values, np.cumsum([knot_count, count, 3 * count]))
    if (weights <= 0.0).any():
        return None
    space = SplineSpace(tuple(knots.tolist()), degree + 1, count)
    curve = Curve(space, points.reshape(count, 3), weights)
    return bezier_curves(curve, (float(used_part[0]), float(used_part[1])))


_MAKERS: dict[int, Callable[[list[str]], list[Curve] | None]] = {
    ARC: _arc,
    CONIC: _conic,
    LINE: _line,
    SPLINE_CURVE: _spline,
}
