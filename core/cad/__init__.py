# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""B-spline surfaces in CAD files: IGES, and .obj files with free-form surfaces."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
