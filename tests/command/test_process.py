# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line as a process: what is on its outputs, and its exit codes.

As a script in Python with the bpy module, and, where there is one, in Blender itself.
"""

import io
import json
import os
import sys

import numpy as np
import pytest

from tests.blender import batch_files as files
from tests.command.processes import SCRIPT, process, script


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("files")
    for suffix in (".glb", ".stl", ".blend"):
        files.box_file(path / f"part{suffix}")
    (path / "bad.blend").write_bytes(b"BLENDER garbage")
    return path


@pytest.mark.parametrize("name", ["part.glb", "part.stl", "part.blend"])
def test_nothing_but_the_document_is_on_the_standard_output(folder, name):
    ended = script("measure", name, cwd=folder)
    found = json.loads(ended.stdout)
    assert ended.returncode == 0 and found["file"] == name
    assert found["objects"][0]["volume"] == pytest.approx(6.0, rel=1e-6)


def test_closed_standard_output_matters_only_without_output_file(folder, tmp_path):
    def closed(*words):
        shell = ("sh", "-c", 'exec "$@" >&-', "sh")
        return process(*shell, sys.executable, SCRIPT, "measure", folder / "part.glb", *words)

    ended = closed()
    assert (
        ended.returncode == 1
        and b"cannot be written" in ended.stderr
        and b"Traceback" not in ended.stderr
    )
    assert closed("--output", tmp_path / "out.json").returncode == 0
    assert json.loads((tmp_path / "out.json").read_text())["objects"]


def test_a_broken_file_gives_1_and_the_others_are_there(folder):
    ended = script(
        "measure", "part.glb", "bad.blend", "gone.stl", "part.stl", "--format", "jsonl", cwd=folder
    )
    found = [json.loads(line) for line in ended.stdout.splitlines()]
    assert ended.returncode == 1
    assert [len(document["objects"]) for document in found] == [1, 0, 0, 1]
    assert [len(document["errors"]) for document in found] == [0, 1, 1, 0]
    assert b"gone.stl" in ended.stderr


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="not on this system: devices")
def test_fourier_transform_is_written_into_a_pipe(folder, tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    ended = script(
        "measure", "part.stl", "--fourier", pipe, "--grid", "2", "--qmax", "1", cwd=folder
    )
    found = np.load(io.BytesIO(os.read(reader, 1 << 16)))
    os.close(reader)
    assert ended.returncode == 0 and found["F"].shape == (8,) and pipe.is_fifo()


@pytest.mark.parametrize("words", [(), ("measure",), ("measure", "part.glb", "--order", "99")])
def test_wrong_usage_gives_2_and_a_clean_output(folder, words):
    ended = script(*words, cwd=folder)
    assert ended.returncode == 2 and ended.stdout == b"" and b"error: " in ended.stderr


def test_the_script_leaves_no_folder_behind(folder, tmp_path):
    ended = script("measure", folder / "part.blend", env={"TMPDIR": str(tmp_path)})
    assert ended.returncode == 0 and list(tmp_path.iterdir()) == []


def test_a_program_that_has_imported_bpy_may_run_the_script(folder):
    code = (
        "import bpy, runpy, sys; sys.argv = sys.argv[1:]; runpy.run_path(sys.argv[0], "
        "run_name='__main__')"
    )
    ended = process(
        sys.executable, "-c", code, SCRIPT, "measure", "--no-supervisor", "part.stl", cwd=folder
    )
    document = ended.stdout[ended.stdout.index(b"{") :]  # Blender may warn of the system before
    assert ended.returncode == 0 and json.loads(document)["file"] == "part.stl"


def test_script_without_bpy_names_what_needs_blender(folder):
    for words, name in (
        ([folder / "part.blend"], "part.blend"),
        ([folder / "part.stl", "--flat"], "--flat"),
    ):
        ended = process(sys.executable, "-S", SCRIPT, "measure", *words)
        said = ended.stderr.decode()
        assert (
            ended.returncode == 2
            and ended.stdout == b""
            and name in said
            and "--blender PATH" in said
        )
