# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements of objects, and the records, documents and HTML pages made from them."""

from ..lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
