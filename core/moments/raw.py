# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Raw moments about a stated point: the common representation of every body.

raw[p,q,r] = ∫ (x-ox)^p (y-oy)^q (z-oz)^r dm, positive integrals, p+q+r ≤ order. Moments add, scale
by a density, and map linearly under an affine map (`affine_maps`), so a sum of objects is a sum and
an instance is a map (`images`). Two bounds go with every number and add and map as it does:
`rounding_error`, for rounding (or a stated truncation), and `input_error`, for storing coordinates
as float32.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import cast

import numpy as np

from ..numerics import (
    Array,
    ArrayLike,
    NDArray,
    PerBody,
    as_rows,
    check_filled,
    float_array,
    rotation_array,
    shape_error,
)
from ..verdict import OBJECT_SIZE, TOO_SMALL, MeasureError
from .affine_maps import (
    SIMILARITY_RTOL,
    absolute_moments,
    anisotropy,
    apply_linear,
    apply_translation,
    are_singular,
)
from .exponents import (
    check_exponents,
    monomial_count,
    monomial_index,
    monomials,
    order_from_count,
    product_indices,
    tensor_index,
)

U = np.finfo(np.float64).eps / 2.0  # unit roundoff
TINY = np.finfo(np.float64).tiny  # smaller numbers lack digits
FLOAT32_HALF_ULP = 2.0**-24  # relative rounding error of float32
# In units u: numpy adds up contiguous rows pairwise, from sums of at most 128 numbers in 8 lanes,
# so this is generous.
PAIRWISE_SUM_ROUNDINGS = 64


SECOND_MOMENT_INDEX = tensor_index(2)
THIRD_MOMENT_INDEX = tensor_index(3)


class Measure(StrEnum):
    """The domain or quantity that moments are integrals over.

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


@dataclass(frozen=True, eq=False, repr=False)
class Moments:
    """Raw moments ∫ (x-ox)^p (y-oy)^q (z-oz)^r dm of one body, with error bounds.

    The point is the middle of the body's bounding box unless another was given; `about_point`,
    `about_center` and `in_frame` lead to others. Moments add (`+`), scale by a density (`*`) and
    follow affine maps (`transform`). `moments[p, q, r]` is one moment; iteration yields all (p, q,
    r), like the keys of a mapping. All arrays may have the same leading axes: then they belong to a
    stack of bodies, and the arguments and results of methods have these axes too.

    Parameters
    ----------
    raw : (K,) array
        The moments with p+q+r ≤ order, in the order of `monomials` and in unit^(dimension of
        `measure` + degree).
    about : (3,) array
        The point that the moments are taken about, in the body's coordinates.
    measure : Measure
        Integrals over volume, area, length or mass.
    rounding_error : (K,) array, optional
        Bounds of ``|raw - exact|`` for the coordinates as given: rounding, and truncation if a
        source states so. Zero by default.
    input_error : (K,) array, optional
        Bounds of the change when every coordinate moves by half an ulp of its float32 value. Zero
        by default, and for float64 sources.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> volume, _ = polyhedron_moments(surface, about=(0, 0, 0))
    >>> round(volume.total * 6, 12), round(volume[2, 0, 0] * 60, 12)
    (1.0, 1.0)
    >>> volume.center.round(12).tolist()
    [0.25, 0.25, 0.25]
    >>> round((volume * 7850.0 + volume.about_center() * 1000.0).total * 6, 9)
    8850.0
    """

    raw: Array
    about: Array
    measure: Measure = Measure.VOLUME
    # zeros after `__post_init__`
    rounding_error: Array = cast("Array", None)
    input_error: Array = cast("Array", None)

    def __post_init__(self) -> None:
        raw = float_array("raw", self.raw, *(getattr(self.raw, "shape", ()) or (..., "K")))
        if raw.shape[-1] != monomial_count(order_from_count(raw.shape[-1])):
            raise shape_error("raw", raw, (..., "monomial_count(order)"), "real numbers")
        about = float_array("about", self.about, *raw.shape[:-1], 3)
        bounds = {
            name: np.zeros_like(raw) if bound is None else float_array(name, bound, *raw.shape)
            for name, bound in (
                ("rounding_error", self.rounding_error),
                ("input_error", self.input_error),
            )
        }
        for name, value in {
            "raw": raw,
            "about": about,
            "measure": Measure(self.measure),
            **bounds,
        }.items():
            object.__setattr__(self, name, value)

    @property
    def order(self) -> int:
        """The largest p+q+r."""
        return order_from_count(self.raw.shape[-1])

    def __repr__(self) -> str:
        about = (
            tuple(self.about.tolist())
            if self.about.ndim == 1
            else "{} points".format(self.about[..., 0].size)
        )
        return "Moments(order={:d}, about={}, {!s}={!r})".format(
            self.order, about, self.measure, self.total
        )

    def __getitem__(self, exponents: tuple[int, int, int]) -> PerBody:
        p, q, r = check_exponents(exponents, 3, self.order)
        value = self.raw[..., monomial_index(p, q, r)]
        return value if value.ndim else float(value)

    def __len__(self) -> int:
        return self.raw.shape[-1]

    def __iter__(self) -> Iterator[tuple[int, int, int]]:
        return (tuple(row) for row in monomials(self.order).tolist())

    def to_dense(self) -> Array:
        """Return (order + 1, order + 1, order + 1) array[p, q, r] as in `skimage.measure.moments`;
        0 elsewhere.
        """
        dense = np.zeros((*self.raw.shape[:-1], *3 * (self.order + 1,)))
        dense[(..., *monomials(self.order).T)] = self.raw
        return dense

    @property
    def total(self) -> PerBody:
        """The volume, area, length or mass itself."""
        return self.raw[..., 0] if self.raw.ndim > 1 else float(self.raw[0])

    def at(self, which: int | slice | list[int] | NDArray | None) -> Moments:
        """Return the bodies of a stack that an index selects; None turns a single body into a stack
        of one.
        """
        return unchecked_moments(
            self.raw[which],
            self.about[which],
            self.measure,
            self.rounding_error[which],
            self.input_error[which],
        )

    @property
    def center(self) -> Array:
        """The (3,) centroid, in the coordinates of `about`. The total must not be zero."""
        return self.about + self.raw[..., 1:4] / self.raw[..., :1]

    def second(self) -> Array:
        """Return the (3, 3) second moments about `about`."""
        return self.raw[..., SECOND_MOMENT_INDEX]

    def third(self) -> Array:
        """Return the (3, 3, 3) third moments about `about`."""
        return self.raw[..., THIRD_MOMENT_INDEX]

    def truncate(self, order: int) -> Moments:
        """Return the same moments to a lower order."""
        k = monomial_count(order)
        if k == self.raw.shape[-1]:
            return self
        return unchecked_moments(
            self.raw[..., :k],
            self.about,
            self.measure,
            self.rounding_error[..., :k],
            self.input_error[..., :k],
        )

    __array_ufunc__ = None  # a numpy number on the left multiplies the moments, not their exponents

    def __mul__(self, factor: float | NDArray) -> Moments:
        """Scale by a constant: a density, a thickness, a sign."""
        if np.ndim(factor):  # one factor for each body of a stack
            factor = np.asarray(factor)[..., None]
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
        if not isinstance(other, Moments):
            return NotImplemented
        return sum_moments([self, other.about_point(self.about)])

    def about_point(self, point: ArrayLike) -> Moments:
        """Return the moments of the same body about another point, (3,) finite, by the binomial
        theorem.
        """
        point = float_array("point", point, *self.about.shape, finite=True)
        offset = self.about - point
        if not offset.any():
            return self
        away = np.abs(offset)
        values = [
            self.raw,
            self.rounding_error,
            self.input_error,
            np.abs(self.raw) + self.rounding_error,
        ]
        shifted = apply_translation(
            as_rows(values), self.order, as_rows([offset, away, away, away])
        )
        raw, error, inputs, size = (shifted[..., i, :] for i in range(4))
        rounding = (4.0 * monomials(self.order).sum(axis=1) + 16.0) * U
        return unchecked_moments(raw, point, self.measure, error + rounding * size, inputs)

    def about_center(self) -> Moments:
        """Return the central moments."""
        return self.about_point(self.center)

    def in_frame(self, rotation: ArrayLike, origin: ArrayLike) -> Moments:
        """Return the moments in another frame, about its origin, (3,).

        rotation: (3, 3) the frame's axes as columns, determinant 1. ValueError if it is no
        rotation, or the origin not finite.
        """
        inverse = rotation_array("rotation", rotation).swapaxes(-1, -2)
        origin = float_array("origin", origin, *self.about.shape, finite=True)
        matrix = np.concatenate([inverse, -inverse @ origin[..., None]], axis=-1)
        # A change of axes stretches nothing, whatever is measured and however the rotation was
        # rounded.
        return replace(
            image(replace(self, measure=Measure.MASS), matrix, np.zeros(self.about.shape)),
            measure=self.measure,
        )

    def transform(self, matrix: ArrayLike) -> Moments:
        """Return the moments of the body's image under matrix[:3, :3] @ x + matrix[:3, 3], about
        the image of `about`.

        Volume and mass follow any map, mass unchanged and volume by ``|det|``. Areas and lengths
        follow a similarity only; the deviation of a float32 rotation from one goes into
        `rounding_error`. ValueError if the matrix is not finite (4, 4), or no similarity although
        one is needed; MeasureError if the image is too small for its measure to be a number.
        """
        affine = float_array("matrix", matrix, *self.about.shape[:-1], 4, 4, finite=True)
        return image(
            self, affine, (affine[..., :3, :3] @ self.about[..., None])[..., 0] + affine[..., :3, 3]
        )


def unchecked_moments(
    raw: Array,
    about: Array,
    measure: Measure,
    rounding_error: Array,
    input_error: Array,
) -> Moments:
    """Return moments of float64 arrays that fit each other, as the core computes them, without a
    check.
    """
    moments = object.__new__(Moments)
    moments.__dict__.update(
        raw=raw,
        about=about,
        measure=measure,
        rounding_error=rounding_error,
        input_error=input_error,
    )
    return moments


def sum_moments(parts: Sequence[Moments]) -> Moments:
    """Add several bodies, about the first one's point and to the lowest of their orders.

    ValueError if `parts` is empty, or the measures differ.
    """
    check_filled("parts", parts)
    first = parts[0]
    if len(parts) == 1:
        return first
    if len({part.measure for part in parts}) > 1:
        raise ValueError("different measures")
    order = min([part.order for part in parts])
    parts = [part.truncate(order).about_point(first.about) for part in parts]
    raws = np.array([part.raw for part in parts])
    rounding = sum([part.rounding_error for part in parts], np.zeros(1))
    rounding = rounding + len(parts) * U * np.add.reduce(np.abs(raws))
    inputs = sum([part.input_error for part in parts], np.zeros(1))
    return unchecked_moments(np.add.reduce(raws), first.about, first.measure, rounding, inputs)


def stack_moments(parts: Sequence[Moments]) -> Moments:
    """Stack moments of one measure, each about its own point, along a leading axis, to the lowest
    of their orders.
    """
    count = min([len(part.raw) for part in parts])
    raw, rounding, inputs = (
        np.array([getattr(part, name)[:count] for part in parts])
        for name in ("raw", "rounding_error", "input_error")
    )
    about = np.array([part.about for part in parts])
    return unchecked_moments(raw, about, parts[0].measure, rounding, inputs)


@np.errstate(over="ignore", invalid="ignore")  # callers check for overflow
def image(moments: Moments, matrices: NDArray, center: NDArray | None = None) -> Moments:
    """Return the moments of a body's image under an affine map, or of each stacked body's image
    under its own map.

    `matrices` are (..., 4, 4) or (..., 3, 4) and finite; `center`, (..., 3), is the point of the
    result, by default the image of `about`. ValueError if a map of areas or lengths is no
    similarity, MeasureError if an image is too small for its measure to be a number.
    """
    order, about = moments.order, moments.about
    linear = matrices[..., :3, :3]
    offsets = matrices[..., :3, 3]
    origins = (
        linear[..., 0] * about[..., :1]
        + linear[..., 1] * about[..., 1:2]
        + linear[..., 2] * about[..., 2:]
        + offsets
    )
    center = origins if center is None else center
    offset = origins - center
    lead = linear.shape[:-2]
    factors = measure_scale_factors(
        moments.measure, linear.reshape(-1, 3, 3).transpose(1, 2, 0).copy()
    )
    weight, weight_error, uneven = [factor.reshape(*lead, 1) for factor in factors]
    # Bounds as in `images.sum_of_images`, for a sum of one. The images of the reference point are
    # rounded, and the body moves with them.
    stretch = np.add.reduce(np.abs(linear), axis=-1).max(axis=-1, keepdims=True)
    reach = np.abs(offsets).max(axis=-1, keepdims=True) + np.abs(center).max(axis=-1, keepdims=True)
    tolerance = 6 * U * (reach + stretch * np.abs(about).max(axis=-1, keepdims=True))
    weight_error = weight_error + (1 + 6 * order + 8) * U * weight
    away = np.abs(offset)
    # The moments; bounds, which the absolute values of the map carry on: of both errors, of the
    # moments' size, and for uneven maps of ∫ |x^α|.
    functionals = [
        moments.raw,
        moments.rounding_error,
        moments.input_error,
        np.abs(moments.raw) + moments.rounding_error,
    ]
    shifts = [offset, away, away, away + tolerance]
    if uneven.any():
        functionals.append(
            absolute_moments(moments.raw, order) + moments.rounding_error + moments.input_error
        )
        shifts.append(away + tolerance)
    images = as_rows(functionals)
    if order:
        images = apply_translation(apply_linear(images, order, linear), order, as_rows(shifts))
    mapped, error, mapped_input, size = [images[..., i, :] for i in range(4)]
    rounding = weight * error + (weight_error + (4.0 * order + 50.0) * U * weight) * size
    for axis, raised in enumerate(product_indices(order) if order else ()):
        moved = monomials(order)[raised, axis] * tolerance * weight * size[..., : len(raised)]
        rounding[..., raised] += moved
    if uneven.any():
        # Some faces grow by more than the weight, and some by less.
        rounding = rounding + weight * uneven * images[..., -1, :]
    return unchecked_moments(
        weight * mapped, center, moments.measure, rounding, weight * mapped_input
    )


def measure_scale_factors(measure: Measure, linear: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Return (k,) factors by which (3, 3, k) maps scale a measure, bounds of rounding, and bounds
    of unevenness.
    """
    exact = np.zeros(linear.shape[2])
    if measure == Measure.MASS:
        return np.ones(linear.shape[2]), exact, exact
    a, b, c = linear
    terms = [
        (a[i] * b[j] * c[k], a[i] * b[k] * c[j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    ]
    det = np.abs(sum([plus - minus for plus, minus in terms], exact))
    vanished = det < TINY
    if vanished.any() and not are_singular(linear.transpose(2, 0, 1)[vanished]).all():
        raise MeasureError(OBJECT_SIZE, fault=TOO_SMALL)
    permanent = sum([np.abs(plus) + np.abs(minus) for plus, minus in terms], exact)
    if measure == Measure.VOLUME:
        return det, 8 * U * permanent, exact
    uneven = anisotropy(linear)
    if np.any(uneven > SIMILARITY_RTOL):
        raise ValueError("not a similarity")
    power = 1 if measure == Measure.LENGTH else 2
    # AᵀA = s²(1 + E): a face of normal n grows by ½ (tr E / 3 - n·En) more than det^⅔, an edge
    # along n by as much less.
    return np.cbrt(det) ** power, 8 * U * np.cbrt(permanent) ** power, uneven * (0.5 + uneven)
