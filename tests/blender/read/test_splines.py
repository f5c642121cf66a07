# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches beside the mesh that Blender displays: what agrees with it, what is recovered from it,
what is neither.
"""

import bpy
import numpy as np
import pytest
from body_moments.blender.read import splines
from body_moments.core.nurbs import Patch, blender_space, display_parameters, display_table

from tests.blender.objects import add
from tests.blender.spline_bodies import surface

pytestmark = pytest.mark.usefixtures("scene")
FAR = np.array([300.0, -20.0, 7.0])


def made(seed, weighted, shape=(5, 4), orders=(3, 4)):
    """A patch away from the origin, and where its display mesh samples it."""
    rng = np.random.default_rng(seed)
    spaces = tuple(
        blender_space(count, order, False, False, True) for count, order in zip(shape, orders)
    )
    points = FAR + rng.uniform(-1.0, 1.0, (*shape, 3)) * (3.0, 2.0, 1.0)
    weights = rng.uniform(0.5, 2.0, shape) if weighted else None
    return Patch(spaces, points, weights), tuple(
        display_table(space, display_parameters(space, 3)) for space in spaces
    )


def reading(obj, mesh=None):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return splines.spline_reading(obj.evaluated_get(depsgraph), depsgraph, mesh)


def test_invalid_spline_surfaces_are_read_from_display():
    points = made(1, False)[0].points
    assert len(reading(surface(points)).patches) == 1
    for value in (0.0, -1.0, float("nan")):
        weights = np.ones((5, 4))
        weights[2, 1] = value
        obj = surface(points, weights)
        assert reading(obj) is None
        assert splines.nonpositive_weights(obj.data.splines) == 1
    wrong = points.copy()
    wrong[0, 0, 2] = np.inf
    assert reading(surface(wrong)) is None
    obj = surface(points)
    row = obj.data.splines.new("NURBS")  # which shows nothing
    row.points.add(4)
    row.points.foreach_set("co", [1.0] * 20)
    found = reading(obj)
    assert len(found.patches) == 1
    assert [(one.code, one.values) for one in found.findings] == [
        ("splines_left_out", {"count": 1, "total": 2})
    ]
    obj.data.splines.new("POLY")
    obj.data.update_tag()
    assert reading(obj) is None
    assert reading(add(bpy.data.curves.new("Empty", "SURFACE"))) is None
    obj = surface(points)
    obj.modifiers.new("Thick", "SOLIDIFY")
    assert reading(obj) is None
