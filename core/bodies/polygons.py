# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body of polygons with all their instances: each surface is measured once and mapped to its places."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..mesh.surface import Surface, normals
from ..moments.images import sum_of_images
from ..moments.moments import Moments, sum_moments
from ..polyhedron import polyhedron_moments
from ..solid.findings import DUPLICATE_FACES_COUNTED, NON_PLANAR_FACES
from ..solid.instance_overlaps import compare_places
from ..solid.measure import SolidIntegrals, measure_solid
from ..verdict.finding import Finding, finding
from ..verdict.method import Method, Verdict, least_trusted
from ..verdict.tolerances import NEGLIGIBLE
from .findings import DRAWN_AS_POLYGONS, FLAT_SURFACES, INSTANCE_OVERLAP_UNCHECKED, NON_PLANAR_FACES_OF_DISPLAY_MESH
from .instances import (
    area_of_instances,
    findings_by_part,
    instances_overlap,
    instances_size,
    merge_health,
    overlap_findings,
    with_overlaps,
)
from .mesh_body import MeshBody, triangle_count
from .reading import Part, Reading, to_si

MAX_COMPARED_TRIANGLES = 200_000  # triangles up to which instances are compared with each other


def sum_of_instances(reading: Reading, unit: float, shell: bool, threads: int) -> MeshBody:
    """Return the sum of all parts, each measured once in its own coordinates, and mapped to its places."""
    volumes, areas, healths, verdicts, by_part, parts = [], [], [], [], [], []
    drawn = drawn_names(reading)
    for part in reading.parts:
        solid = measure_solid(part.surface, shell=shell, threads=threads)
        matrices = to_si(part.matrices, unit)
        volumes.append(sum_of_images(solid.volume, matrices))
        image_areas = list(
            area_of_instances(solid.given_surface, solid.area, matrices, _area(threads) if shell else None)
        )
        areas.extend(image_areas)
        total = float(solid.volume.raw[0])
        stretch = float(volumes[-1].raw[0]) / total if total else 0.0  # Σ |det|
        healths.append(
            (
                replace(solid.health, volume_spread=solid.health.volume_spread * stretch),
                len(matrices),
                sum([float(moments.raw[0]) for moments in image_areas]),
            )
        )
        flat = not shell and not solid.volume.raw.any()
        verdicts.append(None if flat else Verdict(solid.method))
        by_part.append((part.source_object_name, _part_findings(part, solid, shell, flat, drawn)))
        parts.append((solid, matrices))
    findings = findings_by_part(by_part, reading.name)
    health = merge_health(healths)
    if not shell and instances_overlap(reading):
        if sum(triangle_count(part.surface) * len(part.matrices) for part in reading.parts) <= MAX_COMPARED_TRIANGLES:
            comparison = compare_places(parts)
            findings += overlap_findings(reading, [solid for solid, _ in parts], comparison)
            health = with_overlaps(health, comparison)
        else:
            findings.append(finding(INSTANCE_OVERLAP_UNCHECKED))
    of_solids = [verdict for verdict in verdicts if verdict]
    if of_solids and len(of_solids) < len(verdicts):
        flat_area = sum([area for (_, _, area), verdict in zip(healths, verdicts) if verdict is None])
        slight = flat_area * unit * instances_size(reading) < NEGLIGIBLE * float(sum_moments(volumes).total)
        findings.append(finding(FLAT_SURFACES, slight=slight, count=verdicts.count(None), total=len(verdicts)))
    return MeshBody(
        sum_moments(volumes),
        sum_moments(areas),
        health,
        Method(of_solids[0] if len(of_solids) == 1 else least_trusted(of_solids)),
        tuple(findings),
        face_count=sum(
            [len(solid.repaired_surface.triangles) + len(solid.repaired_surface.quads) for solid, _ in parts]
        ),
        solids=tuple(parts),
        threads=threads,
    )


def _part_findings(part: Part, solid: SolidIntegrals, shell: bool, flat: bool, drawn: set[str]) -> list[Finding]:
    """Return the findings about one surface; a sheet is not repaired."""
    if shell:
        copies = solid.health.defective_elements.duplicate_faces
        return [_copies_of_shell(part.surface, copies)] if len(copies) else []
    return [] if flat else of_drawn(solid.findings, [part], drawn)


def _copies_of_shell(surface: Surface, copies: NDArray[np.integer]) -> Finding:
    triangles, faces = surface.all_triangles()
    area = np.linalg.norm(normals(surface.points.astype(np.float64), triangles), axis=1)
    slight = area[np.isin(faces, copies)].sum() < NEGLIGIBLE * area.sum()
    return finding(DUPLICATE_FACES_COUNTED, copies, slight=slight, count=len(copies))


def _area(threads: int) -> Callable[[Surface], Moments]:
    """Return a function that measures the area of a mapped surface."""

    def measured(surface: Surface) -> Moments:
        return polyhedron_moments(surface, area_order=3, threads=threads, allow_open=True)[1]

    return measured


def drawn_names(reading: Reading) -> set[str]:
    """Return the names of the objects with round shapes that Blender draws as polygons."""
    results = [result for result in reading.findings if result.code == DRAWN_AS_POLYGONS]
    return {name for result in results for name in result.values.get("sources", ["", reading.name])}


def of_drawn(findings: Iterable[Finding], parts: Iterable[Part], drawn: set[str]) -> list[Finding]:
    """Return the findings; if all parts are drawn round shapes, non-planar faces are ascribed to the display mesh."""
    if not drawn.issuperset([part.source_object_name for part in parts]):
        return list(findings)
    of_display_mesh = NON_PLANAR_FACES_OF_DISPLAY_MESH
    return [replace(result, code=of_display_mesh) if result.code == NON_PLANAR_FACES else result for result in findings]
