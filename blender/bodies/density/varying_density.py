# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass moments of a body of varying density, from materials, a polynomial, a vertex attribute
or a Volume object.

Each surface is weighed once in its own coordinates, and its moments are mapped to its places.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....core import bodies, measurement, mesh, polyhedron
from ....core.density import (
    PartDensities,
    part_densities,
    sheet_mass_moments,
    solid_mass_moments,
    to_mass_moments,
)
from ....core.moments import KNOWN_ORDER, Moments, similarity_groups, sum_moments, sum_of_images
from ....core.numerics import Array, NDArray
from ....core.solid import ClosedParts, SolidIntegrals
from ....core.verdict import NEGLIGIBLE, Finding, Procedure, ReadError, finding, truncate_findings
from ...settings.density import DensityField, density_key, material_density
from ...settings.findings import OBJECT_DENSITY_USED
from ..findings import (
    ATTRIBUTE_VALUES,
    CAVITY_MATERIAL_IGNORED,
    DENSITY_ATTRIBUTE_OF_SOLID,
    DENSITY_FROM_ATTRIBUTE,
    DENSITY_FROM_MATERIALS,
    DENSITY_OF_MATERIAL,
    DENSITY_OF_OTHERS,
    MATERIAL_WITHOUT_DENSITY,
    MIXED_MATERIALS,
    OVERLAPPING_DENSITIES,
    UNION_LACKS,
)
from ..request import Request
from .fields import filled_by_volume, polynomial_mass_result

MAX_NAMED = 8  # materials in the note on the source of the density


@dataclass(frozen=True, eq=False)
class _Weighed:
    """Mass of a part or body.

    mass: moments in kg, SI units and world axes. source: a note on the source of the density.
    findings: about the decisions. materials: full names of all materials met, with a density or
    without.
    """

    mass: Moments
    source: Finding
    findings: Sequence[Finding] = ()
    materials: tuple[str, ...] = ()


def weigh(reading: bodies.Reading, body: bodies.MeshBody, request: Request) -> bodies.MeshBody:
    """Return the body with mass moments to the requested order, or raise MeasureError if a density
    is impossible.
    """
    # `find_extent` raises MeasureError without a volume or area, before anything is weighed.
    measurement.find_extent(body, request.settings)
    order = request.settings.order or 0
    needs_higher = order > KNOWN_ORDER
    if _field(request).kind == "volume":
        if request.settings.kind == "shell":
            raise ReadError(bodies.GRID_AS_SHELL)
        filled = filled_by_volume(body, request, KNOWN_ORDER)
        return replace(
            filled,
            higher_mass=filled_by_volume(body, request, order).mass if needs_higher else None,
            density_key=density_key(request.obj, (), request.scene),
        )
    weighed = _weigh(reading, body, request, KNOWN_ORDER)
    return replace(
        body,
        mass=weighed.mass,
        higher_mass=_weigh(reading, body, request, order).mass if needs_higher else None,
        density_from=weighed.source,
        density_key=density_key(request.obj, weighed.materials, request.scene),
        materials=weighed.materials,
        findings=(*body.findings, *weighed.findings),
    )


def _weigh(
    reading: bodies.Reading, body: bodies.MeshBody, request: Request, order: int
) -> _Weighed:
    kind = _field(request).kind
    if kind == "polynomial":
        return _by_polynomial(reading, body, request, order)
    if kind == "attribute":
        return _by_attribute(reading, request, order)
    return _by_material(reading, body, request, order)


def _field(request: Request) -> DensityField:
    """Return the density of the requested body, which must not be uniform, as a function of place
    or face.
    """
    assert request.density is not None
    return request.density


def _thickness(request: Request) -> float:
    """Return the factor of a body's area moments: the thickness of a shell, in m; 1 for solids."""
    return request.settings.thickness if request.settings.kind == "shell" else 1.0


def _by_polynomial(
    reading: bodies.Reading, body: bodies.MeshBody, request: Request, order: int
) -> _Weighed:
    density = _field(request)
    parts, findings = polynomial_mass_result(reading, body, density, request.settings, order)
    mass = sum_moments(parts) * _thickness(request)
    if not np.abs(mass.raw).max() < bodies.MAX_MASS_MOMENT:
        raise ReadError(bodies.MASS_OVERFLOW)
    return _Weighed(mass, density.polynomial_source(), findings)


def _by_attribute(reading: bodies.Reading, request: Request, order: int) -> _Weighed:
    attribute = _field(request).attribute or ""
    if request.settings.kind != "shell":
        raise ReadError(DENSITY_ATTRIBUTE_OF_SOLID)
    parts = [
        _sheet_moments(
            reading, i, _vertex_density(reading, i, attribute), request, order, by_vertex=True
        )
        for i in range(len(reading.parts))
    ]
    source = finding(DENSITY_FROM_ATTRIBUTE, attribute=attribute)
    total = sum_moments([moments for part in parts for moments in part])
    return _Weighed(to_mass_moments(total, _thickness(request)), source)


def _by_material(
    reading: bodies.Reading, body: bodies.MeshBody, request: Request, order: int
) -> _Weighed:
    shell = request.settings.kind == "shell"
    if body.method.procedure == Procedure.UNION:
        raise ReadError(UNION_LACKS, data="materials")
    face_densities = _FaceDensities(reading, request.settings.density or 0.0)
    parts: list[Moments] = []
    by_part: list[tuple[str, list[Finding]]] = []
    if shell:
        for i, values in enumerate(face_densities.values):
            parts.extend(_sheet_moments(reading, i, values, request, order))
    else:
        for i, (solid, matrices) in enumerate(body.solids):
            volume = _volume_moments(solid, order, request.settings.threads)
            moments, findings = _solid_moments(
                solid, volume, matrices, face_densities.values[i], face_densities.face_names(i)
            )
            parts += moments
            by_part.append((reading.parts[i].source_object_name, findings))
    findings = [*face_densities.missing_note(), *bodies.findings_by_part(by_part, reading.name)]
    health = body.health
    densities = np.concatenate(face_densities.values)
    if not shell and health.nested_components + health.overlapping_components and np.ptp(densities):
        findings.append(finding(OVERLAPPING_DENSITIES))
    return _Weighed(
        to_mass_moments(sum_moments(parts), _thickness(request)),
        face_densities.source(),
        findings,
        face_densities.names,
    )


def _volume_moments(solid: SolidIntegrals, order: int, threads: int) -> Moments:
    """Return the moments of a solid to an order, beyond the measured ones if necessary."""
    volume = solid.volume
    if order <= volume.order:
        return volume
    return polyhedron.polyhedron_moments(
        solid.repaired_surface, order, about=volume.about, threads=threads, allow_open=True
    )[0]


class _FaceDensities:
    """The densities of all faces of a reading.

    `values`: (f,) densities of the mesh faces of each part. `slots`: for each part the (f,) slots
    of its faces, -1 without a material, and the materials in the slots. `materials`: of all faces,
    sorted by name. `faces`, `faces_without_density`: counts over all places of the parts.
    """

    def __init__(self, reading: bodies.Reading, default_density: float):
        self.default_density = default_density
        self.values: list[NDArray] = []
        self.slots: list[tuple[NDArray, tuple]] = []
        self.faces_without_density = self.faces = 0
        used: dict[Any, None] = {}
        for part in reading.parts:
            slots = part.attributes.materials
            face_slots = part.attributes.face_slots
            # The slot -1, for no material, takes the last entry.
            densities = [*(material_density(material) for material in slots), None]
            lacks_density = np.array([density is None for density in densities])
            density_of_slot = np.array(
                [default_density if density is None else density for density in densities], float
            )
            self.values.append(density_of_slot[face_slots])
            self.slots.append((face_slots, slots))
            instance_count = len(part.matrices)
            self.faces_without_density += int(lacks_density[face_slots].sum()) * instance_count
            self.faces += len(face_slots) * instance_count
            for i in np.unique(face_slots).tolist():
                if i >= 0 and slots[i] is not None:
                    used[slots[i]] = None
        self.materials = sorted(used, key=lambda material: material.name_full)
        if self.faces_without_density and not default_density > 0.0:
            raise ReadError(
                MATERIAL_WITHOUT_DENSITY, count=self.faces_without_density, total=self.faces
            )

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(material.name_full for material in self.materials)

    def face_names(self, i: int) -> NDArray:
        """Return the (f,) names of the materials of a part's faces, "" without a material."""
        face_slots, slots = self.slots[i]
        names = [*(material.name if material else "" for material in slots), ""]
        return np.array(names, object)[face_slots]  # slot -1 takes the last name

    def missing_note(self) -> Iterator[Finding]:
        """Yield a finding about faces without a material density, which have the object's
        density.
        """
        if not self.faces_without_density:
            return
        names = [material.name for material in self.materials if material_density(material) is None]
        yield finding(
            OBJECT_DENSITY_USED,
            count=self.faces_without_density,
            total=self.faces,
            density=self.default_density,
            materials=names or "none",
        )

    def source(self) -> Finding:
        """Return a note that names at most MAX_NAMED materials with their densities."""
        densities = [(material.name, material_density(material)) for material in self.materials]
        parts = [
            finding(DENSITY_OF_MATERIAL, material=name, density=density)
            for name, density in densities
            if density is not None
        ]
        parts = truncate_findings(parts, MAX_NAMED)
        if self.faces_without_density:
            parts.append(finding(DENSITY_OF_OTHERS, density=self.default_density))
        return finding(DENSITY_FROM_MATERIALS, materials=[part.as_record() for part in parts])


def _solid_moments(
    solid: SolidIntegrals, volume: Moments, matrices: NDArray, values: NDArray, names: NDArray
) -> tuple[list[Moments], list[Finding]]:
    """Return the moments ∫ρ dV of a surface's images by the densities of its faces, and findings
    about components.
    """
    components = solid.parts()
    moments, findings = [], []
    has_foreign_material = is_slight = False
    matrix_groups = [matrices]
    if part_densities(components, values).has_several_materials.any():
        # The mean density by area needs the areas after the map.
        matrix_groups = [matrices[places] for places, _ in similarity_groups(matrices)]
    for group in matrix_groups:
        part_density = part_densities(components, values, group[0, :3, :3])
        density = part_density.density[components.part]
        mass = solid_mass_moments(components.points, components.triangles, density, volume)
        moments.append(sum_of_images(mass, group))
        diagonal = float(np.linalg.norm(np.ptp(components.points, axis=0)))
        # In kg/m, like a density times an area: a share of the mass by the body's length.
        negligible = NEGLIGIBLE * float(mass.total) / diagonal
        findings += _mixed_parts_notes(components, part_density, names, negligible)
        foreign = part_density.has_foreign_cavity_material
        # The finding is the same for all groups, of which the last one decides if it is slight.
        has_foreign_material = bool(foreign.any())
        is_slight = bool(part_density.most_by_area[foreign].sum() < negligible)
    if has_foreign_material:
        findings.append(finding(CAVITY_MATERIAL_IGNORED, slight=is_slight))
    return moments, findings


def _mixed_parts_notes(
    parts: ClosedParts, part_density: PartDensities, names: NDArray, negligible: float
) -> list[Finding]:
    """Return a finding about components of several materials, with the first face of each."""
    mixed = np.flatnonzero(part_density.has_several_materials)
    if not len(mixed):
        return []
    first_faces = np.sort(part_density.first_face[mixed])
    is_slight = bool(part_density.range_by_area[mixed].sum() < negligible)
    is_of_mixed = np.isin(parts.part, mixed) & (parts.face >= 0)  # caps have no face
    materials = set(names[parts.face[is_of_mixed]].tolist())
    return [
        finding(
            MIXED_MATERIALS,
            first_faces,
            slight=is_slight,
            count=len(mixed),
            total=parts.number,
            materials=sorted(materials),
        )
    ]


def _vertex_density(reading: bodies.Reading, i: int, name: str) -> Array:
    """Return (n,) densities of a part's vertices; raise ReadError if a vertex with faces has a
    wrong value.
    """
    part = reading.parts[i]
    values = part.attributes.vertex_values
    used = np.unique(part.surface.all_triangles()[0])
    wrong = ~((values[used] >= 0.0) & (values[used] < np.inf))
    if wrong.any():
        result = finding(ATTRIBUTE_VALUES, used[wrong], attribute=name, count=int(wrong.sum()))
        raise ReadError(bodies.attribute_to_source(result, part.source_object_name, reading.name))
    return values


def _sheet_moments(
    reading: bodies.Reading,
    i: int,
    values: NDArray,
    request: Request,
    order: int,
    by_vertex: bool = False,
) -> Iterator[Moments]:
    """Yield moments ∫ρ dA of a part's images; `values` are densities of mesh faces, or with
    `by_vertex` of vertices.
    """
    part = reading.parts[i]

    def measured(surface: mesh.Surface) -> Moments:
        """Return the moments ∫ρ dA of the part's surface or of its image under an uneven map."""
        triangles, faces = surface.all_triangles()
        density = values[triangles] if by_vertex else values[faces]
        area = polyhedron.polyhedron_moments(
            surface, area_order=order, threads=request.settings.threads, allow_open=True
        )[1]
        return sheet_mass_moments(surface.points, triangles, density, area, stored=by_vertex)

    return bodies.area_of_instances(
        part.surface,
        measured(part.surface),
        bodies.to_si(part.matrices, request.settings.unit),
        measured,
    )
