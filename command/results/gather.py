# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that prepare and gather the results of many files: `manifest`, `merge`, `to-csv`,
`summary` and `report`.

Results are files of `measure` as json or jsonl, and journals. Standard library only.
"""

import argparse
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from ...core import measurement, verdict
from ..options.option_types import count, positive
from ..parser import COMMANDS, Parser, UsageError, flag, value
from ..supervisor import journal, listing
from . import compare

_LISTED = 10  # files in each part of a summary
_OPTIONS = {
    "--output": value(Path, "PATH", "(standard output)"),
    "--force": flag("replace any file at --output (only results)"),
}
_OWN_OPTIONS = {
    "manifest": {
        "--parts": value(
            count,
            "N",
            "divide the list into this many parts, for `measure --part K` (1)",
            default=1,
        )
    },
    "merge": {
        "--manifest": value(
            Path,
            "LIST",
            "refuse results in which a file of this list is missing or has two documents, or with "
            "other files",
        )
    },
    "compare": {
        "--quiet": flag("print only what differs by more than it may"),
        "--tolerance": value(
            positive, "TOLERANCE", "relative to each number's own size (0)", default=0.0
        ),
        "--align": flag("compare in each body's own pose: it may have moved (needs --pose)"),
    },
}
# a document, and its `attempts` and `seconds` from a journal
Entry = tuple[dict[str, Any], dict[str, Any]]


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options of one of these commands. Raises SystemExit(2), or HelpRequested."""
    command = argv[0]
    names = "FOLDER" if command == "manifest" else "RESULT"
    parser = Parser(
        prog="body_moments",
        usage="body_moments {} [options] {} [{} ...]".format(command, names, names),
        description=COMMANDS[command],
        epilog="exit code: 0 done, 1 {}the result cannot be written, 2 wrong usage or no "
        "results".format(
            "numbers differ by more than they may, or " if command == "compare" else ""
        ),
        allow_abbrev=False,
    )
    parser.add_argument("command", metavar=command)
    parser.add_argument("paths", nargs="+", metavar=names)
    parser.add_options(_OPTIONS | _OWN_OPTIONS.get(command, {}))
    return parser.parse_args(argv)


def answer(options: argparse.Namespace) -> tuple[Iterable[str], int]:
    """Return the pieces of the output, and the exit code. Raises UsageError."""
    return _COMMANDS[options.command](options)


def _read(paths: Iterable[str]) -> list[Entry]:
    """Return the documents of files of results, in order; a later document replaces one about the
    same file.
    """
    entries: dict[str | None, Entry] = {}
    for path in paths:
        entries.update(
            (document["file"], (document, about)) for document, about in _read_file(path)
        )
    return [*entries.values()]


def _documents(options: argparse.Namespace) -> list[dict[str, Any]]:
    return [document for document, _ in _read(options.paths)]


def _merge(options: argparse.Namespace) -> tuple[Iterable[str], int]:
    """Return JSON lines of the documents of one run, and exit code 0; a later document replaces one
    about the same file. Raises UsageError.
    """
    documents: dict[str | None, dict[str, Any]] = {}
    counts: Counter[str] = Counter()
    first: tuple[str, dict[str, Any]] | None = None
    for path in options.paths:
        for document, _ in _read_file(path):
            run_options = document.get("run", {}).get("options", {})
            first = first or (path, run_options)
            first_path, first_options = first
            if run_options != first_options:
                text = "{} was made with other options than {}: {}. Merge results of one run"
                names = {
                    name
                    for name in (run_options | first_options)
                    if run_options.get(name) != first_options.get(name)
                }
                raise UsageError(text.format(path, first_path, ", ".join(sorted(names))))
            documents[document["file"]] = document
            counts[os.path.abspath(document["file"] or "")] += 1
    if options.manifest is not None:
        listed = [os.path.abspath(name) for name in listing.read(options.manifest)]
        for fault, names in (
            ("no document of", [name for name in listed if not counts[name]]),
            ("several documents of", [name for name in listed if counts[name] > 1]),
            ("documents of files that are not in the list:", sorted(counts.keys() - {*listed})),
        ):
            if names:
                ellipsis = (
                    " and {} more".format(len(names) - _LISTED) if len(names) > _LISTED else ""
                )
                raise UsageError(
                    "There are {} {}{}".format(fault, ", ".join(names[:_LISTED]), ellipsis)
                )
        place = {name: number for number, name in enumerate(listed)}
        documents = dict(
            sorted(documents.items(), key=lambda item: place[os.path.abspath(item[0] or "")])
        )
    return measurement.to_json_lines(documents.values()), 0


def _read_file(path: str) -> Iterator[Entry]:
    """Yield the documents of one file: a JSON object, an array, or one object on each line.

    Raises UsageError.
    """
    try:
        with open(path, encoding="utf-8-sig", errors="surrogateescape") as file:
            begin = file.read(2)
            file.seek(0)
            if begin[:1] == "[" or begin == "{\n":  # An indented object; others are one line each.
                content = measurement.parse_json(file.read())
                for number, entry in enumerate(
                    content if isinstance(content, list) else [content], 1
                ):
                    yield _entry(entry, "document {}".format(number))
                return
            for number, line in enumerate(file, 1):
                if line.strip():
                    yield _entry(measurement.parse_json(line, number), "line {}".format(number))
    except OSError as error:
        raise UsageError(
            "The results {} cannot be read: {}".format(path, verdict.system_reason(error))
        ) from error
    except ValueError as error:
        text = "{} is not a result of body_moments: {}. Name what “measure” has written"
        raise UsageError(text.format(path, error)) from error


def _entry(record: Any, place: str) -> Entry:
    """Return the document of a record, and what a journal adds.

    ValueError, with the place, if it is neither.
    """
    is_line = isinstance(record, dict) and record.get("schema") == journal.SCHEMA
    try:
        (measurement.check_journal_line if is_line else measurement.check_document)(record)
    except ValueError as error:
        raise ValueError("{}: {}".format(place, error)) from error
    return (record["document"], record) if is_line else (record, {})


def _manifest(options: argparse.Namespace) -> tuple[Iterable[str], int]:
    try:
        paths = [*dict.fromkeys(listing.expand(options.paths))]
    except OSError as error:
        raise UsageError("{}: {}".format(error.filename, verdict.system_reason(error))) from error
    # Relative names in a list start from its folder.
    if options.output and options.output.parent != Path():
        paths = [os.path.abspath(path) for path in paths]
    return listing.write_lines(paths, options.parts), 0


def _summary(options: argparse.Namespace) -> tuple[Iterable[str], int]:
    """Return lines with counts by status and method, findings, slowest files and widest bounds; and
    exit code 0.
    """
    entries = _read(options.paths)
    objects = [
        (document["file"] or "-", entry)
        for document, _ in entries
        for entry in (*document["objects"], *document.get("flat", ()))
    ]
    statuses = Counter(document["status"] for document, _ in entries)
    methods = Counter(entry.get("method", "flat") for _, entry in objects)
    codes = sum((measurement.count_findings(document) for document, _ in entries), Counter())
    times = [
        (float(about["seconds"]), str(document["file"] or "-"))
        for document, about in entries
        if about.get("seconds") is not None
    ]
    shares = [
        (share, "{}: {}".format(file, entry["name"]))
        for file, entry in objects
        for share in [_share(entry)]
        if share is not None
    ]
    failed = [
        "{}  {}: {}".format(
            document["status"],
            document["file"] or "-",
            document["errors"][0]["reason"] if document["errors"] else "-",
        )
        for document, _ in entries
        if document["status"] != "ok"
    ]
    ellipsis = ["and {} more".format(len(failed) - _LISTED)] if len(failed) > _LISTED else []
    sections = {
        "Not measured:": [*failed[:_LISTED], *ellipsis],
        "Findings, by how many objects or files have them:": [
            "{:>8}  {:<8} {}".format(count, *row) for row, count in codes.most_common()
        ],
        "Slowest, in seconds:": [
            "{:>10.3f}  {}".format(*row) for row in sorted(times, reverse=True)[:_LISTED]
        ],
        "Widest bounds of the volume or area, of its size:": [
            "{:>10.1e}  {}".format(*row) for row in sorted(shares, reverse=True)[:_LISTED]
        ],
    }
    lines = [
        "{}: {}".format(measurement.counted(statuses.total(), "file"), _counted(statuses)),
        "{}: {}".format(measurement.counted(methods.total(), "object"), _counted(methods)),
        *(
            line
            for title, section_rows in sections.items()
            if section_rows
            for line in ("", title, *section_rows)
        ),
    ]
    return (measurement.visible(line) + "\n" for line in lines), 0


def _share(entry: dict[str, Any]) -> float | None:
    """Return the bound of a record's volume, else of its area, relative to its size."""
    name = "volume" if entry.get("volume") else "area"
    bound = measurement.bound_of(entry, name)
    return bound / abs(entry[name]) if bound is not None and entry[name] else None


def _compare(options: argparse.Namespace) -> tuple[Iterable[str], int]:
    """Return the lines of a comparison of two results, and exit code 1 if they differ by more than
    allowed, else 0. Raises UsageError.
    """
    if len(options.paths) != 2:
        raise UsageError("“compare” takes two results")
    first, second = ([document for document, _ in _read([path])] for path in options.paths)
    lines, failed = compare.differences(first, second, options.tolerance, options.align)
    printed_lines = [] if options.quiet and not failed else lines
    return (
        measurement.visible(line) + "\n"
        for line in printed_lines
        if not (options.quiet and line.startswith("pass"))
    ), int(failed)


def _counted(counts: Counter[str]) -> str:
    return ", ".join("{} {}".format(count, name) for name, count in counts.most_common()) or "-"


_COMMANDS: dict[str, Callable[[argparse.Namespace], tuple[Iterable[str], int]]] = {
    "manifest": _manifest,
    "merge": _merge,
    "to-csv": lambda options: (measurement.to_csv(_documents(options)), 0),
    "summary": _summary,
    "compare": _compare,
    "report": lambda options: (measurement.to_html(_documents(options)), 0),
}
