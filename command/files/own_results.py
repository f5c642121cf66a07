# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognition of our own results by their content: they alone are replaced without --force."""

from __future__ import annotations

import csv
import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

from ...core.measurement.documents import FLAT_SPECTRUM_ARRAYS, SCHEMA, SPECTRUM_ARRAYS, to_csv
from ...core.robots.findings import RESULT_FOREIGN_FILE
from ...core.robots.write.marker import AUDIT_SCHEMA, is_audit, is_ours
from ...core.verdict.finding import finding

_HEAD = 1 << 16  # bytes that hold a header, or the beginning of a document
_SCHEMAS = (SCHEMA, AUDIT_SCHEMA)
_DOCUMENT = re.compile(r'\s*\[?\s*\{{\s*"schema"\s*:\s*"(?:{})"'.format("|".join(map(re.escape, _SCHEMAS))).encode())
_COLUMNS = next(csv.reader(to_csv([])))
_LAST = 2  # columns at the end, behind optional ones


def replaceable(path: Path, option: str) -> bool:
    """Return whether a result may replace `path` without loss.

    It may if there is nothing, no regular file, or an older result. option: "output" or "fourier". Raises OSError.
    """
    return not path.exists() or not path.is_file() or _is_result(path, option)


def is_empty(path: Path) -> bool:
    """Return whether it is an empty file, as `mktemp` makes them. Raises OSError."""
    return path.is_file() and not path.stat().st_size


def guard(option: str, forced: bool) -> Callable[[Path], None]:
    """Return a check that raises FileExistsError if a file has appeared that is not `replaceable`.

    forced: the file may be replaced all the same, because it existed when --force was given.
    """

    def check(path: Path) -> None:
        if not forced and not is_empty(path) and not replaceable(path, option):
            raise FileExistsError(str(finding(RESULT_FOREIGN_FILE, path=str(path))))

    return check


def _is_result(path: Path, option: str) -> bool:
    try:
        if option == "fourier":
            with zipfile.ZipFile(path) as arrays:
                names = {name.removesuffix(".npy") for name in arrays.namelist()}
                return names in ({*SPECTRUM_ARRAYS}, {*SPECTRUM_ARRAYS, *FLAT_SPECTRUM_ARRAYS})
        with open(path, "rb") as file:
            head = file.read(_HEAD)
        return (
            is_ours(head)
            or is_audit(head)
            or _is_table(head)
            or bool(_DOCUMENT.match(head))
            and _are_documents(path.read_text(encoding="utf-8"))
        )
    except (ValueError, RecursionError, zipfile.BadZipFile):
        return False


def _is_table(head: bytes) -> bool:
    columns = head.split(b"\n", 1)[0].decode("utf-8").split(",")
    return columns[: len(_COLUMNS) - _LAST] == _COLUMNS[:-_LAST] and columns[-_LAST:] == _COLUMNS[-_LAST:]


def _are_documents(text: str) -> bool:
    try:
        found = json.loads(text)
    except ValueError:
        found = [json.loads(line) for line in text.split("\n") if line.strip()]
    found = found if isinstance(found, list) else [found]
    return all(isinstance(one, dict) and one.get("schema") in _SCHEMAS for one in found)
