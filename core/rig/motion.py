# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Momentum of a body of moving parts from frame to frame, and the motion that a body without
contacts must have.

Velocities refer to the middle between two frames. On a parabola the center's velocity is exact.
Parts are followed in the axes of the heaviest part, whose rotation is interpolated as a quaternion:
there a turning rigid body is at rest. No interpolation crosses a take-off or a landing, where
velocities jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics import (
    Array,
    ArrayLike,
    Mask,
    NDArray,
    inertia_of_second,
    polar_rotation,
    quaternion,
    rotation_matrix,
)

# indices of the last frame on the ground, or of frame 0, and of the next frame on the ground
Flight = tuple[int, int]
# indices of the first and last frame; linear and angular momentum from nothing
Span = tuple[int, int, float, float]

# nodes of the polynomial through the frames around a velocity
NODES = 9
DEGREE = 8
# seconds: closer frames are captured, turn less, and have noise that averages out
CLOSE = 0.02
CLOSE_DEGREE = 5
AVERAGED = 3  # velocities between frames that give the velocity at a frame
UNEXPLAINED = (
    0.2  # relative to the weight: more force than that without a contact comes from nothing
)
SMOOTHED = 0.1  # seconds over which noise of captured motion averages out


@dataclass(frozen=True, eq=False)
class Course:
    """The p parts of a body at f frames.

    step: seconds from frame to frame. masses: (p,). centers: (f, p, 3). spreads: (f, p, 3, 3)
    integrals of r rᵀ dm about each part's center. linear: (f, p, 3, 3) matrices from each part's
    own axes to the world.
    """

    step: float
    masses: Array
    centers: Array
    spreads: Array
    linear: Array

    @property
    def center(self) -> Array:
        """(f, 3) centers of mass."""
        first = self.centers[0, 0]
        return first + np.einsum("p,fpi->fi", self.masses / self.masses.sum(), self.centers - first)


def find_flights(touching: ArrayLike) -> list[Flight]:
    """Return the flights, with the contact frames at their ends. touching: (f,) mask of the frames
    on the ground.
    """
    last = len(np.asarray(touching)) - 1
    return [
        (max(start - 1, 0), min(end, last)) for start, end in _runs(~np.asarray(touching, bool))
    ]


def _runs(true: Mask) -> list[tuple[int, int]]:
    """Return starts and ends of the runs of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    return [(start, end) for start, end in edges.reshape(-1, 2).tolist()]


def momenta_between(course: Course, first: int, last: int) -> tuple[Array, Array]:
    """Return the motion in the middle between neighboring frames of a section without jumps, and
    (n, 3, 3) inertia.

    The motion is (n, 7): the center's velocity, the angular momentum about the center, and the
    kinetic energy.
    """
    rows = slice(first, last + 1)
    count = last - first  # number of velocities
    step, masses = course.step, course.masses
    center = course.center[rows]
    polar, _ = polar_rotation(course.linear[rows, int(masses.argmax())])
    axes = continuous(quaternion(polar * np.sign(np.linalg.det(polar))[:, None, None]))
    back = rotation_matrix(axes).swapaxes(-1, -2)[:, None]
    degree = DEGREE if step > CLOSE else CLOSE_DEGREE
    mean, rate = (
        _stencils(count + 1, np.arange(count) + 0.5, NODES, derivative, degree)
        for derivative in (False, True)
    )
    # In the axes of the heaviest part: the parts' places and shapes, and their rates.
    arms = (back @ (course.centers[rows] - center[:, None])[..., None])[..., 0]
    linear = back @ course.linear[rows]
    arm = mean(arms)
    spread = mean(back @ course.spreads[rows] @ back.swapaxes(-1, -2))
    arm_rate = rate(arms) / step
    shape = mean(linear)
    shape[np.linalg.det(shape) == 0.0] = np.eye(3)  # a bone scaled to nothing has no spread either
    growth = (rate(linear) / step) @ np.linalg.inv(shape)
    # The rotation of these axes.
    turn = mean(axes)
    rotation = rotation_matrix(turn)
    spin = angular_velocities(turn, rate(axes) / step)
    second = spread.sum(axis=1) + np.einsum("p,fpi,fpj->fij", masses, arm, arm)
    inertia = inertia_of_second(second)
    product = growth @ spread
    inner = np.einsum("p,fpi->fi", masses, np.cross(arm, arm_rate))
    inner += axial_vectors(product.sum(axis=1))
    angular = inner + np.einsum("fij,fj->fi", inertia, spin)
    velocity = np.diff(center, axis=0) / step
    # Twice the kinetic energy: M v², the rotation's ω·(I ω + 2 inner), and that of the motion in
    # the turning axes, Σ m |arm'|² + tr(G S Gᵀ), with the growth G and the spread S of the parts.
    energy = masses.sum() * (velocity**2).sum(axis=1) + (spin * (angular + inner)).sum(axis=1)
    energy += np.einsum("p,fpi->f", masses, arm_rate**2) + (product * growth).sum(axis=(1, 2, 3))
    angular = np.einsum("fij,fj->fi", rotation, angular)
    return np.column_stack(
        [velocity, angular, energy / 2.0]
    ), rotation @ inertia @ rotation.swapaxes(-1, -2)


def angular_velocities(turns: NDArray, rates: NDArray) -> Array:
    """Return (..., 3) angular velocities, along the turned axes, of (..., 4) quaternions and their
    rates: twice the vector of the conjugate times the rate.
    """
    vectors = turns[..., 1:]
    spin = turns[..., :1] * rates[..., 1:] - rates[..., :1] * vectors
    spin = spin - np.cross(vectors, rates[..., 1:])
    return 2.0 * spin / (turns * turns).sum(axis=-1, keepdims=True)


def axial_vectors(matrices: NDArray) -> Array:
    """Return (..., 3) vectors a with a × x = (M - Mᵀ) x, of (..., 3, 3) matrices."""
    skew = matrices - matrices.swapaxes(-1, -2)
    return np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)


def momenta(course: Course, flights: Sequence[Flight]) -> tuple[Array, Array]:
    """Return the (f, 7) motion at the frames and its rate; the ends of a flight have the motion of
    the flight.
    """
    now, change = np.zeros((2, len(course.centers), 7))
    ends = sorted({0, len(course.centers) - 1, *(end for flight in flights for end in flight)})
    # Flights are the last: at their ends their motion replaces that of the sections on the ground.
    for first, last in sorted(zip(ends, ends[1:]), key=lambda section: section in flights):
        between = momenta_between(course, first, last)[0]
        at = np.arange(last - first + 1) - 0.5  # frames, counted in velocities between them
        now[first : last + 1] = _stencils(last - first, at, AVERAGED)(between)
        change[first : last + 1] = (
            _stencils(last - first, at, AVERAGED, derivative=True)(between) / course.step
        )
    return now, change


def find_unexplained(course: Course, flights: Sequence[Flight], gravity: NDArray) -> list[Span]:
    """Return spans of frames in flights with a change of momenta that gravity does not explain, and
    its amount. gravity: (3,).

    A force above a fifth of the weight is unexplained, and a torque above this force times the
    radius of gyration.
    """
    spans = []
    mass = float(course.masses.sum())
    limit = UNEXPLAINED * mass * float(np.linalg.norm(gravity))
    for first, last in flights:
        if last - first < 2:
            continue
        between, inertia = momenta_between(course, first, last)
        # A line through an even number of velocities is fitted evenly about the frame between them.
        nodes = min(2 * max(1, round(SMOOTHED / course.step / 2.0)), last - first)
        slope = _stencils(
            last - first, np.arange(last - first - 1) + 0.5, nodes, derivative=True, degree=1
        )
        change = slope(between) / course.step
        force = mass * np.linalg.norm(change[:, :3] - gravity, axis=1)
        torque = np.linalg.norm(change[:, 3:6], axis=1)
        gyration = np.sqrt(np.trace(inertia, axis1=1, axis2=2).mean() / (2.0 * mass))
        # The first force is that at the frame `first` + 1; `end` is behind the run.
        for start, end in _runs((force > limit) | (torque > limit * gyration)):
            sums = (float(values[start:end].sum()) * course.step for values in (force, torque))
            spans.append((first + 1 + start, first + end, *sums))
    return spans


def zero_moment_points(
    center: NDArray, height: NDArray, force: NDArray, torque: NDArray, weight: NDArray
) -> Array:
    """Return (f, 3) ground points about which contact forces have no moment along the ground; NaN
    without such forces.

    center: (f, 3). height: (f,) above the ground. force, torque: (f, 3) rates of the momenta.
    weight: (3,), a force.
    """
    up = -weight / np.linalg.norm(weight)
    contact = force - weight
    upward = contact @ up
    # With torque = (p - center) × contact and up·(p - center) = -height, the product up × torque is
    # (p - center) upward + height contact.
    moment = np.cross(up, torque) - height[:, None] * contact
    # Less than a thousandth of the weight is noise of a flight: chosen.
    upward = np.where(upward > 1e-3 * np.linalg.norm(weight), upward, np.nan)
    return center + moment / upward[:, None]


def ballistic_arc(
    start: NDArray, end: NDArray, shares: NDArray, time: float, gravity: ArrayLike
) -> Array:
    """Return (n, 3) places of a free fall between two places, at (n,) shares of its time."""
    share = shares[:, None]
    fall = np.asarray(gravity, np.float64) * (0.5 * time**2)
    return start + share * (end - start) - share * (1.0 - share) * fall


def frames_of_height(center: NDArray, step: float, gravity: ArrayLike) -> float:
    """Return the duration, in frames and not rounded, of a free flight from the first to the last
    height of an (f, 3) path, with the top of that path.
    """
    strength = float(np.linalg.norm(gravity))
    heights = -(center - center[0]) @ np.asarray(gravity, np.float64) / strength
    top = float(heights.max())
    # √(2h/g) up to the top, and down from it.
    return (
        float(np.sqrt(2.0 * top / strength) + np.sqrt(2.0 * (top - heights[-1]) / strength)) / step
    )


def continuous(quaternions: NDArray) -> NDArray:
    """Return (s, 4) quaternions, each with the sign that is nearer to the previous one."""
    signs = np.where((quaternions[1:] * quaternions[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    return np.concatenate([quaternions[:1], quaternions[1:] * np.cumprod(signs)[:, None]])


class _stencils:
    """Interpolation, or its derivative, of (count, ...) values at 0, 1, ... at (k,) places, by the
    nearest of these nodes. nodes: their number for each place.

    degree: of a polynomial fitted to the nodes; by default the polynomial goes through all of them.
    """

    def __init__(
        self,
        count: int,
        places: NDArray,
        nodes: int,
        derivative: bool = False,
        degree: int | None = None,
    ):
        nodes = min(nodes, count)
        degree = nodes - 1 if degree is None else min(degree, nodes - 1)
        self.starts = np.clip(np.ceil(places - nodes / 2.0), 0, count - nodes).astype(np.intp)
        middle = (nodes - 1) / 2.0
        # Places that are equally far from their nodes share their weights.
        offsets, self.kinds = np.unique(places - self.starts - middle, return_inverse=True)
        powers = np.arange(degree + 1)
        fit = np.linalg.pinv((np.arange(nodes) - middle)[:, None] ** powers)
        basis = offsets[:, None] ** powers
        if derivative:
            basis = np.concatenate(
                [np.zeros((len(offsets), 1)), basis[:, :-1] * powers[1:]], axis=1
            )
        self.weights = basis @ fit

    def __call__(self, values: NDArray) -> Array:
        """Return the (k, ...) interpolated values, or derivatives by one step, of (count, ...)
        values.
        """
        weights = self.weights[self.kinds].reshape(len(self.starts), -1, *(1,) * (values.ndim - 1))
        return np.sum(
            [weights[:, node] * values[self.starts + node] for node in range(weights.shape[1])],
            axis=0,
        )
