# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl+C ends a run wherever it is, and long reads say how far they are."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ..core.measurement.plain_text import print_message
from ..core.verdict.finding import Finding, finding
from .findings import PROGRESS_SAMPLES

PERIOD = 5.0  # seconds between reports of progress

_requested = False


@contextmanager
def interruptible() -> Iterator[None]:
    """Raise KeyboardInterrupt on Ctrl+C within the block, also in `blender -b`, which would only note it.

    An ignored signal, as in the background of a shell, stays ignored.
    """
    global _requested
    _requested = False
    try:
        before = signal.getsignal(signal.SIGINT)
        if before != signal.SIG_IGN:
            signal.signal(signal.SIGINT, _interrupt)
    except ValueError:  # only the main thread can handle signals
        before = None
    try:
        yield
    finally:
        if before not in (None, signal.SIG_IGN):
            signal.signal(signal.SIGINT, before)


def check_interruption() -> None:
    """Raise KeyboardInterrupt if it was requested: importers in Python turn the exception into their own error."""
    if _requested:
        raise KeyboardInterrupt


@contextmanager
def stopped_by_signals() -> Iterator[None]:
    """Raise KeyboardInterrupt within the block on every signal that asks a process to end.

    Only the first signal counts: nothing disturbs the cleanup after it.
    """
    names = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    before = {}

    def stop(number: int, frame: object) -> None:
        for other in before:
            signal.signal(other, signal.SIG_IGN)
        _interrupt(number, frame)

    with suppress(ValueError):  # only the main thread can handle signals
        for number in numbers:
            if signal.getsignal(number) != signal.SIG_IGN:
                before[number] = signal.signal(number, stop)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _interrupt(_number: int, _frame: object) -> None:
    global _requested
    _requested = True
    raise KeyboardInterrupt


class Progress:
    """A counter of samples or faces read from a file.

    It reports their number every `PERIOD` seconds by the message of the given code.
    """

    def __init__(self, file: str, code: str = PROGRESS_SAMPLES) -> None:
        self._file, self._code, self._count, self._due = file, code, 0, time.monotonic() + PERIOD

    def __call__(self, count: int) -> None:
        self._count += count
        if time.monotonic() >= self._due:
            self._due = time.monotonic() + PERIOD
            self.report(finding(self._code, count=self._count))

    def report(self, note: Finding) -> None:
        """Report how much has been read."""
        print_message(self._file, note)
