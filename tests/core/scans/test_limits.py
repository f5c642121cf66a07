# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Resources that a scan file may claim: limits, linear time, and files in its own folder only."""

import gzip
import os
import struct
import time
import tracemalloc
import zipfile
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.files.limits import Limits
from body_moments.core.scans import read_raw, read_scan
from body_moments.core.verdict import FileError, MeasureError
from body_moments.tests.core.scan_files import nifti, npy, npz, nrrd, written

VALUES = np.arange(60, dtype="u2").reshape(3, 4, 5)
NPY = npy(VALUES)


def refusal(path, limits=None):
    with pytest.raises(MeasureError) as refused:
        read_scan(path, limits or Limits())
    return refused.value.finding


def sparse(path, size):
    with open(path, "wb") as file:
        os.truncate(file.fileno(), size)
    return path


# each file needs just this much of what is limited
NEEDS = {
    "samples": [
        ("a_3x4x5_uint16.raw", VALUES.tobytes(order="F"), 60),
        ("a.npy", NPY, 60),
        ("a.npz", npz({"a": NPY}), 60),
        ("a.nii", nifti(VALUES), 60),
        ("a.nii.gz", gzip.compress(nifti(VALUES)), 60),
        ("a.nrrd", nrrd(VALUES), 60),
        ("a.nrrd", nrrd(VALUES, encoding="gzip"), 60),
    ],
    "unpacked_bytes": [
        ("a.npz", npz({"a": NPY}, zipfile.ZIP_STORED), len(NPY)),
        ("a.nii.gz", gzip.compress(nifti(VALUES)), len(nifti(VALUES))),
        ("a.nrrd", nrrd(VALUES, encoding="gzip"), 120),
    ],
    "entries": [("a.npz", npz(dict.fromkeys("abc", NPY)), 3)],
    "header_bytes": [
        ("a.nrrd", nrrd(VALUES), len(nrrd(VALUES, head=False))),
        (
            "a.nrrd",
            nrrd(VALUES, "# " + 70_000 * "x"),
            len(nrrd(VALUES, "# " + 70_000 * "x", head=False)),
        ),
    ],
}


@pytest.mark.parametrize(
    "name, file, data, needed", [(name, *row) for name, rows in NEEDS.items() for row in rows]
)
def test_a_file_at_a_limit_is_read_and_one_beyond_is_refused(tmp_path, name, file, data, needed):
    path = written(tmp_path / file, data)
    assert np.array_equal(read_scan(path, replace(Limits(), **{name: needed})).samples, VALUES)
    found = refusal(path, replace(Limits(), **{name: needed - 1}))
    values = found.values
    assert (found.code, values["file"], values["name"], values["limit"]) == (
        "file_exceeds_limit",
        file,
        name,
        needed - 1,
    )
    assert values["count"] >= needed and values["next"] >= values["count"]
    assert "BODY_MOMENTS_LIMITS to {}={}".format(name, values["next"]) in str(found)
    assert np.array_equal(
        read_scan(path, replace(Limits(), **{name: values["next"]})).samples, VALUES
    )


def test_raw_samples_of_a_given_shape_are_limited(tmp_path):
    path = written(tmp_path / "a", VALUES.tobytes())
    assert read_raw(path, (3, 4, 5), "uint16", limits=Limits(samples=60)).samples.size == 60
    with pytest.raises(FileError) as refused:
        read_raw(path, (3, 4, 5), "uint16", limits=Limits(samples=59))
    assert refused.value.finding.code == "file_exceeds_limit"


def test_raised_limit_holds_for_samples_without_header(tmp_path):
    path = sparse(tmp_path / "a_2049x2048x2048_uint8.raw", 2049 << 22)
    assert refusal(path).code == "file_exceeds_limit"
    assert read_scan(path, Limits(samples=2049 << 22)).samples.shape == (2049, 2048, 2048)


def test_small_files_claiming_terabytes_are_refused_at_once(tmp_path):
    raw = sparse(tmp_path / "a_4096x4096x4096_uint8.raw", 1 << 36)
    header = struct.pack("<I", (1 << 32) - 9)
    bomb = b"\x93NUMPY\2\0" + header
    deep = NPY.replace(b"'shape': (3, 4, 5)", b"'shape': " + b"(" * 9)
    packer = gzip.compress(bytes(1 << 24))
    packed = packer * (1 << 8)  # 4 GiB and more in 4 MB
    head = nrrd(VALUES, encoding="gzip", head=False).replace(
        b"sizes: 3 4 5", b"sizes: 2048 1024 1025"
    )
    array = written(tmp_path / "a.npz", npz({"a": bomb + bytes(1 << 27)}))
    tracemalloc.start()
    try:
        start = time.perf_counter()
        assert refusal(raw).code == "file_exceeds_limit"
        assert refusal(array).code == "file_damaged"
        assert (
            refusal(
                written(tmp_path / "deep.npz", npz(dict.fromkeys(map(str, range(900)), deep)))
            ).code
            == "file_damaged"
        )
        assert refusal(written(tmp_path / "a.nrrd", head + packed)).code == "file_exceeds_limit"
        sparse(tmp_path / "a.npy", 1 << 32)
        with open(tmp_path / "a.npy", "r+b") as file:
            file.write(bomb)
        assert refusal(tmp_path / "a.npy").code == "file_damaged"
        seconds, peak = time.perf_counter() - start, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert seconds < 10.0 and peak < 1 << 26


# A file of about so many bytes that is hard to read, by what it was once slow for.
HOSTILE = {
    "directions that open only": lambda n: nrrd(VALUES, "space directions: " + "(" * n),
    "directions and words": lambda n: nrrd(VALUES, "space directions: " + "(none" * (n // 5)),
    "many directions": lambda n: nrrd(VALUES, "space directions: " + "(1,0,0)" * (n // 7)),
    "sizes of one": lambda n: nrrd(VALUES).replace(
        b"sizes: 3 4 5", b"sizes: 3 4 5" + b" 1" * (n // 2)
    ),
    "a long origin": lambda n: nrrd(
        VALUES,
        "space directions: (1,0,0) (0,1,0) (0,0,1)",
        "space origin: (" + "1," * (n // 2) + "1)",
    ),
    "long units": lambda n: nrrd(VALUES, 'space units: "' + '" ' * (n // 2)),
    "long spacings": lambda n: nrrd(VALUES, "spacings: " + "9" * n),
    "many fields": lambda n: nrrd(VALUES, *["x: y"] * (n // 5)),
    "line ends": lambda n: nrrd(VALUES, "\r" * n),
    "empty members": lambda n: (
        nrrd(VALUES, encoding="gzip", head=False) + gzip.compress(b"") * (n // 20)
    ),
    "padding": lambda n: nrrd(VALUES, encoding="gzip") + bytes(n),
    "arrays": lambda n: npz(dict.fromkeys(map(str, range(n // 300)), NPY)),
}
FORMS = {"arrays": "a.npz"}


@pytest.mark.parametrize("name", HOSTILE)
def test_the_time_to_read_is_proportional_to_the_bytes(tmp_path, name):
    """A hundred times the bytes may take three hundred times as long; quadratic work takes ten
    thousand times.
    """
    limits = Limits(entries=10**6, header_bytes=1 << 30)
    paths = [
        written(tmp_path / (str(n) + FORMS.get(name, "a.nrrd")), HOSTILE[name](n))
        for n in (10_000, 1_000_000)
    ]

    def seconds(path):
        begin = time.process_time()
        with suppress(FileError):
            read_scan(path, limits)
        return time.process_time() - begin

    short, long = (min(seconds(path) for _ in range(2)) for path in paths)
    assert long < 300.0 * max(short, 1e-3)


@pytest.mark.parametrize(
    "text",
    [
        "(1,0,0) (0,1,0) (0,0,1)",
        "(1,0,0)(0,1,0) none (0,0,1)",
        " none ( 1 , 0, 0) (0,1,0)\t(0,0,1) ",
    ],
)
def test_vectors_of_directions(tmp_path, text):
    assert np.array_equal(
        read_scan(written(tmp_path / "a.nrrd", nrrd(VALUES, "space directions:" + text))).matrix,
        np.eye(4),
    )


@pytest.mark.parametrize(
    "text",
    [
        "(1,0,0) (0,1,0) (0,0,1",
        "1,0,0) (0,1,0) (0,0,1)",
        "11,0,0) (0,1,0) (0,0,1)",
        "(1,0,0) (0,1,0) (0,0,1) x",
        "((1,0,0) (0,1,0) (0,0,1)",
        "(1,0,0,0) (0,1,0) (0,0,1)",
        "(1,0,0) (0,1,0) nine (0,0,1)",
        "()",
        "(",
    ],
)
def test_invalid_directions_are_refused(tmp_path, text):
    found = refusal(written(tmp_path / "a.nrrd", nrrd(VALUES, "space directions: " + text)))
    assert found.code == "header_field" and len(str(found)) < 200


@pytest.mark.parametrize(
    "text, limits",
    [
        ("", Limits()),
        ("samples=2e10", Limits(samples=20_000_000_000)),
        (
            " entries=5, header_bytes=9 unpacked_bytes=7,",
            Limits(entries=5, header_bytes=9, unpacked_bytes=7),
        ),
    ],
)
def test_limits_are_given_by_a_text(text, limits):
    assert Limits.parse(text) == limits


@pytest.mark.parametrize(
    "text",
    [
        "samples",
        "samples=",
        "samples=0",
        "samples=-1",
        "samples=nan",
        "samples=1e999",
        "samples=1_0",
        "x=1",
        "allow_outside=1",
    ],
)
def test_malformed_limits_are_refused(text):
    with pytest.raises(MeasureError) as refused:
        Limits.parse(text)
    assert text in str(refused.value) and "samples" in str(refused.value)


@pytest.mark.parametrize("axes, is_read", [(16, True), (17, False)])
def test_a_header_has_sixteen_axes_at_most(tmp_path, axes, is_read):
    path = written(
        tmp_path / "a.nrrd",
        nrrd(VALUES, "space directions: (1,0,0) (0,1,0) (0,0,1)" + " none" * (axes - 3)),
    )
    if is_read:
        assert np.array_equal(read_scan(path).matrix, np.eye(4))
    else:
        assert refusal(path).code == "header_field"


def test_a_header_names_no_samples_outside_of_its_folder(tmp_path):
    folder, other = tmp_path / "in", tmp_path / "in_side"
    (folder / "deeper").mkdir(parents=True)
    other.mkdir()
    for place in (folder, folder / "deeper", other):
        written(place / "a.raw", VALUES.tobytes(order="F"))
    (folder / "link.raw").symlink_to(other / "a.raw")
    (folder / "near.raw").symlink_to(folder / "deeper" / "a.raw")

    def header(name):
        return written(folder / "a.nhdr", nrrd(VALUES, "data file: " + str(name), head=False))

    for name in (
        "a.raw",
        "./a.raw",
        "deeper/a.raw",
        "deeper/../a.raw",
        "near.raw",
        folder / "a.raw",
    ):
        assert np.array_equal(read_scan(header(name)).samples, VALUES), name
    for name in ("../in_side/a.raw", other / "a.raw", "link.raw", "deeper/../../in_side/a.raw"):
        found = refusal(header(name))
        assert (found.code, found.values["file"]) == ("nrrd_data_file_outside", str(name))
        assert "--allow-outside" in str(found)
        assert np.array_equal(read_scan(header(name), Limits(allow_outside=True)).samples, VALUES)
