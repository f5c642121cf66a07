# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entities of IGES files in fixed ASCII form: their parameters as numbers, and curves as B-spline
curves.

Initial Graphics Exchange Specification 5.3, sections 2.2.1 to 2.2.4. Pointers and counts of a file
are not trusted, but compared with its length. Lines (110), arcs (100), conics (104), B-splines
(126) and chains of them (102) bound faces, in space or in the parameters of a surface, whose third
coordinate is zero.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..files import FILE_UNREADABLE, FILE_UNRECOGNIZED, HEADER_FIELD
from ..numerics import Array, NDArray, SplineSpace, clamped_space, lengths
from ..nurbs import Curve, bezier_curves
from ..verdict import FileError
from .findings import IGES_DAMAGED

FORMAT = "IGES (fixed ASCII form)"
COLUMNS = 80  # columns
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
FEW = 8  # numbers that may all end in zeros
MANY_DIGITS = 8  # Numbers with fewer significant digits are taken as exact.
ARC = 100
CONIC = 104
CHAIN = 102
LINE = 110
SPLINE = 126
MAX_DEPTH = 50  # nesting of subfigures, transformations and curves
MAX_PIECES = 10_000  # pieces of the boundary of a surface
# radians; a quadratic piece of a circle keeps its weights away from zero
MAX_ARC = 2.0 * math.pi / 3.0
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
        lines = _lines(data.decode("latin-1"))
        sections: dict[str, list[str]] = {letter: [] for letter in "SGDPT"}
        for line in lines:
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

    def fields(self, entry: Entry) -> list[str]:
        """Return an entity's parameters without its type.

        ValueError if they are cut short or of another entity.
        """
        first, count = entry.parameters
        start = first - 1
        end = first - 1 + count
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
        units = [0.0]
        kinds = zip((True, False), _long_numbers("\n".join(fields)), self._written)
        for is_fixed, found, written in kinds:
            if found:
                places, digits, _ = np.max(found, axis=0) if len(found) >= FEW else written
                largest = max(value for *_, value in found)
                last = math.floor(math.log10(largest)) - digits + 1.0
                units.append(0.5 * 10.0 ** max(last, -places if is_fixed else last))
        return max(units)

    @cached_property
    def _written(self) -> list[Array]:
        """The most decimals and digits of the file's long numbers, without and with an exponent."""
        found = _long_numbers("\n".join(line[:PARAMETERS] for line in self._lines))
        return [np.max([(0, 0, 0.0), *kind], axis=0) for kind in found]


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
    entries = {}
    for number in range(1, len(lines) + 1, 2):
        try:
            words = [
                lines[number - 1 + row][start : start + 8]
                for row in (0, 1)
                for start in range(0, SECTION, 8)
            ]
            status = "{:0>8}".format(words[8].strip())
            entries[number] = Entry(
                number,
                _integer(words[0]),
                (_integer(words[1]), _integer(words[12])),
                _integer(words[6]),
                status[:2] == "01",
                status[2:4] in ("01", "03"),
                words[16].strip(),
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
        record, found, _ = text.partition(end)
        if not found:
            raise ValueError("no end")
        return record.split(delimiter)
    fields = []
    at = 0
    stop = re.compile("[{}]".format(re.escape(delimiter + end)))
    while True:
        start = _STRING.match(text, at)
        begin = start.end() if start else at
        at = begin + int(start[1]) if start else at
        ending = stop.search(text, at)
        if ending is None:
            raise ValueError("no end")
        fields.append(text[begin:at] if start else text[at : ending.start()])
        if ending[0] == end:
            return fields
        at = ending.end()


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
    """Return the decimals, digits and values of the numbers with many digits, those without and
    with an exponent.
    """
    found: tuple[list[tuple[int, int, float]], ...] = ([], [])
    for whole, decimals, power in _DECIMALS.findall(text):
        digits = (whole + decimals).lstrip("0")
        if len(digits.rstrip("0")) >= MANY_DIGITS:
            value = float("{}.{}e{}".format(whole, decimals, power or "0"))
            found[bool(power)].append((len(decimals), len(digits), value))
    return found


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


class CurveReader:
    """A reader of the curves of a file. matrix_of: returns the (4, 4) matrix of an entity, and the
    decimals' effect on its directions.
    """

    def __init__(self, text: IgesText, matrix_of: Callable[[Entry], tuple[Array, float]]) -> None:
        self._text, self._matrix_of = text, matrix_of
        self._entries: Mapping[int, Entry] = text.entries
        self.rounding = 0.0  # Largest effect of the decimals of points of curves in space.

    def read(
        self,
        pointer: int,
        matrix: NDArray | None,
        depth: int = 0,
        left: Iterator[int] | None = None,
    ) -> list[Curve] | None:
        """Return a curve as Bézier splines end to end; None if a part is of another kind, too deep,
        or has weights ≤ 0.

        matrix: (4, 4), of the entities around the curve; None in the parameters of a surface, where
        nothing is moved. depth, left: chains around it, and an item for each further piece that is
        allowed. ValueError if it is damaged.
        """
        left = iter(range(MAX_PIECES)) if left is None else left
        entry = self._entries.get(pointer)
        if (
            entry is None
            or depth >= MAX_DEPTH
            or next(left, None) is None
            or matrix is None
            and entry.matrix
        ):
            return None
        turning = 0.0
        if matrix is not None:
            own, turning = self._matrix_of(entry)
            matrix = matrix @ own
        fields = self._text.fields(entry)
        if entry.type == CHAIN:
            (count,) = integers(fields, 1)
            pieces = []
            for member in integers(fields[1:], count):
                part = self.read(member, matrix, depth + 1, left)
                if part is None:
                    return None
                pieces += part
            return pieces
        made = _MAKERS[entry.type](fields) if entry.type in _MAKERS else None
        if matrix is not None:
            # The numbers of a spline behind its knots and weights, or the whole of a simple curve.
            first = 6 + 2 * len(fields[6:]) // 5 if entry.type == SPLINE else 0
            moved = self._text.rounding(fields[first:])
            if made and entry.type == CONIC:
                moved = self._text.rounding(fields[6:]) + self._conic_rounding(fields, made)
            if made:
                moved += turning * max(float(lengths(one.points).max()) for one in made)
            self.rounding = max(self.rounding, float(np.linalg.norm(matrix[:3, :3], 2)) * moved)
        return (
            made if made is None or matrix is None else [curve.transform(matrix) for curve in made]
        )

    def _conic_rounding(self, fields: list[str], pieces: Sequence[Curve]) -> float:
        """Return the effect of the decimals of a conic's coefficients on its points."""
        a, b, c, d, e, _ = numbers(fields[:6])
        x, y, _ = np.concatenate([one.points[[0, -1]] for one in pieces]).T
        rows = np.abs([x * x, x * y, y * y, x, y, np.ones_like(x)])
        moved = np.array([self._text.rounding([field]) for field in fields[:6]]) @ rows
        slope = np.hypot(2.0 * a * x + b * y + d, b * x + 2.0 * c * y + e)
        return float((moved / np.maximum(slope, 1e-300)).max())


def _line(fields: list[str]) -> list[Curve]:
    return [Curve(clamped_space(2), numbers(fields[:6]).reshape(2, 3))]


def _arc(fields: list[str]) -> list[Curve]:
    z, *plane = numbers(fields[:7]).tolist()
    return _round(z, *np.array(plane).reshape(3, 2))


def _round(z: float, center: NDArray, begin: NDArray, end: NDArray) -> list[Curve]:
    """Return an arc, counter-clockwise, or a full circle if its ends coincide, as quadratic pieces
    with weights.
    """
    arms = begin - center, end - center
    radius = math.hypot(*arms[0])
    angles = [math.atan2(y, x) for x, y in arms]
    if not radius > 0.0:
        raise ValueError("an arc without radius")
    turn = (angles[1] - angles[0]) % (2.0 * math.pi)
    turn = 2.0 * math.pi if np.array_equal(begin, end) or not turn else turn
    frame = np.eye(4)
    frame[:3, 3] = *center, z
    return conic_pieces(frame, (radius, radius), (angles[0], angles[0] + turn))


def arc_steps(turn: float) -> int:
    """Return the number of quadratic pieces of an arc that turns by an angle."""
    return max(1, math.ceil(turn / MAX_ARC - 1e-9))


def conic_pieces(
    frame: NDArray,
    sizes: tuple[float, float],
    ends: tuple[float, float],
    kind: str = "ELLIPSE",
) -> list[Curve]:
    """Return a part of a conic in a frame (4, 4), between two parameters of ISO 10303-42, as
    quadratic pieces with weights. The middle control point is the meet of a piece's end tangents.

    sizes: both half axes, or both sizes of a hyperbola, or the focal length twice.
    """
    steps = arc_steps(ends[1] - ends[0]) if kind == "ELLIPSE" else 1
    marks = np.linspace(*ends, steps + 1)
    pieces = []
    for low, high in zip(marks[:-1], marks[1:]):
        middle, half = (low + high) / 2.0, (high - low) / 2.0
        t = np.array([low, middle, high])
        if kind == "PARABOLA":
            plane = np.array([[low**2, low * high, high**2], 2.0 * t])
            weight = 1.0
        else:
            cosine, sine = (np.cos, np.sin) if kind == "ELLIPSE" else (np.cosh, np.sinh)
            weight = float(cosine(half))
            plane = np.array([cosine(t), sine(t)]) / [1.0, weight, 1.0]
        points = (plane.T * sizes) @ frame[:3, :2].T + frame[:3, 3]
        pieces.append(Curve(clamped_space(3), points, np.array([1.0, weight, 1.0])))
    return pieces


def _conic(fields: list[str]) -> list[Curve] | None:
    """Return an arc of an ellipse, counter-clockwise, of a parabola or of a hyperbola; None for
    other conics.
    """
    a, b, c, d, e, f, z, *ends = numbers(fields[:11]).tolist()
    begin, end = np.array(ends).reshape(2, 2)
    form = np.array([[a, b / 2.0], [b / 2.0, c]])
    if np.linalg.det(form) > 1e-14 * np.trace(form) ** 2:
        center = -np.linalg.solve(2.0 * form, [d, e])
        form = form / (center @ form @ center - f)
        if not np.trace(form) > 0.0:
            return None
        matrix = np.eye(4)
        matrix[:2, :2] = np.linalg.inv(np.linalg.cholesky(form).T)
        matrix[:2, 3] = center
        unit = [np.linalg.solve(matrix[:2, :2], place - center) for place in (begin, end)]
        return [one.transform(matrix) for one in _round(z, np.zeros(2), *unit)]
    whole = np.array([[a, b / 2.0, d / 2.0], [b / 2.0, c, e / 2.0], [d / 2.0, e / 2.0, f]])
    first, last = np.append(begin, 1.0), np.append(end, 1.0)
    meet = np.cross(whole @ first, whole @ last)
    if not meet[2]:
        return None
    meet /= meet[2]  # of the tangents at both ends
    square = -float(first @ whole @ last) / (2.0 * float(meet @ whole @ meet) or math.inf)
    if not square > 0.0:
        return None
    points = np.array([first, meet, last])
    points[:, 2] = z
    return [Curve(clamped_space(3), points, np.array([1.0, math.sqrt(square), 1.0]))]


def _spline(fields: list[str]) -> list[Curve] | None:
    """Return the used part of a B-spline curve; None if a weight is not positive."""
    last, degree = integers(fields, 2)
    count = last + 1
    knot_count = last + degree + 2
    if degree < 1 or count <= degree:
        raise ValueError("too few control points")
    values = numbers(fields[6 : 6 + knot_count + 4 * count + 2])
    if len(values) < knot_count + 4 * count + 2:
        raise ValueError("too few numbers")
    knots, weights, points, part = np.split(values, np.cumsum([knot_count, count, 3 * count]))
    if (weights <= 0.0).any():
        return None
    curve = Curve(
        SplineSpace(tuple(knots.tolist()), degree + 1, count), points.reshape(count, 3), weights
    )
    return bezier_curves(curve, (float(part[0]), float(part[1])))


_MAKERS: dict[int, Callable[[list[str]], list[Curve] | None]] = {
    ARC: _arc,
    CONIC: _conic,
    LINE: _line,
    SPLINE: _spline,
}
