# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""B-spline surfaces in CAD files: IGES, and .obj files with free-form surfaces."""

from .surface_file import SurfaceBody, SurfaceFile, read_surfaces

__all__ = [
    "SurfaceBody",
    "SurfaceFile",
    "read_surfaces",
]
