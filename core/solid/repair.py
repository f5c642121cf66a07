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

from ..mesh.edges import Edges, find_edges, named_edges, orientation, shells
from ..mesh.surface import Surface, normals
from ..mesh.welding import equal_positions, face_groups, near_positions, vertex_tolerance
from ..numerics.arrays import unique_pairs
from ..numerics.graph import components
from ..verdict.finding import Finding, finding
from ..verdict.tolerances import NEGLIGIBLE
from .holes import find_loops, join_sides

NO_COPIES = np.empty(0, np.intp), np.empty(0, np.intp)
NO_EDGES = np.empty((0, 2), np.intp)


@dataclass(eq=False)
class Mended:
    """points: (n, 3) in the input's type; triangles: (t, 3), all faces running as measured, caps last.
    face: (t,) the mesh face of each, -1 for caps. turned: (t,) which were reversed. shell: (t,), 0 to number - 1.
    open: (number,) shells that cannot be closed. caps: (number, 3) of each shell how many flat caps and curved caps it
    has, and their area. changed: whether the triangles, apart from their direction and from caps, are not simply the
    input's. moved: (length) how far welding has moved a vertex at most. counts: entries of `Health`. faults: entries of
    `Faults`. capped_edges, capped_shell: (k, 2) the boundary edges of capped holes, and (k,) the shell of each.
    findings: what was decided, but for welding and caps, whose effect depends on the volume. Edges are pairs of the
    vertices of the surface that was given."""

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    face: NDArray[np.integer]
    turned: NDArray[np.bool_]
    shell: NDArray[np.intp]
    number: int
    open: NDArray[np.bool_]
    caps: NDArray[np.float64]
    changed: bool = False
    moved: float = 0.0
    counts: dict = field(default_factory=dict)
    faults: dict = field(default_factory=dict)
    capped_edges: NDArray[np.intp] = field(default_factory=lambda: NO_EDGES)
    capped_shell: NDArray[np.intp] = field(default_factory=lambda: np.empty(0, np.intp))
    findings: list[Finding] = field(default_factory=list)


def mend(surface: Surface, tolerance: float, near: bool = True) -> Mended:
    """Repair a surface on a copy.

    tolerance: (length) positions nearer than this are one where edges are open. near: whether positions that differ are
    welded at all.
    """
    points = surface.points
    given, face = surface.all_triangles()
    given, face = given.astype(np.intp), np.asarray(face, np.intp)
    findings: list[Finding] = []
    triangles, welded, moved, edges = _welded(surface, given, face, tolerance if near else 0.0)
    rows = np.flatnonzero(_proper(triangles))
    copies, crowded, named = NO_COPIES, 0, NO_EDGES
    if len(rows):
        edges = edges or find_edges(triangles[rows])
        if edges.count.max() > 2:  # elsewhere copies of faces would have no others beside them
            sides = _crowded(edges, face[rows])
            crowded, named = len(np.unique(edges.of_side[sides])), _named(given[rows], sides)
            copies, left_out = _copies(points, triangles[rows], face[rows], edges, findings)
            if left_out.any():
                rows = rows[~left_out]
                edges = find_edges(triangles[rows])
    triangles, given, face = triangles[rows], given[rows], face[rows]
    body = Mended(
        points,
        triangles,
        face,
        np.zeros(len(rows), bool),
        np.zeros(len(rows), np.intp),
        0,
        np.zeros(0, bool),
        np.zeros((0, 3)),
        changed=moved > 0.0 or len(copies[1]) > 0,
        moved=moved,
        findings=findings,
    )
    body.counts = {
        "welded": welded,
        "duplicate_faces": len(copies[0]),
        "non_manifold_edges": crowded,
        "closed": False,
        "components": 0,
    }
    body.faults = {"duplicate_faces": copies[0], "non_manifold_edges": named}
    if len(rows):
        _join(body, given, edges, tolerance)
    return body


def _proper(triangles: NDArray) -> NDArray[np.bool_]:
    """Which triangles have three different vertices; the others have no boundary and no area."""
    a, b, c = triangles.T
    return (a != b) & (b != c) & (c != a)


def _welded(
    surface: Surface, triangles: NDArray, face: NDArray, tolerance: float
) -> tuple[NDArray, bool, float, Edges | None]:
    """The surface's triangles over welded vertices, whether any were, how far one had to move, and the edges of the
    triangles that are still proper, where they are known."""
    points = surface.points
    rows = np.flatnonzero(_proper(triangles))
    if not len(rows):
        return triangles, False, 0.0, None
    soup, all_rows, edges = len(triangles) * 3 == len(points), True, None
    if not soup:
        edges = named_edges(surface, triangles) if len(rows) == len(triangles) else None
        edges = edges or find_edges(triangles[rows])
        odd = edges.count % 2 == 1
        if not odd.any():
            return triangles, False, 0.0, edges
        along = np.stack(_ends(triangles[rows], edges.first[odd]))  # vertices along open edges
        part, number = components(len(rows), *edges.links())
        unfinished = np.zeros(number, bool)
        unfinished[part[edges.first[odd] // 3]] = True
        whole = ~unfinished[part]
        if whole.any():  # what is closed by copies of its own faces alone is a piece of another part
            single = np.zeros(len(rows), bool)
            own = face[rows[whole]]
            single[whole] = ~_copied(face_groups(triangles[rows[whole]], own), own)
            unfinished |= np.bincount(part, single, minlength=number) == 0
        rows, all_rows = rows[unfinished[part]], bool(unfinished.all())
    vertices = _distinct(triangles[rows], len(points))
    if soup:
        along = vertices
    same = equal_positions(points[vertices])
    welded = bool(np.any(same != np.arange(len(same))))
    if welded:
        triangles = triangles.copy()
        onto = np.arange(len(points))
        onto[vertices] = vertices[same]
        triangles[rows] = onto[triangles[rows]]
        along = onto[along]
        rows = rows[_proper(triangles[rows])]
    if not len(rows):
        return triangles, welded, 0.0, None
    if welded:
        edges = find_edges(triangles[rows])
        if not np.any(edges.count % 2):
            return triangles, welded, 0.0, edges if all_rows else None

    if tolerance == 0.0:
        return triangles, welded, 0.0, edges if all_rows or not welded else None
    vertices = _distinct(along, len(points))
    reach = vertex_tolerance(points, triangles[rows], vertices, tolerance)
    same = near_positions(points[vertices], reach)
    if np.array_equal(same, np.arange(len(same))):
        return triangles, welded, 0.0, edges if all_rows or not welded else None
    place = points[vertices].astype(np.float64)
    moved = float(np.linalg.norm(place - place[same], axis=1).max())
    triangles = triangles.copy()
    onto = np.arange(len(points))
    onto[vertices] = vertices[same]
    triangles[rows] = onto[triangles[rows]]
    return triangles, True, moved, None


def _distinct(values: NDArray[np.integer], width: int) -> NDArray[np.intp]:
    """The distinct values, sorted."""
    present = np.zeros(width, bool)
    present[values] = True
    return np.flatnonzero(present)


def _copies(
    points: NDArray, triangles: NDArray, face: NDArray, edges: Edges, findings: list[Finding]
) -> tuple[tuple[NDArray, NDArray], NDArray[np.bool_]]:
    """The faces on the same vertices as an earlier one; those left out; and (m,) which triangles these are.

    A region of copied faces is reduced to one layer where an odd number of other faces meets its rim, so that one layer
    closes it. Where an even number does, both layers belong: a wall between two boxes that touch, a two-sided fin. A
    region with no others at its rim is reduced where its layers run the same way, or where one layer is closed: a
    two-sided body, which would cancel itself.
    """
    none = np.zeros(len(triangles), bool)
    group = face_groups(triangles, face)
    later = group != face
    if not later.any():
        return NO_COPIES, none
    copied = _copied(group, face)

    side = np.flatnonzero(np.repeat(copied, 3))
    edge, owner = edges.of_side[side], side // 3
    meet = np.empty(len(edges.count), np.intp)
    meet[edge] = owner  # any of them
    region, number = components(len(triangles), owner, meet[edge])
    others = np.bincount(edges.of_side, np.repeat(~copied, 3))[edge]
    vote = np.where(others % 2 == 1, 1, -1) * (others > 0)
    votes = np.bincount(region[owner], vote, minlength=number)
    asked = np.bincount(region[owner], others > 0, minlength=number) > 0

    vector = normals(points, triangles)
    vector = np.stack([np.bincount(face, vector[:, k]) for k in range(3)], axis=1)
    agree = np.sign(np.einsum("ij,ij->i", vector[face], vector[group])) * np.linalg.norm(vector[face], axis=1)
    parallel = np.bincount(region, agree * later, minlength=number)
    single = np.bincount(edges.of_side, np.repeat(copied & ~later, 3))[edge] % 2 == 1
    closed = np.bincount(region[owner], single, minlength=number) == 0
    reduced = np.where(asked, votes > 0, (parallel > 0) | closed)[region]

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
    twice = np.unique(face[later & ~reduced & (agree > 0.0)])
    if len(twice):
        slight = area[twice].sum() < NEGLIGIBLE * area.sum()
        findings.append(
            finding(
                "duplicate_faces_counted_slightly" if slight else "duplicate_faces_counted", twice, count=len(twice)
            )
        )
    return (np.unique(face[later]), ignored), left_out


def _copied(group: NDArray[np.integer], face: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(m,) which triangles are of faces on the vertices of another one. group: what `face_groups` gives."""
    copied = np.zeros(int(face.max()) + 1, bool)
    copied[group[group != face]] = True
    return copied[group]


def _join(body: Mended, given: NDArray, edges: Edges, tolerance: float) -> None:
    """Orient the faces of each part, group parts into shells, and close the shells."""
    triangles, points = body.triangles, body.points
    gap = _gaps(points, triangles, edges, tolerance)
    one, other = edges.pairs()
    against = edges.upward[one] == edges.upward[other]
    a = np.concatenate([one, gap.one]) // 3
    b = np.concatenate([other, gap.other]) // 3
    disagree = np.concatenate([against, gap.against])
    area = np.linalg.norm(normals(points, triangles), axis=1) if disagree.any() else np.zeros(len(triangles))
    turned, twisted = orientation(len(triangles), a, b, disagree, area)
    part, parts = components(len(triangles), a, b)
    filled = np.zeros(len(edges.count), bool)
    filled[edges.of_side[gap.sides]] = True
    shell, number = shells(edges, part, parts, filled)
    body.turned, body.shell, body.number = turned, shell, number
    body.open, body.caps = np.zeros(number, bool), np.zeros((number, 3))
    body.open[shell[twisted]] = True
    twists = int(np.count_nonzero(body.open))

    settled, gaps, capped = _close(body, edges, gap, tolerance)
    rim = edges.first[(edges.count == 1) & ~filled]
    rim = rim[~settled[rim]]
    body.counts |= {
        "boundary_edges": len(rim),
        "inconsistent_edges": int(np.count_nonzero(against)),
        "components": number,
    }
    body.faults |= {
        "boundary_edges": _named(given, rim),
        "inconsistent_edges": _named(given, np.concatenate([one[against], other[against]])),
    }
    body.capped_edges, body.capped_shell = _pairs(given, capped), shell[capped // 3]
    if gaps:
        sides = np.concatenate([gap.sides, np.flatnonzero(settled)])
        body.findings.append(finding("t_junctions", _named(given, sides), count=gaps))
    if twists:
        body.findings.append(
            finding("one_sided_components", body.faults["inconsistent_edges"], count=twists, total=number)
        )
    torn = int(np.count_nonzero(body.open)) - twists
    if torn:
        edges = np.concatenate([body.faults["non_manifold_edges"], body.faults["boundary_edges"]])
        body.findings.append(finding("non_manifold_components", edges, count=torn, total=number))


def _crowded(edges: Edges, face: NDArray[np.integer]) -> NDArray[np.intp]:
    """The sides on edges with more than two triangles. A polygon's own diagonal, which it has on both sides, is none
    of its edges. face: (m,) the mesh face of each triangle."""
    sides = np.flatnonzero((edges.count > 2)[edges.of_side])
    key = edges.of_side[sides] * (int(face.max()) + 1) + face[sides // 3]
    _, place, times = np.unique(key, return_inverse=True, return_counts=True)
    return sides[times[place] == 1]


def _named(given: NDArray, sides: NDArray) -> NDArray[np.intp]:
    """(k, 2) the sides as vertex pairs of the input, the lower first, sorted, each once."""
    return unique_pairs(_pairs(given, sides))


def _pairs(given: NDArray, sides: NDArray) -> NDArray[np.intp]:
    """(k, 2) the sides as vertex pairs of the input, the lower first."""
    triangle, corner = sides // 3, sides % 3
    return np.sort(np.stack([given[triangle, corner], given[triangle, (corner + 1) % 3]], axis=1), axis=1)


@dataclass(frozen=True, eq=False)
class _Gaps:
    """sides: rim sides in loops without area; loop: the loop of each; number: of such loops. one, other, against: the
    links between these sides, and whether the faces there disagree."""

    sides: NDArray[np.intp]
    loop: NDArray[np.intp]
    number: int
    one: NDArray[np.intp]
    other: NDArray[np.intp]
    against: NDArray[np.bool_]


def _gaps(points: NDArray, triangles: NDArray, edges: Edges, tolerance: float) -> _Gaps:
    side = edges.rims()
    none = np.empty(0, np.intp)
    if not len(side):
        return _Gaps(none, none, 0, none, none, np.empty(0, bool))
    start, stop = _ends(triangles, side)
    begin, end = points[start].astype(np.float64), points[stop].astype(np.float64)
    links = join_sides(begin, end, start, stop, directed=False)
    loops = find_loops(begin, end, links)
    closed = loops.complete & ~loops.wide(tolerance)
    within = closed[loops.of_side]
    linked = within[links[0]]
    loop = (np.cumsum(closed) - 1)[loops.of_side]
    return _Gaps(
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


def _close(body: Mended, edges: Edges, gap: _Gaps, tolerance: float) -> tuple[NDArray[np.bool_], int, NDArray]:
    """Find the shells that cannot be closed; fill the gaps and cap the holes of the others.

    Returns (3m,) the sides that `_spikes` found to be closed, how many gaps there are, and (k,) the sides around caps.
    """
    if np.any(edges.count > 2) and body.number > 1:
        # Shells that meet in an edge are judged one by one, each with vertices of its own.
        key, own = np.unique(body.shell.repeat(3) * len(body.points) + body.triangles.ravel(), return_inverse=True)
        edges = find_edges(own.reshape(-1, 3))
    balance = edges.balance(body.turned)
    torn = np.zeros(body.number, bool)
    torn[body.shell[edges.first[(balance != 0) & (edges.count > 1)] // 3]] = True
    spikes = _spikes(body, edges, balance, torn & ~body.open, tolerance)
    body.open |= torn & ~spikes.shells
    settled = np.zeros(3 * len(body.triangles), bool)
    settled[spikes.sides] = True
    gaps = spikes.number + len(np.unique(gap.loop[~settled[gap.sides]]))

    rim = edges.rims()
    rim = rim[~body.open[body.shell[rim // 3]] & ~settled[rim]]
    loop = np.full(3 * len(body.triangles), -1)
    loop[gap.sides] = gap.loop
    loop = loop[rim]
    start, stop = _ends(body.triangles, rim)
    turned = body.turned[rim // 3]
    start, stop = np.where(turned, stop, start), np.where(turned, start, stop)
    apex = np.empty(gap.number, np.intp)
    filled = loop >= 0
    apex[loop[filled][::-1]] = start[filled][::-1]
    caps = [np.stack([stop[filled], start[filled], apex[loop[filled]]], axis=1), spikes.caps]
    owner = [rim[filled] // 3, spikes.sides // 3]
    if not filled.all():
        triangles, side = _capped(body, rim[~filled] // 3, start[~filled], stop[~filled], tolerance)
        caps.append(triangles)
        owner.append(side)
    body.counts["closed"] = not (body.open.any() or body.caps.any())
    caps, owner = np.concatenate(caps), np.concatenate(owner)
    useful = _proper(caps)
    caps, owner = caps[useful], owner[useful]
    body.triangles = np.concatenate([np.where(body.turned[:, None], body.triangles[:, ::-1], body.triangles), caps])
    body.face = np.concatenate([body.face, np.full(len(caps), -1)])
    body.turned = np.concatenate([body.turned, np.zeros(len(caps), bool)])
    body.shell = np.concatenate([body.shell, body.shell[owner]])
    return settled, gaps, rim[~filled]


@dataclass(frozen=True, eq=False)
class _Spikes:
    """shells: (number,) those that close after all. sides, caps: a side on each edge that they leave over, and the
    triangle that closes it. number: of gaps."""

    shells: NDArray[np.bool_]
    sides: NDArray[np.intp]
    caps: NDArray[np.intp]
    number: int


def _spikes(
    body: Mended, edges: Edges, balance: NDArray[np.float64], torn: NDArray[np.bool_], tolerance: float
) -> _Spikes:
    """Shells with edges of three faces or more that close nevertheless, as all that they leave over are loops without
    area: letters whose outline turns back on itself. torn: (number,) the shells to look at. balance: of the edges."""
    edge = np.flatnonzero((balance != 0) & torn[body.shell[edges.first // 3]])
    edge = np.repeat(edge, np.abs(balance[edge]).astype(np.intp))
    side = edges.first[edge]
    if not len(side):
        return _Spikes(torn, side, np.empty((0, 3), np.intp), 0)
    start, stop = _ends(body.triangles, side)
    against = edges.upward[side] != (balance[edge] > 0.0)
    start, stop = np.where(against, stop, start), np.where(against, start, stop)
    begin, end = body.points[start].astype(np.float64), body.points[stop].astype(np.float64)
    shell = body.shell[side // 3]
    meet = [shell * len(body.points) + vertex for vertex in (start, stop)]
    loops = find_loops(begin, end, join_sides(begin, end, *meet, directed=True))
    torn = torn.copy()
    torn[shell[(~loops.complete | loops.wide(tolerance))[loops.of_side]]] = False
    apex = np.empty(len(loops.perimeter), np.intp)
    apex[loops.of_side[::-1]] = start[::-1]
    caps = np.stack([stop, start, apex[loops.of_side]], axis=1)
    kept = torn[shell]
    return _Spikes(torn, side[kept], caps[kept], len(np.unique(loops.of_side[kept])))


def _capped(body: Mended, owner: NDArray, start: NDArray, stop: NDArray, tolerance: float) -> tuple[NDArray, NDArray]:
    """Cap rims, given as the vertices of their sides and the triangle that owns each. Returns the caps' triangles and
    for each one the triangle at whose side it stands."""
    begin, end = body.points[start].astype(np.float64), body.points[stop].astype(np.float64)
    shell = body.shell[owner]
    meet = [shell * len(body.points) + vertex for vertex in (start, stop)]
    loops = find_loops(begin, end, join_sides(begin, end, *meet, directed=True))
    shell_of_loop = np.empty(len(loops.perimeter), np.intp)
    shell_of_loop[loops.of_side] = shell
    body.open[shell_of_loop[~loops.complete]] = True

    hole = loops.wide(tolerance) & ~body.open[shell_of_loop]
    level = loops.height <= tolerance
    for k, part in enumerate((level, ~level, np.where(level, loops.flat, loops.cone))):
        body.caps[:, k] = np.bincount(shell_of_loop, part * hole, minlength=body.number)
    # In the points' own type: a cap's apex then carries the same coordinate error as every vertex. A cap over three
    # sides needs none.
    apex = len(body.points) + np.arange(len(loops.perimeter))
    first = np.empty(len(apex), np.intp)
    first[loops.of_side[::-1]] = start[::-1]
    apex = np.where(np.bincount(loops.of_side) == 3, first, apex)[loops.of_side]
    body.points = np.concatenate([body.points, loops.centroid.astype(body.points.dtype)])
    return np.stack([stop, start, apex], axis=1), owner
