# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that polygons bound, with all its instances: each surface is measured once and mapped to its places."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ....core.measurement.body import Body
from ....core.mesh.surface import Surface, join_surfaces, normals
from ....core.moments.images import sum_of_images
from ....core.moments.moments import Moments, sum_moments
from ....core.polyhedron import polyhedron_moments
from ....core.solid.findings import DUPLICATE_FACES_COUNTED, HOLES_CAPPED, INVERTED_COMPONENTS, NON_PLANAR_FACES
from ....core.solid.instance_overlaps import compare_places
from ....core.solid.measure import SolidIntegrals, measure_solid
from ....core.verdict.finding import Finding, ReadError, finding
from ....core.verdict.findings import FLIPPED_FACES
from ....core.verdict.health import MeshHealth
from ....core.verdict.method import Method, Verdict, least_trusted
from ....core.verdict.tolerances import NEGLIGIBLE
from ...read.findings import DRAWN_AS_POLYGONS
from ...read.reading import Part, Reading, to_si
from ...read.union import union_surface
from ...read.visibility import shows_flat_region
from ..body import MeshBody, triangle_count
from ..density.varying_density import weigh
from ..findings import (
    DISPLAY_MESH_NEEDED,
    FLAT_SURFACES,
    INSTANCE_OVERLAP_UNCHECKED,
    NON_PLANAR_FACES_OF_DISPLAY_MESH,
    OPEN_COMPONENTS_UNITED,
    UNION_BY_BOOLEAN,
    UNION_FAILED,
    ZERO_SCALE,
)
from ..request import Request
from ..wall import find_walls
from .instances import (
    area_of_instances,
    findings_by_part,
    instances_overlap,
    instances_size,
    merge_health,
    overlap_findings,
    singular_instances_message,
    with_overlaps,
)

MEASURED_AS = frozenset({"solid", "shell"})

REPAIRS = {HOLES_CAPPED, FLIPPED_FACES, INVERTED_COMPONENTS}  # reported of bodies before they are united
MAX_COMPARED_TRIANGLES = 200_000  # triangles up to which instances are compared with each other


def read(request: Request) -> Reading | None:
    """Return the polygons that an object shows, or None if it has patches of one density, which are better."""
    reading, density, obj = request.surfaces, request.density, request.obj
    if reading.has_patches:
        if density is None:
            return None
        reading.findings.append(finding(DISPLAY_MESH_NEEDED, purpose="a varying density"))
    elif density is not None and request.settings.kind == "shell" and obj.type == "CURVE" and shows_flat_region(obj):
        reading.findings.append(finding(DISPLAY_MESH_NEEDED, purpose="a varying density"))
    return reading


def body(reading: Reading, request: Request) -> Body:
    """Return the body that polygons bound, weighed and with walls as set, or raise MeasureError."""
    settings = request.settings
    shell = settings.kind == "shell"
    made = mesh_body(reading, settings.unit, shell=shell, union=settings.overlap == "union", threads=settings.threads)
    if request.density is not None:
        made = weigh(reading, made, request)
    if shell and settings.wall != "thin":
        return find_walls(reading, made, settings.wall).body(settings.thickness)
    return made


def mesh_body(reading: Reading, unit: float, *, shell: bool, union: bool, threads: int) -> MeshBody:
    """Return the body that an object's surfaces bound, united first if `union`, or with `shell` their sheets."""
    if shell:
        return _sum_of_instances(reading, unit, True, threads)
    flat = reading.singular_instance_count
    if flat == reading.instance_count:
        raise ReadError(ZERO_SCALE)
    made = _boolean_union(reading, unit, threads) if union else _sum_of_instances(reading, unit, False, threads)
    return replace(made, findings=(singular_instances_message(reading), *made.findings)) if flat else made


def _sum_of_instances(reading: Reading, unit: float, shell: bool, threads: int) -> MeshBody:
    """Return the sum of all parts, each measured once in its own coordinates, and mapped to its places."""
    volumes, areas, healths, verdicts, by_part, parts = [], [], [], [], [], []
    drawn = _drawn(reading)
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
    return [] if flat else _of_drawn(solid.findings, [part], drawn)


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


def _single_surface_body(
    volume: Moments,
    area: Moments,
    health: MeshHealth,
    verdict: Verdict,
    findings: Iterable[Finding],
    solid: SolidIntegrals,
    matrix: NDArray[np.float64],
    threads: int,
) -> MeshBody:
    """Return the body of one surface in one place."""
    solids = [(solid, matrix[None])]
    return MeshBody(
        volume,
        area,
        health,
        Method(verdict),
        tuple(findings),
        face_count=len(solid.repaired_surface.triangles) + len(solid.repaired_surface.quads),
        solids=tuple(solids),
        threads=threads,
    )


def _drawn(reading: Reading) -> set[str]:
    """Return the names of the objects with round shapes that Blender draws as polygons."""
    results = [result for result in reading.findings if result.code == DRAWN_AS_POLYGONS]
    return {name for result in results for name in result.values.get("sources", ["", reading.name])}


def _of_drawn(findings: Iterable[Finding], parts: Iterable[Part], drawn: set[str]) -> list[Finding]:
    """Return the findings; if all parts are drawn round shapes, non-planar faces are ascribed to the display mesh."""
    if not drawn.issuperset([part.source_object_name for part in parts]):
        return list(findings)
    of_display_mesh = NON_PLANAR_FACES_OF_DISPLAY_MESH
    return [replace(result, code=of_display_mesh) if result.code == NON_PLANAR_FACES else result for result in findings]


def _boolean_union(reading: Reading, unit: float, threads: int) -> MeshBody:
    """Return the body of all parts in their places, united by Blender's exact Boolean if they have a volume."""
    before = _sum_of_instances(reading, unit, False, threads)
    if not before.volume.total > 0.0:
        return before
    repaired = [
        solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
        for solid, matrices in before.solids
        for matrix in matrices
    ]
    surface = union_surface(join_surfaces(repaired))
    solid = measure_solid(surface, threads=threads) if triangle_count(surface) else None
    if solid is None or solid.method == Verdict.OPEN:
        raise ReadError(UNION_FAILED)
    findings = [finding(UNION_BY_BOOLEAN)]
    verdict = before.method.verdict
    if verdict == Verdict.OPEN:
        findings.append(finding(OPEN_COMPONENTS_UNITED))
    findings += [result for result in before.findings if result.code in REPAIRS]
    return _single_surface_body(
        solid.volume,
        solid.area,
        before.health,
        Verdict.UNION,
        (*findings, *_of_drawn(solid.findings, reading.parts, _drawn(reading))),
        solid,
        np.eye(4),
        threads,
    )
