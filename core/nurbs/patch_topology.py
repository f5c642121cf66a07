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
    sides_of_patches = [patch.sides for patch in patches]
    curves = [curve for patch_sides in sides_of_patches for curve, _ in patch_sides]
    owner = np.repeat(np.arange(len(patches)), list(map(len, sides_of_patches)))
    forward = np.array(
        [ahead for patch_sides in sides_of_patches for _, ahead in patch_sides], bool
    )
    number_of = np.arange(len(curves))  # The number of each side before cutting, -1 for pieces.
    sides = join_sides(curves, owner, forward, len(patches), tolerance)
    pieces = cut_open_sides(curves, sides, tolerance)
    if pieces:
        counts = np.array(list(map(len, pieces)))
        cut_owner = np.repeat(owner, counts)
        cut_forward = np.repeat(forward, counts)
        cut_curves = [curve for side_pieces in pieces for curve in side_pieces]
        cut_sides = join_sides(cut_curves, cut_owner, cut_forward, len(patches), tolerance)
        if cut_sides.open_length < sides.open_length - tolerance:
            curves, owner, forward, sides = cut_curves, cut_owner, cut_forward, cut_sides
            number_of = np.repeat(np.where(counts == 1, number_of, -1), counts)
    left, right = sides.left, sides.right
    turned = sides.turned
    # Two sides fit if one runs against the other; else one of their patches must turn.
    misoriented = sides.same == (forward[left] == forward[right])
    component, number = connected_components(len(patches), owner[left], owner[right])
    first = np.unique(component, return_index=True)[1]
    flipped = turned ^ turned[first[component]]
    are_most = 2 * np.bincount(component, flipped) > np.bincount(component)
    flipped ^= are_most[component]
    # A seam that does not fit even after turning makes its component one-sided.
    is_one_sided = misoriented ^ turned[owner[left]] ^ turned[owner[right]]
    unclosable = np.zeros(number, bool)
    unclosable[component[owner[left[is_one_sided]]]] = True

    loops = []
    forward = forward ^ flipped[owner]
    open_sides = np.flatnonzero(sides.free)
    for loop_sides, is_complete in _find_loops(sides.points, open_sides, forward, tolerance):
        if not is_complete:
            unclosable[component[owner[loop_sides]]] = True
            continue
        loops.append(
            _cap_loop(
                [curves[k] for k in loop_sides],
                int(component[owner[loop_sides[0]]]),
                sides.points[loop_sides],
                forward[loop_sides],
                tolerance,
            )
        )
    seams = np.stack([number_of[left], number_of[right]], axis=1)
    return PatchTopology(
        component=component,
        number=number,
        flipped=flipped,
        loops=tuple(loops),
        open_sides=len(open_sides),
        non_manifold_sides=sides.non_manifold,
        misoriented_sides=int(misoriented.sum()),
        seam_gap=sides.gap,
        seams=seams[(seams >= 0).all(axis=1)],
        unclosable=unclosable,
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

    points: (n, m, 3) samples of all sides. free: indices of the open ones. forward: (n,) whether a
    chain runs along the side's curve, not against it.
    """
    is_ahead = forward[free]
    begin = points[free, np.where(is_ahead, 0, -1)]
    end = points[free, np.where(is_ahead, -1, 0)]
    count = len(free)
    # Begins are numbered before ends; each pair is taken in both orders.
    i, j = close_pairs(np.concatenate([begin, end]), 2.0 * tolerance)
    i, j = np.concatenate([i, j]), np.concatenate([j, i])
    is_onward = (i >= count) & (j < count)
    source, target = i[is_onward] - count, j[is_onward]
    is_near = np.linalg.norm(end[source] - begin[target], axis=1) <= 2.0 * tolerance
    onward: list[list[int]] = [[] for _ in range(count)]
    for k, after in sorted(zip(source[is_near].tolist(), target[is_near].tolist())):
        onward[k].append(after)
    chains = []
    used = np.zeros(count, bool)
    for first in range(count):
        path = [] if used[first] else [first]
        while path:
            used[path[-1]] = True
            unused = [k for k in onward[path[-1]] if not used[k]]
            is_closed = first in onward[path[-1]]
            if is_closed or not unused:
                chains.append((free[path].tolist(), is_closed))
                break
            path.append(unused[0])
    return chains


def _cap_loop(
    curves: Sequence[Curve],
    component: int,
    points: NDArray,
    forward: Mask,
    tolerance: float,
) -> BoundaryLoop:
    """Close a loop by the cone to its centroid, and return the loop with its caps.

    points: (k, m, 3) samples of the k sides' curves. forward: (k,) whether the oriented patch is on
    the left of the curve; then the loop runs along it.
    """
    run = np.concatenate(
        [samples if ahead else samples[::-1] for samples, ahead in zip(points, forward)]
    )
    steps = np.diff(np.concatenate([run, run[:1]]), axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    center = ((run + steps / 2.0) * lengths[:, None]).sum(axis=0) / lengths.sum()
    arms = run - center
    _, _, axes = np.linalg.svd(arms, full_matrices=False)
    caps = []
    for curve, ahead in zip(curves, forward):
        apex = np.broadcast_to(center, curve.points.shape)
        # A patch on the left of its curve has the cap on the right: with S_t leftward, from the
        # apex to the curve, S_s x S_t is the patch's normal. On the right of it, all is reversed.
        net = np.stack([apex, curve.points] if ahead else [curve.points, apex], axis=1)
        weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
        caps.append(Patch((curve.space, clamped_space(2)), net, weights))
    is_planar = bool(np.abs(arms @ axes[2]).max() <= tolerance)
    # A flat loop without a net area is taken to run there and back, so that its hole is closed. A
    # loop in space may bound a hole without a net area: there, the cone's triangles are summed.
    if is_planar:
        area = float(np.linalg.norm(vector_area(caps)))
    else:
        area = np.linalg.norm(np.cross(arms, steps), axis=1).sum() / 2.0
    zero_area = bool(area <= tolerance * lengths.sum())
    is_tested = is_planar and not zero_area and len(arms) <= MAX_CHORDS
    return BoundaryLoop(
        caps=tuple(caps),
        component=component,
        is_planar=is_planar,
        zero_area=zero_area,
        area=area,
        self_intersecting=is_tested and self_intersects(arms @ axes[:2].T, tolerance),
    )
