# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The trust in an object's numbers, in one word."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

from bpy.types import Object, Scene

from ....core.solid.findings import DUPLICATE_FACES_IGNORED, HOLES_CAPPED, INVERTED_COMPONENTS, VERTICES_WELDED
from ....core.verdict.finding import Finding, Severity
from ....core.verdict.findings import FLIPPED_FACES
from ....core.verdict.method import Method, Verdict
from ....core.verdict.sentences import severity
from ...settings.preferences import default_density
from ...write import properties
from ..live import live
from ..tracking import posed, staleness, updates
from ..tracking.cache import SessionCache

REPAIRED = (Verdict.CAPPED, Verdict.REORIENTED)
# Warnings that say how the surface was closed: those of a repaired body.
REPAIRS = frozenset({VERTICES_WELDED, DUPLICATE_FACES_IGNORED, FLIPPED_FACES, INVERTED_COMPONENTS, HOLES_CAPPED})
BY_OTHERS = ("MATERIALS", "VOLUME")  # densities that change without an update of the object


class Trust(StrEnum):
    """Trust in displayed numbers, the best first."""

    EXACT = "exact"
    REPAIRED = "repaired"
    DOUBTFUL = "doubtful"
    OUT_OF_DATE = "out of date"


_known: SessionCache[tuple[tuple, Trust]] = SessionCache()  # and what it was found for


def trust(obj: Object, scene: Scene) -> Trust:
    """Return the trust in the object's numbers, live or stored.

    obj: an original object with numbers, or an armature that stands for others with numbers.
    scene: sets the unit scale.
    """
    if posed.stands_for_meshes(obj):
        found = [trust(mesh, scene) for mesh in posed.deformed_meshes(obj)]
        return max(found, key=tuple(Trust).index, default=Trust.DOUBTFUL)
    if live.is_live(obj) or obj.body_moments.density_from in BY_OTHERS:
        return _trust(obj, scene)
    key = stored_key(obj, scene)
    known = _known.get(obj)
    if known is None or known[0] != key:
        known = _known[obj] = (key, _trust(obj, scene))
    return known[1]


def stored_key(obj: Object, scene: Scene) -> tuple:
    """Return a key of all that decides the validity and place of an object's stored numbers.

    obj: an original object with a density from none of `BY_OTHERS`.
    """
    return (
        updates.last_change(obj),
        obj.get("body_fingerprint"),
        obj.get("body_findings"),
        scene.session_uid,
        scene.unit_settings.scale_length,
        default_density(scene),
    )


def _trust(obj: Object, scene: Scene) -> Trust:
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
