# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A frame of an animation costs the session nothing but writing down what was updated, and nothing of it is lost."""

import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.operators.read import fingerprint
from body_moments.operators.session import handlers, results, staleness, updates

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


def moving(name):
    obj = add(mesh_body(), name, select=False)
    for frame, place in ((1, 0.0), (11, 10.0)):
        obj.location.x = place
        obj.keyframe_insert("location", frame=frame)
    return obj


def measure(*objects):
    bpy.context.scene.frame_set(1)
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    bpy.context.view_layer.update()
    assert [reason(obj) for obj in objects] == [None] * len(objects)


def test_frames_compare_nothing_and_what_they_changed_is_known_afterwards(monkeypatch):
    deformed, moved, still = deforming("Deformed"), moving("Moved"), add(mesh_body(), "Still")
    measure(deformed, moved, still)
    with monkeypatch.context() as patch:
        for name in ("shape_digest", "settings_hash", "has_transform"):
            patch.setattr(staleness, name, lambda *_args: pytest.fail("A frame compared something."))
        for frame in range(2, 8):
            bpy.context.scene.frame_set(frame)
    assert [reason(obj) for obj in (deformed, moved, still)] == ["stale_geometry", None, None]
    bpy.context.scene.frame_set(1)
    assert [reason(obj) for obj in (deformed, moved, still)] == [None, None, None]


def test_a_setting_that_is_changed_with_the_frame_hides_no_edit(monkeypatch):
    monkeypatch.setattr(fingerprint, "MAX_DIGESTED_FACES", 0)
    deformed = deforming("Deformed")
    measure(deformed)
    for overlap, frame in (("UNION", 5), ("SIGNED", 6)):
        deformed.body_moments.overlap = overlap
        bpy.context.scene.frame_set(frame)
    assert reason(deformed) == "stale_geometry"


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


def test_undo_brings_back_the_shape_of_what_is_sculpted_or_edited_and_settings_of_all_else():
    obj = add(mesh_body())
    for mode in ("OBJECT", "SCULPT", "EDIT", "WEIGHT_PAINT"):
        bpy.ops.object.mode_set(mode=mode)
        bpy.context.view_layer.update()
        before = updates.last_edit(obj)
        handlers._on_undo()
        obj.data.update_tag()
        bpy.context.view_layer.update()
        is_edit = updates.last_edit(obj) != before
        assert is_edit == (mode in ("SCULPT", "EDIT")), mode
        assert (updates.last_edit(obj) if is_edit else updates.last_return(obj)).number == updates.count()
    bpy.ops.object.mode_set(mode="OBJECT")


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


def test_the_graph_of_an_update_is_that_of_its_scene_and_layer_while_they_are_there():
    scene, other = bpy.context.scene, bpy.data.scenes.new("Other")
    layer = scene.view_layers.new("Second")
    stamps = [
        updates.Stamp(1, uid, name)
        for uid, name in (
            (scene.session_uid, scene.view_layers[0].name),
            (scene.session_uid, "Second"),
            (other.session_uid, other.view_layers[0].name),
        )
    ]
    graphs = [one.depsgraph for one in (scene.view_layers[0], layer, other.view_layers[0])]
    assert [updates.depsgraph_of(stamp) for stamp in stamps] == graphs and graphs[0] is not None
    scene.view_layers.remove(layer)
    bpy.data.scenes.remove(other)
    assert [updates.depsgraph_of(stamp) for stamp in (*stamps, updates.NEVER)] == [graphs[0], None, None, None]


def test_an_object_that_shows_others_has_their_updates_and_no_older_ones():
    """Instances by a collection, by particles as an object and a collection; a density's volume but not its place."""
    shown, other = add(mesh_body(), "Shown", select=False), add(mesh_body(), "Other", select=False)
    collection = bpy.data.collections.new("Instanced")
    collection.objects.link(other)
    emitter, instancer = add(mesh_body(), "Emitter", select=False), add(None, "Instancer", select=False)
    settings = emitter.modifiers.new("Particles", "PARTICLE_SYSTEM").particle_system.settings
    settings.instance_object = shown
    assert list(updates.shown_by(emitter)) == [shown]
    settings.instance_object, settings.instance_collection = None, collection
    assert list(updates.shown_by(emitter)) == [collection]
    assert list(updates.shown_by(instancer)) == []
    instancer.instance_type = "COLLECTION"
    assert list(updates.shown_by(instancer)) == []
    instancer.instance_collection = collection
    assert list(updates.shown_by(instancer)) == [collection]
    bpy.context.view_layer.update()
    bpy.context.view_layer.update()
    before = updates.count()
    other.location.x += 1.0
    bpy.context.view_layer.update()
    assert updates.last_edit(instancer).number == updates.count() > before
    assert updates.last_edit(instancer, before).number == updates.count()
    assert updates.last_edit(instancer, updates.count()) == updates.NEVER
    assert updates.last_edit(shown, before) == updates.NEVER

    volume = add(bpy.data.volumes.new("Volume"), "Volume", select=False)
    shown.body_moments.density_volume = volume
    bpy.context.view_layer.update()
    assert updates.density_source(shown) is None
    shown.body_moments.density_from = "VOLUME"
    assert updates.density_source(shown) == volume
    bpy.context.view_layer.update()
    for change, is_edit in ((lambda: setattr(volume, "location", (1, 2, 3)), False), (volume.data.update_tag, True)):
        before = updates.count()
        change()
        bpy.context.view_layer.update()
        assert updates.count() > before
        assert updates.last_edit(shown, before) == (updates.last_edit(volume) if is_edit else updates.NEVER)
