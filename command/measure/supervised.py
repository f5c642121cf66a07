# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`measure` over files: children measure them; this process gathers the answers, and opens no file.

Standard library only: it runs in Blender, in a Python with the bpy module, and in any other with --blender PATH.
"""

from __future__ import annotations

import hashlib
import json
import os
import pkgutil
import shutil
import sys
import tempfile
import tomllib
from argparse import Namespace
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.files.file_lock import Busy, beside, locked
from ...core.measurement.documents import failed_document
from ...core.measurement.plain_text import PROGRAM, print_message
from ...core.robots.formats import FORMATS as ROBOT_FORMATS
from ...core.verdict.finding import Finding, MeasureError, finding, system_reason
from .. import interruption
from ..files import output, own_results
from ..findings import (
    CHILDREN_FAILED,
    FILE_CRASHED,
    FILE_TIMED_OUT,
    FILE_TOOK_MEMORY,
    INTERRUPTED,
    INTERRUPTED_RESUMABLE,
    ROBOT_ONE_FILE,
    USAGE_BUSY,
    USAGE_FOURIER_ONE_OBJECT,
    USAGE_NO_BLENDER,
    USAGE_OLD_FOREIGN,
    USAGE_PATH,
    USAGE_RESULT_NOT_WRITTEN,
)
from ..options import targets
from ..options.arguments import as_record, fail, of_numbers
from ..options.formats import FORMATS
from ..options.measure_parser import DEFAULT_TIMEOUT
from ..supervisor import listing, processes
from ..supervisor.journal import Journal, is_journal, state
from ..supervisor.lifeline import end_with_window
from ..supervisor.pool import ChildError, Limits, Pool, SetupError, TaskOutcome
from ..supervisor.progress import Progress

_ROOT = __name__.removesuffix(".command.measure.supervised")
_OLD = ".old"


def measure(options: Namespace, channel: int, opened: str | None) -> int:
    """Measure the files, and return the exit code. opened: a file that this process has open, and only keeps.

    Raises SystemExit if the options are wrong, and KeyboardInterrupt.
    """
    end_with_window()
    with interruption.stopped_by_signals():
        targets.check_places(options)
        paths = files_of(options)
        command = processes.child_command(_blender(options))
        if command is None:
            fail(finding(USAGE_NO_BLENDER))
        read = [path for path in (*paths, opened, options.q, *_positions(options)) if path]
        replaced = targets.files_to_replace(options, read)
        with ExitStack() as ends:
            places = _Places(options, ends)
            run = _Supervised(options, paths, command, places)
            try:
                if replaced:
                    targets.check_dependencies(replaced, run.dependencies())
                return run.measure(channel)
            except SetupError as error:
                sys.stderr.write(str(error))
                raise SystemExit(2) from error
            except ChildError as error:
                print_message(finding(CHILDREN_FAILED, reason=str(error)))
                return 2
            except OSError as error:  # the journal cannot be written, as on a full disk
                print_message(finding(USAGE_RESULT_NOT_WRITTEN, error=system_reason(error)))
                return 1
            except KeyboardInterrupt:
                if places.journal_is_kept:
                    print_message(finding(INTERRUPTED_RESUMABLE, done=run.done, total=len(run.tasks)))
                else:
                    print_message(finding(INTERRUPTED))
                return 3


def files_of(options: Namespace) -> list[str]:
    """Return the requested files: named ones, the files of folders and of a manifest, and of these the range."""
    try:
        paths = [*listing.expand(options.files)]
        if options.manifest is not None:
            paths += listing.read(options.manifest)
    except MeasureError as error:
        fail(error)
    if options.range is not None:
        paths = paths[slice(*options.range)]
    is_open_file_meant = not options.files and options.manifest is None
    if is_open_file_meant or len(paths) == 1:
        return paths
    if options.fourier is not None:
        fail(finding(USAGE_FOURIER_ONE_OBJECT))
    if options.format in ROBOT_FORMATS:
        fail(finding(ROBOT_ONE_FILE, count=len(paths)))
    return paths


def _blender(options: Namespace) -> str | None:
    """Return the Blender to start: the named one, or that of this process."""
    bpy = sys.modules.get("bpy")
    if options.blender is not None or bpy is None or bpy.app.module:
        return options.blender
    return bpy.app.binary_path


class _Places:
    """Files of an unfinished run: beside its output, which belongs to this run alone until `ends`.

    work: a folder that does not exist yet. journal_is_kept: whether the journal stays if the run is interrupted.
    """

    def __init__(self, options: Namespace, ends: ExitStack) -> None:
        self._replaced: list[Path] = []
        target = options.output
        self.journal_is_kept = not output.is_stream(target)
        if target is None or not self.journal_is_kept:
            folder = Path(tempfile.mkdtemp(prefix="body_moments_"))
            ends.callback(shutil.rmtree, folder, ignore_errors=True)
            self.work, self.journal = folder / "work", folder / "journal"
            return
        target = target.resolve()
        self.work, self.journal = beside(target, "body_moments.work"), target.with_name(target.name + ".journal")
        try:
            ends.enter_context(locked(self.journal, 0.0))
            shutil.rmtree(self.work, ignore_errors=True)  # left behind by a run that was killed
            _check_ours(self.journal, options.force)
            if not options.resume:
                forced = [path.resolve() for path in options.forced]
                self._replaced = [path for path in (target, self.journal) if path not in forced]
                for path in self._replaced:
                    _check_ours(path.with_name(path.name + _OLD), options.force)
        except Busy:
            fail(finding(USAGE_BUSY, path=str(target)))
        except OSError as error:  # a name that is too long with what is added to it
            fail(finding(USAGE_PATH, path=str(error.filename or target), error=system_reason(error)))

    def set_aside(self) -> None:
        """Keep files of an earlier run as .old. Raises OSError."""
        for path in self._replaced:
            if path.exists() and not own_results.is_empty(path):
                os.replace(path, path.with_name(path.name + _OLD))


def _check_ours(path: Path, force: bool) -> None:
    """End with a message if a file to be replaced is no journal or result. Raises OSError."""
    try:
        os.lstat(path)
    except FileNotFoundError:
        return
    if force:
        return
    if not path.is_file() or not (is_journal(path) or own_results.replaceable(path, "output")):
        fail(finding(USAGE_OLD_FOREIGN, path=str(path)))


class _Supervised:
    """One run. tasks: the files, each once. done: how many of them are recorded."""

    def __init__(self, options: Namespace, paths: list[str], command: list[str], places: _Places) -> None:
        self._options, self._paths, self._command, self._places = options, paths, command, places
        self.tasks = [*dict.fromkeys(paths)]
        self.done = 0
        self._faults = 0
        cores = processes.cores()
        self._count = max(1, min(options.jobs or cores, len(self.tasks)))
        self._limits = Limits(options.timeout or DEFAULT_TIMEOUT, self._memory())
        threads = max(1, cores // self._count)
        self._setup = {"options": as_record(options), "threads": threads, "memory": self._limits.memory}

    def _memory(self) -> int | None:
        if self._options.memory_mb is not None:
            return int(self._options.memory_mb * 1e6)
        return processes.memory_share(self._count)

    def dependencies(self) -> Iterator[str]:
        """Yield the files that are read with the named ones, as far as children find out."""
        with self._pool("reads") as pool:
            pool.add(self.tasks)
            while not pool.is_done:
                for outcome in pool.step():
                    yield from outcome.head.get("reads", ())

    def _pool(self, verb: str = "measure") -> Pool:
        return Pool(self._command, self._count, self._setup, self._limits, self._places.work, verb)

    def measure(self, channel: int) -> int:
        """Measure the files missing in the journal, write the result, and return the exit code."""
        with ExitStack() as ends:
            pool = ends.enter_context(self._pool())
            if not self._options.resume:
                pool.add(self.tasks)
            if self.tasks:
                pool.wait_until_ready()
            self._places.set_aside()
            with Journal(self._places.journal) as journal:
                if self.tasks:
                    self._measure(pool, journal)
                is_written = self._write(journal, channel)
                failed = any(journal.entries[path].status != "ok" for path in self.tasks)
        if len(self._paths) == 1 and is_written:
            self._places.journal.unlink()  # there is nothing to go on with
        if self._faults:
            return 70
        failed = failed and not self._options.errors_exit_0
        return 1 if failed or not is_written else 0

    def _measure(self, pool: Pool, journal: Journal) -> None:
        blender = pool.about["blender"]
        common = {"options": _digest(self._options), "addon": _version(), "blender": blender}
        limits = {"seconds": self._limits.seconds, "memory": self._limits.memory}
        if self._options.resume:
            missing = [path for path in self.tasks if not _is_recorded(journal, path, common, limits)]
            self.done = len(self.tasks) - len(missing)
            pool.add(missing)
        progress = Progress(len(self.tasks), self.done)
        while not pool.is_done:
            for outcome in pool.step():
                status, reason, text = self._recorded(outcome, blender)
                key = {"path": outcome.task, **outcome.head.get("state", state(outcome.task)), **common}
                reads = outcome.head.get("reads")
                journal.append(key, status, outcome.attempts, outcome.seconds, limits, text, reads)
                self.done += 1
                progress.add(status)
                self._report(progress, outcome, reason)
            for file, note in pool.notes:
                progress.clear()
                print_message(file, note)
            pool.notes.clear()
            progress.show()
        progress.finish()

    def _recorded(self, outcome: TaskOutcome, blender: str) -> tuple[str, Finding | None, bytes]:
        """Return a file's status, the reason for a missing answer or None, and the document, which always exists."""
        if outcome.status == "answered":
            with suppress(ValueError, KeyError, TypeError):
                return json.loads(outcome.data)["status"], None, outcome.data
            outcome.status, outcome.how = "crashed", "no answer"
        if outcome.status == "timeout":
            reason = finding(FILE_TIMED_OUT, seconds=self._limits.seconds)
        elif outcome.status == "memory":
            assert self._limits.memory is not None
            reason = finding(FILE_TOOK_MEMORY, megabytes=self._limits.memory / 1e6)
        else:
            reason = finding(FILE_CRASHED, how=outcome.how, count=outcome.attempts)
        values = {"blender": blender, "frame": self._options.frame}
        document = failed_document(outcome.task, str(reason), outcome.status, **values)
        return outcome.status, reason, json.dumps(document).encode()

    def _report(self, progress: Progress, outcome: TaskOutcome, reason: Finding | None) -> None:
        """Print the reason for a failed file, else the messages of its child.

        After an internal error, print all output of the child.
        """
        faults = outcome.head.get("faults", 0)
        self._faults += faults
        if reason is not None:
            progress.clear()
            print_message(outcome.task, reason)
            return
        lines = outcome.said.splitlines(keepends=True)
        shown = "".join(line for line in lines if faults or line.startswith(PROGRAM + ": "))
        if shown:
            progress.clear()
            sys.stderr.write(shown)

    def _write(self, journal: Journal, channel: int) -> bool:
        """Write the result, and return whether it could be written."""
        options = self._options
        documents = _Documents(journal, self._paths)
        check = own_results.guard("output", options.output in options.forced)
        return output.written(FORMATS[options.format](documents), options.output, channel, check)


@dataclass
class _Documents:
    """The documents of the files in their order, read again each time, so that never all of them are in memory."""

    journal: Journal
    paths: list[str]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return map(self.journal.document, self.paths)


def _is_recorded(journal: Journal, path: str, common: dict[str, Any], limits: dict[str, Any]) -> bool:
    entry = journal.entries.get(path)
    same = entry is not None and entry.serves({"path": path, **state(path), **common}, limits)
    return same and journal.is_current(path)


def _positions(options: Namespace) -> list[str]:
    """Return the files of positions of samples."""
    return [path for _, path in options.positions or ()]


def _digest(options: Namespace) -> str:
    """Return a digest of everything besides the file that changes the numbers."""
    positions = [state(path) for path in _positions(options)]
    text = json.dumps([of_numbers(options), positions, os.environ.get("BODY_MOMENTS_LIMITS", "")], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _version() -> str:
    """Return the add-on's version."""
    manifest = pkgutil.get_data(_ROOT, "blender_manifest.toml")
    return tomllib.loads(manifest.decode())["version"] if manifest else ""
