# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that has loaded Blender, numpy and pytest, and forks itself for each run of tests that it is asked for.

    python -P server.py ROOT

A line of standard input is a job: {"tests": [[file, [name, ...]], ...], "seconds": s, "lines": file or null}; names may
be null for all of a file, and without parameters. A line of standard output is what came of it: {"outcome": "passed",
"failed", "killed", "timeout" or "broken", "test": the first that failed, "seconds": s}. With `lines`, all tests run,
and each one's outcome, time and the product's lines that it ran are written to that file.
"""

import contextlib
import importlib.util
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

ROOT = Path(sys.argv[1]).resolve()
MEMORY = 8 << 30
HERE = Path(__file__).resolve().parent
LIBRARIES = ("numpy", "bpy", "bmesh", "mathutils", "hypothesis", "mpmath", "pytest", "fractions")


def main() -> None:
    jobs, answers = take_pipes()
    load_libraries()
    for line in jobs:
        job = json.loads(line)
        answer = forked(lambda result, job=job: _run(job, result), job["seconds"])
        print(json.dumps(answer), file=answers)


def take_pipes() -> tuple[TextIO, TextIO]:
    """Standard input and output, of which no test has anything to read or write from then on."""
    jobs, answers = os.fdopen(os.dup(0), buffering=1), os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    return jobs, answers


def load_libraries() -> None:
    os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="body_moments_user_")
    for name in LIBRARIES:
        importlib.import_module(name)
    os.chdir(ROOT)


def load_conftest() -> None:
    """As pytest would first: it wants to be there before Blender, whose user folder this process has set."""
    hidden = sys.modules.pop("bpy")
    spec = importlib.util.spec_from_file_location("mutation_conftest", ROOT / "tests" / "conftest.py")
    spec.loader.exec_module(importlib.util.module_from_spec(spec))
    sys.modules["bpy"] = hidden


def forked(run: Callable[[str], None], seconds: float) -> dict:
    """What `run` wrote to the file that it was given, in a process of its own, within so many seconds."""
    folder = tempfile.mkdtemp(prefix="body_moments_mutant_")
    result = os.path.join(folder, "result")
    begun = time.monotonic()
    child = os.fork()
    if not child:
        try:
            os.setsid()
            _prepare_child(folder)
            run(result)
        finally:
            os._exit(0)
    is_over = False
    while not is_over and time.monotonic() - begun < seconds:
        time.sleep(0.01)
        is_over = os.waitpid(child, os.WNOHANG)[0] != 0
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    if not is_over:
        os.waitpid(child, 0)
    answer = {"outcome": "killed" if is_over else "timeout", "test": ""}
    if os.path.isfile(result):
        with open(result, encoding="utf-8") as file:
            answer = json.load(file)
    shutil.rmtree(folder, ignore_errors=True)
    return {**answer, "seconds": round(time.monotonic() - begun, 2)}


def _prepare_child(folder: str) -> None:
    output = os.open(os.path.join(folder, "output"), os.O_CREAT | os.O_WRONLY)
    os.dup2(output, 1)
    os.dup2(output, 2)
    os.environ["TMPDIR"] = tempfile.tempdir = folder
    os.environ["PYTHONPATH"] = str(HERE / "site")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def write_answer(result: str, outcome: dict) -> None:
    with open(result + ".part", "w", encoding="utf-8") as file:
        json.dump(outcome, file)
    os.replace(result + ".part", result)


def _run(job: dict, result: str) -> None:
    import pytest

    folder = os.path.dirname(result)
    if not job["lines"]:
        sys.dont_write_bytecode = True
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    outcome = {"outcome": "failed", "test": "(loading)"}
    try:
        load_conftest()
        plugin = _Lines(job) if job["lines"] else _Selection(job)
        options = ["-q", "-o", "cache_dir=" + os.path.join(folder, "cache"), "--basetemp", os.path.join(folder, "tmp")]
        code = pytest.main([*options, *(str(ROOT / file) for file, _ in job["tests"])], plugins=[plugin])
        outcome = plugin.outcome(code)
        if code not in (0, 1, 2) and outcome["outcome"] == "passed":
            outcome["outcome"] = "broken"
    except BaseException as error:
        outcome["test"] = "(loading) {!r}".format(error)[:200]
    write_answer(result, outcome)


class _Selection:
    """Runs the tests that are named, in the order of the job, until one fails."""

    def __init__(self, job: dict):
        self.place = {}
        for file, names in job["tests"]:
            for name in names or ():
                self.place[file + "::" + name] = len(self.place)
        self.all = {file for file, names in job["tests"] if names is None}
        self.failed = ""

    def pytest_sessionstart(self, session):
        self.session = session

    def pytest_collection_modifyitems(self, config, items):
        kept = [item for item in items if self.is_wanted(item)]
        items[:] = sorted(kept, key=lambda item: self.place.get(item.nodeid, -1))

    def is_wanted(self, item) -> bool:
        names = {item.nodeid, item.nodeid.partition("[")[0]}
        return not names.isdisjoint(self.place) or item.nodeid.partition("::")[0] in self.all

    def pytest_runtest_logreport(self, report):
        if report.failed and not self.failed:
            self.failed = report.nodeid

    def pytest_collectreport(self, report):
        if report.failed and not self.failed:
            self.failed = report.nodeid + " (collecting)"

    def pytest_runtest_logfinish(self, nodeid):
        if self.failed:
            self.session.shouldfail = True

    def outcome(self, code) -> dict:
        return {"outcome": "failed" if self.failed or code == 2 else "passed", "test": self.failed}


class _Lines(_Selection):
    """Runs all tests, and notes which lines of the product each runs, here and in processes that it starts."""

    def __init__(self, job: dict):
        super().__init__(job)
        sys.path.insert(0, str(HERE / "site"))
        import lines

        self.path, self.notes, self.lines = job["lines"], {}, lines
        lines.start(str(ROOT), os.path.join(tempfile.tempdir, "lines"))

    def pytest_runtest_logstart(self, nodeid):
        self.lines.reset()
        self.begun = time.monotonic()

    def pytest_runtest_logfinish(self, nodeid):
        seconds = time.monotonic() - self.begun
        ok = self.failed != nodeid
        self.failed = ""
        self.notes[nodeid] = {"ok": ok, "seconds": round(seconds, 3), "lines": self.lines.taken()}
        if len(self.notes) % 50 == 0:
            self.write()

    def write(self):
        with open(self.path + ".part", "w", encoding="utf-8") as file:
            json.dump(self.notes, file)
        os.replace(self.path + ".part", self.path)

    def outcome(self, code) -> dict:
        self.write()
        return {"outcome": "passed", "test": ""}


if __name__ == "__main__":
    main()
