# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Why one of many objects was left as it was: a refusal, or an error of this program that nobody foresaw.

Either ends the work on its object alone. An error is told as one, and its traceback goes to the console, so that it can
be reported.
"""

from __future__ import annotations

import traceback

UNFORESEEN = (RecursionError, NotImplementedError)  # which Python derives from RuntimeError, that Blender refuses by


def reason(error: Exception, refusals: tuple[type[Exception], ...] = ()) -> str:
    """What to report of an exception. refusals: what only says that an object cannot be worked on, and why."""
    if is_refusal(error, refusals):
        return str(getattr(error, "reason", error))
    traceback.print_exception(error)
    told = ": ".join([type(error).__name__, *filter(None, [" ".join(str(error).split()).removesuffix(".")])])
    return "Internal error: {:s}; please report it.".format(told)


def is_refusal(error: Exception, refusals: tuple[type[Exception], ...]) -> bool:
    return isinstance(error, refusals) and not isinstance(error, UNFORESEEN)
