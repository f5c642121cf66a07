# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates during animation, undo and removal are counted for the right objects."""

import bpy
import pytest
from body_moments.blender.session.tracking import handlers

from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")


def removed(obj):
    bpy.data.objects.remove(obj)


def hidden(obj):
    obj.hide_set(True)


@pytest.mark.parametrize("change", [removed, hidden])
def test_objects_that_come_and_go_between_moves_are_told_apart(change, monkeypatch):
    """The memory of evaluated objects that are gone may be that of others."""
    moved = []
    monkeypatch.setattr(handlers, "on_update", [lambda events: moved.append({*events.moved})])
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
        assert moved[-1] == {obj.session_uid for obj in kept}
        for obj in kept[:5]:
            obj.location.y += 1.0
        bpy.context.view_layer.update()
        assert moved[-1] == {obj.session_uid for obj in kept[:5]}
