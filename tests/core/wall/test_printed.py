# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cores of prints against closed forms, and against counts of voxels eroded by the walls."""

import itertools

import numpy as np
import pytest
from body_moments.core.bodies.pocket import ball_moments
from body_moments.core.mesh import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.solid import measure_solid
from body_moments.core.verdict import MeasureError
from body_moments.core.wall import find_core, moved_faces

from tests.close import close

WALL, LAYERS = 0.84, 0.8


def prism(outline, height, middle=None):
    """Return a prism over an outline, (n, 2) counterclockwise, of which `middle` sees all; by
    default the mean of its corners.
    """
    outline = np.asarray(outline, np.float64)
    count = len(outline)
    middle = outline.mean(axis=0) if middle is None else middle
    low = np.column_stack([np.vstack([outline, middle]), np.zeros(count + 1)])
    points = np.vstack([low, low + [0.0, 0.0, height]])
    faces = []
    for i in range(count):
        j = (i + 1) % count
        faces += [(j, i, count), (i + count + 1, j + count + 1, 2 * count + 1)]
        faces += [(i, j, j + count + 1), (i, j + count + 1, i + count + 1)]
    return Surface.from_triangles(points, faces)


def box(x, y, z):
    return prism([(0, 0), (x, 0), (x, y), (0, y)], z)


def core_volume(surface, *heights):
    core = find_core(surface, WALL, *(heights or (LAYERS, LAYERS))).surface
    return polyhedron_moments(core, allow_open=True)[0].total


def test_cube_core_has_exact_volume():
    assert close(core_volume(box(20, 20, 20), 0.0, 0.6), 18.32**2 * 19.4, 1e-13)


def test_cube_with_corner_on_edge_of_neighbor_has_its_core():
    cube = box(20, 20, 20)
    points = np.vstack([cube.points, [[10.0, 0.0, 20.0]]])
    faces = cube.triangles.tolist()
    (cut,) = (face for face in faces if {5, 6, 9} == {*face})
    faces.remove(cut)
    turned = np.roll(cut, -cut.index(9)).tolist()
    faces += [[9, turned[1], 10], [9, 10, turned[2]]]
    solid = measure_solid(Surface.from_triangles(points, faces))
    assert close(core_volume(solid.repaired_surface), 18.32**2 * 18.4, 1e-12)


@pytest.mark.parametrize("count", [3, 5, 6, 48])
def test_prism_core_keeps_wall_in_each_layer(count):
    angles = 2.0 * np.pi * np.arange(count) / count
    outline = 10.0 * np.column_stack([np.cos(angles), np.sin(angles)])
    inner = 10.0 * np.cos(np.pi / count) - WALL
    area = count * inner**2 * np.tan(np.pi / count)
    assert close(core_volume(prism(outline, 12.0)), area * (12.0 - 2 * LAYERS), 1e-12)


def test_slope_decides_between_walls_and_layers():
    # A pyramid of half base 10 and height 10: sides of 45° move by max(.84, .8) / √2.
    corners = [(-10, -10, 0), (10, -10, 0), (10, 10, 0), (-10, 10, 0), (0, 0, 10)]
    faces = [(0, 2, 1), (0, 3, 2), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    height = 10.0 - WALL - LAYERS
    found = core_volume(Surface.from_triangles(np.array(corners, float), faces))
    assert close(found, (2.0 * height) ** 2 * height / 3.0, 1e-12)


def stack(filled, edges, matrix=None):
    """Return the surface of the filled boxes between edges of three axes, and a test of points."""
    filled = np.array(filled, bool)
    matrix = np.eye(3) if matrix is None else matrix
    edges = [np.array(one, float) for one in edges]
    around = np.pad(filled, 1)
    numbers = np.arange(np.prod(np.add(filled.shape, 1))).reshape(np.add(filled.shape, 1))
    quads = []
    for at in np.argwhere(filled):
        for axis, side in itertools.product(range(3), (0, 1)):
            beside = at + 1
            beside[axis] += 2 * side - 1
            if not around[tuple(beside)]:
                corner = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])[:: 2 * side - 1]
                corner = np.roll(np.column_stack([np.full(4, side), corner]), axis, axis=1)
                quads.append(numbers[tuple((at + corner).T)])
    points = np.stack(np.meshgrid(*edges, indexing="ij"), axis=-1).reshape(-1, 3)
    used, faces = np.unique(quads, return_inverse=True)
    faces = faces.reshape(-1, 4)
    triangles = np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]])

    def inside(*places):
        local = np.einsum("ij,j...->i...", np.linalg.inv(matrix), np.stack(places))
        cells = [np.searchsorted(one, axis) for one, axis in zip(edges, local)]
        return around[tuple(cells)]

    return Surface.from_triangles(points[used] @ matrix.T, triangles), inside


def box_core(filled, edges):
    """Return the volume of places farther from all empty boxes than the walls and layers."""
    reach = WALL, WALL, LAYERS
    fine = [np.unique([x, x - r, x + r]) for x, r in zip(edges, reach)]
    middles = [(x[1:] + x[:-1]) / 2.0 for x in fine]
    core = np.ones([len(x) for x in middles], bool)
    wide = [np.concatenate([[-np.inf], x, [np.inf]]) for x in edges]
    for at in np.argwhere(~np.pad(filled, 1)):
        near = [(m > x[i] - r) & (m < x[i + 1] + r) for i, m, x, r in zip(at, middles, wide, reach)]
        core[np.ix_(*near)] = False
    return np.einsum("ijk,i,j,k->", core.astype(float), *map(np.diff, fine))


def test_cores_of_random_stacks_of_boxes_are_exact():
    chance = np.random.default_rng(7)
    counts = 0
    while counts < 40:
        shape = chance.integers(2, 5, 3)
        widths = [chance.choice([0.4, 1.0, 1.2, 2.5, 4.0], n) + chance.random(n) / 9 for n in shape]
        edges = [np.concatenate([[0.0], np.cumsum(width)]) for width in widths]
        filled = chance.random(shape) < 0.8
        try:
            core = find_core(stack(filled, edges)[0], WALL, LAYERS, LAYERS)
        except MeasureError as error:
            assert "thin" not in str(error)
            continue
        if core.minimum < 1.0 - 1e-9 or core.maximum > 1.0 + 1e-9:
            continue  # more than three planes meet in a vertex
        found = polyhedron_moments(core.surface, allow_open=True)[0].total
        assert abs(found - box_core(filled, edges)) < 1e-7
        counts += 1


def test_wall_of_tube_is_solid_where_thin():
    angles = 2.0 * np.pi * np.arange(24) / 24
    outline = np.column_stack([np.cos(angles), np.sin(angles)])
    outer, inner = prism(10.0 * outline, 12.0), prism(9.0 * outline, 10.0)
    points = np.vstack([outer.points, inner.points + [0.0, 0.0, 1.0]])
    faces = np.vstack([outer.triangles, inner.triangles[:, ::-1] + len(outer.points)])
    assert abs(core_volume(Surface.from_triangles(points, faces))) < 1e-9


def dimpled(sides):
    """Return a box of 20 · 20 · 4 with a pyramid of 3.5 cut into its bottom, and its outline's
    area.
    """
    angles = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    square = 10.0 * np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
    ring = 8.0 * np.column_stack([np.cos(angles), np.sin(angles)])
    low = np.column_stack([np.vstack([square, ring]), np.full(sides + 4, -4.0)])
    points = np.vstack([np.column_stack([square, np.zeros(4)]), low, [0.0, 0.0, -0.5]])
    faces = [(0, 1, 2), (0, 2, 3)]
    for i in range(4):
        j = (i + 1) % 4
        faces += [(i, i + 4, j + 4), (i, j + 4, j), (i + 4, 8 + j * sides // 4 % sides, j + 4)]
    for i in range(sides):
        j = (i + 1) % sides
        faces += [(8 + j, 8 + i, len(points) - 1), (8 + i, 8 + j, 4 + i * 4 // sides)]
    return Surface.from_triangles(points, faces), sides * 32.0 * np.sin(2.0 * np.pi / sides)


def test_plane_that_many_faces_cross_has_exact_core(monkeypatch):
    surface, area = dimpled(256)
    # The pyramid's tip rises by a layer to 0.3; the core is between −3.2 and −0.8.
    hollow = area * (3.5**3 - 1.1**3) / 3.5**2 / 3.0
    assert close(core_volume(surface), (20.0 - 2 * WALL) ** 2 * 2.4 - hollow, 1e-9)
    monkeypatch.setattr(moved_faces, "MAX_DIVISIONS", 1000)
    with pytest.raises(MeasureError, match="too many faces near each other"):
        find_core(surface, WALL, LAYERS, LAYERS)


def eroded(grid, axis, reach):
    """Return the voxels with all of those up to `reach` before and behind along an axis."""
    if not reach:
        return grid
    sums = np.cumsum(
        np.pad(grid, [(reach + 1, reach) if i == axis else (0, 0) for i in range(3)]),
        axis=axis,
        dtype=np.int32,
    )
    count = grid.shape[axis]
    last = np.take(sums, np.arange(2 * reach + 1, 2 * reach + 1 + count), axis=axis)
    return last - np.take(sums, np.arange(count), axis=axis) == 2 * reach + 1


def voxel_core(inside, low, high):
    """Return the volume of the voxels of STEP whose disc and vertical segment are inside."""
    axes = [np.arange(a - STEP / 2, b + STEP, STEP) for a, b in zip(low, high)]
    grid = inside(*np.meshgrid(*axes, indexing="ij"))
    core = eroded(grid, 2, round(LAYERS / STEP))
    reach = WALL / STEP + 0.5  # from a middle to the faces of voxels
    for shift in range(-int(reach), int(reach) + 1):
        half = int(np.sqrt(reach**2 - shift**2))
        core &= np.roll(eroded(grid, 1, half), shift, 0)
    return core.sum() * STEP**3


STEP = 0.05
TURN = 2 * np.pi * np.arange(64) / 64
ROUND = np.column_stack([np.cos(TURN), np.sin(TURN)])
FINNED = [(0, 0), (8, 0), (8, 4), (4.5, 4), (4.5, 7), (3.5, 7), (3.5, 4), (0, 4)]


def in_polygon(outline, x, y):
    inside = np.zeros(x.shape, bool)
    for (a, b), (c, d) in zip(outline, np.roll(outline, -1, axis=0)):
        if b != d:
            inside ^= ((b > y) != (d > y)) & (x < (c - a) * (y - b) / (d - b) + a)
    return inside


def upright(outline, height, middle=None):
    """Return a prism along z, and a test of points."""
    outline = np.array(outline, float)

    def inside(x, y, z):
        flat = in_polygon(outline, x[:, :, 0], y[:, :, 0])
        return flat[:, :, None] & (z > 0) & (z < height)

    return prism(outline, height, middle), inside


def lying(outline, length, middle=None):
    """Return a prism along y, with its outline in x and z, and a test of points."""
    surface, _ = upright(outline, length, middle)
    outline = np.array(outline, float)
    turned = surface.transform(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float))

    def inside(x, y, z):
        flat = in_polygon(outline, x[:, 0], z[:, 0])
        return flat[:, None, :] & (y > -length) & (y < 0)

    return turned, inside


def cone(sides, radius, height):
    outline = radius * ROUND[:: 64 // sides]
    points = np.vstack([np.column_stack([outline, np.zeros(sides)]), [0, 0, 0], [0, 0, height]])
    faces = []
    for i in range(sides):
        j = (i + 1) % sides
        faces += [(j, i, sides), (i, j, sides + 1)]

    def inside(x, y, z):
        share = np.maximum(1.0 - z / height, 1e-9)
        return (z > 0) & (z < height) & in_polygon(outline, x / share, y / share)

    return Surface.from_triangles(points, faces), inside


TURNED = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
SLANTED = np.array([[1.0, 0.0, 0.1], [0.2, 1.0, 0.0], [0.3, 0.2, 1.0]])
# A thin web whose sides are in the planes of two thick blocks, and a strut likewise.
WEB = [[[1], [1], [0]], [[0], [1], [0]], [[0], [1], [1]]], [[0, 4, 9, 13], [0, 4, 5, 9], [0, 5]]
STRUT = np.zeros((3, 3, 3), bool)
STRUT[:, 1, 1] = STRUT[0, 1:, 1:] = STRUT[2, :2, :2] = True
PROFILE = [[[1], [1], [1]], [[0], [1], [0]], [[1], [1], [1]]]
PROFILE = PROFILE, [[0, 3, 6, 9], [0, 3.5, 4.5, 8], [0, 6]]

SHAPES = {
    "cube": upright([(0, 0), (6, 0), (6, 6), (0, 6)], 6.0),
    "plate": upright([(0, 0), (9, 0), (9, 5), (0, 5)], 2.0),
    "hexagon": upright([(3.5, 0), (1.75, 3), (-1.75, 3), (-3.5, 0), (-1.75, -3), (1.75, -3)], 5.0),
    "triangle": upright([(0, 0), (8, 0), (2, 7)], 5.0),
    "cylinder": upright(3.0 * ROUND, 6.0),
    "angle": upright([(0, 0), (8, 0), (8, 3), (3, 3), (3, 8), (0, 8)], 5.0, (1.5, 1.5)),
    "fin": upright(FINNED, 5.0, (4, 2)),
    "wedge": lying([(0, 0), (8, 0), (8, 5)], 6.0),
    "roof": lying([(0, 0), (8, 0), (8, 2), (4, 5), (0, 2)], 6.0),
    "lying cylinder": lying(3.0 * ROUND, 6.0),
    "cone": cone(64, 4.0, 7.0),
    "pyramid": cone(4, 5.0, 5.0),
    "slanted web": stack(*WEB, SLANTED),
    "strut": stack(STRUT, [[0, 4, 9, 13], [0, 4, 5, 9], [0, 4, 5, 9]], TURNED),
    "lying I profile": stack(*PROFILE, TURNED[[1, 2, 0]]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_core_agrees_with_count_of_voxels(name):
    surface, inside = SHAPES[name]
    low, high = surface.points.min(axis=0) - 0.1, surface.points.max(axis=0) + 0.1
    core = find_core(surface, WALL, LAYERS, LAYERS).surface
    volume, area = polyhedron_moments(core, area_order=0, allow_open=True)
    assert abs(volume.total - voxel_core(inside, low, high)) < 0.5 * STEP * area.total


def test_thin_pin_on_flat_cone_has_no_core():
    """The pin's moved faces are turned over twice, and larger faces have other directions."""
    rings = [(20.0, 0.0), (20.0, 1.0), (0.6, 6.0), (0.6, 30.0)]
    points = [np.column_stack([r * ROUND, np.full(64, z)]) for r, z in rings]
    faces = [(256, (i + 1) % 64, i) for i in range(64)]
    faces += [(257, 192 + i, 192 + (i + 1) % 64) for i in range(64)]
    for i in range(192):
        j = i - i % 64 + (i + 1) % 64
        faces += [(i, j, j + 64), (i, j + 64, i + 64)]
    points = np.vstack([*points, [0.0, 0.0, 0.0], [0.0, 0.0, 30.0]])
    core = find_core(Surface.from_triangles(points, faces), WALL, LAYERS, LAYERS).surface
    assert 5.0 < core.used_points()[:, 2].max() < 6.0


def test_ball_has_moments_of_its_quadrature():
    nodes, weights = np.polynomial.legendre.leggauss(12)
    radius, around = (nodes + 1.0) * 1.5, np.pi * np.arange(24) / 12.0
    r, z, turn = np.meshgrid(radius, nodes, around, indexing="ij")
    across = np.sqrt(1.0 - z**2)
    points = np.stack([across * np.cos(turn), across * np.sin(turn), z]) * r
    weight = r**2 * (1.5 * weights)[:, None, None] * weights[:, None] * np.pi / 12.0
    found = ball_moments(np.zeros(3), 3.0, 6)
    for exponents, moment in zip(found, found.raw):
        powers = np.prod([x**n for x, n in zip(points, exponents)], axis=0)
        assert abs(moment - (weight * powers).sum()) < 1e-9 * 3.0 ** (3 + sum(exponents))


def test_unequal_moves_at_blunt_corners_are_stated():
    even = find_core(box(20, 20, 20), WALL, LAYERS, LAYERS)
    assert close(even.minimum, 1.0, 1e-12) and close(even.maximum, 1.0, 1e-12)
    assert even.misplaced <= 1e-9
    # The four planes at the top, of two slopes, do not meet in a point after they moved.
    corners = np.array([(-10, -4, 0), (10, -4, 0), (10, 4, 0), (-10, 4, 0), (0, 0, 6)])
    sides = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 2, 1), (0, 3, 2)]
    roof = find_core(Surface.from_triangles(corners, sides), WALL, LAYERS, LAYERS)
    assert roof.minimum < 0.99 < 1.01 < roof.maximum and roof.misplaced > 0.0
