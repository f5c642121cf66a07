# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies as plain numbers: principal axes as those of arrays, and sums against exact rationals."""

from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.inertia import (
    TENSOR,
    MassProperties,
    PlainBody,
    add_bodies,
    principal_axes,
    tensor_rows,
)
from body_moments.core.moments import SECOND_MOMENT_INDEX, Measure, Moments

from tests.close import close
from tests.core.boxes import box

# of each symmetry, and of a flat body
SPREADS = (
    (5, 3, 2),
    (5, 2, 2),
    (5, 5, 2),
    (3, 3, 3),
    (5, 3, 0),
)


@pytest.mark.parametrize("scale", [1e-9, 1e9])
@pytest.mark.parametrize("spread", SPREADS)
def test_principal_axes_are_those_of_arrays(spread, scale):
    random = np.random.default_rng(1)
    turns = [np.linalg.qr(random.standard_normal((3, 3)))[0] for _ in range(20)]
    turns += [
        np.eye(3)[list(order)] for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2))
    ]
    for turn in turns:
        second = scale * turn @ np.diag(spread) @ turn.T
        raw = np.zeros(20)
        raw[0], raw[SECOND_MOMENT_INDEX] = 1.0, (second + second.T) / 2.0
        truth = MassProperties.from_moments(Moments(raw, np.zeros(3), Measure.MASS))
        moments, axes, symmetry = principal_axes([truth.inertia[i, j] for _, i, j in TENSOR])
        assert (
            close(moments, truth.principal.moments, 1e-14) and symmetry == truth.principal.symmetry
        )
        assert np.abs(np.transpose(axes) - truth.principal.axes).max() < 1e-12


def test_sum_of_far_boxes_is_exact():
    places = (4096, -8192, 2048), (4097, -8190, 2052)
    boxes = [box((1, 2, 4), place, mass) for place, mass in zip(places, (3, 5))]
    bound = dict.fromkeys(("volume", "area", "center_of_mass", "inertia"), 0.0)
    bodies = [MassProperties.from_moments(moments) for moments, _ in boxes]
    whole = add_bodies(
        [PlainBody.of_body(body, 1.0, 8.0, 28.0, {**bound, "input": bound}) for body in bodies]
    )
    center = [Fraction(3 * a + 5 * b, 8) for a, b in zip(*places)]
    truth = sum(tensor(center) for _, tensor in boxes)
    assert (
        whole.mass == 8.0
        and whole.volume == 16.0
        and close(whole.center, [float(c) for c in center], 1e-15)
    )
    assert np.abs(np.array(tensor_rows(whole.inertia)) - truth).max() <= 1e-13 * truth.max()
    assert add_bodies([]) is None
