# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that other files hold: nothing is written on them that would be lost, and each is
named.
"""

import bpy
import pytest

from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def linked(tmp_path):
    """Two linked objects of one name, and a local one of that name, active and selected with
    them.
    """
    for file in ("a.blend", "b.blend"):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        add(mesh_body(), "Körper")
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / file))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    found = []
    for file in ("a.blend", "b.blend"):
        with bpy.data.libraries.load(str(tmp_path / file), link=True) as (_, names):
            names.objects = ["Körper"]
        found += names.objects
        bpy.context.scene.collection.objects.link(names.objects[0])
    local = add(mesh_body(), "Körper")
    only(local, *found)
    assert [one.name for one in (local, *found)] == ["Körper"] * 3
    return local, *found


@pytest.fixture
def overridden(linked):
    """A library override, active and selected with a local object."""
    local, source, _ = linked
    override = source.override_create(remap_local_usages=True)
    if override.name not in bpy.context.scene.collection.objects:
        bpy.context.scene.collection.objects.link(override)
    bpy.context.view_layer.update()
    only(override, local)
    return override


def run(operator, **options):
    return getattr(bpy.ops.object, "body_moments_" + operator)(**options)


ALL = [
    ("measure", {}),
    ("find_symmetry", {}),
    ("set_material", {"material": "Water"}),
    ("set_rigid_body_mass", {"add": True}),
    ("align_to_world", {}),
    ("origin_to_center", {}),
]


@pytest.mark.parametrize(("operator", "options"), ALL)
def test_linked_objects_are_left_unchanged_and_told_apart(linked, operator, options, reported):
    assert run(operator, **options) == {"FINISHED"}
    failures = [finding.values for finding in reported if finding.code == "failure"]
    assert [values["object"] for values in failures] == ["Körper [a.blend]", "Körper [b.blend]"]
    assert {values["cause"]["code"] for values in failures} == {"linked_object"}


def test_settings_are_not_copied_to_linked_objects(linked, reported):
    local, *_ = linked
    local.body_moments.density = 5.0
    assert run("copy_settings") == {"CANCELLED"}
    assert reported.codes.count("failure") == 2


def test_similar_objects_of_one_name_are_selected_each(linked):
    local, *others = linked
    bpy.context.view_layer.objects.active = local
    assert run("find_similar") == {"FINISHED"}
    names = sorted(row.name for row in bpy.context.scene.body_moments_search.found)
    assert names == ["Körper [a.blend]", "Körper [b.blend]"]
    for name, other in zip(names, others, strict=True):
        assert run("select_found", name=name) == {"FINISHED"}
        assert bpy.context.object == other


@pytest.mark.parametrize(("operator", "options"), ALL[:4] + [("copy_settings", {})])
def test_an_override_is_given_nothing_that_its_file_would_lose(
    overridden, operator, options, reported
):
    if operator == "copy_settings":
        local = next(obj for obj in bpy.context.selected_objects if obj != overridden)
        local.body_moments.density = 5.0
        bpy.context.view_layer.objects.active = local
    run(operator, **options)
    assert {"linked_object"} & {*reported.codes}
    assert not overridden.is_property_set("body_moments_symmetry") and "body_mass" not in overridden
    assert overridden.rigid_body is None and overridden.body_moments.density == 1000.0
    assert not overridden.body_moments.material


def test_linked_material_density_is_not_editable(tmp_path):
    from body_moments.panels.material_menus import density_row

    from tests.panels.drawing import Layout

    bpy.data.materials.new("Stahl").use_fake_user = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    local = bpy.data.materials.new("Stahl")
    with bpy.data.libraries.load(str(tmp_path / "a.blend"), link=True) as (_, names):
        names.materials = ["Stahl"]
    for material, enabled in ((local, True), (names.materials[0], False)):
        layout = Layout()
        density_row(layout, bpy.context.scene, material)
        assert ("enabled", enabled) in layout.record
