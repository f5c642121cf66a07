# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last action refused or warned of, so that panels can show it until the next action: a status line is cut off
and gone with the next click.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ....core.verdict.finding import Finding, Severity
from ....core.verdict.sentences import of_severity
from ..tracking import handlers


@dataclass(frozen=True, eq=False)
class ActionOutcome:
    """What is to be read of one action.

    Attributes
    ----------
    action : str
        The operator's label, in English.
    findings : tuple of Finding
        Refusals and warnings, never empty.
    objects : tuple of str
        The full names of the objects that they are about.
    """

    action: str
    findings: tuple[Finding, ...]
    objects: tuple[str, ...]


_last: ActionOutcome | None = None


def remember(action: str, findings: Iterable[Finding]) -> None:
    """Keep what an action refused or warned of, in place of that of the action before.

    Parameters
    ----------
    action : str
        The operator's label.
    findings : iterable of Finding
        What is no more than a note is left out; where nothing is left, nothing is shown.
    """
    global _last
    kept = of_severity(findings, Severity.ERROR, Severity.WARNING)
    objects = dict.fromkeys(name for finding in kept for name in _objects_of(finding))
    _last = ActionOutcome(action, tuple(kept), tuple(objects)) if kept else None


def _objects_of(finding: Finding) -> list[str]:
    """The names of the objects that a finding is about."""
    values = finding.values
    names = [values.get("object"), *values.get("objects", ()), *values.get("sources", ())]
    return [name for name in names if isinstance(name, str)]


def last() -> ActionOutcome | None:
    """Return what the last action refused or warned of, None where that was nothing."""
    return _last


def forget() -> None:
    """Show it no more."""
    global _last
    _last = None


def register() -> None:
    """Forget it when another file is opened."""
    handlers.on_load.append(forget)


def unregister() -> None:
    """Forget it for good."""
    handlers.on_load.remove(forget)
    forget()
