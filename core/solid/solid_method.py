# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The last stage of measuring a solid: its method, findings and health."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..inertia import are_physical
from ..mesh import Planarity, Surface, half_ulp, triangle_areas
from ..moments import Moments
from ..numerics import Array, ArrayLike, Index, Integers, Mask, unique_pairs
from ..polyhedron import polyhedron_moments
from ..verdict import (
    FLIPPED_FACES,
    NEGLIGIBLE,
    SELF_INTERSECTION,
    DefectiveElements,
    Finding,
    Intersection,
    MeshHealth,
    Procedure,
    finding,
)
from .closedness import CheckedSurface, GivenIntegrals
from .findings import (
    CAVITIES_BREAK_THROUGH,
    CAVITIES_SUBTRACTED,
    COMPONENTS_NESTED,
    COMPONENTS_OVERLAP,
    FLAT_COMPONENTS,
    FLAT_SURFACE,
    HOLES_CAPPED,
    INVERTED_COMPONENTS,
    NON_PLANAR_FACES,
    OVERLAP_OF_COMPONENTS,
    SELF_INTERSECTING,
    UNCHECKED,
    VERTICES_WELDED,
)
from .orientation import ClosedParts, ComponentComparison, OrientedSolid
from .repaired_mesh import NO_INDICES, RepairedMesh, copy_with
from .self_intersection import SelfIntersection

MIN_REPORTED_AMBIGUITY = 1e-6  # Share of the volume; smaller ambiguities are not reported.
# So many bent faces, or more, with a smaller spread stand for a curved surface. Both are chosen.
SMOOTH_FACES = 24
SMOOTH_SHARE = 0.03  # share of the volume


@dataclass(frozen=True, eq=False)
class SolidIntegrals:
    """The moments of the body that a surface bounds, and how they came about.

    A flat body's volume moments are zero; an open body's depend on the reference point. If vertices
    were welded across gaps, `input_error` includes the possible change.

    Attributes
    ----------
    volume : Moments
        To order 3, about the middle of the bounding box.
    area : Moments
        The area of the input's faces, without caps and copies left out, to order 0, or 3 for a
        shell.
    health : MeshHealth
        State of the input.
    method : Procedure
        EXACT, CAPPED, REORIENTED or OPEN.
    findings : tuple of Finding
        The decisions taken; findings about the whole surface have no elements.
    oriented : OrientedSolid
        The surface that was measured, and its components.
    given_surface : Surface
        The surface that was given, without the vertices that no face uses and the copies of faces
        that are left out.

    Examples
    --------
    >>> from body_moments.core import Surface, measure_solid
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2]])
    >>> body = measure_solid(surface)
    >>> str(body.method), [found.code for found in body.findings]
    ('capped', ['holes_capped'])
    >>> round(body.exact_third_order().total * 6, 9)
    1.0
    >>> round(body.moments(8, about=(0, 0, 0))[0][8, 0, 0] * 990, 9)
    1.0
    """

    volume: Moments
    area: Moments
    health: MeshHealth
    method: Procedure
    findings: tuple[Finding, ...]
    oriented: OrientedSolid
    given_surface: Surface

    @property
    def repaired_surface(self) -> Surface:
        """The repaired surface, whose signed sum is ``volume``."""
        return self.oriented.surface

    @property
    def face_count(self) -> int:
        """The number of triangles and quads of the repaired surface."""
        surface = self.repaired_surface
        return len(surface.triangles) + len(surface.quads)

    def moments(
        self,
        order: int,
        area_order: int | None = None,
        *,
        about: ArrayLike | None = None,
        threads: int = 1,
    ) -> tuple[Moments, Moments | None]:
        """Return the body's volume moments to an order; and area moments of the given faces, as in
        ``area``, or None.

        The moments are about the middle of the given points' bounding box, the point of ``volume``,
        unless `about` is given. The moments of open bodies depend on this point. MeasureError if a
        moment is beyond the range of numbers.
        """
        reference = self.volume.about
        volume, area = polyhedron_moments(
            self.repaired_surface,
            order,
            about=reference,
            exact=True,
            threads=threads,
            allow_open=True,
        )
        if not self.volume.raw.any():
            volume = _without_noise(volume)
        if area_order is not None:
            area = polyhedron_moments(
                self.given_surface,
                0,
                area_order=area_order,
                about=reference,
                threads=threads,
                allow_open=True,
            )[1]
        if about is None:
            return volume, area
        return volume.about_point(about), None if area is None else area.about_point(about)

    def parts(self) -> ClosedParts:
        """Return the triangles of the repaired surface by closed part."""
        return self.oriented.closed_parts()

    def exact_third_order(self, threads: int = 1) -> Moments:
        """Return `volume` with its third order exact to rounding, for decisions that its bounds
        leave open.
        """
        return polyhedron_moments(
            self.repaired_surface, exact=True, threads=threads, allow_open=True
        )[0]


def judge(
    checked: CheckedSurface,
    given: GivenIntegrals,
    oriented: OrientedSolid,
    intersection: SelfIntersection | None,
) -> SolidIntegrals:
    """Decide the method of a measured body, and report all decisions. intersection: None if not
    searched.
    """
    mesh, volume = oriented.mesh, oriented.volume
    has_open = bool(mesh.open.any())
    if not oriented.is_solid and not has_open:  # Rounding noise would pass for a tiny body.
        volume = _without_noise(volume)
    flipped_faces = NO_INDICES
    inverted = np.flatnonzero(oriented.turned)
    if mesh.flipped.any():
        flipped_faces, inverted = _flipped_faces(mesh, oriented.turned)
    is_impossible = False
    if oriented.is_solid and not has_open and volume.total > 0.0:
        low, high = checked.surface.box
        is_impossible = not are_physical(volume.at(None), low[None], high[None], checked.size)[0]
    caps = mesh.caps[oriented.solid].sum(axis=0)
    if has_open or not oriented.is_solid or is_impossible:
        procedure = Procedure.OPEN
    elif caps.any():
        procedure = Procedure.CAPPED
    elif len(flipped_faces) or len(inverted):
        procedure = Procedure.REORIENTED
    else:
        procedure = Procedure.EXACT
    cap_share = float(caps[2] / given.area.total) if given.area.total > 0.0 else 0.0
    findings = _repair_findings(checked, given, mesh, volume.total)
    if len(flipped_faces):
        rows = np.isin(mesh.face, flipped_faces)
        slight = _is_slight(mesh, rows, checked.size, volume.total)
        findings.append(
            finding(FLIPPED_FACES, flipped_faces, slight=slight, count=len(flipped_faces))
        )
    if len(inverted):
        findings.append(_inverted_finding(mesh, inverted, checked.size, volume.total))
    if caps[:2].any():
        edges = mesh.capped_edges[oriented.solid[mesh.capped_component]]
        edges = unique_pairs(edges if checked.vertices is None else checked.vertices[edges])
        findings.append(cap_finding(edges, caps, cap_share, checked.size, volume.total))
    if oriented.comparison is not None:
        findings += _component_findings(mesh, oriented.comparison, checked.size, volume.total)
    if is_impossible:
        findings.append(finding(SELF_INTERSECTING))
    elif intersection is not None and procedure is not Procedure.OPEN:
        findings += _intersection_findings(intersection, volume.total)
    planarity = given.planarity
    findings += (
        planarity_findings(planarity.non_planar_count, planarity.volume_spread, volume.total)
        if oriented.is_solid
        else [finding(FLAT_SURFACE)]
    )
    state = Intersection.NOT_CHECKED if intersection is None else intersection.state
    health = _health(checked, planarity, oriented, flipped_faces, len(inverted), cap_share, state)
    return SolidIntegrals(
        volume, given.area, health, procedure, tuple(findings), oriented, checked.surface
    )


def _without_noise(volume: Moments) -> Moments:
    """Return zero moments of a flat body, with its rounding noise as their error."""
    return replace(
        volume,
        raw=np.zeros_like(volume.raw),
        rounding_error=volume.rounding_error + np.abs(volume.raw),
    )


def _repair_findings(
    checked: CheckedSurface, given: GivenIntegrals, mesh: RepairedMesh, volume: float
) -> list[Finding]:
    """Return a finding about welding, if it moved vertices, and the findings of the repair's steps;
    edges are pairs of the input's vertices.
    """
    findings = []
    ulp = 2.0 * float(np.linalg.norm(half_ulp(np.abs(checked.surface.box).max(axis=0))))
    if mesh.max_displacement > ulp:  # float32 may write one place in two ways
        slight = mesh.max_displacement * given.area.total < NEGLIGIBLE * abs(volume)
        share = float(mesh.max_displacement / checked.size)
        findings.append(finding(VERTICES_WELDED, slight=slight, share=share))
    for item in mesh.findings:
        elements = np.asarray(item.elements)
        if elements.ndim == 2 and checked.vertices is not None:  # edges
            item = replace(item, elements=checked.vertices[elements])
        findings.append(item)
    return findings


def _flipped_faces(mesh: RepairedMesh, turned: Mask) -> tuple[Integers, Index]:
    """Return the mesh faces that were turned within their components, and the components turned as
    a whole.
    """
    of_mesh = mesh.face >= 0
    flipped = (mesh.flipped ^ turned[mesh.component])[of_mesh]
    component = mesh.component[of_mesh]
    whole = np.bincount(component, ~flipped) == 0
    return np.unique(mesh.face[of_mesh][flipped & ~whole[component]]), np.flatnonzero(whole)


def _health(
    checked: CheckedSurface,
    planarity: Planarity,
    oriented: OrientedSolid,
    flipped: Integers,
    inverted_count: int,
    cap_share: float,
    intersection: Intersection,
) -> MeshHealth:
    """Return the report of the repair, completed, with edges in the input's vertices."""
    report = oriented.mesh.report
    vertices = checked.vertices
    defects = report.defective_elements
    edges = defects.boundary_edges, defects.non_manifold_edges, defects.inconsistent_edges
    if vertices is not None:
        edges = tuple(vertices[pairs] for pairs in edges)
    if oriented.comparison is not None:
        report = oriented.comparison.add_to(report)
    return copy_with(
        report,
        inverted_components=inverted_count,
        degenerate_faces=len(planarity.degenerate_faces),
        non_planar_faces=planarity.non_planar_count,
        volume_spread=planarity.volume_spread,
        cap_area_share=cap_share,
        self_intersection=intersection,
        defective_elements=DefectiveElements(
            flipped,
            *edges,
            duplicate_faces=defects.duplicate_faces,
            degenerate_faces=planarity.degenerate_faces,
        ),
    )


def _is_slight(mesh: RepairedMesh, rows: Mask, size: float, volume: float) -> bool:
    """Return whether triangles are too small to matter, by their area times the body's size. rows:
    (t,).
    """
    return bool(
        triangle_areas(mesh.points, mesh.triangles[rows]).sum() * size < NEGLIGIBLE * volume
    )


def _inverted_finding(mesh: RepairedMesh, inverted: Index, size: float, volume: float) -> Finding:
    """Return a finding about components, by their numbers, that are inside out."""
    is_inverted = np.zeros(mesh.number, bool)
    is_inverted[inverted] = True
    is_whole = bool(is_inverted.all())
    return finding(
        INVERTED_COMPONENTS,
        () if is_whole else mesh.faces_of(is_inverted),
        slight=not is_whole and _is_slight(mesh, is_inverted[mesh.component], size, volume),
        count=len(inverted),
        total=int(mesh.number),
    )


def cap_finding(edges: Index, caps: Array, share: float, size: float, volume: float) -> Finding:
    """Return a finding about capped holes. caps: (3,) flat ones, curved ones, their area; share: of
    the surface's.
    """
    flat, curved = map(int, caps[:2])
    slight = caps[2] * size < NEGLIGIBLE * volume  # all their moments together
    return finding(
        HOLES_CAPPED,
        edges,
        slight=slight,
        count=flat + curved,
        flat=flat,
        curved=curved,
        share=share,
    )


def _component_findings(
    mesh: RepairedMesh, comparison: ComponentComparison, size: float, volume: float
) -> list[Finding]:
    """Return findings about components that are in others, go through others, or have no volume."""
    solid = comparison.solid
    flat = ~solid & ~mesh.open if solid.any() else np.zeros(mesh.number, bool)
    findings = []
    for code, which, values in (
        (CAVITIES_SUBTRACTED, comparison.cavities & ~comparison.breaking, {}),
        (
            CAVITIES_BREAK_THROUGH,
            comparison.breaking,
            {"share": float(comparison.breakthrough / size)},
        ),
        (COMPONENTS_NESTED, comparison.nested, {}),
        (COMPONENTS_OVERLAP, comparison.intersecting, {}),
        (FLAT_COMPONENTS, flat, {"total": int(mesh.number)}),
    ):
        if which.any():
            in_question = _all_but_largest(mesh, which) if code == COMPONENTS_OVERLAP else which
            slight = code != CAVITIES_SUBTRACTED and _is_slight(
                mesh, in_question[mesh.component], size, volume
            )
            findings.append(
                finding(code, mesh.faces_of(which), slight=slight, count=int(which.sum()), **values)
            )
    if comparison.undecided_pairs:
        findings.append(
            finding(UNCHECKED, subject=OVERLAP_OF_COMPONENTS, count=int(comparison.undecided_pairs))
        )
    return findings


def _all_but_largest(mesh: RepairedMesh, which: Mask) -> Mask:
    """Return a (c,) mask without its component of the largest area: the rest contains the shared
    volume.
    """
    is_included = which[mesh.component]
    areas = np.bincount(
        mesh.component[is_included], triangle_areas(mesh.points, mesh.triangles[is_included])
    )
    rest = which.copy()
    rest[np.argmax(areas)] = False
    return rest


def _intersection_findings(intersection: SelfIntersection, volume: float) -> list[Finding]:
    """Return findings about a component that goes through itself, or that was not tested."""
    if intersection.state is Intersection.FOUND:
        slight = intersection.effect < NEGLIGIBLE
        return [finding(SELF_INTERSECTION, slight=slight, share=intersection.volume / volume)]
    return (
        [finding(UNCHECKED, slight=True, subject="self-intersection of the surface")]
        if intersection.state is Intersection.NOT_CHECKED
        else []
    )


def planarity_findings(count: int, spread: float, volume: float) -> list[Finding]:
    """Return findings about faces with diagonals that make a difference.

    count: number of these faces. spread: difference that they make to the volume.
    """
    if not spread > MIN_REPORTED_AMBIGUITY * volume > 0.0:
        return []
    share = float(spread / volume)
    is_smooth = count >= SMOOTH_FACES and share < SMOOTH_SHARE
    return [finding(NON_PLANAR_FACES, slight=is_smooth or share < NEGLIGIBLE, share=share)]
