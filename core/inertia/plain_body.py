# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A body as plain numbers, in any frame, alone or as a sum: for panels, which are drawn without
numpy.

An inertia tensor is given by six entries, a frame by its three axes. A `Reference` refers inertia
to any point, axes or axis by the parallel-axis theorem, I_p = I_c + m (|d|² 1 - d dᵀ) with d = c -
p, with bounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, sin, sqrt
from sys import float_info
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numerics import cross, dot, subtract
from ..verdict import QueryError
from .findings import AXIS_POINTS_COINCIDE

if TYPE_CHECKING:
    from .mass_properties import MassProperties

Vector = tuple[float, ...]
Axes = tuple[Vector, ...]

# The tensor's six entries, in the order in which they are stored on an object.
TENSOR = (("xx", 0, 0), ("yy", 1, 1), ("zz", 2, 2), ("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2))
ENTRIES, ROWS, COLUMNS = zip(*TENSOR)
BOUND_KEYS = ("volume", "area", "center_of_mass", "inertia")
IDENTITY: Axes = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
SYMMETRIES = "asymmetric", "prolate", "oblate", "isotropic"
# For each symmetry, the axes with equal moments.
EQUAL_AXES = {"isotropic": (0, 1, 2), "prolate": (1, 2), "oblate": (0, 1), "asymmetric": ()}
EQUAL_MOMENTS_RTOL = 1e-6  # moments closer than this, relatively, are equal
SWEEPS = 6  # rounds of Jacobi's rotations, which converge quadratically
EQUAL_TRACE_ATOL = 1e-6  # frames whose traces are closer than this are equally near
MIN_ACROSS = 1e-6  # a shorter part of a vector has no direction
MIN_AXIS_RATIO = (
    1e-6  # relative to the coordinates: float32 points nearer to each other give no direction
)
U = float_info.epsilon / 2.0


class PlainBody(NamedTuple):
    """The results of a body as plain numbers, SI, in the object frame, or in the world after
    `in_world`.

    center: (3,). inertia: (6,) in the order of ENTRIES. moments, axes: the (3,) principal moments,
    and the axes as three vectors. error_bound: as in `Measurement`.
    """

    mass: float
    density: float
    volume: float
    area: float
    center: Vector
    inertia: Vector
    moments: Vector
    axes: tuple[Vector, ...]
    error_bound: dict[str, Any]

    @classmethod
    def of_body(
        cls,
        body: MassProperties,
        density: float,
        volume: float,
        area: float,
        error_bound: dict[str, Any],
    ) -> PlainBody:
        """Return mass properties as plain numbers, with density, volume, area and error bound."""
        return cls(
            body.mass,
            density,
            volume,
            area,
            center=tuple(body.center.tolist()),
            inertia=tuple(body.inertia[ROWS, COLUMNS].tolist()),
            moments=tuple(body.principal.moments.tolist()),
            axes=tuple(map(tuple, body.principal.axes.T.tolist())),
            error_bound=error_bound,
        )

    @property
    def gyration(self) -> Vector:
        """(3,) radii of gyration about the principal axes."""
        return tuple(
            sqrt(max(moment, 0.0) / self.mass) if self.mass > 0.0 else 0.0
            for moment in self.moments
        )

    def turned(self, axes: Axes) -> PlainBody:
        """Return the results in a frame with other axes and the same origin."""
        return self._replace(
            center=along_axes(self.center, axes),
            inertia=turn_tensor(self.inertia, axes),
            axes=tuple(along_axes(axis, axes) for axis in self.axes),
        )

    def in_world(self, matrix_world: Any, unit: float) -> PlainBody:
        """Return the results in the world frame; matrix_world: of the object; unit: meters per
        Blender unit.
        """
        location, turn, _ = matrix_world.decompose()
        body = self.turned(tuple(zip(*rotation_axes(turn))))
        return body._replace(
            center=tuple(value + unit * along for value, along in zip(body.center, location))
        )

    def in_object(self, matrix_world: Any, unit: float) -> PlainBody:
        """Return the results of the world frame in the object frame, as `in_world` takes them."""
        location, turn, _ = matrix_world.decompose()
        from_there = tuple(value - unit * along for value, along in zip(self.center, location))
        return self._replace(center=from_there).turned(rotation_axes(turn))


def add_bodies(parts: Sequence[PlainBody]) -> PlainBody | None:
    """Return bodies as one, in their common frame, by the parallel-axis theorem; None if they have
    no mass.
    """
    mass, volume, area = (
        sum([getattr(part, name) for part in parts]) for name in ("mass", "volume", "area")
    )
    if not mass > 0.0:  # the stored values were changed
        return None
    center = tuple(
        sum([part.mass * part.center[axis] for part in parts]) / mass for axis in range(3)
    )
    arms = [subtract(part.center, center) for part in parts]
    tensors = [move_tensor(part.inertia, part.mass, arm) for part, arm in zip(parts, arms)]
    tensor = tuple(map(sum, zip(*tensors)))
    moments, axes, _ = principal_axes(tensor)
    reach = [hypot(*arm) for arm in arms]
    bound = _bound_of_sum(parts, reach, [part.error_bound for part in parts])
    bound["input"] = _bound_of_sum(parts, reach, [part.error_bound["input"] for part in parts])
    density = mass / volume if volume else 0.0
    return PlainBody(mass, density, volume, area, center, tensor, moments, axes, bound)


def _bound_of_sum(
    parts: Sequence[PlainBody], arms: Sequence[float], bounds: Sequence[dict[str, float]]
) -> dict[str, Any]:
    """Return the bound of a sum of bodies, from the bound of each, and its distance from the
    center.
    """
    total_mass = sum([part.mass for part in parts])
    center = 0.0
    inertia = sum([bound["inertia"] for bound in bounds])
    shares = []  # bounds of the masses, relative to them
    for part, arm, bound in zip(parts, arms, bounds):
        # a shell without thickness has its mass by area
        share = (
            bound["volume"] / part.volume
            if part.volume > 0.0
            else bound["area"] / max(part.area, float_info.min)
        )
        shares.append(share)
        center += part.mass * ((1.0 + share) * bound["center_of_mass"] + share * arm)
    center /= total_mass
    for part, share, arm, bound in zip(parts, shares, arms, bounds):
        reach = arm + bound["center_of_mass"] + center
        growth = reach * reach - arm * arm
        inertia += part.mass * ((1.0 + share) * growth + share * arm * arm)
    return {
        "volume": sum([bound["volume"] for bound in bounds]),
        "area": sum([bound["area"] for bound in bounds]),
        "center_of_mass": center,
        "inertia": inertia,
    }


def rotation_axes(turn: Sequence[float]) -> Axes:
    """Return the axes of a rotation, the columns of its matrix, from a quaternion of any length."""
    length = hypot(*turn)
    if not length > 0.0:
        return IDENTITY
    w, x, y, z = (value / length for value in turn)
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


def along_axes(vector: Sequence[float], axes: Axes) -> Vector:
    """Return the components of a vector along axes."""
    x, y, z = vector
    return tuple([a * x + b * y + c * z for a, b, c in axes])


def tensor_rows(tensor: Sequence[float]) -> Axes:
    """Return the rows of the tensor's matrix."""
    xx, yy, zz, xy, xz, yz = tensor
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def turn_tensor(tensor: Sequence[float], axes: Axes) -> Vector:
    """Return the entries of a tensor along other axes."""
    rows = tensor_rows(tensor)
    turned = [along_axes(along_axes(axis, rows), axes) for axis in axes]
    return tuple([turned[i][j] for _, i, j in TENSOR])


def move_tensor(tensor: Sequence[float], mass: float, arm: Sequence[float]) -> Vector:
    """Return the inertia tensor about a point `arm` away from the center of mass, given that about
    the center.
    """
    x, y, z = arm
    products = y * y + z * z, z * z + x * x, x * x + y * y, -x * y, -x * z, -y * z
    return tuple(entry + mass * product for entry, product in zip(tensor, products))


def frame_about(axis: Sequence[float]) -> Axes:
    """Return a right-handed frame with this third axis; the first is a coordinate axis,
    projected.
    """
    first = _across(IDENTITY[min(range(3), key=lambda i: abs(axis[i]))], axis)
    return first, cross(axis, first), tuple(axis)


def _across(vector: Sequence[float], axis: Sequence[float]) -> Vector:
    """Return the direction of a vector's part that is perpendicular to an axis; () if there is
    none.
    """
    along = dot(vector, axis)
    part = [entry - along * other for entry, other in zip(vector, axis)]
    length = hypot(*part)
    return tuple(entry / length for entry in part) if length >= MIN_ACROSS else ()


def principal_axes(tensor: Sequence[float]) -> tuple[Vector, Axes, str]:
    """Return ascending principal moments, right-handed axes nearest to the coordinate axes, and the
    symmetry.
    """
    axes = IDENTITY
    for i, j, entry in SWEEPS * ((0, 1, 3), (0, 2, 4), (1, 2, 5)):
        turned = turn_tensor(tensor, axes)
        gap = turned[i] - turned[j]
        twice = 2.0 * turned[entry]
        # Jacobi's rotation makes the entry zero; the smaller angle, at most an eighth of a turn,
        # converges.
        angle = 0.5 * atan2(twice if gap >= 0.0 else -twice, abs(gap))
        c, s = cos(angle), sin(angle)
        pairs = tuple(zip(axes[i], axes[j]))
        moved = {
            i: tuple(c * a + s * b for a, b in pairs),
            j: tuple(c * b - s * a for a, b in pairs),
        }
        axes = tuple(moved.get(k, axis) for k, axis in enumerate(axes))
    (low, first), (middle, second), (high, _) = sorted(zip(turn_tensor(tensor, axes), axes))
    high = min(high, low + middle)  # rounding may violate the inequality for a flat body
    spreads = (middle + high - low) / 2.0, (high + low - middle) / 2.0
    rounding = 4.0 * float_info.epsilon * (low + middle + high)
    is_oblate, is_prolate = (
        gap <= EQUAL_MOMENTS_RTOL * spread + rounding
        for gap, spread in zip((middle - low, high - middle), spreads)
    )
    symmetry = SYMMETRIES[2 * is_oblate + is_prolate]
    return (low, middle, high), _nearest_frame(first, second, EQUAL_AXES[symmetry]), symmetry


def _nearest_frame(first: Vector, second: Vector, free: tuple[int, ...]) -> Axes:
    """Return the frame along two axes, as free as they are, and their cross product, nearest to the
    coordinate axes.
    """
    if len(free) == 3:
        return IDENTITY
    frames = []
    for signs in ((1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
        a, b = (tuple(sign * entry for entry in axis) for sign, axis in zip(signs, (first, second)))
        frame = [a, b, cross(a, b)]
        if free:
            fixed = frame[3 - sum(free)]
            # like `complete_free_axes`
            direction = [u + v for u, v in zip(IDENTITY[free[0]], cross(IDENTITY[free[1]], fixed))]
            # If the fixed axis points against its own coordinate axis, any direction may be as
            # near: that along a coordinate axis is taken.
            frame[free[0]] = _across(direction, fixed) or frame_about(fixed)[0]
            frame[free[1]] = cross(fixed, frame[free[0]])
        frames.append(tuple(frame))
    traces = [sum(axis[i] for i, axis in enumerate(frame)) for frame in frames]
    near = [frame for frame, trace in zip(frames, traces) if trace > max(traces) - EQUAL_TRACE_ATOL]
    return max(near, key=lambda frame: [_points_along(axis) for axis in frame])


def _points_along(axis: Vector) -> bool:
    """Return whether an axis points along the coordinate axis nearest to it, not against it."""
    largest = max(map(abs, axis))
    return next(entry for entry in axis if abs(entry) > largest - EQUAL_TRACE_ATOL) > 0.0


@dataclass(frozen=True, eq=False)
class Reference:
    """A frame that inertia is referred to: an origin, and right-handed axes, by default those of
    the coordinates.
    """

    origin: Sequence[float]
    axes: Axes = IDENTITY

    @classmethod
    def through_points(cls, first: Sequence[float], second: Sequence[float]) -> Reference:
        """Return the frame with its origin at the first point and Z towards the second; else
        QueryError.
        """
        way = subtract(second, first)
        length = hypot(*way)
        if not length > MIN_AXIS_RATIO * max(map(abs, (*first, *second))):
            raise QueryError(AXIS_POINTS_COINCIDE)
        return cls(first, frame_about([along / length for along in way]))

    def refer(self, body: PlainBody) -> ReferredInertia:
        """Refer the inertia of a body, given in the same coordinates, to this frame, by the
        parallel-axis theorem.
        """
        arm = subtract(body.center, self.origin)
        distance = hypot(*arm)
        # Frobenius norms: that of d² 1 - d dᵀ is √2 d². An error of d changes it by √2 (2 d error +
        # error²); 6 and 2 are more. 8 and 40 roundings are more than the steps below.
        rounded = 2.0 * U * sum(map(abs, (*body.center, *self.origin)))
        size = hypot(*body.inertia, *body.inertia[3:]) + sqrt(2.0) * body.mass * distance * distance
        bounds = []
        for bound, arm_error in ((body.error_bound, rounded), (body.error_bound["input"], 0.0)):
            mass = bound["volume"] * body.density
            center = bound["center_of_mass"] + arm_error
            inertia = bound["inertia"] + sqrt(2.0) * distance * distance * mass
            inertia += body.mass * (6.0 * distance * center + 2.0 * center * center)
            bounds.append({"mass": mass, "center": center, "inertia": inertia})
        bounds[0]["center"] += 8.0 * U * distance
        bounds[0]["inertia"] += 40.0 * U * size
        turned = turn_tensor(move_tensor(body.inertia, body.mass, arm), self.axes)
        return ReferredInertia(self, body.mass, along_axes(arm, self.axes), turned, *bounds)


@dataclass(frozen=True, eq=False)
class ReferredInertia:
    """Inertia about a reference, along its axes.

    `center`: the center of mass from the reference's origin, along its axes; mass times this is the
    first moment. `inertia`: the six entries of the tensor about the reference's origin.
    `rounding_error`, `input_error`: absolute bounds of "mass", "center" and "inertia", as in
    `MassProperties`.
    """

    reference: Reference
    mass: float
    center: Vector
    inertia: Vector
    rounding_error: dict[str, float]
    input_error: dict[str, float]

    @property
    def about_z(self) -> float:
        """The moment of inertia about the reference's Z axis, the axis of
        `Reference.through_points`.
        """
        return self.inertia[2]

    @property
    def radius_about_z(self) -> float:
        """The radius of gyration about the reference's Z axis."""
        return sqrt(max(self.about_z, 0.0) / self.mass)

    @property
    def distance_from_z(self) -> float:
        """The distance of the center of mass from the reference's Z axis."""
        return hypot(*self.center[:2])
