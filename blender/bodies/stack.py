# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements of many objects, each a solid of one shape in one place, computed together.

Small shapes that are closed or can be capped are measured together, all others are repaired and
measured alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.bodies import Reading
from ...core.inertia import MassProperties, has_certain_total
from ...core.inertia.third_moment_frames import third_moment_frames
from ...core.measurement import (
    DENSITY_FROM_MASS,
    DENSITY_FROM_VALUE,
    Body,
    Measurement,
    Settings,
    build_measurement,
    find_large_bounds,
    fingerprint,
)
from ...core.mesh import Surface
from ...core.moments import Moments, are_similarities, are_singular, image
from ...core.numerics import Array, Index, Mask, NDArray, rotation_matrix
from ...core.polyhedron import area_of_images
from ...core.solid import SmallSolid, SolidIntegrals, SolidStack, measure_again
from ...core.verdict import Finding, Method, Procedure
from ..read.fingerprint import transform_key
from ..read.mesh import read_digest
from ..settings.accepted import accepted_codes, with_acceptance

PlacedSolids = Sequence[tuple[SolidIntegrals, Array]]
METHODS = {verdict: Method(verdict) for verdict in Procedure}


class Member(NamedTuple):
    """An object that may join a stack.

    `shape`: index of its surface.
    `matrix`: (4, 4) map from the mesh's coordinates to the world, Blender units.
    `location`, `quaternion`: the object's frame.
    """

    obj: bpy.types.Object
    shape: int
    settings: Settings
    matrix: Array
    location: tuple[float, ...]
    quaternion: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class MeasuredStack:
    """The measurements of many objects, in SI units and world axes; arrays have one row for each
    object.

    `from_mass`: true if the density, kg/m³, follows from a given mass.
    `stretch`: ratio of the object's volume to its shape's.
    `rotation`, `location`: (n, 3, 3) and (n, 3), the object frames.
    """

    members: list[Member]
    solids: SolidStack
    from_mass: Mask
    density: Array
    volume: Moments
    area: Moments
    mass_properties: MassProperties
    stretch: Array
    rotation: Array
    location: Array
    fingerprints: list[str]
    methods: list[Method]
    findings: list[tuple[Finding, ...]]

    def surface(self, i: int) -> Surface:
        """Return the surface of one member, in its own coordinates."""
        return self.solids.surfaces[self.members[i].shape]

    def some(self, which: list[int]) -> MeasuredStack:
        """Return the stack of the members with these indices."""
        if len(which) == len(self.members):
            return self
        lists = "members", "fingerprints", "methods", "findings"
        arrays = "density", "from_mass", "stretch", "rotation", "location"
        return replace(
            self,
            **{name: [getattr(self, name)[i] for i in which] for name in lists},
            **{name: getattr(self, name)[which] for name in arrays},
            volume=self.volume.at(which),
            area=self.area.at(which),
            mass_properties=self.mass_properties.at(which),
        )

    @cached_property
    def error_bounds(self) -> Array:
        """(n, 2, 4) bounds by rounding, then by float32 coordinates, of volume, area, center and
        inertia.
        """
        volume = self.volume
        area = self.area
        properties = self.mass_properties
        rounding = properties.rounding_error
        moved = properties.input_error
        bounds = (
            (
                volume.rounding_error[:, 0],
                area.rounding_error[:, 0],
                rounding["center"],
                rounding["inertia"],
            ),
            (volume.input_error[:, 0], area.input_error[:, 0], moved["center"], moved["inertia"]),
        )
        return np.array(bounds).transpose(2, 0, 1)

    def measurement(self, i: int) -> Measurement:
        """Return the measurement of one member."""
        obj = self.members[i].obj
        health = self.solids[self.members[i].shape].health
        volume = self.volume.at(i)
        density = self.density[i]
        return build_measurement(
            name=obj.name,
            type=obj.type,
            kind="solid",
            method=self.methods[i],
            density=float(density),
            volume=volume,
            area=self.area.at(i),
            mass_properties=self.mass_properties.at(i),
            mass_moments=(volume, float(density)),
            health=replace(health, volume_spread=health.volume_spread * float(self.stretch[i])),
            findings=self.findings[i],
            rotation=self.rotation[i],
            location=self.location[i],
            fingerprint=self.fingerprints[i],
            density_from=DENSITY_FROM_MASS if self.from_mass[i] else DENSITY_FROM_VALUE,
        )


class Measured:
    """One object's measurement: a row of a stack, or alone with its reading and body."""

    reading: Reading
    body: Body

    def __init__(self, stack: MeasuredStack | None = None, index: int = 0, **alone: Any):
        self.stack = stack
        self.index = index
        self.__dict__.update(alone)

    @cached_property
    def measurement(self) -> Measurement:
        assert self.stack is not None
        return self.stack.measurement(self.index)

    @property
    def findings(self) -> tuple[Finding, ...]:
        return self.stack.findings[self.index] if self.stack else self.measurement.findings

    @property
    def mass_properties(self) -> MassProperties:
        if self.stack is None:
            return self.measurement.mass_properties
        return self.stack.mass_properties.at(self.index)

    @property
    def method(self) -> Method:
        return self.stack.methods[self.index] if self.stack else self.measurement.method

    @property
    def solids(self) -> PlacedSolids:
        """The solids, each with (k, 4, 4) maps of its places to the world in m; none for other
        bodies than meshes.
        """
        if self.stack is None:
            return getattr(self.body, "solids", ())
        member = self.stack.members[self.index]
        matrix = member.matrix * np.array([[member.settings.unit]] * 3 + [[1.0]])
        return [(self.stack.solids[member.shape], matrix[None])]

    def closed_surface(self, limit: int) -> Surface | None:
        """Return the surface in the world if it is closed as it is, with `limit` triangles at most;
        None if that is not known.
        """
        if self.stack is None:
            return None
        member = self.stack.members[self.index]
        solid = self.stack.solids[member.shape]
        surface = solid.given_surface
        if solid.method is not Procedure.EXACT or not isinstance(solid, SmallSolid):
            return None
        if surface.triangle_count > limit:
            return None
        return surface.transform(member.matrix[:3, :3], member.matrix[:3, 3])

    def shape_digest(self, obj: bpy.types.Object) -> bytes | None:
        """Return the digest of the object's surface; None if it is large or not the whole shape."""
        if self.stack is not None:
            return self.stack.surface(self.index).digest
        return read_digest(obj, self.reading) if isinstance(self.reading, Reading) else None


def measure_members(members: list[Member], surfaces: list[Surface]) -> MeasuredStack | None:
    """Return the stack of the members with certain volume and mass, or None; all members have the
    same unit.
    """
    unit = members[0].settings.unit
    solids = measure_again(surfaces)
    own = solids.volume
    which = np.array([member.shape for member in members])
    matrices = np.array([member.matrix for member in members], np.float64)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usable &= own.raw[which, 0] > own.rounding_error[which, 0]
    usable[usable] = ~are_singular(matrices[usable, :3, :3])
    members = _chosen(members, usable)
    matrices = matrices[usable]
    which = which[usable]
    if not members:
        return None
    matrices[:, :3] *= unit
    volume = image(own.at(which), matrices)
    area = _areas(solids, which, matrices)
    density, mass = np.array(
        [(member.settings.density, member.settings.mass) for member in members], np.float64
    ).T
    from_mass = ~np.isnan(mass)
    with np.errstate(divide="ignore", invalid="ignore"):
        density = np.where(from_mass, mass / volume.raw[:, 0], density)
    certain = has_certain_total(volume) & (density > 0.0) & (density < np.inf)
    rows = np.flatnonzero(certain)
    fixed = third_moment_frames(volume.at(rows))
    if not fixed.is_body.all():  # the others are refused by themselves
        rows = rows[fixed.is_body]
        fixed = third_moment_frames(volume.at(rows))
    if not len(rows):
        return None
    if len(rows) < len(members):  # the others are refused by themselves
        members = _chosen(members, rows)
        which = which[rows]
        matrices = matrices[rows]
        density = density[rows]
        from_mass = from_mass[rows]
        volume, area = volume.at(rows), area.at(rows)
    rotation = rotation_matrix([member.quaternion for member in members])

    properties = MassProperties.of_stack(volume, density, rotation, fixed)
    geometry = np.ascontiguousarray(np.concatenate([volume.raw, area.raw], axis=1))
    return MeasuredStack(
        members,
        solids,
        from_mass,
        density,
        volume,
        area,
        properties,
        volume.raw[:, 0] / own.raw[which, 0],
        rotation,
        np.array([member.location for member in members]) * unit,
        [
            fingerprint(numbers, transform_key(each.obj), each.settings.digest)
            for numbers, each in zip(geometry, members)
        ],
        [METHODS[solids[member.shape].method] for member in members],
        [
            _findings(member.obj, solids[member.shape].findings + bounds)
            for member, bounds in zip(members, find_large_bounds(volume, area, properties))
        ],
    )


def _findings(obj: bpy.types.Object, found: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings about an object, with its accepted ones marked."""
    return with_acceptance(found, accepted_codes(obj)) if found else ()


def _chosen(members: list[Member], which: NDArray) -> list[Member]:
    return [members[i] for i in (np.flatnonzero(which) if which.dtype == bool else which).tolist()]


def _areas(solids: SolidStack, which: Index, matrices: NDArray) -> Moments:
    """Return the areas of surfaces mapped by matrices; surfaces are measured again if a matrix is
    no similarity.
    """
    area = solids.area.at(which)
    even = are_similarities(matrices[:, :3, :3])
    if even.all():
        return image(area, matrices)
    regular = matrices.copy()
    regular[~even, :3, :3] = np.eye(3)
    placed = image(area, regular)
    for i in np.flatnonzero(~even).tolist():
        found = area_of_images(solids[int(which[i])].given_surface, matrices[i : i + 1, :3, :3])
        for name in ("raw", "rounding_error", "input_error", "about"):
            getattr(placed, name)[i] = getattr(found, name)
    return placed
