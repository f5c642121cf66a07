# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A measured body has moments of its own to any order; faces that do not close have none by
accident.
"""

import numpy as np
import pytest
from body_moments.core import MassProperties, polyhedron_moments
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid import measure_solid
from body_moments.core.verdict import NEGLIGIBLE, Severity, severity

from tests.close import close
from tests.core.bodies import (
    CORNERS,
    SIDES,
    TOP,
    box,
    inverted,
    joined,
    mesh,
    moved,
    surface,
    torus,
    with_flipped,
    without,
)
from tests.core.findings import refused

HIGH = box((0, 0, 0), (1, 2, 3))


def box_moment(p, q, r):
    return 1.0 / (p + 1) * 2.0 ** (q + 1) / (q + 1) * 3.0 ** (r + 1) / (r + 1)


@pytest.mark.parametrize(
    "part", [HIGH, inverted(HIGH), with_flipped(HIGH, 1, 7), without(HIGH, *TOP)]
)
@pytest.mark.parametrize("order", [0, 2, 3, 4, 12])
def test_repaired_body_has_moments_to_any_order(part, order):
    body = measure_solid(surface(moved(part, offset=(5, 6, 7))))
    volume, area = body.moments(order, about=(5, 6, 7))
    assert area is None and volume.order == order and volume.about.tolist() == [5, 6, 7]
    for exponents in ((0, 0, 0), (order, 0, 0), (order // 2, 0, order // 2)):
        assert close(volume[exponents], box_moment(*exponents), rel=1e-10)
    mass = MassProperties.from_moments(body.volume, density=2.0)
    assert close(mass.mass, 12.0, rel=1e-14) and close(2.0 * volume.total, mass.mass, rel=1e-12)
    assert body.moments(order)[0].about.tolist() == body.volume.about.tolist()


def test_area_counts_only_the_given_faces():
    for part, area in (
        (HIGH, 22.0),
        (without(HIGH, *TOP), 20.0),
        (joined(HIGH, moved(HIGH, offset=(9, 0, 0))), 44.0),
    ):
        body = measure_solid(surface(part))
        found = body.moments(2, area_order=4)[1]
        assert (
            close(found.total, area, rel=1e-13)
            and close(body.area.total, area, rel=1e-13)
            and found.order == 4
        )
        assert found.about.tolist() == body.volume.about.tolist()


def test_a_flat_body_has_no_moments():
    body = measure_solid(surface(joined(box((0, 0, 0), (1, 1, 0)))))
    volume, area = body.moments(6, area_order=0)
    assert not volume.raw.any() and close(area.total, 2.0, rel=1e-14)


@pytest.mark.parametrize("order", [3, 6])
def test_nearly_flat_body_has_no_moments_within_bounds(order):
    """Its volume is 10^-15, less than the rounding error of a closed sheet of its size."""
    body = measure_solid(surface(box((0, 0, 0), (1, 1, 1e-14))))
    volume = body.moments(order)[0]
    for found in (body.volume, volume):
        assert not found.raw.any() and 1e-15 <= found.rounding_error[0] < 1e-12


@pytest.mark.parametrize(
    "part",
    [with_flipped(HIGH, 1), without(HIGH, 4), without(HIGH, *TOP, 0, 1), without(torus(), 3)],
)
@pytest.mark.parametrize("order", [0, 3, 8])
def test_open_faces_are_refused_unless_intended(part, order):
    """The README's example measured a repaired copy and took the moments of the input: 0.333 beside
    a mass of 1.
    """
    with refused("boundary_open"):
        polyhedron_moments(surface(part), order)
    with refused("boundary_open"):
        polyhedron_moments([part[0][part[1][:5]], part[0][part[1][5:]]], order)
    with refused("boundary_open"):
        polyhedron_moments(iter([surface(part)]), order, about=(0, 0, 0), reach=4.0)
    assert polyhedron_moments(surface(part), order, allow_open=True)[0].order == order
    assert measure_solid(surface(part)).moments(order)[0].total > 0.0


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
