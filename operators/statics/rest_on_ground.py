# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Rest on Ground: turn an object the least so that it lies on the ground in a stable pose."""

from __future__ import annotations

import numpy as np
from bpy.props import EnumProperty, IntProperty
from bpy.types import Context, Object, Operator
from numpy.typing import NDArray

from ...blender.scene import reframe
from ...blender.scene.transforms import world
from ...blender.session.displayed import drawn
from ...blender.session.stored import stability
from ...blender.session.tracking import staleness
from ...blender.write.translations import localized
from ...core.statics.findings import NO_STABLE_POSE
from ...core.statics.resting import RestingPoses
from ...core.verdict.finding import EditRefusedError, Finding, finding
from .. import selection
from ..findings import ALREADY_ON_GROUND, LAID_ON_GROUND
from ..snap import base as snapping
from .stability import check_stability


class OBJECT_OT_body_moments_rest_on_ground(Operator):
    """Lay the selected objects on the ground in a pose in which they stay."""

    bl_idname = "object.body_moments_rest_on_ground"
    bl_label = "Rest on Ground"
    bl_description = (
        "Lay the selected objects on the ground in a stable pose, the likeliest or another one. They turn by the "
        "smallest angle about the center of mass, which stays above the same point"
    )
    bl_options = {"REGISTER", "UNDO"}

    pose: IntProperty(
        name="Pose",
        description="Stable pose, the likeliest first. 0 for the one that is reached by the smallest turn",
        default=1,
        min=0,
        soft_max=12,
    )
    ground: EnumProperty(
        name="Ground",
        description="Height of the ground",
        items=(
            ("FLOOR", "Floor", "The world origin, the floor of the viewport"),
            ("CURSOR", "3D Cursor", "The 3D cursor"),
            ("LOWEST", "Lowest Point", "The lowest point of each object as it is"),
        ),
        default="FLOOR",
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context)

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "pose")
        poses = stability.poses(context.object) if context.object is not None else None
        if isinstance(poses, RestingPoses):
            self._draw_pose(poses)
        layout.prop(self, "ground")

    def _draw_pose(self, poses: RestingPoses) -> None:
        count = len(poses.shares)
        layout = self.layout
        if self.pose:
            place = (self.pose - 1) % count
            text = localized("Pose {:d} of {:d}: {:.1f}%, tips at {:.1f}°")
            text = text.format(place + 1, count, 100.0 * poses.shares[place], np.degrees(poses.tipping_angles[place]))
            layout.label(text=text, translate=False)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        findings: list[Finding] = []
        # one after the other, for a child moves with its parent
        moved, failures = selection.apply_to_all(objects, lambda obj: self._lay(context, obj, findings))
        snapping.remeasure(context, moved)
        done = finding(LAID_ON_GROUND, count=len(moved))
        idle = finding(ALREADY_ON_GROUND)
        return selection.summarize(self, len(moved), len(objects), done, failures, findings, idle)

    def _lay(self, context: Context, obj: Object, findings: list[Finding]) -> bool:
        """Lay the object on the ground, and return whether it had to be moved."""
        reframe.check_movable(obj)
        measured: list[Object] = []
        findings.extend(check_stability(context, obj, measured))
        staleness.mark_up_to_date(context, measured)
        poses, body = stability.poses(obj, context.scene), drawn(obj, context.scene)
        if poses is None:  # its stored numbers are damaged
            raise EditRefusedError(NO_STABLE_POSE)
        if isinstance(poses, Finding):
            raise EditRefusedError(poses.code, **poses.values)
        assert body is not None  # the poses belong to it
        down = stability.down(context.scene)
        _, rotation = stability.frame(obj)
        normals = poses.normals @ rotation.T
        place = (self.pose - 1) % len(normals) if self.pose else int((normals @ down).argmax())
        turn = shortest_turn(normals[place], down)
        center, size = np.array(body.world.center) / body.unit, max(body.world.gyration) / body.unit
        target = world(obj)
        target[:3, :3] = turn @ target[:3, :3]
        target[:3, 3] = center + turn @ (target[:3, 3] - center)
        target[:3, 3] += (self._ground(context, obj, center, down) - poses.heights[place]) * down
        off = np.abs(target - world(obj))
        is_turned = off[:, :3].max() > 1e-6 * np.abs(target[:, :3]).max()
        is_moved = is_turned or off[:, 3].max() > reframe.location_tolerance(obj, size)
        if is_moved:
            reframe.move(context, reframe.Plan(obj, target, size, move_only=False))
        return bool(is_moved)

    def _ground(self, context: Context, obj: Object, center: NDArray, down: NDArray) -> float:
        """Return the distance of the ground below the center."""
        if self.ground == "LOWEST":
            support = stability.support(obj, context.scene)
            assert support is not None  # it is known as its poses are
            return support.height
        point = np.array(context.scene.cursor.location, np.float64) if self.ground == "CURSOR" else np.zeros(3)
        return float((point - center) @ down)


def shortest_turn(start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (3, 3) rotation by the smallest angle that takes one (3,) unit vector to another.

    For opposite vectors it is a half turn about an axis across them.
    """
    middle = start + end
    length = np.linalg.norm(middle)
    if length < 1e-8:
        across = np.eye(3)[np.argmin(np.abs(start))]
        middle = across - (across @ start) * start
        length = np.linalg.norm(middle)
        middle /= length
        return 2.0 * np.outer(middle, middle) - np.eye(3)
    middle /= length
    # Two half turns: about `start`, then about the direction between the two.
    return (2.0 * np.outer(middle, middle) - np.eye(3)) @ (2.0 * np.outer(start, start) - np.eye(3))


CLASSES = (OBJECT_OT_body_moments_rest_on_ground,)
