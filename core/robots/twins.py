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
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..numerics import Array
from .diagnosis import Reference
from .model import Pose
from .stated import StatedInertial
from .totals import Tree

if TYPE_CHECKING:
    from .audit import LinkAudit

TOLERANCE = 0.05  # of masses, relative to the larger one, and of tensors
EQUAL = 0.01  # Equal geometry under two maps differs less.
ALIKE = 1e-3  # Volumes of a pair without sides in the names differ less.
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+|[^A-Za-z\d]+")
# The second side of each word; some programs put left and right first.
_SIDES = {"left": ["right"], "l": ["r"]}
_SIDES |= {place + "l": [place + "r"] for place in "frhbm"}
_SIDES |= {"l" + place: ["r" + place] for place in "fhbmr"}
_OWN_MAPS = [np.diag(signs) for signs in ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1))]


class Pair(NamedTuple):
    """Indices of two links. is_copy: True if they are equal, not mirrored."""

    first: int
    second: int
    is_copy: bool = False


@dataclass(frozen=True, eq=False)
class Plane:
    """A mirror plane: x · normal = offset, in the model."""

    normal: Array
    offset: float

    def mirror(self, pose: Pose) -> Pose:
        """Return the pose of the mirror image of a frame; its axes are mirrored as well."""
        turn = np.eye(3) - 2.0 * np.outer(self.normal, self.normal)
        return Pose(turn @ pose.position + 2.0 * self.offset * self.normal, turn @ pose.rotation)


def find_pairs(audits: Sequence[LinkAudit], tree: Tree) -> tuple[list[Pair], Plane | None]:
    """Return the pairs of links with inertials, and the mirror plane if it is known."""
    indices = {one.link.name: index for index, one in enumerate(audits) if one.link.inertial}
    pairs = [
        Pair(indices[name], indices[other])
        for name in indices
        for other in _other_sides(name)
        if other in indices
    ]
    plane = _plane([_places(audits, tree, pair) for pair in pairs])
    paired = {index for pair in pairs for index in pair[:2]}
    groups: dict[str, list[int]] = {}
    for name, index in indices.items():
        if index not in paired and re.search(r"\d", name):
            groups.setdefault(re.sub(r"\d+", "#", name), []).append(index)
    for first, *others in groups.values():
        pairs += [
            Pair(first, other, True) for other in others if _is_copy(audits[first], audits[other])
        ]
    rest = [index for index in indices.values() if index not in paired and audits[index].volume]
    rest.sort(key=lambda index: audits[index].volume)
    near = [
        Pair(first, second)
        for first, second in zip(rest, rest[1:])
        if audits[second].volume <= (1.0 + ALIKE) * audits[first].volume
        and audits[first].geometry is not None
    ]
    return pairs + [pair for pair in near if _is_mirrored(audits, tree, pair, plane)], plane


def _other_sides(name: str) -> Iterator[str]:
    """Yield the possible names of the right link of a left one."""
    words = _WORD.findall(name)
    swapped = [
        [_cased(other, word) for other in _SIDES.get(word.lower(), ())] or [word] for word in words
    ]
    if any(other[0] != word for other, word in zip(swapped, words)):
        yield "".join(other[0] for other in swapped)


def _cased(word: str, like: str) -> str:
    if like.isupper():
        return word.upper()
    return word.capitalize() if like[0].isupper() else word


def _places(audits: Sequence[LinkAudit], tree: Tree, pair: Pair) -> tuple[Array, Array] | None:
    first, second = (tree.poses[audits[index].link.name] for index in pair[:2])
    return None if first is None or second is None else (first.position, second.position)


def _plane(places: Sequence[tuple[Array, Array] | None]) -> Plane | None:
    """Return the plane between most of the pairs of (3,) places."""
    known = [place for place in places if place is not None and (place[0] != place[1]).any()]
    if not known:
        return None
    first, second = (np.array(several) for several in zip(*known))
    ways = second - first
    ways = ways / np.linalg.norm(ways, axis=1)[:, None]
    normal = np.linalg.eigh(ways.T @ ways)[1][:, 2]
    offsets = np.sort((first + second) / 2.0 @ normal)
    half = len(offsets) // 2  # The median; numpy's own functions load much for it.
    return Plane(normal, float(offsets[half] + offsets[-1 - half]) / 2.0)


def _is_copy(first: LinkAudit, second: LinkAudit) -> bool:
    """Return whether two links have equal geometry along their own axes."""
    low, high = sorted((first.volume, second.volume))
    if not low or high > (1.0 + EQUAL) * low or not first.geometry or not second.geometry:
        return False
    return _reference(second).compare(first.geometry) <= EQUAL


def _reference(audit: LinkAudit) -> Reference:
    geometry = audit.geometry
    assert geometry is not None
    return Reference(1.0, geometry.center, geometry.inertia / geometry.mass)


def _is_mirrored(audits: Sequence[LinkAudit], tree: Tree, pair: Pair, plane: Plane | None) -> bool:
    """Return whether the geometry of two links is mirrored by the plane, not within it."""
    first, second = (audits[index] for index in pair[:2])
    start, end = (tree.poses[one.link.name] for one in (first, second))
    if plane is None or start is None or end is None or not first.geometry or not second.geometry:
        return False
    image = mapped(first.geometry, end.inverse() @ plane.mirror(start))
    apart = np.linalg.norm(start.apply(first.geometry.center) - end.apply(second.geometry.center))
    size = np.sqrt(np.trace(_reference(second).inertia))
    return bool(apart > size) and _reference(second).compare(image) <= EQUAL


def mapped(inertial: StatedInertial, pose: Pose) -> StatedInertial:
    """Return an inertial in another frame, in which its own frame, perhaps mirrored, has a pose."""
    turn = pose.rotation
    inertia = turn @ inertial.inertia @ turn.T
    return inertial.along_link(inertia, center=turn @ inertial.center + pose.position)


def images(
    first: LinkAudit, second: LinkAudit, pair: Pair, tree: Tree, plane: Plane | None
) -> list[Pose] | None:
    """Return the maps of the first link to the second that fit their geometry, the likeliest
    first; all of them if the geometry is unknown, None if it differs.
    """
    maps = [Pose(rotation=turn.astype(float)) for turn in _OWN_MAPS[: 1 if pair.is_copy else None]]
    start, end = (tree.poses[one.link.name] for one in (first, second))
    if plane is not None and start is not None and end is not None and not pair.is_copy:
        maps.insert(0, end.inverse() @ plane.mirror(start))
    if first.geometry is None or second.geometry is None:
        return maps
    low, high = sorted((first.volume, second.volume))
    reference = _reference(second)
    apart = [reference.compare(mapped(first.geometry, pose)) for pose in maps]
    if high > (1.0 + TOLERANCE) * low or min(apart) > TOLERANCE:
        return None
    return [pose for pose, value in zip(maps, apart) if value <= min(apart) + EQUAL]


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
        first, *others = (audits[index] for index in group)
        size = np.sqrt(np.trace(_reference(first).inertia))
        if any(
            abs(one.volume / first.volume - 1.0) > TOLERANCE
            or np.linalg.norm(_moments(one) - _moments(first)) > TOLERANCE * size**2
            for one in others
        ):
            yield group


def _moments(audit: LinkAudit) -> Array:
    return np.asarray(np.linalg.eigvalsh(_reference(audit).inertia), np.float64)
