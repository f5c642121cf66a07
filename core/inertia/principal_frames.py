# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The principal frame of a body, made unique if the body allows it.

The axes are the eigenvectors of the central second moments, largest first, so that axis 1 is the
long axis (least inertia). Their signs follow Zhang and Chen (ICIP 2001, eq. 11): central third
moments positive. Their rule fails on every body with a mirror plane, because M_300 is noise, so it
is made robust (see `third_moment_frames`). Moments to sixth order decide if equal moments or a lack
of skewness leave a choice (see `canonical_frame`). Any further freedom is the body's own: there the
frame nearest to the axes that the caller prefers is taken, and `finding` says so.

Moments to sixth order may be given in coordinates of the body's own, with the rotation from there:
then bodies that are copies of each other, turned and scaled, have the same axes, and share the
search for them.

The pose of a body is its center at the origin and that frame along the axes: two copies of a part,
however they lie and whatever their faces, have one pose.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..moments.affine_maps import affine_matrices
from ..moments.moments import Moments
from ..numerics.arguments import check_type, float_array
from ..numerics.arrays import PerBody
from ..numerics.rotations import quaternion, rotation_array
from ..verdict.finding import MeasureError, finding
from ..verdict.findings import OBJECT_TOO_SMALL
from .canonical_frame import NOISE_LEVEL, EquivalentFrames, canonical_frames
from .findings import (
    AXES_AMBIGUOUS,
    AXES_FREE,
    AXES_FREE_BY_SHAPE,
    NEGATIVE_INERTIA,
    STRICT_RULE_UNDEFINED,
)
from .plain_body import EQUAL_AXES, SYMMETRIES
from .shared_search import choose_about_axis, choose_half_turns, shared_frames
from .third_moment_frames import (
    HALF_TURN_SIGNS,
    ThirdMomentFrames,
    align_frames,
    complete_free_axes,
    nearest_frames,
    third_moment_frames,
)

NO_VALUES = np.empty(0)
SIGN_BITS = np.array([1, 2, 4, 8])  # a bit for each of the HALF_TURN_SIGNS, set if it is allowed

# Findings if the body leaves a choice: of directions, by the preferred axes, or of several
# equivalent frames.
FREE, FREE_BY_SHAPE = (
    {
        name: finding(code, axes=[axis + 1 for axis in axes])
        for name, axes in EQUAL_AXES.items()
        if axes
    }
    | {"asymmetric": finding(AXES_AMBIGUOUS)}
    for code in (AXES_FREE, AXES_FREE_BY_SHAPE)
)


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

    moments: NDArray[np.float64]
    axes: NDArray[np.float64]
    symmetry: PerBody
    is_unique: PerBody
    finding: PerBody
    undetermined_axes: PerBody = ()

    @property
    def quaternion(self) -> NDArray[np.float64]:
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


@dataclass(frozen=True, eq=False)
class OwnMoments:
    """The moments to higher order of m bodies, each of them one of u shapes in coordinates of its
    own.

    `moments`: (u, K) of the shapes, to order 6. `shape`: (m,) the shape of each body. `rotation`:
    (m, 3, 3) turns the shape into the body, but for its size; None if they have the same
    coordinates, and each body is a shape of its own.
    """

    moments: Moments
    shape: NDArray[np.intp]
    rotation: NDArray[np.float64] | None = None


def principal_frame(
    moments: Moments,
    preferred_axes: ArrayLike | None = None,
    refine: Callable[[], Moments] | None = None,
    higher: Callable[[], Moments | OwnMoments] | None = None,
) -> PrincipalFrame:
    """Return the principal frame of a body with positive total.

    Parameters
    ----------
    moments : Moments
        To order 3 at least.
    preferred_axes : (3, 3) array_like, optional
        A rotation with the axes to stay near to, as columns, if the body leaves a choice; by
        default the coordinate axes.
    refine : callable, optional
        Returns the moments with exact third order; called if their bounds do not decide.
    higher : callable, optional
        Returns the moments to order `canonical_frame.MAX_ORDER`; called if third order leaves a
        choice.

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

    def higher_of_all(_which: NDArray[np.intp]) -> OwnMoments:
        assert higher is not None
        found = higher()
        return (
            found
            if isinstance(found, OwnMoments)
            else OwnMoments(found.at(None), np.zeros(1, np.intp))
        )

    fixed = _frames_of_body(moments, refine=refine)
    return principal_frames(
        fixed, preferred_axes[None], None if higher is None else higher_of_all
    ).at(0)


def principal_frames(
    fixed: ThirdMomentFrames,
    preferred_axes: NDArray,
    higher: Callable[[NDArray[np.intp]], OwnMoments] | None = None,
) -> PrincipalFrame:
    """Return the principal frames of a stack of n bodies, as `principal_frame` does for one.

    The result has a leading axis; symmetry, finding and undetermined_axes are arrays of objects.
    `higher` returns the moments of given bodies to order `canonical_frame.MAX_ORDER`; called once,
    if third order leaves a choice.
    """
    count = len(fixed.moments)
    symmetry = np.array(SYMMETRIES, object)[fixed.symmetry]
    chosen = np.full(count, None)
    undetermined = np.empty(count, object)
    undetermined[:] = [()] * count
    axes = fixed.axes * HALF_TURN_SIGNS[fixed.allowed.argmax(axis=1)][:, None]
    left = np.flatnonzero((fixed.symmetry > 0) | (fixed.allowed.sum(axis=1) != 1))
    if higher is None:
        kind = fixed.allowed[left] @ SIGN_BITS + 16 * fixed.symmetry[left]
        for number in sorted(set(kind.tolist())):
            bodies = left[kind == number]
            name = SYMMETRIES[number // 16]
            allowed = fixed.allowed[bodies[0]]
            free = EQUAL_AXES[name]
            undetermined[bodies] = [free] * len(bodies)
            chosen[bodies] = FREE[name]
            frames = fixed.axes[bodies, None] * HALF_TURN_SIGNS[allowed, None]
            preferred = preferred_axes[bodies]
            frames = complete_free_axes(frames, free, preferred[:, None])
            axes[bodies] = nearest_frames(frames, preferred, fixed.tilt[bodies])
    elif len(left):
        known = higher(left)
        alike = _frames_of_shapes(fixed, left, known)
        together: dict[tuple[int, tuple[int, ...]], list[int]] = {}
        for i, shape in enumerate(known.shape.tolist()):
            together.setdefault(
                (len(alike[shape].frames), alike[shape].revolution_axes), []
            ).append(i)
        for (ways, revolution_axes), members in together.items():
            bodies = left[members]
            free = undetermined_axes(revolution_axes)
            if revolution_axes or ways > 1:
                choice = FREE if revolution_axes else FREE_BY_SHAPE
                chosen[bodies] = [choice[name] for name in symmetry[bodies]]
            if free:
                undetermined[bodies] = [free] * len(bodies)
            shapes = [alike[shape] for shape in known.shape[members].tolist()]
            frames = np.array([shape.frames for shape in shapes])
            if known.rotation is not None:
                frames = align_frames(known.rotation[members][:, None] @ frames, fixed, bodies)
            preferred = preferred_axes[bodies]
            frames = complete_free_axes(frames, free, preferred[:, None])
            axes[bodies] = nearest_frames(frames, preferred, [shape.tilt for shape in shapes])
    return PrincipalFrame(
        fixed.moments,
        axes,
        symmetry,
        np.array([found is None for found in chosen]),
        chosen,
        undetermined,
    )


def _frames_of_shapes(
    fixed: ThirdMomentFrames, left: NDArray[np.intp], known: OwnMoments
) -> list[EquivalentFrames]:
    """Return for each shape the frames in which it is the same, in the shape's coordinates."""
    which = left
    if known.rotation is not None:
        fixed = third_moment_frames(known.moments)
        which = np.arange(len(known.moments.raw))
    results: list[Any] = [None] * len(which)  # each is found below

    def keep(shapes: NDArray[np.intp], allowed: NDArray[np.bool_]) -> None:
        for shape, signs in zip(shapes.tolist(), allowed):
            body = int(which[shape])
            frames = fixed.axes[body] * HALF_TURN_SIGNS[signs, None]
            free = fixed.free(body)
            revolution = (3 - sum(free),) if free else ()
            results[shape] = EquivalentFrames(
                frames, NO_VALUES, NO_VALUES, revolution, float(fixed.tilt[body])
            )

    by_signs = np.flatnonzero(fixed.symmetry[which] == 0)
    if len(by_signs):
        keep(by_signs, choose_half_turns(known.moments.at(by_signs), fixed, which[by_signs]))
    about_axis = np.flatnonzero((fixed.symmetry[which] == 1) | (fixed.symmetry[which] == 2))
    if len(about_axis):
        is_round, allowed = choose_about_axis(
            known.moments.at(about_axis), fixed, which[about_axis]
        )
        keep(about_axis[is_round], allowed[is_round])
    others = np.array([shape for shape, found in enumerate(results) if found is None], np.intp)
    if len(others):
        for shape, found in zip(
            others.tolist(), shared_frames(known.moments.at(others), fixed, which[others])
        ):
            results[shape] = found
    return results


def equivalent_frames(moments: Moments, noise: float = NOISE_LEVEL) -> EquivalentFrames:
    """Return the principal frames in which a body is the same; noise: of normalized third
    moments.
    """
    fixed = _frames_of_body(moments, noise / NOISE_LEVEL)
    return canonical_frames(moments, fixed.spread(0), fixed.frames(0))


def _frames_of_body(
    moments: Moments, noise_factor: float = 1.0, refine: Callable[[], Moments] | None = None
) -> ThirdMomentFrames:
    """Return the frames of a stack of one body, or raise MeasureError if no body can have the
    second moments.
    """
    refined = None if refine is None else (lambda _which: refine().at(None))
    fixed = third_moment_frames(moments.at(None), refined, noise_factor)
    if not fixed.is_body[0]:
        is_lost = (
            np.abs(moments.raw[4:10]).max() < np.finfo(float).tiny
        )  # in the smallest of numbers
        raise MeasureError(OBJECT_TOO_SMALL if is_lost else NEGATIVE_INERTIA)
    return fixed


def nearest_frame(equivalent: EquivalentFrames, preferred_axes: NDArray) -> NDArray[np.float64]:
    """Return the equivalent frame nearest to the preferred axes.

    Both are (3, 3), with the axes as columns.
    """
    free = undetermined_axes(equivalent.revolution_axes)
    frames = complete_free_axes(equivalent.frames, free, preferred_axes)
    return nearest_frames(frames[None], preferred_axes[None], equivalent.tilt)[0]


def undetermined_axes(revolution_axes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the axes with directions that no moment fixes."""
    if not revolution_axes:
        return ()
    return tuple(i for i in range(3) if i not in revolution_axes) or (0, 1, 2)


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
    fixed = _frames_of_body(moments)
    if (
        refine is not None
        and not (np.abs(fixed.skewness[0, :2]) > 2.0 * fixed.skewness_error[0, :2]).all()
    ):
        fixed = _frames_of_body(refine())
    if fixed.symmetry[0]:
        raise MeasureError(STRICT_RULE_UNDEFINED, where="for equal principal moments")
    if not (np.abs(fixed.skewness[0, :2]) > fixed.skewness_error[0, :2]).all():
        raise MeasureError(STRICT_RULE_UNDEFINED, where="without skewness along axes 1 and 2")
    axes = fixed.axes[0].copy()
    axes[:, :2] *= np.sign(fixed.skewness[0, :2])
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return PrincipalFrame(fixed.moments[0], axes, SYMMETRIES[0], True, None)


def pose_matrix(center: ArrayLike, axes: ArrayLike) -> NDArray[np.float64]:
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
    return (
        affine_matrices(axes.T, -axes.T @ float_array("center", center, 3)) + 0.0
    )  # no negative zeros
