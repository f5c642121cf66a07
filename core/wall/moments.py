# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The moments of a wall to any order.

Both sides of a wall are polyhedra, joined by bilinear patches along the surface's boundary: its
moments follow from these boundaries. Compared with the polynomials of `walls`, which end at third
order, this loses digits, the more the thinner the wall; the error bounds include the loss.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..mesh import Surface, find_edges
from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, check_type, cross, gauss_legendre
from ..polyhedron import polyhedron_moments
from .walls import ORDER, OffsetSolid

NODES_PER_BLOCK = 1 << 14


def wall_moments(wall: OffsetSolid, inward: float, outward: float, order: int) -> Moments:
    """Return a wall's volume moments to any order, about the middle of the surface's box.

    Parameters
    ----------
    wall : OffsetSolid
        With its arrays: not from `drop_arrays`.
    inward, outward : float
        How far the wall reaches below the surface and above it.
    order : int

    Returns
    -------
    Moments
        Up to third order, the moments that `OffsetSolid.moments` returns.

    Raises
    ------
    ValueError
        If the wall folds over.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.wall import offset_solid, wall_moments
    >>> plate = offset_solid(Surface.from_triangles(np.eye(4, 3, -1), [[0, 1, 2]]))
    >>> round(wall_moments(plate, 0.0, 0.5, 6).about_point((0, 0, 0))[2, 0, 4] * 1920, 9)
    1.0
    """
    check_type("wall", wall, OffsetSolid)
    known = wall.moments(inward, outward)
    if order <= ORDER:
        return known.truncate(order)
    count = len(wall.points)
    closed = wall.surface(inward, outward)
    points = closed.points
    sides = Surface(points, closed.triangles[: 2 * len(wall.triangles)])
    moments = polyhedron_moments(sides, order, about=wall.about, allow_open=True)[0]
    start, stop = find_edges(wall.triangles).boundary_ends(wall.triangles)
    if len(start):
        corners = np.stack(
            [points[start], points[stop], points[stop + count], points[start + count]]
        )
        moments = moments + _strip_moments(corners - wall.about, wall.about, order)
    # The largest |x - about| by axis; the factor covers the rounding of the bound itself.
    reach = (wall.reach[0] + max(inward, outward) * wall.reach[1]) * (1.0 + 1e-9)
    largest = np.multiply.reduce(reach ** monomials(order), axis=1)
    rounded, moved = (
        sum(float(row @ s ** np.arange(4)) for s in (inward, outward))
        for row in (wall.swept_rounding, wall.swept_bound)
    )
    lower = len(known.raw)
    error = moments.rounding_error + rounded * largest
    return replace(
        moments,
        raw=np.concatenate([known.raw, moments.raw[lower:]]),
        rounding_error=np.concatenate([known.rounding_error, error[lower:]]),
        input_error=np.concatenate([known.input_error, moved * largest[lower:]]),
    )


def _strip_moments(corners: Array, about: Array, order: int) -> Moments:
    """Return moments of the cones from `about` over bilinear patches, (4, k, 3) corners relative to
    it, by an exact rule.

    A moment of degree n is the integral of x^α and the flux over the patch, divided by n + 3: a
    polynomial over the unit square, of degree order + 2 at most in each variable.
    """
    table = monomials(order)
    sums = np.zeros((2, len(table)))
    nodes, weights = gauss_legendre((order + 4) // 2)
    u, w = (grid.ravel() for grid in np.meshgrid(nodes, nodes))
    weight = np.multiply.outer(weights, weights).ravel()
    share = np.stack([(1 - u) * (1 - w), u * (1 - w), u * w, (1 - u) * w])
    along = np.stack([1 - w, w])
    across = np.stack([1 - u, u])
    step = max(1, NODES_PER_BLOCK // len(weight))
    for first in range(0, corners.shape[1], step):
        block = corners[:, first : first + step]
        # Differences of corners are rounded relative to the sides, which may be much shorter than
        # their distance.
        sides = block[[1, 2]] - block[[0, 3]]
        ends = block[[3, 2]] - block[[0, 1]]
        place, reach, tangent, other = (
            np.einsum("cn,cki->ikn", rows, vectors).reshape(3, -1)
            for rows, vectors in (
                (share, block),
                (share, np.abs(block)),
                (along, sides),
                (across, ends),
            )
        )
        flux = np.einsum("in,in->n", place, np.stack(cross(tangent, other)))
        mixed = (
            np.abs(tangent)[[1, 2, 0]] * np.abs(other)[[2, 0, 1]]
            + np.abs(tangent)[[2, 0, 1]] * np.abs(other)[[1, 2, 0]]
        )
        flux_size = np.einsum("in,in->n", reach, mixed)
        fluxes = np.stack([flux, flux_size]) * np.tile(weight, block.shape[1])
        factors = np.stack([place, reach])
        powers = np.ones((order + 1, 2, 3, place.shape[1]))
        for power in range(order):
            powers[power + 1] = powers[power] * factors
        for number, (p, q, r) in enumerate(table.tolist()):
            values = powers[p, :, 0] * powers[q, :, 1] * powers[r, :, 2]
            sums[:, number] += np.add.reduce(values * fluxes, axis=1)
    raw, size = sums / (table.sum(axis=1) + 3.0)
    # Roundings in units u: of the powers, of corners and flux, and of the sums.
    units = (8.0 * table.sum(axis=1) + 64.0 + corners.shape[1] * len(weight) / step) * U
    return Moments(raw, about, Measure.VOLUME, units * size)
