# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group of geometry nodes that computes the center of mass.

It follows modifiers and animation, renders, and works without the add-on.

Over the triangles (a, b, c), with corners relative to the middle of the bounding box, the volume is
Σ a·(b×c) / 6 and the center of mass Σ a·(b×c) (a + b + c) / 4 over Σ a·(b×c). Both sums change
their sign together in a mirrored object or one turned inside out: the volume is the magnitude.
Nodes compute in single precision: five to six digits.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

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
    """A builder of nodes and links, which places nodes by column and row.

    Inputs are sockets to link, or values, by the name or number of a node's input. `math`, `vector`
    and `sum` take the inputs of an operation, and return the socket of its result.
    """

    tree: GeometryNodeTree

    def node(
        self,
        kind: str,
        column: float,
        row: float = 0.0,
        inputs: Mapping[Any, object] | None = None,
        **settings: object,
    ) -> Node:
        node = self.tree.nodes.new(kind)
        node.location = (column * COLUMN, -row * COLUMN)
        for name, value in settings.items():
            setattr(node, name, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def math(self, operation: str, column: float, row: float, *inputs: object) -> NodeSocket:
        numbered = dict(enumerate(inputs))
        node = self.node("ShaderNodeMath", column, row, numbered, operation=operation)
        return node.outputs["Value"]

    def vector(
        self, operation: str, column: float, row: float, *inputs: NodeSocket, **named: object
    ) -> NodeSocket:
        numbered = dict(enumerate(inputs))
        node = self.node("ShaderNodeVectorMath", column, row, numbered | named, operation=operation)
        return node.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]

    def sum(
        self, kind: str, column: float, row: float, faces: NodeSocket, value: NodeSocket
    ) -> NodeSocket:
        node = self.node(
            "GeometryNodeAttributeStatistic",
            column,
            row,
            {"Geometry": faces, "Attribute": value},
            data_type=kind,
            domain="FACE",
        )
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
    """Make the nodes of the formulas at the top of this module, from left to right."""
    inputs = make.node("NodeGroupInput", 0).outputs
    realized = make.node("GeometryNodeRealizeInstances", 1, 0.0, {"Geometry": inputs["Geometry"]})
    triangles = make.node("GeometryNodeTriangulate", 2, 0.0, {"Mesh": realized.outputs["Geometry"]})
    if hasattr(triangles, "quad_method"):  # Blender 4.5; later a socket
        triangles.quad_method = "FIXED"
    else:
        triangles.inputs["Quad Method"].default_value = "Fixed"
    faces = triangles.outputs["Mesh"]
    box = make.node("GeometryNodeBoundBox", 3, 1, {"Geometry": faces}).outputs
    box_sum = make.vector("ADD", 4, 1, box["Min"], box["Max"])
    middle = make.vector("SCALE", 5, 1, box_sum, Scale=0.5)
    position = make.node("GeometryNodeInputPosition", 3, 2).outputs["Position"]
    a, b, c = (_corner(make, index, position, middle) for index in range(3))
    # a·(b×c) of each triangle, and a·(b×c) (a + b + c)
    cross = make.vector("CROSS_PRODUCT", 7, 2, b, c)
    determinant = make.vector("DOT_PRODUCT", 8, 2, a, cross)
    two_corners = make.vector("ADD", 7, 3, a, b)
    three_corners = make.vector("ADD", 8, 3, two_corners, c)
    weighed = make.vector("SCALE", 9, 3, three_corners, Scale=determinant)
    sixfold_volume = make.sum("FLOAT", 10, 1, faces, determinant)
    weighed_sum = make.sum("FLOAT_VECTOR", 10, 2.5, faces, weighed)
    quarter_inverse = make.math("DIVIDE", 10.5, 1, 0.25, sixfold_volume)
    center = make.vector("SCALE", 11, 2, weighed_sum, Scale=quarter_inverse)  # from the middle
    magnitude = make.math("ABSOLUTE", 10.5, 0.5, sixfold_volume)
    volume = make.math("DIVIDE", 11, 0.5, magnitude, 6.0)
    make.node(
        "NodeGroupOutput",
        12,
        0.0,
        {
            "Center": make.vector("ADD", 11.5, 2, center, middle),
            "Volume": volume,
            "Mass": make.math("MULTIPLY", 11.5, 0.5, volume, inputs["Density"]),
        },
    )


def _corner(make: _Builder, index: int, position: NodeSocket, middle: NodeSocket) -> NodeSocket:
    """Return the position of a corner of each triangle, relative to the middle of the box."""
    row = 2 + index
    corner = make.node("GeometryNodeCornersOfFace", 4, row, {"Sort Index": index})
    vertex = make.node(
        "GeometryNodeVertexOfCorner", 5, row, {"Corner Index": corner.outputs["Corner Index"]}
    )
    corner_position = make.node(
        "GeometryNodeFieldAtIndex",
        5.5,
        row,
        {"Value": position, "Index": vertex.outputs["Vertex Index"]},
        domain="POINT",
        data_type="FLOAT_VECTOR",
    )
    return make.vector("SUBTRACT", 6, row, corner_position.outputs["Value"], middle)


def add_marker(context: Context, obj: Object, group: GeometryNodeTree) -> Object:
    """Add an object, at the world's origin, that shows a ball at the center of mass of `obj`;
    return it.
    """
    tree = bpy.data.node_groups.new(MARKER_NAME, "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    tree.is_modifier = True
    make = _Builder(tree)
    source = make.node(
        "GeometryNodeObjectInfo", 1, 0.0, {"Object": obj}, transform_space="RELATIVE"
    )
    density = object_density(obj.body_moments, context.scene) * meters_per_unit(context.scene) ** 3
    measured = make.node(
        "GeometryNodeGroup",
        2,
        0.0,
        {"Density": density, "Geometry": source.outputs["Geometry"]},
        node_tree=group,
    )
    ball = make.node(
        "GeometryNodeMeshIcoSphere",
        2,
        1,
        {"Radius": MARKER_SHARE * max(obj.dimensions), "Subdivisions": 3},
    )
    placed = make.node(
        "GeometryNodeTransform",
        4,
        0.0,
        {"Geometry": ball.outputs["Mesh"], "Translation": measured.outputs["Center"]},
    )
    make.node("NodeGroupOutput", 5, 0.0, {"Geometry": placed.outputs["Geometry"]})
    marker = bpy.data.objects.new(
        "{:s} {:s}".format(obj.name, GROUP_NAME), bpy.data.meshes.new(MARKER_NAME)
    )
    marker.modifiers.new(MARKER_NAME, "NODES").node_group = tree
    marker.show_in_front = True
    marker.hide_render = True
    context.collection.objects.link(marker)
    return marker
