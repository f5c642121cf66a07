# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves and surfaces of STEP files (ISO 10303-42), by the names of their entities.

Lines and conics between two points are exact rational curves. Cylinders, cones, spheres and tori
are quadrics, extrusions and revolutions are patches as long as their boundary, B-splines patches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from ..numerics import Array, SplineSpace, clamped_space
from ..nurbs import (
    TURN,
    Curve,
    Face,
    Quadric,
    bezier_curves,
    nearest_parameters,
    plane_moments,
    reverse_curves,
)
from ..verdict import FileError, MeasureError
from .findings import SURFACE_UNSUPPORTED
from .iges_entities import MAX_DEPTH
from .part21 import Part21, Reference, untyped
from .regions import MISS_RTOL
from .surfaces import RECURSION, SurfaceRefusedError, bezier_surface, placed_surface, reason, refuse
from .sweeps import conic_pieces, join_pieces, revolve, revolved_quadric, rule
from .trimmed import face_within, flat_region

UNCERTAINTIES = 20.0  # A vertex may be so many uncertainties of the file from its curve.
SAMPLES = 257  # points of a spline where the search for the parameters of vertices begins
MARGIN = 1e-3  # by which a swept surface goes beyond its boundary, relative to this
Ends: TypeAlias = "Sequence[Array] | None"  # two ends of a curve; None for the whole curve
Loops: TypeAlias = list[list[Curve]]


class EntityError(Exception):
    """The refusal of an entity: its number, a finding's code and its values."""

    def __init__(self, number: int, code: str, values: Mapping[str, Any]) -> None:
        super().__init__(code)
        self.number, self.code, self.values = number, code, values


@contextmanager
def blame(number: int) -> Iterator[None]:
    """Raise EntityError with this number for every refusal that names no other entity."""
    try:
        yield
    except FileError:
        raise
    except (MeasureError, ValueError, OverflowError, LookupError, TypeError) as error:
        raise EntityError(number, *reason(error)) from error


class Shapes:
    """The curves and surfaces of a file, in its unit.

    angle: radians per unit of angles. uncertainty: of points, by the file. gap: largest distance of
    a vertex from a curve.
    """

    def __init__(self, text: Part21) -> None:
        self.text = text
        self.angle = 1.0
        self.uncertainty = 0.0
        self.gap = 0.0
        self._depth = 0

    def pick(self, number: int, names: Any) -> tuple[str, list[Any]]:
        """Return the first of the names that an instance has, and its attributes."""
        parts = self.text[number]
        name = next((name for name in parts if name in names), None)
        if name is None:
            raise SurfaceRefusedError(SURFACE_UNSUPPORTED, base=max(parts, key=len))
        return name, parts[name]

    def attribute(self, number: int, name: str, index: int) -> Any:
        """Return an attribute of the entity of a name."""
        return self.pick(number, (name,))[1][index]

    def triple(self, number: int, name: str) -> Array:
        """Return the (3,) coordinates of a point or a direction."""
        values = np.array(self.attribute(number, name, 1), np.float64)
        if values.shape != (3,):
            raise ValueError("not in space")
        return values

    def point(self, number: int) -> Array:
        """Return the (3,) place of a point."""
        return self.triple(number, "CARTESIAN_POINT")

    def direction(self, number: int) -> Array:
        """Return a (3,) direction of length 1."""
        values = self.triple(number, "DIRECTION")
        length = np.linalg.norm(values)
        if not length > 0.0:
            raise ValueError("no direction")
        return values / length

    def along(self, number: int) -> Array:
        """Return a (3,) direction of length 1 of a vector."""
        return self.direction(self.attribute(number, "VECTOR", 1))

    def frame(self, number: int) -> Array:
        """Return the (4, 4) matrix of a placement."""
        name, values = self.pick(number, ("AXIS2_PLACEMENT_3D", "AXIS1_PLACEMENT"))
        axis, toward = (*values[2:], None, None)[:2]  # None if left out
        matrix = np.eye(4)
        z = matrix[:3, 2] if axis is None else self.direction(axis)
        # Without a direction of reference: first_proj_axis of ISO 10303-42.
        usual = np.eye(3)[0 if np.hypot(z[1], z[2]) > 1e-9 else 1]
        x = usual if toward is None else self.direction(toward)
        x = x - (x @ z) * z
        if not np.linalg.norm(x) > 0.0:
            raise ValueError("directions of no frame")
        x /= np.linalg.norm(x)
        matrix[:3] = np.stack([x, np.cross(z, x), z, self.point(values[1])], axis=1)
        return matrix

    @contextmanager
    def _nested(self) -> Iterator[None]:
        """Refuse an entity that refers to itself."""
        self._depth += 1
        try:
            if self._depth > MAX_DEPTH:
                raise refuse(RECURSION)
            yield
        finally:
            self._depth -= 1

    def curve(self, number: int, ends: Ends) -> list[Curve]:
        """Return a curve from the first to the second of two points, the whole curve for None."""
        name, values = self.pick(number, (*_CURVES, *_BASES))
        with self._nested():
            if name not in _BASES:
                with blame(number):
                    curves = _CURVES[name](self, self.text[number], values, ends)
                return curves if ends is None else self._moved_to_vertices(curves, ends)
            if name != "TRIMMED_CURVE":
                return self.curve(values[1], ends)
            _, base, *trims, same, _ = values
            if ends is None:
                ends = [self._trim(base, trim) for trim in trims]
            return self.curve(base, ends) if same else reverse_curves(self.curve(base, ends[::-1]))

    def _trim(self, base: int, trims: Sequence[Any]) -> Array:
        """Return the point where a curve is trimmed: a point of the file, else by a parameter."""
        for trim in trims:
            if isinstance(trim, Reference):
                return self.point(trim)
        name, values = self.pick(base, _CURVES)
        at = untyped(trims[0])
        if name == "LINE":
            length = self.attribute(values[2], "VECTOR", 2)
            return self.point(values[1]) + at * length * self.along(values[2])
        if name in ("CIRCLE", "ELLIPSE"):
            angle = self.angle * at
            # A circle has one size, its last attribute; an ellipse has two.
            place = values[2] * math.cos(angle), values[-1] * math.sin(angle), 0.0, 1.0
            return (self.frame(values[1]) @ place)[:3]
        (curve,) = self.curve(base, None)
        return curve.evaluate([at])[0]

    def _moved_to_vertices(self, curves: list[Curve], ends: Sequence[Array]) -> list[Curve]:
        """Return curves end to end whose first and last point are moved to vertices."""
        # 0 and -1: the first point of the first curve, and the last point of the last one.
        gap = max(float(np.linalg.norm(curves[k].points[k] - ends[k])) for k in (0, -1))
        size = max(float(np.ptp(curve.points, axis=0).max()) for curve in curves)
        if gap > max(MISS_RTOL * size, UNCERTAINTIES * self.uncertainty):
            raise refuse("an edge whose ends are not on its curve")
        self.gap = max(self.gap, gap)
        for k in (0, -1):
            points = curves[k].points.copy()
            points[k] = ends[k]
            curves[k] = replace(curves[k], points=points)
        return curves

    def face(self, number: int, loops: Loops) -> Face:
        """Return the face of a surface within loops, with its normal."""
        surface = self.surface(number, loops)
        if isinstance(surface, np.ndarray):
            return flat_region(loops, surface)
        return face_within(surface, loops, self.gap)

    def surface(self, number: int, loops: Loops) -> Any:
        """Return a plane's normal, a patch, or a quadric."""
        name, values = self.pick(number, (*_SURFACES, "RECTANGULAR_TRIMMED_SURFACE"))
        with self._nested():
            if name in _SURFACES:
                return _SURFACES[name](self, self.text[number], values, loops)
            # A rectangular part of a surface: the loops bound it again.
            return self.surface(values[1], loops)


def _line(shapes: Shapes, _: Any, values: list[Any], ends: Ends) -> list[Curve]:
    if ends is None:
        raise ValueError("a line without ends")
    begin = shapes.point(values[1])
    along = shapes.along(values[2])
    places = [begin + ((end - begin) @ along) * along for end in ends]
    return [Curve(clamped_space(2), np.array(places))]


def _conic(shapes: Shapes, values: list[Any], ends: Ends, kind: str) -> list[Curve]:
    """Return pieces of a conic between points, or all of an ellipse."""
    frame = shapes.frame(values[1])
    # A circle and a parabola have one size, which is the last attribute too.
    x_size, y_size = values[2], values[-1]
    if not min(x_size, y_size) > 0.0:
        raise ValueError("a conic without size")
    start, end = 0.0, TURN
    if ends is not None:
        local = np.linalg.solve(frame, np.column_stack([ends, np.ones(2)]).T)
        x, y = local[0] / x_size, local[1] / y_size
        start, end = {
            "ELLIPSE": np.arctan2(y, x),
            "HYPERBOLA": np.arcsinh(y),
            "PARABOLA": y / 2.0,
        }[kind].tolist()
        if kind == "ELLIPSE":
            end = start + ((end - start) % TURN or TURN)
    elif kind != "ELLIPSE":
        raise ValueError("an unbounded curve")
    return conic_pieces(frame, (x_size, y_size), (start, end), kind)


def _conic_of(kind: str) -> Callable[..., list[Curve]]:
    return lambda shapes, _, values, ends: _conic(shapes, values, ends, kind)


def _knots(
    parts: dict[str, list[Any]], kind: str, degree: int, count: int, multiple: Sequence[Any]
) -> list[float]:
    """Return the knots of a B-spline of `count` control points: those that its name implies, else
    the ones of `multiple`, which has their multiplicities and their values.
    """
    simple = np.arange(-degree, count + 1.0)
    if "UNIFORM_" + kind in parts:
        knots = simple
    elif "QUASI_UNIFORM_" + kind in parts:
        knots = simple.clip(0.0, count - degree)
    elif "BEZIER_" + kind in parts:
        knots = np.ceil(simple.clip(1.0 - degree, count - 1.0) / degree)
    else:
        knots = np.repeat(multiple[1], multiple[0])
    return knots.tolist()


def _spline_values(parts: dict[str, list[Any]], kind: str) -> tuple[list[Any], Any]:
    """Return the attributes of a B-spline after its name, and its weights or None."""
    # Of a single entity, all attributes follow its name; of several, each has its own.
    knots = parts.get("B_SPLINE_{}_WITH_KNOTS".format(kind), [])
    values = (
        next(iter(parts.values()))[1:] if len(parts) == 1 else [*parts["B_SPLINE_" + kind], *knots]
    )
    weights = parts.get("RATIONAL_B_SPLINE_" + kind)
    return values, weights and np.array(weights[0], np.float64)


def _spline(shapes: Shapes, parts: dict[str, list[Any]], _: Any, ends: Ends) -> list[Curve]:
    (degree, points, _, _, _, *multiple), weights = _spline_values(parts, "CURVE")
    places = np.array([shapes.point(point) for point in points])
    knots = _knots(parts, "CURVE", degree, len(places), multiple)
    space = SplineSpace(tuple(knots), degree + 1, len(places))
    return _part(Curve(space, places, weights), ends)


def _polyline(shapes: Shapes, _: Any, values: list[Any], ends: Ends) -> list[Curve]:
    places = np.array([shapes.point(point) for point in values[1]])
    steps = np.arange(len(places), dtype=np.float64)
    return _part(Curve(SplineSpace((0.0, *steps, steps[-1]), 2, len(places)), places), ends)


def _composite(shapes: Shapes, _: Any, values: list[Any], ends: Ends) -> list[Curve]:
    """Return the curves of a chain of trimmed curves."""
    curves: list[Curve] = []
    for segment in values[1]:
        _, (_, same, curve) = shapes.pick(segment, ("COMPOSITE_CURVE_SEGMENT",))
        segment_curves = shapes.curve(curve, None)
        curves += segment_curves if same else reverse_curves(segment_curves)
    gaps = [
        np.abs(curve.points[-1] - after.points[0]).max() for curve, after in zip(curves, curves[1:])
    ]
    size = np.ptp(np.concatenate([curve.points for curve in curves]), axis=0).max()
    if max(gaps, default=0.0) > MISS_RTOL * size:
        raise refuse("a chain of curves with a gap")
    if ends is None:
        return curves
    first_gap = np.linalg.norm(curves[0].points[0] - ends[0])
    is_backward = first_gap > np.linalg.norm(curves[-1].points[-1] - ends[0])
    return reverse_curves(curves) if is_backward else curves


def _part(curve: Curve, ends: Ends) -> list[Curve]:
    """Return the pieces of a spline from the first to the second of two points, or all of it; of a
    closed spline, past its begin if the second point comes first.
    """
    if ends is None:
        return [curve]
    low, high = curve.space.domain
    samples = curve.evaluate(np.linspace(low, high, SAMPLES))
    size = float(np.ptp(samples, axis=0).max())
    start, end = nearest_parameters(curve, samples, np.array(ends), 1e-9 * size).tolist()
    # Chosen, far above rounding and below what files draw: shorter pieces are none, and ends nearer
    # than a millionth of the size close the curve.
    shortest = 1e-9 * (high - low)
    is_closed = np.linalg.norm(samples[0] - samples[-1]) <= 1e-6 * size
    parts = [(start, high), (low, end)] if is_closed and end <= start + shortest else [(start, end)]
    pieces = [
        piece
        for begin, stop in parts
        if stop - begin > shortest
        for piece in bezier_curves(curve, (begin, stop))
    ]
    if not pieces:
        raise refuse("an edge whose ends are not on its curve")
    return pieces


def _spline_surface(shapes: Shapes, parts: dict[str, list[Any]], *_: Any) -> Any:
    values, weights = _spline_values(parts, "SURFACE")
    degree_s, degree_t, rows = values[:3]
    points = np.array([[shapes.point(point) for point in row] for row in rows])
    multiple = values[7:11]  # multiplicities of both directions, then values of both
    s_knots = _knots(parts, "SURFACE", degree_s, points.shape[0], multiple[0::2])
    t_knots = _knots(parts, "SURFACE", degree_t, points.shape[1], multiple[1::2])
    orders = (degree_s + 1, degree_t + 1)
    surface = placed_surface((s_knots, t_knots), orders, points, weights, np.eye(4))
    patches = bezier_surface(surface, (None, None), False)
    return patches[0] if len(patches) == 1 else surface


def _quadric_of(minor: int | None, major: int | None = 2) -> Callable[..., Quadric]:
    """Return the maker of a quadric whose radii are the attributes at these indices, 0 for None."""

    def make(shapes: Shapes, _: Any, values: list[Any], __: Any) -> Quadric:
        radii = [0.0 if at is None else float(values[at]) for at in (major, minor)]
        if min(radii) < 0.0 or not max(radii) > 0.0:
            raise ValueError("radii")
        return Quadric(shapes.frame(values[1]), *radii)

    return make


def _cone(shapes: Shapes, _: Any, values: list[Any], loops: Loops) -> Quadric:
    """Return the part of a cone on that side of its apex where its boundary is."""
    slope = math.tan(shapes.angle * values[3])
    frame = shapes.frame(values[1])
    radius = float(values[2])
    points = np.concatenate([curve.points for loop in loops for curve in loop])
    mean_height = float(np.mean((points - frame[:3, 3]) @ frame[:3, 2]))
    if radius + slope * mean_height < 0.0:
        return Quadric(frame @ np.diag([1.0, -1.0, -1.0, 1.0]), -radius, 0.0, slope)
    return Quadric(frame, radius, 0.0, slope)


def _torus(shapes: Shapes, parts: Any, values: list[Any], loops: Loops) -> Any:
    """Return a torus, or the part where its boundary is if its tube crosses the axis; the inner
    one faces inward.
    """
    torus = _quadric_of(3)(shapes, parts, values, loops)
    inner = replace(torus, radius=-torus.radius)
    # A degenerate torus has a fifth attribute, True for the outer part.
    is_inner = len(values) > 4 and not values[4]
    if torus.minor > torus.radius and len(values) == 4:
        if not loops:
            raise refuse("a torus that crosses its axis, without edges to tell which part is meant")
        points = np.concatenate([curve.samples(8) for loop in loops for curve in loop])
        distance, inner_distance = (
            np.linalg.norm(part.evaluate(*part.project(points).T)[0].T - points, axis=1).max()
            for part in (torus, inner)
        )
        is_inner = inner_distance < distance
    return inner.reverse_orientation() if is_inner else torus


def _offset(shapes: Shapes, _: Any, values: list[Any], loops: Loops) -> Any:
    """Return the surface at a distance from a plane, a cylinder, a cone, a sphere or a torus."""
    surface = shapes.surface(values[1], loops)
    if isinstance(surface, np.ndarray):
        return surface  # The boundary of a plane tells where it is.
    if not isinstance(surface, Quadric):
        raise SurfaceRefusedError(SURFACE_UNSUPPORTED, base="OFFSET_SURFACE")
    side = np.sign(np.linalg.det(surface.frame))  # -1.0 if the normal points inward
    # Off a cone of slope k the radius grows by sqrt(1 + k²) times the distance.
    away = side * float(values[2]) * math.hypot(1.0, surface.slope)
    size = (surface.minor or surface.radius) + away
    if size <= 0.0 and not surface.slope:
        raise refuse("an offset surface that turns its base inside out")
    if surface.minor and size > surface.radius > 0.0:
        raise refuse("an offset torus that crosses its axis")
    return replace(surface, minor=size) if surface.minor else replace(surface, radius=size)


def _extrusion(shapes: Shapes, _: Any, values: list[Any], loops: Loops) -> Any:
    """Return the normal of the plane that a line sweeps, or the patch that another curve sweeps,
    as high as its boundary.
    """
    along = shapes.along(values[2])
    if shapes.pick(values[1], (*_CURVES, *_BASES))[0] == "LINE":
        return np.cross(shapes.along(shapes.attribute(values[1], "LINE", 2)), along)
    profile = join_pieces(shapes.curve(values[1], None))
    heights = np.concatenate([curve.points for loop in loops for curve in loop]) @ along
    profile_heights = profile.points @ along
    low = heights.min() - profile_heights.max()
    high = heights.max() - profile_heights.min()
    margin = MARGIN * (high - low)
    ends = [
        replace(profile, points=profile.points + shift * along)
        for shift in (low - margin, high + margin)
    ]
    return rule(*ends)


def _revolution(shapes: Shapes, _: Any, values: list[Any], loops: Loops) -> Any:
    """Return the normal of a plane, the quadric or the patch that a curve sweeps about an axis."""
    frame = shapes.frame(values[2])
    begin, axis = frame[:3, 3], frame[:3, 2]
    name, line = shapes.pick(values[1], (*_CURVES, *_BASES))
    ends = None
    if name == "LINE":
        place = shapes.point(line[1])
        along = shapes.along(line[2])
        arms = np.concatenate([curve.points for loop in loops for curve in loop]) - place
        if not abs(along @ axis) > 1e-9:
            # Each half of the line sweeps the plane, facing another way: the loops tell which.
            return plane_moments([curve for loop in loops for curve in loop], axis, 0).total * axis
        steps = arms @ axis / (along @ axis)
        ends = [place + step * along for step in (steps.min(), steps.max())]
    profile = join_pieces(shapes.curve(values[1], ends))
    spokes = profile.samples(64) - begin
    spokes -= np.outer(spokes @ axis, axis)
    widest = spokes[np.argmax((spokes**2).sum(axis=1))]
    # A profile in a plane with the axis has spokes that are multiples of one.
    multiples = spokes @ widest / (widest @ widest)
    is_flat = np.abs(spokes - np.outer(multiples, widest)).max() < 1e-9 * np.linalg.norm(widest)
    if is_flat and multiples.min() < -1e-9:
        raise refuse("a curve that crosses the axis it turns about")
    swept = revolved_quadric(profile, begin, axis) or revolve(profile, begin, axis, 0.0, TURN)
    return swept.reverse_orientation()  # The angle is the first parameter.


_SPLINES = (
    ("B_SPLINE_", "_WITH_KNOTS"),
    ("BEZIER_", ""),
    ("QUASI_UNIFORM_", ""),
    ("UNIFORM_", ""),
)
_BASES = ("TRIMMED_CURVE", "SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE")
_CURVES: dict[str, Callable[..., list[Curve]]] = {
    "LINE": _line,
    "CIRCLE": _conic_of("ELLIPSE"),
    "ELLIPSE": _conic_of("ELLIPSE"),
    "HYPERBOLA": _conic_of("HYPERBOLA"),
    "PARABOLA": _conic_of("PARABOLA"),
    "POLYLINE": _polyline,
    "COMPOSITE_CURVE": _composite,
}
_CURVES |= {name + "CURVE" + end: _spline for name, end in _SPLINES}
_SURFACES: dict[str, Callable[..., Any]] = {
    "PLANE": lambda shapes, _, values, __: shapes.frame(values[1])[:3, 2],
    "CYLINDRICAL_SURFACE": _quadric_of(None),
    "CONICAL_SURFACE": _cone,
    "SPHERICAL_SURFACE": _quadric_of(2, None),
    "TOROIDAL_SURFACE": _torus,
    "DEGENERATE_TOROIDAL_SURFACE": _torus,
    "OFFSET_SURFACE": _offset,
    "SURFACE_OF_LINEAR_EXTRUSION": _extrusion,
    "SURFACE_OF_REVOLUTION": _revolution,
}
_SURFACES |= {name + "SURFACE" + end: _spline_surface for name, end in _SPLINES}
