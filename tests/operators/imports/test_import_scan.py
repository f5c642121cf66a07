# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan becomes a Volume object that weighs what the file does."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.read import vdb
from body_moments.blender.read.volume import volume_reading
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.bodies.files import ArrayOptions, measure_array
from body_moments.core.density import grid_moments
from body_moments.core.measurement.settings import Settings

from tests.blender.findings import refused, said
from tests.close import close
from tests.core.scan_files import nifti, nrrd, written

pytestmark = pytest.mark.usefixtures("scene")


def samples(dtype="f4", low=0):
    return np.random.default_rng(0).integers(low, 100, (5, 6, 7)).astype(dtype)


def imported(path, **options):
    assert bpy.ops.object.body_moments_import_scan(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.object


def measure(obj):
    return measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions())


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_imported_scan_has_mass_of_its_file(tmp_path, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    sform = [[0.5, 0.25, 0, -9], [0, -2, 0.125, 8], [0, 0, 3, 7]]
    path = written(tmp_path / "a.nii", nifti(samples("i2"), sform=sform, slope=0.5))
    obj = imported(path)
    assert obj.type == "VOLUME" and obj.select_get() and (tmp_path / "a.vdb").is_file()
    bpy.context.view_layer.update()
    found, expected = measure(obj), measure_array(str(path), "a", ArrayOptions(), Settings())
    assert close(found.mass_properties.mass, expected.mass_properties.mass, rel=1e-12)
    assert found.mass_properties.center == pytest.approx(expected.mass_properties.center, rel=1e-9)
    assert found.mass_properties.inertia == pytest.approx(
        expected.mass_properties.inertia, rel=1e-9, abs=1e-15
    )
    assert close(found.volume, expected.volume, rel=1e-12)


@pytest.mark.parametrize("least", [-1000.0, -(2.0**24), -(2.0**30)])
def test_no_sample_is_lost_and_ct_numbers_go_by_the_table(least, tmp_path, reported):
    values = samples("f4", -1000)
    values[0, 0, :2] = least, -999.0
    obj = imported(written(tmp_path / "ct.nrrd", nrrd(values, "spacings: 1 1 1")))
    assert obj.body_moments.values_from == "TABLE" and "CT numbers" in reported.texts[-1]
    bpy.context.view_layer.update()
    with volume_reading(obj, bpy.context.evaluated_depsgraph_get()) as reading:
        ((_, found),) = reading.blocks()
        assert np.array_equal(found, values)
    assert measure(obj).volume == pytest.approx(values.size)


@pytest.mark.parametrize(("finer", "kind"), [(0.0, "FLOAT"), (2.0**-30, "DOUBLE")])
def test_float64_samples_stay_exact_in_volume(tmp_path, finer, kind):
    values = samples("f8") + finer
    obj = imported(written(tmp_path / "a.nrrd", nrrd(values)))
    bpy.context.view_layer.update()
    obj.data.grids.load()
    assert [grid.data_type for grid in obj.data.grids] == [kind]
    with volume_reading(obj, bpy.context.evaluated_depsgraph_get()) as reading:
        assert np.array_equal(next(iter(reading.blocks()))[1], values)


def test_a_raw_file_by_hand_and_a_spacing(tmp_path):
    values = samples("u2")
    path = written(tmp_path / "a.raw", values.astype(">u2").tobytes(order="F"))
    obj = imported(
        path,
        raw_shape=(5, 6, 7),
        raw_type="uint16",
        raw_big_endian=True,
        use_spacing=True,
        spacing=(0.01, 0.01, 0.02),
    )
    bpy.context.view_layer.update()
    assert close(measure(obj).mass_properties.mass, values.sum() * 2e-6, rel=1e-12)


def test_refused_import_leaves_no_data(tmp_path, reported):
    def refusal(path):
        with pytest.raises(RuntimeError, match=r"\A.+\n?\Z"):
            bpy.ops.object.body_moments_import_scan(filepath=str(path))
        return reported.codes[-1]

    before = len(bpy.data.objects), len(bpy.data.volumes)
    assert refusal(written(tmp_path / "a.nrrd", b"nonsense")) == "file_unrecognized"
    assert reported[-1].values["sources"] == ["a.nrrd"]
    with pytest.raises(RuntimeError, match="No file"):
        bpy.ops.object.body_moments_import_scan(filepath=str(tmp_path))
    assert refusal(written(tmp_path / "a.txt", b"nonsense")) == "file_type"
    good = written(tmp_path / "b.nrrd", nrrd(samples()))
    written(tmp_path / "b.vdb", b"mine")
    assert refusal(good) == "file_exists" and reported[-1].values["file"] == "b.vdb"
    assert (tmp_path / "b.vdb").read_bytes() == b"mine"
    for value in (np.inf, -np.inf, np.nan):
        bad = samples()
        bad[1, 1, 1] = value
        assert refusal(written(tmp_path / "c.nrrd", nrrd(bad))) == "density_non_finite"
    assert (len(bpy.data.objects), len(bpy.data.volumes)) == before
    packed = bytearray(nrrd(samples(), encoding="gzip"))
    packed[-5] ^= 1
    assert (
        refusal(written(tmp_path / "d.nrrd", packed)) == "damage_incomplete"
        and not (tmp_path / "d.vdb").exists()
    )
    imported(good, overwrite=True)


@pytest.mark.parametrize(
    "error", [RuntimeError("no space left"), OSError("no space left"), OSError(28, "no space left")]
)
def test_a_volume_is_written_whole_or_not_at_all(error, tmp_path, monkeypatch, capfd, reported):
    path = written(tmp_path / "a.nii", nifti(samples("i2")))
    imported(path)
    assert ".." not in capfd.readouterr().out
    kept = (tmp_path / "a.vdb").read_bytes()

    class Failing:
        """openvdb on a full disk."""

        def __getattr__(self, name):
            return getattr(real, name)

        def write(self, file, grid):
            with open(file, "wb") as partial:
                partial.write(b"half")
            raise error

    real = vdb.openvdb()
    monkeypatch.setattr(vdb, "openvdb", Failing)
    with pytest.raises(RuntimeError, match="no space left"):
        bpy.ops.object.body_moments_import_scan(filepath=str(path), overwrite=True)
    assert reported.values("file_not_written")["error"] == "no space left"
    assert (tmp_path / "a.vdb").read_bytes() == kept
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.nii", "a.vdb"]


def test_outside_samples_need_permission(tmp_path):
    (tmp_path / "headers").mkdir()
    values = samples("f4", 1)
    (tmp_path / "a.raw").write_bytes(values.tobytes(order="F"))
    header = (
        "NRRD0004\ntype: float\ndimension: 3\nsizes: {} {} {}\nendian: little\nencoding: "
        "raw\nspacings: 1 1 1\n"
    )
    path = tmp_path / "headers" / "a.nhdr"
    path.write_text(header.format(*values.shape) + "data file: ../a.raw\n")
    with pytest.raises(RuntimeError, match="turn on Allow Outside"):
        bpy.ops.object.body_moments_import_scan(filepath=str(path))
    assert bpy.ops.object.body_moments_import_scan(filepath=str(path), allow_outside=True) == {
        "FINISHED"
    }


def uneven(tmp_path, **options):
    samples = np.random.default_rng(3).integers(1, 9, (3, 2, 6)).astype("f4")
    samples[:, :, 0] = 0.0  # so that the grid's box begins at the second slice
    z = np.array([10.0, 10.5, 12.0, 12.25, 15.0, 16.0])
    np.save(tmp_path / "scan.npy", samples)
    np.save(tmp_path / "z.npy", z)
    obj = imported(tmp_path / "scan.npy", z_positions=str(tmp_path / "z.npy"), **options)
    bpy.context.view_layer.update()
    return obj, samples, z


@pytest.mark.parametrize("spline_order", [1, 2, 4])
def test_uneven_slices_are_measured_at_their_positions(tmp_path, reported, spline_order):
    obj, samples, z = uneven(tmp_path, position_unit=0.001)
    assert "“z”" in reported.texts[-1]
    obj.body_moments.spline_order = spline_order
    truth = grid_moments(
        samples, samples.shape, np.eye(4), spline_order, positions=(None, None, z * 0.001)
    )
    found = measure(obj)
    assert close(found.mass_properties.mass, truth.total, 1e-12)
    assert np.abs(found.mass_properties.center - truth.center).max() <= 1e-9
    assert "samples_positioned" in said(found)
    obj.scale = (1, 1, 2)
    bpy.context.view_layer.update()
    assert close(measure(obj).mass_properties.mass, 2.0 * truth.total, 1e-12)


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_uneven_slices_are_drawn_from_first_to_last(tmp_path, unit):
    bpy.context.scene.unit_settings.scale_length = unit
    obj, _, z = uneven(tmp_path, position_unit=0.25)
    obj.data.grids.load()
    matrix = np.array(obj.data.grids[0].matrix_object)
    assert [matrix[2, 3], (matrix @ (0, 0, 5, 1))[2]] == pytest.approx(
        [0.25 * z[0] / unit, 0.25 * z[-1] / unit]
    )


def test_uneven_slices_survive_saving_and_refuse_thresholds(tmp_path):
    obj, *_ = uneven(tmp_path)
    mass = measure(obj).mass_properties.mass
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    obj = bpy.data.objects["scan"]
    assert measure(obj).mass_properties.mass == mass
    obj.body_moments.grid_as = "THRESHOLD"
    with refused("positions_only_as_density", "scan"):
        measure(obj)
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.object
    cube.body_moments.density_from, cube.body_moments.density_volume = "VOLUME", obj
    with refused("object_unreadable", "Cube"):
        measure(cube)
    obj.body_moments.grid_as = "DENSITY"
    for damaged in (
        "{",
        "[1]",
        '{"z":1}',
        '{"z":[0,1,1,2,3,4]}',
        '{"z":[0,1,2,3,4,NaN]}',
        '{"z":["a"]}',
        '{"z":[0,1,2]}',
    ):
        obj.body_moments.sample_positions = damaged
        with refused("positions_damaged", "scan"):
            measure(obj)
