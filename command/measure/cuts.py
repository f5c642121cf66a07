# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of records about planes that cut bodies and surfaces."""

from argparse import Namespace
from collections.abc import Callable
from typing import Any

from ...core.bodies import vessel_surface
from ...core.cuts import (
    CUT_FILL_UNAVAILABLE,
    LEVEL_UNAVAILABLE,
    SURFACE_NEEDED,
    CutFill,
    below_record,
    contents_record,
    cut_fill_record,
    partly_compared,
    surface_cut_fill,
)
from ...core.inertia import NO_CERTAIN_VOLUME
from ...core.measurement import NO_VOLUME, Body, Measurement
from ...core.mesh import Surface, join_surfaces
from ...core.polyhedron import BOUNDARY_OPEN
from ...core.verdict import Finding, MeasureError, Procedure
from ..options.arguments import RIM
from .entries import Contents


def is_open_sheet(refusal: MeasureError, options: Namespace) -> bool:
    """Return whether a refused body is an open surface without volume, for which only cut and fill
    were requested.
    """
    is_empty = refusal.finding.code in (NO_VOLUME, NO_CERTAIN_VOLUME)
    return is_empty and options.against is not None and options.kind is None


def cut_entries(
    measurement: Measurement,
    body: Body,
    options: Namespace,
    contents: Contents,
    against_object: Callable[[str, Surface], CutFill] | None = None,
) -> tuple[dict[str, Any], tuple[Finding, ...]]:
    """Return the entries `below` and `cut_fill` of a record, if requested, and findings about them.

    An entry is None, with an error in the contents, if the plane or the surface do not allow it.
    against_object: compares with the object of a name.
    """
    entries: dict[str, Any] = {}
    findings: tuple[Finding, ...] = ()
    if options.below is not None:
        entries["below"] = None
        with contents.attempt(measurement.name):
            entries["below"] = _below(measurement, body, options.below)
    if options.against is not None:
        entries["cut_fill"] = None
        with contents.attempt(measurement.name):
            found = _cut_fill(body, options.against, against_object)
            entries["cut_fill"] = cut_fill_record(found, str(options.against))
            findings = partly_compared(found)
    return entries, findings


def _below(measurement: Measurement, body: Body, level: float) -> dict[str, Any]:
    if measurement.kind != "solid" and body.wall is None:
        raise MeasureError(LEVEL_UNAVAILABLE, fault=SURFACE_NEEDED)
    if body.method.procedure is Procedure.OPEN:
        raise MeasureError(BOUNDARY_OPEN)
    vessel = vessel_surface(body)
    entry = below_record(join_surfaces([*body.surfaces(False)]), level)
    return entry | {"contents": contents_record(vessel, level)}


def _cut_fill(
    body: Body,
    against: float | str,
    against_object: Callable[[str, Surface], CutFill] | None,
) -> CutFill:
    if not body.has_surface:
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=SURFACE_NEEDED)
    surface = join_surfaces([*body.surfaces(True)])
    if isinstance(against, str) and against != RIM and against_object is not None:
        return against_object(against, surface)
    return surface_cut_fill(surface, None if against == RIM else float(against))
