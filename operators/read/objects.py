# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An object as a Reading: what the viewport shows of it, and in words every decision taken.

Reading changes nothing: no mode, no selection, no mesh. An object that Blender has not evaluated is
refused with the reason, never read without its modifiers (visibility.py). The object frame is
`matrix_world.decompose()`.
"""

from __future__ import annotations

import numpy as np

from ...core.mesh.surface import Surface
from ...core.numerics.rotations import rotation_matrix
from .curves import read_curves
from .decisions import decisions, why_empty
from .deformation import is_deformed
from .instances import Gathered
from .reading import Part, Reading, Unreadable, float64_matrix
from .splines import spline_reading, weightless
from .visibility import NOT_EVALUATED, evaluated_geometry, hidden_reason, require_kind


def read_object(
    obj, depsgraph, *, materials: bool = False, attribute: str | None = None, edges: bool = True
) -> Reading:
    """Read one object, original or evaluated, as the up-to-date viewport `depsgraph` has it.

    materials: with the materials of its faces. attribute: with the values of a float attribute on its
    vertices. edges: with what proves surfaces closed.

    Raises Unreadable with the reason and the remedy: of a kind without surface, not evaluated,
    nothing with a face, coordinates or transforms that are not finite.
    """
    obj = obj.original
    require_kind(obj)
    reading = placed(obj, depsgraph)
    gathered = Gathered(obj.evaluated_get(depsgraph), depsgraph, materials, attribute, edges)
    gathered.gather()
    parts = gathered.parts()
    if not parts:
        raise Unreadable(obj.name, why_empty(obj, gathered, depsgraph))
    for part in parts:
        _require_finite(obj, part.surface)
    reading.parts, reading.warnings = parts, list(decisions(obj, gathered, depsgraph))
    return reading


def read_lines(obj, depsgraph) -> Reading:
    """As `read_object` for a curve object, but its curves instead of the surface that it may show.

    Raises Unreadable for objects of other kinds too.
    """
    obj = obj.original
    if obj.type != "CURVE":
        raise Unreadable(obj.name, "Only a curve can be a wire; measure it as a solid or a shell.")
    reading = placed(obj, depsgraph)
    reading.curves, reading.warnings = read_curves(obj, depsgraph)
    return reading


def read_patches(obj, depsgraph) -> Reading | None:
    """As `read_object` for a surface object, but its patches alone: no display mesh, unless control points have to be
    compared with it, and no word about the render. None where it shows more, or has to be measured by its mesh.
    """
    obj = obj.original
    reading = placed(obj, depsgraph)
    if obj.type != "SURFACE" or obj.instance_type != "NONE" or len(obj.particle_systems):
        return None
    geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    evaluated = obj.evaluated_get(depsgraph)
    splines = spline_reading(evaluated, depsgraph, geometry.mesh if is_deformed(evaluated) else None)
    if splines is None:
        return None
    nothing = Surface(np.zeros((0, 3), np.float32))
    reading.parts = [Part(nothing, reading.matrix[None], splines=splines)]
    return reading


def placed(obj, depsgraph) -> Reading:
    """An evaluated object's name and place, with nothing read of it yet.

    Raises Unreadable where Blender has not evaluated it, or its transform is not finite.
    """
    evaluated = obj.evaluated_get(depsgraph)
    if not evaluated.is_evaluated:
        raise Unreadable(obj.name, hidden_reason(obj, depsgraph) or NOT_EVALUATED)
    matrix = float64_matrix(evaluated.matrix_world)
    if not np.isfinite(matrix).all():
        raise Unreadable(
            obj.name,
            "Its transform is not finite; reset its location, rotation and scale, or its parent's.",
        )
    location, rotation, _scale = evaluated.matrix_world.decompose()
    return Reading(
        name=obj.name,
        type=obj.type,
        matrix=matrix,
        rotation=rotation_matrix(rotation),
        location=np.array(location[:], np.float64),
    )


def _require_finite(obj, surface: Surface) -> None:
    if np.isfinite(surface.box).all():
        return
    points = surface.points
    count = int((~np.isfinite(points).all(axis=1)).sum())
    weights = weightless(obj.data.splines) if obj.type == "SURFACE" else 0
    if weights:
        raise Unreadable(
            obj.name,
            "Weights of its control points ({:d}) are not positive, so that it reaches infinity; raise them above "
            "zero.".format(weights),
        )
    raise Unreadable(
        obj.name,
        "{:d} of its {:d} vertices have coordinates that are not finite; delete them, or mend the "
        "modifier, driver or import that made them.".format(count, len(points)),
    )
