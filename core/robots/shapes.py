# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of the shapes that robots are made of, in closed form where the shape is round."""

from __future__ import annotations

from math import pi

import numpy as np

from ..moments.exponents import KNOWN_ORDER
from ..moments.moments import SECOND_MOMENT_INDEX, Measure, Moments, monomial_count
from ..polyhedron.third_order import integrate
from .model import Shape


def moments_of(shape: Shape) -> Moments:
    """Return the moments of a shape at density 1, in the link's frame; a mesh must have its surface."""
    if shape.surface is not None:
        surface = shape.surface.transform(np.diag(shape.size))
        own = integrate(surface, 1, area=False, area_moments=False, exact=True)[0]
    else:
        own = primitive_moments(shape)
    return own.transform(shape.pose.matrix)


def primitive_moments(shape: Shape) -> Moments:
    """Return the moments of a box, ellipsoid, sphere, capsule or cylinder about its middle, in its own axes."""
    if shape.kind == "box":
        sides = np.array(shape.size)
        volume = float(sides.prod())
        second = volume * sides * sides / 12.0
    elif shape.kind in ("sphere", "ellipsoid"):
        axes = np.array(shape.size * 3 if shape.kind == "sphere" else shape.size)
        volume = 4.0 / 3.0 * pi * float(axes.prod())
        second = volume * axes * axes / 5.0
    else:
        radius, length = shape.size
        volume, across = pi * radius**2 * length, pi * radius**4 * length / 4.0
        along = pi * radius**2 * length**3 / 12.0
        if shape.kind == "capsule":
            volume += 4.0 / 3.0 * pi * radius**3
            across += 4.0 / 15.0 * pi * radius**5
            along += pi * radius**3 * (4.0 / 15.0 * radius**2 + length * radius / 2.0 + length**2 / 3.0)
        second = np.array([across, across, along])
    raw = np.zeros(monomial_count(KNOWN_ORDER))
    raw[0] = volume
    raw[np.diag(SECOND_MOMENT_INDEX)] = second
    return Moments(raw, np.zeros(3), Measure.VOLUME)
