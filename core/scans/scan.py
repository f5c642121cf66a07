# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The samples of a scan in a file: a memory map if they are not packed, so that they may be larger
than memory.

A header is compared with the size of the file, and packed samples with their checksum, before they
are used. Every fault of a file is a FileError that names the fault.
"""

from __future__ import annotations

import bz2
import gzip
import math
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..files import DAMAGE_CUT_SHORT, DAMAGE_INCOMPLETE, DAMAGE_SIZE, Limits, check_length, damaged
from ..numerics import Array, NDArray
from ..verdict import FileError, Finding
from .findings import SCAN_SAMPLE_TYPE, SCAN_SIZE
from .labels import Label

# Most bytes that one byte of a packed file can unpack to; bzip2 packs 900 kB of zeros in 39 bytes.
MAX_RATIOS = {"gzip": 1032, "bzip2": 23_077}
STREAMS = {"gzip": "gzip stream", "bzip2": "bzip2 stream"}
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
    usual_unit : float or None
        Meters per unit that readers of such a file assume if it states none.
    slope, intercept : float
    findings : tuple of Finding
        Decisions made on the way.
    labels : mapping of int to Label
        Names and colors of labels in the header.

    Examples
    --------
    >>> from body_moments.core.scans import Scan
    >>> Scan(np.zeros((2, 2, 2)), np.eye(4)).is_placed
    False
    """

    samples: NDArray
    matrix: Array
    unit: float | None = None
    is_placed: bool = False
    slope: float = 1.0
    intercept: float = 0.0
    findings: tuple[Finding, ...] = ()
    usual_unit: float | None = None
    labels: Mapping[int, Label] = field(default_factory=dict)


def space_axes(sizes: Sequence[int]) -> list[int]:
    """Return the indices of the three axes in space. If there are more than three, axes of one
    sample are left out at the end, else at the beginning.

    FileError if three axes are not left, or their sizes are not possible.
    """
    axes = list(range(len(sizes)))
    while len(axes) > 3 and 1 in (sizes[axes[-1]], sizes[axes[0]]):
        del axes[-1 if sizes[axes[-1]] == 1 else 0]
    space = [int(sizes[axis]) for axis in axes]
    # Chosen: more samples fit into no file, and their bytes, up to 8 times as many, into int64.
    if len(axes) != 3 or min(space) < 1 or max(space) > 1 << 40 or math.prod(space) > 1 << 48:
        raise FileError(SCAN_SIZE, samples=list(sizes))
    return axes


def shape_of(sizes: Sequence[int]) -> tuple[int, int, int]:
    """Return the sizes of the three axes in space. FileError if they are not possible."""
    x, y, z = (int(sizes[axis]) for axis in space_axes(sizes))
    return x, y, z


def real_samples(array: NDArray) -> NDArray:
    """Return the array as (nx, ny, nz), without other axes. FileError if it has no real numbers, or
    no three axes in space.
    """
    if array.dtype.kind not in "biuf":
        raise FileError(SCAN_SAMPLE_TYPE, type=str(array.dtype))
    return array.reshape(shape_of(array.shape), order="A")


def map_samples(
    path: Path, dtype: np.dtype, shape: tuple[int, int, int], offset: int, from_end: bool = False
) -> NDArray:
    """Return a memory map of samples, x fastest, from byte `offset` to the end of the file.

    from_end: they are the last bytes of the file, and `offset` is the first that they may be.
    FileError if there are more or fewer bytes.
    """
    size = path.stat().st_size
    byte_count = dtype.itemsize * math.prod(shape)
    if from_end:
        offset = max(offset, size - byte_count)
    check_length(path, max(0, size - offset), byte_count)
    return np.memmap(path, dtype, "r", offset, shape, "F")


def unpack_samples(
    path: Path,
    start: int,
    dtype: np.dtype,
    shape: tuple[int, int, int],
    skip: int,
    limits: Limits,
    packing: str = "gzip",
) -> NDArray:
    """Return samples, x fastest, that are packed from byte `start` on; check all checksums.

    skip: count of unpacked bytes before the samples. packing: gzip or bzip2. FileError if there are
    more or fewer bytes.
    """
    byte_count = dtype.itemsize * math.prod(shape)
    total = skip + byte_count
    largest = MAX_RATIOS[packing] * path.stat().st_size
    if total > largest:  # before memory is taken for them
        raise damaged(path, DAMAGE_SIZE, bytes=max(0, largest - skip), total=byte_count)
    limits.check(path, "unpacked_bytes", total)
    unpacked = np.empty(total, np.uint8)
    done = 0
    for block in unpacked_blocks(path, start, packing):
        part = np.frombuffer(block, np.uint8)[: total - done]
        unpacked[done : done + len(part)] = part
        done += len(block)
        if done > total:  # There are too many bytes, by how many does not matter.
            break
    check_length(path, max(0, done - skip), byte_count)
    return unpacked[skip:].view(dtype).reshape(shape, order="F")


def unpacked_blocks(path: Path, start: int, packing: str) -> Iterator[bytes]:
    """Yield the unpacked data from byte `start` of a file on, in blocks of at most BLOCK bytes.

    The libraries compare the checksum of each member. Zero bytes behind a member of gzip are
    padding; anything else there is damage: it may have been a member of samples. Behind those of
    bzip2, it is ignored.
    """
    with open(path, "rb") as file:
        file.seek(start)
        members = bz2.BZ2File(file) if packing == "bzip2" else gzip.GzipFile(fileobj=file)
        try:
            while block := members.read(BLOCK):
                yield block
        except EOFError as error:
            raise damaged(path, DAMAGE_CUT_SHORT, part="compressed part") from error
        except (zlib.error, OSError) as error:
            reason = str(error).rpartition(": ")[2]
            raise damaged(path, DAMAGE_INCOMPLETE, kind=STREAMS[packing], error=reason) from error


def parse_samples(
    path: Path, start: int, dtype: np.dtype, shape: tuple[int, int, int], limits: Limits
) -> NDArray:
    """Return samples, x fastest, that are a text from byte `start` on, separated by spaces or
    commas.
    """
    limits.check(path, "text_bytes", path.stat().st_size - start)
    with open(path, "rb") as file:
        file.seek(start)
        words = file.read().replace(b",", b" ").split()
    count = math.prod(shape)
    if len(words) != count:
        reason = "{} of {} numbers".format(len(words), count)
        raise damaged(path, DAMAGE_INCOMPLETE, kind="table of samples", error=reason)
    try:
        samples = np.array(words).astype(dtype)
    except (ValueError, OverflowError) as error:
        reason = "a sample is no number of type {}".format(dtype.name)
        raise damaged(path, DAMAGE_INCOMPLETE, kind="table of samples", error=reason) from error
    return samples.reshape(shape, order="F")
