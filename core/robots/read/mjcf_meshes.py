# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that MuJoCo makes itself, primitives that it fits to meshes, and the masses of geoms.

The moments are those of MuJoCo 4.0.0, whose `legacy` ones of a mesh with dents are too large.
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from math import pi
from typing import NamedTuple

import numpy as np

from ...files import parse_numbers
from ...mesh import Surface, convex_hull, first_at_equal_position
from ...moments.raw import SECOND_MOMENT_INDEX, Moments
from ...numerics import Array, NDArray
from ...polyhedron import integrate
from ...verdict import MeasureError
from ..model import Pose, Shape, second_moments
from ..primitives import primitive_moments
from .xml import check_size

LEGACY = "legacy"
CLOSED = "closed"  # the kind of meshes whose volume counts only if it is certain
THOMSEN = 1.6075  # the exponent of Thomsen's formula for the area of an ellipsoid
# Factors of a derivative by steps of -2, -1, 1 and 2; exact for polynomials of degree 4.
STENCIL = ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0))
STEP = 1e-3
TINY = 1e-12  # smaller sines and cosines are zero but for rounding
MOST_STEPS = 1000  # limit of a mesh's parameters
WATER = 1000.0  # kg/m³, of shapes that state neither mass nor density
LEAST_MASS = 1e-15  # mjMINVAL, kg


def builtin_surface(kind: str, text: str) -> Surface:
    """Return the surface that MuJoCo makes of parameters.

    ValueError, with the kind and the text, if the parameters are wrong, or it bounds no volume: a
    wedge, plate, square or disc, and other kinds whose dim is 2.
    """
    values = parse_numbers(text)
    try:
        if values[6:] == [2.0]:
            raise ValueError(text)
        made = _BUILTIN[kind](*values)
        if isinstance(made, Surface):
            return made
        hull = convex_hull(made)
    except (KeyError, TypeError, ValueError, MeasureError) as error:
        raise ValueError("{} {}".format(kind, text).strip()) from error
    return Surface.from_triangles(hull.points, hull.triangles)


def _sphere(subdivisions: float) -> Array:
    # Each subdivision divides a face by four; 20 of them exceed the limit without an overflow.
    check_size(1, int(12.0 * 4.0 ** min(subdivisions, 20.0)))
    golden = (1.0 + 5.0**0.5) / 2.0
    # The corners of an icosahedron: those of three rectangles across each other.
    edges = np.array([[a, b * golden, 0.0] for a, b in product((-1.0, 1.0), repeat=2)])
    points = np.concatenate([np.roll(edges, shift, axis=1) for shift in range(3)])
    points = points / np.linalg.norm(points[0])
    for _ in range(_whole(subdivisions)):
        hull = convex_hull(points)
        corners = hull.points[hull.triangles]
        middles = (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3)  # middles of the edges
        middles = middles / np.linalg.norm(middles, axis=1, keepdims=True)
        points = np.concatenate([hull.points, middles])
    return points


def _hemisphere(resolution: float) -> Array:
    """Return the points of a divided octahedron's upper half, moved onto the ball."""
    steps = _whole(resolution) + 1
    points = np.stack(np.meshgrid(*[np.arange(-steps, steps + 1.0)] * 3), axis=-1).reshape(-1, 3)
    points = points[(np.abs(points).sum(axis=1) == steps) & (points[:, 2] >= 0.0)]
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def _cone(count: float, radius: float) -> Array:
    angles = 2.0 * pi * np.arange(_whole(count)) / count
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    below = np.column_stack([ring, np.full(len(ring), -1.0)])
    return np.concatenate([below, np.column_stack([radius * ring, np.full(len(ring), 1.0)])])


def _grid(kind: str) -> Callable[..., Array]:
    """Return a function that returns (n, 3) points for three counts and three spacings."""

    def points(*values: float) -> Array:
        x, y, z, *spacings = values[:6]
        counts = [_whole(x), _whole(y), _whole(z)]
        check_size(1, counts[0] * counts[1] * counts[2])
        axes = [np.linspace(-1.0, 1.0, count) for count in counts]
        places = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
        # The square or cube becomes a disc or ball, in place; along one axis all points stay.
        rounded = places[:, : {"cylinder": 2, "ellipsoid": 3}.get(kind, 1)]
        lengths = np.maximum(np.linalg.norm(rounded, axis=1), STEP)  # never zero
        rounded *= (np.abs(rounded).max(axis=1) / lengths)[:, None]
        return places * (np.array(counts) - 1.0) * spacings / 2.0

    return points


def _supersphere(resolution: float, east: float, north: float) -> Surface:
    count = _whole(resolution)
    low = pi * np.arange(count + 1)[:, None] / count - pi / 2.0
    around = 2.0 * pi * np.arange(count) / count - pi
    across = _power(np.cos(low), north)
    x = across * _power(np.cos(around), east)
    y = across * _power(np.sin(around), east)
    return _strips(np.stack([x, y, np.broadcast_to(_power(np.sin(low), north), x.shape)], axis=-1))


def _supertorus(resolution: float, radius: float, minor: float, major: float) -> Surface:
    count = _whole(resolution)
    angles = 2.0 * pi * np.arange(count) / count
    around = np.append(angles, 0.0)[:, None]
    across = 1.0 + radius * _power(np.cos(angles), minor)
    x = across * _power(np.cos(around), major)
    y = across * _power(np.sin(around), major)
    z = np.broadcast_to(radius * _power(np.sin(angles), minor), x.shape)
    return _strips(np.stack([x, y, z], axis=-1))


def _whole(number: float) -> int:
    """Return a count as an integer. ValueError if it is none, or too large to build."""
    if number != int(number) or not 0 <= number <= MOST_STEPS:
        raise ValueError(number)
    return int(number)


def _power(values: NDArray, exponent: float) -> Array:
    return np.sign(values) * np.abs(np.where(np.abs(values) < TINY, 0.0, values)) ** exponent


def _strips(grid: NDArray) -> Surface:
    """Return the surface of (m, n, 3) points: strips between rings, whose ends meet."""
    rings, count = grid.shape[:2]
    index = np.arange(rings * count).reshape(rings, count)
    beside = np.roll(index, -1, axis=1)
    near = np.stack([index[:-1], index[1:], beside[:-1]], axis=-1)
    far = np.stack([index[1:], beside[1:], beside[:-1]], axis=-1)
    points = grid.reshape(-1, 3)
    first = first_at_equal_position(points)
    triangles = first[np.concatenate([near.reshape(-1, 3), far.reshape(-1, 3)])]
    is_whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return Surface.from_triangles(points, triangles[is_whole])


_BUILTIN: dict[str, Callable[..., Array | Surface]] = {
    "sphere": _sphere,
    "hemisphere": _hemisphere,
    "cone": _cone,
    "supersphere": _supersphere,
    "supertorus": _supertorus,
    **{kind: _grid(kind) for kind in ("grid", "box", "cylinder", "ellipsoid")},
}


class Fit(NamedTuple):
    """A primitive that is fitted to a mesh.

    kind: of the primitive. inertia: the kind of the mesh's moments. in_box: True if the mesh's
    bounding box is fitted, not the box of its inertia. scale: the factor of the fitted sizes.
    """

    kind: str
    inertia: str
    in_box: bool
    scale: float

    def shape(self, surface: Surface) -> Shape:
        """Return the primitive in the mesh's axes. MeasureError if the mesh has no moments."""
        volume, center, second = mesh_moments(surface, self.inertia)
        spread, axes = np.linalg.eigh(second)
        axes = axes * (1.0, 1.0, np.sign(np.linalg.det(axes)))
        if self.in_box:
            points = (surface.points - center) @ axes
            low, high = points.min(axis=0), points.max(axis=0)
            center = center + axes @ (low + high) / 2.0
            halves = (high - low) / 2.0
            across = max(halves[:2])
            along = halves[2] - (across if self.kind == "capsule" else 0.0)
            radius = max(halves)
        else:
            # A box of half sides h has the mean squares h²/3.
            halves = np.sqrt(3.0 * np.maximum(spread, 0.0) / volume)
            across = halves[:2].mean()
            # MuJoCo shortens a capsule by half of its radius here, and by the whole above.
            along = halves[2] - (across / 2.0 if self.kind == "capsule" else 0.0)
            radius = halves.mean()
        sizes = {"sphere": [radius], "box": 2.0 * halves, "ellipsoid": halves}
        size = np.array(sizes.get(self.kind, [across, 2.0 * max(along, 0.0)])) * self.scale
        return Shape(self.kind, tuple(size.tolist()), Pose(center, axes))


def mesh_moments(surface: Surface, inertia: str) -> tuple[float, Array, Array]:
    """Return volume, (3,) center and (3, 3) second moments about it that MuJoCo gives a mesh; of
    its area if `inertia` is "shell".
    """
    if inertia == "convex":
        hull = convex_hull(surface.points)
        surface = Surface.from_triangles(hull.points, hull.triangles)
    if inertia != LEGACY:
        is_shell = inertia == "shell"
        of_volume, of_area = integrate(surface, 1, area=is_shell, area_moments=is_shell, exact=True)
        moments = (of_area if is_shell else of_volume).about_center()
        return float(moments.raw[0]), moments.about, moments.raw[SECOND_MOMENT_INDEX]
    corners = surface.points[surface.all_triangles()[0]].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    middle = (areas @ corners.mean(axis=1)) / areas.sum()
    # Pyramids over the faces count in full, also those outside: first to find the center, ...
    volumes = np.abs(np.linalg.det(corners - middle)) / 6.0
    center = middle + volumes @ ((corners - middle).sum(axis=1) / 4.0) / volumes.sum()
    # ... then from it.
    corners = corners - center
    volumes = np.abs(np.linalg.det(corners)) / 6.0
    # A tetrahedron of volume V with the corners 0, a, b, c and their sum s has the second moments
    # V (a aᵀ + b bᵀ + c cᵀ + s sᵀ)/20.
    sums = corners.sum(axis=1)
    second = np.einsum("n,nai,naj->ij", volumes, corners, corners) + (sums.T * volumes) @ sums
    return float(volumes.sum()), center, second / 20.0


class Weight(NamedTuple):
    """The mass that a geom states: kg, or kg/m³ (kg/m² of a shell) if `mass` is None.

    inertia: the kind of the moments of a mesh, "shell" or "" of a primitive.
    """

    mass: float | None
    density: float
    inertia: str

    def moments(self, shape: Shape) -> Moments | None:
        """Return the moments of the mass in the shape's own axes, kg; None if there is no mass."""
        if shape.surface is not None:
            body = second_moments(*mesh_moments(shape.surface, self.inertia))
        elif self.inertia == "shell":
            body = _shell_moments(shape)
        else:
            body = primitive_moments(shape)
        return self.fill(body)

    def fill(self, body: Moments) -> Moments | None:
        """Return the moments of the mass, kg, evenly in a body; None if there is no mass."""
        volume = float(body.raw[0])
        factor = self.density if self.mass is None else self.mass / volume
        return replace(body, raw=body.raw * factor) if factor * volume > LEAST_MASS else None


def _shell_moments(shape: Shape) -> Moments:
    """Return the moments of a primitive's surface, as the derivatives of those of its volume if all
    walls move outward.
    """
    # Growth of each size by the way of the walls: a length has a wall at both ends.
    walls = np.array(
        {"box": [2.0], "cylinder": [1.0, 2.0], "capsule": [1.0, 0.0]}.get(shape.kind, 1.0)
    )
    step = STEP * min(size for size in shape.size if size)
    moments = primitive_moments(shape)
    raw = np.zeros_like(moments.raw)
    for move, factor in STENCIL:
        size = np.array(shape.size) + move * step * walls
        raw += factor / (12.0 * step) * primitive_moments(replace(shape, size=tuple(size))).raw
    # The wall of an ellipsoid that grows is not equally thick; MuJoCo takes its moments
    # nevertheless, scaled to the area.
    if shape.kind == "ellipsoid":
        a, b, c = np.power(shape.size, THOMSEN)
        raw = raw * 4.0 * pi * ((a * b + b * c + c * a) / 3.0) ** (1.0 / THOMSEN) / raw[0]
    return replace(moments, raw=raw)
