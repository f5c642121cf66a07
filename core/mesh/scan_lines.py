# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Crossings of parallel lines with the faces of bodies.

The lines run along the shortest side of a body's box, a little aslant, so that they are parallel to
none of the box's faces. Across the box they form a lattice of rows and columns. As in drawing a
picture, a row crosses a triangle between two of its edges, and the columns between these meet it:
only faces with corners in several rows and columns cause work. A row crosses an edge if one end is
above the row. The place is computed from the vertex with the lower index on, so that triangles that
share the edge get the same place, and no line slips through between them.

Several bodies share a scan, each with its own lines and the same result as alone. Rows of a body
are left out if the work would exceed the limit for its number of triangles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics import Array, Index, Mask, NDArray, batches, segment_ranges, sums_by_index
from .surface import Surface, flipped_quads

LINE_SLOPES = 0.08173, 0.05311  # direction of the lines: across, for each length along
LATTICE_SHIFT = 0.4669, 0.2371  # in rows and columns: no line meets a lattice of vertices
COLUMN_SLOPE = 0.6180339887498949  # shift of columns from row to row, in column widths
POINTS_PER_BLOCK = 1 << 14
FACES_PER_BLOCK = 1 << 16
PAIRS_PER_BLOCK = 1 << 16  # pairs of triangles and rows
# lines through a body; and for each √triangles
MIN_LINES = 576
MAX_LINES = 2048
LINES_PER_SQRT = 5.0
# Limits for a body, of t triangles: (pairs, more pairs for each t) of triangles and rows, and of
# triangles and lines.
MAX_PAIRS = 8192, 1.0
MAX_CROSSINGS = 16384, 0.5


@dataclass(frozen=True, eq=False)
class LineGrids:
    """The lines through each of b bodies.

    `axes`: (b, 3) the points' axes from row to row, along a row, and along the lines; `center`: (b,
    3) in that order. `cell`: (b, 2) height of rows and width of columns; `origin`: (b, 2) row and
    column of the center, counted from 0. `rows`, `columns`: the largest numbers of any body.
    """

    axes: Index
    center: Array
    cell: Array
    origin: Array
    rows: int
    columns: int

    @classmethod
    def over_boxes(cls, low: NDArray, high: NDArray, lines: NDArray[np.integer]) -> LineGrids:
        """Make grids of about `lines`, (b,), lines each over boxes, (b, 3)."""
        axes = np.argsort(low - high, axis=1, kind="stable")  # longest first
        body = np.arange(len(low))[:, None]
        extent = (high - low)[body, axes]
        center = ((low + high) / 2.0)[body, axes]
        width = extent[:, :2] + LINE_SLOPES * extent[:, 2:]
        # A body without width in a direction has a row or column that is not empty.
        width = np.maximum(width, 1e-6 * width.max(axis=1, keepdims=True) + np.finfo(float).tiny)
        rows = np.clip(np.rint(np.sqrt(lines * width[:, 0] / width[:, 1])), 1, lines)
        columns = np.maximum(np.rint(lines / rows), 1)
        # One more row and column for the shift, and more columns for their slope.
        counts = np.array([rows, np.ceil(columns + COLUMN_SLOPE * rows)]).T + 1.0
        largest_rows, largest_columns = counts.max(axis=0).astype(np.intp).tolist()
        return cls(
            axes=axes,
            center=center,
            cell=width / np.array([rows, columns]).T,
            origin=np.floor(counts / 2.0) + LATTICE_SHIFT,
            rows=largest_rows + 1,
            columns=largest_columns + 1,
        )

    def places(self, points: NDArray[np.floating], body: NDArray[np.integer] | None) -> Array:
        """Return the (3, n) rows, columns and lengths along the lines of points, the first two with
        fractions. body: (n,), None for a single body.
        """
        if body is None:
            body = np.zeros(1, np.intp)
            places = points.T[self.axes[0]].astype(np.float64)
        else:
            places = points[np.arange(len(points)), self.axes[body].T].astype(np.float64)
        places -= self.center[body].T
        places[:2] -= np.multiply.outer(LINE_SLOPES, places[2])
        places[:2] /= self.cell[body].T
        places[1] -= COLUMN_SLOPE * places[0]
        places[:2] += self.origin[body].T
        return places

    def squared_distances(
        self,
        body: Index,
        row: Index,
        column: Index,
        along: Array,
    ) -> Array:
        """Return the (k,) squared distances of places on lines from the centers of their bodies
        (unit²).
        """
        across = np.stack([row, column], axis=1) - self.origin[body]
        across[:, 1] += COLUMN_SLOPE * across[:, 0]
        across = across * self.cell[body] + np.multiply.outer(along, LINE_SLOPES)
        return np.einsum("ij,ij->i", across, across) + along**2


@dataclass(frozen=True, eq=False)
class Crossings:
    """The k crossings of lines (`body`, `row`, `column`) with the triangles of b bodies.

    `triangle`: 2q and 2q + 1 for quad q, then the triangles. `along`: the distance along the line
    from the body's center. `sign`: 1 if a line enters and -1 if it leaves a body that faces
    outward. `rows_apart`: (b,) distance of the rows that were taken.
    """

    body: Index
    row: Index
    column: Index
    triangle: Index
    along: Array
    sign: Index
    rows_apart: Index


def line_counts(triangles: NDArray[np.integer]) -> Index:
    """Return (b,) numbers of lines for bodies of these numbers of triangles."""
    return np.clip(LINES_PER_SQRT * np.sqrt(triangles), MIN_LINES, MAX_LINES).astype(np.intp)


def find_crossings(
    surface: Surface, grids: LineGrids, body: NDArray[np.integer] | None = None
) -> Crossings:
    """Find the crossings of lines with faces of bodies, unordered. body: (n,) of the points, None
    for a single body.
    """
    corners, number = _crossed_triangles(surface, _cells(surface.points, grids, body))
    owner = np.zeros(len(number), np.intp) if body is None else body[corners[0]].astype(np.intp)
    face_counts = np.array([surface.triangle_count])
    if body is not None:
        halves = np.concatenate([surface.quads[:, 0], surface.quads[:, 0], surface.triangles[:, 0]])
        face_counts = np.bincount(body[halves], minlength=len(grids.cell))
    flat = corners.ravel()
    places = grids.places(surface.points.take(flat, 0), None if body is None else body[flat])
    spans, rows_apart = _cross_rows(places, flat, owner, face_counts, grids)
    owner = owner[spans.triangle]
    left, right = spans.left, spans.right
    start, stop = (
        np.clip(np.ceil(end[0]), 0, grids.columns).astype(np.intp) for end in (left, right)
    )
    counts = stop - start
    work = sums_by_index(owner, counts, len(grids.cell))
    rows_apart = rows_apart * _rows_apart(work, MAX_CROSSINGS, face_counts)
    counts[spans.row % rows_apart[owner] > 0] = 0
    span = np.repeat(np.arange(len(counts)), counts)
    column = start[span] + segment_ranges(counts)
    share = (column - left[0, span]) / (right[0, span] - left[0, span])
    return Crossings(
        body=owner[span],
        row=spans.row[span],
        column=column,
        triangle=number[spans.triangle[span]],
        along=left[1, span] + share * (right[1, span] - left[1, span]),
        sign=spans.sign[span],
        rows_apart=rows_apart,
    )


@dataclass(frozen=True, eq=False)
class _RowSpans:
    """The k pieces of rows within triangles, between two of the edges.

    `triangle`, `row`: (k,). `left`, `right`: (2, k) column and length along the lines at both ends.
    `sign`: (k,) as in `Crossings`.
    """

    triangle: Index
    row: Index
    left: Array
    right: Array
    sign: Index


def _cross_rows(
    places: Array, corners: Index, owner: Index, face_counts: Index, grids: LineGrids
) -> tuple[_RowSpans, Index]:
    """Return the pieces of the scanned rows in triangles, and the (b,) distances of these rows.

    places, corners: (3, 3t) and (3t,), the first corners of all t triangles first. owner: (t,) the
    body of each triangle.
    """
    lowest_above = np.ceil(places[0]).astype(np.intp).reshape(3, -1)
    first, stop = (
        np.clip(row, 0, grids.rows)
        for row in (np.minimum.reduce(lowest_above), np.maximum.reduce(lowest_above))
    )
    work = sums_by_index(owner, stop - first, len(face_counts))
    rows_apart = _rows_apart(work, MAX_PAIRS, face_counts)
    step = rows_apart[owner]
    first = -(-first // step) * step
    counts = np.maximum(-((first - stop) // step), 0)
    none = np.empty(0, np.intp)
    spans = [_RowSpans(none, none, np.empty((2, 0)), np.empty((2, 0)), none)]
    for part in batches(counts, PAIRS_PER_BLOCK):
        triangle = part.start + np.repeat(np.arange(len(counts[part])), counts[part])
        row = first[triangle] + segment_ranges(counts[part]) * step[triangle]
        is_below = lowest_above.take(triangle, 1) > row
        spans.append(
            _RowSpans(triangle, row, *_cross_row(places, corners, triangle, is_below, row))
        )
    columns = zip(*[vars(span).values() for span in spans])
    return _RowSpans(*[np.concatenate(column, axis=-1) for column in columns]), rows_apart


def _cells(
    points: NDArray[np.floating], grids: LineGrids, body: NDArray[np.integer] | None
) -> tuple[NDArray[np.integer], NDArray[np.integer]]:
    """Return the (n,) lowest rows and the (n,) lowest columns that are not below the points."""
    # The cache holds more of the shorter type.
    is_short = max(grids.rows, grids.columns) < np.iinfo(np.int16).max // 4
    cells = np.empty((2, len(points)), np.int16 if is_short else np.int32)
    for start in range(0, len(points), POINTS_PER_BLOCK):
        part = slice(start, start + POINTS_PER_BLOCK)
        places = grids.places(points[part], None if body is None else body[part])
        cells[:, part] = np.ceil(places[:2])
    return cells[0], cells[1]


def _rows_apart(work: Array, limit: tuple[int, float], faces: Index) -> Index:
    """Return the (b,) distances, in rows, between the scanned rows of bodies, so that the work
    stays within a limit.
    """
    fixed, per_face = limit
    return np.maximum(np.ceil(work / (fixed + per_face * faces)), 1).astype(np.intp)


def _crossed_triangles(
    surface: Surface, cells: tuple[NDArray[np.integer], NDArray[np.integer]]
) -> tuple[Index, Index]:
    """Return (3, k) corners, and indices, of the triangles, or halves of quads, that span several
    rows and columns.
    """
    triangles = [np.empty((3, 0), np.intp)]
    indices = [np.empty(0, np.intp)]
    quads = surface.quads
    for faces in (quads, surface.triangles):
        for start in range(0, len(faces), FACES_PER_BLOCK):
            block = faces[start : start + FACES_PER_BLOCK].T.astype(np.intp, order="C")
            in_rows = np.flatnonzero(_differ(cells[0], block))
            block = block.take(in_rows, 1)
            in_columns = np.flatnonzero(_differ(cells[1], block))
            face = start + in_rows[in_columns]
            corners = block.take(in_columns, 1)
            if faces is quads:
                flipped = flipped_quads(surface.points, corners.T)
                corners = np.where(flipped, np.roll(corners, -1, axis=0), corners)
                triangles.append(
                    corners.take([[0, 0], [1, 2], [2, 3]], 0).transpose(0, 2, 1).reshape(3, -1)
                )
                indices.append((2 * face[:, None] + [0, 1]).ravel())
            else:
                triangles.append(corners)
                indices.append(2 * len(quads) + face)
    return np.concatenate(triangles, axis=1), np.concatenate(indices)


def _differ(cell: NDArray[np.integer], corners: Index) -> Mask:
    """Return a (k,) mask of faces whose corners, (3 or 4, k), are in different rows, or columns."""
    first = cell.take(corners[0])
    differ = cell.take(corners[1]) != first
    for corner in corners[2:]:
        differ |= cell.take(corner) != first
    return differ


def _cross_row(
    places: Array,
    corners: Index,
    triangle: Index,
    is_below: Mask,
    row: Index,
) -> tuple[Array, Array, Index]:
    """Return the points, (2, k), at which a row enters and leaves triangles, and the sign of the
    crossings.

    is_below: (3, k) mask of the corners with the row below them.
    """
    first, second, third = is_below
    # The two edges at the corner that is alone on its side cross the row: at 2, 1 (True) or 0
    # (False).
    lone = np.where(first == second, 2, first == third)
    # Of three, exactly one is below; otherwise two are.
    is_lone_below = (first ^ second ^ third) & ~(first & second & third)
    total = len(corners) // 3
    lone_corner = triangle + total * lone
    ends = []
    for k in (1, 2):
        other_corner = triangle + total * ((lone + k) % 3)
        # Computed from the lower vertex on, so that the neighbor across the edge gets the same.
        swap = corners.take(lone_corner) > corners.take(other_corner)
        begin = places.take(np.where(swap, other_corner, lone_corner), 1)
        end = places.take(np.where(swap, lone_corner, other_corner), 1)
        share = (row - begin[0]) / (end[0] - begin[0])
        ends.append(begin[1:] + share * (end[1:] - begin[1:]))
    forward = ends[0][0] < ends[1][0]
    left = np.where(forward, ends[0], ends[1])
    right = np.where(forward, ends[1], ends[0])
    return left, right, np.where(forward == is_lone_below, -1, 1)
