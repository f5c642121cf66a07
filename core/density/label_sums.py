# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact sums over the voxels of each label of a label map, in one pass.

Each row of voxels is summed per label with weights 1, k, k² and k³, which float64 holds exactly in
rows of at most ROW voxels; all further sums are of whole numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import comb

import numpy as np

from ..moments import KNOWN_ORDER, Measure, Moments
from ..moments.raw import U, monomial_index, monomials
from ..numerics import Index, NDArray
from ..verdict import ReadError
from .findings import LABELS_UNFIT
from .spline_grid import Blocks

ROW = 1 << 12  # voxels along each axis of a block
BLOCK = 1 << 18  # voxels of a block, at most, and bins of its sums
NARROW = 1 << 18  # range of labels in a block that are told apart by counts, without sorting
MAX_LABELS = 10_000
LARGEST_LABEL = 1 << 62
POWERS = monomials(KNOWN_ORDER)
# ∫ t^n from -1/2 to 1/2: the moments of a unit cube about its center are products of these.
CUBE = (1.0, 0.0, 1.0 / 12.0, 0.0)


def _number_labels(block: NDArray) -> tuple[list[int], Index]:
    """Return the ascending labels of a block, and for each voxel the index of its label; ReadError
    if its values are no labels.
    """
    if block.dtype.kind == "f":
        whole = np.rint(block)
        if not (whole == block).all():
            raise ReadError(LABELS_UNFIT, cause="a sample is no whole number")
        if not (np.abs(whole) < LARGEST_LABEL).all():
            raise ReadError(LABELS_UNFIT, cause="a label is too large")
        block = whole.astype(np.int64)
    low = int(block.min())
    high = int(block.max())
    if high >= LARGEST_LABEL:
        raise ReadError(LABELS_UNFIT, cause="a label is too large")
    if high - low < NARROW:
        # In place of a sort: the index of a label is the number of used values below it.
        above_low = block.astype(np.intp) - low
        is_used = np.bincount(above_low.ravel()) > 0
        labels = np.flatnonzero(is_used) + low
        indices = (np.cumsum(is_used) - 1)[above_low]
    else:
        labels, indices = np.unique(block, return_inverse=True)
    _check_count(len(labels))
    return labels.tolist(), indices.reshape(block.shape)


def _check_count(label_count: int) -> None:
    """Raise ReadError if there are too many labels."""
    if label_count > MAX_LABELS:
        raise ReadError(
            LABELS_UNFIT, cause="they have more than {} different numbers".format(MAX_LABELS)
        )


def sum_labels(samples: NDArray | Blocks) -> dict[int, NDArray]:
    """Return the sums Σ i^p j^q k^r over the voxels (i, j, k) of each label.

    Parameters
    ----------
    samples : (nx, ny, nz) array, or callable
        Whole numbers of any real type, a memory map if larger than memory; or a function that
        yields (offset, array) blocks.

    Returns
    -------
    dict
        For each label (20,) whole numbers, p + q + r ≤ 3 in the order of `monomials`.

    Raises
    ------
    ReadError
        If the samples are no labels.

    Examples
    --------
    >>> from body_moments.core.density import sum_labels
    >>> sums = sum_labels(np.arange(8).reshape(2, 2, 2) // 4)
    >>> sums[1][:5].tolist()
    [4, 4, 2, 2, 4]
    """
    sums: dict[int, NDArray] = {}
    for offset, block in _blocks(samples):
        if not block.size:
            continue
        labels, label_indices = _number_labels(block)
        block_sums = _block_sums(label_indices, len(labels)).astype(object) @ _shift(offset)
        for label, label_sums in zip(labels, block_sums):
            sums[label] = sums.get(label, 0) + label_sums
        _check_count(len(sums))
    return sums


def label_moments(sums: NDArray) -> Moments:
    """Return the moments to third order of the voxels with these (20,) sums, as unit cubes about
    their (i, j, k).
    """
    count = sums[0]
    # The center of mass, rounded to a voxel, so that the central sums are exact.
    about = [(2 * int(first) + count) // (2 * count) for first in sums[1:4]]
    central = (sums @ _shift([-middle for middle in about])).astype(np.float64)
    raw = np.zeros(len(POWERS))
    # ∫ (i + t)^p over a voxel is Σ_a C(p, a) i^(p - a) ∫ t^a, and so along each axis.
    for number, (p, q, r) in enumerate(POWERS.tolist()):
        for a, b, c in np.ndindex(p + 1, q + 1, r + 1):
            weight = comb(p, a) * comb(q, b) * comb(r, c) * CUBE[a] * CUBE[b] * CUBE[c]
            raw[number] += weight * central[monomial_index(p - a, q - b, r - c)]
    magnitude = np.abs(raw) + count  # at least as large as each of the few terms of a sum
    return Moments(raw, np.array(about, np.float64), Measure.VOLUME, 8.0 * U * magnitude)


def _blocks(samples: NDArray | Blocks) -> Iterator[tuple[tuple[int, int, int], NDArray]]:
    """Yield the offsets and the values of blocks of at most BLOCK voxels, ROW along each axis."""
    if callable(samples):
        for offset, array in samples():
            for inner_offset, block in _blocks(array):
                yield tuple(np.add(offset, inner_offset).tolist()), block
        return
    depth = max(1, min(samples.shape[2], ROW))
    columns = max(1, min(BLOCK // depth, samples.shape[1], ROW))
    planes = max(1, min(BLOCK // (depth * columns), ROW))
    starts = map(range, (0, 0, 0), samples.shape, (planes, columns, depth))
    for i, j, k in product(*starts):
        yield (i, j, k), samples[i : i + planes, j : j + columns, k : k + depth]


def _block_sums(label_indices: Index, count: int) -> NDArray:
    """Return (count, 20) sums over the voxels of each label of a block, from its own first voxel.

    label_indices: (planes, columns, depth), 0 to count - 1.
    """
    planes, columns, depth = label_indices.shape
    rows_at_once = max(1, BLOCK // max(count, depth))
    rows = label_indices.reshape(-1, depth)
    row_sums = np.zeros((KNOWN_ORDER + 1, len(rows), count), np.int64)
    powers = np.arange(depth, dtype=np.float64) ** np.arange(KNOWN_ORDER + 1)[:, None]
    for first in range(0, len(rows), rows_at_once):
        part = rows[first : first + rows_at_once]
        # Each row has its own bins, so that one bincount sums many rows.
        bins = (part + count * np.arange(len(part))[:, None]).ravel()
        for power, weights in enumerate(powers):
            row_weights = np.tile(weights, len(part)) if power else None
            sums = np.bincount(bins, row_weights, count * len(part))
            row_sums[power, first : first + len(part)] = sums.reshape(len(part), count)
    row_sums = row_sums.reshape(KNOWN_ORDER + 1, planes, columns, count)
    # By label l and the powers P, Q and r of a voxel's plane i, column j and place in its row.
    i, j = (np.arange(size)[:, None] ** np.arange(KNOWN_ORDER + 1) for size in (planes, columns))
    all_sums = np.einsum("rijl,iP,jQ->lPQr", row_sums, i, j, optimize=True)
    return all_sums[:, *POWERS.T]


def _shift(offset: tuple[int, ...] | list[int]) -> NDArray:
    """Return the (20, 20) matrix of whole numbers that turns sums from a first voxel at `offset`
    into sums from (0, 0, 0): sums @ matrix.
    """
    matrix = np.zeros((len(POWERS), len(POWERS)), object)
    for column, powers in enumerate(POWERS.tolist()):
        for lower in np.ndindex(*(power + 1 for power in powers)):
            weight = 1
            for power, low, move in zip(powers, lower, offset):
                weight *= comb(power, low) * int(move) ** (power - low)
            matrix[monomial_index(*lower), column] = weight
    return matrix
