# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose common space counts twice in a sum: copies left in place, and bodies that overlap.

Only pairs with overlapping boxes are read, up to a number of triangles, so that a scene of a
thousand objects takes a fraction of the time of its measurement. Bodies that touch do not overlap.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

import numpy as np
from bpy.types import Depsgraph, Object

from ...core import bodies, mesh, solid, verdict
from ...core.numerics import Array, Mask, cross_rows
from .. import read  # most objects need not be read again
from ..read.assembly import copies_caveats, copies_in_place, operands_of
from . import findings, stack

NOT_MEASURED: Mapping[Object, stack.Measured] = {}
MAX_PAIRS = 4_000
MAX_TRIANGLES = 100_000
MAX_NAMED = 100  # pairs in the values of a finding


def shared_space_caveats(
    objects: Collection[Object], depsgraph: Depsgraph
) -> list[verdict.Finding]:
    """Return a warning about copies left in place, and a note about other solids that overlap."""
    return [*copies_caveats(objects), *overlap_caveats(objects, depsgraph)]


def overlap_caveats(
    objects: Collection[Object],
    depsgraph: Depsgraph,
    measured: Mapping[Object, stack.Measured] = NOT_MEASURED,
) -> list[verdict.Finding]:
    """Return a note if solids overlap, other than copies left in place and operands of Booleans.

    measured: fresh measurements, whose surfaces need not be read again.
    """
    copies = copies_in_place(objects)
    operands = operands_of(objects)
    pairs = _overlapping_pairs(
        [obj for obj in objects if obj.name not in copies and obj not in operands],
        lambda obj, limit: _closed_surface(obj, depsgraph, limit, measured.get(obj)),
    )
    if not pairs:
        return []
    first, second = pairs[0]
    return [
        verdict.finding(
            findings.BODIES_OVERLAP,
            count=len(pairs),
            first=first,
            second=second,
            pairs=pairs[:MAX_NAMED],
        )
    ]


def _overlapping_pairs(
    objects: Sequence[Object], read_surface: Callable[[Object, int], mesh.Surface | None]
) -> list[list[str]]:
    """Return the names of the pairs of closed solids that certainly share space, sorted."""
    solids = [
        obj
        for obj in sorted(objects, key=lambda obj: obj.name)
        if obj.type != "EMPTY"
        and (obj.body_moments.kind, obj.body_moments.mass_from) == ("SOLID", "DENSITY")
    ]
    if len(solids) < 2:
        return []
    corners = np.array([[corner[:] for corner in obj.bound_box] for obj in solids], np.float64)
    matrices = np.array([bodies.float64_matrix(obj.matrix_world) for obj in solids])
    corners = corners @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]
    low, high = corners.min(axis=1), corners.max(axis=1)
    size = float(np.linalg.norm(high.max(axis=0) - low.min(axis=0)))
    # Boxes and bodies that share less than the margin touch, but do not overlap.
    margin = verdict.welding_tolerance(size, float(np.spacing(np.float32(np.abs(corners).max()))))
    # Pairs beyond MAX_PAIRS remain untested: only certain overlaps are reported.
    first, second, _ = mesh.overlapping_box_pairs(low, high, margin, MAX_PAIRS)
    meet = _boxes_meet(corners[first], corners[second])
    surfaces: dict[str, mesh.Surface] = {}
    remaining_triangles = MAX_TRIANGLES
    for i in np.unique([first[meet], second[meet]]).tolist():
        surface = read_surface(solids[i], remaining_triangles)
        if surface is not None:
            remaining_triangles -= len(surface.triangles)
            surfaces[solids[i].name] = surface
    if len(surfaces) < 2:
        return []
    names = [*surfaces]
    joined = mesh.join_surfaces([*surfaces.values()])
    counts = [len(surface.triangles) for surface in surfaces.values()]
    component_of_triangle = np.repeat(np.arange(len(counts)), counts)
    components = mesh.sort_components(
        joined.points, joined.triangles, component_of_triangle, len(counts)
    )
    extent = np.linalg.norm(components.high - components.low, axis=1)
    is_solid = (
        np.abs(components.volume) > verdict.CLOSED_SHEET_VOLUME_RTOL * extent * components.area
    )
    relations = solid.classify_pairs(joined.points, components, is_solid, margin)
    pairs = np.sort(np.concatenate([relations.contained_in, relations.intersecting]), axis=1)
    return [[names[i], names[j]] for i, j in np.unique(pairs, axis=0).tolist()]


def _boxes_meet(first: Array, second: Array) -> Mask:
    """Return a (k,) mask of the pairs of turned boxes, (k, 8, 3) corners each, that no plane along
    two of their edges separates.
    """
    # In Blender's `bound_box`, edges lead from corner 0 to the corners 1, 3 and 4. If boxes are
    # separate, so are their images along a face normal or the cross product of two edges.
    first_edges = first[:, [1, 3, 4]] - first[:, :1]
    second_edges = second[:, [1, 3, 4]] - second[:, :1]
    across = cross_rows(first_edges[:, :, None], second_edges[:, None]).reshape(-1, 9, 3)
    faces = [cross_rows(edges, np.roll(edges, 1, axis=1)) for edges in (first_edges, second_edges)]
    normals = np.concatenate([across, *faces], axis=1).transpose(0, 2, 1)
    along_first = first @ normals  # (k, 8 corners, 15 normals)
    along_second = second @ normals
    gap = np.maximum(
        along_first.min(axis=1) - along_second.max(axis=1),
        along_second.min(axis=1) - along_first.max(axis=1),
    )
    return ~(gap > 0.0).any(axis=1)


def _closed_surface(
    obj: Object, depsgraph: Depsgraph, limit: int, measured: stack.Measured | None
) -> mesh.Surface | None:
    """Return the surface of a closed object in the world, in Blender units; None if it is open or
    cannot be read, or has no triangles or more than `limit`.
    """
    try:
        reading = (
            measured.reading
            if measured is not None
            else read.objects.read_object(obj, depsgraph, edges=False)
        )
    except verdict.MeasureError:  # such as a grid of densities
        return None
    count = sum(part.surface.triangle_count * len(part.matrices) for part in reading.parts)
    if not 0 < count <= limit:
        return None
    if measured is None or not measured.is_faultless:  # a faultless surface is closed
        for part in reading.parts:
            boundary = mesh.BoundarySum()
            boundary.add(part.surface)
            if not boundary.is_zero:
                return None
    return reading.join()
