# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parser class of all commands; the options of `measure` are in `measure_parser`."""

from __future__ import annotations

import argparse
from typing import NoReturn

from ..core.measurement.plain_text import visible


class UsageError(Exception):
    """A request that cannot be carried out, with its reason: it ends a command with exit code 2."""


class HelpRequested(Exception):
    """The request for help by --help, with the text to print."""


class Parser(argparse.ArgumentParser):
    """A parser that escapes control characters in its messages, and raises HelpRequested instead of printing help."""

    def print_help(self, file: object = None) -> NoReturn:
        raise HelpRequested(self.format_help())

    def error(self, message: object) -> NoReturn:
        super().error(visible(str(message)))
