# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters to cut into bones: closed skins with weights, made of cells of a grid and bent:
nothing is flat.
"""

from dataclasses import dataclass

import numpy as np
from body_moments.core.rig.cuts import VertexWeights

SIDES = {  # the sides of a cell, counter-clockwise from outside
    (-1, 0, 0): [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
    (1, 0, 0): [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
    (0, -1, 0): [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
    (0, 1, 0): [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
    (0, 0, -1): [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
    (0, 0, 1): [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
}


@dataclass
class Character:
    """points (n, 3), quads (q, 4), outward, bones (b, 2, 3) and their names, weights."""

    points: np.ndarray
    quads: np.ndarray
    bones: np.ndarray
    weights: VertexWeights
    names: tuple

    @property
    def triangles(self):
        """Quads cut alike on both sides of x = 0: from the corner that comes first by (|x|, y,
        z).
        """
        x, y, z = np.round(self.points[self.quads], 9).transpose(2, 0, 1)
        first = np.array([np.lexsort((c, b, a))[0] for a, b, c in zip(np.abs(x), y, z)])
        turned = np.take_along_axis(self.quads, (first[:, None] + np.arange(4)) % 4, axis=1)
        return turned[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)

    @property
    def corners(self):
        """(faces, corners) as `dominant_bones` takes them."""
        return np.repeat(np.arange(len(self.quads)), 4), self.quads.ravel()

    def moved(self, matrix, offset=(0.0, 0.0, 0.0)):
        matrix = np.asarray(matrix, float)
        quads = self.quads[:, ::-1] if np.linalg.det(matrix) < 0 else self.quads
        return Character(
            self.points @ matrix.T + offset,
            quads,
            self.bones @ matrix.T + offset,
            self.weights,
            self.names,
        )


def boxes_skin(boxes, cells=1):
    """(points, quads) of the surface of a union of integer boxes ((low), (high)), that share no
    space.
    """
    filled = {
        (x, y, z)
        for low, high in boxes
        for x in range(low[0] * cells, high[0] * cells)
        for y in range(low[1] * cells, high[1] * cells)
        for z in range(low[2] * cells, high[2] * cells)
    }
    corners = [
        [np.add(cell, corner) for corner in side]
        for cell in sorted(filled)
        for step, side in SIDES.items()
        if tuple(np.add(cell, step)) not in filled
    ]
    points, index = np.unique(np.array(corners).reshape(-1, 3), axis=0, return_inverse=True)
    return points / cells, index.reshape(-1, 4)


def rigid_weights(points, quads, boxes):
    """Weights that give each face the box it is a side of: a face's corners that lie on several
    boxes share.
    """
    vertex, bone, weight = [], [], []
    for number, (low, high) in enumerate(boxes):
        inside = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        vertex.append(inside)
        bone.append(np.full(len(inside), number))
        weight.append(np.ones(len(inside)))
    vertex, bone, weight = map(np.concatenate, (vertex, bone, weight))
    order = np.argsort(vertex, kind="stable")
    return VertexWeights(vertex[order], bone[order], weight[order])


def smooth_weights(points, bones, reach=1.5, unweighted=()):
    """Weights that fall off with the distance from the bones, so that they overlap."""
    way = bones[:, 1] - bones[:, 0]
    share = np.clip(((points[:, None] - bones[:, 0]) * way).sum(-1) / (way * way).sum(-1), 0, 1)
    away = np.linalg.norm(points[:, None] - bones[:, 0] - share[..., None] * way, axis=-1)
    weight = np.exp(-((away / reach) ** 2)).astype(np.float32)
    weight[weight < 1e-3] = 0.0
    weight[[vertex for vertex in unweighted if vertex < len(points)]] = 0.0
    vertex, bone = np.nonzero(weight)
    return VertexWeights(vertex, bone, weight[vertex, bone])


LIMBS = {  # name: (low, high) of its box, and its bone
    "hips": (((-2, -1, 0), (2, 1, 2)), ((0, 0, 0.5), (0, 0, 1.8))),
    "chest": (((-2, -1, 2), (2, 1, 6)), ((0, 0, 2), (0, 0, 5.5))),
    "head": (((-1, -1, 6), (1, 1, 8)), ((0, 0, 6), (0, 0, 8))),
    "arm.L": (((2, -1, 4), (6, 1, 5)), ((2, 0, 4.5), (6, 0, 4.5))),
    "arm.R": (((-6, -1, 4), (-2, 1, 5)), ((-2, 0, 4.5), (-6, 0, 4.5))),
    "leg.L": (((1, -1, -5), (2, 1, 0)), ((1.5, 0, 0), (1.5, 0, -5))),
    "leg.R": (((-2, -1, -5), (-1, 1, 0)), ((-1.5, 0, 0), (-1.5, 0, -5))),
}
BOXES = [box for box, _ in LIMBS.values()]
BONES = np.array([bone for _, bone in LIMBS.values()], float)
NAMES = tuple(LIMBS)


def bend(points):
    """A bend that keeps the plane x = 0 and the two sides alike, with nothing flat left."""
    x, y, z = points.T
    return np.stack(
        [
            x * (1 + 0.03 * np.sin(z) + 0.02 * y),
            y + 0.05 * x * x / 9 + 0.1 * np.cos(z),
            z + 0.1 * y * y,
        ],
        1,
    )


def humanoid(cells=2, unweighted=(), bent=True):
    points, quads = boxes_skin(BOXES, cells)
    weights = smooth_weights(points, BONES, unweighted=unweighted)
    return Character(bend(points) if bent else points, quads, BONES, weights, NAMES)


def box_skeleton(cells=1):
    """A skin with a box of its own for every bone."""
    points, quads = boxes_skin(BOXES, cells)
    return Character(points, quads, BONES, rigid_weights(points, quads, BOXES), NAMES)


def cylinder_chain(lengths=(1.0, 2.5, 0.75), radius=0.5, sides=24):
    """A chain of prisms over one regular polygon, along X, in rings of vertices."""
    stations = np.concatenate([[0.0], np.cumsum(lengths)])
    turn = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.zeros(sides), radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    points = np.concatenate(
        [*(ring + (x, 0, 0) for x in stations), [(0, 0, 0), (stations[-1], 0, 0)]]
    )
    quads = []
    for s in range(len(lengths)):
        for i in range(sides):
            a, b = s * sides + i, s * sides + (i + 1) % sides
            quads.append((a, b, b + sides, a + sides))
    last, first_center = len(lengths) * sides, (len(lengths) + 1) * sides
    for i in range(0, sides, 2):  # fans of quads close the ends
        j, k = (i + 1) % sides, (i + 2) % sides
        quads.append((first_center, k, j, i))
        quads.append((first_center + 1, last + i, last + j, last + k))
    quads = np.array(quads)
    bones = np.array([[(a, 0, 0), (b, 0, 0)] for a, b in zip(stations, stations[1:])])
    boxes = [((a, -9, -9), (b, 9, 9)) for a, b in zip(stations, stations[1:])]
    return Character(
        points,
        quads,
        bones,
        rigid_weights(points, quads, boxes),
        tuple(f"b{i}" for i in range(len(lengths))),
    )


def ball(bones=6, seed=3, unweighted=()):
    """A sphere with bones in all directions, so that many of them meet in points."""
    rng = np.random.default_rng(seed)
    points, quads = boxes_skin([((-3, -3, -3), (3, 3, 3))], 2)
    points = 2.0 * points / np.linalg.norm(points, axis=1)[:, None]
    ends = rng.normal(size=(bones, 3))
    ends *= 1.5 / np.linalg.norm(ends, axis=1)[:, None]
    segments = np.stack([np.zeros((bones, 3)), ends], axis=1)
    return Character(
        points,
        quads,
        segments,
        smooth_weights(points, segments, 0.8, unweighted),
        tuple("abcdef"[:bones]),
    )


def characters():
    """Five of them: limbs, overlapping weights, unweighted vertices, mirrored, sheared."""
    return {
        "humanoid": humanoid(),
        "unweighted": humanoid(unweighted=range(0, 400, 7)),
        "mirrored": humanoid(3).moved(np.diag([-1.0, 2.0, 0.5]), (100.0, -50.0, 20.0)),
        "sheared": humanoid().moved([[1e-3, 4e-4, 0], [0, 1e-3, 0], [2e-4, 0, 1e-3]]),
        "ball": ball(),
    }
