# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mass moments of a body whose density is not one number: by material, by polynomial, by vertex.

Each surface is weighed once in its own coordinates and mapped to its places, as `mesh_body` does with volumes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...core.density.part_densities import PartDensities, part_densities
from ...core.density.piecewise_mass import as_mass, weighted_sheet, weighted_solid
from ...core.mesh.surface import Surface
from ...core.moments.affine_maps import distinct_linear
from ...core.moments.moments import Moments, are_similarities, map_sum, sum_moments
from ...core.polyhedron import polyhedron_moments
from ...core.solid.measure_solid import SolidMeasure
from ...core.solid.parts import Components
from ...core.verdict.messages import listed
from ..read import Reading
from ..settings.density import DensityField, material_density
from . import polynomial_mass as weigh_polynomial
from .body import Body
from .instances import in_metres, mapped_areas

MOST_NAMED = 8
LARGEST = 1e100  # kg m^n whose squares are still numbers
CAVITY = "A cavity takes away the material that it is cut from, whatever its own faces have."


@dataclass
class Weighed:
    """mass: moments in kg, SI units and world axes. source: where the density came from, as a text. warnings: what was
    decided. materials: full names of those that were met, with a density or without."""

    mass: Moments
    source: str
    warnings: list[str] = field(default_factory=list)
    materials: tuple[str, ...] = ()


def weigh(
    reading: Reading,
    body: Body,
    density: DensityField,
    *,
    unit: float,
    shell: bool,
    thickness: float,
    others: float,
    threads: int = 1,
) -> Weighed:
    """The mass of a body that `mesh_body` measured.

    unit: metres per Blender unit; thickness: of a shell, m; others: kg/m³ of faces whose material has no density.
    ValueError, with what to do, where the density is missing or negative somewhere.
    """
    if not body.solids or (density.kind != "polynomial" and any(part.painted is None for part in reading.parts)):
        raise ValueError("Only what polygons bound can have a density that is not one value; set one value.")
    factor = thickness if shell else 1.0
    if density.kind == "polynomial":
        parts, warnings = weigh_polynomial.weigh(reading, body, density, unit=unit, shell=shell, threads=threads)
        source = "polynomial {:s}, in {:s} coordinates".format(density.text, "world" if density.in_world else "own")
        mass = sum_moments(parts) * factor
        if not np.abs(mass.raw).max() < LARGEST:
            raise ValueError("Its density makes its mass too large a number; give it a smaller one.")
        return Weighed(mass, source, warnings)
    if density.kind == "attribute":
        if not shell:
            raise ValueError(
                "A vertex attribute is a density on the surface, not inside it; measure it as a shell, or "
                "choose another source of density."
            )
        parts = [
            _sheets(reading, i, _vertex_density(reading, i, density.attribute), unit, threads, by_vertex=True)
            for i in range(len(reading.parts))
        ]
        source = "vertex attribute “{:s}”".format(density.attribute)
        return Weighed(as_mass(sum_moments([one for part in parts for one in part]), factor), source)
    return _by_material(reading, body, unit, shell, factor, others, threads)


def _by_material(
    reading: Reading, body: Body, unit: float, shell: bool, factor: float, others: float, threads: int
) -> Weighed:
    if body.method == "union":
        raise ValueError(
            "United shells have no faces of their own to take materials from; count each shell, or set one density."
        )
    painted = _Painted(reading, others)
    parts: list[Moments] = []
    told: list[str] = []
    mixed = False
    if shell:
        for i, values in enumerate(painted.values):
            parts.extend(_sheets(reading, i, values, unit, threads))
    else:
        for (solid, matrices), (values, names) in zip(body.solids, painted.for_solids(body)):
            weighed, own, by_area = _solids(solid, matrices, values, names)
            parts += weighed
            told += [one for one in own if one not in told]
            mixed = mixed or by_area
    warnings = [*painted.missing(), *told]
    health = body.health
    if not shell and health.nested_components + health.overlapping_components and painted.several:
        warnings.append("Where parts lie in or through one another their densities add up; cut a cavity for an insert.")
    return Weighed(as_mass(sum_moments(parts), factor), painted.source(mixed), warnings, painted.names)


class _Painted:
    """The densities of all faces of a reading. values: for each part (f,) of its mesh faces."""

    def __init__(self, reading: Reading, others: float):
        self.reading, self.others = reading, others
        self.values: list[NDArray] = []
        self.slots: list[tuple[NDArray, tuple]] = []
        met: dict[object, None] = {}
        self.lacking = self.faces = 0
        for part in reading.parts:
            slots, faces = part.painted.materials, part.painted.faces
            known = [material_density(material) for material in slots]
            table = np.array([*(others if one is None else one for one in known), others], float)  # -1 is the last
            lacks = np.array([*(one is None for one in known), True])
            self.values.append(table[faces])
            self.slots.append((faces, slots))
            self.lacking += int(lacks[faces].sum()) * len(part.matrices)
            self.faces += len(faces) * len(part.matrices)
            met |= dict.fromkeys(slots[i] for i in np.unique(faces).tolist() if i >= 0 and slots[i] is not None)
        self.met = sorted(met, key=lambda material: material.name_full)
        if self.lacking and not others > 0.0:
            raise ValueError(
                "{:s} no material with a density, and its own density is zero; give it one.".format(
                    "It has" if self.lacking == self.faces else "Some of its faces have"
                )
            )

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(material.name_full for material in self.met)

    @property
    def several(self) -> bool:
        return len({value for values in self.values for value in np.unique(values).tolist()}) > 1

    def missing(self) -> Iterator[str]:
        """A sentence about faces that take the object's density."""
        if not self.lacking:
            return
        names = [material.name for material in self.met if material_density(material) is None]
        yield "{:s} no material with a density and {:s} the object's {:.7g} kg/m³{:s}.".format(
            "It has"
            if self.lacking == self.faces
            else "{:d} of its {:d} faces have".format(self.lacking, self.faces)
            if self.lacking > 1
            else "One of its {:d} faces has".format(self.faces),
            "takes" if self.lacking in (1, self.faces) else "take",
            self.others,
            " ({:s})".format(_listing(["“{:s}” has none".format(name) for name in names])) if names else "",
        )

    def source(self, weighted: bool) -> str:
        known = [(one.name, material_density(one)) for one in self.met]
        text = _listing(["{:s} {:.7g} kg/m³".format(name, value) for name, value in known if value is not None])
        parts = ["materials"] if not text else ["materials: " + text]
        if self.lacking:
            parts.append("others {:.7g} kg/m³".format(self.others))
        if weighted:
            parts.append("mixed parts by area")
        return "; ".join(parts)

    def for_solids(self, body: Body) -> Iterator[tuple[NDArray, list[str] | None]]:
        """The densities and the material's names of the faces of each measured surface; of one that joins all places,
        those of each place in turn, without names."""
        if not is_joined(self.reading, body):
            for values, (faces, slots) in zip(self.values, self.slots):
                names = np.array([*(one.name if one else "none" for one in slots), "none"], object)
                yield values, names[faces].tolist()
            return
        rows = []
        for part, values in zip(self.reading.parts, self.values):
            used = values[: part.surface.all_triangles()[1].max() + 1]
            rows += [used] * len(part.matrices)
        yield np.concatenate(rows), None


def is_joined(reading: Reading, body: Body) -> bool:
    """Whether the body was measured as one surface though it stands in several places."""
    return sum(len(matrices) for _, matrices in body.solids) != reading.places


def _solids(
    solid: SolidMeasure, matrices: NDArray, values: NDArray, names: list[str] | None
) -> tuple[list[Moments], list[str], bool]:
    """∫ρ dV of a surface's places, sentences about its parts, and whether any takes a mean by area. values, names: of
    its mesh faces."""
    components = solid.components()
    moments, told = [], []
    mixed = bool(part_densities(components, values).mixed.any())
    for places in _alike(matrices) if mixed else [matrices]:  # a mean by area is that of the areas as they are seen
        found = part_densities(components, values, places[0, :3, :3])
        density = found.density[components.part]
        moments.append(map_sum(weighted_solid(components.points, components.triangles, density, solid.volume), places))
        told += _mixed(components, found, names)
    return moments, [*told, *([CAVITY] if found.painted.any() else [])], mixed


def _alike(matrices: NDArray) -> Iterator[NDArray]:
    """The (k, 4, 4) maps in groups that stretch areas alike: similarities together, then each uneven map's places."""
    even = are_similarities(matrices[:, :3, :3])
    if even.any():
        yield matrices[even]
    rest = matrices[~even]
    for _, own in distinct_linear(rest):
        yield rest[own]


def _mixed(parts: Components, found: PartDensities, names: list[str] | None) -> list[str]:
    """A sentence about parts whose faces have several materials."""
    which = np.flatnonzero(found.mixed)
    if not len(which):
        return []
    if len(which) > 1:
        faces = ": those with faces {:s}".format(listed(np.sort(found.first[which]))) if names else ""
        return [
            "{:d} of its {:d} parts have several materials and take their means by area{:s}.".format(
                len(which), parts.number, faces
            )
        ]
    one = int(which[0])
    own = np.unique(parts.face[(parts.part == one) & (parts.face >= 0)])
    told = " ({:s})".format(_listing(sorted({names[i] for i in own.tolist()}))) if names else ""
    where = (
        "It has"
        if parts.number == 1
        else "One of its parts has"
        if not names
        else ("The part with face {:d} has".format(int(found.first[one])))
    )
    return [
        "{:s} several materials{:s} and takes their mean by area, {:.7g} kg/m³.".format(where, told, found.density[one])
    ]


def _listing(texts: list[str]) -> str:
    return ", ".join(texts[:MOST_NAMED] + ["…"] * (len(texts) > MOST_NAMED))


def _vertex_density(reading: Reading, i: int, name: str) -> NDArray[np.float64]:
    """(n,) checked values of a part's vertices; those that no face uses do not count."""
    part = reading.parts[i]
    used = np.unique(part.surface.all_triangles()[0])
    values = part.painted.vertices
    for wrong, told in ((~np.isfinite(values[used]), "not finite"), (values[used] < 0.0, "negative")):
        if wrong.any():
            raise ValueError(
                "Its attribute “{:s}” is {:s} at {:d} of its vertices: {:s}; give them a density.".format(
                    name, told, int(wrong.sum()), listed(used[wrong])
                )
            )
    return values


def _sheets(
    reading: Reading, i: int, values: NDArray, unit: float, threads: int, by_vertex: bool = False
) -> Iterator[Moments]:
    """∫ρ dA of a part's images. values: of its mesh faces, or of its vertices and linear between them."""
    part = reading.parts[i]

    def measured(surface: Surface) -> Moments:
        triangles, faces = surface.all_triangles()
        density = values[triangles] if by_vertex else values[faces]
        area = polyhedron_moments(surface, area_order=3, threads=threads)[1]
        return weighted_sheet(surface.points, triangles, density, area, stored=by_vertex)

    return mapped_areas(part.surface, measured(part.surface), in_metres(part.matrices, unit), measured)
