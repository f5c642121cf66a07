# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies of MJCF whose masses MuJoCo takes from geoms, bounds or scales, beside its own numbers."""

import mujoco
import numpy as np
import pytest
from body_moments.core.robots import Auditor, Roots, read_description

from tests.robots.mjcf_models import check_links, matrix

MODEL = "<mujoco>{}<worldbody>{}</worldbody></mujoco>"


def text(values):
    return " ".join(map(repr, np.ravel(values).tolist()))


def audited(path, content=None):
    """Write a model, compare the inertials of the audit with MuJoCo's, and return our links."""
    if content is not None:
        path.write_text(content)
    model = mujoco.MjModel.from_xml_path(str(path))
    links = Auditor(Roots.for_file(path)).audit(read_description(path)).links
    assert len(links) == model.nbody - 1
    for index, one in enumerate(links, start=1):
        used = one.link.inertial
        if used is None:
            assert not model.body_mass[index]
            continue
        turn = matrix(model.body_iquat[index])
        size = np.sqrt(model.body_inertia[index].max() / max(model.body_mass[index], 1e-9))
        np.testing.assert_allclose(used.mass, model.body_mass[index], rtol=2e-5)
        np.testing.assert_allclose(used.center, model.body_ipos[index], atol=2e-5 * (1 + size))
        inertia = turn @ np.diag(model.body_inertia[index]) @ turn.T
        np.testing.assert_allclose(used.inertia, inertia, atol=4e-5 * inertia.max())
    return links


BUILTIN = [
    *(("sphere", str(count)) for count in range(4)),
    *(("hemisphere", str(count)) for count in (0, 1, 4, 10)),
    *[("cone", "3 0"), ("cone", "7 .4"), ("cone", "12 1"), ("supersphere", "9 1 1")],
    *[("supersphere", "8 .4 2.5"), ("supertorus", "6 .3 1 1"), ("supertorus", "9 .7 .5 2")],
    *[("box", "3 2 4 .1 .2 .3"), ("grid", "3 3 2 .1 .2 .3 3")],
    *[("cylinder", "5 4 3 .1 .2 .3"), ("ellipsoid", "3 6 5 .3 .2 .1")],
]


@pytest.mark.parametrize("kind, numbers", BUILTIN)
def test_builtin_mesh_has_the_mass_of_mujoco(tmp_path, kind, numbers):
    for inertia in ("convex", "legacy", "shell"):
        mesh = '<mesh name="m" builtin="{}" params="{}" inertia="{}" scale="1 2 .5"/>'
        head = "<asset>{}</asset>".format(mesh.format(kind, numbers, inertia))
        body = '<body><geom type="mesh" mesh="m" pos="1 2 3" euler="9 8 7"/></body>'
        (one,) = audited(tmp_path / "m.xml", MODEL.format(head, body))
        assert one.link.from_shapes and not one.entries


@pytest.mark.parametrize(
    "kind, numbers",
    [("plate", "2 2"), ("wedge", "3 3 30 30 0"), ("box", "2 2 2 1 1 1 2"), ("cone", "2")],
)
def test_builtin_mesh_without_volume_or_sense_is_no_shape(tmp_path, kind, numbers):
    head = '<asset><mesh name="m" builtin="{}" params="{}"/></asset>'.format(kind, numbers)
    path = tmp_path / "m.xml"
    path.write_text(MODEL.format(head, '<body><geom type="mesh" mesh="m"/></body>'))
    (link,) = read_description(path).links
    assert not link.shapes
    (refused,) = link.findings
    assert refused.code == "description_number" and kind + " " + numbers in str(refused)


def dented(rng):
    """The vertices and faces of a random prism over an L, which no primitive fits."""
    outline = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2]]) + rng.normal(
        scale=0.05, size=(6, 2)
    )
    points = np.array([[*place, height] for height in (0.0, 0.7) for place in outline])
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = points @ (turn * np.linalg.det(turn)) + rng.normal(size=3)
    top = [[6, 7, 8], [6, 8, 9], [6, 9, 11], [9, 10, 11]]
    sides = [[i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6] for i in range(6)]
    faces = [*top, *[[c - 6, b - 6, a - 6] for a, b, c in top]]
    faces += [face for a, b, c, d in sides for face in ([a, b, c], [a, c, d])]
    return 'vertex="{}" face="{}"'.format(text(np.float32(points)), text(np.array(faces)))


@pytest.mark.parametrize("seed", range(12))
def test_primitive_fitted_to_a_mesh_is_that_of_mujoco(tmp_path, seed):
    rng = np.random.default_rng(seed)
    for kind in ("box", "sphere", "ellipsoid", "capsule", "cylinder", "mesh", ""):
        mesh = '<mesh name="m" {} inertia="{}" {}/>'.format(
            dented(rng),
            rng.choice(["legacy", "exact", "convex", "shell"]),
            rng.choice(["", 'scale="2 2 2"', 'refpos="1 2 3" refquat="1 2 3 4"', 'scale="1 -2 3"']),
        )
        compiler = '<compiler fitaabb="{}"/>'.format(rng.choice(["true", "false"]))
        masses = ["", 'mass="2"', 'density="7"', 'shellinertia="true" density="3"']
        mass = rng.choice(masses[: 3 if kind == "mesh" else 4])
        geom = '<geom {} mesh="m" fitscale="{}" {} euler="{}" pos="{}"/>'.format(
            'type="{}"'.format(kind) if kind else "",
            *(rng.uniform(0.5, 2.0), mass, text(rng.uniform(0, 90, 3)), text(rng.normal(size=3))),
        )
        frame = '<frame {} pos="1 0 0" euler="0 90 0">{}</frame>'
        scale = rng.choice(["", 'scale="1.7"', 'scale="2" massscale="3"'])
        head = compiler + "<asset>{}</asset>".format(mesh)
        body = "<body>{}</body>".format(frame.format(scale, geom))
        (one,) = audited(tmp_path / "m.xml", MODEL.format(head, body))
        assert one.link.from_shapes and not one.link.findings


def random_geom(rng):
    kind = rng.choice(["box", "sphere", "ellipsoid", "capsule", "cylinder"])
    mass = rng.choice(["", 'mass="2"', 'mass="0"', 'density="70"', 'shellinertia="true"'])
    place = 'euler="{}" pos="{}"'.format(text(rng.uniform(0, 90, 3)), text(rng.normal(size=3)))
    group = rng.choice(["", 'group="1"', 'group="3"'])
    form = '<geom type="{}" size="{}" {} {} {}/>'
    return form.format(kind, text(rng.uniform(0.1, 0.5, 3)), mass, group, place)


@pytest.mark.parametrize("seed", range(30))
def test_compiler_settings_change_inertials_as_in_mujoco(tmp_path, seed):
    rng = np.random.default_rng(seed)
    form = '<inertial mass="{}" diaginertia="{}" pos="{}"/>'

    def body(name, inner="", sure=False):
        numbers = rng.uniform(0.4, 3.0), rng.uniform(1.0, 1.9, 3), rng.normal(size=3)
        own = form.format(*map(text, numbers)) if sure or rng.random() < 0.5 else ""
        geoms = "".join(random_geom(rng) for _ in range(rng.integers(1, 4)))
        return '<body name="{}">{}{}{}</body>'.format(name, own, geoms, inner)

    def compiler(*more):
        some = (
            'inertiafromgeom="{}"'.format(rng.choice(["true", "auto"])),
            'boundmass="{}"'.format(rng.uniform(0, 3)),
            'boundinertia="{}"'.format(rng.uniform(0, 2)),
            'inertiagrouprange="1 3"',
            *more,
        )
        chosen = [one for one in some if rng.random() < 0.5]
        return '<compiler balanceinertia="true" {}/>'.format(" ".join(chosen))

    child = MODEL.format(compiler(), body("inner", body("deep")))
    (tmp_path / "c.xml").write_text(child)
    attach = '<attach model="c" body="inner" prefix="c_"/>'
    head = compiler('settotalmass="{}"'.format(rng.uniform(5, 50)))
    head += '<asset><model name="c" file="c.xml"/></asset>'
    bodies = body("a", attach + body("b")) + "<body/>" + body("sure", sure=True)
    links = audited(tmp_path / "m.xml", MODEL.format(head, bodies))
    for one in links:
        codes = [entry.finding.code for entry in one.entries]
        assert ("audit_overridden" in codes) <= (one.link.inertial is not None)


BOX = '<inertial mass="48" pos="0 0 0" diaginertia="{}"/><geom type="box" size=".1 .2 .3"/>'
RIGHT, WRONG, IMPOSSIBLE = "2.08 1.6 .8", "2 2 3", "1 1 3"


@pytest.mark.parametrize(
    "settings, inertia, expected",
    [
        ("", RIGHT, []),
        ('inertiafromgeom="auto"', RIGHT, []),
        ('inertiafromgeom="true"', RIGHT, [("audit_overridden", "note")]),
        ('inertiafromgeom="true"', WRONG, [("audit_overridden", "warning")]),
        ('boundinertia="0.81"', RIGHT, [("audit_overridden", "note")]),
        ('settotalmass="24"', RIGHT, [("audit_overridden", "note")]),
        ('balanceinertia="true"', RIGHT, []),
    ],
)
def test_inertial_that_the_compiler_replaces_is_said(tmp_path, settings, inertia, expected):
    path = tmp_path / "m.xml"
    head = "<compiler {}/>".format(settings)
    (one,) = audited(path, MODEL.format(head, "<body>{}</body>".format(BOX.format(inertia))))
    assert [(entry.finding.code, str(entry.severity)) for entry in one.entries] == expected
    assert (one.link.span is None) == bool(expected)  # A repair would change nothing.


def test_balanced_inertia_is_compared_with_the_geometry(tmp_path):
    """MuJoCo makes a ball of an impossible inertia: that is said, and what it uses is compared."""
    head = '<compiler balanceinertia="true"/>'
    body = "<body>{}</body>".format(BOX.format(IMPOSSIBLE))
    (one,) = audited(tmp_path / "m.xml", MODEL.format(head, body))
    assert [entry.finding.code for entry in one.entries][0] == "audit_overridden"
    assert "inertial_triangle" not in [entry.finding.code for entry in one.entries]


def test_full_tensor_of_negative_moments_stays_impossible(tmp_path):
    """MuJoCo refuses it in spite of bounds, which raise a zero moment."""
    model = MODEL.format(
        '<compiler boundinertia="2"/>',
        '<body><inertial mass="1" pos="0 0 0" fullinertia="{} 1 1 {} 0 0"/></body>',
    )
    (one,) = audited(tmp_path / "m.xml", model.format(0, 0))
    assert [entry.finding.code for entry in one.entries] == ["audit_overridden"]
    path = tmp_path / "m.xml"
    path.write_text(model.format(-1, 0.1))
    with pytest.raises(ValueError, match="positive"):
        mujoco.MjModel.from_xml_path(str(path))
    (one,) = Auditor(Roots.for_file(path)).audit(read_description(path)).links
    assert [entry.finding.code for entry in one.entries] == ["inertial_not_positive"]


def test_paths_of_meshes_are_stripped(tmp_path):
    (tmp_path / "here").mkdir()
    points = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "here" / "t.obj").write_text(points)
    head = '<compiler strippath="true" meshdir="here"/><asset><mesh file="{}/t.obj"/></asset>'
    for folder in ("../../elsewhere", "C:\\else\\where"):
        model = MODEL.format(head.format(folder), '<body><geom type="mesh" mesh="t"/></body>')
        (one,) = audited(tmp_path / "m.xml", model)
        assert not one.entries


def test_parts_of_a_model_are_attached_to_itself(tmp_path):
    arm = '<body name="arm" pos="1 2 3" childclass="k">{}<geom/>{}</body>'
    inertial = '<inertial mass="2" pos="1 0 0" diaginertia="2 2 2.5"/>'
    inner = '<frame name="f" pos="0 0 5"><body name="hand" euler="1 2 3"><geom/></body></frame>'
    more = '<body name="own"><attach body="arm" prefix="l_"/><attach frame="f" prefix="r_"/></body>'
    head = '<default><default class="k"><geom size=".2"/></default></default>'
    path = tmp_path / "m.xml"
    path.write_text(MODEL.format(head, arm.format(inertial, inner) + more))
    links = check_links(path)
    assert [one.name for one in links] == ["arm", "hand", "own", "l_arm", "l_hand", "r_hand"]
    path.write_text(
        MODEL.format(head, '<body name="a"><geom/><attach body="a" prefix="b_"/></body>')
    )
    assert [one.name for one in read_description(path).links] == ["a", "b_a"]


def test_mesh_in_the_format_of_mujoco_is_read(tmp_path):
    counts, faces = np.array([4, 0, 4, 4], "<i4"), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], "<f4")
    parts = counts, points, np.zeros((4, 2), "<f4"), np.array(faces, "<i4")
    data = b"".join(part.tobytes() for part in parts)
    model = MODEL.format(
        '<asset><mesh file="m.msh"/></asset>', '<body><geom type="mesh" mesh="m"/></body>'
    )
    (tmp_path / "m.msh").write_bytes(data)
    (one,) = audited(tmp_path / "m.xml", model)
    assert one.link.from_shapes and not one.entries
    for damaged in (data[:-1], data + b"0", data[:10], b"\xff" + data[1:]):
        (tmp_path / "m.msh").write_bytes(damaged)
        path = tmp_path / "m.xml"
        (one,) = Auditor(Roots.for_file(path)).audit(read_description(path)).links
        # The mass is unknown, and the report says why.
        assert one.link.inertial is None
        assert [entry.finding.code for entry in one.entries] == ["mesh_unreadable"]
