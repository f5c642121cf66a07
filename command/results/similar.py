# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`similar`: a ranking of bodies measured with --signature by their likeness to one of them."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core import measurement, shape, verdict
from ..options.option_types import count
from ..parser import Parser, UsageError, flag, value

_COLUMNS = "{:>12} {:>10}  {:<27} {}\n"


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options of `similar`. Raises SystemExit(2), or HelpRequested."""
    parser = Parser(
        prog="body_moments",
        usage="body_moments similar LIBRARY [LIBRARY ...] --to NAME [options]",
        description="The bodies of a library that are most like one of them. A library is what "
        "`measure --signature "
        "--format jsonl` writes.",
        epilog="exit code: 0 compared, 1 some records have no signature, 2 wrong usage, 3 "
        "interrupted",
        allow_abbrev=False,
    )
    parser.add_argument("command", metavar="similar")
    parser.add_argument("libraries", nargs="+", type=Path, metavar="LIBRARY")
    text = "the body's name, or FILE:NAME where several files have one of that name"
    parser.add_options(
        {
            "--to": value(str, "NAME", text, required=True),
            "--any-size": flag("copies of another size are as near"),
            "--any-hand": flag("mirror images are as near"),
            "--count": value(count, "N", "how many are printed (10)", default=10),
        }
    )
    return parser.parse_args(argv)


def answer(options: argparse.Namespace) -> tuple[list[str], int]:
    """Return the table, and the exit code: 1 if some records could not be compared.

    Raises UsageError.
    """
    entries, failures = [], []
    for path in options.libraries:
        try:
            readable, missing = shape.read_library(path)
        except OSError as error:
            raise UsageError(
                "{} cannot be read: {}".format(path, verdict.system_reason(error))
            ) from error
        entries += readable
        failures += missing
    for failure in failures:
        measurement.print_message(failure)
    query = _entry_by_name(entries, options.to)
    lines = [_COLUMNS.format("distance", "size", "", "name")]
    other_entries = [entry for entry in entries if entry is not query]
    ranked = shape.rank(query.signature, other_entries, options.any_size, options.any_hand)
    for entry, likeness in ranked[: options.count]:
        distance = "{:.3e}".format(likeness.distance(options.any_size, options.any_hand))
        similarity = verdict.SIMILARITY[shape.classify(likeness)]
        lines.append(
            _COLUMNS.format(
                distance,
                "{:.4g}".format(likeness.scale),
                similarity,
                measurement.visible(entry.label),
            )
        )
    return lines, 1 if failures else 0


def _entry_by_name(entries: list[shape.Entry], name: str) -> shape.Entry:
    """Return the entry of a body by its name, else by its label, FILE:NAME. UsageError if there is
    none, or several.
    """
    matches = [entry for entry in entries if entry.name == name] or [
        entry for entry in entries if entry.label == name
    ]
    if not matches:
        raise UsageError("No body named {} has a signature".format(name))
    if len(matches) > 1:
        labels = ", ".join(entry.label for entry in matches)
        raise UsageError("Several bodies are named {}. Use one of {}".format(name, labels))
    return matches[0]
