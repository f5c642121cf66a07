# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose, Find Similar and Find Symmetry on objects of a scene."""

import bpy
import numpy as np
import pytest
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale
from body_moments.operators import batch

from tests.blender.objects import add, dent, mesh_body, mesh_of, only, place

pytestmark = pytest.mark.usefixtures("scene")

WEDGE = [(0, 0, 0), (1, 0.2, 0), (0.3, 2, 0.1), (0.2, 0.4, 3)]
SIDES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def wedge(name="Wedge", scale=1.0, mirrored=False, **where):
    sign = -1 if mirrored else 1
    points = [(sign * scale * x, scale * y, scale * z) for x, y, z in WEDGE]
    return add(
        mesh_of(points, [face[::-1] if mirrored else face for face in SIDES], name), name, **where
    )


def cut(obj):
    """The same shape with other faces and vertices."""
    modifier = obj.modifiers.new("Cut", "SUBSURF")
    modifier.subdivision_type, modifier.levels = "SIMPLE", 2
    bpy.context.view_layer.update()


def run(operator, **options):
    return getattr(bpy.ops.object, "body_moments_" + operator)(**options)


def refused(operator, **options):
    with pytest.raises(RuntimeError) as error:
        run(operator, **options)
    return str(error.value)


def test_copy_of_other_faces_is_laid_on_active_object():
    target = wedge("Target", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    copy = wedge("Copy", location=(-7, 2, 1), rotation=(2.0, 1.0, -0.4))
    cut(copy)
    was = place(target)
    only(target, copy)
    assert run("match_pose") == {"FINISHED"}
    assert (place(target) == was).all()
    assert np.abs(place(copy) - place(target)).max() < 2e-6


def test_mirror_image_stays_in_place(reported):
    target = wedge("Target")
    image = wedge("Image", mirrored=True, location=(5, 0, 0))
    was = place(image)
    only(target, image)
    assert run("match_pose") == {"CANCELLED"}
    assert (place(image) == was).all()
    assert "mirror_image" in reported.codes


def test_a_symmetric_object_takes_the_nearest_of_its_poses():
    bpy.ops.mesh.primitive_cube_add(location=(1, 2, 3), rotation=(0.2, 0.1, 0.3))
    target = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(location=(-4, 0, 0), rotation=(0.25, 0.1, 0.3))
    copy = bpy.context.object
    before = place(copy)
    only(target, copy)
    assert run("match_pose") == {"FINISHED"}
    # it turned by a little, not by a quarter
    assert np.trace(before[:3, :3].T @ place(copy)[:3, :3]) > 2.99
    assert np.abs(place(copy) - place(target)).max() < 1e-5


def test_round_objects_turn_no_more_than_they_must():
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=64, depth=3, location=(1, 2, 3), rotation=(0.5, 0.1, 0.3)
    )
    target = bpy.context.object
    bpy.ops.mesh.primitive_cylinder_add(
        vertices=64, depth=3, location=(5, 2, 3), rotation=(0.5, 0.1, 0.3)
    )
    copy = bpy.context.object
    before = place(copy)
    only(target, copy)
    assert run("match_pose") == {"FINISHED"}
    assert np.abs(place(copy)[:3, :3] - before[:3, :3]).max() < 1e-5
    assert np.allclose(place(copy)[:3, 3], (1, 2, 3), atol=1e-5)


def test_one_undo_takes_a_match_back():
    target, copy = wedge("Target"), wedge("Copy", location=(3, 2, 1), rotation=(1, 2, 3))
    only(target, copy)
    before = place(copy)
    bpy.ops.ed.undo_push()
    run("match_pose")
    bpy.ops.ed.undo_push()
    assert np.abs(place(bpy.data.objects["Copy"]) - before).max() > 0.1
    bpy.ops.ed.undo()
    assert np.abs(place(bpy.data.objects["Copy"]) - before).max() < 1e-6


def test_a_parent_is_not_laid_onto_its_child(reported):
    parent, child = wedge("Parent"), wedge("Child", location=(3, 2, 1))
    child.parent = parent
    only(child, parent)
    assert run("match_pose") == {"CANCELLED"}
    assert "follows_moved" in reported.codes


@pytest.mark.parametrize("operator", ["find_symmetry", "find_similar"])
def test_shape_far_from_origin_is_refused(operator, reported):
    far, near = wedge("Far", location=(1e20, 0, 0)), wedge("Near", location=(1e7, 0, 0))
    only(far, near)
    if operator == "find_similar":
        refused(operator)
        only(near)
        assert run(operator) == {"FINISHED"}
    else:
        assert run(operator) == {"FINISHED"} and not far.is_property_set("body_moments_symmetry")
    assert reported.codes.count("shape_unavailable") == (2 if operator == "find_similar" else 1)


@pytest.mark.parametrize("held", [0, 1, 2])
def test_constrained_object_leaves_others_to_be_matched(held, reported):
    target, *others = (wedge(name, location=(9 * place, 1, 2)) for place, name in enumerate("abcd"))
    limit = others[held].constraints.new("LIMIT_LOCATION")
    limit.use_min_x, limit.min_x = True, 5.0
    only(target, *others)
    bpy.context.view_layer.update()
    assert run("match_pose") == {"FINISHED"} and "2 objects" in reported.texts[0]
    apart = [np.abs(place(other) - place(target)).max() for other in others]
    assert [distance > 1.0 for distance in apart] == [number == held for number in range(3)]


def scene_of_shapes():
    wanted = wedge("Wanted", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    copy = wedge("Copy", location=(-7, 2, 1), rotation=(2.0, 1.0, -0.4))
    cut(copy)
    wedge("Image", mirrored=True, location=(5, 0, 0))
    wedge("Big", scale=2.0, location=(0, 9, 0))
    add(mesh_body(), "Other", location=(5, 5, 5))
    only(wanted)
    return wanted


def found():
    return {row.name: row.verdict for row in bpy.context.scene.body_moments_search.found}


def selected():
    return {obj.name for obj in bpy.context.selected_objects}


def test_similar_objects_are_found_listed_and_selected():
    scene_of_shapes()
    assert run("find_similar") == {"FINISHED"}
    rows = found()
    assert rows == {"Copy": "copy", "Image": "mirror", "Big": "scaled_copy", "Other": rows["Other"]}
    assert rows["Other"] in ("similar", "different")
    assert next(iter(rows)) == "Copy" and bpy.context.scene.body_moments_search.wanted == "Wanted"
    assert selected() == {"Wanted", "Copy"}


@pytest.mark.parametrize(
    "options, more",
    [
        ({"mirrored": True}, {"Image"}),
        ({"scaled": True}, {"Big"}),
        ({"mirrored": True, "scaled": True}, {"Image", "Big", "Big Image"}),
    ],
)
def test_search_selects_mirror_images_and_sizes_on_request(options, more):
    wedge("Big Image", scale=2.0, mirrored=True, location=(0, -9, 0))
    scene_of_shapes()
    run("find_similar", **options)
    assert selected() == {"Wanted", "Copy"} | more


def test_a_library_measured_in_batch_is_searched(tmp_path, reported):
    scene_of_shapes()
    path = tmp_path / "library.jsonl"
    with open(tmp_path / "sink", "wb") as sink:
        assert (
            batch.main(
                ["measure", "--signature", "--format", "jsonl", "--output", str(path)],
                channel=sink.fileno(),
            )
            == 0
        )
    for name in ("Copy", "Image", "Big", "Other"):
        bpy.data.objects.remove(bpy.data.objects[name])
    assert run("find_in_library", filepath=str(path)) == {"FINISHED"}
    rows = found()
    assert rows["Copy"] == "copy" and rows["Image"] == "mirror" and rows["Big"] == "scaled_copy"
    assert bpy.context.scene.body_moments_search.looked_at == "library.jsonl"
    refused("find_in_library", filepath=str(tmp_path / "none.jsonl"))
    assert "cannot be read" in reported.texts[-1] and not reported.codes
    bpy.context.object.data = bpy.data.meshes.new("Nothing")
    refused("find_in_library", filepath=str(path))
    assert reported.codes and found() == rows


def test_search_results_survive_saving_and_loading(tmp_path):
    scene_of_shapes()
    run("find_similar")
    run("find_symmetry")
    before = found()
    path = str(tmp_path / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert found() == before
    assert bpy.data.objects["Copy"].body_moments_symmetry.group == "C1"
    assert run("select_found", name="Image") == {"FINISHED"}
    assert bpy.context.object.name == "Image" and selected() == {"Image"}
    refused("select_found", name="Nobody")


@pytest.mark.parametrize(
    "make, group",
    [
        (lambda: bpy.ops.mesh.primitive_cube_add(), "Oh"),
        (lambda: bpy.ops.mesh.primitive_cylinder_add(vertices=12), "D12h"),
        (lambda: bpy.ops.mesh.primitive_cylinder_add(vertices=256), "D∞h"),
        (lambda: bpy.ops.mesh.primitive_cone_add(vertices=5), "C5v"),
        (lambda: bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2), "Ih"),
        (lambda: bpy.ops.mesh.primitive_torus_add(major_segments=48, minor_segments=12), "D48h"),
        (lambda: bpy.ops.mesh.primitive_monkey_add(), "Cs"),
    ],
)
def test_symmetry_group_of_blender_primitives_is_found(make, group):
    make()
    obj = bpy.context.object
    obj.location, obj.rotation_euler = (1, 2, 3), (0.3, 0.4, 0.5)
    if group == "Cs":
        obj.body_moments.kind = "SHELL"  # the monkey's eyes are open
    bpy.context.view_layer.update()
    assert run("find_symmetry") == {"FINISHED"}
    assert obj.body_moments_symmetry.group == group


def test_symmetry_is_stale_after_edit_not_after_motion():
    obj = wedge()
    run("measure")
    run("find_symmetry")
    scene = bpy.context.scene
    assert (
        staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
        and staleness.stale_reason(obj, scene) is None
    )
    obj.location.x, obj.rotation_euler.y, obj.scale = 3.0, 1.0, (2, 2, 2)
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
    obj.scale.x = 1.5
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) == Stale.SCALE
    dent(obj, 0.5)
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY
    assert obj.body_moments_symmetry.group == "C1"
