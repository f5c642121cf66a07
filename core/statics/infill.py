# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The infill with which a print stands: its mass and first moments grow evenly with the infill, so
that each edge of the support polygon allows a range of it.
"""

import numpy as np

from ..numerics import Array

SAMPLES = 1001  # steps of the infill, for the largest margin


def infill_range(
    corners: Array, empty: Array, growth: Array, margin: float
) -> tuple[float, float] | None:
    """Return the least and the largest infill, from 0 to 1, with the center inside a polygon by a
    margin; None if there is none.

    corners: (k, 2), counterclockwise. empty, growth: (3,) mass and first moments x, y without
    infill, and their growth to full infill.
    """
    start, inward = _edges(corners)
    # For each edge, mass · (n·(center - start) - margin) at infill 0, and its growth. It is linear
    # in the infill, and must not be negative.
    at_zero, rate = (
        inward @ moments[1:] - moments[0] * (np.einsum("ki,ki->k", inward, start) + margin)
        for moments in (empty, growth)
    )
    root = -at_zero / np.where(rate != 0.0, rate, 1.0)
    low = float(root[rate > 0.0].max(initial=0.0))
    high = float(root[rate < 0.0].min(initial=1.0))
    return (low, high) if low <= high and (at_zero[rate == 0.0] >= 0.0).all() else None


def largest_margin(corners: Array, empty: Array, growth: Array) -> tuple[float, float]:
    """Return the largest margin that any infill gives, and that infill, as `infill_range`."""
    infill = np.linspace(0.0, 1.0, SAMPLES)
    margins = _margins(corners, empty + infill[:, None] * growth)
    best = int(margins.argmax())
    return float(margins[best]), float(infill[best])


def least_ballast(corners: Array, mass: Array, places: Array, margin: float, sign: float) -> Array:
    """Return the (k,) least masses that bring the center inside a polygon by a margin if they are
    added (sign 1) or taken away (-1) at places (k, 2), infinity if none does.

    corners: as for `infill_range`. mass: (3,) mass and first moments x, y without ballast. Again,
    mass · (n·(center - start) - margin) is linear in the ballast, and must not be negative.
    """
    start, inward = _edges(corners)
    heights = np.einsum("ki,ki->k", inward, start) + margin
    at_zero = inward @ mass[1:] - mass[0] * heights
    rate = sign * (places @ inward.T - heights)
    root = -at_zero / np.where(rate != 0.0, rate, 1.0)
    low = np.where(rate > 0.0, root, 0.0).max(axis=1, initial=0.0)
    high = np.where(rate < 0.0, root, np.inf).min(axis=1)
    allowed = (low <= high) & ((rate != 0.0) | (at_zero >= 0.0)).all(axis=1)
    return np.where(allowed, low, np.inf)


def ballast_margins(corners: Array, mass: Array, places: Array, added: Array) -> Array:
    """Return the (k,) margins that masses (k,), below zero if taken away, give at places (k, 2)."""
    unit = np.column_stack([np.ones(len(places)), places])
    return _margins(corners, mass + added[:, None] * unit)


def _margins(corners: Array, moments: Array) -> Array:
    """Return the (k,) margins of the centers of (k, 3) masses and first moments x, y: distances
    from the nearest edge's line, negative outside.
    """
    start, inward = _edges(corners)
    centers = moments[:, 1:] / moments[:, :1]
    return (centers @ inward.T - np.einsum("ki,ki->k", inward, start)).min(axis=1)


def _edges(corners: Array) -> tuple[Array, Array]:
    """Return (k, 2) starts of a counterclockwise polygon's edges, and (k, 2) unit vectors across
    them that point inside.
    """
    sides = np.roll(corners, -1, axis=0) - corners
    across = np.column_stack([-sides[:, 1], sides[:, 0]])
    return corners, across / np.linalg.norm(across, axis=1)[:, None]
