# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The least change of shape that brings a body's center of mass to a given point.

Some vertices may move. With the derivative G of the center at the start, the moves v that bring it
there with the least Σ a |v|² / m are v = (m / a) G' λ, with one λ for each coordinate of the
center. Here a is a vertex's equal share of the areas of its faces, so that the resulting shape does
not depend on how finely the mesh is cut, and m ≤ 1 is the vertex's freedom to move. Moves longer
than a limit are cut to it, which is the solution of the same problem with that limit. For G and a,
every face is taken as the fan around its middle, so that its diagonals show in the shape as little
as possible; the center itself is computed from the faces as they are cut.

The center is not a linear function of the moves, so λ is found by Newton's method, with the exact
derivative at every step, until the center is there to rounding. The moves are then least to first
order: moves of the least sum differ by terms of their square. Those are not sought, because on fine
meshes they wrinkle: folds are the cheapest way for a shell to gain area.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..inertia import NO_CERTAIN_VOLUME
from ..mesh import Surface, normals, uncancelled_sides
from ..moments import Moments, U
from ..numerics import (
    Array,
    ArrayLike,
    NDArray,
    check_type,
    float_array,
    index_array,
    sums_by_index,
)
from ..polyhedron import polyhedron_moments
from ..verdict import MeasureError
from ..wall import first_positive_root
from .findings import (
    BALANCE_FOLDS_FACES,
    BALANCE_NO_EFFECT,
    BALANCE_SHORT,
)
from .gradient import area_gradient, volume_gradient

MAX_NEWTON_STEPS = 100  # Limit for Newton's method; it takes a few.
MAX_STEP_HALVINGS = 20  # Limit for one step, until the center comes nearer.
# Rounding relative to the body's size and the distances of it and its target.
REACHED_TOLERANCE = 64.0 * U
MIN_RELATIVE_EFFECT = 1e-12  # Relative to the effect of the most effective direction.
SLIVER_RTOL = 1e-9  # Relative to the longest side squared: smaller triangles have no normal.


@dataclass(frozen=True, eq=False)
class BalanceResult:
    """Moved vertices (n, 3) that bring the center of mass to its target, and the center before and
    after.
    """

    points: Array
    before: Array
    after: Array


def balance(
    surface: Surface,
    movable: ArrayLike,
    target: ArrayLike,
    *,
    across: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    limit: float = np.inf,
    shell: bool = False,
) -> BalanceResult:
    """Move vertices as little as possible so that the center of mass comes to a point.

    Parameters
    ----------
    surface : Surface
    movable : (k,) array_like of int
        The vertices that may move.
    target : (3,) array_like
    across : (r, 3) array_like, optional
        Orthonormal rows: move the center along these directions only; by default all three.
    weights : (k,) array_like, optional
        Above 0 to 1: how freely each vertex moves.
    limit : float
        How far a vertex may move.
    shell : bool
        True if the mass is in the surface, otherwise in the body it bounds, which must be closed.
        Uniform density, and all lengths in one unit.

    Returns
    -------
    BalanceResult

    Raises
    ------
    MeasureError
        If the center cannot come there, or faces would be turned over.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.statics import balance
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> result = balance(surface, np.arange(4), np.array([0.25, 0.25, 0.3]))
    >>> np.round(result.after, 9).tolist()
    [0.25, 0.25, 0.3]
    """
    check_type("surface", surface, Surface)
    across = np.eye(3) if across is None else float_array("across", across, "r", 3)
    movable = index_array("movable", movable, "k", count=len(surface.points))
    weights = (
        np.ones(len(movable)) if weights is None else float_array("weights", weights, len(movable))
    )
    problem = _Problem(surface, shell, across, float_array("target", target, 3))
    fans = _Fans(surface, shell)
    area = fans.areas[movable]
    used = (area > 0.0) & (weights > 0.0)
    if not used.any():
        raise MeasureError(BALANCE_NO_EFFECT)
    movable = movable[used]
    start = problem.evaluate(problem.start)
    if start is None:
        raise MeasureError(NO_CERTAIN_VOLUME)
    before = start.center
    step_directions = np.einsum("ri,nik->rnk", across, fans.center_gradient(before)[movable])
    step_directions *= (weights[used] / area[used])[:, None]
    no_moves = np.zeros(len(across))
    slope = _center_jacobian(step_directions, no_moves, start.gradient[:, movable], np.inf)
    if not _is_solvable(slope):
        raise MeasureError(BALANCE_NO_EFFECT)
    points, center, far = _newton_solve(problem, start, step_directions, movable, np.inf)
    far_within_limit = far
    if far or np.linalg.norm(points - problem.start, axis=1).max() > limit:
        points, center, far_within_limit = _newton_solve(
            problem, start, step_directions, movable, limit
        )
    if far_within_limit:
        distance = float(far or far_within_limit)
        raise MeasureError(BALANCE_SHORT, distance=distance, limit=float(limit))
    problem.check(points, movable)
    return BalanceResult(points, before, center)


class _State(NamedTuple):
    """The (3,) center of a surface, its (r,) distances from the target, and their (r, n, 3)
    derivatives by the points, with the opposite sign.
    """

    center: Array
    residual: Array
    gradient: Array


class _Iterate(NamedTuple):
    """Moved points (n, 3), their (r,) multiplier and state, and the (r, r) derivative of the center
    by the multiplier.
    """

    points: Array
    multiplier: Array
    state: _State
    slope: Array


def _newton_solve(
    problem: _Problem, start: _State, step_directions: NDArray, movable: NDArray, limit: float
) -> tuple[Array, Array, float]:
    """Return (n, 3) points, the (3,) center, and its remaining distance from its target, 0 if
    reached.

    step_directions: (r, k, 3) moves of the (k,) movable vertices for each unit of the (r,)
    multiplier. limit: of each vertex's move.
    """
    multiplier = np.zeros(len(step_directions))
    slope = _center_jacobian(step_directions, multiplier, start.gradient[:, movable], limit)
    current = _Iterate(problem.start, multiplier, start, slope)
    least = problem.tolerance
    for _ in range(MAX_NEWTON_STEPS):
        if np.linalg.norm(current.state.residual) <= problem.tolerance:
            break
        following = _newton_step(problem, current, step_directions, movable, limit)
        if following is None:  # rounding may keep the center a little beyond the tolerance
            least = 16.0 * problem.tolerance
            break
        current = following
    far = float(np.linalg.norm(current.state.residual))
    return current.points, current.state.center, far if far > least else 0.0


def _newton_step(
    problem: _Problem, current: _Iterate, step_directions: NDArray, movable: NDArray, limit: float
) -> _Iterate | None:
    """Return the iterate after a step of Newton's method, which is halved until the center comes
    nearer; None if it does not.
    """
    far = float(np.linalg.norm(current.state.residual))
    change = np.linalg.solve(current.slope, current.state.residual)
    share = 1.0
    for _ in range(MAX_STEP_HALVINGS):
        multiplier = current.multiplier + share * change
        points = problem.start.copy()
        points[movable] += _limited_moves(step_directions, multiplier, limit)
        state = problem.evaluate(points)
        # A full step should leave no distance; a tenth of the progress is enough.
        if state is not None and np.linalg.norm(state.residual) <= (1.0 - 0.1 * share) * far:
            gradient = state.gradient[:, movable]
            slope = _center_jacobian(step_directions, multiplier, gradient, limit)
            # If too many moves are at the limit, there is no step from there.
            if _is_solvable(slope) or np.linalg.norm(state.residual) <= problem.tolerance:
                return _Iterate(points, multiplier, state, slope)
        share /= 2.0
    return None


def _is_solvable(system: NDArray) -> bool:
    """Return whether the (r, r) system can be solved, because every direction has an effect."""
    strength = np.linalg.svd(system, compute_uv=False)
    return bool(np.isfinite(strength).all() and strength[-1] > MIN_RELATIVE_EFFECT * strength[0])


def _limited_moves(step_directions: NDArray, multiplier: NDArray, limit: float) -> Array:
    """Return (k, 3) moves: (r, k, 3) step directions times the (r,) multiplier, each cut to the
    limit.
    """
    moves = np.einsum("rnk,r->nk", step_directions, multiplier)
    length = np.linalg.norm(moves, axis=1)
    if not (length > limit).any():  # also if there is no limit
        return moves
    return moves * (limit / np.maximum(length, limit))[:, None]


def _center_jacobian(
    step_directions: NDArray, multiplier: NDArray, gradient: NDArray, limit: float
) -> Array:
    """Return the (r, r) derivative of the center by the multiplier; moves cut to the limit can turn
    but not grow.

    gradient: (r, k, 3) of the center's coordinates by the movable vertices.
    """
    if np.isfinite(limit):
        moves = np.einsum("rnk,r->nk", step_directions, multiplier)
        length = np.linalg.norm(moves, axis=1)
        along = moves / np.where(length > 0.0, length, 1.0)[:, None]
        radial = np.einsum("rnk,nk->rn", step_directions, along)[:, :, None] * along
        step_directions = np.where(
            (length > limit)[:, None],
            (step_directions - radial) * (limit / np.maximum(length, limit))[:, None],
            step_directions,
        )
    return np.einsum("rnk,snk->rs", gradient, step_directions)


class _Problem:
    """The center of one surface as a function of its points. across: (r, 3) orthonormal rows along
    which it counts. target: (3,).
    """

    def __init__(self, surface: Surface, shell: bool, across: NDArray, target: NDArray):
        triangles, _ = surface.all_triangles()
        self.triangles = triangles
        self.start = surface.points.astype(np.float64)
        self.surface = Surface(self.start, triangles)
        self.shell = shell
        self.across = across
        self.target = target
        used = self.start[np.unique(triangles)]
        self.size = float(np.linalg.norm(np.ptp(used, axis=0)))
        farthest = max(np.abs(used).max(), np.abs(self.across @ self.target).max())
        self.tolerance = REACHED_TOLERANCE * (self.size + farthest)
        self.sign = 1.0 if shell else float(np.sign(self._moments(self.start).total))

    def _moments(self, points: NDArray) -> Moments:
        volume, area = polyhedron_moments(
            replace(self.surface, points=points), area_order=3 if self.shell else 0, allow_open=True
        )
        return area if self.shell else volume

    def evaluate(self, points: NDArray) -> _State | None:
        """Return the state of moved points, or None if they are inside out."""
        moments = self._moments(points)
        if not moments.total * self.sign > moments.rounding_error[0]:
            return None
        center = moments.center
        derive = area_gradient if self.shell else volume_gradient
        gradient = derive(replace(self.surface, points=points), center)
        # About the center the first moments vanish: its derivative is theirs over the total.
        return _State(
            center,
            self.across @ (self.target - center),
            np.einsum("ri,nik->rnk", self.across, gradient[:, 1:4] / moments.total),
        )

    def check(self, points: NDArray, movable: NDArray) -> None:
        """Raise MeasureError if a triangle turns by a right angle on the straight way to its (n, 3)
        moved points: N(s)·N(0), a quadratic, has a root in [0, 1].
        """
        moved = np.zeros(len(points), bool)
        moved[movable] = True
        triangles = self.triangles[moved[self.triangles].any(axis=1)]
        a, b, c = (self.start[triangles[:, k]] for k in range(3))
        u, v, w = (points[triangles[:, k]] - corner for k, corner in enumerate((a, b, c)))
        edges, turns = (b - a, c - a), (v - u, w - u)
        normal = np.cross(*edges)
        double = np.linalg.norm(normal, axis=1)
        longest = np.max([(edge * edge).sum(axis=1) for edge in (*edges, c - b)], axis=0)
        solid = double > SLIVER_RTOL * longest
        coefficients = (
            normal,
            np.cross(edges[0], turns[1]) + np.cross(turns[0], edges[1]),
            np.cross(*turns),
        )
        jacobian = np.array([(row * normal).sum(axis=1) for row in coefficients])[:, None, solid]
        turn_length = np.sqrt(np.max([(turn * turn).sum(axis=1) for turn in turns], axis=0))
        long = np.sqrt(longest)
        # Products of the lengths in N(s)·N(0), times a bound of its roundings.
        error = (
            32.0
            * U
            * np.array([long * long, 2.0 * long * turn_length, turn_length * turn_length])
            * double
        )
        folded = int(np.count_nonzero(first_positive_root(jacobian, error[:, solid]) <= 1.0))
        if folded:
            raise MeasureError(BALANCE_FOLDS_FACES, count=folded)


class _Fans:
    """Faces as fans around the means of their vertices.

    areas: (n,) each vertex's equal shares of its faces' areas. owner, vertex, share: (p,) face,
    vertex and the vertex's share of the face, of each pair of both. points: (n + f, 3) vertices and
    middles. fan: (t, 3) triangles; opposed: (t,) mask of those that face against their face.
    """

    def __init__(self, surface: Surface, shell: bool):
        triangles, faces = surface.all_triangles()
        self.shell = shell
        self.count = len(surface.points)
        points = surface.points.astype(np.float64)
        face_ids, faces = np.unique(faces, return_inverse=True)
        faces = faces.ravel()
        number = len(face_ids)
        vectors = normals(points, triangles)
        # Each pair of a face and a vertex once, by a key of both.
        key = np.unique(np.repeat(faces, 3) * np.int64(self.count) + triangles.ravel())
        self.owner, self.vertex = key // self.count, key % self.count
        self.share = 1.0 / np.bincount(self.owner)[self.owner]
        area = sums_by_index(faces, np.linalg.norm(vectors, axis=1) / 2.0, number)
        self.areas = sums_by_index(self.vertex, area[self.owner] * self.share, self.count)
        middles = np.stack(
            [
                sums_by_index(self.owner, points[self.vertex, k] * self.share, number)
                for k in range(3)
            ],
            axis=1,
        )
        whole = np.bincount(faces)[faces] == 1  # triangles that are a face
        owners, start, stop = uncancelled_sides(triangles[~whole], faces[~whole])
        fan = np.concatenate(
            [triangles[whole], np.stack([start, stop, self.count + owners], axis=1)]
        )
        owners = np.concatenate([faces[whole], owners])
        self.points = np.concatenate([points, middles])
        facing = np.stack([sums_by_index(faces, column, number) for column in vectors.T], axis=1)
        # Triangles of a fan that face against it, because its face is not convex.
        self.opposed = (normals(self.points, fan) * facing[owners]).sum(axis=1) < 0.0
        self.fan = fan

    def center_gradient(self, center: NDArray) -> Array:
        """Return (n, 3, 3) ∂ center[i] / ∂ vertex[k], each face's middle moving with its
        vertices.
        """
        if self.shell:  # opposed triangles take away area, as in the face that they belong to
            parts = [
                area_gradient(Surface(self.points, triangles), center)[:, 1:4]
                for triangles in (self.fan[~self.opposed], self.fan[self.opposed])
            ]
            gradient = parts[0] - parts[1]
            total = self.areas.sum()
        else:
            surface = Surface(self.points, self.fan)
            gradient = volume_gradient(surface, center)[:, 1:4]
            total = polyhedron_moments(surface)[0].total
        gradient /= total
        vertex_gradient = gradient[: self.count].reshape(-1, 9)
        middle = gradient[self.count :].reshape(-1, 9)
        for column, shared in zip(vertex_gradient.T, middle.T):
            column += sums_by_index(self.vertex, shared[self.owner] * self.share, self.count)
        return vertex_gradient.reshape(-1, 3, 3)
