# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The least motion of hulls' corners that gives colliders of uniform density the mass properties of a body.

The volume and the first and second moments of the hulls together are ten functions of the corners, with exact
derivatives. The moves have the least Σ area |move|², each corner standing for an equal share of its faces' areas, and
each at most the limit. They are found by Gauss and Newton's method with a trust region for every corner. Each step
takes the hulls of the moved corners anew, so that they stay convex: a face that folds one way has other derivatives
than if it folds the other way, so after a failed step the mean of both is tried.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ..inertia.mass_properties import MassProperties
from ..mesh.hulls import ConvexHull, convex_hull
from ..mesh.surface import Surface, triangle_areas
from ..moments.exponents import monomial_count, monomials
from ..moments.moments import SECOND_MOMENT_INDEX, Moments
from ..numerics.arrays import sums_by_index
from ..polyhedron.integration import polyhedron_moments
from ..robots.model import Pose, Shape
from ..robots.shapes import moments_of
from ..statics.gradient import volume_gradient
from ..verdict.finding import MeasureError

SUMS = monomial_count(2)
DEGREE = monomials(2).sum(axis=1)
REACHED = 1e-10  # of the body's volume and size
MAX_STEPS, MAX_MULTIPLIER_STEPS = 60, 60
FIRST_RADIUS, LEAST_RADIUS = 0.1, 1e-6  # of the trust region, in the body's radii of gyration
MIN_AREA = 1e-3  # of the largest share: corners with less move as if they had so much
SLACK = 1e-9  # of the effect of all moves: how far sums that cannot be reached may be from the nearest ones
TINY = float(np.finfo(np.float64).tiny)


def correct_vertices(
    body: MassProperties, shapes: Sequence[Shape], surface: Surface, outward: float, inward: float
) -> list[Shape]:
    """Move corners of hulls as little as possible so that uniform density gives mass, center and inertia of a body.

    No corner moves farther than the smaller tolerance, in m; if that does not suffice, the result comes as near to the
    body as it is found to come. Primitives stay as they are. surface: the body's. MeasureError if it has no volume.
    """
    places = [place for place, shape in enumerate(shapes) if shape.kind == "mesh"]
    if not places:
        return list(shapes)
    fixed = [moments_of(shape) for shape in shapes if shape.kind != "mesh"]
    hulls = _Hulls(body, polyhedron_moments(surface)[0].total, [_corners(shapes[place]) for place in places], fixed)
    result = list(shapes)
    for place, hull in zip(places, hulls.take(_solve(hulls, min(outward, inward) / hulls.size))):
        moved = Surface(hulls.size * hull.points + body.center, hull.triangles)
        result[place] = replace(shapes[place], size=(1.0, 1.0, 1.0), pose=Pose(), surface=moved)
    return result


def _corners(shape: Shape) -> NDArray[np.float64]:
    """Return (n, 3) points of a mesh in the frame of its link."""
    assert shape.surface is not None
    return shape.surface.points * shape.size @ shape.pose.rotation.T + shape.pose.position


class _Hulls:
    """The ten sums of hulls as functions of all their corners, relative to the body's volume.

    Lengths are in radii of gyration of the body, `size`, from its center. start: (n, 3) corners before they move.
    """

    def __init__(self, body: MassProperties, volume: float, parts: list[NDArray], fixed: list[Moments]) -> None:
        second = (body.inertia.trace() / 2.0 * np.eye(3) - body.inertia) / body.mass
        self.size = sqrt(float(second.trace()))
        self.start = (np.concatenate(parts) - body.center) / self.size
        self.starts = np.cumsum([0, *(len(part) for part in parts)])
        self.density = self.size**3 / volume
        self.target = np.zeros(SUMS)
        self.target[0] = 1.0
        self.target[SECOND_MOMENT_INDEX] = second / self.size**2
        for moments in fixed:
            self.target -= moments.about_point(body.center).raw[:SUMS] / (volume * self.size**DEGREE)

    def take(self, points: NDArray[np.float64]) -> list[ConvexHull]:
        """Return the hulls of moved corners. MeasureError if one has no volume."""
        return [convex_hull(part) for part in np.split(points, self.starts[1:-1])]

    def evaluate(self, points: NDArray[np.float64]) -> tuple[NDArray, NDArray, NDArray]:
        """Return the (10,) sums that are missing, (10, n, 3) derivatives of the sums and (n,) areas of corners."""
        sums, gradient, areas = np.zeros(SUMS), np.zeros((SUMS, *points.shape)), np.zeros(len(points))
        for first, hull in zip(self.starts, self.take(points)):
            surface, places = Surface(hull.points, hull.triangles), first + hull.indices
            sums += polyhedron_moments(surface, about=np.zeros(3))[0].raw[:SUMS]
            gradient[:, places] = volume_gradient(surface, np.zeros(3), order=2).transpose(1, 0, 2)
            shares = np.repeat(triangle_areas(hull.points, hull.triangles), 3)
            areas[places] = sums_by_index(hull.triangles.ravel(), shares, len(hull.points))
        return self.target - self.density * sums, self.density * gradient, areas


def _solve(hulls: _Hulls, limit: float) -> NDArray[np.float64]:
    """Return the (n, 3) corners that have the body's sums with the least motion, or nearly have them."""
    moves, (missing, gradient, areas) = np.zeros_like(hulls.start), hulls.evaluate(hulls.start)
    areas = np.maximum(areas, MIN_AREA * areas.max())
    radius = FIRST_RADIUS
    for _ in range(MAX_STEPS):
        off = float(np.linalg.norm(missing))
        if off <= REACHED or radius < LEAST_RADIUS:
            break
        # Each corner moves within a ball that is in its trust region and within the limit.
        length = np.linalg.norm(moves, axis=1)
        reach = np.minimum(min(radius, limit), (radius + np.maximum(limit - length, 0.0)) / 2.0)
        middle = moves * np.minimum((limit - reach) / np.maximum(length, TINY), 1.0)[:, None]
        wanted = missing + np.einsum("knd,nd->k", gradient, moves)
        trial = _least_moves(gradient, wanted, areas, middle, reach)
        expected = float(np.linalg.norm(wanted - np.einsum("knd,nd->k", gradient, trial)))
        try:
            state = hulls.evaluate(hulls.start + trial)
        except MeasureError:
            radius /= 4.0
            continue
        gain = off - float(np.linalg.norm(state[0]))
        if gain > 0.1 * (off - expected):
            moves, (missing, gradient, _) = trial, state
            radius *= 2.0 if gain > 0.5 * (off - expected) else 1.0
        else:
            gradient = (gradient + state[1]) / 2.0
            radius /= 2.0
    return hulls.start + moves


def _least_moves(
    rows: NDArray[np.float64],
    wanted: NDArray[np.float64],
    areas: NDArray[np.float64],
    middle: NDArray[np.float64],
    reach: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return (n, 3) moves in balls with the least Σ areas |move|², so that (10, n, 3) rows · moves = (10,) wanted.

    If there are none, the sums come as near as they can. middle: (n, 3) and reach: (n,) of the balls. The moves are
    rows · multipliers / areas, each taken to the nearest point of its ball; Newton's method finds the multipliers.
    """
    count = len(rows)
    slack = SLACK * float(np.einsum("knd,knd,n->k", rows, rows, 1.0 / areas).max())

    def judge(multiplier: NDArray) -> tuple[float, NDArray, NDArray, NDArray]:
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
        slope = np.einsum("knd,nd->k", rows, moves) + slack * multiplier - wanted
        spread = (rows * np.sqrt(cut / areas)[:, None]).reshape(count, -1)
        radial = np.einsum("knd,nd->kn", rows, along) * np.sqrt(np.where(cut < 1.0, cut, 0.0) / areas)
        change = -np.linalg.solve(spread @ spread.T - radial @ radial.T + slack * np.eye(count), slope)
        share, state = 1.0, judge(multiplier + change)
        while share > LEAST_RADIUS and not state[0] <= value + 1e-4 * share * float(slope @ change):
            share /= 2.0
            state = judge(multiplier + share * change)
        if not state[0] < value:
            break
        multiplier = multiplier + share * change
        value, moves, cut, along = state
    return moves
