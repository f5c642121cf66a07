# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a point is from triangles, in double precision.

Trees that find the nearest triangle work in single precision, and go wrong on triangles that are long and thin by as
much as their width.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def triangle_distances(point: ArrayLike, corners: NDArray) -> NDArray[np.float64]:
    """(m,) the distances of one point from (m, 3, 3) triangles: from the plane where its foot is inside the triangle,
    else from the nearest edge. Triangles without area are their edges."""
    to = np.asarray(point, np.float64) - corners
    edges = np.roll(corners, -1, axis=1) - corners
    length = np.einsum("mek,mek->me", edges, edges)
    share = np.clip(np.einsum("mek,mek->me", to, edges) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    nearest = np.linalg.norm(to - share[:, :, None] * edges, axis=2).min(axis=1)
    normal = np.cross(edges[:, 0], edges[:, 1])
    size = np.linalg.norm(normal, axis=1)
    inside = (np.einsum("mk,mek->me", normal, np.cross(edges, to)) >= 0.0).all(axis=1) & (size > 0.0)
    height = np.abs(np.einsum("mk,mk->m", normal, to[:, 0])) / np.where(size > 0.0, size, 1.0)
    return np.where(inside, np.minimum(height, nearest), nearest)
