# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The rotations and reflections about its center that take a body to itself.

Moments give the candidates: a rotation takes one frame to another in which all moments, to some
order, are the same (see `canonical_frame`), and a reflection takes a frame of the body to one of
its mirror image. So every symmetry that the body has is a candidate; moments of higher order, or
details smaller than noise, may rule some out again; the body's geometry decides (`point_groups`).
The group is named by its Schoenflies symbol: C1 has no symmetry, D2h is a box, Oh a cube, C∞v a
body of revolution, K a ball.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..inertia import NOISE_LEVEL
from ..moments import Moments, invert_through_point
from ..numerics import Array, Mask, NDArray, check_type, distinct_arrays
from .axial_harmonics import MAX_TILT, AxialHarmonics, axis_last, turn_by_harmonics
from .unique_frames import equivalent_frames

EQUAL_OPERATION_ATOL = 1e-4  # matrices of one operation, known to noise, are equal to this

# For groups by moments to sixth order, the lower groups whose bodies have the same moments to that
# order.
UNDECIDED = {
    "Oh": "O",
    "Ih": "I",
    "D6h": "C6h, D6",
    "C6v": "C6",
    "D5h": "C5h",
    "D5d": "S10",
    "D4d": "S8",
}


@dataclass(frozen=True, eq=False)
class Symmetry:
    """Rotations and reflections about the center that take a body to itself.

    `operations`: (k, 3, 3) the finite ones, orthogonal, the identity among them. `revolution_axes`:
    (1, 3) the axis about which every rotation is a symmetry; (0, 3) none, (3, 3) all directions.
    `order`: the order of the moments it was found from, or of harmonics about an axis.
    """

    operations: Array
    revolution_axes: Array
    order: int

    @property
    def group(self) -> str:
        """The Schoenflies symbol."""
        if len(self.revolution_axes) == 3:
            return "K"
        if len(self.revolution_axes):
            axis = self.revolution_axes[0]
            return "D∞h" if _reverses_axis(self.operations, axis).any() else "C∞v"
        return _schoenflies(self)

    @property
    def axes(self) -> list[tuple[NDArray, int]]:
        """Rotation axes as (direction, order), the highest order first."""
        proper = self.operations[np.linalg.det(self.operations) > 0.0]
        turns = proper[np.trace(proper, axis1=1, axis2=2) < 3.0 - EQUAL_OPERATION_ATOL]
        lines = np.linalg.eigh(turns + turns.swapaxes(1, 2))[1][:, :, 2]
        is_same = np.abs(lines @ lines.T) > 1.0 - EQUAL_OPERATION_ATOL
        # Each axis once, at its first turn; its order is the number of its turns plus the identity.
        axes = [
            (lines[i], 1 + int(row.sum())) for i, row in enumerate(is_same) if np.argmax(row) == i
        ]
        return sorted(axes, key=lambda pair: -pair[1])

    @property
    def planes(self) -> list[NDArray]:
        """The normals of the reflection planes."""
        is_reflection = (np.linalg.det(self.operations) < 0.0) & (
            np.abs(np.trace(self.operations, axis1=1, axis2=2) - 1.0) < EQUAL_OPERATION_ATOL
        )
        return [
            np.linalg.eigh(reflection + reflection.T)[1][:, 0]
            for reflection in self.operations[is_reflection]
        ]

    @property
    def has_center(self) -> bool:
        """True if inversion in the center is one of the operations."""
        return bool(
            (np.abs(self.operations + np.eye(3)).max(axis=(1, 2)) < EQUAL_OPERATION_ATOL).any()
        )


def symmetry(
    moments: Moments,
    noise: float = NOISE_LEVEL,
    axial: Callable[[NDArray], AxialHarmonics] | None = None,
) -> Symmetry:
    """Find the symmetries that moments allow.

    Parameters
    ----------
    moments : Moments
        To third order at least.
    noise : float
        As for `equivalent_frames`.
    axial : callable, optional
        Returns the harmonics about the third axis of a (3, 3) frame; called if the moments are
        those of a body of revolution, about its axis.

    Returns
    -------
    Symmetry
        Every symmetry of the body is among them.

    Examples
    --------
    >>> from body_moments.core.mesh import Surface
    >>> from body_moments.core.polyhedron import polyhedron_moments
    >>> from body_moments.core.shape import symmetry
    >>> faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    >>> surface = Surface.from_triangles(np.eye(4, 3, -1), faces)
    >>> symmetry(polyhedron_moments(surface, 6)[0]).group
    'C3v'
    """
    check_type("moments", moments, Moments)
    central = moments.about_center()
    alike = equivalent_frames(central, noise)
    mirrored = equivalent_frames(invert_through_point(central), noise)
    order = moments.order
    is_known = max(alike.tilt, mirrored.tilt) <= MAX_TILT
    if axial is not None and is_known and len(alike.revolution_axes) == 1:
        harmonics = axial(axis_last(alike))
        order = harmonics.order
        alike = turn_by_harmonics(alike, harmonics, noise)
        mirrored = turn_by_harmonics(mirrored, harmonics.inverted(), noise)
    first = alike.frames[0]
    operations = [frame @ first.T for frame in alike.frames]
    # If the inverted body looks in its frames as the body does in its own, inversion and the turn
    # between both frames together are a symmetry.
    if (np.abs(alike.values - mirrored.values) <= alike.noise).all():
        operations += [-frame @ first.T for frame in mirrored.frames]
    axes = first.T[list(alike.revolution_axes)]
    operations = np.array(operations)
    if len(axes) == 1:
        # Turns about the axis are symmetries too, so that these operations stand for all.
        reflection = np.eye(3) - 2.0 * np.outer(axes[0], axes[0])
        is_reversed = _reverses_axis(operations, axes[0]).any()
        operations = np.array([np.eye(3), reflection] if is_reversed else [np.eye(3)])
    elif len(axes) == 3:
        operations = np.array([np.eye(3)])
    return Symmetry(distinct_arrays(operations, EQUAL_OPERATION_ATOL), axes, order)


def _reverses_axis(operations: NDArray, axis: NDArray) -> Mask:
    """Return which operations turn the axis around."""
    return (operations @ axis) @ axis < 0.0


def _schoenflies(finite: Symmetry) -> str:
    """Return the symbol of a group without axes of revolution.

    n is the highest order of an axis. The group is C or S if its proper operations are the n turns
    about that axis, else D, or T, O or I if several axes have an order n above 2.
    """
    axes = finite.axes
    planes = finite.planes
    proper = int((np.linalg.det(finite.operations) > 0.0).sum())
    has_improper = len(finite.operations) > proper
    if not axes:
        return ("Cs" if planes else "Ci") if has_improper else "C1"
    axis, n = axes[0]
    has_horizontal_plane = any(abs(normal @ axis) > 1.0 - EQUAL_OPERATION_ATOL for normal in planes)
    is_cubic = sum(order == n for _, order in axes) > 1 and n > 2
    if proper == n:
        if has_improper and not planes:
            return "S{:d}".format(2 * n)
        name = "C{:d}".format(n)
        mirrors = "h" if has_horizontal_plane else "v"
    elif is_cubic:
        name = {3: "T", 4: "O", 5: "I"}[n]
        mirrors = "h" if finite.has_center else "d"
    else:
        name = "D{:d}".format(n)
        is_horizontal = finite.has_center if n == 2 else has_horizontal_plane
        mirrors = "h" if is_horizontal else "d"
    return name + mirrors if has_improper else name
