# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of bodies that triangles and quads bound: one entry to the kernels; volume and center in
one light pass.

To third order a kernel of its own is several times as fast (`third_order`); higher orders are for
the recursion (`any_order`).
"""

from collections.abc import Callable, Iterable, Iterator
from math import isfinite
from typing import Any

import numpy as np

from ..inertia import MOMENTS_OVERFLOW
from ..mesh import BoundarySum, PlanarityAccumulator, Surface
from ..moments import Measure, Moments, U, monomial_count
from ..numerics import (
    Array,
    ArrayLike,
    Integers,
    NDArray,
    check_order,
    check_type,
    cross,
    dot,
    float_array,
    indices_in_range,
    number_array,
)
from ..verdict import MeasureError
from . import third_order
from .any_order import StreamIntegrator
from .faces import NO_VERTEX, box_center, finite_box
from .findings import BOUNDARY_OPEN
from .third_order import nothing

THIRD = 3  # orders up to this one have their own kernel
FACES_PER_BLOCK = 1 << 13  # faces whose intermediate arrays stay in the cache
PRODUCTS_PER_BLOCK = 1 << 17  # products of a map with a normal at a time
SUM_ROUNDINGS = 128  # u: within a block numpy adds up in pairs of sums of at most 128 in 8 lanes


def polyhedron_moments(
    body: Surface | Iterable[Surface | NDArray],
    order: int = THIRD,
    *,
    area_order: int | None = None,
    about: ArrayLike | None = None,
    reach: float | None = None,
    exact: bool = False,
    allow_open: bool = False,
    threads: int = 1,
    progress: Callable[[int], None] | None = None,
    planarity: PlanarityAccumulator | None = None,
) -> tuple[Moments, Moments | Any]:
    """Return the moments of the body that a closed surface bounds, and of the surface itself.

    All moments are about the center of the bounding box, unless `about` is given. The volume is
    positive for outward faces, and signed otherwise. An open surface's moments would depend on the
    reference point: it is refused unless `allow_open`. `solid.measure_solid` repairs such a
    surface, and its body has moments of any order. `rounding_error` bounds the rounding of every
    moment, `input_error` the change that storing coordinates as float32 may have made (of a closed
    surface).

    Parameters
    ----------
    body : Surface, or an iterable of pieces of one body
        Pieces, in the same coordinates, are Surfaces or (m, 3, 3) arrays of the corners of
        triangles, counter-clockwise from outside. Of a stream only a few are held at a time.
    order : int
        The highest order p+q+r of the volume's moments.
    area_order : int, optional
        The highest order of the area's moments, 0 for the area alone. To third order these cost
        little and make the volume's `input_error` smaller. By default no areas.
    about : (3,) array_like, optional
        The reference point; of a stream that can be read only once, by default the center of its
        first piece's box. Give a point in the body: far from it digits are lost, and
        `rounding_error` states how many.
    reach : float, optional
        Rough distance from there to the body's farthest point; of such a stream, by default of its
        first piece.
    exact : bool
        True for a third order that is exact to rounding for every size of mesh. Otherwise meshes of
        more than 100,000 triangles leave out terms of the order of an edge cubed, and
        `rounding_error` bounds it. Other orders are always exact to rounding.
    allow_open : bool
        True to take faces as they are: gaps are closed by the cone from the reference point. Saves
        the check, too.
    threads : int
        Threads that share the faces.
    progress : callable, optional
        Called now and then with the number of faces done.
    planarity : PlanarityAccumulator, optional
        Receives the measured sizes of a Surface's faces, if that costs little.

    Returns
    -------
    volume : Moments
    area : Moments, or None if none is asked for

    Raises
    ------
    ValueError
        If coordinates are not finite, a face has an index without a point, or a piece of a stream
        reaches much farther than the first.
    MeasureError
        If the faces do not close, are too small (below 1e-60), or a moment is beyond the range of
        numbers.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> volume, area = polyhedron_moments(surface, 8, area_order=0, about=(0, 0, 0))
    >>> round(volume.total * 6, 12), round(area.total, 6)
    (1.0, 2.366025)
    >>> round(volume[8, 0, 0] * 990, 9)
    1.0
    """
    check_order("order", order)
    if area_order is not None:
        check_order("area_order", area_order)
    if about is not None:
        about = float_array("about", about, 3, finite=True)
    highest = order if area_order is None else max(order, area_order)
    boundary = BoundarySum()
    if isinstance(body, Surface):
        stream = iter([body])
    else:
        check_type("body", body, Iterable)
        planarity = None  # the accumulator is for one surface
        if isinstance(body, (list, tuple)):
            body = [_as_surface(piece) for piece in body]
            about = _center(body) if about is None else about
        stream = map(_as_surface, body)
    if not allow_open:
        stream = _summed(stream, boundary)
    if highest <= THIRD:
        options = {
            "area": area_order is not None,
            # The area alone, beside higher moments of the volume, needs no sums of monomials.
            "area_moments": area_order is not None and area_order >= min(order, 1),
            "exact": exact and order == THIRD,
        }
        volume, area = _sum_to_third_order(
            stream, threads, about, progress, planarity=planarity, **options
        )
        # Bounds are not negative, and an area's have one power of the reach less.
        if not isfinite(np.add.reduce(volume.rounding_error[: monomial_count(highest)])):
            raise MeasureError(MOMENTS_OVERFLOW, order=int(order))
    else:
        volume, area = StreamIntegrator(
            highest, area_order is not None, max(1, threads), progress, about, reach
        ).integrate(stream)
    if not boundary.is_zero:
        raise MeasureError(BOUNDARY_OPEN)
    if area_order is None or area is None:
        return volume.truncate(order), None
    return volume.truncate(order), area.truncate(area_order)


def _summed(stream: Iterable[Surface], boundary: BoundarySum) -> Iterator[Surface]:
    """Yield the pieces, adding up their sides on the way."""
    for piece in stream:
        for faces in (piece.triangles, piece.quads):
            if not indices_in_range(faces, len(piece.points)):
                raise ValueError(NO_VERTEX)
        boundary.add(piece)
        yield piece


def _as_surface(piece: Surface | NDArray) -> Surface:
    """Return a piece as a surface; of (m, 3, 3) corners, each triangle has its own points."""
    if isinstance(piece, Surface):
        return piece
    corners = number_array("corners", piece, "m", 3, 3)
    return Surface(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _center(surfaces: list[Surface]) -> Array | None:
    """Return the (3,) center of the box around all surfaces; None if there are no points."""
    boxes = [finite_box(surface) for surface in surfaces if len(surface.points)]
    if not boxes:
        return None
    lows, highs = zip(*boxes)
    dtype = np.result_type(*(surface.points for surface in surfaces))
    return box_center(np.min(lows, axis=0), np.max(highs, axis=0), dtype)


def _sum_to_third_order(
    stream: Iterable[Surface],
    threads: int,
    about: NDArray | None,
    progress: Callable[[int], None] | None,
    **options: Any,
) -> tuple[Moments, Moments]:
    """Return volume and area of all pieces, about the first one's point if no other is given;
    perhaps not finite.
    """
    total: tuple[Moments, Moments] | None = None
    done = 0
    for surface in stream:
        count = len(surface.triangles) + len(surface.quads)
        if not count:
            continue
        part = third_order.integrate(surface, threads, about=about, **options)
        if total is None:
            total = part
        else:
            with np.errstate(over="ignore", invalid="ignore"):
                total = total[0] + part[0], total[1] + part[1]
        about = total[0].about
        done += count
        if progress is not None:
            progress(done)
    return total or nothing(THIRD, about)


def volume_and_center(surface: Surface) -> tuple[float, Array]:
    """Return the volume that a closed surface encloses, negative if inside out, and its (3,)
    centroid, if finite.
    """
    points = np.ascontiguousarray(surface.points.T, np.float64)
    middle = points.mean(axis=1)
    points = points - middle[:, None]  # the array may be the surface's own
    sums = np.zeros(4)
    for faces, sums_of in ((surface.triangles, _triangles), (surface.quads, _quads)):
        for start in range(0, len(faces), FACES_PER_BLOCK):
            sums += sums_of(points, faces[start : start + FACES_PER_BLOCK])
    # A centroid is a first moment, sum / 24, by the volume, sum / 6.
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(sums[0] / 6.0), middle + sums[1:] / (4.0 * sums[0])


def _triangles(points: Array, triangles: Integers) -> Array:
    """Return (4,): 6 times the volume and 24 times the three first moments. points: (3, n)."""
    a, b, c = (points.take(corner, axis=1) for corner in triangles.T)
    return _sums((dot(cross(b, c), a), a + b + c))


def _quads(points: Array, quads: Integers) -> Array:
    """Return the sums of `_triangles` for quads, cut as Blender draws them, in float64."""
    a, b, c, d = (points.take(corner, axis=1) for corner in quads.T)
    u = b - a
    v = d - a
    diagonal = c - a
    # True if the normals of the two triangles along ac face away from each other, by Lagrange's
    # identity.
    flipped = dot(u, v) * dot(diagonal, diagonal) > dot(u, diagonal) * dot(v, diagonal)
    if flipped.any():  # cut from b to d
        a, b, c, d = (
            np.where(flipped, other, corner) for corner, other in ((a, b), (b, c), (c, d), (d, a))
        )
    w = cross(a, c)
    first = -dot(b, w)
    second = dot(d, w)
    return _sums((first, a + b + c), (second, a + c + d))


def _sums(*parts: tuple[Array, Array]) -> Array:
    """Return the (4,) sums of (k,) volumes, and of volumes times (3, k) corners, over all parts."""
    return sum(
        [
            np.append(volumes.sum(), np.einsum("ij,j->i", corners, volumes))
            for volumes, corners in parts
        ],
        np.zeros(4),
    )


def area_of_images(surface: Surface, linear: Array) -> Moments:
    """Return the total area, order 0, of a surface's images under (k, 3, 3) maps, which may stretch
    it unevenly.

    The image of a triangle with doubled area vector n under A has cof(A) n (Nanson's formula).
    """
    triangles, _ = surface.all_triangles()
    a, b, c = (surface.points[triangles[:, i]].T.astype(np.float64) for i in range(3))
    first, second = b - a, c - a
    # Below, plus and minus are the two products in each component of a normal, then of a cofactor.
    plus, minus = (np.roll(first, -i, axis=0) * np.roll(second, i, axis=0) for i in (1, -1))
    normals = plus - minus
    size = (np.abs(plus) + np.abs(minus)).sum(axis=1)
    above = linear[:, [1, 2, 0]]
    below = linear[:, [2, 0, 1]]
    plus, minus = (
        above[:, :, second_axis] * below[:, :, third_axis]
        for second_axis, third_axis in (([1, 2, 0], [2, 0, 1]), ([2, 0, 1], [1, 2, 0]))
    )
    cofactors = plus - minus
    step = max(1, PRODUCTS_PER_BLOCK // len(linear))
    sums = []
    for start in range(0, len(triangles), step):
        images = cofactors @ normals[:, start : start + step]
        sums.append(np.sqrt(np.einsum("kif,kif->kf", images, images)).sum())
    total = float(sum(sums)) / 2.0
    # A normal is off by 4 u of its terms, a cofactor by 2 u of its; then three products and their
    # sum.
    rounded = (
        (9.0 * np.abs(cofactors) + 2.0 * (np.abs(plus) + np.abs(minus))).sum(axis=(0, 1))
        @ size
        / 2.0
    )
    # Edges are off by twice the points' errors h, so a component u_j v_k - u_k v_j of a normal by
    # 2 (|u_j| + |v_j|) h_k + 2 (|u_k| + |v_k|) h_j + 8 h_j h_k.
    h = surface.coordinate_error
    edges = np.abs(np.concatenate([first, second], axis=1)).sum(axis=1)
    moved = [
        2.0 * (edges[j] * h[k] + edges[k] * h[j]) + 8.0 * h[j] * h[k] * len(triangles)
        for j, k in ((1, 2), (2, 0), (0, 1))
    ]
    return Moments(
        np.array([total]),
        np.zeros(3),
        Measure.AREA,
        np.array([U * (1.0 + 1e-9) * (rounded + (SUM_ROUNDINGS + len(sums)) * total)]),
        np.array([np.abs(cofactors).sum(axis=(0, 1)) @ moved / 2.0]),
    )
