# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists that are cut and counted."""

from __future__ import annotations

from collections.abc import Iterable

LISTED = 3  # failures that a report names before it only counts


def listed(texts: Iterable[str], most: int = LISTED) -> list[str]:
    """The first ones, and how many more there are."""
    texts = list(texts)
    more = ["and {:d} more".format(len(texts) - most)] if len(texts) > most else []
    return texts[:most] + more
