# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever is read, in whatever way: no data is left behind, none is changed, and a second look
gives the same.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat_shape import flat_shape_of
from body_moments.blender.bodies.flat.region import flat_region
from body_moments.blender.bodies.measure_object import measure_object
from body_moments.blender.bodies.mesh import object_hull
from body_moments.blender.bodies.shape.object_shape import shape_of
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.verdict import MeasureError

from tests.blender.flat_objects import regular, sheet, text
from tests.blender.grids import vdb_grid, volume_object
from tests.blender.objects import add, mesh_body

pytestmark = pytest.mark.usefixtures("scene")


def counts():
    """Of all data, and of who uses it."""
    groups = [one.identifier for one in bpy.data.bl_rna.properties if one.type == "COLLECTION"]
    return {
        name: (len(getattr(bpy.data, name)), sum(one.users for one in getattr(bpy.data, name)))
        for name in groups
    }


def circle():
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.dimensions = "2D"
    return bpy.context.object


def edited():
    obj = add(mesh_body())
    bpy.ops.object.mode_set(mode="EDIT")
    return obj


def mirrored():
    obj = edited()
    obj.modifiers.new("Mirror", "MIRROR")
    return obj


def level(folder):
    return volume_object(folder / "grid.vdb", vdb_grid(np.full((3, 3, 3), 2.0, np.float32)))


KINDS = {
    "text": lambda folder: text(),
    "circle": lambda folder: circle(),
    "sheet": lambda folder: sheet(regular(5)),
    "mesh": lambda folder: add(mesh_body()),
    "edited": lambda folder: edited(),
    "edited with a modifier": lambda folder: mirrored(),
    "patches": lambda folder: (
        bpy.ops.surface.primitive_nurbs_surface_sphere_add() and bpy.context.object
    ),
    "ball": lambda folder: bpy.ops.object.metaball_add() and bpy.context.object,
    "grid": level,
}
SHELL = MeasureOptions(kind="shell", thickness=0.01, density=1.0)
WAYS = (
    lambda obj, depsgraph: measure_object(obj, depsgraph).mass_properties.inertia,
    lambda obj, depsgraph: measure_object(obj, depsgraph, SHELL).mass_properties.inertia,
    lambda obj, depsgraph: (
        measure_object(obj, depsgraph, MeasureOptions(kind="wire")).mass_properties.inertia
    ),
    lambda obj, depsgraph: flat_region(obj, depsgraph, resolution=5).moments(2).raw,
    lambda obj, depsgraph: flat_region(obj, depsgraph, exact=False, selected=False).moments(2).raw,
    lambda obj, depsgraph: flat_shape_of(obj, depsgraph).signature().invariants,
    lambda obj, depsgraph: shape_of(obj, depsgraph).pose()["matrix"],
    lambda obj, depsgraph: object_hull(obj, depsgraph).points,
)


@pytest.mark.parametrize("kind", KINDS)
def test_reading_leaves_nothing_and_changes_nothing(tmp_path, kind):
    obj = KINDS[kind](tmp_path)
    bpy.context.view_layer.update()
    before = counts()
    succeeded = 0
    for way in WAYS:
        found = []
        for _ in range(2):
            try:
                found.append(way(obj, bpy.context.evaluated_depsgraph_get()))
            except MeasureError as refusal:
                found.append(str(refusal))
            assert counts() == before
        if not isinstance(found[0], str):
            succeeded += 1
            assert np.array_equal(*map(np.asarray, found))
        else:
            assert found[0] == found[1]
    assert succeeded >= 1
