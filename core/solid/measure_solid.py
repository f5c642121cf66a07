# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What kind of body a surface is, what had to be repaired to measure it, and its moments.

A mesh whose own edges prove it closed is measured as it stands. Any other is repaired on a copy, one decision after the
other, and each decision is reported: equal positions are welded, then, along open edges only, positions that differ by
rounding; copies of faces that keep edges from closing are left out; faces that run against the rest of their part are
turned; gaps without area (T-junctions) close; other rims are capped. Then the shells are compared: a shell that is
inside out and in no other's material is turned. What is still not closed is measured as a signed sum about the
reference point, and called open.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..mesh.bvh import sort_components
from ..mesh.edges import closed_side_faces, face_of_each
from ..mesh.planarity import Planarity, PlanarityAccumulator
from ..mesh.surface import Surface, indices_in_range
from ..moments.moments import SECOND_MOMENT_INDEX, Moments, sum_moments
from ..numerics.arrays import unique_pairs
from ..numerics.graph import connected_components
from ..polyhedron import polyhedron_moments, third_order
from ..verdict.finding import Finding, MeasureError, finding
from ..verdict.health import NO_FACES, DefectiveElements, MeshReport
from ..verdict.tolerances import (
    CLOSED_SHEET_VOLUME_RTOL,
    FLAT_CAP_VOLUME_RTOL,
    MAX_COORDINATE,
    MIN_SIZE,
    NEGLIGIBLE,
    WELDING_RTOL,
)
from .nesting import cavity_host, classify_pairs, orient_nested_shells
from .parts import ClosedParts
from .repair import RepairedMesh, repair_surface

MAX_WELDED_SHARE = 0.1  # of the volume: where welding may change that much, what it closes is no gap left by rounding
MIN_REPORTED_AMBIGUITY = 1e-6  # of the volume: below, nobody needs to know


@dataclass(frozen=True, eq=False)
class SolidIntegrals:
    """What measuring the body that a surface bounds came to.

    Of a body that is flat the volume's moments are zero; of an open one they depend on the reference point. Where
    vertices were welded across gaps, `input_error` bounds what that may have changed too.

    Attributes
    ----------
    volume : Moments
        To order 3, about the body's reference point.
    area : Moments
        Of the input's faces, without caps.
    health : MeshReport
        The input before anything was repaired.
    method : str
        "exact", "capped", "reoriented" or "open".
    findings : tuple of Finding
        The decisions taken; those about the whole surface have no elements.
    repaired_surface : Surface
        The surface whose signed sum `volume` is: its moments to any order are the body's.
    parts : callable
        Returns the same by closed part.

    Examples
    --------
    >>> from body_moments.core import Surface, measure_solid
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2]])
    >>> body = measure_solid(surface)
    >>> str(body.method), [found.code for found in body.findings], round(body.exact_third_order().total * 6, 9)
    ('capped', ['holes_capped'], 1.0)
    """

    volume: Moments
    area: Moments
    health: MeshReport
    method: str
    findings: tuple[Finding, ...]
    repaired_surface: Surface
    parts: Callable[[], ClosedParts]

    def exact_third_order(self, threads: int = 1) -> Moments:
        """Return `volume` with its third order exact to rounding, for what its bounds leave undecided."""
        return polyhedron_moments(self.repaired_surface, exact=True, threads=threads)[0]


def measure_solid(
    surface: Surface,
    *,
    shell: bool = False,
    threads: int = 1,
    weld_near: bool = True,
) -> SolidIntegrals:
    """Measure the body that a surface bounds, in the surface's own coordinates and unit.

    An open, flipped or doubled surface is repaired on a copy, and each decision is a finding; see the module.

    Parameters
    ----------
    surface : Surface
    shell : bool
        Whether the area's moments are to order 3, otherwise order 0.
    threads : int
        For the sums over faces, and for the verdict.
    weld_near : bool
        Whether vertices along open edges that differ by rounding are welded, unless the body is so thin that it would
        collapse.

    Returns
    -------
    SolidIntegrals
        The moments, the method and the findings.

    Raises
    ------
    MeasureError
        If there are no faces, or a face uses a vertex that has no finite position.

    Examples
    --------
    >>> from body_moments.core import Surface, measure_solid
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]])
    >>> body = measure_solid(surface)
    >>> str(body.method), round(body.volume.total * 6, 9), body.health.defective_elements.flipped_faces.tolist()
    ('reoriented', 1.0, [3])
    """
    given = surface
    surface, vertices, size = _drop_unused_vertices(surface)
    error = float(np.linalg.norm(surface.coordinate_error))
    tolerance = max(WELDING_RTOL * size, 4.0 * error)
    as_given, body, planarity = _integrate_and_prove(surface, shell, threads, error)
    proven = body is not None
    if not proven:
        body = repair_surface(surface, tolerance, weld_near)
    comparison = _compare_components(body, tolerance, error) if body.number > 1 else None
    flip = np.zeros(body.number, bool) if comparison is None else comparison.flipped
    flip_each = flip
    measured = _oriented_surface(
        surface, body, flip, np.ones(1, bool) if comparison is None else comparison.solid, proven
    )
    volume, area = as_given  # the area is the input's: without caps, with what was left out and with flat parts
    if measured is not surface:
        caps = _caps_only(surface, body, flip, measured)
        about = None if caps is None else volume.about
        volume = polyhedron_moments(caps or measured, area_order=0, about=about, threads=threads)[0]
        if caps is not None:
            volume = sum_moments([as_given[0], volume])
    if body.max_displacement * area.total > MAX_WELDED_SHARE * abs(volume.total):
        unwelded = measure_solid(given, shell=shell, threads=threads, weld_near=False)
        if unwelded.method != "open":
            return unwelded
    if comparison is None:
        solid = bool(
            abs(volume.total)
            > max(_zero_volume_threshold(size, area.total, body.caps.any(), error), volume.rounding_error[0])
        )
        flip = flip | (solid and volume.total < 0.0 and not body.open.any())  # what is open has no inside
        caps = body.caps.sum(axis=0) * solid
    else:
        solid = bool(comparison.solid.any())
        caps = body.caps[comparison.solid].sum(axis=0)
    cap_share = float(caps[2] / area.total) if area.total > 0.0 else 0.0
    open_parts = bool(body.open.any())
    if not solid and not open_parts:  # what rounding leaves of nothing would pass for a tiny body
        volume = replace(
            volume, raw=np.zeros_like(volume.raw), rounding_error=volume.rounding_error + np.abs(volume.raw)
        )
    inside_out = volume.total < 0.0
    if inside_out:
        volume = replace(volume, raw=-volume.raw)
        measured = replace(measured, quads=measured.quads[:, [0, 3, 2, 1]], triangles=measured.triangles[:, ::-1])
    flipped, inverted = _flipped_faces(body, flip)
    impossible = solid and not open_parts and not _is_physical(volume, surface, size)
    if open_parts or not solid or impossible:
        method = "open"
    elif caps.any():
        method = "capped"
    else:
        method = "reoriented" if len(flipped) or len(inverted) else "exact"
    findings = _weld_finding(body, size, area.total, volume.total)
    findings += [_of_input(found, vertices) for found in body.findings]
    findings += _turned_findings(body, flipped, inverted)
    capped = np.ones(1, bool) if comparison is None else comparison.solid
    findings += _cap_finding(body, capped, vertices, caps, cap_share, caps[2] * size < NEGLIGIBLE * volume.total)
    if comparison is not None:
        findings += comparison.findings
    if impossible:
        findings.append(finding("self_intersecting"))
    if not solid:
        findings.append(finding("flat_surface"))
    elif planarity.volume_ambiguity > MIN_REPORTED_AMBIGUITY * volume.total > 0.0:
        share = float(planarity.volume_ambiguity / volume.total)
        findings.append(finding("non_planar_faces_slightly" if share < NEGLIGIBLE else "non_planar_faces", share=share))
    counts = body.counts | (comparison.counts if comparison else {})
    defects = {
        key: vertices[value] if vertices is not None and key.endswith("edges") else value
        for key, value in body.defects.items()
    }
    health = MeshReport(
        **counts,
        inverted_components=len(inverted),
        degenerate_faces=len(planarity.degenerate_faces),
        non_planar_faces=planarity.non_planar_count,
        volume_spread=planarity.volume_ambiguity,
        cap_area_share=cap_share,
        defective_elements=DefectiveElements(
            **defects, flipped_faces=flipped, degenerate_faces=planarity.degenerate_faces
        ),
    )

    def parts() -> ClosedParts:
        return _closed_parts(measured, body, comparison, flip_each ^ inside_out, proven)

    return SolidIntegrals(volume, area, health, method, tuple(findings), repaired_surface=measured, parts=parts)


def _integrate_and_prove(
    surface: Surface, shell: bool, threads: int, error: float
) -> tuple[tuple[Moments, Moments], RepairedMesh | None, Planarity]:
    """The moments of volume and area of the surface as it is given, the body where its own edges prove it closed, else
    None, and how flat its faces are. Sums and proof run side by side where that is worth a thread."""
    accumulator, area_order = PlanarityAccumulator(surface, error), 3 if shell else 0
    if min(threads, (len(surface.triangles) + 2 * len(surface.quads)) // third_order.MIN_TRIANGLES_PER_THREAD) > 1:
        with ThreadPoolExecutor(1) as pool:
            waiting = pool.submit(_closed_by_mesh_edges, surface)
            sums = polyhedron_moments(surface, area_order=area_order, threads=threads, planarity=accumulator)
        return sums, waiting.result(), accumulator.planarity()
    sums = polyhedron_moments(surface, area_order=area_order, planarity=accumulator)
    return sums, _closed_by_mesh_edges(surface), accumulator.planarity()


def _is_physical(volume: Moments, surface: Surface, size: float) -> bool:
    """Whether a body within the points' bounding box, `size` across, can have these moments: its center is inside, and
    its second central moments are those of a positive mass. Where a surface intersects itself, they need not be."""
    total = volume.raw[0]
    if not total > 0.0:
        return True  # an open surface's sum, which is reported as such
    mean = volume.raw[1:4] / total
    second = volume.raw[SECOND_MOMENT_INDEX] / total - np.outer(mean, mean)
    rounding = 8.0 * (
        volume.rounding_error[SECOND_MOMENT_INDEX].max() / total + np.finfo(float).eps * np.abs(second).max()
    )
    tolerance = 1e-6 * size + volume.rounding_error[1:4].max() / total
    center = volume.center
    low, high = surface.box
    inside = bool((low - tolerance <= center).all() and (center <= high + tolerance).all())
    return bool(inside and np.linalg.eigvalsh(second)[0] >= -rounding)


def _drop_unused_vertices(surface: Surface) -> tuple[Surface, NDArray[np.intp] | None, float]:
    """The surface without vertices that no face uses, the old number of each vertex (None where all are used), and the
    diagonal of the bounding box. MeasureError where the surface cannot be measured."""
    faces = [corners for corners in (surface.quads, surface.triangles) if len(corners)]
    if not faces:
        raise MeasureError("no_faces")
    points, total = surface.points, len(surface.points)
    if not all(indices_in_range(corners, len(points)) for corners in faces):
        raise MeasureError("invalid_faces")
    used = np.zeros(len(points), bool)
    for column in (0, 2, 1, 3):  # opposite corners first: they reach most vertices
        for corners in faces:
            if column < corners.shape[1]:
                used[corners[:, column].astype(np.intp)] = True
        if used.all():
            break
    vertices = None
    if not used.all():
        vertices = np.flatnonzero(used)
        number = np.cumsum(used) - 1
        surface = replace(
            surface,
            points=points[used],
            triangles=number[surface.triangles],
            quads=number[surface.quads],
            corner_vertices=None if surface.corner_vertices is None else number[surface.corner_vertices],
        )
    low, high = surface.box
    with np.errstate(invalid="ignore", over="ignore"):
        size = float(np.linalg.norm(high - low))
    if not np.isfinite(size):
        misplaced = np.flatnonzero(~np.isfinite(surface.points).all(axis=1))
        if len(misplaced):
            elements = misplaced if vertices is None else vertices[misplaced]
            raise MeasureError("non_finite_vertices", elements=elements, count=len(misplaced), total=total)
    if not max(size, float(np.abs([low, high]).max())) < MAX_COORDINATE:
        raise MeasureError("object_too_large")
    if 0.0 < size < MIN_SIZE:
        raise MeasureError("object_too_small")
    return surface, vertices, size


def _zero_volume_threshold(size: float, area: float, capped: bool, error: float) -> float:
    """The volume that is none: what rounding leaves of a closed sheet, and what capping leaves of a flat one."""
    return (FLAT_CAP_VOLUME_RTOL * size + 4.0 * error) * area if capped else CLOSED_SHEET_VOLUME_RTOL * size * area


def _closed_by_mesh_edges(surface: Surface) -> RepairedMesh | None:
    """The body where the mesh's own edges prove it closed and oriented. The triangles of a single shell are left out:
    nothing asks for them."""
    sides = closed_side_faces(surface)
    if sides is None:
        return None
    component, component_count = connected_components(int(sides.max()) + 1, *sides)
    triangles, face = surface.triangles[:0], component[:0]
    if component_count > 1:
        quad_faces, triangle_faces = face_of_each(surface)
        triangles = np.concatenate([surface.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), surface.triangles])
        face = np.concatenate([np.repeat(quad_faces, 2), triangle_faces])
    return RepairedMesh(
        surface.points,
        triangles,
        face,
        np.zeros(len(face), bool),
        component[face],
        component_count,
        np.zeros(component_count, bool),
        np.zeros((component_count, 3)),
        counts={"closed": True, "components": component_count},
    )


@dataclass(frozen=True, eq=False)
class _ShellComparison:
    """What comparing the shells of a body came to. flipped, solid: (c,) the shells to turn, and those with a volume.
    counts: entries of `MeshReport`. host: (c,) as in `ClosedParts`."""

    flipped: NDArray[np.bool_]
    solid: NDArray[np.bool_]
    counts: dict
    findings: list[Finding]
    host: NDArray[np.intp]


def _compare_components(body: RepairedMesh, tolerance: float, error: float) -> _ShellComparison:
    sorted_components = sort_components(body.points, body.triangles, body.component, body.number)
    size = np.linalg.norm(sorted_components.high - sorted_components.low, axis=1)
    closed, capped = (_zero_volume_threshold(size, sorted_components.area, caps, error) for caps in (False, True))
    noise = np.where(body.caps.any(axis=1), capped, closed)
    solid = ~body.open & (np.abs(sorted_components.volume) > noise)
    relations = classify_pairs(body.points, sorted_components, solid, tolerance)
    flipped, nested, cavities = orient_nested_shells(sorted_components, relations, solid)
    crossing = np.zeros(body.number, bool)
    crossing[relations.intersecting] = True
    flat = ~solid & ~body.open if solid.any() else np.zeros(body.number, bool)
    findings = []
    if nested.any():
        findings.append(finding("components_nested", _faces_of(body, nested), count=int(nested.sum())))
    if crossing.any():
        findings.append(finding("components_overlap", _faces_of(body, crossing), count=int(crossing.sum())))
    if flat.any():
        findings.append(
            finding("flat_components", _faces_of(body, flat), count=int(flat.sum()), total=int(body.number))
        )
    if relations.undecided_pairs:
        findings.append(finding("overlap_unchecked", count=int(relations.undecided_pairs)))
    return _ShellComparison(
        flipped,
        solid,
        {
            "nested_components": int(nested.sum()),
            "cavities": int(cavities.sum()),
            "overlapping_components": int(crossing.sum()),
        },
        findings,
        cavity_host(relations, cavities),
    )


def _oriented_surface(
    surface: Surface, body: RepairedMesh, flip: NDArray[np.bool_], solid: NDArray[np.bool_], proven: bool
) -> Surface:
    """The surface whose signed sum is the body's."""
    flipped = body.flipped ^ flip[body.component]
    included = (body.open | solid)[body.component]  # of flat parts only rounding would count
    if not (body.topology_changed or flipped.any() or (body.face < 0).any()) and (included.all() or not included.any()):
        return surface
    if proven:
        quads, triangles = surface.quads.copy(), surface.triangles.copy()
        flipped_rows = flipped[: 2 * len(quads) : 2]
        quads[flipped_rows] = quads[flipped_rows][:, [0, 3, 2, 1]]  # the first corner stays, and with it the diagonal
        flipped_rows = flipped[2 * len(quads) :]
        triangles[flipped_rows] = triangles[flipped_rows][:, ::-1]
        return replace(surface, quads=quads, triangles=triangles)
    triangles = body.triangles
    if flip.any():
        triangles = np.where(flip[body.component][:, None], triangles[:, ::-1], triangles)
    displacement = surface.coordinate_error + body.max_displacement if body.max_displacement else surface.displacement
    return Surface(body.points, triangles if included.all() else triangles[included], displacement=displacement)


def _caps_only(surface: Surface, body: RepairedMesh, flip: NDArray[np.bool_], measured: Surface) -> Surface | None:
    """The caps, where they are all by which `measured` differs from `surface`."""
    caps = body.face < 0
    if (
        body.topology_changed
        or not caps.any()
        or len(measured.triangles) < len(body.triangles)
        or body.flipped.any()
        or flip.any()
    ):
        return None
    return replace(measured, triangles=measured.triangles[caps])


def _closed_parts(
    measured: Surface, body: RepairedMesh, comparison: _ShellComparison | None, flip: NDArray[np.bool_], proven: bool
) -> ClosedParts:
    """The triangles of `measured` by closed part. flip: (c,) the shells of the mended body to turn."""
    host = np.arange(body.number) if comparison is None else comparison.host
    if proven:
        triangles, face = measured.all_triangles()
        part = np.zeros(len(face), np.intp)
        if body.number > 1:
            of_face = np.zeros(int(body.face.max()) + 1, np.intp)
            of_face[body.face] = body.component
            part = of_face[face]
        return ClosedParts(measured.points, triangles, face, part, body.number, host)
    included = np.ones(len(body.face), bool)
    if comparison is not None:
        included = (body.open | comparison.solid)[body.component]
        included |= not included.any()
    triangles = np.where(flip[body.component][:, None], body.triangles[:, ::-1], body.triangles)
    return ClosedParts(
        body.points, triangles[included], body.face[included], body.component[included], body.number, host
    )


def _faces_of(body: RepairedMesh, which: NDArray[np.bool_]) -> NDArray[np.integer]:
    """The mesh faces of some shells, sorted."""
    return np.unique(body.face[which[body.component] & (body.face >= 0)])


def _of_input(found: Finding, vertices: NDArray[np.intp] | None) -> Finding:
    """The finding with edges in the input's vertices, where those of no face were left out before."""
    edges = np.ndim(found.elements) == 2
    return replace(found, elements=vertices[found.elements]) if edges and vertices is not None else found


def _weld_finding(body: RepairedMesh, size: float, area: float, volume: float) -> list[Finding]:
    if not body.max_displacement > 0.0:
        return []
    slight = body.max_displacement * area < NEGLIGIBLE * abs(volume)
    return [
        finding("vertices_welded_slightly" if slight else "vertices_welded", share=float(body.max_displacement / size))
    ]


def _turned_findings(body: RepairedMesh, flipped: NDArray[np.integer], inverted: NDArray[np.intp]) -> list[Finding]:
    findings = []
    if len(flipped):
        findings.append(finding("flipped_faces", flipped, count=len(flipped)))
    if len(inverted):
        which = np.zeros(body.number, bool)
        which[inverted] = True
        faces = NO_FACES if which.all() else _faces_of(body, which)
        findings.append(finding("inverted_components", faces, count=len(inverted), total=int(body.number)))
    return findings


def _cap_finding(
    body: RepairedMesh,
    solid: NDArray[np.bool_],
    vertices: NDArray[np.intp] | None,
    caps: NDArray[np.float64],
    share: float,
    slight: bool,
) -> list[Finding]:
    """About the capped holes of shells that have a volume. caps: (3,) flat ones, curved ones, and their area; share: of
    the surface's. slight: whether all their moments together are negligible."""
    flat, curved = map(int, caps[:2])
    if not flat + curved:
        return []
    edges = body.capped_edges[solid[body.capped_shell]]
    edges = unique_pairs(edges if vertices is None else vertices[edges])
    if slight:
        return [finding("holes_capped_slightly", edges, count=flat + curved, share=share)]
    return [finding("holes_capped", edges, count=flat + curved, flat=flat, curved=curved, share=share)]


def _flipped_faces(body: RepairedMesh, flip: NDArray[np.bool_]) -> tuple[NDArray[np.integer], NDArray[np.intp]]:
    """The mesh faces that were turned within their shells, and the shells that were turned as a whole."""
    if not len(body.face) or not (body.flipped.any() or flip.any()):
        return NO_FACES, np.flatnonzero(flip)
    of_mesh = body.face >= 0
    flipped, component = (body.flipped ^ flip[body.component])[of_mesh], body.component[of_mesh]
    whole = np.bincount(component, ~flipped, minlength=body.number) == 0
    return np.unique(body.face[of_mesh][flipped & ~whole[component]]), np.flatnonzero(whole)
