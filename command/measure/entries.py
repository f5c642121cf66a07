# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries of a document about objects: failures, findings that several records share, planes that
cut a body, and flotation.
"""

from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...blender.write.thumbnail import thumbnail
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
from ...core.floating import Flotation, float_record
from ...core.inertia import NO_CERTAIN_VOLUME
from ...core.measurement import NO_VOLUME, Body, Measurement
from ...core.mesh import Surface, join_surfaces
from ...core.polyhedron import BOUNDARY_OPEN
from ...core.verdict import Finding, MeasureError, Procedure, finding, unique
from ..options.arguments import RIM


@dataclass
class Contents:
    """Measured entries of a file's document.

    internal: returns the entry about an unexpected error. objects: the records of bodies. measured:
    their names, objects in Blender (None without it) and measurements, in the same order. flats:
    the records of flat shapes. caveats: about the total.
    """

    internal: Callable[[str | None, Exception], dict[str, Any]]
    objects: list[dict[str, Any]] = field(default_factory=list)
    measured: list[tuple[str, Any, Measurement]] = field(default_factory=list)
    flats: list[dict[str, Any]] = field(default_factory=list)
    errors: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)
    caveats: list[Finding] = field(default_factory=list)

    @contextmanager
    def attempt(self, name: str) -> Iterator[None]:
        """Turn an error in the block into an entry about the object of this name."""
        try:
            yield
        except MeasureError as refusal:
            self.errors.append(failure(name, refusal.finding))
        except Exception as error:
            self.errors.append(self.internal(name, error))


def failure(name: str | None, reason: Finding) -> dict[str, Any]:
    """Return an entry of a document's `errors` or `left_out`: an object's name and the reason."""
    return {"name": name, "reason": str(reason)}


def said_once(entries: Sequence[dict[str, Any]], code: str) -> Iterator[Finding]:
    """If several records all have the finding with a code, remove it from them and yield it, once
    for all of them with equal values.
    """
    matches = [
        (entry, record)
        for entry in entries
        for record in entry["findings"]
        if record["code"] == code
    ]
    if len(matches) < len(entries) or len(entries) < 2:
        return
    for entry, record in matches:
        entry["findings"].remove(record)
        entry["warnings"].remove(record["message"])
    yield from unique(finding(code, **record["values"]) for _, record in matches)


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
            cut_fill = _cut_fill(body, options.against, against_object)
            entries["cut_fill"] = cut_fill_record(cut_fill, str(options.against))
            findings = partly_compared(cut_fill)
    return entries, findings


def _below(measurement: Measurement, body: Body, level: float) -> dict[str, Any]:
    """Return the entry `below` of a record. level: in meters. Raises MeasureError."""
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
    """Return cut and fill of a body against a height, its rim or the object of a name.

    against_object: None without Blender, where names of objects are refused before.

    Raises MeasureError.
    """
    if not body.has_surface:
        raise MeasureError(CUT_FILL_UNAVAILABLE, fault=SURFACE_NEEDED)
    surface = join_surfaces([*body.surfaces(sheets=True)])
    if isinstance(against, str) and against != RIM and against_object is not None:
        return against_object(against, surface)
    return surface_cut_fill(surface, None if against == RIM else float(against))


def picture(surface: Surface, measurement: Measurement, unit: float) -> str | None:
    """Return the picture of a measured surface with points in `unit` meters, or None if it has no
    faces.
    """
    triangles = surface.all_triangles()[0]
    if not len(triangles):
        return None
    properties = measurement.mass_properties
    points = surface.points.astype(np.float64) * unit
    return thumbnail(points, triangles, properties.center, properties.principal.axes)


def floating_entry(
    settle: Callable[[], Flotation],
    measurement: Measurement,
    options: Namespace,
    contents: Contents,
) -> tuple[dict[str, Any], tuple[Finding, ...]]:
    """Return the entry `floating` of a record, and findings; None, and an error, if the body does
    not float.

    settle: returns its position of rest. measurement: its axes are those of heel and trim.
    """
    with contents.attempt(measurement.name):  # It stops errors, so that the last line is reached.
        rest = settle()
        angles = np.radians(options.gz or ())
        entry = float_record(rest, measurement, options.frame, angles, rest.body.find_rests([rest]))
        return {"floating": entry}, rest.findings
    return {"floating": None}, ()
