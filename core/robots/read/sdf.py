# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of SDFormat: the inertials and shapes of its models' links."""

from __future__ import annotations

from math import radians

import numpy as np

from ...numerics.rotations import rotation_matrix
from ...verdict.finding import Finding
from ..model import Pose
from ..stated import ENTRIES, Angles, Description, StatedInertial, StatedLink, rotation_of_angles
from .xml import NOWHERE, Node, attempt, number, numbers, read_shapes

KINDS = ("box", "ellipsoid", "sphere", "cylinder", "capsule")


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `sdf`: all links, wherever their models are."""
    models = [node for node in root.walk() if node.tag == "model"]
    links = tuple(_link(node, model, len(models) > 1) for model in models for node in model.all("link"))
    return Description(models[0].get("name") if models else "", "sdf", links, data)


def _link(node: Node, model: Node, several: bool) -> StatedLink:
    findings: list[Finding] = []
    element = node.find("inertial")
    is_auto = element is not None and element.get("auto") in ("true", "1")
    inertial = None if is_auto else attempt(findings, element, _inertial)
    span = None if element is None or inertial is None or element.start == NOWHERE else (element.start, element.end)
    shapes = read_shapes(findings, node, _pose, KINDS, _text, 1.0)
    static = _text(model, "static") in ("true", "1")
    name = "{}::{}".format(model.get("name"), node.get("name")) if several else node.get("name")
    moves = bool(shapes) and not static and element is None
    places = node.place, (element or node).place
    return StatedLink(name, inertial, shapes, span, moves, tuple(findings), None, *places)


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


def _pose(node: Node) -> tuple[Pose, Angles | None, tuple[float, ...] | None]:
    element = node.find("pose")
    text = "" if element is None else element.text
    if element is not None and element.get("relative_to"):  # a frame, which is not resolved
        raise ValueError(element.get("relative_to"))
    if element is not None and element.get("rotation_format") == "quat_xyzw":
        x, y, z, qx, qy, qz, qw = numbers(text, 7, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)).tolist()
        if not any((qx, qy, qz, qw)):
            raise ValueError(text)
        return Pose(np.array([x, y, z]), rotation_matrix([qw, qx, qy, qz])), None, (qw, qx, qy, qz)
    values = numbers(text, 6, (0.0,) * 6)
    roll, pitch, yaw = values[3:].tolist()
    if element is not None and element.get("degrees") in ("true", "1"):
        roll, pitch, yaw = radians(roll), radians(pitch), radians(yaw)
    return Pose(values[:3], rotation_of_angles(roll, pitch, yaw)), (roll, pitch, yaw), None
