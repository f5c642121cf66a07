# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""One writer of a file at a time.

The lock is one of the operating system, on a hidden file beside the one that is written: it ends with its process,
however that ends, and the file alone means nothing. It cannot be on the file itself, which is replaced.
"""

from __future__ import annotations

import errno
import hashlib
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .leftovers import removed

if os.name == "nt":
    import msvcrt
else:
    import fcntl

WAIT = 60.0  # seconds that a writer waits for the one before it
_PAUSE = 0.1
_LONGEST = 200  # bytes of a name to which more can be added; file systems take 255
_BUSY = {errno.EACCES, errno.EAGAIN, errno.EWOULDBLOCK, errno.EDEADLK, getattr(errno, "EDEADLOCK", errno.EDEADLK)}
_WITHOUT_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP}


class Busy(OSError):
    """Another process has been writing the file for too long."""

    def __init__(self) -> None:
        super().__init__("another process of body_moments is writing it; run this again when that has ended")


def beside(path: Path, ending: str) -> Path:
    """Return the path of a hidden file in the same folder, named after `path`."""
    name = path.name
    if len(os.fsencode(name)) > _LONGEST:
        name = hashlib.blake2b(os.fsencode(name), digest_size=16).hexdigest()
    return path.with_name(".{}.{}".format(name, ending))


@contextmanager
def locked(path: Path, wait: float | None = None) -> Iterator[bool]:
    """Keep other processes of ours from writing `path` within the block.

    Yield False on a file system that has no locks. path: without symbolic links. wait: seconds, by default WAIT. Raises
    Busy and OSError.
    """
    lock = beside(path, "body_moments.lock")
    descriptor = _acquired(lock, time.monotonic() + (WAIT if wait is None else wait))
    try:
        with removed(lock):  # while it is locked: whoever opened it meanwhile finds another file, or none, in its place
            yield descriptor is not None
    finally:
        if descriptor is not None:
            os.close(descriptor)
        if os.name == "nt":  # Windows cannot remove open files
            with suppress(OSError):
                lock.unlink()


def _acquired(lock: Path, deadline: float) -> int | None:
    """Return the descriptor that holds the lock, None if there are no locks."""
    while True:
        descriptor = _opened(lock)
        try:
            _lock(descriptor)
            if os.path.samestat(os.fstat(descriptor), os.stat(lock)):
                return descriptor
        except FileNotFoundError:
            pass  # its last owner removed it; so does the next line of the loop where it is another file
        except OSError as error:
            if error.errno in _WITHOUT_LOCKS:
                os.close(descriptor)
                return None
            if error.errno not in _BUSY:
                os.close(descriptor)
                raise
            if time.monotonic() >= deadline:
                os.close(descriptor)
                raise Busy from None
            time.sleep(_PAUSE)
        os.close(descriptor)


def _opened(lock: Path) -> int:
    flags = os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    try:
        return os.open(lock, flags | os.O_RDWR, 0o666)
    except PermissionError:  # left by another user; network file systems alone need more than reading
        return os.open(lock, flags | os.O_RDONLY, 0o666)


def _lock(descriptor: int) -> None:
    if os.name == "nt":
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
