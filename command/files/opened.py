# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings about an opened file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.verdict.finding import Finding


@dataclass(frozen=True)
class Opened:
    """Findings about an opened file.

    errors: parts of the file, or references, that are missing now. notes: about the whole file. by_object: about one
    object, by its name.
    """

    errors: tuple[Finding, ...] = ()
    notes: tuple[Finding, ...] = ()
    by_object: Mapping[str, tuple[Finding, ...]] = field(default_factory=dict)
