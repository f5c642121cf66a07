# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of output places before anything is measured; standard library only."""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from ...core.verdict.finding import system_reason
from ..files import output, own_results
from .arguments import TARGETS
from .arguments import fail as fail_measure

Fail = Callable[[str], NoReturn]  # ends a command with the reason and its usage


def check_targets(options: Namespace, read: Sequence[str | Path], fail: Fail = fail_measure) -> None:
    """Call `fail` with a message if a result cannot be written, or would replace an input or a foreign file."""
    for option in TARGETS:
        target = getattr(options, option, None)
        if target is None or output.is_stdout(target):
            continue
        try:
            refusal = _find_refusal(target, read, options.force)
        except OSError as error:  # a name that is too long, a folder that may not be entered
            refusal = "{}: {}. Use another name".format(error.filename or target, system_reason(error))
        if refusal:
            fail("argument --{}: {}".format(option.replace("_", "-"), refusal))


def _find_refusal(target: Path, read: Sequence[str | Path], force: bool) -> str:
    """Return the reason why a result must not be written, or an empty text. Raises OSError."""
    if not target.parent.is_dir():
        return "no folder {}".format(target.parent)
    if target.is_dir():
        return "{} is a folder".format(target)
    if output.is_stream(target):
        return ""
    folder = os.path.dirname(os.path.realpath(target))
    if not os.access(folder, os.W_OK):
        return "no file can be written in {}. Use another folder".format(folder)
    if target.exists() and any(os.path.exists(path) and target.samefile(path) for path in read):
        return "{} is a file that is read. Use another name".format(target)
    if not (force or own_results.is_replaceable(target)):
        return "{} is not a result of body_moments and would be lost. Use another name, or --force".format(target)
    return ""
