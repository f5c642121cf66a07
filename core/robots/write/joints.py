# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints about several axes as joints in a row, and the known values of joints with the formats
that hold them.
"""

from collections.abc import Callable
from dataclasses import replace

from ...verdict import Finding, finding
from ..findings import JOINT_VALUES_LOST
from ..model import Joint, Link, Pose, Robot
from .shapes import with_masses
from .text import free_name

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


def merge_fixed(robot: Robot) -> Robot:
    """Return a robot in which links on fixed joints belong to their parents: mass, inertia and
    shapes.

    Those that a moving joint needs, and frames without mass, stay as frames without mass.
    """
    robot = with_masses(robot)
    needed = {joint.parent for joint in robot.joints if joint.free}
    hosts = host_names(robot)
    links = []
    for link in robot.links:
        to_link = link.pose.inverse()
        if hosts[link.name] == link.name:
            shapes = [
                shape if part is link else replace(shape, pose=to_link @ part.pose @ shape.pose)
                for part in robot.rigid_parts(link)
                for shape in part.shapes
            ]
            links.append(replace(link, inertial=robot.rigid_inertial(link), shapes=tuple(shapes)))
        elif link.name in needed or link.inertial is None:
            links.append(replace(link, inertial=None, shapes=()))
    kept = {link.name for link in links}
    joints = tuple(
        joint if joint.free else replace(joint, parent=hosts[joint.parent])
        for joint in robot.joints
        if joint.child in kept
    )
    return replace(robot, links=tuple(links), joints=joints)


def host_names(robot: Robot) -> dict[str, str]:
    """Return for each link the name of the first link above it, or itself, that can move in its
    parent or has none.
    """
    hosts: dict[str, str] = {}
    for link in robot.ordered():
        joint = robot.joint_of(link.name)
        hosts[link.name] = link.name if joint is None or joint.free else hosts[joint.parent]
    return hosts


def split_frames(robot: Robot) -> tuple[Robot, dict[str, list[Link]]]:
    """Return a robot without its fixed frames without mass, whose joints go to the links that carry
    them, and these frames by the names of those links.
    """
    carriers: dict[str, str] = {}
    frames: dict[str, list[Link]] = {}
    for link in robot.ordered():
        joint = robot.joint_of(link.name)
        if joint is None or joint.free or link.inertial is not None or link.shapes:
            carriers[link.name] = link.name
        else:
            carriers[link.name] = carriers[joint.parent]
            frames.setdefault(carriers[link.name], []).append(link)
    joints = [
        replace(joint, parent=carriers[joint.parent])
        for joint in robot.joints
        if carriers[joint.child] == joint.child
    ]
    links = [link for link in robot.links if carriers[link.name] == link.name]
    return replace(robot, links=tuple(links), joints=tuple(joints)), frames


def with_axis_frames(
    robot: Robot, is_whole: Callable[[Joint], bool] = lambda _joint: False, part: float = 0.0
) -> Robot:
    """Return a robot whose joints have one axis each, with frames between the axes of those that
    had several.

    The frames stand at the joint, along the child's axes. is_whole: returns True for joints that
    stay as they are. part: the fraction of the child's mass and inertia that each of its frames
    takes over; zero for frames without mass.
    """
    names = {link.name for link in robot.links}
    joint_names = {joint.name for joint in robot.joints}
    links = {link.name: link for link in robot.links}
    frames: list[Link] = []
    joints: list[Joint] = []
    for joint in robot.joints:
        parent = joint.parent
        child = robot.link(joint.child)
        place = joint.pose.position
        between = () if is_whole(joint) else joint.free[:-1]
        pose = child.pose @ Pose(place) if place.any() else child.pose
        inertial = None
        if part and between and child.inertial is not None:
            # A frame has the child's axes and another origin: moved back, the total stays.
            inertial = child.inertial.share(part).place(Pose(-place))
            rest = child.inertial.share(1.0 - part * len(between))
            links[child.name] = replace(child, inertial=rest)
        for count, free in enumerate(between, start=1):
            name = free_name("{}_axis_{}".format(child.name, count), names)
            label = free_name("{}_axis_{}".format(joint.name, count), joint_names)
            frames.append(Link(name, inertial, pose))
            joints.append(Joint(label, parent, name, (free,), Pose(rotation=joint.pose.rotation)))
            names.add(name)
            joint_names.add(label)
            parent = name
        joints.append(replace(joint, parent=parent, free=joint.free[len(between) :]))
    return replace(robot, links=(*links.values(), *frames), joints=tuple(joints))
