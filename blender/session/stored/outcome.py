# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Refusals of the last action, for panels to show until the next selection, undo or successful
action.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import bpy

from ....core.verdict import Finding, Group, Severity, grouped, severity
from ...write.findings import FAILURE
from .. import memory


class ActionOutcome(NamedTuple):
    """Refusals of one action, never empty. action: the operator's label, in English."""

    action: str
    groups: tuple[Group, ...]


def remember(action: str, findings: Iterable[Finding]) -> None:
    """Keep the refusals of an action, in place of the previous action's. action: the operator's
    label.
    """
    groups = grouped(
        _refused(finding)
        for finding in findings
        if finding.code == FAILURE or severity(finding) == Severity.ERROR
    )
    memory.state.outcome = ActionOutcome(action, tuple(groups)) if groups else None
    memory.state.outcome_seen_in = ()


def _refused(finding: Finding) -> tuple[str, Finding]:
    """Return the full name of the refused object, or "", and the reason."""
    if finding.code != FAILURE:
        return "", finding
    return finding.values["object"], Finding.from_record(finding.values["cause"])


def last() -> ActionOutcome | None:
    """Return the refusals of the last action, None if there were none, or after another selection
    or action: the first call notes the selection and action at which they are shown.
    """
    if memory.state.outcome is not None:
        layer = bpy.context.view_layer
        actions = bpy.context.window_manager.operators
        state = (
            getattr(layer.objects.active, "session_uid", 0),
            tuple(obj.session_uid for obj in layer.objects.selected),
            actions[-1].as_pointer() if actions else 0,
        )
        if memory.state.outcome_seen_in not in ((), state):
            forget()
        memory.state.outcome_seen_in = state
    return memory.state.outcome


def forget() -> None:
    """Forget the refusals of the last action."""
    memory.state.outcome = None
