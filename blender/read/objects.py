# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""An object as a Reading: its surfaces in the viewport, and a finding for each decision.

Reading changes nothing. An object that Blender has not evaluated is refused, never read without its
modifiers.
"""

import numpy as np

from ...core.bodies import Part, Reading, attribute_to_source
from ...core.mesh import Surface
from ...core.numerics import NDArray, rotation_matrix
from ...core.nurbs import CONTROL_POINTS_INVALID, NON_POSITIVE_WEIGHTS
from ...core.solid import NON_FINITE_VERTICES
from ...core.verdict import ReadError, finding
from .curves import read_curves
from .decisions import reading_findings, why_empty
from .findings import NON_FINITE_TRANSFORM, ONLY_CURVES_ARE_WIRES
from .instances import InstanceCollector
from .places import has_places, world_matrices
from .splines import is_deformed, nonpositive_weights, spline_reading
from .visibility import evaluated_geometry, require_kind, why_not_evaluated


def read_object(
    obj, depsgraph, *, materials: bool = False, attribute: str | None = None, edges: bool = True
) -> Reading:
    """Read an object, original or evaluated, as it is in the up-to-date viewport `depsgraph`, or
    raise ReadError.

    materials: read the materials of its faces, too. attribute: name of a float attribute on
    vertices to read. edges: read the edges that prove surfaces closed.
    """
    obj = obj.original
    require_kind(obj)
    reading = locate(obj, depsgraph)
    evaluated = obj.evaluated_get(depsgraph)
    gathered = InstanceCollector(evaluated, depsgraph, materials, attribute, edges)
    gathered.collect()
    parts = gathered.parts()
    if not parts:
        raise ReadError(why_empty(obj, gathered, depsgraph), subject=obj.name)
    for part in parts:
        # A point that is not finite makes the box so; weights can be the reason.
        if not np.isfinite(part.surface.box).all():
            if obj.type == "SURFACE" and nonpositive_weights(obj.data.splines):
                raise ReadError(
                    CONTROL_POINTS_INVALID, fault=NON_POSITIVE_WEIGHTS, subject=obj.name
                )
            require_finite(obj, part.surface.points, part.source_object_name)
    reading.parts = parts
    reading.findings = list(reading_findings(obj, gathered, depsgraph))
    return reading


def read_lines(obj, depsgraph) -> Reading:
    """Read the curves of a curve object, original or evaluated, or raise ReadError for other
    kinds.
    """
    obj = obj.original
    if obj.type != "CURVE":
        raise ReadError(ONLY_CURVES_ARE_WIRES, subject=obj.name)
    reading = locate(obj, depsgraph)
    reading.curves, reading.findings = read_curves(obj, depsgraph)
    return reading


def read_patches(obj, depsgraph) -> Reading | None:
    """Read the patches of a surface object; None for an instancer, or if the mesh must be
    measured.
    """
    obj = obj.original
    reading = locate(obj, depsgraph)
    if obj.instance_type != "NONE":
        return None
    geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its mesh
    evaluated = obj.evaluated_get(depsgraph)
    splines = spline_reading(
        evaluated, depsgraph, geometry.mesh if is_deformed(evaluated) else None
    )
    if splines is None:
        return None
    nothing = Surface(np.zeros((0, 3), np.float32))
    reading.parts = [Part(nothing, reading.matrix[None], splines=splines)]
    return reading


def locate(obj, depsgraph) -> Reading:
    """Return a reading that only has an evaluated object's name, type and place, or raise
    ReadError.
    """
    evaluated = obj.evaluated_get(depsgraph)
    if not evaluated.is_evaluated:
        raise ReadError(why_not_evaluated(obj, depsgraph), subject=obj.name)
    matrix = world_matrices(evaluated)[0]
    if not np.isfinite(matrix).all():
        raise ReadError(NON_FINITE_TRANSFORM, subject=obj.name)
    location, rotation, _scale = evaluated.matrix_world.decompose()
    return Reading(
        name=obj.name,
        type=obj.type,
        matrix=matrix,
        rotation=rotation_matrix(rotation),
        location=matrix[:3, 3].copy() if has_places(obj) else np.array(location[:], np.float64),
    )


def require_finite(obj, points: NDArray, source: str = "") -> None:
    """Raise ReadError if (n, 3) points of an object, or of an instance of the object `source`, are
    not finite.
    """
    misplaced = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(misplaced):
        fault = finding(NON_FINITE_VERTICES, misplaced, count=len(misplaced), total=len(points))
        raise ReadError(attribute_to_source(fault, source, obj.name), subject=obj.name)
