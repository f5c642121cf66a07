# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The principal frame of a body, made unique if the body allows it.

The axes are the eigenvectors of the central second moments, largest first, so that axis 1 is the
long axis (least inertia). Their signs follow Zhang and Chen (ICIP 2001, eq. 11): central third
moments positive. Their rule fails on every body with a mirror plane, because M_300 is noise, so it
is made robust (see `third_moment_frames`). If equal second moments or a lack of skewness leave a
choice, the frame nearest to the axes that the caller prefers is taken, and `finding` says so. So
copies that are turned as objects have the same frame in their objects' axes, and a frame never
flips from one run to the next. Moments above third order are used by `core.shape.unique_frame`.

The pose of a body is its center at the origin and a frame along the axes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..moments import Moments, affine_matrices
from ..numerics import (
    Array,
    ArrayLike,
    NDArray,
    PerBody,
    check_type,
    float_array,
    quaternion,
    rotation_array,
)
from ..verdict import OBJECT_SIZE, TOO_SMALL, MeasureError, finding
from .findings import (
    ANY_DIRECTIONS,
    AXES_AMBIGUOUS,
    AXES_FREE,
    NEGATIVE_INERTIA,
    STRICT_RULE_UNDEFINED,
)
from .plain_body import EQUAL_AXES, SYMMETRIES
from .third_moment_frames import (
    HALF_TURN_SIGNS,
    SecondMoments,
    ThirdMomentFrames,
    complete_free_axes,
    nearest_frames,
    second_moments,
    third_moment_frames,
)

SIGN_BITS = np.array([1, 2, 4, 8])  # a bit for each of the HALF_TURN_SIGNS, set if it is allowed

# The findings of directions chosen by the preferred axes, by symmetry.
CHOICES = {
    name: (
        finding(AXES_FREE, axes=[axis + 1 for axis in axes], choice=ANY_DIRECTIONS)
        if axes
        else finding(AXES_AMBIGUOUS)
    )
    for name, axes in EQUAL_AXES.items()
}


@dataclass(frozen=True, eq=False)
class PrincipalFrame:
    """Principal moments and axes of one body; for a stack of bodies all attributes have a leading
    axis.

    `moments`: (3,) principal moments of inertia, ascending. `axes`: (3, 3) columns, determinant 1;
    axis 1 is the long one. `symmetry`: "asymmetric", "prolate" (moments 2 and 3 equal), "oblate" (1
    and 2 equal) or "isotropic". `is_unique`: True if the body alone fixes the frame; else `finding`
    has the choice that was made. `undetermined_axes`: the axes without a fixed direction, as far as
    the moments show.
    """

    moments: Array
    axes: Array
    symmetry: PerBody
    is_unique: PerBody
    finding: PerBody
    undetermined_axes: PerBody = field(default_factory=tuple)

    @classmethod
    def on_demand(cls, moments: Array, find: Callable[[], PrincipalFrame]) -> PrincipalFrame:
        """Return a frame with known principal moments, whose other values `find` is asked for when
        one is needed.
        """
        frame = object.__new__(cls)
        frame.__dict__.update(moments=moments, find=find)
        return frame

    def __getattr__(self, name: str) -> Any:
        find = self.__dict__.get("find")
        if find is not None:  # several threads may find the same values
            self.__dict__.update({**vars(find()), "moments": self.moments, "find": None})
        if name not in self.__dict__:
            raise AttributeError(name)
        return self.__dict__[name]

    def __getstate__(self) -> dict[str, Any]:
        _ = self.axes  # is found now: the function that finds it cannot be pickled
        return vars(self)

    def scaled(self, density: NDArray) -> PrincipalFrame:
        """Return the frame of a body with another density, (...,)."""
        frame = object.__new__(PrincipalFrame)
        moments = density[..., None] * self.moments
        # Rounding may violate the inequality of a flat body's moments.
        moments[..., 2] = np.minimum(moments[..., 2], moments[..., 0] + moments[..., 1])
        frame.__dict__.update(self.__dict__, moments=moments)
        return frame

    @property
    def quaternion(self) -> Array:
        """(..., 4) w, x, y, z that turn the coordinate axes into the principal ones."""
        return quaternion(self.axes)

    def at(self, which: int | list[int]) -> PrincipalFrame:
        """Return one frame of a stack, or a stack of some of them."""
        is_unique = self.is_unique[which]
        return PrincipalFrame(
            self.moments[which],
            self.axes[which],
            self.symmetry[which],
            is_unique if isinstance(which, list) else bool(is_unique),
            self.finding[which],
            self.undetermined_axes[which],
        )


def principal_frame(
    moments: Moments,
    preferred_axes: ArrayLike | None = None,
    refine: Callable[[], Moments] | None = None,
) -> PrincipalFrame:
    """Return the principal frame of a body with positive total.

    Parameters
    ----------
    moments : Moments
        To order 3 at least.
    preferred_axes : (3, 3) array_like, optional
        A rotation with the axes to stay near to, as columns, if the moments leave a choice; by
        default the coordinate axes.
    refine : callable, optional
        Returns the moments with exact third order; called if their bounds do not decide.

    Returns
    -------
    PrincipalFrame

    Raises
    ------
    MeasureError
        If no body can have the second moments.

    Notes
    -----
    Zhang and Chen 2001, eq. 11, made robust; see the module.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments, principal_frame
    >>> surface = Surface.from_triangles(
    ...     np.eye(4, 3, -1) * (3, 2, 1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    ... )
    >>> frame = principal_frame(polyhedron_moments(surface)[0])
    >>> frame.symmetry, frame.is_unique, np.round(frame.moments, 4).tolist()
    ('asymmetric', True, [0.1589, 0.3886, 0.5025])
    """
    check_type("moments", moments, Moments)
    preferred_axes = (
        np.eye(3) if preferred_axes is None else rotation_array("preferred_axes", preferred_axes)
    )
    return frame_of_body(moments, preferred_axes, refine)


def frame_of_body(
    moments: Moments, preferred_axes: NDArray, refine: Callable[[], Moments] | None = None
) -> PrincipalFrame:
    """Return the frame of a body with positive total; axes of moments that need no refinement are
    found on demand.
    """
    if refine is not None:
        fixed = frames_of_body(moments, refine=refine)
        return principal_frames(fixed, preferred_axes[None]).at(0)
    stack = moments.at(None)
    second = _second_moments_of_body(stack)
    preferred = preferred_axes[None].copy()  # the caller may change its array before the search
    return PrincipalFrame.on_demand(
        second.inertia[0],
        lambda: principal_frames(third_moment_frames(stack, second=second), preferred).at(0),
    )


def principal_frames(fixed: ThirdMomentFrames, preferred_axes: NDArray) -> PrincipalFrame:
    """Return the principal frames of a stack of n bodies, as `principal_frame` does for one.

    The result has a leading axis; symmetry, finding and undetermined_axes are arrays of objects.
    """
    count = len(fixed.moments)
    symmetry = np.array(SYMMETRIES, object)[fixed.symmetry]
    chosen = np.full(count, None)
    undetermined = np.empty(count, object)
    undetermined[:] = [()] * count
    axes = fixed.axes * HALF_TURN_SIGNS[fixed.allowed.argmax(axis=1)][:, None]
    is_open = (fixed.symmetry > 0) | (fixed.allowed.sum(axis=1) != 1)
    # Bodies of one kind, with the same allowed signs and symmetry, have candidates of one shape.
    kind = fixed.allowed @ SIGN_BITS + 16 * fixed.symmetry
    for number in sorted(set(kind[is_open].tolist())):
        bodies = np.flatnonzero(is_open & (kind == number))
        name = SYMMETRIES[number // 16]
        free = EQUAL_AXES[name]
        undetermined[bodies] = [free] * len(bodies)
        chosen[bodies] = CHOICES[name]
        preferred = preferred_axes[bodies]
        if len(free) == 3:
            axes[bodies] = preferred + 0.0  # no negative zeros
            continue
        signs = HALF_TURN_SIGNS[fixed.allowed[bodies[0]], None]
        frames = complete_free_axes(fixed.axes[bodies, None] * signs, free, preferred[:, None])
        axes[bodies] = nearest_frames(frames, preferred, fixed.tilt[bodies])
    return PrincipalFrame(fixed.moments, axes, symmetry, ~is_open, chosen, undetermined)


def frames_of_body(
    moments: Moments, noise_factor: float = 1.0, refine: Callable[[], Moments] | None = None
) -> ThirdMomentFrames:
    """Return the frames of a stack of one body, or raise MeasureError if no body can have the
    second moments.
    """
    refined = None if refine is None else (lambda _which: refine().at(None))
    stack = moments.at(None)
    return third_moment_frames(stack, refined, noise_factor, _second_moments_of_body(stack))


def _second_moments_of_body(stack: Moments) -> SecondMoments:
    """Return the second moments of a stack of one body, or raise MeasureError."""
    second = second_moments(stack)
    if not second.is_body[0]:
        central = stack.truncate(2).about_center().raw[0, 4:]
        if np.abs(central).max() < np.finfo(float).tiny:  # lost in the smallest of numbers
            raise MeasureError(OBJECT_SIZE, fault=TOO_SMALL)
        raise MeasureError(NEGATIVE_INERTIA)
    return second


def zhang_chen_frame(
    moments: Moments, refine: Callable[[], Moments] | None = None
) -> PrincipalFrame:
    """Return the frame by Zhang and Chen's rule (ICIP 2001, eq. 11): axes 1 and 2 point along
    positive M_300 and M_030.

    Axis 3 completes a right-handed frame. moments, to order 3 at least, and refine are as for
    `principal_frame`. MeasureError if one of the two moments is noise, or second moments are equal:
    the rule has no answer there.
    """
    check_type("moments", moments, Moments)
    fixed = frames_of_body(moments)
    if (
        refine is not None
        and not (np.abs(fixed.skewness[0, :2]) > 2.0 * fixed.skewness_error[0, :2]).all()
    ):
        fixed = frames_of_body(refine())
    if fixed.symmetry[0]:
        raise MeasureError(STRICT_RULE_UNDEFINED, where="for equal principal moments")
    if not (np.abs(fixed.skewness[0, :2]) > fixed.skewness_error[0, :2]).all():
        raise MeasureError(STRICT_RULE_UNDEFINED, where="without skewness along axes 1 and 2")
    axes = fixed.axes[0].copy()
    axes[:, :2] *= np.sign(fixed.skewness[0, :2])
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return PrincipalFrame(fixed.moments[0], axes, SYMMETRIES[0], True, None)


def pose_matrix(center: ArrayLike, axes: ArrayLike) -> Array:
    """Return the matrix that brings the center to the origin and the axes along x, y and z.

    Parameters
    ----------
    center : (3,) array_like
    axes : (3, 3) array_like
        A rotation, its axes as columns.

    Returns
    -------
    (4, 4) array
        For column vectors: pose = matrix @ (x, y, z, 1).

    Examples
    --------
    >>> from body_moments.core.inertia import pose_matrix
    >>> pose_matrix(np.array([1.0, 2.0, 3.0]), np.eye(3))[:3, 3].tolist()
    [-1.0, -2.0, -3.0]
    """
    axes = rotation_array("axes", axes)
    # no negative zeros
    return affine_matrices(axes.T, -axes.T @ float_array("center", center, 3)) + 0.0
