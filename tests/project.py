# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The project's commands, for any Python 3.11 or newer with nothing else installed.

    python3 tests/project.py demo         measure a real body: a report, a record and a picture
    python3 tests/project.py test         pass the tests, on every Blender there is
    python3 tests/project.py test solid   pass those of one subject on one Blender, in seconds
    python3 tests/project.py test core/solid   pass those of one folder of the core, with numpy
                                               alone
    python3 tests/project.py build        build the extension's zip, and the wheel for Python, into
                                          dist/
    python3 tests/project.py lint         check the rules, the format and the types

and what is run by hand, from the folder tools:

    python3 tests/project.py benchmark    times beside an earlier build and other programs
    python3 tests/project.py batch        the cost of measuring 400 files in one process or several
    python3 tests/project.py tables       the tables of Soldea, Elber and Rivlin beside ours
    python3 tests/project.py film         the film of the thrown crates in the manual
    python3 tests/project.py retrieval    the rate at which moved and noisy parts are recognized
    python3 tests/project.py robots       audit robots of the Python index: the manual's page
    python3 tests/project.py alarms       faults planted in them that are found; alarms confirmed
    python3 tests/project.py soak         what takes long: hostile files, kills, random damage, ...

Each sets up what it needs in .envs/, and no more: one environment for each Blender that exists as a
Python module, with the Python which that module is made for. Environments are used again until
their requirements change. Libraries that the module lacks are installed on Debian and Ubuntu, if
the user may. A real Blender, for the demo and for the window tests, is the one that the variable
BLENDER names, else (window tests only) `blender` on the PATH. The window tests pass on the one that
BLENDER_45 names, too.
"""

import argparse
import contextlib
import functools
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TESTS = ROOT / "tests"
TOOLS = ROOT / "tools"
ENVS = ROOT / ".envs"
WINDOWS = os.name == "nt"
CI = os.environ.get("CI", "").lower() in ("1", "true", "yes")
RUNNING = "{}.{}".format(*sys.version_info)  # the version of the Python that runs this

# Blender as a module -> the Python which its wheel is made for
BLENDERS = {"4.5": "3.11", "5.2": "3.13"}
# group of tests -> minutes on one of two idle cores; the window's comes alone, after all the others
GROUPS = {
    **{"core": 4, "blender": 3, "command": 3, "operators": 2, "panels": 1},
    **{"corpus": 2, "package": 2, "robots": 1, "window": 5},
}
SUBJECT_GROUPS = ("core", "blender", "command", "operators", "panels")  # where `test SUBJECT` looks
# seconds without a line of output after which a run of pytest has hung: no file takes 2 minutes
SILENCE_LIMIT = 1800
EXIT_LIMIT = 240  # seconds that an interpreter may take to end once its tests are over
INTERRUPT_LIMIT = 10  # seconds that what was interrupted may take to clean up

# What the tests need beside a Blender: pytest and others, and what builds the manual and the wheel.
TESTED = ("tests", "build")
# command -> its script in the folder tools, requirements beside a Blender, and help
TOOLBOX = {
    "benchmark": (
        "benchmark.py",
        ("benchmark",),
        "times beside an earlier build, trimesh, libigl, vtk and CoACD; --quick, --against COMMIT",
    ),
    "batch": (
        "benchmark_batch.py",
        (),
        "the cost of measuring 400 files in one process or several",
    ),
    "tables": ("paper_tables.py", (), "the paper's tables of trivariate densities beside ours"),
    "film": ("tumbling.py", ("tools",), "the film of the thrown crates in the manual"),
    "retrieval": ("retrieval.py", (), "the rate at which moved and noisy parts are recognized"),
    "robots": ("published_robots.py", ("tools",), "audit robots of the Python index"),
    "alarms": (
        "robot_alarms.py",
        ("benchmark", "tools"),
        "faults planted in these robots that are found, and alarms that trimesh and others confirm",
    ),
    "consumers": ("robot_consumers.py", (), "load exported robots in all programs that read them"),
    "soak": (
        "soak",
        TESTED,
        "what takes long: hostile files, kills, random damage; --minutes N, --seed S, names",
    ),
}

INSTALL = ["apt-get", "install", "-y", "--no-install-recommends"]
INSTALLING = threading.Lock()  # apt-get refuses to run twice at a time
NO_PYTHON = (
    "Neither Python 3.11 nor 3.13 with venv is here. Install one of them, or uv, and try again."
)
NO_LIBRARIES = """\
Blender cannot be loaded: {}
On Debian and Ubuntu its libraries come by

    sudo {}

elsewhere by the same names without numbers (Fedora: libX11, libXi, libglvnd-glx, ...); macOS and
Windows have them."""
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


class Children:
    """The processes that run for this one, each with a process group of its own, so that none
    outlives it.
    """

    def __init__(self) -> None:
        self.running: set[subprocess.Popen] = set()
        self.stopped = False

    @contextlib.contextmanager
    def start(self, command: list, **options) -> Iterator[subprocess.Popen]:
        if self.stopped:
            raise Failed("Interrupted.")
        words = [str(part) for part in command]
        text = {"encoding": "utf-8", "errors": "replace"}
        options = {
            "cwd": ROOT,
            "env": clean_environment(),
            "start_new_session": not WINDOWS,
            **text,
            **options,
        }
        process = subprocess.Popen(words, **options)
        self.running.add(process)
        try:
            if self.stopped:  # while it was being started
                self.kill(process)
            yield process
            process.wait()
        finally:
            self.kill(process)
            self.running.discard(process)

    def kill(self, process: subprocess.Popen, sign: str = "SIGKILL") -> None:
        """End a process with whatever it has started."""
        if WINDOWS:
            if process.poll() is None:
                subprocess.run(
                    ["taskkill", "/T", "/F", "/PID", str(process.pid)], capture_output=True
                )
        else:  # the group may outlive its leader
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, getattr(signal, sign))

    def stop(self) -> None:
        """Interrupt everything, and kill what has not cleaned up soon."""
        self.stopped = True
        left = list(self.running)
        try:
            for process in left:
                self.kill(process, "SIGINT")
            end = time.monotonic() + INTERRUPT_LIMIT
            while time.monotonic() < end and any(process.poll() is None for process in left):
                time.sleep(0.1)
        finally:
            for process in left:
                self.kill(process)


children = Children()


def call(command: list, what: str) -> str:
    """Run a command that must succeed and return its output, which is shown only when it fails."""
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    with children.start(command, **pipes) as process:
        output = process.stdout.read()
    if process.returncode:
        raise Failed(f"{output.rstrip()}\n{what} failed with exit code {process.returncode}.")
    return output


def show(command: list) -> int:
    """Run a command with its output on ours and return its exit code."""
    with children.start(command) as process:
        return process.wait()


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
            timeout=240,
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
        scripts = prepare("uv", sys.executable, RUNNING, ["uv"]).parent
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
    """Return the Python of the environment .envs/<name> with these requirements installed.

    Missing ones are added; an environment with outdated ones, or a broken one, is made anew.
    """
    folder = ENVS / name
    executable = folder / ("Scripts/python.exe" if WINDOWS else "bin/python")
    marker = folder / "complete.json"
    installed = json.loads(marker.read_text(encoding="utf-8")) if marker.is_file() else {}
    current = {file: stamp(folder, version, file) for file in {*installed, *requirements}}
    if installed.items() - current.items() or not probe([executable], version):
        installed = {}
    missing = [file for file in requirements if file not in installed]
    if not missing:
        return executable
    print(f"Setting up .envs/{name}: {', '.join(missing)} ...", flush=True)
    if not installed:
        ENVS.mkdir(exist_ok=True)
        call([python, "-m", "venv", "--clear", folder], f"Making the environment .envs/{name}")
    install = [executable, "-m", "pip", "install", "--disable-pip-version-check", "--no-input"]
    for file in missing:
        install += ["-r", TESTS / f"requirements-{file}.txt"]
    call(install, f"Installing {' and '.join(missing)}")
    marker.write_text(json.dumps({**installed, **{file: current[file] for file in missing}}))
    return executable


def stamp(folder: Path, version: str, file: str) -> str:
    """Return the digest that an environment keeps of a file of requirements."""
    path = TESTS / f"requirements-{file}.txt"
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    return hashlib.sha256("\0".join([str(folder), version, text]).encode()).hexdigest()


def prepare_blender(version: str, *additions: str, name: str = "") -> Path | None:
    """Return the Python that has this Blender as a module and additional requirements.

    `name`: an environment of their own. None if no Python fits.
    """
    wanted = BLENDERS[version]
    if not (python := find_python(wanted)):
        return None
    executable = prepare(name or f"blender-{version}", python, wanted, [version, *additions])
    with INSTALLING:
        if find_load_problem(executable):
            packages = re.search(
                "^Blender: (.*)", (TESTS / "packages-debian.txt").read_text(), re.MULTILINE
            )[1].split()
            install_packages(packages)
            if problem := find_load_problem(executable):
                raise Failed(NO_LIBRARIES.format(problem, " ".join([*INSTALL, *packages])))
    return executable


def find_load_problem(python: Path) -> str:
    """Return the last line of the error that Blender's module gives when it is loaded, or
    nothing.
    """
    command = [python, "-P", "-c", "import os, bpy; os._exit(0)"]  # bpy 4.5 can crash at the end
    done = subprocess.run(
        command, env=clean_environment(), capture_output=True, encoding="utf-8", errors="replace"
    )
    return done.stderr.strip().rpartition("\n")[2] if done.returncode else ""


def install_packages(packages: list[str]) -> None:
    """Install packages on Debian and Ubuntu, if the user may without a password."""
    sudo = [] if WINDOWS or os.geteuid() == 0 else ["sudo", "-n"]
    try:
        call([*sudo, "apt-get", "--version"], "apt-get")
    except (Failed, OSError):
        return
    print(f"Installing {' '.join(packages)} ...", flush=True)
    with contextlib.suppress(Failed):  # old lists of packages may do
        call([*sudo, "apt-get", "update"], "apt-get update")
    call([*sudo, *INSTALL, *packages], "apt-get install")


def prepare_consumers(version: str) -> Path:
    """The Python that has what reads robots' files, and no Blender; of the version that this
    Blender is made for.
    """
    wanted = BLENDERS[version]
    return prepare("robots", find_python(wanted), wanted, ["robots"])


def prepare_core() -> Path:
    """Return the Python of the environment for the tests of the core: numpy and no Blender, on the
    running version.
    """
    return prepare("core", sys.executable, RUNNING, ["core"])


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
        self.started = time.monotonic()
        self.lock = threading.Lock()

    def print(self, label: str, text: str) -> None:
        minutes, seconds = divmod(int(time.monotonic() - self.started), 60)
        with self.lock:
            print(f"{minutes:3d}:{seconds:02d} [{label}] {text}", flush=True)

    def watch(self, process: subprocess.Popen, result: Path, heard: list[float]) -> None:
        """End a process that has fallen silent, or that goes on after its result is written."""
        written = None
        while process.poll() is None:
            now = time.monotonic()
            if written is None and result.is_file():
                written = now
            if now - heard[-1] > SILENCE_LIMIT or (written and now - written > EXIT_LIMIT):
                children.kill(process)
            time.sleep(0.5)
        children.kill(process)  # what it has left behind would keep its output open

    def run(self, label: str, command: list, result: Path, **variables: str) -> int:
        """Run a command to its end; its exit code, which is no small number if it was killed."""
        pipes = {
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
        }
        heard = [time.monotonic()]
        with children.start(
            command, env=clean_environment(PYTHONUNBUFFERED="1", **variables), **pipes
        ) as process:
            threading.Thread(target=self.watch, args=(process, result, heard), daemon=True).start()
            for line in process.stdout:
                heard[-1] = time.monotonic()
                if line.strip():
                    self.print(label, line.rstrip())
            return process.wait()


def summary(counts: dict) -> str:
    return "{passed} passed, {failed} failed, {skipped} skipped".format(**counts)


def run_tests(
    runner: Runner,
    python: Path,
    version: str,
    group: str,
    extra: list[str],
    files: list[Path] | None = None,
    **variables: str,
) -> dict:
    """Run a group of tests, or some files of it, on one Blender; `failed` is at least 1 when
    anything went wrong.

    The exit code is pytest's own where the process ended by itself. bpy 4.5 can crash or hang while
    the interpreter shuts down; then the file that pytest's session wrote at its end counts, and
    without that file the run has failed.
    """
    label = f"{group} {version}"
    result = ENVS / "results" / f"{group}-{version}.json"
    result.parent.mkdir(exist_ok=True)
    result.unlink(missing_ok=True)
    command = [python, "-P", "-m", "pytest", "-q", "-rfE", "-o", "console_output_style=classic"]
    command += [f"--result-file={result}", *(files or [TESTS / group]), *extra]
    started = time.monotonic()
    code = runner.run(label, command, result, **variables)
    if result.is_file():
        outcome = json.loads(result.read_text(encoding="utf-8"))
        if code in range(6):
            outcome["exit"] = code or outcome["exit"]
        else:
            runner.print(label, f"exit code {code} came after the tests were over")
    else:
        runner.print(label, f"exit code {code} came before the tests were over")
        outcome = {
            "passed": 0,
            "failed": 0,
            "skipped": 0,
            "left_out": {},
            "failures": [],
            "exit": code or 1,
        }
    nothing_selected = outcome["exit"] == 5 and extra
    if outcome["exit"] and not nothing_selected:
        outcome["failed"] = max(outcome["failed"], 1)
    outcome["failures"] = [f"{label}: {name}" for name in outcome["failures"]]
    seconds = time.monotonic() - started
    runner.print(label, f"{summary(outcome)} in {seconds:.0f} s")
    return outcome


def in_lanes(function: Callable, lanes: Iterable) -> list[dict]:
    """Call a function that gives outcomes for each lane, side by side."""
    with ThreadPoolExecutor() as pool:
        try:
            return [outcome for outcomes in pool.map(function, lanes) for outcome in outcomes]
        except BaseException:
            children.stop()
            raise


def finish(outcomes: list[dict], remarks: Iterable[str] = (), failed: int = 0) -> int:
    """Print the tests that were left out, by reason, that failed, and the total; return the
    command's exit code.
    """
    total = {
        word: sum(outcome[word] for outcome in outcomes) for word in ("passed", "failed", "skipped")
    }
    total["failed"] += failed
    left_out = sum((Counter(outcome["left_out"]) for outcome in outcomes), Counter())
    for reason, count in left_out.most_common():
        tests, need = ("tests", "that need") if count > 1 else ("test", "that needs")
        print(f"Left out: {count} {tests} {re.sub('^needs', need, reason)}")
    for sentence in remarks:
        print(sentence)
    if not any(total.values()):
        print("No test was selected.")
        total["failed"] = 1
    for name in (name for outcome in outcomes for name in outcome["failures"]):
        print(f"FAILED {name}")
    print(summary(total), flush=True)
    return 1 if total["failed"] else 0


# Subjects


def subjects() -> dict[str, dict[str, list[Path]]]:
    """The files of each subject by group: those in folders of its name, and those whose own name
    has the word.
    """
    result = {}
    for group in SUBJECT_GROUPS:
        for path in sorted((TESTS / group).rglob("test_*.py")):
            folders = path.relative_to(TESTS / group).parts[:-1]
            for word in {*folders, *path.stem.split("_")[1:]}:
                result.setdefault(word, {}).setdefault(group, []).append(path)
    return result


def test_folder(name: str, extra: list[str]) -> int:
    """Pass the tests of one folder, given by its path: those of the core with numpy alone, others
    on one Blender.
    """
    folder = TESTS / name.strip("/").removeprefix("tests/")
    group = folder.relative_to(TESTS).parts[0]
    if group not in SUBJECT_GROUPS or not folder.is_dir():
        raise Failed(f"{name} is no folder of code with tests: try core/solid or blender/read.")
    version = f"Python {RUNNING}" if group == "core" else any_blender()
    python = prepare_core() if group == "core" else prepare_blender(version, *TESTED)
    return finish([run_tests(Runner(), python, version, group, extra, [folder])])


def test_subject(subject: str, extra: list[str]) -> int:
    """Pass the tests of one subject on one Blender: those that need no Blender beside those that
    do.
    """
    if "/" in subject:
        return test_folder(subject, extra)
    known = subjects()
    if subject not in known:
        folders = {
            path.name
            for group in SUBJECT_GROUPS
            for path in (TESTS / group).rglob("*/")
            if path.is_dir()
        }
        names = ", ".join(sorted(folders - {"__pycache__"}))
        raise Failed(
            f"No tests are about {subject!r}. Folders: {names}; or a word of a test file's name."
        )
    version = any_blender()
    python = prepare_blender(version, *TESTED)
    print(
        f"The tests of {subject}, on Blender {version} alone; at most half a minute on two cores."
    )
    runner, groups = Runner(), known[subject]
    return finish(
        in_lanes(
            lambda name: [run_tests(runner, python, version, name, extra, groups[name])], groups
        )
    )


# The project's commands


def test(options: argparse.Namespace) -> int:
    """Pass the tests and what `lint` checks: both Blenders side by side, then the window's
    alone.
    """
    extra = [*options.arguments, *(["-k", options.k] if options.k else [])]
    if options.subject:
        return test_subject(options.subject, extra)
    groups = options.only or list(GROUPS)
    # this may install uv
    versions = [version for version, wanted in BLENDERS.items() if find_python(wanted)]
    if not versions:
        raise Failed(NO_PYTHON)
    absent = BLENDERS.keys() - versions
    remarks = [
        f"Left out: the half on Blender {version}, which needs Python {BLENDERS[version]}"
        for version in absent
    ]
    if "window" in groups and not (os.environ.get("BLENDER") or shutil.which("blender")):
        groups = [group for group in groups if group != "window"]
        remarks.append(
            "Left out: the window tests, which need a real Blender: on the PATH, or named by "
            "BLENDER"
        )
    minutes = sum(GROUPS[group] for group in groups)
    print(
        f"Tests of {', '.join(groups)} on Blender {' and '.join(versions)}: about {minutes} minutes"
        " on two idle cores,"
        " four times that on a slow machine. Environments that are not there yet come first.",
        flush=True,
    )
    runner, failures = Runner(), [len(absent)] if CI else []

    def lane(version: str) -> list[dict]:
        python = prepare_blender(version, *TESTED)
        mine = [group for group in groups if group not in ("robots", "window")]
        outcomes = [run_tests(runner, python, version, group, extra) for group in mine]
        if "robots" in groups and version == max(versions):
            outcomes.append(run_tests(runner, prepare_consumers(version), version, "robots", extra))
        if version == min(versions) and not options.only and not extra:
            failures.append(lint(options))
        return outcomes

    outcomes = in_lanes(lane, versions)
    if "window" in groups:  # alone: drawing without a graphics card takes both cores
        version = max(versions)
        python = prepare_blender(version, *TESTED)
        outcomes.append(run_tests(runner, python, version, "window", extra))
        if older := os.environ.get("BLENDER_45"):
            outcomes.append(run_tests(runner, python, "4.5", "window", extra, BLENDER=older))
        else:
            remarks.append("Left out: the window of Blender 4.5: BLENDER_45 names none")
    return finish(outcomes, remarks, sum(failures))


def demo(options: argparse.Namespace) -> int:
    """Measure a real body in .blend: its report, its record and a picture."""
    out = ROOT / "demo"
    out.mkdir(exist_ok=True)
    body, record, picture = out / "bracket.blend", out / "measure.json", out / "picture.png"
    script, batch = TOOLS / "demo.py", ROOT / "operators" / "batch.py"
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
    python = prepare_blender(any_blender(), "build")
    zipped = show([python, "-P", TOOLS / "extension.py", ROOT / "dist"])
    wheel = ["-m", "build", "--wheel", "--no-isolation", "--outdir", ROOT / "dist", ROOT]
    return show([python, "-P", *wheel]) or zipped


def tool(options: argparse.Namespace) -> int:
    """Run a script of the folder tools; reports of `soak` are in .envs/soak/."""
    script, additions, _ = TOOLBOX[options.tool]
    name = additions[0] if additions and additions != TESTED else ""
    python = prepare_blender(any_blender(), *additions, name=name)
    return show([python, TOOLS / script, *options.arguments])


def lint(options: argparse.Namespace) -> int:
    """Check the rules, the format and the types: all three, whatever the first ones say."""
    python = prepare("lint", sys.executable, RUNNING, ["lint"])
    checks = (
        ["ruff", "check", "--no-cache", ROOT],
        ["ruff", "format", "--check", "--no-cache", ROOT],
        ["basedpyright", "--project", ROOT / "pyproject.toml", "--pythonpath", python],
    )
    return int(any([show([python, "-m", *check]) for check in checks]))  # a list: none is skipped


def parse(words: list[str]) -> argparse.Namespace:
    """The command and its options; `arguments` are those for what it calls."""
    parser = argparse.ArgumentParser(
        prog="project.py", description="Sets up what it needs and runs one of the commands."
    )
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, (_, _, text) in TOOLBOX.items():
        commands.add_parser(name, help=text).set_defaults(function=tool, tool=name)
    for function, text in (
        (demo, "measure a real body"),
        (test, "pass the tests"),
        (build, "build the extension's zip and the wheel"),
        (lint, "check the rules, the format and the types"),
    ):
        command = commands.add_parser(function.__name__, help=text)
        command.set_defaults(function=function)
        if function is test:
            command.add_argument(
                "subject",
                nargs="?",
                help="solid, nurbs, ...: its tests on one Blender; core/solid: with numpy alone",
            )
            command.add_argument("--only", action="append", choices=GROUPS, help="repeatable")
            command.add_argument("-k", metavar="WORDS", help="tests with such names, as in pytest")
            command.epilog = "What follows -- is for pytest."
    own, arguments = words, []
    if words and words[0] in TOOLBOX:  # argparse would take options for the parser's own
        own, arguments = words[:1], words[1:]
    elif words[:1] == ["test"] and "--" in words:
        split = words.index("--")
        own, arguments = words[:split], words[split + 1 :]
    return argparse.Namespace(**vars(parser.parse_args(own)), arguments=arguments)


def main() -> int:
    options = parse(sys.argv[1:])
    # a shell's job in the background has the first ignored
    for name in (
        "SIGINT",
        "SIGTERM",
        "SIGHUP",
    ):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.default_int_handler)
    try:
        return options.function(options)
    except Failed as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        children.stop()
        print("Interrupted.", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
