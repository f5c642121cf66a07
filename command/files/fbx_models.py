# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of an FBX file: their places, meshes and levels of detail, as the file states them.

The places follow the FBX SDK's example Transformations: pivots, offsets, pre- and post-rotation,
and three ways to inherit the scale of a parent.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import nan
from typing import Any, NamedTuple

import numpy as np

from ...core.files import FbxNode
from ...core.numerics import Array
from ...core.rig import rotations
from .fbx_animation import ORDERS, FbxAnimation

_SAME = 1e-9  # larger than the rounding of products in float64
_RSRS = 1  # InheritType: the product of the matrices
_RRS = 2  # InheritType: without the parent's own scale


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

    parent, children: the models above and below it. geometry: its mesh, None without one. is_rare:
    its animation may be read differently. clusters: of the mesh, each with the bone that moves its
    points. shapes: of the mesh, their names and weights, NaN if programs may read them differently.
    is_lod_group: its children are levels of detail of one thing.
    """

    name: str
    properties: dict[str, Any]
    parent: FbxModel | None = None
    children: list[FbxModel] = field(default_factory=list)
    geometry: FbxNode | None = None
    is_rare: bool = False
    clusters: list[tuple[FbxNode, FbxModel]] = field(default_factory=list)
    shapes: list[tuple[str, float]] = field(default_factory=list)
    is_lod_group: bool = False

    def vector(self, name: str, rest: float = 0.0) -> Array:
        """Return three numbers of a property, three times `rest` if it is not stated."""
        return np.array(self.properties.get(name, (rest,) * 3)[:3], np.float64)

    def whole(self, name: str) -> int:
        """Return a whole number of a property, 0 if it is not stated."""
        return int(self.properties.get(name, (0,))[0])

    @property
    def geometric(self) -> Array:
        """The (4, 4) matrix of the mesh in the model, which its children do not inherit."""
        linear = _turn(self.vector("GeometricRotation")) * self.vector("GeometricScaling", 1.0)
        return _matrix(linear, self.vector("GeometricTranslation"))

    @property
    def to_pivot(self) -> Array:
        """The (4, 4) translation to the point of the mesh that stays when the model turns: the one
        that offset and scaling about their own pivot bring to the pivot of rotations.
        """
        center = self.vector("ScalingPivot")
        apart = self.vector("RotationPivot") - center - self.vector("ScalingOffset")
        scale = self.vector("Lcl Scaling", 1.0)
        divisor = np.where(scale == 0.0, 1.0, scale)  # No point is there if the scale is 0.
        return _matrix(np.eye(3), center + apart / divisor)

    @property
    def moves_rarely(self) -> bool:
        """Whether its animation, or that of a model above it, may be read differently."""
        return self.is_rare or self.parent is not None and self.parent.moves_rarely

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
        homogeneous = np.column_stack([points, np.ones(len(points))]) @ self.geometric.T
        moved_points = np.zeros_like(homogeneous)
        for cluster, bone in self.clusters:
            indices, shares, to_bone = (
                node.numbers() for node in map(cluster.child, ("Indexes", "Weights", "Transform"))
            )
            matrix = bone.place.matrix @ to_bone.reshape(4, 4).T
            index = indices.astype(int)
            np.add.at(moved_points, index, shares[:, None] * (homogeneous[index] @ matrix.T))
        free = moved_points[:, 3] == 0.0  # Points that no bone moves follow the model.
        moved_points[free] = homogeneous[free] @ self.place.matrix.T
        return moved_points[:, :3] / moved_points[:, 3:]

    def coarse_levels(self) -> list[FbxModel]:
        """Return all models of the levels of detail in it that follow the first, finest one."""
        levels = [child.below() for child in self.children if self.is_lod_group]
        levels_with_meshes = [level for level in levels if any(model.geometry for model in level)]
        return [model for level in levels_with_meshes[1:] for model in level]

    def below(self) -> list[FbxModel]:
        """Return the model and all models below it."""
        models: list[FbxModel] = [self]
        for model in models:
            models += model.children
        return models

    @cached_property
    def place(self) -> Place:
        """Its place in the world.

        Each InheritType but RSrs turns by all rotations before it scales. Programs agree on the
        inherited scale only if it is one for each axis (RrSs), or none (Rrs, which leaves out the
        parent's own scale).
        """
        above = Place(np.eye(4), np.eye(3), None) if self.parent is None else self.parent.place
        order = self.whole("RotationOrder")
        pre, post = self.vector("PreRotation"), self.vector("PostRotation")
        turn = _turn(self.vector("Lcl Rotation"), ORDERS[order % 6])
        turn = _turn(pre) @ turn @ _turn(post).T
        scale = self.vector("Lcl Scaling", 1.0)
        pivot, center = self.vector("RotationPivot"), self.vector("ScalingPivot")
        local = (
            _matrix(turn, self.vector("Lcl Translation") + self.vector("RotationOffset") + pivot)
            @ _matrix(np.diag(scale), self.vector("ScalingOffset") + center - pivot)
            @ _matrix(np.eye(3), -center)
        )
        matrix = above.matrix @ local
        doubt = above.doubt
        if self.whole("InheritType") != _RSRS:
            inherited = above.rotation.T @ above.matrix[:3, :3]
            is_apart = self.whole("InheritType") == _RRS
            if is_apart and self.parent is not None:
                inherited = inherited / self.parent.vector("Lcl Scaling", 1.0)
            matrix[:3, :3] = above.rotation @ turn @ inherited * scale
            agreed = np.diag(np.ones(3) if is_apart else np.diag(inherited))
            if np.abs(inherited - agreed).max() > _SAME * np.abs(inherited).max():
                doubt = "a node inherits some scales of the nodes above it"
        if not self.whole("RotationActive") and (order or np.any([pre, post])):
            doubt = "a node has pre-rotations that are switched off"
        if not 0 <= order < len(ORDERS):
            doubt = "a node has rotations of an unknown order"
        return Place(matrix, above.rotation @ turn, doubt)


def _matrix(linear: Array, move: Array) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = move
    return matrix


def _turn(degrees: Array, order: str = "XYZ") -> Array:
    """Return the (3, 3) rotation by (3,) angles about x, y and z. order: as in `ORDERS`."""
    return rotations(np.radians(degrees)[None], order)[0]


def fbx_to_scene(root: FbxNode) -> Array:
    """Return the (4, 4) matrix from a file's axes and unit to Blender's, meters.

    KeyError or ValueError if the axes are not three right-handed ones.
    """
    settings = root.child("GlobalSettings").properties()
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
    if not objects.name or not connections.name:
        raise ValueError("version")
    kinds = [
        kind.child("PropertyTemplate").properties()
        for kind in root.child("Definitions").children
        if kind.name == "ObjectType" and kind.values[:1] == ["Model"]
    ]
    rest = kinds[0] if kinds else {}  # Models may state none.
    nodes = {node.values[0]: node for node in objects.children}
    if any(not isinstance(number, int) for number in nodes):
        raise ValueError("version")
    models = {
        number: FbxModel(
            node.values[1], rest | node.properties(), is_lod_group="LodGroup" in node.values[2:]
        )
        for number, node in nodes.items()
        if node.name == "Model"
    }
    links = [link.values[1:] for link in connections.children]
    animation = FbxAnimation(root, nodes, links, seconds)
    for number, model in models.items():
        model.is_rare = not animation.animate(number, model.properties)
    below_of: dict[int, list[int]] = {}  # the deformers of a mesh, the parts and shapes of these
    bones: dict[int, FbxModel] = {}
    ordered = []  # the numbers of meshes, and their models
    for child_number, parent_number, *_ in links:
        child, parent = nodes.get(child_number), nodes.get(parent_number)
        below, above = models.get(child_number), models.get(parent_number)
        if below is not None and above is not None:
            below.parent = above
            above.children.append(below)
        elif above is not None and child is not None and child.name == "Geometry":
            above.geometry = child
            ordered.append((child_number, above))
        elif above is not None and child is not None and "LodGroup" in child.values[2:]:
            above.is_lod_group = True
        elif child is not None and parent is not None and child.name in ("Deformer", "Geometry"):
            below_of.setdefault(parent_number, []).append(child_number)
        elif below is not None and parent is not None and "Cluster" in parent.values[2:]:
            bones[parent_number] = below
    for number, model in ordered:
        parts = [
            part for deformer in below_of.get(number, ()) for part in below_of.get(deformer, ())
        ]
        model.clusters = [(nodes[part], bones[part]) for part in parts if part in bones]
        for part in parts:
            shapes = [nodes[shape] for shape in below_of.get(part, ())]
            if shapes:
                weight = _weight(nodes[part], len(shapes), animation, part)
                model.shapes.append((shapes[-1].values[1], weight))
    place = {number: index for index, number in enumerate(nodes)}
    ordered.sort(key=lambda pair: place[pair[0]])
    return [*dict.fromkeys([model for _, model in ordered] + [*models.values()])]


def _weight(channel: FbxNode, shapes: int, animation: FbxAnimation, number: int) -> float:
    """Return the weight of a channel's last shape; NaN if programs may read it differently.

    channel: the node with the number, which is animated. shapes: how many it has, one after the
    other up to the full weight.
    """
    percent = channel.child("DeformPercent").first(0.0)
    properties = {"DeformPercent": [percent]} | channel.properties()
    if not animation.animate(number, properties):
        return nan
    weight = properties["DeformPercent"][0] / 100.0
    # The full weight of each shape; in files of Blender, weights of vertices, of another count.
    limits = channel.child("FullWeights").numbers()
    is_partial = shapes > 1 and weight not in (0.0, 1.0)
    return nan if is_partial or len(limits) == shapes and limits[-1] != 100.0 else weight
