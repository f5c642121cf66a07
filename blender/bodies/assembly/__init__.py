# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies: sums of measured bodies and of parts with given mass."""

from typing import TYPE_CHECKING

from ....core.lazy import lazy_names

if TYPE_CHECKING:
    from . import assembly as assembly

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    assembly="assembly",
)
