# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, with the inertial frame and the tensor along the link's axes (rpy 0).

Some readers ignore the inertial frame's rotation (ros2/rviz#1170) or diagonalize wrongly. The
products ixy, ixz and iyz are entries of the tensor, such as -∫xy dm. A link's origin is at its
joint.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from ...mesh import Surface
from ...verdict import Finding, finding
from ..findings import ROBOT_BASE_ADDED, URDF_EFFORT_UNKNOWN, URDF_ROOT_WITHOUT_MASS
from ..model import FreeAxis, Inertial, Joint, Pose, Robot, Shape
from ..stated import ENTRIES, StatedInertial
from .joints import lost_values, with_axis_frames
from .mjcf import raised_inertials, smallest_inertials
from .shapes import box_of_ellipsoid, capsule_pieces, ellipsoids_as_boxes, shape_values
from .text import (
    document,
    inertial_element,
    is_identity,
    number,
    numbers,
    roll_pitch_yaw,
    unique_names,
    xml_name,
)

FLATNESS = 1e-7  # Thickness relative to length, of float32 vertices in a plane.
BASE, WORLD = "base_link", "world"
SLACK = (
    2.0**-48
    # The largest moment of a flat body is lowered by this part: MuJoCo tests A + B ≥ C without
    # tolerance.
)
LEAST = 1e-14  # kg and kg·m² that MuJoCo gives massless frames, as it refuses less than 1e-15.
BOUNDED = 1e-13  # It takes smaller tensors for singular, unless a bound is set.
# A limited joint must state these unknown values. N·m or N, and rad/s or m/s, too large to have an
# effect.
EFFORT, VELOCITY = 1e6, 1e3


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    findings = []
    loose = [link for link in robot.roots if not link.is_fixed]
    if loose and len(robot.roots) > 1:
        name = BASE if len(loose) == len(robot.roots) else WORLD
        findings.append(finding(ROBOT_BASE_ADDED, count=len(loose), name=name))
    # The root of the file that is to be free: an added one, or a frame.
    free = BASE if len(loose) == len(robot.roots) > 1 else ""
    if len(robot.roots) == len(loose) == 1 and loose[0].inertial is None:
        free = loose[0].name
    if free:
        findings.append(finding(URDF_ROOT_WITHOUT_MASS, name=free))
    findings += ellipsoids_as_boxes(robot)
    unknown = [
        joint.name
        for joint in robot.joints
        if any(
            _needs_limit(free) and not {"effort", "velocity"} <= free.values.keys()
            for free in joint.free
        )
    ]
    if unknown:
        findings.append(finding(URDF_EFFORT_UNKNOWN, count=len(unknown), joints=unknown))
    return findings + raised_inertials(robot, LEAST) + lost_values(robot, "URDF")


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as URDF, with remarks as comments. inertial_only: only the links with their
    inertials.
    """
    robot = robot if inertial_only else with_axis_frames(robot.at_joints())
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], xml_name)
    root = Element("robot", name=xml_name(robot.name))
    base = None
    if not inertial_only:
        _add_compiler(root, robot)
        if any(link.is_fixed for link in robot.roots):
            base = WORLD
        elif len(robot.roots) > 1:
            base = _free_name(BASE, names)
    if base is not None:
        _add_no_mass(SubElement(root, "link", name=base))
    for link in robot.ordered():
        element = SubElement(root, "link", name=names[link.name])
        if link.inertial is not None:
            _add_inertial(element, link.inertial)
        else:
            _add_no_mass(element)
        if not inertial_only:
            _add_shapes(element, link.shapes)
    for link in () if inertial_only else robot.ordered():
        joint = robot.joint_of(link.name)
        if joint is not None:
            parent = names[joint.parent]
            name = joint_names[joint.name]
        elif base is not None:
            parent = base
            name = _free_name(names[link.name] + "_joint", joint_names)
        else:
            continue
        element = _add_joint(
            root, name, parent, names[link.name], robot.pose_in_parent(link), joint
        )
        if joint is not None and joint.mimic is not None:
            leader, multiplier, offset = joint.mimic
            values = {
                "joint": joint_names[leader],
                "multiplier": number(multiplier),
                "offset": number(offset),
            }
            SubElement(element, "mimic", values)
    return document(root, "urdf", remarks)


def _name(text: str) -> str:
    """Return a valid name; MuJoCo and Gazebo take a root named `world` as the world itself."""
    text = xml_name(text)
    return text + "_" if text == WORLD else text


def _add_compiler(root: Element, robot: Robot) -> None:
    """Let MuJoCo keep fixed links, folders of meshes, and links of little or no mass; other readers
    skip it.
    """
    values = {"fusestatic": "false", "strippath": "false"}
    is_bare = any(link.inertial is None and robot.joint_of(link.name) for link in robot.links)
    if is_bare or smallest_inertials(robot, BOUNDED):
        values |= {"boundmass": number(LEAST), "boundinertia": number(LEAST)}
    SubElement(SubElement(root, "mujoco"), "compiler", values)


def _free_name(name: str, taken: Mapping[str, str]) -> str:
    return unique_names([name], str, taken.values())[name]


def _add_origin(parent: Element, pose: Pose) -> None:
    if is_identity(pose):
        SubElement(parent, "origin", xyz="0 0 0", rpy="0 0 0")
        return
    SubElement(
        parent, "origin", xyz=numbers(pose.position), rpy=numbers(roll_pitch_yaw(pose.rotation))
    )


def _add_inertial(parent: Element, inertial: Inertial) -> None:
    element = SubElement(parent, "inertial")
    SubElement(element, "origin", xyz=numbers(inertial.center), rpy="0 0 0")
    SubElement(element, "mass", value=number(inertial.mass))
    tensor = inertial.inertia
    axis = inertial.axes[:, 2]
    missing = SLACK * inertial.moments[2] - (
        inertial.moments[0] + inertial.moments[1] - inertial.moments[2]
    )
    if missing > 0.0:
        tensor = tensor - missing * np.outer(axis, axis)
    SubElement(element, "inertia", {name: number(tensor[i, j]) for name, i, j in ENTRIES})


def _add_no_mass(parent: Element) -> None:
    """Add zeros; some readers take 1 kg for a link without inertial."""
    element = SubElement(parent, "inertial")
    SubElement(element, "mass", value="0")
    SubElement(element, "inertia", {name: "0" for name, _, _ in ENTRIES})


def inertial_text(inertial: StatedInertial, *_: object) -> str:
    """Return the element of a repaired inertial."""
    return inertial_element(_add_inertial, inertial.principal())


def _add_shapes(parent: Element, shapes: Sequence[Shape]) -> None:
    for tag in ("visual", "collision"):
        shown = [
            shape
            for shape in shapes
            if (shape.seen if tag == "visual" else shape.collides and not _is_flat(shape.surface))
        ]
        for piece in (
            box_of_ellipsoid(piece) for shape in shown for piece in capsule_pieces(shape)
        ):
            element = SubElement(parent, tag)
            _add_origin(element, piece.pose)
            geometry = SubElement(element, "geometry")
            values = {"filename": piece.file} if piece.kind == "mesh" else {}
            SubElement(geometry, piece.kind, values | shape_values(piece))


def _is_flat(surface: Surface | None) -> bool:
    """Return whether a surface lies in a plane, so that no convex hull of it can collide; MuJoCo
    refuses it.
    """
    if surface is None:
        return False
    points = surface.points[np.unique(surface.all_triangles()[0])]
    spread = np.linalg.svd(np.cov((points - points[0]).T), compute_uv=False)
    return bool(spread[2] <= FLATNESS**2 * spread[0])


def _add_joint(
    root: Element, name: str, parent: str, child: str, pose: Pose, joint: Joint | None
) -> Element:
    axis = joint.free[0] if joint is not None and joint.free else None
    element = SubElement(root, "joint", name=name, type=_joint_type(axis))
    _add_origin(element, pose)
    SubElement(element, "parent", link=parent)
    SubElement(element, "child", link=child)
    if joint is not None and axis is not None:
        SubElement(element, "axis", xyz=numbers(joint.pose.rotation @ axis.axis))
        if _needs_limit(axis):
            _add_limit(element, axis)
        dynamics = {
            key: number(axis.values[key]) for key in ("damping", "friction") if key in axis.values
        }
        if dynamics:
            SubElement(element, "dynamics", dynamics)
    return element


def _needs_limit(free: FreeAxis) -> bool:
    return (
        free.is_limited
        or free.kind == "translate"
        or bool({"effort", "velocity"} & free.values.keys())
    )


def _joint_type(free: FreeAxis | None) -> str:
    if free is None:
        return "fixed"
    if free.kind == "translate":
        return "prismatic"
    return "revolute" if free.is_limited else "continuous"


def _add_limit(joint: Element, free: FreeAxis) -> None:
    """Add the limits of a joint; an open one becomes a far one, because URDF requires both."""
    limit = {}
    if free.is_limited or free.kind == "translate":
        far = 2.0 * pi if free.kind == "rotate" else 1e3
        limit = {"lower": number(max(free.lower, -far)), "upper": number(min(free.upper, far))}
    limit["effort"] = number(free.values.get("effort", EFFORT))
    limit["velocity"] = number(free.values.get("velocity", VELOCITY))
    SubElement(joint, "limit", limit)
