# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Momentum of a body of moving parts from frame to frame, and the motion that a body without contacts must have.

Velocities are those in the middle between two frames. The center's is exact on a parabola. Parts are followed in the
axes of the heaviest one, whose turn is interpolated as a quaternion: a rigid body that turns is a body at rest there.
No interpolation crosses a take-off or a landing, where velocities jump.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.rotations import polar_rotation, quaternion, rotation_matrix

Flight = tuple[int, int]  # indices of the last frame on the ground, or the first of all, and of the first one again

NODES, DEGREE = 10, 9  # of the polynomial through the frames around a velocity
CLOSE, CLOSE_DEGREE = 0.02, 5  # seconds: closer frames turn less, and are captured, with noise that averages out
AVERAGED = 4  # velocities between frames that those at a frame are computed from
UNEXPLAINED = 0.2  # of the weight: more force than that, without a contact, comes from nothing
SMOOTHED = 0.1  # seconds over which noise of captured motion averages out
TRIALS, CONVERGED = 40, 1e-12  # of a turn between two frames
CORRECTIONS, CONSTANT = 30, 1e-9  # of the turns of all frames; relative change of the angular momentum


@dataclass(frozen=True, eq=False)
class Course:
    """The p parts of a body at f frames.

    step: seconds from frame to frame. masses: (p,). centers: (f, p, 3). spreads: (f, p, 3, 3) integrals of r rᵀ dm
    about each part's center. linear: (f, p, 3, 3) matrices from each part's own axes to the world.
    """

    step: float
    masses: NDArray[np.float64]
    centers: NDArray[np.float64]
    spreads: NDArray[np.float64]
    linear: NDArray[np.float64]

    @property
    def center(self) -> NDArray[np.float64]:
        """(f, 3) centers of mass."""
        first = self.centers[0, 0]
        return first + np.einsum("p,fpi->fi", self.masses / self.masses.sum(), self.centers - first)

    def turned(self, turns: NDArray[np.float64]) -> Course:
        """Return the body turned about its center by a (3, 3) rotation at each frame."""
        center, each = self.center[:, None], turns[:, None]
        return replace(
            self,
            centers=center + np.einsum("fij,fpj->fpi", turns, self.centers - center),
            spreads=each @ self.spreads @ each.swapaxes(-1, -2),
            linear=each @ self.linear,
        )


@dataclass(frozen=True, eq=False)
class Momenta:
    """Motion of a body at each of n moments, in the units of its course.

    velocity, linear, angular: (n, 3), the last about the center. energy: (n,) kinetic. inertia: (n, 3, 3).
    """

    velocity: NDArray[np.float64]
    linear: NDArray[np.float64]
    angular: NDArray[np.float64]
    energy: NDArray[np.float64]
    inertia: NDArray[np.float64]


@dataclass(frozen=True)
class Unexplained:
    """Frames, by index, at which momentum changes without a contact.

    impulse: the linear momentum, twist: the angular momentum that comes from nothing.
    """

    first: int
    last: int
    impulse: float
    twist: float


def find_flights(touching: ArrayLike) -> list[Flight]:
    """Return the flights in (f,) frames that touch the ground or do not, with the frames of contact at their ends."""
    touching = np.asarray(touching, bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], touching, [True]]).astype(int)))
    pairs = edges.reshape(-1, 2)
    return [(max(start - 1, 0), min(end, len(touching) - 1)) for start, end in pairs.tolist()]


def momenta_between(course: Course, first: int, last: int) -> Momenta:
    """Return the motion in the middle between neighboring frames of a section without jumps."""
    rows, count, step = slice(first, last + 1), last - first, course.step
    masses, center = course.masses, course.center[rows]
    axes = _axes(course.linear[rows, int(masses.argmax())])
    back = rotation_matrix(axes).swapaxes(-1, -2)
    arms = np.einsum("fij,fpj->fpi", back, course.centers[rows] - center[:, None])
    linear = back[:, None] @ course.linear[rows]
    spreads = back[:, None] @ course.spreads[rows] @ back[:, None].swapaxes(-1, -2)
    middle = np.arange(count) + 0.5
    degree = DEGREE if step > CLOSE else CLOSE_DEGREE
    mean, rate = (_stencils(count + 1, middle, NODES, order, degree) for order in (False, True))
    arm, spread, turn = mean(arms), mean(spreads), mean(axes)
    arm_rate, turn_rate, shape = rate(arms) / step, rate(axes) / step, mean(linear)
    shape[np.linalg.det(shape) == 0.0] = np.eye(3)  # a bone scaled to nothing has no spread either
    growth = (rate(linear) / step) @ np.linalg.inv(shape)
    spin = 2.0 * _vector_of_product(turn_rate, turn) / (turn * turn).sum(axis=1)[:, None]
    rotation = rotation_matrix(turn)
    spin = np.einsum("fji,fj->fi", rotation, spin)  # in the axes
    second = spread.sum(axis=1) + np.einsum("p,fpi,fpj->fij", masses, arm, arm)
    inertia = np.trace(second, axis1=1, axis2=2)[:, None, None] * np.eye(3) - second
    product = growth @ spread
    own = (product - product.swapaxes(-1, -2)).sum(axis=1)
    relative = np.stack([own[:, 2, 1], own[:, 0, 2], own[:, 1, 0]], axis=1)
    relative = relative + np.einsum("p,fpi->fi", masses, np.cross(arm, arm_rate))
    angular = relative + np.einsum("fij,fj->fi", inertia, spin)
    velocity, mass = np.diff(center, axis=0) / step, float(masses.sum())
    energy = mass * (velocity**2).sum(axis=1) + (spin * (angular + relative)).sum(axis=1)
    energy += np.einsum("p,fpi->f", masses, arm_rate**2) + (product * growth).sum(axis=(1, 2, 3))
    angular, inertia = np.einsum("fij,fj->fi", rotation, angular), rotation @ inertia @ rotation.swapaxes(-1, -2)
    return Momenta(velocity, mass * velocity, angular, energy / 2.0, inertia)


def momenta(course: Course, flights: Sequence[Flight]) -> tuple[Momenta, NDArray, NDArray]:
    """Return the motion at the frames, (f, 3) forces and (f, 3) torques; at the ends of a flight, those of the flight.

    Forces and torques, about the center, are the rates of the momenta; gravity is in them.
    """
    frames = len(course.centers)
    found = {name: np.zeros((frames, *shape)) for name, shape in SHAPES.items()}
    for first, last in sorted(_sections(frames, flights), key=lambda section: section in flights):
        between, at = momenta_between(course, first, last), np.arange(last - first + 1) - 0.5
        value, rate = (_stencils(last - first, at, AVERAGED, derivative) for derivative in (False, True))
        for name in SHAPES:
            if name in RATES:
                found[name][first : last + 1] = rate(getattr(between, RATES[name])) / course.step
            else:
                found[name][first : last + 1] = value(getattr(between, name))
    force, torque = found.pop("force"), found.pop("torque")
    return Momenta(**found), force, torque


SHAPES = {"velocity": (3,), "linear": (3,), "angular": (3,), "energy": (), "inertia": (3, 3), "force": (3,)}
SHAPES["torque"] = (3,)
RATES = {"force": "linear", "torque": "angular"}


def find_unexplained(course: Course, flights: Sequence[Flight], gravity: ArrayLike) -> list[Unexplained]:
    """Return the frames of flights at which the momenta change otherwise than by gravity.

    A force above a fifth of the weight is unexplained, or its torque at the body's radius of gyration.
    """
    result, mass = [], float(course.masses.sum())
    weight = mass * np.asarray(gravity, np.float64)
    for first, last in flights:
        if last - first < 2:
            continue
        between = momenta_between(course, first, last)
        nodes = min(2 * max(1, round(SMOOTHED / course.step / 2.0)), last - first)
        slope = _stencils(last - first, np.arange(last - first - 1) + 0.5, nodes, derivative=True, degree=1)
        force = np.linalg.norm(slope(between.linear) / course.step - weight, axis=1)
        torque = np.linalg.norm(slope(between.angular) / course.step, axis=1)
        gyration = np.sqrt(np.trace(between.inertia, axis1=1, axis2=2).mean() / (2.0 * mass))
        limit = UNEXPLAINED * float(np.linalg.norm(weight))
        bad = (force > limit) | (torque > limit * gyration)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], bad, [False]]).astype(int))).reshape(-1, 2)
        for start, end in edges.tolist():
            sums = (float(values[start:end].sum()) * course.step for values in (force, torque))
            result.append(Unexplained(first + 1 + start, first + end, *sums))
    return result


def zero_moment_points(
    center: NDArray, height: NDArray, force: NDArray, torque: NDArray, weight: NDArray
) -> NDArray[np.float64]:
    """Return (f, 3) points of the ground at which the contact forces have no moment along it; NaN without such forces.

    center: (f, 3). height: (f,) above the ground. force, torque: (f, 3) rates of the momenta. weight: (3,), a force.
    """
    up = -weight / np.linalg.norm(weight)
    carried = force - weight
    upward = carried @ up
    moment = np.cross(up, torque) - height[:, None] * carried
    upward = np.where(upward > 1e-3 * np.linalg.norm(weight), upward, np.nan)
    return center + moment / upward[:, None]


def ballistic_arc(start: NDArray, end: NDArray, frames: int, step: float, gravity: ArrayLike) -> NDArray[np.float64]:
    """Return (frames + 1, 3) places of a free fall from one place to another."""
    share = np.arange(frames + 1)[:, None] / frames
    fall = np.asarray(gravity, np.float64) * (0.5 * (frames * step) ** 2)
    return start + share * (end - start) - share * (1.0 - share) * fall


def frames_of_height(center: NDArray, step: float, gravity: ArrayLike) -> float:
    """Return the number of frames, not whole, of a free fall as high as an (f, 3) path, between its ends."""
    strength = float(np.linalg.norm(gravity))
    heights = -(center - center[0]) @ np.asarray(gravity, np.float64) / strength
    top = float(heights.max())
    return float(np.sqrt(2.0 * top / strength) + np.sqrt(2.0 * (top - heights[-1]) / strength)) / step


def turns_of_constant_spin(course: Course, first: int, last: int) -> NDArray[np.float64]:
    """Return (last - first + 1, 3, 3) turns about the center that keep the angular momentum after the first frame.

    They are integrated from frame to frame, then corrected until the turned body, measured as any other, keeps it.
    """
    between, step = momenta_between(course, first, last), course.step
    kept, inverse = between.angular[0], np.linalg.inv(between.inertia)
    turns = np.tile(np.eye(3), (last - first + 1, 1, 1))
    for index in range(last - first):
        rate = np.zeros(3)
        for _ in range(TRIALS):
            half = turns[index] @ _rotation(0.5 * step * rate)
            before, rate = rate, inverse[index] @ (half.T @ kept - between.angular[index])
            if np.abs(rate - before).max() * step < CONVERGED:
                break
        turns[index + 1] = turns[index] @ _rotation(step * rate)
    section = Course(course.step, course.masses, *(each[first : last + 1] for each in _arrays(course)))
    best, least = turns, np.inf
    for _ in range(CORRECTIONS):
        found = momenta_between(section.turned(turns), 0, last - first)
        missing = kept - found.angular
        error = float(np.abs(missing).max())
        if error < least:
            best, least = turns, error
        if not error > CONSTANT * np.linalg.norm(kept):
            break
        rates = np.linalg.solve(found.inertia, missing[:, :, None])[:, :, 0] * step
        total, corrected = np.eye(3), [turns[0]]
        for rate, turn in zip(rates, turns[1:]):
            total = _rotation(rate) @ total
            corrected.append(total @ turn)
        turns = np.array(corrected)
    return best


def _arrays(course: Course) -> tuple[NDArray, NDArray, NDArray]:
    return course.centers, course.spreads, course.linear


def _sections(frames: int, flights: Sequence[Flight]) -> Iterator[Flight]:
    """Yield the flights, and the sections of at least two frames between them."""
    end = 0
    for first, last in flights:
        if first > end:
            yield end, first
        yield first, last
        end = last
    if frames - 1 > end:
        yield end, frames - 1


def _axes(linear: NDArray) -> NDArray[np.float64]:
    """Return (f, 4) quaternions of a part's axes, each of the sign that is nearer to the one before."""
    polar, _ = polar_rotation(linear)
    turns = quaternion(polar * np.sign(np.linalg.det(polar))[:, None, None])
    flips = np.where((turns[1:] * turns[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    turns[1:] *= np.cumprod(flips)[:, None]
    return turns


def _vector_of_product(first: NDArray, second: NDArray) -> NDArray[np.float64]:
    """Return the vectors of (f, 4) quaternions times the conjugates of others."""
    scalar, vector = first[:, :1], first[:, 1:]
    return second[:, :1] * vector - scalar * second[:, 1:] - np.cross(vector, second[:, 1:])


def _rotation(vector: NDArray) -> NDArray[np.float64]:
    """Return the (3, 3) rotation by a vector's length about it."""
    half = 0.5 * float(np.linalg.norm(vector))
    return rotation_matrix(np.concatenate([[np.cos(half)], 0.5 * np.sinc(half / np.pi) * vector]))


class _stencils:
    """Interpolation, or its derivative, of (count, ...) values at (k,) places between them, by their nearest nodes.

    degree: of a polynomial fitted to the nodes; without, the one through all of them.
    """

    def __init__(self, count: int, places: NDArray, nodes: int, derivative: bool = False, degree: int | None = None):
        nodes = min(nodes, count)
        degree = nodes - 1 if degree is None else min(degree, nodes - 1)
        self.starts = np.clip(np.ceil(places - nodes / 2.0), 0, count - nodes).astype(np.intp)
        middle = (nodes - 1) / 2.0
        offsets, self.kinds = np.unique(places - self.starts - middle, return_inverse=True)
        powers = np.arange(degree + 1)
        fit = np.linalg.pinv((np.arange(nodes) - middle)[:, None] ** powers)
        basis = offsets[:, None] ** powers
        if derivative:
            basis = np.concatenate([np.zeros((len(offsets), 1)), basis[:, :-1] * powers[1:]], axis=1)
        self.weights = basis @ fit

    def __call__(self, values: NDArray) -> NDArray[np.float64]:
        """Return (k, ...) combinations."""
        base, flat = values[self.starts], 0.0
        weights = self.weights[self.kinds]
        shape = (-1,) + (1,) * (values.ndim - 1)
        total = weights.sum(axis=1).reshape(shape) * base  # zero or one: differences keep their digits far away
        for node in range(weights.shape[1]):
            flat = flat + weights[:, node].reshape(shape) * (values[self.starts + node] - base)
        return total + flat
