# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The signatures of objects that are measured together are those of each by itself."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.shape.object_shape import surface_shape_of
from body_moments.blender.bodies.shape.signatures import signatures_in_turn
from body_moments.core.shape.signatures import Signature, similarity
from body_moments.core.verdict import MeasureError

from tests.blender.many_objects import KINDS, shards
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
ORDER = 12
# By itself a body is measured as its matrix of float32 numbers maps it, which turns and scales it
# to rounding.
MATRIX_RTOL = 2e-6


def refusal_or(function, *arguments):
    """What a function returns, or the code of what it raises."""
    try:
        return function(*arguments)
    except MeasureError as error:
        return error.finding.code


def test_stacked_signatures_equal_single_ones():
    bpy.context.scene.unit_settings.scale_length = 1e-3
    objects = shards()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    signed = signatures_in_turn(objects, depsgraph, ORDER)
    together, mirrored = 0, 0
    for obj in objects:
        found, alone = refusal_or(signed, obj), refusal_or(surface_shape_of, obj, depsgraph)
        if isinstance(alone, str) or isinstance(found, str):
            assert found == alone, obj.name
            continue
        wanted = alone.signature(ORDER)
        if not isinstance(found, Signature):  # measured by itself
            found = found.signature(ORDER)
        else:
            together += 1
            mirrored += obj.matrix_world.determinant() < 0.0
        assert close(found.size, wanted.size, MATRIX_RTOL), obj.name
        near = MATRIX_RTOL * np.abs(wanted.zernike).max()
        assert np.abs(found.zernike - wanted.zernike).max() < near, obj.name
        assert np.abs(found.fourier - wanted.fourier).max() < MATRIX_RTOL
        for name in ("invariants", "chirality"):
            one, other = getattr(found, name), getattr(wanted, name)
            assert np.abs(one - other).max() < MATRIX_RTOL * max(1.0, np.abs(other).max()), obj.name
        likeness = similarity(wanted, found)
        assert likeness.distance() < MATRIX_RTOL and likeness.is_mirror_image in (False, None), (
            obj.name
        )
    assert together > len(objects) / 2 and mirrored > len(KINDS) / 2
