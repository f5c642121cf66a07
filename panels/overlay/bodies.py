# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bodies are drawn, as arrays in Blender's units and world axes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...core.numerics.float32 import shortest_decimal
from ...operators.session import live, posed, results
from ...operators.session.shown import shown_body, shown_bone
from . import appearance as look


@dataclass(frozen=True, eq=False)
class Bodies:
    """Bodies that are drawn.

    Attributes
    ----------
    centers : (n, 3) array
        Centers of mass.
    axes : (n, 3, 3) array
        Principal axes as columns.
    gyration : (n, 3) array
        Radii of gyration about them.
    verdicts : (n,) integer array
        Indices into `appearance.VERDICTS`.
    """

    centers: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    verdicts: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.centers)


def drawn_objects(context: Context, show_all: bool) -> Iterator[Object]:
    """The objects whose numbers are drawn in a view: visible and, if not all, selected. In Pose Mode an armature stands
    for its meshes."""
    layer, space = context.view_layer, context.space_data
    for obj in layer.objects if show_all else layer.objects.selected:
        has_numbers = "body_mass" in obj or live.is_live(obj) or posed.stands_for_meshes(obj)
        if has_numbers and obj.visible_in_viewport_get(space):
            yield obj


def collect(context: Context) -> Bodies:
    """Gather what is shown of the objects, of the selected pose bones, and of the selection as one body where that is
    switched on."""
    scene = context.scene
    settings = scene.body_moments.overlay
    bodies = []
    for obj in drawn_objects(context, settings.show_all):
        body = shown_body(obj)
        if body is not None:
            bodies.append((body.center, body.axes, body.gyration, look.VERDICTS.index(body.verdict)))
    for bone in context.selected_pose_bones or ():
        body = shown_bone(bone, scene)
        if body is not None:
            bodies.append((body.center, body.axes, body.gyration, look.VERDICTS.index(body.verdict)))
    if settings.show_sum:
        total = results.total(context)
        if total.count > 1 and total.body is not None:
            unit = shortest_decimal(scene.unit_settings.scale_length)
            body = total.body
            bodies.append(
                (body.center / unit, body.principal.axes, body.radii_of_gyration / unit, look.VERDICTS.index("sum"))
            )
    if not bodies:
        return Bodies(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros(0, np.intp))
    return Bodies(*(np.array(values) for values in zip(*bodies)))
