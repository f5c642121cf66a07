# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and center of bodies with vertices mixed from several shapes.

If every vertex is p + Σ v_k d_k, the moments of order n of the volume are polynomials of degree 3 +
n in the mixing values v: the integral over a cone to a triangle is the determinant of its corners
times a polynomial of degree n of them. So the moments of as many mixes as the polynomial has
coefficients give the moments of all mixes, inside the range of the samples and beyond it.
"""

from dataclasses import dataclass
from itertools import product
from math import comb

import numpy as np

from ..mesh import Surface
from ..numerics import Array, ArrayLike, Integers, NDArray
from ..polyhedron import polyhedron_moments

DEGREE = 4  # The degree of the first moments.
MIN_SHARE = 1e-6  # Smaller volumes, relative to their terms, are lost to cancellation.


@dataclass(frozen=True, eq=False)
class Mixes:
    """Volume and first moments as polynomials of the mixing values.

    `coefficients`: (c, 4) coefficients of volume and first moments about `about`.
    `exponents`: (c, k) the powers of the mixing values that each coefficient belongs to.
    """

    coefficients: Array
    exponents: Integers
    about: Array

    def at(self, values: ArrayLike) -> tuple[Array, Array]:
        """Return (f,) volumes and (f, 3) centers of mixes by (f, k) values; NaN for flat and
        inside-out ones.
        """
        powers = _powers(np.asarray(values, np.float64), self.exponents)
        moments = powers @ self.coefficients
        terms = np.abs(powers) @ np.abs(self.coefficients[:, 0])
        moments[~(moments[:, 0] > MIN_SHARE * terms)] = np.nan
        return moments[:, 0], self.about + moments[:, 1:] / moments[:, :1]


def sample_count(shapes: int) -> int:
    """Return the number of mixes to measure for a number of shapes."""
    return comb(shapes + DEGREE, DEGREE)


def fit_mixes(surface: Surface, offsets: ArrayLike) -> Mixes:
    """Fit the polynomials of a closed, outward surface, triangulated as now, with the (k, n, 3)
    offsets of k shapes.
    """
    triangles, _ = surface.all_triangles()
    points = surface.points.astype(np.float64)
    offsets = np.asarray(offsets, np.float64)
    about = np.mean(surface.box, axis=0)
    exponents = np.array(
        [
            powers
            for powers in product(range(DEGREE + 1), repeat=len(offsets))
            if sum(powers) <= DEGREE
        ]
    )
    # Mixing values on the lattice of a simplex, where a polynomial of this degree is unique.
    nodes = exponents / DEGREE
    samples = np.empty((len(nodes), 4))
    for row, values in enumerate(nodes):
        mixed = points + np.tensordot(values, offsets, axes=1)
        volume, _ = polyhedron_moments(
            Surface.from_triangles(mixed, triangles), 1, about=about, allow_open=True
        )
        samples[row] = volume.raw
    coefficients = np.linalg.solve(_powers(nodes, exponents), samples)
    return Mixes(np.asarray(coefficients, np.float64), exponents, about)


def _powers(values: NDArray, exponents: NDArray) -> Array:
    """Return the (f, c) monomials: products of (f, k) values to the powers (c, k)."""
    return np.prod(values[:, None, :] ** exponents, axis=2)
