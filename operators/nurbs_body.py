# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that B-spline patches bound, measured from their control points instead of their display mesh.

Volumes are measured once for each surface and mapped to its places. Areas, and sheets of real thickness, do not follow
a map that stretches unevenly: there the control points are mapped, for each different map.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..core.moments import are_similarities, map_sum, sum_moments
from ..core.patch import Patch
from ..core.patch_moments import area_moments
from ..core.patch_solid import measure_patches, measure_sheet
from .body import Body
from .mesh_body import mesh_body, places_meet, scaled, together
from .read import Reading

RANKED = ("open", "capped", "reoriented", "exact")


def nurbs_body(reading: Reading, unit: float, *, thickness: float | None, union: bool, threads: int,
               compare: bool = True) -> Body:
    """What an object's surfaces bound where some of them are B-spline patches, or the sheets that they are.

    unit: metres per Blender unit. thickness: m, of sheets; None for solids. union: shells that overlap are united,
    for which polygons are needed. compare: also measure what the display mesh would have given.
    ValueError, with what to do, where there is nothing to measure.
    """
    if thickness is not None:
        return _sheets(reading, unit, thickness, threads)
    if reading.singular:
        raise ValueError("A zero scale flattens it; set its scale, or its parents', to something else than zero, or "
                         "measure it as a shell.")
    bodies = list(_solids(reading, unit, threads))
    if union and (reading.places > 1 or bodies[0].health.components > 1):
        body = mesh_body(reading, unit, shell=False, union=True, threads=threads)
        return replace(body, warnings=("Uniting needs polygons: its display mesh was measured, as fine as the "
                                       "viewport's resolution.", *body.warnings))
    warnings = [warning for body in bodies for warning in body.warnings]
    if reading.flattened:
        warnings.append("{:d} of its instances are flattened by a zero scale and enclose nothing.".format(
            reading.flattened))
    if reading.places > 1 and places_meet(reading):
        warnings.append("Overlap was not looked for between its {:d} instances, and boxes around some of them overlap; "
                        "what those share counts twice.".format(reading.places))
    volume = sum_moments([body.volume for body in bodies])
    display = None
    if compare:
        with suppress(ValueError):  # a display mesh that cannot be measured compares with nothing
            display = mesh_body(reading, unit, shell=False, union=False, threads=threads).volume.total
    return Body(volume, sum_moments([body.area for body in bodies]),
                together([(body.health, 1) for body in bodies]),
                _method(reading, min((body.method.split()[-1] for body in bodies), key=RANKED.index)),
                tuple(dict.fromkeys(warnings)), refined=lambda: volume, display_volume=display)


def _method(reading: Reading, method: str) -> str:
    """With `NURBS` before it where all that was measured are patches."""
    return "NURBS " + method if all(part.splines for part in reading.parts) else method


def _solids(reading: Reading, unit: float, threads: int) -> Iterator[Body]:
    """One body for each surface with all its places, and one for all meshes among them."""
    for part in reading.parts:
        if part.splines is None:
            continue
        measure = measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored)
        matrices = scaled(part.matrices, unit)
        even = are_similarities(matrices[:, :3, :3])
        areas = [map_sum(measure.area, matrices[even])] if even.any() else []
        for patches, places in _distinct(part.splines.patches, matrices[~even]):
            area, _ = area_moments(patches, 3)
            areas += [map_sum(area, places)]
        yield Body(map_sum(measure.volume, matrices), sum_moments(areas),
                   together([(measure.health, len(matrices))]), measure.method, measure.warnings)
    meshes = [part for part in reading.parts if part.splines is None]
    if meshes:
        yield mesh_body(replace(reading, parts=meshes), unit, shell=False, union=False, threads=threads)


def _sheets(reading: Reading, unit: float, thickness: float, threads: int) -> Body:
    """Sheets of the thickness, half of it on either side."""
    sheets, areas, healths, warnings = [], [], [], []
    for part in reading.parts:
        if part.splines is None:
            continue
        for patches, places in _distinct(part.splines.patches, scaled(part.matrices, unit)):
            grown = unit * float(np.linalg.norm(part.matrices[0, :3, :3], 2))
            sheet, area, fine = measure_sheet(patches, thickness, stored=part.splines.stored * grown)
            sheets.append(map_sum(sheet, places))
            areas.append(map_sum(area, places))
            if not fine:
                warnings.append("The estimate of its sheet's error is above what was asked for; its surface may have "
                                "creases.")
        healths.append((measure_patches(part.splines.patches).health, len(part.matrices)))
    meshes = [part for part in reading.parts if part.splines is None]
    if meshes:
        body = mesh_body(replace(reading, parts=meshes), unit, shell=True, union=False, threads=threads)
        sheets.append(replace(body.area * thickness, of="volume"))
        areas.append(body.area)
        healths.append((body.health, 1))
        warnings += body.warnings
    area = sum_moments(areas)
    volume = replace(area, raw=np.zeros_like(area.raw), error=np.zeros_like(area.raw), of="volume")
    return Body(volume, area, together(healths), _method(reading, "shell"), tuple(dict.fromkeys(warnings)),
                sheet=sum_moments(sheets))


def _distinct(patches: tuple[Patch, ...], matrices: NDArray) -> Iterator[tuple[list[Patch], NDArray]]:
    """The patches under each different linear map, facing as before, and the (k, 4, 4) translations to where they
    stand."""
    if not len(matrices):
        return
    linear, which = np.unique(matrices[:, :3, :3].reshape(-1, 9), axis=0, return_inverse=True)
    for i, row in enumerate(linear):
        turn = np.eye(4)
        turn[:3, :3] = row.reshape(3, 3)
        mapped = [patch.mapped(turn) for patch in patches]
        if np.linalg.det(turn) < 0.0:
            mapped = [patch.turned() for patch in mapped]
        own = np.flatnonzero(which.ravel() == i)
        places = np.tile(np.eye(4), (len(own), 1, 1))
        places[:, :3, 3] = matrices[own, :3, 3]
        yield mapped, places
