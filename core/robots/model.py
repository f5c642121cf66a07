# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Links, joints and their contents in SI units: the data that robot formats are written from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf
from typing import NamedTuple

import numpy as np

from ..inertia import combine
from ..mesh import Surface
from ..moments import KNOWN_ORDER
from ..moments.raw import SECOND_MOMENT_INDEX, Measure, Moments, monomial_count
from ..numerics import Array, NDArray, second_of_inertia

# Known values of an axis: N·m·s/rad or N·s/m, N·m or N, N·m/rad or N/m, N·m or N, rad/s or m/s.
VALUES = ("damping", "friction", "stiffness", "effort", "velocity")
# Relative to the largest entry; chosen: some roundings of a product of three (3, 3) matrices.
AGREEING_RTOL = 8.0 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True, eq=False)
class Pose:
    """The place of a frame in another one: x_other = rotation @ x + position, with (3, 3) and (3,)
    arrays, m.
    """

    position: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def __matmul__(self, other: Pose) -> Pose:
        """Return the pose of a frame in the outer frame, from its pose `other` in this frame."""
        return Pose(self.rotation @ other.position + self.position, self.rotation @ other.rotation)

    def apply(self, points: NDArray) -> Array:
        """Return (n, 3) points of the frame in the other one."""
        return points @ self.rotation.T + self.position

    @property
    def matrix(self) -> Array:
        """The (4, 4) map from the frame to the other one."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rotation
        matrix[:3, 3] = self.position
        return matrix

    def inverse(self) -> Pose:
        """Return the pose of the outer frame in this one."""
        return Pose(-self.rotation.T @ self.position, self.rotation.T)


@dataclass(frozen=True, eq=False)
class Inertial:
    """Mass, center and inertia of one link, along the link's axes.

    mass: kg. center: (3,) in the link's frame, m. inertia: (3, 3) about the center, kg·m²; I_xy =
    -∫xy dm. moments: (3,) principal moments, kg·m², ascending, none greater than the sum of the
    others. axes: (3, 3) principal axes as columns, determinant 1.
    """

    mass: float
    center: Array
    inertia: Array
    moments: Array
    axes: Array

    @classmethod
    def with_agreeing_axes(
        cls, mass: float, center: NDArray, inertia: NDArray, moments: NDArray, axes: NDArray
    ) -> Inertial:
        """Return an inertial whose principal moments and axes reproduce its tensor to rounding.

        For almost equal moments a measurement takes axes near to the object's own, so the pair may
        differ from the tensor by a millionth. Readers of the pair alone would miss that, so the
        axes are turned to the tensor's.
        """
        largest = np.abs(inertia).max()
        along = axes.T @ inertia @ axes
        if np.abs(along - np.diag(moments)).max() > AGREEING_RTOL * largest:
            moments_of_tensor, turn = np.linalg.eigh(along)
            axes = right_handed(axes @ turn)
            # A rod's least moment is known far better than the tensor has it.
            differs = np.abs(moments_of_tensor - moments) > AGREEING_RTOL * largest
            moments = np.where(differs, moments_of_tensor, moments)
            moments[2] = min(moments[2], moments[0] + moments[1])
        return cls(float(mass), center, inertia, moments, axes)

    def share(self, part: float) -> Inertial:
        """Return the inertial of a body with a part of this one's density."""
        return replace(
            self, mass=part * self.mass, inertia=part * self.inertia, moments=part * self.moments
        )

    def place(self, pose: Pose) -> Inertial:
        """Return the inertial in another frame, in which the link has the given pose."""
        turn = pose.rotation
        inertia = turn @ self.inertia @ turn.T
        return Inertial(
            self.mass,
            turn @ self.center + pose.position,
            (inertia + inertia.T) / 2.0,
            self.moments,
            turn @ self.axes,
        )


@dataclass(frozen=True, eq=False)
class Shape:
    """A visual or collision shape of a link.

    kind: "mesh", "box", "ellipsoid", "capsule", "cylinder" or "sphere". pose: in the link's frame.
    size: m; sides of a box, semi-axes of an ellipsoid, radius and length along z of a capsule
    (without its caps) or a cylinder, the radius of a sphere, the factors along the axes of a mesh.
    file: a mesh's file, with slashes, relative to the file that names it. sheet: True if the mesh
    bounds no volume. surface: the geometry of a mesh that is to be written, in meters along the
    axes of the shape. collides: False for a shape that is only seen. seen: False for a shape that
    only collides. mass: kg, of the part of the link that the shape stands for, if known.
    """

    kind: str
    size: tuple[float, ...] = (1.0, 1.0, 1.0)
    pose: Pose = field(default_factory=Pose)
    file: str = ""
    sheet: bool = False
    surface: Surface | None = None
    collides: bool = True
    seen: bool = True
    mass: float = 0.0


@dataclass(frozen=True, eq=False)
class FreeAxis:
    """One degree of freedom of a joint: "rotate" or "translate", along a (3,) unit axis in the
    joint's frame.

    lower, upper: limits in radians or meters, infinite if unlimited. values: those of VALUES that
    are known, by name.
    """

    kind: str
    axis: Array
    lower: float = -inf
    upper: float = inf
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_limited(self) -> bool:
        """True if either limit is finite."""
        return self.lower > -inf or self.upper < inf

    def reverse(self) -> FreeAxis:
        """Return the freedom with the same positions for parent and child exchanged."""
        return replace(self, axis=-self.axis)


class Mimic(NamedTuple):
    """The position of a joint follows another joint's: multiplier · position + offset, in radians
    or meters.
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, eq=False)
class Joint:
    """The joint between a link and its parent.

    free: the axis next to the parent first. pose: the joint's frame in the child's frame.
    """

    name: str
    parent: str
    child: str
    free: tuple[FreeAxis, ...] = ()
    pose: Pose = field(default_factory=Pose)
    mimic: Mimic | None = None

    @property
    def is_ball(self) -> bool:
        """True if the joint only rotates, about three axes without limits."""
        turns = [free for free in self.free if free.kind == "rotate" and not free.is_limited]
        return len(turns) == len(self.free) == 3


@dataclass(frozen=True, eq=False)
class Link:
    """One rigid part.

    inertial: None for a frame without mass. pose: in the world.
    scale: (3,) scale of the source's own geometry along the link's axes, if it is not written anew.
    is_fixed: True if it cannot move in the world. A robot needs that of roots alone.
    """

    name: str
    inertial: Inertial | None = None
    pose: Pose = field(default_factory=Pose)
    shapes: tuple[Shape, ...] = ()
    scale: Array = field(default_factory=lambda: np.ones(3))
    is_fixed: bool = False

    def moved_to(self, origin: Array) -> Link:
        """Return the same link with its frame's origin at a (3,) point of the former frame."""
        back = Pose(-origin)
        return replace(
            self,
            inertial=self.inertial and self.inertial.place(back),
            pose=self.pose @ Pose(origin),
            shapes=tuple(replace(shape, pose=back @ shape.pose) for shape in self.shapes),
        )


@dataclass(frozen=True, eq=False)
class Robot:
    """Links, and joints that make trees of them.

    ValueError if names repeat, a link is missing, or joints loop.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...] = ()

    def __post_init__(self) -> None:
        names = {link.name for link in self.links}
        if len(names) < len(self.links) or len(self._joint_by_child) < len(self.joints):
            raise ValueError("a name stands twice")
        if not names.issuperset(
            [name for joint in self.joints for name in (joint.parent, joint.child)]
        ):
            raise ValueError("joint without link")
        if len([*self.ordered()]) < len(self.links):  # Links of a loop are below no root.
            raise ValueError("joints close a loop")

    @cached_property
    def _link_by_name(self) -> dict[str, Link]:
        return {link.name: link for link in self.links}

    @cached_property
    def _joint_by_child(self) -> dict[str, Joint]:
        return {joint.child: joint for joint in self.joints}

    @cached_property
    def _children(self) -> dict[str, list[Link]]:
        below: dict[str, list[Link]] = {}
        for link in self.links:
            joint = self._joint_by_child.get(link.name)
            if joint is not None:
                below.setdefault(joint.parent, []).append(link)
        return below

    @property
    def roots(self) -> tuple[Link, ...]:
        """The links without a parent."""
        return tuple(link for link in self.links if link.name not in self._joint_by_child)

    def link(self, name: str) -> Link:
        """Return the link with a name."""
        return self._link_by_name[name]

    def joint_of(self, child: str) -> Joint | None:
        """Return the joint between a link and its parent, None for a root."""
        return self._joint_by_child.get(child)

    def children(self, name: str) -> list[Link]:
        """Return the child links of the link with a name."""
        return self._children.get(name, [])

    def ordered(self) -> Iterator[Link]:
        """Yield all links, parents before their children."""
        waiting = list(reversed(self.roots))
        while waiting:
            link = waiting.pop()
            yield link
            waiting.extend(reversed(self.children(link.name)))

    def pose_in_parent(self, link: Link) -> Pose:
        """Return the pose of a link in its parent's frame; of a root, in the world's."""
        joint = self.joint_of(link.name)
        if joint is None:
            return link.pose
        outer = self.link(joint.parent).pose
        # Equal frames without rounding.
        return Pose() if outer is link.pose else outer.inverse() @ link.pose

    def with_fixed_roots(self) -> Robot:
        """Return the robot with all its roots fixed to the world."""
        roots = {link.name for link in self.roots}
        return replace(
            self, links=tuple(replace(link, is_fixed=link.name in roots) for link in self.links)
        )

    def without_motion(self) -> Robot:
        """Return the links with their inertials alone: no joints, shapes or poses."""
        links = tuple(Link(link.name, link.inertial) for link in self.ordered())
        return Robot(self.name, links)

    def at_joints(self) -> Robot:
        """Return the robot with each link's origin at its joint, its axes unturned, for formats
        that demand it.
        """
        origins = {
            joint.child: joint.pose.position for joint in self.joints if joint.pose.position.any()
        }
        links = tuple(
            link.moved_to(origins[link.name]) if link.name in origins else link
            for link in self.links
        )
        joints = tuple(
            replace(joint, pose=Pose(rotation=joint.pose.rotation)) for joint in self.joints
        )
        return replace(self, links=links, joints=joints)

    def moves_freely(self, root: Link) -> bool:
        """Return whether a root can move in the world, and has a mass to move."""
        return not root.is_fixed and any(
            part.inertial is not None for part in self.rigid_parts(root)
        )

    def rigid_parts(self, link: Link) -> list[Link]:
        """Return a link and all links below it that are connected by fixed joints only, parents
        first.
        """
        parts = []
        waiting = [link]
        while waiting:
            part = waiting.pop()
            parts.append(part)
            below = reversed(self.children(part.name))
            waiting.extend(child for child in below if not self._joint_by_child[child.name].free)
        return parts

    def rigid_inertial(self, link: Link) -> Inertial | None:
        """Return the inertial of a link with all links fixed to it, in the link's frame; None if
        all lack mass.
        """
        to_link = link.pose.inverse()
        inertials = {
            part.name: part.inertial.place(to_link @ part.pose)
            for part in self.rigid_parts(link)
            if part.inertial is not None
        }
        if not inertials:
            return None
        if inertials.keys() == {link.name}:  # Its own numbers stay without rounding.
            return link.inertial
        return combine_inertials([*inertials.values()])


def right_handed(axes: NDArray) -> Array:
    """Return (3, 3) orthogonal axes, as columns, with the third one reversed if they mirror."""
    return axes * (1.0, 1.0, np.sign(np.linalg.det(axes)))


def second_moments(
    size: float, center: Array, second: Array, measure: Measure = Measure.VOLUME
) -> Moments:
    """Return the moments of a body from its volume or mass, (3,) center and (3, 3) second moments
    about it.
    """
    raw = np.zeros(monomial_count(KNOWN_ORDER))
    raw[0] = size
    raw[SECOND_MOMENT_INDEX] = second
    return Moments(raw, center, measure)


def combine_inertials(inertials: list[Inertial]) -> Inertial:
    """Return the total of several inertials that are given in the same frame."""
    moments = [
        second_moments(one.mass, one.center, second_of_inertia(one.inertia), Measure.MASS)
        for one in inertials
    ]
    total = combine([(body, 1.0) for body in moments])
    return Inertial.with_agreeing_axes(
        total.mass, total.center, total.inertia, total.principal.moments, total.principal.axes
    )
