# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The marks on an object's stored results: fingerprints of their inputs.

Results, a section and a symmetry carry one each: version, geometry, transform and settings, joined by colons. In a
saved file, EDITED stands in place of the geometry's digest if the geometry has changed since.
"""

from __future__ import annotations

from collections.abc import Container
from typing import NamedTuple

from bpy.types import Object

from ...write import properties, section

EDITED = "edited"


class Mark(NamedTuple):
    """The parts of a mark: digests, but for the version."""

    version: str
    geometry: str
    transform: str
    settings: str


def parse(text: str) -> Mark | None:
    """Return the parts of a mark, or None if the text is no mark: a script may have put any text in its place."""
    parts = text.split(":")
    return Mark(*parts) if len(parts) == len(Mark._fields) else None


def of_section(obj: Object) -> str:
    """Return the mark of the stored section, "" if there is none."""
    return section.fingerprint(obj)


def of_symmetry(obj: Object) -> str:
    """Return the mark of the stored symmetry, "" if there is none."""
    # Asked first: reading a group that is not there makes one.
    return obj.body_moments_symmetry.fingerprint if obj.is_property_set("body_moments_symmetry") else ""


def of_object(obj: Object) -> list[str]:
    """Return all marks of an original object, results first, none of them empty."""
    return [mark for mark in (properties.fingerprint(obj), of_section(obj), of_symmetry(obj)) if mark]


def write_edited(obj: Object, edited: Container[str]) -> None:
    """Put EDITED into those marks of an original, editable object whose geometry has changed."""
    for mark, group, key in (
        (properties.fingerprint(obj), obj, "body_fingerprint"),
        (of_section(obj), obj.get(section.KEY), "fingerprint"),
    ):
        if mark in edited and parse(mark):
            group[key] = _edited(mark)
    mark = of_symmetry(obj)
    if mark in edited and parse(mark):
        obj.body_moments_symmetry.fingerprint = _edited(mark)


def _edited(mark: str) -> str:
    return ":".join(Mark(*mark.split(":"))._replace(geometry=EDITED))
