# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies bounded by polygons, with all their instances: each surface is measured once and mapped to
its places.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar

import numpy as np

from .. import measurement, mesh, polyhedron
from ..moments import Moments, monomials, sum_moments, sum_of_images
from ..numerics import Array, Integers
from ..solid import (
    DUPLICATE_FACES_COUNTED,
    NON_PLANAR_FACES,
    OVERLAP_OF_INSTANCES,
    UNCHECKED,
    SolidIntegrals,
    measure_again,
    measure_stack,
)
from ..verdict import NEGLIGIBLE, Finding, Method, Procedure, finding, least_trusted
from .findings import (
    DRAWN_AS_POLYGONS,
    FLAT_SURFACES,
    NON_PLANAR_FACES_OF_DISPLAY_MESH,
)
from .instances import (
    area_of_instances,
    compare_places,
    findings_by_part,
    instances_overlap,
    instances_size,
    merge_health,
    overlap_findings,
)
from .reading import Part, Reading, to_si

MAX_MASS_MOMENT = 1e100  # kg m^n; squares of much larger moments would overflow
MAX_COMPARED_TRIANGLES = 200_000  # triangles up to which instances are compared with each other


@dataclass(frozen=True, eq=False)
class MeshBody(measurement.Body):
    """A body bounded by polygons, or the sheets of these polygons.

    `solids`: the measured surfaces, each with the (k, 4, 4) maps to its places.
    """

    any_order: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True

    solids: tuple[tuple[SolidIntegrals, Array], ...] = ()
    threads: int = field(kw_only=True)

    def moments(self, order: int, area: bool) -> tuple[Moments, Moments | None]:
        """Return the moments of volume and area (None without `area`) to an order, measured once
        for each part.
        """
        volumes, areas = [], []
        # up to third order the area is found on the way, and makes bounds smaller
        alone = 0 if order <= 3 else None

        def measured(surface: mesh.Surface) -> Moments:
            return polyhedron.polyhedron_moments(
                surface, order, area_order=order, exact=True, threads=self.threads, allow_open=True
            )[1]

        for solid, matrices in self.solids:
            surface = solid.given_surface
            # otherwise the repaired surface has fewer or more faces
            same = (
                solid.method in (Procedure.EXACT, Procedure.REORIENTED)
                and not solid.health.duplicate_faces
                and solid.repaired_surface.triangle_count == surface.triangle_count
            )
            volume, faces = polyhedron.polyhedron_moments(
                solid.repaired_surface,
                order,
                area_order=order if area and same else alone,
                about=solid.volume.about,  # an open surface's moments depend on it
                exact=True,
                threads=self.threads,
                allow_open=True,
            )
            volumes.append(sum_of_images(volume, matrices))
            if area:
                of_faces = faces if same and faces is not None else measured(surface)
                areas.extend(area_of_instances(surface, of_faces, matrices, measured))
        return sum_moments(volumes), sum_moments(areas) if area else None

    def third_order(self) -> Moments:
        """Return the moments of the volume, the third order exact to rounding."""
        return sum_moments(
            [
                sum_of_images(solid.exact_third_order(self.threads), matrices)
                for solid, matrices in self.solids
            ]
        )

    def surfaces(self, sheets: bool) -> Iterator[mesh.Surface]:
        """Yield the surfaces in world coordinates, repaired, or with `sheets` as they were before
        repair.
        """
        for solid, matrices in self.solids:
            piece = solid.given_surface if sheets else solid.repaired_surface
            yield from (piece.transform(matrix[:3, :3], matrix[:3, 3]) for matrix in matrices)


def with_input_error(moments: Moments, known: Moments) -> Moments:
    """Return moments with input bounds no larger than those of `known`, if both are about the same
    point.
    """
    if not np.array_equal(moments.about, known.about):
        return moments
    error = moments.input_error.copy()
    error[: len(known.raw)] = np.minimum(error[: len(known.raw)], known.input_error)
    return replace(moments, input_error=error)


def extend_input_error(moments: Moments, known: Moments) -> Moments:
    """Return moments with input bounds of every order: the bound of the `known` total times powers
    of the reach.
    """
    swept, further = known.input_error[:2].tolist()
    reach = further / swept if swept > 0.0 else 0.0
    return replace(moments, input_error=swept * reach ** monomials(moments.order).sum(axis=1))


def sum_of_instances(reading: Reading, unit: float, shell: bool, threads: int) -> MeshBody:
    """Return the sum of all parts, each measured once in its own coordinates, and mapped to its
    places.
    """
    volumes = []
    areas = []
    healths = []
    procedures = []
    by_part = []
    parts = []
    drawn = drawn_names(reading)

    def measured_area(surface: mesh.Surface) -> Moments:
        return polyhedron.polyhedron_moments(
            surface, area_order=3, threads=threads, allow_open=True
        )[1]

    measured = measured_area if shell else None
    surfaces = [part.surface for part in reading.parts]
    measure = partial(measure_stack, shell=True) if shell else measure_again
    stack = measure(surfaces, threads=threads)
    for i, part in enumerate(reading.parts):
        solid = stack[i]
        matrices = to_si(part.matrices, unit)
        volumes.append(sum_of_images(solid.volume, matrices))
        image_areas = list(area_of_instances(solid.given_surface, solid.area, matrices, measured))
        areas.extend(image_areas)
        total = float(solid.volume.raw[0])
        stretch = float(volumes[-1].raw[0]) / total if total else 0.0  # Σ |det|
        health = replace(solid.health, volume_spread=solid.health.volume_spread * stretch)
        healths.append(
            (health, len(matrices), sum([float(moments.raw[0]) for moments in image_areas]))
        )
        flat = not shell and not solid.volume.raw.any()
        procedures.append(None if flat else Procedure(solid.method))
        if shell:  # A sheet is not repaired.
            copies = solid.health.defective_elements.duplicate_faces
            remarks = [_copies_of_shell(part.surface, copies)] if len(copies) else []
        else:
            remarks = [] if flat else of_drawn(solid.findings, [part], drawn)
        by_part.append((part.source_object_name, remarks))
        parts.append((solid, matrices))
    findings = findings_by_part(by_part, reading.name)
    health = merge_health(healths)
    if not shell and instances_overlap(reading):
        if (
            sum(part.surface.triangle_count * len(part.matrices) for part in reading.parts)
            <= MAX_COMPARED_TRIANGLES
        ):
            comparison = compare_places(parts)
            findings += overlap_findings(reading, [solid for solid, _ in parts], comparison)
            nested, overlapping = (
                len(pairs) for pairs in (comparison.nested, comparison.overlapping)
            )
            health = replace(
                health,
                nested_components=health.nested_components + nested,
                overlapping_components=health.overlapping_components + overlapping,
            )
        else:
            findings.append(finding(UNCHECKED, subject=OVERLAP_OF_INSTANCES))
    of_solids = [procedure for procedure in procedures if procedure]
    if of_solids and len(of_solids) < len(procedures):
        flat_area = sum(
            [area for (_, _, area), procedure in zip(healths, procedures) if procedure is None]
        )
        slight = flat_area * unit * instances_size(reading) < NEGLIGIBLE * float(
            sum_moments(volumes).total
        )
        findings.append(
            finding(
                FLAT_SURFACES, slight=slight, count=procedures.count(None), total=len(procedures)
            )
        )
    return MeshBody(
        sum_moments(volumes),
        sum_moments(areas),
        health,
        Method(least_trusted(of_solids)),
        tuple(findings),
        face_count=sum([solid.face_count for solid, _ in parts]),
        solids=tuple(parts),
        threads=threads,
    )


def _copies_of_shell(surface: mesh.Surface, copies: Integers) -> Finding:
    triangles, faces = surface.all_triangles()
    area = np.linalg.norm(mesh.normals(surface.points.astype(np.float64), triangles), axis=1)
    slight = bool(area[np.isin(faces, copies)].sum() < NEGLIGIBLE * area.sum())
    return finding(DUPLICATE_FACES_COUNTED, copies, slight=slight, count=len(copies))


def drawn_names(reading: Reading) -> set[str]:
    """Return the names of the objects with round shapes that Blender draws as polygons."""
    results = [result for result in reading.findings if result.code == DRAWN_AS_POLYGONS]
    return {name for result in results for name in result.values.get("sources", ["", reading.name])}


def of_drawn(findings: Iterable[Finding], parts: Iterable[Part], drawn: set[str]) -> list[Finding]:
    """Return the findings; if all parts are drawn round shapes, non-planar faces are ascribed to
    the display mesh.
    """
    if not drawn.issuperset([part.source_object_name for part in parts]):
        return list(findings)
    of_display_mesh = NON_PLANAR_FACES_OF_DISPLAY_MESH
    return [
        replace(result, code=of_display_mesh) if result.code == NON_PLANAR_FACES else result
        for result in findings
    ]
