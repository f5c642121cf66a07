# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Judgments of links: the faults of stated inertials, by what is possible and by geometry."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ..mesh import hull_volumes
from ..numerics import inertia_of_second, second_of_inertia
from ..verdict import Finding, finding
from .comparison import DIFFERS, LARGEST_DENSITY, Reference
from .diagnosis import Diagnosis, diagnose, diagnose_density
from .entries import Entry, LinkAudit
from .findings import (
    AUDIT_DENSITY,
    AUDIT_INSTEAD,
    AUDIT_NOT_UNIFORM,
    INERTIAL_CENTER_OUTSIDE,
    INERTIAL_NOT_FINITE,
    INERTIAL_TRIANGLE_SLIGHTLY,
    UNIFORM,
)
from .pieces import Geometry
from .plausibility import CENTER_RTOL, LEAST_MASS, Hull, impossible
from .stated import Place, StatedInertial, StatedLink


def judge(link: StatedLink, stated: StatedInertial, geometry: Geometry) -> LinkAudit:
    """Return the audit of an inertial by the geometry of its link: impossible, different by a
    mistake that a change corrects, or of an unusual density.
    """
    place = link.inertial_place
    hull = geometry.hull
    references = [*geometry.references.values()]
    reference = references[0] if references else None
    reasons = impossible(stated, hull)
    codes = {reason.code for reason in reasons}
    if not stated.mass > LEAST_MASS or INERTIAL_NOT_FINITE in codes:
        return LinkAudit(link, _plain_entries(place, reasons), reference=reference)
    slight = [reason for reason in reasons if reason.code == INERTIAL_TRIANGLE_SLIGHTLY]
    reasons = [reason for reason in reasons if reason.code != INERTIAL_TRIANGLE_SLIGHTLY]
    diagnoses = diagnose(
        stated, references, geometry.in_degrees(), INERTIAL_CENTER_OUTSIDE in codes
    )
    changes = [diagnosis for diagnosis in diagnoses if diagnosis.is_change]
    repaired = changes[-1].repaired if changes else None
    unexplained = _unexplained(reasons, changes, hull)
    explained = [reason for reason in reasons if reason not in unexplained]
    entries = (*_plain_entries(place, slight), *_diagnosis_entries(place, diagnoses, explained))
    if reference is None:
        return LinkAudit(link, (*entries, *_plain_entries(place, unexplained)), repaired)
    if unexplained:
        repaired = _guess(stated, reference, hull)
        if repaired.center is reference.center:  # The note adds nothing to errors.
            entries = tuple(entry for entry in entries if entry.finding.code != AUDIT_NOT_UNIFORM)
        # Geometry that cannot hold the mass, in kg or another unit, shows nothing about its place.
        unusual = diagnose_density(stated, reference)
        if any(not diagnosis.is_change for diagnosis in unusual):
            repaired = None
        entries = (*_guess_entries(place, unexplained, repaired), *entries)
        if unusual:
            findings = [finding(AUDIT_DENSITY, density=reference.density(stated))]
            entries = (*entries, *_plain_entries(place, findings))
    is_told = any(entry.change or entry.finding.code == AUDIT_DENSITY for entry in entries)
    if not reasons and not is_told:
        least = _least_density(stated, references, hull)
        if least > LARGEST_DENSITY:
            entries = (*entries, *_plain_entries(place, [finding(AUDIT_DENSITY, density=least)]))
    draws_any = any(shape.role == "visual" for shape, _ in geometry.pieces)
    return LinkAudit(
        link,
        entries,
        repaired,
        density=reference.density(stated),
        reference=reference,
        apart=min(each.compare(stated) for each in references),
        is_drawn="visual" in geometry.references or not draws_any,
    )


def _plain_entries(place: Place, findings: Sequence[Finding]) -> tuple[Entry, ...]:
    """Return an entry without a change for each finding about an inertial."""
    return tuple(Entry(found, place, compares=True) for found in findings)


def _unexplained(
    reasons: Sequence[Finding], changes: Sequence[Diagnosis], hull: Hull | None
) -> Sequence[Finding]:
    """Return the reasons of an impossible inertial that hold without, or in spite of, its changes.

    A change of the geometry explains all of them.
    """
    if not changes:
        return reasons
    repaired = changes[-1].repaired
    if repaired is None:
        return []
    codes = {reason.code for reason in impossible(repaired, hull)}
    return [reason for reason in reasons if reason.code in codes]


def _least_density(
    stated: StatedInertial, references: Sequence[Reference], hull: Hull | None
) -> float:
    """Return the density, kg/m³, of the stated mass in the largest geometry, or in the hull if that
    is too much: the mass may lie anywhere in it, such as a motor in a cover.
    """
    density = min(reference.density(stated) for reference in references)
    if density <= LARGEST_DENSITY or hull is None:
        return density
    # One hull, of all points.
    volume = float(hull_volumes(hull.points, np.zeros(1, np.intp), 0.0)[0])
    return min(density, stated.mass / volume) if volume > 0.0 else density


def _guess(stated: StatedInertial, reference: Reference, hull: Hull | None) -> StatedInertial:
    """Return the inertial of the evenly filled geometry, about the stated center if that is
    possible.
    """
    uniform = reference.uniform(stated.mass)
    if (
        hull is None
        or hull.distance(stated.center) > CENTER_RTOL * hull.size
        or reference.compare_centers(stated) <= DIFFERS
    ):
        return uniform
    second = second_of_inertia(uniform.inertia)
    arm = stated.center - uniform.center
    direction = arm / np.linalg.norm(arm)
    # Near the border of the hull the geometry is shrunk towards it, until it fits.
    for factor in 0.5 ** np.arange(10.0):
        shrink = np.eye(3) - (1.0 - factor) * np.outer(direction, direction)
        tensor = inertia_of_second(shrink @ second @ shrink)
        guessed = replace(uniform, center=stated.center, tensor=tensor)
        if not impossible(guessed, hull):
            return guessed
    return uniform


def _guess_entries(
    place: Place, reasons: Sequence[Finding], guessed: StatedInertial | None
) -> Sequence[Entry]:
    """Return an entry for each reason, whose change is to state a guessed inertial; without one, no
    change.
    """
    if guessed is None:
        return _plain_entries(place, reasons)
    instead = finding(AUDIT_INSTEAD, source=UNIFORM)
    return [
        Entry(reason, place, change=instead, certainty="guess", compares=True) for reason in reasons
    ]


def _diagnosis_entries(
    place: Place, diagnoses: Sequence[Diagnosis], reasons: Sequence[Finding]
) -> Iterator[Entry]:
    """Yield one entry for each diagnosis, with the reasons that it explains.

    A single change explains all of them; of two, the first is one of the center.
    """
    is_single = sum(diagnosis.is_change for diagnosis in diagnoses) == 1
    for index, diagnosis in enumerate(diagnoses):
        if not diagnosis.is_change:
            yield Entry(diagnosis.finding, place, compares=True)
            continue
        explained = [
            reason
            for reason in reasons
            if is_single or (index == 0) == (reason.code == INERTIAL_CENTER_OUTSIDE)
        ]
        yield Entry(
            diagnosis.finding,
            place,
            tuple(explained),
            change=diagnosis.finding,
            certainty="certain" if diagnosis.is_certain else "likely",
            compares=True,
        )
