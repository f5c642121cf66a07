# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn of measured objects: where their mass is now, and how far that is to be trusted.

A viewport is drawn at every movement of the mouse, so the answer is kept until Blender reports a change.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Object, Scene
from numpy.typing import NDArray

from ...core.numerics.float32 import shortest_decimal
from . import handlers, results
from .cache import SessionCache
from .trust import Trust, trust


@dataclass(frozen=True, eq=False)
class ShownBody:
    """A measured object as it is drawn: world axes, lengths in Blender units.

    Attributes
    ----------
    center : (3,) array
        The center of mass.
    axes : (3, 3) array
        The principal axes as columns, of the least moment first.
    gyration : (3,) array
        The radii of gyration about them.
    mass : float
        In kg.
    verdict : Trust
    """

    center: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    mass: float
    verdict: Trust


_shown: SessionCache[tuple[tuple, ShownBody | None]] = SessionCache()  # and after which change of which scene


def shown_body(obj: Object, scene: Scene | None = None) -> ShownBody | None:
    """Return what is to be drawn of an object: its live numbers where Live is on, else the stored ones.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object.
    scene : bpy.types.Scene, optional
        The scene that it is drawn in, by default the context's.

    Returns
    -------
    ShownBody or None
        None where it has no numbers.
    """
    scene = scene or bpy.context.scene
    key = (handlers.generation(), scene.session_uid)
    cached = _shown.get(obj)
    if cached is None or cached[0] != key:
        cached = _shown[obj] = (key, _shown_now(obj, scene))
    return cached[1]


def _shown_now(obj: Object, scene: Scene) -> ShownBody | None:
    stored = results.in_world(obj, scene)
    if stored is None or not stored.body.mass > 0.0:
        return None
    body, unit = stored.body, shortest_decimal(scene.unit_settings.scale_length)
    return ShownBody(
        body.center / unit, body.principal.axes, body.radii_of_gyration / unit, body.mass, trust(obj, scene)
    )
