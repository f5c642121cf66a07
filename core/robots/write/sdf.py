# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SDF 1.9, with a diagonal tensor in an inertial frame along the principal axes, as a quaternion.

Rounding would change the moments of a full tensor, and Gazebo tests whether they are possible.
"""

import re
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

import numpy as np

from ...numerics import NDArray, quaternion
from ...verdict import Finding, finding
from ..findings import SDF_FRAMES_ADDED
from ..model import Inertial, Joint, Link, Pose, Robot
from ..stated import ENTRIES, StatedInertial
from .joints import NAMES, lost_values, split_frames, with_axis_frames
from .shapes import shape_values
from .text import (
    document,
    element,
    element_text,
    is_identity,
    number,
    numbers,
    unique_names,
    xml_name,
)

VERSION = (
    "1.9"  # The first with quaternions; newer parsers convert it, older ones refuse newer files.
)
# The fraction of the child's inertial for each frame between axes, as readers take no link without
# mass; chosen: a millionth, and a power of 2, which rounds nothing.
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
    robot = (
        robot.without_motion() if inertial_only else with_axis_frames(robot, _is_whole, FRAME_PART)
    )
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], _name, names.values())
    parts: list[Element] = []
    robot, frames = (robot, {}) if inertial_only else split_frames(robot)
    for carrier, frames_of_carrier in frames.items():
        to_carrier = robot.link(carrier).pose.inverse()
        for frame in frames_of_carrier:
            values = {"name": names[frame.name], "attached_to": names[carrier]}
            parts.append(element("frame", *_pose(to_carrier @ frame.pose), **values))
    for link in robot.ordered():
        inertial = () if link.inertial is None else (_inertial(link.inertial),)
        content = (*_pose(link.pose), *inertial, *_shapes(link))
        parts.append(element("link", *content, name=names[link.name]))
    for joint in robot.joints:
        values = {"name": joint_names[joint.name], "type": _joint_type(joint)}
        ends = _ends(names[joint.parent], names[joint.child])
        parts.append(element("joint", *_pose(joint.pose), *ends, *_axes(joint), **values))
    bases = [link.name for link in robot.roots if link.is_fixed]
    taken = [*names.values(), *joint_names.values()]
    for base, name in unique_names(bases, lambda name: names[name] + "_joint", taken).items():
        parts.append(element("joint", *_ends("world", names[base]), name=name, type="fixed"))
    model = element("model", *parts, name=_name(robot.name))
    return document(element("sdf", model, version=VERSION), "sdf", remarks)


def _name(text: str) -> str:
    """Return a valid name: without `::`, which separates models and links, and not reserved by the
    format.
    """
    text = xml_name(text).replace("::", "_")
    return text + "_" if _RESERVED.fullmatch(text) else text


def _ends(parent: str, child: str) -> list[Element]:
    return [element("parent", text=parent), element("child", text=child)]


def _pose(pose: Pose) -> list[Element]:
    """Return the element of a pose; none for the identity."""
    if is_identity(pose):
        return []
    w, x, y, z = quaternion(pose.rotation)
    text = numbers((*pose.position, x, y, z, w))
    return [element("pose", text=text, rotation_format="quat_xyzw")]


def _inertial(inertial: Inertial) -> Element:
    place = _pose(Pose(inertial.center, inertial.axes))
    return _with_tensor(place, inertial.mass, np.diag(inertial.moments))


def _with_tensor(place: Sequence[Element], mass: float, tensor: NDArray) -> Element:
    entries = (element(name, text=number(tensor[i, j])) for name, i, j in ENTRIES)
    parts = (element("mass", text=number(mass)), element("inertia", *entries))
    return element("inertial", *place, *parts)


def inertial_text(inertial: StatedInertial, old: str, *_: object) -> str:
    """Return the element of a repaired inertial, along the link's axes: files before version 1.9
    have no quaternion.
    """
    principal = inertial.principal()
    place = element("pose", text=numbers(principal.center) + " 0 0 0")
    text = element_text(_with_tensor([place], principal.mass, principal.inertia))
    kept = re.findall(r"<fluid_added_mass>.*?</fluid_added_mass>", old, re.DOTALL)
    return text.replace("\n</inertial>", "".join("\n  " + mass for mass in kept) + "\n</inertial>")


def _shapes(link: Link) -> Iterator[Element]:
    for tag in ("visual", "collision"):
        for count, shape in enumerate(link.shapes, start=1):
            if shape.seen if tag == "visual" else shape.collides:
                name = tag if len(link.shapes) == 1 else "{}_{}".format(tag, count)
                values = {"uri": shape.file} if shape.kind == "mesh" else {}
                values |= shape_values(shape)
                sizes = (element(key, text=text) for key, text in values.items())
                form = element("geometry", element(shape.kind, *sizes))
                yield element(tag, *_pose(shape.pose), form, name=name)


def _joint_type(joint: Joint) -> str:
    """Return the type of a joint that has one, as `_is_whole` tells."""
    kinds = [free.kind for free in joint.free]
    if len(kinds) < 2:
        return {"rotate": "revolute", "translate": "prismatic"}[kinds[0]] if kinds else "fixed"
    return "universal" if kinds == ["rotate", "rotate"] else "ball"


def _axes(joint: Joint) -> Iterator[Element]:
    for tag, free in zip(("axis", "axis2"), () if joint.is_ball else joint.free):
        limits = {"lower": free.lower, "upper": free.upper}
        dynamics: dict[str, float] = {}
        for name, value in free.values.items():
            (limits if name in ("effort", "velocity") else dynamics)[NAMES["SDF"][name]] = value
        groups = {"limit": limits} | ({"dynamics": dynamics} if dynamics else {})
        parts = (
            element(group, *(element(name, text=number(value)) for name, value in values.items()))
            for group, values in groups.items()
        )
        yield element(tag, element("xyz", text=numbers(free.axis)), *parts)
