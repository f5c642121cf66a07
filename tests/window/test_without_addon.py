# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The node group Center of Mass in a Blender that has never seen the add-on: modifiers and
animation are followed.
"""

import json
import subprocess

import numpy as np
import pytest

FLOAT32 = 2e-5  # Relative to the size: nodes lose as much.
UNIT = 0.001
# An L with a leg of 1 × 3 and a foot of 2 × 1, 0.5 high: volume 2.5, center (1.1, 1.1, 0.25).
POINTS = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
VOLUME, CENTER = 2.5, (1.1, 1.1, 0.25)
DENSITY = 1240.0  # kg/m³
MADE = f"""\
import bpy, sys
points, n = {POINTS!r}, {len(POINTS)}
bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
scene = bpy.context.scene
scene.unit_settings.scale_length = {UNIT}
mesh = bpy.data.meshes.new("Part")
faces = [tuple(range(n))[::-1], tuple(range(n, 2 * n))]
faces += [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
mesh.from_pydata([(x, y, z) for z in (0.0, 0.5) for x, y in points], [], faces)
part = bpy.data.objects.new("Part", mesh)
scene.collection.objects.link(part)
part.body_moments.density = {DENSITY}
part.scale = (1.0, 1.0, -2.0)
array = part.modifiers.new("Array", "ARRAY")
array.use_relative_offset = False
array.use_constant_offset = True
array.constant_offset_displace = (4.0, 0.0, 0.0)
part.shape_key_add(name="Basis")
taller = part.shape_key_add(name="Taller", from_mix=False)
for point in taller.data:
    point.co.z *= 3.0
taller.value = 0.0
taller.keyframe_insert("value", frame=1)
taller.value = 1.0
taller.keyframe_insert("value", frame=11)
for curve in taller.id_data.animation_data.action.layers[0].strips[0].channelbag(
    taller.id_data.animation_data.action_slot
).fcurves:
    for key in curve.keyframe_points:
        key.interpolation = "LINEAR"
part.keyframe_insert("location", frame=1)
part.location.y = 20.0
part.keyframe_insert("location", frame=11)
bpy.context.view_layer.objects.active = part
part.select_set(True)
scene.frame_set(1)
assert bpy.ops.object.body_moments_add_nodes() == {{"FINISHED"}}
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
"""
# Steps of a user: store the group's outputs with the marker, change a modifier and the frame.
READ = """\
import bpy, json, sys
assert not hasattr(bpy.types.Object, "body_moments"), "the add-on is here"
part, marker = bpy.data.objects["Part"], bpy.data.objects["Part Center of Mass"]
tree = marker.modifiers[0].node_group
group = next(node for node in tree.nodes if node.type == "GROUP")
end = next(node for node in tree.nodes if node.type == "GROUP_OUTPUT")
for name in ("Volume", "Mass"):
    store = tree.nodes.new("GeometryNodeStoreNamedAttribute")
    store.inputs["Name"].default_value = name.lower()
    tree.links.new(end.inputs["Geometry"].links[0].from_socket, store.inputs["Geometry"])
    tree.links.new(group.outputs[name], store.inputs["Value"])
    tree.links.new(store.outputs["Geometry"], end.inputs["Geometry"])
seen = []
for frame, count in ((1, 2), (11, 2), (6, 2), (6, 5)):
    bpy.context.scene.frame_set(frame)
    part.modifiers["Array"].count = count
    evaluated = marker.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.data
    axes = list(zip(*(vertex.co for vertex in mesh.vertices)))
    center = [(min(axis) + max(axis)) / 2.0 for axis in axes]
    matrix = [list(row) for row in marker.matrix_world]
    values = [mesh.attributes[name].data[0].value for name in ("volume", "mass")]
    seen.append([frame, count, part.location.y, center, *values, matrix])
print("SEEN", json.dumps(seen))
"""


@pytest.fixture(scope="module")
def without_addon(run_blender, tmp_path_factory):
    """Return the numbers of the file in a Blender with factory settings and an empty user
    folder.
    """
    folder = tmp_path_factory.mktemp("nodes")
    made, read, file = folder / "made.py", folder / "read.py", folder / "nodes.blend"
    made.write_text(MADE, encoding="utf-8")
    read.write_text(READ, encoding="utf-8")
    run_blender("--background", "--python-exit-code", "1", "--python", made, "--", file)
    command = [run_blender.blender, "--background", "--factory-startup", str(file)]
    command += ["--python-exit-code", "1", "--python", str(read)]
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", errors="replace", timeout=600
    )
    assert done.returncode == 0, f"{done.stdout}\n{done.stderr}"
    (line,) = [line for line in done.stdout.splitlines() if line.startswith("SEEN ")]
    return json.loads(line.removeprefix("SEEN "))


def test_group_follows_animation_without_the_addon(without_addon):
    for frame, count, y, center, volume, mass, matrix in without_addon:
        assert np.array_equal(matrix, np.eye(4))
        height = 1.0 + 2.0 * (frame - 1) / 10.0
        exact_volume = count * VOLUME * 2.0 * height
        exact = np.array(
            [CENTER[0] + 4.0 * (count - 1) / 2.0, CENTER[1] + y, -2.0 * height * CENTER[2]]
        )
        assert np.abs(center - exact).max() < FLOAT32 * max(np.abs(exact).max(), 4.0 * count), (
            frame,
            count,
        )
        assert abs(volume / exact_volume - 1.0) < FLOAT32, (frame, count)
        assert abs(mass / (DENSITY * UNIT**3 * exact_volume) - 1.0) < FLOAT32, (frame, count)
    assert [round(y, 4) for _, _, y, *_ in without_addon] == [0.0, 20.0, 10.0, 10.0]  # it has moved
