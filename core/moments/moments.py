# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Raw moments about a stated point: the one thing that every body becomes.

raw[p,q,r] = ∫ (x-ox)^p (y-oy)^q (z-oz)^r d(of), positive integrals, p+q+r ≤ order. They add, they scale by a density
and they map linearly under an affine map, so a sum of objects is a sum and an instance is a map. Two bounds go with
every number and add and map as it does: `rounding_error`, what rounding (or a stated truncation) may have changed, and
`input_error`, what storing coordinates as float32 may have changed.

What affine maps do to them is in `affine_maps`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .affine_maps import transform_by_horner
from .monomials import (
    count_of_degree,
    monomial_count,
    monomial_index,
    monomials,
    order_from_count,
    product_indices,
    quotient_indices,
)

U = np.finfo(np.float64).eps / 2.0  # unit roundoff
FLOAT32_HALF_ULP = 2.0**-24  # of float32, relatively
# u: numpy adds up contiguous rows in pairs of sums of at most 128 in 8 lanes, so this is generous
PAIRWISE_SUM_ROUNDINGS = 64
MAPS_PER_BLOCK = 2048  # maps at a time at order 3, fewer at higher ones: their functionals stay in the cache
SIMILARITY_RTOL = 1e-5  # a float32 rotation matrix is a similarity to about 1e-7; a real shear is far above this


SECOND_MOMENT_INDEX = np.array(
    [[monomial_index(*(np.eye(3, dtype=int)[[i, j]].sum(axis=0))) for j in range(3)] for i in range(3)]
)
THIRD_MOMENT_INDEX = np.array(
    [
        [[monomial_index(*(np.eye(3, dtype=int)[[i, j, k]].sum(axis=0))) for k in range(3)] for j in range(3)]
        for i in range(3)
    ]
)


class Measure(StrEnum):
    """What moments are integrals over.

    Examples
    --------
    >>> from body_moments.core.moments import Measure
    >>> Measure("area") is Measure.AREA
    True
    """

    VOLUME = "volume"
    AREA = "area"
    LENGTH = "length"
    MASS = "mass"


@dataclass(frozen=True, eq=False)
class Moments:
    """Raw moments of one body about a stated point, ∫ (x-ox)^p (y-oy)^q (z-oz)^r dm, with error bounds.

    They add (`+`), scale by a density (`*`) and follow affine maps (`transform`). `moments[p, q, r]` is one of them.

    Parameters
    ----------
    raw : (K,) array
        All p+q+r ≤ order in the order of `monomials`, in unit^(dimension of `measure` + degree).
    about : (3,) array
        The point they are taken about, in the body's coordinates.
    measure : Measure
        What they are integrals over: volume, area, length or mass.
    rounding_error : (K,) array, optional
        Bounds of |raw - exact| for the coordinates as given: rounding, and truncation where a source states so. Zero by
        default.
    input_error : (K,) array, optional
        Bounds of the change when every coordinate moves by half an ulp of its float32 value. Zero by default, and for
        float64 sources.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> volume, _ = polyhedron_moments(surface, about=(0, 0, 0))
    >>> round(volume.total * 6, 12), round(volume[2, 0, 0] * 60, 12), np.round(volume.center, 12).tolist()
    (1.0, 1.0, [0.25, 0.25, 0.25])
    >>> round((volume * 7850.0 + volume.about_center() * 1000.0).total * 6, 9)
    8850.0
    """

    raw: NDArray[np.float64]
    about: NDArray[np.float64]
    measure: Measure = Measure.VOLUME
    rounding_error: NDArray[np.float64] = cast("NDArray[np.float64]", None)  # zeros, once it is made
    input_error: NDArray[np.float64] = cast("NDArray[np.float64]", None)

    def __post_init__(self) -> None:
        object.__setattr__(self, "measure", Measure(self.measure))
        if self.rounding_error is None:
            object.__setattr__(self, "rounding_error", np.zeros_like(self.raw))
        if self.input_error is None:
            object.__setattr__(self, "input_error", np.zeros_like(self.raw))

    @property
    def order(self) -> int:
        """The largest p+q+r."""
        return order_from_count(len(self.raw))

    def __getitem__(self, exponents: tuple[int, int, int]) -> float:
        return float(self.raw[monomial_index(*exponents)])

    @property
    def total(self) -> float:
        """The volume, area, length or mass itself."""
        return float(self.raw[0])

    @property
    def center(self) -> NDArray[np.float64]:
        """(3,) the centroid, in the coordinates of `about`. The total must not be zero."""
        return self.about + self.raw[1:4] / self.raw[0]

    def second(self) -> NDArray[np.float64]:
        """(3, 3) the second moments about `about`."""
        return self.raw[SECOND_MOMENT_INDEX]

    def third(self) -> NDArray[np.float64]:
        """(3, 3, 3) the third moments about `about`."""
        return self.raw[THIRD_MOMENT_INDEX]

    def truncate(self, order: int) -> Moments:
        """Return the same moments to a lower order."""
        k = monomial_count(order)
        return replace(self, raw=self.raw[:k], rounding_error=self.rounding_error[:k], input_error=self.input_error[:k])

    def __mul__(self, factor: float) -> Moments:
        """Scale by a constant: a density, a thickness, a sign."""
        size = abs(factor)
        return replace(
            self,
            raw=self.raw * factor,
            rounding_error=self.rounding_error * size + 2 * U * np.abs(self.raw) * size,
            input_error=self.input_error * size,
        )

    __rmul__ = __mul__

    def __add__(self, other: Moments) -> Moments:
        """Add another body, about this one's point, to the lower of the two orders."""
        return sum_moments([self, other.about_point(self.about)])

    def about_point(self, point: ArrayLike) -> Moments:
        """Return the moments of the same body about another point, by the binomial theorem.

        Parameters
        ----------
        point : (3,) array_like
            In the coordinates of `about`.

        Returns
        -------
        Moments

        Raises
        ------
        ValueError
            If the point is not three finite numbers.
        """
        point = np.asarray(point, np.float64)
        if np.array_equal(point, self.about):
            return self
        if point.shape != (3,) or not np.isfinite(point).all():
            raise ValueError("about must be finite (3,)")
        offset = self.about - point
        away = np.abs(offset)
        raw, error, moved, size = apply_translation(
            np.array([self.raw, self.rounding_error, self.input_error, np.abs(self.raw) + self.rounding_error]),
            self.order,
            np.array([offset, away, away, away]),
        )
        rounding = (4.0 * monomials(self.order).sum(axis=1) + 16.0) * U
        return replace(self, raw=raw, about=point, rounding_error=error + rounding * size, input_error=moved)

    def about_center(self) -> Moments:
        """Return the central moments."""
        return self.about_point(self.center)

    def in_frame(self, rotation: ArrayLike, origin: ArrayLike) -> Moments:
        """Return the moments in another frame, about its origin.

        Parameters
        ----------
        rotation : (3, 3) array_like
            The frame's axes as columns.
        origin : (3,) array_like

        Returns
        -------
        Moments
        """
        matrix = np.eye(4)
        matrix[:3, :3] = np.asarray(rotation, np.float64).T
        matrix[:3, 3] = -matrix[:3, :3] @ np.asarray(origin, np.float64)
        # A change of axes stretches nothing, whatever is measured and however the rotation was rounded.
        return replace(
            sum_of_images(replace(self, measure=Measure.MASS), matrix[None], np.zeros(3)), measure=self.measure
        )

    def transform(self, matrix: ArrayLike) -> Moments:
        """Return the moments of the body's image under an affine map, about the image of `about`.

        Volume and mass follow any map, mass unchanged and volume by |det|. Areas and lengths follow a similarity only;
        what a float32 rotation lacks of one goes into `input_error`.

        Parameters
        ----------
        matrix : (4, 4) array_like
            new = matrix[:3, :3] @ old + matrix[:3, 3].

        Returns
        -------
        Moments

        Raises
        ------
        ValueError
            If the matrix is not finite (4, 4), or no similarity where one is needed.
        """
        affine = _validated_matrices(np.asarray(matrix, np.float64)[None])[0]
        return sum_of_images(self, affine[None], affine[:3, :3] @ self.about + affine[:3, 3])


def sum_moments(parts: Sequence[Moments]) -> Moments:
    """Add several bodies, about the first one's point and to the lowest of their orders.

    Parameters
    ----------
    parts : sequence of Moments
        At least one, all of the same measure.

    Returns
    -------
    Moments

    Raises
    ------
    ValueError
        If they measure different things.

    Examples
    --------
    >>> from body_moments.core.moments import Moments, sum_moments
    >>> left, right = (Moments(np.array([1.0, 0.0, 0.0, 0.0]), np.array([x, 0.0, 0.0])) for x in (0.0, 2.0))
    >>> both = sum_moments([left, right])
    >>> both.total, both.center.tolist()
    (2.0, [1.0, 0.0, 0.0])
    """
    first = parts[0]
    if len({part.measure for part in parts}) > 1:
        raise ValueError("different measures")
    if len(parts) > 1:
        order = min([part.order for part in parts])
        parts = [part.truncate(order).about_point(first.about) for part in parts]
    raws = np.array([part.raw for part in parts])
    return Moments(
        raw=raws.sum(axis=0),
        about=first.about,
        measure=first.measure,
        rounding_error=sum([part.rounding_error for part in parts], np.zeros(1))
        + len(parts) * U * np.abs(raws).sum(axis=0),
        input_error=sum([part.input_error for part in parts], np.zeros(1)),
    )


def are_similarities(linear: NDArray) -> NDArray[np.bool_]:
    """(k,) whether each of the (k, 3, 3) maps is a rotation, reflection and uniform scale, as far as float32 matrices
    can be."""
    return _anisotropy(np.ascontiguousarray(np.asarray(linear, np.float64).transpose(1, 2, 0))) <= SIMILARITY_RTOL


def sum_of_images(moments: Moments, matrices: NDArray, about: ArrayLike | None = None) -> Moments:
    """Add the images of one body under several affine maps: instances.

    Parameters
    ----------
    moments : Moments
    matrices : (k, 4, 4) array
        As for `Moments.transform`.
    about : (3,) array_like, optional
        The point of the result; by default the mean of the images of `moments.about`.

    Returns
    -------
    Moments

    Raises
    ------
    ValueError
        If the matrices are not finite (k, 4, 4), or not similarities where areas or lengths need them.

    Examples
    --------
    >>> from body_moments.core.moments import Moments, sum_of_images
    >>> matrices = np.stack([np.eye(4), np.diag([2.0, 2.0, 2.0, 1.0])])
    >>> round(sum_of_images(Moments(np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)), matrices).total, 9)
    9.0
    """
    matrices = _validated_matrices(np.asarray(matrices, np.float64))
    affine = np.ascontiguousarray(matrices[:, :3].transpose(1, 2, 0))
    linear, offsets = affine[:, :3], affine[:, 3]
    point, order = moments.about[:, None], moments.order
    origins = linear[:, 0] * point[0] + linear[:, 1] * point[1] + linear[:, 2] * point[2] + offsets
    center: NDArray[np.float64] = origins.mean(axis=1) if about is None else np.asarray(about, np.float64)
    raw, error, extra = np.zeros((3, len(moments.raw)))
    block = max(MAPS_PER_BLOCK * 20 // len(moments.raw), 16)
    for start in range(0, len(matrices), block):
        part = slice(start, start + block)
        maps = linear[:, :, part]
        weight, weight_error, anisotropy = measure_scale_factors(moments.measure, maps)
        offset = origins[:, part] - center[:, None]
        # The images of the reference point are rounded, and the body moves with them.
        stretch, reach = np.abs(maps).sum(axis=1).max(axis=0), np.abs(offset).max(axis=0)
        tolerance = (
            6 * U * (np.abs(offsets[:, part]).max(axis=0) + np.abs(center).max() + stretch * np.abs(point).max())
        )
        weight_error = weight_error + (len(matrices) + 6 * order + 8) * U * weight
        if len(matrices) == 1:
            image, *bounds = _single_image(moments, order, maps, offset, tolerance, weight, weight_error, anisotropy)
        else:
            image = np.add.reduce(transform_by_horner(moments.raw[:, None], order, maps, offset) * weight, axis=1)
            bounds = _image_error_bounds(moments, stretch, reach, tolerance, weight, weight_error, anisotropy)
        raw += image
        error += bounds[0]
        extra += bounds[1]
    return Moments(raw, center, moments.measure, error, extra)


def _validated_matrices(matrices: NDArray) -> NDArray[np.float64]:
    """The maps. ValueError where they are none."""
    if matrices.ndim != 3 or matrices.shape[1:] != (4, 4) or not len(matrices) or not np.isfinite(matrices).all():
        raise ValueError("matrices not finite (4, 4)")
    return matrices


def _single_image(
    moments: Moments,
    order: int,
    linear: NDArray,
    offset: NDArray,
    tolerance: NDArray,
    weight: NDArray,
    weight_error: NDArray,
    anisotropy: NDArray,
) -> tuple[NDArray, NDArray, NDArray]:
    """The image under one map, (3, 3, 1) and (3, 1), and its bounds moment by moment: the same on absolute values."""
    away = np.abs(offset.T)
    values = apply_linear(
        np.array(
            [moments.raw, moments.rounding_error, moments.input_error, np.abs(moments.raw) + moments.rounding_error]
        ),
        order,
        linear[:, :, 0],
    )
    image, error, mapped_input, size = apply_translation(
        values, order, np.concatenate([offset.T, away, away, away + tolerance])
    )
    rounding = weight * error + (weight_error + (4.0 * order + 50.0) * U * weight) * size
    for axis, raised in enumerate(product_indices(order) if order else ()):
        moved = monomials(order)[raised, axis] * tolerance * weight * size[: len(raised)]
        rounding[raised] += moved
    return weight * image, rounding, weight * (mapped_input + anisotropy * (size + mapped_input))


def apply_linear(values: NDArray, order: int, linear: NDArray) -> NDArray[np.float64]:
    """(m, K): m functionals F, (m, K), under a linear map (3, 3), the first as it is, the others under |map|.

    For one map it is faster than Horner's scheme to turn first, degree by degree, and to shift then, axis by axis. The
    image's monomials as polynomials of the old ones are those of one degree less times a form.
    """
    forms, out = np.array([linear, np.abs(linear)]), np.array(values)
    table = np.ones((2, 1, 1))
    for degree in range(1, order + 1):
        count, below = count_of_degree(degree), count_of_degree(degree - 1)
        padded = np.concatenate([table, np.zeros((2, below, 1))], axis=2)
        raised = padded[:, :, quotient_indices(degree, below)]  # times x, y, z: (2, below, 3, rows)
        table = np.empty((2, count, count))
        for axis, old, new in (
            (0, slice(0, below), slice(0, below)),
            (1, slice(below - degree, below), slice(below, count - 1)),
            (2, slice(below - 1, below), slice(count - 1, count)),
        ):
            np.einsum("mrjc,mj->mrc", raised[:, old], forms[:, axis], out=table[:, new])
        part = slice(monomial_count(degree - 1), monomial_count(degree))
        out[0, part] = np.add.reduce(table[0] * values[0, part], axis=1)
        out[1:, part] = np.einsum("rc,mc->mr", table[1], values[1:, part])
    return out


@lru_cache
def _cube_layout(order: int) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """(K,) where each monomial stands in a flat table of all exponents up to `order`, and (n, n) the binomials."""
    p, q, r = monomials(order).T
    n = order + 1
    return (p * n + q) * n + r, np.array([[float(math.comb(i, j)) for j in range(n)] for i in range(n)])


def apply_translation(values: NDArray, order: int, offsets: NDArray) -> NDArray[np.float64]:
    """(m, K): each of m functionals F, (m, K), with its own offset, (m, 3): F[(x+t)^α], one axis after the other."""
    positions, binomials = _cube_layout(order)
    n = order + 1
    lag = np.subtract.outer(np.arange(n), np.arange(n))
    for axis in range(3):
        powers = np.multiply.accumulate(
            np.concatenate([np.ones((len(values), 1)), np.repeat(offsets[:, axis, None], order, axis=1)], axis=1),
            axis=1,
        )
        table = binomials * powers[:, np.maximum(lag, 0)]
        cube = np.zeros((len(values), n**3))
        cube[:, positions] = values  # what stands above `order` is no moment, and must not come back
        cube = np.moveaxis(cube.reshape(-1, n, n, n), axis + 1, 1)
        with np.errstate(over="ignore", invalid="ignore"):
            cube = np.einsum("mpi,miqr->mpqr", table, cube)
        values = np.moveaxis(cube, 1, axis + 1).reshape(len(values), -1)[:, positions]
    return values


def _image_error_bounds(
    moments: Moments,
    stretch: NDArray,
    reach: NDArray,
    tolerance: NDArray,
    weight: NDArray,
    weight_error: NDArray,
    anisotropy: NDArray,
) -> tuple[NDArray, NDArray]:
    """(K,) and (K,) what `rounding_error`, with the rounding of the maps, and `input_error` become under k maps
    together.

    By degree: where the rows of |linear| sum to at most `stretch` and |offset| is at most `reach`, both (k,), a product
    of n linear forms holds binomial(n, j) stretch^j reach^(n-j) of the moments of degree j, each at most the largest
    of its degree. An offset that may be off by `tolerance` changes it by at most n `tolerance` times n-1 forms.
    """
    order = moments.order
    degree = monomials(order).sum(axis=1)
    starts = [monomial_count(n - 1) for n in range(order + 1)]
    error, inputs = (
        np.maximum.reduceat(moments.rounding_error, starts),
        np.maximum.reduceat(moments.input_error, starts),
    )
    size = np.maximum.reduceat(np.abs(moments.raw), starts) + error

    def carried(factor: NDArray, reach: NDArray, *largest: NDArray) -> list[NDArray]:
        powers = [[factor]]
        for _ in range(order):
            powers.append([power * reach for power in powers[-1]] + [powers[-1][-1] * stretch])
        sums = [[math.comb(n, j) * power.sum() for j, power in enumerate(row)] for n, row in enumerate(powers)]
        return [np.array([np.dot(row, top[: len(row)]) for row in sums]) for top in largest]

    rounding, mapped_input = carried(weight, reach, error, inputs)
    rounding += carried(weight_error, reach, size)[0]
    rounding[1:] += np.arange(1, order + 1) * carried(weight * tolerance, reach + tolerance, size)[0][:-1]
    if anisotropy.any():
        mapped_input += carried(weight * anisotropy, reach, size + inputs)[0]
    return rounding[degree], mapped_input[degree]


def measure_scale_factors(measure: Measure, linear: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """(k,) the factor by which each of the (3, 3, k) maps changes the measure, its rounding bound, and by how much the
    map fails to have one factor."""
    exact = np.zeros(linear.shape[2])
    if measure == Measure.MASS:
        return np.ones(linear.shape[2]), exact, exact
    a, b, c = linear
    terms = [(a[i] * b[j] * c[k], a[i] * b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))]
    det = np.abs(sum([plus - minus for plus, minus in terms], exact))
    permanent = sum([np.abs(plus) + np.abs(minus) for plus, minus in terms], exact)
    if measure == Measure.VOLUME:
        return det, 8 * U * permanent, exact
    anisotropy = _anisotropy(linear)
    if np.any(anisotropy > SIMILARITY_RTOL):
        raise ValueError("not a similarity")
    power = 1 if measure == Measure.LENGTH else 2
    return np.cbrt(det) ** power, 8 * U * np.cbrt(permanent) ** power, anisotropy


def _anisotropy(linear: NDArray) -> NDArray[np.float64]:
    """(k,) by how much, relatively, each of the (3, 3, k) maps stretches one direction more than another; infinite for
    a flat map."""
    columns = linear.transpose(1, 0, 2)
    a, b, c = [np.add.reduce(column * column, axis=0) for column in columns]
    ab, ac, bc = [np.abs(np.add.reduce(columns[i] * columns[j], axis=0)) for i, j in ((0, 1), (0, 2), (1, 2))]
    mean = (a + b + c) / 3.0
    off = np.maximum(np.maximum(np.abs(a - mean) + ab + ac, np.abs(b - mean) + ab + bc), np.abs(c - mean) + ac + bc)
    with np.errstate(invalid="ignore", divide="ignore"):
        off = off / mean
    return np.where(np.isfinite(off), off, np.inf)
