# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF: the statements of its links."""

from __future__ import annotations

import numpy as np

from ...verdict.finding import Finding
from ..model import Pose, Shape
from ..stated import Description, StatedInertial, StatedLink, StatedShape, pose_of_angles
from .xml import Node, number, numbers, unreadable

ENTRIES = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `robot`."""
    links = tuple(_link(node) for node in root.all("link"))
    return Description(root.get("name"), "urdf", links, data)


def _link(node: Node) -> StatedLink:
    findings: list[Finding] = []
    inertial_node, inertial = node.find("inertial"), None
    try:
        inertial = None if inertial_node is None else _inertial(inertial_node)
    except ValueError as error:
        findings.append(unreadable(inertial_node or node, error))
    shapes = []
    for role in ("visual", "collision"):
        for element in node.all(role):
            try:
                shapes += _shape(element, role)
            except ValueError as error:
                findings.append(unreadable(element, error))
    span = None if inertial_node is None else (inertial_node.start, inertial_node.end)
    return StatedLink(node.get("name"), inertial, tuple(shapes), span, bool(shapes), tuple(findings))


def _inertial(node: Node) -> StatedInertial:
    pose, angles = _origin(node)
    mass, inertia = node.find("mass"), node.find("inertia")
    tensor = np.zeros((3, 3))
    for name, i, j in ENTRIES:
        tensor[i, j] = tensor[j, i] = number(inertia.get(name) if inertia else "", 0.0)
    return StatedInertial(number(mass.get("value") if mass else "", 0.0), pose.position, tensor, pose.rotation, angles)


def _origin(node: Node) -> tuple[Pose, tuple[float, float, float]]:
    origin = node.find("origin")
    position = numbers(origin.get("xyz") if origin else "", 3, (0.0, 0.0, 0.0))
    roll, pitch, yaw = numbers(origin.get("rpy") if origin else "", 3, (0.0, 0.0, 0.0)).tolist()
    return pose_of_angles(position, (roll, pitch, yaw)), (roll, pitch, yaw)


def _shape(node: Node, role: str) -> list[StatedShape]:
    pose, angles = _origin(node)
    geometry = node.find("geometry")
    for element in geometry.children if geometry else ():
        shape = None
        if element.tag == "mesh":
            scale = numbers(element.get("scale"), 3, (1.0, 1.0, 1.0))
            shape = Shape("mesh", tuple(scale.tolist()), pose, element.get("filename"))
        elif element.tag == "box":
            shape = Shape("box", tuple(numbers(element.get("size"), 3, (1.0, 1.0, 1.0)).tolist()), pose)
        elif element.tag == "sphere":
            shape = Shape("sphere", (number(element.get("radius")),), pose)
        elif element.tag in ("cylinder", "capsule"):
            shape = Shape(element.tag, (number(element.get("radius")), number(element.get("length"))), pose)
        if shape is not None:
            return [StatedShape(shape, role, angles)]
    return []
