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
from ...core.moments.affine_maps import distinct_linear_parts, translation_matrices
from ...core.moments.moments import Measure, Moments, are_similarities, monomial_count, sum_moments, sum_of_images
from ...core.nurbs.creases import sharpest_crease
from ...core.nurbs.patch import Patch
from ...core.nurbs.patch_moments import area_moments, volume_moments
from ...core.nurbs.solid import PatchIntegrals, measure_patches, measure_sheet
from ...core.verdict.finding import MeasureError, ReadError, finding
from ..read import Part, Reading
from .body import MeasuredBody
from .instances import (
    METHOD_RANK,
    each_once,
    findings_by_part,
    instances_overlap,
    merge_health,
    not_compared,
    singular_instances_message,
    singular_reason,
    to_si,
)
from .mesh import mesh_body

MIN_CREASE_ANGLE = 0.02  # radians: less is what float32 leaves of a surface without
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
) -> MeasuredBody:
    """What an object's surfaces bound where some of them are B-spline patches, or the sheets that they are.

    unit: metres per Blender unit. wall: of a shell, as in `MeasureOptions`; None for solids. thickness: m. union:
    shells that overlap are united, for which polygons are needed. compare: also measure what the display mesh would
    have given. MeasureError where there is nothing to measure.
    """
    if wall is not None:
        return _sheet_body(reading, unit, wall, thickness, threads)
    if reading.all_singular:
        raise ReadError(singular_reason(reading))
    patch_parts, meshes = _split_parts(reading)
    measures = [measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored) for part in patch_parts]
    if union and (reading.instance_count > 1 or measures[0].health.components > 1):
        body = mesh_body(reading, unit, shell=False, union=True, threads=threads)
        return replace(body, findings=(finding("union_of_display_mesh"), *body.findings))
    rest = mesh_body(meshes, unit, shell=False, union=False, threads=threads) if meshes.parts else None
    mesh_bodies = [rest] if rest else []
    findings = findings_by_part(
        [(part.source_object_name, measure.findings) for part, measure in zip(patch_parts, measures)], reading.name
    )
    findings += [result for measure in mesh_bodies for result in measure.findings]
    if reading.singular_instance_count:
        findings.append(singular_instances_message(reading.singular_instance_count))
    if reading.instance_count > 1 and instances_overlap(reading):
        findings.append(not_compared(reading))
    matrices_of_parts = [to_si(part.matrices, unit) for part in patch_parts]
    volume = sum_moments(
        [
            *map(sum_of_images, (measure.volume for measure in measures), matrices_of_parts),
            *(measure.volume for measure in mesh_bodies),
        ]
    )
    areas = [
        sum_moments(list(_image_areas(part, measure.area, matrices)))
        for part, measure, matrices in zip(patch_parts, measures, matrices_of_parts)
    ]
    area = sum_moments(areas + [measure.area for measure in mesh_bodies])
    display = None
    if compare:
        with suppress(MeasureError):  # a display mesh that cannot be measured compares with nothing
            display = mesh_body(reading, unit, shell=False, union=False, threads=threads).volume.total

    def to_order(order: int, with_area: bool) -> tuple[Moments, Moments | None]:
        volumes = [
            sum_of_images(_moments_to_order(measured_patches, order), matrices)
            for measured_patches, matrices in zip(measures, matrices_of_parts)
        ]
        faces = (
            [
                moments
                for part, measured_patches, matrices in zip(patch_parts, measures, matrices_of_parts)
                for moments in _image_areas(
                    part, area_moments(part.splines.patches, order, measured_patches.area.about)[0], matrices
                )
            ]
            if with_area
            else []
        )
        for measured_patches in mesh_bodies:
            more, outside = measured_patches.moments(order, with_area)
            volumes, faces = [*volumes, more], [*faces, *([outside] if with_area else [])]
        return sum_moments(volumes), sum_moments(faces) if with_area else None

    def pieces(sheets: bool) -> Iterator[Surface]:  # of the display mesh: what asks for them asks for polygons
        return mesh_body(reading, unit, shell=sheets, union=False, threads=threads).surfaces(sheets)

    health = merge_health(
        [
            (measure.health, len(part.matrices), faces.total)
            for measure, part, faces in zip(measures, patch_parts, areas)
        ]
        + [(measure.health, 1, measure.area.total) for measure in mesh_bodies]
    )
    method = min((measure.method for measure in (*measures, *mesh_bodies)), key=METHOD_RANK.index)
    return MeasuredBody(
        volume,
        area,
        health,
        _with_nurbs(reading, method),
        tuple(each_once(findings)),
        third_order=lambda: volume,
        display_volume=display,
        moments=to_order,
        surfaces=pieces,
        estimated=True,
    )


def _split_parts(reading: Reading) -> tuple[list[Part], Reading]:
    """The parts that are patches, and a reading of the others."""
    return (
        [part for part in reading.parts if part.splines is not None],
        replace(reading, parts=[part for part in reading.parts if part.splines is None]),
    )


def _with_nurbs(reading: Reading, method: str) -> str:
    """With `NURBS` before it where all that was measured are patches."""
    return "NURBS " + method if all(part.splines for part in reading.parts) else method


def _moments_to_order(measure: PatchIntegrals, order: int) -> Moments:
    """The volume's moments to another order; those of an open body, or of none, to the one that is known."""
    if measure.method == "open":
        raise ReadError("open_patches_order")
    return volume_moments(measure.patches, order, measure.volume.about)[0]


def _image_areas(part: Part, area: Moments, matrices: NDArray) -> Iterator[Moments]:
    """The area moments of a part's images."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield sum_of_images(area, matrices[even])
    for patches, translations_of_image in _distinct_images(part.splines.patches, matrices[~even]):
        yield sum_of_images(area_moments(patches, area.order)[0], translations_of_image)


def _sheet_body(reading: Reading, unit: float, wall: str, thickness: float, threads: int) -> MeasuredBody:
    """Thin sheets, or walls with the surfaces at their inner or outer side or in their middle."""
    patch_parts, meshes = _split_parts(reading)
    if meshes.parts and wall != "thin":
        raise ReadError("wall_of_mixed_surfaces")
    sheets, areas, healths, by_part = [], [], [], []
    for part in patch_parts:
        matrices = to_si(part.matrices, unit)
        measure = measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored)
        grown_by = np.cbrt(np.linalg.det(matrices[:, :3, :3])) ** 2
        healths.append((measure.health, len(matrices), measure.area.total * float(grown_by.sum())))
        if wall == "thin":
            areas += _image_areas(part, measure.area, matrices)
            continue
        outward = [
            patch.reverse_orientation() if sign < 0.0 else patch
            for patch, sign in zip(part.splines.patches, measure.signs)
        ]
        sharpest = sharpest_crease(part.splines.patches, measure.topology)
        if sharpest > MIN_CREASE_ANGLE:
            by_part.append((part.source_object_name, [finding("wall_creases", angle=float(np.degrees(sharpest)))]))
        inner, outer = (thickness * height for height in HEIGHTS[wall])
        for patches, translations_of_image in _distinct_images(outward, matrices):
            grown = unit * float(np.linalg.norm(part.matrices[:, :3, :3], 2, axis=(1, 2)).max())
            sheet, area, fine = measure_sheet(patches, inner, outer, stored=part.splines.stored * grown)
            sheets.append(sum_of_images(sheet, translations_of_image))
            areas.append(sum_of_images(area, translations_of_image))
            if not fine:
                by_part.append((part.source_object_name, [finding("wall_error_estimate_large")]))
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
        rounding_error=np.zeros_like(area.raw),
        input_error=np.zeros_like(area.raw),
        measure=Measure.VOLUME,
    )

    def to_order(order: int, _with_area: bool) -> tuple[Moments, Moments]:
        area_parts = [
            moments
            for part in patch_parts
            for moments in _image_areas(part, area_moments(part.splines.patches, order)[0], to_si(part.matrices, unit))
        ]
        volume = Moments(np.zeros(monomial_count(order)), area.about, Measure.VOLUME)
        return volume, sum_moments(area_parts + ([body.moments(order, True)[1]] if meshes.parts else []))

    return MeasuredBody(
        nothing,
        area,
        merge_health(healths),
        _with_nurbs(reading, "shell"),
        tuple(each_once(findings)),
        wall=sum_moments(sheets) if sheets else None,
        moments=to_order if wall == "thin" else None,
        estimated=True,
    )


def _distinct_images(patches: Sequence[Patch], matrices: NDArray) -> Iterator[tuple[list[Patch], NDArray]]:
    """The patches under each different linear map, facing as before, and the (k, 4, 4) translations to where they
    stand."""
    for linear, members in distinct_linear_parts(matrices):
        turn = np.eye(4)
        turn[:3, :3] = linear
        mapped = [patch.transform(turn) for patch in patches]
        if np.linalg.det(turn) < 0.0:
            mapped = [patch.reverse_orientation() for patch in mapped]
        yield mapped, translation_matrices(matrices[members, :3, 3])
