# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The splines of a curve object as B-spline curves: Bézier, NURBS and straight ones.

Blender's geometry set has the control points of a curve that shows no surface as modifiers and shape keys leave them.
Of one with a bevel it has the mesh alone, and the points come from the splines.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...core.blender_knots import blender_space
from ...core.bspline import Space
from ...core.curve import Curve
from .deformation import deformed, is_deformed, spline_modifiers
from .reading import Unreadable
from .splines import weighted_points
from .visibility import evaluated_geometry

STRAIGHT = 1e-6  # of a spline's length: what float32 leaves of a straight line


def read_curves(obj, depsgraph) -> tuple[list[Curve], list[str]]:
    """The curves of a curve object in its own coordinates, as it is evaluated, and what was decided.

    Raises Unreadable where there is none, or Blender has not evaluated it.
    """
    obj = obj.original
    geometry = evaluated_geometry(obj, depsgraph, obj)
    evaluated = obj.evaluated_get(depsgraph)
    splines = list(evaluated.data.splines)
    notes = []
    rows = [_control_points(spline) for spline in splines]
    places = np.concatenate(rows) if rows else np.zeros((0, 3))
    shown = _evaluated_points(geometry.curves, splines)
    if shown is not None:
        places = shown
    elif is_deformed(evaluated):
        places = deformed(evaluated, places, depsgraph)
    if spline_modifiers(obj)[1] and shown is None:
        notes.append("Its modifiers change the mesh that comes of the curve; the curve was measured as it is before.")
    if not np.isfinite(places).all():
        raise Unreadable(obj.name, "Some of its control points are not finite; delete them, or mend what moves them.")
    found, left_out, start = [], 0, 0
    for spline, row in zip(splines, rows):
        curve = _curve(spline, places[start:start + len(row)])
        start += len(row)
        if curve is None:
            left_out += 1
        else:
            found.append(curve)
    if left_out:
        notes.append("{:d} of its {:d} splines are no curve and are left out: they have too few points for their "
                     "order, or for Bézier ends.".format(left_out, len(splines)))
    if not found:
        raise Unreadable(obj.name, "It has no spline that is a curve; add points to one.")
    return found, notes


def is_round(obj) -> bool:
    """Whether the polygons that Blender draws for a curve or text object stand for something that is not straight."""
    curve = obj.data
    if obj.type == "FONT" or (curve.bevel_mode != "OBJECT" and curve.bevel_depth and curve.bevel_resolution):
        return True
    shapes = [curve.bevel_object if curve.bevel_mode == "OBJECT" else None, curve.taper_object]
    return not all(_is_straight(spline) for data in (curve, *(one.data for one in shapes if one))
                   for spline in data.splines)


def _is_straight(spline) -> bool:
    """Whether a spline has no bend but at its points."""
    if spline.type == "POLY" or (spline.type == "NURBS" and spline.order_u == 2):
        return True
    pieces = _control_points(spline)[None]
    if spline.type == "BEZIER":
        knots = pieces.reshape(-1, 3, 3)
        after = np.roll(knots, -1, axis=0)
        pieces = np.concatenate([knots[:, 1:], after[:, :2]], axis=1)[:None if spline.use_cyclic_u else -1]
    arms = pieces - pieces[:, :1]
    lengths = np.linalg.norm(arms, axis=2)
    if not lengths.any():
        return True
    longest = np.take_along_axis(arms, lengths.argmax(axis=1)[:, None, None], axis=1)
    beside = np.linalg.norm(np.cross(arms, longest), axis=2)
    return bool((beside <= STRAIGHT * lengths.max(axis=1, keepdims=True) ** 2).all())


def _control_points(spline) -> NDArray[np.float64]:
    """(n, 3) in the order in which Blender counts them; of a Bézier point both handles, around it."""
    if spline.type != "BEZIER":
        return weighted_points(spline)[:, :3].astype(np.float64)
    rows = np.empty((3, 3 * len(spline.bezier_points)), np.float32)
    for row, name in zip(rows, ("handle_left", "co", "handle_right")):
        spline.bezier_points.foreach_get(name, row)
    return rows.reshape(3, -1, 3).swapaxes(0, 1).reshape(-1, 3).astype(np.float64)


def _evaluated_points(curves, splines: list) -> NDArray[np.float64] | None:
    """As `_control_points` for all splines in turn, from a geometry set's curves; None where they are others."""
    if curves is None or len(curves.curves) != len(splines):
        return None
    counts = [len(spline.bezier_points if spline.type == "BEZIER" else spline.points) for spline in splines]
    if len(curves.points) != sum(counts):
        return None
    position = _attribute(curves, "position")
    left, right = _attribute(curves, "handle_left"), _attribute(curves, "handle_right")
    rows, start = [], 0
    for spline, count in zip(splines, counts):
        own = slice(start, start + count)
        if spline.type != "BEZIER":
            rows.append(position[own])
        elif left is None or right is None:
            return None
        else:
            rows.append(np.stack([left[own], position[own], right[own]], axis=1).reshape(-1, 3))
        start += count
    return np.concatenate(rows).astype(np.float64)


def _attribute(curves, name: str) -> NDArray[np.float32] | None:
    if name not in curves.attributes:
        return None
    values = np.empty(3 * len(curves.points), np.float32)
    curves.attributes[name].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def _curve(spline, places: NDArray[np.float64]) -> Curve | None:
    cyclic = spline.use_cyclic_u
    if spline.type == "NURBS":
        space = blender_space(len(places), spline.order_u, cyclic, spline.use_bezier_u, spline.use_endpoint_u)
        if space is None:
            return None
        return Curve(space, places, weighted_points(spline)[:, 3].astype(np.float64))
    if spline.type == "BEZIER":
        knots = places.reshape(-1, 3, 3)
        if cyclic:
            knots = np.concatenate([knots, knots[:1]])
        places, order = knots.reshape(-1, 3)[1:-1], 4
    else:
        places, order = np.concatenate([places, places[:1]]) if cyclic else places, 2
    pieces = (len(places) - 1) // (order - 1)
    if pieces < 1:
        return None
    return Curve(Space(tuple(_joined_knots(pieces, order)), order, len(places)), places)


def _joined_knots(pieces: int, order: int) -> Iterator[float]:
    """Knots of Bézier pieces that follow each other."""
    yield 0.0
    for piece in range(pieces + 1):
        yield from (float(piece),) * (order - 1)
    yield float(pieces)
