# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reason why one of many objects was left alone: a refusal, or an unforeseen error of this
program.

Both end only the work on their object. An unforeseen error is reported, and its traceback goes to
the console.
"""

import traceback

from .finding_types import Finding, MeasureError, finding
from .findings import INTERNAL_ERROR, OUT_OF_MEMORY

CODE = INTERNAL_ERROR
PACKAGE = __name__.removesuffix("core.verdict.internal_error")


def finding_of(error: Exception) -> Finding:
    """Return the finding of a refusal or of too little memory; for any other error, print its
    traceback first.
    """
    if isinstance(error, MeasureError):
        return error.finding
    if isinstance(error, MemoryError):
        return finding(OUT_OF_MEMORY)
    traceback.print_exception(error)
    message = " ".join(str(error).split()).removesuffix(".") or "-"
    return finding(CODE, type=type(error).__name__, error=message, where=_where(error))


def _where(error: Exception) -> str:
    """Return file and line of the innermost frame of this program."""
    where = "-"
    for frame, line in traceback.walk_tb(error.__traceback__):
        name = frame.f_globals.get("__name__", "")
        if name.startswith(PACKAGE):
            where = "{:s}.py:{:d}".format(name.removeprefix(PACKAGE).replace(".", "/"), line)
    return where
