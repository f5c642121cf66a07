# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""B-splines of one parameter: function spaces, their values and derivatives.

A `SplineSpace` is the function space of a direction of Soldea, Elber and Rivlin (Exact and
efficient computation of moments of free-form surface and trivariate based geometry, section 2):
order and knots, without control points. The basis is evaluated by the triangular scheme of Cox and
de Boor, for many parameters at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from .arguments import float_array
from .array_types import Array, ArrayLike, Int64, Integers, NDArray


@dataclass(frozen=True)
class SplineSpace:
    """The B-splines of one order over one knot vector, without control points.

    Parameters
    ----------
    knots : tuple of float
        Non-decreasing, as many as basis functions plus `order`.
    order : int
        The degree plus one, at least 1.
    count : int
        Control points. Basis function i takes control point i mod count, so a closed direction has
        order - 1 more basis functions than control points.

    Raises
    ------
    ValueError
        If the knots make no such space.

    Examples
    --------
    >>> from body_moments.core.numerics import SplineSpace
    >>> space = SplineSpace((0.0, 0.0, 0.0, 1.0, 1.0, 1.0), order=3, count=3)
    >>> space.collocation_matrix(np.array([0.5])).tolist()
    [[0.25, 0.5, 0.25]]
    """

    knots: tuple[float, ...]
    order: int
    count: int

    def __post_init__(self) -> None:
        knots = float_array("knots", self.knots, "n")
        object.__setattr__(self, "knots", tuple(knots.tolist()))
        if (
            self.order < 1
            or self.count < 1
            or len(knots) < 2 * self.order
            or self.function_count < self.count
        ):
            raise ValueError("too few control points")
        if not np.isfinite(knots).all() or (np.diff(knots) < 0.0).any():
            raise ValueError("knots must ascend")
        if not self.domain[0] < self.domain[1]:
            raise ValueError("empty domain")

    @property
    def function_count(self) -> int:
        """The number of basis functions."""
        return len(self.knots) - self.order

    @property
    def domain(self) -> tuple[float, float]:
        """The interval in which all the basis functions add up to one."""
        return self.knots[self.order - 1], self.knots[self.function_count]

    @cached_property
    def is_discontinuous(self) -> bool:
        """True if curves may jump: a knot within the domain is repeated `order` times."""
        knots = np.asarray(self.knots)
        first = knots[: len(knots) - self.order + 1]
        low, high = self.domain
        return bool(((first == knots[self.order - 1 :]) & (first > low) & (first < high)).any())

    @cached_property
    def spans(self) -> Int64:
        """(s,) the j of every interval knots[j] < knots[j + 1] in the domain."""
        knots = np.asarray(self.knots)
        j = np.arange(self.order - 1, self.function_count)
        return j[knots[j] < knots[j + 1]]

    @cached_property
    def intervals(self) -> Array:
        """The (s, 2) bounds of the spans."""
        knots = np.asarray(self.knots)
        return np.stack([knots[self.spans], knots[self.spans + 1]], axis=1)

    def uniform_parameters(self, per_span: int) -> Array:
        """Return (spans * per_span + 1,) parameters at equal steps in every span, both ends of the
        domain included.
        """
        low, high = self.intervals.T
        inner = low[:, None] + (high - low)[:, None] * (np.arange(per_span) / per_span)
        return np.append(inner.ravel(), high[-1])

    @cached_property
    def end_weights(self) -> Array:
        """(2, count) weights of the control points at the domain's ends."""
        return self.collocation_matrix(np.array(self.domain))

    @cached_property
    def active_controls(self) -> Int64:
        """The (s, order) control points that act in each span."""
        return self.controls_of_spans(self.spans)

    @cached_property
    def bezier_extraction(self) -> Array:
        """(s, order, order) weights of the acting control points in each Bézier control point of a
        span.
        """
        return self.bezier_weights(self.spans, self.intervals)

    def bezier_weights(self, spans: Integers, intervals: ArrayLike) -> Array:
        """Return (s, order, order) weights of the acting control points in the Bézier control
        points of intervals.

        There is an interval (s, 2) within each span (s,). The recursion of Cox and de Boor takes
        the interval's beginning or its end in each of its steps: Bézier's b-th point takes b ends.
        """
        knots = np.asarray(self.knots)
        near = knots[np.asarray(spans)[:, None] + np.arange(2 - self.order, self.order)]
        low, high = np.split(float_array("intervals", intervals, len(near), 2), 2, axis=1)
        b = np.arange(self.order)
        values = np.ones((len(near), self.order, 1))
        for order in range(2, self.order + 1):
            before, after = self._adjacent_knots(near, order)
            # Step `order` - 1 of point b is at the interval's end if it is one of the first b
            # steps.
            t = np.where(b >= order - 1, high, low)[..., None]
            share = values * ((t - before[:, None]) / (after - before)[:, None])
            rest = values - share
            values = np.zeros((len(near), self.order, order))
            values[..., 1:] = share
            values[..., :-1] += rest
        return values

    def controls_of_spans(self, spans: Integers) -> Int64:
        """Return the (..., order) control points that act in each span."""
        return (np.asarray(spans)[..., None] + np.arange(1 - self.order, 1)) % self.count

    def find_spans(self, parameters: NDArray) -> Int64:
        """Return the span of each parameter, or the nearest span if a parameter is outside the
        domain.
        """
        return self.spans[np.searchsorted(self.intervals[1:, 0], parameters, side="right")]

    def derivatives(self, spans: Integers, parameters: NDArray, highest: int) -> list[Array]:
        """Return `highest` + 1 arrays (..., order): values and derivatives of the basis functions
        that act in spans.

        spans, parameters: broadcast against each other to some shape (...).
        """
        knots = np.asarray(self.knots)
        t = np.asarray(parameters, np.float64)
        # The knots from j - order + 2 to j + order - 1, gathered once for each span, however many
        # parameters it has.
        near = knots[np.asarray(spans)[..., None] + np.arange(2 - self.order, self.order)]
        lower = [np.ones((*t.shape, 1))]  # by order, from 1
        for order in range(2, self.order + 1):
            before, after = self._adjacent_knots(near, order)
            ratio = lower[-1] / (after - before)
            values = np.empty((*t.shape, order))
            values[..., 0] = 0.0
            np.multiply(ratio, t[..., None] - before, out=values[..., 1:])
            values[..., :-1] += ratio * (after - t[..., None])
            lower.append(values)
        by_derivative = [lower[-1]]
        for derivative in range(1, min(highest + 1, self.order)):
            values = lower[self.order - derivative - 1]
            for order in range(self.order - derivative + 1, self.order + 1):
                before, after = self._adjacent_knots(near, order)
                ratio = (order - 1) * values / (after - before)
                values = np.zeros((*t.shape, order))
                values[..., 1:] = ratio
                values[..., :-1] -= ratio
            by_derivative.append(values)
        return by_derivative + [np.zeros_like(lower[-1]) for _ in range(self.order, highest + 1)]

    def _adjacent_knots(self, near: NDArray, order: int) -> tuple[NDArray, NDArray]:
        """Return the first and the last knot, (..., order - 1), of the functions, one order lower
        than `order`, that act in a span. near: (..., 2 self.order - 2) knots around the span.
        """
        return near[..., self.order - order : self.order - 1], near[
            ..., self.order - 1 : self.order + order - 2
        ]

    def collocation_matrix(
        self, parameters: ArrayLike, derivative: int = 0, spans: Integers | None = None
    ) -> Array:
        """Return (n, count) weights of the control points in the value, or a derivative, at n
        parameters.

        spans: (n,) the span of each parameter; by default a parameter at a knot is in the span that
        begins there.
        """
        parameters = float_array("parameters", parameters, "n")
        spans = self.find_spans(parameters) if spans is None else spans
        values = self.derivatives(spans, parameters, derivative)[derivative]
        table = np.zeros((len(parameters), self.count))
        np.add.at(
            table, (np.arange(len(parameters))[:, None], self.controls_of_spans(spans)), values
        )
        return table


@lru_cache(maxsize=64)
def clamped_space(
    order: int, inner: tuple[float, ...] = (), low: float = 0.0, high: float = 1.0
) -> SplineSpace:
    """Make the space of curves that begin and end at their first and last control points.

    Parameters
    ----------
    order : int
        The degree plus one.
    inner : tuple of float
        The knots between the two ends, ascending.
    low, high : float
        The ends of the domain.

    Returns
    -------
    SplineSpace
        Cached: equal arguments give the same object.

    Examples
    --------
    >>> from body_moments.core.numerics import clamped_space
    >>> clamped_space(3, (0.5,)).knots
    (0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0)
    """
    knots = (low,) * order + tuple(inner) + (high,) * order
    return SplineSpace(knots, order, len(knots) - order)
