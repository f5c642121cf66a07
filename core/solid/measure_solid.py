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

from ..mesh.bvh import sort_shells
from ..mesh.edges import closed_sides, mesh_faces
from ..mesh.planarity import Flatness, Witness
from ..mesh.surface import Surface, all_there
from ..moments.moments import SECOND, Moments, sum_moments
from ..numerics.arrays import unique_pairs
from ..numerics.graph import components
from ..polyhedron import polyhedron_moments, third_order
from ..verdict.finding import Finding, MeasureError, finding
from ..verdict.health import NO_FACES, Faults, Health
from ..verdict.tolerances import LARGEST, NEGLIGIBLE, NO_VOLUME, ROUNDING, SMALLEST, TOLERANCE
from .nesting import cut_from, decide, relate
from .parts import Components
from .repair import Mended, mend

COLLAPSED = 0.1  # of the volume: where welding may change that much, what it closes is no gap left by rounding
SPREAD = 1e-6  # of the volume: below, nobody needs to know


@dataclass(frozen=True, eq=False)
class SolidMeasure:
    """volume: Moments to order 3, about the body's reference point. area: Moments of the input's faces, without caps.
    method: "exact", "capped", "reoriented" or "open". findings: the decisions taken; those about the whole surface have
    no elements.

    Of a body that is flat the volume's moments are zero; of an open one they depend on the reference point. Where
    vertices were welded across gaps, `input` bounds what that may have changed too.
    mended: the surface whose signed sum `volume` is. components: gives the same by closed part.
    """

    volume: Moments
    area: Moments
    health: Health
    method: str
    findings: tuple[Finding, ...]
    mended: Surface
    components: Callable[[], Components]

    def refined(self, threads: int = 1) -> Moments:
        """`volume` with its third order exact to rounding, for what its bounds leave undecided."""
        return polyhedron_moments(self.mended, exact=True, threads=threads)[0]


def measure_solid(
    surface: Surface,
    *,
    shell: bool = False,
    threads: int = 1,
    near: bool = True,
) -> SolidMeasure:
    """The moments of the body that a surface bounds, in the surface's own coordinates and unit, and how they came.

    shell: the area's moments to order 3 (else order 0). threads: for the sums over faces, and for the verdict.
    near: whether vertices along open edges that differ by rounding are welded, unless the body is so thin that it would
    collapse. MeasureError where there are no faces, or a face uses a vertex that has no finite position.
    """
    given = surface
    surface, vertices, size = _used(surface)
    error = float(np.linalg.norm(surface.coordinate_error))
    tolerance = max(TOLERANCE * size, 4.0 * error)
    own, body, flatness = _as_it_stands(surface, shell, threads, error)
    proven = body is not None
    if not proven:
        body = mend(surface, tolerance, near)
    compared = _compared(body, tolerance, error) if body.number > 1 else None
    turn = np.zeros(body.number, bool) if compared is None else compared.turned
    turn_each = turn
    measured = _to_measure(surface, body, turn, np.ones(1, bool) if compared is None else compared.solid, proven)
    volume, area = own  # the area is the input's: without caps, with what was left out and with flat parts
    if measured is not surface:
        caps = _caps_alone(surface, body, turn, measured)
        about = None if caps is None else volume.about
        volume = polyhedron_moments(caps or measured, area_order=0, about=about, threads=threads)[0]
        if caps is not None:
            volume = sum_moments([own[0], volume])
    if body.moved * area.total > COLLAPSED * abs(volume.total):
        apart = measure_solid(given, shell=shell, threads=threads, near=False)
        if apart.method != "open":
            return apart
    if compared is None:
        solid = bool(abs(volume.total) > max(_noise(size, area.total, body.caps.any(), error), volume.error[0]))
        turn = turn | (solid and volume.total < 0.0 and not body.open.any())  # what is open has no inside
        caps = body.caps.sum(axis=0) * solid
    else:
        solid = bool(compared.solid.any())
        caps = body.caps[compared.solid].sum(axis=0)
    cap_share = float(caps[2] / area.total) if area.total > 0.0 else 0.0
    open_parts = bool(body.open.any())
    if not solid and not open_parts:  # what rounding leaves of nothing would pass for a tiny body
        volume = replace(volume, raw=np.zeros_like(volume.raw), error=volume.error + np.abs(volume.raw))
    inside_out = volume.total < 0.0
    if inside_out:
        volume = replace(volume, raw=-volume.raw)
        measured = replace(measured, quads=measured.quads[:, [0, 3, 2, 1]], triangles=measured.triangles[:, ::-1])
    flipped, inverted = _turned_faces(body, turn)
    impossible = solid and not open_parts and not _possible(volume, surface, size)
    if open_parts or not solid or impossible:
        method = "open"
    elif caps.any():
        method = "capped"
    else:
        method = "reoriented" if len(flipped) or len(inverted) else "exact"
    findings = _weld_finding(body, size, area.total, volume.total)
    findings += [_of_input(found, vertices) for found in body.findings]
    findings += _turned_findings(body, flipped, inverted)
    capped = np.ones(1, bool) if compared is None else compared.solid
    findings += _cap_finding(body, capped, vertices, caps, cap_share, caps[2] * size < NEGLIGIBLE * volume.total)
    if compared is not None:
        findings += compared.findings
    if impossible:
        findings.append(finding("self_intersecting"))
    if not solid:
        findings.append(finding("flat_surface"))
    elif flatness.spread > SPREAD * volume.total > 0.0:
        share = float(flatness.spread / volume.total)
        findings.append(finding("non_planar_faces_slightly" if share < NEGLIGIBLE else "non_planar_faces", share=share))
    counts = body.counts | (compared.counts if compared else {})
    faults = {
        key: vertices[value] if vertices is not None and key.endswith("edges") else value
        for key, value in body.faults.items()
    }
    health = Health(
        **counts,
        inverted_components=len(inverted),
        degenerate_faces=len(flatness.without_area),
        non_planar_faces=flatness.not_flat,
        volume_spread=flatness.spread,
        cap_area_share=cap_share,
        faults=Faults(**faults, flipped_faces=flipped, degenerate_faces=flatness.without_area),
    )

    def parts() -> Components:
        return _parts(measured, body, compared, turn_each ^ inside_out, proven)

    return SolidMeasure(volume, area, health, method, tuple(findings), mended=measured, components=parts)


def _as_it_stands(
    surface: Surface, shell: bool, threads: int, error: float
) -> tuple[tuple[Moments, Moments], Mended | None, Flatness]:
    """The moments of volume and area of the surface as it is given, the body where its own edges prove it closed, else
    None, and how flat its faces are. Sums and proof run side by side where that is worth a thread."""
    witness, area_order = Witness(surface, error), 3 if shell else 0
    if min(threads, (len(surface.triangles) + 2 * len(surface.quads)) // third_order.LEAST) > 1:
        with ThreadPoolExecutor(1) as pool:
            waiting = pool.submit(_proven, surface)
            sums = polyhedron_moments(surface, area_order=area_order, threads=threads, planarity=witness)
        return sums, waiting.result(), witness.flatness()
    sums = polyhedron_moments(surface, area_order=area_order, planarity=witness)
    return sums, _proven(surface), witness.flatness()


def _possible(volume: Moments, surface: Surface, size: float) -> bool:
    """Whether a body within the points' bounding box, `size` across, can have these moments: its center is inside, and
    its second central moments are those of a positive mass. Where a surface intersects itself, they need not be."""
    total = volume.raw[0]
    if not total > 0.0:
        return True  # an open surface's sum, which is reported as such
    mean = volume.raw[1:4] / total
    second = volume.raw[SECOND] / total - np.outer(mean, mean)
    rounding = 8.0 * (volume.error[SECOND].max() / total + np.finfo(float).eps * np.abs(second).max())
    slack = 1e-6 * size + volume.error[1:4].max() / total
    center = volume.center
    low, high = surface.box
    inside = bool((low - slack <= center).all() and (center <= high + slack).all())
    return bool(inside and np.linalg.eigvalsh(second)[0] >= -rounding)


def _used(surface: Surface) -> tuple[Surface, NDArray[np.intp] | None, float]:
    """The surface without vertices that no face uses, the old number of each vertex (None where all are used), and the
    diagonal of the bounding box. MeasureError where the surface cannot be measured."""
    faces = [corners for corners in (surface.quads, surface.triangles) if len(corners)]
    if not faces:
        raise MeasureError("no_faces")
    points, total = surface.points, len(surface.points)
    if not all(all_there(corners, len(points)) for corners in faces):
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
        astray = np.flatnonzero(~np.isfinite(surface.points).all(axis=1))
        if len(astray):
            elements = astray if vertices is None else vertices[astray]
            raise MeasureError("non_finite_vertices", elements=elements, count=len(astray), total=total)
    if not max(size, float(np.abs([low, high]).max())) < LARGEST:
        raise MeasureError("object_too_large")
    if 0.0 < size < SMALLEST:
        raise MeasureError("object_too_small")
    return surface, vertices, size


def _noise(size: float, area: float, capped: bool, error: float) -> float:
    """The volume that is none: what rounding leaves of a closed sheet, and what capping leaves of a flat one."""
    return (NO_VOLUME * size + 4.0 * error) * area if capped else ROUNDING * size * area


def _proven(surface: Surface) -> Mended | None:
    """The body where the mesh's own edges prove it closed and oriented. The triangles of a single shell are left out:
    nothing asks for them."""
    sides = closed_sides(surface)
    if sides is None:
        return None
    shell, shells = components(int(sides.max()) + 1, *sides)
    triangles, face = surface.triangles[:0], shell[:0]
    if shells > 1:
        quad_faces, triangle_faces = mesh_faces(surface)
        triangles = np.concatenate([surface.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), surface.triangles])
        face = np.concatenate([np.repeat(quad_faces, 2), triangle_faces])
    return Mended(
        surface.points,
        triangles,
        face,
        np.zeros(len(face), bool),
        shell[face],
        shells,
        np.zeros(shells, bool),
        np.zeros((shells, 3)),
        counts={"closed": True, "components": shells},
    )


@dataclass(frozen=True, eq=False)
class _Compared:
    """What comparing the shells of a body came to. turned, solid: (c,) the shells to turn, and those with a volume.
    counts: entries of `Health`. within: (c,) as in `Components`."""

    turned: NDArray[np.bool_]
    solid: NDArray[np.bool_]
    counts: dict
    findings: list[Finding]
    within: NDArray[np.intp]


def _compared(body: Mended, tolerance: float, error: float) -> _Compared:
    shells = sort_shells(body.points, body.triangles, body.shell, body.number)
    size = np.linalg.norm(shells.high - shells.low, axis=1)
    closed, capped = (_noise(size, shells.area, caps, error) for caps in (False, True))
    noise = np.where(body.caps.any(axis=1), capped, closed)
    solid = ~body.open & (np.abs(shells.volume) > noise)
    relations = relate(body.points, shells, solid, tolerance)
    turned, nested, cavities = decide(shells, relations, solid)
    crossing = np.zeros(body.number, bool)
    crossing[relations.crossing] = True
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
    if relations.unchecked:
        findings.append(finding("overlap_unchecked", count=int(relations.unchecked)))
    return _Compared(
        turned,
        solid,
        {
            "nested_components": int(nested.sum()),
            "cavities": int(cavities.sum()),
            "overlapping_components": int(crossing.sum()),
        },
        findings,
        cut_from(relations, cavities),
    )


def _to_measure(
    surface: Surface, body: Mended, turn: NDArray[np.bool_], solid: NDArray[np.bool_], proven: bool
) -> Surface:
    """The surface whose signed sum is the body's."""
    turned = body.turned ^ turn[body.shell]
    kept = (body.open | solid)[body.shell]  # of flat parts only rounding would count
    if not (body.changed or turned.any() or (body.face < 0).any()) and (kept.all() or not kept.any()):
        return surface
    if proven:
        quads, triangles = surface.quads.copy(), surface.triangles.copy()
        rows = turned[: 2 * len(quads) : 2]
        quads[rows] = quads[rows][:, [0, 3, 2, 1]]  # the first corner stays, and with it the diagonal
        rows = turned[2 * len(quads) :]
        triangles[rows] = triangles[rows][:, ::-1]
        return replace(surface, quads=quads, triangles=triangles)
    triangles = body.triangles
    if turn.any():
        triangles = np.where(turn[body.shell][:, None], triangles[:, ::-1], triangles)
    moved = surface.coordinate_error + body.moved if body.moved else surface.moved
    return Surface(body.points, triangles if kept.all() else triangles[kept], moved=moved)


def _caps_alone(surface: Surface, body: Mended, turn: NDArray[np.bool_], measured: Surface) -> Surface | None:
    """The caps, where they are all by which `measured` differs from `surface`."""
    caps = body.face < 0
    if (
        body.changed
        or not caps.any()
        or len(measured.triangles) < len(body.triangles)
        or body.turned.any()
        or turn.any()
    ):
        return None
    return replace(measured, triangles=measured.triangles[caps])


def _parts(
    measured: Surface, body: Mended, compared: _Compared | None, turn: NDArray[np.bool_], proven: bool
) -> Components:
    """The triangles of `measured` by closed part. turn: (c,) the shells of the mended body to turn."""
    within = np.arange(body.number) if compared is None else compared.within
    if proven:
        triangles, face = measured.all_triangles()
        part = np.zeros(len(face), np.intp)
        if body.number > 1:
            of_face = np.zeros(int(body.face.max()) + 1, np.intp)
            of_face[body.face] = body.shell
            part = of_face[face]
        return Components(measured.points, triangles, face, part, body.number, within)
    kept = np.ones(len(body.face), bool)
    if compared is not None:
        kept = (body.open | compared.solid)[body.shell]
        kept |= not kept.any()
    triangles = np.where(turn[body.shell][:, None], body.triangles[:, ::-1], body.triangles)
    return Components(body.points, triangles[kept], body.face[kept], body.shell[kept], body.number, within)


def _faces_of(body: Mended, which: NDArray[np.bool_]) -> NDArray[np.integer]:
    """The mesh faces of some shells, sorted."""
    return np.unique(body.face[which[body.shell] & (body.face >= 0)])


def _of_input(found: Finding, vertices: NDArray[np.intp] | None) -> Finding:
    """The finding with edges in the input's vertices, where those of no face were left out before."""
    edges = np.ndim(found.elements) == 2
    return replace(found, elements=vertices[found.elements]) if edges and vertices is not None else found


def _weld_finding(body: Mended, size: float, area: float, volume: float) -> list[Finding]:
    if not body.moved > 0.0:
        return []
    slight = body.moved * area < NEGLIGIBLE * abs(volume)
    return [finding("vertices_welded_slightly" if slight else "vertices_welded", share=float(body.moved / size))]


def _turned_findings(body: Mended, flipped: NDArray[np.integer], inverted: NDArray[np.intp]) -> list[Finding]:
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
    body: Mended,
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


def _turned_faces(body: Mended, turn: NDArray[np.bool_]) -> tuple[NDArray[np.integer], NDArray[np.intp]]:
    """The mesh faces that were turned within their shells, and the shells that were turned as a whole."""
    if not len(body.face) or not (body.turned.any() or turn.any()):
        return NO_FACES, np.flatnonzero(turn)
    own = body.face >= 0
    turned, shell = (body.turned ^ turn[body.shell])[own], body.shell[own]
    whole = np.bincount(shell, ~turned, minlength=body.number) == 0
    return np.unique(body.face[own][turned & ~whole[shell]]), np.flatnonzero(whole)
