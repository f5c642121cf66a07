# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplices in n dimensions: the facets around full ones, and a test that facets close."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.arguments import check_filled, float_array, index_array


def facets_of(points: ArrayLike, simplices: ArrayLike) -> tuple[NDArray[np.integer], NDArray[np.float64]]:
    """Return the facets around full simplices, with signs that make the enclosed volume positive.

    Parameters
    ----------
    points : (m, n) array_like
    simplices : (k, n + 1) array_like of int

    Returns
    -------
    facets : ((n + 1) k, n) int array
    signs : ((n + 1) k,) array
        1 or -1, for `enclosed_moments`.

    Examples
    --------
    >>> from body_moments.core.polyhedron import enclosed_moments, facets_of
    >>> points = [[0, 0], [1, 0], [0, 1]]
    >>> facets, signs = facets_of(points, [[0, 2, 1]])
    >>> round(enclosed_moments(points, facets, 0, signs=signs)[0, 0], 12)
    0.5
    """
    points, simplices = simplex_arrays(points, simplices, 1)
    corners = points[simplices]
    turned = np.sign(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    count = simplices.shape[1]
    facets = [np.delete(simplices, k, axis=1) for k in range(count)]
    signs = [turned * (-1.0) ** k for k in range(count)]
    return np.concatenate(facets), np.concatenate(signs)


def simplex_arrays(
    points: ArrayLike, simplices: ArrayLike, more: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.integer]]:
    """Return (m, n) points and (k, n + `more`) simplices as arrays."""
    points = float_array("points", points, "m", "n")
    check_filled("points", points.T)
    return points, index_array("simplices", simplices, "k", points.shape[1] + more, count=len(points))


def closes(points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None = None) -> bool:
    """Return whether every ridge is used as often one way as the other. Points at the same place are one."""
    _, corners, parity = _sorted_corners(points, simplices, signs)
    if not len(corners):
        return True
    ridges = np.concatenate([np.delete(corners, k, axis=1) for k in range(corners.shape[1])])
    uses = np.concatenate([parity * (-1.0) ** k for k in range(corners.shape[1])])
    _, which = np.unique(ridges, axis=0, return_inverse=True)
    return not np.bincount(which.reshape(-1), uses).any()


def outer_facets(points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None = None) -> NDArray[np.intp]:
    """Return the (j, n) facets that bound simplices on one side only; a pair of opposite facets cancels."""
    facets, corners, parity = _sorted_corners(points, simplices, signs)
    _, first, which = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    uses = np.abs(np.bincount(which.reshape(-1), parity, len(first))).astype(np.intp)
    return facets[np.repeat(first, uses)]


def _sorted_corners(
    points: ArrayLike, simplices: ArrayLike, signs: ArrayLike | None
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Return the facets with an extent, their sorted corners, points of a place as one, and orientations, 1 or -1."""
    simplices = np.asarray(simplices)
    _, place = np.unique(np.asarray(points, np.float64) + 0.0, axis=0, return_inverse=True)
    corners = place.reshape(-1)[simplices]
    signs = np.ones(len(corners)) if signs is None else np.asarray(signs, np.float64)
    order = np.argsort(corners, axis=1)
    parity = signs.copy()
    for first in range(order.shape[1]):
        for second in range(first + 1, order.shape[1]):
            parity[order[:, first] > order[:, second]] *= -1.0
    corners = np.take_along_axis(corners, order, 1)
    solid = (np.diff(corners, axis=1) > 0).all(axis=1)  # the others have no extent
    return simplices[solid], corners[solid], parity[solid]
