# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sums over the voxels of labels: whole numbers, equal to those over lists of indices."""

import tracemalloc

import numpy as np
import pytest
from body_moments.core.bodies.grid import label_value
from body_moments.core.density import label_moments, label_sums, sum_labels
from body_moments.core.moments.raw import monomials
from body_moments.core.verdict import MeasureError


def listed_sums(labels, label):
    index = np.argwhere(labels == label).astype(object)
    return [int((index ** np.array(power)).prod(axis=1).sum()) for power in monomials(3).tolist()]


@pytest.mark.parametrize("dtype", ["u1", "i2", ">i4", "f4", "f8", "u8"])
def test_sums_of_labels_equal_sums_over_indices(dtype, monkeypatch):
    monkeypatch.setattr(label_sums, "BLOCK", 40)
    monkeypatch.setattr(label_sums, "ROW", 5)
    labels = np.random.default_rng(1).integers(0, 5, (7, 6, 11)).astype(dtype)
    sums = sum_labels(labels)
    assert {label: row.tolist() for label, row in sums.items()} == {
        label: listed_sums(labels, label) for label in range(5)
    }


def test_labels_far_apart_are_told_apart():
    labels = np.array([[[-3, 0, 7]], [[10**9, 10**12, 7]]])
    sums = sum_labels(labels)
    assert {label: row[0] for label, row in sums.items()} == {
        **dict.fromkeys((-3, 0, 10**9, 10**12), 1),
        7: 2,
    }


def test_sums_far_from_first_voxel_stay_exact():
    offset = (1 << 20, 3, 1 << 22)
    sums = sum_labels(lambda: iter([(offset, np.ones((2, 2, 2), np.uint8))]))
    corner = sum_labels(np.ones((2, 2, 2)))
    moments = label_moments(sums[1])
    assert moments.total == 8.0
    assert np.array_equal(moments.center, np.array(offset) + 0.5)
    central = moments.about_center().raw - label_moments(corner[1]).about_center().raw
    assert np.abs(central).max() < 1e-8


@pytest.mark.parametrize("axis", range(3))
def test_sums_of_long_thin_maps_stay_exact(axis):
    count = 200_000
    sums = sum_labels(np.ones(np.where(np.arange(3) == axis, count, 1), np.uint8))[1]
    cubes = monomials(3).tolist().index([3 * (axis == i) for i in range(3)])
    assert sums[0] == count and sums[cubes] == (count * (count - 1) // 2) ** 2


def test_thin_map_of_distant_labels_takes_little_memory():
    labels = np.arange(1 << 14).reshape(128, 128, 1) % 2 * 1000
    tracemalloc.start()
    try:
        sums = sum_labels(labels)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert {label: row.tolist() for label, row in sums.items()} == {
        label: listed_sums(labels, label) for label in (0, 1000)
    }
    assert peak < 100 * labels.nbytes


@pytest.mark.parametrize(
    "samples",
    [[0.0, 0.5], [np.nan, 1.0], [np.inf, 1.0], range(10_001), np.array([1 << 62], np.uint64)],
)
def test_samples_that_are_no_labels_are_refused(samples):
    with pytest.raises(MeasureError, match="no labels"):
        sum_labels(np.array(samples)[None, None])


@pytest.mark.parametrize(("label", "slope"), [(10, 0.1), (21, 1 / 3), (-30_000, 0.1), (4, 0.5)])
def test_label_with_slope_of_float32_is_whole(label, slope):
    assert label_value(label, float(np.float32(slope))) == round(label * slope)


@pytest.mark.parametrize(
    ("label", "slope", "cause"),
    [
        (5, 0.1, "whole number"),
        (20_000_001, 0.5, "whole number"),
        (1, 1e38, "too large"),
        (9, 1e308, "too large"),
    ],
)
def test_label_that_slope_makes_unfit_is_refused(label, slope, cause):
    with pytest.raises(MeasureError, match=cause):
        label_value(label, slope)
