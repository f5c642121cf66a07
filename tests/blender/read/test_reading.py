# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Places of what was read, in meters, and the unions that Blender computes wherever shells
stand.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.union import union_surface
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.raw import FLOAT32_HALF_ULP
from body_moments.core.polyhedron import polyhedron_moments

from tests.blender.read_bodies import CUBE, CUBE_FACES
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("away", [0.0, 8.0])
def test_a_union_is_as_exact_as_float32_wherever_it_is(size, away):
    """Two cubes of two that overlap by a third of each."""
    near, far = np.array(CUBE, float), np.array(CUBE, float) + (4.0 / 3.0, 0.0, 0.0)
    place = size * away * np.array([1.0, -0.5, 0.25])
    points = np.concatenate([size * part + place for part in (near, far)]).astype(np.float32)
    surface = Surface(points, quads=np.concatenate([CUBE_FACES, np.add(CUBE_FACES, 8)]))
    counts = [
        len(getattr(bpy.data, name)) for name in ("meshes", "objects", "collections", "scenes")
    ]
    united = union_surface(surface)
    assert counts == [
        len(getattr(bpy.data, name)) for name in ("meshes", "objects", "collections", "scenes")
    ]
    moments = polyhedron_moments(united)[0]
    tolerance = 1e-6 * (1.0 + away)
    assert close(moments.raw[0], 40.0 / 3.0 * size**3, tolerance)
    center = moments.about + moments.raw[1:4] / moments.raw[0]
    assert np.abs(center - place - (size * 2.0 / 3.0, 0.0, 0.0)).max() <= tolerance * size
    # rounded before and after Blender's boolean
    more = united.displacement - surface.coordinate_error
    assert (more > 0.1 * FLOAT32_HALF_ULP * size).all() and (
        more < 8.0 * FLOAT32_HALF_ULP * size
    ).all()
