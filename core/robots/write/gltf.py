# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies in a glTF file that Blender's exporter has written: KHR_physics_rigid_bodies and
OMI_physics_body.

The nodes stay as they are; nodes of bodies get the two extensions. Blender's z up is glTF's y up:
(x, y, z) becomes (x, z, -y). Blender writes its own units as meters, whatever the scene's unit
scale, so a node above all others scales them. A body has the mass of all links that are fixed to
it; nodes without a motion of their own move with the node above.
"""

from typing import Any

import numpy as np

from ...numerics import ArrayLike, quaternion
from ...verdict import Finding, finding
from ..findings import GLTF_NODE_MISSING, GLTF_SCALED, ROBOT_SCALED, UNIT_SCALE
from ..model import Inertial, Robot

KHR, OMI = "KHR_physics_rigid_bodies", "OMI_physics_body"
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
UNIFORM_RTOL = 1e-6  # Relative; for scales that differ by float32 rounding alone.


def body_extensions(
    inertial: Inertial, scale: ArrayLike = 1.0, is_fixed: bool = False
) -> dict[str, Any]:
    """Return both extensions of a node that is a rigid body, for an inertial along Blender's axes.

    scale: meters per unit of the node's own space along Blender's axes, for the center.
    """
    values: dict[str, Any] = {
        "mass": inertial.mass,
        "centerOfMass": (Y_UP @ (inertial.center / np.asarray(scale)) + 0.0).tolist(),
    }
    if inertial.moments[0] > 0.0:  # zero would be automatic, or infinite
        w, x, y, z = quaternion(Y_UP @ inertial.axes).tolist()
        values["inertiaDiagonal"] = inertial.moments.tolist()
        values["inertiaOrientation"] = [x, y, z, w]
    kinematic = {"isKinematic": True} if is_fixed else {}
    kind = {"type": "kinematic" if is_fixed else "dynamic"}
    return {KHR: {"motion": (kinematic | values)}, OMI: {"motion": (kind | values)}}


def add_rigid_bodies(
    document: dict[str, Any], robot: Robot, meters_per_unit: float
) -> list[Finding]:
    """Add the motions of bodies to the nodes of a glTF document, and a node for its unit, in place;
    return findings.

    robot: its links have the names of nodes. meters_per_unit: unit scale of the Blender scene.
    """
    nodes = document.get("nodes", [])
    bones = {joint for skin in document.get("skins", []) for joint in skin["joints"]}
    by_name: dict[str, list[dict]] = {}
    for index, node in enumerate(nodes):
        if index not in bones and "name" in node:
            by_name.setdefault(node["name"], []).append(node)
    missing = []
    scaled = []
    written = 0
    for link in robot.roots:
        inertial = robot.rigid_inertial(link)
        found = by_name.get(link.name, [])
        if inertial is None:
            continue
        if len(found) != 1:
            missing.append(link.name)
            continue
        if np.abs(link.scale - 1.0).max() > UNIFORM_RTOL:
            scaled.append(link.name)
        found[0].setdefault("extensions", {}).update(
            body_extensions(inertial, meters_per_unit * link.scale, link.is_fixed)
        )
        written += 1
    if written:
        document["extensionsUsed"] = sorted({*document.get("extensionsUsed", []), KHR, OMI})
    findings = [finding(GLTF_NODE_MISSING, count=len(missing), links=missing)] if missing else []
    if scaled:
        findings.append(finding(ROBOT_SCALED, count=len(scaled), links=scaled))
    if meters_per_unit != 1.0:
        findings.append(finding(UNIT_SCALE, scale=meters_per_unit, cause=GLTF_SCALED))
        for scene in [scene for scene in document.get("scenes", []) if scene.get("nodes")]:
            nodes.append(
                {"name": "Meters", "scale": [meters_per_unit] * 3, "children": scene["nodes"]}
            )
            scene["nodes"] = [len(nodes) - 1]
    return findings
