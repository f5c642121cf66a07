# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Walls of real thickness against closed forms and rational arithmetic."""

from fractions import Fraction
from math import pi, sqrt

import numpy as np
import pytest
from body_moments.core.inertia.mass_properties import MassProperties
from body_moments.core.moments.raw import monomials
from body_moments.core.polyhedron import polyhedron_moments
from body_moments.core.verdict import MeasureError
from body_moments.core.wall.directions import offset_directions
from body_moments.core.wall.walls import offset_solid, split_thickness
from hypothesis import given

from tests.core import bodies, exact
from tests.core.findings import refused
from tests.core.strategies import holds, seeds

SIDES = ("inward", "outward", "centered")
SQUARE = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)])
SHEAR = np.array([[1.0, 0.4, -0.2], [0.1, 0.7, 0.3], [0.0, -0.25, 1.5]])


def cube(side=1.0):
    return bodies.moved(bodies.box(), side * np.eye(3), (-side / 2,) * 3)


def wall(part, side, thickness, **more):
    return offset_solid(bodies.surface(part, **more)).moments(*split_thickness(side, thickness))


def exact_difference(part, vectors, low, high, about):
    """Return the 20 moments between a closed surface moved by `low` and by `high`, as Fractions."""

    def moved(s):
        points = [
            [Fraction(float(x)) + Fraction(float(s)) * Fraction(float(d)) for x, d in zip(*row)]
            for row in zip(part[0], vectors)
        ]
        return exact.volume_moments(points, part[1], about)

    return [one - other for one, other in zip(moved(high), moved(low))]


@pytest.mark.parametrize(
    ("side", "t", "low", "high"),
    [
        *(("inward", t, 1.0 - 2.0 * t, 1.0) for t in (1e-6, 0.01, 0.1, 0.25, 0.4, 0.49)),
        ("outward", 0.25, 1.0, 1.5),
        ("centered", 0.25, 0.75, 1.25),
    ],
)
def test_mitred_shell_of_a_cube_is_a_difference_of_cubes(side, t, low, high):
    body = wall(cube(), side, t)
    assert abs(body.total - (high**3 - low**3)) <= 1e-14
    assert np.abs(bodies.inertia(body) - (high**5 - low**5) / 6).max() <= 1e-14
    assert np.abs(body.center).max() <= 1e-14


@pytest.mark.parametrize(("side", "high"), [("inward", 1.0), ("outward", 1.5), ("centered", 1.25)])
def test_box_of_a_shell_ends_at_its_outside(side, high):
    offset = offset_solid(bodies.surface(cube()))
    assert [corner.tolist() for corner in offset.box(*split_thickness(side, 0.25))] == [
        [-high / 2] * 3,
        [high / 2] * 3,
    ]


def test_every_cut_of_the_cubes_faces_gives_the_same_directions():
    part = cube()
    for turn in range(3):
        again = (part[0], np.roll(part[1], turn, axis=1))
        vectors = offset_directions(*again).vectors
        assert np.abs(vectors - np.sign(part[0])).max() < 1e-14


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(
    "part",
    [
        bodies.sphere(2),
        bodies.torus(9, 7),
        bodies.moved(bodies.sphere(1), SHEAR, (3.0, -2.0, 5.0)),
        bodies.moved(cube(), SHEAR),
        bodies.moved(bodies.torus(6, 5), 1e-3 * SHEAR, (1e-2, 0.0, 0.0)),
        bodies.joined(cube(2.0), bodies.inverted(cube())),
    ],
    ids=["ball", "torus", "sheared", "box", "tiny", "hollow"],
)
def test_every_moment_is_a_difference_of_two_closed_bodies(part, side):
    found = offset_solid(bodies.surface(part))
    size = min(found.max_thickness(side), np.ptp(part[0], axis=0).min())
    low, high = split_thickness(side, 0.6 * size if side == "inward" else 0.2 * size)
    body = found.moments(low, high)
    truth = np.array(
        exact_difference(part, offset_directions(*part).vectors, -low, high, body.about), float
    )
    reach = np.abs(part[0] - body.about).max(axis=0) + size
    scale = body.total * np.multiply.reduce(reach ** monomials(3), axis=1)
    assert (np.abs(body.raw - truth) <= body.rounding_error).all()
    assert (np.abs(body.raw - truth) <= 1e-14 * scale).all()
    assert (body.rounding_error[:10] <= 1e-9 * scale[:10]).all()


def test_distant_wall_loses_only_coordinate_digits():
    near, far = cube(), bodies.moved(cube(), offset=(1024.0, -2048.0, 4096.0))
    one, other = (wall(part, "inward", 0.125) for part in (near, far))
    assert np.abs(one.raw - other.raw).max() <= 1e-14
    assert np.array_equal(other.about, (1024.0, -2048.0, 4096.0))


def test_directions_move_every_plane_of_a_tilted_box_by_one():
    part = bodies.moved(bodies.box((0, 0, 0), (3, 1, 2)), bodies.rotation(4) @ SHEAR)
    found = offset_directions(*part)
    corners = part[0][part[1]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    heights = np.einsum("mi,mki->mk", normals, found.vectors[part[1]])
    assert np.abs(heights - 1.0).max() < 1e-14
    assert found.tangential_error[0].max() < 1e-13


def test_wall_at_more_than_three_planes_is_reported_as_uneven():
    part = (
        np.array([[2, 1, 0], [-2, 1, 0], [-2, -1, 0], [2, -1, 0], [0.5, 0.25, 1.0]], float),
        np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]]),
    )
    found = offset_solid(bodies.surface(part))
    assert found.inexact_vertices == 1 and found.min_ratio < 1.0 < found.max_ratio
    even = (part[0] * [1, 1, 1] - [0, 0, 0], part[1])
    even[0][4, :2] = 0.0
    assert offset_solid(bodies.surface(even)).inexact_vertices == 1
    square = (even[0] * [0.5, 1, 1], part[1])
    assert offset_solid(bodies.surface(square)).inexact_vertices == 0


def test_the_planes_of_a_fine_sphere_are_kept_at_the_thickness():
    found = offset_solid(bodies.surface(bodies.sphere(4)))
    assert found.min_ratio > 0.995 and found.max_ratio < 1.005
    thick = found.moments(0.1, 0.0)
    assert abs(thick.total / (4 / 3 * pi * (1 - 0.9**3)) - 1.0) < 5e-3


@pytest.mark.parametrize("level", [2, 3, 4])
def test_sphere_shell_converges_quadratically_with_its_faces(level):
    truth = 4 / 3 * pi * (1 - 0.8**3)
    errors = [abs(wall(bodies.sphere(k), "inward", 0.2).total - truth) for k in (level, level + 1)]
    assert 3.4 < errors[0] / errors[1] < 4.6


def test_a_flat_sheet_is_a_plate_and_says_nothing_of_an_inside():
    body = wall(bodies.moved(bodies.grid(3), np.diag([2.0, 3.0, 1.0])), "centered", 0.5)
    properties = MassProperties.from_moments(body)
    assert abs(body.total - 3.0) < 1e-14
    assert np.abs(properties.center - (1.0, 1.5, 0.0)).max() < 1e-14
    assert (
        np.abs(
            np.diag(properties.inertia) - [3 * (9 + 0.25) / 12, 3 * (4 + 0.25) / 12, 3 * 13 / 12]
        ).max()
        < 1e-14
    )


def test_a_bent_sheet_is_mitred_at_its_crease():
    points = np.array([[0, 0, 0], [2, 0, 0], [2, 0, 1], [0, 0, 1], [0, 3, 0], [0, 3, 1]], float)
    part = points, bodies.split([[0, 1, 2, 3], [4, 0, 3, 5]])
    t = 0.25
    assert abs(wall(part, "outward", t).total - t * (5 + t)) < 1e-14
    assert abs(wall(part, "inward", t).total - t * (5 - t)) < 1e-14


@pytest.mark.parametrize(
    ("sizes", "limit"), [((1, 1, 1), 0.5), ((4, 1, 2), 0.5), ((1, 1, 0.2), 0.1)]
)
def test_a_box_folds_over_at_half_its_least_side(sizes, limit):
    found = offset_solid(bodies.surface(bodies.box(high=sizes)))
    assert limit * (1 - 1e-6) < found.inward <= limit
    assert found.outward == np.inf and found.inward_at >= 0 and found.outward_at == -1
    assert found.max_thickness("centered") == 2 * found.inward
    found.moments(0.999 * limit, 0.0)
    for thickness in (limit, 1.1 * limit, 3 * limit):
        with pytest.raises(ValueError, match="folds over"):
            found.moments(thickness, 0.0)


@holds(6)
@given(seed=seeds)
def test_prisms_have_no_negative_jacobian_up_to_the_limit(seed):
    rng = np.random.default_rng(seed)
    part = bodies.sphere(1)
    part = part[0] * rng.uniform(0.8, 1.2, len(part[0]))[:, None], part[1]
    found = offset_solid(bodies.surface(part))
    points, vectors = part[0][part[1]], offset_directions(*part).vectors[part[1]]
    for limit, sign in ((found.inward, -1.0), (found.outward, 1.0)):
        limit = min(limit, 100.0)

        def least(s, sign=sign):
            moved = points + sign * s * vectors
            normal = np.cross(moved[:, 1] - moved[:, 0], moved[:, 2] - moved[:, 0])
            return np.einsum("mi,mki->mk", normal, vectors).min()

        assert min(least(s) for s in np.linspace(0, limit * (1 - 1e-9), 500)) > 0.0
        if limit < 100.0:
            assert least(limit * (1 + 1e-6)) < 0.0


def test_loose_triangles_are_joined_at_common_edges():
    assert abs(wall(bodies.soup(cube()), "inward", 0.1).total - (1 - 0.8**3)) <= 1e-14


def test_a_vertex_in_the_middle_of_an_edge_changes_nothing():
    points, triangles = cube()
    points = np.concatenate([points, [(points[0] + points[1]) / 2, (points[0] + points[2]) / 2]])
    for new, (a, b) in ((8, (0, 1)), (9, (0, 2))):
        rows = [row for row in triangles if {a, b} <= set(row)]
        for row in rows:
            c = next(int(v) for v in row if v not in (a, b))
            start = list(row)
            forward = start[(start.index(a) + 1) % 3] == b
            halves = [[a, new, c], [new, b, c]] if forward else [[b, new, c], [new, a, c]]
            triangles = np.concatenate([triangles[~(triangles == row).all(axis=1)], halves])
    assert abs(wall((points, triangles), "inward", 0.1).total - (1 - 0.8**3)) <= 1e-14


def test_a_face_without_area_is_carried_along():
    points, triangles = cube()
    points = np.concatenate([points, [(points[0] + points[1]) / 2]])
    row = next(row for row in triangles if {0, 1} <= set(row))
    c = next(int(v) for v in row if v not in (0, 1))
    a, b = (0, 1) if list(row)[(list(row).index(0) + 1) % 3] == 1 else (1, 0)
    triangles = np.concatenate(
        [triangles[~(triangles == row).all(axis=1)], [[a, 8, c], [8, b, c], [a, b, 8]]]
    )
    found = offset_solid(bodies.surface((points, triangles)))
    assert found.degenerate_triangles == 1
    assert abs(found.moments(0.1, 0.0).total - (1 - 0.8**3)) <= 1e-14


def test_noise_on_a_flat_side_does_not_send_its_edge_sliding():
    rng = np.random.default_rng(0)
    part = bodies.welded(
        bodies.joined(
            bodies.grid(8),
            bodies.moved(bodies.grid(8), np.array([[0, 0, -1], [0, 1, 0], [-1, 0, 0.0]])),
        )
    )
    part = part[0] + 1e-5 * rng.normal(size=part[0].shape), part[1]
    found = offset_directions(*part)
    assert np.abs(found.vectors).max() < 1.01


@pytest.mark.parametrize(
    ("part", "code"),
    [
        (bodies.with_flipped(cube(), 0), "wall_without_sides"),
        (bodies.moebius(), "wall_without_sides"),
        (
            bodies.welded(bodies.joined(bodies.box(), bodies.box((0, 1, 1), (1, 2, 2)))),
            "wall_without_sides",
        ),
        ((bodies.CORNERS, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])), "wall_without_sides"),
        ((np.zeros((3, 3)), np.array([[0, 1, 2]])), "no_face_area"),
    ],
)
def test_surface_without_sides_is_refused_with_the_remedy(part, code):
    with refused(code):
        offset_solid(bodies.surface(part))


@pytest.mark.parametrize(
    "part, code, edges",
    [
        (
            bodies.welded(bodies.joined(bodies.box(), bodies.box((0, 1, 1), (1, 2, 2)))),
            "wall_without_sides",
            [[[0, 1, 1], [1, 1, 1]]],
        ),
        (
            (SQUARE, np.array([[0, 1, 2], [0, 3, 2]])),
            "wall_without_sides",
            [[[0, 0, 0], [1, 1, 0]]],
        ),
    ],
)
def test_unusable_edges_are_named_by_given_vertices(part, code, edges):
    points, triangles = part
    given = np.concatenate([np.full((3, 3), 9.0), points])
    with pytest.raises(MeasureError) as caught:
        offset_solid(bodies.surface((given, triangles + 3)))
    finding = caught.value.finding
    assert (finding.code, finding.values["count"]) == (code, len(edges))
    assert given[finding.elements].tolist() == edges


def test_the_inside_wall_up_to_the_limit_fills_a_regular_body():
    part = bodies.sphere(0)
    found = offset_solid(bodies.surface(part))
    assert abs(found.inward - 1 / sqrt(3)) < 1e-7
    full = polyhedron_moments(bodies.surface(part))[0].total
    assert abs(found.moments(found.inward * (1 - 1e-12), 0.0).total - full) < 1e-9


def cone(sides=32):
    angle = np.arange(sides) * 2 * np.pi / sides
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(sides)])
    points = np.concatenate([ring, [[0.0, 0.0, 2.0]]])
    lid = [[0, i + 1, i] for i in range(1, sides - 1)]
    return points, np.array(lid + [[i, (i + 1) % sides, sides] for i in range(sides)])


def test_wall_of_a_pyramid_is_a_difference_of_similar_pyramids():
    sides, t = 32, 0.02
    body = wall(cone(sides), "inward", t)
    apothem = np.cos(np.pi / sides)
    whole = sides / 2 * np.sin(2 * np.pi / sides) * 2 / 3
    left = (2 - t - t * np.hypot(apothem, 2) / apothem) / 2
    assert abs(body.total - whole * (1 - left**3)) < 1e-13


@pytest.mark.parametrize(
    "part",
    [
        cone(),
        bodies.torus(24, 12),
        bodies.sphere(3),
        bodies.moved(cube(), bodies.rotation(1) @ SHEAR, (50.0, 20.0, -30.0)),
    ],
)
@pytest.mark.parametrize("side", ["inward", "centered"])
@pytest.mark.parametrize("t", [1e-4, 0.05])
def test_any_float32_rounding_stays_within_the_bound(part, side, t):
    rng = np.random.default_rng(5)
    single = part[0].astype(np.float32)
    given = offset_solid(bodies.surface((single, part[1]), np.float32)).moments(
        *split_thickness(side, t)
    )
    half = np.spacing(np.abs(single).max(axis=0)).astype(float) / 2
    for _ in range(5):
        moved = single.astype(float) + half * rng.choice([-1.0, 1.0], single.shape)
        found = wall((moved, part[1]), side, t).about_point(given.about)
        assert (np.abs(found.raw - given.raw) <= given.input_error + 2 * given.rounding_error)[
            :10
        ].all()
    assert given.input_error[0] < 0.01 * given.total


def fine_box(n, size=(1.0, 1.0, 1.0)):
    """A box with sides cut in n x n quads."""
    faces = [
        (np.eye(3), (0, 0, 1)),
        (np.diag([1, -1, -1]), (0, 1, 0)),
        (np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]), (1, 0, 0)),
        (np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]]), (0, 0, 0)),
        (np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]), (0, 1, 0)),
        (np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]), (0, 0, 0)),
    ]
    part = bodies.welded(
        bodies.joined(*(bodies.moved(bodies.grid(n), turn, offset) for turn, offset in faces))
    )
    return part[0] * size, part[1]


@pytest.mark.parametrize("n", [2, 4, 16])
@pytest.mark.parametrize("t", [0.05, 0.2, 0.45])
def test_a_finely_cut_cube_has_the_wall_of_a_cube(n, t):
    found = offset_solid(bodies.surface(fine_box(n)))
    assert found.inexact_vertices == 0 and 0.4999 < found.inward <= 0.5
    body = found.moments(t, 0.0)
    assert abs(body.total - (1 - (1 - 2 * t) ** 3)) <= 1e-14
    assert np.abs(bodies.inertia(body) - (1 - (1 - 2 * t) ** 5) / 6).max() <= 1e-14


def test_turned_fine_float32_box_has_the_wall_of_a_box():
    points, triangles = bodies.moved(
        fine_box(16, (1.0, 2.0, 3.0)), bodies.rotation(3), (5.0, 7.0, -3.0)
    )
    found = offset_solid(bodies.surface((points.astype(np.float32), triangles), np.float32))
    assert found.inward > 0.49
    body = found.moments(0.3, 0.0)
    assert abs(body.total - (6 - 0.4 * 1.4 * 2.4)) < 1e-5
    assert abs(body.total - (6 - 0.4 * 1.4 * 2.4)) < body.input_error[0]


def test_a_finely_cut_sheet_keeps_its_rim():
    body = wall(bodies.grid(8), "outward", 0.7)
    assert abs(body.total - 0.7) < 1e-14
    other = bodies.moved(bodies.grid(8), offset=(-1.0, 0.0, 0.0))
    part = bodies.welded(
        bodies.joined(bodies.grid(8), bodies.moved(other, [[0, 0, -1], [0, 1, 0], [1, 0, 0]]))
    )
    assert abs(wall(part, "outward", 0.1).total - (0.2 + 0.01)) < 1e-14
    assert abs(wall(part, "inward", 0.1).total - (0.2 - 0.01)) < 1e-14


JAWS = [
    (0, 0),
    (4, 0),
    (4, 1.9),
    (3, 1.9),
    (3, 1),
    (1, 1),
    (1, 3),
    (3, 3),
    (3, 2.1),
    (4, 2.1),
    (4, 4),
    (0, 4),
]
CAP = [(0, 1, 4, 5), (1, 2, 3, 4), (0, 5, 6, 11), (6, 7, 10, 11), (7, 8, 9, 10)]


def clamp():
    """A C with jaws that face each other over a gap of 0.2, each as wide and high as the other."""
    points = np.array([(x, y, z) for z in (0.0, 1.0) for x, y in JAWS])
    quads = [row[::-1] for row in CAP] + [tuple(i + 12 for i in row) for row in CAP]
    quads += [(i, (i + 1) % 12, (i + 1) % 12 + 12, i + 12) for i in range(12)]
    return points, bodies.split(np.array(quads))


SHEET = SQUARE, bodies.split([(0, 1, 2, 3)])
OUTER, INNER = bodies.box((0, 0, 0), (4, 4, 4)), bodies.box((1, 1, 1), (3, 3, 3))


@pytest.mark.parametrize(
    ("part", "side", "apart", "through"),
    [
        (
            bodies.joined(OUTER, bodies.inverted(INNER)),
            "inward",
            (0.1, 0.49, 0.5),
            (0.501, 0.6, 1.0, 1.5),
        ),
        (bodies.joined(OUTER, bodies.inverted(INNER)), "centered", (0.5, 0.99), (1.01, 1.5)),
        (bodies.joined(OUTER, bodies.inverted(INNER)), "outward", (0.5, 0.9), ()),
        (bodies.joined(OUTER, INNER), "outward", (0.5, 0.99), (1.01, 3.0)),
        (bodies.joined(OUTER, INNER), "inward", (0.5, 0.9), ()),
        (
            bodies.joined(bodies.box(), bodies.moved(bodies.box(), offset=(4, 0, 0))),
            "outward",
            (1.0, 1.5),
            (1.51, 5.0),
        ),
        (clamp(), "outward", (0.05, 0.09), (0.11, 0.15, 0.3)),
        (
            bodies.joined(SHEET, bodies.moved(SHEET, offset=(0, 0, 0.25))),
            "inward",
            (0.1, 0.25),
            (0.26, 0.5),
        ),
        (
            bodies.joined(SHEET, bodies.moved(SHEET, offset=(0.5, 0.5, 0.25))),
            "centered",
            (0.1, 0.25),
            (0.26, 0.5),
        ),
        (bodies.joined(SHEET, bodies.moved(SHEET, offset=(2, 0, 0.25))), "outward", (0.1, 0.5), ()),
    ],
)
def test_meeting_walls_without_piercing_edges_are_found(part, side, apart, through):
    """Skins that have moved past one another, and ones that are flush with each other."""
    swept = offset_solid(bodies.surface(part))
    assert not any(swept.self_intersects(*split_thickness(side, t)) for t in apart)
    assert all(swept.self_intersects(*split_thickness(side, t)) for t in through)


def test_float32_bound_grows_with_the_reach_of_a_wall():
    found = offset_solid(bodies.surface(bodies.sphere(2), dtype=np.float32))
    for ways in ((0.0, 1.0), (0.2, 1.0)):
        errors = [
            found.moments(min(t * ways[0], 0.5), t * ways[1]).input_error
            for t in (0.1, 0.5, 2.0, 8.0)
        ]
        assert all(
            (more > less).all() and (less > 0.0).all() for less, more in zip(errors, errors[1:])
        )


@pytest.mark.parametrize("angle", [1e-3, 1e-2])
def test_faint_float32_crease_is_offset_as_a_crease(angle):
    points, triangles = bodies.grid(6)
    points[:, 2] = angle * np.maximum(points[:, 0] - np.unique(points[:, 0])[2], 0.0)
    found = offset_solid(bodies.surface((points, triangles), dtype=np.float32))
    assert (
        found.inexact_vertices == 0
        and max(1.0 - found.min_ratio, found.max_ratio - 1.0) < 1e-3 * angle**2 + 1e-9
    )


@pytest.mark.parametrize("gap, meet", [(1.5, True), (2.5, False)])
def test_thin_walls_of_facing_skins_meet_at_their_thickness(gap, meet):
    points, triangles = bodies.grid(2)
    thickness = 1e-6
    part = bodies.joined(
        (points, triangles), (points + [0.1, 0.1, gap * thickness], triangles[:, ::-1])
    )
    assert offset_solid(bodies.surface(part)).self_intersects(0.0, thickness) == meet


@pytest.mark.parametrize("inverted", [False, True])
@pytest.mark.parametrize(
    "faces_down, gap, meet",
    [(True, 0.0109, True), (True, 0.0112, False), (False, 0.0099, True), (False, 0.0102, False)],
)
def test_tip_of_a_spike_piercing_another_side_is_found(faces_down, gap, meet, inverted):
    """A sheet with a spike that points at another sheet: while each side moves by 0.001 its tip
    goes ahead by ten times as much, to where the other sheet faces it, or to its back, which stays.
    Hardly a point within the wall is in what pierces.
    """
    x, y = 0.3, 0.1
    lower = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    base = [
        (x - 0.1, y - 0.1, 0),
        (x + 0.1, y - 0.1, 0),
        (x + 0.1, y + 0.1, 0),
        (x - 0.1, y + 0.1, 0),
    ]
    points = np.array(
        [*lower, *base, (x, y, 1 - gap), (1, -1, 1), (1, 1, 1), (-1, 1, 1), (-1, -1, 1)], float
    )
    ring = bodies.split([(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4)])
    spike = [(k + 4, (k + 1) % 4 + 4, 8) for k in range(4)]
    bend = bodies.split([(2, 1, 9, 10)])  # so that what faces the spike is one sheet with it
    upper = bodies.split([(10, 9, 12, 11)])
    sheet = np.concatenate([ring, spike, *([bend, upper] if faces_down else [upper[:, ::-1]])])
    found = offset_solid(bodies.surface((points, sheet[:, ::-1] if inverted else sheet)))
    assert found.self_intersects(*((1e-3, 0.0) if inverted else (0.0, 1e-3))) == meet
