# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Place, time and members of imported files, against what the file states.

The body is a box of 6 m3, centered at (0.5, 1, 1.5), mapped by affine maps in closed form.
"""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from tests.blender.batch_files import codes
from tests.close import close
from tests.command.usd_files import by_name, measure, moved, prim

pytestmark = [
    pytest.mark.usefixtures("registered"),
    pytest.mark.skipif(not bpy.app.usd.supported, reason="this Blender is built without USD"),
]
BOX = """
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0,1,3,2, 4,6,7,5, 0,4,5,1, 2,3,7,6, 0,2,6,4, 1,5,7,3]
    point3f[] points = [(0,0,0), (0,0,3), (0,2,0), (0,2,3), (1,0,0), (1,0,3), (1,2,0), (1,2,3)]
"""
MESH = 'uniform token subdivisionScheme = "none"' + BOX
CENTER = np.array([0.5, 1.0, 1.5])
SHEAR = np.array([[2.0, 0, 0, 0], [1, 1, 0, 0], [0, 0, 1, 0], [3, 4, 5, 1]])  # of rows, as in USD
SCALE = np.diag([2.0, 2, 2, 1])
# The rotation that the importer applies to files with y up.
TURNS = {"Z": np.eye(3), "Y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])}


def rows(matrix):
    return moved(tuple(map(tuple, matrix.tolist())))


def instancer(matrix, *children, target="/W/i/m", more=""):
    values = (
        "rel prototypes = <{}>".format(target),
        "int[] protoIndices = [0, 0]",
        "point3f[] positions = [(0, 0, 0), (10, 0, 0)]",
        more,
        rows(matrix),
    )
    return prim("PointInstancer", "i", *values, *children)


@pytest.mark.parametrize("up", "ZY")
@pytest.mark.parametrize("outer", [np.eye(4), SCALE, SHEAR])
@pytest.mark.parametrize("inner", [np.eye(4), SCALE, SHEAR, np.diag([-1.0, 2, 1, 1])])
def test_usd_instances_stand_where_the_file_states(tmp_path, outer, inner, up):
    world = prim("Xform", "W", instancer(outer, prim("Mesh", "m", MESH, rows(inner))))
    total = measure(tmp_path, world, up=up)["total"]
    volume = 12.0 * abs(np.linalg.det(outer) * np.linalg.det(inner))
    local = np.append(CENTER, 1.0) @ inner + [5.0, 0, 0, 0]
    assert close(total["volume"], volume, 1e-6)
    assert np.allclose(total["center_of_mass"], TURNS[up] @ (local @ outer)[:3], atol=1e-5)


@pytest.mark.parametrize("outer", [SCALE, SHEAR])
def test_usd_reset_of_transforms_leaves_out_the_parents(tmp_path, outer):
    reset = 'double3 xformOp:translate = (5, 0, 0)\nuniform token[] xformOpOrder = ["{}", "{}"]'
    reset = reset.format("!resetXformStack!", "xformOp:translate")
    found = measure(tmp_path, prim("Xform", "W", rows(outer), prim("Mesh", "m", MESH, reset)))
    assert close(found["total"]["volume"], 6.0, 1e-6)
    assert np.allclose(found["total"]["center_of_mass"], CENTER + [5, 0, 0], atol=1e-6)


def test_usd_place_is_read_in_double_precision(tmp_path):
    place = np.eye(4)
    place[3, :3] = 12345678.3, -0.1, 1234.5678
    found = measure(tmp_path, prim("Mesh", "m", MESH, rows(place)))
    (body,) = found["objects"]
    assert np.allclose(body["center_of_mass"], CENTER + place[3, :3], rtol=0.0, atol=1e-8)


def test_usd_prototype_shows_what_the_file_renders_of_it(tmp_path):
    parts = (
        prim("Mesh", "a", MESH),
        prim("Mesh", "b", MESH, 'token visibility = "invisible"'),
        prim("Xform", "c", 'uniform token purpose = "guide"', prim("Mesh", "d", MESH)),
    )
    group = prim("Xform", "m", *parts), prim("Mesh", "stray", MESH)
    found = measure(tmp_path, prim("Xform", "W", instancer(np.eye(4), *group)))
    assert [*by_name(found)] == ["i"] and close(found["total"]["volume"], 12.0, 1e-6)
    assert {entry["name"] for entry in found["left_out"]} == {"a", "b", "d", "stray"}
    assert not any("camera" in entry["reason"] for entry in found["left_out"])


def test_usd_prototype_outside_of_its_instancer_counts(tmp_path):
    world = prim("Mesh", "p", MESH) + instancer(np.eye(4), target="/W/p")
    found = measure(tmp_path, prim("Xform", "W", world))
    volumes = {name: body["volume"] for name, body in by_name(found).items()}
    assert close(volumes.pop("p"), 6.0, 1e-6)
    assert close(volumes.pop("i"), 12.0, 1e-6) and not volumes


def test_usd_mask_of_an_instancer_hides_instances(tmp_path):
    more = "int64[] invisibleIds = [1]"
    world = prim("Xform", "W", instancer(np.eye(4), prim("Mesh", "m", MESH), more=more))
    assert close(measure(tmp_path, world)["total"]["volume"], 6.0, 1e-6)


def test_usd_prototype_that_is_a_cage_is_reported(tmp_path):
    found = measure(tmp_path, prim("Xform", "W", instancer(np.eye(4), prim("Mesh", "m", BOX))))
    assert "usd_cage" in codes(found["objects"][0])


@pytest.mark.parametrize(
    ("options", "size"),
    [((), 2.0), (("--frame", "20"), 5.0), (("--at-frame", "11.333333333333"), 3.0)],
)
def test_animated_usd_is_measured_at_its_frame(tmp_path, options, size):
    samples = "double3 xformOp:scale.timeSamples = {7: (2, 1, 1), 20: (5, 1, 1)}"
    order = 'uniform token[] xformOpOrder = ["xformOp:scale"]'
    found = measure(tmp_path, prim("Mesh", "m", MESH, samples, order), options=options)
    (body,) = found["objects"]
    assert close(body["volume"], 6.0 * size, 1e-6) and "frame_measured" in codes(body)
    assert close(body["center_of_mass"][0], size / 2.0, 1e-6)


def test_animated_points_of_usd_are_those_between_samples(tmp_path):
    wide = BOX.partition("points = ")[2].replace("(1,", "(5,")
    points = BOX.replace("points = ", "points.timeSamples = {{0: ").rstrip() + ", 8: {} }}"
    lines = 'uniform token subdivisionScheme = "none"', points.format(wide)
    found = measure(tmp_path, prim("Mesh", "m", *lines), options=("--frame", "2"))
    assert close(found["objects"][0]["volume"], 12.0, 1e-6)
