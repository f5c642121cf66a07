# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Journal of a run: JSON lines, appended as each file ends, from which the run can continue after any end.

A line has the file's key (path, size, time of its last change, digest of the options, versions of the add-on and of
Blender), its status, the attempts and seconds it took, sizes and times of the files that it refers to, and its
document. A line that is torn or damaged counts as none; of two with one path the later counts.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SCHEMA = "body-moments-journal/1"
_SYNC = 1.0  # seconds between waits for the disk
_BEYOND = {"timeout": "seconds", "memory": "memory"}  # statuses that a higher limit may change


@dataclass(frozen=True)
class Entry:
    """One file's line without its document.

    refers: whether the file refers to others. offset, length: position of the line.
    """

    key: dict[str, Any]
    status: str
    attempts: int
    seconds: float
    limits: dict[str, Any]
    refers: bool
    offset: int
    length: int

    def serves(self, key: dict[str, Any], limits: dict[str, Any]) -> bool:
        """Return whether measuring the file again would give the same result."""
        name = _BEYOND.get(self.status)
        if name is not None:
            before, now = self.limits.get(name), limits[name]
            if before is not None and (now is None or now > before):
                return False
        return self.key == key


class Journal:
    """An open journal, to which lines are appended. entries: the last of each path. Raises OSError."""

    def __init__(self, path: Path) -> None:
        self.entries: dict[str, Entry] = {}
        flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0) | getattr(os, "O_NOFOLLOW", 0)
        self._file = open(os.open(path, flags, 0o666), "r+b")  # noqa: SIM115
        end = 0
        for offset, line in _lines(self._file):
            end = offset + len(line)
            entry = _entry(line, offset)
            if entry is not None:
                self.entries[entry.key["path"]] = entry
        self._file.seek(max(0, end - 1))
        self._torn = bool(end) and self._file.read(1) != b"\n"
        self._synced = time.monotonic()

    def append(
        self,
        key: dict[str, Any],
        status: str,
        attempts: int,
        seconds: float,
        limits: dict[str, Any],
        document: bytes,
        reads: dict[str, Any] | None = None,
    ) -> None:
        """Append the line of a finished file.

        document: JSON on one line. reads: the files that the file refers to, each with its `state`. Raises OSError.
        """
        head = {
            "schema": SCHEMA,
            "key": key,
            "status": status,
            "attempts": attempts,
            "seconds": round(seconds, 6),
            "limits": limits,
            "reads": reads or {},
        }
        line = json.dumps(head)[:-1].encode() + b', "document": ' + document.strip() + b"}\n"
        offset = self._file.seek(0, os.SEEK_END)
        if self._torn:
            offset += self._file.write(b"\n")
            self._torn = False
        self._file.write(line)
        self._file.flush()
        self.entries[key["path"]] = Entry(key, status, attempts, seconds, limits, bool(reads), offset, len(line))
        if time.monotonic() > self._synced + _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def document(self, path: str) -> dict[str, Any]:
        """Return the document of a file that is recorded. Raises OSError."""
        return self._line(path)["document"]

    def is_current(self, path: str) -> bool:
        """Return whether the references of a recorded file are unchanged. Raises OSError."""
        reads = self._line(path)["reads"] if self.entries[path].refers else {}
        return all(state(name) == before for name, before in reads.items())

    def _line(self, path: str) -> dict[str, Any]:
        entry = self.entries[path]
        self._file.seek(entry.offset)
        return json.loads(self._file.read(entry.length))

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        """Wait for the disk, and let go of the file. Raises OSError."""
        os.fsync(self._file.fileno())
        self._file.close()


def state(path: str) -> dict[str, int | None]:
    """Return the size and modification time of a file, by which it is recognized; None for each if it is missing."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return {"size": None, "mtime_ns": None}
    return {"size": status.st_size, "mtime_ns": status.st_mtime_ns}


def is_journal(path: Path) -> bool:
    """Return whether a file is empty, or begins as a journal does. Raises OSError."""
    start = json.dumps({"schema": SCHEMA})[:-1].encode()
    with open(path, "rb") as file:
        return file.read(len(start)) in (b"", start)


def _lines(file: Any) -> Iterator[tuple[int, bytes]]:
    offset = 0
    for line in file:
        yield offset, line
        offset += len(line)


def _entry(line: bytes, offset: int) -> Entry | None:
    """Return the entry of a line, or None if it is damaged or foreign."""
    if not line.endswith(b"\n"):
        return None
    try:
        record = json.loads(line)
        if record["schema"] != SCHEMA or not isinstance(record["document"], dict):
            return None
        entry = Entry(
            dict(record["key"]),
            str(record["status"]),
            int(record["attempts"]),
            float(record["seconds"]),
            dict(record["limits"]),
            bool(record.get("reads")),
            offset,
            len(line),
        )
        return entry if isinstance(entry.key["path"], str) else None
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
