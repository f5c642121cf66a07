# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender in: evaluated objects as arrays, with their places and every decision taken."""

from .objects import read_object
from .reading import Painted, Part, Reading, Unreadable
from .visibility import measurable, measurable_objects

__all__ = ["Painted", "Part", "Reading", "Unreadable", "measurable", "measurable_objects", "read_object"]
