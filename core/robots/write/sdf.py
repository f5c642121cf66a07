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
from numpy.typing import NDArray

from ...numerics.rotations import quaternion
from ...verdict.finding import Finding
from ..model import Inertial, Joint, Link, Pose, Robot, Shape
from ..stated import ENTRIES, StatedInertial
from .text import (
    add_text,
    document,
    inertial_element,
    is_identity,
    lost_values,
    number,
    numbers,
    stated_values,
    unique_names,
    xml_name,
)

VERSION = "1.9"  # The first with quaternions; newer parsers convert it, older ones refuse newer files.
DYNAMICS = {"damping": "damping", "friction": "friction", "stiffness": "spring_stiffness"}
_RESERVED = re.compile(r"__.*__|world", re.DOTALL)


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    return lost_values(robot, "SDF", _lost)


def _lost(joint: Joint) -> set[str]:
    """Return the names of values that SDF 1.9 cannot say: mimics, axes after a slide's, all values of a ball joint."""
    kind, count = _joint_type(joint), len(joint.free)
    lost = stated_values(joint) & {"mimic"}
    if kind == "ball":
        return stated_values(joint) if joint.is_ball else {*stated_values(joint), "limits"}
    return {*lost, "axes"} if count > (2 if kind == "universal" else 1) else lost


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as an SDF model. remarks, inertial_only: as in `urdf.write`."""
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], _name, names.values())
    root = Element("sdf", version=VERSION)
    model = SubElement(root, "model", name=_name(robot.name))
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
    taken = {*names.values(), *joint_names.values()}
    for link in () if inertial_only else robot.roots:
        if link.is_fixed:
            name = unique_names([link.name], lambda _, link=link: names[link.name] + "_joint", taken)[link.name]
            taken.add(name)
            element = SubElement(model, "joint", name=name, type="fixed")
            add_text(element, "parent", "world")
            add_text(element, "child", names[link.name])
    return document(root, "sdf", remarks)


def _name(text: str) -> str:
    """Return a valid name: without `::`, which separates models and links, and not reserved by the format."""
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
    """Return the element of a repaired inertial, along the link's axes: files before version 1.9 have no quaternion."""
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
            if tag == "collision" and not shape.collides:
                continue
            element = SubElement(parent, tag, name=tag if len(link.shapes) == 1 else "{}_{}".format(tag, count))
            _add_pose(element, shape.pose)
            _add_geometry(SubElement(element, "geometry"), shape)


def _add_geometry(geometry: Element, shape: Shape) -> None:
    element = SubElement(geometry, shape.kind)
    if shape.kind == "mesh":
        add_text(element, "uri", shape.file)
        if shape.size != (1.0, 1.0, 1.0):
            add_text(element, "scale", numbers(shape.size))
    elif shape.kind == "box":
        add_text(element, "size", numbers(shape.size))
    elif shape.kind == "ellipsoid":
        add_text(element, "radii", numbers(shape.size))
    else:
        for name, value in zip(("radius", "length"), shape.size):
            add_text(element, name, number(value))


def _joint_type(joint: Joint) -> str:
    kinds = [free.kind for free in joint.free]
    if not kinds:
        return "fixed"
    if len(kinds) == 1 or "translate" in kinds:
        return "prismatic" if kinds[0] == "translate" else "revolute"
    return "universal" if kinds == ["rotate", "rotate"] else "ball"


def _add_axes(element: Element, joint: Joint) -> None:
    if _joint_type(joint) == "ball":
        return
    for tag, free in zip(("axis", "axis2") if _joint_type(joint) == "universal" else ("axis",), joint.free):
        axis = SubElement(element, tag)
        add_text(axis, "xyz", numbers(free.axis))
        limit = SubElement(axis, "limit")
        for name, value in (("lower", free.lower), ("upper", free.upper)):
            add_text(limit, name, number(value))
        for name in ("effort", "velocity"):
            if name in free.values:
                add_text(limit, name, number(free.values[name]))
        dynamics = {tag: free.values[name] for name, tag in DYNAMICS.items() if name in free.values}
        if dynamics:
            element_ = SubElement(axis, "dynamics")
            for name, value in dynamics.items():
                add_text(element_, name, number(value))
