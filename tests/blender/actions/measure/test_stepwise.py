# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that work in steps: what Esc, the end and a fault between two steps leave behind."""

import numpy as np
import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.core.verdict.finding import finding
from body_moments.operators.actions import modal as stepwise
from body_moments.operators.actions.measure.fourier import OBJECT_OT_body_moments_fourier_run
from body_moments.operators.actions.measure.measure_selected import OBJECT_OT_body_moments_measure
from body_moments.operators.actions.shape.find_similar import OBJECT_OT_body_moments_find_similar
from body_moments.operators.actions.shape.find_symmetry import OBJECT_OT_body_moments_find_symmetry
from body_moments.operators.actions.shape.match_pose import OBJECT_OT_body_moments_match_pose
from body_moments.operators.session import outcome, results

from tests.blender.actions.shape.test_shape import prism
from tests.blender.actions.test_dialogs import ESC, MOUSE, TIMER, stand_in
from tests.blender.objects import add, mesh_body, only, place

pytestmark = pytest.mark.usefixtures("registered", "scene")


class Window:
    """What of a window such an operator uses; everything else is Blender's."""

    def __init__(self):
        self.handlers, self.timers, self.status = [], [], []
        self.window = self.window_manager = self.workspace = self
        self.modal_handler_add = self.handlers.append
        self.status_text_set = self.status.append
        self.progress_begin = self.progress_update = lambda *_: None

    def __getattr__(self, name):
        return getattr(bpy.context, name)

    def event_timer_add(self, _seconds, window):
        self.timers.append(window)
        return window

    def event_timer_remove(self, timer):
        self.timers.remove(timer)

    def progress_end(self):
        pass


@pytest.fixture(autouse=True)
def one_step_at_a_time(monkeypatch):
    monkeypatch.setattr(stepwise, "STEP_SECONDS", 0.0)
    monkeypatch.setattr(stepwise, "MAX_STEP_SECONDS", 0.0)


def pressed(cls, **settings):
    """An operator as its button starts it, without Blender's own part, and the window that it has."""
    reports = []
    operator = stand_in(cls, lambda kind, text: reports.append((*kind, text)), **settings)
    operator.reports = reports
    window = Window()
    assert operator.invoke(window, None) == {"RUNNING_MODAL"}
    assert window.handlers == [operator] and window.timers == [window]
    return operator, window


def finished(operator, window, limit=100):
    for _ in range(limit):
        result = operator.modal(window, TIMER)
        if result != {"RUNNING_MODAL"}:
            assert window.timers == [] and window.status[-1] is None
            return result
    raise AssertionError("it never ends")


def three():
    bodies = [add(mesh_body(), name, location=(3 * i, i, 1), rotation=(i, 0, 1)) for i, name in enumerate("abc")]
    only(*bodies)
    return bodies


OPERATORS = [
    (OBJECT_OT_body_moments_measure, {}),
    (OBJECT_OT_body_moments_find_symmetry, {"tolerance": 1e-3}),
    (OBJECT_OT_body_moments_match_pose, {}),
]


@pytest.mark.parametrize(("cls", "settings"), OPERATORS)
def test_esc_between_two_objects_leaves_everything_as_it_was(cls, settings, monkeypatch):
    monkeypatch.setattr("body_moments.operators.actions.measure.measure_selected.MAX_OBJECTS_WITHOUT_REDRAW", 1)
    bodies = three()
    before = [place(body) for body in bodies]
    operator, window = pressed(cls, **settings)
    assert operator.modal(window, MOUSE) == {"RUNNING_MODAL"}
    assert operator.modal(window, TIMER) == {"RUNNING_MODAL"} and "Esc" in window.status[-1]
    assert operator.modal(window, ESC) == {"CANCELLED"}
    assert window.timers == [] and window.status[-1] is None and operator.reports[-1][0] == "INFO"
    assert all((place(body) == matrix).all() for body, matrix in zip(bodies, before, strict=True))
    assert not any("body_mass" in body or body.is_property_set("body_moments_symmetry") for body in bodies)


@pytest.mark.parametrize(
    ("cls", "count"),
    [
        (OBJECT_OT_body_moments_find_symmetry, 1),
        (OBJECT_OT_body_moments_match_pose, 2),
        (OBJECT_OT_body_moments_find_similar, 2),
    ],
)
def test_esc_within_an_object_leaves_everything_as_it_was(cls, count):
    bodies = three()[:count]
    only(*bodies)
    before = [place(body) for body in bodies]
    settings = {"tolerance": 1e-3, "select": True, "mirrored": False, "scaled": False}
    for steps in range(1, 100):
        operator, window = pressed(cls, **settings)
        for _ in range(steps):
            result = operator.modal(window, TIMER)
        if result != {"RUNNING_MODAL"}:
            break
        assert operator.modal(window, ESC) == {"CANCELLED"}
        assert window.timers == [] and window.status[-1] is None
        assert all((place(body) == matrix).all() for body, matrix in zip(bodies, before, strict=True))
        assert not any(body.is_property_set("body_moments_symmetry") for body in bodies)
        assert not len(bpy.context.scene.body_moments_search.found)
        shares = [float(text.split(": ")[1].partition("%")[0]) for text in window.status[:-1]]
        assert shares == sorted(shares) and 0.0 <= shares[-1] <= 100.0
    assert result == {"FINISHED"} and steps > 4


def test_the_progress_of_a_search_that_looks_at_surfaces_only_rises():
    wanted = prism("Wanted", [(0, 0), (3, 0), (1, 1)])
    for number in range(2):
        prism("Copy", [(0, 0), (3, 0), (1, 1)], location=(9 * number, 0, 0))
    only(wanted)
    operator, window = pressed(OBJECT_OT_body_moments_find_similar, select=True, mirrored=False, scaled=False)
    assert finished(operator, window) == {"FINISHED"} and len(operator._mirror_images) == 2
    shares = [float(text.split(": ")[1].partition("%")[0]) for text in window.status[:-1]]
    assert shares == sorted(shares) and shares[-1] <= 100.0
    assert {share // 50.0 for share in shares[1:-1] if 0.0 < share % 50.0 < 25.0} == {0.0, 1.0}  # within each of both


@pytest.mark.parametrize(
    ("cls", "settings", "among"),
    [
        (OBJECT_OT_body_moments_find_symmetry, {"tolerance": 1e-3}, {15.0, 45.0, 50.0, 65.0, 95.0, 100.0}),
        (OBJECT_OT_body_moments_match_pose, {}, {30.0, 90.0, 100.0}),
    ],
)
def test_of_each_object_three_tenths_are_done_when_it_is_read_and_nine_when_its_surface_is_sorted(cls, settings, among):
    only(*[add(mesh_body(), name, (5 * place, 0, 0)) for place, name in enumerate("ab")])
    operator, window = pressed(cls, **settings)
    assert finished(operator, window) == {"FINISHED"}
    shares = [float(text.split(": ")[1].partition("%")[0]) for text in window.status[:-1]]
    assert shares == sorted(shares) and among <= {*shares}


@pytest.mark.parametrize("cls", [OBJECT_OT_body_moments_match_pose, OBJECT_OT_body_moments_find_similar])
def test_an_active_object_that_has_no_shape_is_reported_and_ends_it(cls):
    bodies = three()
    bodies[0].data = bpy.data.meshes.new("Nothing")
    operator, window = pressed(cls, select=True, mirrored=False, scaled=False)
    assert finished(operator, window) == {"CANCELLED"}
    ((kind, text),) = operator.reports
    assert kind == "ERROR" and text.startswith("a: ")


def test_esc_leaves_what_was_said_of_objects_that_could_not_be_measured(monkeypatch):
    monkeypatch.setattr("body_moments.operators.actions.measure.measure_selected.MAX_OBJECTS_WITHOUT_REDRAW", 1)
    bodies = three()
    whole, nothing = bodies[0].data, bpy.data.meshes.new("Nothing")
    for body in bodies:
        body.data = nothing
    assert finished(*pressed(OBJECT_OT_body_moments_measure)) == {"CANCELLED"}
    refusals = [results.failure(body) for body in bodies]
    assert {refusal.code for refusal in refusals} == {"no_geometry"}
    for body in bodies:
        body.data = whole
    operator, window = pressed(OBJECT_OT_body_moments_measure)
    assert operator.modal(window, TIMER) == {"RUNNING_MODAL"}
    assert operator.modal(window, ESC) == {"CANCELLED"}
    assert [results.failure(body) for body in bodies] == refusals
    assert finished(*pressed(OBJECT_OT_body_moments_measure)) == {"FINISHED"}
    assert not any(results.failure(body) for body in bodies)


def test_one_object_with_warnings_is_not_counted(monkeypatch):
    monkeypatch.setattr("body_moments.operators.actions.measure.measure_selected.MAX_OBJECTS_WITHOUT_REDRAW", 0)
    text = bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT"))
    text.data.body, text.data.extrude, text.data.render_resolution_u = "o", 0.1, 30
    bpy.context.scene.collection.objects.link(text)
    only(text)
    operator, window = pressed(OBJECT_OT_body_moments_measure)
    assert finished(operator, window) == {"FINISHED"}
    assert operator.reports == [("WARNING", "Measured Text, with warnings")] and outcome.last() is None


@pytest.mark.parametrize(("cls", "settings"), OPERATORS)
def test_a_fault_in_a_step_gives_the_window_back(cls, settings, monkeypatch):
    monkeypatch.setattr("body_moments.operators.actions.measure.measure_selected.MAX_OBJECTS_WITHOUT_REDRAW", 1)
    three()
    operator, window = pressed(cls, **settings)

    def broken():
        yield 1
        raise ZeroDivisionError

    operator._steps = broken()
    with pytest.raises(ZeroDivisionError):
        finished(operator, window)
    assert window.timers == [] and window.status[-1] is None


def test_symmetries_are_kept_when_all_are_found():
    bodies = three()
    bodies[1].data = bpy.data.meshes.new("Nothing")
    operator, window = pressed(OBJECT_OT_body_moments_find_symmetry, tolerance=1e-3)
    assert finished(operator, window) == {"FINISHED"}
    assert [body.is_property_set("body_moments_symmetry") for body in bodies] == [True, False, True]
    ((kind, text),) = operator.reports
    assert kind == "WARNING" and "1 of 3 left unchanged: b: " in text


@pytest.mark.parametrize(("cls", "settings"), OPERATORS[1:])
def test_what_a_report_does_not_name_it_counts(cls, settings):
    bodies = [*three(), add(mesh_body(), "d"), add(mesh_body(), "e")]
    only(*bodies)
    operator, window = pressed(cls, **settings)
    assert finished(operator, window) == {"FINISHED"}
    ((kind, text),) = operator.reports
    more = 2 if cls is OBJECT_OT_body_moments_find_symmetry else 1  # nothing is reported of what others are laid onto
    assert kind == "INFO" and text.endswith("and {:d} more".format(more))


def test_a_child_is_laid_where_it_belongs_although_its_parent_moves_too():
    target, parent, child = three()
    child.parent = parent
    bpy.context.view_layer.update()
    operator, window = pressed(OBJECT_OT_body_moments_match_pose)
    assert finished(operator, window) == {"FINISHED"}
    assert operator.reports[-1][0] == "INFO"
    for body in (parent, child):
        assert np.abs(place(body) - place(target)).max() < 2e-6


def test_a_child_that_lies_right_is_laid_again_after_its_parent_has_moved():
    target, parent, child = three()
    child.matrix_world = target.matrix_world
    child.parent = parent
    child.matrix_parent_inverse = parent.matrix_world.inverted()
    before = place(child)
    assert np.abs(before - place(target)).max() < 1e-6
    operator, window = pressed(OBJECT_OT_body_moments_match_pose)
    assert finished(operator, window) == {"FINISHED"}
    for body in (parent, child):
        assert np.abs(place(body) - place(target)).max() < 3e-6


def test_a_fourier_transform_that_fails_under_way_gives_the_window_back_and_says_why(tmp_path):
    add(mesh_body())
    settings = {"filepath": str(tmp_path / "a.npz"), "of": "BODY", "frame": "WORLD", "count": 8, "largest": 0.0}
    operator, window = pressed(OBJECT_OT_body_moments_fourier_run, **settings)
    assert "0%" in window.status[-1]
    path = operator._path
    operator._path = path.parent / "none" / path.name
    assert finished(operator, window) == {"CANCELLED"}
    assert operator.reports[-1][0] == "ERROR" and not path.exists()
    assert operator.reports[-1][1].endswith("No such file or directory.")
    operator, window = pressed(OBJECT_OT_body_moments_fourier_run, **settings)
    assert operator.modal(window, ESC) == {"CANCELLED"} and not path.exists() and window.timers == []
    operator, window = pressed(OBJECT_OT_body_moments_fourier_run, **settings)
    assert finished(operator, window) == {"FINISHED"} and path.exists()


def test_a_fourier_transform_without_a_file_does_not_start():
    add(mesh_body())
    reports, window = [], Window()
    operator = stand_in(OBJECT_OT_body_moments_fourier_run, lambda kind, text: reports.append((*kind, text)))
    assert operator.invoke(window, None) == {"CANCELLED"} and window.handlers == window.timers == []
    assert reports == [("ERROR", str(finding("fourier_path_missing")))]
