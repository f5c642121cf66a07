# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of the result: to a file, whole or not at all, or alone on the standard output; checks of
its place.

Blender and its importers print on the standard output from C. So `claim_stdout` keeps the original
one for the result, and descriptor 1 becomes the standard error until the process ends, as C may
print what it has buffered at any time.
"""

import csv
import os
import re
import sys
import zipfile
from argparse import Namespace
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NoReturn

from ...core import measurement, robots, verdict
from ...core.files.whole_file import whole_file
from ..options import arguments, option_types

_STDOUT = {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}  # its descriptor may not be 1 any more
_HEAD = 1 << 16  # bytes that hold a header, or the beginning of a document
_BEGINNING = re.compile(
    rb'(\s*\[?\s*\{\s*"schema"\s*:\s*"body-moments[a-z-]*/)|<!doctype html><!-- Body Moments'
)
_SPECTRUM = {name + ".npy" for name in measurement.SPECTRUM_ARRAYS}
_FLAT_SPECTRUM = _SPECTRUM | {name + ".npy" for name in measurement.FLAT_SPECTRUM_ARRAYS}
_COLUMNS = next(csv.reader(measurement.to_csv([])))
_LAST = 2  # columns of a table at the end, behind optional ones
Fail = Callable[[str], NoReturn]  # ends a command with the reason and its usage


def claim_stdout() -> int:
    """Return a descriptor of the standard output, unreachable to the rest of this process, or -1 if
    it is closed.
    """
    try:
        channel = os.dup(1)
    except OSError:
        channel = -1
    else:
        sys.stdout.flush()
    os.dup2(2, 1)
    return channel


def is_stdout(path: Path) -> bool:
    """Return whether a path is a name of the standard output."""
    return str(path) in _STDOUT


def is_stream(path: Path | None) -> bool:
    """Return whether a result goes to the standard output, a pipe or a device, beside which no file
    can stand.
    """
    return path is None or is_stdout(path) or path.exists() and not path.is_file()


def write_result(
    parts: Iterable[str],
    path: Path | None,
    channel: int,
    check: Callable[[Path], None] | None = None,
) -> bool:
    """Write a result to `path`, or to the descriptor `channel` if `path` is None, and return
    whether it succeeded.

    Print the reason for a failure to the standard error. check: as in `whole_file`.
    """
    # A file name that is not UTF-8 holds lone surrogates. Escaped so, they are what JSON writes for
    # them.
    pieces = (part.encode("utf-8", "backslashreplace") for part in parts)
    try:
        if path is None or is_stdout(path):
            for piece in pieces:
                view = memoryview(piece)
                while view:
                    view = view[os.write(channel, view) :]
        else:
            with whole_file(path, check) as file:
                file.writelines(pieces)
    except OSError as error:
        measurement.print_message(
            "the result cannot be written: {}".format(verdict.system_reason(error))
        )
        return False
    return True


def write_documents(
    documents: Iterable[dict[str, Any]], options: Namespace, channel: int
) -> bool | None:
    """Write documents, which may be iterated twice, in the requested format, and return whether it
    succeeded; None if there is no robot to write, and a file at --output stays as it was.
    """
    if options.format in robots.FORMATS and not any("robot" in document for document in documents):
        measurement.print_message("no robot was written, and no file was replaced")
        return None
    text = option_types.FORMATS[options.format](documents)
    return write_result(text, options.output, channel, guard(options.force))


def is_replaceable(path: Path) -> bool:
    """Return whether a result may replace `path` without loss: nothing, no regular file, an empty
    file, or a result.

    Raises OSError.
    """
    return not path.is_file() or not path.stat().st_size or is_result(path)


def is_result(path: Path) -> bool:
    """Return whether a file is a result, a journal or a list of ours. Raises OSError."""
    with open(path, "rb") as file:
        head = file.read(_HEAD)
    if _BEGINNING.match(head) or robots.is_ours(head) or robots.is_audit(head):
        return True
    with suppress(zipfile.BadZipFile), zipfile.ZipFile(path) as arrays:
        return {*arrays.namelist()} in (_SPECTRUM, _FLAT_SPECTRUM)
    first_line, _, _ = head.partition(b"\n")
    columns = first_line.rstrip(b"\r").decode("utf-8", "replace").split(",")
    first_columns = _COLUMNS[:-_LAST]
    return columns[: len(first_columns)] == first_columns and columns[-_LAST:] == _COLUMNS[-_LAST:]


def guard(force: bool) -> Callable[[Path], None]:
    """Return a check for `whole_file` that raises FileExistsError if a foreign file would be lost,
    unless `force`.
    """

    def check(path: Path) -> None:
        if not force and not is_replaceable(path):
            raise FileExistsError(
                "{} is not a result of body_moments and would be lost".format(path)
            )

    return check


def check_targets(
    options: Namespace, read: Sequence[str | Path], fail: Fail = arguments.fail
) -> None:
    """Call `fail` with a message if a result cannot be written, or would replace an input or a
    foreign file.
    """
    for option in arguments.TARGETS:
        target = getattr(options, option, None)
        if target is None or is_stdout(target):
            continue
        try:
            refusal = _find_refusal(target, read, options.force)
        except OSError as error:  # a name that is too long, a folder that may not be entered
            refusal = "{}: {}. Use another name".format(
                error.filename or target, verdict.system_reason(error)
            )
        if refusal:
            fail("argument --{}: {}".format(option.replace("_", "-"), refusal))


def _find_refusal(target: Path, read: Sequence[str | Path], force: bool) -> str:
    """Return the reason why a result must not be written, or an empty text: the first reason that
    holds. Raises OSError.
    """
    folder = os.path.dirname(os.path.realpath(target))
    is_read = target.exists() and any(
        os.path.exists(path) and target.samefile(path) for path in read
    )
    loses_foreign_file = (
        "{} is not a result of body_moments and would be lost. Use another name, or --force"
    )
    refusals = {
        "no folder {}".format(target.parent): not target.parent.is_dir(),
        "{} is a folder".format(target): target.is_dir(),
        "": is_stream(target),  # A pipe or a device has none of the faults below.
        "no file can be written in {}. Use another folder".format(folder): (
            not os.access(folder, os.W_OK)
        ),
        "{} is a file that is read. Use another name".format(target): is_read,
        loses_foreign_file.format(target): not (force or is_replaceable(target)),
    }
    return next((reason for reason, holds in refusals.items() if holds), "")
