# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Typical panels as a reviewer reads them: labels and controls in their order, kept as text.

The numbers are tested where they are measured. `pytest --rewrite` writes the pages.
"""

import bpy
import numpy as np
import pytest

from tests.blender.boxes import box_mesh
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, measure, only
from tests.operators.assemblies import assembly_of_boxes
from tests.operators.characters import character
from tests.panels.drawing import shown

pytestmark = pytest.mark.usefixtures("scene")


def measured_cube(_folder):
    add(box_mesh(2, 2, 2), "Cube", location=(1, 2, 3))
    bpy.ops.object.body_moments_measure()


def open_box(_folder):
    mesh, closed = bpy.data.meshes.new("Open"), box_mesh(1, 2, 4)
    mesh.from_pydata(
        [v.co for v in closed.vertices], [], [tuple(f.vertices) for f in closed.polygons][1:]
    )
    add(mesh, "Open Box")
    bpy.ops.object.body_moments_measure()


def assembly(_folder):
    assembly_of_boxes()
    only(bpy.data.objects["b0"])
    bpy.ops.object.body_moments_measure_assembly()


def rig(_folder):
    armature, _ = character()
    bpy.ops.object.body_moments_measure_bones()
    armature.data.bones.active = armature.data.bones["head"]


def volume(folder):
    measure(volume_object(folder / "fog.vdb", vdb_grid(np.ones((4, 4, 4), np.float32))))


def page(record):
    """Lines of text: neighboring labels on one line, however they were wrapped, and each control on
    its own.
    """
    lines, words = [], []
    for kind, name, *_ in [*record, ("end", "")]:
        if kind == "label":
            words.append(name)
        elif kind in ("prop", "operator", "menu", "end"):
            lines.append(" ".join(filter(None, words)))
            lines.append(
                {"prop": "[{}]", "operator": "({})", "menu": "<{}>"}.get(kind, "").format(name)
            )
            words = []
    return "\n".join(line for line in lines if line not in ("", "(object.body_moments_copy_value)"))


@pytest.mark.parametrize("build", [measured_cube, open_box, assembly, rig, volume])
def test_panel_of_typical_scene_is_as_reviewed(build, kept, tmp_path):
    build(tmp_path)
    bpy.context.view_layer.update()
    kept(build.__name__ + ".txt", page(shown()))
