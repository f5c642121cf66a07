# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters: their weight as they are posed, their balance, and their motion over frames."""

from ....core.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    CharacterMotion="flight",
    balance_pose="balance",
)
