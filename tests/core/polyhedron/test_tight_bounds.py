# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds are not only true but near: each has bodies whose error comes to a twentieth of it, so that one made twenty
times smaller is false."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import U, monomials
from body_moments.core.polyhedron import any_order, polyhedron_moments, third_order, third_order_small
from body_moments.core.polyhedron.any_order_kernel import Sums, absolute_sums
from body_moments.core.polyhedron.third_order_kernel import BlockSums

from tests.close import close
from tests.core import bodies, exact

NEAR = 1.0 / 20.0
TRIANGLE = np.array([[0, 1, 2]])
TETRAHEDRON = (
    bodies.box()[0][[0, 1, 2, 4]] * (3.0, 2.0, 1.5) + 0.1,
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)

# (by the kernel for few triangles, of areas) of 2,500 the ones that come nearest
SEEDS = {
    (True, False): (816, 1197, 922),
    (True, True): (2103, 772, 829),
    (False, False): (915,),
    (False, True): (1275, 396, 425),
}


def moved_against(part, order, area):
    """(K,) for each monomial the change, by its bound, of moments when float32 points are moved by half an ulp along
    each axis, in the directions in which the moment grows. The reference point is far away, where a monomial is nearly
    as large everywhere as at its largest."""
    points, triangles = (part[0] @ bodies.rotation(1).T + 50.0).astype(np.float32), part[1]
    surface = Surface(points, triangles)
    about = points.mean(axis=0) - 12.0 * np.ptp(points, axis=0).max()

    def measure(of):
        return polyhedron_moments(of, order, area_order=order, about=about, exact=True)[int(area)]

    given, points = measure(surface), points.astype(float)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal, growth = np.cross(b - a, c - a), np.zeros_like(points)
    unit = normal / np.linalg.norm(normal, axis=1)[:, None]
    for k, side in enumerate((c - b, a - c, b - a)):
        np.add.at(growth, triangles[:, k], np.cross(unit, side) if area else normal)
    ratios = np.zeros(len(given.raw))
    for sign in (1.0, -1.0):
        moved = measure(Surface(points + sign * np.sign(growth) * surface.coordinate_error, triangles))
        ratios = np.maximum(ratios, np.abs(moved.raw - given.raw) / given.input_error)
    return ratios


@pytest.mark.parametrize("order", [3, 7])
@pytest.mark.parametrize("part", [bodies.sphere(2), bodies.sphere(4), bodies.torus(40, 30)])
def test_what_float32_has_moved_of_a_volume_comes_near_its_bound(part, order):
    ratios = moved_against(part, order, area=False)
    assert (ratios <= 1.0).all() and (ratios >= 0.3).all()


@pytest.mark.parametrize("order, small", [(3, True), (3, False), (7, True)])
def test_what_float32_has_moved_of_an_area_comes_near_its_bound(monkeypatch, order, small):
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    ratios = moved_against(TETRAHEDRON if order == 3 else bodies.sphere(2), order, area=True)
    assert (ratios <= 1.0).all() and (ratios >= NEAR).all()


@pytest.mark.parametrize("area", [False, True])
@pytest.mark.parametrize("small", [True, False])
def test_rounding_comes_near_its_bound(monkeypatch, small, area):
    """Of one triangle, far from the reference point."""
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = np.zeros(20)
    for seed in SEEDS[small, area]:
        rng = np.random.default_rng(seed)
        points, about = rng.normal(size=(3, 3)), np.array([7.0, 5.0, 3.0]) * (1.0 + rng.random(3))
        found = polyhedron_moments(
            Surface(points, TRIANGLE), 3, area_order=3, about=about, exact=True, allow_open=True
        )[int(area)]
        truth = (exact.area_moments if area else exact.volume_moments)(points, TRIANGLE, about)
        errors = [abs(Fraction(float(value)) - right) for value, right in zip(found.raw, truth)]
        assert all(error <= Fraction(float(bound)) for error, bound in zip(errors, found.rounding_error))
        largest = np.maximum(largest, [float(e / Fraction(float(b))) for e, b in zip(errors, found.rounding_error)])
    degree = monomials(3).sum(axis=1)
    nearest = [largest[degree == k].max() >= NEAR for k in range(3)]
    assert nearest == [True] * 3 if small or not area else any(nearest)


@pytest.mark.parametrize("area", [False, True])
@pytest.mark.parametrize("small", [True, False])
def test_what_cancels_in_a_triangle_comes_near_its_bound(monkeypatch, small, area):
    """A cone from a point in the triangle's plane, which has no volume; a triangle of two edges along each other, which
    has no area: all that is found is rounding."""
    if not small:
        monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = 0.0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        a, edge, other = rng.normal(size=(3, 3))
        points = np.array([a, a + edge, a + (edge * rng.random() if area else other)])
        about = a + edge * rng.normal() + other * rng.normal()
        found = polyhedron_moments(
            Surface(points, TRIANGLE), 3, area_order=3, about=about, exact=True, allow_open=True
        )[int(area)]
        truth = (exact.area_moments if area else exact.volume_moments)(points, TRIANGLE, about)
        error = float(abs(Fraction(float(found.raw[0])) - truth[0]) / Fraction(float(found.rounding_error[0])))
        assert error <= 1.0
        largest = max(largest, error)
    assert largest >= NEAR


@pytest.mark.parametrize("area", [False, True])
def test_what_is_left_out_of_third_moments_is_their_bound(monkeypatch, area):
    """Of one triangle the terms of third order about the middle of an edge are left out, and are the bound."""
    monkeypatch.setattr(third_order, "MAX_TRIANGLES_EXACT_THIRD", 0)
    monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 0)
    largest = np.zeros(20)
    for seed in range(40):
        rng = np.random.default_rng(seed)
        points = rng.normal(size=(3, 3))
        options = {"area_order": 3, "about": points.mean(axis=0) + 0.1 * rng.normal(size=3), "allow_open": True}
        fast, slow = (
            polyhedron_moments(Surface(points, TRIANGLE), 3, exact=whole, **options)[int(area)]
            for whole in (False, True)
        )
        ratios = np.abs(fast.raw - slow.raw) / fast.rounding_error
        assert (ratios <= 1.0).all()
        largest = np.maximum(largest, ratios)
    assert (largest[10:] >= 0.9).all()


@pytest.mark.parametrize("order", [4, 9])
@pytest.mark.parametrize("area", [False, True])
def test_rounding_of_high_orders_is_counted(order, area):
    """Sums of thousands of terms round by less than they may; what they may is counted: numpy adds 128 numbers up in 25
    steps, each sum of a block's slices comes to 200 and more, and each degree takes eight operations."""
    points, triangles = bodies.sphere(1)
    about = np.array([-5.0, -6.0, -7.0])  # where no monomial changes its sign
    volume, surface = polyhedron_moments(Surface(points, triangles), order, area_order=order, about=about)
    found = surface if area else volume
    size = (
        exact.area_moments(points, triangles, about, order=order)
        if area
        else exact.volume_moments(points, triangles, about, order, absolute=True)
    )
    degree = monomials(order).sum(axis=1)
    assert (found.rounding_error >= U * (200.0 + 7.0 * degree) * np.array([float(value) for value in size])).all()
    reach = np.abs(points - about).max(axis=0)
    weight = float(np.multiply(1.0 if area else 1.0 / 3.0, float(sum(map(float, size[:1])))))
    assert (
        found.rounding_error
        <= 1e3 * U * (1.0 + degree) * max(weight, float(size[0])) * np.prod(reach ** monomials(order), axis=1)
    ).all()


@pytest.mark.parametrize("area", [False, True])
def test_rounding_of_few_triangles_is_counted(area):
    """A product of matrices may add its terms up one by one: a step for each triangle, and eight for each degree."""
    points, triangles = bodies.sphere(2)
    about = np.array([-5.0, -6.0, -7.0])
    found = polyhedron_moments(Surface(points, triangles), 3, area_order=3, about=about)[int(area)]
    measure = exact.area_moments if area else exact.volume_moments
    size = measure(points, triangles, about, **({} if area else {"absolute": True}))
    steps = len(triangles) + 7.0 * monomials(3).sum(axis=1)
    assert (found.rounding_error >= U * steps * np.array([float(value) for value in size])).all()


def derived_bounds(chunks, sizes, reach, half_ulp, steps, area):
    """(2, 20) and (2, 20) what rounding and storage may change in the sums over chunks of triangles, (side, base,
    count), with sums of their determinants and doubled areas: from the largest edges, one number after the other."""
    tau, edges, count = np.zeros(3), 0.0, 0
    for side, base, many in chunks:
        tau += [many * (side[j] * base[k] + side[k] * base[j]) for j, k in ((1, 2), (2, 0), (0, 1))]
        edges += many * (np.linalg.norm(side) + np.linalg.norm(base))
        count += many
    step = np.linalg.norm(half_ulp)
    double = sizes[1] * (1.0 + 1e-9) if area else np.linalg.norm(tau)
    swept = double / 2.0 + step * edges + 2.0 * step**2 * count  # by each unit of a step
    rounding, inputs = np.zeros((2, 2, 20))
    for number, powers in enumerate(monomials(3).tolist()):
        degree, largest = sum(powers), np.prod(np.array(reach) ** powers)
        moved = np.prod((np.array(reach) + half_ulp) ** powers)
        for which, weight in enumerate((np.dot(reach, tau), tau.sum())):
            off = 9.0 * U * weight
            terms = U * (sizes[which] * (1.0 + 1e-9) + off) * (8.0 * degree + steps)
            rounding[which, number] = (off + 1e-290 * count + terms) * largest * (1.0 if degree < 3 else 2.0)
        inputs[0, number] = step * swept * moved
        growth = sum(n * h / (r + h) for n, r, h in zip(powers, reach, half_ulp) if n and r + h)
        inputs[1, number] = moved * (step * (edges + 2.0 * step * count) + growth * swept)
    return rounding, inputs


BOX = ((2.0, 3.0, 5.0), (0.5, 0.25, 0.75), (7.0, 11.0))


@pytest.mark.parametrize("area", [False, True])
@pytest.mark.parametrize(
    "reach, half_ulp, sizes",
    [BOX, ((2.0, 3.0, 0.0), (0.5, 0.25, 0.0), (7.0, 11.0)), (BOX[0], (0.0,) * 3, BOX[2]), (*BOX[:2], (0.0, 0.0))],
)
@pytest.mark.parametrize("edge", [1.0, 0.0])
def test_bounds_are_those_that_are_derived(reach, half_ulp, sizes, edge, area):
    """Each cause alone, too: edges or weights that are zero leave what underflow may lose."""
    first = tuple(edge * np.array([1.0, 0.5, 2.0])), tuple(edge * np.array([0.25, 3.0, 1.5])), 3
    second = tuple(edge * np.array([4.0, 1.5, 0.5])), tuple(edge * np.array([2.0, 0.75, 1.0])), 8
    rows = [np.array([row, row]) for row in (reach, half_ulp, *first[:2], sizes)]
    found = third_order_small._error_bounds(*rows, np.array([[3], [3]]), area)
    for one, truth in zip(found, derived_bounds([first], sizes, reach, half_ulp, 3.0 * 3, area), strict=True):
        assert close(one, np.stack([truth, truth], axis=1), rel=1e-13)
    chunks = [first, second]
    sides, bases = (np.array([chunk[k] for chunk in chunks]).T for k in (0, 1))
    parts = np.array([0.25, 0.75]) * np.array(sizes)[:, None]
    sums = BlockSums(np.zeros(20), None, sides, bases, parts, np.array([3, 8]), 5)
    truth = derived_bounds(chunks, sizes, reach, half_ulp, 64.0 + 5, area)
    rest = np.zeros((2, 20))
    for number, powers in enumerate(monomials(3).tolist()):
        i, j, k = ([axis for axis, n in enumerate(powers) for _ in range(n)] + [0, 0, 0])[:3]
        for side, base, part in zip(sides.T, bases.T, parts.T):
            f, e = side + base / 2.0, base
            third = f[i] * f[j] * f[k] / 10.0
            third += (f[i] * e[j] * e[k] + e[i] * f[j] * e[k] + e[i] * e[j] * f[k]) / 120.0
            rest[:, number] += (1.0 + 1e-9) * third * part * (sum(powers) == 3)
    for whole in (True, False):
        job = SimpleNamespace(reach=np.array(reach), half_ulp=np.array(half_ulp), area=area, exact=whole)
        total, rounding, inputs = third_order._error_bounds(job, sums)
        assert close(total, sizes, rel=1e-15) and close(inputs, truth[1], rel=1e-13)
        assert close(rounding, truth[0] + (0.0 if whole else rest), rel=1e-13)


@pytest.mark.parametrize("area_order", [0, 3])
@pytest.mark.parametrize("small", [True, False])
def test_bounds_of_moments_are_those_of_their_sums_and_eight_roundings_more(monkeypatch, small, area_order):
    """With a rounding of one unit for each sum, of which the moments are shares."""
    module = third_order_small if small else third_order
    own = module._error_bounds

    def one_unit(*given):
        *sizes, rounding, inputs = own(*given)
        return *sizes, np.full_like(rounding, U), inputs

    monkeypatch.setattr(third_order, "MAX_SMALL_TRIANGLES", 1024 if small else 0)
    monkeypatch.setattr(module, "_error_bounds", one_unit)
    points, triangles = bodies.sphere(1)
    about = np.array([-5.0, -6.0, -7.0])
    volume, area = polyhedron_moments(Surface(points, triangles), 3, area_order=area_order, about=about)
    degree = monomials(3).sum(axis=1)
    assert close(volume.rounding_error, U / (2.0 * degree + 6.0) + 8.0 * U * np.abs(volume.raw), rel=1e-13)
    assert close(area.rounding_error, U / 2.0 + 8.0 * U * np.abs(area.raw), rel=1e-13)
    assert area.order == area_order


@pytest.mark.parametrize("order", [1, 4])
@pytest.mark.parametrize("corners", [3, 4])
@pytest.mark.parametrize("half_ulp", [(0.0, 0.0, 0.0), (0.5, 0.25, 0.125)])
def test_sizes_of_high_orders_are_those_that_are_derived(order, corners, half_ulp):
    """Of two blocks, of two chunks and of one: 32 faces each, as far as they reach, with their longest edges."""
    high = np.array([[3.0, 2.0, -1.0], [1.0, 4.0, 2.0], [0.5, 0.25, 6.0]])
    low = np.array([[-1.0, -2.5, -5.0], [-7.0, 1.0, -3.0], [0.125, -0.5, 2.0]])
    weights = np.array([[7.0, 11.0], [3.0, 5.0], [0.5, 2.0]])
    edges = np.array([[1.0, 2.0, 0.5], [3.0, 0.25, 4.0], [0.0, 1.5, 2.5]])[:, : corners - 1]
    for area in (False, True):
        chunks = np.concatenate([high, low, weights[:, : 1 + area], edges**2], axis=1).T
        blocks = [Sums(np.empty(0), part, np.array(half_ulp)) for part in (chunks[:, :2], chunks[:, 2:])]
        found, expected, step = absolute_sums(order, 1 + area, blocks), 0.0, np.linalg.norm(half_ulp)
        for top, bottom, (volume, surface), lengths in zip(high, low, weights, edges):
            reach = np.maximum(top, -bottom) + half_ulp
            pairs = list(zip(lengths[:-1], lengths[1:]))
            terms, sides = (32.0 * sum(of(*pair) for pair in pairs) for of in (np.multiply, np.add))
            double = surface + 27.0 * U * terms if area else terms
            added = step * (sides + 32.0 * 2.0 * len(pairs) * step)
            off = 9.0 * U * terms * reach.sum()
            rows = [volume + off, off, step * (double / 2.0 + added), double, 27.0 * U * terms, added]
            expected += np.outer(rows[: 6 if area else 3], np.prod(reach ** monomials(order), axis=1))
        assert close(found, expected, rel=1e-8) and (found >= expected * (1.0 + 1e-11)).all()
    lost = np.zeros((10, 1))  # 32 triangles that are a point: what underflow may lose of their edges
    (found,) = absolute_sums(0, 1, [Sums(np.empty(0), np.append(np.ones((6, 1)), lost[:3], 0), np.zeros(3))])[1]
    assert 9.0 * U * 32.0 * 3.0 * 1e-145 <= found <= 1.1e-12 * 1e-145


@pytest.mark.parametrize("reach, exponent", [(1.0, 0), (2.0**20 * 0.75, 20)])
@pytest.mark.parametrize("area", [False, True])
def test_bounds_of_high_orders_are_made_of_these_sizes(reach, exponent, area):
    """228 u and 8 u a degree of them, and 1e-220 for each face; in the body's own unit."""
    order, degree = 4, monomials(4).sum(axis=1)
    rng, half_ulp = np.random.default_rng(8), np.array([0.5, 0.25, 0.125])
    job = any_order._StreamIntegrator(order, True, 1, None, np.zeros(3), reach)
    total = any_order._CompensatedSum(order, 2)
    total.high, total.low = rng.uniform(1.0, 2.0, (2, 2, 35))
    total.sizes, total.faces = rng.uniform(1.0, 2.0, (6, 35)) * np.array([[1.0], [1e-14], [1.0]] * 2), 7
    sizes, scale = total.sizes[3:] if area else total.sizes[:3], 2.0 ** (exponent * (degree + (2.0 if area else 3.0)))
    mean = 2.0 if area else 2.0 * (degree + 3.0)
    found = job._moments(total, "area" if area else "volume")
    assert not found.input_error.any()
    expected = (U * (8.0 * degree + 228.0) * sizes[0] + sizes[1]) / mean
    assert close(found.rounding_error, expected * scale + 8.0 * U * np.abs(found.raw), rel=1e-8)
    least = expected * (1.0 + 1e-11) * scale + 8.0 * U * np.abs(found.raw)  # what the sizes are rounded by is added
    assert (found.rounding_error >= least).all()
    job.half_ulp, inputs = half_ulp * 2.0**exponent, sizes[2].copy()
    if area:
        rows = monomials(order).tolist()
        for number, powers in enumerate(rows):
            for axis, power in enumerate(powers):
                if power:
                    lower = rows.index([n - (k == axis) for k, n in enumerate(powers)])
                    inputs[number] += power * half_ulp[axis] / np.linalg.norm(half_ulp) * total.sizes[2, lower]
    moved = job._moments(total, "area" if area else "volume").input_error
    assert close(moved, inputs * scale, rel=1e-8) and (moved >= inputs * (1.0 + 1e-11) * scale).all()
    total.high, total.low, total.sizes = np.zeros((2, 35)), np.zeros((2, 35)), np.zeros((6, 35))
    assert close(job._moments(total, "area" if area else "volume").rounding_error, 7e-220 * scale, rel=1e-12)
    tiny = any_order._StreamIntegrator(order, True, 1, None, np.zeros(3), 2.0**-300)
    assert (tiny._moments(total, "area" if area else "volume").rounding_error > 0.0).all()


@pytest.mark.parametrize("degree", [0, 1, 2])
@pytest.mark.parametrize("name", ["rounding_error", "input_error"])
def test_bounds_of_mass_properties_are_near(name, degree):
    """Moments of one degree that are off by their bounds, all signs tried at random, far from the reference point."""
    part = bodies.moved(bodies.box((0, 0, 0), (1, 2, 3)), bodies.rotation(1))
    moments = polyhedron_moments(bodies.surface(part), 3, area_order=0, about=(-30.0, -20.0, -25.0))[0]
    moments = replace(moments, rounding_error=np.zeros(20), input_error=np.zeros(20))
    delta = 1e-7 * np.abs(moments.raw) * (monomials(3).sum(axis=1) == degree)
    given = MassProperties.from_moments(replace(moments, **{name: delta}), density=1000.0)
    bound, largest = getattr(given, name), {"mass": 0.0, "center": 0.0, "inertia": 0.0}
    rng = np.random.default_rng(0)
    for _ in range(400):
        off = MassProperties.from_moments(
            replace(moments, raw=moments.raw + delta * rng.choice([-1.0, 1.0], 20)), density=1000.0
        )
        for key in largest:
            change = np.linalg.norm(np.asarray(getattr(off, key)) - getattr(given, key))
            largest[key] = max(largest[key], float(change / max(np.linalg.norm(bound[key]), 1e-300)))
    moved = {0: ("mass", "center", "inertia"), 1: ("center", "inertia"), 2: ("inertia",)}[degree]
    assert all(0.4 <= largest[key] <= 1.0 + 1e-3 for key in moved), largest
