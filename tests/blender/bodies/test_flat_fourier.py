# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The transform of a flat object is that of the polygons that Blender draws, which is said."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat_fourier import flat_transform

from tests.blender.findings import said
from tests.blender.flat_objects import sheet
from tests.blender.objects import only
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def test_a_curve_is_transformed_as_its_polygon_in_the_unit_that_is_given():
    bpy.ops.curve.primitive_nurbs_circle_add()
    obj = bpy.context.object
    obj.data.dimensions, obj.location = "2D", (0.5, 0.0, 0.0)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph))
    x, y, _ = np.array([vertex.co for vertex in mesh.vertices], float).T
    polygon = abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2.0
    assert polygon < 0.9995 * np.pi
    for unit in (None, 0.5):
        length = unit or 1.0
        for frame, turned in (("world", np.exp(-0.5j * length)), ("object", 1.0)):
            q = np.array([(0.0, 0.0), (1.0, 0.0)])
            work = flat_transform(obj, depsgraph, q, frame=frame, unit=unit)
            for _ in work.steps():
                pass
            spectrum, findings = work.result()
            assert close(spectrum.values[0].real, polygon * length**2, 1e-6)
            assert abs(np.angle(spectrum.values[1] / turned)) < 1e-6
            assert "section_drawn_as_polygons" in said(findings)
            assert 0.0 < spectrum.input_error < 1e-5


def test_all_of_a_mesh_in_edit_mode_is_transformed_in_its_plane():
    """A rectangle of 3 by 1, of which one face is selected, turned and away from the origin."""
    obj = sheet(
        [(0, 0), (1, 0), (1, 1), (0, 1), (3, 0), (3, 1)],
        faces=[(0, 1, 2, 3), (1, 4, 5, 2)],
        location=(5, 6, 7),
        rotation=(0.3, 0.4, 0.5),
    )
    for polygon in obj.data.polygons:
        polygon.select = polygon.index == 0
    only(obj)
    bpy.ops.object.mode_set(mode="EDIT")
    asked = []

    def grid(extent):
        asked.append(extent)
        return np.array([(0.0, 0.0)])

    depsgraph = bpy.context.evaluated_depsgraph_get()
    turn = np.array(obj.matrix_world.to_quaternion().to_matrix(), float)
    for frame in ("world", "object"):
        work = flat_transform(obj, depsgraph, grid, frame=frame)
        for _ in work.steps():
            pass
        assert close(work.result()[0].values[0].real, 3.0, 1e-6)
        x, y = work.arrays["axes"]
        assert np.abs(np.cross(x, y) - turn[:, 2]).max() < 1e-6
        normal = turn[:, 2] @ [5, 6, 7] * turn[:, 2]
        assert np.abs(work.arrays["origin"] - (normal if frame == "world" else [5, 6, 7])).max() < 1e-5
    spans = [np.ptp(np.array([(0, 0), (3, 0), (3, 1), (0, 1)]) @ (turn.T @ axis)[:2]) for axis in (x, y)]
    assert close(asked, [max(spans)] * 2, 1e-5)
    bpy.ops.object.mode_set(mode="OBJECT")
