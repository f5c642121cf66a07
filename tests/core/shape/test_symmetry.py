# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The group of every body by its symbol, first by moments, then as its geometry has it."""

import numpy as np
import pytest
from body_moments.core.flat import directed_edges, region_moments
from body_moments.core.moments.raw import Moments
from body_moments.core.shape import UNDECIDED, PlacedTriangles, Symmetry, disc_zernike, symmetry
from body_moments.core.shape.registration import (
    MIRROR,
    flat_symmetry,
    holds_by_moments,
    holds_by_outline,
    turns_about_normal,
)

from tests.core import bodies, shapes
from tests.core.bodies import ball
from tests.core.point_groups import POINT_GROUPS, group_of, orbit_of
from tests.core.recursion import moments


def placed(part, near):
    """A surface about its center and in units of its largest radius of gyration."""
    spread = moments(part, 2).about_center()
    size = (np.linalg.eigvalsh(spread.second())[-1] / spread.total) ** 0.5
    return PlacedTriangles((part[0] - spread.about) / size, part[1], near, 4.0 * near)


def decided(part, near=1e-5):
    """Names of the groups that a surface may have, the least first."""
    return [Symmetry(each, np.empty((0, 3)), 0).group for each in placed(part, near).groups()]


@pytest.mark.parametrize("name", [*shapes.SYMMETRIC, *shapes.ROUND])
def test_moments_tell_the_group_and_corners_its_folds(name):
    part, group, *exact = (shapes.SYMMETRIC | shapes.ROUND)[name]
    image = bodies.moved(part, bodies.rotation(5), (1, 2, 3))
    assert symmetry(moments(shapes.refined(image, 1), 6)).group == group
    for near in (1e-5, 1e-9):
        assert decided(image, near) == (exact or [group])


def test_ball_by_moments_has_all_axes_and_one_operation():
    axial = pytest.fail  # about which axis should it be asked
    for turn in (np.eye(3), bodies.rotation(3)):
        found = symmetry(Moments(ball(6, 0.7), np.zeros(3)).in_frame(turn, np.ones(3)), axial=axial)
        assert (found.group, found.order) == ("K", 6) and np.array_equal(
            found.operations, np.eye(3)[None]
        )
        assert np.abs(found.revolution_axes @ found.revolution_axes.T - np.eye(3)).max() < 1e-14


@pytest.mark.parametrize("tolerance", [1e-4, 1e-10])
def test_round_looking_polygon_has_mirror_lines_of_its_corners(tolerance):
    angle = 0.3 + 2.0 * np.pi / 23 * np.arange(23)
    corners = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    zernike = disc_zernike(region_moments(corners, directed_edges([range(23)]), 8), 1.0)

    def distance(places):
        return np.linalg.norm(places[:, None, :2] - corners, axis=2).min(axis=1)

    holds = holds_by_outline(np.pad(corners, ((0, 0), (0, 1))), distance, tolerance)
    assert flat_symmetry(zernike, 8, corners, np.eye(3), holds).group == "C23v"


@pytest.mark.parametrize("name", POINT_GROUPS)
@pytest.mark.parametrize("seed", [None, 3])
def test_point_groups_have_their_schoenflies_symbols(name, seed):
    order, generators = POINT_GROUPS[name]
    turn = np.eye(3) if seed is None else bodies.rotation(seed)
    operations = turn @ group_of(generators) @ turn.T
    assert len(operations) == order
    found = Symmetry(operations, np.empty((0, 3)), 6)
    assert found.group == name
    assert found.has_center == any(np.abs(one + np.eye(3)).max() < 1e-9 for one in operations)


@pytest.mark.parametrize("name", POINT_GROUPS)
def test_surface_of_turned_orbits_has_their_group(name):
    part = orbit_of(name)
    for seed in range(2):
        assert decided(bodies.moved(part, bodies.rotation(seed), (1, 2, 3))) == [name]
    if len(part[1]) <= 4 * 60:  # moments to sixth order cannot tell axes of higher order
        group = symmetry(moments(part, 6)).group
        assert (
            group == name
            or name in UNDECIDED.get(group, "").split(", ")
            or group.startswith(("C∞", "D∞"))
        )


@pytest.mark.parametrize("name", ["S4", "D3d", "Td"])
def test_coarse_coordinates_leave_the_group_listed(name):
    for seed in range(4):
        points, faces = bodies.moved(orbit_of(name), bodies.rotation(seed), (3000, 900, -1800))
        assert name in decided((points.astype(np.float32).astype(float), faces), 1e-3)


@pytest.mark.parametrize("name", ["C1", "C3v", "D2d", "D6h", "Oh"])
def test_group_does_not_depend_on_the_triangulation(name):
    """Triangles are cut at inner points, in another way in each image, and share no corners."""
    assert decided(bodies.soup(shapes.refined(orbit_of(name), 1))) == [name]


@pytest.mark.parametrize("axis", [[0, 0, 0], [0, 0, 1], [1, 1, 1]])
def test_ball_of_facets_is_round_within_a_tolerance(axis):
    """Other bodies are egg-shaped along an axis: r = 1 + c³ / 10 with the cosine c."""
    points, faces = bodies.sphere(4)
    points = points * (1.0 + 0.1 * (points @ np.array(axis, float)) ** 3)[:, None]
    ball = Symmetry(np.eye(3)[None], np.eye(3), 6)
    body = placed((points, faces), 0.02)
    assert body.is_round(ball, 0.02) == (not any(axis)) and not body.is_round(ball, 1e-4)


def test_geometry_rules_out_symmetry_of_moments_alone():
    """A box with small dents that spoil all symmetry by less than the noise of moments, and more
    than the tolerance.
    """
    part = shapes.refined(bodies.box((0, 0, 0), (3, 2, 1)))
    points = part[0].copy()
    points[8:] += np.random.default_rng(0).normal(size=(12, 3)) * 1e-6
    assert symmetry(moments((points, part[1]), 6)).group == "D2h" and decided(
        (points, part[1]), 1e-9
    ) == ["C1"]


@pytest.mark.parametrize(
    "off, groups", [(1e-7, ["Oh"]), (5e-6, ["C3v", "D3d", "Oh"]), (1e-3, ["C3v"])]
)
def test_misfits_near_the_tolerance_leave_both_groups(off, groups):
    points, faces = bodies.box()
    points = points.copy()
    points[0] -= off * np.sign(points[0] - points.mean(axis=0))
    assert decided((points, faces)) == groups


@pytest.mark.parametrize("name", shapes.ASYMMETRIC)
def test_a_body_without_symmetry_has_none(name):
    found = symmetry(moments(shapes.ASYMMETRIC[name], 6))
    assert found.group == "C1" and not found.axes and not found.planes


def test_axes_and_planes_lie_in_the_body_as_built():
    turn = bodies.rotation(8)
    found = symmetry(moments(bodies.moved(shapes.prism(6), turn, (1, 2, 3)), 6))
    axis, order = found.axes[0]
    assert order == 6 and abs(axis @ turn[:, 2]) == pytest.approx(1.0)
    assert len(found.axes) == 7 and len(found.planes) == 7 and found.has_center
    assert sum(abs(normal @ turn[:, 2]) > 0.999 for normal in found.planes) == 1
    for normal in found.planes:
        assert np.linalg.norm(normal) == pytest.approx(1.0)


def test_the_operations_are_a_group():
    for part, _ in shapes.SYMMETRIC.values():
        operations = symmetry(moments(part, 6)).operations
        products = np.einsum("aij,bjk->abik", operations, operations).reshape(-1, 1, 3, 3)
        if len(products) < 3000:
            assert np.abs(products - operations[None]).max(axis=(2, 3)).min(axis=1).max() < 1e-9


def test_a_coarse_body_can_be_looked_at_loosely():
    """Coordinates of six digits: too few for the moments' own noise, enough for a part."""
    points, triangles = bodies.moved(shapes.ICOSAHEDRON, bodies.rotation(2))
    rough = np.round(points, 4), triangles
    assert symmetry(moments(rough, 6), noise=1e-3).group == "Ih"


@pytest.mark.parametrize("mirrored", [False, True])
def test_flat_moments_hold_for_turns_and_mirrors(mirrored):
    """A blade, or an arrow head along x, three times around."""
    blade = np.array([[0.2, 0.0], [1.0, -0.1], [1.5, 0.0] if mirrored else [1.5, 0.6], [1.0, 0.1]])
    turns = turns_about_normal(2.0 * np.pi / 3.0 * np.arange(3))
    points = np.concatenate([blade @ turn[:2, :2].T for turn in turns])
    moments = region_moments(points, directed_edges(np.arange(12).reshape(3, 4)), 12, (0.0, 0.0))
    holds = holds_by_moments(disc_zernike(moments, 2.0), 12, 1e-9)
    for k, turn in enumerate(turns_about_normal(np.pi / 6.0 * np.arange(12))):
        assert holds(turn) == (k % 4 == 0)
        assert holds(turn @ MIRROR) == (mirrored and k % 4 == 0)
