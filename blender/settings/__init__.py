# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Property groups, the options that override them, and their digests."""

from typing import TYPE_CHECKING

from ...core.lazy import lazy_names

if TYPE_CHECKING:
    from . import density as density
    from . import given as given
    from . import options as options

__getattr__, __dir__, __all__ = lazy_names(__name__)
