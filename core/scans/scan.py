# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The samples of a scan in a file: mapped into memory where they are not packed, so that a scan may be larger than it.

Nothing that a header says of them is believed before it has been compared with the size of the file, and no packed
sample before its checksum. Every fault of a file is a ValueError with a sentence that says what is wrong.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

DEFLATED = 1032  # bytes that a byte of a gzip file can hold, at most
PACKED = 1 << 16  # bytes that are unpacked at a time: what a small member leaves of them is copied
BLOCK = 1 << 18  # unpacked bytes at a time
FAULT = "its packed part cannot be unpacked ({:s})"
FAULTS = {  # what zlib calls those that need plainer words
    "incorrect data check": "its packed part does not have the checksum that was stored with it",
    "incorrect length check": "its packed part does not have the length that was stored with it",
    "incorrect header check": "what is packed in it by gzip, or what follows that, does not begin as gzip does",
}


@dataclass(frozen=True, eq=False)
class Scan:
    """samples: (nx, ny, nz), any real type, perhaps a memory map; a sample stands for slope · sample + intercept.
    matrix: (4, 4), the sample (i, j, k) stands at matrix @ (i, j, k, 1), in units of `unit` metres (None: the file does
    not say). placed: whether the file says where samples stand. notes: one sentence for each decision."""

    samples: NDArray
    matrix: NDArray[np.float64]
    unit: float | None = None
    placed: bool = False
    slope: float = 1.0
    intercept: float = 0.0
    notes: tuple[str, ...] = ()


def shape_of(sizes: Sequence[int]) -> tuple[int, int, int]:
    """Three positive sizes; more only where they are 1."""
    sizes = tuple(int(size) for size in sizes)
    while len(sizes) > 3 and sizes[-1] == 1:
        sizes = sizes[:-1]
    if len(sizes) != 3:
        raise ValueError(
            "It has {:d} dimensions, and a scan of densities has 3; save one volume of it.".format(len(sizes))
        )
    if min(sizes) < 1 or max(sizes) > 1 << 40 or math.prod(sizes) > 1 << 48:
        raise ValueError("Its size, {:s}, is impossible.".format(" x ".join(map(str, sizes))))
    return sizes


def real_samples(array: NDArray) -> NDArray:
    """An array that can be a scan of densities."""
    if array.dtype.kind not in "biuf":
        raise ValueError("Its samples are of the type {:s}, and a density is a real number.".format(str(array.dtype)))
    if array.ndim != 3:
        raise ValueError("It has {:d} dimensions, and a scan of densities has 3.".format(array.ndim))
    if not array.size:
        raise ValueError("It has no samples.")
    return array


def damaged(path: Path, what: str, remedy: str = "Obtain it again, or export it anew.") -> ValueError:
    """The error for a file that is not what was once written."""
    return ValueError("The file “{:s}” is damaged: {:s}. {:s}".format(path.name, what, remedy))


def check_length(path: Path, held: int, wanted: int) -> None:
    """A file must hold just the bytes of samples that its sizes ask for. More of them mean that the sizes are wrong, or
    that nobody knows what the rest is; of samples without a checksum nothing else can show damage."""
    if held == wanted:
        return
    if held < wanted:
        what = "it is cut short or its sizes are wrong: it holds {:d} of the {:d} bytes of samples that they ask for"
    else:
        what = "its sizes are wrong or more follows: it holds more than the {1:d} bytes of samples that they ask for"
    raise damaged(path, what.format(held, wanted), "Obtain it again, export it anew, or correct its sizes.")


def mapped(path: Path, dtype: np.dtype, shape: tuple[int, int, int], offset: int, from_end: bool = False) -> NDArray:
    """Uncompressed samples, x fastest, from byte `offset` to the end of the file. from_end: they are its last bytes,
    after whatever else begins at `offset`, so that only too few of them can be noticed."""
    size, wanted = path.stat().st_size, dtype.itemsize * math.prod(shape)
    if from_end:
        offset = max(offset, size - wanted)
    check_length(path, max(0, size - offset), wanted)
    return np.memmap(path, dtype, "r", offset, shape, "F")


def unpacked(path: Path, start: int, dtype: np.dtype, shape: tuple[int, int, int], skip: int) -> NDArray:
    """Samples that are compressed by gzip from byte `start` of the file on, x fastest; skip: unpacked bytes before.

    They are read to the end of the file, for the checksum stands behind them; see `gzip_blocks`."""
    wanted = dtype.itemsize * math.prod(shape)
    if skip < 0:
        raise ValueError("Samples that are packed are counted from their beginning; “byte skip: -1” is for raw ones.")
    if skip + wanted > DEFLATED * path.stat().st_size:
        raise damaged(path, "{:s} samples cannot be packed into it".format(" x ".join(map(str, shape))))
    samples = np.empty(wanted, np.uint8)
    begin = -skip  # where a block stands among the samples
    for block in gzip_blocks(path, start):
        end = begin + len(block)
        if end > 0 and begin < wanted:
            first, last = max(begin, 0), min(end, wanted)
            samples[first:last] = np.frombuffer(block, np.uint8, last - first, first - begin)
        begin = end
        if begin > wanted:  # a small file may hold a thousand times its size
            break
    check_length(path, max(0, begin), wanted)
    return samples.view(dtype).reshape(shape, order="F")


def gzip_blocks(path: Path, start: int) -> Iterator[bytes]:
    """What is packed from byte `start` of the file on, in blocks of at most BLOCK bytes.

    A stream of gzip is one or more members. zlib compares the CRC-32 and the length of each, once it has been read to
    its end. Zero bytes behind a member are padding, as for the gzip tool. Anything else there the tool ignores with a
    warning; here it is damage, as for Python's gzip: it may have been a member of samples."""
    with open(path, "rb") as file:
        file.seek(start)
        waiting, first = file.read(PACKED), True
        while waiting or first:
            member = zlib.decompressobj(zlib.MAX_WBITS | 16)  # with the head and the checksums of gzip
            while not member.eof:
                try:
                    block = member.decompress(waiting, BLOCK)
                except zlib.error as error:
                    reason = str(error).rpartition(": ")[2]
                    raise damaged(path, FAULTS.get(reason, FAULT).format(reason)) from error
                if not (block or waiting or member.eof):
                    raise damaged(path, "it is cut short, for its packed part has no end")
                yield block
                waiting = member.unused_data if member.eof else member.unconsumed_tail or file.read(PACKED)
            first = False
            waiting = waiting.lstrip(b"\0")
            while not waiting and (more := file.read(PACKED)):
                waiting = more.lstrip(b"\0")
