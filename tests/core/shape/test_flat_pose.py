# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat shapes: their Zernike moments by quadrature, the turn between two of them, and symmetries in
any plane.
"""

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.numerics.quadrature import triangle_rule
from body_moments.core.shape.registration import (
    _best_angles,
    flat_symmetry,
    holds_by_outline,
    match_flat,
)
from body_moments.core.shape.zernike import degrees, disc_zernike

from tests.core.bodies import rotation


def radial(n, m, r):
    """Return R_nm by Prata and Rusch's recursion, independent of the product's coefficients."""
    if m > n or n < 0:
        return np.zeros_like(r)
    if n == 0:
        return np.ones_like(r)
    return r * (radial(n - 1, abs(m - 1), r) + radial(n - 1, m + 1, r)) - radial(n - 2, m, r)


@pytest.mark.parametrize("radius", [2.5, 4.0])
def test_zernike_moments_of_a_triangle_match_quadrature(radius):
    order, points = 7, np.array([[0.0, 0.0], [3.0, 0.5], [1.0, 2.0]])
    moments = region_moments(points, directed_edges([range(3)]), order)
    a, b, c = (points - moments.about[:2]) / radius
    double = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
    shares, weights = triangle_rule(8)
    x, y = np.einsum("kn,ki->in", shares, [a, b, c])
    r, phi = np.hypot(x, y), np.arctan2(y, x)
    truth = [
        np.sqrt((n + 1) / np.pi)
        * double
        * (weights * radial(n, m, r) * np.exp(-1j * m * phi)).sum()
        for n, m in degrees(order)
    ]
    assert np.abs(disc_zernike(moments, radius) - truth).max() < 1e-13


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("turn", [0.0, 1e-4, 0.5, 3.0, -2.0, np.pi / 720.0])
def test_turn_between_two_shapes_maximizes_their_overlap(seed, turn):
    rng = np.random.default_rng(seed)
    m = np.array([m for _, m in degrees(9)])
    source = rng.normal(size=len(m)) + 1j * rng.normal(size=len(m)) * (m > 0)
    target = source * np.exp(-1j * m * turn)
    found = _best_angles(source, target)
    assert abs(np.exp(1j * found[0]) - np.exp(1j * turn)) < 1e-13

    def overlap(angle, times):
        return ((target.conj() * source) * (-1j * m) ** times * np.exp(-1j * m * angle)).real.sum()

    values = np.array([overlap(angle, 0) for angle in found])
    assert (np.diff(values) <= 1e-9 * values[0]).all() and len(values) > 1
    apart = np.abs(np.exp(1j * found[:, None]) - np.exp(1j * found))[np.triu_indices(len(found), 1)]
    # one that lies just between two samples comes from both
    assert np.count_nonzero(apart < 1e-3) <= 1
    assert max(abs(overlap(angle, 1)) for angle in found) < 1e-11 * abs(overlap(found[0], 2))
    assert max(overlap(angle, 2) for angle in found) < 0.0


def corner_distances(corners):
    return lambda places: np.linalg.norm(places[:, None] - corners, axis=2).min(axis=1)


@pytest.mark.parametrize("seed", [None, 3, 5])
def test_rectangle_has_two_turns_and_two_mirrors_in_any_plane(seed):
    axes = np.eye(3) if seed is None else rotation(seed)
    corners = np.array([[1.5, 0.5], [-1.5, 0.5], [-1.5, -0.5], [1.5, -0.5]])
    zernike = disc_zernike(region_moments(corners, directed_edges([range(4)]), 8), 1.6)
    places = np.pad(corners, ((0, 0), (0, 1)))
    holds = holds_by_outline(places, corner_distances(places), 1e-6)
    found = flat_symmetry(zernike, 8, corners, axes, holds)
    assert found.group == "C2v" and len(found.operations) == 4 and found.order == 8
    for way in ([1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0]):
        true = axes @ np.diag(way) @ axes.T
        assert np.abs(found.operations - true).max(axis=(1, 2)).min() < 1e-9


@pytest.mark.parametrize("seed", [3, 5])
def test_round_shape_has_any_turn_and_a_mirror_in_any_plane(seed):
    axes = rotation(seed)
    angle = 2.0 * np.pi / 720.0 * np.arange(720)
    rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    zernike = disc_zernike(region_moments(rim, directed_edges([range(720)]), 8), 1.1)
    places = np.pad(rim, ((0, 0), (0, 1)))

    def from_rim(places):
        return np.hypot(np.hypot(places[:, 0], places[:, 1]) - 1.0, places[:, 2])

    found = flat_symmetry(zernike, 8, rim, axes, holds_by_outline(places, from_rim, 1e-6))
    assert found.group == "C∞v" and np.array_equal(found.revolution_axes, axes[:, 2][None])
    unit, mirror = found.operations
    assert np.abs(unit - np.eye(3)).max() < 1e-14 and np.linalg.det(mirror) < 0.0
    assert (
        np.abs(mirror @ axes[:, 2] - axes[:, 2]).max() < 1e-14
        and np.abs(mirror @ mirror - np.eye(3)).max() < 1e-14
    )


@pytest.mark.parametrize("seeds", [(1, 2), (4, 1)])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_triangle_is_laid_onto_its_like_from_plane_to_plane(seeds, mirrored):
    start, end = map(rotation, seeds)
    corners = np.array([[0.0, 0.0], [3.0, 0.0], [0.5, 1.0]])
    other = corners @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    if mirrored:
        other = other[::-1] * [1.0, -1.0]
    moments = [region_moments(shape, directed_edges([range(3)]), 8) for shape in (corners, other)]
    places = [np.pad(shape - shape.mean(axis=0), ((0, 0), (0, 1))) for shape in (corners, other)]
    source, target = places[0] @ start.T, places[1] @ end.T
    fit = match_flat(
        *(disc_zernike(shape, 3.0) for shape in moments),
        (start, end),
        lambda way, _: corner_distances(target)(source @ way.T),
        3.0,
    )
    assert fit.is_mirror_image == mirrored and np.linalg.det(fit.rotation) > 0.0
    assert np.abs(fit.rotation @ start[:, 2] - end[:, 2]).max() < 1e-9  # front on front
    assert (fit.max_distance < 1e-9) != mirrored
