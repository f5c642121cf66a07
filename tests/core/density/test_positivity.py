# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Negative densities in a body, on both sides of the limit."""

import numpy as np
import pytest
from body_moments.core.density import find_negative_point, parse_polynomial

from tests.close import close
from tests.core import bodies, exact


def found(text, body, solid=True):
    """The value and the place, or None, and a flag if a negative value remains possible."""
    points, triangles = (np.array(part) for part in body)
    # any of these densities would differ there
    unused = np.concatenate([points, [[-1e3, 1e3, 1e3]]])
    return find_negative_point(parse_polynomial(text), unused, triangles, solid)


BOX = bodies.box((-1, -1, -1), (1, 1, 1))
OUTLINE = [(0.0, 0.0), (10.0, 0.0), (10.0, 1.0), (1.0, 1.0), (1.0, 10.0), (0.0, 10.0)]
CORNERS, FACES = exact.prism(OUTLINE, 0.0, 1.0, [(0, 1, 2, 3), (0, 3, 4, 5)])
ANGLE = CORNERS, exact.fan(FACES)
FLAT = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]]), np.array([[0, 1, 2]])


@pytest.mark.parametrize("degree", ["", " + 0.0000000000001*x**2"])
def test_negative_vertex_density_is_told_from_rounding(degree):
    for least, is_found in ((-0.9e-6, False), (-1.1e-6, True)):
        # from `least` to one along z
        text = "{!r}*(1 - z)/2 + (1 + z)/2{}".format(least, degree)
        worst, unsure = found(text, BOX)
        assert (worst is not None) == is_found and not unsure
        if is_found:
            assert close(worst[0], least, 1e-6) and worst[1][2] == -1.0


@pytest.mark.parametrize("text", ["1", "1.1 + x", "x**2 + 1", "2 + x*y*z"])
def test_positive_density_is_known_to_be_positive(text):
    for body, solid in ((BOX, True), (BOX, False), (FLAT, False)):
        assert found(text, body, solid) == (None, False)


def test_density_outside_the_body_does_not_count():
    assert found("(x - 5.5)**2 + (y - 5.5)**2 - 3", ANGLE) == (None, True)  # between the arms
    # a millionth of what there is between the arms
    (value, place), unsure = found("(x*y)**8 - 1000", ANGLE)
    assert value == -1000.0 and place[0] * place[1] == 0.0 and not unsure
