# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenSim models (.osim, version 4), with z up: gravity is stated, so nothing is turned.

A body has the tensor about its mass center, along its own axes. Geometry is only seen.
"""

from collections.abc import Sequence
from xml.etree.ElementTree import Element

import numpy as np

from ...verdict import Finding
from ..model import FreeAxis, Joint, Link, Pose, Robot, Shape
from .joints import lost_values
from .shapes import capsule_pieces
from .text import document, element, numbers, roll_pitch_yaw, unique_names
from .usd import identifier

VERSION = "40000"
GRAVITY = (0.0, 0.0, -9.80665)
FAR = 1e3  # rad or m, in the place of an open limit
ALONG_Y = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # Cylinders stand along y.
_FORMS = {
    "mesh": ("Mesh", "scale_factors", 1.0),
    "box": ("Brick", "half_lengths", 0.5),
    "ellipsoid": ("Ellipsoid", "radii", 1.0),
    "sphere": ("Sphere", "radius", 1.0),
    "cylinder": ("Cylinder", "radius", 1.0),
}


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    return lost_values(
        robot, "OpenSim", lambda joint, _: {"order of axes"} if _order(joint) is None else set()
    )


def _order(joint: Joint) -> bool | None:
    """Return True if a joint moves before it turns, False if it turns first, None if it does
    neither.
    """
    kinds = [free.kind for free in joint.free]
    # In the alphabet "rotate" comes before "translate".
    if kinds == sorted(kinds, reverse=True):
        return True
    return False if kinds == sorted(kinds) else None


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as a model of OpenSim. remarks, inertial_only: as in `urdf.write`."""
    names = unique_names([link.name for link in robot.links], identifier, ["ground"])
    joint_names = unique_names([joint.name for joint in robot.joints], identifier)
    bodies = []
    joints = []
    for link in robot.ordered():
        bodies.append(_body(link, names[link.name], () if inertial_only else link.shapes))
        joint = robot.joint_of(link.name)
        if joint is not None and not inertial_only:
            joints.append(_joint(robot, joint, joint_names[joint.name], names))
        elif not inertial_only:
            name = names[link.name]
            ends = _ends((("", link.pose), (name, Pose())))  # the ground, and the link itself
            kind = "FreeJoint" if robot.moves_freely(link) else "WeldJoint"
            joints.append(element(kind, *ends, name=name + "_ground"))
    sets = [element("BodySet", element("objects", *bodies), name="bodyset")]
    if not inertial_only:
        sets.append(element("JointSet", element("objects", *joints), name="jointset"))
    gravity = element("gravity", text=numbers(GRAVITY))
    model = element("Model", gravity, *sets, name=identifier(robot.name))
    return document(element("OpenSimDocument", model, Version=VERSION), "osim", remarks)


def _body(link: Link, name: str, shapes: Sequence[Shape]) -> Element:
    seen = [piece for shape in shapes if shape.seen for piece in capsule_pieces(shape)]
    frames = []
    for count, shape in enumerate(seen, start=1):
        turn = shape.pose.rotation @ ALONG_Y if shape.kind == "cylinder" else shape.pose.rotation
        pose = Pose(shape.pose.position, turn)
        form = element("attached_geometry", _geometry(shape))
        frames.append(_frame("shape_{}".format(count), name, pose, form))
    parts = [element("components", *frames)] if seen else []
    values = {"mass": [0.0], "mass_center": np.zeros(3), "inertia": np.zeros(6)}
    if link.inertial is not None:
        entries = link.inertial.inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        values = {
            "mass": [link.inertial.mass],
            "mass_center": link.inertial.center,
            "inertia": entries,
        }
    parts += (element(key, text=numbers(value)) for key, value in values.items())
    return element("Body", *parts, name=name)


def _geometry(shape: Shape) -> Element:
    tag, name, factor = _FORMS[shape.kind]
    lengths = shape.size[:1] if shape.kind == "cylinder" else shape.size
    parts = [element(name, text=numbers(factor * length for length in lengths))]
    if shape.kind == "mesh":
        parts.append(element("mesh_file", text=shape.file))
    elif shape.kind == "cylinder":
        parts.append(element("half_height", text=numbers([shape.size[1] / 2.0])))
    return element(tag, *parts, name=shape.kind)


def _frame(name: str, body: str, pose: Pose, *parts: Element) -> Element:
    """Return a frame of a body, "" for the ground, with more elements in it.

    Its angles turn about its own x, y and z in turn. That is the inverse of Rz(-z) Ry(-y) Rx(-x),
    so they are the roll, pitch and yaw of the transposed rotation, with the other sign.
    """
    texts = {
        "socket_parent": "/bodyset/" + body if body else "/ground",
        "translation": numbers(pose.position),
        "orientation": numbers(-angle for angle in roll_pitch_yaw(pose.rotation.T)),
    }
    place = (element(tag, text=text) for tag, text in texts.items())
    return element("PhysicalOffsetFrame", *place, *parts, name=name)


def _ends(ends: Sequence[tuple[str, Pose]]) -> list[Element]:
    """Return the elements for the parent and the child of a joint: each a body, "" for the ground,
    and the pose of the joint in it.
    """
    sides = [*zip(("parent", "child"), ends)]
    frames = (_frame(side, body, pose) for side, (body, pose) in sides)
    sockets = (element("socket_{}_frame".format(side), text=side) for side, _ in sides)
    return [element("frames", *frames), *sockets]


def _joint(robot: Robot, joint: Joint, name: str, names: dict[str, str]) -> Element:
    """Return a joint. names: of the bodies, by link.

    A CustomJoint moves before it turns, each along three axes in a row, which are free or constant.
    A joint that turns first is stated from its other side, with parent and child exchanged.
    """
    place = robot.pose_in_parent(robot.link(joint.child)) @ joint.pose
    ends = ((names[joint.parent], place), (names[joint.child], joint.pose))
    kind = "BallJoint" if joint.is_ball else "CustomJoint" if joint.free else "WeldJoint"
    is_exchanged = _order(joint) is False
    parts = _ends(ends[::-1] if is_exchanged else ends)
    if kind != "CustomJoint":
        return element(kind, *parts, name=name)
    all_free = [free.reverse() for free in reversed(joint.free)] if is_exchanged else joint.free
    coordinates = []
    axes = []
    for title, kind_of_axis in (("rotation", "rotate"), ("translation", "translate")):
        free_axes = [free for free in all_free if free.kind == kind_of_axis]
        directions = [free.axis for free in free_axes]
        # The first rows span the free directions; the others complete them to three axes.
        completed = np.linalg.qr(np.column_stack([*directions, np.eye(3)]))[0].T
        for index, direction in enumerate([*directions, *completed[len(directions) :]]):
            axis_name = "{}{}".format(title, index + 1)
            along = element("axis", text=numbers(direction))
            content = [along, element("Constant", element("value", text="0"), name="function")]
            if index < len(free_axes):
                label = "{}_{}".format(name, axis_name) if len(all_free) > 1 else name
                coordinates.append(_coordinate(free_axes[index], label))
                slope = element("coefficients", text="1 0")
                function = element("LinearFunction", slope, name="function")
                content = [element("coordinates", text=label), along, function]
            axes.append(element("TransformAxis", *content, name=axis_name))
    parts += (element("coordinates", *coordinates), element("SpatialTransform", *axes))
    return element(kind, *parts, name=name)


def _coordinate(free: FreeAxis, label: str) -> Element:
    """Return the element of a coordinate, with its range if it is limited."""
    text = numbers((max(free.lower, -FAR), min(free.upper, FAR)))
    limits = (element("range", text=text), element("clamped", text="true"))
    return element("Coordinate", *(limits if free.is_limited else ()), name=label)
