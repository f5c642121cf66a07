# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of one surface: mapped areas, overlaps, the health and warnings of all together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.boxes import boxes_meet
from ...core.mesh.surface import Surface
from ...core.moments.affine_maps import distinct_linear, translations
from ...core.moments.moments import Moments, are_similarities, map_sum
from ...core.polyhedron.sheared_areas import area_of_images
from ...core.verdict.health import Faults, Health
from ..read import Reading

RANKED = ("open", "capped", "reoriented", "exact")  # methods: of several, the first counts


FLATTENED = (
    "A zero scale flattens it; set its scale, or its parents', to something else than zero, or measure it as a shell."
)


ALL_FLATTENED = (
    "A zero scale flattens all that it instances; give the instances another scale, or measure it as a shell."
)


MOST_NAMED = 8  # surfaces, or faces, that a sentence names


NOT_COMPARED = (
    "Overlap was not looked for between its {:d} instances, and boxes around some of them overlap; what "
    "those share counts twice."
)


def flattened_reason(reading: Reading) -> str:
    """Why nothing of a singular reading encloses anything, with the remedy."""
    return FLATTENED if reading.flat else ALL_FLATTENED


def some_flattened(count: int) -> str:
    """A sentence about so many instances that enclose nothing."""
    return (
        "One of its instances is flattened by a zero scale and encloses nothing."
        if count == 1
        else "{:d} of its instances are flattened by a zero scale and enclose nothing.".format(count)
    )


def told_of_parts(parts: Iterable[tuple[str, Iterable[str]]], whole: str) -> list[str]:
    """The sentences of several parts, as (name, sentences), each sentence once. Of a part that is all of the object
    `whole` they stay as they are; else the names come before them, for “it” is a part then."""
    parts = list(parts)
    named: dict[str, list[str]] = {}
    for k, (name, sentences) in enumerate(parts):
        for sentence in sentences:
            named.setdefault(sentence, []).append(
                "“{:s}”".format(name) if name else "Surface {:d} of {:d}".format(k + 1, len(parts))
            )
    if len(parts) == 1 and parts[0][0] in ("", whole):
        return list(named)
    return [
        "{:s}: {:s}".format(", ".join(names[:MOST_NAMED] + ["…"] * (len(names) > MOST_NAMED)), sentence)
        for sentence, names in named.items()
    ]


def places_meet(reading: Reading) -> bool:
    """Whether the boxes around any two of the places where parts stand share more than a rim."""
    centers, extents = [], []
    for part in reading.parts:
        low, high = part.surface.box
        linear = part.matrices[:, :3, :3]
        centers.append(linear @ ((low + high) / 2.0) + part.matrices[:, :3, 3])
        extents.append(np.abs(linear) @ ((high - low) / 2.0))
    return boxes_meet(np.concatenate(centers), np.concatenate(extents))


def in_metres(matrices: NDArray, unit: float) -> NDArray[np.float64]:
    """World matrices to SI."""
    scaled = np.array(matrices, np.float64)
    scaled[:, :3] *= unit
    return scaled


def mapped_areas(
    surface: Surface, area: Moments, matrices: NDArray, measured: Callable[[Surface], Moments] | None
) -> Iterator[Moments]:
    """The area moments of a surface's images. They do not follow a map that stretches unevenly, so there the mapped
    surface is `measured`, once for each different map; with None, only the area itself is wanted."""
    if measured is None:
        even = are_similarities(matrices[:, :3, :3])
        if even.any():
            yield map_sum(area, matrices[even])
        if not even.all():
            yield area_of_images(surface, matrices[~even, :3, :3])
        return
    for image, places, _ in even_surfaces(surface, matrices):
        yield map_sum(area if image is surface else measured(image), places)


def even_surfaces(surface: Surface, matrices: NDArray) -> Iterator[tuple[Surface, NDArray, NDArray]]:
    """A surface's images as images under similarities: the surface itself or mapped ones, one for each different uneven
    map, with the (j, 4, 4) maps that are left and which of `matrices` they stand for, (j,)."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield surface, matrices[even], np.flatnonzero(even)
    if even.all():
        return
    rest = np.flatnonzero(~even)
    for linear, own in distinct_linear(matrices[rest]):
        yield surface.mapped(linear), translations(matrices[rest[own], :3, 3]), rest[own]


def together(healths: Iterable[tuple[Health, int, float]]) -> Health:
    """One verdict for all parts, each with the number of its instances and the area of all of them: counts add; faults
    are named where there is one part only."""
    healths = list(healths)
    first, copies, _ = healths[0]
    if len(healths) == 1 and copies == 1:
        return first
    area = sum(own for *_, own in healths)
    total = {
        "faults": Faults(),
        "closed": all(h.closed for h, *_ in healths),
        "welded": any(h.welded for h, *_ in healths),
        "volume_spread": sum(h.volume_spread for h, *_ in healths),
        "cap_area_share": sum(h.cap_area_share * own for h, _, own in healths) / area if area > 0.0 else 0.0,
    }
    for field in fields(Health):
        if field.name not in total:
            total[field.name] = sum(getattr(h, field.name) * k for h, k, _ in healths)
    return Health(**total)
