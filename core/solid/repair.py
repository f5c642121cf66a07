# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface that its mesh does not prove closed, repaired on a copy as far as it can be.

In this order: equal positions are welded where edges are odd (one face, or three), then positions that differ by
rounding; copies of faces are left out where the edges around them say so; gaps without area are recognized; the faces
of each part are made to agree; parts are grouped into shells; the other rims are capped. Only what is not closed by
itself is touched at any step.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..mesh.edges import Edges, consistent_orientation, edges_from_mesh, find_edges, group_components
from ..mesh.surface import Surface, normals
from ..mesh.welding import first_at_equal_position, first_at_near_position, same_vertices_groups, vertex_tolerance
from ..numerics.arrays import unique_pairs
from ..numerics.graph import connected_components
from ..verdict.finding import Finding, finding
from ..verdict.tolerances import NEGLIGIBLE
from .holes import find_loops, join_sides

NO_COPIES = np.empty(0, np.intp), np.empty(0, np.intp)
NO_EDGES = np.empty((0, 2), np.intp)


@dataclass(eq=False)
class RepairedMesh:
    """points: (n, 3) in the input's type; triangles: (t, 3), all faces running as measured, caps last.
    face: (t,) the mesh face of each, -1 for caps. flipped: (t,) which were reversed. component: (t,), 0 to number - 1.
    open: (number,) shells that cannot be closed. caps: (number, 3) of each shell how many flat caps and curved caps it
    has, and their area. topology_changed: whether the triangles, apart from their direction and from caps, are not
    simply the input's. max_displacement: (length) how far welding has moved a vertex at most. counts: entries of
    `Health`. defects: entries of `Faults`. capped_edges, capped_shell: (k, 2) the boundary edges of capped holes, and
    (k,) the shell of each.
    findings: what was decided, but for welding and caps, whose effect depends on the volume. Edges are pairs of the
    vertices of the surface that was given."""

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    face: NDArray[np.integer]
    flipped: NDArray[np.bool_]
    component: NDArray[np.intp]
    number: int
    open: NDArray[np.bool_]
    caps: NDArray[np.float64]
    topology_changed: bool = False
    max_displacement: float = 0.0
    counts: dict = field(default_factory=dict)
    defects: dict = field(default_factory=dict)
    capped_edges: NDArray[np.intp] = field(default_factory=lambda: NO_EDGES)
    capped_shell: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, np.intp))
    findings: list[Finding] = field(default_factory=list)


def repair_surface(surface: Surface, tolerance: float, weld_near: bool = True) -> RepairedMesh:
    """Repair a surface on a copy.

    tolerance: (length) positions nearer than this are one where edges are open. weld_near: whether positions that
    differ are welded at all.
    """
    points = surface.points
    given, face = surface.all_triangles()
    given, face = given.astype(np.intp), np.asarray(face, np.intp)
    findings: list[Finding] = []
    triangles, welded, displacement, edges = _weld_open_edges(surface, given, face, tolerance if weld_near else 0.0)
    kept_rows = np.flatnonzero(_non_degenerate(triangles))
    copies, non_manifold_count, non_manifold_edges = NO_COPIES, 0, NO_EDGES
    if len(kept_rows):
        edges = edges or find_edges(triangles[kept_rows])
        if edges.count.max() > 2:  # elsewhere copies of faces would have no others beside them
            sides = _non_manifold_sides(edges, face[kept_rows])
            non_manifold_count, non_manifold_edges = (
                len(np.unique(edges.of_side[sides])),
                _as_vertex_pairs(given[kept_rows], sides),
            )
            copies, left_out = _drop_duplicate_faces(points, triangles[kept_rows], face[kept_rows], edges, findings)
            if left_out.any():
                kept_rows = kept_rows[~left_out]
                edges = find_edges(triangles[kept_rows])
    triangles, given, face = triangles[kept_rows], given[kept_rows], face[kept_rows]
    body = RepairedMesh(
        points,
        triangles,
        face,
        np.zeros(len(kept_rows), bool),
        np.zeros(len(kept_rows), np.intp),
        0,
        np.zeros(0, bool),
        np.zeros((0, 3)),
        topology_changed=displacement > 0.0 or len(copies[1]) > 0,
        max_displacement=displacement,
        findings=findings,
    )
    body.counts = {
        "welded": welded,
        "duplicate_faces": len(copies[0]),
        "non_manifold_edges": non_manifold_count,
        "closed": False,
        "components": 0,
    }
    body.defects = {"duplicate_faces": copies[0], "non_manifold_edges": non_manifold_edges}
    if len(kept_rows):
        _orient_and_group(body, given, edges, tolerance)
    return body


def _non_degenerate(triangles: NDArray) -> NDArray[np.bool_]:
    """Which triangles have three different vertices; the others have no boundary and no area."""
    a, b, c = triangles.T
    return (a != b) & (b != c) & (c != a)


def _weld_open_edges(
    surface: Surface, triangles: NDArray, face: NDArray, tolerance: float
) -> tuple[NDArray, bool, float, Edges | None]:
    """The surface's triangles over welded vertices, whether any were, how far one had to move, and the edges of the
    triangles that are still proper, where they are known."""
    points = surface.points
    proper_rows = np.flatnonzero(_non_degenerate(triangles))
    if not len(proper_rows):
        return triangles, False, 0.0, None
    soup, all_rows, edges = len(triangles) * 3 == len(points), True, None
    if not soup:
        edges = edges_from_mesh(surface, triangles) if len(proper_rows) == len(triangles) else None
        edges = edges or find_edges(triangles[proper_rows])
        odd = edges.count % 2 == 1
        if not odd.any():
            return triangles, False, 0.0, edges
        along = np.stack(_ends(triangles[proper_rows], edges.first[odd]))  # vertices along open edges
        part, number = connected_components(len(proper_rows), *edges.adjacency())
        unfinished = np.zeros(number, bool)
        unfinished[part[edges.first[odd] // 3]] = True
        whole = ~unfinished[part]
        if whole.any():  # what is closed by copies of its own faces alone is a piece of another part
            single = np.zeros(len(proper_rows), bool)
            whole_face = face[proper_rows[whole]]
            single[whole] = ~_is_duplicated(same_vertices_groups(triangles[proper_rows[whole]], whole_face), whole_face)
            unfinished |= np.bincount(part, single, minlength=number) == 0
        proper_rows, all_rows = proper_rows[unfinished[part]], bool(unfinished.all())
    vertices = _unique_sorted(triangles[proper_rows], len(points))
    if soup:
        along = vertices
    same = first_at_equal_position(points[vertices])
    welded = bool(np.any(same != np.arange(len(same))))
    if welded:
        triangles = triangles.copy()
        onto = np.arange(len(points))
        onto[vertices] = vertices[same]
        triangles[proper_rows] = onto[triangles[proper_rows]]
        along = onto[along]
        proper_rows = proper_rows[_non_degenerate(triangles[proper_rows])]
    if not len(proper_rows):
        return triangles, welded, 0.0, None
    if welded:
        edges = find_edges(triangles[proper_rows])
        if not np.any(edges.count % 2):
            return triangles, welded, 0.0, edges if all_rows else None

    if tolerance == 0.0:
        return triangles, welded, 0.0, edges if all_rows or not welded else None
    vertices = _unique_sorted(along, len(points))
    reach = vertex_tolerance(points, triangles[proper_rows], vertices, tolerance)
    same = first_at_near_position(points[vertices], reach)
    if np.array_equal(same, np.arange(len(same))):
        return triangles, welded, 0.0, edges if all_rows or not welded else None
    place = points[vertices].astype(np.float64)
    moved = float(np.linalg.norm(place - place[same], axis=1).max())
    triangles = triangles.copy()
    onto = np.arange(len(points))
    onto[vertices] = vertices[same]
    triangles[proper_rows] = onto[triangles[proper_rows]]
    return triangles, True, moved, None


def _unique_sorted(values: NDArray[np.integer], width: int) -> NDArray[np.intp]:
    """The distinct values, sorted."""
    present = np.zeros(width, bool)
    present[values] = True
    return np.flatnonzero(present)


def _drop_duplicate_faces(
    points: NDArray, triangles: NDArray, face: NDArray, edges: Edges, findings: list[Finding]
) -> tuple[tuple[NDArray, NDArray], NDArray[np.bool_]]:
    """The faces on the same vertices as an earlier one; those left out; and (m,) which triangles these are.

    A region of copied faces is reduced to one layer where an odd number of other faces meets its rim, so that one layer
    closes it. Where an even number does, both layers belong: a wall between two boxes that touch, a two-sided fin. A
    region with no others at its rim is reduced where its layers run the same way, or where one layer is closed: a
    two-sided body, which would cancel itself.
    """
    none = np.zeros(len(triangles), bool)
    group = same_vertices_groups(triangles, face)
    later = group != face
    if not later.any():
        return NO_COPIES, none
    copied = _is_duplicated(group, face)

    side = np.flatnonzero(np.repeat(copied, 3))
    edge, owner = edges.of_side[side], side // 3
    meet = np.empty(len(edges.count), np.intp)
    meet[edge] = owner  # any of them
    region, number = connected_components(len(triangles), owner, meet[edge])
    single_count = np.bincount(edges.of_side, np.repeat(~copied, 3))[edge]
    vote = np.where(single_count % 2 == 1, 1, -1) * (single_count > 0)
    votes = np.bincount(region[owner], vote, minlength=number)
    has_neighbors = np.bincount(region[owner], single_count > 0, minlength=number) > 0

    vector = normals(points, triangles)
    vector = np.stack([np.bincount(face, vector[:, k]) for k in range(3)], axis=1)
    agree = np.sign(np.einsum("ij,ij->i", vector[face], vector[group])) * np.linalg.norm(vector[face], axis=1)
    parallel = np.bincount(region, agree * later, minlength=number)
    single = np.bincount(edges.of_side, np.repeat(copied & ~later, 3))[edge] % 2 == 1
    closed = np.bincount(region[owner], single, minlength=number) == 0
    reduced = np.where(has_neighbors, votes > 0, (parallel > 0) | closed)[region]

    left_out = later & reduced
    area = np.linalg.norm(vector, axis=1)  # of each face, doubled
    ignored = np.unique(face[left_out])
    if len(ignored):
        slight = area[ignored].sum() < NEGLIGIBLE * area.sum()
        findings.append(
            finding(
                "duplicate_faces_ignored_slightly" if slight else "duplicate_faces_ignored", ignored, count=len(ignored)
            )
        )
    doubled_faces = np.unique(face[later & ~reduced & (agree > 0.0)])
    if len(doubled_faces):
        slight = area[doubled_faces].sum() < NEGLIGIBLE * area.sum()
        findings.append(
            finding(
                "duplicate_faces_counted_slightly" if slight else "duplicate_faces_counted",
                doubled_faces,
                count=len(doubled_faces),
            )
        )
    return (np.unique(face[later]), ignored), left_out


def _is_duplicated(group: NDArray[np.integer], face: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(m,) which triangles are of faces on the vertices of another one. group: what `same_vertices_groups` gives."""
    copied = np.zeros(int(face.max()) + 1, bool)
    copied[group[group != face]] = True
    return copied[group]


def _orient_and_group(body: RepairedMesh, given: NDArray, edges: Edges, tolerance: float) -> None:
    """Orient the faces of each part, group parts into shells, and close the shells."""
    triangles, points = body.triangles, body.points
    gap = _find_t_junctions(points, triangles, edges, tolerance)
    first, second = edges.manifold_side_pairs()
    misoriented = edges.upward[first] == edges.upward[second]
    a = np.concatenate([first, gap.first]) // 3
    b = np.concatenate([second, gap.second]) // 3
    disagree = np.concatenate([misoriented, gap.misoriented])
    area = np.linalg.norm(normals(points, triangles), axis=1) if disagree.any() else np.zeros(len(triangles))
    flipped, twisted = consistent_orientation(len(triangles), a, b, disagree, area)
    part, parts = connected_components(len(triangles), a, b)
    filled = np.zeros(len(edges.count), bool)
    filled[edges.of_side[gap.sides]] = True
    shell, number = group_components(edges, part, parts, filled)
    body.flipped, body.component, body.number = flipped, shell, number
    body.open, body.caps = np.zeros(number, bool), np.zeros((number, 3))
    body.open[shell[twisted]] = True
    twists = int(np.count_nonzero(body.open))

    closed_already, gaps, capped = _close_boundaries(body, edges, gap, tolerance)
    boundary = edges.first[(edges.count == 1) & ~filled]
    boundary = boundary[~closed_already[boundary]]
    body.counts |= {
        "boundary_edges": len(boundary),
        "inconsistent_edges": int(np.count_nonzero(misoriented)),
        "components": number,
    }
    body.defects |= {
        "boundary_edges": _as_vertex_pairs(given, boundary),
        "inconsistent_edges": _as_vertex_pairs(given, np.concatenate([first[misoriented], second[misoriented]])),
    }
    body.capped_edges, body.capped_shell = _pairs(given, capped), shell[capped // 3]
    if gaps:
        sides = np.concatenate([gap.sides, np.flatnonzero(closed_already)])
        body.findings.append(finding("t_junctions", _as_vertex_pairs(given, sides), count=gaps))
    if twists:
        body.findings.append(
            finding("one_sided_components", body.defects["inconsistent_edges"], count=twists, total=number)
        )
    unclosable = int(np.count_nonzero(body.open)) - twists
    if unclosable:
        edges = np.concatenate([body.defects["non_manifold_edges"], body.defects["boundary_edges"]])
        body.findings.append(finding("non_manifold_components", edges, count=unclosable, total=number))


def _non_manifold_sides(edges: Edges, face: NDArray[np.integer]) -> NDArray[np.intp]:
    """The sides on edges with more than two triangles. A polygon's own diagonal, which it has on both sides, is none
    of its edges. face: (m,) the mesh face of each triangle."""
    sides = np.flatnonzero((edges.count > 2)[edges.of_side])
    key = edges.of_side[sides] * (int(face.max()) + 1) + face[sides // 3]
    _, place, times = np.unique(key, return_inverse=True, return_counts=True)
    return sides[times[place] == 1]


def _as_vertex_pairs(given: NDArray, sides: NDArray) -> NDArray[np.intp]:
    """(k, 2) the sides as vertex pairs of the input, the lower first, sorted, each once."""
    return unique_pairs(_pairs(given, sides))


def _pairs(given: NDArray, sides: NDArray) -> NDArray[np.intp]:
    """(k, 2) the sides as vertex pairs of the input, the lower first."""
    triangle, corner = sides // 3, sides % 3
    return np.sort(np.stack([given[triangle, corner], given[triangle, (corner + 1) % 3]], axis=1), axis=1)


@dataclass(frozen=True, eq=False)
class _ZeroAreaLoops:
    """sides: rim sides in loops without area; loop: the loop of each; number: of such loops. first, second,
    misoriented: the links between these sides, and whether the faces there disagree."""

    sides: NDArray[np.intp]
    loop: NDArray[np.intp]
    number: int
    first: NDArray[np.intp]
    second: NDArray[np.intp]
    misoriented: NDArray[np.bool_]


def _find_t_junctions(points: NDArray, triangles: NDArray, edges: Edges, tolerance: float) -> _ZeroAreaLoops:
    side = edges.boundary_sides()
    none = np.empty(0, np.intp)
    if not len(side):
        return _ZeroAreaLoops(none, none, 0, none, none, np.empty(0, bool))
    start, stop = _ends(triangles, side)
    begin, end = points[start].astype(np.float64), points[stop].astype(np.float64)
    links = join_sides(begin, end, start, stop, directed=False)
    loops = find_loops(begin, end, links)
    closed = loops.complete & ~loops.has_area(tolerance)
    within = closed[loops.of_side]
    linked = within[links[0]]
    loop = (np.cumsum(closed) - 1)[loops.of_side]
    return _ZeroAreaLoops(
        side[within],
        loop[within],
        int(np.count_nonzero(closed)),
        side[links[0][linked]],
        side[links[1][linked]],
        ~links[2][linked],
    )


def _ends(triangles: NDArray, sides: NDArray) -> tuple[NDArray, NDArray]:
    """The vertices from which and to which sides run."""
    triangle, corner = sides // 3, sides % 3
    return triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]


def _close_boundaries(
    body: RepairedMesh, edges: Edges, gap: _ZeroAreaLoops, tolerance: float
) -> tuple[NDArray[np.bool_], int, NDArray]:
    """Find the shells that cannot be closed; fill the gaps and cap the holes of the others.

    Returns (3m,) the sides that `_find_folded_loops` found to be closed, how many gaps there are, and (k,) the sides
    around caps.
    """
    if np.any(edges.count > 2) and body.number > 1:
        # Shells that meet in an edge are judged one by one, each with vertices of its own.
        key, vertex = np.unique(
            body.component.repeat(3) * len(body.points) + body.triangles.ravel(), return_inverse=True
        )
        edges = find_edges(vertex.reshape(-1, 3))
    signed_count = edges.signed_use_count(body.flipped)
    unclosable = np.zeros(body.number, bool)
    unclosable[body.component[edges.first[(signed_count != 0) & (edges.count > 1)] // 3]] = True
    spikes = _find_folded_loops(body, edges, signed_count, unclosable & ~body.open, tolerance)
    body.open |= unclosable & ~spikes.components
    closed_already = np.zeros(3 * len(body.triangles), bool)
    closed_already[spikes.sides] = True
    gaps = spikes.number + len(np.unique(gap.loop[~closed_already[gap.sides]]))

    boundary = edges.boundary_sides()
    boundary = boundary[~body.open[body.component[boundary // 3]] & ~closed_already[boundary]]
    loop = np.full(3 * len(body.triangles), -1)
    loop[gap.sides] = gap.loop
    loop = loop[boundary]
    start, stop = _ends(body.triangles, boundary)
    flipped = body.flipped[boundary // 3]
    start, stop = np.where(flipped, stop, start), np.where(flipped, start, stop)
    apex = np.empty(gap.number, np.intp)
    filled = loop >= 0
    apex[loop[filled][::-1]] = start[filled][::-1]
    caps = [np.stack([stop[filled], start[filled], apex[loop[filled]]], axis=1), spikes.caps]
    owner = [boundary[filled] // 3, spikes.sides // 3]
    if not filled.all():
        triangles, side = _cap_loops(body, boundary[~filled] // 3, start[~filled], stop[~filled], tolerance)
        caps.append(triangles)
        owner.append(side)
    body.counts["closed"] = not (body.open.any() or body.caps.any())
    caps, owner = np.concatenate(caps), np.concatenate(owner)
    useful = _non_degenerate(caps)
    caps, owner = caps[useful], owner[useful]
    body.triangles = np.concatenate([np.where(body.flipped[:, None], body.triangles[:, ::-1], body.triangles), caps])
    body.face = np.concatenate([body.face, np.full(len(caps), -1)])
    body.flipped = np.concatenate([body.flipped, np.zeros(len(caps), bool)])
    body.component = np.concatenate([body.component, body.component[owner]])
    return closed_already, gaps, boundary[~filled]


@dataclass(frozen=True, eq=False)
class _FoldedLoops:
    """components: (number,) those that close after all. sides, caps: a side on each edge that they leave over, and the
    triangle that closes it. number: of gaps."""

    components: NDArray[np.bool_]
    sides: NDArray[np.intp]
    caps: NDArray[np.intp]
    number: int


def _find_folded_loops(
    body: RepairedMesh, edges: Edges, signed_count: NDArray[np.float64], unclosable: NDArray[np.bool_], tolerance: float
) -> _FoldedLoops:
    """Shells with edges of three faces or more that close nevertheless, as all that they leave over are loops without
    area: letters whose outline turns back on itself. unclosable: (number,) the shells to look at. signed_count: of the
    edges."""
    edge = np.flatnonzero((signed_count != 0) & unclosable[body.component[edges.first // 3]])
    edge = np.repeat(edge, np.abs(signed_count[edge]).astype(np.intp))
    side = edges.first[edge]
    if not len(side):
        return _FoldedLoops(unclosable, side, np.empty((0, 3), np.intp), 0)
    start, stop = _ends(body.triangles, side)
    reversed_side = edges.upward[side] != (signed_count[edge] > 0.0)
    start, stop = np.where(reversed_side, stop, start), np.where(reversed_side, start, stop)
    begin, end = body.points[start].astype(np.float64), body.points[stop].astype(np.float64)
    component = body.component[side // 3]
    meet = [component * len(body.points) + vertex for vertex in (start, stop)]
    loops = find_loops(begin, end, join_sides(begin, end, *meet, directed=True))
    unclosable = unclosable.copy()
    unclosable[component[(~loops.complete | loops.has_area(tolerance))[loops.of_side]]] = False
    apex = np.empty(len(loops.perimeter), np.intp)
    apex[loops.of_side[::-1]] = start[::-1]
    caps = np.stack([stop, start, apex[loops.of_side]], axis=1)
    closes = unclosable[component]
    return _FoldedLoops(unclosable, side[closes], caps[closes], len(np.unique(loops.of_side[closes])))


def _cap_loops(
    body: RepairedMesh, owner: NDArray, start: NDArray, stop: NDArray, tolerance: float
) -> tuple[NDArray, NDArray]:
    """Cap rims, given as the vertices of their sides and the triangle that owns each. Returns the caps' triangles and
    for each one the triangle at whose side it stands."""
    begin, end = body.points[start].astype(np.float64), body.points[stop].astype(np.float64)
    shell = body.component[owner]
    meet = [shell * len(body.points) + vertex for vertex in (start, stop)]
    loops = find_loops(begin, end, join_sides(begin, end, *meet, directed=True))
    shell_of_loop = np.empty(len(loops.perimeter), np.intp)
    shell_of_loop[loops.of_side] = shell
    body.open[shell_of_loop[~loops.complete]] = True

    hole = loops.has_area(tolerance) & ~body.open[shell_of_loop]
    level = loops.out_of_plane <= tolerance
    for k, part in enumerate((level, ~level, np.where(level, loops.planar_area, loops.cone_area))):
        body.caps[:, k] = np.bincount(shell_of_loop, part * hole, minlength=body.number)
    # In the points' own type: a cap's apex then carries the same coordinate error as every vertex. A cap over three
    # sides needs none.
    apex = len(body.points) + np.arange(len(loops.perimeter))
    first = np.empty(len(apex), np.intp)
    first[loops.of_side[::-1]] = start[::-1]
    apex = np.where(np.bincount(loops.of_side) == 3, first, apex)[loops.of_side]
    body.points = np.concatenate([body.points, loops.centroid.astype(body.points.dtype)])
    return np.stack([stop, start, apex], axis=1), owner
