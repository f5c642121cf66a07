# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Units of imported surface files."""

import gzip
import tarfile
from pathlib import Path

import bpy
import pytest
from body_moments.core.verdict import MeasureError

from tests.blender.objects import measured
from tests.blender.surface_files import imported, written
from tests.core.exact_splines import sphere
from tests.core.iges_files import obj_text, unrolled

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_unitless_surface_file_takes_unit_of_option(scale, tmp_path):
    bpy.context.scene.unit_settings.scale_length = scale
    written(tmp_path, unrolled(sphere()), unit=6)
    (tmp_path / "two.obj").write_text(obj_text([unrolled(sphere())], name="Ball"))
    for name, meters in (("body.igs", 1.0), ("two.obj", 0.25)):
        obj = imported(filepath=str(tmp_path / name), unit=0.25)
        assert max(obj.dimensions) == pytest.approx(2.0 * meters / scale, rel=0.05)


def test_step_solid_keeps_its_volume_in_a_blend_until_it_is_edited(tmp_path):
    with tarfile.open("tests/core/cad/kernel/step.tar.xz") as archive:
        (tmp_path / "assembly_mm.step").write_bytes(archive.extractfile("assembly_mm.step").read())
    imported(filepath=str(tmp_path / "assembly_mm.step"))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "parts.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "parts.blend"))
    assert {obj.name for obj in bpy.data.objects} == {
        "Plätte",
        "Bolt",
        *("Bolt.00" + k for k in "123"),
    }
    bolt = bpy.data.objects["Bolt.002"]
    assert bolt.active_material.name == "#e7597c"
    assert measured(bolt).volume == pytest.approx(1.8366940367818e-6, rel=1e-11)
    bolt.modifiers.new("Shell", "SOLIDIFY")
    with pytest.raises(MeasureError, match="CAD file"):
        measured(bolt)


def test_trimmed_iges_solid_is_measured_as_in_the_file(tmp_path):
    packed = Path("tests/core/cad/kernel/swept/cross_solid.igs.gz")
    data = gzip.decompress(packed.read_bytes())
    (tmp_path / "tube.igs").write_bytes(data)
    tube = imported(filepath=str(tmp_path / "tube.igs"))
    tube.name = "Tube"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "tube.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "tube.blend"))
    tube = bpy.data.objects["Tube"]
    assert measured(tube).volume == pytest.approx(11020.05259343911728e-9, rel=1e-9)
    tube.scale = 2.0, 2.0, 2.0
    assert measured(tube).volume == pytest.approx(8.0 * 11020.05259343911728e-9, rel=1e-9)
