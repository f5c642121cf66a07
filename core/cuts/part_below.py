# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of the part of a body below a plane, and of the cut face, for many planes at once.

In axes with z along the plane's normal n, at height d over the reference point, the divergence
theorem gives for the part below and for the cut face

    ∫ x^a y^b z^c dV = (S[a, b, c+1] - d^(c+1) S[a, b, 0]) / (c + 1),   ∫ x^a y^b dA = -S[a, b, 0],

where S[a, b, c] = ∫ x^a y^b z^c n_z dA is over the surface below the plane: the cut face itself is
never made. Over a triangle, S is its doubled projected area w times a mean; with sums s = Σ u and
Q = Σ z u over its corners,

    2 S[1] = w,   6 S[u] = w s,   24 S[uv] = w (s s' + Σ u v),
    120 S[uvz] = w (s_z s s' + s Q' + s' Q + Σ (s_z + 2 z) u v).

A triangle counts as a whole for the planes above its middle corner. For planes between two of its
corners, the small triangle between the plane and the corner that is alone on its side is added
below the middle, subtracted above. So one pass sorts all triangles by their middle corners, and
only the pairs of a triangle with a plane through it are cut.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..inertia import frame_about
from ..mesh import Surface
from ..moments import (
    PAIRWISE_SUM_ROUNDINGS,
    Measure,
    Moments,
    U,
    image,
    monomials,
    unchecked_moments,
)
from ..numerics import (
    Array,
    ArrayLike,
    Index,
    Integers,
    PerBody,
    batches,
    float_array,
    index_array,
    run_starts,
    segment_ranges,
)
from ..polyhedron import BOUNDARY_OPEN
from ..solid import measure_solid
from ..verdict import MeasureError, Procedure, check_size

TRIANGLES_PER_BLOCK = 4096  # triangles whose products stay in the cache
EXPONENTS = monomials(2)
# Rows of the sums: 1, x, y, z, xx, xy, xz, yy, yz, zz, then the latter six times z.
DIVISORS = np.array([2.0, 6.0, 6.0, 6.0, *6 * [24.0], *6 * [120.0]])
RAISED = np.array([3, 6, 8, 9, 10, 11, 12, 13, 14, 15])  # rows of each monomial times z
# Rows of each monomial with z left out.
LEVEL = np.array([0, 1, 2, 0, 4, 5, 1, 7, 2, 0])
# Errors in units of rounding: of rotated positions; of the products for one triangle, relative to
# its area and to the products in its area.
PLACE_ROUNDINGS = 24.0
PRODUCT_ROUNDINGS = 40.0
SPREAD_ROUNDINGS = 8.0


@dataclass(frozen=True, eq=False)
class PartBelow:
    """The parts of a body below k planes, and their cut faces; or below one, without leading axis.

    The face is the derivative of the part by the plane: a plane that moves by dh along its normal
    adds ``face_area`` dh to the volume and ``face_first`` dh to the first moments; one that tilts
    adds moments of the face of the next order.

    Attributes
    ----------
    part : Moments
        Stack of k volumes, to order 2, about the middle of the points' box.
    face : Moments
        Stack of k areas, to order 2, about points in the planes. Of faces of the body that lie in
        the plane, those with the body below them count; the bounds hold if none lies within
        rounding of the plane.
    volume, first, second : (k,), (k, 3), (k, 3, 3) array
        ∫1, ∫x, ∫x x' over the part, about the origin of the points' frame.
    face_area, face_first, face_second : (k,), (k, 3), (k, 3, 3) array
        The same over the cut face, whose outward normal is the plane's.
    """

    part: Moments
    face: Moments

    @cached_property
    def _at_origin(self) -> tuple[Moments, Moments]:
        origin = np.zeros(self.part.about.shape)
        return self.part.about_point(origin), self.face.about_point(origin)

    @property
    def volume(self) -> PerBody:
        return self.part.total

    @property
    def first(self) -> Array:
        return self._at_origin[0].raw[..., 1:4]

    @property
    def second(self) -> Array:
        return self._at_origin[0].second()

    @property
    def face_area(self) -> PerBody:
        return self.face.total

    @property
    def face_first(self) -> Array:
        return self._at_origin[1].raw[..., 1:4]

    @property
    def face_second(self) -> Array:
        return self._at_origin[1].second()


def below(surface: Surface, plane: ArrayLike) -> PartBelow:
    """Measure the part of the body that a surface bounds below a plane.

    The surface is repaired as by `measure_solid`.

    Parameters
    ----------
    surface : Surface
    plane : float, (4,) or (k, 4) array_like
        A height z; or rows a, b, c, d of planes: the parts where a x + b y + c z <= d.

    Returns
    -------
    PartBelow

    Raises
    ------
    MeasureError
        If the surface bounds no body.

    Examples
    --------
    >>> from body_moments.core import Surface, below
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> part = below(Surface.from_triangles(np.eye(4, 3, -1), faces), 0.5)
    >>> round(part.volume * 48, 9), (part.first * 384).round(9).tolist()
    (7.0, [15.0, 15.0, 11.0])
    """
    solid = measure_solid(surface)
    if solid.method is Procedure.OPEN:
        raise MeasureError(BOUNDARY_OPEN)
    rows = np.asarray(plane, np.float64)
    if rows.ndim == 0:
        rows = np.append([0.0, 0.0, 1.0], rows)
    single = rows.ndim == 1
    rows = float_array("plane", rows[None] if single else rows, "k", 4, finite=True)
    closed = solid.repaired_surface
    triangles = closed.all_triangles()[0]
    parts = measure_below(
        closed.points, triangles, rows[:, :3], rows[:, 3], closed.coordinate_error
    )
    return PartBelow(parts.part.at(0), parts.face.at(0)) if single else parts


def measure_below(
    points: ArrayLike,
    triangles: ArrayLike,
    normals: ArrayLike,
    offsets: ArrayLike,
    displacement: ArrayLike = (0.0, 0.0, 0.0),
    *,
    is_open: bool = False,
) -> PartBelow:
    """Measure the parts of a closed body where normal · x <= offset, for k planes.

    Planes with the same normal share one pass over the mesh.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise from outside.
    normals : (k, 3) array_like
        Of any length but zero.
    offsets : (k,) array_like
    displacement : (3,) array_like
        Largest shift of the points by storing, for `input_error` of a closed body
        (`Surface.coordinate_error`).
    is_open : bool
        True for a surface without a body. The parts are the prisms between the triangles below the
        plane and the plane, with negative volume under triangles that face up (along the normal),
        and the faces are their projections onto the plane.

    Returns
    -------
    PartBelow

    Raises
    ------
    ValueError
        If a number is not finite, a normal is zero, or a triangle names no point.

    Examples
    --------
    >>> from body_moments.core.cuts import measure_below
    >>> triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> below = measure_below(np.eye(4, 3, -1), triangles, [[0, 0, 1]], [0.5])
    >>> (below.volume * 48).round(9).tolist(), (below.face_area * 8).round(9).tolist()
    ([7.0], [1.0])
    """
    points = float_array("points", points, "n", 3, finite=True)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    normals = float_array("normals", normals, "k", 3, finite=True)
    offsets = float_array("offsets", offsets, len(normals), finite=True)
    displacement = float_array("displacement", displacement, 3, finite=True)
    sizes = np.sqrt((normals * normals).sum(axis=1))
    if not sizes.all():
        raise ValueError("normals must not be zero")
    units = normals / sizes[:, None] + 0.0
    low = points.min(axis=0, initial=np.inf)
    high = points.max(axis=0, initial=-np.inf)
    center = low / 2.0 + high / 2.0 if len(points) else np.zeros(3)
    local = (points - center).T
    if len(points):
        check_size(*(high - low))
    heights = offsets / sizes - units @ center
    # The plane's height and the points' rounded coordinates shift the cut.
    step = float(np.linalg.norm(displacement))
    # The heights err by at most 2 roundings of the offsets, and by scalar products with the center.
    noise = 2.0 * U * (np.abs(offsets / sizes) + 4.0 * float(np.abs(center).max()))
    parts = np.zeros((len(normals), 10))
    faces = np.zeros((len(normals), 10))
    bounds = np.zeros((4, len(normals), 10))
    about = np.zeros((len(normals), 3))
    axes = np.zeros((len(normals), 3, 3))
    directions, group = np.unique(units, axis=0, return_inverse=True)
    for i, direction in enumerate(directions):
        frame = np.array(frame_about(direction.tolist()))
        rows = np.flatnonzero(group.reshape(-1) == i)
        rows = rows[np.argsort(heights[rows], kind="stable")]
        turned = np.einsum("ij,jn->in", frame, local)
        parts[rows], faces[rows], about[rows], bounds[:, rows] = _below(
            turned, triangles, heights[rows], noise[rows], step, is_open
        )
        axes[rows] = frame.T
    matrices = np.concatenate([axes, np.broadcast_to(center[:, None], (len(axes), 3, 1))], axis=2)
    centers = np.broadcast_to(center, about.shape)
    # As masses, which no map scales: a rotation stretches neither volumes nor areas, however it was
    # rounded.
    part = unchecked_moments(parts, np.zeros_like(about), Measure.MASS, bounds[0], bounds[1])
    face = unchecked_moments(faces, about, Measure.MASS, bounds[2], bounds[3])
    part, face = image(part, matrices, centers), image(face, matrices)
    return PartBelow(
        unchecked_moments(
            part.raw, part.about, Measure.VOLUME, part.rounding_error, part.input_error
        ),
        unchecked_moments(
            face.raw, face.about, Measure.AREA, face.rounding_error, face.input_error
        ),
    )


def cut_outline(points: Array, triangles: Integers, normal: ArrayLike, offset: float) -> Array:
    """Return (k, 2, 3) segments along which triangles cross the plane normal · x = offset."""
    heights = points @ np.asarray(normal) - offset
    start, stop = triangles, np.roll(triangles, -1, axis=1)
    crossed = (heights > 0.0)[start] != (heights > 0.0)[stop]
    start, stop = start[crossed], stop[crossed]
    share = (heights[start] / (heights[start] - heights[stop]))[:, None]
    return (points[start] + share * (points[stop] - points[start])).reshape(-1, 2, 3)


def _below(
    points: Array,
    triangles: Integers,
    heights: Array,
    noise: Array,
    step: float,
    is_open: bool,
) -> tuple[Array, Array, Array, Array]:
    """Return (k, 10) moments of the parts below k ascending heights, and of their faces; (k, 3)
    points that the latter are about; and (4, k, 10) bounds: of the parts by rounding and by
    storing, then of the faces.

    points: (3, n) from the point that the parts are about, z along the normal. noise: (k,) errors
    of the heights. step: displacement of the points by storing.
    """
    low = points.min(axis=1, initial=0.0)
    high = points.max(axis=1, initial=0.0)
    levels = heights if is_open else np.clip(heights, low[2], high[2])
    reach = np.maximum(high, -low)[:, None] + np.zeros(len(levels))
    reach[2] = np.maximum(reach[2], np.abs(levels))
    # The surface moves relative to the planes by rounding, and by storing.
    shifts = np.stack(
        [noise + PLACE_ROUNDINGS * U * np.sqrt((reach * reach).sum(axis=0)), 0 * noise]
    )
    shifts[1] = step
    sums, sizes = _sums_below(points, triangles, levels, shifts.sum(axis=0))
    depth = EXPONENTS[:, 2, None] + 1.0
    parts = (sums[RAISED] - levels**depth * sums[LEVEL]) / depth
    faces = np.where(EXPONENTS[:, 2, None] == 0, -sums[:10], 0.0)
    if not is_open:
        faces[:, heights > high[2]] = 0.0
    area, spread, edges, count, unclear, roundings = sizes  # the results of `_sums_below`
    largest = np.multiply.reduce((reach + shifts.sum(axis=0)) ** EXPONENTS[:, :, None], axis=1)
    products = U * ((PRODUCT_ROUNDINGS + roundings) * area + SPREAD_ROUNDINGS * spread)
    bounds = np.zeros((4, *parts.shape))
    bounds[0] = products * largest * reach[2] + 8.0 * U * np.abs(parts)
    bounds[2] = products * largest + 8.0 * U * np.abs(faces)
    for i, shift in enumerate(shifts):
        # Triangles beyond the plane may reach through it: within the box's section.
        swept = area / 2.0 + shift * (edges + 2.0 * shift * count) + 8.0 * reach[0] * reach[1]
        bounds[i] += shift * swept * largest
        # A tip that only just reaches the plane counts by its width.
        edge = edges + 2.0 * shift * count + 4.0 * (reach[0] + reach[1])
        tilted = shift * edge + unclear
        across = np.maximum(reach[:2].max(axis=0), shift)
        share = EXPONENTS.sum(axis=1)[:, None] * shift / np.where(across > 0.0, across, 1.0)
        bounds[2 + i] += (tilted + share * area) * largest
    middle = np.zeros((len(levels), 3))
    middle[:, 2] = levels
    return parts.T, faces.T, middle, bounds.swapaxes(1, 2)


def _sums_below(
    points: Array, triangles: Integers, levels: Array, shifts: Array
) -> tuple[Array, Array]:
    """Return (16, k) sums over the surface below k ascending levels, and (6, k) sizes for bounds.

    The sizes are those of the summed triangles: doubled area, size of the products in it, length of
    edges, number; the face's area that shifts of the plane leave open; roundings of the sums.
    """
    k = len(levels)
    index = np.min_scalar_type(k)
    # The first level above each point, and the first that is not below it.
    above = np.searchsorted(levels, points[2], "right").astype(index)
    not_below = np.searchsorted(levels, points[2], "left").astype(index)
    # The mode "clip" saves checks of the indices, half of the time; `index_array` has checked them.
    columns = np.ascontiguousarray(triangles.T)
    a, b, c = above.take(columns, mode="clip")
    # Of each triangle, the first levels above its lowest and above its middle corner.
    lowest = np.minimum(np.minimum(a, b), c)
    middle = np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
    table = np.zeros((21, k))
    order = np.flatnonzero(middle < k)
    if k > 1:
        order = order[np.argsort(middle[order], kind="stable")]
    whole = len(order)
    for start in range(0, whole, TRIANGLES_PER_BLOCK):
        rows = order[start : start + TRIANGLES_PER_BLOCK]
        corners = points.take(columns[:, rows], axis=1, mode="clip")
        weight, sizes = _weights(corners)
        _add_sums(table, corners, weight, sizes, middle[rows])
    # A triangle that is whole below a level is so below all higher ones.
    table = np.cumsum(table, axis=1)
    stop = np.maximum(middle, not_below.take(columns, mode="clip").max(axis=0))
    crossed = np.flatnonzero(stop > lowest)
    counts = (stop[crossed] - lowest[crossed]).astype(np.intp)
    for part in batches(counts, TRIANGLES_PER_BLOCK):
        # A row for each pair of a triangle and a level through it.
        rows = np.repeat(crossed[part], counts[part])
        level = lowest[rows] + segment_ranges(counts[part])
        order = np.argsort(level, kind="stable")
        rows, level = rows[order], level[order]
        corners = points.take(columns[:, rows], axis=1, mode="clip")
        weight, sizes = _weights(corners)
        z = corners[2]
        is_low = level < middle[rows]
        # The corner that is alone on its side comes first; the others move along their edges to the
        # level.
        apex = np.where(is_low, z.argmin(axis=0), z.argmax(axis=0))
        corners = corners[:, (apex + np.arange(3)[:, None]) % 3, np.arange(len(rows))]
        ends = corners[:, 1:] - corners[:, :1]
        share = (levels[level] - corners[2, 0]) / ends[2]
        corners[:, 1:] = corners[:, :1] + share * ends
        corners[2, 1:] = levels[level]
        height = np.ptp(z, axis=0)
        sizes[4] = np.abs(weight) * np.minimum(1.0, 4.0 * shifts[level] / height)
        weight *= np.where(is_low, 1.0, -1.0) * share[0] * share[1]
        _add_sums(table, corners, weight, sizes, level)
    sizes = np.zeros((6, k))
    sizes[:5] = table[16:]
    summed = 2 * (whole + int(counts.sum()))
    sizes[5] = min(summed, PAIRWISE_SUM_ROUNDINGS + k + summed / TRIANGLES_PER_BLOCK)
    return table[:16] / DIVISORS[:, None], sizes


def _weights(corners: Array) -> tuple[Array, Array]:
    """Return (t,) doubled projected areas of (3, 3, t) corners (axis, corner, triangle), and (5, t)
    sizes: the first four of `_sums_below`, and a row of zeros.
    """
    edges = corners[:, 1:] - corners[:, :1]
    (ax, bx), (ay, by), (az, bz) = edges
    plus, minus = ax * by, ay * bx
    weight = plus - minus
    sizes = np.zeros((5, len(weight)))
    across = ay * bz - az * by, az * bx - ax * bz
    sizes[0] = np.sqrt(weight * weight + across[0] * across[0] + across[1] * across[1])
    sizes[1] = np.abs(plus) + np.abs(minus)
    np.add.reduce(np.abs(edges).reshape(6, -1), out=sizes[2])
    sizes[3] = 1.0
    return weight, sizes


def _add_sums(table: Array, corners: Array, weight: Array, sizes: Array, level: Index) -> None:
    """Add the sums over (3, 3, t) corners to rows 0 to 15 of the (21, k) table, and their (5, t)
    sizes to the other rows, in the columns of the (t,) ascending levels.

    weight: (t,) signed, doubled projected areas. The rows lack the factors DIVISORS.
    """
    rows = np.empty((21, len(weight)))
    rows[0] = weight
    weighted = corners * weight
    total = np.add.reduce(corners, axis=1)
    np.multiply(total, weight, rows[1:4])
    # (s_z + 2 z) u of each corner, and s_z s + 2 Q
    raised = corners * (total[2] + 2.0 * corners[2])
    tilted = total[2] * total + 2.0 * np.einsum("ct,dct->dt", corners[2], corners)
    row = 4
    for i in range(3):
        # Products of axis i with itself and the following ones, then the same times z.
        products = rows[row : row + 3 - i]
        products_by_z = rows[row + 6 : row + 9 - i]
        np.einsum("ct,dct->dt", weighted[i], corners[i:], out=products)
        products += rows[1 + i] * total[i:]
        np.einsum("ct,dct->dt", weighted[i], raised[i:], out=products_by_z)
        products_by_z += 0.5 * (rows[1 + i] * tilted[i:] + rows[1 + i : 4] * tilted[i])
        row += 3 - i
    rows[16:] = sizes
    starts = run_starts(level)
    table[:, level[starts]] += np.add.reduceat(rows, starts, axis=1)
