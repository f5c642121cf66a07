# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Engines of others that measure ranges of a list: the files in docs/engines, run by what they are written for."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("bpy")

from tests.command import slurm_controller
from tests.command.test_process import BLENDER, ROOT, SCRIPT, in_blender, process, script
from tests.soak import commands

ENGINES = ROOT / "docs" / "engines"
OPENJD = shutil.which("openjd", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]))
COUNT, SIZE = 7, 3


@pytest.fixture
def job(tmp_path):
    """A list of seven files, of which one kills Blender, and a folder for results."""
    folder = tmp_path / "files"
    folder.mkdir()
    for number in range(COUNT - 1):
        np.save(folder / "scan {}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    (folder / "killer.ply").write_text("ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n")
    assert script("manifest", folder, "--output", tmp_path / "list").returncode == 0
    (tmp_path / "results").mkdir()
    return tmp_path


def check(job):
    text = (job / "results" / "all.jsonl").read_text(encoding="utf-8")
    found = [json.loads(line) for line in text.splitlines()]
    assert [Path(one["file"]).name for one in found] == [
        "killer.ply",
        *("scan {}.npy".format(number) for number in range(6)),
    ]
    assert [one["status"] for one in found] == ["crashed"] + ["ok"] * 6
    assert [one["objects"][0]["mass"] for one in found[1:]] == [60.0 * (number + 1) for number in range(6)]


def environment(job, **more):
    values = {"SCRIPT": SCRIPT, "BLENDER": BLENDER, "MANIFEST": job / "list", "FOLDER": job / "results", "SIZE": SIZE}
    return {name: str(value) for name, value in {**values, "PYTHON": sys.executable, **more}.items()}


@in_blender
@pytest.mark.skipif(not OPENJD, reason="needs openjd-cli")
def test_open_job_description(job):
    values = {"Python": sys.executable, "Script": SCRIPT, "Blender": BLENDER, "Manifest": job / "list"}
    values |= {"Folder": job / "results", "Last": COUNT - 1, "Size": SIZE}
    words = [word for name, value in values.items() for word in ("-p", "{}={}".format(name, value))]
    template = ENGINES / "body_moments.openjd.yaml"
    ended = process(OPENJD, "run", template, "--step", "Merge", "--run-dependencies", *words)
    assert ended.returncode == 0, ended.stdout[-3000:]
    check(job)


@in_blender
@pytest.mark.skipif(not shutil.which("parallel"), reason="needs GNU parallel")
def test_gnu_parallel(job):
    ended = process("bash", ENGINES / "body_moments.parallel.sh", "--jobs", "2", env=environment(job, COUNT=COUNT))
    assert ended.returncode == 0, ended.stderr
    check(job)


@in_blender
@pytest.mark.skipif(os.name == "nt", reason="not on this system: bash")
def test_the_tasks_of_a_slurm_array(job):
    """Run one task twice, as Slurm does: a requeued task continues."""
    for number in (0, 1, 2, 1):
        variables = environment(job, SLURM_ARRAY_TASK_ID=number, SLURM_CPUS_PER_TASK=1)
        ended = process("bash", ENGINES / "body_moments.slurm.sh", env=variables)
        assert ended.returncode == 0, ended.stderr
    assert b"0 files in" in ended.stderr
    parts = [job / "results" / "part-{}.jsonl".format(number) for number in range(3)]
    assert script("merge", *parts, "--output", job / "results" / "all.jsonl").returncode == 0
    check(job)


@pytest.fixture
def slurm():
    """The environment of a Slurm that takes jobs."""
    missing = [name for name, path in slurm_controller.PROGRAMS.items() if path is None]
    if missing:
        pytest.skip("needs Slurm: " + ", ".join(missing))
    with tempfile.TemporaryDirectory(prefix="slurm_") as name:  # a socket's name must be short
        try:
            with slurm_controller.slurm(Path(name)) as environment:
                yield environment
        except slurm_controller.NotStarted as error:
            pytest.skip("needs Slurm: its controller does not start here: {}".format(error))


@in_blender
def test_an_array_under_a_controller_of_slurm(job, slurm):
    """Follow the head of the script; the controller requeues a task during a slow file."""
    listed = [json.loads(line) for line in (job / "list").read_text().splitlines()]
    slow = job / "files" / "slow_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    listed[0]["files"] += 1
    with open(job / "list", "w") as file:
        file.writelines(json.dumps(line) + "\n" for line in [*listed, {"path": str(slow)}])
    log = job / "log-%a"
    environment_of_job = slurm | environment(job)
    submit = ("sbatch", "--parsable", "--requeue", "--array=0-2", "--output", log, "--open-mode=append")
    number = slurm_controller.asked(environment_of_job, *submit, ENGINES / "body_moments.slurm.sh")
    assert number.isdigit(), number
    joins = ENGINES.joinpath("body_moments.slurm.sh").read_text().split("--wrap")[1].split("'")[1]
    joins = joins.replace("python3", '"$PYTHON"')
    words = ("sbatch", "--parsable", "--dependency=afterok:" + number, "--output", job / "log-merge", "--wrap", joins)
    merge = slurm_controller.asked(environment_of_job, *words)
    assert merge.isdigit(), merge

    def state(task):
        return slurm_controller.asked(slurm, "squeue", "-h", "-t", "all", "-j", task, "-o", "%T").split("\n")[0]

    journal = job / "results" / "part-2.jsonl.journal"
    assert commands.wait_until(lambda: journal.exists() and journal.read_bytes().count(b"\n") == 1, 120.0)
    slurm_controller.asked(slurm, "scontrol", "requeue", number + "_2")
    now = ("scontrol", "update", "JobId=" + number + "_2", "StartTime=now")  # not after Slurm's two minutes
    commands.wait_until(lambda: state(number + "_2") == "PENDING", 60.0)
    slow.unlink()  # Only after the first run has ended, or that run could record the missing file.
    slurm_controller.asked(slurm, *now)
    assert commands.wait_until(lambda: state(merge) in ("COMPLETED", "FAILED"), 300.0), state(merge)
    told = (job / "log-2").read_text()
    assert state(merge) == "COMPLETED", (told, (job / "log-merge").read_text())
    assert "1 file in" in told, told  # The second run does not repeat measured files.
    everything = [json.loads(line) for line in (job / "results" / "all.jsonl").read_text().splitlines()]
    assert everything.pop()["status"] == "missing"
    (job / "results" / "all.jsonl").write_text("".join(json.dumps(line) + "\n" for line in everything))
    check(job)


# Flamenco's interface to a job type.
STUBS = """
const fs = require("fs"), paths = require("path"), vm = require("vm");
const [, , source, given] = process.argv;
const made = [];
class Task {
  constructor(name, kind) { Object.assign(this, {name, kind, commands: [], needs: []}); }
  addCommand(command) { this.commands.push(command); }
  addDependency(task) { this.needs.push(task.name); }
}
const sandbox = {
  author: { Task: (name, kind) => new Task(name, kind), Command: (name, values) => ({name, ...values}) },
  path: { join: paths.posix.join }, shellSplit: text => text.split(/ +/).filter(Boolean),
};
vm.createContext(sandbox);
vm.runInContext(fs.readFileSync(source, "utf8") + ";this.JOB_TYPE = JOB_TYPE;", sandbox);
sandbox.compileJob({settings: JSON.parse(given), addTask: task => made.push(task)});
console.log(JSON.stringify({type: sandbox.JOB_TYPE, tasks: made}));
"""


def compiled(tmp_path, settings):
    stubs = tmp_path / "stubs.js"
    stubs.write_text(STUBS)
    source = ENGINES / "body_moments.flamenco.js"
    return process("node", stubs, source, json.dumps(settings), timeout=60)


@pytest.mark.skipif(not shutil.which("node"), reason="needs Node")
def test_the_job_type_of_flamenco(job):
    """With stubs of its interface; the workers' part is done here."""
    settings = {"manifest": str(job / "list"), "script": SCRIPT, "folder": str(job / "results"), "count": COUNT}
    settings |= {"size": SIZE, "python": sys.executable, "options": "--jobs 1"}
    found = json.loads(compiled(job, settings).stdout)
    kinds = {setting["type"] for setting in found["type"]["settings"]}
    assert kinds <= {"string", "int32", "float", "bool"}
    *parts, merge = found["tasks"]
    assert [part["name"] for part in parts] == ["measure 0", "measure 3", "measure 6"]
    assert merge["needs"] == [part["name"] for part in parts]
    for task in found["tasks"]:
        (command,) = task["commands"]
        assert command["name"] == "exec" and task["kind"] == "misc"
        words = [command["exe"], *command["args"]]
        if "--blender" in words and not BLENDER:
            at = words.index("--blender")
            del words[at : at + 2]
        ended = subprocess.run(words, capture_output=True, timeout=600)
        assert ended.returncode == 0, ended.stderr
    check(job)
    settings.pop("size")
    assert len(json.loads(compiled(job, settings).stdout)["tasks"]) == 2  # the default, which the API does not send
    settings.pop("count")
    assert compiled(job, settings).returncode != 0
