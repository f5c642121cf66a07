# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`similar`: which of the bodies measured with --signature are most like one of them."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from ...core.shape.library import Entry, nearest, read_library, verdict

_COLUMNS = "{:>12} {:>10}  {:<21} {}\n"


class Unanswerable(Exception):
    """A library or a name that leaves nothing to compare. Its text is a sentence for the person who gave it."""


def parse(argv: list[str]) -> argparse.Namespace:
    """The options of `similar`. Raises SystemExit(2), or SystemExit(0) after --help."""
    parser = argparse.ArgumentParser(
        prog="body_moments",
        usage="body_moments similar LIBRARY [LIBRARY ...] --to NAME [options]",
        description="The bodies of a library that are most like one of them. A library is what `measure --signature "
        "--format jsonl` writes.",
        epilog="exit code: 0 compared, 1 some records have no signature, 2 wrong usage",
        allow_abbrev=False,
    )
    parser.add_argument("command", choices=("similar",), metavar="similar")
    parser.add_argument("libraries", nargs="+", type=Path, metavar="LIBRARY")
    parser.add_argument(
        "--to",
        required=True,
        metavar="NAME",
        help="the body's name, or FILE:NAME where several files have one of that name",
    )
    parser.add_argument("--any-size", action="store_true", help="copies of another size are as near")
    parser.add_argument("--any-hand", action="store_true", help="mirror images are as near")
    parser.add_argument("--count", type=_count, default=10, metavar="N", help="how many are printed (10)")
    return parser.parse_args(argv)


def _count(text: str) -> int:
    if not text.isdecimal() or not int(text):
        raise argparse.ArgumentTypeError("{!r} is not a positive number".format(text))
    return int(text)


def answer(options: argparse.Namespace) -> tuple[str, int]:
    """The table, and how many records could not be compared. Raises Unanswerable."""
    entries, faults = [], []
    for path in options.libraries:
        try:
            found, missing = read_library(path)
        except (OSError, ValueError) as error:
            reason = "{}.".format(getattr(error, "strerror", None) or str(error).removesuffix("."))
            raise Unanswerable("{}: {}".format(path, reason)) from error
        entries += found
        faults += missing
    for fault in faults:
        sys.stderr.write("body_moments: {}\n".format(fault))
    wanted = _named(entries, options.to)
    rows = [_COLUMNS.format("distance", "size", "", "name")]
    others = [entry for entry in entries if entry is not wanted]
    ranked = nearest(wanted.signature, others, options.any_size, options.any_hand)
    for entry, likeness in ranked[: options.count]:
        distance = "{:.3e}".format(likeness.distance(options.any_size, options.any_hand))
        rows.append(_COLUMNS.format(distance, "{:.4g}".format(likeness.scale), verdict(likeness), entry.label))
    return "".join(rows), len(faults)


def _named(entries: list[Entry], name: str) -> Entry:
    found = [entry for entry in entries if entry.name == name] or [entry for entry in entries if entry.label == name]
    if not found:
        raise Unanswerable("No body with a signature is called {}.".format(name))
    if len(found) > 1:
        raise Unanswerable(
            "Several bodies are called {}; name one of them: {}.".format(
                name, ", ".join(entry.label for entry in found)
            )
        )
    return found[0]
