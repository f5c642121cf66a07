# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions judged by their own geometry: stated inertials beside measured meshes; and
repaired copies.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

import numpy as np

from ..inertia import combine
from ..moments import Moments
from ..numerics import second_of_inertia
from ..verdict import Severity, finding, internal_error
from .diagnosis import DENSITIES, DIFFERS, Reference
from .findings import (
    AUDIT_COPIED,
    AUDIT_DENSITY,
    AUDIT_INSTEAD,
    AUDIT_NOT_UNIFORM,
    AUDIT_OVERRIDDEN,
    AUDIT_TWINS,
    AUDIT_UP_AXIS,
    INERTIAL_MISSING,
    INERTIAL_OF_FRAME,
)
from .formats import FORMATS
from .judgment import Entry, LinkAudit, judge
from .model import second_moments
from .pieces import Geometry, Measurer, Piece, Pieces
from .plausibility import LEAST_MASS, impossible
from .read.descriptions import Roots
from .read.mjcf_meshes import CLOSED
from .stated import Description, Place, StatedInertial, StatedLink, StatedShape
from .totals import Expectation, Totals, Tree, add_up, build_tree
from .twins import TOLERANCE, Pair, disagreement, find_copies, find_pairs, mapped

MIRRORED_TWIN = "the inertial of its twin {}, mirrored as the links are"


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


@dataclass
class Auditor:
    """An auditor of descriptions, which measures each mesh once, even if several links name it.

    joints: positions of joints by name, radians or meters. meshes: measured meshes, which auditors
    may share.
    """

    roots: Roots
    joints: Mapping[str, float] = field(default_factory=dict)
    expected: Expectation = Expectation()
    meshes: dict[tuple, Piece] = field(default_factory=dict)

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
        pairs = find_pairs(alone, build_tree(description, {}) if self.joints else tree)
        for pair in pairs:
            _repair_by_twin(alone, pair)
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
                pieces, unread = self._measure(link)
                is_open = any(
                    one.weight and one.weight.inertia == CLOSED and piece.moments is None
                    for one, piece in pieces
                )
                if unread or link.findings or is_open:
                    return link
                masses = [
                    (_weighed(one, piece.mass), 1.0)
                    for one, piece in pieces
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

    def _measure(self, link: StatedLink) -> tuple[Pieces, list[Entry]]:
        """Return the measured shapes of a link, and entries about others."""
        pieces, unread = Measurer(self.roots, self.meshes).measure(link.shapes)
        return pieces, [Entry(*one) for one in unread]

    def _link(self, link: StatedLink) -> LinkAudit:
        entries = _read_entries(link)
        place = link.inertial_place
        inertial = link.inertial
        if inertial is None:
            if link.moves and not entries:
                entries.append(Entry(finding(INERTIAL_MISSING), link.place))
            if any(shape.weight for shape in link.shapes):
                entries += self._measure(link)[1]
            return LinkAudit(link, tuple(entries))
        if link.is_frame:
            return LinkAudit(link, (*entries, Entry(finding(INERTIAL_OF_FRAME), place)))
        pieces, unread = self._measure(link)
        # entries of the reader: about shapes, as there is an inertial
        geometry = Geometry(pieces, not unread and not entries)
        entries += unread
        entries += _describe_overridden(link, inertial)
        if link.from_shapes:
            return _judge_mass(link, inertial, pieces, entries)
        found = judge(link, inertial, geometry)
        upright = geometry.upright()
        other = judge(link, inertial, upright) if upright else found
        agrees = other.apart <= min(DIFFERS, found.apart / 2.0)
        if upright and not other.is_impossible and (found.is_impossible or agrees):
            found = other
            geometry = upright
            entries.append(Entry(finding(AUDIT_UP_AXIS), place))
        entries += found.entries
        drawn = geometry.references.get("visual")
        collision = geometry.references.get("collision")
        if collision is None or found.is_impossible and found.repaired is None:
            return replace(found, entries=tuple(entries))
        stated = found.repaired or inertial
        effect = collision.effect(stated, None if drawn is None else drawn.volume)
        if drawn is not None and collision.compare(stated) > max(DIFFERS, drawn.compare(stated)):
            note = collision.describe_effect(stated, effect, "collision geometry")
            entries.append(Entry(note, place, compares=True))
        return replace(found, entries=tuple(entries), colliders=effect)


def _judge_mass(
    link: StatedLink, inertial: StatedInertial, pieces: Pieces, entries: list[Entry]
) -> LinkAudit:
    """Judge an inertial that comes from the masses of its shapes. entries: those so far."""
    reasons = impossible(inertial, None)
    volume = sum(
        piece.moments.raw[0]
        for one, piece in pieces
        if one.weight and one.weight.inertia != "shell" and piece.mass and piece.moments
    )
    density = float(inertial.mass / volume) if volume else None
    if density and not reasons and not DENSITIES[0] <= density <= DENSITIES[1]:
        reasons.append(finding(AUDIT_DENSITY, density=density))
    told = (Entry(one, link.inertial_place) for one in reasons)
    return LinkAudit(link, (*entries, *told), density=density)


def _repair_by_twin(audits: list[LinkAudit], pair: Pair) -> None:
    """Give an impossible inertial that has no likelier repair that of its twin, if that is
    possible.
    """
    first, second, (likeliest, *_) = pair
    for own, other, pose in ((first, second, likeliest.inverse()), (second, first, likeliest)):
        audit, twin = audits[own], audits[other].link
        is_guess = all(one.certainty in ("", "guess") for one in audit.entries)
        is_right = not audits[other].has_impossible and not any(
            one.change for one in audits[other].entries
        )
        if not (audit.has_impossible and is_right and is_guess):
            continue
        assert twin.inertial is not None
        change = finding(AUDIT_INSTEAD, source=MIRRORED_TWIN.format(twin.name))
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


def _compare_twins(audits: list[LinkAudit], pairs: Sequence[Pair]) -> None:
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
