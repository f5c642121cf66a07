# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--flat: records, signatures and Fourier transforms of flat shapes, and `similar` over them."""

import json
from fractions import Fraction

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.command.files.output import is_result
from body_moments.core.shape.library import read_library

from tests.blender.batch_files import add_box, document
from tests.blender.flat_objects import sheet, text
from tests.close import close
from tests.command.running import ask

pytestmark = pytest.mark.usefixtures("scene")

RECTANGLE = [(0, 0), (3, 0), (3, 2), (0, 2)]


def shape(*words):
    found = document("--flat", *words)
    assert found["errors"] == [] and found["objects"] == []
    (entry,) = found["flat"]
    return entry


def test_a_flat_shape_has_a_record_of_its_own_beside_the_bodies():
    box = add_box()
    sheet(RECTANGLE, "Sheet", location=(1, 2, 3), rotation=(0, 0, np.pi / 2))
    text("R", "Letter")
    found = document("--flat")
    assert [entry["name"] for entry in found["objects"]] == [box.name]
    assert [entry["name"] for entry in found["flat"]] == ["Letter", "Sheet"]
    assert close(found["total"]["volume"], 6.0, rel=1e-6)
    entry = found["flat"][1]
    assert close(entry["area"], 6.0, rel=1e-6)
    assert np.abs(np.array(entry["centroid"]) - (0.0, 3.5, 3.0)).max() < 1e-6
    assert np.abs(np.array(entry["plane"]["x"]) - (0, 1, 0)).max() < 1e-6
    assert np.abs(np.array(entry["plane"]["normal"]) - (0, 0, 1)).max() < 1e-6
    assert close(entry["second_moments"]["xx"], 2 * 27 / 12, rel=1e-6)
    own = document("--flat", "--frame", "object")["flat"][1]
    assert np.abs(np.array(own["centroid"]) - (1.5, 1.0, 0.0)).max() < 1e-6
    assert np.abs(np.array(own["plane"]["x"]) - (1, 0, 0)).max() < 1e-6


@pytest.mark.parametrize(
    "words, corner",
    [
        ((), (5, 6)),
        (("--frame", "object"), (0, 0)),
        (("--about", "origin"), (0, 0)),
        (("--about", "center"), (-1.5, -1.0)),
        (("--about", "5,6,100"), (0, 0)),
        (("--about", "world", "--frame", "object"), (5, 6)),
    ],
)
def test_area_moments_about_a_point_are_within_bounds(words, corner):
    sheet(RECTANGLE, location=(5, 6, 7))
    entry = shape("--order", "5", *words)
    moments = entry["moments"]
    assert len(moments["area"]) == 21 and {one["name"] for one in entry["invariants"]} >= {
        "φ7",
        "c40 c12⁴",
    }
    for key, value in moments["area"].items():
        p, q = map(int, key.split(","))
        x, y = (
            ((low + side) ** (n + 1) - low ** (n + 1)) / (n + 1)
            for low, side, n in zip(corner, (3.0, 2.0), (p, q))
        )
        bound = moments["error"]["area"][key] + moments["input"]["area"][key]
        assert abs(value - x * y) <= bound + 1e-14 * abs(x * y)
        assert moments["error"]["area"][key] <= 1e-11 * (np.abs(corner).max() + 3.0) ** (p + q + 2)


def test_library_finds_letters_and_tells_mirrored_ones_apart(tmp_path):
    text("R", "R")
    text("R", "Large", location=(4, 5, 6), rotation=(1, 2, 3), scale=(3, 3, 3), resolution=4)
    text("R", "Mirrored", scale=(-1, 1, 1))
    text("k", "k")
    box = add_box()
    found = document("--flat", "--signature")
    assert all(entry["signature"]["dimension"] == 2 for entry in found["flat"])
    path = tmp_path / "letters.jsonl"
    path.write_text(json.dumps(found) + "\n")
    entries, missing = read_library(path)
    assert not missing and [entry.signature.dimension for entry in entries] == [3, 2, 2, 2, 2]
    code, answer = ask(tmp_path, path, "--to", "R", "--any-size")
    rows = answer.splitlines()[1:]
    assert code == 0 and rows[0].endswith("Large") and "scaled copy" in rows[0]
    assert "mirror image" in next(row for row in rows if row.endswith("Mirrored"))
    code, answer = ask(tmp_path, path, "--to", "R", "--any-hand")
    assert answer.splitlines()[1].endswith("Mirrored")
    assert "different" in next(row for row in rows if row.endswith(box.name))


@pytest.mark.parametrize("frame", ["world", "object"])
def test_the_transform_of_a_flat_shape_is_in_its_plane(tmp_path, frame):
    sheet(RECTANGLE, location=(5, 6, 7))
    q = np.random.default_rng(0).normal(size=(50, 2)) * np.logspace(-9, 1.5, 50)[:, None]
    np.save(tmp_path / "q.npy", q)
    out = tmp_path / "out.npz"
    shape("--fourier", out, "--q", tmp_path / "q.npy", "--frame", frame)
    low = np.array([5.0, 6.0] if frame == "world" else [0.0, 0.0])
    true = np.prod([3.0, 2.0] * np.sinc(q * [3.0, 2.0] / (2 * np.pi)), axis=1) * np.exp(
        -1j * q @ (low + [1.5, 1.0])
    )
    with np.load(out) as found:
        assert (np.abs(found["F"] - true) <= found["error"] + 1e-14).all() and found[
            "error"
        ].max() < 1e-12
        assert np.abs(found["axes"] - np.eye(3)[:2]).max() < 1e-12
        assert (
            np.abs(found["origin"] - ([0, 0, 7] if frame == "world" else [5, 6, 7])).max() < 1e-12
        )
    assert is_result(out)
    shape("--fourier", out, "--grid", "5", "--qmax", "2", "--frame", frame)
    with np.load(out) as found:
        assert found["q"].shape == (25, 2) and found["q"][12].tolist() == [0.0, 0.0]
        assert close(found["F"][12].real, 6.0, rel=1e-6)


def test_flat_shape_refuses_spatial_wave_vectors(tmp_path):
    sheet(RECTANGLE)
    np.save(tmp_path / "q.npy", np.zeros((2, 3)))
    with pytest.raises(SystemExit):
        document("--flat", "--fourier", tmp_path / "out.npz", "--q", tmp_path / "q.npy")


def test_a_body_has_no_flat_transform(tmp_path):
    add_box()
    found = document("--flat", "--fourier", tmp_path / "out.npz", "--grid", "4", "--qmax", "2")
    assert len(found["errors"]) == 1 and not (tmp_path / "out.npz").exists()


def test_faces_that_cover_nothing_have_no_transform(tmp_path, reported):
    """Two slivers that face each other: they are no larger than what rounding leaves, and no side
    of them is told.
    """
    sheet([(1, 0), (2, 0), (1.5, 1e-7)], faces=[(0, 1, 2), (2, 1, 0)])
    path = tmp_path / "out.npz"
    with pytest.raises(RuntimeError):
        bpy.ops.object.body_moments_fourier(filepath=str(path), of="FLAT")
    assert reported.codes == ["no_section_area"] and not path.exists()


def test_operator_writes_transform_and_picture_of_a_flat_shape(tmp_path):
    text("R", "Letter")
    path = str(tmp_path / "letter.npz")
    assert bpy.ops.object.body_moments_fourier(filepath=path, of="FLAT", count=32) == {"FINISHED"}
    image = bpy.data.images["Fourier Transform of Letter"]
    assert tuple(image.size) == (32, 32)
    pixels = np.array(image.pixels[:]).reshape(32, 32, 4)[..., 0]
    assert pixels[16, 16] == pixels.max() and pixels.min() < 0.7
    with np.load(path) as found:
        assert found["q"].shape == (1024, 2)
        size = np.abs(found["F"]).reshape(32, 32)
        gray = 1.0 + np.log10(size / size.max()) / 6.0
        assert np.abs(pixels - gray.T).max() < 0.01  # x to the right, y upward


def exact_moments(points):
    """Area, centroid and central second moments (xx, yy, xy) of a polygon, as fractions."""
    x, y = ([Fraction(float(value)) for value in column] for column in np.asarray(points).T)
    after = [*range(1, len(x)), 0]
    cross = [x[i] * y[j] - x[j] * y[i] for i, j in enumerate(after)]
    area = sum(cross) / 2
    center = [
        sum(c * (u[i] + u[j]) for i, (j, c) in enumerate(zip(after, cross))) / (6 * area)
        for u in (x, y)
    ]
    second = [
        sum(
            c * (2 * u[i] * v[i] + 2 * u[j] * v[j] + u[i] * v[j] + u[j] * v[i])
            for i, (j, c) in enumerate(pairs)
        )
        / 24
        - area * center[one] * center[other]
        for u, v, one, other in ((x, x, 0, 0), (y, y, 1, 1), (x, y, 0, 1))
        for pairs in [list(zip(after, cross))]
    ]
    return area, center, second


@pytest.mark.parametrize("far, least", [(0.0, 1e-3), (300.0, 1e-6)])
def test_centroid_and_second_moments_have_tight_bounds(far, least):
    """Compare float32 polygons with fractions."""
    rng, worst = (
        np.random.default_rng(5),
        dict.fromkeys(("area", "centroid", "second_moments"), 0.0),
    )
    for _ in range(12):
        turns = np.sort(rng.random(7)) * 2.0 * np.pi
        points = far + rng.uniform(0.5, 1.5, (7, 1)) * np.column_stack(
            [np.cos(turns), np.sin(turns)]
        )
        points = points.astype(np.float32)
        obj = sheet(points.tolist())
        entry, (area, center, second) = shape(), exact_moments(points)
        bpy.data.objects.remove(obj)
        assert entry["plane"]["x"] == [1, 0, 0] and entry["plane"]["y"] == [0, 1, 0]
        found = {
            "area": [(entry["area"], area)],
            "centroid": zip(entry["centroid"], center),
            "second_moments": [
                (entry["second_moments"][name], truth)
                for name, truth in zip(("xx", "yy", "xy"), second)
            ],
        }
        for name, pairs in found.items():
            off = max(abs(Fraction(value) - truth) for value, truth in pairs)
            assert off <= Fraction(entry["error_bound"][name])
            worst[name] = max(worst[name], float(off / Fraction(entry["error_bound"][name])))
    assert min(worst.values()) > least, worst
