# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of output places before anything is measured; standard library only.

The places must be writable, and neither an input nor somebody else's file.
"""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

from ...core.robots.findings import USAGE_OVERWRITES_INPUT
from ...core.verdict.finding import finding, system_reason
from ..files import output, own_results
from ..findings import (
    USAGE_FOLDER_MISSING,
    USAGE_FOLDER_READ_ONLY,
    USAGE_FOREIGN_FILE,
    USAGE_IS_FOLDER,
    USAGE_NOT_REPLACEABLE,
    USAGE_OVERWRITES_DEPENDENCY,
    USAGE_PATH,
)
from .arguments import TARGETS
from .arguments import fail as fail_measure

Fail = Callable[[object], NoReturn]  # ends a command with the reason and its usage


def check_places(options: Namespace, fail: Fail = fail_measure) -> None:
    """End with a message if a file cannot be written."""
    for option in TARGETS:
        target = getattr(options, option, None)
        if target is None or output.is_stdout(target):
            continue
        try:
            _check_place(option, target, fail)
        except OSError as error:  # a name that is too long, a folder that may not be entered
            fail(finding(USAGE_PATH, path=str(error.filename), error=system_reason(error)))


def _check_place(option: str, target: Path, fail: Fail) -> None:
    if not target.parent.is_dir():
        fail(finding(USAGE_FOLDER_MISSING, option=option, folder=str(target.parent)))
    if target.is_dir():
        fail(finding(USAGE_IS_FOLDER, option=option, path=str(target)))
    with suppress(FileNotFoundError):
        os.stat(target)
    folder = Path(os.path.realpath(target)).parent
    if not (target.exists() and not target.is_file() or os.access(folder, os.W_OK)):
        fail(finding(USAGE_FOLDER_READ_ONLY, option=option, folder=str(folder)))


def files_to_replace(
    options: Namespace, read: Iterable[str | Path], fail: Fail = fail_measure
) -> list[tuple[Path, str]]:
    """Return the existing targets that are no results of ours, each with its option.

    Ends with a message if a target is among the files that are `read`, or without --force if it is somebody else's and
    not empty. `options.forced`: the targets that need --force.
    """
    options.forced = []
    read, replaced = list(read), []
    for option in TARGETS:
        target = getattr(options, option, None)
        if target is None or not target.exists() or output.is_stdout(target):
            continue
        if any(os.path.exists(path) and os.path.samefile(path, target) for path in read):
            fail(finding(USAGE_OVERWRITES_INPUT, option=option, path=str(target)))
        try:
            if own_results.replaceable(target, option):
                continue
            empty = own_results.is_empty(target)
        except OSError as error:
            fail(finding(USAGE_NOT_REPLACEABLE, option=option, path=str(target), error=system_reason(error)))
        if not (empty or options.force):
            fail(finding(USAGE_FOREIGN_FILE, option=option, path=str(target)))
        replaced.append((target, option))
        if not empty:
            options.forced.append(target)
    return replaced


def check_dependencies(replaced: list[tuple[Path, str]], read: Iterable[str | Path]) -> None:
    """End with a message if a file to be replaced is read by a measurement."""
    for path in read:
        for target, option in replaced:
            if os.path.exists(path) and target.samefile(path):
                fail_measure(finding(USAGE_OVERWRITES_DEPENDENCY, option=option, path=str(target)))
