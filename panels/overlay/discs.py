# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Discs at the centers of mass, and digits at the ends of axes, as arrays: their size on the screen is constant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import appearance as look
from . import glyphs
from .bodies import Bodies
from .lines import axis_lines

MARGIN = 40.0  # pixels around the view in which discs are still made
MIN_NAMED = 8.0  # pixels of the longest axis from which on axes are named


@dataclass(frozen=True, eq=False)
class View:
    """A projection of the world to the screen: (4, 4) world to view, (4, 4) view to clip space, (2,) size in pixels."""

    view: NDArray[np.float64]
    projection: NDArray[np.float64]
    size: NDArray[np.float64]

    def depths(self, points: NDArray) -> NDArray[np.float64]:
        """Return (n,) distances of (n, 3) points from the eye along the view, negative behind it in perspective."""
        return -(points @ self.view[2, :3] + self.view[2, 3])

    def pixels(self, points: NDArray) -> NDArray[np.float64]:
        """Return (n, 2) screen positions of (n, 3) points, from the lower left corner.

        Positions of points behind the eye are meaningless.
        """
        seen = points @ self.view[:3, :3].T + self.view[:3, 3]
        clip = seen @ self.projection[:, :3].T + self.projection[:, 3]
        scale = np.where(clip[:, 3] == 0.0, 1.0, clip[:, 3])
        return (clip[:, :2] / scale[:, None] + 1.0) / 2.0 * self.size

    def pixel_sizes(self, points: NDArray) -> NDArray[np.float64]:
        """Return (n, 2) lengths of a pixel at (n, 3) points, along the width and the height; 0 behind the eye."""
        seen = points @ self.view[:3, :3].T + self.view[:3, 3]
        w = seen @ self.projection[3, :3] + self.projection[3, 3]
        return np.maximum(w, 0.0)[:, None] * 2.0 / (self.size * np.diagonal(self.projection)[:2])

    def place(self, anchors: NDArray, offsets: NDArray) -> NDArray[np.float64]:
        """Return (n, k, 3) world points of shapes of constant screen size at (n, 3) anchors, in the offsets' type.

        The (n, k, 2) offsets are pixels right and up; the points lie in the plane through the anchor facing the view.
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
    bodies: Bodies, view: View, scale: float, labeled: int
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]] | None:
    """Make the discs at the centers, and the digits at the ends of the axes of the `labeled` body, -1 for none.

    No disc is larger than its body: the largest radius of gyration is at most the distance of the farthest point.

    Return (k, 3) points, (2, k, 4) colors, hidden by something in front and visible, and (l, 3) triangles, the nearest
    bodies last; None if no body is in view. scale: pixels of the screen per pixel of `appearance`.
    """
    sizes = view.pixel_sizes(bodies.centers).max(axis=1)
    reach = np.divide(bodies.gyration.max(axis=1), sizes, out=np.zeros(len(sizes)), where=sizes > 0.0)  # in pixels
    pixels = view.pixels(bodies.centers)
    away = np.abs(pixels - view.size / 2.0) - view.size / 2.0
    seen = np.flatnonzero((sizes > 0.0) & (away <= (reach + scale * MARGIN)[:, None]).all(axis=1))
    seen = seen[np.argsort(-view.depths(bodies.centers[seen]), kind="stable")]
    named = (seen == labeled) & (reach[seen] >= scale * MIN_NAMED)
    parts = [
        _glyphs(bodies, group, view, scale, reach, pixels if has_digits else None)
        for group, has_digits in ((seen[~named], False), (seen[named], True))
        if len(group)
    ]
    if not parts:
        return None
    starts = np.cumsum([0, *(len(points) for points, _, _ in parts)], dtype=np.int32)
    points, colors, triangles = zip(*parts)
    numbered = [corners + start for corners, start in zip(triangles, starts)]
    return np.concatenate(points), np.concatenate(colors, axis=1), np.concatenate(numbered)


def _glyphs(
    bodies: Bodies, group: NDArray[np.intp], view: View, scale: float, reach: NDArray, pixels: NDArray | None
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int32]]:
    """Make the `disc_triangles` of some bodies, in this order; digits if the `pixels` of all centers are given.

    reach: of all bodies, their sizes in pixels; 0 for points.
    """
    count, centers, verdicts = len(group), bodies.centers[group], bodies.verdicts[group]
    discs = glyphs.discs()
    radii = scale * np.linalg.norm(discs.corners, axis=2).max(axis=1)[verdicts]
    sizes = np.where(reach[group] > 0.0, np.minimum(reach[group] / radii, 1.0), 1.0).astype(np.float32)
    corners = scale * sizes[:, None, None] * discs.corners[verdicts]
    points, colors = [view.place(centers, corners)], [discs.colors[:, verdicts]]
    triangles = [discs.triangles[verdicts]]
    if pixels is not None:
        digits = glyphs.digits()
        tips = axis_lines(centers, bodies.axes[group], bodies.gyration[group])[:, :, 1].reshape(-1, 3)
        away = _digit_offsets(pixels[group], view.pixels(tips).reshape(-1, 3, 2), scale).astype(np.float32)
        offsets = (scale * digits.corners + away[:, :, None]).reshape(3 * count, digits.corners.shape[1], 2)
        points.append(view.place(tips, offsets).reshape(count, 3 * digits.corners.shape[1], 3))
        tints = digits.colors.reshape(2, 1, -1, 4)
        colors.append(np.broadcast_to(tints, (2, count, *tints.shape[2:])))
        first = discs.corners.shape[1] + digits.corners.shape[1] * np.arange(3, dtype=np.int32)[:, None, None]
        named = (digits.triangles + first).reshape(1, -1, 3)
        triangles.append(np.broadcast_to(named, (count, *named.shape[1:])))
    placed, tints = np.concatenate(points, axis=1), np.concatenate(colors, axis=2)
    start = placed.shape[1] * np.arange(count, dtype=np.int32)[:, None, None]
    corners = np.concatenate(triangles, axis=1) + start
    return placed.reshape(-1, 3), tints.reshape(2, -1, 4), corners.reshape(-1, 3)


def _digit_offsets(centers: NDArray, tips: NDArray, scale: float) -> NDArray[np.float64]:
    """Return (n, 3, 2) pixels from the ends of axes, (n, 3, 2), to their digits: beyond the end, and off the disc."""
    arms = tips - centers[:, None]
    lengths = np.linalg.norm(arms, axis=2, keepdims=True)
    fallback = np.array([(1.0, 0.3), (-0.3, 1.0), (-1.0, -0.3)])
    directions = np.where(lengths > 1e-3, arms / np.maximum(lengths, 1e-3), fallback)
    wanted = np.maximum(lengths + scale * 2.5 * look.DIGIT, scale * (look.FRAME + 3.0 * look.DIGIT))
    return directions * (wanted - lengths)
