# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A whole run over files in a process of its own, started by a window that stays usable meanwhile."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from . import processes
from .lifeline import WINDOW

_STOP = 5.0  # seconds that a run may take to stop


class WholeRun:
    """A running `measure` with the given words.

    output: its result. blender: the Blender to start; None for this Python, if it has the bpy module. Raises OSError.
    """

    def __init__(self, words: Sequence[str], output: Path, blender: str | None) -> None:
        command = processes.run_command(blender, ["measure", *words, "--output", str(output)])
        self._journal = output.with_name(output.name + ".journal")
        self._place, self._lines = 0, 0
        nowhere = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        flags = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)  # on Windows it can be asked to end then
        environment = {**os.environ, WINDOW: "1"}
        self._process = subprocess.Popen(command, env=environment, creationflags=flags, **nowhere)

    @property
    def exit_code(self) -> int | None:
        """The exit code of the run, None while it is under way."""
        return self._process.poll()

    def done(self) -> int:
        """Return the count of files that the journal records so far."""
        try:
            with open(self._journal, "rb") as file:
                file.seek(self._place)
                data = file.read()
        except OSError:
            return self._lines
        self._place += len(data)
        self._lines += data.count(b"\n")
        return self._lines

    def stop(self) -> None:
        """End the run and its children. Measured files stay in its journal."""
        if self._process.poll() is None:
            with suppress(OSError):
                self._process.send_signal(getattr(signal, "CTRL_BREAK_EVENT", signal.SIGTERM))
            try:
                self._process.wait(_STOP)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
