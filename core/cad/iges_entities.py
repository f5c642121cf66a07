# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entities of IGES files in fixed ASCII form, their parameters as numbers, and their places by
transformations (124).

Initial Graphics Exchange Specification 5.3, sections 2.2.1 to 2.2.4. Pointers and counts of a file
are not trusted, but compared with its length.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..files import FILE_UNREADABLE, FILE_UNRECOGNIZED, HEADER_FIELD
from ..numerics import Array
from ..verdict import FileError
from .findings import IGES_DAMAGED
from .iges_types import MATRIX
from .surfaces import RECURSION, refuse

FORMAT = "IGES (fixed ASCII form)"
COLUMNS = 80  # characters of a line
SECTION = 72  # Column of the letter that names a line's section.
PARAMETERS = 64  # columns that parameters may take
UNITS = {
    1: 0.0254,
    2: 1e-3,
    4: 0.3048,
    5: 1609.344,
    6: 1.0,
    7: 1e3,
    8: 2.54e-5,
    9: 1e-6,
    10: 1e-2,
    11: 2.54e-8,
}
UNIT_NAMES = {
    "IN": 0.0254,
    "INCH": 0.0254,
    "MM": 1e-3,
    "FT": 0.3048,
    "MI": 1609.344,
    "M": 1.0,
    "KM": 1e3,
    "MIL": 2.54e-5,
    "UM": 1e-6,
    "CM": 1e-2,
    "UIN": 2.54e-8,
}
UNIT_BY_NAME = 3
FEW = 8  # So few numbers may all end in zeros.
MANY_DIGITS = 8  # Numbers with fewer significant digits are taken as exact.
TURNING = 3.0  # the norm of a matrix (3, 3) of ones
MAX_DEPTH = 50  # nesting of subfigures, transformations and curves
_DECIMALS = re.compile(r"([0-9]*)\.([0-9]*)(?:[EDed]([+-]?[0-9]+))?")
_NUMBERS = re.compile(r"[0-9+\-.eEdD \n]*")
_STRING = re.compile(r"\s*(\d{1,9})H")


@dataclass(frozen=True)
class Entry:
    """An entity in the directory.

    number: number of its first line, which pointers hold. parameters: first line and count of
    lines. matrix: pointer to a transformation, or 0. hidden, dependent: flags of its status number.
    """

    number: int
    type: int
    parameters: tuple[int, int]
    matrix: int
    hidden: bool
    dependent: bool
    label: str


class IgesText:
    """An IGES file. unit: m per unit. entries: entities by number.

    FileError if it is damaged, or no IGES file.
    """

    def __init__(self, data: bytes) -> None:
        sections: dict[str, list[str]] = {letter: [] for letter in "SGDPT"}
        for line in _lines(data.decode("latin-1")):
            letter = line[SECTION : SECTION + 1]
            if letter in ("B", "C") and not sections["S"]:
                raise FileError(
                    FILE_UNREADABLE, error="it is binary or compressed. Save it in fixed ASCII form"
                )
            if letter not in sections:
                raise FileError(FILE_UNRECOGNIZED, format=FORMAT)
            sections[letter].append(line)
        if not (sections["G"] and sections["D"] and sections["P"]):
            raise FileError(FILE_UNRECOGNIZED, format=FORMAT)
        self._lines = sections["P"]
        text = "".join(line[:SECTION] for line in sections["G"])
        try:
            self._delimiter, self._end, fields = _global_fields(text)
            self.unit = _unit(fields)
        except ValueError:
            raise FileError(IGES_DAMAGED, section="global section", text=text[:COLUMNS]) from None
        self.entries = _directory(sections["D"])

    def entry(self, pointer: int, kind: int) -> Entry:
        """Return the entity of a type that a pointer refers to.

        KeyError if there is none, ValueError if it is of another type.
        """
        entry = self.entries[pointer]
        if entry.type != kind:
            raise ValueError("another entity")
        return entry

    def fields(self, entry: Entry) -> list[str]:
        """Return an entity's parameters without its type.

        ValueError if they are cut short or of another entity.
        """
        first, count = entry.parameters
        start = first - 1
        end = start + count
        if not 0 <= start < end <= len(self._lines):
            raise ValueError("parameters beyond the section")
        text = "".join(line[:PARAMETERS] for line in self._lines[start:end])
        fields = _split(text, self._delimiter, self._end)
        if _integer(fields[0]) != entry.type:
            raise ValueError("parameters of another entity")
        return fields[1:]

    def rounding(self, fields: list[str]) -> float:
        """Return half a unit of the last digit in the largest of those numbers with many digits, 0
        if there are none.

        The longest number shows how many digits are written, because zeros at the end are often
        left out: the longest of the file if there are few.
        """
        fixed, scientific = _long_numbers("\n".join(fields))
        longest_fixed, longest_scientific = self._longest
        return max(
            _half_unit(fixed, longest_fixed, is_fixed=True),
            _half_unit(scientific, longest_scientific, is_fixed=False),
        )

    @cached_property
    def _longest(self) -> list[Array]:
        """The most decimals, digits and value of the file's long numbers, without and with an
        exponent.
        """
        by_form = _long_numbers("\n".join(line[:PARAMETERS] for line in self._lines))
        return [np.max([(0, 0, 0.0), *long_numbers], axis=0) for long_numbers in by_form]


def _lines(text: str) -> list[str]:
    """Return the lines of a text: split at line breaks, else after every 80 columns; blank lines
    are left out.
    """
    # Not splitlines: of Latin-1 it also cuts at \x85, which is half of an “Å” in UTF-8.
    cut = [text[start : start + COLUMNS] for start in range(0, len(text), COLUMNS)]
    lines = re.split(r"\r\n|\r|\n", text) if re.match(r"[^\r\n]{0,80}[\r\n]", text) else cut
    return [line for line in lines if line.strip("\0 \x1a")]


def _global_fields(text: str) -> tuple[str, str, list[str]]:
    """Return the delimiter of parameters, the end mark, and the parameters from the third on.

    ValueError if damaged.
    """
    # Each mark is a string of one character, such as “1H,”; a comma and a semicolon if left out.
    delimiter, rest = (text[2:3], text[3:]) if text.startswith("1H") else (",", text)
    if not rest.startswith(delimiter):
        raise ValueError("no delimiter")
    rest = rest[1:]
    end, rest = (rest[2:3], rest[3:]) if rest.startswith("1H") else (";", rest)
    if not rest.startswith((delimiter, end)) or delimiter == end:
        raise ValueError("no end mark")
    return delimiter, end, _split(rest[1:], delimiter, end)


def _unit(fields: list[str]) -> float:
    """Return the meters per unit of the model.

    FileError if the unit is unknown, ValueError if a field is wrong.
    """
    # The parameters 13 to 15 of the section, whose first two are the marks.
    scale_word, flag_word, name = padded(fields[10:], 3)
    scale = float(numbers([scale_word])[0]) or 1.0
    flag = _integer(flag_word) or 1
    unit = UNIT_NAMES.get(name.strip().upper()) if flag == UNIT_BY_NAME else UNITS.get(flag)
    if unit is None:
        raise FileError(
            HEADER_FIELD,
            format="IGES",
            field="unit",
            wanted="that of a known length",
            text=name.strip() or str(flag),
        )
    if not 0.0 < unit / scale < math.inf:
        raise ValueError("scale")
    return unit / scale


def _directory(lines: list[str]) -> dict[int, Entry]:
    """Return the entities by number."""
    entries = {}
    for number in range(1, len(lines) + 1, 2):
        try:
            # An entity has two lines of nine words.
            words = [
                line[start : start + 8]
                for line in (lines[number - 1], lines[number])
                for start in range(0, SECTION, 8)
            ]
            status = "{:0>8}".format(words[8].strip())
            entries[number] = Entry(
                number=number,
                type=_integer(words[0]),
                parameters=(_integer(words[1]), _integer(words[12])),
                matrix=_integer(words[6]),
                hidden=status[:2] == "01",
                dependent=status[2:4] in ("01", "03"),
                label=words[16].strip(),
            )
        except (ValueError, IndexError):
            text = "".join(lines[number - 1 : number + 1])
            raise FileError(IGES_DAMAGED, section="directory", text=text[: 2 * COLUMNS]) from None
    return entries


def _split(text: str, delimiter: str, end: str) -> list[str]:
    """Return the fields of a record, strings without their lengths.

    ValueError if it has no end mark.
    """
    if "H" not in text:
        record, mark, _ = text.partition(end)
        if not mark:
            raise ValueError("no end")
        return record.split(delimiter)
    fields = []
    begin = 0
    stop = re.compile("[{}]".format(re.escape(delimiter + end)))
    while True:
        # A string may contain the marks, so its length tells where it ends.
        string = _STRING.match(text, begin)
        string_end = string.end() + int(string[1]) if string else begin
        mark = stop.search(text, string_end)
        if mark is None:
            raise ValueError("no end")
        fields.append(text[string.end() : string_end] if string else text[begin : mark.start()])
        if mark[0] == end:
            return fields
        begin = mark.end()


def _integer(word: str) -> int:
    """Return the whole number in a field, 0 if it is blank. ValueError if it is no whole number."""
    word = word.strip()
    if not re.fullmatch(r"[+-]?[0-9]*", word):
        raise ValueError("not a whole number")
    return int(word or 0)


def integers(fields: list[str], count: int) -> list[int]:
    """Return the first `count` fields as whole numbers.

    ValueError if there are fewer, or one is no whole number.
    """
    if not 0 <= count <= len(fields):
        raise ValueError("too few parameters")
    return [_integer(word) for word in fields[:count]]


def padded(fields: list[str], count: int) -> list[str]:
    """Return the first `count` fields, with blank fields for missing ones."""
    return fields[:count] + [""] * (count - len(fields))


def _long_numbers(text: str) -> tuple[list[tuple[int, int, float]], ...]:
    """Return the decimals, digits and values of the numbers with many digits: first of those
    without, then of those with an exponent.
    """
    by_form: tuple[list[tuple[int, int, float]], ...] = ([], [])
    for whole, decimals, power in _DECIMALS.findall(text):
        digits = (whole + decimals).lstrip("0")
        if len(digits.rstrip("0")) >= MANY_DIGITS:
            value = float("{}.{}e{}".format(whole, decimals, power or "0"))
            by_form[bool(power)].append((len(decimals), len(digits), value))
    return by_form


def _half_unit(
    long_numbers: list[tuple[int, int, float]], longest_of_file: Array, is_fixed: bool
) -> float:
    """Return half a unit of the last digit in the largest of some `_long_numbers` of one form, 0 if
    there are none. is_fixed: they have no exponent, so the count of decimals limits the digits.
    """
    if not long_numbers:
        return 0.0
    is_many = len(long_numbers) >= FEW
    decimals, digits, _ = np.max(long_numbers, axis=0) if is_many else longest_of_file
    largest = max(value for _, _, value in long_numbers)
    # The power of ten of the last of so many significant digits of the largest number.
    power = math.floor(math.log10(largest)) - digits + 1.0
    return 0.5 * 10.0 ** (max(power, -decimals) if is_fixed else power)


def numbers(fields: list[str]) -> Array:
    """Return the real numbers of fields, with Fortran's exponents, 0 for blank ones.

    ValueError if one is no number.
    """
    text = "\n".join(fields)
    if not _NUMBERS.fullmatch(text):
        raise ValueError("not a number")
    words = [word.strip() or "0" for word in text.replace("D", "E").replace("d", "e").split("\n")]
    values = np.array(words, dtype=np.float64)
    if not np.isfinite(values).all():
        raise ValueError("not finite")
    return values


class Places:
    """The places of a file's entities.

    rounding: largest effect of the decimals on a point so far. turning: largest effect of the
    decimals of directions so far, on points at a unit's distance.
    """

    def __init__(self, text: IgesText) -> None:
        self._text = text
        # (4, 4) matrices by the number of their entity, with the effect of their directions
        self._matrices: dict[int, tuple[Array, float]] = {0: (np.eye(4), 0.0)}
        self.rounding = 0.0
        self.turning = 0.0

    def note_rounding(self, rounding: float) -> None:
        """Note an effect of the decimals on a point."""
        self.rounding = max(self.rounding, rounding)

    def matrix(self, entry: Entry) -> Array:
        """Return the (4, 4) matrix of a part of the structure, and note its decimals."""
        matrix, turning = self.matrix_and_turning(entry)
        self.turning = max(self.turning, turning)
        return matrix

    def matrix_and_turning(self, entry: Entry) -> tuple[Array, float]:
        """Return the (4, 4) matrix of an entity: its transformation, followed by the ones that this
        refers to; and how far its decimals move points at a unit's distance.
        """
        chain = []
        pointer = entry.matrix
        while pointer not in self._matrices and len(chain) < MAX_DEPTH:
            chain.append(self._text.entry(pointer, MATRIX))
            pointer = chain[-1].matrix
        if pointer not in self._matrices:
            raise refuse(RECURSION)
        matrix, turning = self._matrices[pointer]
        for transformation in reversed(chain):
            fields = self._text.fields(transformation)[:12]
            # Each row has three numbers of directions and one of the place.
            self.note_rounding(self._text.rounding(fields[3::4]))
            directions = [word for k, word in enumerate(fields) if k % 4 < 3]
            turning += TURNING * self._text.rounding(directions)
            inner = np.eye(4)
            inner[:3] = numbers(fields).reshape(3, 4)
            matrix = matrix @ inner
            self._matrices[transformation.number] = matrix, turning
        if not abs(np.linalg.det(matrix[:3, :3])) > 0.0:
            raise refuse("a transformation that flattens")
        return matrix, turning
