# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints about several axes as joints in a row, and the known values of joints with the formats
that hold them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...verdict.finding import Finding, finding
from ..findings import JOINT_VALUES_LOST
from ..model import Joint, Link, Pose, Robot
from .text import unique_names

# Names of values in each format, by ours. UsdPhysics and glTF have drives, others dynamics, limits
# and mimics.
_DRIVE = {"damping": "damping", "stiffness": "stiffness", "effort": "maxForce"}
NAMES = {
    "URDF": {name: name for name in ("damping", "friction", "effort", "velocity", "mimic")},
    "SDF": (
        {"stiffness": "spring_stiffness"}
        | {name: name for name in ("damping", "friction", "effort", "velocity")}
    ),
    "MJCF": {
        "damping": "damping",
        "friction": "frictionloss",
        "stiffness": "stiffness",
        "effort": "",
        "mimic": "",
    },
    "USD": _DRIVE,
    "glTF": _DRIVE,
    "OpenSim": {},
}


def lost_values(
    robot: Robot,
    form: str,
    more: Callable[[Joint, set[str]], set[str]] = lambda _joint, _stated: set(),
) -> list[Finding]:
    """Return the finding about joints for which a format loses values, empty if it loses none.

    more: returns the names of further losses for a joint and the names of its values.
    """
    lost = {}
    for joint in robot.joints:
        stated = {name for free in joint.free for name in free.values} | (
            {"mimic"} if joint.mimic else set()
        )
        lost[joint.name] = (stated - NAMES[form].keys()) | more(joint, stated)
    joints = [name for name, names in lost.items() if names]
    values = sorted(set().union(*lost.values()))
    return [finding(JOINT_VALUES_LOST, format=form, values=values, joints=joints)] if joints else []


def with_axis_frames(
    robot: Robot, is_whole: Callable[[Joint], bool] = lambda _joint: False, part: float = 0.0
) -> Robot:
    """Return a robot whose joints have one axis each, with frames between the axes of those that
    had several.

    The frames stand at the joint, along the child's axes. is_whole: returns True for joints that
    stay as they are. part: of the child's inertial, which a frame has as well; zero for frames
    without mass.
    """
    names, joint_names = ({one.name for one in those} for those in (robot.links, robot.joints))
    frames: list[Link] = []
    joints: list[Joint] = []
    for joint in robot.joints:
        parent = joint.parent
        child = robot.link(joint.child)
        place = joint.pose.position
        between = () if is_whole(joint) else joint.free[:-1]
        pose = child.pose @ Pose(place) if place.any() else child.pose
        inertial = (
            child.inertial.share(part).place(Pose(-place))
            if part and child.inertial is not None
            else None
        )
        for count, free in enumerate(between, start=1):
            (name,) = unique_names(["{}_axis_{}".format(child.name, count)], str, names).values()
            (label,) = unique_names(
                ["{}_axis_{}".format(joint.name, count)], str, joint_names
            ).values()
            frames.append(Link(name, inertial, pose))
            joints.append(Joint(label, parent, name, (free,), Pose(rotation=joint.pose.rotation)))
            names.add(name)
            joint_names.add(label)
            parent = name
        joints.append(replace(joint, parent=parent, free=joint.free[len(between) :]))
    return replace(robot, links=(*robot.links, *frames), joints=tuple(joints))
