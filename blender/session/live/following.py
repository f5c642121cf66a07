# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects with Live on, and their current numbers: `live` measures them, and the panels ask here."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

from bpy.types import Object

from ...read.fingerprint import VERSION
from .. import live
from ..tracking.cache import SessionCache
from ..tracking.stamps import Kind, Stamp

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ....core.measurement.measurement import Measurement
    from ....core.nurbs.tracked_solid import TrackedSolid
    from ....core.verdict.finding import Finding
    from .moving_surface import MovingSurface


class Lag(StrEnum):
    """Lag of live numbers behind the displayed object."""

    NONE = ""
    FIRST_ORDER = "first order"  # volume, mass and center are current, inertia is that of the last measurement
    BEHIND = "behind"


@dataclass(frozen=True, eq=False)
class LiveResult:
    """An object's current numbers.

    measurement: None if there are none; refusal: then the reason. seconds: spent on it. settings: the digest of its
    settings.
    """

    measurement: Measurement | None
    refusal: Finding | None
    seconds: float
    settings: str


@dataclass(eq=False)
class Followed:
    """An object with Live on.

    matrix, transform: its place at the measurement, and the key of its numbers' dependence on that. number: of the last
    update then. tracked: its body, if that is followed rather than measured each time. surface: its faces, if a light
    pass can follow them; first_order: volume and center in its own coordinates after the last such pass. is_pending: it
    was evaluated anew since the measurement.
    """

    result: LiveResult | None = None
    matrix: NDArray[np.float64] | None = None
    transform: str = ""
    number: int = 0
    tracked: TrackedSolid | None = None
    surface: MovingSurface | None = None
    first_order: tuple[float, NDArray[np.float64]] | None = None
    pass_seconds: float = 0.0
    shows_others: bool = False
    is_pending: bool = False


followed: SessionCache[Followed] = SessionCache()


def is_live(obj: Object) -> bool:
    """Return whether Live is on for the object."""
    return obj in followed


def current_numbers(obj: Object) -> LiveResult | None:
    """Return the numbers of an object with Live on when it was last measured, None before that."""
    current = followed.get(obj)
    return None if current is None else current.result


def stamp_of(obj: Object) -> Stamp | None:
    """Return the stamp of the live numbers: Blender does not report every change of a setting."""
    now = current_numbers(obj)
    return None if now is None else Stamp(Kind.SETTINGS, VERSION, settings=now.settings)


def lag(obj: Object) -> Lag:
    """Return the lag of an object's live numbers behind the displayed object."""
    current = followed.get(obj)
    if current is None or not (current.is_pending or live.live.is_of_another_scale(obj, current)):
        return Lag.NONE
    return Lag.BEHIND if current.first_order is None else Lag.FIRST_ORDER
