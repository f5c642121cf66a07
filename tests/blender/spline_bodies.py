# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface objects with any control net: what Blender's interface cannot make in one step."""

import bpy
import numpy as np


def surface(
    points,
    weights=None,
    *,
    orders=(4, 4),
    cyclic=(False, False),
    bezier=(False, False),
    endpoint=(True, True),
    resolution=(3, 3),
    name="Surface",
):
    """A surface object in the scene, active. points: (count_v, count_u, 3); the pairs are for u and
    v.
    """
    points = np.asarray(points, np.float32)
    rows, columns = points.shape[:2]
    data = bpy.data.curves.new(name, "SURFACE")
    for column in range(columns):
        spline = data.splines.new("NURBS")
        spline.points.add(rows - 1)
        line = np.zeros((rows, 4), np.float32)
        line[:, 0], line[:, 1], line[:, 3] = column, np.arange(rows), 1.0
        spline.points.foreach_set("co", line.ravel())
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.curve.select_all(action="SELECT")
    bpy.ops.curve.make_segment()  # lofts them
    bpy.ops.object.mode_set(mode="OBJECT")
    (spline,) = data.splines
    assert (spline.point_count_u, spline.point_count_v) == (columns, rows)
    set_points(spline, points, weights)
    spline.order_u, spline.order_v = orders
    spline.use_cyclic_u, spline.use_cyclic_v = cyclic
    spline.use_bezier_u, spline.use_bezier_v = bezier
    spline.use_endpoint_u, spline.use_endpoint_v = endpoint
    spline.resolution_u, spline.resolution_v = resolution
    bpy.context.view_layer.update()
    return obj


def set_points(spline, points, weights=None):
    """Move all control points: (count_v, count_u, 3)."""
    flat = np.ones((points.shape[0] * points.shape[1], 4), np.float32)
    flat[:, :3] = np.asarray(points, np.float32).reshape(-1, 3)
    if weights is not None:
        flat[:, 3] = np.asarray(weights, np.float32).ravel()
    spline.points.foreach_set("co", flat.ravel())
    spline.id_data.update_tag()
