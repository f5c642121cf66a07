# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects with Live on, and their current numbers: `live` measures them, and the panels ask
here.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

from bpy.types import Object

from ....core import measurement as measuring
from .. import live
from ..tracking.cache import SessionCache
from ..tracking.stamps import Kind, Stamp

if TYPE_CHECKING:
    from ....core.measurement.measurement import Measurement
    from ....core.verdict.finding import Finding
    from .live import Followed


class Lag(StrEnum):
    """Lag of live numbers behind the displayed object."""

    NONE = ""
    # volume, mass and center are current, the inertia is scaled from the last measurement
    FIRST_ORDER = "first order"
    BEHIND = "behind"


class LiveResult(NamedTuple):
    """An object's current numbers.

    measurement: None if it was refused. refusal: the reason for that. seconds: duration of the
    measurement. settings: the digest of the object's settings.
    """

    measurement: Measurement | None
    refusal: Finding | None
    seconds: float
    settings: str


followed: SessionCache[Followed] = SessionCache()


def is_live(obj: Object) -> bool:
    """Return whether Live is on for the object."""
    return obj in followed


def current_numbers(obj: Object) -> LiveResult | None:
    """Return the result of an object's last live measurement, or None if there is none or Live is
    off.
    """
    current = followed.get(obj)
    return None if current is None else current.result


def stamp_of(obj: Object) -> Stamp | None:
    """Return a stamp of the settings of live numbers, as Blender does not report every change of a
    setting.
    """
    now = current_numbers(obj)
    return (
        None
        if now is None
        else Stamp(Kind.SETTINGS, measuring.settings.VERSION, settings=now.settings)
    )


def lag(obj: Object) -> Lag:
    """Return the lag of an object's live numbers behind the displayed object."""
    current = followed.get(obj)
    if current is None or not (current.is_pending or live.live.is_of_another_scale(obj, current)):
        return Lag.NONE
    return Lag.BEHIND if current.first_order is None else Lag.FIRST_ORDER
