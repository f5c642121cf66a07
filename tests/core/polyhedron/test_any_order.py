# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of any order against rational arithmetic, which has no tolerance: the numbers' own
bounds, and the promised share of the absolute moment. Small blocks make small meshes take the path
of large ones.
"""

import math
import tracemalloc
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import monomial_count, monomials
from body_moments.core.polyhedron import any_order as recursion
from body_moments.core.polyhedron import any_order_kernel as levels
from body_moments.core.polyhedron import integration
from hypothesis import given
from hypothesis import strategies as st

from tests.close import close
from tests.core import exact
from tests.core.bodies import grid_torus
from tests.core.findings import refused
from tests.core.strategies import holds, random_meshes, seeds

# open faces count as given
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)


@pytest.fixture(params=["one block", "many blocks"])
def path(request, monkeypatch):
    if request.param == "many blocks":
        monkeypatch.setattr(recursion, "MAX_FACES_PER_BLOCK", 16)
        monkeypatch.setattr(levels, "FACES_PER_CHUNK", 4)


def octahedron(level=2, noise=0.0, seed=0):
    """A star-shaped body without triangles across a coordinate plane, its box centered on the
    origin.
    """
    points = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    for _ in range(level):
        halves, finer = {}, []
        for a, b, c in faces:
            middles = []
            for edge in ((a, b), (b, c), (c, a)):
                key = tuple(sorted(edge))
                if key not in halves:
                    halves[key] = len(points)
                    points.append(
                        tuple((x + y) / 2 for x, y in zip(points[edge[0]], points[edge[1]]))
                    )
                middles.append(halves[key])
            ab, bc, ca = middles
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    points = np.array(points, float)
    points[6:] *= 1.0 + noise * np.random.default_rng(seed).uniform(-1.0, 1.0, (len(points) - 6, 3))
    return points, np.array(faces)


def assert_within(moments, truth, error=None):
    error = moments.rounding_error if error is None else error
    for value, bound, right, monomial in zip(
        moments.raw, error, truth, monomials(moments.order).tolist(), strict=True
    ):
        assert abs(Fraction(float(value)) - right) <= Fraction(float(bound)), monomial


def share(moments, truth, absolute):
    """The largest error as a share of the absolute moment."""
    return max(
        float(abs(Fraction(float(value)) - right) / scale)
        for value, right, scale in zip(moments.raw, truth, absolute, strict=True)
    )


def test_all_moments_to_order_20_are_right_to_2e_15():
    points, triangles = octahedron(2, noise=0.3)
    volume, _ = polyhedron_moments(Surface(points, triangles), 20)
    assert len(volume.raw) == 1771 and not volume.about.any()
    truth = exact.volume_moments(points, triangles, order=20)
    assert (
        share(volume, truth, exact.volume_moments(points, triangles, order=20, absolute=True))
        < 2e-15
    )
    assert_within(volume, truth)


def test_body_10000_diameters_away_is_right_about_its_center():
    points, triangles = octahedron(2, noise=0.3)
    points = points + 20000.0 * np.array([1.0, -1.0, 0.5])
    volume, area = polyhedron_moments(Surface(points, triangles), 20, area_order=20)
    truth = exact.volume_moments(points, triangles, volume.about, order=20)
    absolute = exact.volume_moments(points, triangles, volume.about, order=20, absolute=True)
    assert share(volume, truth, absolute) < 1e-14
    assert_within(volume, truth)
    assert_within(area, exact.area_moments(points, triangles, volume.about, order=20))


@pytest.mark.parametrize("exact_scale", [2.0**40, 2.0**-20])
def test_body_beyond_the_range_of_powers_is_bounded_as_at_home(exact_scale):
    """The bound depends on the extent, not on the place."""
    points, triangles = octahedron(2)
    size = min(1.0, exact_scale)
    here, there = (
        polyhedron_moments(Surface(size * points + place, triangles), 20, area_order=20)
        for place in (0.0, exact_scale)
    )
    for near, far in zip(here, there):
        assert np.array_equal(near.raw, far.raw) and np.array_equal(
            near.rounding_error, far.rounding_error
        )


@pytest.mark.parametrize("order", [3, 5])
@pytest.mark.parametrize("cut", range(7))
def test_triangles_and_quads_may_be_as_many_as_they_like(path, order, cut):
    """A box with this many sides cut in two."""
    points = np.array(exact.box((0, 0, 0), (2, 3, 5)), float)
    halves = np.array(exact.fan(exact.BOX_QUADS[:cut]), int).reshape(-1, 3)
    body, told = Surface(points, halves, np.array(exact.BOX_QUADS[cut:], int).reshape(-1, 4)), []
    volume, area = polyhedron_moments(body, order, area_order=order, progress=told.append)
    assert_within(volume, exact.box_moments((-1, -1.5, -2.5), (1, 1.5, 2.5), order))
    assert close(area.total, 62.0, rel=1e-14) and told[-1] == 6 + cut


@pytest.mark.parametrize("order", [3, 5])
def test_quads_in_reversed_order_are_recognized(path, order):
    """Two triangles then share the edge that halves of one quad would share."""
    points, quads = grid_torus(12, 8, noise=0.05)
    backward = quads.reshape(12, 8, 4)[::-1].transpose(1, 0, 2).reshape(-1, 4)
    found, plain = (
        polyhedron_moments(Surface(points, quads=own), order, area_order=order)
        for own in (backward, quads)
    )
    for one, other in zip(found, plain):
        assert (np.abs(one.raw - other.raw) <= one.rounding_error + other.rounding_error).all()


def test_rounding_of_additions_is_recovered():
    total = recursion._CompensatedSum()
    rng = np.random.default_rng(0)
    values = [
        1.0,
        1e100,
        1.0,
        -1e100,
        *(rng.normal(size=2000) * 10.0 ** rng.uniform(-9.0, 9.0, 2000)),
    ]
    for value in values:
        total.add(1, np.array([[value]]), np.ones((3, 1)))
    assert close(total.high + total.low, [[math.fsum(values)]], rel=4e-16)


@pytest.mark.parametrize("order", [2, 6])
def test_pieces_of_other_storage_precision_have_own_bounds(order):
    """One piece as float64 and two as float32, one of these far away."""
    points, faces = octahedron()
    pieces = [
        Surface(points, faces),
        Surface((points / 3.0).astype(np.float32), faces),
        Surface((points / 7.0 + 1000.0).astype(np.float32), faces),
    ]
    measure = partial(polyhedron_moments, order=order, about=np.zeros(3), reach=1.0)
    alone = [measure(piece)[0].input_error for piece in pieces]
    assert not alone[0].any() and (alone[2] > alone[1]).all() and (alone[1] > 0.0).all()
    for turn in range(3):
        assert close(measure(pieces[turn:] + pieces[:turn])[0].input_error, sum(alone), rel=1e-12)


@holds(120)
@given(mesh=random_meshes(60, 1e-12), order=st.integers(4, 11))
def test_the_bounds_hold_for_random_meshes(path, mesh, order):
    points, triangles = mesh
    volume, area = polyhedron_moments(Surface(points, triangles), order, area_order=order)
    assert_within(volume, exact.volume_moments(points, triangles, volume.about, order))
    assert_within(area, exact.area_moments(points, triangles, area.about, order=order))


@pytest.mark.parametrize("order", [6, 20])
def test_the_bounds_are_not_vacuous(order):
    points, quads = grid_torus(100, 60)
    volume, area = polyhedron_moments(Surface(points, quads=quads), order, area_order=order)
    degree = monomials(order).sum(axis=1)
    reach = 1.4**degree
    assert (volume.rounding_error <= 1e-12 * volume.total * reach).all()
    assert (area.rounding_error <= 1e-12 * area.total * reach).all()
    # whose moments do not cancel, and mostly lie far inside the box
    even = (monomials(order) % 2 == 0).all(axis=1)
    assert (volume.rounding_error[even] <= 1e-11 * volume.raw[even]).all()
    assert (area.rounding_error[even] <= 1e-11 * area.raw[even]).all()


@holds(8)
@given(seed=seeds)
def test_the_input_bound_covers_every_float32_half_ulp(path, seed):
    rng = np.random.default_rng(seed)
    points, quads = grid_torus(7, 5, noise=0.03, seed=seed)
    points = (points * 10.0 ** rng.uniform(-3, 2) + 10.0 ** rng.uniform(-2, 3)).astype(np.float32)
    surface = Surface(points, Surface(points, quads=quads).all_triangles()[0])
    volume, area = polyhedron_moments(surface, 8, area_order=8)
    moved = points.astype(float) + surface.coordinate_error * rng.choice([-1.0, 1.0], points.shape)
    assert_within(
        volume,
        exact.volume_moments(moved, surface.triangles, volume.about, 8),
        volume.rounding_error + volume.input_error,
    )
    assert_within(
        area,
        exact.area_moments(moved, surface.triangles, area.about, order=8),
        area.rounding_error + area.input_error,
    )
    step = np.linalg.norm(surface.coordinate_error)
    assert volume.input_error[0] < 1.5 * step * area.total
    assert not polyhedron_moments(Surface(points.astype(float), surface.triangles), 8)[
        0
    ].input_error.any()


@pytest.mark.parametrize(
    "order, area_order", [(5, 2), (5, 0), (2, 5), (3, 1), (1, 3), (3, 0), (0, 0)]
)
def test_the_area_has_an_order_of_its_own(order, area_order):
    points, quads = grid_torus(12, 8, noise=0.05)
    surface = Surface(points, quads=quads)
    volume, area = polyhedron_moments(surface, order, area_order=area_order)
    assert (volume.order, area.order) == (order, area_order)
    triangles = surface.all_triangles()[0]
    assert_within(volume, exact.volume_moments(points, triangles, volume.about, order))
    assert_within(area, exact.area_moments(points, triangles, area.about, order=area_order))


@pytest.mark.parametrize("kind", ["i4", "i8", "f2", "f4", ">f4", ">f8"])
@pytest.mark.parametrize("order", [2, 6])
def test_corners_may_be_numbers_of_any_kind(path, order, kind):
    points, faces = octahedron()
    corners = 4.0 * points[faces]
    truth = polyhedron_moments([corners], order, area_order=order)
    found = polyhedron_moments([corners.astype(kind)], order, area_order=order)
    for right, made in zip(truth, found):
        assert (
            np.array_equal(made.about, right.about)
            and (np.abs(made.raw - right.raw) <= right.rounding_error).all()
        )


@pytest.mark.parametrize("order", [2, 6])
def test_pieces_make_the_whole(path, order):
    points, quads = grid_torus(12, 8, noise=0.05)
    triangles = Surface(points, quads=quads).all_triangles()[0]
    pieces = [
        points[triangles[:50]],
        Surface(points, triangles[50:90]),
        points[triangles[90:]].astype(np.float64),
    ]
    volume, area = polyhedron_moments(pieces, order, area_order=order)
    whole = polyhedron_moments(Surface(points, triangles), order, area_order=order)
    assert np.array_equal(volume.about, whole[0].about)
    for made, right in zip((volume, area), whole):
        assert (np.abs(made.raw - right.raw) <= made.rounding_error + right.rounding_error).all()
    about = np.array([0.25, 0.0, -0.5])
    streamed = polyhedron_moments(iter(pieces), order, area_order=order, about=about, reach=2.0)
    assert np.array_equal(streamed[0].about, about)
    assert_within(streamed[0], exact.volume_moments(points, triangles, about, order))
    pieces.insert(0, np.zeros((0, 3, 3)))
    # about the middle of the first that has faces
    blind = polyhedron_moments(iter(pieces), order, area_order=order)
    assert np.abs(blind[0].about - whole[0].about).max() > 0.01
    assert_within(blind[0], exact.volume_moments(points, triangles, blind[0].about, order))
    assert_within(blind[1], exact.area_moments(points, triangles, blind[1].about, order=order))
    back = blind[0].about_point(whole[0].about)
    assert (np.abs(back.raw - whole[0].raw) <= back.rounding_error + whole[0].rounding_error).all()


@pytest.mark.parametrize("exponent", [-30, 20])
def test_moments_scale_exactly_with_powers_of_two(exponent):
    points, quads = grid_torus(noise=0.05)
    plain = polyhedron_moments(Surface(points, quads=quads), 12)[0]
    scaled = polyhedron_moments(Surface(np.ldexp(points, exponent), quads=quads), 12)[0]
    assert np.array_equal(
        scaled.raw, np.ldexp(plain.raw, exponent * (monomials(12).sum(axis=1) + 3))
    )


def test_empty_surface_has_zero_moments():
    for order in (2, 5):
        for nothing in (Surface(np.zeros((0, 3))), [], iter(())):
            volume, area = polyhedron_moments(nothing, order, area_order=order)
            assert not volume.raw.any() and len(area.raw) == monomial_count(order)
            assert np.array_equal(volume.about, np.zeros(3)) and np.array_equal(
                area.about, np.zeros(3)
            )
        for moments in polyhedron_moments([], order, area_order=order, about=(1.0, 2.0, 3.0)):
            assert np.array_equal(moments.about, (1.0, 2.0, 3.0))


@pytest.mark.parametrize("order", [2, 5])
def test_unmeasurable_input_is_refused(order):
    points, quads = grid_torus()
    for wrong in (quads + 1, quads - 1):
        for faces in ({"quads": wrong}, {"triangles": wrong[:, :3]}):
            with pytest.raises(ValueError, match="vertex"):
                polyhedron_moments(Surface(points, **faces), order)
    for bad in (np.nan, np.inf, -np.inf):
        with pytest.raises(ValueError, match="finite"):
            polyhedron_moments(Surface(np.where(points > 1.0, bad, points), quads=quads), order)
    for wrong in (np.zeros((4, 3)), np.zeros((4, 3, 3), complex)):
        with pytest.raises(ValueError, match="corners"):
            polyhedron_moments([wrong], order)
    for about in ((0.0, 1.0), (0.0, np.nan, 0.0)):
        with pytest.raises(ValueError, match="about"):
            polyhedron_moments(Surface(points, quads=quads), order, about=about)
    for wrong in (-1, 2.5, 2.0, "3", None):
        with pytest.raises(ValueError, match="order"):
            polyhedron_moments(Surface(points, quads=quads), wrong)
    with pytest.raises(ValueError, match="order"):
        polyhedron_moments(Surface(points, quads=quads), order, area_order=-1)


def test_overflowing_moments_are_refused():
    points, quads = grid_torus()
    with refused("moments_overflow", order=20):
        polyhedron_moments(Surface(points * 1e20, quads=quads), 20)
    triangles = points[quads[:, :3]]
    with pytest.raises(ValueError, match="reach"):
        polyhedron_moments(iter([triangles[:1] * 1e-30, triangles]), 20)


def test_moments_may_be_a_thousand_powers_of_two_large():
    """At order 17, with 20 factors, the reach may have 50 of them; in a stream 48 more than
    stated.
    """
    points, faces = octahedron()
    points *= 0.75
    for exponent, is_measured in ((50, True), (51, False)):
        body = Surface(points * 2.0**exponent, faces)
        if is_measured:
            assert np.isfinite(polyhedron_moments(body, 17)[0].raw).all()
        else:
            with refused("moments_overflow", order=17):
                polyhedron_moments(body, 17)
    for exponent, is_measured in ((48, True), (49, False)):
        stream, about = iter([points[faces] * 2.0**exponent]), np.zeros(3)
        if is_measured:
            assert np.isfinite(polyhedron_moments(stream, 17, about=about, reach=1.0)[0].raw).all()
        else:
            with pytest.raises(ValueError, match="reach"):
                polyhedron_moments(stream, 17, about=about, reach=1.0)


@pytest.mark.filterwarnings("error")
def test_overflow_at_low_orders_is_refused_and_the_limit_told():
    points, quads = grid_torus()
    triangles = points[quads[:, :3]] * 1e60
    whole = polyhedron_moments(iter([triangles, triangles]), 1)[0]
    assert whole.total == pytest.approx(
        2e180 * polyhedron_moments([points[quads[:, :3]]], 1)[0].total, rel=1e-12
    )
    for order in (3, 4):
        with refused("moments_overflow", order=order):
            polyhedron_moments(iter([triangles, triangles]), order)
        with refused("moments_overflow", order=order):
            polyhedron_moments(Surface(points * 1e60, quads=quads), order)
    with refused("moments_overflow", order=3):  # one infinite, the other its negative
        polyhedron_moments(iter([triangles, triangles[:, ::-1]]), 3)
    corners = octahedron(1, noise=0.3)[0][octahedron(1)[1]]
    largest = np.abs(polyhedron_moments(iter([corners]), 3)[0].raw[10:]).max()
    corners = corners * 1.2e308 ** (1.0 / 6.0) * largest ** (-1.0 / 6.0)
    assert np.isfinite(polyhedron_moments(iter([corners]), 3)[0].raw).all()
    with refused("moments_overflow", order=3):  # each of two is in the range, their sum is not
        polyhedron_moments(iter([corners, corners]), 3)


def test_a_stream_is_never_in_memory_as_a_whole():
    """A torus of 250,000 triangles, made in strips; as arrays it would take 18 MB."""
    n, m, strip = 500, 250, 25

    def strips():
        for start in range(0, n, strip):
            points, quads = grid_torus_strip(n, m, start, strip)
            yield Surface(points, quads=quads)

    tracemalloc.start()
    volume, _ = polyhedron_moments(strips(), 4, about=np.zeros(3), reach=1.4)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 12e6  # one block's scratch is most of it
    assert volume.total == pytest.approx(2 * np.pi**2 * 0.4**2, rel=2e-4)
    assert volume[0, 0, 2] == pytest.approx(np.pi**2 / 2 * 0.4**4, rel=4e-4)


def grid_torus_strip(n, m, start, count):
    """Yield some of the rings of quads of `grid_torus(n, m)`."""
    u, v = np.meshgrid(
        (start + np.arange(count + 1)) % n * (2 * np.pi / n),
        np.arange(m) * (2 * np.pi / m),
        indexing="ij",
    )
    points = np.stack(
        [(1 + 0.4 * np.cos(v)) * np.cos(u), (1 + 0.4 * np.cos(v)) * np.sin(u), 0.4 * np.sin(v)],
        axis=-1,
    )
    i, j = np.meshgrid(np.arange(count), np.arange(m), indexing="ij")
    corners = [(i, j), (i + 1, j), (i + 1, (j + 1) % m), (i, (j + 1) % m)]
    return points.reshape(-1, 3), np.stack([(a * m + b).ravel() for a, b in corners], axis=1)
