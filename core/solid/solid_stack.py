# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of small solids at once, one or many, if they face outward and are closed as they are
or by caps alone.

A solid may have one or several separate pieces. Results are exact or capped, with the same numbers
as from `measure_alone`, which measures all other solids. Caps are made if every edge has one face,
or two that agree, at each boundary vertex one side arrives and one leaves, every loop has an area,
and no vertices touch that a repair would weld.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..inertia import are_physical
from ..mesh import (
    Connections,
    LineGrids,
    StackPlanarity,
    Surface,
    SurfaceStack,
    TriangleStack,
    find_crossings,
    line_counts,
    may_have_neighbor,
    sort_components,
    stack_planarity,
)
from ..moments import Moments, U, sum_moments
from ..numerics import Array, Index, Mask, NDArray
from ..polyhedron import MAX_SMALL_TRIANGLES, MAX_UNSCALED_REACH, box_center, small_moments
from ..verdict import (
    WELDING_RTOL,
    DefectiveElements,
    Finding,
    Intersection,
    MeshHealth,
    Procedure,
)
from .boundary_loops import OwnedLoops, has_distinct_vertices, side_ends
from .orientation import OrientedSolid, zero_volume
from .repaired_mesh import RepairedMesh
from .self_intersection import MAX_UNSURE_LINES, SUM_ROUNDING, along_ray, find_cones, measure_excess
from .solid_method import SolidIntegrals, cap_finding, planarity_findings

MAX_COMPONENTS = 16  # Limit for one body: all pairs are compared.
# Times the volume of a flat component: bodies with smaller components are measured one by one.
CLEAR_VOLUME = 4.0


@dataclass(frozen=True, eq=False)
class SmallSolids:
    """The bodies of n small surfaces, meaningless unless measured.

    `is_measured`: (n,) surfaces closed as they are or by caps. `volume`, `area`: to order 3 and 0,
    about each body's own point; area without caps. `size`: (n,) diagonal of the bounding box.
    `intersection`: (n,) objects of type Intersection.
    """

    is_measured: Mask
    volume: Moments
    area: Moments
    size: Array
    planarity: StackPlanarity
    intersection: NDArray[np.object_]
    component_counts: Index
    caps: StackCaps


class SmallSolid(SolidIntegrals):
    """Body `i` of a stack, with results that are computed when they are asked for."""

    stack: SmallSolids
    i: int

    def __init__(self, stack: SmallSolids, i: int, surface: Surface):
        self.__dict__.update(
            stack=stack,
            i=i,
            given_surface=surface,
            volume=stack.volume.at(i),
            area=stack.area.at(i),
        )

    @cached_property
    def method(self) -> Procedure:  # type: ignore[override]
        return Procedure.CAPPED if self.stack.caps.is_capped[self.i] else Procedure.EXACT

    @cached_property
    def health(self) -> MeshHealth:  # type: ignore[override]
        planarity = self.stack.planarity
        edges = self.stack.caps.edges_of(self.i)
        return MeshHealth(
            closed=not len(edges),
            boundary_edges=len(edges),
            components=int(self.stack.component_counts[self.i]),
            non_planar_faces=int(planarity.non_planar_counts[self.i]),
            volume_spread=float(planarity.volume_spread[self.i]),
            cap_area_share=self._cap_share,
            self_intersection=Intersection(self.stack.intersection[self.i]),
            defective_elements=DefectiveElements(boundary_edges=edges),
        )

    @cached_property
    def findings(self) -> tuple[Finding, ...]:  # type: ignore[override]
        planarity = self.stack.planarity
        findings = planarity_findings(
            int(planarity.non_planar_counts[self.i]),
            float(planarity.volume_spread[self.i]),
            self.volume.total,
        )
        caps = self.stack.caps
        if caps.is_capped[self.i]:
            findings.insert(
                0,
                cap_finding(
                    caps.edges_of(self.i),
                    caps.counts[self.i],
                    self._cap_share,
                    size=float(self.stack.size[self.i]),
                    volume=self.volume.total,
                ),
            )
        return tuple(findings)

    @cached_property
    def oriented(self) -> OrientedSolid:  # type: ignore[override]
        mesh = self.stack.caps.mesh(self.i, self.given_surface, self.health)
        is_closed = self.health.closed
        all_components = np.ones(mesh.number, bool)
        return OrientedSolid(
            mesh,
            is_proven=is_closed,
            surface=self.given_surface if is_closed else Surface(mesh.points, mesh.triangles),
            volume=self.volume,
            is_solid=True,
            solid=all_components,
            turned=~all_components,
            reversed=~all_components,
            comparison=None,
        )

    @property
    def _cap_share(self) -> float:
        return float(self.stack.caps.counts[self.i, 2] / self.area.total)


def measure_small(surfaces: Sequence[Surface]) -> SmallSolids:
    """Measure the bodies of surfaces, at least one, that `SurfaceStack.takes`, if closed as they
    are or by caps.
    """
    stack = SurfaceStack.from_surfaces(surfaces)
    low, high = stack.box
    center = box_center(low, high, stack.points.dtype)
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)  # not rounded down
    volume, area = small_moments(
        stack.points,
        stack.triangles,
        stack.triangle_counts,
        center,
        reach,
        stack.coordinate_error,
        area=True,
        area_moments=False,
    )
    planarity = stack_planarity(stack)
    links = stack.connections()
    size = np.sqrt(np.add.reduce((high - low) ** 2, axis=1))
    farthest = reach.max(axis=1)
    usable = stack.uses_all_points() & ~planarity.has_degenerate
    # Bodies of other sizes are scaled before they are measured: `third_order.integrate`.
    usable &= (farthest > 1.0 / MAX_UNSCALED_REACH) & (farthest < MAX_UNSCALED_REACH)
    usable &= links.component_counts <= MAX_COMPONENTS
    error = np.sqrt(np.add.reduce(stack.coordinate_error**2, axis=1))
    tolerance = np.maximum(WELDING_RTOL * size, 4.0 * error)  # `verdict.welding_tolerance`
    caps = cap_stack(stack, links, usable, tolerance)
    if caps.is_capped.any():
        volume = caps.add_to(volume)
    triangles = caps.triangles
    is_measured = usable & (links.is_closed | caps.is_capped)
    flat = zero_volume(size, area.raw[:, 0], caps.is_capped, error)
    is_measured &= volume.raw[:, 0] > np.maximum(flat, volume.rounding_error[:, 0])
    # A star is a body, and does not go through itself.
    is_star = _find_stars(caps, volume, is_measured & (links.component_counts == 1))
    doubtful = np.flatnonzero(is_measured & ~is_star)
    if len(doubtful):
        is_measured[doubtful] = are_physical(
            volume.at(doubtful), low[doubtful], high[doubtful], size[doubtful]
        )
    several = np.flatnonzero(is_measured & (links.component_counts > 1))
    if len(several):
        is_measured[several] = _stand_apart(caps, several, links.component_counts, tolerance, error)
    intersection = np.full(len(stack), Intersection.NOT_CHECKED, object)
    intersection[is_measured] = Intersection.EXCLUDED
    rows = np.flatnonzero(is_measured & ~is_star)
    if len(rows):
        _, is_searched = triangles.owned(rows)
        intersection[rows] = _search_self_intersections(
            triangles.some(rows), tolerance[rows], _renumbered(caps.part[is_searched])
        )
        is_measured[rows] = intersection[rows] == Intersection.NOT_FOUND
    return SmallSolids(
        is_measured,
        volume,
        area,
        size,
        planarity,
        intersection,
        links.component_counts,
        caps,
    )


def _find_stars(caps: StackCaps, volume: Moments, candidates: Mask) -> Mask:
    """Return an (n,) mask of the `candidates`, (n,), that certainly are stars about their center of
    mass or the point of `volume`.
    """
    if not candidates.any():
        return candidates
    total = np.where(candidates, volume.raw[:, 0], 1.0)
    is_star = _are_stars(caps.triangles, volume.about + volume.raw[:, 1:4] / total[:, None])
    if not is_star[candidates & ~caps.is_capped].all():
        is_star |= ~caps.is_capped & _are_stars(caps.triangles, volume.about)
    return candidates & is_star


def _renumbered(labels: Index) -> Index:
    """Return labels from 0 on, without gaps, in the same order."""
    return np.unique(labels, return_inverse=True)[1].ravel()


def _stand_apart(
    caps: StackCaps, rows: Index, counts: Index, tolerance: Array, error: Array
) -> Mask:
    """Return a (k,) mask of the bodies `rows` whose parts face outward, surely have a volume, and
    stand apart.

    counts, tolerance, error: (n,) of all bodies: the number of parts, the distance of touch, and
    the largest shift of points by storing.
    """
    stack = caps.triangles
    _, is_chosen = stack.owned(rows)
    # The body of each part; parts are numbered body by body.
    body = np.repeat(np.arange(len(rows)), counts[rows])
    of_all = rows[body]  # its row in the arrays of all bodies
    parts = sort_components(
        stack.points, stack.triangles[is_chosen], _renumbered(caps.part[is_chosen]), len(body)
    )
    low = parts.low
    high = parts.high
    size = np.sqrt(np.add.reduce((high - low) ** 2, axis=1))
    is_bad = parts.volume <= CLEAR_VOLUME * zero_volume(
        size, parts.area, caps.is_capped[of_all], error[of_all]
    )
    least_gap = 2.0 * tolerance[of_all]  # twice, so that rounding cannot decide
    # All pairs of parts of a body: each with the next, with the one after that, and so on.
    for step in range(1, int(counts[rows].max())):
        gap = np.maximum(low[step:] - high[:-step], low[:-step] - high[step:]).max(axis=1)
        is_bad[:-step] |= (body[step:] == body[:-step]) & ~(gap > least_gap[:-step])
    return np.bincount(body, is_bad) == 0


def _are_stars(stack: TriangleStack, points: NDArray) -> Mask:
    """Return an (n,) mask of the bodies that certainly are stars about their (n, 3) points."""
    places = points.take(np.repeat(np.arange(len(stack)), stack.triangle_counts), 0).T[:, None]
    cones, is_crossed = find_cones(along_ray(stack.points.T.take(stack.triangles.T, 1), places))
    total, signed, crossings = np.add.reduceat(
        np.array([np.abs(cones), cones, is_crossed]), stack.first_triangle, axis=1
    )
    return (total - signed <= SUM_ROUNDING * total) & (crossings == 1.0)


def _search_self_intersections(
    stack: TriangleStack, tolerance: NDArray, part: Index
) -> NDArray[np.object_]:
    """Return the (k,) `Intersection` of each body, like `find_self_intersection`. part: (t,)
    triangles' components.
    """
    low, high = stack.box
    body = np.repeat(np.arange(len(tolerance)), stack.point_counts)
    grids = LineGrids.over_boxes(low, high, line_counts(stack.triangle_counts))
    crossings = find_crossings(Surface(stack.points, stack.triangles), grids, body)
    excess = measure_excess(crossings, grids, tolerance, part)
    state = np.where(excess.volume > 0.0, Intersection.FOUND, Intersection.NOT_FOUND).astype(object)
    state[excess.unsure > MAX_UNSURE_LINES] = Intersection.NOT_CHECKED
    return state


@dataclass(frozen=True, eq=False)
class StackCaps:
    """The caps of n surfaces; `is_capped`: (n,) mask of the surfaces that have any.

    `triangles`, `part`: t triangles of all surfaces, each surface's caps last, and the component of
    each. `cap_counts`: (n,) triangles that are caps. `counts`: (n, 3) holes with flat and with
    curved caps, and the caps' area. `edges`: (k, 2) sorted pairs of the surfaces' own vertices
    along the holes, by surface, `edge_counts` each.
    """

    is_capped: Mask
    triangles: TriangleStack
    part: Index
    cap_counts: Index
    counts: Array
    edges: Index
    edge_counts: Index

    def add_to(self, volume: Moments) -> Moments:
        """Return the volume moments of the surfaces with their caps, about the same points."""
        rows = np.flatnonzero(self.is_capped)
        stack = self.triangles.some(rows)
        counts = self.cap_counts[rows]
        center = volume.about[rows]
        low, high = stack.box
        first_cap = stack.first_triangle + stack.triangle_counts - counts
        is_cap = np.arange(len(stack.triangles)) >= np.repeat(first_cap, stack.triangle_counts)
        caps, _ = small_moments(
            stack.points,
            stack.triangles[is_cap],
            counts,
            center,
            np.maximum(high - center, center - low) * (1.0 + 4.0 * U),
            stack.coordinate_error,
            area=True,
            area_moments=False,
        )
        total = sum_moments([volume.at(rows), caps])
        changed = {
            name: getattr(volume, name).copy() for name in ("raw", "rounding_error", "input_error")
        }
        for name, values in changed.items():
            values[rows] = getattr(total, name)
        return replace(volume, **changed)

    def mesh(self, i: int, surface: Surface, report: MeshHealth) -> RepairedMesh:
        """Return one surface with its caps; without triangles if it is one component, and closed as
        it is.
        """
        number = report.components
        stack = self.triangles
        points = surface.points
        triangles = surface.triangles[:0]
        face = part = np.empty(0, np.intp)
        if number > 1 or not report.closed:
            start, begin = stack.first_point[i], stack.first_triangle[i]
            rows = slice(begin, begin + stack.triangle_counts[i])
            points = stack.points[start : start + stack.point_counts[i]]
            triangles = stack.triangles[rows] - start
            face = np.full(len(triangles), -1)
            face[: surface.triangle_count] = surface.all_triangles()[1]
            part = self.part[rows] - self.part[rows].min()
        return RepairedMesh(
            points,
            triangles,
            face,
            np.zeros(len(face), bool),
            part,
            number,
            np.zeros(number, bool),
            np.concatenate([self.counts[i : i + 1], np.zeros((number - 1, 3))]),
            report,
            capped_edges=self.edges_of(i),
        )

    def edges_of(self, i: int) -> Index:
        """Return the (k, 2) edges along the holes of one surface."""
        start = int(self.edge_counts[:i].sum())
        return self.edges[start : start + self.edge_counts[i]]


def cap_stack(
    stack: SurfaceStack,
    links: Connections,
    usable: Mask,
    tolerance: Array,
) -> StackCaps:
    """Cap `usable` surfaces that need nothing but caps. tolerance: (n,) distances of touch."""
    part = links.component[stack.triangle_faces]
    none = np.zeros(len(stack), np.intp)
    uncapped = StackCaps(
        none > 0, stack, part, none, np.zeros((len(stack), 3)), np.empty((0, 2), np.intp), none
    )
    fits = usable & links.is_open
    if not fits.any():
        return uncapped
    start, stop = links.open_sides
    owner = stack.point_owners
    total = len(stack.points)
    # At each boundary vertex one side arrives and one leaves.
    leaving = np.bincount(start, minlength=total)
    arriving = np.bincount(stop, minlength=total)
    fits &= np.logical_and.reduceat((leaving <= 1) & (leaving == arriving), stack.first_point)
    # No boundary vertices touch, and no vertices are at the same place.
    for vertices, reach in ((start, tolerance), (np.flatnonzero(fits[owner]), np.zeros(len(fits)))):
        body = owner[vertices]
        fits[body[may_have_neighbor(stack.points[vertices], reach[body], body)]] = False
    if not fits.any():
        return uncapped
    next_vertex = np.full(total, -1)  # along the boundary
    next_vertex[start] = stop
    begins, ends = side_ends(stack.triangles, np.arange(stack.triangles.size))
    is_boundary = next_vertex[begins] == ends
    boundary_counts = np.add.reduceat(is_boundary, 3 * stack.first_triangle, dtype=np.intp)
    # No two sides run the same way: diagonals may run along edges.
    is_candidate = np.repeat(fits, 3 * stack.triangle_counts)
    key = np.sort(begins[is_candidate] * total + ends[is_candidate])
    fits[owner[key[1:][key[1:] == key[:-1]] // total]] = False
    fits &= boundary_counts + stack.triangle_counts <= MAX_SMALL_TRIANGLES
    fits &= np.logical_and.reduceat(has_distinct_vertices(stack.triangles), stack.first_triangle)
    side = np.flatnonzero(is_boundary)
    # A body with a loop that cannot be capped is left out, and the loops of the rest are found
    # anew.
    while fits.any():
        side = side[fits[owner[begins[side]]]]
        start, stop = begins[side], ends[side]
        holes = OwnedLoops.of_sides(stack.points, start, stop, owner[start])
        bad = ~holes.loops.complete | ~holes.loops.has_area(tolerance[holes.owner])
        if not bad.any():
            return _capped(stack, part, fits, tolerance, side, holes)
        fits[holes.owner[bad]] = False
    return uncapped


def _capped(
    stack: SurfaceStack,
    part: Index,
    is_capped: Mask,
    tolerance: Array,
    side: Index,
    holes: OwnedLoops,
) -> StackCaps:
    """Add the caps of holes to their surfaces. part: (t,) components of triangles; side: (r,) sides
    of the holes.
    """
    count = len(stack)
    apexes, caps, kept = holes.cones()
    body = stack.point_owners[holes.start]
    cap_counts = np.bincount(body[kept], minlength=count)
    # Each surface's new points and triangles come after its own.
    point_order = np.concatenate([stack.point_owners, holes.owner]).argsort(kind="stable")
    triangle_bodies = np.repeat(np.arange(count), stack.triangle_counts)
    order = np.concatenate([triangle_bodies, body[kept]]).argsort(kind="stable")
    triangles = TriangleStack(
        np.concatenate([stack.points, apexes])[point_order],
        point_order.argsort()[np.concatenate([stack.triangles, caps])[order]],
        stack.point_counts + np.bincount(holes.owner, minlength=count),
        stack.triangle_counts + cap_counts,
    )
    ends = np.sort(np.stack([holes.start, holes.stop], axis=1), axis=1)
    edges = ends - stack.first_point[body][:, None]
    return StackCaps(
        is_capped,
        triangles,
        np.concatenate([part, part[side[kept] // 3]])[order],
        cap_counts,
        holes.count_caps(tolerance, is_capped),
        edges[np.lexsort((edges[:, 1], edges[:, 0], body))],
        np.bincount(body, minlength=count),
    )
