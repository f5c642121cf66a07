# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The body that B-spline patches bound, measured from their control points instead of their display
mesh.

Volumes map to all places of a surface; areas and sheets of real thickness are found anew for each
uneven map.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import ClassVar, cast

import numpy as np

from ...core import bodies, mesh, nurbs, solid, verdict
from ...core.measurement import WALL_UNSUPPORTED, Body
from ...core.moments import (
    Measure,
    Moments,
    affine_matrices,
    are_similarities,
    distinct_linear_parts,
    monomial_count,
    sum_moments,
    sum_of_images,
)
from ...core.numerics import Array, NDArray
from ..read.findings import DISPLAY_MESH_MEASURED
from .findings import WALL_CREASES, ZERO_SCALE
from .mesh import mesh_body
from .request import Request

MEASURED_AS = frozenset({"solid", "shell"})

MIN_CREASE_ANGLE = 0.02  # radians; smaller creases may be due to float32 alone
# in thicknesses of a wall
HEIGHTS = {
    "inward": (-1.0, 0.0),
    "outward": (0.0, 1.0),
    "centered": (-0.5, 0.5),
}


@dataclass(frozen=True, eq=False)
class PatchBody(Body):
    """A body bounded by patches, and by polygons if some parts have no patches.

    `reading`: the whole object; `surfaces` yields its display mesh. `pieces`: the parts that are
    patches, each with the (k, 4, 4) maps to its places. `polygons`: the other parts.
    """

    any_order: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True

    reading: bodies.Reading = field(kw_only=True)
    unit: float = field(kw_only=True)
    pieces: tuple[tuple[bodies.Part, nurbs.PatchIntegrals, Array], ...] = ()
    polygons: bodies.MeshBody | None = None
    threads: int = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume and of the area (None without `area`) to an order."""
        volumes, areas = [], []
        for _, measure, matrices in self.pieces:
            own = nurbs.volume_moments(measure.patches, order, measure.volume.about)[0]
            volumes.append(sum_of_images(bodies.extend_input_error(own, measure.volume), matrices))
        for part, measure, matrices in self.pieces if area else ():
            of_part = nurbs.area_moments(_patches(part), order, measure.area.about)[0]
            areas.extend(
                _image_areas(part, bodies.extend_input_error(of_part, measure.area), matrices)
            )
        if self.polygons is not None:
            volume, faces = self.polygons.moments(order, area)
            volumes.append(volume)
            areas += [faces] if faces is not None else []
        return sum_moments(volumes), sum_moments(areas) if area else None

    def surfaces(self, sheets: bool) -> Iterator[mesh.Surface]:
        """Yield the display mesh in its place, because callers need polygons."""
        return mesh_body(
            self.reading, self.unit, shell=sheets, union=False, threads=self.threads
        ).surfaces(sheets)


@dataclass(frozen=True, eq=False)
class PatchSheetBody(Body):
    """Thin sheets of patches, and of polygons if some parts have no patches; fields as in
    `PatchBody`.
    """

    any_order: ClassVar[bool] = True

    unit: float = field(kw_only=True)
    parts: tuple[bodies.Part, ...] = ()
    polygons: bodies.MeshBody | None = None

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments]:
        """Return zero moments of the volume, and the moments of the area."""
        areas = []
        for part in self.parts:
            of_part = nurbs.stored_area_moments(_patches(part), order, stored=_stored(part))
            areas.extend(_image_areas(part, of_part, bodies.to_si(part.matrices, self.unit)))
        if self.polygons is not None:
            faces = self.polygons.moments(order, True)[1]
            areas += [faces] if faces is not None else []
        return Moments(
            np.zeros(monomial_count(order)), self.area.about, Measure.VOLUME
        ), sum_moments(areas)


def _patches(part: bodies.Part) -> tuple[nurbs.Face, ...]:
    """Return the patches of a part, which must have some."""
    return cast(bodies.SplineReading, part.splines).patches


def _stored(part: bodies.Part) -> float:
    return cast(bodies.SplineReading, part.splines).stored


def read(request: Request) -> bodies.Reading:
    """Return the surfaces, at least one of them a patch, of an object of one density, or raise
    MeasureError.
    """
    return request.surfaces


def body(reading: bodies.Reading, request: Request) -> Body:
    """Return the body that patches bound, or their sheets or walls, or raise MeasureError if there
    is none.
    """
    settings = request.settings
    unit, threads = settings.unit, settings.threads
    if settings.kind == "shell":
        return _sheet_body(reading, unit, settings.wall, settings.thickness, threads)
    if reading.all_singular:
        raise verdict.ReadError(ZERO_SCALE)
    patch_parts, meshes = _split_parts(reading)
    measures = [
        nurbs.measure_patches(_patches(part), area_order=3, stored=_stored(part))
        for part in patch_parts
    ]
    if settings.overlap == "union" and (
        reading.instance_count > 1 or measures[0].health.components > 1
    ):
        united = mesh_body(reading, unit, shell=False, union=True, threads=threads)
        return replace(
            united,
            findings=(
                verdict.finding(DISPLAY_MESH_MEASURED, cause="a union needs polygons"),
                *united.findings,
            ),
        )
    rest = (
        mesh_body(meshes, unit, shell=False, union=False, threads=threads) if meshes.parts else None
    )
    pieces = [
        (part, measure, bodies.to_si(part.matrices, unit))
        for part, measure in zip(patch_parts, measures)
    ]
    volumes = [sum_of_images(measure.volume, matrices) for _, measure, matrices in pieces]
    areas = [
        sum_moments(list(_image_areas(part, measure.area, matrices)))
        for part, measure, matrices in pieces
    ]
    healths = [
        (measure.health, len(part.matrices), faces.total)
        for (part, measure, _), faces in zip(pieces, areas)
    ]
    procedures = [verdict.Procedure(measure.method) for measure in measures]
    if rest:
        volumes.append(rest.volume)
        areas.append(rest.area)
        healths.append((rest.health, 1, rest.area.total))
        procedures.append(rest.method.procedure)
    display = None
    if settings.compare:
        # A display mesh that cannot be measured compares with nothing.
        with suppress(verdict.MeasureError):
            display = mesh_body(
                reading, unit, shell=False, union=False, threads=threads
            ).volume.total
    return PatchBody(
        sum_moments(volumes),
        sum_moments(areas),
        bodies.merge_health(healths),
        verdict.Method(verdict.least_trusted(procedures), _source(reading)),
        tuple(bodies.each_once(_solid_findings(reading, pieces, rest))),
        display_volume=display,
        estimated=True,
        reading=reading,
        unit=unit,
        pieces=tuple(pieces),
        polygons=rest,
        threads=threads,
    )


def _solid_findings(
    reading: bodies.Reading,
    pieces: list[tuple[bodies.Part, nurbs.PatchIntegrals, NDArray]],
    rest: bodies.MeshBody | None,
) -> list[verdict.Finding]:
    by_part = [(part.source_object_name, measure.findings) for part, measure, _ in pieces]
    findings = bodies.findings_by_part(by_part, reading.name)
    if rest:
        findings += rest.findings
    if reading.singular_instance_count:
        findings.append(bodies.singular_instances_message(reading))
    if bodies.instances_overlap(reading):
        findings.append(verdict.finding(solid.UNCHECKED, subject=solid.OVERLAP_OF_INSTANCES))
    return findings


def _split_parts(reading: bodies.Reading) -> tuple[list[bodies.Part], bodies.Reading]:
    """Return the parts that are patches, and a reading of the others."""
    return (
        [part for part in reading.parts if part.splines is not None],
        replace(reading, parts=[part for part in reading.parts if part.splines is None]),
    )


def _source(reading: bodies.Reading) -> verdict.Source:
    """Return the source of the measurement: NURBS if all parts are patches, else polygons."""
    return (
        verdict.Source.NURBS
        if all(part.splines for part in reading.parts)
        else verdict.Source.POLYGONS
    )


def _image_areas(part: bodies.Part, area: Moments, matrices: NDArray) -> Iterator[Moments]:
    """Yield the area moments of each place of a part."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield sum_of_images(area, matrices[even])
    stored = _stored(part) * float(np.linalg.norm(matrices[:, :3, :3], 2, axis=(1, 2)).max())
    for patches, translations_of_image in _distinct_images(_patches(part), matrices[~even]):
        yield sum_of_images(
            nurbs.stored_area_moments(patches, area.order, stored=stored), translations_of_image
        )


def _sheet_body(
    reading: bodies.Reading, unit: float, wall: str, thickness: float, threads: int
) -> Body:
    """Return the body of thin sheets, or of walls inside, outside or on both sides of the
    surfaces.
    """
    patch_parts, meshes = _split_parts(reading)
    if meshes.parts and wall != "thin":
        raise verdict.ReadError(WALL_UNSUPPORTED, quantity="A mixture of NURBS surfaces and meshes")
    sheets = []
    areas = []
    healths = []
    by_part = []
    for part in patch_parts:
        matrices = bodies.to_si(part.matrices, unit)
        measure = nurbs.measure_patches(_patches(part), area_order=3, stored=_stored(part))
        grown_by = np.cbrt(np.linalg.det(matrices[:, :3, :3])) ** 2
        healths.append((measure.health, len(matrices), measure.area.total * float(grown_by.sum())))
        if wall == "thin":
            areas += _image_areas(part, measure.area, matrices)
            continue
        outward = [
            patch.reverse_orientation() if sign < 0.0 else patch
            for patch, sign in zip(_patches(part), measure.signs)
        ]
        sharpest = nurbs.sharpest_crease(_patches(part), measure.topology)
        if sharpest > MIN_CREASE_ANGLE:
            by_part.append(
                (
                    part.source_object_name,
                    [verdict.finding(WALL_CREASES, angle=float(np.degrees(sharpest)))],
                )
            )
        inner, outer = (thickness * height for height in HEIGHTS[wall])
        for patches, translations_of_image in _distinct_images(outward, matrices):
            grown = unit * float(np.linalg.norm(part.matrices[:, :3, :3], 2, axis=(1, 2)).max())
            sheet, area, fine = nurbs.measure_sheet(
                patches, inner, outer, stored=_stored(part) * grown
            )
            sheets.append(sum_of_images(sheet, translations_of_image))
            areas.append(sum_of_images(area, translations_of_image))
            if not fine:
                by_part.append(
                    (
                        part.source_object_name,
                        [verdict.finding(nurbs.ERROR_ESTIMATE_LARGE, quantity="wall's volume")],
                    )
                )
    findings = bodies.findings_by_part(by_part, reading.name)
    polygons = None
    if meshes.parts:
        polygons = mesh_body(meshes, unit, shell=True, union=False, threads=threads)
        areas.append(polygons.area)
        healths.append((polygons.health, 1, polygons.area.total))
        findings += polygons.findings
    area = sum_moments(areas)
    nothing = Moments(np.zeros_like(area.raw), area.about, Measure.VOLUME)
    common = (
        nothing,
        area,
        bodies.merge_health(healths),
        verdict.Method(verdict.Procedure.SHELL, _source(reading)),
        tuple(bodies.each_once(findings)),
    )
    if wall != "thin":
        return Body(*common, wall=sum_moments(sheets), estimated=True)
    return PatchSheetBody(
        *common, estimated=True, unit=unit, parts=tuple(patch_parts), polygons=polygons
    )


def _distinct_images(
    patches: Sequence[nurbs.Face], matrices: NDArray
) -> Iterator[tuple[list[nurbs.Face], NDArray]]:
    """Yield the patches under each distinct linear map, facing as before, with (k, 4, 4)
    translations to the places.
    """
    for linear, members in distinct_linear_parts(matrices):
        mapped = [patch.transform(affine_matrices(linear)) for patch in patches]
        if np.linalg.det(linear) < 0.0:
            mapped = [patch.reverse_orientation() for patch in mapped]
        yield mapped, affine_matrices(np.eye(3), matrices[members, :3, 3])
