# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""--float and --gz, their columns and their plot."""

from argparse import ArgumentTypeError

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.command.options.option_types import liquid
from body_moments.core.measurement import FORMATS, to_html

from tests.blender import batch_files as files
from tests.blender.batch_files import document

pytestmark = pytest.mark.usefixtures("scene")
WORDS = ("--float", "1000", "--density", "500", "--gz", "0:60:10")


def floating_box(*words, size=(3.0, 2.0, 1.0)):
    files.add_box(center=(5.0, 6.0, 7.0), size=size)
    return document(*WORDS, *words)


@pytest.mark.parametrize("frame", ["world", "object"])
def test_floating_box_has_closed_form_record(frame):
    entry = floating_box("--frame", frame)["objects"][0]["floating"]
    center = np.array([5.0, 6.0, 7.0]) if frame == "world" else np.zeros(3)
    assert entry["draught"] == pytest.approx(0.5, rel=1e-12)
    assert entry["displacement"] == pytest.approx(3.0, rel=1e-12)
    assert entry["center_of_buoyancy"] == pytest.approx(center - [0.0, 0.0, 0.25], abs=1e-12)
    assert entry["gm"] == pytest.approx([2.0 / 3.0 - 0.25, 1.5 - 0.25], rel=1e-12)
    assert 0.0 < entry["error_bound"]["draught"] < 1e-12 < entry["error_bound"]["input"]["gm"]
    assert np.array(entry["matrix"])[2] == pytest.approx([0.0, 0.0, 1.0, -7.0], abs=1e-12)
    assert entry["rests"][0]["energy"] == pytest.approx(0.0, abs=1e-12)
    curve = entry["gz"]
    assert np.degrees(curve["angles"]) == pytest.approx(np.arange(0.0, 61.0, 10.0))
    sine, tangent = np.sin(curve["angles"][2]), np.tan(curve["angles"][2])
    arm = sine * (entry["gm"][0] + entry["bm"][0] * tangent**2 / 2.0)
    assert curve["arms"][2] == pytest.approx(arm, rel=1e-12)


def test_children_and_tanks_of_a_file_float_as_one_body():
    boat, tank, cargo = (
        files.add_box(name, (0.0, 0.0, z), size)
        for name, z, size in (
            ("Boat", 0.0, (6.0, 2.0, 1.0)),
            ("Tank", 0.0, (2.0, 1.6, 0.8)),
            ("Cargo", 0.75, (1.0, 1.0, 0.5)),
        )
    )
    tank.parent = cargo.parent = boat
    tank.body_moments_tank.role = "TANK"
    tank.body_moments.density = 800.0
    found = document("--float", "1000", "--density", "300")
    assert not found["errors"]
    entries = {one["name"]: one for one in found["objects"]}
    entry = entries["Boat"]["floating"]
    assert entry["parts"] == ["Boat", "Cargo", "Tank"]
    volume = 3.6 + 0.15 + 0.8 * 1.28
    depth = volume / 12.0
    assert entry["draught"] == pytest.approx(depth, rel=1e-6)
    gravity = (3.6 * 0.5 + 0.15 * 1.25 + 1.024 * 0.3) / volume
    second = 6.0 * 8.0 / 12.0 - 0.8 * 2.0 * 1.6**3 / 12.0
    assert entry["kg"] == pytest.approx(gravity, rel=1e-6)
    assert entry["gm"][0] == pytest.approx(depth / 2.0 + second / volume - gravity, rel=1e-6)
    assert "floating" not in entries["Cargo"]
    bpy.context.scene.collection.body_moments.mass_from = "MASS"
    bpy.context.scene.collection.body_moments.mass = 3750.0
    (whole,) = document("--float", "1000", "--density", "300")["assemblies"]
    assert whole["floating"]["gm"] == pytest.approx(entry["gm"], rel=1e-6)
    alone = document("--float", "1000", "--density", "300", "--object", "Cargo")["objects"]
    assert alone[0]["floating"]["draught"] == pytest.approx(0.15, rel=1e-6)


def test_floating_record_becomes_columns_and_plot():
    files_document = floating_box()
    text = "".join(FORMATS["csv"]([files_document]))
    header = text.splitlines()[0].split(",")
    assert {"floating_draught", "floating_gm_1", "gz_arms"} <= {*header}
    assert "matrix" not in header
    page = "".join(to_html([files_document]))
    assert 'class="curve"' in page and "60°" in page


def test_heavy_box_is_an_error_with_remedy():
    files.add_box()
    found = document("--float", "1000", "--density", "2000")
    assert found["objects"][0]["floating"] is None
    assert "remove more than 6000 kg of its 12000 kg" in found["errors"][0]["reason"]


@pytest.mark.parametrize("change", [{"use_gravity": False}, {"gravity": (0.0, 0.0, 0.0)}])
def test_nothing_floats_without_gravity(change):
    for name, value in change.items():
        setattr(bpy.context.scene, name, value)
    found = floating_box()
    assert found["objects"][0]["floating"] is None
    assert "no gravity" in found["errors"][0]["reason"]


def test_mesh_file_floats_as_its_object(tmp_path):
    there = floating_box()["objects"][0]["floating"]
    path = files.save(tmp_path / "box.obj")
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    here = document(*WORDS, path)["objects"][0]["floating"]
    assert here["gm"] == pytest.approx(there["gm"], rel=1e-6)
    assert here["draught"] == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize(
    "name, density",
    [("Sea Water", 1023.343), ("sea water", 1023.343), ("Oil", 871.0), ("oil, hydraulic", 871.0)],
)
def test_liquid_is_named_in_any_case(name, density):
    files.add_box()
    found = document("--float", name, "--density", "500")["objects"][0]["floating"]
    assert found["liquid_density"] == density


def test_scan_does_not_float_and_says_so(tmp_path):
    path = tmp_path / "scan.npy"
    np.save(path, np.full((2, 2, 2), 500.0))
    (entry,) = document("--float", "Water", path)["objects"]
    assert entry["floating"] is None
    assert "options_unused" in [found["code"] for found in entry["findings"]]


@pytest.mark.parametrize("text", ["1e300", "0.0009", "0", "-1", "nan", "inf"])
def test_liquid_of_absurd_density_is_refused(text):
    with pytest.raises(ArgumentTypeError, match="1e-3 to 1e6"):
        liquid(text)
