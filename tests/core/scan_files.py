# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scan files written by the letter of their formats, independently of how they are read."""

from __future__ import annotations

import gzip
import io
import struct
import zipfile
from pathlib import Path

import numpy as np

NRRD_NAMES = {
    "u1": "uchar",
    "i1": "int8",
    "u2": "unsigned short",
    "i2": "short",
    "i4": "int",
    "u4": "uint32_t",
    "i8": "long long int",
    "f4": "float",
    "f8": "double",
}
NIFTI_CODES = {
    "u1": 2,
    "i2": 4,
    "i4": 8,
    "f4": 16,
    "f8": 64,
    "i1": 256,
    "u2": 512,
    "u4": 768,
    "i8": 1024,
}


def nrrd(values: np.ndarray, *lines: str, encoding: str = "raw", head: bool = True) -> bytes:
    """values: (nx, ny, nz). lines: further fields."""
    order = ">" if values.dtype.byteorder == ">" else "<"
    data = values.astype(values.dtype.newbyteorder(order)).tobytes(order="F")
    fields = [
        "NRRD0004",
        "# made for a test",
        "type: " + NRRD_NAMES[values.dtype.str[1:]],
        "dimension: 3",
        "sizes: {} {} {}".format(*values.shape),
        "encoding: " + encoding,
        "endian: " + ("big" if order == ">" else "little"),
        *lines,
    ]
    packed = gzip.compress(data) if encoding == "gzip" else data
    return "\n".join(fields).encode() + b"\n\n" + (packed if head else b"")


def nifti(
    values: np.ndarray,
    *,
    spacing=(1, 1, 1),
    unit: int = 2,
    sform=None,
    quaternion=None,
    qfac: float = 1.0,
    slope: float = 0.0,
    intercept: float = 0.0,
    dims: int = 3,
) -> bytes:
    """values: (nx, ny, nz). sform: (3, 4) rows. quaternion: b, c, d, x, y, z."""
    order = ">" if values.dtype.byteorder == ">" else "<"
    head = bytearray(352)
    struct.pack_into(order + "i", head, 0, 348)
    struct.pack_into(order + "8h", head, 40, dims, *values.shape, 1, 1, 1, 1)
    struct.pack_into(
        order + "2h", head, 70, NIFTI_CODES[values.dtype.str[1:]], 8 * values.dtype.itemsize
    )
    struct.pack_into(order + "8f", head, 76, qfac, *spacing, 0, 0, 0, 0)
    struct.pack_into(order + "3f", head, 108, 352.0, slope, intercept)
    head[123] = unit
    struct.pack_into(order + "2h", head, 252, int(quaternion is not None), int(sform is not None))
    if quaternion is not None:
        struct.pack_into(order + "6f", head, 256, *quaternion)
    if sform is not None:
        struct.pack_into(order + "12f", head, 280, *np.asarray(sform, float).reshape(-1))
    head[344:348] = b"n+1\0"
    return bytes(head) + values.astype(values.dtype.newbyteorder(order)).tobytes(order="F")


def npy(values: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, values)
    return stream.getvalue()


def npz(
    entries: dict[str, bytes],
    compression: int = zipfile.ZIP_DEFLATED,
    stream: io.BytesIO | None = None,
) -> bytes:
    """entries: array files by name."""
    stream = stream or io.BytesIO()
    with zipfile.ZipFile(stream, "w", compression) as archive:
        for name, entry in entries.items():
            archive.writestr(name + ".npy", entry)
    return stream.getvalue()


def written(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path
