# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""OpenSim models (.osim, version 4), with z up: gravity is stated, so nothing is turned.

A body has the tensor about its mass center, along its own axes. Geometry is only seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from ...verdict import Finding
from ..model import Joint, Link, Pose, Robot, Shape
from .joints import lost_values
from .shapes import capsule_pieces
from .text import add_text, document, numbers, roll_pitch_yaw, unique_names
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
    return (
        True if kinds == sorted(kinds, reverse=True) else False if kinds == sorted(kinds) else None
    )


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as a model of OpenSim. remarks, inertial_only: as in `urdf.write`."""
    names = unique_names([link.name for link in robot.links], identifier, ["ground"])
    joint_names = unique_names([joint.name for joint in robot.joints], identifier)
    root = Element("OpenSimDocument", Version=VERSION)
    model = SubElement(root, "Model", name=identifier(robot.name))
    add_text(model, "gravity", numbers(GRAVITY))
    bodies = SubElement(SubElement(model, "BodySet", name="bodyset"), "objects")
    joints = (
        model
        if inertial_only
        else SubElement(SubElement(model, "JointSet", name="jointset"), "objects")
    )
    for link in robot.ordered():
        _add_body(bodies, link, names[link.name], () if inertial_only else link.shapes)
        if not inertial_only:
            joint = robot.joint_of(link.name)
            if joint is None:
                name = names[link.name]
                is_free = not link.is_fixed and any(
                    part.inertial is not None for part in robot.rigid_parts(link)
                )
                element = SubElement(
                    joints, "FreeJoint" if is_free else "WeldJoint", name=name + "_ground"
                )
                _add_ends(element, (("", link.pose), (name, Pose())))
            else:
                _add_joint(joints, robot, joint, joint_names[joint.name], names)
    return document(root, "osim", remarks)


def _add_body(bodies: Element, link: Link, name: str, shapes: Sequence[Shape]) -> None:
    body = SubElement(bodies, "Body", name=name)
    seen = [piece for shape in shapes if shape.seen for piece in capsule_pieces(shape)]
    components = SubElement(body, "components") if seen else body
    for count, shape in enumerate(seen, start=1):
        turn = shape.pose.rotation @ ALONG_Y if shape.kind == "cylinder" else shape.pose.rotation
        frame = _add_frame(
            components, "shape_{}".format(count), name, Pose(shape.pose.position, turn)
        )
        _add_geometry(SubElement(frame, "attached_geometry"), shape)
    mass = 0.0
    center = np.zeros(3)
    tensor = np.zeros((3, 3))
    if link.inertial is not None:
        mass = link.inertial.mass
        center = link.inertial.center
        tensor = link.inertial.inertia
    add_text(body, "mass", numbers([mass]))
    add_text(body, "mass_center", numbers(center))
    add_text(body, "inertia", numbers(tensor[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]))


def _add_geometry(parent: Element, shape: Shape) -> None:
    tag, name, factor = _FORMS[shape.kind]
    element = SubElement(parent, tag, name=shape.kind)
    lengths = shape.size[:1] if shape.kind == "cylinder" else shape.size
    add_text(element, name, numbers(factor * length for length in lengths))
    if shape.kind == "mesh":
        add_text(element, "mesh_file", shape.file)
    elif shape.kind == "cylinder":
        add_text(element, "half_height", numbers([shape.size[1] / 2.0]))


def _add_frame(parent: Element, name: str, body: str, pose: Pose) -> Element:
    """Add a frame of a body, "" for the ground, and return it.

    Its angles turn about its own x, y and z in turn.
    """
    frame = SubElement(parent, "PhysicalOffsetFrame", name=name)
    add_text(frame, "socket_parent", "/bodyset/" + body if body else "/ground")
    add_text(frame, "translation", numbers(pose.position))
    add_text(frame, "orientation", numbers(-angle for angle in roll_pitch_yaw(pose.rotation.T)))
    return frame


def _add_ends(joint: Element, ends: Sequence[tuple[str, Pose]]) -> None:
    frames = SubElement(joint, "frames")
    for side, (body, pose) in zip(("parent", "child"), ends):
        add_text(joint, "socket_{}_frame".format(side), side)
        _add_frame(frames, side, body, pose)


def _add_joint(
    joints: Element, robot: Robot, joint: Joint, name: str, names: dict[str, str]
) -> None:
    """Add a joint.

    A CustomJoint moves before it turns; one that turns first is stated from its other side.
    """
    place = robot.pose_in_parent(robot.link(joint.child)) @ joint.pose
    ends = ((names[joint.parent], place), (names[joint.child], joint.pose))
    kind = "BallJoint" if joint.is_ball else "CustomJoint" if joint.free else "WeldJoint"
    element = SubElement(joints, kind, name=name)
    is_turned = _order(joint) is False
    _add_ends(element, ends[::-1] if is_turned else ends)
    if kind != "CustomJoint":
        return
    axes = [free.reverse() for free in reversed(joint.free)] if is_turned else joint.free
    coordinates = SubElement(element, "coordinates")
    transform = SubElement(element, "SpatialTransform")
    for title, freedom in (("rotation", "rotate"), ("translation", "translate")):
        own = [free for free in axes if free.kind == freedom]
        rest = np.linalg.qr(np.column_stack([*(free.axis for free in own), np.eye(3)]))[0].T[
            len(own) :
        ]
        for count, direction in enumerate([*(free.axis for free in own), *rest], start=1):
            axis = SubElement(transform, "TransformAxis", name="{}{}".format(title, count))
            if count > len(own):
                add_text(axis, "axis", numbers(direction))
                add_text(SubElement(axis, "Constant", name="function"), "value", "0")
                continue
            free = own[count - 1]
            label = name if len(axes) == 1 else "{}_{}{}".format(name, title, count)
            coordinate = SubElement(coordinates, "Coordinate", name=label)
            if free.is_limited:
                add_text(
                    coordinate, "range", numbers((max(free.lower, -FAR), min(free.upper, FAR)))
                )
                add_text(coordinate, "clamped", "true")
            add_text(axis, "coordinates", label)
            add_text(axis, "axis", numbers(direction))
            add_text(SubElement(axis, "LinearFunction", name="function"), "coefficients", "1 0")
