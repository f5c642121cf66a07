# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Closedness and orientation of patches and flat faces, and the caps of their holes.

Every patch has four sides, curves that run round it with the patch on their left; the sides of a
flat face are the curves that bound it. A side is closed if it is a point (a pole) or coincides with
another side (`seams`): of the same patch (a cyclic direction, a seam) or of another one, run the
other way. A vector area of zero proves nothing: an open cylinder's is zero too.

Open sides are joined to loops, and a loop is closed by the cone to its centroid. For a flat loop of
any shape the cone is the exact flat cap, as a signed sum. A cone over a B-spline curve is a
B-spline patch with degree one in the other direction, so that caps are patches like all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics import Index, Mask, NDArray, clamped_space, connected_components
from ..verdict import MeasureError, welding_tolerance
from .findings import DISCONTINUOUS_PATCH
from .flat_face import self_intersects
from .patch_moments import vector_area
from .seams import close_pairs, cut_open_sides, join_sides
from .splines import Curve, Face, Patch, patches_size

MAX_CHORDS = 4096  # Limit for a boundary loop that is tested for crossing itself.


@dataclass(frozen=True, eq=False)
class BoundaryLoop:
    """Open sides that run round a hole.

    caps: patches that close the hole and face as the sides' patches do. component: index of the
    sides' component. zero_area: the hole is closed already. area: of the cap, an estimate.
    self_intersecting: flat, and crosses itself.
    """

    caps: tuple[Patch, ...]
    component: int
    is_planar: bool
    zero_area: bool
    area: float
    self_intersecting: bool


@dataclass(frozen=True, eq=False)
class PatchTopology:
    """Components, orientations, joined sides and holes of patches.

    component: (n,) component index of each patch; number: of components. flipped: (n,) mask of
    patches that face against most of their component, or against its first if as many face each
    way. loops: the holes. open_sides, non_manifold_sides: the numbers of sides that are open, or
    coincide with several other sides. misoriented_sides: the number of joined pairs that run the
    same way before any patch is turned. seam_gap: the sum over joined sides of largest distance
    times length. seams: (k, 2) joined sides that were not cut, counted over all patches in turn.
    unclosable: (number,) mask of components with open sides that form no loop, or with a one-sided
    surface.
    """

    component: Index
    number: int
    flipped: Mask
    loops: tuple[BoundaryLoop, ...]
    open_sides: int
    non_manifold_sides: int
    misoriented_sides: int
    seam_gap: float
    seams: Index
    unclosable: Mask


def find_topology(patches: Sequence[Face], tolerance: float) -> PatchTopology:
    """Find the seams, orientation and holes of patches; MeasureError if a patch may be torn at a
    knot.
    """
    if any(space.is_discontinuous for patch in patches for space in patch.spaces):
        raise MeasureError(DISCONTINUOUS_PATCH)
    around_patches = [patch.sides for patch in patches]
    curves = [curve for around in around_patches for curve, _ in around]
    owner = np.repeat(np.arange(len(patches)), list(map(len, around_patches)))
    forward = np.array([ahead for around in around_patches for _, ahead in around], bool)
    number_of = np.arange(len(curves))
    sides = join_sides(curves, owner, forward, len(patches), tolerance)
    pieces = cut_open_sides(curves, sides, tolerance)
    if pieces:
        counts = np.array(list(map(len, pieces)))
        cut_owner = np.repeat(owner, counts)
        cut_forward = np.repeat(forward, counts)
        cut_curves = [curve for row in pieces for curve in row]
        cut_sides = join_sides(cut_curves, cut_owner, cut_forward, len(patches), tolerance)
        if cut_sides.open_length < sides.open_length - tolerance:
            curves = cut_curves
            owner = cut_owner
            forward = cut_forward
            sides = cut_sides
            number_of = np.repeat(np.where(counts == 1, number_of, -1), counts)
    points = sides.points
    left = sides.left
    right = sides.right
    free = sides.free
    turned = sides.turned

    # Two sides fit if one runs against the other; else one of their patches must turn.
    misoriented = sides.same == (forward[left] == forward[right])
    component, number = connected_components(len(patches), owner[left], owner[right])
    first = np.unique(component, return_index=True)[1]
    flipped = turned ^ turned[first[component]]
    are_most = 2 * np.bincount(component, flipped) > np.bincount(component)
    flipped ^= are_most[component]
    unclosable = np.zeros(number, bool)
    unclosable[component[owner[left[misoriented ^ turned[owner[left]] ^ turned[owner[right]]]]]] = (
        True
    )

    loops = []
    forward = forward ^ flipped[owner]
    for loop_sides, complete in _find_loops(points, np.flatnonzero(free), forward, tolerance):
        if not complete:
            unclosable[component[owner[loop_sides]]] = True
            continue
        loop_curves = [curves[k] for k in loop_sides]
        part = int(component[owner[loop_sides[0]]])
        loops.append(
            _cap_loop(loop_curves, part, points[loop_sides], forward[loop_sides], tolerance)
        )
    return PatchTopology(
        component,
        number,
        flipped,
        tuple(loops),
        int(free.sum()),
        sides.non_manifold,
        int(misoriented.sum()),
        sides.gap,
        np.stack([number_of[left], number_of[right]], axis=1)[
            (number_of[left] >= 0) & (number_of[right] >= 0)
        ],
        unclosable,
    )


def closed_parts(faces: Sequence[Face], stored: float) -> list[Face]:
    """Return the faces of the components without open sides."""
    tolerance = welding_tolerance(patches_size(faces), stored)
    topology = find_topology(faces, tolerance)
    is_open = topology.unclosable.copy()
    is_open[[loop.component for loop in topology.loops]] = True
    return [face for face, part in zip(faces, topology.component) if not is_open[part]]


def _find_loops(
    points: NDArray, free: Index, forward: Mask, tolerance: float
) -> list[tuple[list[int], bool]]:
    """Join open sides to chains; return the side indices of each chain, and True if it is
    closed.
    """
    ahead = forward[free]
    begin, end = (
        points[free, np.where(ahead, source, target)] for source, target in ((0, -1), (-1, 0))
    )
    limit = 2.0 * tolerance
    i, j = close_pairs(np.concatenate([begin, end]), limit)
    count = len(free)
    i, j = np.concatenate([i, j]), np.concatenate([j, i])  # both ways
    meet = (i >= count) & (j < count)
    i = i[meet] - count
    j = j[meet]
    close = np.linalg.norm(end[i] - begin[j], axis=1) <= limit
    onward: list[list[int]] = [[] for _ in range(count)]
    for source, target in sorted(zip(i[close].tolist(), j[close].tolist())):
        onward[source].append(target)
    loops = []
    used = np.zeros(count, bool)
    for first in range(count):
        path = [] if used[first] else [first]
        while path:
            used[path[-1]] = True
            after = [k for k in onward[path[-1]] if not used[k]]
            if first in onward[path[-1]] or not after:
                loops.append((free[path].tolist(), first in onward[path[-1]]))
                break
            path.append(after[0])
    return loops


def _cap_loop(
    curves: Sequence[Curve],
    component: int,
    points: NDArray,
    forward: Mask,
    tolerance: float,
) -> BoundaryLoop:
    """Close a loop by the cone to its centroid, and return the loop with its caps."""
    run = np.concatenate([row if ahead else row[::-1] for row, ahead in zip(points, forward)])
    steps = np.diff(np.concatenate([run, run[:1]]), axis=0)
    weigh = np.linalg.norm(steps, axis=1)
    center = ((run + steps / 2.0) * weigh[:, None]).sum(axis=0) / weigh.sum()
    arms = run - center
    _, _, axes = np.linalg.svd(arms, full_matrices=False)
    width = np.linalg.norm(np.cross(arms, steps), axis=1).sum() / 2.0
    caps = []
    for curve, ahead in zip(curves, forward):
        ends = (np.broadcast_to(center, curve.points.shape), curve.points)[:: 1 if ahead else -1]
        weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
        caps.append(Patch((curve.space, clamped_space(2)), np.stack(ends, axis=1), weights))
    flat = bool(np.abs(arms @ axes[2]).max() <= tolerance)
    # A path there and back has no net area; for a loop in space only its cone's area shows that.
    area = float(np.linalg.norm(vector_area(caps))) if flat else width
    slim = bool(area <= tolerance * weigh.sum())
    crossing = (
        flat
        and not slim
        and len(arms) <= MAX_CHORDS
        and self_intersects(arms @ axes[:2].T, tolerance)
    )
    return BoundaryLoop(tuple(caps), component, flat, slim, area, crossing)
