# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""NRRD files, http://teem.sourceforge.net/nrrd/format.html: samples raw or packed by gzip, attached or detached."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import FileError
from ..verdict.number_text import parse_number, parse_whole
from .findings import (
    DAMAGE_CUT_SHORT,
    FILE_UNRECOGNIZED,
    HEADER_FIELD,
    NAMED_FILE_MISSING,
    NRRD_DATA_FILE_OUTSIDE,
    SCAN_IN_SEVERAL_FILES,
    SCAN_SAMPLE_TYPE,
)
from .limits import Limits
from .scan import Scan, damaged, map_samples, shape_of, unpack_samples

HEADER_BLOCK = 1 << 16  # bytes of a header that are read at a time
MAX_AXES = 16
UNITS = {
    **dict.fromkeys(("m", "meter", "meters"), 1.0),
    **dict.fromkeys(("mm", "millimeter", "millimeters"), 1e-3),
    **dict.fromkeys(("um", "µm", "micron", "microns"), 1e-6),
    **{"cm": 1e-2, "nm": 1e-9},
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
    """Return the fields by lower-case names, and the samples' offset, None if the file ends before. FileError."""
    head, end = bytearray(), None
    with open(path, "rb") as file:
        while not end and (block := file.read(HEADER_BLOCK)):
            seen = max(0, len(head) - 3)
            head += block
            if not re.match(rb"NRRD000[1-5]\r?\n", head):
                raise FileError(FILE_UNRECOGNIZED, format="NRRD")
            end = _HEADER_END.search(head, seen)
            limits.check(path, "header_bytes", end.end() if end else len(head))
    if not head:
        raise FileError(FILE_UNRECOGNIZED, format="NRRD")
    fields = {}
    text = head[: end.start() if end else len(head)].decode("latin-1")
    for line in text.splitlines()[1:]:
        name, colon, value = line.partition(":")
        if colon and not value.startswith("="):  # “:=” sets a key's value
            fields[name.strip().lower()] = value.strip()
    return fields, end.end() if end else None


def data_file(fields: dict[str, str]) -> str | None:
    """Return the name of a separate file with the samples, None if they follow the header."""
    return fields.get("data file", fields.get("datafile"))


def read_nrrd(path: Path, limits: Limits) -> Scan:
    """Read the scan as a memory map, or unpacked if it is gzipped."""
    fields, start = read_header(path, limits)

    sizes = _numbers(fields, "sizes", parse_whole)
    if not sizes:
        raise _field(fields, "sizes", "three numbers")
    if _numbers(fields, "dimension", parse_whole) != [len(sizes)]:
        raise _field(fields, "dimension", "the count of “sizes”")
    shape = shape_of(sizes)
    kind = TYPES.get(fields.get("type", "").lower())
    if kind is None:
        raise FileError(SCAN_SAMPLE_TYPE, type=fields.get("type", "“”"))
    dtype = np.dtype(kind)
    endian = fields.get("endian", "").lower()
    if dtype.itemsize > 1 and endian not in ("little", "big"):
        raise _field(fields, "endian", "little or big")
    dtype = dtype.newbyteorder(">" if endian == "big" else "<")
    matrix, placed, unit = _sample_matrix(fields)
    encoding = fields.get("encoding", "").lower()
    if encoding not in ("raw", "gzip", "gz"):
        raise _field(fields, "encoding", "raw or gzip")
    line_skip = _skip(fields, "line skip", 0)
    # The samples are the last bytes of a file if the skip is -1; compressed ones are counted from their start.
    byte_skip = _skip(fields, "byte skip", -1 if encoding == "raw" else 0)
    source, start = _samples_start(path, data_file(fields), start, limits)
    if line_skip:
        start = _skip_lines(source, start, line_skip, limits)
    if encoding == "raw":
        samples = map_samples(source, dtype, shape, start + max(byte_skip, 0), from_end=byte_skip == -1)
    else:
        samples = unpack_samples(source, start, dtype, shape, byte_skip, limits)
    return Scan(samples, matrix, unit, placed)


def _samples_start(path: Path, name: str | None, start: int | None, limits: Limits) -> tuple[Path, int]:
    """Return the file that has the samples, and their offset in it. name: of a separate file, None for this one."""
    if name is None:
        if start is None:
            raise damaged(path, DAMAGE_CUT_SHORT, part="header")
        return path, start
    if name.upper().startswith("LIST") or "%" in name or len(name.split()) > 3:
        raise FileError(SCAN_IN_SEVERAL_FILES, suffix=".nrrd")
    source = path.parent / name
    if not source.is_file():
        raise FileError(NAMED_FILE_MISSING, file=name, content="samples")
    if not (limits.allow_outside or source.resolve().is_relative_to(path.parent.resolve())):
        raise FileError(NRRD_DATA_FILE_OUTSIDE, file=name)
    return source, 0


def _field(fields: dict[str, str], name: str, wanted: str) -> FileError:
    return FileError(HEADER_FIELD, format="NRRD", field=name, wanted=wanted, text=fields.get(name, ""))


def _numbers(fields: dict[str, str], name: str, parse: Callable[[str], Any], default: str = "") -> list:
    try:
        return [parse(word) for word in fields.get(name, default).split()]
    except (ValueError, OverflowError):
        raise _field(fields, name, "a list of numbers") from None


def _skip(fields: dict[str, str], name: str, least: int) -> int:
    name = _alias(fields, name)
    values = _numbers(fields, name, parse_whole, "0")
    if len(values) != 1 or values[0] < least:
        raise _field(fields, name, "one number, not negative")
    return values[0]


def _alias(fields: dict[str, str], name: str) -> str:
    """Return the name of a field as the header has it: NRRD fields may be written without their space."""
    return name if name in fields else name.replace(" ", "")


def _skip_lines(path: Path, start: int, count: int, limits: Limits) -> int:
    with open(path, "rb") as file:
        file.seek(start)
        for _ in range(count):
            if not file.readline(limits.header_bytes).endswith(b"\n"):
                raise damaged(path, DAMAGE_CUT_SHORT, part="skipped lines")
        return file.tell()


def _sample_matrix(fields: dict[str, str]) -> tuple[NDArray[np.float64], bool, float | None]:
    """Return the matrix of the sample positions, whether the header states it, and its unit."""
    matrix = np.eye(4)
    words = re.findall(r'"([^"]*)"', fields.get("space units", fields.get("units", "")))
    units = {UNITS.get(word.strip().lower()) for word in words[:3]}
    unit = units.pop() if len(units) == 1 else None
    if "space directions" in fields:
        directions = _vectors(fields, "space directions")
        if len(directions) != 3:
            raise _field(fields, "space directions", "three vectors")
        matrix[:3, :3] = np.array(directions).T
        if "space origin" in fields:
            origin = _vector(fields["space origin"], "space origin")
            matrix[:3, 3] = np.zeros(3) if origin is None else origin
        return matrix, True, unit
    spacings = _numbers(fields, "spacings", parse_number)
    if spacings:
        if len(spacings) < 3 or not all(0.0 < abs(spacing) < math.inf for spacing in spacings[:3]):
            raise _field(fields, "spacings", "three spacings that are not zero")
        matrix[:3, :3] = np.diag(spacings[:3])
    mins = _numbers(fields, _alias(fields, "axis mins"), parse_number)
    if len(mins) >= 3 and np.isfinite(mins[:3]).all():
        matrix[:3, 3] = mins[:3]
    return matrix, bool(spacings), unit


def _vectors(fields: dict[str, str], name: str) -> list[list[float]]:
    """Parse vectors in parentheses, with “none” between them, in time linear in the text."""
    vectors, rest = [], fields[name].strip()
    for _ in range(MAX_AXES):
        vector, end, rest = rest.partition("none" if rest.startswith("none") else ")")
        vectors.append(_vector(vector + end, name))
        rest = rest.lstrip()
        if not rest:
            return [row for row in vectors if row is not None]
    raise _field(fields, name, "three vectors")


def _vector(text: str, name: str) -> list[float] | None:
    if text == "none":
        return None
    try:
        row = [parse_number(word.strip()) for word in text[1:-1].split(",", 3)] if text[0] + text[-1] == "()" else []
    except ValueError:
        row = []
    if len(row) != 3 or not np.isfinite(row).all():
        raise _field({name: text}, name, "vectors of three numbers")
    return row
