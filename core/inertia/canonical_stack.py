# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice of `canonical_frames` for many bodies at once.

It applies to bodies with only the signs of axes left to choose, and to bodies that no moment fixes about an axis.

A frame turned by half a turn about one of its axes has the same normalized moments, but for the signs of the moments
that are odd in both other axes. So the frames with the largest moments, among those that differ by half turns, follow
from the first moment above noise of each odd kind.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..moments.affine_maps import rotate_moments
from ..moments.exponents import monomial_count, monomial_index, monomial_values, monomials, order_from_count
from ..moments.moments import Moments
from ..verdict.finding import MeasureError
from .canonical_frame import NOISE_GROWTH, extents_of
from .findings import MOMENTS_OVERFLOW
from .plain_body import SYMMETRIES
from .third_moment_frames import FIXED_AXIS, HALF_TURN_SIGNS, ThirdMomentFrames

THIRD = monomial_count(2)  # index of the first moment of third order
# By the parity of p, q and r: 0 if half turns change no sign, else 1 to 3 for the exponent of other parity.
ODD_KIND = np.array([[[0, 3], [2, 1]], [[1, 2], [3, 0]]])
# Signs that moments of each such kind get by no half turn, and by half turns about axes 1, 2 and 3.
HALF_TURN_PARITY = np.array([[1.0, 1.0, -1.0, -1.0], [1.0, -1.0, 1.0, -1.0], [1.0, -1.0, -1.0, 1.0]])


def choose_half_turns(moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Return the (n, 4) HALF_TURN_SIGNS that `canonical_frames` chooses for bodies without axes of equal moments."""
    values, least, _ = _along_axes(moments, fixed, bodies)
    return _choose(values, least, fixed.allowed[bodies])


def choose_about_axis(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Choose the half turns as `canonical_frames` does, for bodies with two axes of equal moments.

    Return an (n,) mask of the bodies whose moments do not fix the directions of these two axes, and an (n, 4) mask of
    half turns, at most one for each direction of the third axis. The half turns hold for the masked bodies only; the
    other bodies have to be searched one by one.
    """
    values, least, raw = _along_axes(moments, fixed, bodies)
    is_round, allowed = np.ones(len(bodies), bool), fixed.allowed[bodies]
    for name, axis in FIXED_AXIS.items():
        rows = np.flatnonzero(fixed.symmetry[bodies] == SYMMETRIES.index(name))
        weights, columns, forms = _harmonics(axis, moments.order)
        size = fixed.size[bodies[rows]]
        unit = monomial_values(extents_of(size), moments.order)[:, columns + THIRD]
        harmonic = np.abs(raw[rows][:, THIRD:] @ forms.T) / unit
        is_round[rows] = ~(harmonic > weights * least[rows][:, columns]).any(axis=1)
        # keep only the first frame for each direction of the axis
        ahead = HALF_TURN_SIGNS[:, axis] > 0.0
        for way in (ahead, ~ahead):
            later = np.cumsum(allowed[np.ix_(rows, np.flatnonzero(way))], axis=1) > 1
            kept = allowed[np.ix_(rows, np.flatnonzero(way))] & ~later
            allowed[np.ix_(rows, np.flatnonzero(way))] = kept
    return is_round, _choose(values, least, allowed)


def _choose(values: NDArray, least: NDArray, allowed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return an (n, 4) mask of the allowed half turns with the largest (n, columns) moments, equal within `least`."""
    kind = ODD_KIND[tuple(monomials(order_from_count(THIRD + values.shape[1]))[THIRD:].T % 2)]
    clear = (2.0 * np.abs(values) > least)[:, None] & (kind == np.arange(1, 4)[:, None])  # (n, 3, columns)
    count = values.shape[1]
    bodies, first = np.arange(len(values)), np.where(clear.any(axis=2), clear.argmax(axis=2), count)
    for deciding in first.argsort(axis=1).T:
        column = first[bodies, deciding]
        value = values[bodies, np.minimum(column, count - 1)]
        positive = allowed & (HALF_TURN_PARITY[deciding] * value[:, None] > 0.0)
        decides = (column < count) & positive.any(axis=1)
        allowed = np.where(decides[:, None], positive, allowed)
    return allowed


def _along_axes(
    moments: Moments, fixed: ThirdMomentFrames, bodies: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return (n, columns) normalized moments of order ≥ 3 along the axes, their noise, and (n, K) central ones."""
    central = moments.about_center()
    order, total, size = central.order, central.raw[:, :1], fixed.size[bodies]
    with np.errstate(over="ignore"):
        reach = total[:, 0] * size.max(axis=1) ** order
    if not ((reach > np.finfo(float).tiny) & (reach < np.inf)).all():
        raise MeasureError(MOMENTS_OVERFLOW, order=order)
    turned = fixed.axes[bodies].transpose(0, 2, 1)
    raw = rotate_moments(central.raw / total, order, turned)
    error = rotate_moments(central.rounding_error / total, order, np.abs(turned))[:, THIRD:]
    powers = monomials(order)[THIRD:]
    degree, extents = powers.sum(axis=1), extents_of(size)
    unit = monomial_values(extents, order)[:, THIRD:]
    thin = np.minimum.reduce(np.where(powers > 0, extents[:, None], np.inf), axis=2)
    noise = fixed.noise + 4.0 * fixed.step[bodies, None] / thin + degree * fixed.tilt[bodies, None]
    return raw[:, THIRD:] / unit, np.array(NOISE_GROWTH)[degree] * noise + error / unit, raw


@lru_cache
def _harmonics(axis: int, order: int) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.complex128]]:
    """Return the harmonics E[(x+iy)^m (x²+y²)^j z^k] for all degrees m + 2j + k from 3 to `order` with m > 0.

    z is along this axis, x and y along the next. Return three arrays: (h,) factors on the noise of a moment that give
    the noise of each harmonic; (h,) the column, from third order on, of that moment; and (h, columns) coefficients.
    """
    weights, columns, forms = [], [], []
    for degree in range(3, order + 1):
        for m in range(1, degree + 1):
            for k in range((degree - m) % 2, degree - m + 1, 2):
                form = np.zeros(monomial_count(order) - THIRD, complex)
                planar = np.polynomial.polynomial.polypow([1.0, 1.0j], m)  # coefficients of y over x
                ring = np.polynomial.polynomial.polypow([1.0, 0.0, 1.0], (degree - m - k) // 2)
                where = [
                    monomial_index(*np.roll((degree - k - power, power, k), axis + 1)) - THIRD
                    for power in range(degree - k + 1)
                ]
                form[where] = np.polynomial.polynomial.polymul(planar, ring)
                weights.append(2.0 ** (degree - k))
                columns.append(where[0])
                forms.append(form)
    return np.array(weights), np.array(columns), np.array(forms)
