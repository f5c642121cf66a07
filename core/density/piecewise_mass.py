# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass moments with one density for each triangle: of solids by part, of sheets by face or by
vertex.

The moments of a triangle a, b, c have the generating function 1 / ((1 - a·t) (1 - b·t) (1 - c·t))
(Sheynin and Tuzikov, Pattern Recognition Letters 22, 2001). With h_α its coefficients and n = |α|,

    ∫ x^α over the cone on it from the reference point = det α! h_α / (n+3)!
    ∫ x^α over the triangle itself                     = 2 area α! h_α / (n+2)!

A density that is linear on the triangle is one more coordinate: with a' = (a, ρ_a) and so on, ∫ ρ
x^α over the triangle is 2 area α! h_(α,1) / (n+3)!. So it costs one order and no more, and is
exact.

Rounding is bounded as in `third_order`: determinants are off by at most 9 u reach·τ, doubled areas
by 9 u Σ τ, and the table adds no more than 9 roundings for each order and each corner to sums with
terms bounded by the terms for |x|.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..moments import factorial_ratios
from ..moments.raw import (
    FLOAT32_HALF_ULP,
    PAIRWISE_SUM_ROUNDINGS,
    Measure,
    Moments,
    U,
    monomial_count,
    monomial_index,
    monomials,
)
from ..numerics import Array, Integers, Mask, NDArray, sums_by_index
from ..solid import ClosedParts

TRIANGLES_PER_BLOCK = 4096  # triangles whose table of 20 monomials stays in the cache
MIN_TRIANGLES_PER_BLOCK = 64
CORNERS_PER_BLOCK = 1 << 16  # triangles whose corners are compared at a time


def _block_size(order: int) -> int:
    """Return the number of triangles whose table to an order stays in the cache."""
    return max(TRIANGLES_PER_BLOCK * 20 // monomial_count(order), MIN_TRIANGLES_PER_BLOCK)


def solid_mass_moments(
    points: NDArray, triangles: NDArray, density: NDArray, volume: Moments
) -> Moments:
    """Return ∫ ρ x^p y^q z^r dV for triangles (t, 3) with (t,) densities of their parts.

    volume: their volume moments, for the order, the reference point and the input error; the result
    has measure VOLUME as well.
    """
    order = volume.order
    sums, size, tau = _accumulate(points, triangles, density, volume, solid=True)
    reach = _reach(points, triangles, volume.about)
    raw = sums * factorial_ratios(monomials(order), 3)
    # α! h_α is at most (n+2)!/2 times the largest monomial, and over (n+3)! this is 1/(2n+6).
    error = (
        (9.0 * U * (reach @ tau) + _relative_rounding(len(triangles), order) * size)
        / (2.0 * monomials(order).sum(axis=1) + 6.0)
        * _monomial_bounds(reach, order)
    )
    return Moments(
        raw,
        volume.about,
        Measure.VOLUME,
        error + 8.0 * U * np.abs(raw),
        volume.input_error * float(density.max(initial=0.0)),
    )


def sheet_mass_moments(
    points: NDArray, triangles: NDArray, density: NDArray, area: Moments, stored: bool = False
) -> Moments:
    """Return ∫ ρ x^p y^q z^r dA, with densities (t,) of triangles, or (t, 3) of their corners,
    linear between them.

    No density may be negative. area: the sheet's area moments, for the order, the reference point
    and the input error; the result has measure AREA as well. stored: True if the densities were
    float32, which adds to `input_error`.
    """
    order = area.order
    sums, doubled_mass, tau = _accumulate(points, triangles, density, area, solid=False)
    reach = _reach(points, triangles, area.about)
    density_degree = density.ndim - 1
    raw = sums * factorial_ratios(monomials(order), 2 + density_degree)
    bounds = _monomial_bounds(reach, order)
    # α! h_α is at most (n+2)!/2 times the largest monomial, and over (n+2)! this is 1/2.
    size = doubled_mass / 2.0 * bounds
    error = 9.0 * U * tau.sum() / 2.0 * bounds + _relative_rounding(len(triangles), order) * size
    input_error = area.input_error * float(density.max(initial=0.0))
    if stored:
        input_error += FLOAT32_HALF_ULP * size
    return Moments(raw, area.about, Measure.AREA, error + 8.0 * U * np.abs(raw), input_error)


def _accumulate(
    points: NDArray, triangles: NDArray, density: NDArray, like: Moments, solid: bool
) -> tuple[Array, float, Array]:
    """Return (K,) Σ ρ h weight, Σ ρ |weight| and (3,) Σ ρ τ.

    The weights of triangles are determinants or, for sheets, doubled areas; τ are the sums of the
    two magnitudes whose difference is a component of the normal. like: its order and reference
    point are used.
    """
    order = like.order
    step = _block_size(order)
    series = _complete_homogeneous if density.ndim == 1 else _with_linear_density
    block_sums = [np.zeros(monomial_count(order))]
    size = 0.0
    tau = np.zeros(3)
    columns = [np.ascontiguousarray(column, np.float64) for column in points.T]
    for start in range(0, len(triangles), step):
        corner_indices = np.ascontiguousarray(triangles[start : start + step].T, np.intp)
        block_density = density[start : start + step]
        corners = np.array([column.take(corner_indices) for column in columns])  # (axis, corner, k)
        (ax, bx, cx), (ay, by, cy), (az, bz, cz) = corners
        ux = bx - ax
        uy = by - ay
        uz = bz - az
        vx = cx - ax
        vy = cy - ay
        vz = cz - az
        # The components of the normal (b - a) × (c - a), as pairs to be subtracted.
        products = ((uy * vz, uz * vy), (uz * vx, ux * vz), (ux * vy, uy * vx))
        normal = np.array([plus - minus for plus, minus in products])
        corners -= like.about[:, None, None]
        mean = block_density if block_density.ndim == 1 else block_density.sum(axis=1) / 3.0
        if solid:
            weight = (normal * corners[:, 0]).sum(axis=0)
        else:
            weight = np.sqrt((normal * normal).sum(axis=0))
        size += float(np.abs(weight) @ mean)
        tau += [float((np.abs(plus) + np.abs(minus)) @ mean) for plus, minus in products]
        block_sums.append(np.add.reduce(series(corners, block_density.T, order) * weight, axis=1))
    return np.add.reduce(np.array(block_sums)), size, tau


def _complete_homogeneous(corners: NDArray, density: NDArray, order: int) -> Array:
    """Return (K, k) ρ h_α of each triangle with corners (3 axes, 3 corners, k)."""
    table = np.zeros((monomial_count(order), corners.shape[2]))
    table[0] = density
    for corner in range(3):
        _multiply_by_geometric_series(table, corners[:, corner], order)
    return table


def _with_linear_density(corners: NDArray, density: NDArray, order: int) -> Array:
    """Return (K, k) h_(α,1) of each triangle with corners (3 axes, 3 corners, k) of density (3
    corners, k).
    """
    table, linear = np.zeros((2, monomial_count(order), corners.shape[2]))
    table[0] = 1.0
    for corner in range(3):
        _multiply_by_geometric_series(table, corners[:, corner], order)
        linear += table * density[corner]
        # 1/(1 - v·t - ρ s): the part linear in s is the former one plus ρ times the whole, then
        # divided by (1 - v·t).
        _multiply_by_geometric_series(linear, corners[:, corner], order)
    return linear


def _multiply_by_geometric_series(table: NDArray, vertex: NDArray, order: int) -> None:
    """Multiply the series in `table`, (K, k), by 1 / (1 - v·t) in place; (3, k) vertices."""
    # The rows ascend in degree, so that each adds rows that are multiplied already.
    for row, (p, q, r) in enumerate(monomials(order).tolist()):
        for axis, lower in enumerate(((p - 1, q, r), (p, q - 1, r), (p, q, r - 1))):
            if lower[axis] >= 0:
                table[row] += vertex[axis] * table[monomial_index(*lower)]


def _reach(points: NDArray, triangles: NDArray, center: NDArray) -> Array:
    """Return the (3,) largest distances of a corner from the reference point along each axis."""
    reach = np.zeros(3)
    for start in range(0, len(triangles), CORNERS_PER_BLOCK):
        for axis in range(3):
            part = points[:, axis].take(triangles[start : start + CORNERS_PER_BLOCK].ravel())
            reach[axis] = max(reach[axis], np.abs(part.astype(np.float64) - center[axis]).max())
    return reach * (1.0 + 4.0 * U)


def _relative_rounding(count: int, order: int) -> Array:
    """Return the (K,) rounding errors relative to the sum of the terms' sizes; 27 are the 9 of the
    module for each of three corners.
    """
    return U * (
        27.0 * (monomials(order).sum(axis=1) + 1)
        + PAIRWISE_SUM_ROUNDINGS
        + count / _block_size(order)
        + 2.0
    )


def _monomial_bounds(reach: NDArray, order: int) -> Array:
    """Return the (K,) largest values of the monomials within reach."""
    return np.multiply.reduce(reach ** monomials(order), axis=1)


def to_mass_moments(moments: Moments, factor: float = 1.0) -> Moments:
    """Return density-weighted moments, already transformed, as mass moments; factor: a sheet's
    thickness.
    """
    return replace(moments, measure=Measure.MASS) * factor


@dataclass(frozen=True, eq=False)
class PartDensities:
    """Densities of parts by the densities of their faces, as arrays with an entry for each part.

    density: of a cavity, that of the part that it is cut from, whatever material its own faces
    have. has_several_materials: the part is no cavity, and its faces differ in density.
    has_foreign_cavity_material: the part is a cavity with a face of another density than the part
    that it is cut from. first_face: a part's first mesh face, -1 if it has none. range_by_area,
    most_by_area: the range of its faces' densities, and the largest density, times the part's area.
    """

    density: Array
    has_several_materials: Mask
    has_foreign_cavity_material: Mask
    first_face: Integers
    range_by_area: Array
    most_by_area: Array


def part_densities(
    parts: ClosedParts, face_density: Array, linear: NDArray | None = None
) -> PartDensities:
    """Return one density for each part: the mean of the (f,) face densities by area under the
    linear map.
    """
    from_mesh = parts.face >= 0  # all triangles but those of caps
    part = parts.part[from_mesh]
    face = parts.face[from_mesh]
    density = face_density[face]
    area = parts.areas(linear)[from_mesh]
    first = np.full(parts.number, np.iinfo(np.int64).max)
    least = np.full(parts.number, np.inf)
    most = np.full(parts.number, -np.inf)
    np.minimum.at(first, part, face)
    np.minimum.at(least, part, density)
    np.maximum.at(most, part, density)
    has_face = np.bincount(part, minlength=parts.number) > 0
    least = np.where(has_face, least, 0.0)
    most = np.where(has_face, most, 0.0)
    total_area = sums_by_index(part, area, parts.number)
    mean = np.divide(
        sums_by_index(part, area * density, parts.number),
        total_area,
        out=(least + most) / 2.0,
        where=total_area > 0.0,
    )
    differs = most > least
    own_density = np.where(differs, np.clip(mean, least, most), least)
    host_density = own_density[parts.host_part]
    is_cavity = parts.host_part != np.arange(parts.number)
    return PartDensities(
        host_density,
        has_several_materials=differs & ~is_cavity,
        has_foreign_cavity_material=is_cavity
        & has_face
        & (differs | (own_density != host_density)),
        first_face=np.where(has_face, first, -1),
        range_by_area=(most - least) * total_area,
        most_by_area=most * total_area,
    )
