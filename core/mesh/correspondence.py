# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Correspondences of two meshes: the similarities that lay one onto the other, and the elements
that meet.

The images of two vertices and the handedness fix a similarity. Two vertices of one mesh that few
others resemble are paired with all similar vertices of the other mesh, so that every symmetry is
found. Each candidate is proven on all vertices, edges and faces, which may be numbered in any
order.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..numerics import Array, Index, NDArray

# hardly any mesh has points that coincide along this direction
DIRECTION = np.array([0.7071, 0.5477, 0.4472])
MAX_CANDIDATES = 500  # similarities that are compared in full
PROBES = 6  # vertices that are compared first
# The scores of equal vertices differ by at most so many tolerances: a distance from the middle,
# 0.618 of a mean length and 1.32 of a product change by under 5, and middle and radius move, too.
RESEMBLANCE = 20.0


class Elements:
    """A mesh: (n, 3) points, (e, 2) edges, (c,) vertices of the corners, (f + 1,) first corners of
    the faces.

    unit_points: the points about their middle, in units of the radius. scores: (n,) numbers that no
    similarity changes.
    """

    def __init__(self, points: Array, edges: Index, corners: Index, starts: Index):
        self.points = points
        self.edges = edges
        self.corners = corners
        self.starts = starts
        self.sizes = np.diff(starts)
        self.middle = points.mean(axis=0) if len(points) else np.zeros(3)
        self.radius = float(np.linalg.norm(points - self.middle, axis=1).max(initial=0.0))
        self.unit_points = (points - self.middle) / (self.radius or 1.0)
        lengths = np.linalg.norm(
            self.unit_points[edges[:, 0]] - self.unit_points[edges[:, 1]], axis=1
        )
        valence = np.bincount(edges.ravel(), minlength=len(points))
        mean = np.bincount(edges.ravel(), lengths.repeat(2), len(points)) / np.maximum(valence, 1)
        # Valences differ by more than the other terms can: 1, and 0.618 of at most 2.
        self.scores = np.linalg.norm(self.unit_points, axis=1) + 0.618 * mean + 4.0 * valence


@dataclass(frozen=True, eq=False)
class Correspondence:
    """The similarity p → linear · p + offset that lays one mesh onto another, and the elements that
    meet.

    vertices, edges, faces, corners: the other mesh's index for each element.
    """

    linear: Array
    offset: Array
    vertices: Index
    edges: Index
    faces: Index
    corners: Index

    @property
    def is_still(self) -> bool:
        """True if the similarity is the identity."""
        return bool((self.linear == np.eye(3)).all() and not self.offset.any())

    @property
    def is_ordered(self) -> bool:
        """True if vertices and corners have the same numbers in both meshes."""
        return all(
            (indices == np.arange(len(indices))).all() for indices in (self.vertices, self.corners)
        )


def correspondences(
    first: Elements,
    second: Elements,
    tolerance: float,
    labels: tuple[NDArray, NDArray] | None = None,
) -> Iterator[Correspondence]:
    """Yield the correspondences of two meshes with equal counts; tolerance: relative to the second
    mesh's radius.

    labels: (n,) numbers, the same for equal vertices. The correspondence that keeps the numbers of
    all vertices comes first, if there is one; then come those that turn least.
    """
    count = len(first.points)
    loose = 4.0 * tolerance  # chosen for candidates, of which `_prove` asks for the tolerance
    if not count or not first.radius or not second.radius:
        return
    if not np.array_equal(np.sort(first.sizes), np.sort(second.sizes)):
        return
    scores = [mesh.scores + label for mesh, label in zip((first, second), labels or (0.0, 0.0))]
    if np.abs(np.sort(scores[0]) - np.sort(scores[1])).max() > RESEMBLANCE * loose:
        return
    same = np.arange(count)  # the correspondences that keep all numbers
    for mirrored in (False, True):
        if correspondence := _prove(first, second, same, same, mirrored, tolerance):
            yield correspondence
    targets = second.unit_points
    second_places = _first_near(targets, targets, loose)
    for turn in _candidate_turns(first.unit_points, targets, scores, loose):
        first_places = _first_near(first.unit_points @ turn.T, targets, loose)
        mirrored = bool(np.linalg.det(turn) < 0.0)
        if correspondence := _prove(
            first, second, first_places, second_places, mirrored, tolerance
        ):
            yield correspondence


def _first_near(points: NDArray, targets: NDArray, tolerance: float) -> Index:
    """Return for each of (n, 3) points the first of the (m, 3) targets within the tolerance, or
    m.
    """
    along = targets @ DIRECTION
    places = points @ DIRECTION
    reach = 2.0 * tolerance
    order = np.argsort(along, kind="stable")
    low = np.searchsorted(along[order], places - reach)
    high = np.searchsorted(along[order], places + reach, side="right")
    first = np.full(len(points), len(targets))
    for k in range((high - low).max()):
        rows = np.flatnonzero(low + k < high)
        target = order[low[rows] + k]
        is_near = np.abs(points[rows] - targets[target]).max(axis=1) <= tolerance
        first[rows[is_near]] = np.minimum(first[rows[is_near]], target[is_near])
    return first


def _candidate_turns(
    points: NDArray, targets: NDArray, scores: list[NDArray], tolerance: float
) -> Iterator[Array]:
    """Yield orthogonal (3, 3) maps that may lay points onto targets with the same scores: turns
    first, least first.
    """
    near = RESEMBLANCE * tolerance
    pair = _anchors(points, scores[0], near)
    if pair is None:
        return
    a, b = points[list(pair)]
    frame = _frames(a[None], b[None])[0]
    like_a, like_b = (np.abs(scores[1] - scores[0][anchor]) <= near for anchor in pair)
    turns = [np.empty((0, 3, 3))]
    for image in targets[like_a]:
        other_images = targets[like_b & (np.abs(targets @ image - a @ b) <= near)]
        frames = _frames(np.broadcast_to(image, other_images.shape), other_images)
        turns += [(frames * (1.0, 1.0, hand)) @ frame.T for hand in (1.0, -1.0)]
    maps = np.concatenate(turns)
    # Of PROBES vertices, spread over the scores, each must come to lie on a similar one.
    for probe in np.argsort(scores[0])[:: -(-len(targets) // PROBES)]:
        ends = targets[np.abs(scores[1] - scores[0][probe]) <= near]
        is_met = [
            np.abs(ends - image).max(axis=1).min(initial=np.inf) <= near
            for image in maps @ points[probe]
        ]
        maps = maps[np.array(is_met, bool)]
    order = np.lexsort((-np.trace(maps, axis1=1, axis2=2), np.linalg.det(maps) < 0.0))
    yield from maps[order[:MAX_CANDIDATES]]


def _anchors(points: NDArray, scores: NDArray, near: float) -> tuple[int, int] | None:
    """Return two vertices that as few others as possible resemble, not in line with the middle;
    None if all are in line. Both fix directions well: they are 0.3 of the radius from the middle
    and 0.1 from the line, if they can be.
    """

    def count_alike(scores: NDArray) -> Index:
        """Return (n,) the numbers of vertices with a score near to each one's."""
        ordered = np.sort(scores)
        stops = np.searchsorted(ordered, scores + near, side="right")
        return stops - np.searchsorted(ordered, scores - near)

    too_many = len(points) + 1
    distance = np.linalg.norm(points, axis=1)
    first = int(np.where(distance >= 0.3, count_alike(scores), too_many).argmin())
    from_line = np.linalg.norm(np.cross(points, points[first]), axis=1)
    if from_line.max() <= near:
        return None
    counts = count_alike(scores + 1.32 * (points @ points[first]))
    is_apart = from_line >= min(0.1, from_line.max())
    return first, int(np.where(is_apart, counts, too_many).argmin())


def _frames(first: NDArray, second: NDArray) -> Array:
    """Return (k, 3, 3) right-handed frames, as columns: x along `first`, `second` in the plane of x
    and y.
    """
    x = first / np.linalg.norm(first, axis=1, keepdims=True)
    z = np.cross(x, second)
    z /= np.maximum(np.linalg.norm(z, axis=1, keepdims=True), np.finfo(float).tiny)
    return np.stack([x, np.cross(z, x), z], axis=2)


def _prove(
    first: Elements,
    second: Elements,
    first_places: Index,
    second_places: Index,
    mirrored: bool,
    tolerance: float,
) -> Correspondence | None:
    """Return the correspondence of two meshes; None if points, edges or faces do not meet.

    first_places, second_places: (n,) numbers of the vertices' places, equal if vertices meet.
    mirrored: True if the similarity mirrors. tolerance: relative to the second mesh's radius.
    """
    matched_faces = _match_faces(first, second, first_places, second_places, mirrored)
    if matched_faces is None:
        return None
    faces, corners = matched_faces
    vertices = np.full(len(first.points), -1)
    vertices[first.corners] = second.corners[corners]
    if not np.array_equal(vertices[first.corners], second.corners[corners]):
        return None
    # Vertices without faces are matched by their places, with those of the second mesh.
    unmatched = np.flatnonzero(vertices < 0)
    is_free = np.ones(len(vertices), bool)
    is_free[vertices[vertices >= 0]] = False
    free = np.flatnonzero(is_free)
    if len(unmatched) != len(free):
        return None
    order = np.argsort(first_places[unmatched], kind="stable")
    free_order = np.argsort(second_places[free], kind="stable")
    vertices[unmatched[order]] = free[free_order]
    edges = _match_rows(np.sort(vertices[first.edges], axis=1), np.sort(second.edges, axis=1))
    if edges is None:
        return None
    limit = tolerance * second.radius
    similarity = _simplest_similarity(first.points, second.points[vertices], mirrored, limit)
    if similarity is None:
        return None
    correspondence = Correspondence(*similarity, vertices, edges, faces, corners)
    return correspondence if _triangulates_alike(first, second, correspondence, limit) else None


def _simplest_similarity(
    points: NDArray, images: NDArray, mirrored: bool, limit: float
) -> tuple[NDArray, NDArray] | None:
    """Return the map and offset that bring (n, 3) points to their images: of maps that are equally
    good up to rounding, the one that changes least. None if a point misses by over `limit`.
    """
    linear, offset = _similarity(points, images, mirrored)
    error = np.linalg.norm(points @ linear.T + offset - images, axis=1).max()
    if error > limit:
        return None
    # Two maps that miss by twice as much, or by a few roundings of float32, are equally good.
    rounding = 4.0 * np.finfo(np.float32).eps * max(np.abs(points).max(), np.abs(images).max())
    allowed = min(2.0 * error + rounding, limit)
    shifts = [] if mirrored else [np.zeros(3), images.mean(axis=0) - points.mean(axis=0)]
    for shift in shifts:
        if np.linalg.norm(points + shift - images, axis=1).max() <= allowed:
            return np.eye(3), shift
    return linear, offset


def _similarity(source: NDArray, target: NDArray, mirrored: bool) -> tuple[NDArray, NDArray]:
    """Return map and offset of the similarity, of this handedness, that moves (n, 3) points nearest
    to (n, 3) others: least squares by Kabsch's method, scaled by the ratio of the radii of
    gyration.
    """
    middle = source.mean(axis=0)
    other = target.mean(axis=0)
    a, b = source - middle, target - other
    u, _, vt = np.linalg.svd(b.T @ a)
    hand = (-1.0 if mirrored else 1.0) * np.sign(np.linalg.det(u @ vt))
    linear = np.sqrt((b * b).sum() / (a * a).sum()) * ((u * (1.0, 1.0, hand)) @ vt)
    return linear, other - linear @ middle


def _match_faces(
    first: Elements, second: Elements, first_places: Index, second_places: Index, mirrored: bool
) -> tuple[Index, Index] | None:
    """Return the second mesh's face and corner for each of the first's; of a mirror image, corners
    run backward.
    """
    faces = np.empty(len(first.sizes), np.intp)
    corners = np.empty(len(first.corners), np.intp)
    for size in np.unique(first.sizes):
        first_faces, second_faces = (np.flatnonzero(mesh.sizes == size) for mesh in (first, second))
        steps = np.arange(size)
        turned = -steps % size if mirrored else steps
        keys, first_corners = _from_least(first_places, first, first_faces, turned)
        other_keys, second_corners = _from_least(second_places, second, second_faces, steps)
        order = _match_rows(keys, other_keys)
        if order is None:
            return None
        faces[first_faces] = second_faces[order]
        corners[first_corners] = second_corners[order]
    return faces, corners


def _from_least(places: Index, mesh: Elements, faces: Index, steps: Index) -> tuple[Index, Index]:
    """Return the (k, s) places and corners of k faces of s corners, each row turned so that it
    begins with its least place. steps: the order in which the corners are taken.
    """
    corners = mesh.starts[faces][:, None] + steps
    keys = places[mesh.corners[corners]]
    turned = (keys.argmin(axis=1)[:, None] + np.arange(len(steps))) % len(steps)
    return np.take_along_axis(keys, turned, axis=1), np.take_along_axis(corners, turned, axis=1)


def _match_rows(rows: Index, others: Index) -> Index | None:
    """Return the index in `others` of each row, or None if the rows are not the same."""
    order = np.lexsort(rows.T[::-1])
    other_order = np.lexsort(others.T[::-1])
    if not np.array_equal(rows[order], others[other_order]):
        return None
    matches = np.empty(len(rows), np.intp)
    matches[order] = other_order
    return matches


def _triangulates_alike(
    first: Elements, second: Elements, correspondence: Correspondence, limit: float
) -> bool:
    """Return whether faces that begin at another corner, and so may have other triangles, are
    flat.
    """
    begins = second.starts[correspondence.faces]
    turned = (first.sizes > 3) & (correspondence.corners[first.starts[:-1]] != begins)
    for size in np.unique(first.sizes[turned]):
        rows = np.flatnonzero(turned & (first.sizes == size))
        places = second.points[second.corners[begins[rows][:, None] + np.arange(size)]]
        places = places - places.mean(axis=1, keepdims=True)
        normals = np.linalg.svd(places, full_matrices=False)[2][:, 2]
        if np.abs(np.einsum("fsi,fi->fs", places, normals)).max() > limit:
            return False
    return True
