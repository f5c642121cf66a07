# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are near to each other are found, and those alone."""

import numpy as np
from body_moments.core.mesh.welding import first_at_near_position, may_have_neighbor


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
