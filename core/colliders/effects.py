# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The effect of colliders on a body's physics, and masses of colliders, or moves of their corners,
that take it away.

An engine without an explicit inertial sums up its colliders, overlaps counted twice. The sum is
linear in the masses m of the colliders: ten rows of mass, first and second moments, each divided by
the collider's mass. The corrected masses lie nearest to uniform density, by Σ (m - u)² / u with the
masses u of uniform density: the least change of the density in the mean over the volume. If no
masses ≥ 0 have all ten sums, the mass is kept, then the center comes as near as it can, then the
inertia.

The volume and the first and second moments of hulls together are ten functions of their corners,
with exact derivatives. No known convex body has a greater determinant of the covariance, at its
volume, than a tetrahedron, so no hull comes near to a chair. Then the volume is given up and the
nine ratios to it remain, which an affine map alone can meet. Engines are told the mass. The moves
of the corners have the least Σ area |move|², each corner standing for an equal share of its faces'
areas, and each at most the limit. They are found by Gauss and Newton's method with a trust region
for every corner. Each step takes the hulls of the moved corners anew, so that they stay convex: a
face that folds one way has other derivatives than if it folds the other way, so after a failed step
the mean of both is tried.
"""

from collections.abc import Generator, Sequence
from dataclasses import replace
from math import sqrt

import numpy as np

from ..inertia import MassProperties
from ..mesh import ConvexHull, Surface, convex_hull, triangle_areas
from ..moments import SECOND_MOMENT_INDEX, Moments, monomial_count, monomials
from ..numerics import Array, NDArray, sums_by_index
from ..polyhedron import polyhedron_moments
from ..robots import Effect, Inertial, Pose, Shape, compare, moments_of, ratio
from ..statics import volume_gradient
from ..verdict import MeasureError
from .findings import COLLIDERS_FLAT

SUMS = monomial_count(2)  # mass, first and second moments
DEGREE = monomials(2).sum(axis=1)
# Products, whose powers are at most half of their degree, count twice in the norm of a tensor.
IN_NORM = np.where((DEGREE > 0) & (monomials(2).max(axis=1) * 2 == DEGREE), np.sqrt(2.0), 1.0)
# Weight of sums that are held, beside 1 of other sums. Repetition takes away the effect of the
# other sums on those that are held.
HELD_WEIGHT = 30.0
NEARNESS = 1e-5  # weight of the nearness to the wish, beside the sums
REPETITIONS = 40
# Relative to the body's mass and size: smaller deviations of the sums are rounding, or reached.
ROUNDING = 1e-15
REACHED = 1e-11
MOVES_REACHED = 1e-8  # relative to the body's volume and size, as precise as single precision
NEAR = 1e-6  # Like MOVES_REACHED: farther from the sums, the volume is given up.
MAX_STEPS, MAX_MULTIPLIER_STEPS = 60, 60
# radii of the trust region, in the body's radii of gyration
FIRST_RADIUS = 0.1
LEAST_RADIUS = 1e-6
MIN_AREA = 1e-3  # relative to the largest share: corners with less move as if they had so much
# Relative to the effect of all moves: it lets sums that cannot be reached be missed.
SLACK = 1e-9
CORRECTING_SHARE = 0.97  # share of the work that is completed when corners are moved
FLAT_RTOL = 3e-7  # a few roundings to single precision
TINY = float(np.finfo(np.float64).tiny)


def effect(body: MassProperties, shapes: Sequence[Shape], volume: float) -> Effect:
    """Compare the sum of colliders, each with its mass and uniform density, with a body and its
    volume.

    MeasureError if the colliders have no mass.
    """
    volumes, rows = _ten_sums(body, shapes)
    sums = rows @ [shape.mass for shape in shapes]
    if not sums[0] > 0.0:
        raise MeasureError(COLLIDERS_FLAT)
    shift = sums[1:4] / sums[0]
    second = sums[SECOND_MOMENT_INDEX] - sums[0] * np.outer(shift, shift)
    inertial = Inertial(
        body.mass, body.center, body.inertia, body.principal.moments, body.principal.axes
    )
    return compare(inertial, float(sums[0]), shift, second, ratio(float(sum(volumes)), volume))


def uniform_masses(density: float, shapes: Sequence[Shape]) -> list[float]:
    """Return the masses of colliders of one density, kg/m³; MeasureError if all of them are flat
    within rounding.
    """
    if all(_is_flat(shape) for shape in shapes):
        raise MeasureError(COLLIDERS_FLAT)
    return [density * float(moments_of(shape).total) for shape in shapes]


def _is_flat(shape: Shape) -> bool:
    """Return whether a collider's least extent is within the rounding of its largest one."""
    extents = np.array(shape.size)
    if shape.surface is not None:
        offsets = shape.surface.points - shape.surface.points.mean(axis=0)
        extents = np.ptp(offsets @ np.linalg.eigh(offsets.T @ offsets)[1], axis=0)
    elif shape.kind == "capsule":  # a sphere if it has no length
        extents = extents[:1]
    return bool(extents.min() <= FLAT_RTOL * extents.max())


def correct_masses(body: MassProperties, shapes: Sequence[Shape]) -> list[float]:
    """Return the masses ≥ 0 nearest to uniform density with the body's mass, center and inertia, or
    near to them.

    MeasureError if the colliders have no volume, or the body has no mass.
    """
    volumes, rows = _ten_sums(body, shapes)
    if not sum(volumes) > 0.0 or not body.mass > 0.0:
        raise MeasureError(COLLIDERS_FLAT)
    weights = np.sqrt(volumes / sum(volumes))
    second = body.inertia.trace() / 2.0 * np.eye(3) - body.inertia
    target = np.zeros(SUMS)
    target[0] = 1.0
    target[SECOND_MOMENT_INDEX] = second / body.mass
    # The radius of gyration, or that of the farthest collider: xx, yy and zz are rows 4, 7 and 9.
    size = sqrt(max(float(rows[[4, 7, 9]].sum(axis=0).max()), float(second.trace()) / body.mass))
    units = IN_NORM / size**DEGREE
    # The unknowns are shares of the mass over the weights; at uniform density they are the weights.
    rows = rows * weights * units[:, None]
    target = target * units
    roots, off = _nearest(rows, target, SUMS, weights)
    if off > REACHED:
        # Not all sums can be met. Hold the mass and the center (4 sums) if these can be met, else
        # the mass and the nearest center.
        center_roots, off = _nearest(rows[:4], target[:4], 4, weights)
        if off > REACHED:
            center_roots, _ = _nearest(rows[:4], target[:4], 1, weights)
            target[1:4] = rows[1:4] @ center_roots
        roots, _ = _nearest(rows, target, 4, weights)
    shares = weights * roots
    return (body.mass / shares.sum() * shares).tolist()


def _ten_sums(body: MassProperties, shapes: Sequence[Shape]) -> tuple[Array, Array]:
    """Return (n,) volumes of colliders, and (10, n) moments divided by these, about the body's
    center; zero for flat colliders.
    """
    moments = [moments_of(shape).truncate(2) for shape in shapes]
    volumes = np.array([float(solid.total) for solid in moments])
    raw = np.array([solid.about_point(body.center).raw for solid in moments]).reshape(-1, SUMS).T
    return volumes, raw / np.where(volumes > 0.0, volumes, 1.0)


def _nearest(rows: Array, target: Array, held: int, wish: Array) -> tuple[Array, float]:
    """Return (n,) x ≥ 0 nearest to a wish, and the largest deviation of the `held` first rows of
    rows @ x = target.

    The other rows come as near as they can. The method of multipliers adds the deviation of the
    held rows to the target.
    """
    weights = np.where(np.arange(len(rows)) < held, HELD_WEIGHT, 1.0)
    system = np.concatenate([rows * weights[:, None], NEARNESS * np.eye(len(wish))])
    wanted = target.copy()
    x = wish
    off = np.inf
    for _ in range(REPETITIONS):
        x = _nonnegative(system, np.concatenate([wanted * weights, NEARNESS * wish]), x)
        missing = (target - rows @ x)[:held]
        off = float(np.abs(missing).max())
        if off <= ROUNDING:
            break
        wanted[:held] += missing
    return x, off


def _nonnegative(system: Array, target: Array, x: NDArray) -> Array:
    """Return (n,) x ≥ 0 with the least |system @ x - target| (Lawson and Hanson 1974), from a start
    ≥ 0.

    The columns must be independent. Free entries take their best values; the others are 0.
    """
    size = len(x)
    x = x.copy()
    free = x > 0.0
    largest = float(np.abs(system).sum(axis=0).max()) * float(np.abs(target).max())
    noise = 64.0 * np.finfo(float).eps * largest
    for _ in range(10 * size + 10):
        while True:
            # The best values of the free entries; if some of them are below 0, a step toward them
            # that ends where the first entry is 0, and no longer free.
            best = np.zeros(size)
            best[free] = np.linalg.lstsq(system[:, free], target, rcond=None)[0]
            if not (best[free] <= 0.0).any():
                break
            falls = free & (best <= 0.0)
            step = (x[falls] / np.maximum(x[falls] - best[falls], np.finfo(float).tiny)).min()
            x = x + step * (best - x)
            at_zero = falls & (x <= np.finfo(float).eps * np.abs(x).max())
            free &= ~at_zero
            x[~free] = 0.0
        x = best
        # The entry at 0 whose growth lowers the sum of squares most becomes free.
        gain = np.where(free, -np.inf, system.T @ (target - system @ x))
        entering = int(gain.argmax())
        if gain[entering] <= noise:
            break
        free[entering] = True
    return x


def correct_vertices(
    body: MassProperties, shapes: Sequence[Shape], surface: Surface, outward: float, inward: float
) -> Generator[float, None, list[Shape]]:
    """Move corners of hulls as little as possible so that uniform density gives mass, center and
    inertia of a body, in steps that yield the completed share.

    The density is the body's if it can be, else another that gives the mass. No corner moves
    farther than the smaller tolerance, in m; if that does not suffice, the result comes as near to
    the body as it is found to come. Primitives stay as they are. surface: the body's. MeasureError
    if it has no volume.
    """
    meshes = {
        place: shape.surface for place, shape in enumerate(shapes) if shape.surface is not None
    }
    if not meshes:
        return list(shapes)
    fixed = [moments_of(shape) for shape in shapes if shape.surface is None]
    parts = [
        shapes[place].pose.apply(mesh.points * shapes[place].size) for place, mesh in meshes.items()
    ]
    try:
        volume = polyhedron_moments(surface)[0].total
    except MeasureError:  # an open sheet encloses nothing
        volume = 0.0
    if not volume > 0.0:
        volume = sum(float(moments_of(shape).total) for shape in shapes)
    if not volume > 0.0:
        raise MeasureError(COLLIDERS_FLAT)
    hulls = _Hulls(body, volume, parts, fixed)
    points, off = yield from _solve(hulls, min(outward, inward) / hulls.size)
    if off > NEAR:
        hulls.is_density_free = True
        points, _ = yield from _solve(hulls, min(outward, inward) / hulls.size)
    result = list(shapes)
    for place, hull in zip(meshes, hulls.take(points)):
        moved = Surface(hulls.size * hull.points + body.center, hull.triangles)
        result[place] = replace(shapes[place], size=(1.0, 1.0, 1.0), pose=Pose(), surface=moved)
    return result


class _Hulls:
    """The ten sums of hulls as functions of all their corners, relative to the body's volume, or to
    their own.

    Lengths are in radii of gyration of the body, `size`, from its center. start: (n, 3) corners
    before they move; those of hull i begin at starts[i]. fixed: sums of colliders that do not move.
    is_density_free: whether sums are relative to the colliders' own volume.
    """

    is_density_free = False

    def __init__(
        self, body: MassProperties, volume: float, parts: list[NDArray], fixed: list[Moments]
    ) -> None:
        second = (body.inertia.trace() / 2.0 * np.eye(3) - body.inertia) / body.mass
        self.size = sqrt(float(second.trace()))
        self.start = (np.concatenate(parts) - body.center) / self.size
        self.starts = np.cumsum([0, *(len(part) for part in parts)])
        self.density = self.size**3 / volume
        self.target = np.zeros(SUMS)
        self.fixed = np.zeros(SUMS)
        self.target[0] = 1.0
        self.target[SECOND_MOMENT_INDEX] = second / self.size**2
        for moments in fixed:
            self.fixed += moments.about_point(body.center).raw[:SUMS] / (volume * self.size**DEGREE)

    def take(self, points: Array) -> list[ConvexHull]:
        """Return the hulls of moved corners. MeasureError if one has no volume."""
        return [convex_hull(part) for part in np.split(points, self.starts[1:-1])]

    def evaluate(self, points: Array) -> tuple[NDArray, NDArray, NDArray]:
        """Return the (10,) sums that are missing, (10, n, 3) derivatives of the sums and, for each
        of the (n,) corners, the areas of its faces.
        """
        sums = np.zeros(SUMS)
        gradient = np.zeros((SUMS, *points.shape))
        areas = np.zeros(len(points))
        for first, hull in zip(self.starts, self.take(points)):
            surface = Surface(hull.points, hull.triangles)
            places = first + hull.indices
            sums += polyhedron_moments(surface, about=np.zeros(3))[0].raw[:SUMS]
            gradient[:, places] = volume_gradient(surface, np.zeros(3), order=2).transpose(1, 0, 2)
            shares = np.repeat(triangle_areas(hull.points, hull.triangles), 3)
            areas[places] = sums_by_index(hull.triangles.ravel(), shares, len(hull.points))
        sums = self.fixed + self.density * sums
        gradient = self.density * gradient
        if self.is_density_free:  # quotients by the volume, the first sum
            sums, gradient = sums / sums[0], gradient / sums[0]
            gradient -= sums[:, None, None] * gradient[0]
        return self.target - sums, gradient, areas


def _solve(hulls: _Hulls, limit: float) -> Generator[float, None, tuple[Array, float]]:
    """Find the (n, 3) corners that have the body's sums with the least motion, or nearly; return
    them and the norm of the missing sums. Yields the completed share.

    limit: of each corner's move, in units of `hulls.size`.
    """
    moves = np.zeros_like(hulls.start)
    missing, gradient, areas = hulls.evaluate(hulls.start)
    off = float(np.linalg.norm(missing))
    areas = np.maximum(areas, MIN_AREA * areas.max())
    radius = FIRST_RADIUS
    for _ in range(MAX_STEPS):
        if off <= MOVES_REACHED or radius < LEAST_RADIUS:
            break
        yield CORRECTING_SHARE
        # Each corner moves within the largest ball in both its trust region, around its last place,
        # and the limit, around its start. On the line through both centers the ball is as wide as
        # their common part.
        length = np.linalg.norm(moves, axis=1)
        reach = np.minimum(min(radius, limit), (radius + np.maximum(limit - length, 0.0)) / 2.0)
        middle = moves * np.minimum((limit - reach) / np.maximum(length, TINY), 1.0)[:, None]
        wanted = missing + np.einsum("knd,nd->k", gradient, moves)
        trial = _least_moves(gradient, wanted, areas, middle, reach)
        expected = float(np.linalg.norm(wanted - np.einsum("knd,nd->k", gradient, trial)))
        try:
            trial_missing, trial_gradient, _ = hulls.evaluate(hulls.start + trial)
        except MeasureError:  # a hull has become flat
            radius /= 4.0
            continue
        trial_off = float(np.linalg.norm(trial_missing))
        if off - trial_off > 0.1 * (off - expected):
            radius *= 2.0 if off - trial_off > 0.5 * (off - expected) else 1.0
            off = trial_off
            moves = trial
            missing, gradient = trial_missing, trial_gradient
        else:  # the mean of both ways to fold, as in the module's docstring
            gradient = (gradient + trial_gradient) / 2.0
            radius /= 2.0
    return hulls.start + moves, off


def _least_moves(
    rows: NDArray, wanted: NDArray, areas: NDArray, middle: NDArray, reach: NDArray
) -> Array:
    """Return the (n, 3) moves with the least Σ areas |move|² that give Σ rows · moves = wanted,
    each within its ball.

    If there are none, the sums come as near as they can. rows: (10, n, 3); wanted: (10,); middle
    (n, 3) and reach (n,) of the balls. The moves are rows · multipliers / areas, each taken to the
    nearest point of its ball; Newton's method finds the multipliers.
    """
    count = len(rows)
    slack = SLACK * float(np.einsum("knd,knd,n->k", rows, rows, 1.0 / areas).max())

    def judge(multiplier: NDArray) -> tuple[float, NDArray, NDArray, NDArray]:
        """Return the negative dual function, to be minimized; (n, 3) moves; (n,) shares by which
        they are cut to their balls; and (n, 3) unit vectors from the balls' middles.
        """
        free = np.einsum("knd,k->nd", rows, multiplier) / areas[:, None]
        length = np.maximum(np.linalg.norm(free - middle, axis=1), TINY)
        cut = np.minimum(reach / length, 1.0)
        moves = middle + (free - middle) * cut[:, None]
        value = (areas * (moves * (free - moves / 2.0)).sum(axis=1)).sum() - multiplier @ (
            wanted - slack * multiplier / 2
        )
        return float(value), moves, cut, (free - middle) / length[:, None]

    multiplier = np.zeros(count)
    value, moves, cut, along = judge(multiplier)
    for _ in range(MAX_MULTIPLIER_STEPS):
        # The first derivative, and the second: of moves that are cut, without the radial part.
        slope = np.einsum("knd,nd->k", rows, moves) + slack * multiplier - wanted
        spread = (rows * np.sqrt(cut / areas)[:, None]).reshape(count, -1)
        radial = np.einsum("knd,nd->kn", rows, along) * np.sqrt(
            np.where(cut < 1.0, cut, 0.0) / areas
        )
        change = -np.linalg.solve(
            spread @ spread.T - radial @ radial.T + slack * np.eye(count), slope
        )
        share = 1.0
        state = judge(multiplier + change)
        while share > LEAST_RADIUS and not state[0] <= value + 1e-4 * share * float(slope @ change):
            share /= 2.0
            state = judge(multiplier + share * change)
        if not state[0] < value:
            break
        multiplier = multiplier + share * change
        value, moves, cut, along = state
    return moves
