# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Engines of others that measure ranges of a list: the files in docs/engines, run by what they are
written for.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from tests.command import slurm_controller
from tests.command.processes import BLENDER, ROOT, in_blender, process, script
from tools.soak import commands

ENGINES = ROOT / "docs" / "engines"
OPENJD = shutil.which(
    "openjd", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
)
COUNT, PARTS = 7, 3


@pytest.fixture
def job(tmp_path):
    """A list of seven files, of which one kills Blender, and a folder for results, with spaces in
    all names.
    """
    tmp_path = tmp_path / "a job"
    tmp_path.mkdir()
    folder = tmp_path / "files to measure"
    folder.mkdir()
    for number in range(COUNT - 1):
        np.save(folder / "scan {}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    shutil.copy(
        ROOT / "tools" / "soak" / "crash_corpus" / "damaged_block.blend", folder / "killer.blend"
    )
    assert (
        script("manifest", folder, "--parts", PARTS, "--output", tmp_path / "a list").returncode
        == 0
    )
    (tmp_path / "results").mkdir()
    return tmp_path


def check(job, name="1"):
    text = (job / "results" / name / "all.jsonl").read_text(encoding="utf-8")
    found = [json.loads(line) for line in text.splitlines()]
    assert [Path(one["file"]).name for one in found] == [
        "killer.blend",
        *("scan {}.npy".format(number) for number in range(6)),
    ]
    assert [one["status"] for one in found] == ["crashed"] + ["ok"] * 6
    assert [one["objects"][0]["mass"] for one in found[1:]] == [
        60.0 * (number + 1) for number in range(6)
    ]


def environment(job, **more):
    values = {
        "ADDON": ROOT,
        "BLENDER": BLENDER,
        "MANIFEST": job / "a list",
        "FOLDER": job / "results",
        "JOB": 1,
    }
    return {
        name: str(value) for name, value in {**values, "PYTHON": sys.executable, **more}.items()
    }


@in_blender
@pytest.mark.skipif(not OPENJD, reason="needs openjd-cli")
def test_open_job_description(job):
    values = {
        "Python": sys.executable,
        "Addon": ROOT,
        "Blender": BLENDER,
        "Manifest": job / "a list",
    }
    values |= {"Folder": job / "results", "Job": 1, "Parts": PARTS}
    words = [word for name, value in values.items() for word in ("-p", "{}={}".format(name, value))]
    template = ENGINES / "body_moments.openjd.yaml"
    ended = process(OPENJD, "run", template, "--step", "Merge", "--run-dependencies", *words)
    assert ended.returncode == 0, ended.stdout[-3000:]
    check(job)


@in_blender
@pytest.mark.skipif(not shutil.which("parallel"), reason="needs GNU parallel")
def test_gnu_parallel(job):
    ended = process(
        "bash", ENGINES / "body_moments.parallel.sh", "--jobs", "2", env=environment(job)
    )
    assert ended.returncode == 0, ended.stderr
    check(job)


@in_blender
@pytest.mark.skipif(os.name == "nt", reason="not on this system: bash")
def test_the_tasks_of_a_slurm_array(job):
    """Run one task twice, as Slurm does: a requeued task continues."""
    for number in (1, 2, 3, 2):
        variables = environment(
            job, SLURM_ARRAY_JOB_ID=1, SLURM_ARRAY_TASK_ID=number, SLURM_CPUS_PER_TASK=1
        )
        ended = process("bash", ENGINES / "body_moments.slurm.sh", env=variables)
        assert ended.returncode == 0, ended.stderr
    assert b"2 of 2 files reused" in ended.stderr
    assert (
        process("bash", ENGINES / "body_moments.slurm.sh", "1", env=environment(job)).returncode
        == 0
    )
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
    listed = [json.loads(line) for line in (job / "a list").read_text().splitlines()]
    slow = job / "slow_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    listed[0]["files"] += 1
    with open(job / "a list", "w") as file:
        file.writelines(json.dumps(line) + "\n" for line in [*listed, {"path": str(slow)}])
    log = job / "log-%a"
    environment_of_job = slurm | environment(job)
    submit = (
        "sbatch",
        "--parsable",
        "--requeue",
        "--array=1-3",
        "--output",
        log,
        "--open-mode=append",
    )
    number = slurm_controller.asked(environment_of_job, *submit, ENGINES / "body_moments.slurm.sh")
    assert number.isdigit(), number
    words = (
        "sbatch",
        "--parsable",
        "--dependency=afterok:" + number,
        "--output",
        job / "log-merge",
    )
    merge = slurm_controller.asked(
        environment_of_job, *words, ENGINES / "body_moments.slurm.sh", number
    )
    assert merge.isdigit(), merge

    def state(task):
        return slurm_controller.asked(
            slurm, "squeue", "-h", "-t", "all", "-j", task, "-o", "%T"
        ).split("\n")[0]

    journal = job / "results" / number / "part-3.jsonl.journal"
    assert commands.wait_until(
        lambda: journal.exists() and journal.read_bytes().count(b"\n") == 2, 120.0
    )
    slurm_controller.asked(slurm, "scontrol", "requeue", number + "_3")
    # not after Slurm's two minutes
    now = (
        "scontrol",
        "update",
        "JobId=" + number + "_3",
        "StartTime=now",
    )
    commands.wait_until(lambda: state(number + "_3") == "PENDING", 60.0)
    slow.unlink()  # Only after the first run has ended, or that run could record the missing file.
    slurm_controller.asked(slurm, *now)
    assert commands.wait_until(lambda: state(merge) in ("COMPLETED", "FAILED"), 300.0), state(merge)
    told = (job / "log-3").read_text()
    assert state(merge) == "COMPLETED", (told, (job / "log-merge").read_text())
    assert "2 of 3 files reused" in told, told  # The second run does not repeat measured files.
    joined = job / "results" / number / "all.jsonl"
    everything = [json.loads(line) for line in joined.read_text().splitlines()]
    assert everything.pop()["status"] == "missing"
    joined.write_text("".join(json.dumps(line) + "\n" for line in everything))
    check(job, number)


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
  author: {
    Task: (name, kind) => new Task(name, kind),
    Command: (name, values) => ({name, ...values}),
  },
  path: { join: paths.posix.join }, shellSplit: text => text.split(/ +/).filter(Boolean),
};
vm.createContext(sandbox);
vm.runInContext(fs.readFileSync(source, "utf8") + ";this.JOB_TYPE = JOB_TYPE;", sandbox);
sandbox.compileJob({name: "a job", settings: JSON.parse(given), addTask: task => made.push(task)});
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
    settings = {
        "manifest": str(job / "a list"),
        "addon": str(ROOT),
        "folder": str(job / "results"),
        "parts": PARTS,
    }
    settings |= {"python": sys.executable, "options": "--jobs 1"}
    found = json.loads(compiled(job, settings).stdout)
    kinds = {setting["type"] for setting in found["type"]["settings"]}
    assert kinds <= {"string", "int32", "float", "bool"}
    *parts, merge = found["tasks"]
    assert [part["name"] for part in parts] == ["measure 1", "measure 2", "measure 3"]
    assert merge["needs"] == [part["name"] for part in parts]
    for task in found["tasks"]:
        for command in task["commands"]:
            assert command["name"] == "exec" and task["kind"] == "misc"
            words = [command["exe"], *command["args"]]
            if "--blender" in words and not BLENDER:
                at = words.index("--blender")
                del words[at : at + 2]
            ended = subprocess.run(words, capture_output=True, timeout=600)
            assert ended.returncode == 0, ended.stderr
    check(job, "a_job")
    settings.pop("parts")
    assert compiled(job, settings).returncode != 0
