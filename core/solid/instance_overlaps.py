# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlaps between solids that stand in several places.

Each solid is measured by itself, with its own cavities. A volume common to two counts twice, and is reported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.bvh import sort_components
from ..verdict.tolerances import CLOSED_SHEET_VOLUME_RTOL, NEGLIGIBLE, welding_tolerance
from .nesting import classify_pairs
from .solid_verdict import SolidIntegrals


@dataclass(frozen=True, eq=False)
class PlaceComparison:
    """Solids inside other ones, or overlapping them: (k, 2) [solid, component], once for each place.

    `nested`: components in the material of others. `overlapping`: components that share a part of their interiors.
    `undecided_pairs`: number of pairs that would have been too much work.
    `nested_slightly`, `overlapping_slightly`: True if the nested components, or the smaller components of the
    overlapping pairs, are too small to matter.
    """

    nested: NDArray[np.intp]
    overlapping: NDArray[np.intp]
    undecided_pairs: int
    nested_slightly: bool
    overlapping_slightly: bool


def compare_places(solids: Sequence[tuple[SolidIntegrals, NDArray[np.float64]]]) -> PlaceComparison:
    """Find solids that overlap or contain each other in their places, given by (k, 4, 4) maps for each solid."""
    points, triangles, component, owner, place, closed = [], [], [], [], [], []
    number = shift = places = 0
    displacement = 0.0
    for which, (solid, matrices) in enumerate(solids):
        parts, count = solid.parts(), len(matrices)
        linear, at = matrices[:, :3, :3], np.arange(count)
        points.append(parts.points.astype(np.float64) @ linear.transpose(0, 2, 1) + matrices[:, None, :3, 3])
        mirrored = np.linalg.det(linear)[:, None, None] < 0.0
        images = np.where(mirrored, parts.triangles[:, ::-1], parts.triangles).astype(np.intp)
        triangles.append(images + (shift + len(parts.points) * at)[:, None, None])
        component.append(parts.part + (number + parts.number * at)[:, None])
        owner.append(np.tile(np.stack([np.full(parts.number, which), np.arange(parts.number)], axis=1), (count, 1)))
        place.append(np.repeat(places + at, parts.number))
        closed.append(np.tile(solid.oriented.solid & ~solid.oriented.mesh.open, count))
        moved = np.abs(linear) @ solid.repaired_surface.coordinate_error
        displacement = max(displacement, float(np.linalg.norm(moved, axis=1).max()))
        number, shift, places = number + count * parts.number, shift + count * len(parts.points), places + count
    owner, place, closed = np.concatenate(owner), np.concatenate(place), np.concatenate(closed)
    corners = np.concatenate([image.reshape(-1, 3) for image in points])
    components = sort_components(
        corners,
        np.concatenate([image.reshape(-1, 3) for image in triangles]),
        np.concatenate([image.ravel() for image in component]),
        number,
    )
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    tolerance = welding_tolerance(size, displacement)
    extent = np.linalg.norm(components.high - components.low, axis=1)
    flattened = np.abs(components.volume) <= CLOSED_SHEET_VOLUME_RTOL * extent * components.area
    relations = classify_pairs(corners, components, closed & ~flattened, tolerance)
    inner, outer = relations.contained_in.T
    elsewhere = place[inner] != place[outer]
    inner, outer = inner[elsewhere], outer[elsewhere]
    # Count how often each other place surrounds a component: 0 in its cavities.
    key, pair = np.unique(inner * places + place[outer], return_inverse=True)
    surrounds = np.bincount(pair.ravel(), np.sign(components.volume[outer])) > 0.0
    nested = np.unique((key // places)[surrounds])
    nested = nested[components.volume[nested] > 0.0]
    pairs = relations.intersecting
    pairs = pairs[place[pairs[:, 0]] != place[pairs[:, 1]]]
    negligible = NEGLIGIBLE * components.volume.sum() / size
    return PlaceComparison(
        owner[nested],
        owner[np.unique(pairs)],
        relations.undecided_pairs,
        bool(components.area[nested].sum() < negligible),
        bool(components.area[pairs].min(axis=1).sum() < negligible),
    )
