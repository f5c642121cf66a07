# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognition of label maps, whose numbers name regions and measure nothing; names, colors and
densities of labels, from headers and tables.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..files import LINE_MISREAD, MAX_TEXT, Limits, check_regular, parse_number, parse_whole
from ..verdict import FileError

MOST_LABELS = 256  # different numbers; scans of 8 bits may have as many, but change everywhere
MAX_CHANGING = 0.5  # share of neighbors that differ, of those that are not both background

# Rows of tables in text files, by ITK-SNAP and by FreeSurfer.
_ITK_SNAP = re.compile(
    r'(?P<label>\d+)(?P<color>(?:\s+\d+){3})\s+[\d.]+\s+[01]\s+[01]\s+"(?P<name>.*)"'
)
_FREESURFER = re.compile(r"(?P<label>\d+)\s+(?P<name>\S.*?)(?P<color>(?:\s+\d+){3})\s+\d+(\s.*)?")
# Names of the columns of tables in .csv files; the first that a table has counts.
_COLUMNS = {
    "label": ("labelvalue", "value", "index", "id", "no", "number", "label"),
    "name": ("name", "labelname", "structure", "segment", "label"),
    "density": ("density", "densitykgm3"),
    "red": ("r", "red", "colorr"),
    "green": ("g", "green", "colorg"),
    "blue": ("b", "blue", "colorb"),
}
_TABLE = "a label and its name, as ITK-SNAP, FreeSurfer or the columns label, name, density have it"


class Label(NamedTuple):
    """What a header or a table tells of a label: name, color (from 0 to 1), density in kg/m³."""

    name: str = ""
    color: tuple[float, ...] | None = None
    density: float | None = None


def read_label_table(path: Path, limits: Limits) -> dict[int, Label]:
    """Return the labels of a table: a .csv file with named columns, or a text file as ITK-SNAP and
    FreeSurfer write it.

    Raises FileError and OSError.
    """
    check_regular(path)
    limits.check(path, "text_bytes", path.stat().st_size)
    lines = path.read_bytes().decode("utf-8-sig", "replace").splitlines()
    numbered_lines = [
        (number, line.strip())
        for number, line in enumerate(lines, 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    parse_row = _text_row
    if path.suffix.lower() == ".csv" and numbered_lines:
        columns, delimiter = _columns(*numbered_lines.pop(0))
        parse_row = partial(_csv_row, columns=columns, delimiter=delimiter)
    labels = {}
    for number, line in numbered_lines:
        try:
            label, entry = parse_row(line)
        except (ValueError, IndexError, csv.Error) as error:
            raise _misread(number, line) from error
        if label in labels:
            raise _misread(number, line, "a label that no line before it has")
        labels[label] = entry
    if not labels:
        raise _misread(1, "")
    return labels


def _misread(number: int, line: str, expected: str = _TABLE) -> FileError:
    """Return the refusal of a line. number: from 1."""
    return FileError(LINE_MISREAD, line=number, text=line[:MAX_TEXT], expected=expected)


def _columns(number: int, line: str) -> tuple[dict[str, int], str]:
    """Return the places of the columns that a .csv file's first line names, by the keys of
    `_COLUMNS`, and its delimiter. number: of the line, from 1.
    """
    delimiter = max(",;\t", key=line.count)
    try:
        words = _split(line, delimiter)
    except csv.Error as error:
        raise _misread(number, line) from error
    names = [re.sub(r"[^a-z0-9]", "", word.lower().replace("³", "3")) for word in words]
    places: dict[str, int] = {}
    for column, known_names in _COLUMNS.items():
        matches = [names.index(name) for name in known_names if name in names]
        # “label” may be the name of a label whose number has a column of its own.
        free = [place for place in matches if place not in places.values()]
        if free:
            places[column] = free[0]
    if "label" not in places or not places.keys() & {"name", "density"}:
        raise _misread(number, line)
    return places, delimiter


def _split(line: str, delimiter: str) -> list[str]:
    """Return the words of a line of a .csv file."""
    return [word.strip() for word in next(csv.reader([line], delimiter=delimiter))]


def _csv_row(line: str, columns: Mapping[str, int], delimiter: str) -> tuple[int, Label]:
    """Return a label and its entry, from a row of a .csv file. columns: the place of each column
    that the file has. Raises ValueError, IndexError and csv.Error.
    """
    words = _split(line, delimiter)
    texts = {column: words[place] for column, place in columns.items()}
    colors = [texts[name] for name in ("red", "green", "blue") if texts.get(name)]
    text = texts.get("density")
    density = parse_number(text) if text else None
    if density is not None and not 0.0 < density < np.inf:
        raise ValueError(text)
    color = read_color(map(parse_number, colors)) if len(colors) == 3 else None
    return parse_whole(texts["label"]), Label(texts.get("name", ""), color, density)


def _text_row(line: str) -> tuple[int, Label]:
    """Return a label and its entry, from a row of a text file. Raises ValueError."""
    for pattern in (_ITK_SNAP, _FREESURFER):
        if row := pattern.fullmatch(line):
            color = read_color(map(float, row["color"].split()))
            return int(row["label"]), Label(row["name"], color)
    label, name = line.split(None, 1)
    return parse_whole(label), Label(name.strip('"'))


def read_color(values: Iterable[float]) -> tuple[float, ...]:
    """Return a color from 0 to 1. If a value is greater than 1, all are taken as 0 to 255.

    Raises ValueError.
    """
    channels = [*values]
    if not np.isfinite(channels).all():
        raise ValueError("a color is not finite")
    unit = 255.0 if max(channels) > 1.0 else 1.0
    return tuple(channel / unit for channel in channels)


def segment_labels(fields: Mapping[str, str]) -> dict[int, Label]:
    """Return the labels of the segments that the keys of an NRRD header describe."""
    labels = {}
    for key, text in fields.items():
        if segment := re.fullmatch(r"=(Segment\d+_)LabelValue", key):
            name = fields.get("={}Name".format(segment[1]), "")
            color = None
            # Names and colors are remarks, without effect on sums: unreadable ones are left out.
            with suppress(ValueError):
                r, g, b = map(parse_number, fields.get("={}Color".format(segment[1]), "").split())
                color = read_color((r, g, b))
            with suppress(ValueError):
                labels[parse_whole(text)] = Label(name, color)
    return labels


def count_labels(values: NDArray) -> int:
    """Return the count of different numbers in a (nx, ny, nz) grid that looks like labels, else 0.

    Labels are three or more whole numbers in regions, so that few neighbors along y differ. The
    background has the first sample's number.
    """
    labels = np.zeros(0)
    background = values[0, 0, 0]
    neighbors = changes = 0
    for slab in values:
        numbers = np.unique(slab)
        labels = np.union1d(labels, numbers)
        if len(labels) > MOST_LABELS or not (numbers == np.rint(numbers)).all():
            return 0
        before = slab[:, :-1]
        after = slab[:, 1:]
        neighbors += np.count_nonzero((before != background) | (after != background))
        changes += np.count_nonzero(before != after)
    return len(labels) if len(labels) > 2 and changes <= MAX_CHANGING * neighbors else 0
