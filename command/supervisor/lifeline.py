# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A child's end of the pipes to its supervisor.

The child ends when the supervisor ends for any reason. On Linux the system itself kills it, even if
Blender hangs on a file. Elsewhere a thread waits for the end of the pipe.
"""

import ctypes
import json
import os
import queue
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

MARK = b"\x1e"  # Begins an answer; other lines are output of Blender.
WINDOW = "BODY_MOMENTS_WINDOW"  # Environment variable of a run that ends with its parent.
_PR_SET_PDEATHSIG = 1  # Linux: sets the signal that a process gets when its parent ends.


def end_with_parent(number: int) -> None:
    """Request a signal to this process for the end of its parent; without effect on other systems
    than Linux.
    """
    if sys.platform.startswith("linux"):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, number)


def end_with_window() -> None:
    """Make this process end with the window that started it for a run over files, if one did."""
    if os.environ.pop(WINDOW, ""):
        end_with_parent(signal.SIGTERM)


class Lifeline:
    """Messages from the supervisor, and answers to it. channel: the descriptor for the answers."""

    def __init__(self, channel: int) -> None:
        self._channel = channel
        self._waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        with suppress(OSError):  # if memory runs out, this process goes first, not its supervisor
            Path("/proc/self/oom_score_adj").write_text("500")
        if hasattr(signal, "SIGKILL"):
            end_with_parent(signal.SIGKILL)
        ThreadPoolExecutor().submit(self._listen)

    def messages(self) -> Iterator[dict[str, Any]]:
        while True:
            yield json.loads(self._waiting.get())

    def _listen(self) -> None:
        for line in iter(sys.stdin.buffer.readline, b""):
            self._waiting.put(line)
        os._exit(0)

    def answer(self, head: dict[str, Any], data: bytes = b"") -> None:
        """Send a line of JSON. If there are data, the line states their length as "bytes", and they
        follow it.
        """
        head = (head | {"bytes": len(data)}) if data else head
        view = memoryview(MARK + json.dumps(head).encode() + b"\n" + data)
        while view:
            view = view[os.write(self._channel, view) :]
