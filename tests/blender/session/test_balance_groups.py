# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The keys of an empty that shows a balance group: what is written beside others, and which of them are a path."""

import bpy
import numpy as np
import pytest
from body_moments.operators.session import balance_groups, handlers

from tests.blender.objects import add
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

FRAMES = np.array([1.0, 2.0, 4.0])
CENTERS = np.array([[1.0, 2.0, 3.0], [4.0, -5.0, 6.5], [0.25, 0.0, -1.0]])
SIGNAL = '["{:s}"]'.format(balance_groups.INSIDE)


def path_of(inside=(True, False, True), shift=0.0):
    return balance_groups.Path(FRAMES + shift, CENTERS + shift, None if inside is None else np.array(inside))


def curves_of(empty):
    """{(path, axis): curve} of what moves it."""
    animation = empty.animation_data
    bag = animation.action.layers[0].strips[0].channelbag(animation.action_slot)
    return {(curve.data_path, curve.array_index): curve for curve in bag.fcurves}


def new_path(empty):
    handlers.count_change()
    return balance_groups.path(empty)


@pytest.fixture
def empty():
    made = add(None, "Empty")
    balance_groups.store(made, path_of(), [None, "second", None])
    return made


def assert_found(empty, wanted):
    found = new_path(empty)
    assert found.frames.tolist() == wanted.frames.tolist() and found.centers.tolist() == wanted.centers.tolist()
    assert (found.inside is None) == (wanted.inside is None)
    assert found.inside is None or found.inside.tolist() == wanted.inside.tolist()


def test_a_path_is_kept_as_keys_and_its_support_polygons_in_memory(empty):
    assert_found(empty, path_of())
    assert [balance_groups.support(empty, frame) for frame in (1, 2, 3, 4)] == [None, "second", None, None]
    assert balance_groups.support(add(None, "Other"), 2) is None
    curves = curves_of(empty)
    assert set(curves) == {("location", 0), ("location", 1), ("location", 2), (SIGNAL, 0)}
    kinds = {key: {point.interpolation for point in curve.keyframe_points} for key, curve in curves.items()}
    assert kinds.pop((SIGNAL, 0)) == {"CONSTANT"} and set(map(tuple, kinds.values())) == {("LINEAR",)}
    ui = empty.id_properties_ui(balance_groups.INSIDE).as_dict()
    assert (ui["min"], ui["max"]) == (0, 1) and "support polygon" in ui["description"]
    bpy.context.scene.frame_set(3)
    assert close(np.array(empty.location), [2.125, -2.5, 2.75], 1e-6) and empty[balance_groups.INSIDE] == 0
    bpy.context.scene.frame_set(4)
    assert empty[balance_groups.INSIDE] == 1


def test_a_new_path_takes_the_place_of_the_last_and_leaves_other_keys(empty):
    action = empty.animation_data.action
    empty.rotation_euler.z = 0.5
    empty.keyframe_insert("rotation_euler", index=2, frame=1)
    known, generation = balance_groups.path(empty), handlers.generation()
    assert balance_groups.path(empty) is known
    balance_groups.store(empty, path_of(None, 2.0), [None] * 3)
    assert handlers.generation() > generation and balance_groups.path(empty) is not known
    assert_found(empty, path_of(None, 2.0))
    assert balance_groups.INSIDE not in empty and balance_groups.support(empty, 2) is None
    assert empty.animation_data.action == action and len(bpy.data.actions) == 1
    assert set(curves_of(empty)) == {("location", 0), ("location", 1), ("location", 2), ("rotation_euler", 2)}
    balance_groups.store(empty, path_of(shift=1.0), [None] * 3)
    assert_found(empty, path_of(shift=1.0))
    assert len(action.slots) == len(action.layers) == len(action.layers[0].strips) == 1
