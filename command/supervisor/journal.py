# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The journal of a run, JSON lines; `Entry.reason_to_measure` decides whether --resume measures a
file again.

A line has the file's key (path, size, time of its last change, digest of the options, versions of
the add-on and of Blender), its status, the attempts and seconds it took, sizes and times of the
files that it refers to, and its document. Torn and damaged lines are ignored; the last line of a
path counts.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...core.measurement import check_document

if os.name == "nt":
    import msvcrt
else:
    import fcntl

SCHEMA = "body-moments-journal/1"
_SYNC = 1.0  # seconds between waits for the disk
_WITHOUT_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EINVAL, errno.ENOTSUP)
_LIMITED = ("timeout", "memory")  # statuses that other limits may change


@dataclass(frozen=True)
class Entry:
    """One file's line. offset, length: its position. options: of the earlier run that has written
    it.

    is_damaged: True if that run's document cannot be used.
    """

    head: dict[str, Any]
    offset: int
    length: int
    options: dict[str, Any] = field(default_factory=dict)
    is_damaged: bool = False

    @property
    def status(self) -> str:
        return self.head["status"]

    def reason_to_measure(
        self,
        key: dict[str, Any],
        options: dict[str, Any],
        limits: dict[str, Any],
        retry_failed: bool = False,
    ) -> str | None:
        """Return the reason for measuring the file again, as a part of a sentence, or None if there
        is none.
        """
        # The first reason that holds is given, so that the order of the reasons matters.
        changed = {name for name in key if self.head["key"].get(name) != key[name]}
        earlier_options = self.options
        names = sorted(
            name
            for name in earlier_options | options
            if earlier_options.get(name) != options.get(name)
        )
        other_options = ": ".join(filter(None, ["made with other options", " ".join(names)]))
        reasons = {
            other_options: "options" in changed,
            "made by another version": changed & {"addon", "blender"},
            "changed": changed,
            "failed": retry_failed and self.status != "ok",
            "ended by other limits": self.status in _LIMITED and self.head["limits"] != limits,
            "damaged in the journal": self.is_damaged,
            "whose references have changed": any(
                state(name) != before for name, before in self.head["reads"].items()
            ),
        }
        return next((reason for reason, holds in reasons.items() if holds), None)


class Journal:
    """An open journal, to which lines are appended. entries: the last line of each path.

    Raises OSError.
    """

    def __init__(self, path: Path) -> None:
        self.entries: dict[str, Entry] = {}
        self._file = open(path, "a+b")  # noqa: SIM115
        self._file.seek(0)
        self._end = 0  # offset of the next line
        self._torn = False  # True if the last line lacks its end
        for line in self._file:
            # A line that is torn, damaged or foreign counts as none.
            with suppress(ValueError, KeyError, TypeError, AttributeError, RecursionError):
                record = json.loads(line)
                self._add(record, len(line), **_read_back(record["document"]))
            self._end += len(line)
            self._torn = not line.endswith(b"\n")
        self._synced = time.monotonic()

    def _add(self, record: dict[str, Any], length: int, **read_back: Any) -> None:
        """Add the entry of a line of `length` bytes at `_end`. read_back: as of `_read_back`."""
        head = {name: record[name] for name in ("key", "status", "limits", "reads")}
        if record["schema"] == SCHEMA:
            self.entries[head["key"]["path"]] = Entry(head, self._end, length, **read_back)

    def append(self, head: dict[str, Any], document: bytes) -> None:
        """Append the line of a finished file.

        head: its key, status, attempts, seconds, limits, and `reads`, the files that it refers to,
        each with its `state`. document: JSON on one line. Raises OSError.
        """
        record = {"schema": SCHEMA} | head
        line = json.dumps(record)[:-1].encode() + b', "document": ' + document.strip() + b"}\n"
        self._end = self._file.seek(0, os.SEEK_END) + self._file.write(b"\n" * self._torn)
        self._torn = False
        self._file.write(line)
        self._file.flush()
        self._add(record, len(line))
        if time.monotonic() > self._synced + _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def document(self, path: str) -> dict[str, Any]:
        """Return the document of a file that is recorded. Raises OSError."""
        entry = self.entries[path]
        self._file.seek(entry.offset)
        return json.loads(self._file.read(entry.length))["document"]

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        """Flush the file to the disk, and close it. Raises OSError."""
        os.fsync(self._file.fileno())
        self._file.close()


def _read_back(document: dict[str, Any]) -> dict[str, Any]:
    """Return the fields `options` or `is_damaged` of an entry, from the document that an earlier
    run has recorded.
    """
    try:
        check_document(document)
    except ValueError:
        return {"is_damaged": True}
    return {"options": document.get("run", {}).get("options", {})}


def state(path: str) -> dict[str, int | None]:
    """Return the size and modification time of a file, by which it is recognized; None for each if
    it is missing.
    """
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return {"size": None, "mtime_ns": None}
    return {"size": status.st_size, "mtime_ns": status.st_mtime_ns}


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Create and lock a folder for the files of one run within the block, and remove it afterwards.

    The operating system holds the lock, and releases it when the process ends for any reason. A
    file system without locks is used without one. Raises BlockingIOError if another run has the
    folder, and OSError.
    """
    folder.mkdir(exist_ok=True)
    with open(folder / "lock", "wb") as file:
        try:
            if os.name == "nt":
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            else:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError) as error:  # the latter on Windows
            raise BlockingIOError from error
        except OSError as error:
            if error.errno not in _WITHOUT_LOCKS:
                raise
        try:
            yield
        finally:
            shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(folder, ignore_errors=True)  # Windows cannot remove open files
