# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn of a measured object stands where the object stands, in Blender's units, and says how far it holds."""

import pytest

pytest.importorskip("bpy")
import bpy
import numpy as np
from body_moments.operators.session import staleness
from body_moments.operators.session.shown import Trust, shown_body
from mathutils import Matrix

from tests.blender.objects import add, measured, mesh_body, only, strip_mesh
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")


def measure(*objects):
    only(*objects)
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}


def assert_shown(obj, unit=1.0):
    """What is shown is what measuring again gives."""
    shown, body = shown_body(obj), measured(obj).mass_properties
    reach = np.linalg.norm(body.radii_of_gyration) + np.linalg.norm(body.center)
    assert np.linalg.norm(shown.center * unit - body.center) <= 1e-6 * reach
    assert close(shown.gyration * unit, body.radii_of_gyration, 1e-6)
    assert close(np.abs((shown.axes * body.principal.axes).sum(axis=0)), 1.0, 1e-5)
    assert close(shown.mass, body.mass, 1e-6)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_a_moved_object_is_shown_where_it_is_in_the_same_redraw(unit):
    bpy.context.scene.unit_settings.scale_length = unit
    obj = add(mesh_body(), location=(3, -2, 5), rotation=(0.3, -0.7, 2.1), scale=(1, 2, -0.7))
    assert shown_body(obj) is None
    measure(obj)
    assert_shown(obj, unit)
    assert shown_body(obj) is shown_body(obj)
    obj.matrix_world = Matrix.Translation((-40, 7, 1)) @ Matrix.Rotation(2.2, 4, (1, 2, -1)) @ obj.matrix_world
    bpy.context.view_layer.update()
    assert_shown(obj, unit)


def test_the_verdict_says_what_is_repaired_doubtful_and_out_of_date():
    exact, open_strip, flipped = add(mesh_body()), add(strip_mesh(), "Strip"), add(mesh_body("Flipped"), "Flipped")
    flipped.data.polygons[3].flip()
    flipped.data.update()
    measure(exact, open_strip, flipped)
    assert [shown_body(obj).verdict for obj in (exact, open_strip, flipped)] == [
        Trust.EXACT,
        Trust.DOUBTFUL,
        Trust.REPAIRED,
    ]
    exact.data.vertices[0].co.x -= 1.0
    exact.data.update()
    bpy.context.view_layer.update()
    assert shown_body(exact).verdict == Trust.OUT_OF_DATE and staleness.stale_reason(exact, bpy.context.scene)
