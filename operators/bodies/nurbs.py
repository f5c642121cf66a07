# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that B-spline patches bound, measured from their control points instead of their display mesh.

Volumes are measured once for each surface and mapped to its places. Areas, and sheets of real thickness, do not follow
a map that stretches unevenly: there the control points are mapped, for each different map.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core.mesh.surface import Surface
from ...core.moments.affine_maps import distinct_linear, translations
from ...core.moments.moments import Measure, Moments, are_similarities, map_sum, monomial_count, sum_moments
from ...core.nurbs.creases import sharpest_crease
from ...core.nurbs.patch import Patch
from ...core.nurbs.patch_moments import area_moments, volume_moments
from ...core.nurbs.solid import PatchMeasure, measure_patches, measure_sheet
from ...core.verdict.finding import MeasureError, ReadError, finding
from ..read import Part, Reading
from .body import Body
from .instances import (
    RANKED,
    each_once,
    findings_by_part,
    flattened_reason,
    in_metres,
    not_compared,
    places_meet,
    some_flattened,
    together,
)
from .mesh import mesh_body

CREASE = 0.02  # radians: less is what float32 leaves of a surface without
HEIGHTS = {"inward": (-1.0, 0.0), "outward": (0.0, 1.0), "centered": (-0.5, 0.5)}  # of a wall, in thicknesses


def nurbs_body(
    reading: Reading,
    unit: float,
    *,
    wall: str | None,
    thickness: float,
    union: bool,
    threads: int,
    compare: bool = True,
) -> Body:
    """What an object's surfaces bound where some of them are B-spline patches, or the sheets that they are.

    unit: metres per Blender unit. wall: of a shell, as in `MeasureOptions`; None for solids. thickness: m. union:
    shells that overlap are united, for which polygons are needed. compare: also measure what the display mesh would
    have given. MeasureError where there is nothing to measure.
    """
    if wall is not None:
        return _shell(reading, unit, wall, thickness, threads)
    if reading.singular:
        raise ReadError(flattened_reason(reading))
    own, meshes = _parts(reading)
    measures = [measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored) for part in own]
    if union and (reading.places > 1 or measures[0].health.components > 1):
        body = mesh_body(reading, unit, shell=False, union=True, threads=threads)
        return replace(body, findings=(finding("union_of_display_mesh"), *body.findings))
    rest = mesh_body(meshes, unit, shell=False, union=False, threads=threads) if meshes.parts else None
    others = [rest] if rest else []
    findings = findings_by_part([(part.source, one.findings) for part, one in zip(own, measures)], reading.name)
    findings += [result for one in others for result in one.findings]
    if reading.flattened:
        findings.append(some_flattened(reading.flattened))
    if reading.places > 1 and places_meet(reading):
        findings.append(not_compared(reading))
    places = [in_metres(part.matrices, unit) for part in own]
    volume = sum_moments([*map(map_sum, (one.volume for one in measures), places), *(one.volume for one in others)])
    areas = [sum_moments(list(_areas(part, one.area, matrices))) for part, one, matrices in zip(own, measures, places)]
    area = sum_moments(areas + [one.area for one in others])
    display = None
    if compare:
        with suppress(MeasureError):  # a display mesh that cannot be measured compares with nothing
            display = mesh_body(reading, unit, shell=False, union=False, threads=threads).volume.total

    def to_order(order: int, with_area: bool) -> tuple[Moments, Moments | None]:
        found = [map_sum(_to_order(one, order), matrices) for one, matrices in zip(measures, places)]
        faces = (
            [
                moments
                for part, one, matrices in zip(own, measures, places)
                for moments in _areas(part, area_moments(part.splines.patches, order, one.area.about)[0], matrices)
            ]
            if with_area
            else []
        )
        for one in others:
            more, outside = one.to_order(order, with_area)
            found, faces = [*found, more], [*faces, *([outside] if with_area else [])]
        return sum_moments(found), sum_moments(faces) if with_area else None

    def pieces(sheets: bool) -> Iterator[Surface]:  # of the display mesh: what asks for them asks for polygons
        return mesh_body(reading, unit, shell=sheets, union=False, threads=threads).pieces(sheets)

    health = together(
        [(one.health, len(part.matrices), faces.total) for one, part, faces in zip(measures, own, areas)]
        + [(one.health, 1, one.area.total) for one in others]
    )
    method = min((one.method for one in (*measures, *others)), key=RANKED.index)
    return Body(
        volume,
        area,
        health,
        _with_nurbs(reading, method),
        tuple(each_once(findings)),
        refined=lambda: volume,
        display_volume=display,
        to_order=to_order,
        pieces=pieces,
        estimated=True,
    )


def _parts(reading: Reading) -> tuple[list[Part], Reading]:
    """The parts that are patches, and a reading of the others."""
    return (
        [part for part in reading.parts if part.splines is not None],
        replace(reading, parts=[part for part in reading.parts if part.splines is None]),
    )


def _with_nurbs(reading: Reading, method: str) -> str:
    """With `NURBS` before it where all that was measured are patches."""
    return "NURBS " + method if all(part.splines for part in reading.parts) else method


def _to_order(measure: PatchMeasure, order: int) -> Moments:
    """The volume's moments to another order; those of an open body, or of none, to the one that is known."""
    if measure.method == "open":
        raise ReadError("open_patches_order")
    return volume_moments(measure.patches, order, measure.volume.about)[0]


def _areas(part: Part, area: Moments, matrices: NDArray) -> Iterator[Moments]:
    """The area moments of a part's images."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield map_sum(area, matrices[even])
    for patches, places in _distinct(part.splines.patches, matrices[~even]):
        yield map_sum(area_moments(patches, area.order)[0], places)


def _shell(reading: Reading, unit: float, wall: str, thickness: float, threads: int) -> Body:
    """Thin sheets, or walls with the surfaces at their inner or outer side or in their middle."""
    own, meshes = _parts(reading)
    if meshes.parts and wall != "thin":
        raise ReadError("wall_of_mixed_surfaces")
    sheets, areas, healths, by_part = [], [], [], []
    for part in own:
        matrices = in_metres(part.matrices, unit)
        measure = measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored)
        grown_by = np.cbrt(np.linalg.det(matrices[:, :3, :3])) ** 2
        healths.append((measure.health, len(matrices), measure.area.total * float(grown_by.sum())))
        if wall == "thin":
            areas += _areas(part, measure.area, matrices)
            continue
        outward = [patch.turned() if sign < 0.0 else patch for patch, sign in zip(part.splines.patches, measure.signs)]
        sharpest = sharpest_crease(part.splines.patches, measure.closure)
        if sharpest > CREASE:
            by_part.append((part.source, [finding("wall_creases", angle=float(np.degrees(sharpest)))]))
        inner, outer = (thickness * height for height in HEIGHTS[wall])
        for patches, places in _distinct(outward, matrices):
            grown = unit * float(np.linalg.norm(part.matrices[:, :3, :3], 2, axis=(1, 2)).max())
            sheet, area, fine = measure_sheet(patches, inner, outer, stored=part.splines.stored * grown)
            sheets.append(map_sum(sheet, places))
            areas.append(map_sum(area, places))
            if not fine:
                by_part.append((part.source, [finding("wall_error_estimate_large")]))
    findings = [] if not by_part else findings_by_part(by_part, reading.name)
    if meshes.parts:
        body = mesh_body(meshes, unit, shell=True, union=False, threads=threads)
        areas.append(body.area)
        healths.append((body.health, 1, body.area.total))
        findings += body.findings
    area = sum_moments(areas)
    nothing = replace(
        area,
        raw=np.zeros_like(area.raw),
        error=np.zeros_like(area.raw),
        input=np.zeros_like(area.raw),
        of=Measure.VOLUME,
    )

    def to_order(order: int, _with_area: bool) -> tuple[Moments, Moments]:
        found = [
            moments
            for part in own
            for moments in _areas(part, area_moments(part.splines.patches, order)[0], in_metres(part.matrices, unit))
        ]
        volume = Moments(np.zeros(monomial_count(order)), area.about, Measure.VOLUME)
        return volume, sum_moments(found + ([body.to_order(order, True)[1]] if meshes.parts else []))

    return Body(
        nothing,
        area,
        together(healths),
        _with_nurbs(reading, "shell"),
        tuple(each_once(findings)),
        wall=sum_moments(sheets) if sheets else None,
        to_order=to_order if wall == "thin" else None,
        estimated=True,
    )


def _distinct(patches: Sequence[Patch], matrices: NDArray) -> Iterator[tuple[list[Patch], NDArray]]:
    """The patches under each different linear map, facing as before, and the (k, 4, 4) translations to where they
    stand."""
    for linear, own in distinct_linear(matrices):
        turn = np.eye(4)
        turn[:3, :3] = linear
        mapped = [patch.mapped(turn) for patch in patches]
        if np.linalg.det(turn) < 0.0:
            mapped = [patch.turned() for patch in mapped]
        yield mapped, translations(matrices[own, :3, 3])
