# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The last steps of a repair: faces of each part are made to agree, gaps without area closed, and
holes capped.

Sides are numbered as in `Edges`: 3t + i runs from corner i of triangle t to the next one, the
triangles as given.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..mesh import (
    Edges,
    consistent_orientation,
    find_edges,
    group_components,
    normals,
    same_vertices_groups,
)
from ..numerics import (
    Array,
    Floats,
    Index,
    Integers,
    Mask,
    connected_components,
    hash_uint64,
    sums_by_index,
)
from ..verdict import Finding, finding
from . import boundary_loops, weld_open_parts
from .findings import (
    DUPLICATE_FACES_COUNTED,
    NON_MANIFOLD_COMPONENTS,
    ONE_SIDED_COMPONENTS,
    T_JUNCTIONS,
)
from .repaired_mesh import NO_INDICES, FoldedLoops, RepairedMesh, ZeroAreaLoops, copy_with

FLAT_RTOL = 1e-9  # Relative to the area: allowed shortfall of the sum of a flat piece's normals.
NO_LINKS = NO_INDICES, NO_INDICES


def find_t_junctions(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Find the boundary loops without area, across which the surface closes in space."""
    side = mesh.state.edges.boundary_sides()
    start, stop = boundary_loops.side_ends(mesh.triangles, side)
    begin = mesh.points[start].astype(np.float64)
    end = mesh.points[stop].astype(np.float64)
    links = boundary_loops.join_sides(begin, end, start, stop, directed=False)
    loops = boundary_loops.find_loops(begin, end, links)
    closed = loops.complete & ~loops.has_area(tolerance)
    within = closed[loops.of_side]
    linked = within[links[0]]
    gaps = ZeroAreaLoops(
        side[within],
        (np.cumsum(closed) - 1)[loops.of_side][within],
        int(np.count_nonzero(closed)),
        side[links[0][linked]],
        side[links[1][linked]],
        ~links[2][linked],
    )
    return mesh.with_state(gaps=gaps)


def orient_faces(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Find the faces of each part to turn so that all agree, and group parts into components."""
    edges = mesh.state.edges
    gaps = mesh.state.gaps
    count = len(mesh.triangles)
    pairs = edges.manifold_side_pairs()
    walls = wall_links(mesh.points, edges, mesh.triangles, mesh.face)
    first, second = (np.concatenate(sides) for sides in zip(pairs, walls))
    misoriented = edges.upward[first] == edges.upward[second]
    a = np.concatenate([first, gaps.first]) // 3
    b = np.concatenate([second, gaps.second]) // 3
    disagree = np.concatenate([misoriented, gaps.misoriented])
    area = (
        np.linalg.norm(normals(mesh.points, mesh.triangles), axis=1)
        if disagree.any()
        else np.zeros(count)
    )
    flipped, twisted = consistent_orientation(count, a, b, disagree, area)
    component, number = group_components(
        edges, *connected_components(count, a, b), _edges_along(mesh)
    )
    is_open = np.zeros(number, bool)
    is_open[component[twisted]] = True
    report = copy_with(mesh.report, components=number)
    if misoriented.any():
        sides = boundary_loops.distinct_vertex_pairs(
            mesh.state.given, np.concatenate([first[misoriented], second[misoriented]])
        )
        elements = copy_with(report.defective_elements, inconsistent_edges=sides)
        report = copy_with(
            report,
            inconsistent_edges=int(np.count_nonzero(misoriented)),
            defective_elements=elements,
        )
    return replace(
        mesh,
        findings=_without_walls(mesh, np.concatenate(walls)),
        flipped=flipped,
        component=component,
        number=number,
        open=is_open,
        caps=np.zeros((number, 3)),
        report=report,
        state=copy_with(mesh.state, one_sided=is_open),
    )


def _without_walls(mesh: RepairedMesh, sides: Integers) -> tuple[Finding, ...]:
    """Return the findings without counting copies of faces that are walls of two bodies. sides: the
    sides at walls.
    """
    walls = np.unique(mesh.face[sides // 3])
    findings = []
    for item in mesh.findings:
        if item.code.startswith(DUPLICATE_FACES_COUNTED):
            left = np.setdiff1d(np.asarray(item.elements), walls)
            item = replace(item, values={**item.values, "count": len(left)}, elements=left)
        if item.values.get("count") != 0:
            findings.append(item)
    return tuple(findings)


def find_unclosable_components(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Find the components that no caps can close, and the loops that remain at edges of three faces
    or more.
    """
    edges = mesh.state.edges
    if np.any(edges.count > 2) and mesh.number > 1:
        # Components that meet in an edge are judged one by one, each with vertices of its own.
        key = mesh.component.repeat(3) * len(mesh.points) + mesh.triangles.ravel()
        edges = find_edges(np.unique(key, return_inverse=True)[1].reshape(-1, 3))
    signed_count = edges.signed_use_count(mesh.flipped)
    unclosable = np.zeros(mesh.number, bool)
    unclosable[mesh.component[edges.first[(signed_count != 0) & (edges.count > 1)] // 3]] = True
    folded = _find_folded_loops(mesh, edges, signed_count, unclosable & ~mesh.open, tolerance)
    return replace(
        mesh,
        open=mesh.open | (unclosable & ~folded.components),
        state=copy_with(mesh.state, component_edges=edges, folded=folded),
    )


def close_gaps(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Fill the gaps without area, and report the remaining boundary."""
    edges = mesh.state.edges
    gaps = mesh.state.gaps
    folded = mesh.state.folded
    given = mesh.state.given
    closed_already = np.zeros(edges.of_side.shape, bool)
    closed_already[folded.sides] = True
    number = folded.number + len(np.unique(gaps.loop[~closed_already[gaps.sides]]))
    if number:
        sides = np.concatenate([gaps.sides, np.flatnonzero(closed_already)])
        mesh = mesh.with_findings(
            finding(T_JUNCTIONS, boundary_loops.distinct_vertex_pairs(given, sides), count=number)
        )
    boundary = edges.first[(edges.count == 1) & ~_edges_along(mesh)]
    boundary = boundary[~closed_already[boundary]]
    if len(boundary):
        mesh = mesh.with_report(
            boundary_edges=len(boundary),
            elements={"boundary_edges": boundary_loops.distinct_vertex_pairs(given, boundary)},
        )

    boundary = mesh.state.component_edges.boundary_sides()
    boundary = boundary[~mesh.open[mesh.component[boundary // 3]] & ~closed_already[boundary]]
    loop = np.full(len(closed_already), -1)
    loop[gaps.sides] = gaps.loop
    loop = loop[boundary]
    filled = loop >= 0
    start, stop = mesh.oriented_ends(boundary[filled])
    apex = np.empty(gaps.number, np.intp)
    apex[loop[filled][::-1]] = start[::-1]
    caps = np.concatenate([np.stack([stop, start, apex[loop[filled]]], axis=1), folded.caps])
    owner = np.concatenate([boundary[filled] // 3, folded.sides // 3])
    if len(caps):
        useful = boundary_loops.has_distinct_vertices(caps)
        mesh = mesh.with_caps(caps[useful], owner[useful])
    return mesh.with_state(uncapped_sides=boundary[~filled])


def cap_holes(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Cap the boundary loops that have an area, each by the cone to its centroid."""
    side = mesh.state.uncapped_sides
    if not len(side):
        return mesh
    component = mesh.component[side // 3]
    found = boundary_loops.OwnedLoops.of_sides(mesh.points, *mesh.oriented_ends(side), component)
    is_open = mesh.open.copy()
    is_open[found.owner[~found.loops.complete]] = True
    apexes, caps, under = found.cones()
    return copy_with(
        mesh,
        points=np.concatenate([mesh.points, apexes]),
        open=is_open,
        caps=found.count_caps(np.full(mesh.number, tolerance), ~is_open),
        capped_edges=boundary_loops.vertex_pairs(mesh.state.given, side),
        capped_component=component,
    ).with_caps(caps, side[under] // 3)


def turn_faces(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Turn the disagreeing faces. This changes the numbers of sides."""
    if not mesh.flipped.any():
        return mesh
    return copy_with(
        mesh, triangles=np.where(mesh.flipped[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    )


def report_closedness(mesh: RepairedMesh, tolerance: float) -> RepairedMesh:
    """Report the components that cannot be closed, with the reasons."""
    elements = mesh.report.defective_elements
    findings = []
    count = int(np.count_nonzero(mesh.state.one_sided))
    if count:
        findings.append(
            finding(
                ONE_SIDED_COMPONENTS, elements.inconsistent_edges, count=count, total=mesh.number
            )
        )
    count = int(np.count_nonzero(mesh.open)) - count
    if count:
        edges = np.concatenate([elements.non_manifold_edges, elements.boundary_edges])
        findings.append(finding(NON_MANIFOLD_COMPONENTS, edges, count=count, total=mesh.number))
    closed = not (mesh.open.any() or mesh.caps.any())
    return copy_with(
        mesh, findings=(*mesh.findings, *findings), report=copy_with(mesh.report, closed=closed)
    )


def _edges_along(mesh: RepairedMesh) -> Mask:
    """Return an (e,) mask of the edges along gaps without area."""
    edges = mesh.state.edges
    along = np.zeros(len(edges.count), bool)
    along[edges.of_side[mesh.state.gaps.sides]] = True
    return along


def _find_folded_loops(
    mesh: RepairedMesh,
    edges: Edges,
    signed_count: Array,
    unclosable: Mask,
    tolerance: float,
) -> FoldedLoops:
    """Find components (of `unclosable`) whose remaining loops have no area, such as outlines that
    turn back.
    """
    edge = np.flatnonzero((signed_count != 0) & unclosable[mesh.component[edges.first // 3]])
    edge = np.repeat(edge, np.abs(signed_count[edge]).astype(np.intp))
    side = edges.first[edge]
    if not len(side):
        return FoldedLoops(unclosable, side, np.empty((0, 3), np.intp), 0)
    start, stop = boundary_loops.side_ends(mesh.triangles, side)
    reversed_side = edges.upward[side] != (signed_count[edge] > 0.0)
    start, stop = np.where(reversed_side, stop, start), np.where(reversed_side, start, stop)
    component = mesh.component[side // 3]
    loops = boundary_loops.OwnedLoops.of_sides(mesh.points, start, stop, component).loops
    closes = unclosable.copy()
    closes[component[(~loops.complete | loops.has_area(tolerance))[loops.of_side]]] = False
    caps = np.stack([stop, start, loops.of_each(start)[loops.of_side]], axis=1)
    taken = closes[component]
    return FoldedLoops(closes, side[taken], caps[taken], len(np.unique(loops.of_side[taken])))


def wall_links(
    points: Floats,
    edges: Edges,
    triangles: Integers,
    face: Integers,
) -> tuple[Index, Index]:
    """Return (k,) and (k,) the sides that belong together at walls between bodies. face: (t,) of
    each triangle.

    If two bodies have copies of a face on the same vertices, four faces meet along its border: one
    of each body, and the two copies, the layers. Each layer belongs to one body along its whole
    border; the directions of the faces decide, if they can.
    """
    if not (edges.count == 4).any():
        return NO_LINKS
    pairs = edges.manifold_side_pairs()
    piece, _ = connected_components(len(triangles), pairs[0] // 3, pairs[1] // 3)
    layer, wall = _layers(points, edges, triangles, face, piece)
    if not layer.any():
        return NO_LINKS
    sides = np.flatnonzero((edges.count == 4)[edges.of_side])
    # Sort by edge: single faces, then the first layer, then the other.
    sides = sides[np.lexsort((layer[sides // 3], edges.of_side[sides]))].reshape(-1, 4)
    rank = layer[sides // 3]
    within = sides[(rank == [1, 1, 2, 2]).all(axis=1)]
    border = sides[(rank == [0, 0, 1, 2]).all(axis=1)]
    border = border[wall[border[:, 2] // 3] == wall[border[:, 3] // 3]]
    if not len(border):
        return NO_LINKS
    layers = _layer_links(edges, within, wall)
    part, _ = connected_components(
        len(triangles),
        np.concatenate([pairs[0] // 3, layers[:, 0] // 3]),
        np.concatenate([pairs[1] // 3, layers[:, 1] // 3]),
    )
    # A column keeps its body and its layer along the whole border.
    for columns in np.array([[0, 1], [2, 3]]):
        swap = np.diff(part[border[:, columns] // 3])[:, 0] < 0
        border[np.ix_(swap, columns)] = border[np.ix_(swap, columns[::-1])]
    # A wall is between two bodies only, the same along its border.
    wall = np.unique(part[border[:, 2:] // 3], axis=0, return_inverse=True)[1].ravel()
    lower = part[border[:, 0] // 3]
    upper = part[border[:, 1] // 3]
    first = np.empty(int(wall.max()) + 1, np.intp)
    first[wall] = np.arange(len(wall))
    one_pair = (lower == lower[first[wall]]) & (upper == upper[first[wall]]) & (lower != upper)
    decided = sums_by_index(wall, ~one_pair)[wall] == 0.0
    border, wall = border[decided], wall[decided]
    up = edges.upward[border]
    agree = (up[:, :2, None] != up[:, None, 2:]).astype(float)  # Compare each body with each layer.
    straight = agree[:, 0, 0] + agree[:, 1, 1] - agree[:, 0, 1] - agree[:, 1, 0]
    swapped = sums_by_index(wall, straight)[wall] < 0.0
    border[swapped] = border[swapped][:, [0, 1, 3, 2]]
    links = (
        np.concatenate([layers, border[:, [0, 2]], border[:, [1, 3]]])
        if len(border)
        else layers[:0]
    )
    return links[:, 0], links[:, 1]


def _layer_links(edges: Edges, within: Index, wall: Index) -> Index:
    """Return the (k, 2) sides that are joined within walls.

    The order of a face's copies is accidental: each copy is joined to the neighbor with which it
    agrees. within: (e, 4) sides on edges between two faces of a wall, by layers; wall: (t,) as of
    `_layers`.
    """
    crossed = wall[within[:, 1] // 3] != wall[within[:, 3] // 3]
    # Corners of one face, then the other, twice.
    within = np.where(crossed[:, None], within[:, [0, 1, 3, 2]], within)
    up = edges.upward[within]
    straight = (up[:, 0] != up[:, 1]).astype(int) + (up[:, 2] != up[:, 3])
    across = (up[:, 0] != up[:, 3]).astype(int) + (up[:, 2] != up[:, 1])
    within = np.where((across > straight)[:, None], within[:, [0, 3, 2, 1]], within)
    return np.concatenate([within[:, :2], within[:, 2:]])


def _layers(
    points: Floats,
    edges: Edges,
    triangles: Integers,
    face: Integers,
    piece: Index,
) -> tuple[Index, Index]:
    """Return (t,) layers, 1 and 2 for triangles of walls, else 0; and (t,) numbers of the walls.

    Layers are faces on the same vertices, or flat pieces with the same border that are cut into
    triangles differently. piece: (t,) the piece of each triangle, connected across edges of two
    faces.
    """
    group = same_vertices_groups(triangles, face)
    layer = weld_open_parts.is_duplicated(group, face).astype(np.intp) + (group != face)
    vector = normals(points, triangles)
    number = int(piece.max()) + 1
    total = np.stack([np.bincount(piece, vector[:, k], number) for k in range(3)], axis=1)
    area = np.bincount(piece, np.linalg.norm(vector, axis=1), number)
    flat = np.linalg.norm(total, axis=1) >= (1.0 - FLAT_RTOL) * area
    crowded = np.flatnonzero((edges.count > 2)[edges.of_side])
    border = np.zeros(number, np.uint64)
    np.add.at(border, piece[crowded // 3], hash_uint64(edges.of_side[crowded].astype(np.uint64)))
    candidate = np.flatnonzero(flat & (np.bincount(piece, layer > 0, number) == 0) & (border != 0))
    _, kind, times = np.unique(border[candidate], return_inverse=True, return_counts=True)
    candidate = candidate[times[kind] == 2]
    kind = kind[times[kind] == 2]
    order = np.argsort(kind).reshape(-1, 2)
    first = candidate[order[:, 0]]
    other = candidate[order[:, 1]]
    piece_layer = np.zeros(number, np.intp)
    partner = np.arange(number)
    piece_layer[first], piece_layer[other], partner[other] = 1, 2, first
    by_piece = piece_layer[piece] > 0
    return np.where(by_piece, piece_layer[piece], layer), np.where(
        by_piece, int(face.max()) + 1 + partner[piece], group
    )
