# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes that overlap."""

import bpy

from tests.blender.objects import editing


def boxes(*sizes, reverse=()):
    """A mesh of boxes about one center, with some faces reversed."""
    import bmesh  # is there once bpy is

    mesh = bpy.data.meshes.new("Boxes")
    with editing(mesh) as built:
        for size in sizes:
            bmesh.ops.create_cube(built, size=size)
        built.faces.ensure_lookup_table()
        bmesh.ops.reverse_faces(built, faces=[built.faces[index] for index in reverse])
    return mesh
