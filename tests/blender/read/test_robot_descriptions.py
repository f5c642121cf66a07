# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Robots written in every way that the formats have, from numbers that are known: what descriptions
state of them.
"""

import numpy as np
import pytest

from tests.blender.robot_truth import (
    about,
    check,
    check_repair,
    fixed_angles,
    near,
    quaternion,
    random_inertial,
    read,
    text,
)

SEEDS = pytest.mark.parametrize("seed", range(6))


def mjcf_turns(rng, degrees, sequence):
    """Attributes and the rotations that they mean."""
    unit = np.degrees(1) if degrees else 1.0
    axis, angle, angles = rng.normal(size=3), rng.uniform(-3, 3), rng.uniform(-3, 3, 3)
    turn = np.eye(3)
    for name, each in zip(sequence, angles):
        step = about(np.eye(3)["xyz".index(name.lower())], each)
        # about axes that turn along, or that do not
        turn = turn @ step if name.islower() else step @ turn
    x, y = rng.normal(size=(2, 3))
    upright = y - (y @ x) / (x @ x) * x
    z = np.cross(x, upright)
    columns = np.column_stack([x, upright, z])
    yield "", np.eye(3)
    yield 'quat="{}"'.format(text(np.multiply(quaternion(axis, angle), 2.5))), about(axis, angle)
    yield 'euler="{}"'.format(text(angles * unit)), turn
    yield 'axisangle="{} {!r}"'.format(text(2.5 * axis), float(angle * unit)), about(axis, angle)
    yield 'xyaxes="{}"'.format(text([x, y])), columns / np.linalg.norm(columns, axis=0)
    yield (
        'zaxis="{}"'.format(text(axis)),
        about(np.cross((0, 0, 1), axis), np.arccos(axis[2] / np.linalg.norm(axis))),
    )
    yield 'zaxis="0 0 2"', np.eye(3)
    yield 'zaxis="0 0 -2"', np.diag([1.0, -1.0, -1.0])


@SEEDS
def test_mjcf(tmp_path, seed):
    rng = np.random.default_rng(seed)
    degrees, sequence = bool(seed % 2), ["xyz", "ZYX", "zYx", "XYZ", "yXz", "zyx"][seed]
    compiler = '<compiler angle="{}" eulerseq="{}" {}/>'.format(
        "degree" if degrees else "radian", sequence, ["", 'meshdir="m"', 'assetdir="m"'][seed % 3]
    )
    folder = "" if seed % 3 == 0 else "m/"
    head = """<mujoco model="bot">{}<default><mesh scale="2 3 4"/></default><asset><mesh name="own"
file="own.stl"
    scale="1 2 -3"/><mesh file="sub\\bare.stl"/><mesh name="far" file="/far.stl"/></asset>
<worldbody>"""
    bodies, inertials, truth, statement = (
        [],
        [],
        [],
        compiler if degrees or seed else compiler.replace('angle="radian"', ""),
    )
    degrees = degrees or not seed  # what is left out means degrees
    for number, (attributes, turn) in enumerate(mjcf_turns(rng, degrees, sequence)):
        mass, center, moments, tensor = random_inertial(rng, turn)
        if number == 0:
            products = rng.normal(size=3) / 9
            tensor = np.diag(moments) + sum(
                value * (np.outer(*pair) + np.outer(*pair[::-1]))
                for value, pair in zip(
                    products, (np.eye(3)[[0, 1]], np.eye(3)[[0, 2]], np.eye(3)[[1, 2]])
                )
            )
            moments = 'fullinertia="{}"'.format(text([*moments, *products]))
        else:
            moments = 'diaginertia="{}"'.format(text(moments))
        a, b, c = rng.uniform(0.1, 2, 3)
        ends, place = rng.normal(size=(2, 3)), rng.normal(size=3)
        along = ends[0] - ends[1]
        length = np.linalg.norm(along)
        upright = about(np.cross((0, 0, 1), along), np.arccos(along[2] / length))
        sizes = {
            'size="{!r}"'.format(float(a)): ("sphere", (a,)),
            'type="box" size="{}"'.format(text([a, b, c])): ("box", (2 * a, 2 * b, 2 * c)),
            'type="ellipsoid" size="{}"'.format(text([a, b, c])): ("ellipsoid", (a, b, c)),
            'type="capsule" size="{}"'.format(text([a, b])): ("capsule", (a, 2 * b)),
            'type="cylinder" size="{}"'.format(text([a, b])): ("cylinder", (a, 2 * b)),
            'mesh="own"': ("mesh", (1, 2, -3), folder + "own.stl"),
            'type="mesh" mesh="bare"': ("mesh", (2, 3, 4), folder + "sub\\bare.stl"),
            'mesh="far"': ("mesh", (2, 3, 4), "/far.stl"),
            'mesh="none"': ("mesh", (1, 1, 1)),
        }
        geoms = ['<geom {} pos="{}" {}/>'.format(size, text(place), attributes) for size in sizes]
        shapes = [
            (kind, size, place, turn, "collision", "".join(file))
            for kind, size, *file in sizes.values()
        ]
        geoms += [
            '<geom type="{}" fromto="{}" size="0.5"/>'.format(kind, text(ends))
            for kind in ("capsule", "cylinder")
        ]
        shapes += [
            (kind, (0.5, length), ends.mean(0), upright, "collision", "")
            for kind in ("capsule", "cylinder")
        ]
        for more, role in (('contype="0"', "collision"), ('conaffinity="0"', "collision")):
            geoms.append('<geom size="3" {}/>'.format(more))
            shapes.append(("sphere", (3,), (0, 0, 0), np.eye(3), role, ""))
        geoms += [
            '<geom size="3" contype="0" conaffinity="0"/>',
            '<geom type="plane" size="1 1 1"/>',
        ]
        shapes.append(("sphere", (3,), (0, 0, 0), np.eye(3), "visual", ""))
        truth.append(((mass, center, tensor), shapes))
        inertials.append(
            '<inertial pos="{}" mass="{!r}" {} {}/>'.format(text(center), mass, moments, attributes)
        )
        bodies.append('<body name="b{}">{}{}</body>'.format(number, inertials[-1], "".join(geoms)))
    description = read(tmp_path, head.format(statement) + "".join(bodies) + "</worldbody></mujoco>")
    assert (description.name, description.format) == ("bot", "mjcf")
    for number, (link, expected) in enumerate(zip(description.links, truth, strict=True)):
        assert link.name == "b{}".format(number) and not link.moves
        check(link, expected)
        assert description.source[slice(*link.span)].decode() == inertials[number]
        own = link.inertial.angles, link.inertial.quaternion
        assert [one is not None for one in own] == [number == 2 and sequence == "XYZ", number == 1]
    check_repair(tmp_path, description)


def test_mjcf_defaults_come_from_classes(tmp_path):
    """Of a geom: its own class, else the nearest child class; classes in classes; what the geom has
    itself counts.
    """
    description = read(
        tmp_path,
        """<mujoco><compiler angle="radian"/><compiler/>
        <default><geom type="box" size="1 2 3" contype="0"/><geom conaffinity="0"/>
          <default class="a"><geom size="4 5 6"/>
            <default class="b"><geom type="sphere" pos="1 2 3"/></default></default>
          <default class="c"><geom conaffinity="1" euler="0 0 0.5"/></default></default>
        <worldbody><body><geom/><geom class="b"/>
          <body name="x" childclass="a"><geom/><geom class="c" size="7 7 7"/><body childclass="b">
<geom/></body>
            <body><geom type="sphere"/></body></body>
          <body name="y"><geom pos="4 5 6"/></body></body></worldbody></mujoco>""",
    )
    nowhere, turn = (0, 0, 0), about((0, 0, 1), 0.5)
    expected = {
        "body 1": [
            ("box", (2, 4, 6), nowhere, np.eye(3), "visual"),
            ("sphere", (4,), (1, 2, 3), np.eye(3), "visual"),
        ],
        "x": [
            ("box", (8, 10, 12), nowhere, np.eye(3), "visual"),
            ("box", (14, 14, 14), nowhere, turn, "collision"),
        ],
        "body 3": [("sphere", (4,), (1, 2, 3), np.eye(3), "visual")],
        "body 4": [("sphere", (4,), nowhere, np.eye(3), "visual")],
        "y": [("box", (2, 4, 6), (4, 5, 6), np.eye(3), "visual")],
    }
    assert [link.name for link in description.links] == list(expected)
    for link in description.links:
        check(link, (None, [(*shape, "") for shape in expected[link.name]]))
        assert link.span is None


WRONG = {
    "robot.urdf": (
        '<robot name="r"><link name="a"><inertial><origin xyz="1 2"/></inertial><visual><origin '
        'rpy="1"/><geometry>'
        '<sphere radius="1"/></geometry></visual><collision><geometry><sphere '
        'radius="big"/></geometry></collision>'
        '<collision><geometry><sphere radius="2"/></geometry></collision></link></robot>',
        ["1 2", "1", "big"],
    ),
    "robot.sdf": (
        '<sdf><model name="m"><link '
        'name="a"><inertial><pose>1</pose></inertial><visual><geometry><box><size>1 2</size>'
        "</box></geometry></visual><collision><pose>1 "
        "2</pose><geometry><sphere/></geometry></collision><collision>"
        '<pose rotation_format="quat_xyzw">1 2 3 0 0 0 '
        "0</pose><geometry><sphere/></geometry></collision><collision>"
        "<geometry><sphere><radius>2</radius></sphere></geometry></collision></link></model></sdf>",
        ["1", "1 2", "1 2", "1 2 3 0 0 0 0"],
    ),
    "robot.xml": (
        '<mujoco><worldbody><body name="a"><inertial mass="1" pos="1 2"/><geom type="box" size="1 '
        '2"/><geom size="1"'
        ' quat="0 0 0 0"/><geom type="capsule" fromto="0 0 0 0 0 1"/><geom size="1" axisangle="0 0 '
        '0 1"/><geom size="1"'
        ' xyaxes="0 0 0 1 0 0"/><geom size="1" xyaxes="0 2 0 0 3 0"/><geom size="1" zaxis="0 0 '
        '0"/><geom size="2"/>'
        "</body></worldbody></mujoco>",
        ["1 2", "1 2", "0 0 0 0", "", "0 0 0 1", "0 0 0 1 0 0", "0 2 0 0 3 0", "0 0 0"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_numbers_are_findings_and_others_are_read(tmp_path, name):
    content, texts = WRONG[name]
    (link,) = read(tmp_path, content, name).links
    assert [(one.code, one.values["text"]) for one in link.findings] == [
        ("description_number", one) for one in texts
    ]
    assert link.inertial is None and [shape.shape.size for shape in link.shapes] == [(2.0,)]


PLACES = {
    "robot.urdf": """<robot name="r">
<link name="a">
<inertial><origin xyz="0 0 1"/>
<mass value="@"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
<collision><geometry>
<sphere radius="@"/></geometry></collision></link></robot>""",
    "robot.sdf": """<sdf><model name="m">
<link name="a"><inertial><pose>0 0 1 0 0 0</pose>
<inertia><ixx>1</ixx></inertia>
<mass>@</mass></inertial><collision><geometry><sphere>
<size/>
<radius>@</radius></sphere></geometry></collision></link></model></sdf>""",
    "robot.xml": """<mujoco><worldbody>
<body name="a">

<inertial mass="@" pos="0 0 1"/>

<geom type="sphere" size="@"/></body></worldbody></mujoco>""",
}
ELEMENTS = {
    "robot.urdf": ("mass", "sphere"),
    "robot.sdf": ("mass", "radius"),
    "robot.xml": ("inertial", "geom"),
}


@pytest.mark.parametrize("name", PLACES)
def test_word_for_a_number_is_named_with_its_line(tmp_path, name):
    for word in ("1_0", "٣", "1.0D0", "0x1", "1e", "--1", "1,0", "1\xa02"):
        (link,) = read(tmp_path, PLACES[name].replace("@", word), name).links
        found = [one.values for one in link.findings]
        assert [one["line"] for one in found] == [4, 6] and {one["text"] for one in found} == {word}
        assert tuple(one["element"] for one in found) == ELEMENTS[name]
        assert link.inertial is None and not link.shapes
    for word in ("+1", "1.", ".1e1", " 1E0\t"):
        (link,) = read(tmp_path, PLACES[name].replace("@", word), name).links
        assert (
            not link.findings and link.inertial.mass == 1.0 and link.shapes[0].shape.size == (1.0,)
        )


@SEEDS
def test_urdf(tmp_path, seed):
    rng = np.random.default_rng(seed)
    angles, place, (a, b, c) = rng.uniform(-3, 3, 3), rng.normal(size=3), rng.uniform(0.1, 2, 3)
    turn = fixed_angles(*angles)
    mass, center, _, tensor = random_inertial(rng, turn)
    own = turn.T @ tensor @ turn + np.ones((3, 3)) / 9
    tensor = turn @ own @ turn.T
    entries = " ".join(
        'i{}{}="{!r}"'.format("xyz"[i], "xyz"[j], float(own[i, j]))
        for i in range(3)
        for j in range(i, 3)
    )
    origin = '<origin xyz="{}" rpy="{}"/>'
    shapes = {
        '<mesh filename="a b.stl" scale="{}"/>'.format(text([a, b, c])): (
            "mesh",
            (a, b, c),
            "a b.stl",
        ),
        '<mesh filename="c.stl"/>': ("mesh", (1, 1, 1), "c.stl"),
        '<box size="{}"/>'.format(text([a, b, c])): ("box", (a, b, c), ""),
        "<box/>": ("box", (1, 1, 1), ""),
        '<sphere radius="{!r}"/>'.format(float(a)): ("sphere", (a,), ""),
        '<cylinder radius="{!r}" length="{!r}"/>'.format(*map(float, (a, b))): (
            "cylinder",
            (a, b),
            "",
        ),
        '<capsule radius="{!r}" length="{!r}"/>'.format(*map(float, (a, b))): (
            "capsule",
            (a, b),
            "",
        ),
    }
    content = """<robot name="bot" note="a>b"><link name="first"><inertial note="'>">
{}<mass value="{!r}"/><inertia {}/>
    </inertial>{}<collision><geometry/></collision><visual/></link><link name="second">
<inertial/></link>
    <link name="third"/></robot>"""
    elements = ""
    for role in ("collision", "visual"):
        for shape in shapes:
            where = origin.format(text(place), text(angles)) if role == "visual" else ""
            elements += "<{0}>{1}<geometry>{2}</geometry></{0}>".format(role, where, shape)
    content = content.format(origin.format(text(center), text(angles)), mass, entries, elements)
    description = read(tmp_path, content)
    first, second, third = description.links
    assert (description.name, description.format, first.name) == ("bot", "urdf", "first")
    expected = [(kind, size, place, turn, "visual", file) for kind, size, file in shapes.values()]
    expected += [
        (kind, size, (0, 0, 0), np.eye(3), "collision", file)
        for kind, size, file in shapes.values()
    ]
    check(first, ((mass, center, tensor), expected))
    check(second, ((0.0, (0, 0, 0), np.zeros((3, 3))), []))
    check(third, (None, []))
    assert (
        first.inertial.angles == pytest.approx(tuple(angles)) and first.inertial.quaternion is None
    )
    assert first.moves and not second.moves and third.span is None
    inertial = description.source[slice(*first.span)]
    assert inertial.startswith(b"<inertial note") and inertial.endswith(b"</inertial>")
    assert description.source[slice(*second.span)] == b"<inertial/>"
    check_repair(tmp_path, description)


@SEEDS
def test_sdf(tmp_path, seed):
    rng = np.random.default_rng(seed)
    angles, place, (a, b, c) = rng.uniform(-3, 3, 3), rng.normal(size=3), rng.uniform(0.1, 2, 3)
    turn, axis, angle = fixed_angles(*angles), rng.normal(size=3), rng.uniform(-3, 3)
    w, *xyz = quaternion(axis, angle)
    poses = [
        ("", (0, 0, 0), np.eye(3)),
        ("<pose/>", (0, 0, 0), np.eye(3)),
        ("<pose>{}</pose>".format(text([place, angles])), place, turn),
        ('<pose degrees="true">{}</pose>'.format(text([place, np.degrees(angles)])), place, turn),
        ('<pose degrees="1">{}</pose>'.format(text([place, np.degrees(angles)])), place, turn),
        (
            '<pose rotation_format="quat_xyzw">{} {}</pose>'.format(text(place), text([*xyz, w])),
            place,
            about(axis, angle),
        ),
    ]
    pose, position, rotation = poses[seed]
    sizes = {
        "<mesh><uri>m.dae</uri><scale>{}</scale></mesh>".format(text([a, b, c])): (
            "mesh",
            (a, b, c),
            "m.dae",
        ),
        "<mesh><uri> n.dae </uri></mesh>": ("mesh", (1, 1, 1), "n.dae"),
        "<box><size>{}</size></box>".format(text([a, b, c])): ("box", (a, b, c), ""),
        "<empty/><box/>": ("box", (1, 1, 1), ""),
        "<ellipsoid><radii>{}</radii></ellipsoid>".format(text([a, b, c])): (
            "ellipsoid",
            (a, b, c),
            "",
        ),
        "<ellipsoid/>": ("ellipsoid", (1, 1, 1), ""),
        "<sphere><radius>{!r}</radius></sphere>".format(float(a)): ("sphere", (a,), ""),
        "<sphere/>": ("sphere", (1,), ""),
        "<cylinder><radius>{!r}</radius><length>{!r}</length></cylinder>".format(
            *map(float, (a, b))
        ): (
            "cylinder",
            (a, b),
            "",
        ),
        "<capsule><radius>{!r}</radius><length>{!r}</length></capsule>".format(
            *map(float, (a, b))
        ): (
            "capsule",
            (a, b),
            "",
        ),
        "<cylinder/>": ("cylinder", (1, 1), ""),
    }
    elements = "".join("<{0}>{1}<geometry>{2}</geometry></{0}>".format(role, pose, size)
                       for role in ("collision", "visual") for size in sizes)  # fmt: skip
    mass, center, _, _ = random_inertial(rng, turn)
    own = np.diag(rng.uniform(2, 3, 3)) + 0.1
    inertial = "<inertial>{}<mass>{!r}</mass><inertia>{}</inertia></inertial>".format(
        pose,
        mass,
        "".join(
            "<i{0}{1}>{2!r}</i{0}{1}>".format("xyz"[i], "xyz"[j], float(own[i, j]))
            for i in range(3)
            for j in range(i, 3)
        ),
    )
    expected = [
        (kind, size, position, rotation, role, file)
        for role in ("visual", "collision")
        for kind, size, file in sizes.values()
    ]
    one = '<sdf version="1.9"><model name="m"><link name="a">{}</link></model></sdf>'
    (link,) = read(tmp_path, one.format(inertial + elements + "<visual/>")).links
    check(link, ((mass, position, rotation @ own @ rotation.T), expected))
    assert link.name == "a" and not link.moves
    angled, known = link.inertial.angles, link.inertial.quaternion
    assert (angled is None, known is None) == (seed == 5, seed != 5)
    assert near(
        np.array(angled or known), np.array([w, *xyz] if seed == 5 else angles * (seed > 1)), 1e-12
    )
    world = """<sdf><world><model name="m"><link name="a"><inertial/>{0}</link><model name="n">
<link name="b">{0}</link>
    </model></model><model name="s"><static>true</static><link name="c">{0}</link></model>
<model name="t"><static> 1
    </static><link name="d">{0}</link></model><model name="u"><static>0</static><link name="e">
<inertial auto="true">
    <mass>2</mass></inertial>{0}</link><link name="f"><inertial auto="1"/></link></model></world>
</sdf>"""
    description = read(tmp_path, world.format(elements))
    assert description.name == "m" and description.format == "sdf"
    names = ["m::a", "n::b", "s::c", "t::d", "u::e", "u::f"]
    assert [found.name for found in description.links] == names
    assert [found.moves for found in description.links] == [False, True, False, False, True, True]
    assert [found.inertial is None for found in description.links] == [False, *[True] * 5]
    check(description.links[0], ((1.0, (0, 0, 0), np.eye(3)), expected))
    assert description.source[slice(*description.links[0].span)] == b"<inertial/>"
    check_repair(tmp_path, description)
    assert [found.span is None for found in description.links] == [False, *[True] * 5]


def test_mjcf_frames_place_and_scale_what_is_in_them(tmp_path):
    """The numbers are those of MuJoCo 4.0.0."""
    own = '<inertial pos="0 0 .5" mass="2" diaginertia=".1 .2 .25"/>'
    geom = '<geom type="box" size=".1 .2 .3" pos=".5 0 0"/>'

    def link(content):
        model = '<mujoco><worldbody><body name="b">{}</body></worldbody></mujoco>'.format(content)
        return read(tmp_path, model).links[-1]

    nested = '<frame pos="1 0 0" scale="2"><frame pos="1 0 0" euler="0 0 90">{}</frame></frame>'
    (shape,) = link(own + nested.format(geom)).shapes
    assert near(shape.shape.pose.position, [3, 1, 0], 1e-14) and shape.shape.size == (0.4, 0.8, 1.2)
    body = '<frame {}><body name="c">' + own + geom + "</body></frame>"
    for attributes, mass, inertia in (
        ('scale="2"', 16, [3.2, 6.4, 8.0]),
        ('scale="2" massscale="3"', 6, [1.2, 2.4, 3.0]),
        ('scale="1 2 3" scaling="geometry"', 12, [3.15, 2.4, 2.85]),
    ):
        found = link(body.format(attributes))
        assert found.inertial.mass == mass and found.span is None
        assert near(np.diag(found.inertial.inertia), inertia, 1e-14)
    assert near(
        found.shapes[0].shape.size, (0.2, 0.8, 1.8), 1e-15
    ) and found.inertial.center.tolist() == [0, 0, 1.5]
    # no frame: it has no scale
    found = link(own + '<body name="d" pos="1 0 0" scale="2">{}</body>'.format(own + geom))
    assert found.inertial.mass == 2 and found.span is not None and not found.findings
    for wrong in (
        "<frame scale='0'>{}</frame>",
        "<frame scale='1 2 3'><frame euler='0 0 30'>{}</frame></frame>",
    ):
        found = link(own + wrong.format(geom))
        assert [one.code for one in found.findings] == ["description_number"] and not found.shapes
