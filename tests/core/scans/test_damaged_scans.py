# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A damaged scan is refused or gives the numbers of the whole one: every bit flipped, cut
everywhere, and overlong.

Formats without a checksum are named in UNCHECKED: there a flipped bit of a sample goes unnoticed, a
wrong length does not.
"""

import gzip
import io
import random
import tracemalloc
import zipfile
import zlib
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.scans import read_scan
from body_moments.core.scans import scan as samples
from body_moments.core.verdict import FileError
from body_moments.tests.core.scan_files import nifti, npy, npz, nrrd, written

pytestmark = pytest.mark.filterwarnings("ignore")  # NumPy's, of headers that it can still make out

VALUES = np.random.default_rng(9).integers(0, 999, (3, 4, 5)).astype("u2")
NIFTI = nifti(VALUES, spacing=(2, 3, 4))
PAYLOAD = VALUES.tobytes(order="F")
NPY = npy(VALUES)


class Unseekable(io.BytesIO):
    """Write as zipfile does with data descriptors."""

    def seekable(self):
        return False

    def seek(self, *_):
        raise io.UnsupportedOperation


def archive(compression: int, entry: bytes, stream: io.BytesIO | None = None) -> bytes:
    other = NPY.replace(b"(3, 4, 5)", b"(5, 4, 3)")
    return npz({"other": other, "density": entry}, compression, stream)


def members(data: bytes) -> bytes:
    """Three members, one of them empty, and padding."""
    return gzip.compress(data[:400]) + gzip.compress(b"") + gzip.compress(data[400:], 1) + bytes(9)


GZ_NRRD = nrrd(VALUES, "spacings: 2 3 4", encoding="gzip")
# the file that is read, the one that is damaged, what it holds, and from which byte on a checksum
# holds good
CHECKED = {
    "npz stored": ("a.npz", "a.npz", archive(zipfile.ZIP_STORED, NPY), 0),
    "npz deflated": ("a.npz", "a.npz", archive(zipfile.ZIP_DEFLATED, NPY), 0),
    "npz streamed": ("a.npz", "a.npz", archive(zipfile.ZIP_DEFLATED, NPY, Unseekable()), 0),
    "nii.gz": ("a.nii.gz", "a.nii.gz", gzip.compress(NIFTI), 0),
    "nii.gz of members": ("a.nii.gz", "a.nii.gz", members(NIFTI), 0),
    "nrrd gzip": ("a.nrrd", "a.nrrd", GZ_NRRD, GZ_NRRD.index(b"\n\n") + 2),
    "nhdr gzip": ("a.nhdr", "a.raw.gz", gzip.compress(PAYLOAD), 0),
}
UNCHECKED = {
    "npy": ("a.npy", "a.npy", NPY, None),
    "nii": ("a.nii", "a.nii", NIFTI, None),
    "nrrd raw": ("a.nrrd", "a.nrrd", nrrd(VALUES, "spacings: 2 3 4"), None),
    "nhdr raw": ("a.nhdr", "a.raw", PAYLOAD, None),
    "raw": ("a_3x4x5_uint16.raw", "a_3x4x5_uint16.raw", PAYLOAD, None),
}
FORMATS = CHECKED | UNCHECKED


class Files:
    """A file of a format, whole or damaged."""

    def __init__(self, folder: Path, name: str):
        read, target, self.data, self.checked = FORMATS[name]
        self.path, self.target = folder / read, folder / target
        if read != target:
            encoding = "gzip" if target.endswith("gz") else "raw"
            written(self.path, nrrd(VALUES, "data file: " + target, encoding=encoding, head=False))
        self.whole = self.numbers(self.data)
        assert self.whole is not None

    def numbers(self, data: bytes):
        """Return all values that decide the mass, or None if the file is refused."""
        self.target.write_bytes(data)
        try:
            scan = read_scan(self.path)
        except FileError as error:
            assert str(error).endswith("."), error
            return None
        return (
            scan.samples.dtype.str,
            scan.samples.shape,
            scan.samples.tobytes(),
            scan.matrix.tolist(),
            scan.unit,
            scan.slope,
            scan.intercept,
        )

    def flipped(self, bit: int):
        data = bytearray(self.data)
        data[bit // 8] ^= 1 << bit % 8
        return self.numbers(bytes(data))


@pytest.mark.parametrize("name", CHECKED)
def test_a_flipped_bit_under_a_checksum_changes_no_number(tmp_path, name):
    files, refused = Files(tmp_path, name), 0
    bits = range(8 * files.checked, 8 * len(files.data))
    if len(bits) > 4000:  # an archive: its first header, its directory, and some bits between
        bits = (*bits[:400], *random.Random(name).sample(bits[400:-1120], 500), *bits[-1120:])
    for bit in bits:
        found = files.flipped(bit)
        assert found is None or found == files.whole, "byte {} of {}".format(
            bit // 8, len(files.data)
        )
        refused += found is None
    assert refused > len(bits) // 3


@pytest.mark.parametrize("name", UNCHECKED)
def test_flipped_bit_without_checksum_keeps_the_sample_count(tmp_path, name):
    files = Files(tmp_path, name)
    for bit in range(0, 8 * len(files.data), 5):
        found = files.flipped(bit)
        assert found is None or len(found[2]) == len(PAYLOAD), "byte {} of {}".format(
            bit // 8, len(files.data)
        )


@pytest.mark.parametrize("name", FORMATS)
def test_a_file_cut_anywhere_is_refused(tmp_path, name):
    files = Files(tmp_path, name)
    for length in range(
        len(files.data.rstrip(b"\0") if name == "nii.gz of members" else files.data)
    ):
        assert files.numbers(files.data[:length]) is None, length


@pytest.mark.parametrize("name", FORMATS)
def test_a_file_with_something_behind_it(tmp_path, name):
    files = Files(tmp_path, name)
    padding = [b"\0", bytes((1 << 16) + 7), gzip.compress(b"")]
    garbage = [
        b"x",
        b"\0x",
        b"\x1f",
        b"\x1f\x8b",
        bytes(1 << 16) + b"x",
        gzip.compress(b"1"),
        files.data,
    ]
    for tail in padding + garbage:
        found = files.numbers(files.data + tail)
        if "npz" in name:  # an archive is found from its end, whatever stands around it
            assert found in (None, files.whole)
        else:
            assert found == (files.whole if name in CHECKED and tail in padding else None), tail[:9]


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data + b"1",
        lambda data: data + bytes(9 * samples.BLOCK),
        lambda data: data[:-1],
    ],
)
def test_a_whole_stream_of_another_length_is_refused(tmp_path, change):
    head = nrrd(VALUES, "byte skip: 2", encoding="gzip", head=False)
    paths = [
        written(tmp_path / "a.nii.gz", gzip.compress(change(NIFTI))),
        written(tmp_path / "a.nii", change(NIFTI)),
        written(tmp_path / "a.nrrd", head + gzip.compress(b"12" + change(PAYLOAD))),
    ]
    assert [damage_of(path) for path in paths] == ["damage_size"] * 3
    packed = archive(zipfile.ZIP_DEFLATED, change(NPY))
    assert damage_of(written(tmp_path / "a.npz", packed)) == "damage_incomplete"


def damage_of(path) -> str:
    """Return the code of the refusal of a damaged file."""
    with pytest.raises(FileError) as refused:
        read_scan(path)
    assert refused.value.finding.code == "file_damaged"
    return refused.value.finding.values["cause"]["code"]


@pytest.mark.parametrize(
    "name, damage, code",
    [
        ("nii.gz", lambda data: data[:-8] + bytes([data[-8] ^ 1]) + data[-7:], "damage_incomplete"),
        ("nii.gz", lambda data: data[:-1] + bytes([data[-1] ^ 1]), "damage_incomplete"),
        ("nii.gz", lambda data: data[:-1], "damage_cut_short"),
        ("nii.gz", lambda data: data + b"xx", "damage_incomplete"),
        ("nhdr gzip", lambda data: b"", "damage_size"),
        ("nii.gz", lambda data: data[:10] + b"\xff" + data[11:], "damage_incomplete"),
        (
            "npz stored",
            lambda data: data.replace(VALUES.tobytes(), VALUES[::-1].tobytes()),
            "damage_incomplete",
        ),
        ("npz stored", lambda data: data.replace(b"(3, 4, 5)", b"(3, 4, 4)"), "damage_incomplete"),
        ("nhdr gzip", lambda data: data[:-1], "damage_cut_short"),
        ("raw", lambda data: data[:-1], "damage_size"),
    ],
)
def test_refusal_names_the_file_the_damage_and_the_remedy(tmp_path, name, damage, code):
    files = Files(tmp_path, name)
    files.target.write_bytes(damage(files.data))
    with pytest.raises(FileError) as refused:
        read_scan(files.path)
    assert refused.value.finding.values["cause"]["code"] == code
    assert "The file “{}” is damaged".format(files.target.name) in str(refused.value)
    assert "Obtain it again" in str(refused.value)


def test_samples_at_the_end_of_a_file_do_not_begin_in_its_header(tmp_path):
    head = nrrd(VALUES, "byte skip: -1", head=False)
    assert np.array_equal(
        read_scan(written(tmp_path / "a.nrrd", head + b"12" + PAYLOAD)).samples, VALUES
    )
    assert damage_of(written(tmp_path / "a.nrrd", head + PAYLOAD[1:])) == "damage_size"


def test_an_archive_called_an_array_is_refused(tmp_path):
    assert damage_of(written(tmp_path / "a.npy", CHECKED["npz stored"][2])) == "damage_incomplete"


@pytest.mark.parametrize("more", [0, 1])
def test_file_too_small_for_its_samples_is_refused(tmp_path, more):
    """A byte holds 1032 bytes at most, the longest match in two bits."""
    path = written(tmp_path / "a.gz", gzip.compress(b"few"))
    count = 1032 * path.stat().st_size + more
    with pytest.raises(FileError) as refused:
        samples.unpack_samples(path, 0, np.dtype("u1"), (count - 5, 1, 1), 5, samples.Limits())
    assert refused.value.finding.values["cause"]["code"] == "damage_size"


def test_unpacking_needs_no_second_copy_of_the_samples(tmp_path):
    values = np.random.default_rng(1).integers(0, 9, (128, 128, 256)).astype("u1")
    packer = zlib.compressobj(1, wbits=31)
    path = written(tmp_path / "a.nii.gz", packer.compress(nifti(values)) + packer.flush())
    tracemalloc.start()
    try:
        scan = read_scan(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert np.array_equal(scan.samples, values)
    assert peak < 1.5 * values.nbytes
