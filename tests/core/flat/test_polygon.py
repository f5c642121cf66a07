# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Area moments of polygons against rational integration, and defects that make a polygon
ambiguous.
"""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.flat.polygon import (
    OutlineDefects,
    area_moments,
    directed_edges,
    find_defects,
    orient_loops,
    outline_areas,
    winding_numbers,
)
from body_moments.core.mesh.edges import uncancelled_sides
from body_moments.core.polyhedron.n_dimensions import facet_moments, multi_indices

from tests.close import close
from tests.core import rational
from tests.core.findings import refused
from tests.core.polygons import rectangle, shape

STAR = [(0, 0), (3, 1), (6, 0), (5, 3), (6, 6), (3, 5), (0, 6), (1, 3)]
HOLED = shape(STAR, rectangle(2, 2, 1, 2)[::-1])


@pytest.mark.parametrize(
    "scale, offset", [(1.0, (0, 0)), (2.0**-30, (1.0, 2.0)), (0.7, (1e4, -3e4)), (1e6, (5, 5))]
)
@pytest.mark.parametrize("mirrored", [False, True])
def test_star_with_a_hole_has_moments_within_bounds(scale, offset, mirrored):
    points, loops = HOLED
    points = (points * [-1 if mirrored else 1, 1]) @ np.array(
        [[1.0, 0.3], [-0.2, 1.1]]
    ).T * scale + offset
    loops = [loop[::-1] if mirrored else loop for loop in loops]
    found = area_moments(points, directed_edges(loops), 8)
    exactly, about = rational.fractions(points), tuple(Fraction(x) for x in found.about)
    for i, row in enumerate(multi_indices(2, 8).tolist()):
        truth = rational.enclosed(exactly, directed_edges(loops).tolist(), row, about)
        assert abs(Fraction(found.raw[i]) - truth) <= Fraction(found.rounding_error[i])
        reach = np.abs(points - found.about).max()
        assert found.rounding_error[i] <= 1e-11 * found.raw[0] * reach ** sum(row) * max(
            1.0, np.abs(offset).max() / scale / 1e4
        )
    assert found.raw[0] > 0.0


def test_rectangle_moments_to_order_20_are_products():
    points, loops = shape(rectangle(-1.5, 0.25, 4, 2))
    found = area_moments(points, directed_edges(loops), 20, about=(0.0, 0.0))
    for i, (p, q) in enumerate(multi_indices(2, 20).tolist()):
        truth = (
            (Fraction(5, 2) ** (p + 1) - Fraction(-3, 2) ** (p + 1))
            / (p + 1)
            * (Fraction(9, 4) ** (q + 1) - Fraction(1, 4) ** (q + 1))
            / (q + 1)
        )
        assert abs(Fraction(found.raw[i]) - truth) <= Fraction(found.rounding_error[i])
        assert abs(found.raw[i] / float(truth) - 1.0) < 1e-14
    assert found[2, 0] == found.raw[3]


def test_the_outline_has_its_length_and_its_moments():
    points, loops = shape(rectangle(0, 0, 3, 4), rectangle(1, 1, 1, 1))
    found = facet_moments(points, orient_loops(points, loops), 1, about=(0.0, 0.0))
    assert found.raw[0] == 14 + 4
    assert close(found.raw[1], 14 * 1.5 + 4 * 1.5, rel=1e-14)
    assert facet_moments(points, orient_loops(points, loops), 0).raw.tolist() == [18.0]


def test_an_open_outline_is_refused():
    with refused("outline_open", count=2):
        area_moments(np.eye(2), [(0, 1)], 0)


@pytest.mark.parametrize("turned", range(8))
def test_loops_of_any_direction_nest_as_holes_and_islands(turned):
    points, loops = shape(
        rectangle(0, 0, 6, 6), rectangle(1, 1, 4, 4), rectangle(2, 2, 2, 2), rectangle(8, 0, 1, 1)
    )
    loops = [loop[::-1] if turned >> i & 1 else loop for i, loop in enumerate(loops)]
    edges = orient_loops(points, loops)
    assert area_moments(points, edges, 0).raw[0] == 36 - 16 + 4 + 1
    assert sorted(outline_areas(points, edges)) == [-16, 1, 4, 36]
    assert (
        find_defects(points, edges).crossings == 0 and not find_defects(points, edges).overlapping
    )


@pytest.mark.parametrize("first", range(4))
def test_crossing_outlines_are_not_holes(first):
    """None is in the other, whichever of its edges begins in there."""
    low, high = rectangle(0, 0, 4, 4), rectangle(1, 1, 5, 5)
    for other in (
        high,
        [(-x, y) for x, y in low],
        [(x, -y) for x, y in high],
        [(-x, -y) for x, y in high],
    ):
        points, loops = shape(np.roll(low, first, axis=0), np.roll(other, first, axis=0))
        areas = outline_areas(points, orient_loops(points, loops))
        assert (areas > 0.0).all()


def test_outlines_touching_along_edges_and_corners_are_no_flaw():
    points, loops = shape(
        rectangle(0, 0, 4, 4), rectangle(4, 1, 2, 2), rectangle(6, 3, 1, 1), rectangle(4, 3, 1, 1)
    )
    edges = orient_loops(points, loops)
    assert area_moments(points, edges, 0).raw[0] == 16 + 4 + 1 + 1
    found = find_defects(points, edges)
    assert not found.crossings and not found.overlapping and not found.too_many_pairs


@pytest.mark.parametrize("first", range(4))
@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_a_hole_with_most_of_its_sides_on_the_outline_is_a_hole(first, angle):
    """From side to side, and with three sides on the outline."""
    cosine, sine = math.cos(angle), math.sin(angle)
    for hole, area in ((rectangle(1, 0, 2, 4), 8.0), (rectangle(0, 0, 4, 1), 12.0)):
        points, loops = shape(rectangle(0, 0, 4, 4), np.roll(hole, first, axis=0))
        points = points @ np.array([[cosine, sine], [-sine, cosine]])
        assert close(area_moments(points, orient_loops(points, loops), 0).raw[0], area, 1e-14)
        assert close(sorted(outline_areas(points, orient_loops(points, loops[:1]))), [16.0], 1e-14)


PENTAGRAM = [(math.cos(4 * math.pi * k / 5), math.sin(4 * math.pi * k / 5)) for k in range(5)]


@pytest.mark.parametrize(
    "outlines, crossings",
    [
        ([[(0, 0), (2, 2), (2, 0), (0, 2)]], 1),
        ([PENTAGRAM], 5),
        ([rectangle(0, 0, 4, 4), rectangle(2, 2, 4, 4)], 2),
        ([rectangle(0, 1, 9, 1), rectangle(4, -3, 1, 9)], 4),
    ],
)
@pytest.mark.parametrize("offset", [0.0, 1e5])
def test_crossing_outlines_are_found(outlines, crossings, offset):
    points, loops = shape(*outlines)
    assert find_defects(points + offset, directed_edges(loops)).crossings == crossings


def test_stacked_regions_without_crossings_are_found():
    points, loops = shape(rectangle(0, 0, 4, 4), rectangle(1, 1, 1, 1))
    assert find_defects(points, directed_edges(loops)) == find_defects(
        points, directed_edges(loops)[::-1]
    )
    assert (
        find_defects(points, directed_edges(loops)).overlapping
        and not find_defects(points, directed_edges(loops)).crossings
    )
    points, loops = shape(rectangle(0, 0, 4, 4), rectangle(0, 0, 4, 4), rectangle(0, 0, 4, 2))
    assert (
        find_defects(points, directed_edges(loops[:2])).overlapping
        and find_defects(points, directed_edges(loops[1:])).overlapping
    )
    # Through a corner of the other, so that no edge crosses another in its inside.
    points, loops = shape(
        [(0, 0), (4, 0), (4, 2), (4, 4), (0, 4)], [(2, 2), (4, 2), (6, 0), (6, 4)]
    )
    assert find_defects(points, directed_edges(loops)).overlapping


@pytest.mark.parametrize("offset", [0.0, 1e3])
@pytest.mark.parametrize("away", [0.0, 0.5])
def test_repeated_points_are_no_flaw(offset, away):
    """Imported drawings have such outlines; away: the distance in float32 steps."""
    rng = np.random.default_rng(3)
    for turn in rng.uniform(0.0, 7.0, 40):
        points = np.array([(math.cos(turn + k), math.sin(turn + k)) for k in range(6)]) + offset
        step = float(np.spacing(np.float32(offset + 1.0)))
        points = np.insert(points, 3, points[2] + away * step * rng.uniform(-1.0, 1.0, 2), axis=0)
        assert find_defects(points, directed_edges([np.arange(7)]), error=step) == OutlineDefects(
            0, False, False
        )
        assert find_defects(points, directed_edges([np.arange(7)[::-1]]), error=step).negative


def test_reversed_outline_counts_negative():
    points, loops = shape([(0, 0), (4, 4), (4, 0), (0, 5)], PENTAGRAM, rectangle(0, 0, 4, 4))
    assert find_defects(points, directed_edges(loops[:1])).negative
    found = find_defects(points, directed_edges(loops[1:2]))
    assert found.overlapping and not found.negative
    assert not find_defects(points, directed_edges(loops[2:])).negative


@pytest.mark.parametrize("turn, offset", [(0.0, 0.0), (0.3, 0.0), (0.7, 1e3)])
@pytest.mark.parametrize(
    "outlines, shared",
    [
        ([rectangle(0, 0, 2, 2), rectangle(2, 0, 1, 1), rectangle(2, 1, 1, 1)], 3.0),
        ([rectangle(0, 0, 2, 3), rectangle(2, 2, 2, 3)], 1.0),
        ([rectangle(0, 0, 4, 4), rectangle(0, 1, 2, 2)], 2.0),
        ([rectangle(0, 0, 4, 4), rectangle(0, 0, 2, 2)], 4.0),
        ([rectangle(0, 0, 1, 1), rectangle(1, 1, 1, 1), rectangle(3, 0, 1, 1)], 0.0),
    ],
)
def test_shared_length_of_outlines_is_measured(outlines, shared, turn, offset):
    points, loops = shape(*outlines)
    points = (
        points @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
        + offset
    )
    assert find_defects(points, orient_loops(points, loops)).shared_length == pytest.approx(
        shared, abs=1e-11
    )


def test_outlines_on_one_another_are_refused():
    points, loops = shape(rectangle(0, 0, 4, 4), rectangle(0, 0, 4, 4))
    with refused("outlines_coincide"):
        orient_loops(points, loops)


def test_winding_number_is_whole_inside_and_half_on_an_edge():
    points, loops = HOLED
    at = np.array(
        [
            [1.5, 3.0],
            [2.5, 3.0],
            [50.0, 0.0],
            (points[0] + points[1]) / 2,
            (points[8] + points[9]) / 2,
        ]
    )
    assert winding_numbers(points, directed_edges(loops), at) == pytest.approx(
        [1, 0, 0, 0.5, 0.5], abs=1e-12
    )


@pytest.mark.parametrize(
    ("triangles", "sides"),
    [
        (
            [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]],
            [(0, 1), (1, 2), (2, 5), (3, 0), (4, 3), (5, 4)],
        ),
        ([[0, 1, 2], [0, 1, 2]], [(0, 1), (0, 1), (1, 2), (1, 2), (2, 0), (2, 0)]),
        ([[3, 3, 4], [0, 1, 2], [2, 1, 0], [4, 5, 4]], []),
        ([], []),
        ([[3, 3, 4], [2, 1, 0], [4, 5, 4]], [(0, 2), (1, 0), (2, 1)]),
    ],
)
def test_boundary_of_triangles_holds_uncancelled_sides(triangles, sides):
    triangles = np.array(triangles, int).reshape(-1, 3)
    _, start, stop = uncancelled_sides(triangles, np.zeros(len(triangles), int))
    assert sorted(zip(start.tolist(), stop.tolist())) == sides


def lattice_polygon(rng, size):
    """A triangle or quad, counter-clockwise, with corners on a coarse lattice."""
    while True:
        corners = rng.integers(0, size, (int(rng.integers(3, 5)), 2))
        to = corners - corners.mean(axis=0)
        corners = corners[np.argsort(np.arctan2(to[:, 1], to[:, 0]))]
        if area_moments(corners, directed_edges([np.arange(len(corners))]), 0).raw[0] > 0.4:
            return corners


@pytest.mark.parametrize("size", [4, 9])
def test_flaws_of_random_regions_match_winding_numbers(size):
    """On a lattice many outlines touch, share edges and corners, or lie on one another."""
    rng = np.random.default_rng(size)
    at = rng.uniform(0, size, (1000, 2))
    seen = []
    for _ in range(100):
        points, loops = shape(*(lattice_polygon(rng, size) for _ in range(int(rng.integers(1, 4)))))
        edges = directed_edges(loops)
        seen.append(bool((np.round(winding_numbers(points, edges, at)) > 1).any()))
        found = find_defects(points, edges)
        assert (found.overlapping or found.crossings > 0) == seen[-1]
    assert 20 < sum(seen) < 80


def exact_defects(points, edges):
    """Defects by whole numbers, for each pair of edges and both sides of each edge; the shared
    length alone is a float.
    """
    crossings, shared = 0, 0.0
    edges = [edge for edge in edges.tolist() if (points[edge[0]] != points[edge[1]]).any()]
    for row, (a, b) in enumerate(edges):
        for c, d in edges[:row]:
            one, other = points[b] - points[a], points[d] - points[c]
            turns = [turn(one, points[c] - points[a]), turn(one, points[d] - points[a])]
            turns += [turn(other, points[a] - points[c]), turn(other, points[b] - points[c])]
            crossings += turns[0] * turns[1] < 0 and turns[2] * turns[3] < 0
            if not any(turns) and one @ other < 0:
                along = [(points[i] - points[a]) @ one for i in (c, d)]
                shared += max(0, min(along[0], one @ one) - max(along[1], 0)) / math.sqrt(one @ one)
    middles = np.array([(points[a] + points[b]) / 2.0 for a, b in edges])
    left = np.array([(points[a] - points[b])[::-1] * (1, -1) for a, b in edges]) * 1e-4
    left, right = (
        np.round(winding_numbers(points, np.array(edges), middles + side)) for side in (left, -left)
    )
    negative = bool((right < 0).any())
    overlapping = negative or bool((left < right).any() or (left > 1).any())
    return OutlineDefects(crossings, False, overlapping, negative, shared)


def turn(a, b):
    return int(a[0] * b[1] - a[1] * b[0])


@pytest.mark.parametrize(
    "scale", [(1, 1), (2.0**-20, 2.0**-20), (2.0**9, 2.0**9), (4, 1), (0.5, 2)]
)
@pytest.mark.parametrize("offset", [(0, 0), (-40, 25)])
def test_findings_of_random_regions_match_exact_arithmetic(scale, offset):
    """Edges on a lattice, of both senses, with points that are there twice."""
    rng = np.random.default_rng(12)
    kinds = set()
    for _ in range(25):
        outlines = [
            lattice_polygon(rng, 5)[:: 1 if rng.random() < 0.8 else -1]
            for _ in range(int(rng.integers(1, 4)))
        ]
        outlines = [np.insert(one, 1, one[0], axis=0) for one in outlines]
        points, loops = shape(*outlines)
        points, edges = points * scale + np.multiply(offset, scale), directed_edges(loops)
        truth, found = exact_defects(points / min(scale), edges), find_defects(points, edges)
        assert close(found.shared_length, min(scale) * truth.shared_length, 1e-12)
        assert replace(found, shared_length=0.0) == replace(truth, shared_length=0.0)
        kinds.add(
            (min(found.crossings, 1), found.overlapping, found.negative, found.shared_length > 0.0)
        )
    assert len(kinds) >= 7


@pytest.mark.parametrize("way", [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
def test_edges_without_area_have_no_defects(way):
    points = np.outer([0.0, 1.0, 3.0], way) + 5.0
    found = find_defects(points, np.array([[0, 1], [1, 2], [2, 0]]))
    assert not found.crossings and not found.too_many_pairs


@pytest.mark.parametrize("y, overlapping", [(0.0, True), (0.5, False), (-0.5, False)])
def test_a_stroke_there_and_back_overlaps_only_on_a_side(y, overlapping):
    """There one of its two edges has the outside to its left and the inside to its right."""
    points = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.25, y), (0.75, y)])
    edges = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 4)])
    found = find_defects(points, edges)
    assert found.overlapping == overlapping and not found.negative and found.crossings == 0
