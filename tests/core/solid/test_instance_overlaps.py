# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Overlaps of instanced solids, mirrored and stretched: boxes with known answers."""

import numpy as np
import pytest
from body_moments.core.bodies.instances import compare_places
from body_moments.core.solid.measure import measure_solid

from tests.core.bodies import box, inverted, joined, rotation, surface, welded, without

MIRROR = np.diag([-1.0, 1.0, 1.0])
STRETCH = np.diag([2.0, 0.5, 1.0])


def places(*maps):
    """(k, 4, 4) of (3, 3) maps about the origin, or of (map, offset)."""
    result = np.tile(np.eye(4), (len(maps), 1, 1))
    for row, one in zip(result, maps):
        row[:3, :3], row[:3, 3] = one if isinstance(one, tuple) else (one, 0.0)
    return result


def cube(half, center=(0.0, 0.0, 0.0)):
    return box(np.array(center) - half, np.array(center) + half)


def solid(part):
    return measure_solid(surface(part))


def compared(*solids):
    return compare_places([(solid(part), maps) for part, maps in solids])


@pytest.mark.parametrize("outer", [np.eye(3), MIRROR, STRETCH, MIRROR @ STRETCH])
@pytest.mark.parametrize("inner", [np.eye(3), MIRROR, MIRROR @ STRETCH / 4.0])
def test_part_in_the_material_of_another_is_nested_if_mirrored(outer, inner):
    found = compared(
        (cube(1.0), places(outer)), (cube(0.25), places(inner, (inner, (9.0, 0.0, 0.0))))
    )
    assert (
        found.nested.tolist() == [[1, 0]]
        and not len(found.overlapping)
        and not found.undecided_pairs
    )


@pytest.mark.parametrize("way", [np.eye(3), MIRROR])
def test_part_in_a_cavity_is_in_no_material(way):
    hollow = joined(cube(1.0), inverted(cube(0.5)))
    assert not len(compared((hollow, places(way)), (cube(0.25), places(np.eye(3)))).nested)
    in_wall = compared((hollow, places(way)), (cube(0.125), places((np.eye(3), (0.75, 0.0, 0.0)))))
    assert in_wall.nested.tolist() == [[1, 0]]
    # a body around both: the outer shell of the hollow one is in it, a cavity is none of what
    # counts twice
    around = compared((cube(3.0), places(way)), (hollow, places(way)))
    assert around.nested.tolist() == [[1, 0]] and not len(around.overlapping)


@pytest.mark.parametrize("way", [np.eye(3), MIRROR])
@pytest.mark.parametrize("shift, overlap", [(0.99, True), (1.01, False)])
def test_instances_sharing_a_part_overlap_once_each(way, shift, overlap):
    found = compared(
        (joined(cube(0.25, (0.0, 5.0, 0.0)), cube(0.5)), places(way, (way, (30.0, 0.0, 0.0)))),
        (cube(0.5), places((way, (shift, 0.25, 0.0)), (way, (30.0 - shift, -0.25, 0.0)))),
    )
    assert found.overlapping.tolist() == (
        [[0, 1]] * 2 + [[1, 0]] * 2 if overlap else []
    ) and not len(found.nested)
    # and one that meets itself in another place
    twice = compared((cube(0.5), places(way, (way, (shift, 0.25, 0.1)))))
    assert twice.overlapping.tolist() == ([[0, 0]] * 2 if overlap else [])


def test_own_parts_and_open_parts_are_not_compared():
    crossed = joined(cube(0.5), cube(0.5, (0.5, 0.25, 0.0)))
    found = compared((crossed, places(np.eye(3), (np.eye(3), (9.0, 0.0, 0.0)))))
    assert not len(found.overlapping) and not len(found.nested)
    lid = without(cube(0.25), *range(2, 12))
    found = compared((cube(0.5), places(np.eye(3))), (lid, places(np.eye(3), MIRROR)))
    assert not len(found.overlapping) and not len(found.nested)
    # but for one layer of their wall
    points, triangles = welded(joined(cube(0.125), cube(0.125, (0.25, 0.0, 0.0))))
    triangles = triangles[np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1]]
    for shift in (0.0, 0.5):
        found = compared(
            (cube(0.5), places(np.eye(3))),
            ((points, triangles), places((np.eye(3), (shift, 0.0, 0.0)))),
        )
        assert not len(found.overlapping) and not len(found.nested)


def test_plates_without_a_thickness_go_through_nothing():
    """Boxes of tilted plates are as thick as others."""
    plates = [
        rotation(seed) @ np.diag([1.0, 1.0, height]) for seed in (1, 2) for height in (1e-18, 1e-3)
    ]
    for first in plates[:2]:
        for second in plates[2:]:
            found = compared(
                (cube(0.5), places(first)), (cube(0.5), places((second, (0.1, 0.05, 0.0))))
            )
            is_thick = abs(np.linalg.det(first)) > 1e-9 and abs(np.linalg.det(second)) > 1e-9
            assert bool(len(found.overlapping)) == is_thick


@pytest.mark.parametrize("size", [1e-12, 1.0, 1e12])
def test_bodies_of_any_size_overlap_unless_flattened(size):
    for height, overlap in ((1.0, True), (1e-18, False)):
        way = size * np.diag([1.0, 1.0, height])
        found = compared((cube(0.5), places(way, (way, way @ [0.5, 0.25, 0.25]))))
        assert bool(len(found.overlapping)) is overlap and not len(found.nested)


@pytest.mark.parametrize("here", range(3))
@pytest.mark.parametrize("count", [1, 2])
def test_overlap_is_found_for_any_instance_of_a_part(here, count):
    """Places are numbered over all solids: two of different solids are never taken for one."""
    far = [(np.eye(3), (9.0 * k, 0.0, 0.0)) for k in (1, 2, 3)]
    inner = places(*(np.eye(3) if k == here else one for k, one in enumerate(far)))
    outer = places(np.eye(3), *((np.eye(3), (0.0, 9.0 * k, 0.0)) for k in range(1, count)))
    found = compared((cube(1.0), outer), (cube(0.25), inner))
    assert found.nested.tolist() == [[1, 0]] and not len(found.overlapping)
    found = compared((cube(1.0), outer), (cube(0.5, (1.0, 0.25, 0.125)), inner))
    assert found.overlapping.tolist() == [[0, 0], [1, 0]] and not len(found.nested)
