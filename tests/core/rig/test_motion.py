# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Momenta of moving parts against closed forms: tumbling tops, tucking bodies, floaty jumps and
rolling balls.
"""

import numpy as np
import pytest
from body_moments.core.rig.channels import rotation_values, rotations
from body_moments.core.rig.motion import (
    Course,
    ballistic_arc,
    find_flights,
    find_unexplained,
    frames_of_height,
    momenta,
    zero_moment_points,
)
from body_moments.core.rig.spin import LAST, CarriedParts

STEP, GRAVITY = 1.0 / 24.0, np.array([0.0, 0.0, -9.81])
SPREAD = np.diag([0.5, 0.3, 0.1])
TILT = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
TILT = TILT * np.linalg.det(TILT)
FRAMES = 48
TIME = STEP * np.arange(FRAMES)
VELOCITY = np.array([2.0, 1.0, 5.0])
FALL = 1e3 + TIME[:, None] * VELOCITY + 0.5 * GRAVITY * TIME[:, None] ** 2


def turn(axis, angle):
    """Return (f, 3, 3) rotations about an axis by (f,) angles."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.asarray(angle, float)[:, None, None]
    return np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * skew @ skew


def course(masses, local, spread, turns, path, step=STEP):
    """Return parts with (p, 3) or (f, p, 3) centers in axes that turn together about a path."""
    frames, parts = len(path), len(masses)
    local = np.broadcast_to(local, (frames, parts, 3))
    local = local - np.einsum("p,fpi->fi", masses, local)[:, None] / np.sum(masses)
    centers = path[:, None] + np.einsum("fij,fpj->fpi", turns, local)
    linear = np.broadcast_to(turns[:, None], (frames, parts, 3, 3))
    return Course(
        step, np.array(masses), centers, linear @ spread @ linear.swapaxes(-1, -2), linear
    )


def tucking(turns=None, path=FALL):
    """Return a body of three parts that draws in its arms in flight, then stretches them."""
    arm = 1.0 - 0.7 * np.sin(np.pi * np.clip((TIME - 0.3) / 1.2, 0.0, 1.0)) ** 2
    local = np.zeros((FRAMES, 3, 3))
    local[:, 1, 0], local[:, 2, 0], local[:, 2, 1] = arm, -arm, 0.3 * arm
    turns = TILT @ turn([0, 0, 1], 3.0 * TIME) if turns is None else turns
    return course([4.0, 1.0, 1.5], local, np.diag([0.02, 0.05, 0.1]), turns, path)


def discrete_momentum(body):
    """Return (f - 1, 3) angular momenta from differences of particles, six a part, of fine
    motion.
    """
    values, axes = np.linalg.eigh(body.spreads[0])
    arms = axes * np.sqrt(3.0 * values / body.masses[:, None])[:, None]
    local = np.concatenate([arms, -arms], axis=2)
    turns = body.linear @ np.linalg.inv(body.linear[0])
    points = body.centers[..., None] + turns @ local - body.center[:, None, :, None]
    middle, rate = (points[1:] + points[:-1]) / 2.0, np.diff(points, axis=0) / body.step
    return np.einsum("p,fpjk->fj", body.masses / 6.0, np.cross(middle, rate, axis=2))


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_thrown_tumbling_top_keeps_its_momenta(size):
    spread = np.diag([0.5, 0.5, 0.1])
    inertia = np.trace(spread) * np.eye(3) - spread
    kept = TILT @ inertia @ [6.0, 0.0, 5.0]
    # Euler's solution: the axis turns about the momentum, and the top about its axis.
    turns = (
        turn(kept, np.linalg.norm(kept) / 0.6 * TIME)
        @ TILT
        @ turn([0, 0, 1], 5.0 * (1.0 - 1.0 / 0.6) * TIME)
    )
    top = course([2.0], [[0.0, 0.0, 0.0]], size**2 * spread, turns, size * FALL)
    now, change = momenta(top, [(0, FRAMES - 1)])
    falling = size * (VELOCITY + GRAVITY * TIME[:, None])
    assert np.abs(now[:, 3:6] - size**2 * kept).max() < 1e-6 * size**2 * np.linalg.norm(kept)
    assert np.abs(now[:, :3] - falling).max() < 1e-9 * size * 5.0
    assert np.abs(change[:, :3] - size * GRAVITY).max() < 1e-6 * size * 9.81
    energy = (falling**2).sum(axis=1) + 0.5 * size**2 * kept @ TILT @ np.linalg.solve(
        inertia, TILT.T @ kept
    )
    assert np.abs(now[:, 6] - energy).max() < 1e-6 * energy.max()
    assert find_unexplained(top, [(0, FRAMES - 1)], size * GRAVITY) == []


def test_momenta_of_moving_parts_are_those_of_particles():
    fine = STEP / 400.0
    body = tucking()
    now, _ = momenta(body, [(0, FRAMES - 1)])
    for place in (5, 20, 41):
        time = TIME[place] + fine * (np.arange(2) - 0.5)
        arm = 1.0 - 0.7 * np.sin(np.pi * np.clip((time - 0.3) / 1.2, 0.0, 1.0)) ** 2
        local = np.zeros((2, 3, 3))
        local[:, 1, 0], local[:, 2, 0], local[:, 2, 1] = arm, -arm, 0.3 * arm
        turns, path = TILT @ turn([0, 0, 1], 3.0 * time), np.zeros((2, 3))
        exact = discrete_momentum(
            course([4.0, 1.0, 1.5], local, np.diag([0.02, 0.05, 0.1]), turns, path, fine)
        )[0]
        assert np.abs(now[place, 3:6] - exact).max() < 1e-3 * np.linalg.norm(exact)


def test_arc_leads_from_place_to_place_as_gravity_demands():
    shares = np.linspace(0.0, 1.0, FRAMES)
    arc = ballistic_arc(FALL[0], FALL[-1], shares, STEP * (FRAMES - 1), GRAVITY)
    assert np.abs(arc - FALL).max() < 1e-9
    assert frames_of_height(FALL, STEP, GRAVITY) == pytest.approx(FRAMES - 1, rel=2e-3)


def test_flights_are_between_contacts():
    assert find_flights([1, 1, 0, 0, 1, 0, 1, 1]) == [(1, 4), (4, 6)]
    assert find_flights([0, 0, 1, 0]) == [(0, 2), (2, 3)]
    assert find_flights([1, 1]) == [] and find_flights([0, 0, 0]) == [(0, 2)]


def test_floaty_jump_is_unexplained_and_its_impulse_is_told():
    slow = FALL[0] + TIME[:, None] * VELOCITY + 0.5 * 0.4 * GRAVITY * TIME[:, None] ** 2
    ((first, last, impulse, _twist),) = find_unexplained(
        tucking(np.tile(np.eye(3), (FRAMES, 1, 1)), slow), [(0, FRAMES - 1)], GRAVITY
    )
    assert (first, last) == (1, FRAMES - 2)
    assert impulse == pytest.approx(6.5 * 0.6 * 9.81 * STEP * (FRAMES - 2), rel=1e-6)


def recorded_jump(rate, noise, gravity=GRAVITY):
    """Return a simulated jump of four spheres on springs, spun and shaken, as captured at a rate
    with noise, in m.
    """
    random, fine, seconds = np.random.default_rng(8), 1.0 / 4800.0, 0.7
    masses = np.array([30.0, 15.0, 12.0, 18.0])
    places = np.array([[0.0, 0.0, 1.0], [0.1, 0.0, 1.5], [-0.1, 0.3, 0.7], [0.0, -0.2, 0.4]])
    speeds = (
        np.array([1.0, 0.5, 3.4])
        + np.cross([1.0, 2.0, 0.5], places - places[0])
        + random.normal(0.0, 0.5, (4, 3))
    )
    lengths = np.linalg.norm(places[:, None] - places, axis=2)
    kept = []
    for step in range(round(seconds / fine) + 1):
        if step % round(1.0 / rate / fine) == 0:
            kept.append(places.copy())
        away = places[:, None] - places
        distance = np.maximum(np.linalg.norm(away, axis=2), 1e-9)
        forces = -(4000.0 * (1.0 - lengths / distance)[..., None] * away).sum(axis=1)
        speeds = speeds + fine * (forces / masses[:, None] + gravity)
        places = places + fine * speeds
    centers = np.array(kept) + random.normal(0.0, noise, (len(kept), 4, 3))
    turns = turn([1, 1, 1], random.normal(0.0, 3.0 * noise, 4 * len(kept))).reshape(-1, 4, 3, 3)
    spreads = np.broadcast_to(0.02 * masses[:, None, None] * np.eye(3), turns.shape)
    return Course(1.0 / rate, masses, centers, spreads, turns)


@pytest.mark.parametrize("rate, noise", [(24, 0.0), (120, 0.001), (60, 0.001)])
def test_recorded_jump_is_plausible_and_a_slow_one_is_not(rate, noise):
    flight = [(0, int(0.7 * rate))]
    assert find_unexplained(recorded_jump(rate, noise), flight, GRAVITY) == []
    assert find_unexplained(recorded_jump(rate, noise, 0.7 * GRAVITY), flight, GRAVITY)


def test_spin_from_nothing_is_unexplained():
    angle = 2.0 * np.pi * (TIME > 0.8) * (TIME - 0.8)
    assert find_unexplained(tucking(turn([0, 0, 1], angle)), [(0, FRAMES - 1)], GRAVITY)


def sampled_top(frames, spread=SPREAD):
    """Return a rigid body at rest in its carrier's axes, at the nodes of frames."""
    count = frames * LAST + 1
    spreads = np.tile(spread, (count, 1, 1, 1))
    linear = np.tile(np.eye(3), (count, 1, 1, 1))
    still = Course(STEP, np.array([2.0]), np.zeros((count, 1, 3)), spreads, linear)
    return CarriedParts.of_course(still, np.tile(np.eye(3), (count, 1, 1)))


def test_constant_spin_of_a_rigid_top_is_that_of_euler():
    spread = np.diag([0.5, 0.5, 0.1])
    kept = (np.trace(spread) * np.eye(3) - spread) @ [6.0, 0.0, 5.0]
    turns = sampled_top(24, spread).constant_spin(kept)[:, 0]
    exact = turn(kept, np.linalg.norm(kept) / 0.6 * TIME[:24]) @ turn(
        [0, 0, 1], 5.0 * (1.0 - 1.0 / 0.6) * TIME[:24]
    )
    assert np.abs(turns - exact).max() < 3e-6


def test_constant_spin_keeps_the_energy_of_a_tumbling_body():
    body = sampled_top(96)
    kept = np.array([0.3, 4.0, 0.2])  # about the middle axis: it turns over
    turns = body.constant_spin(kept)
    spin = np.linalg.solve(body.inertia[0, 0, 0], (turns[:, 0].swapaxes(1, 2) @ kept)[..., None])
    energy = np.einsum("fij,fi->f", turns[:, 0].swapaxes(1, 2) @ kept[:, None], spin[..., 0])
    assert np.ptp(energy) < 1e-6 * energy[0] and np.ptp(turns[:, 0, 1, 1]) > 1.0
    moved = CarriedParts(STEP, body.masses, turns, body.arms, body.spreads, body.linear)
    assert moved.deviations(kept).max() < 1e-5


@pytest.mark.parametrize("mode", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "AXIS_ANGLE"])
def test_channels_of_a_turn_past_its_lock_have_no_jump(mode):
    """The middle angle passes 90° exactly, or the axis and angle the rest position."""
    angle = np.linspace(-2.0, 7.0, 97)[:, None, None]
    axis = np.eye(3)["XYZ".index(mode[1])] if len(mode) == 3 else [0.6, 0.0, 0.8]
    turns = turn(axis, angle.ravel())
    values = rotation_values(turns, mode, np.zeros(3) if len(mode) == 3 else [-2.0, *axis])
    assert np.abs(np.diff(values, axis=0)).max() < 0.1
    assert np.abs(rotations(values, mode) - turns).max() < 1e-7


def test_zero_moment_point_of_a_tipping_force():
    center, height = np.array([[1.0, 2.0, 3.0]]), np.array([3.0])
    weight = 5.0 * GRAVITY
    still = zero_moment_points(center, height, np.zeros((1, 3)), np.zeros((1, 3)), weight)
    assert np.abs(still - [1.0, 2.0, 0.0]).max() < 1e-12
    pushed = zero_moment_points(
        center, height, np.array([[5.0, 0.0, 0.0]]), np.zeros((1, 3)), weight
    )
    assert np.abs(pushed - [1.0 - 3.0 / 9.81, 2.0, 0.0]).max() < 1e-12
    assert np.isnan(
        zero_moment_points(center, height, weight[None], np.zeros((1, 3)), weight)
    ).all()
