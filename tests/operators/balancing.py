# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A figure to be balanced."""

import bpy
import numpy as np
import pytest

from tests.blender.objects import add, editing, only

bmesh = pytest.importorskip("bmesh")  # only found once bpy is loaded

balance = bpy.ops.object.body_moments_sculpt_balance


def figure(**more):
    """A sphere cut in quads, its upper half pulled to one side: it would fall over."""
    mesh = bpy.data.meshes.new("Figure")
    with editing(mesh) as work:
        bmesh.ops.create_uvsphere(work, u_segments=20, v_segments=14, radius=1.0)
        for vertex in work.verts:
            vertex.co.x += 0.6 * max(vertex.co.z, 0.0)
    return add(mesh, "Figure", **more)


def points(obj):
    if obj.mode == "EDIT":
        return np.array([v.co[:] for v in bmesh.from_edit_mesh(obj.data).verts], np.float64)
    found = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", found)
    return found.reshape(-1, 3).astype(np.float64)


def edit(obj, chosen=lambda co: co.z > 0.1):
    only(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    mesh = bmesh.from_edit_mesh(obj.data)
    for vertex in mesh.verts:
        vertex.select = chosen(vertex.co)
    mesh.select_flush_mode()
    bmesh.update_edit_mesh(obj.data)
    return np.array([v.select for v in mesh.verts])
