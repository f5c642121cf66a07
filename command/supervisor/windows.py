# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory queries by a library of Windows, because a command of Windows takes half a second for each query."""

from __future__ import annotations

import ctypes
from contextlib import suppress
from typing import Any

_QUERY = 0x1000  # PROCESS_QUERY_LIMITED_INFORMATION
_Size = ctypes.c_size_t


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


def memory_of(pid: int) -> int | None:
    """Return the bytes of a process's private memory, or None if unknown."""
    with suppress(OSError, AttributeError):
        library = _library()
        library.OpenProcess.restype = ctypes.c_void_p
        process = library.OpenProcess(_QUERY, False, pid)
        if not process:
            return None
        counters = _Counters(cb=ctypes.sizeof(_Counters))
        try:
            size = ctypes.c_uint32(counters.cb)
            if library.K32GetProcessMemoryInfo(ctypes.c_void_p(process), ctypes.byref(counters), size):
                return counters.PrivateUsage
        finally:
            library.CloseHandle(ctypes.c_void_p(process))
    return None


def memory_of_machine() -> int | None:
    """Return the bytes of physical memory, or None if unknown."""
    with suppress(OSError, AttributeError):
        status = _Status(dwLength=ctypes.sizeof(_Status))
        if _library().GlobalMemoryStatusEx(ctypes.byref(status)):
            return status.ullTotalPhys
    return None


def _library() -> Any:
    return getattr(ctypes, "WinDLL")("kernel32")  # noqa: B009 which other systems do not have
