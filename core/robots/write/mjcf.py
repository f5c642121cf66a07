# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""MJCF, for MuJoCo, with the inertia as principal pair, `diaginertia` and `quat`.

MuJoCo's test that no principal moment exceeds the sum of the others has no tolerance, and its
moments of a `fullinertia` are off by rounding, so that it refuses thin plates.
"""

from collections.abc import Iterator, Sequence
from operator import mul
from xml.etree.ElementTree import Element, SubElement

from ...numerics import quaternion
from ...verdict import Finding, finding
from ..findings import INERTIA_TOO_SMALL, RAISED
from ..model import Inertial, Joint, Link, Pose, Robot, Shape
from ..stated import StatedInertial
from .joints import NAMES, lost_values
from .shapes import with_masses
from .text import (
    document,
    element,
    element_text,
    is_identity,
    number,
    numbers,
    unique_names,
    xml_name,
    xml_text,
)

LEAST = 1e-15  # mjMINVAL: MuJoCo refuses moving bodies of less mass or inertia, kg and kg·m².
FAR = 1e10  # rad or m, in the place of an open limit beside a finite one


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that MuJoCo raises or the format cannot express."""
    return raised_inertials(robot, LEAST) + lost_values(
        robot, "MJCF", lambda joint, stated: stated & ({"effort"} if joint.is_ball else set())
    )


def small_links(robot: Robot, limit: float) -> list[str]:
    """Return the names of the links whose mass or least moment is below a limit."""
    return [
        link.name
        for link in robot.links
        if link.inertial is not None and min(link.inertial.mass, link.inertial.moments[0]) < limit
    ]


def raised_inertials(robot: Robot, limit: float) -> list[Finding]:
    """Return the finding about links whose mass or moments MuJoCo raises to a limit, empty if there
    are none.
    """
    return too_small(small_links(robot, limit), limit, "MuJoCo", RAISED)


def too_small(links: list[str], limit: float, program: str, remedy: str) -> list[Finding]:
    """Return the finding about links of too little inertia, empty if there are none."""
    values = {"links": links, "limit": limit, "program": program, "remedy": remedy}
    return [finding(INERTIA_TOO_SMALL, **values)] if links else []


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as MJCF. remarks, inertial_only: as in `urdf.write`."""
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], _name)
    # Each axis of a joint with several is a joint of its own in the file, numbered from 1.
    numbered = {
        (joint.name, index): "{}_{}".format(joint_names[joint.name], index + 1)
        for joint in robot.joints
        if len(joint.free) > 1 and not joint.is_ball
        for index in range(len(joint.free))
    }
    axis_names = unique_names(numbered, lambda axis: numbered[axis], joint_names.values())
    root = Element("mujoco", model=xml_text(robot.name))
    if not inertial_only:
        bounds: dict[str, str] = {}
        if small_links(robot, LEAST):  # MuJoCo refuses them unless it may raise them.
            bounds = {"boundmass": number(LEAST), "boundinertia": number(LEAST)}
        SubElement(root, "compiler", bounds, angle="radian", autolimits="true")
    robot = robot if inertial_only else with_masses(robot)
    meshes = {} if inertial_only else _add_meshes(root, robot)
    world = SubElement(root, "worldbody")
    bodies: dict[str, Element] = {}
    for link in robot.ordered():
        joint = robot.joint_of(link.name)
        parent = world if joint is None else bodies[joint.parent]
        body = bodies[link.name] = SubElement(parent, "body", name=names[link.name])
        if not inertial_only:
            _add_place(body, robot.pose_in_parent(link))
            _add_joints(body, robot, link, joint, joint_names, axis_names)
        if link.inertial is not None:
            body.append(_inertial(link.inertial))
        for shape in () if inertial_only else link.shapes:
            _add_geoms(body, shape, meshes)
    mimics = [] if inertial_only else [*_mimics(robot, joint_names)]
    if mimics:
        root.append(element("equality", *mimics))
    return document(root, "mjcf", remarks)


def _mimics(robot: Robot, names: dict[str, str]) -> Iterator[Element]:
    """Yield the equality of each joint that follows another one. names: of the joints in the
    file.
    """
    for joint in robot.joints:
        if joint.mimic is not None:
            leader, multiplier, offset = joint.mimic
            both = {"joint1": names[joint.name], "joint2": names[leader]}
            # position = offset + multiplier · leader, and no higher powers
            powers = numbers((offset, multiplier, 0.0, 0.0, 0.0))
            yield element("joint", **both, polycoef=powers)


def _name(text: str) -> str:
    text = xml_name(text)
    # The element that contains all bodies has this name.
    return text + "_" if text == "world" else text


def _add_meshes(root: Element, robot: Robot) -> dict[tuple, str]:
    """Add an asset for each mesh, once even if several links show it; return the names by
    `_mesh_key`.
    """
    shapes = {
        _mesh_key(shape): shape
        for link in robot.links
        for shape in link.shapes
        if shape.kind == "mesh"
    }
    assets = []
    names = {}
    for index, (key, shape) in enumerate(shapes.items()):
        names[key] = "mesh_{}".format(index)
        scale = {} if shape.size == (1.0, 1.0, 1.0) else {"scale": numbers(shape.size)}
        shell = {"inertia": "shell"} if shape.sheet else {}
        assets.append(element("mesh", name=names[key], file=shape.file, **scale, **shell))
    if assets:
        root.append(element("asset", *assets))
    return names


def _mesh_key(shape: Shape) -> tuple:
    return shape.file, shape.size, shape.sheet


def _add_place(element: Element, pose: Pose) -> None:
    element.set("pos", numbers(pose.position))
    element.set("quat", numbers(quaternion(pose.rotation)))


def _add_joints(
    body: Element,
    robot: Robot,
    link: Link,
    joint: Joint | None,
    names: dict[str, str],
    axis_names: dict[tuple[str, int], str],
) -> None:
    """Add a joint for each degree of freedom of a link. names: of joints with one axis; axis_names:
    of each axis of others, by the joint's name and the axis's index.

    A root with mass moves freely if it is not fixed.
    """
    if joint is None:
        if robot.moves_freely(link):
            SubElement(body, "freejoint")
        return
    for index, free in enumerate(joint.free[:1] if joint.is_ball else joint.free):
        name = axis_names.get((joint.name, index), names[joint.name])
        kind = {"rotate": "hinge", "translate": "slide"}[free.kind]
        values = {"type": "ball" if joint.is_ball else kind}
        if joint.pose.position.any():
            values["pos"] = numbers(joint.pose.position)
        if not joint.is_ball:
            values["axis"] = numbers(joint.pose.rotation @ free.axis)
            if "effort" in free.values:
                effort = free.values["effort"]
                values["actuatorfrcrange"] = numbers((-effort, effort))
        if free.is_limited:
            values["range"] = numbers((max(free.lower, -FAR), min(free.upper, FAR)))
        for key, value in free.values.items():
            if NAMES["MJCF"].get(key):
                values[NAMES["MJCF"][key]] = number(value)
        body.append(element("joint", name=name, **values))


def _inertial(inertial: Inertial) -> Element:
    place = {"pos": numbers(inertial.center), "quat": numbers(quaternion(inertial.axes))}
    values = {"mass": number(inertial.mass), "diaginertia": numbers(inertial.moments)}
    return element("inertial", **place, **values)


def inertial_text(inertial: StatedInertial, *_: object) -> str:
    """Return the element of a repaired inertial."""
    return element_text(_inertial(inertial.principal()))


def _add_geoms(body: Element, shape: Shape, meshes: dict[tuple, str]) -> None:
    """Add a geom that is only seen, and one that collides, which has the mass of both."""
    mass = number(shape.mass) if shape.mass else "0"
    # MuJoCo makes the convex hull of a collider; a flat sheet has none.
    is_collider = shape.collides and not shape.sheet
    if shape.seen:
        own_mass = "0" if is_collider else mass
        drawn = {"group": "2", "contype": "0", "conaffinity": "0", "mass": own_mass}
        _add_geom(body, shape, meshes, drawn)
    if is_collider:
        _add_geom(body, shape, meshes, {"group": "3", "mass": mass})


def _add_geom(body: Element, shape: Shape, meshes: dict[tuple, str], role: dict[str, str]) -> None:
    geom = SubElement(body, "geom", role, type=shape.kind)
    if not is_identity(shape.pose):
        _add_place(geom, shape.pose)
    if shape.kind == "mesh":
        geom.set("mesh", meshes[_mesh_key(shape)])
    else:
        # MuJoCo states half lengths; radii and semi-axes are halves already.
        halves = {"box": (0.5,) * 3, "capsule": (1.0, 0.5), "cylinder": (1.0, 0.5)}
        factors = halves.get(shape.kind, (1.0,) * 3)
        geom.set("size", numbers(map(mul, shape.size, factors)))
