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


def find_t_junctions(mesh: RepairedMesh) -> RepairedMesh:
    """Find the boundary loops without area, across which the surface closes in space."""
    side = mesh.state.edges.boundary_sides()
    start, stop = boundary_loops.side_ends(mesh.triangles, side)
    begin = mesh.points[start].astype(np.float64)
    end = mesh.points[stop].astype(np.float64)
    links = boundary_loops.join_sides(begin, end, start, stop, directed=False)
    loops = boundary_loops.find_loops(begin, end, links)
    is_gap = loops.complete & ~loops.has_area(mesh.state.tolerance)
    at_gap = is_gap[loops.of_side]
    left, right, follows = links
    in_gap = at_gap[left]
    gaps = ZeroAreaLoops(
        sides=side[at_gap],
        loop=(np.cumsum(is_gap) - 1)[loops.of_side][at_gap],
        number=int(np.count_nonzero(is_gap)),
        first=side[left[in_gap]],
        second=side[right[in_gap]],
        misoriented=~follows[in_gap],
    )
    return mesh.with_state(gaps=gaps)


def orient_faces(mesh: RepairedMesh) -> RepairedMesh:
    """Find the faces of each part to turn so that all agree, and group parts into components."""
    edges = mesh.state.edges
    gaps = mesh.state.gaps
    count = len(mesh.triangles)
    pairs = edges.manifold_side_pairs()
    walls = wall_links(mesh.points, edges, mesh.triangles, mesh.face)
    first, second = (np.concatenate(sides) for sides in zip(pairs, walls))
    misoriented = edges.upward[first] == edges.upward[second]
    # Triangles that are joined: across an edge, at a wall, or across a gap.
    left = np.concatenate([first, gaps.first]) // 3
    right = np.concatenate([second, gaps.second]) // 3
    disagree = np.concatenate([misoriented, gaps.misoriented])
    area = np.zeros(count)
    if disagree.any():  # only then areas decide
        area = np.linalg.norm(normals(mesh.points, mesh.triangles), axis=1)
    flipped, twisted = consistent_orientation(count, left, right, disagree, area)
    component, number = group_components(
        edges, *connected_components(count, left, right), _edges_along(mesh)
    )
    is_one_sided = np.zeros(number, bool)
    is_one_sided[component[twisted]] = True
    findings = _without_walls(mesh, np.concatenate(walls))
    mesh = mesh.with_report(components=number)
    if misoriented.any():
        sides = np.concatenate([first[misoriented], second[misoriented]])
        inconsistent = boundary_loops.distinct_vertex_pairs(mesh.state.given, sides)
        mesh = mesh.with_report(
            inconsistent_edges=int(np.count_nonzero(misoriented)),
            elements={"inconsistent_edges": inconsistent},
        )
    return copy_with(
        mesh,
        findings=findings,
        flipped=flipped,
        component=component,
        number=number,
        open=is_one_sided,
        caps=np.zeros((number, 3)),
    ).with_state(one_sided=is_one_sided)


def _without_walls(mesh: RepairedMesh, sides: Integers) -> tuple[Finding, ...]:
    """Return the findings without the copies of faces that are walls of two bodies; a finding about
    these alone is left out. sides: the sides at walls.
    """
    walls = np.unique(mesh.face[sides // 3])
    findings = []
    for item in mesh.findings:
        if item.code == DUPLICATE_FACES_COUNTED:
            copies = np.setdiff1d(np.asarray(item.elements), walls)
            item = replace(item, values={**item.values, "count": len(copies)}, elements=copies)
        if item.values.get("count") != 0:
            findings.append(item)
    return tuple(findings)


def find_unclosable_components(mesh: RepairedMesh) -> RepairedMesh:
    """Find the components that no caps can close, and the loops that remain at edges of three faces
    or more.
    """
    edges = mesh.state.edges
    if np.any(edges.count > 2) and mesh.number > 1:
        # Components that meet in an edge are judged one by one, each with vertices of its own.
        key = mesh.component.repeat(3) * len(mesh.points) + mesh.triangles.ravel()
        edges = find_edges(np.unique(key, return_inverse=True)[1].reshape(-1, 3))
    signed_count = edges.signed_use_count(mesh.flipped)
    # Caps stand on edges of one face only; edges of several that do not cancel stay open.
    is_unbalanced = (signed_count != 0) & (edges.count > 1)
    unclosable = np.zeros(mesh.number, bool)
    unclosable[mesh.component[edges.first[is_unbalanced] // 3]] = True
    folded = _find_folded_loops(mesh, edges, signed_count, unclosable & ~mesh.open)
    is_open = mesh.open | (unclosable & ~folded.components)
    return copy_with(mesh, open=is_open).with_state(component_edges=edges, folded=folded)


def close_gaps(mesh: RepairedMesh) -> RepairedMesh:
    """Fill the gaps without area, and report the remaining boundary."""
    edges = mesh.state.edges
    gaps = mesh.state.gaps
    folded = mesh.state.folded
    is_folded = np.zeros(edges.of_side.shape, bool)
    is_folded[folded.sides] = True
    mesh = _report_boundary(mesh, is_folded)

    boundary = mesh.state.component_edges.boundary_sides()
    boundary = boundary[~mesh.open[mesh.component[boundary // 3]] & ~is_folded[boundary]]
    gap_of_side = np.full(len(is_folded), -1)
    gap_of_side[gaps.sides] = gaps.loop
    loop = gap_of_side[boundary]
    is_gap = loop >= 0
    start, stop = mesh.oriented_ends(boundary[is_gap])
    apex = np.empty(gaps.number, np.intp)
    apex[loop[is_gap][::-1]] = start[::-1]  # the last write wins: the loop's first side
    caps = np.concatenate([np.stack([stop, start, apex[loop[is_gap]]], axis=1), folded.caps])
    owner = np.concatenate([boundary[is_gap] // 3, folded.sides // 3])
    if len(caps):
        useful = boundary_loops.has_distinct_vertices(caps)
        mesh = mesh.with_caps(caps[useful], owner[useful])
    return mesh.with_state(uncapped_sides=boundary[~is_gap])


def _report_boundary(mesh: RepairedMesh, is_folded: Mask) -> RepairedMesh:
    """Report the gaps without area, and the other boundary edges. is_folded: (3t,) mask of the
    sides of folded loops.
    """
    edges = mesh.state.edges
    gaps = mesh.state.gaps
    given = mesh.state.given
    open_gaps = np.unique(gaps.loop[~is_folded[gaps.sides]])
    gap_count = mesh.state.folded.number + len(open_gaps)
    if gap_count:
        sides = np.concatenate([gaps.sides, np.flatnonzero(is_folded)])
        mesh = mesh.with_findings(
            finding(
                T_JUNCTIONS, boundary_loops.distinct_vertex_pairs(given, sides), count=gap_count
            )
        )
    boundary = edges.first[(edges.count == 1) & ~_edges_along(mesh)]
    boundary = boundary[~is_folded[boundary]]
    if not len(boundary):
        return mesh
    pairs = boundary_loops.distinct_vertex_pairs(given, boundary)
    return mesh.with_report(boundary_edges=len(boundary), elements={"boundary_edges": pairs})


def cap_holes(mesh: RepairedMesh) -> RepairedMesh:
    """Cap the boundary loops that have an area, each by the cone to its centroid."""
    side = mesh.state.uncapped_sides
    if not len(side):
        return mesh
    component = mesh.component[side // 3]
    holes = boundary_loops.OwnedLoops.of_sides(mesh.points, *mesh.oriented_ends(side), component)
    is_open = mesh.open.copy()
    is_open[holes.owner[~holes.loops.complete]] = True
    apexes, caps, kept = holes.cones()
    return copy_with(
        mesh,
        points=np.concatenate([mesh.points, apexes]),
        open=is_open,
        caps=holes.count_caps(np.full(mesh.number, mesh.state.tolerance), ~is_open),
        capped_edges=boundary_loops.vertex_pairs(mesh.state.given, side),
        capped_component=component,
    ).with_caps(caps, side[kept] // 3)


def turn_faces(mesh: RepairedMesh) -> RepairedMesh:
    """Turn the disagreeing faces. This changes the numbers of sides."""
    if not mesh.flipped.any():
        return mesh
    return copy_with(
        mesh, triangles=np.where(mesh.flipped[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    )


def report_closedness(mesh: RepairedMesh) -> RepairedMesh:
    """Report the components that cannot be closed, with the reasons."""
    elements = mesh.report.defective_elements
    closed = not (mesh.open.any() or mesh.caps.any())
    one_sided_count = int(np.count_nonzero(mesh.state.one_sided))
    open_count = int(np.count_nonzero(mesh.open)) - one_sided_count
    if one_sided_count:
        mesh = mesh.with_findings(
            finding(
                ONE_SIDED_COMPONENTS,
                elements.inconsistent_edges,
                count=one_sided_count,
                total=mesh.number,
            )
        )
    if open_count:
        edges = np.concatenate([elements.non_manifold_edges, elements.boundary_edges])
        mesh = mesh.with_findings(
            finding(NON_MANIFOLD_COMPONENTS, edges, count=open_count, total=mesh.number)
        )
    return mesh.with_report(closed=closed)


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
) -> FoldedLoops:
    """Return the components, among the `unclosable`, (c,), with remaining loops that all lack area,
    such as outlines that turn back; and these loops.

    signed_count: (e,) upward minus downward sides of each edge.
    """
    edge = np.flatnonzero((signed_count != 0) & unclosable[mesh.component[edges.first // 3]])
    edge = np.repeat(edge, np.abs(signed_count[edge]).astype(np.intp))
    side = edges.first[edge]
    if not len(side):
        return FoldedLoops(unclosable, side, np.empty((0, 3), np.intp), 0)
    start, stop = boundary_loops.side_ends(mesh.triangles, side)
    # If an edge has more upward sides than downward ones, upward copies of it remain, else
    # downward.
    reversed_side = edges.upward[side] != (signed_count[edge] > 0.0)
    start, stop = np.where(reversed_side, stop, start), np.where(reversed_side, start, stop)
    component = mesh.component[side // 3]
    loops = boundary_loops.OwnedLoops.of_sides(mesh.points, start, stop, component).loops
    is_hole = ~loops.complete | loops.has_area(mesh.state.tolerance)
    closes = unclosable.copy()
    closes[component[is_hole[loops.of_side]]] = False
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
    # (e, 4) sides of each edge: single faces, then the first layer, then the other.
    sides = sides[np.lexsort((layer[sides // 3], edges.of_side[sides]))].reshape(-1, 4)
    layers_at_edge = layer[sides // 3]
    within = sides[(layers_at_edge == [1, 1, 2, 2]).all(axis=1)]
    border = sides[(layers_at_edge == [0, 0, 1, 2]).all(axis=1)]
    border = border[wall[border[:, 2] // 3] == wall[border[:, 3] // 3]]
    if not len(border):
        return NO_LINKS
    layers = _layer_links(edges, within, wall)
    part, _ = connected_components(
        len(triangles),
        np.concatenate([pairs[0] // 3, layers[:, 0] // 3]),
        np.concatenate([pairs[1] // 3, layers[:, 1] // 3]),
    )
    border = _bodies_beside_layers(edges, border, part)
    links = np.concatenate([layers, border[:, [0, 2]], border[:, [1, 3]]])
    # Layers that no border joins to a body stay apart.
    return (links[:, 0], links[:, 1]) if len(border) else NO_LINKS


def _bodies_beside_layers(edges: Edges, border: Index, part: Index) -> Index:
    """Return the (b, 4) sides at the borders of walls whose layers are decided: the first body and
    the other, the first body's layer and the other's.

    border: (k, 4) sides: the bodies in columns 0 and 1, the layers in 2 and 3, both in any order;
    overwritten. part: (t,) connected parts.
    """
    # A column keeps its body and its layer along the whole border.
    for columns in np.array([[0, 1], [2, 3]]):
        swap = np.diff(part[border[:, columns] // 3])[:, 0] < 0
        border[np.ix_(swap, columns)] = border[np.ix_(swap, columns[::-1])]
    # A wall is between two bodies only, the same along its border.
    wall = np.unique(part[border[:, 2:] // 3], axis=0, return_inverse=True)[1].ravel()
    lower = part[border[:, 0] // 3]
    upper = part[border[:, 1] // 3]
    any_row = np.empty(int(wall.max()) + 1, np.intp)
    any_row[wall] = np.arange(len(wall))
    row = any_row[wall]
    is_one_pair = (lower == lower[row]) & (upper == upper[row]) & (lower != upper)
    is_decided = sums_by_index(wall, ~is_one_pair)[wall] == 0.0
    border, wall = border[is_decided], wall[is_decided]
    up = edges.upward[border]
    agrees = (up[:, :2, None] != up[:, None, 2:]).astype(float)  # each body with each layer
    # Edges for the first body with the first layer, less those for the first body with the other.
    straight = agrees[:, 0, 0] + agrees[:, 1, 1] - agrees[:, 0, 1] - agrees[:, 1, 0]
    swap = sums_by_index(wall, straight)[wall] < 0.0
    border[swap] = border[swap][:, [0, 1, 3, 2]]
    return border


def _layer_links(edges: Edges, within: Index, wall: Index) -> Index:
    """Return the (k, 2) sides that are joined within walls.

    The order of a face's copies is accidental: each copy is joined to the neighbor with which it
    agrees. within: (e, 4) sides on edges between two faces of a wall, by layers; wall: (t,) as of
    `_layers`.
    """
    # Columns: the first layer of both faces of the wall, then the other layer, faces in one order.
    crossed = wall[within[:, 1] // 3] != wall[within[:, 3] // 3]
    within = np.where(crossed[:, None], within[:, [0, 1, 3, 2]], within)
    up = edges.upward[within]
    straight_agrees = (up[:, 0] != up[:, 1]).astype(int) + (up[:, 2] != up[:, 3])
    across_agrees = (up[:, 0] != up[:, 3]).astype(int) + (up[:, 2] != up[:, 1])
    is_across = across_agrees > straight_agrees
    within = np.where(is_across[:, None], within[:, [0, 3, 2, 1]], within)
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
    # 0 for faces without copies, 1 for the first face of a group, 2 for its copies.
    layer = weld_open_parts.is_duplicated(group, face).astype(np.intp) + (group != face)
    vector = normals(points, triangles)
    number = int(piece.max()) + 1
    total = np.stack([np.bincount(piece, vector[:, k], number) for k in range(3)], axis=1)
    area = np.bincount(piece, np.linalg.norm(vector, axis=1), number)
    is_flat = np.linalg.norm(total, axis=1) >= (1.0 - FLAT_RTOL) * area
    has_no_layer = np.bincount(piece, layer > 0, number) == 0
    # Pieces with the same edges of three faces or more have the same sum of hashes.
    crowded = np.flatnonzero((edges.count > 2)[edges.of_side])
    border = np.zeros(number, np.uint64)
    np.add.at(border, piece[crowded // 3], hash_uint64(edges.of_side[crowded].astype(np.uint64)))
    candidates = np.flatnonzero(is_flat & has_no_layer & (border != 0))
    _, key, counts = np.unique(border[candidates], return_inverse=True, return_counts=True)
    is_pair = counts[key] == 2
    candidates, key = candidates[is_pair], key[is_pair]
    first, second = candidates[np.argsort(key).reshape(-1, 2)].T
    piece_layer = np.zeros(number, np.intp)
    partner = np.arange(number)
    piece_layer[first] = 1
    piece_layer[second] = 2
    partner[second] = first
    by_piece = piece_layer[piece] > 0
    # Walls of copied faces have the number of the first face; walls of pieces come after these.
    piece_wall = int(face.max()) + 1 + partner[piece]
    return np.where(by_piece, piece_layer[piece], layer), np.where(by_piece, piece_wall, group)
