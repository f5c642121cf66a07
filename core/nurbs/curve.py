# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomial and rational B-spline curves in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..numerics.arguments import check_type, float_array
from ..numerics.bspline import SplineSpace
from ..verdict.finding import MeasureError
from .findings import NON_FINITE_CONTROL_POINTS, NON_POSITIVE_WEIGHTS


def checked_points(
    points: ArrayLike, weights: ArrayLike | None, shape: tuple[int, ...]
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Return read-only float64 copies of points (*shape, 3) and weights (*shape), None if equal."""
    points = _frozen_copy(float_array("points", points, *shape, 3))
    if not np.isfinite(points).all():
        raise MeasureError(NON_FINITE_CONTROL_POINTS)
    if weights is None:
        return points, None
    weights = _frozen_copy(float_array("weights", weights, *shape))
    if not (np.isfinite(weights).all() and (weights > 0.0).all()):
        raise MeasureError(NON_POSITIVE_WEIGHTS)
    return points, None if (weights == weights.flat[0]).all() else weights


def _frozen_copy(values: NDArray[np.float64]) -> NDArray[np.float64]:
    copy = np.array(values, order="C")
    copy.setflags(write=False)
    return copy


@dataclass(frozen=True, eq=False)
class Curve:
    """A polynomial or rational B-spline curve in space.

    Parameters
    ----------
    space : SplineSpace
        Function space of the parameter.
    points : (count, 3) array
        Control points.
    weights : (count,) array, optional
        Positive; None for a polynomial curve.

    Raises
    ------
    ValueError
        If the shapes differ.
    MeasureError
        If a number is not finite or a weight not positive.

    Examples
    --------
    >>> from body_moments.core.nurbs import Curve
    >>> from body_moments.core.numerics import clamped_space
    >>> curve = Curve(clamped_space(3), np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 0.0, 0.0]]))
    >>> curve.evaluate([0.5]).tolist()
    [[1.0, 1.0, 0.0]]
    """

    space: SplineSpace
    points: NDArray[np.float64]
    weights: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        check_type("space", self.space, SplineSpace)
        points, weights = checked_points(self.points, self.weights, (self.space.count,))
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "weights", weights)

    def evaluate(self, parameters: ArrayLike) -> NDArray[np.float64]:
        """Return the (n, 3) points of the curve at n parameters."""
        return self.apply_weights(self.space.collocation_matrix(parameters))

    def apply_weights(self, table: NDArray) -> NDArray[np.float64]:
        """Return the (n, 3) points given by a table (n, count) of weights of its control points."""
        if self.weights is not None:
            table = table * self.weights
            table /= table.sum(axis=1, keepdims=True)
        origin = self.points[0]
        return np.einsum("ni,id->nd", table, self.points - origin) + origin

    def velocity(self, parameters: ArrayLike) -> NDArray[np.float64]:
        """Return the (n, 3) derivatives at n parameters."""
        values, slopes = (self.space.collocation_matrix(parameters, k) for k in (0, 1))
        points = self.points - self.points[0]
        if self.weights is None:
            return np.einsum("ni,id->nd", slopes, points)
        values, slopes = values * self.weights, slopes * self.weights
        bottom = values.sum(axis=1, keepdims=True)
        place = np.einsum("ni,id->nd", values, points) / bottom
        return (np.einsum("ni,id->nd", slopes, points) - place * slopes.sum(axis=1, keepdims=True)) / bottom

    def transform(self, matrix: ArrayLike) -> Curve:
        """Return the image of the curve under a (4, 4) affine map."""
        matrix = float_array("matrix", matrix, 4, 4)
        return Curve(self.space, self.points @ matrix[:3, :3].T + matrix[:3, 3], self.weights)

    def reverse(self) -> Curve:
        """Return the same curve, run backward."""
        # In this order the first point of the reversed curve is that of function 0.
        if self.space.function_count > self.space.count:
            order = (self.space.function_count - 1 - np.arange(self.space.count)) % self.space.count
        else:
            order = np.arange(self.space.count)[::-1]
        knots = tuple((-np.asarray(self.space.knots)[::-1]).tolist())
        return Curve(
            SplineSpace(knots, self.space.order, self.space.count),
            self.points[order],
            None if self.weights is None else self.weights[order],
        )

    def samples(self, each: int) -> NDArray[np.float64]:
        """Return (spans * each + 1, 3) points at equal steps in every span, both ends included."""
        return self.evaluate(self.space.uniform_parameters(each))
