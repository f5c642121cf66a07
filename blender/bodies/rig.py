# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a skinned character's bones, in rest pose: skinned geometry and parented objects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from bpy.types import Context, Depsgraph, Object

from ...core import bodies, polyhedron
from ...core.measurement import (
    DENSITY_FROM,
    DENSITY_FROM_MASS,
    DENSITY_FROM_VALUE,
    NO_VOLUME,
    ZERO_QUANTITY,
    Extent,
    Measurement,
    add_extents,
    digest,
    extent_of,
    fingerprint,
    measure_total,
)
from ...core.mesh import Surface
from ...core.moments import KNOWN_ORDER, Measure, Moments, are_similarities, sum_moments
from ...core.numerics import Array, Integers, NDArray, shortest_decimal
from ...core.rig import bone_pieces, bones_of_caps, dominant_bones
from ...core.solid import measure_solid
from ...core.verdict import (
    Finding,
    MeasureError,
    Method,
    Procedure,
    ReadError,
    finding,
    internal_error,
    least_trusted,
)
from ..read.bones import RestBones, vertex_weights
from ..read.fingerprint import matrix_hash
from ..read.objects import locate, read_object
from ..read.rig import hanging_objects, rest_pose, rig_hash, rig_objects, skinned_objects
from ..settings.density import is_density_unset, unset_density
from ..settings.options import AS_SET, MeasureOptions
from .findings import (
    BONE_MISSING,
    BONE_PART_IMPOSSIBLE,
    BONE_PARTS_IMPOSSIBLE,
    MEMBERS_DENSITY_UNSET,
    MEMBERS_LEFT_OUT,
    MEMBERS_NOT_MEASURED,
    RIG_MEAN_DENSITY,
    RIG_WALL_THIN,
    RIG_WITHOUT_PARTS,
    UNWEIGHTED_VERTICES,
)
from .measure_body import measure_body
from .measure_object import measure_object
from .request import Request

DENSITIES_FROM = {
    "MESH": finding(DENSITY_FROM, source="members"),
    "DENSITY": DENSITY_FROM_VALUE,
    "MASS": DENSITY_FROM_MASS,
}


@dataclass(eq=False)
class _Sum:
    """The moments and source objects of a bone's part.

    carriers: mass moments at 1 kg/m³ of geometry skinned to the bone, each with its density.
    hanging: mass moments of objects parented to the bone. extents, areas: (value, rounding, effect
    of float32), m³ and m².
    """

    carriers: list[tuple[Moments, float]] = field(default_factory=list)
    hanging: list[Moments] = field(default_factory=list)
    extents: list[Extent] = field(default_factory=list)
    areas: list[Extent] = field(default_factory=list)
    procedures: list[Procedure] = field(default_factory=list)
    surfaces: list[tuple[Surface, Array]] = field(default_factory=list)
    sources: dict[str, None] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class BonePart:
    """The part of one bone at rest, in SI units along the world's axes.

    `name`: of the bone. `mass`: kg, to third order. `sources`: names of the objects that the part
    is made of. `measurement`: in place of an object's frame it has the bone's rest frame; None if
    `refusal` says that no body has such moments. `surfaces`: closed pieces of solids and sheets of
    shells, each with the (4, 4) map to the world, m.
    """

    name: str
    mass: Moments
    measurement: Measurement | None
    refusal: Finding | None
    surfaces: tuple[tuple[Surface, Array], ...]
    sources: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Rig:
    """The parts of a character's bones, in the order of the armature, and their measurement as one
    body at rest.
    """

    armature: Object
    parts: tuple[BonePart, ...]
    measurement: Measurement
    objects: tuple[Object, ...]


def measure_rig(context: Context, armature: Object, options: MeasureOptions = AS_SET) -> Rig:
    """Measure the parts of all bones of a character, or raise MeasureError if none has a mass."""
    with rest_pose(context, armature) as depsgraph:
        return _Measuring(armature, depsgraph, options).rig()


class _Measuring:
    """One measurement of a rig, with its armature at rest."""

    def __init__(self, armature: Object, depsgraph: Depsgraph, options: MeasureOptions):
        self.armature = armature
        self.depsgraph = depsgraph
        self.options = options
        self.is_given = options.density is not None or options.mass is not None
        self.unit = options.meters_per_unit(depsgraph.scene)
        self.bones = RestBones.read(armature)
        self.sums: dict[str, _Sum] = {}
        self.findings: list[Finding] = []
        self.refused: list[str] = []
        self.unset: list[str] = []
        self.objects: list[Object] = []

    def rig(self) -> Rig:
        skinned = skinned_objects(self.armature, list(self.depsgraph.view_layer.objects))
        if skinned and not self.bones.deforming:
            raise ReadError(RIG_WITHOUT_PARTS, subject=self.armature.name)
        hanging = hanging_objects(self.armature, skinned)
        unrendered = [
            obj.name for obj in (*skinned, *[obj for obj, _ in hanging]) if obj.hide_render
        ]
        if unrendered:
            self.findings.append(finding(MEMBERS_LEFT_OUT, count=len(unrendered), names=unrendered))
        for obj in skinned:
            self._try(obj, self._skin)
        for obj, bone in hanging:
            self._try(obj, lambda obj, bone=bone: self._hang(obj, bone))
        parts = tuple(
            self._part(name, self.sums[name]) for name in self.bones.names if name in self.sums
        )
        impossible = [part.name for part in parts if part.refusal is not None]
        named = {
            MEMBERS_NOT_MEASURED: self.refused,
            MEMBERS_DENSITY_UNSET: self.unset,
            BONE_PARTS_IMPOSSIBLE: impossible,
        }
        self.findings += [
            finding(code, count=len(names), names=names) for code, names in named.items() if names
        ]
        return Rig(self.armature, parts, self._total(parts), tuple(self.objects))

    def _try(self, obj: Object, measure) -> None:
        if obj.hide_render:
            return
        self.objects.append(obj)
        try:
            measure(obj)
        except Exception as error:
            internal_error.finding_of(error)
            self.refused.append(obj.name)

    def _sum_of(self, bone: str, source: Object) -> _Sum:
        found = self.sums.setdefault(bone, _Sum())
        found.sources[source.name] = None
        return found

    def _hang(self, obj: Object, bone: str) -> None:
        if bone not in self.bones.frames:
            self.findings.append(finding(BONE_MISSING, bone=bone).of_sources([obj.name]))
            return
        measured = measure_body(obj, self.depsgraph, self.options)
        measurement = measured.measurement
        moments, factor = measurement.mass_moments
        found = self._sum_of(bone, obj)
        found.hanging.append(replace(moments.truncate(KNOWN_ORDER), measure=Measure.MASS) * factor)
        found.extents.append(extent_of(measurement, "volume"))
        found.areas.append(extent_of(measurement, "area"))
        found.procedures.append(measurement.method.procedure)
        for surface in measured.body.surfaces(measurement.kind == "shell"):
            found.surfaces.append((surface, np.eye(4)))
        if not self.is_given and unset_density(obj, measurement, self.depsgraph.scene) is not None:
            self.unset.append(obj.name)

    def _skin(self, obj: Object) -> None:
        request = Request.resolve(obj, self.depsgraph, self.options)
        options = request.settings
        reading = read_object(obj, self.depsgraph)
        shell = options.kind == "shell"
        if shell and options.wall != "thin":
            self.findings.append(finding(RIG_WALL_THIN).of_sources([obj.name]))
        pieces = [piece for part in reading.parts for piece in self._pieces(obj, part, shell)]
        volume = sum(moments.total for _, moments, *_ in pieces) * (
            options.thickness if shell else 1.0
        )
        if not volume > 0.0:
            # `rig` reports the names of refused objects, without the reason
            raise ReadError(NO_VOLUME)
        density = options.density or 0.0 if options.mass is None else options.mass / volume
        if options.mass is None and request.density is not None:
            measurement = measure_object(obj, self.depsgraph, self.options)
            density = measurement.mass_properties.mass / measurement.volume
            self.findings.append(finding(RIG_MEAN_DENSITY).of_sources([obj.name]))
        if not density > 0.0:
            raise ReadError(ZERO_QUANTITY, quantity="density")
        for name, moments, area, surface, matrix, procedure in pieces:
            found = self._sum_of(name, obj)
            carrier = replace(moments.truncate(KNOWN_ORDER), measure=Measure.MASS)
            carrier = carrier * options.thickness if shell else carrier
            found.carriers.append((carrier, density))
            found.extents.append(
                (carrier.total, float(carrier.rounding_error[0]), float(carrier.input_error[0]))
            )
            found.areas.append(
                (area.total, float(area.rounding_error[0]), float(area.input_error[0]))
            )
            found.procedures.append(procedure)
            found.surfaces.append((surface, matrix))
        own = obj.body_moments
        by_value = own.mass_from == "DENSITY" and own.density_from == "VALUE"
        if by_value and not self.is_given and is_density_unset(own, self.depsgraph.scene):
            self.unset.append(obj.name)

    def _pieces(self, obj: Object, part: bodies.Part, shell: bool) -> Iterator[tuple]:
        """Yield (bone, SI world volume or area moments, area, surface, map, procedure) of each
        piece of a surface.
        """
        surface = part.surface
        if not len(surface.triangles) and not len(surface.quads):
            return
        weights = vertex_weights(obj, part, self.bones, self.depsgraph)
        triangles, face = surface.all_triangles()
        number = len(surface.points)
        # every corner of an n-gon once, though it belongs to several triangles
        corners = np.unique(np.repeat(face, 3).astype(np.int64) * number + triangles.ravel())
        pairs = np.stack([corners // number, corners % number], axis=1)
        used = np.zeros(number, bool)
        used[pairs[:, 1]] = True
        bare = weights.unweighted(number)
        bare = bare[used[bare]]
        if len(bare):
            count = int(np.count_nonzero(used))
            self.findings.append(
                finding(UNWEIGHTED_VERTICES, bare, count=len(bare), total=count).of_sources(
                    [obj.name]
                )
            )
        solid = None if shell else measure_solid(surface)
        if solid is not None:
            self.findings += [found.of_sources([obj.name]) for found in solid.findings]
        for matrix in part.matrices:
            points = surface.points.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
            bone, _ = dominant_bones(pairs[:, 0], pairs[:, 1], points, weights, self.bones.segments)
            metric = bodies.to_si(matrix[None], self.unit)[0]
            if shell:
                yield from self._sheets(surface, triangles, bone[face], metric)
                continue
            assert solid is not None
            parts = solid.parts()
            is_cap = parts.face < 0
            bones = bones_of_caps(parts.triangles, is_cap, np.where(is_cap, 0, bone[parts.face]))
            for piece in bone_pieces(
                parts.points, parts.triangles, bones, surface.coordinate_error
            ):
                sheet = replace(
                    piece.surface, triangles=piece.surface.triangles[: piece.face_count]
                )
                yield (
                    self.bones.deforming[piece.bone],
                    piece.moments().transform(metric),
                    _area(sheet, metric, 0),
                    piece.surface,
                    metric,
                    solid.method,
                )

    def _sheets(
        self,
        surface: Surface,
        triangles: NDArray,
        bones: Integers,
        metric: Array,
    ) -> Iterator[tuple]:
        for bone in np.unique(bones).tolist():
            sheet = Surface(
                surface.points,
                triangles[bones == bone].astype(np.int64),
                displacement=surface.coordinate_error,
            )
            area = _area(sheet, metric, KNOWN_ORDER)
            yield self.bones.deforming[bone], area, area, sheet, metric, Procedure.SHELL

    def _part(self, name: str, found: _Sum) -> BonePart:
        settings = self.armature.pose.bones[name].body_moments
        mass_from = "MESH" if self.is_given else settings.mass_from
        own = shortest_decimal(settings.density) if mass_from == "DENSITY" else None
        masses = [
            moments * (density if own is None else own) for moments, density in found.carriers
        ]
        mass = sum_moments([*masses, *found.hanging])
        if mass_from == "MASS" and mass.total > 0.0:
            mass = mass * (shortest_decimal(settings.mass) / mass.total)
        rotation, head = self.bones.frames[name]
        measurement = refusal = None
        try:
            measurement = measure_total(
                mass,
                name=name,
                type="BONE",
                kind="bone",
                volume=add_extents(found.extents),
                area=add_extents(found.areas),
                rotation=rotation,
                location=head * self.unit,
                fingerprint=fingerprint(mass.raw.tobytes(), "", digest(name.encode())),
                findings=(),
                method=Method(least_trusted(found.procedures)),
                density_from=DENSITIES_FROM[mass_from],
            )
        except MeasureError as error:
            refusal = finding(BONE_PART_IMPOSSIBLE, cause=error.finding.as_record())
        return BonePart(
            name, mass, measurement, refusal, tuple(found.surfaces), tuple(found.sources)
        )

    def _total(self, parts: tuple[BonePart, ...]) -> Measurement:
        armature, depsgraph = self.armature, self.depsgraph
        if not parts:
            raise ReadError(RIG_WITHOUT_PARTS, subject=armature.name)
        at = locate(armature, depsgraph)
        objects = rig_objects(armature, depsgraph.view_layer.objects)
        settings = rig_hash(armature, objects, depsgraph.scene)
        sums = [self.sums[part.name] for part in parts]
        mass = sum_moments([part.mass for part in parts])
        return measure_total(
            mass,
            name=armature.name,
            type="ARMATURE",
            kind="rig",
            volume=add_extents([add_extents(found.extents) for found in sums]),
            area=add_extents([add_extents(found.areas) for found in sums]),
            rotation=at.rotation,
            location=at.location * self.unit,
            fingerprint=fingerprint(mass.raw.tobytes(), matrix_hash(armature), settings),
            findings=tuple(self.findings),
        )


def _area(sheet: Surface, metric: Array, order: int) -> Moments:
    """Return the area moments of a sheet mapped to its place in the world."""
    if are_similarities(metric[None, :3, :3])[0]:  # the mapped points would be rounded once more
        area = polyhedron.polyhedron_moments(sheet, 0, area_order=order, allow_open=True)[1]
        return area.transform(metric)
    placed = sheet.transform(metric[:3, :3], metric[:3, 3])
    return polyhedron.polyhedron_moments(placed, 0, area_order=order, allow_open=True)[1]
