# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole documents, kept as text: of measured objects in each format, of a robot in each format. What is in them is
tested where it is measured; here is what they look like.
"""

import base64
import json
import re
import zlib
from dataclasses import replace
from math import inf, nan

import bpy
import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.robots.model import FreeAxis, Inertial, Joint, Link, Pose, Robot, Shape
from body_moments.core.robots.stated import Description, StatedInertial, StatedLink
from body_moments.core.verdict.finding import finding
from body_moments.operators.write import documents, messages, properties, text_report
from body_moments.operators.write.html.report import to_html
from body_moments.operators.write.robots import audit_report, formats, gltf, shapes, stl, usd
from body_moments.operators.write.terminal import visible
from body_moments.operators.write.thumbnail import SIZE, thumbnail

from tests.blender import batch_files
from tests.blender.actions.measure.test_section import I_BEAM, flat_mesh, square
from tests.blender.actions.setup.test_remedy_buttons import boxes
from tests.blender.bodies.test_assembly import box_mesh
from tests.blender.objects import add, only

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
QUARTERS = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def of_box(mass, sides, center=(0.0, 0.0, 0.0), turn=TURN):
    moments = mass * (np.square(sides).sum() - np.square(sides)) / 12.0
    order = np.argsort(moments)
    axes = turn[:, order] * (1.0, 1.0, np.linalg.det(turn[:, order]))
    return Inertial(mass, np.array(center), turn @ np.diag(moments) @ turn.T, moments[order], axes)


def robot():
    """A link of each kind of shape, a joint of each kind, names that no format has, two roots."""
    shapes = {
        "base": (Shape("mesh", file="meshes/base.stl"), Shape("box", (1.0, 2.0, 3.0), Pose(np.array([0.5, 0.0, 0.0])))),
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


def surface_of(name):
    corners = np.array([(0, 0, 0), (9, 9, 9), (1, 0, 0), (0, 2, 0), (0, 0, 3)], float)  # the second is in no triangle
    faces = np.array([(0, 3, 2), (0, 2, 4), (0, 4, 3), (2, 3, 4)])
    return Surface.from_triangles(corners, faces) if name == "base" else None


@pytest.mark.parametrize("name", formats.WRITERS)
def test_a_robot(kept, name):
    remarks = (finding("robot_without_links"), finding("robot_links_left_out", count=1, links=["--"]))
    text, findings = formats.robot_text(robot(), name, remarks, surface_of=surface_of)
    brief, _ = formats.robot_text(robot(), name, inertial_only=True)
    writer = formats.WRITERS[name]
    assert writer.write(robot()) == writer.write(robot(), (), inertial_only=False)
    said = ["{:s} {!r}".format(one.code, one.values) for one in findings]
    kept("robot." + name, "\n".join([text, "=== inertials only", brief, "=== findings", *said]))


def test_a_robot_of_one_root_without_remarks(kept):
    whole = robot()
    one = Robot("One", whole.links[:2], whole.joints[:1])
    kept("robots_of_one_root.txt", "\n".join(formats.robot_text(one, name)[0] for name in formats.WRITERS))


def test_the_meshes_of_a_robot_are_written_where_its_file_names_them(tmp_path):
    """Of the links that have surfaces, and of these the shapes that are meshes."""
    for _ in range(2):  # in place of those of before
        written = stl.write_meshes(robot(), surface_of, tmp_path / "new")
        assert written == finding("robot_meshes_written", count=1, folder=str(tmp_path / "new"))
    (path,) = (one for one in tmp_path.rglob("*") if one.is_file())
    data, surface = path.read_bytes(), surface_of("base")
    assert path == tmp_path / "new" / "meshes" / "base.stl" and data[:80] == b"Body Moments".ljust(80, b"\0")
    rows = np.frombuffer(data[84:], [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    assert len(rows) == int.from_bytes(data[80:84], "little") == 4
    assert not rows["normal"].any() and not rows["more"].any()
    assert (rows["corners"] == surface.points[surface.all_triangles()[0]]).all()


def test_masses_over_another_layer_and_into_another_file(kept):
    whole = robot()
    scaled = Link("other", whole.links[8].inertial, whole.links[8].pose, (), np.array([1.0, 2.0, 4.0]))
    whole = Robot("Over", (*whole.links[:8], scaled), whole.joints)
    paths = {"base": ("root", "base"), "other": ("root", "above", "other")}
    document = {
        "nodes": [
            {"name": "base", "extensions": {"OWN": 1}},
            {"name": "other"},
            {"name": "hand"},
            {"name": "base"},
            {},
        ],
        "skins": [{"joints": [3]}],
        "extensionsUsed": ["OWN"],
    }
    said = gltf.add_rigid_bodies(document, whole, 0.5)
    missing = gltf.add_rigid_bodies({"nodes": [{"name": "other"}, {"name": "other"}]}, whole, 1.0)
    lines = [usd.write_over(whole, paths, "./geometry.usda", 0.5, ["Remark"]), json.dumps(document, indent=1)]
    kept("masses_over.txt", "\n".join(lines + ["{:s} {!r}".format(one.code, one.values) for one in (*said, *missing)]))


def test_a_glb_file_keeps_what_is_no_json():
    document, binary = {"name": "Würfel"}, b"\x01\x02\x03\x04"
    data = gltf.to_glb(json.dumps(document))
    assert data[:4] == b"glTF" and len(data) == int.from_bytes(data[8:12], "little") and len(data) % 4 == 0
    assert gltf.read_json(data) == document
    data += len(binary).to_bytes(4, "little") + b"BIN\0" + binary
    other = gltf.replace_json(data, {"name": "other", "more": [1]})
    assert gltf.read_json(other) == {"name": "other", "more": [1]}
    assert other.endswith(binary) and len(other) == int.from_bytes(other[8:12], "little")
    assert other[4:8] == (2).to_bytes(4, "little") and other[16:20] == b"JSON"
    text = gltf.replace_json(b"{}", document)
    assert text.decode() == '{\n\t"name": "Würfel"\n}\n' and gltf.read_json(text) == document


@pytest.mark.parametrize("value", [nan, inf])
def test_what_is_no_number_of_json_is_never_written(value):
    entry = {"mass": value}
    for write in (documents.to_json, documents.to_json_lines, audit_report.to_json):
        with pytest.raises(ValueError):
            list(write([entry]))
    for data in (b"{}", gltf.to_glb("{}")):
        with pytest.raises(ValueError):
            gltf.replace_json(data, entry)
    (stored,) = json.loads(properties.findings_text([finding("t_junctions", count=value)]))
    assert stored["values"] == {"count": None}


def test_audits_of_robots(kept):
    found = [finding("no_faces"), finding("overlap_unchecked", count=2), finding("t_junctions", count=3)]
    stated = StatedInertial(
        2.0, np.array([0.5, 0.0, 1.0]), np.array([[3.0, 0.1, 0.0], [0.3, 2.0, 0.0], [0.0, 0.0, 1.0]])
    )
    links = [StatedLink("=<b>", stated), StatedLink("bare"), StatedLink("noted", stated)]
    entries = [
        audit_report.link_entry(links[0], found, stated.along_link(mass=4.0), 1234.5678),
        audit_report.link_entry(links[1], (), None, None),
        audit_report.link_entry(links[2], found[2:], None, 1000.0),
    ]
    description = Description("Robot", "urdf", tuple(links))
    documents = [
        audit_report.document("a&b.urdf", description, entries, "out/a&b.urdf"),
        audit_report.document("fine.urdf", description, entries[1:], None),
        audit_report.failed_document("gone.urdf", finding("file_missing")),
    ]
    pages = [write(documents) for write in audit_report.FORMATS.values()] + [audit_report.to_json(documents[:1])]
    kept("audits.txt", "\n".join([*pages, *map(audit_report.to_text, documents)]))


def test_links_as_the_primitives_of_their_inertia(kept):
    lines = []
    for kind in ("box", "ellipsoid", "capsule", "none"):
        for link in shapes.with_primitives(robot(), kind).links:
            lines += [repr((kind, link.name, [(one.kind, np.round(one.size, 9).tolist()) for one in link.shapes]))]
    kept("primitives.txt", "\n".join(lines))


def test_what_a_sentence_leaves_out_of_a_list_is_translated():
    german = {"and {count} more": "und {count} weitere"}
    said = messages.sentence(finding("missing_links", names=["a"] * 9), lambda text: german.get(text, text))
    assert ", und 1 weitere" in said and "more" not in said


def test_what_terminals_would_obey_is_shown():
    assert visible("Würfel 立方体 \x1b[31m\r\n\u2028\u2029\u202e\ud800.") == (
        "Würfel 立方体 \\x1b[31m\\r\\n\\u2028\\u2029\\u202e\\ud800."
    )


def scene_of_all_kinds():
    add(box_mesh(1, 2, 4), "Box", location=(1, 2, 3)).body_moments.density = 500.0
    flipped = add(boxes(2.0, reverse=[0]), "=Flipped", location=(5, 0, 0))
    flipped.body_moments.kind, flipped.body_moments.thickness = "SHELL", 0.125
    dense = add(box_mesh(1, 1, 1), "Polynomial", rotation=(0.0, 0.0, np.pi / 2))
    dense.body_moments.density_from, dense.body_moments.density_polynomial = "POLYNOMIAL", "900 + 120*x"
    bpy.ops.curve.primitive_nurbs_circle_add()
    bpy.context.object.name, bpy.context.object.body_moments.kind = "Wire", "WIRE"
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    sphere = bpy.context.object
    sphere.name, sphere.location, sphere.rotation_euler, sphere.scale = "Sphere", (7, 8, 9), (0.3, 0.2, 0.1), (1, 2, 3)
    broken = add(bpy.data.meshes.new("Empty"), "Empty Mesh")
    add(box_mesh(1, 1, 1), "Hidden").hide_render = True
    only(broken)


def test_documents_of_objects(kept, scene):
    scene_of_all_kinds()
    plain = batch_files.document()
    rich = batch_files.document(
        "--order", 2, "--surface-moments", "--pose", "--signature", "--about", "center", "--object", "Box"
    )
    other = batch_files.document("--frame", "object", "--about", "world", "--order", 1, "--object", "Box")
    for document in (plain, rich, other):
        document["blender"] = "4.5.0"
    failed = documents.failed_document("a\tb.stl", "It is gone", "missing", blender=None, frame="world")
    of_object_frame = documents.failed_document("a", "It is gone", "missing", blender=None, frame="object")
    assert (failed["frame"], of_object_frame["frame"]) == ("world", "object")
    kept("one.json", "".join(documents.to_json([plain])))
    kept("rich.json", "".join(documents.to_json([rich])))
    kept("several.json", "".join(documents.to_json([other, failed])))
    kept("objects.csv", "".join(documents.to_csv([plain, rich, other, failed])))
    page = "".join(to_html([plain, other, failed]))
    kept("objects.html", re.sub(r"(?s)<style>.*?</style>|<script>.*?</script>", "", page))
    kept("objects.txt", "\n".join(map(text_report.text, (plain, other, failed))))
    assert [*documents.to_json([])] == ["[]\n"]
    assert list(map(json.loads, documents.to_json_lines([plain, failed]))) == [plain, failed]


def test_documents_of_flat_shapes(kept, scene):
    add(flat_mesh(I_BEAM), "Beam", location=(1, 2, 3), rotation=(np.pi / 2, 0.0, 0.0))
    add(flat_mesh(square(0, 0, 2)), "Square")
    flat = batch_files.document("--flat", "--order", 2, "--signature")
    about = batch_files.document("--flat", "--order", 1, "--about", "origin", "--frame", "object")
    flat["blender"] = about["blender"] = "4.5.0"
    kept("flat.json", "".join(documents.to_json([flat, about])))
    kept("flat.csv", "".join(documents.to_csv([flat])))
    kept("flat.html", re.sub(r"(?s)<style>.*?</style>|<script>.*?</script>", "", "".join(to_html([flat]))))


def test_reports_of_stored_numbers(kept, scene):
    from body_moments.operators.write import section

    scene_of_all_kinds()
    objects = [obj for obj in bpy.data.objects if obj.name != "Hidden"]
    only(*objects)
    bpy.ops.object.body_moments_measure()
    caveat = finding("total_of_open_objects", objects=["Box"])
    texts = []
    for frame in ("WORLD", "OBJECT"):
        scene.body_moments.frame = frame
        texts.append(text_report.report_text(bpy.context, objects, {"Box"}, [caveat]))
    beam = add(flat_mesh(I_BEAM), "Beam", location=(1, 2, 3), rotation=(np.pi / 2, 0.0, 0.0))
    for obj in (
        beam,
        add(flat_mesh(square(0, 0, 2)), "Square"),
        add(flat_mesh(square(-2000, -1999.99, 4000)), "Large"),
    ):
        only(obj)
        bpy.ops.object.body_moments_measure_section()
        for outdated in (None, finding("stale_geometry")):
            texts.append(section.text(obj.name, section.stored(obj), outdated))
    kept("reports.txt", "\n".join(texts))


def picture(url):
    """The bytes of a thumbnail, and its pixels."""
    data = base64.b64decode(url.removeprefix("data:image/png;base64,"))
    start, end = data.index(b"IDAT") + 4, data.index(b"IEND") - 8
    rows = np.frombuffer(zlib.decompress(data[start:end]), np.uint8).reshape(SIZE, -1)
    return data, rows[:, 1:].reshape(SIZE, SIZE, 4)


def test_the_axes_of_a_thumbnail_cross_at_the_center_of_mass():
    """Where it is in the picture; a body that is a point fills the inner four fifths with a length of 1."""
    right, up = np.array([0.8, -0.6, 0.0]), np.array([0.36, 0.48, 0.8])
    point, middles = np.array([1.0, 2.0, 3.0]), []
    for offset in (np.zeros(3), 0.02 * right, 0.03 * up):
        _, pixels = picture(thumbnail(point[None], np.zeros((1, 3), int), point + offset, TURN))
        row, column = np.nonzero(pixels[..., 3])
        middles.append(((column.min() + column.max()) / 2.0, -(row.min() + row.max()) / 2.0))
    moved = np.subtract(middles[1:], middles[0])
    assert np.abs(moved - 0.8 * SIZE * np.diag([0.02, 0.03])).max() <= 1.0  # a pixel


def test_axes_that_reach_beyond_a_thumbnail_end_at_its_edges():
    right, up = np.array([0.8, -0.6, 0.0]), np.array([0.36, 0.48, 0.8])
    point, nothing = np.array([1.0, 2.0, 3.0]), np.zeros((1, 3), int)
    _, whole = picture(thumbnail(point[None], nothing, point, TURN))
    wide = np.pad(whole, ((2 * SIZE, 2 * SIZE), (2 * SIZE, 2 * SIZE), (0, 0)))
    for columns, rows in ((0, 60), (0, -60), (60, 0), (-60, 0), (50, -50), (200, 0)):
        moved = (columns * right + rows * up) / (0.8 * SIZE)
        _, pixels = picture(thumbnail(point[None], nothing, point + moved, TURN))
        assert (pixels == wide[2 * SIZE + rows :, 2 * SIZE - columns :][:SIZE, :SIZE]).all(), (columns, rows)


def test_a_triangle_in_a_thumbnail_is_the_darker_the_less_it_faces_the_light():
    view = np.array([[0.8, -0.6, 0.0], [0.36, 0.48, 0.8], [0.48, 0.64, -0.6]])  # right, up, away from the eye
    light, full = np.array([0.75, 0.75, -0.35]), np.array([205.0, 208.0, 214.0])
    for normal in ((0.6, 0.0, -0.8), (0.75, 0.75, -0.35)):  # the second one is of full light
        normal = np.array(normal) / np.linalg.norm(normal)
        first = np.cross(normal, (0.0, 1.0, 0.0))
        corners = np.array([np.zeros(3), first, np.cross(normal, first)]) @ view
        _, pixels = picture(thumbnail(corners, np.arange(3)[None], corners[1], TURN))
        shade = full * (0.35 + 0.65 * min(1.0, abs(normal @ light)))
        colors, counts = np.unique(pixels[pixels[..., 3] > 0], axis=0, return_counts=True)
        assert np.abs(colors[np.argmax(counts)] - np.array([*shade, 255.0])).max() <= 1.0


def test_a_thumbnail(kept):
    """Every second pixel as a letter of its color."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    box = np.array([part for a, b, c, d in quads for part in ((a, b, c), (a, c, d))])
    pages = []
    for triangles in (box, np.zeros((1, 3), int)):
        data, pixels = picture(thumbnail(corners, triangles, np.array([0.5, 1.0, 1.5]), TURN))
        pixels = pixels[::2, ::2]
        colors, place = np.unique(pixels.reshape(-1, 4), axis=0, return_inverse=True)
        letters = np.array([*".abcdefghi"])[place.reshape(pixels.shape[:2])]
        pages += [repr(data[:33]), repr(colors.tolist()), *("".join(row).rstrip(".") for row in letters)]
    kept("thumbnail.txt", "\n".join(pages))


def test_a_row_of_the_page_has_the_records_picture_or_the_box_of_its_inertia(scene):
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
    from body_moments.operators.write import section

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


def test_of_the_axes_of_a_plane_nothing_is_shown_that_single_precision_does_not_hold(scene):
    from body_moments.operators.write import section

    beam = add(flat_mesh(I_BEAM), "Beam")
    only(beam)
    bpy.ops.object.body_moments_measure_section()
    stored = section.stored(beam)
    for index, label in ((2, "normal"), (0, ", x"), (1, ", y")):
        for off, is_shown in ((0.9, False), (1.1, True)):
            axes = np.eye(3)
            axes[index - 1, index] = off * 2.5e-7
            plane = replace(stored.section.plane, axes=axes)
            text = section.text("Beam", replace(stored, section=replace(stored.section, plane=plane)))
            (line,) = (line for line in text.splitlines() if "normal (" in line)
            shown = line.partition(label + " (")[2].partition(")")[0].split(", ")
            assert (float(shown[index - 1]) != 0.0) == is_shown, line
