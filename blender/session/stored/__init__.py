# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of an open file: stored on objects or cached, one module per kind of result."""

from typing import TYPE_CHECKING

from ....core.lazy import lazy_names

if TYPE_CHECKING:
    from . import sliders as sliders

__getattr__, __dir__, __all__ = lazy_names(__name__, compute_moments="moments")
