# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of varying density: by part, by face, as a polynomial, as a grid or spline of samples."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
