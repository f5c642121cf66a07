# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Discs at the centers of mass, with a frame for each verdict, as triangles: their size on the
screen is constant.

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
from .bodies import Bodies

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
    # (k, 2) corners `first` to `last` of a circle of `segments` sides
    angles = 2.0 * np.pi / segments * np.arange(first, last + 1)
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _fan(points: NDArray) -> Part:
    """Return the triangle fan between the origin and an open polyline."""
    corner = np.arange(1, len(points), dtype=np.int32)  # 0 is the origin
    triangles = np.stack([0 * corner, corner, corner + 1], axis=1)
    return np.concatenate([np.zeros((1, 2)), points]), triangles


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
    # By verdict: direction of the first corner in degrees, corners, and distance of the corners
    # relative to the circle's radius, chosen so that the frames look equally large.
    polygons = {
        1: (45.0, 4, 1.25),  # square
        2: (90.0, 3, 1.75),  # triangle
        4: (90.0, 4, 1.3),  # diamond
    }
    if verdict in polygons:
        start, count, size = polygons[verdict]
        angles = np.radians(start + 360.0 / count * np.arange(count + 1))
        return [size * look.FRAME * np.stack([np.cos(angles), np.sin(angles)], axis=1)]
    if verdict == 3:  # dashed: two of four sides
        return [_arc(look.FRAME, first, first + 2) for first in range(0, SEGMENTS, 4)]
    return [_arc(look.FRAME)]


def _disc(verdict: int) -> GlyphShape:
    # from the lowest layer to the highest: frame, disc of four quadrants, and dot, each on dark
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
    # A triangle of zeros, one corner three times, draws nothing.
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
def glyphs() -> Glyphs:
    """Return the discs, in the order of `appearance.VERDICTS`."""
    return _stack([_disc(verdict) for verdict in range(len(look.VERDICTS))])


MARGIN = 40.0  # pixels around the view in which discs are still made


@dataclass(frozen=True, eq=False)
class View:
    """A projection of the world to the screen.

    view: (4, 4) world to view. projection: (4, 4) view to clip space. size: (2,) pixels.
    """

    view: Array
    projection: Array
    size: Array

    def depths(self, points: NDArray) -> Array:
        """Return (n,) distances of (n, 3) points from the eye along the view, negative behind it in
        perspective.
        """
        return -(points @ self.view[2, :3] + self.view[2, 3])

    def pixels(self, points: NDArray) -> Array:
        """Return (n, 2) screen positions of (n, 3) points, from the lower left corner.

        Positions of points behind the eye are meaningless.
        """
        view_points = points @ self.view[:3, :3].T + self.view[:3, 3]
        clip = view_points @ self.projection[:, :3].T + self.projection[:, 3]
        scale = np.where(clip[:, 3] == 0.0, 1.0, clip[:, 3])
        return (clip[:, :2] / scale[:, None] + 1.0) / 2.0 * self.size

    def pixel_sizes(self, points: NDArray) -> Array:
        """Return (n, 2) lengths of a pixel at (n, 3) points, along the width and the height; 0
        behind the eye.
        """
        view_points = points @ self.view[:3, :3].T + self.view[:3, 3]
        # The screen is 2 wide in clip coordinates, where a length of 1 along the view's axis i is
        # projection[i, i] / w long.
        w = view_points @ self.projection[3, :3] + self.projection[3, 3]
        return np.maximum(w, 0.0)[:, None] * 2.0 / (self.size * np.diagonal(self.projection)[:2])

    def place(self, anchors: NDArray, offsets: NDArray) -> Array:
        """Return (n, k, 3) world points of shapes of constant screen size at (n, 3) anchors, in the
        offsets' type.

        The (n, k, 2) offsets are pixels right and up; the points lie in the plane through the
        anchor facing the view.
        """
        lengths = self.pixel_sizes(anchors)[:, :, None] * self.view[:2, :3]
        right, up = offsets[..., 0], offsets[..., 1]
        placed = np.empty((*right.shape, 3), offsets.dtype)
        for axis in range(3):
            across, above, base = (
                values.astype(offsets.dtype)[:, None]
                for values in (lengths[:, 0, axis], lengths[:, 1, axis], anchors[:, axis])
            )
            placed[..., axis] = right * across + up * above + base
        return placed


def disc_triangles(
    bodies: Bodies, view: View, scale: float
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]] | None:
    """Make the discs at the centers.

    No disc is larger than its body: the largest radius of gyration is at most the distance of the
    farthest point.

    Return (k, 3) points, (2, k, 4) colors, hidden by something in front and visible, and (l, 3)
    triangles, the nearest bodies last; None if no body is in view. scale: pixels of the screen per
    pixel of `appearance`.
    """
    sizes = view.pixel_sizes(bodies.centers).max(axis=1)
    # largest radius of gyration in pixels
    reach = np.divide(
        bodies.gyration.max(axis=1), sizes, out=np.zeros(len(sizes)), where=sizes > 0.0
    )
    away = np.abs(view.pixels(bodies.centers) - view.size / 2.0) - view.size / 2.0
    visible = np.flatnonzero(
        (sizes > 0.0) & (away <= (reach + scale * MARGIN)[:, None]).all(axis=1)
    )
    if not len(visible):
        return None
    visible = visible[np.argsort(-view.depths(bodies.centers[visible]), kind="stable")]
    discs = glyphs()
    reach = reach[visible]
    verdicts = bodies.verdicts[visible]
    radii = scale * np.linalg.norm(discs.corners, axis=2).max(axis=1)[verdicts]
    shrink = np.where(reach > 0.0, np.minimum(reach / radii, 1.0), 1.0).astype(np.float32)
    points = view.place(
        bodies.centers[visible], scale * shrink[:, None, None] * discs.corners[verdicts]
    )
    first = points.shape[1] * np.arange(len(visible), dtype=np.int32)[:, None, None]
    triangles = discs.triangles[verdicts] + first
    return (
        points.reshape(-1, 3),
        discs.colors[:, verdicts].reshape(2, -1, 4),
        triangles.reshape(-1, 3),
    )
