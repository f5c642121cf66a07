# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The displayed bodies, as arrays in Blender's units and world axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...blender.session.displayed import Displayed, Total, all_drawn, drawn_bone, total
from . import appearance as look

Entry = Displayed | Total  # one body, or the selection as one


@dataclass(frozen=True, eq=False)
class Bodies:
    """Displayed bodies: (n, 3) centers of mass, and (n, 3, 3) principal axes as columns.

    `gyration`: (n, 3) radii of gyration about the axes. `verdicts`: (n,) indices into `appearance.VERDICTS`.
    """

    centers: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    verdicts: NDArray[np.intp]

    @classmethod
    def of(cls, entries: Sequence[Entry], unit: float) -> Bodies:
        """Return the bodies as arrays; unit: meters per Blender unit."""
        bodies = [(one.world, one.trust) if isinstance(one, Displayed) else (one.numbers, "sum") for one in entries]
        return cls(
            np.array([numbers.center for numbers, _ in bodies]).reshape(-1, 3) / unit,
            np.array([numbers.axes for numbers, _ in bodies]).reshape(-1, 3, 3).transpose(0, 2, 1),
            np.array([numbers.gyration for numbers, _ in bodies]).reshape(-1, 3) / unit,
            np.array([look.VERDICTS.index(verdict) for _, verdict in bodies], np.intp),
        )

    def put(self, rows: list[int], bodies: Bodies) -> None:
        """Replace the bodies in these rows."""
        for name, values in vars(bodies).items():
            getattr(self, name)[rows] = values


def collect(context: Context, objects: list[Object]) -> list[Entry]:
    """Return the displayed bodies of these objects, of selected pose bones and, if enabled, of the whole selection."""
    scene = context.scene
    shown = all_drawn(objects, scene)
    shown += [drawn_bone(bone, scene) for bone in context.selected_pose_bones or ()]
    entries: list[Entry] = [body for body in shown if body is not None]
    if scene.body_moments.overlay.show_sum:
        whole = total(context)
        if whole.count > 1 and whole.numbers is not None:
            entries.append(whole)
    return entries
