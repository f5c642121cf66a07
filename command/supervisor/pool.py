# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Children that measure one file each at a time, so that a crash, a hang or too much memory blames
only that file.
"""

from __future__ import annotations

import json
import os
import queue
import shutil
import subprocess
import sys
import time
from collections import deque
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from . import lifeline, processes

ATTEMPTS = 2  # for a file that ends its child; the second in a fresh child
START_LIMIT = 300.0  # seconds in which a child must be ready
MAX_FAILED_STARTS = 5  # in a row
# seconds between looks at the memory of children
_WATCH = 0.05 if sys.platform.startswith("linux") else 1.0
_STEP = 0.2  # Longest wait for an answer of a child, in seconds.
_LOG_TAIL = 1 << 16  # Bytes of a child's output that are kept.


class ChildError(Exception):
    """The error that no child can be started, with the output or end of the last one."""


class SetupError(Exception):
    """The error that children refuse the options, with their complete message."""


@dataclass(frozen=True)
class Limits:
    """Limits of one file. seconds: its time. memory: its bytes, None for any."""

    seconds: float
    memory: int | None = None


@dataclass
class TaskOutcome:
    """Outcome of a task.

    status: "answered", "crashed", "timeout" or "memory". head, data: the answer. how: the signal or
    exit code of a crash. attempts: their count. seconds: their total time. said: the child's output
    on its standard error.
    """

    task: str
    status: str
    attempts: int
    seconds: float
    head: dict[str, Any] = field(default_factory=dict)
    data: bytes = b""
    how: str = ""
    said: str = ""


@dataclass(eq=False)
class _Child:
    """A child process.

    requests, answers: the streams to and from it. started: time of its start, or of its task's.
    deadline: time by which it must be ready, or its task done. task: its current file. is_fresh:
    True before its first file. doomed: the reason if we ended it.
    """

    process: subprocess.Popen[bytes]
    requests: IO[bytes]
    answers: IO[bytes]
    folder: Path
    log: Path
    started: float
    deadline: float
    ready: bool = False
    task: str | None = None
    is_fresh: bool = True
    doomed: str = ""


class Pool:
    """A pool of child processes that work on tasks, which are names of files.

    command: starts a child. count: their largest number. setup: the first message to each. work: a
    folder for all their files, which must not exist, and is removed in the end. Use it as a context
    manager; its end kills the children.
    """

    def __init__(
        self, command: Sequence[str], count: int, setup: dict[str, Any], limits: Limits, work: Path
    ) -> None:
        self._command = command
        self._count = count
        self._setup = setup
        self._limits = limits
        self._work = work
        self._tasks: deque[str] = deque()
        self._again: deque[str] = deque()  # tasks that ended their child, for a fresh one
        self._attempts: dict[str, tuple[int, float]] = {}
        self._children: list[_Child] = []
        self._events: queue.SimpleQueue[tuple[_Child, dict[str, Any] | None, bytes]] = (
            queue.SimpleQueue()
        )
        # Chosen: readers of children that have ended may still wait for the end of a pipe.
        self._readers = ThreadPoolExecutor(max_workers=4 * count + 8)
        self._early: list[TaskOutcome] = []  # outcomes before the first step
        self._started = self._failed_starts = 0
        self._watched = 0.0
        self.about: dict[str, Any] = {}  # report of the children when they are ready
        # Files and sentences that children send while they work.
        self.notes: list[tuple[str, str]] = []

    def __enter__(self) -> Pool:
        self._work.mkdir(parents=True)
        return self

    def __exit__(self, *_: object) -> None:
        processes.kill([child.process for child in self._children], gently=True)
        for child in self._children:
            self._close(child)
        self._readers.shutdown()
        shutil.rmtree(self._work, ignore_errors=True)

    def add(self, tasks: Iterable[str]) -> None:
        self._tasks.extend(tasks)

    @property
    def is_done(self) -> bool:
        """True if no work is left."""
        waiting = self._tasks or self._again or self._early
        return not waiting and all(child.task is None for child in self._children)

    def wait_until_ready(self) -> None:
        """Start the children and wait for the first. Raises ChildError and SetupError."""
        while not self.about:
            self._early = self.step()

    def step(self) -> list[TaskOutcome]:
        """Give tasks to idle children, and return the outcomes, waiting a moment for them.

        Raises ChildError and SetupError.
        """
        self._refill()
        outcomes = self._early
        self._early = []
        with suppress(queue.Empty):
            event = self._events.get(timeout=self._pause())
            while True:
                outcomes += self._receive(*event)
                event = self._events.get_nowait()
        self._watch()
        return outcomes

    def _pause(self) -> float:
        """Return the seconds to wait for an event: to the next deadline or look at the memory."""
        now = time.monotonic()
        deadlines = [child.deadline - now for child in self._children]
        is_watched = self._limits.memory and any(child.task for child in self._children)
        return max(0.001, min([_STEP, *deadlines, *[_WATCH] * bool(is_watched)]))

    def _refill(self) -> None:
        """Start the children that are missing, and give tasks to idle ones.

        There are enough if each task has an idle child, and each second attempt a fresh one. One is
        started even without tasks, to learn about Blender.
        """
        idle = [child for child in self._children if child.task is None]
        fresh = sum(child.is_fresh for child in idle)
        missing = max(len(self._tasks) + len(self._again) - len(idle), len(self._again) - fresh)
        if not self.about:
            missing = max(missing, 1 - len(self._children))
        for _ in range(min(missing, self._count - len(self._children))):
            self._start()
        for child in idle:
            if child.ready:
                self._give(child)

    def _start(self) -> None:
        """Start a child, and send it the setup. Raises ChildError."""
        folder = self._work / str(self._started)
        self._started += 1
        log = folder.with_suffix(".log")
        try:
            process = processes.start(self._command, folder, log)
        except OSError as error:
            raise ChildError("{}: {}".format(self._command[0], error.strerror)) from error
        assert process.stdin is not None and process.stdout is not None
        now = time.monotonic()
        child = _Child(process, process.stdin, process.stdout, folder, log, now, now + START_LIMIT)
        self._children.append(child)
        self._readers.submit(self._read, child)
        self._send(child, self._setup)

    def _send(self, child: _Child, message: dict[str, Any]) -> None:
        with suppress(OSError):  # The child has ended; its reader reports that.
            child.requests.write(json.dumps(message).encode() + b"\n")
            child.requests.flush()

    def _read(self, child: _Child) -> None:
        """Queue a child's answers as events, and finally its end; runs in a thread."""
        stream = child.answers
        # a child that answers nonsense counts as dead
        with suppress(ValueError, TypeError, AttributeError, OSError):
            while line := stream.readline():
                if line.startswith(lifeline.MARK):
                    head = json.loads(line[len(lifeline.MARK) :])
                    size = head.get("bytes", 0)
                    data = stream.read(size)
                    if len(data) == size:
                        self._events.put((child, head, data))
        self._events.put((child, None, b""))

    def _receive(
        self, child: _Child, head: dict[str, Any] | None, data: bytes
    ) -> list[TaskOutcome]:
        """Take an event of a child: an answer, or its end if `head` is None. Return the outcome of
        its task, if this is known now. Raises ChildError and SetupError.
        """
        if child not in self._children:
            return []
        if head is None:
            return self._ended(child)
        if child.doomed:  # The answer came too late.
            return []
        if "usage" in head:
            raise SetupError(head["usage"])
        task = child.task
        if "ready" in head:
            self.about = head["ready"]
            child.ready, self._failed_starts = True, 0
            self._give(child)
        elif "note" in head and task is not None:
            self.notes.append((task, head["note"]))
        elif task is not None:
            outcome = self._outcome(child, "answered", head=head, data=data)
            child.task = None
            self._give(child)
            return [outcome]
        return []

    def _outcome(self, child: _Child, status: str, **more: Any) -> TaskOutcome:
        """Return the outcome of a child's task, which has one attempt more now."""
        assert child.task is not None
        attempts, seconds = self._attempts.pop(child.task, (0, 0.0))
        seconds += time.monotonic() - child.started
        stderr_tail = self._stderr_tail(child)
        return TaskOutcome(child.task, status, attempts + 1, seconds, said=stderr_tail, **more)

    def _give(self, child: _Child) -> None:
        """Give a ready child a task, if one waits; second attempts go to fresh children only."""
        child.deadline = float("inf")
        tasks = self._again if self._again and child.is_fresh else self._tasks
        if tasks:
            child.task = tasks.popleft()
            child.is_fresh = False
            child.started = time.monotonic()
            child.deadline = child.started + self._limits.seconds
            self._send(child, {"measure": child.task})

    def _ended(self, child: _Child) -> list[TaskOutcome]:
        """Remove a child that has ended, and return the outcome of its task after the last attempt;
        before, the task waits for a fresh child. Raises ChildError.
        """
        processes.kill([child.process])  # This ends its descendants, too.
        self._children.remove(child)
        how = processes.how_it_ended(child.process.returncode)
        stderr_tail = self._stderr_tail(child)
        task = child.task
        outcome = self._outcome(child, child.doomed or "crashed", how=how) if task else None
        self._close(child)
        if not child.ready:
            self._failed_starts += 1
            if self._failed_starts >= MAX_FAILED_STARTS:
                raise ChildError(" ".join(stderr_tail.split()) or how)
        if task is None or outcome is None:
            return []
        if outcome.attempts < ATTEMPTS:
            self._attempts[task] = outcome.attempts, outcome.seconds
            self._again.append(task)
            return []
        return [outcome]

    def _watch(self) -> None:
        """End children that have passed their deadline or use too much memory."""
        now = time.monotonic()
        for child in self._children:
            if now >= child.deadline:
                self._doom(child, "timeout", gently=True)
        if self._limits.memory and now >= self._watched + _WATCH:
            self._watched = now
            for child in self._children:
                if (
                    child.task is not None
                    and (processes.memory_of(child.process.pid) or 0) > self._limits.memory
                ):
                    self._doom(child, "memory")

    def _doom(self, child: _Child, why: str, *, gently: bool = False) -> None:
        """End a child. why: the status of its task, "timeout" or "memory"."""
        child.doomed = why
        child.deadline = float("inf")
        processes.kill([child.process], gently=gently)

    def _stderr_tail(self, child: _Child) -> str:
        """Return the end of a child's standard error about its current file. The child empties it
        before each file.
        """
        try:
            with open(child.log, "rb") as file:
                file.seek(max(0, os.fstat(file.fileno()).st_size - _LOG_TAIL))
                return file.read().decode("utf-8", "replace")
        except OSError:
            return ""

    def _close(self, child: _Child) -> None:
        for stream in (child.requests, child.answers):
            with suppress(OSError):
                stream.close()
        with suppress(OSError):
            child.log.unlink()
        shutil.rmtree(child.folder, ignore_errors=True)
