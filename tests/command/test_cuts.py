# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`--below` and `--against`: parts of solids, and cut and fill of open surfaces."""

import csv
import io

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
import bmesh
from body_moments.core.measurement import to_csv, to_html

from tests.blender.batch_files import add_box, document
from tests.blender.objects import add

pytestmark = pytest.mark.usefixtures("scene")


def add_grid(name, heights, location=(0, 0, 0), size=2.0):
    """A grid of 5 x 5 points about the origin, with z = heights(x, y)."""
    axis = np.linspace(-size / 2, size / 2, 5)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    points = np.stack([x, y, heights(x, y)], axis=-1).reshape(-1, 3)
    i = np.arange(25).reshape(5, 5)
    faces = np.stack([i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    return add(mesh, name, location=location)


def test_part_of_a_box_below_a_height():
    add_box("Box", (5, 0, 1))
    found = document("--below", "0.5")
    below = found["objects"][0]["below"]
    size = np.array(bpy.data.objects["Box"].dimensions)
    low = 1 - size[2] / 2
    area, height = size[0] * size[1], 0.5 - low
    assert below["volume"] == pytest.approx(area * height)
    assert below["center"] == pytest.approx([5, 0, low + height / 2])
    assert below["face"]["area"] == pytest.approx(area)
    assert below["face"]["second_moments"][0][0] == pytest.approx(area * size[0] ** 2 / 12)
    assert 0 < below["error_bound"]["volume"] < 1e-11
    (row,) = csv.DictReader(io.StringIO("".join(to_csv([found]))))
    assert float(row["below_volume"]) == below["volume"]


def test_vessel_has_contents_and_a_table_in_the_report():
    add_box("Cup", (0, 0, 0), (2, 2, 2))
    cup = bpy.data.objects["Cup"]
    edited = bmesh.new()
    edited.from_mesh(cup.data)
    edited.faces.ensure_lookup_table()
    top = max(edited.faces, key=lambda face: face.calc_center_median().z)
    bmesh.ops.inset_individual(edited, faces=[top], thickness=0.5, use_even_offset=True)
    (bottom,) = bmesh.ops.extrude_discrete_faces(edited, faces=[top])["faces"]
    bmesh.ops.translate(edited, verts=bottom.verts, vec=(0, 0, -1.5))
    edited.to_mesh(cup.data)
    found = document("--below", "0")
    contents = found["objects"][0]["below"]["contents"]
    assert contents["volume"] == pytest.approx(0.5)
    assert contents["capacity"] == pytest.approx(1.5)
    assert (contents["bottom"], contents["spill"]) == pytest.approx((-0.5, 1.0))
    assert contents["surface"]["second_moments"][0][0] == pytest.approx(1 / 12)
    assert contents["table"]["volumes"][16] == pytest.approx(0.75)
    assert "Volume over level, 0 to 1.5 m³" in "".join(to_html([found]))
    (row,) = csv.DictReader(io.StringIO("".join(to_csv([found]))))
    assert float(row["below_contents_capacity"]) == contents["capacity"]


def test_plane_beside_a_body_is_an_error():
    add_box("Box")
    found = document("--below", "-77")
    assert found["objects"][0]["below"] is None
    assert "misses" in found["errors"][0]["reason"] and found["errors"][0]["name"] == "Box"


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_slope_against_heights_planes_and_surfaces(scale):
    bpy.context.scene.unit_settings.scale_length = scale
    add_grid("Slope", lambda x, y: x, (0, 0, 3))
    add_grid("Flat", lambda x, y: 0 * x, (50, 0, 3), 1.0)
    add_grid("Other", lambda x, y: np.where(np.abs(x) > 0.9, x + 1.0, x - 1.0), (0, 0, 3))
    plane = add(None, "Empty", location=(7, 7, 3))
    assert plane.type == "EMPTY"
    volume = 1.0 * scale**3
    for against in (3 * scale, "Flat", "Empty", "rim"):
        found = document("--object", "Slope", "--against", str(against))["objects"][0]["cut_fill"]
        if against == "rim":
            assert found["cut"]["volume"] < 1e-6 * volume
            assert abs(found["plane"]["normal"][0] + 0.5**0.5) < 1e-6
            continue
        assert found["cut"]["volume"] == pytest.approx(volume, rel=1e-6)
        assert found["fill"]["volume"] == pytest.approx(volume, rel=1e-6)
        assert found["cut"]["area"] == pytest.approx(2.0 * scale**2, rel=1e-6)
    found = document("--object", "Slope", "--against", "Other")["objects"][0]["cut_fill"]
    assert found["plane"] is None and found["compared"] == pytest.approx(1.0)
    assert found["net"] == pytest.approx(2.0 * scale**3, rel=1e-6)


def test_closed_body_and_missing_object_are_errors():
    add_box("Box")
    for against, reason in (("0", "closed"), ("Nothing", "“Nothing”"), ("rim", "no rim")):
        found = document("--against", against)
        assert found["objects"][0]["cut_fill"] is None
        assert reason in found["errors"][0]["reason"]


def test_sheet_that_does_not_float_keeps_its_cut_and_fill():
    add_grid("Slope", lambda x, y: x, (0, 0, 3))
    found = document("--against", "3", "--float", "Water")
    (entry,) = found["objects"]
    assert entry["cut_fill"]["cut"]["volume"] == pytest.approx(1.0, rel=1e-6)
    assert entry["floating"] is None
    assert [error["name"] for error in found["errors"]] == ["Slope"]


def test_solid_without_a_volume_is_refused():
    add_box("Box").body_moments.kind = "SHELL"
    (error,) = document("--below", "0")["errors"]
    assert "No level" in error["reason"]


@pytest.mark.parametrize("height", [1e49, -1e49, 1e50, -1e300])
def test_surface_against_a_far_height_is_exact_or_refused(height):
    add_grid("Flat", lambda x, y: 0 * x)
    found = document("--against", repr(height))
    cut_fill = found["objects"][0]["cut_fill"]
    if abs(height) >= 1e50:
        assert cut_fill is None and "too far away" in found["errors"][0]["reason"]
        return
    assert cut_fill["net"] == pytest.approx(-4.0 * height)
    side = cut_fill["fill" if height > 0 else "cut"]
    assert side["center"] == pytest.approx([0, 0, height / 2], abs=abs(height) * 1e-12)
    assert np.isfinite(cut_fill["error_bound"]["net"])
