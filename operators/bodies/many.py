# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many objects at once: small solids are measured as stacks, all others one by one, with the same numbers.

A stack holds shapes and objects. A shape is a mesh, however many objects show it: it is measured in its own
coordinates, closed ones all together and what has to be repaired by itself, and its axes are looked for once. An object
is a shape, a place, and settings: moments, mass properties and frames are computed for all objects together.

What joins no stack, because it shows more than one mesh in one place, is no solid, is large, or has a density that
varies, is measured by `measure_body`; so is what is refused, for the reason.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.inertia.canonical_frame import MAX_ORDER
from ...core.inertia.mass_properties import MassProperties
from ...core.inertia.principal_frame import OwnMoments
from ...core.inertia.second_order import second_order_frames
from ...core.measurement import DENSITY_FROM_MASS, DENSITY_FROM_VALUE, Measurement
from ...core.mesh.surface import Surface
from ...core.moments.affine_maps import are_similarities
from ...core.moments.moments import Moments, image, stack_moments
from ...core.numerics.float32 import shortest_decimal
from ...core.numerics.rotations import rotation_matrix
from ...core.polyhedron import area_of_images, polyhedron_moments
from ...core.solid.measure_solid import measure_solid
from ...core.solid.solid_stack import SolidStack, can_be_stacked, measure_stack
from ...core.verdict import internal_error
from ...core.verdict.finding import Finding, MeasureError
from ...core.verdict.health import MeshReport
from ...core.verdict.method import Method, Verdict
from ..read.fingerprint import effective_hash, fingerprint, matrix_hash, surface_digest
from ..read.mesh import mesh_surface
from ..read.plain import plain_mesh
from ..read.reading import are_singular, to_si
from ..settings.density import object_density
from ..settings.options import AS_SET, MeasureOptions
from .body import own_moments
from .measure_object import Measured, measure_body
from .measurement import MAX_FACES_HIGH_ORDER

MAX_OBJECTS_PER_STACK = 512
MAX_FACES_PER_STACK = 40_000
EXACT = Method(Verdict.EXACT)


class Stacked:
    """One object's measurement that is part of a stack: what `Measured` is of an object that was measured by itself."""

    __slots__ = ("index", "stack")

    def __init__(self, stack: MeasuredStack, index: int):
        self.stack, self.index = stack, index

    @property
    def measurement(self) -> Measurement:
        """The measurement."""
        return self.stack.measurement(self.index)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The measurement's findings."""
        return self.stack.findings[self.index]

    def add_finding(self, found: Finding) -> None:
        """Report something more."""
        self.stack.findings[self.index] += (found,)

    @property
    def has_density(self) -> bool:
        """Whether the object has a density, not a mass."""
        return not self.stack.from_mass[self.index]

    @property
    def shape_digest(self) -> bytes | None:
        """A digest of what the object shows; None of a large one."""
        return self.stack.shapes[self.index].digest

    def alone(self) -> Measured:
        """The same, measured by itself, with its reading and its body."""
        return measure_body(self.stack.objects[self.index], self.stack.depsgraph, self.stack.options)


Outcome = Measured | Stacked | Exception


def measure_many(
    objects: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph, options: MeasureOptions = AS_SET
) -> Iterator[list[tuple[bpy.types.Object, Outcome]]]:
    """Measure objects, some at a time.

    Parameters
    ----------
    objects : sequence of bpy.types.Object
        Original ones.
    depsgraph : bpy.types.Depsgraph
    options : MeasureOptions
        For all of them.

    Yields
    ------
    list of (bpy.types.Object, Measured or Stacked or Exception)
        The next ones, in their order: what was measured, or why it was not.
    """
    pending: list[tuple[bpy.types.Object, _Member | None]] = []
    collector = _Collector(depsgraph, options)
    for obj in objects:
        pending.append((obj, collector.add(obj)))
        if collector.is_full or len(pending) >= MAX_OBJECTS_PER_STACK:
            yield from _outcomes(pending, collector)
            pending, collector = [], _Collector(depsgraph, options)
    if pending:
        yield from _outcomes(pending, collector)


def _outcomes(
    pending: list[tuple[bpy.types.Object, _Member | None]], collector: _Collector
) -> Iterator[list[tuple[bpy.types.Object, Outcome]]]:
    """What came of those that were collected: of stacked ones together, of others one by one."""
    stacked = collector.measure()
    together: list[tuple[bpy.types.Object, Outcome]] = []
    for obj, member in pending:
        outcome: Outcome | None = None if member is None else stacked.get(member.number)
        if outcome is None:
            if together:
                yield together
                together = []
            try:
                outcome = measure_body(obj, collector.depsgraph, collector.options)
            except Exception as error:
                outcome = error
            yield [(obj, outcome)]
        else:
            together.append((obj, outcome))
    if together:
        yield together


@dataclass(eq=False)
class Shape:
    """A mesh in its own coordinates, and how it was measured."""

    surface: Surface
    face_count: int
    volume: Moments | None = None
    area: Moments | None = None
    health: MeshReport | None = None
    method: Method = EXACT
    findings: tuple[Finding, ...] = ()
    measured_surface: Surface | None = None

    @cached_property
    def digest(self) -> bytes | None:
        """Of what it shows, for staleness; None of a large one."""
        return surface_digest(self.surface, self.face_count)

    @cached_property
    def sixth_order(self) -> Moments:
        """The volume's moments that axes are found by."""
        surface = self.measured_surface or self.surface
        with np.errstate(over="ignore", invalid="ignore"):
            return polyhedron_moments(surface, MAX_ORDER, about=self.volume.about, exact=True)[0]

    def measure_alone(self) -> None:
        """Measure it with whatever it needs. MeasureError where there is nothing to measure."""
        solid = measure_solid(self.surface)
        self.volume, self.area, self.health = solid.volume, solid.area, solid.health
        self.method, self.findings, self.measured_surface = Method(solid.method), solid.findings, solid.repaired_surface

    def take(self, solids: SolidStack, i: int) -> None:
        """What it is as one of a stack."""
        self.volume, self.area, self.health = solids.volume.at(i), solids.area.at(i), solids.health(i)
        self.findings = solids.findings(i)


@dataclass(frozen=True, eq=False)
class _Member:
    """An object that may join a stack: which of its objects it is, and of which shape."""

    number: int
    obj: bpy.types.Object
    shape: Shape
    density: float | None
    mass: float | None
    settings: str
    matrix: NDArray[np.float64]
    location: tuple[float, float, float]
    quaternion: tuple[float, float, float, float]


class _Collector:
    """Objects that are measured together."""

    def __init__(self, depsgraph: bpy.types.Depsgraph, options: MeasureOptions):
        self.depsgraph, self.options, self.scene = depsgraph, options, depsgraph.scene
        self.unit = options.unit_scale or shortest_decimal(self.scene.unit_settings.scale_length)
        self.members: list[_Member] = []
        self.shapes: list[Shape] = []
        self.faces = 0
        self._by_mesh: dict[bpy.types.Mesh, Shape | None] = {}
        self._by_content: dict[tuple[bytes, ...], Shape] = {}
        self._settings: dict[tuple[float | None, float | None], str] = {}

    @property
    def is_full(self) -> bool:
        return len(self.members) >= MAX_OBJECTS_PER_STACK or self.faces >= MAX_FACES_PER_STACK

    def add(self, obj: bpy.types.Object) -> _Member | None:
        """The object as one of the stack; None where it cannot be, or reading it fails: by itself it fails again."""
        try:
            return self._member(obj)
        except Exception:
            return None

    def _member(self, obj: bpy.types.Object) -> _Member | None:
        weight = self._weight(obj)
        mesh = None if weight is None else plain_mesh(obj, self.depsgraph)
        if mesh is None:
            return None
        try:
            shape = self._by_mesh[mesh]
        except KeyError:
            shape = self._by_mesh[mesh] = self._read(mesh)
        if shape is None:
            return None
        matrix = obj.evaluated_get(self.depsgraph).matrix_world
        location, turn, _scale = matrix.decompose()
        member = _Member(
            len(self.members),
            obj,
            shape,
            *weight,
            np.array(matrix),
            location.to_tuple(),
            (turn.w, turn.x, turn.y, turn.z),
        )
        self.members.append(member)
        return member

    def _weight(self, obj: bpy.types.Object) -> tuple[float | None, float | None, str] | None:
        """The density or the mass of a solid that has one, and the digest of the settings; None of others."""
        options, settings = self.options, obj.body_moments
        kind, overlap = options.kind or settings.kind.lower(), options.overlap or settings.overlap.lower()
        if kind != "solid" or overlap != "signed" or options.order is not None:
            return None
        density, mass = options.density, options.mass
        if density is None and mass is None:
            if settings.mass_from == "MASS":
                if settings.use_center or settings.use_inertia:
                    return None
                mass = shortest_decimal(settings.mass)
            elif settings.density_from != "VALUE":
                return None
            else:
                density = object_density(settings, self.scene)
        elif settings.mass_from == "MASS" and density is None and (settings.use_center or settings.use_inertia):
            return None
        key = density, mass
        if key not in self._settings:
            self._settings[key] = effective_hash("SOLID", density, mass, 0.0, "SIGNED", self.unit)
        return density, mass, self._settings[key]

    def _read(self, mesh: bpy.types.Mesh) -> Shape | None:
        """The shape of a mesh; None where it has to be measured by itself."""
        if not len(mesh.polygons) or len(mesh.polygons) > MAX_FACES_HIGH_ORDER:
            return None
        surface = mesh_surface(mesh)
        content = surface.points.tobytes(), surface.corner_vertices.tobytes(), surface.quads.tobytes()
        if content in self._by_content:
            return self._by_content[content]
        if not np.isfinite(surface.box).all():
            return None
        shape = self._by_content[content] = Shape(surface, len(mesh.polygons))
        self.shapes.append(shape)
        self.faces += len(surface.triangles) + len(surface.quads)
        return shape

    def measure(self) -> dict[int, Stacked]:
        """What could be measured together, by number: where that fails, nothing, so that each is measured by itself."""
        stack = None
        try:
            if self.members:
                self._measure_shapes()
                stack = _stack_of(self)
        except Exception as error:
            internal_error.finding_of(error)
        return {} if stack is None else {number: Stacked(stack, i) for i, number in enumerate(stack.numbers)}

    def _measure_shapes(self) -> None:
        small = [shape for shape in self.shapes if can_be_stacked(shape.surface)]
        if small:
            solids = measure_stack([shape.surface for shape in small])
            for i in np.flatnonzero(solids.is_exact).tolist():
                small[i].take(solids, i)
        for shape in self.shapes:
            if shape.volume is None:
                try:
                    shape.measure_alone()
                except MeasureError:  # the objects are refused one by one, with the reason
                    continue


@dataclass(frozen=True, eq=False)
class MeasuredStack:
    """The measurements of many objects, each a solid of one shape in one place, in SI units and world axes.

    Attributes
    ----------
    objects : list of bpy.types.Object
    numbers : list of int
        Where they stood among those that were collected.
    shapes : list of Shape
        Of each object.
    density, thickness : (n,) array
        kg/m³.
    from_mass : (n,) bool
        Whether the density follows from a given mass.
    volume, area : Moments
    mass_properties : MassProperties
        With a leading axis.
    stretch : (n,) array
        By what the volume of the shape was multiplied.
    rotation, location : (n, 3, 3) and (n, 3) array
        The object frames.
    fingerprints : list of str
    findings : list of tuple of Finding
    """

    objects: list[bpy.types.Object]
    numbers: list[int]
    shapes: list[Shape]
    depsgraph: bpy.types.Depsgraph
    options: MeasureOptions
    density: NDArray[np.float64]
    from_mass: NDArray[np.bool_]
    volume: Moments
    area: Moments
    mass_properties: MassProperties
    stretch: NDArray[np.float64]
    rotation: NDArray[np.float64]
    location: NDArray[np.float64]
    fingerprints: list[str]
    findings: list[tuple[Finding, ...]] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.objects)

    def some(self, which: list[int]) -> MeasuredStack:
        """Some of them as a stack."""
        return replace(
            self,
            **{
                name: [getattr(self, name)[i] for i in which]
                for name in ("objects", "numbers", "shapes", "fingerprints", "findings")
            },
            **{
                name: getattr(self, name)[which] for name in ("density", "from_mass", "stretch", "rotation", "location")
            },
            volume=self.volume.at(which),
            area=self.area.at(which),
            mass_properties=self.mass_properties.at(which),
        )

    @cached_property
    def error_bounds(self) -> NDArray[np.float64]:
        """(n, 2, 4) of rounding and of float32 coordinates: volume, area, center, inertia."""
        properties = self.mass_properties
        return np.array(
            [
                [volume[:, 0], area[:, 0], bounds["center"], bounds["inertia"]]
                for volume, area, bounds in (
                    (self.volume.rounding_error, self.area.rounding_error, properties.rounding_error),
                    (self.volume.input_error, self.area.input_error, properties.input_error),
                )
            ]
        ).transpose(2, 0, 1)

    def in_object_frames(self) -> MassProperties:
        """The mass properties, each in its object's own frame."""
        return self.mass_properties.in_frame(self.rotation, self.location)

    def measurement(self, i: int) -> Measurement:
        """One of them."""
        obj, shape, volume, density = self.objects[i], self.shapes[i], self.volume.at(i), float(self.density[i])
        names = "volume", "area", "center_of_mass", "inertia"
        rounding, inputs = (dict(zip(names, row)) for row in self.error_bounds[i].tolist())
        return Measurement(
            name=obj.name,
            type=obj.type,
            kind="solid",
            method=shape.method,
            density=density,
            thickness=0.0,
            volume=volume.total,
            area=float(self.area.raw[i, 0]),
            mass_properties=self.mass_properties.at(i),
            volume_moments=volume,
            area_moments=self.area.at(i),
            mass_moments=(volume, density),
            health=replace(shape.health, volume_spread=shape.health.volume_spread * float(self.stretch[i])),
            findings=self.findings[i],
            rotation=self.rotation[i],
            location=self.location[i],
            error_bound={**rounding, "input": inputs},
            fingerprint=self.fingerprints[i],
            density_from=DENSITY_FROM_MASS if self.from_mass[i] else DENSITY_FROM_VALUE,
        )


def _stack_of(collected: _Collector) -> MeasuredStack | None:
    """The measurements of those members whose shapes could be measured and whose numbers are certain."""
    members = [member for member in collected.members if member.shape.volume is not None]
    matrices = np.array([member.matrix for member in members]).reshape(-1, 4, 4)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usable[usable] = ~are_singular(matrices[usable])
    usable &= np.array([_is_certain(member.shape.volume) for member in members], bool)
    members, matrices = _chosen(members, usable), to_si(matrices[usable], collected.unit)
    if not members:
        return None
    shapes = {id(member.shape): i for i, member in enumerate(members)}
    distinct = [members[i].shape for i in shapes.values()]
    place = {key: i for i, key in enumerate(shapes)}
    which = np.array([place[id(member.shape)] for member in members])
    own = stack_moments([shape.volume for shape in distinct])
    own_area = stack_moments([shape.area for shape in distinct])
    linear = matrices[:, :3, :3]
    even = are_similarities(linear)
    volume = _placed(own.at(which), matrices)
    area = _areas(own_area.at(which), matrices, even, [member.shape for member in members])
    total = volume.raw[:, 0]
    density = np.array([np.nan if member.density is None else member.density for member in members])
    mass = np.array([np.nan if member.mass is None else member.mass for member in members])
    from_mass = ~np.isnan(mass)
    with np.errstate(divide="ignore", invalid="ignore"):
        density = np.where(from_mass, mass / total, density)
        certain = (total > volume.rounding_error[:, 0]) & (density > 0.0) & np.isfinite(density)
    rest = np.flatnonzero(certain)
    fixed = second_order_frames(volume.at(rest)) if len(rest) else None
    if fixed is None or not fixed.is_body.all():  # one that is none is refused by itself
        rest = rest[fixed.is_body] if fixed is not None else rest
        if not len(rest):
            return None
        fixed = second_order_frames(volume.at(rest))
    members, volume, area, density = _chosen(members, rest), volume.at(rest), area.at(rest), density[rest]
    which, linear = which[rest], linear[rest]
    rotation = rotation_matrix([member.quaternion for member in members])

    def higher(left: NDArray[np.intp]) -> OwnMoments:
        needed, shape = np.unique(which[left], return_inverse=True)
        return own_moments([distinct[i].sixth_order for i in needed.tolist()], shape, linear[left])

    properties = MassProperties.of_stack(volume, density, rotation, fixed, higher)
    return MeasuredStack(
        [member.obj for member in members],
        [member.number for member in members],
        [member.shape for member in members],
        collected.depsgraph,
        collected.options,
        density,
        from_mass[rest],
        volume,
        area,
        properties,
        volume.raw[:, 0] / own.raw[which, 0],
        rotation,
        np.array([member.location for member in members]) * collected.unit,
        _fingerprints(members, volume, area),
        [member.shape.findings for member in members],
    )


def _chosen(members: list[_Member], which: NDArray) -> list[_Member]:
    return [members[i] for i in (np.flatnonzero(which) if which.dtype == bool else which).tolist()]


def _is_certain(volume: Moments) -> bool:
    return bool(volume.raw[0] > volume.rounding_error[0])


def _placed(moments: Moments, matrices: NDArray) -> Moments:
    """The images about the images of their reference points, as `sum_of_images` gives them."""
    linear, about = matrices[:, :3, :3], moments.about
    center = linear[..., 0] * about[:, :1] + linear[..., 1] * about[:, 1:2] + linear[..., 2] * about[:, 2:]
    return image(moments, matrices, center + matrices[:, :3, 3])


def _areas(area: Moments, matrices: NDArray, even: NDArray[np.bool_], shapes: list[Shape]) -> Moments:
    """The areas of the images, of uneven ones from the mapped surfaces."""
    if even.all():
        return _placed(area, matrices)
    regular = matrices.copy()
    regular[~even, :3, :3] = np.eye(3)
    placed = _placed(area, regular)
    for i in np.flatnonzero(~even).tolist():
        found = area_of_images(shapes[i].surface, matrices[i : i + 1, :3, :3])
        for name in ("raw", "rounding_error", "input_error", "about"):
            getattr(placed, name)[i] = getattr(found, name)
    return placed


def _fingerprints(members: list[_Member], volume: Moments, area: Moments) -> list[str]:
    geometry = np.concatenate([volume.raw, area.raw], axis=1)
    return [
        fingerprint(numbers, matrix_hash(member.obj), member.settings) for numbers, member in zip(geometry, members)
    ]
