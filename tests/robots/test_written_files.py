# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files as they are written by default, with their meshes, opened by the programs that read
them.
"""

from pathlib import Path

import mujoco
import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.robots.model import FreeAxis, Joint, Link, Pose, Robot, Shape
from body_moments.core.robots.write.stl import MOST_TRIANGLES
from body_moments.core.robots.write.texts import robot_text, with_geometry

from tests.core.bodies import box
from tests.robots.links import inertial, rotation, shaped

SHEET = (
    np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float),
    np.array([[0, 1, 2], [0, 2, 3]]),
)


def arm():
    """A robot and its links' surfaces: two joined links, a sheet apart, a link without faces; names
    with accents.
    """
    rng = np.random.default_rng(11)
    bodies = {
        "Rümpf 1": shaped(rng, "sheared"),
        "hand": box((-0.1, -0.2, 0.0), (0.3, 0.1, 0.5)),
        "sheet": SHEET,
    }
    bodies["wire"] = box((0, 0, 0), (1, 2, 3))
    links = [
        Link(
            name,
            inertial(*(bodies["hand"] if name == "sheet" else body)),
            Pose(rng.normal(size=3), rotation(rng)),
            (Shape("mesh", sheet=name == "sheet"),),
        )
        for name, body in bodies.items()
    ]
    joint = Joint(
        "wrist", "Rümpf 1", "hand", (FreeAxis("rotate", np.array([0.0, 0.0, 1.0]), -1.0, 1.0),)
    )
    surfaces = {
        name: Surface.from_triangles(*body) for name, body in bodies.items() if name != "wire"
    }
    return Robot("arm", tuple(links), (joint,)), surfaces


def written(folder, name, suffix):
    """The robot of a file, and the file."""
    robot, surfaces = arm()
    path = folder / ("my arm" + suffix)
    robot, findings = with_geometry(robot, name, surfaces.get, path)
    path.write_text(robot_text(robot, name, findings)[0], encoding="utf-8")
    return robot, path


@pytest.mark.parametrize(("name", "suffix"), [("mjcf", ".xml"), ("urdf", ".urdf")])
def test_mujoco_opens_files_with_their_meshes(tmp_path, name, suffix):
    """A flat mesh is only seen."""
    robot, path = written(tmp_path, name, suffix)
    model = mujoco.MjModel.from_xml_path(str(path))
    # MuJoCo skips what is only seen there.
    assert model.nmesh == sum(bool(link.shapes) for link in robot.links) - (name == "urdf")
    for link in robot.links:
        assert abs(model.body(link.name).mass[0] / link.inertial.mass - 1.0) < 1e-12
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.isfinite(data.qacc).all()


def test_mujoco_takes_thin_plates_from_urdf():
    """Their largest moment is the sum of the others, to rounding."""
    for seed in range(60):
        points, triangles = shaped(np.random.default_rng(seed), "square" if seed % 2 else "plate")
        link = Link("plate", inertial(points, triangles, 1e9))
        model = mujoco.MjModel.from_xml_string(robot_text(Robot("flat", (link,)), "urdf")[0])
        assert (
            np.abs(np.sort(model.body("plate").inertia) - link.inertial.moments).max()
            < 1e-13 * link.inertial.moments[2]
        )


@pytest.mark.parametrize(
    ("count", "suffix"), [(MOST_TRIANGLES, ".stl"), (MOST_TRIANGLES + 2, ".obj")]
)
def test_mujoco_loads_meshes_of_any_size(tmp_path, count, suffix):
    points, triangles = box((0, 0, 0), (1, 2, 3))
    surface = Surface.from_triangles(points, np.resize(triangles, (count, 3)))
    link = Link("large", inertial(points, triangles), shapes=(Shape("mesh"),))
    for _ in range(2):  # The second replaces the files of the first.
        robot, _ = with_geometry(
            Robot("large", (link,)), "mjcf", lambda _: surface, tmp_path / "large.xml"
        )
    assert Path(robot.links[0].shapes[0].file).suffix == suffix
    text, findings = robot_text(robot, "mjcf")
    (tmp_path / "large.xml").write_text(text, encoding="utf-8")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "large.xml"))
    assert not findings and model.nmesh == 1 and model.nmeshface == count
