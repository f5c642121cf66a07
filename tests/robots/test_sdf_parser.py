# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""SDF read back by the parser of Gazebo itself, libsdformat, where a machine has it with its
headers and a compiler.
"""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.numerics.rotations import rotation_matrix
from body_moments.core.robots import Inertial, Link, Pose, Robot, read_description
from body_moments.core.robots.write import sdf

from tests.robots.links import bodies, shapes

SOURCE = Path(__file__).with_name("read_sdf.cc")
LIBRARY = "sdformat12"  # The parser of SDF 1.9, in Debian 12.


@pytest.fixture(scope="module")
def parse(tmp_path_factory):
    """A function from a text to what the parser says of it, a list of words each."""
    compiler, config = shutil.which("g++"), shutil.which("pkg-config")
    flags = config and subprocess.run(
        [config, "--cflags", "--libs", LIBRARY], capture_output=True, text=True
    )
    if not compiler or not flags or flags.returncode:
        pytest.skip("needs libsdformat")
    folder = tmp_path_factory.mktemp("sdf")
    program = str(folder / "read_sdf")
    subprocess.run(
        [compiler, "-std=c++17", str(SOURCE), "-o", program, *flags.stdout.split()], check=True
    )

    def run(text, *options):
        path = folder / "model.sdf"
        path.write_text(text, encoding="utf-8")
        done = subprocess.run(
            [program, *options, str(path)], capture_output=True, text=True, check=True
        )
        messages = [["message", line] for line in done.stderr.splitlines()]
        return [*messages, *(line.split("\t") for line in done.stdout.splitlines())]

    return run


def test_gazebo_takes_each_link_and_has_its_numbers(parse):
    many = bodies(500)
    said = parse(sdf.write(many))
    assert {words[0] for words in said} == {"link"}, [
        words for words in said if words[0] != "link"
    ][:3]
    for link, words in zip(many.links, said, strict=True):
        true, values = link.inertial, np.array(words[2:], np.float64)
        assert (
            words[1] == link.name and values[0] == true.mass and (values[1:4] == true.center).all()
        )
        assert (
            np.abs(values[4:13].reshape(3, 3) - true.inertia).max()
            <= 1e-14 * np.abs(true.inertia).max()
        )


def test_gazebo_takes_joints_and_shapes(parse):
    chain = bodies(24, chain=True, away=True).with_fixed_roots()
    dressed = Link("dressed", chain.links[0].inertial, Pose(), shapes(chain.links[1].pose))
    said = parse(sdf.write(Robot("world", (*chain.links, dressed), chain.joints)))
    assert {words[0] for words in said} == {"link", "joint"}, [
        words for words in said if words[0] == "error"
    ]
    joints = {words[1]: words[3:5] for words in said if words[0] == "joint"}
    assert joints.pop("body 0_joint") == ["world", "body 0"]
    assert joints == {joint.name: [joint.parent, joint.child] for joint in chain.joints}
    places = {words[1]: np.array(words[5:], np.float64) for words in said if words[0] == "joint"}
    for joint in chain.joints:
        true = (chain.link(joint.child).pose @ joint.pose).position
        assert np.abs(places[joint.name] - true).max() <= 1e-12
    for link, words in zip(chain.links, said):
        assert np.abs(np.array(words[15:18], np.float64) - link.pose.position).max() <= 1e-13


def test_gazebo_refuses_impossible_inertia(parse):
    """So that the tests above could fail."""
    true = bodies(1).links[0].inertial
    wrong = Inertial(true.mass, true.center, true.inertia, np.array([1.0, 1.0, 3.0]), true.axes)
    said = parse(sdf.write(Robot("r", (Link("a", wrong),))))
    (reason,) = [words[2] for words in said if words[0] == "error"]
    assert "inertia" in reason


def framed_model(rng, name, depth=0):
    """A model whose links, joints, frames, inner models and shapes stand in random ones of its
    earlier frames.
    """
    known, parts, links = ["__model__"], [], []

    def pose():
        numbers = " ".join(map(repr, rng.normal(size=6).tolist()))
        return '<pose relative_to="{}">{}</pose>'.format(
            rng.choice(known) if rng.random() < 0.8 else "", numbers
        )

    for index in range(8):
        kind, own = (
            rng.choice(["link", "joint", "frame", "model"]) if index else "link",
            "{}{}".format(name, index),
        )
        if kind == "link":
            forms = "".join(
                '<{0} name="{0}">{{}}<geometry><sphere/></geometry></{0}>'.format(role)
                for role in ROLES
            )
            parts.append('<link name="{}">{}{}</link>'.format(own, pose(), forms))
            links.append(own)
        elif kind == "frame":
            attached = rng.choice(["", *links])
            parts.append(
                '<frame name="{}" attached_to="{}">{}</frame>'.format(own, attached, pose())
            )
        elif kind == "joint" and len(links) > 1:
            ends = "<parent>{}</parent><child>{}</child>".format(
                *rng.choice(links, 2, replace=False)
            )
            parts.append('<joint name="{}" type="fixed">{}{}</joint>'.format(own, pose(), ends))
        elif kind == "model" and depth < 2:
            inner = framed_model(rng, own, depth + 1)
            placement = (
                'placement_frame="{}0">{}'.format(own, pose())
                if rng.random() < 0.5
                else ">" + pose()
            )
            parts.append(inner.replace(">", " " + placement, 1))
            known += [own + "::" + own + "0", own + "::__model__"]
        else:
            continue
        known.append(own)
    shown = "".join(parts)
    while "{}" in shown:
        shown = shown.replace("{}", pose(), 1)
    return '<model name="{}">{}</model>'.format(name, shown)


ROLES = ("visual", "collision")


@pytest.mark.parametrize("seed", range(12))
def test_poses_in_frames_are_those_of_gazebo(parse, tmp_path, seed):
    """In frames of the model, of joints, links and models within it, and after its joints'
    children.
    """
    path = tmp_path / "m.sdf"
    text = '<sdf version="1.9">{}</sdf>'.format(framed_model(np.random.default_rng(seed), "m"))
    path.write_text(text, encoding="utf-8")
    said = iter(parse(text, "--shapes"))
    for link in read_description(path).links:
        assert not link.findings
        for stated, words in zip(link.shapes, said):
            assert words[0] == "shape" and words[1].endswith(link.name)
            values, pose = np.array(words[3:], np.float64), stated.shape.pose
            assert np.abs(values[:3] - pose.position).max() < 1e-12
            assert np.abs(rotation_matrix(values[3:]) - pose.rotation).max() < 1e-12
    assert next(said, None) is None


@pytest.mark.parametrize("frame", ["none", "b", "world", "a::x", "m", "around"])
def test_unknown_frame_of_sdf_is_a_finding_at_its_pose(parse, tmp_path, frame):
    """Gazebo knows none of them either: frames outside of the model, and frames in each other."""
    around = (
        '<frame name="around"><pose relative_to="more"/></frame><frame name="more"><pose '
        'relative_to="around"/></frame>'
    )
    shape = (
        '\n<visual name="v"><pose relative_to="{}">0 0 0 0 0 '
        "0</pose><geometry><sphere/></geometry></visual>"
    )
    inner = '<model name="n">{}<link name="a">{}</link></model>'.format(around, shape.format(frame))
    text = '<sdf version="1.9"><model name="m">{}<link name="b"/></model></sdf>'.format(inner)
    path = tmp_path / "m.sdf"
    path.write_text(text, encoding="utf-8")
    assert any(words[0] == "error" for words in parse(text, "--shapes"))
    inner, _ = sorted(read_description(path).links, key=lambda link: link.name != "n::a")
    assert [(one.code, one.values["text"], one.values["line"]) for one in inner.findings] == [
        ("description_number", frame, 2)
    ]


def test_included_model_has_the_name_and_place_of_its_include(tmp_path):
    (tmp_path / "arm.sdf").write_text(
        '<sdf version="1.9"><model name="arm"><pose>9 9 9 0 0 0</pose><frame name="f"><pose>0 2 0 '
        "0 0 0</pose></frame>"
        '<link name="a"><pose>1 0 0 0 0 0</pose></link></model></sdf>'
    )
    include = "<include><uri>arm.sdf</uri><name>left</name><pose>0 0 5 0 0 0</pose>{}</include>"
    shape = '<visual name="v"><pose relative_to="left::a"/><geometry><sphere/></geometry></visual>'
    for more, place in (("", [1, 0, 5]), ("<placement_frame>f</placement_frame>", [1, -2, 5])):
        text = '<sdf version="1.9"><model name="m">{}<link name="b">{}</link></model></sdf>'
        (tmp_path / "m.sdf").write_text(text.format(include.format(more), shape))
        outer, inner = read_description(tmp_path / "m.sdf").links
        assert inner.name == "left::a" and outer.shapes[0].shape.pose.position.tolist() == place
