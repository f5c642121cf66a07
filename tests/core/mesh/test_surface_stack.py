# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the faces of stacked surfaces hang together, where the corners and edges of some do not fit their faces."""

from dataclasses import replace

import numpy as np
import pytest
from body_moments.core.mesh.surface_stack import SurfaceStack

from tests.core.bodies import CORNERS, SIDES, mesh
from tests.core.mesh.test_edges import box_with_a_face_of_two_corners, pyramid

BOX = mesh(CORNERS, SIDES.tolist(), np.float32)


def connections(*surfaces):
    assert all(SurfaceStack.takes(surface) for surface in surfaces)
    return SurfaceStack.of(surfaces).connections()


TETRAHEDRON = mesh(np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.float32)
PYRAMID = mesh(*pyramid(5), np.float32)
BENT = replace(BOX, points=np.random.default_rng(2).normal(size=(8, 3)).astype(np.float32))
LOOSE = replace(  # its first vertex has no faces, and neither has its first edge
    TETRAHEDRON,
    points=np.concatenate([BENT.points[:1], TETRAHEDRON.points]),
    triangles=TETRAHEDRON.triangles + 1,
    corner_vertices=TETRAHEDRON.corner_vertices + 1,
    corner_edges=TETRAHEDRON.corner_edges + 1,
)


@pytest.mark.parametrize(
    "surfaces",
    [
        [BOX],
        [TETRAHEDRON],
        [TETRAHEDRON, PYRAMID, LOOSE],
        [BENT, TETRAHEDRON, BOX],
        [PYRAMID, BOX, BENT, LOOSE, TETRAHEDRON, BENT],
        [replace(TETRAHEDRON, triangle_faces=None), replace(BENT, quad_faces=None, triangle_faces=None), PYRAMID],
    ],
)
def test_a_stack_holds_the_arrays_of_each_one_after_the_other(surfaces):
    stack = SurfaceStack.of(surfaces)
    firsts = np.zeros(5, int)
    assert len(stack) == len(surfaces)
    for k, surface in enumerate(surfaces):
        triangles, own_faces = surface.all_triangles()
        corners = np.asarray(surface.corner_vertices)
        counts = [len(surface.points), len(triangles), len(surface.quads), len(corners), int(own_faces.max()) + 1]
        for name, count in zip(("point", "triangle", "quad", "corner", "face"), counts):
            assert getattr(stack, name + "_counts")[k] == count
        assert stack.edge_counts[k] == int(surface.corner_edges.max()) + 1
        point, triangle, quad, corner, face = firsts
        edge = int(stack.edge_counts[:k].sum())
        assert (stack.first_point[k], stack.first_triangle[k], stack.first_face[k]) == (point, triangle, face)
        assert np.array_equal(stack.points[point:][: counts[0]], surface.points)
        assert np.array_equal(stack.triangles[triangle:][: counts[1]] - point, triangles)
        assert np.array_equal(stack.triangle_faces[triangle:][: counts[1]] - face, own_faces)
        assert np.array_equal(stack.quads[quad:][: counts[2]] - point, surface.quads)
        own_quads = own_faces[len(surface.triangles) :: 2]
        assert np.array_equal(stack.quad_faces[quad:][: counts[2]] - face, own_quads)
        assert np.array_equal(stack.corner_vertices[corner:][: counts[3]] - point, corners)
        assert np.array_equal(stack.corner_edges[corner:][: counts[3]] - edge, surface.corner_edges)
        sizes = np.zeros(counts[4], int)
        np.add.at(sizes, own_faces, 1)
        assert np.array_equal(stack.face_sizes[face:][: counts[4]], np.where(sizes > 0, sizes + 2, 0))
        low, high = (end[k] for end in stack.box)
        assert np.array_equal([low, high], surface.box)
        firsts += counts
    assert stack.uses_all_points().tolist() == [surface is not LOOSE for surface in surfaces]
    number, found = np.arange(len(surfaces)), stack.connections()
    assert stack.point_owners.tolist() == np.repeat(number, stack.point_counts).tolist()
    assert found.is_closed.all() and (found.component_counts == 1).all() and not found.open_sides.size
    assert found.component.tolist() == np.repeat(number, stack.face_counts).tolist()
    for some in (number, number[::2], number[-1:]):
        fewer = stack.some(some)
        assert fewer.point_counts.tolist() == stack.point_counts[some].tolist()
        expected = [surfaces[k].all_triangles()[0] + first for k, first in zip(some, fewer.first_point)]
        assert np.array_equal(fewer.triangles, np.concatenate(expected))
        assert np.array_equal(fewer.points, np.concatenate([surfaces[k].points for k in some]))


def with_corners(count):
    """The box, with so many of its 24 corners, or the first ones again after them."""
    return replace(
        BOX, corner_vertices=np.resize(BOX.corner_vertices, count), corner_edges=np.resize(BOX.corner_edges, count)
    )


@pytest.mark.parametrize("other", [with_corners(20), with_corners(28)], ids=["fewer", "more"])
def test_a_surface_with_more_or_fewer_corners_than_its_faces_have_does_not_disturb_others(other):
    for stack in ([other, BOX], [BOX, other], [other, BOX, with_corners(24)], [BOX, other, BOX]):
        found = connections(*stack)
        fits = [surface is not other for surface in stack]
        assert found.is_closed.tolist() == fits and not found.is_open.any()
        assert found.component_counts[fits].tolist() == [1] * sum(fits)


def test_surfaces_whose_corners_make_up_for_each_other_s_do_not_fit_either():
    found = connections(with_corners(20), BOX, with_corners(28), mesh(CORNERS, SIDES[:5].tolist(), np.float32))
    assert found.is_closed.tolist() == [False, True, False, False]
    assert found.is_open.tolist() == [False, False, False, True]
    start, stop = found.open_sides - 3 * len(CORNERS)
    assert sorted(zip(start.tolist(), stop.tolist())) == sorted(zip(SIDES[5], np.roll(SIDES[5], 1)))


def test_a_surface_with_a_face_without_triangles_does_not_fit():
    gap = replace(BOX, quad_faces=np.array([0, 1, 2, 3, 4, 6]))
    assert connections(BOX, gap, BOX).is_closed.tolist() == [True, False, True]


@pytest.mark.parametrize("place", range(7))
def test_a_surface_with_a_face_of_two_corners_does_not_fit(place):
    found = connections(BOX, box_with_a_face_of_two_corners(place), BOX)
    assert found.is_closed.tolist() == [True, False, True] and not found.is_open.any()


def exchanged(first, second):
    """The box with two edges, given by their vertices, exchanged where they run from the second vertex to the first."""
    vertices, edges = BOX.corner_vertices, BOX.corner_edges.copy()
    following = vertices.reshape(-1, 4)[:, [1, 2, 3, 0]].ravel()
    (one,) = np.flatnonzero((vertices == first[1]) & (following == first[0]))
    (other,) = np.flatnonzero((vertices == second[1]) & (following == second[0]))
    edges[[one, other]] = edges[[other, one]]
    return replace(BOX, corner_edges=edges)


@pytest.mark.parametrize(
    "edges",
    [((0, 1), (6, 7)), ((0, 1), (0, 2)), ((1, 3), (2, 3)), ((1, 0), (2, 0)), ((3, 1), (3, 2))],
    ids=["apart", "from one vertex", "to one vertex", "down to one vertex", "down from one vertex"],
)
def test_edges_that_join_other_vertices_close_nothing(edges):
    found = connections(BOX, exchanged(*edges), BOX)
    assert found.is_closed.tolist() == [True, False, True] and not found.is_open.any()


def test_coordinates_are_as_inexact_as_the_largest_of_their_surface_up_to_the_largest_there_is():
    """Which has the step of 2^127, half of which is 2^103."""
    largest = np.finfo(np.float32).max
    ends = [(-largest, 1.0, 3.0), (0.0, largest, -(2.0**127)), (1.0, -7.0, 2.0**-100)]
    boxes = [replace(BOX, points=(CORNERS * np.array(end)).astype(np.float32)) for end in ends]
    exponents = [[103, -24, -23], [-150, 103, 103], [-24, -22, -124]]
    found = SurfaceStack.of(boxes).coordinate_error
    assert np.array_equal(found, np.ldexp(1.0, exponents))
    assert np.array_equal(found, [surface.coordinate_error for surface in boxes])


@pytest.mark.parametrize(
    "lacking",
    [
        {"corner_edges": None},
        {"corner_vertices": None},
        {"corner_vertices": None, "corner_edges": None},
        {"corner_edges": BOX.corner_edges[:-1]},
        {"corner_edges": BOX.corner_edges - 1},
        {"corner_edges": BOX.corner_edges + 48},
        {"corner_edges": BOX.corner_edges + 37},
        {"corner_vertices": BOX.corner_vertices[:0], "corner_edges": BOX.corner_edges[:0]},
        {"displacement": np.full(3, 1e-3)},
        {"corner_vertices": BOX.corner_vertices + 1},
        {"points": BOX.points.astype(np.float64)},
        {"quads": BOX.quads[:0], "quad_faces": BOX.quad_faces[:0]},
    ],
)
def test_a_surface_without_sound_corners_and_edges_is_not_taken(lacking):
    assert SurfaceStack.takes(BOX) and not SurfaceStack.takes(replace(BOX, **lacking))


def test_edges_without_faces_may_be_as_many_as_make_twice_the_corners():
    """Where the box has 24 corners, its 12 edges may follow after 36 others."""
    other = replace(BOX, corner_edges=BOX.corner_edges + 36)
    assert SurfaceStack.takes(other)
    assert connections(BOX, other, BOX).is_closed.tolist() == [True, True, True]
