# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of URDF: the inertials and shapes of its links, and its joints."""

from ...verdict import Finding
from ..model import Pose
from ..stated import (
    Angles,
    Description,
    Motion,
    StatedInertial,
    StatedJoint,
    StatedLink,
    rotation_of_angles,
)
from .xml import (
    Node,
    attempt,
    attempt_all,
    axis_of,
    number,
    numbers,
    read_shapes,
    stated_link,
    symmetric_tensor,
)

KINDS = {"revolute": "hinge", "continuous": "hinge", "prismatic": "slide"}


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `robot`."""
    findings: list[Finding] = []
    joints = attempt_all(findings, root.all("joint"), _joint)
    return Description(
        root.get("name"),
        "urdf",
        tuple(map(_link, root.all("link"))),
        data,
        joints=joints,
        findings=tuple(findings),
    )


def _joint(node: Node) -> StatedJoint:
    name = node.get("name")
    kind = node.get("type")
    parent, child = (
        end.get("link") if (end := node.find(tag)) else "" for tag in ("parent", "child")
    )
    pose, _ = _origin(node)
    motion = Motion(name, KINDS.get(kind, kind))
    if kind in KINDS and (axis := node.find("axis")):
        motion = motion._replace(axis=axis_of(axis.get("xyz"), (1.0, 0.0, 0.0)))
    if mimic := node.find("mimic"):
        motion = motion._replace(
            leader=mimic.get("joint"),
            powers=(number(mimic.get("offset"), 0.0), number(mimic.get("multiplier"), 1.0)),
        )
    return StatedJoint(name, parent, child, pose, (motion,), node.place)


def _link(node: Node) -> StatedLink:
    findings: list[Finding] = []
    element = node.find("inertial")
    inertial = attempt(findings, element, _inertial)
    shapes = read_shapes(
        findings, node, _origin, ("box", "sphere", "cylinder", "capsule"), Node.get
    )
    more = {"name": node.get("name"), "moves": bool(shapes)}
    return stated_link(node, element, findings, inertial=inertial, shapes=shapes, **more)


def _inertial(node: Node) -> StatedInertial:
    pose, angles = _origin(node)
    mass = node.find("mass")
    inertia = node.find("inertia")
    tensor = symmetric_tensor(lambda name: number(inertia.get(name) if inertia else "", 0.0))
    return StatedInertial(
        number(mass.get("value") if mass else "", 0.0), pose.position, tensor, pose.rotation, angles
    )


def _origin(node: Node) -> tuple[Pose, Angles]:
    origin = node.find("origin")
    position = numbers(origin.get("xyz") if origin else "", 3, (0.0, 0.0, 0.0))
    roll, pitch, yaw = numbers(origin.get("rpy") if origin else "", 3, (0.0, 0.0, 0.0)).tolist()
    return Pose(position, rotation_of_angles(roll, pitch, yaw)), (roll, pitch, yaw)
