# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The displayed bodies, as arrays in Blender's units and world axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...blender.session.displayed import Displayed, drawn, drawn_bone, total
from ...core.numerics.float32 import shortest_decimal
from . import appearance as look


@dataclass(frozen=True, eq=False)
class Bodies:
    """Displayed bodies: (n, 3) centers of mass, and (n, 3, 3) principal axes as columns.

    `gyration`: (n, 3) radii of gyration about the axes. `verdicts`: (n,) indices into `appearance.VERDICTS`.
    """

    centers: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    verdicts: NDArray[np.intp]


def collect(context: Context, objects: list[Object]) -> Bodies:
    """Return the displayed bodies of these objects, of selected pose bones and, if enabled, of the whole selection."""
    scene = context.scene
    shown: list[Displayed | None] = [drawn(obj, scene) for obj in objects]
    shown += [drawn_bone(bone, scene) for bone in context.selected_pose_bones or ()]
    bodies = [(body.world, body.trust) for body in shown if body is not None]
    if scene.body_moments.overlay.show_sum:
        whole = total(context)
        if whole.count > 1 and whole.numbers is not None:
            bodies.append((whole.numbers, "sum"))
    unit = shortest_decimal(scene.unit_settings.scale_length)
    return Bodies(
        np.array([numbers.center for numbers, _ in bodies]).reshape(-1, 3) / unit,
        np.array([numbers.axes for numbers, _ in bodies]).reshape(-1, 3, 3).transpose(0, 2, 1),
        np.array([numbers.gyration for numbers, _ in bodies]).reshape(-1, 3) / unit,
        np.array([look.VERDICTS.index(verdict) for _, verdict in bodies], np.intp),
    )
