# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of an FBX file: their places, meshes and levels of detail, as the file states them.

The places follow the FBX SDK's example Transformations: pivots, offsets, pre- and post-rotation,
and three ways to inherit the scale of a parent.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import cos, radians, sin
from typing import Any, NamedTuple

import numpy as np

from ...core.files import FbxNode
from ...core.numerics import Array

_ORDERS = ("XYZ", "XZY", "YZX", "YXZ", "ZXY", "ZYX")  # the first letter's rotation acts first
_SAME = 1e-9  # larger than the rounding of products in float64
_RSRS = 1  # InheritType: the product of the matrices
RRS = 2  # InheritType: without the parent's own scale
_TICKS = 46186158000.0  # of a file's clock in a second
_SAME_TIME = 1e-6  # seconds
_LINEAR = 4  # a flag of keys


class Place(NamedTuple):
    """A model's place.

    matrix: (4, 4), in the file's axes and unit. rotation: (3, 3), without scale. doubt: the reason
    why programs read the file differently, or None.
    """

    matrix: Array
    rotation: Array
    doubt: str | None


@dataclass(eq=False)
class FbxModel:
    """A model, with its properties, those of its kind included.

    moves: it is animated, and its place at the time to measure is not known. geometry: its mesh,
    None without one. clusters: of the mesh, each with the bone that moves its points.
    """

    name: str
    properties: dict[str, Any]
    parent: FbxModel | None = None
    children: list[FbxModel] = field(default_factory=list)
    geometry: FbxNode | None = None
    moves: bool = False
    clusters: list[tuple[FbxNode, FbxModel]] = field(default_factory=list)
    is_lod_group: bool = False

    def vector(self, name: str, rest: float = 0.0) -> Array:
        """Return three numbers of a property."""
        return np.array(self.properties.get(name, (rest,) * 3)[:3], np.float64)

    def whole(self, name: str) -> int:
        """Return a whole number of a property."""
        return int(self.properties.get(name, (0,))[0])

    @property
    def geometric(self) -> Array:
        """The (4, 4) matrix of the mesh in the model, which its children do not inherit."""
        linear = _turn(self.vector("GeometricRotation")) * self.vector("GeometricScaling", 1.0)
        return _matrix(linear, self.vector("GeometricTranslation"))

    @property
    def to_pivot(self) -> Array:
        """The (4, 4) translation to the point of the mesh that stays when the model turns."""
        center = self.vector("ScalingPivot")
        apart = self.vector("RotationPivot") - center - self.vector("ScalingOffset")
        scale = self.vector("Lcl Scaling", 1.0)
        safe = np.where(scale == 0.0, 1.0, scale)
        return _matrix(np.eye(3), center + apart / safe)

    @property
    def is_animated(self) -> bool:
        """Whether it moves, or a model above it."""
        return self.moves or self.parent is not None and self.parent.is_animated

    @property
    def is_hidden(self) -> bool:
        """Whether it is invisible, or a model above it whose visibility it inherits."""
        return not self.properties.get("Visibility", (1,))[0] or (
            self.parent is not None
            and self.parent.is_hidden
            and bool(self.properties.get("Visibility Inheritance", (1,))[0])
        )

    def skinned(self, points: Array) -> Array:
        """Return the places, in the file's axes and unit, of (n, 3) points of its mesh that bones
        move. ValueError if their weights are unknown.
        """
        whole = np.column_stack([points, np.ones(len(points))]) @ self.geometric.T
        moved = np.zeros_like(whole)
        for cluster, bone in self.clusters:
            rows, shares, to_bone = (
                node.numbers()
                for node in map(cluster.child, ("Indexes", "Weights", "Transform"))
                if node is not None
            )
            matrix = bone.place.matrix @ to_bone.reshape(4, 4).T
            index = rows.astype(int)
            np.add.at(moved, index, shares[:, None] * (whole[index] @ matrix.T))
        free = moved[:, 3] == 0.0
        moved[free] = whole[free] @ self.place.matrix.T
        return moved[:, :3] / moved[:, 3:]

    def coarse_levels(self) -> list[FbxModel]:
        """Return all models of the levels of detail in it that follow the first, finest one."""
        levels = [child.below() for child in self.children if self.is_lod_group]
        shown = [level for level in levels if any(model.geometry for model in level)]
        return [model for level in shown[1:] for model in level]

    def below(self) -> list[FbxModel]:
        """Return the model and all models below it."""
        found: list[FbxModel] = [self]
        for model in found:
            found += model.children
        return found

    @cached_property
    def place(self) -> Place:
        """Its place in the world."""
        above = Place(np.eye(4), np.eye(3), None) if self.parent is None else self.parent.place
        order = self.whole("RotationOrder")
        pre, post = self.vector("PreRotation"), self.vector("PostRotation")
        turn = _turn(self.vector("Lcl Rotation"), _ORDERS[order % 6])
        turn = _turn(pre) @ turn @ _turn(post).T
        scale = self.vector("Lcl Scaling", 1.0)
        pivot, center = self.vector("RotationPivot"), self.vector("ScalingPivot")
        own = (
            _matrix(turn, self.vector("Lcl Translation") + self.vector("RotationOffset") + pivot)
            @ _matrix(np.diag(scale), self.vector("ScalingOffset") + center - pivot)
            @ _matrix(np.eye(3), -center)
        )
        matrix = above.matrix @ own
        doubt = above.doubt
        if self.whole("InheritType") != _RSRS:
            inherited = above.rotation.T @ above.matrix[:3, :3]
            is_apart = self.whole("InheritType") == RRS
            if is_apart and self.parent is not None:
                inherited = inherited / self.parent.vector("Lcl Scaling", 1.0)
            matrix[:3, :3] = above.rotation @ turn @ inherited * scale
            rest = inherited - np.diag(np.ones(3) if is_apart else np.diag(inherited))
            if np.abs(rest).max() > _SAME * np.abs(inherited).max():
                doubt = "a node inherits some scales of the nodes above it"
        if not self.whole("RotationActive") and (order or np.any([pre, post])):
            doubt = "a node has pre-rotations that are switched off"
        if not 0 <= order < len(_ORDERS):
            doubt = "a node has rotations of an unknown order"
        return Place(matrix, above.rotation @ turn, doubt)


def _matrix(linear: Array, move: Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = move
    return matrix


def _turn(degrees: Array, order: str = "XYZ") -> Array:
    """Return the (3, 3) rotation by angles about x, y and z, the first axis of the order first."""
    matrix = np.eye(3)
    for axis in map("XYZ".index, order):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        step = np.eye(3)
        angle = radians(degrees[axis])
        step[j, j] = step[k, k] = cos(angle)
        step[k, j] = sin(angle)
        step[j, k] = -sin(angle)
        matrix = step @ matrix
    return matrix


def fbx_to_scene(root: FbxNode) -> Array:
    """Return the (4, 4) matrix from a file's axes and unit to Blender's, meters.

    KeyError or ValueError if the axes are not three right-handed ones.
    """
    settings = _properties(root.child("GlobalSettings"))
    axes = np.zeros((3, 3))
    # Blender's axes: x to the right, z up, and -y to the front.
    for row, (name, sign) in enumerate((("Coord", 1.0), ("Front", -1.0), ("Up", 1.0))):
        axes[row, settings[name + "Axis"][0]] = sign * settings[name + "AxisSign"][0]
    if np.linalg.det(axes) <= 0.0:
        raise ValueError("axes")
    return _matrix(axes * settings.get("UnitScaleFactor", (1.0,))[0] / 100.0, np.zeros(3))


def fbx_models(root: FbxNode, seconds: float) -> list[FbxModel]:
    """Return the models of a file at a time, connected, those with meshes in the order of these.

    ValueError if its format is older than 7.0.
    """
    objects = root.child("Objects")
    connections = root.child("Connections")
    if objects is None or connections is None:
        raise ValueError("version")
    kinds = [
        kind.child("PropertyTemplate")
        for kind in getattr(root.child("Definitions"), "children", ())
        if kind.name == "ObjectType" and kind.values[:1] == ["Model"]
    ]
    rest = _properties(kinds[0]) if kinds else {}  # of models that state none
    nodes = {node.values[0]: node for node in objects.children}
    if any(not isinstance(number, int) for number in nodes):
        raise ValueError("version")
    models = {
        number: FbxModel(
            node.values[1], rest | _properties(node), is_lod_group="LodGroup" in node.values[2:]
        )
        for number, node in nodes.items()
        if node.name == "Model"
    }
    below_of: dict[int, list[int]] = {}  # the clusters of a skin, the skins of a mesh
    bones: dict[int, FbxModel] = {}
    channels: dict[int, dict[str, FbxNode]] = {}
    animated = []
    ordered = []
    for link in connections.children:
        child, parent = (nodes.get(number) for number in link.values[1:3])
        below, above = (models.get(number) for number in link.values[1:3])
        if below is not None and above is not None:
            below.parent = above
            above.children.append(below)
        elif above is not None and child is not None and child.name == "Geometry":
            above.geometry = child
            ordered.append((link.values[1], above))
        elif above is not None and child is not None and child.name == "AnimationCurveNode":
            animated.append((above, link.values[3], link.values[1]))
        elif child is not None and parent is not None and child.name == "AnimationCurve":
            channels.setdefault(link.values[2], {})[link.values[3]] = child
        elif above is not None and child is not None and "LodGroup" in child.values[2:]:
            above.is_lod_group = True
        elif child is not None and parent is not None and child.name == "Deformer":
            below_of.setdefault(link.values[2], []).append(link.values[1])
        elif below is not None and parent is not None and "Cluster" in parent.values[2:]:
            bones[link.values[2]] = below
    is_single = sum(node.name == "AnimationLayer" for node in nodes.values()) == 1
    for model, name, number in animated:
        values = [
            _value_at(channels.get(number, {}).get(channel), rest[0], seconds)
            for channel, rest in _properties(nodes[number]).items()
            if channel.startswith("d|")
        ]
        if is_single and None not in values:
            model.properties[name] = values
        else:
            model.moves = True
    for number, model in ordered:
        model.clusters = [
            (nodes[cluster], bones[cluster])
            for skin in below_of.get(number, ())
            for cluster in below_of.get(skin, ())
            if cluster in bones
        ]
    place = {number: index for index, number in enumerate(nodes)}
    ordered.sort(key=lambda pair: place[pair[0]])
    return [*dict.fromkeys([model for _, model in ordered] + [*models.values()])]


def _value_at(curve: FbxNode | None, rest: float, seconds: float) -> float | None:
    """Return the value of an animated channel at a time; None between keys that are not linear."""
    times, values, flags = (
        np.empty(0) if node is None else node.numbers()
        for node in map(
            FbxNode("").child if curve is None else curve.child,
            ("KeyTime", "KeyValueFloat", "KeyAttrFlags"),
        )
    )
    if not len(times):
        return rest
    times = times / _TICKS
    near = np.abs(times - np.clip(seconds, times[0], times[-1])) <= _SAME_TIME
    if near.any():
        return float(values[near.argmax()])
    is_linear = (flags.astype(int) & _LINEAR).all()
    return float(np.interp(seconds, times, values)) if is_linear else None


def _properties(node: FbxNode | None) -> dict[str, Any]:
    table = None if node is None else node.child("Properties70")
    return {} if table is None else {line.values[0]: line.values[4:] for line in table.children}
