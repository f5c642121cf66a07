# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a flat object by itself, and which objects have one."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.flat.flat_shape import OutlineDistance, flat_shape_of
from body_moments.blender.bodies.fourier import flat_transform
from body_moments.blender.bodies.shape.surface_distance import register_surfaces

from tests.blender.findings import said
from tests.blender.flat_objects import sheet
from tests.close import close

pytestmark = pytest.mark.usefixtures("scene")
TRIANGLE = np.array([(0.0, 0.0), (4.0, 0.0), (1.0, 2.0)])


def flat(obj, **more):
    bpy.context.view_layer.update()
    return flat_shape_of(obj, bpy.context.evaluated_depsgraph_get(), **more)


@pytest.mark.filterwarnings("error")
def test_flat_signature_is_independent_of_size():
    obj = sheet(TRIANGLE * 0.3, scale=(1, 1, 1))
    plain = flat(obj)
    for size in (2.0**-40, 2.0**40):
        obj.scale = (size,) * 3
        found, wanted = flat(obj).signature(), plain.signature()
        assert close(found.size, size * plain.size, 1e-12) and close(wanted.size, plain.size, 1e-12)
        for name in ("invariants", "zernike", "chirality"):
            one, other = getattr(found, name), getattr(wanted, name)
            assert len(other) and np.abs(one - other).max() < 1e-9 * np.abs(other).max()
    longest, low = plain.signature(21).zernike, plain.signature(8).zernike
    assert np.array_equal(longest, plain.signature().zernike)
    assert len(low) < len(longest) and np.abs(longest[: len(low)] - low).max() < 1e-9


@pytest.mark.parametrize("sizes", [(1e-3, 1e-3), (1e-3, 4e-3), (4e-3, 1e-3), (1e3, 3e3)])
def test_a_flat_shape_of_any_size_is_turned_onto_another_one(sizes):
    small, large = (
        sheet(TRIANGLE, name, location=where, rotation=turn, scale=(size,) * 3)
        for name, size, where, turn in zip(
            "ab", sizes, ((1, 2, 3), (-4, 5, 6)), ((0.3, 0.2, 0.1), (1.0, -0.5, 2.0))
        )
    )
    source, target = flat(small), flat(large)
    fit = register_surfaces(
        source, target, OutlineDistance(source), OutlineDistance(target), sizes[1] / sizes[0]
    )
    turns = [
        np.array(obj.matrix_world.to_quaternion().to_matrix(), float) for obj in (small, large)
    ]
    assert np.abs(fit.rotation @ turns[0] - turns[1]).max() < 1e-5 and not fit.is_mirror_image


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_near_square_symmetry_follows_tolerance_at_any_size(size):
    obj = sheet(
        [(0, 0), (1, 0), (1, 1.003), (0, 1)],
        location=(3, 4, 5),
        rotation=(1, 2, 3),
        scale=(size,) * 3,
    )
    shape = flat(obj)
    for tolerance, group in ((1e-4, "C1"), (0.02, "C4v")):
        assert [found.group for found in shape.find_symmetries(tolerance)] == [group, group]


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
