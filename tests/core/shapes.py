# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of every kind of symmetry with their Schoenflies symbols, cut into triangles in several
ways.
"""

from itertools import combinations

import numpy as np

from tests.core import bodies


def prism(n, height=1.7, top=1.0, twist=0.0):
    """A straight prism over a regular polygon; `top` shrinks its upper end and `twist` turns it."""
    angle = np.arange(n) * 2 * np.pi / n
    low = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    high = np.stack(
        [top * np.cos(angle + twist), top * np.sin(angle + twist), np.full(n, height)], axis=1
    )
    fans = [(0, i + 1, i) for i in range(1, n - 1)] + [
        (n, n + i, n + i + 1) for i in range(1, n - 1)
    ]
    sides = [t for i in range(n) for j in [(i + 1) % n] for t in ((i, j, n + j), (i, n + j, n + i))]
    return np.concatenate([low, high]), np.array(fans + sides)


def antiprism(n, height=1.0):
    points, triangles = prism(n, height, twist=np.pi / n)
    sides = [t for i in range(n) for j in [(i + 1) % n] for t in ((i, j, n + i), (j, n + j, n + i))]
    return points, np.concatenate([triangles[: 2 * (n - 2)], sides])


def hull(points):
    """A convex polyhedron of few corners, no four of them in one plane with a face."""
    points = np.asarray(points, float)
    middle, triangles = points.mean(axis=0), []
    for i, j, k in combinations(range(len(points)), 3):
        normal = np.cross(points[j] - points[i], points[k] - points[i])
        side = (points - points[i]) @ normal
        if (side <= 1e-9).all() or (side >= -1e-9).all():
            outward = normal @ (points[i] - middle) > 0
            triangles.append((i, j, k) if outward else (i, k, j))
    return points, np.array(triangles)


def refined(part, seed=None):
    """The same body with each triangle cut in three at an inner point, at random where a seed is
    given, and in another order.
    """
    points, triangles = part
    share = np.full((len(triangles), 3), 1 / 3)
    if seed is not None:
        share = np.random.default_rng(seed).dirichlet([2.0] * 3, len(triangles))
    inner = np.einsum("nk,nki->ni", share, points[triangles])
    new = len(points) + np.arange(len(triangles))
    a, b, c = triangles.T
    cut = np.concatenate(
        [np.stack([a, b, new], 1), np.stack([b, c, new], 1), np.stack([c, a, new], 1)]
    )
    if seed is not None:
        cut = np.random.default_rng(seed).permutation(cut)
    return np.concatenate([points, inner]), cut


def mirrored(part):
    return part[0] * [-1.0, 1.0, 1.0], part[1][:, ::-1]


def distance(part, points):
    """(n,) distances of points from a surface of few triangles, one by one."""
    a, b, c = (part[0][part[1][:, k]] for k in range(3))
    best = np.full(len(points), np.inf)
    for start in range(0, len(points), 256):
        best[start : start + 256] = _distances(
            points[start : start + 256, None], a[None], b[None], c[None]
        ).min(axis=1)
    return best


def _distances(p, a, b, c):
    normal = np.cross(b - a, c - a)
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    inside, result = True, np.inf
    for u, v in ((a, b), (b, c), (c, a)):
        side = v - u
        along = np.clip(((p - u) * side).sum(-1) / (side * side).sum(-1), 0, 1)[..., None]
        result = np.minimum(result, np.linalg.norm(p - u - along * side, axis=-1))
        inside = inside & ((np.cross(side, p - u) * normal).sum(-1) >= 0)
    return np.where(inside, np.abs(((p - a) * normal).sum(-1)), result)


PHI = (1 + 5**0.5) / 2
TETRAHEDRON = hull([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
ICOSAHEDRON = hull(
    [np.roll((0, a, b * PHI), k) for a in (1, -1) for b in (1, -1) for k in range(3)]
)
WEDGE = (
    np.array([[0, 0, 0], [1, 0.2, 0], [0.3, 2, 0.1], [0.2, 0.4, 3]]),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)
SHEARED = bodies.moved(bodies.box((0, 0, 0), (3, 2, 1)), [[1, 0.4, 0], [0, 1, 0], [0, 0, 1]])
L_PRISM = bodies.joined(bodies.box((0, 0, 0), (3, 1, 1)), bodies.box((0, 1, 0), (1, 4, 1)))
THREE_BOXES = bodies.joined(
    bodies.box((0, 0, 0), (4, 1, 1)),
    bodies.box((0, 1, 0), (1, 3, 1)),
    bodies.box((0, 0, 1), (1, 1, 2.5)),
)
# An S: two arms reach out to opposite sides. Half a turn about the stroke's normal, and no other,
# leaves it as it is.
S_PRISM = bodies.joined(
    bodies.box((0, 0, 0), (1, 6, 1)),
    bodies.box((1, 5, 0), (3, 6, 1)),
    bodies.box((-2, 0, 0), (0, 1, 1)),
)
STEPPED = bodies.joined(
    bodies.box((-1, -1, -1), (1, 1, 1)), bodies.box((-0.5, -0.5, 1), (0.5, 0.5, 2))
)

ASYMMETRIC = {
    "wedge": WEDGE,
    "three boxes": THREE_BOXES,
    "blob": bodies.moved(bodies.sphere(2), [[1, 0.2, 0], [0, 2, 0.3], [0.1, 0, 3]]),
}
ASYMMETRIC["blob"] = (
    ASYMMETRIC["blob"][0] + 0.2 * ASYMMETRIC["blob"][0][:, [1, 2, 0]] ** 2,
    ASYMMETRIC["blob"][1],
)
SYMMETRIC = {
    "L prism": (L_PRISM, "Cs"),
    "box": (bodies.box((0, 0, 0), (3, 2, 1)), "D2h"),
    "S prism": (S_PRISM, "C2h"),
    "sheared box": (SHEARED, "C2h"),
    "cube": (bodies.box(), "Oh"),
    "square prism": (prism(4), "D4h"),
    "flat square prism": (prism(4, 0.5), "D4h"),
    "triangular prism": (prism(3), "D3h"),
    "pentagonal prism": (prism(5), "D5h"),
    "hexagonal prism": (prism(6), "D6h"),
    "stepped cube": (STEPPED, "C4v"),
    "frustum": (prism(4, top=0.5), "C4v"),
    "tetrahedron": (TETRAHEDRON, "Td"),
    "octahedron": (bodies.sphere(0), "Oh"),
    "icosahedron": (ICOSAHEDRON, "Ih"),
    "twisted square prism": (prism(4, twist=0.3), "D4"),
    "antiprism": (antiprism(4), "D4d"),
}
ROUND = {
    "torus": (bodies.torus(12, 6), "D∞h", "D12h"),
    "prism of 12 sides": (prism(12), "D∞h", "D12h"),
    "pyramid of 9 sides": (prism(9, top=0.3), "C∞v", "C9v"),
    "twisted prism": (prism(9, twist=0.1), "D∞h", "D9"),
    "antiprism of 8": (antiprism(8), "D∞h", "D8d"),
}
