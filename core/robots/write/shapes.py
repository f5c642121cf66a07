# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Visual and collision shapes of links: their meshes, the primitives of their inertia, or
nothing.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import sqrt

import numpy as np

from ...mesh import Surface
from ...verdict import Finding, finding
from ..findings import ROBOT_ELLIPSOID_AS_BOX, ROBOT_LINKS_BARE
from ..model import Link, Pose, Robot, Shape
from ..primitives import equal_inertia_shape, moments_of
from .text import number, numbers

# Sides s over semi-axes a at equal mass and inertia: a mean square of s²/12 = a²/5 along each axis.
BOX_OF_ELLIPSOID = 2.0 * sqrt(3.0 / 5.0)


def box_of_ellipsoid(shape: Shape) -> Shape:
    """Return the box with the inertia of an ellipsoid; other shapes as they are."""
    if shape.kind != "ellipsoid":
        return shape
    return Shape("box", tuple(BOX_OF_ELLIPSOID * axis for axis in shape.size), shape.pose)


def capsule_pieces(shape: Shape) -> list[Shape]:
    """Return a cylinder and two spheres for a capsule; other shapes as they are."""
    if shape.kind != "capsule":
        return [shape]
    radius, length = shape.size
    ends = [shape.pose @ Pose(np.array([0.0, 0.0, side * length / 2.0])) for side in (-1.0, 1.0)]
    return [
        Shape("cylinder", shape.size, shape.pose),
        *(Shape("sphere", (radius,), end) for end in ends),
    ]


def ellipsoids_as_boxes(robot: Robot) -> list[Finding]:
    """Return the finding about a robot's ellipsoids for a format without them, empty if it has
    none.
    """
    names = [
        link.name for link in robot.links if any(shape.kind == "ellipsoid" for shape in link.shapes)
    ]
    return [finding(ROBOT_ELLIPSOID_AS_BOX, count=len(names), links=names)] if names else []


def shape_values(shape: Shape) -> dict[str, str]:
    """Return the names and texts of a shape's lengths in URDF and SDF; of a mesh its scale, unless
    it is 1.
    """
    if shape.kind == "mesh":
        return {"scale": numbers(shape.size)} if shape.size != (1.0, 1.0, 1.0) else {}
    if shape.kind in ("box", "ellipsoid"):
        return {"size" if shape.kind == "box" else "radii": numbers(shape.size)}
    return {name: number(value) for name, value in zip(("radius", "length"), shape.size)}


def with_meshes(
    robot: Robot, surface_of: Callable[[str], Surface | None]
) -> tuple[Robot, list[Finding]]:
    """Return a robot with the surface of each link (in m, along its axes), and a finding about
    links without one.

    Colliders have their own surfaces.
    """
    links, bare = [], []
    for link in robot.links:
        surface = surface_of(link.name) if link.shapes else None
        shown = surface is not None and len(surface.all_triangles()[0])
        shapes = [replace(shape, surface=surface) if shape.seen else shape for shape in link.shapes]
        links.append(
            replace(link, shapes=tuple(shape for shape in shapes if shown or not shape.seen))
        )
        bare += [] if shown else [link.name]
    findings = [finding(ROBOT_LINKS_BARE, count=len(bare), links=bare)] if bare else []
    return replace(robot, links=tuple(links)), findings


def without_collision(robot: Robot) -> Robot:
    """Return a robot whose shapes are only seen."""
    return _with_shapes(
        robot, lambda link: [replace(shape, collides=False) for shape in link.shapes if shape.seen]
    )


def with_colliders(robot: Robot, colliders_of: Callable[[Link], Sequence[Shape]]) -> Robot:
    """Return a robot whose links collide as their colliders, shapes in the links' frames, if they
    have any.
    """

    def shapes_of(link: Link) -> Sequence[Shape]:
        colliders = [replace(shape, seen=False) for shape in colliders_of(link)]
        return (
            [*(replace(shape, collides=False) for shape in link.shapes), *colliders]
            if colliders
            else link.shapes
        )

    return _with_shapes(robot, shapes_of)


def with_masses(robot: Robot) -> Robot:
    """Return a robot whose colliders, or else drawn shapes, have masses that add up to their
    link's.

    Known masses are scaled; unknown ones are in proportion to the volumes.
    """

    def shapes_of(link: Link) -> Sequence[Shape]:
        colliders = [shape for shape in link.shapes if shape.collides and not shape.sheet]
        heavy = colliders or [shape for shape in link.shapes if shape.seen]
        if link.inertial is None:
            return link.shapes
        mass = link.inertial.mass
        shares = np.array([shape.mass for shape in heavy])
        if not (shares > 0.0).any():
            # Volumes, at the density 1; equal shares if one is unknown.
            is_known = all(shape.kind != "mesh" or shape.surface for shape in heavy)
            shares = np.array([moments_of(shape).raw[0] if is_known else 1.0 for shape in heavy])
        if not shares.sum() > 0.0 or (shares < 0.0).any():
            shares = np.ones(len(heavy))
        masses = dict(zip(map(id, heavy), (mass * shares / shares.sum()).tolist()))
        return [replace(shape, mass=masses.get(id(shape), 0.0)) for shape in link.shapes]

    return _with_shapes(robot, shapes_of)


def with_primitives(robot: Robot, kind: str) -> Robot:
    """Return a robot with a "box", "ellipsoid", "capsule" or no shape ("none") as each link's
    geometry.
    """
    return _with_shapes(
        robot,
        lambda link: (
            ()
            if kind == "none" or link.inertial is None
            else (equal_inertia_shape(link.inertial, kind),)
        ),
    )


def _with_shapes(robot: Robot, shapes_of: Callable[[Link], Sequence[Shape]]) -> Robot:
    return replace(
        robot, links=tuple(replace(link, shapes=tuple(shapes_of(link))) for link in robot.links)
    )
