# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The schema of SDFormat 1.9 for the written elements: attributes, children, counts and types.

Restated from its descriptions (sdf/1.9/root, model, link, inertial, pose, collision, visual,
geometry and joint), for machines without the parser itself, which test_sdf_parser.py asks.
"""

import math
import re

# Children: once "1", at most once "?", any number "*". Attributes: "!" required, "?" optional.
POSE = {"text": "pose", "attributes": {"relative_to": "?", "degrees": "?", "rotation_format": "?"}}
DOUBLE, STRING, VECTOR = ({"text": kind} for kind in ("double", "string", "vector3"))
TENSOR = {"children": {name: ("1", DOUBLE) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}}
INERTIAL = {
    "attributes": {"auto": "?"},
    "children": {
        "mass": ("?", DOUBLE),
        "density": ("?", DOUBLE),
        "pose": ("?", POSE),
        "inertia": ("?", TENSOR),
    },
}
ROUND = {"children": {"radius": ("1", DOUBLE), "length": ("1", DOUBLE)}}
GEOMETRY = {
    "children": {
        "box": ("?", {"children": {"size": ("1", VECTOR)}}),
        "capsule": ("?", ROUND),
        "cylinder": ("?", ROUND),
        "ellipsoid": ("?", {"children": {"radii": ("1", VECTOR)}}),
        "sphere": ("?", {"children": {"radius": ("1", DOUBLE)}}),
        "mesh": ("?", {"children": {"uri": ("1", STRING), "scale": ("?", VECTOR)}}),
    }
}
PLACED = {
    "attributes": {"name": "!"},
    "children": {"pose": ("?", POSE), "geometry": ("1", GEOMETRY)},
}
LIMIT = {"children": {name: ("?", DOUBLE) for name in ("lower", "upper", "effort", "velocity")}}
DYNAMICS = {
    "children": {name: ("?", DOUBLE) for name in ("damping", "friction", "spring_stiffness")}
}
AXIS = {"children": {"xyz": ("1", VECTOR), "limit": ("1", LIMIT), "dynamics": ("?", DYNAMICS)}}
JOINT = {
    "attributes": {"name": "!", "type": "!"},
    "children": {
        "parent": ("1", STRING),
        "child": ("1", STRING),
        "axis": ("?", AXIS),
        "axis2": ("?", AXIS),
        "pose": ("?", POSE),
    },
}
LINK = {
    "attributes": {"name": "!"},
    "children": {
        "pose": ("?", POSE),
        "inertial": ("?", INERTIAL),
        "collision": ("*", PLACED),
        "visual": ("*", PLACED),
    },
}
MODEL = {
    "attributes": {"name": "!"},
    "children": {"pose": ("?", POSE), "link": ("*", LINK), "joint": ("*", JOINT)},
}
SDF = {"attributes": {"version": "!"}, "children": {"model": ("?", MODEL)}}

JOINT_TYPES = {
    *("continuous", "revolute", "gearbox", "revolute2", "prismatic", "ball"),
    *("screw", "universal", "fixed"),
}
AXES = {
    "revolute": 1,
    "prismatic": 1,
    "continuous": 1,
    "universal": 2,
    "revolute2": 2,
    "fixed": 0,
    "ball": 0,
}


def validate(root):
    """AssertionError where the document is not what the descriptions allow."""
    assert root.tag == "sdf" and root.get("version") == "1.9"
    check(root, SDF)
    for model in root.iter("model"):
        frames = [
            element.get("name") for tag in ("link", "joint") for element in model.findall(tag)
        ]
        assert len({*frames}) == len(frames), "a name stands twice"
        assert not [
            name
            for name in frames
            if not name or "::" in name or re.fullmatch(r"__.*__|world", name)
        ]
        links = {link.get("name") for link in model.findall("link")}
        for link in model.findall("link"):
            for tag in ("visual", "collision"):
                names = [element.get("name") for element in link.findall(tag)]
                assert len({*names}) == len(names)
        for joint in model.findall("joint"):
            assert joint.get("type") in JOINT_TYPES
            assert {joint.findtext("parent"), joint.findtext("child")} <= {*links, "world"}
            assert joint.findtext("parent") != joint.findtext("child")
            assert (
                len(joint.findall("axis")) + len(joint.findall("axis2")) == AXES[joint.get("type")]
            )


def check(element, rule):
    attributes, children = rule.get("attributes", {}), rule.get("children", {})
    assert {*element.keys()} <= attributes.keys(), (element.tag, element.keys())
    assert {name for name, how in attributes.items() if how == "!"} <= {*element.keys()}, (
        element.tag
    )
    if "text" in rule:
        check_text(element, rule["text"])
    else:
        assert not (element.text or "").strip(), element.tag
    tags = [child.tag for child in element]
    assert {*tags} <= children.keys(), (element.tag, tags)
    for tag, (count, of_child) in children.items():
        assert count == "*" or tags.count(tag) <= 1, (element.tag, tag)
        assert count != "1" or tag in tags, (element.tag, tag)
        for child in element.findall(tag):
            check(child, of_child)


def check_text(element, kind):
    text = element.text or ""
    if kind == "string":
        assert text
        return
    values = list(map(float, text.split()))
    assert not any(map(math.isnan, values))
    if kind == "pose":
        quaternion = element.get("rotation_format") == "quat_xyzw"
        assert len(values) == (7 if quaternion else 6)
        assert not quaternion or abs(math.hypot(*values[3:]) - 1.0) < 1e-12
    else:
        assert len(values) == (3 if kind == "vector3" else 1)
