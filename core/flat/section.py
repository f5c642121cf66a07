# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurement of the section properties of a plane region: the plane of flat triangles, and the
region on it.
"""

from dataclasses import replace

import numpy as np

from ..mesh import first_at_equal_position, normals, uncancelled_sides
from ..moments import U
from ..numerics import Array, ArrayLike, Index, NDArray, check_type, float_array, index_array
from ..polyhedron import facet_moments
from ..verdict import MeasureError
from .findings import NO_SECTION_AREA, OUTLINES_ENCLOSE_NONE, SECTION_NOT_FLAT
from .polygon import edge_arrays, outline_areas, plane_positions, region_moments
from .section_properties import Plane, Section

# Relative to a region's size: points farther off their plane are not planar; an area errs by the
# square of this.
PLANAR_RTOL = 1e-5
EDGE_GROWTH = 2.0 * np.sqrt(2.0)  # an edge grows by this if both ends move by 1 along each axis
# The least share of a preferred axis that must lie in the plane to become the plane's x axis.
MIN_AXIS_SHARE = 0.05
# Relative to a face's length: thinner faces have no side to look to, because of rounding.
SLIVER_RTOL = 1e-12


def project(plane: Plane, points: ArrayLike) -> Array:
    """Return the (n, 2) coordinates of points along the plane's x and y axes."""
    x, y, z = (float_array("points", points, "n", 3) - plane.origin).T
    # Not a matrix product, whose rounding depends on the number of points.
    return np.stack([x * a[0] + y * a[1] + z * a[2] for a in plane.axes.T[:2]], axis=1)


def foot(plane: Plane, point: ArrayLike) -> Array:
    """Return the (3,) foot of a point of the world on the plane, in the plane's axes: z is 0."""
    return np.append(project(plane, np.asarray(point, np.float64)[None])[0], 0.0)


def fit_plane(
    points: ArrayLike,
    triangles: ArrayLike,
    prefer: ArrayLike,
    origin: ArrayLike,
    error: float = 0.0,
    facing: ArrayLike | None = None,
) -> Plane:
    """Fit the plane of triangles that are flat.

    Parameters
    ----------
    points : (n, 3) array_like
    triangles : (m, 3) array_like of int
    prefer : (3, 3) array_like
        Columns: axes that the plane's x is to be near to: the first, or if that is normal to the
        plane the second.
    origin : (3,) array_like
        A point whose foot on the plane becomes its origin.
    error : float
        Largest distance of the points from their intended places.
    facing : (3,) array_like, optional
        A direction that the normal is to agree with; by default most of the triangles' area.

    Returns
    -------
    Plane

    Raises
    ------
    MeasureError
        If the points are not planar, or have no area.

    Examples
    --------
    >>> from body_moments.core.flat import fit_plane
    >>> plane = fit_plane(np.eye(4, 3, -1) + 1.0, np.array([[0, 1, 2]]), np.eye(3), np.zeros(3))
    >>> plane.origin.tolist(), plane.axes[:, 2].tolist()
    ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0])
    """
    points = float_array("points", points, "n", 3)
    triangles = index_array("triangles", triangles, "m", 3, count=len(points))
    prefer = float_array("prefer", prefer, 3, 3)
    origin = float_array("origin", origin, 3)
    facing = None if facing is None else float_array("facing", facing, 3)
    vectors = normals(points, triangles)
    sizes = np.sqrt((vectors * vectors).sum(axis=1))
    if not (sizes > 0.0).any():
        raise MeasureError(NO_SECTION_AREA, fault="the faces have none. Select other faces")
    used = points[np.unique(triangles)]
    size = float(np.sqrt(((used.max(axis=0) - used.min(axis=0)) ** 2).sum()))
    # Faces that look the other way than the largest one are of the same plane.
    side = np.sign(vectors @ vectors[int(np.argmax(sizes))])
    total = (vectors * side[:, None]).sum(axis=0)
    normal = total / np.sqrt(total @ total)
    agreement = (vectors @ normal).sum() if facing is None else facing @ normal
    if agreement < 0.0:
        normal = -normal
    heights = (used - used[0]) @ normal
    level = float(heights.min() + heights.max()) / 2.0
    out_of_plane = float(np.ptp(heights)) / 2.0
    # The errors of the points and of the normal raise a point by some 2 errors; 4 leaves a margin.
    if out_of_plane > PLANAR_RTOL * size + 4.0 * error:
        raise MeasureError(SECTION_NOT_FLAT, share=out_of_plane / size)
    axes, x_axis_name = _axes(normal, prefer)
    distance = float((used[0] - origin) @ normal) + level
    return Plane(origin + distance * normal, axes, out_of_plane, x_axis_name)


def _axes(normal: NDArray, prefer: NDArray) -> tuple[Array, str]:
    """Return the `Plane.axes` of a plane, and the name of the preferred axis, the first or second
    column of `prefer`, whose part in the plane x is along.
    """
    in_plane = [axis - normal * (normal @ axis) for axis in prefer.T]
    choice = int(np.sqrt(in_plane[0] @ in_plane[0]) <= MIN_AXIS_SHARE)
    x = in_plane[choice] / np.sqrt(in_plane[choice] @ in_plane[choice])
    x = x - normal * (normal @ x)  # once more, because of rounding
    return np.stack([x, np.cross(normal, x), normal], axis=1) + 0.0, "XY"[choice]


def region(
    plane: Plane, points: NDArray, triangles: NDArray, faces: NDArray, error: float
) -> tuple[Index, int]:
    """Return (k, 2) edges around the region of triangles near a plane, and the number of faces that
    look against the plane, whose triangles are turned.

    points: (n, 3). triangles: (m, 3). faces: (m,) face of each triangle, from 0. error: the largest
    distance of a point from its intended place, in the unit of the points.
    """
    triangles = first_at_equal_position(points)[triangles]
    a, b, c = project(plane, points)[triangles].swapaxes(0, 1)
    first, second = b - a, c - a
    triangle_areas = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]) / 2.0
    areas = np.bincount(faces, triangle_areas)
    # The longest side of each face's triangles along an axis of the plane.
    lengths = np.zeros(len(areas))
    np.maximum.at(lengths, faces, np.abs(np.stack([first, second])).max(axis=(0, 2)))
    # Corners that move by the error change an area by at most half the perimeter times the error,
    # some 2 errors times the length of a triangle; 4 leaves a margin. Thinner faces may look to
    # either side, and are not turned.
    flipped = areas < -(4.0 * error + SLIVER_RTOL * lengths) * lengths
    triangles = np.where(flipped[faces][:, None], triangles[:, ::-1], triangles)
    _, start, stop = uncancelled_sides(triangles, np.zeros(len(triangles), np.intp))
    return np.stack([start, stop], axis=1), int(np.count_nonzero(flipped))


def projection_rounding(plane: Plane, points: NDArray, flat: NDArray) -> float:
    """Return a bound of the displacement by rounding of each coordinate of (n, 3) points projected
    to (n, 2) flat points.
    """
    # Three products, a difference and sums, and rounded axes: less than 16 roundings.
    return (
        16.0
        * U
        * float(np.abs(points).max() + np.abs(plane.origin).max() + np.abs(flat).max(initial=0.0))
    )


def measure_section(
    plane: Plane, points: ArrayLike, edges: ArrayLike, error: float = 0.0, shared: float = 0.0
) -> Section:
    """Measure the region to the left of directed edges.

    Check beforehand with `find_defects` that the edges bound one region; it also reports the length
    that edges share.

    Parameters
    ----------
    plane : Plane
    points : (n, 3) array_like
        Near the plane.
    edges : (m, 2) array_like of int
    error : float
        Largest displacement of each point by storing it as float32.
    shared : float
        The length that edges share, which the perimeter leaves out twice.

    Returns
    -------
    Section

    Raises
    ------
    MeasureError
        If the edges enclose no area, or do not close.

    Examples
    --------
    >>> from body_moments.core.flat import directed_edges, measure_section
    >>> from body_moments.core.flat.section_properties import Plane
    >>> points = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    >>> plane = Plane(np.zeros(3), np.eye(3), 0.0, "X")
    >>> section = measure_section(plane, points, directed_edges([range(4)]))
    >>> round(section.area, 9), section.center, np.round(section.second * 12, 9).tolist()
    (2.0, (1.0, 0.5, 0.0), [2.0, 8.0, 0.0])
    """
    check_type("plane", plane, Plane)
    points, edges = edge_arrays(points, edges, 3)
    flat = project(plane, points)
    used = flat[edges.ravel()]
    rounded = projection_rounding(plane, points, used)
    moments = region_moments(flat, edges, 2, rounded=rounded, stored=error)
    if not moments.total > 0.0:
        raise MeasureError(NO_SECTION_AREA, fault=OUTLINES_ENCLOSE_NONE)
    about = moments.about[:2]
    positions = plane_positions(2)
    raw = moments.raw[positions]
    length = facet_moments(flat, edges, 0)
    rounding_error = _bounds(raw, about, moments.rounding_error[positions])
    input_error = _bounds(raw, about, moments.input_error[positions])
    # The perimeter without twice the shared length, which consists of at most 2 len(edges) pieces:
    # with its own edges, 5 len(edges) lengths, and the rounding of 3 sums.
    ends = EDGE_GROWTH * len(edges) * (5.0 if shared else 1.0)
    length_rounding = float(length.rounding_error[0]) * (3.0 if shared else 1.0)
    rounding_error["perimeter"] = length_rounding + ends * rounded
    input_error["perimeter"] = ends * error
    area = moments.total
    x_shift, y_shift = shift = raw[1:3] / raw[0]
    # The rows of the moments are 1, x, y, xx, xy, yy.
    second = raw[[5, 3, 4]] - area * np.array([y_shift**2, x_shift**2, x_shift * y_shift])
    second[:2] = np.maximum(second[:2], 0.0)
    sizes = outline_areas(flat, edges)
    centroid = about + shift
    section = Section(
        plane=plane,
        area=area,
        perimeter=float(length.raw[0]) - 2.0 * shared,
        centroid=centroid,
        second=second,
        reach=np.ones(4),  # It depends on the section's angle, and follows.
        outlines=int((sizes > 0.0).sum()),
        holes=int((sizes < 0.0).sum()),
        rounding_error=rounding_error,
        input_error=input_error,
    )
    x, y = (used - centroid).T
    sine = np.sin(section.angle)
    cosine = np.cos(section.angle)
    distances = np.abs([y, x, y * cosine - x * sine, x * cosine + y * sine])
    return replace(section, reach=distances.max(axis=1))


def _bounds(raw: NDArray, about: NDArray, delta: NDArray) -> dict[str, float]:
    """Return error bounds of area, centroid and second moments from (6,) moments off by `delta`.

    raw: 1, x, y, xx, xy, yy about the point `about`, the centroid up to rounding.
    """
    area = raw[0]
    shift = np.abs(raw[1:3]) / raw[0]
    if not area > 2.0 * delta[0]:  # then nothing bounds a quotient
        return {"area": float(delta[0]), "centroid": float("inf"), "second": float("inf")}
    # The change of the quotient of first moments and area.
    drift = (delta[1:3] + shift * delta[0]) / (area - delta[0])
    tolerance = 4.0 * U * (np.abs(about) + shift)
    # The second moments about the point, and what the step to the centroid takes away.
    second = delta[3:].max() + (area + delta[0]) * (drift + shift).max() ** 2
    second += 4.0 * U * np.abs(raw[3:]).max()
    return {
        "area": float(delta[0]),
        "centroid": float(np.hypot(*(drift + tolerance))),
        "second": float(second),
    }
