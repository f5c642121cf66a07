# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line as a process, for what kills it and what reads its results."""

import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SCRIPT = str(ROOT / "operators" / "batch.py")
FAULTS = ("Traceback", "Internal error")


def start(*words, **options) -> subprocess.Popen:
    """`measure` with these words, its standard error as a pipe."""
    options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **options}
    return subprocess.Popen([sys.executable, SCRIPT, "measure", *map(str, words)], **options)


def run(*words, timeout=3600, **options) -> tuple[int, str]:
    """The exit code of `measure` with these words, and what it said."""
    process = start(*words, **options)
    try:
        _, said = process.communicate(timeout=timeout)
    finally:
        process.kill()
    return process.returncode, said.decode("utf-8", "replace")


def children(pid: int) -> list[int]:
    """The processes that a process has started and that are still there.

    Linux alone knows them so.
    """
    with suppress(OSError):
        return [
            int(word)
            for word in Path("/proc/{}/task/{}/children".format(pid, pid)).read_text().split()
        ]
    return []


def is_running(pid: int) -> bool:
    try:
        status = Path("/proc/{}/stat".format(pid)).read_text()
    except OSError:
        return False
    return status.rpartition(")")[2].split()[0] not in "ZX"


def kill(pid: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)


def wait_until(condition, seconds=30.0) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return condition()


def documents(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").split("\n") if line]


def check_documents(found: list[dict], paths: list[Path]) -> Counter:
    """Count the documents of each status; each file has exactly one document, in the order
    given.
    """
    assert [document["file"] for document in found] == [str(path) for path in paths]
    for document in found:
        assert (document["status"] == "ok") == (not document["errors"]), document["file"]
        reasons = [error["reason"] for error in document["errors"]]
        assert not [reason for reason in reasons if any(word in reason for word in FAULTS)], (
            document["file"],
            reasons,
        )
    return Counter(document["status"] for document in found)
