# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The signatures of many objects: objects of a stack that show the same shape share one signature."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ....core.mesh.surface_stack import TriangleStack
from ....core.moments.affine_maps import are_similarities
from ....core.numerics.arrays import segment_starts
from ....core.polyhedron.any_order import extend_small_moments
from ....core.polyhedron.third_order_small import small_moments
from ....core.shape.signatures import Signature, signatures
from ....core.shape.zernike import MAX_DESCRIPTOR_ERROR
from ..stacks.many import measured_in_turn
from ..stacks.stack import MeasuredStack, Stacked
from .shape import SURFACE_OPTIONS, Shape, surface_shape, surface_shape_of
from .surface_distance import EXACT_DISTANCE


def signed_in_turn(
    objects: Sequence[bpy.types.Object], depsgraph: bpy.types.Depsgraph, order: int
) -> Callable[[bpy.types.Object], Signature | Shape]:
    """Return a function from an object to its signature, or to its `Shape` if it was measured outside a stack."""
    measured = measured_in_turn(objects, depsgraph, SURFACE_OPTIONS)
    known: dict[MeasuredStack, list[Signature | None]] = {}

    def signed(obj: bpy.types.Object) -> Signature | Shape:
        outcome = measured(obj)
        if not isinstance(outcome, Stacked):
            return surface_shape(outcome)
        if outcome.stack not in known:
            known.clear()
            known[outcome.stack] = stack_signatures(outcome.stack, order)
        return known[outcome.stack][outcome.index] or surface_shape_of(obj, depsgraph)

    return signed


def stack_signatures(stack: MeasuredStack, order: int) -> list[Signature | None]:
    """Return the signatures of a stack's members; None for repaired, distant and ill-conditioned members."""
    found: list[Signature | None] = [None] * len(stack.members)
    linear = np.array([member.matrix[:3, :3] for member in stack.members])
    is_even, determinant = are_similarities(linear), np.linalg.det(linear)
    solids = next((member.shape.solids for member in stack.members if member.shape.solids is not None), None)
    if solids is None:
        return found
    # A body is a shape in its own coordinates, or the unevenly mapped shape of a single object.
    body_of: dict[tuple[int, int], int] = {}
    rows, maps, of_member = [], [], {}
    for i, member in enumerate(stack.members):
        if member.shape.solids is None:
            continue
        key = (member.shape.row, -1 if is_even[i] else i)
        if key not in body_of:
            body_of[key] = len(rows)
            rows.append(member.shape.row)
            maps.append(np.eye(3) if is_even[i] else linear[i])
        of_member[i] = body_of[key]
    volume = solids.volume.at(np.array(rows))
    centers = volume.about + volume.raw[:, 1:4] / volume.raw[:, :1]
    of_bodies, scale = _signatures(solids.caps.triangles, np.array(rows), np.array(maps), centers, order)
    reach = np.finfo(np.float64).eps * np.abs(stack.mass_properties.center).max(axis=1)
    for i, body in of_member.items():
        own = of_bodies[body]
        mapped = 1.0 if is_even[i] else abs(determinant[i])
        size = float(scale[body] * own.size * np.cbrt(stack.stretch[i] / mapped))
        if own.error > MAX_DESCRIPTOR_ERROR or reach[i] > EXACT_DISTANCE / 2.0 * size:
            continue
        is_mirrored = bool(is_even[i] and determinant[i] < 0.0)
        found[i] = replace(own, size=size, chirality=-own.chirality if is_mirrored else own.chirality)
    return found


def _signatures(
    stack: TriangleStack, rows: NDArray[np.intp], maps: NDArray, centers: NDArray, order: int
) -> tuple[list[Signature], NDArray[np.float64]]:
    """Return the signatures of linearly mapped surfaces, each scaled to about unit size, and the (k,) scales."""
    points, triangles, first = [], [], 0
    for row, linear, center in zip(rows.tolist(), maps, centers):
        start, begin = stack.first_point[row], stack.first_triangle[row]
        own = (stack.points[start : start + stack.point_counts[row]] - center) @ linear.T
        corners = stack.triangles[begin : begin + stack.triangle_counts[row]] - start + first
        points.append(own)
        triangles.append(corners[:, ::-1] if np.linalg.det(linear) < 0.0 else corners)
        first += len(own)
    counts, point_counts = stack.triangle_counts[rows], stack.point_counts[rows]
    starts = segment_starts(point_counts)
    places = np.concatenate(points)
    radius = np.sqrt(np.maximum.reduceat((places * places).sum(axis=1), starts))
    scale = 2.0 ** np.frexp(radius)[1]  # a power of two rounds nothing
    places /= np.repeat(scale, point_counts)[:, None]
    reach, nothing = np.maximum.reduceat(np.abs(places), starts), np.zeros((len(rows), 3))
    joined = np.concatenate(triangles)
    volume = small_moments(places, joined, counts, nothing, reach, nothing, area=False, area_moments=False)[0]
    volume = extend_small_moments(volume, order, places, joined, counts, reach)
    return signatures(volume, radius / scale), scale
