# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that must not outlive their use, however the process is asked to end."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_ENDS = tuple(getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name))
_present: set[Path] = set()


@contextmanager
def removed(*paths: Path) -> Iterator[None]:
    """Remove the files when the block ends, or if a signal ends the process within it. None need exist."""
    taken = _take_signals()
    _present.update(paths)
    try:
        yield
    finally:
        _remove(paths)
        _present.difference_update(paths)
        for number in taken:
            signal.signal(number, signal.SIG_DFL)


def _remove(paths: tuple[Path, ...]) -> None:
    for path in paths:
        with suppress(OSError):
            path.unlink()


def _take_signals() -> list[int]:
    """Take the signals that nobody else handles or ignores, until the block ends. Return them."""
    free = [number for number in _ENDS if signal.getsignal(number) == signal.SIG_DFL]
    try:
        for number in free:
            signal.signal(number, _end)
    except ValueError:  # only the main thread can have any
        return []
    return free


def _end(number: int, _frame: object) -> None:
    """Clean up, then die of the signal as if it had not been handled.

    Raising would not do: an exception within an importer that is written in Python becomes an error of that importer.
    """
    _remove(tuple(_present))
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
