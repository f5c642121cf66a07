# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Relations of shells: boxes and spheres with known answers, and brute force."""

import numpy as np
import pytest
from body_moments.core.mesh import Bvh, Surface, sort_components
from body_moments.core.solid import ComponentComparison, measure_solid
from body_moments.core.solid.nesting import (
    ComponentRelations,
    cavity_host,
    classify_pairs,
    orient_nested_components,
)
from hypothesis import given

from tests.close import close
from tests.core.bodies import box, inverted, joined, moved, rotation, sphere, surface, torus
from tests.core.findings import codes, only
from tests.core.strategies import holds, seeds

TOUCH = 1e-6
OUTER, INNER = box((-2, -2, -2), (2, 2, 2)), box((-1, -1, -1), (1, 1, 1))


def shells_of(*parts):
    points, triangles = joined(*parts)
    shell = np.repeat(np.arange(len(parts)), [len(part[1]) for part in parts])
    return points, sort_components(points, triangles, shell, len(parts))


def relation(*parts):
    points, shells = shells_of(*parts)
    ask = np.ones(len(parts), bool)
    found = classify_pairs(points, shells, ask, TOUCH)
    return (
        {tuple(pair) for pair in found.contained_in},
        {tuple(sorted(pair)) for pair in found.intersecting},
        found.undecided_pairs,
    )


def test_shells_are_measured_one_by_one_in_any_triangle_order():
    parts = [moved(sphere(2), 0.5 * np.eye(3), (k, 2 * k, 0)) for k in range(5)]
    parts.append(inverted(box((9, 9, 9), (11, 12, 13))))
    points, triangles = joined(*parts)
    shell = np.repeat(np.arange(6), [len(part[1]) for part in parts])
    order = np.random.default_rng(0).permutation(len(shell))
    shells = sort_components(points, triangles[order], shell[order], 6)
    assert close(shells.volume[5], -24.0, rel=1e-14) and close(shells.area[5], 52.0, rel=1e-14)
    np.testing.assert_allclose(shells.volume[:5], shells.volume[0], rtol=1e-13)
    for k, part in enumerate(parts):
        np.testing.assert_array_equal(shells.low[k], part[0].min(axis=0))
        np.testing.assert_array_equal(shells.high[k], part[0].max(axis=0))
        assert set(map(tuple, shells.triangles[shells.start[k] : shells.start[k + 1]])) == set(
            map(tuple, triangles[shell == k])
        )


@pytest.mark.parametrize("spin", [None, 1, 2])
def test_winding_numbers_match_the_bodies(spin):
    matrix = np.eye(3) if spin is None else rotation(spin)
    parts = [moved(part, matrix) for part in (OUTER, inverted(INNER), torus())]
    points, shells = shells_of(*parts)
    tree = Bvh(points, shells, np.ones(3, bool))
    rng = np.random.default_rng(4)
    where = rng.uniform(-2.5, 2.5, size=(3000, 3))
    # Points in the planes and on the axes of the boxes, where rays meet edges and corners.
    where[:1000] = np.round(where[:1000] * 2) / 2 + 0.25 * rng.integers(0, 2, size=(1000, 3))
    places = where @ matrix.T - tree.origin
    for shell, (half, sign) in enumerate([(2.0, 1), (1.0, -1)]):
        inside, sure = tree.winding_numbers(places, np.full(3000, shell), TOUCH)
        reach = np.abs(where).max(axis=1)
        clear = sure & (np.abs(reach - half) > 1e-3)
        assert clear.sum() > 2000
        np.testing.assert_array_equal(inside[clear], sign * (reach < half)[clear])
    inside, sure = tree.winding_numbers(places, np.full(3000, 2), TOUCH)
    across = np.hypot(np.hypot(where[:, 0], where[:, 1]) - 1.0, where[:, 2])
    np.testing.assert_array_equal(inside[across < 0.3], 1)
    np.testing.assert_array_equal(inside[across > 0.36], 0)


@pytest.mark.parametrize("spin", [None, 3, 4, 5])
@pytest.mark.parametrize(
    "name, parts, inside, crossing",
    [
        ("apart", [box(), box((2, 0, 0), (3, 1, 1))], set(), set()),
        ("one in another", [OUTER, INNER], {(1, 0)}, set()),
        ("one in another, listed first", [INNER, OUTER], {(0, 1)}, set()),
        ("a cavity", [OUTER, inverted(INNER)], {(1, 0)}, set()),
        (
            "a cavity that touches the wall",
            [OUTER, inverted(box((-2, -1, -1), (1, 1, 1)))],
            {(1, 0)},
            set(),
        ),
        (
            "a thin cavity along the wall",
            [OUTER, inverted(box((-2, -1, -1), (-1.999, 1, 1)))],
            {(1, 0)},
            set(),
        ),
        (
            "overlapping by half, faces in common planes",
            [box(), box((0.5, 0, 0), (1.5, 1, 1))],
            set(),
            {(0, 1)},
        ),
        (
            "overlapping in a corner",
            [box(), box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5))],
            set(),
            {(0, 1)},
        ),
        (
            "crossing bars, no vertex in the other",
            [box((-3, -1, -1), (3, 1, 1)), box((-1, -3, -0.9), (1, 3, 0.9))],
            set(),
            {(0, 1)},
        ),
        (
            "crossing bars of one height",
            [box((-3, -1, -1), (3, 1, 1)), box((-1, -3, -1), (1, 3, 1))],
            set(),
            {(0, 1)},
        ),
        ("the same twice", [box(), box()], set(), {(0, 1)}),
        ("the same twice, one inverted", [box(), inverted(box())], set(), {(0, 1)}),
        ("touching in a face", [box(), box((1, 0, 0), (2, 1, 1))], set(), set()),
        ("touching in a part of a face", [box(), box((1, 0.5, 0.3), (2, 1.5, 1.3))], set(), set()),
        ("touching in an edge", [box(), box((1, 1, 0), (2, 2, 1))], set(), set()),
        ("touching in a corner", [box(), box((1, 1, 1), (2, 2, 2))], set(), set()),
        (
            "boxes overlap, bodies do not",
            [torus(), moved(sphere(2), 0.3 * np.eye(3))],
            set(),
            set(),
        ),
        (
            "linked rings",
            [torus(), moved(torus(), [[1, 0, 0], [0, 0, -1], [0, 1, 0]], (1, 0, 0))],
            set(),
            set(),
        ),
        (
            "a ring through a ring",
            [torus(), moved(torus(), np.eye(3), (0.9, 0.05, 0.02))],
            set(),
            {(0, 1)},
        ),
        (
            "three deep",
            [box((-k, -k, -k), (k, k, k)) for k in (3, 1, 2)],
            {(1, 0), (1, 2), (2, 0)},
            set(),
        ),
    ],
)
def test_known_pairs_are_related_as_built(name, parts, inside, crossing, spin):
    if spin is not None:
        parts = [moved(part, rotation(spin) * 0.7, (5, -3, 2)) for part in parts]
        # Stored as in Blender, touching faces now miss or enter by an ulp.
        parts = [
            (points.astype(np.float32).astype(float), triangles) for points, triangles in parts
        ]
    assert relation(*parts) == (inside, crossing, 0)


@holds(20)
@given(seed=seeds)
def test_random_spheres_are_related_by_centers_and_radii(seed):
    rng = np.random.default_rng(seed)
    centre, radius = rng.uniform(-2, 2, size=(12, 3)), rng.uniform(0.2, 2.0, size=12)
    parts = [moved(sphere(3), rotation(k) * r, c) for k, (c, r) in enumerate(zip(centre, radius))]
    inside, crossing, _ = relation(*parts)
    for i in range(12):
        for j in range(12):
            apart = np.linalg.norm(centre[i] - centre[j])
            margin = 0.02 * (radius[i] + radius[j])  # the facets lie inside their spheres
            if i != j and apart + radius[i] < radius[j] - margin:
                assert (i, j) in inside
            elif (
                i < j
                and abs(radius[i] - radius[j]) + margin < apart < radius[i] + radius[j] - margin
            ):
                assert (i, j) in crossing
            elif i < j and apart > radius[i] + radius[j]:
                assert (i, j) not in inside | crossing and (j, i) not in inside


def test_thousands_of_cavities_are_found_in_one_body():
    holes = [inverted(moved(sphere(1), 0.3 * np.eye(3), place)) for place in np.ndindex(13, 13, 13)]
    inside, crossing, unchecked = relation(*holes, box((-1, -1, -1), (13, 13, 13)))
    assert len(inside) == 13**3 and not crossing and not unchecked


@pytest.mark.parametrize(
    "signs, turned, nested, cavities",
    [
        ("+", "-", "-", "-"),
        ("-", "x", "-", "-"),
        ("++", "--", "-x", "--"),
        ("+-", "--", "--", "-x"),
        ("-+", "xx", "--", "-x"),
        ("--", "x-", "--", "-x"),
        ("+-+", "---", "---", "-x-"),
        ("--+", "x--", "---", "-x-"),
        ("-+-", "xxx", "---", "-x-"),
        ("+--", "--x", "---", "-x-"),
        ("+++", "---", "-xx", "---"),
        ("+-+-", "----", "----", "-x-x"),
        ("-+-+", "xxxx", "----", "-x-x"),
        ("-+++", "xx--", "---x", "-x--"),
    ],
)
def test_nested_shells_are_turned_outside_any_material(signs, turned, nested, cavities):
    count = len(signs)
    parts = [
        (inverted if sign == "-" else (lambda part: part))(
            moved(sphere(1), (count - k) * np.eye(3))
        )
        for k, sign in enumerate(signs)
    ]
    order = np.random.default_rng(count).permutation(count)
    points, shells = shells_of(*[parts[k] for k in order])
    ask = np.ones(count, bool)
    found = orient_nested_components(shells, classify_pairs(points, shells, ask, TOUCH), ask)
    for flags, expected in zip(found, (turned, nested, cavities)):
        assert "".join("x" if flag else "-" for flag in flags[np.argsort(order)]) == expected


@pytest.mark.parametrize("turn", range(6))
def test_caps_in_one_plane_do_not_pierce_each_other(turn):
    """A pipe without end faces: the caps of its outer and inner walls lie in the same planes, to
    float32.
    """
    count = np.array([1000, 12])
    outer, inner = (np.arange(n) for n in count)
    loops = []
    for k, r, sense in (
        (outer, 0.7 + 0.3 * np.sin(3.7 * outer**2), 1.0),
        (inner, np.where(inner % 2, 0.075, 0.15), -1.0),
    ):
        angle = 2.0 * np.pi * k / len(k)
        loops.append(np.stack([r * np.cos(angle), sense * r * np.sin(angle)], axis=1))
    walls, area = [], 0.0
    for loop in loops:
        n, i = len(loop), np.arange(len(loop))
        area += (
            np.cross(np.c_[loop, i * 0], np.c_[np.roll(loop, -1, axis=0), i * 0])[:, 2].sum() / 2.0
        )
        j = np.roll(i, -1)
        walls.append(
            (
                np.concatenate([np.c_[loop, i * 0.0], np.c_[loop, i * 0.0 + 1.0]]),
                np.concatenate(
                    [np.stack([i, j, n + j], axis=1), np.stack([i, n + j, n + i], axis=1)]
                ),
            )
        )
    points, triangles = moved(joined(*walls), rotation(turn), (0.3, 0.3, 0.3))
    body = measure_solid(Surface(points.astype(np.float32), triangles))
    assert (body.method, body.health.cavities, body.health.overlapping_components) == (
        "capped",
        1,
        0,
    )
    assert close(body.volume.total, area, rel=1e-6)


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e4])
def test_a_copy_is_one_though_its_volume_is_rounded_otherwise(scale):
    """Its triangles are added up in another order; which orders round otherwise depends on the
    processor.
    """
    points, triangles = moved(sphere(2), scale * rotation(2))
    orders = [(points, np.random.default_rng(seed).permutation(triangles)) for seed in range(64)]
    _, shells = shells_of(*orders)
    copies = [orders[first] for first in np.unique(shells.volume, return_index=True)[1]]
    assert len(copies) > 1
    assert relation(*copies) == (set(), {(i, j) for j in range(len(copies)) for i in range(j)}, 0)


def test_a_part_without_extent_beside_others_is_no_trouble():
    """Its box has no size for ordering its contents."""
    points, triangles = joined(OUTER, INNER, (np.zeros((3, 3)), np.array([[0, 1, 2]])))
    shells = sort_components(points, triangles, np.repeat([0, 1, 2], [12, 12, 1]), 3)
    assert len(Bvh(points, shells, np.ones(3, bool)).ids.T) == 25


@holds(20)
@given(seed=seeds)
def test_the_order_of_components_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    parts = []
    for _ in range(6):
        low, size = rng.integers(0, 8, 3), rng.integers(1, 7, 3)
        parts.append((inverted if rng.integers(2) else (lambda part: part))(box(low, low + size)))
    results = []
    for order in (range(6), rng.permutation(6), rng.permutation(6)):
        points, triangles = joined(*(parts[k] for k in order))
        body = measure_solid(Surface(points, triangles))
        found = {
            item.code: (item.values, sorted(order[k] for k in np.unique(item.elements // 12)))
            for item in body.findings
        }
        results.append((body.health.as_record(), found, body.volume.total))
    for record, found, total in results[1:]:
        assert (
            record == results[0][0]
            and found == results[0][1]
            and close(total, results[0][2], rel=1e-12)
        )


def test_rod_in_a_drilled_hole_breaks_through_nothing():
    """Both are cavities as given; a rod in a hole is none."""
    block, hole = box(high=(4, 4, 4)), inverted(box((1, 1, -1), (3, 3, 5)))
    rod = inverted(box((1.5, 1.5, -0.5), (2.5, 2.5, 4.5)))
    points, triangles = joined(block, hole, rod)
    body = measure_solid(Surface(points, triangles))
    found = {item.code: np.unique(item.elements // 12).tolist() for item in body.findings}
    assert found == {
        "inverted_components": [2],
        "cavities_break_through": [1],
        "components_overlap": [0, 2],
    }


@holds(30)
@given(seed=seeds)
def test_cavities_take_material_away_as_brackets_close(seed):
    """Components one in another, from the outermost inward: each cavity is one of the innermost
    that has none yet.
    """
    rng = np.random.default_rng(seed)
    count, open_ones = 12, []
    cavity, host = np.zeros(count, bool), np.arange(count)
    order = rng.permutation(count)
    for component in order.tolist():
        cavity[component] = bool(open_ones) and rng.random() < 0.6
        if cavity[component]:
            host[component] = open_ones.pop()
        else:
            open_ones.append(component)
    pairs = rng.permutation([(order[i], order[j]) for i in range(count) for j in range(i)])
    some = int(rng.integers(len(pairs)))
    found = ComponentRelations(pairs[:some], np.empty((0, 2), np.intp), 0, pairs[some:])
    assert cavity_host(found, cavity).tolist() == host.tolist()


def test_cavity_breaking_through_does_not_hide_another_overlap():
    """Pairs are told apart by both of their numbers."""
    parts = [
        OUTER,
        inverted(box((-1, -1, -1), (3, 1, 1))),
        box((-10, -10, -10), (-1.5, 10, 10)),
        box((9, 0, 0), (10, 1, 1)),
    ]
    points, shells = shells_of(*parts)
    found = ComponentComparison.from_relations(
        shells, classify_pairs(points, shells, np.ones(4, bool), TOUCH), np.ones(4, bool)
    )
    assert found.breaking.tolist() == [False, True, False, False]
    assert found.intersecting.tolist() == [True, False, True, False]


WALL = box((0, 0, 0), (1, 1, 1))


def hollow(depth, turned=False):
    """A unit box and a cavity of 0.8 x 0.8 x 0.9 that reaches out of its lower side by so much."""
    part = joined(WALL, inverted(box((0.1, 0.1, -depth), (0.9, 0.9, 0.9 - depth))))
    return inverted(part) if turned else part


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("depth", [1e-5, 1e-3, 0.05])
def test_cavity_breaking_through_counts_as_given(depth, scale, turned):
    points, triangles = moved(
        hollow(depth, turned), scale * rotation(3), (2 * scale, -scale, scale)
    )
    rng = np.random.default_rng(int(-np.log10(depth)))
    triangles = triangles[np.concatenate([rng.permutation(12), 12 + rng.permutation(12)])]
    result = measure_solid(surface((points, triangles)))
    assert close(result.volume.total, 0.424 * scale**3, rel=1e-12)
    assert result.method == ("reoriented" if turned else "exact")
    found = {finding.code: finding for finding in result.findings}
    assert set(found) == {"cavities_break_through", *(["inverted_components"] if turned else [])}
    breaks = found["cavities_break_through"]
    assert breaks.elements.tolist() == list(range(12, 24))
    size = np.linalg.norm(points.max(axis=0) - points.min(axis=0))
    assert close(breaks.values["share"] * size, depth * scale, rel=1e-6)
    assert result.health.cavities == 1 and not result.health.overlapping_components


def test_a_cavity_within_its_wall_is_subtracted_with_a_note():
    result = measure_solid(surface(joined(WALL, inverted(box((0.1, 0.1, 0.1), (0.9, 0.9, 0.9))))))
    assert close(result.volume.total, 1.0 - 0.512, rel=1e-14)
    assert only(result).code == "cavities_subtracted" and only(result).values == {"count": 1}
    assert only(result).elements.tolist() == list(range(12, 24))


def test_depth_of_a_cavity_includes_walls_reaching_into_it():
    """No vertex of the cavity is outside: the bottom of a groove reaches into it."""
    groove = np.array([[0, 0], [4, 0], [4, 4], [2.5, 4], [2, 1.5], [1.5, 4], [0, 4]], float)
    ring = np.arange(7)
    faces = [
        [*ring[::-1]],
        [*(ring + 7)],
        *([i, (i + 1) % 7, 7 + (i + 1) % 7, 7 + i] for i in ring),
    ]
    points = np.concatenate([np.insert(groove, 2, z, axis=1) for z in (0.0, 4.0)])
    fans = [(face[0], face[k], face[k + 1]) for face in faces[2:] for k in (1, 2)]
    ends = [(4, 5, 6), (4, 6, 0), (4, 0, 1), (4, 1, 2), (4, 2, 3)]
    fans += [end[::-1] for end in ends] + [tuple(i + 7 for i in end) for end in ends]
    body = (points, np.array(fans))
    result = measure_solid(surface(joined(body, inverted(box((1, 1, 1), (3, 1.7, 3))))))
    assert result.method == "exact" and only(result).code == "cavities_break_through"
    assert close(only(result).values["share"] * np.sqrt(48.0), 0.2, rel=1e-9)


@pytest.mark.parametrize("share, turned", [(0.3, True), (0.9, False)])
def test_inward_part_less_than_half_inside_another_is_inverted(share, turned):
    part = inverted(box((1 - share, 0.1, 0.1), (2 - share, 0.9, 0.9)))
    result = measure_solid(surface(joined(WALL, part)))
    assert codes(result) == (
        ["inverted_components", "components_overlap"] if turned else ["cavities_break_through"]
    )


def test_many_cavities_breaking_through_are_measured():
    cavities = [
        inverted(moved(sphere(1), 0.3 * np.eye(3), (x, y, 0.25)))
        for x in range(12)
        for y in range(12)
    ]
    plate = box((-0.5, -0.5, 0), (11.5, 11.5, 2))
    result = measure_solid(surface(joined(plate, *cavities)))
    size = np.linalg.norm([12.0, 12.0, 2.05])
    assert only(result).values["count"] == 144 and close(
        only(result).values["share"] * size, 0.05, rel=1e-9
    )
    solid = measure_solid(surface(sphere(1))).volume.total * 0.027
    assert close(result.volume.total, 288.0 - 144 * solid, rel=1e-12)
