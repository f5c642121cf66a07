# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that need no Blender run without it."""

import json
import sys

import numpy as np
import pytest

from tests.blender import batch_files as files
from tests.command.processes import SCRIPT, process, script

# Run the script where some modules cannot be imported.
WITHOUT = """
import runpy, sys
sys.modules.update(dict.fromkeys(sys.argv.pop(1).split(","), None))
del sys.argv[0]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
ROBOT = (
    '<robot name="r"><link name="a"><visual><geometry><box size="2 2 '
    '2"/></geometry></visual></link></robot>'
)
PLAIN, NUMERIC = "bpy,mathutils,numpy", "bpy,mathutils"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("files")
    files.box_file(path / "part.blend")
    words = ("--signature", "--pose", "--format", "jsonl", "--output", "result.jsonl")
    assert script("measure", "part.blend", *words, cwd=path).returncode == 0
    np.savez(path / "corner.npz", points=np.eye(3, 2), simplices=[[0, 1, 2]])
    (path / "robot.urdf").write_text(ROBOT)
    return path


def without(modules, *words, cwd):
    ended = process(sys.executable, "-c", WITHOUT, modules, SCRIPT, *words, cwd=cwd)
    assert b"Traceback" not in ended.stderr
    return ended


@pytest.mark.parametrize(
    "modules, words, found",
    [
        (PLAIN, ["manifest", "."], b"part.blend"),
        (PLAIN, ["merge", "result.jsonl"], files.BOX_NAME.encode()),
        (PLAIN, ["to-csv", "result.jsonl"], files.BOX_NAME.encode()),
        (PLAIN, ["summary", "result.jsonl"], b"1 file: 1 ok"),
        (PLAIN, ["compare", "result.jsonl", "result.jsonl"], b"1 bodies compared, 0 differences"),
        (PLAIN, ["report", "result.jsonl"], b"<!doctype html>"),
        (PLAIN, ["--help"], b"measure"),
        (PLAIN, ["measure", "--help"], b"--density"),
        (NUMERIC, ["similar", "result.jsonl", "--to", files.BOX_NAME], b"distance"),
        (NUMERIC, ["simplex", "corner.npz"], b'"0,0": 0.5'),
    ],
)
def test_command_runs_without_blender(folder, modules, words, found):
    ended = without(modules, *words, cwd=folder)
    assert ended.returncode == 0 and found in ended.stdout


def test_audit_runs_without_blender(folder):
    ended = without(NUMERIC, "audit", "robot.urdf", cwd=folder)
    assert ended.returncode == 1 and json.loads(ended.stdout)["links"][0]["name"] == "a"
