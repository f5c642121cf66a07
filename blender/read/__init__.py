# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender in: evaluated objects as arrays, with their places and a finding for each decision."""

from .objects import read_lines, read_object, read_patches
from .reading import FaceAttributes, Part, Reading, SplineReading
from .visibility import measurable, measurable_objects, shows_flat_region

__all__ = [
    "FaceAttributes",
    "Part",
    "Reading",
    "SplineReading",
    "measurable",
    "measurable_objects",
    "read_lines",
    "read_object",
    "read_patches",
    "shows_flat_region",
]
