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
from .entries import LinkAudit
from .model import Pose
from .stated import StatedInertial
from .totals import Tree

TOLERANCE = 0.05  # Relative to the larger mass, and for tensors.
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
    indices = {audit.link.name: index for index, audit in enumerate(audits) if audit.link.inertial}
    places = [tree.poses[audit.link.name] for audit in audits]
    sides = [
        (index, indices[other])
        for name, index in indices.items()
        if (other := _other_side(name)) != name and other in indices
    ]
    plane = _plane([(places[first], places[second]) for first, second in sides])

    def mirror(first: int, second: int) -> list[Pose]:
        """Return the map from the first link's frame to the second's by the plane, if it is
        known, as the only item.
        """
        start, end = places[first], places[second]
        if plane is None or start is None or end is None:
            return []
        return [end.inverse() @ plane.mirror(start)]

    def pair(first: int, second: int, maps: Sequence[Pose], within: float) -> Pair:
        """Return a pair with those of the maps that fit within a tolerance."""
        return Pair(first, second, _fitting_maps(audits[first], audits[second], maps, within))

    pairs = [pair(*side, [*mirror(*side), *_OWN_MAPS], TOLERANCE) for side in sides]
    paired = {index for side in sides for index in side}
    unpaired = {
        name: (index, reference)
        for name, index in indices.items()
        if (reference := audits[index].reference) is not None and index not in paired
    }
    # Links whose names differ by numbers alone are copies of the first one.
    groups: dict[str, list[int]] = {}
    for name, (index, _) in unpaired.items():
        if re.search(r"\d", name):
            groups.setdefault(re.sub(r"\d+", "#", name), []).append(index)
    for first, *copies in groups.values():
        pairs += [pair(first, copy, _OWN_MAPS[:1], EQUAL) for copy in copies]
    # Other links are paired if their volumes are equal, and the plane maps one onto the other.
    by_volume = sorted(unpaired.values(), key=lambda link: link[1].volume)
    for (first, start), (second, end) in zip(by_volume, by_volume[1:]):
        is_near = end.volume <= (1.0 + ALIKE) * start.volume
        maps = mirror(first, second) if is_near else []
        if not maps or not pair(first, second, maps, EQUAL).maps:
            continue
        centers = [
            place.apply(reference.center)
            for place, reference in ((places[first], start), (places[second], end))
            if place is not None
        ]
        # One link within the other has no other side.
        # √tr(I) of 1 kg is √2 times the radius of gyration.
        if np.linalg.norm(centers[0] - centers[1]) > np.sqrt(np.trace(end.inertia)):
            pairs.append(pair(first, second, [*maps, *_OWN_MAPS], TOLERANCE))
    return [each for each in pairs if each.maps]


def _fitting_maps(
    first: LinkAudit, second: LinkAudit, maps: Sequence[Pose], within: float
) -> Sequence[Pose]:
    """Return the maps that lay the first link's geometry onto the second's; all of them if the
    geometry is unknown, none if it differs by more than a part `within`.
    """
    start, end = first.reference, second.reference
    if start is None or end is None:
        return maps
    low, high = sorted((start.volume, end.volume))
    apart = [end.compare(mapped(start.uniform(1.0), pose)) for pose in maps]
    if high > (1.0 + within) * low or min(apart) > within:
        return []
    return [pose for pose, value in zip(maps, apart) if value <= min(apart) + EQUAL]


def _other_side(name: str) -> str:
    """Return the name of the right link of a left one; other names as they are."""
    words: list[str] = _WORD.findall(name)
    others = []
    for word in words:
        other = _SIDES.get(word.lower(), word)
        if word.isupper():
            other = other.upper()
        elif word[0].isupper():
            other = other.capitalize()
        others.append(other)
    return "".join(others)


def _plane(pairs: Sequence[tuple[Pose | None, Pose | None]]) -> Plane | None:
    """Return the plane between most of the pairs of places."""
    points = [(one.position, other.position) for one, other in pairs if one and other]
    apart = [(first, second) for first, second in points if (first != second).any()]
    if not apart:
        return None
    first, second = map(np.array, zip(*apart))  # (k, 3) each
    ways = second - first
    directions = ways / np.linalg.norm(ways, axis=1)[:, None]
    # The direction to which most of them are near, whatever their signs.
    normal = np.linalg.eigh(directions.T @ directions)[1][:, 2]
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
    # A wrong mass changes the tensor by the same part, so the masses are named unless the tensors
    # differ by more than twice as much.
    return ("masses", mass) if mass >= 0.5 * tensor else ("inertias", tensor)


def find_copies(audits: Sequence[LinkAudit]) -> Iterator[list[int]]:
    """Yield the links of each inertial that stands at links of different geometry.

    Drawn geometry is compared with drawn geometry alone: colliders are often rougher, also those
    of drawn shapes without a certain volume.
    """
    groups: dict[tuple[bytes, bool], list[int]] = {}
    for index, audit in enumerate(audits):
        inertial = audit.link.inertial
        if inertial is not None and audit.is_drawn and inertial.mass > 0.0:
            numbers = np.concatenate([[inertial.mass], inertial.center, inertial.inertia.ravel()])
            draws = any(shape.role == "visual" for shape in audit.link.shapes)
            groups.setdefault((numbers.tobytes(), draws), []).append(index)
    for group in groups.values():
        first, *others = (reference for index in group if (reference := audits[index].reference))
        # Moments per kilogram do not depend on the axes.
        size = np.trace(first.inertia)
        moments = np.linalg.eigvalsh(first.inertia)
        if any(
            abs(other.volume / first.volume - 1.0) > TOLERANCE
            or np.linalg.norm(np.linalg.eigvalsh(other.inertia) - moments) > TOLERANCE * size
            for other in others
        ):
            yield group
