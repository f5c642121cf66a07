# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""B-spline curves in space and tensor-product patches, polynomial or rational.

The normal of a patch is ∂S/∂s x ∂S/∂t, s being the direction of the first axis of its control
points. Blender's faces look the other way: with Blender's v as s and u as t, both normals agree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..numerics import Array, ArrayLike, NDArray, SplineSpace, check_type, float_array
from ..verdict import MeasureError, check_size
from .findings import CONTROL_POINTS_INVALID, NON_FINITE, NON_POSITIVE_WEIGHTS

Face: TypeAlias = "Patch | FlatFace | TrimmedFace"
# Of a patch, counter-clockwise: the axis that is fixed (0 for s), at its begin (0) or end (1), and
# whether the patch is on the left of the side's curve.
SIDES = (
    (1, 0, True),
    (0, 1, True),
    (1, 1, False),
    (0, 0, False),
)


def _freeze_points(part: Curve | Patch, *shape: int) -> None:
    """Replace the points (*shape, 3) and weights (*shape) by read-only float64 copies, equal
    weights by None.
    """
    points = _frozen_copy(float_array("points", part.points, *shape, 3))
    if not np.isfinite(points).all():
        raise MeasureError(CONTROL_POINTS_INVALID, fault=NON_FINITE)
    object.__setattr__(part, "points", points)
    if part.weights is not None:
        weights = _frozen_copy(float_array("weights", part.weights, *shape))
        if not (np.isfinite(weights).all() and (weights > 0.0).all()):
            raise MeasureError(CONTROL_POINTS_INVALID, fault=NON_POSITIVE_WEIGHTS)
        object.__setattr__(part, "weights", None if (weights == weights.flat[0]).all() else weights)


def _frozen_copy(values: Array) -> Array:
    copy = np.array(values, order="C")
    copy.setflags(write=False)
    return copy


def homogeneous(points: NDArray, weights: NDArray | None) -> Array:
    """Return (..., 4) homogeneous coordinates: points times their weights, and the weights; for
    None the points.
    """
    if weights is None:
        return points
    net = np.empty((*weights.shape, 4))
    net[..., 3] = weights
    np.multiply(points, weights[..., None], out=net[..., :3])
    return net


def projected(net: NDArray) -> tuple[Array, Array | None]:
    """Return the points and the weights of a net of `homogeneous` coordinates."""
    return (net, None) if net.shape[-1] == 3 else (net[..., :3] / net[..., 3:], net[..., 3])


def control_length(curves: Sequence[Curve]) -> float:
    """Return an upper bound of the length of curves."""
    return sum(
        float(np.linalg.norm(np.diff(curve.points, axis=0), axis=1).sum()) for curve in curves
    )


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
    >>> points = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 0.0, 0.0]])
    >>> curve = Curve(clamped_space(3), points)
    >>> curve.evaluate([0.5]).tolist()
    [[1.0, 1.0, 0.0]]
    """

    space: SplineSpace
    points: Array
    weights: Array | None = None

    def __post_init__(self) -> None:
        check_type("space", self.space, SplineSpace)
        _freeze_points(self, self.space.count)

    def evaluate(self, parameters: ArrayLike) -> Array:
        """Return the (n, 3) points of the curve at n parameters."""
        return self.apply_weights(self.space.collocation_matrix(parameters))

    def apply_weights(self, table: NDArray) -> Array:
        """Return the (n, 3) points given by a table (n, count) of weights of its control points."""
        net = homogeneous(self.points - self.points[0], self.weights)
        return projected(np.einsum("ni,id->nd", table, net))[0] + self.points[0]

    def derivatives(self, parameters: NDArray) -> tuple[Array, Array]:
        """Return the (n, 3) points and derivatives at n parameters."""
        spans = self.space.find_spans(parameters)
        acting = self._net[self.space.controls_of_spans(spans)]
        place, slope = (
            np.einsum("nk,nkd->nd", table, acting)
            for table in self.space.derivatives(spans, parameters, 1)
        )
        place[:, :3] /= place[:, 3:]
        slope = (slope[:, :3] - place[:, :3] * slope[:, 3:]) / place[:, 3:]
        return place[:, :3] + self.points[0], slope

    @property
    def all_weights(self) -> Array:
        """(count,) weights: ones for a polynomial curve."""
        return np.ones(len(self.points)) if self.weights is None else self.weights

    @cached_property
    def _net(self) -> Array:
        """(count, 4) homogeneous control points about the first."""
        return homogeneous(self.points - self.points[0], self.all_weights)

    def transform(self, matrix: ArrayLike) -> Curve:
        """Return the image of the curve under a (4, 4) affine map."""
        matrix = float_array("matrix", matrix, 4, 4)
        return Curve(self.space, self.points @ matrix[:3, :3].T + matrix[:3, 3], self.weights)

    def reverse(self) -> Curve:
        """Return the same curve, run backward."""
        # Function j has the control point j % count; a cyclic curve has more functions than points.
        # Run backward, function 0 is the one that was last.
        order = (self.space.function_count - 1 - np.arange(self.space.count)) % self.space.count
        knots = tuple((-np.asarray(self.space.knots)[::-1]).tolist())
        return Curve(
            SplineSpace(knots, self.space.order, self.space.count),
            self.points[order],
            None if self.weights is None else self.weights[order],
        )

    def uniform(self, count: int) -> Array:
        """Return (count, 3) points at equal steps of the domain."""
        return self.apply_weights(_uniform_table(self.space, count))

    def samples(self, each: int) -> Array:
        """Return (spans * each + 1, 3) points at equal steps in every span, both ends included."""
        return self.apply_weights(_sample_table(self.space, each))


def reverse_curves(curves: Sequence[Curve]) -> list[Curve]:
    """Return curves end to end, run backward."""
    return [curve.reverse() for curve in reversed(curves)]


if TYPE_CHECKING:
    from .flat_face import FlatFace
    from .trimmed_face import TrimmedFace


@dataclass(frozen=True, eq=False)
class Patch:
    """A tensor-product B-spline patch, polynomial or rational.

    Its normal is ∂S/∂s x ∂S/∂t.

    Parameters
    ----------
    spaces : (SplineSpace, SplineSpace)
        Function spaces of s, along the first axis of the control points, and of t.
    points : (count_s, count_t, 3) array
        Control points.
    weights : (count_s, count_t) array, optional
        Positive; None for a polynomial patch.

    Raises
    ------
    ValueError
        If the shapes differ.
    MeasureError
        If a number is not finite or a weight not positive.

    Examples
    --------
    >>> from body_moments.core.nurbs import Patch
    >>> from body_moments.core.numerics import clamped_space
    >>> square = np.array([[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]])
    >>> Patch((clamped_space(2), clamped_space(2)), square).evaluate_grid([0.5], [0.5]).tolist()
    [[[0.5, 0.5, 0.0]]]
    """

    spaces: tuple[SplineSpace, SplineSpace]
    points: Array
    weights: Array | None = None

    def __post_init__(self) -> None:
        for space in self.spaces:
            check_type("spaces", space, SplineSpace)
        _freeze_points(self, self.spaces[0].count, self.spaces[1].count)

    @cached_property
    def constant_weights(self) -> tuple[bool, bool]:
        """Two flags: whether the weights are constant along s, and along t."""
        if self.weights is None:
            return True, True
        return bool((self.weights == self.weights[:1]).all()), bool(
            (self.weights == self.weights[:, :1]).all()
        )

    def transform(self, matrix: ArrayLike) -> Patch:
        """Return the image of the patch under a (4, 4) affine map."""
        matrix = float_array("matrix", matrix, 4, 4)
        return replace(self, points=self.points @ matrix[:3, :3].T + matrix[:3, 3])

    def reverse_orientation(self) -> Patch:
        """Return the same surface facing the other way."""
        return Patch(
            (self.spaces[1], self.spaces[0]),
            self.points.swapaxes(0, 1),
            None if self.weights is None else self.weights.T,
        )

    def evaluate_grid(self, s: ArrayLike, t: ArrayLike) -> Array:
        """Return the (len(s), len(t), 3) points at all pairs of parameters from s and t."""
        return self.apply_weights(
            *(space.collocation_matrix(values) for space, values in zip(self.spaces, (s, t)))
        )

    def apply_weights(self, *tables: NDArray) -> Array:
        """Return the (m, n, 3) points given by tables (m, count_s) and (n, count_t) of basis
        function values.
        """
        net = homogeneous(self.points, self.weights)
        half = np.einsum("ai,ijd->ajd", tables[0], net)
        return projected(np.einsum("ajd,bj->abd", half, tables[1]))[0]

    def side(self, axis: int, end: int) -> Curve:
        """Return the boundary curve at the first (end 0) or last (end 1) s (axis 0) or t (axis
        1).
        """
        return self._side_curves[axis, end]

    @cached_property
    def _side_curves(self) -> dict[tuple[int, int], Curve]:
        """The boundary curves by axis and end."""
        net = homogeneous(self.points, self.weights)
        return {
            (axis, end): Curve(
                self.spaces[1 - axis],
                *projected(np.tensordot(self.spaces[axis].end_weights[end], net, (0, axis))),
            )
            for axis, end, _ in SIDES
        }

    @property
    def sides(self) -> tuple[tuple[Curve, bool], ...]:
        """The four boundary curves, in the order of `SIDES`, each with True if the patch is on its
        left.
        """
        return tuple((self.side(axis, end), forward) for axis, end, forward in SIDES)

    def samples(self, each: int) -> Array:
        """Return a grid of points that divide every span of both directions into `each` equal
        steps, ends included.
        """
        return self.apply_weights(*(_sample_table(space, each) for space in self.spaces))


@lru_cache(maxsize=64)
def _uniform_table(space: SplineSpace, count: int) -> Array:
    """Return (count, k) weights of k control points at equal steps of the domain; cached: do not
    modify.
    """
    low, high = space.domain
    return space.collocation_matrix(low + (high - low) * np.linspace(0.0, 1.0, count))


@lru_cache(maxsize=64)
def _sample_table(space: SplineSpace, each: int) -> Array:
    """Return (n, count) weights of control points at `each` equal steps in every span; cached: do
    not modify.
    """
    return space.collocation_matrix(space.uniform_parameters(each))


def control_box(patches: Sequence[Face]) -> tuple[Array, Array]:
    """Return the least (3,) and the largest (3,) coordinates of all control points."""
    for patch in patches:
        if not hasattr(patch, "sides"):  # no face of any kind: raise TypeError
            check_type("patches", patch, Patch)
    points = np.concatenate([patch.points.reshape(-1, 3) for patch in patches])
    return points.min(axis=0), points.max(axis=0)


def patches_center(patches: Sequence[Face]) -> Array:
    """Return the (3,) middle of the box around all control points: the reference point."""
    low, high = control_box(patches)
    return low + (high - low) / 2.0


def patches_size(patches: Sequence[Face]) -> float:
    """Return the diagonal of the box around all control points."""
    low, high = control_box(patches)
    check_size(*(high - low).tolist())
    return float(np.linalg.norm(high - low))
