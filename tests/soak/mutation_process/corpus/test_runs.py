# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus in pieces of one file each, in this process: for mutants, which the whole of it would find too."""

import json
import os
from functools import cache
from pathlib import Path

import bpy
import pytest
from body_moments.operators import batch

from tests.corpus import compare, runs, scenes

pytestmark = [pytest.mark.usefixtures("registered"), pytest.mark.filterwarnings("default::RuntimeWarning")]


@cache
def reference() -> dict[str, object]:
    folder = Path(compare.__file__).parent
    table = compare.load(folder / "reference-5.2.json.gz")
    return table | compare.load(folder / "reference-4.5.json.gz") if bpy.app.version < (5, 0) else table


PLAN = json.loads(Path(os.environ["BODY_MOMENTS_CORPUS"]).read_text(encoding="utf-8"))


@pytest.mark.parametrize("number", range(len(PLAN)), ids=["{} {}".format(run, Path(f).stem) for run, _, f in PLAN])
def test_one_file(number, tmp_path):
    run, words, file = PLAN[number]
    output = tmp_path / "results.jsonl"
    argv = ["measure", "--no-supervisor", *words, "--format", "jsonl", "--output", str(output), file]
    assert batch.main(argv, channel=os.open(os.devnull, os.O_WRONLY)) in (0, 1)
    now = runs.entries(run, [Path(file)], output.read_text(encoding="utf-8"))
    before = {key: value for key, value in reference().items() if key in now}
    assert before.keys() == now.keys()
    assert not list(compare.within(before, now, scenes.EVALUATED))


@pytest.mark.parametrize("scene", sorted(scenes.SCENES.keys() - {"refused"}))  # that one fails without a mutant too
def test_what_operators_store(scene, tmp_path):
    now = runs._operators(tmp_path, scene)
    before = {key: value for key, value in reference().items() if key.startswith("properties/{}/".format(scene))}
    assert before.keys() == now.keys()
    table = {key: value for key, value in reference().items() if key.startswith("object/{}.blend/".format(scene))}
    assert not list(compare.within(before | table, now | table, scenes.EVALUATED))
