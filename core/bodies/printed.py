# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Printed bodies: walls, top and bottom layers of full density around a core of infill."""

from __future__ import annotations

from dataclasses import replace

from ..measurement import DENSITY_FROM, WALL_UNSUPPORTED, Settings
from ..moments import KNOWN_ORDER, Measure
from ..moments.moments import sum_moments
from ..polyhedron import polyhedron_moments
from ..verdict import Procedure
from ..verdict.finding import ReadError, finding
from ..wall import PRINT_UNFIT, core_surface
from .mesh_body import MeshBody

LEAST_CORE = 1e-9  # of the volume


def print_body(body: MeshBody, settings: Settings) -> MeshBody:
    """Return the body as it is printed upward along z, with mass moments of its two densities.

    Raises MeasureError if the settings cannot be printed, or leave no core.
    """
    printed = settings.printed
    printed.check()
    if body.mass is not None:
        raise ReadError(WALL_UNSUPPORTED, quantity="A varying density")
    order = max(KNOWN_ORDER, settings.order or 0)
    cores = []
    for solid, matrices in body.solids:
        if solid.method == Procedure.OPEN:
            raise ReadError(PRINT_UNFIT, fault="its surface is open. Close it")
        for matrix in matrices:
            surface = solid.repaired_surface.transform(matrix[:3, :3], matrix[:3, 3])
            thicknesses = printed.wall, printed.top_height, printed.bottom_height
            core = core_surface(surface, *thicknesses)
            cores.append(polyhedron_moments(core, order, exact=True, allow_open=True)[0])
    core = sum_moments(cores)
    volume = body.third_order() if order == KNOWN_ORDER else body.moments(order, False)[0]
    if not core.total > LEAST_CORE * volume.total:
        raise ReadError(
            PRINT_UNFIT, fault="its walls and layers are thicker than the part. Use Kind: Solid"
        )
    filled = volume + core * (printed.infill / 100.0 - 1.0)
    mass = replace(filled, measure=Measure.MASS) * (settings.density or 1.0)
    record = printed.record() | {"core_volume": core.total, "material_volume": filled.total}
    if printed.price > 0.0:
        kilograms = settings.mass or mass.total
        record["price"] = kilograms / printed.spool * printed.price
    return replace(
        body,
        mass=mass.truncate(KNOWN_ORDER),
        higher_mass=mass if order > KNOWN_ORDER else None,
        density_from=finding(DENSITY_FROM, source="walls and infill of a print"),
        printed=record,
    )
