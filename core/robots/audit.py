# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions judged by their own geometry: stated inertials beside measured meshes; and
repaired copies.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf

import numpy as np

from ..inertia import combine
from ..moments import Moments
from ..numerics import second_of_inertia
from ..verdict import Finding, Severity, finding, internal_error
from .comparison import DIFFERS, Reference, is_possible
from .entries import Entry, LinkAudit
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
from .judgment import judge
from .model import Pose, second_moments
from .pieces import Geometry, Measurer, Piece, Pieces
from .plausibility import LEAST_MASS, impossible
from .read.mjcf_meshes import CLOSED
from .read.roots import Roots
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
        by_span = {  # Copies of a body have one inertial in the file.
            audit.link.span: (audit.link, audit.repaired)
            for audit in self.links
            if audit.link.span is not None and audit.repaired is not None
        }
        return [*by_span.values()]


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
        links = self._used_links(description)
        tree = build_tree(description, self.joints)
        audits = [self._audit_link(link) for link in links]
        pairs = find_pairs(audits, build_tree(description, {}) if self.joints else tree)
        for pair in pairs:
            _repair_by_twin(audits, pair)
        audits = [self._without_faulty_repair(audit) for audit in audits]
        _compare_twins(audits, pairs)
        totals = add_up(tree, [(audit.link, audit.is_impossible) for audit in audits])
        unexpected = [Entry(found, Place()) for found in self.expected.check(totals.whole)]
        return Audit(description, tuple(audits), tree, totals, (*tree.entries, *unexpected))

    def _used_links(self, description: Description) -> list[StatedLink]:
        """Return the links with the inertials that the format's program uses, scaled to the total
        mass that the file states if all masses are known.
        """
        stated_links = description.links
        links = [self._with_used_inertial(link) for link in stated_links]
        mass = sum(0.0 if link.inertial is None else link.inertial.mass for link in links)
        # A link that is returned as it is has unknown masses.
        is_known = all(link is not stated for stated, link in zip(stated_links, links))
        factor = 1.0
        if description.total > 0.0 and is_known and mass > 0.0:
            factor = description.total / mass
        return [_keep_stated(*both, factor) for both in zip(stated_links, links)]

    def _with_used_inertial(self, link: StatedLink) -> StatedLink:
        """Return a link with the inertial that its format's program uses; the link itself if that
        is the stated one, or masses of shapes are unknown.
        """
        if link.rules is None:
            return link
        try:
            masses = self._shape_masses(link)
            if masses is None:
                return link
            inertial = link.inertial
            if masses:
                body = combine([(mass, 1.0) for mass in masses])
                inertial = StatedInertial(body.mass, body.center, body.inertia)
            if masses or inertial is None:
                inertial = link.rules.complete(inertial)
            is_stated = link.rules.mass > 0.0 and link.rules.moments is not None
            used = link.rules.bound(inertial)
            return replace(link, inertial=used, from_shapes=bool(masses) and not is_stated)
        except Exception:  # An unforeseen error returns when the link is audited.
            return link

    def _shape_masses(self, link: StatedLink) -> list[Moments] | None:
        """Return the moments of the masses that a link's shapes state, kg, in the link's frame;
        None if one of them is unknown.
        """
        if not any(shape.weight for shape in link.shapes):
            return []
        pieces, unread = self._measure(link)
        is_open = any(
            shape.weight and shape.weight.inertia == CLOSED and piece.moments is None
            for shape, piece in pieces
        )
        if unread or link.findings or is_open:
            return None
        return [_placed_mass(shape, piece.mass) for shape, piece in pieces if piece.mass]

    def _audit_link(self, link: StatedLink) -> LinkAudit:
        """Return the findings about one link; an unforeseen error is one of them, and ends nothing
        else.
        """
        try:
            return self._judge_link(link)
        except Exception as error:
            internal = Entry(internal_error.finding_of(error), link.place)
            return LinkAudit(link, (*_read_entries(link), internal))

    def _without_faulty_repair(self, audit: LinkAudit) -> LinkAudit:
        """Return the audit of a link without a repair that would itself have a new finding."""
        if audit.repaired is None:
            return audit
        again = self._audit_link(replace(audit.link, inertial=audit.repaired, overridden=None))
        codes = {found.code for found in audit.findings}
        has_new = any(found.code not in codes for found in again.findings)
        return replace(audit, repaired=None) if has_new else audit

    def _measure(self, link: StatedLink) -> tuple[Pieces, list[Entry]]:
        """Return the measured shapes of a link, and entries about others."""
        return Measurer(self.roots, self.meshes).measure(link.shapes)

    def _judge_link(self, link: StatedLink) -> LinkAudit:
        entries = _read_entries(link)
        inertial = link.inertial
        if inertial is None:
            if link.moves and not entries:
                entries.append(Entry(finding(INERTIAL_MISSING), link.place))
            if any(shape.weight for shape in link.shapes):
                entries += self._measure(link)[1]
            return LinkAudit(link, tuple(entries))
        if link.is_frame:
            entries.append(Entry(finding(INERTIAL_OF_FRAME), link.inertial_place))
            return LinkAudit(link, tuple(entries))
        pieces, unread = self._measure(link)
        # Entries of the reader are about shapes, as there is an inertial.
        is_whole = not unread and not entries
        entries += [*unread, *_describe_overridden(link, inertial)]
        if link.from_shapes:
            audit = _judge_mass(link, inertial, pieces)
        else:
            audit = _judge_geometry(link, inertial, Geometry(pieces, is_whole))
        return replace(audit, entries=(*entries, *audit.entries))


def _judge_mass(link: StatedLink, inertial: StatedInertial, pieces: Pieces) -> LinkAudit:
    """Judge an inertial that comes from the masses of its shapes."""
    reasons = impossible(inertial, None)
    volume = sum(
        piece.moments.raw[0]
        for shape, piece in pieces
        if shape.weight and shape.weight.inertia != "shell" and piece.mass and piece.moments
    )
    density = float(inertial.mass / volume) if volume else None
    if density and not reasons and not is_possible(density):
        reasons.append(finding(AUDIT_DENSITY, density=density))
    entries = (Entry(reason, link.inertial_place) for reason in reasons)
    return LinkAudit(link, tuple(entries), density=density)


def _judge_geometry(link: StatedLink, inertial: StatedInertial, geometry: Geometry) -> LinkAudit:
    """Judge an inertial by its geometry, with meshes turned upright if it only agrees so, and
    describe the effect of its collision geometry.
    """
    audit = judge(link, inertial, geometry)
    upright = geometry.upright()
    if upright is not None:
        turned = judge(link, inertial, upright)
        agrees = turned.apart <= min(DIFFERS, audit.apart / 2.0)
        if not turned.is_impossible and (audit.is_impossible or agrees):
            note = Entry(finding(AUDIT_UP_AXIS), link.inertial_place)
            audit = replace(turned, entries=(note, *turned.entries))
            geometry = upright
    drawn = geometry.references.get("visual")
    collision = geometry.references.get("collision")
    if collision is None or audit.is_impossible and audit.repaired is None:
        return audit
    stated = audit.repaired or inertial
    effect = collision.effect(stated, None if drawn is None else drawn.volume)
    audit = replace(audit, colliders=effect)
    if drawn is None or collision.compare(stated) <= max(DIFFERS, drawn.compare(stated)):
        return audit
    note = collision.describe_effect(stated, effect, "collision geometry")
    return audit.with_entries(Entry(note, link.inertial_place, compares=True))


def _repair_by_twin(audits: list[LinkAudit], pair: Pair) -> None:
    """Give an impossible inertial that has no likelier repair that of its twin, if that is
    possible.
    """
    first, second, (likeliest, *_) = pair
    for index, other, pose in ((first, second, likeliest.inverse()), (second, first, likeliest)):
        audit, twin = audits[index], audits[other]
        has_guess = all(entry.certainty in ("", "guess") for entry in audit.entries)
        is_twin_right = not twin.is_impossible and all(
            entry.change is None for entry in twin.entries
        )
        if audit.is_impossible and has_guess and is_twin_right:
            audits[index] = _with_repair_of_twin(audit, twin, pose)


def _with_repair_of_twin(audit: LinkAudit, twin: LinkAudit, pose: Pose) -> LinkAudit:
    """Return an audit whose impossible inertial is repaired by its twin's. pose: the map from the
    twin's frame, which may mirror.
    """
    assert twin.link.inertial is not None
    instead = finding(AUDIT_INSTEAD, source=MIRRORED_TWIN.format(twin.link.name))
    entries = [
        replace(entry, change=instead, certainty="guess")
        if entry.compares and entry.severity == Severity.ERROR
        else entry
        for entry in audit.entries
    ]
    # What is noted of the twin holds for the repair, too.
    if all(entry.finding.code != AUDIT_NOT_UNIFORM for entry in entries):
        entries += [
            replace(entry, place=audit.link.inertial_place)
            for entry in twin.entries
            if entry.finding.code == AUDIT_NOT_UNIFORM
        ]
    is_in_file = audit.link.span is not None
    repaired = mapped(twin.link.inertial, pose) if is_in_file else None
    return replace(audit, entries=tuple(entries), repaired=repaired)


def _compare_twins(audits: list[LinkAudit], pairs: Sequence[Pair]) -> None:
    """Add findings about twins that disagree, and about copies."""
    for first, second, maps in pairs:
        audit = audits[first]
        disagreeing = _disagreeing_twins(audit, audits[second], maps)
        if disagreeing is not None:
            audits[first] = audit.with_entries(Entry(disagreeing, audit.link.inertial_place))
    for group in find_copies(audits):
        audit = audits[group[0]]
        copied = finding(AUDIT_COPIED, links=[audits[index].link.name for index in group])
        entry = Entry(copied, audit.link.inertial_place, compares=True)
        audits[group[0]] = audit.with_entries(entry)


def _disagreeing_twins(audit: LinkAudit, twin: LinkAudit, maps: Sequence[Pose]) -> Finding | None:
    """Return the finding about twins that disagree as stated, if possible, or with their repairs.

    maps: those of the first link to its twin.
    """
    states = [(audit.repaired or audit.link.inertial, twin.repaired or twin.link.inertial)]
    if not audit.is_impossible and not twin.is_impossible:
        states.insert(0, (audit.link.inertial, twin.link.inertial))
    for inertial, other in states:
        if inertial is None or other is None or not min(inertial.mass, other.mass) > LEAST_MASS:
            continue
        part, apart = disagreement(inertial, other, maps)
        if apart > TOLERANCE:
            return finding(
                AUDIT_TWINS, part=part, apart=apart, first=audit.link.name, second=twin.link.name
            )
    return None


def _placed_mass(shape: StatedShape, mass: Moments) -> Moments:
    """Return the moments of a shape's mass, kg, in its link, with the values that are stated
    instead of them.
    """
    placed = mass.transform(shape.shape.pose.matrix)
    if shape.rules is None:
        return placed
    total = combine([(placed, 1.0)])
    body = shape.rules.complete(StatedInertial(total.mass, total.center, total.inertia))
    assert body is not None
    return second_moments(body.mass, body.center, second_of_inertia(body.inertia), placed.measure)


def _keep_stated(stated: StatedLink, link: StatedLink, factor: float) -> StatedLink:
    """Return a link with its used inertial times a factor; beside it the stated one, if that is not
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
        apart = Reference.of_inertial(used).compare(stated)
    if link.from_shapes:
        apart = max(apart, abs(stated.mass / used.mass - 1.0))
    # Rules of MuJoCo never have moments; a USD body that states an inertial has no rules, or rules
    # with its moments.
    is_newton = link.rules is None or link.rules.moments is not None
    if is_newton and apart <= DIFFERS:
        return []
    first, second, third = np.linalg.eigvalsh(used.inertia).tolist()
    overridden = finding(
        AUDIT_OVERRIDDEN,
        slight=apart <= DIFFERS,
        program="Newton" if is_newton else "MuJoCo",
        cause="newton:inertia" if is_newton else "<compiler>",
        mass=used.mass,
        first=first,
        second=second,
        third=third,
    )
    return [Entry(overridden, link.inertial_place)]


def _read_entries(link: StatedLink) -> list[Entry]:
    """Return the entries about content that the reader could not use, at its places if known."""
    entries = []
    for found in link.findings:
        values = found.values
        place = Place(
            values.get("line", link.place.line),
            values.get("column", 1),
            values.get("source", link.place.file),
        )
        entries.append(Entry(found, place))
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
    # The last one first, so that the spans before it stay valid.
    for (start, end), link, inertial in sorted(places, key=lambda place: place[0], reverse=True):
        old = data[start:end].decode("utf-8", "surrogateescape")
        new = writer.inertial_text(inertial, old, link, description)
        # Further lines get the spaces before the element, if it begins its line.
        before = data[:start].rpartition(b"\n")[2]
        if description.format != "usd" and not before.strip():
            new = new.replace("\n", "\n" + before.decode())
        data = data[:start] + new.encode("utf-8", "surrogateescape") + data[end:]
    return data
