# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The frames that a body's moments beyond second order choose.

A body without symmetry has one frame, any other body one for each rotation that takes it to itself,
as far as these moments show.

First a finite set of frames is found that turns with the body. Axes of different second moments are
fixed up to their signs. Around one such axis the other two are turned to make the first clear
harmonic ∫ (x+iy)^m ... real and positive; this leaves m choices (for a square prism by fourth
order, for a triangular one by third). If all second moments are equal, the first axis is a
direction in which the n-th moment ∫ (u·x)^n is largest or smallest, whichever happens in fewer
directions: for a cube by fourth order its own axes. Then the central moments are computed in each
of these frames, and the frames with the largest moments, compared entry by entry, are kept; entries
that differ by noise are equal. In all remaining frames the body is the same.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product

import numpy as np

from ..inertia import MOMENTS_OVERFLOW, NOISE_LEVEL, SecondMomentAxes, frame_about
from ..moments import Measure, Moments, monomial_index, monomials, tensor_index
from ..numerics import Array, NDArray, distinct_arrays, spread_directions
from ..verdict import MeasureError

MAX_ORDER = 6  # enough for the axes of prisms up to hexagonal, of a cube and of an icosahedron
# Growth of the noise with the degree: as the moments of a normal distribution grow.
NOISE_GROWTH = (1.0, 1.0, 1.0, 1.0, 3.0, 8.0, 15.0)
# A harmonic above this fixes a direction well; weaker ones are used only without a better one.
CLEAR_HARMONIC = 1e-2
# Relative to the largest extent: with less along an axis, a body is a lamina without skewness.
FLAT_EXTENT_RTOL = 1e-6
# Share of the range over all directions: larger differences never count as equal.
MAX_EQUAL_SHARE = 0.25
START_DIRECTIONS = 240  # directions at which the search for extreme ones starts
MAX_START_GAP = 0.18  # largest angle between any direction and the nearest start
ASCENT_STEPS = 16  # steps from a start to a maximum; flat maxima need most of them
# Directions that are closer than this after these steps go to one maximum, and are merged.
STEPS_BEFORE_MERGE = 3
MERGED_DIRECTIONS = 1e-4
ARRIVED = 1e-15  # shorter steps end the search
DISTINCT_DIRECTIONS = 1e-2  # extreme directions closer than this are one


@dataclass(frozen=True, eq=False)
class EquivalentFrames:
    """Frames in which a body is the same.

    frames: (k, 3, 3) rotations with the axes as columns. values, noise: (n,) the normalized central
    moments in each frame, of third to the highest order, and their noise. revolution_axes: the
    directions that no moment fixes: none (), all around one axis of the frames (that axis,), or all
    (0, 1, 2). tilt: an estimate of the angle by which noise may have turned them.
    """

    frames: Array
    values: Array
    noise: Array
    revolution_axes: tuple[int, ...]
    tilt: float


def canonical_frames(
    moments: Moments, spread: SecondMomentAxes, starts: NDArray
) -> EquivalentFrames:
    """Return the frames that moments of order 3 to MAX_ORDER choose; starts: (k, 3, 3) frames by
    third moments.
    """
    central = moments.about_center()
    total = central.raw[0]
    with np.errstate(over="ignore", under="ignore"):
        reach = total * spread.size.max() ** central.order
    if not np.finfo(float).tiny < reach < np.inf:
        raise MeasureError(MOMENTS_OVERFLOW, order=central.order)
    central = replace(
        central,
        raw=central.raw / total,
        rounding_error=central.rounding_error / total,
        measure=Measure.MASS,
    )
    frames, revolution_axes, tilt = _candidates(central, spread, starts)
    values, noise = _normalized_moments(central, spread, frames)
    return EquivalentFrames(
        *lexicographic_maximum(frames, values, noise), noise, revolution_axes, tilt
    )


def _candidates(
    central: Moments, spread: SecondMomentAxes, starts: NDArray
) -> tuple[NDArray, tuple[int, ...], float]:
    """Return candidate frames, and `revolution_axes` and `tilt` as in `EquivalentFrames`."""
    if not spread.undetermined_axes:
        return starts, (), spread.tilt
    if len(spread.undetermined_axes) == 2:
        axis = 3 - sum(spread.undetermined_axes)
        # One start for each direction of the axis; the turns about it are searched for here.
        points_along = starts[:, :, axis] @ spread.axes[:, axis] > 0.0
        bases = starts[np.unique(points_along, return_index=True)[1]]
        return _fix_rotation_about_axis(central, spread, bases, axis, spread.tilt)
    # All second moments are equal: the first degree whose moments differ clearly, else at all.
    for clear, degree in product((CLEAR_HARMONIC, 0.0), range(3, central.order + 1)):
        directions, sign, tilt = _extreme_directions(central, spread, degree, clear)
        if len(directions):
            bases = np.array([frame_about(direction) for direction in directions.tolist()])
            # About an axis of a cube, the fourth harmonic has this sign in the cube's own axes.
            quarter_sign = sign if degree == 4 else -1.0
            return _fix_rotation_about_axis(
                central, spread, bases.transpose(0, 2, 1), 2, tilt, quarter_sign
            )
    return spread.axes[None], (0, 1, 2), 0.0


def _fix_rotation_about_axis(
    central: Moments,
    spread: SecondMomentAxes,
    bases: NDArray,
    axis: int,
    tilt: float,
    quarter_sign: float = -1.0,
) -> tuple[NDArray, tuple[int, ...], float]:
    """Turn (n, 3, 3) bases about an axis so that the first clear harmonic is real, with the sign
    `quarter_sign` if it repeats at quarter turns, else positive.

    tilt: the uncertainty of the axis, rad. Return candidate frames, and `revolution_axes` and
    `tilt` as in `EquivalentFrames`.
    """
    harmonic = _clear_harmonic(central, spread, bases, axis)
    if harmonic is None:
        return bases, (axis,), tilt
    m, values, least = harmonic
    signed = quarter_sign * values if m == 4 else values
    angles = (np.angle(signed)[:, None] + 2.0 * np.pi * np.arange(m)) / m
    cos = np.cos(angles)[..., None]
    sin = np.sin(angles)[..., None]
    first = (axis + 1) % 3
    second = (axis + 2) % 3
    a = bases[:, None, :, first]
    b = bases[:, None, :, second]
    frames = np.repeat(bases[:, None], m, axis=1)
    frames[..., first] = cos * a + sin * b
    frames[..., second] = cos * b - sin * a
    # Among several directions keep those with the largest harmonic. `least` is for NOISE_LEVEL.
    noise = spread.noise / NOISE_LEVEL * least
    largest = np.abs(values).max()
    is_alike = np.abs(values) > largest - min(2.0 * noise, MAX_EQUAL_SHARE * largest)
    return frames[is_alike].reshape(-1, 3, 3), (), tilt + noise / (m * largest)


def _clear_harmonic(
    central: Moments, spread: SecondMomentAxes, bases: NDArray, axis: int
) -> tuple[int, NDArray[np.complex128], float] | None:
    """Return m, the (n,) values in n bases, and the noise of values at NOISE_LEVEL, of the first
    clear harmonic about an axis, else of the first above the noise; None if there is none.
    """
    first = (axis + 1) % 3
    order = [first, (axis + 2) % 3, axis]
    size = extents_of(spread.size)
    weaker = None
    for degree in range(3, central.order + 1):
        tensor = _rotate_tensor(central.raw[tensor_index(degree)], bases[:, :, order])
        noise = _normalization(central, replace(spread, noise=NOISE_LEVEL), degree)[1]
        # (x+iy)^m (x²+y²)^j z^k with m + 2j + k equal to the degree
        exponents = [
            (m, k) for m in range(1, degree + 1) for k in range((degree - m) % 2, degree - m + 1, 2)
        ]
        for m, k in exponents:
            unit = size[first] ** (degree - k) * size[axis] ** k
            values = _harmonic(tensor, degree, m, k) / unit
            powers = [0, 0, 0]
            powers[first] = degree - k
            powers[axis] = k
            place = monomial_index(*powers) - monomial_index(degree, 0, 0)
            # A harmonic is a sum of moments with weights that add up to 2^(degree - k).
            least = 2.0 ** (degree - k) * noise[place]
            largest = np.abs(values).max()
            if largest > max(least, CLEAR_HARMONIC):
                return m, values, least
            if weaker is None and largest > least:
                weaker = m, values, least
    return weaker


def _harmonic(tensor: NDArray, degree: int, m: int, k: int) -> NDArray[np.complex128]:
    """Return the (n,) means of (x+iy)^m (x²+y²)^j z^k, m + 2j + k = degree, from (n, 3, ..., 3)
    moments of this degree in n frames.
    """
    j = (degree - m - k) // 2
    forms = (
        [np.array([1.0, 1.0j, 0.0])] * (m + j)
        + [np.array([1.0, -1.0j, 0.0])] * j
        + [np.array([0, 0, 1.0])] * k
    )
    for form in forms:
        tensor = tensor @ form
    return tensor


def _extreme_directions(
    central: Moments, spread: SecondMomentAxes, degree: int, clear: float
) -> tuple[NDArray, float, float]:
    """Return the (k, 3) directions u of the largest E[(u·x)^degree], or of the least, whichever are
    fewer.

    Return also 1 for the largest or -1 for the least, and the angle by which noise may have turned
    the directions. A circle of directions is replaced by its poles.
    There are no directions, (0, 3), if the moment is the same in all of them.
    """
    tensor = central.raw[tensor_index(degree)] / spread.size.max() ** degree
    noise = 2.0 * _normalization(central, spread, degree)[1].max()
    usual_noise = _normalization(central, replace(spread, noise=NOISE_LEVEL), degree)[1].max()
    least = max(2.0 * usual_noise, clear)
    sphere = spread_directions(START_DIRECTIONS)
    # Samples span less than the extremes; those are compared with `least` again below.
    span = np.ptp(_contract(tensor, degree, sphere))
    if span <= least / 2.0:
        return np.empty((0, 3)), 1.0, 0.0
    within = min(noise, MAX_EQUAL_SHARE * span)
    extremes = []
    for sign in (1.0, -1.0) if degree % 2 == 0 else (1.0,):  # else the least are the opposite ones
        points = _maximize_on_sphere(sign * tensor, degree, span, within)
        height = _contract(sign * tensor, degree, points)
        if height.max() - _contract(sign * tensor, degree, sphere).min() <= least:
            return np.empty((0, 3)), sign, 0.0
        top = points[height > height.max() - within]
        extremes.append((distinct_arrays(top, DISTINCT_DIRECTIONS), sign))
    directions, sign = min(extremes, key=lambda pair: len(pair[0]))
    tilt = noise / span
    # If extreme directions form a circle, the moment is the same all around its pole: u × gradient,
    # the axis about which the moment grows, is across the pole for all u.
    slope = np.cross(sphere, _contract(tensor, degree - 1, sphere))
    pole = np.linalg.eigh(slope.T @ slope)[1][:, 0]
    is_round = np.abs(slope @ pole).max() <= within
    if is_round and np.linalg.norm(np.cross(directions, pole), axis=1).max() > DISTINCT_DIRECTIONS:
        return np.array([pole, -pole]), sign, tilt
    return directions, sign, tilt


def _maximize_on_sphere(tensor: NDArray, degree: int, span: float, within: float) -> Array:
    """Return (k, 3) maxima of a tensor's form on the sphere, some repeated, the most precise first;
    all of those at most `within` below the largest are among them.

    span: of the form's values on the sphere.

    The search starts from the highest points of a grid over the sphere: along the sphere the
    function is a trigonometric polynomial of this span, so that by Bernstein's inequality it loses
    at most (degree MAX_START_GAP)² span / 4 on the way from a maximum to the nearest of them. Steps
    are Newton's in curved directions, and always uphill.
    """
    points = spread_directions(START_DIRECTIONS)
    scale = degree**2 * span
    height = _contract(tensor, degree, points)
    points = points[height >= height.max() - within - (degree * MAX_START_GAP) ** 2 / 4.0 * span]
    uphill = np.zeros_like(points)
    for step in range(ASCENT_STEPS):
        if step >= STEPS_BEFORE_MERGE:
            points = distinct_arrays(points, MERGED_DIRECTIONS)
        contracted_twice = _contract(tensor, degree - 2, points)
        contracted_once = degree * np.einsum("nij,nj->ni", contracted_twice, points)
        radial = (contracted_once * points).sum(axis=1)[:, None]
        uphill = contracted_once - radial * points  # the gradient along the sphere
        tangential = np.eye(3) - points[:, :, None] * points[:, None, :]
        second_derivative = degree * (degree - 1) * contracted_twice
        values, vectors = np.linalg.eigh(
            tangential @ second_derivative @ tangential - radial[:, None] * tangential
        )
        move = np.einsum("nji,nj->ni", vectors, uphill) / np.maximum(np.abs(values), 1e-3 * scale)
        move /= np.maximum(np.linalg.norm(move, axis=1) / MAX_START_GAP, 1.0)[:, None]
        points = points + np.einsum("nij,nj->ni", vectors, move)
        points /= np.linalg.norm(points, axis=1)[:, None]
        if np.abs(move).max() < ARRIVED:
            break
    # Points that have arrived, by the gradient before their last step.
    steep = np.linalg.norm(uphill, axis=1)
    order = np.argsort(steep, kind="stable")
    return points[order[steep[order] <= max(1e-4 * scale, steep.min())]]


def _normalized_moments(
    central: Moments, spread: SecondMomentAxes, frames: NDArray
) -> tuple[NDArray, NDArray]:
    """Return the (k, n) normalized moments in the frames, and (n,) their noise."""
    values = []
    noises = []
    for degree in range(3, central.order + 1):
        unit, noise = _normalization(central, spread, degree)
        tensors = _rotate_tensor(central.raw[tensor_index(degree)], frames).reshape(len(frames), -1)
        values.append(tensors[:, _tensor_positions(degree)] / unit)
        noises.append(noise)
    return np.concatenate(values, axis=1), np.concatenate(noises)


def _normalization(
    central: Moments, spread: SecondMomentAxes, degree: int
) -> tuple[NDArray, NDArray]:
    """Return the (n,) scales of a degree's monomials, products of extents, and the (n,) noise of
    their moments over these: by the points' noise and the frame's tilt, and by rounding.
    """
    powers = monomials(degree)[monomial_index(degree, 0, 0) :]
    size = extents_of(spread.size)
    unit = np.prod(size**powers, axis=1)
    thin = np.min(np.where(powers > 0, size, np.inf), axis=1)  # the least extent in a monomial
    error = np.abs(
        _rotate_tensor(central.rounding_error[tensor_index(degree)], np.abs(spread.axes)[None])
    )
    if len(spread.undetermined_axes) == 3:  # the frames do not lie along the spread's axes
        error = np.full_like(error, 3.0 ** (degree / 2.0) * error.max())
    noise = spread.noise + 4.0 * spread.step / thin + degree * spread.tilt
    return unit, NOISE_GROWTH[degree] * noise + error.ravel()[_tensor_positions(degree)] / unit


def extents_of(size: NDArray) -> Array:
    """Return (..., 3) extents, infinite along an axis with hardly any, because noise is divided by
    them.
    """
    return np.where(size > FLAT_EXTENT_RTOL * size.max(axis=-1, keepdims=True), size, np.inf)


def lexicographic_maximum(
    frames: NDArray, values: NDArray, noise: NDArray
) -> tuple[NDArray, NDArray]:
    """Return the frames with the largest values, compared entry by entry up to noise; and these
    values.
    """
    best = np.arange(len(frames))
    for column, least in zip(values.T, noise):
        best = best[column[best] >= column[best].max() - least]
    return frames[best], values[best[0]]


def _contract(tensor: NDArray, times: int, points: NDArray) -> Array:
    """Return (n, 3, ...) contractions of a symmetric tensor with each of (n, 3) points, `times`
    times (at least 1).
    """
    out = np.tensordot(points, tensor, axes=(1, 0))
    for _ in range(times - 1):
        out = np.einsum("n...i,ni->n...", out, points)
    return out


def _rotate_tensor(tensor: NDArray, frames: NDArray) -> Array:
    """Return the (k, 3, ..., 3) entries of a symmetric tensor along the axes of k frames."""
    out = np.broadcast_to(tensor, (len(frames), *tensor.shape))
    for _ in range(tensor.ndim):
        out = np.einsum("kai,ka...->k...i", frames, out)
    return out


@lru_cache
def _tensor_positions(degree: int) -> NDArray[np.int64]:
    """Return for each monomial of a degree, in storage order, its first index in the flattened
    tensor.
    """
    return np.unique(tensor_index(degree), return_index=True)[1]
