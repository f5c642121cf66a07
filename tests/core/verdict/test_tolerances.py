# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What counts as nothing, from both sides, in bodies that are measured."""

import numpy as np
import pytest
from body_moments.core import Surface, measure_solid, polyhedron_moments
from body_moments.core.numerics import clamped_space
from body_moments.core.nurbs import Curve, Patch, length_moments, measure_patches, measure_sheet
from body_moments.core.solid.duplicate_faces import _copies_findings
from body_moments.core.verdict.method import Verdict
from body_moments.core.verdict.tolerances import welding_tolerance
from body_moments.core.wall import offset_solid

from tests.core.bodies import box, soup, without
from tests.core.findings import codes, refused


def measured(part):
    return measure_solid(Surface.from_triangles(*part))


@pytest.mark.parametrize(
    "size, code", [(9.9e49, ""), (1.01e50, "object_too_large"), (1.01e-60, ""), (9.9e-61, "object_too_small")]
)
def test_a_body_may_be_as_large_and_as_small_as_its_moments_are_numbers(size, code):
    rod = box((0, 0, 0), (size, 0.01 * size, 0.01 * size))
    if code:
        with refused(code):
            measured(rod)
    else:
        assert measured(rod).volume.total > 0.0


@pytest.mark.parametrize("height, is_flat", [(2.79e-14, True), (2.87e-14, False)])
def test_a_closed_sheet_is_told_from_a_thin_body(height, is_flat):
    assert (measured(box((0, 0, 0), (1, 1, height))).method == Verdict.OPEN) == is_flat


@pytest.mark.parametrize("height, is_flat", [(1.40e-7, True), (1.43e-7, False)])
def test_an_open_sheet_is_told_from_a_thin_body_without_a_side(height, is_flat):
    found = measured(without(box((0, 0, 0), (1, 1, height)), 0, 1))
    assert (found.method, codes(found)) == (
        (Verdict.OPEN, ["flat_surface"]) if is_flat else ("capped", ["holes_capped"])
    )


def test_points_are_the_same_within_a_millionth_of_the_diagonal_or_four_times_what_storing_moves_them():
    assert [welding_tolerance(2.0, error) for error in (0.0, 4e-7, 6e-7)] == [2e-6, 2e-6, 4.0 * 6e-7]


@pytest.mark.parametrize("gap, code", [(1.72e-6, "vertices_welded_slightly"), (1.75e-6, "holes_capped_slightly")])
def test_vertices_that_are_near_are_welded(gap, code):
    points, triangles = soup(box())
    points[0] += (gap, 0.0, 0.0)
    assert codes(measured((points, triangles))) == [code]


@pytest.mark.parametrize("steps, code", [(3, "vertices_welded"), (4, "holes_capped_slightly")])
def test_vertices_that_storing_as_float32_may_have_parted_are_welded(steps, code):
    """Nearer than four times √3 half steps of float32, which are those of 1024 to 2048 here: 3.46 steps."""
    points, triangles = soup(box((1100, 1100, 1100), (1101, 1101, 1101)))
    points[0] += (steps * 2.0**-13, 0.0, 0.0)
    assert codes(measured((points.astype(np.float32), triangles))) == [code]


@pytest.mark.parametrize("share, more", [(0.99e-4, "_slightly"), (1.01e-4, "")])
def test_what_changes_a_body_by_little_is_a_note(share, more):
    area, one = np.array([1.0 - share, share]), np.array([1])
    found = [finding.code for finding in _copies_findings(one, one, area)]
    assert found == ["duplicate_faces_ignored" + more, "duplicate_faces_counted" + more]


@pytest.mark.parametrize("size", [1e-62, 1e-120, 1e-200, 1e-310])
def test_bodies_too_small_for_a_volume_are_refused(size):
    points, triangles = size * np.eye(4, 3, -1), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    surface, line = Surface(points, triangles), clamped_space(2)
    patch = Patch((line, line), size * np.array([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]]))
    for measure in (
        lambda: measure_solid(surface),
        lambda: polyhedron_moments(surface),
        lambda: polyhedron_moments([surface], 5, about=(0, 0, 0)),
        lambda: offset_solid(surface),
        lambda: measure_patches([patch]),
        lambda: measure_sheet([patch], 0.0, 0.1 * size),
        lambda: length_moments([Curve(line, points[:2])]),
    ):
        with refused("object_too_small"):
            measure()
