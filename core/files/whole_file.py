# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are written whole or not at all."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from .file_lock import beside, locked
from .leftovers import removed


@contextmanager
def whole_file(path: Path, check: Callable[[Path], None] | None = None) -> Iterator[BinaryIO]:
    """Open a file to write to, which takes the place of `path` once it is on the disk, and is gone if that fails.

    A pipe or a device is written to, and not replaced.

    check: raises FileExistsError if `path` must not be replaced. It is called last of all, because the file may have
    appeared meanwhile; the written data is kept beside it then. Raises OSError.
    """
    if path.exists() and not path.is_file():
        with open(path, "wb") as file:
            yield file
        return
    path = path.resolve()
    with locked(path) as alone, partial_file(path, alone) as partial:
        mode = 0o600 if path.exists() else 0o666
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
        with open(os.open(partial, flags, mode), "wb") as file:
            yield file
        try:
            if check is not None:
                check(path)
        except FileExistsError as refusal:
            kept = _free_name(path)
            replace(partial, kept)
            raise FileExistsError("{}; it is in {}".format(refusal, kept)) from None
        replace(partial, path)


@contextmanager
def partial_file(path: Path, alone: bool) -> Iterator[Path]:
    """Yield the name of a file beside `path` to write first, gone when the block ends.

    Files left by processes that were killed go too, if nobody else can be writing.
    """
    partial = beside(path, "{}.partial".format(os.getpid()))
    written = Path("{}@".format(partial))  # Blender's own, while it saves
    ours = re.compile(re.escape(beside(path, "").name) + r"\d+\.partial@?")
    stale = [partial, written]
    with suppress(PermissionError):  # a folder that may be written to, and not listed
        stale += [one for one in path.parent.iterdir() if ours.fullmatch(one.name)] if alone else []
    with removed(partial, written):
        for one in stale:
            with suppress(FileNotFoundError):
                one.unlink()
        yield partial


def replace(partial: Path, path: Path) -> None:
    """Put a complete file in the place of another, whose owner and mode it takes, and wait for the disk.

    Raises OSError.
    """
    with suppress(FileNotFoundError):
        _take_owner_and_mode(partial, os.stat(path))
    with open(partial, "rb+") as file:
        os.fsync(file.fileno())
    os.replace(partial, path)
    with suppress(OSError):  # not every system can open folders
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def _take_owner_and_mode(path: Path, status: os.stat_result) -> None:
    if hasattr(os, "chown"):
        own = os.stat(path)
        # One at a time: a group of one's own may be given to a file where its owner may not.
        for uid, gid in ((status.st_uid, -1), (-1, status.st_gid)):
            if (uid, gid) not in ((own.st_uid, -1), (-1, own.st_gid)):
                with suppress(OSError):
                    os.chown(path, uid, gid)
    os.chmod(path, stat.S_IMODE(status.st_mode))


def _free_name(path: Path) -> Path:
    """Create an empty file of a new name beside `path`. Return its path."""
    number = 1
    while True:
        free = path.with_name("{}.{}{}".format(path.stem, number, path.suffix))
        try:
            free.open("x").close()
        except FileExistsError:
            number += 1
        else:
            return free
