# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches beside the mesh that Blender displays: what agrees with it, what is recovered from it, what is neither."""

import bpy
import numpy as np
import pytest
from body_moments.blender.read.nurbs import splines
from body_moments.core.nurbs.blender_knots import blender_space, display_parameters, display_table
from body_moments.core.nurbs.patch import Patch

from tests.blender.objects import add
from tests.blender.spline_bodies import surface

pytestmark = pytest.mark.usefixtures("scene")
FAR = np.array([300.0, -20.0, 7.0])
HALF_ULP = 2.0**-24


def made(seed, weighted, shape=(5, 4), orders=(3, 4)):
    """A patch away from the origin, and where its display mesh samples it."""
    rng = np.random.default_rng(seed)
    spaces = tuple(blender_space(count, order, False, False, True) for count, order in zip(shape, orders))
    points = FAR + rng.uniform(-1.0, 1.0, (*shape, 3)) * (3.0, 2.0, 1.0)
    weights = rng.uniform(0.5, 2.0, shape) if weighted else None
    return Patch(spaces, points, weights), tuple(display_table(space, display_parameters(space, 3)) for space in spaces)


def shown(patch, sample):
    """(n, 3) the vertices as Blender has them: along v within each step of u."""
    return patch.apply_weights(*sample).swapaxes(0, 1).reshape(-1, 3)


@pytest.mark.parametrize("weighted", [False, True])
def test_control_points_come_back_from_the_points_of_the_surface(weighted):
    patch, sample = made(1, weighted)
    other, _ = made(2, False)
    truth = Patch(patch.spaces, other.points, patch.weights)
    found = splines._interpolating_patch(patch, sample, truth.apply_weights(*sample))
    assert np.abs(found.points - truth.points).max() <= 1e-10 * 300.0
    assert (found.weights is None) == (not weighted) and (not weighted or (found.weights == patch.weights).all())


@pytest.mark.parametrize("direction", [0, 1])
def test_samples_that_hardly_determine_a_control_point_recover_none(direction):
    patch, sample = made(1, False, (2, 2), (2, 2))
    piece = np.zeros((2, 2, 3))
    for condition, is_found in ((0.99e4, True), (1.01e4, False)):
        tables = [np.eye(2), np.eye(2)]
        tables[direction] = np.diag([1.0, 1.0 / condition])
        assert (splines._interpolating_patch(patch, tuple(tables), piece) is not None) == is_found
    tables[direction] = np.diag([1.0, 0.0])  # what nothing shows may lie anywhere
    assert splines._interpolating_patch(patch, tuple(tables), piece) is not None


@pytest.mark.parametrize("weighted", [False, True])
def test_what_agrees_is_kept_what_can_be_is_recovered_and_all_else_is_none(weighted):
    patches, samples = zip(made(1, weighted), made(2, False, (3, 6), (2, 3)))
    patches, samples = list(patches), list(samples)
    vertices = np.concatenate([shown(*pair) for pair in zip(patches, samples)])
    for number in (0, len(vertices) - 1):
        for axis in range(3):
            for sign in (-1.0, 1.0):
                off = vertices.copy()
                off[number, axis] += sign * 0.99e-3
                assert splines._verified(patches, samples, off, 1e-3) is patches
                off[number, axis] += sign * 0.02e-3
                assert splines._verified(patches, samples, off, 1e-3) is not patches
    moved = [Patch(patch.spaces, patch.points[::-1] + 1.0, patch.weights) for patch in patches]
    others = np.concatenate([shown(*pair) for pair in zip(moved, samples)])
    found = splines._verified(patches, samples, others, 1e-9)
    for one, truth in zip(found, moved, strict=True):
        assert np.abs(one.points - truth.points).max() <= 1e-9
    assert splines._verified(patches, samples, others[:-1], 1e9) is None
    first = len(shown(patches[0], samples[0]))
    for number in (0, first):  # one of them is no such patch
        off = others.copy()
        off[number] += 0.5
        assert splines._verified(patches, samples, off, 1e-3) is None
    singular = [samples[0], (np.diag([1.0, 1e-5, 1.0]).repeat(3, axis=0), samples[1][1])]
    assert splines._verified(patches, singular, others, 1e9) is patches
    assert splines._verified(patches, singular, others, 1e-3) is None


def reading(obj, mesh=None):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return splines.spline_reading(obj.evaluated_get(depsgraph), depsgraph, mesh)


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("far", [0.0, 1.0])
def test_what_float32_may_have_moved_is_bounded_and_not_by_much_more(weighted, far):
    """Three coordinates of half a step each, and a weight of half a step, which moves a point by no more than twice
    that of the size."""
    patch, sample = made(1, weighted)
    points = (patch.points - (1.0 - far) * FAR).astype(np.float32)
    obj = surface(points, patch.weights, orders=(4, 3))
    points = points.astype(float)
    size = np.ptp(points.reshape(-1, 3), axis=0).max()
    bound = HALF_ULP * (np.sqrt(3.0) * np.abs(points).max() + weighted * 2.0 * size)
    plain = reading(obj)
    assert bound <= plain.stored <= 1.05 * bound and not plain.findings
    moved = Patch(patch.spaces, points[::-1].copy(), patch.weights)
    mesh = bpy.data.meshes.new("Shown")
    vertices = shown(moved, sample).astype(np.float32)
    mesh.from_pydata(vertices.tolist(), [], [])
    found = reading(obj, mesh)
    assert [one.code for one in found.findings] == ["control_points_recovered"]
    off = np.abs(found.patches[0].points - moved.points).max()
    assert off <= found.stored and 0.5e-6 * size <= found.stored - plain.stored <= 2e-6 * size
    limit = 4e-6 * np.abs(points).max()
    truth = shown(Patch(patch.spaces, points, patch.weights), sample)
    for factor, is_kept in ((0.9, True), (1.1, False)):
        vertices = truth.copy()
        vertices[7, 1] += factor * limit
        mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
        found = reading(obj, mesh)
        assert (found is not None and not found.findings) == is_kept


def test_what_is_no_surface_of_splines_alone_is_left_to_the_display_mesh():
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
    assert [(one.code, one.values) for one in found.findings] == [("splines_left_out", {"count": 1, "total": 2})]
    obj.data.splines.new("POLY")
    obj.data.update_tag()
    assert reading(obj) is None
    assert reading(add(bpy.data.curves.new("Empty", "SURFACE"))) is None
    obj = surface(points)
    obj.modifiers.new("Thick", "SOLIDIFY")
    assert reading(obj) is None
