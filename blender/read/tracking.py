# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A pause in the tracking of edits, during readings and temporary changes."""

from contextlib import ContextDecorator


class tracking_paused(ContextDecorator):
    """Note no change while the block or function runs: for changes that leave every object's shape
    as it was.
    """

    depth = 0

    def __enter__(self) -> None:
        tracking_paused.depth += 1

    def __exit__(self, *_error: object) -> None:
        tracking_paused.depth -= 1
