# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of MJCF: the inertials and shapes of its bodies, and their joints.

It applies defaults by class, the compiler's angle unit and Euler order, and mesh folders. Models
that it attaches have their own.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import radians
from typing import NamedTuple

import numpy as np

from ...files import parse_numbers
from ...mesh import Surface, convex_hull
from ...numerics import (
    Array,
    NDArray,
    inertia_of_second,
    rotation_about,
    rotation_matrix,
    second_of_inertia,
)
from ...verdict import Finding, MeasureError
from ..model import Pose, Shape
from ..stated import (
    LEAST,
    MOST,
    Angles,
    Description,
    Motion,
    Rules,
    StatedInertial,
    StatedJoint,
    StatedLink,
    StatedShape,
)
from .meshes import checked_surface
from .mjcf_meshes import LEGACY, WATER, Fit, Weight, builtin_surface
from .xml import (
    FLAT_KINDS,
    Node,
    attempt,
    axis_of,
    check_size,
    direction,
    number,
    numbers,
    stated_link,
)

SQUARE_ATOL = 1e-9  # entries of a rotation between axes are 0 or 1 up to this
SIZES = {"sphere": 1, "ellipsoid": 3, "box": 3, "capsule": 2, "cylinder": 2}


class _Model:
    """The settings and assets of a whole file. count: counts the elements of all models
    together.
    """

    def __init__(self, root: Node, count: Iterator[int]) -> None:
        self.root = root
        self.count = count
        self.compiler: dict[str, str] = {}
        self.meshes: dict[str, Node] = {}
        self.models: dict[str, _Model] = {}
        self._shapes: dict[Node, Shape] = {}  # shapes of the meshes that were read
        self._classes: dict[str, dict[str, dict[str, str]]] = {}
        for compiler in root.all("compiler"):
            if compiler.get("assetdir"):
                self.compiler["meshdir"] = compiler.get("assetdir")
            self.compiler |= compiler.attributes
        self.euler = self.compiler.get("eulerseq", "xyz")
        for defaults in root.all("default"):
            self._add_defaults(defaults, "main", {})
        # The equalities that a joint follows another one by, by the name of the follower.
        self.followers = {
            node.get("joint1"): node
            for equality in root.all("equality")
            for node in equality.all("joint")
            if node.get("joint2")
            and self.attributes(node, "main", "equality").get("active") != "false"
        }
        for asset in (asset for assets in root.all("asset") for asset in assets.children):
            if asset.tag == "mesh":
                file_stem = _file_name(asset.get("file")).rpartition(".")[0]
                self.meshes[asset.get("name") or file_stem] = asset
            elif asset.tag == "model" and asset.children:
                (inner,) = asset.children
                self.models[asset.get("name") or inner.get("model")] = _Model(inner, count)

    def _add_defaults(self, node: Node, name: str, above: dict[str, dict[str, str]]) -> None:
        """Add a class of defaults and those in it. above: the values that it inherits, by tag."""
        by_tag = {tag: dict(values) for tag, values in above.items()}
        self._classes[name] = by_tag
        for child in node.children:
            if child.tag != "default":
                by_tag.setdefault(child.tag, {}).update(child.attributes)
        for child in node.all("default"):
            self._add_defaults(child, child.get("class"), by_tag)

    def attributes(self, node: Node, current: str = "main", tag: str = "") -> dict[str, str]:
        """Return the attributes of an element and its defaults. current: the class of those that
        name none. tag: that of the defaults, if it is another one.
        """
        defaults = self._classes.get(node.get("class") or current, {})
        return defaults.get(tag or node.tag, {}) | node.attributes

    def is_set(self, name: str) -> bool:
        """Return whether an attribute of the compiler is true."""
        return self.compiler.get(name) == "true"

    def rules(self) -> Rules:
        """Return the changes of inertials. ValueError, with the text, if a number is wrong."""
        return Rules(
            self.compiler.get("inertiafromgeom", "auto"),
            number(self.compiler.get("boundmass", ""), 0.0),
            number(self.compiler.get("boundinertia", ""), 0.0),
            self.is_set("balanceinertia"),
        )

    def mesh(self, node: Node) -> Shape:
        """Return the mesh of an asset, which MuJoCo moves and turns before it scales it."""
        if node not in self._shapes:
            values = self.attributes(node)
            # The file's own frame is moved and turned to `refpos` and `refquat`, back by them.
            frame = _Frame(self, scale=numbers(values.get("scale", ""), 3, (1.0, 1.0, 1.0)))
            reference = {"quat": values["refquat"]} if "refquat" in values else {}
            turn = _rotation(reference, self).matrix.T
            size = frame.scale_along(turn, values.get("refquat", ""))
            pose = frame.place(-turn @ numbers(values.get("refpos", ""), 3, (0.0, 0.0, 0.0)), turn)
            surface = _surface(values) if "vertex" in values else None
            if "builtin" in values:
                surface = builtin_surface(values["builtin"], values.get("params", ""))
            path = values.get("file", "")
            if self.is_set("strippath"):
                path = _file_name(path)
            folder = self.compiler.get("meshdir")
            if folder and not path.startswith("/"):
                path = folder + "/" + path
            self._shapes[node] = Shape("mesh", tuple(size.tolist()), pose, path, surface=surface)
        return self._shapes[node]


def _file_name(path: str) -> str:
    """Return the last part of a path with slashes of either kind."""
    return path.replace("\\", "/").rpartition("/")[2]


class _Frame(NamedTuple):
    """The frame that elements of a body stand in: its pose in the body, what scales it, and the
    class of its defaults.

    scale: (3,) along the frame's axes. mass: the factor of masses. prefix, suffix: of the names of
    bodies. attached: the elements `attach` that it is in. outer: the frame that names its elements
    without the last prefix or suffix.
    """

    model: _Model
    pose: Pose = Pose()
    scale: Array = np.ones(3)
    mass: float = 1.0
    defaults: str = "main"
    prefix: str = ""
    suffix: str = ""
    attached: tuple[Node, ...] = ()
    outer: _Frame | None = None

    @property
    def is_plain(self) -> bool:
        """True if it is the frame of the body itself."""
        pose = self.pose
        is_in_place = not pose.position.any() and bool((pose.rotation == np.eye(3)).all())
        return is_in_place and self.mass == 1.0 and bool((self.scale == 1.0).all())

    def full_name(self, node: Node) -> str:
        """Return the name of an element with prefix and suffix; "" if it states none."""
        name = node.get("name")
        return self.prefix + name + self.suffix if name else ""

    def enter(self, node: Node) -> _Frame:
        """Return the frame within an element `frame` in this one, or within a `body`: that is the
        body's own, scaled as this one.
        """
        turn = _rotation(node.attributes, self.model).matrix
        values = node.attributes if node.tag == "frame" else {}
        position = numbers(values.get("pos", ""), 3, (0.0, 0.0, 0.0))
        text = values.get("scale", "")
        factors = numbers(text, 3) if len(text.split()) > 1 else np.full(3, number(text, 1.0))
        if not ((factors >= LEAST) & (factors <= MOST)).all():
            raise ValueError(text)
        scale = self.scale_along(turn, text or node.get("name")) * factors
        # By default the mass scales as the volume.
        mass = self.mass * number(values.get("massscale", ""), float(factors.prod()))
        pose = Pose() if node.tag == "body" else self.place(position, turn)
        return self._replace(
            pose=pose, scale=scale, mass=mass, defaults=node.get("childclass") or self.defaults
        )

    def attach(self, node: Node) -> tuple[list[Node], _Frame]:
        """Return the elements that an element `attach` names, and their frame: a body or a frame of
        another model, or of this one if it names none, or all elements of the other model.

        ValueError, with the name, if there is no such model, body or frame.
        """
        model_name = node.get("model")
        names = {tag: node.get(tag) for tag in ("body", "frame") if node.get(tag)}
        # MuJoCo attaches a part of this model as it is at that place in the file: without this
        # node.
        if node in self.attached:
            return [], self
        is_own = names and not model_name
        model = self.model if is_own else self.model.models.get(model_name)
        if model is None:
            raise ValueError(model_name)
        worlds = model.root.all("worldbody")
        inner = self._replace(
            model=model,
            defaults="main",
            prefix=self.prefix + node.get("prefix"),
            attached=(*self.attached, node),
            outer=self,
        )
        if not names:
            return [child for world in worlds for child in world.children], inner
        # Find the named element, and the class of defaults that holds at its place.
        waiting = [(world, "main") for world in worlds]
        while waiting:
            part, above = waiting.pop()
            check_size(1, next(model.count))
            if part.tag in names and part.get("name") == names[part.tag]:
                return [part], inner._replace(defaults=above)
            waiting += [(child, part.get("childclass") or above) for child in part.children]
        raise ValueError(*names.values())

    def repeat(self, node: Node) -> list[_Frame]:
        """Return the frames of the copies that an element `replicate` makes of its content."""
        count = int(number(node.get("count")))
        check_size(1, count)
        offset = numbers(node.get("offset"), 3, (0.0, 0.0, 0.0))
        angles = numbers(node.get("euler"), 3, (0.0, 0.0, 0.0))
        digits = len(str(count - 1))
        position = np.zeros(3)
        frames = []
        for index in range(count):
            text = " ".join(map(repr, (angles * index).tolist()))
            turn = _rotation({"euler": text}, self.model).matrix
            scale = self.scale_along(turn, node.get("euler"))
            # The names of inner copies come before those of outer ones.
            suffix = "{}{:0{}d}{}".format(node.get("sep"), index, digits, self.suffix)
            pose = self.place(position, turn)
            frames.append(self._replace(pose=pose, scale=scale, suffix=suffix, outer=self))
            position = position + turn @ offset
        return frames

    def place(self, position: NDArray, turn: NDArray) -> Pose:
        """Return the pose in the body of a pose in this frame."""
        return self.pose @ Pose(self.scale * position, turn)

    def scale_along(self, turn: NDArray, text: str) -> Array:
        """Return the (3,) scale along turned axes. ValueError, with the text, if it would shear."""
        if not np.ptp(self.scale):
            return self.scale
        # Axes that stay axes have entries of 0 and 1.
        along = np.abs(turn.T)
        if np.abs(along * (1.0 - along)).max() > SQUARE_ATOL:
            raise ValueError(text)
        return np.round(along) @ self.scale


def read(root: Node, data: bytes) -> Description:
    """Return a description from the element `mujoco`."""
    outside = _Frame(_Model(root, itertools.count(1)))
    links: list[StatedLink] = []
    joints: list[StatedJoint] = []
    names = {node.get("name") for node in root.walk() if node.tag == "body"}
    for world in root.all("worldbody"):
        findings: list[Finding] = []  # of frames of the world, which the next body reports
        waiting = [("", part) for part in reversed([*_parts(world.children, outside, findings)])]
        while waiting:
            parent, (body, above) = waiting.pop()
            if body.tag != "body":
                continue
            frame = attempt(findings, body, above.enter) or above._replace(pose=Pose())
            parts = [*_parts(body.children, frame, findings)]
            pose = attempt(findings, body, _body_pose, above)
            motions = [
                attempt(findings, node, _motion, frame_of_joint)
                for node, frame_of_joint in parts
                if node.tag in ("joint", "freejoint")
            ]
            unnamed = "body {}".format(len(links) + 1)
            unnamed += " without name" * (unnamed in names)
            link = _link(body, frame, parts, unnamed, findings)
            links.append(link)
            usable = tuple(motion for motion in motions if motion is not None)
            joints.append(StatedJoint("", parent, link.name, pose or Pose(), usable, body.place))
            findings = []
            waiting += ((link.name, part) for part in reversed(parts))
    total = parse_numbers(outside.model.compiler.get("settotalmass", ""))
    return Description(
        root.get("model"), "mjcf", tuple(links), data, total=sum(total), joints=tuple(joints)
    )


def _body_pose(body: Node, above: _Frame) -> Pose:
    """Return the pose of a body in its parent's. above: the frame that it stands in."""
    position = numbers(body.get("pos"), 3, (0.0, 0.0, 0.0))
    return above.place(position, _rotation(body.attributes, above.model).matrix)


def _motion(joint: Node, frame: _Frame) -> Motion:
    values = frame.model.attributes(joint, frame.defaults)
    kind = "free" if joint.tag == "freejoint" else values.get("type", "hinge")
    unit = 1.0
    if kind == "hinge" and frame.model.compiler.get("angle") != "radian":
        unit = radians(1.0)
    name = frame.full_name(joint)
    leader = ""
    powers = (0.0, 1.0)
    # The equality may be in the joint's own model, or in one that attaches it and knows its prefix.
    scope: _Frame | None = frame
    while scope and not leader:
        inner_name = name[len(scope.prefix) :].removesuffix(scope.suffix)
        if follower := scope.model.followers.get(inner_name):
            leader = scope.prefix + follower.get("joint2") + scope.suffix
            powers = tuple(parse_numbers(follower.get("polycoef") or "0 1"))
        scope = scope.outer
    return Motion(
        name,
        kind,
        frame.pose.rotation @ axis_of(values.get("axis", ""), (0.0, 0.0, 1.0)),
        frame.place(numbers(values.get("pos", ""), 3, (0.0, 0.0, 0.0)), np.eye(3)).position,
        number(values.get("ref", ""), 0.0) * unit,
        leader,
        powers,
    )


def _parts(
    nodes: Sequence[Node], frame: _Frame, refused: list[Finding]
) -> Iterator[tuple[Node, _Frame]]:
    """Yield elements and their frames; also those in frames and attached models. refused: findings
    about wrong ones.
    """
    for node in nodes:
        check_size(1, next(frame.model.count))
        insides: Sequence[tuple[Sequence[Node], _Frame]] = ()
        if node.tag == "attach":
            inside = attempt(refused, node, frame.attach)
            insides = [inside] if inside else ()
        elif node.tag == "frame":
            inner = attempt(refused, node, frame.enter)
            insides = [(node.children, inner)] if inner else ()
        elif node.tag == "replicate":
            copies = attempt(refused, node, frame.repeat) or ()
            insides = [(node.children, copy) for copy in copies]
        else:
            yield node, frame
        for inside in insides:
            yield from _parts(*inside, refused)


def _link(
    body: Node,
    outer: _Frame,
    parts: Sequence[tuple[Node, _Frame]],
    unnamed: str,
    findings: list[Finding],
) -> StatedLink:
    """Return the link of a body. unnamed: its name if it states none. findings: those so far."""
    node, frame = next((part for part in parts if part[0].tag == "inertial"), (None, outer))
    inertial = attempt(findings, node, _inertial, frame)
    rules = attempt(findings, outer.model.root, lambda _: outer.model.rules())
    weighs = rules and (rules.from_shapes == "true" or node is None and rules.from_shapes == "auto")
    geoms = [
        attempt(findings, geom, _shape, inner, findings, weighs)
        for geom, inner in parts
        if geom.tag == "geom"
    ]
    shapes = tuple(shape for shape in geoms if shape is not None)
    name = outer.full_name(body) or unnamed
    values = {"inertial": inertial, "shapes": shapes, "moves": False, "rules": rules}
    link = stated_link(body, node, findings, name=name, **values)
    # Numbers in a frame are not those of the body; no repair fits them.
    return link if frame.is_plain else replace(link, span=None)


def _inertial(node: Node, frame: _Frame) -> StatedInertial:
    rotation, angles, quaternion = _rotation(node.attributes, frame.model)
    if node.get("fullinertia"):
        xx, yy, zz, xy, xz, yz = numbers(node.get("fullinertia"), 6, ())
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    else:
        tensor = np.diag(numbers(node.get("diaginertia"), 3, (0.0, 0.0, 0.0)))
    center = numbers(node.get("pos"), 3, (0.0, 0.0, 0.0))
    stated = StatedInertial(
        number(node.get("mass"), 0.0), center, tensor, rotation, angles, quaternion
    )
    if frame.is_plain:
        return stated
    # The second moments of the mass about the center scale with its place.
    second = second_of_inertia(stated.inertia)
    second = frame.mass * second * np.outer(frame.scale, frame.scale)
    pose = frame.place(center, np.eye(3))
    turn = frame.pose.rotation
    inertia = turn @ inertia_of_second(second) @ turn.T
    return StatedInertial(stated.mass * frame.mass, pose.position, inertia)


class Rotation(NamedTuple):
    """A (3, 3) rotation; roll, pitch and yaw, rad, and the quaternion, w first, if stated so."""

    matrix: Array
    angles: Angles | None = None
    quaternion: tuple[float, ...] | None = None


def _rotation(attributes: dict[str, str], model: _Model) -> Rotation:
    """Return the rotation that the attributes of an element state, by default none. ValueError,
    with the text, if it is wrong.
    """
    unit = 1.0 if model.compiler.get("angle") == "radian" else radians(1.0)
    if "quat" in attributes:
        values = numbers(attributes["quat"], 4, (1.0, 0.0, 0.0, 0.0))
        if not values.any():
            raise ValueError(attributes["quat"])
        return Rotation(rotation_matrix(values), quaternion=tuple(values.tolist()))
    if "euler" in attributes:
        first, second, third = (numbers(attributes["euler"], 3, (0.0, 0.0, 0.0)) * unit).tolist()
        matrix = np.eye(3)
        if len(model.euler) != 3 or not {*model.euler.lower()} <= {*"xyz"}:
            raise ValueError(model.euler)
        for axis, angle in zip(model.euler, (first, second, third)):
            step = rotation_about(np.eye(3)["xyz".index(axis.lower())], angle)
            # Small letters are axes that turn with the element, capital letters fixed axes.
            matrix = matrix @ step if axis.islower() else step @ matrix
        # About the fixed x, y and z in turn the angles are roll, pitch and yaw.
        return Rotation(matrix, (first, second, third) if model.euler == "XYZ" else None)
    if "axisangle" in attributes:
        text = attributes["axisangle"]
        values = numbers(text, 4, (0.0, 0.0, 1.0, 0.0))
        return Rotation(rotation_about(direction(values[:3], text), values[3] * unit))
    if "xyaxes" in attributes:
        text = attributes["xyaxes"]
        values = numbers(text, 6, ())
        x = direction(values[:3], text)
        stated_y = direction(values[3:], text)
        y = direction(stated_y - (stated_y @ x) * x, text)
        return Rotation(np.column_stack([x, y, np.cross(x, y)]))
    if "zaxis" in attributes:
        text = attributes["zaxis"]
        return Rotation(_upright(direction(numbers(text, 3, (0.0, 0.0, 1.0)), text)))
    return Rotation(np.eye(3))


def _upright(z: NDArray) -> Array:
    """Return the (3, 3) least rotation from the z axis to a unit vector."""
    # (cos θ, sin θ n) = (z_3, k × z), with k along the z axis, is the quaternion of twice the turn
    # θ; its sum with that of no turn, (1, 0), is that of the turn, up to its length.
    half = np.array([1.0 + z[2], -z[1], z[0], 0.0])
    return rotation_matrix(half if half.any() else [0.0, 1.0, 0.0, 0.0])


def _shape(geom: Node, frame: _Frame, findings: list[Finding], weighs: bool) -> StatedShape | None:
    """Return the shape of a geom in its body. findings: gets those about its mesh. weighs: True if
    its mass may count.
    """
    model = frame.model
    attributes = model.attributes(geom, frame.defaults)
    rotation, angles, _ = _rotation(attributes, model)
    pose = Pose(numbers(attributes.get("pos", ""), 3, (0.0, 0.0, 0.0)), rotation)
    kind = attributes.get("type", "sphere")
    inertia = "shell" if attributes.get("shellinertia") == "true" else ""
    fit = None
    if kind == "mesh" or "mesh" in attributes and kind in SIZES:
        asset = model.meshes.get(attributes.get("mesh", ""))
        shape = Shape("mesh") if asset is None else attempt(findings, asset, model.mesh)
        shape = shape and replace(shape, pose=pose @ shape.pose)
        mesh_inertia = model.attributes(asset).get("inertia", LEGACY) if asset else LEGACY
        if kind == "mesh":
            inertia = mesh_inertia
        else:
            factor = number(attributes.get("fitscale", ""), 1.0)
            fit = Fit(kind, mesh_inertia, model.is_set("fitaabb"), factor)
    else:
        shape = _primitive(kind, attributes, pose)
    if shape is None:
        return None
    is_as_stated = frame.is_plain and bool((shape.pose.rotation == rotation).all())
    collides = attributes.get("contype", "1") != "0" or attributes.get("conaffinity", "1") != "0"
    scaled = _scaled(shape, frame, geom.get("name"))
    groups = numbers(model.compiler.get("inertiagrouprange", ""), 2, (0.0, 5.0))
    counts = weighs and groups[0] <= number(attributes.get("group", ""), 0.0) <= groups[1]
    return StatedShape(
        scaled,
        "collision" if collides else "visual",
        angles if is_as_stated else None,
        geom.place,
        model.root.place.file,
        fit,
        _weight(attributes, frame, inertia) if counts else None,
    )


def _scaled(shape: Shape, frame: _Frame, name: str) -> Shape:
    """Return a shape of a frame in the body. ValueError, with the name, if it is no longer round,
    or sheared.
    """
    turn = shape.pose.rotation
    scale = frame.scale_along(turn, name)
    round_axes = {"sphere": 3, "capsule": 2, "cylinder": 2}.get(shape.kind, 0)
    if round_axes and np.ptp(scale[:round_axes]):
        raise ValueError(name)
    factors = scale[[0, 2]] if round_axes == 2 else scale[: len(shape.size)]
    size = tuple((np.array(shape.size) * factors).tolist())
    return replace(shape, size=size, pose=frame.place(shape.pose.position, turn))


def _weight(attributes: dict[str, str], frame: _Frame, inertia: str) -> Weight:
    """Return the mass of a geom. inertia: as of a Weight."""
    mass = attributes.get("mass")
    # The frame scales the mass, so the density of the scaled volume or area changes by the rest.
    content = float(frame.scale.prod()) ** (2.0 / 3.0 if inertia == "shell" else 1.0)
    density = number(attributes.get("density", ""), WATER) * frame.mass / content
    return Weight(None if mass is None else number(mass) * frame.mass, density, inertia)


def _primitive(kind: str, attributes: dict[str, str], pose: Pose) -> Shape | None:
    """Return the shape of a geom in its frame, None if it bounds no volume. pose: unless it states
    both of its ends.
    """
    size = parse_numbers(attributes.get("size", ""))
    if kind in FLAT_KINDS:
        return None
    if kind not in SIZES:
        raise ValueError(kind)
    has_ends = "fromto" in attributes and kind != "sphere"
    if len(size) < (1 if has_ends else SIZES[kind]):
        raise ValueError(attributes.get("size", ""))
    if has_ends:
        ends = numbers(attributes["fromto"], 6, ())
        along = ends[:3] - ends[3:]
        length = float(np.linalg.norm(along))
        turn = _upright(direction(along, attributes["fromto"]))
        sizes = {
            "box": (2.0 * size[0], 2.0 * size[0], length),
            "ellipsoid": (size[0], size[0], length / 2.0),
        }
        return Shape(
            kind, sizes.get(kind, (size[0], length)), Pose((ends[:3] + ends[3:]) / 2.0, turn)
        )
    # The index of the first size that is half of ours.
    halves = {"box": 0, "capsule": 1, "cylinder": 1}.get(kind, 3)
    values = tuple(
        2.0 * value if place >= halves else value for place, value in enumerate(size[: SIZES[kind]])
    )
    return Shape(kind, values, pose)


def _surface(values: dict[str, str]) -> Surface:
    """Return the mesh of an asset's vertices and faces; without faces, the convex hull of the
    vertices.
    """
    vertices = values["vertex"]
    faces = values.get("face", "")
    points = np.array(parse_numbers(vertices))
    corners = np.array(parse_numbers(faces))
    if not faces:
        try:
            hull = convex_hull(points.reshape(-1, 3))
        except (MeasureError, ValueError) as error:
            raise ValueError(vertices[:80]) from error
        points = hull.points.ravel()
        corners = hull.triangles.ravel()
    return checked_surface(
        (vertices, faces, faces), points, np.full(-(-len(corners) // 3), 3), corners
    )
