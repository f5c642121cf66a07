# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of a run over many files, on the standard error: a line every few seconds."""

from __future__ import annotations

import time
from collections import Counter
from datetime import timedelta

from ...core.measurement.plain_text import counted, print_message

PERIOD = 5.0  # seconds between lines


class Progress:
    """The counts of a run. total: count of its files. done: count of the files that an earlier run has recorded."""

    def __init__(self, total: int, done: int = 0) -> None:
        self.counts: Counter[str] = Counter()
        self._total, self._before = total, done
        self._began = time.monotonic()
        self._due = self._began + PERIOD

    def count_file(self, status: str) -> None:
        """Count one finished file."""
        self.counts[status] += 1

    def show(self) -> None:
        """Print the progress, if due."""
        now = time.monotonic()
        if now < self._due or self._total < 2:
            return
        self._due = now + PERIOD
        measured = self.counts.total()
        done = self._before + measured
        text = "{} of {} files".format(done, self._total)
        if measured:
            seconds = now - self._began
            left = timedelta(seconds=round((self._total - done) * seconds / measured))
            failed = measured - self.counts["ok"]
            text += ", {:.3g} per second, {} left, {} not ok".format(measured / seconds, left, failed)
        print_message(text)

    def finish(self) -> None:
        """Print the totals of the run."""
        if self._total > 1:
            counts = ", ".join("{} {}".format(number, status) for status, number in self.counts.most_common())
            seconds = time.monotonic() - self._began
            files = counted(self.counts.total(), "file")
            print_message("{} in {:.1f} s: {}".format(files, seconds, counts or "-"))
