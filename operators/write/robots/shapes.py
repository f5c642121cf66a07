# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links that look like, and collide as, the primitive of their inertia."""

from __future__ import annotations

from dataclasses import replace

from ....core.robots.model import Robot
from ....core.robots.primitives import equal_inertia_shape


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
