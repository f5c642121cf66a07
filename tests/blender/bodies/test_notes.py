# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What changes mass, size and inertia by less than 1e-4 is a note: the same decision about a small
thing and a large one.
"""

import numpy as np
import pytest

from tests.blender.findings import said
from tests.blender.measured_boxes import add, box, collection_of, measure
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
SIDES = pytest.mark.parametrize(("side", "slight"), [(1e-3, {"slight": True}), (0.1, {})])
UNIT = box((0, 0, 0), (1, 1, 1))


def small(side, place, turned=False):
    return box(place, tuple(np.add(place, side)), turned=turned)


@SIDES
def test_overlaps_of_instances(side, slight):
    for place, code, count in (
        ((0.4, 0.4, 0.4), "components_nested", 1),
        ((1 - side / 2, 0.4, 0.4), "components_overlap", 2),
    ):
        found = measure(collection_of(add(UNIT), add(small(side, place))))
        assert said(found) == {code: {"count": count, **slight}}
        assert close(found.volume, 1.0 + side**3, rel=1e-6)


@SIDES
def test_flat_instances(side, slight):
    sheet = {
        "points": [(3, 0, 0), (3 + side, 0, 0), (3 + side, side, 0), (3, side, 0)],
        "faces": [(0, 1, 2, 3)],
    }
    found = measure(collection_of(add(UNIT), add(sheet)))
    assert said(found) == {"flat_surfaces": {"count": 1, "total": 2, **slight}}
    assert close(found.volume, 1.0, rel=1e-6)


@SIDES
def test_duplicate_faces_counteds(side, slight):
    corners = [(3 + x * side, y * side, 0) for y in range(2) for x in range(3)]
    part = add(UNIT, {"points": corners, "faces": [(0, 1, 4, 3), (1, 2, 5, 4), (1, 2, 5, 4)]})
    part.body_moments.kind = "SHELL"
    found = measure(part)
    assert said(found)["duplicate_faces_counted"] == {"count": 1, **slight}
