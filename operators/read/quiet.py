# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""While Blender is read, or changed and put back, no change of it counts as an edit."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

_is_paused = False


@contextmanager
def paused() -> Iterator[None]:
    """No change is noted in this context: for changes that leave every object's shape as it was."""
    global _is_paused
    before, _is_paused = _is_paused, True
    try:
        yield
    finally:
        _is_paused = before


def is_paused() -> bool:
    """Whether changes that Blender reports now are not edits."""
    return _is_paused
