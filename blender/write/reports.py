# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings as operators show them: reports, reasons why a button is off, the status bar.

Sentences are in the language of the interface and lengths in the scene's units.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy
from bpy.types import Operator

from ...core.verdict import internal_error
from ...core.verdict.finding import Finding, MeasureError, Severity, finding, truncate_findings
from ...core.verdict.sentences import sentence, severity
from .findings import FAILURE, REFUSED
from .units import Units

MAX_REPORTED = 3  # findings of one kind that a report names before it only counts
LEVELS = {Severity.NOTE: "INFO", Severity.WARNING: "WARNING", Severity.ERROR: "ERROR"}


def text(*findings: Finding) -> str:
    """Return the sentences of findings, one after the other."""
    joined = ""
    for added in [sentence(shown, bpy.app.translations.pgettext_rpt, _length) for shown in findings]:
        between = " " if joined.endswith(".") else ". " if added.endswith(".") else "; "
        joined += between + added if joined else added
    return joined


def _length(meters: float) -> str:
    return Units.from_settings(bpy.context.scene.unit_settings).text("length", meters)


def _rank(shown: Finding) -> int:
    return tuple(Severity).index(severity(shown))


def report(operator: Operator, *findings: Finding) -> None:
    """Report findings at once, as severe as the most severe of them."""
    worst = findings[0] if len(findings) == 1 else max(findings, key=_rank)
    operator.report({LEVELS[severity(worst)]}, text(*findings))


def unavailable(operator: type[Operator], reason: Finding) -> bool:
    """Return False from `poll`, with this reason."""
    operator.poll_message_set(text(reason))
    return False


def first(findings: Sequence[Finding]) -> list[Finding]:
    """Return the first of the most severe findings, and how many more there are."""
    return truncate_findings(sorted(findings, key=_rank, reverse=True), MAX_REPORTED)


def failure(name: str, reason: Finding | Exception) -> Finding:
    """Return the finding that one of several objects was left as it is: it was refused, or this program failed."""
    cause = reason if isinstance(reason, Finding) else internal_error.finding_of(reason)
    return finding(FAILURE, object=name, cause=cause.as_record())


def refusal(error: MeasureError) -> Finding:
    """Return the reason why an operator does nothing at all."""
    if not error.subject:
        return error.finding
    return finding(REFUSED, object=error.subject, cause=error.finding.as_record())
