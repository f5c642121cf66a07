# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects to try operators on, and what they look like in the world."""

from contextlib import contextmanager
from types import SimpleNamespace

import bpy
import numpy as np

from tests.core.bodies import moebius

# A closed body without any symmetry: an L with a slanted end, so that nothing about its frame is
# left to choose.
POINTS = ((0, 0, 0), (3, 0, 0), (3.5, 1, 0), (1, 1, 0), (1, 2.5, 0), (0, 2, 0))
HEIGHT = 0.7


def mesh_of(points, faces, name="Mesh"):
    """A mesh of these points and faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(points).tolist(), [], faces)
    return mesh


def mesh_body(name="Body", points=POINTS, height=HEIGHT):
    """A mesh: the polygon as a prism."""
    n = len(points)
    vertices = [*points, *((x, y, height) for x, y, _ in points)]
    faces = [tuple(range(n))[::-1], tuple(range(n, 2 * n))]
    faces += [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    return mesh_of(vertices, faces, name)


def strip_mesh(name="Strip"):
    """A mesh that cannot be closed: a Möbius strip."""
    points, triangles = moebius()
    return mesh_of(points, triangles.tolist(), name)


def add(
    data,
    name="Body",
    location=(0, 0, 0),
    rotation=(0, 0, 0),
    scale=(1, 1, 1),
    select=True,
    parent=None,
):
    """An object in the scene, selected and active."""
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    obj.parent = parent
    obj.location, obj.rotation_euler, obj.scale = location, rotation, scale
    bpy.context.view_layer.update()
    if select:
        bpy.ops.object.select_all(action="DESELECT")
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    return obj


def dent(obj, by):
    """Move the first vertex of a mesh along x."""
    obj.data.vertices[0].co.x += by
    obj.data.update()
    bpy.context.view_layer.update()


def after(step):
    """The active object's successor, by its name, after undo or redo."""
    name = bpy.context.object.name
    step()
    bpy.context.view_layer.update()
    return bpy.data.objects[name]


@contextmanager
def editing(mesh):
    """A mesh as a bmesh, to be edited, which becomes the mesh at the end."""
    import bmesh  # is there once bpy is

    edited = bmesh.new()
    edited.from_mesh(mesh)
    edited.faces.ensure_lookup_table()
    yield edited
    edited.to_mesh(mesh)
    edited.free()
    mesh.update()


def only(*objects):
    """Select these and make the first active."""
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def measure(*objects):
    """Measure these, and store the results."""
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


def seen(obj):
    """(n, 3) float64 vertices of the evaluated object in the world."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    evaluated.to_mesh_clear()
    matrix = np.array(obj.matrix_world, np.float64)
    return points.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]


def place(obj):
    """(4, 4) float64 matrix_world."""
    bpy.context.view_layer.update()
    return np.array(obj.matrix_world, np.float64)


def measured(obj):
    """The measurement of an object as it is now."""
    from body_moments.blender.bodies.measure_object import measure_object
    from body_moments.blender.settings.options import MeasureOptions

    bpy.context.view_layer.update()
    return measure_object(obj, bpy.context.evaluated_depsgraph_get(), MeasureOptions())


def arrays(numbers):
    """Displayed or stored numbers of a body as arrays: center, tensor, principal moments, axes as
    columns.
    """
    from body_moments.core.inertia.plain_body import tensor_rows

    return SimpleNamespace(
        mass=numbers.mass,
        center=np.array(numbers.center),
        inertia=np.array(tensor_rows(numbers.inertia)),
        moments=np.array(numbers.moments),
        axes=np.transpose(numbers.axes),
    )
