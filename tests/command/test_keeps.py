# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files replaced by --output and --fourier: older results, other files with --force, never an
input.
"""

import io
import json
import os
from pathlib import Path

import numpy as np
import pytest
from body_moments.command.files import output
from body_moments.command.measure import measuring
from body_moments.core.measurement import documents

from tests.blender import batch_files as files

pytestmark = pytest.mark.usefixtures("scene")
WAVES = ("--grid", "2", "--qmax", "1")


@pytest.fixture
def no_measuring(monkeypatch):
    def measure(*_):
        raise AssertionError("an hour is lost")

    files.measure_with(monkeypatch, measure)


def foreign():
    yield "notes", b"old"
    yield "json", json.dumps({"mine": 1, "schema": "body-moments/1"}).encode()
    yield "array", json.dumps([{"schema": "others/1"}]).encode()
    yield "csv", b"file,frame,name,mass\n"
    yield "csv_edited", b"x," + "".join(documents.to_csv([])).encode()
    arrays = io.BytesIO()
    np.savez(arrays, q=1, F=2, error=3, input=4, method=5, frame=6, mine=7)
    yield "arrays", arrays.getvalue()


@pytest.mark.parametrize("content", [pytest.param(content, id=name) for name, content in foreign()])
@pytest.mark.parametrize("option", ["--output", "--fourier"])
def test_foreign_file_is_kept_before_measuring(tmp_path, main, no_measuring, option, content):
    part = files.box_file(tmp_path / "part.stl")
    target = tmp_path / "target"
    target.write_bytes(content)
    code, _, said = main(
        "measure", part, option, target, *(WAVES if option == "--fourier" else ["--flat"])
    )
    assert code == 2 and str(target) in said and "--force" in said
    assert target.read_bytes() == content


def test_force_replaces_a_foreign_file(tmp_path, main):
    part = files.box_file(tmp_path / "part.stl")
    target, arrays = tmp_path / "out.json", tmp_path / "out.npz"
    target.write_text("old")
    arrays.write_text("old")
    code, *_ = main("measure", part, "--force", "--output", target, "--fourier", arrays, *WAVES)
    assert (
        code == 0
        and json.loads(target.read_text())["objects"]
        and np.load(arrays)["F"].shape == (8,)
    )


def test_older_results_are_replaced_and_keep_their_mode(tmp_path, main):
    part = files.box_file(tmp_path / "part.stl")
    target, arrays = tmp_path / "out", tmp_path / "out.npz"
    target.touch()  # mktemp creates such files.
    target.chmod(0o600)
    for words in (
        (part,),
        (part, part),
        (part, part, "--format", "jsonl"),
        (part, "--format", "csv"),
        (part, "--format", "csv", "--order", "1", "--pose"),
    ):
        assert main("measure", *words, "--output", target)[0] == 0
        before = target.read_bytes()
    assert main("measure", part, "--output", target)[0] == 0 and target.read_bytes() != before
    for _ in range(2):
        assert main("measure", part, "--fourier", arrays, *WAVES)[0] == 0
    if os.name == "posix":
        assert target.stat().st_mode & 0o777 == 0o600
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out.npz", "part.stl"]


@pytest.mark.parametrize("option", ["--output", "--fourier"])
def test_force_keeps_inputs(tmp_path, main, no_measuring, option):
    part, link = tmp_path / "part.stl", tmp_path / "link"
    kept = Path(files.box_file(part)).read_bytes()
    os.link(part, link)
    for target in (part, link):
        code, _, said = main(
            "measure",
            "--force",
            part,
            option,
            target,
            *(WAVES if option == "--fourier" else ["--flat"]),
        )
        assert (
            code == 2
            and str(target) in said
            and "Use another name" in said
            and "--force" not in said
        )
    assert part.read_bytes() == kept


@pytest.mark.parametrize("option", ["--output", "--fourier"])
def test_file_appearing_meanwhile_is_kept(tmp_path, main, monkeypatch, option):
    part = files.box_file(tmp_path / "part.stl")
    target = tmp_path / "out.npz"
    real = measuring.measure_object

    def measure(*rest):
        target.write_text("somebody's")
        return real(*rest)

    files.measure_with(monkeypatch, measure)
    code, _, said = main(
        "measure", part, option, target, *(WAVES if option == "--fourier" else ["--flat"])
    )
    assert code == 1 and target.read_text() == "somebody's" and str(target) in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.npz", "part.stl"]


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="not on this system: devices")
def test_standard_output_follows_its_redirection(tmp_path):
    from tests.command.processes import script

    part = files.box_file(tmp_path / "part.stl")
    with open(tmp_path / "log", "w") as log:
        log.write("before\n")
        log.flush()
        words = ("measure", part, "--format", "jsonl", "--output", "/dev/stdout")
        ended = script(*words, stdout=log, stderr=log)
    lines = (tmp_path / "log").read_text().splitlines()
    assert ended.returncode == 0 and lines[0] == "before" and json.loads(lines[-1])["objects"]


def test_unreadable_file_is_not_replaced(tmp_path, main, no_measuring, monkeypatch):
    """Refuse a file that may or may not be a result."""
    part, target = files.box_file(tmp_path / "part.stl"), tmp_path / "out"
    target.write_text("mine")

    def fail(*_):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(output, "open", fail, raising=False)
    code, _, said = main("measure", part, "--output", target)
    assert code == 2 and "out: Input/output error" in said and target.read_text() == "mine"
