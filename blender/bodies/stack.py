# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements of many objects, each a solid of one shape in one place, computed together.

Small shapes that are closed or can be capped are measured together, all others are repaired and
measured alone.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core import bodies, inertia, mesh, moments, polyhedron
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
from ...core.numerics import Array, Index, Mask, NDArray, rotation_matrix
from ...core.solid import SmallSolid, SolidStack
from ...core.verdict import Finding, Method, Procedure
from ..read.fingerprint import transform_key
from ..settings.accepted import accepted_codes, with_acceptance

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


class Measured:
    """The measurement of one object, with its reading and its body.

    `stack`: the measurements of several objects, of which this is row `index`, or of one that was
    measured alone. `members`, `shapes`: the objects of a stack, one of them this `member`, and the
    solids that they show. An object that was measured alone has no member, but a `reading` and a
    `body` from the start.
    """

    stack: Any  # entries of a stack are lists and arrays
    member: Member
    members: list[Member]
    shapes: SolidStack

    def __init__(self, stack: Measurement, index: int | None = None, **attributes: Any):
        self.stack = stack
        self.index = index
        self.__dict__.update(attributes)  # also in place of cached properties

    @property
    def findings(self) -> tuple[Finding, ...]:
        return self.stack.findings if self.index is None else self.stack.findings[self.index]

    @property
    def is_faultless(self) -> bool:
        """True if the object's surface is known to be closed, without defective elements."""
        if self.index is None:
            return False
        solid = self.shapes[self.member.shape]
        return isinstance(solid, SmallSolid) and solid.method is Procedure.EXACT

    @property
    def surface(self) -> mesh.Surface | None:
        """The object's surface as it was read, None if it has several or none."""
        if self.index is not None:
            return self.shapes.surfaces[self.member.shape]
        parts = self.reading.parts
        return parts[0].surface if len(parts) == 1 else None

    @cached_property
    def measurement(self) -> Measurement:
        if self.index is None:
            return self.stack
        row = self.stack.at(self.index)
        solid = self.shapes[self.member.shape]
        # A spread is a volume and grows with the volume, from the mesh's coordinates to the world.
        spread = solid.health.volume_spread * (row.volume / solid.volume.total)
        return replace(row, health=replace(solid.health, volume_spread=spread))

    @cached_property
    def body(self) -> Body:
        row = self.measurement
        member = self.member
        solid = self.shapes[member.shape]
        return bodies.MeshBody(
            row.mass_moments[0],
            row.area_moments,
            row.health,
            row.method,
            row.findings,
            face_count=solid.face_count,
            solids=((solid, bodies.to_si(member.matrix[None], member.settings.unit)),),
            threads=1,
        )

    @cached_property
    def reading(self) -> bodies.Reading:
        member = self.member
        return bodies.Reading(
            member.obj.name,
            member.obj.type,
            member.matrix,
            self.stack.rotation[self.index],
            np.array(member.location),
            [bodies.Part(self.shapes.surfaces[member.shape], member.matrix[None])],
        )


def measure_members(members: list[Member], shapes: SolidStack) -> list[Measured]:
    """Return the measurements of the members with certain volume and mass, as one stack; all
    members have the same unit. shapes: the solids that members show. The other members are left
    out: measured alone, they are refused.
    """

    def measure_some(usable: Mask) -> list[Measured]:
        """Measure the usable members in a new stack."""
        return measure_members([members[i] for i in np.flatnonzero(usable)], shapes)

    if not members:
        return []
    unit = members[0].settings.unit
    shape = np.array([member.shape for member in members])
    matrices = np.array([member.matrix for member in members], np.float64)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usable &= shapes.volume.raw[shape, 0] > shapes.volume.rounding_error[shape, 0]
    usable[usable] = ~moments.are_singular(matrices[usable, :3, :3])
    if not usable.all():
        return measure_some(usable)
    matrices[:, :3] *= unit
    volume = moments.image(shapes.volume.at(shape), matrices)
    area = _areas(shapes, shape, matrices)
    # None becomes NaN: a member has a density or a mass.
    density, mass = np.array(
        [(member.settings.density, member.settings.mass) for member in members], np.float64
    ).T
    from_mass = ~np.isnan(mass)
    with np.errstate(divide="ignore", invalid="ignore"):
        density = np.where(from_mass, mass / volume.raw[:, 0], density)
    certain = inertia.has_certain_total(volume) & (density > 0.0) & (density < np.inf)
    if not certain.all():
        return measure_some(certain)
    frames = third_moment_frames(volume)
    if not frames.is_body.all():
        return measure_some(frames.is_body)
    rotation = rotation_matrix([member.quaternion for member in members])
    properties = inertia.MassProperties.of_stack(volume, density, rotation, frames)
    geometry = np.ascontiguousarray(np.concatenate([volume.raw, area.raw], axis=1))
    stack = build_measurement(
        name=[member.obj.name for member in members],
        type=[member.obj.type for member in members],
        kind="solid",
        method=[METHODS[shapes[member.shape].method] for member in members],
        density=density,
        volume=volume,
        area=area,
        mass_properties=properties,
        mass_moments=(volume, density),
        health=None,
        findings=[
            _findings(member.obj, shapes[member.shape].findings + bounds)
            for member, bounds in zip(members, find_large_bounds(volume, area, properties))
        ],
        rotation=rotation,
        location=np.array([member.location for member in members]) * unit,
        fingerprint=[
            fingerprint(numbers, transform_key(each.obj), each.settings.digest)
            for numbers, each in zip(geometry, members)
        ],
        density_from=[
            DENSITY_FROM_MASS if is_given else DENSITY_FROM_VALUE for is_given in from_mass.tolist()
        ],
    )
    return [
        Measured(stack, i, member=member, members=members, shapes=shapes)
        for i, member in enumerate(members)
    ]


def _findings(obj: bpy.types.Object, findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the findings about an object, with its accepted ones marked."""
    return with_acceptance(findings, accepted_codes(obj)) if findings else ()


def _areas(shapes: SolidStack, shape: Index, matrices: NDArray) -> moments.Moments:
    """Return the areas of the surface shape[i] mapped by matrices[i]; a surface is measured again
    if its matrix is no similarity.
    """
    area = shapes.area.at(shape)
    is_even = moments.are_similarities(matrices[:, :3, :3])
    if is_even.all():
        return moments.image(area, matrices)
    even_matrices = matrices.copy()
    even_matrices[~is_even, :3, :3] = np.eye(3)
    images = moments.image(area, even_matrices)
    for i in np.flatnonzero(~is_even).tolist():
        image = polyhedron.area_of_images(
            shapes[int(shape[i])].given_surface, matrices[i : i + 1, :3, :3]
        )
        for name in ("raw", "rounding_error", "input_error", "about"):
            getattr(images, name)[i] = getattr(image, name)
    return images
