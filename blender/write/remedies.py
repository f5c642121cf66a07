# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that carry out the advice of findings."""

from ...core.inertia.findings import NEGATIVE_INERTIA
from ...core.measurement.findings import NO_VOLUME
from ...core.solid.findings import (
    COMPONENTS_NESTED,
    COMPONENTS_OVERLAP,
    DUPLICATE_FACES_COUNTED,
    DUPLICATE_FACES_IGNORED,
    FLAT_COMPONENTS,
    FLAT_SURFACE,
    HOLES_CAPPED,
    INVERTED_COMPONENTS,
    NON_MANIFOLD_COMPONENTS,
    ONE_SIDED_COMPONENTS,
    SELF_INTERSECTING,
    VERTICES_WELDED,
)
from ...core.verdict.findings import FLIPPED_FACES, SELF_INTERSECTION

UNION = "object.body_moments_count_as_union"
OUTSIDE = "object.body_moments_recalculate_outside"
DEFECTS = "object.body_moments_select_faults"
SHELL = "object.body_moments_measure_as_shell"
REMEDIES: dict[str, tuple[str, ...]] = {
    COMPONENTS_NESTED: (UNION,),
    COMPONENTS_OVERLAP: (UNION,),
    SELF_INTERSECTING: (UNION,),
    SELF_INTERSECTION: (UNION,),
    FLIPPED_FACES: (OUTSIDE, DEFECTS),
    INVERTED_COMPONENTS: (OUTSIDE,),
    HOLES_CAPPED: (DEFECTS, SHELL),
    DUPLICATE_FACES_IGNORED: (DEFECTS,),
    DUPLICATE_FACES_COUNTED: (DEFECTS,),
    VERTICES_WELDED: (DEFECTS,),
    ONE_SIDED_COMPONENTS: (SHELL,),
    NON_MANIFOLD_COMPONENTS: (DEFECTS, SHELL),
    FLAT_COMPONENTS: (SHELL,),
    FLAT_SURFACE: (SHELL,),
    NO_VOLUME: (SHELL,),
    NEGATIVE_INERTIA: (UNION, SHELL),
}
MESH_ONLY = (OUTSIDE, DEFECTS)


def remedies_of(code: str, object_type: str) -> tuple[str, ...]:
    """Return the idnames of the operators that carry out the advice of a finding about an object of this type."""
    found = REMEDIES.get(code, ())
    return found if object_type == "MESH" else tuple(idname for idname in found if idname not in MESH_ONLY)
