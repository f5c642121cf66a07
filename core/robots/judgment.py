# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judgments of links: the faults of stated inertials, by what is possible and by geometry."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from ..mesh import hull_volumes
from ..numerics import inertia_of_second, second_of_inertia
from ..verdict import Finding, Severity, finding, sentence, severity
from .diagnosis import DENSITIES, DIFFERS, Diagnosis, Reference, diagnose, diagnose_density
from .findings import (
    AUDIT_DENSITY,
    AUDIT_INSTEAD,
    AUDIT_NOT_UNIFORM,
    INERTIAL_CENTER_OUTSIDE,
    INERTIAL_NOT_FINITE,
    INERTIAL_TRIANGLE_SLIGHTLY,
    UNIFORM,
)
from .model import Effect
from .pieces import Geometry
from .plausibility import CENTER_RTOL, LEAST_MASS, Hull, impossible
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
    the relative difference from the geometry. is_impossible: True if no body within the geometry
    has the stated inertial. colliders: what the collision geometry beside the inertial does.
    is_drawn: True if the reference is the drawn geometry, or nothing is drawn.
    """

    link: StatedLink
    entries: tuple[Entry, ...]
    repaired: StatedInertial | None = None
    density: float | None = None
    reference: Reference | None = None
    apart: float = inf
    is_impossible: bool = False
    colliders: Effect | None = None
    is_drawn: bool = False

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, first the reasons of each entry."""
        return tuple(found for entry in self.entries for found in (*entry.reasons, entry.finding))

    @property
    def has_impossible(self) -> bool:
        """True if a finding says that no body has the inertial."""
        return any(
            one.code.startswith("inertial_") and severity(one) == Severity.ERROR
            for one in self.findings
        )


def judge(link: StatedLink, stated: StatedInertial, geometry: Geometry) -> LinkAudit:
    """Judge an inertial by the geometry of its link."""
    place = link.inertial_place
    hull = geometry.hull
    references = [*geometry.references.values()]
    reference = references[0] if references else None
    reasons = impossible(stated, hull)
    wrong = [one for one in reasons if one.code != INERTIAL_TRIANGLE_SLIGHTLY]
    entries = [Entry(one, place, compares=True) for one in reasons if one not in wrong]
    codes = {one.code for one in wrong}
    if not stated.mass > LEAST_MASS or INERTIAL_NOT_FINITE in codes:
        entries = [Entry(one, place, compares=True) for one in reasons]
        return LinkAudit(link, tuple(entries), reference=reference, is_impossible=True)
    diagnoses = diagnose(
        stated, references, geometry.in_degrees(), INERTIAL_CENTER_OUTSIDE in codes
    )
    changes = [one for one in diagnoses if one.is_change]
    repaired = changes[-1].repaired if changes else None
    left = [] if changes else wrong
    if repaired is not None:
        codes = {one.code for one in impossible(repaired, hull)}
        left = [one for one in wrong if one.code in codes]
    entries += _entries(place, diagnoses, [one for one in wrong if one not in left])
    if reference is None:
        entries += [Entry(one, place, compares=True) for one in left]
        return LinkAudit(link, tuple(entries), repaired, is_impossible=bool(wrong))
    if left:
        guessed = _guess(stated, reference, hull)
        if guessed.center is reference.center:  # It adds nothing to errors.
            entries = [one for one in entries if one.finding.code != AUDIT_NOT_UNIFORM]
        # Geometry that cannot hold the mass, in kg or another unit, shows nothing about its place.
        unusual = diagnose_density(stated, reference)
        guess = (
            finding(AUDIT_INSTEAD, source=UNIFORM)
            if all(one.is_change for one in unusual)
            else None
        )
        repaired = guessed if guess else None
        certainty = "guess" if guess else ""
        entries = [*(Entry(one, place, (), guess, certainty, True) for one in left), *entries]
        if unusual:
            density = finding(AUDIT_DENSITY, density=stated.mass / reference.volume)
            entries.append(Entry(density, place, compares=True))
    # The mass may lie anywhere in the hull: a motor in a cover.
    least = stated.mass / max(one.volume for one in references)
    if least > DENSITIES[1] and hull is not None:
        room = float(hull_volumes(hull.points, np.zeros(1, np.intp), 0.0)[0])
        least = min(least, stated.mass / room) if room > 0.0 else least
    is_told = any(one.change or one.finding.code == AUDIT_DENSITY for one in entries)
    if least > DENSITIES[1] and not wrong and not is_told:
        entries.append(Entry(finding(AUDIT_DENSITY, density=least), place, compares=True))
    return LinkAudit(
        link,
        tuple(entries),
        repaired,
        stated.mass / reference.volume,
        reference,
        min(one.compare(stated) for one in references),
        bool(wrong),
        is_drawn="visual" in geometry.references
        or all(one.role != "visual" for one, _ in geometry.pieces),
    )


def _guess(stated: StatedInertial, reference: Reference, hull: Hull | None) -> StatedInertial:
    """Return the inertial of the evenly filled geometry, about the stated center if that is
    possible.
    """
    geometry = reference.uniform(stated.mass)
    if (
        hull is None
        or hull.distance(stated.center) > CENTER_RTOL * hull.size
        or reference.compare_centers(stated) <= DIFFERS
    ):
        return geometry
    second = second_of_inertia(geometry.inertia)
    way = stated.center - geometry.center
    way = way / np.linalg.norm(way)
    # Near the border of the hull the geometry is shrunk towards it, until it fits.
    for part in 0.5 ** np.arange(10.0):
        shrink = np.eye(3) - (1.0 - part) * np.outer(way, way)
        tensor = inertia_of_second(shrink @ second @ shrink)
        guessed = replace(geometry, center=stated.center, tensor=tensor)
        if not impossible(guessed, hull):
            return guessed
    return geometry


def _entries(
    place: Place, diagnoses: Sequence[Diagnosis], explained: Sequence[Finding]
) -> list[Entry]:
    """Return one entry for each diagnosis, with the reasons that it explains: the center's, or all
    other ones.
    """
    entries = []
    is_single = sum(one.is_change for one in diagnoses) == 1
    for index, one in enumerate(diagnoses):
        if not one.is_change:
            entries.append(Entry(one.finding, place, compares=True))
            continue
        reasons = [
            reason
            for reason in explained
            if is_single or (index == 0) == (reason.code == INERTIAL_CENTER_OUTSIDE)
        ]
        certainty = "certain" if one.is_certain else "likely"
        entries.append(Entry(one.finding, place, tuple(reasons), one.finding, certainty, True))
    return entries
