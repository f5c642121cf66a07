# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of an audit: findings at their places in the file, and the links that they are about."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from ..verdict import Finding, Severity, sentence, severity
from .comparison import Effect, Reference
from .stated import Place, StatedInertial, StatedLink


@dataclass(frozen=True, eq=False)
class Entry:
    """One fault of a link, or a note about it.

    finding: the fault; the change that corrects it, if there is one that explains it. reasons: why
    the stated inertial is impossible, as far as the finding explains that. change: the change that
    corrects the fault, None if unknown. certainty: "certain" if geometry and inertial then agree to
    the digits of files, "likely" if they do so after several different changes, "guess" if the
    change merely makes the inertial possible. place: of the element in the file. compares: True if
    the fault is one of the stated inertial.
    """

    finding: Finding
    place: Place
    reasons: tuple[Finding, ...] = ()
    change: Finding | None = None
    certainty: str = ""
    compares: bool = False

    @property
    def severity(self) -> Severity:
        """The severity of the finding, but an error if the inertial is impossible."""
        return Severity.ERROR if self.reasons else severity(self.finding)

    @property
    def message(self) -> str:
        """The sentences of the reasons and the finding."""
        return " ".join(map(sentence, (*self.reasons, self.finding)))


@dataclass(frozen=True, eq=False)
class LinkAudit:
    """Entries about one link. repaired: its corrected inertial, None if it stays. density: kg/m³,
    None if unknown.

    reference: the evenly filled geometry, the drawn one if it is certain; None if unknown. apart:
    the relative difference from the geometry. colliders: what the collision geometry beside the
    inertial does. is_drawn: True if the reference is the drawn geometry, or nothing is drawn.
    """

    link: StatedLink
    entries: tuple[Entry, ...]
    repaired: StatedInertial | None = None
    density: float | None = None
    reference: Reference | None = None
    apart: float = inf
    colliders: Effect | None = None
    is_drawn: bool = False

    def with_entries(self, *entries: Entry) -> LinkAudit:
        """Return the audit with further entries at its end."""
        return replace(self, entries=(*self.entries, *entries))

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, first the reasons of each entry."""
        return tuple(found for entry in self.entries for found in (*entry.reasons, entry.finding))

    @property
    def is_impossible(self) -> bool:
        """True if a finding says that no body, or none within the geometry, has the inertial."""
        return any(
            found.code.startswith("inertial_") and severity(found) == Severity.ERROR
            for found in self.findings
        )
