# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signatures of many objects: those of a stack are computed together, one for each shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import bpy
import numpy as np

from ....core import polyhedron
from ....core.measurement import Measurement
from ....core.moments import are_similarities
from ....core.numerics import NDArray, segment_starts
from ....core.shape import MAX_DESCRIPTOR_ERROR
from ....core.shape.signatures import Signature, signatures
from ....core.solid import SmallSolid
from .. import measure_object, stack
from .object_shape import SURFACE_OPTIONS, Shape, surface_shape, surface_shape_of
from .surface_distance import EXACT_DISTANCE


def signatures_in_turn(
    objects: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph, order: int
) -> Callable[[bpy.types.Object], Signature | Shape]:
    """Return a function from each object, in the given order, to its signature, or to its `Shape`
    if it was measured outside a stack.
    """
    measured = measure_object.measured_in_turn(objects, depsgraph, SURFACE_OPTIONS)
    # Only the signatures of the last stack are kept, because objects come stack by stack.
    by_stack: dict[Measurement, list[Signature | None]] = {}

    def signature_of(obj: bpy.types.Object) -> Signature | Shape:
        row = measured(obj)
        if row.index is None:
            return surface_shape(row)
        if row.stack not in by_stack:
            by_stack.clear()
            by_stack[row.stack] = stack_signatures(row, order)
        return by_stack[row.stack][row.index] or surface_shape_of(obj, depsgraph)

    return signature_of


def stack_signatures(row: stack.Measured, order: int) -> list[Signature | None]:
    """Return the signatures of all members of a row's stack; None for repaired, distant and
    ill-conditioned members.
    """
    members = row.members
    linear = np.array([member.matrix[:3, :3] for member in members])
    is_even = are_similarities(linear)
    determinant = np.linalg.det(linear)
    # A body is a shape in its own coordinates, which all its evenly mapped members share, or the
    # unevenly mapped shape of a single member.
    body_indices: dict[tuple[int, int | None], int] = {}
    mapped_solids = []
    body_of_member = {}
    for i, member in enumerate(members):
        solid = row.shapes[member.shape]
        if not isinstance(solid, SmallSolid):
            continue
        key = (member.shape, None if is_even[i] else i)
        if key not in body_indices:
            body_indices[key] = len(mapped_solids)
            mapped_solids.append((solid, np.eye(3) if is_even[i] else linear[i]))
        body_of_member[i] = body_indices[key]
    result: list[Signature | None] = [None] * len(members)
    if not mapped_solids:
        return result
    body_signatures = _signatures(mapped_solids, order)
    center = row.stack.mass_properties.center
    rounding = np.finfo(np.float64).eps * np.abs(center).max(axis=1)
    growth = row.stack.volume / row.shapes.volume.total[[member.shape for member in members]]
    for i, body in body_of_member.items():
        signature = body_signatures[body]
        # The size of an unevenly mapped body contains its map already, but not the unit.
        remaining_growth = growth[i] if is_even[i] else growth[i] / abs(determinant[i])
        size = float(signature.size * np.cbrt(remaining_growth))
        if signature.error > MAX_DESCRIPTOR_ERROR or rounding[i] > EXACT_DISTANCE / 2.0 * size:
            continue
        is_mirrored = bool(is_even[i] and determinant[i] < 0.0)
        chirality = -signature.chirality if is_mirrored else signature.chirality
        result[i] = replace(signature, size=size, chirality=chirality)
    return result


def _signatures(mapped_solids: list[tuple[SmallSolid, NDArray]], order: int) -> list[Signature]:
    """Return the signatures of solids, each mapped by a (3, 3) matrix."""
    points = []
    triangles = []
    point_count = 0
    for solid, linear in mapped_solids:
        parts = solid.parts()
        points.append((parts.points - solid.volume.center) @ linear.T)
        corner_step = -1 if np.linalg.det(linear) < 0.0 else 1  # a mirrored solid faces outward
        triangles.append(parts.triangles[:, ::corner_step] + point_count)
        point_count += len(parts.points)
    triangle_counts = np.array([len(corners) for corners in triangles])
    point_counts = np.array([len(corners) for corners in points])
    starts = segment_starts(point_counts)
    joined_points = np.concatenate(points)
    joined_triangles = np.concatenate(triangles)
    radius = np.sqrt(np.maximum.reduceat((joined_points * joined_points).sum(axis=1), starts))
    # Each solid is scaled to about unit size by a power of two, which rounds nothing.
    scale = 2.0 ** np.frexp(radius)[1]
    joined_points /= np.repeat(scale, point_counts)[:, None]
    reach = np.maximum.reduceat(np.abs(joined_points), starts)
    origins = np.zeros((len(mapped_solids), 3))
    volume = polyhedron.small_moments(
        joined_points,
        joined_triangles,
        triangle_counts,
        origins,
        reach,
        origins,
        area=False,
        area_moments=False,
    )[0]
    volume = polyhedron.extend_small_moments(
        volume, order, joined_points, joined_triangles, triangle_counts, reach
    )
    return [
        replace(signature, size=factor * signature.size)
        for signature, factor in zip(signatures(volume, radius / scale), scale.tolist())
    ]
