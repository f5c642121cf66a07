# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat bodies: regions of a plane, their Fourier transforms and shapes."""

from ....core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
