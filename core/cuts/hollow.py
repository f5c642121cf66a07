# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The space that a liquid fills in a vessel: a cavity, the hollow of a cup with thick walls, or a
single surface that is closed at its rim.

As a level rises along a surface, the parts of the surface below it appear at its lowest points, and
join at passes, the lower part absorbing the higher one. A part whose lowest point has air above it
bounds air: a hollow. It spills where it joins a part whose lowest point has air below it, or where
it reaches an open edge. Vertices follow their lowest neighbors to the lowest points; only the
links between their regions are then joined in order of height.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..inertia import frame_about
from ..mesh import first_at_equal_position, uncancelled_sides
from ..moments import Moments, U
from ..moments.raw import TINY
from ..numerics import (
    Array,
    ArrayLike,
    Index,
    Integers,
    Mask,
    connected_components,
    first_occurrence,
    float_array,
    index_array,
    lengths,
    run_starts,
    unit_vector,
)
from ..verdict import MeasureError
from .findings import LEVEL_UNAVAILABLE, LIQUID_ABSENT, NO_HOLLOW, VESSEL_OVERFLOWS
from .part_below import PartBelow, measure_below

MAX_CANDIDATES = 6  # deepest hollows whose volumes are compared
# A sheet may face either way; hollows that it has only if it is turned must be so much larger.
TURNED_SHARE = 10.0
MAX_STEPS = 100  # steps of the search for a level; bisection alone takes 60
DIRECTIONS = 24  # in which a vessel is tilted: the corners of a box among them
TILT_ROUNDS = 24
TILT_RTOL = 1e-4


@dataclass(frozen=True, eq=False)
class Hollow:
    """The space of a vessel that a liquid fills.

    Attributes
    ----------
    points : (n, 3) array
    triangles : (m, 3) array of int
        The walls, facing away from the liquid; at an open top more than what it wets.
    up : (3,) array
        Unit vector against gravity.
    bottom, spill : float
        Heights along `up` of the lowest point, and of the level at which the liquid runs over (of
        the highest point of a cavity).
    sealed : bool
        True for a cavity.
    """

    points: Array
    triangles: Integers
    up: Array
    bottom: float
    spill: float
    sealed: bool

    def below(self, levels: ArrayLike) -> PartBelow:
        """Return the liquids below k levels, at most `spill`, and their surfaces."""
        levels = np.minimum(float_array("levels", levels, "k"), self.spill)
        normals = np.broadcast_to(self.up, (len(levels), 3))
        return measure_below(self.points, self.triangles, normals, levels)

    @cached_property
    def capacity(self) -> float:
        """The volume at which it is full."""
        return float(self.below([self.spill]).volume[0])

    def contents(self, level: float) -> PartBelow:
        """Return the liquid up to a level; MeasureError if there is none, or it runs over.

        A cavity cannot run over: a level above it stands for a full one.
        """
        if level <= self.bottom:
            raise MeasureError(LEVEL_UNAVAILABLE, fault=LIQUID_ABSENT)
        if level > self.spill + 4.0 * U * abs(self.spill) and not self.sealed:
            self._overflow()
        liquid = self.below([level])
        if not liquid.volume[0] > 0.0:
            raise MeasureError(LEVEL_UNAVAILABLE, fault=LIQUID_ABSENT)
        return liquid

    def free_surface(self, liquid: PartBelow, level: float) -> Moments | None:
        """Return the surface of the liquid up to a level; None if it fills a cavity."""
        face = liquid.face.at(0)
        is_full = self.sealed and level >= self.spill
        return None if is_full or face.total <= face.rounding_error[0] else face

    def level_of(self, volume: float) -> float:
        """Return the level of a volume of liquid; MeasureError if it runs over."""
        if not volume > 0.0:
            raise MeasureError(LEVEL_UNAVAILABLE, fault=LIQUID_ABSENT)
        if volume > self.capacity * (1.0 + 1e-12):
            self._overflow()
        low, high = self.bottom, self.spill
        level = low + (high - low) * volume / self.capacity
        for _ in range(MAX_STEPS):
            liquid = self.below([level])
            excess = float(liquid.volume[0]) - volume
            low, high = (low, level) if excess > 0.0 else (level, high)
            # Newton's step, or half of the interval if that leaves it.
            area = float(liquid.face_area[0])
            next_level = level - excess / area if area > 0.0 else high
            if not low < next_level < high:
                next_level = (low + high) / 2.0
            if abs(next_level - level) <= 2.0 * U * max(abs(self.bottom), abs(self.spill)):
                break
            level = next_level
        return level

    def _overflow(self) -> None:
        """Raise MeasureError: the liquid runs over."""
        raise MeasureError(VESSEL_OVERFLOWS, capacity=self.capacity, level=self.spill)


def find_hollow(points: ArrayLike, triangles: ArrayLike, up: ArrayLike = (0.0, 0.0, 1.0)) -> Hollow:
    """Find the largest hollow of a vessel.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
        A closed surface, outward, with a cavity or with a hollow that is open upward; or a single
        surface with a rim. Corners at the same position are one.
    up : (3,) array_like
        The direction against gravity.

    Returns
    -------
    Hollow

    Raises
    ------
    MeasureError
        If there is none.

    Examples
    --------
    >>> from body_moments.core.cuts import find_hollow
    >>> points = [[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    >>> walls = [[i, (i + 1) % 4, 4 + (i + 1) % 4] for i in range(4)]
    >>> walls += [[i, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    >>> box = find_hollow(points, [[0, 2, 1], [0, 3, 2], *walls])
    >>> round(box.capacity, 9), round(box.level_of(0.25), 9)
    (1.0, 0.25)
    """
    points = float_array("points", points, "n", 3, finite=True)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    up = unit_vector("up", up)
    used, triangles = np.unique(first_at_equal_position(points)[triangles], return_inverse=True)
    points = points[used]
    # Points are numbered by height: from here on, the lower of two points has the smaller index.
    heights = points @ up
    order = np.argsort(heights, kind="stable")
    points, heights = points[order], heights[order]
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    triangles = rank[triangles.reshape(-1, 3)]
    # A side without a length bounds nothing.
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    triangles = _without_copies(triangles)
    _, start, stop = uncancelled_sides(triangles, np.zeros(len(triangles), np.intp))
    rim = np.union1d(start, stop)
    best = _largest(points, heights, triangles, up, rim)
    if len(rim):  # a sheet may face either way
        turned = _largest(points, heights, triangles[:, ::-1], up, rim)
        if turned is not None and (best is None or turned.capacity > TURNED_SHARE * best.capacity):
            best = turned
    if best is None:
        raise MeasureError(LEVEL_UNAVAILABLE, fault=NO_HOLLOW)
    return best


def _without_copies(triangles: Index) -> Index:
    """Return each triangle once, facing as most of its copies; of two that face opposite ways, the
    one that continues its neighbors, both if both or neither do.
    """
    count = len(triangles)
    first = first_occurrence(*np.sort(triangles, axis=1).T)
    if (first == np.arange(count)).all():
        return triangles
    following = np.roll(triangles, -1, axis=1)
    # 1 if the corners ascend twice on the way round, -1 if once: copies of one direction agree.
    side = 2 * (following > triangles).sum(axis=1) - 3
    facing = np.bincount(first, side, count)[first]
    rest = triangles[facing != 0.0]
    _, start, stop = uncancelled_sides(rest, np.zeros(len(rest), np.intp))
    # Copies of both kinds: a side of the rest's boundary must run against the copy's.
    size = int(triangles.max()) + 1
    fits = np.isin(following * size + triangles, start * size + stop).any(axis=1)
    fits &= np.bincount(first, fits, count)[first] == 1.0  # just one of the copies
    chosen = np.flatnonzero(np.where(facing != 0.0, side * facing > 0.0, fits))
    _, rows = np.unique(first[chosen], return_index=True)
    undecided = np.flatnonzero(~np.isin(first, first[chosen]))
    return triangles[np.union1d(chosen[rows], undecided)]


def _largest(
    points: Array, heights: Array, triangles: Index, up: Array, rim: Index
) -> Hollow | None:
    """Return the largest hollow of a surface; None if there is none.

    points, heights: ascending, so that indices compare heights. rim: points of open edges.
    """
    a, b = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    low, high = np.minimum(a, b), np.maximum(a, b)
    candidates = _hollows(points, triangles, low, high, up, rim)
    depth = [heights[min(top, len(heights) - 1)] - heights[bottom] for bottom, top in candidates]
    best = None
    for i in np.argsort(depth)[::-1][:MAX_CANDIDATES]:
        bottom, top = candidates[i]
        # The sides below the spill point connect the points of the hollow.
        wet = high < top
        label, _ = connected_components(len(points), low[wet], high[wet])
        lowest = triangles.min(axis=1)
        walls = triangles[(label[lowest] == label[bottom]) & (lowest < top)]
        sealed = top == len(points)
        spill = heights[walls.max() if sealed else top]
        used, walls = np.unique(walls, return_inverse=True)
        # The walls face the liquid.
        walls = walls.reshape(-1, 3)[:, ::-1]
        hollow = Hollow(points[used], walls, up, float(heights[bottom]), float(spill), bool(sealed))
        if hollow.capacity > (0.0 if best is None else best.capacity):
            best = hollow
    return best


def _hollows(
    points: Array, triangles: Index, low: Index, high: Index, up: Array, rim: Index
) -> list[tuple[int, int]]:
    """Return the lowest point of each hollow, and the point where it spills, n for a cavity.

    points: (n, 3), ascending. low, high: (s,) lower and upper ends of the triangles' sides. rim:
    (r,) points of open edges.
    """
    count = len(points)
    # From the lowest neighbor of each point to the lowest point of its region, itself.
    parent = np.arange(count)
    np.minimum.at(parent, high, low)
    while not np.array_equal(above := parent[parent], parent):
        parent = above
    faces_up = _faces_up(points, triangles, parent == np.arange(count), up)
    # Links between regions, and of regions with the outside, -1, at the rim.
    first = np.concatenate([parent[low], np.full(len(rim), -1)])
    second = np.concatenate([parent[high], parent[rim]])
    passes = np.concatenate([high, rim])
    is_link = first != second
    first, second, passes = first[is_link], second[is_link], passes[is_link]
    # The lowest pass between each pair of regions, then these passes in order of height.
    pair = np.minimum(first, second) * (count + 1) + np.maximum(first, second)
    order = np.lexsort([passes, pair])
    order = order[run_starts(pair[order])]
    order = order[np.argsort(passes[order], kind="stable")]
    # A union-find forest of regions by their lowest points; the lower region is the root.
    root = {int(bottom): int(bottom) for bottom in np.unique(parent)} | {-1: -1}

    def find(item: int) -> int:
        """Return the lowest point of the union of an item; the outside, -1, is below all."""
        while root[item] != item:
            root[item] = root[root[item]]
            item = root[item]
        return item

    hollows = []
    for left, right, top in np.stack([first, second, passes], axis=1)[order].tolist():
        lower, upper = sorted((find(left), find(right)))
        if lower == upper:
            continue
        root[upper] = lower
        if faces_up[upper] and (lower < 0 or not faces_up[lower]):
            hollows.append((upper, top))
    cavities = [item for item in root if item >= 0 and faces_up[item] and find(item) == item]
    return hollows + [(item, count) for item in cavities]


def _faces_up(points: Array, triangles: Index, lowest: Mask, up: Array) -> Mask:
    """Return an (n,) mask of the lowest points of regions with air above them.

    lowest: (n,) mask of these points. A place just below one has no point of the surface nearer, so
    that the sum of normals around it, weighted by angles, tells on which side of the surface the
    place is (Bærentzen and Aanæs 2005). If the sum points up, that is inside: the air is above.
    """
    around = triangles[lowest[triangles].any(axis=1)]
    corners = points[around]
    sides = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(sides[:, 0], sides[:, 1])
    dots = -(sides * np.roll(sides, 1, axis=1)).sum(axis=2)
    angle = np.arctan2(np.linalg.norm(normal, axis=1)[:, None], dots)
    normal /= np.maximum(lengths(normal), TINY)
    facing = angle * (normal @ up)[:, None]
    return np.bincount(around.ravel(), facing.ravel(), len(points)) > 0.0


def spill_tilt(
    points: ArrayLike, triangles: ArrayLike, volume: float, up: ArrayLike = (0.0, 0.0, 1.0)
) -> tuple[float, Array]:
    """Find the tilt at which a vessel spills: the smallest angle in 24 directions.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
    volume : float
        Of the liquid.
    up : (3,) array_like

    Returns
    -------
    angle : float
        In rad; pi for a cavity.
    direction : (3,) array
        The horizontal direction to which it is tilted.

    Raises
    ------
    MeasureError
        If it has no hollow.

    Examples
    --------
    >>> from body_moments.core.cuts import spill_tilt
    >>> points = [[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    >>> walls = [[i, (i + 1) % 4, 4 + (i + 1) % 4] for i in range(4)]
    >>> walls += [[i, 4 + (i + 1) % 4, 4 + i] for i in range(4)]
    >>> angle, direction = spill_tilt(points, [[0, 2, 1], [0, 3, 2], *walls], 0.5)
    >>> round(float(np.degrees(angle)), 2)
    35.26
    """
    hollow = find_hollow(points, triangles, up)
    first, second, _ = np.array(frame_about(hollow.up.tolist()))
    if hollow.sealed:
        return np.pi, first

    def spills(tilt: float, direction: Array) -> bool:
        # Tilting the vessel toward the direction tilts the vertical away from it.
        tilted = np.cos(tilt) * hollow.up - np.sin(tilt) * direction
        try:
            return find_hollow(points, triangles, tilted).capacity < volume
        except MeasureError:
            return True

    least_tilt, least_direction = np.pi, first
    for azimuth in np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS):
        direction = np.cos(azimuth) * first + np.sin(azimuth) * second
        if not spills(least_tilt * (1.0 - TILT_RTOL), direction):
            continue
        low, high = 0.0, least_tilt
        for _ in range(TILT_ROUNDS):
            middle = (low + high) / 2.0
            low, high = (low, middle) if spills(middle, direction) else (middle, high)
        least_tilt, least_direction = high, direction
    return least_tilt, least_direction
