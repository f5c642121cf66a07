# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments of bodies that triangles and quads bound: one entry to the kernels.

To third order a kernel of its own is several times as fast (`third_order`); higher orders are for the recursion
(`any_order`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..inertia.findings import MOMENTS_OVERFLOW
from ..mesh.boundary import BoundarySum
from ..mesh.planarity import PlanarityAccumulator
from ..mesh.surface import Surface
from ..moments.exponents import monomial_count
from ..moments.moments import Moments
from ..numerics.arguments import check_order, check_type, float_array, number_array
from ..numerics.arrays import indices_in_range
from ..verdict.finding import MeasureError
from . import third_order
from .any_order import StreamIntegrator
from .findings import BOUNDARY_OPEN
from .third_order import box_center, finite_box, nothing
from .third_order_kernel import NO_VERTEX

THIRD = 3  # orders up to this one have their own kernel


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

    All moments are about the center of the bounding box, unless `about` is given. The volume is positive for outward
    faces, and signed otherwise. The moments of an open surface would depend on the reference point: it is refused
    unless `allow_open`. `solid.measure_solid` repairs it, and its body has moments of any order. `rounding_error`
    bounds the rounding of every moment, `input_error` the change that storing coordinates as float32 may have made (of
    a closed surface).

    Parameters
    ----------
    body : Surface, or an iterable of pieces of one body
        Pieces, in the same coordinates, are Surfaces or (m, 3, 3) arrays of the corners of triangles, counter-clockwise
        from outside. Of a stream only a few are held at a time.
    order : int
        The highest order p+q+r of the volume's moments.
    area_order : int, optional
        The highest order of the area's moments, 0 for the area alone. To third order these cost little and make the
        volume's `input_error` smaller. By default no areas.
    about : (3,) array_like, optional
        The reference point; of a stream that can be read only once, by default the center of its first piece's box.
        Give a point in the body: far from it digits are lost, and `rounding_error` states how many.
    reach : float, optional
        Rough distance from there to the body's farthest point; of such a stream, by default of its first piece.
    exact : bool
        True for a third order that is exact to rounding for every size of mesh. Otherwise meshes of more than
        100,000 triangles leave out terms of the order of an edge cubed, and `rounding_error` bounds it. Other orders
        are always exact to rounding.
    allow_open : bool
        True to take faces as they are: gaps are closed by the cone from the reference point. Saves the check, too.
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
        If coordinates are not finite, a face has an index without a point, or a piece of a stream reaches much farther
        than the first.
    MeasureError
        If the faces do not close, are too small (below 1e-60), or a moment is beyond the range of numbers.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
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
    highest, boundary = order if area_order is None else max(order, area_order), BoundarySum()
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
        area_moments = area_order is not None and area_order >= min(order, 1)
        options = {"area": area_order is not None, "area_moments": area_moments, "exact": exact and order == THIRD}
        volume, area = _sum_to_third_order(stream, threads, about, progress, planarity=planarity, **options)
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
        return _to_order(volume, order), None
    return _to_order(volume, order), _to_order(area, area_order)


def _summed(stream: Iterable[Surface], boundary: BoundarySum) -> Iterator[Surface]:
    """Yield the pieces, adding up their sides on the way."""
    for piece in stream:
        for faces in (piece.triangles, piece.quads):
            if not indices_in_range(faces, len(piece.points)):
                raise ValueError(NO_VERTEX)
        boundary.add(piece)
        yield piece


def _as_surface(piece: Surface | NDArray) -> Surface:
    if isinstance(piece, Surface):
        return piece
    corners = number_array("corners", piece, "m", 3, 3)
    return Surface(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _center(surfaces: list[Surface]) -> NDArray[np.float64] | None:
    """Return the (3,) center of the box around all surfaces; None if there are no points."""
    boxes = [finite_box(surface) for surface in surfaces if len(surface.points)]
    if not boxes:
        return None
    lows, highs = zip(*boxes)
    dtype = np.result_type(*(surface.points for surface in surfaces))
    return box_center(np.min(lows, axis=0), np.max(highs, axis=0), dtype)


def _to_order(moments: Moments, order: int) -> Moments:
    return moments if len(moments.raw) <= monomial_count(order) else moments.truncate(order)


def _sum_to_third_order(
    stream: Iterable[Surface],
    threads: int,
    about: NDArray | None,
    progress: Callable[[int], None] | None,
    **options: Any,
) -> tuple[Moments, Moments]:
    """Return volume and area of all pieces, about the first one's point if no other is given; perhaps not finite."""
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
