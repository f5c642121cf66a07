# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in files that are larger than memory, measured in blocks."""

from .measure import StreamIntegrals, measure_stream
from .mesh_file import open_mesh_file

__all__ = [
    "StreamIntegrals",
    "measure_stream",
    "open_mesh_file",
]
