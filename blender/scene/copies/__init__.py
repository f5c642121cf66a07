# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies among meshes, and the linking of their objects to one mesh."""

from ....core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, find_copies="find", link_copies="link")
