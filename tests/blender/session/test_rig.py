# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stored of a character's bones, and when it no longer holds. tests/blender/actions/rig has what users do."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import pytest
from body_moments.core.verdict.finding import finding
from body_moments.operators.read.tracking import tracking_paused
from body_moments.operators.session import handlers, marks, rig, staleness

from tests.blender.actions.rig.test_rig import character, measured
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add

pytestmark = pytest.mark.usefixtures("registered", "scene")


def stored(armature):
    return [bone.name for bone in armature.pose.bones if "body_mass" in bone]


def reason(armature):
    handlers.count_change()
    return rig.stale_reason(armature, bpy.context.scene)


def test_bones_without_a_part_have_no_results_and_those_after_them_have(monkeypatch):
    armature, _ = character()
    whole = measured(armature)
    assert rig.store(whole) == [] and armature["body_mass"] > 0.0
    names = stored(armature)
    assert names == [bone.name for bone in armature.pose.bones] and len(names) > 3
    refusal = finding("no_volume")
    for gone, told in (
        (lambda part: [], []),
        (lambda part: [replace(part, measurement=None, refusal=None)], []),
        (lambda part: [replace(part, measurement=None, refusal=refusal)], [(names[1], refusal)]),
    ):
        for bone in armature.pose.bones[2:]:
            del bone["body_mass"]
        parts = [one for part in whole.parts for one in (gone(part) if part.name == names[1] else [part])]
        generation = handlers.generation()
        assert rig.store(replace(whole, parts=tuple(parts))) == told
        assert stored(armature) == [names[0], *names[2:]] and handlers.generation() > generation
        rig.store(whole)
    assert rig.clear(armature) and stored(armature) == [] and "body_mass" not in armature
    assert not rig.clear(armature)
    rig.store(whole)

    def refuse(_owner):
        raise ZeroDivisionError

    monkeypatch.setattr(rig.properties, "require_storable", refuse)
    with pytest.raises(ZeroDivisionError):
        rig.clear(armature)
    assert stored(armature) == names


def test_why_what_is_stored_of_bones_does_not_hold():
    armature, skin = character()
    assert reason(armature) is None
    armature["body_mass"] = 1.0
    assert reason(armature) == "stale_fingerprint"
    rig.store(measured(armature))
    assert reason(armature) is None
    whole = armature["body_fingerprint"]
    mark = marks.parse(whole)
    for name, text, why in (
        ("version", "of the future", "stale_fingerprint"),
        ("geometry", marks.EDITED, "stale_geometry"),
        ("settings", "others", "stale_rig"),
    ):
        armature["body_fingerprint"] = ":".join(mark._replace(**{name: text}))
        assert reason(armature) == why
        assert staleness.reasons_by_type["ARMATURE"](armature) == why
    del armature["body_mass"]
    armature["body_fingerprint"] = "nothing"
    assert reason(armature) is None
    armature["body_fingerprint"] = whole
    rig._edited[armature] = True
    assert reason(armature) == "stale_geometry"
    rig.store(measured(armature))
    assert rig.stale_reason(armature, bpy.context.scene) is None  # as that counts as a change


def test_an_edit_of_a_skin_is_noted_where_its_armature_was_not_touched():
    armature, skin = character()
    other = add(box_mesh(1, 1, 1), "Other")
    rig.store(measured(armature))
    uid, own = skin.session_uid, armature.session_uid
    assert rig._watched == {uid: armature} and rig._note_updates in handlers.on_update

    def is_noted(**uids):
        rig._edited.forget(armature)
        generation = handlers.generation()
        rig._note_updates(SimpleNamespace(**{"reshaped": [], "moved": [], "others": []} | uids))
        assert (handlers.generation() > generation) == bool(rig._edited.get(armature))
        return bool(rig._edited.get(armature))

    assert is_noted(reshaped=[other.session_uid, uid])
    assert not is_noted(reshaped=[uid, own])
    assert not is_noted(reshaped=[uid], moved=[own])
    assert not is_noted(reshaped=[uid], others=[own])
    assert not is_noted(reshaped=[other.session_uid], moved=[uid], others=[uid])
    with tracking_paused():
        assert not is_noted(reshaped=[uid])
    rig._watched.clear()
    assert not is_noted(reshaped=[uid]) and rig._note_updates not in handlers.on_update


def test_skins_are_watched_again_after_undo_and_notes_are_written_where_a_file_can_hold_them(tmp_path):
    armature, skin = character()
    rig.store(measured(armature))
    before = armature["body_fingerprint"]
    unmeasured, _ = character()
    rig._watched[12345678] = unmeasured
    rig._watch_all()
    assert rig._watched == {skin.session_uid: armature}
    rig._write_notes()
    assert armature["body_fingerprint"] == before
    path = str(tmp_path / "a.blend")
    bpy.data.libraries.write(path, {armature})
    with bpy.data.libraries.load(path, link=True) as (held, wanted):
        wanted.objects = [name for name in held.objects if name == armature.name]
    (linked,) = wanted.objects
    assert not linked.is_editable
    for one in (armature, linked):
        rig._edited[one] = True
    rig._write_notes()
    assert linked["body_fingerprint"] == before
    assert marks.parse(armature["body_fingerprint"]) == marks.parse(before)._replace(geometry=marks.EDITED)
