# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Refusals of damaged files."""

import os
import struct
import zlib
from pathlib import Path
from typing import Any

from ..verdict import FileError, finding
from .findings import (
    AT_ROW,
    DAMAGE_SIZE,
    FILE_DAMAGED,
    FILE_MISSING,
    FILE_UNREADABLE,
    HEADER_FIELD,
    NON_FINITE_COORDINATES,
)

NOT_REGULAR = "it is not a regular file"

# Errors from reading a file whose structure is wrong.
MALFORMED = (
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    OverflowError,
    RecursionError,
    struct.error,
    zlib.error,
)


def damaged(path: Path, code: str, **values: Any) -> FileError:
    """Return the error for a damaged file. code, values: of the finding that names the fault."""
    return FileError(FILE_DAMAGED, file=path.name, cause=finding(code, **values).as_record())


def wrong_field(format: str, name: str, wanted: str, *values: float) -> FileError:
    """Return the error for numbers of a header's field. format: of the file. name: of the field.
    wanted: what its numbers should be, in words. values: the numbers that it has.
    """
    return FileError(
        HEADER_FIELD,
        format=format,
        field=name,
        wanted=wanted,
        text=" ".join(map("{:g}".format, values)),
    )


def check_regular(path: str | Path) -> None:
    """Raise FileError unless a path is that of a regular file."""
    if not os.path.exists(path):
        raise FileError(FILE_MISSING)
    if not os.path.isfile(path):
        raise FileError(FILE_UNREADABLE, error=NOT_REGULAR)


def check_length(path: Path, held: int, wanted: int) -> None:
    """Raise FileError unless a file holds exactly the bytes of its samples; more bytes mean wrong
    sizes.
    """
    if held != wanted:
        raise damaged(path, DAMAGE_SIZE, bytes=held, total=wanted)


def refuse_non_finite(count: int, element: str, row: int | str) -> None:
    """Raise FileError if numbers of a file are not finite.

    count: of these numbers. element: what the file has in rows, such as “vertex”. row: the number
    or the name of the first element with such a number.
    """
    if count:
        place = finding(AT_ROW, element=element, row=row).as_record()
        raise FileError(NON_FINITE_COORDINATES, count=count, place=place)
