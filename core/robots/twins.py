# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links that are mirror images or copies of each other, and inertials that both cannot have.

Links are paired by sides or numbers in their names, and by equal geometry at mirrored places. The
mirror plane comes from the places of the joints. An inertial is mapped from one link to the other
as the geometry is: by the mirror plane, along the links' own axes, or unchanged. Pairs whose
geometry differs are none.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..numerics import Array
from .comparison import Reference
from .entries import LinkAudit
from .model import Pose
from .stated import StatedInertial
from .totals import Tree

TOLERANCE = 0.05  # of masses, relative to the larger one, and of tensors
EQUAL = 0.01  # Equal geometry under two maps differs less.
ALIKE = 1e-3  # Volumes of a pair without sides in the names differ less.
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+|[^A-Za-z\d]+")
# The second side of each word; some programs put left and right first.
_SIDES = {"left": "right", "l": "r"}
_SIDES |= {place + "l": place + "r" for place in "frhbm"}
_SIDES |= {"l" + place: "r" + place for place in "fhbmr"}
_OWN_MAPS = [
    Pose(rotation=np.diag(signs))
    for signs in ((1.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -1.0))
]


class Pair(NamedTuple):
    """Indices of two links, and the maps of the first to the second, the likeliest first."""

    first: int
    second: int
    maps: Sequence[Pose]


@dataclass(frozen=True, eq=False)
class Plane:
    """A mirror plane: x · normal = offset, in the model."""

    normal: Array
    offset: float

    def mirror(self, pose: Pose) -> Pose:
        """Return the pose of the mirror image of a frame; its axes are mirrored as well."""
        turn = np.eye(3) - 2.0 * np.outer(self.normal, self.normal)
        return Pose(turn @ pose.position + 2.0 * self.offset * self.normal, turn @ pose.rotation)


def find_pairs(audits: Sequence[LinkAudit], tree: Tree) -> list[Pair]:
    """Return the pairs of links with inertials, and all maps that fit their geometry."""
    indices = {one.link.name: index for index, one in enumerate(audits) if one.link.inertial}
    places = [tree.poses[one.link.name] for one in audits]
    sides = [
        (index, indices[other])
        for name, index in indices.items()
        if (other := _other_side(name)) != name and other in indices
    ]
    plane = _plane([(places[first], places[second]) for first, second in sides])

    def mirror(first: int, second: int) -> list[Pose]:
        """Return the map by the plane, if it is known."""
        start, end = places[first], places[second]
        if plane is None or start is None or end is None:
            return []
        return [end.inverse() @ plane.mirror(start)]

    def pair(first: int, second: int, maps: Sequence[Pose], within: float) -> Pair:
        return Pair(first, second, _fitting_maps(audits[first], audits[second], maps, within))

    pairs = [pair(*side, [*mirror(*side), *_OWN_MAPS], TOLERANCE) for side in sides]
    paired = {index for side in sides for index in side}
    groups: dict[str, list[int]] = {}
    rest: dict[int, Reference] = {}
    for name, index in indices.items():
        reference = audits[index].reference
        if reference is not None and index not in paired:
            rest[index] = reference
            if re.search(r"\d", name):
                groups.setdefault(re.sub(r"\d+", "#", name), []).append(index)
    for first, *others in groups.values():
        pairs += [pair(first, other, _OWN_MAPS[:1], EQUAL) for other in others]
    ordered = sorted(rest, key=lambda index: rest[index].volume)
    for first, second in zip(ordered, ordered[1:]):
        is_near = rest[second].volume <= (1.0 + ALIKE) * rest[first].volume
        maps = mirror(first, second) if is_near else []
        if maps and pair(first, second, maps, EQUAL).maps:
            ends = [pose.apply(rest[i].center) for i in (first, second) if (pose := places[i])]
            if np.linalg.norm(ends[0] - ends[1]) > np.sqrt(np.trace(rest[second].inertia)):
                pairs.append(pair(first, second, [*maps, *_OWN_MAPS], TOLERANCE))
    return [one for one in pairs if one.maps]


def _fitting_maps(
    first: LinkAudit, second: LinkAudit, maps: Sequence[Pose], within: float
) -> Sequence[Pose]:
    """Return the maps that lay the first link's geometry onto the second's; all of them if the
    geometry is unknown.
    """
    own = first.reference
    other = second.reference
    if own is None or other is None:
        return maps
    low, high = sorted((own.volume, other.volume))
    apart = [other.compare(mapped(own.uniform(1.0), pose)) for pose in maps]
    if high > (1.0 + within) * low or min(apart) > within:
        return []
    return [pose for pose, value in zip(maps, apart) if value <= min(apart) + EQUAL]


def _other_side(name: str) -> str:
    """Return the name of the right link of a left one; other names as they are."""
    words: list[str] = _WORD.findall(name)
    return "".join(_cased(_SIDES.get(word.lower(), word), word) for word in words)


def _cased(word: str, like: str) -> str:
    if like.isupper():
        return word.upper()
    return word.capitalize() if like[0].isupper() else word


def _plane(pairs: Sequence[tuple[Pose | None, Pose | None]]) -> Plane | None:
    """Return the plane between most of the pairs of places."""
    places = [(one.position, other.position) for one, other in pairs if one and other]
    known = [place for place in places if (place[0] != place[1]).any()]
    if not known:
        return None
    first, second = (np.array(several) for several in zip(*known))
    ways = second - first
    ways = ways / np.linalg.norm(ways, axis=1)[:, None]
    normal = np.linalg.eigh(ways.T @ ways)[1][:, 2]
    offsets = np.sort((first + second) / 2.0 @ normal)
    half = len(offsets) // 2  # The median; numpy's own functions load much for it.
    return Plane(normal, float(offsets[half] + offsets[-1 - half]) / 2.0)


def mapped(inertial: StatedInertial, pose: Pose) -> StatedInertial:
    """Return an inertial in another frame, in which its own frame, perhaps mirrored, has a pose."""
    turn = pose.rotation
    inertia = turn @ inertial.inertia @ turn.T
    return inertial.along_link(inertia, center=turn @ inertial.center + pose.position)


def disagreement(
    first: StatedInertial, second: StatedInertial, maps: Sequence[Pose]
) -> tuple[str, float]:
    """Return the part that differs more, "masses" or "inertias", and the relative difference."""
    mass = abs(first.mass - second.mass) / max(first.mass, second.mass)
    largest = max(np.linalg.norm(first.inertia), np.linalg.norm(second.inertia)) or 1.0
    tensor = min(
        float(np.linalg.norm(mapped(first, pose).inertia - second.inertia) / largest)
        for pose in maps
    )
    return ("masses", mass) if mass >= 0.5 * tensor else ("inertias", tensor)


def find_copies(audits: Sequence[LinkAudit]) -> Iterator[list[int]]:
    """Yield the links of each inertial that stands at links of different geometry.

    Drawn geometry is compared with drawn geometry alone: colliders are often rougher, also those
    of drawn shapes without a certain volume.
    """
    groups: dict[tuple[bytes, bool], list[int]] = {}
    for index, one in enumerate(audits):
        inertial = one.link.inertial
        if inertial is not None and one.is_drawn and inertial.mass > 0.0:
            numbers = np.concatenate([[inertial.mass], inertial.center, inertial.inertia.ravel()])
            is_drawn = any(shape.role == "visual" for shape in one.link.shapes)
            groups.setdefault((numbers.tobytes(), is_drawn), []).append(index)
    for group in groups.values():
        first, *others = (one for index in group if (one := audits[index].reference))
        size = np.trace(first.inertia)
        if any(
            abs(one.volume / first.volume - 1.0) > TOLERANCE
            or np.linalg.norm(np.linalg.eigvalsh(one.inertia) - np.linalg.eigvalsh(first.inertia))
            > TOLERANCE * size
            for one in others
        ):
            yield group
