# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cavities are reported, and measured as given if they break through their walls."""

import numpy as np
import pytest
from body_moments.core.solid.measure import measure_solid

from tests.close import close
from tests.core.bodies import box, inverted, joined, moved, rotation, sphere, surface
from tests.core.findings import codes, only

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
