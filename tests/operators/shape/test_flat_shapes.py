# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Match Pose, Find Similar and Find Symmetry on letters and other flat objects."""

import math

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat_shape import flat_shape_of
from body_moments.blender.session.tracking import staleness
from body_moments.blender.session.tracking.stamps import Kind, Stale

from tests.blender.findings import refused
from tests.blender.flat_objects import MONOSPACED, converted, regular, sheet, text
from tests.blender.objects import add, mesh_body, only, place

pytestmark = pytest.mark.usefixtures("scene")


def run(operator, **options):
    return getattr(bpy.ops.object, "body_moments_" + operator)(**options)


def found():
    return {
        row.name: (row.verdict, row.scale) for row in bpy.context.scene.body_moments_search.found
    }


@pytest.mark.parametrize("body", ["R", "S", "8", "g"])
def test_letters_are_found_again_in_another_size_place_and_turn(body):
    wanted = text(body, "Wanted", location=(1, 2, 3), rotation=(0.3, 0.4, 0.5))
    text(body, "Copy", resolution=3, location=(-50, 2, 1), rotation=(2.0, 1.0, -0.4))
    text(body, "Large", location=(5, 2, 1), rotation=(0, 0, 2.5), scale=(7, 7, 7))
    text("k", "Other")
    only(wanted)
    assert run("find_similar") == {"FINISHED"}
    rows = found()
    assert (
        rows["Copy"][0] == "copy"
        and rows["Large"][0] == "scaled_copy"
        and rows["Other"][0] == "different"
    )
    assert abs(rows["Large"][1] - 7.0) < 1e-4
    assert bpy.data.objects["Copy"].select_get() and not bpy.data.objects["Large"].select_get()


def test_mirror_images_are_told_apart_as_seen_from_the_front():
    wanted = text("R", "Wanted")
    # its front looks down, and shows an R
    text("R", "Turned over", rotation=(math.pi, 0, 0), location=(3, 0, 0))
    text("R", "Mirrored", scale=(-1, 1, 1), location=(6, 0, 0))
    text("R", "Mirrored twice", scale=(-1, -1, 1), location=(9, 0, 0))
    only(wanted)
    assert run("find_similar") == {"FINISHED"}
    rows = {name: verdict for name, (verdict, _) in found().items()}
    assert rows["Turned over"] == rows["Mirrored twice"] == "copy"
    assert rows["Mirrored"] == "mirror"
    text("H", "Own mirror image")
    text("H", "Its image", scale=(-1, 1, 1))
    only(bpy.data.objects["Own mirror image"])
    assert run("find_similar") == {"FINISHED"}
    assert found()["Its image"][0] == "copy"


def test_flipped_faces_show_the_mirror_image():
    wanted = converted(text("R"), "Wanted")
    bpy.data.objects.remove(bpy.data.objects["Text"])
    backward = converted(wanted, "Backward")
    backward.data.flip_normals()
    copy = converted(wanted, "Copy")
    copy.location = (4, 5, 6)
    only(wanted)
    assert run("find_similar") == {"FINISHED"}
    rows = {name: verdict for name, (verdict, _) in found().items()}
    assert rows == {"Copy": "copy", "Backward": "mirror"}


def test_flat_shape_matches_sheet_and_no_body():
    wanted = text("R", "Wanted")
    add(mesh_body("Body"), "Body")
    plate = text("R", "Plate", rotation=(1, 0, 0))
    plate.body_moments.kind = "SHELL"
    only(wanted)
    assert run("find_similar") == {"FINISHED"}
    rows = {name: verdict for name, (verdict, _) in found().items()}
    assert rows == {"Body": "different", "Plate": "copy"}
    only(bpy.data.objects["Body"])
    assert run("find_similar") == {"FINISHED"}
    assert {verdict for verdict, _ in found().values()} == {"different"}


@pytest.mark.parametrize(
    "make, group",
    [
        (lambda: text("R"), "C1"),
        (lambda: text("S"), None),
        (lambda: sheet(regular(3)), "C3v"),
        (lambda: sheet(regular(5, 1e-3), location=(5, 6, 7), rotation=(1, 2, 3)), "C5v"),
        (lambda: sheet(regular(40)), "C40v"),
        (
            lambda: sheet(
                [(0, 0), (3, 0), (3, 1), (0, 1)], rotation=(0.4, 0.3, 0.2), scale=(2, 1, 1)
            ),
            "C2v",
        ),
        (lambda: sheet([(0, 0), (3, 0), (4, 1), (1, 1)]), "C2"),
        (lambda: sheet([(0, 0), (4, 0), (3, 1), (1, 1)]), "Cs"),
        (lambda: sheet([(0, 0), (3, 0), (0, 1)]), "C1"),
    ],
)
def test_flat_symmetry_group_and_elements_are_found(make, group):
    obj = make()
    only(obj)
    assert run("find_symmetry") == {"FINISHED"}
    stored = obj.body_moments_symmetry
    assert group is None or stored.group == group
    for element in stored.elements:
        along = abs(element.direction[2])
        assert abs(along - (element.kind != "PLANE")) < 1e-5


def test_the_symmetry_of_a_changed_text_is_out_of_date():
    obj = text("H")
    only(obj)
    run("find_symmetry")
    assert obj.body_moments_symmetry.group == "C2v"
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) is None
    obj.data.body = "R"
    bpy.context.view_layer.update()
    assert staleness.stale_reason(obj, bpy.context.scene, Kind.SYMMETRY) == Stale.GEOMETRY


@pytest.mark.parametrize("body", ["R", "Q", "4"])
def test_a_letter_comes_to_lie_on_another_one_front_on_front(body):
    target = text(
        body, "Target", font_name=MONOSPACED, location=(1, 2, 3), rotation=(0.3, 0.4, 0.5)
    )
    copy = text(
        body,
        "Copy",
        font_name=MONOSPACED,
        resolution=5,
        location=(-7, 2, 1),
        rotation=(2.0, 1.0, -0.4),
    )
    was = place(target)
    only(target, copy)
    assert run("match_pose") == {"FINISHED"}
    assert (place(target) == was).all()
    assert np.abs(place(copy) - place(target)).max() < 2e-6


@pytest.mark.filterwarnings("error")
def test_overflowing_or_distant_flat_shape_is_refused():
    obj = sheet(regular(5))
    for change, code in (
        ({"scale": (1e36, 1e36, 1.0)}, "moments_overflow"),
        ({"location": (1e12, 0, 0)}, "shape_unavailable"),
    ):
        obj.scale, obj.location = (1, 1, 1), (0, 0, 0)
        for name, value in change.items():
            setattr(obj, name, value)
        bpy.context.view_layer.update()
        with refused(code, obj.name):
            flat_shape_of(obj, bpy.context.evaluated_depsgraph_get())
