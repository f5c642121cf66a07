# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a density is negative in a body, from both sides of what counts."""

import numpy as np
import pytest
from body_moments.core.density import positivity
from body_moments.core.density.polynomial import parse_polynomial
from body_moments.core.density.positivity import find_negative_point

from tests.close import close
from tests.core import bodies, exact


def found(text, body, solid=True):
    """The value and the place, None where there is none; whether there may be one nevertheless."""
    points, triangles = (np.array(part) for part in body)
    unused = np.concatenate([points, [[-1e3, 1e3, 1e3]]])  # where any of these densities would be something else
    return find_negative_point(parse_polynomial(text), unused, triangles, solid)


BOX = bodies.box((-1, -1, -1), (1, 1, 1))
OUTLINE = [(0.0, 0.0), (10.0, 0.0), (10.0, 1.0), (1.0, 1.0), (1.0, 10.0), (0.0, 10.0)]
CORNERS, FACES = exact.prism(OUTLINE, 0.0, 1.0, [(0, 1, 2, 3), (0, 3, 4, 5)])
ANGLE = CORNERS, exact.fan(FACES)
FLAT = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 0.0]]), np.array([[0, 1, 2]])


@pytest.mark.parametrize("degree", ["", " + 0.0000000000001*x**2"])
def test_what_is_negative_at_a_vertex_is_told_from_what_rounding_makes(degree):
    for least, is_found in ((-0.9e-6, False), (-1.1e-6, True)):
        # from `least` to one along z
        text = "{!r}*(1 - z)/2 + (1 + z)/2{}".format(least, degree)
        worst, unsure = found(text, BOX)
        assert (worst is not None) == is_found and not unsure
        if is_found:
            assert close(worst[0], least, 1e-6) and worst[1][2] == -1.0


@pytest.mark.parametrize("text", ["1", "1.1 + x", "x**2 + 1", "2 + x*y*z"])
def test_what_is_positive_is_known_to_be(text):
    for body, solid in ((BOX, True), (BOX, False), (FLAT, False)):
        assert found(text, body, solid) == (None, False)


def test_the_middles_of_faces_count_where_a_density_is_curved():
    (value, place), unsure = found("(x - 1)**2 + (y - 1)**2 - 0.01", FLAT, False)
    assert close(value, -0.01, 1e-12) and close(place, [1.0, 1.0, 0.0], 1e-15) and not unsure


def test_the_inside_counts_where_it_is_filled_and_is_unknown_to_a_sheet():
    (value, place), unsure = found("x**2 + y**2 + z**2 - 0.5", BOX)
    assert close(value, -0.5, 1e-12) and np.abs(place).max() <= 1e-15 and not unsure
    assert found("x**2 + y**2 + z**2 - 0.5", BOX, solid=False) == (None, True)


def test_only_what_lies_in_the_body_counts():
    assert found("(x - 5.5)**2 + (y - 5.5)**2 - 3", ANGLE) == (None, True)  # between the arms
    (value, place), unsure = found("(x*y)**8 - 1000", ANGLE)  # a millionth of what there is between the arms
    assert value == -1000.0 and place[0] * place[1] == 0.0 and not unsure


@pytest.mark.parametrize("text", ["x**2 + y**2 + z**2 - 0.5", "x**2 + y**2 + z**2 - 2.5"])
def test_the_first_24_places_are_looked_for_in_the_body(monkeypatch, text):
    """Where the density is least, or where it is most if some of the surface is negative."""
    asked = []
    monkeypatch.setattr(positivity, "winding_number", lambda _points, _triangles, at: asked.append(at) or 0.0)
    found(text, BOX)
    values = np.sort([float(parse_polynomial(text)(at[None])[0]) for at in asked])
    grid = np.sort(parse_polynomial(text)(-1.0 + 2.0 * positivity.GRID_STEPS))
    assert len(asked) == 24 and np.array_equal(values, grid[:24] if text.endswith("0.5") else grid[-24:])


@pytest.mark.parametrize("least, is_found", [(-0.8e-6, False), (-1.2e-6, True)])
def test_a_surface_of_next_to_nothing_is_compared_with_the_inside(least, is_found):
    text = "(1 - x**2)*(1 - y**2)*(1 - z**2) + {!r}".format(least)
    worst, unsure = found(text, BOX)
    assert (worst is not None) == is_found and not unsure
    if is_found:
        assert close(worst[0], least, 1e-9) and np.abs(worst[1]).max() == 1.0


def test_of_places_that_are_negative_alike_the_first_is_named():
    """Of a grid of nine places along each side, in their order."""
    (value, place), _ = found("z**2 - 0.1", BOX)
    assert close(value, -0.1, 1e-12) and close(place[:2], [-8.0 / 9.0] * 2, 1e-12) and abs(place[2]) <= 1e-15
