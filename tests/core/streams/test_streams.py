# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments and closedness of meshes read in blocks, compared with meshes in memory."""

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.streams import measure_stream, open_mesh_file, ply_rows
from body_moments.core.streams import stl as stl_module

from tests.close import close
from tests.core.bodies import (
    box,
    inverted,
    joined,
    ring,
    rotation,
    soup,
    sphere,
    torus,
    with_flipped,
    without,
)
from tests.core.findings import refused
from tests.core.mesh_files import ply, stl, stl_text


@pytest.fixture
def small_blocks(monkeypatch):
    """So that a small file is many blocks."""
    monkeypatch.setattr(stl_module, "TRIANGLES_PER_BLOCK", 15)
    monkeypatch.setattr(stl_module, "TEXT_PER_BLOCK", 700)
    monkeypatch.setattr(stl_module, "SAMPLES", 3)
    monkeypatch.setattr(ply_rows, "BYTES_PER_BLOCK", 301)
    monkeypatch.setattr(ply_rows, "SINGLE_ROWS", 5)


def moved(part, scale=0.3, offset=(5.0, -2.0, 9.0)):
    """Turned, scaled and moved, as float32."""
    points = part[0] @ rotation(4).T * scale + offset
    return points.astype(np.float32), part[1]


def quads_and_triangles(part):
    """Every other pair of triangles that share an edge as a quad: faces of two lengths, in turn."""
    points, quads = part
    faces = []
    for number, quad in enumerate(quads.tolist()):
        faces += [quad] if number % 3 else [quad[:3], [quad[0], *quad[2:]]]
    return points, faces


def measured(tmp_path, name, data, *args, **options):
    (tmp_path / name).write_bytes(data)
    return measure_stream(open_mesh_file(tmp_path / name), *args, **options)


def in_memory(part, order, about):
    return polyhedron_moments(
        Surface(*part), order, area_order=order, about=about, exact=True, allow_open=True
    )


def same(found, truth):
    for one, other in zip((found.volume, found.area), truth):
        bound = one.rounding_error + other.rounding_error
        assert (np.abs(one.raw - other.raw) <= bound).all()
        assert (bound <= 1e-9 * np.abs(other.raw).max()).all()  # a bound that says something
        assert (one.input_error >= 0.0).all()


FORMS = {
    "binary.stl": stl,
    "text.stl": stl_text,
    "little.ply": lambda part: ply(*part),
    "big.ply": lambda part: ply(*part, order=">"),
    "text.ply": lambda part: ply(*part, order=""),
    "double.ply": lambda part: ply(*part, kind="f8", extra=True),
    "extra.ply": lambda part: ply(*part, order=">", extra=True),
    "double text.ply": lambda part: ply(*part, order="", kind="f8"),
    "extra text.ply": lambda part: ply(*part, order="", extra=True),
}


@pytest.mark.parametrize("order", [3, 9])
@pytest.mark.parametrize("name", FORMS)
def test_streamed_moments_match_moments_in_memory(tmp_path, small_blocks, name, order):
    part = moved(joined(torus(9, 7), sphere(1)))
    found = measured(tmp_path, name, FORMS[name](part), order, order)
    assert found.closed and found.face_count == len(part[1])
    truth = in_memory(part, order, found.volume.about)
    same(found, truth)
    for one, other in zip((found.volume, found.area), truth):
        assert (one.rounding_error <= 8.0 * other.rounding_error).all()


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize(
    "part, closed",
    [
        (inverted(torus(9, 7)), True),
        (without(torus(9, 7), 7), False),
        (with_flipped(torus(9, 7), 7), False),
        (without(box(), 0, 1, 2, 3), False),  # a tube, whose normals add up to nothing
    ],
)
def test_open_streamed_mesh_is_detected(tmp_path, small_blocks, name, part, closed):
    part = moved(part)
    found = measured(tmp_path, name, FORMS[name](part), 3)
    assert found.closed == closed
    if closed:
        assert close(
            found.volume.total, -in_memory(moved(torus(9, 7)), 3, (0, 0, 0))[0].total, rel=1e-6
        )


def test_minus_zero_is_zero(tmp_path):
    points, triangles = soup(box((-1, 0, 0), (0, 1, 1)))
    points[::2] = np.where(points[::2] == 0.0, -0.0, points[::2])
    assert measured(tmp_path, "a.stl", stl((points, triangles))).closed
    points[0] += 1e-7
    assert not measured(tmp_path, "a.stl", stl((points, triangles))).closed


@pytest.mark.parametrize("order", ["<", ">", ""])
@pytest.mark.parametrize("extra", [False, True])
def test_faces_of_any_number_of_sides(tmp_path, small_blocks, order, extra):
    points, faces = quads_and_triangles(ring(30, 16))
    points = points.astype(np.float32)
    found = measured(tmp_path, "a.ply", ply(points, faces, order, extra=extra), 4, 4)
    quads = [face for face in faces if len(face) == 4]
    truth = polyhedron_moments(
        Surface(points, np.array([face for face in faces if len(face) == 3]), np.array(quads)),
        4,
        area_order=4,
        about=found.volume.about,
    )
    assert found.closed and found.face_count == len(faces)
    same(found, truth)
    prism = np.array(
        [[x, y, z] for z in (0, 1) for x, y in ((0, 0), (2, 0), (3, 1), (2, 2), (0, 2))], float
    )
    sides = [[k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k] for k in range(5)]
    found = measured(
        tmp_path,
        "b.ply",
        ply(prism, [[1, 2], [4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *sides, [1, 2]], order),
    )
    assert found.closed and close(
        [found.volume.total, found.area.total], [5.0, 16.0 + 2.0**1.5 - 0.0], rel=1e-12
    )


@pytest.mark.parametrize("place", [0.0, 1e9, -1e9])
def test_body_far_beyond_its_first_faces_is_read_again(tmp_path, small_blocks, place):
    """However far from the world's origin, on either side of the first faces."""
    points, triangles = joined(sphere(2), box((1e9, 0, 0), (1e9 + 1e6, 1e6, 1e6)))
    points[:, 0] += place
    triangles = np.roll(triangles, 40, axis=0)  # no sample is of the box
    for way in (1.0, -1.0):
        part = (points * way).astype(np.float32), triangles
        low, high = part[0].min(axis=0), part[0].max(axis=0)
        for data in (stl(part), stl_text(part)):
            seen = []
            found = measured(tmp_path, "a.stl", data, 20, progress=seen.append)
            assert found.closed and close(
                found.volume.about[:1], (low / 2.0 + high / 2.0)[:1], rel=1e-6
            )
            assert found.face_count == len(triangles) < sum(seen)


@pytest.mark.parametrize("order", ["<", ">", ""])
def test_truncated_or_damaged_ply_is_refused(tmp_path, small_blocks, order):
    part = moved(sphere(1))
    whole = ply(*part, order, extra=True)
    body = len(whole) - len(ply(*part, order, extra=True).partition(b"end_header\n")[2])
    for end in (0, 3, 30, body - 5, *range(body, len(whole) - (1 if order else 3), 41)):
        with refused("file_damaged", "file_unrecognized", "line_misread"):
            measured(tmp_path, "a.ply", whole[:end])
    for wrong in (-1, len(part[0])):
        faces = part[1].copy()
        faces[5, 1] = wrong
        with refused("file_damaged", "file_unrecognized", "line_misread"):
            measured(tmp_path, "a.ply", ply(part[0], faces, order))
    with refused("file_without_objects"):
        measured(
            tmp_path,
            "a.ply",
            b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
        )


@pytest.mark.parametrize("cut", [1, 10, 49, 50, 500])
def test_truncated_stl_is_refused(tmp_path, small_blocks, cut):
    part = moved(sphere(1))
    with refused("stl_cut_short"):
        measured(tmp_path, "a.stl", stl(part)[:-cut])
    text = stl_text(part)
    with refused("stl_cut_short", "line_misread"):
        measured(tmp_path, "a.stl", text[: -cut - 15])
    second = text.replace(b"part", b"normal part")
    for more in (second[: -cut - 15], second[: second.index(b"endfacet") - cut // 10]):
        with refused("stl_cut_short", "line_misread"):  # though the first of two solids has its end
            measured(tmp_path, "a.stl", text + more)
    assert measured(tmp_path, "a.stl", text + second).face_count == 2 * len(part[1])
    for other in (text.upper().replace(b"\n", b"\r\n"), text.title()):
        assert measured(tmp_path, "a.stl", other).closed


def test_wrong_word_in_the_last_facet_is_refused(tmp_path, small_blocks):
    text = stl_text(moved(sphere(1)))
    for word in (b"normal", b"vertex", b"endloop", b"."):
        at = text.rindex(word)
        with refused("line_misread"):
            measured(tmp_path, "a.stl", text[:at] + b"_" + text[at + 1 :])


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_nonfinite_numbers_are_refused_with_count_and_place(tmp_path, small_blocks, name, bad):
    points, triangles = soup(moved(sphere(1)))
    points[3 * 20] = bad
    points[3 * 25, 1] = bad
    if "text" in name:
        with refused("line_misread"):
            measured(tmp_path, name, FORMS[name]((points, triangles)))
        return
    kind, first = ("triangle", 20) if name.endswith("stl") else ("vertex", 60)
    place = {"code": "at_row", "values": {"element": kind, "row": first}}
    with refused("non_finite_coordinates", count=4, place=place):
        measured(tmp_path, name, FORMS[name]((points, triangles)))


def test_signaling_nans_beside_doubles_are_refused(tmp_path):
    row = np.dtype([("x", "<u4"), ("y", "<f8"), ("z", "<f4")])
    table = np.zeros(4, row)
    table["x"][2] = 0x7FA00000
    head = VERTICES.replace("double x", "float x").replace("double z", "float z") + FACES
    whole = (
        b"ply\nformat binary_little_endian 1.0\n"
        + head.encode()
        + b"end_header\n"
        + table.tobytes()
    )
    faces = np.array([(3, (0, 2, 1))] * 4, np.dtype([("n", "u1"), ("corners", "<i4", 3)]))
    with refused("non_finite_coordinates", count=1):
        measured(tmp_path, "a.ply", whole + faces.tobytes())


def test_concave_polygons_are_cut_into_their_own_triangles(tmp_path):
    """A prism over an arrow: a fan of triangles would count what is outside of the arrow, too."""
    arrow = np.array([[0, 0], [2, 1], [0, 2], [0.5, 1.5], [0.5, 0.5]])
    points = np.concatenate([np.insert(arrow, 2, z, axis=1) for z in (0.0, 3.0)])
    faces = [
        [4, 3, 2, 1, 0],
        [5, 6, 7, 8, 9],
        *([i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5] for i in range(5)),
    ]
    found = measured(tmp_path, "a.ply", ply(points, faces))
    sides = np.linalg.norm(arrow - np.roll(arrow, 1, axis=0), axis=1).sum()
    assert found.volume.total == pytest.approx(3.0 * 1.25, rel=1e-14)
    assert found.area.total == pytest.approx(2.0 * 1.25 + 3.0 * sides, rel=1e-14)


@pytest.mark.parametrize("name", FORMS)
def test_face_count_is_known_or_estimated_before_reading(tmp_path, name):
    part = moved(sphere(2))
    (tmp_path / name).write_bytes(FORMS[name](part))
    share = open_mesh_file(tmp_path / name).face_count / len(part[1])
    assert share == 1.0 or name == "text.stl" and 0.5 < share < 2.0


def ply_text(elements, rows):
    return "ply\nformat ascii 1.0\n{}end_header\n{}".format(elements, rows).encode()


VERTICES = "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
FACES = "element face 4\nproperty list uchar int vertex_indices\n"
TETRAHEDRON = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"


def test_ply_without_vertices_or_with_late_indices_is_refused(tmp_path):
    with refused("file_unrecognized"):
        measured(tmp_path, "a.ply", ply_text(FACES, TETRAHEDRON))
    with refused("line_misread"):
        measured(
            tmp_path,
            "a.ply",
            ply_text(VERTICES + FACES, TETRAHEDRON.replace("3 1 2 3", "3 1.5 2 3")),
        )


def test_a_header_has_a_million_bytes_at_most(tmp_path):
    whole = ply_text(VERTICES + FACES, TETRAHEDRON)
    length = whole.index(b"end_header\n") + len(b"end_header\n")
    for spare, is_read in ((0, True), (1, False)):
        comment = b"comment " + b"x" * (2**20 - length - 9 + spare) + b"\n"
        data = whole.replace(b"element vertex", comment + b"element vertex")
        assert data.index(b"end_header\n") + len(b"end_header\n") == 2**20 + spare
        if is_read:
            assert measured(tmp_path, "a.ply", data).closed
        else:
            with refused("file_unrecognized", format="PLY"):
                measured(tmp_path, "a.ply", data)


def test_elements_without_properties_take_nothing(tmp_path):
    empty = "element nothing 1000000000000\n"
    assert measured(tmp_path, "a.ply", ply_text(empty + VERTICES + FACES, TETRAHEDRON)).closed
    for order in ("<", ">"):
        whole = ply(*moved(sphere(0)), order)
        assert measured(
            tmp_path, "a.ply", whole.replace(b"element face", empty.encode() + b"element face")
        ).closed


@pytest.mark.parametrize("order", ["<", ">"])
def test_rows_with_empty_lists_take_only_their_counts(tmp_path, order):
    whole = ply(*moved(sphere(0)), order)
    head, end, body = whole.partition(b"end_header\n")
    empty = b"element edge 5000\nproperty list uchar double ends\n"
    assert measured(tmp_path, "a.ply", head + empty + end + body + bytes(5000)).closed
    first = head.index(b"element vertex")
    before = head[:first] + empty + head[first:] + end + bytes(5000) + body
    assert measured(tmp_path, "a.ply", before).closed
    with refused("file_damaged"):
        measured(
            tmp_path, "a.ply", head + empty.replace(b"5000", b"50000") + end + body + bytes(5000)
        )


@pytest.mark.parametrize("order", [3, 4])
def test_coordinates_beyond_float32(tmp_path, order):
    points, faces = box()
    found = measured(tmp_path, "a.ply", ply(points * 1e39, faces, kind="f8"), order)
    assert found.closed and close(
        found.volume.total / 1e117, in_memory((points, faces), 3, None)[0].total, rel=1e-12
    )


@pytest.mark.parametrize("size", [1e-13, 6e12])
def test_a_body_of_any_size_has_moments_of_twentieth_order(tmp_path, size):
    """Moments are computed at the body's own scale; in meters they would under- or overflow on the
    way.
    """
    points, faces = box((-1, -1, -1), (1, 1, 1))
    found = measured(tmp_path, "a.ply", ply(points * size, faces, kind="f8"), 20)
    for powers in ((0, 0, 0), (20, 0, 0), (4, 6, 10)):
        truth = np.prod([2.0 / (power + 1.0) for power in powers]) * size ** (sum(powers) + 3.0)
        assert close(found.volume[powers], truth, rel=1e-12)


def test_moments_beyond_all_numbers_are_refused(tmp_path):
    points, faces = box()
    with refused("moments_overflow"):
        measured(tmp_path, "a.ply", ply(points * 1e120, faces, kind="f8"))


@pytest.mark.parametrize("order", [3, 5, 20])
def test_collapsed_body_has_no_volume(tmp_path, order):
    found = measured(
        tmp_path, "a.stl", stl((np.full((3, 3), 0.1), np.array([[0, 1, 2]]))), order, order
    )
    assert found.volume.total == 0.0 == found.area.total


def test_text_without_facets_is_refused(tmp_path):
    with refused("stl_cut_short"):
        measured(tmp_path, "a.stl", b"solid" + bytes(100_000))


def header(*lines, start="ply\nformat ascii 1.0"):
    return "\n".join([start, *lines, "end_header", ""]).encode()


POINTS = "element vertex 4", "property float x", "property float y", "property float z"


@pytest.mark.parametrize(
    "data",
    [
        header(*POINTS, start="plx\nformat ascii 1.0"),
        header(*POINTS)[:-12],
        header(*POINTS, start="ply\nformat text 1.0"),
        header(*POINTS[:-1], FACES[:-1]),
        header("property float x", *POINTS, FACES[:-1]),
        header(*POINTS[:-1], "property real z", FACES[:-1]),
        header(*POINTS, FACES[:-1].replace("4", "-4")),
        header(*POINTS, FACES[:-1].replace("4", "four")),
        header(*POINTS, "element face", FACES.splitlines()[1]),
    ],
)
def test_senseless_header_is_refused(tmp_path, data):
    with refused("file_unrecognized", format="PLY"):
        measured(tmp_path, "a.ply", data + TETRAHEDRON.encode())


@pytest.mark.parametrize(
    "old, new, error",
    [
        ("vertex 4", "vertex 4000000000000", "vertex, 4000000000000 rows"),
        ("face 4", "face 40", "face, 40 rows"),
    ],
)
def test_damage_in_a_ply_is_named(tmp_path, old, new, error):
    whole = ply_text(VERTICES + FACES, TETRAHEDRON).decode()
    assert whole.count(old) == 1
    values = {"kind": "table of numbers", "error": error}
    cause = {"code": "damage_incomplete", "values": values}
    with refused("file_damaged", file="a.ply", cause=cause):
        measured(tmp_path, "a.ply", whole.replace(old, new).encode("latin-1"))


def test_files_of_other_types_are_refused(tmp_path):
    (tmp_path / "a.obj").write_bytes(b"")
    with refused("file_type", suffixes=".stl .ply"):
        open_mesh_file(tmp_path / "a.obj")
    with refused("file_without_objects", content="faces"):
        measured(tmp_path, "a.stl", stl((np.zeros((0, 3)), np.zeros((0, 3), int))))
    with refused("file_without_objects", content="faces"):
        measured(tmp_path, "a.ply", header(*POINTS) + b"0 0 0\n" * 4)
    with refused("file_without_objects", content="faces"):  # one number is no list of vertices
        numbers = header(*POINTS, "element face 1", "property int vertex_indices")
        measured(tmp_path, "a.ply", numbers + b"0 0 0\n" * 4 + b"0\n")
    (tmp_path / "a.stl").rename(tmp_path / "b.STL")
    assert open_mesh_file(str(tmp_path / "b.STL")).face_count == 0
