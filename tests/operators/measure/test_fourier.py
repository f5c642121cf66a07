# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fourier transforms of objects: on the command line and by the operator."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.fourier import object_transform
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.fourier import instances as fourier_body

from tests.blender import batch_files as files
from tests.blender import objects
from tests.blender.batch_files import document, measured, run
from tests.blender.findings import refused, said
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")

SIZE, CENTER = np.array([1.0, 2.0, 3.0]), np.array(files.CENTER)
Q = np.random.default_rng(3).normal(size=(30, 3)) * np.logspace(-9, 1.5, 30)[:, None]


def box_spectrum(q, size=SIZE, center=CENTER):
    return np.prod(size * np.sinc(q * size / (2 * np.pi)), axis=1) * np.exp(-1j * (q @ center))


@pytest.fixture
def wave_vectors(tmp_path):
    path = tmp_path / "q.npy"
    np.save(path, Q)
    return path


def transform(obj, q=Q, options=None, **more):
    bpy.context.view_layer.update()
    found = object_transform(
        obj, bpy.context.evaluated_depsgraph_get(), options or MeasureOptions(), q, **more
    )
    for _ in found.steps():
        pass
    return found.result()


def test_fourier_command_writes_given_wave_vectors_and_values(tmp_path, wave_vectors):
    files.add_box()
    out = tmp_path / "out.npz"
    entry = measured("--fourier", out, "--q", wave_vectors)
    assert entry["volume"] == pytest.approx(6.0)
    with np.load(out) as found:
        assert np.array_equal(found["q"], Q)
        assert found["F"].dtype == np.complex128
        assert np.abs(found["F"] - box_spectrum(Q)).max() <= 1e-13
        assert (found["error"] <= 1e-12).all() and found["input"] < 1e-4
        assert (str(found["method"]), str(found["frame"])) == ("exact", "world")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.npz", "q.npy"]


def test_the_command_writes_a_grid(tmp_path):
    files.add_box()
    out = tmp_path / "out"  # the name is taken as it is
    measured("--fourier", out, "--grid", 6, "--qmax", 4.5, "--kind", "solid")
    with np.load(out) as found:
        axis = np.arange(-3, 3) * 1.5
        assert np.array_equal(np.unique(found["q"]), axis) and found["q"].shape == (216, 3)
        assert np.abs(found["F"] - box_spectrum(found["q"])).max() <= 1e-13


def test_fourier_object_frame_has_unit_scale(tmp_path, wave_vectors):
    box = files.add_box(center=(0, 0, 0))
    box.location, box.rotation_euler, box.scale = (5, 6, 7), (0.3, -0.2, 1.1), (2, 1, 0.5)
    out = tmp_path / "out.npz"
    measured("--fourier", out, "--q", wave_vectors, "--frame", "object")
    with np.load(out) as found:
        assert str(found["frame"]) == "object"
        assert np.abs(found["F"] - box_spectrum(Q, SIZE * [2, 1, 0.5], np.zeros(3))).max() <= 1e-4


def test_a_shell_is_its_area_times_its_thickness():
    box = files.add_box(center=(0, 0, 0))
    found, _ = transform(box, np.zeros((1, 3)), MeasureOptions(kind="shell", thickness=0.25))
    assert close(found.values[0], 22.0 * 0.25, rel=1e-14)
    found, _ = transform(box, np.zeros((1, 3)), area=True)
    assert close(found.values[0], 22.0, rel=1e-14)
    with refused("zero_quantity"):
        transform(box, options=MeasureOptions(kind="shell", thickness=0.0))


def test_a_wall_of_real_thickness_is_refused_with_the_remedy():
    box = files.add_box(center=(0, 0, 0))
    thick = MeasureOptions(kind="shell", thickness=0.1, wall="inward")
    with refused("wall_unsupported", box.name):
        transform(box, options=thick)
    assert close(transform(box, np.zeros((1, 3)), thick, area=True)[0].values[0], 22.0, rel=1e-14)


def test_given_unit_scale_overrides_scene_unit_in_both_frames(scene):
    scene.unit_settings.scale_length = 10.0
    box = files.add_box()
    options = MeasureOptions(unit_scale=0.01)
    true = box_spectrum(Q, SIZE / 100, CENTER / 100)
    assert np.abs(transform(box, options=options)[0].values - true).max() <= 1e-18
    own = box_spectrum(Q, SIZE / 100, np.zeros(3))
    assert np.abs(transform(box, options=options, frame="object")[0].values - own).max() <= 1e-18


def test_fourier_turns_flipped_faces_and_caps_holes():
    box = files.add_box()
    box.data.polygons[2].flip()
    found, findings = transform(box)
    assert np.abs(found.values - box_spectrum(Q)).max() <= 1e-13
    assert said(findings) == {"flipped_faces": {"count": 1}}
    corners = [vertex.co[:] for vertex in box.data.vertices]
    sides = [polygon.vertices[:] for polygon in box.data.polygons]
    found, findings = transform(
        objects.add(objects.mesh_of(corners, sides[:4]), location=files.CENTER)
    )
    assert np.abs(found.values - box_spectrum(Q)).max() <= 1e-13
    assert said(findings)["holes_capped"]["count"] == 2


def test_fourier_of_fins_is_refused():
    obj = objects.add(
        objects.mesh_of(
            [(0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (-1, -1, 0)],
            [(0, 1, 2), (0, 1, 3), (0, 1, 4)],
            "Fins",
        )
    )
    with refused("fourier_of_open_surface"):
        transform(obj)
    found, _ = transform(obj, np.zeros((1, 3)), area=True)
    assert found.values[0] == pytest.approx(0.5 + 0.5 + 2**0.5 / 2, rel=1e-12)


def test_one_object_is_needed_and_a_refusal_is_an_error(tmp_path, wave_vectors):
    files.add_box("a")
    files.add_box("b")
    out = tmp_path / "out.npz"
    found = document("--fourier", out, "--q", wave_vectors)
    assert (
        len(found["objects"]) == 2
        and "--object" in found["errors"][0]["reason"]
        and not out.exists()
    )
    assert (
        measured("--fourier", out, "--q", wave_vectors, "--object", "b")["name"] == "b"
        and out.exists()
    )
    out.unlink()
    objects.add(objects.mesh_of([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], "Plane"), "Flat")
    line = run("--fourier", out, "--q", wave_vectors, "--object", "Flat")
    assert line.errors == 1 and line.internal_errors == 0 and not out.exists()


def test_the_operator_writes_the_file_and_an_image(tmp_path):
    box = objects.add(objects.mesh_body(), location=(1, 2, 3))
    selected, mode = bpy.context.selected_objects, bpy.context.mode
    path = tmp_path / "body.npz"
    result = bpy.ops.object.body_moments_fourier(filepath=str(path.with_suffix("")), count=12)
    assert result == {"FINISHED"}
    expected, _ = transform(box, lambda size: fourier_body.FrequencyGrid(12, np.pi / size * 6))
    with np.load(path) as found:
        assert np.array_equal(found["q"], expected.q)
        assert np.array_equal(found["F"], expected.values)
        assert found["q"].max() == pytest.approx(np.pi / 3.5 * 5, rel=1e-6)
        values = np.abs(found["F"]).reshape(12, 12, 12)
    image = bpy.data.images["Fourier Transform of Body"]
    assert tuple(image.size) == (3 * 12 + 4, 12) and image.packed_file
    pixels = np.empty(40 * 12 * 4, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(12, 40, 4)
    gray = pixels[..., 0]
    assert (pixels[..., :3] == gray[..., None]).all() and (pixels[..., 3] == 1.0).all()
    assert gray[6, 6] == gray[6, 14 + 6] == gray[6, 28 + 6] == 1.0  # F(0) = V is the largest
    for found, slice_ in (
        (gray[:, :12], values[:, :, 6]),
        (gray[:, 14:26], values[:, 6]),
        (gray[:, 28:], values[6]),
    ):
        assert (
            np.abs(found.T - (1 + np.log10(slice_ / values.max()).clip(-6, 0) / 6)).max() <= 1 / 255
        )
    assert (bpy.context.selected_objects, bpy.context.mode) == (selected, mode)
