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
from .findings import AUDIT_JOINT, AUDIT_TOTAL, JOINT_VALUE_UNUSABLE
from .model import Pose
from .plausibility import LARGEST
from .stated import Description, Place, StatedInertial, StatedJoint, StatedLink

MOVABLE = ("hinge", "slide")
NOWHERE = Place()


class Body(NamedTuple):
    """Mass, kg, (3,) center, m, and (3, 3) inertia about it, kg·m²; both None if unknown."""

    mass: float = 0.0
    center: Array | None = None
    inertia: Array | None = None

    def add(self, other: Body) -> Body:
        """Return the total of both bodies."""
        if not self.mass or not other.mass:
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
        term = share * self.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        return Body(mass, self.center + share * arm, self.inertia + other.inertia + term)


@dataclass(frozen=True, eq=False)
class Tree:
    """Links by their names, the joint above each, and their poses in the model; None if unknown."""

    description: Description
    above: Mapping[str, StatedJoint]
    poses: Mapping[str, Pose | None]
    findings: Sequence[tuple[Finding, Place]] = ()


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
    """Return the places of all links. values: of joints, by their names, radians or meters; others
    are at zero.
    """
    links = {}
    for link in description.links:
        links.setdefault(link.name, link)
    findings = [(one, Place(one.values.get("line", 1))) for one in description.findings]
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
            findings.append(_unusable(joint.name or joint.child, cause, joint.place))
        else:
            above[joint.child] = joint
    findings += _open_loops(above)
    values, wrong = _joint_values(above, values, description.format == "mjcf")
    findings += wrong
    if (
        description.format == "urdf" and len(links) - len(above) == 1
    ):  # The root's frame is the model's.
        (root,) = links.keys() - above.keys()
        links[root] = replace(links[root], pose=Pose())
    poses: dict[str, Pose | None] = {}
    for name in links:
        waiting = [name]
        while (joint := above.get(waiting[-1])) and joint.parent and waiting[-1] not in poses:
            waiting.append(joint.parent)
        for below in reversed(waiting):
            if below not in poses:
                with np.errstate(invalid="ignore", over="ignore"):
                    pose = _pose(links, above.get(below), links[below], poses, values)
                if pose is not None and not (np.abs(pose.matrix) <= LARGEST).all():
                    joint = above.get(below)
                    name = joint.name if joint and joint.name else below
                    place = joint.place if joint else links[below].place
                    cause = "its place is no number, or too far away. Correct its origin"
                    findings.append(_unusable(name, cause, place))
                    pose = None
                poses[below] = pose
    return Tree(description, above, poses, findings)


def _unusable(name: str, cause: str, place: Place = NOWHERE) -> tuple[Finding, Place]:
    return finding(AUDIT_JOINT, joint=name, cause=cause), place


def _open_loops(above: dict[str, StatedJoint]) -> Iterator[tuple[Finding, Place]]:
    """Remove one joint of each loop, and yield the finding about it."""
    state: dict[str, int] = {}
    for index, name in enumerate([*above]):
        while name and name not in state:
            state[name] = index
            joint = above.get(name)
            name = joint.parent if joint else ""
        if name and state[name] == index and name in above:
            joint = above.pop(name)
            cause = "it closes a loop, which has no root. Remove it, or give another parent"
            yield _unusable(joint.name or joint.child, cause, joint.place)


def _joint_values(
    above: Mapping[str, StatedJoint], stated: Mapping[str, float], is_mjcf: bool
) -> tuple[dict[str, float], list[tuple[Finding, Place]]]:
    """Return the values of all motions that are not at zero, also of those that follow others, and
    findings about unusable names.
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
    zeros = {one.name: one.zero for one in motions if one.name and not one.leader}
    values = ({} if is_mjcf else zeros) | dict(stated)
    for _ in motions:  # Followers may follow followers.
        more = {
            motion.name: motion.zero
            + sum(
                factor * (values[motion.leader] - by_name[motion.leader].zero) ** power
                for power, factor in enumerate(motion.powers)
            )
            for motion in motions
            if motion.leader in values.keys() & by_name.keys() and motion.name not in values
        }
        if not more:
            break
        values |= more
    for joint in () if is_mjcf else above.values():  # MuJoCo leaves such an equality out.
        for name, *_, leader, _ in joint.motions:
            if leader and (leader not in by_name or name not in values):
                fault = finding(JOINT_VALUE_UNUSABLE, joint=name, key="mimic", value=leader)
                wrong.append((fault, joint.place))
    return values, wrong


def _pose(
    links: Mapping[str, StatedLink],
    joint: StatedJoint | None,
    link: StatedLink,
    poses: Mapping[str, Pose | None],
    values: Mapping[str, float],
) -> Pose | None:
    if joint is None:
        return link.pose
    outer = poses[joint.parent] if joint.parent else Pose()
    pose = joint.pose
    if pose is None and joint.parent:
        parent = links[joint.parent].pose
        pose = None if parent is None or link.pose is None else parent.inverse() @ link.pose
    elif pose is None:
        pose = link.pose
    if outer is None or pose is None:
        return None
    for motion in joint.motions:
        value = values.get(motion.name, 0.0) if motion.name else 0.0
        if motion.kind in MOVABLE and motion.name in values and value != motion.zero:
            pose = pose @ motion.pose(value)
    return outer @ pose


def add_up(tree: Tree, used: Sequence[tuple[StatedLink, bool]]) -> Totals:
    """Return the totals of links with the inertials that their program uses, each with whether it
    is impossible.
    """
    groups: dict[str, list[str]] = {name: [] for name in ("missing", "frames", "left_out")}
    sums = dict.fromkeys(tree.poses, Body())
    for link, _ in used:
        inertial = link.inertial
        if inertial is None:
            is_frame = not link.shapes and not link.findings
            groups["frames" if is_frame else "missing"].append(link.name)
        elif link.is_frame:
            groups["frames"].append(link.name)
        elif not 0.0 < inertial.mass <= LARGEST:
            groups["left_out"].append(link.name)
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
    return Totals(whole, sums, impossible=impossible, **groups)


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
