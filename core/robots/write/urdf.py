# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF, with the inertial frame and the tensor along the link's axes (rpy 0).

Some readers ignore the inertial frame's rotation (ros2/rviz#1170) or diagonalize wrongly. The
products ixy, ixz and iyz are entries of the tensor, such as -∫xy dm. A link's origin is at its
joint.
"""

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from xml.etree.ElementTree import Element

import numpy as np

from ...mesh import Surface
from ...verdict import Finding, finding
from ..findings import ROBOT_BASE_ADDED, URDF_EFFORT_UNKNOWN, URDF_ROOT_WITHOUT_MASS
from ..model import FreeAxis, Inertial, Joint, Pose, Robot, Shape
from ..stated import ENTRIES, StatedInertial
from .joints import lost_values, with_axis_frames
from .mjcf import raised_inertials, small_links
from .shapes import box_of_ellipsoid, capsule_pieces, ellipsoids_as_boxes, shape_values
from .text import (
    document,
    element,
    element_text,
    free_name,
    is_identity,
    number,
    numbers,
    roll_pitch_yaw,
    unique_names,
    xml_name,
)

FLATNESS = 1e-7  # Thickness relative to length, of float32 vertices in a plane.
BASE, WORLD = "base_link", "world"
# The largest moment of a flat body is lowered by this part, as MuJoCo tests A + B ≥ C without
# tolerance: 16 times the rounding of float64, for the rounding of both programs.
SLACK = 2.0**-48
LEAST = 1e-14  # kg and kg·m² that MuJoCo gives massless frames, as it refuses less than 1e-15.
BOUNDED = 1e-13  # It takes smaller tensors for singular, unless a bound is set.
# A limited joint must state these unknown values. N·m or N, and rad/s or m/s, too large to have an
# effect.
EFFORT, VELOCITY = 1e6, 1e3


def check(robot: Robot) -> list[Finding]:
    """Return findings about content that the format cannot express."""
    findings = []
    loose = [link for link in robot.roots if not link.is_fixed]
    if loose and len(robot.roots) > 1:
        name = BASE if len(loose) == len(robot.roots) else WORLD
        findings.append(finding(ROBOT_BASE_ADDED, count=len(loose), name=name))
    # A root of the file that is to be free, and has no mass: an added one, or a frame.
    massless_root = BASE if len(loose) == len(robot.roots) > 1 else ""
    if len(robot.roots) == len(loose) == 1 and loose[0].inertial is None:
        massless_root = loose[0].name
    if massless_root:
        findings.append(finding(URDF_ROOT_WITHOUT_MASS, name=massless_root))
    findings += ellipsoids_as_boxes(robot)
    unknown = [
        joint.name
        for joint in robot.joints
        if any(
            _needs_limit(free) and not {"effort", "velocity"} <= free.values.keys()
            for free in joint.free
        )
    ]
    if unknown:
        findings.append(finding(URDF_EFFORT_UNKNOWN, count=len(unknown), joints=unknown))
    return findings + raised_inertials(robot, LEAST) + lost_values(robot, "URDF")


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as URDF, with remarks as comments. inertial_only: only the links with their
    inertials.

    A file has one root. A single loose one is it; else all roots are fixed to an added link: the
    world if one of them is fixed to it.
    """
    robot = robot if inertial_only else with_axis_frames(robot.at_joints())
    names = unique_names([link.name for link in robot.links], _name)
    joint_names = unique_names([joint.name for joint in robot.joints], xml_name)
    parts = []
    base = None  # the name of the added root
    if not inertial_only:
        parts.append(_compiler(robot))
        if any(link.is_fixed for link in robot.roots):
            base = WORLD
        elif len(robot.roots) > 1:
            base = free_name(BASE, names.values())
    if base is not None:
        parts.append(element("link", _no_mass(), name=base))
    for link in robot.ordered():
        inertial = _no_mass() if link.inertial is None else _inertial(link.inertial)
        shapes = () if inertial_only else _shapes(link.shapes)
        parts.append(element("link", inertial, *shapes, name=names[link.name]))
    for link in () if inertial_only else robot.ordered():
        joint = robot.joint_of(link.name)
        child = names[link.name]
        if joint is not None:
            name, parent = joint_names[joint.name], names[joint.parent]
        elif base is not None:
            name, parent = free_name(child + "_joint", joint_names.values()), base
        else:
            continue
        parts.append(_joint(robot.pose_in_parent(link), joint, joint_names, name, parent, child))
    return document(element("robot", *parts, name=xml_name(robot.name)), "urdf", remarks)


def _name(text: str) -> str:
    """Return a valid name; MuJoCo and Gazebo take a root named `world` as the world itself."""
    text = xml_name(text)
    return text + "_" if text == WORLD else text


def _compiler(robot: Robot) -> Element:
    """Return the element that lets MuJoCo keep fixed links, folders of meshes, and links of little
    or no mass; other readers skip it.
    """
    values = {"fusestatic": "false", "strippath": "false"}
    is_bare = any(link.inertial is None and robot.joint_of(link.name) for link in robot.links)
    if is_bare or small_links(robot, BOUNDED):
        values |= {"boundmass": number(LEAST), "boundinertia": number(LEAST)}
    return element("mujoco", element("compiler", **values))


def _origin(pose: Pose) -> Element:
    if is_identity(pose):
        return element("origin", xyz="0 0 0", rpy="0 0 0")
    return element("origin", xyz=numbers(pose.position), rpy=numbers(roll_pitch_yaw(pose.rotation)))


def _inertial(inertial: Inertial) -> Element:
    tensor = inertial.inertia
    axis = inertial.axes[:, 2]
    first, second, third = inertial.moments
    # What the sum of the others lacks to exceed the largest moment by the slack.
    missing = SLACK * third - (first + second - third)
    if missing > 0.0:
        tensor = tensor - missing * np.outer(axis, axis)
    return element(
        "inertial",
        element("origin", xyz=numbers(inertial.center), rpy="0 0 0"),
        element("mass", value=number(inertial.mass)),
        element("inertia", **{name: number(tensor[i, j]) for name, i, j in ENTRIES}),
    )


def _no_mass() -> Element:
    """Return zeros; some readers take 1 kg for a link without inertial."""
    zeros = element("inertia", **{name: "0" for name, _, _ in ENTRIES})
    return element("inertial", element("mass", value="0"), zeros)


def inertial_text(inertial: StatedInertial, *_: object) -> str:
    """Return the element of a repaired inertial."""
    return element_text(_inertial(inertial.principal()))


def _shapes(shapes: Sequence[Shape]) -> Iterator[Element]:
    for tag in ("visual", "collision"):
        for shape in shapes:
            if shape.seen if tag == "visual" else shape.collides and not _is_flat(shape.surface):
                for piece in map(box_of_ellipsoid, capsule_pieces(shape)):
                    values = {"filename": piece.file} if piece.kind == "mesh" else {}
                    form = element(piece.kind, **values, **shape_values(piece))
                    yield element(tag, _origin(piece.pose), element("geometry", form))


def _is_flat(surface: Surface | None) -> bool:
    """Return whether a surface lies in a plane, so that no convex hull of it can collide; MuJoCo
    refuses it.
    """
    if surface is None:
        return False
    points = surface.used_points()
    # Variances along the principal directions, the least at the end: squares of lengths.
    spread = np.linalg.svd(np.cov((points - points[0]).T), compute_uv=False)
    return bool(spread[2] <= FLATNESS**2 * spread[0])


def _joint(
    pose: Pose, joint: Joint | None, names: Mapping[str, str], name: str, parent: str, child: str
) -> Element:
    """Return a joint of at most one axis. pose: of the child in the parent. joint: None for a root
    that is fixed to the added link. names: of the joints in the file.
    """
    free = joint.free[0] if joint is not None and joint.free else None
    parts = [_origin(pose), element("parent", link=parent), element("child", link=child)]
    if joint is not None and free is not None:
        parts.append(element("axis", xyz=numbers(joint.pose.rotation @ free.axis)))
        if _needs_limit(free):
            parts.append(_limit(free))
        dynamics = {
            key: number(free.values[key]) for key in ("damping", "friction") if key in free.values
        }
        if dynamics:
            parts.append(element("dynamics", **dynamics))
        if joint.mimic is not None:
            leader, multiplier, offset = joint.mimic
            values = {"multiplier": number(multiplier), "offset": number(offset)}
            parts.append(element("mimic", joint=names[leader], **values))
    return element("joint", *parts, name=name, type=_joint_type(free))


def _needs_limit(free: FreeAxis) -> bool:
    return (
        free.is_limited
        or free.kind == "translate"
        or bool({"effort", "velocity"} & free.values.keys())
    )


def _joint_type(free: FreeAxis | None) -> str:
    if free is None:
        return "fixed"
    if free.kind == "translate":
        return "prismatic"
    return "revolute" if free.is_limited else "continuous"


def _limit(free: FreeAxis) -> Element:
    """Return the limits of a joint; an open one becomes a far one, because URDF requires both."""
    limit = {}
    if free.is_limited or free.kind == "translate":
        far = 2.0 * pi if free.kind == "rotate" else 1e3  # a whole turn, or a kilometer: chosen
        limit = {"lower": number(max(free.lower, -far)), "upper": number(min(free.upper, far))}
    rates = {"effort": EFFORT, "velocity": VELOCITY}
    limit |= {name: number(free.values.get(name, value)) for name, value in rates.items()}
    return element("limit", **limit)
