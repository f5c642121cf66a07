# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of trivariate densities against exact rational arithmetic, closed forms and each
other.
"""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.density.spline_grid import SplineAxis, density_moments, grid_moments
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.moments.raw import monomials
from body_moments.tests.core.trivariate import exact_moments

from tests.close import close
from tests.core.findings import refused


def knots(rng, order: int, count: int) -> np.ndarray:
    return np.sort(rng.integers(-64, 64, count + order)) / 16.0


def spline(orders, seed=0, signed=False):
    rng = np.random.default_rng(seed)
    axes = [SplineAxis(knots(rng, order, 4 + i), order) for i, order in enumerate(orders)]
    coefficients = rng.integers(-9 if signed else 0, 9, [axis.count for axis in axes]) / 8.0
    return coefficients, axes


def check(moments, coefficients, axes, relative=1e-13):
    """Against exact values: within the stated bound, and within `relative` of each moment's natural
    size.
    """
    exact = exact_moments(coefficients, axes, moments.order, moments.about)
    size = exact_moments(np.abs(coefficients), axes, 0, moments.about)[0]
    reach = max(
        np.abs(axis.knots[[0, -1]] - center).max() for axis, center in zip(axes, moments.about)
    )
    for value, bound, truth, degree in zip(
        moments.raw, moments.rounding_error, exact, monomials(moments.order).sum(axis=1)
    ):
        off = abs(float(Fraction(value) - truth))
        assert off <= bound
        assert off <= relative * float(size) * reach**degree


@pytest.mark.parametrize(
    "orders", [(1, 1, 1), (2, 2, 2), (3, 4, 1), (4, 4, 4), (5, 2, 6), (6, 6, 6)]
)
@pytest.mark.parametrize("signed", [False, True])
def test_any_order_and_knots_against_exact_arithmetic(orders, signed):
    coefficients, axes = spline(orders, sum(orders), signed)
    check(density_moments(coefficients, axes, 4), coefficients, axes)


@pytest.mark.parametrize(
    "order, signed", [(1, False), (2, False), (3, False), (4, False), (4, True)]
)
def test_grid_moments_to_order_20_match_fractions(order, signed):
    rng = np.random.default_rng(order)
    coefficients = rng.integers(-9 if signed else 0, 9, (4, 3, 5)) / 4.0
    axes = [SplineAxis.uniform(count, order) for count in coefficients.shape]
    moments = density_moments(coefficients, axes, 20)
    check(moments, coefficients, axes, 1e-12)
    exact = exact_moments(coefficients, axes, 20, moments.about)
    table = monomials(20)
    for value, bound, truth, powers in zip(
        moments.raw, moments.rounding_error, exact, table.tolist()
    ):
        if not signed and not any(power % 2 for power in powers):  # nothing cancels
            assert abs(Fraction(value) - truth) <= truth / 10**12
            # (|t| + w)^l is far from sharp
            assert bound <= (1e-11 if sum(powers) < 4 else 1e-2) * float(truth)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("value, order", [(0.5, 2), (0.5, 3), (5.0, 2)])
@pytest.mark.parametrize(
    "place, is_near", [(6, False), (7, False), (8, True), (12, True), (13, False)]
)
def test_moments_of_distant_mass_are_about_a_nearby_knot(axis, value, order, place, is_near):
    """A voxel has a variance of 1/12 about its middle: three from the middle of all is 108 of
    these, two is 48.
    """
    values = np.zeros(np.roll([21, 1, 1], axis))
    values[tuple(np.roll([place, 0, 0], axis))] = value
    axes = [SplineAxis.uniform(count) for count in values.shape]
    found = density_moments(values, axes, order)
    about = np.roll(found.about, -axis)
    assert about[0] == 10.0 if is_near else abs(about[0] - place) == 0.5
    assert (
        density_moments(values, axes, 1).about.tolist() == np.roll([10.0, 0.0, 0.0], axis).tolist()
    )
    check(found, values, axes)


def test_bounds_are_not_wild():
    coefficients, axes = spline((4, 4, 4))
    moments = density_moments(coefficients, axes, 2)
    assert moments.rounding_error[0] < 1e-13 * moments.total
    assert moments.rounding_error[[4, 7, 9]].max() < 1e-11 * moments.raw[[4, 7, 9]].min()


@pytest.mark.parametrize(
    "dtype", [np.float32, np.float64, np.uint8, np.int16, np.int64, np.bool_, ">f4", ">i2"]
)
@pytest.mark.parametrize("layout", ["C", "F", "reversed", "strided"])
def test_any_type_and_layout_gives_the_same_numbers(dtype, layout):
    rng = np.random.default_rng(1)
    values = rng.integers(0, 2, (5, 6, 7))
    axes = [SplineAxis.uniform(count, 4) for count in values.shape]
    array = np.asarray(values, dtype, order="F" if layout == "F" else "C")
    if layout == "reversed":
        array = np.ascontiguousarray(array[::-1, :, ::-1])[::-1, :, ::-1]
    elif layout == "strided":
        array = np.repeat(np.repeat(array, 2, axis=1), 3, axis=2)[:, ::2, ::3]
    expected = density_moments(values.astype(float), axes)
    found = density_moments(array, axes)
    assert (
        np.abs(found.raw - expected.raw) <= found.rounding_error + expected.rounding_error
    ).all()
    check(found, values, axes)


def test_one_voxel_in_the_corner_of_a_large_grid_is_a_unit_cube():
    values = np.zeros((300, 300, 300), np.uint8)
    values[299, 0, 7] = 1
    body = MassProperties.from_moments(grid_moments(values, values.shape, np.eye(4)))
    assert body.mass == 1.0
    assert body.center == pytest.approx([299, 0, 7], abs=1e-13)
    assert np.abs(body.inertia - np.eye(3) / 6.0).max() <= 1e-14


@pytest.mark.parametrize("order", range(1, 7))
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e6])
def test_smoothing_adds_mass_times_k_twelfths_of_spacing_squared(order, scale):
    """The whole of the paper's gain over the discrete sum: I_xx = discrete + M k g² / 6."""
    rng = np.random.default_rng(2)
    values = rng.random((4, 5, 6))
    spacing = np.array([0.5, 0.25, 2.0]) * scale
    matrix = np.diag([*spacing, 1.0])
    matrix[:3, 3] = np.array([1e4, -3.0, 0.0]) * scale
    body = MassProperties.from_moments(grid_moments(values, values.shape, matrix, order))
    index = np.stack(np.meshgrid(*map(np.arange, values.shape), indexing="ij"), axis=-1).reshape(
        -1, 3
    )
    masses = values.reshape(-1) * np.prod(spacing)
    points = index * spacing
    center = masses @ points / masses.sum()
    arms = points - center
    second = np.einsum("n,ni,nj->ij", masses, arms, arms) + np.diag(
        masses.sum() * order * spacing**2 / 12
    )
    assert close(body.mass, masses.sum(), rel=1e-14)
    assert close(body.center, center + matrix[:3, 3], rel=1e-13)
    expected = np.trace(second) * np.eye(3) - second
    assert np.abs(body.inertia - expected).max() <= 1e-12 * np.trace(second)


def test_a_sheared_and_mirrored_grid_is_a_parallelepiped():
    matrix = np.array(
        [[-1.0, 0.5, 0.0, 9.0], [0.0, 2.0, 0.25, -4.0], [0.0, 0.0, 3.0, 1.0], [0, 0, 0, 1]]
    )
    found = grid_moments(np.full((4, 4, 4), 5.0), (4, 4, 4), matrix)
    box = SplineAxis(np.array([-2.0, 2.0]), 1)
    one = density_moments(np.full((1, 1, 1), 5.0), [box] * 3)
    to_box = matrix.copy()
    to_box[:3, 3] += matrix[:3, :3] @ [1.5, 1.5, 1.5]
    linear = to_box[:3, :3]
    assert found.total == pytest.approx(5.0 * 64 * 6.0, rel=1e-14)
    center = found.center
    assert center == pytest.approx(to_box[:3, 3], abs=1e-13)
    second = found.about_center().second()
    assert second == pytest.approx(linear @ one.second() @ linear.T * 6.0, rel=1e-13)


def test_nonfinite_values_are_refused():
    for bad in (np.nan, np.inf, -np.inf):
        values = np.ones((3, 3, 3))
        values[1, 2, 0] = bad
        with refused("density_non_finite"), np.errstate(invalid="ignore"):
            grid_moments(values, values.shape, np.eye(4))


def test_misfit_shapes_and_transforms_are_refused():
    axes = [SplineAxis.uniform(2)] * 3
    with pytest.raises(ValueError, match="2, 2, 3"):
        density_moments(np.ones((2, 2, 3)), axes)
    far = np.eye(4)
    far[1, 3] = np.inf
    for bad in (np.diag([1.0, 1.0, 0.0, 1.0]), far):
        with refused("grid_transform_singular"):
            grid_moments(np.ones((2, 2, 2)), (2, 2, 2), bad)


def test_values_are_mapped_before_they_are_summed():
    values = np.arange(27.0).reshape(3, 3, 3)
    found = grid_moments(
        values, values.shape, np.eye(4), value=lambda block: np.interp(block, [5, 10], [0, 100])
    )
    assert found.total == pytest.approx(np.interp(values, [5, 10], [0, 100]).sum())


def test_signaling_nan_samples_are_refused_without_warning():
    # a damaged file may hold it
    samples = np.full((2, 3, 4), 0x7FA00000, np.uint32).view(np.float32)
    with refused("density_non_finite"):
        grid_moments(samples, samples.shape, np.eye(4))
