# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The verdict on numbers, which panel, overlay, list, report and record show. It loads no numpy."""

from collections.abc import Iterable
from enum import StrEnum

from .catalog import declared
from .finding_types import Finding, Severity, finding
from .findings import TOTAL_OF_OPEN_OBJECTS
from .method import Method, Procedure
from .sentences import severity

REPAIRED = (Procedure.CAPPED, Procedure.REORIENTED)


class Verdict(StrEnum):
    """How far numbers can be trusted, the best first."""

    EXACT = "exact"
    REPAIRED = "repaired"
    DOUBTFUL = "doubtful"
    OUT_OF_DATE = "out of date"
    INCOMPLETE = "incomplete"  # a total without the numbers of some of its objects


def find_verdict(method: Method | None, findings: Iterable[Finding]) -> Verdict:
    """Return the verdict on up-to-date numbers, by their method and findings."""
    warnings = [declared(item.code) for item in findings if severity(item) != Severity.NOTE]
    if method is None or method.procedure == Procedure.OPEN:
        return Verdict.DOUBTFUL
    if not all(code.is_repair for code in warnings):
        return Verdict.DOUBTFUL
    return Verdict.REPAIRED if warnings or method.procedure in REPAIRED else Verdict.EXACT


def open_body_caveats(methods: Iterable[tuple[str, Method | None]]) -> list[Finding]:
    """Return caveats about open bodies, given as names and methods: their own numbers depend on a
    reference point.
    """
    methods = list(methods)
    names = sorted(
        name
        for name, method in methods
        if method is not None and method.procedure == Procedure.OPEN
    )
    return [finding(TOTAL_OF_OPEN_OBJECTS, objects=names)] if names and len(methods) > 1 else []
