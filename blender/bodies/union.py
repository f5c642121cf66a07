# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface around the union of shells, by Blender's Booleans.

Shells whose boxes meet no other box stay as they are. The others are united by the solver Manifold,
which needs a twentieth of the time and of the memory of the solver Exact, but takes closed shells
only that do not go through themselves; all else, and Blenders built without it, need Exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

from ...core import bodies, polyhedron, verdict
from ...core.mesh import Surface, join_surfaces, keep_used, overlapping_box_pairs
from ...core.numerics import Array, Index, Integers
from ...core.solid import CAVITIES_BREAK_THROUGH, NON_MANIFOLD_COMPONENTS, measure_solid
from ..read.mesh import mesh_surface

MAX_PAIRS = 2_000_000  # pairs of boxes; if there are more, all shells are united at once
TOUCHING_RTOL = 1e-6  # Relative to the size: boxes nearer than this meet.
VOLUME_RTOL = 1e-5  # Relative to the volume of the union, beyond its bounds.
# A tetrahedron apart from all bodies, whose coordinates are scaled to at most 1.
MARKER = np.array([(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0), (0.0, 0.0, 0.1)]) + 1.2
MARKER_FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
PointsAndTriangles = tuple[Array, Integers]


def unite(body: bodies.MeshBody) -> Surface:
    """Return the surface around the union of a body's shells, each in all its places."""
    surfaces = []
    shells = []  # (t,) shell of each triangle of each surface, numbered across all surfaces
    shell_count = 0
    for solid, matrices in body.solids:
        parts = solid.oriented.closed_parts()
        error = solid.repaired_surface.coordinate_error
        surface = Surface(parts.points, parts.triangles, displacement=error)
        for matrix in matrices:
            surfaces.append(surface.transform(matrix[:3, :3], matrix[:3, 3]))
            # A cavity is part of the shell around it, its host.
            shells.append(parts.host_part[parts.part] + shell_count)
            shell_count += parts.number
    self_intersections = {solid.health.self_intersection for solid, _ in body.solids}
    codes = {finding.code for solid, _ in body.solids for finding in solid.findings}
    is_simple = (
        body.method.procedure != verdict.Procedure.OPEN
        and self_intersections <= {verdict.Intersection.EXCLUDED, verdict.Intersection.NOT_FOUND}
        and not codes & {CAVITIES_BREAK_THROUGH, NON_MANIFOLD_COMPONENTS}
    )
    joined = join_surfaces(surfaces)
    return _unite_simple(joined, np.concatenate(shells)) if is_simple else union_surface(joined)


def _unite_simple(surface: Surface, shell: Index) -> Surface:
    """Return the surface around the union of shells that do not go through themselves. shell: (t,)
    number of the shell of each triangle.
    """
    # Sorted by shell, so that each shell is a segment of the triangles; shells are numbered anew.
    order = np.argsort(shell, kind="stable")
    triangles = surface.triangles[order]
    starts = np.flatnonzero(np.diff(shell[order], prepend=-1))
    shell = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(order)))
    low = np.minimum.reduceat(surface.points[triangles].min(axis=1), starts)
    high = np.maximum.reduceat(surface.points[triangles].max(axis=1), starts)
    touching = TOUCHING_RTOL * float((high - low).max())
    # A negative margin: boxes that are apart by less meet, too.
    left, right, untested = overlapping_box_pairs(low, high, -touching, MAX_PAIRS)
    if untested:
        return union_surface(surface)
    layer = _layers(len(starts), left, right)[shell]
    parts = [_with_triangles(surface, triangles[layer == i]) for i in range(layer.max() + 1)]
    united = [_with_triangles(surface, triangles[layer < 0])]
    if parts:
        united.append(_by_manifold(parts) or union_surface(join_surfaces(parts)))
    return join_surfaces([part for part in united if part.triangle_count])


def _layers(count: int, left: Index, right: Index) -> Index:
    """Return (count,) layers of boxes so that the boxes of a layer do not meet; -1 for boxes that
    meet no other.
    """
    neighbors: list[list[int]] = [[] for _ in range(count)]
    for i, j in zip(left.tolist(), right.tolist()):
        neighbors[i].append(j)
        neighbors[j].append(i)
    layers = np.full(count, -1)
    for i, others in enumerate(neighbors):
        if others:
            taken = {layers[j] for j in others}
            layers[i] = next(layer for layer in range(count) if layer not in taken)
    return layers


def _with_triangles(surface: Surface, triangles: Integers) -> Surface:
    """Return a surface of some triangles, without the points of others."""
    return Surface(*keep_used(surface.points, triangles), displacement=surface.coordinate_error)


def _by_manifold(layers: Sequence[Surface]) -> Surface | None:
    """Return the surface around the union of layers of shells; None if Blender has no such solver
    or refuses them.

    The solver unites them with a marker beside them: if it fails, the marker is all that it leaves.
    """
    joined = join_surfaces(layers)
    middle, scale = _unit_cube(joined)
    operands = [((layer.points - middle) / scale, layer.triangles) for layer in layers]
    result = _evaluate((MARKER, MARKER_FACES), operands, "MANIFOLD")
    triangles = result.all_triangles()[0]
    is_of_body = (result.points < MARKER.min() - 0.1).all(axis=1)[triangles].all(axis=1)
    if not is_of_body.any():
        return None
    united = _with_triangles(result, triangles[is_of_body])
    united = united.transform(scale * np.eye(3), middle)
    volume = polyhedron.volume_and_center(united)[0]
    volumes = [polyhedron.volume_and_center(layer)[0] for layer in layers]
    slack = VOLUME_RTOL * sum(volumes)
    if not max(volumes) - slack <= volume <= sum(volumes) + slack:
        return None
    # The solver moves points by twice the rounding of the coordinates, which is done twice.
    return replace(united, displacement=4.0 * united.coordinate_error + joined.coordinate_error)


def union_surface(surface: Surface) -> Surface:
    """Return the surface around the union of all shells by the solver Exact, computed in float32
    about their middle and at unit size.
    """
    middle, scale = _unit_cube(surface)
    united = _evaluate(((surface.points - middle) / scale, surface.all_triangles()[0]), [], "EXACT")
    # Blender rounds the points to float32 before its boolean and after it, and the points
    # themselves were rounded once.
    united = united.transform(scale * np.eye(3), middle)
    return replace(united, displacement=2.0 * united.coordinate_error + surface.coordinate_error)


def _unit_cube(surface: Surface) -> tuple[Array, float]:
    """Return the middle of a surface's points, and the power of two, which rounds nothing, that
    scales them to at most 1.
    """
    low, high = surface.box
    return (low + high) / 2.0, 2.0 ** float(np.ceil(np.log2((high - low).max() / 2.0)))


def subtract(body: Surface, cutters: Sequence[Surface]) -> Surface | None:
    """Return the surface of a body without the space inside cutters, or None if the Boolean
    fails; without triangles if nothing is left. All must be closed. The Boolean has failed if the
    result is open, larger than the body, or smaller than by the sum of the cutters.
    """
    middle, scale = _unit_cube(join_surfaces([body, *cutters]))
    first, *operands = (
        ((surface.points - middle) / scale, surface.all_triangles()[0])
        for surface in (body, *cutters)
    )
    rest = _evaluate(first, operands, "EXACT", "DIFFERENCE")
    if not rest.triangle_count:
        return rest
    rest = rest.transform(scale * np.eye(3), middle)
    rest = replace(rest, displacement=2.0 * rest.coordinate_error + body.coordinate_error)
    solid = measure_solid(rest)
    body_volume = polyhedron.volume_and_center(body)[0]
    least = body_volume - sum(polyhedron.volume_and_center(cutter)[0] for cutter in cutters)
    slack = VOLUME_RTOL * body_volume
    is_right = least - slack <= solid.volume.total <= body_volume + slack
    return rest if is_right and solid.method == verdict.Procedure.EXACT else None


def _evaluate(
    body: PointsAndTriangles,
    operands: Sequence[PointsAndTriangles],
    solver: str,
    operation: str = "UNION",
) -> Surface:
    """Return the surface of Blender's Boolean of a body with operands, or without them its union
    with itself. All data that are made for it are removed.
    """
    created = []
    try:
        created.append(scene := bpy.data.scenes.new(""))
        created.append(collection := bpy.data.collections.new(""))
        scene.collection.children.link(collection)
        for index, (points, triangles) in enumerate((body, *operands)):
            created.append(mesh := bpy.data.meshes.new(""))
            mesh.vertices.add(len(points))
            mesh.attributes["position"].data.foreach_set(
                "vector", points.astype(np.float32).ravel()
            )
            mesh.loops.add(triangles.size)
            mesh.polygons.add(len(triangles))
            mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
            mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
            mesh.update(calc_edges=True)
            created.append(obj := bpy.data.objects.new("", mesh))
            (collection if index else scene.collection).objects.link(obj)
        obj = scene.collection.objects[0]
        boolean = obj.modifiers.new("", "BOOLEAN")
        boolean.operation = operation
        boolean.solver = solver
        boolean.operand_type = "COLLECTION"
        # With no operand the solver Exact still unites the object with itself.
        boolean.collection = collection
        boolean.use_self = solver == "EXACT" and not operands
        scene.view_layers[0].update()
        evaluated = obj.evaluated_get(scene.view_layers[0].depsgraph)
        united = mesh_surface(evaluated.to_mesh(), edges=False)
        evaluated.to_mesh_clear()
        return united
    finally:
        bpy.data.batch_remove(created)
