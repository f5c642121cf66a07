# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Child processes: their start, memory and end; a whole run in a process of its own, for a
window.
"""

import ctypes
import importlib.util
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from .lifeline import WINDOW

_WINDOWS = os.name == "nt"
# on Windows: a process that can be asked to end
_NEW_GROUP = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)
_MEMORY_SHARE = 0.8  # share of the machine's memory, for all processes that measure
_END = 5.0  # seconds that a killed process may take to be gone
_TOOL = 5.0  # seconds that a tool of the system may take to answer
_GRACE = 0.4  # seconds to clean up in, for a child that is asked to end
# Blender without a window, of factory settings, that runs no script of a file and reaches no
# network.
_SWITCHES = (
    "-b",
    "--factory-startup",
    "--disable-autoexec",
    "--offline-mode",
    "-q",
    "--python-exit-code",
    "70",
)
_STOP = 5.0  # seconds that a run may take to stop
# On Windows, its own library is asked: a command takes half a second for each query.
_QUERY = 0x1000  # PROCESS_QUERY_LIMITED_INFORMATION
_Size = ctypes.c_size_t


def run_command(blender: str | None, words: Sequence[str]) -> list[str]:
    """Return the command that runs our command line with these words in a Blender, else in this
    Python.
    """
    batch = importlib.util.find_spec("...operators.batch", __package__)
    assert batch is not None and batch.origin is not None
    script = str(Path(batch.origin).resolve())
    if blender is not None:
        return [blender, *_SWITCHES, "--python", script, "--", *words]
    return [sys.executable, script, *words]


def has_blender() -> bool:
    """Return whether this process is a Blender, or this Python has the bpy module."""
    return sys.modules.get("bpy") is not None or importlib.util.find_spec("bpy") is not None


def start(command: Sequence[str], folder: Path, log: Path) -> subprocess.Popen[bytes]:
    """Start a child with temporary and user files in `folder` and its standard error in `log`.

    Messages go to its standard input, answers come from its standard output. Raises OSError.
    """
    folder.mkdir()
    temporary = dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder))
    environment = os.environ | temporary | {"BLENDER_USER_RESOURCES": str(folder / "user")}
    with open(log, "ab") as errors:
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            env=environment,
            creationflags=_NEW_GROUP,  # a terminal's Ctrl+C is for the supervisor alone
            start_new_session=not _WINDOWS,
        )


def kill(processes: Sequence[subprocess.Popen[bytes]], *, gently: bool = False) -> None:
    """End processes and their descendants. gently: they may remove unfinished files first."""
    if gently and not _WINDOWS:
        for process in processes:
            _signal(process, signal.SIGTERM)
        grace = time.monotonic() + _GRACE  # for all of them together
        for process in processes:
            with suppress(subprocess.TimeoutExpired):
                process.wait(max(0.0, grace - time.monotonic()))
    for process in processes:
        if _WINDOWS:
            with suppress(OSError):
                process.kill()
        else:
            _signal(process, signal.SIGKILL)
    for process in processes:
        with suppress(subprocess.TimeoutExpired):  # the system itself may hang on it
            process.wait(_END)


def _signal(process: subprocess.Popen[bytes], number: int) -> None:
    """Send a signal to the process group that a child leads, unless the child has ended and been
    waited for.
    """
    if process.returncode is None:
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, number)


def how_it_ended(code: int | None) -> str:
    """Return a text about a process's end: the name of the signal, which is a negative code, or the
    exit code. Codes of Windows' exceptions are known as hexadecimal numbers.
    """
    if code is None:
        return "no answer"
    try:
        return signal.Signals(-code).name
    except ValueError:
        return "exit code " + ("{:#x}".format(code & 0xFFFFFFFF) if code > 255 else str(code))


def memory_of(pid: int) -> int | None:
    """Return the bytes of a process's own memory, without mapped files, or None if unknown."""
    if _WINDOWS:
        return _memory_on_windows(pid)
    with suppress(OSError, ValueError, subprocess.SubprocessError):
        if not sys.platform.startswith("linux"):  # a tool of macOS and BSD tells resident bytes
            words = ["ps", "-o", "rss=", "-p", str(pid)]
            return 1024 * int(subprocess.run(words, capture_output=True, timeout=_TOOL).stdout)
        status = Path("/proc/{}/status".format(pid)).read_bytes().splitlines()
        kinds = (b"RssAnon:", b"RssShmem:", b"VmSwap:")  # in kilobytes
        sizes = [1024 * int(line.split()[1]) for line in status if line.startswith(kinds)]
        return sum(sizes) if sizes else None
    return None


def memory_of_machine() -> int | None:
    """Return the bytes of physical memory, or None if unknown."""
    if _WINDOWS:
        return _windows_memory()
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None


def memory_share(count: int = 1) -> int | None:
    """Return the bytes that each of `count` processes may take, or None if the machine's memory is
    unknown.
    """
    machine = memory_of_machine()
    return None if machine is None else int(_MEMORY_SHARE * machine / count)


def cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


class WholeRun:
    """A running `measure` with the given words.

    output: its result. blender: the Blender to start; None for this Python, if it has the bpy
    module. Raises OSError.
    """

    def __init__(self, words: Sequence[str], output: Path, blender: str | None) -> None:
        command = run_command(blender, ["measure", *words, "--output", str(output)])
        self._journal = output.with_name(output.name + ".journal")
        self._place = 0  # offset in the journal up to which lines were counted
        self._lines = 0
        nowhere = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        environment = os.environ | {WINDOW: "1"}
        self._process = subprocess.Popen(
            command, env=environment, creationflags=_NEW_GROUP, **nowhere
        )

    @property
    def exit_code(self) -> int | None:
        """The exit code of the run, None while it is under way."""
        return self._process.poll()

    def done(self) -> int:
        """Return the count of files that the journal records so far."""
        try:
            with open(self._journal, "rb") as file:
                file.seek(self._place)
                data = file.read()
        except OSError:
            return self._lines
        self._place += len(data)
        self._lines += data.count(b"\n")
        return self._lines

    def stop(self) -> None:
        """End the run and its children. Measured files stay in its journal."""
        if self._process.poll() is None:
            with suppress(OSError):
                self._process.send_signal(getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM))
            try:
                self._process.wait(_STOP)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()


class _Counters(ctypes.Structure):
    """The structure PROCESS_MEMORY_COUNTERS_EX."""

    _fields_ = (
        *(("cb", ctypes.c_uint32), ("PageFaultCount", ctypes.c_uint32)),
        *(("PeakWorkingSetSize", _Size), ("WorkingSetSize", _Size)),
        *(("QuotaPeakPagedPoolUsage", _Size), ("QuotaPagedPoolUsage", _Size)),
        *(("QuotaPeakNonPagedPoolUsage", _Size), ("QuotaNonPagedPoolUsage", _Size)),
        *(("PagefileUsage", _Size), ("PeakPagefileUsage", _Size), ("PrivateUsage", _Size)),
    )


class _Status(ctypes.Structure):
    """The structure MEMORYSTATUSEX."""

    _fields_ = (
        *(("dwLength", ctypes.c_uint32), ("dwMemoryLoad", ctypes.c_uint32)),
        *(("ullTotalPhys", ctypes.c_uint64), ("ullAvailPhys", ctypes.c_uint64)),
        *(("ullTotalPageFile", ctypes.c_uint64), ("ullAvailPageFile", ctypes.c_uint64)),
        *(("ullTotalVirtual", ctypes.c_uint64), ("ullAvailVirtual", ctypes.c_uint64)),
        ("ullAvailExtendedVirtual", ctypes.c_uint64),
    )


def _memory_on_windows(pid: int) -> int | None:
    with suppress(OSError, AttributeError):
        library = _library()
        library.OpenProcess.restype = ctypes.c_void_p
        process = ctypes.c_void_p(library.OpenProcess(_QUERY, False, pid))
        counters = _Counters(cb=ctypes.sizeof(_Counters))
        size = ctypes.c_uint32(counters.cb)
        is_known = library.K32GetProcessMemoryInfo(process, ctypes.byref(counters), size)
        library.CloseHandle(process)
        return counters.PrivateUsage if is_known else None
    return None


def _windows_memory() -> int | None:
    with suppress(OSError, AttributeError):
        status = _Status(dwLength=ctypes.sizeof(_Status))
        if _library().GlobalMemoryStatusEx(ctypes.byref(status)):
            return status.ullTotalPhys
    return None


def _library() -> Any:
    return getattr(ctypes, "WinDLL")("kernel32")  # noqa: B009 which other systems do not have
