# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A child of the supervisor: it measures the files that it is sent, one at a time, and answers with
documents.
"""

import io
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import redirect_stderr, suppress
from functools import partial
from pathlib import Path
from typing import Any

from ...core import files, scans, verdict
from ..interruption import Progress
from ..options import arguments, checks
from ..supervisor.journal import state
from ..supervisor.lifeline import Lifeline
from .run import Run, blender_version

# Errors about a file with an impossible name, unreadable or damaged, which counts as without
# references.
_UNREADABLE = (OSError, RuntimeError, verdict.MeasureError, *files.MALFORMED)
_ASSET = re.compile(rb"@@@(.+?)@@@|@([^@\n]+)@")


def serve(line: Lifeline) -> None:
    """Measure files on request, until the supervisor closes the pipe, which ends the process."""
    messages = line.messages()
    setup = next(messages)
    options = arguments.parse(setup["words"])
    stderr_text = io.StringIO()
    try:
        with redirect_stderr(stderr_text):
            checks.prepare(options)
    except SystemExit:
        line.answer({"usage": stderr_text.getvalue()})
        return

    def report(_file: str, text: str) -> None:
        line.answer({"note": text})

    run = Run(options, setup["threads"], setup["memory"], partial(Progress, report=report))
    line.answer({"ready": {"blender": blender_version()}})
    for message in messages:
        with suppress(OSError):
            os.ftruncate(2, 0)  # Remove output about the previous file.
            os.lseek(2, 0, os.SEEK_SET)  # needed if it is not opened for appending, as on Windows
        _measure(run, message["measure"], line)


def _measure(run: Run, path: str, line: Lifeline) -> None:
    """Measure a file, and answer with its document; with the count of internal errors, the state of
    the file that the document is about, and the states of the files that it refers to.
    """
    faults_before = run.internal_errors
    state_before = state(path)
    document = run.document(path)
    head: dict[str, Any] = {
        "faults": run.internal_errors - faults_before,
        "state": state(path) if run.has_saved else state_before,
    }
    names = sorted(map(os.fspath, references(path, run.opened)))
    head["reads"] = {name: state(name) for name in names}
    line.answer(head, json.dumps(document, allow_nan=False).encode() + b"\n")


def references(path: str, opened: Iterable[str] = ()) -> set[Path]:
    """Return the files, existing or not, that a file refers to directly or indirectly.

    opened: the files that Blender has read with it. Layers in binary USD layers are not found, nor
    are missing tiles.
    """
    waiting = [Path(path), *map(Path, opened)]
    visited = set()
    while waiting:
        file = waiting.pop()
        with suppress(*_UNREADABLE):
            file = Path(os.path.realpath(file))
            if file not in visited:
                visited.add(file)
                names = _NAMES.get(file.suffix.lower())
                waiting += [file.parent / name for name in names(file)] if names else []
    return visited - {Path(os.path.realpath(path))}


def _of_nrrd(path: Path) -> Iterator[str]:
    fields, _ = scans.read_header(path, files.file_limits())
    yield fields.get("data file") or path.name


def _of_gltf(path: Path) -> Iterator[str]:
    yield from files.GltfFile(files.map_file(path), str(path)).references()


def _of_usd(path: Path) -> Iterator[str]:
    for long, short in _ASSET.findall(path.read_bytes()):
        yield (long or short).decode("utf-8", "surrogateescape")


_NAMES: dict[str, Callable[[Path], Iterator[str]]] = {
    ".nrrd": _of_nrrd,
    ".nhdr": _of_nrrd,
    ".gltf": _of_gltf,
    ".glb": _of_gltf,
    ".usd": _of_usd,
    ".usda": _of_usd,
}
