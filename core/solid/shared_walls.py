# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Assignment of the two layers of a wall between welded bodies to the bodies.

If two bodies share the vertices of a face that each of them has, four faces meet along its border: one of either body,
and both layers. Nothing but the layers' directions distinguishes them, and these say nothing if one body is inside out.
So a layer goes with one body along its whole border, the other one with the other, each with the body that it agrees
with in direction, if that decides.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh.edges import Edges
from ..mesh.surface import normals
from ..mesh.welding import same_vertices_groups
from ..numerics.arrays import hash_uint64, sums_by_index
from ..numerics.graph import connected_components
from .duplicate_faces import is_duplicated
from .repaired_mesh import NO_INDICES

FLAT_RTOL = 1e-9  # Relative to the area: allowed shortfall of the sum of a flat piece's normals.
NO_LINKS = NO_INDICES, NO_INDICES


def wall_links(
    points: NDArray[np.floating], edges: Edges, triangles: NDArray[np.integer], face: NDArray[np.integer]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return (k,) and (k,) the sides that belong together at walls between bodies. face: (t,) of each triangle."""
    if not (edges.count == 4).any():
        return NO_LINKS
    pairs = edges.manifold_side_pairs()
    piece, _ = connected_components(len(triangles), pairs[0] // 3, pairs[1] // 3)
    layer, wall = _layers(points, edges, triangles, face, piece)
    if not layer.any():
        return NO_LINKS
    sides = np.flatnonzero((edges.count == 4)[edges.of_side])
    # Sort by edge: single faces, then the first layer, then the other.
    sides = sides[np.lexsort((layer[sides // 3], edges.of_side[sides]))].reshape(-1, 4)
    rank = layer[sides // 3]
    within = sides[(rank == [1, 1, 2, 2]).all(axis=1)]
    border = sides[(rank == [0, 0, 1, 2]).all(axis=1)]
    border = border[wall[border[:, 2] // 3] == wall[border[:, 3] // 3]]
    if not len(border):
        return NO_LINKS
    layers = _layer_links(edges, within, wall)
    part, _ = connected_components(
        len(triangles),
        np.concatenate([pairs[0] // 3, layers[:, 0] // 3]),
        np.concatenate([pairs[1] // 3, layers[:, 1] // 3]),
    )
    for columns in np.array([[0, 1], [2, 3]]):  # A column keeps its body and its layer along the whole border.
        swap = np.diff(part[border[:, columns] // 3])[:, 0] < 0
        border[np.ix_(swap, columns)] = border[np.ix_(swap, columns[::-1])]
    # A wall is between two bodies only, the same along its border.
    wall = np.unique(part[border[:, 2:] // 3], axis=0, return_inverse=True)[1].ravel()
    lower, upper = part[border[:, 0] // 3], part[border[:, 1] // 3]
    first = np.empty(int(wall.max()) + 1, np.intp)
    first[wall] = np.arange(len(wall))
    one_pair = (lower == lower[first[wall]]) & (upper == upper[first[wall]]) & (lower != upper)
    decided = sums_by_index(wall, ~one_pair)[wall] == 0.0
    border, wall = border[decided], wall[decided]
    up = edges.upward[border]
    agree = (up[:, :2, None] != up[:, None, 2:]).astype(float)  # Compare each body with each layer.
    straight = agree[:, 0, 0] + agree[:, 1, 1] - agree[:, 0, 1] - agree[:, 1, 0]
    swapped = sums_by_index(wall, straight)[wall] < 0.0
    border[swapped] = border[swapped][:, [0, 1, 3, 2]]
    links = np.concatenate([layers, border[:, [0, 2]], border[:, [1, 3]]]) if len(border) else layers[:0]
    return links[:, 0], links[:, 1]


def _layer_links(edges: Edges, within: NDArray[np.intp], wall: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the (k, 2) sides that are joined within walls.

    Which copy of a face is first is an accident: a copy goes with the one of its neighbors that it agrees with. within:
    (e, 4) sides on edges between two faces of a wall, by layers; wall: (t,) as of `_layers`.
    """
    crossed = wall[within[:, 1] // 3] != wall[within[:, 3] // 3]
    within = np.where(crossed[:, None], within[:, [0, 1, 3, 2]], within)  # Corners of one face, then the other, twice.
    up = edges.upward[within]
    straight = (up[:, 0] != up[:, 1]).astype(int) + (up[:, 2] != up[:, 3])
    across = (up[:, 0] != up[:, 3]).astype(int) + (up[:, 2] != up[:, 1])
    within = np.where((across > straight)[:, None], within[:, [0, 3, 2, 1]], within)
    return np.concatenate([within[:, :2], within[:, 2:]])


def _layers(
    points: NDArray[np.floating],
    edges: Edges,
    triangles: NDArray[np.integer],
    face: NDArray[np.integer],
    piece: NDArray[np.intp],
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return (t,) 1 and 2 for triangles of the two layers of walls, else 0; and (t,) a number of each wall.

    Layers are faces on the same vertices, or flat pieces with the same border that are cut into triangles differently.
    piece: (t,) the piece of each triangle, connected across edges of two faces.
    """
    group = same_vertices_groups(triangles, face)
    layer = is_duplicated(group, face).astype(np.intp) + (group != face)
    vector = normals(points, triangles)
    number = int(piece.max()) + 1
    total = np.stack([np.bincount(piece, vector[:, k], number) for k in range(3)], axis=1)
    area = np.bincount(piece, np.linalg.norm(vector, axis=1), number)
    flat = np.linalg.norm(total, axis=1) >= (1.0 - FLAT_RTOL) * area
    crowded = np.flatnonzero((edges.count > 2)[edges.of_side])
    border = np.zeros(number, np.uint64)
    np.add.at(border, piece[crowded // 3], hash_uint64(edges.of_side[crowded].astype(np.uint64)))
    candidate = np.flatnonzero(flat & (np.bincount(piece, layer > 0, number) == 0) & (border != 0))
    _, kind, times = np.unique(border[candidate], return_inverse=True, return_counts=True)
    candidate, kind = candidate[times[kind] == 2], kind[times[kind] == 2]
    order = np.argsort(kind).reshape(-1, 2)
    first, other = candidate[order[:, 0]], candidate[order[:, 1]]
    piece_layer, partner = np.zeros(number, np.intp), np.arange(number)
    piece_layer[first], piece_layer[other], partner[other] = 1, 2, first
    by_piece = piece_layer[piece] > 0
    return np.where(by_piece, piece_layer[piece], layer), np.where(
        by_piece, int(face.max()) + 1 + partner[piece], group
    )
