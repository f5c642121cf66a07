# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Children and supervisors are killed at random moments: no file is lost or counted twice, nothing
stays behind.

Needs Linux, whose /proc lists children.
"""

import random
import signal
import tempfile
import time
from pathlib import Path

import numpy as np

from tools.soak import commands


def run(
    budget_seconds: float, seed: int, children: int = 20, supervisors: int = 5, files: int = 60
) -> str:
    """One run with kills of children, and one whose supervisor is killed and goes on, until the
    budget is used up.
    """
    end, chance, rounds = time.monotonic() + budget_seconds, random.Random(seed), 0
    while True:
        with tempfile.TemporaryDirectory(prefix="body_moments_kills_") as name:
            paths = _files(Path(name) / "files", files)
            _kill_children(paths, Path(name), children, chance)
            _kill_supervisors(paths, Path(name), supervisors, chance)
        rounds += 1
        if time.monotonic() >= end:
            break
    return "{} kills of children, {} of supervisors".format(rounds * children, rounds * supervisors)


def _files(folder: Path, count: int) -> list[Path]:
    """Scans that take some time each, with masses that tell them apart."""
    folder.mkdir()
    paths = [folder / "scan {:04d}.npy".format(number) for number in range(count)]
    for number, path in enumerate(paths):
        np.save(path, np.full((60, 60, 60), number + 1, "u2"))
    return paths


def _lines(result: Path) -> int:
    """Count the recorded files."""
    journal = result.with_name(result.name + ".journal")
    return journal.read_bytes().count(b"\n") if journal.exists() else 0


def _check(result: Path, paths: list[Path], *, damaged: int) -> None:
    found = commands.documents(result)
    counts = commands.check_documents(found, paths)
    assert counts["ok"] >= len(paths) - damaged and set(counts) <= {"ok", "crashed"}, counts
    for number, document in enumerate(found):
        if document["status"] == "ok":
            assert document["objects"][0]["mass"] == 216000.0 * (number + 1)


def _kill_children(paths: list[Path], folder: Path, count: int, chance: random.Random) -> None:
    result = folder / "children.jsonl"
    process = commands.start(paths[0].parent, "--jobs", 2, "--format", "jsonl", "--output", result)
    killed = 0
    while process.poll() is None:
        victims = commands.children(process.pid)
        if killed < count and victims:
            before = _lines(result)
            commands.kill(chance.choice(victims))
            killed += 1
            commands.wait_until(
                lambda before=before: process.poll() is not None or _lines(result) > before
            )
            time.sleep(chance.uniform(0.0, 0.1))
        else:
            time.sleep(0.05)
    said = process.stderr.read().decode()
    assert process.returncode in (0, 1), said[-2000:]
    _check(result, paths, damaged=count // 2)  # A file may be hit twice.
    _check_nothing_left(folder, {"files", result.name, result.name + ".journal"})


def _kill_supervisors(paths: list[Path], folder: Path, count: int, chance: random.Random) -> None:
    result = folder / "supervisors.jsonl"
    words = (paths[0].parent, "--jobs", 2, "--format", "jsonl", "--output", result)
    journal = result.with_name(result.name + ".journal")
    resume = ()
    for number in range(count):
        process = commands.start(*words, *resume)
        done = _lines(result)
        wanted = done + chance.randrange(len(paths) // (count + 1))
        commands.wait_until(
            lambda wanted=wanted, process=process: (
                process.poll() is not None or _lines(result) >= wanted
            )
        )
        time.sleep(chance.uniform(0.0, 0.05))
        born = commands.children(process.pid)
        process.send_signal(
            chance.choice((signal.SIGKILL, signal.SIGKILL, signal.SIGTERM))
            if number
            else signal.SIGKILL
        )
        process.wait(20)
        assert commands.wait_until(
            lambda born=born: not any(map(commands.is_running, born)), 5.0
        ), "children survive"
        resume = ("--resume",)
    code, said = commands.run(*words, "--resume")
    assert code == 0, said[-2000:]
    _check(result, paths, damaged=0)
    lines = journal.read_bytes().splitlines()
    assert len(lines) <= len(paths) + count, "files were measured again"
    _check_nothing_left(
        folder,
        {"files", *(path.name for path in folder.glob("children.*")), result.name, journal.name},
    )


def _check_nothing_left(folder: Path, expected: set[str]) -> None:
    assert {path.name for path in folder.iterdir()} == expected
