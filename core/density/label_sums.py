# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact sums over the voxels of each label of a label map, in one pass.

Each row of voxels is summed per label with weights 1, k, k² and k³, which float64 holds exactly in
rows of at most ROW voxels; all further sums are of whole numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
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
LARGEST = 1 << 62
POWERS = monomials(KNOWN_ORDER)
# Moments of a unit cube about its center: the integral of x^n is zero for odd n.
CUBE = (1.0, 0.0, 1.0 / 12.0, 0.0)


def _number_labels(block: NDArray) -> tuple[list[int], Index]:
    """Return the labels of a block and the place of each voxel's label among them; ReadError if it
    has no labels.
    """
    if block.dtype.kind == "f":
        whole = np.rint(block)
        if not (whole == block).all():
            raise ReadError(LABELS_UNFIT, cause="a sample is no whole number")
        if not (np.abs(whole) < LARGEST).all():
            raise ReadError(LABELS_UNFIT, cause="a label is too large")
        block = whole.astype(np.int64)
    low, high = int(block.min()), int(block.max())
    if high >= LARGEST:
        raise ReadError(LABELS_UNFIT, cause="a label is too large")
    if high - low < NARROW:
        places = block.astype(np.intp) - low
        is_used = np.bincount(places.ravel()) > 0
        labels = np.flatnonzero(is_used) + low
        places = (np.cumsum(is_used) - 1)[places]
    else:
        labels, places = np.unique(block, return_inverse=True)
    _check_count(len(labels))
    return labels.tolist(), places.reshape(block.shape)


def _check_count(labels: int) -> None:
    if labels > MAX_LABELS:
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
        labels, places = _number_labels(block)
        moved = _block_sums(places, len(labels)).astype(object) @ _shift(offset)
        for label, row in zip(labels, moved):
            sums[label] = sums.get(label, 0) + row
        _check_count(len(sums))
    return sums


def label_moments(sums: NDArray) -> Moments:
    """Return the moments to third order of the voxels with these sums, as unit cubes about their
    (i, j, k).
    """
    count = sums[0]
    about = [(2 * int(first) + count) // (2 * count) for first in sums[1:4]]
    central = (sums @ _shift([-middle for middle in about])).astype(np.float64)
    raw = np.zeros(len(POWERS))
    for place, (p, q, r) in enumerate(POWERS.tolist()):
        for a, b, c in np.ndindex(p + 1, q + 1, r + 1):
            weight = comb(p, a) * comb(q, b) * comb(r, c) * CUBE[a] * CUBE[b] * CUBE[c]
            raw[place] += weight * central[monomial_index(p - a, q - b, r - c)]
    even = np.abs(raw) + count  # at least as large as each sum in it
    return Moments(raw, np.array(about, np.float64), Measure.VOLUME, 8.0 * U * even)


def _blocks(samples: NDArray | Blocks) -> Iterator[tuple[tuple[int, int, int], NDArray]]:
    """Yield the offsets and the values of blocks of at most BLOCK voxels, ROW along each axis."""
    if callable(samples):
        for offset, array in samples():
            for own, block in _blocks(array):
                yield tuple(np.add(offset, own).tolist()), block
        return
    depth = min(samples.shape[2], ROW)
    columns = min(max(1, BLOCK // max(depth, 1)), samples.shape[1], ROW)
    planes = min(max(1, BLOCK // max(depth * columns, 1)), ROW)
    for i, j, k in np.ndindex(
        -(-samples.shape[0] // planes),
        -(-samples.shape[1] // max(columns, 1)),
        -(-samples.shape[2] // max(depth, 1)),
    ):
        i, j, k = i * planes, j * columns, k * depth
        yield (i, j, k), samples[i : i + planes, j : j + columns, k : k + depth]


def _block_sums(numbers: Index, count: int) -> NDArray:
    """Return (count, 20) sums of the labels of a block, from its own first voxel."""
    planes, columns, depth = numbers.shape
    rows_at_once = max(1, BLOCK // max(count, depth))
    rows = numbers.reshape(-1, depth)
    along = np.zeros((KNOWN_ORDER + 1, len(rows), count), np.int64)
    powers = np.arange(depth, dtype=np.float64) ** np.arange(KNOWN_ORDER + 1)[:, None]
    for first in range(0, len(rows), rows_at_once):
        part = rows[first : first + rows_at_once]
        keys = (part + count * np.arange(len(part))[:, None]).ravel()
        bins = count * len(part)
        for power, row in enumerate(powers):
            weights = np.tile(row, len(part)) if power else None
            found = np.bincount(keys, weights, bins)
            along[power, first : first + len(part)] = found.reshape(len(part), count)
    along = along.reshape(KNOWN_ORDER + 1, planes, columns, count)
    i, j = (np.arange(size)[:, None] ** np.arange(KNOWN_ORDER + 1) for size in (planes, columns))
    both = np.einsum("rijl,iP,jQ->lPQr", along, i, j, optimize=True)
    return both[:, *POWERS.T]


def _shift(offset: tuple[int, ...] | list[int]) -> NDArray:
    """Return the (20, 20) whole numbers that turn sums from a first voxel at `offset` into sums
    from (0, 0, 0): sums @ matrix.
    """
    matrix = np.zeros((len(POWERS), len(POWERS)), object)
    for column, powers in enumerate(POWERS.tolist()):
        for lower in np.ndindex(*(power + 1 for power in powers)):
            weight = 1
            for power, low, move in zip(powers, lower, offset):
                weight *= comb(power, low) * int(move) ** (power - low)
            matrix[monomial_index(*lower), column] = weight
    return matrix
