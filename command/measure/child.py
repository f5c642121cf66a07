# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A child of the supervisor: it measures the files that it is sent, one at a time, and answers with documents."""

from __future__ import annotations

import io
import json
import os
from contextlib import redirect_stderr, suppress
from typing import Any

from ..files.inputs import references
from ..interruption import Progress
from ..options.arguments import parse
from ..options.checks import prepare
from ..supervisor.journal import state
from ..supervisor.lifeline import Lifeline
from .run import Run, blender_version


def serve(line: Lifeline) -> None:
    """Measure files on request, until the supervisor closes the pipe, which ends the process."""
    messages = line.messages()
    setup = next(messages)
    options = parse(setup["words"])
    said = io.StringIO()
    try:
        with redirect_stderr(said):
            prepare(options)
    except SystemExit:
        line.answer({"usage": said.getvalue()})
        return
    run = Run(options, setup["threads"], setup["memory"], lambda file, what: _Told(file, what, line))
    line.answer({"ready": {"blender": blender_version()}})
    for message in messages:
        with suppress(OSError):
            os.ftruncate(2, 0)  # Remove output about the previous file.
            os.lseek(2, 0, os.SEEK_SET)  # needed if it is not opened for appending, as on Windows
        _measure(run, message["measure"], line)


def _measure(run: Run, path: str, line: Lifeline) -> None:
    faults, before = run.internal_errors, state(path)
    document = run.document(path)
    head: dict[str, Any] = {"faults": run.internal_errors - faults, "state": state(path) if run.has_saved else before}
    names = sorted(map(os.fspath, references(path, run.opened)))
    head["reads"] = {name: state(name) for name in names}
    line.answer(head, json.dumps(document, allow_nan=False).encode() + b"\n")


class _Told(Progress):
    """A counter whose reports are sent to the supervisor."""

    def __init__(self, file: str, what: str, line: Lifeline) -> None:
        super().__init__(file, what)
        self._line = line

    def report(self, text: str) -> None:
        self._line.answer({"note": text})
