# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of a run over many files: a bar on a terminal, else a line every few seconds."""

from __future__ import annotations

import shutil
import sys
import time
from collections import Counter

from ...core.measurement.plain_text import print_message, visible
from ...core.verdict.finding import finding
from ..findings import PROGRESS_DONE, PROGRESS_FILES, PROGRESS_STARTED

PERIOD = 5.0  # seconds between lines
_REDRAW = 0.1  # and between bars
_CELLS = 24


class Progress:
    """total: how many files there are; done: how many of them were recorded by an earlier run."""

    def __init__(self, total: int, done: int = 0) -> None:
        self.counts: Counter[str] = Counter()
        self._total, self._before, self._done = total, done, done
        self._began = time.monotonic()
        self._is_terminal = sys.stderr.isatty()
        self._due = self._began + (0.0 if self._is_terminal else PERIOD)
        self._drawn = False

    def add(self, status: str) -> None:
        """One more file has ended."""
        self._done += 1
        self.counts[status] += 1

    def show(self) -> None:
        """Show the progress, if due."""
        now = time.monotonic()
        if now < self._due or self._total < 2:
            return
        self._due = now + (_REDRAW if self._is_terminal else PERIOD)
        if self._is_terminal:
            self._draw()
        else:
            print_message(self._state())

    def clear(self) -> None:
        """Remove the bar, for other lines."""
        if self._drawn:
            sys.stderr.write("\r\x1b[K")
            self._drawn = False

    def finish(self) -> None:
        """Print the totals of the run."""
        self.clear()
        if self._total > 1:
            counts = ", ".join("{} {}".format(number, status) for status, number in self.counts.most_common())
            seconds = time.monotonic() - self._began
            print_message(
                finding(PROGRESS_DONE, count=self._done - self._before, seconds=seconds, counts=counts or "-")
            )

    def _state(self) -> object:
        seconds = max(time.monotonic() - self._began, 1e-3)
        rate = (self._done - self._before) / seconds
        values = {"done": self._done, "total": self._total, "rate": rate, "failed": self._failed()}
        if not rate:
            return finding(PROGRESS_STARTED, **values)
        return finding(PROGRESS_FILES, left=_duration((self._total - self._done) / rate), **values)

    def _failed(self) -> int:
        return sum(number for status, number in self.counts.items() if status != "ok")

    def _draw(self) -> None:
        filled = _CELLS * self._done // self._total
        line = "[{}{}] {}".format("#" * filled, "." * (_CELLS - filled), self._state())
        sys.stderr.write("\r\x1b[K" + visible(line)[: shutil.get_terminal_size().columns - 1])
        sys.stderr.flush()
        self._drawn = True


def _duration(seconds: float) -> str:
    """Seconds, minutes or hours."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return "{} h {:02d} min".format(hours, minutes)
    return "{} min {:02d} s".format(minutes, rest) if minutes else "{} s".format(rest)
