# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Why one of many objects was left as it was: a refusal, or an error of this program that nobody foresaw.

Either ends the work on its object alone. An error is reported as one, and its traceback goes to the console.
"""

from __future__ import annotations

import traceback
from pathlib import Path

from .finding import Finding, MeasureError, finding

ROOT = Path(__file__).resolve().parents[2]
UNFORESEEN = (RecursionError, NotImplementedError)  # which Python derives from RuntimeError, that Blender refuses by


def finding_of(error: Exception) -> Finding:
    """What to report of an exception: the finding of a refusal; else that this program failed, how and where, after its
    traceback has gone to the console."""
    if isinstance(error, MeasureError):
        return error.finding
    traceback.print_exception(error)
    message = " ".join(str(error).split()).removesuffix(".") or "no message"
    return finding("internal_error", type=type(error).__name__, error=message, where=_where(error))


def _where(error: Exception) -> str:
    """File and line of the innermost frame of this program, as this program's files are called."""
    where = "unknown place"
    for frame, line in traceback.walk_tb(error.__traceback__):
        path = Path(frame.f_code.co_filename)
        if path.is_relative_to(ROOT):
            where = "{:s}:{:d}".format(path.relative_to(ROOT).as_posix(), line)
    return where


def reason(error: Exception, refusals: tuple[type[Exception], ...] = ()) -> str:
    """What to report of an exception. refusals: what only says that an object cannot be worked on, and why."""
    if is_refusal(error, refusals):
        return str(getattr(error, "reason", error))
    traceback.print_exception(error)
    told = ": ".join([type(error).__name__, *filter(None, [" ".join(str(error).split()).removesuffix(".")])])
    return "Internal error: {:s}; please report it.".format(told)


def is_refusal(error: Exception, refusals: tuple[type[Exception], ...]) -> bool:
    return isinstance(error, refusals) and not isinstance(error, UNFORESEEN)
