# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of one surface: mapped areas, overlaps, the health and findings of all together.

Each solid is measured by itself, with its own cavities. A volume common to two counts twice, and is
reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields

import numpy as np

from .. import mesh, moments, polyhedron, verdict
from ..numerics import Array, Index, NDArray
from ..solid import (
    COMPONENTS_NESTED,
    COMPONENTS_OVERLAP,
    OVERLAP_OF_COMPONENTS,
    UNCHECKED,
    SolidIntegrals,
    classify_pairs,
)
from .findings import FLAT_SURFACES
from .reading import Reading


def singular_instances_message(reading: Reading) -> verdict.Finding:
    """Return the finding that some instances enclose nothing."""
    return verdict.finding(
        FLAT_SURFACES, count=reading.singular_instance_count, total=reading.instance_count
    )


def findings_by_part(
    parts: Iterable[tuple[str, Iterable[verdict.Finding]]], whole: str
) -> list[verdict.Finding]:
    """Return findings of parts, (object's name, findings), with equal ones joined, and those of
    `whole` as they are.
    """
    parts = list(parts)
    if len(parts) == 1 and parts[0][0] in ("", whole):
        return each_once(parts[0][1])
    merged: dict[tuple, tuple[verdict.Finding, dict[str, None]]] = {}
    for name, findings in parts:
        for result in findings:
            merged.setdefault(_identity(result), (result, {}))[1][name or whole] = None
    return [result.of_sources(list(names)) for result, names in merged.values()]


def each_once(findings: Iterable[verdict.Finding]) -> list[verdict.Finding]:
    """Return the findings in their order, without repetitions about the same elements."""
    return list({_identity(result): result for result in findings}.values())


def _identity(result: verdict.Finding) -> tuple[verdict.Finding, object]:
    elements = result.elements
    return result, elements.tobytes() if isinstance(elements, np.ndarray) else repr(elements)


@dataclass(frozen=True, eq=False)
class PlaceComparison:
    """Solids inside other ones, or overlapping them: (k, 2) [solid, component], once for each
    place.

    `nested`: components in the material of others. `overlapping`: components that share a part of
    their interiors. `undecided_pairs`: number of pairs that would have been too much work.
    `nested_slightly`, `overlapping_slightly`: True if the nested components, or the smaller
    components of the overlapping pairs, are too small to matter.
    """

    nested: Index
    overlapping: Index
    undecided_pairs: int
    nested_slightly: bool
    overlapping_slightly: bool


def compare_places(solids: Sequence[tuple[SolidIntegrals, Array]]) -> PlaceComparison:
    """Find solids that overlap or contain each other in their places, given by (k, 4, 4) maps for
    each solid.
    """
    points = []
    triangles = []
    component = []
    owner = []
    place = []
    closed = []
    number = shift = places = 0
    displacement = 0.0
    for which, (solid, matrices) in enumerate(solids):
        parts = solid.parts()
        count = len(matrices)
        linear = matrices[:, :3, :3]
        at = np.arange(count)
        points.append(
            parts.points.astype(np.float64) @ linear.transpose(0, 2, 1) + matrices[:, None, :3, 3]
        )
        mirrored = np.linalg.det(linear)[:, None, None] < 0.0
        images = np.where(mirrored, parts.triangles[:, ::-1], parts.triangles).astype(np.intp)
        triangles.append(images + (shift + len(parts.points) * at)[:, None, None])
        component.append(parts.part + (number + parts.number * at)[:, None])
        owner.append(
            np.tile(
                np.stack([np.full(parts.number, which), np.arange(parts.number)], axis=1),
                (count, 1),
            )
        )
        place.append(np.repeat(places + at, parts.number))
        closed.append(np.tile(solid.oriented.solid & ~solid.oriented.mesh.open, count))
        moved = np.abs(linear) @ solid.repaired_surface.coordinate_error
        displacement = max(displacement, float(np.linalg.norm(moved, axis=1).max()))
        number = number + count * parts.number
        shift = shift + count * len(parts.points)
        places = places + count
    owner = np.concatenate(owner)
    place = np.concatenate(place)
    closed = np.concatenate(closed)
    corners = np.concatenate([image.reshape(-1, 3) for image in points])
    components = mesh.sort_components(
        corners,
        np.concatenate([image.reshape(-1, 3) for image in triangles]),
        np.concatenate([image.ravel() for image in component]),
        number,
    )
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    tolerance = verdict.welding_tolerance(size, displacement)
    extent = np.linalg.norm(components.high - components.low, axis=1)
    flattened = (
        np.abs(components.volume) <= verdict.CLOSED_SHEET_VOLUME_RTOL * extent * components.area
    )
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
    negligible = verdict.NEGLIGIBLE * components.volume.sum() / size
    return PlaceComparison(
        owner[nested],
        owner[np.unique(pairs)],
        relations.undecided_pairs,
        bool(components.area[nested].sum() < negligible),
        bool(components.area[pairs].min(axis=1).sum() < negligible),
    )


def overlap_findings(
    reading: Reading, solids: Sequence[SolidIntegrals], comparison: PlaceComparison
) -> list[verdict.Finding]:
    """Return findings about places that overlap or contain each other, with [face, source name] as
    elements.
    """
    findings = []
    for code, components, slight in (
        (COMPONENTS_NESTED, comparison.nested, comparison.nested_slightly),
        (COMPONENTS_OVERLAP, comparison.overlapping, comparison.overlapping_slightly),
    ):
        if len(components):
            elements = []
            for which in np.unique(components[:, 0]):
                parts = solids[which].parts()
                name = reading.parts[which].source_object_name or reading.name
                of_these = np.isin(parts.part, components[components[:, 0] == which, 1]) & (
                    parts.face >= 0
                )
                elements += [[face, name] for face in np.unique(parts.face[of_these]).tolist()]
            findings.append(verdict.finding(code, elements, slight=slight, count=len(components)))
    if comparison.undecided_pairs:
        findings.append(
            verdict.finding(
                UNCHECKED, subject=OVERLAP_OF_COMPONENTS, count=comparison.undecided_pairs
            )
        )
    return findings


def instances_overlap(reading: Reading) -> bool:
    """Return whether the boxes around any two places of parts share more than a boundary."""
    return mesh.boxes_overlap(*_boxes(reading))


def instances_size(reading: Reading) -> float:
    """Return the diagonal of the box around all instances, in Blender units."""
    centers, extents = _boxes(reading)
    return float(np.linalg.norm((centers + extents).max(axis=0) - (centers - extents).min(axis=0)))


def _boxes(reading: Reading) -> tuple[Array, Array]:
    """Return (k, 3) middles and (k, 3) half sides of the boxes around the places of parts."""
    centers, extents = zip(
        *[moments.placed_boxes(part.surface.box, part.matrices) for part in reading.parts]
    )
    return np.concatenate(centers), np.concatenate(extents)


def area_of_instances(
    surface: mesh.Surface,
    area: moments.Moments,
    matrices: NDArray,
    measured: Callable[[mesh.Surface], moments.Moments] | None,
) -> Iterator[moments.Moments]:
    """Yield the area moments of a surface's images, `measured` once for each uneven map, or None
    for totals alone.
    """
    if measured is None:
        even = moments.are_similarities(matrices[:, :3, :3])
        if even.any():
            yield moments.sum_of_images(area, matrices[even])
        if not even.all():
            yield polyhedron.area_of_images(surface, matrices[~even, :3, :3])
        return
    for image, matrices_of_image, _ in group_by_similarity(surface, matrices):
        yield moments.sum_of_images(
            area if image is surface else measured(image), matrices_of_image
        )


def group_by_similarity(
    surface: mesh.Surface, matrices: NDArray
) -> Iterator[tuple[mesh.Surface, NDArray, NDArray]]:
    """Yield (surface, (j, 4, 4) similarities, (j,) rows of `matrices`), with a mapped surface for
    each uneven map.
    """
    for rows, is_even in moments.similarity_groups(matrices):
        if is_even:
            yield surface, matrices[rows], rows
        else:
            yield (
                surface.transform(matrices[rows[0], :3, :3]),
                moments.affine_matrices(np.eye(3), matrices[rows, :3, 3]),
                rows,
            )


def merge_health(healths: Iterable[tuple[verdict.MeshHealth, int, float]]) -> verdict.MeshHealth:
    """Return the summed health of parts (health, instances, area); only a single part keeps its
    faulty elements.
    """
    healths = list(healths)
    first, copies, _ = healths[0]
    if len(healths) == 1 and copies == 1:
        return first
    area = sum(part_area for *_, part_area in healths)
    total = {
        "defective_elements": verdict.DefectiveElements(),
        "closed": all(h.closed for h, *_ in healths),
        "welded": any(h.welded for h, *_ in healths),
        verdict.SELF_INTERSECTION: min(
            (h.self_intersection for h, *_ in healths), key=list(verdict.Intersection).index
        ),
        "volume_spread": sum(h.volume_spread for h, *_ in healths),
        "cap_area_share": sum(h.cap_area_share * part_area for h, _, part_area in healths) / area
        if area > 0.0
        else 0.0,
    }
    for field in fields(verdict.MeshHealth):
        if field.name not in total:
            total[field.name] = sum(getattr(h, field.name) * k for h, k, _ in healths)
    return verdict.MeshHealth(**total)
