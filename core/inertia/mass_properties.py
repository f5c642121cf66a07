# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass properties, derived from moments.

Inertia is a tensor with entries I_xx = ∫(y²+z²)dm and I_xy = -∫xy dm. Principal moments are sums of
covariance eigenvalues, I_1 = m(λ_2+λ_3), so that no moment exceeds the sum of the other two, by
construction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..moments import SECOND_MOMENT_INDEX, Measure, Moments, U, sum_moments
from ..numerics import (
    IDENTITY_3,
    Array,
    ArrayLike,
    Mask,
    NDArray,
    PerBody,
    check_type,
    float_array,
    inertia_of_second,
    rotation_array,
    second_of_inertia,
)
from ..verdict import MeasureError
from .findings import NO_CERTAIN_VOLUME
from .principal_frames import PrincipalFrame, frame_of_body, principal_frames
from .third_moment_frames import ThirdMomentFrames

MAX_INPUT_SHARE = 0.1  # relative to a volume: a larger bound for float32 coordinates leaves none


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass, center and inertia of one body, or of several as one, all in one frame and unit.

    For a stack of bodies all attributes have a leading axis.

    Attributes
    ----------
    mass : float
    center : (3,) array
    inertia : (3, 3) array
        The tensor about the center: I_xx = ∫(y²+z²)dm, I_xy = -∫xy dm.
    principal : PrincipalFrame
        Principal moments and axes.
    rounding_error, input_error : dict of str to float
        Absolute bounds of "mass", "center" and "inertia", Euclidean for the center and Frobenius
        for the tensor (so they hold for each entry and each principal moment): of rounding, and of
        float32 coordinates.

    Examples
    --------
    >>> from body_moments.core import MassProperties, Surface, polyhedron_moments
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> properties = MassProperties.from_moments(polyhedron_moments(surface)[0], density=6000.0)
    >>> round(properties.mass, 9), np.round(properties.principal.moments, 6).tolist()
    (1000.0, [62.5, 62.5, 100.0])
    """

    mass: PerBody
    center: Array
    inertia: Array
    principal: PrincipalFrame
    rounding_error: dict[str, PerBody]
    input_error: dict[str, PerBody]

    @classmethod
    def from_moments(
        cls,
        moments: Moments,
        density: float = 1.0,
        preferred_axes: ArrayLike | None = None,
        refine: Callable[[], Moments] | None = None,
    ) -> MassProperties:
        """Derive the mass properties of a body with constant density ≥ 0 from its moments to order
        3 or more.

        The other arguments are as for `principal_frame`. MeasureError if the body has no certain
        volume.
        """
        check_type("moments", moments, Moments)
        if moments.order < 3:
            raise ValueError("moments below third order")
        if not 0.0 <= density < np.inf:
            raise ValueError("impossible density: {!r}".format(density))
        axes = (
            IDENTITY_3
            if preferred_axes is None
            else rotation_array("preferred_axes", preferred_axes)
        )
        return cls.of_body(moments, density, axes, refine)

    @classmethod
    def of_body(
        cls,
        moments: Moments,
        density: float,
        preferred_axes: Array,
        refine: Callable[[], Moments] | None = None,
    ) -> MassProperties:
        """Derive the mass properties as `from_moments` does, from arguments that need no check."""
        if not has_certain_total(moments):
            raise MeasureError(NO_CERTAIN_VOLUME)
        return cls._with_frame(moments, density, frame_of_body(moments, preferred_axes, refine))

    @classmethod
    def of_stack(
        cls,
        moments: Moments,
        density: NDArray,
        preferred_axes: NDArray,
        fixed: ThirdMomentFrames,
    ) -> MassProperties:
        """Derive the mass properties of a stack of n bodies with certain volumes and (n,)
        densities.

        The other arguments are as for `principal_frames`.
        """
        return cls._with_frame(moments, density, principal_frames(fixed, preferred_axes))

    @classmethod
    def _with_frame(
        cls, moments: Moments, density: float | NDArray, frame: PrincipalFrame
    ) -> MassProperties:
        total = moments.raw[..., 0]
        weight = np.asarray(density)
        shift = moments.raw[..., 1:4] / total[..., None]
        products = shift[..., :, None] * shift[..., None, :]
        second = weight[..., None, None] * (
            moments.raw[..., SECOND_MOMENT_INDEX] - total[..., None, None] * products
        )
        inertia = inertia_of_second(second)
        mass = weight * total
        rounding, moved = _propagate_errors(moments, weight)
        return cls(
            mass=mass if mass.ndim else float(mass),
            center=moments.about + shift,
            inertia=inertia,
            principal=frame.scaled(weight),
            rounding_error=rounding,
            input_error=moved,
        )

    def at(self, which: int | list[int]) -> MassProperties:
        """Return one body of a stack, or a stack of some of them."""

        def pick(values: PerBody) -> PerBody:
            return values[which] if isinstance(which, list) else float(values[which])

        rounding, inputs = (
            {name: pick(values) for name, values in bounds.items()}
            for bounds in (self.rounding_error, self.input_error)
        )
        return MassProperties(
            pick(self.mass),
            self.center[which],
            self.inertia[which],
            self.principal.at(which),
            rounding,
            inputs,
        )

    def inertia_about(self, point: ArrayLike) -> Array:
        """Return the (3, 3) tensor about another point, by the parallel-axis theorem."""
        arm = float_array("point", point, 3) - self.center
        return self.inertia + self.mass * (arm @ arm * IDENTITY_3 - np.outer(arm, arm))

    @property
    def radii_of_gyration(self) -> Array:
        """(3,) sqrt(I/m) about the principal axes."""
        return np.sqrt(self.principal.moments / self.mass)

    def axes_bound(self, strain: float) -> float:
        """Return a bound of the turn of the principal axes of different moments, in radians (Davis
        and Kahan 1970).

        They turn with the errors of inertia, and with a `strain` of the body.
        """
        moments = self.principal.moments
        off = (
            self.rounding_error["inertia"] + self.input_error["inertia"] + 2.0 * strain * moments[2]
        )
        # An axis turns by at most asin(off / gap), for the least gap between true moments.
        gap = float(np.diff(moments).min()) - off
        return math.asin(off / gap) if off < gap else math.pi

    def in_frame(self, rotation: ArrayLike, origin: ArrayLike) -> MassProperties:
        """Return the same body in the frame with the columns of a rotation as axes and with this
        origin.
        """
        rotation = rotation_array("rotation", rotation)
        inverse = rotation.swapaxes(-1, -2)
        inertia = inverse @ self.inertia @ rotation
        arm = self.center - float_array("origin", origin, *self.center.shape)
        return replace(
            self,
            center=(inverse @ arm[..., None])[..., 0],
            inertia=(inertia + inertia.swapaxes(-1, -2)) / 2.0,
            principal=replace(self.principal, axes=inverse @ self.principal.axes),
        )


def has_certain_total(moments: Moments) -> PerBody:
    """Return whether totals exceed their rounding, and volumes also ten times what float32
    coordinates may change.
    """
    least = moments.rounding_error[..., 0]
    if moments.measure == Measure.VOLUME:
        least = np.maximum(least, moments.input_error[..., 0] / MAX_INPUT_SHARE)
    return moments.raw[..., 0] > least


def combine(
    bodies: Sequence[tuple[Moments, float]], preferred_axes: ArrayLike | None = None
) -> MassProperties:
    """Combine several bodies into one.

    Parameters
    ----------
    bodies : sequence of (Moments, float)
        Each body's moments and density.
    preferred_axes : (3, 3) array_like, optional
        As for `principal_frame`.

    Returns
    -------
    MassProperties

    Raises
    ------
    MeasureError
        If there is no certain mass.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> from body_moments.core.inertia import combine
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> volume, _ = polyhedron_moments(surface)
    >>> stretched = volume.transform(np.diag([2.0, 1.0, 1.0, 1.0]))
    >>> round(combine([(volume, 6.0), (stretched, 6.0)]).mass, 9)
    3.0
    """
    for moments, _ in bodies:
        check_type("bodies", moments, Moments)
    weighed = [replace(moments, measure=Measure.MASS) * density for moments, density in bodies]
    return MassProperties.from_moments(sum_moments(weighed), preferred_axes=preferred_axes)


def affine_image(
    properties: MassProperties,
    linear: ArrayLike,
    center: ArrayLike,
    mass: float,
    preferred_axes: ArrayLike,
) -> MassProperties:
    """Return the properties of an image of this `mass` and `center` under a (3, 3) map; its axes
    point the way of `preferred_axes`, and its bounds are those of the body.
    """
    linear = np.asarray(linear, np.float64)
    preferred = np.asarray(preferred_axes, np.float64)
    second = second_of_inertia(properties.inertia)
    second = linear @ second @ linear.T * (mass / properties.mass)
    spread, axes = np.linalg.eigh(second)
    spread = np.maximum(spread[::-1], 0.0)
    axes = axes[:, ::-1]
    axes = axes * np.where((axes * preferred).sum(axis=0) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, np.abs((axes * preferred).sum(axis=0)).argmin()] *= -1.0
    moments = np.array([spread[1] + spread[2], spread[2] + spread[0], spread[0] + spread[1]])
    return replace(
        properties,
        mass=float(mass),
        center=np.asarray(center, np.float64),
        inertia=inertia_of_second(second),
        principal=PrincipalFrame(moments, axes, symmetry="", is_unique=False, finding=None),
    )


def are_physical(volume: Moments, low: NDArray, high: NDArray, size: float | Array) -> Mask:
    """Return an (n,) mask of the bodies with a center in their (n, 3) boxes and with second moments
    that a mass can have. size: diagonals of the boxes, by which the centers may miss by a
    millionth.
    """
    total = volume.raw[:, 0]
    mean = volume.raw[:, 1:4] / total[:, None]
    second = (
        volume.raw[:, SECOND_MOMENT_INDEX] / total[:, None, None]
        - mean[:, :, None] * mean[:, None, :]
    )
    most = np.abs(second).max(axis=(1, 2))
    # An eigenvalue is off by at most three errors of entries; 8 leaves room for those of the
    # center.
    rounding = 8.0 * (
        volume.rounding_error[:, 4:10].max(axis=1) / total + np.finfo(float).eps * most
    )
    tolerance = (1e-6 * size + volume.rounding_error[:, 1:4].max(axis=1) / total)[:, None]
    center = volume.about + mean
    inside = ((low - tolerance <= center) & (center <= high + tolerance)).all(axis=1)
    return inside & (np.linalg.eigvalsh(second)[:, 0] >= -rounding)


def _propagate_errors(
    moments: Moments, density: NDArray
) -> tuple[dict[str, PerBody], dict[str, PerBody]]:
    """Return bounds of mass, center, inertia by rounding and by `input_error`; infinite if nothing
    bounds them.

    The arrays have a leading axis for the two: rounding, input.
    """
    error = np.array([moments.rounding_error, moments.input_error])
    raw = moments.raw
    total, total_error = raw[..., 0], error[..., 0]
    is_bounded = total > 2.0 * total_error
    least = np.where(is_bounded, total - total_error, 1.0)[..., None]
    total = np.where(is_bounded, total, 1.0)[..., None]
    first = np.abs(raw[..., 1:4])
    first_error = error[..., 1:4]
    shift = first / total
    center = _lengths((first_error + shift * total_error[..., None]) / least)
    cross = first_error[..., :, None] * shift[..., None, :]
    cross = (
        cross
        + cross.swapaxes(-1, -2)
        + shift[..., :, None] * shift[..., None, :] * total_error[..., None, None]
    )
    second = error[..., SECOND_MOMENT_INDEX] + cross * (total / least)[..., None]
    second = second + first_error[..., :, None] * (first_error / least)[..., None, :]
    # The results themselves are rounded, too: row 0 has the bounds of rounding.
    center[0] += 2.0 * U * _lengths(np.abs(moments.about) + 2.0 * shift[0])
    second[0] += (
        6.0
        * U
        * (np.abs(raw[..., SECOND_MOMENT_INDEX]) + first[..., :, None] * shift[0][..., None, :])
    )
    tensor = second.trace(axis1=-2, axis2=-1)[..., None, None] * IDENTITY_3 + second
    inertia = np.abs(density) * _lengths(tensor.reshape(*tensor.shape[:-2], 9))
    total_error[0] += U * raw[..., 0]
    bounds = (
        np.abs(density) * total_error,
        np.where(is_bounded, center, np.inf),
        np.where(is_bounded, inertia, np.inf),
    )
    columns = bounds if raw.ndim > 1 else [bound.tolist() for bound in bounds]
    rounding, inputs = (
        dict[str, PerBody](zip(("mass", "center", "inertia"), each)) for each in zip(*columns)
    )
    return rounding, inputs


def _lengths(vectors: NDArray) -> Array:
    """Return the lengths (...,) of (..., k) vectors with squares that may underflow."""
    lengths = [math.hypot(*vector) for vector in vectors.reshape(-1, vectors.shape[-1]).tolist()]
    return np.array(lengths).reshape(vectors.shape[:-1])
