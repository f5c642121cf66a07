# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are near to each other are found, and those alone."""

import numpy as np
import pytest
from body_moments.core.mesh.welding import (
    first_at_near_position,
    may_have_neighbor,
    same_vertices_groups,
    vertex_tolerance,
)

from tests.close import close


def test_only_points_that_stand_alone_have_no_neighbor():
    rng = np.random.default_rng(5)
    points = rng.uniform(-1, 1, (200, 3))
    twins = points[:20] + 1e-4 * rng.normal(size=(20, 3)) / np.sqrt(3.0)
    reach = np.linalg.norm(twins - points[:20], axis=1).max()
    together = np.concatenate([points, twins])
    may = may_have_neighbor(together, reach)
    assert may[:20].all() and may[200:].all() and may.sum() < 100
    owner = np.repeat([0, 1], [200, 20])
    assert not may_have_neighbor(together, np.full(220, reach), owner)[200:].any()
    first = first_at_near_position(together, np.full(220, reach))
    assert first[200:].tolist() == list(range(20)) and first[:200].tolist() == list(range(200))


def test_whichever_way_a_neighbor_within_reach_lies_it_is_noticed():
    rng = np.random.default_rng(6)
    way = rng.normal(size=(1000, 3))
    points = rng.uniform(-1e3, 1e3, (1000, 3))
    beside = points + 0.999e-6 * way / np.linalg.norm(way, axis=1)[:, None]
    assert may_have_neighbor(np.concatenate([points, beside]), 1e-6).all()
    alone = may_have_neighbor(points, 1e-6)
    assert alone.sum() < 10


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_vertices_move_by_a_thousandth_of_the_smallest_triangle_around_them_at_most(dtype):
    """Each triangle is as large as its longest side: 5, 13.3 and 0.5."""
    points = np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 5, 12], [0, 4, 0.5], [0.25, 4, 0.25], [9, 9, 9]], dtype)
    triangles = np.array([[0, 1, 2], [0, 3, 1], [2, 5, 4]])
    found = vertex_tolerance(points, triangles, np.array([6, 3, 0, 4, 2, 1]), 0.01)
    sides = [np.sqrt(178.0), 5.0, 0.5, 0.5, 5.0]
    assert close(found, [0.01, *np.minimum(0.01, 1e-3 * np.array(sides))], 1e-7)
    assert close(vertex_tolerance(points, triangles, np.array([3, 1]), 1.0), [1e-3 * 178.0**0.5, 5e-3], 1e-7)


@pytest.mark.parametrize("tolerances, is_one", [((1.0, 1.0), True), ((0.5, 1.0), False), ((1.0, 0.5), False)])
@pytest.mark.parametrize("way", [(0.9, 0.0, 0.0), (0.0, -0.9, 0.0), (0.5, 0.5, -0.5)])
def test_points_are_one_where_both_may_move_as_far(tolerances, is_one, way):
    """Others, far away, may move farther or are on their own."""
    places = np.array([[40.0, 0.0, 0.0], [0.0, 0.0, 0.0], way, [-30.0, 9.0, 2.0], [-30.0, 9.0, 3.9]])
    found = first_at_near_position(places, np.array([1.0, *tolerances, 2.0, 2.0]))
    assert found.tolist() == [0, 1, 1 if is_one else 2, 3, 3]


@pytest.mark.parametrize("seed", range(3))
def test_clusters_that_stand_apart_are_found_whole_in_any_order(seed):
    """Of points that are all within reach of each other, each cluster between two others; some points are alone."""
    rng = np.random.default_rng(seed)
    count = rng.integers(1, 7, 300)
    cluster = rng.permutation(np.repeat(np.arange(300), count))
    centers = 7e-3 + 4.5e-3 * np.array(list(np.ndindex(7, 7, 7)))[rng.permutation(343)[:300]]
    way = rng.normal(size=(len(cluster), 3))
    places = centers[cluster] + 0.499e-3 * way / np.linalg.norm(way, axis=1)[:, None]
    first = first_at_near_position(places, np.full(len(places), 1e-3))
    assert first.tolist() == [cluster.tolist().index(one) for one in cluster.tolist()]


def test_faces_share_a_group_where_they_have_the_same_vertices_and_nowhere_else():
    """Faces of one to four pieces, some of which use the vertices of others, whole or twice."""
    rng = np.random.default_rng(7)
    for _ in range(20):
        triangles, faces = [], []
        for face in range(40):
            pieces = rng.integers(1, 5)
            corners = rng.choice(6, 3, replace=False) if rng.random() < 0.5 else np.arange(3, 6)
            rows = [rng.permutation(corners) for _ in range(pieces)]
            if rng.random() < 0.3:
                rows[-1] = rng.choice(6, 3, replace=False)
            triangles += rows
            faces += [2 * face] * pieces
        faces, triangles = np.array(faces), np.array(triangles)
        found = same_vertices_groups(triangles, faces)
        sets = {face: frozenset(triangles[faces == face].ravel().tolist()) for face in faces.tolist()}
        first = {vertices: min(face for face, other in sets.items() if other == vertices) for vertices in sets.values()}
        assert found.tolist() == [first[sets[face]] for face in faces.tolist()]
