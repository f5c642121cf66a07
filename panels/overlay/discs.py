# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Discs at the centers of mass, as arrays: their size on the screen is constant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.numerics import Array, NDArray
from . import glyphs
from .bodies import Bodies

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
        seen = points @ self.view[:3, :3].T + self.view[:3, 3]
        clip = seen @ self.projection[:, :3].T + self.projection[:, 3]
        scale = np.where(clip[:, 3] == 0.0, 1.0, clip[:, 3])
        return (clip[:, :2] / scale[:, None] + 1.0) / 2.0 * self.size

    def pixel_sizes(self, points: NDArray) -> Array:
        """Return (n, 2) lengths of a pixel at (n, 3) points, along the width and the height; 0
        behind the eye.
        """
        seen = points @ self.view[:3, :3].T + self.view[:3, 3]
        w = seen @ self.projection[3, :3] + self.projection[3, 3]
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
    # in pixels
    reach = np.divide(
        bodies.gyration.max(axis=1), sizes, out=np.zeros(len(sizes)), where=sizes > 0.0
    )
    away = np.abs(view.pixels(bodies.centers) - view.size / 2.0) - view.size / 2.0
    seen = np.flatnonzero((sizes > 0.0) & (away <= (reach + scale * MARGIN)[:, None]).all(axis=1))
    if not len(seen):
        return None
    seen = seen[np.argsort(-view.depths(bodies.centers[seen]), kind="stable")]
    discs = glyphs.discs()
    reach = reach[seen]
    verdicts = bodies.verdicts[seen]
    radii = scale * np.linalg.norm(discs.corners, axis=2).max(axis=1)[verdicts]
    shrink = np.where(reach > 0.0, np.minimum(reach / radii, 1.0), 1.0).astype(np.float32)
    points = view.place(
        bodies.centers[seen], scale * shrink[:, None, None] * discs.corners[verdicts]
    )
    first = points.shape[1] * np.arange(len(seen), dtype=np.int32)[:, None, None]
    triangles = discs.triangles[verdicts] + first
    return (
        points.reshape(-1, 3),
        discs.colors[:, verdicts].reshape(2, -1, 4),
        triangles.reshape(-1, 3),
    )
