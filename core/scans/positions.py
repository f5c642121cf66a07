# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Positions of unevenly spaced samples: a file of positions for each such axis of a scan."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import FileError
from .findings import NAMED_FILE_MISSING, POSITIONS_COUNT, POSITIONS_NOT_ASCENDING
from .numpy_files import map_array

AXES = "xyz"
CONTENTS = {"x": "positions along x", "y": "positions along y", "z": "positions along z"}
Positions = tuple[NDArray[np.float64] | None, NDArray[np.float64] | None, NDArray[np.float64] | None]
EVEN: Positions = (None, None, None)


def read_positions(path: str | Path, axis: str, count: int) -> NDArray[np.float64]:
    """Return the (count,) ascending positions of samples along an axis from a .npy file. Raises FileError, OSError."""
    path = Path(path)
    whose = {"file": path.name, "axis": axis}
    if not path.is_file():
        raise FileError(NAMED_FILE_MISSING, file=path.name, content=CONTENTS[axis])
    array = map_array(path)
    if array.shape != (count,) or count < 2 or array.dtype.kind not in "iuf":
        size = " x ".join(map(str, array.shape))
        raise FileError(POSITIONS_COUNT, **whose, samples=count, array="{} {}".format(size, array.dtype).strip())
    row = np.array(array, np.float64)
    is_right = np.isfinite(row) & np.append(True, row[1:] > row[:-1])
    if not is_right.all():
        raise FileError(POSITIONS_NOT_ASCENDING, **whose, place=int(np.argmin(is_right)))
    return row


def read_all_positions(files: Mapping[str, str | Path], shape: Sequence[int]) -> Positions:
    """Return the positions along each axis that has a file. Raises the errors of `read_positions`."""
    x, y, z = (read_positions(files[axis], axis, count) if axis in files else None for axis, count in zip(AXES, shape))
    return x, y, z


def place_samples(matrix: NDArray, positions: Positions, unit: float) -> tuple[NDArray[np.float64], Positions]:
    """Put samples at positions along their axes' own directions; return the new (4, 4) matrix and the positions.

    `matrix` puts the regular sample (i, j, k) at matrix @ (i, j, k, 1). `positions` are (n,) coordinates along each of
    the three axes, in place of its spacing and origin, or None; their `unit` is in units of the matrix. The returned
    positions are relative to the first, so that they keep all digits: sample k stands at matrix @ (…, positions[k], 1).
    """
    matrix = matrix.copy()
    if not any(row is not None for row in positions):
        return matrix, positions
    directions = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    origin = np.linalg.solve(directions, matrix[:3, 3])
    relative = []
    for axis, row in enumerate(positions):
        if row is not None:
            matrix[:3, axis] = directions[:, axis] * unit
            origin[axis] = row[0] * unit
        relative.append(None if row is None else row - row[0])
    matrix[:3, 3] = directions @ origin
    x, y, z = relative
    return matrix, (x, y, z)
