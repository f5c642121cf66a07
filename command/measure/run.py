# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Production of a file's document, by Blender or without it.

Every failure is an entry in `errors` and stops nothing else; an unexpected one prints its
traceback, too.
"""

import os
import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from ...core import bodies, files
from ...core.measurement import document, print_message, record
from ...core.verdict import MeasureError, internal_error
from .. import findings, interruption, measure
from ..options.arguments import run_of
from . import bare, entries

THREADS = os.cpu_count() or 1  # for long measurements
_STATUSES: dict[str, str] = {
    files.FILE_MISSING: "missing",
    findings.FILE_VERSION_UNSUPPORTED: "unsupported_version",
}


def blender_version() -> str | None:
    """Return the version of the Blender in this process, or None."""
    bpy = sys.modules.get("bpy")
    return ".".join(map(str, bpy.app.version)) if bpy else None


@dataclass
class Run:
    """The execution of a command line in this process.

    threads: count for a measurement. memory: bytes that one file may take, None for any. progress:
    returns a counter of the samples or faces read from a file. documents: one for each file, in
    order. internal_errors: count of the errors that are faults of the program. has_saved: whether
    the last file was saved in place. opened: the files that Blender has read with it.
    """

    options: Namespace
    threads: int = THREADS
    memory: int | None = None
    progress: Callable[[str, str], Callable[[int], None]] = interruption.Progress
    documents: list[dict[str, Any]] = field(default_factory=list)
    internal_errors: int = 0
    has_saved: bool = field(init=False)
    opened: Sequence[str] = field(init=False)

    def measure(self) -> None:
        """Measure every named file, or else the open file, and add their documents."""
        options = self.options
        is_open_file_meant = (
            not options.files and options.manifest is None and options.range is None
        )
        for path in [None] if is_open_file_meant else options.files:
            self.documents.append(self.document(path))

    @property
    def errors(self) -> int:
        """The number of entries under `errors` in all documents."""
        return sum(len(document["errors"]) for document in self.documents)

    def document(self, path: str | None) -> dict[str, Any]:
        """Measure one file, or the open scene, and return its document."""
        options = self.options
        contents = entries.Contents(self.internal_error)
        status = None
        if path is not None and bare.is_bare(path, options, self.memory):
            source = bare.BareFile(path, options, self.threads, self.memory, self.progress)
        else:
            source = measure.scene.Scene(path, options, self.threads)
        file = path or measure.scene.open_name()
        try:
            source.measure(contents)
            contents.caveats += entries.said_once(contents.objects, bodies.DENSITY_DEFAULTED)
            source.store(contents)
        except MeasureError as refusal:
            contents.errors.append(entries.failure(None, refusal.finding))
            status = _STATUSES.get(refusal.finding.code)
        except Exception as error:
            contents.errors.append(self.internal_error(None, error))
        self.has_saved = source.has_saved
        self.opened = source.opened
        for entry in contents.errors:
            where = [text for text in (file, entry["name"]) if text]
            print_message(*where, entry["reason"])
        finished_document = document(
            contents.objects,
            record.total(
                [measurement for _, _, measurement in contents.measured], contents.caveats
            ),
            contents.errors,
            contents.left_out,
            file=file,
            blender=blender_version(),
            frame=options.frame,
            status=status,
            run=run_of(options),
        )
        finished_document = source.complete(finished_document, contents)
        interruption.check_interruption()
        return finished_document

    def internal_error(self, name: str | None, error: Exception) -> dict[str, Any]:
        """Count an unexpected error if it is the program's fault, and return the entry about it."""
        reason = internal_error.finding_of(error)
        self.internal_errors += reason.code == internal_error.CODE
        return entries.failure(name, reason)
