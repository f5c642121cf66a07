# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans and arrays of samples in files, by their suffix; places of samples: a matrix, or files of
uneven positions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from ..files import (
    DEFAULT_LIMITS,
    FILE_TYPE,
    FILE_UNREADABLE,
    NAMED_FILE_MISSING,
    Limits,
    check_regular,
    wrong_field,
)
from ..numerics import Array, NDArray, check_type, float_array
from ..verdict import FileError, Finding, finding
from .findings import (
    POSITIONS_COUNT,
    POSITIONS_NOT_ASCENDING,
    SCAN_OWN_UNIT,
    SCAN_PLACEMENT_OVERRIDDEN,
    SCAN_UNSTATED,
    UNIT_ASSUMED,
)
from .nifti import read_nifti
from .nrrd import read_nrrd
from .numpy_files import map_array, read_named_raw, read_npy, read_npz
from .scan import Scan
from .scan_files import SUFFIXES, scan_suffix

READERS: dict[str, Callable[[Path, Limits], Scan]] = dict(
    zip(
        SUFFIXES,
        (read_npy, read_npz, read_nrrd, read_nrrd, read_nifti, read_nifti, read_named_raw),
        strict=True,
    )
)
AXES = "xyz"
CONTENTS = {"x": "positions along x", "y": "positions along y", "z": "positions along z"}
Positions = tuple[Array | None, Array | None, Array | None]
EVEN: Positions = (None, None, None)


def read_scan(path: str | Path, limits: Limits = DEFAULT_LIMITS) -> Scan:
    """Read the scan in a file: NRRD, NIfTI, .npy, .npz, or .raw called NAME_XxYxZ_TYPE.raw.

    Parameters
    ----------
    path : str or Path
    limits : Limits
        Limits on the demands of its header.

    Returns
    -------
    Scan
        Uncompressed samples are a memory map.

    Raises
    ------
    FileError
        If the file is no scan, damaged or beyond a limit.
    OSError
        If it cannot be opened.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from body_moments.core import read_scan
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "scan.npy"
    ...     np.save(path, np.ones((2, 3, 4), np.int16))
    ...     read_scan(path).samples.shape
    (2, 3, 4)
    """
    path = Path(path)
    read = READERS.get(scan_suffix(path))
    if read is None:
        raise FileError(FILE_TYPE, suffixes=" ".join(SUFFIXES))
    check_regular(path)
    with open(path, "rb"):
        pass  # raises OSError with the reason; a reader would call the file damaged
    try:
        scan = read(path, limits)
    except MemoryError as error:
        raise FileError(
            FILE_UNREADABLE, error="its samples do not fit into memory. Decompress it"
        ) from error
    limits.check(path, "samples", scan.samples.size)
    rows = scan.matrix[:3]
    scaling = (scan.slope, scan.intercept)
    # "Not greater", so that a determinant of NaN is refused, too.
    if not np.isfinite(rows).all() or not abs(np.linalg.det(rows[:, :3])) > 0.0:
        raise wrong_field(
            scan_suffix(path),
            "spacing or directions",
            "finite, and not in one plane",
            *rows.ravel(),
        )
    if not np.isfinite(scaling).all():
        raise wrong_field(scan_suffix(path), "slope and intercept", "finite numbers", *scaling)
    return scan


def sample_matrix(
    scan: Scan,
    spacing: Sequence[float] | None,
    origin: Sequence[float] | None,
    unit_scale: float | None,
) -> tuple[Array, tuple[Finding, ...]]:
    """Return the matrix from sample indices of a scan to positions in meters, and findings.

    Parameters
    ----------
    scan : Scan
    spacing, origin : sequence of three float, or None
        In place of the header's, in units of `unit_scale` meters; axes x, y, z.
    unit_scale : float or None
        Meters per unit if the file states none; 1 by default.

    Returns
    -------
    matrix : (4, 4) array
        The sample (i, j, k) stands at matrix @ (i, j, k, 1).
    findings : tuple of Finding
        Decisions made on the way.

    Examples
    --------
    >>> from body_moments.core.scans import Scan, sample_matrix
    >>> scan = Scan(np.zeros((2, 2, 2)), np.eye(4))
    >>> matrix, findings = sample_matrix(scan, (2.0, 2.0, 3.0), None, 0.001)
    >>> matrix.diagonal().tolist(), findings
    ([0.002, 0.002, 0.003, 1.0], ())
    """
    check_type("scan", scan, Scan)
    findings = []
    matrix = float_array("scan.matrix", scan.matrix, 4, 4).copy()
    # The header's own matrix is in its unit; given values, below, are in `unit_scale`.
    matrix[:3] *= scan.unit or unit_scale or scan.usual_unit or 1.0
    if scan.unit is not None and unit_scale is not None:
        findings.append(finding(SCAN_OWN_UNIT))
    replaced = []
    if spacing is not None:
        matrix[:3, :3] = np.diag(float_array("spacing", spacing, 3)) * (unit_scale or 1.0)
        replaced.append("spacing")
    if origin is not None:
        matrix[:3, 3] = float_array("origin", origin, 3) * (unit_scale or 1.0)
        replaced.append("origin")
    if scan.is_placed and replaced:
        findings.append(finding(SCAN_PLACEMENT_OVERRIDDEN, fields=replaced))
    if not scan.is_placed and spacing is None:
        findings.append(finding(SCAN_UNSTATED, part="spacing", option="spacing"))
    elif scan.unit is None and unit_scale is None and spacing is None:
        findings.append(
            finding(SCAN_UNSTATED, part="unit", option="unit-scale")
            if scan.usual_unit is None
            else finding(UNIT_ASSUMED, unit="mm")
        )
    return matrix, tuple(findings)


def read_positions(path: str | Path, axis: str, count: int) -> Array:
    """Return the (count,) ascending positions of samples along an axis from a .npy file.

    Raises FileError, OSError.
    """
    path = Path(path)
    subject = {"file": path.name, "axis": axis}
    if not path.is_file():
        raise FileError(NAMED_FILE_MISSING, file=path.name, content=CONTENTS[axis])
    array = map_array(path)
    if array.shape != (count,) or count < 2 or array.dtype.kind not in "iuf":
        size = " x ".join(map(str, array.shape))
        description = "{} {}".format(size, array.dtype).strip()
        raise FileError(POSITIONS_COUNT, **subject, samples=count, array=description)
    positions = np.array(array, np.float64)
    is_right = np.isfinite(positions) & np.append(True, positions[1:] > positions[:-1])
    if not is_right.all():
        raise FileError(POSITIONS_NOT_ASCENDING, **subject, place=int(np.argmin(is_right)))
    return positions


def read_all_positions(files: Mapping[str, str | Path], shape: Sequence[int]) -> Positions:
    """Return the positions along each axis, None for an axis without a file.

    files: by the axis, "x", "y" or "z". shape: of the samples. Raises the errors of
    `read_positions`.
    """
    x, y, z = (
        read_positions(files[axis], axis, count) if axis in files else None
        for axis, count in zip(AXES, shape)
    )
    return x, y, z


def place_samples(matrix: NDArray, positions: Positions, unit: float) -> tuple[Array, Positions]:
    """Put samples at positions along their axes' own directions; return the new (4, 4) matrix and
    the positions.

    `matrix` puts the regular sample (i, j, k) at matrix @ (i, j, k, 1). `positions` are (n,)
    coordinates along each of the three axes, in place of its spacing and origin, or None; their
    `unit` is in units of the matrix. The returned positions are relative to the first, so that they
    keep all digits: sample k stands at matrix @ (…, positions[k], 1).
    """
    matrix = matrix.copy()
    if all(coordinates is None for coordinates in positions):
        return matrix, positions
    directions = matrix[:3, :3] / np.linalg.norm(matrix[:3, :3], axis=0)
    # Coordinates of the first sample along the directions, which need not be perpendicular.
    origin = np.linalg.solve(directions, matrix[:3, 3])
    relative: list[Array | None] = [None, None, None]
    for axis, coordinates in enumerate(positions):
        if coordinates is not None:
            matrix[:3, axis] = directions[:, axis] * unit
            origin[axis] = coordinates[0] * unit
            relative[axis] = coordinates - coordinates[0]
    matrix[:3, 3] = directions @ origin
    x, y, z = relative
    return matrix, (x, y, z)
