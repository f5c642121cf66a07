# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Area moments of a plane region to any order, as `Moments` with third coordinate zero.

So they shift, turn, add and are normalized like those of bodies. Beside the rounding of the integration, which
`n_dimensions` bounds, a region's points may be off: an edge of length l whose ends move by at most d
sweeps over at most d (l + 2 d), and there |x| and |y| exceed those of the ends by at most d.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.exponents import monomial_count, monomial_index
from ..moments.moments import Measure, Moments
from ..polyhedron.n_dimensions import multi_indices
from ..verdict.finding import MeasureError
from .findings import SECTION_ENCLOSES_NOTHING
from .polygon import area_moments, edge_arrays

BOUND_ROUNDING = 1.0 + 1e-9  # The sums that make a bound are rounded themselves.
EDGES_PER_BLOCK = 4096


@lru_cache
def plane_positions(order: int) -> NDArray[np.int64]:
    """Return the (k,) positions of x^p y^q among `monomials`, in the order of `multi_indices`; read-only."""
    p, q = multi_indices(2, order).T
    positions = monomial_index(p, q, np.zeros_like(p))
    positions.flags.writeable = False
    return positions


def region_moments(
    points: ArrayLike,
    edges: ArrayLike,
    order: int,
    about: ArrayLike | None = None,
    rounded: float = 0.0,
    stored: float = 0.0,
) -> Moments:
    """Return ∫ x^p y^q dA of the region to the left of directed edges, for all p + q ≤ order, with error bounds.

    The moments are about the centroid, up to rounding, unless `about` is given.

    Parameters
    ----------
    points : (n, 2) array_like
    edges : (m, 2) array_like of int
        Closed: at every point as many edges end as start.
    order : int
    about : (2,) array_like, optional
        The reference point.
    rounded : float
        Largest displacement of each coordinate of the points by rounding.
    stored : float
        Largest displacement of each coordinate by storing the points as float32.

    Returns
    -------
    Moments
        Area moments about (x, y, 0); those with a power of z are zero.

    Raises
    ------
    MeasureError
        If the edges do not close, or enclose no area.

    Notes
    -----
    Zhang and Chen (2001), eqs. 3 and 9, by Sheynin and Tuzikov's formula in two dimensions.

    Examples
    --------
    >>> from body_moments.core.flat import directed_edges, region_moments
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    >>> moments = region_moments(square, directed_edges([range(4)]), 4)
    >>> moments.total, moments.about.tolist(), round(moments[2, 2, 0] * 9, 9)
    (4.0, [1.0, 1.0, 0.0], 4.0)
    """
    points, edges = edge_arrays(points, edges)
    if about is None:
        first = area_moments(points, edges, 1)
        bounds = first.rounding_error + _swept(points, edges, first.about, rounded, 1)
        if not abs(first.raw[0]) > bounds[0]:
            raise MeasureError(SECTION_ENCLOSES_NOTHING)
        about = first.about + first.raw[1:] / first.raw[0]
    flat = area_moments(points, edges, order, about)
    positions = plane_positions(order)
    raw, rounding, moved = np.zeros((3, monomial_count(order)))
    raw[positions] = flat.raw
    rounding[positions] = flat.rounding_error + _swept(points, edges, flat.about, rounded, order)
    moved[positions] = _swept(points, edges, flat.about, stored, order)
    return Moments(raw, np.append(flat.about, 0.0), Measure.AREA, rounding, moved)


def _swept(points: NDArray, edges: NDArray, about: NDArray, step: float, order: int) -> NDArray[np.float64]:
    """Return (k,) bounds of the changes of moments if every coordinate of every point moves by `step`."""
    total = np.zeros(len(multi_indices(2, order)))
    if not step > 0.0:
        return total
    p, q = multi_indices(2, order).T
    way = step * np.sqrt(2.0)
    for start in range(0, len(edges), EDGES_PER_BLOCK):
        a, b = (points[edges[start : start + EDGES_PER_BLOCK, i]] - about for i in (0, 1))
        area = way * (np.hypot(*(b - a).T) + 2.0 * way)
        far = np.maximum(np.abs(a), np.abs(b)) + way
        x, y = (np.vander(column, order + 1, increasing=True).T for column in far.T)
        total += (area * x[p] * y[q]).sum(axis=1)
    return BOUND_ROUNDING * total
