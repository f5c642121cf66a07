# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The one change that makes a stated inertial agree with its geometry.

A link's geometry, filled evenly, has a center and an inertia for each kilogram. If the stated
values differ, each of a list of common mistakes is undone; agreement to the digits of files is no
coincidence. If none agrees, the mass may be distributed unevenly: that is no error, and only noted
with the factor of the inertia.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..verdict import Finding, finding
from .comparison import AGREES, DIFFERS, Reference, is_possible
from .findings import AUDIT_DENSITY, AUDIT_UNIT
from .mistakes import (
    ALL_AGREE,
    CENTERS_AGREE,
    INCH,
    LENGTHS,
    WHOLE_POUNDS,
    Change,
    center_changes,
    changes,
    scaled,
)
from .stated import StatedInertial

BETTER = 0.1  # A change counts if it leaves less than this part of the difference.
ROUNDING = 1e-9  # Relative differences below are none, and do not choose between changes.
SAME = 1e-6  # Relative difference below which two changes lead to one inertial.
# kg/m³, typical range; a change that only the density shows must lead into it.
LEAST_USUAL_DENSITY = 100.0
LARGEST_USUAL_DENSITY = 12_000.0


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Diagnosis of an inertial: a finding that names the change, and the corrected inertial, None
    if it stays.

    is_of_geometry: True if the geometry has to change. is_certain: False if another change would
    agree as well.
    """

    finding: Finding
    repaired: StatedInertial | None = None
    is_of_geometry: bool = False
    is_certain: bool = True

    @property
    def is_change(self) -> bool:
        """True if something has to change; False for a mere note."""
        return self.repaired is not None or self.is_of_geometry


class Fit(NamedTuple):
    """A change after which an inertial agrees with a reference. apart: the difference that is
    left, relative.
    """

    change: Change
    reference: Reference
    apart: float


def diagnose(
    stated: StatedInertial,
    references: Sequence[Reference],
    otherwise: Iterable[tuple[Finding, Reference]] = (),
    center_is_wrong: bool = False,
) -> list[Diagnosis]:
    """Return the changes that correct an inertial, or a note about the place of the mass; empty if
    it agrees.

    That is one change, or one of the center with one of the rest or the note; each has the inertial
    corrected so far. references: candidates for the geometry, such as visual and collision shapes.
    otherwise: geometries with a corrected fault of the description, each with its finding.
    center_is_wrong: True if a change of the center alone is certain.
    """
    if not references:
        return []
    nearest = min(references, key=lambda reference: reference.compare(stated))
    if nearest.compare(stated) <= DIFFERS:
        return diagnose_density(stated, nearest)
    for fault, geometry in otherwise:
        if geometry.compare(stated) < AGREES:
            return [Diagnosis(fault, is_of_geometry=True)]
    single = _best_change(stated, references)
    if single is not None:
        return [single]
    for center in _likeliest_center_changes(stated, references):
        rest = _best_change(center.repaired, references)
        if rest is not None:
            return [Diagnosis(*center), rest]
        if center_is_wrong:
            note = _note_uneven(center.repaired, nearest)
            return [Diagnosis(*center, is_certain=False), note]
    return [_note_uneven(stated, nearest)]


def _note_uneven(stated: StatedInertial, reference: Reference) -> Diagnosis:
    effect = reference.effect(stated, reference.volume)
    return Diagnosis(reference.describe_effect(stated, effect, "geometry"))


def _best_change(stated: StatedInertial, references: Sequence[Reference]) -> Diagnosis | None:
    """Return the one change after which an inertial agrees with a reference, None if there is
    none.
    """
    limit = min(AGREES, BETTER * min(reference.compare(stated) for reference in references))
    fits: list[Fit] = []
    best: Fit | None = None
    for reference in references:
        for change in changes(stated, reference):
            apart = reference.compare(change.repaired)
            if not apart < limit:
                continue
            fit = Fit(change, reference, apart)
            fits.append(fit)
            # Likelier changes come first: only a much better fit takes their place.
            if best is None or max(apart, ROUNDING) < BETTER * best.apart:
                best = fit
    if best is None:
        return None
    diagnosis = _diagnose_fit(best, stated)
    return replace(diagnosis, is_certain=_is_certain(diagnosis, fits))


def _diagnose_fit(fit: Fit, stated: StatedInertial) -> Diagnosis:
    """Return the diagnosis of a change. If it is one of all lengths, the density shows whether
    those of the mesh are wrong instead.
    """
    change, reference, _ = fit
    if change.finding.values.get("part") != LENGTHS:
        return Diagnosis(*change)
    factor = change.finding.values["factor"]
    # Both densities cannot be in the range: its ends differ by a factor of 3000, and the cube of
    # the least factor, that of inches, is 61,000.
    if is_possible(reference.density(stated) * factor**3):
        part = "lengths of the mesh"
        of_mesh = finding(AUDIT_UNIT, part=part, factor=1.0 / factor, agree=ALL_AGREE)
        return Diagnosis(of_mesh, is_of_geometry=True)
    if factor == INCH:  # Programs that state inches state pounds.
        return Diagnosis(*WHOLE_POUNDS.change(stated))
    return Diagnosis(*change)


def _is_certain(diagnosis: Diagnosis, fits: Sequence[Fit]) -> bool:
    """Return whether all changes that fit lead to the inertial of a diagnosis, in one order."""
    # A density that no robot has excludes a change, if another one leads to a possible density.
    possible = [
        fit for fit in fits if is_possible(fit.reference.density(fit.change.repaired))
    ] or fits
    inertials = [fit.change.repaired for fit in possible]
    # Inertials per kg agree, but the masses need not.
    masses = [inertial.mass for inertial in inertials]
    if max(masses) > (1.0 + DIFFERS) * min(masses):
        return False
    # Equal moments have no order of their own.
    part = diagnosis.finding.values.get("part")
    values = [fit.change.finding.values for fit in possible]
    if len({each.get("order") for each in values if each.get("part") == part}) > 1:
        return False
    if diagnosis.repaired is None:
        return True
    repaired = Reference.of_inertial(diagnosis.repaired)
    return all(repaired.compare(inertial) <= SAME for inertial in inertials)


def _likeliest_center_changes(
    stated: StatedInertial, references: Sequence[Reference]
) -> Iterator[Change]:
    """Yield the first change for each reference that corrects a wrong center alone."""
    for reference in references:
        if reference.compare_centers(stated) <= DIFFERS:
            continue
        for change in center_changes(stated, reference, CENTERS_AGREE):
            if reference.compare_centers(change.repaired) < AGREES:
                yield change
                break


def diagnose_density(stated: StatedInertial, reference: Reference) -> list[Diagnosis]:
    """Diagnose an unusual density of an inertial, such as a wrong unit of the mass; empty if it is
    usual.
    """
    density = reference.density(stated)
    if is_possible(density):
        return []
    for factor in (1e-3, 1e3):
        if LEAST_USUAL_DENSITY <= density * factor <= LARGEST_USUAL_DENSITY:
            unit = finding(
                AUDIT_UNIT,
                part="mass and inertia",
                factor=factor,
                density=density,
                agree=ALL_AGREE,
            )
            repaired = scaled(stated, mass=factor, inertia=factor)
            return [Diagnosis(unit, repaired, is_certain=False)]
    return [Diagnosis(finding(AUDIT_DENSITY, density=density))]
