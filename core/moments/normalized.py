# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments without unit: independent of a body's place and size."""

from __future__ import annotations

import numpy as np

from ..verdict.finding import MeasureError
from .affine_maps import apply_translation
from .exponents import monomials
from .findings import NORMALIZATION_UNDEFINED
from .moments import Measure, Moments, U


def normalize(moments: Moments, by: str = "size") -> Moments:
    """Return the central moments without unit, about (0, 0, 0): independent of place and size of the body.

    by: "size" for μ / V^(1+n/3) of volumes and μ / A^(1+n/2) of areas, for degree n, as if the body were scaled to a
    volume, or area, of 1; "gyration" for μ / (m R^n) with R² = ∫ r² dm / m, from second order on, as if it were scaled
    to a radius of gyration and a mass of 1. The bounds hold for the body's true center. ValueError if `by` is neither
    or does not fit, MeasureError if there is too little to divide by.
    """
    if by not in ("size", "gyration"):
        raise ValueError("by not 'size', 'gyration': {!r}".format(by))
    dimension = {Measure.VOLUME: 3, Measure.AREA: 2}.get(moments.measure)
    if by == "size" and dimension is None:
        raise ValueError("masses need 'gyration'")
    uncertain = moments.rounding_error[0] + moments.input_error[0]
    if moments.order < (2 if by == "gyration" else 1) or not moments.total > 2.0 * uncertain:
        raise MeasureError(NORMALIZATION_UNDEFINED)
    body = moments.about_center()
    n = monomials(moments.order).sum(axis=1)
    trace = float(body.raw[[4, 7, 9]].sum()) if by == "gyration" else 1.0
    if by == "gyration":
        factor = (trace / body.total) ** (-n / 2.0) / body.total
    else:
        factor = body.total ** -(1.0 + n / dimension)
    bounds = []
    # Bounds of the total, the trace, and the center's place.
    for delta in (body.rounding_error, body.rounding_error + body.input_error):
        total = body.total / (body.total - delta[0])
        off = (np.abs(body.raw[1:4]) + delta[1:4]) / (body.total - delta[0]) + 2.0 * U * np.abs(body.about)
        size = np.abs(body.raw) + delta
        away = apply_translation(size[None], moments.order, off[None])[0] - size + 8.0 * U * n * size
        if by == "gyration":
            spread = delta[[4, 7, 9]].sum() + away[[4, 7, 9]].sum()
            if not trace > 2.0 * spread:
                raise MeasureError(NORMALIZATION_UNDEFINED)
            stretch = total ** np.abs(n / 2.0 - 1.0) * (trace / (trace - spread)) ** (n / 2.0)
        else:
            stretch = total ** (1.0 + n / dimension)
        bounds.append(factor * (stretch * (delta + away) + (stretch - 1.0 + (8.0 + 4.0 * n) * U) * size))
    return Moments(
        body.raw * factor,
        np.zeros(3),
        moments.measure if by == "size" else Measure.MASS,
        bounds[0],
        (bounds[1] - bounds[0]) * bool(moments.input_error.any()),
    )
