# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Many small solids measured at once: those that are closed as they are, and outward, in one piece or in several that
stand apart.

What is exact here is what `measure_solid` would call exact, with the same numbers. Everything else is for
`measure_solid`, one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh.planarity import Planarity, StackPlanarity, stack_planarity
from ..mesh.scan_lines import LineGrids, find_crossings, line_counts
from ..mesh.surface import Surface
from ..mesh.surface_stack import SurfaceStack
from ..moments.moments import SECOND_MOMENT_INDEX, Moments, U, stack_moments
from ..polyhedron.any_order_small import extend_small_moments
from ..polyhedron.third_order import MAX_SMALL_TRIANGLES, MAX_UNSCALED_REACH
from ..polyhedron.third_order_small import NEXT_AXIS, PREVIOUS_AXIS, small_moments
from ..verdict.finding import Finding
from ..verdict.health import NO_FACES, Intersection, MeshReport
from ..verdict.tolerances import CLOSED_SHEET_VOLUME_RTOL, MAX_COORDINATE, MIN_SIZE, WELDING_RTOL
from .self_intersection import MAX_UNSURE_LINES, measure_excess
from .solid_verdict import SolidIntegrals, shape_findings
from .triage import SUM_ROUNDING

MAX_COMPONENTS = 16  # of one body: each is compared with each
CLEAR_VOLUME = 4.0  # times what counts as none: a component of less is looked at by itself


@dataclass(frozen=True, eq=False)
class SolidStack:
    """The moments of the bodies that n surfaces bound.

    Attributes
    ----------
    is_exact : (n,) bool
        Which of them are closed as they are; the others have to be measured one by one.
    volume, area : Moments
        Of each, to order 3 and 0, about a point of its own; only those that are exact mean anything.
    planarity : StackPlanarity
    intersection : (n,) array of Intersection
    component_counts : (n,) int
    surfaces : SurfaceStack
    """

    is_exact: NDArray[np.bool_]
    volume: Moments
    area: Moments
    planarity: StackPlanarity
    intersection: NDArray[np.object_]
    component_counts: NDArray[np.intp]
    surfaces: SurfaceStack

    def health(self, i: int) -> MeshReport:
        """What the surface of an exact one is like."""
        flat = self.planarity
        return MeshReport(
            closed=True,
            components=int(self.component_counts[i]),
            non_planar_faces=int(flat.non_planar_counts[i]),
            volume_spread=float(flat.volume_ambiguity[i]),
            self_intersection=self.intersection[i],
        )

    def findings(self, i: int) -> tuple[Finding, ...]:
        """What is to be reported of an exact one."""
        flat = self.planarity
        if not flat.volume_ambiguity[i]:
            return ()
        planarity = Planarity(int(flat.non_planar_counts[i]), float(flat.volume_ambiguity[i]), NO_FACES)
        return tuple(shape_findings(True, planarity, self.volume.at(i)))

    def to_order(self, rows: NDArray[np.intp], order: int) -> Moments:
        """The volumes of some, in ascending order, to a higher order than third."""
        stack, volume = self.surfaces.some(rows), self.volume.at(rows)
        low, high = stack.box
        reach = np.maximum(high - volume.about, volume.about - low) * (1.0 + 4.0 * U) + stack.coordinate_error
        return extend_small_moments(volume, order, stack.points, stack.triangles, stack.triangle_counts, reach)


def small_moments_to_order(solids: Sequence[SolidIntegrals], order: int) -> Moments:
    """Return the volumes of solids that were measured by themselves, each of at most MAX_SMALL_TRIANGLES triangles, to
    a higher order than third."""
    surfaces = [solid.repaired_surface for solid in solids]
    triangles = [surface.all_triangles()[0] for surface in surfaces]
    first = np.cumsum([0, *(len(surface.points) for surface in surfaces)])
    volume = stack_moments([solid.volume for solid in solids])
    boxes = np.array([surface.box for surface in surfaces])
    reach = np.maximum(boxes[:, 1] - volume.about, volume.about - boxes[:, 0]) * (1.0 + 4.0 * U)
    reach += [surface.coordinate_error for surface in surfaces]
    return extend_small_moments(
        volume,
        order,
        np.concatenate([surface.points.astype(np.float64) for surface in surfaces]),
        np.concatenate([rows + start for rows, start in zip(triangles, first.tolist())]),
        np.array([len(rows) for rows in triangles]),
        reach,
    )


def is_small(surface: Surface) -> bool:
    """Whether a surface has so few triangles that it is taken together with others."""
    return len(surface.triangles) + 2 * len(surface.quads) <= MAX_SMALL_TRIANGLES


def can_be_stacked(surface: Surface) -> bool:
    """Whether a surface may be one of those that `measure_stack` measures."""
    return is_small(surface) and SurfaceStack.takes(surface)


def measure_stack(surfaces: Sequence[Surface]) -> SolidStack:
    """Measure the bodies that many small surfaces bound, as far as they are closed as they are.

    Parameters
    ----------
    surfaces : sequence of Surface
        At least one; all of them as `can_be_stacked` asks, with finite coordinates.

    Returns
    -------
    SolidStack
    """
    stack = SurfaceStack.of(surfaces)
    starts = stack.first_triangle
    low, high = stack.box
    center = (low / 2.0 + high / 2.0).astype(np.float32).astype(np.float64)
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)
    volume, area, _ = small_moments(
        stack.points,
        stack.triangles,
        stack.triangle_counts,
        center,
        reach,
        stack.coordinate_error,
        area=True,
        shell=False,
    )
    planarity = stack_planarity(stack)
    size, farthest = np.sqrt(np.add.reduce((high - low) ** 2, axis=1)), reach.max(axis=1)
    component_counts, component = stack.closed_components()
    is_exact = (
        (component_counts > 0)
        & (component_counts <= MAX_COMPONENTS)
        & ~planarity.has_degenerate
        & stack.uses_all_points()
    )
    is_exact &= (farthest > 1.0 / MAX_UNSCALED_REACH) & (farthest < MAX_UNSCALED_REACH) & (size >= MIN_SIZE)
    is_exact &= np.maximum(size, np.maximum(np.abs(low), np.abs(high)).max(axis=1)) < MAX_COORDINATE
    none = np.maximum(CLOSED_SHEET_VOLUME_RTOL * size * area.raw[:, 0], volume.rounding_error[:, 0])
    is_exact &= volume.raw[:, 0] > none
    rows = np.flatnonzero(is_exact)
    is_exact[rows] = _are_physical(volume.at(rows), low[rows], high[rows], size[rows])
    tolerance = np.maximum(WELDING_RTOL * size, 4.0 * np.sqrt(np.add.reduce(stack.coordinate_error**2, axis=1)))
    part = component[stack.triangle_faces]
    several = np.flatnonzero(is_exact & (component_counts > 1))
    if len(several):
        is_exact[several] = _stand_apart(stack, part, several, center, component_counts[several], tolerance[several])
    intersection = np.full(len(starts), Intersection.NOT_CHECKED, object)
    intersection[is_exact] = Intersection.EXCLUDED
    centers = volume.about + volume.raw[:, 1:4] / np.where(is_exact, volume.raw[:, 0], 1.0)[:, None]
    is_star = _are_stars(stack, starts, centers)
    if not is_star[is_exact].all():
        is_star |= _are_stars(stack, starts, volume.about)
    rows = np.flatnonzero(is_exact & ~(is_star & (component_counts == 1)))
    if len(rows):
        chosen = _of_bodies(stack, rows)
        intersection[rows] = _looked_for(stack.some(rows), tolerance[rows], _renumbered(part[chosen]))
        is_exact[rows] = intersection[rows] == Intersection.NOT_FOUND
    return SolidStack(is_exact, volume, area, planarity, intersection, component_counts, stack)


def _of_bodies(stack: SurfaceStack, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
    """(t,) the triangles of some of the surfaces."""
    chosen = np.zeros(len(stack), bool)
    chosen[rows] = True
    return np.repeat(chosen, stack.triangle_counts)


def _renumbered(labels: NDArray[np.intp]) -> NDArray[np.intp]:
    """Labels from 0 on, without gaps, in the same order."""
    return np.unique(labels, return_inverse=True)[1].ravel()


def _stand_apart(
    stack: SurfaceStack,
    part: NDArray[np.intp],
    rows: NDArray[np.intp],
    center: NDArray,
    counts: NDArray[np.intp],
    tolerance: NDArray,
) -> NDArray[np.bool_]:
    """(k,) whether the components of some of the bodies, the `part` of each triangle of all, face outward, each with a
    volume that is certain, and have boxes that do not touch."""
    chosen = _of_bodies(stack, rows)
    part = _renumbered(part[chosen])
    body = np.repeat(np.arange(len(rows)), counts)  # of each part: they are numbered one body after the other
    corners = stack.points[stack.triangles[chosen]].astype(np.float64) - center[rows][body[part], None]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    volume = np.bincount(part, np.add.reduce(corners[:, 0] * normals, axis=1)) / 6.0
    area = np.bincount(part, np.sqrt(np.add.reduce(normals * normals, axis=1))) / 2.0
    order = part.argsort(kind="stable")
    starts = np.searchsorted(part[order], np.arange(len(body)))
    low = np.minimum.reduceat(corners.min(axis=1)[order], starts)
    high = np.maximum.reduceat(corners.max(axis=1)[order], starts)
    is_bad = (
        volume <= CLEAR_VOLUME * CLOSED_SHEET_VOLUME_RTOL * np.sqrt(np.add.reduce((high - low) ** 2, axis=1)) * area
    )
    apart = 2.0 * tolerance[body]
    for step in range(1, int(counts.max())):
        gap = np.maximum(low[step:] - high[:-step], low[:-step] - high[step:]).max(axis=1)
        is_bad[:-step] |= (body[step:] == body[:-step]) & ~(gap > apart[:-step])
    return np.bincount(body, is_bad) == 0


def _are_stars(stack: SurfaceStack, starts: NDArray[np.intp], points: NDArray) -> NDArray[np.bool_]:
    """(n,) whether the cones over all faces of a surface, from its point, (n, 3), agree and surround it once: by their
    solid angles (van Oosterom and Strackee 1983)."""
    places = points.take(np.repeat(np.arange(len(starts)), stack.triangle_counts), 0).T[:, None]
    corners = stack.points.T.take(stack.triangles.T, 1) - places
    after, before = corners.take(NEXT_AXIS, 0), corners.take(PREVIOUS_AXIS, 0)
    cones = np.add.reduce(corners[:, 0] * (after[:, 1] * before[:, 2] - before[:, 1] * after[:, 2]))
    la, lb, lc = np.sqrt(np.add.reduce(corners * corners))
    ab, bc, ca = np.add.reduce(corners * corners.take(NEXT_AXIS, 1))
    halves = np.arctan2(cones, la * lb * lc + ab * lc + bc * la + ca * lb)
    total, signed, angle = np.add.reduceat(np.stack([np.abs(cones), cones, halves]), starts, axis=1)
    return (total - signed <= SUM_ROUNDING * total) & (np.rint(angle / (2.0 * np.pi)) == 1.0)


def _looked_for(stack: SurfaceStack, tolerance: NDArray, part: NDArray[np.intp]) -> NDArray[np.object_]:
    """(k,) whether surfaces go through themselves, as `find_self_intersection` finds by lines. part: (t,) the component
    of each triangle."""
    low, high = stack.box
    body = np.repeat(np.arange(len(tolerance)), stack.point_counts)
    grids = LineGrids.over_boxes(low, high, line_counts(stack.triangle_counts))
    crossings = find_crossings(Surface(stack.points, stack.triangles), grids, body)
    excess = measure_excess(crossings, grids, tolerance, part)
    state = np.where(excess.volume > 0.0, Intersection.FOUND, Intersection.NOT_FOUND).astype(object)
    state[excess.unsure > MAX_UNSURE_LINES] = Intersection.NOT_CHECKED
    return state


def _are_physical(volume: Moments, low: NDArray, high: NDArray, size: NDArray) -> NDArray[np.bool_]:
    """(n,) whether bodies within these boxes can have these moments, as `solid_verdict` asks of one."""
    total = volume.raw[:, 0]
    mean = volume.raw[:, 1:4] / total[:, None]
    second = volume.raw[:, SECOND_MOMENT_INDEX] / total[:, None, None] - mean[:, :, None] * mean[:, None, :]
    most = np.abs(second).max(axis=(1, 2))
    rounding = 8.0 * (volume.rounding_error[:, 4:10].max(axis=1) / total + np.finfo(float).eps * most)
    tolerance = (1e-6 * size + volume.rounding_error[:, 1:4].max(axis=1) / total)[:, None]
    center = volume.about + mean
    inside = ((low - tolerance <= center) & (center <= high + tolerance)).all(axis=1)
    return inside & (np.linalg.eigvalsh(second)[:, 0] >= -rounding)
