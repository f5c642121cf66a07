# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A reading becomes a body and a measurement: one module a kind."""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import rig as rig

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    rig="rig",
)
