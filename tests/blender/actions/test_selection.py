# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What all operators on the selection share: one report a run, progress, the order of the objects."""

from types import SimpleNamespace

import bpy
import pytest
from body_moments.core.verdict.finding import EditRefusedError, finding
from body_moments.operators.actions import modal, rigid_world, selection

from tests.blender.actions.test_dialogs import Window
from tests.blender.actions.test_refusals import linked_armature
from tests.blender.objects import add, mesh_body, only

pytestmark = pytest.mark.usefixtures("scene")
DONE, IDLE, FAILURE, NOTE = (
    finding(code) for code in ("no_faces", "already_aligned", "not_a_rigid_body", "open_object")
)


@pytest.mark.parametrize("idle", [None, IDLE])
@pytest.mark.parametrize("total", [0, 3])
@pytest.mark.parametrize("findings", [[], [NOTE]])
@pytest.mark.parametrize("failures", [[], [FAILURE]])
@pytest.mark.parametrize("changed", [0, 2])
def test_one_report_tells_what_was_done_what_was_left_and_what_was_noticed(
    changed, failures, findings, total, idle, monkeypatch
):
    said, kept = [], []
    monkeypatch.setattr(selection.reports, "report", lambda _, *found: said.extend(found))
    monkeypatch.setattr(selection.outcome, "remember", lambda label, found: kept.append((label, found)))
    operator = SimpleNamespace(bl_label="Action")
    answer = selection.summarize(operator, changed, total, DONE, failures, findings, idle)
    assert answer == ({"FINISHED"} if changed else {"CANCELLED"})
    expected = [DONE] if changed or not failures else []
    if not changed and not failures and idle:
        expected = [finding("nothing_to_do", cause=IDLE.as_record()) if total else finding("nothing_measurable")]
    if failures:
        expected.append(finding("left_unchanged", count=1, total=total, causes=[FAILURE.as_record()]))
    assert said == [*expected, *findings] and kept == [("Action", [*failures, *findings])]


def test_the_first_of_many_are_reported_and_all_are_kept(monkeypatch):
    said, kept = [], []
    monkeypatch.setattr(selection.reports, "report", lambda _, *found: said.extend(found))
    monkeypatch.setattr(selection.outcome, "remember", lambda _, found: kept.extend(found))
    selection.summarize(SimpleNamespace(bl_label="Action"), 1, 9, DONE, [FAILURE] * 4, [NOTE] * 5)
    causes = [found.as_record() for found in (*[FAILURE] * 3, finding("and_more", count=1))]
    assert said[:2] == [DONE, finding("left_unchanged", count=4, total=9, causes=causes)]
    assert said[2:] == [*[NOTE] * 3, finding("and_more", count=2)] and kept == [*[FAILURE] * 4, *[NOTE] * 5]


def test_each_object_counts_when_it_is_done_and_its_shares_before():
    def action(obj):
        if obj.name == "fails":
            raise EditRefusedError("open_object")
        if obj.name == "steps":
            return iter((0.25, 0.5))
        return None

    objects = [SimpleNamespace(name=name, name_full=name) for name in ("one", "steps", "fails", "last")]
    failures = []
    assert [*selection.iterate_objects(objects, action, failures)] == [1, 1.25, 1.5, 2, 3, 4]
    assert [failure.values["object"] for failure in failures] == ["fails"]


def test_of_what_an_action_says_that_it_changed_nothing_is_not_counted(monkeypatch):
    def action(obj):
        if obj.name == "fails":
            raise EditRefusedError("open_object")
        return {"none": None, "yes": True, "no": False}[obj.name]

    objects = [SimpleNamespace(name=name, name_full=name) for name in ("none", "yes", "no", "fails")]
    changed, failures = selection.apply_to_all(objects, action)
    assert [obj.name for obj in changed] == ["none", "yes"] and [found.code for found in failures] == ["failure"]


@pytest.mark.parametrize("count", [0, 1, 2])
def test_the_progress_of_several_is_shown_until_they_are_done(count, monkeypatch):
    window = Window()
    monkeypatch.setattr(modal, "bpy", SimpleNamespace(context=window))
    with pytest.raises(ZeroDivisionError), modal.progress(count) as step:
        step(0.5)
        assert window.said == (["progress 0 2", "done 0.5"] if count == 2 else [])
        raise ZeroDivisionError
    assert window.said[2:] == (["progress ends"] if count == 2 else [])


def test_parents_come_before_their_children_however_they_are_named():
    objects = [add(mesh_body(), name) for name in "abcd"]
    for child, parent in zip(objects, objects[1:], strict=False):
        child.parent = parent
    only(*objects)
    add(None, "Point", select=False).select_set(True)
    assert [obj.name for obj in selection.selected_measurable(bpy.context)] == ["d", "c", "b", "a"]


def test_a_joint_is_added_where_the_context_is_about_an_object_that_cannot_be_edited():
    linked_armature()
    rig = bpy.context.object
    joint = add(None, "Joint", select=False)
    bodies = [add(mesh_body(), name, select=False) for name in ("One", "Two")]
    with bpy.context.temp_override(object=rig, active_object=rig, selected_objects=[rig]):
        made = rigid_world.add_joint(bpy.context, joint, "HINGE")
        rigid_world.add_rigid_bodies(bpy.context, bodies, "PASSIVE")
        assert made == joint.rigid_body_constraint and made.type == "HINGE"
        assert [body.rigid_body.type for body in bodies] == ["PASSIVE"] * 2
        rigid_world.remove_joint(bpy.context, joint)
    assert joint.rigid_body_constraint is None and bpy.context.view_layer.objects.active == rig
