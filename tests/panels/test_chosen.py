# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection decides: its settings are shown and set, never those of an unselected active
object.
"""

import bpy
import numpy as np
import pytest

from tests.blender.objects import add, measure, mesh_body, only
from tests.panels.drawing import labels, shown

pytestmark = pytest.mark.usefixtures("scene")


def buttons(record):
    return [entry[1] for entry in record if entry[0] == "operator"]


def set_of(obj):
    settings = obj.body_moments
    names = ("kind", "thickness", "mass_from", "mass", "density", "material", "overlap", "wall")
    return [getattr(settings, name) for name in names]


@pytest.fixture
def mixed():
    """Two selected bodies of different materials and thicknesses, and an unselected active one."""
    first, second, active = (
        add(mesh_body(), name, (5 * i, 0, 0)) for i, name in enumerate(("A", "B", "Ball"))
    )
    for obj, density, material, thickness in (
        (first, 7850.0, "Steel", 0.001),
        (second, 2700.0, "Aluminum", 0.002),
        (active, 1240.0, "PLA", 0.003),
    ):
        obj.body_moments.density, obj.body_moments.material = density, material
        obj.body_moments.kind, obj.body_moments.thickness = "SHELL", thickness
    only(first, second)
    bpy.context.view_layer.objects.active = active
    bpy.context.view_layer.update()
    return first, second, active


def test_mixed_settings_of_selection_are_shown_as_mixed(mixed):
    first, second, active = mixed
    found = labels(shown())
    assert "2 Objects" in found and found.count("Mixed") == 2 and "PLA" not in found
    only(first)
    bpy.context.view_layer.objects.active = active
    bpy.context.view_layer.update()
    found = labels(shown(without=("selection",)))
    assert "A" in found and "Ball" not in found


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("kind", "SOLID"),
        ("wall", "INWARD"),
        ("thickness", 0.004),
        ("overlap", "UNION"),
        ("mass_from", "MASS"),
        ("mass", 3.0),
        ("density_g_cm3", 7.0),
        ("use_center", True),
        ("given_center", (1.0, 2.0, 3.0)),
        ("density_polynomial", "1 + x"),
    ],
)
def test_setting_of_selection_leaves_unselected_active(mixed, name, value):
    *selected, active = mixed
    before = set_of(active)
    setattr(bpy.context.scene.body_moments_selection, name, value)
    for obj in selected:
        own = getattr(obj.body_moments, name)
        if isinstance(value, str):
            assert own == value
        else:
            assert np.allclose(own[:] if isinstance(value, tuple) else own, value, 1e-6)
    assert set_of(active) == before


def test_set_material_changes_selected_objects_alone(mixed):
    *selected, active = mixed
    empty = add(None, "Point", select=False)
    empty.body_moments.mass_from = "MASS"
    empty.select_set(True)
    before = set_of(active)
    assert bpy.ops.object.body_moments_set_material(material="Gold") == {"FINISHED"}
    assert {obj.body_moments.material for obj in selected} == {"Gold"}
    assert set_of(active) == before and empty.body_moments.mass_from == "MASS"
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Select objects"):
        bpy.ops.object.body_moments_set_material(material="PLA")


def test_setting_of_one_object_by_script_leaves_the_others(mixed):
    first, second, _ = mixed
    first.body_moments.thickness = 0.5
    assert second.body_moments.thickness == pytest.approx(0.002)


def test_total_without_some_numbers_is_incomplete(mixed):
    first, second, _ = mixed
    measure(first)
    only(first, second)
    bpy.context.view_layer.update()
    assert {"2 Objects", "Incomplete"} <= {*labels(shown())}
    bpy.ops.object.body_moments_measure()
    assert "Incomplete" not in labels(shown())


def test_colliders_and_bones_are_those_of_the_selection(mixed):
    first, second, active = mixed
    for obj in (first, active):
        only(obj)
        bpy.ops.object.body_moments_make_colliders(shape="BOX")
    active["body_colliders"]["count"] = 7
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.scene.collection.objects.link(rig)
    only(first, rig)
    bpy.context.view_layer.objects.active = active
    bpy.context.view_layer.update()
    found = labels(shown())
    assert "1 Collider" in found and "7 Colliders" not in found
    assert "object.body_moments_measure_bones" in buttons(shown())
    only(first, second)
    bpy.context.view_layer.objects.active = rig
    bpy.context.view_layer.update()
    assert "1 Collider" not in labels(shown())
    found = buttons(shown())
    assert "object.body_moments_make_colliders" in found
    assert "object.body_moments_measure_bones" not in found


def test_density_that_nobody_set_stands_beside_mass(mixed):
    first, second, _ = mixed
    first.body_moments.property_unset("density")
    second.body_moments.kind = first.body_moments.kind = "SOLID"
    measure(first)
    assert "at 1000 kg/m³, not set" in labels(shown())
    measure(first, second)
    assert any("not set: 1 of 2" in label for label in labels(shown()))
    measure(second)
    assert "at 2700 kg/m³" in labels(shown())
    only(first)
    bpy.ops.object.body_moments_clear()
    bpy.ops.object.body_moments_live()
    assert "at 1000 kg/m³, not set" in labels(shown())
    bpy.ops.object.body_moments_live()


def test_presets_are_given_to_the_selection_alone(mixed, tmp_path):
    *selected, active = mixed
    before = set_of(active)
    path = tmp_path / "thin.py"
    path.write_text(
        "import bpy\nsettings = bpy.context.object.body_moments\nsettings.thickness = 0.25\n"
    )
    bpy.ops.object.body_moments_preset_apply(filepath=str(path))
    assert {obj.body_moments.thickness for obj in selected} == {0.25}
    assert set_of(active) == before


def test_copy_left_in_place_is_a_warning_with_select():
    body = add(mesh_body(), "Body")
    linked, other = bpy.data.objects.new("Linked", body.data), add(mesh_body(), "Other", (9, 0, 0))
    bpy.context.scene.collection.objects.link(linked)
    copied = add(body.data.copy(), "Copied")
    measure(body, linked, copied, other)
    assert "Copies at an equal place count again" in " ".join(labels(shown()))
    bpy.ops.object.body_moments_select_refused(code="total_copies_in_place")
    assert sorted(obj.name for obj in bpy.context.selected_objects) == ["Copied", "Linked"]
    only(body)  # an assembly's line names its objects itself
    bpy.ops.object.body_moments_select_refused(code="any", listed="Copied\nLinked")
    assert sorted(obj.name for obj in bpy.context.selected_objects) == ["Copied", "Linked"]
    copied.location.x = linked.location.x = 4.0
    linked.location.y = 5.0
    only(body, linked, copied, other)
    bpy.context.view_layer.update()
    assert "Copies at an equal place" not in " ".join(labels(shown()))


def test_overlap_is_a_note_until_an_object_moves():
    first, second = add(mesh_body(), "First"), add(mesh_body(), "Second", (0.5, 0.1, 0.2))
    measure(first, second)
    assert "share" in " ".join(labels(shown())) and "Notes (2)" in labels(shown())
    second.location.x = 9.0
    bpy.context.view_layer.update()
    assert "Notes (1)" in labels(shown())
