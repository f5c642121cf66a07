# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a skinned character's bones, in rest pose: skinned geometry and parented objects."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

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
from ...core.numerics import Array, Index, NDArray, shortest_decimal
from ...core.rig import VertexWeights, bone_pieces, bones_of_caps, dominant_bones
from ...core.solid import SolidIntegrals, measure_solid
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

    skinned: mass moments at 1 kg/m³ of geometry skinned to the bone, each with its density.
    hanging: mass moments of objects parented to the bone. volumes, areas: m³ and m². surfaces: each
    with the (4, 4) map to the world, m. sources: names of the objects, in order.
    """

    skinned: list[tuple[Moments, float]] = field(default_factory=list)
    hanging: list[Moments] = field(default_factory=list)
    volumes: list[Extent] = field(default_factory=list)
    areas: list[Extent] = field(default_factory=list)
    procedures: list[Procedure] = field(default_factory=list)
    surfaces: list[tuple[Surface, Array]] = field(default_factory=list)
    sources: dict[str, None] = field(default_factory=dict)


class _Piece(NamedTuple):
    """The piece of a skinned surface that goes with one bone.

    moments: of the volume, or of the area of a sheet, SI units and world axes. surface: in the
    object's coordinates, with the (4, 4) map to the world, m.
    """

    bone: str
    moments: Moments
    area: Moments
    surface: Surface
    matrix: Array
    procedure: Procedure


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
        """Return the measured rig; objects that are not rendered or cannot be measured are left
        out and reported.
        """
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
            self._try(obj, partial(self._add_skinned, obj))
        for obj, bone in hanging:
            self._try(obj, partial(self._add_hanging, obj, bone))
        parts = tuple(
            self._part(name, self.sums[name]) for name in self.bones.names if name in self.sums
        )
        impossible = [part.name for part in parts if part.refusal is not None]
        for code, names in (
            (MEMBERS_NOT_MEASURED, self.refused),
            (MEMBERS_DENSITY_UNSET, self.unset),
            (BONE_PARTS_IMPOSSIBLE, impossible),
        ):
            if names:
                self.findings.append(finding(code, count=len(names), names=names))
        return Rig(self.armature, parts, self._total(parts), tuple(self.objects))

    def _try(self, obj: Object, add: Callable[[], None]) -> None:
        """Add a rendered object, or note its name if it cannot be measured."""
        if obj.hide_render:
            return
        self.objects.append(obj)
        try:
            add()
        except Exception as error:
            internal_error.finding_of(error)
            self.refused.append(obj.name)

    def _sum_of(self, bone: str, source: Object) -> _Sum:
        bone_sum = self.sums.setdefault(bone, _Sum())
        bone_sum.sources[source.name] = None
        return bone_sum

    def _add_hanging(self, obj: Object, bone: str) -> None:
        if bone not in self.bones.frames:
            self.findings.append(finding(BONE_MISSING, bone=bone).of_sources([obj.name]))
            return
        measured = measure_body(obj, self.depsgraph, self.options)
        measurement = measured.measurement
        moments, factor = measurement.mass_moments
        bone_sum = self._sum_of(bone, obj)
        bone_sum.hanging.append(
            replace(moments.truncate(KNOWN_ORDER), measure=Measure.MASS) * factor
        )
        bone_sum.volumes.append(extent_of(measurement, "volume"))
        bone_sum.areas.append(extent_of(measurement, "area"))
        bone_sum.procedures.append(measurement.method.procedure)
        for surface in measured.body.surfaces(measurement.kind == "shell"):
            bone_sum.surfaces.append((surface, np.eye(4)))
        if not self.is_given and unset_density(obj, measurement, self.depsgraph.scene) is not None:
            self.unset.append(obj.name)

    def _add_skinned(self, obj: Object) -> None:
        request = Request.resolve(obj, self.depsgraph, self.options)
        settings = request.settings
        reading = read_object(obj, self.depsgraph)
        shell = settings.kind == "shell"
        if shell and settings.wall != "thin":
            self.findings.append(finding(RIG_WALL_THIN).of_sources([obj.name]))
        pieces = [piece for part in reading.parts for piece in self._pieces(obj, part, shell)]
        # The moments of solids are those of volumes already, those of sheets are areas.
        thickness = settings.thickness if shell else 1.0
        volume = sum(piece.moments.total for piece in pieces) * thickness
        if not volume > 0.0:
            # `rig` reports the names of refused objects, without the reason
            raise ReadError(NO_VOLUME)
        density = settings.density or 0.0 if settings.mass is None else settings.mass / volume
        if settings.mass is None and request.density is not None:
            measurement = measure_object(obj, self.depsgraph, self.options)
            density = measurement.mass_properties.mass / measurement.volume
            self.findings.append(finding(RIG_MEAN_DENSITY).of_sources([obj.name]))
        if not density > 0.0:
            raise ReadError(ZERO_QUANTITY, quantity="density")
        for piece in pieces:
            bone_sum = self._sum_of(piece.bone, obj)
            unit_mass = replace(piece.moments.truncate(KNOWN_ORDER), measure=Measure.MASS)
            unit_mass = unit_mass * thickness if shell else unit_mass
            bone_sum.skinned.append((unit_mass, density))
            bone_sum.volumes.append(_extent(unit_mass))
            bone_sum.areas.append(_extent(piece.area))
            bone_sum.procedures.append(piece.procedure)
            bone_sum.surfaces.append((piece.surface, piece.matrix))
        properties = obj.body_moments
        by_value = properties.mass_from == "DENSITY" and properties.density_from == "VALUE"
        if by_value and not self.is_given and is_density_unset(properties, self.depsgraph.scene):
            self.unset.append(obj.name)

    def _pieces(self, obj: Object, part: bodies.Part, shell: bool) -> Iterator[_Piece]:
        """Yield the pieces of a surface in all its places; add findings about its repair and about
        vertices without weights.
        """
        surface = part.surface
        if not len(surface.triangles) and not len(surface.quads):
            return
        weights = vertex_weights(obj, part, self.bones, self.depsgraph)
        triangles, face_of_triangle = surface.all_triangles()
        point_count = len(surface.points)
        # Every corner of an n-gon once, though it belongs to several triangles. The pair of a face
        # and a vertex is one number, because `np.unique` sorts numbers faster than rows.
        corners = np.unique(
            np.repeat(face_of_triangle, 3).astype(np.int64) * point_count + triangles.ravel()
        )
        corner_face, corner_vertex = np.divmod(corners, point_count)
        self._note_unweighted(obj, weights, corner_vertex, point_count)
        solid = None if shell else measure_solid(surface)
        if solid is not None:
            self.findings += [result.of_sources([obj.name]) for result in solid.findings]
        for matrix in part.matrices:
            points = surface.points.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
            bone_of_face, _ = dominant_bones(
                corner_face, corner_vertex, points, weights, self.bones.segments
            )
            metric = bodies.to_si(matrix[None], self.unit)[0]  # (4, 4), to the world in m
            if solid is None:
                yield from self._sheets(surface, triangles, bone_of_face[face_of_triangle], metric)
            else:
                yield from self._closed_pieces(solid, surface, bone_of_face, metric)

    def _note_unweighted(
        self, obj: Object, weights: VertexWeights, corner_vertex: Index, point_count: int
    ) -> None:
        """Add a finding if vertices of faces have no weight on a deforming bone."""
        is_used = np.zeros(point_count, bool)
        is_used[corner_vertex] = True
        unweighted = weights.unweighted(point_count)
        unweighted = unweighted[is_used[unweighted]]
        if len(unweighted):
            total = int(np.count_nonzero(is_used))
            note = finding(UNWEIGHTED_VERTICES, unweighted, count=len(unweighted), total=total)
            self.findings.append(note.of_sources([obj.name]))

    def _closed_pieces(
        self, solid: SolidIntegrals, surface: Surface, bone_of_face: Index, metric: Array
    ) -> Iterator[_Piece]:
        """Yield the pieces of a solid, closed by caps where bones meet."""
        parts = solid.parts()
        is_cap = parts.face < 0  # triangles over holes belong to no face
        bones = bones_of_caps(
            parts.triangles, is_cap, np.where(is_cap, 0, bone_of_face[parts.face])
        )
        for piece in bone_pieces(parts.points, parts.triangles, bones, surface.coordinate_error):
            faces = piece.surface.triangles[: piece.face_count]  # without the caps
            yield _Piece(
                self.bones.deforming[piece.bone],
                piece.moments().transform(metric),
                _area(replace(piece.surface, triangles=faces), metric, 0),
                piece.surface,
                metric,
                solid.method,
            )

    def _sheets(
        self,
        surface: Surface,
        triangles: NDArray,
        bone_of_triangle: Index,
        metric: Array,
    ) -> Iterator[_Piece]:
        """Yield the sheets of triangles that go with the same bone."""
        for bone in np.unique(bone_of_triangle).tolist():
            sheet = Surface(
                surface.points,
                triangles[bone_of_triangle == bone].astype(np.int64),
                displacement=surface.coordinate_error,
            )
            area = _area(sheet, metric, KNOWN_ORDER)
            yield _Piece(self.bones.deforming[bone], area, area, sheet, metric, Procedure.SHELL)

    def _part(self, name: str, bone_sum: _Sum) -> BonePart:
        """Return the part of a bone, with the density or mass that the bone's settings give it."""
        settings = self.armature.pose.bones[name].body_moments
        mass_from = "MESH" if self.is_given else settings.mass_from
        bone_density = shortest_decimal(settings.density) if mass_from == "DENSITY" else None
        masses = [
            moments * (density if bone_density is None else bone_density)
            for moments, density in bone_sum.skinned
        ]
        mass = sum_moments([*masses, *bone_sum.hanging])
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
                volume=add_extents(bone_sum.volumes),
                area=add_extents(bone_sum.areas),
                rotation=rotation,
                location=head * self.unit,
                fingerprint=fingerprint(mass.raw.tobytes(), "", digest(name.encode())),
                findings=(),
                method=Method(least_trusted(bone_sum.procedures)),
                density_from=DENSITIES_FROM[mass_from],
            )
        except MeasureError as error:
            refusal = finding(BONE_PART_IMPOSSIBLE, cause=error.finding.as_record())
        return BonePart(
            name, mass, measurement, refusal, tuple(bone_sum.surfaces), tuple(bone_sum.sources)
        )

    def _total(self, parts: tuple[BonePart, ...]) -> Measurement:
        """Return the measurement of all parts as one body, or raise ReadError without parts."""
        armature, depsgraph = self.armature, self.depsgraph
        if not parts:
            raise ReadError(RIG_WITHOUT_PARTS, subject=armature.name)
        frame = locate(armature, depsgraph)
        objects = rig_objects(armature, depsgraph.view_layer.objects)
        settings_hash = rig_hash(armature, objects, depsgraph.scene)
        sums = [self.sums[part.name] for part in parts]
        mass = sum_moments([part.mass for part in parts])
        return measure_total(
            mass,
            name=armature.name,
            type="ARMATURE",
            kind="rig",
            volume=add_extents([add_extents(bone_sum.volumes) for bone_sum in sums]),
            area=add_extents([add_extents(bone_sum.areas) for bone_sum in sums]),
            rotation=frame.rotation,
            location=frame.location * self.unit,
            fingerprint=fingerprint(mass.raw.tobytes(), matrix_hash(armature), settings_hash),
            findings=tuple(self.findings),
        )


def _area(sheet: Surface, metric: Array, order: int) -> Moments:
    """Return the area moments of a sheet mapped to its place in the world, in m."""
    # Moments map by a similarity; the mapped points would be rounded once more.
    is_even = are_similarities(metric[None, :3, :3])[0]
    placed = sheet if is_even else sheet.transform(metric[:3, :3], metric[:3, 3])
    area = polyhedron.polyhedron_moments(placed, 0, area_order=order, allow_open=True)[1]
    return area.transform(metric) if is_even else area


def _extent(moments: Moments) -> Extent:
    """Return the total of a volume or an area, with its bounds of rounding and of the input."""
    return moments.total, float(moments.rounding_error[0]), float(moments.input_error[0])
