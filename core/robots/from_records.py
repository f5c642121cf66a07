# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of measured objects become the links of a robot.

A record has its numbers along the object's axes (frame "object") and an entry `link`, as `blender/read/robots.py`
makes it: the object's place, parent and freedom of motion. So any object with a record can be a link.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from pathlib import PurePath
from typing import Any

import numpy as np

from ..measurement.measurement import Measurement
from ..numerics.rotations import rotation_matrix
from ..verdict.finding import Finding, finding
from .findings import ROBOT_LINKS_LEFT_OUT, ROBOT_WITHOUT_LINKS
from .model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape

DEFAULT_NAME = "robot"


def robot_name(file: str | None) -> str:
    """Return the name of a file's robot."""
    return PurePath(file).stem if file else DEFAULT_NAME


def robot_of_records(name: str, records: Sequence[Mapping[str, Any]]) -> tuple[Robot, list[Finding]]:
    """Return records with an entry `link`, in the frame "object", as a robot, and findings about omitted ones."""
    usable = {record["name"]: record for record in records if record.get("link") and record["mass"]}
    links = [_link(record) for record in usable.values()]
    joints = []
    for label, record in usable.items():
        parent = next((above for above in record["link"]["parents"] if above in usable and above != label), None)
        if parent is not None:
            joints.append(Joint("{}_joint".format(label), parent, label, _free(record["link"].get("free", ()))))
    left_out = [record["name"] for record in records if record["name"] not in usable]
    findings = [finding(ROBOT_LINKS_LEFT_OUT, count=len(left_out), links=left_out)] if left_out else []
    if not usable:
        findings.append(finding(ROBOT_WITHOUT_LINKS))
    return Robot(name, tuple(links), tuple(joints)), findings


def brief_record(name: str, measurement: Measurement, link: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of a record that a link needs, in the frame "object", from the measurement itself."""
    body = measurement.in_object_frame()
    return {
        "name": name,
        "type": measurement.type,
        "kind": measurement.kind,
        "mass": body.mass,
        "center_of_mass": body.center,
        "inertia": body.inertia,
        "principal_moments": body.principal.moments,
        "principal_axes": body.principal.axes,
        "link": link,
    }


def _link(record: Mapping[str, Any]) -> Link:
    place = record["link"]
    inertial = Inertial.with_agreeing_axes(
        record["mass"],
        np.array(record["center_of_mass"]),
        np.array(record["inertia"]),
        np.array(record["principal_moments"]),
        np.array(record["principal_axes"]),
    )
    pose = Pose(np.array(place["position"]), rotation_matrix(place["rotation"]))
    shapes = () if record["kind"] == "wire" else (Shape("mesh", sheet=record["kind"] == "shell"),)
    return Link(record["name"], inertial, pose, shapes, np.array(place["scale"]))


def _free(axes: Iterable[Mapping[str, Any]]) -> tuple[FreeAxis, ...]:
    return tuple(
        FreeAxis(
            axis["kind"],
            np.array(axis["axis"], np.float64),
            -inf if axis["lower"] is None else axis["lower"],
            inf if axis["upper"] is None else axis["upper"],
        )
        for axis in axes
    )
