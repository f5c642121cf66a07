# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Start of the add-on in a Blender that has not loaded numpy: registration and panels do without it."""

import subprocess
import sys
from pathlib import Path

import bpy

from tests.blender.objects import add, mesh_body

ROOT = Path(__file__).resolve().parents[2]
MAX_MODULES = 145  # of ours; the standard library adds five in a real Blender
# The module of Blender loads numpy by itself, which is hidden here: an import fails.
CODE = """
import importlib.util, os, sys, types
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
bpy.ops.wm.open_mainfile(filepath=sys.argv[2])
from tests.panels.drawing import labels, shown
assert "Exact" in labels(shown())
ours = [name for name in sys.modules if name not in loaded and name.split(".")[0] == "body_moments"]
assert len(ours) <= int(sys.argv[3]), ours
sys.stdout.flush()
os._exit(0)
"""


def test_start_and_panels_of_saved_file_load_no_numpy(scene, tmp_path):
    add(mesh_body())
    bpy.ops.object.body_moments_measure()
    path = tmp_path / "a.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    command = [sys.executable, "-P", "-c", CODE, str(ROOT), str(path), str(MAX_MODULES)]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=480)
    assert done.returncode == 0, done.stderr
