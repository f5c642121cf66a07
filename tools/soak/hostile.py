# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile files through the real command: each has one record with a status that it may have,
nothing is obeyed.

1,000 files and more where the budget allows it; then fuzzed ones with new seeds until it is used
up.
"""

import tempfile
import time
from collections import Counter
from pathlib import Path

from tools.soak import commands, hostile_files

TIMEOUT = 20


def run(budget_seconds: float, seed: int, fuzzed: int = 900) -> str:
    """Measure them all, in rounds; the report counts statuses and lists what ended its child."""
    end, total, killers = time.monotonic() + budget_seconds, Counter(), []
    with tempfile.TemporaryDirectory(prefix="body_moments_hostile_") as name:
        folder = Path(name)
        marker = folder / "marker"
        cases = hostile_files.write_cases(folder / "cases", marker)
        paths = [*cases, *hostile_files.write_cut(folder / "cut")]
        paths += hostile_files.write_damaged(folder / "fuzzed", fuzzed, seed)
        while True:
            found = measured(paths, folder)
            total += commands.check_documents(found, paths)
            for document in found:
                expected = cases.get(Path(document["file"]), hostile_files.STATUSES - {"missing"})
                assert document["status"] in expected, (
                    document["file"],
                    document["status"],
                    document["errors"],
                )
                if document["status"] in ("crashed", "timeout", "memory"):
                    killers.append("{} {}".format(document["status"], Path(document["file"]).name))
            assert not marker.exists(), "a script of a file has run"
            seed += 1
            if time.monotonic() >= end:
                break
            paths, cases = (
                hostile_files.write_damaged(folder / "fuzzed {}".format(seed), 300, seed),
                {},
            )
    text = "{} files: {}".format(
        total.total(), ", ".join("{} {}".format(*one) for one in total.most_common())
    )
    return text + "".join("\n  " + killer for killer in killers[:50])


def measured(paths: list[Path], folder: Path) -> list[dict]:
    result = folder / "result.jsonl"
    listed = folder / "list"
    listed.write_text(
        "".join(hostile_lines(paths)),
        encoding="ascii",
    )
    words = (
        "--manifest",
        listed,
        "--timeout",
        TIMEOUT,
        "--format",
        "jsonl",
        "--output",
        result,
        "--memory-mb",
        2500,
    )
    code, said = commands.run(*words)
    assert code == 1 and "Traceback" not in said, (code, said[-2000:])
    left = {path.name for path in folder.iterdir() if path.name.startswith(".")}
    assert not left, left
    return commands.documents(result)


def hostile_lines(paths: list[Path]) -> list[str]:
    from body_moments.command.supervisor.listing import write_lines

    return list(write_lines(map(str, paths)))
