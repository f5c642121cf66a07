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
from typing import ClassVar, NamedTuple, cast

import numpy as np

from ...core import bodies, mesh, nurbs, solid, verdict
from ...core.measurement import WALL_UNSUPPORTED, Body, Settings
from ...core.moments import (
    Moments,
    affine_matrices,
    are_similarities,
    distinct_linear_parts,
    sum_moments,
    sum_of_images,
)
from ...core.numerics import Array, NDArray
from ...core.polyhedron import nothing
from ..read.findings import DISPLAY_MESH_MEASURED
from .findings import WALL_CREASES, ZERO_SCALE
from .mesh import mesh_body
from .request import Request

MEASURED_AS = frozenset({"solid", "shell"})

MIN_CREASE_ANGLE = 0.02  # radians; smaller creases may be due to float32 alone
# Heights of a wall's two faces above the surface, in thicknesses of the wall.
HEIGHTS = {
    "inward": (-1.0, 0.0),
    "outward": (0.0, 1.0),
    "centered": (-0.5, 0.5),
}


class PlacedPatches(NamedTuple):
    """A part that is patches, its integrals in its own coordinates, and (k, 4, 4) maps from these
    to its places in the world, m.
    """

    part: bodies.Part
    integrals: nurbs.PatchIntegrals
    matrices: Array


@dataclass(frozen=True, eq=False)
class PatchBody(Body):
    """A body bounded by patches, and by polygons if some parts have no patches.

    `reading`: the whole object; `surfaces` yields its display mesh. `pieces`: the parts that are
    patches. `polygons`: the other parts.
    """

    any_order: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True

    reading: bodies.Reading = field(kw_only=True)
    unit: float = field(kw_only=True)
    pieces: tuple[PlacedPatches, ...] = ()
    polygons: bodies.MeshBody | None = None
    threads: int = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of the volume and of the area (None without `area`) to an order."""
        volumes, areas = [], []
        for part, integrals, matrices in self.pieces:
            volume = nurbs.volume_moments(integrals.patches, order, integrals.volume.about)[0]
            volume = bodies.extend_input_error(volume, integrals.volume)
            volumes.append(sum_of_images(volume, matrices))
            if area:
                faces = nurbs.area_moments(_splines(part).patches, order, integrals.area.about)[0]
                faces = bodies.extend_input_error(faces, integrals.area)
                areas.extend(_image_areas(part, faces, matrices))
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
            splines = _splines(part)
            faces = nurbs.stored_area_moments(splines.patches, order, stored=splines.stored)
            areas.extend(_image_areas(part, faces, bodies.to_si(part.matrices, self.unit)))
        if self.polygons is not None:
            faces = self.polygons.moments(order, True)[1]
            areas += [faces] if faces is not None else []
        return nothing(order, self.area.about)[0], sum_moments(areas)


def _splines(part: bodies.Part) -> bodies.SplineReading:
    """Return the patches of a part, which must have some, and the rounding of their points in
    storage.
    """
    return cast(bodies.SplineReading, part.splines)


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
        return _sheet_body(reading, settings)
    if reading.all_singular:
        raise verdict.ReadError(ZERO_SCALE)
    pieces, meshes = _split_parts(reading, unit)
    needs_union = reading.instance_count > 1 or pieces[0].integrals.health.components > 1
    if settings.overlap == "union" and needs_union:
        united = mesh_body(reading, unit, shell=False, union=True, threads=threads)
        note = verdict.finding(DISPLAY_MESH_MEASURED, cause="a union needs polygons")
        return replace(united, findings=(note, *united.findings))
    volumes = []
    areas = []
    healths = []
    procedures = []
    for part, integrals, matrices in pieces:
        area = sum_moments(list(_image_areas(part, integrals.area, matrices)))
        volumes.append(sum_of_images(integrals.volume, matrices))
        areas.append(area)
        healths.append((integrals.health, len(matrices), area.total))
        procedures.append(verdict.Procedure(integrals.method))
    polygons = None
    if meshes.parts:
        polygons = mesh_body(meshes, unit, shell=False, union=False, threads=threads)
        volumes.append(polygons.volume)
        areas.append(polygons.area)
        healths.append((polygons.health, 1, polygons.area.total))
        procedures.append(polygons.method.procedure)
    display_volume = None
    if settings.compare:
        # A display mesh that cannot be measured compares with nothing.
        with suppress(verdict.MeasureError):
            display_mesh = mesh_body(reading, unit, shell=False, union=False, threads=threads)
            display_volume = display_mesh.volume.total
    return PatchBody(
        sum_moments(volumes),
        sum_moments(areas),
        bodies.merge_health(healths),
        verdict.Method(verdict.least_trusted(procedures), _source(reading)),
        tuple(bodies.each_once(_solid_findings(reading, pieces, polygons))),
        display_volume=display_volume,
        estimated=True,
        reading=reading,
        unit=unit,
        pieces=tuple(pieces),
        polygons=polygons,
        threads=threads,
    )


def _solid_findings(
    reading: bodies.Reading, pieces: list[PlacedPatches], polygons: bodies.MeshBody | None
) -> list[verdict.Finding]:
    by_part = [(piece.part.source_object_name, piece.integrals.findings) for piece in pieces]
    findings = bodies.findings_by_part(by_part, reading.name)
    if polygons:
        findings += polygons.findings
    if reading.singular_instance_count:
        findings.append(bodies.singular_instances_message(reading))
    if bodies.instances_overlap(reading):
        findings.append(verdict.finding(solid.UNCHECKED, subject=solid.OVERLAP_OF_INSTANCES))
    return findings


def _split_parts(
    reading: bodies.Reading, unit: float
) -> tuple[list[PlacedPatches], bodies.Reading]:
    """Return the parts that are patches, measured, and a reading of the others."""
    pieces = [
        PlacedPatches(
            part,
            nurbs.measure_patches(part.splines.patches, area_order=3, stored=part.splines.stored),
            bodies.to_si(part.matrices, unit),
        )
        for part in reading.parts
        if part.splines is not None
    ]
    return pieces, replace(reading, parts=[part for part in reading.parts if part.splines is None])


def _source(reading: bodies.Reading) -> verdict.Source:
    """Return the source of the measurement: NURBS if all parts are patches, else polygons."""
    return (
        verdict.Source.NURBS
        if all(part.splines for part in reading.parts)
        else verdict.Source.POLYGONS
    )


def _image_areas(part: bodies.Part, area: Moments, matrices: NDArray) -> Iterator[Moments]:
    """Yield the area moments of a part in its (k, 4, 4) places: one sum of all evenly scaled images
    of `area`, and one of all images by each other linear map, which are measured anew.
    """
    is_even = are_similarities(matrices[:, :3, :3])
    if is_even.any():
        yield sum_of_images(area, matrices[is_even])
    stored = _splines(part).stored * _largest_stretch(matrices)
    for patches, translations in _distinct_images(_splines(part).patches, matrices[~is_even]):
        yield sum_of_images(
            nurbs.stored_area_moments(patches, area.order, stored=stored), translations
        )


def _largest_stretch(matrices: NDArray) -> float:
    """Return the largest factor by which (k, 4, 4) maps lengthen a vector."""
    return float(np.linalg.norm(matrices[:, :3, :3], 2, axis=(1, 2)).max())


def _sheet_body(reading: bodies.Reading, settings: Settings) -> Body:
    """Return the body of thin sheets, or of walls inside, outside or on both sides of the
    surfaces.
    """
    has_meshes = not all(part.splines for part in reading.parts)
    if has_meshes and settings.wall != "thin":
        raise verdict.ReadError(WALL_UNSUPPORTED, quantity="A mixture of NURBS surfaces and meshes")
    pieces, meshes = _split_parts(reading, settings.unit)
    healths = []
    for _part, integrals, matrices in pieces:
        # The areas only weigh the healths, so that growth by an even scale is near enough.
        growth = np.cbrt(np.linalg.det(matrices[:, :3, :3])) ** 2
        area = integrals.area.total * float(growth.sum())
        healths.append((integrals.health, len(matrices), area))
    if settings.wall != "thin":
        return _wall_body(reading, pieces, bodies.merge_health(healths), settings)
    areas = []
    for part, integrals, matrices in pieces:
        areas += _image_areas(part, integrals.area, matrices)
    polygons = None
    if has_meshes:
        polygons = mesh_body(
            meshes, settings.unit, shell=True, union=False, threads=settings.threads
        )
        areas.append(polygons.area)
        healths.append((polygons.health, 1, polygons.area.total))
    area = sum_moments(areas)
    return PatchSheetBody(
        nothing(area.order, area.about)[0],
        area,
        bodies.merge_health(healths),
        verdict.Method(verdict.Procedure.SHELL, _source(reading)),
        tuple(bodies.each_once(polygons.findings if polygons else ())),
        estimated=True,
        unit=settings.unit,
        parts=tuple(piece.part for piece in pieces),
        polygons=polygons,
    )


def _wall_body(
    reading: bodies.Reading,
    pieces: list[PlacedPatches],
    health: verdict.MeshHealth,
    settings: Settings,
) -> Body:
    """Return the body of walls of the set thickness along the patches."""
    walls = []
    areas = []
    by_part = []
    inner, outer = (settings.thickness * height for height in HEIGHTS[settings.wall])
    for part, integrals, matrices in pieces:
        source = part.source_object_name
        splines = _splines(part)
        crease_angle = nurbs.sharpest_crease(splines.patches, integrals.topology)
        if crease_angle > MIN_CREASE_ANGLE:
            creases = verdict.finding(WALL_CREASES, angle=float(np.degrees(crease_angle)))
            by_part.append((source, [creases]))
        outward = [
            patch.reverse_orientation() if sign < 0.0 else patch
            for patch, sign in zip(splines.patches, integrals.signs)
        ]
        stored = splines.stored * (settings.unit * _largest_stretch(part.matrices))
        for patches, translations in _distinct_images(outward, matrices):
            wall, area, has_converged = nurbs.measure_sheet(patches, inner, outer, stored=stored)
            walls.append(sum_of_images(wall, translations))
            areas.append(sum_of_images(area, translations))
            if not has_converged:
                inexact = verdict.finding(nurbs.ERROR_ESTIMATE_LARGE, quantity="wall's volume")
                by_part.append((source, [inexact]))
    area = sum_moments(areas)
    return Body(
        nothing(area.order, area.about)[0],
        area,
        health,
        verdict.Method(verdict.Procedure.SHELL, _source(reading)),
        tuple(bodies.each_once(bodies.findings_by_part(by_part, reading.name))),
        wall=sum_moments(walls),
        estimated=True,
    )


def _distinct_images(
    patches: Sequence[nurbs.Face], matrices: NDArray
) -> Iterator[tuple[list[nurbs.Face], NDArray]]:
    """Yield the patches under each distinct linear map, facing as before, with (k, 4, 4)
    translations to the places that have this map.
    """
    for linear, members in distinct_linear_parts(matrices):  # members: indices of matrices
        mapped = [patch.transform(affine_matrices(linear)) for patch in patches]
        if np.linalg.det(linear) < 0.0:
            mapped = [patch.reverse_orientation() for patch in mapped]
        yield mapped, affine_matrices(np.eye(3), matrices[members, :3, 3])
