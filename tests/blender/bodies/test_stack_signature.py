# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The signatures of objects that are measured together are those of each by itself."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
from body_moments.blender.bodies.shape import stack_signature
from body_moments.blender.bodies.shape.shape import SURFACE_OPTIONS, surface_shape_of
from body_moments.blender.bodies.shape.stack_signature import signed_in_turn
from body_moments.blender.bodies.stacks.many import measure_many
from body_moments.core.shape.signatures import Signature, similarity
from body_moments.core.verdict.finding import MeasureError

from tests.blender.bodies.test_many import KINDS, shards
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
ORDER = 12
# By itself a body is measured as its matrix of float32 numbers maps it, which turns and scales it to rounding.
MATRIX_RTOL = 2e-6


def refusal_or(function, *arguments):
    """What a function returns, or the code of what it raises."""
    try:
        return function(*arguments)
    except MeasureError as error:
        return error.finding.code


def test_signatures_found_together_are_those_found_alone():
    bpy.context.scene.unit_settings.scale_length = 1e-3
    objects = shards()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    signed = signed_in_turn(objects, depsgraph, ORDER)
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
        assert likeness.distance() < MATRIX_RTOL and likeness.is_mirror_image in (False, None), obj.name
    assert together > len(objects) / 2 and mirrored > len(KINDS) / 2


def test_a_body_that_is_stretched_or_mirrored_has_a_signature_of_its_own_and_one_far_away_has_none():
    """The last of them are as far away as rounding leaves their shape, and a little farther, among others."""
    mesh = bpy.data.meshes.new("Wedge")
    mesh.from_pydata(
        [(0, 0, 0), (1, 0.2, 0), (0.3, 2, 0.1), (0.2, 0.4, 3)], [], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    scales = [(0.5, 0.5, 0.5), (0.5, 0.7, 0.6), (0.7, 0.5, 0.6), (0.5, 0.7, -0.6), (2, 3, 4), (2, 3, -4)]
    places = [0.0] * len(scales) + [3e10, 1e11, 0.0]
    wedges = []
    for place, scale in zip(places, [*scales, (1, 1, 1), (1, 1, 1), (1, 1, 1)]):
        wedges.append(bpy.data.objects.new("Wedge", mesh))
        bpy.context.scene.collection.objects.link(wedges[-1])
        wedges[-1].location.x, wedges[-1].scale = place, scale
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    signed, kept = signed_in_turn(wedges, depsgraph, ORDER), 0
    for obj, place in zip(wedges, places):
        found = refusal_or(signed, obj)
        if place == 1e11:
            assert found == refusal_or(surface_shape_of, obj, depsgraph) == "shape_far_from_origin"
            continue
        kept += isinstance(found, Signature)
        found = found if isinstance(found, Signature) else found.signature(ORDER)
        wanted = surface_shape_of(obj, depsgraph).signature(ORDER)
        assert close(found.size, wanted.size, MATRIX_RTOL)
        likeness = similarity(wanted, found)
        assert likeness.distance() < MATRIX_RTOL and likeness.is_mirror_image is False
    assert kept >= len(scales) + 1


def test_of_a_stack_of_bodies_that_need_care_each_is_signed_alone():
    """Boxes with a flipped face."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 2) for z in (0, 3)]
    faces = [(0, 1, 3, 2)[::-1], (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    boxes = []
    for size in (1.0, 2.0):
        mesh = bpy.data.meshes.new("Box")
        mesh.from_pydata([[size * x for x in corner] for corner in corners], [], faces)
        boxes.append(bpy.data.objects.new("Box", mesh))
        bpy.context.scene.collection.objects.link(boxes[-1])
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    signed = signed_in_turn(boxes, depsgraph, ORDER)
    for obj in boxes:
        found, wanted = signed(obj).signature(ORDER), surface_shape_of(obj, depsgraph).signature(ORDER)
        assert close(found.zernike, wanted.zernike, 1e-12) and close(found.size, wanted.size, 1e-12)
    in_stack = {found.stack for _, found in next(iter(measure_many(boxes, depsgraph, SURFACE_OPTIONS)))}
    for one in in_stack:
        assert stack_signature.stack_signatures(one, ORDER) == [None] * len(one.members)
