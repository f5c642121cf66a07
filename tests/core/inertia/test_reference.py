# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Inertia about any reference: against exact rationals, far away and tiny, within its bounds; both ways agree."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia import MassProperties, Reference
from body_moments.core.moments import Measure, Moments
from body_moments.core.moments.exponents import monomials
from body_moments.core.verdict.finding import QueryError

from tests.close import close


def box(size, center, mass=1):
    """(Moments about a point that is not the center, exact function of (point) → tensor) of a solid box."""
    size, center = [Fraction(x) for x in size], [Fraction(x) for x in center]
    second = [[Fraction(0)] * 3 for _ in range(3)]
    for i in range(3):
        second[i][i] = Fraction(mass) * size[i] ** 2 / 12

    def tensor(point):
        arm = [c - Fraction(p) for c, p in zip(center, point)]
        whole = [[second[i][j] + Fraction(mass) * arm[i] * arm[j] for j in range(3)] for i in range(3)]
        trace = sum(whole[i][i] for i in range(3))
        return np.array([[float((trace if i == j else 0) - whole[i][j]) for j in range(3)] for i in range(3)])

    raw = np.zeros(20)
    for k, (p, q, r) in enumerate(monomials(3).tolist()):
        value = Fraction(mass)
        for n, length in zip((p, q, r), size):
            value *= 0 if n % 2 else length**n / (2**n * (n + 1))
        raw[k] = float(value)
    return Moments(raw, np.array(center, float), Measure.MASS, np.abs(raw) * 1e-16), tensor


@pytest.mark.parametrize(
    "size, center, point",
    [
        ((1, 2, 4), (0, 0, 0), (0, 0, 0)),
        ((1, 2, 4), (8, -3, 5), (1, 1, 1)),
        ((1, 2, 4), (4096, -8192, 2048), (0, 0, 0)),
        ((1e-6, 2e-6, 4e-6), (1e-5, 0, 0), (0, 3e-5, 0)),
        ((1, 2, 4), (4096, -8192, 2048), (4097, -8192, 2048)),
    ],
)
def test_the_tensor_about_a_point_is_exact_within_its_bound(size, center, point):
    moments, tensor = box(size, center, 3)
    moments = moments.about_point(np.array(center, float) + np.array(size, float))
    reference, truth = Reference(np.array(point, float)), tensor(point)
    properties = MassProperties.from_moments(moments)
    for referred in (reference.refer(properties), reference.refer_moments(moments)):
        error = np.linalg.norm(referred.inertia - truth)
        assert (
            error
            <= referred.rounding_error["inertia"]
            <= 1e-11 * np.linalg.norm(truth) + 1e-9 * np.linalg.norm(properties.inertia)
        )
        arm = np.array([float(Fraction(c) - Fraction(p)) for c, p in zip(center, point)])
        assert np.linalg.norm(referred.center - arm) <= referred.rounding_error["center"]


def test_axes_turn_the_tensor_and_both_ways_agree():
    moments, tensor = box((1, 2, 4), (8, -3, 5), 3)
    axes = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
    reference = Reference(np.array([1.0, 2.0, 3.0]), axes)
    truth = axes.T @ tensor((1, 2, 3)) @ axes
    first, second = reference.refer(MassProperties.from_moments(moments)), reference.refer_moments(moments)
    assert np.abs(first.inertia - truth).max() <= 1e-14 * truth.max()
    assert np.abs(second.inertia - truth).max() <= 1e-14 * truth.max()
    assert close(first.center, axes.T @ [7.0, -5.0, 2.0], 1e-14) and first.mass == second.mass == 3.0


def test_float32_coordinates_move_with_the_arm():
    moments, _ = box((1, 2, 4), (8, -3, 5), 3)
    moved = Moments(moments.raw, moments.about, Measure.MASS, moments.rounding_error, np.abs(moments.raw) * 1e-6)
    near, far = Reference(moments.about), Reference(moments.about + [1000.0, 0.0, 0.0])
    for refer in (lambda at: at.refer(MassProperties.from_moments(moved)), lambda at: at.refer_moments(moved)):
        small, large = refer(near).input_error["inertia"], refer(far).input_error["inertia"]
        assert large > 1e5 * small > 0.0


def test_an_axis_through_two_points():
    moments, tensor = box((1, 2, 4), (8, -3, 5), 3)
    reference = Reference.through_points((1, 1, 1), (3, 2, 3))
    along = np.array([2, 1, 2]) / 3.0
    assert close(reference.axes[:, 2], along, 1e-15) and np.linalg.det(reference.axes) > 0.999
    assert np.abs(reference.axes.T @ reference.axes - np.eye(3)).max() < 1e-15
    referred = reference.refer(MassProperties.from_moments(moments))
    assert close(referred.about_z, along @ tensor((1, 1, 1)) @ along, 1e-14)
    arm = np.array([7.0, -4.0, 4.0])
    assert close(referred.distance_from_z, np.linalg.norm(np.cross(arm, along)), 1e-14)
    assert close(referred.radius_about_z, np.sqrt(referred.about_z / 3.0), 1e-15)
    for second in ((1, 1, 1), (1 + 1e-7, 1, 1), (np.nan, 0, 0)):
        with pytest.raises(QueryError):
            Reference.through_points((1, 1, 1), second)


@pytest.mark.parametrize("share, bound", [(0.9, 18.0), (1.0, np.inf), (1.1, np.inf)])
def test_moments_that_may_be_those_of_nothing_bound_no_center(share, bound):
    off = np.zeros(10)
    off[0] = share
    point = Moments(np.r_[1.0, np.zeros(9)], np.array([0.6, 0.8, 0.0]), input_error=off)
    assert Reference(np.zeros(3)).refer_moments(point).input_error["center"] == pytest.approx(bound)


@pytest.mark.parametrize("total, error, is_certain", [(1.0, 0.49, True), (1.0, 0.5, False), (-1.0, 0.0, False)])
def test_moments_whose_total_is_not_certain_are_refused(total, error, is_certain):
    off = np.zeros(10)
    off[0] = error
    point = Moments(np.r_[total, np.zeros(9)], np.array([0.6, 0.8, 0.0]), rounding_error=off)
    if is_certain:
        assert close(Reference(np.array([0.6, 0.8, 0.0])).refer_moments(point).mass, 1.0, 1e-15)
        return
    with pytest.raises(QueryError) as refusal:
        Reference(np.array([0.6, 0.8, 0.0])).refer_moments(point)
    assert refusal.value.finding.code == "no_certain_volume"


def test_the_bound_of_an_arm_counts_the_rounding_of_both_its_ends():
    place = np.array([4096.0, -8192.0, 2048.0])
    moments, _ = box((1, 2, 4), place)
    properties = MassProperties.from_moments(moments)
    bound = Reference(place).refer(properties).rounding_error["center"] - properties.rounding_error["center"]
    assert bound >= 2.0**-53 * 2.0 * np.abs(place).sum()


def uncertain(mass, center, inertia):
    return {"mass": mass, "center": center, "inertia": inertia}


def test_the_bound_of_a_shifted_tensor_is_its_own_and_those_of_mass_and_arm():
    """|d| = 7 and m = 5: by hand from √2 d² times the mass' and m (6 d e + 2 e²)."""
    body = MassProperties.from_moments(box((1, 2, 4), (3, 5, -1), 5)[0])
    body = replace(body, rounding_error=uncertain(2e-3, 1e-2, 3e-2), input_error=uncertain(0.25, 0.5, 7.0))
    found = Reference(body.center - (2.0, 3.0, 6.0)).refer(body)
    for bounds, own in ((found.input_error, body.input_error), (found.rounding_error, body.rounding_error)):
        error = own["center"]
        inertia = own["inertia"] + np.sqrt(2.0) * 49.0 * own["mass"] + 5.0 * (42.0 * error + 2.0 * error**2)
        assert bounds["mass"] == own["mass"]
        assert close(bounds["center"], error, 1e-11) and close(bounds["inertia"], inertia, 1e-11)


def test_rounding_alone_bounds_an_arm_and_its_tensor():
    """Units in the last place of what is subtracted, of the arm, and of the tensors that are added."""
    unit, body = 2.0**-53, MassProperties.from_moments(box((1, 2, 4), (3, 5, -1), 5)[0])
    body = replace(body, rounding_error=uncertain(0.0, 0.0, 0.0))
    origin = body.center - (2.0, 3.0, 6.0)
    found = Reference(origin).refer(body).rounding_error
    arm = 2.0 * unit * (np.abs(body.center).sum() + np.abs(origin).sum())
    size = np.linalg.norm(body.inertia) + np.sqrt(2.0) * 5.0 * 49.0
    assert found["mass"] == 0.0 and close(found["center"], arm + 56.0 * unit, 1e-9)
    assert close(found["inertia"], 5.0 * 42.0 * arm + 40.0 * unit * size, 1e-9)


@pytest.mark.parametrize("length, mass", [(2.0**-20, 1.0), (2.0**20, 1.0), (1.0, 2.0**-30), (2.0**7, 2.0**30)])
def test_inertia_and_its_bounds_scale_with_length_and_mass(length, mass):
    axes = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0
    raw = box((1, 2, 4), (3, 5, -1), 5)[0].about_point((2.5, 4.0, 1.0)).raw
    powers = mass * length ** monomials(3).sum(axis=1).astype(float)

    def of(share, about, origin):
        moments = Moments(raw * share, about, Measure.MASS, np.abs(raw) * share * 1e-15, np.abs(raw) * share * 1e-6)
        reference = Reference(origin, axes)
        return reference.refer(MassProperties.from_moments(moments)), reference.refer_moments(moments)

    about, origin = np.array([2.5, 4.0, 1.0]), np.array([-1.0, 7.0, 2.0])
    for one, other in zip(of(np.ones(20), about, origin), of(powers, about * length, origin * length)):
        assert other.mass == one.mass * mass
        assert (other.center == one.center * length).all()
        assert close(other.inertia, one.inertia * mass * length**2, 1e-13)
        for bound in ("rounding_error", "input_error"):
            for name, factor in (("mass", mass), ("center", length), ("inertia", mass * length**2)):
                assert close(getattr(other, bound)[name], getattr(one, bound)[name] * factor, 1e-9), (bound, name)


def test_doubtful_moments_move_a_center_and_a_tensor_by_what_is_told():
    """About the moments' own point, where nothing is shifted: with the worst signs, and (tr D) 1 + D of errors D."""
    raw = np.array([4.0, 1.0, -2.0, 3.0, 9.0, 0.5, -0.25, 8.0, 0.125, 7.0])
    off = np.array([0.5, 0.25, 0.5, 0.125, *[0.0625] * 6])
    for name in ("input_error", "rounding_error"):
        found = Reference(np.zeros(3)).refer_moments(Moments(raw, np.zeros(3), Measure.MASS, **{name: off}))
        bounds = getattr(found, name)
        worst = (np.abs(raw[1:4]) + off[1:4]) / 3.5 - np.abs(raw[1:4]) / 4.0
        assert bounds["mass"] == pytest.approx(0.5, rel=1e-12)
        assert close(bounds["center"], np.linalg.norm(worst), 1e-12)
        assert close(bounds["inertia"], np.sqrt(54.0) * 0.0625, 1e-11)


def test_points_nearer_than_a_millionth_of_their_coordinates_give_no_axis():
    for first in ((1.0, -2000.0, 0.0), (1.0, 2.0, 2000.0)):
        for sign in (1.0, -1.0):
            assert Reference.through_points(first, np.add(first, (sign * 2.1e-3, 0.0, 0.0))).axes[0, 2] == sign
            with pytest.raises(QueryError):
                Reference.through_points(first, np.add(first, (sign * 1.9e-3, 0.0, 0.0)))
    with pytest.raises(QueryError):
        Reference.through_points((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize("along", [(3.0, 1.0, 2.0), (1.0, 3.0, -2.0), (3.0, -2.0, 1.0)])
def test_the_first_axis_is_the_coordinate_axis_that_is_most_across(along):
    axes = Reference.through_points((5.0, 6.0, 7.0), np.add((5.0, 6.0, 7.0), along)).axes
    least = int(np.abs(along).argmin())
    assert axes[least, 0] > 0.8 and abs(np.cross(axes[:, 2], np.eye(3)[least]) @ axes[:, 0]) < 1e-15
    assert close(axes[:, 1], np.cross(axes[:, 2], axes[:, 0]), 1e-12)
