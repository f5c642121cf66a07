# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that polygons bound, with all its instances: each surface is measured once and mapped to its places."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.surface import Surface, join_surfaces
from ...core.moments.moments import Moments, sum_moments, sum_of_images
from ...core.polyhedron import polyhedron_moments
from ...core.solid.measure_solid import SolidIntegrals, measure_solid
from ...core.verdict.finding import Finding, ReadError, finding
from ...core.verdict.health import DefectiveElements, MeshReport
from ..read import Part, Reading
from ..read.union import union_surface
from .body import MeasuredBody
from .instances import (
    METHOD_RANK,
    area_of_instances,
    findings_by_part,
    instances_overlap,
    merge_health,
    not_compared,
    singular_instances_message,
    singular_reason,
    to_si,
    with_sources,
)

MAX_COMPARED_TRIANGLES = 200_000  # triangles up to which instances are compared with each other as shells of one mesh


def mesh_body(reading: Reading, unit: float, *, shell: bool, union: bool, threads: int) -> MeasuredBody:
    """What an object's surfaces bound, or with `shell` the sheets that they are.

    unit: metres per Blender unit. union: shells that overlap are united first. MeasureError where there is nothing to
    measure.
    """
    if reading.all_singular and not shell:
        raise ReadError(singular_reason(reading))
    body = (
        _boolean_union(reading, unit, threads)
        if union and not shell
        else _sum_of_instances(reading, unit, shell, threads)
    )
    if reading.singular_instance_count and not shell:
        body = replace(body, findings=(singular_instances_message(reading.singular_instance_count), *body.findings))
    return body


def _sum_of_instances(reading: Reading, unit: float, shell: bool, threads: int) -> MeasuredBody:
    """Each part measured once in its own coordinates, and mapped to wherever it stands."""
    volumes, areas, healths, methods, findings, by_part, parts = [], [], [], [], [], [], []
    drawn = _drawn(reading)
    if not shell and reading.instance_count > 1 and instances_overlap(reading):
        if sum(_triangles(part.surface) * len(part.matrices) for part in reading.parts) <= MAX_COMPARED_TRIANGLES:
            return _joined_body(reading, unit, threads)
        findings.append(not_compared(reading))
    for part in reading.parts:
        solid = measure_solid(part.surface, shell=shell, threads=threads)
        matrices = to_si(part.matrices, unit)
        volumes.append(sum_of_images(solid.volume, matrices))
        measured = (lambda surface: polyhedron_moments(surface, area_order=3, threads=threads)[1]) if shell else None
        image_areas = list(area_of_instances(part.surface, solid.area, matrices, measured))
        areas.extend(image_areas)
        stretch = volumes[-1].total / solid.volume.total if solid.volume.total else 0.0  # Σ |det|
        healths.append(
            (
                replace(solid.health, volume_spread=solid.health.volume_spread * stretch),
                len(matrices),
                sum(moments.total for moments in image_areas),
            )
        )
        flat = not shell and not solid.volume.raw.any()
        methods.append(None if flat else solid.method)
        if shell:  # it is measured as it is
            copies = solid.health.defective_elements.duplicate_faces
            found = [finding("duplicate_faces_of_shell", copies, count=len(copies))] if len(copies) else []
        else:
            found = [] if flat else _of_drawn(solid.findings, [part], drawn)
        by_part.append((part.source_object_name, found))
        parts.append((solid, matrices))
    findings += findings_by_part(by_part, reading.name)
    solid_methods = [method for method in methods if method]
    if solid_methods and len(solid_methods) < len(methods):
        findings.append(finding("flat_instance_sources", count=methods.count(None), total=len(methods)))
    method = min(solid_methods, key=METHOD_RANK.index, default="open")
    return _measured_body(
        sum_moments(volumes),
        sum_moments(areas),
        merge_health(healths),
        method,
        findings,
        parts,
        [part.surface for part in reading.parts],
        threads,
    )


def _measured_body(
    volume: Moments,
    area: Moments,
    health: MeshReport,
    method: str,
    findings: Iterable[Finding],
    solids: list[tuple[SolidIntegrals, NDArray]],
    surfaces: list[Surface],
    threads: int,
) -> MeasuredBody:
    """surfaces: what each of the solids was before it was repaired."""

    def refined() -> Moments:
        return sum_moments([sum_of_images(solid.exact_third_order(threads), matrices) for solid, matrices in solids])

    @cache  # the frame and the shape need them to one order
    def to_order(order: int, area: bool) -> tuple[Moments, Moments | None]:
        return _moments_to_order(solids, surfaces, order, area, threads)

    def pieces(sheets: bool) -> Iterator[Surface]:
        for (solid, matrices), surface in zip(solids, surfaces):
            piece = surface if sheets else solid.repaired_surface
            yield from (piece.transform(matrix[:3, :3], matrix[:3, 3]) for matrix in matrices)

    faces = sum(len(solid.repaired_surface.triangles) + len(solid.repaired_surface.quads) for solid, _ in solids)
    return MeasuredBody(
        volume,
        area,
        health,
        method,
        tuple(findings),
        third_order=refined,
        moments=to_order,
        solids=tuple(solids),
        surfaces=pieces,
        face_count=faces,
    )


def _moments_to_order(
    solids: list[tuple[SolidIntegrals, NDArray]], surfaces: list[Surface], order: int, area: bool, threads: int
) -> tuple[Moments, Moments | None]:
    """The moments to an order of what was measured, each part once and mapped to its places: the volume of the repaired
    surface, in one pass with the area where the repair has neither added nor left out a face."""
    volumes, areas = [], []
    alone = 0 if order <= 3 else None  # up to third order the area is found on the way, and makes bounds smaller

    def measured(surface: Surface) -> Moments:
        return polyhedron_moments(surface, order, area_order=order, exact=True, threads=threads)[1]

    for (solid, matrices), surface in zip(solids, surfaces):
        same = (
            solid.method in ("exact", "reoriented")
            and not solid.health.duplicate_faces
            and _triangles(solid.repaired_surface) == _triangles(surface)
        )  # else flat parts are left out
        volume, faces = polyhedron_moments(
            solid.repaired_surface,
            order,
            area_order=order if area and same else alone,
            about=solid.volume.about,  # of an open surface they depend on it
            exact=True,
            threads=threads,
        )
        volumes.append(sum_of_images(volume, matrices))
        if area:
            areas.extend(area_of_instances(surface, faces if same else measured(surface), matrices, measured))
    return sum_moments(volumes), sum_moments(areas) if area else None


def _triangles(surface: Surface) -> int:
    return len(surface.triangles) + 2 * len(surface.quads)


def _joined_body(reading: Reading, unit: float, threads: int) -> MeasuredBody:
    """All parts where they stand as one surface, so that they are compared as the shells of one mesh are."""
    surface = reading.join()
    solid = measure_solid(surface, threads=threads)
    scale = np.diag([unit, unit, unit, 1.0])
    health = replace(
        solid.health, volume_spread=solid.health.volume_spread * unit**3, defective_elements=DefectiveElements()
    )
    return _measured_body(
        solid.volume.transform(scale),
        solid.area.transform(scale),
        health,
        solid.method,
        [with_sources(reading, result) for result in _of_drawn(solid.findings, reading.parts, _drawn(reading))],
        [(solid, scale[None])],
        [surface],
        threads,
    )


def _drawn(reading: Reading) -> set[str]:
    """The sources of which Blender draws polygons in place of something round."""
    codes = ("surface_drawn_as_polygons", "curves_drawn_as_polygons")
    results = [result for result in reading.findings if result.code in codes]
    return {name for result in results for name in result.values.get("sources", ["", reading.name])}


def _of_drawn(findings: Iterable[Finding], parts: Iterable[Part], drawn: set[str]) -> list[Finding]:
    """How polygons are cut that stand for something round matters less than that they do."""
    if not all(part.source_object_name in drawn for part in parts):
        return list(findings)
    of_display_mesh = "non_planar_faces_of_display_mesh"
    return [
        replace(result, code=of_display_mesh) if result.code == "non_planar_faces" else result for result in findings
    ]


def _boolean_union(reading: Reading, unit: float, threads: int) -> MeasuredBody:
    """All parts where they stand as one surface, overlaps removed by Blender's exact boolean."""
    before = _sum_of_instances(reading, unit, False, threads)
    if not before.volume.total > 0.0:
        return before
    repaired = [
        solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
        for solid, matrices in before.solids
        for matrix in matrices
    ]
    surface = union_surface(join_surfaces(repaired))
    solid = measure_solid(surface, threads=threads) if _triangles(surface) else None
    if solid is None or solid.method == "open":
        raise ReadError("union_failed")
    findings = [finding("union_by_boolean")]
    if before.method == "capped":
        slight = all(result.code != "holes_capped" for result in before.findings)
        code = "holes_capped_before_union_slightly" if slight else "holes_capped_before_union"
        findings.append(finding(code, share=before.health.cap_area_share))
    elif before.method != "exact":
        reoriented = before.method == "reoriented"
        findings.append(finding("faces_reversed_before_union" if reoriented else "open_components_united"))
    return _measured_body(
        solid.volume,
        solid.area,
        before.health,
        "union",
        (*findings, *_of_drawn(solid.findings, reading.parts, _drawn(reading))),
        [(solid, np.eye(4)[None])],
        [surface],
        threads,
    )
