# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the numbers of an object hold, in one word."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

from bpy.types import Object, Scene

from ...core.verdict.finding import Finding, Severity
from ...core.verdict.method import Method, Verdict
from ..write import properties
from ..write.messages import severity
from . import live, posed, staleness

REPAIRED = (Verdict.CAPPED, Verdict.REORIENTED)
# Warnings that say how the surface was closed: those of a repaired body.
REPAIRS = frozenset(
    {"vertices_welded", "duplicate_faces_ignored", "flipped_faces", "inverted_components", "holes_capped"}
)


class Trust(StrEnum):
    """How far shown numbers are to be trusted, the best first."""

    EXACT = "exact"
    REPAIRED = "repaired"
    DOUBTFUL = "doubtful"
    OUT_OF_DATE = "out of date"


def trust(obj: Object, scene: Scene) -> Trust:
    """Return how far the object's numbers, live or stored, are to be trusted.

    Parameters
    ----------
    obj : bpy.types.Object
        An original object with numbers, or an armature that stands for others with numbers.
    scene : bpy.types.Scene
        Whose unit scale counts.

    Returns
    -------
    Trust
    """
    if posed.stands_for_meshes(obj):
        found = [trust(mesh, scene) for mesh in posed.deformed_meshes(obj)]
        return max(found, key=tuple(Trust).index, default=Trust.DOUBTFUL)
    now = live.current_numbers(obj)
    if now is not None and now.measurement is not None:
        if live.lag(obj) == live.Lag.BEHIND or live.is_stale(obj, scene):
            return Trust.OUT_OF_DATE
        return trust_of(now.measurement.method, now.measurement.findings)
    if staleness.stale_reason(obj, scene):
        return Trust.OUT_OF_DATE
    return trust_of(properties.method(obj), properties.findings(obj))


def trust_of(method: Method | None, findings: Iterable[Finding]) -> Trust:
    warnings = [found.code for found in findings if severity(found) != Severity.NOTE]
    if method is None or method.verdict == Verdict.OPEN or not REPAIRS.issuperset(warnings):
        return Trust.DOUBTFUL
    return Trust.REPAIRED if warnings or method.verdict in REPAIRED else Trust.EXACT
