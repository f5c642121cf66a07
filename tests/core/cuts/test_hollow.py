# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Liquids in vessels against closed forms."""

import numpy as np
import pytest
from body_moments.core.cuts import find_hollow, fit_rim, spill_tilt
from body_moments.core.verdict import MeasureError

from tests.core.bodies import box, inverted, joined, lathed

SIDES = 48
CIRCLE = SIDES / 2 * np.sin(2 * np.pi / SIDES)  # area of the unit polygon


def cone_volume(low, high, height):
    return CIRCLE * height * (low * low + low * high + high * high) / 3


CUP = lathed((0, 0), (1.2, 0), (1.2, 3), (1, 3), (1, 0.5), (0, 0.5))
FLASK = lathed((0, 0), (2.2, 0), (0.7, 3), (0.5, 3), (2, 0.3), (0, 0.3))
SHEET = lathed((0, 0), (1, 0), (1.5, 2))
TANK = joined(box((0, 0, 0), (4, 4, 4)), inverted(box((1, 1, 1), (3, 2, 3))))
BICONE = inverted(lathed((0, 0), (1, 1), (0, 2)))
VESSELS = [
    (CUP, 0.5, 3, CIRCLE * 2.5),
    (FLASK, 0.3, 3, cone_volume(2, 0.5, 2.7)),
    (SHEET, 0, 2, cone_volume(1, 1.5, 2)),
    (inverted(SHEET), 0, 2, cone_volume(1, 1.5, 2)),
    (TANK, 1, 3, 4),
]


@pytest.mark.parametrize(("vessel", "bottom", "spill", "capacity"), VESSELS)
def test_vessel_has_its_hollow_wherever_it_stands(vessel, bottom, spill, capacity):
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    for axes, place in ((np.eye(3), np.zeros(3)), (turn, 1e3 * rng.standard_normal(3))):
        up = axes @ [0, 0, 1]
        hollow = find_hollow(vessel[0] @ axes.T + place, vessel[1], up)
        accuracy = 1e-12 * (1 + np.abs(place).max())
        assert abs(hollow.bottom - bottom - up @ place) < accuracy
        assert abs(hollow.spill - spill - up @ place) < accuracy
        assert abs(hollow.capacity - capacity) < 10 * accuracy


@pytest.mark.parametrize("share", [1e-6, 0.1, 0.5, 0.999, 1.0])
@pytest.mark.parametrize(("vessel", "bottom", "spill", "capacity"), VESSELS)
def test_level_of_a_volume_has_that_volume(vessel, bottom, spill, capacity, share):
    hollow = find_hollow(*vessel)
    level = hollow.level_of(share * capacity)
    assert bottom < level <= spill
    assert abs(hollow.below([level]).volume[0] - share * capacity) < 1e-12 * capacity


def test_free_surface_of_a_cup_is_its_polygon():
    liquid = find_hollow(*CUP).contents(2.0)
    central = liquid.face.about_point(liquid.face.center)
    second = CIRCLE / 12 * (2 + np.cos(2 * np.pi / SIDES))
    np.testing.assert_allclose(central.second()[0], np.diag([second, second, 0]), atol=1e-14)


def test_free_surface_ends_where_a_cavity_is_full():
    for vessel, top in ((TANK, 3.0), (joined(box((-9, -9, -9), (9, 9, 9)), BICONE), 2.0)):
        hollow = find_hollow(*vessel)
        for level in (top, top + 1.0):
            assert hollow.free_surface(hollow.contents(level), level) is None
        assert hollow.free_surface(hollow.contents(1.5), 1.5).total > 0.5
    assert abs(hollow.free_surface(hollow.contents(1.5), 1.5).total - CIRCLE / 4) < 1e-12


def test_triangle_with_a_corner_twice_changes_nothing():
    points, triangles = CUP
    inner = 4 * SIDES
    points = np.concatenate([points, points[[inner]]])
    whole = find_hollow(*CUP)
    extra = [[inner, inner + 1, inner + 1], [inner, inner - SIDES, len(points) - 1]]
    found = find_hollow(points, np.concatenate([triangles, extra]))
    assert found.capacity == whole.capacity
    np.testing.assert_array_equal(found.triangles, whole.triangles)


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("vessel", [SHEET, inverted(SHEET)])
def test_face_of_a_sheet_that_is_there_twice_counts_once(vessel, way):
    points, triangles = vessel
    doubled = np.concatenate([triangles[-5:, ::way], triangles])
    assert abs(find_hollow(points, doubled).capacity - find_hollow(*vessel).capacity) < 1e-12


def test_boxes_that_share_a_face_are_no_vessel():
    points, triangles = joined(box(), box((0, 0, 1), (1, 1, 2)))
    with pytest.raises(MeasureError, match="neither a cavity nor a hollow"):
        find_hollow(points, triangles)


def test_level_without_volume_is_below_the_bottom():
    with pytest.raises(MeasureError, match="below the bottom"):
        find_hollow(*lathed((0, 0), (1, 1))).contents(1e-300)


def test_level_beside_a_pillar_and_under_a_hook():
    # A pillar on the bottom, and a ring that hangs from the wall into the liquid.
    vessel = lathed(
        *((0, 0), (3, 0), (3, 4), (2.5, 4), (2.5, 3), (2, 3), (2, 1.5)),
        *((2.25, 1.5), (2.25, 2.5), (2.5, 2.5), (2.5, 1), (1, 1), (1, 2), (0, 2)),
    )
    hollow = find_hollow(*vessel)
    assert hollow.spill == 4
    volumes = hollow.below([1.5, 1.75]).volume / CIRCLE
    np.testing.assert_allclose(np.diff(volumes), 0.25 * (2.5**2 - 1 - (2.25**2 - 2**2)))


def test_open_vessel_spills_at_its_lowest_hole():
    points, triangles = SHEET
    heights = points[triangles][:, :, 2]
    hole = np.flatnonzero((heights == 0).sum(axis=1) == 2)[-1:]
    points = points + [0, 0, 1]
    points[triangles[hole, 2], 2] = 2
    with pytest.raises(MeasureError, match="No level"):
        find_hollow(points, np.delete(triangles, hole, axis=0))


@pytest.mark.parametrize("up", [(0, 0, 0), (0, 0, 1e-320), (0, 0, 1e300)])
def test_direction_without_length_is_refused(up):
    if any(up):
        assert abs(find_hollow(*CUP, up).capacity - CIRCLE * 2.5) < 1e-9
        return
    for call in (find_hollow, fit_rim, lambda *body: spill_tilt(*body[:2], 1.0, up)):
        with pytest.raises(ValueError, match="up must not be zero"):
            call(*SHEET, up)


@pytest.mark.parametrize("solid", [box(), (CUP[0] * [1, 1, -1], CUP[1][:, ::-1])])
def test_body_without_a_hollow_is_refused(solid):
    with pytest.raises(MeasureError, match="neither a cavity nor a hollow"):
        find_hollow(*solid)


def test_more_than_the_capacity_and_nothing_are_refused():
    hollow = find_hollow(*CUP)
    for call in (lambda: hollow.level_of(8.0), lambda: hollow.contents(3.1)):
        with pytest.raises(MeasureError, match=r"at most 7\.83"):
            call()
    for call in (lambda: hollow.level_of(0.0), lambda: hollow.contents(0.5)):
        with pytest.raises(MeasureError, match="below the bottom"):
            call()


@pytest.mark.parametrize("level", [1.5, 2.0, 2.5])
def test_tilted_cup_spills_where_its_surface_meets_the_rim(level):
    # Above half its height the surface of a cylinder turns about the middle.
    angle, direction = spill_tilt(*CUP, CIRCLE * (level - 0.5))
    assert level < 1.75 or abs(np.tan(angle) - (3 - level)) < 1e-6
    assert abs(direction @ [0, 0, 1]) < 1e-12
    assert spill_tilt(*TANK, 1.0)[0] == np.pi
