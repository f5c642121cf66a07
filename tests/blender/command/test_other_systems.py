# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways of the supervisor on Windows and macOS, as far as they can be taken here: what asks those systems is in the
place of them, everything else is real.
"""

import ctypes
import os
import shutil
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("bpy")
from body_moments.operators.supervisor import processes, whole_run, windows

from tests.blender.command.test_process import SCRIPT, process
from tests.soak import commands

elsewhere = pytest.mark.skipif(os.name == "nt", reason="not on this system: it is the one that is imitated")


class Kernel:
    """The part of Windows' library that tells of memory."""

    def __init__(self, is_there=True):
        self.is_there, self.closed = is_there, []
        self.OpenProcess = lambda *words: self.opened(*words)  # which takes an attribute
        self.CloseHandle = lambda handle: self.closed.append(handle.value)

    def opened(self, access, inherited, pid):
        assert (access, inherited, pid) == (0x1000, False, 17)  # no more than to ask
        return 0x123456789A if self.is_there else None  # beyond 32 bits

    def K32GetProcessMemoryInfo(self, process, counters, size):
        found = ctypes.cast(counters, ctypes.POINTER(windows._Counters)).contents
        assert process.value == 0x123456789A and size.value == found.cb == ctypes.sizeof(windows._Counters)
        found.PrivateUsage = 5 << 32
        return 1

    def GlobalMemoryStatusEx(self, status):
        found = ctypes.cast(status, ctypes.POINTER(windows._Status)).contents
        assert found.dwLength == ctypes.sizeof(windows._Status) == 64
        found.ullTotalPhys = 64 << 30
        return 1


def test_memory_on_windows(monkeypatch):
    monkeypatch.setattr(processes, "_WINDOWS", True)
    kernel = Kernel()
    monkeypatch.setattr(ctypes, "WinDLL", lambda name: kernel, raising=False)
    assert processes.memory_of(17) == 5 << 32 and kernel.closed == [0x123456789A]
    assert processes.memory_of_machine() == 64 << 30
    kernel.is_there = False
    assert processes.memory_of(17) is None
    monkeypatch.setattr(ctypes, "WinDLL", lambda name: SimpleNamespace(), raising=False)
    assert processes.memory_of(17) is None and processes.memory_of_machine() is None


@elsewhere
@pytest.mark.skipif(not shutil.which("ps"), reason="needs ps")
def test_memory_on_macos():
    told, known = processes._memory_by_tool(os.getpid()), processes.memory_of(os.getpid())
    assert told > (1 << 20) and (known is None or 0.5 * known < told)
    assert processes._memory_by_tool(1 << 30) is None


@elsewhere
def test_a_child_on_windows_is_a_group_of_its_own_without_a_pipe_to_watch(monkeypatch, tmp_path):
    given = {}

    def popen(command, **options):
        given.update(options, command=command)
        return SimpleNamespace(pid=1)

    monkeypatch.setattr(processes, "_WINDOWS", True)
    monkeypatch.setattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0x200, raising=False)
    monkeypatch.setattr(subprocess, "Popen", popen)
    _, kept = processes.start(["blender", "child"], tmp_path / "work", tmp_path / "log")
    assert kept is None and given["command"] == ["blender", "child"] and given["pass_fds"] == ()
    assert given["creationflags"] == 0x200 and not given["start_new_session"]
    assert given["env"]["TEMP"] == str(tmp_path / "work") and (tmp_path / "work").is_dir()
    ended = []
    one = SimpleNamespace(kill=lambda: ended.append("killed"), wait=lambda seconds: ended.append("waited for"))
    processes.kill([one], gently=True)
    assert ended == ["killed", "waited for"]


@elsewhere
def test_a_window_on_windows_asks_its_run_to_end_by_a_break(monkeypatch, tmp_path):
    """The signal of the break is another one here; what it does is real."""
    monkeypatch.setattr(whole_run, "BY_SIGNAL", False)
    monkeypatch.setattr(signal, "CTRL_BREAK_EVENT", signal.SIGHUP, raising=False)
    for number in range(2):
        np.save(tmp_path / "{}.npy".format(number), np.full((3, 4, 5), number + 1, "u2"))
    slow = tmp_path / "z_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    run = whole_run.WholeRun([str(tmp_path), "--jobs", "1"], tmp_path / "out.json", None)
    try:
        assert commands.wait_until(lambda: run.done() == 2, 120.0)
        born = commands.children(run._process.pid)
    finally:
        run.stop()
    assert run.exit_code == 3
    assert not any(map(commands.is_running, born))
    assert not (tmp_path / ".out.json.body_moments.work").exists()


@elsewhere
def test_a_run_whose_children_watch_by_a_thread(tmp_path):
    """As on macOS, where no signal comes when a pipe closes: they end when their supervisor is killed."""
    (tmp_path / "python").mkdir()
    (tmp_path / "python" / "sitecustomize.py").write_text("import sys; sys.platform = 'darwin'")
    environment = {"PYTHONPATH": str(tmp_path / "python")}
    scan = tmp_path / "scan.npy"
    np.save(scan, np.full((3, 4, 5), 7, "u2"))
    out = tmp_path / "out.jsonl"
    ended = process(sys.executable, SCRIPT, "measure", scan, "--format", "jsonl", "--output", out, env=environment)
    assert ended.returncode == 0, ended.stderr
    assert commands.documents(out)[0]["objects"][0]["mass"] == 420.0
    slow = tmp_path / "z_2048x2048x2048_uint8.raw"
    slow.touch()
    os.truncate(slow, 1 << 33)
    running = commands.start(slow, "--output", tmp_path / "slow.json", env={**os.environ, **environment})
    try:
        assert commands.wait_until(lambda: (tmp_path / "slow.json.journal").exists(), 120.0)
        born = commands.children(running.pid)
    finally:
        running.kill()
        running.communicate(timeout=20)
    assert commands.wait_until(lambda: not any(map(commands.is_running, born)), 60.0)
