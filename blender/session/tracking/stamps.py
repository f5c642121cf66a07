# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stamps: digests of the inputs of stored data, which `staleness.stale_reason` compares with the
present inputs.

Results, a section and a symmetry carry theirs as text: version, geometry, transform and settings,
joined by colons. In a saved file, EDITED stands in place of the geometry's digest if the geometry
has changed since. Data in memory, such as hulls, have stamps of the same form, that the session
carries for their objects.
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
    SETTINGS = "settings"  # live numbers and failed measurements


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


def carry(
    obj: Object,
    kind: Kind,
    number: int,
    transform: str = "",
    settings: str = "",
    extra: float | None = None,
) -> Stamp:
    """Attach a stamp to an original object's data in memory, and return it.

    number: of the last update at their making.
    """
    stamp = Stamp(
        kind,
        measurement.settings.VERSION,
        "{:s} {:d}".format(kind.value, number),
        transform,
        settings,
        extra,
    )
    memory.carried[obj] = {**(memory.carried.get(obj) or {}), kind: stamp}
    return stamp


def carried(obj: Object, kind: Kind) -> Stamp | None:
    """Return the stamp of an object's data in memory, if any."""
    return (memory.carried.get(obj) or {}).get(kind)


def of_results(owner: Object | Collection) -> Stamp | None:
    """Return the stamp of the stored results, None if there are none."""
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


def of_section(obj: Object) -> Stamp | None:
    """Return the stamp of the stored section, None if there is none."""
    known = section.stored(obj)
    return None if known is None else Stamp.parse(known.fingerprint, Kind.SECTION, known.unit)


def of_symmetry(obj: Object) -> Stamp | None:
    """Return the stamp of the stored symmetry, None if there is none."""
    # Checked first, because reading a missing property group creates it.
    text = (
        obj.body_moments_symmetry.fingerprint
        if obj.is_property_set("body_moments_symmetry")
        else ""
    )
    return Stamp.parse(text, Kind.SYMMETRY) if text else None


def of_colliders(obj: Object) -> Stamp | None:
    """Return the stamp of the stored effects of an object's colliders, None if there is none."""
    group = obj.get(COLLIDERS)
    text = str(group.get("fingerprint", "")) if hasattr(group, "get") else ""
    return Stamp.parse(text, Kind.COLLIDERS) if text else None


def with_geometry(obj: Object) -> dict[str, Kind]:
    """Return the texts and kinds of an original object's stamps, except those of assemblies and
    bones.
    """
    found = [*_stored(obj), *(memory.carried.get(obj) or {}).values()]
    return {
        stamp.text: stamp.kind
        for stamp in found
        if stamp is not None and stamp.kind not in (Kind.ASSEMBLY, Kind.BONES)
    }


def _stored(obj: Object) -> tuple[Stamp | None, ...]:
    return of_results(obj), of_section(obj), of_symmetry(obj), of_colliders(obj)


def write_edited(obj: Object, edited: Container[str]) -> None:
    """Put EDITED into the stored stamps of an original, editable object whose texts are in
    `edited`.
    """
    for stamp in _stored(obj):
        if stamp is None or not stamp.version or stamp.text not in edited:
            continue
        text = stamp._replace(geometry=EDITED).text
        if stamp.kind == Kind.SYMMETRY:
            obj.body_moments_symmetry.fingerprint = text
        elif stamp.kind == Kind.SECTION:
            obj[section.KEY]["fingerprint"] = text
        elif stamp.kind == Kind.COLLIDERS:
            obj[COLLIDERS]["fingerprint"] = text
        else:
            obj["body_fingerprint"] = text
