# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure a folder or an asset library while the window goes on living: other processes open its
files.
"""

from __future__ import annotations

import os
import time
from collections.abc import Generator
from pathlib import Path

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy.types import Context, Event, Operator

from ... import command, core
from ...blender.write import reports
from .. import batch, selection
from ..modal import ModalSteps

RESULT, REPORT = "body_moments.jsonl", "body_moments.html"
JOURNAL = RESULT + ".journal"
FOLDER = "FOLDER"
_PAUSE = 0.05  # seconds between looks at the run; chosen: short beside the time of a file


def _sources(_operator: Operator | None, context: Context | None) -> list[tuple[str, str, str]]:
    """Return the menu's items: the folder in the file browser, and the asset libraries of the
    preferences.
    """
    libraries = context.preferences.filepaths.asset_libraries if context else ()
    items = [(FOLDER, "Folder", "The folder that is open in the file browser")]
    items += [
        ("LIBRARY_{:d}".format(number), library.name, library.path)
        for number, library in enumerate(libraries)
    ]
    _menu_items[:] = items
    return items


# the last items of the menu: Blender keeps no reference to their texts
_menu_items: list[tuple[str, str, str]] = []


class OBJECT_OT_body_moments_measure_library(ModalSteps, Operator):
    """Measure all files of a folder or an asset library, and write results and a report there"""

    bl_label = "Measure Library"
    bl_options = {"REGISTER"}
    PROGRESS = "Measuring the library: {share:.0%}. Esc to stop"
    CANCELED = "Stopped. The files measured so far stand in the journal"

    directory: StringProperty(
        name="Folder", description="Folder with the files to measure", subtype="DIR_PATH"
    )
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    source: EnumProperty(
        name="Measure", description="Folder or asset library to measure", items=_sources
    )
    asset_metadata: BoolProperty(
        name="Write Asset Metadata",
        description="Write mass, volume and center into the metadata of the objects and "
        "collections that are assets",
    )
    overwrite: BoolProperty(
        name="Overwrite Files",
        description="Save the metadata in the asset files themselves instead of in copies beside "
        "them",
    )
    thumbnails: BoolProperty(
        name="Pictures", description="Draw a picture of each body in the report", default=True
    )

    def draw(self, _context: Context) -> None:
        selection.draw_properties(self, "source", "thumbnails", "asset_metadata")
        selection.draw_properties(self, "overwrite").enabled = self.asset_metadata

    def invoke(self, context: Context, _event: Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        in_window = context.window is not None and not bpy.app.background
        try:
            return selection.reporting(self, self._run, context, in_window)
        except OSError as error:
            return selection.refuse(
                self, "No process can be started: {error}.", error=core.verdict.system_reason(error)
            )

    def modal(self, context: Context, event: Event) -> set[str]:
        # All events but the timer's and Esc are left to the window.
        outcome = ModalSteps.modal(self, context, event)
        return (
            {"PASS_THROUGH"} if outcome == {"RUNNING_MODAL"} and event.type != "TIMER" else outcome
        )

    def _begin(self, context: Context) -> int:
        """Start the run; return the number of its files. Raises MeasureError and OSError."""
        folder = self.directory
        if self.source != FOLDER:
            library = context.preferences.filepaths.asset_libraries[
                int(self.source.removeprefix("LIBRARY_"))
            ]
            folder = library.path
        folder = os.path.abspath(bpy.path.abspath(folder))
        count = sum(1 for _ in command.supervisor.expand([folder]))
        self._folder = Path(folder)
        words = [folder, "--format", "jsonl", *(["--thumbnails"] if self.thumbnails else [])]
        # An earlier run that was stopped has left a journal without a result.
        was_stopped = (self._folder / JOURNAL).exists() and not (self._folder / RESULT).exists()
        words += ["--resume"] if was_stopped else []
        if self.asset_metadata:
            words += ["--asset-metadata", "file" if self.overwrite else "copy"]
        blender = None if bpy.app.module else bpy.app.binary_path
        self._steps = self._watch(
            command.supervisor.WholeRun(words, self._folder / RESULT, blender)
        )
        return count

    def _watch(self, run: command.supervisor.WholeRun) -> Generator[float, None, None]:
        # yields the number of completed files; a canceled work closes this generator
        try:
            while run.exit_code is None:
                time.sleep(_PAUSE)
                yield run.done()
            self._exit_code = run.exit_code
        finally:
            run.stop()

    def _finish(self, context: Context) -> set[str]:
        result = self._folder / RESULT
        codes = (batch.ALL_MEASURED, batch.SOME_FAILED, batch.INTERNAL_ERROR)  # with a result
        if self._exit_code not in codes or not result.exists():
            return selection.refuse(
                self,
                "Measuring the library failed with exit code {code}. Use the command line to see "
                "why.",
                code=self._exit_code,
            )
        with command.supervisor.Journal(result.with_name(JOURNAL)) as journal:
            paths = list(journal.entries)
            failed = sum(entry.status != "ok" for entry in journal.entries.values())
            pages = core.measurement.to_html(_Documents(journal, paths))
            selection.write_file(
                self._folder / REPORT, (page.encode("utf-8", "backslashreplace") for page in pages)
            )
        counts = {"count": len(paths), "failed": failed, "file": str(self._folder / REPORT)}
        if failed:
            reports.report(
                self,
                reports.phrase(
                    "Files measured: {count}, not or not fully: {failed}; report: {file}", **counts
                ),
                level=core.verdict.Severity.WARNING,
            )
        else:
            reports.report(
                self,
                reports.phrase(
                    "{count} file measured; report: {file}",
                    "{count} files measured; report: {file}",
                    **counts,
                ),
            )
        return {"FINISHED"}


class _Documents:
    """The documents of a journal, read again at each iteration."""

    def __init__(self, journal: command.supervisor.Journal, paths: list[str]) -> None:
        self._journal, self._paths = journal, paths

    def __iter__(self) -> Generator[dict, None, None]:
        yield from map(self._journal.document, self._paths)
