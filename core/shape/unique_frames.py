# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The principal frame of a body, made unique by moments to sixth order if the body allows it.

Measure stores the frame of second and third moments (`principal_frame`). Its axes of equal moments,
and the signs without skewness, follow the object's axes. Poses, alignment and comparisons need axes
that follow the shape: `canonical_frame` searches them among the moments to sixth order. Any further
freedom is the body's own; there the frame nearest to the preferred axes is taken.
"""

import numpy as np

from ..inertia import (
    AXES_FREE,
    CHOICES,
    DIRECTIONS_OF_SHAPE,
    EQUAL_AXES,
    NOISE_LEVEL,
    SYMMETRIES,
    PrincipalFrame,
    complete_free_axes,
    frames_of_body,
    nearest_frames,
)
from ..moments import Moments
from ..numerics import Array, ArrayLike, NDArray, check_type, rotation_array
from ..verdict import finding
from .canonical_frame import EquivalentFrames, canonical_frames


def unique_frame(moments: Moments, preferred_axes: ArrayLike | None = None) -> PrincipalFrame:
    """Return the principal frame that moments to sixth order fix.

    Parameters
    ----------
    moments : Moments
        To order 6; of a lower order, they fix less.
    preferred_axes : (3, 3) array_like, optional
        A rotation with the axes to stay near to, as columns, if the body leaves a choice; by
        default the coordinate axes.

    Returns
    -------
    PrincipalFrame

    Raises
    ------
    MeasureError
        If no body can have the second moments, or the highest moments are no numbers.

    Examples
    --------
    >>> from body_moments.core import Surface, polyhedron_moments
    >>> from body_moments.core.shape import unique_frame
    >>> surface = Surface.from_triangles(
    ...     np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    ... )
    >>> frame = unique_frame(polyhedron_moments(surface, 6)[0])
    >>> frame.symmetry, frame.undetermined_axes, frame.finding.code
    ('oblate', (), 'axes_free')
    """
    check_type("moments", moments, Moments)
    preferred_axes = (
        np.eye(3) if preferred_axes is None else rotation_array("preferred_axes", preferred_axes)
    )
    fixed = frames_of_body(moments)
    symmetry = SYMMETRIES[fixed.symmetry[0]]
    frames = fixed.frames(0)
    if symmetry == "asymmetric" and len(frames) == 1:
        return PrincipalFrame(fixed.moments[0], frames[0], symmetry, True, None)
    alike = canonical_frames(moments, fixed.spread(0), frames)
    choice = None
    if alike.revolution_axes or symmetry == "asymmetric":
        choice = CHOICES[symmetry]
    elif len(alike.frames) > 1:
        choice = finding(
            AXES_FREE,
            axes=[axis + 1 for axis in EQUAL_AXES[symmetry]],
            choice=DIRECTIONS_OF_SHAPE,
        )
    is_unique = len(alike.frames) == 1 and not alike.revolution_axes
    return PrincipalFrame(
        fixed.moments[0],
        nearest_frame(alike, preferred_axes),
        symmetry,
        is_unique,
        None if is_unique else choice,
        undetermined_axes(alike.revolution_axes),
    )


def equivalent_frames(moments: Moments, noise: float = NOISE_LEVEL) -> EquivalentFrames:
    """Return the principal frames in which a body is the same; noise: of normalized third
    moments.
    """
    fixed = frames_of_body(moments, noise / NOISE_LEVEL)
    return canonical_frames(moments, fixed.spread(0), fixed.frames(0))


def nearest_frame(equivalent: EquivalentFrames, preferred_axes: NDArray) -> Array:
    """Return the equivalent frame nearest to the preferred axes, free axes turned to these. Both
    are (3, 3), with the axes as columns.
    """
    free = undetermined_axes(equivalent.revolution_axes)
    frames = complete_free_axes(equivalent.frames, free, preferred_axes)
    return nearest_frames(frames[None], preferred_axes[None], equivalent.tilt)[0]


def undetermined_axes(revolution_axes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the axes with directions that no moment fixes: those across an axis of revolution, all
    if there are several.
    """
    if not revolution_axes:
        return ()
    return tuple(i for i in range(3) if i not in revolution_axes) or (0, 1, 2)
