# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The slider of a grid's threshold in a window: exact numbers come once it rests, of each object still there."""

from types import SimpleNamespace

import bpy
import pytest
from body_moments.operators.session import threshold

from tests.blender.objects import only
from tests.blender.session.test_what_is_remembered import threshold as grid_body

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def timers(monkeypatch):
    """In the place of Blender's, which come in a window alone: what is registered."""
    waiting = []
    made = SimpleNamespace(
        is_registered=lambda function: function in [one for one, _ in waiting],
        register=lambda function, first_interval: waiting.append((function, first_interval)),
        unregister=lambda function: waiting.remove(next(one for one in waiting if one[0] == function)),
    )
    monkeypatch.setattr(threshold, "bpy", SimpleNamespace(app=SimpleNamespace(background=False, timers=made)))
    yield waiting
    threshold._pending.clear()


def two_bodies():
    first = grid_body()
    second = first.copy()
    second.data = first.data.copy()
    bpy.context.scene.collection.objects.link(second)
    bpy.context.view_layer.update()
    only(second)
    bpy.ops.object.body_moments_measure()
    return first, second


def test_exact_numbers_come_once_the_slider_rests(timers):
    first, second = two_bodies()
    before = first["body_volume"]
    for value in (0.5, 0.75):
        first.body_moments.threshold = value
    assert timers == [(threshold._finish, threshold.DELAY)]
    second.body_moments.threshold = 0.75
    assert [obj for obj, _ in threshold._pending] == [first, second] and len(timers) == 1
    threshold._finish()
    assert not threshold._pending and first["body_volume"] == second["body_volume"] < before
    exact = first["body_volume"]
    only(first)
    bpy.ops.object.body_moments_measure()
    assert first["body_volume"] == pytest.approx(exact, rel=1e-12)


def test_an_object_that_is_gone_keeps_no_other_from_its_numbers(timers):
    first, second = two_bodies()
    for obj in (first, second):
        obj.body_moments.threshold = 0.75
    bpy.data.objects.remove(second)
    threshold._finish()
    only(first)
    exact = first["body_volume"]
    bpy.ops.object.body_moments_measure()
    assert first["body_volume"] == pytest.approx(exact, rel=1e-12) and not threshold._pending


def test_nothing_is_due_once_nobody_listens(timers):
    first, _ = two_bodies()
    first.body_moments.threshold = 0.5
    threshold.unregister()
    try:
        assert timers == [] and threshold._pending == []
    finally:
        threshold.register()
