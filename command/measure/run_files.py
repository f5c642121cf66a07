# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`measure` over files in children; with --resume it asks the journal's entries which files to
measure again.

Standard library only: it runs in Blender, in a Python with the bpy module, and in any other with
--blender PATH.
"""

import hashlib
import json
import os
import shutil
import sys
import tempfile
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core import files, robots
from ...core.measurement import PROGRAM, counted, failed_document, print_message
from ...core.verdict import Finding, finding, system_reason
from .. import findings, parser
from ..files import output
from ..options import arguments, measure_parser
from ..supervisor import lifeline, listing, processes
from ..supervisor.journal import Journal, locked, state
from ..supervisor.pool import ChildError, Limits, Pool, SetupError, TaskOutcome
from ..supervisor.progress import Progress


def measure(options: Namespace, channel: int, opened: str | None) -> int:
    """Measure the files, and return the exit code. opened: the file that this process has open, if
    any.

    Raises SystemExit if the options are wrong, and KeyboardInterrupt.
    """
    lifeline.end_with_window()
    paths = files_of(options)
    if options.blender is None:
        arguments.check_blender(options, paths)
    command = processes.run_command(_blender(options), ["child"])
    output.check_targets(options, arguments.files_of_options(options, paths, opened))
    with ExitStack() as ends:
        places = _Places(options, ends)
        run = _Supervised(options, paths, command, places)
        try:
            return run.measure(channel)
        except SetupError as error:
            sys.stderr.write(str(error))
            return 2
        except ChildError as error:
            print_message("no process that measures can be started: {}".format(error))
            return 2
        except OSError as error:  # the journal cannot be written, as on a full disk
            print_message("the result cannot be written: {}".format(system_reason(error)))
            return 1
        except KeyboardInterrupt:
            if not places.journal_is_kept:
                raise
            text = (
                "interrupted after {} of {} files; the result was not written. Run the same with "
                "--resume to go on"
            )
            print_message(text.format(run.done, len(run.tasks)))
            return 3


def files_of(options: Namespace) -> list[str]:
    """Return the requested range of the files that are named, in named folders, or in the
    manifest.
    """
    try:
        paths = [*listing.expand(options.files)]
        if options.manifest is not None:
            paths += listing.read(options.manifest, options.part)
    except parser.UsageError as error:
        arguments.fail(str(error))
    except OSError as error:
        arguments.fail("{}: {}".format(error.filename, system_reason(error)))
    if options.range is not None:
        paths = paths[slice(*options.range)]
    if len(paths) != 1 and (options.files or options.manifest is not None):
        if options.fourier is not None:
            arguments.fail(arguments.ONE_OBJECT)
        if options.format in robots.FORMATS:
            arguments.fail(arguments.ONE_FILE.format(options.format))
    return paths


def _blender(options: Namespace) -> str | None:
    """Return the Blender to start: the one named by --blender, or the one of this process; None for
    the bpy module.
    """
    bpy = sys.modules.get("bpy")
    running_blender = None if bpy is None or bpy.app.module else bpy.app.binary_path
    return running_blender if options.blender is None else options.blender


class _Places:
    """Paths of the files of an unfinished run, beside its output, which is locked until `ends` is
    closed.

    work: a folder that does not exist yet. journal_is_kept: whether the journal stays if the run is
    interrupted.
    """

    def __init__(self, options: Namespace, ends: ExitStack) -> None:
        self._replaced: list[Path] = []
        self.journal_is_kept = not output.is_stream(options.output)
        if not self.journal_is_kept:
            folder = Path(ends.enter_context(tempfile.TemporaryDirectory(prefix="body_moments_")))
            self.work = folder / "work"
            self.journal = folder / "journal"
            return
        target = Path(os.path.realpath(options.output))
        folder = files.hidden_path(target, "body_moments.work")
        self.journal = target.with_name(target.name + ".journal")
        self.work = folder / "work"
        try:
            ends.enter_context(locked(folder))
            shutil.rmtree(self.work, ignore_errors=True)  # left behind by a run that was killed
            paths_to_replace = [self.journal]
            if not options.resume:
                is_older = target.is_file() and output.is_result(target)
                self._replaced = [self.journal, *([target] if is_older else [])]
                paths_to_replace += map(_old, self._replaced)
            for path in paths_to_replace:
                if not (options.force or output.is_replaceable(path)):
                    arguments.fail(
                        "argument --output: {} is in the way, and no result. Move it, or use "
                        "--force".format(path)
                    )
        except BlockingIOError:
            text = "argument --output: another run is writing {}. Use another name, or wait"
            arguments.fail(text.format(target))
        except OSError as error:  # Such as a name that is too long with the suffix.
            text = "argument --output: {}: {}"
            arguments.fail(text.format(error.filename or target, system_reason(error)))

    def set_aside(self) -> None:
        """Keep files of an earlier run as .old. Raises OSError."""
        for path in self._replaced:
            if path.exists():
                os.replace(path, _old(path))

    def restore(self) -> None:
        """Put back an older result, but not its journal, that was set aside. Raises OSError."""
        for path in self._replaced[1:]:  # The first is the journal.
            if not path.exists() and _old(path).exists():
                os.replace(_old(path), path)


def _old(path: Path) -> Path:
    return path.with_name(path.name + ".old")


class _Supervised:
    """A run over files by children. tasks: the files, each once. done: count of the recorded
    files.
    """

    def __init__(
        self, options: Namespace, paths: list[str], command: list[str], places: _Places
    ) -> None:
        self._options = options
        self._paths = paths
        self._command = command
        self._places = places
        self.tasks = [*dict.fromkeys(paths)]
        self.done = 0
        self._faults = 0
        cores = processes.cores()
        self._count = max(1, min(options.jobs or cores, len(self.tasks)))
        memory_option = options.memory_mb
        memory = (
            processes.memory_share(self._count)
            if memory_option is None
            else int(memory_option * 1e6)
        )
        self._limits = Limits(options.timeout or measure_parser.DEFAULT_TIMEOUT, memory)
        threads = max(1, cores // self._count)
        self._setup = {"words": options.words, "threads": threads, "memory": memory}

    def measure(self, channel: int) -> int:
        """Measure the files missing in the journal, write the result, and return the exit code."""
        with Pool(self._command, self._count, self._setup, self._limits, self._places.work) as pool:
            if not self._options.resume:
                pool.add(self.tasks)
            if self.tasks:
                pool.wait_until_ready()
            self._places.set_aside()
            with Journal(self._places.journal) as journal:
                if self.tasks:
                    self._measure(pool, journal)
                documents = _Documents(journal, self._paths)
                is_written = output.write_documents(documents, self._options, channel)
                failed = any(journal.entries[path].status != "ok" for path in self.tasks)
        if is_written is None:
            self._places.restore()
        if len(self._paths) == 1 and is_written is not False:
            self._places.journal.unlink()  # there is nothing to go on with
        failed = failed and not self._options.errors_exit_0
        return 70 if self._faults else int(failed or not is_written)

    def _measure(self, pool: Pool, journal: Journal) -> None:
        blender = pool.about["blender"]
        common = {
            "options": _digest(self._options),
            "addon": arguments.version(),
            "blender": blender,
        }
        limits = {"seconds": self._limits.seconds, "memory": self._limits.memory}
        reused_statuses = []
        if self._options.resume:
            entries = journal.entries
            run_options = arguments.run_of(self._options)["options"]
            retried = self._options.retry_failed
            reasons = {
                path: entries[path].reason_to_measure(
                    {"path": path} | state(path) | common, run_options, limits, retried
                )
                if path in entries
                else "not recorded"
                for path in self.tasks
            }
            reused_statuses = [
                entries[path].status for path, reason in reasons.items() if reason is None
            ]
            self.done = len(reused_statuses)
            _report_reuse(reasons)
            pool.add(path for path, reason in reasons.items() if reason is not None)
        progress = Progress(len(self.tasks), reused_statuses)
        while not pool.is_done:
            for outcome in pool.step():
                status, reason, text = self._recorded(outcome, blender)
                head = {
                    "key": (
                        {"path": outcome.task}
                        | outcome.head.get("state", state(outcome.task))
                        | common
                    ),
                    "status": status,
                    "attempts": outcome.attempts,
                    "seconds": round(outcome.seconds, 6),
                    "limits": limits,
                    "reads": outcome.head.get("reads", {}),
                }
                journal.append(head, text)
                self.done += 1
                progress.count_file(status)
                self._report(outcome, reason)
            for file, note in pool.notes:
                print_message(file, note)
            pool.notes.clear()
            progress.show()
        progress.finish()

    def _recorded(self, outcome: TaskOutcome, blender: str) -> tuple[str, Finding | None, bytes]:
        """Return a file's status, the reason for a missing answer or None, and the document, which
        always exists.
        """
        if outcome.status == "answered":
            with suppress(ValueError, KeyError, TypeError):
                return json.loads(outcome.data)["status"], None, outcome.data
            outcome.status = "crashed"
            outcome.how = "no answer"
        reason = {
            "timeout": finding(findings.FILE_TIMED_OUT, seconds=self._limits.seconds),
            "memory": finding(
                findings.FILE_TOOK_MEMORY, megabytes=(self._limits.memory or 0) / 1e6
            ),
            "crashed": finding(findings.FILE_CRASHED, how=outcome.how, count=outcome.attempts),
        }[outcome.status]
        document = failed_document(
            outcome.task,
            str(reason),
            outcome.status,
            blender=blender,
            frame=self._options.frame,
            run=arguments.run_of(self._options),
        )
        return outcome.status, reason, json.dumps(document).encode()

    def _report(self, outcome: TaskOutcome, reason: Finding | None) -> None:
        """Print the reason for a failed file, else the messages of its child.

        After an internal error, print all output of the child.
        """
        faults = outcome.head.get("faults", 0)
        self._faults += faults
        if reason is not None:
            print_message(outcome.task, reason)
        else:
            lines = outcome.said.splitlines(keepends=True)
            sys.stderr.writelines(
                line for line in lines if faults or line.startswith(PROGRAM + ": ")
            )


@dataclass
class _Documents:
    """The documents of the files in order, read from the journal one by one, so that they need not
    fit into memory.
    """

    journal: Journal
    paths: list[str]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return map(self.journal.document, self.paths)


def _report_reuse(reasons: dict[str, str | None]) -> None:
    """Print how many files of an earlier run are reused, and why the others are not."""
    again = Counter(reason for reason in reasons.values() if reason is not None)
    text = "{} of {} reused".format(len(reasons) - again.total(), counted(len(reasons), "file"))
    parts = ["{} {}".format(count, reason) for reason, count in again.most_common()]
    print_message("; ".join([text, *(["to measure: " + ", ".join(parts)] if parts else [])]))


def _digest(options: Namespace) -> str:
    """Return a digest of the options, positions and limits, which influence the numbers besides the
    file.
    """
    positions = [state(path) for _, path in options.positions or ()]
    text = json.dumps(
        [arguments.of_numbers(options), positions, os.environ.get("BODY_MOMENTS_LIMITS", "")],
        sort_keys=True,
    )
    return hashlib.sha256(text.encode()).hexdigest()[:16]
