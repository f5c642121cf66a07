# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces that keep a liquid out of boxes: open, walled, hollow, and within each other."""

import numpy as np
import pytest
from body_moments.core import MeasureError, Surface
from body_moments.core.bodies import Part, Reading, body_of_mesh
from body_moments.core.floating import FloatingBody, find_hull, settle
from body_moments.core.measurement import Settings
from body_moments.core.numerics import rotation_matrix

UP = (0.0, 0.0, 1.0)
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
LID = 5


def box(low, high, without=(), inward=False):
    """Return a box as a surface of quads, without some of its sides."""
    points = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    quads = np.delete(QUADS, list(without), axis=0)
    return Surface(points, quads=quads[:, ::-1] if inward else quads)


def body(*surfaces, **settings):
    parts = [Part(surface, np.eye(4)[None]) for surface in surfaces]
    reading = Reading("hull", "MESH", np.eye(4), np.eye(3), np.zeros(3), parts)
    return body_of_mesh(reading, Settings(**{"density": 500.0} | settings))


def displaced(*bodies):
    hull = find_hull(bodies)
    return FloatingBody(hull.points, hull.triangles, 1.0, np.zeros(3), 1000.0, hull.openings)


HULL = (-2.0, -1.0, 0.0), (2.0, 1.0, 1.0)


def test_open_hull_displaces_up_to_its_rim():
    found = displaced(body(box(*HULL, without=[LID])))
    assert found.capacity == pytest.approx(8.0, rel=1e-12)
    assert found.openings[:, 2] == pytest.approx(np.ones(4))


@pytest.mark.parametrize(("side", "grown"), [("inward", 0.0), ("centered", 0.05), ("outward", 0.1)])
def test_walls_displace_by_their_outer_side(side, grown):
    walled = body(box(*HULL), kind="shell", wall=side, thickness=0.1)
    size = np.array([4.0, 2.0, 1.0]) + 2.0 * grown
    assert displaced(walled).capacity == pytest.approx(size.prod(), rel=1e-12)


def test_cavity_and_cargo_displace_nothing():
    inner = (-1.0, -0.5, 0.2), (1.0, 0.5, 0.8)
    hollow = body(box(*HULL), box(*inner, inward=True))
    cargo = body(box((-0.2, -0.2, 0.3), (0.2, 0.2, 0.5)))
    assert displaced(hollow, cargo).capacity == pytest.approx(8.0, rel=1e-12)


def test_mast_through_opening_displaces_nothing():
    mast = body(box((-0.1, -0.1, 0.1), (0.1, 0.1, 4.0)))
    assert displaced(body(box(*HULL, without=[LID])), mast).capacity == pytest.approx(8.0)


def test_separate_hulls_displace_together():
    other = box((-2.0, 3.0, 0.0), (2.0, 4.0, 1.0))
    assert displaced(body(box(*HULL)), body(other)).capacity == pytest.approx(12.0, rel=1e-12)


@pytest.mark.parametrize(
    ("bodies", "words"),
    [
        ((body(box(*HULL)), body(box((1.0, 0.0, 0.5), (3.0, 3.0, 0.7)))), "overlap"),
        ((body(box(*HULL, without=[0, 2, 3, 4, 5]), kind="shell", thickness=0.1),), "close"),
        ((), "no volume"),
    ],
)
def test_bad_hulls_are_refused(bodies, words):
    with pytest.raises(MeasureError, match=words):
        displaced(*bodies)


def test_hole_below_waterline_is_refused():
    hull = find_hull([body(box(*HULL, without=[2]))])
    leaking = FloatingBody(hull.points, hull.triangles, 2000.0, [0, 0, 0.2], 1000.0, hull.openings)
    with pytest.raises(MeasureError, match="runs in"):
        leaking.settle(UP)


def bowl(wall):
    """Return an open box of thick walls as one closed surface."""
    outer, rim = np.array([[-2, -1], [2, -1], [2, 1], [-2, 1]]), np.ones((4, 1))
    inner = outer - wall * np.sign(outer)
    points = np.concatenate(
        [
            np.hstack([outer, 0 * rim]),
            np.hstack([outer, rim]),
            np.hstack([inner, rim]),
            np.hstack([inner, wall * rim]),
        ]
    )
    quads = [[3, 2, 1, 0], [12, 13, 14, 15]]
    for low in (0, 4, 8):
        quads += [
            [low + i, low + (i + 1) % 4, low + 4 + (i + 1) % 4, low + 4 + i] for i in range(4)
        ]
    return Surface(points, quads=np.array(quads))


def test_hollow_of_thick_hull_stays_dry():
    rest = settle([body(bowl(0.1))], 2000.0, np.array([0.0, 0.0, 0.4]), 1000.0, UP)
    assert rest.draught == pytest.approx(0.25, rel=1e-12)
    assert rest.plane.area == pytest.approx(8.0, rel=1e-12)
    assert rest.depth_of_openings == pytest.approx(-0.75, rel=1e-12)
    assert not rest.findings


ENGINE = (-0.5, -0.5, 0.15), (0.5, 0.5, 0.65)
CRATE = (-1.5, -0.7, 0.1), (1.5, 0.7, 3.0)  # stands on the floor, and is larger than the hollow


@pytest.mark.parametrize("joined", [False, True])
@pytest.mark.parametrize("inside", [ENGINE, ((-1.0, 0.2, 0.1), (1.0, 0.5, 1.7)), CRATE])
def test_parts_in_hollow_of_thick_hull_displace_nothing(inside, joined):
    bodies = [body(bowl(0.1), box(*inside))] if joined else [body(bowl(0.1)), body(box(*inside))]
    rest = settle(bodies, 2000.0, np.array([0.0, 0.0, 0.4]), 1000.0, UP)
    assert rest.draught == pytest.approx(0.25, rel=1e-12)
    assert rest.plane.area == pytest.approx(8.0, rel=1e-12)


SPACE = (-0.5, -0.5, 0.1), (0.5, 0.5, 0.6)


def flooded(*spaces, tanks=(), mass=2000.0, up=UP):
    return settle(
        *([body(bowl(0.1))], mass, np.array([0.0, 0.0, 0.3]), 1000.0, up),
        [(body(box(*tank)), 0.5, 800.0) for tank in tanks],
        [body(box(*space)) for space in spaces],
    )


def test_flooded_space_in_hollow_displaces_nothing():
    apart = (1.0, -0.5, 0.1), (1.5, 0.5, 0.6)
    assert flooded(SPACE).draught == pytest.approx((2.0 - 0.1) / (8.0 - 1.0), rel=1e-9)
    for heel in (0.3, 1.0, 1.6, 2.6):  # the lid of a tilted hollow cuts the space
        rest = flooded(SPACE, mass=500.0, up=[0.0, np.sin(heel), np.cos(heel)])
        # Upside down, the walls and the bottom displace 1160 L/m and 8000 L/m.
        depth = 0.5 / 8.0 if heel < 2.0 else 0.5 / 1.16
        assert rest.draught == pytest.approx(depth, rel=1e-9)
    two = flooded(SPACE, apart)
    assert two.plane.area * two.up[2] == pytest.approx(8.0 - 1.0 - 0.5, rel=1e-9)


@pytest.mark.parametrize(
    "spaces",
    [
        [((-0.5, -0.5, 0.5), (0.5, 0.5, 1.5))],  # through the open top
        [((-1.0, 20.0, 0.1), (1.0, 21.0, 0.9))],
        [((-3.0, -2.0, -1.0), (3.0, 2.0, 2.0))],
        [SPACE, ((0.0, 0.0, 0.2), (1.0, 0.8, 0.4))],
        [SPACE, ((-0.2, -0.2, 0.2), (0.2, 0.2, 0.4))],
    ],
)
@pytest.mark.parametrize("last_is_tank", [False, True])
def test_flooded_space_outside_or_twice_is_refused(spaces, last_is_tank):
    tanks = spaces[1:] if last_is_tank else []
    with pytest.raises(MeasureError, match="flooded space"):
        flooded(*spaces[: len(spaces) - len(tanks)], tanks=tanks)


def test_large_cargo_through_open_top_displaces_nothing():
    cargo = body(box((-1.9, -0.9, 0.1), (1.9, 0.9, 2.0)))
    found = displaced(body(box(*HULL, without=[LID])), cargo)
    assert found.capacity == pytest.approx(8.0, rel=1e-12)


def test_rests_leave_out_those_in_which_liquid_runs_in():
    boat = settle([body(bowl(0.1))], 2000.0, np.array([0.0, 0.0, 0.4]), 1000.0, UP).body
    (rest,) = boat.find_rests()
    assert rest.up == pytest.approx(UP, abs=1e-9)
    assert rest.draught == pytest.approx(0.25, rel=1e-9)


@pytest.mark.parametrize("heel", [0.3, 1.6, 3.1])
@pytest.mark.parametrize(("height", "sheer"), [(0.5, 0.0), (1.0, 0.1)])
def test_rests_do_not_depend_on_attitude_in_file(heel, height, sheer):
    shape = bowl(0.1)
    points = shape.points * [1.0, 1.0, height]
    points[4:12, 2] += sheer * points[4:12, 0]
    turn = rotation_matrix([np.cos(heel / 2.0), np.sin(heel / 2.0), 0.0, 0.0])
    boat = body(Surface(points @ turn.T, quads=shape.quads))
    volume = float(boat.volume.raw[0])
    rest = settle([boat], 900.0 * volume, np.asarray(boat.volume.center), 1000.0, UP)
    rests = sorted(rest.body.find_rests([rest]), key=lambda one: one.draught)
    assert len(rests) == 2
    assert min(np.linalg.norm(rest.up - one.up) for one in rests) < 1e-6
    upright, inverted = rests
    assert (turn.T @ upright.up)[2] > 0.9 and not upright.findings
    assert [found.code for found in inverted.findings] == ["hollow_flooded"]
    if not sheer:
        depth = 0.9 * volume / 8.0
        assert upright.draught == pytest.approx(depth, rel=1e-9)
        walls = 0.9 * height * (8.0 - 3.8 * 1.8)  # open downward, below the floor
        depth = 0.9 * height + (0.9 * volume - walls) / 8.0
        assert inverted.draught == pytest.approx(depth, rel=1e-9)
    for one in rests:
        again = rest.body.settle(one.up)
        assert again.draught == pytest.approx(one.draught, rel=1e-9)
        assert len(again.findings) == len(one.findings)


def test_flooded_hollow_is_reported_or_refused():
    bodies = [body(bowl(0.45))]
    capsized = settle(bodies, 4000.0, np.array([0.0, 0.0, 2.0]), 1000.0, [0.0, 0.1, 1.0])
    assert capsized.up[2] < 0.0
    assert [found.code for found in capsized.findings] == ["hollow_flooded"]
    with pytest.raises(MeasureError, match="runs in"):
        settle(bodies, 7000.0, np.array([0.0, 0.0, 2.0]), 1000.0, [0.0, 0.1, 1.0])
