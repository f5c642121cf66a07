# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a child of the supervisor answers, and how a process of the command line begins and ends, within this one."""

import json
import os
import sys
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("bpy")
import bpy
from body_moments.operators import batch
from body_moments.operators.command import arguments, child, interruption, output
from body_moments.operators.supervisor import lifeline
from body_moments.operators.supervisor.journal import state

from tests.blender import batch_files as files
from tests.blender.batch_files import sentence

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


READY = {"ready": {"blender": ".".join(map(str, bpy.app.version))}}


def test_a_child_that_is_told_nothing_ends():
    line = Line()
    child.serve(line)
    assert line.answers == []


def test_a_child_says_what_is_wrong_with_what_it_was_told(tmp_path, capfd):
    (tmp_path / "q.npy").write_bytes(b"1 2 3")
    line = Line(setup("--fourier", tmp_path / "f.npz", "--q", tmp_path / "q.npy"), {"measure": "a.stl"})
    child.serve(line)
    ((head, data, _),) = line.answers
    assert [*head] == ["usage"] and "error: argument --q: " in head["usage"] and data == b"" and line.limits == []
    assert capfd.readouterr().err == ""  # the supervisor says it, once


def test_a_child_answers_with_documents_and_what_they_refer_to(tmp_path, capfd, monkeypatch):
    monkeypatch.setattr(interruption, "PERIOD", 0.0)
    detached = {"type": "uint8", "dimension": 3, "sizes": "2 2 2", "spacings": "1 1 1", "encoding": "raw"}
    (tmp_path / "samples.raw").write_bytes(bytes(range(8)))
    lines = ["NRRD0004", *("{}: {}".format(*one) for one in detached.items()), "data file: samples.raw", "", ""]
    scan = tmp_path / "scan.nhdr"
    scan.write_text("\n".join(lines))
    np.save(tmp_path / "b.npy", np.ones((2, 2, 2)))
    os.write(2, b"said of the file before\n")
    missing = str(tmp_path / "none.stl")
    paths = [str(scan), str(tmp_path / "b.npy"), missing]
    line = Line(setup(), *({"measure": path} for path in paths), {"reads": str(scan)})
    child.serve(line)
    assert "before" not in capfd.readouterr().err
    assert line.limits == [7.5] * 4 and line.answers.pop(0) == (READY, b"", False)
    heads = [(head, data) for head, data, within in line.answers if within]
    assert len(heads) == len(line.answers)
    notes = [head["note"] for head, _ in heads if "note" in head]
    assert notes == [sentence("progress_samples", count=8)] * 2
    *answers, (reads, nothing) = [(head, data) for head, data in heads if "note" not in head]
    for (head, data), path, error in zip(answers, paths, (False, False, True), strict=True):
        document = json.loads(data)
        assert (
            data.endswith(b"\n") and document["file"] == path and document["status"] == ("missing" if error else "ok")
        )
        assert head["faults"] == 0 and head["state"] == state(path)
        samples = str(tmp_path / "samples.raw")
        assert head["reads"] == ({samples: state(samples)} if path == str(scan) else {})
    assert reads == {"reads": [str(scan), samples]} and nothing == b""


def test_a_child_counts_its_faults_and_knows_a_file_that_it_has_saved(tmp_path, monkeypatch, capfd):
    path, broken = files.box_file(tmp_path / "part.blend"), files.box_file(tmp_path / "broken.blend")
    before = state(path)
    measure = child.Run.document

    def document(self, path):
        self.internal_errors += 3 * (path == broken)
        return measure(self, path)

    monkeypatch.setattr(child.Run, "document", document)
    line = Line(setup("--write"), {"measure": broken}, {"measure": path}, {"measure": str(tmp_path / "none.blend")})
    child.serve(line)
    _, (first, _, _), (second, _, _), (third, _, _) = line.answers
    assert [first["faults"], second["faults"], third["faults"]] == [3, 0, 0]
    assert second["state"] == state(path) != before and third["state"] == state(str(tmp_path / "none.blend"))
    read_only = Line(setup(), {"measure": path})
    child.serve(read_only)
    assert read_only.answers[1][0]["state"] == state(path)


class Ended(BaseException):
    """In the place of the end of this process."""


@pytest.fixture
def exits(monkeypatch):
    """The codes with which the process would have ended."""
    codes = []

    def end(code):
        codes.append(code)
        raise Ended

    monkeypatch.setattr(batch.os, "_exit", end)
    return codes


def test_a_process_that_serves_a_supervisor_ends_with_it_or_with_a_fault(exits, monkeypatch, capsys):
    made = []
    monkeypatch.setattr(lifeline, "Lifeline", lambda *words: made.append(words) or words)
    monkeypatch.setattr(child, "serve", lambda line: made.append(line))
    for words, watched in ((["child", "5"], 5), (["child"], None)):
        with pytest.raises(Ended):
            batch.main(words, channel=9)
        assert made == [(9, watched)] * 2 and exits == [0] and capsys.readouterr().err == ""
        made.clear(), exits.clear()
    for fault in (ZeroDivisionError, KeyboardInterrupt, SystemExit):

        def serve(_, fault=fault):
            raise fault("here")

        monkeypatch.setattr(child, "serve", serve)
        with pytest.raises(Ended):
            batch.main(["child"], channel=9)
        said = capsys.readouterr().err
        assert exits.pop() == 70 and "Traceback" in said and said.rstrip().endswith("{}: here".format(fault.__name__))


@pytest.mark.parametrize(
    ("comes", "code", "said"),
    [
        (1, 1, ""),
        (
            ModuleNotFoundError("No module named 'numpy'"),
            2,
            "body_moments: No module named 'numpy'. Install it, or use ",
        ),
        (KeyboardInterrupt(), 3, "body_moments: interrupted\n"),
        (ZeroDivisionError("here"), 70, "Traceback (most recent call last):"),
    ],
)
def test_a_script_ends_with_the_code_of_what_came_of_it(exits, monkeypatch, tmp_path, capsys, comes, code, said):
    """As Blender's module does: without its folder, where that is empty and its own."""

    def run():
        if isinstance(comes, BaseException):
            raise comes
        return comes

    monkeypatch.setattr(batch, "_run", run)
    for module in (None, False):
        app = None if module is None else SimpleNamespace(app=SimpleNamespace(module=False))
        monkeypatch.setitem(sys.modules, "bpy", app)
        with pytest.raises(SystemExit) as ended:
            batch._run_script()
        assert ended.value.code == code and exits == []
        shown = capsys.readouterr().err
        assert shown.startswith(said) and (said or not shown)
    for name, content, left in (("blender_a", False, False), ("blender_b", True, True), ("other", False, True)):
        (tmp_path / name).mkdir()
        if content:
            (tmp_path / name / "file").touch()
        app = SimpleNamespace(module=True, tempdir=str(tmp_path / name) + os.sep)
        monkeypatch.setitem(sys.modules, "bpy", SimpleNamespace(app=app))
        with pytest.raises(Ended):
            batch._run_script()
        assert exits.pop() == code and (tmp_path / name).exists() == left


def test_a_script_takes_its_words_from_behind_those_of_blender(monkeypatch):
    asked = []
    monkeypatch.setattr(batch, "_load_package", lambda: None)
    monkeypatch.setattr(output, "claim_stdout", lambda: 17)
    monkeypatch.setattr(batch, "main", lambda words, **more: asked.append((words, more)) or 5)
    blender = ["blender", "-b", "a.blend", "--python", "batch.py"]
    for module, words, own in (
        (False, [*blender, "--", "measure", "--", "x"], ["measure", "--", "x"]),
        (False, blender, []),
        (True, ["batch.py", "measure", "a.stl"], ["measure", "a.stl"]),
        (None, ["batch.py", "measure", "--", "a.stl"], ["measure", "--", "a.stl"]),
    ):
        found = None if module is None else SimpleNamespace(app=SimpleNamespace(module=module))
        monkeypatch.setitem(sys.modules, "bpy", found)
        monkeypatch.setattr(sys, "argv", words)
        assert batch._run() == 5
        assert asked.pop() == (own, {"channel": 17, "file_needed": module is not False})


def test_an_interruption_before_anything_is_read_is_said(monkeypatch, capsys):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(arguments, "parse", interrupted)
    assert batch.main(["measure"], channel=-1) == 3
    assert capsys.readouterr().err == "body_moments: {}\n".format(sentence("interrupted"))


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
def test_nobody_else_writes_where_the_result_goes_whatever_is_closed(monkeypatch, given, out, err):
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
