# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places, weights and times of glTF files, against the product of their nodes.

The body is a box of 6 m3, centered at (0.5, 1, 1.5); y is up in the file, and z in the results.
"""

import base64
import json
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from tests.blender.batch_files import codes, document, run, write_text
from tests.close import close

pytestmark = pytest.mark.usefixtures("registered")
BOX = np.array([(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)], np.float32)
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
FACES = np.array([(q[0], q[i], q[i + 1]) for q in QUADS for i in (1, 2)], np.uint16)
WIDER = np.where(BOX > 0, [[1, 0, 0]], 0).astype(np.float32)  # per weight: the box is 1 m longer
CENTER = np.array([0.5, 1.0, 1.5, 1.0])
# Two turns, unequal scales and a mirror: their product shears.
TURNED = {"rotation": [0.0, 0.0, sin(0.4), cos(0.4)], "translation": [100.5, -20.25, 3.0]}
STRETCHED = {"scale": [-3.0, 1.0, 0.5], "rotation": [sin(0.3), 0.0, 0.0, cos(0.3)]}
SHEAR = [1.0, 0, 0, 0, 0.5, 2, 0, 0, 0, 0, 3, 0, 10, 20, 30, 1]  # by columns


def measure(tmp_path, nodes, *options, weights=None, animation=(), arrays=(), more=()):
    """Measure a file. arrays: further accessors, from number 3. animation: (path, times, values,
    interpolation) of node 0, with accessors behind these.
    """
    blob = b""
    accessors, views, channels, samplers = [], [], [], []

    def add(values, kind="<f4"):
        nonlocal blob
        values = np.asarray(values, kind)
        rows = values.reshape(-1, values.shape[-1] if values.ndim > 1 else 1)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": values.nbytes})
        blob += values.tobytes() + bytes(-values.nbytes % 4)
        name = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[rows.shape[1]]
        number = {"<f4": 5126, "<u2": 5123}[kind]
        accessors.append({"bufferView": len(views) - 1, "componentType": number, "type": name})
        accessors[-1] |= {"count": len(rows), "min": rows.min(0).tolist()}
        accessors[-1] |= {"max": rows.max(0).tolist()}
        return len(accessors) - 1

    part = {"attributes": {"POSITION": add(BOX)}, "indices": add(FACES.ravel(), "<u2")}
    target = add(WIDER)
    mesh = {"primitives": [part]}
    if weights is not None:
        part["targets"] = [{"POSITION": target}]
        mesh["weights"] = [weights]
    for values in arrays:
        add(values, "<u2" if np.asarray(values).dtype == np.uint16 else "<f4")
    for path, times, values, kind in animation:
        samplers.append({"input": add(times), "output": add(values), "interpolation": kind})
        where = {"node": 0, "path": path}
        channels.append({"sampler": len(samplers) - 1, "target": where})
    uri = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
    below = {child for node in nodes for child in node.get("children", ())}
    file = {"asset": {"version": "2.0"}, "bufferViews": views, "accessors": accessors}
    file |= {"buffers": [{"byteLength": len(blob), "uri": uri}], "meshes": [mesh], "nodes": nodes}
    file |= {"scene": 0, "scenes": [{"nodes": [n for n in range(len(nodes)) if n not in below]}]}
    if channels:
        file["animations"] = [{"channels": channels, "samplers": samplers}]
    path = write_text(tmp_path / "t.gltf", json.dumps(file | dict(more)))
    found = document(path, "--density", "1", *options)
    assert found["errors"] == []
    return found["objects"]


def matrix_of(node):
    if "matrix" in node:
        return np.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    axes = 2.0 * np.outer((x, y, z), (x, y, z)) + (2.0 * w * w - 1.0) * np.eye(3)
    axes += 2.0 * w * np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    matrix = np.eye(4)
    matrix[:3, :3] = axes * np.array(node.get("scale", (1, 1, 1)))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


SKINS = {
    "turned": [TURNED, {"rotation": [0, sin(0.2), 0, cos(0.2)], "translation": [0, 0.5, 0]}],
    "stretched": [{"scale": [1, 1, 3]}, {"rotation": [sin(0.2), 0, 0, cos(0.2)]}],
    "mirrored": [STRETCHED, {"scale": [1, 2, 1]}],
    "sheared": [{"matrix": SHEAR}, {"translation": [0, 0, 0.5]}],
    "animated": [{}, {"scale": [9, 9, 9]}],
}


@pytest.mark.parametrize("case", SKINS)
@pytest.mark.parametrize("is_bound", [False, True])
def test_gltf_skin_follows_joints_and_inverse_bind_matrices(tmp_path, case, is_bound):
    outer, inner = SKINS[case]
    mesh = {"mesh": 0, "skin": 0, "translation": [50, 0, 0]}  # which joints override
    nodes = [{**inner, "name": "b"}, {**outer, "children": [0], "name": "a"}, mesh]
    joints = np.tile([0, 1, 0, 0], (8, 1)).astype(np.uint16)
    weights = np.tile([[1, 0, 0, 0], [0.25, 0.75, 0, 0]], (4, 1))  # at the bottom, at the top
    binds = [np.diag([2.0, 1.0, 0.5, 1.0]), matrix_of({"rotation": [0, 0, sin(0.2), cos(0.2)]})]
    skin = {"joints": [0, 1]} | ({"inverseBindMatrices": 5} if is_bound else {})
    attributes = {"POSITION": 0, "JOINTS_0": 3, "WEIGHTS_0": 4}
    meshes = [{"primitives": [{"attributes": attributes, "indices": 1}]}]
    animation = [("scale", [1, 2], [[2, 3, 1], [1, 1, 1]], "LINEAR")] if case == "animated" else ()
    arrays = [joints, weights, np.array([bind.T.ravel() for bind in binds])]
    more = {"skins": [skin], "meshes": meshes}.items()
    (body,) = measure(tmp_path, nodes, animation=animation, arrays=arrays, more=more)
    own = matrix_of({"scale": [2, 3, 1]} if case == "animated" else inner)
    places = np.array([matrix_of(outer) @ own, matrix_of(outer)]) @ (
        binds if is_bound else np.eye(4)
    )
    whole = np.column_stack([BOX, np.ones(8)])
    moved = np.einsum("vj,jab,vb->va", weights[:, :2], places, whole)[:, :3]
    volume = np.linalg.det(moved[FACES.astype(int)]).sum() / 6.0
    assert close(abs(body["volume"]), abs(volume), 1e-5)
    assert "places_unchecked" not in codes(body)


def upright(point):
    return np.array([point[0], -point[2], point[1]])


@pytest.mark.parametrize("far", [0.0, 12345678.3])
@pytest.mark.parametrize("outer", [TURNED, STRETCHED, {"matrix": SHEAR}])
@pytest.mark.parametrize("inner", [{}, STRETCHED, {"matrix": SHEAR}])
def test_gltf_place_is_the_product_of_the_nodes(tmp_path, outer, inner, far):
    nodes = [{"mesh": 0, **inner}, {"children": [0], **outer}]
    nodes.append({"children": [1], "translation": [far, 0, -far]})
    place = matrix_of(nodes[2]) @ matrix_of(outer) @ matrix_of(inner)
    (body,) = measure(tmp_path, nodes)
    assert close(body["volume"], 6.0 * abs(np.linalg.det(place)), 1e-12)
    size = np.abs(place).max()
    assert np.allclose(body["center_of_mass"], upright(place @ CENTER), atol=1e-15 * size, rtol=0)


def test_gltf_instances_stand_where_the_file_states(tmp_path):
    arrays = [[[5, 0, 0], [0, 7, 0]], [[0, 0, sin(0.5), cos(0.5)], [0, 0, 0, 1]]]
    arrays.append([[1, 2, 1], [-1, 1, 1]])
    places = {"TRANSLATION": 3, "ROTATION": 4, "SCALE": 5}
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": places}}
    nodes = [{"mesh": 0, "extensions": instancing, **STRETCHED}]
    bodies = measure(tmp_path, nodes, arrays=arrays, more={"extensionsUsed": [*instancing]}.items())
    stated = []
    for move, turn, scale in zip(*arrays, strict=True):
        own = matrix_of({"translation": move, "rotation": turn, "scale": scale})
        stated.append(upright(matrix_of(STRETCHED) @ own @ CENTER).tolist())
    found = sorted(body["center_of_mass"] for body in bodies)
    assert np.allclose(found, sorted(stated), atol=1e-5)


@pytest.mark.parametrize("levels", [[1, 3], [3, 1]])
def test_gltf_levels_of_detail_count_once(tmp_path, levels):
    nodes = [{"mesh": 0, "extensions": {"MSFT_lod": {"ids": levels}}}, {"mesh": 0}, {"mesh": 0}]
    nodes.append({"mesh": 0, "children": [4]})
    nodes.append({"mesh": 0})
    used = {"extensionsUsed": ["MSFT_lod"]}.items()
    bodies = measure(tmp_path, nodes, more=used)
    assert [body["volume"] for body in bodies] == [6.0, 6.0]


@pytest.mark.parametrize("weight", [0.5, 9.75, 20.0, -15.0, 1000.0])
def test_gltf_weight_of_any_size_moves_the_target(tmp_path, weight):
    nodes = [{"mesh": 0}, {"mesh": 0, "weights": [-weight], "translation": [5000.0, 0, 0]}]
    first, second = measure(tmp_path, nodes, weights=weight)
    for body, length in ((first, 1.0 + weight), (second, 1.0 - weight)):
        assert close(body["volume"], 6.0 * abs(length), 1e-5)


@pytest.mark.parametrize(
    ("options", "weight"), [((), 0.0), (("--at-frame", "24"), 4.0), (("--frame", "36"), 17.0)]
)
def test_gltf_weights_are_those_of_the_frame(tmp_path, options, weight):
    weights = "weights", [0, 1, 2], [0, 4, 30], "LINEAR"
    (body,) = measure(tmp_path, [{"mesh": 0}], *options, weights=9.0, animation=[weights])
    assert close(body["volume"], 6.0 * (1.0 + weight), 1e-5) and "frame_measured" in codes(body)


@pytest.mark.parametrize(("kind", "share"), [("STEP", 0.0), ("LINEAR", 0.25)])
def test_gltf_nodes_between_keys_follow_the_interpolation(tmp_path, kind, share):
    angle = 0.9 * pi
    sizes = [[1, 1, 1], [5, 1, 1]]
    turns = [[0, 0, 0, 1], [0, 0, sin(angle / 2), cos(angle / 2)]]
    animation = [("scale", [1, 2], sizes, kind), ("rotation", [1, 2], turns, kind)]
    nodes = [{"mesh": 0}, {"children": [0], **TURNED}]
    (body,) = measure(tmp_path, nodes, "--frame", "30", animation=animation)
    half = share * angle / 2.0
    own = {"scale": [1.0 + 4.0 * share, 1, 1], "rotation": [0, 0, sin(half), cos(half)]}
    place = matrix_of(TURNED) @ matrix_of(own)
    assert close(body["volume"], 6.0 * (1.0 + 4.0 * share), 1e-6)
    assert np.allclose(body["center_of_mass"], upright(place @ CENTER), atol=1e-5)


def test_gltf_cubic_spline_is_followed_between_keys(tmp_path):
    still = [0, 0, 0]
    keys = [[still, still, [64, 0, 0]], [[0, 64, 0], [0, 0, 64], still]]
    animation = [("translation", [1, 2], keys, "CUBICSPLINE")]
    (body,) = measure(tmp_path, [{"mesh": 0}], "--frame", "30", animation=animation)
    # At a quarter: 9 / 64 of the first tangent, -3 / 64 of the last, 10 / 64 of the last value.
    move = upright([9.0, -3.0, 10.0])
    assert np.allclose(body["center_of_mass"], upright(CENTER) + move, atol=1e-5)


def test_gltf_animation_is_measured_at_its_first_key(tmp_path):
    scale = "scale", [0.5, 1.5], [[2, 2, 2], [3, 3, 3]], "LINEAR"
    (body,) = measure(tmp_path, [{"mesh": 0}], animation=[scale])
    (note,) = body["notes"]
    assert close(body["volume"], 48.0, 1e-6) and "12" in note


@pytest.mark.parametrize(
    "words",
    [("--frame", "1e9"), ("--at-frame", "x"), ("--at-frame", "2", "--write"), ("--frame", "x")],
)
def test_frame_that_cannot_be_measured_is_refused(tmp_path, words):
    with pytest.raises(SystemExit, match="2"):
        run(*words, tmp_path / "t.gltf")


def test_frame_of_reference_and_frame_of_time_go_together(tmp_path):
    size = sqrt(2.0)
    scale = "scale", [0, 1], [[1, 1, 1], [size, 1, 1]], "LINEAR"
    words = "--frame", "object", "--frame", "24"
    (body,) = measure(tmp_path, [{"mesh": 0, **TURNED}], *words, animation=[scale])
    assert np.allclose(body["center_of_mass"], upright(CENTER * [size, 1, 1, 1]), atol=1e-5)


def test_gltf_compressed_animation_is_doubtful(tmp_path):
    scale = "scale", [1, 2], [[2, 2, 2], [3, 3, 3]], "LINEAR"
    measure(tmp_path, [{"mesh": 0}], animation=[scale])
    path = tmp_path / "t.gltf"
    file = json.loads(path.read_text())
    extension = {"buffer": 0, "byteLength": 24, "byteStride": 12, "count": 2, "mode": "ATTRIBUTES"}
    file["bufferViews"][-1]["extensions"] = {"EXT_meshopt_compression": extension}
    write_text(path, json.dumps(file | {"extensionsUsed": ["EXT_meshopt_compression"]}))
    found = document(path)
    if found["errors"]:
        assert "meshopt" in str(found["errors"]).lower()
    else:
        (body,) = found["objects"]
        assert "places_unchecked" in codes(body) and body["verdict"] != "exact"
