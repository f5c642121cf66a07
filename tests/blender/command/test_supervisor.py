# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs over files whose children are programs of a few lines, which do all that a child may do but measure."""

import importlib.util
import io
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
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("bpy")
from body_moments.core.verdict.finding import QueryError, finding
from body_moments.operators import batch
from body_moments.operators.command import arguments, supervised
from body_moments.operators.supervisor import lifeline, listing, pool, processes, progress, whole_run
from body_moments.operators.supervisor.journal import Entry, Journal, is_journal, state
from body_moments.operators.supervisor.pool import Limits, Pool
from body_moments.operators.supervisor.progress import Progress
from body_moments.operators.supervisor.whole_run import WholeRun

from tests.blender.batch_files import sentence

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="not on this system: /proc")

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
if "refuse" in (setup["options"]["object"] or ()):
    answer({"usage": "error: no\n"})
if "slow" in (setup["options"]["object"] or ()):
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
    document = json.dumps({"schema": "body-moments/1", "file": path, "status": status}).encode() + b"\n"
    if verb == "reads":
        answer({"reads": [path + ".samples"]})
        continue
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
    answer(dict(head, reads={path + ".samples": {"size": 1, "mtime_ns": 2}}) if kind == "refers" else head, document)
"""


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """The command of a child, and what its children have logged."""
    (tmp_path / "child.py").write_text(CHILD)
    log = tmp_path / "log"
    command = [sys.executable, "-S", "-E", str(tmp_path / "child.py"), str(log)]
    monkeypatch.setattr(processes, "child_command", lambda blender: command)

    def logged(key):
        return [entry for entry in map(json.loads, log.read_text().splitlines()) if key in entry]

    logged.command = command
    return logged


@pytest.fixture
def main(tmp_path, fake, capsys):
    """`measure` with these words: exit code, documents by file, lines on the standard error, lines of the journal."""
    (tmp_path / "out").mkdir()

    def run(*words, reads=True):
        out = tmp_path / "out" / "result"
        code = batch.main(["measure", *map(str, words), "--format", "jsonl", "--output", str(out)], channel=-1)
        said = re.sub(r"in [\d.]+ s", "in 0 s", capsys.readouterr().err).splitlines()
        documents = [json.loads(line) for line in out.read_text().splitlines()] if reads and out.exists() else []
        journal = out.with_name("result.journal")
        lines = [json.loads(line) for line in journal.read_text().splitlines()] if journal.exists() else []
        assert {path.name for path in out.parent.iterdir()} <= {"result", "result.journal", "result.old"} | {
            "result.journal.old"
        }
        return code, documents, said, lines

    return run


def test_each_end_of_a_child_is_a_record(tmp_path, main, fake):
    names = ["ok 1", "crash", "exit", "once", "mad", "short", "empty", "note", "bad", "refers", "ok 2"]
    paths = [str(tmp_path / name) for name in names]
    begun = time.monotonic()
    code, documents, said, journal = main(*paths, paths[0], "--jobs", "1", "--memory-mb", "150", "--timeout", "60")
    assert sum(line["seconds"] for line in journal) < time.monotonic() - begun
    assert code == 1 and [one["file"] for one in documents] == [*paths, paths[0]]
    ends = {"crash": ("SIGSEGV", 2), "exit": ("exit code 3", 2), "mad": ("SIGKILL", 2), "short": ("exit code 0", 2)}
    ends["empty"] = "no answer", 1
    status = dict.fromkeys(names, "ok") | dict.fromkeys(ends, "crashed") | {"bad": "error"}
    assert [one["status"] for one in documents] == [*(status[name] for name in names), "ok"]
    reasons = {name: sentence("file_crashed", how=how, count=count) for name, (how, count) in ends.items()}
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
        known = {"size": 5, "mtime_ns": 7} if name not in reasons else state(str(tmp_path / name))
        assert {**line["key"], "options": "", "addon": ""} == {
            **{"path": str(tmp_path / name), "options": "", "addon": "", "blender": "9.8.7"},
            **known,
        }
        assert line["status"] == status[name] and line["limits"] == {"seconds": 60.0, "memory": 150_000_000}
        assert line["attempts"] == (2 if name == "once" else ends.get(name, ("", 1))[1])
        assert line["reads"] == ({paths[9] + ".samples": {"size": 1, "mtime_ns": 2}} if name == "refers" else {})
        assert 0.0 <= line["seconds"] < 60.0 and line["document"]["status"] == status[name]
    started = fake("setup")
    assert {one["setup"]["threads"] for one in started} == {processes.cores()}
    assert {(one["setup"]["seconds"], one["setup"]["memory"]) for one in started} == {(60.0, 150_000_000)}
    for one in started:
        *temporary, user = one["places"].values()
        assert {*temporary} == {one["folder"]} and user == one["folder"] + "/user"
        assert one["is_there"] and not Path(one["folder"]).exists()
    asked = Counter(Path(one["path"]).name for one in fake("verb"))
    assert asked == Counter({name: by_name[name]["attempts"] for name in names})
    # a second attempt is made by a child that has measured nothing
    first_of = {}
    for one in fake("verb"):
        first_of.setdefault(one["pid"], one["path"])
    for name in ("crash", "exit", "mad", "short", "once"):
        assert [one["path"] for one in fake("verb") if one["path"] == str(tmp_path / name)][1] in first_of.values()


@pytest.mark.parametrize(
    ("name", "status", "words", "reason"),
    [
        ("hang", "timeout", ("--timeout", "1.5"), sentence("file_timed_out", seconds=1.5)),
        ("fat", "memory", ("--memory-mb", "100"), sentence("file_took_memory", megabytes=100.0)),
    ],
)
def test_what_takes_too_long_or_too_much_is_ended(name, status, words, reason, tmp_path, main, monkeypatch):
    """One at a time: what takes too much may take long, too, where memory is slow. What is late may clean up first."""
    monkeypatch.setattr(processes, "_GRACE", 10.0)  # as much as a busy machine may need
    code, documents, said, journal = main(tmp_path / name, tmp_path / "ok", *words, "--jobs", "1")
    assert code == 1 and [one["status"] for one in documents] == [status, "ok"]
    assert documents[0]["errors"][0]["reason"] == reason
    (line,) = [line for line in journal if line["status"] != "ok"]
    assert line["status"] == status and line["attempts"] == 2
    assert (tmp_path / (name + " tidied")).exists() == (status == "timeout")
    if status == "timeout":
        assert 3.0 <= line["seconds"] < 30.0
    assert said[-1] == "body_moments: 2 files in 0 s: 1 {:s}, 1 ok".format(status)


def test_faults_are_shown_with_all_that_the_child_has_said(tmp_path, main):
    code, _, said, journal = main(tmp_path / "fault 1", "--jobs", "1")
    assert code == 70 and said == ["body_moments: {}: read".format(tmp_path / "fault 1"), "chatter"]
    assert journal == []  # of one file there is nothing to go on with
    assert main(tmp_path / "ok", "--jobs", "1")[0] == 0
    assert main(tmp_path / "bad", "--jobs", "1")[0] == 1
    assert main(tmp_path / "bad", "--jobs", "1", "--errors-exit-0")[0] == 0
    (tmp_path / "list").write_text("".join(listing.write_lines(["ok", "bad", "ok 2"])))
    code, documents, _, _ = main("--manifest", tmp_path / "list", "--range", "1:")
    assert code == 1 and [Path(one["file"]).name for one in documents] == ["bad", "ok 2"]


def test_what_is_recorded_is_not_measured_again(tmp_path, main, fake):
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
    assert said == ["body_moments: 0 files in 0 s: -"]
    samples.write_text("2")
    os.utime(paths[0], ns=(7, 8))
    _, again, said, journal = main(*words, "--resume")
    assert again == documents and said[-1] == "body_moments: 2 files in 0 s: 2 ok"
    assert {one["path"] for one in fake("verb")[asked:]} == {str(paths[0]), str(paths[2])}
    assert len(journal) == 7
    _, _, said, journal = main(*words)  # from the beginning: what was there is kept
    assert said[-1].startswith("body_moments: 5 files") and len(journal) == 5
    old = tmp_path / "out" / "result.journal.old"
    assert len(old.read_text().splitlines()) == 7 and (tmp_path / "out" / "result.old").exists()


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
            while not (tmp_path / "log").exists() or sum("hang" in one["path"] for one in fake("path")) == count:
                time.sleep(0.02)
            time.sleep(0.3)
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=interrupt)
        thread.start()
        code, documents, said, journal = main(*paths, "--jobs", "1", *words)
        thread.join()
        assert code == 3 and documents == [] and len(journal) == 2
        assert said[-1] == "body_moments: {}".format(sentence("interrupted_resumable", done=2, total=3))


def test_children_that_have_grown_are_replaced(tmp_path, fake, monkeypatch):
    monkeypatch.setattr(pool, "_GROWTH_PERIOD", 2)
    monkeypatch.setattr(pool, "GROWTH", 2 << 20)
    names = ["ok 1", "grow 2", "grow 3", "ok 4", "ok 5", "ok 6", "ok 7"]
    setup = {"options": {"object": None}}
    opened, begun = len(os.listdir("/proc/self/fd")), time.monotonic()
    with Pool(fake.command, 1, setup, Limits(60.0, None), tmp_path / "work") as found:
        found.add(names)
        assert not found.is_done
        outcomes, let_go = [], {}
        while not found.is_done or found._ending:
            outcomes += found.step()
            let_go.update((child.process.pid, child.process) for child, _ in found._ending)
    assert [process.returncode for process in let_go.values()] == [0, 0]  # they end by themselves
    assert sum(one.seconds for one in outcomes) < time.monotonic() - begun
    assert len(os.listdir("/proc/self/fd")) == opened
    assert [one.task for one in outcomes] == names and not (tmp_path / "work").exists()
    assert {(one.status, one.attempts) for one in outcomes} == {("answered", 1)}
    children = [
        [one["path"] for one in fake("verb") if one["pid"] == pid] for pid in {one["pid"]: 0 for one in fake("verb")}
    ]
    assert children == [names[:2], names[2:4], names[4:]]
    assert [one.said for one in outcomes] == ["body_moments: {}: read\nchatter\n".format(name) for name in names]


def test_what_is_measured_at_once_is_not_lost(tmp_path, fake, monkeypatch):
    """A child whose answer is there before the pool looks again."""
    give = Pool._give
    monkeypatch.setattr(Pool, "_give", lambda self, child: (give(self, child), time.sleep(0.3)))
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.add(["ok 1"])
        found.wait_until_ready()
        outcomes = []
        while not found.is_done:
            outcomes += found.step()
    assert [one.task for one in outcomes] == ["ok 1"]


def test_what_has_ended_a_child_waits_for_a_fresh_one(tmp_path, fake):
    with Pool(fake.command, 2, {"options": {"object": ["slow"]}}, Limits(60.0), tmp_path / "work") as found:
        found.add(["crash", *("ok {}".format(number) for number in range(6))])
        outcomes = []
        while not found.is_done:
            outcomes += found.step()
    assert sorted((one.status, one.how) for one in outcomes) == [("answered", "")] * 6 + [("crashed", "SIGSEGV")]
    first, second = [one["pid"] for one in fake("path") if one["path"] == "crash"]
    assert first != second and [one["path"] for one in fake("path") if one["pid"] == second] == ["crash"]


def test_what_waits_for_a_fresh_child_is_work_beside_the_rest(tmp_path, fake):
    with Pool(fake.command, 3, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.add(["ok 1"])
        found._again.append("ok 2")
        found._refill()
        found._refill()  # those are enough
        children = list(found._children)
        assert len(children) == 2
        while not found.is_done:
            found.step()
    for child in children:
        assert child.requests.closed and child.answers.closed and child.kept is None


def test_where_nothing_is_known_of_memory_children_are_not_replaced(tmp_path, fake, monkeypatch):
    monkeypatch.setattr(pool, "_GROWTH_PERIOD", 1)
    monkeypatch.setattr(processes, "memory_of", lambda pid: None)
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0, 1), tmp_path / "work") as found:
        found.add(["ok 1", "ok 2", "ok 3"])
        outcomes = []
        while not found.is_done:
            outcomes += found.step()
    assert [one.status for one in outcomes] == ["answered"] * 3 and len(fake("setup")) == 1


def test_of_what_a_child_says_the_end_is_kept(tmp_path, fake):
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.add(["long"])
        while not found.is_done:
            for outcome in found.step():
                end = "body_moments: long: read\nchatter\n"
                assert outcome.said == "x" * (pool._LOG_TAIL - len(end)) + end


def test_as_many_children_work_as_there_is_work(tmp_path, fake):
    setup = {"options": {"object": None}}
    for count, tasks in ((3, ["ok 1"]), (2, ["ok {}".format(number) for number in range(6)]), (3, [])):
        before = len(fake("setup")) if (tmp_path / "log").exists() else 0
        with Pool(fake.command, count, setup, Limits(60.0), tmp_path / "work", "reads") as found:
            found.add(tasks)
            found.wait_until_ready()
            heads = []
            while not found.is_done:
                heads += [outcome.head for outcome in found.step()]
        assert found.about == {"blender": "9.8.7"} and len(heads) == len(tasks)
        assert sorted(one["reads"][0] for one in heads) == sorted(name + ".samples" for name in tasks)
        assert len(fake("setup")) - before <= max(1, min(count, len(tasks)))


def test_children_that_refuse_or_do_not_start_end_a_run(tmp_path, fake, monkeypatch, capsys):
    options = arguments.parse(["measure", "a", "--object", "refuse", "--jobs", "1"])
    with pytest.raises(SystemExit) as ended:
        supervised.measure(options, -1, None)
    assert ended.value.code == 2 and capsys.readouterr().err == "error: no\n"
    monkeypatch.setattr(pool, "MAX_FAILED_STARTS", 3)
    options = arguments.parse(["measure", "a"])
    tried = tmp_path / "tried"
    for command, reason in (
        (["sh", "-c", "echo >> {}; echo 'no  such'; echo thing >&2; exit 1".format(tried)], "thing"),
        ([sys.executable, "-c", "import sys; sys.exit('no  such\\n thing')"], "no such thing"),
        ([sys.executable, "-c", "import sys; sys.exit(9)"], "exit code 9"),
        ([str(tmp_path / "nothing")], "{}: No such file or directory".format(tmp_path / "nothing")),
    ):
        monkeypatch.setattr(processes, "child_command", lambda blender, command=command: command)
        assert supervised.measure(options, -1, None) == 2
        assert capsys.readouterr().err == "body_moments: {}\n".format(sentence("children_failed", reason=reason))
    assert tried.read_text() == "\n" * 3
    monkeypatch.setattr(processes, "child_command", lambda blender: None)
    with pytest.raises(SystemExit):
        supervised.measure(options, -1, None)
    assert sentence("usage_no_blender") in capsys.readouterr().err


def test_what_a_target_replaces_is_not_read_by_way_of_a_file(tmp_path, main):
    (tmp_path / "out" / "result").write_text("a novel")
    (tmp_path / "ok").write_text("")
    (tmp_path / "ok.samples").symlink_to(tmp_path / "out" / "result")
    target = tmp_path / "out" / "result"
    code, _, said, _ = main(tmp_path / "ok", "--force", reads=False)
    assert code == 2 and sentence("usage_overwrites_dependency", option="output", path=str(target)) in said[-1]
    (tmp_path / "ok.samples").unlink()
    assert main(tmp_path / "ok", "--force")[0] == 0 and "novel" not in target.read_text()


def test_a_child_has_a_folder_a_session_and_a_pipe_of_its_own(tmp_path):
    names = "TMPDIR", "TEMP", "TMP", "BLENDER_USER_RESOURCES"
    script = (
        "import os, sys; os.read(int(sys.argv[1]), 1); print('said', file=sys.stderr);"
        "print(*map(os.environ.get, {!r}), os.getsid(0) == os.getpid())".format(names)
    )
    folder = tmp_path / "child"
    process, kept = processes.start([sys.executable, "-c", script], folder, tmp_path / "log")
    with process:
        os.close(kept)
        told = process.stdout.read().decode().split()
    assert told == [*[str(folder)] * 3, str(folder / "user"), "True"] and process.returncode == 0
    assert (tmp_path / "log").read_text() == "said\n" and folder.is_dir()
    opened = len(os.listdir("/proc/self/fd"))
    with pytest.raises(FileNotFoundError):
        processes.start([str(tmp_path / "nothing")], tmp_path / "other", tmp_path / "log")
    assert len(os.listdir("/proc/self/fd")) == opened


def test_how_processes_end_is_said():
    for code, text in (
        (None, "no answer"),
        (-11, "SIGSEGV"),
        (-9, "SIGKILL"),
        (0, "exit code 0"),
        (255, "exit code 255"),
    ):
        assert processes.how_it_ended(code) == text
    assert (
        processes.how_it_ended(256) == "exit code 0x100"
        and processes.how_it_ended(0xC0000005) == "exit code 0xc0000005"
    )
    assert processes.how_it_ended(0x1C0000005) == "exit code 0xc0000005"
    bound = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(bound)})
        assert processes.cores() == 1
    finally:
        os.sched_setaffinity(0, bound)
    assert processes.cores() == len(bound)
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    assert processes.memory_of_machine() == machine
    assert (processes.memory_share(), processes.memory_share(4)) == (int(0.8 * machine), int(0.2 * machine))
    kept = bytearray(b"x") * (64 << 20)
    with open("/proc/self/smaps_rollup") as file:
        rollup = dict(line.split()[:2] for line in file.readlines()[1:])
    expected = 1024 * (int(rollup["Anonymous:"]) + int(rollup["Swap:"]))
    taken = processes.memory_of(os.getpid())
    assert abs(taken - expected) < 0.3 * expected and taken % 1024 == 0 and len(kept)
    assert processes.memory_of(2**22 + 1) is None
    ended = subprocess.Popen(["true"])
    os.waitid(os.P_PID, ended.pid, os.WEXITED | os.WNOWAIT)  # it is listed still, and has no memory
    assert processes.memory_of(ended.pid) is None and ended.wait() == 0


def test_a_tool_tells_in_kibibytes_or_nothing_where_it_hangs(tmp_path, monkeypatch):
    (tmp_path / "ps").write_text("#!/bin/sh\nexec sleep 600\n")
    (tmp_path / "ps").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(processes, "_TOOL", 0.1)
    assert processes._memory_by_tool(os.getpid()) is None
    (tmp_path / "ps").write_text("#!/bin/sh\necho ' 2048'\n")
    monkeypatch.setattr(processes, "_TOOL", 60.0)
    assert processes._memory_by_tool(os.getpid()) == 2 << 20


def test_progress_is_a_bar_or_a_line_now_and_then(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr("shutil.get_terminal_size", lambda: os.terminal_size((60, 9)))

    def shown(is_terminal, total, done, steps):
        """What is written after each of these: seconds later, what has ended."""

        class Stream(io.StringIO):
            flushed = 0

            def isatty(self):
                return is_terminal

            def flush(self):
                self.flushed = len(self.getvalue())

        stream = Stream()
        monkeypatch.setattr(sys, "stderr", stream)
        found, place = Progress(total, done), 0
        for seconds, ended in steps:
            now[0] += seconds
            for status in ended:
                found.add(status)
            found.show()
            assert not is_terminal or stream.flushed == len(stream.getvalue())
            yield stream.getvalue()[place:]
            place = len(stream.getvalue())
        found.clear()
        drawn = len(stream.getvalue())
        found.clear()  # which is gone already
        assert drawn == len(stream.getvalue())
        found.finish()
        yield stream.getvalue()[place:]

    def lines(**values):
        return "body_moments: {}\n".format(sentence(**values))

    few = {"done": 3, "total": 10}
    rate = lines(code="progress_files", done=5, total=10, rate=0.4, left="12 s", failed=1)
    slow = lines(code="progress_files", done=6, total=10, rate=3 / 3605.01, left="1 h 20 min", failed=1)
    end = lines(code="progress_done", count=3, seconds=3605.01, counts="2 ok, 1 error")
    steps = [(4.99, ""), (0.01, ["ok", "error"]), (4.99, ["ok"]), (3595.02, "")]
    assert [*shown(False, 10, 3, steps)] == ["", rate, "", slow, end]
    assert [*shown(False, 10, 3, [(5.0, "")])] == [
        lines(code="progress_started", **few),
        lines(code="progress_done", count=0, seconds=5.0, counts="-"),
    ]
    two = dict(code="progress_files", done=1, total=2, rate=1 / 9.0, left="9 s", failed=0)
    two_end = lines(code="progress_done", count=1, seconds=9.0, counts="1 ok")
    assert [*shown(False, 2, 0, [(9.0, ["ok"])])] == [lines(**two), two_end]
    assert [*shown(False, 1, 0, [(9.0, ["ok"])])] == ["", ""]
    assert [*shown(True, 1, 0, [(9.0, ["ok"])])] == ["", ""]
    start = "\r\x1b[K"
    bars = ["[{:.<24}] {}".format("#" * cells, text)[:59] for cells, text in (
        (7, sentence("progress_started", **few)),
        (9, sentence("progress_files", done=4, total=10, rate=10.0, left="1 s", failed=0)),
    )]  # fmt: skip
    found = [*shown(True, 10, 3, [(0.0, ""), (0.09, ["ok"]), (0.01, "")])]
    assert found[:3] == [start + bars[0], "", start + bars[1]] and found[3].startswith(
        start + "body_moments: 1 file in"
    )
    at_once = sentence("progress_files", done=4, total=10, rate=1000.0, left="0 s", failed=0)
    assert [*shown(True, 10, 3, [(0.0, ["ok"])])][0] == start + "[{:.<24}] {}".format("#" * 9, at_once)[:59]
    for seconds, text in (
        (0.4, "0 s"),
        (59.4, "59 s"),
        (59.6, "1 min 00 s"),
        (3599.4, "59 min 59 s"),
        (3661, "1 h 01 min"),
    ):
        assert progress._duration(seconds) == text


def test_a_journal_is_known_and_damaged_lines_count_as_none(tmp_path):
    path = tmp_path / "journal"
    limits = {"seconds": 2.0, "memory": None}
    with Journal(path) as journal:
        for number in range(4):
            key = {"path": "f {}".format(number), "size": number}
            journal.append(key, "ok", 1, 0.1234567, limits, b' {"n": 1}\n', {"r": state("none")} if number else None)
    lines = path.read_bytes().splitlines(keepends=True)
    assert json.loads(lines[1])["seconds"] == 0.123457 and is_journal(path)
    wrong = [
        lines[0].replace(b"journal/1", b"journal/2"),
        lines[1].replace(b'"document": {"n": 1}', b'"document": 1'),
        lines[2].replace(b'"path": "f 2"', b'"path": 2'),
        lines[3].replace(b'"attempts": 1', b'"attempts": "x"'),
        b"[" * 100_000 + b"\n",
        b"{}\n",
        lines[3][:-2],
    ]
    path.write_bytes(lines[0] + b"".join(wrong))
    with Journal(path) as journal:
        assert list(journal.entries) == ["f 0"] and journal.document("f 0") == {"n": 1}
        entry = journal.entries["f 0"]
        assert (entry.key, entry.status, entry.attempts, entry.seconds) == (
            {"path": "f 0", "size": 0},
            "ok",
            1,
            0.123457,
        )
        assert (entry.limits, entry.refers, entry.offset, entry.length) == (limits, False, 0, len(lines[0]))
        journal.append({"path": "g"}, "ok", 1, 0.0, limits, b"{}", {"none": state("none")})
        assert journal.is_current("g") and journal.is_current("f 0")
        journal.append({"path": "g"}, "ok", 1, 0.0, limits, b"{}", {"none": {"size": 1, "mtime_ns": None}})
        assert not journal.is_current("g") and journal.entries["g"].refers
    with Journal(path) as journal:
        assert list(journal.entries) == ["f 0", "g"]
    for text in (b"a novel", lines[0].replace(b"journal/1", b"journal/10")):
        path.write_bytes(text)
        assert not is_journal(path)
    path.write_text("")
    assert is_journal(path)
    (tmp_path / "link").symlink_to(path)
    with pytest.raises(OSError):
        Journal(tmp_path / "link")


def test_a_journal_is_on_the_disk_once_a_second_and_in_the_end(tmp_path, monkeypatch):
    """So that little is lost where the machine stops."""
    now, synced = [100.0], []
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    monkeypatch.setattr(os, "fsync", lambda descriptor: synced.append((now[0], os.fstat(descriptor).st_size)))
    path = tmp_path / "journal"
    sizes = {}
    with Journal(path) as journal:
        for seconds in (0.5, 1.0, 1.001, 2.0, 2.001, 2.002, 9.0):
            now[0] = 100.0 + seconds
            journal.append({"path": "a"}, "ok", 1, 0.0, {}, b"{}")
            sizes[now[0]] = path.stat().st_size
    assert len({*sizes.values()}) == len(sizes) and journal._file.closed
    assert synced == [(at, sizes[at]) for at in (101.001, 102.002, 109.0, 109.0)]


def test_a_journal_may_be_read_by_whom_the_system_lets_read_files_and_is_made_where_links_are_followed(
    tmp_path, monkeypatch
):
    for name in ("O_NOFOLLOW", "O_BINARY"):  # which Windows has, or others
        monkeypatch.delattr(os, name, raising=False)
    before = os.umask(0)
    try:
        with Journal(tmp_path / "journal") as journal:
            journal.append({"path": "a"}, "ok", 1, 0.0, {}, b'{"n": 1}')
            assert journal.document("a") == {"n": 1}
    finally:
        os.umask(before)
    assert (tmp_path / "journal").stat().st_mode & 0o777 == 0o666
    assert json.loads((tmp_path / "journal").read_text())["reads"] == {}


def test_a_line_behind_a_torn_one_is_whole(tmp_path):
    path = tmp_path / "journal"
    for rest in (b"", b'{"schema": "body-moments-jou', b"\n", b"{}\n"):
        path.write_bytes(rest)
        with Journal(path) as journal:
            for name in "ab":
                journal.append({"path": name}, "ok", 1, 0.0, {}, json.dumps({"n": name}).encode())
            assert [journal.document(name) for name in "ab"] == [{"n": "a"}, {"n": "b"}]
        lines = path.read_bytes().splitlines(keepends=True)
        assert len(lines) == 2 + bool(rest) and all(line.endswith(b"\n") for line in lines)
        with Journal(path) as journal:
            assert [*journal.entries] == ["a", "b"] and journal.document("b") == {"n": "b"}


@pytest.mark.parametrize("status", ["ok", "error", "crashed", "timeout", "memory"])
def test_a_higher_limit_alone_is_a_reason_to_try_again(status):
    key = {"path": "a", "size": 1}
    name = {"timeout": "seconds", "memory": "memory"}.get(status)
    for before, now, higher in ((2.0, 2.0, False), (2.0, 2.5, True), (2.0, 1.5, False), (2.0, None, True)) + (
        *((None, None, False), (None, 2.0, False)),
    ):
        for limit in ("seconds", "memory"):
            limits, other = {"seconds": 5.0, "memory": 5.0, limit: before}, {"seconds": 5.0, "memory": 5.0, limit: now}
            entry = Entry(key, status, 1, 0.0, limits, False, 0, 1)
            assert entry.serves(key, other) == (not (higher and limit == name)), (limit, before, now)
            assert not entry.serves({**key, "size": 2}, other)


LINE = """
import importlib.util, sys, time
spec = importlib.util.spec_from_file_location("lifeline", {!r})
lifeline = importlib.util.module_from_spec(spec)
spec.loader.exec_module(lifeline)
lifeline.BY_SIGNAL, lifeline._LATE = {}, 0.2
line = lifeline.Lifeline(1, int(sys.argv[1]))
for message in line.messages():
    with line.limited(message["seconds"]):
        time.sleep(message["work"])
    line.answer(message, b"data" * message["many"])
line.answer({{"over": True}})
"""


@pytest.mark.parametrize("by_signal", [True, False])
def test_a_child_answers_what_it_is_sent_and_ends_with_its_supervisor(by_signal):
    watched, kept = os.pipe()
    words = [sys.executable, "-S", "-c", LINE.format(lifeline.__file__, by_signal), str(watched)]

    def child():
        return subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, pass_fds=[watched]
        )

    messages = [{"seconds": 60, "work": 0, "many": many} for many in (0, 3, 100_000)]
    answers = b"".join(
        b"\x1e" + json.dumps({**one, **({"bytes": 4 * one["many"]} if one["many"] else {})}).encode() + b"\n"
        + b"data" * one["many"] for one in messages
    )  # fmt: skip
    first = child()
    out, _ = first.communicate("".join(json.dumps(one) + "\n" for one in messages).encode(), timeout=60)
    # where a thread listens, the end of the messages is that of the process, whatever it is doing
    assert out == answers + b'\x1e{"over": true}\n' if by_signal else (answers + b"\x1e").startswith(out[:20])
    assert first.returncode == 0
    second = child()
    second.stdin.write(json.dumps({"seconds": 0.1, "work": 600, "many": 0}).encode() + b"\n")
    second.stdin.flush()
    assert second.wait(60) == 1 and b"Timeout" in second.stderr.read()  # after that time, and a moment
    third = child()
    third.stdin.write(json.dumps({"seconds": 600, "work": 600, "many": 0}).encode() + b"\n")
    third.stdin.flush()
    os.close(watched)
    os.close(kept)
    if by_signal:
        assert third.wait(60) in (0, -signal.SIGIO)
    third.stdin.close()
    assert third.wait(60) in (0, -signal.SIGIO)
    for one in (first, second, third):
        for stream in (one.stdin, one.stdout, one.stderr):
            stream.close()


RUN = """
import os, signal, sys, time
if {}:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
with open(sys.argv[1], "w") as file:
    file.write("started")
time.sleep(600)
"""


@pytest.mark.parametrize("stubborn", [False, True])
def test_a_whole_run_is_followed_and_stopped(tmp_path, monkeypatch, stubborn):
    asked, output = [], tmp_path / "out.json"

    def command(blender, words):
        asked.append((blender, words))
        return [sys.executable, "-S", "-c", RUN.format(stubborn), str(output)]

    monkeypatch.setattr(whole_run.processes, "run_command", command)
    monkeypatch.setattr(whole_run, "_STOP", 0.5 if stubborn else 60.0)
    found = WholeRun(["a", "b"], output, "blender")
    assert asked == [("blender", ["measure", "a", "b", "--output", str(output)])]
    while not output.exists():
        time.sleep(0.01)
    assert found.exit_code is None and found.done() == 0
    journal = tmp_path / "out.json.journal"
    for text, count in (("{}\n{", 1), ("}\n", 2), ("{}\n{}\n", 4)):
        with open(journal, "a") as file:
            file.write(text)
        assert found.done() == count
    journal.unlink()
    assert found.done() == 4
    found.stop()
    assert found.exit_code == (-signal.SIGKILL if stubborn else -signal.SIGTERM)
    found.stop()
    monkeypatch.setattr(whole_run.processes, "run_command", lambda *_: None)
    with pytest.raises(FileNotFoundError, match="bpy"):
        WholeRun([], output, None)


def test_a_run_ends_with_the_window_that_has_started_it():
    """A window that has gone already, and one that goes later, also where the signal of that was ignored; without one
    nothing is watched.
    """
    code = "import signal; signal.signal(signal.SIGIO, signal.SIG_IGN); "
    code += "import runpy; runpy.run_path({!r})['end_with_window'](); import os; os.write(1, b'.'); {}"
    for closed_before in (True, False):
        watched, kept = os.pipe()
        words = [sys.executable, "-c", code.format(lifeline.__file__, "import time; time.sleep(600)")]
        environment = {**os.environ, lifeline.WINDOW: str(watched)}
        if closed_before:
            os.close(kept)
        child = subprocess.Popen(words, env=environment, pass_fds=[watched], stdout=subprocess.PIPE)
        os.close(watched)
        assert child.stdout.read(1) == (b"" if closed_before else b".")
        if not closed_before:
            os.close(kept)
        assert child.wait(60) in (0, -signal.SIGIO)
        child.stdout.close()
    alone = [sys.executable, "-c", code.format(lifeline.__file__, "assert 'BODY_MOMENTS_WATCHED' not in os.environ")]
    assert subprocess.run(alone, check=True, stdout=subprocess.PIPE).stdout == b"."


def test_a_name_to_which_nothing_can_be_added_is_wrong_usage(tmp_path, fake, capsys):
    """The journal is called like the output, and so is what is kept of an older run."""
    place = tmp_path / "out"
    place.mkdir()
    for length, ending in ((250, ".journal"), (245, ".journal.old"), (240, "")):
        target = place / ("r" * length)
        code = batch.main(["measure", "ok 1", "ok 2", "--output", str(target), "--jobs", "1"], channel=-1)
        said = capsys.readouterr().err
        if ending:
            reason = sentence("usage_path", path=str(target) + ending, error="File name too long")
            assert code == 2 and said.endswith("error: {}\n".format(reason)) and not [*place.iterdir()]
        else:
            assert code == 0 and {path.name for path in place.iterdir()} == {target.name, target.name + ".journal"}
    target = place / "result"
    (place / ".result.journal.body_moments.lock").mkdir()
    assert batch.main(["measure", "ok 1", "--output", str(target)], channel=-1) == 2
    reason = sentence("usage_path", path=str(place / ".result.journal.body_moments.lock"), error="Is a directory")
    assert reason in capsys.readouterr().err and not target.exists()


def test_a_disk_that_is_full_is_said_and_the_older_result_stays(tmp_path, main, monkeypatch):
    words = (tmp_path / "ok 1", tmp_path / "ok 2", "--jobs", "1")
    assert main(*words)[0] == 0
    result = (tmp_path / "out" / "result").read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Journal, "append", full)
    code, _, said, _ = main(*words, reads=False)
    assert code == 1
    assert said[-1] == "body_moments: {}".format(sentence("usage_result_not_written", error="No space left on device"))
    assert (tmp_path / "out" / "result.old").read_bytes() == result


def test_an_interrupted_run_without_a_journal_says_so_alone(tmp_path, fake, monkeypatch, capsys):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(Pool, "step", interrupted)
    for target in ((), ("--output", "/dev/null")):
        assert supervised.measure(arguments.parse(["measure", "ok 1", "ok 2", *target]), -1, None) == 3
        assert capsys.readouterr().err == "body_moments: {}\n".format(sentence("interrupted"))


def test_the_blender_that_is_started_is_the_one_that_is_named_or_runs_this(monkeypatch, capsys):
    asked = []
    monkeypatch.setattr(processes, "child_command", asked.append)
    module, window = (SimpleNamespace(app=SimpleNamespace(module=one, binary_path="/blender")) for one in (True, False))
    cases = [(None, [], None), (module, [], None), (window, [], "/blender")]
    cases += [(one, ["--blender", "/other"], "/other") for one in (None, module, window)]
    for bpy, words, command in cases:
        options = arguments.parse(["measure", "a.stl", *words])
        monkeypatch.setitem(sys.modules, "bpy", bpy)
        with pytest.raises(SystemExit) as ended:
            supervised.measure(options, -1, None)
        monkeypatch.undo()
        monkeypatch.setattr(processes, "child_command", asked.append)
        assert ended.value.code == 2 and asked.pop() == command
        assert sentence("usage_no_blender") in capsys.readouterr().err


def test_a_command_needs_a_blender_or_the_module(monkeypatch):
    script = str(Path(batch.__file__).resolve())
    assert processes.child_command(None) == [sys.executable, script, "child"]
    command = processes.run_command("/b", ["measure", "x"])
    switches = ["-b", "--factory-startup", "--disable-autoexec", "--offline-mode", "-q", "--python-exit-code", "70"]
    assert command == ["/b", *switches, "--python", script, "--", "measure", "x"]
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *more: None if name == "bpy" else found(name, *more))
    assert processes.child_command(None) is None and processes.child_command("/b") == [*command[:11], "child"]


def test_processors_are_counted_where_a_process_is_bound_to_none(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity")
    for count in (6, None):
        monkeypatch.setattr(os, "cpu_count", lambda count=count: count)
        assert processes.cores() == (count or 1)
    monkeypatch.delattr(os, "sysconf")
    assert processes.memory_of_machine() is None and processes.memory_share(2) is None


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
def test_what_is_no_list_of_files_is_wrong_usage(tmp_path, fake, capsys, lines):
    listed = tmp_path / "list"
    listed.write_bytes(lines)
    assert batch.main(["measure", "--manifest", str(listed)], channel=-1) == 2
    assert capsys.readouterr().err.endswith("error: {}\n".format(sentence("manifest_malformed", file=str(listed))))
    assert not (tmp_path / "log").exists()


def test_the_names_in_a_list_are_meant_from_its_folder(tmp_path, monkeypatch):
    names = ["a.stl", "b/ü\n\udcff.stl", str(tmp_path / "c.stl")]
    (tmp_path / "in").mkdir()
    listed = tmp_path / "in" / "list"
    listed.write_text("".join(listing.write_lines(names)) + "\n")
    assert listing.read(listed) == [str(tmp_path / "in" / name) for name in names[:2]] + names[2:]
    monkeypatch.chdir(tmp_path)
    assert listing.read(Path("in/list")) == ["in/" + name for name in names[:2]] + names[2:]
    monkeypatch.chdir(tmp_path / "in")
    assert listing.read(Path("list")) == names
    missing = tmp_path / "none"
    with pytest.raises(QueryError) as refused:
        listing.read(missing)
    assert refused.value.finding == finding("manifest_unreadable", file=str(missing), error="No such file or directory")


class Channel:
    """A descriptor to which answers are written, and what came."""

    def __init__(self):
        self.reading, self.writing = os.pipe()

    def answers(self):
        os.close(self.writing)
        with open(self.reading, "rb") as file:
            return [json.loads(line.removeprefix(lifeline.MARK)) for line in file if line.startswith(lifeline.MARK)]


def test_where_a_thread_listens_messages_come_and_their_end_is_that_of_the_process(monkeypatch):
    """In one process: what would end it is noted."""
    ended, over = [], threading.Event()
    monkeypatch.setattr(lifeline, "BY_SIGNAL", False)
    monkeypatch.setattr(lifeline.os, "_exit", lambda code: (ended.append(code), over.set()))
    lines = [b'{"number": %d}\n' % number for number in range(3)]
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(b"".join(lines))))
    channel = Channel()
    line = lifeline.Lifeline(channel.writing, 5)
    assert int(Path("/proc/self/oom_score_adj").read_text()) >= 500  # where memory runs out it goes first
    messages = line.messages()
    assert [next(messages) for _ in lines] == [{"number": number} for number in range(3)]
    assert over.wait(60) and ended == [0]
    line.answer({"done": True})
    line.answer({"more": 1}, b"data")
    assert channel.answers() == [{"done": True}, {"more": 1, "bytes": 4}]


def test_a_file_has_its_time_and_no_longer(monkeypatch):
    """Also one at which something fails; afterwards a child may wait for as long as it has nothing to do."""
    asked = []
    monkeypatch.setattr(lifeline.faulthandler, "dump_traceback_later", lambda *what, **how: asked.append((what, how)))
    monkeypatch.setattr(lifeline.faulthandler, "cancel_dump_traceback_later", lambda: asked.append("over"))
    line = lifeline.Lifeline.__new__(lifeline.Lifeline)  # without its pipes
    with line.limited(7.0):
        assert asked == [((12.0,), {"exit": True, "file": 2})]
    assert asked.pop() == "over"
    with pytest.raises(ZeroDivisionError), line.limited(0.5):
        raise ZeroDivisionError
    assert asked[1:] == [((5.5,), {"exit": True, "file": 2}), "over"]


def test_where_there_are_no_descriptors_to_control_nothing_is_watched(monkeypatch):
    monkeypatch.setattr(lifeline, "BY_SIGNAL", False)
    monkeypatch.setenv(lifeline.WINDOW, "-1")
    lifeline.end_with_window()
    assert lifeline.WINDOW not in os.environ
    monkeypatch.setattr(lifeline, "fcntl", None)
    lifeline.end_with(-1)


def test_an_idle_child_that_ends_is_nobodys_fault(tmp_path, fake, monkeypatch):
    """Nor is what comes of one that has been let go, or of one that has been given nothing. Each start that fails is
    the first again where another child was ready since.
    """
    monkeypatch.setattr(pool, "MAX_FAILED_STARTS", 2)
    (tmp_path / "fail").touch()
    once = 'rm {} 2> /dev/null && exit 9; exec "$@"'.format(tmp_path / "fail")
    command = ["sh", "-c", once, "sh", *fake.command]
    with Pool(command, 1, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.wait_until_ready()
        (child,) = found._children
        assert found._receive(child, {}, b"stray") == [] and found._receive(child, {"note": "stray"}, b"") == []
        assert found.notes == []
        child.folder.rmdir()  # as where somebody else cleans up
        os.kill(child.process.pid, signal.SIGKILL)
        while found._children:
            assert found.step() == []
        assert found._receive(child, {"ready": {"blender": "other"}}, b"") == []
        assert found.about == {"blender": "9.8.7"} and not child.log.exists() and found._said(child) == ""
        (tmp_path / "fail").touch()
        shutil.rmtree(tmp_path / "work")  # by somebody who cleans up thoroughly
        found.add(["ok 1"])
        outcomes = []
        while not found.is_done:
            outcomes += found.step()
    assert [(one.status, one.attempts) for one in outcomes] == [("answered", 1)] and len(fake("setup")) == 2


def test_an_answer_that_comes_too_late_is_none(tmp_path, fake):
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.add(["hang"])
        outcomes = []
        while not found.is_done:
            for child in [child for child in found._children if child.task]:
                found._doom(child, "timeout")
                assert found._receive(child, {}, b"late") == []
            outcomes += found.step()
    assert [(one.status, one.attempts, one.data) for one in outcomes] == [("timeout", 2, b"")]


def test_an_idle_child_may_take_what_it_needs(tmp_path, fake, monkeypatch):
    monkeypatch.setattr(pool, "_STEP", 2.0 * pool._WATCH)
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0, 1), tmp_path / "work") as found:
        found.wait_until_ready()
        (child,) = found._children
        for _ in range(2):
            assert found.step() == []
        assert found._children == [child] and child.process.poll() is None


def test_a_child_that_was_let_go_and_does_not_end_is_ended(tmp_path, fake, monkeypatch):
    monkeypatch.setattr(pool, "_END", 0.2)
    monkeypatch.setattr(pool, "_STEP", 0.01)
    with Pool(fake.command, 1, {"options": {"object": None}}, Limits(60.0), tmp_path / "work") as found:
        found.wait_until_ready()
        (child,) = found._children
        os.kill(child.process.pid, signal.SIGSTOP)
        found._retire(child)
        assert found._children == [] and child.process.poll() is None
        begun = time.monotonic()
        while found._ending:
            found.step()
        assert child.process.returncode == -signal.SIGKILL and time.monotonic() - begun >= 0.2
        assert child.kept is None and not child.log.exists() and not child.folder.exists()


def test_without_options_a_file_has_half_an_hour_and_its_share_of_the_memory(tmp_path, main, fake):
    assert main(tmp_path / "ok 1", tmp_path / "ok 2", "--jobs", "2")[0] == 0
    assert {one["setup"]["seconds"] for one in fake("setup")} == {1800.0}
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    assert {one["setup"]["memory"] for one in fake("setup")} == {int(0.4 * machine)}
    assert 2.0 * processes._GRACE < 1.0  # a run ends within a second


def test_what_a_child_is_asked_to_end_by_is_heard_first(monkeypatch):
    """It may clean up, for a moment; one that does not listen is ended all the same, with all that it has started."""
    monkeypatch.setattr(processes, "_GRACE", 2.0)  # as much as a busy machine may need
    code = "import signal, sys, time; signal.signal(signal.SIGTERM, {}); print(flush=True); time.sleep(600)"
    heard, deaf = "lambda *_: sys.exit(7)", "signal.SIG_IGN"
    for gently, ends in ((True, [7, -signal.SIGKILL]), (False, [-signal.SIGKILL] * 2)):
        started = [
            subprocess.Popen(
                [sys.executable, "-S", "-c", code.format(one)], stdout=subprocess.PIPE, start_new_session=True
            )
            for one in (heard, deaf)
        ]
        for one in started:
            one.stdout.readline()
        begun = time.monotonic()
        processes.kill(started, gently=gently)
        took = time.monotonic() - begun
        assert [one.returncode for one in started] == ends and (took >= processes._GRACE) == gently
        processes.kill(started, gently=True)  # what has ended is not signaled again
        for one in started:
            one.stdout.close()


def test_of_a_process_that_is_gone_no_tool_is_asked_where_the_system_knows(monkeypatch):
    monkeypatch.setattr(processes, "_memory_by_tool", lambda pid: 5 * pid)
    gone = 2**22 + 1
    assert processes.memory_of(gone) is None
    monkeypatch.setattr(sys, "platform", "darwin")
    assert processes.memory_of(gone) == 5 * gone


@pytest.mark.parametrize("by_signal", [True, False])
def test_a_run_watches_the_window_that_starts_it_where_it_can(tmp_path, monkeypatch, by_signal):
    """By a pipe that the window alone holds open, until it has stopped the run; elsewhere it can be asked to end."""
    given = {}

    def popen(command, **options):
        given.update(options, command=command)
        given["inherited"] = [os.fstat(one).st_ino for one in options.get("pass_fds", ())]
        return SimpleNamespace(poll=lambda: 3)

    monkeypatch.setattr(whole_run.processes, "run_command", lambda blender, words: [blender, *words])
    monkeypatch.setattr(whole_run, "BY_SIGNAL", by_signal)
    monkeypatch.setattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0x200, raising=False)
    monkeypatch.setattr(subprocess, "Popen", popen)
    opened = {*os.listdir("/proc/self/fd")}
    run = WholeRun(["a"], tmp_path / "out", "/b")
    assert given["command"] == ["/b", "measure", "a", "--output", str(tmp_path / "out")] and run.exit_code == 3
    assert {given[name] for name in ("stdin", "stdout", "stderr")} == {subprocess.DEVNULL}
    if by_signal:
        (watched,) = given["pass_fds"]
        assert given["env"] == {**os.environ, lifeline.WINDOW: str(watched)} and "creationflags" not in given
        (kept,) = [one for one in {*os.listdir("/proc/self/fd")} - opened if os.path.exists("/proc/self/fd/" + one)]
        assert [os.fstat(int(kept)).st_ino] == given["inherited"] and int(kept) != watched
    else:
        assert "env" not in given and "pass_fds" not in given and given["creationflags"] == 0x200
    run.stop()
    run.stop()
    assert len(os.listdir("/proc/self/fd")) == len(opened)


def test_a_run_that_ends_asks_its_children_before_it_kills_them_and_hears_what_they_still_say(tmp_path, monkeypatch):
    asked, heard = [], []
    monkeypatch.setattr(processes, "kill", lambda children, **how: asked.append((children, how)))
    with Pool(["nothing"], 1, {}, Limits(60.0), tmp_path / "work") as pool:
        pool._readers.submit(lambda: (time.sleep(0.3), heard.append(True)))
    assert asked == [([], {"gently": True})] and heard == [True]


def test_the_folder_of_a_run_is_new_and_gone_in_the_end(tmp_path):
    """Also one that somebody else has removed meanwhile."""
    work = tmp_path / "new" / "work"
    with Pool(["nothing"], 1, {}, Limits(60.0), work):
        assert work.is_dir()
        with pytest.raises(FileExistsError), Pool(["nothing"], 1, {}, Limits(60.0), work):
            pass
    assert not work.exists()
    with Pool(["nothing"], 1, {}, Limits(60.0), work):
        work.rmdir()
