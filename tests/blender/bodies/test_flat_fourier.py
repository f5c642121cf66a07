# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The transform of a flat object is that of the polygons that Blender draws, which is said."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.fourier import flat_transform

from tests.blender.findings import said
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def test_curve_transform_is_that_of_its_polygon():
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
            assert "drawn_as_polygons" in said(findings)
            assert 0.0 < spectrum.input_error < 1e-5
