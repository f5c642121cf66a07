# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume and area moments of triangles and quads, to third order, with rigorous bounds of their
errors: of one mesh of any size, and of stacks of small ones.

The divergence theorem turns a body into cones from a reference point over its faces. Over the cone
on a triangle a, b, c with determinant w = a·((b-a) x (c-a)) a monomial f of degree n integrates to
w / (2n + 6) · E[f], where E[f] is its mean over the triangle; over the triangle itself to half its
doubled area times E[f] (Sheynin and Tuzikov 2001). With q = a + c, Z = w (q + 2 b) and
H = w (a a' + c c' + 2 b b'),

    24 ∫ x = w (a + b + c),   120 ∫ x x' = H + (q Z' + Z q') / 2,
    288 ∫ x x' x'' = q H + the same for the other two orders of the indices,

but for the third moments about the middle q / 2 of the edge a, c. With e = c - a and f = 2 b - q
these are w / 2880 (f (f f' + e e') + the other two orders), of the order of an edge cubed: unless
`exact`, large meshes leave them out and add their bound to `rounding_error`. No sum cancels if all
weights are positive.

Edges are taken before the reference point is subtracted, so that a determinant's error is relative
to the product of its edges. With u = 2^-53, edges e and e' and vertices within `reach` of the
reference point, a determinant is off by at most 9 u reach·τ, where τ_x = |e_y e'_z| + |e_z e'_y|
bounds |normal_x|. Small bodies are summed in stacks, a large one in blocks whose arrays stay in the
cache, and whose parts have a bound of their edges each.

Triangles a, b, c and a, c, d with a common base a, c and determinants v and w share its terms: with
u = v + w, Z = u q + 2 (v b + w d) and H = u (a a' + c c') + 2 (v b b' + w d d').
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from ..mesh import PlanarityAccumulator, Surface
from ..moments import (
    PAIRWISE_SUM_ROUNDINGS,
    Measure,
    Moments,
    U,
    monomial_count,
    monomials,
    unchecked_moments,
)
from ..numerics import (
    NEXT_AXIS,
    PREVIOUS_AXIS,
    Array,
    Index,
    NDArray,
    batches,
    indices_in_range,
    segment_starts,
)
from ..verdict import check_size
from .faces import NO_VERTEX, Faces, box_center, face_blocks, finite_box

# Up to this number of triangles the third order is always exact, which takes half as long again.
MAX_TRIANGLES_EXACT_THIRD = 100_000
MAX_SMALL_TRIANGLES = 1024  # triangles of a body in a stack
FACES_PER_BLOCK = 5120  # faces whose products stay in the cache
FACES_PER_PART = 1024  # faces of a block with one bound of their edges
SLICES = 32  # slices of a block, whose products are added up
# Triangles that are worth a thread: with fewer, calls are short, and wait for the interpreter.
MIN_TRIANGLES_PER_THREAD = 250_000
# Reaches beyond this, or below its inverse, are scaled, so that a product of six does not overflow
# or vanish.
MAX_UNSCALED_REACH = 2.0**100
EXPONENTS = monomials(3)
DEGREE = EXPONENTS.sum(axis=1)
# Factors of each monomial, as indices of 1, x, y, z.
MONOMIAL_FACTORS = np.sort(
    [[0] * (3 - p - q - r) + [1] * p + [2] * q + [3] * r for p, q, r in EXPONENTS]
)
DIVISORS = np.array([6.0, 24.0, 120.0, 288.0])[DEGREE]  # divide the sums below
# errors of the products of weights and nodes, in units of rounding
PRODUCT_ROUNDINGS = 8.0 * DEGREE
# the third moments about the middles come to as much again at most
THIRD_ORDER_SHARE = np.repeat([1.0, 2.0], 10)
CONE_DIVISORS = 2.0 * DEGREE + 6.0  # ∫ f over a cone is w E[f] / this
AREA_FACTORS = DEGREE + 3.0  # ∫ f over a triangle is (doubled area E[f]) / 2, this much more
TRIPLES = [(i, j, k) for i in range(3) for j in range(i, 3) for k in range(j, 3)]
PAIR_INDEX = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])
# Indices, in a table of x, y, z times xx, xy, xz, yy, yz, zz, x, y, z, of the terms of the
# symmetric products: two of each xx, xy, ... and three of each xxx, xxy, ...
SQUARE = np.array([[9 * i + 6 + j, 9 * j + 6 + i] for i in range(3) for j in range(i, 3)]).T
CUBE = np.array(
    [
        [9 * i + PAIR_INDEX[j, k], 9 * j + PAIR_INDEX[i, k], 9 * k + PAIR_INDEX[i, j]]
        for i, j, k in TRIPLES
    ]
).T
LOCAL_CUBE = CUBE - CUBE // 9 * 3  # in a table without x, y, z

# Sums of s segments: (s, 20) Σ w f, which `DIVISORS` turn into moments; the same with doubled
# areas, or (s, 0); (s, 3) largest components of b-a and of c-a; (s, 2) Σ |w| and Σ doubled area.
_Sums = tuple[Array, ...]


def integrate(
    surface: Surface,
    threads: int,
    *,
    area: bool,
    area_moments: bool,
    exact: bool,
    about: NDArray | None = None,
    planarity: PlanarityAccumulator | None = None,
) -> tuple[Moments, Moments]:
    """Return the moments of the volume to third order; and the area if `area`, its moments if
    `area_moments`.
    """
    count = surface.triangle_count
    if not count:
        return nothing(3, about)
    points = np.ascontiguousarray(surface.points)
    if points.dtype != np.float32:
        points = points.astype(np.float64, copy=False)
    low, high = finite_box(surface)
    center = box_center(low, high, points.dtype) if about is None else np.asarray(about, np.float64)
    reach = np.maximum(high - center, center - low) * (1.0 + 4.0 * U)
    largest = max(reach.tolist())
    check_size(4.0 * largest)  # the diagonal of the box is shorter
    if largest and not 1.0 / MAX_UNSCALED_REACH < largest < MAX_UNSCALED_REACH:
        return _measure_rescaled(
            surface, int(np.log2(largest)), threads, about, area, area_moments, exact
        )
    for faces in (surface.triangles, surface.quads):
        if not indices_in_range(faces, len(points)):
            raise ValueError(NO_VERTEX)
    if count <= MAX_SMALL_TRIANGLES:
        volume, areas = small_moments(
            points,
            surface.all_triangles()[0],
            np.array([count]),
            center[None],
            reach[None],
            surface.coordinate_error[None],
            area=area,
            area_moments=area_moments,
        )
        return volume.at(0), areas.at(0)
    exact = exact or count <= MAX_TRIANGLES_EXACT_THIRD
    coordinates = np.ascontiguousarray(points.T)

    def sum_block(block: tuple[int, NDArray]) -> _Sums:
        """Return the sums of a block of faces, and report their planarity."""
        start, rows = block
        faces = Faces.gather(coordinates, rows)
        lengths = faces.lengths() if area else None
        if planarity is not None:
            if rows.shape[1] == 4:
                _report_quads(planarity, start, faces)
            elif lengths is not None:
                planarity.add_triangles(start, lengths.T.ravel())
        face_count = faces.corners.shape[2]
        starts = np.arange(0, face_count, FACES_PER_PART)
        counts = np.minimum(face_count - starts, FACES_PER_PART)
        return _face_sums(
            faces, lengths, center[:, None], starts, counts, True, area_moments, exact
        )

    blocks = list(face_blocks(surface, FACES_PER_BLOCK))
    threads = min(threads, count // MIN_TRIANGLES_PER_THREAD)
    if threads > 1:
        with ThreadPoolExecutor(threads) as pool:
            sums = list(pool.map(sum_block, blocks))
    else:
        sums = [sum_block(block) for block in blocks]
    volume, areas = _moments(
        sums,
        np.zeros(1, np.intp),
        center[None],
        reach[None],
        surface.coordinate_error[None],
        area=area,
        area_moments=area_moments,
        exact=exact,
    )
    return volume.at(0), areas.at(0)


def _report_quads(planarity: PlanarityAccumulator, start: int, quads: Faces) -> None:
    """Report the normals and the tetrahedra of quads, which are the rows from `start` on."""
    normal = np.add.reduce(quads.normals, axis=1)
    tetrahedra = np.abs(np.einsum("it,it->t", quads.normals[:, 0], quads.edges[:, 2]))
    planarity.add_quads(start, np.sqrt(np.einsum("it,it->t", normal, normal)), tetrahedra)


def small_moments(
    points: NDArray,
    triangles: NDArray[np.integer],
    counts: NDArray[np.integer],
    center: Array,
    reach: Array,
    half_ulp: Array,
    *,
    area: bool,
    area_moments: bool,
) -> tuple[Moments, Moments]:
    """Return stacked volumes and areas of n bodies.

    Triangles are sorted by body, at least one each. reach: (n, 3) largest distances of points from
    `center`. half_ulp: (n, 3) their shifts by storage. Without `area` the areas are zero, and the
    `input_error` is larger. A body's sums are the same to the bit for any neighbors.
    """
    coordinates = np.ascontiguousarray(points.T)
    ends = np.cumsum(counts)
    sums = []
    for part in batches(counts, FACES_PER_BLOCK):
        rows = triangles[ends[part.start] - counts[part.start] : ends[part.stop - 1]]
        corners = coordinates.take(rows.T, axis=1).astype(np.float64, copy=False)
        block = Faces(corners)
        lengths = block.lengths() if area else None
        number = counts[part]
        middle = np.repeat(center[part].T, number, axis=1)
        starts = segment_starts(number)
        sums.append(_face_sums(block, lengths, middle, starts, number, False, area_moments, True))
    return _moments(
        sums,
        np.arange(len(counts)),
        center,
        reach,
        half_ulp,
        area=area,
        area_moments=area_moments,
        exact=True,
    )


def _face_sums(
    faces: Faces,
    lengths: Array | None,
    middle: Array,
    starts: Index,
    counts: NDArray[np.integer],
    is_joint: bool,
    area_moments: bool,
    exact: bool,
) -> _Sums:
    """Return the sums of faces, whose corners are overwritten. lengths: doubled areas, (f, t).

    middle: (3, 1 or t) reference points. starts, counts: (s,) first face and number of faces of the
    parts, of one body if `is_joint`, else of a body each. The names are those of the module's
    formulas.
    """
    edges = faces.edges
    nodes = np.subtract(faces.corners, middle[:, None], faces.corners)  # a, b, c, perhaps d
    det = np.einsum("ift,it->ft", faces.normals, nodes[:, 0])
    lengths = np.zeros(det.shape) if lengths is None else lengths
    apexes = nodes[:, 1::2]  # b, perhaps d
    q = nodes[:, 0] + nodes[:, 2]
    f = f_and_e = np.empty(0)
    if exact:
        f = 2.0 * apexes - q[:, None]
        e = edges[:, 1]
        f_and_e = np.empty((6, *det.shape))  # f f' + e e', as xx, xy, xz, yy, yz, zz
        row = 0
        for i in range(3):
            for j in range(i, 3):
                np.multiply(f[i], f[j], f_and_e[row])
                f_and_e[row] += e[i] * e[j]
                row += 1
    body_starts = starts[:1] if is_joint else starts

    def scalar_products(first: Array, second: Array) -> Array:
        """Return the (m n, bodies) scalar products of m rows with n."""
        count = len(first) * len(second)
        if is_joint and first.shape[-1] % SLICES == 0:
            # einsum adds slices in one pass, into rows that stay in the cache.
            first = first.reshape(len(first), SLICES, -1)
            second = second.reshape(len(second), SLICES, -1)
            return np.add.reduce(np.einsum("mjt,njt->mnt", first, second), axis=2).reshape(count, 1)
        products = (first[:, None] * second).reshape(count, -1)
        return np.add.reduceat(products, body_starts, axis=1)

    def weighted_sums(weight: Array) -> Array:
        """Return the (bodies, 20) sums Σ w f, with (f, t) determinants or doubled areas as w."""
        u = np.add.reduce(weight)
        weighted = np.empty_like(nodes)  # u a, 2 v b, u c, perhaps 2 w d
        np.multiply(nodes[:, ::2], u, weighted[:, ::2])
        np.multiply(apexes, 2.0 * weight, weighted[:, 1::2])
        table = np.empty((9, len(u)))  # H, as xx, xy, xz, yy, yz, zz, and Z
        row = 0
        for axis in range(3):
            rows = table[row : row + 3 - axis]
            row += len(rows)
            np.einsum("ct,dct->dt", weighted[axis], nodes[axis:], out=rows)
        u_q = weighted[:, 0] + weighted[:, 2]
        np.add(u_q, weighted[:, 1], table[6:])
        if len(weight) == 2:
            table[6:] += weighted[:, 3]
        products = scalar_products(q, table)
        third = np.add.reduce(products.take(CUBE, 0))
        if exact:
            about_middles = scalar_products((f * weight).reshape(3, -1), f_and_e.reshape(6, -1))
            third += 0.1 * np.add.reduce(about_middles.take(LOCAL_CUBE, 0))
        sums = np.add.reduceat(table, body_starts, axis=1)
        first = 0.5 * (np.add.reduceat(u_q, body_starts, axis=1) + sums[6:])
        second = sums[:6] + 0.5 * np.add.reduce(products.take(SQUARE, 0))
        total = np.add.reduceat(u, body_starts)[None]
        return np.concatenate([total, first, second, third]).T

    largest = np.maximum.reduceat(np.abs(edges), starts, axis=2)
    return (
        weighted_sums(det),
        weighted_sums(lengths) if area_moments else np.empty((len(body_starts), 0)),
        counts[:, None].astype(np.float64) * len(det),
        np.maximum.reduce(largest[:, ::2], axis=1).T,
        largest[:, 1].T,
        np.array(
            [np.add.reduceat(np.add.reduce(size), starts) for size in (np.abs(det), lengths)]
        ).T,
    )


def _moments(
    blocks: Sequence[_Sums],
    starts: Index,
    center: Array,
    reach: Array,
    half_ulp: Array,
    *,
    area: bool,
    area_moments: bool,
    exact: bool,
) -> tuple[Moments, Moments]:
    """Return the stacked volumes and areas of n bodies with first blocks and parts `starts`."""
    of_volume, of_area, number, side, base, sizes = (
        blocks[0] if len(blocks) == 1 else map(np.concatenate, zip(*blocks))
    )

    def total(values: NDArray) -> Array:
        """Return the (n, k) sums over the bodies' blocks and parts."""
        if len(starts) == len(values):
            return values
        return np.add.reduceat(np.ascontiguousarray(values.T), starts, axis=1).T

    tau = total(
        number
        * (
            side.take(NEXT_AXIS, 1) * base.take(PREVIOUS_AXIS, 1)
            + side.take(PREVIOUS_AXIS, 1) * base.take(NEXT_AXIS, 1)
        )
    )
    lengths = np.sqrt(np.add.reduce(side * side, axis=1)) + np.sqrt(
        np.add.reduce(base * base, axis=1)
    )
    edges = total(lengths[:, None] * number)  # bound the sums at the triangles' first corners
    counts = total(number)
    bounds = total(sizes)
    rounding, inputs = error_bounds(
        reach,
        half_ulp,
        tau,
        edges,
        bounds,
        counts,
        np.minimum(3.0 * counts, 2.0 * PAIRWISE_SUM_ROUNDINGS),
        area,
    )
    if not exact:
        # Add the bound of the omitted third order, 12 / 2880 (3 f f' f'' + f e' e'' + …) by the
        # module's formulas. Their f = 2 (b - a) - e is at most twice the f here.
        f = (side + base / 2.0).T
        e = base.T
        rest = np.array(
            [
                f[i] * f[j] * f[k] / 10.0
                + (f[i] * e[j] * e[k] + e[i] * f[j] * e[k] + e[i] * e[j] * f[k]) / 120.0
                for i, j, k in TRIPLES
            ]
        ).T
        for which in range(2):
            rounding[which, :, 10:] += (1.0 + 1e-9) * total(rest * sizes[:, which, None])
    raw = total(of_volume) / DIVISORS
    error = rounding[0] / CONE_DIVISORS + 8.0 * U * np.abs(raw)
    volume = unchecked_moments(raw, center, Measure.VOLUME, error, inputs[0])
    if not area:
        return volume, Moments(np.zeros((len(starts), 1)), center, Measure.AREA)
    raw = total(of_area) / (DIVISORS / AREA_FACTORS) if area_moments else bounds[:, 1:] / 2.0
    count = raw.shape[1]
    error = rounding[1, :, :count] / 2.0 + 8.0 * U * np.abs(raw)
    return volume, unchecked_moments(raw, center, Measure.AREA, error, inputs[1, :, :count])


def nothing(order: int, about: NDArray | None) -> tuple[Moments, Moments]:
    """Return zero moments of the volume and the area, for a surface without faces."""
    zeros = np.zeros(monomial_count(order))
    about = np.zeros(3) if about is None else about
    return Moments(zeros, about, Measure.VOLUME), Moments(zeros, about, Measure.AREA)


def _measure_rescaled(
    surface: Surface,
    exponent: int,
    threads: int,
    about: NDArray | None,
    area: bool,
    area_moments: bool,
    exact: bool,
) -> tuple[Moments, Moments]:
    """Return the moments by measuring a copy of about unit size, 2^exponent times smaller: scaling
    rounds nothing.
    """
    points = np.ldexp(surface.points.astype(np.float64), -exponent)
    small = Surface(
        points,
        surface.all_triangles()[0],
        displacement=np.ldexp(surface.coordinate_error, -exponent),
    )
    results = []
    about = None if about is None else np.ldexp(about, -exponent)
    for moments in integrate(
        small, threads, about=about, area=area, area_moments=area_moments, exact=exact
    ):
        powers = exponent * (
            DEGREE[: len(moments.raw)] + (3 if moments.measure == Measure.VOLUME else 2)
        )
        with np.errstate(over="ignore"):  # the caller refuses what becomes infinite
            results.append(
                replace(
                    moments,
                    raw=np.ldexp(moments.raw, powers),
                    about=np.ldexp(moments.about, exponent),
                    rounding_error=np.ldexp(moments.rounding_error, powers) + np.finfo(float).tiny,
                    input_error=np.ldexp(moments.input_error, powers),
                )
            )
    return results[0], results[1]


def error_bounds(
    reach: NDArray,
    half_ulp: NDArray,
    tau: NDArray,
    edges: NDArray,
    sizes: NDArray,
    counts: NDArray,
    sum_roundings: NDArray | float,
    area: bool,
) -> tuple[Array, Array]:
    """Return the errors of Σ w E[f] and `input_error`, (2, n, 20), for determinants and doubled
    areas as weights w.

    tau: (n, 3) the sums of τ (see `third_order`). edges: (n, 1) the sum of two edges of each
    triangle. sizes: (n, 2) Σ |w|. counts: (n, 1) triangles. sum_roundings: of the sums, in units u.
    """
    moved_reach = reach + half_ulp
    powers = monomial_bounds(reach)
    displaced = monomial_bounds(moved_reach)
    weight = (
        9.0
        * U
        * np.array([np.add.reduce(reach * tau, axis=1), np.add.reduce(tau, axis=1)])[:, :, None]
    )
    size = sizes.T[:, :, None] * (1.0 + 1e-9)
    # Then come their products with the nodes, the sums, and underflow, which loses less than 1e-290
    # of a determinant: at most 5e-324 of a product of edges, times a coordinate of at most 2^100.
    steps = PRODUCT_ROUNDINGS + sum_roundings
    rounding = (
        (weight + 1e-290 * counts + (U * (size + weight)) * steps) * powers * THIRD_ORDER_SHARE
    )
    inputs = np.zeros((2, len(reach), 20))
    if half_ulp.any():
        step = np.sqrt(np.add.reduce(half_ulp * half_ulp, axis=1))[:, None]
        double = size[1] if area else np.sqrt(np.add.reduce(tau * tau, axis=1))[:, None]
        # A closed surface sweeps this volume if float32 moves its points.
        swept = double / 2.0 + step * edges + 2.0 * step * step * counts
        tilted = step * (edges + 2.0 * step * counts)
        # The relative change of a coordinate; the divisor of an axis without extent is 1.
        share = half_ulp / np.where(moved_reach > 0.0, moved_reach, 1.0)
        inputs[0] = step * swept * displaced
        inputs[1] = displaced * (tilted + np.add.reduce(share[:, None] * EXPONENTS, axis=2) * swept)
    return rounding, inputs


def monomial_bounds(reaches: NDArray) -> Array:
    """Return the (k, 20) largest values of the monomials within (k, 3) reaches."""
    factors = np.ones((len(reaches), 4))
    factors[:, 1:] = reaches
    return np.multiply.reduce(factors.take(MONOMIAL_FACTORS, axis=1), axis=2)
