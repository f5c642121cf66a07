# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames in frames, inertials that are moved and put together, and the trees that links make."""

import numpy as np
import pytest
from body_moments.core.robots.model import (
    FreeAxis,
    Inertial,
    Joint,
    Link,
    Pose,
    Robot,
    combine_inertials,
)
from body_moments.core.robots.stated import rotation_of_angles

from tests.close import close
from tests.core import bodies

RNG = np.random.default_rng(3)
Z = np.array([0.0, 0.0, 1.0])


def inertial(seed, mass=1.7):
    axes, moments = bodies.rotation(seed), mass * np.array([0.2, 0.3, 0.4])
    return Inertial(
        mass,
        np.random.default_rng(seed).normal(size=3),
        axes @ np.diag(moments) @ axes.T,
        moments,
        axes,
    )


def pose(seed):
    return Pose(np.random.default_rng(seed).normal(size=3), bodies.rotation(seed))


def test_angles_turn_about_the_fixed_axes_x_then_y_then_z():
    roll, pitch, yaw = 0.3, -1.2, 2.2
    turns = [rotation_of_angles(*angles) for angles in ((roll, 0, 0), (0, pitch, 0), (0, 0, yaw))]
    assert (
        np.abs(rotation_of_angles(roll, pitch, yaw) - turns[2] @ turns[1] @ turns[0]).max() <= 1e-14
    )
    for axis, (turn, angle) in enumerate(zip(turns, (roll, pitch, yaw))):
        following = np.roll(np.eye(3), axis + 1, axis=1)[0]
        across = np.roll(np.eye(3), axis + 2, axis=1)[0]
        assert close(turn @ following, np.cos(angle) * following + np.sin(angle) * across, 1e-14)


def test_an_inertial_is_moved_with_its_axes():
    one, place = inertial(1), pose(2)
    moved = one.place(place)
    assert moved.mass == one.mass and (moved.moments == one.moments).all()
    assert close(moved.center, place.rotation @ one.center + place.position, 1e-13)
    assert np.abs(moved.inertia - place.rotation @ one.inertia @ place.rotation.T).max() <= 1e-14
    assert np.abs(moved.axes @ np.diag(moved.moments) @ moved.axes.T - moved.inertia).max() <= 1e-14
    assert np.abs(moved.inertia - moved.inertia.T).max() <= 1e-14


def test_inertials_add_by_the_theorem_of_parallel_axes():
    parts = [inertial(1, 1.0), inertial(2, 3.0), inertial(5, 0.25)]
    total = combine_inertials(parts)
    mass = sum(part.mass for part in parts)
    center = sum(part.mass * part.center for part in parts) / mass
    arms = [part.center - center for part in parts]
    tensor = sum(
        p.inertia + p.mass * (d @ d * np.eye(3) - np.outer(d, d)) for p, d in zip(parts, arms)
    )
    assert close(total.mass, mass, 1e-14) and close(total.center, center, 1e-13)
    assert np.abs(total.inertia - tensor).max() <= 1e-13
    assert np.abs(total.axes @ np.diag(total.moments) @ total.axes.T - tensor).max() <= 1e-13


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_principal_axes_reproduce_the_tensor(scale):
    """Moments that differ by less stay as given.

    Axes along the link's own make every product exact.
    """
    axes, true = np.roll(np.eye(3), 1, axis=1), scale * np.array([0.2, 0.3, 0.4])
    for units, stays in ((6.0, True), (12.0, False)):
        moments = true + [0.0, 0.0, units * np.finfo(float).eps * true[2]]
        found = Inertial.with_agreeing_axes(scale, Z, axes @ np.diag(true) @ axes.T, moments, axes)
        assert (found.moments == moments).all() == stays


def test_principal_axes_not_matching_the_tensor_are_recomputed():
    true, off = inertial(3), bodies.rotation(1)
    exact = Inertial.with_agreeing_axes(1.7, true.center, true.inertia, true.moments, true.axes)
    assert (exact.axes == true.axes).all() and (exact.moments == true.moments).all()
    agreeing = Inertial.with_agreeing_axes(
        1.7, true.center, true.inertia, np.array([1.0, 2.0, 3.0]), off
    )
    assert (
        np.abs(agreeing.axes @ np.diag(agreeing.moments) @ agreeing.axes.T - true.inertia).max()
        <= 1e-14
    )
    assert np.linalg.det(agreeing.axes) > 0.0 and close(agreeing.moments, true.moments, 1e-14)
    tilt, rod_moments = rotation_of_angles(0.0, 0.0, 1e-9), np.array([3e-20, 1.0, 1.0 + 2.0**-51])
    rod = Inertial.with_agreeing_axes(1.0, Z, np.diag([1e-20, 1.0, 1.0]), rod_moments, tilt)
    assert rod.moments[0] == 3e-20 and rod.moments[2] <= rod.moments[0] + rod.moments[1]
    other = Inertial.with_agreeing_axes(
        1.0, Z, np.diag([1e-20, 1.0, 1.0]), rod_moments[[0, 2, 2]], tilt
    )
    assert (other.moments == rod_moments[[0, 2, 2]]).all()  # agreeing moments stay as given
    for scale in (2.0**-40, 2.0**40):
        tensor, moments = agreeing.inertia * scale, np.array([1.0, 2.0, 3.0]) * scale
        scaled = Inertial.with_agreeing_axes(1.7, true.center, tensor, moments, off)
        assert close(scaled.moments, agreeing.moments * scale, 1e-14)
        tensor = np.diag([1e-20, 1.0, 1.0]) * scale
        scaled = Inertial.with_agreeing_axes(1.0, Z, tensor, rod_moments * scale, tilt)
        assert close(scaled.moments, rod.moments * scale, 1e-14)


def free(kind="rotate", **limits):
    return FreeAxis(kind, Z, **limits)


def tree():
    links = [Link(name, inertial(k + 1), pose(k)) for k, name in enumerate("edcba")]
    links[1] = Link("d", None, pose(9))
    joints = [
        Joint("1", "a", "b"),
        Joint("2", "a", "c", (free(),)),
        Joint("3", "b", "d"),
        Joint("4", "b", "e"),
    ]
    return Robot("r", tuple(links), tuple(joints))


def test_links_are_walked_from_parents_to_children():
    robot = tree()
    assert [link.name for link in robot.roots] == ["a"]
    assert [link.name for link in robot.ordered()] == ["a", "c", "b", "e", "d"]
    assert [link.name for link in robot.children("b")] == ["e", "d"] and robot.children("e") == []
    assert (
        robot.joint_of("a") is None
        and robot.joint_of("c").name == "2"
        and robot.link("d").inertial is None
    )
    root, below = robot.link("a"), robot.link("b")
    assert robot.pose_in_parent(root) is root.pose
    back = root.pose @ robot.pose_in_parent(below)
    assert (
        close(back.position, below.pose.position, 1e-12)
        and np.abs(back.rotation - below.pose.rotation).max() < 1e-14
    )


def test_links_on_fixed_joints_are_one_body():
    robot = tree()
    root, parts = robot.link("a"), ["a", "b", "e", "d"]
    assert [link.name for link in robot.rigid_parts(root)] == parts
    whole, to_link = robot.rigid_inertial(root), root.pose.inverse()
    heavy = [robot.link(name) for name in parts if name != "d"]
    truth = combine_inertials([link.inertial.place(to_link @ link.pose) for link in heavy])
    assert close(whole.mass, sum(link.inertial.mass for link in heavy), 1e-14)
    assert np.abs(whole.inertia - truth.inertia).max() <= 1e-13 and close(
        whole.center, truth.center, 1e-13
    )
    assert robot.rigid_inertial(robot.link("c")) is robot.link("c").inertial
    assert robot.rigid_inertial(robot.link("d")) is None


def test_massless_link_belongs_to_the_body_of_its_fixed_joint():
    base, hand = Link("base", None, pose(1)), Link("hand", inertial(2), pose(3))
    robot = Robot("r", (base, hand), (Joint("1", "base", "hand"),))
    held, truth = robot.rigid_inertial(base), hand.inertial.place(base.pose.inverse() @ hand.pose)
    assert close(held.mass, truth.mass, 1e-14) and close(held.center, truth.center, 1e-13)
    assert np.abs(held.inertia - truth.inertia).max() <= 1e-14


@pytest.mark.parametrize(
    "joints, text",
    [
        ([("a", "b"), ("c", "b")], "twice"),
        ([("a", "x")], "without link"),
        ([("x", "a")], "without link"),
        ([("a", "b"), ("b", "a")], "loop"),
        ([("a", "a")], "loop"),
    ],
)
def test_cyclic_or_split_links_are_refused(joints, text):
    links = tuple(Link(name) for name in "abc")
    with pytest.raises(ValueError, match=text):
        Robot("r", links, tuple(Joint(str(k), *pair) for k, pair in enumerate(joints)))
    with pytest.raises(ValueError, match="twice"):
        Robot("r", (*links, Link("a")))
