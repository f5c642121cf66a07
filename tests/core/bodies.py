# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small bodies as (points, triangles), outward unless the name says otherwise, with their known
measures.
"""

import math
from math import gamma

import numpy as np
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomials

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
SIDES = np.array(
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
)
TOP = (2, 3)  # the two triangles of a box that lie in its upper side


def split(quads):
    """Quads as triangles along their first diagonals."""
    return np.asarray(quads)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def box(low=(0, 0, 0), high=(1, 1, 1)):
    low, high = np.array(low, float), np.array(high, float)
    return CORNERS * (high - low) + low, split(SIDES)


def joined(*parts):
    """Several bodies in one mesh, each with vertices of its own."""
    shift = np.cumsum([0] + [len(points) for points, _ in parts])
    return (
        np.concatenate([points for points, _ in parts]),
        np.concatenate([triangles + k for (_, triangles), k in zip(parts, shift)]),
    )


def inverted(part):
    return part[0], part[1][:, ::-1]


def without(part, *faces):
    return part[0], np.delete(part[1], faces, axis=0)


def with_flipped(part, *faces):
    triangles = part[1].copy()
    triangles[list(faces)] = triangles[list(faces)][:, ::-1]
    return part[0], triangles


def welded(part):
    """Weld a body to one vertex for each position."""
    points, index = np.unique(part[0], axis=0, return_inverse=True)
    return points, index.reshape(-1)[part[1]]


def soup(part):
    """Split a body into three vertices for each triangle."""
    return part[0][part[1].ravel()], np.arange(part[1].size).reshape(-1, 3)


def grid(n):
    """The unit square in z = 0 facing up, in n x n quads."""
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n, indexing="ij")
    index = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    quads = np.stack(
        [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1
    ).reshape(-1, 4)
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1), split(quads)


def sphere(level=3):
    """The octahedron, each triangle cut in four `level` times, its points on the unit sphere."""
    points = np.concatenate([np.eye(3), -np.eye(3)])
    triangles = np.array(
        [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    )
    for _ in range(level):
        sides = np.sort(
            np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]),
            axis=1,
        )
        ends, middle = np.unique(sides, axis=0, return_inverse=True)
        ab, bc, ca = middle.reshape(3, -1) + len(points)
        a, b, c = triangles.T
        middles = points[ends].sum(axis=1)
        points = np.concatenate([points, middles / np.linalg.norm(middles, axis=1)[:, None]])
        triangles = np.concatenate(
            [np.stack(t, axis=1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
        )
    return points, triangles


def ring(nu, nv, twist=False, major=1.0, minor=0.35):
    """A closed strip of nu x nv quads as (points, quads): a torus; with `twist`, a Klein bottle
    (the figure-8 one).
    """
    u, v = np.meshgrid(
        np.arange(nu) * 2 * np.pi / nu, np.arange(nv) * 2 * np.pi / nv, indexing="ij"
    )
    if twist:
        r = major + minor * (np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v))
        z = minor * (np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v))
    else:
        r, z = major + minor * np.cos(v), minor * np.sin(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), z], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))

    def vertex(i, j):
        around = i // nu  # past the seam a Klein bottle's cross-section is turned by half
        j = np.where(around % 2 == 1, -j, j) if twist else j
        return i % nu * nv + j % nv

    quads = np.stack(
        [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)], axis=1
    )
    return points, quads


def torus(nu=24, nv=16, **sizes):
    points, quads = ring(nu, nv, **sizes)
    return points, split(quads)


def moebius(n=40):
    u = np.arange(n) * 2 * np.pi / n
    edges = []
    for side in (-0.3, 0.3):
        r = 1.0 + side * np.cos(u / 2)
        edges.append(np.stack([r * np.cos(u), r * np.sin(u), side * np.sin(u / 2)], axis=1))
    quads = [[i, i + 1, n + i + 1, n + i] for i in range(n - 1)] + [[n - 1, n, 0, 2 * n - 1]]
    return np.concatenate(edges), split(quads)


def rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def moved(part, matrix=None, offset=(0, 0, 0)):
    """The image under x -> matrix @ x + offset."""
    points = part[0] if matrix is None else part[0] @ np.asarray(matrix).T
    return points + np.asarray(offset, float), part[1]


def surface(part, dtype=np.float64, **more):
    return Surface(part[0].astype(dtype), part[1], **more)


def mesh(points, faces, dtype=np.float64):
    """A surface as a reader makes it from polygons: quads, fans for larger ones, the mesh's corners
    and their edges.
    """
    edges, corner_edges = {}, []
    for face in faces:
        for a, b in zip(face, [*face[1:], face[0]]):
            corner_edges.append(edges.setdefault((min(a, b), max(a, b)), len(edges)))
    quads = [face for face in faces if len(face) == 4]
    fans = [
        (k, (face[0], face[i], face[i + 1]))
        for k, face in enumerate(faces)
        if len(face) != 4
        for i in range(1, len(face) - 1)
    ]
    return Surface(
        np.asarray(points, dtype),
        triangles=np.array([fan for _, fan in fans], int).reshape(-1, 3),
        quads=np.array(quads, int).reshape(-1, 4),
        triangle_faces=np.array([k for k, _ in fans], int),
        quad_faces=np.array([k for k, face in enumerate(faces) if len(face) == 4], int),
        corner_vertices=np.concatenate(faces),
        corner_edges=np.array(corner_edges),
    )


def volume(part):
    """The signed volume about a point of the body, added up without rounding."""
    a, b, c = (
        part[0][part[1][:, k]].astype(float) - part[0][part[1][0, 0]].astype(float)
        for k in range(3)
    )
    return math.fsum(np.einsum("ij,ij->i", a, np.cross(b, c))) / 6.0


def inertia(moments):
    """The diagonal of the inertia tensor about the centre."""
    second = moments.about_center().second()
    return np.trace(second) - np.diag(second)


def grid_torus(n=12, m=8, noise=0.0, seed=0, major=1.0, minor=0.4):
    """A closed torus of n x m quads with its points moved at random: points and quads."""
    u, v = np.meshgrid(
        np.arange(n) * (2 * np.pi / n), np.arange(m) * (2 * np.pi / m), indexing="ij"
    )
    ring = major + minor * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), minor * np.sin(v)], axis=-1).reshape(
        -1, 3
    )
    points = points + noise * np.random.default_rng(seed).standard_normal(points.shape)
    i, j = np.meshgrid(np.arange(n), np.arange(m), indexing="ij")
    corners = [(i, j), ((i + 1) % n, j), ((i + 1) % n, (j + 1) % m), (i, (j + 1) % m)]
    return points, np.stack([(a * m + b).ravel() for a, b in corners], axis=1)


def ball(order, radius=1.0):
    """Raw moments of a ball about its center: Dirichlet's integral."""
    raw = [
        0.0
        if any(n % 2 for n in row)
        else 2.0
        * np.prod([gamma((n + 1) / 2) for n in row])
        / gamma((sum(row) + 3) / 2)
        / (sum(row) + 3)
        * radius ** (sum(row) + 3)
        for row in monomials(order).tolist()
    ]
    return np.array(raw)


def bar(turn, sections=90, sides=12, radius=0.2):
    """A round bar bent about the z axis by so many full turns."""
    around = np.linspace(0.0, 2.0 * np.pi * turn, sections + 1)
    side = np.arange(sides) * 2.0 * np.pi / sides
    distance, height = (
        1.0 + radius * np.cos(side),
        np.tile(radius * np.sin(side), (sections + 1, 1)),
    )
    points = np.stack(
        [np.cos(around)[:, None] * distance, np.sin(around)[:, None] * distance, height], axis=-1
    )
    i, j = (k.ravel() for k in np.meshgrid(np.arange(sections), np.arange(sides), indexing="ij"))
    after = (j + 1) % sides
    mantle = np.stack(
        [i * sides + j, (i + 1) * sides + j, (i + 1) * sides + after, i * sides + after], axis=1
    )
    ends = [(0, k, k + 1) for k in range(1, sides - 1)]
    far = [
        (sections * sides, sections * sides + k + 1, sections * sides + k)
        for k in range(1, sides - 1)
    ]
    return points.reshape(-1, 3), np.concatenate([split(mantle), ends, far])


def hourglass(heavy):
    """A prism on two wedges that meet in a narrow waist.

    All of its sides are seen from the middle of its box there; from its center, in the wider one of
    the wedges, those of the other are seen from behind.
    """
    outline = [(-3.0, -heavy), (0.0, -0.05), (3.0, -1.5), (3.0, 1.5), (0.0, 0.05), (-3.0, heavy)]
    points = np.array([(x, y, z) for z in (-1.0, 1.0) for x, y in outline])
    lids = [(0, 5, 4, 1), (1, 4, 3, 2), (6, 7, 10, 11), (7, 8, 9, 10)]
    return points, split(lids + [(k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6) for k in range(6)])


def lathed(*profile, sides=48):
    """(radius, z) revolved about z in `sides` sides; closed if its ends are at radius 0."""
    angle = np.arange(sides) * (2 * np.pi / sides)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    points = np.concatenate([ring * r + [0, 0, z] for r, z in profile])
    i = np.arange(sides)
    j = (i + 1) % sides
    triangles = []
    for k in range(len(profile) - 1):
        low, high = k * sides, (k + 1) * sides
        if profile[k][0]:
            triangles.append(np.stack([low + i, low + j, high + j], axis=1))
        if profile[k + 1][0]:
            triangles.append(np.stack([low + i, high + j, high + i], axis=1))
    return points, np.concatenate(triangles)
