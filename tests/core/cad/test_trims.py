# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Loops that bound a region of a plane or of a sphere."""

import contextlib

import numpy as np
import pytest
from body_moments.core.cad.sweeps import conic_pieces
from body_moments.core.cad.trimmed import face_within, flat_region
from body_moments.core.nurbs import (
    TURN,
    Quadric,
    bezier_curves,
    measure_patches,
    reverse_curves,
)
from body_moments.core.verdict import MeasureError

from tests.core.polygons import polygon


def test_directed_loops_may_touch_but_not_cross():
    up = np.array([0.0, 0.0, 1.0])
    square = polygon((0, 0), (2, 0), (2, 2), (0, 2))
    corner = polygon((2, 2), (3, 2), (3, 3), (2, 3))
    assert flat_region([square, corner], up).area_moments(0, np.zeros(3)).total == 5.0
    twisted = polygon((0, 0), (3, 3), (3, 0), (1, 4))  # lobes of different signs
    overlapping = polygon((1, 1), (3, 1), (3, 3), (1, 3))
    cornered = polygon((0, 0), (2, 2), (3, 3), (3, 0), (1, 4))  # the same, a corner on an edge
    sides = np.linspace([(0, 0), (3, 3), (3, 0), (1, 4)], [(3, 3), (3, 0), (1, 4), (0, 0)], 31)
    fine = polygon(*np.moveaxis(sides[:-1], 1, 0).reshape(-1, 2))  # the same, in short curves
    crossing = [[loop] for loop in (twisted, cornered, fine)]
    for loops in (*crossing, *([reverse_curves(one)] for (one,) in crossing)):
        with pytest.raises(MeasureError):
            flat_region(loops, up)
    with pytest.raises(MeasureError):
        flat_region([square, overlapping], up)


def test_bound_covers_a_ball_whose_small_rim_misses_its_surface():
    frame = np.eye(4)
    frame[2, 3] = -np.sqrt(1.0001**2 - 0.1**2)
    rim = conic_pieces(frame, (0.1, 0.1), (0.0, TURN))
    ball = face_within(Quadric(np.eye(4), minor=1.0), [rim])
    volume = measure_patches([ball, flat_region([rim], -frame[:3, 2])]).volume
    bound = (volume.rounding_error + volume.input_error)[0]
    assert bound < 1e-3 * volume.total
    for radius in (1.0, 1.0001):
        height = radius - frame[2, 3]
        truth = np.pi * height**2 * (radius - height / 3.0)
        assert abs(volume.total - truth) <= bound


def parted(curves):
    parts = []
    for curve in curves:
        low, high = curve.space.domain
        middle = 0.63 * low + 0.37 * high
        parts += bezier_curves(curve, (low, middle)) + bezier_curves(curve, (middle, high))
    return parts


def test_seam_in_other_pieces_each_way_never_leaves_nothing():
    tube = np.eye(4)[:, [0, 2, 1, 3]]
    tube[0, 3] = 3.0
    around = conic_pieces(np.eye(4), (4.0, 4.0), (0.0, TURN))
    across = conic_pieces(tube, (1.0, 1.0), (0.0, TURN))
    back = [reverse_curves(one) for one in (around, across)]

    def area(*loop):
        torus = face_within(Quadric(np.eye(4), 3.0, 1.0), [sum(loop, [])])
        return torus.area_moments(0, np.zeros(3)).total

    assert abs(area(around, across, parted(back[0]), back[1]) - 12.0 * np.pi**2) <= 1e-9
    with contextlib.suppress(MeasureError):  # Rounding decides whether it is refused.
        assert abs(area(around, across, parted(back[0]), parted(back[1])) - 12.0 * np.pi**2) <= 1e-9
