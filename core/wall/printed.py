# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The core of a printed body: the surface behind its walls, top and bottom layers.

A face with the normal n moves inward by the larger of two distances: the width of the walls times
the horizontal part of n, and the height of the top or bottom layers times its vertical part (z is
the direction of the print). So walls keep their width in each layer, and layers their height.
Vertices follow the planes of their faces, by least squares if there are more than three. Where two
sides are nearer to each other than their walls are thick, the core is empty (`moved_faces`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..mesh import Surface, tree_of_all, triangle_areas
from ..numerics import Array, Integers, NDArray
from ..verdict import ReadError
from .directions import (
    LEAST_SQUARES_RTOL,
    SAME_PLANE_RTOL,
    UNEVEN_RTOL,
    corner_geometry,
    weld_equal,
)
from .findings import PRINT_UNFIT
from .moved_faces import part_behind

MAX_SAMPLED = 20_000  # with more triangles, only the middle of each is sampled
SAMPLES = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / [[3.0], [6.0], [6.0], [6.0]]
LEAST_FACING = 0.5  # least cosine between the normals of opposite sides, one of them reversed
ALWAYS = 5_000  # with fewer triangles, samples may miss thin places: `part_behind` looks always


class PrintCore(NamedTuple):
    """The surface of a core; its signed volume is not positive if there is none.

    minimum, maximum: the least and largest move of a face at a corner, over its intended move.
    misplaced: the volume that unequal moves add; or, if larger, the first moment that they move,
    over the size of the body.
    """

    surface: Surface
    minimum: float
    maximum: float
    misplaced: float


def find_core(surface: Surface, wall: float, top: float, bottom: float) -> PrintCore:
    """Return the core of a printed body.

    surface: closed, with faces outward, its z upward in the print. wall: the width of the walls;
    top, bottom: the heights of the layers below faces that face up, and above those that face
    down. Raises MeasureError.
    """
    points, triangles = weld_equal(surface)
    corners = points[triangles]
    normals, angles, _, has_normal = corner_geometry(corners)  # slivers have none
    layers = np.where(normals[:, 2] > 0.0, top, bottom) * np.abs(normals[:, 2])
    sideways = wall * np.hypot(normals[:, 0], normals[:, 1])
    moves = np.where(has_normal, np.maximum(sideways, layers), 0.0)
    weights = np.where(has_normal[:, None], angles, 0.0)
    steps = _steps(len(points), triangles, normals, weights, moves)
    depths = np.einsum("mi,mki->mk", normals, steps[triangles])
    ratios = depths[moves > 0.0] / moves[moves > 0.0, None]
    unequal = triangle_areas(points, triangles) * (depths.mean(axis=1) - moves)
    ways = corners.mean(axis=1) - points.mean(axis=0)
    shifted = float(np.linalg.norm(unequal @ ways)) / float(np.ptp(points, axis=0).max())
    core = Surface(points - steps, triangles)
    least = float(ratios.min(initial=1.0))
    if len(triangles) < ALWAYS or _meet(
        corners[has_normal], normals[has_normal], moves[has_normal]
    ):
        nearest = wall * least, top * least, bottom * least
        core = part_behind(points, core.points, triangles, nearest)
        if core is None:
            raise ReadError(
                PRINT_UNFIT, fault="it has too many faces near each other. Use Decimate"
            )
    return PrintCore(
        core, least, float(ratios.max(initial=1.0)), max(abs(float(unequal.sum())), shifted)
    )


def _steps(count: int, triangles: Integers, normals: Array, weights: Array, moves: Array) -> Array:
    """Return the (count, 3) inward steps of points whose triangles' planes move.

    normals: (m, 3). weights: (m, 3) angles at the corners. moves: (m,) along the normals.
    """
    corner = triangles.ravel()
    weight = weights.ravel()
    normals = np.repeat(normals, 3, axis=0)
    moves = np.repeat(moves, 3)

    def total(values: NDArray) -> Array:
        """Return the (count,) weighted sums over the corners at each point."""
        return np.bincount(corner, weight * values, count).astype(np.float64)

    system = np.empty((count, 3, 3))
    for i in range(3):
        for j in range(3):
            system[:, i, j] = total(normals[:, i] * normals[:, j])
    right = np.stack([total(moves * column) for column in normals.T], axis=1)
    values, axes = np.linalg.eigh(system)

    def solved(least: float) -> tuple[Array, Array]:
        """Return (count, 3) steps in the axes with eigenvalues above `least`, relative to the
        largest, and (count,) root sums of squared deviations of the moves.
        """
        known = values > least * values[:, 2:]
        inverse = np.where(known, 1.0 / np.where(known, values, 1.0), 0.0)
        steps = np.einsum("nij,nj,nkj,nk->ni", axes, inverse, axes, right)
        off = total((np.einsum("ij,ij->i", normals, steps[corner]) - moves) ** 2)
        return steps, np.sqrt(off)

    steps, off = solved(SAME_PLANE_RTOL)
    rough = off > UNEVEN_RTOL * np.sqrt(total(moves**2))
    if rough.any():
        steps[rough] = solved(LEAST_SQUARES_RTOL)[0][rough]
    return steps


def _meet(corners: Array, normals: Array, moves: Array) -> bool:
    """Return whether two opposite triangles, of (m, 3, 3) corners, meet or pass each other if each
    moves inward by its (m,) move.

    Along the first triangle's normal, the second one's plane comes nearer by its move over the
    cosine between both.
    """
    samples = SAMPLES if len(corners) <= MAX_SAMPLED else SAMPLES[:1]
    starts = np.einsum("sk,mki->msi", samples, corners).reshape(-1, 3)
    triangle = np.repeat(np.arange(len(corners)), len(samples))
    tree = tree_of_all(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    reach = 2.0 * float(moves.max(initial=0.0))
    depth, hit = tree.first_hits(starts - tree.origin, -normals[triangle], reach)
    hit = tree.ids[0, hit] // 3
    facing = -np.einsum("ri,ri->r", normals[triangle], normals[hit])
    near = facing > LEAST_FACING
    triangle, hit = triangle[near], hit[near]
    return bool((moves[triangle] + moves[hit] / facing[near] >= depth[near]).any())
