# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots in kilograms and meters, whatever the unit of the file or of the scene: masses, inertias,
joints, meshes.
"""

import itertools

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from tests.blender.batch_files import add_box, document
from tests.blender.characters import PARENTS, armature_of, skin_of
from tests.blender.exported_robots import SUFFIXES, assert_filled
from tests.close import close
from tests.command.robot_files import exported, text
from tests.core import characters
from tests.core.bodies import box
from tests.core.mesh_files import stl

pytestmark = pytest.mark.usefixtures("scene")
UNITS = (1.0, 0.01, 0.001, 0.0254)
SIDES = np.array([40.0, 20.0, 10.0])
DENSITY = 2700.0
Y_UP = {"gltf": [0, 2, 1]}  # the order of the axes where y is up

every_export = pytest.mark.parametrize(("name", "unit"), [*itertools.product(SUFFIXES, UNITS)])


def box_stl(folder):
    path = folder / "part.stl"
    path.write_bytes(stl(box((0, 0, 0), SIDES)))
    return path


def assert_box(link, name, unit):
    """The body of 40 x 20 x 10 units of aluminum."""
    sides = SIDES[Y_UP.get(name, [0, 1, 2])] * unit
    assert close(link.sides, sides, 1e-6) and close(link.mass, DENSITY * sides.prod(), 1e-6)
    assert_filled(link, DENSITY)


@pytest.mark.parametrize("is_scene", [False, True])
@pytest.mark.parametrize("links", ["object", "collection"])
@every_export
def test_units_hold_for_masses_and_meshes(tmp_path, name, unit, links, is_scene):
    words = () if is_scene else ("--unit-scale", unit, box_stl(tmp_path))
    bpy.context.scene.unit_settings.scale_length = unit if is_scene else 1.0
    add_box("Part", (70.0, 0.0, 0.0), SIDES)
    (link,) = exported(tmp_path, name, "--links", links, "--density", DENSITY, *words).values()
    assert_box(link, name, unit)


@every_export
def test_bones_are_links_in_meters(tmp_path, name, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    character = characters.box_skeleton()
    skin_of(character, armature_of(character, parents=PARENTS), density=DENSITY)
    links = exported(tmp_path, name, "--links", "bone")
    assert len(links) == len(character.names)
    for link in links.values():
        assert_filled(link, DENSITY)
    low, high = character.points.min(axis=0), character.points.max(axis=0)
    assert sum(link.mass for link in links.values()) < DENSITY * np.prod((high - low) * unit)
    assert max(link.sides.max() for link in links.values()) < (high - low).max() * unit


@pytest.mark.parametrize(
    "option", [("--material", "Aluminum"), ("--kind", "shell", "--thickness", "0.001")]
)
def test_collections_follow_the_density_options(tmp_path, option):
    path = box_stl(tmp_path)
    (link,) = exported(
        tmp_path, "urdf", "--links", "collection", "--unit-scale", "0.001", *option, path
    ).values()
    assert close(
        link.mass, document(*option, "--unit-scale", "0.001", path)["total"]["mass"], 1e-12
    )


@pytest.mark.parametrize("links", ["collection", "bone"])
def test_scans_are_links_of_their_own_without_the_scene(tmp_path, links):
    """The open scene has nothing to do with a file that Blender does not open."""
    add_box("Of the scene")
    np.save(tmp_path / "scan.npy", np.full((3, 3, 3), 2.0))
    found = text("measure", "--format", "urdf", "--links", links, tmp_path / "scan.npy")
    assert 'link name="scan"' in found and "Of the scene" not in found and "Collection" not in found
