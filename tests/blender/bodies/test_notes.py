# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What changes mass, size and inertia by less than 1e-4 is a note: the same decision about a small thing and a large
one."""

import numpy as np
import pytest

from tests.blender.bodies.test_density import CORK, STEEL, by_material, material
from tests.blender.bodies.test_measure_object import add, box, collection_of, measure
from tests.blender.findings import said
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
SIDES = pytest.mark.parametrize(("side", "ending"), [(1e-3, "_slightly"), (0.1, "")])
UNIT = box((0, 0, 0), (1, 1, 1))


def small(side, place, turned=False):
    return box(place, tuple(np.add(place, side)), turned=turned)


@SIDES
def test_overlaps_of_instances(side, ending):
    for place, code, count in (
        ((0.4, 0.4, 0.4), "components_nested", 1),
        ((1 - side / 2, 0.4, 0.4), "components_overlap", 2),
    ):
        found = measure(collection_of(add(UNIT), add(small(side, place))))
        assert said(found) == {code + ending: {"count": count}}
        assert close(found.volume, 1.0 + side**3, rel=1e-6)


@SIDES
def test_flat_instances(side, ending):
    sheet = {"points": [(3, 0, 0), (3 + side, 0, 0), (3 + side, side, 0), (3, side, 0)], "faces": [(0, 1, 2, 3)]}
    found = measure(collection_of(add(UNIT), add(sheet)))
    assert said(found) == {"flat_instance_sources" + ending: {"count": 1, "total": 2}}
    assert close(found.volume, 1.0, rel=1e-6)


@pytest.mark.parametrize(("share", "ending"), [(0.1, "_slightly"), (0.6, "")])
def test_flat_instances_count_by_their_area_times_the_size_of_all(share, ending):
    """Beside a body of 8; all of them reach over about 4.1."""
    side = (share * 8e-4) ** 0.5
    sheet = {"points": [(3, 0, 0), (3 + side, 0, 0), (3 + side, side, 0), (3, side, 0)], "faces": [(0, 1, 2, 3)]}
    found = measure(collection_of(add(box((0, 0, 0), (2, 2, 2))), add(sheet)))
    assert [*said(found)] == ["flat_instance_sources" + ending]


@SIDES
def test_duplicate_faces_of_shells(side, ending):
    corners = [(3 + x * side, y * side, 0) for y in range(2) for x in range(3)]
    part = add(UNIT, {"points": corners, "faces": [(0, 1, 4, 3), (1, 2, 5, 4), (1, 2, 5, 4)]})
    part.body_moments.kind = "SHELL"
    found = measure(part)
    assert said(found)["duplicate_faces_of_shell" + ending] == {"count": 1}


@SIDES
@pytest.mark.parametrize("corners", [(0, 1, 2, 3), (3, 2, 1, 0), (2, 3, 0, 1), (0, 1, 2)])
def test_a_face_twice_over_the_same_vertices_of_a_shell(side, ending, corners):
    """Each of the two is the other's neighbor at every edge: by its edges alone the mesh is closed."""
    points = [(3, 0, 0), (3 + side, 0, 0), (3 + side, side, 0), (3, side, 0)]
    part = add(UNIT, {"points": points, "faces": [tuple(sorted(corners)), corners]})
    part.body_moments.kind = "SHELL"
    found = measure(part)
    assert said(found)["duplicate_faces_of_shell" + ending] == {"count": 1}
    assert found.health.duplicate_faces == 1


@SIDES
@pytest.mark.parametrize("copies", [1, 2])
def test_components_of_several_materials(side, ending, copies):
    bits = [small(side, (3 + i, 0, 0)) for i in range(copies)]
    faces = [0] * 6 + ([0, 1] * 3) * copies
    obj = by_material(add(UNIT, *bits), material("Steel", STEEL), material("Cork", CORK), faces=faces)
    found = said(measure(obj))
    if ending:
        assert found == {"mixed_materials_slightly": {"count": copies, "total": 1 + copies}}
    else:
        assert set(found) == {"mixed_material_component" if copies == 1 else "mixed_material_components"}


@SIDES
def test_materials_of_cavities(side, ending):
    hole = small(side, (0.4, 0.4, 0.4), turned=True)
    obj = by_material(add(UNIT, hole), material("Steel", STEEL), material("Cork", CORK), faces=[0] * 6 + [1] * 6)
    found = measure(obj)
    assert "cavity_material_ignored" + ending in said(found)
    assert close(found.mass_properties.mass, STEEL * (1.0 - side**3), rel=1e-6)
