# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot as glTF, with KHR_physics_rigid_bodies and OMI_physics_body: as a file of its own, or in
a file that Blender's exporter has written.

Blender's z up is glTF's y up: (x, y, z) becomes (x, z, -y). In a file of its own, every link is a
body, in meters. A joint has a node below the parent link's node and a connected node below the
child's, both at the joint's frame and turned so that the axes of freedom are axes of these nodes;
fixed directions have the limits zero. Meshes are embedded: glTF knows no files of other formats.

In Blender's file the nodes stay as they are; nodes of bodies get the two extensions. Blender writes
its own units as meters, whatever the scene's unit scale, so a node above all others scales them. A
body has the mass of all links that are fixed to it; nodes without a motion of their own move with
the node above.
"""

import base64
import json
from collections.abc import Sequence
from math import inf
from typing import Any

import numpy as np

from ...mesh import Surface, keep_used
from ...numerics import Array, ArrayLike, NDArray, along_x, quaternion
from ...verdict import Finding, finding
from ..findings import GLTF_NODE_MISSING, GLTF_SCALED, ROBOT_SCALED, UNIT_SCALE
from ..model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape
from .joints import NAMES, lost_values, split_frames
from .marker import MARKER
from .shapes import box_of_ellipsoid, ellipsoids_as_boxes
from .text import unique_names

KHR, OMI = "KHR_physics_rigid_bodies", "OMI_physics_body"
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
UNIFORM_RTOL = 1e-6  # Relative; for scales that differ by float32 rounding alone.
SHAPES = "KHR_implicit_shapes"


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    return ellipsoids_as_boxes(robot) + lost_values(robot, "glTF")


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as the text of a .gltf file. remarks, inertial_only: as in `urdf.write`."""
    robot = robot.without_motion() if inertial_only else split_frames(robot)[0]
    document = _Document(robot)
    for link in robot.ordered():
        document.add_link(link)
    for joint in robot.joints:
        document.add_joint(joint)
    return document.text(remarks)


class _Document:
    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.names = unique_names([link.name for link in robot.links], str)
        self.nodes: list[dict[str, Any]] = []
        self.node_of_link: dict[str, int] = {}
        self.meshes: list[dict] = []
        self.accessors: list[dict] = []
        self.buffer_views: list[dict] = []
        self.shapes: list[dict] = []
        self.joints: list[dict] = []
        self.buffer = b""
        self.unseen: set[int] = set()  # Nodes in no scene, for meshes that only collide.

    def add_link(self, link: Link) -> None:
        index = self._node(self.names[link.name], link.pose)
        self.node_of_link[link.name] = index
        if link.inertial is not None:
            extensions = body_extensions(link.inertial, is_fixed=link.is_fixed)
            self.nodes[index]["extensions"] = extensions
        for shape in link.shapes:
            self._add_shape(index, link, shape)

    def _node(
        self, name: str, pose: Pose, parent: int | None = None, turn: NDArray | None = None
    ) -> int:
        """Add a node and return its index. pose: with z up, in the parent node or the scene. turn:
        (3, 3) further rotation, about axes of the node.
        """
        rotation = Y_UP @ pose.rotation @ Y_UP.T
        node: dict[str, Any] = {"name": name}
        if pose.position.any():
            node["translation"] = (Y_UP @ pose.position + 0.0).tolist()
        w, x, y, z = quaternion(rotation if turn is None else rotation @ turn).tolist()
        if (x, y, z) != (0.0, 0.0, 0.0):
            node["rotation"] = [x, y, z, w]
        self.nodes.append(node)
        if parent is not None:
            self.nodes[parent].setdefault("children", []).append(len(self.nodes) - 1)
        return len(self.nodes) - 1

    def _add_shape(self, parent: int, link: Link, shape: Shape) -> None:
        geometry: dict[str, Any]
        if shape.kind == "mesh":
            if shape.surface is None:
                return
            # A mesh that is not seen hangs on a node of its own, outside of the scene.
            index = holder = self._node(
                link.name + (" mesh" if shape.seen else " collider"), shape.pose, parent
            )
            if not shape.seen:
                holder = self._node(link.name + " hull", Pose())
                self.unseen.add(holder)
            mesh = self.nodes[holder]["mesh"] = self._mesh(shape.surface)
            # The draft of 2026 names the mesh, the one before a node that holds it.
            geometry = {"mesh": mesh, "node": holder, "convexHull": True}
        else:
            index = self._node("{} {}".format(link.name, shape.kind), shape.pose, parent)
            geometry = {"shape": len(self.shapes)}
            self.shapes.append(_implicit(box_of_ellipsoid(shape)))
        if shape.collides:
            self.nodes[index]["extensions"] = {KHR: {"collider": {"geometry": geometry}}}

    def _mesh(self, surface: Surface) -> int:
        """Add a mesh with its tables, and return its index."""
        used_points, triangles = keep_used(surface.points, surface.all_triangles()[0])
        points = (used_points @ Y_UP.T + 0.0).astype("<f4")
        bounds = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
        # 5126: float32, 5125: uint32; 34962: vertices, 34963: indices.
        position = self._accessor(points.tobytes(), 5126, "VEC3", len(points), 34962, bounds)
        indices = self._accessor(
            triangles.astype("<u4").tobytes(), 5125, "SCALAR", triangles.size, 34963, {}
        )
        self.meshes.append(
            {"primitives": [{"attributes": {"POSITION": position}, "indices": indices}]}
        )
        return len(self.meshes) - 1

    def _accessor(
        self, data: bytes, component: int, kind: str, count: int, target: int, more: dict
    ) -> int:
        """Add a table of numbers and return its index. component, target: codes of glTF for the
        type of the numbers, and for vertices or indices. more: further values.
        """
        self.buffer_views.append(
            {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), "target": target}
        )
        self.buffer += data
        view = len(self.buffer_views) - 1
        accessor = {"bufferView": view, "componentType": component, "type": kind, "count": count}
        self.accessors.append(accessor | more)
        return len(self.accessors) - 1

    def add_joint(self, joint: Joint) -> None:
        child = self.robot.link(joint.child)
        parent = self.robot.link(joint.parent)
        # The nodes' x axis is a single free axis; several are axes of the joint's frame already.
        turn = along_x(Y_UP @ joint.free[0].axis) if len(joint.free) == 1 else np.eye(3)
        place = parent.pose.inverse() @ child.pose @ joint.pose
        index = self._node(joint.name, place, self.node_of_link[parent.name], turn)
        end = self._node(joint.name + " end", joint.pose, self.node_of_link[child.name], turn)
        reference = {"connectedNode": end, "joint": len(self.joints)}
        self.nodes[index]["extensions"] = {KHR: {"joint": reference}}
        drives = _drives(joint, turn)
        more = {"drives": drives} if drives else {}
        self.joints.append({"name": joint.name, "limits": _limits(joint, turn)} | more)

    def text(self, remarks: Sequence[str]) -> str:
        children = self.unseen.union(*(node.get("children", ()) for node in self.nodes))
        roots = [index for index in range(len(self.nodes)) if index not in children]
        asset: dict[str, Any] = {"generator": MARKER.format("gltf"), "version": "2.0"}
        if remarks:
            asset["extras"] = {"remarks": list(remarks)}
        used = {KHR, OMI}
        of_root = {}
        if self.joints:
            of_root[KHR] = {"physicsJoints": self.joints}
        if self.shapes:
            used.add(SHAPES)
            of_root[SHAPES] = {"shapes": self.shapes}
        document: dict[str, Any] = {
            "asset": asset,
            "extensionsUsed": sorted(used),
            **({"extensions": of_root} if of_root else {}),
            "scene": 0,
            "scenes": [{"name": self.robot.name, "nodes": roots}],
            "nodes": self.nodes,
        }
        if self.buffer:
            document["meshes"] = self.meshes
            document["accessors"] = self.accessors
            document["bufferViews"] = self.buffer_views
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.buffer).decode()
            document["buffers"] = [{"byteLength": len(self.buffer), "uri": uri}]
        return json.dumps(document, ensure_ascii=False, indent=1, allow_nan=False) + "\n"


def _implicit(shape: Shape) -> dict[str, Any]:
    """Return a box, sphere, capsule or cylinder as an entry of KHR_implicit_shapes, in whose axes
    our z is y.
    """
    if shape.kind == "box":
        x, y, z = shape.size
        return {"type": "box", "box": {"size": [x, z, y]}}
    if shape.kind == "sphere":
        return {"type": "sphere", "sphere": {"radius": shape.size[0]}}
    radius, height = shape.size
    return {
        "type": shape.kind,
        shape.kind: {"height": height, "radiusTop": radius, "radiusBottom": radius},
    }


def _limits(joint: Joint, turn: NDArray) -> list[dict[str, Any]]:
    """Return the limits of a joint along its node's axes: zero for fixed directions, the range of
    limited ones. turn: (3, 3), from the node's axes to those of the joint's frame with y up.
    """
    fixed = {"linearAxes": {0, 1, 2}, "angularAxes": {0, 1, 2}}
    limits: list[dict[str, Any]] = []
    for free in joint.free:
        direction, axis = _direction(free, turn)
        kind = "linearAxes" if free.kind == "translate" else "angularAxes"
        fixed[kind].discard(axis)
        low, high = (
            (free.lower, free.upper) if direction[axis] > 0.0 else (-free.upper, -free.lower)
        )
        ends = {name: value for name, value in (("min", low), ("max", high)) if abs(value) < inf}
        if ends:
            limits.append({kind: [axis]} | ends)
    return [
        *({kind: sorted(axes), "min": 0.0, "max": 0.0} for kind, axes in fixed.items() if axes),
        *limits,
    ]


def _drives(joint: Joint, turn: NDArray) -> list[dict[str, Any]]:
    """Return the drives of a joint's axes with known values, at rest."""
    drives: list[dict[str, Any]] = []
    for free in joint.free:
        values = {
            name: free.values[key] for key, name in NAMES["glTF"].items() if key in free.values
        }
        if values:
            kind = "angular" if free.kind == "rotate" else "linear"
            drives.append(
                {"type": kind, "mode": "force", "axis": _direction(free, turn)[1]} | values
            )
    return drives


def _direction(free: FreeAxis, turn: NDArray) -> tuple[Array, int]:
    """Return the direction of a free axis along the joint's node, and the index of the node's axis
    next to it.
    """
    direction = turn.T @ Y_UP @ free.axis
    return direction, int(np.argmax(np.abs(direction)))


def body_extensions(
    inertial: Inertial, scale: ArrayLike = 1.0, is_fixed: bool = False
) -> dict[str, Any]:
    """Return both extensions of a node that is a rigid body, for an inertial along Blender's axes.

    scale: meters per unit of the node's own space along Blender's axes, for the center.
    """
    values: dict[str, Any] = {
        "mass": inertial.mass,
        "centerOfMass": (Y_UP @ (inertial.center / np.asarray(scale)) + 0.0).tolist(),
    }
    if inertial.moments[0] > 0.0:  # zero would be automatic, or infinite
        w, x, y, z = quaternion(Y_UP @ inertial.axes).tolist()
        values["inertiaDiagonal"] = inertial.moments.tolist()
        values["inertiaOrientation"] = [x, y, z, w]
    kinematic = {"isKinematic": True} if is_fixed else {}
    kind = {"type": "kinematic" if is_fixed else "dynamic"}
    return {KHR: {"motion": (kinematic | values)}, OMI: {"motion": (kind | values)}}


def add_rigid_bodies(
    document: dict[str, Any], robot: Robot, meters_per_unit: float
) -> list[Finding]:
    """Add the motions of bodies to the nodes of a glTF document, and a node for its unit, in place;
    return findings.

    robot: its links have the names of nodes, and no joint moves: one with such joints is written as
    a document of its own. So each root has the inertia of all links below it. meters_per_unit: unit
    scale of the Blender scene.
    """
    nodes = document.get("nodes", [])
    bones = {joint for skin in document.get("skins", []) for joint in skin["joints"]}
    by_name: dict[str, list[dict]] = {}
    for index, node in enumerate(nodes):
        if index not in bones and "name" in node:
            by_name.setdefault(node["name"], []).append(node)
    missing = []
    scaled = []
    for link in robot.roots:
        inertial = robot.rigid_inertial(link)
        if inertial is None:
            continue
        nodes_of_link = by_name.get(link.name, [])
        if len(nodes_of_link) != 1:  # none, or which one is unknown
            missing.append(link.name)
            continue
        if np.abs(link.scale - 1.0).max() > UNIFORM_RTOL:
            scaled.append(link.name)
        extensions = body_extensions(inertial, meters_per_unit * link.scale, link.is_fixed)
        nodes_of_link[0].setdefault("extensions", {}).update(extensions)
        document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), KHR, OMI})
    findings = [finding(GLTF_NODE_MISSING, count=len(missing), links=missing)] if missing else []
    if scaled:
        findings.append(finding(ROBOT_SCALED, count=len(scaled), links=scaled))
    if meters_per_unit == 1.0:
        return findings
    for scene in document.get("scenes", []):
        if scene.get("nodes"):
            scale = [meters_per_unit] * 3
            nodes.append({"name": "Meters", "scale": scale, "children": scene["nodes"]})
            scene["nodes"] = [len(nodes) - 1]
    return [*findings, finding(UNIT_SCALE, scale=meters_per_unit, cause=GLTF_SCALED)]
