# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The view being drawn: screen positions of points of the world, and pixel sizes there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


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
