# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands that prepare and gather the results of many files: `manifest`, `merge`, `to-csv`, `summary` and `report`.

Results are files of `measure` as json or jsonl, and journals. Standard library only. They are read again each time they
are needed, so that never all of them are in memory.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.measurement.documents import SCHEMA, to_csv, to_json_lines
from ...core.measurement.page import to_html
from ...core.measurement.plain_text import counted, print_message, visible
from ...core.robots.findings import RESULT_FOREIGN_FILE
from ...core.verdict.finding import MeasureError, QueryError, finding, system_reason
from ..files import output, own_results
from ..findings import COMPARE_TWO, RESULTS_MALFORMED, RESULTS_UNREADABLE
from ..options.option_types import positive
from ..parser import Parser
from ..supervisor import journal, listing
from . import compare

_LISTED = 10  # files in each part of a summary


@dataclass(frozen=True)
class Results:
    """The documents of some files of results, in order; of two about one file the later counts.

    Documents from a journal have `attempts` and `seconds` beside them.
    """

    paths: tuple[Path, ...]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (document for document, _ in self.entries())

    def entries(self) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        """Yield each document with its `attempts` and `seconds` from a journal. Raises QueryError."""
        last: dict[Any, int] = {}
        for number, (document, _) in enumerate(self._all()):
            last[document.get("file")] = number
        first = {file: number for number, file in enumerate(dict.fromkeys(last))}
        waiting: dict[int, tuple[dict[str, Any], dict[str, Any]]] = {}
        due = 0
        for number, (document, about) in enumerate(self._all()):
            file = document.get("file")
            if last[file] != number:
                continue
            waiting[first[file]] = (document, about)
            while due in waiting:
                yield waiting.pop(due)
                due += 1

    def _all(self) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
        for path in self.paths:
            try:
                yield from _documents(path)
            except OSError as error:
                raise QueryError(RESULTS_UNREADABLE, file=str(path), error=system_reason(error)) from error
            except (ValueError, KeyError, TypeError, RecursionError) as error:
                raise QueryError(RESULTS_MALFORMED, file=str(path)) from error


def _documents(path: Path) -> Iterator[tuple[dict[str, Any], dict[str, Any]]]:
    """Read the documents of one file: an object, an array, or one object a line.

    Raises ValueError, KeyError, TypeError and OSError.
    """
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        begin = file.read(2)
        file.seek(0)
        found: Iterable[Any]
        if begin[:1] == "[" or begin == "{\n":
            whole = json.load(file)
            found = whole if isinstance(whole, list) else [whole]
        else:
            found = (json.loads(line) for line in file if line.strip())
        for entry in found:
            about: dict[str, Any] = {}
            if entry["schema"] == journal.SCHEMA:
                about = {name: entry[name] for name in ("attempts", "seconds")}
                entry = entry["document"]
            if entry["schema"] != SCHEMA:
                raise ValueError(path)
            yield entry if "status" in entry else {**entry, "status": "error" if entry["errors"] else "ok"}, about


def run(argv: list[str], channel: int) -> int:
    """Do one of the commands, and return the exit code."""
    options = _parse(argv)
    try:
        pieces, failed = _COMMANDS[argv[0]](options)
        # The pieces are made while they are written.
        written = output.written(pieces, options.output, channel, _guard(options))
    except MeasureError as error:
        print_message(error)
        return 2
    return 1 if failed or not written else 0


def _guard(options: argparse.Namespace) -> Callable[[Path], None]:
    def check(path: Path) -> None:
        ours = own_results.is_empty(path) or own_results.replaceable(path, "output") or _is_made_here(path)
        if not ours and not options.force:
            raise FileExistsError(str(finding(RESULT_FOREIGN_FILE, path=str(path))))

    return check


def _is_made_here(path: Path) -> bool:
    with open(path, "rb") as file:
        head = file.read(200)
    return listing.SCHEMA.encode() in head or b"<!doctype html><!-- Body Moments" in head


def _parse(argv: list[str]) -> argparse.Namespace:
    """Return the options. Raises SystemExit(2), or HelpRequested."""
    command = argv[0]
    names = "FOLDER" if command == "manifest" else "RESULT"
    parser = Parser(
        prog="body_moments",
        usage="body_moments {} [options] {} [{} ...]".format(command, names, names),
        description=_DESCRIPTIONS[command],
        epilog="exit code: 0 done, 1 {}the result cannot be written, 2 wrong usage or no results".format(
            "numbers differ by more than they may, or " if command == "compare" else ""
        ),
        allow_abbrev=False,
    )
    parser.add_argument("command", metavar=command)
    parser.add_argument("paths", nargs="+", metavar=names)
    parser.add_argument("--output", type=Path, metavar="PATH", help="(standard output)")
    parser.add_argument("--force", action="store_true", help="replace any file at --output (only results)")
    if command == "compare":
        parser.add_argument("--tolerance", type=positive, default=0.0, help="relative to each number's own size (0)")
        parser.add_argument(
            "--align", action="store_true", help="compare in each body's own pose: it may have moved (needs --pose)"
        )
    return parser.parse_args(argv)


def _results(options: argparse.Namespace) -> Results:
    found = Results(tuple(map(Path, options.paths)))
    for _ in found:  # check that all can be read, before anything is written
        pass
    return found


def _manifest(options: argparse.Namespace) -> tuple[Iterable[str], bool]:
    folder = options.output.parent if options.output else Path()
    found = list(dict.fromkeys(listing.expand(options.paths)))
    return listing.write_lines(_as_seen_from(folder, path) for path in found), False


def _as_seen_from(folder: Path, path: str) -> str:
    """Return the name that means the file in a list in that folder."""
    if str(folder) in ("", "."):
        return path
    return str(Path(path).absolute())


def _summary(options: argparse.Namespace) -> tuple[Iterable[str], bool]:
    """Return counts by status and method, the slowest, the widest bounds, findings by code."""
    statuses: Counter[str] = Counter()
    methods: Counter[str] = Counter()
    codes: Counter[tuple[str, str]] = Counter()
    slowest: list[tuple[float, str]] = []
    widest: list[tuple[float, str]] = []
    failed: list[str] = []
    for document, about in _results(options).entries():
        file = document["file"] or "-"
        statuses[document["status"]] += 1
        if document["status"] != "ok" and len(failed) < _LISTED:
            failed.append("{}  {}: {}".format(document["status"], file, document["errors"][0]["reason"]))
        if "seconds" in about:
            slowest = sorted([*slowest, (float(about["seconds"]), str(file))], reverse=True)[:_LISTED]
        for entry in (*document["objects"], *document.get("flat", ())):
            methods[entry.get("method", "flat")] += 1
            codes.update({(one["severity"], one["code"]) for one in entry["findings"]})
            bound, size = _bound(entry), entry.get("volume") or entry["area"]
            if bound is not None and size:
                share = bound / abs(size), "{}: {}".format(file, entry["name"])
                widest = sorted([*widest, share], reverse=True)[:_LISTED]
    lines = ["{}: {}".format(counted(statuses.total(), "file"), _counted(statuses))]
    lines += ["{}: {}".format(counted(methods.total(), "object"), _counted(methods))]
    lines += ["", "Not measured:", *failed] if failed else []
    if codes:
        lines += ["", "Findings, by how many objects have them:"]
        lines += ["{:>8}  {:<8} {}".format(count, *one) for one, count in codes.most_common()]
    if slowest:
        lines += ["", "Slowest, in seconds:", *("{:>10.3f}  {}".format(*one) for one in slowest)]
    if widest:
        lines += ["", "Widest bounds of the volume or area, of its size:"]
        lines += ["{:>10.1e}  {}".format(*one) for one in widest]
    return (visible(line) + "\n" for line in lines), False


def _bound(entry: dict[str, Any]) -> float | None:
    """Return the error bound of the volume, else of the area: rounding plus input."""
    bounds = entry["error_bound"] or {}
    name = "volume" if entry.get("volume") else "area"
    known = [one for one in (bounds.get(name), (bounds.get("input") or {}).get(name)) if one is not None]
    return sum(known) if known else None


def _compare(options: argparse.Namespace) -> tuple[Iterable[str], bool]:
    if len(options.paths) != 2:
        raise QueryError(COMPARE_TWO)
    first, second = (Results((Path(path),)) for path in options.paths)
    lines, failed = compare.differences(first, second, options.tolerance, options.align)
    return (visible(line) + "\n" for line in lines), failed


def _counted(counts: Counter[str]) -> str:
    return ", ".join("{} {}".format(count, name) for name, count in counts.most_common()) or "-"


_COMMANDS: dict[str, Callable[[argparse.Namespace], tuple[Iterable[str], bool]]] = {
    "manifest": _manifest,
    "merge": lambda options: (to_json_lines(_results(options)), False),
    "to-csv": lambda options: (to_csv(_results(options)), False),
    "summary": _summary,
    "compare": _compare,
    "report": lambda options: (to_html(_results(options)), False),
}
_DESCRIPTIONS = {
    "manifest": "Lists the files in folders that can be measured, for `measure --manifest LIST --range A:B`.",
    "merge": "Joins results, of ranges of a list for example: one document a file, as JSON lines.",
    "to-csv": "Results as a table.",
    "summary": "What became of many files: counts by status and method, findings, the slowest, the widest bounds.",
    "compare": "Every number of two results, whose files and bodies have the same names: they pass where their bounds "
    "or the tolerance allow the difference.",
    "report": "Results as one HTML file that opens without a network: a table to sort and filter, and pictures.",
}
