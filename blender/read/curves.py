# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The splines of a curve object as B-spline curves: Bézier, NURBS, Catmull-Rom and straight
splines.

Blender gives evaluated curves only without a surface; of beveled curves it gives the mesh, so their
splines are read.
"""

from collections.abc import Iterator

import numpy as np

from ...core.numerics import Array, NDArray, SplineSpace
from ...core.nurbs import CONTROL_POINTS_INVALID, NON_FINITE, Curve, blender_space
from ...core.verdict import Finding, ReadError, finding
from .findings import (
    CURVE_MEASURED_WHOLE,
    NO_SPLINE_LENGTH,
    NOTHING_TO_MEASURE,
    SPLINES_LEFT_OUT,
    UNKNOWN_KNOTS,
)
from .mesh import read_array
from .splines import deform, is_deformed, spline_modifiers, weighted_points
from .visibility import evaluated_geometry

STRAIGHT_RTOL = 1e-6  # relative to a spline's length: float32 may bend a straight line by as much
TYPES = ("CATMULL_ROM", "POLY", "BEZIER", "NURBS")  # curve types by their number in a geometry set
CUSTOM_KNOTS_MODE = 4  # the mode of custom knots, which no flags describe
STEPS_PER_POINT = 8  # straight steps per point in which lengths are compared
SAME_LENGTH_RTOL = 1e-4  # relative to the length: other knots change it by more
AGREEMENT_RTOL = 1e-7  # relative to the largest coordinate: rounding in float32 of each step


def read_curves(obj, depsgraph) -> tuple[list[Curve], list[Finding]]:
    """Return the curves of an evaluated curve object in its own coordinates, and the findings, or
    raise ReadError.
    """
    obj = obj.original
    geometry = evaluated_geometry(obj, depsgraph, obj)  # it owns its curves
    ignored = []
    if geometry.curves is not None:
        curves = list(_shown_curves(geometry.curves, obj.name))
    else:
        curves = list(_spline_curves(obj.evaluated_get(depsgraph), depsgraph))
        is_partial = (obj.data.bevel_factor_start, obj.data.bevel_factor_end) != (0.0, 1.0)
        ignored += ["the modifiers that work on its mesh"] * bool(spline_modifiers(obj)[1])
        ignored += ["the start and end of its bevel"] * is_partial
    findings = [finding(CURVE_MEASURED_WHOLE, ignored=part) for part in ignored]
    usable = [curve for curve in curves if curve is not None]
    if len(usable) < len(curves):
        findings.append(
            finding(SPLINES_LEFT_OUT, count=len(curves) - len(usable), total=len(curves))
        )
    if not usable:
        raise ReadError(NOTHING_TO_MEASURE, cause=NO_SPLINE_LENGTH, subject=obj.name)
    return usable, findings


def text_curves(obj, depsgraph) -> list[Curve]:
    """Return the outlines of a text object as curves of its font, in its own coordinates, or raise
    ReadError.
    """
    try:
        curves = [
            _curve(*_kind(spline), _control_points(spline), None)
            for spline in obj.to_curve(depsgraph).splines
        ]
    finally:
        obj.to_curve_clear()
    usable = [curve for curve in curves if curve is not None]
    if not usable or len(usable) < len(curves):
        raise ReadError(NOTHING_TO_MEASURE, cause=NO_SPLINE_LENGTH, subject=obj.name)
    return usable


def is_round(obj) -> bool:
    """Return whether the polygons of a curve or text object stand for a curved shape."""
    curve = obj.data
    if obj.type == "FONT" or (
        curve.bevel_mode != "OBJECT" and curve.bevel_depth and curve.bevel_resolution
    ):
        return True
    shapes = [curve.bevel_object if curve.bevel_mode == "OBJECT" else None, curve.taper_object]
    return not all(
        _is_straight(spline)
        for data in (curve, *(other.data for other in shapes if other))
        for spline in data.splines
    )


def _is_straight(spline) -> bool:
    """Return whether all pieces of a spline are straight lines, as far as control points tell."""
    if spline.type == "POLY" or (spline.type == "NURBS" and spline.order_u == 2):
        return True
    pieces = _control_points(spline)[None]
    if spline.type == "BEZIER":
        # A piece has four: a point, its right handle, the next left handle and the next point.
        knots = pieces.reshape(-1, 3, 3)
        following = np.roll(knots, -1, axis=0)
        pieces = np.concatenate([knots[:, 1:], following[:, :2]], axis=1)
        pieces = pieces if spline.use_cyclic_u else pieces[:-1]
    arms = pieces - pieces[:, :1]
    lengths = np.linalg.norm(arms, axis=2)
    if not lengths.any():
        return True
    longest = np.take_along_axis(arms, lengths.argmax(axis=1)[:, None, None], axis=1)
    # The cross product is the distance from the line times the longest arm.
    beside = np.linalg.norm(np.cross(arms, longest), axis=2)
    return bool((beside <= STRAIGHT_RTOL * lengths.max(axis=1, keepdims=True) ** 2).all())


def _kind(spline) -> tuple[str, bool, int, bool, bool]:
    """Return the first arguments of `_curve`."""
    return (
        spline.type,
        spline.use_cyclic_u,
        spline.order_u,
        spline.use_bezier_u,
        spline.use_endpoint_u,
    )


def _control_points(spline) -> Array:
    """Return (n, 3) points in Blender's order; a Bézier point counts as left handle, point and
    right handle.
    """
    if spline.type != "BEZIER":
        return weighted_points(spline)[:, :3].astype(np.float64)
    knots = spline.bezier_points
    names = ("handle_left", "co", "handle_right")
    rows = [read_array(knots, name, (len(knots), 3), np.float32) for name in names]
    return np.stack(rows, axis=1).reshape(-1, 3).astype(np.float64)


def _spline_curves(evaluated, depsgraph) -> Iterator[Curve | None]:
    """Yield the splines as curves, moved by shape keys and hooks; None for each spline that is too
    short.
    """
    name = evaluated.original.name
    splines = list(evaluated.data.splines)
    if not splines:
        return
    control_points = [_control_points(spline) for spline in splines]
    points = np.concatenate(control_points)
    if is_deformed(evaluated):
        points = deform(evaluated, points, depsgraph)
    _require_finite(points, name)
    ends = np.cumsum([len(stored) for stored in control_points])
    for spline, stored, deformed in zip(splines, control_points, np.split(points, ends[:-1])):
        # Bézier splines have no weights and need none.
        weights = weighted_points(spline)[:, 3].astype(np.float64)
        if spline.type == "NURBS":
            stored_curve = _curve(*_kind(spline), stored, weights)
            if not _has_known_knots(spline, stored_curve):
                raise ReadError(UNKNOWN_KNOTS, subject=name)
        yield _curve(*_kind(spline), deformed, weights)


def _has_known_knots(spline, curve: Curve | None) -> bool:
    """Return whether a spline's knots follow from its settings, so that Blender finds the same
    length.
    """
    if curve is None:
        return True
    low, high = curve.space.domain
    # `calc_length` adds up as many straight steps.
    steps = (
        STEPS_PER_POINT * len(spline.points)
        if spline.use_cyclic_u
        else STEPS_PER_POINT * (len(spline.points) - 1) - 1
    )
    points = curve.evaluate(low + (high - low) * np.arange(steps + 1) / steps)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    unsure = SAME_LENGTH_RTOL * length + AGREEMENT_RTOL * steps * float(np.abs(points).max())
    return bool(abs(spline.calc_length(resolution=STEPS_PER_POINT) - length) <= unsure)


def _shown_curves(curves, name: str) -> Iterator[Curve | None]:
    """Yield the curves of a geometry set; None for each curve that is too short."""

    def point_vectors(attribute: str) -> Array:
        return _values(curves, attribute, "vector", (len(curves.points), 3))

    def curve_numbers(attribute: str, default: float = 0.0) -> list[int]:
        values = _values(curves, attribute, "value", (len(curves.curves), 1), default)
        return values[:, 0].astype(int).tolist()

    positions = point_vectors("position")
    left = point_vectors("handle_left")
    right = point_vectors("handle_right")
    weights = _values(curves, "nurbs_weight", "value", (len(curves.points), 1), 1.0)[:, 0]
    types = curve_numbers("curve_type")
    cyclic = curve_numbers("cyclic")
    orders = curve_numbers("nurbs_order", 4.0)
    knots = curve_numbers("knots_mode")
    _require_finite(positions, name)
    for number, curve in enumerate(curves.curves):
        of_curve = slice(curve.first_point_index, curve.first_point_index + curve.points_length)
        kind = TYPES[types[number]]
        points = positions[of_curve]
        if kind == "NURBS" and knots[number] == CUSTOM_KNOTS_MODE:
            raise ReadError(UNKNOWN_KNOTS, subject=name)
        if kind == "CATMULL_ROM":
            padded = np.pad(points, ((1, 1), (0, 0)), "wrap" if cyclic[number] else "edge")
            arms = (padded[2:] - padded[:-2]) / 6.0  # to the handles of the same cubic
            kind = "BEZIER"
            points = np.stack([points - arms, points, points + arms], axis=1).reshape(-1, 3)
        elif kind == "BEZIER":
            points = np.stack([left[of_curve], points, right[of_curve]], axis=1).reshape(-1, 3)
            _require_finite(points, name)
        yield _curve(
            kind,
            bool(cyclic[number]),
            orders[number],
            bool(knots[number] & 2),  # Bézier knots
            bool(knots[number] & 1),  # end points
            points,
            weights[of_curve],
        )


def _values(curves, name: str, item: str, shape: tuple[int, int], default: float = 0.0) -> Array:
    """Return an attribute of the points or the curves as an array, filled with the default if there
    is none.
    """
    if name not in curves.attributes:
        return np.full(shape, default)
    attribute = curves.attributes[name]
    kind = {"BOOLEAN": bool, "FLOAT": np.float32, "FLOAT_VECTOR": np.float32}.get(
        attribute.data_type, np.int32
    )
    return read_array(attribute.data, item, shape, kind).astype(np.float64)


def _require_finite(positions: NDArray, name: str) -> None:
    if not np.isfinite(positions).all():
        raise ReadError(CONTROL_POINTS_INVALID, fault=NON_FINITE, subject=name)


def _curve(
    kind: str,
    cyclic: bool,
    order: int,
    bezier: bool,
    endpoint: bool,
    points: Array,
    weights: NDArray | None,
) -> Curve | None:
    """Return a spline as a curve, None if too short; `points` are (n, 3), three for each point of a
    Bézier curve.
    """
    if kind == "NURBS":
        space = blender_space(len(points), order, cyclic, bezier, endpoint)
        return None if space is None else Curve(space, points, weights)
    if kind == "BEZIER":
        knots = points.reshape(-1, 3, 3)
        if cyclic:
            knots = np.concatenate([knots, knots[:1]])
        points = knots.reshape(-1, 3)[1:-1]
        order = 4
    else:
        points = np.concatenate([points, points[:1]]) if cyclic else points
        order = 2
    pieces = (len(points) - 1) // (order - 1)
    if pieces < 1:
        return None
    knots = [0.0, *np.repeat(np.arange(pieces + 1.0), order - 1).tolist(), float(pieces)]
    return Curve(SplineSpace(tuple(knots), order, len(points)), points)
