# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements as plain data, for scripts and agents inside Blender."""

import json

import body_moments
import bpy
import pytest


@pytest.fixture
def cube(scene):
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(1.0, 2.0, 3.0), rotation=(0.0, 0.0, 0.5))
    return bpy.context.object


def test_description_is_plain_data_in_the_requested_frame(cube):
    (world,) = body_moments.describe()
    (own,) = body_moments.describe(cube, frame="object", mass=3.0)
    assert json.loads(json.dumps(world)) == world
    assert world["verdict"] == "exact" and world["numbers"]["center_of_mass"] == pytest.approx(
        [1.0, 2.0, 3.0]
    )
    assert own["numbers"]["center_of_mass"] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
    assert own["numbers"]["inertia"][0] == pytest.approx([2.0, 0.0, 0.0], abs=1e-6)
    assert [one["code"] for one in world["findings"]] == ["density_defaulted"] and not own[
        "findings"
    ]


def test_only_store_changes_the_file(cube):
    body_moments.describe(cube)
    assert "body_mass" not in cube
    (stored,) = body_moments.describe(cube, store=True)
    assert cube["body_mass"] == stored["numbers"]["mass"] and stored["next"] == []


def test_remedies_are_calls_that_exist(cube):
    bpy.ops.mesh.primitive_plane_add()
    (plane,) = body_moments.describe("Plane")
    assert plane["verdict"] == "not measured" and plane["numbers"] is None
    (remedy,) = plane["next"]
    assert eval(remedy) == {"FINISHED"}
    assert body_moments.describe("Plane")[0]["numbers"]["mass"] > 0.0


@pytest.mark.parametrize(
    ("objects", "options"),
    [
        ("Nobody", {}),
        ("Cube", {"frame": "local"}),
        ("Cube", {"kind": "liquid"}),
        ("Cube", {"density": float("nan")}),
        ("Cube", {"mass": "3"}),
        ("Cube", {"thickness": 0.0}),
        ("Cube", {"weight": 3.0}),
    ],
)
def test_wrong_words_and_numbers_are_refused(cube, objects, options):
    with pytest.raises(ValueError, match="one of|called|positive"):
        body_moments.describe(objects, **options)
