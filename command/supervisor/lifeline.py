# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A child's end of the pipes to its supervisor.

The child ends when the supervisor does, however that ended, also within a file that Blender never comes back from.

On Linux the system itself sends a signal when the other end of a pipe closes, which nothing needs to run for. Elsewhere
a thread waits for that. Either way, a file that takes longer than it may ends the process.
"""

from __future__ import annotations

import faulthandler
import json
import os
import queue
import select
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from typing import Any

MARK = b"\x1e"  # begins an answer; what Blender prints before it comes to us does not
WINDOW = "BODY_MOMENTS_WATCHED"  # a variable of the environment: the descriptor that such a run watches
_LATE = 5.0  # seconds after which a child ends itself whose supervisor should have ended it

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None
BY_SIGNAL = sys.platform.startswith("linux")  # elsewhere that signal is ignored, or there is none


def end_with(watched: int) -> None:
    """From now on this process ends when the other end of a pipe closes, on which nothing ever comes. Linux alone."""
    if fcntl is None:
        return
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    fcntl.fcntl(watched, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(watched, fcntl.F_SETFL, fcntl.fcntl(watched, fcntl.F_GETFL) | os.O_ASYNC)
    ready = select.poll()
    ready.register(watched, select.POLLHUP)  # the other end is closed already
    if ready.poll(0):
        os._exit(0)


def end_with_window() -> None:
    """End with the window that started this process for a run over files, if any."""
    watched = os.environ.pop(WINDOW, "")
    if BY_SIGNAL and watched:
        end_with(int(watched))


class Lifeline:
    """Messages from the supervisor, and answers to it.

    channel: the descriptor for the answers. watched: the descriptor of a pipe that never carries data, or None.
    """

    def __init__(self, channel: int, watched: int | None) -> None:
        self._channel = channel
        self._waiting: queue.SimpleQueue[bytes] | None = None
        with suppress(OSError), open("/proc/self/oom_score_adj", "w") as file:
            file.write("500")  # if memory runs out, this process goes first, not its supervisor
        if BY_SIGNAL and watched is not None:
            end_with(watched)
        else:
            self._waiting = queue.SimpleQueue()
            ThreadPoolExecutor().submit(self._listen, self._waiting)

    def messages(self) -> Iterator[dict[str, Any]]:
        """Yield the supervisor's messages, until it closes the pipe."""
        lines = iter(self._waiting.get, b"") if self._waiting else iter(sys.stdin.buffer.readline, b"")
        for line in lines:
            yield json.loads(line)

    def _listen(self, waiting: queue.SimpleQueue[bytes]) -> None:
        for line in iter(sys.stdin.buffer.readline, b""):
            waiting.put(line)
        os._exit(0)

    def answer(self, head: dict[str, Any], data: bytes = b"") -> None:
        """Send a line, followed by `bytes` of data, if any."""
        head = {**head, "bytes": len(data)} if data else head
        view = memoryview(MARK + json.dumps(head).encode() + b"\n" + data)
        while view:
            view = view[os.write(self._channel, view) :]

    @contextmanager
    def limited(self, seconds: float) -> Iterator[None]:
        """Within the block the process ends when that time is over."""
        faulthandler.dump_traceback_later(seconds + _LATE, exit=True, file=2)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()
