# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--fourier where no transform comes of it: the reason is an entry, the body is measured all the same."""

from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("bpy")
from body_moments.core.verdict.finding import QueryError, ReadError, finding
from body_moments.operators import batch
from body_moments.operators.bodies.fourier import ObjectTransform
from body_moments.operators.command import fourier
from body_moments.operators.command.option_types import MAX_GRID

from tests.blender import batch_files as files
from tests.blender.batch_files import run, sentence
from tests.blender.findings import refused

pytestmark = pytest.mark.usefixtures("scene")


@pytest.fixture
def asked(tmp_path):
    """What comes of a transform: the names of what was measured, the errors, the faults of the program."""

    def answer(*words):
        line = run("--fourier", tmp_path / "f.npz", "--grid", "2", "--qmax", "1", *words)
        (found,) = line.documents
        return [one["name"] for one in found["objects"]], found["errors"], line.internal_errors

    return answer


def error(name, code, **values):
    return [{"name": name, "reason": sentence(code, **values)}]


def test_there_is_one_object_to_transform(asked, tmp_path):
    files.add_box("Other")
    assert asked() == (["Other"], [], 0) and (tmp_path / "f.npz").exists()
    (tmp_path / "f.npz").unlink()
    files.add_box("Box")
    assert asked() == (["Box", "Other"], error(None, "fourier_object_count", count=2), 0)
    assert not (tmp_path / "f.npz").exists()
    assert asked("--object", "Box") == (["Box"], [], 0) and (tmp_path / "f.npz").exists()


def test_what_cannot_be_measured_has_one_error(asked, tmp_path):
    box = files.add_box("Box")
    box.data.clear_geometry()
    names, (told,), faults = asked("--object", "Box")
    assert (names, faults) == ([], 0) and told["name"] == "Box" and told["reason"] == sentence("no_geometry")
    assert not (tmp_path / "f.npz").exists()


def test_why_there_is_no_transform_is_said_beside_the_body(asked, monkeypatch):
    files.add_box("Box")
    cause = finding("wave_vectors_archive", file="q")
    for comes, expected, faults in (
        (QueryError(cause), error("Box", "fourier_failed", cause=cause.as_record()), 0),
        (
            OSError(28, "No space left on device"),
            error("Box", "fourier_not_written", error="No space left on device"),
            0,
        ),
        (ZeroDivisionError("here"), None, 1),
    ):

        def fail(*_, comes=comes):
            raise comes

        monkeypatch.setattr(fourier, "write", fail)
        names, told, internal = asked()
        assert (names, internal) == (["Box"], faults)
        if expected:
            assert told == expected
        else:
            assert [one["name"] for one in told] == ["Box"] and "ZeroDivisionError: here" in told[0]["reason"]


def test_an_array_is_measured_and_not_transformed(asked, tmp_path):
    np.save(tmp_path / "scan.npy", np.ones((2, 2, 2)))
    assert asked(tmp_path / "scan.npy") == (["scan"], error(None, "fourier_of_array"), 0)
    assert not (tmp_path / "f.npz").exists()


def test_as_many_wave_vectors_may_be_named_as_the_largest_grid_has(tmp_path, capfd):
    """One more is refused by its number, before any of them is read."""
    files.add_box("Box")
    path, count = tmp_path / "q.npy", MAX_GRID**3 + 1
    with open(path, "wb") as file:
        header = {"descr": "<f8", "fortran_order": False, "shape": (count, 3)}
        np.lib.format.write_array_header_1_0(file, header)
        file.truncate(file.tell() + 24 * count)
    assert batch.main(["measure", "--fourier", str(tmp_path / "f.npz"), "--q", str(path)], channel=-1) == 2
    cause = finding("wave_vectors_too_many", count=count, limit=MAX_GRID**3)
    assert sentence("usage_value", option="q", cause=cause.as_record()) in capfd.readouterr().err


def test_what_is_refused_while_a_transform_is_found_is_about_its_object():
    def steps():
        yield 0.5
        raise ReadError("object_too_large")

    transform = ObjectTransform("Part", SimpleNamespace(steps=steps), 1.0, ())
    with refused("object_too_large", "Part"):
        list(transform.steps())
