# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Printed bodies: walls, top and bottom layers of full density around a core of infill, in which a
ball of ballast may be.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .. import measurement, mesh, moments, polyhedron, verdict, wall
from ..numerics import Array
from .findings import WALL_THICKNESS_VARIES
from .mesh_body import MeshBody
from .pocket import PocketRoom, ball_moments
from .wall import REPORTED

LEAST_CORE = 1e-9  # relative to the volume
POCKET_RTOL = 1e-5  # relative to its radius


def find_cores(
    body: MeshBody, printed: measurement.PrintSettings
) -> tuple[list[wall.PrintCore], list[mesh.Surface]]:
    """Return the cores of a body, and the surfaces of its outside. Raises MeasureError."""
    cores = []
    outsides = []
    for solid, matrices in body.solids:
        if solid.method == verdict.Procedure.OPEN:
            raise verdict.ReadError(wall.PRINT_UNFIT, fault="its surface is open. Close it")
        for matrix in matrices:
            surface = solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
            heights = np.array([printed.top, printed.bottom]) * printed.layer_height
            cores.append(wall.find_core(surface, printed.wall, *heights.tolist()))
            outsides.append(surface)
    return cores, outsides


def print_body(
    body: MeshBody, settings: measurement.Settings, place: Array | None = None
) -> MeshBody:
    """Return the body as it is printed upward along z, with mass moments of its densities.

    place: (4, 4) map from the object's coordinates to the body's; by default they are the same.
    Raises MeasureError if the settings cannot be printed, or leave no core.
    """
    printed = settings.printed
    printed.check()
    if body.mass is not None:
        raise verdict.ReadError(measurement.WALL_UNSUPPORTED, quantity="A varying density")
    order = max(moments.KNOWN_ORDER, settings.order or 0)
    cores, outsides = find_cores(body, printed)
    core_volume = moments.sum_moments(
        [
            polyhedron.polyhedron_moments(core.surface, order, exact=True, allow_open=True)[0]
            for core in cores
        ]
    )
    volume = body.third_order() if order == moments.KNOWN_ORDER else body.moments(order, False)[0]
    if not core_volume.total > LEAST_CORE * volume.total:
        raise verdict.ReadError(
            wall.PRINT_UNFIT,
            fault="its walls and layers are thicker than the part. Use Kind: Solid",
        )
    material = volume + core_volume * (printed.infill / 100.0 - 1.0)
    findings = body.findings
    minimum = min(core.minimum for core in cores)
    maximum = max(core.maximum for core in cores)
    if minimum < 1.0 - REPORTED or maximum > 1.0 + REPORTED:
        misplaced = sum(core.misplaced for core in cores) * (1.0 - printed.infill / 100.0)
        slight = misplaced < verdict.NEGLIGIBLE * volume.total
        varies = verdict.finding(
            WALL_THICKNESS_VARIES, slight=slight, minimum=minimum, maximum=maximum
        )
        findings = (*findings, varies)
    record = printed.record()
    ballast = None
    if (pocket := printed.pocket) is not None:
        if settings.mass is not None:
            fault = "beside a pocket it needs a density, not a mass. Set Density"
            raise verdict.ReadError(wall.PRINT_UNFIT, fault=fault)
        place = np.eye(4) if place is None else place
        center = place[:3, :3] @ pocket.center + place[:3, 3]
        room = PocketRoom([core.surface for core in cores], outsides, printed.line_width)
        if pocket.radius > float(room.radii(center[None])[0]) * (1.0 + POCKET_RTOL):
            fault = "its pocket reaches out of the core. Make it smaller, or remove it"
            raise verdict.ReadError(wall.PRINT_UNFIT, fault=fault)
        ball = ball_moments(center, pocket.radius, order)
        material = material + ball * (-printed.infill / 100.0)
        ballast = replace(ball, measure=moments.Measure.MASS) * pocket.density
        record |= {
            "pocket_center": center.tolist(),
            "pocket_radius": pocket.radius,
            "pocket_density": pocket.density,
            "pocket_mass": ballast.total,
        }
    # Without a density, a given mass scales these moments when the body is measured.
    mass = replace(material, measure=moments.Measure.MASS) * (settings.density or 1.0)
    record |= {"core_volume": core_volume.total, "material_volume": material.total}
    kilograms = settings.mass or mass.total  # the printed material, without ballast
    if ballast is not None:
        mass = mass + ballast
    if printed.price > 0.0:
        record["price"] = kilograms / printed.spool * printed.price
    return replace(
        body,
        findings=findings,
        mass=mass.truncate(moments.KNOWN_ORDER),
        higher_mass=mass if order > moments.KNOWN_ORDER else None,
        density_from=verdict.finding(
            measurement.DENSITY_FROM, source="walls and infill of a print"
        ),
        printed=record,
    )
