# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group of geometry nodes that computes the center of mass.

It follows modifiers and animation, renders, and works without the add-on.

Over the triangles (a, b, c), with corners relative to the middle of the bounding box, the volume is
Σ a·(b×c) / 6 and the center of mass Σ a·(b×c) (a + b + c) / 4 over Σ a·(b×c). Both sums change
their sign together in a mirrored object or one turned inside out: the volume is the magnitude.
Nodes compute in single precision: five to six digits.
"""

from typing import NamedTuple

import bpy
from bpy.types import Context, GeometryNodeTree, Node, NodeSocket, Object

from ..scale import meters_per_unit
from ..settings.density import object_density

GROUP_NAME = "Center of Mass"
MARKER_NAME = "Center of Mass Marker"
KEY = "body_moments_nodes"  # ID property of our groups: the version of their nodes
VERSION = 2
COLUMN = 180  # distance of two nodes
MARKER_SHARE = 0.04  # radius of the marker relative to the object's largest side


class _Builder(NamedTuple):
    """A builder of nodes and links, which places nodes by column and row."""

    tree: GeometryNodeTree

    def node(self, kind: str, column: float, row: float = 0.0, **settings: object) -> Node:
        node = self.tree.nodes.new(kind)
        node.location = (column * COLUMN, -row * COLUMN)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def link(self, source: NodeSocket, target: NodeSocket) -> None:
        self.tree.links.new(source, target)

    def vector(
        self,
        operation: str,
        column: float,
        row: float,
        *inputs: NodeSocket,
        scale: NodeSocket | None = None,
    ) -> Node:
        node = self.node("ShaderNodeVectorMath", column, row, operation=operation)
        for source, target in zip(inputs, node.inputs):
            self.link(source, target)
        if scale is not None:
            self.link(scale, node.inputs["Scale"])
        return node

    def sum(
        self, kind: str, column: float, row: float, faces: NodeSocket, value: NodeSocket
    ) -> NodeSocket:
        node = self.node(
            "GeometryNodeAttributeStatistic", column, row, data_type=kind, domain="FACE"
        )
        self.link(faces, node.inputs["Geometry"])
        self.link(value, node.inputs["Attribute"])
        return node.outputs["Sum"]


def center_of_mass_group() -> GeometryNodeTree:
    """Return the file's node group, built if there is none of this version."""
    for group in bpy.data.node_groups:
        if group.get(KEY) == VERSION and group.library is None:
            return group
    group = bpy.data.node_groups.new(GROUP_NAME, "GeometryNodeTree")
    group[KEY] = VERSION
    interface = group.interface
    interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    density = interface.new_socket("Density", in_out="INPUT", socket_type="NodeSocketFloat")
    density.default_value, density.min_value = 1000.0, 0.0
    density.description = "Mass per cubic unit of the geometry"
    interface.new_socket("Center", in_out="OUTPUT", socket_type="NodeSocketVector")
    interface.new_socket("Volume", in_out="OUTPUT", socket_type="NodeSocketFloat")
    interface.new_socket("Mass", in_out="OUTPUT", socket_type="NodeSocketFloat")
    _build(_Builder(group))
    group.asset_mark()
    group.asset_data.description = (
        "Center of mass, volume and mass of a closed mesh, in the units of the geometry"
    )
    group.asset_data.tags.new("Body Moments")
    return group


def _build(make: _Builder) -> None:
    inputs = make.node("NodeGroupInput", 0)
    outputs = make.node("NodeGroupOutput", 12)
    realized = make.node("GeometryNodeRealizeInstances", 1)
    triangles = make.node("GeometryNodeTriangulate", 2)
    if hasattr(triangles, "quad_method"):  # Blender 4.5; later a socket
        triangles.quad_method = "FIXED"
    else:
        triangles.inputs["Quad Method"].default_value = "Fixed"
    box = make.node("GeometryNodeBoundBox", 3, 1)
    make.link(inputs.outputs["Geometry"], realized.inputs["Geometry"])
    make.link(realized.outputs["Geometry"], triangles.inputs["Mesh"])
    make.link(triangles.outputs["Mesh"], box.inputs["Geometry"])
    both = make.vector("ADD", 4, 1, box.outputs["Min"], box.outputs["Max"])
    middle = make.vector("SCALE", 5, 1, both.outputs["Vector"])
    middle.inputs["Scale"].default_value = 0.5
    position = make.node("GeometryNodeInputPosition", 3, 2)
    corners = [_corner(make, index, position, middle) for index in range(3)]
    cross = make.vector("CROSS_PRODUCT", 7, 2, *corners[1:])
    determinant = make.vector("DOT_PRODUCT", 8, 2, corners[0], cross.outputs["Vector"]).outputs[
        "Value"
    ]
    pair = make.vector("ADD", 7, 3, *corners[:2])
    three = make.vector("ADD", 8, 3, pair.outputs["Vector"], corners[2])
    weighed = make.vector("SCALE", 9, 3, three.outputs["Vector"], scale=determinant)
    faces = triangles.outputs["Mesh"]
    sixfold = make.sum("FLOAT", 10, 1, faces, determinant)
    moment = make.sum("FLOAT_VECTOR", 10, 2.5, faces, weighed.outputs["Vector"])
    inverse = make.node("ShaderNodeMath", 10.5, 1, operation="DIVIDE")
    inverse.inputs[0].default_value = 0.25
    make.link(sixfold, inverse.inputs[1])
    relative = make.vector("SCALE", 11, 2, moment, scale=inverse.outputs["Value"])
    center = make.vector("ADD", 11.5, 2, relative.outputs["Vector"], middle.outputs["Vector"])
    magnitude = make.node("ShaderNodeMath", 10.5, 0.5, operation="ABSOLUTE")
    make.link(sixfold, magnitude.inputs[0])
    volume = make.node("ShaderNodeMath", 11, 0.5, operation="DIVIDE")
    make.link(magnitude.outputs["Value"], volume.inputs[0])
    volume.inputs[1].default_value = 6.0
    mass = make.node("ShaderNodeMath", 11.5, 0.5, operation="MULTIPLY")
    make.link(volume.outputs["Value"], mass.inputs[0])
    make.link(inputs.outputs["Density"], mass.inputs[1])
    make.link(center.outputs["Vector"], outputs.inputs["Center"])
    make.link(volume.outputs["Value"], outputs.inputs["Volume"])
    make.link(mass.outputs["Value"], outputs.inputs["Mass"])


def _corner(make: _Builder, index: int, position: Node, middle: Node) -> NodeSocket:
    """Return the position of a corner of each triangle, relative to the middle of the box."""
    row = 2 + index
    corner = make.node("GeometryNodeCornersOfFace", 4, row)
    corner.inputs["Sort Index"].default_value = index
    vertex = make.node("GeometryNodeVertexOfCorner", 5, row)
    make.link(corner.outputs["Corner Index"], vertex.inputs["Corner Index"])
    there = make.node(
        "GeometryNodeFieldAtIndex", 5.5, row, domain="POINT", data_type="FLOAT_VECTOR"
    )
    make.link(position.outputs["Position"], there.inputs["Value"])
    make.link(vertex.outputs["Vertex Index"], there.inputs["Index"])
    return make.vector(
        "SUBTRACT", 6, row, there.outputs["Value"], middle.outputs["Vector"]
    ).outputs["Vector"]


def add_marker(context: Context, obj: Object, group: GeometryNodeTree) -> Object:
    """Add an object, at the world's origin, that shows a ball at the center of mass of `obj`;
    return it.
    """
    tree = bpy.data.node_groups.new(MARKER_NAME, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    tree.is_modifier = True
    make = _Builder(tree)
    outputs = make.node("NodeGroupOutput", 5)
    source = make.node("GeometryNodeObjectInfo", 1, transform_space="RELATIVE")
    source.inputs["Object"].default_value = obj
    nodes = make.node("GeometryNodeGroup", 2, node_tree=group)
    unit = meters_per_unit(context.scene)
    nodes.inputs["Density"].default_value = (
        object_density(obj.body_moments, context.scene) * unit**3
    )
    make.link(source.outputs["Geometry"], nodes.inputs["Geometry"])
    ball = make.node("GeometryNodeMeshIcoSphere", 2, 1)
    ball.inputs["Radius"].default_value = MARKER_SHARE * max(obj.dimensions)
    ball.inputs["Subdivisions"].default_value = 3
    placed = make.node("GeometryNodeTransform", 4)
    make.link(ball.outputs["Mesh"], placed.inputs["Geometry"])
    make.link(nodes.outputs["Center"], placed.inputs["Translation"])
    make.link(placed.outputs["Geometry"], outputs.inputs["Geometry"])
    made = bpy.data.objects.new(
        "{:s} {:s}".format(obj.name, GROUP_NAME), bpy.data.meshes.new(MARKER_NAME)
    )
    modifier = made.modifiers.new(MARKER_NAME, "NODES")
    modifier.node_group = tree
    made.show_in_front = True
    made.hide_render = True
    context.collection.objects.link(made)
    return made
