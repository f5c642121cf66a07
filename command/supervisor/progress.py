# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of a run over many files, on the standard error: a line every few seconds."""

import time
from collections import Counter
from collections.abc import Sequence
from datetime import timedelta

from ...core.measurement import counted, print_message

PERIOD = 5.0  # seconds between lines


class Progress:
    """The counts of a run. total: count of its files. recorded_statuses: those of
    files that an earlier run has recorded.
    """

    def __init__(self, total: int, recorded_statuses: Sequence[str] = ()) -> None:
        self.counts: Counter[str] = Counter()
        self._total = total
        self._known = Counter(recorded_statuses)
        self._began = time.monotonic()
        self._due = self._began + PERIOD

    def count_file(self, status: str) -> None:
        self.counts[status] += 1

    def show(self) -> None:
        """Print the progress, if due."""
        now = time.monotonic()
        if now < self._due or self._total < 2:
            return
        self._due = now + PERIOD
        measured = self.counts.total()
        finished = self._known.total() + measured
        text = "{} of {} files".format(finished, self._total)
        if measured:
            seconds = now - self._began
            left = timedelta(seconds=round((self._total - finished) * seconds / measured))
            failed = measured - self.counts["ok"]
            text += ", {:.3g} per second, {} left, {} not ok".format(
                measured / seconds, left, failed
            )
        print_message(text)

    def finish(self) -> None:
        if self._total > 1:
            everything = (self._known + self.counts).most_common()
            counts = ", ".join("{} {}".format(number, status) for status, number in everything)
            files = "{} in {:.1f} s".format(
                counted(self.counts.total(), "file"), time.monotonic() - self._began
            )
            if self._known:
                files = "{}, of which {}".format(counted(self._total, "file"), files)
            print_message("{}: {}".format(files, counts or "-"))
