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

from ..moments.raw import Measure, Moments, U, monomials
from ..numerics import Array, ArrayLike, NDArray, batches, float_array, power_table, triangle_rule
from ..verdict import NO_FACES, MeasureError
from .findings import DENSITY_NON_FINITE

PIECES_PER_BATCH = 1 << 17  # Expected pieces of the triangles taken at a time.
MAX_VOXELS = 1 << 27  # voxels of the box around the surface


def inside_moments(
    triangles: ArrayLike, densities: ArrayLike, order: int = 3
) -> tuple[Moments, float]:
    """Return the mass moments of a closed surface filled with a grid of voxels, and the volume of
    the body in the grid.

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
    exponents = monomials(order)
    total, size = np.zeros((2, len(exponents)))
    below = _sums_below(densities, about[2], order)
    nodes, weights = triangle_rule((order + 3) // 2)  # exact to order + 1
    volume, terms = 0.0, 0
    spans = np.minimum(np.ptp(triangles, axis=1), shape) + 1.0
    expected = spans[:, 0] * spans[:, 1] + spans[:, 1] * spans[:, 2] + spans[:, 2] * spans[:, 0]
    for part in batches(expected, PIECES_PER_BATCH):
        pieces = _cut_at_voxels(triangles[part], shape)
        centers = pieces.mean(axis=1)
        inside = ((centers[:, :2] > 0) & (centers[:, :2] < shape[:2])).all(axis=1) & (
            centers[:, 2] > 0
        )
        pieces, centers = pieces[inside], centers[inside]
        if not len(pieces):
            continue
        a, b, c = pieces.transpose(1, 2, 0)
        double = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        i, j, k = np.minimum(centers.astype(np.int64), shape - 1).T
        voxel_density = densities[i, j, k]
        corner = k - about[2]
        filled = [sums[i, j, k] for sums in below]
        for (u, v, w), weight in zip(nodes.T, weights):
            x, y, z = u * a + v * b + w * c
            z = np.clip(z, k, k + 1.0)  # above the grid its whole column is filled
            volume += float((double * weight) @ z)
            x = x - about[0]
            y = y - about[1]
            z = z - about[2]
            columns = [
                sums + voxel_density * (z ** (r + 1) - corner ** (r + 1)) / (r + 1)
                for r, sums in enumerate(filled)
            ]
            xs = power_table(x, order)
            ys = power_table(y, order)
            for n, (p, q, r) in enumerate(exponents.tolist()):
                term = double * weight * xs[p] * ys[q] * columns[r]
                total[n] += term.sum()
                size[n] += np.abs(term).sum()
        terms = max(terms, len(pieces))
    units = 40 + 4 * order + int(shape[2]) + int(math.log2(terms + 1))
    return Moments(total, about, Measure.MASS, units * U * size), volume


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
    """Return the (m, 3, 3) triangles cut along every plane between voxels, and along the sides of
    the grid.
    """
    for axis in range(3):
        done = [triangles[:0]]
        while len(triangles):
            low = triangles[:, :, axis].min(axis=1)
            high = triangles[:, :, axis].max(axis=1)
            first = np.maximum(np.floor(low) + 1.0, 0.0)  # the planes strictly between
            last = np.minimum(np.ceil(high) - 1.0, float(shape[axis]))
            across = first <= last
            done.append(triangles[~across])
            plane = np.floor((first + last) / 2.0)[across]
            triangles = _split_triangles(triangles[across], axis, plane)
        triangles = np.concatenate(done)
    return triangles


def _split_triangles(triangles: NDArray, axis: int, plane: NDArray) -> Array:
    """Cut each triangle by the plane through it into three; fewer if a corner is on the plane."""
    side = triangles[:, :, axis] > plane[:, None]
    alone = np.where(side.sum(axis=1) == 1, side.argmax(axis=1), (~side).argmax(axis=1))
    index = np.arange(len(triangles))
    a, b, c = (triangles[index, (alone + turn) % 3] for turn in range(3))

    def crossing(end: NDArray) -> NDArray:
        share = (plane - a[:, axis]) / (end[:, axis] - a[:, axis])
        point = a + share[:, None] * (end - a)
        point[:, axis] = plane
        return point

    ab, ac = crossing(b), crossing(c)
    pieces = np.concatenate(
        [np.stack(corners, axis=1) for corners in ((a, ab, ac), (ab, b, c), (ab, c, ac))]
    )
    doubled = np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0])
    return pieces[(doubled != 0.0).any(axis=1)]
