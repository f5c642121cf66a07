# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of SDFormat: the inertials and shapes of its models' links, and their joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import radians

import numpy as np

from ...numerics import rotation_matrix
from ...verdict import Finding
from ..model import Pose
from ..stated import (
    ENTRIES,
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
    axis_of,
    check_names,
    number,
    numbers,
    read_shapes,
    stated_link,
)

KINDS = ("box", "ellipsoid", "sphere", "cylinder", "capsule")
OWN = "__model__"  # the name of a model's frame within itself
HINGES = ("revolute", "continuous", "universal", "revolute2")


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `sdf`: all links, wherever their models are."""
    models = [node for node in root.walk() if node.tag == "model"]
    # Siblings have names of their own; content of plugins is free.
    for node in (root, *root.all("world"), *models):
        for tag in ("model", "link", "joint"):
            check_names("sdf", [(one.get("name"), one.place) for one in node.all(tag)])
    scopes: dict[Node, _Scope] = {}
    outer = {inner: model for model in models for inner in model.all("model")}
    scopes.update((model, _Scope(model, scopes)) for model in models)
    is_one = len(models) - len(outer) == 1
    findings: list[Finding] = []

    def in_world(model: Node) -> Pose:
        """Return the pose of a model in the world, or of a single one in itself."""
        if model not in outer:
            return Pose() if is_one else _pose(model)[0]
        return in_world(outer[model]) @ scopes[outer[model]].pose(model.get("name"))

    def place(node: Node, model: Node) -> Pose:
        """Return the pose of a link or joint of a model."""
        return in_world(model) @ scopes[model].pose(node.get("name"))

    several = len(models) > 1
    links = tuple(
        replace(
            _link(node, model, scopes[model], several), pose=attempt(findings, node, place, model)
        )
        for model in models
        for node in model.all("link")
    )
    joints = [
        attempt(findings, node, _joint, model, scopes[model], place, several)
        for model in models
        for node in model.all("joint")
    ]
    return Description(
        models[0].get("name") if models else "",
        "sdf",
        links,
        data,
        joints=tuple(joint for joint in joints if joint is not None),
        findings=tuple(findings),
    )


class _Scope:
    """The frames of a model by their names, each in another one of them. scopes: those of all
    models.
    """

    def __init__(self, model: Node, scopes: dict[Node, _Scope]) -> None:
        frames = [
            child for child in model.children if child.tag in ("link", "joint", "frame", "model")
        ]
        self._model = model
        self._frames = {frame.get("name"): frame for frame in frames}
        self._scopes = scopes
        self._poses = {OWN: Pose()}

    def pose(self, name: str, depth: int = 0) -> Pose:
        """Return the pose of a frame in the model. ValueError if it is unknown, or in itself."""
        if name not in self._poses:
            first, _, rest = name.partition("::")
            node = self._frames.get(first)
            if node is None or rest and node.tag != "model" or depth > MAX_DEPTH:
                raise ValueError(name)
            default = {"joint": _text(node, "child"), "frame": node.get("attached_to")}.get(
                node.tag
            )
            own, _, _, outer = _pose(node)
            pose = self.pose(outer or default or OWN, depth + 1) @ own
            if node.tag == "model":
                inner = self._scopes[node]
                place = node.get("placement_frame") or OWN
                pose = (
                    pose
                    @ inner.pose(place, depth + 1).inverse()
                    @ inner.pose(rest or OWN, depth + 1)
                )
            self._poses[name] = pose
        return self._poses[name]

    def link_of(self, name: str, depth: int = 0) -> tuple[Node, Node | None]:
        """Return the model and the link that a frame is fixed to; without one, the name is
        unknown.
        """
        first, _, rest = name.partition("::")
        node = self._frames.get(first)
        if node is None or depth > MAX_DEPTH or node.tag == "link":
            return self._model, node
        if node.tag == "model":
            inner = self._scopes[node]
            canonical = node.get("canonical_link") or next(
                (link.get("name") for link in node.all("link")), ""
            )
            return inner.link_of(rest or canonical, depth + 1)
        return self.link_of(_text(node, "child") or node.get("attached_to"), depth + 1)


def _joint(
    node: Node, model: Node, scope: _Scope, place: Callable[[Node, Node], Pose], several: bool
) -> StatedJoint:
    """Return a joint between links. place: returns the pose of a link or joint of a model. several:
    True if the names of links need their model's.
    """
    name = node.get("name")
    kind = node.get("type")
    kind = "hinge" if kind in HINGES else {"prismatic": "slide"}.get(kind, kind)
    links = {tag: scope.link_of(_text(node, tag)) for tag in ("parent", "child")}
    ends = {
        tag: _text(node, tag) if link is None else _link_name(link, inner, several)
        for tag, (inner, link) in links.items()
    }
    inner, child = links["child"]
    motions = [Motion(name, kind)]
    if child is not None and kind in ("hinge", "slide"):
        own = place(child, inner).inverse() @ place(node, model)
        motions = []
        for tag, label in (("axis", name), ("axis2", name + " axis2")):
            element = node.find(tag, "xyz")
            frame = "" if element is None else element.get("expressed_in")
            if node.find(tag) or tag == "axis":
                turn = own.rotation
                if frame:
                    turn = (own @ scope.pose(name).inverse() @ scope.pose(frame)).rotation
                axis = axis_of("" if element is None else element.text, (0.0, 0.0, 1.0))
                motion = Motion(label, kind, turn @ axis, own.position)
                if mimic := node.find(tag, "mimic"):
                    leader = mimic.get("joint") + " axis2" * (mimic.get("axis") == "axis2")
                    factor = number(_text(mimic, "multiplier"), 1.0)
                    offset = number(_text(mimic, "offset"), 0.0)
                    offset -= factor * number(_text(mimic, "reference"), 0.0)
                    motion = motion._replace(leader=leader, powers=(offset, factor))
                motions.append(motion)
    parent = "" if ends["parent"] == "world" else ends["parent"] or "?"
    return StatedJoint(name, parent, ends["child"], None, tuple(motions), node.place)


def _link_name(link: Node, model: Node, several: bool) -> str:
    name = link.get("name")
    return "{}::{}".format(model.get("name"), name) if several else name


def _link(node: Node, model: Node, scope: _Scope, several: bool) -> StatedLink:
    findings: list[Finding] = []
    element = node.find("inertial")
    is_auto = element is not None and element.get("auto") in ("true", "1")
    inertial = None if is_auto else attempt(findings, element, _inertial)

    def pose_of(part: Node) -> tuple[Pose, Angles | None]:
        pose, angles, _, frame = _pose(part)
        if not frame:
            return pose, angles
        try:
            return scope.pose(node.get("name")).inverse() @ scope.pose(frame) @ pose, None
        except ValueError as error:
            raise ValueError(frame) from error

    shapes = read_shapes(findings, node, pose_of, KINDS, _text, 1.0, node.place.file)
    rules = None
    if is_auto:
        shapes, rules = attempt(findings, node, _weights, element, shapes) or (shapes, None)
    static = _text(model, "static") in ("true", "1")
    name = _link_name(node, model, several)
    moves = not static and (is_auto or bool(shapes) and element is None)
    values = {"name": name, "inertial": inertial, "shapes": shapes, "rules": rules}
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
    found = node.find(*path)
    return "" if found is None else found.text.strip()


def _inertial(node: Node) -> StatedInertial:
    pose, angles, quaternion, _ = _pose(node)
    tensor = np.eye(3)
    for name, i, j in ENTRIES:
        tensor[i, j] = tensor[j, i] = number(_text(node, "inertia", name), float(i == j))
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
        return (
            Pose(np.array([x, y, z]), rotation_matrix([qw, qx, qy, qz])),
            None,
            (qw, qx, qy, qz),
            frame,
        )
    values = numbers(text, 6, (0.0,) * 6)
    roll, pitch, yaw = values[3:].tolist()
    if element.get("degrees") in ("true", "1"):
        roll = radians(roll)
        pitch = radians(pitch)
        yaw = radians(yaw)
    return Pose(values[:3], rotation_of_angles(roll, pitch, yaw)), (roll, pitch, yaw), None, frame
