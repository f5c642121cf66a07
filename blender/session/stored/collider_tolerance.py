# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tolerance of stored colliders, which hulls and a limited number of pieces may not keep."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

ROUNDING = 1e-6  # relative: distances of hulls that are stored in single precision


def is_beyond_tolerance(record: Mapping[str, Any]) -> bool:
    """Return whether colliders, or their body, stand out farther than they were allowed to.

    record: the stored effect of the colliders. A tolerance of zero always holds: such pieces are
    limited by their number alone.
    """
    return any(
        limit and record[name] > limit * (1.0 + ROUNDING)
        for name, limit in zip(("outward", "inward"), record.get("tolerance", ()))
    )


def tolerance_remedy(record: Mapping[str, Any]) -> str:
    """Return the English advice on colliders beyond their tolerance. record: their stored effect,
    with (outward, inward) tolerance and (pieces, vertices) limits.
    """
    if record["shape"] == "hull" and record["outward"] > record["tolerance"][0]:
        return "Choose Convex Pieces, or allow more distance."
    if record["shape"] != "hull" and record["count"] >= record["limits"][0]:
        return "Allow more pieces or vertices, or more distance."
    return "Allow more vertices, or more distance."
