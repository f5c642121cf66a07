# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Constant sets of trilinear densities against closed forms, and against quadrature with the axes
in another order.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.density import threshold, threshold_body
from body_moments.core.moments.raw import monomials
from body_moments.core.verdict import MeasureError

from tests.close import close
from tests.core.findings import refused

RNG = np.random.default_rng(11)


def points(n):
    """(n, n, n) each of x, y and z from -1 to 1."""
    return np.meshgrid(*[np.linspace(-1.0, 1.0, n)] * 3, indexing="ij")


def ball(n, radius=0.7, center=(0.0, 0.0, 0.0)):
    return radius - np.sqrt(sum((x - c) ** 2 for x, c in zip(points(n), center)))


def torus(n):
    x, y, z = points(n)
    return 0.31 - np.sqrt((np.hypot(x, y) - 0.55) ** 2 + z**2)


BODIES = {
    "ball": ball,
    "torus": torus,
    "touching balls": lambda n: np.maximum(
        ball(n, 0.45, (-0.45, 0.03, 0.0)), ball(n, 0.45, (0.45, 0.03, 0.0))
    ),
}


# The oracle: columns along x, whatever the density does along them; double exponential rules
# between all roots.

_T = np.arange(-3.2, 3.2001, 0.1)
NODES = 0.5 + 0.5 * np.tanh(0.5 * np.pi * np.sinh(_T))
WEIGHTS = 0.1 * 0.25 * np.pi * np.cosh(_T) / np.cosh(0.5 * np.pi * np.sinh(_T)) ** 2


def between(roots):
    """Nodes and weights over [0, 1] between roots (…, k)."""
    inside = np.where((roots > 0.0) & (roots < 1.0), roots, 0.0)
    edges = np.sort(
        np.concatenate([np.zeros_like(roots[..., :1]), inside, np.ones_like(roots[..., :1])], -1),
        -1,
    )
    start, length = edges[..., :-1, None], np.diff(edges)[..., None]
    nodes, weights = start + length * NODES, length * WEIGHTS
    return nodes.reshape(*nodes.shape[:-2], -1), weights.reshape(*weights.shape[:-2], -1)


def cell_moments(corners, origin, order):
    """The volume moments of {≥ 0} in the cell at `origin`, by columns along x, then y, then z."""
    c = corners
    with np.errstate(all="ignore"):
        edges = (c[:, :, 0] / (c[:, :, 0] - c[:, :, 1])).ravel()
        low, step = c[:, :, 0], c[:, :, 1] - c[:, :, 0]  # x, y: at z = 0, and along z
        both = np.polynomial.Polynomial([0.0])
        for sign, (i, j) in ((1, (0, 1)), (-1, (1, 0))):
            first = np.polynomial.Polynomial([low[i, 0], step[i, 0]])
            slope = np.polynomial.Polynomial([low[j, 1] - low[j, 0], step[j, 1] - step[j, 0]])
            both = both + sign * first * slope
        crossing = (
            [root.real for root in both.trim().roots() if abs(root.imag) < 1e-9]
            if both.trim().degree()
            else []
        )
        z, weight_z = between(np.nan_to_num(np.array([*edges, *crossing])))
        line = low + z[:, None, None] * step  # z, x, y
        y, weight = between(np.nan_to_num(line[:, :, 0] / (line[:, :, 0] - line[:, :, 1])))
        ends = line[:, :, 0, None] + y[:, None, :] * (line[:, :, 1] - line[:, :, 0])[:, :, None]
        crossed = ends[:, 0] / (ends[:, 0] - ends[:, 1])
    begin = np.where(ends[:, 0] >= 0.0, 0.0, np.where(ends[:, 1] >= 0.0, crossed, 1.0))
    end = np.where(ends[:, 1] >= 0.0, 1.0, np.where(ends[:, 0] >= 0.0, crossed, begin))
    weight = weight * weight_z[:, None]
    z = np.broadcast_to(z[:, None], y.shape)
    begin, end, y, z = begin + origin[0], end + origin[0], y + origin[1], z + origin[2]
    return np.array(
        [
            (weight * (end ** (p + 1) - begin ** (p + 1)) / (p + 1) * y**q * z**r).sum()
            for p, q, r in monomials(order).tolist()
        ]
    )


def oracle(samples, order):
    total = np.zeros(len(monomials(order)))
    for place in np.ndindex(*np.array(samples.shape) - 1):
        i, j, k = place
        corners = samples[i : i + 2, j : j + 2, k : k + 2]
        if (corners >= 0.0).any():
            total += cell_moments(corners, place, order)
    return total


@pytest.mark.parametrize("name", BODIES)
def test_a_sampled_body_has_the_moments_of_its_interpolant(name):
    samples = BODIES[name](8)
    found = threshold_body(samples, 0.0, order=3)
    truth = oracle(samples, 3)
    volume = found.volume.about_point((0.0, 0.0, 0.0))
    assert close(volume.raw, truth, rel=1e-10)
    assert close(found.volume.center, truth[1:4] / truth[0], rel=1e-10)
    assert (np.abs(volume.raw - truth) <= volume.rounding_error + 1e-13 * np.abs(truth)).all()
    assert not found.clipped


def test_noise_has_moments_of_its_interpolant_at_any_threshold():
    """Cells of every kind: tunnels, saddles and axes without monotone values."""
    samples = RNG.normal(size=(4, 5, 3))
    for level in (-0.7, 0.0, 0.9):
        found = threshold_body(samples, level, order=2)
        truth = oracle(samples - level, 2)
        assert close(found.volume.about_point((0.0, 0.0, 0.0)).raw, truth, rel=1e-9)
        assert found.clipped


def test_cell_with_opposed_steps_is_not_monotone():
    corners = (-1.0) ** np.indices((2, 2, 2)).sum(axis=0)
    cells = threshold.Cells(corners[None], np.zeros((1, 3)), np.ones(1))
    assert not cells.column_axes()[1].any()


def test_noise_of_many_cells_is_within_its_bounds():
    """The whole has less work for a cell than its halves, which are nearly exact."""
    samples = RNG.normal(size=(25, 24, 24))
    whole = threshold_body(samples, 0.3, order=2)
    halves = [threshold_body(part, 0.3, order=2) for part in (samples[:13], samples[12:])]
    for name in ("volume", "area"):
        found = getattr(whole, name)
        lower, upper = (getattr(half, name) for half in halves)
        upper = replace(upper, about=upper.about + (12.0, 0.0, 0.0))
        truth = lower.about_point(found.about) + upper.about_point(found.about)
        assert (np.abs(found.raw - truth.raw) <= found.rounding_error).all()
        assert 100.0 * truth.rounding_error[0] < found.rounding_error[0] < 1e-3 * found.total


@pytest.mark.parametrize("level", [0.9, 0.3, 0.01, 1e-4])
def test_a_product_has_its_closed_form(level):
    """xyz ≥ t in the unit cube: 1 - t (1 - ln t + ln² t / 2)."""
    corner = np.zeros((2, 2, 2))
    corner[1, 1, 1] = 1.0
    log = math.log(level)
    found = threshold_body(corner, level)
    assert close(found.volume.total, 1.0 - level * (1.0 - log + log * log / 2.0), rel=1e-11)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_half_space_is_exact_with_its_density_and_its_face(axis, sign):
    """f = ±x over a box of 6 x 3 x 4 cells, cut at x = 2.25."""
    shape = np.roll([7, 4, 5], axis)
    x = np.arange(7.0).reshape(np.roll([7, 1, 1], axis))
    samples = np.broadcast_to(sign * x, shape)
    low, high = (2.25, 6.0) if sign > 0.0 else (0.0, 2.25)
    found = threshold_body(samples, sign * 2.25, with_density=True)
    assert close(found.volume.total, 12.0 * (high - low), rel=1e-14)
    assert close(found.area.total, 12.0, rel=1e-14)
    assert close(found.mass.total, sign * 6.0 * (high**2 - low**2), rel=1e-14)
    assert (found.volume.measure, found.area.measure, found.mass.measure) == (
        "volume",
        "area",
        "mass",
    )
    assert close(found.volume.center[axis], (low + high) / 2.0, rel=1e-14)
    assert close(found.area.center[axis], 2.25, rel=1e-14)
    assert close(
        found.mass.center[axis], 2.0 / 3.0 * (high**3 - low**3) / (high**2 - low**2), rel=1e-14
    )
    # with its density to third order: ∫ x³ x
    powers = [0, 0, 0]
    powers[axis] = 3
    about = found.mass.about_point((0.0, 0.0, 0.0))
    assert close(about[tuple(powers)], sign * 12.0 * (high**5 - low**5) / 5.0, rel=1e-13)


def test_a_slanted_plane_is_exact_in_volume_and_area():
    """x + 2y + 3z ≥ t cuts a simplex off a corner: t³/36, with a face of √14 t²/12."""
    x, y, z = np.meshgrid(*[np.arange(8.0)] * 3, indexing="ij")
    found = threshold_body(-(x + 2 * y + 3 * z), -5.3)
    assert close(found.volume.total, 5.3**3 / 36.0, rel=1e-11)
    assert close(found.area.total, math.sqrt(14.0) * 5.3**2 / 12.0, rel=1e-11)
    assert close(found.volume.center, 5.3 / 4.0 / np.array([1.0, 2.0, 3.0]), rel=1e-11)


def test_sampled_balls_converge_with_the_square_of_the_spacing():
    errors = []
    for n in (16, 31, 61):
        found, spacing = threshold_body(ball(n), 0.0), 2.0 / (n - 1)
        errors.append(
            (
                found.volume.total * spacing**3 / (4.0 / 3.0 * np.pi * 0.343) - 1.0,
                found.area.total * spacing**2 / (4.0 * np.pi * 0.49) - 1.0,
            )
        )
    ratios = np.array(errors[:-1]) / np.array(errors[1:])
    assert (np.abs(ratios - 4.0) < 0.4).all()


def test_the_area_is_the_derivative_of_the_volume():
    """d volume / d threshold = -∫ dA / |∇f|, and |∇f| = 1 along the samples of a plane's
    distance.
    """
    normal = np.array([1.0, 2.0, -2.0]) / 3.0
    samples = sum(n * x for n, x in zip(normal, points(9))) * 4.0
    low, high = (threshold_body(samples, level) for level in (0.1 - 1e-4, 0.1 + 1e-4))
    middle = threshold_body(samples, 0.1)
    assert close((low.volume.total - high.volume.total) / 2e-4, middle.area.total, rel=1e-7)


@pytest.mark.parametrize("exponent", [-1000, -600, 600, 1000])
def test_the_size_of_the_numbers_changes_nothing(exponent):
    """Powers of two are exact, so every number stays; squares of these leave the range."""
    samples, scale = np.random.default_rng(9).normal(size=(5, 6, 4)), 2.0**exponent
    found, scaled = (
        threshold_body(samples * s, 0.1 * s, order=2, with_density=True) for s in (1.0, scale)
    )
    for measure in ("volume", "area"):
        assert np.array_equal(getattr(scaled, measure).raw, getattr(found, measure).raw)
        assert np.array_equal(
            getattr(scaled, measure).rounding_error, getattr(found, measure).rounding_error
        )
    assert np.array_equal(scaled.mass.raw, found.mass.raw * scale)


def test_turned_and_mirrored_samples_turn_and_mirror_the_body():
    samples = RNG.normal(size=(5, 6, 7))
    plain = threshold_body(samples, 0.2, with_density=True)
    turned = threshold_body(samples.transpose(2, 0, 1)[::-1], 0.2, with_density=True)
    for name in ("volume", "area", "mass"):
        one, other = getattr(plain, name), getattr(turned, name)
        assert close(one.total, other.total, rel=1e-9)
        x, y, z = one.center
        assert close(other.center, (6.0 - z, x, y), rel=1e-8)


def test_sheared_grid_has_area_and_moments_of_the_sheared_body():
    """A plane's piece with known corners in the image of the grid; a volume and a center under the
    map.
    """
    matrix = np.array(
        [
            [0.02, 0.003, 0.0, 5.0],
            [0.0, -0.05, 0.01, 6.0],
            [0.004, 0.0, 0.003, -7.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    x, y, z = np.meshgrid(*[np.arange(8.0)] * 3, indexing="ij")
    samples = -(x + 2 * y + 3 * z)
    plain, mapped = (
        threshold_body(samples, -5.3),
        threshold_body(samples, -5.3, matrix=matrix, with_density=True),
    )
    corners = (matrix @ np.array([[5.3, 0, 0, 1], [0, 2.65, 0, 1], [0, 0, 5.3 / 3.0, 1]]).T).T[
        :, :3
    ]
    area = np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) / 2.0
    assert close(mapped.area.total, area, rel=1e-10)
    assert close(mapped.area.center, corners.mean(axis=0), rel=1e-10)
    assert close(
        mapped.volume.total, plain.volume.total * abs(np.linalg.det(matrix[:3, :3])), rel=1e-12
    )
    assert close(
        mapped.volume.center, matrix[:3, :3] @ plain.volume.center + matrix[:3, 3], rel=1e-13
    )
    assert mapped.mass.total < 0.0  # these densities are negative
    far = np.eye(4)
    far[1, 3] = np.inf
    for bad in (np.diag([1.0, 1.0, 0.0, 1.0]), far):
        with refused("grid_transform_singular"):
            threshold_body(samples, -5.3, matrix=bad)


@pytest.mark.parametrize("along, across", [(0, 1), (0, 2), (1, 2), (1, 0), (2, 0), (2, 1)])
def test_area_of_a_plane_piece_matches_its_corners_under_shear(along, across):
    matrix = np.diag([1.0, 1.5, 0.75, 1.0])
    matrix[along, across] = 0.5
    x, y, z = np.meshgrid(*[np.arange(8.0)] * 3, indexing="ij")
    found = threshold_body(-(x + 2 * y + 3 * z), -5.3, matrix=matrix)
    corners = np.diag([5.3, 2.65, 5.3 / 3.0]) @ matrix[:3, :3].T
    area = np.linalg.norm(np.cross(corners[1] - corners[0], corners[2] - corners[0])) / 2.0
    assert close(found.area.total, area, rel=1e-10)
    assert close(found.area.center, corners.mean(axis=0), rel=1e-10)


def test_grid_surroundings_are_empty_or_background():
    samples = np.full((2, 2, 2), 3.0)
    alone = threshold_body(samples, 1.0)
    assert close(alone.volume.total, 1.0, rel=1e-14) and alone.area.total == 0.0 and alone.clipped
    closed = threshold_body(samples, 1.0, background=0.0)
    assert not closed.clipped and closed.volume.total > 1.0 and closed.area.total > 6.0
    assert close(closed.volume.center, (0.5, 0.5, 0.5), rel=1e-13)
    infinite = threshold_body(samples, 1.0, background=2.0)
    assert infinite.clipped and close(infinite.volume.total, 1.0, rel=1e-14)
    one = threshold_body(np.array([[[1.0]]]), 0.25, background=0.0)
    log = math.log(0.25)
    assert close(one.volume.total, 8.0 * (1.0 - 0.25 * (1.0 - log + log * log / 2.0)), rel=1e-10)


def test_a_preview_is_near_and_claims_nothing():
    samples = torus(24)
    exact, preview = (
        threshold_body(samples, 0.05, order=1, preview=quick) for quick in (False, True)
    )
    assert close(preview.volume.total, exact.volume.total, rel=1e-6)
    assert abs(preview.volume.total - exact.volume.total) > 0.0


def test_empty_full_and_bad_samples_are_handled():
    samples = RNG.uniform(size=(3, 4, 5))
    assert (
        threshold_body(samples, 2.0).volume.total == 0.0
        and not threshold_body(samples, 2.0).clipped
    )
    assert close(threshold_body(samples, -1.0).volume.total, 24.0, rel=1e-14)
    samples[1, 1, 1] = np.nan
    with pytest.raises(MeasureError) as refused:
        threshold_body(samples, 0.5)
    assert refused.value.finding.code == "density_non_finite"
    # a damaged file may hold it
    signaling = np.full((2, 3, 4), 0x7FA00000, np.uint32).view(np.float32)
    with pytest.raises(MeasureError):
        threshold_body(signaling, 0.5)
    with pytest.raises(ValueError, match="two samples per axis"):
        threshold_body(np.ones((1, 4, 4)), 0.5)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("level", [0.6, 0.05])
def test_surface_area_is_exact_along_a_constant_axis(axis, level):
    """yz ≥ t in the unit cube: 1 - t + t ln t, and the length of y = t / z between z = t and 1."""
    mpmath = pytest.importorskip("mpmath")
    corner = np.zeros((2, 2, 2))
    corner[:, 1, 1] = 1.0
    found = threshold_body(np.moveaxis(corner, 0, axis), level)
    assert close(found.volume.total, 1.0 - level + level * math.log(level), rel=1e-11)
    length = mpmath.quad(
        lambda z: mpmath.sqrt(1 + level**2 / z**4),
        [level, 2 * level, 1] if level < 0.5 else [level, 1],
    )
    assert close(found.area.total, float(length), rel=1e-8)
    assert close(found.volume.center[axis], 0.5, rel=1e-11) and close(
        found.area.center[axis], 0.5, rel=1e-9
    )
