# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots with their fixed links merged: the same totals, and only frames that a joint needs."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pinocchio
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.robots import (
    FORMATS,
    Auditor,
    Roots,
    merge_fixed,
    read_description,
    with_primitives,
)
from body_moments.core.robots.model import (
    FreeAxis,
    Joint,
    Link,
    Pose,
    Robot,
    Shape,
    combine_inertials,
)
from body_moments.core.robots.write.stl import write_meshes

from tests.core.bodies import box
from tests.robots import consumers, links
from tests.robots.links import inertial, near

COUNT = 12


def audit(robot, form, folder):
    path = folder / ("robot" + FORMATS[form].suffix)
    path.write_text(FORMATS[form].writer_module.write(robot), encoding="utf-8")
    return path, Auditor(Roots.for_file(path)).audit(read_description(path))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("form", ["urdf", "mjcf", "sdf", "usd"])
def test_merged_robot_has_the_same_totals(form, seed, tmp_path):
    robot = with_primitives(links.assembly(seed, COUNT).with_fixed_roots(), "box")
    merged = merge_fixed(robot)
    _, before = audit(robot, form, tmp_path)
    path, after = audit(merged, form, tmp_path)
    truth = combine_inertials([one.inertial.place(one.pose) for one in robot.links])
    old, new = before.totals.whole, after.totals.whole
    for found in (old, new):
        rel = 1e-6 if form == "usd" else 1e-12  # single precision
        assert abs(found.mass / truth.mass - 1.0) < rel
        assert near(found.center, truth.center, rel) and near(found.inertia, truth.inertia, rel)
    heavy = [one for one in merged.links if one.inertial is not None]
    assert len(heavy) == COUNT - sum(not joint.free for joint in robot.joints)
    needed = {joint.parent for joint in robot.joints if joint.free}
    assert needed <= {one.name for one in merged.links}
    assert sum(len(one.shapes) for one in merged.links) == COUNT
    if form == "mjcf":
        model = mujoco.MjModel.from_xml_path(str(path))
        assert {model.body(index).name for index in range(1, model.nbody)} >= needed
    elif form == "urdf":
        model = pinocchio.buildModelFromUrdf(str(path))
        assert all(model.existFrame(name) for name in needed)


@pytest.mark.parametrize("is_merged", [False, True])
@pytest.mark.parametrize(
    "program, form",
    [("mujoco", "urdf"), ("mujoco", "mjcf"), ("pinocchio", "urdf"), ("opensim", "osim")],
)
def test_total_is_that_of_another_program(program, form, is_merged, tmp_path):
    """tools/robot_consumers.py has more robots and programs."""
    for seed in range(2):
        robot = links.assembly(seed)
        path = tmp_path / (str(seed) + FORMATS[form].suffix)
        named = write_meshes(robot, path)
        named = merge_fixed(named) if is_merged else named
        path.write_text(FORMATS[form].writer_module.write(named), encoding="utf-8")
        mass, center, inertia = consumers.summed(getattr(consumers, program)(path))
        truth = links.total(robot, form == "urdf" and not robot.roots[0].is_fixed)
        assert abs(mass / truth.mass - 1.0) < 1e-12
        assert near(center, truth.center, 1e-12) and near(inertia, truth.inertia, 1e-12)


@pytest.mark.parametrize("is_merged", [False, True])
@pytest.mark.parametrize("mesh_format", ["stl", "obj"])
def test_masses_of_geoms_are_the_inertials(mesh_format, is_merged, tmp_path):
    rng = np.random.default_rng(3)
    links = []
    for index in range(3):
        points, triangles = box(rng.normal(size=3), rng.uniform(3.0, 4.0, 3))
        seen = Shape("mesh", surface=Surface.from_triangles(points, triangles))
        body = inertial(points, triangles, 700.0 + index)
        links.append(Link("l{}".format(index), body, Pose(rng.normal(size=3)), (seen,)))
    piece = Shape("sphere", (0.1,), seen=False, mass=1.0)
    drawn = replace(links[2].shapes[0], collides=False)
    links[2] = replace(links[2], shapes=(drawn, piece, replace(piece, mass=3.0)))
    joints = (Joint("a", "l0", "l1"), Joint("b", "l1", "l2", (FreeAxis("rotate", np.eye(3)[0]),)))
    robot = write_meshes(
        Robot("r", tuple(links), joints), tmp_path / "r.xml", None, False, mesh_format
    )
    robot = merge_fixed(robot) if is_merged else robot
    text = FORMATS["mjcf"].writer_module.write(robot)
    assert "." + mesh_format in text
    (tmp_path / "r.xml").write_text(text, encoding="utf-8")
    (tmp_path / "bare.xml").write_text(re.sub("<inertial [^>]*>", "", text), encoding="utf-8")
    stated, computed = (
        mujoco.MjModel.from_xml_path(str(tmp_path / name)) for name in ("r.xml", "bare.xml")
    )
    assert near(computed.body_mass, stated.body_mass, 1e-7)
    first = stated.body("l0").id
    assert near(computed.body_ipos[first], stated.body_ipos[first], 1e-6)
    moments = [np.sort(model.body_inertia[first]) for model in (computed, stated)]
    assert near(*moments, 1e-5)
