# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Small solids measured together, compared with single measurements, however they are broken."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.measure import measure_alone, measure_solid, measure_stack
from body_moments.core.solid.solid_stack import SmallSolid
from body_moments.core.verdict import Intersection, Procedure

from tests.close import close
from tests.core.bodies import hourglass, mesh, moved
from tests.core.findings import refused

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def prism(n, height):
    angle = np.arange(n) * 2.0 * np.pi / n
    points = np.concatenate(
        [np.stack([np.cos(angle), np.sin(angle), np.full(n, z)], axis=1) for z in (0, height)]
    )
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return points, [list(range(n - 1, -1, -1)), list(range(n, 2 * n)), *sides]


def lattice(n, m, noise, rng):
    """A torus of quads."""
    i, j = np.divmod(np.arange(n * m), m)
    u, v = i * 2.0 * np.pi / n, j * 2.0 * np.pi / m
    points = np.stack(
        [(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)],
        axis=1,
    )
    corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
    faces = np.stack([a % n * m + b % m for a, b in corners], axis=1)
    return points + noise * rng.normal(size=points.shape), faces.tolist()


def whole(rng):
    kind = rng.integers(4)
    if kind == 0:
        return CORNERS * rng.uniform(0.5, 2, 3), SIDES
    if kind == 1:
        return prism(int(rng.integers(3, 20)), rng.uniform(0.01, 3.0))
    if kind == 2:
        return lattice(*map(int, rng.integers(3, 9, 2)), 0.02 * rng.integers(2), rng)
    return CORNERS + rng.uniform(-0.2, 0.2, (8, 3)), SIDES


def broken(rng):
    """A body with up to three faults."""
    points, faces = whole(rng)
    points, faces = points.copy(), [list(face) for face in faces]
    for fault in rng.integers(0, 11, rng.integers(0, 4)):
        face = int(rng.integers(len(faces)))
        if fault < 4 and len(faces) > 2:
            faces.pop(face)
        elif fault == 4:
            faces[face].reverse()
        elif fault == 5:
            faces.append(list(faces[face]))
        elif fault == 6:  # a corner of its own, at the same place or near it
            corner = int(rng.integers(len(faces[face])))
            away = rng.normal(size=3) * 10.0 ** rng.uniform(-9, -3) * rng.integers(2)
            points = np.concatenate([points, points[faces[face][corner]] + away[None]])
            faces[face][corner] = len(points) - 1
        elif fault == 7:  # two vertices become one
            one, other = rng.integers(len(points), size=2).tolist()
            faces = [[one if corner == other else corner for corner in each] for each in faces]
            faces = [each for each in faces if len(set(each)) == len(each)]
        elif fault == 8:
            points[rng.integers(len(points))] += rng.normal(size=3) * rng.choice(
                [1e-8, 1e-6, 1e-3, 0.3, 2.0]
            )
        elif fault == 9:
            points = points * rng.choice([1e-6, 1e5]) + rng.normal(size=3)
        else:
            points[:, rng.integers(3)] *= 10.0 ** rng.uniform(-9, 0)
        if not faces:
            return whole(rng)
    used, numbers = np.unique(np.concatenate(faces), return_inverse=True)
    if rng.integers(10):  # else vertices of no face stay
        rows = np.split(numbers.ravel(), np.cumsum([len(face) for face in faces])[:-1])
        points, faces = points[used], [row.tolist() for row in rows]
    return points, faces


def body(rng):
    parts = [broken(rng) for _ in range(1 + 2 * (rng.integers(3) == 0))]
    apart = 6.0 * rng.integers(2)
    first = np.cumsum([0, *(len(points) for points, _ in parts)])
    points = np.concatenate([points + [apart * k, 0, 0] for k, (points, _) in enumerate(parts)])
    faces = [
        [corner + int(start) for corner in face]
        for start, (_, own) in zip(first, parts)
        for face in own
    ]
    return mesh(points, faces, np.float32)


def agree(one, other):
    """Compare nested values; floats to a relative 1e-9, because a stack may add in another
    order.
    """
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(
            agree(value, other[key]) for key, value in one.items()
        )
    if isinstance(one, (list, tuple)):
        return len(one) == len(other) and all(map(agree, one, other))
    if isinstance(one, (float, np.ndarray)):
        return close(other, one, 1e-9)
    return one == other


def assert_alike(stack, i, surface):
    alone, row = measure_alone(surface), stack[i]
    together, found_together = row.health, row.findings
    assert alone.method is row.method
    for one, other in ((alone.volume, stack.volume.at(i)), (alone.area, stack.area.at(i))):
        assert (np.abs(one.raw - other.raw) <= one.rounding_error).all()
        assert agree(one.about, other.about)
        for name in ("rounding_error", "input_error"):
            assert agree(getattr(one, name), getattr(other, name)), name
    assert agree(alone.health.as_record(), together.as_record())
    one, other = alone.health.defective_elements, together.defective_elements
    assert np.array_equal(one.boundary_edges, other.boundary_edges)
    findings = [
        [(found.code, found.values, np.asarray(found.elements).tolist()) for found in several]
        for several in (alone.findings, found_together)
    ]
    assert agree(findings[0], findings[1])
    assert close(row.exact_third_order().total, alone.volume.total, 1e-9)
    first, second = alone.parts(), row.parts()
    assert first.number == second.number and first.host_part.tolist() == second.host_part.tolist()
    assert np.array_equal(first.triangles, second.triangles) and agree(first.points, second.points)
    assert np.array_equal(first.face, second.face)
    # the numbers of components may differ
    assert len(np.unique(np.stack([first.part, second.part], axis=1), axis=0)) == first.number


def is_together(stack):
    return [isinstance(solid, SmallSolid) for solid in stack.solids]


FORMS = {
    "a mesh of its own edges": lambda surface: surface,
    "float64": lambda surface: replace(surface, points=surface.points.astype(float)),
    "triangles alone": lambda surface: Surface(surface.points, surface.all_triangles()[0]),
}


@pytest.mark.parametrize(
    "seed, form",
    [
        *((seed, FORMS["a mesh of its own edges"]) for seed in range(3)),
        *((3, form) for form in FORMS.values()),
    ],
)
def test_stacked_bodies_match_single_measurements(seed, form):
    rng = np.random.default_rng(seed)
    surfaces = [form(body(rng)) for _ in range(250)]
    stack = measure_stack(surfaces)
    measured = np.flatnonzero(is_together(stack))
    methods = [stack[i].method for i in measured.tolist()]
    assert 20 < methods.count(Procedure.CAPPED) < len(measured) - 20
    for i in measured.tolist():
        assert_alike(stack, i, surfaces[i])


def open_box(points=CORNERS, faces=SIDES[:5]):
    return mesh(points, [list(face) for face in faces], np.float32)


def pinched():
    """Two holes that share a vertex."""
    points, faces = lattice(6, 6, 0.0, np.random.default_rng(0))
    return mesh(points, [face for k, face in enumerate(faces) if k not in (0, 7)], np.float32)


def cracked(width):
    """The corner of one side of a box without lid, in another place."""
    faces = [list(face) for face in SIDES[:5]]
    faces[0][faces[0].index(0)] = 8
    return open_box(np.concatenate([CORNERS, CORNERS[:1] - width]), faces)


def gapped(*open_sides):
    """A box but for some sides; along one edge it has a vertex in one face alone."""
    faces = [list(side) for k, side in enumerate(SIDES) if k not in (0, *open_sides)]
    return open_box(np.concatenate([CORNERS, [[0, 0.5, 0]]]), [*faces, [8, 0, 1, 3, 2]])


NOT_TOGETHER = {
    "a gap without area": gapped,
    "a gap without area beside a hole": lambda: gapped(1),
    "holes that share a vertex": pinched,
    "vertices that a repair welds": lambda: cracked(3e-7),
    "vertices at one place": lambda: cracked(0.0),
    "a face that runs against the others": lambda: open_box(faces=[*SIDES[:4], SIDES[4][::-1]]),
    "a face twice": lambda: open_box(faces=[*SIDES[:5], SIDES[4]]),
    "inside out": lambda: open_box(faces=[side[::-1] for side in SIDES[:5]]),
    "flat": lambda: open_box(CORNERS * [1, 1, 1e-9]),
}


@pytest.mark.parametrize("name", NOT_TOGETHER)
def test_bodies_needing_more_than_caps_are_left_to_repair(name):
    whole_one = open_box()
    stack = measure_stack([whole_one, NOT_TOGETHER[name](), whole_one])
    assert is_together(stack) == [True, False, True]
    for i in (0, 2):
        assert_alike(stack, i, whole_one)


def test_a_diagonal_along_an_edge_is_left_to_be_repaired():
    """The repair counts it with the edge's own sides."""
    points = np.array(
        [[0, 0, 0], [2, 0, 0.5], [2, 2, 0], [0, 2, 0.5], [1, 1, 2], [1, 1, 0.1]], float
    )
    faces = [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [3, 0, 4], [0, 2, 5], [2, 0, 4]]
    surface = mesh(points, faces, np.float32)
    cuts = surface.all_triangles()[0]
    sides = np.stack([cuts, np.roll(cuts, -1, axis=1)], axis=2).reshape(-1, 2).tolist()
    assert len(sides) > len({tuple(side) for side in sides})
    for first in range(6):  # whichever vertex has the lowest number
        numbers = (np.arange(6) - first) % 6
        renumbered = mesh(
            points[np.argsort(numbers)], [numbers[face].tolist() for face in faces], np.float32
        )
        stack = measure_stack([open_box(), renumbered, open_box()])
        assert is_together(stack) == [True, False, True]


@pytest.mark.parametrize("way", [1, -1])
def test_bodies_needing_scaled_sums_are_measured_alone(way):
    """Sizes from a hundred powers of two on."""
    near, far = (
        2.0 ** (100 * way) * (1.0 - way * 2.0**-20),
        2.0 ** (100 * way) * (1.0 + way * 2.0**-20),
    )
    surfaces = [mesh((2.0 * CORNERS - 1.0) * size, SIDES, np.float32) for size in (1.0, far, near)]
    stack = measure_stack(surfaces)
    assert is_together(stack) == [True, False, True]
    for i in (0, 2):
        assert_alike(stack, i, surfaces[i])


def test_star_shaped_bodies_are_proved_together():
    parts = [
        moved(hourglass(heavy), offset=place)
        for heavy in (0.3, 1.5)
        for place in ((0, 0, 0), (8, -16, 4))
    ]
    surfaces = [mesh(points, triangles.tolist(), np.float32) for points, triangles in parts]
    for several in (surfaces, surfaces[:2], surfaces[2:]):
        stack = measure_stack(several)
        assert {row.health.self_intersection for row in stack.solids} == {Intersection.EXCLUDED}
        for i, surface in enumerate(several):
            assert_alike(stack, i, surface)


def test_warped_quads_are_compared_as_drawn():
    """Along the other diagonals they may have no volume, or one of the other sign."""
    rng, turned = np.random.default_rng(0), 0
    sides = [*SIDES[:5], [1, 5, 7], [1, 7, 3]]
    faces = [[corner + start for corner in side] for start in (0, 8) for side in sides]
    for _ in range(60):
        warped = CORNERS * [1, 1, 0.2] + rng.normal(size=(8, 3)) * 0.5
        points = np.concatenate([3 * CORNERS, warped + [20, 0, 0]])
        surface = mesh(points, faces, np.float32)
        cuts = surface.all_triangles()[0]
        drawn, cut = measure_solid(surface), measure_solid(mesh(points, cuts.tolist(), np.float32))
        assert drawn.method is cut.method and drawn.volume.total == pytest.approx(
            cut.volume.total, rel=1e-12
        )
        assert {found.code for found in cut.findings} == {
            found.code for found in drawn.findings if not found.code.startswith("non_planar")
        }
        turned += drawn.health.inverted_components
    assert 10 < turned < 50


@pytest.mark.filterwarnings("error")
def test_halved_quads_are_bent_beside_whole_quads():
    points = CORNERS.astype(float)
    points[7] += [0, 0, 0.2]
    whole_quads = mesh(points, SIDES)
    quads = whole_quads.quads
    halved = replace(
        whole_quads,
        triangles=np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        quads=quads[:0],
        triangle_faces=np.tile(np.arange(6), 2),
        quad_faces=np.zeros(0, int),
    )
    stack = measure_stack([whole_quads, halved])
    for i, surface in enumerate((whole_quads, halved)):
        assert_alike(stack, i, surface)
        assert [found.code for found in stack[i].findings] == ["non_planar_faces"]


@pytest.mark.parametrize("size", [2.0**-40, 2.0**15, 2.0**90, 2.0**125])
def test_stack_of_any_size_gives_no_numpy_warning(size):
    stack = measure_stack([mesh(CORNERS * size, SIDES, np.float32)] * 2)
    assert close(stack.volume.raw[:, 0], [size**3] * 2, 1e-14)
    assert all(is_together(stack)) == (size < 2.0**100)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_refused_surfaces_leave_the_rest_of_their_stack(dtype):
    whole_one = mesh(CORNERS, SIDES, dtype)
    empty = Surface(np.zeros((0, 3), dtype), np.zeros((0, 3), int))
    lost = mesh(CORNERS * [1, 1, np.nan], SIDES, dtype)
    stack = measure_stack([empty, whole_one, lost, whole_one])
    assert stack.volume.raw[:, 0].tolist() == [0.0, 1.0, 0.0, 1.0]
    assert stack.area.raw[:, 0].tolist() == [0.0, 6.0, 0.0, 6.0]
    for i, code in ((0, "no_faces"), (2, "non_finite_vertices")):
        with refused(code):
            stack[i]
    assert empty.coordinate_error.tolist() == [0.0] * 3
