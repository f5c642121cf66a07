# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's commands, for any Python 3.11 or newer with nothing else installed.

    python tests/project.py demo         measure a real body: a report, a record and a picture
    python tests/project.py test         pass the tests, on every Blender there is
    python tests/project.py build        build the extension's zip into dist/
    python tests/project.py benchmark    times and ratios against trimesh and libigl
    python tests/project.py tables       the tables of Soldea, Elber and Rivlin beside ours
    python tests/project.py lint         check the rules, the format and the types

Each sets up what it needs in .envs/: one environment for each Blender that exists as a Python
module, with the Python which that module is made for. Environments are used again until their
requirements change. A real Blender, for the demo and for the window tests, is the one named by the
variable BLENDER, else (window tests only) `blender` on the PATH.
"""

import argparse
import functools
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TESTS = ROOT / "tests"
ENVS = ROOT / ".envs"
WINDOWS = os.name == "nt"
CI = os.environ.get("CI", "").lower() in ("1", "true", "yes")
RUNNING = "{}.{}".format(*sys.version_info)  # the version of the Python that runs this

# Blender as a module -> the Python which its wheel is made for
BLENDERS = {"4.5": "3.11", "5.2": "3.13"}
GROUPS = ("core", "blender", "corpus", "package", "window")
RUN_LIMIT = 1800  # seconds for one run of pytest
EXIT_LIMIT = 60  # seconds that an interpreter may take to end once its tests are over

NO_PYTHON = "Neither Python 3.11 nor 3.13 is here. Install one of them, or uv, and try again."
PROBE = """\
import ensurepip, platform, sys, venv
assert sys.maxsize > 2**32 and platform.python_implementation() == "CPython"
print("{}.{}".format(*sys.version_info), sys.executable, sep="|")
"""


class Failed(Exception):
    """Something did not work; the text says what, and what to do."""


# Commands of others


def clean_environment(**more: str) -> dict[str, str]:
    """The variables of this process without those that would change what the tests import."""
    drop = ("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "PYTEST_ADDOPTS", "VIRTUAL_ENV")
    kept = {name: value for name, value in os.environ.items() if name not in drop}
    return {**kept, "PYTHONNOUSERSITE": "1", "PYTHONPYCACHEPREFIX": str(ENVS / "pycache"), **more}


def call(command: list, what: str) -> str:
    """Run a command that must succeed and return its output, which is shown only when it fails."""
    done = subprocess.run(
        [str(part) for part in command],
        cwd=ROOT,
        env=clean_environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode:
        raise Failed(f"{done.stdout.rstrip()}\n{what} failed with exit code {done.returncode}.")
    return done.stdout


def show(command: list) -> int:
    """Run a command with its output on ours and return its exit code."""
    words = [str(part) for part in command]
    return subprocess.run(words, cwd=ROOT, env=clean_environment()).returncode


# Pythons and environments


def probe(command: list, version: str) -> str | None:
    """The executable behind a command, if it runs, is of that version and can make environments.

    That a command exists proves nothing: so do pyenv's shims, and Debian's Python without venv.
    """
    try:
        done = subprocess.run(
            [*map(str, command), "-c", PROBE],
            env=clean_environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            timeout=60,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    found, _, executable = done.stdout.strip().partition("|")
    return executable if done.returncode == 0 and found == version else None


def candidates(version: str) -> Iterator[list]:
    """Commands that may be a Python of that version, the surest first."""
    yield [sys.executable]
    for name in (f"python{version}", "python3", "python"):
        if path := shutil.which(name):
            yield [path]
    if launcher := shutil.which("py"):
        yield [launcher, f"-{version}"]
    pyenv = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv")
    for folder in (pyenv / "versions", pyenv / "pyenv-win" / "versions"):
        for home in sorted(folder.glob(f"{version}.*"), reverse=True):
            yield [home / ("python.exe" if WINDOWS else "bin/python")]


def python_of_uv(version: str) -> str | None:
    """A Python that uv knows or brings; uv itself is installed where it is not on the PATH."""
    uv = shutil.which("uv")
    if not uv:
        scripts = prepare("uv", sys.executable, RUNNING, ["requirements-uv.txt"]).parent
        uv = scripts / ("uv.exe" if WINDOWS else "uv")
    call([uv, "python", "install", version], f"uv python install {version}")
    path = call([uv, "python", "find", "--no-project", version], f"uv python find {version}")
    return probe([path.strip().splitlines()[-1]], version)


@functools.cache
def find_python(version: str) -> str | None:
    """A Python of that version, or None after a sentence about why there is none."""
    for command in candidates(version):
        if executable := probe(command, version):
            return executable
    print(f"There is no Python {version} here; asking uv for one ...", flush=True)
    try:
        if executable := python_of_uv(version):
            return executable
        reason = "what it brought does not run"
    except (Failed, OSError) as error:
        reason = str(error)
    print(f"{reason}\nuv could not bring a Python {version} either.", flush=True)
    return None


def prepare(name: str, python: str, version: str, requirements: list[str]) -> Path:
    """The Python of the environment .envs/<name>, which is made anew if it is old or broken."""
    folder = ENVS / name
    executable = folder / ("Scripts/python.exe" if WINDOWS else "bin/python")
    texts = [(TESTS / file).read_text(encoding="utf-8") for file in requirements]
    stamp = hashlib.sha256("\0".join([str(folder), version, *texts]).encode()).hexdigest()
    marker = folder / "complete"
    current = marker.is_file() and marker.read_text(encoding="utf-8") == stamp
    if current and probe([executable], version):
        return executable
    print(f"Setting up .envs/{name} ...", flush=True)
    ENVS.mkdir(exist_ok=True)
    call([python, "-m", "venv", "--clear", folder], f"Making the environment .envs/{name}")
    install = [executable, "-m", "pip", "install", "--disable-pip-version-check", "--no-input"]
    for file in requirements:
        install += ["-r", TESTS / file]
    call(install, f"Installing {' and '.join(requirements)}")
    marker.write_text(stamp, encoding="utf-8")
    return executable


def prepare_blender(version: str) -> Path | None:
    """The Python that has this Blender as a module, or None where there is no Python for it."""
    wanted = BLENDERS[version]
    if python := find_python(wanted):
        return prepare(f"blender-{version}", python, wanted, [f"requirements-{version}.txt"])
    return None


def any_blender() -> str:
    """The version of a Blender module that can be had: the running Python's, else the newest."""
    for version in sorted(BLENDERS, key=lambda key: (BLENDERS[key] == RUNNING, key), reverse=True):
        if find_python(BLENDERS[version]):
            return version
    raise Failed(NO_PYTHON)


# Running tests


class Runner:
    """Runs commands side by side, shows their lines as they come, and ends what does not end."""

    def __init__(self) -> None:
        self.processes: set[subprocess.Popen] = set()
        self.lock = threading.Lock()

    def kill(self, process: subprocess.Popen) -> None:
        if process.poll() is None:
            if WINDOWS:
                process.kill()
            else:  # with whatever it has started
                os.killpg(process.pid, signal.SIGKILL)

    def kill_all(self) -> None:
        for process in list(self.processes):
            self.kill(process)

    def watch(self, process: subprocess.Popen, result: Path) -> None:
        """End a process that runs for too long, or that goes on after its result is written."""
        started, written = time.monotonic(), None
        while process.poll() is None:
            now = time.monotonic()
            if written is None and result.is_file():
                written = now
            if now - started > RUN_LIMIT or (written and now - written > EXIT_LIMIT):
                self.kill(process)
            time.sleep(0.5)

    def run(self, label: str, command: list, result: Path) -> int:
        """Run a command to its end; its exit code, which is no small number if it was killed."""
        process = subprocess.Popen(
            [str(part) for part in command],
            cwd=ROOT,
            env=clean_environment(PYTHONUNBUFFERED="1"),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            start_new_session=not WINDOWS,
        )
        self.processes.add(process)
        threading.Thread(target=self.watch, args=(process, result), daemon=True).start()
        for line in process.stdout:
            with self.lock:
                print(f"[{label}] {line.rstrip()}", flush=True)
        code = process.wait()
        self.processes.discard(process)
        return code


def summary(counts: dict) -> str:
    return "{passed} passed, {failed} failed, {skipped} skipped".format(**counts)


def run_tests(runner: Runner, python: Path, version: str, group: str, extra: list[str]) -> dict:
    """Run one group of tests on one Blender; `failed` is at least 1 when anything went wrong.

    The exit code is pytest's own where the process ended by itself. bpy 4.5 can crash or hang while
    the interpreter shuts down; then the file that pytest's session wrote at its end counts, and
    without that file the run has failed.
    """
    label = f"{group} {version}"
    result = ENVS / "results" / f"{group}-{version}.json"
    result.parent.mkdir(exist_ok=True)
    result.unlink(missing_ok=True)
    command = [python, "-P", "-m", "pytest", "-q", "-rfEs", f"--result-file={result}"]
    command += [TESTS / group, *extra]
    started = time.monotonic()
    code = runner.run(label, command, result)
    if result.is_file():
        outcome = json.loads(result.read_text(encoding="utf-8"))
        if code in range(6):
            outcome["exit"] = code or outcome["exit"]
        else:
            print(f"[{label}] exit code {code} came after the tests were over", flush=True)
    else:
        print(f"[{label}] exit code {code} came before the tests were over", flush=True)
        outcome = {"passed": 0, "failed": 0, "skipped": 0, "exit": code or 1}
    nothing_selected = outcome["exit"] == 5 and extra
    if outcome["exit"] and not nothing_selected:
        outcome["failed"] = max(outcome["failed"], 1)
    seconds = time.monotonic() - started
    print(f"[{label}] {summary(outcome)} in {seconds:.0f} s", flush=True)
    return outcome


# The project's commands


def test(options: argparse.Namespace) -> int:
    """Pass the tests: both Blenders side by side, then the window's alone, then what `lint` checks."""
    groups = options.only or GROUPS
    extra = [*options.pytest, *(["-k", options.k] if options.k else [])]
    runner, outcomes, left_out = Runner(), [], []
    for version, wanted in BLENDERS.items():  # one after the other: this may install uv
        if not find_python(wanted):
            left_out.append(f"No test ran on Blender {version}: it needs Python {wanted}.")
    if len(left_out) == len(BLENDERS):
        raise Failed(NO_PYTHON)
    versions = [version for version, wanted in BLENDERS.items() if find_python(wanted)]

    def lane(version: str) -> list[dict]:
        python = prepare_blender(version)
        mine = [group for group in groups if group != "window"]
        return [run_tests(runner, python, version, group, extra) for group in mine]

    with ThreadPoolExecutor() as pool:
        try:
            for lane_outcomes in pool.map(lane, versions):
                outcomes += lane_outcomes
        except BaseException:
            runner.kill_all()
            raise
    if "window" in groups:  # alone: drawing without a graphics card takes both cores
        version = max(versions)
        outcomes.append(run_tests(runner, prepare_blender(version), version, "window", extra))

    words = ("passed", "failed", "skipped")
    total = {word: sum(outcome[word] for outcome in outcomes) for word in words}
    if groups is GROUPS and not extra and lint(options):
        total["failed"] += 1
    for sentence in left_out:
        print(sentence)
    if CI:  # there, nothing may be left out
        total["failed"] += len(left_out)
    if not any(total.values()):
        print("No test was selected.")
        total["failed"] = 1
    print(summary(total), flush=True)
    return 1 if total["failed"] else 0


def demo(options: argparse.Namespace) -> int:
    """Measure a real body in .blend: its report, its record and a picture."""
    out = ROOT / "demo"
    out.mkdir(exist_ok=True)
    body, record, picture = out / "bracket.blend", out / "measure.json", out / "picture.png"
    script, batch = TESTS / "demo.py", ROOT / "operators" / "batch.py"
    measure = ["measure", "--object", "Bracket", "--density", "2700", "--output", record]
    if blender := os.environ.get("BLENDER"):
        name = f"the Blender at {blender}"
        plain = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
        plain += ["--python", script, "--"]
        opened = [blender, "--background", "-Y", body, "--python-exit-code", "70"]
        measure = [*opened, "--python", batch, "--", *measure]
    else:
        version = any_blender()
        python = prepare_blender(version)
        name = f"Blender {version} as a Python module"
        plain = [python, script]
        measure = [python, batch, *measure, body]
    for file in (body, record, picture):
        file.unlink(missing_ok=True)
    print(f"Using {name}.\nBuilding a bracket of aluminium ...", flush=True)
    call([*plain, "build", body], "Building the body")
    print("Measuring it: operators/batch.py measure --density 2700 ...", flush=True)
    call(measure, "Measuring the body")
    print("Drawing it with its principal axes ...\n", flush=True)
    call([*plain, "picture", body, record, picture], "Drawing the picture")
    print(call([sys.executable, script, "report", record], "Reading the record"))
    for file in (record, picture):
        if not file.is_file():
            raise Failed(f"{file.relative_to(ROOT)} was not written.")
    print(f"The record is {record.relative_to(ROOT)}, the picture {picture.relative_to(ROOT)}.")
    return 0


def build(options: argparse.Namespace) -> int:
    python = prepare_blender(any_blender())
    return show([python, "-P", TESTS / "package" / "extension.py", ROOT / "dist"])


def benchmark(options: argparse.Namespace) -> int:
    version = any_blender()
    wanted = BLENDERS[version]
    requirements = [f"requirements-{version}.txt", "requirements-benchmark.txt"]
    python = prepare("benchmark", find_python(wanted), wanted, requirements)
    return show([python, "-P", TESTS / "benchmark.py", *options.arguments])


def tables(options: argparse.Namespace) -> int:
    return show([prepare_blender(any_blender()), "-P", TESTS / "paper_tables.py"])


def lint(options: argparse.Namespace) -> int:
    """Check the rules, the format and the types: all three, whatever the first ones say."""
    python = prepare("lint", sys.executable, RUNNING, ["requirements-lint.txt"])
    checks = (
        ["ruff", "check", "--no-cache", ROOT],
        ["ruff", "format", "--check", "--no-cache", ROOT],
        ["basedpyright", "--project", ROOT / "pyproject.toml", "--pythonpath", python],
    )
    return int(any([show([python, "-m", *check]) for check in checks]))  # a list: none is skipped


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="project.py", description="Sets up what it needs and runs one of the commands."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for function, text in (
        (demo, "measure a real body"),
        (test, "pass the tests"),
        (build, "build the extension's zip"),
        (benchmark, "times and ratios against trimesh and libigl"),
        (tables, "the paper's tables of trivariate densities beside ours"),
        (lint, "check the rules, the format and the types"),
    ):
        command = commands.add_parser(function.__name__, help=text)
        command.set_defaults(function=function)
        if function is test:
            command.add_argument("--only", action="append", choices=GROUPS, help="repeatable")
            command.add_argument("-k", metavar="WORDS", help="tests with such names, as in pytest")
            command.add_argument("pytest", nargs="*", help="for pytest, after --")
        if function is benchmark:
            command.add_argument("arguments", nargs=argparse.REMAINDER, help="for benchmark.py")
    options = parser.parse_args()
    try:
        return options.function(options)
    except Failed as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
