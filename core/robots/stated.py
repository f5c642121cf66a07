# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links of a robot description as its file states them, in SI units, not yet audited."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import atan2, inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..numerics import Array, NDArray, rotation_about
from ..verdict import Finding
from .model import Inertial, Pose, Shape, right_handed

if TYPE_CHECKING:
    from .read.mjcf_meshes import Fit, Weight

# The names of the tensor's entries in URDF and SDF.
ENTRIES = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
Angles = tuple[float, float, float]
# of lengths in m and scales: fifth powers and their products stay in the range of float64
LEAST = 1e-30
MOST = 1e30
SINGLE = 1e-7  # relative rounding in single precision, in which USD computes


class Place(NamedTuple):
    """A place in a file, from 1. file: a file that the description includes, "" for the description
    itself.
    """

    line: int = 1
    column: int = 1
    file: str = ""

    @property
    def values(self) -> dict[str, Any]:
        """The values of a finding that name the place."""
        return {"line": self.line, "column": self.column, "source": self.file}


@dataclass(frozen=True, eq=False)
class StatedInertial:
    """One link's inertial as its file states it.

    `center`: (3,) in the link's frame.
    `tensor`: (3, 3) about the center, along the axes of the inertial frame.
    `rotation`: (3, 3) the inertial frame's axes in the link's frame, as columns.
    `angles`: roll, pitch and yaw, if the rotation was stated so.
    `quaternion`: four numbers in the order of the file, if the rotation was stated so.
    """

    mass: float
    center: Array
    tensor: Array
    rotation: Array = field(default_factory=lambda: np.eye(3))
    angles: Angles | None = None
    quaternion: tuple[float, ...] | None = None

    @property
    def inertia(self) -> Array:
        """The (3, 3) tensor along the link's axes."""
        with np.errstate(invalid="ignore", over="ignore"):  # numbers of a file, not yet audited
            return self.rotation @ self.tensor @ self.rotation.T

    @property
    def is_turned(self) -> bool:
        """True if the inertial frame is not along the link's axes."""
        return bool((self.rotation != np.eye(3)).any())

    def along_link(self, inertia: NDArray | None = None, **changes) -> StatedInertial:
        """Return a copy in a frame along the link's axes, with its own or a given inertia, and
        other changes.
        """
        tensor = self.inertia if inertia is None else inertia
        return replace(
            self, tensor=tensor, rotation=np.eye(3), angles=None, quaternion=None, **changes
        )

    def principal(self) -> Inertial:
        """Return an inertial with principal moments and axes, no moment above the sum of the
        others.
        """
        tensor = (self.inertia + self.inertia.T) / 2.0
        moments, axes = np.linalg.eigh(tensor)
        moments[2] = min(moments[2], moments[0] + moments[1])
        return Inertial(self.mass, self.center, tensor, moments, right_handed(axes))


@dataclass(frozen=True, eq=False)
class StatedShape:
    """A shape of a link; `role` is "visual" or "collision".

    `shape`: for a mesh, its `file` is the name in the description. `angles`: roll, pitch and yaw,
    if the pose was stated so. `beside`: the file that the names of its meshes are relative to, ""
    for the description itself. `fit`: the primitive that stands for the mesh. `weight`: its mass,
    if the link's inertial may come from its shapes; `rules`: more that is stated of it.

    ValueError, with the numbers as text, if a size is not positive, a factor of a mesh is zero, or
    a size or the place is not finite, or too large or small to compute with.
    """

    shape: Shape
    role: str
    angles: Angles | None = None
    place: Place = Place()
    beside: str = ""
    fit: Fit | None = None
    weight: Weight | None = None
    rules: Rules | None = None

    def __post_init__(self) -> None:
        shape = self.shape
        sizes = np.abs(shape.size) if shape.kind == "mesh" else np.array(shape.size)
        if not ((sizes >= LEAST) & (sizes <= MOST)).all():
            raise ValueError(" ".join(map("{:.16g}".format, shape.size)))
        for values in (shape.pose.position, shape.pose.rotation):
            if not (np.abs(values) <= MOST).all():
                raise ValueError(" ".join(map("{:.16g}".format, values.ravel()[:9])))


class Rules(NamedTuple):
    """The changes that a format's program makes to a body's inertial, or that of one of its shapes.

    from_shapes: "true", "false", or "auto" if only a missing inertial comes from the shapes.
    least_mass, least_moment: lower bounds, kg and kg·m². balances: True if moments that no body has
    become their mean. mass: kg, of the whole of the shapes; 0 if their own counts. center: (3,),
    moments: (3,) and axes: (3, 3) columns of their directions, instead of those of the shapes.
    radius: m, of the ball that stands for missing shapes.
    """

    from_shapes: str = "auto"
    least_mass: float = 0.0
    least_moment: float = 0.0
    balances: bool = False
    mass: float = 0.0
    center: Array | None = None
    moments: Array | None = None
    axes: Array | None = None
    radius: float = 0.0

    def complete(self, body: StatedInertial | None) -> StatedInertial | None:
        """Return the inertial of shapes with the stated values; None if there is neither."""
        if body is None:
            if not self.mass or not self.radius and self.moments is None:
                return None
            center = np.zeros(3) if self.center is None else self.center
            # A ball of 1 kg has the moment 2/5 r² about any axis.
            body = StatedInertial(1.0, center, 0.4 * self.radius**2 * np.eye(3))
        mass = self.mass or body.mass
        center = body.center if self.center is None else self.center
        # Programs keep the shapes' place, and take their inertia about the stated center.
        term = parallel_axis_term(mass, center - body.center)
        inertia = body.inertia * (mass / body.mass) + term
        if self.moments is not None or self.axes is not None:
            nearest_axes = _least_turn(inertia)
            moments = self.moments
            if moments is None:
                moments = np.diag(nearest_axes.T @ inertia @ nearest_axes)
            axes = nearest_axes if self.axes is None else self.axes
            inertia = (axes * moments) @ axes.T
        return StatedInertial(mass, center, inertia)

    def bound(self, stated: StatedInertial | None) -> StatedInertial | None:
        """Return the inertial within the bounds; itself if nothing changes."""
        if stated is None and not self.least_mass > 0.0 and not self.least_moment > 0.0:
            return None
        body = stated or StatedInertial(0.0, np.zeros(3), np.zeros((3, 3)))
        moments, axes = np.linalg.eigh(body.inertia)
        # MuJoCo refuses a full tensor of negative moments, and never bounds them.
        if moments[0] < 0.0 and (body.tensor != np.diag(np.diag(body.tensor))).any():
            return stated
        # A bound of 0 is none: negative numbers stay.
        mass = max(body.mass, self.least_mass or -inf)
        bounded = np.maximum(moments, self.least_moment or -inf)
        if self.balances and bounded[2] > bounded[0] + bounded[1]:
            bounded[:] = bounded.mean()
        if mass == body.mass and (bounded == moments).all():
            return stated
        return body.along_link((axes * bounded) @ axes.T, mass=mass)


def _least_turn(tensor: NDArray) -> Array:
    """Return the principal axes to which Jacobi's rotations, the largest entry first, turn the
    coordinate axes.
    """
    axes = np.eye(3)
    for _ in range(24):  # USD's own limit
        along = axes.T @ tensor @ axes
        i, j = max(((1, 2), (2, 0), (0, 1)), key=lambda pair: abs(along[pair]))
        if abs(along[i, j]) <= SINGLE * along.trace():  # Equal moments keep their axes.
            break
        # The angle, at most 45 degrees, that makes the entry zero.
        angle = atan2(2.0 * along[i, j], abs(along[j, j] - along[i, i])) / 2.0
        if along[j, j] >= along[i, i]:
            angle = -angle
        third = 3 - i - j  # the axis that stays
        axes = axes @ rotation_about(np.eye(3)[third], angle)
    return axes


@dataclass(frozen=True, eq=False)
class StatedLink:
    """One link as its file states it.

    `pose`: in the model, with all joints at zero; None if only joints place it.
    `place`, `inertial_place`: of the link and of its inertial, which is the link's if there is
    none. `span`: range of the inertial in the file, in bytes. `moves`: True if a missing inertial
    matters. `findings`: about content that the reader could not use. `local`: (4, 4) from the
    file's coordinates to the link's axes, in the file's unit; None if they are the same. `rules`:
    the changes that the format's own program makes to the inertial. `from_shapes`: True if the
    inertial is that of the masses that its shapes state. `overridden`: a stated inertial that the
    format's program does not use.
    """

    name: str
    inertial: StatedInertial | None = None
    shapes: tuple[StatedShape, ...] = ()
    span: tuple[int, int] | None = None
    moves: bool = True
    findings: tuple[Finding, ...] = ()
    local: Array | None = None
    place: Place = Place()
    inertial_place: Place = Place()
    rules: Rules | None = None
    from_shapes: bool = False
    overridden: StatedInertial | None = None
    pose: Pose | None = None

    @property
    def is_frame(self) -> bool:
        """True for a frame without geometry, mass and inertia, whose zeros are stated."""
        inertial = self.inertial
        return bool(
            inertial and not self.shapes and not inertial.mass and not inertial.tensor.any()
        )


class Motion(NamedTuple):
    """One motion of a child link relative to its parent.

    name: of the value of `--joint`. kind: "hinge", "slide", "fixed", or another one that has not
    one value. axis: (3,) unit vector, and origin: (3,) point on it, m, in the child's frame. zero:
    the value of the pose that the file states, radians or meters. leader: the name of the motion
    that this one follows. powers: the coefficients of the powers, from 0, of the leader's distance
    from its zero, whose sum is this one's.
    """

    name: str
    kind: str = "fixed"
    axis: Array = np.array([1.0, 0.0, 0.0])
    origin: Array = np.zeros(3)
    zero: float = 0.0
    leader: str = ""
    powers: tuple[float, ...] = (0.0, 1.0)

    def pose(self, value: float) -> Pose:
        """Return the pose of the moved child in the unmoved one."""
        value = value - self.zero
        if self.kind == "slide":
            return Pose(value * self.axis)
        turn = rotation_about(self.axis, value)
        return Pose(self.origin - turn @ self.origin, turn)


@dataclass(frozen=True, eq=False)
class StatedJoint:
    """The connection of a link with its parent, "" for the world, by motions in a row.

    pose: of the child in the parent, unmoved; None if it follows from the poses of both links.
    """

    name: str
    parent: str
    child: str
    pose: Pose | None = None
    motions: tuple[Motion, ...] = ()
    place: Place = Place()


@dataclass(frozen=True, eq=False)
class Description:
    """A robot description, with the whole file as `source`. scales: units of its "length" in m and
    "mass" in kg. total: the mass that all inertials are scaled to, kg; 0 if they stay. findings:
    about joints.
    """

    name: str
    format: str
    links: tuple[StatedLink, ...]
    source: bytes = b""
    scales: Mapping[str, float] = field(default_factory=lambda: {"length": 1.0, "mass": 1.0})
    total: float = 0.0
    joints: tuple[StatedJoint, ...] = ()
    findings: tuple[Finding, ...] = ()


def parallel_axis_term(mass: float, arm: NDArray) -> Array:
    """Return the (3, 3) inertia of a mass at a (3,) distance from the point that it is about."""
    return mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def rotation_of_angles(roll: float, pitch: float, yaw: float) -> Array:
    """Return the (3, 3) rotation Rz(yaw) Ry(pitch) Rx(roll), as in URDF and SDF, of angles in
    radians.
    """
    cr, cp, cy = np.cos([roll, pitch, yaw])
    sr, sp, sy = np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
