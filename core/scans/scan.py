# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The samples of a scan in a file: a memory map if they are not packed, so that they may be larger
than memory.

A header is compared with the size of the file, and packed samples with their checksum, before they
are used. Every fault of a file is a FileError that names the fault.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..files.damage import check_length, damaged
from ..files.findings import (
    DAMAGE_CUT_SHORT,
    DAMAGE_INCOMPLETE,
    DAMAGE_SIZE,
)
from ..files.limits import Limits
from ..verdict.finding import FileError, Finding
from .findings import SCAN_SAMPLE_TYPE, SCAN_SIZE

MAX_GZIP_RATIO = 1032  # Most bytes that one byte of a gzip file can unpack to.
PACKED = 1 << 16  # Packed bytes read at a time; the rest after each small member is copied.
BLOCK = 1 << 18  # unpacked bytes at a time


@dataclass(frozen=True, eq=False)
class Scan:
    """The samples of a scan, and their positions.

    Attributes
    ----------
    samples : (nx, ny, nz) array
        Of any real type, perhaps a memory map. A sample stands for slope · sample + intercept.
    matrix : (4, 4) array
        The sample (i, j, k) stands at matrix @ (i, j, k, 1), in units of `unit` meters.
    unit : float or None
        None if the file does not state it.
    is_placed : bool
        True if the file states the positions of samples.
    slope, intercept : float
    findings : tuple of Finding
        Decisions made on the way.

    Examples
    --------
    >>> from body_moments.core.scans import Scan
    >>> Scan(np.zeros((2, 2, 2)), np.eye(4)).is_placed
    False
    """

    samples: NDArray
    matrix: NDArray[np.float64]
    unit: float | None = None
    is_placed: bool = False
    slope: float = 1.0
    intercept: float = 0.0
    findings: tuple[Finding, ...] = ()


def shape_of(sizes: Sequence[int]) -> tuple[int, int, int]:
    """Return three positive sizes; further sizes must be 1. FileError if they are not possible."""
    sizes = tuple(int(size) for size in sizes)
    dimensions = max(
        (number for number, size in enumerate(sizes, 1) if number <= 3 or size != 1), default=0
    )
    if dimensions != 3:
        raise FileError(SCAN_SIZE, samples=list(sizes))
    x, y, z = sizes[:3]
    if min(x, y, z) < 1 or max(x, y, z) > 1 << 40 or x * y * z > 1 << 48:
        raise FileError(SCAN_SIZE, samples=[x, y, z])
    return x, y, z


def real_samples(array: NDArray) -> NDArray:
    """Return the array if it can be a scan of densities, else raise FileError."""
    if array.dtype.kind not in "biuf":
        raise FileError(SCAN_SAMPLE_TYPE, type=str(array.dtype))
    if array.ndim != 3 or not array.size:
        raise FileError(SCAN_SIZE, samples=list(array.shape))
    return array


def map_samples(
    path: Path, dtype: np.dtype, shape: tuple[int, int, int], offset: int, from_end: bool = False
) -> NDArray:
    """Return a memory map of samples, x fastest, from byte `offset` on, or at the end of the file
    if `from_end`.
    """
    size = path.stat().st_size
    byte_count = dtype.itemsize * math.prod(shape)
    if from_end:
        offset = max(offset, size - byte_count)
    check_length(path, max(0, size - offset), byte_count)
    return np.memmap(path, dtype, "r", offset, shape, "F")


def unpack_samples(
    path: Path, start: int, dtype: np.dtype, shape: tuple[int, int, int], skip: int, limits: Limits
) -> NDArray:
    """Return samples, x fastest, gzipped from byte `start` on, without the first `skip` bytes;
    check all checksums.
    """
    byte_count = dtype.itemsize * math.prod(shape)
    total = skip + byte_count
    room = MAX_GZIP_RATIO * path.stat().st_size
    if total > room:
        raise damaged(path, DAMAGE_SIZE, bytes=max(0, room - skip), total=byte_count)
    limits.check(path, "unpacked_bytes", total)
    unpacked = np.empty(total, np.uint8)
    done = 0
    for block in gzip_blocks(path, start):
        part = np.frombuffer(block, np.uint8)[: total - done]
        unpacked[done : done + len(part)] = part
        done += len(block)
        if done > total:  # a small file may hold a thousand times its size
            break
    check_length(path, max(0, done - skip), byte_count)
    return unpacked[skip:].view(dtype).reshape(shape, order="F")


def gzip_blocks(path: Path, start: int) -> Iterator[bytes]:
    """Yield the unpacked data from byte `start` of a file on, in blocks of at most BLOCK bytes.

    zlib compares the checksum and the length of each member. Zero bytes behind a member are
    padding; anything else there, which the gzip tool ignores with a warning, is damage: it may have
    been a member of samples.
    """
    with open(path, "rb") as file:
        file.seek(start)
        waiting = file.read(PACKED)
        first = True
        while waiting or first:
            member = zlib.decompressobj(
                zlib.MAX_WBITS | 16
            )  # with the head and the checksums of gzip
            while not member.eof:
                try:
                    block = member.decompress(waiting, BLOCK)
                except zlib.error as error:
                    reason = str(error).rpartition(": ")[2]
                    raise damaged(
                        path, DAMAGE_INCOMPLETE, kind="gzip stream", error=reason
                    ) from error
                if not (block or waiting or member.eof):
                    raise damaged(path, DAMAGE_CUT_SHORT, part="compressed part")
                yield block
                waiting = (
                    member.unused_data
                    if member.eof
                    else member.unconsumed_tail or file.read(PACKED)
                )
            first = False
            waiting = waiting.lstrip(b"\0")
            while not waiting and (more := file.read(PACKED)):
                waiting = more.lstrip(b"\0")
