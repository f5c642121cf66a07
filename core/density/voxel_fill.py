# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A closed surface filled with the density of a grid of voxels, each of constant density: exact but
for rounding.

By the divergence theorem along z, with F_r the antiderivative of ρ z^r that is zero below the grid,

    ∫ ρ x^p y^q z^r dV = ∮ x^p y^q F_r(x, y, z) n_z dA.

The triangles are cut along the planes between the voxels. On each piece F_r is then a polynomial, a
sum over the voxels below plus the filled part of the piece's voxel, and Gauss's rule integrates it
exactly.
"""

from __future__ import annotations

import math

import numpy as np

from ..moments.raw import Measure, Moments, U, monomial_count, monomials
from ..numerics import Array, ArrayLike, NDArray, batches, float_array, power_table, triangle_rule
from ..verdict import NO_FACES, MeasureError
from .findings import DENSITY_NON_FINITE

PIECES_PER_BATCH = 1 << 17  # Expected pieces of the triangles taken at a time.
MAX_VOXELS = 1 << 27  # voxels of the box around the surface


def inside_moments(
    triangles: ArrayLike, densities: ArrayLike, order: int = 3
) -> tuple[Moments, float]:
    """Return the mass moments of a closed surface filled with a grid of voxels, and the volume of
    the body within the grid, in voxels.

    The moments are about the middle of the bounding box within the grid, rounded to a corner of
    voxels. triangles: (n, 3, 3) corners, counter-clockwise from outside, closed together, in the
    grid's coordinates: the voxel (i, j, k) is the cube from (i, j, k) to (i+1, j+1, k+1).
    densities: (nx, ny, nz), 0 outside. `rounding_error` estimates the rounding from the sizes of
    all terms; nothing else is approximate. MeasureError if a density is not finite.
    """
    triangles = float_array("triangles", triangles, "n", 3, 3, finite=True)
    if not len(triangles):
        raise MeasureError(NO_FACES)
    with np.errstate(invalid="ignore"):  # Signaling NaN would warn.
        densities = float_array("densities", densities, "nx", "ny", "nz")
    if not np.isfinite(densities).all():
        raise MeasureError(DENSITY_NON_FINITE)
    shape = np.array(densities.shape)
    about = np.round(
        np.clip((triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1))) / 2.0, 0, shape)
    )
    total, size = np.zeros((2, monomial_count(order)))
    below = _sums_below(densities, about[2], order)
    volume = 0.0
    longest_sum = 0
    spans = np.minimum(np.ptp(triangles, axis=1), shape) + 1.0
    expected_pieces = (spans * np.roll(spans, -1, axis=1)).sum(axis=1)
    for batch in batches(expected_pieces, PIECES_PER_BATCH):
        pieces = _cut_at_voxels(triangles[batch], shape)
        centers = pieces.mean(axis=1)
        # No column of the grid ends at the other pieces.
        in_columns = ((centers[:, :2] > 0) & (centers[:, :2] < shape[:2])).all(axis=1) & (
            centers[:, 2] > 0
        )
        pieces = pieces[in_columns]
        voxels = np.minimum(centers[in_columns].astype(np.int64), shape - 1)
        volume += _add_pieces(pieces, voxels, densities, below, about, total, size)
        longest_sum = max(longest_sum, len(pieces))
    # Roundings of a term, by its order, of sums along a column and of pairwise sums; 40 is chosen.
    units = 40 + 4 * order + int(shape[2]) + int(math.log2(longest_sum + 1))
    return Moments(total, about, Measure.MASS, units * U * size), volume


def _add_pieces(
    pieces: NDArray,
    voxels: NDArray,
    densities: NDArray,
    below: list[Array],
    about: NDArray,
    total: NDArray,
    size: NDArray,
) -> float:
    """Add the mass moments of the columns below (m, 3, 3) pieces to (K,) `total`, and their
    magnitudes to (K,) `size`; return the volume of the columns.

    voxels: (m, 3) indices of the voxels that the pieces are in, for pieces above the grid those of
    the topmost ones. below: as `_sums_below` returns.
    """
    order = len(below) - 1
    exponents = monomials(order).tolist()
    nodes, weights = triangle_rule((order + 3) // 2)  # exact to order + 1
    a, b, c = pieces.transpose(1, 2, 0)
    doubled_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])  # seen along z
    i, j, k = voxels.T
    voxel_density = densities[i, j, k]
    floor = k - about[2]
    full = [sums[i, j, k] for sums in below]
    volume = 0.0
    for (u, v, w), weight in zip(nodes.T, weights):
        x, y, z = u * a + v * b + w * c
        z = np.clip(z, k, k + 1.0)  # Below pieces above the grid, the whole column is filled.
        volume += float((doubled_area * weight) @ z)
        x_powers = power_table(x - about[0], order)
        y_powers = power_table(y - about[1], order)
        top = z - about[2]
        columns = [
            sums + voxel_density * (top ** (r + 1) - floor ** (r + 1)) / (r + 1)
            for r, sums in enumerate(full)
        ]
        for n, (p, q, r) in enumerate(exponents):
            term = doubled_area * weight * x_powers[p] * y_powers[q] * columns[r]
            total[n] += term.sum()
            size[n] += np.abs(term).sum()
    return volume


def _sums_below(densities: NDArray, center: float, order: int) -> list[Array]:
    """Return for each power r the (nx, ny, nz) integrals of ρ (z - center)^r over the voxels below
    each voxel.
    """
    z = np.arange(densities.shape[2] + 1) - center
    sums = []
    for r in range(order + 1):
        integrals = densities * (np.diff(z ** (r + 1)) / (r + 1))
        np.cumsum(integrals, axis=2, out=integrals)
        integrals[:, :, 1:] = integrals[:, :, :-1].copy()
        integrals[:, :, 0] = 0.0
        sums.append(integrals)
    return sums


def _cut_at_voxels(triangles: NDArray, shape: NDArray) -> Array:
    """Return the (m, 3, 3) pieces of triangles, cut along every plane between voxels and along the
    sides of the grid.
    """
    pieces = triangles
    for axis in range(3):
        uncut = [pieces[:0]]
        while len(pieces):
            low = pieces[:, :, axis].min(axis=1)
            high = pieces[:, :, axis].max(axis=1)
            # The planes strictly between. Cut at the middle one first, so that rounds are few.
            first = np.maximum(np.floor(low) + 1.0, 0.0)
            last = np.minimum(np.ceil(high) - 1.0, float(shape[axis]))
            is_cut = first <= last
            uncut.append(pieces[~is_cut])
            plane = np.floor((first + last) / 2.0)[is_cut]
            pieces = _split_triangles(pieces[is_cut], axis, plane)
        pieces = np.concatenate(uncut)
    return pieces


def _split_triangles(triangles: NDArray, axis: int, plane: NDArray) -> Array:
    """Cut each triangle by the plane through it into three; fewer if a corner is on the plane.

    plane: (n,) coordinates along the axis.
    """
    is_above = triangles[:, :, axis] > plane[:, None]
    # a is the corner that has a side of the plane to itself.
    alone = np.where(is_above.sum(axis=1) == 1, is_above.argmax(axis=1), (~is_above).argmax(axis=1))
    index = np.arange(len(triangles))
    a, b, c = (triangles[index, (alone + turn) % 3] for turn in range(3))

    def crossing(end: NDArray) -> NDArray:
        """Return the points of the plane on the edges from a."""
        share = (plane - a[:, axis]) / (end[:, axis] - a[:, axis])
        point = a + share[:, None] * (end - a)
        point[:, axis] = plane
        return point

    ab, ac = crossing(b), crossing(c)
    pieces = np.concatenate(
        [np.stack(corners, axis=1) for corners in ((a, ab, ac), (ab, b, c), (ab, c, ac))]
    )
    normals = np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0])
    return pieces[(normals != 0.0).any(axis=1)]
