# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration of one body onto another by their poses, and the residual between them.

The pose leaves as many choices as the body has rotations, and all of them are tried. So are half
turns about the axes, as noise may decide a sign. The residual is measured on the surfaces, in both
directions, so that neither may be a part of the other; if a few points are farther apart than all
points under a better rotation, the other points are skipped. A mirror image is recognized as such:
a reflection fits, and no rotation does.

Flat shapes are turned in their planes, with front on front; the rotations and mirror lines of one
flat shape follow in the same way. Turned by θ about the centroid, a shape's Zernike moments A_nm
get the factor exp(-imθ). So the overlap of two shapes is, as far as these moments see, a
trigonometric polynomial of θ, Re Σ conj(B_nm) A_nm exp(-imθ). Its maxima are the rotations that may
lay one onto the other; the outlines decide. With conj(A_nm) the mirror image is turned instead.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import count

import numpy as np

from ..inertia import HALF_TURN_SIGNS, complete_free_axes
from ..moments import Moments, invert_through_point
from ..numerics import Array, NDArray, distinct_arrays
from .symmetries import Symmetry
from .unique_frames import equivalent_frames, undetermined_axes
from .zernike import degrees

# Relative to the size: residuals nearer than this are equal, and the smallest turn is taken.
EQUAL_RESIDUAL_RTOL = 1e-4
MAX_FIT_RTOL = 1e-3  # relative to the size: below, a body lies on the other one
FIRST_COMPARED = 32  # points of each surface that are compared first
# a reflection that leaves less than this share of what rotations leave means a mirror image
MIRROR_SHARE = 0.2
Residual = Callable[[NDArray, int | None], NDArray]
ANGLES = 720  # at which overlaps are sampled
MAX_CANDIDATES = 24  # rotations, the largest overlaps first, that are compared by outlines
NEWTON_STEPS = 8
ROUND_ANGLES = 1.0, 0.1, 0.01  # a shape that all these turns leave is round
MIRROR = np.diag([1.0, -1.0, 1.0])  # in the line y = 0, seen from the front
MAX_AXIS_ORDER = 128  # highest order of an axis that is searched for
FIRST_SAMPLES = 64  # points at most of the first test, which most wrong candidates fail

Distance = Callable[[NDArray], NDArray]
# True if a (3, 3) map, in the plane's axes, takes the shape to itself
Holds = Callable[[NDArray], bool]


@dataclass(frozen=True, eq=False)
class RigidMatch:
    """The placement of one body on another.

    `rotation`: (3, 3) about the centers.
    `max_distance`, `mean_distance`: distances of points of either surface from the other one.
    `is_mirror_image`: True if a reflection fits so much better that the bodies are mirror images.
    """

    rotation: Array
    max_distance: float
    mean_distance: float
    is_mirror_image: bool


def match(source: Moments, target: Moments, residual: Residual, size: float) -> RigidMatch:
    """Find the rotation that lays one body onto another, both about their centers.

    source, target: central moments, to the order of a pose. residual: (map, count) to (n,)
    distances that an orthogonal (3, 3) map of the source leaves: of all points if count is None,
    otherwise of about `count` points. size: the target's.
    """
    source_frame = equivalent_frames(source).frames[0]

    def maps(mirrored: bool) -> Array:
        """Return (k, 3, 3) rotations, or reflections, that may lay one body onto the other."""
        alike = equivalent_frames(invert_through_point(target) if mirrored else target)
        turned = (alike.frames[:, None] * HALF_TURN_SIGNS[:, None, :]).reshape(-1, 3, 3)
        free = undetermined_axes(alike.revolution_axes)
        frames = np.array([complete_free_axes(frame, free, source_frame) for frame in turned])
        return distinct_arrays(frames @ source_frame.T, 1e-9) * (-1.0 if mirrored else 1.0)

    return _best_match(maps, residual, size)


def _best_match(maps: Callable[[bool], NDArray], residual: Residual, size: float) -> RigidMatch:
    """Return the best of the rotations `maps(False)`, and whether the reflections `maps(True)` fit
    much better.
    """
    rotation, distances = _best_map(maps(False), residual, size)
    largest = float(distances.max())
    is_mirror_image = False
    if largest > MAX_FIT_RTOL * size:
        _, mirrored_distances = _best_map(maps(True), residual, size)
        is_mirror_image = bool(mirrored_distances.max() < MIRROR_SHARE * largest)
    return RigidMatch(rotation, largest, float(distances.mean()), is_mirror_image)


def _best_map(candidates: NDArray, residual: Residual, size: float) -> tuple[NDArray, NDArray]:
    """Return the map with the least residual among (k, 3, 3) maps, and its distances; of equal
    residuals, the smallest turn.
    """
    # A few points give a lower bound of each residual. All points are compared in the order of the
    # bounds, until one is above the least residual.
    bounds = np.array([residual(candidate, FIRST_COMPARED).max() for candidate in candidates])
    residuals = np.full(len(candidates), np.inf)
    distances = {}
    for i in np.argsort(bounds, kind="stable"):
        if bounds[i] > residuals.min() + EQUAL_RESIDUAL_RTOL * size:
            break
        distances[i] = residual(candidates[i], None)
        residuals[i] = distances[i].max()
    equal = np.flatnonzero(residuals <= residuals.min() + EQUAL_RESIDUAL_RTOL * size)
    best = max(equal, key=lambda i: np.trace(candidates[i]))
    return candidates[best], distances[best]


def match_flat(
    source: NDArray, target: NDArray, axes: tuple[NDArray, NDArray], residual: Residual, size: float
) -> RigidMatch:
    """Find the rotation that lays one flat shape onto another, about their centroids and front on
    front.

    `source` and `target` are the `disc_zernike` of both to one order, in discs of one radius,
    `axes` those of their planes: x, y and the normal as columns. `residual` is as for `match`;
    `size` is the target's.
    """
    source_axes, target_axes = axes

    def maps(mirrored: bool) -> Array:
        """Return (k, 3, 3) maps that may lay one shape, or its mirror image, onto the other."""
        turns = turns_about_normal(_best_angles(source.conj() if mirrored else source, target))
        return target_axes @ turns @ (MIRROR if mirrored else np.eye(3)) @ source_axes.T

    return _best_match(maps, residual, size)


def flat_symmetry(
    zernike: NDArray, order: int, points: NDArray, axes: NDArray, holds: Holds
) -> Symmetry:
    """Find the rotations about its centroid and the mirror lines of a flat shape: Cn or Cnv, C∞v if
    it is round.

    Rotations are about the normal, mirror planes across the plane. `zernike` is the `disc_zernike`
    to `order`, `points` are the (n, 2) outlines, both about the centroid. `axes` are the plane's x,
    y and normal as columns. `holds` returns True if a map of these axes takes the shape to itself.
    """
    if all(holds(turn) for turn in turns_about_normal(np.array(ROUND_ANGLES))):
        operations = np.array([np.eye(3), MIRROR])
        return Symmetry(axes @ operations @ axes.T, axes[:, 2][None], order)
    # The tolerance may let one turn by nearly the right angle pass, but not its multiples.
    fold = next(
        n
        for n in range(MAX_AXIS_ORDER, 0, -1)
        if all(
            holds(turn) for turn in turns_about_normal(2.0 * np.pi / n * np.arange(1, n // 2 + 1))
        )
    )
    operations = turns_about_normal(2.0 * np.pi / fold * np.arange(fold))
    mirror = next(filter(holds, _mirrors(zernike, points)), None)
    if mirror is not None:
        operations = np.concatenate([operations, operations @ mirror])
    return Symmetry(axes @ operations @ axes.T, np.empty((0, 3)), order)


def holds_by_outline(points: NDArray, distance: Distance, tolerance: float) -> Holds:
    """Return a test that images of (n, 3) points, about the centroid, are within the tolerance of
    the outline.
    """
    sample = points[:: 1 + len(points) // FIRST_SAMPLES]

    def holds(operation: NDArray) -> bool:
        return all((distance(part @ operation.T) <= tolerance).all() for part in (sample, points))

    return holds


def holds_by_moments(zernike: NDArray, order: int, tolerance: float) -> Holds:
    """Return a test that the image's moments differ from the shape's by at most `tolerance` of
    their norm.
    """
    m = np.array([m for _, m in degrees(order)])
    size = np.linalg.norm(zernike)

    def holds(operation: NDArray) -> bool:
        angle = np.arctan2(operation[1, 0], operation[0, 0])
        image = zernike if np.linalg.det(operation[:2, :2]) > 0.0 else zernike.conj()
        return bool(np.linalg.norm(image * np.exp(-1j * m * angle) - zernike) <= tolerance * size)

    return holds


def turns_about_normal(angles: NDArray) -> Array:
    """Return (k, 3, 3) rotations about the third axis."""
    turns = np.zeros((len(angles), 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles)
    turns[:, 1, 0] = np.sin(angles)
    turns[:, 0, 1] = -turns[:, 1, 0]
    turns[:, 2, 2] = 1.0
    return turns


def _mirrors(zernike: NDArray, points: NDArray) -> Array:
    """Return (k, 3, 3) reflections that may take a shape to itself: by moments, and those that take
    its first outermost corner to another one.
    """
    radius = np.hypot(*points.T)
    corner_angles = np.arctan2(*points[radius > (1.0 - 1e-4) * radius.max()].T[::-1])
    _, distinct = np.unique(np.round(corner_angles, 5), return_index=True)
    corner_angles = corner_angles[distinct[: 2 * MAX_AXIS_ORDER]]
    # A mirror image in y = 0, turned by the sum of two angles, has the first at the second.
    angles = np.concatenate(
        [_best_angles(zernike.conj(), zernike), corner_angles[0] + corner_angles]
    )
    return turns_about_normal(angles) @ MIRROR


def _best_angles(source: NDArray, target: NDArray) -> Array:
    """Return the (k,) angles of the largest overlap of the turned source with the target, the
    largest first.

    source, target: `disc_zernike` to one order, which follows from their number.
    """
    order = next(n for n in count() if len(degrees(n)) == len(source))
    m = np.array([m for _, m in degrees(order)])
    terms = target.conj() * source
    weights = np.array([terms[m == k].sum() for k in range(order + 1)])

    def derivative(angle: NDArray, times: int) -> NDArray:
        """Return the overlap at (k,) angles, derived so many times."""
        powers = (-1j * np.arange(order + 1)) ** times
        return (
            weights * powers * np.exp(-1j * np.multiply.outer(angle, np.arange(order + 1)))
        ).real.sum(axis=1)

    angles = 2.0 * np.pi / ANGLES * np.arange(ANGLES)
    overlap = derivative(angles, 0)
    peaks = np.flatnonzero((overlap >= np.roll(overlap, 1)) & (overlap >= np.roll(overlap, -1)))
    peaks = peaks[np.argsort(-overlap[peaks], kind="stable")][:MAX_CANDIDATES]
    angles = angles[peaks]
    for _ in range(NEWTON_STEPS):
        slope = derivative(angles, 1)
        bend = derivative(angles, 2)
        step = np.where(bend < 0.0, -slope / np.where(bend < 0.0, bend, 1.0), 0.0)
        angles = angles + np.clip(step, -np.pi / ANGLES, np.pi / ANGLES)
    return np.asarray(angles, np.float64)
