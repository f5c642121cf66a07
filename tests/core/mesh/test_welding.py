# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are near to each other are found, and those alone."""

import numpy as np
from body_moments.core.mesh.welding import first_at_near_position, may_have_neighbor, same_vertices_groups


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
