# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stamps: digests of the inputs of stored data, which `staleness.stale_reason` compares with the
present inputs.

Results, a section, a symmetry and colliders carry theirs as text: version, geometry, transform and
settings, joined by colons. In a saved file, EDITED stands in place of the geometry's digest if the
geometry has changed since. Data in memory, such as hulls, have stamps of the same form, that the
session carries for their objects (`staleness.carry`).
"""

from __future__ import annotations

from collections.abc import Container
from enum import Enum, StrEnum
from typing import NamedTuple

from bpy.types import Collection, Object

from ....core import measurement, verdict
from ...settings.given import COLLIDERS
from ...write import properties, section
from .. import memory

EDITED = "edited"


class Stale(StrEnum):
    """Reasons why stored data are out of date, as sentences to be translated."""

    FINGERPRINT = "Fingerprint damaged"
    SETTINGS = "Settings changed"
    GEOMETRY = "Geometry changed"
    TRANSFORM = "Transform changed"
    SCALE = "Scale changed"
    UNIT_SCALE = "Unit scale changed"
    MEMBER = "A member changed, or was measured anew"
    MEMBERS = "Members were added, removed or moved, or given masses changed"
    BONES = "Bones, settings or objects changed"
    COLLIDERS = "Colliders changed"


class Kind(Enum):
    """The kinds of stored data, which depend on different inputs."""

    RESULTS = "results"
    SECTION = "section"
    SYMMETRY = "symmetry"
    ASSEMBLY = "assembly"
    BONES = "bones"
    COLLIDERS = "colliders"
    MOMENTS = "moments"  # in memory, as are the following
    HULL = "hull"
    LEVEL = "level"
    CUT_FILL = "cut and fill"
    FLOATING = "floating"
    LIVE = "live"


STORED = (Kind.RESULTS, Kind.SECTION, Kind.SYMMETRY, Kind.COLLIDERS)
GROUPS = {Kind.SECTION: section.KEY, Kind.COLLIDERS: COLLIDERS}  # ID properties with a fingerprint


class Stamp(NamedTuple):
    """The inputs of stored data: digests, and the version of the fingerprint.

    extra: the unit scale of a section, a level, or cut and fill, in meters.
    """

    kind: Kind
    version: str
    geometry: str = ""
    transform: str = ""
    settings: str = ""
    extra: float | None = None

    @classmethod
    def parse(cls, text: str, kind: Kind = Kind.RESULTS, extra: float | None = None) -> Stamp:
        """Return the stamp in a stored text, with an empty version if the text is no stamp."""
        parts = text.split(":")
        return cls(kind, *parts, extra=extra) if len(parts) == 4 else cls(kind, "")

    @property
    def text(self) -> str:
        """The stored form: version, geometry, transform and settings, joined by colons."""
        return ":".join(self[1:5])


def stamp_of(owner: Object | Collection, kind: Kind = Kind.RESULTS) -> Stamp | None:
    """Return the stamp of an owner's results, or of its other data of a kind; None if there are
    none.
    """
    if kind == Kind.RESULTS:
        return _results_stamp(owner)
    if kind == Kind.SECTION:
        stored_section = section.stored(owner)
        return (
            None
            if stored_section is None
            else Stamp.parse(stored_section.fingerprint, kind, stored_section.unit)
        )
    if kind == Kind.LIVE:
        followed = memory.followed.get(owner)
        return followed and Stamp(kind, measurement.settings.VERSION, settings=followed.settings)
    if kind not in STORED:
        return (memory.carried.get(owner) or {}).get(kind)
    text = ""
    if kind == Kind.COLLIDERS:
        group = owner.get(COLLIDERS)
        text = str(group.get("fingerprint", "")) if hasattr(group, "get") else ""
    elif owner.is_property_set("body_moments_symmetry"):  # reading a missing group creates it
        text = owner.body_moments_symmetry.fingerprint
    return Stamp.parse(text, kind) if text else None


def _results_stamp(owner: Object | Collection) -> Stamp | None:
    """Return the stamp of the results of an object, assembly or character, with its kind; an empty
    one for results without a fingerprint.
    """
    text = properties.fingerprint(owner)
    if not text and "body_mass" not in owner:
        return None
    kind = Kind.RESULTS
    if not isinstance(owner, Object):
        kind = Kind.ASSEMBLY
    elif (
        owner.type in {"EMPTY", "ARMATURE"}
        and owner.get("body_method") == verdict.Procedure.ASSEMBLY
    ):
        kind = Kind.ASSEMBLY if owner.type == "EMPTY" else Kind.BONES
    return Stamp.parse(text, kind)


def with_geometry(obj: Object) -> dict[str, Kind]:
    """Return the texts and kinds of an original object's stamps, except those of assemblies and
    bones.
    """
    return {
        stamp.text: stamp.kind
        for stamp in [
            *[stamp_of(obj, kind) for kind in STORED],
            *(memory.carried.get(obj) or {}).values(),
        ]
        if stamp is not None and stamp.kind not in (Kind.ASSEMBLY, Kind.BONES)
    }


def write_edited(obj: Object, edited: Container[str]) -> None:
    """Put EDITED into the stored stamps of an original, editable object whose texts are in
    `edited`.
    """
    for kind in STORED:
        stamp = stamp_of(obj, kind)
        if stamp is None or not stamp.version or stamp.text not in edited:
            continue
        text = stamp._replace(geometry=EDITED).text
        if kind == Kind.SYMMETRY:
            obj.body_moments_symmetry.fingerprint = text
        elif kind in GROUPS:
            obj[GROUPS[kind]]["fingerprint"] = text
        else:
            obj["body_fingerprint"] = text
