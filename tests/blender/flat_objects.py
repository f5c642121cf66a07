# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Letters and other flat objects."""

import os

import bpy
import numpy as np

from tests.blender.objects import add

MONOSPACED = "DejaVuSansMono.woff2"  # of the fonts that Blender ships


def font(name):
    """One of the fonts that Blender ships; the one that it starts with for an empty name."""
    if not name:
        return None
    path = os.path.join(bpy.utils.system_resource("DATAFILES", path="fonts"), name)
    return bpy.data.fonts.load(path, check_existing=True)


def text(body="R", name="Text", font_name="", resolution=12, **where):
    data = bpy.data.curves.new(name, "FONT")
    data.body, data.resolution_u = body, resolution
    if font_name:
        data.font = font(font_name)
    return add(data, name, **where)


def sheet(points, name="Sheet", faces=None, **where):
    """A flat mesh of one face, or of the given ones, in its own plane z = 0."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        np.insert(np.asarray(points, float), 2, 0.0, axis=1).tolist(),
        [],
        faces or [range(len(points))],
    )
    mesh.update()
    return add(mesh, name, **where)


def regular(sides, radius=1.0):
    """(n, 2) the corners of a regular polygon."""
    angle = 2.0 * np.pi * np.arange(sides) / sides + 0.1
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def converted(obj, name="Mesh"):
    """A mesh of what a text or curve object shows, where the object stands."""
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph))
    copy = add(mesh, name)
    copy.matrix_world = obj.matrix_world
    bpy.context.view_layer.update()
    return copy


W, T, X, Y = 0.125, 1.75, 1.0, 2.0  # an I section whose corners float32 has exactly

I_BEAM = [
    (-X, -Y),
    (X, -Y),
    (X, -T),
    (W, -T),
    (W, T),
    (X, T),
    (X, Y),
    (-X, Y),
    (-X, T),
    (-W, T),
    (-W, -T),
    (-X, -T),
]


def flat_mesh(*polygons, height=0.0):
    mesh = bpy.data.meshes.new("Flat")
    starts = np.cumsum([0] + [len(polygon) for polygon in polygons])
    mesh.from_pydata(
        [(x, y, height) for polygon in polygons for x, y in polygon],
        [],
        [tuple(range(a, b)) for a, b in zip(starts, starts[1:])],
    )
    return mesh
