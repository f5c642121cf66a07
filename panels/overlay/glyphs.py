# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes of constant size on the screen, as triangles in pixels: the disc with its frame, and the digits of the axes.

All glyphs of one kind have equally many triangles, the shorter ones filled up with empty triangles, so that any mixture
of them is one array.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from . import appearance as look

SEGMENTS = 32  # of a circle
Shape = tuple[NDArray[np.float32], NDArray[np.float32]]  # (k, 3, 2) triangles in pixels and (k, 4) their colors

# digits in units of half their height
DIGITS = (
    ((-0.3, 0.6), (0.1, 1.0), (0.1, -1.0)),
    ((-0.5, 0.7), (-0.2, 1.0), (0.3, 1.0), (0.5, 0.7), (0.5, 0.3), (-0.55, -1.0), (0.6, -1.0)),
    ((-0.5, 1.0), (0.5, 1.0), (0.0, 0.25), (0.4, 0.1), (0.55, -0.4), (0.3, -0.9), (-0.1, -1.0), (-0.55, -0.8)),
)


def _circle(radius: float, first: int = 0, last: int = SEGMENTS) -> NDArray:
    angles = 2.0 * np.pi / SEGMENTS * np.arange(first, last + 1)
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _fan(points: NDArray) -> NDArray:
    """(k, 3, 2) triangles from the origin to the sides of an open polyline."""
    return np.stack([np.zeros_like(points[1:]), points[:-1], points[1:]], axis=1)


def _strip(path: NDArray, width: float, closed: bool) -> NDArray:
    """(k, 3, 2) a polyline with width; each of its segments is longer by half the width at both ends."""
    ends = np.roll(path, -1, axis=0) if closed else path[1:]
    starts = path if closed else path[:-1]
    along = ends - starts
    along = along / np.linalg.norm(along, axis=1, keepdims=True) * (width / 2.0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    a, b, c, d = starts - along - across, ends + along - across, ends + along + across, starts - along + across
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def _colored(*layers: tuple[NDArray, NDArray]) -> Shape:
    triangles = np.concatenate([triangles for triangles, _ in layers])
    colors = np.concatenate([np.broadcast_to(color, (len(triangles), 4)) for triangles, color in layers])
    return triangles.astype(np.float32), colors.astype(np.float32)


def _frame(verdict: int) -> list[NDArray]:
    """The closed or open polylines around the disc that say the verdict by their form."""
    corners = {1: (45.0, 4, 1.25), 2: (90.0, 3, 1.75), 4: (90.0, 4, 1.3)}  # square, triangle, diamond
    if verdict in corners:
        start, count, size = corners[verdict]
        angles = np.radians(start + 360.0 / count * np.arange(count + 1))
        return [size * look.FRAME * np.stack([np.cos(angles), np.sin(angles)], axis=1)]
    if verdict == 3:  # dashed
        return [_circle(look.FRAME, first, first + 2) for first in range(0, SEGMENTS, 4)]
    return [_circle(look.FRAME)]


def _disc(verdict: int) -> Shape:
    color = look.COLORS[verdict]
    wide, narrow = (
        np.concatenate([_strip(line, width, closed=False) for line in _frame(verdict)])
        for width in (look.STROKE + 2.0 * look.OUTLINE, look.STROKE)
    )
    quarter = SEGMENTS // 4
    quadrants = [_fan(_circle(look.DISC, quarter * i, quarter * (i + 1))) for i in range(4)]
    return _colored(
        (wide, look.DARK),
        (narrow, color),
        (_fan(_circle(look.DISC + look.OUTLINE)), look.DARK),
        (np.concatenate(quadrants[0::2]), color),
        (np.concatenate(quadrants[1::2]), look.WHITE),
        (_fan(_circle(look.DOT + 1.0)), look.DARK),
        (_fan(_circle(look.DOT)), color),
    )


def _digit(points: Sequence[tuple[float, float]]) -> Shape:
    path = np.array(points) * look.DIGIT
    return _colored(
        (_strip(path, look.STROKE + 2.0 * look.OUTLINE, closed=False), look.DARK),
        (_strip(path, look.STROKE, closed=False), look.WHITE),
    )


def _stack(shapes: Sequence[Shape]) -> Shape:
    size = max(len(triangles) for triangles, _ in shapes)
    filled = [
        (
            np.pad(triangles, ((0, size - len(triangles)), (0, 0), (0, 0))),
            np.pad(colors, ((0, size - len(colors)), (0, 0))),
        )
        for triangles, colors in shapes
    ]
    return np.stack([triangles for triangles, _ in filled]), np.stack([colors for _, colors in filled])


@lru_cache(maxsize=1)
def discs() -> Shape:
    """(verdicts, k, 3, 2) pixels and (verdicts, k, 4) colors of the discs, in the order of `appearance.VERDICTS`."""
    return _stack([_disc(verdict) for verdict in range(len(look.VERDICTS))])


@lru_cache(maxsize=1)
def digits() -> Shape:
    """(3, k, 3, 2) pixels and (3, k, 4) colors of the digits 1, 2 and 3."""
    return _stack([_digit(points) for points in DIGITS])
