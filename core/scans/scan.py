# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The samples of a scan in a file: mapped into memory where they are not packed, so that a scan may be larger than it.

Nothing that a header says of them is believed before it has been compared with the size of the file. Every fault of a
file is a FileError that says what is wrong.
"""

from __future__ import annotations

import gzip
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import FileError, Finding

DEFLATED = 1032  # bytes that a byte of a gzip file can hold, at most


@dataclass(frozen=True, eq=False)
class Scan:
    """samples: (nx, ny, nz), any real type, perhaps a memory map; a sample stands for slope · sample + intercept.
    matrix: (4, 4), the sample (i, j, k) stands at matrix @ (i, j, k, 1), in units of `unit` metres (None: the file does
    not say). placed: whether the file says where samples stand. findings: what was decided on the way."""

    samples: NDArray
    matrix: NDArray[np.float64]
    unit: float | None = None
    placed: bool = False
    slope: float = 1.0
    intercept: float = 0.0
    findings: tuple[Finding, ...] = ()


def shape_of(sizes: Sequence[int]) -> tuple[int, int, int]:
    """Three positive sizes; more only where they are 1."""
    sizes = tuple(int(size) for size in sizes)
    while len(sizes) > 3 and sizes[-1] == 1:
        sizes = sizes[:-1]
    if len(sizes) != 3:
        raise FileError("scan_dimensions", dimensions=len(sizes))
    if min(sizes) < 1 or max(sizes) > 1 << 40 or math.prod(sizes) > 1 << 48:
        raise FileError("scan_size", samples=list(sizes))
    return sizes


def real_samples(array: NDArray) -> NDArray:
    """An array that can be a scan of densities."""
    if array.dtype.kind not in "biuf":
        raise FileError("scan_sample_type", type=str(array.dtype))
    if array.ndim != 3:
        raise FileError("scan_dimensions", dimensions=array.ndim)
    if not array.size:
        raise FileError("scan_empty")
    return array


def mapped(path: Path, dtype: np.dtype, shape: tuple[int, int, int], offset: int, from_end: bool = False) -> NDArray:
    """Uncompressed samples, x fastest."""
    size, wanted = path.stat().st_size, dtype.itemsize * math.prod(shape)
    offset = size - wanted if from_end else offset
    if offset < 0 or size - offset < wanted:
        raise FileError("scan_cut_short", samples=list(shape))
    return np.memmap(path, dtype, "r", offset, shape, "F")


def unpacked(path: Path, start: int, dtype: np.dtype, shape: tuple[int, int, int], skip: int) -> NDArray:
    """Samples that are compressed by gzip from byte `start` of the file on, x fastest; skip: unpacked bytes before."""
    wanted = dtype.itemsize * math.prod(shape)
    if skip < 0 or skip + wanted > DEFLATED * path.stat().st_size:
        raise FileError("scan_cut_short", samples=list(shape))
    with open(path, "rb") as file:
        file.seek(start)
        with gzip.GzipFile(fileobj=file) as packed:
            packed.read(skip)
            data = packed.read(wanted)
    if len(data) < wanted:
        raise FileError("scan_bytes_missing", bytes=len(data), total=wanted)
    return np.frombuffer(data, dtype).reshape(shape, order="F")
