# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body bounded by polygons, with all its instances: each surface is measured once and mapped to
its places.

The convex hull's corners are the possible ground contacts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from bpy.types import Depsgraph, Object

from ...core import bodies, measurement, verdict
from ...core.mesh import ConvexHull, convex_hull
from ...core.solid import HOLES_CAPPED, INVERTED_COMPONENTS, measure_solid
from ..read import objects, visibility
from ..read.findings import DISPLAY_MESH_MEASURED, SCALE_ZERO_AXIS
from .density.varying_density import weigh
from .findings import (
    OPEN_COMPONENTS_UNITED,
    UNION_BY_BOOLEAN,
    UNION_FAILED,
    ZERO_SCALE,
)
from .request import Request
from .union import unite

MEASURED_AS = frozenset({"solid", "shell", "printed"})

# findings about the bodies before their union that also apply to the union
REPAIRS = {HOLES_CAPPED, verdict.FLIPPED_FACES, INVERTED_COMPONENTS}
HULL_RTOL = 1e-6  # relative to the extent: points that are outside by less are left out
NOISE = 4.0  # largest unevenness of flat faces, in errors of a coordinate; chosen with a margin
MAX_CORNERS = 10000  # per hull: finely divided round bodies have more


def read(request: Request) -> bodies.Reading | None:
    """Return the polygons that an object shows, or None if it has NURBS patches of one density (see
    `nurbs.py`). A finding tells of patches and flat curves that polygons stand for.
    """
    reading = request.surfaces
    density = request.density
    kind = request.settings.kind
    if density is not None:
        cause = "a varying density needs polygons"
    elif kind == "printed":
        cause = "walls and infill need polygons"
    elif reading.has_patches:
        return None
    else:
        return reading
    # Flat curves of one density do not come here: `flat.region` reads them first.
    is_flat_sheet = density is not None and kind == "shell" and request.obj.type == "CURVE"
    if reading.has_patches or (is_flat_sheet and visibility.shows_flat_region(request.obj)):
        reading.findings.append(verdict.finding(DISPLAY_MESH_MEASURED, cause=cause))
    return reading


def body(reading: bodies.Reading, request: Request) -> measurement.Body:
    """Return the body that polygons bound, weighed and with walls as set, or raise MeasureError."""
    settings = request.settings
    shell = settings.kind == "shell"
    result = mesh_body(
        reading,
        settings.unit,
        shell=shell,
        union=settings.overlap == "union",
        threads=settings.threads,
    )
    if request.density is not None:
        result = weigh(reading, result, request)
    if shell and settings.wall != "thin":
        return bodies.find_walls(reading, result, settings.wall).body(settings.thickness)
    if settings.kind == "printed":
        matrix = bodies.to_si([reading.matrix], settings.unit)[0]
        return bodies.print_body(result, settings, matrix)
    return result


def mesh_body(
    reading: bodies.Reading, unit: float, *, shell: bool, union: bool, threads: int
) -> bodies.MeshBody:
    """Return the body bounded by an object's surfaces, united first if `union`, or with `shell`
    their sheets.
    """
    if shell:
        return bodies.sum_of_instances(reading, unit, True, threads)
    if reading.all_singular:
        raise verdict.ReadError(ZERO_SCALE)
    result = (
        _boolean_union(reading, unit, threads)
        if union
        else bodies.sum_of_instances(reading, unit, False, threads)
    )
    if not reading.singular_instance_count:
        return result
    flattened = bodies.singular_instances_message(reading)
    return replace(result, findings=(flattened, *result.findings))


def _boolean_union(reading: bodies.Reading, unit: float, threads: int) -> bodies.MeshBody:
    """Return the body of all parts in their places; parts with a volume are united by Blender's
    exact Boolean.
    """
    before = bodies.sum_of_instances(reading, unit, False, threads)
    if not before.volume.total > 0.0:
        return before
    surface = unite(before)
    solid = measure_solid(surface, threads=threads) if surface.triangle_count else None
    if solid is None or solid.method == verdict.Procedure.OPEN:
        raise verdict.ReadError(UNION_FAILED)
    findings = [verdict.finding(UNION_BY_BOOLEAN)]
    if before.method.procedure == verdict.Procedure.OPEN:
        findings.append(verdict.finding(OPEN_COMPONENTS_UNITED))
    findings += [result for result in before.findings if result.code in REPAIRS]
    findings += bodies.of_drawn(solid.findings, reading.parts, bodies.drawn_names(reading))
    return replace(
        before,
        volume=solid.volume,
        area=solid.area,
        method=verdict.Method(verdict.Procedure.UNION),
        findings=tuple(findings),
        face_count=solid.face_count,
        solids=((solid, np.eye(4)[None]),),
    )


def object_hull(obj: Object, depsgraph: Depsgraph) -> ConvexHull:
    """Return the convex hull of an object with its instances, in its own coordinates, or raise
    MeasureError.
    """
    reading = objects.read_object(obj, depsgraph, edges=False)
    if reading.is_singular:
        raise verdict.EditRefusedError(SCALE_ZERO_AXIS)
    to_local = np.linalg.inv(reading.matrix)  # from the world to the object's coordinates
    points = []
    coordinate_error = 0.0
    for part in reading.parts:
        corners = part.surface.used_points().astype(np.float64)
        if len(part.matrices) > 1:
            corners = convex_hull(corners, HULL_RTOL, MAX_CORNERS).points
        for matrix in to_local @ part.matrices:
            points.append(corners @ matrix[:3, :3].T + matrix[:3, 3])
            error = np.abs(matrix[:3, :3]) @ part.surface.coordinate_error
            coordinate_error = max(coordinate_error, float(error.max()))
    joined = np.concatenate(points)
    extent = float(np.ptp(joined, axis=0).max())
    # Without extent, all points are one, and any tolerance will do.
    rtol = max(HULL_RTOL, NOISE * coordinate_error / (extent or np.inf))
    return convex_hull(joined, rtol, MAX_CORNERS)
