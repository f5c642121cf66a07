# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conventions of scans beyond their header: units, spaces, encodings, axes of one sample, labels.

The expected positions are those that ITK, nibabel and pynrrd give.
"""

import bz2
import struct

import numpy as np
import pytest
from body_moments.core.scans import count_labels, read_scan, sample_matrix
from body_moments.core.verdict import FileError

from tests.core.scan_files import nifti, nrrd

VALUES = np.arange(120, dtype="<i2").reshape(4, 5, 6)
PLACED = "space directions: (2,0,0) (0,3,0) (0,0,4)", "space origin: (10,20,30)"


def scan_of(path, data):
    path.write_bytes(data)
    return read_scan(path)


@pytest.mark.parametrize(
    "space, signs",
    [
        ("right-anterior-superior", (1, 1, 1)),
        ("RAS", (1, 1, 1)),
        ("left-anterior-superior", (-1, 1, 1)),
        ("LAST", (-1, 1, 1)),
        ("Left-Posterior-Superior", (-1, -1, 1)),
        ("left-posterior-superior-time", (-1, -1, 1)),
        ("LPS", (-1, -1, 1)),
        ("scanner-xyz", (1, 1, 1)),
        ("3D-right-handed", (1, 1, 1)),
    ],
)
def test_nrrd_space_gives_the_axes_their_directions(tmp_path, space, signs):
    scan = scan_of(tmp_path / "a.nrrd", nrrd(VALUES, "space: " + space, *PLACED))
    matrix, findings = sample_matrix(scan, None, None, None)
    is_anatomical = space[0].lower() in "rl"
    unit = 1e-3 if is_anatomical else 1.0
    expected = np.diag([*np.array(signs) * (2, 3, 4), 1.0])
    expected[:3, 3] = np.array(signs) * (10, 20, 30)
    np.testing.assert_allclose(matrix[:3], expected[:3] * unit, rtol=1e-15, atol=0.0)
    code = "unit_assumed" if is_anatomical else "scan_unstated"
    assert [one.code for one in findings] == [code]


def test_nrrd_space_of_no_such_name_is_refused(tmp_path):
    with pytest.raises(FileError, match="space"):
        scan_of(tmp_path / "a.nrrd", nrrd(VALUES, "space: left-posterior-inside", *PLACED))


@pytest.mark.parametrize("unit, given, scale", [(0, None, 1e-3), (0, 0.5, 0.5), (1, None, 1.0)])
def test_nifti_without_unit_is_in_millimeters(tmp_path, unit, given, scale):
    scan = scan_of(tmp_path / "a.nii", nifti(VALUES, spacing=(2, 3, 4), unit=unit))
    matrix, findings = sample_matrix(scan, None, None, given)
    assert np.allclose(matrix.diagonal()[:3], np.array([2, 3, 4]) * scale, rtol=1e-15)
    codes = [] if unit or given else ["unit_assumed"]
    assert [one.code for one in findings] == codes


@pytest.mark.parametrize("order", "<>")
def test_nifti_2_is_read_like_nifti_1(tmp_path, order):
    head = bytearray(544)
    struct.pack_into(order + "i8s2h", head, 0, 540, b"n+2\0\r\n\x1a\n", 4, 16)
    struct.pack_into(order + "8q", head, 16, 3, 4, 5, 6, 1, 1, 1, 1)
    struct.pack_into(order + "8d", head, 104, -1, 2, 3, 4, 0, 0, 0, 0)
    struct.pack_into(order + "q2d", head, 168, 544, 0.5, -1.0)
    struct.pack_into(order + "2i6d", head, 344, 1, 0, 0.5, 0.5, 0.5, 7, 8, 9)
    struct.pack_into(order + "i", head, 500, 2)
    data = VALUES.astype(order + "i2").tobytes(order="F")
    scan = scan_of(tmp_path / "a.nii", bytes(head) + data)
    assert np.array_equal(scan.samples, VALUES) and (scan.slope, scan.intercept) == (0.5, -1.0)
    # The quaternion turns x to y, y to z and z to x; a qfac of -1 reverses the last axis.
    expected = [[0, 0, -4, 7], [2, 0, 0, 8], [0, 3, 0, 9]]
    assert np.allclose(scan.matrix[:3], expected, atol=1e-14) and scan.unit == 1e-3


def test_nifti_slope_that_is_nan_scales_nothing(tmp_path):
    scan = scan_of(tmp_path / "a.nii", nifti(VALUES, slope=np.nan, intercept=np.nan))
    assert (scan.slope, scan.intercept) == (1.0, 0.0)


@pytest.mark.parametrize("name", ["ascii", "text", "txt", "bzip2", "bz2"])
def test_nrrd_encodings_hold_the_same_samples(tmp_path, name):
    flat = VALUES.ravel(order="F")
    data = bz2.compress(flat.tobytes()) if name[0] == "b" else " ".join(map(str, flat)).encode()
    header = nrrd(VALUES, "spacings: 1 1 1", encoding=name, head=False)
    if name[0] != "b":
        header = header.replace(b"endian: little\n", b"")
    assert np.array_equal(scan_of(tmp_path / "a.nrrd", header + data).samples, VALUES)
    with pytest.raises(FileError, match="damaged"):
        scan_of(tmp_path / "a.nrrd", header + data[:-5])


def test_nrrd_text_of_other_words_is_refused(tmp_path):
    words = " ".join(["1", "x1", *["2"] * 118]).encode()
    with pytest.raises(FileError, match="no number of type int16"):
        scan_of(tmp_path / "a.nrrd", nrrd(VALUES, encoding="text", head=False) + words)


@pytest.mark.parametrize("shape", [(4, 5, 6, 1), (1, 4, 5, 6), (1, 4, 5, 6, 1, 1)])
@pytest.mark.parametrize("suffix", [".npy", ".npz"])
def test_numpy_axes_of_one_sample_are_left_out(tmp_path, shape, suffix):
    path = tmp_path / ("a" + suffix)
    np.save(path, VALUES.reshape(shape)) if suffix == ".npy" else np.savez(
        path, a=VALUES.reshape(shape)
    )
    assert np.array_equal(read_scan(path).samples, VALUES)


@pytest.mark.parametrize("leading", [True, False])
def test_nrrd_axis_of_one_sample_is_left_out(tmp_path, leading):
    def beside(text, extra):
        return extra + " " + text if leading else text + " " + extra

    data = nrrd(
        VALUES,
        "kinds: " + beside("domain domain domain", "scalar"),
        "space directions: " + beside("(2,0,0) (0,3,0) (0,0,4)", "none"),
        "space: RAS",
    )
    data = data.replace(b"dimension: 3", b"dimension: 4")
    data = data.replace(b"sizes: 4 5 6", b"sizes: " + beside("4 5 6", "1").encode())
    scan = scan_of(tmp_path / "a.nrrd", data)
    assert np.array_equal(scan.samples, VALUES)
    assert scan.matrix.diagonal()[:3].tolist() == [2, 3, 4]


def test_scan_of_several_volumes_is_refused(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((4, 5, 6, 2)))
    with pytest.raises(FileError, match="three possible sizes"):
        read_scan(tmp_path / "a.npy")


def test_labels_are_told_from_masks_and_densities():
    labels = np.zeros((20, 20, 20), np.int16)
    labels[2:9, 2:9, 2:9] = 1
    assert count_labels(labels) == 0  # a mask
    labels[11:18, 4:12, 3:15] = 7
    assert count_labels(labels) == count_labels(labels.astype(float)) == 3
    noise = np.random.default_rng(5).integers(0, 9, labels.shape)
    assert count_labels(noise) == count_labels(labels + 0.25) == 0
    assert count_labels(np.add.outer(np.add.outer(*[np.arange(20)] * 2), np.arange(20))) == 0
