# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What opening a file has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.verdict.finding import Finding


@dataclass(frozen=True)
class Opened:
    """errors: what the file has, or refers to, and is not there now. notes: about all that is. by_object: about one
    object, by its name."""

    errors: tuple[Finding, ...] = ()
    notes: tuple[Finding, ...] = ()
    by_object: Mapping[str, tuple[Finding, ...]] = field(default_factory=dict)
