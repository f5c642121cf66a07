# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays and scans on the command line: the options of the contract, and records as objects have
them.
"""

import gzip

import numpy as np
import pytest
from body_moments.command.findings import NEEDS_BLEND
from body_moments.core.density import smooth_threshold_body, threshold_body
from body_moments.operators import batch

from tests.blender.batch_files import codes, in_process, sentence
from tests.close import close
from tests.command.running import run
from tests.core.scan_files import nifti, nrrd, written

pytestmark = pytest.mark.usefixtures("scene")


def box(dtype="f4", value=1.0):
    """4 x 2 x 6 voxels."""
    return np.full((4, 2, 6), value, dtype)


def test_a_box_of_voxels_has_the_inertia_of_a_box(tmp_path):
    np.save(tmp_path / "box.npy", box())
    options = "--spacing 0.5,0.5,0.5 --origin -1,0,10 --density-scale 2 --order 2"
    code, document = run(tmp_path, tmp_path / "box.npy", *options.split())
    assert code == 0 and document["errors"] == []
    (entry,) = document["objects"]
    assert (entry["name"], entry["type"], entry["kind"], entry["method"]) == (
        "box",
        "ARRAY",
        "solid",
        "grid exact",
    )
    assert close(entry["mass"], 12.0, rel=1e-14)
    assert close(entry["volume"], 6.0, rel=1e-14)
    assert close(entry["density"], 2.0, rel=1e-14)
    assert close(entry["center_of_mass"], [-0.25, 0.25, 11.25], rel=1e-14)
    assert np.diag(entry["inertia"]) == pytest.approx([10.0, 13.0, 5.0], rel=1e-12)
    assert entry["moments"]["volume"]["0,0,0"] == pytest.approx(6.0)
    assert document["total"]["mass"] == pytest.approx(12.0)


def test_scans_bring_their_own_units_and_places(tmp_path):
    files = [
        written(tmp_path / "a.nii", nifti(box("i2"), spacing=(2, 2, 2), slope=3.0)),
        written(tmp_path / "b.nii.gz", gzip.compress(nifti(box("u1"), spacing=(2, 2, 2)))),
        written(
            tmp_path / "c.nrrd",
            nrrd(box(), "spacings: 2 2 2", 'units: "mm" "mm" "mm"', encoding="gzip"),
        ),
    ]
    code, documents = run(tmp_path, *files)
    assert code == 0
    masses = [document["objects"][0]["mass"] for document in documents]
    assert close(masses, [3 * 48 * 8e-9, 48 * 8e-9, 48 * 8e-9], rel=1e-6)
    assert [document["objects"][0]["name"] for document in documents] == ["a", "b", "c"]


def test_given_mass_object_names_and_notes(tmp_path):
    np.savez(tmp_path / "m.npz", density=box())
    code, document = run(tmp_path, tmp_path / "m.npz", "--mass", "7", "--unit-scale", "0.001")
    assert document["objects"][0]["mass"] == pytest.approx(7.0)
    assert close(document["objects"][0]["volume"], 48e-9, rel=1e-6)
    assert document["objects"][0]["density_from"] == "samples"
    code, document = run(
        tmp_path, tmp_path / "m.npz", "--density", "5", "--object", "m", "--object", "n"
    )
    assert code == 1
    assert [error["name"] for error in document["errors"]] == ["n"]
    assert {"given_density_ignored", "scan_unstated"} <= {*codes(document["objects"][0])}


def damaged(file: str, code: str, **values) -> str:
    return sentence("file_damaged", file=file, cause={"code": code, "values": values})


@pytest.mark.parametrize(
    "data, options, reason",
    [
        (b"nonsense", (), sentence("file_unrecognized", format="NRRD")),
        (nrrd(-box()), (), sentence("values_negative", density=-1.0)),
        (nrrd(box("f4", 0.0)), (), sentence("grid_empty")),
        (nrrd(box("f4", np.nan)), (), sentence("density_non_finite")),
        (nrrd(box()), ("--kind", "shell"), sentence("grid_as_shell")),
        (nrrd(box()), ("--write",), sentence("results_not_stored", cause=NEEDS_BLEND)),
        (
            nrrd(box(), encoding="gzip")[:-1] + b"!",
            (),
            damaged(
                "a.nrrd",
                "damage_incomplete",
                kind="gzip stream",
                error="Incorrect length of data produced",
            ),
        ),
    ],
)
def test_unmeasurable_array_is_an_error(tmp_path, data, options, reason):
    code, document = run(tmp_path, written(tmp_path / "a.nrrd", data), *options)
    assert code == 1
    (error,) = document["errors"]
    assert error["name"] is None and error["reason"] == reason


def test_a_scene_with_a_cloud_goes_through_every_option(tmp_path):
    import bpy

    from tests.blender.grids import vdb_grid, volume_object

    values = np.random.default_rng(0).random((5, 6, 9)).astype("f4")
    volume_object(tmp_path / "a.vdb", vdb_grid(values))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    options = "--order 4 --surface-moments --pose --signature --density 2 --frame object --write"
    code, document = run(tmp_path, tmp_path / "a.blend", *options.split())
    assert code == 0 and document["errors"] == []
    (entry,) = document["objects"]
    assert (entry["type"], entry["method"]) == ("VOLUME", "grid exact")
    assert entry["mass"] == pytest.approx(2.0 * values.sum(dtype=float), rel=1e-12)
    assert entry["pose"] is None and entry["signature"] is None
    assert "shape_of_grid" in codes(entry)
    assert set(entry["moments"]["surface"].values()) == {0.0}
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    obj = bpy.data.objects["Cloud"]
    assert obj["body_mass"] == entry["mass"]
    assert obj.body_moments.value_density == 2.0
    code, document = run(
        tmp_path,
        tmp_path / "a.blend",
        "--fourier",
        tmp_path / "f.npz",
        "--grid",
        "4",
        "--qmax",
        "1",
    )
    assert code == 1
    assert "Fourier" in document["errors"][0]["reason"]


def test_uneven_slices_are_measured_in_place(tmp_path):
    samples = np.random.default_rng(3).integers(1, 9, (4, 2, 6)).astype("f4")
    z = np.array([10.0, 10.5, 12.0, 12.25, 15.0, 16.0])
    np.save(tmp_path / "scan.npy", samples)
    np.save(tmp_path / "z.npy", z)
    words = (
        tmp_path / "scan.npy",
        "--spacing",
        "2,3,9",
        "--origin",
        "5,6,7",
        "--positions",
        f"z={tmp_path / 'z.npy'}",
    )
    code, document = run(tmp_path, *words, "--order", "4")
    assert code == 0 and document["errors"] == []
    (entry,) = document["objects"]
    edges = np.concatenate([[9.75], (z[1:] + z[:-1]) / 2, [16.5]])
    thick, middle = np.diff(edges), (edges[1:] + edges[:-1]) / 2
    weights = samples.sum(axis=(0, 1)) * thick * 6.0
    assert close(entry["mass"], weights.sum(), 1e-13)
    assert close(entry["center_of_mass"][2], (weights @ middle) / weights.sum(), 1e-13)
    assert close(entry["volume"], 8 * 6.0 * thick.sum(), 1e-13)
    fourth = samples.sum(axis=(0, 1)) * 6.0 @ (np.diff(edges**5) / 5)
    assert close(entry["moments"]["mass"]["0,0,4"], fourth, 1e-12)
    assert 0.0 < entry["moments"]["error"]["mass"]["0,0,4"] < 1e-10 * fourth
    assert "samples_positioned" in codes(entry)
    millimeters = run(tmp_path, *words, "--unit-scale", "0.001", "--spline-order", "2")[1][
        "objects"
    ][0]
    hats = np.diff(np.concatenate([[9.5], z, [17.0]]))
    weights = samples.sum(axis=(0, 1)) * 6.0 * (hats[1:] + hats[:-1]) / 2
    assert close(millimeters["mass"], weights.sum() * 1e-9, 1e-13)


@pytest.mark.parametrize(
    "row, words",
    [
        ([0, 1, 2, 3, 4], "must be one row of numbers, 6"),
        ([0, 1, 2, 2, 4, 5], "Position 3 along z"),
        ([0, 1, 2, np.nan, 4, 5], "Position 3 along z"),
        (None, "“z.npy” is missing"),
    ],
)
def test_wrong_positions_are_an_error_of_the_file(tmp_path, row, words):
    np.save(tmp_path / "box.npy", box())
    if row is not None:
        np.save(tmp_path / "z.npy", np.array(row, float))
    code, document = run(tmp_path, tmp_path / "box.npy", "--positions", f"z={tmp_path / 'z.npy'}")
    assert code == 1 and not document["objects"] and words in document["errors"][0]["reason"]


def ball(n=12, dtype="f4"):
    """Values whose trilinear body at 0 is a ball of radius 0.7 n/2 voxels, about."""
    x, y, z = np.ogrid[:n, :n, :n]
    middle = (n - 1) / 2
    return (
        (0.35 * n) ** 2 - (x - middle) ** 2 - (y - middle) ** 2 - 1.3 * (z - middle) ** 2
    ).astype(dtype)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("spline", ["1", "4"])
def test_threshold_turns_array_into_a_body(tmp_path, order, spline):
    values = ball() + np.linspace(0, 3, 12, dtype="f4")[:, None, None]
    np.save(tmp_path / "b.npy", np.asarray(values, order=order))
    words = [
        tmp_path / "b.npy",
        "--threshold",
        "0.5",
        "--spacing",
        "0.1,0.2,0.3",
        "--origin",
        "-1,2,5",
    ]
    words += ["--spline-order", spline, "--order", "4"]
    matrix = np.diag([0.1, 0.2, 0.3, 1.0])
    matrix[:3, 3] = -1.0, 2.0, 5.0
    if spline == "1":
        truth = threshold_body(values, 0.5, 4, matrix, with_density=True)
    else:
        truth = smooth_threshold_body(values, 0.5, 4, 4, matrix, with_density=True)
    code, document = run(tmp_path, *words, "--density", "7")
    (entry,) = document["objects"]
    assert code == 0 and "threshold_measured" in codes(entry) and entry["method"] == "grid exact"
    assert "density_from" not in entry and "scan_unstated" not in codes(entry)
    assert close([entry["volume"], entry["area"]], [truth.volume.total, truth.area.total], rel=1e-9)
    assert close(entry["mass"], 7.0 * truth.volume.total, rel=1e-9)
    assert close(entry["center_of_mass"], truth.volume.center, rel=1e-9)
    raw = truth.volume.about_point(np.zeros(3))
    assert close(entry["moments"]["volume"]["2,1,1"], raw[2, 1, 1], rel=1e-8)
    assert entry["error_bound"]["estimated"] is True
    code, document = run(tmp_path, *words, "--density-scale", "2")
    (entry,) = document["objects"]
    assert close(entry["mass"], 2.0 * truth.mass.total, rel=1e-9)
    assert close(entry["center_of_mass"], truth.mass.center, rel=1e-9)
    raw = truth.mass.about_point(np.zeros(3))
    assert close(entry["moments"]["mass"]["2,1,1"], 2.0 * raw[2, 1, 1], rel=1e-8)
    assert entry["density_from"] == "samples"
    assert "density_defaulted" not in codes(entry)
    _, document = run(tmp_path, tmp_path / "b.npy", "--threshold", "0.5")
    assert {"scan_unstated", "threshold_measured"} <= {*codes(document["objects"][0])}


def test_threshold_applies_to_scaled_header_values(tmp_path):
    stored = (ball() * 10).astype("i2")
    path = written(tmp_path / "a.nii", nifti(stored, spacing=(2, 2, 2), slope=-0.5))
    truth = threshold_body(-0.5 * stored, -3.0)
    _, document = run(tmp_path, path, "--threshold", "-3", "--density", "1")
    (entry,) = document["objects"]
    assert close(entry["volume"], truth.volume.total * 8e-9, rel=1e-6)
    assert truth.clipped and "threshold_clipped" in codes(entry)
    for words, expected in (((), 1), (("--errors-exit-0",), 0)):
        code, document = run(tmp_path, path, "--threshold", "1e6", "--density", "1", *words)
        assert code == expected and not document["objects"] and document["errors"]
    assert (
        batch.main(in_process("measure", path, "--threshold", "nan"), channel=2, file_needed=True)
        == 2
    )


def test_threshold_measures_volumes_and_warns_for_meshes(tmp_path):
    import bpy

    from tests.blender.grids import vdb_grid, volume_object

    volume_object(tmp_path / "a.vdb", vdb_grid(ball()))
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    _, document = run(tmp_path, tmp_path / "a.blend", "--threshold", "0.5")
    entries = {entry["type"]: entry for entry in document["objects"]}
    truth = threshold_body(ball(), 0.5, background=0.0)
    assert close(entries["VOLUME"]["volume"], truth.volume.total, rel=1e-5)
    assert "options_unused" in codes(entries["MESH"])
    assert "options_unused" not in codes(entries["VOLUME"])
