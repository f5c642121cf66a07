# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Start of the add-on in a Blender that has not loaded numpy: registration and panels do without
it.
"""

import subprocess
import sys
from pathlib import Path

import bpy

from tests.blender.characters import pose
from tests.blender.flat_objects import sheet
from tests.blender.grids import mesh_to_volume
from tests.blender.objects import add, mesh_body, only
from tests.operators.assemblies import assembly_of_boxes
from tests.operators.characters import character

ROOT = Path(__file__).resolve().parents[2]
MAX_MODULES = 145  # of ours; the standard library adds five in a real Blender
# The module of Blender loads numpy by itself, which is hidden here: an import fails.
CODE = """
import importlib.util, itertools, os, sys, types
spec = importlib.util.spec_from_file_location("body_moments", sys.argv[1] + "/__init__.py",
                                              submodule_search_locations=[sys.argv[1]])
sys.modules["body_moments"] = module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
sys.modules["tests"] = tests = types.ModuleType("tests")
tests.__path__ = [sys.argv[1] + "/tests"]
import bpy
sys.modules.update(dict.fromkeys([name for name in sys.modules if name.split(".")[0] == "numpy"]))
loaded = set(sys.modules)
module.register()
ours = [name for name in sys.modules if name not in loaded and name.split(".")[0] == "body_moments"]
assert len(ours) <= int(sys.argv[3]), ours
from tests.panels.drawing import every_panel
drawn = set()
for path in sys.argv[4:]:
    bpy.ops.wm.open_mainfile(filepath=path)
    layer = bpy.context.view_layer
    collections = [layer.layer_collection, *layer.layer_collection.children]
    for active, collection in itertools.product(layer.objects, collections):
        layer.objects.active = active
        layer.active_layer_collection = collection
        drawn.update(every_panel())
        for obj in layer.objects:
            obj.select_set(obj == layer.objects.active)
        layer.update()
        drawn.update(every_panel())
missing = set(sys.argv[2].splitlines()) - drawn
assert not missing, (missing, drawn)
sys.stdout.flush()
os._exit(0)
"""
LABELS = (  # a label of each kind of result
    *(
        "Exact",
        "6 Objects",
        "Exact, from a Grid",
        "Centroid (World)",
        "Center of Mass from There",
        "Symmetry Cs",
    ),
    *("Robot", "hips", "Rig: 1 Mesh", "Principal Axes"),
)


def test_start_and_panels_of_saved_file_load_no_numpy(scene, tmp_path):
    paths = tmp_path / "a.blend", tmp_path / "pose.blend"
    assembly_of_boxes()
    shown = add(None, "Shown", (0, 20, 0))
    shown.instance_type, shown.instance_collection = "COLLECTION", bpy.data.collections["Arm"]
    bpy.data.collections["Robot"].objects.link(shown)
    bpy.ops.object.body_moments_measure_assembly()
    body, fog = add(mesh_body(), rotation=(0.3, 0.2, 0.1)), mesh_to_volume(bpy.data.objects["b0"])
    bpy.context.view_layer.update()
    only(body, fog)
    bpy.ops.object.body_moments_measure()
    bpy.ops.object.body_moments_find_symmetry()
    only(sheet([(0, 0), (2, 0), (2, 1), (0, 1)]))
    bpy.ops.object.body_moments_measure_section()
    reference = scene.body_moments_reference
    reference.about, reference.first, reference.second = "AXIS", (0, 0, 1), (3, 4, 1)
    armature, skin = character()
    bpy.ops.object.body_moments_measure_bones()
    only(skin)
    bpy.ops.object.body_moments_measure()
    only(body, fog, armature, *bpy.data.collections["Robot"].all_objects)
    bpy.ops.wm.save_as_mainfile(filepath=str(paths[0]))
    only(armature)
    bpy.ops.object.mode_set(mode="POSE")
    pose(armature)
    bpy.ops.wm.save_as_mainfile(filepath=str(paths[1]))
    arguments = str(ROOT), "\n".join(LABELS), str(MAX_MODULES), *map(str, paths)
    done = subprocess.run(
        [sys.executable, "-P", "-c", CODE, *arguments],
        capture_output=True,
        encoding="utf-8",
        timeout=480,
    )
    # handlers print theirs
    assert done.returncode == 0 and "Traceback" not in done.stderr, done.stderr
