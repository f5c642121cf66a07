# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The densities of faces by their materials, and what is said of components that have several."""

from types import SimpleNamespace

import numpy as np
import pytest
from body_moments.blender.bodies.density.varying_density import _FaceDensities, _similarity_groups, _vertex_density
from body_moments.core.verdict.finding import ReadError, finding


class Material:
    def __init__(self, name, density):
        self.name, self.name_full, self.body_moments = name, name + " [lib]", SimpleNamespace(density=density)


STEEL, WOOD, PLAIN = Material("Steel", 7850.0), Material("Wood", 500.0), Material("Plain", 0.0)


def reading_of(*parts):
    """Parts as (materials, slot of each face, number of places)."""
    return SimpleNamespace(
        parts=[
            SimpleNamespace(
                attributes=SimpleNamespace(materials=slots, face_slots=np.array(faces)),
                matrices=np.zeros((count, 4, 4)),
            )
            for slots, faces, count in parts
        ]
    )


def test_faces_have_the_density_of_their_material_or_else_the_objects():
    found = _FaceDensities(
        reading_of(((WOOD, None, STEEL, PLAIN), [2, 0, 1, 3, 2, -1], 3), ((STEEL,), [0, 0], 2), ((), [-1], 1)), 40.0
    )
    assert [row.tolist() for row in found.values] == [[7850, 500, 40, 40, 7850, 40], [7850, 7850], [40]]
    assert (found.faces_without_density, found.faces) == (3 * 3 + 1, 6 * 3 + 2 * 2 + 1)
    assert found.names == ("Plain [lib]", "Steel [lib]", "Wood [lib]") and found.has_several
    values = {"count": 10, "total": 23, "density": 40.0}
    assert [*found.missing_note()] == [finding("object_density_used_for_materials", **values, materials=["Plain"])]
    named = [names.tolist() for _, names in found.with_names()]
    assert named == [["Steel", "Wood", "", "Plain", "Steel", ""], ["Steel", "Steel"], [""]]
    parts = [
        finding("density_of_material", material="Steel", density=7850.0),
        finding("density_of_material", material="Wood", density=500.0),
        finding("density_of_others", density=40.0),
    ]
    for by_area in (False, True):
        several = [*parts, finding("density_mixed_by_area")] if by_area else parts
        records = [part.as_record() for part in several]
        assert found.source(by_area) == finding("density_from_materials", materials=records)


def test_places_are_grouped_by_how_they_stretch_areas():
    maps = np.tile(np.eye(4), (5, 1, 1))
    maps[:, 0, 3] = range(5)
    maps[1, :3, :3] *= 2.0
    maps[2, 0, 0] = maps[4, 0, 0] = 3.0
    maps[3, 1, 1] = 3.0
    groups = [matrices[:, 0, 3].tolist() for matrices in _similarity_groups(maps)]
    assert groups[0] == [0.0, 1.0] and sorted(groups[1:]) == [[2.0, 4.0], [3.0]]
    assert [matrices[:, 0, 3].tolist() for matrices in _similarity_groups(maps[2:3])] == [[2.0]]


@pytest.mark.parametrize(("value", "code"), [(-1e-9, "attribute_negative"), (np.inf, "attribute_non_finite")])
def test_values_of_vertices_that_no_face_uses_do_not_count(value, code):
    values = np.array([1.0, value, 0.0, 2.0, value])
    triangles = np.array([[0, 2, 3]])
    surface = SimpleNamespace(all_triangles=lambda: (triangles, None))
    part = SimpleNamespace(
        attributes=SimpleNamespace(vertex_values=values), surface=surface, source_object_name="Other"
    )
    reading = SimpleNamespace(name="Whole", parts=[part])
    assert _vertex_density(reading, 0, "rho") is values
    triangles = np.array([[0, 1, 2], [1, 2, 4]])
    with pytest.raises(ReadError) as caught:
        _vertex_density(reading, 0, "rho")
    assert code in str(caught.value.finding.as_record()) and "Other" in str(caught.value.finding.as_record())
    assert "'count': 2" in str(caught.value.finding.as_record())
