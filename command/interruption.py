# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Interruption of a run by signals, and progress messages of long reads."""

import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from ..core.measurement import print_message

PERIOD = 5.0  # seconds between reports of progress
_NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")

_signals: list[int] = []  # the first signal of the run, once it has come


@contextmanager
def interruptible() -> Iterator[None]:
    """Raise KeyboardInterrupt within the block on every signal that asks a process to end, also in
    `blender -b`.

    Only the first signal counts: nothing disturbs the cleanup after it. An ignored signal, as in
    the background of a shell, stays ignored.
    """
    _signals.clear()
    before = {}

    def stop(caught: int, _frame: object) -> None:
        _signals.append(caught)
        for number in before:
            signal.signal(number, signal.SIG_IGN)
        raise KeyboardInterrupt

    with suppress(ValueError):  # only the main thread can handle signals
        for number in [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]:
            if signal.getsignal(number) != signal.SIG_IGN:
                before[number] = signal.signal(number, stop)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)  # None: Blender's own, in C


def check_interruption() -> None:
    """Raise KeyboardInterrupt if a signal has come: an importer may have turned the first one into
    its own error.
    """
    if _signals:
        raise KeyboardInterrupt


class Progress:
    """A counter of the "samples" or "faces" read from a file, reported with the file's name every
    `PERIOD` seconds.
    """

    def __init__(
        self, file: str, unit_name: str, report: Callable[[str, str], None] = print_message
    ) -> None:
        self._file = file
        self._unit_name = unit_name
        self._report = report
        self._count = 0
        self._due = time.monotonic() + PERIOD

    def __call__(self, count: int) -> None:
        self._count += count
        if time.monotonic() >= self._due:
            self._due = time.monotonic() + PERIOD
            self._report(
                self._file, "{:.3g} {} read. Ctrl+C ends it".format(self._count, self._unit_name)
            )
