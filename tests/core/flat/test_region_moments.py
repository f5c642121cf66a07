# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Area moments of any order, their bounds, and invariants, against rational arithmetic."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, plane_positions, region_moments
from body_moments.core.moments import (
    complex_moments,
    flusser_invariants,
    hu_invariants,
    monomials,
    normalize,
)
from body_moments.core.polyhedron.n_dimensions import multi_indices

from tests.core import rational
from tests.core.findings import refused

POINTS = np.array(
    [(0, 0), (3, 0.25), (2.5, 1), (1, 1), (1.25, 2.5), (0, 2), (0.25, 0.5), (0.25, 1), (0.75, 0.5)]
)
EDGES = directed_edges([range(6), range(6, 9)])


def truths(points, about, order):
    exactly, center = rational.fractions(points), [Fraction(float(x)) for x in about[:2]]
    return [
        rational.enclosed(exactly, EDGES.tolist(), row, center)
        for row in multi_indices(2, order).tolist()
    ]


@pytest.mark.parametrize(
    "scale, offset", [(1.0, (0, 0)), (2.0**-40, (3, 4)), (1e5, (-7, 2)), (1.0, (1e5, 0))]
)
def test_central_moments_are_within_tight_bounds(scale, offset):
    points = POINTS * scale + np.array(offset, float) * scale
    found, order = region_moments(points, EDGES, 9), 9
    size = region_moments(np.abs(POINTS - POINTS.mean(axis=0)) * scale, EDGES, 0).rounding_error[0]
    reach = np.abs(points - found.about[:2]).max()
    for i, truth, (p, q) in zip(
        plane_positions(order), truths(points, found.about, order), multi_indices(2, order)
    ):
        assert abs(Fraction(found.raw[i]) - truth) <= Fraction(found.rounding_error[i])
        assert (
            found.rounding_error[i] <= 1e-12 * found.raw[0] * reach ** float(p + q) and size > 0.0
        )
    assert (
        np.abs(found.raw[1:3]).max()
        <= (1e-14 + 1e-15 * np.abs(offset).max()) * found.raw[0] * reach
    )
    assert (np.delete(found.raw, plane_positions(order)) == 0.0).all()


@pytest.mark.parametrize("step", [1e-9, 1e-3, 0.3])
def test_moved_points_change_moments_up_to_the_bound(step):
    about = np.array([0.9, 0.8])
    known = region_moments(POINTS, EDGES, 5, about, rounded=step)
    positions, worst = plane_positions(5), 0.0
    for seed in range(40):
        moved = POINTS + step * np.sign(np.random.default_rng(seed).normal(size=POINTS.shape))
        off = np.abs(region_moments(moved, EDGES, 5, about).raw - known.raw)[positions]
        assert (off <= known.rounding_error[positions]).all()
        worst = max(worst, off[0] / known.rounding_error[0])
    assert worst > 0.1
    assert (
        region_moments(POINTS, EDGES, 5, about, stored=step).input_error[positions] >= 0.9 * off
    ).all()


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**15])
def test_region_scaled_by_a_power_of_two_scales_exactly(scale):
    found, large = (
        region_moments(POINTS * size, EDGES, 4, rounded=1e-6 * size, stored=1e-5 * size)
        for size in (1.0, scale)
    )
    powers = scale ** (monomials(4).sum(axis=1) + 2.0)
    assert large.about.tolist() == (found.about * scale).tolist() and found.about[2] == 0.0
    for name in ("raw", "rounding_error", "input_error"):
        assert (getattr(large, name) == getattr(found, name) * powers).all()


@pytest.mark.parametrize("rounded, is_certain", [(0.1293, True), (0.1295, False)])
def test_region_within_its_coordinate_error_is_refused(rounded, is_certain):
    """A unit square: 4 w (1 + 2 w) of it with w = √2 times what coordinates are off, which is 1 for
    w = 0.18301.
    """
    square = [(3, 5), (4, 5), (4, 6), (3, 6)]
    if is_certain:
        assert region_moments(
            square, directed_edges([range(4)]), 2, rounded=rounded
        ).about.tolist() == [3.5, 5.5, 0.0]
        return
    with refused("no_section_area"):
        region_moments(square, directed_edges([range(4)]), 2, rounded=rounded)


def test_complex_moments_match_their_definition_within_bounds():
    found = region_moments(POINTS, EDGES, 6, (0.5, 0.25))
    real = dict(zip(map(tuple, multi_indices(2, 6).tolist()), truths(POINTS, (0.5, 0.25), 6)))
    for (p, q), entry in complex_moments(found).items():
        terms = {(0, 0): (Fraction(1), Fraction(0))}
        for sign in (1,) * p + (-1,) * q:  # times x + i sign y
            product = {}
            for (j, k), (a, b) in terms.items():
                for key, (c, d) in (((j + 1, k), (a, b)), ((j, k + 1), (-sign * b, sign * a))):
                    old = product.get(key, (0, 0))
                    product[key] = old[0] + c, old[1] + d
            terms = product
        true = [sum(real[key] * value[part] for key, value in terms.items()) for part in (0, 1)]
        off = [
            abs(Fraction(value) - part)
            for value, part in zip((entry.value.real, entry.value.imag), true)
        ]
        assert off[0] ** 2 + off[1] ** 2 <= Fraction(entry.bound) ** 2
        assert entry.bound <= 1e-12 * 3.0 ** (p + q) * 5.0


def test_invariants_of_turned_and_mirrored_shapes_agree():
    def found(points, edges=EDGES):
        moments = normalize(region_moments(points, edges, 6, rounded=1e-15))
        return hu_invariants(moments), flusser_invariants(moments)

    hu, flusser = found(POINTS)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    for first, second in zip((hu, flusser), found(POINTS @ turn.T)):
        for a, b in zip(first, second):
            assert (
                a.name == b.name and abs(a.value - b.value) <= a.rounding_error + b.rounding_error
            )
            assert a.rounding_error < 1e-10
    mirrored = found(POINTS * [1.0, -1.0], EDGES[:, ::-1])
    assert abs(hu[6].value + mirrored[0][6].value) < 1e-13 and abs(hu[6].value) > 1e-6
    for a, b in zip(flusser, mirrored[1]):
        assert abs(a.value.conjugate() - b.value) <= a.rounding_error + b.rounding_error


def test_a_square_has_the_invariants_of_its_closed_form():
    square = region_moments([(0, 0), (3, 0), (3, 3), (0, 3)], directed_edges([range(4)]), 4)
    values = [one.value.real for one in hu_invariants(normalize(square))]
    assert abs(values[0] - 1.0 / 6.0) < 1e-14 and max(map(abs, values[1:])) < 1e-14
