# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies as (points, faces): float64 arrays (n, 3) and lists of polygons, outward unless the name
says otherwise.

Plain numpy with fixed seeds. Blender rounds the points to float32, which hides what the last bit of
a sine may differ between machines.
"""

from itertools import combinations

import numpy as np

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
SIDES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
L_PLAN = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
U_PLAN = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
T_PLAN = [(1, 0), (2, 0), (2, 2), (3, 2), (3, 3), (0, 3), (0, 2), (1, 2)]
SLANTED_PLAN = [(0, 0), (3, 0), (3.5, 1), (1, 1), (1, 2.5), (0, 2)]
COMB_PLAN = [
    (0, 0),
    (5, 0),
    (5, 2),
    (4, 2),
    (4, 1),
    (3, 1),
    (3, 2.5),
    (2, 2.5),
    (2, 1),
    (1, 1),
    (1, 2),
    (0, 2),
]


def box(low=(0, 0, 0), high=(1, 1, 1)):
    low, high = np.array(low, float), np.array(high, float)
    return CORNERS * (high - low) + low, [list(side) for side in SIDES]


def joined(*parts):
    """Several bodies in one mesh, each with vertices of its own."""
    shifts = np.cumsum([0] + [len(points) for points, _ in parts])
    faces = [
        [int(i + shift) for i in face] for (_, faces), shift in zip(parts, shifts) for face in faces
    ]
    return np.concatenate([points for points, _ in parts]), faces


def inverted(part):
    return part[0], [face[::-1] for face in part[1]]


def without(part, *numbers):
    return part[0], [face for i, face in enumerate(part[1]) if i not in numbers]


def with_flipped(part, *numbers):
    return part[0], [face[::-1] if i in numbers else face for i, face in enumerate(part[1])]


def with_again(part, *numbers):
    """Return the part with some faces doubled."""
    return part[0], [*part[1], *(list(part[1][i]) for i in numbers)]


def unwelded(part):
    """Return the part with separate vertices for each face."""
    ends = np.cumsum([0] + [len(face) for face in part[1]])
    points = part[0][np.concatenate(part[1])]
    return points, [list(range(start, end)) for start, end in zip(ends, ends[1:])]


def triangulated(part):
    return part[0], [
        [face[0], face[i], face[i + 1]] for face in part[1] for i in range(1, len(face) - 1)
    ]


def moved(part, offset=(0, 0, 0), scale=1.0):
    return part[0] * np.asarray(scale, float) + np.asarray(offset, float), part[1]


def turned(part, axis, angle):
    """About a coordinate axis through the origin."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [k for k in range(3) if k != axis]
    points = part[0].copy()
    points[:, i], points[:, j] = (
        c * part[0][:, i] - s * part[0][:, j],
        s * part[0][:, i] + c * part[0][:, j],
    )
    return points, part[1]


def prism(plan, height=1.0, slant=(0.0, 0.0), taper=1.0):
    """A plan (counter-clockwise) extruded along z; its two ends are polygons of as many sides."""
    plan = np.asarray(plan, float)
    n = len(plan)
    low = np.column_stack([plan, np.zeros(n)])
    high = np.column_stack([plan * taper + slant, np.full(n, float(height))])
    faces = [list(range(n))[::-1], list(range(n, 2 * n))]
    return np.concatenate([low, high]), faces + [
        [i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)
    ]


def regular(n, radius=1.0, phase=0.0):
    angles = phase + 2 * np.pi * np.arange(n) / n
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def cone(n=16, radius=1.0, height=2.0):
    points = np.concatenate([np.column_stack([regular(n, radius), np.zeros(n)]), [[0, 0, height]]])
    return points, [list(range(n))[::-1], *([i, (i + 1) % n, n] for i in range(n))]


def uv_sphere(segments=12, rings=8, radius=1.0):
    heights = np.pi * np.arange(1, rings) / rings
    circles = [
        np.column_stack([regular(segments, np.sin(h)), np.full(segments, np.cos(h))])
        for h in heights
    ]
    points = radius * np.concatenate([*circles, [[0, 0, 1], [0, 0, -1]]])
    top, bottom, last = len(points) - 2, len(points) - 1, (rings - 2) * segments
    faces = []
    for i in range(segments):
        j = (i + 1) % segments
        faces += [[top, i, j], [bottom, last + j, last + i]]
        faces += [
            [r * segments + i, (r + 1) * segments + i, (r + 1) * segments + j, r * segments + j]
            for r in range(rings - 2)
        ]
    return points, faces


def ball(level=2, radius=1.0):
    """The octahedron, each triangle cut in four `level` times, its points on the sphere."""
    points = [*np.eye(3), *-np.eye(3)]
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    for _ in range(level):
        middles, cut = {}, []

        def middle(a, b, middles=middles):
            side = (min(a, b), max(a, b))
            if side not in middles:
                point = points[a] + points[b]
                middles[side] = len(points)
                points.append(point / np.sqrt(point @ point))
            return middles[side]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            cut += [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        faces = cut
    return radius * np.array(points), faces


def torus(nu=16, nv=8, major=1.0, minor=0.35, twist=False):
    """A ring of quads; with `twist`, the Klein bottle of the figure 8."""
    u, v = np.meshgrid(
        np.arange(nu) * 2 * np.pi / nu, np.arange(nv) * 2 * np.pi / nv, indexing="ij"
    )
    if twist:
        r = major + minor * (np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v))
        z = minor * (np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v))
    else:
        r, z = major + minor * np.cos(v), minor * np.sin(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), z], axis=-1).reshape(-1, 3)

    def vertex(i, j):
        return i % nu * nv + (-j if twist and i // nu % 2 else j) % nv

    faces = [
        [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]
        for i in range(nu)
        for j in range(nv)
    ]
    return points, faces


def moebius(n=40, width=0.3):
    u = np.arange(n) * 2 * np.pi / n
    sides = [
        np.stack(
            [
                (1 + w * np.cos(u / 2)) * np.cos(u),
                (1 + w * np.cos(u / 2)) * np.sin(u),
                w * np.sin(u / 2),
            ],
            axis=1,
        )
        for w in (-width, width)
    ]
    return np.concatenate(sides), [
        *([i, i + 1, n + i + 1, n + i] for i in range(n - 1)),
        [n - 1, n, 0, 2 * n - 1],
    ]


def sheet(n=4, height=0.0):
    """The unit square facing up, in n x n quads; with a height, a hill."""
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n, indexing="ij")
    z = height * 16 * x * (1 - x) * y * (1 - y)
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack(
        [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1
    ).reshape(-1, 4)
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), quads.tolist()


def hull(points, tolerance=1e-9):
    """The convex hull of a few points by its supporting planes, each face one polygon."""
    points = np.asarray(points, float)
    size = np.ptp(points, axis=0).max()
    middle, faces, seen = points.mean(axis=0), [], set()
    for a, b, c in combinations(range(len(points)), 3):
        normal = np.cross(points[b] - points[a], points[c] - points[a])
        length = np.sqrt(normal @ normal)
        if length < tolerance * size**2:
            continue
        normal = normal / length
        off = (points - points[a]) @ normal
        if off.min() < -tolerance * size and off.max() > tolerance * size:
            continue
        on = tuple(np.flatnonzero(np.abs(off) <= tolerance * size).tolist())
        if on in seen:
            continue
        seen.add(on)
        if (points[a] - middle) @ normal < 0:
            normal = -normal
        center = points[list(on)].mean(axis=0)
        along = points[on[0]] - center
        across = np.cross(normal, along)
        angles = [
            np.arctan2((points[i] - center) @ across, (points[i] - center) @ along) for i in on
        ]
        faces.append([on[i] for i in np.argsort(np.round(angles, 9), kind="stable")])
    used = sorted({i for face in faces for i in face})
    place = {old: new for new, old in enumerate(used)}
    return points[used], [[place[i] for i in face] for face in faces]


def random_hull(seed, count=12):
    return hull(np.round(np.random.default_rng(seed).uniform(-1, 1, (count, 3)), 3))


def clipped(part, normal, offset):
    """Return the part of a convex body with normal . x <= offset."""
    points, faces = part
    heights = points @ normal - offset
    edges = {(min(a, b), max(a, b)) for face in faces for a, b in zip(face, [*face[1:], face[0]])}
    kept = [*points[heights <= 0]]
    for i, j in sorted(edges):
        if heights[i] * heights[j] < 0:
            kept.append(
                points[i] + heights[i] / (heights[i] - heights[j]) * (points[j] - points[i])
            )
    return hull(kept)


def fracture(seed=5, count=6):
    """The Voronoi cells of a box of 2 x 1 x 1."""
    seeds = np.round(np.random.default_rng(seed).uniform(0, 1, (count, 3)), 3) * (2, 1, 1)
    cells = []
    for i, own in enumerate(seeds):
        cell = box((0, 0, 0), (2, 1, 1))
        for other in np.delete(seeds, i, axis=0):
            cell = clipped(cell, other - own, (other - own) @ (own + other) / 2)
        cells.append(cell)
    return cells


def polycube(seed, count=8):
    """Unit cubes grown face to face at random, their outer faces over shared vertices."""
    rng = np.random.default_rng(seed)
    steps = np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])
    cells = [(0, 0, 0)]
    while len(cells) < count:
        cell = cells[rng.integers(len(cells))]
        new = tuple((np.array(cell) + steps[rng.integers(6)]).tolist())
        if new not in cells:
            cells.append(new)
    outward = [(0, 0, -1), (0, 0, 1), (0, -1, 0), (0, 1, 0), (-1, 0, 0), (1, 0, 0)]
    place, faces = {}, []
    for cell in sorted(cells):
        for side, step in zip(SIDES, outward):
            if tuple(np.add(cell, step).tolist()) not in cells:
                corners = [tuple(np.add(cell, CORNERS[i].astype(int)).tolist()) for i in side]
                faces.append([place.setdefault(corner, len(place)) for corner in corners])
    return np.array(list(place), float), faces


def raised_column(height=0.5):
    """A unit box with one corner of its top raised: a quad that is not flat."""
    points, faces = box()
    points[7, 2] += height
    return points, faces


def t_junctions():
    """A box of which one side is cut in four and its neighbors are not."""
    points, faces = box()
    more = np.array([[0.5, 0, 1], [0.5, 1, 1], [0, 0.5, 1], [1, 0.5, 1], [0.5, 0.5, 1]])
    a, b, c, d, m = range(8, 13)
    quads = [[4, a, m, c], [a, 5, d, m], [m, d, 7, b], [c, m, b, 6]]
    return np.concatenate([points, more]), [face for face in faces if face != [4, 5, 7, 6]] + quads


def dense_side(n=8, size=(2, 3, 5)):
    """A box with one side in n x n quads, closed in space alone."""
    points, faces = box((0, 0, 0), size)
    top, quads = sheet(n)
    return joined(
        (points, [face for face in faces if face != [4, 5, 7, 6]]),
        (top * size + (0, 0, size[2]), quads),
    )


def random_tetrahedra(seed, count=5, spread=4.0):
    """Tetrahedra apart from each other in one mesh."""
    rng = np.random.default_rng(seed)
    parts = []
    for number in range(count):
        points = np.round(rng.uniform(-1, 1, (4, 3)), 3) + (number * spread, 0, 0)
        faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        if np.linalg.det(points[1:] - points[0]) < 0:
            faces = [face[::-1] for face in faces]
        parts.append((points, faces))
    return joined(*parts)


TONON = (
    np.array(
        [
            [8.3322, -11.86875, 0.93355],
            [0.75523, 5.0, 16.37072],
            [52.61236, 5.0, -5.3858],
            [2.0, 5.0, 3.0],
        ]
    ),
    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
)
