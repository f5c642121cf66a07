# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes of bodies: pose, symmetry and signature, alone and in stacks."""

from ....core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
