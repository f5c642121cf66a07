# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that follow edits and animation."""

from typing import TYPE_CHECKING

from ....core.lazy import lazy_names

if TYPE_CHECKING:
    from . import following as following
    from . import live as live
    from . import motion as motion
    from . import moving_surface as moving_surface

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    following="following",
    live="live",
    motion="motion",
    moving_surface="moving_surface",
)
