# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bodies in mesh files without any object: read as a whole, or in blocks if the file is larger than memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from ..measurement.body import Body
from ..measurement.findings import NO_VOLUME
from ..measurement.measurement import Measurement
from ..measurement.settings import Settings
from ..moments.exponents import KNOWN_ORDER
from ..moments.moments import Moments
from ..solid.findings import INVERTED_COMPONENTS
from ..streams.boxes import box_of_blocks
from ..streams.file_mesh import FileMesh
from ..streams.measure import MeshFile, StreamIntegrals, measure_stream, open_mesh_file
from ..verdict.finding import Finding, ReadError, finding
from ..verdict.findings import SELF_INTERSECTION
from ..verdict.health import MeshHealth
from ..verdict.method import Method, Verdict
from .findings import MESH_STREAMED, NO_GEOMETRY, STREAMED_OPEN
from .mesh_body import MeshBody
from .polygons import sum_of_instances
from .reading import Part, Reading, about_file, bare_reading, measure_reading
from .wall import WallBody, find_walls

COUNTED = "boundary_edges", "non_manifold_edges", "inconsistent_edges", "components"


def read_mesh(mesh: FileMesh, upright: NDArray[np.float64]) -> Reading:
    """Return the reading of a file's mesh in a place, (4, 4): a rotation.

    FileError if a coordinate is too large, ReadError if there are no faces.
    """
    if not len(mesh.sides):
        raise ReadError(NO_GEOMETRY)
    with np.errstate(over="ignore"):
        points = mesh.points.astype(np.float32)
    box_of_blocks([points], "vertex")
    part = Part(replace(mesh, points=points).surface(), upright[None])
    return Reading(mesh.name, "MESH", upright, upright[:3, :3], np.zeros(3), [part])


def body_of_mesh(reading: Reading, settings: Settings) -> MeshBody | WallBody:
    """Return the solid or sheet that the faces bound, with walls as set, or raise MeasureError."""
    is_shell = settings.kind == "shell"
    body = sum_of_instances(reading, settings.unit, is_shell, settings.threads)
    if is_shell and settings.wall != "thin":
        return find_walls(reading, body, settings.wall).body(settings.thickness)
    return body


class StreamHealth(MeshHealth):
    """Health of a streamed mesh: closed or not, and nothing else, because no edge was kept."""

    def as_record(self) -> dict:
        """Return plain values for JSON, None for all uncounted faults."""
        return {"closed": self.closed, "welded": False, **dict.fromkeys(COUNTED), SELF_INTERSECTION: "not_checked"}


@dataclass(frozen=True, eq=False)
class StreamBody(Body):
    """The solid or the sheet of the faces in a file; unit: meters per unit of the file."""

    any_order: ClassVar[bool] = True

    mesh: MeshFile = field(kw_only=True)
    unit: float = field(kw_only=True)
    threads: int = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments to an order; an order above the stored moments' reads the file again."""
        if order <= self.volume.order and (not area or order <= self.area.order):
            return self.volume.truncate(order), self.area.truncate(order) if area else None
        found = measure_stream(self.mesh, order, order if area else 0, self.threads)
        volume, areas = _in_meters(found, self.unit)
        return volume, areas if area else None


def measure_mesh_file(
    path: str,
    name: str,
    settings: Settings,
    findings: tuple[Finding, ...] = (),
    progress: Callable[[int], None] | None = None,
) -> Measurement:
    """Return the mass properties of an .stl or .ply file as one body; `progress` gets the number of faces just read."""
    kind, unit = settings.kind, settings.unit
    order = max(settings.order or KNOWN_ORDER, KNOWN_ORDER)
    area_order = order if kind == "shell" or settings.surface else 0
    with about_file(name):
        mesh = open_mesh_file(path)
        found = measure_stream(mesh, order, area_order, settings.threads, progress)
        volume, area = _in_meters(found, unit)
        body = StreamBody(
            volume,
            area,
            StreamHealth(closed=found.closed),
            Method(_verdict(found)),
            (*findings, *_findings(found, kind)),
            face_count=found.face_count,  # axes of many faces come from third order, without reading them again
            mesh=mesh,
            unit=unit,
            threads=settings.threads,
        )
        if kind == "solid" and not volume.total > volume.rounding_error[0]:
            raise ReadError(NO_VOLUME)
        reading = bare_reading(name, "MESH")
        return measure_reading(reading, body, replace(settings, unit=1.0))


def _verdict(found: StreamIntegrals) -> Verdict:
    if not found.closed:
        return Verdict.OPEN
    return Verdict.EXACT if found.volume.total >= 0.0 else Verdict.REORIENTED


def _in_meters(found: StreamIntegrals, unit: float) -> tuple[Moments, Moments]:
    """Return the moments of volume and area, in SI units; a negative volume is reversed, as if faces were outward."""
    matrix = np.diag([unit, unit, unit, 1.0])
    volume = found.volume * -1.0 if found.volume.total < 0.0 else found.volume
    return volume.transform(matrix), found.area.transform(matrix)


def _findings(found: StreamIntegrals, kind: str) -> list[Finding]:
    """Return the findings about a streamed mesh, and about the omitted checks."""
    findings = [finding(MESH_STREAMED, count=found.face_count)]
    if kind == "solid" and not found.closed:
        findings.append(finding(STREAMED_OPEN))
    elif kind == "solid" and found.volume.total < 0.0:
        findings.append(finding(INVERTED_COMPONENTS, count=1, total=1))
    return findings
