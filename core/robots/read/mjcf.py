# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of MJCF: the inertials and shapes of its bodies.

It applies defaults by class, the compiler's angle unit and Euler order, and mesh folders.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import inf, radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...numerics.rotations import rotation_matrix
from ...verdict.finding import Finding
from ...verdict.number_text import parse_numbers
from ..model import Pose, Shape
from ..stated import (
    LEAST,
    MOST,
    Angles,
    Description,
    Place,
    StatedInertial,
    StatedLink,
    StatedShape,
    rotation_about,
)
from .xml import NOWHERE, Node, attempt, number, numbers

SQUARE_ATOL = 1e-9  # of the entries of a rotation between axes, which are 0 or 1
LEAST_LENGTH = 1e-14  # of a direction; shorter ones are rounding errors, also for MuJoCo
SIZES = {"sphere": 1, "ellipsoid": 3, "box": 3, "capsule": 2, "cylinder": 2}


@dataclass(eq=False)
class _Model:
    """The settings of a whole file."""

    degrees: bool = True
    euler: str = "xyz"
    mesh_folder: str = ""
    meshes: dict[str, tuple[str, str]] = field(default_factory=dict)  # path and scale
    classes: dict[str, dict[str, dict[str, str]]] = field(default_factory=dict)


class _Frame(NamedTuple):
    """The frame that elements of a body stand in: its pose in the body, what scales it, and the class of its defaults.

    scale: (3,) along the frame's axes. mass: the factor of masses.
    """

    pose: Pose = Pose()
    scale: NDArray[np.float64] = np.ones(3)
    mass: float = 1.0
    defaults: str = "main"

    @property
    def is_plain(self) -> bool:
        """True if it is the frame of the body itself."""
        pose = self.pose
        is_in_place = not pose.position.any() and bool((pose.rotation == np.eye(3)).all())
        return is_in_place and self.mass == 1.0 and bool((self.scale == 1.0).all())

    def enter(self, node: Node, model: _Model) -> _Frame:
        """Return the frame of an element `frame` in this one."""
        turn, position = _rotation(node.attributes, model)[0], numbers(node.get("pos"), 3, (0.0, 0.0, 0.0))
        text = node.get("scale")
        own = numbers(text, 3) if len(text.split()) > 1 else np.full(3, number(text, 1.0))
        if not ((own >= LEAST) & (own <= MOST)).all():
            raise ValueError(text)
        scale = self.scale_along(turn, text) * own
        mass = self.mass * number(node.get("massscale"), float(own.prod()))
        return _Frame(self.place(position, turn), scale, mass, node.get("childclass") or self.defaults)

    def enter_body(self, node: Node, model: _Model) -> _Frame:
        """Return the frame of an element `body` in this one: its own, scaled as this one."""
        turn, text = _rotation(node.attributes, model)[0], node.get("name")
        return _Frame(Pose(), self.scale_along(turn, text), self.mass, node.get("childclass") or self.defaults)

    def place(self, position: NDArray, turn: NDArray) -> Pose:
        """Return the pose in the body of a pose in this frame."""
        return self.pose @ Pose(self.scale * position, turn)

    def scale_along(self, turn: NDArray, text: str) -> NDArray[np.float64]:
        """Return the (3,) scale along turned axes. ValueError, with the text, if it would shear."""
        along = np.abs(turn.T)
        if np.ptp(self.scale) and np.abs(along * (1.0 - along)).max() > SQUARE_ATOL:
            raise ValueError(text)
        return np.round(along) @ self.scale if np.ptp(self.scale) else self.scale


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `mujoco`."""
    model = _settings(root)
    links: list[StatedLink] = []
    for world in root.all("worldbody"):
        refused: list[Finding] = []  # of frames of the world, which the bodies in them report
        waiting = [*reversed([part for part in _parts(world, _Frame(), model, refused) if part[0].tag == "body"])]
        while waiting:
            body, above = waiting.pop()
            outer = attempt(refused, body, above.enter_body, model) or _Frame()
            parts = [*_parts(body, outer, model, refused)]
            links.append(_link(body, parts, model, len(links), refused))
            refused = []
            waiting += reversed([part for part in parts if part[0].tag == "body"])
    return Description(root.get("model"), "mjcf", tuple(links), data)


def _parts(body: Node, frame: _Frame, model: _Model, refused: list[Finding]) -> Iterator[tuple[Node, _Frame]]:
    """Yield the children of a body and of its frames, with their frames. refused: findings about wrong frames."""
    for child in body.children:
        if child.tag != "frame":
            yield child, frame
            continue
        inner = attempt(refused, child, frame.enter, model)
        if inner is not None:
            yield from _parts(child, inner, model, refused)


def _settings(root: Node) -> _Model:
    model = _Model()
    for compiler in root.all("compiler"):
        model.degrees = compiler.get("angle", "degree" if model.degrees else "radian") != "radian"
        model.euler = compiler.get("eulerseq", model.euler)
        model.mesh_folder = compiler.get("meshdir", compiler.get("assetdir", model.mesh_folder))
    for defaults in root.all("default"):
        _defaults(defaults, "main", {}, model)
    of_mesh = model.classes.get("main", {}).get("mesh", {})
    for assets in root.all("asset"):
        for mesh in assets.all("mesh"):
            file = mesh.get("file")
            name = mesh.get("name") or file.replace("\\", "/").rpartition("/")[2].rpartition(".")[0]
            path = file if file.startswith("/") or not model.mesh_folder else model.mesh_folder + "/" + file
            model.meshes[name] = path, mesh.get("scale", of_mesh.get("scale", ""))
    return model


def _defaults(node: Node, name: str, above: dict[str, dict[str, str]], model: _Model) -> None:
    own = {tag: dict(values) for tag, values in above.items()}
    for child in node.children:
        if child.tag != "default":
            own.setdefault(child.tag, {}).update(child.attributes)
    model.classes[name] = own
    for child in node.all("default"):
        _defaults(child, child.get("class"), own, model)


def _link(
    body: Node, parts: Sequence[tuple[Node, _Frame]], model: _Model, count: int, refused: Sequence[Finding]
) -> StatedLink:
    findings = [*refused]
    node, frame = next((part for part in parts if part[0].tag == "inertial"), (None, _Frame()))
    inertial = attempt(findings, node, _inertial, frame, model)
    read = (attempt(findings, geom, _shape, inner, model) for geom, inner in parts if geom.tag == "geom")
    shapes = tuple(shape for shape in read if shape is not None)
    # Numbers in a frame are not those of the body, so that repairs do not fit them.
    span = None if node is None or node.start == NOWHERE or not frame.is_plain else (node.start, node.end)
    name = body.get("name") or "body {}".format(count + 1)
    places = body.place, (node or body).place
    # Without an inertial MuJoCo takes it from geoms.
    return StatedLink(name, inertial, shapes, span, False, tuple(findings), None, *places)


def _inertial(node: Node, frame: _Frame, model: _Model) -> StatedInertial:
    rotation, angles, quaternion = _rotation(node.attributes, model)
    if node.get("fullinertia"):
        xx, yy, zz, xy, xz, yz = numbers(node.get("fullinertia"), 6, ())
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        tensor = np.diag(numbers(node.get("diaginertia"), 3, (0.0, 0.0, 0.0)))
    center = numbers(node.get("pos"), 3, (0.0, 0.0, 0.0))
    stated = StatedInertial(number(node.get("mass"), 0.0), center, tensor, rotation, angles, quaternion)
    if frame.is_plain:
        return stated
    # The second moments of the mass about the center scale with its place.
    second = np.trace(tensor) / 2.0 * np.eye(3) - stated.inertia
    second = frame.mass * second * np.outer(frame.scale, frame.scale)
    pose, turn = frame.place(center, np.eye(3)), frame.pose.rotation
    inertia = turn @ (np.trace(second) * np.eye(3) - second) @ turn.T
    return StatedInertial(stated.mass * frame.mass, pose.position, inertia)


Rotation = tuple[NDArray[np.float64], Angles | None, tuple[float, ...] | None]


def _rotation(attributes: dict[str, str], model: _Model) -> Rotation:
    """Return the (3, 3) rotation, roll, pitch and yaw if stated, and the quaternion if stated, of an element."""
    unit = radians(1.0) if model.degrees else 1.0
    if "quat" in attributes:
        values = numbers(attributes["quat"], 4, (1.0, 0.0, 0.0, 0.0))
        if not values.any():
            raise ValueError(attributes["quat"])
        return rotation_matrix(values), None, tuple(values.tolist())
    if "euler" in attributes:
        first, second, third = (numbers(attributes["euler"], 3, (0.0, 0.0, 0.0)) * unit).tolist()
        turn = np.eye(3)
        if len(model.euler) != 3 or not {*model.euler.lower()} <= {*"xyz"}:
            raise ValueError(model.euler)
        for axis, angle in zip(model.euler, (first, second, third)):
            step = rotation_about(np.eye(3)["xyz".index(axis.lower())], angle)
            turn = turn @ step if axis.islower() else step @ turn
        fixed_axes = model.euler == "XYZ"
        return turn, (first, second, third) if fixed_axes else None, None
    if "axisangle" in attributes:
        values = numbers(attributes["axisangle"], 4, (0.0, 0.0, 1.0, 0.0))
        return rotation_about(_direction(values[:3], attributes["axisangle"]), values[3] * unit), None, None
    if "xyaxes" in attributes:
        values = numbers(attributes["xyaxes"], 6, ())
        x = _direction(values[:3], attributes["xyaxes"])
        y = _direction(values[3:], attributes["xyaxes"])
        y = _direction(y - (y @ x) * x, attributes["xyaxes"])
        return np.column_stack([x, y, np.cross(x, y)]), None, None
    if "zaxis" in attributes:
        z = _direction(numbers(attributes["zaxis"], 3, (0.0, 0.0, 1.0)), attributes["zaxis"])
        half = np.array([1.0 + z[2], -z[1], z[0], 0.0])
        return rotation_matrix(half if half.any() else [0.0, 1.0, 0.0, 0.0]), None, None
    return np.eye(3), None, None


def _direction(vector: NDArray, text: str) -> NDArray[np.float64]:
    length = np.linalg.norm(vector)
    if not LEAST_LENGTH < length < inf:
        raise ValueError(text)
    return vector / length


def _shape(geom: Node, frame: _Frame, model: _Model) -> StatedShape | None:
    """Return the shape of a geom in its body."""
    stated = _own_shape(geom, frame.defaults, model)
    if stated is None:
        return None
    shape, text = stated.shape, geom.get("name")
    scale = frame.scale_along(shape.pose.rotation, text)
    round_axes = {"sphere": 3, "capsule": 2, "cylinder": 2}.get(shape.kind, 0)
    if round_axes and np.ptp(scale[:round_axes]):
        raise ValueError(text)  # It is no longer round.
    factors = scale[[0, 2]] if round_axes == 2 else scale[: len(shape.size)]
    size = tuple((np.array(shape.size) * factors).tolist())
    pose = frame.place(shape.pose.position, shape.pose.rotation)
    angles = stated.angles if frame.is_plain else None
    return replace(stated, shape=replace(shape, size=size, pose=pose), angles=angles, place=Place(*geom.place[:2]))


def _own_shape(geom: Node, current: str, model: _Model) -> StatedShape | None:
    attributes = {**model.classes.get(geom.get("class") or current, {}).get("geom", {}), **geom.attributes}
    kind = attributes.get("type", "mesh" if "mesh" in attributes else "sphere")
    rotation, angles, _ = _rotation(attributes, model)
    position = numbers(attributes.get("pos", ""), 3, (0.0, 0.0, 0.0))
    collides = attributes.get("contype", "1") != "0" or attributes.get("conaffinity", "1") != "0"
    role = "collision" if collides else "visual"
    size = parse_numbers(attributes.get("size", ""))
    if kind == "mesh":
        file, text = model.meshes.get(attributes.get("mesh", ""), ("", ""))
        scale = tuple(numbers(text, 3, (1.0, 1.0, 1.0)).tolist())
        return StatedShape(Shape("mesh", scale, Pose(position, rotation), file), role, angles)
    if kind not in SIZES:
        return None
    has_ends = "fromto" in attributes and kind in ("capsule", "cylinder")
    if len(size) < (1 if has_ends else SIZES[kind]):
        raise ValueError(attributes.get("size", ""))
    if has_ends:
        ends = numbers(attributes["fromto"], 6, ())
        along = ends[:3] - ends[3:]
        length = float(np.linalg.norm(along))
        along = _direction(along, attributes["fromto"])
        rotation, _, _ = _rotation({"zaxis": " ".join(map(repr, along.tolist()))}, model)
        pose = Pose((ends[:3] + ends[3:]) / 2.0, rotation)
        return StatedShape(Shape(kind, (size[0], length), pose), role)
    halves = {"box": 0, "capsule": 1, "cylinder": 1}.get(kind, 3)  # index of the first half of a length
    values = tuple(2.0 * value if place >= halves else value for place, value in enumerate(size[: SIZES[kind]]))
    return StatedShape(Shape(kind, values, Pose(position, rotation)), role, angles)
