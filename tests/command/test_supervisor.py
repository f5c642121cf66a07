# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs over files with scripted children that crash, hang, grow or answer nonsense."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

import pytest
from body_moments.command.supervisor import lifeline, processes
from body_moments.command.supervisor.journal import Journal
from body_moments.command.supervisor.pool import Limits, Pool
from body_moments.operators import batch

from tests.blender.batch_files import sentence

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="not on this system: /proc"
)

CHILD = r"""
import json, os, signal, sys, time

def answer(head, data=b"", mark=b"\x1e"):
    head = dict(head, bytes=len(data)) if data else head
    sys.stdout.buffer.write(mark + json.dumps(head).encode() + b"\n" + data)
    sys.stdout.buffer.flush()

def say(text):
    sys.stderr.write(text)
    sys.stderr.flush()

def log(**entry):
    with open(sys.argv[1], "a") as file:
        file.write(json.dumps(dict(entry, pid=os.getpid())) + "\n")

setup = json.loads(sys.stdin.readline())
places = {name: os.environ[name] for name in ("TMPDIR", "TEMP", "TMP", "BLENDER_USER_RESOURCES")}
log(setup=setup, folder=places["TMPDIR"], places=places, is_there=os.path.isdir(places["TMPDIR"]))
if "refuse" in setup["words"]:
    answer({"usage": "error: no\n"})
if "slow" in setup["words"]:
    time.sleep(0.5)
say("a stray line\n")
print("a stray word", flush=True)
answer({"ready": {"blender": "9.8.7"}})
kept = []
for line in sys.stdin:
    ((verb, path),) = json.loads(line).items()
    kind = os.path.basename(path).partition(" ")[0]
    log(verb=verb, path=path)
    os.ftruncate(2, 0)
    status = "error" if kind == "bad" else "ok"
    empty = {"blender": "9.8.7", "frame": "world", "objects": [], "left_out": [], "errors": []}
    head = {"schema": "body-moments/1", "file": path, "status": status}
    document = json.dumps({**head, **empty}).encode() + b"\n"
    if kind == "once" and not os.path.exists(path):
        open(path, "w").close()
        os.abort()
    if kind == "crash":
        say("body_moments: last words\n")
        os.kill(os.getpid(), signal.SIGSEGV)
    if kind == "exit":
        sys.exit(3)
    if kind in ("hang", "fat"):
        signal.signal(signal.SIGTERM, lambda *_: (open(path + " tidied", "w").close(), sys.exit(7)))
    if kind == "hang":
        time.sleep(600)
    if kind == "fat":
        kept.append(bytearray(b"x") * (400 << 20))
        time.sleep(600)
    if kind == "grow":
        kept.append(bytearray(b"x") * (4 << 20))
    if kind == "long":
        say("x" * 70000)
    if kind == "mad":
        answer({}, mark=b"\x1e{")
        time.sleep(600)
    if kind == "short":
        answer({"bytes": 100})
        sys.stdout.buffer.write(b"{}")
        sys.exit(0)
    if kind == "empty":
        answer({})
        continue
    if kind == "note":
        answer({"note": "half of it"})
    say("body_moments: {}: read\nchatter\n".format(path))
    head = {"faults": int(kind == "fault"), "state": {"size": 5, "mtime_ns": 7}}
    if kind == "refers":
        head = dict(head, reads={path + ".samples": {"size": 1, "mtime_ns": 2}})
    answer(head, document)
"""


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """The command of a child, and what its children have logged."""
    (tmp_path / "child.py").write_text(CHILD)
    log = tmp_path / "log"
    command = [sys.executable, "-S", "-E", str(tmp_path / "child.py"), str(log)]
    monkeypatch.setattr(processes, "run_command", lambda *_: command)

    def logged(key):
        return [entry for entry in map(json.loads, log.read_text().splitlines()) if key in entry]

    logged.command = command
    return logged


@pytest.fixture
def main(tmp_path, fake, capsys):
    """`measure` with these words: exit code, documents by file, lines on the standard error, lines
    of the journal.
    """
    (tmp_path / "out").mkdir()

    def run(*words, reads=True):
        out = tmp_path / "out" / "result"
        code = batch.main(
            ["measure", *map(str, words), "--format", "jsonl", "--output", str(out)], channel=-1
        )
        said = re.sub(r"in [\d.]+ s", "in 0 s", capsys.readouterr().err).splitlines()
        documents = (
            [json.loads(line) for line in out.read_text().splitlines()]
            if reads and out.exists()
            else []
        )
        journal = out.with_name("result.journal")
        lines = (
            [json.loads(line) for line in journal.read_text().splitlines()]
            if journal.exists()
            else []
        )
        assert {path.name for path in out.parent.iterdir()} <= {
            "result",
            "result.journal",
            "result.old",
        } | {"result.journal.old"}
        return code, documents, said, lines

    return run


def test_each_end_of_a_child_is_a_record(tmp_path, main, fake):
    names = [
        "ok 1",
        "crash",
        "exit",
        "once",
        "mad",
        "short",
        "empty",
        "note",
        "bad",
        "refers",
        "ok 2",
    ]
    paths = [str(tmp_path / name) for name in names]
    begun = time.monotonic()
    code, documents, said, journal = main(
        *paths, paths[0], "--jobs", "1", "--memory-mb", "150", "--timeout", "60"
    )
    assert sum(line["seconds"] for line in journal) < time.monotonic() - begun
    assert code == 1 and [one["file"] for one in documents] == [*paths, paths[0]]
    ends = {
        "crash": ("SIGSEGV", 2),
        "exit": ("exit code 3", 2),
        "mad": ("SIGKILL", 2),
        "short": ("exit code 0", 2),
    }
    ends["empty"] = "no answer", 1
    status = dict.fromkeys(names, "ok") | dict.fromkeys(ends, "crashed") | {"bad": "error"}
    assert [one["status"] for one in documents] == [*(status[name] for name in names), "ok"]
    reasons = {
        name: sentence("file_crashed", how=how, count=count) for name, (how, count) in ends.items()
    }
    for document in documents:
        name = Path(document["file"]).name
        if name in reasons:
            assert document["errors"] == [{"name": None, "reason": reasons[name]}]
            assert (document["blender"], document["frame"]) == ("9.8.7", "world")
    expected = [
        "body_moments: {}: {}".format(path, reasons.get(name, "read"))
        for path, name in zip(paths, names)
        if name != "note"
    ]
    note = "body_moments: {}: ".format(tmp_path / "note")
    assert sorted(said[:-1]) == sorted([*expected, note + "half of it", note + "read"])
    assert said[-1] == "body_moments: 11 files in 0 s: 5 ok, 5 crashed, 1 error"
    by_name = {Path(line["key"]["path"]).name: line for line in journal}
    assert len(journal) == len(by_name) == len(names)
    for name, line in by_name.items():
        assert line["status"] == status[name]
        assert line["attempts"] == (2 if name == "once" else ends.get(name, ("", 1))[1])
    assert not any(Path(entry["folder"]).exists() for entry in fake("setup"))
    asked = Counter(Path(one["path"]).name for one in fake("verb"))
    assert asked == Counter({name: by_name[name]["attempts"] for name in names})
    # a second attempt is made by a child that has measured nothing
    first_of = {}
    for one in fake("verb"):
        first_of.setdefault(one["pid"], one["path"])
    for name in ("crash", "exit", "mad", "short", "once"):
        assert [one["path"] for one in fake("verb") if one["path"] == str(tmp_path / name)][
            1
        ] in first_of.values()


@pytest.mark.parametrize(
    ("name", "status", "words", "reason"),
    [
        ("hang", "timeout", ("--timeout", "1.5"), sentence("file_timed_out", seconds=1.5)),
        ("fat", "memory", ("--memory-mb", "100"), sentence("file_took_memory", megabytes=100.0)),
    ],
)
def test_child_over_its_time_or_memory_is_ended(
    name, status, words, reason, tmp_path, main, monkeypatch
):
    """One at a time: what takes too much may take long, too, where memory is slow.

    What is late may clean up first.
    """
    monkeypatch.setattr(processes, "_GRACE", 10.0)  # A busy machine may need as much.
    code, documents, said, journal = main(tmp_path / name, tmp_path / "ok", *words, "--jobs", "1")
    assert code == 1 and [one["status"] for one in documents] == [status, "ok"]
    assert documents[0]["errors"][0]["reason"] == reason
    (line,) = [line for line in journal if line["status"] != "ok"]
    assert line["status"] == status and line["attempts"] == 2
    assert (tmp_path / (name + " tidied")).exists() == (status == "timeout")
    if status == "timeout":
        assert 3.0 <= line["seconds"] < 30.0
    assert said[-1] == "body_moments: 2 files in 0 s: 1 {:s}, 1 ok".format(status)


def test_recorded_file_is_not_measured_again(tmp_path, main, fake):
    (tmp_path / "samples").mkdir()
    paths = [tmp_path / "samples" / name for name in ("ok 1", "bad", "refers", "crash", "ok 2")]
    for path in paths:
        path.write_text("five!")
        os.utime(path, ns=(7, 7))
    words = (*paths, "--jobs", "2", "--timeout", "60")
    code, documents, _, _ = main(*words)
    assert code == 1
    samples = tmp_path / "samples" / "refers.samples"
    samples.write_text("1")
    os.utime(samples, ns=(2, 2))
    asked = len(fake("verb"))
    code, again, said, _ = main(*words, "--resume")
    assert code == 1 and again == documents and len(fake("verb")) == asked
    totals = "body_moments: 5 files, of which {} in 0 s: 3 ok, 1 error, 1 crashed"
    assert said == ["body_moments: 5 of 5 files reused", totals.format("0 files")]
    samples.write_text("2")
    os.utime(paths[0], ns=(7, 8))
    _, again, said, journal = main(*words, "--resume")
    assert again == documents and said[-1] == totals.format("2 files")
    assert (
        said[0]
        == "body_moments: 3 of 5 files reused; to measure: 1 changed, 1 whose references have "
        "changed"
    )
    assert {one["path"] for one in fake("verb")[asked:]} == {str(paths[0]), str(paths[2])}
    assert len(journal) == 7
    samples.write_text("1")
    for path, time_ns in ((samples, 2), (paths[0], 7)):
        os.utime(path, ns=(time_ns, time_ns))
    asked = len(fake("verb"))
    code, again, said, _ = main(*words, "--retry-failed")
    assert said[0] == "body_moments: 3 of 5 files reused; to measure: 2 failed" and said[
        -1
    ] == totals.format("2 files")
    assert [Path(one["path"]).name for one in fake("verb")[asked:]] == [
        "bad",
        "crash",
        "crash",
    ] and code == 1
    _, _, said, _ = main(*words, "--resume", "--unit-scale", "0.001", "--density", "7")
    reason = "made with other options: --density --unit-scale"
    assert said[0] == "body_moments: 0 of 5 files reused; to measure: 5 " + reason
    journal = tmp_path / "out" / "result.journal"
    journal.write_text(journal.read_text().replace('"objects": []', '"objects": [1]'))
    _, _, said, _ = main(*words, "--resume", "--unit-scale", "0.001", "--density", "7")
    assert said[0].endswith("5 damaged in the journal")
    journal.write_text("")
    _, _, said, _ = main(*words, "--resume")
    assert said[0].endswith("5 not recorded")
    _, _, said, journal = main(*words)  # from the beginning: what was there is kept
    assert said[-1].startswith("body_moments: 5 files") and len(journal) == 5
    old = tmp_path / "out" / "result.journal.old"
    assert len(old.read_text().splitlines()) == 5 and (tmp_path / "out" / "result.old").exists()


def test_a_run_that_is_interrupted_says_how_far_it_is(tmp_path, main, fake):
    """Also when it has been resumed: what was there before counts."""
    (tmp_path / "out" / "result.journal").write_text("")
    paths = [tmp_path / name for name in ("ok 1", "bad", "hang")]
    for path in paths:
        path.write_text("five!")
        os.utime(path, ns=(7, 7))
    for words in ((), ("--resume",)):
        count = len([one for one in fake("path") if "hang" in one["path"]]) if words else 0

        def interrupt(count=count):
            while (
                not (tmp_path / "log").exists()
                or sum("hang" in one["path"] for one in fake("path")) == count
            ):
                time.sleep(0.02)
            time.sleep(0.3)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        code, documents, said, journal = main(*paths, "--jobs", "1", *words)
        thread.join()
        assert code == 3 and documents == [] and len(journal) == 2
        assert (
            said[-1].startswith("body_moments: interrupted after 2 of 3 files")
            and "--resume" in said[-1]
        )


def test_file_that_ended_a_child_waits_for_a_fresh_one(tmp_path, fake):
    with Pool(fake.command, 2, {"words": ["slow"]}, Limits(60.0), tmp_path / "work") as found:
        found.add(["crash", *("ok {}".format(number) for number in range(6))])
        outcomes = []
        while not found.is_done:
            outcomes += found.step()
    assert sorted((one.status, one.how) for one in outcomes) == [("answered", "")] * 6 + [
        ("crashed", "SIGSEGV")
    ]
    first, second = [one["pid"] for one in fake("path") if one["path"] == "crash"]
    assert first != second and [one["path"] for one in fake("path") if one["pid"] == second] == [
        "crash"
    ]


def test_a_line_behind_a_torn_one_is_whole(tmp_path):
    path = tmp_path / "journal"
    for rest in (b"", b'{"schema": "body-moments-jou', b"\n", b"{}\n"):
        path.write_bytes(rest)
        with Journal(path) as journal:
            for name in "ab":
                head = {"key": {"path": name}, "status": "ok", "limits": {}, "reads": {}}
                journal.append(head, json.dumps({"n": name}).encode())
            assert [journal.document(name) for name in "ab"] == [{"n": "a"}, {"n": "b"}]
        lines = path.read_bytes().splitlines(keepends=True)
        assert len(lines) == 2 + bool(rest) and all(line.endswith(b"\n") for line in lines)
        with Journal(path) as journal:
            assert [*journal.entries] == ["a", "b"] and journal.document("b") == {"n": "b"}


def test_run_ends_with_the_window_that_started_it():
    """A window that is killed, and no window."""
    code = "import runpy; runpy.run_path({!r})['end_with_window'](); ".format(lifeline.__file__)
    code += "print(end='.', flush=True); {}"
    run = [sys.executable, "-c", code.format("import time; time.sleep(600)")]
    window = "import subprocess, time; subprocess.Popen({!r}); time.sleep(600)".format(run)
    environment = {**os.environ, lifeline.WINDOW: "1"}
    with subprocess.Popen(
        [sys.executable, "-c", window], env=environment, stdout=subprocess.PIPE
    ) as started:
        assert started.stdout.read(1) == b"."
        started.kill()
        assert started.stdout.read() == b""  # the pipe is closed as soon as the run has ended, too
    alone = [sys.executable, "-c", code.format("")]
    assert subprocess.run(alone, check=True, stdout=subprocess.PIPE).stdout == b"."


def test_a_disk_that_is_full_is_said_and_the_older_result_stays(tmp_path, main, monkeypatch):
    words = (tmp_path / "ok 1", tmp_path / "ok 2", "--jobs", "1")
    assert main(*words)[0] == 0
    result = (tmp_path / "out" / "result").read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Journal, "append", full)
    code, _, said, _ = main(*words, reads=False)
    assert code == 1
    assert said[-1].endswith("cannot be written: No space left on device")
    assert (tmp_path / "out" / "result.old").read_bytes() == result


@pytest.mark.parametrize(
    "lines",
    [
        b"",
        b"a.stl\nb.stl\n",
        b'[{"schema": "body-moments-manifest/1"}]\n',
        b'{"files": 0}\n',
        b'{"schema": "body-moments-manifest/2", "files": 1}\n{"path": "a.stl"}\n',
        b'{"schema": "body-moments-manifest/1", "files": 2}\n{"path": "a.stl"}\n',
        b'{"schema": "body-moments-manifest/1", "files": 0}\n{"path": "a.stl"}\n',
        b'{"schema": "body-moments-manifest/1"}\n{"path": "a.stl"}\n',
        b'{"schema": "body-moments-manifest/1", "files": 1}\n{"name": "a.stl"}\n',
        b'{"schema": "body-moments-manifest/1", "files": 2}\n{"path": "a.stl"}\n{"path": 5}\n',
        b'{"schema": "body-moments-manifest/1", "files": 1}\n{"path": "\xff"}\n',
        b"[" * 100_000,
    ],
)
def test_malformed_list_of_files_is_wrong_usage(tmp_path, fake, capsys, lines):
    listed = tmp_path / "list"
    listed.write_bytes(lines)
    assert batch.main(["measure", "--manifest", str(listed)], channel=-1) == 2
    assert "{} is not a list of files".format(listed) in capsys.readouterr().err
    assert not (tmp_path / "log").exists()
