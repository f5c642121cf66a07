# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, with the inertial frame and the tensor along the link's axes (rpy 0).

Some readers ignore the inertial frame's rotation (ros2/rviz#1170) or diagonalize wrongly. The products ixy, ixz and
iyz are entries of the tensor, such as -∫xy dm.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from ...verdict.finding import Finding, finding
from ..findings import ROBOT_BASE_ADDED, URDF_EFFORT_UNKNOWN
from ..model import FreeAxis, Inertial, Pose, Robot, Shape
from ..stated import ENTRIES, StatedInertial
from .shapes import box_of_ellipsoid, ellipsoids_as_boxes
from .text import document, inertial_element, is_identity, number, numbers, roll_pitch_yaw, unique_names, xml_text

BASE = "base_link"
# A limited joint must state these unknown values. N·m or N, and rad/s or m/s, too large to have an effect.
EFFORT, VELOCITY = 1e6, 1e3


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    findings = []
    if len(robot.roots) > 1:
        findings.append(finding(ROBOT_BASE_ADDED, count=len(robot.roots), name=BASE))
    findings += ellipsoids_as_boxes(robot)
    limited = [joint.name for joint in robot.joints if any(free.is_limited for free in joint.free)]
    if limited:
        findings.append(finding(URDF_EFFORT_UNKNOWN, count=len(limited), joints=limited))
    return findings


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as URDF, with remarks as comments. inertial_only: only the links with their inertials."""
    names = unique_names([link.name for link in robot.links], xml_text)
    joint_names = unique_names([joint.name for joint in robot.joints], xml_text)
    root = Element("robot", name=xml_text(robot.name))
    taken = {*names.values()}
    base = None
    if len(robot.roots) > 1 and not inertial_only:
        base = _free_name(BASE, taken)
        SubElement(root, "link", name=base)
    for link in robot.ordered():
        element = SubElement(root, "link", name=names[link.name])
        if link.inertial is not None:
            _add_inertial(element, link.inertial)
        if not inertial_only:
            _add_shapes(element, link.shapes)
    if inertial_only:
        return document(root, "urdf", remarks)
    for link in robot.ordered():
        joint = robot.joint_of(link.name)
        if joint is not None:
            parent, name, free = names[joint.parent], joint_names[joint.name], joint.free
        elif base is not None:
            parent, name, free = base, _free_name(names[link.name] + "_joint", {*joint_names.values()}), ()
        else:
            continue
        _add_joint(root, taken, name, parent, names[link.name], robot.pose_in_parent(link), free)
    return document(root, "urdf", remarks)


def _free_name(name: str, taken: set[str]) -> str:
    name = unique_names([name], str, taken)[name]
    taken.add(name)
    return name


def _add_origin(parent: Element, pose: Pose) -> None:
    if is_identity(pose):
        SubElement(parent, "origin", xyz="0 0 0", rpy="0 0 0")
        return
    SubElement(parent, "origin", xyz=numbers(pose.position), rpy=numbers(roll_pitch_yaw(pose.rotation)))


def _add_inertial(parent: Element, inertial: Inertial) -> None:
    element = SubElement(parent, "inertial")
    SubElement(element, "origin", xyz=numbers(inertial.center), rpy="0 0 0")
    SubElement(element, "mass", value=number(inertial.mass))
    SubElement(element, "inertia", {name: number(inertial.inertia[i, j]) for name, i, j in ENTRIES})


def inertial_text(inertial: StatedInertial, *_: object) -> str:
    """Return the element of a repaired inertial."""
    return inertial_element(_add_inertial, inertial.principal())


def _add_shapes(parent: Element, shapes: Sequence[Shape]) -> None:
    pieces = [piece for shape in shapes for piece in _pieces(shape)]
    for tag in ("visual", "collision"):
        for piece in pieces:
            element = SubElement(parent, tag)
            _add_origin(element, piece.pose)
            geometry = SubElement(element, "geometry")
            if piece.kind == "mesh":
                mesh = SubElement(geometry, "mesh", filename=piece.file)
                if piece.size != (1.0, 1.0, 1.0):
                    mesh.set("scale", numbers(piece.size))
            elif piece.kind == "box":
                SubElement(geometry, "box", size=numbers(piece.size))
            elif piece.kind == "cylinder":
                SubElement(geometry, "cylinder", radius=number(piece.size[0]), length=number(piece.size[1]))
            else:
                SubElement(geometry, "sphere", radius=number(piece.size[0]))


def _pieces(shape: Shape) -> list[Shape]:
    """Return the URDF shapes of a shape: a cylinder and two spheres for a capsule, a box for an ellipsoid."""
    if shape.kind != "capsule":
        return [box_of_ellipsoid(shape)]
    radius, length = shape.size
    ends = [shape.pose @ Pose(np.array([0.0, 0.0, side * length / 2.0])) for side in (-1.0, 1.0)]
    return [Shape("cylinder", shape.size, shape.pose), *(Shape("sphere", (radius,), end) for end in ends)]


def _add_joint(
    root: Element, taken: set[str], name: str, parent: str, child: str, pose: Pose, free: Sequence[FreeAxis]
) -> None:
    """Add a joint for each degree of freedom, with massless links between them; a fixed joint if there is none."""
    for number_, axis in enumerate(free or (None,)):
        last = number_ + 1 >= len(free)
        frame = child if last else _free_name("{}_axis_{}".format(child, number_ + 1), taken)
        if not last:
            SubElement(root, "link", name=frame)
        label = name if last else "{}_axis_{}".format(name, number_ + 1)
        element = SubElement(root, "joint", name=label, type=_joint_type(axis))
        _add_origin(element, Pose() if number_ else pose)
        SubElement(element, "parent", link=parent)
        SubElement(element, "child", link=frame)
        if axis is not None:
            SubElement(element, "axis", xyz=numbers(axis.axis))
            if axis.is_limited or axis.kind == "translate":
                _add_limit(element, axis)
        parent = frame


def _joint_type(free: FreeAxis | None) -> str:
    if free is None:
        return "fixed"
    if free.kind == "translate":
        return "prismatic"
    return "revolute" if free.is_limited else "continuous"


def _add_limit(joint: Element, free: FreeAxis) -> None:
    """Add the limits of a joint; an open one becomes a far one, because URDF requires both."""
    far = 2.0 * pi if free.kind == "rotate" else 1e3
    lower, upper = max(free.lower, -far), min(free.upper, far)
    limit = {"lower": number(lower), "upper": number(upper), "effort": number(EFFORT), "velocity": number(VELOCITY)}
    SubElement(joint, "limit", limit)
