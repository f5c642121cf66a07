# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which harmonics about an axis turn a body's frames, one or two of them at a time; and bodies of several parts."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.inertia.axial_harmonics import AxialHarmonics, axial_harmonics, axis_last, turn_by_harmonics
from body_moments.core.inertia.canonical_frame import EquivalentFrames
from body_moments.core.mesh.surface import Surface

from tests.close import close
from tests.core import bodies, shapes

NOISE = 1e-5
BASE = bodies.rotation(3)


def seemingly_round(axis, ways=(1.0,)):
    """Frames about one of their axes, which points ahead or back as well."""
    frames = []
    for way in ways:
        signs = np.full(3, way)
        signs[(axis + 1) % 3] = 1.0
        frames.append(BASE * signs)
    return EquivalentFrames(np.array(frames), np.array([0.5, 0.25]), np.array([1e-3, 2e-3]), (axis,), 1e-4)


def harmonics_of(alike, known, order=12):
    """About the axis of frames: these values, {(k, m): value}, and one of all."""
    values = np.zeros((2, order + 1), complex)
    values[0, 0] = 1.0
    for place, value in known.items():
        values[place] = value
    return AxialHarmonics(axis_last(alike), values)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("k, m", [(0, 7), (1, 6), (1, 7), (0, 12)])
@pytest.mark.parametrize("ways", [(1.0,), (1.0, -1.0)], ids=["one way", "both ways"])
def test_a_harmonic_is_real_and_positive_in_each_of_the_frames_that_it_leaves(axis, k, m, ways):
    alike, value = seemingly_round(axis, ways), 3e-3 * np.exp(0.7j)
    harmonics = harmonics_of(alike, {(k, m): value})
    found = turn_by_harmonics(alike, harmonics)
    assert found.frames.shape == (m * len(ways), 3, 3) and found.revolution_axes == () and found.rule is None
    last = np.roll([0, 1, 2], 2 - axis)
    for frame in found.frames:
        assert np.abs(frame.T @ frame - np.eye(3)).max() < 1e-14 and np.linalg.det(frame) > 0.0
        assert np.abs(np.abs(frame[:, axis] @ BASE[:, axis]) - 1.0) < 1e-14
        assert abs(harmonics.in_frame(frame[:, last]).values[k, m] - 3e-3) < 1e-16
    apart = np.abs(found.frames[:, None] - found.frames[None]).max(axis=(2, 3)) + np.eye(len(found.frames))
    assert apart.min() > 0.1
    assert close(found.tilt, 1e-4 + NOISE / (m * 3e-3), 1e-12)
    assert found.values[:2].tolist() == [0.5, 0.25] and found.noise[:2].tolist() == [1e-3, 2e-3]
    assert (found.noise[2:] == 2.0 * NOISE).all() and len(found.values) == len(found.noise) == 2 + 2 * 2 * 13
    real = found.values[2 : 2 + 26].reshape(2, 13)
    assert close(real[k, m], 3e-3, 1e-12) and close(real[0, 0], 1.0, 1e-15)


@pytest.mark.parametrize("noise", [NOISE, 1e-3])
@pytest.mark.parametrize(
    "k, m, share, is_turned", [(0, 7, 2.01, True), (0, 7, 1.99, False), (0, 6, 9.0, False), (1, 5, 9.0, False)]
)
def test_moments_to_sixth_order_turn_nothing_nor_does_what_is_noise(k, m, share, is_turned, noise):
    alike = seemingly_round(2)
    harmonics = harmonics_of(alike, {(k, m): share * noise * 1j})
    found = turn_by_harmonics(alike, harmonics, noise)
    assert (found is not alike) == is_turned
    if is_turned:
        assert close(found.tilt, 1e-4 + 1.0 / (m * share), 1e-12)


@pytest.mark.parametrize("tilt, is_turned", [(0.0099, True), (0.0101, False)])
def test_about_an_axis_that_may_lean_by_more_than_a_hundredth_nothing_turns(tilt, is_turned):
    alike = replace(seemingly_round(0), tilt=tilt)
    assert (turn_by_harmonics(alike, harmonics_of(alike, {(0, 7): 1e-3})) is not alike) == is_turned


@pytest.mark.parametrize("first, other", [((0, 8), (1, 8)), ((1, 7), (0, 9)), ((0, 7), (0, 12)), ((0, 9), (1, 12))])
def test_of_two_harmonics_the_lower_degree_turns_and_the_other_decides(first, other):
    """Where both are real, the other one is as large as it gets: it has its own phase in each of the turned frames."""
    alike = seemingly_round(1)
    values = {first: 2e-3 * np.exp(2.0j), other: 5e-3 * np.exp(-1.0j)}
    harmonics = harmonics_of(alike, values)
    found = turn_by_harmonics(alike, harmonics)
    (m, phase), (n, own) = (first[1], 2.0), (other[1], -1.0)
    turns = (phase + 2.0 * np.pi * np.arange(m)) / m
    best = (5e-3 * np.cos(own - n * turns)).max()
    last = np.roll([0, 1, 2], 1)
    for frame in found.frames:
        turned = harmonics.in_frame(frame[:, last]).values
        assert abs(turned[first] - 2e-3) < 1e-16 and turned[other].real > best - 2.0 * NOISE
    assert len(found.frames) == np.gcd(m, n) and close(found.tilt, 1e-4 + NOISE / (m * 2e-3), 1e-12)


@pytest.mark.parametrize("area", [False, True])
def test_a_body_of_parts_of_any_reach_and_height_has_the_harmonics_of_the_whole(area):
    parts = [
        bodies.moved(shapes.prism(7), 1.5 * bodies.rotation(1), (1.0, 2.0, 0.0)),
        bodies.moved(shapes.prism(5, 4.0), 0.3 * bodies.rotation(2), (-9.0, 1.0, 0.5)),
        bodies.moved(shapes.WEDGE, bodies.rotation(4), (0.0, 0.0, 12.0)),
    ]
    frame, center = bodies.rotation(6), np.array([0.5, -1.0, 2.0])
    whole = axial_harmonics([Surface.from_triangles(*bodies.joined(*parts))], center, frame, area=area)
    found = axial_harmonics((Surface.from_triangles(*part) for part in parts), center, frame, area=area)
    assert np.abs(found.values - whole.values).max() < 1e-13 and found.order == 30 and (found.frame == frame).all()
    assert close(found.values[0, 0].real, 1.0, 1e-13)
    local = (bodies.joined(*parts)[0] - center) @ frame
    reach, height = np.hypot(local[:, 0], local[:, 1]).max(), np.abs(local[:, 2]).max()
    moved = axial_harmonics(
        [Surface.from_triangles(local, bodies.joined(*parts)[1])], np.zeros(3), np.eye(3), area=area
    )
    assert np.abs(found.values - moved.values).max() < 1e-13
    scaled = local / (reach, reach, height)
    small = axial_harmonics(
        [Surface.from_triangles(scaled, bodies.joined(*parts)[1])], np.zeros(3), np.eye(3), area=False
    )
    if not area:
        assert np.abs(found.values - small.values).max() < 1e-13
