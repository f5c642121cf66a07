# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The trust in numbers: the one verdict that panel, overlay, list, report and record show. Loads no numpy."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

from .catalog import declared
from .finding import Finding, Severity, finding
from .findings import TOTAL_OF_OPEN_OBJECTS
from .method import Method, Verdict
from .sentences import severity

REPAIRED = (Verdict.CAPPED, Verdict.REORIENTED)


class Trust(StrEnum):
    """Trust in numbers, the best first."""

    EXACT = "exact"
    REPAIRED = "repaired"
    DOUBTFUL = "doubtful"
    OUT_OF_DATE = "out of date"


def trust_of(method: Method | None, findings: Iterable[Finding]) -> Trust:
    """Return the trust in numbers that are up to date, by their method and findings."""
    warnings = [declared(found.code) for found in findings if severity(found) != Severity.NOTE]
    if method is None or method.verdict == Verdict.OPEN or not all(code.is_repair for code in warnings):
        return Trust.DOUBTFUL
    return Trust.REPAIRED if warnings or method.verdict in REPAIRED else Trust.EXACT


def open_body_caveats(methods: Iterable[tuple[str, Method | None]]) -> list[Finding]:
    """Return caveats about open bodies, given as names and methods: their own numbers depend on a reference point."""
    methods = list(methods)
    names = sorted(name for name, method in methods if method is not None and method.verdict == Verdict.OPEN)
    return [finding(TOTAL_OF_OPEN_OBJECTS, objects=names)] if names and len(methods) > 1 else []
