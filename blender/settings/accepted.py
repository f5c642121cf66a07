# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings that the user has accepted, by object and code.

An accepted warning counts as a note in the panel, in stored results and in records.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import replace

from bpy.types import Object

from ...core.verdict import Finding

ACCEPTED = "accepted"  # name of the value that marks an accepted finding


def accepted_codes(obj: Object) -> frozenset[str]:
    """Return the codes that were accepted for an object."""
    return frozenset(obj.body_moments.accepted.split())


def set_accepted(obj: Object, code: str, accepted: bool) -> bool:
    """Accept the findings with a code for an object, or revoke this; return whether anything
    changed.
    """
    before = accepted_codes(obj)
    after = before | {code} if accepted else before - {code}
    if after != before:
        obj.body_moments.accepted = " ".join(sorted(after))
    return after != before


def with_acceptance(findings: Iterable[Finding], codes: Collection[str]) -> tuple[Finding, ...]:
    """Return the findings, marked as accepted exactly if `codes` contains their code."""
    return tuple(_marked(finding, finding.code in codes) for finding in findings)


def _marked(finding: Finding, accepted: bool) -> Finding:
    if accepted == (ACCEPTED in finding.values):
        return finding
    others = {name: value for name, value in finding.values.items() if name != ACCEPTED}
    return replace(finding, values=(others | {ACCEPTED: True}) if accepted else others)
