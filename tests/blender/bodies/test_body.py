# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What bodies do with moments that are known better, and with those of shapes that several bodies share."""

import bpy
import numpy as np
import pytest
from body_moments.blender.bodies.body import extend_input_error, own_moments, with_input_error, with_known
from body_moments.blender.bodies.measure_object import measure_body
from body_moments.blender.settings.options import MeasureOptions
from body_moments.core.moments.moments import Measure, Moments, monomial_count, monomials

from tests.blender.objects import add
from tests.close import close
from tests.core.bodies import moebius
from tests.corpus import shapes as s


def moments_of(order, factor=1.0, about=(1.0, 2.0, 3.0)):
    """Of five points with weights, with bounds that are all different."""
    rng = np.random.default_rng(3)
    points, weights = rng.normal(size=(5, 3)), rng.uniform(1.0, 2.0, 5)
    raw = weights @ (points[:, None] ** monomials(order)).prod(axis=2)
    bounds = factor * 1e-9 * (1.0 + np.arange(len(raw)))
    return Moments(factor * raw, np.array(about), Measure.VOLUME, bounds, 5.0 * bounds)


def test_moments_that_are_known_take_the_place_of_their_own_about_the_same_point_alone():
    own, known, count = moments_of(5), moments_of(3, 1.5), monomial_count(3)
    found = with_known(own, known)
    for name in ("raw", "rounding_error", "input_error"):
        assert np.array_equal(getattr(found, name)[:count], getattr(known, name))
        assert np.array_equal(getattr(found, name)[count:], getattr(own, name)[count:])
    assert np.array_equal(found.about, own.about) and found.order == 5 and found.measure == own.measure
    assert with_known(own, moments_of(3, 1.5, (1.0, 2.0, 4.0))) is own


def test_bounds_that_are_known_to_be_smaller_count_about_the_same_point_alone():
    own, count = moments_of(5), monomial_count(3)
    smaller, larger = moments_of(3, 0.5), moments_of(3, 2.0)
    found = with_input_error(own, smaller)
    assert np.array_equal(found.input_error, np.concatenate([smaller.input_error, own.input_error[count:]]))
    assert np.array_equal(with_input_error(own, larger).input_error, own.input_error)
    for name in ("raw", "rounding_error", "about"):
        assert np.array_equal(getattr(found, name), getattr(own, name))
    assert np.array_equal(own.input_error, moments_of(5).input_error)  # which is nobody else's to change
    assert with_input_error(own, moments_of(3, 0.5, (1.0, 2.0, 4.0))) is own


def test_bounds_of_other_orders_grow_by_the_reach_from_degree_to_degree():
    known = moments_of(2)
    swept, further = known.input_error[:2]
    found = extend_input_error(moments_of(4), known)
    for power, bound in zip(monomials(4).sum(axis=1).tolist(), found.input_error):
        assert close(bound, swept * (further / swept) ** power, 1e-14)
    nothing = Moments(known.raw, known.about, known.measure, known.rounding_error, np.zeros_like(known.raw))
    assert not extend_input_error(moments_of(4), nothing).input_error.any()


def turn(rng):
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return rotation * np.linalg.det(rotation)


def image(moments, linear):
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    return moments.transform(matrix).about_center().raw


@pytest.mark.parametrize("seed", range(3))
def test_each_body_is_the_image_of_its_own_moments_which_bodies_of_one_shape_share(seed):
    rng = np.random.default_rng(seed)
    shapes = [moments_of(3, about=(0.0, 0.0, 0.0)), moments_of(3, 2.0, (0.5, -0.25, 4.0))]
    scales, mirror = (2.0, 0.5, 3.0), np.diag([1.0, 1.0, -1.0])
    linear = [scale * turn(rng) for scale in scales] + [0.7 * turn(rng) @ mirror, 1.3 * turn(rng) @ mirror]
    linear += [turn(rng) @ np.diag([1.0, 2.0, 3.0]), turn(rng) @ np.diag([1.0, 2.0, -3.0]), linear[0]]
    which = np.array([0, 1, 0, 0, 0, 0, 0, 1])
    found = own_moments(shapes, which, np.array(linear))
    numbers = found.shape.tolist()
    assert numbers[0] == numbers[2] and numbers[1] == numbers[7] and numbers[3] == numbers[4]
    assert sorted(set(numbers)) == [0, 1, 2, 3, 4] and len({numbers[k] for k in (0, 1, 3, 5, 6)}) == 5
    for body, (shape, matrix) in enumerate(zip(which.tolist(), linear)):
        is_even, rotation = body not in (5, 6), found.rotation[body]
        own = found.moments.at(np.array([numbers[body]]))
        own = Moments(own.raw[0], own.about[0], Measure.VOLUME)
        assert np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-12 and np.linalg.det(rotation) > 0.0
        size = np.cbrt(abs(np.linalg.det(matrix))) if is_even else 1.0
        truth = image(shapes[shape], matrix)
        assert np.abs(image(own, size * rotation) - truth).max() <= 1e-11 * np.abs(truth).max()
        assert is_even or np.array_equal(rotation, np.eye(3))


CASES = {
    "box": (s.box((0, 0, 0), (1, 2, 3)), 12),
    "open": (s.without(s.box((0, 0, 0), (1, 2, 3)), 0), 14),
    "turned face": (s.with_flipped(s.box((0, 0, 0), (1, 2, 3)), 1), 12),
    "twice": ((s.box()[0], [*s.box()[1], s.box()[1][0]]), 12),
    "with a leaf": (s.joined(s.box(), (np.array([(5.0, 0, 0), (6, 0, 0), (5, 1, 0)]), [(0, 1, 2), (0, 2, 1)])), 14),
    "strip": (tuple(map(np.ndarray.tolist, moebius())), None),
}


@pytest.mark.usefixtures("scene")
@pytest.mark.parametrize("scale", [(1, 1, 1), (0.5, 2, -1)])
@pytest.mark.parametrize("name", CASES)
def test_moments_of_any_order_begin_with_those_that_were_measured(name, scale):
    """Of the volume of what was repaired, and of the area of the faces that are there."""
    (points, faces), count = CASES[name]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(points, float).tolist(), [], [list(map(int, face)) for face in faces])
    obj = add(mesh, scale=scale, location=(3, 4, 5), rotation=(0.3, 0.4, 0.5))
    if name == "strip":
        obj.body_moments.kind = "SHELL"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = measure_body(obj, depsgraph).body
    sheet = measure_body(obj, depsgraph, MeasureOptions(kind="shell", thickness=1.0)).body.area
    for order in (2, 3, 4, 6):
        volume, area = found.moments(order, True)
        assert (volume.order, area.order) == (order, order) and found.moments(order, True) == (volume, area)
        assert found.moments(order, False)[1] is None
        low = min(order, 3)
        for one, known in ((volume, found.volume), (found.moments(order, False)[0], found.volume), (area, sheet)):
            known = known.about_point(one.about).truncate(low).raw
            assert np.abs(one.truncate(low).raw - known).max() <= 1e-12 * np.abs(known).max(), (order, one.measure)
    sheets, solids = (list(found.surfaces(kind)) for kind in (True, False))
    assert [len(one.all_triangles()[0]) for one in sheets] == [sum(len(face) - 2 for face in faces)]
    assert count is None or [len(one.all_triangles()[0]) for one in solids] == [count]
    place = np.array(obj.matrix_world, float)
    truth = np.asarray(points, float) @ place[:3, :3].T + place[:3, 3]
    assert np.abs(sheets[0].points - truth).max() < 1e-5
