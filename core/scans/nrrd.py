# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""NRRD files, http://teem.sourceforge.net/nrrd/format.html: samples raw or packed by gzip, attached or detached."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import FileError
from ..verdict.number_text import parse_number, parse_whole
from .findings import (
    DAMAGE_LINES,
    NRRD_DATA_FILE_MISSING,
    NRRD_DATA_FILE_OUTSIDE,
    NRRD_DIMENSION_MISMATCH,
    NRRD_ENCODING,
    NRRD_ENDIAN_MISSING,
    NRRD_FIELD_MISSING,
    NRRD_FIELD_NOT_NUMBERS,
    NRRD_FIELD_NOT_ONE_NUMBER,
    NRRD_HEADER_UNENDED,
    NRRD_SEVERAL_FILES,
    NRRD_SPACE_DIRECTIONS,
    NRRD_SPACINGS,
    NRRD_TYPE,
    NRRD_UNRECOGNIZED,
    NRRD_VECTOR,
)
from .limits import Limits
from .scan import Scan, damaged, map_samples, shape_of, unpack_samples

HEADER_BLOCK = 1 << 16  # bytes of a header that are read at a time
MAX_AXES = 16
UNITS = {
    "m": 1.0,
    "meter": 1.0,
    "meters": 1.0,
    "cm": 1e-2,
    "mm": 1e-3,
    "millimeter": 1e-3,
    "millimeters": 1e-3,
    "um": 1e-6,
    "µm": 1e-6,
    "micron": 1e-6,
    "microns": 1e-6,
    "nm": 1e-9,
}
TYPES = {
    name: dtype
    for dtype, names in {
        "i1": "signed char,int8,int8_t",
        "u1": "uchar,unsigned char,uint8,uint8_t",
        "i2": "short,short int,signed short,signed short int,int16,int16_t",
        "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t",
        "i4": "int,signed int,int32,int32_t",
        "u4": "uint,unsigned int,uint32,uint32_t",
        "i8": "longlong,long long,long long int,signed long long,signed long long int,int64,int64_t",
        "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t",
        "f4": "float",
        "f8": "double",
    }.items()
    for name in names.split(",")
}
_HEADER_END = re.compile(rb"\r?\n\r?\n")


def read_header(path: Path, limits: Limits) -> tuple[dict[str, str], int | None]:
    """Return the fields by their names in lower case, and the offset of the samples; None if the file ends before.

    FileError if it is no NRRD file, or the header has no end within the limit.
    """
    head, end = bytearray(), None
    with open(path, "rb") as file:
        while not end and (block := file.read(HEADER_BLOCK)):
            seen = max(0, len(head) - 3)
            head += block
            if not re.match(rb"NRRD000[1-5]\r?\n", head):
                raise FileError(NRRD_UNRECOGNIZED)
            end = _HEADER_END.search(head, seen)
            limits.check(path, "header_bytes", end.end() if end else len(head))
    if not head:
        raise FileError(NRRD_UNRECOGNIZED)
    fields = {}
    text = head[: end.start() if end else len(head)].decode("latin-1")
    for line in text.splitlines()[1:]:
        name, colon, value = line.partition(":")
        if colon and not value.startswith("="):  # “:=” sets a key's value
            fields[name.strip().lower()] = value.strip()
    return fields, end.end() if end else None


def data_file(fields: dict[str, str]) -> str | None:
    """Return the name of the file that has the samples, if it is another one."""
    return fields.get("data file", fields.get("datafile"))


def read_nrrd(path: Path, limits: Limits) -> Scan:
    """Read the scan, mapped if it is raw."""
    fields, start = read_header(path, limits)

    def needed(name: str) -> str:
        if name not in fields:
            raise FileError(NRRD_FIELD_MISSING, field=name)
        return fields[name]

    def numbers(name: str, kind: type, default: str = "") -> list:
        try:
            parse = parse_whole if kind is int else parse_number
            return [parse(word) for word in fields.get(name, default).split()]
        except (ValueError, OverflowError):
            raise FileError(NRRD_FIELD_NOT_NUMBERS, field=name, text=fields[name]) from None

    sizes = numbers("sizes", int) if needed("sizes") else []
    if numbers("dimension", int) != [len(sizes)]:
        raise FileError(NRRD_DIMENSION_MISMATCH)
    shape = shape_of(sizes)
    kind = TYPES.get(needed("type").lower())
    if kind is None:
        raise FileError(NRRD_TYPE, type=fields["type"])
    dtype = np.dtype(kind)
    endian = fields.get("endian", "").lower()
    if dtype.itemsize > 1 and endian not in ("little", "big"):
        raise FileError(NRRD_ENDIAN_MISSING)
    dtype = dtype.newbyteorder(">" if endian == "big" else "<")
    matrix, placed, unit = _sample_matrix(fields, numbers)
    (line_skip,), (byte_skip,) = (
        _single_value(numbers(name, int, "0"), name)
        for name in (_alias(fields, "line skip"), _alias(fields, "byte skip"))
    )
    source, start = _samples_start(path, data_file(fields), start, limits)
    if line_skip:
        start = _skip_lines(source, start, line_skip, limits)
    encoding = needed("encoding").lower()
    if encoding == "raw":
        samples = map_samples(source, dtype, shape, start + max(byte_skip, 0), from_end=byte_skip == -1)
    elif encoding in ("gzip", "gz"):
        samples = unpack_samples(source, start, dtype, shape, byte_skip, limits)
    else:
        raise FileError(NRRD_ENCODING, encoding=encoding)
    return Scan(samples, matrix, unit, placed)


def _samples_start(path: Path, name: str | None, start: int | None, limits: Limits) -> tuple[Path, int]:
    """Return the file that has the samples, and their offset in it. name: of a detached file."""
    if name is None:
        if start is None:
            raise FileError(NRRD_HEADER_UNENDED)
        return path, start
    if name.upper().startswith("LIST") or "%" in name or len(name.split()) > 3:
        raise FileError(NRRD_SEVERAL_FILES)
    source = path.parent / name
    if not source.is_file():
        raise FileError(NRRD_DATA_FILE_MISSING, file=name)
    if not (limits.allow_outside or source.resolve().is_relative_to(path.parent.resolve())):
        raise FileError(NRRD_DATA_FILE_OUTSIDE, file=name)
    return source, 0


def _single_value(values: list, name: str) -> list:
    if len(values) != 1 or values[0] < -1:
        raise FileError(NRRD_FIELD_NOT_ONE_NUMBER, field=name)
    return values


def _alias(fields: dict[str, str], name: str) -> str:
    """Return the name of a field as the header has it: NRRD fields may be written without their space."""
    return name if name in fields else name.replace(" ", "")


def _skip_lines(path: Path, start: int, count: int, limits: Limits) -> int:
    with open(path, "rb") as file:
        file.seek(start)
        for _ in range(count):
            if not file.readline(limits.header_bytes).endswith(b"\n"):
                raise damaged(path, DAMAGE_LINES)
        return file.tell()


def _sample_matrix(
    fields: dict[str, str], numbers: Callable[..., list]
) -> tuple[NDArray[np.float64], bool, float | None]:
    """Return the matrix of the sample positions, whether the header states it, and its unit."""
    matrix = np.eye(4)
    words = re.findall(r'"([^"]*)"', fields.get("space units", fields.get("units", "")))
    units = {UNITS.get(word.strip().lower()) for word in words[:3]}
    unit = units.pop() if len(units) == 1 else None
    if "space directions" in fields:
        directions = [row for row in _vectors(fields["space directions"], "space directions") if row is not None]
        if len(directions) != 3:
            raise FileError(NRRD_SPACE_DIRECTIONS)
        matrix[:3, :3] = np.array(directions).T
        if "space origin" in fields:
            origin = _vector(fields["space origin"], "space origin")
            matrix[:3, 3] = np.zeros(3) if origin is None else origin
        return matrix, True, unit
    spacings = numbers("spacings", float)
    if spacings:
        if len(spacings) < 3 or not all(0.0 < abs(spacing) < math.inf for spacing in spacings[:3]):
            raise FileError(NRRD_SPACINGS)
        matrix[:3, :3] = np.diag(spacings[:3])
    mins = numbers(_alias(fields, "axis mins"), float)
    if len(mins) >= 3 and np.isfinite(mins[:3]).all():
        matrix[:3, 3] = mins[:3]
    return matrix, bool(spacings), unit


def _vectors(text: str, name: str) -> Iterator[list[float] | None]:
    """Parse vectors in parentheses, with “none” between them. Each character is looked at once."""
    rest = text.strip()
    for _ in range(MAX_AXES):
        vector, end, rest = rest.partition("none" if rest.startswith("none") else ")")
        yield _vector(vector + end, name)
        rest = rest.lstrip()
        if not rest:
            return
    raise FileError(NRRD_VECTOR, field=name, text=text)


def _vector(text: str, name: str) -> list[float] | None:
    if text == "none":
        return None
    try:
        row = [parse_number(word.strip()) for word in text[1:-1].split(",", 3)] if text[0] + text[-1] == "()" else []
    except ValueError:
        row = []
    if len(row) != 3 or not np.isfinite(row).all():
        raise FileError(NRRD_VECTOR, field=name, text=text)
    return row
