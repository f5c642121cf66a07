# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of measured bodies to the links of a robot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from ..measurement.measurement import Measurement
from ..numerics.rotations import quaternion, rotation_matrix
from ..verdict.finding import Finding, finding
from .findings import (
    JOINT_VALUE_UNUSABLE,
    JOINTS_CLOSE_LOOP,
    JOINTS_WITHOUT_LINKS,
    ROBOT_LINKS_LEFT_OUT,
    ROBOT_WITHOUT_LINKS,
)
from .model import FreeAxis, Inertial, Joint, Link, Mimic, Pose, Robot, Shape


class Candidate(NamedTuple):
    """A measured body. link: None if the body has no mass.

    parents: names of other candidates, the nearest first. free: its degrees of freedom relative to its parent.
    """

    name: str
    link: Link | None
    parents: Sequence[str] = ()
    free: tuple[FreeAxis, ...] = ()
    mimic: Mimic | None = None


class Connection(NamedTuple):
    """A joint between two candidates, "" for anything else. pose: its frame in the world, m.

    free: freedom of `second` relative to `first`, the axis next to `first` first.
    """

    name: str
    first: str
    second: str
    pose: Pose
    free: tuple[FreeAxis, ...] = ()
    mimic: Mimic | None = None


def robot_name(file: str | None) -> str:
    """Return a robot's name: the file's name without its suffix, else "robot"."""
    return PurePath(file).stem if file else "robot"


def make_candidate(
    name: str,
    measurement: Measurement,
    parents: Sequence[str] = (),
    scale: Sequence[float] = (1.0, 1.0, 1.0),
    free: tuple[FreeAxis, ...] = (),
    mimic: Mimic | None = None,
    is_fixed: bool = False,
) -> Candidate:
    """Return a candidate with the measured body as a link in its own frame. scale: (3,) of the object's geometry."""
    body = measurement.in_object_frame()
    if not body.mass:
        return Candidate(name, None)
    frame = body.principal
    inertial = Inertial.with_agreeing_axes(body.mass, body.center, body.inertia, frame.moments, frame.axes)
    pose = Pose(measurement.location, rotation_matrix(quaternion(measurement.rotation)))
    shapes = () if measurement.kind == "wire" else (Shape("mesh", sheet=measurement.kind == "shell"),)
    return Candidate(name, Link(name, inertial, pose, shapes, np.array(scale), is_fixed), parents, free, mimic)


def assemble_robot(
    name: str,
    candidates: Sequence[Candidate],
    connections: Sequence[Connection] = (),
    fixed_base: bool = False,
) -> tuple[Robot, list[Finding]]:
    """Return a robot of the candidates with mass, joined to their nearest parents, and findings.

    connections: joints that take the place of the fixed joint to a parent, or hold links that have no parent.
    fixed_base: whether all roots are fixed to the world.
    """
    links = {one.name: one.link for one in candidates if one.link is not None}
    parents = {}
    for one in candidates:
        parent = next((above for above in one.parents if above in links and above != one.name), None)
        if parent is not None and one.name in links:
            parents[one.name] = parent
    loose = [one.name for one in connections if (one.first in links) != (one.second in links)]
    whole = [one for one in connections if one.first in links and one.second in links]
    edges, loops = _spanning_edges(links, parents, whole)
    own = {one.name: (one.free, one.mimic) for one in candidates}
    joints, findings = _check_mimics(_directed_joints(links, parents, edges, own))
    if fixed_base:
        below = {joint.child for joint in joints}
        links = {key: replace(link, is_fixed=link.is_fixed or key not in below) for key, link in links.items()}
    if loose:
        findings.append(finding(JOINTS_WITHOUT_LINKS, count=len(loose), joints=loose))
    if loops:
        findings.append(finding(JOINTS_CLOSE_LOOP, count=len(loops), joints=loops))
    left_out = [one.name for one in candidates if one.link is None]
    if left_out:
        findings.append(finding(ROBOT_LINKS_LEFT_OUT, count=len(left_out), links=left_out))
    if not links:
        findings.append(finding(ROBOT_WITHOUT_LINKS))
    return Robot(name, tuple(links.values()), tuple(joints)), findings


_Edge = tuple[str, str, Connection | None]  # the side of the parent, the side of the child


def _spanning_edges(
    links: Mapping[str, Link], parents: Mapping[str, str], connections: Sequence[Connection]
) -> tuple[list[_Edge], list[str]]:
    """Return edges that make trees of the links, and the names of connections that would close a loop.

    All fixed links count as one, the world.
    """
    group: dict[str | None, str | None] = {}

    def top(name: str | None) -> str | None:
        while name in group:
            name = group[name]
        return name

    def join(first: str | None, second: str | None) -> bool:
        first, second = top(first), top(second)
        if first == second:
            return False
        if first is None:
            first, second = second, first
        group[first] = second
        return True

    between: dict[frozenset[str], Connection] = {}
    for one in connections:
        between.setdefault(frozenset((one.first, one.second)), one)
    edges: list[_Edge] = []
    for child, parent in parents.items():
        both_fixed = links[child].is_fixed and links[parent].is_fixed
        edges.append((parent, child, None if both_fixed else between.get(frozenset((parent, child)))))
        join(parent, child)
    for link in links.values():
        if link.is_fixed:
            join(link.name, None)
    used, loops = {id(one) for *_, one in edges if one is not None}, []
    for one in connections:
        if id(one) in used:
            continue
        if join(one.first, one.second):
            edges.append((one.first, one.second, one))
        else:
            loops.append(one.name)
    return edges, loops


def _directed_joints(
    links: Mapping[str, Link],
    parents: Mapping[str, str],
    edges: Sequence[_Edge],
    own: Mapping[str, tuple[tuple[FreeAxis, ...], Mimic | None]],
) -> list[Joint]:
    """Return the edges as joints, from fixed links or from the top of parents and first sides to the others."""
    above: dict[str, str] = {}
    at: dict[str, list[_Edge]] = {name: [] for name in links}
    for edge in edges:
        first, second, _ = edge
        above.setdefault(second, first)  # Parents come first.
        at[first].append(edge)
        at[second].append(edge)

    def path_up(name: str) -> list[str]:
        path = [name]
        while path[-1] in above:
            path.append(above[path[-1]])
        return path

    fixed = sorted((link.name for link in links.values() if link.is_fixed), key=lambda name: len(path_up(name)))
    joints: dict[str, Joint] = {}
    visited: set[str] = set()
    taken: set[str] = set()
    for root in [*fixed, *(path_up(name)[-1] for name in links)]:
        if root in visited:
            continue
        visited.add(root)
        waiting = [root]
        while waiting:
            parent = waiting.pop()
            for first, second, connection in at[parent]:
                child = second if first == parent else first
                if child in visited:
                    continue
                visited.add(child)
                waiting.append(child)
                name = _free_name("{}_joint".format(child) if connection is None else connection.name, taken)
                is_parent = parents.get(child) == parent
                if connection is None:
                    free, mimic = own[child] if is_parent else ((), None)
                    joints[child] = Joint(name, parent, child, free, mimic=mimic)
                    continue
                free = connection.free
                if connection.first != parent:
                    free = tuple(axis.reverse() for axis in reversed(free))
                pose = links[child].pose.inverse() @ connection.pose
                joints[child] = Joint(name, parent, child, free, pose, connection.mimic)
    return [joints[name] for name in links if name in joints]


def _free_name(name: str, taken: set[str]) -> str:
    """Return a name that is not taken, and take it."""
    free, count = name, 1
    while free in taken:
        count += 1
        free = "{}_{}".format(name, count)
    taken.add(free)
    return free


def _check_mimics(joints: Iterable[Joint]) -> tuple[list[Joint], list[Finding]]:
    """Return the joints, with mimics that name other joints of one axis, and findings about mimics that do not."""
    joints, findings = list(joints), []
    single = {joint.child: joint.name for joint in joints if len(joint.free) == 1}
    single.update({name: name for name in single.values()})
    for index, joint in enumerate(joints):
        if joint.mimic is None:
            continue
        leader, mimic = single.get(joint.mimic.joint), None
        if leader is None or leader == joint.name or joint.name not in single:
            named = joint.mimic.joint
            findings.append(finding(JOINT_VALUE_UNUSABLE, joint=joint.name, key="joint_mimic", value=named))
        else:
            mimic = joint.mimic._replace(joint=leader)
        joints[index] = replace(joint, mimic=mimic)
    return joints, findings
