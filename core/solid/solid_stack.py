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
from typing import Any

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
# times the volume that counts as none: bodies with smaller components are measured one by one
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


COMPUTED = "method", "health", "findings", "oriented"


class SmallSolid(SolidIntegrals):
    """Body `i` of a stack, with results that are computed when they are asked for."""

    stack: SmallSolids
    i: int

    def __init__(self, stack: SmallSolids, i: int, surface: Surface):
        volume = stack.volume.at(i)
        area = stack.area.at(i)
        self.__dict__.update(stack=stack, i=i, given_surface=surface, volume=volume, area=area)

    def __getattr__(self, name: str) -> Any:
        if name not in COMPUTED:
            raise AttributeError(name)
        value = self.__dict__[name] = getattr(self, "_" + name)()
        return value

    def _method(self) -> Procedure:
        return Procedure.CAPPED if self.stack.caps.is_capped[self.i] else Procedure.EXACT

    def _health(self) -> MeshHealth:
        flat = self.stack.planarity
        edges = self.stack.caps.edges_of(self.i)
        return MeshHealth(
            closed=not len(edges),
            boundary_edges=len(edges),
            components=int(self.stack.component_counts[self.i]),
            non_planar_faces=int(flat.non_planar_counts[self.i]),
            volume_spread=float(flat.volume_spread[self.i]),
            cap_area_share=self._cap_share,
            self_intersection=Intersection(self.stack.intersection[self.i]),
            defective_elements=DefectiveElements(boundary_edges=edges),
        )

    def _findings(self) -> tuple[Finding, ...]:
        flat = self.stack.planarity
        caps = self.stack.caps
        found = []
        if caps.is_capped[self.i]:
            size = float(self.stack.size[self.i])
            edges = caps.edges_of(self.i)
            found.append(
                cap_finding(edges, caps.counts[self.i], self._cap_share, size, self.volume.total)
            )
        count, spread = flat.non_planar_counts[self.i], flat.volume_spread[self.i]
        return *found, *planarity_findings(int(count), float(spread), self.volume.total)

    def _oriented(self) -> OrientedSolid:
        mesh = self.stack.caps.mesh(self.i, self.given_surface, self.health)
        is_closed = self.health.closed
        yes = np.ones(mesh.number, bool)
        surface = self.given_surface if is_closed else Surface(mesh.points, mesh.triangles)
        return OrientedSolid(mesh, is_closed, surface, self.volume, True, yes, ~yes, ~yes, None)

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
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)
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
    # float32: none too large
    usable &= (farthest > 1.0 / MAX_UNSCALED_REACH) & (farthest < MAX_UNSCALED_REACH)
    usable &= links.component_counts <= MAX_COMPONENTS
    error = np.sqrt(np.add.reduce(stack.coordinate_error**2, axis=1))
    tolerance = np.maximum(WELDING_RTOL * size, 4.0 * error)
    none = np.zeros(len(stack), np.intp)
    part = links.component[stack.triangle_faces]
    caps = StackCaps(
        none > 0, stack, part, none, np.zeros((len(none), 3)), np.empty((0, 2), np.intp), none
    )
    if links.is_open.any() and (made := cap_stack(stack, links, usable, tolerance)) is not None:
        caps = made
        volume = made.add_to(volume)
    capped = caps.is_capped
    triangles = caps.triangles
    part = caps.part
    is_measured = usable & (links.is_closed | capped)
    least = np.maximum(
        zero_volume(size, area.raw[:, 0], capped, error), volume.rounding_error[:, 0]
    )
    is_measured &= volume.raw[:, 0] > least
    is_star = links.component_counts == 1
    if (is_measured & is_star).any():
        centers = (
            volume.about
            + volume.raw[:, 1:4] / np.where(is_measured, volume.raw[:, 0], 1.0)[:, None]
        )
        is_proven = _are_stars(triangles, centers)
        if not is_proven[is_measured & ~capped].all():
            is_proven |= ~capped & _are_stars(triangles, volume.about)
        is_star &= is_proven
    # A star is a body, and does not go through itself.
    rows = np.flatnonzero(is_measured & ~is_star)
    if len(rows):
        is_measured[rows] = are_physical(volume.at(rows), low[rows], high[rows], size[rows])
    several = np.flatnonzero(is_measured & (links.component_counts > 1))
    if len(several):
        is_measured[several] = _stand_apart(
            triangles, part, several, links.component_counts, tolerance, capped, error
        )
    intersection = np.full(len(stack), Intersection.NOT_CHECKED, object)
    intersection[is_measured] = Intersection.EXCLUDED
    rows = np.flatnonzero(is_measured & ~is_star)
    if len(rows):
        chosen = triangles.owned(rows)[1]
        intersection[rows] = _search_self_intersections(
            triangles.some(rows), tolerance[rows], _renumbered(part[chosen])
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


def _renumbered(labels: Index) -> Index:
    """Return labels from 0 on, without gaps, in the same order."""
    return np.unique(labels, return_inverse=True)[1].ravel()


def _stand_apart(
    stack: TriangleStack,
    part: Index,
    rows: Index,
    counts: Index,
    tolerance: Array,
    capped: Mask,
    error: Array,
) -> Mask:
    """Return a (k,) mask of the bodies `rows` whose parts face outward, surely have a volume, and
    stand apart.
    """
    chosen = stack.owned(rows)[1]
    part = _renumbered(part[chosen])
    # The body of each part; parts are numbered body by body.
    body = np.repeat(np.arange(len(rows)), counts[rows])
    parts = sort_components(stack.points, stack.triangles[chosen], part, len(body))
    of_all = rows[body]
    low = parts.low
    high = parts.high
    size = np.sqrt(np.add.reduce((parts.high - parts.low) ** 2, axis=1))
    is_bad = parts.volume <= CLEAR_VOLUME * zero_volume(
        size, parts.area, capped[of_all], error[of_all]
    )
    apart = 2.0 * tolerance[of_all]
    for step in range(1, int(counts[rows].max())):
        gap = np.maximum(low[step:] - high[:-step], low[:-step] - high[step:]).max(axis=1)
        is_bad[:-step] |= (body[step:] == body[:-step]) & ~(gap > apart[:-step])
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
) -> StackCaps | None:
    """Cap `usable` surfaces that need nothing but caps; None if there are none. tolerance: (n,)
    distances of touch.
    """
    can = usable & links.is_open
    start, stop = links.open_sides
    owner = stack.point_owners
    total = len(stack.points)
    leaving = np.bincount(start, minlength=total)
    arriving = np.bincount(stop, minlength=total)
    can &= np.logical_and.reduceat((leaving <= 1) & (leaving == arriving), stack.first_point)
    for chosen, reach in ((start, tolerance), (np.flatnonzero(can[owner]), np.zeros(len(can)))):
        of = owner[chosen]
        can[of[may_have_neighbor(stack.points[chosen], reach[of], of)]] = False
    if not can.any():
        return None
    onto = np.full(total, -1)
    onto[start] = stop
    begins, ends = side_ends(stack.triangles, np.arange(stack.triangles.size))
    is_side = onto[begins] == ends
    side_counts = np.add.reduceat(is_side, 3 * stack.first_triangle, dtype=np.intp)
    sides = np.repeat(can, 3 * stack.triangle_counts)
    key = np.sort(begins[sides] * total + ends[sides])
    can[owner[key[1:][key[1:] == key[:-1]] // total]] = False  # diagonals may run along edges
    can &= side_counts + stack.triangle_counts <= MAX_SMALL_TRIANGLES
    can &= np.logical_and.reduceat(has_distinct_vertices(stack.triangles), stack.first_triangle)
    side = np.flatnonzero(is_side)
    while can.any():
        side = side[can[owner[begins[side]]]]
        start, stop = begins[side], ends[side]
        found = OwnedLoops.of_sides(stack.points, start, stop, owner[start])
        bad = ~found.loops.complete | ~found.loops.has_area(tolerance[found.owner])
        if not bad.any():
            return _capped(
                stack, links.component[stack.triangle_faces], can, tolerance, side, found
            )
        can[found.owner[bad]] = False
    return None


def _capped(
    stack: SurfaceStack,
    part: Index,
    is_capped: Mask,
    tolerance: Array,
    side: Index,
    found: OwnedLoops,
) -> StackCaps:
    """Add the caps of loops to their surfaces. part: (t,) components of triangles; side: (r,) sides
    of the loops.
    """
    count = len(stack)
    owner = stack.point_owners
    (apexes, caps, kept) = found.cones()
    body = owner[found.start]
    cap_counts = np.bincount(body[kept], minlength=count)
    point_order = np.concatenate([owner, found.owner]).argsort(kind="stable")
    bodies = np.concatenate([np.repeat(np.arange(count), stack.triangle_counts), body[kept]])
    order = bodies.argsort(kind="stable")
    triangles = TriangleStack(
        np.concatenate([stack.points, apexes])[point_order],
        point_order.argsort()[np.concatenate([stack.triangles, caps])[order]],
        stack.point_counts + np.bincount(found.owner, minlength=count),
        stack.triangle_counts + cap_counts,
    )
    edges = (
        np.sort(np.stack([found.start, found.stop], axis=1), axis=1)
        - stack.first_point[body][:, None]
    )
    return StackCaps(
        is_capped,
        triangles,
        np.concatenate([part, part[side[kept] // 3]])[order],
        cap_counts,
        found.count_caps(tolerance, is_capped),
        edges[np.lexsort((edges[:, 1], edges[:, 0], body))],
        np.bincount(body, minlength=count),
    )
