# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in NumPy's files, .npy and .npz, and raw samples without a header, described by the file's
name.
"""

from __future__ import annotations

import math
import re
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import NDArray

from ..files import (
    DAMAGE_INCOMPLETE,
    DEFAULT_LIMITS,
    OTHERS_LEFT_OUT,
    Limits,
    check_length,
    damaged,
)
from ..verdict import FileError, finding
from .findings import RAW_WITHOUT_LAYOUT, SCAN_SAMPLE_TYPE, SCAN_SIZE
from .scan import (
    Scan,
    map_samples,
    real_samples,
    shape_of,
    space_axes,
)
from .scan_files import SAMPLE_TYPES

ENTRY = b"PK\1\2"  # first bytes of an entry in a zip archive's directory
MAX_ARRAY_HEADER = 10_000  # bytes, like numpy.load


def read_npy(path: Path, _limits: Limits) -> Scan:
    """Read the array of an .npy file as a memory map."""
    return Scan(real_samples(map_array(path)), np.eye(4))


def map_array(path: Path) -> NDArray:
    """Return the memory map of an array of any type but objects.

    Raises OSError, and FileError for other contents.
    """
    with open(path, "rb") as file:
        start = file.read(12)  # to the end of the header's length
    with _damage(path, "NumPy array"):
        _check_array_header(start)
        array = np.lib.format.open_memmap(path, mode="r")
    check_length(path, path.stat().st_size - array.offset, array.nbytes)
    return array


def read_npz(path: Path, limits: Limits) -> Scan:
    """Read the array called “density”, else the first of three dimensions; only the headers of the
    others are read.
    """
    with _archive(path, limits) as (archive, shapes):
        volumes = [name for name, shape in shapes.items() if len(shape) == 3]
        volumes = volumes or [name for name, shape in shapes.items() if _is_volume(shape)]
        if not volumes:
            raise FileError(SCAN_SIZE, samples=next(map(list, shapes.values()), []))
        name = "density" if "density" in volumes else volumes[0]
        findings = ()
        others = [volume for volume in volumes if volume != name]
        if others:
            findings = (finding(OTHERS_LEFT_OUT, kind="array", name=name, others=others),)
        samples = real_samples(_unpack(archive, path, name, limits))
        return Scan(samples, np.eye(4), findings=findings)


def _is_volume(shape: Sequence[int]) -> bool:
    """Return whether an array has three axes in space."""
    with suppress(FileError):
        return bool(space_axes(shape))
    return False


def read_arrays(path: Path, names: Sequence[str], limits: Limits) -> dict[str, NDArray]:
    """Return the arrays of an .npz file with these names, of any type but objects.

    Raises FileError and OSError.
    """
    with _archive(path, limits) as (archive, shapes):
        return {name: _unpack(archive, path, name, limits) for name in names if name in shapes}


@contextmanager
def _archive(
    path: Path, limits: Limits
) -> Iterator[tuple[zipfile.ZipFile, dict[str, tuple[int, ...]]]]:
    """Yield an open archive, and the shapes of its arrays by name.

    Exceptions in the block become FileErrors, but MemoryError. Raises OSError.
    """
    with (
        open(path, "rb") as file,
        _damage(path, "archive of NumPy arrays"),
        zipfile.ZipFile(file) as archive,
    ):
        entries = archive.infolist()
        limits.check(path, "entries", len(entries))
        if any(ENTRY in entry.comment + entry.extra for entry in entries):
            raise zipfile.BadZipFile("overlapping entries")  # by a wrong length
        heads = {entry.filename: _npz_header(archive, entry) for entry in entries}
        yield archive, {name.removesuffix(".npy"): shape for name, shape in heads.items()}


@contextmanager
def _damage(path: Path, kind: str) -> Iterator[None]:
    """Turn every exception in the block but MemoryError into a FileError."""
    try:
        yield
    except (MemoryError, FileError):
        raise
    except Exception as error:  # NumPy evaluates a damaged header, which may raise anything
        reason = type(error).__name__
        if isinstance(error, zipfile.BadZipFile):
            reason = str(error).rstrip(".")
        raise damaged(path, DAMAGE_INCOMPLETE, kind=kind, error=reason) from error


def _unpack(archive: zipfile.ZipFile, path: Path, name: str, limits: Limits) -> NDArray:
    """Read an array of an archive to the end of its entry, where zipfile compares the checksum."""
    limits.check(path, "unpacked_bytes", archive.getinfo(name + ".npy").file_size)
    with archive.open(name + ".npy") as file:
        return np.lib.format.read_array(file, allow_pickle=False)


def _check_array_header(start: bytes) -> None:
    """Raise ValueError if an array's header is too long, because NumPy would read gigabytes of it
    before it refuses.

    start: at least the first 12 bytes: six of magic, two of the version, and the length of the
    header, of two bytes in version 1 and four in later ones.
    """
    length = start[8 : 10 if start[6:7] == b"\1" else 12]
    if int.from_bytes(length, "little") > MAX_ARRAY_HEADER:
        raise ValueError("length of header")


def _npz_header(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> tuple[int, ...]:
    """Return the shape of the array in an entry, without reading its numbers.

    ValueError if the entry is longer than the array, because reading would not reach the checksum.
    """
    with cast(zipfile.ZipExtFile, archive.open(entry)) as file:  # has `peek`
        _check_array_header(file.peek(12))
        version = np.lib.format.read_magic(file)
        read = (
            np.lib.format.read_array_header_1_0
            if version == (1, 0)
            else np.lib.format.read_array_header_2_0
        )
        shape, _, dtype = read(file)
        size = file.tell() + dtype.itemsize * math.prod(shape)
        if not dtype.hasobject and size != entry.file_size:
            raise ValueError("length of entry")
    return shape


def read_raw(
    path: str | Path,
    shape: Sequence[int],
    dtype: str,
    big_endian: bool = False,
    limits: Limits = DEFAULT_LIMITS,
) -> Scan:
    """Read samples with no header: shape (nx, ny, nz), x running fastest; dtype: one of
    SAMPLE_TYPES.
    """
    if dtype not in SAMPLE_TYPES:
        raise FileError(SCAN_SAMPLE_TYPE, type=dtype)
    kind = np.dtype(dtype).newbyteorder(">" if big_endian else "<")
    shape = shape_of(shape)
    limits.check(Path(path), "samples", math.prod(shape))
    return Scan(map_samples(Path(path), kind, shape, 0), np.eye(4))


def read_named_raw(path: Path, limits: Limits) -> Scan:
    """Read a raw file that is called NAME_XxYxZ_TYPE.raw, like the Open SciVis collection."""
    layout = re.search(
        r"_(\d+)x(\d+)x(\d+)_({:s})\.raw$".format("|".join(SAMPLE_TYPES)), path.name, re.IGNORECASE
    )
    if not layout:
        raise FileError(RAW_WITHOUT_LAYOUT)
    return read_raw(
        # `int` refuses thousands of digits; twenty are too many for a possible size already.
        path,
        [int(size[:20]) for size in layout.groups()[:3]],
        layout[4].lower(),
        limits=limits,
    )
