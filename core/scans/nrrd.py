# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""NRRD files, http://teem.sourceforge.net/nrrd/format.html: samples raw, as text,
or packed by gzip or bzip2, attached or detached.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..files import (
    DAMAGE_CUT_SHORT,
    FILE_UNRECOGNIZED,
    HEADER_FIELD,
    NAMED_FILE_MISSING,
    Limits,
    damaged,
    parse_number,
    parse_whole,
)
from ..numerics import Array
from ..verdict import FileError
from .findings import NRRD_DATA_FILE_OUTSIDE, SCAN_IN_SEVERAL_FILES, SCAN_SAMPLE_TYPE
from .labels import segment_labels
from .scan import Scan, map_samples, parse_samples, shape_of, space_axes, unpack_samples

HEADER_BLOCK = 1 << 16  # bytes of a header that are read at a time
MAX_AXES = 16
_METERS = {
    "": 1.0,
    "deci": 0.1,
    "centi": 1e-2,
    "milli": 1e-3,
    "micro": 1e-6,
    "nano": 1e-9,
    "kilo": 1e3,
}
UNITS = {
    **{
        prefix + name: unit
        for prefix, unit in _METERS.items()
        for name in ("meter", "meters", "metre", "metres")
    },
    "m": 1.0,
    "dm": 0.1,
    "cm": 1e-2,
    "mm": 1e-3,
    "nm": 1e-9,
    "km": 1e3,
    **dict.fromkeys(("um", "\u00b5m", "\u03bcm", "micron", "microns"), 1e-6),
    **dict.fromkeys(("angstrom", "angstroms", "\u00e5"), 1e-10),
    **dict.fromkeys(("in", "inch", "inches"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
}
TIMES = {
    "s",
    "sec",
    "second",
    "seconds",
    "ms",
    "millisecond",
    "milliseconds",
    "us",
    "\u00b5s",
    "ns",
    "hz",
}
# "" and the others stand for no unit
KNOWN_WORDS = {*UNITS, *TIMES, "", "none", "unknown", "???", "pixel", "pixels", "voxel", "voxels"}
# The samples along other axes are no places.
SPACE_KINDS = {
    "domain",
    "space",
    "stub",
    "none",
    "???",
}
# Allowed difference of an axis' extent (maximum minus minimum) from the one by its spacing, as a
# share of that. Chosen: more than the rounding of any header's decimals, less than one sample of
# most axes.
SAME_EXTENT_RTOL = 1e-3
TYPES = {
    name: dtype
    for dtype, names in {
        "i1": "signed char,int8,int8_t",
        "u1": "uchar,unsigned char,uint8,uint8_t",
        "i2": "short,short int,signed short,signed short int,int16,int16_t",
        "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t",
        "i4": "int,signed int,int32,int32_t",
        "u4": "uint,unsigned int,uint32,uint32_t",
        "i8": "longlong,long long,long long int,signed long long,signed long long "
        "int,int64,int64_t",
        "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t",
        "f4": "float",
        "f8": "double",
    }.items()
    for name in names.split(",")
}
ENCODINGS = {
    "raw": "raw",
    **dict.fromkeys(("txt", "text", "ascii"), "text"),
    **dict.fromkeys(("gz", "gzip"), "gzip"),
    **dict.fromkeys(("bz2", "bzip2"), "bzip2"),
}
# Signs of the coordinates of anatomical spaces, which become right, anterior, superior as in NIfTI.
_TO_RAS = {
    **dict.fromkeys(("right-anterior-superior", "ras", "rast"), (1.0, 1.0, 1.0)),
    **dict.fromkeys(("left-anterior-superior", "las", "last"), (-1.0, 1.0, 1.0)),
    **dict.fromkeys(("left-posterior-superior", "lps", "lpst"), (-1.0, -1.0, 1.0)),
}
_OTHER_SPACES = "scanner-xyz", "3d-right-handed", "3d-left-handed"
_PER_AXIS = {
    *("sizes", "spacings", "thicknesses", "axis mins", "axis maxs"),
    *("centers", "kinds", "units", "space directions"),
}
# Other forms of names.
_NAMES = {"centerings": "centers"} | {
    name.replace(" ", ""): name
    for name in (
        *("axis mins", "axis maxs", "data file", "line skip", "byte skip"),
        *("space directions", "space origin", "space units"),
    )
}
_HEADER_END = re.compile(rb"\r?\n\r?\n")
_WORD = re.compile(r'"([^"]*)"|([^\s"]+)')


def read_header(path: Path, limits: Limits) -> tuple[dict[str, str], int | None]:
    """Return the fields of a header, and the samples' offset, None if the file ends before them.

    Fields have names in lower case. Keys, which have names of any case, are among them with “=”
    before the name. Raises FileError.
    """
    head = bytearray()
    end = None
    with open(path, "rb") as file:
        while not end and (block := file.read(HEADER_BLOCK)):
            # An empty line, of up to four bytes, may begin in the block before.
            unsearched = max(0, len(head) - 3)
            head += block
            if not re.match(rb"NRRD000[1-5]\r?\n", head):
                raise FileError(FILE_UNRECOGNIZED, format="NRRD")
            end = _HEADER_END.search(head, unsearched)
            limits.check(path, "header_bytes", end.end() if end else len(head))
    if not head:
        raise FileError(FILE_UNRECOGNIZED, format="NRRD")
    fields = {}
    text = bytes(head[: end.start() if end else len(head)])
    try:
        lines = text.decode().splitlines()
    except UnicodeDecodeError:
        lines = text.decode("latin-1").splitlines()
    for line in lines[1:]:
        name, colon, value = line.partition(":")
        if colon and value.startswith("="):  # “:=” sets a key's value
            fields["=" + name.strip()] = value[1:].strip()
        elif colon:
            name = name.strip().lower()
            fields[_NAMES.get(name, name)] = value.strip()
    return fields, end.end() if end else None


def read_nrrd(path: Path, limits: Limits) -> Scan:
    """Read the scan as a memory map, or unpacked if it is packed."""
    fields, start = read_header(path, limits)
    shape = _take_shape(fields)
    dtype, encoding = _sample_type(fields)
    kinds = fields.get("kinds", "").lower().split()
    if kinds and not (len(kinds) == 3 and SPACE_KINDS.issuperset(kinds)):
        raise _wrong(fields, "kinds", "three axes in space")
    matrix, is_placed, unit = _sample_matrix(fields, shape)
    space = fields.get("space", "").lower().removesuffix("-time")
    is_anatomical = space in _TO_RAS
    if is_anatomical and "space directions" in fields:
        matrix[:3] *= np.array(_TO_RAS[space])[:, None]
    elif space and not is_anatomical and space not in _OTHER_SPACES:
        raise _wrong(fields, "space", "a space of NRRD, such as left-posterior-superior")
    line_skip = _skip(fields, "line skip", 0)
    # A skip of -1 means that raw samples are the last bytes of the file. Of compressed samples,
    # unpacked bytes are skipped.
    byte_skip = _skip(fields, "byte skip", -1 if encoding == "raw" else 0)
    source, start = _samples_start(path, fields.get("data file"), start, limits)
    if line_skip:
        start = _skip_lines(source, start, line_skip, limits)
    if encoding == "raw":
        samples = map_samples(
            source, dtype, shape, start + max(byte_skip, 0), from_end=byte_skip == -1
        )
    elif encoding == "text":
        samples = parse_samples(source, start + byte_skip, dtype, shape, limits)
    else:
        samples = unpack_samples(source, start, dtype, shape, byte_skip, limits, encoding)
    usual_unit = 1e-3 if is_anatomical else None
    labels = segment_labels(fields)
    return Scan(samples, matrix, unit, is_placed, usual_unit=usual_unit, labels=labels)


def _take_shape(fields: dict[str, str]) -> tuple[int, int, int]:
    """Return the sizes of the three axes in space, and drop other axes from all fields that state a
    word for each axis.
    """
    sizes = _numbers(fields, "sizes", parse_whole)
    if not sizes:
        raise _wrong(fields, "sizes", "three numbers")
    if _numbers(fields, "dimension", parse_whole) != [len(sizes)]:
        raise _wrong(fields, "dimension", "the count of “sizes”")
    axes = space_axes(sizes)
    for name in _PER_AXIS & fields.keys() if len(sizes) > 3 else ():
        words = re.findall(r'"[^"]*"|\([^()]*\)|[^\s"()]+', fields[name])
        if len(words) == len(sizes):
            fields[name] = " ".join(words[axis] for axis in axes)
    return shape_of(sizes)


def _sample_type(fields: dict[str, str]) -> tuple[np.dtype, str]:
    """Return the type of the samples, with its byte order, and one of the values of ENCODINGS."""
    kind = TYPES.get(fields.get("type", "").lower())
    if kind is None:
        raise FileError(SCAN_SAMPLE_TYPE, type=fields.get("type", "“”"))
    dtype = np.dtype(kind)
    endian = fields.get("endian", "").lower()
    encoding = ENCODINGS.get(fields.get("encoding", "").lower())
    if encoding is None:
        raise _wrong(fields, "encoding", "raw, gzip, bzip2 or text")
    if encoding != "text" and dtype.itemsize > 1 and endian not in ("little", "big"):
        raise _wrong(fields, "endian", "little or big")
    return dtype.newbyteorder(">" if endian == "big" else "<"), encoding


def _samples_start(
    path: Path, name: str | None, start: int | None, limits: Limits
) -> tuple[Path, int]:
    """Return the file that has the samples, and their offset in it.

    path: of the header. name: of a separate file, None if the samples follow the header. start:
    their offset then, None if the file ends with the header.
    """
    if name is None:
        if start is None:
            raise damaged(path, DAMAGE_CUT_SHORT, part="header")
        return path, start
    # Three forms of several files: a list, a pattern such as slice%03d, a pattern with its range.
    if name.upper().startswith("LIST") or "%" in name or len(name.split()) > 3:
        raise FileError(SCAN_IN_SEVERAL_FILES, suffix=".nrrd")
    source = path.parent / name
    if not source.is_file():
        raise FileError(NAMED_FILE_MISSING, file=name, content="samples")
    if not (limits.allow_outside or source.resolve().is_relative_to(path.parent.resolve())):
        raise FileError(NRRD_DATA_FILE_OUTSIDE, file=name)
    return source, 0


def _wrong(fields: dict[str, str], name: str, wanted: str) -> FileError:
    """Return the refusal of a field. wanted: what it should be."""
    return FileError(
        HEADER_FIELD, format="NRRD", field=name, wanted=wanted, text=fields.get(name, "")
    )


def _numbers(
    fields: dict[str, str], name: str, parse: Callable[[str], Any], default: str = ""
) -> list:
    """Return the numbers in a field. default: the text if there is no such field."""
    try:
        return [parse(word) for word in fields.get(name, default).split()]
    except (ValueError, OverflowError):
        raise _wrong(fields, name, "a list of numbers") from None


def _skip(fields: dict[str, str], name: str, least: int) -> int:
    """Return the number of lines or bytes to skip, 0 by default, at least `least`."""
    values = _numbers(fields, name, parse_whole, "0")
    if len(values) != 1 or values[0] < least:
        raise _wrong(fields, name, "one number, not negative")
    return values[0]


def _skip_lines(path: Path, start: int, count: int, limits: Limits) -> int:
    """Return the offset behind `count` lines from byte `start` on. FileError if there are fewer, or
    a line is longer than a header may be.
    """
    with open(path, "rb") as file:
        file.seek(start)
        for _ in range(count):
            if not file.readline(limits.header_bytes).endswith(b"\n"):
                raise damaged(path, DAMAGE_CUT_SHORT, part="skipped lines")
        return file.tell()


def _sample_matrix(
    fields: dict[str, str], shape: tuple[int, int, int]
) -> tuple[Array, bool, float | None]:
    """Return the (4, 4) matrix from sample indices to positions, whether the header states the
    spacing, and the matrix's unit in meters, None if it is not stated.
    """
    matrix = np.eye(4)
    name = "space units" if "space units" in fields else "units"  # of the space, else of the axes
    units = _units(fields, name)
    if "space directions" in fields:
        words = re.findall(r"none|\([^()]*\)|\S", fields["space directions"])
        directions = [_vector(word, "space directions") for word in words[:MAX_AXES]]
        vectors = [vector for vector in directions if vector is not None]
        if len(vectors) != 3 or len(words) > MAX_AXES:
            raise _wrong(fields, "space directions", "three vectors")
        matrix[:3, :3] = np.array(vectors).T
        if "space origin" in fields:
            origin = _vector(fields["space origin"], "space origin")
            matrix[:3, 3] = np.zeros(3) if origin is None else origin
        is_placed = True
    else:
        spacings, matrix[:3, 3] = _even_axes(fields, shape)
        is_placed = spacings is not None
        matrix[:3, :3] = np.diag([1.0, 1.0, 1.0] if spacings is None else spacings)
    if units is not None and len(set(units)) == 1:
        return matrix, is_placed, units[0]
    # Different units of the axes say nothing about the coordinates of their directions.
    if units is None or "space directions" in fields and name == "units":
        return matrix, is_placed, None
    # Row i has the coordinates along axis i of the space. Without directions, these are the axes of
    # the samples.
    matrix[:3] = matrix[:3] * np.array(units)[:, None]
    return matrix, is_placed, 1.0


def _units(fields: dict[str, str], name: str) -> list[float] | None:
    """Return the units of three axes in meters, or None if one is not stated.

    name: of the field. FileError for units of time, or unknown words.
    """
    words = [
        (quoted or word).strip() for quoted, word in _WORD.findall(fields.get(name, "").lower())
    ]
    if name == "units" and TIMES.intersection(words[:3]) or set(words[:3]) - KNOWN_WORDS:
        raise _wrong(fields, name, "units of length")
    units = [UNITS[word] for word in words[:3] if word in UNITS]
    return units if len(units) == 3 else None


def _even_axes(
    fields: dict[str, str], shape: tuple[int, int, int]
) -> tuple[list[float] | None, list[float]]:
    """Return the spacing along each axis, None if the header states none, and the (3,) position of
    the first sample, zeros if it is not stated for each axis.

    A spacing that is not stated follows from the axis' minimum and maximum: they are the outer
    faces of the first and last sample on axes of cells, and their centers on axes of nodes. If
    neither cells nor nodes are stated, but minimum, maximum and spacing are, their distance tells
    them apart; without spacing, cells are assumed, as by the format's own library. The last resort
    is the thickness.
    """
    # Of NaN, where a field states nothing, follow NaN and False below.
    stated, lows, highs, thicknesses = (
        _three_numbers(fields, name)
        for name in ("spacings", "axis mins", "axis maxs", "thicknesses")
    )
    centers = [*fields.get("centers", "").lower().split(), *["???"] * 3][:3]
    if not {"cell", "node", "none", "???"}.issuperset(centers):
        raise _wrong(fields, "centers", "cell or node for each axis")
    unfit = _wrong(fields, "spacings", "three spacings that are not zero")
    has_few = 0 < len(fields.get("spacings", "").split()) < 3
    if has_few or 0.0 in stated or any(map(math.isinf, stated)):
        raise unfit
    spacings = []
    origin = []
    are_stated = "spacings" in fields
    for axis, (spacing, low, high) in enumerate(zip(stated, lows, highs)):
        count = shape[axis]
        # Steps from the minimum to the maximum: between outer faces as many as samples, between
        # outer centers one less.
        steps = count - (centers[axis] == "node")
        if math.isnan(spacing):
            spacing = (high - low) / steps if steps else math.nan
        else:
            stated_steps = (high - low) / spacing
            if centers[axis] not in ("cell", "node"):  # Nearer to the steps of cells, or of nodes?
                steps = count if stated_steps > count - 0.5 else count - 1
            if abs(stated_steps - steps) > SAME_EXTENT_RTOL * count:
                raise _wrong(fields, "axis maxs", "in agreement with “spacings”")
        are_stated = are_stated or _is_spacing(spacing)
        spacings.append(spacing if _is_spacing(spacing) else thicknesses[axis])
        origin.append(low + spacings[-1] / 2.0 if steps == count else low)
    if not all(map(_is_spacing, spacings)):
        if are_stated:
            raise unfit
        spacings = None
        origin = lows
    return spacings, origin if np.isfinite(origin).all() else [0.0] * 3


def _three_numbers(fields: dict[str, str], name: str) -> list[float]:
    """Return the first three numbers of a field, three times NaN if it has fewer."""
    numbers = _numbers(fields, name, parse_number)
    return numbers[:3] if len(numbers) >= 3 else [math.nan] * 3


def _is_spacing(number: float) -> bool:
    """Return whether a number is finite and not zero."""
    return 0.0 < abs(number) < math.inf


def _vector(text: str, name: str) -> list[float] | None:
    """Return the vector “(x,y,z)” of a field, or None for “none”."""
    if text == "none":
        return None
    # A fourth number stays in the last word, and is refused.
    words = text[1:-1].split(",", 3) if text[0] + text[-1] == "()" else []
    try:
        vector = [parse_number(word.strip()) for word in words]
    except ValueError:
        vector = []
    if len(vector) != 3 or not np.isfinite(vector).all():
        raise _wrong({name: text}, name, "vectors of three numbers")
    return vector
