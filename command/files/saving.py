# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--write: saving of results into the opened .blend file, never into a file that has replaced it meanwhile.

The file is locked from before it is opened until it is saved, so that a second writer measures the results of the
first. Programs that ignore the lock are noticed by the file's content.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.files.file_lock import locked
from ...core.files.whole_file import partial_file, replace
from ...core.verdict.finding import FileError, Finding, finding, system_reason
from ..findings import (
    FILE_CHANGED_MEANWHILE,
    FILE_CHANGED_SINCE_START,
    FILE_NOT_SAVED,
    FILE_READ_ONLY,
    FILE_VANISHED,
    HARD_LINK_SEVERED,
)
from .files import reason

_PACKED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # start of a .blend compressed with zstd or gzip


@dataclass
class Place:
    """A .blend file that is going to take results.

    path: without symbolic links. digest: of the opened content. refusal: the reason why it cannot be saved, if known
    already. alone: whether nobody else can be writing it.
    """

    path: Path
    digest: bytes = b""
    refusal: Finding | None = None
    alone: bool = False

    def save(self) -> tuple[Finding, ...]:
        """Save the open scene, whole or not at all. Returns warnings. Raises FileError."""
        if self.refusal:
            raise FileError(self.refusal)
        try:
            return self._save()
        except (RuntimeError, OSError) as error:
            raise FileError(FILE_NOT_SAVED, error=reason(error)) from error

    def _save(self) -> tuple[Finding, ...]:
        if not os.path.lexists(self.path):
            raise FileError(FILE_VANISHED)
        if not os.access(self.path, os.W_OK):
            raise FileError(FILE_READ_ONLY)
        with open(self.path, "rb") as file:
            packed = file.read(4).startswith(_PACKED)
        with partial_file(self.path, self.alone) as partial:
            mask = os.umask(0o077)  # until it has the mode of the other
            try:
                bpy.ops.wm.save_as_mainfile(filepath=str(partial), copy=True, compress=packed, relative_remap=False)
            finally:
                os.umask(mask)
            if _digest(self.path) != self.digest:
                raise FileError(FILE_CHANGED_MEANWHILE)
            names = os.stat(self.path).st_nlink
            replace(partial, self.path)
        if names < 2:
            return ()
        return (finding(HARD_LINK_SEVERED, count=names, file=self.path.name),)


@contextmanager
def reserved(path: str, opened: bool, at_start: bool) -> Iterator[Place]:
    """Reserve the file for this process, which opens it within the block.

    opened: it is open already. at_start: Blender opened it when it started, before anything here could look at it.
    """
    place = Place(Path(os.path.realpath(path)))
    with ExitStack() as held:
        try:
            before = _digest(place.path) if opened else None
            place.alone = held.enter_context(locked(place.path))
            place.digest = _digest(place.path)
            if before not in (None, place.digest):
                place.refusal = finding(FILE_CHANGED_MEANWHILE)
            elif at_start and _saved_since_start(place.path):
                place.refusal = finding(FILE_CHANGED_SINCE_START)
        except OSError as error:
            place.refusal = finding(FILE_NOT_SAVED, error=system_reason(error))
        yield place


def _digest(path: Path) -> bytes:
    """Return a digest of the content.

    Sizes and times do not change if two programs save within one tick of a file system's clock.
    """
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "blake2b").digest()


def _saved_since_start(path: Path) -> bool:
    """Return whether the file is younger than this session's folder, which Blender makes before it opens a file."""
    status = os.stat(path)
    return max(status.st_mtime_ns, status.st_ctime_ns) > os.stat(bpy.app.tempdir).st_ctime_ns
