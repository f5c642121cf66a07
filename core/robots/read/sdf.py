# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SDFormat: the statements of its models' links."""

from __future__ import annotations

from math import radians

import numpy as np

from ...numerics.rotations import rotation_matrix
from ...verdict.finding import Finding
from ..model import Pose, Shape
from ..stated import Description, StatedInertial, StatedLink, StatedShape, pose_of_angles
from .urdf import ENTRIES
from .xml import Node, number, numbers, unreadable

Angles = tuple[float, float, float] | None


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `sdf`: all links, wherever their models are."""
    models = [node for node in root.walk() if node.tag == "model"]
    links = tuple(_link(node, model, len(models) > 1) for model in models for node in model.all("link"))
    return Description(models[0].get("name") if models else "", "sdf", links, data)


def _link(node: Node, model: Node, several: bool) -> StatedLink:
    findings: list[Finding] = []
    inertial_node, inertial, span = node.find("inertial"), None, None
    try:
        if inertial_node is not None and inertial_node.get("auto") not in ("true", "1"):
            inertial, span = _inertial(inertial_node), (inertial_node.start, inertial_node.end)
    except ValueError as error:
        findings.append(unreadable(inertial_node or node, error))
    shapes = []
    for role in ("visual", "collision"):
        for element in node.all(role):
            try:
                shapes += _shape(element, role)
            except ValueError as error:
                findings.append(unreadable(element, error))
    static = _text(model, "static") in ("true", "1")
    name = "{}::{}".format(model.get("name"), node.get("name")) if several else node.get("name")
    moves = bool(shapes) and not static and inertial_node is None
    return StatedLink(name, inertial, tuple(shapes), span, moves, tuple(findings))


def _text(node: Node, *path: str) -> str:
    found = node.find(*path)
    return "" if found is None else found.text.strip()


def _inertial(node: Node) -> StatedInertial:
    pose, angles, quaternion = _pose(node)
    tensor = np.eye(3)
    for name, i, j in ENTRIES:
        tensor[i, j] = tensor[j, i] = number(_text(node, "inertia", name), float(i == j))
    mass = number(_text(node, "mass"), 1.0)
    return StatedInertial(mass, pose.position, tensor, pose.rotation, angles, quaternion)


def _pose(node: Node) -> tuple[Pose, Angles, tuple[float, ...] | None]:
    element = node.find("pose")
    text = "" if element is None else element.text
    if element is not None and element.get("rotation_format") == "quat_xyzw":
        x, y, z, qx, qy, qz, qw = numbers(text, 7, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)).tolist()
        if not any((qx, qy, qz, qw)):
            raise ValueError(text)
        return Pose(np.array([x, y, z]), rotation_matrix([qw, qx, qy, qz])), None, (qw, qx, qy, qz)
    values = numbers(text, 6, (0.0,) * 6)
    roll, pitch, yaw = values[3:].tolist()
    if element is not None and element.get("degrees") in ("true", "1"):
        roll, pitch, yaw = radians(roll), radians(pitch), radians(yaw)
    return pose_of_angles(values[:3], (roll, pitch, yaw)), (roll, pitch, yaw), None


def _shape(node: Node, role: str) -> list[StatedShape]:
    pose, angles, _ = _pose(node)
    geometry = node.find("geometry")
    for element in geometry.children if geometry else ():
        kind, shape = element.tag, None
        if kind == "mesh":
            scale = numbers(_text(element, "scale"), 3, (1.0, 1.0, 1.0))
            shape = Shape("mesh", tuple(scale.tolist()), pose, _text(element, "uri"))
        elif kind == "box":
            shape = Shape(kind, tuple(numbers(_text(element, "size"), 3, (1.0, 1.0, 1.0)).tolist()), pose)
        elif kind == "ellipsoid":
            shape = Shape(kind, tuple(numbers(_text(element, "radii"), 3, (1.0, 1.0, 1.0)).tolist()), pose)
        elif kind == "sphere":
            shape = Shape(kind, (number(_text(element, "radius"), 1.0),), pose)
        elif kind in ("cylinder", "capsule"):
            size = number(_text(element, "radius"), 1.0), number(_text(element, "length"), 1.0)
            shape = Shape(kind, size, pose)
        if shape is not None:
            return [StatedShape(shape, role, angles)]
    return []
