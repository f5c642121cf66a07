# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays in NumPy's files, .npy and .npz, and raw samples without a header, whose shape and type their name tells."""

from __future__ import annotations

import math
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .scan import Scan, check_length, damaged, mapped, real_samples, shape_of

TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64")
ENTRY = b"PK\1\2"  # how an entry of a zip archive's directory begins


def read_npy(path: Path) -> Scan:
    """The array, mapped."""
    try:
        array = np.lib.format.open_memmap(path, mode="r")
    except MemoryError:
        raise
    except Exception as error:  # of a damaged header NumPy evaluates what it finds, and may raise anything
        raise damaged(path, "it is no whole array of numbers in NumPy's format") from error
    real_samples(array)
    check_length(path, path.stat().st_size - array.offset, array.nbytes)
    return Scan(array, np.eye(4))


def read_npz(path: Path) -> Scan:
    """The array called “density”, else the first of three dimensions. It is read to the end of its entry, where
    zipfile compares the checksum; of the others the headers alone are read."""
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            if any(ENTRY in entry.comment + entry.extra for entry in entries):
                raise zipfile.BadZipFile("an entry of its directory hides the next")  # by a wrong length
            heads = {entry.filename: _npz_header(archive, entry) for entry in entries}
            volumes = [name.removesuffix(".npy") for name, shape in heads.items() if len(shape) == 3]
            name = "density" if "density" in volumes else volumes[0] if volumes else None
            if name:
                with archive.open(name + ".npy") as file:
                    array = np.lib.format.read_array(file, allow_pickle=False)
    except MemoryError:
        raise
    except zipfile.BadZipFile as error:
        raise damaged(path, "it is no whole archive ({:s})".format(str(error).rstrip("."))) from error
    except Exception as error:  # as above, and whatever unpacking raises
        raise damaged(path, "it is no whole archive of arrays in NumPy's format") from error
    if not name:
        raise ValueError("None of its arrays has 3 dimensions.")
    notes = ()
    if len(volumes) > 1:
        notes = (
            "Of its arrays “{:s}” is measured; left out: {:s}.".format(
                name, ", ".join("“{:s}”".format(one) for one in volumes if one != name)
            ),
        )
    return Scan(real_samples(array), np.eye(4), notes=notes)


def _npz_header(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> tuple[int, ...]:
    """The shape of an array in an archive, which must fill its entry: beyond the array no checksum would be reached."""
    with archive.open(entry) as file:
        version = np.lib.format.read_magic(file)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = read(file)
        if not dtype.hasobject and file.tell() + dtype.itemsize * math.prod(shape) != entry.file_size:
            raise ValueError("The array does not fill its entry.")
    return shape


def read_raw(path: str | Path, shape: Sequence[int], dtype: str, big_endian: bool = False) -> Scan:
    """Samples with no header: shape (nx, ny, nz), x running fastest; dtype: one of TYPES."""
    if dtype not in TYPES:
        raise ValueError("The type “{:s}” is none of {:s}.".format(dtype, ", ".join(TYPES)))
    kind = np.dtype(dtype).newbyteorder(">" if big_endian else "<")
    return Scan(mapped(Path(path), kind, shape_of(shape), 0), np.eye(4))


def read_named_raw(path: Path) -> Scan:
    """A raw file that is called NAME_XxYxZ_TYPE.raw, as those of the Open SciVis collection are."""
    found = re.search(r"_(\d+)x(\d+)x(\d+)_({:s})\.raw$".format("|".join(TYPES)), path.name, re.IGNORECASE)
    if not found:
        raise ValueError(
            "A raw file does not say what is in it. Call it NAME_XxYxZ_TYPE.raw, for example "
            "head_128x128x54_uint16.raw (x fastest, little-endian), or give it a detached NRRD header."
        )
    return read_raw(path, [int(size[:20]) for size in found.groups()[:3]], found[4].lower())
