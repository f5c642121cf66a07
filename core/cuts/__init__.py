# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies and surfaces cut by planes: moments below them, cut and fill, levels of vessels."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
