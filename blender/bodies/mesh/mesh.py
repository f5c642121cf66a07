# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body bounded by polygons, with all its instances: each surface is measured once and mapped to its places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core.bodies.instances import singular_instances_message
from ....core.bodies.mesh_body import MeshBody, triangle_count
from ....core.bodies.polygons import drawn_names, of_drawn, sum_of_instances
from ....core.bodies.reading import Reading
from ....core.bodies.wall import find_walls
from ....core.measurement.body import Body
from ....core.mesh.surface import join_surfaces
from ....core.solid.findings import HOLES_CAPPED, INVERTED_COMPONENTS
from ....core.solid.measure import measure_solid
from ....core.verdict.finding import ReadError, finding
from ....core.verdict.findings import FLIPPED_FACES
from ....core.verdict.method import Method, Verdict
from ...read.union import union_surface
from ...read.visibility import shows_flat_region
from ..density.varying_density import weigh
from ..findings import DISPLAY_MESH_NEEDED, OPEN_COMPONENTS_UNITED, UNION_BY_BOOLEAN, UNION_FAILED, ZERO_SCALE
from ..request import Request

MEASURED_AS = frozenset({"solid", "shell"})

REPAIRS = {HOLES_CAPPED, FLIPPED_FACES, INVERTED_COMPONENTS}  # reported of bodies before they are united


def read(request: Request) -> Reading | None:
    """Return the polygons that an object shows, or None if it has NURBS patches of one density (see `nurbs.py`)."""
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
    """Return the body bounded by an object's surfaces, united first if `union`, or with `shell` their sheets."""
    if shell:
        return sum_of_instances(reading, unit, True, threads)
    flat = reading.singular_instance_count
    if flat == reading.instance_count:
        raise ReadError(ZERO_SCALE)
    made = _boolean_union(reading, unit, threads) if union else sum_of_instances(reading, unit, False, threads)
    return replace(made, findings=(singular_instances_message(reading), *made.findings)) if flat else made


def _boolean_union(reading: Reading, unit: float, threads: int) -> MeshBody:
    """Return the body of all parts in their places; parts with a volume are united by Blender's exact Boolean."""
    before = sum_of_instances(reading, unit, False, threads)
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
    findings += of_drawn(solid.findings, reading.parts, drawn_names(reading))
    return replace(
        before,
        volume=solid.volume,
        area=solid.area,
        method=Method(Verdict.UNION),
        findings=tuple(findings),
        face_count=len(solid.repaired_surface.triangles) + len(solid.repaired_surface.quads),
        solids=((solid, np.eye(4)[None]),),
        _known={},
    )
