# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings that change mass, size and inertia by less than a ten-thousandth are notes."""

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.measure import measure_solid
from body_moments.core.verdict import NEGLIGIBLE, Severity, severity

from tests.close import close
from tests.core.bodies import CORNERS, SIDES, box, inverted, joined, mesh

# A cube of side s has area 6 s², beside or in a box of volume 8 whose diagonal is 2√3.
LIMIT = np.sqrt(NEGLIGIBLE * 8.0 / (6.0 * np.sqrt(12.0)))


def cube(side, center=(0.0, 0.0, 0.0)):
    middle, half = np.array(center), side / 2.0
    return box(middle - half, middle + half)


def codes(part, scale=1.0, shift=(0.0, 0.0, 0.0)):
    points, triangles = part
    solid = measure_solid(
        Surface.from_triangles(scale * points + np.array(shift) * scale, triangles)
    )
    return {(str(found.code), severity(found)) for found in solid.findings}


@pytest.mark.parametrize(
    ("scale", "shift"), [(1.0, (0, 0, 0)), (1e-6, (0, 0, 0)), (1e6, (0, 0, 0)), (1.0, (30, -20, 7))]
)
@pytest.mark.parametrize(
    ("code", "body"),
    [
        ("components_nested", lambda side: joined(cube(2.0), cube(side))),
        ("components_overlap", lambda side: joined(cube(2.0), cube(side, (1.0, 0.0, 0.0)))),
        (
            "inverted_components",
            lambda side: joined(cube(2.0), inverted(cube(side, (1.0 + side, 0.0, 0.0)))),
        ),
    ],
)
def test_negligible_components_are_a_note(code, body, scale, shift):
    assert (code, Severity.WARNING) in codes(body(1.1 * LIMIT), scale, shift)
    found = codes(body(0.9 * LIMIT), scale, shift)
    assert (code, Severity.NOTE) in found and (code, Severity.WARNING) not in found


def test_negligible_flipped_faces_are_a_note():
    for side, level in ((2.2 * LIMIT, Severity.WARNING), (0.9 * LIMIT, Severity.NOTE)):
        points, triangles = joined(cube(2.0), cube(side, (3.0, 0.0, 0.0)))
        triangles = triangles.copy()
        triangles[-2:] = triangles[-2:, ::-1]
        assert [each for code, each in codes((points, triangles)) if code == "flipped_faces"] == [
            level
        ]


def test_inverted_body_is_never_negligible():
    assert codes(inverted(cube(1e-9))) == {("inverted_components", Severity.WARNING)}


@pytest.mark.parametrize("size", [1.0, 2.0**-20, 2.0**20])
@pytest.mark.parametrize(
    "height, level", [(0.25, Severity.WARNING), (8e-4, Severity.WARNING), (4e-4, Severity.NOTE)]
)
def test_spread_of_diagonals_is_a_share_of_the_volume(size, height, level):
    """A cube with one raised corner: the diagonals of its side differ by a pyramid of a sixth of
    that.
    """
    points = np.array(CORNERS, float)
    raised = (points == [1.0, 1.0, 1.0]).all(axis=1)
    assert raised.sum() == 1
    points[raised, 2] += height
    solid = measure_solid(mesh(size * points, SIDES.tolist()))
    (found,) = solid.findings
    assert found.code == "non_planar_faces" and severity(found) == level
    assert close(found.values["share"], height / 6.0 * size**3 / solid.volume.total, rel=1e-9)


@pytest.mark.parametrize("count, level", [(4, Severity.WARNING), (24, Severity.NOTE)])
def test_spread_over_many_faces_of_a_smooth_body_is_a_note(count, level):
    """A torus of twisted quads; a few that are bent as much, or many that are bent more, are a
    warning.
    """
    u, v = np.meshgrid(*2 * [np.arange(count) * 2.0 * np.pi / count], indexing="ij")
    radius = 2.0 + np.cos(u + v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(u + v)], axis=-1).reshape(
        -1, 3
    )
    i, j = np.indices((count, count)).reshape(2, -1)
    along, around = (i + 1) % count, (j + 1) % count
    faces = np.stack(
        [i * count + j, along * count + j, along * count + around, i * count + around], axis=1
    )
    (found,) = measure_solid(mesh(points, faces.tolist())).findings
    assert found.code == "non_planar_faces" and severity(found) == level
    assert (found.values["share"] < 0.03) == (level == Severity.NOTE) and found.values[
        "share"
    ] > 1e-3
