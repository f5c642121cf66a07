# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Thresholds below which lengths, volumes and rounding count as nothing, relative to the body's own
size.
"""

from math import hypot

from .finding_types import MeasureError
from .findings import OBJECT_SIZE, TOO_SMALL

# The sixth power of the first and the fifth of the second are still numbers.
MAX_COORDINATE, MIN_SIZE = 1e50, 1e-60
FLAT_CAP_VOLUME_RTOL = (
    1e-7  # relative to diagonal times area: volume left by capping a flat sheet of float32 points
)
CLOSED_SHEET_VOLUME_RTOL = (
    1e-14  # relative to the same: volume left by the rounding of a closed sheet
)
WELDING_RTOL = 1e-6  # relative to the body's diagonal
NEGLIGIBLE = (
    1e-4  # relative to mass, size and inertia: a decision that changes them by less is a note
)


def check_size(*sides: float) -> None:
    """Raise MeasureError if the diagonal of a box is so short, but not zero, that volumes in it are
    no numbers.
    """
    if 0.0 < hypot(*sides) < MIN_SIZE:
        raise MeasureError(OBJECT_SIZE, fault=TOO_SMALL)


def welding_tolerance(size: float, error: float) -> float:
    """Return the distance below which a body's points count as one. size: its diagonal; error: of
    its coordinates.
    """
    return max(WELDING_RTOL * size, 4.0 * error)
