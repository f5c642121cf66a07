# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions beside the numbers that they were written from."""

from dataclasses import replace

import numpy as np
from body_moments.core.robots import read_description, repaired_copy


def near(found, truth, rel):
    """Relative to the largest number."""
    return (
        np.shape(found) == np.shape(truth)
        and np.abs(np.subtract(found, truth)).max() <= rel * np.abs(truth).max()
    )


def about(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def fixed_angles(roll, pitch, yaw):
    return about((0, 0, 1), yaw) @ about((0, 1, 0), pitch) @ about((1, 0, 0), roll)


def quaternion(axis, angle):
    return [np.cos(angle / 2), *(np.sin(angle / 2) * np.asarray(axis) / np.linalg.norm(axis))]


def text(values):
    return " ".join(map(repr, np.ravel(values).tolist()))


def read(folder, content, name="robot.xml"):
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return read_description(path)


def check(link, truth):
    """truth: mass, center, tensor along the link's axes, or None; and shapes as (kind, size,
    position, rotation, role, file).
    """
    assert not link.findings
    inertial, shapes = truth
    if inertial is None:
        assert link.inertial is None
    else:
        mass, center, tensor = inertial
        assert near(link.inertial.mass, mass, 1e-14) and near(
            link.inertial.center, np.array(center), 1e-12
        )
        assert near(link.inertial.inertia, np.array(tensor), 1e-12)
    for stated, (kind, size, position, rotation, role, file) in zip(
        link.shapes, shapes, strict=True
    ):
        shape = stated.shape
        assert (shape.kind, stated.role, shape.file) == (kind, role, file)
        assert near(np.array(shape.size), np.array(size, float), 1e-12)
        assert near(shape.pose.position, np.array(position, float), 1e-12)
        assert near(shape.pose.rotation, np.array(rotation), 1e-12)


def check_repair(folder, description):
    """Other inertials are written where they stand, and all else stays."""
    repairs = [
        (link, link.inertial)
        for link in description.links
        if link.span is not None and link.inertial
    ]
    repairs = [(link, replace(own, mass=2 * own.mass, center=own.center + 1, tensor=3 * own.tensor))
               for link, own in repairs]  # fmt: skip
    path = folder / "repaired"
    path.write_bytes(repaired_copy(description, repairs))
    expected = {link.name: inertial for link, inertial in repairs}
    for before, after in zip(description.links, read_description(path).links, strict=True):
        assert (before.name, len(before.shapes)) == (after.name, len(after.shapes))
        assert (before.inertial is None) == (after.inertial is None)
        if before.name in expected:
            for name in ("mass", "center", "inertia"):
                assert near(
                    getattr(after.inertial, name), getattr(expected[before.name], name), 1e-6
                )


def random_inertial(rng, rotation):
    mass, center, moments = float(rng.uniform(1, 9)), rng.normal(size=3), rng.uniform(2, 3, 3)
    return mass, center, moments, rotation @ np.diag(moments) @ rotation.T
