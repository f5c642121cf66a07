# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random bodies as links: boxes and balls, sheared and turned; thin plates, rods, all but equal
moments.
"""

import numpy as np
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.robots.model import (
    FreeAxis,
    Inertial,
    Joint,
    Link,
    Pose,
    Robot,
    Shape,
    combine_inertials,
)

from tests.core.bodies import box, sphere


def rotation(rng):
    """A random rotation: the QR factors of a random matrix, made proper."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


def inertial(points, triangles, density=1000.0):
    """Return the measured inertial of the body along the link's axes."""
    body = MassProperties.from_moments(
        polyhedron_moments(Surface.from_triangles(points, triangles))[0], density
    )
    frame = body.principal
    return Inertial.with_agreeing_axes(
        body.mass, body.center, body.inertia, frame.moments, frame.axes
    )


def shaped(rng, kind):
    """(points, triangles) of one random body."""
    points, triangles = sphere(1) if kind == "ball" else box((-1, -1, -1), (1, 1, 1))
    sides = {
        "plate": [1.0, rng.uniform(0.3, 1.0), 10.0 ** rng.uniform(-9, -3)],
        "rod": [1.0, 10.0 ** rng.uniform(-4, -2), 10.0 ** rng.uniform(-4, -2)],
        "square": [1.0, 1.0, 10.0 ** rng.uniform(-9, -3)],
        "ball": [1.0, 1.0, 1.0 + rng.choice([0.0, 1e-15, 1e-9, 1e-3])],
    }.get(kind, rng.uniform(0.2, 1.0, 3))
    stretch = rotation(rng) * np.asarray(sides)
    if kind == "sheared":
        stretch = stretch @ (np.eye(3) + np.triu(rng.uniform(-0.5, 0.5, (3, 3)), 1))
    size = 10.0 ** rng.uniform(-2, 1)
    return points @ (size * stretch).T + size * rng.normal(size=3), triangles


KINDS = ("plate", "rod", "square", "ball", "box", "sheared")


def bodies(count, seed=17, chain=False, away=False):
    """A robot of that many separate bodies, or of one chain with all kinds of joints, at the
    children or `away`.
    """
    rng = np.random.default_rng(seed)
    links, joints = [], []
    for index in range(count):
        name = "body {}".format(index)
        pose = Pose(rng.normal(size=3) * 3.0, rotation(rng))
        links.append(Link(name, inertial(*shaped(rng, KINDS[index % len(KINDS)])), pose))
        if chain and index:
            place = Pose(rng.normal(size=3), rotation(rng)) if away else Pose()
            parent = "body {}".format(index - 1)
            joints.append(
                Joint("joint {}".format(index), parent, name, free_axes(rng, index), place)
            )
    return Robot("test", tuple(links), tuple(joints))


def assembly(seed, count=12):
    """A random tree of bodies with their meshes, half of its joints fixed, the others of any kind
    and away from the links' origins; the root is fixed if the seed is odd.
    """
    rng = np.random.default_rng(seed)
    links, joints = [], []
    for name in "abcdefghijkl"[:count]:
        points, triangles = shaped(rng, KINDS[rng.integers(6)])
        mesh = Shape("mesh", surface=Surface.from_triangles(points, triangles))
        pose = Pose(rng.normal(size=3), rotation(rng))
        if links:
            parent = links[rng.integers(len(links))].name
            piston = (FreeAxis("translate", np.eye(3)[2], -0.25, 0.5),)
            piston += (FreeAxis("rotate", np.eye(3)[2]),)
            kinds = [(), piston, *(free_axes(rng, index) for index in range(1, 6))]
            free = kinds[rng.integers(7)] if rng.integers(2) else ()
            place = Pose(rng.normal(size=3), rotation(rng))
            joints.append(Joint("to " + name, parent, name, free, place))
        links.append(Link(name, inertial(points, triangles), pose, (mesh,)))
    robot = Robot("random", tuple(links), tuple(joints))
    return robot.with_fixed_roots() if seed % 2 else robot


def total(robot, in_root=False):
    """Return the truth about a whole robot, in the world or in the frame of its root."""
    start = robot.roots[0].pose.inverse() if in_root else Pose()
    return combine_inertials([one.inertial.place(start @ one.pose) for one in robot.links])


def free_axes(rng, index):
    """Fixed, hinge, slide, hinge without limits, ball, two hinges with limits, in turns."""
    x, y, z = np.eye(3)
    unit = rotation(rng)[0]
    return (
        (),
        (FreeAxis("rotate", unit, -0.5, 1.25),),
        (FreeAxis("translate", unit, -0.25, 0.75),),
        (FreeAxis("rotate", unit),),
        tuple(FreeAxis("rotate", axis) for axis in (x, y, z)),
        (FreeAxis("rotate", z, -1.0, 1.0), FreeAxis("rotate", x, -0.5, 0.25)),
    )[index % 6]


def shapes(pose):
    """One of each primitive."""
    sizes = {
        "box": (1.0, 2.0, 3.0),
        "sphere": (0.5,),
        "capsule": (0.25, 1.0),
        "cylinder": (0.25, 2.0),
    }
    return (
        *(Shape(kind, size, pose) for kind, size in sizes.items()),
        Shape("ellipsoid", (1.0, 2.0, 3.0), pose),
    )


def near(found, truth, rel=1e-14, scale=None):
    """Return whether all entries are within `rel` of the largest true entry, or of `scale`."""
    found, truth = np.asarray(found, float), np.asarray(truth, float)
    return np.abs(found - truth).max() <= rel * (np.abs(truth).max() if scale is None else scale)
