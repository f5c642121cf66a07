# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links that look like, and collide as, the primitive of their inertia."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

from ....core.robots.model import Robot, Shape
from ....core.robots.primitives import equal_inertia_shape
from ....core.verdict.finding import Finding, finding

BOX_OF_ELLIPSOID = 2.0 * sqrt(3.0 / 5.0)  # sides over semi-axes at equal mass and inertia


def box_of_ellipsoid(shape: Shape) -> Shape:
    """Return the box with the inertia of an ellipsoid; other shapes as they are."""
    if shape.kind != "ellipsoid":
        return shape
    return Shape("box", tuple(BOX_OF_ELLIPSOID * axis for axis in shape.size), shape.pose)


def ellipsoids_as_boxes(robot: Robot) -> list[Finding]:
    """Return what a format without ellipsoids says of a robot that has some."""
    names = [link.name for link in robot.links if any(shape.kind == "ellipsoid" for shape in link.shapes)]
    return [finding("robot_ellipsoid_as_box", count=len(names), links=names)] if names else []


def with_primitives(robot: Robot, kind: str) -> Robot:
    """Return a robot whose links have a primitive each in the place of their geometry.

    Parameters
    ----------
    robot : Robot
    kind : str
        "box", "ellipsoid", "capsule", or "none" for no geometry.

    Returns
    -------
    Robot
    """
    links = [
        replace(
            link,
            shapes=() if kind == "none" or link.inertial is None else (equal_inertia_shape(link.inertial, kind),),
        )
        for link in robot.links
    ]
    return replace(robot, links=tuple(links))
