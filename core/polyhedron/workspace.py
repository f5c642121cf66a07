# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The scratch of a kernel: one buffer, and the arrays of the last block's shape carved out of it.

Allocating arrays, and making views of them, costs as much as the arithmetic of a short block: both
are done once for all blocks of one shape. A workspace is not to be shared by threads.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from math import prod
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..numerics import Array, Index

ROW_PADDING = (
    8  # numbers between arrays: numpy < 2 leaves its vector loop where output ends at input's start
)
MAX_ARRAYS = 16  # arrays of one shape, at a time

Block = TypeVar("Block")


class Workspace(Generic[Block]):
    """Memory for blocks of one shape, `make(workspace, *shape)`, with arrays from `take` and
    `overlay`.
    """

    def __init__(self, make: Callable[..., Block]):
        self._make = make
        self._buffer: NDArray = np.empty(0)
        self._position = 0
        self._shape: tuple[Hashable, ...] | None = None
        self._block: Block | None = None

    def block(self, shape: tuple[Hashable, ...], numbers: int) -> Block:
        """Return the block of this shape. numbers: size of its arrays together; arrays that share
        memory count once.
        """
        block = self._block
        if block is None or shape != self._shape:
            self._shape = self._block = block = None
            needed = numbers + MAX_ARRAYS * ROW_PADDING
            if len(self._buffer) < needed:
                self._buffer = np.empty(0)  # frees the old buffer before the new one is made
                self._buffer = np.empty(needed)
            self._position = -(self._buffer.ctypes.data // 8) % 8  # aligned to 64 bytes
            self._block = block = self._make(self, *shape)
            self._shape = shape
        return block

    def take(self, *shape: int) -> Array:
        """Return the next contiguous array of this shape."""
        start = self._position
        end = start + prod(shape)
        self._position = end + ROW_PADDING
        return self._buffer[start:end].reshape(shape)

    def overlay(self, *groups: Sequence[tuple[int, ...]]) -> list[list[Array]]:
        """Return arrays of the given shapes, by group; the groups share memory: only one is in use
        at a time.
        """
        start = self._position
        end = self._position
        arrays = []
        for group in groups:
            self._position = start
            arrays.append([self.take(*shape) for shape in group])
            end = max(end, self._position)
        self._position = end
        return arrays


def gather(
    points: NDArray,
    index: Index,
    single: NDArray[np.float32],
    corners: Array,
) -> None:
    """Gather coordinates into `corners`, (3, ...), float32 ones by way of `single`. index: checked;
    gets tripled.
    """
    flat = points.reshape(-1)
    target = single if points.dtype == np.float32 else corners
    np.multiply(index, 3, index)
    for axis in range(3):  # the indices have been checked: "wrap" is the mode that costs least
        flat[axis:].take(index, None, target[axis], "wrap")
    if target is single:
        corners[...] = single
