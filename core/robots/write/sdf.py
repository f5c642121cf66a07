# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SDF 1.9, with a diagonal tensor in an inertial frame along the principal axes, as a quaternion.

Rounding would change the moments of a full tensor, and Gazebo tests whether they are possible.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from ...numerics import NDArray, quaternion
from ...verdict import Finding, finding
from ..findings import SDF_FRAMES_ADDED
from ..model import Inertial, Joint, Link, Pose, Robot, Shape
from ..stated import ENTRIES, StatedInertial
from .joints import NAMES, lost_values, split_frames, with_axis_frames
from .shapes import shape_values
from .text import (
    add_text,
    document,
    inertial_element,
    is_identity,
    number,
    numbers,
    unique_names,
    xml_name,
)

VERSION = (
    "1.9"  # The first with quaternions; newer parsers convert it, older ones refuse newer files.
)
# of the child's inertial, for frames between axes: readers take no link without mass
FRAME_PART = 2.0**-20
_RESERVED = re.compile(r"__.*__|world", re.DOTALL)


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    split = [joint.name for joint in robot.joints if not _is_whole(joint)]
    findings = (
        [finding(SDF_FRAMES_ADDED, count=len(split), joints=split, part=FRAME_PART)]
        if split
        else []
    )
    return findings + lost_values(
        robot, "SDF", lambda joint, stated: stated if joint.is_ball else set()
    )


def _is_whole(joint: Joint) -> bool:
    return len(joint.free) < 2 or joint.is_ball or _joint_type(joint) == "universal"


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as an SDF model. remarks, inertial_only: as in `urdf.write`."""
    robot = robot if inertial_only else with_axis_frames(robot, _is_whole, FRAME_PART)
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], _name, names.values())
    root = Element("sdf", version=VERSION)
    model = SubElement(root, "model", name=_name(robot.name))
    robot, frames = (robot, {}) if inertial_only else split_frames(robot)
    for carrier, several in frames.items():
        for frame in several:
            values = {"name": names[frame.name], "attached_to": names[carrier]}
            element = SubElement(model, "frame", values)
            _add_pose(element, robot.link(carrier).pose.inverse() @ frame.pose)
    for link in robot.ordered():
        element = SubElement(model, "link", name=names[link.name])
        if not inertial_only:
            _add_pose(element, link.pose)
        if link.inertial is not None:
            _add_inertial(element, link.inertial)
        if not inertial_only:
            _add_shapes(element, link)
    for joint in () if inertial_only else robot.joints:
        element = SubElement(model, "joint", name=joint_names[joint.name], type=_joint_type(joint))
        _add_pose(element, joint.pose)
        add_text(element, "parent", names[joint.parent])
        add_text(element, "child", names[joint.child])
        _add_axes(element, joint)
    bases = [] if inertial_only else [link.name for link in robot.roots if link.is_fixed]
    taken = [*names.values(), *joint_names.values()]
    for base, name in unique_names(bases, lambda name: names[name] + "_joint", taken).items():
        element = SubElement(model, "joint", name=name, type="fixed")
        add_text(element, "parent", "world")
        add_text(element, "child", names[base])
    return document(root, "sdf", remarks)


def _name(text: str) -> str:
    """Return a valid name: without `::`, which separates models and links, and not reserved by the
    format.
    """
    text = xml_name(text).replace("::", "_")
    return text + "_" if _RESERVED.fullmatch(text) else text


def _add_pose(parent: Element, pose: Pose) -> None:
    if not is_identity(pose):
        w, x, y, z = quaternion(pose.rotation)
        add_text(parent, "pose", numbers((*pose.position, x, y, z, w)), rotation_format="quat_xyzw")


def _add_inertial(parent: Element, inertial: Inertial) -> None:
    element = SubElement(parent, "inertial")
    _add_pose(element, Pose(inertial.center, inertial.axes))
    add_text(element, "mass", number(inertial.mass))
    _add_tensor(element, np.diag(inertial.moments))


def _add_tensor(parent: Element, tensor: NDArray) -> None:
    element = SubElement(parent, "inertia")
    for name, i, j in ENTRIES:
        add_text(element, name, number(tensor[i, j]))


def inertial_text(inertial: StatedInertial, old: str, *_: object) -> str:
    """Return the element of a repaired inertial, along the link's axes: files before version 1.9
    have no quaternion.
    """
    text = inertial_element(_add_plain_inertial, inertial.principal())
    kept = re.findall(r"<fluid_added_mass>.*?</fluid_added_mass>", old, re.DOTALL)
    return text.replace("\n</inertial>", "".join("\n  " + one for one in kept) + "\n</inertial>")


def _add_plain_inertial(parent: Element, inertial: Inertial) -> None:
    element = SubElement(parent, "inertial")
    add_text(element, "pose", numbers(inertial.center) + " 0 0 0")
    add_text(element, "mass", number(inertial.mass))
    _add_tensor(element, inertial.inertia)


def _add_shapes(parent: Element, link: Link) -> None:
    for tag in ("visual", "collision"):
        for count, shape in enumerate(link.shapes, start=1):
            if not (shape.seen if tag == "visual" else shape.collides):
                continue
            element = SubElement(
                parent, tag, name=tag if len(link.shapes) == 1 else "{}_{}".format(tag, count)
            )
            _add_pose(element, shape.pose)
            _add_geometry(SubElement(element, "geometry"), shape)


def _add_geometry(geometry: Element, shape: Shape) -> None:
    element = SubElement(geometry, shape.kind)
    values = {"uri": shape.file} if shape.kind == "mesh" else {}
    for name, text in (values | shape_values(shape)).items():
        add_text(element, name, text)


def _joint_type(joint: Joint) -> str:
    kinds = [free.kind for free in joint.free]
    if len(kinds) < 2:
        return {"rotate": "revolute", "translate": "prismatic"}[kinds[0]] if kinds else "fixed"
    return "universal" if kinds == ["rotate", "rotate"] else "ball"


def _add_axes(element: Element, joint: Joint) -> None:
    for tag, free in zip(("axis", "axis2"), () if joint.is_ball else joint.free):
        axis = SubElement(element, tag)
        add_text(axis, "xyz", numbers(free.axis))
        limit = SubElement(axis, "limit")
        for name, value in (("lower", free.lower), ("upper", free.upper)):
            add_text(limit, name, number(value))
        groups = {"effort": limit, "velocity": limit}
        for name, value in free.values.items():
            group = groups.get(name, axis.find("dynamics"))
            add_text(
                SubElement(axis, "dynamics") if group is None else group,
                NAMES["SDF"][name],
                number(value),
            )
