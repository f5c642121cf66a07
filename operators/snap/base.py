# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the snapping operators."""

from __future__ import annotations

from bpy.props import BoolProperty
from bpy.types import Context, Operator

from ...blender import scene, session
from ...blender.write import reports
from .. import selection

STRICT_PROPERTY = BoolProperty(
    name="Zhang and Chen's Rule",
    description=(
        "Take axes 1 and 2 in the direction of positive third moments, as in the paper. Objects for which "
        "the rule is undefined, such as most symmetric ones, are left unchanged"
    ),
    default=False,
)


def reframe_selected(
    operator: Operator, context: Context, along_axes: bool, done: tuple[str, str], strict: bool = False
) -> set[str]:
    """Give each selected object an origin at its center of mass while nothing visible moves, and report it.

    along_axes: the axes too become principal ones. done: the report, for one object and for `count` of them.
    """
    objects = selection.selected_measurable(context)
    target_matrix = scene.matrix_along_axes if along_axes else scene.matrix_at_center
    changed, failures = session.reframe_objects(context, objects, target_matrix, not along_axes, strict)
    findings = [found.of_sources([plan.obj.name]) for plan in changed for found in plan.findings]
    text, idle = reports.phrase(*done, count=len(changed)), reports.phrase("already in place")
    return selection.summarize(operator, len(changed), len(objects), text, failures, findings, idle)
