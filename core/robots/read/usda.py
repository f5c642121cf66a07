# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""USD as text: rigid bodies with PhysicsMassAPI, and the meshes and primitives below them.

Only one layer is read: prims, their metadata and attributes. Layers that it refers to are not
opened; a prim that refers to another of the layer has its attributes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import inf

import numpy as np

from ...files import parse_number
from ...mesh import Surface
from ...numerics import Array, NDArray, polar_rotation, rotation_about, rotation_matrix
from ...verdict import FileError, Finding, finding
from ..findings import DESCRIPTION_INVALID, DESCRIPTION_NUMBER
from ..model import Pose, Shape
from ..stated import (
    LEAST,
    MOST,
    Description,
    Motion,
    Place,
    Rules,
    StatedInertial,
    StatedJoint,
    StatedLink,
    StatedShape,
)
from .meshes import checked_surface
from .mjcf_meshes import CLOSED, WATER, Weight
from .xml import attempt, check_size

_TOKEN = re.compile(
    r'\s+|#[^\n]*|"""(?:.|\n)*?"""|\'\'\'(?:.|\n)*?\'\'\'|'
    r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    r"|@@@(?:.|\n)*?@@@|@[^@\n]*@|<[^>\n]*>|[(){}\[\]=,;]|[^\s(){}\[\]=,;\"'@<#]+|."
)
_FIELD = re.compile(r"[^\s()\[\],]+")
_REFERENCE = re.compile(r"\breferences\s*=\s*\[?\s*<([^>]*)>")
OTHER_SOLIDS = ("Cone", "Capsule_1", "Cylinder_1", "NurbsPatch", "PointInstancer", "TetMesh")
JOINTS = {
    "PhysicsRevoluteJoint": "hinge",
    "PhysicsPrismaticJoint": "slide",
    "PhysicsFixedJoint": "fixed",
    "PhysicsSphericalJoint": "ball",
    "PhysicsJoint": "several axes",
}
BALL_RADIUS = 0.1  # m, of the ball that stands for a body of known mass without colliders
JOINT_AXES = ("X", "Y", "Z")
TRUE = ("true", "1")
SINGLE_RTOL = 1e-5  # rounding of places and turns in single precision
_SPECIFIERS = {"def", "over", "class"}


@dataclass(eq=False)
class Prim:
    """One prim. values: attributes as text. text: that of the layer. start, end: its range between
    the prim's braces, in characters.

    line: that of its opening brace.
    """

    kind: str
    name: str
    metadata: str
    text: str
    start: int
    line: int
    end: int = 0
    values: dict[str, str] = field(default_factory=dict)
    children: list[Prim] = field(default_factory=list)

    def numbers(self, name: str) -> Array | None:
        """Return the numbers of an attribute, None if it has no value.

        ValueError if a text is no number.
        """
        if self.values.get(name, "None") == "None":
            return None
        words = _FIELD.findall(self.values[name].replace("inf", "INF"))
        return np.array([parse_number(word) for word in words], np.float64)

    def vector(self, name: str, default: tuple[float, ...]) -> Array:
        """Return the numbers of an attribute, else its default. ValueError if the counts differ."""
        values = self.numbers(name)
        count = len(default)
        if values is None:
            return np.array(default, np.float64)
        if len(values) != count:
            raise ValueError(self.values[name][:80])
        return values

    def unreadable(self, text: str) -> Finding:
        """Return the finding about a wrong number, at its line if it is in the prim."""
        place = max(self.text.find(text, self.start, self.end), self.start)
        line = self.text.count("\n", 0, place) + 1
        return finding(DESCRIPTION_NUMBER, text=text, element=self.name, line=line)

    def number(self, name: str, default: float) -> float:
        """Return the number of an attribute, else its default. ValueError if there are several."""
        return float(self.vector(name, (default,))[0])


class _Parser:
    def __init__(self, text: str) -> None:
        self.text = text
        self.tokens = [
            (match[0], match.start())
            for match in _TOKEN.finditer(text)
            if match[0].strip()[:1] not in "#"
        ]
        wrong = next((place for token, place in self.tokens if token in ('"', "'", "@", "<")), None)
        if wrong is not None:
            raise _invalid(text, wrong)
        self.index = 0
        self.count = 0  # number of prims
        self.line = 1  # line of the character at `counted`
        self.counted = 0

    def peek(self) -> str:
        return self.tokens[self.index][0] if self.index < len(self.tokens) else ""

    def take(self) -> tuple[str, int]:
        """Return the next token and its position. IndexError if the text ends."""
        self.index += 1
        return self.tokens[self.index - 1]

    def balanced(self) -> str:
        """Return the next word, or pair of brackets with its content."""
        depth = 0
        start = self.tokens[self.index][1]
        while True:
            token, position = self.take()
            if token in "([{":
                depth += 1
            elif token in ")]}":
                depth -= 1
            if depth <= 0:
                return self.text[start : position + len(token)]

    def prim(self, depth: int) -> Prim:
        self.count += 1
        check_size(depth, self.count)
        self.take()  # the specifier
        words = []
        while self.peek() not in ("(", "{", ""):
            words.append(self.take()[0])
        metadata = self.balanced() if self.peek() == "(" else ""
        kind, name = (words[0], words[-1].strip("\"'")) if words else ("", "")
        _, opening = self.take()
        self.line = self.line + self.text.count("\n", self.counted, opening)
        self.counted = opening
        prim = Prim(kind, name, metadata, self.text, opening + 1, self.line)
        while self.peek() != "}":
            if self.peek() in _SPECIFIERS:
                prim.children.append(self.prim(depth + 1))
            elif self.peek() in "([{":
                self.balanced()
            else:
                self.attribute(prim)
        prim.end = self.take()[1]
        return prim

    def attribute(self, prim: Prim) -> None:
        """Read a statement, and store the value after its equals sign, if it has one, in the
        prim.
        """
        words: list[str] = []
        while self.peek() not in ("=", "}", ";", "(") and self.peek() not in _SPECIFIERS:
            words.append(self.take()[0])
        if self.peek() != "=":  # metadata in brackets may follow, as it may behind a value
            if self.peek() == ";":
                self.take()
            return
        self.take()
        prim.values[words[-1] if words else ""] = self.balanced()


def read(data: bytes) -> Description:
    """Return a description of a layer's bodies. FileError if the data are no USD text."""
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise _invalid("", 0) from error
    try:
        with np.errstate(all="ignore"):  # wrong numbers are refused afterwards
            return _description(text, data)
    except (IndexError, KeyError, ValueError, RecursionError) as error:
        place = text.find(str(error)) if isinstance(error, ValueError) else -1
        raise _invalid(text, place if place >= 0 else len(text)) from error


def _invalid(text: str, place: int) -> FileError:
    """Return the error about a text at a place, with the beginning of its line."""
    line = "“{:.40}”".format(text[text.rfind("\n", 0, place) + 1 :].partition("\n")[0].strip())
    return FileError(
        DESCRIPTION_INVALID, format="text of USD", line=text.count("\n", 0, place) + 1, error=line
    )


def _description(text: str, data: bytes) -> Description:
    parser = _Parser(text)
    metadata = parser.balanced() if parser.peek() == "(" else ""
    roots = []
    while parser.index < len(parser.tokens):
        if parser.peek() not in _SPECIFIERS:
            raise _invalid(text, parser.tokens[parser.index][1])
        roots.append(parser.prim(0))
    length = _scale(metadata, "metersPerUnit", 0.01)
    mass = _scale(metadata, "kilogramsPerUnit", 1.0)
    stage = _Stage(_resolve(roots), length, mass)
    for root in roots:
        stage.visit(root, np.eye(4), root.name)
    links = {link.name: link for link in stage.links}
    findings: list[Finding] = []
    joints = [attempt(findings, prim, _joint, path, links, length) for path, prim in stage.joints]
    return Description(
        roots[0].name if roots else "",
        "usd",
        tuple(stage.links),
        data,
        {"length": length, "mass": mass},
        joints=tuple(joint for joint in joints if joint is not None),
        findings=tuple(findings),
    )


def _resolve(roots: list[Prim]) -> dict[str, Prim]:
    """Give prims that refer to another prim of the layer its attributes, unless they state their
    own; return all prims by their paths.
    """
    by_path: dict[str, Prim] = {}
    waiting = [("/" + prim.name, prim) for prim in roots]
    while waiting:
        path, prim = waiting.pop()
        by_path[path] = prim
        waiting += [(path + "/" + child.name, child) for child in prim.children]
    for prim in by_path.values():
        match = _REFERENCE.search(prim.metadata)
        target = by_path.get(match[1]) if match else None
        if target is not None:
            prim.kind = prim.kind or target.kind
            prim.values = target.values | prim.values
    return by_path


def _scale(metadata: str, name: str, default: float) -> float:
    match = re.search(r"\b{}\s*=\s*([^\s()]+)".format(name), metadata)
    scale = parse_number(match[1]) if match else default
    if not LEAST <= scale <= MOST:
        raise ValueError(match[0] if match else name)
    return scale


class _Stage:
    """The prims of a layer by their paths, its units in m and kg, and its bodies and joints so
    far, the latter with their paths.
    """

    def __init__(self, prims: Mapping[str, Prim], length: float, mass: float) -> None:
        self.prims = prims
        self.length = length
        self.mass = mass
        self.inertia = length**2 * mass  # the unit, kg·m²
        self.links: list[StatedLink] = []
        self.joints: list[tuple[str, Prim]] = []

    def visit(self, prim: Prim, above: NDArray, path: str, is_within: bool = False) -> None:
        """Add the bodies and joints at and below a prim. above: the matrix of its parent.
        is_within: True in a body, whose parts are no bodies of their own.
        """
        matrix = _placed(prim, above)
        # Joints that close a loop are marked.
        if prim.kind in JOINTS and prim.values.get("physics:excludeFromArticulation") not in TRUE:
            self.joints.append((path, prim))
        is_body = "PhysicsRigidBodyAPI" in prim.metadata
        is_fixed = "MassAPI" in prim.metadata and "PhysicsCollisionAPI" not in prim.metadata
        if is_body or is_fixed and not is_within:
            self.links.append(self._link(prim, matrix, path))
        for child in prim.children:
            self.visit(child, matrix, path + "/" + child.name, is_within or is_body)

    def _link(self, prim: Prim, matrix: NDArray, path: str) -> StatedLink:
        """Return a body in the axes of its prim, in meters; the prim's scale is applied to its
        shapes and its center. matrix: (4, 4), from the prim to the world.
        """
        findings: list[Finding] = []
        frame = Pose(matrix[:3, 3], _turn(matrix))
        to_link = frame.inverse().matrix
        local = to_link @ matrix
        rules = attempt(findings, prim, self._rules, local)
        inertials = rules and attempt(findings, prim, self._inertials, rules)
        inertial, overridden = inertials or (None, None)
        density = rules and attempt(findings, prim, Prim.number, "physics:density", 0.0)
        # A body that states its inertial and center takes nothing from colliders; nor does one with
        # a wrong number. `newton:inertia`, which has no quaternion, replaces the other moments.
        if rules is None or inertial is not None and rules.center is not None or findings:
            rules = None
        elif inertial is not None and inertial.quaternion is None:
            moments, axes = np.linalg.eigh(inertial.tensor)
            rules = rules._replace(moments=moments, axes=axes)
        shapes = []
        for part, place in _parts(prim, matrix):
            shape = attempt(findings, part, _shape, to_link @ place, self.length)
            if shape is None:
                continue
            if rules is not None and shape.role == "collision":
                weight = attempt(findings, part, self._weight, density or 0.0)
                of_shape = attempt(findings, part, self._rules, to_link @ place)
                if of_shape and of_shape.axes is None and of_shape.moments is not None:
                    of_shape = of_shape._replace(axes=_turn(to_link @ place))
                # The weight has the shape's mass already.
                shape = replace(
                    shape, weight=weight, rules=of_shape and of_shape._replace(mass=0.0)
                )
            shapes.append(shape)
        return StatedLink(
            path,
            inertial,
            tuple(shapes),
            (len(prim.text[: prim.start].encode()), len(prim.text[: prim.end].encode())),
            moves="PhysicsRigidBodyAPI" in prim.metadata,
            rules=rules,
            findings=tuple(findings),
            local=local,
            place=Place(prim.line),
            inertial_place=Place(prim.line),
            overridden=overridden,
            pose=Pose(frame.position * self.length, frame.rotation),
        )

    def _inertials(
        self, prim: Prim, rules: Rules
    ) -> tuple[StatedInertial | None, StatedInertial | None]:
        """Return the stated inertial, and the one that `newton:inertia` overrides; None for those
        that come from the colliders. rules: those of the prim.
        """
        mass = prim.number("physics:mass", 0.0) * self.mass
        center = np.zeros(3) if rules.center is None else rules.center
        of_moments = None
        if mass and rules.moments is not None:
            quaternion = (1.0, 0.0, 0.0, 0.0)
            of_moments = StatedInertial(mass, center, np.diag(rules.moments), quaternion=quaternion)
            if rules.axes is not None:
                stated = tuple(prim.vector("physics:principalAxes", quaternion).tolist())
                of_moments = replace(of_moments, rotation=rules.axes, quaternion=stated)
        entries = (
            prim.values.get("newton:inertia", "None") if "NewtonMassAPI" in prim.metadata else ""
        )
        if not mass or not _FIELD.search(entries) or entries == "None":
            return of_moments, None
        xx, yy, zz, xy, xz, yz = prim.vector("newton:inertia", (0.0,) * 6)
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        return StatedInertial(mass, center, tensor * self.inertia), of_moments

    def _rules(self, prim: Prim, local: NDArray) -> Rules:
        """Return the values of PhysicsMassAPI that replace those of colliders, as
        `UsdPhysics.RigidBodyAPI.ComputeMassProperties` uses them: a center that is finite, other
        values that are not zero. local: (4, 4), from the prim to the link.
        """
        center = prim.vector("physics:centerOfMass", (-inf, -inf, -inf))
        moments = prim.vector("physics:diagonalInertia", (0.0, 0.0, 0.0)) * self.inertia
        axes = prim.vector("physics:principalAxes", (0.0, 0.0, 0.0, 0.0))
        place = (local[:3, :3] @ center + local[:3, 3]) * self.length
        return Rules(
            mass=max(prim.number("physics:mass", 0.0), 0.0) * self.mass,
            center=None if np.isinf(center).all() else place,
            moments=moments if moments.any() else None,
            axes=_turn(local) @ rotation_matrix(axes) if axes.any() else None,
            radius=BALL_RADIUS,
        )

    def _weight(self, prim: Prim, density: float) -> Weight:
        """Return the mass of a collider. density: that of its body, 0 if it has none.

        Mass comes before density, the collider's before the body's, and both before its material's.
        """
        bound = prim.values.get("material:binding:physics") or prim.values.get(
            "material:binding", ""
        )
        material = self.prims.get(bound.strip("[]<> "))
        densities = [prim.number("physics:density", 0.0), density]
        if material is not None:
            densities.append(material.number("physics:density", 0.0))
        unit = self.mass / self.length**3
        mass = prim.number("physics:mass", 0.0) * self.mass
        first = next((value * unit for value in densities if value > 0.0), WATER)
        is_hull = prim.values.get("physics:approximation", "").strip("\"'") == "convexHull"
        return Weight(mass if mass > 0.0 else None, first, "convex" if is_hull else CLOSED)


def _joint(prim: Prim, path: str, links: Mapping[str, StatedLink], unit: float) -> StatedJoint:
    """Return a joint: both of its frames coincide when it is at zero. links: by their names. unit:
    m.

    ValueError if a number is wrong.
    """
    (parent, in_parent), (child, in_child) = (_end(prim, end, links, unit) for end in "01")
    # The world may be either body, and is the parent here.
    is_reversed = bool(parent) and not child
    if is_reversed:
        parent, in_parent, child, in_child = child, in_child, parent, in_parent
    pose = None
    outer = links[parent].pose if parent else None
    inner = links[child].pose if child else None
    if outer is not None and inner is not None:
        pose = in_parent @ in_child.inverse()
        placed = outer.inverse() @ inner
        apart = np.abs(pose.matrix - placed.matrix).max()
        # The prims' places have more digits than the frames, and count if both agree.
        if apart <= SINGLE_RTOL * max(1.0, np.abs(placed.position).max()):
            pose = None
    axis = prim.values.get("physics:axis", '"X"').strip("\"'")
    column = in_child.rotation[:, "XYZ".index(axis) if axis in JOINT_AXES else 0]
    sign = -1.0 if is_reversed else 1.0
    motion = Motion(prim.name, JOINTS[prim.kind], sign * column, in_child.position)
    return StatedJoint(path, parent, child, pose, (motion,), Place(prim.line))


def _end(prim: Prim, end: str, links: Mapping[str, StatedLink], unit: float) -> tuple[str, Pose]:
    """Return the name of the body "0" or "1" of a joint, "" for the world, and the joint's frame in
    it, m.
    """
    name = prim.values.get("physics:body" + end, "").strip("[]<> ").strip("/")
    while name and name not in links:  # A prim in a body is a part of it.
        name = name.rpartition("/")[0]
    place = prim.vector("physics:localPos" + end, (0.0, 0.0, 0.0))
    turn = prim.vector("physics:localRot" + end, (1.0, 0.0, 0.0, 0.0))
    local = links[name].local if name else None
    if local is not None:
        place = local[:3, :3] @ place
    return name, Pose(place * unit, rotation_matrix(turn if turn.any() else [1, 0, 0, 0]))


def _placed(prim: Prim, above: NDArray) -> Array:
    """Return the (4, 4) matrix from a prim to the world, for column vectors. above: the matrix of
    its parent.
    """
    matrix = above
    for inverse, name in re.findall(r'"(!\w+!)?([\w:]*)"', prim.values.get("xformOpOrder", "")):
        if inverse == "!resetXformStack!":
            matrix = np.eye(4)
        values = prim.numbers(name)
        if values is None:
            continue
        step = _operation(name.split(":")[1], values)
        if step is None or not (np.abs(values) <= MOST).all():
            raise ValueError(prim.values[name])
        matrix = matrix @ (np.linalg.inv(step) if inverse else step)
    return np.asarray(matrix, np.float64)


def _operation(kind: str, values: Array) -> Array | None:
    """Return the (4, 4) matrix of an operation such as "rotateXYZ"; None if it is unknown, or the
    count of its values is wrong.
    """
    step = np.eye(4)
    if kind == "translate" and len(values) == 3:
        step[:3, 3] = values
    elif kind == "scale" and len(values) == 3:
        step[:3, :3] = np.diag(values)
    elif kind == "orient" and len(values) == 4 and np.abs(values).max() >= LEAST:
        step[:3, :3] = rotation_matrix(values)
    elif kind == "transform" and len(values) == 16:
        step = values.reshape(4, 4).T
    elif kind.startswith("rotate") and len(values) == len(kind) - 6 and {*kind[6:]} <= {*"XYZ"}:
        for axis, angle in zip(kind[6:], np.radians(values)):  # rotateXYZ turns about x first
            step[:3, :3] = rotation_about(np.eye(3)["XYZ".index(axis)], angle) @ step[:3, :3]
    else:
        return None
    return step


def _turn(matrix: NDArray) -> Array:
    """Return the (3, 3) rotation of a (4, 4) matrix, without its scale and its mirroring."""
    turn = polar_rotation(matrix[None])[0][0]
    return -turn if np.linalg.det(turn) < 0.0 else turn


def _parts(prim: Prim, matrix: NDArray) -> Iterator[tuple[Prim, NDArray]]:
    """Yield a body and the prims below it, up to the next body, with their matrices to the
    world.
    """
    yield prim, matrix
    for child in prim.children:
        if "PhysicsRigidBodyAPI" not in child.metadata:
            yield from _parts(child, _placed(child, matrix))


def _shape(prim: Prim, matrix: NDArray, unit: float) -> StatedShape | None:
    """Return the shape of a prim, None if it has none. matrix: (4, 4), from the prim to the link,
    in the file's unit, m.
    """
    role = "collision" if "PhysicsCollisionAPI" in prim.metadata else "visual"
    if prim.kind == "Mesh":
        return _mesh(prim, matrix, unit, role)
    kinds = {"Cube": "box", "Sphere": "sphere", "Capsule": "capsule", "Cylinder": "cylinder"}
    if prim.kind in OTHER_SOLIDS:
        raise ValueError(prim.kind)
    if prim.kind not in kinds:
        return None
    scales = np.linalg.norm(matrix[:3, :3], axis=0) * unit
    pose = Pose(matrix[:3, 3] * unit, _turn(matrix))
    if prim.kind == "Cube":
        size = prim.number("size", 2.0) * scales
        return StatedShape(Shape("box", tuple(size.tolist()), pose), role)
    if prim.kind == "Sphere":
        return StatedShape(
            Shape("ellipsoid", tuple((prim.number("radius", 1.0) * scales).tolist()), pose), role
        )
    axis = prim.values.get("axis", '"Z"').strip("\"'")
    # The columns of the prim's axes that are the x, y and z axes of our shape.
    order = {"X": [1, 2, 0], "Y": [2, 0, 1], "Z": [0, 1, 2]}[axis if axis in "XYZ" else "Z"]
    across, _, along = scales[order]
    capsule = prim.kind == "Capsule"
    radius = prim.number("radius", 0.5 if capsule else 1.0)
    size = radius * across, prim.number("height", 1.0 if capsule else 2.0) * along
    return StatedShape(
        Shape(kinds[prim.kind], size, Pose(pose.position, pose.rotation[:, order])), role
    )


def _mesh(prim: Prim, matrix: NDArray, unit: float, role: str) -> StatedShape | None:
    names = "points", "faceVertexCounts", "faceVertexIndices"
    points, counts, corners = map(prim.numbers, names)
    if points is None or counts is None or corners is None:
        return None  # another layer may have them
    surface = checked_surface([prim.values[name] for name in names], points, counts, corners)
    placed = (surface.points @ matrix[:3, :3].T + matrix[:3, 3]) * unit
    if not (np.abs(placed) <= MOST).all():
        raise ValueError(prim.values["points"][:80])
    triangles = surface.triangles
    # A mirrored mesh turns its faces as one of left-handed faces does; both together do not.
    is_left_handed = prim.values.get("orientation", "").strip("\"'") == "leftHanded"
    if is_left_handed != (np.linalg.det(matrix[:3, :3]) < 0.0):
        triangles = triangles[:, ::-1]
    return StatedShape(Shape("mesh", surface=Surface.from_triangles(placed, triangles)), role)
