# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates during animation, undo and removal are counted for the right objects."""

import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.blender.session.stored import results
from body_moments.blender.session.tracking import handlers, staleness, updates

from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")


def reason(obj):
    return staleness.stale_reason(obj, bpy.context.scene)


def deforming(name, select=False):
    obj = add(mesh_body(), name, select=select)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    key.data[0].co.x -= 1.0
    for frame, value in ((1, 0.0), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    return obj


def measure(*objects):
    bpy.context.scene.frame_set(1)
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert [reason(obj) for obj in objects] == [None] * len(objects)


def test_a_move_that_undo_takes_back_is_an_update_of_the_object():
    obj = add(mesh_body())
    measure(obj)
    bpy.ops.ed.undo_push(message="Measured")
    before = results.in_world(obj, bpy.context.scene).body.center
    obj.location.x += 5.0
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message="Moved")
    assert abs(results.in_world(obj, bpy.context.scene).body.center[0] - before[0] - 5.0) < 1e-5
    bpy.ops.ed.undo()
    bpy.context.view_layer.update()
    obj = bpy.data.objects["Body"]
    assert updates.last_change(obj) == updates.count() and reason(obj) is None
    assert abs(results.in_world(obj, bpy.context.scene).body.center - before).max() < 1e-6


def test_an_object_made_between_frames_is_not_taken_for_another(monkeypatch):
    deformed = deforming("Deformed")
    measure(deformed)
    for frame in range(2, 6):
        bpy.context.scene.frame_set(frame)
        added = deforming("Added", select=False)
        bpy.context.scene.frame_set(frame + 1)
        uids = {obj.session_uid for obj in bpy.data.objects}
        assert {uid for uid in handlers._uids.values() if uid} - uids <= {
            collection.session_uid for collection in (bpy.context.scene.collection, *bpy.data.collections)
        }
        assert updates.last_change_of_geometry(added) == updates.count()
        bpy.data.objects.remove(added)


def removed(obj):
    bpy.data.objects.remove(obj)


def hidden(obj):
    obj.hide_set(True)


@pytest.mark.parametrize("change", [removed, hidden])
def test_objects_that_come_and_go_between_moves_are_told_apart(change):
    """The memory of evaluated objects that are gone may be that of others."""
    bpy.context.scene.frame_set(1)
    for _ in range(6):
        objects = [add(mesh_body(), str(i), select=False) for i in range(20)]
        for obj in objects:
            obj.location.x += 1.0
        bpy.context.view_layer.update()
        for obj in objects[::2]:
            change(obj)
        bpy.context.view_layer.update()
        kept = objects[1::2]
        for obj in kept:
            obj.location.y += 1.0
        bpy.context.view_layer.update()
        assert [updates.last_change(obj) for obj in kept] == [updates.count()] * len(kept)
        for obj in kept[:5]:
            obj.location.y += 1.0
        bpy.context.view_layer.update()
        assert [updates.last_change(obj) == updates.count() for obj in kept] == [True] * 5 + [False] * 5
