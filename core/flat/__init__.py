# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Area moments of polygons with holes, and the section properties that engineers know."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
