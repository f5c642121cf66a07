# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""USD on the command line: round solids, shear, subdivision, and prims that are not rendered."""

from math import pi

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from tests.blender.batch_files import codes, sentence
from tests.close import close
from tests.command.usd_files import MATRIX, by_name, measure, moved, prim

pytestmark = [
    pytest.mark.usefixtures("registered"),
    pytest.mark.skipif(not bpy.app.usd.supported, reason="this Blender is built without USD"),
]
BALL = 4.0 * pi / 3.0
CAGE = """
    int[] faceVertexCounts = [3, 3, 3, 3]
    int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
"""
PLAIN = 'uniform token subdivisionScheme = "none"' + CAGE


# kind, attributes, volume, and the center of mass along the axis
SOLIDS = [
    ("Sphere", {"radius": 3}, 27 * BALL, 0.0),
    ("Capsule", {"radius": 1, "height": 4}, BALL + 4 * pi, 0.0),
    ("Cylinder", {"radius": 2, "height": 5}, 20 * pi, 0.0),
    ("Cone", {"radius": 2, "height": 5}, 20 * pi / 3, -1.25),
    ("Cone", {"radius": 2, "height": -5}, 20 * pi / 3, 1.25),
    ("Capsule_1", {"radiusTop": 1, "radiusBottom": -2, "height": 0}, 6 * pi, -0.625),
    ("Capsule_1", {"radiusTop": 1, "radiusBottom": 1, "height": 4}, BALL + 4 * pi, 0.0),
    ("Cylinder_1", {"radiusTop": 0, "radiusBottom": 2, "height": 5}, 20 * pi / 3, -1.25),
]


@pytest.mark.parametrize("kind, sizes, volume, center", SOLIDS)
def test_round_usd_solids_match_closed_forms(tmp_path, kind, sizes, volume, center):
    lines = ["double {} = {}".format(*pair) for pair in sizes.items()]
    axes = ["X", "Y", "Z"] if "height" in sizes else [""]
    turns = {axis: 'uniform token axis = "{}"'.format(axis) if axis else "" for axis in axes}
    found = measure(
        tmp_path,
        *(prim(kind, "Plain" + axis, *lines, turn) for axis, turn in turns.items()),
        prim(
            "Xform",
            "Top",
            moved(),
            *(prim(kind, "Turned" + axis, *lines, turn) for axis, turn in turns.items()),
        ),
        up="Y",
        unit=0.01,
    )
    matrix = np.diag([0.01, 0.01, 0.01, 1.0]) @ [
        [1, 0, 0, 0],
        [0, 0, -1, 0],
        [0, 1, 0, 0],
        [0, 0, 0, 1],
    ]
    for name, entry in by_name(found).items():
        place = matrix @ (np.array(MATRIX, float).T if name.startswith("Turned") else np.eye(4))
        axis = np.eye(3)["XYZ".index(name[-1])] if name[-1] in axes else np.zeros(3)
        assert entry["method"] == "NURBS exact" and entry["warnings"] == []
        assert close(entry["volume"], volume * abs(np.linalg.det(place[:3, :3])), 1e-6)
        truth = place[:3, :3] @ (center * axis) + place[:3, 3]
        assert np.abs(np.array(entry["center_of_mass"]) - truth).max() <= 1e-6


def test_sheared_usd_meshes_and_solids_keep_their_shear(tmp_path):
    turned = prim(
        "Xform",
        "Top",
        moved(),
        prim("Mesh", "Mesh", PLAIN),
        prim("Sphere", "Ball", "double radius = 1"),
    )
    found = by_name(measure(tmp_path, turned))
    assert close(found["Mesh"]["volume"], 1.0, 1e-6) and close(
        found["Ball"]["volume"], 6 * BALL, 1e-6
    )
    matrix = np.array(MATRIX, float)
    assert close(
        found["Mesh"]["center_of_mass"], np.array([0.25, 0.25, 0.25, 1.0]) @ matrix[:, :3], 1e-6
    )
    second = 6 * BALL / 5.0 * matrix[:3, :3].T @ matrix[:3, :3]
    inertia = np.trace(second) * np.eye(3) - second
    assert np.abs(inertia - found["Ball"]["inertia"]).max() <= 1e-7 * np.trace(second)


def test_instances_of_usd_solids_are_measured_with_them(tmp_path):
    arcs = "(\n instanceable = true\n inherits = </Ball>\n)\n"
    model = 'class Xform "Ball" {\n' + prim("Sphere", "S", "double radius = 1") + "}\n"
    (entry,) = measure(tmp_path, model, prim("Xform", "A", arcs=arcs))["objects"]
    assert entry["name"] == "A" and close(entry["volume"], BALL, 1e-7)
    model = model.replace("double", 'token visibility = "invisible"\ndouble')
    found = measure(tmp_path, model, prim("Xform", "A", arcs=arcs), prim("Mesh", "Mesh", PLAIN))
    assert list(by_name(found)) == ["Mesh"] and [entry["name"] for entry in found["left_out"]] == [
        "S"
    ]


@pytest.mark.parametrize(
    "scheme, warned", [("catmullClark", True), ("loop", True), (None, True), ("none", False)]
)
def test_usd_subdivision_cages_are_reported(tmp_path, scheme, warned):
    line = 'uniform token subdivisionScheme = "{}"'.format(scheme) if scheme else ""
    (entry,) = measure(tmp_path, prim("Mesh", "Cage", CAGE, line))["objects"]
    assert ("usd_cage" in codes(entry)) is warned


def test_usd_prims_that_are_not_rendered_are_left_out(tmp_path):
    hide = 'token visibility = "invisible"'
    prims = [
        prim("Mesh", "Shown", PLAIN),
        prim("Mesh", "Render", PLAIN, 'uniform token purpose = "render"'),
        prim("Mesh", "Hidden", PLAIN, hide),
        prim("Xform", "Top", hide, prim("Mesh", "Below", PLAIN), prim("Sphere", "Ball")),
        prim("Mesh", "Proxy", PLAIN, 'uniform token purpose = "proxy"'),
        prim("Xform", "Guides", 'uniform token purpose = "guide"', prim("Mesh", "Guide", PLAIN)),
    ]
    found = measure(tmp_path, *prims)
    assert list(by_name(found)) == ["Render", "Shown"]
    causes = dict.fromkeys(["Ball", "Below", "Hidden"], "it is invisible")
    causes |= {"Proxy": "its purpose is proxy", "Guide": "its purpose is guide"}
    left_out = {entry["name"]: entry["reason"] for entry in found["left_out"]}
    assert left_out == {name: sentence("file_hides", cause=cause) for name, cause in causes.items()}
    every = measure(tmp_path, *prims, options=["--all"])
    assert set(by_name(every)) == {"Render", "Shown", *causes} and every["left_out"] == []
    assert close(by_name(every)["Ball"]["volume"], BALL, 1e-7)


@pytest.mark.parametrize("kind", ["NurbsPatch", "TetMesh"])
def test_usd_shapes_that_blender_leaves_out_are_errors(tmp_path, kind):
    prims = [
        prim("Mesh", "Shown", PLAIN),
        prim(kind, "Lost"),
        prim(kind, "Hidden", 'token visibility = "invisible"'),
    ]
    (error,) = measure(tmp_path, *prims, is_whole=False)["errors"]
    assert error["reason"] == sentence("usd_unread", names=["/Lost ({})".format(kind)])
