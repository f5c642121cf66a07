# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The polygons of one body as arrays: the result of every reader and the input of every
measurement.

Quads stay quads, because two triangles that share a diagonal cost less than two loose ones. They
are cut along the diagonal that Blender draws, so that the body measured is the body seen.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..numerics import (
    Array,
    ArrayLike,
    Floats,
    Index,
    Integers,
    Mask,
    NDArray,
    cross,
    cross_rows,
    dot,
    float_array,
    has_form,
    index_array,
    lengths,
    number_array,
)

NO_TRIANGLES = np.empty((0, 3), np.int32)
NO_QUADS = np.empty((0, 4), np.int32)
NEXT_CORNER = [1, 2, 3, 0]
HALVES = [0, 1, 2, 0, 2, 3]  # corners of a quad's triangles
POINT_TYPES = (np.dtype(np.float32), np.dtype(np.float64))
INDEX_TYPES = (np.dtype(np.int32), np.dtype(np.int64))
INDEX_SHAPES = {
    "triangles": ("m", 3),
    "quads": ("q", 4),
    "triangle_faces": ("m",),
    "quad_faces": ("q",),
    "corner_vertices": ("c",),
    "corner_edges": ("c",),
}


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles and quads over shared points, counter-clockwise from outside.

    Parameters
    ----------
    points : (n, 3) float32 or float64 array
        In the surface's own coordinates and unit.
    triangles : (m, 3) integer array
        Vertex indices: the triangular faces and Blender's tessellation of n-gons.
    quads : (q, 4) integer array
        Vertex indices in corner order; cut into triangles as `flipped_quads` decides.
    triangle_faces, quad_faces : integer arrays, optional
        The mesh face that each row belongs to; None if face i is row i.
    corner_vertices, corner_edges : (c,) integer arrays, optional
        The mesh's own corners, and the edge from each one to the next. They prove closedness
        without sorting.
    displacement : (3,) array, optional
        See `coordinate_error`.

    Examples
    --------
    >>> from body_moments.core import Surface
    >>> cube = Surface(
    ...     np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]),
    ...     quads=np.array(
    ...         [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    ...     ),
    ... )
    >>> cube.box[1].tolist(), len(cube.all_triangles()[0])
    ([1.0, 1.0, 1.0], 12)
    """

    points: Floats
    triangles: Integers = field(default_factory=NO_TRIANGLES.view)
    quads: Integers = field(default_factory=NO_QUADS.view)
    triangle_faces: Integers | None = None
    quad_faces: Integers | None = None
    corner_vertices: Integers | None = None
    corner_edges: Integers | None = None
    displacement: Array | None = None

    def __post_init__(self) -> None:
        if not has_form(self.points, POINT_TYPES, (3,)):
            points = number_array("points", self.points, "n", 3)
            # float32 from files, in either byte order, stays float32: its rounding counts. Other
            # numbers become float64.
            kind = np.float32 if points.dtype.newbyteorder("=") == np.float32 else np.float64
            object.__setattr__(self, "points", points.astype(kind, copy=False))
        for name, shape in INDEX_SHAPES.items():
            values = getattr(self, name)
            if values is not None and not has_form(values, INDEX_TYPES, shape[1:]):
                indices = index_array(name, values, *shape)
                # Numbers of faces, edges and vertices are added to others, which must neither
                # overflow nor round.
                kind = indices.dtype if indices.dtype in INDEX_TYPES else np.int64
                object.__setattr__(self, name, indices.astype(kind, copy=False))
        if self.displacement is not None:
            object.__setattr__(
                self, "displacement", float_array("displacement", self.displacement, 3)
            )

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Smallest and largest coordinates of the points, (3,) each, unused points included; NaN if
        any is NaN.
        """
        # Reducing (n, 3) rows would take numpy twenty times as long.
        rows = np.ascontiguousarray(self.points.T)
        return np.minimum.reduce(rows, axis=1).astype(np.float64), np.maximum.reduce(
            rows, axis=1
        ).astype(np.float64)

    @cached_property
    def coordinate_error(self) -> Array:
        """The (3,) bounds of the points' shift by storing: half an ulp of the largest float32
        coordinate by axis.

        `displacement` holds it for points that were float32 before; otherwise it is zero for
        float64 points.
        """
        if self.displacement is not None:
            return self.displacement
        if self.points.dtype != np.float32 or not len(self.points):
            return np.zeros(3)
        low, high = self.box
        return half_ulp(np.maximum(high, -low))

    @cached_property
    def content(self) -> tuple[tuple[str, bytes] | None, ...]:
        """All arrays as bytes; equal for surfaces of equal numbers."""
        arrays = [getattr(self, name) for name in ("points", "displacement", *INDEX_SHAPES)]
        return tuple(
            [None if array is None else (array.dtype.char, array.tobytes()) for array in arrays]
        )

    @cached_property
    def digest(self) -> bytes:
        """A digest of the points and faces."""
        digest = hashlib.blake2b(digest_size=16)
        for array in (self.points, self.triangles, self.quads):
            digest.update(np.ascontiguousarray(array).data)
            digest.update(repr(array.shape).encode())
        return digest.digest()

    @property
    def triangle_count(self) -> int:
        """The number of triangles, two for each quad."""
        return len(self.triangles) + 2 * len(self.quads)

    def used_points(self) -> Floats:
        """Return the (k, 3) points that are corners of faces."""
        return keep_used(self.points, self.all_triangles()[0])[0]

    def transform(self, linear: ArrayLike, offset: ArrayLike = (0.0, 0.0, 0.0)) -> Surface:
        """Map the points by (3, 3) `linear` @ x + (3,) `offset` in float64; the surface is then one
        of triangles alone.

        A mirroring map reverses the faces, so that outward stays outward; the diagonals stay as
        Blender drew them.
        """
        rows = float_array("linear", linear, 3, 3)
        offset = float_array("offset", offset, 3)
        x, y, z = self.points.T.astype(np.float64)
        points = np.stack(
            [a[0] * x + a[1] * y + a[2] * z + t for a, t in zip(rows, offset)], axis=1
        )
        triangles, faces = self.all_triangles()
        if np.linalg.det(rows) < 0.0:
            triangles = triangles[:, ::-1]
        return replace(
            self,
            points=points,
            triangles=triangles,
            triangle_faces=faces,
            quads=NO_QUADS,
            quad_faces=None,
            displacement=np.abs(rows) @ self.coordinate_error,
        )

    @classmethod
    def from_triangles(cls, points: ArrayLike, triangles: ArrayLike) -> Surface:
        """Make a surface of (m, 3) triangles, counter-clockwise from outside, over (n, 3) points,
        float32 or float64.

        ValueError if the shapes or types differ, or an index has no point.
        """
        points = number_array("points", points, "n", 3)
        return cls(points, index_array("triangles", triangles, "m", 3, count=len(points)))

    def all_triangles(self) -> tuple[Integers, Integers]:
        """Return (m + 2q, 3) triangles with the quads cut as drawn, and the (m + 2q,) face of
        each.
        """
        quad_faces, faces = face_of_each(self)
        if not len(self.quads):
            return self.triangles, faces
        cut = turned_quads(self.points, self.quads)[:, HALVES].reshape(-1, 3)
        return np.concatenate([self.triangles, cut]), np.concatenate(
            [faces, np.repeat(quad_faces, 2)]
        )


def face_of_each(surface: Surface) -> tuple[Integers, Integers]:
    """Return the mesh face of each quad and of each triangle."""
    return (
        np.arange(len(surface.quads)) if surface.quad_faces is None else surface.quad_faces,
        np.arange(len(surface.triangles))
        if surface.triangle_faces is None
        else surface.triangle_faces,
    )


def normals(points: Floats, triangles: Integers) -> Array:
    """Return (m, 3) normals of triangles, each twice as long as its triangle's area."""
    a, b, c = (points[triangles[:, k]].astype(np.float64, copy=False) for k in range(3))
    return cross_rows(b - a, c - a)


def triangle_areas(points: Floats, triangles: Integers) -> Array:
    """Return (m,) areas of triangles."""
    return 0.5 * lengths(normals(points, triangles))[:, 0]


def keep_used(points: NDArray, triangles: Integers) -> tuple[NDArray, Index]:
    """Return the (k, 3) points that are corners of (t, 3) triangles, and the triangles over
    these.
    """
    used = np.zeros(len(points), bool)
    used[triangles] = True
    return points[used], (np.cumsum(used) - 1)[triangles]


def join_surfaces(surfaces: Sequence[Surface]) -> Surface:
    """Join surfaces, in the same coordinates, into one of float64 triangles; the numbers of their
    faces continue.
    """
    points = []
    triangles = []
    faces = []
    first_point = 0
    first_face = 0
    for surface in surfaces:
        own_triangles, own_faces = surface.all_triangles()
        points.append(surface.points.astype(np.float64))
        triangles.append(own_triangles + first_point)
        faces.append(own_faces + first_face)
        first_point = first_point + len(surface.points)
        first_face = first_face + int(own_faces.max(initial=-1)) + 1
    return Surface(
        np.concatenate(points),
        np.concatenate(triangles),
        triangle_faces=np.concatenate(faces),
        displacement=np.max([surface.coordinate_error for surface in surfaces], axis=0),
    )


def half_ulp(largest: Array) -> Array:
    """Return half an ulp of float32 numbers.

    From 2^127 on it is that of 2^127, which stays finite.
    """
    return np.spacing(np.minimum(largest, 2.0**127).astype(np.float32)).astype(np.float64) / 2.0


def turned_quads(points: NDArray, quads: NDArray) -> NDArray:
    """Return (q, 4) quads turned so that Blender cuts them from their first corners to their third:
    into `HALVES`.
    """
    return np.where(flipped_quads(points, quads)[:, None], quads.take(NEXT_CORNER, 1), quads)


def flipped_quads(points: NDArray, quads: NDArray) -> Mask:
    """Return a (q,) mask of quads that Blender (is_quad_flip_v3_first_third_fast) cuts from the
    second corner on.
    """
    return has_flipped_corners(*(points[quads[:, i]].T for i in range(4)))


def has_flipped_corners(a: NDArray, b: NDArray, c: NDArray, d: NDArray) -> Mask:
    """Return the mask of `flipped_quads` from the coordinates of corners, (3, q) each."""
    with np.errstate(over="ignore", invalid="ignore"):
        a, b, c, d = (corner.astype(np.float32, copy=False) for corner in (a, b, c, d))
        diagonal = c - a
        return dot(cross(b - a, diagonal), cross(d - a, diagonal)) > 0.0
