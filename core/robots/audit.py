# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions judged by their own geometry: stated inertials beside measured meshes; and
repaired copies.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf, pi, radians
from pathlib import Path
from typing import Any

import numpy as np

# Robots without meshes start without the modules of these packages.
from .. import solid
from ..inertia import combine
from ..mesh import Surface, hull_volumes
from ..moments import Moments
from ..moments.moments import SECOND_MOMENT_INDEX
from ..numerics import Array, NDArray, first_occurrence, inertia_of_second, second_of_inertia
from ..verdict import (
    Finding,
    MeasureError,
    Procedure,
    Severity,
    finding,
    internal_error,
    sentence,
    severity,
)
from . import read
from .diagnosis import DENSITIES, DIFFERS, Diagnosis, Reference, diagnose, diagnose_density
from .findings import (
    AUDIT_ANGLES,
    AUDIT_COPIED,
    AUDIT_DENSITY,
    AUDIT_NOT_UNIFORM,
    AUDIT_OVERRIDDEN,
    AUDIT_TWIN_INSTEAD,
    AUDIT_TWINS,
    AUDIT_UNIFORM_INSTEAD,
    AUDIT_UP_AXIS,
    INERTIAL_CENTER_OUTSIDE,
    INERTIAL_MISSING,
    INERTIAL_NOT_FINITE,
    INERTIAL_OF_FRAME,
    INERTIAL_TRIANGLE_SLIGHTLY,
)
from .formats import FORMATS
from .model import Effect, Pose, Shape, second_moments
from .plausibility import CENTER_RTOL, LEAST_MASS, Hull, impossible, spread_directions
from .primitives import primitive_moments
from .read.descriptions import Roots
from .read.mjcf_meshes import CLOSED
from .stated import Description, Place, StatedInertial, StatedLink, StatedShape, rotation_of_angles
from .totals import Body, Expectation, Totals, Tree, add_up, build_tree
from .twins import TOLERANCE, disagreement, find_copies, find_pairs, images, mapped

BALL = 2000  # points of a ball
MOST_POINTS = 10_000_000  # points of measured meshes that are kept for other links and files
ROUND = 1.01  # Factor that encloses a round shape, of which only some points are known.
RELIABLE = (Procedure.EXACT, Procedure.REORIENTED, Procedure.CAPPED)


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

    geometry: the inertial of the evenly filled geometry with the stated mass, with 1 kg if that is
    no mass, None if unknown. volume: of the geometry, m³, 0 if unknown.
    apart: the relative difference from it. is_impossible: True if no body within the geometry has
    the stated inertial. colliders: what the collision geometry beside the inertial does. is_drawn:
    True if the geometry is the drawn one, or nothing is drawn.
    """

    link: StatedLink
    entries: tuple[Entry, ...]
    repaired: StatedInertial | None = None
    density: float | None = None
    geometry: StatedInertial | None = None
    apart: float = inf
    is_impossible: bool = False
    colliders: Effect | None = None
    volume: float = 0.0
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


@dataclass(frozen=True, eq=False)
class Audit:
    """Findings about a description. entries: about the whole of it."""

    description: Description
    links: tuple[LinkAudit, ...]
    tree: Tree
    totals: Totals
    entries: tuple[Entry, ...] = ()

    def repairs(self) -> list[tuple[StatedLink, StatedInertial]]:
        """Return the links with a corrected inertial, if the file itself holds the inertial."""
        found = {  # Copies of a body have one inertial in the file.
            one.link.span: (one.link, one.repaired)
            for one in self.links
            if one.link.span is not None and one.repaired is not None
        }
        return [*found.values()]


@dataclass(frozen=True, eq=False)
class _Piece:
    """A measured shape in its own coordinates: hull points, moments if certain, the rotation to z
    up, if any, and the moments of the mass that it states, kg, if any.
    """

    points: Array
    moments: Moments | None
    upright: Array | None = None
    mass: Moments | None = None

    def turned(self) -> _Piece:
        """Return the piece rotated so that the up axis of its mesh file becomes z."""
        return self if self.upright is None else self.placed(Pose(rotation=self.upright))

    def placed(self, pose: Pose) -> _Piece:
        """Return the piece in the coordinates in which its own have a pose."""
        moments, mass = (
            None if one is None else one.transform(pose.matrix) for one in (self.moments, self.mass)
        )
        return _Piece(pose.apply(self.points), moments, mass=mass)


Pieces = dict[str, list[tuple[StatedShape, _Piece]]]


@dataclass
class Auditor:
    """An auditor of descriptions, which measures each mesh once, even if several links name it.

    joints: positions of joints by name, radians or meters. meshes: measured meshes, which auditors
    may share.
    """

    roots: Roots
    joints: Mapping[str, float] = field(default_factory=dict)
    expected: Expectation = Expectation()
    meshes: dict[tuple, _Piece] = field(default_factory=dict)

    def audit(self, description: Description) -> Audit:
        """Return the findings about each link of a description."""
        links = [self._use_rules(link) for link in description.links]
        masses = [0.0 if link.inertial is None else link.inertial.mass for link in links]
        pairs = [*zip(description.links, links)]
        is_known = all(stated is not link for stated, link in pairs)
        factor = 1.0
        if description.total > 0.0 and is_known and sum(masses) > 0.0:
            factor = description.total / sum(masses)
        used = [_scaled(stated, link, factor) for stated, link in pairs]
        tree = build_tree(description, self.joints)
        alone = [self._link_alone(link) for link in used]
        pairs = _twins(alone, build_tree(description, {}) if self.joints else tree)
        for first, second, maps in pairs:
            _repair_by_twin(alone, first, second, maps)
        audits = [self._sure(one) for one in alone]
        _compare_twins(audits, pairs)
        totals = add_up(tree, [(one.link, one.has_impossible) for one in audits])
        about = [*tree.findings, *((one, Place()) for one in self.expected.check(totals.whole))]
        return Audit(description, tuple(audits), tree, totals, tuple(Entry(*one) for one in about))

    def _use_rules(self, link: StatedLink) -> StatedLink:
        """Return a link with the inertial that its format's program uses; the stated one if masses
        of shapes are unknown.
        """
        if link.rules is None:
            return link
        try:
            inertial = link.inertial
            masses = []
            if any(shape.weight for shape in link.shapes):
                pieces, unread = self._pieces(link.shapes)
                is_open = any(
                    one.weight and one.weight.inertia == CLOSED and piece.moments is None
                    for several in pieces.values()
                    for one, piece in several
                )
                if unread or link.findings or is_open:
                    return link
                masses = [
                    (_weighed(one, piece.mass), 1.0)
                    for several in pieces.values()
                    for one, piece in several
                    if piece.mass is not None
                ]
            if masses:
                body = combine(masses)
                inertial = StatedInertial(body.mass, body.center, body.inertia)
            if inertial is None or masses:
                inertial = link.rules.complete(inertial)
            is_stated = link.rules.mass > 0.0 and link.rules.moments is not None
            used = link.rules.bound(inertial)
            return replace(link, inertial=used, from_shapes=bool(masses) and not is_stated)
        except Exception:  # An unforeseen error returns when the link is audited.
            return link

    def _link_alone(self, link: StatedLink) -> LinkAudit:
        """Return the findings about one link; an unforeseen error is one of them, and ends nothing
        else.
        """
        try:
            return self._link(link)
        except Exception as error:
            return LinkAudit(
                link, (*_read_entries(link), Entry(internal_error.finding_of(error), link.place))
            )

    def _sure(self, audit: LinkAudit) -> LinkAudit:
        """Return the audit of a link without a repair that would itself have a new finding."""
        if audit.repaired is None:
            return audit
        again = self._link_alone(replace(audit.link, inertial=audit.repaired, overridden=None))
        new = {one.code for one in again.findings} - {one.code for one in audit.findings}
        return replace(audit, repaired=None) if new else audit

    def _link(self, link: StatedLink) -> LinkAudit:
        entries = _read_entries(link)
        place = link.inertial_place
        inertial = link.inertial
        if inertial is None:
            if link.moves and not entries:
                entries.append(Entry(finding(INERTIAL_MISSING), link.place))
            if any(shape.weight for shape in link.shapes):
                entries += self._pieces(link.shapes)[1]
            return LinkAudit(link, tuple(entries))
        if not link.shapes and not inertial.mass and not inertial.tensor.any():
            return LinkAudit(link, (*entries, Entry(finding(INERTIAL_OF_FRAME), place)))
        pieces, unread = self._pieces(link.shapes)
        # entries of the reader: about shapes, as there is an inertial
        incomplete = bool(unread or entries)
        entries += unread
        entries += _describe_overridden(link, inertial)
        if link.from_shapes:
            reasons = impossible(inertial, None)
            entries += [Entry(one, place) for one in reasons]
            volume = sum(
                piece.moments.raw[0]
                for several in pieces.values()
                for one, piece in several
                if one.weight and one.weight.inertia != "shell" and piece.mass and piece.moments
            )
            density = float(inertial.mass / volume) if volume else None
            if density and not reasons and not DENSITIES[0] <= density <= DENSITIES[1]:
                entries.append(Entry(finding(AUDIT_DENSITY, density=density), place))
            return LinkAudit(link, tuple(entries), density=density)
        found = _judge(link, inertial, pieces, incomplete)
        if any(piece.upright is not None for several in pieces.values() for _, piece in several):
            turned = {
                role: [(one, piece.turned()) for one, piece in several]
                for role, several in pieces.items()
            }
            other = _judge(link, inertial, turned, incomplete)
            agrees = other.apart <= min(DIFFERS, found.apart / 2.0)
            if not other.is_impossible and (found.is_impossible or agrees):
                found = other
                entries.append(Entry(finding(AUDIT_UP_AXIS), place))
                pieces = turned
        entries += found.entries
        drawn, collision = (_reference(pieces.get(role, ())) for role in ("visual", "collision"))
        effect = None
        stated = found.repaired or inertial
        if (
            collision is not None
            and not incomplete
            and (found.repaired is not None or not found.is_impossible)
        ):
            effect = collision.effect(stated, None if drawn is None else drawn.volume)
            if drawn is not None and collision.compare(stated) > max(
                DIFFERS, drawn.compare(stated)
            ):
                note = collision.describe_effect(stated, effect, "collision geometry")
                entries.append(Entry(note, place, compares=True))
        return replace(found, entries=tuple(entries), colliders=effect)

    def _pieces(self, shapes: Iterable[StatedShape]) -> tuple[Pieces, list[Entry]]:
        """Return the measured shapes by role, and entries about shapes that cannot be measured."""
        pieces: Pieces = {}
        unread: list[Entry] = []
        for stated in shapes:
            try:
                piece = self._piece(stated)
            except MeasureError as error:
                if error.finding not in [entry.finding for entry in unread]:
                    unread.append(Entry(error.finding, stated.place))
                continue
            pieces.setdefault(stated.role, []).append((stated, piece))
        return pieces, unread

    def _piece(self, stated: StatedShape) -> _Piece:
        """Return a measured shape in its own coordinates; raise MeasureError if its mesh cannot be
        read.
        """
        shape = stated.shape
        weight = stated.weight
        if shape.kind != "mesh":
            piece = _primitive(shape)
            return replace(piece, mass=weight.moments(shape)) if weight else piece
        # Meshes of an included SDF model or an attached one of MJCF are beside its file.
        roots = self.roots.at(Path(stated.beside).parent) if stated.beside else self.roots
        source = shape.surface or roots.find(shape.file)
        key = source, shape.size, stated.fit, weight
        piece = self.meshes.get(key)
        if piece is None:
            surface, upright = (
                read.meshes.read_mesh(source) if isinstance(source, Path) else (source, None)
            )
            surface = surface.transform(np.diag(shape.size))
            fit = stated.fit.shape(surface) if stated.fit else None
            piece = _measured(surface, upright) if fit is None else _primitive(fit)
            if weight:
                filled = replace(shape, surface=surface) if fit is None else fit
                if weight.inertia != CLOSED:
                    piece = replace(piece, mass=weight.moments(filled))
                elif piece.moments is not None:
                    piece = replace(piece, mass=weight.fill(piece.moments))
            piece = piece if fit is None else piece.placed(fit.pose)
            if sum(len(one.points) for one in [*self.meshes.values()]) > MOST_POINTS:
                self.meshes.clear()
            self.meshes[key] = piece
        return piece


def _twins(audits: Sequence[LinkAudit], tree: Tree) -> list[tuple[int, int, list[Pose]]]:
    """Return the indices of twins, and the maps of the first to the second."""
    pairs, plane = find_pairs(audits, tree)
    found = []
    for pair in pairs:
        first, second = (audits[index] for index in pair[:2])
        maps = images(first, second, pair, tree, plane)
        if maps is not None:
            found.append((pair.first, pair.second, maps))
    return found


def _repair_by_twin(audits: list[LinkAudit], first: int, second: int, maps: list[Pose]) -> None:
    """Give an impossible inertial that has no likelier repair that of its twin, if that is
    possible.
    """
    for own, other, pose in ((first, second, maps[0].inverse()), (second, first, maps[0])):
        audit, twin = audits[own], audits[other].link
        is_guess = all(one.certainty in ("", "guess") for one in audit.entries)
        is_right = not audits[other].has_impossible and not any(
            one.change for one in audits[other].entries
        )
        if not (audit.has_impossible and is_right and is_guess):
            continue
        assert twin.inertial is not None
        change = finding(AUDIT_TWIN_INSTEAD, twin=twin.name)
        entries = [
            replace(one, change=change, certainty="guess")
            if one.compares and one.severity == Severity.ERROR
            else one
            for one in audit.entries
        ]
        # What is noted of the twin holds for the repair, too.
        known = {one.finding.code for one in entries}
        entries += [
            replace(one, place=audit.link.inertial_place)
            for one in audits[other].entries
            if one.finding.code == AUDIT_NOT_UNIFORM and AUDIT_NOT_UNIFORM not in known
        ]
        is_in_file = audit.link.span is not None
        repaired = mapped(twin.inertial, pose) if is_in_file else None
        audits[own] = replace(audit, entries=tuple(entries), repaired=repaired)


def _compare_twins(audits: list[LinkAudit], pairs: Sequence[tuple[int, int, list[Pose]]]) -> None:
    """Add findings about twins that disagree, as stated or with their repairs, and about copies."""
    for first, second, maps in pairs:
        one, other = audits[first], audits[second]
        states = [(one.repaired or one.link.inertial, other.repaired or other.link.inertial)]
        if not one.has_impossible and not other.has_impossible:
            states.insert(0, (one.link.inertial, other.link.inertial))
        for left, right in states:
            if left is None or right is None or not min(left.mass, right.mass) > LEAST_MASS:
                continue
            part, apart = disagreement(left, right, maps)
            if apart > TOLERANCE:
                names = {"first": one.link.name, "second": other.link.name}
                values: dict[str, Any] = {"part": part, "apart": apart, **names}
                entry = Entry(finding(AUDIT_TWINS, **values), one.link.inertial_place)
                audits[first] = replace(one, entries=(*one.entries, entry))
                break
    for group in find_copies(audits):
        names = [audits[index].link.name for index in group]
        one = audits[group[0]]
        entry = Entry(finding(AUDIT_COPIED, links=names), one.link.inertial_place, compares=True)
        audits[group[0]] = replace(one, entries=(*one.entries, entry))


def _weighed(shape: StatedShape, mass: Moments) -> Moments:
    """Return the moments of a shape's mass in its link, with what is stated of them."""
    placed = mass.transform(shape.shape.pose.matrix)
    if shape.rules is None:
        return placed
    own = combine([(placed, 1.0)])
    body = shape.rules.complete(StatedInertial(own.mass, own.center, own.inertia))
    assert body is not None
    return second_moments(body.mass, body.center, second_of_inertia(body.inertia), placed.measure)


def _scaled(stated: StatedLink, link: StatedLink, factor: float) -> StatedLink:
    """Return a link with the used inertial times a factor, and the stated one if that is not
    used.
    """
    used = link.inertial
    if used is not None and factor != 1.0:
        used = replace(used, mass=used.mass * factor, tensor=used.tensor * factor)
    if used is stated.inertial:
        return stated
    if link.rules and link.rules.moments is not None and not link.from_shapes:
        return replace(link, inertial=used)  # Only a center that is not stated is the colliders'.
    return replace(link, inertial=used, overridden=stated.inertial, span=None)


def _describe_overridden(link: StatedLink, used: StatedInertial) -> list[Entry]:
    """Return the entry about a stated inertial that the format's program does not use, empty if
    there is none.
    """
    stated = link.overridden
    if stated is None:
        return []
    apart = inf
    if used.mass > 0.0 and stated.mass > 0.0:
        apart = Reference(1.0, used.center, used.inertia / used.mass).compare(stated)
    if link.from_shapes:
        apart = max(apart, abs(stated.mass / used.mass - 1.0))
    is_newton = link.rules is None or link.rules.moments is not None
    if is_newton and apart <= DIFFERS:
        return []
    first, second, third = np.linalg.eigvalsh(used.inertia).tolist()
    found = finding(
        AUDIT_OVERRIDDEN,
        slight=apart <= DIFFERS,
        program="Newton" if is_newton else "MuJoCo",
        cause="newton:inertia" if is_newton else "<compiler>",
        mass=used.mass,
        first=first,
        second=second,
        third=third,
    )
    return [Entry(found, link.inertial_place)]


def _read_entries(link: StatedLink) -> list[Entry]:
    """Return the entries about content that the reader could not use."""
    entries = []
    for found in link.findings:
        values = {**link.place._asdict(), "column": 1, **found.values}
        entries.append(
            Entry(
                found,
                Place(values["line"], values["column"], values.get("source", link.place.file)),
            )
        )
    return entries


def _judge(link: StatedLink, stated: StatedInertial, pieces: Pieces, incomplete: bool) -> LinkAudit:
    """Judge an inertial by its geometry. incomplete: True if some shapes could not be read; then
    none are compared.
    """
    place = link.inertial_place
    points = [
        one.shape.pose.apply(piece.points) for several in pieces.values() for one, piece in several
    ]
    hull = Hull(np.concatenate(points)) if points and not incomplete else None
    made = {} if incomplete else {role: _reference(several) for role, several in pieces.items()}
    references = [one for role in ("visual", "collision") if (one := made.get(role))]
    reasons = impossible(stated, hull)
    if not stated.mass > LEAST_MASS or any(one.code == INERTIAL_NOT_FINITE for one in reasons):
        entries = [Entry(one, place, compares=True) for one in reasons]
        found = LinkAudit(link, tuple(entries), is_impossible=True)
        if not references:
            return found
        return replace(found, geometry=references[0].uniform(1.0), volume=references[0].volume)
    wrong = [one for one in reasons if one.code != INERTIAL_TRIANGLE_SLIGHTLY]
    is_outside = any(one.code == INERTIAL_CENTER_OUTSIDE for one in wrong)
    diagnoses = diagnose(stated, references, [] if incomplete else _turned(pieces), is_outside)
    changes = [one for one in diagnoses if one.is_change]
    repaired = changes[-1].repaired if changes else None
    left = wrong
    if repaired is not None:
        codes = {one.code for one in impossible(repaired, hull)}
        left = [one for one in wrong if one.code in codes]
    elif changes:
        left = []
    entries = [Entry(one, place, compares=True) for one in reasons if one not in wrong]
    entries += _entries(place, diagnoses, [one for one in wrong if one not in left])
    if not references:
        entries += [Entry(one, place, compares=True) for one in left]
        return LinkAudit(link, tuple(entries), repaired, is_impossible=bool(wrong))
    reference = references[0]
    geometry = reference.uniform(stated.mass)
    if left:
        guessed = _guess(stated, geometry, hull)
        if guessed is geometry:  # It adds nothing to errors.
            entries = [one for one in entries if one.finding.code != AUDIT_NOT_UNIFORM]
        density = stated.mass / reference.volume
        # Geometry that cannot hold the mass, in kg or another unit, shows nothing about its place.
        unusual = diagnose_density(geometry, reference)
        holds = all(one.is_change for one in unusual)
        guess = finding(AUDIT_UNIFORM_INSTEAD) if holds else None
        repaired = guessed if holds else None
        certainty = "guess" if guess else ""
        entries = [*(Entry(one, place, (), guess, certainty, True) for one in left), *entries]
        if unusual:
            entries.append(Entry(finding(AUDIT_DENSITY, density=density), place, compares=True))
    # The mass may lie anywhere in the hull: a motor in a cover.
    least = stated.mass / max(one.volume for one in references)
    if least > DENSITIES[1] and hull is not None:
        room = float(hull_volumes(hull.points, np.zeros(1, np.intp), 0.0)[0])
        least = min(least, stated.mass / room) if room > 0.0 else least
    is_told = any(one.change or one.finding.code == AUDIT_DENSITY for one in entries)
    if least > DENSITIES[1] and not wrong and not is_told:
        entries.append(Entry(finding(AUDIT_DENSITY, density=least), place, compares=True))
    apart = min(one.compare(stated) for one in references)
    return LinkAudit(
        link,
        tuple(entries),
        repaired,
        stated.mass / reference.volume,
        geometry,
        apart,
        bool(wrong),
        volume=reference.volume,
        is_drawn="visual" not in made or made["visual"] is not None,
    )


def _guess(stated: StatedInertial, geometry: StatedInertial, hull: Hull | None) -> StatedInertial:
    """Return the inertial of the evenly filled geometry, about the stated center if that is
    possible.
    """
    if hull is None or hull.distance(stated.center) > CENTER_RTOL * hull.size:
        return geometry
    reference = Reference(1.0, geometry.center, geometry.inertia / geometry.mass)
    if reference.compare_centers(stated) <= DIFFERS:
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


def _measured(surface: Surface, upright: NDArray | None = None) -> _Piece:
    """Return a surface's points, with the moments of the body that it bounds if they are
    certain.
    """
    points = np.asarray(surface.points, np.float64)
    first = first_occurrence(*points.T.copy())
    points = points[first == np.arange(len(first))]  # Many files repeat them for each triangle.
    try:
        body = solid.measure_solid(surface)
    except MeasureError:
        return _Piece(points, None, upright)
    certain = Procedure(body.method) in RELIABLE and body.volume.raw[0] > 0.0
    return _Piece(points, body.volume if certain else None, upright)


def _reference(pieces: Sequence[tuple[StatedShape, _Piece]]) -> Reference | None:
    """Return all shapes of one role as evenly filled geometry; None if there is none, or one bounds
    no certain body.
    """
    if not pieces:
        return None
    whole = Body()
    for stated, piece in pieces:
        if piece.moments is None:
            return None
        own = piece.moments.transform(stated.shape.pose.matrix).about_center()
        inertia = inertia_of_second(own.raw[SECOND_MOMENT_INDEX])
        whole = whole.add(Body(float(own.raw[0]), own.about, inertia))
    if whole.center is None or whole.inertia is None:
        return None
    origins = tuple(stated.shape.pose.position for stated, _ in pieces)
    return Reference(whole.mass, whole.center, whole.inertia / whole.mass, origins)


def _turned(pieces: Pieces) -> list[tuple[Finding, Reference]]:
    """Return, for each role with angles, the finding and the geometry if those angles were meant in
    degrees.
    """
    result = []
    for found in pieces.values():
        turned = []
        for stated, piece in found:
            shape = stated.shape
            if stated.angles is not None:
                turn = rotation_of_angles(*map(radians, stated.angles))
                shape = replace(shape, pose=Pose(shape.pose.position, turn))
            turned.append((replace(stated, shape=shape), piece))
        if (
            any(any(stated.angles or ()) for stated, _ in found)
            and (reference := _reference(turned)) is not None
        ):
            result.append(
                (
                    finding(AUDIT_ANGLES, part="geometry", unit="degrees", wanted="radians"),
                    reference,
                )
            )
    return result


def _primitive(shape: Shape) -> _Piece:
    """Return a primitive in its own frame, with its moments and points that enclose it."""
    if shape.kind == "box":
        points = (
            np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
            * shape.size
        )
    elif shape.kind in ("sphere", "ellipsoid"):
        points = spread_directions(BALL) * shape.size * ROUND
    else:
        radius, length = shape.size
        if shape.kind == "capsule":
            ring = spread_directions(BALL)
        else:
            turn = np.linspace(0.0, 2.0 * pi, 48, endpoint=False)
            ring = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
        end = np.array([0.0, 0.0, length / 2.0])
        points = np.concatenate([ring * radius * ROUND + end, ring * radius * ROUND - end])
    return _Piece(points, primitive_moments(shape))


def repaired_copy(
    description: Description, repairs: Sequence[tuple[StatedLink, StatedInertial]]
) -> bytes:
    """Return the bytes of a description's file with replaced inertials, every other byte as it
    was.
    """
    data = description.source
    writer = FORMATS[description.format].writer_module
    places = [(link.span, link, inertial) for link, inertial in repairs if link.span is not None]
    for (start, end), link, inertial in sorted(places, key=lambda place: place[0], reverse=True):
        old = data[start:end].decode("utf-8", "surrogateescape")
        new = writer.inertial_text(inertial, old, link, description)
        before = data[:start].rpartition(b"\n")[2]
        if description.format != "usd" and not before.strip():
            new = new.replace("\n", "\n" + before.decode())
        data = data[:start] + new.encode("utf-8", "surrogateescape") + data[end:]
    return data
