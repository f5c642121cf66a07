# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes a measured object a link of a robot: where it stands, and what it hangs on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import bpy
import numpy as np

from ...core.measurement import Measurement
from ...core.mesh.surface import Surface, join_surfaces
from ...core.numerics.rotations import polar_rotation, quaternion
from ...core.robots.model import Pose
from ...core.verdict.finding import MeasureError
from .objects import read_object
from .reading import float64_matrix


def link_entry(
    obj: bpy.types.Object,
    measurement: Measurement,
    labels: Mapping[bpy.types.Object, str],
    free: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """Return the entry `link` of an object's record.

    Parameters
    ----------
    obj : Object
    measurement : Measurement
        Its own; the link's frame is the object's.
    labels : mapping of Object to str
        The names of the records of all that may be links.
    free : sequence of mapping
        How it may move in its parent: "kind", "axis" (its own), "lower" and "upper" of each degree of freedom, None for
        no limit.

    Returns
    -------
    dict
        "position" (m) and "rotation" (w, x, y, z) in the world; "scale" of the object's own geometry; "parents", the
        nearest first; "free" where it may move.
    """
    parents, above = [], obj.parent
    while above is not None:
        parents += [labels[above]] if above in labels else []
        above = above.parent
    return {
        "position": measurement.location.tolist(),
        "rotation": quaternion(measurement.rotation).tolist(),
        "scale": list(obj.matrix_world.to_scale()),
        "parents": parents,
        **({"free": [dict(axis) for axis in free]} if free else {}),
    }


def link_surface(
    objects: Iterable[bpy.types.Object], depsgraph: bpy.types.Depsgraph, pose: Pose, unit: float
) -> Surface | None:
    """Return what the objects of a link show as triangles in meters, in the link's frame; None where they show no
    faces.

    Parameters
    ----------
    objects : iterable of Object
    depsgraph : Depsgraph
    pose : Pose
        Of the link in the world, m.
    unit : float
        Meters per Blender unit.

    Returns
    -------
    Surface or None
    """
    pieces, to_link = [], pose.inverse()
    for obj in objects:
        try:
            surface = read_object(obj, depsgraph, edges=False).join()
        except MeasureError:  # such as a grid of densities
            continue
        pieces.append(surface.transform(unit * to_link.rotation, to_link.position))
    return join_surfaces(pieces) if len(pieces) > 1 else pieces[0] if pieces else None


def sheared_objects(objects: Iterable[bpy.types.Object]) -> list[str]:
    """Return the names of objects whose matrix does more than move, turn, scale and mirror."""
    located = list(objects)
    if not located:
        return []
    _, sheared = polar_rotation(np.array([float64_matrix(obj.matrix_world) for obj in located]))
    return [obj.name_full for obj, skew in zip(located, sheared) if skew]


USD_ROOT = "root"  # what Blender's exporter puts everything under


def usd_path(obj: bpy.types.Object, identifier: Callable[[str], str]) -> list[str]:
    """Return the names of the prims from the top to an object's, in what Blender's exporter writes.

    Parameters
    ----------
    obj : Object
    identifier : callable
        Makes the name of a prim of an object's.

    Returns
    -------
    list of str
    """
    names, above = [], obj
    while above is not None:
        names.append(identifier(above.name))
        above = above.parent
    return [USD_ROOT, *reversed(names)]
