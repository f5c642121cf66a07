# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assemblies: each member is measured once, and their masses add up, with exact parallel-axis
terms.

A scaled instance multiplies masses by a power of its scale: 3 for solids, 2 for shells, 1 for
wires, 0 for given masses. Mass moments are stored by this power, so that a collection instance is
not measured again.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import bpy
import numpy as np
from bpy.types import Depsgraph, Object

from ....core.bodies import merge_health, to_si
from ....core.measurement import (
    DENSITY_FROM,
    DENSITY_FROM_MASS,
    Extent,
    Measurement,
    add_extents,
    extent_of,
    fingerprint,
    measure_total,
)
from ....core.moments import KNOWN_ORDER, Measure, Moments, are_similarities, sum_moments
from ....core.numerics import rotation_matrix, shortest_decimal
from ....core.verdict import (
    Finding,
    MeasureError,
    ReadError,
    finding,
    internal_error,
    open_body_caveats,
)
from ...read.assembly import (
    Member,
    MemberKind,
    Root,
    copies_caveats,
    members_key,
    members_of,
    settings_of,
    structure_hash,
)
from ...read.findings import (
    BOOLEAN_OPERAND,
    HIDDEN_OBJECT_MEASURED,
    MEMBER_COUNTED_BEFORE,
    NOT_RENDERED,
    SCALE_ZERO_AXIS,
)
from ...read.fingerprint import matrix_hash
from ...read.objects import locate
from ...settings.density import unset_density
from ...settings.given import GivenPart
from ...settings.options import AS_SET, MeasureOptions
from .. import measure_object, overlaps, stack
from ..findings import (
    ASSEMBLY_MASS_GIVEN,
    ASSEMBLY_WITHOUT_MEMBERS,
    CENTER_MISSING,
    GIVEN_CENTER,
    INSTANCE_STRETCHES_SHEETS,
    MEMBERS_COUNTED_BEFORE,
    MEMBERS_DENSITY_UNSET,
    MEMBERS_EXCLUDED,
    MEMBERS_HIDDEN,
    MEMBERS_LEFT_OUT,
    MEMBERS_NOT_MEASURED,
)
from .given import given_moments

NOTHING: Extent = (0.0, 0.0, 0.0)
POWERS = {"solid": 3, "printed": 3, "shell": 2, "wire": 1, "point": 0}
Results = dict[Object, stack.Measured | Finding]


@dataclass(frozen=True, eq=False)
class MemberBody:
    """Moments of a member of an assembly, in SI units along the world's axes.

    `masses`: mass moments to third order, by the power of an instance's scale (see the module);
    empty if no mass. `volume`, m³, and `area`, m²: with their bounds. `measured`: the result of an
    object, with its `measurement`; `refusal`: the reason why it could not be measured. `parts`: the
    members of this member. `findings`: about this member alone, without its parts.
    """

    member: Member
    masses: Mapping[int, Moments] = field(default_factory=dict)
    volume: Extent = NOTHING
    area: Extent = NOTHING
    measured: stack.Measured | None = None
    measurement: Measurement | None = None
    refusal: Finding | None = None
    parts: tuple[MemberBody, ...] = ()
    findings: tuple[Finding, ...] = ()

    @property
    def mass(self) -> Moments | None:
        """The sum of the mass moments, None if there are none."""
        return sum_moments(list(self.masses.values())) if self.masses else None

    def walk(self) -> Iterator[MemberBody]:
        """Yield this member and all members below it, each before its own members."""
        yield self
        for part in self.parts:
            yield from part.walk()


@dataclass(frozen=True, eq=False)
class Assembly:
    """An assembly as one body: the tree of its members, and the measurement of the whole."""

    root: MemberBody
    measurement: Measurement


def measure_assembly(
    root: Root, depsgraph: Depsgraph, options: MeasureOptions = AS_SET
) -> Assembly:
    """Measure a collection, or an empty with its children, as one body; MeasureError if it has no
    mass.
    """
    member = members_of(root, depsgraph)
    results: Results = {}
    for _ in measure_members(member, depsgraph, results, options):
        pass
    return assemble(member, results, depsgraph, options)


def measure_members(
    root: Member, depsgraph: Depsgraph, results: Results, options: MeasureOptions = AS_SET
) -> Generator[int, None, None]:
    """Store the result or refusal of each object of an assembly in `results`; yield the number of
    results. Instances that stretch are measured as one object, too, for their areas.
    """
    objects = {
        member.data: None for member in root.walk() if member.is_measured or _is_sheared(member)
    }
    for together in measure_object.measure_many(list(objects), depsgraph, options):
        for obj, outcome in together:
            results[obj] = (
                internal_error.finding_of(outcome) if isinstance(outcome, Exception) else outcome
            )
        yield len(results)


def assemble(
    root: Member, results: Results, depsgraph: Depsgraph, options: MeasureOptions = AS_SET
) -> Assembly:
    """Return the assembly of measured members, or raise MeasureError if it has no mass."""
    unit = options.meters_per_unit(depsgraph.scene)
    whole = member_body(root, results, unit)
    return Assembly(whole, assembly_measurement(whole, depsgraph, unit))


def member_body(member: Member, results: Results, unit: float) -> MemberBody:
    """Return the moments of a member; `unit` is in meters per Blender unit."""
    parts = tuple(member_body(part, results, unit) for part in member.members)
    if member.kind in (MemberKind.OBJECT, MemberKind.POINT):
        alone = (
            MemberBody(member)
            if member.left_out is not None
            else _object_body(member, results[member.data])
        )
        return _sum(alone, (alone, *parts), parts)
    whole = _sum(MemberBody(member), parts, parts)
    if member.kind == MemberKind.INSTANCE:
        return _instance_body(whole, results, unit)
    return _with_given_mass(whole, unit)


def assembly_measurement(whole: MemberBody, depsgraph: Depsgraph, unit: float) -> Measurement:
    """Return the results of an assembly as one body, or raise MeasureError if it has no mass."""
    data = whole.member.data
    mass = whole.mass
    if mass is None:
        raise ReadError(ASSEMBLY_WITHOUT_MEMBERS, subject=data.name)
    rotation = np.eye(3)
    location = np.zeros(3)
    place_hash = ""
    if isinstance(data, bpy.types.Object):
        frame = locate(data, depsgraph)
        rotation = frame.rotation
        location = frame.location * unit
        place_hash = matrix_hash(data)
    measured = [
        (part.member.data, part.measurement)
        for part in whole.walk()
        if part.measurement is not None
    ]
    fingerprints = {obj: measurement.fingerprint for obj, measurement in measured}
    key = members_key(whole.member, fingerprints)
    healths = [(measurement.health, 1, measurement.area) for _, measurement in measured]
    given = settings_of(data).mass_from == "MASS"
    return measure_total(
        mass,
        name=data.name,
        type="COLLECTION" if isinstance(data, bpy.types.Collection) else data.type,
        kind="assembly",
        volume=whole.volume,
        area=whole.area,
        rotation=rotation,
        location=location,
        fingerprint=fingerprint(key.encode(), place_hash, structure_hash(whole.member)),
        findings=(*findings_of(whole, depsgraph.scene), *_shared_space(whole, depsgraph)),
        density_from=DENSITY_FROM_MASS if given else finding(DENSITY_FROM, source="members"),
        health=merge_health(healths) if healths else None,
    )


def _shared_space(whole: MemberBody, depsgraph: Depsgraph) -> Iterator[Finding]:
    """Yield the findings about copies and overlaps, of the members in the scene and of those in
    each instance, which stand elsewhere.
    """
    objects_in_scene: list[Object] = []
    waiting = [whole]
    while waiting:
        body = waiting.pop()
        is_instance = body.member.kind == MemberKind.INSTANCE
        if body.measurement is not None or is_instance:
            objects_in_scene.append(body.member.data)
        if is_instance:
            inside = [part for part in body.walk() if part.measurement is not None]
            yield from copies_caveats([part.member.data for part in inside])
        else:
            waiting += body.parts
    objects_in_scene.sort(key=lambda obj: obj.name)
    yield from overlaps.shared_space_caveats(objects_in_scene, depsgraph)


def findings_of(whole: MemberBody, scene: bpy.types.Scene) -> Iterator[Finding]:
    """Yield the findings about an assembly: first about the whole, then about its members, with
    their names.
    """
    yield from whole.findings
    bodies = list(whole.walk())
    names: dict[str, list[str]] = {
        MEMBERS_NOT_MEASURED: [body.member.name for body in bodies if body.refusal is not None]
    }
    for body in bodies:
        reason = body.member.left_out
        if reason is not None:
            names.setdefault(_LEFT_OUT.get(reason.code, MEMBERS_EXCLUDED), []).append(
                body.member.name
            )
    measured = [(body.member, body.measurement) for body in bodies if body.measurement is not None]
    names[MEMBERS_HIDDEN] = [
        member.name
        for member, measurement in measured
        if any(each.code == HIDDEN_OBJECT_MEASURED for each in measurement.findings)
    ]
    names[MEMBERS_DENSITY_UNSET] = [
        member.name
        for member, measurement in measured
        if unset_density(member.data, measurement, scene) is not None
    ]
    for code, members in names.items():
        if members:
            yield finding(code, count=len(members), names=members)
    yield from open_body_caveats((member.name, result.method) for member, result in measured)
    for body in bodies[1:]:
        for each in body.findings:
            if each.code == ASSEMBLY_MASS_GIVEN:
                yield each.of_sources([body.member.name])


_LEFT_OUT: dict[str, str] = {
    MEMBER_COUNTED_BEFORE: MEMBERS_COUNTED_BEFORE,
    BOOLEAN_OPERAND: MEMBERS_LEFT_OUT,
    NOT_RENDERED: MEMBERS_LEFT_OUT,
}


def _object_body(member: Member, result: stack.Measured | Finding) -> MemberBody:
    """Return the body of a measured object, without its children, or of a refusal."""
    if isinstance(result, Finding):
        return MemberBody(member, refusal=result)
    measurement = result.measurement
    moments, factor = measurement.mass_moments
    power = 0 if member.data.body_moments.mass_from == "MASS" else POWERS[measurement.kind]
    mass = replace(moments.truncate(KNOWN_ORDER), measure=Measure.MASS) * factor
    return MemberBody(
        member,
        {power: mass},
        extent_of(measurement, "volume"),
        extent_of(measurement, "area"),
        measured=result,
        measurement=measurement,
    )


def _sum(
    like: MemberBody, bodies: Iterable[MemberBody], parts: tuple[MemberBody, ...]
) -> MemberBody:
    """Return a copy of `like` with `parts`, and the sums of the masses, volumes and areas of bodies
    with a mass.
    """
    bodies = [body for body in bodies if body.masses]
    masses: dict[int, list[Moments]] = {}
    for body in bodies:
        for power, moments in body.masses.items():
            masses.setdefault(power, []).append(moments)
    return replace(
        like,
        masses={power: sum_moments(several) for power, several in masses.items()},
        volume=add_extents([body.volume for body in bodies]),
        area=add_extents([body.area for body in bodies]),
        parts=parts,
    )


def _with_given_mass(whole: MemberBody, unit: float) -> MemberBody:
    """Return the body of a collection or an empty with children, with its given mass if the
    settings have one.
    """
    data = whole.member.data
    settings = settings_of(data)
    if settings.mass_from != "MASS":
        return whole
    given = GivenPart.from_settings(settings, unit)
    mass = shortest_decimal(settings.mass)
    rotation = np.eye(3)
    location = np.zeros(3)
    if isinstance(data, bpy.types.Object):
        place, quaternion, _scale = data.matrix_world.decompose()
        rotation = rotation_matrix(quaternion)
        location = np.array(place[:], np.float64) * unit
    try:
        moments, findings = given_moments(mass, given, rotation, location, whole.mass)
    except MeasureError as error:
        return replace(whole, masses={}, refusal=error.finding)
    if whole.mass is None and given.center is None and isinstance(data, bpy.types.Collection):
        findings.append(finding(GIVEN_CENTER, fault=CENTER_MISSING))
    findings.insert(0, finding(ASSEMBLY_MASS_GIVEN, mass=mass))
    return replace(whole, masses={0: moments}, findings=tuple(findings))


def _is_sheared(member: Member) -> bool:
    """Return whether an instance stretches its members unevenly, so that their areas have no common
    factor.
    """
    return (
        member.matrix is not None and not are_similarities(np.array([member.matrix])[:, :3, :3])[0]
    )


def _instance_body(whole: MemberBody, results: Results, unit: float) -> MemberBody:
    """Return the body of a collection instance: the moments of its members, mapped to its place, or
    a refusal.
    """
    member = whole.member
    assert member.matrix is not None
    matrix = to_si([member.matrix], unit)[0]
    matrix[:3, :3] /= unit  # the members are in SI units already
    volume_factor = abs(np.linalg.det(matrix[:3, :3]))
    nothing = replace(whole, masses={}, volume=NOTHING, area=NOTHING)
    if not volume_factor > 0.0:
        return replace(nothing, refusal=finding(SCALE_ZERO_AXIS))
    sheared = _is_sheared(member)
    # Uneven stretching multiplies all volumes by one factor, but not areas and lengths.
    if sheared and not {0, 3}.issuperset(whole.masses):
        return replace(nothing, refusal=finding(INSTANCE_STRETCHES_SHEETS))
    masses = {
        power: moments.transform(matrix) * (volume_factor ** (power / 3.0) if power else 1.0)
        for power, moments in whole.masses.items()
    }
    area = _scale_extent(whole.area, volume_factor ** (2.0 / 3.0))
    if sheared:
        result = results[member.data]  # the instance as one object
        if isinstance(result, Finding):
            return replace(nothing, refusal=result)
        area = extent_of(result.measurement, "area")
    volume = _scale_extent(whole.volume, volume_factor)
    return replace(whole, masses=masses, volume=volume, area=area)


def _scale_extent(extent: Extent, factor: float) -> Extent:
    value, rounding, inputs = extent
    return value * factor, rounding * factor, inputs * factor
