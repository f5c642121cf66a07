# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Refusals and warnings of the last action, for panels to show until the next action.

A status line is cut off and gone with the next click.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ....core.verdict.finding import Finding, Severity
from ....core.verdict.sentences import of_severity


@dataclass(frozen=True, eq=False)
class ActionOutcome:
    """Messages of one action.

    action: the operator's label, in English. findings: refusals and warnings, never empty.
    objects: full names of the objects that they are about.
    """

    action: str
    findings: tuple[Finding, ...]
    objects: tuple[str, ...]


_last: ActionOutcome | None = None


def remember(action: str, findings: Iterable[Finding]) -> None:
    """Keep the refusals and warnings of an action (an operator's label) in place of the previous ones."""
    global _last
    kept = of_severity(findings, Severity.ERROR, Severity.WARNING)
    objects = dict.fromkeys(name for finding in kept for name in _objects_of(finding))
    _last = ActionOutcome(action, tuple(kept), tuple(objects)) if kept else None


def _objects_of(finding: Finding) -> list[str]:
    """Return the names of the objects that a finding is about."""
    values = finding.values
    names = [values.get("object"), *values.get("objects", ()), *values.get("sources", ())]
    return [name for name in names if isinstance(name, str)]


def last() -> ActionOutcome | None:
    """Return the refusals and warnings of the last action, None if there were none."""
    return _last


def forget() -> None:
    """Forget the refusals and warnings of the last action."""
    global _last
    _last = None
