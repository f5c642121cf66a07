# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Library without its processes: the words that they are given, and how a window watches them."""

from types import SimpleNamespace

import bpy
import pytest
from body_moments.operators.actions.measure import library

from tests.blender.actions.test_dialogs import ESC, MOUSE, TIMER, Window, stand_in

pytestmark = pytest.mark.usefixtures("scene")


class Run:
    """What stands in for the processes: two looks, then it has ended."""

    made, looks, ends = [], 2, 0

    def __init__(self, words, output, blender):
        self.words, self.output, self.blender = words, output, blender
        self.looked, self.stopped = 0, False
        Run.made.append(self)

    @property
    def exit_code(self):
        return Run.ends if self.looked >= Run.looks else None

    def done(self):
        self.looked += 1
        return self.looked

    def stop(self):
        self.stopped = True


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "a.stl").write_bytes(b"")
    (tmp_path / "b.stl").write_bytes(b"")
    monkeypatch.setattr(library, "WholeRun", Run)
    monkeypatch.setattr(library, "_PAUSE", 0.0)
    monkeypatch.setattr(Run, "made", [])
    monkeypatch.setattr(Run, "ends", 0)
    return tmp_path


def operator_in(folder, window, **options):
    settings = {"directory": str(folder), "source": library.FOLDER, **options}
    cls = library.OBJECT_OT_body_moments_measure_library
    return stand_in(cls, lambda kind, text: window.say(*kind, text), **settings)


@pytest.mark.parametrize(
    ("options", "more"),
    [
        ({}, ["--thumbnails"]),
        ({"thumbnails": False}, []),
        ({"asset_metadata": True}, ["--thumbnails", "--asset-metadata", "copy"]),
        ({"thumbnails": False, "asset_metadata": True, "overwrite": True}, ["--asset-metadata", "file"]),
        ({"overwrite": True}, ["--thumbnails"]),
    ],
)
@pytest.mark.parametrize("files", [(), (library.JOURNAL,), (library.JOURNAL, library.RESULT), (library.RESULT,)])
def test_the_run_is_given_the_words_of_the_options_and_goes_on_where_one_was_ended(folder, options, more, files):
    for name in files:
        (folder / name).write_bytes(b"")
    operator_in(folder, Window(), **options)._begin(bpy.context)
    (run,) = Run.made
    resume = ["--resume"] if files == (library.JOURNAL,) else []
    thumbnails = [word for word in more if word == "--thumbnails"]
    assert run.words == [str(folder), "--format", "jsonl", *thumbnails, *resume, *more[len(thumbnails) :]]
    assert run.output == folder / library.RESULT
    assert run.blender == (None if bpy.app.module else bpy.app.binary_path)


def test_without_a_context_the_folder_alone_can_be_measured():
    assert [identifier for identifier, *_ in library._sources(None, None)] == [library.FOLDER]


@pytest.mark.parametrize("background", [False, True])
@pytest.mark.parametrize("is_open", [False, True])
def test_it_runs_in_steps_in_a_window_alone(folder, background, is_open, monkeypatch):
    app = SimpleNamespace(background=background, module=True)
    monkeypatch.setattr(library, "bpy", SimpleNamespace(app=app, path=bpy.path, data=bpy.data))
    window = Window(is_open)
    operator = operator_in(folder, window)
    answer = operator.execute(window)
    in_steps = is_open and not background
    assert answer == ({"RUNNING_MODAL"} if in_steps else {"CANCELLED"})  # the run has written nothing
    assert ("progress 0 2" in window.said) == in_steps and Run.made[0].stopped != in_steps
    assert any("ERROR" in line or "WARNING" in line for line in window.said) != in_steps


def test_the_window_goes_on_living_and_esc_stops_the_run(folder, monkeypatch):
    monkeypatch.setattr(
        library, "bpy", SimpleNamespace(app=SimpleNamespace(background=False, module=True), path=bpy.path)
    )
    monkeypatch.setattr("body_moments.operators.actions.modal.STEP_SECONDS", 0.0)
    monkeypatch.setattr("body_moments.operators.actions.modal.MAX_STEP_SECONDS", 0.0)
    window = Window()
    operator = operator_in(folder, window)
    assert operator.execute(window) == {"RUNNING_MODAL"}
    assert operator.modal(window, MOUSE) == {"PASS_THROUGH"}
    assert operator.modal(window, TIMER) == {"RUNNING_MODAL"} and "done 1" in window.said
    assert operator.modal(window, ESC) == {"CANCELLED"} and Run.made[0].stopped
    operator = operator_in(folder, window)
    operator.execute(window)
    answers = [operator.modal(window, TIMER) for _ in range(3)]
    assert answers == [{"RUNNING_MODAL"}, {"RUNNING_MODAL"}, {"CANCELLED"}] and Run.made[1].stopped


@pytest.mark.parametrize("code", [0, 1, 70, 2, -9])
def test_a_report_is_written_where_the_run_came_to_its_end(folder, code, reported, monkeypatch):
    monkeypatch.setattr(Run, "ends", code)
    (folder / library.RESULT).write_bytes(b"")
    (folder / library.JOURNAL).write_bytes(b"")
    window = Window(False)
    answer = operator_in(folder, window).execute(window)
    is_over = code in (0, 1, 70)
    assert answer == ({"FINISHED"} if is_over else {"CANCELLED"})
    assert (folder / library.REPORT).is_file() == is_over
    if is_over:
        assert reported.values("library_measured") == {"count": 0, "failed": 0, "file": str(folder / library.REPORT)}
    else:
        assert reported.values("library_failed") == {"code": code}


def test_a_run_that_cannot_be_started_says_why(folder, reported, monkeypatch):
    def fails(*_words):
        raise FileNotFoundError(2, "No such thing")

    monkeypatch.setattr(library, "WholeRun", fails)
    assert operator_in(folder, Window()).execute(Window()) == {"CANCELLED"}
    assert reported.values("library_not_started") == {"error": "No such thing"}
