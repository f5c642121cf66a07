# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""NIfTI files, https://nifti.nimh.nih.gov, of version 1 or 2: one file, raw or packed by gzip."""

from __future__ import annotations

import html
import math
import re
from contextlib import suppress
from pathlib import Path
from typing import Literal

import numpy as np

from ..files import (
    DAMAGE_CUT_SHORT,
    FILE_UNRECOGNIZED,
    Limits,
    damaged,
    parse_number,
    parse_whole,
    wrong_field,
)
from ..numerics import Array, rotation_matrix
from ..verdict import FileError
from .findings import SCAN_IN_SEVERAL_FILES, SCAN_SAMPLE_TYPE, SCAN_SIZE
from .labels import Label, read_color
from .scan import (
    Scan,
    map_samples,
    shape_of,
    unpack_samples,
    unpacked_blocks,
)

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
# The fields that matter: their shapes, and for versions 1 and 2 their types and offsets.
_FIELDS = {
    "magic": ((), ("S4", 344), ("S4", 4)),
    "dim": ((8,), ("i2", 40), ("i8", 16)),
    "datatype": ((), ("i2", 70), ("i2", 12)),
    "bitpix": ((), ("i2", 72), ("i2", 14)),
    "pixdim": ((8,), ("f4", 76), ("f8", 104)),
    "vox_offset": ((), ("f4", 108), ("i8", 168)),
    "scl_slope": ((), ("f4", 112), ("f8", 176)),
    "scl_inter": ((), ("f4", 116), ("f8", 184)),
    "xyzt_units": ((), ("u1", 123), ("i4", 500)),
    "qform_code": ((), ("i2", 252), ("i4", 344)),
    "sform_code": ((), ("i2", 254), ("i4", 348)),
    "quatern": ((6,), ("f4", 256), ("f8", 352)),
    "srow": ((3, 4), ("f4", 280), ("f8", 400)),
}
_ATTRIBUTE = re.compile(r"""(\w+)=["']([^"']*)["']""")
_VERSIONS = {348: 1, 540: 2}  # by the bytes of the header
_MAGICS = {1: (b"n+1", b"ni1"), 2: (b"n+2", b"ni2")}  # magic of one file, and of a pair of files


def read_nifti(path: Path, limits: Limits) -> Scan:
    """Read the scan as a memory map, or unpacked if it is gzipped."""
    is_packed = path.name.lower().endswith(".gz")
    header = _read_header(path, is_packed)
    if header["magic"][:2] == b"ni":  # a header whose samples are in another file
        raise FileError(SCAN_IN_SEVERAL_FILES, suffix=".nii")
    dim = header["dim"].tolist()
    if not 1 <= dim[0] <= 7:
        raise wrong_field("NIfTI", "dim", "1 to 7 dimensions", dim[0])
    sizes = dim[1 : dim[0] + 1]
    while len(sizes) > 3 and sizes[-1] == 1:  # the first three are those in space
        del sizes[-1]
    if len(sizes) > 3:
        raise FileError(SCAN_SIZE, samples=sizes)
    shape = shape_of(sizes)
    code = int(header["datatype"])
    if code not in TYPES:
        raise FileError(SCAN_SAMPLE_TYPE, type="NIfTI {}".format(code))
    byte_order = header.dtype["dim"].base.byteorder
    dtype = np.dtype(TYPES[code]).newbyteorder(byte_order)
    if header["bitpix"] not in (0, 8 * dtype.itemsize):
        raise wrong_field("NIfTI", "bitpix", "the size of its data type", header["bitpix"])
    offset = float(header["vox_offset"])
    # Chosen: no header is longer than a terabyte, and `int` takes no infinity.
    if not header.dtype.itemsize <= offset < 1 << 40 or offset != int(offset):
        raise wrong_field("NIfTI", "vox_offset", "a whole number behind the header", offset)
    matrix, is_placed = _sample_matrix(header)
    if is_packed:
        samples = unpack_samples(path, 0, dtype, shape, int(offset), limits)
    else:
        samples = map_samples(path, dtype, shape, int(offset))
    slope = float(header["scl_slope"])
    intercept = float(header["scl_inter"])
    if slope == 0.0 or math.isnan(slope):  # by the standard, and by its libraries: not scaled
        slope = 1.0
        intercept = 0.0
    unit = UNITS.get(int(header["xyzt_units"]) & 7)  # The higher bits have the unit of time.
    labels = {}
    if offset <= limits.header_bytes:
        # Four bytes between header and extensions state whether there are any.
        extensions = _first_bytes(path, is_packed, int(offset))[header.dtype.itemsize + 4 :]
        labels = _extension_labels(extensions, "big" if byte_order == ">" else "little")
    return Scan(samples, matrix, unit, is_placed, slope, intercept, usual_unit=1e-3, labels=labels)


def _extension_labels(extensions: bytes, order: Literal["little", "big"]) -> dict[int, Label]:
    """Return the labels of tables in the XML of a header's extensions.

    They are remarks, without effect on sums: a label that cannot be read is left out. order: of the
    bytes of numbers.
    """
    labels: dict[int, Label] = {}
    # Each extension begins with its size and its kind, of four bytes each.
    while len(extensions) > 8 and (size := int.from_bytes(extensions[:4], order)) >= 8:
        for element in extensions[8:size].decode("utf-8", "replace").split("<Label ")[1:]:
            attributes, _, content = element.partition(">")
            values = dict(_ATTRIBUTE.findall(attributes))
            name = content.partition("</Label>")[0].strip()
            name = name.removeprefix("<![CDATA[").removesuffix("]]>")
            with suppress(ValueError, KeyError):
                color = read_color(parse_number(values[key]) for key in ("Red", "Green", "Blue"))
                labels[parse_whole(values["Key"])] = Label(html.unescape(name).strip(), color)
        extensions = extensions[size:]
    return labels


def _first_bytes(path: Path, is_packed: bool, count: int) -> bytes:
    """Return the first bytes of a file, unpacked; fewer if it ends before."""
    if not is_packed:
        with open(path, "rb") as file:
            return file.read(count)
    head = b""
    for block in unpacked_blocks(path, 0, "gzip"):
        head += block
        if len(head) >= count:
            break
    return head[:count]


def _read_header(path: Path, is_packed: bool) -> np.void:
    """Return the fields of a header of either version and byte order. Raises FileError."""
    head = _first_bytes(path, is_packed, max(_VERSIONS))
    if len(head) < min(_VERSIONS):
        raise damaged(path, DAMAGE_CUT_SHORT, part="header")
    # The first number is the size of the header, which tells the byte order and the version.
    order = "<" if int.from_bytes(head[:4], "little") in _VERSIONS else ">"
    size = int.from_bytes(head[:4], "little" if order == "<" else "big")
    if size not in _VERSIONS:
        raise FileError(FILE_UNRECOGNIZED, format="NIfTI")
    if len(head) < size:
        raise damaged(path, DAMAGE_CUT_SHORT, part="header")
    version = _VERSIONS[size]
    fields = [(shape, *versions[version - 1]) for shape, *versions in _FIELDS.values()]
    layout = np.dtype(
        {
            "names": list(_FIELDS),
            "formats": [(order + kind, shape) for shape, kind, _ in fields],
            "offsets": [offset for _, _, offset in fields],
            "itemsize": size,
        }
    )
    header = np.frombuffer(head, layout, 1)[0]
    if header["magic"] not in _MAGICS[version]:
        raise FileError(FILE_UNRECOGNIZED, format="NIfTI")
    return header


def _sample_matrix(header: np.void) -> tuple[Array, bool]:
    """Return the (4, 4) matrix from sample indices to positions (affine, else quaternion, else
    spacing), and whether the header states it.
    """
    matrix = np.eye(4)
    pixdim = header["pixdim"].astype(np.float64)
    has_quaternion = header["qform_code"] > 0
    if header["sform_code"] > 0:
        matrix[:3] = header["srow"]
        return matrix, True
    spacing = np.abs(pixdim[1:4])
    if not all(0.0 < distance < math.inf for distance in spacing):
        if has_quaternion or pixdim[1:4].any():
            raise wrong_field(
                "NIfTI", "pixdim", "three spacings that are not zero", *spacing.tolist()
            )
        return matrix, False
    if not has_quaternion:
        matrix[:3, :3] = np.diag(spacing)
        return matrix, True
    b, c, d, *offset = header["quatern"].tolist()
    # Chosen: b² + c² + d² of a unit quaternion may exceed 1 by the rounding of float32 and a
    # hundred times that.
    if not all(map(math.isfinite, (b, c, d, *offset))) or b * b + c * c + d * d > 1.0 + 1e-5:
        raise wrong_field("NIfTI", "quatern", "a rotation", b, c, d, *offset)
    axes = rotation_matrix((math.sqrt(max(0.0, 1.0 - (b * b + c * c + d * d))), b, c, d))
    if pixdim[0] < 0.0:  # The format's “qfac”: the third axis is mirrored.
        axes[:, 2] *= -1.0
    matrix[:3, :3] = axes * spacing
    matrix[:3, 3] = offset
    return matrix, True
