# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects with Live on and their current numbers, as `memory.followed` keeps them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from ....core import numerics, nurbs, verdict

if TYPE_CHECKING:
    from ....core.measurement import Measurement
    from .measuring import MovingSurface


class Lag(StrEnum):
    """Lag of live numbers behind the displayed object."""

    NONE = ""
    # volume, mass and center are current, the inertia is scaled from the last measurement
    FIRST_ORDER = "first order"
    BEHIND = "behind"


@dataclass(eq=False)
class Followed:
    """An object with Live on.

    measurement: None if it was refused; refusal: the reason for that. seconds: duration of the
    measurement. settings: the digest of the object's settings. matrix, transform, number: at the
    measurement, matrix_world, transform key and number of the last update. tracked: the body, if
    edits are followed rather than measured anew. surface: the faces, if a light pass can follow
    them. first_order: volume and center in the object's coordinates by the last light pass.
    pass_seconds: its duration. shows_others: whether the object shows instances. is_pending:
    whether the object changed since the measurement.
    """

    measurement: Measurement | None = None
    refusal: verdict.Finding | None = None
    seconds: float = 0.0
    settings: str = ""
    matrix: numerics.Array | None = None
    transform: str = ""
    number: int = 0
    tracked: nurbs.TrackedSolid | None = None
    surface: MovingSurface | None = None
    first_order: tuple[float, numerics.Array] | None = None
    pass_seconds: float = 0.0
    shows_others: bool = False
    is_pending: bool = False
