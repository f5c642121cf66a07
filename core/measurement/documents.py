# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The JSON document of a file, and its formats: JSON, JSON lines and CSV.

A public contract, `body-moments/1`.

A document is the result of one file: one record for each object, their total, and the objects that
could not be measured. Nothing here needs numpy or Blender, so that a process that only gathers
results can write documents, too.
"""

from __future__ import annotations

import io
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from math import isfinite, sqrt
from typing import Any

from ..inertia import TENSOR

SCHEMA = "body-moments/1"
FRAMES = ("world", "object")
MAX_ORDER = 30  # 5456 moments; the core knows no limit, but beyond it double precision says little
STATUSES = ("ok", "error", "crashed", "timeout", "memory", "unsupported_version", "missing")

# Keys of a total's numbers, all null if nothing was measured.
TOTAL = (
    *("mass", "volume", "area", "center_of_mass"),
    *("inertia", "principal_moments", "principal_axes", "symmetry"),
)
# Content of the file of a Fourier transform.
SPECTRUM_ARRAYS = ("q", "F", "error", "input", "method", "frame")
# Additional arrays of a flat shape: its plane in the world.
FLAT_SPECTRUM_ARRAYS = (
    "axes",
    "origin",
)

# An innermost list of numbers that json.dumps has spread over lines. No text can hold a line break,
# so none matches. Patterns are compiled at their first use: registration reads the constants of
# this module alone.
_NUMBER_ROWS = r"\[\n\s+((?:[-+.\deE]+|null)(?:,\n\s+(?:[-+.\deE]+|null))*)\n\s*\]"

# Beginnings of formulas, as OWASP lists them, or an apostrophe of the text itself.
_FORMULA = r"['\t\r\n]|\s*[=+\-@\uff1d\uff0b\uff0d\uff20]"


def plain(value: Any) -> Any:
    """Return a value as JSON can hold it: arrays as lists, keys as text, and None for numbers that
    are not finite.
    """
    if hasattr(value, "tolist"):  # an array, or a number of one
        value = value.tolist()
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, float) and not isfinite(value):
        return None
    return value


def document(
    objects: Iterable[dict[str, Any]],
    total: dict[str, Any],
    errors: Iterable[dict[str, Any]],
    left_out: Iterable[dict[str, Any]] = (),
    *,
    file: str | None,
    blender: str | None,
    frame: str = "world",
    status: str | None = None,
    run: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """Return the document of one file, with the objects sorted by name.

    `file` is None for a scene that was never saved. errors, left_out: names and reasons of objects
    that could not be measured, or were excluded. status: one of `STATUSES`, by default according to
    the errors. run: the add-on's version and the given options, None outside of the command line.
    """
    errors = list(errors)
    if frame != "world":
        total = {"frame": "world"} | total
    return {
        "schema": SCHEMA,
        "blender": blender,
        **({} if run is None else {"run": run}),
        "file": file,
        "status": status or ("error" if errors else "ok"),
        "frame": frame,
        "objects": sorted(objects, key=lambda entry: entry["name"]),
        "total": total,
        "left_out": sorted(left_out, key=lambda entry: entry["name"]),
        "errors": errors,
    }


def failed_document(file: str, reason: str, status: str, **values: Any) -> dict[str, Any]:
    """Return the document of a file that was not measured; values: of `document`, such as `blender`
    and `frame`.
    """
    return document(
        objects=[],
        total=dict.fromkeys(TOTAL) | {"findings": [], "warnings": [], "notes": []},
        errors=[{"name": None, "reason": reason}],
        file=file,
        status=status,
        **values,
    )


def radius_of_gyration(record: dict[str, Any]) -> float | None:
    """Return the radius of gyration of a body's record in m, or None without a positive mass and
    known moments.
    """
    mass = record["mass"]
    moments = record["principal_moments"]
    if not mass or not moments or None in moments:
        return None
    square = sum(moments) / (2.0 * mass)
    return sqrt(square) if square >= 0.0 else None


def bound_of(record: dict[str, Any], name: str) -> float | None:
    """Return the error bound of a record's number, rounding plus input, or None if neither is
    known.
    """
    rounding = record["error_bound"] or {}
    inputs = rounding.get("input") or {}
    known = [bounds[name] for bounds in (rounding, inputs) if bounds.get(name) is not None]
    return sum(known) if known else None


def count_findings(document: dict[str, Any]) -> Counter[tuple[str, str]]:
    """Return the counts of the records with a finding, and of the total, by severity and code."""
    counts: Counter[tuple[str, str]] = Counter()
    for record in (*document["objects"], *document.get("flat", ()), document.get("total", {})):
        findings = record.get("findings", ())
        counts.update({(finding["severity"], finding["code"]) for finding in findings})
    return counts


def to_json(documents: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield the text of one document, or of an array of several, indented, with each row of numbers
    on one line.
    """
    # Each text waits until the next one comes: a single document has no brackets, the last no
    # comma.
    waiting = ""
    count = 0
    for entry in documents:
        if count:
            yield ("[\n" if count == 1 else "") + _indented(waiting) + ",\n"
        text = json.dumps(entry, indent=2, ensure_ascii=False, allow_nan=False)
        waiting = re.sub(
            _NUMBER_ROWS, lambda match: "[" + re.sub(r"\s+", " ", match[1]) + "]", text
        )
        count += 1
    if not count:
        yield "[]\n"
    else:
        yield _indented(waiting) + "\n]\n" if count > 1 else waiting + "\n"


def _indented(text: str) -> str:
    """Return the text with every line indented as an entry of an array."""
    return "  " + text.replace("\n", "\n  ")


def to_json_lines(documents: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield each document as one line of JSON."""
    for entry in documents:
        yield json.dumps(entry, ensure_ascii=False, allow_nan=False) + "\n"


def to_csv(documents: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield a header and one row for each object; `documents` is iterated twice.

    Unmeasured objects have a row too, with the reason under `error`, and so do excluded ones, with
    the reason under `left_out`.

    Spreadsheets take text that begins with =, +, -, @ and the like for a formula. Such text gets an
    apostrophe before it, and so does text that begins with one: a reader removes one apostrophe
    from the start of a text.
    """
    names = dict.fromkeys(_COLUMNS)
    for row in _csv_rows(documents):
        names.update(dict.fromkeys(name for name in row if name not in _LAST_COLUMNS))
    yield from table([*names, *_LAST_COLUMNS], _csv_rows(documents))


def table(header: Sequence[str], rows: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Yield CSV with these columns, a row for each mapping, escaped as in `to_csv`; missing entries
    stay empty.
    """
    yield _line(header)
    for row in rows:
        yield _line(_cell(row.get(name, "")) for name in header)


def _csv_rows(documents: Iterable[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """Yield a dict of column names and values for each body, flat shape, and unmeasured object."""
    for file_document in documents:
        place = {"file": file_document["file"], "frame": file_document["frame"]}
        for name in ("objects", "assemblies", "bones"):
            for entry in file_document.get(name, ()):
                yield (place | _columns(entry))
        for entry in file_document.get("flat", ()):
            yield (place | _flat_columns(entry))
        for column, entries in (
            ("left_out", file_document["left_out"]),
            ("error", file_document["errors"]),
        ):
            for entry in entries:
                yield (place | {"name": entry["name"], column: entry["reason"]})


_COLUMNS = (
    *("file", "frame", "name", "type", "kind", "verdict", "method"),
    *("density", "mass", "volume", "area"),
    *(f"center_of_mass_{axis}" for axis in "xyz"),
    *(f"inertia_{name}" for name, *_ in TENSOR),
    *(f"principal_moment_{number}" for number in (1, 2, 3)),
    *(f"principal_axis_{number}_{axis}" for number in (1, 2, 3) for axis in "xyz"),
    "symmetry",
)
_OPTIONAL_COLUMNS = (
    "armature",
    "density_from",
    "thickness",
    "length",
    "linear_density",
    "principal_axes_unique",
)
# All other columns, such as notes and findings, come before these.
_LAST_COLUMNS = (
    "warnings",
    "error",
)


def _flat_columns(entry: dict[str, Any]) -> dict[str, Any]:
    """Return the record of a flat shape as a row: a dict of column names and values."""
    row = {name: entry[name] for name in ("name", "type", "area")} | {"kind": "flat"}
    row |= _nested("error_bound", entry["error_bound"])
    row |= {f"center_of_mass_{axis}": value for axis, value in zip("xyz", entry["centroid"])}
    powers = entry.get("moments", {}).get("area", {})
    row |= {f"area_moment_{key.replace(',', '_')}": value for key, value in powers.items()}
    return row | _shared_columns(entry)


def _columns(entry: dict[str, Any]) -> dict[str, Any]:
    """Return an object's record as a row: a dict with a column for each entry of its lists and
    tables.
    """
    row = {name: entry[name] for name in (*_COLUMNS, *_OPTIONAL_COLUMNS) if name in entry}
    row |= {f"center_of_mass_{axis}": value for axis, value in zip("xyz", entry["center_of_mass"])}
    row |= {f"inertia_{name}": entry["inertia"][i][j] for name, i, j in TENSOR}
    for number in range(3):
        row[f"principal_moment_{number + 1}"] = entry["principal_moments"][number]
        row |= {
            f"principal_axis_{number + 1}_{axis}": entry["principal_axes"][i][number]
            for i, axis in enumerate("xyz")
        }
    for name in ("label", "print", "display_mesh"):
        row |= _nested(name, entry.get(name, {}))
    # Tables and matrices have no columns.
    below = dict(entry.get("below") or {})
    below["contents"] = dict(below.get("contents") or {})
    below["contents"].pop("table", None)
    row |= _nested("below", below) | _nested("cut_fill", entry.get("cut_fill") or {})
    floating = dict(entry.get("floating") or {})
    curve = floating.pop("gz", {})
    for name in ("matrix", "rests"):
        floating.pop(name, None)
    row |= _nested("floating", floating) | {f"gz_{name}": value for name, value in curve.items()}
    row |= _nested("health", entry["health"]) | _nested("error_bound", entry["error_bound"] or {})
    for name in ("volume", "length", "surface", "mass"):
        powers = entry.get("moments", {}).get(name, {})
        row |= {f"{name}_moment_{key.replace(',', '_')}": value for key, value in powers.items()}
    if entry.get("pose"):
        row |= {
            f"pose_{name}": entry["pose"].get(name)
            for name in ("unique", "symmetry", "symmetry_order")
        }
        row |= {
            f"pose_matrix_{i + 1}{j + 1}": value
            for i, line in enumerate(entry["pose"]["matrix"])
            for j, value in enumerate(line)
        }
    return row | _shared_columns(entry)


def _shared_columns(entry: dict[str, Any]) -> dict[str, Any]:
    """Return the columns that bodies and flat shapes share: signature, findings and remarks."""
    codes = {"findings": [finding["code"] for finding in entry["findings"]]}
    return (
        _nested("signature", entry.get("signature") or {})
        | codes
        | {k: entry[k] for k in ("notes", "warnings")}
    )


def _nested(prefix: str, values: dict[Any, Any]) -> dict[str, Any]:
    """Return a column for each number or text in nested dicts and lists, which count from 1; the
    names of the levels are joined by underscores.
    """
    row = {}
    for name, value in values.items():
        if isinstance(value, list):
            value = dict(enumerate(value, 1))
        row |= (
            _nested(f"{prefix}_{name}", value)
            if isinstance(value, dict)
            else {f"{prefix}_{name}": value}
        )
    return row


def _line(cells: Iterable[Any]) -> str:
    """Return a line of CSV. Before Python 3.13 the csv module quotes only line breaks that it ends
    a row with.
    """
    import csv  # Registration reads the constants of this module alone.

    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerow(cells)
    return text.getvalue().removesuffix("\r\n") + "\n"


def _cell(value: Any) -> Any:
    """Return a value as a cell of CSV; texts that a spreadsheet takes for formulas are escaped."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        value = " | ".join(map(str, value))
    if isinstance(value, str) and re.match(_FORMULA, value):
        return "'" + value
    return value


# Functions from documents, which may be iterated twice, to pieces of text.
FORMATS = {"json": to_json, "jsonl": to_json_lines, "csv": to_csv}
