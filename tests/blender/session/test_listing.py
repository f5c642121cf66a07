# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The list of measured objects: what it shows in which order, what a click does, and the files of
their numbers.
"""

import csv
import io
import json

import bpy
import pytest
from body_moments.blender.session import displayed
from body_moments.blender.session.displayed import SortBy, listed_masses, listing
from body_moments.panels.texts import scene_units

from tests.blender.boxes import box_mesh
from tests.blender.objects import add, dent, measure, mesh_body, strip_mesh
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def shown(sort_by=SortBy.NAME, name="", warnings_first=False):
    scene, layer = bpy.context.scene, bpy.context.view_layer
    listed, lines = listing(scene, layer, name, sort_by, warnings_first)
    assert sorted(lines) == list(range(len(layer.objects)))
    names = {
        line: obj.name
        for obj, is_listed, line in zip(layer.objects, listed, lines, strict=True)
        if is_listed
    }
    return [names[line] for line in sorted(names)]


def four():
    """Measured: light, heavy and doubtful; one that was not."""
    objects = [
        add(mesh_body(), "b light"),
        add(mesh_body(), "C heavy", scale=(3, 3, 3)),
        add(strip_mesh(), "a strip"),
    ]
    add(mesh_body(), "Not Measured")
    measure(*objects)
    bpy.context.view_layer.update()
    return objects


def test_measured_objects_are_listed_and_sorted():
    light, heavy, _strip = four()
    assert shown() == ["a strip", "b light", "C heavy"]
    assert shown(SortBy.MASS)[0] == "C heavy" and shown(SortBy.VERDICT)[0] == "a strip"
    assert shown(name="HEAV") == ["C heavy"]
    dent(heavy, -1.0)
    assert shown(warnings_first=True) == ["a strip", "C heavy", "b light"]
    assert shown(SortBy.VERDICT) == ["C heavy", "a strip", "b light"]
    light.body_moments.density = 1e6
    bpy.context.view_layer.update()
    assert shown(SortBy.MASS)[0] == "b light"


def test_a_linked_object_of_the_same_name_has_its_own_mass(tmp_path):
    light, heavy, strip = four()
    path = str(tmp_path / "library.blend")
    light.name, heavy.name = "other", "b light"
    bpy.data.libraries.write(path, {heavy})
    heavy.name, light.name = "C heavy", "b light"
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["b light"]
    (linked,) = target.objects
    bpy.context.scene.collection.objects.link(linked)
    bpy.context.view_layer.update()
    assert (
        linked.name == light.name
        and linked["body_mass"] == heavy["body_mass"] != light["body_mass"]
    )
    masses = listed_masses(bpy.context.scene, bpy.context.view_layer, scene_units())
    assert masses.keys() == {obj.session_uid for obj in (light, heavy, strip, linked)}
    assert masses[linked.session_uid] == masses[heavy.session_uid] != masses[light.session_uid]


def test_a_click_selects_that_object_alone():
    objects, scene, layer = four(), bpy.context.scene, bpy.context.view_layer
    for obj in objects:
        scene.body_moments_listed = layer.objects.find(obj.name)
        assert layer.objects.active == obj and list(layer.objects.selected) == [obj]
        assert scene.body_moments_listed == layer.objects.find(obj.name)
    for nowhere in (-1, len(layer.objects)):
        scene.body_moments_listed = nowhere
        assert layer.objects.active == objects[-1] and list(layer.objects.selected) == [objects[-1]]
    bpy.ops.object.mode_set(mode="EDIT")
    scene.body_moments_listed = 0
    assert layer.objects.active == objects[-1]
    bpy.ops.object.mode_set(mode="OBJECT")
    layer.objects.active = None
    assert scene.body_moments_listed == -1
    assert "body_moments_listed" not in scene.keys()  # noqa: SIM118


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("masses", [(0.0, 0.0), (0.0, 0.25), (0.125, 0.25)])
def test_the_total_of_light_bodies_is_one_of_them_all(masses):
    """Also where a stored mass was changed to nothing."""
    objects = [add(box_mesh(1, 1, 1), name, (at, 0, 0)) for name, at in (("A", 2.0), ("B", 5.0))]
    for obj, mass in zip(objects, masses):
        obj.body_moments.mass_from, obj.body_moments.mass = "MASS", mass or 1.0
    measure(*objects)
    for obj, mass in zip(objects, masses):
        obj["body_mass"] = mass
    bpy.context.view_layer.update()
    total = displayed.total(bpy.context)
    assert total.count == 2 and total.volume == 2.0
    if not sum(masses):
        assert total.numbers is None
    else:
        assert close(total.numbers.mass, sum(masses), 1e-15)
        assert close(
            total.numbers.center[0], (2.0 * masses[0] + 5.0 * masses[1]) / sum(masses), 1e-15
        )


def test_the_table_has_a_row_for_each_object(capsys):
    objects = four()
    assert bpy.ops.object.body_moments_copy(what="TABLE") == {"FINISHED"}
    text = capsys.readouterr().out
    table = list(csv.DictReader(io.StringIO(text[text.index("file,") :])))
    assert [row["name"] for row in table] == sorted(obj.name for obj in objects)
    for row in table:
        obj = bpy.data.objects[row["name"]]
        assert (
            close(float(row["mass"]), obj["body_mass"], 1e-15)
            and row["method"] == obj["body_method"]
        )


@pytest.mark.parametrize("suffix", [".csv", ".json", ".jsonl", ".CSV"])
def test_the_file_has_the_numbers_and_is_replaced_as_a_whole(suffix, tmp_path, reported):
    objects, path = four(), tmp_path / ("numbers" + suffix)
    path.write_text("before")
    assert bpy.ops.object.body_moments_save_numbers(filepath=str(path)) == {"FINISHED"}
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    text = path.read_text(encoding="utf-8")
    if suffix.lower() == ".csv":
        assert len(list(csv.DictReader(io.StringIO(text)))) == 3
    else:
        document = json.loads(text)
        assert [entry["name"] for entry in document["objects"]] == sorted(
            obj.name for obj in objects
        )
        assert close(document["total"]["mass"], sum(obj["body_mass"] for obj in objects), 1e-14)
        assert document["total"]["warnings"] and document["file"] is None  # it was never saved
    assert "3" in reported.texts[-1] and path.name in reported.texts[-1]


def test_unsaveable_numbers_are_refused_with_reason(tmp_path, reported):
    four()
    reported.texts.clear()
    for path in ("", tmp_path / "a.txt", tmp_path):
        save_fails(path)
    assert len(reported.texts) == 3
    save_fails(tmp_path / "none" / "a.csv")
    assert "file_not_written" in reported.codes and not list(tmp_path.iterdir())


def save_fails(path):
    with pytest.raises(RuntimeError):  # a report of an error is one to Python
        bpy.ops.object.body_moments_save_numbers(filepath=str(path))
