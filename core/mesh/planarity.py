# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that are not flat, and faces without area.

A face that is not flat has no volume under it until somebody chooses its diagonals. For a quad the two choices differ
by the tetrahedron of its corners, |(b-a)·((c-a)×(d-b))|/6; for a polygon the fan from its first corner differs from
the fan from its second by the tetrahedra on their common edge and each further one. A face counts as not flat where
its diagonals pass each other by more than its coordinates' own errors and a millionth of its size, and it has an area.

The sums over the faces have most of that at hand, and show it to a `Witness`, a block at a time. The normal of a quad
is the sum of those of its two triangles: with their lengths p and q at most p + q, and at least 0.7 of that unless they
face away from each other. Mostly that is enough to decide; the other faces are looked at one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..numerics.vectors import cross, dot
from .edges import mesh_faces
from .surface import Surface

BLOCK = 1 << 14
FLAT = 1e-6  # of the square root of a face's area
NO_AREA = 1e-12  # of a face's size, for float64 points
NONE = np.empty(0, np.intp)
QUAD, TRIANGLE = ((2, 0), (3, 1), (1, 0)), ((1, 0), (2, 0))  # corners (i, j) whose differences i - j are taken


@dataclass(frozen=True, eq=False)
class Flatness:
    """not_flat: how many faces are not; spread: the volume that the choice of their diagonals can change;
    without_area: (k,) the faces that have none."""

    not_flat: int
    spread: float
    without_area: NDArray[np.integer]


@dataclass(frozen=True, eq=False)
class _Seen:
    """Of some quads or triangles: how many; how many of them are surely not flat, and 6 times their spread; and the
    rows of those that have to be looked at."""

    count: int
    bent: int
    spread: float
    unsure: NDArray[np.intp]


class Witness:
    """Quads, and polygons where the surface has the mesh's corners to tell their rings from; other faces are made of
    triangles and have no choice.

    error: (length) how far the points may be from where they were meant. Safe in threads.
    """

    def __init__(self, surface: Surface, error: float):
        self.surface, self.error = surface, error
        low, high = surface.box
        size = float((high - low).max())
        self.narrow = 2.0 * np.sqrt(_narrow(3.0 * size * size, error))  # no face is longer than √3 times that
        self.quads: dict[int, _Seen] = {}
        self.triangles: dict[int, _Seen] = {}
        # What is looked at one by one is brought to about size 1, lest sixth powers of small lengths underflow.
        self.exponent = int(np.frexp(max(size, float(np.finfo(np.float32).tiny)))[1])

    def see_quads(self, start: int, lengths: NDArray, volume: NDArray, folded: NDArray[np.intp], room: NDArray) -> None:
        """Those from row `start` on.

        lengths: (2, k) of the normals of both triangles, or 0. volume: (k,) 6 times that of the tetrahedron of the
        corners, to be written over. folded: those of the k where the triangles may face away from each other.
        room: (2, k).
        """
        volume, normal = np.abs(volume, out=volume), np.add(lengths[0], lengths[1], out=room[0])
        least, most = normal.min(), normal.max()
        bent = volume > np.multiply(normal, 8.0 * self.error + FLAT * np.sqrt(most), out=room[1])
        narrow = NONE
        if least <= self.narrow or len(folded):
            normal[folded] = 0.0
            narrow = np.flatnonzero(normal <= self.narrow)
            bent[narrow] = False
        count, unsure = np.count_nonzero(bent), NONE
        if count < len(bent):
            limit = 0.7 * (8.0 * self.error + FLAT * np.sqrt(0.7 * least))
            maybe = volume > np.multiply(normal, limit, out=room[1])
            maybe[narrow] = True
            unsure = start + np.flatnonzero(maybe > bent)
            volume[np.flatnonzero(~bent)] = 0.0
        self.quads[start] = _Seen(len(bent), count, float(np.add.reduce(volume)), unsure)

    def see_triangles(self, starts: Sequence[int], step: int, lengths: NDArray) -> None:
        """Every `step`-th from each of these rows on. lengths: (len(starts), k) of their normals."""
        for start, normal in zip(starts, lengths):
            self.triangles[start] = _Seen(len(normal), 0, 0.0, start + step * np.flatnonzero(normal <= self.narrow))

    def flatness(self) -> Flatness:
        """What was seen, and where that does not tell or nothing was seen, what is found by looking."""
        surface, triangle_faces = self.surface, self.surface.triangle_faces
        seen = _together(self.quads, len(surface.quads))
        volumes, bare = self._look(surface.quads[seen.unsure], QUAD)
        bare = seen.unsure[bare] if surface.quad_faces is None else surface.quad_faces[seen.unsure[bare]]
        not_flat, looked = seen.bent + np.count_nonzero(volumes), np.add.reduce(volumes)
        if len(surface.triangles):
            rows = _together(self.triangles, len(surface.triangles)).unsure
            rows = rows[self._look(surface.triangles[rows], TRIANGLE)[1]]
            if triangle_faces is not None:
                pieces, found = np.bincount(triangle_faces), np.bincount(triangle_faces[rows])
                rows = np.flatnonzero((found == pieces[: len(found)]) & (found > 0))
                polygon, corners = self._polygons(pieces)
                volumes, _ = self._look(corners, QUAD)
                not_flat += len(np.unique(polygon[volumes > 0.0]))
                looked += np.add.reduce(volumes)
            bare = np.concatenate([bare, rows])
        spread = (seen.spread + float(np.ldexp(looked, 3 * self.exponent))) / 6.0
        return Flatness(int(not_flat), spread, np.sort(bare))

    def _look(self, corners: NDArray, pairs: tuple) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """(m,) 6 times the volume of the tetrahedron on the corners of each face, of what is brought to size 1, zero
        where the face is flat; and (m,) whether it has no area. pairs: of corners, QUAD or TRIANGLE."""
        error, volumes, bare = np.ldexp(self.error, -self.exponent), [np.empty(0)], [np.empty(0, bool)]
        for start in range(0, len(corners), BLOCK):
            points = self.surface.points[corners[start : start + BLOCK].astype(np.intp)].T
            points = np.ldexp(points.astype(np.float64, order="C"), -self.exponent)
            first, second, *third = ((points[:, i] - points[:, j]) for i, j in pairs)
            across = cross(first, second)
            square = dot(across, across)
            bare.append(square <= _narrow(np.maximum(dot(first, first), dot(second, second)), error))
            if third:
                volume, normal = np.abs(dot(third[0], across)), np.sqrt(square)
                volume[(volume <= normal * (8.0 * error + FLAT * np.sqrt(normal))) | bare[-1]] = 0.0
                volumes.append(volume)
        return np.concatenate(volumes), np.concatenate(bare)

    def _polygons(self, pieces: NDArray[np.integer]) -> tuple[NDArray[np.intp], NDArray[np.integer]]:
        """The tetrahedra of the faces of more than one triangle: (m,) which face each is of, and (m, 4) corners.

        pieces: how many triangles each mesh face has.
        """
        ring, quad_faces = self.surface.corner_vertices, mesh_faces(self.surface)[0]
        polygon = np.flatnonzero(pieces > 1)
        sizes = np.zeros(max(len(pieces), int(quad_faces.max(initial=-1)) + 1), np.intp)
        sizes[: len(pieces)] = np.where(pieces > 0, pieces + 2, 0)
        sizes[quad_faces] = 4
        if ring is None or sizes.sum() != len(ring):
            return NONE, np.empty((0, 4), np.intp)
        begin = (np.cumsum(sizes) - sizes)[polygon]
        steps = sizes[polygon] - 3
        row = np.repeat(np.arange(len(polygon)), steps)
        at = begin[row] + 2 + np.arange(len(row)) - np.repeat(np.cumsum(steps) - steps, steps)
        return row, np.stack([ring[begin[row]], ring[begin[row] + 1], ring[at], ring[at + 1]], axis=1)


def _together(blocks: dict[int, _Seen], count: int) -> _Seen:
    """What was seen of so many rows, in their order, whoever was first; if not of all, then of none."""
    seen = [blocks[start] for start in sorted(blocks)]
    if sum(block.count for block in seen) != count:
        return _Seen(count, 0, 0.0, np.arange(count))
    return _Seen(
        count,
        sum(block.bent for block in seen),
        sum(block.spread for block in seen),
        np.concatenate([NONE, *(block.unsure for block in seen)]),
    )


def _narrow(longest: NDArray | float, error: float) -> NDArray | float:
    """The largest square of the normal of a face without area, from the square of its longest edge or diagonal."""
    return longest * (error * error + NO_AREA * NO_AREA * longest)
