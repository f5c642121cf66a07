# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Fourier transform as a window runs it: progress, the image in its editors, the grid that it is asked for."""

from math import pi
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from body_moments.operators.actions.measure import fourier
from body_moments.operators.actions.measure.fourier import (
    OBJECT_OT_body_moments_fourier,
    OBJECT_OT_body_moments_fourier_run,
)

from tests.blender.actions.test_dialogs import TIMER, Window, stand_in
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add

pytestmark = pytest.mark.usefixtures("scene")


def run(window, path, **settings):
    said = {"of": "BODY", "frame": "WORLD", "count": 4, "largest": 0.0, **settings}
    operator = stand_in(OBJECT_OT_body_moments_fourier_run, window.say, filepath=str(path), **said)
    assert operator.invoke(window, None) == {"RUNNING_MODAL"}
    for _ in range(1000):
        answer = operator.modal(window, TIMER)
        if answer != {"RUNNING_MODAL"}:
            return answer
    raise AssertionError("it never ends")


def test_the_progress_goes_to_one_and_image_editors_show_the_image(tmp_path, monkeypatch):
    monkeypatch.setattr("body_moments.operators.actions.modal.STEP_SECONDS", 0.0)
    monkeypatch.setattr("body_moments.operators.actions.modal.MAX_STEP_SECONDS", 0.0)
    add(box_mesh(1, 2, 4), "Box")
    window = Window()
    assert run(window, tmp_path / "box.npz") == {"FINISHED"}
    assert window.said[:3] == ["timer 0.0 True", "modal OBJECT_OT_body_moments_fourier_run", "progress 0 1.0"]
    shares = [float(line.removeprefix("done ")) for line in window.said if line.startswith("done")]
    assert shares == sorted(shares) and shares[0] == 0.0 and 0.0 < shares[-1] <= 1.0
    assert window.spaces.active.image.name == "Fourier Transform of Box"
    other = Window()
    other.type = "VIEW_3D"
    assert run(other, tmp_path / "box.npz") == {"FINISHED"} and other.spaces.active.image is None


def test_without_a_window_no_progress_of_one_object_is_shown(tmp_path, monkeypatch):
    add(box_mesh(1, 2, 4), "Box")
    window, path = Window(False), str(tmp_path / "box.npz")
    monkeypatch.setattr("body_moments.operators.actions.modal.bpy", SimpleNamespace(context=window))
    settings = {"of": "BODY", "frame": "WORLD", "count": 4, "largest": 0.0}
    operator = stand_in(OBJECT_OT_body_moments_fourier_run, lambda *_: None, filepath=path, **settings)
    assert operator.execute(window) == {"FINISHED"} and window.said == []


@pytest.mark.parametrize(
    ("height", "kind", "asked", "proposed"),
    [
        (0.0, "SOLID", {}, "FLAT"),
        (4.0, "SOLID", {}, "BODY"),
        (0.0, "SHELL", {}, "BODY"),
        (0.0, "SOLID", {"of": "AREA"}, "AREA"),
    ],
)
def test_the_dialog_proposes_the_flat_shape_of_what_is_flat_unless_something_else_is_asked_for(
    height, kind, asked, proposed
):
    add(box_mesh(1, 2, height), "Box").body_moments.kind = kind
    operator = stand_in(OBJECT_OT_body_moments_fourier, print, **asked)
    assert operator.invoke(Window(), None) == {"RUNNING_MODAL"} and operator.of == proposed


def test_the_dialog_proposes_a_file_in_the_folder_of_the_last_one_else_beside_the_scene(tmp_path):
    add(box_mesh(1, 2, 4), "Box")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    for before, folder in (("", tmp_path), (str(tmp_path / "other" / "last.npz"), tmp_path / "other")):
        operator = stand_in(OBJECT_OT_body_moments_fourier, print, filepath=before)
        assert operator.invoke(Window(), None) == {"RUNNING_MODAL"} and operator.filepath == str(folder / "Box.npz")


@pytest.mark.parametrize(("is_open", "call"), [(True, "INVOKE_DEFAULT"), (False, "EXEC_DEFAULT")])
def test_in_a_window_it_goes_on_in_steps_and_without_one_at_once(is_open, call, monkeypatch):
    asked = []
    running = SimpleNamespace(
        body_moments_fourier_run=lambda *how, **settings: asked.append((how, settings)) or {"FINISHED"}
    )
    monkeypatch.setattr(fourier, "bpy", SimpleNamespace(ops=SimpleNamespace(object=running)))
    settings = {"filepath": "/a.npz", "of": "AREA", "frame": "OBJECT", "count": 5, "largest": 3.0}
    operator = stand_in(OBJECT_OT_body_moments_fourier, print, **settings)
    assert operator.execute(Window(is_open)) == {"FINISHED"} and asked == [((call,), settings)]


@pytest.mark.parametrize("largest", [0.0, 3.0])
@pytest.mark.parametrize("count", [4, 5])
@pytest.mark.parametrize("of", ["BODY", "AREA", "FLAT"])
def test_the_frequencies_go_to_the_largest_or_in_steps_of_half_a_turn_across_the_object(of, count, largest, tmp_path):
    size = 2.0 if of == "FLAT" else 4.0
    add(box_mesh(1, 2, 0 if of == "FLAT" else 4), "Box")
    assert run(Window(), tmp_path / "box.npz", of=of, count=count, largest=largest) == {"FINISHED"}
    with np.load(tmp_path / "box.npz") as file:
        assert file["q"].shape[-1] == (2 if of == "FLAT" else 3)
        found = np.unique(np.round(file["q"], 9))
    assert len(found) == count and 0.0 in found
    assert np.abs(found).max() == pytest.approx(largest or pi / size * (count // 2), rel=1e-6)
