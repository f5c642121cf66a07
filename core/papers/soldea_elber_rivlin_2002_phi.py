# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments by the Φ tensors of Soldea, Elber and Rivlin, as printed: a reference for small patches.

With S = Σ P_i B_i and the z-flux, the volume is (section 2, eqs. 2 to 5)

    M_0 = Σ_l Σ_i Σ_j z_l x_i y_j Φ⁰_{ijl},    Φ⁰_{ijl} = ∫∫ B_l (B_i,s B_j,t - B_i,t B_j,s) ds dt,

each index standing for a pair, of s and of t; Φ¹ and Φ² (sections 3.1 and 3.2) hold one and two
factors B more. Every entry is a difference of products of two integrals over one parameter. There
are (n n')^(3 + order) of them: this is good for patches of some nine control points;
`core/nurbs/tracked_solid.py` is for any patch.
"""

import numpy as np

from ..numerics import Array, NDArray, SplineSpace, gauss_legendre
from .sheynin_tuzikov_2001 import _exponents_to

MAX_ENTRIES = 2e6


def phi(spaces: tuple[SplineSpace, SplineSpace], order: int) -> Array:
    """Return the tensor Φ of a patch's function spaces.

    Parameters
    ----------
    spaces : (SplineSpace, SplineSpace)
    order : int
        0, 1 or 2.

    Returns
    -------
    (n, n, n, …) array
        Indexed [i, j, l, m, …] by control points in row-major order.

    Raises
    ------
    ValueError
        If the tensor would have more than `MAX_ENTRIES` entries.

    Examples
    --------
    >>> from body_moments.core.numerics import clamped_space
    >>> from body_moments.core.papers.soldea_elber_rivlin_2002_phi import phi
    >>> phi((clamped_space(2), clamped_space(2)), 0).shape
    (4, 4, 4)
    """
    size = (spaces[0].count * spaces[1].count) ** (3 + order)
    if size > MAX_ENTRIES:
        raise ValueError("{:d} entries of Φ".format(size))
    s, t = (_integrals(space, order) for space in spaces)
    swapped = (1, 0, *range(2, 3 + order))
    table = np.multiply.outer(s, t.transpose(swapped)) - np.multiply.outer(s.transpose(swapped), t)
    # [i j l ..., i' j' l' ...] to [i i', j j', l l', ...]
    count = 3 + order
    pairs = [axis for k in range(count) for axis in (k, count + k)]
    return table.transpose(pairs).reshape((spaces[0].count * spaces[1].count,) * count)


def phi_moments(points: NDArray, tensors: tuple[NDArray, ...]) -> dict[tuple[int, int, int], float]:
    """Return the moments of the z-flux of a polynomial patch from its tensors Φ.

    Parameters
    ----------
    points : (n_s, n_t, 3) array
        Control points.
    tensors : tuple of array
        Φ⁰, Φ¹ and Φ², or fewer.

    Returns
    -------
    dict of (p, q, r) to float

    Examples
    --------
    >>> from body_moments.core.numerics import clamped_space
    >>> from body_moments.core.papers.soldea_elber_rivlin_2002_phi import phi, phi_moments
    >>> square = np.array([[[0.0, 0.0, 2.0], [0.0, 1.0, 2.0]], [[1.0, 0.0, 2.0], [1.0, 1.0, 2.0]]])
    >>> round(phi_moments(square, (phi((clamped_space(2), clamped_space(2)), 0),))[0, 0, 0], 12)
    2.0
    """
    x, y, z = points.reshape(-1, 3).T
    moments = {}
    for p, q, r in _exponents_to(len(tensors) - 1):
        product = tensors[p + q + r]
        for coordinate in (x, y, *[x] * p, *[y] * q, *[z] * (r + 1)):
            product = np.tensordot(coordinate, product, 1)
        moments[p, q, r] = float(product) / (r + 1)
    return moments


def _integrals(space: SplineSpace, order: int) -> Array:
    """Return ∫ B'_i B_j B_l ... of one parameter, (count, count, count, ...)."""
    nodes, weights = gauss_legendre((3 + order) * (space.order - 1) // 2 + 1)
    low, high = space.intervals.T
    size = (high - low)[:, None]
    parameters = (low[:, None] + size * nodes).ravel()
    values = space.collocation_matrix(parameters)
    slopes = space.collocation_matrix(parameters, 1)
    operands = [slopes] + [values] * (2 + order)
    letters = "ijlmo"[: 3 + order]
    return np.einsum(
        "{:s},g->{:s}".format(",".join("g" + letter for letter in letters), letters),
        *operands,
        (size * weights).ravel(),
        optimize=True,
    )
