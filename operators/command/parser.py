# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parser of a command line, whose messages may hold names of files."""

from __future__ import annotations

import argparse
from typing import NoReturn

from ..write.terminal import visible


class HelpRequested(Exception):
    """Raised for --help, with its text."""


class Parser(argparse.ArgumentParser):
    """One that shows control characters, and leaves it to its caller where the help goes."""

    def print_help(self, file: object = None) -> NoReturn:
        raise HelpRequested(self.format_help())

    def error(self, message: object) -> NoReturn:
        super().error(visible(str(message)))
