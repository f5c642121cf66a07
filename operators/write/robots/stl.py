# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of links as binary STL, which all readers of robots know."""

from __future__ import annotations

import numpy as np

from ....core.mesh.surface import Surface

MAX_TRIANGLES = 200_000  # of a mesh in MuJoCo
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def to_stl(surface: Surface) -> bytes:
    """Return a surface as binary STL, with zero normals, which readers find from the corners.

    Parameters
    ----------
    surface : Surface
        In meters, along the link's axes.

    Returns
    -------
    bytes
    """
    triangles = surface.all_triangles()[0]
    rows = np.zeros(len(triangles), _TRIANGLE)
    rows["corners"] = surface.points[triangles]
    return b"Body Moments".ljust(80, b"\0") + np.uint32(len(rows)).astype("<u4").tobytes() + rows.tobytes()
