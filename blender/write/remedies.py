# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The remedies of findings: the effect of one press of a button, and the findings that it
remedies.
"""

from typing import NamedTuple

from ...core import inertia, measurement, solid, verdict


class Remedy(NamedTuple):
    """A change of an object after which it is measured again."""

    name: str
    description: str
    icon: str


REPAIR = "object.body_moments_remedy"  # the operator of all `REMEDIES`
SELECT = "object.body_moments_select_refused"
DEFECTS = "object.body_moments_select_faults"
FILL = "FILL_HOLES"
OUTSIDE = "OUTSIDE"
MERGE = "MERGE"
DUPLICATES = "DUPLICATES"
UNION = "UNION"
SHELL = "SHELL"
REMEDIES = {
    FILL: Remedy("Fill Holes", "Close the holes of the mesh with faces", "MESH_PLANE"),
    OUTSIDE: Remedy(
        "Recalculate Outside",
        "Reverse the faces that were measured as reversed: flipped ones, and those of components "
        "that are inside out. "
        "Cavities keep facing inward",
        "NORMALS_FACE",
    ),
    MERGE: Remedy(
        "Merge by Distance", "Merge vertices as close as those that were welded", "AUTOMERGE_ON"
    ),
    DUPLICATES: Remedy("Delete Duplicate Faces", "Delete the later copies of faces", "X"),
    UNION: Remedy(
        "Count as Union", "Unite overlapping components before they are measured", "MOD_BOOLEAN"
    ),
    SHELL: Remedy(
        "Measure as Shell", "Measure the surface as a sheet with a thickness", "MOD_SOLIDIFY"
    ),
}
ADVICE: dict[str, tuple[str, ...]] = {
    solid.COMPONENTS_NESTED: (UNION,),
    solid.COMPONENTS_OVERLAP: (UNION,),
    solid.SELF_INTERSECTING: (UNION,),
    verdict.SELF_INTERSECTION: (UNION,),
    verdict.FLIPPED_FACES: (OUTSIDE, DEFECTS),
    solid.INVERTED_COMPONENTS: (OUTSIDE,),
    solid.HOLES_CAPPED: (FILL, DEFECTS, SHELL),
    solid.DUPLICATE_FACES_IGNORED: (DUPLICATES, DEFECTS),
    solid.DUPLICATE_FACES_COUNTED: (DUPLICATES, DEFECTS),
    solid.VERTICES_WELDED: (MERGE, DEFECTS),
    solid.ONE_SIDED_COMPONENTS: (SHELL,),
    solid.NON_MANIFOLD_COMPONENTS: (DEFECTS, SHELL),
    solid.FLAT_COMPONENTS: (SHELL,),
    solid.FLAT_SURFACE: (SHELL,),
    measurement.NO_VOLUME: (SHELL,),
    inertia.NEGATIVE_INERTIA: (UNION, SHELL),
}
EDITS = (FILL, OUTSIDE, MERGE, DUPLICATES)  # edits of a mesh


def remedies_of(code: str, object_type: str) -> tuple[str, ...]:
    """Return the remedies of a finding about an object of this type: keys of REMEDIES, or an
    operator's idname.
    """
    advice = ADVICE.get(code, ())
    if object_type == "MESH":
        return advice
    return tuple(key for key in advice if key not in (*EDITS, DEFECTS))
