# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of a surface's body: its kind, the repairs that it needed, and its moments.

A mesh whose own edges prove it closed is measured as it stands. Any other is repaired on a copy,
one decision after the other, and each decision is reported: patches that lie on a closed part are
welded onto it; in open parts equal positions are welded, then, along open edges only, positions
that differ by rounding; copies of faces that keep edges from closing are left out; faces that run
against the rest of their part are turned; gaps without area (T-junctions) close; other boundary
loops are capped. Then the components are compared: one that is inside out and in no other's
material is turned. A surface still not closed is measured as a signed sum about the reference
point, and called open.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np

from ..mesh import Surface, SurfaceStack
from ..moments import KNOWN_ORDER, Moments, stack_moments
from ..numerics import check_type
from ..polyhedron import MAX_SMALL_TRIANGLES, nothing
from ..verdict import Finding, MeasureError, Procedure
from .closedness import CheckedSurface, GivenIntegrals, check_surface, integrate_and_prove
from .hole_caps import (
    cap_holes,
    close_gaps,
    find_t_junctions,
    find_unclosable_components,
    orient_faces,
    report_closedness,
    turn_faces,
)
from .orientation import orient_components
from .repaired_mesh import UNKNOWN, RepairedMesh, copy_with
from .self_intersection import find_self_intersection
from .solid_method import SolidIntegrals, judge
from .solid_stack import SmallSolid, measure_small
from .weld_open_parts import (
    copied_faces,
    drop_collapsed_triangles,
    drop_duplicate_faces,
    split_into_triangles,
    weld_equal_positions,
    weld_near_positions,
    weld_patches,
    without_faces,
)

MAX_KEPT_TRIANGLES = 100_000  # surfaces whose measurement is kept
MAX_STACKED_TRIANGLES = 100_000  # surfaces measured together, each of a few hundred bytes
MAX_WELDED_SHARE = (
    0.1  # Share of the volume: a weld that may change more closes no gap left by rounding.
)
STEPS: tuple[Callable[[RepairedMesh], RepairedMesh], ...] = (
    weld_patches,
    weld_equal_positions,  # in parts with odd edges: one face, or three
    weld_near_positions,  # along the edges that are then still odd
    drop_collapsed_triangles,
    drop_duplicate_faces,
    find_t_junctions,
    orient_faces,
    find_unclosable_components,
    close_gaps,
    cap_holes,
    turn_faces,
    report_closedness,
)


def measure_solid(surface: Surface, *, shell: bool = False, threads: int = 1) -> SolidIntegrals:
    """Measure the body that a surface bounds, and report how its moments came about.

    Vertices along open edges that differ by rounding are welded, unless the body is so thin that it
    would collapse.

    Parameters
    ----------
    surface : Surface
        Any polygons; closed or not.
    shell : bool
        True if the surface has the mass: the area's moments are found to order 3 instead of 0, and
        self-intersection, which only spoils a volume, is not looked for.
    threads : int
        For the sums over faces, and for the proof of closedness.

    Returns
    -------
    SolidIntegrals
        In the surface's own coordinates and unit.

    Raises
    ------
    MeasureError
        If there are no faces, a face names no vertex, or positions are not finite, too large or too
        small.

    Examples
    --------
    >>> from body_moments.core import Surface, measure_solid
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> body = measure_solid(surface)
    >>> flipped = body.health.defective_elements.flipped_faces
    >>> str(body.method), round(body.volume.total * 6, 9), flipped.tolist()
    ('reoriented', 1.0, [3])
    """
    return measure_stack([surface], shell=shell, threads=threads)[0]


def measure_stack(
    surfaces: Sequence[Surface], *, shell: bool = False, threads: int = 1
) -> SolidStack:
    """Measure the bodies that surfaces bound, at least one, as `measure_solid` does: small ones
    together if they need no repair but caps, others one by one.
    """
    for surface in surfaces:
        check_type("surface", surface, Surface)
    fits = SurfaceStack.takes(surfaces, 0 if shell else MAX_SMALL_TRIANGLES)
    counts = np.array([surface.triangle_count for surface in surfaces]) * fits
    stacked = np.flatnonzero(fits & (np.cumsum(counts) <= MAX_STACKED_TRIANGLES)).tolist()
    solids: dict[int, SolidIntegrals | Finding] = {}
    if stacked:
        small = measure_small([surfaces[i] for i in stacked])
        for row in np.flatnonzero(small.is_measured).tolist():
            i = stacked[row]
            solids[i] = SmallSolid(small, row, surfaces[i])
    for i in set(range(len(surfaces))).difference(solids):
        try:
            solids[i] = measure_alone(surfaces[i], shell, threads)
        except MeasureError as refusal:
            solids[i] = refusal.finding
    return SolidStack(surfaces, [solids[i] for i in range(len(surfaces))])


@dataclass(frozen=True, eq=False)
class SolidStack:
    """The bodies of n surfaces, `stack[i]` each, or why they are refused.

    `volume`, `area`: stacks of their moments; zero for refused surfaces.
    """

    surfaces: Sequence[Surface]
    solids: Sequence[SolidIntegrals | Finding]

    def __getitem__(self, i: int) -> SolidIntegrals:
        solid = self.solids[i]
        if isinstance(solid, Finding):
            raise MeasureError(solid)
        return solid

    @cached_property
    def volume(self) -> Moments:
        return self._moments(0)

    @cached_property
    def area(self) -> Moments:
        return self._moments(1)

    def _moments(self, which: int) -> Moments:
        """Return the stacked moments of the volumes, `which` 0, or of the areas, 1."""
        none = nothing(KNOWN_ORDER, None)[which]
        return stack_moments(
            [
                none if isinstance(solid, Finding) else (solid.volume, solid.area)[which]
                for solid in self.solids
            ]
        )


def measure_alone(surface: Surface, shell: bool = False, threads: int = 1) -> SolidIntegrals:
    """Measure a surface by itself."""
    checked = check_surface(surface)
    given = integrate_and_prove(checked, shell, threads)
    mesh = given.proven or repair_surface(checked.surface, checked.tolerance)
    solid = _measure_repaired(checked, given, mesh, shell, threads)
    # The weld changes the volume by less than this.
    swept_volume = mesh.max_displacement * solid.area.total
    if swept_volume and swept_volume > MAX_WELDED_SHARE * abs(solid.oriented.volume.total):
        mesh = repair_surface(checked.surface, checked.tolerance, weld_near=False)
        unwelded = _measure_repaired(checked, given, mesh, shell, threads)
        return solid if unwelded.method is Procedure.OPEN else unwelded  # the weld closed it
    return solid


@dataclass(frozen=True)
class _Known:
    """A key of the cache: surfaces, equal to others with the same content."""

    content: tuple
    surfaces: Sequence[Surface] = field(compare=False)
    threads: int = field(compare=False)


@lru_cache(maxsize=4)  # Objects are often measured again with the same surfaces.
def _measure_known(known: _Known) -> SolidStack:
    return measure_stack(known.surfaces, threads=known.threads)


def measure_again(surfaces: Sequence[Surface], threads: int = 1) -> SolidStack:
    """Return the `measure_stack` of surfaces, remembered unless they are large."""
    if sum([surface.triangle_count for surface in surfaces]) > MAX_KEPT_TRIANGLES:
        return measure_stack(surfaces, threads=threads)
    content = tuple([surface.content for surface in surfaces])
    return _measure_known(_Known(content, surfaces, threads))


def _measure_repaired(
    checked: CheckedSurface, given: GivenIntegrals, mesh: RepairedMesh, shell: bool, threads: int
) -> SolidIntegrals:
    """Measure the body of a repaired mesh.

    Faces that are left out of a solid count in none of its numbers. A shell is not searched for
    self-intersections; its copies of faces are reported.
    """
    if len(mesh.left_out) and not shell:
        checked = replace(checked, surface=without_faces(checked.surface, mesh.left_out))
        given = integrate_and_prove(checked, shell, threads)
    oriented = orient_components(checked, given, mesh, threads)
    if not shell:
        return judge(checked, given, oriented, find_self_intersection(checked, oriented))
    solid = judge(checked, given, oriented, None)
    defects = solid.health.defective_elements
    copies = np.union1d(defects.duplicate_faces, copied_faces(checked.surface))
    health = replace(
        solid.health,
        duplicate_faces=len(copies),
        defective_elements=replace(defects, duplicate_faces=copies),
    )
    return replace(solid, health=health)


def repair_surface(surface: Surface, tolerance: float, weld_near: bool = True) -> RepairedMesh:
    """Repair a surface, whose vertices all belong to faces, on a copy.

    The steps end if no triangle is left.

    tolerance: positions nearer than this (unit) count as equal at open edges, and loops narrower
    than this have no area.
    """
    mesh = split_into_triangles(surface, tolerance)
    for step in STEPS:
        if len(mesh.triangles) and (weld_near or step is not weld_near_positions):
            mesh = step(mesh)
    return copy_with(mesh, state=UNKNOWN)
