# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How often cells are cut that a surface passes through and no rule serves: so many parts there may be."""

import numpy as np
import pytest
from body_moments.core.density import threshold
from body_moments.core.density.threshold_cells import Cells

from tests.close import close


@pytest.mark.parametrize("count, left", [(1, 4096), (2, 1024), (1024, 65_536), (1025, 8200)])
def test_of_each_cell_there_are_64_parts_on_average_and_8192_more_of_all(monkeypatch, count, left):
    """Cut in eight again and again: 8 (1 + 8 + 64 + 512) times one cell is within, and times two is not; of more, 8 (1
    + 8) is."""
    given_up = []
    monkeypatch.setattr(threshold._Sums, "_add_batch", lambda _sums, cells, _threshold, _allowed: cells)
    monkeypatch.setattr(threshold._Sums, "_give_up", lambda _sums, cells, _threshold: given_up.append(len(cells.size)))
    eight = [Cells(np.array([[[[-1.0, 1.0]] * 2] * 2]), np.zeros((1, 3)), np.ones(1))] * 8
    alike = Cells.join(eight)
    monkeypatch.setattr(Cells, "cut_in_eight", lambda cells: alike[np.arange(8 * len(cells.size)) % 8])
    sums = threshold._Sums(0, False, False, np.eye(3))
    sums.add_cut_cells(alike[np.zeros(count, int)], 0.5)
    assert given_up == [left]


def test_a_mass_is_measured_where_it_is_asked_for():
    samples = np.full((2, 2, 2), 3.0)
    assert threshold.threshold_body(samples, 1.0).mass is None
    assert close(threshold.threshold_body(samples, 1.0, with_density=True).mass.total, 3.0, 1e-14)
