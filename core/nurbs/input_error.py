# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounds of the changes in moments of patches by storing their control points.

A skin that moves sweeps a volume, and so do gaps along seams; a monomial of degree d is at most the reach, to the d, in
it. The change of an area is bounded the same way, with its slope in place of the skin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..moments.moments import Moments, monomials
from .patch import Patch, patches_size
from .patch_moments import area_moments, area_slope


def with_swept_error(moments: Moments, swept: float, reach: float) -> Moments:
    """Return moments with the bounds of a change that sweeps a volume `swept`, no farther away than `reach`."""
    return replace(moments, input_error=swept * reach ** monomials(moments.order).sum(axis=1))


def with_area_error(area: Moments, slope: float, stored: float, reach: float) -> Moments:
    """Return area moments with bounds of moving each control point by at most `stored`; slope: from `area_slope`."""
    if reach == 0.0:
        return area  # The patches are one point, without any digits in their stored coordinates.
    return with_swept_error(area, stored * (slope + area.total / reach), reach)


def stored_area_moments(
    patches: Sequence[Patch], order: int, about: NDArray[np.float64] | None = None, *, stored: float
) -> Moments:
    """Return the area moments of patches, by default about their box's center, with bounds of storing the points."""
    area = area_moments(patches, order, about)[0]
    return with_area_error(area, area_slope(patches), stored, patches_size(patches) + 4.0 * stored)
