# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""NIfTI-1 files, https://nifti.nimh.nih.gov/nifti-1: one file, raw or packed by gzip."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..files.damage import damaged, wrong_field
from ..files.findings import DAMAGE_CUT_SHORT, FILE_UNRECOGNIZED
from ..files.limits import Limits
from ..numerics.rotations import rotation_matrix
from ..verdict.finding import FileError
from .findings import SCAN_IN_SEVERAL_FILES, SCAN_SAMPLE_TYPE
from .scan import (
    Scan,
    gzip_blocks,
    map_samples,
    shape_of,
    unpack_samples,
)

HEADER = 348  # bytes
TYPES = {
    2: "u1",
    4: "i2",
    8: "i4",
    16: "f4",
    64: "f8",
    256: "i1",
    512: "u2",
    768: "u4",
    1024: "i8",
    1280: "u8",
}
UNITS = {1: 1.0, 2: 1e-3, 3: 1e-6}
ByteOrder: TypeAlias = Literal["<", ">"]
BYTE_ORDERS: tuple[ByteOrder, ...] = ("<", ">")


def read_nifti(path: Path, limits: Limits) -> Scan:
    """Read the scan as a memory map, or unpacked if it is gzipped."""
    packed = path.name.lower().endswith(".gz")
    head = _head(path, packed)
    if len(head) < HEADER:
        raise damaged(path, DAMAGE_CUT_SHORT, part="header")
    order: ByteOrder | None = next(
        (mark for mark in BYTE_ORDERS if struct.unpack_from(mark + "i", head)[0] == 348), None
    )
    if order is None or head[344:348] not in (b"n+1\0", b"ni1\0"):
        raise FileError(FILE_UNRECOGNIZED, format="NIfTI-1")
    if head[344:348] == b"ni1\0":
        raise FileError(SCAN_IN_SEVERAL_FILES, suffix=".nii")
    dim = struct.unpack_from(order + "8h", head, 40)
    if not 1 <= dim[0] <= 7:
        raise wrong_field("NIfTI", "dim", "1 to 7 dimensions", dim[0])
    shape = shape_of(dim[1 : dim[0] + 1])
    code, bits = struct.unpack_from(order + "2h", head, 70)
    if code not in TYPES:
        raise FileError(SCAN_SAMPLE_TYPE, type="NIfTI {}".format(code))
    dtype = np.dtype(TYPES[code]).newbyteorder(order)
    if bits not in (0, 8 * dtype.itemsize):
        raise wrong_field("NIfTI", "bitpix", "the size of its data type", bits)
    offset, slope, intercept = struct.unpack_from(order + "3f", head, 108)
    if not 348.0 <= offset < 1 << 40 or offset != int(offset):
        raise wrong_field("NIfTI", "vox_offset", "a whole number behind the header", offset)
    matrix, placed = _sample_matrix(head, order)
    if packed:
        samples = unpack_samples(path, 0, dtype, shape, int(offset), limits)
    else:
        samples = map_samples(path, dtype, shape, int(offset))
    if slope == 0.0:  # by the standard: not scaled
        slope, intercept = 1.0, 0.0
    return Scan(samples, matrix, UNITS.get(head[123] & 7), placed, slope, intercept)


def _head(path: Path, packed: bool) -> bytes:
    if not packed:
        with open(path, "rb") as file:
            return file.read(HEADER)
    head = b""
    for block in gzip_blocks(path, 0):
        head += block[: HEADER - len(head)]
        if len(head) == HEADER:
            break
    return head


def _sample_matrix(head: bytes, order: str) -> tuple[NDArray[np.float64], bool]:
    """Return the matrix of the samples (affine, else quaternion, else spacing), and whether the
    header states it.
    """
    matrix = np.eye(4)
    pixdim = struct.unpack_from(order + "8f", head, 76)
    qform, sform = struct.unpack_from(order + "2h", head, 252)
    b, c, d, *offset = struct.unpack_from(order + "6f", head, 256)
    if sform > 0:
        matrix[:3] = np.array(struct.unpack_from(order + "12f", head, 280)).reshape(3, 4)
        return matrix, True
    spacing = np.abs(pixdim[1:4])
    if not all(0.0 < distance < math.inf for distance in spacing):
        if qform > 0 or any(pixdim[1:4]):
            raise wrong_field(
                "NIfTI", "pixdim", "three spacings that are not zero", *spacing.tolist()
            )
        return matrix, False
    if qform > 0:
        if not all(map(math.isfinite, (b, c, d, *offset))) or b * b + c * c + d * d > 1.0 + 1e-5:
            raise wrong_field("NIfTI", "quatern", "a rotation", b, c, d, *offset)
        a = math.sqrt(max(0.0, 1.0 - (b * b + c * c + d * d)))
        turn = rotation_matrix((a, b, c, d))
        turn[:, 2] *= -1.0 if pixdim[0] < 0.0 else 1.0
        matrix[:3, :3] = turn * spacing
        matrix[:3, 3] = offset
        return matrix, True
    matrix[:3, :3] = np.diag(spacing)
    return matrix, True
