# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls: the material between a surface and its offset, with moments that are polynomials in the
thickness.

With the directions d of its vertices (see `directions`), a triangle sweeps the prism x = p + s d,
both linear on the triangle, with Jacobian J = Σ λ_k N(s)·d_k, with N(s) = (e + s f) × (e' + s f')
the normal of the triangle moved by s, e, e' its edges and f, f' the differences of its directions.
J x^α is a polynomial of degree |α| + 2 in s and |α| + 1 in the barycentric coordinates λ, which six
nodes (Dunavant, Int. J. Numer. Methods Eng. 21, 1985) integrate exactly. Neighboring prisms share
the ruled surface over their edge, so that their sum is the wall, with no gap.

J is linear in λ, hence positive on a prism exactly if its three quadratics N(s)·d_k in s are: their
first roots are the thickness at which the offset folds over. Walls that run into each other far
along the surface are looked for separately, one thickness at a time; a volume that two share counts
twice.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..mesh import Surface, find_edges, sort_components
from ..moments.raw import (
    PAIRWISE_SUM_ROUNDINGS,
    Measure,
    Moments,
    U,
    monomial_count,
    monomial_index,
    monomials,
)
from ..numerics import Array, Integers, NDArray, check_type, connected_components, cross
from ..solid import classify_pairs, self_overlaps, surfaces_intersect
from ..verdict import MeasureError, check_size
from .directions import UNEVEN_RTOL, blocks, offset_directions, weld_equal
from .findings import WALL_PRECISION_LOST

ORDER = 3
COEFFICIENT_COUNT = ORDER + 3  # coefficients in s: degrees 0 to 5
TOUCHING_RTOL = 1e-6  # Relative to the size: nearer sides touch.
MAX_UNORIENTED_SHARE = (
    0.01  # Share of the area: above it, too many faces have lost their direction for a wall.
)
# Rounding of a Jacobian, in units u, relative to the product of the lengths in it.
JACOBIAN_ROUNDINGS = 20.0
INNER_NODES = (0.10810301816807023, 0.81684757298045851)
OUTER_NODES = (0.44594849091596489, 0.091576213509770743)
NODES = np.concatenate(
    [
        np.full((3, 3), outer) + (inner - outer) * np.eye(3)
        for inner, outer in zip(INNER_NODES, OUTER_NODES)
    ]
)
WEIGHTS = np.repeat([0.11169079483900573, 0.054975871827660933], 3)


@dataclass(frozen=True, eq=False)
class OffsetSolid:
    """The solid that a surface sweeps as it moves along its directions by s; its growth per s, as
    polynomials in s.

    points, vectors, triangles: (n, 3), (n, 3) and (m, 3), the moving surface and its directions.
    about: (3,) of the moments. coefficients, rounding_error, input_error: (20, 6) of s^0 to s^5 for
    each moment to third order, and bounds for either sign of s of the changes by rounding and by
    storing the points as float32. swept_bound, swept_rounding: (4,) of s^0 to s^3, bounds of the
    volume that a side, and the strip along the boundary, sweep if storing the points, or rounding,
    moves them. reach: (2, 3) of the points from `about` and of the vectors, by axis. outward,
    inward: the move at which the first prism folds over, infinite if none does; outward_at,
    inward_at: the triangles that fold first, or -1. inexact_vertices: vertices without a direction
    that moves all their faces alike; min_ratio, max_ratio: the thickness there, divided by the
    thickness asked for. degenerate_triangles: swept, but without a known normal.
    """

    points: Array
    vectors: Array
    triangles: Integers
    about: Array
    coefficients: Array
    rounding_error: Array
    input_error: Array
    swept_bound: Array
    swept_rounding: Array
    reach: Array
    outward: float
    inward: float
    outward_at: int
    inward_at: int
    inexact_vertices: int
    min_ratio: float
    max_ratio: float
    degenerate_triangles: int

    def moments(self, inward: float, outward: float) -> Moments:
        """Return a wall's volume moments to third order, about the middle of the surface's bounding
        box.
        """
        for move, limit in ((inward, self.inward), (outward, self.outward)):
            if not (move < limit or move == 0.0):
                raise ValueError("offset folds over")
        # The integrals of s^0 to s^5 over the moves outward and inward.
        degree = np.arange(1, COEFFICIENT_COUNT + 1)
        up = outward**degree / degree
        down = -((-inward) ** degree) / degree
        both = outward**degree / degree + inward**degree / degree
        raw = self.coefficients @ (up + down)
        error = self.rounding_error @ both + 16.0 * U * (np.abs(self.coefficients) @ both)
        # A second bound by storing: no point is farther from `about` than `reach`, by axis.
        swept = sum(self.swept_bound @ s ** np.arange(4) for s in (inward, outward))
        reach = self.reach[0] + max(inward, outward) * self.reach[1]
        moved = swept * np.multiply.reduce(reach ** monomials(ORDER), axis=1)
        return Moments(
            raw, self.about, Measure.VOLUME, error, np.minimum(self.input_error @ both, moved)
        )

    def box(self, inward: float, outward: float) -> tuple[Array, Array]:
        """Return the smallest and the largest coordinates of the wall, (3,) and (3,)."""
        sides = [self.points - inward * self.vectors, self.points + outward * self.vectors]
        return np.min(sides, axis=(0, 1)), np.max(sides, axis=(0, 1))

    def self_intersects(self, inward: float, outward: float) -> bool:
        """Return whether the wall's sides go through each other or themselves, or walls of separate
        parts overlap.
        """
        wall = self.surface(inward, outward)
        shell = np.repeat([0, 1], len(self.triangles))
        tolerance = min(
            TOUCHING_RTOL * float(np.ptp(wall.points, axis=0).max()), 1e-3 * (inward + outward)
        )
        pairs = [(0, 1), *((k, k) for k, moved in enumerate((inward, outward)) if moved)]
        return surfaces_intersect(
            wall.points,
            wall.triangles[: len(shell)],
            shell,
            np.array(pairs),
            np.tile(np.arange(len(self.points)), 2),
            tolerance,
        ) or self._overlaps(wall, tolerance)

    def surface(self, inward: float, outward: float) -> Surface:
        """Return the closed surface of a wall: its inner side, its outer side, and the strips
        along the boundary.
        """
        count = len(self.points)
        start, stop = find_edges(self.triangles).boundary_ends(self.triangles)
        triangles = [
            self.triangles[:, ::-1],
            self.triangles + count,
            np.stack([start, stop, stop + count], axis=1),
            np.stack([start, stop + count, start + count], axis=1),
        ]
        points = [self.points - inward * self.vectors, self.points + outward * self.vectors]
        return Surface(np.concatenate(points), np.concatenate(triangles))

    def _overlaps(self, wall: Surface, tolerance: float) -> bool:
        """Return whether walls of connected parts overlap each other or themselves, even without
        crossing edges.
        """
        part, number = connected_components(
            len(self.points), self.triangles.ravel(), np.roll(self.triangles, 1, axis=1).ravel()
        )
        # The wall has each point twice: at the inner side, and len(self.points) later at the outer.
        owner = part[wall.triangles[:, 0] % len(self.points)].astype(np.intp)
        shells = sort_components(wall.points, wall.triangles, owner, number)
        solid = shells.volume > 0.0
        if self_overlaps(wall.points, shells, solid, tolerance):
            return True
        relations = classify_pairs(wall.points, shells, solid, tolerance)
        return len(relations.contained_in) + len(relations.intersecting) > 0

    def drop_arrays(self) -> OffsetSolid:
        """Return the solid without the arrays that are as large as the mesh."""
        return replace(
            self, points=self.points[:0], vectors=self.vectors[:0], triangles=self.triangles[:0]
        )

    def first_fold_location(self, side: str) -> Array:
        """Return the (3,) middle of the triangle that folds first. side: "inward", "outward" or
        "centered".
        """
        is_inward = side == "inward" or side == "centered" and self.inward < self.outward
        triangle = self.inward_at if is_inward else self.outward_at
        return self.points[self.triangles[triangle]].mean(axis=0)

    def max_thickness(self, side: str) -> float:
        """Return the thickness from which the wall on that side folds over: "inward", "outward" or
        "centered".
        """
        return {
            "inward": self.inward,
            "outward": self.outward,
            "centered": 2.0 * min(self.inward, self.outward),
        }[side]


def split_thickness(side: str, thickness: float) -> tuple[float, float]:
    """Return the parts of a thickness inside and outside the surface. side: "inward", "outward" or
    "centered".
    """
    share = {"inward": 1.0, "outward": 0.0, "centered": 0.5}[side]
    return thickness * share, thickness * (1.0 - share)


def offset_solid(surface: Surface) -> OffsetSolid:
    """Return the walls of a surface, as polynomials in their thickness.

    Parameters
    ----------
    surface : Surface
        Closed or open; its faces must agree which side is outward. Points at exactly the same place
        are one.

    Returns
    -------
    OffsetSolid

    Raises
    ------
    MeasureError
        If faces disagree, more than two meet in an edge, none has an area, or float32 has lost
        their directions; the finding's edges are pairs of the surface's vertices.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.wall import offset_solid
    >>> cube = Surface(
    ...     np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]),
    ...     quads=np.array(
    ...         [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    ...     ),
    ... )
    >>> wall = offset_solid(cube)
    >>> round(wall.moments(0.1, 0.0).total, 9), round(float(wall.max_thickness("inward")), 5)
    (0.488, 0.5)
    """
    check_type("surface", surface, Surface)
    points, triangles = weld_equal(surface)
    stored = float(np.linalg.norm(surface.coordinate_error))
    low, high = points.min(axis=0), points.max(axis=0)
    check_size(*(high - low).tolist())
    about = low / 2.0 + high / 2.0
    directions = offset_directions(points, triangles, stored)
    vectors = directions.vectors
    # By axis, the farthest point from `about`, up to rounding, and the longest direction.
    point_reach = np.abs(points - about).max(axis=0) * (1.0 + 4.0 * U)
    vector_reach = np.abs(vectors).max(axis=0)
    sums = np.zeros((20, COEFFICIENT_COUNT))
    bounds = np.zeros((3, 7))
    swept_rounding = np.zeros(4)
    swept_bound = np.zeros(4)
    jacobians, jacobian_errors, doubled_areas = [], [], []
    # How far rounding moves a point, and a direction: some 4 units of the largest coordinates.
    rounded = 4.0 * U * float(np.linalg.norm(point_reach))
    turned = 4.0 * U * float(np.linalg.norm(vector_reach))
    for part, is_known in zip(blocks(triangles), blocks(directions.has_normal)):
        prisms = _Prisms(points[part], about, vectors[part])
        sums += prisms.sums()
        # (2, k) of each triangle's worst corner, by rounding and by storing.
        slide = directions.tangential_error[:, part].max(axis=2)
        lift = directions.normal_error[:, part].max(axis=2)
        if stored:
            # A triangle without a known normal moved by up to `far`, and should have moved by 1.
            lift[1] += np.where(is_known, 0.0, 1.0 + prisms.far)
        bounds += prisms.bounds(slide, lift, stored)
        swept_rounding += prisms.swept(slide[0] + turned, lift[0] + turned, rounded)
        swept_bound += prisms.swept(slide[1], lift[1], stored)
        jacobians.append(prisms.jacobians)
        jacobian_errors.append(JACOBIAN_ROUNDINGS * U * prisms.sizes())
        doubled_areas.append(prisms.double)
    jacobian = np.concatenate(jacobians, axis=-1)
    jacobian_error = np.concatenate(jacobian_errors, axis=-1)
    double = np.concatenate(doubled_areas)
    solid = directions.has_normal
    lost = float(double[~solid].sum())
    total = float(double.sum())
    if stored and lost > MAX_UNORIENTED_SHARE * total:
        raise MeasureError(WALL_PRECISION_LOST, share=lost / total)
    solid_triangles = np.flatnonzero(solid)
    # Inward is the same way with the sign of s, and so that of the odd coefficients, changed.
    outward, inward = (
        first_positive_root(jacobian[:, :, solid] * signs[:, None, None], jacobian_error[:, solid])
        for signs in (np.array([1.0, 1.0, 1.0]), np.array([1.0, -1.0, 1.0]))
    )
    height = jacobian[0, :, solid] / double[solid, None]
    uneven = np.abs(height - 1.0) > UNEVEN_RTOL
    error, moved = _propagate_error(bounds, point_reach + stored, vector_reach, len(jacobians))
    slides = directions.tangential_error.max(axis=1) + directions.normal_error.max(axis=1)
    swept_rounding += _swept_by_strips(
        points, vectors, triangles, rounded, slides[0] + 2.0 * turned
    )
    swept_bound += _swept_by_strips(points, vectors, triangles, stored, slides[1])

    def first_fold(limits: NDArray) -> int:
        """Return the triangle with the least of the solid triangles' limits, -1 if none folds."""
        if not np.isfinite(limits.min(initial=np.inf)):
            return -1
        return int(solid_triangles[np.argmin(limits)])

    return OffsetSolid(
        points=points,
        vectors=vectors,
        triangles=triangles,
        about=about,
        coefficients=sums,
        rounding_error=error,
        input_error=moved,
        swept_bound=swept_bound,
        swept_rounding=swept_rounding,
        reach=np.array([point_reach, vector_reach]),
        outward=outward.min(initial=np.inf),
        inward=inward.min(initial=np.inf),
        outward_at=first_fold(outward),
        inward_at=first_fold(inward),
        inexact_vertices=len(np.unique(triangles[solid][uneven])),
        min_ratio=height.min(initial=1.0),
        max_ratio=height.max(initial=1.0),
        degenerate_triangles=int(np.count_nonzero(~solid)),
    )


class _Prisms:
    """Prisms swept by (m, 3, 3) corners along their (m, 3, 3) directions; columns are prisms.

    `double`, `long`, `turned_length`, `far`: (m,) doubled areas, and the largest lengths of edges,
    of changes of edges per s, and of directions.
    """

    def __init__(self, points: NDArray, about: NDArray, vectors: NDArray):
        a, b, c = points.transpose(1, 2, 0)  # corner, axis, prism
        u, v, w = self.vectors = vectors.transpose(1, 2, 0)
        self.points = points.transpose(1, 2, 0) - about[:, None]
        self.edges = (b - a, c - a)
        self.turns = (v - u, w - u)
        # N(s) = (e + s f) × (e' + s f'), by powers of s
        plain, plain_turned, turned_plain, turned = (
            np.stack(cross(first, second)) for first in (b - a, v - u) for second in (c - a, w - u)
        )
        self.normals = plain, plain_turned + turned_plain, turned
        # N(s)·d_k. Axes: power of s, corner, prism.
        self.jacobians = np.array(
            [
                [np.einsum("im,im->m", normal, vector) for vector in self.vectors]
                for normal in self.normals
            ]
        )
        self.double = np.sqrt(np.einsum("im,im->m", self.normals[0], self.normals[0]))
        self.long, self.turned_length, self.far = (
            np.sqrt(np.max([np.einsum("im,im->m", row, row) for row in vectors_by_axis], axis=0))
            for vectors_by_axis in (self.edges, self.turns, self.vectors)
        )

    def sizes(self) -> Array:
        """Return (3, m) bounds of the coefficients of J: products of the lengths in them."""
        return (
            np.array([self.long**2, 2.0 * self.long * self.turned_length, self.turned_length**2])
            * self.far
        )

    def sums(self) -> Array:
        """Return the (20, 6) coefficients of the moments, in the order of `monomials`.

        The table has J x^α at all nodes, (|α| + 3, nodes), by powers of s: J x^β times x + s d.
        """
        sums = np.zeros((monomial_count(ORDER), COEFFICIENT_COUNT))
        count = self.points.shape[2]
        place, step = (
            np.einsum("nk,kim->inm", NODES, corners).reshape(3, 6 * count)
            for corners in (self.points, self.vectors)
        )
        table = {
            (0, 0, 0): (np.einsum("nk,pkm->pnm", NODES, self.jacobians) * WEIGHTS[:, None]).reshape(
                3, 6 * count
            )
        }
        for exponents in map(tuple, monomials(ORDER).tolist()):
            if exponents not in table:
                axis = next(i for i in range(3) if exponents[i])
                lower = table[tuple(n - (i == axis) for i, n in enumerate(exponents))]
                product = np.zeros((len(lower) + 1, 6 * count))
                np.multiply(lower, place[axis], out=product[:-1])
                product[1:] += lower * step[axis]
                table[exponents] = product
            values = np.add.reduce(table[exponents], axis=1)
            sums[monomial_index(*exponents), : len(values)] = values
        return sums

    def bounds(self, tangential_error: NDArray, normal_error: NDArray, stored: float) -> Array:
        """Return (3, 7) first-order bounds, as coefficients in s, of integrals over all prisms: of
        |J|, of its changes by rounding, and of its changes by storing.

        Columns: three coefficients of |J|, or of the change of J; four of |J| times the move of x,
        zero in the first row. tangential_error, normal_error: (2, m) moves of the directions d, in
        all and along the normal, by rounding and by storing; storing also moves points by `stored`.

        Ends that move by ε change an edge e of J = (e + s f) × (e' + s f')·d by 2 ε, and f by twice
        the move δ of the directions. Either of both edges may change: hence 4 ε and 4 δ. The change
        of d itself counts N(s)·δ: at s = 0 by the normal part of δ, else by |N(s)| |δ|. x = p + s d
        moves by ε + s δ. A triangle of the nodes has the area 1/2.
        """
        sizes = self.sizes()
        coefficients = [np.pad(sizes, ((0, 4), (0, 0)))]
        long = self.long
        turned = self.turned_length
        far = self.far
        flat = self.double * far  # sharper than sizes[0]
        for slide, lift, step in zip(tangential_error, normal_error, (0.0, stored)):
            change = [
                4.0 * long * step * far + self.double * lift,
                (4.0 * turned * step + 4.0 * long * slide) * far + 2.0 * long * turned * slide,
                4.0 * turned * slide * far + turned**2 * slide,
            ]
            place = [
                flat * step,
                flat * slide + sizes[1] * step,
                sizes[1] * slide + sizes[2] * step,
                sizes[2] * slide,
            ]
            coefficients.append(np.array(change + place))
        return np.add.reduce(np.array(coefficients), axis=2) / 2.0

    def swept(self, tangential_error: NDArray, normal_error: NDArray, stored: float) -> Array:
        """Return (4,) coefficients in s of a bound of the volume that one side sweeps: as its
        points move by `stored`, and its directions by (m,) errors, in all and along the normals.

        A triangle sweeps half of N(s) times its move. The move of the directions counts by the part
        of N(s) along the normal at s = 0, and by the rest.
        """
        unit = self.normals[0] / np.where(self.double > 0.0, self.double, 1.0)
        height = [np.einsum("im,im->m", normal, unit) for normal in self.normals]
        rest = [normal - part * unit for normal, part in zip(self.normals, height)]
        along = np.abs(height)
        size, across = (
            [np.sqrt(np.einsum("im,im->m", vector, vector)) for vector in vectors]
            for vectors in (self.normals, rest)
        )
        # The rest is a difference of near equals: some 8 roundings.
        across = [a + 8.0 * U * b for a, b in zip(across, size)]
        coefficients = [
            2.0 * size[0] * stored,  # twice the first order, as a margin
            size[1] * stored + size[0] * normal_error,
            size[2] * stored + along[1] * normal_error + across[1] * tangential_error,
            along[2] * normal_error + across[2] * tangential_error,
        ]
        return np.add.reduce(np.array(coefficients), axis=1) / 2.0


def _swept_by_strips(
    points: NDArray, vectors: NDArray, triangles: NDArray, stored: float, slide: float
) -> Array:
    """Return (4,) coefficients in s of the volume that the strips along the boundary sweep, if
    points move by `stored` and directions by `slide`, both lengths.

    A strip of the length of its side is `far` wide per s.
    """
    start, stop = find_edges(triangles).boundary_ends(triangles)
    ends = [np.linalg.norm(array[stop] - array[start], axis=1) for array in (points, vectors)]
    far = np.maximum(*(np.linalg.norm(vectors[end], axis=1) for end in (start, stop)))
    long, turned = (float((end * far).sum()) for end in ends)
    return np.array([0.0, long * stored, turned * stored + long * slide, turned * slide])


def _propagate_error(
    bounds: NDArray, point_reach: NDArray, vector_reach: NDArray, blocks: int
) -> tuple[Array, Array]:
    """Return (20, 6) and (20, 6) `rounding_error` and `input_error` of the moments' coefficients.

    bounds: sums of `_Prisms.bounds` over `blocks` blocks. point_reach, vector_reach: (3,) largest
    |p - about| and |d| by axis. J x^α changes by the change of J times x^α, and by J times the move
    of x times Σ α_i x^(α - e_i).
    """

    def times(row: NDArray, exponents: list[int]) -> Array:
        """Return the coefficients in s of a row's polynomial times the largest |x^α|."""
        for axis, power in enumerate(exponents):
            for _ in range(power):
                row = np.convolve(row, (point_reach[axis], vector_reach[axis]))
        return row

    error, moved = np.zeros((2, monomial_count(ORDER), COEFFICIENT_COUNT))
    for i, exponents in enumerate(monomials(ORDER).tolist()):
        degree = sum(exponents)
        rounded = (JACOBIAN_ROUNDINGS + 8.0 * degree + PAIRWISE_SUM_ROUNDINGS + blocks) * U
        error[i, : degree + 3] = times(rounded * bounds[0, :3], exponents)
        for target, row in ((error, bounds[1]), (moved, bounds[2])):
            target[i, : degree + 3] += times(row[:3], exponents)
            for axis, power in enumerate(exponents):
                if power:
                    lower = [n - (k == axis) for k, n in enumerate(exponents)]
                    target[i, : degree + 3] += power * times(row[3:], lower)
    return error, moved


def first_positive_root(jacobian: NDArray, error: NDArray) -> Array:
    """Return (m,) the s up to which three quadratics, a y² + b y + c with y = 1 / s, are certainly
    positive.

    jacobian: (3, 3, m) their a, b and c; error: (3, m) bounds of their rounding. Discriminants that
    rounding may have made negative are zero.
    """
    a, b, c = jacobian - error[:, None]
    size = b * b + np.abs(4.0 * a * c)
    discriminant = b * b - 4.0 * a * c
    is_real = discriminant >= -16.0 * U * size
    root = np.sqrt(np.maximum(discriminant, 0.0) + 16.0 * U * size)
    with np.errstate(divide="ignore", invalid="ignore"):
        # Of both forms of the larger root in y, the one without a difference of near equals.
        largest = np.where(b > 0.0, -2.0 * c / (b + root), (root - b) / (2.0 * a))
        largest = np.where(is_real & (largest > 0.0), largest, 0.0)
        largest = np.where(a > 0.0, largest, np.inf)  # else not positive at s = 0
        return (1.0 / largest).min(axis=0) * (1.0 - 16.0 * U)
