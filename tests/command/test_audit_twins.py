# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Twins of a robot: pairs that disagree, repairs from the valid twin, and copied inertials."""

import json

import numpy as np
import pytest
from body_moments.command import audit

LINK = (
    '<link name="{}"><inertial><origin xyz="{}"/><mass value="{}"/><inertia ixx="{}" iyy="{}" '
    'izz="{}" ixy="{}" ixz="{}" iyz="{}"/></inertial>{}</link>'
)
JOINT = (
    '<joint name="{0}_joint" type="revolute"><origin xyz="{1}"/><parent link="base"/>'
    '<child link="{0}"/><axis xyz="0 1 0"/></joint>'
)
BASE = LINK.format("base", "0 0 0", 9, 1, 1, 1, 0, 0, 0, "")
TENSOR = (0.005, 0.007, 0.009, 0.0004, 0.0006, 0.0005)
PAIRS = [
    ("left_arm", "right_arm"),
    ("arm_l", "arm_r"),
    ("FL_hip", "FR_hip"),
    ("rl_calf", "rr_calf"),
    ("LeftHand", "RightHand"),
    ("LH_SHANK", "RH_SHANK"),
]


def box(y, sides="0.3 0.2 0.1"):
    return (
        '<visual><origin xyz="0.1 {} 0.05"/><geometry><box size="{}"/></geometry></visual>'.format(
            y, sides
        )
    )


def record(folder, *links):
    names = [(link.split('"')[1], "0 {} 0".format(1 - 2 * i)) for i, link in enumerate(links)]
    path = folder / "r.urdf"
    joints = [JOINT.format(*one) for one in names]
    path.write_text('<robot name="r">{}</robot>'.format("".join([BASE, *links, *joints])))
    (text,), _ = audit.answer(audit.parse(["audit", str(path)]))
    return json.loads(text)


def codes(found):
    return [one["code"] for link in found["links"] for one in link["findings"]]


@pytest.mark.parametrize("names", PAIRS)
@pytest.mark.parametrize(
    "mass, factors, is_wrong",
    [(2, (1, 1, 1), False), (2.08, (1.04,) * 3, False), (2.2, (1, 1, 1), True)],
)
def test_pair_beyond_the_tolerance_is_named(names, mass, factors, is_wrong, tmp_path):
    a, b, c, xy, xz, yz = TENSOR
    left = LINK.format(names[0], "0.1 0.02 0.05", 2, *TENSOR, "")
    moments = np.array(factors) * (a, b, c)
    right = LINK.format(names[1], "0.1 -0.02 0.05", mass, *moments, -xy, xz, -yz, "")
    found = record(tmp_path, left, right)
    assert codes(found) == ["audit_twins"] * is_wrong
    if is_wrong:
        (one,) = found["links"][1]["findings"]
        assert all(name in one["message"] for name in names) and one["severity"] == "warning"


def test_wrong_product_beside_mirrored_geometry_is_found(tmp_path):
    a, b, c, xy, xz, yz = TENSOR
    left = LINK.format("l_arm", "0.1 0.02 0.05", 2, *TENSOR, box(0.02))
    right = LINK.format("r_arm", "0.1 -0.02 0.05", 2, a, b, c, -xy, xz, -yz, box(-0.02))
    copied = LINK.format("r_arm", "0.1 -0.02 0.05", 2, a, b, c, xy, xz, yz, box(-0.02))
    assert "audit_twins" not in codes(record(tmp_path, left, right))
    assert "audit_twins" in codes(record(tmp_path, left, copied))
    other = LINK.format("r_arm", "0.1 -0.02 0.05", 4, *TENSOR, box(-0.02, "0.6 0.2 0.1"))
    assert "audit_twins" not in codes(record(tmp_path, left, other))


@pytest.mark.parametrize("moments", [(0.005, 0.007, 0.09), (-1, 1, 1)])
def test_impossible_inertial_gets_that_of_its_twin(moments, tmp_path):
    left = LINK.format("l_arm", "0.1 0.02 0.05", 2, *TENSOR, box(0.02))
    right = LINK.format("r_arm", "0.1 -0.02 0.05", 2, *moments, 0, 0, 0, box(-0.02))
    link = record(tmp_path, left, right)["links"][2]
    assert "l_arm" in link["findings"][0]["change"] and link["findings"][0]["severity"] == "error"
    a, b, c, xy, xz, yz = TENSOR
    truth = [[a, -xy, xz], [-xy, b, -yz], [xz, -yz, c]]
    assert np.abs(np.array(link["repaired"]["inertia"]) - truth).max() < 1e-15
    assert np.abs(np.array(link["repaired"]["center_of_mass"]) - (0.1, -0.02, 0.05)).max() < 1e-15


def test_almost_symmetric_copies_may_have_mirrored_inertials(tmp_path):
    a, b, c, xy, xz, yz = TENSOR
    left = LINK.format("l_arm", "0.1 0 0.05", 2, a, b, c, xy, xz, yz, box(0.0002))
    right = LINK.format("r_arm", "0.1 0 0.05", 2, a, b, c, -xy, xz, -yz, box(0.0002))
    assert "audit_twins" not in codes(record(tmp_path, left, right))


def test_copies_of_a_finger_agree(tmp_path):
    values = ("0.1 0 0.05", 2, 0.005, 0.007, 0.009, 0, 0, 0, box(0))
    first, same = (LINK.format("finger_{}".format(index), *values) for index in (1, 2))
    heavy = LINK.format("finger_3", values[0], 3, *values[2:])
    assert "audit_twins" not in codes(record(tmp_path, first, same))
    assert codes(record(tmp_path, first, heavy)).count("audit_twins") == 1


def test_one_inertial_at_different_meshes_is_found(tmp_path):
    first = LINK.format("a", "0.1 0 0.05", 2, 0.005, 0.007, 0.009, 0, 0, 0, box(0))
    other = LINK.format("b", "0.1 0 0.05", 2, 0.005, 0.007, 0.009, 0, 0, 0, box(0, "0.4 0.3 0.1"))
    assert codes(record(tmp_path, first, other)).count("audit_copied") == 1
    same = LINK.format("b", "0.1 0 0.05", 2, 0.005, 0.007, 0.009, 0, 0, 0, box(0))
    assert "audit_copied" not in codes(record(tmp_path, first, same))
    collider = other.replace("visual>", "collision>")
    assert "audit_copied" not in codes(record(tmp_path, first, collider))
    # The drawn meshes of both are open and equal; only their colliders differ.
    corners = ["v {} {} {}".format(*point) for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0))]
    (tmp_path / "open.obj").write_text("\n".join([*corners, "f 1 2 3"]), encoding="utf-8")
    drawn = '<visual><geometry><mesh filename="open.obj"/></geometry></visual></link>'
    links = [one.replace("visual>", "collision>").replace("</link>", drawn)
             for one in (first, other)]  # fmt: skip
    assert "audit_copied" not in codes(record(tmp_path, *links))


@pytest.mark.parametrize("mass", [0, -1])
def test_massless_link_of_other_geometry_gets_no_twin(mass, tmp_path):
    left = LINK.format("l_arm", "0.1 0.02 0.05", mass, *TENSOR, box(0.02, "0.6 0.1 0.1"))
    right = LINK.format("r_arm", "0.1 -0.02 0.05", 2, *TENSOR, box(-0.02))
    link = record(tmp_path, left, right)["links"][1]
    assert link["repaired"] is None
    assert not any(one["change"] or one["geometry"] for one in link["findings"])
    alike = LINK.format("l_arm", "0.1 0.02 0.05", mass, *TENSOR, box(0.02))
    assert record(tmp_path, alike, right)["links"][1]["repaired"]["mass"] == 2


@pytest.mark.parametrize("place", ["nan", "inf", "1e160"])
def test_place_that_is_no_number_is_a_finding(place, tmp_path):
    path = tmp_path / "r.xml"
    body = '<body name="{}_a" pos="0 {} 0"><geom type="box" size=".1 .1 .1" mass="1"/></body>'
    bodies = body.format("left", place) + body.format("right", -1)
    path.write_text("<mujoco><worldbody>{}</worldbody></mujoco>".format(bodies))
    (text,), code = audit.answer(audit.parse(["audit", str(path)]))
    found = json.loads(text)
    assert code == 1 and found["total"]["mass"] == 2 and found["total"]["inertia"] is None
    assert [one["code"] for one in found["findings"]] == ["audit_joint"]
    assert "left_a" in found["findings"][0]["message"]
