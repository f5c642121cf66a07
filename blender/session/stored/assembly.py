# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stored results of an assembly: on it, on its assemblies and measured objects; its tree and
bill of masses.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from math import dist, hypot

import bpy
import numpy as np
from bpy.types import Context, Object, PropertyGroup
from mathutils import Matrix

from ....core.bodies import DENSITY_DEFAULTED
from ....core.inertia import TENSOR, PlainBody, add_bodies
from ....core.measurement import digest, find_properties, table
from ....core.verdict import Finding, Severity, finding, internal_error, of_severity, sentence
from ... import read, scale, write
from ...bodies.assembly.measure import Assembly, MemberBody, assembly_measurement
from ...bodies.findings import ASSEMBLY_MASS_GIVEN, MEMBERS_DENSITY_UNSET
from ...bodies.stack import Measured
from ..tracking import handlers, staleness, stamps
from . import reference, results

# relative to mass and radius of gyration: other coordinates of the same body may change as much
SAME_RTOL = 1e-5
COLUMNS = (
    *("level", "name", "type", "counted", "method", "mass", "share", "density", "volume", "area"),
    *(f"center_of_mass_{axis}" for axis in "xyz"),
    *(f"inertia_{name}" for name, *_ in TENSOR),
    *(
        "principal_moment_1",
        "principal_moment_2",
        "principal_moment_3",
        "notes",
        "warnings",
        "left_out",
    ),
)


def store(context: Context, assembly: Assembly) -> list[tuple[str, Finding]]:
    """Store the results of an assembly and its members; return names of members that cannot hold
    them, and reasons.
    """
    scene = context.scene
    depsgraph = context.evaluated_depsgraph_get()
    unit = scale.meters_per_unit(scene)
    root = assembly.root.member.data
    about = reference.stored_choice(root)
    write.properties.store(root, assembly.measurement)
    reference.follow(root, scene, about)
    visited: dict[read.assembly.Root, None] = {root: None}
    failures: list[tuple[str, Finding]] = []
    measured: list[tuple[Object, Measured]] = []
    # An assembly comes before the point mass that the same object may be, and is stored alone.
    for part in assembly.root.walk():
        data = part.member.data
        if data in visited:
            continue
        visited[data] = None
        if part.measured is not None:
            measured.append((data, part.measured))
        elif (
            part.member.kind
            in (read.assembly.MemberKind.COLLECTION, read.assembly.MemberKind.EMPTY)
            and part.masses
        ):
            try:
                write.properties.store(data, assembly_measurement(part, depsgraph, unit))
            except Exception as error:
                failures.append((data.name_full, internal_error.finding_of(error)))
    _write_rows(assembly)
    return failures + [
        (obj.name_full, internal_error.finding_of(refusal))
        for obj, refusal in results.store_measured(context, measured).items()
    ]


def clear(root: read.assembly.Root) -> bool:
    """Remove the results of an assembly; return whether there were any; EditRefusedError if it
    cannot be changed.
    """
    write.properties.require_storable(root)
    read.assembly.settings_of(root).rows.clear()
    return write.properties.clear(root)


@contextmanager
def kept_up_to_date(context: Context, member: Object | None = None) -> Iterator[None]:
    """Keep assemblies up to date while a block gives members other frames, or stores other masses
    of them.

    A total that is the plain sum of its members follows their masses. An assembly keeps its old
    stamp, and so goes out of date, if a member's results are out of date, or if instances or given
    masses are in its total. member: the only one that changes, without an update of the scene.
    """
    scene = context.scene
    depsgraph = context.view_layer.depsgraph
    roots = [scene.collection, *scene.collection.children_recursive, *scene.objects]
    stored = [
        root for root in roots if "body_fingerprint" in root and read.assembly.is_assembly(root)
    ]
    if depsgraph is None or not stored:
        yield
        return
    if member is None:
        depsgraph = context.evaluated_depsgraph_get()
    bodies_before = {
        root: _member_bodies(read.assembly.members_of(root, depsgraph))
        for root in stored
        if staleness.was_current(root, scene)
    }
    if member is not None:
        bodies_before = {root: bodies for root, bodies in bodies_before.items() if member in bodies}
    yield
    if member is None:
        depsgraph = context.evaluated_depsgraph_get()
    for root, before in bodies_before.items():
        handlers.count_change(root)
        tree = read.assembly.members_of(root, depsgraph)
        stamp = stamps.stamp_of(root)
        now = _member_bodies(tree)
        if (
            stamp is None
            or before.keys() != now.keys()
            or any(staleness.stale_reason(obj, scene) for obj in now)
        ):
            continue
        key = read.assembly.members_key(
            tree, {obj: write.properties.fingerprint(obj) for obj in now}
        )
        text = stamp._replace(geometry=digest(key.encode())).text
        if all(_is_same(before[obj], now[obj]) for obj in now):
            root["body_fingerprint"] = text
            _follow_defaults(root, now)
        elif _is_sum(root, before) and (total := add_bodies([*now.values()])) is not None:
            matrix = getattr(root, "matrix_world", Matrix())
            write.properties.store_body(
                root, total.in_object(matrix, scale.meters_per_unit(scene)), text
            )
            _add_gains(
                root, {obj.name: now[obj].mass - before[obj].mass for obj in now}, total.mass
            )
            _follow_defaults(root, now)


def _follow_defaults(root: read.assembly.Root, members: Collection[Object]) -> None:
    """Let the warning about members of the default density follow the findings of these members."""
    findings = write.properties.findings(root)
    member_names = {obj.name for obj in members}
    unset = [
        obj.name
        for obj in members
        if DENSITY_DEFAULTED
        in [stored_finding.code for stored_finding in write.properties.findings(obj)]
    ]
    for stored_finding in findings:
        if stored_finding.code == MEMBERS_DENSITY_UNSET:
            unset = [
                *(name for name in stored_finding.values["names"] if name not in member_names),
                *unset,
            ]
    warning = [finding(MEMBERS_DENSITY_UNSET, count=len(unset), names=unset)] if unset else []
    write.properties.store_findings(
        root,
        [
            *(
                stored_finding
                for stored_finding in findings
                if stored_finding.code != MEMBERS_DENSITY_UNSET
            ),
            *warning,
        ],
    )


def _is_sum(root: read.assembly.Root, bodies: dict[Object, PlainBody]) -> bool:
    """Return whether the stored total of an assembly is the sum of these bodies, in the world."""
    total = add_bodies([*bodies.values()])
    stored_total = write.properties.stored(root)
    if total is None or stored_total is None:
        return False
    return _is_same(
        total,
        stored_total.in_world(
            getattr(root, "matrix_world", Matrix()), scale.meters_per_unit(bpy.context.scene)
        ),
    )


def _add_gains(root: read.assembly.Root, gains: dict[str, float], mass: float) -> None:
    """Add the gains of objects in kg, by name, to their rows and to those of the assemblies that
    they are in, and renew all shares of the total mass.
    """
    above: list[PropertyGroup] = []  # the present row, and those of the assemblies that it is in
    for row in read.assembly.settings_of(root).rows:
        above = [*(upper for upper in above if upper.depth < row.depth), row]
        gain = (
            gains.get(row.name, 0.0) if row.member == read.assembly.MemberKind.OBJECT.value else 0.0
        )
        for part in above if gain else ():
            part.mass += gain
    for row in read.assembly.settings_of(root).rows:
        row.share = row.mass / mass if row.is_counted else 0.0


def _member_bodies(root: read.assembly.Member) -> dict[Object, PlainBody]:
    """Return the stored results of an assembly's measured objects, in the world."""
    unit = scale.meters_per_unit(bpy.context.scene)
    objects = [
        member.data
        for member in root.walk()
        if member.kind == read.assembly.MemberKind.OBJECT and member.is_measured
    ]
    stored = [(obj, write.properties.stored(obj)) for obj in objects]
    return {obj: body.in_world(obj.matrix_world, unit) for obj, body in stored if body is not None}


def _is_same(before: PlainBody, now: PlainBody) -> bool:
    """Return whether two bodies in the world have the same mass, center and size up to rounding."""
    size = hypot(*before.gyration)
    size_now = hypot(*now.gyration)
    return (
        abs(now.mass - before.mass) <= SAME_RTOL * before.mass
        and dist(now.center, before.center) <= SAME_RTOL * max(size, *map(abs, now.center))
        and abs(size_now - size) <= SAME_RTOL * size
    )


def _write_rows(assembly: Assembly) -> None:
    tree_rows = read.assembly.settings_of(assembly.root.member.data).rows
    tree_rows.clear()
    mass = assembly.measurement.mass_properties.mass
    for depth, part, factor, counted in _tree(assembly.root, 0, 1.0, True):
        row = tree_rows.add()
        row.name = part.member.name
        row.depth = depth
        row.member = part.member.kind.value
        own_mass = _own_mass(part) * factor
        row.is_counted = counted and own_mass > 0.0
        row.mass = own_mass
        row.share = own_mass / mass if counted else 0.0
        row.findings = write.properties.findings_text(_row_findings(part))


def _tree(
    part: MemberBody, depth: int, factor: float, counted: bool
) -> Iterator[tuple[int, MemberBody, float, bool]]:
    """Yield for each member its depth, itself, the factor of its mass, and whether its mass counts.

    Below an instance the factor scales the masses of its collection's members to that of the
    instance. Below a given mass no member counts.
    """
    yield depth, part, factor, counted
    below = sum([_own_mass(member) for member in part.parts], 0.0)
    if part.member.kind == read.assembly.MemberKind.INSTANCE and below > 0.0:
        factor *= _own_mass(part) / below
    is_given = any(finding.code == ASSEMBLY_MASS_GIVEN for finding in part.findings)
    for member in part.parts:
        yield from _tree(member, depth + 1, factor, counted and not is_given)


def _own_mass(part: MemberBody) -> float:
    return 0.0 if part.mass is None else part.mass.total


def _row_findings(part: MemberBody) -> list[Finding]:
    """Return the reason for leaving out a member, or the findings about it."""
    if part.member.left_out is not None:
        return [part.member.left_out]
    if part.refusal is not None:
        return [part.refusal]
    if part.measurement is not None:
        return of_severity(part.measurement.findings, Severity.WARNING, Severity.ERROR)
    return list(part.findings)


def bill_csv(root: MemberBody, mass: float) -> list[str]:
    """Return the lines of the bill of an assembly with this mass, kg, as CSV: the header, then its
    rows.

    SI units; the inertia of a member is about its own center of mass, along the world axes.
    """
    return list(
        table(
            COLUMNS,
            (
                _bill_row(part, mass, level, counted)
                for level, part, _, counted in _tree(root, 0, 1.0, True)
            ),
        )
    )


def _bill_row(part: MemberBody, mass: float, level: int, counted: bool) -> dict[str, object]:
    """Return the row of a member. mass: of the whole, kg. level: number of assemblies around the
    member. counted: whether its mass is a part of the whole.
    """
    moments = part.mass
    measurement = part.measurement
    findings = part.findings if measurement is None else measurement.findings
    row: dict[str, object] = {
        "level": level,
        "name": part.member.name,
        "type": part.member.kind.value.lower(),
        "counted": counted and moments is not None,
        "method": "" if measurement is None else str(measurement.method),
        "notes": [sentence(note) for note in of_severity(findings, Severity.NOTE)],
        "warnings": [
            sentence(note) for note in of_severity(findings, Severity.WARNING, Severity.ERROR)
        ],
    }
    reason = part.member.left_out or part.refusal
    if reason is not None:
        row["left_out"] = sentence(reason)
    if moments is not None:
        properties = find_properties(moments, np.eye(3))
        volume = part.volume[0]
        row |= {"mass": properties.mass, "volume": volume, "area": part.area[0]}
        row |= {"share": moments.total / mass} if counted else {}
        row |= {"density": moments.total / volume} if volume else {}
        row |= {
            f"center_of_mass_{axis}": float(value) for axis, value in zip("xyz", properties.center)
        }
        row |= {f"inertia_{name}": float(properties.inertia[i, j]) for name, i, j in TENSOR}
        row |= {
            f"principal_moment_{k}": float(value)
            for k, value in enumerate(properties.principal.moments, start=1)
        }
    return row
