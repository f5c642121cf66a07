# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of the result: to a file, whole or not at all, or alone on the standard output.

Blender and its importers print on the standard output from C. So its descriptor is taken away from them: the original
standard output is kept for the result, and descriptor 1 becomes the standard error. It is not given back, because
output buffered by C until then would follow the result; the entries that call this are the last thing their process
does.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from ...core.files.whole_file import whole_file
from ...core.measurement.plain_text import print_message
from ...core.verdict.finding import finding, system_reason
from ..findings import USAGE_RESULT_NOT_WRITTEN

_STDOUT = {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}  # its descriptor may not be 1 any more


def claim_stdout() -> int:
    """Return a descriptor of the standard output, unreachable to the rest of this process, or -1 if it is closed."""
    silent = not _is_open(2)
    try:
        channel = os.dup(1)
    except OSError:
        channel = -1
    else:
        sys.stdout.flush()
    if silent:  # its number is free, and whatever is opened next would be written to as the standard error
        if channel == 2:
            channel = os.dup(channel)
        nowhere = os.open(os.devnull, os.O_WRONLY)
        if nowhere != 2:
            os.dup2(nowhere, 2)
            os.close(nowhere)
        sys.stderr = sys.stderr or io.StringIO()
    os.dup2(2, 1)
    return channel


def _is_open(descriptor: int) -> bool:
    try:
        os.fstat(descriptor)
    except OSError:
        return False
    return True


def is_stdout(path: Path) -> bool:
    """Return whether this is a name of the standard output."""
    return str(path) in _STDOUT


def is_stream(path: Path | None) -> bool:
    """Return whether a result goes to the standard output, a pipe or a device, which no file can be beside."""
    return path is None or is_stdout(path) or path.exists() and not path.is_file()


def write(parts: Iterable[str], path: Path | None, channel: int, check: Callable[[Path], None] | None = None) -> None:
    """Write a result to `path`, or to a descriptor if it is None. check: as in `whole_file`. Raises OSError."""
    # A file name that is not UTF-8 holds lone surrogates. Escaped so, they are what JSON writes for
    # them.
    pieces = (part.encode("utf-8", "backslashreplace") for part in parts)
    if path is None or is_stdout(path):
        for piece in pieces:
            _write_all(channel, piece)
    else:
        with whole_file(path, check) as file:
            file.writelines(pieces)


def written(parts: Iterable[str], path: Path | None, channel: int, check: Callable[[Path], None] | None = None) -> bool:
    """Return whether the result was written; print the reason for a failure to the standard error."""
    try:
        write(parts, path, channel, check)
    except OSError as error:
        print_message(finding(USAGE_RESULT_NOT_WRITTEN, error=system_reason(error)))
        return False
    return True


def _write_all(channel: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(channel, view) :]
