# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line in a real Blender: what a pipeline calls, and the exit codes that it gets."""

import json
import re
from pathlib import Path

import pytest

BATCH = Path(__file__).resolve().parent.parent.parent / "operators" / "batch.py"
COMMAND = ("--background", "--command", "body_moments", "measure")


def check_cube(output: Path) -> None:
    document = json.loads(output.read_text(encoding="utf-8"))
    assert document["schema"] == "body-moments/1"
    assert document["errors"] == []
    (cube,) = document["objects"]
    assert cube["name"] == "Cube"
    assert cube["method"] == "exact"
    assert cube["volume"] == pytest.approx(8.0, rel=1e-12)
    assert cube["center_of_mass"] == pytest.approx([1.0, 2.0, 3.0], rel=1e-12)


def test_the_installed_command_measures_a_file(run_blender, cube_file, tmp_path):
    run_blender(*COMMAND, "--output", tmp_path / "out.json", cube_file)
    check_cube(tmp_path / "out.json")


def test_the_installed_command_measures_the_open_file(run_blender, cube_file, tmp_path):
    run_blender("--background", cube_file, *COMMAND[1:], "--output", tmp_path / "out.json")
    check_cube(tmp_path / "out.json")


def test_the_script_measures_the_open_file(run_blender, cube_file, tmp_path):
    output = tmp_path / "out.json"
    words = ("--python", BATCH, "--", "measure", "--output", output)
    run_blender("--background", "--factory-startup", cube_file, *words)
    check_cube(output)


def test_nothing_but_the_record_is_on_the_output(run_blender, cube_file):
    """Blender itself may say things while it starts, before the command runs, and that it quits."""
    done = run_blender(*COMMAND, "--format", "jsonl", cube_file)
    lines = [line for line in done.stdout.splitlines() if line.strip()]
    (record,) = (index for index, line in enumerate(lines) if line.startswith("{"))
    assert json.loads(lines[record])["schema"] == "body-moments/1"
    started = re.compile(r"Blender \d|\d\d:\d\d\.\d+  ")
    assert [line for line in lines[:record] if not started.match(line)] == []
    assert [line for line in lines[record + 1 :] if line != "Blender quit"] == []


def test_missing_file_is_an_error_beside_other_records(run_blender, cube_file, tmp_path):
    output = tmp_path / "out.json"
    done = run_blender(
        *COMMAND, "--output", output, tmp_path / "missing.blend", cube_file, check=False
    )
    assert done.returncode == 1
    missing, measured = json.loads(output.read_text(encoding="utf-8"))
    assert missing["objects"] == []
    assert missing["errors"][0]["name"] is None
    assert len(measured["objects"]) == 1


def test_unopened_file_is_not_taken_for_the_startup_scene(run_blender, tmp_path):
    output = tmp_path / "out.json"
    missing = tmp_path / "missing.blend"
    done = run_blender("--background", missing, *COMMAND[1:], "--output", output, check=False)
    assert done.returncode not in (0, 70)
    assert not output.is_file() or json.loads(output.read_text("utf-8"))["objects"] == []


def test_wrong_words_are_told_and_exit_2(run_blender, cube_file):
    done = run_blender(*COMMAND, "--kind", "gas", cube_file, check=False)
    assert done.returncode == 2
    assert "gas" in done.stderr + done.stdout
