# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""USD as plain text: PhysicsMassAPI, in single precision, and NewtonMassAPI, in double.

Blender's Python has no `pxr`, so layers are written as text. The largest principal moment is
rounded down until no moment exceeds the sum of the others in float32 too (rule RB.008 of NVIDIA's
SimReady). A body carries the mass of all links fixed to it, because the mass of a parent overrides
that of its children.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from math import degrees, inf, radians

import numpy as np

from ...mesh import Surface, keep_used
from ...numerics import ArrayLike, NDArray, along_x, quaternion
from ...verdict import Finding
from ..findings import TOO_SMALL_FOR_SINGLE
from ..model import FreeAxis, Inertial, Joint, Pose, Robot, Shape
from ..stated import Description, StatedInertial, StatedLink
from .joints import NAMES, lost_values, split_frames
from .marker import MARKER
from .mjcf import too_small
from .text import number, unique_names

ROOT = "Robot"
ARTICULATION = ("PhysicsArticulationRootAPI",)
APIS = ("PhysicsRigidBodyAPI", "PhysicsMassAPI", "NewtonMassAPI")
LEAST = float(np.finfo(np.float32).tiny)  # The least number that float32 holds with all its digits.
_MASS_ATTRIBUTE = re.compile(
    r"[ \t]*(?:custom )?(?:uniform )?[\w:\[\]]+ "
    r"(?:physics:(?:mass|centerOfMass|diagonalInertia|principalAxes)|"
    r"newton:inertia) = (?:\([^)]*\)|\[[^\]]*\]|[^\s(\[]+)[ \t]*;?\n?"
)
_NO_IDENTIFIER = re.compile(r"\W")
_INDENT = "    "


def check(robot: Robot) -> list[Finding]:
    """Return findings about numbers that single precision cannot hold."""
    # Twice the least number, chosen as a margin for rounding.
    small = [
        link.name
        for link in robot.links
        if link.inertial is not None and not link.inertial.moments[0] > 2.0 * LEAST
    ]
    findings = too_small(small, 2.0 * LEAST, "PhysicsMassAPI", TOO_SMALL_FOR_SINGLE)
    # Spherical joints have no drives.
    return findings + lost_values(
        robot, "USD", lambda joint, stated: stated if joint.is_ball else set()
    )


def write(robot: Robot, remarks: Sequence[str] = (), *, inertial_only: bool = False) -> str:
    """Return a robot as a USD layer, in meters, with a prim for each link.

    Parameters are those of `urdf.write`.
    """
    names = unique_names([link.name for link in robot.links], identifier)
    joints = unique_names([joint.name for joint in robot.joints], identifier, names.values())
    robot, frames = (robot.without_motion(), {}) if inertial_only else split_frames(robot)
    # Prims without mass stand.
    bases = {link.name: link for link in robot.roots if link.is_fixed and link.inertial is not None}
    trees = {link.name for link in robot.roots if robot.children(link.name)} | {*bases}
    is_single = len(robot.roots) == 1 and bool(trees)
    # Else each tree is an articulation of its own: by the joint of its base, or by its first link.
    own_articulation = () if is_single else ARTICULATION
    lines: list[str] = []
    for link in robot.ordered():
        inner = [] if link.inertial is None else mass_attributes(link.inertial)
        apis = () if link.inertial is None else APIS
        if not inertial_only:
            inner += _transform(link.pose)
        for count, shape in enumerate(link.shapes, start=1):
            inner += _shape(shape, names[link.name], count)
        for frame in frames.get(link.name, ()):
            place = _transform(link.pose.inverse() @ frame.pose)
            inner += _prim("def Xform", names[frame.name], place)
        if link.name in trees and link.name not in bases:
            apis = own_articulation + apis
        lines += _prim("def Xform", names[link.name], inner, apis)
    for joint in robot.joints:
        lines += _joint(robot, joint, joints[joint.name], names)
    taken = [*names.values(), *joints.values()]
    for base, name in unique_names(bases, lambda name: names[name] + "_base", taken).items():
        ends = _ends(None, names[base], bases[base].pose)
        lines += _prim("def PhysicsFixedJoint", name, ends, own_articulation)
    top = _prim("def Xform", ROOT, lines, ARTICULATION if is_single else ())
    return "\n".join([*header(robot.name, remarks, 1.0, ROOT), *top, ""])


def write_over(
    robot: Robot,
    paths: Mapping[str, Sequence[str]],
    geometry: str,
    meters_per_unit: float,
    remarks: Sequence[str] = (),
) -> str:
    """Return a layer that adds mass to the prims of another layer, and nothing else.

    paths: names of the prims from the top to each root link. geometry: the other layer's file,
    relative to this one. meters_per_unit: of the scene, whose exporter omits it. Bodies cannot
    nest: each root carries all links fixed to it.
    """
    bodies: dict[tuple[str, ...], list[str]] = {}
    joints = []
    for link in robot.roots:
        inertial = robot.rigid_inertial(link)
        if inertial is None:
            continue
        path = tuple(paths[link.name])
        bodies[path] = mass_attributes(inertial, meters_per_unit, link.scale)
        if link.is_fixed:
            pose = Pose(link.pose.position / meters_per_unit, link.pose.rotation)
            ends = _ends(None, "/".join(path), pose, top="")
            joints += _prim("def PhysicsFixedJoint", "_".join([*path, "base"]), ends)
    top = next((path[0] for path in bodies), ROOT)
    lines = header(robot.name, remarks, meters_per_unit, top, [geometry])
    # The joints stand within the last prim, before its closing brace.
    overs = _overs(bodies)
    return "\n".join([*lines, *overs[:-1], *(_INDENT + line for line in joints), *overs[-1:], ""])


def _overs(bodies: Mapping[tuple[str, ...], list[str]]) -> list[str]:
    """Return the lines of nested prims that add those of each body at its path."""
    lines = []
    for name in dict.fromkeys(path[0] for path in bodies):
        below = {path[1:]: body for path, body in bodies.items() if path[0] == name}
        body = below.pop((), [])
        lines += _prim("over", name, [*body, *_overs(below)], APIS if body else ())
    return lines


def header(
    name: str,
    remarks: Sequence[str],
    meters_per_unit: float,
    prim: str,
    sublayers: Sequence[str] = (),
) -> list[str]:
    """Return the lines before the first prim."""
    text = [MARKER.format("usd"), name, *remarks]
    doc = "\n".join(text).replace("\\", "\\\\").replace('"', '\\"')
    lines = [
        "#usda 1.0",
        "(",
        '    """{}"""'.format(doc),
        "    defaultPrim = {}".format(quoted(prim)),
        "    kilogramsPerUnit = 1",
        "    metersPerUnit = {}".format(number(meters_per_unit)),
    ]
    if sublayers:
        lines += [
            "    subLayers = [",
            *("        @{}@".format(path) for path in sublayers),
            "    ]",
        ]
    return [*lines, '    upAxis = "Z"', ")", ""]


def identifier(name: str) -> str:
    """Return the name that Blender's exporter gives the prim of an object: letters, digits and
    underscores.
    """
    name = _NO_IDENTIFIER.sub("_", name)
    return name if name.isidentifier() else "_" + name


def quoted(text: str) -> str:
    """Return a text in quotes, escaped for a layer."""
    return '"{}"'.format(text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n"))


def mass_attributes(
    inertial: Inertial, meters_per_unit: float = 1.0, scale: ArrayLike = (1.0, 1.0, 1.0)
) -> list[str]:
    """Return the lines that give a prim its mass, in units of its stage. scale: (3,) of the prim,
    for the center.
    """
    center = inertial.center / (meters_per_unit * np.asarray(scale, np.float64))
    inertia = inertial.inertia / meters_per_unit**2
    entries = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    return [
        "float physics:mass = {}".format(single(inertial.mass)),
        "point3f physics:centerOfMass = {}".format(singles(center)),
        "float3 physics:diagonalInertia = {}".format(
            singles(round_down(inertial.moments / meters_per_unit**2))
        ),
        "quatf physics:principalAxes = {}".format(singles(quaternion(inertial.axes))),
        "double[] newton:inertia = [{}]".format(", ".join(map(number, entries))),
    ]


def inertial_text(
    inertial: StatedInertial, old: str, link: StatedLink, description: Description
) -> str:
    """Return a prim's inner text `old` with the attributes of a repaired inertial instead of its
    former ones.
    """
    unit = description.scales["length"]
    mass = description.scales["mass"]
    local = np.eye(4) if link.local is None else link.local
    principal = inertial.principal()
    # The file states the center in the prim's own coordinates, and all numbers in its units.
    center = np.asarray(
        np.linalg.solve(local[:3, :3], inertial.center / unit - local[:3, 3]) * unit, np.float64
    )
    placed = Inertial(
        principal.mass / mass,
        center,
        principal.inertia / mass,
        principal.moments / mass,
        principal.axes,
    )
    # Attributes of prims below it stay.
    below = re.search(r"\n[ \t]*(?:def|over|class)\b", old)
    split = below.start() if below else len(old)
    match = re.search(r"\n([ \t]+)\S", old)
    indent = match[1] if match else _INDENT
    lines = "".join("\n" + indent + line for line in mass_attributes(placed, unit))
    return lines + _MASS_ATTRIBUTE.sub("", old[:split]) + old[split:]


def round_down(moments: NDArray) -> NDArray[np.float32]:
    """Return (3,) ascending moments in single precision, the largest one not above the sum of the
    others.
    """
    rounded = np.asarray(moments, np.float64).astype(np.float32)
    while float(rounded[2]) > float(rounded[0]) + float(rounded[1]):
        rounded[2] = np.nextafter(rounded[2], np.float32(0.0))
    return rounded


def single(value: float) -> str:
    """Return the shortest text that is read as this float32, without a negative zero."""
    if abs(value) == inf:
        return "inf" if value > 0.0 else "-inf"
    return repr(float(str(np.float32(value) + np.float32(0.0))))


def singles(values: Iterable[float]) -> str:
    """Return a tuple of single-precision numbers."""
    return "({})".format(", ".join(map(single, values)))


def _doubles(values: Iterable[float]) -> str:
    return "({})".format(", ".join(map(number, values)))


def _prim(
    kind: str, name: str, inner: Iterable[str], apis: Sequence[str] = (), reference: str = ""
) -> list[str]:
    """Return the lines of a prim with attributes and prims in it. reference: a prim that has the
    rest.
    """
    head = ["{} {}".format(kind, quoted(name))]
    if apis:
        lines = ["    prepend apiSchemas = [{}]".format(", ".join(map(quoted, apis)))]
        lines += ["    prepend references = <{}>".format(reference)] if reference else []
        head = [head[0] + " (", *lines, ")"]
    return [*head, "{", *(_INDENT + line for line in inner), "}"]


def _transform(pose: Pose, scale: Sequence[float] | None = None) -> list[str]:
    operations = ["translate", "orient"] + ["scale"] * (scale is not None)
    lines = [
        "double3 xformOp:translate = {}".format(_doubles(pose.position)),
        "quatd xformOp:orient = {}".format(_doubles(quaternion(pose.rotation))),
    ]
    if scale is not None:
        lines.append("double3 xformOp:scale = {}".format(_doubles(scale)))
    names = ", ".join(quoted("xformOp:" + operation) for operation in operations)
    return [*lines, "uniform token[] xformOpOrder = [{}]".format(names)]


_KINDS = {
    "mesh": "Mesh",
    "box": "Cube",
    "ellipsoid": "Sphere",
    "sphere": "Sphere",
    "capsule": "Capsule",
    "cylinder": "Cylinder",
}


def _geometry(shape: Shape) -> list[str]:
    """Return the lines in the prim of a shape; none for a mesh without a surface."""
    if shape.kind == "mesh":
        return [] if shape.surface is None else _mesh(shape.surface, shape.pose)
    scale = None
    if shape.kind in ("box", "ellipsoid"):
        attributes = ["double {} = 1".format("size" if shape.kind == "box" else "radius")]
        scale = shape.size
    elif shape.kind == "sphere":
        attributes = ["double radius = {}".format(number(shape.size[0]))]
    else:
        attributes = [
            "double radius = {}".format(number(shape.size[0])),
            'uniform token axis = "Z"',
            "double height = {}".format(number(shape.size[1])),
        ]
    return [*attributes, *_transform(shape.pose, scale)]


def _shape(shape: Shape, link: str, count: int) -> list[str]:
    """Return the prims of a visible shape and of a collider, a mesh's convex hull; none without
    geometry. A collider of a visible shape refers to its prim.
    """
    geometry = _geometry(shape)
    kind = "def " + _KINDS[shape.kind]
    visual = "visual_{}".format(count)
    lines = _prim(kind, visual, geometry) if shape.seen else []
    if not geometry or not shape.collides:
        return lines if geometry else []
    # Renderers skip guides.
    inner = ['uniform token purpose = "guide"', *(() if shape.seen else geometry)]
    apis = ["PhysicsCollisionAPI"]
    if shape.kind == "mesh":
        inner.append('uniform token physics:approximation = "convexHull"')
        apis.append("PhysicsMeshCollisionAPI")
    reference = "/{}/{}/{}".format(ROOT, link, visual) if shape.seen else ""
    return lines + _prim(kind, "collision_{}".format(count), inner, apis, reference)


def _mesh(surface: Surface, pose: Pose) -> list[str]:
    """Return the lines in the prim of a mesh, embedded: USD knows no files of other formats."""
    points, triangles = keep_used(surface.points, surface.all_triangles()[0])
    return [
        "point3f[] points = [{}]".format(", ".join(map(singles, points.astype(np.float32)))),
        "int[] faceVertexCounts = [{}]".format(", ".join(["3"] * len(triangles))),
        "int[] faceVertexIndices = [{}]".format(", ".join(map(str, triangles.ravel().tolist()))),
        'uniform token subdivisionScheme = "none"',
        *_transform(pose),
    ]


def _joint(robot: Robot, joint: Joint, name: str, names: dict[str, str]) -> list[str]:
    """Return the lines of a joint, general with limits if it has several degrees of freedom."""
    child = robot.link(joint.child)
    parent = robot.link(joint.parent)
    place = parent.pose.inverse() @ child.pose @ joint.pose
    turn = np.eye(3)
    apis: Sequence[str] = ()
    more: list[str] = []
    if not joint.free:
        kind = "PhysicsFixedJoint"
    elif len(joint.free) == 1:
        free = joint.free[0]
        kind = "PhysicsRevoluteJoint" if free.kind == "rotate" else "PhysicsPrismaticJoint"
        turn = along_x(free.axis)  # USD's joints move along an axis of their frames: x.
        apis, drive = _drive(free, "angular" if free.kind == "rotate" else "linear")
        more = [
            'uniform token physics:axis = "X"',
            "float physics:lowerLimit = {}".format(single(_in_degrees(free.kind, free.lower))),
            "float physics:upperLimit = {}".format(single(_in_degrees(free.kind, free.upper))),
            *drive,
        ]
    elif joint.is_ball:
        kind = "PhysicsSphericalJoint"
    else:
        kind = "PhysicsJoint"
        apis, more = _limits(joint)
    here = Pose(joint.pose.position, joint.pose.rotation @ turn)
    lines = _ends(
        names[parent.name], names[child.name], Pose(place.position, place.rotation @ turn), here
    )
    return _prim("def " + kind, name, [*lines, *more], apis)


def _ends(
    parent: str | None, child: str, place: Pose, own: Pose | None = None, top: str = "/" + ROOT
) -> list[str]:
    """Return the lines of a joint's bodies and its frames in them.

    parent: its path below `top`, None for the world. place: the frame in the parent. own: the frame
    in the child, by default the child's own.
    """
    lines = []
    for index, (body, pose) in enumerate(((parent, place), (child, own or Pose()))):
        lines += [] if body is None else ["rel physics:body{} = <{}/{}>".format(index, top, body)]
        lines.append("point3f physics:localPos{} = {}".format(index, singles(pose.position)))
        lines.append(
            "quatf physics:localRot{} = {}".format(index, singles(quaternion(pose.rotation)))
        )
    return lines


def _drive(free: FreeAxis, name: str) -> tuple[list[str], list[str]]:
    """Return API names and lines for the drive of one direction, per degree if it turns; empty if
    nothing is known.
    """
    lines = []
    for key, attribute in NAMES["USD"].items():
        if key in free.values:
            is_per_angle = free.kind == "rotate" and key != "effort"
            value = free.values[key] * (radians(1.0) if is_per_angle else 1.0)
            lines.append("float drive:{}:physics:{} = {}".format(name, attribute, single(value)))
    return ["PhysicsDriveAPI:" + name] if lines else [], lines


def _in_degrees(kind: str, value: float) -> float:
    return degrees(value) if kind == "rotate" else value


def _limits(joint: Joint) -> tuple[tuple[str, ...], list[str]]:
    """Return API names and lines for limits and drives of six directions; a locked one's lower
    limit is the higher.
    """
    limits = {"{}{}".format(kind, axis): (1.0, -1.0) for kind in ("trans", "rot") for axis in "XYZ"}
    apis = []
    lines = []
    for free in joint.free:
        axis = int(np.argmax(np.abs(free.axis)))  # Directions are axes of the joint's frame.
        is_reversed = free.axis[axis] < 0.0
        low, high = (-free.upper, -free.lower) if is_reversed else (free.lower, free.upper)
        direction = ("rot" if free.kind == "rotate" else "trans") + "XYZ"[axis]
        limits[direction] = (_in_degrees(free.kind, low), _in_degrees(free.kind, high))
        drive_apis, drive = _drive(free, direction)
        apis += drive_apis
        lines += drive
    for name, (low, high) in limits.items():
        if low == -inf and high == inf:
            continue
        apis.append("PhysicsLimitAPI:" + name)
        lines.append("float limit:{}:physics:low = {}".format(name, single(low)))
        lines.append("float limit:{}:physics:high = {}".format(name, single(high)))
    return tuple(apis), lines
