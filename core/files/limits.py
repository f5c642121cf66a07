# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits on the demands of files.

A small file can ask for terabytes: by a sparse file, by compression, by its header.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, fields, replace
from pathlib import Path

from ..verdict import FileError, QueryError
from .findings import FILE_EXCEEDS_LIMIT, LIMITS_UNRECOGNIZED
from .number_text import parse_number


@dataclass(frozen=True)
class Limits:
    """Limits of a file.

    samples: count in one scan. unpacked_bytes: size of compressed samples, which are unpacked into
    memory. entries: count in an archive. header_bytes: size of a header. text_bytes: size of a file
    of surfaces, which is text. allow_outside: True if a header may name a file of samples outside
    of its own folder.
    """

    samples: int = 1 << 33
    unpacked_bytes: int = 1 << 32
    entries: int = 1000
    header_bytes: int = 1 << 20
    text_bytes: int = 1 << 28
    allow_outside: bool = False

    @classmethod
    def parse(cls, text: str) -> Limits:
        """Return limits, some replaced by a text such as “samples=2e10, entries=5000”. QueryError
        if it is invalid.
        """
        names = [field.name for field in fields(cls) if field.type == "int"]
        given = {}
        for part in text.replace(",", " ").split():
            name, _, number = part.partition("=")
            try:
                given[name] = int(parse_number(number))
            except (ValueError, OverflowError):  # no number, NaN, infinity
                given[name] = 0
            if name not in names or given[name] < 1:
                raise QueryError(LIMITS_UNRECOGNIZED, text=part[:60], names=names)
        return replace(cls(), **given)

    def check(self, path: Path, name: str, count: int) -> None:
        """Raise FileError if a count of a file exceeds the limit with that name."""
        limit = getattr(self, name)
        if count > limit:
            # The message suggests a limit with which the next files pass, too.
            suggested_limit = max(int(count), 2 * limit)
            raise FileError(
                FILE_EXCEEDS_LIMIT,
                file=path.name,
                name=name,
                count=int(count),
                limit=limit,
                next=suggested_limit,
            )


DEFAULT_LIMITS = Limits()


def file_limits() -> Limits:
    """Return the limits that the environment variable sets, or raise QueryError if it is
    invalid.
    """
    return Limits.parse(os.environ.get("BODY_MOMENTS_LIMITS", ""))
