# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes of constant size on the screen, as triangles in pixels: the disc, with a frame for each
verdict.

All have equally many corners and triangles, the smaller ones filled up with empty triangles, so
that any mixture of them is one array.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...core.numerics import Array, NDArray
from . import appearance as look

SEGMENTS = 24  # segments of a circle
DOT_SEGMENTS = 12
Part = tuple[Array, NDArray[np.int32]]  # (k, 2) corners in pixels, (l, 3) triangles


@dataclass(frozen=True, eq=False)
class Glyphs:
    """Several glyphs of one kind.

    `corners`: (n, k, 2) in pixels. `colors`: (2, n, k, 4) hidden by something in front, and
    visible. `triangles`: (n, l, 3) corner indices, painted in this order.
    """

    corners: NDArray[np.float32]
    colors: NDArray[np.float32]
    triangles: NDArray[np.int32]


GlyphShape = tuple[NDArray, NDArray, NDArray]  # corners, (k, 2, 4) colors, triangles of one glyph


def _arc(radius: float, first: int = 0, last: int = SEGMENTS, segments: int = SEGMENTS) -> Array:
    angles = 2.0 * np.pi / segments * np.arange(first, last + 1)
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _fan(points: NDArray) -> Part:
    """Return the triangle fan between the origin and an open polyline."""
    count = np.arange(1, len(points), dtype=np.int32)
    return np.concatenate([np.zeros((1, 2)), points]), np.stack(
        [0 * count, count, count + 1], axis=1
    )


def _stroke(path: NDArray, width: float) -> Part:
    """Return the triangles of a polyline of this width; each segment is longer by half the width at
    both ends.
    """
    starts = path[:-1]
    ends = path[1:]
    along = ends - starts
    along = along / np.linalg.norm(along, axis=1, keepdims=True) * (width / 2.0)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    quads = np.stack(
        [
            starts - along - across,
            ends + along - across,
            ends + along + across,
            starts - along + across,
        ],
        axis=1,
    )
    first = 4 * np.arange(len(starts), dtype=np.int32)[:, None, None]
    return quads.reshape(-1, 2), (first + np.array([[0, 1, 2], [0, 2, 3]], np.int32)).reshape(-1, 3)


def _colored(*layers: tuple[Part, NDArray, float]) -> GlyphShape:
    """Join layers into one glyph; a layer is a part, its color, and its factor of opacity behind
    other objects.
    """
    starts = np.cumsum([0, *(len(corners) for (corners, _), _, _ in layers)])
    colors = [np.stack([color * (1.0, 1.0, 1.0, hidden), color]) for _, color, hidden in layers]
    return (
        np.concatenate([corners for (corners, _), _, _ in layers]),
        np.concatenate(
            [
                np.broadcast_to(tint, (len(part[0]), 2, 4))
                for (part, _, _), tint in zip(layers, colors)
            ]
        ),
        np.concatenate(
            [triangles + start for ((_, triangles), _, _), start in zip(layers, starts)]
        ),
    )


def _frame(verdict: int) -> list[Array]:
    """Return the polylines around the disc that show the verdict by their form."""
    # square, triangle, diamond
    polygons = {
        1: (45.0, 4, 1.25),
        2: (90.0, 3, 1.75),
        4: (90.0, 4, 1.3),
    }
    if verdict in polygons:
        start, count, size = polygons[verdict]
        angles = np.radians(start + 360.0 / count * np.arange(count + 1))
        return [size * look.FRAME * np.stack([np.cos(angles), np.sin(angles)], axis=1)]
    if verdict == 3:  # dashed
        return [_arc(look.FRAME, first, first + 2) for first in range(0, SEGMENTS, 4)]
    return [_arc(look.FRAME)]


def _disc(verdict: int) -> GlyphShape:
    color = look.COLORS[verdict]
    lines = _frame(verdict)
    quarter = SEGMENTS // 4
    quadrants = [_fan(_arc(look.DISC, quarter * i, quarter * (i + 1))) for i in range(4)]
    return _colored(
        *((_stroke(line, look.STROKE + 2.0 * look.OUTLINE), look.DARK, 1.0) for line in lines),
        *((_stroke(line, look.STROKE), color, 1.0) for line in lines),
        (_stroke(_arc(look.DISC), 2.0 * look.OUTLINE), look.DARK, 1.0),
        *zip(quadrants, (color, look.WHITE, color, look.WHITE), (1.0, look.GLASS, 1.0, look.GLASS)),
        (_fan(_arc(look.DOT + 1.0, 0, DOT_SEGMENTS, DOT_SEGMENTS)), look.DARK, 1.0),
        (_fan(_arc(look.DOT, 0, DOT_SEGMENTS, DOT_SEGMENTS)), color, 1.0),
    )


def _stack(shapes: Sequence[GlyphShape]) -> Glyphs:
    def filled(arrays: Sequence[NDArray]) -> NDArray:
        size = max(map(len, arrays))
        return np.stack(
            [
                np.pad(array, ((0, size - len(array)), *[(0, 0)] * (array.ndim - 1)))
                for array in arrays
            ]
        )

    corners, colors, triangles = (filled(arrays) for arrays in zip(*shapes))
    tints = np.moveaxis(colors, 2, 0)
    return Glyphs(corners.astype(np.float32), tints.astype(np.float32), triangles.astype(np.int32))


@lru_cache(maxsize=1)
def discs() -> Glyphs:
    """Return the discs, in the order of `appearance.VERDICTS`."""
    return _stack([_disc(verdict) for verdict in range(len(look.VERDICTS))])
