# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Known values of joints and the formats that have a place for them."""

from __future__ import annotations

from collections.abc import Callable

from ...verdict.finding import Finding, finding
from ..findings import JOINT_VALUES_LOST
from ..model import Joint, Robot

# Names of values in each format, by ours. UsdPhysics and glTF have drives, others dynamics, limits and mimics.
_DRIVE = {"damping": "damping", "stiffness": "stiffness", "effort": "maxForce"}
NAMES = {
    "URDF": {name: name for name in ("damping", "friction", "effort", "velocity", "mimic")},
    "SDF": {"stiffness": "spring_stiffness", **{name: name for name in ("damping", "friction", "effort", "velocity")}},
    "MJCF": {"damping": "damping", "friction": "frictionloss", "stiffness": "stiffness", "effort": "", "mimic": ""},
    "USD": _DRIVE,
    "glTF": _DRIVE,
}


def lost_values(
    robot: Robot, form: str, more: Callable[[Joint, set[str]], set[str]] = lambda _joint, _stated: set()
) -> list[Finding]:
    """Return the finding about joints for which a format loses values, empty if it loses none.

    more: returns the names of further losses for a joint and the names of its values.
    """
    lost = {}
    for joint in robot.joints:
        stated = {name for free in joint.free for name in free.values} | ({"mimic"} if joint.mimic else set())
        lost[joint.name] = (stated - NAMES[form].keys()) | more(joint, stated)
    joints, values = [name for name, names in lost.items() if names], sorted(set().union(*lost.values()))
    return [finding(JOINT_VALUES_LOST, format=form, values=values, joints=joints)] if joints else []
