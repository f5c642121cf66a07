# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of SDFormat: the inertials and shapes of its models' links, and their joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import radians

import numpy as np

from ...numerics import rotation_matrix
from ...verdict import Finding
from ..model import Pose
from ..stated import (
    Angles,
    Description,
    Motion,
    Rules,
    StatedInertial,
    StatedJoint,
    StatedLink,
    StatedShape,
    rotation_of_angles,
)
from .mjcf_meshes import CLOSED, WATER, Weight
from .xml import (
    MAX_DEPTH,
    NOWHERE,
    Node,
    attempt,
    attempt_all,
    axis_of,
    check_names,
    number,
    numbers,
    read_shapes,
    stated_link,
    symmetric_tensor,
)

KINDS = ("box", "ellipsoid", "sphere", "cylinder", "capsule")
TRUE = ("true", "1")
OWN = "__model__"  # the name of a model's frame within itself
MOTIONS = {
    "revolute": "hinge",
    "continuous": "hinge",
    "universal": "hinge",
    "revolute2": "hinge",
    "prismatic": "slide",
}


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `sdf`: all links, wherever their models are."""
    nodes = [node for node in root.walk() if node.tag == "model"]
    # Siblings have names of their own; content of plugins is free.
    for node in (root, *root.all("world"), *nodes):
        for tag in ("model", "link", "joint"):
            check_names("sdf", [(child.get("name"), child.place) for child in node.all(tag)])
    outer_of = {inner: node for node in nodes for inner in node.all("model")}
    is_single = len(nodes) - len(outer_of) == 1
    models: dict[Node, _Model] = {}
    for node in nodes:  # outer ones first
        outer = models[outer_of[node]] if node in outer_of else None
        prefix = node.get("name") + "::" if len(nodes) > 1 else ""
        models[node] = _Model(node, outer, is_single, prefix)
    findings: list[Finding] = []
    links = tuple(
        replace(_link(node, model), pose=attempt(findings, node, model.place))
        for model in models.values()
        for node in model.node.all("link")
    )
    joints = tuple(
        joint
        for model in models.values()
        for joint in attempt_all(findings, model.node.all("joint"), _joint, model)
    )
    name = nodes[0].get("name") if nodes else ""
    return Description(name, "sdf", links, data, joints=joints, findings=tuple(findings))


class _Model:
    """A model, and its frames by their names, each in another one of them.

    outer: the model that it is in. is_single: True if no other model has no outer one; its frame is
    then the world's. prefix: of the names of its links.
    """

    def __init__(self, node: Node, outer: _Model | None, is_single: bool, prefix: str) -> None:
        self.node = node
        self._outer = outer
        self._is_single = is_single
        self._prefix = prefix
        self._inner: dict[str, _Model] = {}
        if outer is not None:
            outer._inner[node.get("name")] = self
        self._frames = {
            child.get("name"): child
            for child in node.children
            if child.tag in ("link", "joint", "frame", "model")
        }
        self._poses = {OWN: Pose()}

    def link_name(self, link: Node) -> str:
        """Return the name of a link of the model in the description."""
        return self._prefix + link.get("name")

    def place(self, node: Node) -> Pose:
        """Return the pose of a link, joint or model of the model in the world."""
        return self._in_world() @ self.pose(node.get("name"))

    def _in_world(self) -> Pose:
        if self._outer is not None:
            return self._outer.place(self.node)
        return Pose() if self._is_single else _pose(self.node)[0]

    def pose(self, name: str, depth: int = 0) -> Pose:
        """Return the pose of a frame in the model. ValueError if it is unknown, or in itself.

        name: with "::" between models and their content. depth: of the frames that led to it.
        """
        if name not in self._poses:
            first, _, rest = name.partition("::")
            node = self._frames.get(first)
            if node is None or rest and node.tag != "model" or depth > MAX_DEPTH:
                raise ValueError(name)
            # Without a frame of its own, a pose is in that of the child, or of the attachment.
            defaults = {"joint": _text(node, "child"), "frame": node.get("attached_to")}
            relative, _, _, outer = _pose(node)
            outer = outer or defaults.get(node.tag) or OWN
            pose = self.pose(outer, depth + 1) @ relative
            if node.tag == "model":  # The pose is that of its placement frame.
                inner = self._inner[first]
                placement = inner.pose(node.get("placement_frame") or OWN, depth + 1)
                pose = pose @ placement.inverse() @ inner.pose(rest or OWN, depth + 1)
            self._poses[name] = pose
        return self._poses[name]

    def link_of(self, name: str, depth: int = 0) -> tuple[_Model, Node | None]:
        """Return the model and the link that a frame is fixed to; without one, the name is
        unknown.
        """
        first, _, rest = name.partition("::")
        node = self._frames.get(first)
        if node is None or depth > MAX_DEPTH or node.tag == "link":
            return self, node
        if node.tag == "model":
            canonical = node.get("canonical_link") or next(
                (link.get("name") for link in node.all("link")), ""
            )
            return self._inner[first].link_of(rest or canonical, depth + 1)
        return self.link_of(_text(node, "child") or node.get("attached_to"), depth + 1)


def _joint(node: Node, model: _Model) -> StatedJoint:
    name = node.get("name")
    parent, child = _text(node, "parent"), _text(node, "child")
    parent_model, parent_link = model.link_of(parent)
    child_model, child_link = model.link_of(child)
    if parent_link is not None:
        parent = parent_model.link_name(parent_link)
    kind = MOTIONS.get(node.get("type"), node.get("type"))
    motions = (Motion(name, kind),)
    if child_link is not None:
        child = child_model.link_name(child_link)
        if kind in ("hinge", "slide"):
            in_child = child_model.place(child_link).inverse() @ model.place(node)
            motions = tuple(_motions(node, kind, model, in_child))
    # "" is the world, and "?" no link, so that a joint without parent is refused.
    parent = "" if parent == "world" else parent or "?"
    return StatedJoint(name, parent, child, None, motions, node.place)


def _motions(node: Node, kind: str, model: _Model, pose: Pose) -> Iterator[Motion]:
    """Yield the motions along the axes of a joint. pose: of the joint in the child."""
    name = node.get("name")
    for tag, label in (("axis", name), ("axis2", name + " axis2")):
        if tag == "axis2" and node.find(tag) is None:
            continue
        element = node.find(tag, "xyz")
        frame = element.get("expressed_in") if element else ""
        turn = pose.rotation
        if frame:
            turn = (pose @ model.pose(name).inverse() @ model.pose(frame)).rotation
        axis = axis_of(element.text if element else "", (0.0, 0.0, 1.0))
        motion = Motion(label, kind, turn @ axis, pose.position)
        if mimic := node.find(tag, "mimic"):
            leader = mimic.get("joint") + " axis2" * (mimic.get("axis") == "axis2")
            factor = number(_text(mimic, "multiplier"), 1.0)
            offset = number(_text(mimic, "offset"), 0.0)
            offset -= factor * number(_text(mimic, "reference"), 0.0)
            motion = motion._replace(leader=leader, powers=(offset, factor))
        yield motion


def _link(node: Node, model: _Model) -> StatedLink:
    findings: list[Finding] = []
    element = node.find("inertial")
    is_auto = element is not None and element.get("auto") in TRUE
    inertial = None if is_auto else attempt(findings, element, _inertial)

    def pose_of(part: Node) -> tuple[Pose, Angles | None]:
        """Return the pose of a part in the link, and its angles if they are in the link's frame."""
        pose, angles, _, frame = _pose(part)
        if not frame:
            return pose, angles
        try:
            return model.pose(node.get("name")).inverse() @ model.pose(frame) @ pose, None
        except ValueError as error:
            raise ValueError(frame) from error

    shapes = read_shapes(findings, node, pose_of, KINDS, _text, 1.0, node.place.file)
    rules = None
    if is_auto:  # With a wrong number all shapes stay without weight.
        shapes, rules = attempt(findings, node, _weights, element, shapes) or (shapes, None)
    is_static = _text(model.node, "static") in TRUE
    moves = not is_static and (is_auto or bool(shapes) and element is None)
    values = {"name": model.link_name(node), "inertial": inertial, "shapes": shapes, "rules": rules}
    return stated_link(node, element, findings, moves=moves, **values)


def _weights(
    node: Node, inertial: Node, shapes: Sequence[StatedShape]
) -> tuple[tuple[StatedShape, ...], Rules]:
    """Return the shapes of an automatic inertial with the densities of collisions, and the mass
    that is stated beside them.
    """
    default = number(_text(inertial, "density"), WATER)
    densities = {
        part.place: number(_text(part, "density"), default) for part in node.all("collision")
    }
    weighed = tuple(
        replace(shape, weight=Weight(None, densities[shape.place], CLOSED))
        if shape.role == "collision"
        else shape
        for shape in shapes
    )
    return weighed, Rules(mass=number(_text(inertial, "mass"), 0.0))


def _text(node: Node, *path: str) -> str:
    """Return the text of the element along a path of tags, "" if there is none."""
    element = node.find(*path)
    return "" if element is None else element.text.strip()


def _inertial(node: Node) -> StatedInertial:
    pose, angles, quaternion, _ = _pose(node)
    # The default is the unit tensor.
    tensor = symmetric_tensor(
        lambda name: number(_text(node, "inertia", name), float(name[1] == name[2]))
    )
    mass = number(_text(node, "mass"), 1.0)
    return StatedInertial(mass, pose.position, tensor, pose.rotation, angles, quaternion)


def _pose(node: Node) -> tuple[Pose, Angles | None, tuple[float, ...] | None, str]:
    """Return a pose, its angles or its quaternion as stated, and the name of the frame that it is
    in, "" by default.
    """
    element = node.find("pose") or Node("pose", {}, NOWHERE)
    text = element.text
    frame = element.get("relative_to")
    if element.get("rotation_format") == "quat_xyzw":
        x, y, z, qx, qy, qz, qw = numbers(text, 7, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)).tolist()
        if not any((qx, qy, qz, qw)):
            raise ValueError(text)
        quaternion = (qw, qx, qy, qz)
        return Pose(np.array([x, y, z]), rotation_matrix(quaternion)), None, quaternion, frame
    values = numbers(text, 6, (0.0,) * 6)
    roll, pitch, yaw = values[3:].tolist()
    if element.get("degrees") in TRUE:
        roll, pitch, yaw = map(radians, (roll, pitch, yaw))
    return Pose(values[:3], rotation_of_angles(roll, pitch, yaw)), (roll, pitch, yaw), None, frame
