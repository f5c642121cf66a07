# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: the setting, what is found, and the thickness as a slider."""

import math

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.session.stored import sliders
from body_moments.blender.session.tracking import staleness, stamps
from body_moments.blender.settings.options import MeasureOptions
from body_moments.blender.write import properties
from body_moments.core.verdict import MeasureError

from tests.blender.batch_files import document
from tests.blender.findings import refused, said
from tests.blender.objects import add, measured, mesh_body, only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def box(size=(1.0, 1.0, 1.0), wall="INWARD", thickness=0.125, **more):
    x, y, z = size
    obj = add(mesh_body("Box", ((0, 0, 0), (x, 0, 0), (x, y, 0), (0, y, 0)), z), "Box", **more)
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", wall, thickness
    return obj


def shell_volume(size, low, high):
    return np.prod(np.add(size, 2 * high)) - np.prod(np.subtract(size, 2 * low))


def test_a_cube_is_the_cube_less_the_cube_inside():
    obj = box()
    found = measured(obj)
    assert str(found.method) == "shell" and found.kind == "shell" and found.thickness == 0.125
    assert abs(found.volume - (1 - 0.75**3)) < 1e-14
    assert abs(found.mass_properties.mass - 1000 * (1 - 0.75**3)) < 1e-11
    inertia = 1000 * (1 - 0.75**5) / 6
    assert np.abs(found.mass_properties.inertia - inertia * np.eye(3)).max() < 1e-10
    assert np.abs(found.mass_properties.center - 0.5).max() < 1e-14
    assert found.area == 6.0
    assert said(found) == {"wall_measured": {"thickness": 0.125, "side": "inward"}}
    assert 0.0 < found.error_bound["volume"] < 1e-12


@pytest.mark.parametrize(
    ("wall", "low", "high"), [("INWARD", 0.1, 0.0), ("OUTWARD", 0.0, 0.1), ("CENTERED", 0.05, 0.05)]
)
@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_thickness_is_a_length_in_the_world_whatever_the_scale(wall, low, high, mirror):
    obj = box(
        wall=wall,
        thickness=0.1,
        location=(30, -20, 10),
        rotation=(0.3, 0.5, 0.7),
        scale=(2 * mirror, 3, 4),
    )
    found = measured(obj)
    assert abs(found.volume / shell_volume((2, 3, 4), low, high) - 1.0) < 1e-6


def test_sheared_object_has_wall_along_its_world_normals():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (1, 1, 3)
    obj = box(thickness=0.0625)
    obj.parent, obj.rotation_euler = parent, (0.6, 0.0, 0.0)
    bpy.context.view_layer.update()
    found = measured(obj)
    a, b, c = np.array(obj.matrix_world, float)[:3, :3].T
    volume, t = abs(np.linalg.det([a, b, c])), 0.0625
    heights = [volume / np.linalg.norm(np.cross(u, v)) for u, v in ((b, c), (c, a), (a, b))]
    truth = volume * (1 - np.prod([1 - 2 * t / height for height in heights]))
    assert abs(found.volume / truth - 1.0) < 1e-6


def test_folding_wall_is_refused_with_largest_thickness():
    obj = box((1, 2, 0.5), thickness=0.3)
    with pytest.raises(MeasureError) as refusal:
        measured(obj)
    values = refusal.value.finding.values
    assert refusal.value.finding.code == "wall_folds" and 0.249 < values["largest"] < 0.25
    assert values["thickness"] == pytest.approx(0.3) and len(values["point"]) == 3
    found = measure_object(
        obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(thickness=values["largest"])
    )
    assert 0.99 < found.volume < 1.0


def test_a_flipped_face_is_turned_before_and_said():
    obj = box()
    obj.data.polygons[0].flip()
    obj.data.update()
    found = measured(obj)
    assert abs(found.volume - (1 - 0.75**3)) < 1e-14
    assert "flipped_faces" in said(found)


def test_open_surface_of_opposed_faces_is_refused():
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)],
        [],
        [(0, 1, 2, 3), (1, 2, 5, 4)],
    )
    obj = add(mesh)
    obj.body_moments.kind, obj.body_moments.wall = "SHELL", "INWARD"
    with refused("wall_without_sides", count=1):
        measured(obj)


def test_instances_have_walls_of_one_thickness():
    part = box(thickness=0.125)
    collection = bpy.data.collections.new("Parts")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.scene.collection.objects.unlink(part)
    collection.objects.link(part)
    holder = add(None, "Holder", location=(5, 0, 0), scale=(2, 2, 2))
    holder.instance_type, holder.instance_collection = "COLLECTION", collection
    settings = holder.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "INWARD", 0.125
    found = measured(holder)
    assert abs(found.volume - shell_volume((2, 2, 2), 0.125, 0)) < 1e-13
    assert np.abs(found.mass_properties.center - (6, 1, 1)).max() < 1e-13


def test_instances_turned_every_way_share_one_wall():
    part = box((1.0, 2.0, 0.5), thickness=0.125)
    collection = bpy.data.collections.new("Parts")
    collection.objects.link(part)
    holder = add(None, "Holder")
    inner = bpy.data.collections.new("All")
    for k in range(5):
        one = bpy.data.objects.new("Place", None)
        one.instance_type, one.instance_collection = "COLLECTION", collection
        one.location, one.rotation_euler, one.scale = (
            (5 * k, 0, 0),
            (k, 2 * k, 3),
            (1 + k % 2, 1 + k % 2, 1 + k % 2),
        )
        inner.objects.link(one)
    holder.instance_type, holder.instance_collection = "COLLECTION", inner
    bpy.context.view_layer.update()
    settings = holder.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "OUTWARD", 0.125
    truth = 3 * shell_volume((1, 2, 0.5), 0, 0.125) + 2 * shell_volume((2, 4, 1), 0, 0.125)
    assert measured(holder).volume == pytest.approx(truth, rel=1e-6)


def test_command_line_uses_wall_and_given_thickness():
    box()
    found = document("--thickness", "0.25", "--order", "2")["objects"][0]
    assert close(found["volume"], 1 - 0.5**3, rel=1e-13)
    assert found["method"] == "shell" and found["thickness"] == 0.25
    assert close(found["moments"]["volume"]["0,0,0"], 1 - 0.5**3, rel=1e-13)
    assert "wall_measured" in [entry["code"] for entry in found["findings"]]
    surface = document("--surface-moments", "--order", "2")["objects"][0]
    assert close(surface["moments"]["surface"]["0,0,0"], 6.0, rel=1e-13)


# The slider


def press(obj):
    only(obj)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


def test_thickness_slider_stores_measured_results():
    obj = box(location=(3, 4, 5), rotation=(0.1, 0.2, 0.3), scale=(1, 2, 3))
    press(obj)
    for thickness in (0.0625, 0.2, 0.3125):
        obj.body_moments.thickness = thickness
        kept = properties.stored(obj)
        assert staleness.stale_reason(obj, bpy.context.scene) is None
        bpy.context.view_layer.update()
        assert staleness.stale_reason(obj, bpy.context.scene) is None
        press(obj)
        for name in ("mass", "volume", "area", "center", "inertia", "moments"):
            one, other = (
                np.array(getattr(numbers, name)) for numbers in (kept, properties.stored(obj))
            )
            assert np.abs(one - other).max() <= 1e-13 * max(1.0, np.abs(other).max())


def test_another_side_is_stored_at_once_too():
    obj = box()
    press(obj)
    obj.body_moments.wall = "OUTWARD"
    assert abs(properties.stored(obj).volume - (1.25**3 - 1)) < 1e-13
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    obj.body_moments.wall = "THIN"
    assert staleness.stale_reason(obj, bpy.context.scene) == stamps.Stale.SETTINGS


@pytest.mark.parametrize("change", ["edited", "scaled"])
def test_thickness_slider_keeps_results_after_change(change):
    obj = box()
    press(obj)
    if change == "edited":
        obj.data.vertices[0].co.x -= 1.0
        obj.data.update()
    else:
        obj.scale.z = 1.1
    bpy.context.view_layer.update()
    before = properties.stored(obj)
    obj.body_moments.thickness = 0.2
    assert properties.stored(obj) == before
    assert staleness.stale_reason(obj, bpy.context.scene)


def test_too_thick_slider_keeps_results_and_tells_limit():
    obj = box()
    press(obj)
    before = properties.stored(obj)
    assert sliders.max_thickness(obj) == pytest.approx(0.5) and not sliders.is_too_thick(obj)
    obj.body_moments.thickness = 0.75
    assert properties.stored(obj) == before and sliders.is_too_thick(obj)
    assert staleness.stale_reason(obj, bpy.context.scene) == stamps.Stale.SETTINGS
    obj.body_moments.thickness = 0.25
    assert abs(properties.stored(obj).volume - (1 - 0.5**3)) < 1e-13


def test_after_loading_a_file_the_slider_waits_for_measure(tmp_path):
    obj = box()
    press(obj)
    path = str(tmp_path / "wall.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Box"]
    assert (
        obj.body_moments.wall == "INWARD" and staleness.stale_reason(obj, bpy.context.scene) is None
    )
    obj.body_moments.thickness = 0.2
    assert staleness.stale_reason(obj, bpy.context.scene) == stamps.Stale.SETTINGS
    press(obj)
    assert abs(properties.stored(obj).volume - (1 - 0.6**3)) < 1e-6


@pytest.mark.parametrize("size", [(1.0, 2.0, 0.5), (0.3, 0.3, 4.0)])
def test_box_wall_equals_solidify_modifier(size):
    obj = box(size, thickness=0.0625)
    wall = measured(obj)
    modifier = obj.modifiers.new("Solidify", "SOLIDIFY")
    modifier.thickness, modifier.offset, modifier.use_even_offset = 0.0625, -1.0, True
    bpy.context.view_layer.update()
    solid = measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(kind="solid"))
    assert solid.health.cavities == 1
    assert wall.volume == pytest.approx(solid.volume, rel=1e-5)
    bodies = [one.mass_properties.inertia for one in (wall, solid)]
    assert np.abs(bodies[0] - bodies[1]).max() < 1e-5 * bodies[0].max()


def sheet_of(points, faces, wall="OUTWARD", thickness=0.125):
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(points, [], faces)
    obj = add(mesh, "Sheet")
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", wall, thickness
    return obj


def test_face_without_area_is_counted_in_wall():
    obj = sheet_of(
        [(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], [(0, 2, 3, 4), (0, 1, 2)]
    )
    found = measured(obj)
    assert close(found.volume, 6.0 * 0.125, rel=1e-12)
    assert said(found)["wall_faces_without_area"] == {"count": 1}


@pytest.mark.parametrize("wall", ["INWARD", "OUTWARD", "CENTERED"])
def test_wall_of_varying_density_is_refused(wall):
    obj = box(wall=wall)
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "1000 + x"
    with refused("wall_unsupported", obj.name):
        measured(obj)


@pytest.mark.parametrize("scales", [(1.0, 2.0), (2.0, 1.0)])
def test_first_folding_instance_is_named_with_its_place(scales):
    part = box()
    collection, inner = bpy.data.collections.new("Parts"), bpy.data.collections.new("All")
    collection.objects.link(part)
    for place, scale in enumerate(scales):
        one = bpy.data.objects.new("Place", None)
        one.instance_type, one.instance_collection = "COLLECTION", collection
        one.location.x, one.scale = 10.0 * place, (scale, scale, scale)
        inner.objects.link(one)
    holder = add(None, "Holder")
    holder.instance_type, holder.instance_collection = "COLLECTION", inner
    settings = holder.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "INWARD", 0.75
    with pytest.raises(MeasureError) as refusal:
        measured(holder)
    values = refusal.value.finding.values
    assert refusal.value.finding.code == "wall_folds" and 0.49 < values["largest"] < 0.5
    first = 10.0 * scales.index(1.0)
    assert first - 1e-6 <= values["point"][0] <= first + 1.0 + 1e-6
    assert min(values["point"][1:]) >= 0.0 and max(values["point"][1:]) <= 1.0


def shown_together(part, *places):
    """An empty that shows the part at places: (x, scale)."""
    collection, inner = bpy.data.collections.new("Parts"), bpy.data.collections.new("All")
    bpy.context.scene.collection.objects.unlink(part)
    collection.objects.link(part)
    for x, scale in places:
        one = bpy.data.objects.new("Place", None)
        one.instance_type, one.instance_collection = "COLLECTION", collection
        one.location.x, one.scale = x, (scale, scale, scale)
        inner.objects.link(one)
    holder = add(None, "Holder")
    holder.instance_type, holder.instance_collection = "COLLECTION", inner
    holder.body_moments.kind = "SHELL"
    return holder


@pytest.mark.parametrize(
    ("first", "second", "edge"), [(2.0, 1.0, 2.0), (1.0, 2.0, 1.0), (4.0, 2.0, 4.0)]
)
def test_meeting_walls_of_instances_are_reported(first, second, edge):
    for gap, expected in ((0.27, False), (0.23, True)):
        shown = shown_together(box(), (0.0, first), (edge + gap, second))
        shown.body_moments.wall, shown.body_moments.thickness = "OUTWARD", 0.125
        assert ("unchecked" in said(measured(shown))) == expected


def test_instances_of_nearly_one_size_have_each_its_wall():
    scales = [float(np.float32(scale)) for scale in (1.0, 1.0005)]
    shown = shown_together(box(), (0.0, scales[0]), (5.0, scales[1]))
    shown.body_moments.wall, shown.body_moments.thickness = "INWARD", 0.375
    truth = math.fsum(scale**3 - (scale - 0.75) ** 3 for scale in scales)
    assert close(measured(shown).volume, truth, rel=1e-9)
