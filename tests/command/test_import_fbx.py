# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places, levels of detail and hidden nodes of FBX files, against what their models state.

The body is a box of 6 m3, centered at (0.5, 1, 1.5), in a file in centimeters with z up.
"""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from mathutils import Matrix, Quaternion

from tests.blender import batch_files as files
from tests.blender.batch_files import codes, document, measured
from tests.close import close

pytestmark = [
    pytest.mark.usefixtures("registered"),
    pytest.mark.skipif(not hasattr(bpy.ops.wm, "fbx_import"), reason="no importer in C++"),
]
BOX = np.array([(x, y, z) for x in (0, 100) for y in (0, 200) for z in (0, 300)], float)
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
CORNERS = [corner for a, b, c, d in QUADS for corner in (a, b, c, -d - 1)]
CENTER = np.array([50.0, 100.0, 150.0])
AXES = {"Up": (2, 1), "Front": (1, -1), "Coord": (0, 1)}
Y_UP = {"Up": (1, 1), "Front": (2, 1), "Coord": (0, 1)}
TURNS = "Lcl Rotation", "PreRotation", "PostRotation"
MOVES = "Lcl Translation", "RotationOffset", "RotationPivot", "ScalingOffset", "ScalingPivot"
ACTIVE = {"RotationActive": 1, "InheritType": 1}
SKIN = 'Deformer: 80, "Deformer::", "Skin" {\nVersion: 101\n}\n'
CLUSTER = """\
Deformer: {}, "SubDeformer::", "Cluster" {{
Indexes: *8 {{
a: 0,1,2,3,4,5,6,7
}}
Weights: *8 {{
a: {}
}}
Transform: *16 {{
a: {}
}}
TransformLink: *16 {{
a: {}
}}
}}
"""
# an animation of a property, keyed at 0 and 1 s
ANIMATION = """\
AnimationStack: 93, "AnimStack::a", "" {{
}}
AnimationLayer: 94, "AnimLayer::l", "" {{
}}
AnimationCurveNode: 95, "AnimCurveNode::{}", "" {{
Properties70: {{
{}}}
}}
"""
CURVE = """\
AnimationCurve: {}, "AnimCurve::", "" {{
KeyTime: *2 {{
a: 0,46186158000
}}
KeyValueFloat: *2 {{
a: {},0
}}
KeyAttrFlags: *1 {{
a: {}
}}
KeyAttrDataFloat: *4 {{
a: {}
}}
KeyAttrRefCount: *1 {{
a: 2
}}
}}
"""
SHAPE = """\
Geometry: 90, "Geometry::s", "Shape" {{
Version: 100
Indexes: *4 {{
a: 4,5,6,7
}}
Vertices: *12 {{
a: 100,0,0,100,0,0,100,0,0,100,0,0
}}
}}
Deformer: 91, "Deformer::b", "BlendShape" {{
Version: 100
}}
Deformer: 92, "SubDeformer::s", "BlendShapeChannel" {{
Version: 100
FullWeights: *1 {{
a: 100
}}
Properties70: {{
{}}}
}}
"""


def property_line(name, value):
    numbers = ",".join(map(repr, np.ravel(value).tolist()))
    return 'P: "{}", "", "", "A",{}\n'.format(name, numbers)


def write(path, models, axes=AXES, unit=1.0, more="", more_links="", ahead="", rate=0):
    """Write a text file. models: (name, kind, properties, number of the parent or 0), from number
    2; a mesh shows the box. ahead: text before the objects. rate: the number of a frame rate.
    """
    settings = {"UnitScaleFactor": unit, "TimeMode": rate}
    for name, (axis, sign) in axes.items():
        settings |= {name + "Axis": axis, name + "AxisSign": sign}
    text = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\n"
    text += "GlobalSettings: {\nProperties70: {\n{}}}\n}}\nObjects: {{\n".replace("{\n", "{{\n", 2)
    text = text.replace("Extension: {\n", "Extension: {{\n").replace("7400\n}", "7400\n}}")
    text = text.format("".join(property_line(*pair) for pair in settings.items()))
    text += 'Geometry: 1, "Geometry::g", "Mesh" {\nVertices: *24 {\na: '
    text += ",".join(map(repr, BOX.ravel().tolist())) + "\n}\nPolygonVertexIndex: *24 {\na: "
    text += ",".join(map(str, CORNERS)) + "\n}\nGeometryVersion: 124\n}\n"
    links = ""
    for number, (name, kind, properties, parent) in enumerate(models, 2):
        lines = "".join(property_line(*pair) for pair in properties.items())
        text += 'Model: {}, "Model::{}", "{}" {{\n'.format(number, name, kind)
        text += "Version: 232\nProperties70: {\n" + lines + "}\n}\n"
        links += 'C: "OO",{},{}\n'.format(number, parent)
        links += 'C: "OO",1,{}\n'.format(number) if kind == "Mesh" else ""
    text = text.replace("Objects: {", ahead + "Objects: {")
    return files.write_text(path, text + more + "}\nConnections: {\n" + links + more_links + "}\n")


def with_shape(text, links, weight):
    """Add a shape that makes the box 1 m longer per weight."""
    links += 'C: "OO",91,1\nC: "OO",92,91\nC: "OO",90,92\n'
    return text + SHAPE.format(property_line("DeformPercent", 100 * weight)), links


def animation(target, name, values, flags=260, data="0,0,0,0"):
    """Key the numbers of a property at 0 s, and 0 at 1 s."""
    channels = ["d|" + axis for axis in ("XYZ" if len(values) == 3 else [name])]
    rest = "".join(property_line(channel, 0.0) for channel in channels)
    text = ANIMATION.format(name.replace("Lcl Rotation", "R"), rest)
    links = 'C: "OO",94,93\nC: "OO",95,94\nC: "OP",95,{}, "{}"\n'.format(target, name)
    for number, (channel, value) in enumerate(zip(channels, values, strict=True), 96):
        text += CURVE.format(number, value, flags, data)
        links += 'C: "OP",{},95, "{}"\n'.format(number, channel)
    return text, links


def matrix(linear, move):
    return np.vstack([np.column_stack([linear, move]), [0, 0, 0, 1]])


def by_name(found):
    assert found["errors"] == []
    return {entry["name"]: entry for entry in found["objects"]}


def draw(rng):
    properties = {name: rng.uniform(-150, 150, 3) for name in TURNS}
    properties |= {name: rng.uniform(-300, 300, 3) for name in MOVES}
    properties |= {"GeometricTranslation": rng.uniform(-300, 300, 3)}
    scale = rng.uniform(0.5, 2.0, 3) * rng.choice([-1, 1], 3)
    return properties | {"Lcl Scaling": scale, "RotationOrder": rng.integers(6)} | ACTIVE


@pytest.mark.parametrize("axes", [AXES, Y_UP])
@pytest.mark.parametrize("is_shared", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_fbx_chain_of_pivots_stands_where_ufbx_places_it(tmp_path, seed, is_shared, axes):
    rng = np.random.default_rng(seed)
    models = [("top", "Null", draw(rng), 0), ("part", "Mesh", draw(rng), 2)]
    models += [("below", "Mesh", draw(rng), 3)] * is_shared
    path = write(tmp_path / "t.fbx", models, axes, unit=2.54)
    bodies = by_name(document(path))
    files.empty_scene()
    bpy.ops.wm.fbx_import(filepath=path)
    bpy.context.view_layer.update()
    for obj in [obj for obj in bpy.data.objects if obj.type == "MESH"]:
        center = obj.matrix_world @ (sum((v.co for v in obj.data.vertices), 0 * obj.location) / 8)
        volume = 6e6 * abs(obj.matrix_world.determinant())
        body = bodies[obj.name]
        assert close(body["volume"], volume, 1e-5)
        assert np.allclose(body["center_of_mass"], center, atol=1e-4)
        assert "places_unchecked" not in codes(body)


@pytest.mark.parametrize("far", [0.0, 1234567830.0])
def test_fbx_place_has_the_digits_of_the_file(tmp_path, far):
    outer = {"Lcl Translation": [far, -20.0, 3.0], "Lcl Rotation": [0, 0, 30], **ACTIVE}
    inner = {"Lcl Translation": [0.1, 0.7, far], "Lcl Rotation": [10, 20, 30], **ACTIVE}
    inner["Lcl Scaling"] = [-3.0, 1.0, 0.5]
    path = write(tmp_path / "t.fbx", [("top", "Null", outer, 0), ("part", "Mesh", inner, 2)])
    body = measured(path)
    center = files.turn([10, 20, 30]) @ (CENTER * [-3, 1, 0.5]) + [0.1, 0.7, far]
    center = files.turn([0, 0, 30]) @ center + [far, -20, 3]
    assert close(body["volume"], 9.0, 1e-12)
    assert np.allclose(body["center_of_mass"], center / 100, rtol=0, atol=1e-12 + far * 1e-17)


@pytest.mark.parametrize("kind", [0, 1, 2])
def test_fbx_scale_is_inherited_as_the_file_states(tmp_path, kind):
    outer = {"Lcl Translation": [100, 0, 0], "Lcl Rotation": [0, 0, 90], "Lcl Scaling": [2, 3, 4]}
    inner = {"Lcl Translation": [10, 20, 30], "Lcl Rotation": [0, 0, 45], "Lcl Scaling": [5, 1, 1]}
    inner |= {"RotationActive": 1, "InheritType": kind}
    models = [("top", "Null", outer | ACTIVE, 0), ("part", "Mesh", inner, 2)]
    body = measured(write(tmp_path / "t.fbx", models))
    quarter, eighth = files.turn([0, 0, 90]), files.turn([0, 0, 45])
    parent, own = np.diag([2, 3, 4]), np.diag([5, 1, 1])
    linear = (
        quarter @ eighth @ parent @ own,
        quarter @ parent @ eighth @ own,
        quarter @ eighth @ own,
    )[kind]
    center = quarter @ parent @ [10, 20, 30] + [100, 0, 0] + linear @ CENTER
    assert close(body["volume"], 720.0 if kind < 2 else 30.0, 1e-9)
    assert np.allclose(body["center_of_mass"], center / 100, atol=1e-9)
    assert "places_unchecked" not in codes(body)


def test_fbx_scale_of_several_parents_is_doubtful(tmp_path):
    scaled = {"Lcl Scaling": [2, 2, 2], **ACTIVE}
    inner = {"RotationActive": 1, "InheritType": 2}
    models = [("top", "Null", scaled, 0), ("middle", "Null", scaled, 2), ("part", "Mesh", inner, 3)]
    body = measured(write(tmp_path / "t.fbx", models))
    assert "places_unchecked" in codes(body) and body["verdict"] != "exact"


@pytest.mark.parametrize("as_attribute", [True, False])
def test_fbx_levels_of_detail_count_once(tmp_path, as_attribute):
    attribute = 'NodeAttribute: 99, "NodeAttribute::", "LodGroup" {\nTypeFlags: "LodGroup"\n}\n'
    group = "group", "Null" if as_attribute else "LodGroup", {}, 0
    models = [group, ("empty", "Null", {}, 2), ("fine", "Null", {}, 2), ("part", "Mesh", {}, 4)]
    models += [("coarse", "Mesh", {}, 2), ("below", "Mesh", {}, 6), ("coarser", "Mesh", {}, 2)]
    more = (attribute, 'C: "OO",99,2\n') if as_attribute else ("", "")
    path = write(tmp_path / "t.fbx", models, more=more[0], more_links=more[1])
    found = document(path)
    assert [*by_name(found)] == ["part"] and close(found["total"]["volume"], 6.0, 1e-9)
    assert {entry["name"] for entry in found["left_out"]} == {"coarse", "below", "coarser"}
    assert all("level of detail" in entry["reason"] for entry in found["left_out"])
    assert len(document(path, "--all")["objects"]) == 4


def test_fbx_visibility_is_inherited(tmp_path):
    own = {"Visibility Inheritance": 0}
    models = [("top", "Null", {"Visibility": 0.0}, 0), ("hidden", "Mesh", {}, 2)]
    models += [("shown", "Mesh", own, 2), ("part", "Mesh", {}, 0)]
    found = document(write(tmp_path / "t.fbx", models))
    assert {*by_name(found)} == {"shown", "part"}
    (left_out,) = found["left_out"]
    assert left_out["name"] == "hidden" and "invisible" in left_out["reason"]


def test_fbx_of_equal_names_agrees_or_is_doubtful(tmp_path):
    moved = {"Lcl Translation": [1000, 0, 0], **ACTIVE}
    scaled = {"Lcl Scaling": [2, 2, 2], **ACTIVE}
    models = [("part", "Mesh", {}, 0), ("part", "Mesh", moved, 0)]
    found = document(write(tmp_path / "t.fbx", models))
    assert close(found["total"]["volume"], 12.0, 1e-6)
    assert close(found["total"]["center_of_mass"][0], 5.5, 1e-6)
    assert not any("places_unchecked" in codes(body) for body in found["objects"])
    models = [
        ("top", "Null", scaled, 0),
        *((one, kind, values, 2) for one, kind, values, _ in models),
    ]
    models[1][2].update({"InheritType": 2})
    bodies = document(write(tmp_path / "t.fbx", models))["objects"]
    assert any("places_unchecked" in codes(body) for body in bodies)


def test_binary_fbx_of_blender_agrees_with_its_nodes(tmp_path):
    files.empty_scene()
    rng = np.random.default_rng(7)
    parent = None
    for number in range(4):
        box = files.add_box("part.00{}".format(number))
        box.location, box.rotation_euler = rng.uniform(-9, 9, (2, 3))
        box.scale = rng.uniform(0.5, 2.0, 3) * [1, -1, 1]
        box.parent = parent
        parent = box
    bpy.context.view_layer.update()
    volumes = {obj.name: 6 * abs(obj.matrix_world.determinant()) for obj in bpy.data.objects}
    path = str(tmp_path / "t.fbx")
    bpy.ops.export_scene.fbx(filepath=path)
    bodies = by_name(document(path))
    assert {*bodies} == {*volumes}
    for name, body in bodies.items():
        assert "places_unchecked" not in codes(body)
        assert close(body["volume"], volumes[name], 1e-4)


def bits(*values):
    """Numbers of float32, as text files state them; whole ones are the lengths of tangents."""
    words = [
        value if isinstance(value, int) else np.float32(value).view(np.int32) for value in values
    ]
    return ",".join(map(str, [*words, 0, 0, 0, 0][:4]))


@pytest.mark.parametrize(
    ("flags", "data", "slopes", "lengths"),
    [
        (4, bits(), (-1, -1), (1 / 3, 1 / 3)),
        (0x108, bits(), (-1, -1), (1 / 3, 1 / 3)),
        (0x6108, bits(), (0, 0), (1 / 3, 1 / 3)),
        (0x408, bits(300.0, -500.0), (3, -5), (1 / 3, 1 / 3)),
        (0x3000C08, bits(300.0, -500.0, 8000 << 16 | 2500), (3, -5), (0.25, 0.8)),
        (0x208, bits(0.5, 0.25, -0.5), (-0.5625, -0.1875), (1 / 3, 1 / 3)),
        (0x10000408, bits(300.0, -500.0), None, None),
        (0x108, bits(50.0, 0), None, None),
    ],
)
@pytest.mark.parametrize("name", ["Lcl Translation", "DeformPercent"])
def test_fbx_curves_between_keys_are_the_files(tmp_path, flags, data, slopes, lengths, name):
    is_moved = name == "Lcl Translation"
    more, links = with_shape("", "", 0.0)
    values = [100.0, 0, 0] if is_moved else [100.0]
    curves = animation(2 if is_moved else 92, name, values, flags, data)
    more, links = more + curves[0], links + curves[1]
    path = write(tmp_path / "t.fbx", [("part", "Mesh", {}, 0)], more=more, more_links=links)
    document(path)
    rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    (after, before) = lengths or (0.5, 0.5)
    start, low, high, end = np.array([1, 3, 3, 1]) * 0.3 ** np.arange(4) * 0.7 ** np.arange(4)[::-1]
    body = measured(path, "--at-frame", str(1 + rate * (low * after + high * (1 - before) + end)))
    assert (slopes is None) == ("places_unchecked" in codes(body))
    if slopes is not None:
        share = start + low * (1 + after * slopes[0]) - high * before * slopes[1]
        assert close(body["center_of_mass"][0], 0.5 + share / (1 if is_moved else 2), 1e-5)


@pytest.mark.parametrize(
    ("flags", "rate", "frame", "center"),
    [(2, 0, 9, 1.5), (0x102, 0, 9, 0.5), (4, 9, 26, 1.5 - 25 / 29.97)],  # steps; 29.97 Hz
)
def test_fbx_steps_and_frames_are_the_files(tmp_path, flags, rate, frame, center):
    more, links = animation(2, "Lcl Translation", [100.0, 0, 0], flags)
    models = [("part", "Mesh", {}, 0)]
    path = write(tmp_path / "t.fbx", models, more=more, more_links=links, rate=rate)
    assert close(measured(path, "--at-frame", frame)["center_of_mass"][0], center, 1e-6)


LOW, HIGH = (
    ([10.0, 20, 30], [20.0, 0, 50], [-2.0, 3, 0.5]),
    ([5.0, -8, 1], [0.0, 40, 0], [0.5, 2, 4]),
)
NAMES = "Lcl Translation", "Lcl Rotation", "Lcl Scaling"


def write_layers(path, upper, count=3):
    """Write a text file whose active animation has two layers. upper: the properties of the second
    one, which moves `count` properties of the part.
    """
    document = 'Document: 1, "", "Scene" {\nProperties70: {\n'
    document += 'P: "ActiveAnimStackName", "", "", "", "b"\n}\n}\n'
    more = links = ""
    for stack, layer, properties, values in (
        (200, 210, {}, HIGH),  # of another animation, the first one
        (300, 310, {}, LOW),
        (300, 320, upper, HIGH[:count]),
    ):
        lines = "".join(property_line(*pair) for pair in properties.items())
        more += 'AnimationLayer: {}, "AnimLayer::l", "" {{\n'.format(layer)
        more += "Properties70: {\n" + lines + "}\n}\n"
        links += 'C: "OO",{},{}\n'.format(layer, stack)
        for number, (name, three) in enumerate(zip(NAMES, values), layer + 1):
            lines = "".join(property_line("d|" + a, v) for a, v in zip("XYZ", three, strict=True))
            more += 'AnimationCurveNode: {}, "AnimCurveNode::n", "" {{\n'.format(number)
            more += "Properties70: {\n" + lines + "}\n}\n"
            links += 'C: "OO",{0},{1}\nC: "OP",{0},2, "{2}"\n'.format(number, layer, name)
    for number, name in ((200, "a"), (300, "b")):
        more += 'AnimationStack: {}, "AnimStack::{}", "" {{\n}}\n'.format(number, name)
    models = [("part", "Mesh", ACTIVE, 0)]
    ahead = "Documents: {\n" + document + "}\n"
    return write(path, models, AXES, 1.0, more, links, ahead)


@pytest.mark.parametrize("mode", [0, 1, 2, 3])  # additive, override, passed through, unknown
@pytest.mark.parametrize("by_channel", [0, 1])
@pytest.mark.parametrize("weight", [100.0, 40.0])
def test_fbx_layers_blend_as_the_file_states(tmp_path, mode, by_channel, weight):
    upper = {"BlendMode": mode, "Weight": weight, "RotationAccumulationMode": by_channel}
    upper["ScaleAccumulationMode"] = by_channel
    body = measured(write_layers(tmp_path / "t.fbx", upper))
    # The root of a mirroring scale is no number.
    is_rare = mode == 3 or weight < 100 and (mode == 1 or mode == 2 and not by_channel)
    assert is_rare == ("places_unchecked" in codes(body))
    if is_rare:
        return
    share = weight / 100
    rest = 1.0 if mode == 0 else 1.0 - share
    move, angles, scale = (rest * np.array(a) + share * np.array(b) for a, b in zip(LOW, HIGH))
    turn = files.turn(angles)
    if not by_channel:
        scale = np.array(LOW[2]) ** rest * np.array(HIGH[2]) ** share
        low, high = files.turn(LOW[1]), files.turn(HIGH[1])
        between = Matrix(high if mode == 0 else low.T @ high).to_quaternion()
        turn = low @ np.array(Quaternion().slerp(between, share).to_matrix())
    assert close(body["volume"], 6 * abs(np.prod(scale)), 1e-5)
    assert np.allclose(body["center_of_mass"], (turn @ (CENTER * scale) + move) / 100, atol=1e-5)


@pytest.mark.parametrize("count", [0, 3])
@pytest.mark.parametrize("switch", ["Mute", "Solo"])
def test_fbx_switched_layers_are_doubtful(tmp_path, switch, count):
    body = measured(write_layers(tmp_path / "t.fbx", {switch: 1}, count))
    assert ("places_unchecked" in codes(body)) == (count > 0 or switch == "Solo")


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("weight", [0.5, 9.75, 20.0, -15.0, 1000.0])
def test_fbx_weight_is_the_files_or_doubtful(tmp_path, weight, moves):
    shape, links = with_shape("", "", 0.25 if moves else weight)
    if moves:
        more, more_links = animation(92, "DeformPercent", [100 * weight])
        shape, links = shape + more, links + more_links
    path = write(tmp_path / "t.fbx", [("part", "Mesh", {}, 0)], more=shape, more_links=links)
    body = measured(path)
    is_doubtful = moves and abs(weight) > 10.0
    assert is_doubtful == ("places_unchecked" in codes(body))
    assert is_doubtful or close(body["volume"], 6.0 * abs(1.0 + weight), 1e-5)


@pytest.mark.parametrize(("full", "weight"), [("50", 0.5), ("100,100", 0.5), ("100,100", 1.0)])
def test_fbx_shape_in_between_is_doubtful(tmp_path, full, weight):
    shape, links = with_shape("", "", weight)
    count = full.count(",") + 1
    shape = shape.replace("*1 {\na: 100", "*{} {{\na: {}".format(count, full))
    links += 'C: "OO",90,92\n' * (count - 1)
    path = write(tmp_path / "t.fbx", [("part", "Mesh", {}, 0)], more=shape, more_links=links)
    body = measured(path)
    assert ("places_unchecked" in codes(body)) == (weight < 1.0)


@pytest.mark.parametrize("flags", [None, 4, 8])  # of linear keys, of cubic ones
@pytest.mark.parametrize("bone_scale", [[1, 1, 1], [1, 3, 0.5]])
def test_fbx_skin_follows_the_clusters(tmp_path, bone_scale, flags):
    part = {"Lcl Translation": [500, 0, 0], "GeometricTranslation": [0, 0, 10]}
    low = {"Lcl Rotation": [0, 20, 30], "Lcl Scaling": bone_scale, **ACTIVE}
    high = {"Lcl Translation": [0, 10, 200], "Lcl Rotation": [20 - 7 * bool(flags), 0, 0], **ACTIVE}
    models = [("part", "Mesh", part, 0), ("low", "LimbNode", low, 0), ("high", "LimbNode", high, 3)]
    binds = np.diag([1.0, 2, 1, 1]), matrix(np.eye(3), [5, -10, -180])
    shares = np.tile([[0.75, 0.25], [0.2, 0.2]], (4, 1))
    more, links = with_shape(SKIN, 'C: "OO",80,1\n', 0.5)
    for number, (bind, share) in enumerate(zip(binds, shares.T, strict=True), 81):
        arrays = share, bind.T.ravel(), np.linalg.inv(bind).T.ravel()
        numbers = [",".join(map(repr, values.tolist())) for values in arrays]
        more += CLUSTER.format(number, *numbers)
        links += 'C: "OO",{0},80\nC: "OO",{1},{0}\n'.format(number, number - 78)
    if flags is not None:
        keyed, more_links = animation(4, "Lcl Rotation", [20, 0, 0], flags)
        more, links = more + keyed, links + more_links
    body = measured(write(tmp_path / "t.fbx", models, more=more, more_links=links))
    places = [matrix(files.turn([0, 20, 30]) @ np.diag(bone_scale), [0, 0, 0])] * 2
    places[1] = places[0] @ matrix(files.turn([20, 0, 0]), [0, 10, 200])
    points = BOX * [1.5, 1, 1] + [0, 0, 10]
    whole = np.column_stack([points, np.ones(8)])
    moved = np.einsum("vj,jab,vb->va", shares, np.array(places) @ binds, whole)
    moved = moved[:, :3] / shares.sum(axis=1, keepdims=True) / 100.0
    triangles = [(a, *pair) for a, b, c, d in QUADS for pair in ((b, c), (c, d))]
    assert close(body["volume"], abs(np.linalg.det(moved[triangles]).sum() / 6.0), 1e-5)
    assert "places_unchecked" not in codes(body)


def test_fbx_doubtful_skin_keeps_its_weights(tmp_path):
    more, links = with_shape(SKIN, 'C: "OO",80,1\nC: "OO",81,80\nC: "OO",2,81\n', 0.5)
    arrays = np.ones(8), np.eye(4).ravel(), np.eye(4).ravel()
    more += CLUSTER.format(81, *(",".join(map(repr, values.tolist())) for values in arrays))
    models = [("bone", "LimbNode", {}, 0), *[("part", "Mesh", {}, 0)] * 2]
    for body in document(write(tmp_path / "t.fbx", models, more=more, more_links=links))["objects"]:
        assert close(body["volume"], 9.0, 1e-5) and "places_unchecked" in codes(body)
