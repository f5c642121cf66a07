# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The fourth stage of measuring a solid: relations between its components, and components that are
inside out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..mesh import SortedComponents, Surface, sort_components, triangle_areas
from ..moments import Moments, sum_moments
from ..numerics import Array, Floats, Index, Integers, Mask, NDArray, PerBody, lengths
from ..polyhedron import polyhedron_moments
from ..verdict import CLOSED_SHEET_VOLUME_RTOL, FLAT_CAP_VOLUME_RTOL, MeshHealth
from .closedness import CheckedSurface, GivenIntegrals
from .nesting import ComponentRelations, cavity_host, classify_pairs, orient_nested_components
from .repaired_mesh import RepairedMesh, copy_with


@dataclass(frozen=True, eq=False)
class ComponentComparison:
    """Result of comparing the components of a body; masks are (c,).

    `flipped`: components to turn. `solid`: with a volume. `nested`, `cavities`: outward and inward
    ones inside the material of another. `intersecting`: overlapping others, except `breaking` ones:
    cavities that break through the wall around them, by at most `breakthrough` (unit). `host`: as
    `ClosedParts.host_part`. `undecided_pairs`: number of pairs that would have been too much work.
    """

    flipped: Mask
    solid: Mask
    nested: Mask
    cavities: Mask
    intersecting: Mask
    breaking: Mask
    breakthrough: float
    host: Index
    undecided_pairs: int

    @classmethod
    def from_relations(
        cls, components: SortedComponents, relations: ComponentRelations, solid: Mask
    ) -> ComponentComparison:
        """Decide which components to turn, from the relations between the solid ones."""
        flipped, nested, cavities = orient_nested_components(components, relations, solid)
        intersecting, breaking = np.zeros((2, len(solid)), bool)
        inner, outer = relations.mostly_in.T
        breaks_through = cavities[inner] & ~cavities[outer]
        breaking[inner[breaks_through]] = True
        # Pairs as one number; those that break through do not count as intersecting.
        keys = relations.intersecting @ [len(solid), 1]
        breaking_keys = relations.mostly_in[breaks_through] @ [len(solid), 1]
        intersecting[relations.intersecting[~np.isin(keys, breaking_keys)]] = True
        return cls(
            flipped,
            solid,
            nested,
            cavities,
            intersecting,
            breaking,
            breakthrough=float(relations.breakthrough[breaks_through].max(initial=0.0)),
            host=cavity_host(relations, cavities),
            undecided_pairs=relations.undecided_pairs,
        )

    def add_to(self, report: MeshHealth) -> MeshHealth:
        """Return the report with the numbers of nested components, cavities and overlapping
        components.
        """
        return copy_with(
            report,
            nested_components=int(self.nested.sum()),
            cavities=int(self.cavities.sum()),
            overlapping_components=int(self.intersecting.sum()),
        )


@dataclass(frozen=True, eq=False)
class ClosedParts:
    """Triangles, (t, 3), turned and with caps, whose signed sum is the body; and the closed part
    that each bounds.

    face: (t,) the mesh face of each, -1 for a cap. part: (t,), 0 to number - 1. host_part:
    (number,) the part to whose volume a part belongs: itself, or for a cavity the part around it.
    """

    points: Floats
    triangles: Integers
    face: Integers
    part: Integers
    number: int
    host_part: Integers

    def areas(self, linear: NDArray | None = None) -> Array:
        """Return (t,) areas of the triangles under a (3, 3) map, by default as they are."""
        points = self.points.astype(np.float64)
        if linear is not None:
            points = points @ np.asarray(linear).T
        return triangle_areas(points, self.triangles)


@dataclass(frozen=True, eq=False)
class OrientedSolid:
    """A body with components that face as they count; masks are (c,).

    `is_proven`: True if nothing had to be repaired, so that `surface` has the input's faces.
    `surface`: the surface with the signed sum `volume`: without flat parts, with caps; not
    negative, except for rounding noise of flat bodies. `is_solid`: True if any component has a
    volume. `solid`: the components that have one. `turned`: components turned as a whole.
    `reversed`: components with triangles in `mesh` that run against `surface`. `comparison`: None
    for one component.
    """

    mesh: RepairedMesh
    is_proven: bool
    surface: Surface
    volume: Moments
    is_solid: bool
    solid: Mask
    turned: Mask
    reversed: Mask
    comparison: ComponentComparison | None

    def closed_parts(self) -> ClosedParts:
        """Return the triangles of ``surface`` by closed part."""
        mesh = self.mesh
        host = np.arange(mesh.number) if self.comparison is None else self.comparison.host
        if self.is_proven:
            triangles, face = self.surface.all_triangles()
            part = np.zeros(len(face), np.intp)
            if mesh.number > 1:
                of_face = np.zeros(int(mesh.face.max()) + 1, np.intp)
                of_face[mesh.face] = mesh.component
                part = of_face[face]
            return ClosedParts(self.surface.points, triangles, face, part, mesh.number, host)
        included = np.ones(len(mesh.face), bool)
        if self.comparison is not None:
            included = (mesh.open | self.comparison.solid)[mesh.component]
            included |= not included.any()
        triangles = np.where(
            self.reversed[mesh.component][:, None], mesh.triangles[:, ::-1], mesh.triangles
        )
        return ClosedParts(
            mesh.points,
            triangles[included],
            mesh.face[included],
            mesh.component[included],
            mesh.number,
            host,
        )


def orient_components(
    checked: CheckedSurface, given: GivenIntegrals, mesh: RepairedMesh, threads: int
) -> OrientedSolid:
    """Compare the components of a body, turn components that are inside out, and integrate the
    result.
    """
    is_proven = mesh is given.proven
    comparison = None
    flipped = np.zeros(mesh.number, bool)
    counted = np.ones(mesh.number, bool)
    if mesh.number > 1:
        comparison = compare_components(mesh, checked.tolerance, checked.error)
        flipped = comparison.flipped
        counted = comparison.solid
    surface, volume = checked.surface, given.volume
    if comparison is not None or not is_proven:
        surface = _oriented_surface(surface, mesh, flipped, counted, is_proven)
    if surface is not checked.surface:
        volume = _integrate_oriented(given, mesh, flipped, surface, threads)
    total = volume.total
    has_open = bool(mesh.open.any())
    threshold = zero_volume(checked.size, given.area.total, bool(mesh.caps.any()), checked.error)
    is_solid = bool(abs(total) > max(threshold, volume.rounding_error[0]))
    if comparison is None:
        solid = np.full(mesh.number, is_solid)
        # An open surface has no inside.
        turned = np.full(mesh.number, is_solid and total < 0.0 and not has_open)
    else:
        solid = comparison.solid
        turned = flipped
        is_solid = bool(solid.any()) or (is_solid and has_open)
    inside_out = total < 0.0 and (is_solid or has_open)
    if inside_out:
        volume = replace(volume, raw=-volume.raw)
        surface = replace(
            surface, quads=surface.quads[:, [0, 3, 2, 1]], triangles=surface.triangles[:, ::-1]
        )
    return OrientedSolid(
        mesh, is_proven, surface, volume, is_solid, solid, turned, flipped ^ inside_out, comparison
    )


def compare_components(mesh: RepairedMesh, tolerance: float, error: float) -> ComponentComparison:
    """Find the components with a volume, and their relations.

    Points touch nearer than `tolerance`.
    """
    components = sort_components(mesh.points, mesh.triangles, mesh.component, mesh.number)
    size = lengths(components.high - components.low)[:, 0]
    threshold = zero_volume(size, components.area, mesh.caps.any(axis=1), error)
    solid = ~mesh.open & (np.abs(components.volume) > threshold)
    return ComponentComparison.from_relations(
        components, classify_pairs(mesh.points, components, solid, tolerance), solid
    )


def zero_volume(size: PerBody, area: PerBody, capped: PerBody, error: PerBody) -> PerBody:
    """Return the volume (unit³) below which a component is flat: its area times the thickness of a
    sheet that counts as flat, by rounding and float32.

    size: diagonal of the box. area: unit². capped: True if the component has caps. error: largest
    shift of points by storing, of which a cap moves with several, so that it allows for four.
    """
    return (
        np.where(
            capped,
            FLAT_CAP_VOLUME_RTOL * size + 4.0 * error,
            np.maximum(CLOSED_SHEET_VOLUME_RTOL * size, error),
        )
        * area
    )


def _oriented_surface(
    surface: Surface,
    mesh: RepairedMesh,
    flip: Mask,
    solid: Mask,
    proven: bool,
) -> Surface:
    """Return the surface with the signed sum of the body; `surface` itself if it is that.

    flip, solid: (c,) components to turn, and components with a volume. proven: True if `mesh` has
    the faces of `surface`.
    """
    flipped = mesh.flipped ^ flip[mesh.component]
    included = (mesh.open | solid)[mesh.component]  # Flat parts would only add rounding.
    is_changed = mesh.topology_changed or flipped.any() or (mesh.face < 0).any()
    if not is_changed and (included.all() or not included.any()):
        return surface
    if proven:
        quads = surface.quads.copy()
        triangles = surface.triangles.copy()
        # The mesh has the triangles first, then both halves of each quad: `Surface.all_triangles`.
        flipped_triangles = flipped[: len(triangles)]
        triangles[flipped_triangles] = triangles[flipped_triangles][:, ::-1]
        flipped_quads = flipped[len(triangles) :: 2]  # by their first halves
        # The first corner stays, and with it the diagonal.
        quads[flipped_quads] = quads[flipped_quads][:, [0, 3, 2, 1]]
        return replace(surface, quads=quads, triangles=triangles)
    triangles = mesh.triangles
    if flip.any():
        triangles = np.where(flip[mesh.component][:, None], triangles[:, ::-1], triangles)
    displacement = surface.displacement
    if mesh.max_displacement:
        displacement = surface.coordinate_error + mesh.max_displacement
    return Surface(
        mesh.points, triangles if included.all() else triangles[included], displacement=displacement
    )


def _integrate_oriented(
    given: GivenIntegrals,
    mesh: RepairedMesh,
    flip: Mask,
    measured: Surface,
    threads: int,
) -> Moments:
    """Return the volume moments of the measured surface; only its caps are integrated if the rest
    is as given.
    """
    integrate = partial(polyhedron_moments, area_order=0, threads=threads, allow_open=True)
    is_cap = mesh.face < 0
    is_turned = mesh.flipped.any() or flip.any()
    is_complete = len(measured.triangles) == len(mesh.triangles)
    if mesh.topology_changed or is_turned or not is_complete or not is_cap.any():
        return integrate(measured)[0]
    # Row i of the measured surface is row i of the mesh: nothing was left out.
    caps = replace(measured, triangles=measured.triangles[is_cap])
    return sum_moments([given.volume, integrate(caps, about=given.volume.about)[0]])
