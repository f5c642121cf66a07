# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files Import Surfaces reads, in which unit, what it selects, and what it says of each."""

import bpy
import pytest

from tests.blender.objects import add, mesh_body
from tests.blender.read.test_surface_files import imported, unrolled, written
from tests.core.exact_splines import sphere, torus
from tests.core.iges_files import obj_text

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("name", ["", "folder"])
def test_a_path_that_is_no_file_is_none_to_import(name, tmp_path, reported):
    (tmp_path / "folder").mkdir()
    path = str(tmp_path / name) if name else ""
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_import_surfaces(filepath=path)
    assert reported.codes == ["no_surface_file"]


def test_a_file_that_is_not_there_is_named(tmp_path, reported):
    with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
        bpy.ops.object.body_moments_import_surfaces(filepath=str(tmp_path / "none.igs"))
    assert reported.codes == ["refused", "file_missing"]
    assert reported.values("refused")["object"] == "none.igs"


def test_names_of_the_browser_come_before_its_path_and_empty_ones_are_none(tmp_path, reported):
    written(tmp_path, unrolled(sphere()))
    (tmp_path / "two.obj").write_text(obj_text([unrolled(torus())], name="Donut"))
    path = str(tmp_path / "two.obj")
    imported(directory=str(tmp_path), filepath=path, files=[{"name": "body.igs"}])
    assert bpy.context.object.name == "body" and "Donut" not in bpy.data.objects
    imported(directory=str(tmp_path), filepath=path, files=[{"name": ""}])
    assert bpy.context.object.name == "Donut"


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_a_file_without_a_unit_has_that_of_the_option_and_others_their_own(scale, tmp_path):
    bpy.context.scene.unit_settings.scale_length = scale
    written(tmp_path, unrolled(sphere()), unit=6)
    (tmp_path / "two.obj").write_text(obj_text([unrolled(sphere())], name="Ball"))
    for name, meters in (("body.igs", 1.0), ("two.obj", 0.25)):
        obj = imported(filepath=str(tmp_path / name), unit=0.25)
        assert max(obj.dimensions) == pytest.approx(2.0 * meters / scale, rel=0.05)


def test_what_is_imported_is_selected_alone_and_each_file_has_a_line(tmp_path, reported):
    other = add(mesh_body(), "Other")
    written(tmp_path, unrolled(sphere()))
    (tmp_path / "bad.igs").write_text("nothing")
    obj = imported(directory=str(tmp_path), files=[{"name": "bad.igs"}, {"name": "body.igs"}])
    assert [*bpy.context.selected_objects] == [obj] and not other.select_get()
    assert bpy.context.view_layer.objects.active == obj
    assert reported.codes[:2] == ["not_imported", "refused"] and reported.codes.count("not_imported") == 1
    assert reported.values("surfaces_imported") == {"count": 1, "order": 3, "file": "body.igs"}


def test_what_comes_into_a_collection_that_is_not_shown_is_not_selected(tmp_path):
    hidden, active = bpy.data.collections.new("Hidden"), add(mesh_body(), "Other")
    bpy.context.scene.collection.children.link(hidden)
    layer = bpy.context.view_layer
    layer.active_layer_collection = layer.layer_collection.children["Hidden"]
    layer.layer_collection.children["Hidden"].exclude = True
    path = str(written(tmp_path, unrolled(sphere())))
    assert bpy.ops.object.body_moments_import_surfaces(filepath=path) == {"FINISHED"}
    shown = "body" in layer.objects
    assert "body" in bpy.data.objects and (layer.objects.active == active) != shown
