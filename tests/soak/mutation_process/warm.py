# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that has loaded Blender, the product and all tests, and forks itself for each mutant that it is asked for.

    python -P warm.py ROOT FOLDER ...

A line of standard input is a job: {"path": of the module, "before": its text, "text": of the mutant, which is on the
disk, "lines": those changed, "tests": node ids, "limits": seconds of each, "seconds": of all}. A line of standard
output is what came of it: {"outcome": "passed", "failed", "killed", "timeout" or "cold", "test": the first that failed,
"seconds": s}. A mutant is "cold" where its code has run while things were loaded, or cannot take the place of the
loaded one: then server.py does it.
"""

import gc
import json
import os
import resource
import signal
import sys
import tempfile
import types
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE / "site"))

import lines
import server


class Cold(Exception):
    """The mutant cannot be tried in a process that has loaded the module."""


def main() -> None:
    plugin = _Jobs()
    server.load_libraries()
    lines.start(str(server.ROOT), os.path.join(tempfile.mkdtemp(prefix="body_moments_lines_"), "lines"))
    server.load_conftest()
    import pytest

    code = pytest.main(["-q", *sys.argv[2:]], plugins=[plugin])
    if not plugin.is_done:
        sys.exit("pytest ended with {}".format(code))


class _Jobs:
    """Takes the place of pytest's loop over its tests."""

    def __init__(self):
        self.is_done = False
        self.jobs, self.answers = server.take_pipes()

    def pytest_runtestloop(self, session):
        self.run = {(path, line) for path, found in lines.taken().items() for line in found}
        lines.stop()
        items = {item.nodeid: item for item in session.items}
        print(json.dumps({"count": len(items)}), file=self.answers)
        for line in self.jobs:
            job = json.loads(line)
            answer = server.forked(lambda result, job=job: self.child(job, items, result), job["seconds"])
            print(json.dumps(answer), file=self.answers)
        self.is_done = True
        return True

    def child(self, job: dict, items: dict, result: str) -> None:
        outcome = {"outcome": "passed", "test": ""}
        try:
            if any((job["path"], line) in self.run for line in job["lines"]):
                raise Cold
            replace_code(str(server.ROOT / job["path"]), job["before"], job["text"])
            outcome["test"] = _first_failure(job, items)
            outcome["outcome"] = "failed" if outcome["test"] else "passed"
        except Cold:
            outcome["outcome"] = "cold"
        except BaseException as error:
            outcome = {"outcome": "failed", "test": "(running) {!r}".format(error)[:200]}
        server.write_answer(result, outcome)


def _first_failure(job: dict, items: dict) -> str:
    from _pytest.runner import runtestprotocol

    chosen = [(items[name], limit) for name, limit in zip(job["tests"], job["limits"], strict=True) if name in items]
    for (item, limit), (following, _) in zip(chosen, [*chosen[1:], (None, 0)], strict=True):
        signal.alarm(limit)  # kills this process
        if any(report.failed for report in runtestprotocol(item, log=False, nextitem=following)):
            return item.nodeid
    return ""


def replace_code(path: str, before: str, text: str) -> None:
    """Give the functions that are loaded from a module the code that they have in this text."""
    if path not in [getattr(module, "__file__", None) for module in list(sys.modules.values())]:
        return  # it will be read from the disk, where the mutant is
    old = _functions(compile(before, path, "exec", dont_inherit=True))
    new = _functions(compile(text, path, "exec", dont_inherit=True))
    if {name: len(codes) for name, codes in old.items()} != {name: len(codes) for name, codes in new.items()}:
        raise Cold
    codes = {}
    for name, found in old.items():
        for before, after in zip(found, new[name], strict=True):
            codes[name, before.co_firstlineno] = after
    changed = 0
    for function in gc.get_objects():
        if isinstance(function, types.FunctionType) and function.__code__.co_filename == path:
            code = function.__code__
            after = codes.get((code.co_qualname, code.co_firstlineno))
            if after is None or len(after.co_freevars) != len(code.co_freevars):
                raise Cold
            if after != code:
                function.__code__ = after
                changed += 1
    if not changed:
        raise Cold


def _functions(code: types.CodeType) -> dict[str, list[types.CodeType]]:
    found = {}
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            found.setdefault(constant.co_qualname, []).append(constant)
            for name, codes in _functions(constant).items():
                found.setdefault(name, []).extend(codes)
    return found


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main()
