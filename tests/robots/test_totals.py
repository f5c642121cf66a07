# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Totals of whole robots: the same in every format, and those of MuJoCo and Pinocchio."""

import numpy as np
import pytest
from body_moments.core.robots import FORMATS, Auditor, Roots, read_description
from body_moments.core.robots.model import combine_inertials

from tests.robots.links import bodies, near

mujoco = pytest.importorskip("mujoco")
pinocchio = pytest.importorskip("pinocchio")
MODEL = """<mujoco><default><joint axis="0 1 0"/><default class="s"><joint type="slide"
axis="1 0 0" ref="0.1"/></default></default><worldbody><body name="base" pos="0 0 1"
euler="10 20 30"><freejoint/><geom type="box" size=".1 .2 .3"/><frame pos="0.1 0 0" euler="0 0 40">
<body name="arm" pos="0.3 0 0" euler="0 30 0"><joint name="j1" pos="0.05 0 0.02" ref="15"/>
<joint name="j2" class="s"/><geom type="capsule" size=".05 .2" density="500"/><body name="hand"
pos="0 0 .4"><joint name="j3" axis="1 1 0"/><geom size=".07"/></body></body></frame></body>
<body name="other" pos="0 3 0"><geom size=".2"/></body></worldbody></mujoco>"""


def audit(path, **joints):
    return Auditor(Roots.for_file(path), joints).audit(read_description(path))


@pytest.mark.parametrize("away", [False, True])
@pytest.mark.parametrize("form", ["urdf", "sdf", "mjcf", "usd"])
def test_whole_and_subtrees_are_those_of_the_written_robot(form, away, tmp_path):
    robot = bodies(12, chain=True, away=away)
    path = tmp_path / ("robot" + FORMATS[form].suffix)
    path.write_text(FORMATS[form].writer_module.write(robot), encoding="utf-8")
    found = audit(path)
    root = robot.roots[0]
    start = robot.link(root.name).pose.inverse() if form == "urdf" else None
    placed = [link.inertial.place(link.pose) for link in robot.links]
    truth = combine_inertials(placed if start is None else [one.place(start) for one in placed])
    rel = {"usd": 1e-6, "sdf": 1e-5}.get(form, 1e-12)  # SDF has links between axes.
    whole = found.totals.whole
    assert abs(whole.mass / truth.mass - 1.0) < rel
    assert near(whole.center, truth.center, rel) and near(whole.inertia, truth.inertia, rel)
    below = combine_inertials([one for one in placed[6:]])
    (name,) = [link.name for link in found.description.links if link.name.endswith(("6", "body_6"))]
    assert abs(found.totals.subtrees[name].mass / below.mass - 1.0) < rel


@pytest.mark.parametrize("follower", ["", "j3"])
@pytest.mark.parametrize("values", [{}, {"j1": 0.7, "j2": 0.3, "j3": -0.4}, {"j1": 0.7}])
def test_subtrees_are_those_of_mujoco_in_any_position(values, follower, tmp_path):
    """The third joint follows the first by an equality, which MuJoCo's qpos0 does not obey."""
    path = tmp_path / "robot.xml"
    equality = '<equality><joint joint1="j3" joint2="j1" polycoef="0.1 0.5 0.2"/></equality>'
    text = MODEL.replace("</mujoco>", equality * bool(follower) + "</mujoco>")
    path.write_text(text, encoding="utf-8")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    moved = dict(values)
    if follower and values:
        distance = values["j1"] - np.radians(15.0)
        moved.setdefault(follower, 0.1 + 0.5 * distance + 0.2 * distance**2)
    for name, value in moved.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    totals = audit(path, **values).totals
    for name in ("base", "arm", "hand", "other"):
        index = model.body(name).id
        assert abs(totals.subtrees[name].mass / model.body_subtreemass[index] - 1.0) < 1e-12
        assert near(totals.subtrees[name].center, data.subtree_com[index], 1e-12)
    assert abs(totals.whole.mass / model.body_subtreemass[0] - 1.0) < 1e-12
    assert near(totals.whole.center, data.subtree_com[0], 1e-12)


ARM = """<body name="a"><joint name="j1"/><geom size=".1" pos="1 0 0"/><body name="b" pos="1 0 0">
<joint name="j2" axis="0 1 0"/><geom size=".2" pos="1 0 0"/></body></body>"""
EQUAL = '<equality><joint joint1="{}" joint2="{}" polycoef="0.1 2"{}/></equality>'
CLASS = '<default><default class="off"><equality active="false"/></default></default>'
TWO = '<attach model="m" prefix="l_"/><attach model="m" prefix="r_"/>'
# Elements of the attached model, of the world, and of the model.
EQUALITIES = (
    (EQUAL.format("j2", "j1", ""), TWO, EQUAL.format("r_j1", "l_j1", "")),
    ("", TWO, EQUAL.format("l_j2", "l_j1", "") + EQUAL.format("r_j2", "l_j2", "")),
    (EQUAL.format("j2", "j1", ""), '<attach model="m" body="b" prefix="l_"/>', ""),
    (EQUAL.format("j2", "j1", ""), ARM + '<body pos="0 0 1"><attach body="a" prefix="l_"/></body>',
     EQUAL.format("l_j1", "j2", "")),
    ("", '<replicate count="2" euler="0 90 0">{}</replicate>'.format(ARM),
     EQUAL.format("j2", "j1", "") + EQUAL.format("j11", "j20", "")),
    ("", ARM, CLASS + EQUAL.format("j2", "j1", ' class="off"')),
)  # fmt: skip


@pytest.mark.parametrize("inner, world, outer", EQUALITIES)
def test_followers_across_attached_models_are_those_of_mujoco(inner, world, outer, tmp_path):
    text = '<mujoco model="m">{}<worldbody>{}</worldbody>{}</mujoco>'
    (tmp_path / "m.xml").write_text(text.format("", ARM, inner), encoding="utf-8")
    asset = '<asset><model name="m" file="m.xml"/></asset>' * ("model=" in world)
    path = tmp_path / "robot.xml"
    path.write_text(text.format(asset, world, outer), encoding="utf-8")
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    ends = zip(model.eq_obj1id, model.eq_obj2id, model.eq_active0)
    leaders = {first: second for first, second, is_active in ends if is_active}
    (first, *_) = set(range(model.njnt)) - leaders.keys()
    data.qpos[first] = 0.7
    for _ in leaders:
        for follower, leader in leaders.items():
            if data.qpos[leader]:
                data.qpos[follower] = 0.1 + 2.0 * data.qpos[leader]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    found = audit(path, **{model.joint(first).name: 0.7})
    assert not found.entries and near(found.totals.whole.center, data.subtree_com[0], 1e-12)


def test_whole_robot_is_that_of_pinocchio_in_any_position(tmp_path):
    robot = bodies(12, chain=True)
    path = tmp_path / "robot.urdf"
    path.write_text(FORMATS["urdf"].writer_module.write(robot), encoding="utf-8")
    model = pinocchio.buildModelFromUrdf(str(path))
    data = model.createData()
    values = {
        name: 0.1 * index
        for index, name in enumerate(model.names)
        if index and model.joints[index].nq == 1
    }
    position = pinocchio.neutral(model)
    for name, value in values.items():
        position[model.joints[model.getJointId(name)].idx_q] = value
    pinocchio.ccrba(model, data, position, np.zeros(model.nv))
    whole = audit(path, **values).totals.whole
    # It starts from the parent of the first joint, the root link.
    center = pinocchio.centerOfMass(model, data, position)
    mass = sum(inertia.mass for inertia in model.inertias)
    assert abs(whole.mass / mass - 1.0) < 1e-12
    root = model.inertias[0]
    moving = whole.mass - root.mass
    truth = (center * moving + root.mass * root.lever) / whole.mass
    assert near(whole.center, truth, 1e-11)
