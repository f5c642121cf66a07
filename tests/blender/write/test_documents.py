# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that writers make: meshes of robots, glTF, JSON, thumbnails, pages, and stored sections that are damaged."""

import json
from math import inf, nan

import bpy
import numpy as np
import pytest
from body_moments.blender.write import properties
from body_moments.core.measurement import documents
from body_moments.core.measurement.page import to_html
from body_moments.core.measurement.plain_text import visible
from body_moments.core.mesh.surface import Surface
from body_moments.core.robots.model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape
from body_moments.core.robots.write import audit_report, gltf, stl
from body_moments.core.verdict.finding import finding

from tests.blender import batch_files
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, only
from tests.operators.measure.test_section import I_BEAM, flat_mesh

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
QUARTERS = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def of_box(mass, sides, center=(0.0, 0.0, 0.0), turn=TURN):
    moments = mass * (np.square(sides).sum() - np.square(sides)) / 12.0
    order = np.argsort(moments)
    axes = turn[:, order] * (1.0, 1.0, np.linalg.det(turn[:, order]))
    return Inertial(mass, np.array(center), turn @ np.diag(moments) @ turn.T, moments[order], axes)


def robot():
    """A link of each kind of shape, a joint of each kind, names that no format has, two roots."""
    corners = np.array([(0, 0, 0), (9, 9, 9), (1, 0, 0), (0, 2, 0), (0, 0, 3)], float)  # the second is in no triangle
    surface = Surface.from_triangles(corners, np.array([(0, 3, 2), (0, 2, 4), (0, 4, 3), (2, 3, 4)]))
    box = Shape("box", (1.0, 2.0, 3.0), Pose(np.array([0.5, 0.0, 0.0])))
    shapes = {
        "base": (Shape("mesh", file="meshes/base.stl", surface=surface), box),
        "arm <1>": (Shape("mesh", (2.0, 1.0, 1.0), Pose(np.zeros(3), TURN), "meshes/arm.stl", True),),
        "arm_1_": (Shape("ellipsoid", (1.0, 2.0, 3.0)),),
        "world": (Shape("capsule", (0.5, 2.0), Pose(np.array([0.0, 1.0, 0.0]), QUARTERS)),),
        "3rd::link": (Shape("cylinder", (0.25, 1.5)),),
        "hand": (Shape("sphere", (0.75,)),),
        "": (),
        "wheel": (),
        "other": (),
    }
    links = [
        Link(
            name, of_box(count + 1.0, (1.0, 2.0, 4.0), (0.1 * count, 0.0, -0.5)), Pose(np.array([count, 0.0, 1.0])), own
        )
        for count, (name, own) in enumerate(shapes.items())
    ]
    links[1] = Link("arm <1>", links[1].inertial, Pose(np.array([1.0, 2.0, 3.0]), QUARTERS), links[1].shapes)
    links[7] = Link("wheel", None, Pose(), ())
    x, y, z = np.eye(3)
    joints = (
        Joint("shoulder", "base", "arm <1>", (FreeAxis("rotate", z, -0.5, 1.5),)),
        Joint("spin", "arm <1>", "arm_1_", (FreeAxis("rotate", -y),)),
        Joint("slide", "arm_1_", "world", (FreeAxis("translate", x, -0.25, inf),)),
        Joint("weld", "world", "3rd::link"),
        Joint("cross", "3rd::link", "hand", (FreeAxis("rotate", x, -1.0, 1.0), FreeAxis("rotate", -y, -0.5, inf))),
        Joint("ball", "hand", "", (FreeAxis("rotate", x), FreeAxis("rotate", y), FreeAxis("rotate", z))),
        Joint("hip", "", "wheel", (FreeAxis("rotate", x), FreeAxis("rotate", -y, -1.0, 2.0), FreeAxis("translate", z))),
    )
    return Robot('A "robot"', tuple(links), joints)


def test_robot_meshes_are_written_to_named_files(tmp_path):
    """Of the shapes that have surfaces."""
    for _ in range(2):  # in place of those of before
        written = stl.write_meshes(robot(), tmp_path / "New arm.urdf")
    names = [[shape.file for shape in link.shapes] for link in written.links]
    assert names[:2] == [["meshes/new_arm/base.stl", ""], ["meshes/arm.stl"]]
    (path,) = (one for one in tmp_path.rglob("*") if one.is_file())
    data, surface = path.read_bytes(), robot().links[0].shapes[0].surface
    assert path == tmp_path / names[0][0] and data[:80] == b"Body Moments".ljust(80, b"\0")
    rows = np.frombuffer(data[84:], [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    assert len(rows) == int.from_bytes(data[80:84], "little") == 4
    assert not rows["normal"].any() and not rows["more"].any()
    assert (rows["corners"] == surface.points[surface.all_triangles()[0]]).all()


@pytest.mark.parametrize("value", [nan, inf])
def test_numbers_beyond_json_are_refused(value):
    entry = {"mass": value}
    for write in (documents.to_json, documents.to_json_lines, audit_report.to_json):
        with pytest.raises(ValueError):
            list(write([entry]))
    for data in (b"{}", gltf.to_glb("{}")):
        with pytest.raises(ValueError):
            gltf.replace_json(data, entry)
    (stored,) = json.loads(properties.findings_text([finding("t_junctions", count=value)]))
    assert stored["values"] == {"count": None}


def test_control_characters_are_written_visibly():
    assert visible("Würfel 立方体 \x1b[31m\r\n\u2028\u2029\u202e\ud800.") == (
        "Würfel 立方体 \\x1b[31m\\r\\n\\u2028\\u2029\\u202e\\ud800."
    )


def test_page_row_has_picture_or_inertia_box(scene):
    """No other text can stand there."""
    add(box_mesh(1, 2, 4), "Box")
    document = batch_files.document("--thumbnails")
    entry = document["objects"][0]

    def shown(**changed):
        page = "".join(to_html([{**document, "objects": [{**entry, **changed}]}]))
        return page.count("<img"), page.count("<svg")

    assert shown() == (1, 0)
    for wrong in (None, 5, "", "javascript:x", entry["thumbnail"] + '"', "x" + entry["thumbnail"]):
        assert shown(thumbnail=wrong) == (0, 1)
    for name in ("mass", "principal_moments", "principal_axes"):
        assert shown(thumbnail=None, **{name: None}) == (0, 0)
    assert shown(thumbnail=None, mass=0.0) == shown(thumbnail=None, principal_moments=[1.0, None, 2.0]) == (0, 0)
    assert shown(thumbnail=None, principal_moments=[0.0, 0.0, 0.0]) == (0, 1)


def test_a_section_that_somebody_else_has_stored_is_none(scene):
    from body_moments.blender.write import section

    beam = add(flat_mesh(I_BEAM), "Beam")
    only(beam)
    bpy.ops.object.body_moments_measure_section()
    kept = beam[section.KEY].to_dict()
    assert section.stored(beam) is not None
    for name, length in section.LENGTHS.items():
        for wrong in ([0.0] * (length + 1), [0.0] * (length - 1) if length > 1 else ["x"], "x" * length, 5.0):
            beam[section.KEY] = {**kept, name: wrong}
            assert section.stored(beam) is None, (name, wrong)
        beam[section.KEY] = {one: value for one, value in kept.items() if one != name}
        assert section.stored(beam) is None
    for name in section.SIDE_DESCRIPTIONS:
        beam[section.KEY] = {one: value for one, value in kept.items() if one != name}
        assert (section.stored(beam) is not None) == (name == "findings")
    beam[section.KEY] = kept
    assert section.stored(beam) is not None and section.fingerprint(beam) == kept["fingerprint"]
    for wrong in (5, "text", [1.0, 2.0]):
        beam[section.KEY] = wrong
        assert section.stored(beam) is None and section.fingerprint(beam) == ""
    assert section.clear(beam) and not section.clear(beam) and section.stored(beam) is None
