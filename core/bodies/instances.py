# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of one surface: mapped areas, overlaps, the health and findings of all together."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from ..mesh.boxes import boxes_overlap
from ..mesh.surface import Surface
from ..moments.affine_maps import are_similarities, distinct_linear_parts, translation_matrices
from ..moments.images import sum_of_images
from ..moments.moments import Moments
from ..polyhedron.integration import area_of_images
from ..solid.findings import COMPONENTS_NESTED, COMPONENTS_OVERLAP, OVERLAP_UNCHECKED
from ..solid.instance_overlaps import PlaceComparison
from ..solid.solid_verdict import SolidIntegrals
from ..verdict.finding import Finding, finding
from ..verdict.findings import SELF_INTERSECTION
from ..verdict.health import DefectiveElements, Intersection, MeshHealth
from .findings import FLAT_SURFACES
from .reading import Reading


def singular_instances_message(reading: Reading) -> Finding:
    """Return the finding that some instances enclose nothing."""
    return finding(FLAT_SURFACES, count=reading.singular_instance_count, total=reading.instance_count)


def findings_by_part(parts: Iterable[tuple[str, Iterable[Finding]]], whole: str) -> list[Finding]:
    """Return findings of parts, (object's name, findings), with equal ones joined, and those of `whole` as they are."""
    parts = list(parts)
    if len(parts) == 1 and parts[0][0] in ("", whole):
        return each_once(parts[0][1])
    merged: dict[tuple, tuple[Finding, dict[str, None]]] = {}
    for name, findings in parts:
        for result in findings:
            merged.setdefault(_identity(result), (result, {}))[1][name or whole] = None
    return [result.of_sources(list(names)) for result, names in merged.values()]


def each_once(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings in their order, without repetitions about the same elements."""
    return list({_identity(result): result for result in findings}.values())


def _identity(result: Finding) -> tuple[Finding, object]:
    elements = result.elements
    return result, elements.tobytes() if isinstance(elements, np.ndarray) else repr(elements)


def overlap_findings(reading: Reading, solids: Sequence[SolidIntegrals], comparison: PlaceComparison) -> list[Finding]:
    """Return findings about places that overlap or contain each other, with [face, source name] as elements."""
    findings = []
    for code, components, slight in (
        (COMPONENTS_NESTED, comparison.nested, comparison.nested_slightly),
        (COMPONENTS_OVERLAP, comparison.overlapping, comparison.overlapping_slightly),
    ):
        if len(components):
            elements = []
            for which in np.unique(components[:, 0]):
                parts, name = solids[which].parts(), reading.parts[which].source_object_name or reading.name
                of_these = np.isin(parts.part, components[components[:, 0] == which, 1]) & (parts.face >= 0)
                elements += [[face, name] for face in np.unique(parts.face[of_these]).tolist()]
            findings.append(finding(code, elements, slight=slight, count=len(components)))
    if comparison.undecided_pairs:
        findings.append(finding(OVERLAP_UNCHECKED, count=comparison.undecided_pairs))
    return findings


def with_overlaps(health: MeshHealth, comparison: PlaceComparison) -> MeshHealth:
    """Return the health that also counts components inside, or overlapping, components of another place."""
    return replace(
        health,
        nested_components=health.nested_components + len(comparison.nested),
        overlapping_components=health.overlapping_components + len(comparison.overlapping),
    )


def instances_overlap(reading: Reading) -> bool:
    """Return whether the boxes around any two places of parts share more than a boundary."""
    return boxes_overlap(*_boxes(reading))


def instances_size(reading: Reading) -> float:
    """Return the diagonal of the box around all instances, in Blender units."""
    centers, extents = _boxes(reading)
    return float(np.linalg.norm((centers + extents).max(axis=0) - (centers - extents).min(axis=0)))


def _boxes(reading: Reading) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (k, 3) middles and (k, 3) half sides of the boxes around the places of parts."""
    centers, extents = [], []
    for part in reading.parts:
        low, high = part.surface.box
        linear = part.matrices[:, :3, :3]
        centers.append(linear @ ((low + high) / 2.0) + part.matrices[:, :3, 3])
        extents.append(np.abs(linear) @ ((high - low) / 2.0))
    return np.concatenate(centers), np.concatenate(extents)


def area_of_instances(
    surface: Surface, area: Moments, matrices: NDArray, measured: Callable[[Surface], Moments] | None
) -> Iterator[Moments]:
    """Yield the area moments of a surface's images, `measured` once for each uneven map, or None for totals alone."""
    if measured is None:
        even = are_similarities(matrices[:, :3, :3])
        if even.any():
            yield sum_of_images(area, matrices[even])
        if not even.all():
            yield area_of_images(surface, matrices[~even, :3, :3])
        return
    for image, matrices_of_image, _ in group_by_similarity(surface, matrices):
        yield sum_of_images(area if image is surface else measured(image), matrices_of_image)


def group_by_similarity(surface: Surface, matrices: NDArray) -> Iterator[tuple[Surface, NDArray, NDArray]]:
    """Yield (surface, (j, 4, 4) similarities, (j,) rows of `matrices`), with a mapped surface for each uneven map."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield surface, matrices[even], np.flatnonzero(even)
    if even.all():
        return
    rest = np.flatnonzero(~even)
    for linear, members in distinct_linear_parts(matrices[rest]):
        yield surface.transform(linear), translation_matrices(matrices[rest[members], :3, 3]), rest[members]


def merge_health(healths: Iterable[tuple[MeshHealth, int, float]]) -> MeshHealth:
    """Return the summed health of parts (health, instances, area); only a single part keeps its faulty elements."""
    healths = list(healths)
    first, copies, _ = healths[0]
    if len(healths) == 1 and copies == 1:
        return first
    area = sum(part_area for *_, part_area in healths)
    total = {
        "defective_elements": DefectiveElements(),
        "closed": all(h.closed for h, *_ in healths),
        "welded": any(h.welded for h, *_ in healths),
        SELF_INTERSECTION: min((h.self_intersection for h, *_ in healths), key=list(Intersection).index),
        "volume_spread": sum(h.volume_spread for h, *_ in healths),
        "cap_area_share": sum(h.cap_area_share * part_area for h, _, part_area in healths) / area
        if area > 0.0
        else 0.0,
    }
    for field in fields(MeshHealth):
        if field.name not in total:
            total[field.name] = sum(getattr(h, field.name) * k for h, k, _ in healths)
    return MeshHealth(**total)
