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
from ..numerics import Array, Index, Mask, NDArray, sums_by_index
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
    """Return findings of parts, (object's name, findings), with equal ones joined and the names of
    their objects added; those of `whole` alone as they are.
    """
    parts = list(parts)
    if len(parts) == 1 and parts[0][0] in ("", whole):
        return each_once(parts[0][1])
    results = {}
    sources: dict[tuple, dict[str, None]] = {}  # names in order, each once
    for name, findings in parts:
        for result in findings:
            key = _identity(result)
            results.setdefault(key, result)
            sources.setdefault(key, {})[name or whole] = None
    return [result.of_sources(list(sources[key])) for key, result in results.items()]


def each_once(findings: Iterable[verdict.Finding]) -> list[verdict.Finding]:
    """Return the findings in their order, without repetitions about the same elements."""
    return list({_identity(result): result for result in findings}.values())


def _identity(result: verdict.Finding) -> tuple[verdict.Finding, object]:
    """Return a key that is equal for findings with equal values and elements."""
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


@dataclass(frozen=True, eq=False)
class _Images:
    """The components of solids in all their places, as one mesh in the world.

    corners: (n, 3). triangles: (t, 3). component: (t,) of each triangle, 0 to c - 1. owner: (c, 2)
    [solid, its component] of each component. place: (c,) number of its place, each of one solid.
    is_closed: (c,). displacement: largest error of a corner by the rounding of coordinates.
    """

    corners: Array
    triangles: Index
    component: Index
    owner: Index
    place: Index
    is_closed: Mask
    displacement: float


def _place_solids(solids: Sequence[tuple[SolidIntegrals, Array]]) -> _Images:
    """Return the images of solids under (k, 4, 4) maps each."""
    images_of_solids = []
    corner_count = component_count = place_count = 0
    displacement = 0.0
    for solid_index, (solid, matrices) in enumerate(solids):
        parts = solid.parts()
        linear = matrices[:, :3, :3]
        corners = parts.points.astype(np.float64) @ linear.transpose(0, 2, 1)
        corners += matrices[:, None, :3, 3]
        # A mirrored image keeps its faces outward.
        is_mirrored = np.linalg.det(linear)[:, None, None] < 0.0
        faces = np.where(is_mirrored, parts.triangles[:, ::-1], parts.triangles).astype(np.intp)
        copies = np.arange(len(matrices))
        first_corner = corner_count + len(parts.points) * copies
        first_component = component_count + parts.number * copies
        own_components = np.tile(np.arange(parts.number), len(copies))
        images_of_solids.append(
            (
                corners.reshape(-1, 3),
                (faces + first_corner[:, None, None]).reshape(-1, 3),
                (parts.part + first_component[:, None]).ravel(),
                np.stack([np.full_like(own_components, solid_index), own_components], axis=1),
                np.repeat(place_count + copies, parts.number),
                # parts are the mesh's components, in their order
                np.tile(solid.oriented.solid & ~solid.oriented.mesh.open, len(copies)),
            )
        )
        error = np.abs(linear) @ solid.repaired_surface.coordinate_error
        displacement = max(displacement, float(np.linalg.norm(error, axis=1).max()))
        corner_count += len(copies) * len(parts.points)
        component_count += len(copies) * parts.number
        place_count += len(copies)
    arrays = [np.concatenate(of_solids) for of_solids in zip(*images_of_solids)]
    corners, triangles, component, owner, place, is_closed = arrays
    return _Images(corners, triangles, component, owner, place, is_closed, displacement)


def compare_places(solids: Sequence[tuple[SolidIntegrals, Array]]) -> PlaceComparison:
    """Find solids that overlap or contain each other in their places, given by (k, 4, 4) maps for
    each solid.
    """
    images = _place_solids(solids)
    place = images.place
    components = mesh.sort_components(
        images.corners, images.triangles, images.component, len(place)
    )
    size = float(np.linalg.norm(np.ptp(images.corners, axis=0)))
    tolerance = verdict.welding_tolerance(size, images.displacement)
    extent = np.linalg.norm(components.high - components.low, axis=1)
    is_flat = np.abs(components.volume) <= verdict.CLOSED_SHEET_VOLUME_RTOL * extent * (
        components.area
    )
    relations = classify_pairs(images.corners, components, images.is_closed & ~is_flat, tolerance)
    inner, outer = relations.contained_in.T
    is_elsewhere = place[inner] != place[outer]
    inner = inner[is_elsewhere]
    outer = outer[is_elsewhere]
    # For each component and other place: how many times the components there surround it, less the
    # cavities that it is in. So 0 in a cavity.
    pairs, pair_index = np.unique(
        np.stack([inner, place[outer]], axis=1), axis=0, return_inverse=True
    )
    times = sums_by_index(pair_index.ravel(), np.sign(components.volume[outer]), len(pairs))
    nested = np.unique(pairs[times > 0.0, 0])
    nested = nested[components.volume[nested] > 0.0]
    overlapping = relations.intersecting  # (k, 2)
    overlapping = overlapping[place[overlapping[:, 0]] != place[overlapping[:, 1]]]
    # An area: pieces that share it are at most `size` deep, so that they share less than the
    # negligible part of the volume.
    negligible = verdict.NEGLIGIBLE * components.volume.sum() / size
    return PlaceComparison(
        images.owner[nested],
        images.owner[np.unique(overlapping)],
        relations.undecided_pairs,
        nested_slightly=bool(components.area[nested].sum() < negligible),
        overlapping_slightly=bool(components.area[overlapping].min(axis=1).sum() < negligible),
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
        if not len(components):
            continue
        elements = []
        for number in np.unique(components[:, 0]):
            parts = solids[number].parts()
            name = reading.parts[number].source_object_name or reading.name
            of_solid = components[components[:, 0] == number, 1]
            faces = parts.face[np.isin(parts.part, of_solid) & (parts.face >= 0)]
            elements += [[face, name] for face in np.unique(faces).tolist()]
        findings.append(verdict.finding(code, elements, slight=slight, count=len(components)))
    count = comparison.undecided_pairs
    if count:
        findings.append(verdict.finding(UNCHECKED, subject=OVERLAP_OF_COMPONENTS, count=count))
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
    """Yield the area moments of a surface's images.

    area: moments of the surface, which similarities map. measured: returns those of a surface that
    another map has made; None if totals are enough.
    """
    if measured is None:
        is_even = moments.are_similarities(matrices[:, :3, :3])
        if is_even.any():
            yield moments.sum_of_images(area, matrices[is_even])
        if not is_even.all():
            yield polyhedron.area_of_images(surface, matrices[~is_even, :3, :3])
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
    parts = list(healths)
    first, copies, _ = parts[0]
    if len(parts) == 1 and copies == 1:
        return first
    area = sum(part_area for *_, part_area in parts)
    cap_area = sum(health.cap_area_share * part_area for health, _, part_area in parts)
    total = {
        "defective_elements": verdict.DefectiveElements(),
        "closed": all(health.closed for health, *_ in parts),
        "welded": any(health.welded for health, *_ in parts),
        verdict.SELF_INTERSECTION: min(
            (health.self_intersection for health, *_ in parts),
            key=list(verdict.Intersection).index,
        ),
        "volume_spread": sum(health.volume_spread for health, *_ in parts),
        "cap_area_share": cap_area / area if area > 0.0 else 0.0,
    }
    for field in fields(verdict.MeshHealth):
        if field.name not in total:
            total[field.name] = sum(
                getattr(health, field.name) * count for health, count, _ in parts
            )
    return verdict.MeshHealth(**total)
