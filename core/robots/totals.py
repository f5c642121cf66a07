# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tree of a description's joints, and mass, center and inertia of the model and its subtrees.

Everything is along the axes of the model: the root link of URDF, the world of MJCF and USD, the
model of SDF, or the world if there are several.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from ..numerics import Array
from ..verdict import Finding, finding
from .entries import Entry
from .findings import AUDIT_JOINT, AUDIT_TOTAL, JOINT_VALUE_UNUSABLE
from .model import Pose
from .plausibility import LARGEST
from .stated import (
    Description,
    Motion,
    Place,
    StatedInertial,
    StatedJoint,
    StatedLink,
    parallel_axis_term,
)

MOVABLE = ("hinge", "slide")
NOWHERE = Place()


class Body(NamedTuple):
    """Mass, kg, (3,) center, m, and (3, 3) inertia about it, kg·m²; both None if unknown."""

    mass: float = 0.0
    center: Array | None = None
    inertia: Array | None = None

    def add(self, other: Body) -> Body:
        """Return the total of both bodies."""
        if not self.mass or not other.mass:  # A body without mass adds nothing.
            return self if self.mass else other
        mass = self.mass + other.mass
        if (
            self.center is None
            or other.center is None
            or self.inertia is None
            or other.inertia is None
        ):
            return Body(mass)
        arm = other.center - self.center
        share = other.mass / mass
        # Both about the common center: the reduced mass m_1 m_2/(m_1 + m_2) at the arm.
        term = parallel_axis_term(share * self.mass, arm)
        return Body(mass, self.center + share * arm, self.inertia + other.inertia + term)


@dataclass(frozen=True, eq=False)
class Tree:
    """Links by their names, the joint above each, and their poses in the model; None if unknown."""

    description: Description
    above: Mapping[str, StatedJoint]
    poses: Mapping[str, Pose | None]
    entries: Sequence[Entry] = ()


@dataclass(frozen=True, eq=False)
class Totals:
    """The whole model, and each subtree by the name of its first link.

    missing: links with geometry but without inertial. frames: links without both, which count
    nothing. impossible: links whose inertial no body has. left_out: those of them that count
    nothing, as the mass is no positive number.
    """

    whole: Body
    subtrees: Mapping[str, Body]
    missing: Sequence[str]
    frames: Sequence[str]
    impossible: Sequence[str]
    left_out: Sequence[str]


class Expectation(NamedTuple):
    """The expected mass, kg, and center, m, and the relative tolerance."""

    mass: float | None = None
    center: tuple[float, ...] | None = None
    within: float = 0.01

    def check(self, whole: Body) -> list[Finding]:
        """Return findings about numbers that differ. The tolerance of the center is a part of the
        radius of gyration.
        """
        findings = []
        if self.mass is not None and not abs(whole.mass - self.mass) <= self.within * self.mass:
            texts = ("{:.6g} kg".format(mass) for mass in (whole.mass, self.mass))
            findings.append(_unexpected("mass", *texts))
        if self.center is None:
            return findings
        text = "unknown"
        if whole.center is not None and whole.inertia is not None:
            # The radius of gyration about the center: tr(I)/2 = ∫r² dm.
            radius = sqrt(max(float(np.trace(whole.inertia)), 0.0) / 2.0 / whole.mass)
            if np.linalg.norm(whole.center - self.center) <= self.within * radius:
                return findings
            text = _point(whole.center.tolist())
        return [*findings, _unexpected("center", text, _point(self.center))]


def _unexpected(part: str, value: str, expected: str) -> Finding:
    return finding(AUDIT_TOTAL, part=part, value=value, expected=expected)


def _point(numbers: Sequence[float]) -> str:
    return "{:.6g},{:.6g},{:.6g} m".format(*numbers)


def build_tree(description: Description, values: Mapping[str, float]) -> Tree:
    """Return the tree of a description's links, with their poses. values: of joints, by their
    names, radians or meters; others are at zero.
    """
    links: dict[str, StatedLink] = {}
    for link in description.links:
        links.setdefault(link.name, link)
    above, entries = _joints_above(description, links)
    positions, wrong = _joint_values(above, values, description.format == "mjcf")
    entries += wrong
    roots = links.keys() - above.keys()
    if description.format == "urdf" and len(roots) == 1:  # The root's frame is the model's.
        (root,) = roots
        links[root] = replace(links[root], pose=Pose())
    poses: dict[str, Pose | None] = {}
    for name in _parents_first(links, above):
        joint = above.get(name)
        with np.errstate(invalid="ignore", over="ignore"):
            pose = _pose(links, joint, links[name], poses, positions)
        if pose is not None and not (np.abs(pose.matrix) <= LARGEST).all():
            pose = None
            cause = "its place is no number, or too far away. Correct its origin"
            place = joint.place if joint else links[name].place
            entries.append(_unusable(joint.name if joint and joint.name else name, cause, place))
        poses[name] = pose
    return Tree(description, above, poses, entries)


def _joints_above(
    description: Description, links: Mapping[str, StatedLink]
) -> tuple[dict[str, StatedJoint], list[Entry]]:
    """Return the usable joint above each link that has one, without loops, and entries about
    others.
    """
    entries = [Entry(found, Place(found.values.get("line", 1))) for found in description.findings]
    above: dict[str, StatedJoint] = {}
    for joint in description.joints:
        cause = ""
        if joint.child not in links:
            cause = "its child is no link of the file. Name one that is"
        elif joint.parent not in links and (joint.parent or description.format == "urdf"):
            cause = "its parent is no link of the file. Name one that is"
        elif joint.child in above:
            cause = (
                "its child has a parent already, so that it closes a loop. Keep one of both joints"
            )
        if cause:
            entries.append(_unusable(joint.name or joint.child, cause, joint.place))
        else:
            above[joint.child] = joint
    for joint in _looping_joints(above):
        del above[joint.child]
        cause = "it closes a loop, which has no root. Remove it, or give another parent"
        entries.append(_unusable(joint.name or joint.child, cause, joint.place))
    return above, entries


def _unusable(name: str, cause: str, place: Place = NOWHERE) -> Entry:
    return Entry(finding(AUDIT_JOINT, joint=name, cause=cause), place)


def _looping_joints(above: Mapping[str, StatedJoint]) -> list[StatedJoint]:
    """Return one joint of each loop."""
    looping = []
    start_of: dict[str, str] = {}  # The link from which each visited one was reached.
    for start in above:
        name = start
        while name in above and name not in start_of:
            start_of[name] = start
            name = above[name].parent
        if start_of.get(name) == start:  # The way up has met itself.
            looping.append(above[name])
    return looping


def _parents_first(
    links: Mapping[str, StatedLink], above: Mapping[str, StatedJoint]
) -> Iterator[str]:
    """Yield the names of all links, each after its parent, else in the order of the file."""
    done: set[str] = set()
    for name in links:
        path = []
        while name and name not in done:
            path.append(name)
            name = above[name].parent if name in above else ""
        done.update(path)
        yield from reversed(path)


def _joint_values(
    above: Mapping[str, StatedJoint], stated: Mapping[str, float], is_mjcf: bool
) -> tuple[dict[str, float], list[Entry]]:
    """Return the values of all motions that are not at zero, also of those that follow others, and
    entries about unusable names.
    """
    motions = [motion for joint in above.values() for motion in joint.motions]
    by_name = {motion.name: motion for motion in motions if motion.name}
    wrong = []
    for name in stated:
        if name not in by_name:
            wrong.append(_unusable(name, "the file has no such joint. Correct the name in --joint"))
        elif by_name[name].kind not in MOVABLE:
            wrong.append(
                _unusable(name, "its position is not one number. Give --joint a hinge or slide")
            )
    # MuJoCo's qpos0 does not obey equalities, so that only stated positions have followers.
    zeros = {motion.name: motion.zero for motion in motions if motion.name and not motion.leader}
    values = dict(stated) if is_mjcf else zeros | dict(stated)
    for _ in motions:  # Followers may follow followers.
        followers = {
            motion.name: motion.zero + _followed(motion, by_name[motion.leader], values)
            for motion in motions
            if motion.leader in values.keys() & by_name.keys() and motion.name not in values
        }
        if not followers:
            break
        values |= followers
    for joint in () if is_mjcf else above.values():  # MuJoCo leaves such an equality out.
        for motion in joint.motions:
            leader = motion.leader
            if leader and (leader not in by_name or motion.name not in values):
                fault = finding(JOINT_VALUE_UNUSABLE, joint=motion.name, key="mimic", value=leader)
                wrong.append(Entry(fault, joint.place))
    return values, wrong


def _followed(motion: Motion, leader: Motion, values: Mapping[str, float]) -> float:
    """Return the distance of a motion from its zero that its leader's value gives it."""
    distance = values[leader.name] - leader.zero
    return sum(factor * distance**power for power, factor in enumerate(motion.powers))


def _pose(
    links: Mapping[str, StatedLink],
    joint: StatedJoint | None,
    link: StatedLink,
    poses: Mapping[str, Pose | None],
    values: Mapping[str, float],
) -> Pose | None:
    """Return the pose of a link in the model, moved by its joint; None if it is unknown. poses: of
    the links above it. values: of the motions that are not at zero, by name.
    """
    if joint is None:
        return link.pose
    outer = poses[joint.parent] if joint.parent else Pose()
    unmoved = joint.pose
    if unmoved is None:
        unmoved = link.pose
        if joint.parent:
            parent = links[joint.parent].pose
            unmoved = parent.inverse() @ link.pose if parent and link.pose else None
    if outer is None or unmoved is None:
        return None
    pose = unmoved
    for motion in joint.motions:
        value = values.get(motion.name, motion.zero) if motion.name else motion.zero
        if motion.kind in MOVABLE and value != motion.zero:
            pose = pose @ motion.pose(value)
    return outer @ pose


def add_up(tree: Tree, used: Sequence[tuple[StatedLink, bool]]) -> Totals:
    """Return the totals of links with the inertials that their program uses, each with whether it
    is impossible.
    """
    missing = []
    frames = []
    left_out = []
    sums = dict.fromkeys(tree.poses, Body())
    for link, _ in used:
        inertial = link.inertial
        if link.is_frame or inertial is None and not link.shapes and not link.findings:
            frames.append(link.name)
        elif inertial is None:
            missing.append(link.name)
        elif not 0.0 < inertial.mass <= LARGEST:
            left_out.append(link.name)
        else:
            body = _placed(inertial, tree.poses[link.name])
            sums[link.name] = sums[link.name].add(body)
    whole = Body()
    for name in reversed(sums):  # Parents come first in it.
        joint = tree.above.get(name)
        if joint and joint.parent:
            sums[joint.parent] = sums[joint.parent].add(sums[name])
        else:
            whole = whole.add(sums[name])
    impossible = [link.name for link, is_impossible in used if is_impossible]
    return Totals(whole, sums, missing, frames, impossible, left_out)


def _placed(inertial: StatedInertial, pose: Pose | None) -> Body:
    """Return a link in the model; without center and inertia if a number or the pose is
    unknown.
    """
    numbers = np.concatenate([inertial.center, inertial.inertia.ravel()])
    if pose is None or not (np.abs(numbers) <= LARGEST).all():
        return Body(inertial.mass)
    turn = pose.rotation
    inertia = turn @ inertial.inertia @ turn.T
    return Body(inertial.mass, turn @ inertial.center + pose.position, (inertia + inertia.T) / 2.0)
