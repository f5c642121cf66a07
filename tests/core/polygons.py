# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with corners and round sides."""

import numpy as np
from body_moments.core.numerics.bspline import clamped_space
from body_moments.core.nurbs.splines import Curve


def arcs(radius, z=0.0, center=(0.0, 0.0), count=4):
    """Quadratic rational arcs, counter-clockwise."""
    half, made = np.pi / count, []
    for k in range(count):
        ring = [(2 * k - 1, 1.0), (2 * k, 1.0 / np.cos(half)), (2 * k + 1, 1.0)]
        points = [
            (*(center + radius * far * np.array([np.cos(t * half), np.sin(t * half)])), z)
            for t, far in ring
        ]
        made.append(Curve(clamped_space(3), np.array(points), np.array([1.0, np.cos(half), 1.0])))
    return made


def polygon(*corners, z=0.0):
    points = np.array([(*corner, z) for corner in corners], np.float64)
    return [
        Curve(clamped_space(2), np.array(pair)) for pair in zip(points, np.roll(points, -1, axis=0))
    ]


def rectangle(x, y, width, height):
    return [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]


def shape(*outlines):
    """(points, loops)"""
    starts = np.cumsum([0] + [len(one) for one in outlines])
    return np.array([p for one in outlines for p in one], float), [
        np.arange(a, b) for a, b in zip(starts, starts[1:])
    ]
