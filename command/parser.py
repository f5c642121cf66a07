# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The parser class of all commands; the options of `measure` are in `measure_parser`."""

import argparse
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

from ..core.measurement import visible

COMMANDS = {
    "measure": "Exact mass properties of the objects in files.",
    "audit": "Checks mass, center and inertia in robot descriptions.",
    "similar": "The bodies of a library that are most like one of them.",
    "simplex": "Raw moments ∫ x^α in n dimensions, with bounds of their rounding, as JSON.",
    "manifest": "Lists the files in folders that can be measured, for `measure --manifest LIST`.",
    "merge": "Joins results of one run, of parts of a list for example: one document a file, as "
    "JSON lines.",
    "to-csv": "Results as a table.",
    "summary": "Counts by status, method and finding, the failed files, the slowest, the widest "
    "bounds.",
    "compare": "Every number of two results, which may differ as far as their bounds or the "
    "tolerance allow.",
    "report": "Results as one HTML file that opens without a network: a table to sort and filter, "
    "and pictures.",
}


def list_commands() -> str:
    """Return the help without a command: all commands, one line each."""
    lines = ["  {:<9} {}".format(*command) for command in COMMANDS.items()]
    return "\n".join(
        [
            "usage: body_moments COMMAND [options] …",
            "",
            *lines,
            "",
            "COMMAND --help explains one.",
            "",
        ]
    )


class UsageError(Exception):
    """A request that cannot be carried out, with its reason: it ends a command with exit code 2."""


class HelpRequested(Exception):
    """The request for help by --help, with the text to print."""


def flag(text: str) -> dict[str, Any]:
    """Return an option without a value. text: its help."""
    return {"action": "store_true", "help": text}


def value(kind: Callable[[str], Any], metavar: str, text: str, **more: Any) -> dict[str, Any]:
    """Return an option with a value of a kind, the value's name, and its help."""
    return {"type": kind, "metavar": metavar, "help": text} | more


def choice(choices: Sequence[str], text: str, **more: Any) -> dict[str, Any]:
    """Return an option with one of several words, and its help."""
    return {"choices": choices, "help": text} | more


class Parser(argparse.ArgumentParser):
    """A parser that escapes control characters in its messages, and raises HelpRequested instead of
    printing help.
    """

    def add_options(self, options: dict[str, dict[str, Any]]) -> None:
        """Add options by their names."""
        for name, settings in options.items():
            self.add_argument(name, **settings)

    def print_help(self, file: object = None) -> NoReturn:
        raise HelpRequested(self.format_help())

    def error(self, message: object) -> NoReturn:
        super().error(visible(str(message)))
