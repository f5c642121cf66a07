# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Winding numbers by rays: of a box, and where they are not sure."""

import numpy as np
import pytest
from body_moments.core.mesh import bvh
from body_moments.core.mesh.bvh import RAY_SLOPES, Bvh, radix_argsort, sort_components

from tests.close import close
from tests.core import bodies, shapes

RAY = np.array([*RAY_SLOPES, 1.0])
TOLERANCE = 1e-6


def tree_of(points, triangles):
    components = sort_components(points, triangles, np.zeros(len(triangles), np.intp), 1)
    return Bvh(points, components, np.ones(1, bool))


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("share", [2.0, 1.1, 0.9, 0.1, -0.1, -0.9, -1.1, -2.0])
def test_a_place_is_sure_where_the_surface_is_farther_along_the_ray_than_the_tolerance(share, flip):
    """Of faces above and below it, on both sides; other places are sure all the same."""
    points, triangles = bodies.box((1.0, 2.0, 3.0), (2.0, 4.0, 6.0))
    tree = tree_of(points, triangles[:, ::-1] if flip else triangles)
    faces = np.array([[1.3, 2.9, 6.0], [1.8, 3.4, 3.0], [1.3, 3.1, 6.0]])
    far = np.array([[1.5, 3.0, 4.5], [0.5, 3.0, 4.5], [1.5, 3.0, 6.5], [1.5, 3.0, 2.0]])
    places = np.concatenate([faces - share * TOLERANCE * RAY, far])
    winding, sure = tree.winding_numbers(places - tree.origin, np.zeros(7, np.intp), TOLERANCE)
    assert sure.tolist() == [abs(share) > 1.0] * 3 + [True] * 4
    inside = [share > 0.0, share < 0.0, share > 0.0, True, False, False, False]
    expected = np.where(inside, -1 if flip else 1, 0)
    assert (winding[sure] == expected[sure]).all()


def test_a_place_on_the_surface_is_not_sure_without_a_tolerance():
    tree = tree_of(*bodies.box((0.0, 0.0, 0.0), (1.0, 2.0, 4.0)))
    places = np.array([[0.5, 0.75, 4.0], [0.5, 0.75, 0.0], [0.5, 0.75, 1.0]]) - tree.origin
    assert tree.winding_numbers(places, np.zeros(3, np.intp), 0.0)[1].tolist() == [False, False, True]


@pytest.mark.parametrize("turn", range(3))
def test_distances_from_a_box_have_their_closed_form_inside_and_outside(turn):
    low, high = np.roll([1.0, 2.0, 3.0], turn), np.roll([2.0, 4.0, 7.0], turn)
    tree = tree_of(*shapes.refined(shapes.refined(bodies.box(low, high), 0), 1))
    places = np.random.default_rng(turn).uniform(2.0 * low - high, 2.0 * high - low, (300, 3))
    outside = np.linalg.norm(np.maximum(np.maximum(low - places, places - high), 0.0), axis=1)
    inside = np.minimum(places - low, high - places).min(axis=1)
    assert 5 < np.count_nonzero(inside > 0.0) < 295
    found = tree.distances(places - tree.origin, np.zeros(300, np.intp))
    assert close(found, np.where(inside > 0.0, inside, outside), rel=1e-12)


@pytest.mark.parametrize("limit, is_sure", [(4, False), (5, True)])
def test_where_the_work_runs_out_nothing_is_sure(monkeypatch, limit, is_sure):
    monkeypatch.setattr(bvh, "MAX_BOX_PAIRS", limit)
    points, triangles = bodies.box()
    tree = tree_of(points, triangles[:4])  # one leaf
    assert tree.winding_numbers(np.full((5, 3), 9.0), np.zeros(5, np.intp), 0.0)[1].tolist() == [is_sure] * 5


@pytest.mark.parametrize("values", [[2, 65535, 1, 65535], [65536, 1, 65535, 0, 65536], [65537, 131072, 65536, 131071]])
def test_integers_are_sorted_by_all_of_their_bits_and_stay_in_order_where_they_are_equal(values):
    assert radix_argsort(np.array(values)).tolist() == sorted(range(len(values)), key=values.__getitem__)
    many = np.random.default_rng(0).permutation(np.repeat(np.array(values, np.uint32), 300))
    assert radix_argsort(many).tolist() == sorted(range(len(many)), key=many.tolist().__getitem__)


def test_a_tree_s_places_are_about_the_middle_of_what_was_chosen():
    """So that what is far away loses no digits."""
    parts = bodies.joined(bodies.box((1, 2, 3), (2, 4, 7)), bodies.box((8, 9, 7), (9, 9.5, 8)), bodies.box())
    shell = np.repeat([0, 1, 2], 12)
    tree = Bvh(parts[0], sort_components(*parts, shell, 3), np.array([True, True, False]))
    assert tree.origin.tolist() == [5.0, 5.75, 5.5]
