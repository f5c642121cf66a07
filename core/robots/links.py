# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion of measured bodies to the links of a robot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from ..measurement.measurement import Measurement
from ..numerics.rotations import quaternion, rotation_matrix
from ..verdict.finding import Finding, finding
from .findings import ROBOT_LINKS_LEFT_OUT, ROBOT_WITHOUT_LINKS
from .model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape


class Candidate(NamedTuple):
    """A measured body. link: None if the body has no mass.

    parents: names of other candidates, the nearest first. free: its degrees of freedom relative to its parent.
    """

    name: str
    link: Link | None
    parents: Sequence[str] = ()
    free: tuple[FreeAxis, ...] = ()


def robot_name(file: str | None) -> str:
    """Return a robot's name: the file's name without its suffix, else "robot"."""
    return PurePath(file).stem if file else "robot"


def make_candidate(
    name: str,
    measurement: Measurement,
    parents: Sequence[str] = (),
    scale: Sequence[float] = (1.0, 1.0, 1.0),
    free: tuple[FreeAxis, ...] = (),
) -> Candidate:
    """Return a candidate with the measured body as a link in its own frame. scale: (3,) of the object's geometry."""
    body = measurement.in_object_frame()
    if not body.mass:
        return Candidate(name, None)
    frame = body.principal
    inertial = Inertial.with_agreeing_axes(body.mass, body.center, body.inertia, frame.moments, frame.axes)
    pose = Pose(measurement.location, rotation_matrix(quaternion(measurement.rotation)))
    shapes = () if measurement.kind == "wire" else (Shape("mesh", sheet=measurement.kind == "shell"),)
    return Candidate(name, Link(name, inertial, pose, shapes, np.array(scale)), parents, free)


def assemble_robot(name: str, candidates: Sequence[Candidate]) -> tuple[Robot, list[Finding]]:
    """Return a robot of the candidates with mass, joined to their nearest parents, and findings."""
    links = {one.name: one.link for one in candidates if one.link is not None}
    joints = []
    for one in candidates:
        parent = next((above for above in one.parents if above in links and above != one.name), None)
        if parent is not None and one.name in links:
            joints.append(Joint("{}_joint".format(one.name), parent, one.name, one.free))
    left_out = [one.name for one in candidates if one.link is None]
    findings = [finding(ROBOT_LINKS_LEFT_OUT, count=len(left_out), links=left_out)] if left_out else []
    if not links:
        findings.append(finding(ROBOT_WITHOUT_LINKS))
    return Robot(name, tuple(links.values()), tuple(joints)), findings
