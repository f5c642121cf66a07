# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies bounded by polygons, with all their instances: each surface is measured once and mapped to
its places.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar, NamedTuple

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
from ..verdict import NEGLIGIBLE, Finding, MeshHealth, Method, Procedure, finding, least_trusted
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
        volumes = []
        areas = []
        # Up to third order the area costs nothing, and makes the bounds of the volume smaller.
        least_area_order = 0 if order <= 3 else None

        def measured(surface: mesh.Surface) -> Moments:
            return polyhedron.polyhedron_moments(
                surface, order, area_order=order, exact=True, threads=self.threads, allow_open=True
            )[1]

        for solid, matrices in self.solids:
            surface = solid.given_surface
            # Otherwise, the repair has removed or added faces, and the area is measured alone.
            has_same_faces = (
                solid.method in (Procedure.EXACT, Procedure.REORIENTED)
                and not solid.health.duplicate_faces
                and solid.repaired_surface.triangle_count == surface.triangle_count
            )
            volume, faces = polyhedron.polyhedron_moments(
                solid.repaired_surface,
                order,
                area_order=order if area and has_same_faces else least_area_order,
                about=solid.volume.about,  # an open surface's moments depend on it
                exact=True,
                threads=self.threads,
                allow_open=True,
            )
            volumes.append(sum_of_images(volume, matrices))
            if area:
                of_faces = faces if has_same_faces and faces is not None else measured(surface)
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
    error = moments.input_error.copy()  # begins with the orders of `known`
    error[: len(known.raw)] = np.minimum(error[: len(known.raw)], known.input_error)
    return replace(moments, input_error=error)


def extend_input_error(moments: Moments, known: Moments) -> Moments:
    """Return moments with input bounds of every order: the bound of the `known` total times powers
    of the reach.

    The reach is the bound of the first moment along x by that of the total.
    """
    total_error, first_error = known.input_error[:2].tolist()
    reach = first_error / total_error if total_error > 0.0 else 0.0
    return replace(moments, input_error=total_error * reach ** monomials(moments.order).sum(axis=1))


def sum_of_instances(reading: Reading, unit: float, shell: bool, threads: int) -> MeshBody:
    """Return the sum of all parts, each measured once in its own coordinates, and mapped to its
    places.
    """
    measure = partial(measure_stack, shell=True) if shell else measure_again
    stack = measure([part.surface for part in reading.parts], threads=threads)
    drawn = drawn_names(reading)
    images = [
        _measure_part(part, stack[i], unit, shell, threads, drawn)
        for i, part in enumerate(reading.parts)
    ]
    volume = sum_moments([image.volume for image in images])
    health = merge_health((image.health, len(image.matrices), image.area) for image in images)
    findings = findings_by_part(
        [(part.source_object_name, image.findings) for part, image in zip(reading.parts, images)],
        reading.name,
    )
    solids = tuple((image.solid, image.matrices) for image in images)
    if not shell and instances_overlap(reading):
        count = sum(part.surface.triangle_count * len(part.matrices) for part in reading.parts)
        if count <= MAX_COMPARED_TRIANGLES:
            comparison = compare_places(solids)
            findings += overlap_findings(reading, [solid for solid, _ in solids], comparison)
            health = replace(
                health,
                nested_components=health.nested_components + len(comparison.nested),
                overlapping_components=health.overlapping_components + len(comparison.overlapping),
            )
        else:
            findings.append(finding(UNCHECKED, subject=OVERLAP_OF_INSTANCES))
    flat = [image for image in images if image.is_flat]
    if 0 < len(flat) < len(images):
        flat_area = sum([image.area for image in flat])
        negligible = NEGLIGIBLE * float(volume.total)
        slight = flat_area * unit * instances_size(reading) < negligible
        findings.append(finding(FLAT_SURFACES, slight=slight, count=len(flat), total=len(images)))
    return MeshBody(
        volume,
        sum_moments([moments for image in images for moments in image.area_moments]),
        health,
        Method(
            least_trusted([Procedure(image.solid.method) for image in images if not image.is_flat])
        ),
        tuple(findings),
        face_count=sum([image.solid.face_count for image in images]),
        solids=solids,
        threads=threads,
    )


class _PartImages(NamedTuple):
    """A measured surface in all its places, in SI units.

    matrices: (k, 4, 4) maps to its places. area_moments: one or several, to be added; area: their
    total. is_flat: True for a solid without volume.
    """

    solid: SolidIntegrals
    matrices: Array
    volume: Moments
    area_moments: list[Moments]
    area: float
    health: MeshHealth
    is_flat: bool
    findings: list[Finding]


def _measure_part(
    part: Part, solid: SolidIntegrals, unit: float, shell: bool, threads: int, drawn: set[str]
) -> _PartImages:
    """Return the images of a measured part. drawn: as `drawn_names` returns."""

    def measured(surface: mesh.Surface) -> Moments:
        return polyhedron.polyhedron_moments(
            surface, area_order=3, threads=threads, allow_open=True
        )[1]

    matrices = to_si(part.matrices, unit)
    volume = sum_of_images(solid.volume, matrices)
    area_moments = list(
        area_of_instances(solid.given_surface, solid.area, matrices, measured if shell else None)
    )
    own_volume = float(solid.volume.raw[0])
    stretch = float(volume.raw[0]) / own_volume if own_volume else 0.0  # Σ |det|
    health = replace(solid.health, volume_spread=solid.health.volume_spread * stretch)
    is_flat = not shell and not solid.volume.raw.any()
    findings = []
    if shell:  # A sheet is not repaired.
        copies = solid.health.defective_elements.duplicate_faces
        if len(copies):
            findings.append(_copies_of_shell(part.surface, copies))
    elif not is_flat:
        findings = of_drawn(solid.findings, [part], drawn)
    area = sum([float(moments.raw[0]) for moments in area_moments])
    return _PartImages(solid, matrices, volume, area_moments, area, health, is_flat, findings)


def _copies_of_shell(surface: mesh.Surface, copies: Integers) -> Finding:
    """Return the finding about faces of a sheet that are there twice. copies: their indices."""
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
