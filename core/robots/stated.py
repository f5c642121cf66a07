# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Statements of a robot description about its links in SI units, as the format means them, not yet judged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..verdict.finding import Finding
from .model import Pose, Shape


@dataclass(frozen=True, eq=False)
class StatedInertial:
    """One link's inertial as its file has it.

    Attributes
    ----------
    mass : float
    center : (3,) array
        In the link's frame.
    tensor : (3, 3) array
        Along the axes of the inertial frame, about the center.
    rotation : (3, 3) array
        The inertial frame's axes in the link's.
    angles : tuple of float, optional
        Roll, pitch and yaw, if the rotation was stated so.
    quaternion : tuple of float, optional
        Four numbers in the order of the file, if the rotation was stated so.

    Examples
    --------
    >>> from body_moments.core.robots.stated import StatedInertial
    >>> StatedInertial(1.0, np.zeros(3), np.diag([1.0, 2.0, 3.0]), np.eye(3)).inertia.diagonal().tolist()
    [1.0, 2.0, 3.0]
    """

    mass: float
    center: NDArray[np.float64]
    tensor: NDArray[np.float64]
    rotation: NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    angles: tuple[float, float, float] | None = None
    quaternion: tuple[float, ...] | None = None

    @property
    def inertia(self) -> NDArray[np.float64]:
        """(3, 3) the tensor along the link's axes."""
        return self.rotation @ self.tensor @ self.rotation.T

    def along_link(self, inertia: NDArray | None = None, **changes) -> StatedInertial:
        """Return it with the tensor along the link's axes, or another one, and other changes."""
        tensor = self.inertia if inertia is None else inertia
        return replace(self, tensor=tensor, rotation=np.eye(3), angles=None, quaternion=None, **changes)


@dataclass(frozen=True, eq=False)
class StatedShape:
    """A shape of a link.

    Attributes
    ----------
    shape : Shape
        For a mesh, `file` is the name in the description.
    role : str
        "visual" or "collision".
    angles : tuple of float, optional
        Roll, pitch and yaw, if its pose was stated so.
    points, triangles : arrays, optional
        Of a mesh that stands in the description itself.

    Examples
    --------
    >>> from body_moments.core.robots import Shape
    >>> from body_moments.core.robots.stated import StatedShape
    >>> StatedShape(Shape("sphere", (1.0,)), "visual").angles is None
    True
    """

    shape: Shape
    role: str
    angles: tuple[float, float, float] | None = None
    points: NDArray[np.float64] | None = None
    triangles: NDArray[np.integer] | None = None


@dataclass(frozen=True, eq=False)
class StatedLink:
    """One link as its file has it.

    Attributes
    ----------
    name : str
    inertial : StatedInertial, optional
    shapes : tuple of StatedShape
    span : tuple of int, optional
        Range of the inertial in the file, in bytes.
    moves : bool
        True if a missing inertial matters.
    findings : tuple of Finding
        About content that the reader could not use.
    local : (4, 4) array, optional
        If the file's coordinates are not the link's axes in its unit: from the former to the latter.

    Examples
    --------
    >>> from body_moments.core.robots.stated import StatedLink
    >>> StatedLink("base").shapes
    ()
    """

    name: str
    inertial: StatedInertial | None = None
    shapes: tuple[StatedShape, ...] = ()
    span: tuple[int, int] | None = None
    moves: bool = True
    findings: tuple[Finding, ...] = ()
    local: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False)
class Description:
    """A robot description.

    Attributes
    ----------
    name, format : str
    links : tuple of StatedLink
    source : bytes
        The whole file.
    scales : mapping of str to float
        "length": meters per unit of the file's numbers, "mass": kilograms.

    Examples
    --------
    >>> from body_moments.core.robots.stated import Description
    >>> Description("arm", "urdf", ()).links
    ()
    """

    name: str
    format: str
    links: tuple[StatedLink, ...]
    source: bytes = b""
    scales: Mapping[str, float] = field(default_factory=lambda: {"length": 1.0, "mass": 1.0})


def rotation_of_angles(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """Return the (3, 3) rotation Rz(yaw) Ry(pitch) Rx(roll), as in URDF and SDF.

    roll, pitch, yaw: radians.
    """
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def pose_of_angles(position: NDArray, angles: tuple[float, float, float]) -> Pose:
    """Return a pose stated by a position and roll, pitch and yaw."""
    return Pose(np.asarray(position, np.float64), rotation_of_angles(*angles))
