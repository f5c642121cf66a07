# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages between the supervisor and its children, within this process."""

import sys
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

pytest.importorskip("bpy")
from body_moments.command.files import output
from body_moments.command.measure import child
from body_moments.command.options import arguments

pytestmark = pytest.mark.usefixtures("scene")


class Line:
    """Messages for a child, and what it answers to each; for how long each may take."""

    def __init__(self, *messages):
        self._messages, self.answers, self.limits, self.within = messages, [], [], False

    def messages(self):
        return iter(self._messages)

    def answer(self, head, data=b""):
        self.answers.append((head, data, self.within))

    @contextmanager
    def limited(self, seconds):
        self.limits.append(seconds)
        self.within = True
        yield
        self.within = False


def setup(*words, seconds=7.5):
    options = arguments.as_record(arguments.parse(["measure", "a.stl", *map(str, words)]))
    return {"options": options, "threads": 1, "memory": None, "seconds": seconds}


def test_a_child_that_is_told_nothing_ends():
    line = Line()
    child.serve(line)
    assert line.answers == []


def test_child_reports_a_wrong_order(tmp_path, capfd):
    (tmp_path / "q.npy").write_bytes(b"1 2 3")
    line = Line(setup("--fourier", tmp_path / "f.npz", "--q", tmp_path / "q.npy"), {"measure": "a.stl"})
    child.serve(line)
    ((head, data, _),) = line.answers
    assert [*head] == ["usage"] and "error: argument --q: " in head["usage"] and data == b"" and line.limits == []
    assert capfd.readouterr().err == ""  # the supervisor says it, once


class Descriptors:
    """Those of a process, each with what it is open for."""

    devnull, O_WRONLY = "nothing", 1

    def __init__(self, **opened):
        self.table = {number: name for number, name in enumerate(("in", "out", "err")) if opened[name]}

    def open(self, path, _how):
        free = next(number for number in range(9) if number not in self.table)
        self.table[free] = path
        return free

    def fstat(self, number):
        if number not in self.table:
            raise OSError(9, "Bad file descriptor")

    def dup(self, number):
        self.fstat(number)
        return self.open(self.table[number], 1)

    def dup2(self, number, other):
        self.fstat(number)
        self.table[other] = self.table[number]

    def close(self, number):
        del self.table[number]


@pytest.mark.parametrize("err", [True, False])
@pytest.mark.parametrize("out", [True, False])
@pytest.mark.parametrize("given", [True, False])
def test_closed_streams_keep_the_result_clean(monkeypatch, given, out, err):
    system, stream = Descriptors(**{"in": given, "out": out, "err": err}), sys.stderr
    monkeypatch.setattr(output, "os", system)
    flushed = []
    monkeypatch.setattr(sys, "stdout", SimpleNamespace(flush=lambda: flushed.append(system.table.get(1))))
    if not err:
        monkeypatch.setattr(sys, "stderr", None)
    channel = output.claim_stdout()
    table = system.table
    assert flushed == (["out"] if out else [])  # what was printed before goes where it was meant to
    assert [number for number, name in table.items() if name == "out"] == ([channel] if out else [])
    assert channel not in (1, 2) and (out or channel not in table)
    assert table[1] == table[2] == ("err" if err else "nothing")
    assert len(table) <= 3 + out  # nothing else stays open
    assert (sys.stderr is stream) == err and sys.stderr.write("x") == 1
