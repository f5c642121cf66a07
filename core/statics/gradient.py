# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of moments to second order by every vertex, in one pass.

A vertex that moves by δ carries its surface with it by λ δ, λ its barycentric coordinate, and the flow through the
surface is the change of the body (Reynolds): with N = (b-a) × (c-a) of each triangle around the vertex v,

    ∂/∂v ∫ f dV = Σ N ∫ f λ_v,   the integral over the unit triangle: f = 1: 1/6;   x: (s + x_v) / 24;
    x x': (s s' + q + x_v s' + s x_v' + 2 x_v x_v') / 120,   s = x_a + x_b + x_c,   q = x_a x_a' + x_b x_b' + x_c x_c'.

It holds for closed surfaces; of the sum over cones it is the derivative there, and needs no reference point. An area's
moment is |N| m, m the mean of f over the triangle times 1/2; ∂|N|/∂a = (b - c) × n with n = N / |N|.

About the body's own center, first moments vanish, so that center and inertia follow from these with no term more:
∂center = ∂first / volume, ∂(central second) = ∂second.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh.surface import Surface
from ..moments.moments import SECOND_MOMENT_INDEX, Measure, U, monomial_count, monomial_index, monomials
from ..numerics.arguments import check_type, float_array
from ..numerics.vectors import cross

TRIANGLES_PER_BLOCK = 65536  # triangles at a time
PAIRS = [(i, j) for i in range(3) for j in range(i, 3)]


@dataclass(frozen=True, eq=False)
class Gradient:
    """Derivatives of moments by every vertex.

    Attributes
    ----------
    by_vertex : (n, K, 3) array
        ∂ raw[α] / ∂ vertex, in the order of `monomials`; unit of the moment per length.
    about : (3,) array
        The fixed point that the moments are about.
    measure : Measure
        Volume or area.
    scale : (n,) array
        Upper bound of the sum over the triangles at a vertex, for the integrand one.
    reach : (3,) array
        Of the points from `about`.
    valence : int
        The most triangles at one vertex.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import volume_gradient
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> gradient = volume_gradient(surface, np.full(3, 0.25), order=1)
    >>> np.round(gradient.center(1 / 6).sum(axis=0), 9).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """

    by_vertex: NDArray[np.float64]
    about: NDArray[np.float64]
    measure: Measure
    scale: NDArray[np.float64]
    reach: NDArray[np.float64]
    valence: int

    def error(self) -> NDArray[np.float64]:
        """Return (n, K) bounds of the rounding of each component."""
        exponents = monomials(2)[: self.by_vertex.shape[1]]
        sizes = np.multiply.reduce(self.reach**exponents, axis=1)
        if self.measure == Measure.AREA:  # |N| ∂m has one power of the reach less and one of the sides more
            for axis, step in enumerate(np.eye(3)):
                lower = np.multiply.reduce(self.reach ** np.maximum(exponents - step, 0), axis=1)
                sizes = sizes + exponents[:, axis] * lower * 2.0 * self.reach.max()
        return self.scale[:, None] * (32.0 + 8.0 * exponents.sum(axis=1) + self.valence) * U * sizes

    def center(self, total: float) -> NDArray[np.float64]:
        """Return ∂ center[i] / ∂ vertex[k], (n, 3, 3).

        `about` must be the center, `total` the volume or area.
        """
        return self.by_vertex[:, 1:4] / total

    def inertia(self) -> NDArray[np.float64]:
        """Return the derivative of the tensor about the center, (n, 3, 3, 3), of unit density.

        `about` must be the center.
        """
        second = self.by_vertex[:, SECOND_MOMENT_INDEX]
        trace = np.einsum("niik->nk", second)
        return np.eye(3)[None, :, :, None] * trace[:, None, None] - second


def volume_gradient(surface: Surface, about: ArrayLike, order: int = 2) -> Gradient:
    """Return the derivatives of the volume's moments by every vertex.

    Parameters
    ----------
    surface : Surface
        Closed and outward: of any other the result is the derivative of no volume.
    about : (3,) array_like
        The fixed point that the moments are about.
    order : int
        1 or 2.

    Returns
    -------
    Gradient

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import volume_gradient
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> np.round(volume_gradient(surface, np.zeros(3), order=1).by_vertex[3, 0] * 6, 9).tolist()
    [0.0, 0.0, 1.0]
    """
    return _gradient(surface, about, order, _volume_shares)


def area_gradient(surface: Surface, about: ArrayLike, order: int = 2) -> Gradient:
    """Return the derivatives of the area's moments by every vertex.

    Parameters
    ----------
    surface : Surface
        A triangle without area has no derivative; the area that its vertices could give it is left out.
    about : (3,) array_like
        The fixed point that the moments are about.
    order : int
        1 or 2.

    Returns
    -------
    Gradient

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import area_gradient
    >>> triangle = Surface.from_triangles(np.eye(4, 3, -1), [[0, 1, 2]])
    >>> area_gradient(triangle, np.zeros(3), order=1).by_vertex[2, 0].tolist()
    [0.0, 0.5, 0.0]
    """
    return _gradient(surface, about, order, _area_shares)


def _gradient(surface: Surface, about: ArrayLike, order: int, shares: Callable) -> Gradient:
    area, kinds = shares is _area_shares, monomial_count(order)
    check_type("surface", surface, Surface)
    about = float_array("about", about, 3)
    points = surface.points.astype(np.float64)
    triangles, _ = surface.all_triangles()
    out, scale = np.zeros((3 * kinds, len(points))), np.zeros(len(points))
    valence = int(np.bincount(triangles.ravel(), minlength=1).max())
    for start in range(0, len(triangles), TRIANGLES_PER_BLOCK):
        part = triangles[start : start + TRIANGLES_PER_BLOCK].astype(np.intp)
        low = int(part.min())
        place, count = part - low, int(part.max()) - low + 1
        corners = points[part].transpose(1, 2, 0)  # corner, axis, triangle
        edges = (corners[1] - corners[0], corners[2] - corners[0])
        normal = np.stack(cross(*edges))
        size = np.sqrt(np.maximum.reduce([np.einsum("im,im->m", edge, edge) for edge in edges]))
        corner_shares = shares(corners, corners - about[:, None], normal, kinds)
        bound = size * size
        if area:  # a normal's direction is the less certain the thinner its triangle
            double = np.sqrt(np.einsum("im,im->m", normal, normal))
            bound = 2.0 * size * np.maximum(1.0, bound / np.where(double > 0.0, double, bound + 1.0))
        for vertex, values in zip(place.T, corner_shares):
            for row, target in zip(values.reshape(3 * kinds, -1), out):
                target[low : low + count] += np.bincount(vertex, row, count)
            scale[low : low + count] += np.bincount(vertex, bound, count)
    reach = np.abs(points - about).max(axis=0, initial=0.0)
    by_vertex = out.reshape(kinds, 3, -1).transpose(2, 0, 1)
    return Gradient(by_vertex, about, Measure.AREA if area else Measure.VOLUME, scale, reach, valence)


def _volume_shares(corners: NDArray, local: NDArray, normal: NDArray, kinds: int) -> Iterator[NDArray]:
    """Yield for each corner the (K, 3, m) that its triangles add.

    local: (3, 3, m) corners from the reference point.
    """
    total = local[0] + local[1] + local[2]
    pairs = PAIRS if kinds > 4 else []
    square = {(i, j): np.einsum("km,km->m", local[:, i], local[:, j]) + total[i] * total[j] for i, j in pairs}
    for corner in local:
        weights = np.empty((kinds, normal.shape[1]))
        weights[0] = 1.0 / 6.0
        weights[1:4] = (total + corner) / 24.0
        for i, j in pairs:
            weights[SECOND_MOMENT_INDEX[i, j]] = (
                square[i, j] + corner[i] * total[j] + total[i] * corner[j] + 2.0 * corner[i] * corner[j]
            ) / 120.0
        yield weights[:, None] * normal


def _area_shares(corners: NDArray, local: NDArray, normal: NDArray, kinds: int) -> Iterator[NDArray]:
    """Yield the shares as `_volume_shares`, of areas."""
    double = np.sqrt(np.einsum("im,im->m", normal, normal))
    unit = normal / np.where(double > 0.0, double, 1.0)
    total = local[0] + local[1] + local[2]
    pairs = PAIRS if kinds > 4 else []
    mean = np.empty((kinds, len(double)))
    mean[0] = 0.5
    mean[1:4] = total / 6.0
    for i, j in pairs:
        mean[SECOND_MOMENT_INDEX[i, j]] = (np.einsum("km,km->m", local[:, i], local[:, j]) + total[i] * total[j]) / 24.0
    for k, corner in enumerate(local):
        turn = cross(corners[(k + 1) % 3] - corners[(k + 2) % 3], unit)
        values = mean[:, None] * np.stack(turn)
        for i in range(3):
            values[monomial_index(*np.eye(3, dtype=int)[i]), i] += double / 6.0
        for i, j in pairs:
            row = values[SECOND_MOMENT_INDEX[i, j]]
            row[i] += double * (total[j] + corner[j]) / 24.0
            row[j] += double * (total[i] + corner[i]) / 24.0
        yield values
