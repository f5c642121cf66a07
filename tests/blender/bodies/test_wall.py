# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Shells of real thickness: the setting, what is found, and the thickness as a slider."""

import math
from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_body, measure_object
from body_moments.blender.bodies.mesh.mesh import mesh_body as polygon_body
from body_moments.blender.bodies.wall import Walls, find_walls
from body_moments.blender.read.objects import read_object
from body_moments.blender.session.stored import walls as wall_slider
from body_moments.blender.session.tracking import staleness
from body_moments.blender.settings.options import MeasureOptions
from body_moments.blender.write import properties
from body_moments.core.moments.moments import Measure, Moments, monomials
from body_moments.core.verdict.finding import MeasureError

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
    obj = box(wall=wall, thickness=0.1, location=(30, -20, 10), rotation=(0.3, 0.5, 0.7), scale=(2 * mirror, 3, 4))
    found = measured(obj)
    assert abs(found.volume / shell_volume((2, 3, 4), low, high) - 1.0) < 1e-6


def test_a_sheared_object_is_offset_where_it_stands():
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


def test_thickness_follows_the_scenes_unit():
    bpy.context.scene.unit_settings.scale_length = 0.01
    found = measured(box(thickness=0.125))
    assert close(found.thickness, 0.00125, rel=1e-12)
    assert close(found.volume, 1e-6 * (1 - 0.75**3), rel=1e-12)


def test_a_given_mass_is_spread_over_the_material():
    obj = box()
    obj.body_moments.mass_from, obj.body_moments.mass = "MASS", 3.0
    found = measured(obj)
    assert abs(found.mass_properties.mass - 3.0) < 1e-13
    assert abs(found.density - 3.0 / (1 - 0.75**3)) < 1e-12


def test_thin_stays_area_times_thickness():
    found = measured(box(wall="THIN"))
    assert close(found.volume, 0.75, rel=1e-15)
    assert not found.findings


def test_an_open_sheet_is_a_plate():
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata([(0, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], [], [(0, 1, 2, 3)])
    obj = add(mesh)
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "OUTWARD", 0.5
    found = measured(obj)
    assert abs(found.volume - 3.0) < 1e-14
    assert np.abs(found.mass_properties.center - (1.0, 1.5, 0.25)).max() < 1e-14


def test_what_folds_over_is_refused_with_the_largest_that_works():
    obj = box((1, 2, 0.5), thickness=0.3)
    with pytest.raises(MeasureError) as refusal:
        measured(obj)
    values = refusal.value.finding.values
    assert refusal.value.finding.code == "wall_folds" and 0.249 < values["largest"] < 0.25
    assert values["thickness"] == pytest.approx(0.3) and len(values["point"]) == 3
    found = measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(thickness=values["largest"]))
    assert 0.99 < found.volume < 1.0


def test_a_flipped_face_is_turned_before_and_said():
    obj = box()
    obj.data.polygons[0].flip()
    obj.data.update()
    found = measured(obj)
    assert abs(found.volume - (1 - 0.75**3)) < 1e-14
    assert "wall_faces_reversed" in said(found)


def test_an_open_surface_whose_faces_disagree_is_refused():
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)], [], [(0, 1, 2, 3), (1, 2, 5, 4)]
    )
    obj = add(mesh)
    obj.body_moments.kind, obj.body_moments.wall = "SHELL", "INWARD"
    with refused("wall_inconsistent_faces", count=1):
        measured(obj)


def test_a_slit_folds_over_before_its_walls_meet():
    points = ((0, 0, 0), (3, 0, 0), (3, 2, 0), (2, 2, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0))
    obj = add(mesh_body("U", points, 1.0))
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "OUTWARD", 0.25
    assert "walls_overlap" not in said(measured(obj))
    settings.wall, settings.thickness = "INWARD", 0.25
    assert "walls_overlap" not in said(measured(obj))
    points = ((0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 1.2, 0), (4, 1.2, 0), (4, 3, 0), (0, 3, 0))
    slit = add(mesh_body("Slit", points, 1.0), "Slit")
    settings = slit.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "OUTWARD", 0.09
    assert "walls_overlap" not in said(measured(slit))
    settings.thickness = 0.15
    with refused("wall_folds", side="outward"):  # the slit's own end folds first
        measured(slit)


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
        one.location, one.rotation_euler, one.scale = (5 * k, 0, 0), (k, 2 * k, 3), (1 + k % 2, 1 + k % 2, 1 + k % 2)
        inner.objects.link(one)
    holder.instance_type, holder.instance_collection = "COLLECTION", inner
    bpy.context.view_layer.update()
    settings = holder.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "OUTWARD", 0.125
    truth = 3 * shell_volume((1, 2, 0.5), 0, 0.125) + 2 * shell_volume((2, 4, 1), 0, 0.125)
    assert measured(holder).volume == pytest.approx(truth, rel=1e-6)


def test_the_command_line_uses_the_objects_wall_and_its_own_thickness():
    box()
    found = document("--thickness", "0.25", "--order", "2")["objects"][0]
    assert close(found["volume"], 1 - 0.5**3, rel=1e-13)
    assert found["method"] == "shell" and found["thickness"] == 0.25
    assert close(found["moments"]["volume"]["0,0,0"], 1 - 0.5**3, rel=1e-13)
    assert "wall_measured" in [entry["code"] for entry in found["findings"]]
    surface = document("--surface-moments", "--order", "2")["objects"][0]
    assert close(surface["moments"]["surface"]["0,0,0"], 6.0, rel=1e-13)


# The slider


def stored(obj):
    return properties.from_numbers(properties.numbers(obj))


def press(obj):
    only(obj)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


def test_a_new_thickness_is_stored_at_once_and_is_what_measuring_gives():
    obj = box(location=(3, 4, 5), rotation=(0.1, 0.2, 0.3), scale=(1, 2, 3))
    press(obj)
    for thickness in (0.0625, 0.2, 0.3125):
        obj.body_moments.thickness = thickness
        kept = properties.numbers(obj)
        assert staleness.stale_reason(obj, bpy.context.scene) is None
        bpy.context.view_layer.update()
        assert staleness.stale_reason(obj, bpy.context.scene) is None
        press(obj)
        for one, other in zip(kept, properties.numbers(obj)):
            assert np.abs(np.array(one) - other).max() <= 1e-13 * max(1.0, np.abs(other).max())


def test_another_side_is_stored_at_once_too():
    obj = box()
    press(obj)
    obj.body_moments.wall = "OUTWARD"
    assert abs(stored(obj).volume - (1.25**3 - 1)) < 1e-13
    assert staleness.stale_reason(obj, bpy.context.scene) is None
    obj.body_moments.wall = "THIN"
    assert staleness.stale_reason(obj, bpy.context.scene) == "stale_settings"


@pytest.mark.parametrize("change", ["edited", "scaled"])
def test_what_was_changed_since_is_not_stored_as_if_it_were_measured(change):
    obj = box()
    press(obj)
    if change == "edited":
        obj.data.vertices[0].co.x -= 1.0
        obj.data.update()
    else:
        obj.scale.z = 1.1
    bpy.context.view_layer.update()
    before = properties.numbers(obj)
    obj.body_moments.thickness = 0.2
    assert properties.numbers(obj) == before
    assert staleness.stale_reason(obj, bpy.context.scene)


def test_a_thickness_that_folds_leaves_the_numbers_and_says_how_thick_it_may_be():
    obj = box()
    press(obj)
    before = properties.numbers(obj)
    assert wall_slider.max_thickness(obj) == pytest.approx(0.5) and not wall_slider.is_too_thick(obj)
    obj.body_moments.thickness = 0.75
    assert properties.numbers(obj) == before and wall_slider.is_too_thick(obj)
    assert staleness.stale_reason(obj, bpy.context.scene) == "stale_settings"
    obj.body_moments.thickness = 0.25
    assert abs(stored(obj).volume - (1 - 0.5**3)) < 1e-13


def test_after_loading_a_file_the_slider_waits_for_measure(tmp_path):
    obj = box()
    press(obj)
    path = str(tmp_path / "wall.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    obj = bpy.data.objects["Box"]
    assert obj.body_moments.wall == "INWARD" and staleness.stale_reason(obj, bpy.context.scene) is None
    obj.body_moments.thickness = 0.2
    assert staleness.stale_reason(obj, bpy.context.scene) == "stale_settings"
    press(obj)
    assert abs(stored(obj).volume - (1 - 0.6**3)) < 1e-6


def test_an_edit_after_the_slider_is_noticed():
    obj = box()
    press(obj)
    obj.body_moments.thickness = 0.2
    bpy.context.view_layer.update()
    obj.data.vertices[0].co.x -= 1.0
    obj.data.update()
    obj.update_tag(refresh={"DATA"})
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene) == "stale_geometry"


@pytest.mark.parametrize("size", [(1.0, 2.0, 0.5), (0.3, 0.3, 4.0)])
def test_the_wall_of_a_box_is_what_blenders_solidify_makes(size):
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


def test_a_head_with_sharp_folds_has_a_thin_wall():
    bpy.ops.mesh.primitive_monkey_add()
    obj = bpy.context.object
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", "INWARD", 0.01
    found = measured(obj)
    assert 0.5 < found.volume / (0.01 * found.area) < 1.0
    assert said(found)["wall_thickness_varies"]["minimum"] < 0.99
    settings.thickness = 0.1
    with refused("wall_folds"):
        measured(obj)


@pytest.mark.parametrize("size", [0.01, 1.0, 300.0])
@pytest.mark.parametrize("seed", range(4))
def test_how_uneven_a_wall_is_is_the_largest_share_of_a_moment_that_it_misses(seed, size):
    """Of points with weights; the wall has others of them, and is known about another place."""
    rng = np.random.default_rng(seed)
    points = size * rng.normal(size=(6, 3)) * (1.0, 2.0, 0.5) + 20.0 * size
    weights = rng.uniform(1.0, 2.0, 6)
    more = 1e-3 * rng.normal(size=6) * (10.0 if seed % 2 else 1.0)

    def moments(weights, about):
        return Moments(weights @ ((points - about)[:, None] ** monomials(3)).prod(axis=2), about, Measure.AREA)

    area, wall = moments(weights, points[0]), moments(weights + more, points[1])
    walls = Walls(SimpleNamespace(area=area), "inward", (SimpleNamespace(per_thickness=lambda: wall),), ())
    total = math.fsum(weights)
    center = [math.fsum(weights * points[:, axis]) / total for axis in range(3)]
    arms = (points - center).tolist()
    reach = math.sqrt(math.fsum(w * (x * x + y * y + z * z) for w, (x, y, z) in zip(weights, arms)) / total)
    powers = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if i + j + k <= 2]
    shares = [
        abs(math.fsum(w * x**i * y**j * z**k for w, (x, y, z) in zip(more, arms))) / (total * reach ** (i + j + k))
        for i, j, k in powers
    ]
    assert close(walls._unevenness(), max(shares), 1e-8)


def test_just_below_the_largest_thickness_there_is_a_wall_and_from_it_on_none():
    """The comparison rounds as the wall does: what is not refused is measured."""
    walls = find_walls(*body_of(box((1, 2, 0.3), thickness=0.01)), "inward")
    refusals = 0
    for scale in np.random.default_rng(1).uniform(0.1, 10.0, 300):
        scaled = replace(walls, pieces=tuple(replace(piece, scale=scale) for piece in walls.pieces))
        for thickness in (
            np.nextafter(scaled.max_thickness, 0.0),
            scaled.max_thickness,
            np.nextafter(scaled.max_thickness, np.inf),
        ):
            try:
                assert scaled.body(float(thickness), check_overlap=False).wall.total > 0.0
            except MeasureError as error:
                refusals += error.finding.code == "wall_folds"
    assert 300 <= refusals < 900


def body_of(obj):
    bpy.context.view_layer.update()
    reading = read_object(obj, bpy.context.evaluated_depsgraph_get())
    return reading, polygon_body(reading, 1.0, shell=True, union=False, threads=1)


def sheet_of(points, faces, wall="OUTWARD", thickness=0.125):
    mesh = bpy.data.meshes.new("Sheet")
    mesh.from_pydata(points, [], faces)
    obj = add(mesh, "Sheet")
    settings = obj.body_moments
    settings.kind, settings.wall, settings.thickness = "SHELL", wall, thickness
    return obj


def test_faces_that_fold_back_leave_no_room_for_any_wall():
    obj = sheet_of([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 1)])
    for wall in ("INWARD", "OUTWARD", "CENTERED"):
        obj.body_moments.wall = wall
        with pytest.raises(MeasureError) as caught:
            measured(obj)
        found = caught.value.finding
        assert found.code == "wall_faces_fold_back" and caught.value.subject == obj.name
        assert set(found.values) == {"point"} and min(found.values["point"]) >= 0.0 and str(found)
        reading, made = body_of(obj)
        with refused("wall_faces_fold_back_somewhere"):
            find_walls(reading, made, wall.lower()).drop_arrays().body(0.125)


def test_a_face_without_area_goes_with_its_neighbors_and_is_counted():
    obj = sheet_of([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 3, 0), (0, 3, 0)], [(0, 2, 3, 4), (0, 1, 2)])
    found = measured(obj)
    assert close(found.volume, 6.0 * 0.125, rel=1e-12)
    assert said(found)["wall_faces_without_area"] == {"count": 1}


@pytest.mark.parametrize("wall", ["INWARD", "OUTWARD", "CENTERED"])
def test_a_wall_of_a_density_that_varies_is_refused_with_the_remedy(wall):
    obj = box(wall=wall)
    obj.body_moments.density_from, obj.body_moments.density_polynomial = "POLYNOMIAL", "1000 + x"
    with refused("wall_needs_one_density", obj.name):
        measured(obj)


@pytest.mark.parametrize("scales", [(1.0, 2.0), (2.0, 1.0)])
def test_of_several_instances_that_which_folds_first_is_named_with_its_place(scales):
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


@pytest.mark.parametrize(("first", "second", "edge"), [(2.0, 1.0, 2.0), (1.0, 2.0, 1.0), (4.0, 2.0, 4.0)])
def test_walls_of_instances_of_different_size_may_meet_where_both_end(first, second, edge):
    for gap, expected in ((0.27, False), (0.23, True)):
        shown = shown_together(box(), (0.0, first), (edge + gap, second))
        shown.body_moments.wall, shown.body_moments.thickness = "OUTWARD", 0.125
        assert ("instance_walls_unchecked" in said(measured(shown))) == expected


def test_instances_of_nearly_one_size_have_each_its_wall():
    scales = [float(np.float32(scale)) for scale in (1.0, 1.0005)]
    shown = shown_together(box(), (0.0, scales[0]), (5.0, scales[1]))
    shown.body_moments.wall, shown.body_moments.thickness = "INWARD", 0.375
    truth = math.fsum(scale**3 - (scale - 0.75) ** 3 for scale in scales)
    assert close(measured(shown).volume, truth, rel=1e-9)


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_a_wall_has_moments_of_any_order_and_an_area_where_it_is_asked_for(scale):
    obj = box(wall="CENTERED", thickness=0.25 * scale, scale=(scale, scale, scale))
    bpy.context.view_layer.update()
    body = measure_body(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions(order=3)).body
    low, high = 0.375 * scale, 0.625 * scale
    wall, area = body.moments(6, True)
    assert close(wall.total, body.wall.total, rel=1e-12) and close(wall.total, 8 * (high**3 - low**3), rel=1e-12)
    sixth = wall.about_point(np.full(3, 0.5 * scale))[6, 0, 0]
    assert close(sixth, 8.0 * (high**9 - low**9) / 7.0, rel=1e-9)
    assert area.order == 6 and close(area.total, 6.0 * scale**2, rel=1e-14)
    assert body.moments(6, False)[1] is None and body.moments(3, False)[0].order == 3
