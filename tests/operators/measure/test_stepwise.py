# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that work in steps: what Esc, the end and a fault between two steps leave behind."""

import bpy
import numpy as np
import pytest
from body_moments.operators import modal as stepwise
from body_moments.operators.measure.fourier import OBJECT_OT_body_moments_fourier
from body_moments.operators.measure.measure_selected import OBJECT_OT_body_moments_measure
from body_moments.operators.shape.find_similar import OBJECT_OT_body_moments_find_similar
from body_moments.operators.shape.find_symmetry import OBJECT_OT_body_moments_find_symmetry
from body_moments.operators.shape.match_pose import OBJECT_OT_body_moments_match_pose

from tests.blender.objects import add, mesh_body, only, place
from tests.operators.modal_runs import ESC, MOUSE, TIMER, finished, pressed

pytestmark = pytest.mark.usefixtures("registered", "scene")


@pytest.fixture(autouse=True)
def one_step_at_a_time(monkeypatch):
    monkeypatch.setattr(stepwise, "STEP_SECONDS", 0.0)
    monkeypatch.setattr(stepwise, "MAX_STEP_SECONDS", 0.0)


def three():
    bodies = [
        add(mesh_body(), name, location=(3 * i, i, 1), rotation=(i, 0, 1))
        for i, name in enumerate("abc")
    ]
    only(*bodies)
    return bodies


OPERATORS = [
    (OBJECT_OT_body_moments_measure, {}),
    (OBJECT_OT_body_moments_find_symmetry, {"tolerance": 1e-3}),
    (OBJECT_OT_body_moments_match_pose, {}),
]


@pytest.mark.parametrize(("cls", "settings"), OPERATORS)
def test_esc_between_two_objects_leaves_everything_as_it_was(cls, settings, monkeypatch):
    monkeypatch.setattr(OBJECT_OT_body_moments_measure, "MAX_AT_ONCE", 1)
    bodies = three()
    before = [place(body) for body in bodies]
    operator, window = pressed(cls, **settings)
    assert operator.modal(window, MOUSE) == {"RUNNING_MODAL"}
    assert operator.modal(window, TIMER) == {"RUNNING_MODAL"} and "Esc" in window.status[-1]
    assert operator.modal(window, ESC) == {"CANCELLED"}
    assert window.timers == [] and window.status[-1] is None and operator.reports[-1][0] == "INFO"
    assert all((place(body) == matrix).all() for body, matrix in zip(bodies, before, strict=True))
    assert not any(
        "body_mass" in body or body.is_property_set("body_moments_symmetry") for body in bodies
    )


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
        assert all(
            (place(body) == matrix).all() for body, matrix in zip(bodies, before, strict=True)
        )
        assert not any(body.is_property_set("body_moments_symmetry") for body in bodies)
        assert not len(bpy.context.scene.body_moments_search.found)
        shares = [float(text.split(": ")[1].partition("%")[0]) for text in window.status[:-1]]
        assert shares == sorted(shares) and 0.0 <= shares[-1] <= 100.0
    assert result == {"FINISHED"} and steps > 1


@pytest.mark.parametrize(("cls", "settings"), OPERATORS)
def test_a_fault_in_a_step_gives_the_window_back(cls, settings, monkeypatch):
    monkeypatch.setattr(OBJECT_OT_body_moments_measure, "MAX_AT_ONCE", 1)
    three()
    operator, window = pressed(cls, **settings)

    def broken():
        yield 1
        raise ZeroDivisionError

    operator._steps = broken()
    with pytest.raises(ZeroDivisionError):
        finished(operator, window)
    assert window.timers == [] and window.status[-1] is None


def test_child_is_matched_although_its_parent_moves():
    target, parent, child = three()
    child.parent = parent
    bpy.context.view_layer.update()
    operator, window = pressed(OBJECT_OT_body_moments_match_pose)
    assert finished(operator, window) == {"FINISHED"}
    assert operator.reports[-1][0] == "INFO"
    for body in (parent, child):
        assert np.abs(place(body) - place(target)).max() < 2e-6


def test_failed_fourier_step_restores_window_and_reports(tmp_path):
    add(mesh_body())
    settings = {
        "filepath": str(tmp_path / "a.npz"),
        "of": "BODY",
        "frame": "WORLD",
        "count": 8,
        "largest": 0.0,
    }
    operator, window = pressed(OBJECT_OT_body_moments_fourier, **settings)
    assert "0%" in window.status[-1]
    path = operator._path
    operator._path = path.parent / "none" / path.name
    assert finished(operator, window) == {"CANCELLED"}
    assert operator.reports[-1][0] == "ERROR" and not path.exists()
    assert operator.reports[-1][1].endswith("No such file or directory.")
    operator, window = pressed(OBJECT_OT_body_moments_fourier, **settings)
    assert (
        operator.modal(window, ESC) == {"CANCELLED"} and not path.exists() and window.timers == []
    )
    operator, window = pressed(OBJECT_OT_body_moments_fourier, **settings)
    assert finished(operator, window) == {"FINISHED"} and path.exists()
