# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files opened by the command line: every format, its unit and axes, and broken files of all
kinds.
"""

import gzip
import json
import os
import struct
import zipfile
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")
import numpy as np
from body_moments.command.files import opening, suffixes
from body_moments.command.findings import NO_SHAPES
from body_moments.core.files import NOT_REGULAR
from body_moments.core.streams.stl import BY_WORD
from body_moments.core.verdict import FileError

from tests.blender import batch_files as files
from tests.blender.batch_files import codes, document, measured, reason, run, sentence
from tests.close import close
from tests.core import mesh_files

pytestmark = pytest.mark.usefixtures("registered")
needs_usd = pytest.mark.skipif(
    not bpy.app.usd.supported, reason="this Blender is built without USD"
)


@pytest.mark.parametrize(
    "suffix",
    [pytest.param(end, marks=needs_usd if "usd" in end else ()) for end in files.EXPORTERS],
)
def test_every_format_gives_the_box_that_was_saved(tmp_path, suffix):
    path = files.box_file(tmp_path / f"part{suffix}")
    found = document(path)
    (entry,) = found["objects"]
    assert found["file"] == path and found["errors"] == [] and found["schema"] == "body-moments/1"
    assert entry["type"] == "MESH" and entry["kind"] == "solid" and entry["method"] == "exact"
    assert entry["volume"] == pytest.approx(6.0, rel=1e-6)
    assert entry["area"] == pytest.approx(22.0, rel=1e-6)
    assert entry["mass"] == pytest.approx(6000.0, rel=1e-6)
    assert entry["center_of_mass"] == pytest.approx(files.CENTER, rel=1e-6)
    assert entry["principal_moments"] == pytest.approx([2500.0, 5000.0, 6500.0], rel=1e-5)
    assert entry["health"]["closed"] is True
    assert found["total"]["mass"] == entry["mass"]
    if suffix in (".blend", ".glb", ".gltf", ".fbx"):
        assert entry["name"] == files.BOX_NAME


@pytest.mark.parametrize(
    "name, text, center",
    [
        ("t.stl", files.stl_text(), (0.25, 0.5, 0.75)),
        ("t.ply", files.ply_text(), (0.25, 0.5, 0.75)),
        # There y is up, and the importer turns the object by a quarter: a float32 matrix.
        ("T.OBJ", files.obj_text(), (0.25, -0.75, 0.5)),
    ],
    ids=["stl", "ply", "obj"],
)
def test_a_file_written_by_hand_is_measured_as_blender_shows_it(tmp_path, name, text, center):
    entry = measured(files.write_text(tmp_path / name, text))
    assert entry["volume"] == pytest.approx(1.0, rel=1e-12)
    assert close(entry["center_of_mass"], center, rel=2e-7 if "OBJ" in name else 1e-12)


def contents():
    """Names, transform and geometry of the scene's one object."""
    (obj,) = bpy.context.scene.objects
    mesh = obj.data
    faces = [tuple(face.vertices) for face in mesh.polygons]
    edges = sorted(tuple(sorted(edge.vertices)) for edge in mesh.edges)
    values = sorted(layer.name for layer in mesh.attributes if layer.data_type == "FLOAT")
    points = [tuple(vertex.co) for vertex in mesh.vertices]
    return obj.name, mesh.name, obj.matrix_world.copy(), points, faces, edges, values


@pytest.mark.parametrize("name", ["a b.c.stl", "t.STL", "t.ply", "little.ply", "big.ply"])
def test_meshes_are_imported_as_by_blender(tmp_path, name):
    rng = np.random.default_rng(5)
    points = rng.normal(size=(60, 3)).astype(np.float32)
    faces = [
        sorted(rng.choice(60, count, replace=False).tolist()) for count in rng.integers(3, 7, 80)
    ]
    if name.endswith("ply"):
        order = {"t.ply": "", "little.ply": "<", "big.ply": ">"}[name]
        data = mesh_files.ply(points, faces, order, extra=True).replace(b"uchar red", b"uchar heat")
    else:
        part = points, np.unique([face[:3] for face in faces], axis=0)
        data = mesh_files.stl(part) if "a" in name else mesh_files.stl_text(part)
    (tmp_path / name).write_bytes(data)
    files.empty_scene()
    importer = bpy.ops.wm.ply_import if name.endswith("ply") else bpy.ops.wm.stl_import
    importer(filepath=str(tmp_path / name))
    truth = contents()
    opening.open_file(str(tmp_path / name))
    assert contents() == truth


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply"])
def test_the_unit_scale_is_for_files_without_a_unit(tmp_path, suffix):
    path = files.box_file(tmp_path / f"part{suffix}")
    meters, millimeters = measured(path), measured(path, "--unit-scale", "0.001")
    assert meters["volume"] == pytest.approx(6.0, rel=1e-6)
    assert "unit_assumed" in codes(meters)
    assert close(millimeters["volume"], 6e-9, rel=1e-6)
    assert close(millimeters["area"], 22e-6, rel=1e-6)
    assert close(millimeters["mass"], 6e-6, rel=1e-6)
    assert millimeters["center_of_mass"] == pytest.approx([0.01, 0.02, 0.03], rel=1e-6)
    assert close(millimeters["principal_moments"], [2.5e-12, 5e-12, 6.5e-12], rel=1e-5)
    assert codes(millimeters) == ["density_defaulted"]  # an STL file has none


@pytest.mark.parametrize("suffix", [".glb", ".blend"])
def test_a_file_with_a_unit_keeps_it_and_says_so(tmp_path, suffix):
    entry = measured(files.box_file(tmp_path / f"part{suffix}"), "--unit-scale", "0.001")
    assert entry["volume"] == pytest.approx(6.0, rel=1e-6)
    assert "options_unused" in codes(entry)


def test_a_blend_files_own_unit_scale_counts(tmp_path):
    files.empty_scene()
    files.add_box()
    bpy.context.scene.unit_settings.scale_length = 0.001
    entry = measured(files.save(tmp_path / "part.blend"))
    assert close(entry["volume"], 6e-9, rel=1e-6)
    assert entry["center_of_mass"] == pytest.approx([0.01, 0.02, 0.03], rel=1e-6)


def test_blend_is_measured_at_the_requested_frame(tmp_path):
    files.empty_scene()
    box = files.add_box()
    for frame, size in ((1, 1.0), (11, 3.0)):
        box.scale.x = size
        box.keyframe_insert("scale", frame=frame)
    bpy.context.scene.frame_set(1)
    path = files.save(tmp_path / "t.blend")
    volumes = [measured(*words, path)["volume"] for words in ((), ("--frame", 11))]
    assert volumes == pytest.approx([6.0, 18.0], rel=1e-6)


@needs_usd
def test_a_usd_stages_unit_counts(tmp_path):
    entry = measured(files.write_text(tmp_path / "t.usda", files.usda_text(0.01)))
    assert close(entry["volume"], 1e-6, rel=1e-6)
    assert entry["center_of_mass"] == pytest.approx([0.0025, 0.005, 0.0075], rel=1e-6)


def test_an_invisible_gltf_node_is_left_out_with_its_children(tmp_path):
    path = Path(files.box_file(tmp_path / "part.gltf"))
    found = json.loads(path.read_text(encoding="utf-8"))
    shown = found["nodes"][0] | {"name": "Shown"}
    found["nodes"] += [{"name": "Top", "children": [0]}, shown]
    found["scenes"][0]["nodes"] = [1, 2]
    found["nodes"][1]["extensions"] = {"KHR_node_visibility": {"visible": False}}
    found["extensionsUsed"] = ["KHR_node_visibility"]
    path.write_text(json.dumps(found), encoding="utf-8")
    told = document(path)
    assert [entry["name"] for entry in told["objects"]] == ["Shown"]
    reason_ = sentence("file_hides", cause="it is invisible")
    assert told["left_out"] == [{"name": files.BOX_NAME, "reason": reason_}]
    assert len(document(path, "--all")["objects"]) == 2


def test_startup_file_of_the_user_changes_nothing(tmp_path):
    path = files.box_file(tmp_path / "part.glb")
    startup = Path(bpy.utils.user_resource("CONFIG", path="startup.blend", create=False))
    assert not startup.exists()
    bpy.context.scene.unit_settings.scale_length = 0.01
    bpy.ops.wm.save_homefile()
    try:
        assert startup.exists() and measured(path)["volume"] == pytest.approx(6.0, rel=1e-6)
    finally:
        startup.unlink()


def test_several_files_give_documents_in_order(tmp_path):
    scaled = files.box_file(tmp_path / "scaled.stl")
    files.empty_scene()
    bpy.context.scene.unit_settings.scale_length = 0.01
    files.add_box("Other")
    blend = files.save(tmp_path / "other.blend")
    missing = str(tmp_path / "missing.stl")
    line = run(scaled, blend, missing, scaled)
    assert [found["file"] for found in line.documents] == [scaled, blend, missing, scaled]
    names = [[entry["name"] for entry in found["objects"]] for found in line.documents]
    assert names == [["scaled"], ["Other"], [], ["scaled"]]
    assert line.documents[0]["objects"] == line.documents[3]["objects"]
    assert line.errors == 1


def test_importer_of_a_disabled_addon_works(tmp_path):
    import addon_utils

    path = files.box_file(tmp_path / "part.glb")
    addon_utils.disable("io_scene_gltf2")
    assert measured(path)["volume"] == pytest.approx(6.0, rel=1e-6)


GARBAGE = bytes(range(256)) * 4


@pytest.mark.parametrize("suffix", list(files.EXPORTERS))
@pytest.mark.parametrize("data", [b"", b"hello world\n", GARBAGE], ids=["empty", "text", "noise"])
def test_file_with_a_wrong_suffix_is_an_error(tmp_path, suffix, data):
    (tmp_path / f"bad{suffix}").write_bytes(data)
    assert reason(tmp_path / f"bad{suffix}")


@pytest.mark.parametrize("suffix", [".blend", ".glb", ".gltf", ".ply", ".stl", ".fbx"])
def test_half_a_file_is_an_error(tmp_path, suffix):
    path = tmp_path / f"part{suffix}"
    files.box_file(path)
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    assert reason(path)


def test_a_text_stl_cut_short_is_not_measured_as_half_a_body(tmp_path):
    text = files.stl_text(faces=files.FACES[:2], end="facet normal 0 0 0\nouter loop\n")
    assert reason(files.write_text(tmp_path / "cut.stl", text)) == sentence(
        "stl_cut_short", end=BY_WORD
    )


def test_binary_stl_with_a_solid_header_is_binary(tmp_path):
    corners = [[files.CORNERS[i] for i in face] for face in files.FACES]
    facets = [struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in corners]
    path = tmp_path / "t.stl"
    path.write_bytes(b"solid binary".ljust(80) + struct.pack("<I", 4) + b"".join(facets))
    assert measured(path)["volume"] == pytest.approx(1.0)
    path.write_bytes(path.read_bytes()[:-1])
    assert reason(path) == sentence("stl_cut_short", end=BY_WORD)  # it says that it is text


@needs_usd
def test_usdz_checksums_are_verified(tmp_path):
    data = Path(files.box_file(tmp_path / "whole.usdz")).read_bytes()
    (stored,) = zipfile.ZipFile(tmp_path / "whole.usdz").infolist()
    begin = data.index(b"PXR-USDC")
    for place in range(begin, begin + stored.file_size, stored.file_size // 20):
        flipped = data[:place] + bytes([data[place] ^ 16]) + data[place + 1 :]
        (tmp_path / "flipped.usdz").write_bytes(flipped)
        assert "Bad CRC-32" in reason(tmp_path / "flipped.usdz")
    directory = data.index(b"PK\1\2")
    larger = struct.pack("<II", stored.file_size + 99, stored.file_size + 99)
    (tmp_path / "larger.usdz").write_bytes(data[: directory + 20] + larger + data[directory + 28 :])
    # Old Pythons use other words.
    assert any(
        words in reason(tmp_path / "larger.usdz")
        for words in ("Overlapped", "overlap", "Bad CRC-32")
    )
    assert close(measured(tmp_path / "whole.usdz")["volume"], 6.0, rel=1e-6)


def test_folders_and_devices_are_errors(tmp_path):
    (tmp_path / "folder.blend").mkdir()
    assert reason(tmp_path / "folder.blend") == sentence("file_unreadable", error=NOT_REGULAR)
    assert reason(tmp_path / "missing.obj") == sentence("file_missing")
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.blend")
        assert reason(tmp_path / "pipe.blend") == sentence("file_unreadable", error=NOT_REGULAR)


@pytest.mark.parametrize("name", ["part.prt", "part", "part.blend.zip"])
def test_a_kind_of_file_that_blender_does_not_import_is_an_error(tmp_path, name):
    assert ".stl" in reason(files.write_text(tmp_path / name, "x"))


@pytest.mark.parametrize("suffix", [".npy", ".npz", ".nrrd", ".nii", ".nii.gz"])
def test_arrays_that_are_none_are_errors(tmp_path, suffix):
    assert reason(files.write_text(tmp_path / f"scan{suffix}", "x"))


def test_scripts_inside_a_blend_file_do_not_run(tmp_path):
    files.empty_scene()
    box = files.add_box()
    sentinel = tmp_path / "it_ran"
    script = bpy.data.texts.new("startup.py")
    script.write(
        f"open({str(sentinel)!r}, 'w')\nimport bpy\nbpy.data.objects[0].scale = (9, 9, 9)\n"
    )
    script.use_module = True
    driver = box.driver_add("location", 0).driver
    driver.expression = f"len(open({str(sentinel)!r}, 'w').name)"
    path = files.save(tmp_path / "hostile.blend")
    sentinel.unlink(missing_ok=True)
    bpy.context.preferences.filepaths.use_scripts_auto_execute = True
    try:
        entry = measured(path)
    finally:
        bpy.context.preferences.filepaths.use_scripts_auto_execute = False
    assert not sentinel.exists()
    assert entry["volume"] == pytest.approx(6.0)


def test_missing_library_is_an_error_beside_other_records(tmp_path):
    library = tmp_path / "library.blend"
    files.box_file(library)
    files.empty_scene()
    files.add_box("Local")
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects = [files.BOX_NAME]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    path = files.save(tmp_path / "part.blend")
    assert document(path)["errors"] == []
    library.unlink()
    found = document(path)
    assert [entry["name"] for entry in found["objects"]] == ["Local"]
    (error,) = found["errors"]
    assert error["name"] is None and "library.blend" in error["reason"]


@needs_usd
def test_missing_usd_reference_is_an_error_beside_records(tmp_path, capfd):
    text = files.usda_text(1.0) + '\ndef Xform "A" (prepend references = @./gone.usdc@</X>) {}\n'
    text += 'def Xform "B" (payload = @./away.usd@) {}\n'
    text += 'def "C" (references = @./there.usda@</Nope>) {}\n'
    text = text.replace("(\n", "(\n    subLayers = [@./layer.usda@]\n", 1)
    files.write_text(tmp_path / "there.usda", files.usda_text(1.0))
    found = document(files.write_text(tmp_path / "t.usda", text))
    assert [entry["name"] for entry in found["objects"]] == ["Tetra"]
    names = [
        str(tmp_path / name)
        for name in ("away.usd", "gone.usdc", "layer.usda", "there.usda</Nope>")
    ]
    assert [error["name"] for error in found["errors"]] == [None]
    assert found["errors"][0]["reason"] == sentence("missing_references", names=names)
    assert "_ReportErrors" in capfd.readouterr().err  # USD's own message is there too.
    empty = "#usda 1.0\n(\n    subLayers = [@./layer.usda@]\n)\n"
    found = reason(files.write_text(tmp_path / "empty.usda", empty))
    assert found == sentence("missing_references", names=names[2:3])
    assert document(files.write_text(tmp_path / "whole.usda", files.usda_text(1.0)))["errors"] == []


@pytest.mark.parametrize("end", [".usda", ".glb"])
def test_a_file_with_empties_alone_is_an_error(tmp_path, end):
    if end == ".usda" and not bpy.app.usd.supported:
        pytest.skip("this Blender is built without USD")
    files.empty_scene()
    bpy.ops.object.empty_add()
    assert reason(files.save(tmp_path / f"part{end}")) == sentence(
        "nothing_measured", cause=NO_SHAPES
    )


@pytest.mark.parametrize("kind", ["MESH_CACHE", "MESH_SEQUENCE_CACHE"])
def test_a_cache_that_is_gone_is_an_error(tmp_path, kind):
    files.empty_scene()
    box = files.add_box()
    cache = box.modifiers.new("Cache", kind)
    if kind == "MESH_CACHE":
        cache.filepath = "//points.mdd"
    else:
        (tmp_path / "points.abc").write_bytes(b"x")
        bpy.ops.cachefile.open(filepath=str(tmp_path / "points.abc"))
        cache.cache_file = bpy.data.cache_files[0]
        (tmp_path / "points.abc").unlink()
    found = document(files.save(tmp_path / "part.blend"))
    assert len(found["objects"]) == 1
    (error,) = found["errors"]
    assert error["name"] is None and "points." in error["reason"]
    if kind == "MESH_SEQUENCE_CACHE":  # Each frame of a sequence has its own file.
        bpy.data.cache_files[0].is_sequence = True
        assert document(files.save(tmp_path / "part.blend"))["errors"] == []
        bpy.data.cache_files[0].is_sequence = False
    cache = bpy.context.scene.objects[0].modifiers[0]
    cache.show_viewport = False
    assert document(files.save(tmp_path / "part.blend"))["errors"] == []
    cache = bpy.context.scene.objects[0].modifiers[0]
    cache.show_viewport = True
    setattr(cache, *(("filepath", "") if kind == "MESH_CACHE" else ("cache_file", None)))
    assert document(files.save(tmp_path / "part.blend"))["errors"] == []


@pytest.mark.skipif(not Path("/proc/self/mem").exists(), reason="not on this system: /proc")
def test_a_file_that_cannot_be_read_is_an_error(tmp_path):
    """Address 0 of a process: a regular file of which nothing can be read."""
    for words in ((), ("--stream", "always")):
        (tmp_path / "part.stl").unlink(missing_ok=True)
        (tmp_path / "part.stl").symlink_to("/proc/self/mem")
        found = document(tmp_path / "part.stl", *words)
        assert found["objects"] == [] and found["status"] == "error"
        (error,) = found["errors"]
        assert error == {
            "name": None,
            "reason": sentence("file_unreadable", error="Input/output error"),
        }


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize(
    ("head", "version"),
    [
        (b"BLENDER-v999", "9.99"),
        (b"BLENDER_v999", "9.99"),
        (b"BLENDER-v249", "2.49"),
        (b"BLENDER-V405", "-"),
        (b"BLENDER17-01v9901", "99.1"),
        (b"BLENDER17-02v0502", "99.0"),
        (b"BLENDER-v250", None),
        (b"BLENDER17-01v0250", None),
        (b"BLENDER-v404", None),
        (b"BLENDER-x404", None),
        (b"blender-v999", None),
        (b"BLEND", None),
    ],
)
def test_file_of_an_unsupported_version_names_the_version(tmp_path, head, version, packed):
    data = head + b"REND" + bytes(40)
    (tmp_path / "part.blend").write_bytes(gzip.compress(data) if packed else data)
    found = document(tmp_path / "part.blend")
    (error,) = found["errors"]
    expected = sentence("file_version_unsupported", blender=bpy.app.version_string, version=version)
    assert (error["reason"] == expected) == (version is not None)
    assert found["status"] == ("error" if version is None else "unsupported_version")


def test_a_file_of_a_newer_blender_that_opens_has_a_warning(tmp_path):
    major, minor = bpy.app.version[:2]
    path = tmp_path / "part.blend"
    files.empty_scene()
    files.add_box()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=False)
    assert "file_newer_version" not in files.codes(measured(path))
    head = path.read_bytes()[:17]
    new = head.replace(b"v%d%02d" % (major, minor), b"v%d%02d" % (major, minor + 1))
    new = new.replace(b"v%02d%02d" % (major, minor), b"v%02d%02d" % (major, minor + 1))
    assert new != head
    path.write_bytes(new + path.read_bytes()[17:])
    found = files.values(measured(path), "file_newer_version")
    assert found == {"version": "{}.{}".format(major, minor + 1), "blender": bpy.app.version_string}


@pytest.mark.filterwarnings("ignore:Overlapped entries")  # by newer Pythons
@pytest.mark.parametrize("size", [162, 163])
def test_usdz_contents_may_not_exceed_the_file(tmp_path, size):
    """Two entries for the same bytes, with headers that take 162."""
    with zipfile.ZipFile(tmp_path / "whole.usdz", "w") as archive:
        archive.writestr("a.usda", bytes(size))
    data = (tmp_path / "whole.usdz").read_bytes()
    begin, end = data.index(b"PK\1\2"), data.index(b"PK\5\6")
    path = tmp_path / "part.usdz"
    last = data[end : end + 8] + struct.pack("<HHI", 2, 2, 2 * (end - begin)) + data[end + 16 :]
    path.write_bytes(data[:end] + data[begin:end] + last)
    assert path.stat().st_size == size + 162
    told = ""
    try:
        suffixes.check_file(str(path))
    except FileError as error:  # also by newer Pythons themselves, in other words
        told = str(error.finding)
    assert ("(overlapping entries)" in told) == (size > 162)
