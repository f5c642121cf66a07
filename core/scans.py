# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans and arrays of samples in files: .npy, .npz, NRRD (raw, gzip; attached or detached), NIfTI-1 (raw, gzip), raw.

A header says what the samples are and where they stand; nothing of it is believed before it has been compared with the
size of the file. Uncompressed samples are mapped into memory, so that a scan may be larger than it. Every fault of a
file is a ValueError with a sentence that says what is wrong.
"""

from __future__ import annotations

import gzip
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SUFFIXES = (".npy", ".npz", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".raw")
TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64")
DEFLATED = 1032  # bytes that a byte of a gzip file can hold, at most
HEADER = 1 << 20  # bytes of an NRRD header, at most
UNITS = {"m": 1.0, "meter": 1.0, "meters": 1.0, "cm": 1e-2, "mm": 1e-3, "millimeter": 1e-3, "millimeters": 1e-3,
         "um": 1e-6, "µm": 1e-6, "micron": 1e-6, "microns": 1e-6, "nm": 1e-9}


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


def suffix(path: str | Path) -> str:
    """What the file's name ends with, in lower case; "" where it is no scan's."""
    name = str(path).lower()
    return next((end for end in sorted(SUFFIXES, key=len, reverse=True) if name.endswith(end)), "")


def read_scan(path: str | Path) -> Scan:
    """The scan in a file, by its suffix. ValueError where it is none or damaged, OSError where it cannot be opened."""
    path = Path(path)
    read = {".npy": _read_npy, ".npz": _read_npz, ".nrrd": _read_nrrd, ".nhdr": _read_nrrd, ".nii": _read_nifti,
            ".nii.gz": _read_nifti, ".raw": _read_named_raw}.get(suffix(path))
    if read is None:
        raise ValueError("Files of this kind are no scans; these are: {:s}.".format(" ".join(SUFFIXES)))
    if not path.is_file():
        raise ValueError("There is no such file." if not path.exists() else "This is not a regular file.")
    try:
        scan = read(path)
    except (zlib.error, gzip.BadGzipFile, zipfile.BadZipFile, EOFError) as error:
        raise ValueError("The file is damaged or cut short: its compressed part cannot be unpacked.") from error
    except MemoryError as error:
        raise ValueError("The samples do not fit into memory; unpack the file, then they need not.") from error
    if not np.isfinite(scan.matrix).all() or not abs(np.linalg.det(scan.matrix[:3, :3])) > 0.0:
        raise ValueError("The header places all samples in one plane, or nowhere: its spacing or directions are zero "
                         "or not finite.")
    if not (math.isfinite(scan.slope) and math.isfinite(scan.intercept)):
        raise ValueError("The header scales the samples by numbers that are not finite.")
    return scan


def read_raw(path: str | Path, shape: Sequence[int], dtype: str, big_endian: bool = False, skip: int = 0) -> Scan:
    """Samples with no header: shape (nx, ny, nz), x running fastest; dtype: one of TYPES; skip: bytes before them."""
    if dtype not in TYPES:
        raise ValueError("The type “{:s}” is none of {:s}.".format(dtype, ", ".join(TYPES)))
    kind = np.dtype(dtype).newbyteorder(">" if big_endian else "<")
    return Scan(_mapped(Path(path), kind, _shape(shape), skip), np.eye(4))


def placed(scan: Scan, spacing: Sequence[float] | None, origin: Sequence[float] | None,
           unit_scale: float | None) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """(4, 4) where the samples stand in metres, and a sentence for each decision.

    spacing, origin: in place of the header's, in units of `unit_scale` metres, by default 1; axes x, y, z.
    """
    notes = []
    matrix = scan.matrix.copy()
    own = (unit_scale or 1.0) if scan.unit is None else scan.unit
    if scan.unit is not None and unit_scale is not None:
        notes.append("The file carries its own unit, which its own spacing and origin keep.")
    given = unit_scale or 1.0
    matrix[:3] *= own
    if spacing is not None:
        matrix[:3, :3] = np.diag(spacing) * given
    if origin is not None:
        matrix[:3, 3] = np.asarray(origin, float) * given
    if scan.placed and (spacing is not None or origin is not None):
        notes.append("The given {:s} took the place of the header's.".format(
            " and ".join(name for name, value in (("spacing", spacing), ("origin", origin)) if value is not None)))
    if not scan.placed and spacing is None:
        notes.append("The file does not say how far its samples are apart; 1 unit is taken (give a spacing).")
    elif scan.unit is None and unit_scale is None and spacing is None:
        notes.append("The file carries no unit; 1 unit is taken as 1 m (give a unit scale).")
    return matrix, tuple(notes)


def _shape(sizes: Sequence[int]) -> tuple[int, int, int]:
    """Three positive sizes; more only where they are 1."""
    sizes = tuple(int(size) for size in sizes)
    while len(sizes) > 3 and sizes[-1] == 1:
        sizes = sizes[:-1]
    if len(sizes) != 3:
        raise ValueError("It has {:d} dimensions, and a scan of densities has 3; save one volume of it.".format(
            len(sizes)))
    if min(sizes) < 1 or max(sizes) > 1 << 40 or math.prod(sizes) > 1 << 48:
        raise ValueError("Its size, {:s}, is impossible.".format(" x ".join(map(str, sizes))))
    return sizes


def _real(array: NDArray) -> NDArray:
    if array.dtype.kind not in "biuf":
        raise ValueError("Its samples are of the type {:s}, and a density is a real number.".format(str(array.dtype)))
    if array.ndim != 3:
        raise ValueError("It has {:d} dimensions, and a scan of densities has 3.".format(array.ndim))
    if not array.size:
        raise ValueError("It has no samples.")
    return array


def _mapped(path: Path, dtype: np.dtype, shape: tuple[int, int, int], offset: int, from_end: bool = False) -> NDArray:
    """Uncompressed samples, x fastest."""
    size, wanted = path.stat().st_size, dtype.itemsize * math.prod(shape)
    offset = size - wanted if from_end else offset
    if offset < 0 or size - offset < wanted:
        raise ValueError("The file is cut short: {:s} samples of {:d} bytes do not fit into it.".format(
            " x ".join(map(str, shape)), dtype.itemsize))
    return np.memmap(path, dtype, "r", offset, shape, "F")


def _unpacked(path: Path, start: int, dtype: np.dtype, shape: tuple[int, int, int], skip: int) -> NDArray:
    """Samples that are compressed by gzip from byte `start` of the file on, x fastest; skip: unpacked bytes before."""
    wanted = dtype.itemsize * math.prod(shape)
    if skip < 0 or skip + wanted > DEFLATED * path.stat().st_size:
        raise ValueError("The file is cut short: {:s} samples cannot be packed into it.".format(
            " x ".join(map(str, shape))))
    with open(path, "rb") as file:
        file.seek(start)
        with gzip.GzipFile(fileobj=file) as packed:
            packed.read(skip)
            data = packed.read(wanted)
    if len(data) < wanted:
        raise ValueError("The file is cut short: it holds {:d} of {:d} bytes of samples.".format(len(data), wanted))
    return np.frombuffer(data, dtype).reshape(shape, order="F")


def _read_npy(path: Path) -> Scan:
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except MemoryError:
        raise
    except Exception as error:  # of a damaged header NumPy evaluates what it finds, and may raise anything
        raise ValueError("The file is no whole array of numbers in NumPy's format.") from error
    return Scan(_real(array), np.eye(4))


def _read_npz(path: Path) -> Scan:
    try:
        with np.load(path, allow_pickle=False) as archive:
            names = list(archive.files)
            heads = {name: _npz_header(path, name) for name in names}
            volumes = [name for name, shape in heads.items() if len(shape) == 3]
            name = "density" if "density" in volumes else volumes[0] if volumes else None
            array = archive[name] if name else None
    except MemoryError:
        raise
    except Exception as error:  # as above, and whatever unpacking raises
        raise ValueError("The file is no whole archive of arrays in NumPy's format.") from error
    if array is None:
        raise ValueError("None of its arrays has 3 dimensions.")
    notes = ()
    if len(volumes) > 1:
        notes = ("Of its arrays “{:s}” is measured; left out: {:s}.".format(
            name, ", ".join("“{:s}”".format(one) for one in volumes if one != name)),)
    return Scan(_real(array), np.eye(4), notes=notes)


def _npz_header(path: Path, name: str) -> tuple[int, ...]:
    """The shape of an array in an archive, which must be able to hold it."""
    with zipfile.ZipFile(path) as archive, archive.open(name + ".npy") as file:
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = read(file)
        if dtype.itemsize * math.prod(shape) > archive.getinfo(name + ".npy").file_size:
            raise ValueError("cut short")
    return shape


def _read_named_raw(path: Path) -> Scan:
    """A raw file that is called NAME_XxYxZ_TYPE.raw, as those of the Open SciVis collection are."""
    found = re.search(r"_(\d+)x(\d+)x(\d+)_({:s})\.raw$".format("|".join(TYPES)), path.name, re.IGNORECASE)
    if not found:
        raise ValueError("A raw file does not say what is in it. Call it NAME_XxYxZ_TYPE.raw, for example "
                         "head_128x128x54_uint16.raw (x fastest, little-endian), or give it a detached NRRD header.")
    return read_raw(path, [int(size[:20]) for size in found.groups()[:3]], found[4].lower())


NRRD_TYPES = {name: dtype for dtype, names in {
    "i1": "signed char,int8,int8_t", "u1": "uchar,unsigned char,uint8,uint8_t",
    "i2": "short,short int,signed short,signed short int,int16,int16_t",
    "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t", "i4": "int,signed int,int32,int32_t",
    "u4": "uint,unsigned int,uint32,uint32_t",
    "i8": "longlong,long long,long long int,signed long long,signed long long int,int64,int64_t",
    "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t", "f4": "float", "f8": "double",
}.items() for name in names.split(",")}


def _read_nrrd(path: Path) -> Scan:
    with open(path, "rb") as file:
        head = file.read(HEADER)
    if not re.match(rb"NRRD000[1-5]\r?\n", head):
        raise ValueError("The file does not begin as an NRRD file does (NRRD0001 to NRRD0005).")
    end = re.search(rb"\r?\n\r?\n", head)
    fields = {}
    text = head[:end.start() if end else len(head)].decode("latin-1")
    for line in text.splitlines()[1:]:
        if line.startswith("#") or ":=" in line:
            continue
        name, colon, value = line.partition(":")
        if colon:
            fields[name.strip().lower()] = value.strip()
    return _nrrd(path, fields, end.end() if end else None)


def _nrrd(path: Path, fields: dict[str, str], start: int | None) -> Scan:
    def needed(name: str) -> str:
        if name not in fields:
            raise ValueError("The NRRD header lacks the field “{:s}”.".format(name))
        return fields[name]

    def numbers(name: str, kind: type, default: str = "") -> list:
        try:
            return [kind(word) for word in fields.get(name, default).split()]
        except (ValueError, OverflowError):
            raise ValueError("The NRRD field “{:s}” is no row of numbers: {:.60s}.".format(
                name, fields[name])) from None

    sizes = numbers("sizes", int) if needed("sizes") else []
    if numbers("dimension", int) != [len(sizes)] or not needed("dimension"):
        raise ValueError("The NRRD fields “dimension” and “sizes” do not agree.")
    shape = _shape(sizes)
    kind = NRRD_TYPES.get(needed("type").lower())
    if kind is None:
        raise ValueError("The NRRD type “{:.40s}” is no real number.".format(fields["type"]))
    dtype = np.dtype(kind)
    endian = fields.get("endian", "").lower()
    if dtype.itemsize > 1 and endian not in ("little", "big"):
        raise ValueError("The NRRD header does not say in which order bytes stand (the field “endian”).")
    dtype = dtype.newbyteorder(">" if endian == "big" else "<")
    matrix, placed_, unit = _nrrd_place(fields, numbers)
    (line_skip,), (byte_skip,) = (_one(numbers(name, int, "0"), name)
                                  for name in (_alias(fields, "line skip"), _alias(fields, "byte skip")))
    source, name = path, fields.get("data file", fields.get("datafile"))
    if name is not None:
        if name.upper().startswith("LIST") or "%" in name or len(name.split()) > 3:
            raise ValueError("Its samples are spread over several files; join them into one.")
        source, start = path.parent / name, 0
        if not source.is_file():
            raise ValueError("The file of its samples, “{:.80s}”, is not there.".format(name))
    elif start is None:
        raise ValueError("The NRRD header has no end: the empty line before the samples is missing.")
    if line_skip:
        start = _after_lines(source, start, line_skip)
    encoding = needed("encoding").lower()
    if encoding == "raw":
        samples = _mapped(source, dtype, shape, start + max(byte_skip, 0), from_end=byte_skip == -1)
    elif encoding in ("gzip", "gz"):
        samples = _unpacked(source, start, dtype, shape, byte_skip)
    else:
        raise ValueError("The NRRD encoding “{:.40s}” is not supported; save it raw or packed by gzip.".format(
            encoding))
    return Scan(samples, matrix, unit, placed_)


def _one(values: list, name: str) -> list:
    if len(values) != 1 or values[0] < -1:
        raise ValueError("The NRRD field “{:s}” is not one number.".format(name))
    return values


def _alias(fields: dict[str, str], name: str) -> str:
    """NRRD fields may be written without their space."""
    return name if name in fields else name.replace(" ", "")


def _after_lines(path: Path, start: int, count: int) -> int:
    with open(path, "rb") as file:
        file.seek(start)
        for _ in range(count):
            if not file.readline(HEADER).endswith(b"\n"):
                raise ValueError("The file is cut short: it has not the lines that its header tells to skip.")
        return file.tell()


def _nrrd_place(fields: dict[str, str], numbers) -> tuple[NDArray[np.float64], bool, float | None]:
    """Where the samples stand, whether the header says so, and in which unit."""
    matrix = np.eye(4)
    words = re.findall(r'"([^"]*)"', fields.get("space units", fields.get("units", "")))
    units = {UNITS.get(word.strip().lower()) for word in words[:3]}
    unit = units.pop() if len(units) == 1 else None
    if "space directions" in fields:
        rows = [_vector(text, "space directions") for text in re.findall(r"\([^)]*\)|none", fields["space directions"])]
        rows = [row for row in rows if row is not None]
        if len(rows) != 3:
            raise ValueError("The NRRD field “space directions” does not have three vectors.")
        matrix[:3, :3] = np.array(rows).T
        if "space origin" in fields:
            origin = _vector(fields["space origin"], "space origin")
            matrix[:3, 3] = np.zeros(3) if origin is None else origin
        return matrix, True, unit
    spacings = numbers("spacings", float)
    if spacings:
        if len(spacings) < 3 or not all(0.0 < abs(one) < math.inf for one in spacings[:3]):
            raise ValueError("The NRRD field “spacings” must have three numbers other than zero.")
        matrix[:3, :3] = np.diag(spacings[:3])
    mins = numbers(_alias(fields, "axis mins"), float)
    if len(mins) >= 3 and np.isfinite(mins[:3]).all():
        matrix[:3, 3] = mins[:3]
    return matrix, bool(spacings), unit


def _vector(text: str, name: str) -> list[float] | None:
    if text == "none":
        return None
    try:
        row = [float(word) for word in text.strip().strip("()").split(",")]
    except ValueError:
        row = []
    if len(row) != 3 or not np.isfinite(row).all():
        raise ValueError("The NRRD field “{:s}” has a vector that is not three numbers: {:.60s}.".format(name, text))
    return row


NIFTI_TYPES = {2: "u1", 4: "i2", 8: "i4", 16: "f4", 64: "f8", 256: "i1", 512: "u2", 768: "u4", 1024: "i8", 1280: "u8"}
NIFTI_UNITS = {1: 1.0, 2: 1e-3, 3: 1e-6}


def _read_nifti(path: Path) -> Scan:
    packed = suffix(path) == ".nii.gz"
    with gzip.open(path) if packed else open(path, "rb") as file:
        head = file.read(348)
    if len(head) < 348:
        raise ValueError("The file is cut short: a NIfTI-1 header has 348 bytes.")
    order = next((mark for mark in "<>" if struct.unpack_from(mark + "i", head)[0] == 348), None)
    if order is None or head[344:348] not in (b"n+1\0", b"ni1\0"):
        raise ValueError("The file does not begin as a NIfTI-1 file does.")
    if head[344:348] == b"ni1\0":
        raise ValueError("It is the header of a pair .hdr and .img; save it as one .nii file.")
    dim = struct.unpack_from(order + "8h", head, 40)
    if not 1 <= dim[0] <= 7:
        raise ValueError("The NIfTI header tells of {:d} dimensions.".format(dim[0]))
    shape = _shape(dim[1:dim[0] + 1])
    code, bits = struct.unpack_from(order + "2h", head, 70)
    if code not in NIFTI_TYPES:
        raise ValueError("The NIfTI data type {:d} is no real number that can be read.".format(code))
    dtype = np.dtype(NIFTI_TYPES[code]).newbyteorder(order)
    if bits not in (0, 8 * dtype.itemsize):
        raise ValueError("The NIfTI header contradicts itself: {:d} bits for the data type {:d}.".format(bits, code))
    offset, slope, intercept = struct.unpack_from(order + "3f", head, 108)
    if not 348.0 <= offset < 1 << 40 or offset != int(offset):
        raise ValueError("The NIfTI header tells an impossible place of the samples, {:g}.".format(offset))
    matrix, placed_ = _nifti_place(head, order)
    samples = _unpacked(path, 0, dtype, shape, int(offset)) if packed else _mapped(path, dtype, shape, int(offset))
    if slope == 0.0:  # by the standard: not scaled
        slope, intercept = 1.0, 0.0
    return Scan(samples, matrix, NIFTI_UNITS.get(head[123] & 7), placed_, slope, intercept)


def _nifti_place(head: bytes, order: str) -> tuple[NDArray[np.float64], bool]:
    """By the standard's three methods: the affine, else the quaternion, else the spacing alone."""
    matrix = np.eye(4)
    pixdim = struct.unpack_from(order + "8f", head, 76)
    qform, sform = struct.unpack_from(order + "2h", head, 252)
    b, c, d, *offset = struct.unpack_from(order + "6f", head, 256)
    if sform > 0:
        matrix[:3] = np.array(struct.unpack_from(order + "12f", head, 280)).reshape(3, 4)
        return matrix, True
    spacing = np.abs(pixdim[1:4])
    if not all(0.0 < one < math.inf for one in spacing):
        if qform > 0 or any(pixdim[1:4]):
            raise ValueError("The NIfTI header tells an impossible spacing, {:g} x {:g} x {:g}.".format(*spacing))
        return matrix, False
    if qform > 0:
        if not all(map(math.isfinite, (b, c, d, *offset))) or b * b + c * c + d * d > 1.0 + 1e-5:
            raise ValueError("The NIfTI header tells a rotation that is none.")
        a = math.sqrt(max(0.0, 1.0 - (b * b + c * c + d * d)))
        turn = np.array([[a*a + b*b - c*c - d*d, 2*(b*c - a*d), 2*(b*d + a*c)],
                         [2*(b*c + a*d), a*a + c*c - b*b - d*d, 2*(c*d - a*b)],
                         [2*(b*d - a*c), 2*(c*d + a*b), a*a + d*d - b*b - c*c]])
        turn[:, 2] *= -1.0 if pixdim[0] < 0.0 else 1.0
        matrix[:3, :3], matrix[:3, 3] = turn * spacing, offset
        return matrix, True
    matrix[:3, :3] = np.diag(spacing)
    return matrix, True
