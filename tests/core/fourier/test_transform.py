# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier transforms of bodies and surfaces against 120 digits, closed forms, symmetries and
moments.
"""

import math
from functools import partial

import numpy as np
import pytest
from body_moments.core.fourier.transform import Transform, solid_transform, surface_transform
from body_moments.core.fourier.wave_vectors import FrequencyGrid
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import integration
from body_moments.core.verdict import TOO_LARGE, TOO_SMALL, MeasureError

from tests.close import close
from tests.core import bodies, exact
from tests.core.findings import refused

# open faces count as given
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)

TETRAHEDRON = (
    np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0], [0.5, 0.75**0.5 / 3, (2 / 3) ** 0.5]]),
    np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
)
BOX = bodies.box((0, 0, 0), (1, 1.5, 0.7))
BODIES = {
    "tetrahedron": TETRAHEDRON,
    "box": BOX,
    "box off center": bodies.moved(BOX, None, (10, -7, 5)),
    "sphere": bodies.sphere(1),
}
SIZES = (1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.5, 3.0, 5.0, 20.0, 100.0, 1000.0)


@pytest.fixture(scope="module")
def truth():
    pytest.importorskip("mpmath")
    from tests.core import fourier_truth

    return fourier_truth


def directions(part):
    """Random, along a face's normal, along its edge, across that edge in the face; and near each of
    the last three.
    """
    rng = np.random.default_rng(5)
    a, b, c = part[0][part[1][0]]
    normal, edge = np.cross(b - a, c - a), b - a
    special = np.stack([normal, edge, np.cross(normal, edge)])
    special /= np.linalg.norm(special, axis=1)[:, None]
    near = [special + size * rng.normal(size=(3, 3)) for size in (1e-9, 1e-5)]
    some = rng.normal(size=(1, 3))
    return np.concatenate([some / np.linalg.norm(some), special, *near])


def length(part):
    return np.ptp(part[0], axis=0).max()


@pytest.mark.parametrize("name", BODIES)
def test_a_body_is_right_to_1e_14_of_its_volume_at_any_frequency(name, truth):
    part = BODIES[name]
    sizes = SIZES[1::3] if name == "sphere" else SIZES
    q = np.concatenate([directions(part) * size / length(part) for size in sizes])
    found = solid_transform(bodies.surface(part), q)
    true = np.array([truth.solid(*part, row) for row in q])
    error = np.abs(found.values - true)
    assert error.max() <= 1e-14 * bodies.volume(part)
    assert (error <= found.error).all()
    assert found.error.max() <= 2e-13 * bodies.volume(part)


@pytest.mark.parametrize(
    "squash", [(1, 1, 1e-3), (1, 1, 1e-6), (1, 1, 1e-9), (1e-6, 1, 1e-7), (1e-9, 1, 1e-9)]
)
def test_slivers_are_right_to_1e_15_of_area_times_length(squash, truth):
    for part in (TETRAHEDRON, BOX):
        part = bodies.moved((part[0] * squash, part[1]), bodies.rotation(3))
        q = np.concatenate([directions(part) * size / length(part) for size in SIZES[2::3]])
        found = solid_transform(bodies.surface(part), q)
        error = np.abs(found.values - [truth.solid(*part, row) for row in q])
        total = polyhedron_moments(bodies.surface(part), area_order=0)[1].total
        assert error.max() <= 1e-15 * total * length(part)
        assert (error <= found.error).all()


def test_a_mesh_with_needles_and_corners_in_line_is_right(truth):
    points, triangles = BOX
    points = np.concatenate([points, [[0.5, 0, 0], [0.5 + 1e-13, 0, 0]]])
    edge = [row for row in triangles if {0, 4} <= set(row.tolist())]
    assert len(edge) == 2
    cut = []
    for row in triangles:
        row = row.tolist()
        if not {0, 4} <= set(row):
            cut.append(row)
            continue
        while row[2] in (0, 4):
            row = row[1:] + row[:1]
        chain = [row[0], *((8, 9) if row[0] == 0 else (9, 8)), row[1]]
        cut += [[a, b, row[2]] for a, b in zip(chain, chain[1:])]
    cut.append([0, 8, 9])  # without area
    q = np.concatenate([directions(BOX) * size for size in SIZES[2::2]])
    found = solid_transform(Surface(points, np.array(cut)), q)
    assert np.abs(found.values - [truth.solid(points, cut, row) for row in q]).max() <= 1e-14 * 1.05


def test_surface_transform_is_right_to_1e_14_of_its_area(truth):
    for part in (
        TETRAHEDRON,
        bodies.without(BODIES["box off center"], *bodies.TOP),
        bodies.grid(2),
    ):
        q = np.concatenate(
            [[[0, 0, 0]], *(directions(part) * size / length(part) for size in SIZES[::3])]
        )
        found = surface_transform(bodies.surface(part), q)
        error = np.abs(found.values - [truth.area(*part, row) for row in q])
        total = polyhedron_moments(bodies.surface(part), area_order=0)[1].total
        assert error.max() <= 1e-14 * total
        assert (error <= found.error).all()


def box_spectrum(low, high, q):
    """The closed form of an axis-aligned box."""
    low, high = np.array(low, float), np.array(high, float)
    sides = (high - low) * np.sinc(q * (high - low) / (2 * np.pi))
    return np.prod(sides * np.exp(-0.5j * q * (low + high)), axis=1)


def test_a_box_has_its_closed_form_on_a_grid():
    for count in (2, 7, 12):
        grid = FrequencyGrid(count, 40.0)
        found = solid_transform(bodies.surface(BOX), grid)
        assert np.array_equal(found.q, grid.vectors())
        assert np.abs(found.values - box_spectrum((0, 0, 0), (1, 1.5, 0.7), found.q)).max() <= 1e-14


def test_grid_matches_the_list_of_its_vectors():
    part = bodies.moved(bodies.sphere(2), np.diag([1, 0.5, 2]), (3, 1, -2))
    for grid in (FrequencyGrid(9, 0.02), FrequencyGrid(8, 30.0), FrequencyGrid(5, 2000.0)):
        for transform in (solid_transform, surface_transform):
            found, listed = (transform(bodies.surface(part), q) for q in (grid, grid.vectors()))
            assert np.abs(found.values - listed.values).max() <= 3e-14


def test_the_taylor_coefficients_are_the_moments():
    part = bodies.moved(
        bodies.sphere(2), [[1, 0.2, 0], [0, 0.8, 0.1], [0.3, 0, 1.1]], (0.2, -0.1, 0.4)
    )
    raw = dict(zip(exact.MONOMIALS, map(float, exact.volume_moments(*part))))
    q = np.random.default_rng(6).normal(size=(30, 3))
    q *= 1e-3 / np.linalg.norm(q, axis=1)[:, None]
    found = solid_transform(bodies.surface(part), q).values
    order = [
        sum(
            (-1j) ** n
            * np.prod(q ** np.array(m), axis=1)
            / np.prod([math.factorial(k) for k in m])
            * raw[m]
            for m in exact.MONOMIALS
            if sum(m) == n
        )
        for n in range(4)
    ]
    size = raw[0, 0, 0]
    # real parts hold even orders only, imaginary ones odd orders: what is left is of fourth and of
    # fifth order
    assert np.abs(found.real - (order[0] + order[2]).real).max() <= 1e-12 * size
    assert np.abs(found.imag - (order[1] + order[3]).imag).max() <= 1e-14 * size
    assert np.abs(order[2]).min() >= 1e-8 * size and np.abs(order[3]).max() >= 1e-11 * size


def test_zero_and_frequencies_beyond_all_digits_give_the_volume():
    part = bodies.moved(BOX, None, (10, -7, 5))
    q = np.array([[0, 0, 0], [1e-300, 0, 0], [0, -1e-40, 1e-40], [1e-19, 1e-19, 0]])
    found = solid_transform(bodies.surface(part), q)
    assert np.abs(found.values.real - 1.05).max() <= 1e-14
    center = np.array([10.5, -6.25, 5.35])
    assert found.values.imag == pytest.approx(-1.05 * (q @ center), rel=1e-14, abs=1e-310)


@pytest.mark.parametrize("power", [-120, -40, 40, 120])
def test_tiny_and_huge_bodies_are_the_same_problem(power):
    scale = 2.0**power
    points, triangles = bodies.moved(BOX, None, (1, 2, 3))
    q = np.random.default_rng(2).normal(size=(20, 3)) * np.logspace(-3, 2, 20)[:, None]
    plain, scaled = (
        solid_transform(Surface(points * s, triangles), q / s).values for s in (1.0, scale)
    )
    assert np.array_equal(plain * scale**3, scaled)


def test_unused_points_cost_no_digits():
    part = np.concatenate([BOX[0], [[1e9, 0, 0]]]), BOX[1]
    q = np.random.default_rng(3).normal(size=(30, 3)) * 5
    found = solid_transform(Surface(*part), q).values
    assert np.abs(found - box_spectrum((0, 0, 0), (1, 1.5, 0.7), q)).max() <= 1e-14
    part[0][-1] = (9.0, -4.0, 5.0)
    found = solid_transform(Surface(*part), q * 1e-23).values
    assert close(found.real, 1.05, rel=1e-14) and close(
        found.imag, -1.05e-23 * (q @ (0.5, 0.75, 0.35)), rel=1e-12
    )


def test_quads_are_cut_as_for_the_moments():
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0], [0.5, 0.5, -1]], np.float32)
    surface = Surface(
        points,
        triangles=np.array([[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]]),
        quads=np.array([[0, 1, 2, 3]]),
    )
    assert close(
        solid_transform(surface, [[0.0, 0.0, 1e-9]]).values[0].real,
        polyhedron_moments(surface)[0].total,
        rel=1e-14,
    )


def test_the_shells_of_one_surface_add():
    inner = bodies.inverted(bodies.box((0.2, 0.2, 0.2), (0.5, 0.9, 0.4)))
    q = np.random.default_rng(3).normal(size=(30, 3)) * 5
    found = solid_transform(bodies.surface(bodies.joined(BOX, inner)), q).values
    true = box_spectrum((0, 0, 0), (1, 1.5, 0.7), q) - box_spectrum(
        (0.2, 0.2, 0.2), (0.5, 0.9, 0.4), q
    )
    assert np.abs(found - true).max() <= 1e-14


def test_float32_storage_error_is_reported():
    part = bodies.moved(bodies.sphere(2), None, (100, 0, 0))
    stored = bodies.surface(part, np.float32)
    q = np.random.default_rng(4).normal(size=(60, 3)) * np.logspace(-2, 2, 60)[:, None]
    found, true = solid_transform(stored, q), solid_transform(bodies.surface(part), q)
    difference = np.abs(found.values - true.values).max()
    assert 1e-8 < difference <= found.input_error < 1e-3
    assert true.input_error == 0.0


def test_an_open_surface_is_refused_and_an_unwelded_one_is_not():
    sphere = bodies.sphere(2)
    for part in (
        bodies.without(sphere, 3),
        bodies.without(BOX, *bodies.TOP),
        bodies.grid(3),
        bodies.with_flipped(sphere, 5),
    ):
        with refused("fourier_of_open_surface"):
            solid_transform(bodies.surface(part), [[1.0, 0.0, 0.0]])
    tube = bodies.without(BOX, 0, 1, *bodies.TOP)  # its faces' normals add up to zero
    with refused("fourier_of_open_surface"):
        solid_transform(bodies.surface(tube), [[1.0, 0.0, 0.0]])
    q = [[1.0, 2.0, 3.0]]
    apart, whole = (
        solid_transform(bodies.surface(part), q).values[0] for part in (bodies.soup(sphere), sphere)
    )
    assert abs(apart - whole) <= 1e-14


@pytest.mark.parametrize("share, is_closed", [(0.5e-6, True), (2e-6, False)])
def test_hole_of_a_millionth_of_the_area_is_ignored(share, is_closed):
    """A needle along an edge of a unit cube is left out, whose normal is half along the wave that
    is looked at.
    """
    points, triangles = bodies.box()
    a, b, c = triangles[0].tolist()
    middle, edge = (points[a] + points[b]) / 2.0, np.linalg.norm(points[b] - points[a])
    inward = points[c] - middle
    normal = np.cross(points[b] - points[a], points[c] - points[a])
    normal /= np.linalg.norm(normal)
    wave = np.array([0.48, 0.6, 0.64])
    height = share * 6.0 / np.linalg.norm(np.cross(normal, wave)) * 2.0 / edge
    along = (points[b] - points[a]) / edge
    inward = inward - (inward @ along) * along
    points = np.concatenate([points, [middle + height * inward / np.linalg.norm(inward)]])
    part = points, np.array([[b, c, 8], [c, a, 8], *triangles[1:]])
    if is_closed:
        assert abs(solid_transform(bodies.surface(part), np.zeros((1, 3))).values[0] - 1.0) <= 1e-6
    else:
        with refused("fourier_of_open_surface"):
            solid_transform(bodies.surface(part), np.zeros((1, 3)))


@pytest.mark.parametrize(
    "q",
    [
        [1.0, 2.0, 3.0],
        [[1.0, 2.0]],
        [["a", "b", "c"]],
        [[1j, 0, 0]],
        [[np.nan, 0, 0]],
        [[np.inf, 0, 0]],
        [[[0.0, 0.0, 0.0]]],
    ],
)
def test_invalid_wave_vectors_are_refused(q):
    with refused("wave_vectors_shape", "wave_vectors_range"):
        solid_transform(bodies.surface(BOX), q)


@pytest.mark.parametrize(
    "part",
    [
        (BOX[0], BOX[1] + 3),
        (BOX[0], -BOX[1] - 1),
        (BOX[0] * [1, np.nan, 1], BOX[1]),
        (BOX[0], BOX[1][:0]),
    ],
)
def test_broken_surfaces_are_refused(part):
    for transform in (solid_transform, surface_transform):
        with pytest.raises((MeasureError, ValueError)):
            transform(Surface(*part), [[1.0, 0.0, 0.0]])


def test_steps_tell_how_much_is_done_and_can_be_left():
    surface = bodies.surface(bodies.sphere(4))
    for threads in (1, 2):
        transform = Transform(surface, FrequencyGrid(8, 20.0), "volume", threads)
        shares = list(transform.steps())
        assert shares == sorted(shares) and shares[-1] == 1.0 and len(shares) > 3
        left = Transform(surface, FrequencyGrid(8, 20.0), "volume", threads).steps()
        next(left)
        left.close()


def test_transform_is_as_exact_as_libformfactor(truth):
    """BornAgain's form factors are libformfactor's: ∫ exp(+i q·r) over a tetrahedron that stands on
    its base. It is large, and in the environment of one Blender.
    """
    bornagain = pytest.importorskip("bornagain", reason="needs BornAgain")
    body = bornagain.PlatonicTetrahedron(1.0)
    around = 2 * np.pi / 3 * np.arange(1, 4)
    base = np.stack([np.cos(around), np.sin(around), np.zeros(3)], axis=1) / 3**0.5
    part = np.concatenate([base, [[0, 0, (2 / 3) ** 0.5]]]), TETRAHEDRON[1]
    for size in (1e-6, 0.01, 0.02, 0.03, 0.1, 1.0, 10.0, 100.0):
        q = directions(part) * size
        true = np.array([truth.solid(*part, -row) for row in q])
        ours = np.abs(solid_transform(bodies.surface(part), -q).values - true).max()
        peer = np.abs(
            [complex(body.formfactorAtBottom(bornagain.C3(*row))) for row in q.tolist()] - true
        ).max()
        assert ours <= max(peer, 1e-15 * bodies.volume(part))


def test_quads_with_invalid_indices_are_refused():
    for index in (8, -1, 2**40):
        quads = bodies.SIDES.astype(np.int64)
        quads[3, 2] = index
        with pytest.raises(ValueError, match="vertex"):
            surface_transform(Surface(bodies.CORNERS, quads=quads), np.ones((1, 3)))


def test_unrepresentable_transform_is_refused():
    points, triangles = bodies.box()
    for scale in (1e-200, 1e-120, 1e60, 1e200):
        with refused("object_size", fault=TOO_SMALL if scale < 1.0 else TOO_LARGE):
            solid_transform(Surface.from_triangles(points * scale, triangles), np.zeros((1, 3)))
    with refused("wave_vectors_range"):
        solid_transform(Surface.from_triangles(points, triangles), np.full((1, 3), 1.7e308))
    for size in (1.01e100, 1e200):
        with refused("frequencies_invalid"):
            FrequencyGrid(8, size)
        with refused("wave_vectors_range"):
            solid_transform(
                Surface.from_triangles(points, triangles), np.array([[0.0, -size, 0.0]])
            )
    assert FrequencyGrid(8, 1e100).largest == 1e100
    found = solid_transform(Surface.from_triangles(points, triangles), np.full((1, 3), 1e100))
    assert abs(found.values[0]) <= found.error[0] < 1e-13
