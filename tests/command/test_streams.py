# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes in blocks on the command line: the numbers of an import, and what is said of what was not
looked for.
"""

import json

import numpy as np
import pytest
from body_moments.command.findings import NEEDS_BLEND
from body_moments.command.measure import bare
from body_moments.command.supervisor import processes
from body_moments.core.streams.stl import BY_COUNT, BY_WORD

from tests.blender.batch_files import codes, sentence
from tests.close import close
from tests.command.processes import script
from tests.command.running import run
from tests.core.bodies import inverted, soup, torus, without
from tests.core.mesh_files import ply, stl, stl_text, write_large_torus
from tests.records import valid

pytestmark = pytest.mark.usefixtures("scene")

MEMORY_MB = 300  # The limit of a child, with Blender in it.

FORMS = {"part.stl": stl, "part text.stl": stl_text, "part.ply": lambda part: ply(*part)}


def part(scale=0.1):
    points, triangles = torus(12, 9)
    return (points * scale + [1.0, 2.0, 3.0]).astype(np.float32), triangles


def written(tmp_path, name="part.stl", body=None):
    (tmp_path / name).write_bytes(FORMS[name](body or part()))
    return tmp_path / name


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "obj"])
@pytest.mark.parametrize("place", [(500_000.123, 4_649_776.456, 100.0), (0.1, 0.2, 0.3)])
def test_double_coordinates_are_not_rounded(tmp_path, form, place):
    """A box of 1 by 2 by 3, as photogrammetry places it."""
    corners = np.stack(np.meshgrid([0, 1], [0, 2], [0, 3], indexing="ij"), -1).reshape(-1, 3)
    corners = corners + place
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    path = tmp_path / "box.ply"
    if form == "obj":
        path = tmp_path / "box.obj"
        lines = ["v {!r} {!r} {!r}".format(x, z, -y) for x, y, z in corners.tolist()]
        lines += ["f " + " ".join(str(1 + i) for i in quad) for quad in quads]
        path.write_text("\n".join(lines) + "\n")
    else:
        head = "ply\nformat {} 1.0\nelement vertex 8\n".format(form)
        head += "".join("property double {}\n".format(axis) for axis in "xyz")
        head += "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
        faces = np.array([(4, quad) for quad in quads], "u1, (4,)<i4")
        if form == "ascii":
            rows = [*corners.tolist(), *((4, *quad) for quad in quads)]
            body = "".join(" ".join(map(repr, row)) + "\n" for row in rows).encode()
        else:
            body = corners.astype("<f8").tobytes() + faces.tobytes()
        path.write_bytes(head.encode() + body)
    center = np.array(place) + [0.5, 1.0, 1.5]
    wordings = [["--stream", "never"], *([] if form == "obj" else [["--stream", "always"]])]
    for words in wordings:
        (entry,) = run(tmp_path, path, "--density", "1", *words)[1]["objects"]
        assert close(entry["volume"], 6.0, 1e-8) and entry["method"] == "exact"
        assert np.abs(entry["center_of_mass"] - center).max() < 1e-8
    if form != "obj":  # As an object of Blender it stands where float32 does not move its points.
        (entry,) = run(tmp_path, path, "--density", "1", "--pose")[1]["objects"]
        assert close(entry["volume"], 6.0, 1e-6)
        assert np.abs(entry["center_of_mass"] - center).max() < 1e-6


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("kind", ["solid", "shell"])
def test_streamed_record_agrees_with_an_import(tmp_path, name, kind):
    words = [
        written(tmp_path, name),
        "--density",
        "7800",
        "--unit-scale",
        "0.5",
        "--kind",
        kind,
        "--thickness",
        "0.002",
    ]
    words += ["--order", "6", "--surface-moments", "--about", "1,2,3"]
    code, streamed = run(tmp_path, *words, "--stream", "always")
    assert code == 0 and streamed["status"] == "ok"
    _, imported = run(tmp_path, *words)
    (one,), (other,) = streamed["objects"], imported["objects"]
    assert (one["name"], one["type"], one["kind"], one["method"]) == tuple(
        other[key] for key in ("name", "type", "kind", "method")
    )
    for key in ("mass", "volume", "area", "density", "center_of_mass"):
        assert close(one[key], other[key], rel=1e-12), key
    apart = np.abs(np.subtract(one["inertia"], other["inertia"])).max()
    assert apart <= 1e-12 * np.trace(other["inertia"])
    for domain in ("volume", "surface", "mass"):
        for power, value in one["moments"][domain].items():
            bounds = [entry["moments"]["error"][domain][power] for entry in (one, other)]
            assert abs(value - other["moments"][domain][power]) <= sum(bounds), (domain, power)
    assert "mesh_streamed" in codes(one) and "mesh_streamed" not in codes(other)
    assert one["health"]["closed"] is True and one["health"]["components"] is None
    assert other["health"]["components"] == 1


def test_open_and_inside_out_meshes_are_said_to_be(tmp_path):
    _, document = run(tmp_path, written(tmp_path, body=without(part(), 5)), "--stream", "always")
    (entry,) = document["objects"]
    assert (
        entry["method"] == "open"
        and not entry["health"]["closed"]
        and "streamed_open" in codes(entry)
    )
    _, document = run(
        tmp_path, written(tmp_path, body=inverted(part())), "--stream", "always", "--order", "3"
    )
    (entry,) = document["objects"]
    assert entry["method"] == "reoriented" and "inverted_components" in codes(entry)
    assert close(
        entry["volume"], run(tmp_path, written(tmp_path))[1]["objects"][0]["volume"], rel=1e-12
    )
    assert min(entry["moments"]["volume"][key] for key in ("0,0,0", "2,0,0", "0,2,0")) > 0.0


def test_huge_file_is_read_in_blocks_unless_switched_off(tmp_path, monkeypatch):
    path = written(tmp_path)
    needed = len(part()[1]) * bare.BYTES_PER_FACE
    for memory, stream, expected in (
        (2 * needed, "auto", False),
        (needed // 2, "auto", True),
        (needed // 2, "never", False),
        (2 * needed, "always", True),
        (None, "auto", False),
    ):
        monkeypatch.setattr(processes, "memory_share", lambda count=1, memory=memory: memory)
        _, document = run(tmp_path, path, "--stream", stream)
        assert ("mesh_streamed" in codes(document["objects"][0])) == expected, (memory, stream)


def test_the_usual_findings_are_there(tmp_path):
    _, document = run(
        tmp_path,
        written(tmp_path),
        "--stream",
        "always",
        "--pose",
        "--signature",
        "--spacing",
        "1,1,1",
    )
    (entry,) = document["objects"]
    assert {"unit_assumed", "density_defaulted", "options_unused"} <= {*codes(entry)}
    assert entry["pose"] is None and entry["signature"] is None and entry["density"] == 1000.0
    _, document = run(tmp_path, written(tmp_path), "--stream", "always", "--mass", "7")
    assert document["objects"][0]["mass"] == pytest.approx(7.0, rel=1e-14)
    assert "density_defaulted" not in codes(document["objects"][0])
    code, document = run(tmp_path, written(tmp_path), "--stream", "always", "--object", "other")
    assert (
        code == 1
        and [error["name"] for error in document["errors"]] == ["other"]
        and not document["objects"]
    )


@pytest.mark.parametrize(
    "words, code",
    [
        (("--kind", "shell", "--thickness", "1", "--wall", "inward"), "stream_options"),
        (("--polynomial", "1 + x"), "stream_options"),
        (("--kind", "wire"), "stream_options"),
        (("--overlap", "union"), "stream_options"),
        (("--write",), "results_not_stored"),
    ],
)
def test_options_that_need_the_mesh_are_refused(tmp_path, words, code):
    exit_code, document = run(tmp_path, written(tmp_path), "--stream", "always", *words)
    options = (
        {"options": [words[-2] if "--wall" not in words else "--wall"]}
        if code == "stream_options"
        else {"cause": NEEDS_BLEND}
    )
    assert exit_code == 1 and [error["reason"] for error in document["errors"]] == [
        sentence(code, **options)
    ]


def test_damaged_and_empty_files_are_errors(tmp_path):
    path = written(tmp_path)
    whole = path.read_bytes()
    points, triangles = soup(part())
    points[7] = np.nan
    place = {"code": "at_row", "values": {"element": "triangle", "row": 2}}
    for data, reason in (
        (whole[:-1], sentence("stl_cut_short", end=BY_COUNT)),
        (b"", sentence("file_unreadable", error="it is empty")),
        (stl((points, triangles)), sentence("non_finite_coordinates", count=3, place=place)),
        (stl((points[:0], triangles[:0])), sentence("file_without_objects", content="faces")),
        (stl_text(part())[:-40], sentence("stl_cut_short", end=BY_WORD)),
    ):
        path.write_bytes(data)
        code, document = run(tmp_path, path, "--stream", "always")
        assert code == 1 and [error["reason"] for error in document["errors"]] == [reason]
    code, document = run(tmp_path, tmp_path / "missing.stl", "--stream", "always")
    assert code == 1 and document["status"] == "missing"
    flat = written(
        tmp_path,
        body=(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 1]])),
    )
    assert run(tmp_path, flat, "--stream", "always")[0] == 1


def test_five_million_triangles_are_measured_in_little_memory(tmp_path):
    """By a child, which would be ended if it took more."""
    path, out = tmp_path / "large.stl", tmp_path / "out.json"
    volume = write_large_torus(path, 2500, 1000)
    words = [
        "measure",
        "--memory-mb",
        str(MEMORY_MB),
        "--jobs",
        "1",
        "--density",
        "1",
        "--output",
        out,
        path,
    ]
    ended = script(*words)
    document = valid(json.loads(out.read_text(encoding="utf-8")))
    assert ended.returncode == 0 and document["status"] == "ok", ended.stderr
    (entry,) = document["objects"]
    assert {
        one["values"]["count"] for one in entry["findings"] if one["code"] == "mesh_streamed"
    } == {5_000_000}
    assert entry["health"]["closed"] and entry["method"] == "exact"
    assert abs(entry["volume"] - volume) <= entry["error_bound"]["volume"] + 1e-12 * volume
    assert entry["error_bound"]["volume"] < 1e-10 * volume
