# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies in files without any object: meshes, read as a whole or in blocks; scans and arrays of
densities.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from .. import files, nurbs, scans, solid, streams
from ..density import POSITIONS_ONLY_AS_DENSITY, GridOptions, sum_labels
from ..measurement import DENSITY_FROM, NO_VOLUME, Body, Measurement, Settings
from ..moments import KNOWN_ORDER, Moments, affine_matrices
from ..numerics import Array, NDArray
from ..verdict import (
    NO_FACES,
    SELF_INTERSECTION,
    Finding,
    MeshHealth,
    Method,
    Procedure,
    ReadError,
    Source,
    finding,
)
from . import mesh_body, printed, wall
from .findings import (
    GIVEN_DENSITY_IGNORED,
    GRID_AS_SHELL,
    GRID_DENSITY,
    GRID_EMPTY,
    GRID_TOO_LARGE,
    MESH_STREAMED,
    SAMPLES_POSITIONED,
    STREAMED_OPEN,
)
from .grid import (
    MAX_SAMPLES,
    TRILINEAR,
    Samples,
    ThresholdGrid,
    density_body,
    label_body,
    label_value,
    threshold_grid_body,
)
from .reading import Part, Reading, about_file, bare_reading, measure_reading

COUNTED = "boundary_edges", "non_manifold_edges", "inconsistent_edges", "components"


def read_mesh(mesh: streams.FileMesh, upright: Array) -> Reading:
    """Return the reading of a file's mesh in a place, (4, 4): a rotation.

    FileError if a coordinate is too large, ReadError if there are no faces.
    """
    if not len(mesh.sides):
        raise ReadError(NO_FACES)
    with np.errstate(over="ignore"):
        streams.box_of_blocks([mesh.points.astype(np.float32)], "vertex")
    part = Part(mesh.surface(), upright[None])
    return Reading(mesh.name, "MESH", upright, upright[:3, :3], np.zeros(3), [part])


def body_of_mesh(reading: Reading, settings: Settings) -> mesh_body.MeshBody | wall.WallBody:
    """Return the solid or sheet that the faces bound, with walls as set, or raise MeasureError."""
    is_shell = settings.kind == "shell"
    body = mesh_body.sum_of_instances(reading, settings.unit, is_shell, settings.threads)
    if is_shell and settings.wall != "thin":
        return wall.find_walls(reading, body, settings.wall).body(settings.thickness)
    return printed.print_body(body, settings) if settings.kind == "printed" else body


class StreamHealth(MeshHealth):
    """Health of a streamed mesh: closed or not, and nothing else, because no edge was kept."""

    def as_record(self) -> dict:
        """Return plain values for JSON, None for all uncounted faults."""
        return {
            "closed": self.closed,
            "welded": False,
            **dict.fromkeys(COUNTED),
            SELF_INTERSECTION: "not_checked",
        }


@dataclass(frozen=True, eq=False)
class StreamBody(Body):
    """The solid or the sheet of the faces in a file; unit: meters per unit of the file."""

    any_order: ClassVar[bool] = True

    mesh: streams.MeshFile = field(kw_only=True)
    unit: float = field(kw_only=True)
    threads: int = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments to an order; an order above the stored moments' reads the file
        again.
        """
        if order <= self.volume.order and (not area or order <= self.area.order):
            return self.volume.truncate(order), self.area.truncate(order) if area else None
        integrals = streams.measure_stream(self.mesh, order, order if area else 0, self.threads)
        volume, areas = _in_meters(integrals, self.unit)
        return volume, areas if area else None


@dataclass(frozen=True, eq=False)
class FaceBody(Body):
    """The solid or the sheet of curved faces, in meters. stored: as in `measure_patches`."""

    any_order: ClassVar[bool] = True

    faces: tuple[nurbs.Face, ...] = field(kw_only=True)
    stored: float = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments to an order."""
        integrals = nurbs.measure_patches(
            self.faces, order=order, area_order=order if area else 0, stored=self.stored
        )
        return integrals.volume, integrals.area if area else None


def measure_faces(
    name: str, faces: Sequence[nurbs.Face], rounding: float, settings: Settings
) -> Measurement:
    """Return the mass properties of a solid or a thin sheet of faces, or raise MeasureError.

    rounding: largest effect of a file's decimals on a point, in its unit.
    """
    scale = np.diag([*[settings.unit] * 3, 1.0])
    placed = tuple(face.transform(scale) for face in faces)
    stored = settings.unit * rounding
    integrals = nurbs.measure_patches(placed, area_order=3, stored=stored)
    is_shell = settings.kind == "shell"
    body = FaceBody(
        integrals.volume * 0.0 if is_shell else integrals.volume,
        integrals.area,
        integrals.health,
        Method(Procedure.SHELL if is_shell else integrals.method, Source.NURBS),
        integrals.findings,
        estimated=True,
        faces=placed,
        stored=stored,
    )
    return measure_reading(bare_reading(name, "SURFACE"), body, settings)


def measure_mesh_file(
    path: str,
    name: str,
    settings: Settings,
    findings: tuple[Finding, ...] = (),
    progress: Callable[[int], None] | None = None,
) -> Measurement:
    """Return the mass properties of an .stl or .ply file as one body; `progress` gets the number of
    faces just read.
    """
    kind = settings.kind
    unit = settings.unit
    order = max(settings.order or KNOWN_ORDER, KNOWN_ORDER)
    area_order = order if kind == "shell" or settings.surface else 0
    with about_file(name):
        mesh = streams.open_mesh_file(path)
        integrals = streams.measure_stream(mesh, order, area_order, settings.threads, progress)
        volume, area = _in_meters(integrals, unit)
        notes = [*findings, finding(MESH_STREAMED, count=integrals.face_count)]
        procedure = Procedure.EXACT
        if not integrals.closed:
            procedure = Procedure.OPEN
            if kind == "solid":
                notes.append(finding(STREAMED_OPEN))
        elif integrals.volume.total < 0.0:
            procedure = Procedure.REORIENTED
            if kind == "solid":
                notes.append(finding(solid.INVERTED_COMPONENTS, count=1, total=1))
        body = StreamBody(
            volume,
            area,
            StreamHealth(closed=integrals.closed),
            Method(procedure),
            tuple(notes),
            # Axes of many faces come from third order, without reading them again.
            face_count=integrals.face_count,
            mesh=mesh,
            unit=unit,
            threads=settings.threads,
        )
        if kind == "solid" and not volume.total > volume.rounding_error[0]:
            raise ReadError(NO_VOLUME)
        # The moments are in meters already.
        return measure_reading(bare_reading(name, "MESH"), body, replace(settings, unit=1.0))


def _in_meters(integrals: streams.StreamIntegrals, unit: float) -> tuple[Moments, Moments]:
    """Return the moments of volume and area, in SI units; a negative volume is reversed, as if
    faces were outward.
    """
    matrix = np.diag([unit, unit, unit, 1.0])
    volume = integrals.volume * -1.0 if integrals.volume.total < 0.0 else integrals.volume
    return volume.transform(matrix), integrals.area.transform(matrix)


@dataclass(frozen=True)
class ArrayOptions:
    """Options of a measured array file.

    spacing, origin: (x, y, z) in place of the file's own; unit_scale: meters per unit if the file
    has none; density_scale: kg/m³ that a sample of 1 stands for; threshold: smallest value inside
    the body, None for all; limits: of the file's size; positions: paths of files with the samples'
    positions, by axis, in units of unit_scale.
    """

    spacing: Sequence[float] | None = None
    origin: Sequence[float] | None = None
    spline_order: int = 1
    density_scale: float = 1.0
    threshold: float | None = None
    unit_scale: float | None = None
    limits: files.Limits = files.DEFAULT_LIMITS
    positions: Mapping[str, str] = field(default_factory=dict)


def measure_labels(
    path: str,
    name: str,
    array: ArrayOptions,
    settings: Settings,
    wanted: Sequence[int] | None,
    table: Mapping[int, scans.Label],
) -> list[tuple[Measurement, dict[str, Any]]]:
    """Return the measurement of each label of a file's samples, and its entry `label` of the
    record.

    wanted: the labels, None for all but 0. table: their names, colors and densities, else those of
    the header and the settings.
    """
    if settings.kind != "solid":
        raise ReadError(GRID_AS_SHELL, subject=name)
    if array.positions:
        raise ReadError(POSITIONS_ONLY_AS_DENSITY, grid=name)
    with about_file(name):
        scan = scans.read_scan(path, array.limits)
        matrix, placing = scans.sample_matrix(scan, array.spacing, array.origin, array.unit_scale)
        samples, matrix = in_file_order(scan.samples, matrix)
        sums = {
            label_value(label, scan.slope, scan.intercept): label_sums
            for label, label_sums in sum_labels(samples).items()
        }
        chosen = sorted(sums.keys() - {0}) if wanted is None else [*dict.fromkeys(wanted)]
        if absent := [label for label in chosen if label not in sums]:
            raise ReadError(
                scans.LABEL_ABSENT,
                file=os.path.basename(path),
                labels=absent,
                others=sorted(sums),
                remedy="--label",
            )
        if not chosen:
            raise ReadError(GRID_EMPTY)
        descriptions = [table.get(label, scan.labels.get(label, scans.Label())) for label in chosen]
        names = [
            description.name or "{} {}".format(name, label)
            for label, description in zip(chosen, descriptions)
        ]
        measured = []
        for label, description, label_name in zip(chosen, descriptions, names):
            if names.count(label_name) > 1:
                label_name = "{} ({})".format(label_name, label)
            label_settings = settings
            if description.density is not None:
                label_settings = replace(settings, density=description.density, mass=None)
            body = label_body(sums[label], matrix, (*scan.findings, *placing))
            measurement = measure_reading(bare_reading(label_name, "ARRAY"), body, label_settings)
            entry: dict[str, Any] = {"value": label, "voxels": int(sums[label][0])}
            if description.color is not None:
                entry["color"] = [*description.color]
            measured.append((measurement, {"label": entry}))
    return measured


def measure_array(
    path: str,
    name: str,
    array: ArrayOptions,
    settings: Settings,
    progress: Callable[[int], None] = lambda samples: None,
) -> Measurement:
    """Return the mass properties of the samples in a file; `progress` gets the number of samples
    just read.
    """
    if settings.kind == "shell":
        raise ReadError(GRID_AS_SHELL, subject=name)
    with about_file(name):
        scan = scans.read_scan(path, array.limits)
        matrix, findings = scans.sample_matrix(scan, array.spacing, array.origin, array.unit_scale)
        positions = scans.read_all_positions(array.positions, scan.samples.shape)
        matrix, positions = scans.place_samples(matrix, positions, array.unit_scale or 1.0)
        if array.positions:
            if len(array.positions) == len(scans.AXES):  # then no axis lacks a spacing
                unspaced = finding(scans.SCAN_UNSTATED, part="spacing", option="spacing")
                findings = tuple(result for result in findings if result != unspaced)
            positioned = finding(SAMPLES_POSITIONED, axes=sorted(array.positions))
            findings = (*findings, positioned)
        findings = (*scan.findings, *findings)
        if array.threshold is None:
            grid = GridOptions(value_density=array.density_scale, spline_order=array.spline_order)
            shape = scan.samples.shape
            findings += (
                finding(GRID_DENSITY, samples=list(shape), cause=grid.meaning().as_record()),
            )
            if settings.density is not None:
                findings += (finding(GIVEN_DENSITY_IGNORED),)
            samples = Samples(
                scan.samples, shape, matrix, grid, None, scan.slope, scan.intercept, positions
            )
            body = density_body(samples, findings, progress, settings.order or KNOWN_ORDER)
            body = replace(body, density_from=finding(DENSITY_FROM, source="samples"))
        else:
            body = _threshold_body(name, scan, matrix, array, settings, findings, progress)
        density = None if body.mass is not None else settings.density
        reading = bare_reading(name, "ARRAY")
        return measure_reading(reading, body, replace(settings, density=density))


def in_file_order(samples: NDArray, matrix: Array) -> tuple[NDArray, Array]:
    """Return samples and their matrix with axes in the order of the file, the slowest first."""
    slowest = np.argsort([-abs(stride) for stride in samples.strides], kind="stable")
    return samples.transpose(slowest), matrix @ affine_matrices(np.eye(3)[:, slowest])


def _threshold_body(
    name: str,
    scan: scans.Scan,
    matrix: Array,
    array: ArrayOptions,
    settings: Settings,
    findings: tuple[Finding, ...],
    progress: Callable[[int], None],
) -> Body:
    """Return the body at or above a threshold, filled with the given density, else with the samples
    as densities.
    """
    if array.positions:
        raise ReadError(POSITIONS_ONLY_AS_DENSITY, grid=name)
    filled = settings.density is None
    spline_order = max(array.spline_order, TRILINEAR)
    grid = GridOptions(
        threshold=array.threshold,
        filled=filled,
        value_density=array.density_scale,
        spline_order=spline_order,
    )
    if spline_order > TRILINEAR and scan.samples.size > MAX_SAMPLES:
        raise ReadError(GRID_TOO_LARGE, grid=name, samples=list(scan.samples.shape))
    samples, matrix = in_file_order(scan.samples, matrix)

    def values(block: NDArray) -> Array:
        progress(block.size)
        return block * scan.slope + scan.intercept

    body = threshold_grid_body(
        ThresholdGrid(name, samples, matrix, None, values),
        grid,
        order=settings.order or KNOWN_ORDER,
    )
    source = finding(DENSITY_FROM, source="samples") if filled else None
    return replace(body, findings=(*findings, *body.findings), density_from=source)
