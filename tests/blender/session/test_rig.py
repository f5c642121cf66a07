# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of a skin are noted for its armature. tests/operators/rig has the operators."""

from types import SimpleNamespace

import pytest
from body_moments.blender.read.tracking import tracking_paused
from body_moments.blender.session.stored import rig
from body_moments.blender.session.tracking import handlers

from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add
from tests.operators.rig.test_rig import character, measured

pytestmark = pytest.mark.usefixtures("registered", "scene")


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
