# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognition of our own results by their beginning: only these are replaced without --force."""

from __future__ import annotations

import csv
import re
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from ...core.measurement.documents import FLAT_SPECTRUM_ARRAYS, SPECTRUM_ARRAYS, to_csv
from ...core.robots.write.marker import is_audit, is_ours

_HEAD = 1 << 16  # bytes that hold a header, or the beginning of a document
_BEGINNING = re.compile(rb'(\s*\[?\s*\{\s*"schema"\s*:\s*"body-moments[a-z-]*/)|<!doctype html><!-- Body Moments')
_SPECTRUM = {name + ".npy" for name in SPECTRUM_ARRAYS}
_FLAT_SPECTRUM = _SPECTRUM | {name + ".npy" for name in FLAT_SPECTRUM_ARRAYS}
_COLUMNS = next(csv.reader(to_csv([])))
_LAST = 2  # columns at the end, behind optional ones


def is_replaceable(path: Path) -> bool:
    """Return whether a result may replace `path` without loss: nothing, no regular file, an empty file, or a result.

    Raises OSError.
    """
    return not path.is_file() or not path.stat().st_size or is_result(path)


def is_result(path: Path) -> bool:
    """Return whether a file is a result, a journal or a list of ours. Raises OSError."""
    with open(path, "rb") as file:
        head = file.read(_HEAD)
    return bool(_BEGINNING.match(head)) or is_ours(head) or is_audit(head) or _is_table(head) or _is_spectrum(path)


def guard(force: bool) -> Callable[[Path], None]:
    """Return a check for `whole_file` that raises FileExistsError if a foreign file would be lost, unless `force`."""

    def check(path: Path) -> None:
        if not force and not is_replaceable(path):
            raise FileExistsError("{} is not a result of body_moments and would be lost".format(path))

    return check


def _is_table(head: bytes) -> bool:
    columns = head.split(b"\n", 1)[0].rstrip(b"\r").decode("utf-8", "replace").split(",")
    return columns[: len(_COLUMNS) - _LAST] == _COLUMNS[:-_LAST] and columns[-_LAST:] == _COLUMNS[-_LAST:]


def _is_spectrum(path: Path) -> bool:
    with suppress(zipfile.BadZipFile), zipfile.ZipFile(path) as arrays:
        return {*arrays.namelist()} in (_SPECTRUM, _FLAT_SPECTRUM)
    return False
