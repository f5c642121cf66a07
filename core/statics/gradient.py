# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of the zeroth, first and second moments by every vertex, in one pass.

A vertex that moves by δ carries its surface with it by λ δ, λ its barycentric coordinate, and the
flow through the surface is the change of the body (Reynolds): with N = (b-a) × (c-a) of each
triangle around the vertex v,

    ∂/∂v ∫ f dV = Σ N ∫ f λ_v,

the integral over the unit triangle, with s = Σ x,

    f = 1: 1/6;   x: (s + x_v) / 24;   xy: (s_x s_y + Σ xy + s_x y_v + x_v s_y + 2 x_v y_v) / 120.

It holds for closed surfaces; of the sum over cones it is the derivative there, and needs no
reference point. An area's moment is |N| m, m the mean of f over the triangle times 1/2; ∂|N|/∂a =
(b - c) × n with n = N / |N|.

About the body's own center, first moments vanish, so that the derivative of the center is just
∂first / volume.
"""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from ..mesh import Surface
from ..moments import monomial_count
from ..numerics import Array, ArrayLike, NDArray, check_type, cross, float_array

TRIANGLES_PER_BLOCK = 65536  # triangles at a time


def volume_gradient(surface: Surface, about: ArrayLike, order: int = 1) -> Array:
    """Return the derivatives of the volume moments to order two at most by every vertex.

    Parameters
    ----------
    surface : Surface
        Closed and outward: of any other the result is the derivative of no volume.
    about : (3,) array_like
        The fixed point that the moments are about.
    order : int

    Returns
    -------
    (n, 4, 3) array, or (n, 10, 3) with second moments
        ∂ raw[α] / ∂ vertex, in the order of `monomials`; unit of the moment per length.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import volume_gradient
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> np.round(volume_gradient(surface, np.zeros(3))[3, 0] * 6, 9).tolist()
    [0.0, 0.0, 1.0]
    """
    return _gradient(surface, about, partial(_volume_shares, order=order), monomial_count(order))


def area_gradient(surface: Surface, about: ArrayLike) -> Array:
    """Return the derivatives of the area and its first moments by every vertex.

    Parameters
    ----------
    surface : Surface
        Triangles without area have no derivative and are left out.
    about : (3,) array_like
        The fixed point that the moments are about.

    Returns
    -------
    (n, 4, 3) array
        As for `volume_gradient`.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import area_gradient
    >>> triangle = Surface.from_triangles(np.eye(4, 3, -1), [[0, 1, 2]])
    >>> area_gradient(triangle, np.zeros(3))[2, 0].tolist()
    [0.0, 0.5, 0.0]
    """
    return _gradient(surface, about, _area_shares, monomial_count(1))


def _gradient(surface: Surface, about: ArrayLike, shares: Callable, count: int) -> Array:
    """Return the (n, count, 3) sums at every vertex of the shares of its triangles' corners.

    shares: yields (count, 3, m) for each corner of m triangles, from their (3, 3, m) corners, these
    from `about`, and (3, m) doubled normals.
    """
    check_type("surface", surface, Surface)
    about = float_array("about", about, 3)
    points = surface.points.astype(np.float64)
    triangles, _ = surface.all_triangles()
    sums = np.zeros((3 * count, len(points)))
    for start in range(0, len(triangles), TRIANGLES_PER_BLOCK):
        part = triangles[start : start + TRIANGLES_PER_BLOCK].astype(np.intp)
        # Only the span of vertices that this block uses is summed up.
        low = int(part.min())
        place = part - low
        length = int(part.max()) - low + 1
        corners = points[part].transpose(1, 2, 0)  # corner, axis, triangle
        normal = np.stack(cross(corners[1] - corners[0], corners[2] - corners[0]))
        for vertex, values in zip(place.T, shares(corners, corners - about[:, None], normal)):
            for row, target in zip(values.reshape(3 * count, -1), sums):
                target[low : low + length] += np.bincount(vertex, row, length)
    return sums.reshape(count, 3, -1).transpose(2, 0, 1)


def _volume_shares(
    _corners: NDArray, local: NDArray, normal: NDArray, order: int
) -> Iterator[NDArray]:
    """Yield for each corner the (k, 3, m) derivatives of the k volume moments to `order` in m
    triangles.

    _corners, local: (3, 3, m) corners, and corners from the reference point; axes are corner, axis,
    triangle. Only `_area_shares` needs the former: their differences are not rounded twice. normal:
    (3, m), as long as the doubled areas.
    """
    total = local[0] + local[1] + local[2]
    i, j = np.triu_indices(3)
    products = total[i] * total[j] + (local[:, i] * local[:, j]).sum(axis=0) if order > 1 else None
    for corner in local:
        weights = np.empty((monomial_count(order), normal.shape[1]))
        weights[0] = 1.0 / 6.0
        weights[1:4] = (total + corner) / 24.0
        if products is not None:
            cross_products = total[i] * corner[j] + corner[i] * (total + 2.0 * corner)[j]
            weights[4:] = (products + cross_products) / 120.0
        yield weights[:, None] * normal


def _area_shares(corners: NDArray, local: NDArray, normal: NDArray) -> Iterator[NDArray]:
    """Yield for each corner the (4, 3, m) derivatives of area moments; parameters as for
    `_volume_shares`.
    """
    double = np.sqrt(np.einsum("im,im->m", normal, normal))
    unit = normal / np.where(double > 0.0, double, 1.0)
    # The moments over |N|, half of the means: an area is |N| / 2, and each corner has a third.
    mean = np.empty((4, len(double)))
    mean[0] = 0.5
    mean[1:4] = (local[0] + local[1] + local[2]) / 6.0
    for k in range(3):
        turn = cross(corners[(k + 1) % 3] - corners[(k + 2) % 3], unit)
        values = mean[:, None] * np.stack(turn)
        for axis in range(3):
            values[1 + axis, axis] += double / 6.0
        yield values
