# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nested and scaled frames of MJCF, attached models and inline meshes, as our reader and as MuJoCo
have them.
"""

import mujoco
import numpy as np
import pytest
from body_moments.core.robots import Auditor, Roots, read_description, repaired_copy
from body_moments.core.verdict import FileError

from tests.robots.mjcf_models import check_links

MODEL = '<mujoco><compiler inertiafromgeom="false"/>{}<worldbody>{}</worldbody></mujoco>'
EVEN, UNEVEN = "scale=", 'scaling="geometry" scale='


class Writer:
    """A model of random nested frames and bodies. Uneven scales allow quarter turns only."""

    def __init__(self, seed):
        self.rng, self.is_even, self.count = np.random.default_rng(seed), seed % 2 == 0, 0

    def text(self, values):
        return " ".join(map(repr, np.ravel(values).tolist()))

    def place(self):
        position = self.text(self.rng.normal(size=3))
        turn = self.rng.uniform(-180, 180, 3) if self.is_even else 90 * self.rng.integers(0, 4, 3)
        return 'pos="{}" euler="{}"'.format(position, self.text(turn))

    def inertial(self):
        numbers = self.text(self.rng.uniform(2, 3, 3))
        return '<inertial mass="{}" diaginertia="{}" {}/>'.format(
            self.rng.uniform(1, 3), numbers, self.place()
        )

    def geom(self):
        kind = self.rng.choice(
            ["box", "ellipsoid", *["capsule", "cylinder", "sphere"] * self.is_even]
        )
        has_ends = self.is_even and kind != "sphere" and self.rng.random() < 0.5
        place = (
            'fromto="{}"'.format(self.text(self.rng.normal(size=6))) if has_ends else self.place()
        )
        return '<geom type="{}" size="{}" {}/>'.format(
            kind, self.text(self.rng.uniform(0.1, 0.5, 3)), place
        )

    def scale(self):
        own = self.rng.uniform(0.5, 2, 1 if self.is_even else 3)
        text = '{}"{}"'.format(EVEN if self.is_even else UNEVEN, self.text(own))
        return (
            "" if self.rng.random() < 0.3 else text + ' massscale="1.5"' * (self.rng.random() < 0.3)
        )

    def content(self, depth):
        parts = [self.geom()]
        for _ in range(self.rng.integers(1, 3) if depth else 0):
            if self.rng.random() < 0.6:
                parts.append(
                    "<frame {} {}>{}</frame>".format(
                        self.place(), self.scale(), self.content(depth - 1)
                    )
                )
            else:
                parts.append(self.body(depth - 1))
        return "".join(parts)

    def body(self, depth):
        self.count += 1
        name, place = "b{}".format(self.count), self.place()
        return '<body name="{}" {}>{}{}</body>'.format(
            name, place, self.inertial(), self.content(depth)
        )


def audit(path):
    return Auditor(Roots.for_file(path)).audit(read_description(path)).links


@pytest.mark.parametrize("seed", range(20))
def test_frames_are_those_of_mujoco(tmp_path, seed):
    path = tmp_path / "model.xml"
    path.write_text(MODEL.format("", Writer(seed).body(4)))
    check_links(path)


CHILD = """<mujoco model="child"><compiler angle="radian" meshdir="meshes" eulerseq="XYZ"
inertiafromgeom="false"/>
<asset><mesh file="t.obj"/><model name="inner" file="more/inner.xml"/></asset>
<default><geom size="7"/><default class="k"><geom size="3"/></default></default>
<include file="part.xml"/>
<worldbody><geom size=".5" pos="0 0 9"/><frame name="fr" pos="10 0 0" scale="2" massscale="3">
<body name="b" pos="1 2 3"
euler="1 0 .5" childclass="k">{0}<geom/><frame euler="0 1 0"><geom pos="1 2 3"/>
<attach model="inner" prefix="i_"/>
</frame><geom type="mesh" mesh="t" pos="5 5 5"/></body></frame><body name="out" childclass="k">
<body name="deep">{0}
<geom/></body></body></worldbody></mujoco>"""
INERTIAL = '<inertial mass="2" pos="1 0 0" euler="0 .3 0" diaginertia="1 2 2.5"/>'
INNER = """<mujoco><worldbody><geom size="2" pos="4 4 4"/><body name="i" euler="90 0 0">
{}<geom size="1"/></body>
</worldbody></mujoco>"""
MESH = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
PART = '<mujoco><worldbody><body name="part"><geom/></body></worldbody></mujoco>'


def write_child(folder):
    files = {
        "c.xml": CHILD.format(INERTIAL),
        "more/inner.xml": INNER.format(INERTIAL),
        "meshes/t.obj": MESH,
    }
    for name, text in {**files, "part.xml": PART}.items():
        (folder / "child" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "child" / name).write_text(text)
    return folder / "model.xml"


def test_bodies_and_joints_may_have_no_names(tmp_path):
    model = '<mujoco model="m">{}<worldbody>{}</worldbody></mujoco>'
    part = '<body><joint/><geom size="1"/></body>'
    body = '<body name="{}"><joint/><geom size="1"/>{}</body>'
    (tmp_path / "m.xml").write_text(model.format("", body.format("b", part)))
    asset = '<asset><model name="m" file="m.xml"/></asset>'
    twice = '<attach model="m" prefix="p_"/><attach model="m" prefix="q_"/>'
    path = tmp_path / "model.xml"
    path.write_text(model.format(asset, body.format("body 2", part) + twice))
    mujoco.MjModel.from_xml_path(str(path))
    description = read_description(path)
    names = ["body 2", "body 2 without name", "p_b", "body 4", "q_b", "body 6"]
    assert [link.name for link in description.links] == names
    assert {motion.name for joint in description.joints for motion in joint.motions} == {""}


@pytest.mark.parametrize("chosen", ['body="b"', 'body="deep"', 'frame="fr"', ""])
def test_attached_models_are_those_of_mujoco(tmp_path, chosen):
    """Names have all prefixes; a body leaves its own frames behind, and models have their own
    settings and folders.
    """
    path = write_child(tmp_path)
    asset = (
        '<asset><model name="m" file="child/c.xml"/></asset><default><geom size="11"/></default>'
    )
    attach = '<attach model="m" {} prefix="{}"/>'
    body = '<body name="own"><geom/><frame pos="0 0 5" euler="0 0 90" scale="3">{}</frame></body>{}'
    path.write_text(
        MODEL.format(asset, body.format(attach.format(chosen, "p_"), attach.format(chosen, "q_")))
    )
    assert all(link.span is None and link.place.file for link in check_links(path)[1:])
    codes = [found.code for one in audit(path) for found in one.findings]
    assert codes and not any(code.startswith("mesh") for code in codes)


FAULTS = {
    "../../out": "mesh_outside",
    "none": "mesh_missing",
    "own": "It is included already.",
    "robot": "description_unknown",
}


@pytest.mark.parametrize("name", FAULTS)
def test_attached_file_keeps_the_rules_of_includes(tmp_path, name):
    folder = tmp_path / "a" / "b"
    folder.mkdir(parents=True)
    model = MODEL.format('<asset><model name="m" file="{}.xml"/></asset>', '<body name="b"/>')
    (folder / "robot.xml").write_text("<robot/>")
    for other in ("own", "../../out"):
        (folder / (other + ".xml")).write_text(model.format("own"))
    (folder / "model.xml").write_text(model.format(name))
    with pytest.raises(FileError) as refused:
        read_description(folder / "model.xml")
    found = refused.value.finding
    assert FAULTS[name] in str(found.values["cause"]) and found.values["line"] == 1


def test_attached_model_without_its_body_is_a_finding(tmp_path):
    path = write_child(tmp_path)
    for attach in ('model="m" body="none"', 'model="none" body="b"', 'body="none"'):
        body = '<body name="own"><geom size="1"/>\n<attach {} prefix="p_"/></body>'.format(attach)
        path.write_text(MODEL.format('<asset><model name="m" file="child/c.xml"/></asset>', body))
        (link,) = read_description(path).links
        assert [(one.code, one.values["line"]) for one in link.findings] == [
            ("description_number", 2)
        ]


def test_attachments_of_attachments_are_limited(tmp_path):
    """Forty models that attach the next one twice each are 2^40 bodies."""
    for index in range(40):
        body = '<frame><attach model="m" prefix="a"/><attach model="m" prefix="b"/></frame>'
        asset = '<asset><model name="m" file="{}.xml"/></asset>'.format(index + 1)
        (tmp_path / "{}.xml".format(index)).write_text(
            MODEL.format(asset, '<body name="b"/>' + body)
        )
    (tmp_path / "40.xml").write_text(MODEL.format("", '<geom size="1"/>'))
    with pytest.raises(FileError) as refused:
        read_description(tmp_path / "0.xml")
    assert refused.value.finding.values["content"] == "elements"


STAR = "0 0 0 1 0 0 0 2 0 0 0 3 .2 .2 .2"  # Its last vertex is within the hull of the others.
FACES = 'face="0 2 1 0 1 3 0 3 2 1 2 4 2 3 4 3 1 4"'


@pytest.mark.parametrize("faces", ["", FACES])
@pytest.mark.parametrize(
    "more", ["", 'class="big"', 'scale="-2 1 3"', 'scale="2 2 2" refpos="1 2 3" refquat="1 2 3 4"']
)
@pytest.mark.parametrize("frame", ["", 'scale=".5" pos="1 2 3"'])
def test_inline_mesh_has_the_inertia_of_mujoco(tmp_path, faces, more, frame):
    """Its own inertia, as MuJoCo computes it from single-precision vertices, has no finding."""
    mesh = '<asset><mesh name="m" vertex="{}" {} {}/></asset>'.format(STAR, faces, more)
    head = (
        '<default><mesh inertia="exact"/><default class="big"><mesh scale="2 2 '
        '2"/></default></default>' + mesh
    )
    body = (
        '<body name="a">{}<frame {}><geom type="mesh" mesh="m" pos="3 2 1" euler="10 20 '
        '30"/></frame></body>'
    )
    path = tmp_path / "model.xml"
    path.write_text(
        "<mujoco>{}<worldbody>{}</worldbody></mujoco>".format(head, body.format("", frame))
    )
    model = mujoco.MjModel.from_xml_path(str(path))
    numbers = model.body_mass[1], model.body_ipos[1], model.body_iquat[1], model.body_inertia[1]
    form = '<inertial mass="{}" pos="{}" quat="{}" diaginertia="{}"/>'
    inertial = form.format(*(" ".join(map(repr, np.ravel(values).tolist())) for values in numbers))
    path.write_text(MODEL.format(head, body.format(inertial, frame)))
    (one,) = audit(path)
    assert not one.entries
    np.testing.assert_allclose(one.density, 1000.0, rtol=1e-5)
    stated, geometry = one.link.inertial, one.reference.uniform(one.link.inertial.mass)
    limit = 1e-5 * model.body_inertia[1].max()
    np.testing.assert_allclose(geometry.inertia, stated.inertia, atol=limit)
    np.testing.assert_allclose(geometry.center, stated.center, atol=1e-5)


FEW, OPEN, WORD = "0 0 0 1 0", "0 0 0 1 0 0 2 0 0 3 0 0", "0 0 nan 1 0 0 0 1 0 0 0 1"


@pytest.mark.parametrize(
    "numbers", [FEW, OPEN, WORD, *(STAR + '" face="0 1' + end for end in ("", " 9", " 1.5")), "x"]
)
def test_wrong_inline_mesh_is_a_finding_at_its_asset(tmp_path, numbers):
    path = tmp_path / "model.xml"
    body = '<body name="a">{}<geom type="mesh" mesh="m"/></body>'.format(INERTIAL)
    path.write_text(
        MODEL.format('\n<asset><mesh name="m" vertex="{}"/></asset>\n\n'.format(numbers), body)
    )
    (one,) = audit(path)
    assert [(entry.finding.code, entry.place.line) for entry in one.entries] == [
        ("description_number", 2)
    ]


def test_replicated_bodies_and_geoms_are_those_of_mujoco(tmp_path):
    """Copies stand where MuJoCo puts them, with its names, also in bodies and in other copies."""
    spokes = '<replicate count="4" euler="0 20 90" offset=".1 0 .05">{}</replicate>'
    spoke = '<geom type="box" size=".01 .02 .03" pos=".5 0 0" euler="10 0 0"/>'
    wheel = '<body name="w"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>{}</body>'
    pair = '<replicate count="11" sep="-" offset="0 1 0">{}</replicate>'
    body = pair.format(spokes.format(wheel.format(spokes.format(pair.format(spoke)))))
    path = tmp_path / "r.xml"
    path.write_text(MODEL.format("", body))
    model = mujoco.MjModel.from_xml_path(str(path))
    links = read_description(path, Roots.for_file(path)).links
    assert [link.name for link in links] == [model.body(i + 1).name for i in range(model.nbody - 1)]
    shapes = [one.shape for link in links for one in link.shapes]
    assert len(shapes) == model.ngeom == 11 * 4 * 11 * 4
    places = np.array([shape.pose.position for shape in shapes])
    assert np.abs(places - model.geom_pos).max() < 1e-12
    turns = np.array([shape.pose.rotation for shape in shapes])
    truth = np.zeros((model.ngeom, 9))
    for quaternion, row in zip(model.geom_quat, truth):
        mujoco.mju_quat2Mat(row, quaternion)
    assert np.abs(turns.reshape(-1, 9) - truth).max() < 1e-12


def test_inertial_of_replicated_bodies_is_repaired_once(tmp_path):
    """All copies of a body have one inertial in the file, and one repair."""
    body = (
        '<replicate count="3" offset="1 0 0"><body name="b"><geom type="box" size=".1 .2 .3"/>'
        '<inertial mass="48" pos="0 0 0" diaginertia="2080 1600 800"/></body></replicate>'
    )
    path = tmp_path / "r.xml"
    path.write_text(MODEL.format("", body))
    roots = Roots.for_file(path)
    audit = Auditor(roots).audit(read_description(path, roots))
    assert len(audit.links) == 3
    (link, repaired), *others = audit.repairs()
    assert not others and np.allclose(np.diag(repaired.inertia), [2.08, 1.6, 0.8])
    copy = repaired_copy(audit.description, audit.repairs())
    path.write_bytes(copy)
    again = Auditor(roots).audit(read_description(path, roots))
    assert not any(one.findings for one in again.links)
