# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a body bounded by B-spline patches: its kind, the decisions taken, and its
moments.

The counterpart of `core.solid` for surfaces that are not made of polygons, with the same
procedures: patches that face against the rest of their part are turned, holes are capped, parts
that are inside out and in no other part's material are turned, and unclosable patches are measured
as a signed sum and called open. Parts are compared by samples of their patches: an overlap that is
thinner than a hundredth of a part may be missed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..mesh import SortedComponents, sort_components
from ..moments import Moments, sum_moments
from ..numerics import Array, Index, Mask, NDArray, check_filled
from ..solid import (
    CAVITIES_BREAK_THROUGH,
    CAVITIES_SUBTRACTED,
    COMPONENTS_NESTED,
    COMPONENTS_OVERLAP,
    FLAT_COMPONENTS,
    FLAT_SURFACE,
    OVERLAP_OF_COMPONENTS,
    UNCHECKED,
    ComponentComparison,
    ComponentRelations,
    classify_pairs,
    zero_volume,
)
from ..verdict import (
    NEGLIGIBLE,
    Finding,
    MeasureError,
    MeshHealth,
    Procedure,
    finding,
    welding_tolerance,
)
from .findings import (
    AMBIGUOUS_PATCH_SIDES,
    ERROR_ESTIMATE_LARGE,
    FLIPPED_PATCHES,
    INVERTED_PATCH_COMPONENTS,
    NO_EXTENT,
    OPEN_PATCH_SIDES,
    PATCH_BOUNDARY_CROSSES_ITSELF,
    PATCH_HOLES_CAPPED,
)
from .flat_face import split_faces
from .patch_moments import (
    area_moments,
    area_slope,
    sheet_moments,
    volume_moments,
    with_area_error,
    with_swept_error,
)
from .patch_topology import PatchTopology, find_topology
from .splines import Face, Patch, patches_center, patches_size
from .trimmed_face import TrimmedFace

# For comparing parts, and for parts that seem to cross.
SAMPLES_PER_SPAN = 8
FINE_SAMPLES_PER_SPAN = 48
MAX_TRIANGLES = 1_000_000  # Limit for the fine samples.


@dataclass(frozen=True, eq=False)
class PatchIntegrals:
    """The moments of the body that patches bound, and how they came about; errors are estimates.

    `area`: moments of the patches, without caps. `health`: state of the input.
    `method`: EXACT, CAPPED, REORIENTED or OPEN.
    `patches`: the counted faces and caps, oriented so that their sum is `volume`.
    `signs`: (n,) how each given patch counts: 1, -1, or 0 if its part is left out.
    """

    volume: Moments
    area: Moments
    health: MeshHealth
    method: Procedure
    findings: tuple[Finding, ...]
    patches: tuple[Face, ...]
    signs: Array
    topology: PatchTopology


def measure_patches(
    patches: Sequence[Face], *, order: int = 3, area_order: int = 0, stored: float = 0.0
) -> PatchIntegrals:
    """Measure the body that B-spline patches bound, and flat faces with curved boundaries.

    Its moments are about the middle of the control points' bounding box.

    Parameters
    ----------
    patches : sequence of Patch or FlatFace
        In any order and orientation.
    order, area_order : int
        Orders of the volume's moments and of the area's.
    stored : float
        Largest displacement of a control point by storing it, for the moments' `input_error`.

    Returns
    -------
    PatchIntegrals
        In the patches' own coordinates and unit.

    Raises
    ------
    MeasureError
        If all control points coincide, or a patch may be torn at a knot.

    Notes
    -----
    Soldea, Elber and Rivlin, sections 2 and 3, by a radial flux; see `patch_moments`.

    Examples
    --------
    >>> from body_moments.core.nurbs import Patch, measure_patches
    >>> from body_moments.core.numerics import clamped_space
    >>> line = clamped_space(2)
    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])
    >>> around = np.stack([np.insert(corners, 2, z, axis=1) for z in (0.0, 1.0)], axis=1)
    >>> body = measure_patches([Patch((clamped_space(2, (0.25, 0.5, 0.75)), line), around)])
    >>> str(body.method), round(body.volume.total, 9)
    ('capped', 1.0)
    """
    check_filled("patches", patches)
    size = patches_size(patches)
    if not size > 0.0:
        raise MeasureError(NO_EXTENT)
    about = patches_center(patches)
    topology = find_topology(patches, welding_tolerance(size, stored))
    area, converged = area_moments(patches, area_order, about)
    findings = () if converged else (finding(ERROR_ESTIMATE_LARGE, quantity="area"),)
    parts = oriented_parts(patches, topology)
    measured = [volume_moments(part, order, about) for part in parts]
    return assess(patches, topology, parts, measured, area, area_slope(patches), stored, findings)


def oriented_parts(patches: Sequence[Face], topology: PatchTopology) -> list[list[Face]]:
    """Return the faces of each component, facing the same way, with the caps of its holes."""
    parts: list[list[Face]] = [[] for _ in range(topology.number)]
    for patch, turn, part in zip(patches, topology.flipped, topology.component):
        parts[part].append(patch.reverse_orientation() if turn else patch)
    for loop in topology.loops:
        parts[loop.component] += loop.caps
    return parts


def assess(
    patches: Sequence[Face],
    topology: PatchTopology,
    parts: Sequence[list[Face]],
    measured: Sequence[tuple[Moments, bool]],
    area: Moments,
    slope: float,
    stored: float,
    findings: Sequence[Finding] = (),
) -> PatchIntegrals:
    """Sum the `measured` moments of the parts, inverted ones turned and uncounted ones left out;
    add findings.

    measured: of each part, the volume's moments and whether they converged. slope: of `area_slope`.
    """
    size = patches_size(patches)
    cap_area = np.zeros(topology.number)
    for loop in topology.loops:
        cap_area[loop.component] += 0.0 if loop.zero_area else loop.area
    total = np.array([moments.total for moments, _ in measured])
    least_volume = zero_volume(size, area.total, cap_area > 0.0, stored)
    solid = ~topology.unclosable & (np.abs(total) > least_volume)
    comparison = _compare_parts(parts, total, solid, welding_tolerance(size, stored))
    inverted = solid & (total < 0.0) if comparison is None else comparison.flipped
    is_counted = solid if solid.any() else topology.unclosable
    counted_parts = np.flatnonzero(is_counted).tolist()
    part_signs = np.where(inverted, -1.0, 1.0)
    volumes = [measured[k][0] * float(part_signs[k]) for k in counted_parts]
    volume = sum_moments(volumes) if volumes else measured[0][0] * 0.0
    # May be negative if open, or if cavities overlap.
    if volume.total < 0.0:
        part_signs = -part_signs
        volume = replace(volume, raw=-volume.raw)
    # The box's diagonal grows by twice the displacement; 4 leaves a margin.
    reach = size + 4.0 * stored
    # Caps move with their boundaries: their area counts too.
    skin = area.total + sum(loop.area for loop in topology.loops)
    uneven = sum(face.uneven for face in split_faces(patches)[1])
    # A gap lets through at most its area times a third of the distance from the reference point.
    gaps = topology.seam_gap * reach / 3.0
    volume = with_swept_error(volume, stored * skin + gaps + uneven, reach)
    misoriented = np.flatnonzero(topology.flipped).tolist()
    turned = np.flatnonzero(inverted).tolist()
    outward = tuple(
        patch.reverse_orientation() if part_signs[k] < 0.0 else patch
        for k in counted_parts
        for patch in parts[k]
    )
    signs = (part_signs * is_counted)[topology.component] * np.where(topology.flipped, -1.0, 1.0)
    health = MeshHealth(
        closed=not (topology.unclosable.any() or cap_area.any()),
        boundary_edges=topology.open_sides,
        non_manifold_edges=topology.non_manifold_sides,
        inconsistent_edges=topology.misoriented_sides,
        components=topology.number,
        inverted_components=len(turned),
        cap_area_share=float(cap_area[solid].sum() / area.total) if area.total > 0.0 else 0.0,
    )
    if topology.unclosable.any() or not solid.any():
        method = Procedure.OPEN
    elif cap_area[solid].any():
        method = Procedure.CAPPED
    else:
        method = Procedure.REORIENTED if misoriented or turned else Procedure.EXACT
    all_findings = [
        *_orientation_findings(
            topology,
            [[patches[k]] for k in misoriented],
            [parts[k] for k in turned],
            size,
            volume.total,
        ),
        *_closing_findings(topology, solid, area.total, volume.total, size),
        *_component_findings(comparison, size),
        *findings,
    ]
    if not all(measured[k][1] for k in counted_parts):
        all_findings.append(finding(ERROR_ESTIMATE_LARGE, quantity="volume"))
    return PatchIntegrals(
        volume=volume,
        area=with_area_error(area, slope, stored, reach),
        health=health if comparison is None else comparison.add_to(health),
        method=method,
        findings=tuple(all_findings),
        patches=outward,
        signs=signs,
        topology=topology,
    )


def measure_sheet(
    patches: Sequence[Face], inner: float, outer: float, *, stored: float = 0.0
) -> tuple[Moments, Moments, bool]:
    """Measure the sheet between two heights along patches: volume, area, and whether both
    converged.
    """
    about = patches_center(patches)
    area, fine = area_moments(patches, 3, about)
    sheet, converged = sheet_moments(patches, inner, outer, 3, about)
    size = patches_size(patches)
    reach = size + max(abs(inner), abs(outer)) + 4.0 * stored
    area = with_area_error(area, area_slope(patches), stored, reach)
    # The volume grows with the area, by at most this thickness on average.
    thickness = max(abs(outer - inner), sheet.total / (area.total or 1.0))
    sheet = replace(sheet, input_error=thickness * area.input_error)
    return sheet, area, fine and converged


def _compare_parts(
    parts: Sequence[list[Face]], total: NDArray, solid: Mask, tolerance: float
) -> ComponentComparison | None:
    """Compare parts with each other and find the ones to turn; None for a single part, or if none
    is solid.
    """
    if len(parts) == 1 or not solid.any():
        return None
    components, relations = _classify_parts(parts, solid, SAMPLES_PER_SPAN, tolerance)
    crossing = np.unique(relations.intersecting)
    # Faces within curves count as patches with the spans of their first two curves: an estimate.
    spans = sum(
        math.prod(len(space.spans) for space in face.spaces[:2])
        for k in crossing
        for face in parts[k]
    )
    # A span of a patch has 2 each² triangles.
    each = min(FINE_SAMPLES_PER_SPAN, int(np.sqrt(MAX_TRIANGLES / (2.0 * max(spans, 1)))))
    # Parts with crossing samples may be merely near.
    if len(crossing) and each > SAMPLES_PER_SPAN:
        all_solid = np.ones(len(crossing), bool)
        _, finer = _classify_parts([parts[k] for k in crossing], all_solid, each, tolerance)
        relations = _refined(relations, finer, crossing, len(parts))
    return ComponentComparison.from_relations(replace(components, volume=total), relations, solid)


def _refined(
    relations: ComponentRelations, finer: ComponentRelations, crossing: Index, count: int
) -> ComponentRelations:
    """Return the relations of `count` parts with those that finer samples of the crossing ones
    show. crossing: (k,) the parts that `finer` counts from 0.
    """
    contained_in, intersecting = crossing[finer.contained_in], crossing[finer.intersecting]
    # A pair of parts as one number.
    number = np.array([count, 1])
    was_crossing = np.isin(np.sort(contained_in) @ number, np.sort(relations.intersecting) @ number)
    is_crossing = np.isin(np.sort(relations.intersecting) @ number, np.sort(intersecting) @ number)
    return ComponentRelations(
        np.concatenate([relations.contained_in, contained_in[was_crossing]]),
        relations.intersecting[is_crossing],
        relations.undecided_pairs,
        crossing[finer.mostly_in],
        finer.breakthrough,
    )


def _component_findings(comparison: ComponentComparison | None, size: float) -> list[Finding]:
    """Return findings about parts in other parts' material, and about parts that go through other
    parts.
    """
    if comparison is None:
        return []
    masks = {
        CAVITIES_SUBTRACTED: comparison.cavities & ~comparison.breaking,
        CAVITIES_BREAK_THROUGH: comparison.breaking,
        COMPONENTS_NESTED: comparison.nested,
        COMPONENTS_OVERLAP: comparison.intersecting,
    }
    findings = []
    for code, mask in masks.items():
        count = int(mask.sum())
        if count and code == CAVITIES_BREAK_THROUGH:
            share = float(comparison.breakthrough / size)
            findings.append(finding(code, count=count, share=share))
        elif count:
            findings.append(finding(code, count=count))
    if comparison.undecided_pairs:
        findings.append(
            finding(UNCHECKED, subject=OVERLAP_OF_COMPONENTS, count=int(comparison.undecided_pairs))
        )
    return findings


def _classify_parts(
    parts: Sequence[Sequence[Face]], solid: Mask, each: int, tolerance: float
) -> tuple[SortedComponents, ComponentRelations]:
    """Return components sampled `each` times per span, and their relations."""
    points, triangles, owners = [], [], []
    point_count = 0
    distance = 0.0
    for number, part in enumerate(parts):
        for face in part:
            corners, quads, sagitta = _sampled(face, each)
            points.append(corners)
            halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
            triangles.append(halves + point_count)
            owners.append(np.full(len(halves), number))
            point_count += len(corners)
            distance = max(distance, sagitta)
    all_points = np.concatenate(points)
    components = sort_components(
        all_points, np.concatenate(triangles), np.concatenate(owners), len(parts)
    )
    # Finer samples, which look again at parts that seem to cross, show a crossing only if it is
    # deeper than the distances of both parts from their samples.
    if each != SAMPLES_PER_SPAN:
        tolerance = max(tolerance, 2.0 * distance)
    return components, classify_pairs(all_points, components, solid, tolerance)


def _sampled(face: Face, each: int) -> tuple[NDArray, Index, float]:
    """Return points (n, 3) of a face, quads (f, 4) between them, and a bound of the face's distance
    from the quads.
    """
    if not isinstance(face, Patch):
        quads = face.quads(each)
        sagitta = (
            face.sagitta(each)
            if isinstance(face, TrimmedFace)
            else max(_sagitta(curve.samples(each)[:, None], each) for curve in face.curves)
        )
        return quads.reshape(-1, 3), np.arange(4 * len(quads)).reshape(-1, 4), sagitta
    grid = face.samples(each)
    corners = np.arange(grid.shape[0] * grid.shape[1]).reshape(grid.shape[:2])
    quads = np.stack(
        [corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], axis=-1
    )
    return (
        grid.reshape(-1, 3),
        quads.reshape(-1, 4),
        _sagitta(grid, each) + _sagitta(grid.swapaxes(0, 1), each),
    )


def _sagitta(grid: NDArray, each: int) -> float:
    """Return the largest distance of a surface from the chords of its samples along the first axis,
    bends ignored.
    """
    # With steps h the second difference is h² S'', and the sagitta of a chord h² S'' / 8. A second
    # difference at a knot, between two spans, shows a bend.
    bend = np.linalg.norm(np.diff(grid, 2, axis=0), axis=2) / 8.0
    bend[each - 1 :: each] = 0.0
    return float(bend.max())


def _orientation_findings(
    topology: PatchTopology,
    mixed: list[list[Face]],
    turned: list[list[Face]],
    size: float,
    volume: float,
) -> list[Finding]:
    """Return findings about single patches turned to agree with their part (mixed), and about whole
    parts turned.
    """

    def are_slight(groups: list[list[Face]]) -> bool:
        # An area is at most twice the square of a box's diagonal.
        area = 2.0 * sum(patches_size(patches) ** 2 for patches in groups)
        return area * size < NEGLIGIBLE * volume

    findings = []
    if mixed:
        findings.append(finding(FLIPPED_PATCHES, slight=are_slight(mixed), count=len(mixed)))
        if topology.non_manifold_sides:
            findings.append(finding(AMBIGUOUS_PATCH_SIDES, count=int(topology.non_manifold_sides)))
    if turned:
        findings.append(
            finding(
                INVERTED_PATCH_COMPONENTS,
                slight=are_slight(turned),
                count=len(turned),
                total=int(topology.number),
            )
        )
    return findings


def _closing_findings(
    topology: PatchTopology, solid: Mask, area: float, volume: float, size: float
) -> list[Finding]:
    """Return findings about open, flat and capped parts; solid: (c,) the parts with a volume."""
    findings = []
    if topology.unclosable.any():
        findings.append(finding(OPEN_PATCH_SIDES))
    if not solid.any():
        return findings if topology.unclosable.any() else [finding(FLAT_SURFACE)]
    flattened = int((~solid & ~topology.unclosable).sum())
    if flattened:
        findings.append(finding(FLAT_COMPONENTS, count=flattened, total=int(topology.number)))
    loops = [loop for loop in topology.loops if solid[loop.component]]
    caps = [loop for loop in loops if not loop.zero_area]
    if caps:
        cap_area = sum(loop.area for loop in caps)
        flat = sum(loop.is_planar for loop in caps)
        findings.append(
            finding(
                PATCH_HOLES_CAPPED,
                slight=cap_area * size < NEGLIGIBLE * volume,
                flat=flat,
                curved=len(caps) - flat,
                share=float(cap_area / area),
            )
        )
    crossing = sum(loop.self_intersecting for loop in loops)
    if crossing:
        findings.append(finding(PATCH_BOUNDARY_CROSSES_ITSELF, count=crossing))
    return findings
