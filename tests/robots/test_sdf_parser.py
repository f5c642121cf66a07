# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SDF read back by the parser of Gazebo itself, libsdformat, where a machine has it with its headers and a compiler."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.robots.model import Inertial, Link, Pose, Robot
from body_moments.core.robots.write import sdf

from tests.robots.links import bodies, shapes

SOURCE = Path(__file__).with_name("read_sdf.cc")
LIBRARY = "sdformat12"  # The parser of SDF 1.9, in Debian 12.


@pytest.fixture(scope="module")
def parse(tmp_path_factory):
    """A function from a text to what the parser says of it, a list of words each."""
    compiler, config = shutil.which("g++"), shutil.which("pkg-config")
    flags = config and subprocess.run([config, "--cflags", "--libs", LIBRARY], capture_output=True, text=True)
    if not compiler or not flags or flags.returncode:
        pytest.skip("needs libsdformat")
    folder = tmp_path_factory.mktemp("sdf")
    program = str(folder / "read_sdf")
    subprocess.run([compiler, "-std=c++17", str(SOURCE), "-o", program, *flags.stdout.split()], check=True)

    def run(text):
        path = folder / "model.sdf"
        path.write_text(text, encoding="utf-8")
        done = subprocess.run([program, str(path)], capture_output=True, text=True, check=True)
        messages = [["message", line] for line in done.stderr.splitlines()]
        return [*messages, *(line.split("\t") for line in done.stdout.splitlines())]

    return run


def test_gazebo_takes_each_link_and_has_its_numbers(parse):
    many = bodies(500)
    said = parse(sdf.write(many))
    assert {words[0] for words in said} == {"link"}, [words for words in said if words[0] != "link"][:3]
    for link, words in zip(many.links, said, strict=True):
        true, values = link.inertial, np.array(words[2:], np.float64)
        assert words[1] == link.name and values[0] == true.mass and (values[1:4] == true.center).all()
        assert np.abs(values[4:13].reshape(3, 3) - true.inertia).max() <= 1e-14 * np.abs(true.inertia).max()


def test_gazebo_takes_joints_and_shapes(parse):
    chain = bodies(24, chain=True, away=True).with_fixed_roots()
    dressed = Link("dressed", chain.links[0].inertial, Pose(), shapes(chain.links[1].pose))
    said = parse(sdf.write(Robot("world", (*chain.links, dressed), chain.joints)))
    assert {words[0] for words in said} == {"link", "joint"}, [words for words in said if words[0] == "error"]
    joints = {words[1]: words[3:5] for words in said if words[0] == "joint"}
    assert joints.pop("body 0_joint") == ["world", "body 0"]
    assert joints == {joint.name: [joint.parent, joint.child] for joint in chain.joints}
    places = {words[1]: np.array(words[5:], np.float64) for words in said if words[0] == "joint"}
    for joint in chain.joints:
        true = (chain.link(joint.child).pose @ joint.pose).position
        assert np.abs(places[joint.name] - true).max() <= 1e-12
    for link, words in zip(chain.links, said):
        assert np.abs(np.array(words[-3:], np.float64) - link.pose.position).max() <= 1e-13


def test_gazebo_refuses_impossible_inertia(parse):
    """So that the tests above could fail."""
    true = bodies(1).links[0].inertial
    wrong = Inertial(true.mass, true.center, true.inertia, np.array([1.0, 1.0, 3.0]), true.axes)
    said = parse(sdf.write(Robot("r", (Link("a", wrong),))))
    (reason,) = [words[2] for words in said if words[0] == "error"]
    assert "inertia" in reason
