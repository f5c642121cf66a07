# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links and joints of a robot from measured bodies and the connections between them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from ..measurement import Measurement
from ..numerics import quaternion, rotation_matrix
from ..verdict import Finding, finding
from .findings import (
    CLOSE_LOOP,
    JOINT_VALUE_UNUSABLE,
    JOINTS_LEFT_OUT,
    ROBOT_LINKS_LEFT_OUT,
    ROBOT_WITHOUT_LINKS,
    WITHOUT_LINK,
)
from .model import FreeAxis, Inertial, Joint, Link, Mimic, Pose, Robot, Shape


class Candidate(NamedTuple):
    """A measured body. link: None if the body has no mass. parents: names of other candidates, the
    nearest first.
    """

    name: str
    link: Link | None
    parents: Sequence[str] = ()


class Connection(NamedTuple):
    """A joint between two candidates; "" stands for any object that is no candidate.

    pose: the frame of the joint in the world, m; by default the second's. free: freedom of `second`
    relative to `first`, the axis next to `first` first.
    """

    name: str
    first: str
    second: str
    pose: Pose | None = None
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
    is_fixed: bool = False,
) -> Candidate:
    """Return a candidate with the measured body as a link in its own frame. scale: (3,) of the
    object's geometry.
    """
    body = measurement.in_object_frame()
    if not body.mass:
        return Candidate(name, None)
    frame = body.principal
    inertial = Inertial.with_agreeing_axes(
        body.mass, body.center, body.inertia, frame.moments, frame.axes
    )
    pose = Pose(measurement.location, rotation_matrix(quaternion(measurement.rotation)))
    shapes = (
        () if measurement.kind == "wire" else (Shape("mesh", sheet=measurement.kind == "shell"),)
    )
    return Candidate(name, Link(name, inertial, pose, shapes, np.array(scale), is_fixed), parents)


def assemble_robot(
    name: str, candidates: Sequence[Candidate], connections: Iterable[Connection] = ()
) -> tuple[Robot, list[Finding]]:
    """Return a robot of the candidates with mass, and findings.

    A connection takes the place of the fixed joint to a parent, or holds links that have no parent.
    """
    links = {one.name: one.link for one in candidates if one.link is not None}
    nearest = {
        one.name: next((name for name in one.parents if name in links and name != one.name), None)
        for one in candidates
        if one.link is not None
    }
    parents = {child: parent for child, parent in nearest.items() if parent is not None}
    loose = [one.name for one in connections if (one.first in links) != (one.second in links)]
    edges, loops = _spanning_edges(
        links, parents, [one for one in connections if {one.first, one.second} <= {*links}]
    )
    joints, findings = _check_mimics(_directed_joints(links, edges))
    left_out = [one.name for one in candidates if one.link is None]
    for unused, cause in ((loose, WITHOUT_LINK), (loops, CLOSE_LOOP)):
        if unused:
            findings.append(finding(JOINTS_LEFT_OUT, joints=unused, cause=cause))
    if left_out:
        findings.append(finding(ROBOT_LINKS_LEFT_OUT, count=len(left_out), links=left_out))
    if not links:
        findings.append(finding(ROBOT_WITHOUT_LINKS))
    return Robot(name, tuple(links.values()), tuple(joints)), findings


def _spanning_edges(
    links: Mapping[str, Link], parents: Mapping[str, str], connections: Sequence[Connection]
) -> tuple[list[Connection], list[str]]:
    """Return edges that make trees of the links, those to parents first, and the names of
    connections that would close a loop. parents: by the names of their children.

    All fixed links count as one, the world, which has no name.
    """
    groups = _Groups()
    between = {frozenset((one.first, one.second)): one for one in reversed(connections)}
    edges = []
    names = {one.name for one in connections}
    for child, parent in parents.items():
        edge = between.get(frozenset((parent, child)))
        if edge is None or links[child].is_fixed and links[parent].is_fixed:
            name = "{}_joint".format(child)
            edge = Connection(name + "_" * (name in names), parent, child)
        # The side of the parent comes first.
        edges.append(edge if edge.first == parent else _exchange(edge, links))
        groups.join(parent, child)
    for link in links.values():
        if link.is_fixed:
            groups.join("", link.name)
    used = {edge.name for edge in edges} & names
    loops = []
    for connection in connections:
        if connection.name in used:
            continue
        if groups.join(connection.first, connection.second):
            edges.append(connection)
        else:
            loops.append(connection.name)
    return edges, loops


class _Groups:
    """Groups of links that are connected, each with one of them as its top."""

    def __init__(self) -> None:
        self._above: dict[str, str] = {}

    def join(self, first: str, second: str) -> bool:
        """Join the groups of two links. Return False if they are one already."""
        low, high = sorted((self._top(first), self._top(second)))
        if low == high:
            return False
        self._above[high] = low
        return True

    def _top(self, name: str) -> str:
        while name in self._above:
            name = self._above[name]
        return name


def _exchange(edge: Connection, links: Mapping[str, Link]) -> Connection:
    """Return the connection of the same positions as seen from its other side."""
    free = tuple(axis.reverse() for axis in reversed(edge.free))
    return edge._replace(
        first=edge.second, second=edge.first, pose=edge.pose or links[edge.second].pose, free=free
    )


def _directed_joints(links: Mapping[str, Link], edges: Sequence[Connection]) -> list[Joint]:
    """Return the edges, which make trees, as joints that lead away from the roots, in the order of
    the child links.

    Each fixed link is a root, unless a joint from another one reaches it first; those near to their
    top are the first. The top of a link is reached from second to first sides of edges, and is the
    root of a tree without fixed links.
    """
    first_side_of: dict[str, str] = {}
    edges_at: dict[str, list[Connection]] = {name: [] for name in links}
    for edge in edges:
        first_side_of.setdefault(edge.second, edge.first)
        edges_at[edge.first].append(edge)
        edges_at[edge.second].append(edge)

    def path_up(name: str) -> list[str]:
        """Return the links from a link to its top."""
        path = [name]
        while path[-1] in first_side_of:
            path.append(first_side_of[path[-1]])
        return path

    fixed = sorted(
        (link.name for link in links.values() if link.is_fixed), key=lambda name: len(path_up(name))
    )
    joints: dict[str, Joint] = {}
    visited: set[str] = set()
    for root in [*fixed, *(path_up(name)[-1] for name in links)]:
        waiting = [root] if root not in visited else []
        while waiting:
            parent = waiting.pop()
            visited.add(parent)
            for either_way in edges_at[parent]:
                edge = either_way if either_way.first == parent else _exchange(either_way, links)
                child = edge.second
                if child in visited:
                    continue
                waiting.append(child)
                pose = Pose() if edge.pose is None else links[child].pose.inverse() @ edge.pose
                joints[child] = Joint(edge.name, parent, child, edge.free, pose, edge.mimic)
    return [joints[name] for name in links if name in joints]


def _check_mimics(joints: Iterable[Joint]) -> tuple[list[Joint], list[Finding]]:
    """Return the joints, with mimics that name other joints of one axis, and findings about mimics
    that do not.
    """
    checked = [*joints]
    findings = []
    # Joints of one axis by the name of their child, and by their own, which comes first.
    single = {joint.child: joint.name for joint in checked if len(joint.free) == 1}
    single |= {name: name for name in single.values()}
    for index, joint in enumerate(checked):
        mimic = joint.mimic
        if mimic is None:
            continue
        leader = single.get(mimic.joint, joint.name)  # itself, if there is none
        is_usable = leader != joint.name and joint.name in single
        if not is_usable:
            findings.append(
                finding(
                    JOINT_VALUE_UNUSABLE, joint=joint.name, key="joint_mimic", value=mimic.joint
                )
            )
        checked[index] = replace(joint, mimic=mimic._replace(joint=leader) if is_usable else None)
    return checked, findings
