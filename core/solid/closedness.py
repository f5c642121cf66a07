# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The first stages of measuring a solid: a check that it can be measured, and a proof of closedness
by its edges.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from .. import mesh, moments, verdict
from ..numerics import Index, Integers, Mask, NDArray, connected_components, indices_in_range
from ..polyhedron import polyhedron_moments, third_order
from . import findings, repaired_mesh


@dataclass(frozen=True, eq=False)
class CheckedSurface:
    """A surface that can be measured, without the vertices that no face uses; lengths in its unit.

    `vertices`: (n,) the input's number of each vertex; None if all are used. `size`: diagonal of
    the bounding box. `error`: largest shift of the points by storing. `tolerance`: distance below
    which points touch.
    """

    surface: mesh.Surface
    vertices: Index | None
    size: float
    error: float
    tolerance: float


@dataclass(frozen=True, eq=False)
class GivenIntegrals:
    """Integrals over the faces as given: `volume` to order 3, and `area`.

    `proven`: the mesh if its own edges prove it closed and oriented, else None.
    """

    volume: moments.Moments
    area: moments.Moments
    planarity: mesh.Planarity
    proven: repaired_mesh.RepairedMesh | None


def check_surface(surface: mesh.Surface) -> CheckedSurface:
    """Check that a surface can be measured, or raise MeasureError; leave out vertices that no face
    uses.
    """
    faces = [corners for corners in (surface.quads, surface.triangles) if len(corners)]
    if not faces:
        raise verdict.MeasureError(verdict.NO_FACES)
    total = len(surface.points)
    if not all([indices_in_range(corners, total) for corners in faces]):
        raise verdict.MeasureError(findings.INVALID_FACES)
    vertices = None
    is_used = _used_vertices(faces, total)
    if not is_used.all():
        vertices = np.flatnonzero(is_used)
        new_number = np.cumsum(is_used) - 1
        ring = surface.corner_vertices
        surface = replace(
            surface,
            points=surface.points[is_used],
            triangles=new_number[surface.triangles],
            quads=new_number[surface.quads],
            corner_vertices=None if ring is None else new_number[ring],
        )
    low, high = surface.box
    with np.errstate(invalid="ignore", over="ignore"):
        size = float(np.linalg.norm(high - low))
    if not np.isfinite(size):  # by finite but huge coordinates, too: the next check refuses these
        misplaced = np.flatnonzero(~np.isfinite(surface.points).all(axis=1))
        if len(misplaced):
            elements = misplaced if vertices is None else vertices[misplaced]
            raise verdict.MeasureError(
                findings.NON_FINITE_VERTICES, elements=elements, count=len(misplaced), total=total
            )
    if not max(size, float(np.abs([low, high]).max())) < verdict.MAX_COORDINATE:
        raise verdict.MeasureError(verdict.OBJECT_SIZE, fault=verdict.TOO_LARGE)
    verdict.check_size(*(high - low).tolist())
    error = float(np.linalg.norm(surface.coordinate_error))
    return CheckedSurface(
        surface, vertices, size, error, tolerance=verdict.welding_tolerance(size, error)
    )


def _used_vertices(faces: list[Integers], total: int) -> Mask:
    """Return a (total,) mask of the vertices that are corners of triangles or quads."""
    is_used = np.zeros(total, bool)
    for column in (0, 2, 1, 3):  # opposite corners first: they reach most vertices
        for corners in faces:
            if column < corners.shape[1]:
                is_used[corners[:, column].astype(np.intp)] = True
        if is_used.all():
            break
    return is_used


def integrate_and_prove(checked: CheckedSurface, shell: bool, threads: int) -> GivenIntegrals:
    """Integrate over the given faces, areas to order 3 of a shell, and meanwhile test if the
    edges prove the surface closed.
    """
    surface = checked.surface
    accumulator = mesh.PlanarityAccumulator(surface, checked.error)
    integrate = partial(
        polyhedron_moments,
        surface,
        area_order=3 if shell else 0,
        threads=threads,
        planarity=accumulator,
        allow_open=True,
    )
    if min(threads, surface.triangle_count // third_order.MIN_TRIANGLES_PER_THREAD) > 1:
        with ThreadPoolExecutor(1) as pool:
            waiting = pool.submit(prove_closed, surface)
            volume, area = integrate()
        proven = waiting.result()
    else:
        volume, area = integrate()
        proven = prove_closed(surface)
    return GivenIntegrals(volume, area, accumulator.planarity(), proven)


def prove_closed(surface: mesh.Surface) -> repaired_mesh.RepairedMesh | None:
    """Return the mesh if its own edges prove it closed and oriented, without triangles if one
    component; else None.
    """
    sides = _closed_side_faces(surface)
    if sides is None:
        return None
    component, component_count = connected_components(int(sides.max()) + 1, *sides)
    triangles = surface.triangles[:0]
    face = component[:0]
    if component_count > 1:  # only components are compared triangle by triangle
        triangles, face = surface.all_triangles()
    return repaired_mesh.RepairedMesh(
        surface.points,
        triangles,
        face,
        flipped=np.zeros(len(face), bool),
        component=component[face],
        number=component_count,
        open=np.zeros(component_count, bool),
        caps=np.zeros((component_count, 3)),
        report=verdict.MeshHealth(closed=True, components=component_count),
    )


def _closed_side_faces(surface: mesh.Surface) -> NDArray[np.int32] | None:
    """Return the (2, e) mesh faces beside each edge; None if not proven closed and oriented."""
    if surface.corner_edges is not None:
        return mesh.closed_side_faces(surface)
    # Without the mesh's edges, rows must be mesh faces, with the same number of corners each.
    if surface.triangle_faces is not None or surface.quad_faces is not None:
        return None
    if len(surface.triangles) and len(surface.quads):
        return None
    faces = surface.triangles if len(surface.triangles) else surface.quads
    return mesh.faces_beside_edges(faces, len(surface.points))
