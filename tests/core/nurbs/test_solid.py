# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies bounded by patches: closedness, orientation, caps and findings."""

from math import prod

import numpy as np
import pytest
from body_moments.core.moments.raw import monomials
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import (
    Curve,
    Patch,
    measure_patches,
    planar_region,
    sharpest_crease,
    volume_moments,
)
from body_moments.core.nurbs.patch_topology import find_topology
from body_moments.core.verdict import Finding
from hypothesis import given

from tests.close import close
from tests.core.exact_splines import sphere, torus, tube
from tests.core.findings import codes, only, refused
from tests.core.strategies import holds, seeds

BALL = 4.0 * np.pi / 3.0


def flat(corners, orders=(2, 2), inner=((), ())):
    """A bilinear patch over four corners (00, 10, 11, 01), of higher order and with more knots if
    asked: its control points are at the Greville abscissae, so that its parameters stay even.
    """
    spaces = tuple(clamped_space(order, knots) for order, knots in zip(orders, inner))
    steps = [
        np.array(
            [
                sum(space.knots[i + 1 : i + space.order]) / (space.order - 1)
                for i in range(space.count)
            ]
        )
        for space in spaces
    ]
    a, b, c, d = (np.asarray(corner, float) for corner in corners)
    s, t = steps[0][:, None, None], steps[1][None, :, None]
    return Patch(spaces, (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d)


def box(size=(1.0, 2.0, 3.0), offset=(5.0, -3.0, 2.0), orders=((2, 2),) * 6, inner=(((), ()),) * 6):
    """Six outward patches."""
    corner = np.array(
        [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    ) * size + np.asarray(offset)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [
        flat([corner[i] for i in face], order, knots)
        for face, order, knots in zip(faces, orders, inner)
    ]


def odd_factorial(n):
    return prod(range(n, 0, -2))


def test_ball_cylinder_and_box_match_closed_forms_to_order_six():
    ball, rod = (
        measure_patches([patch], order=6).volume.about_point(np.zeros(3))
        for patch in (sphere(), tube())
    )
    low = np.array([5.0, -3.0, 2.0])
    block = measure_patches(box(offset=tuple(low)), order=6).volume.about_point(np.zeros(3))
    for powers in monomials(6).tolist():
        p, q, r = powers
        even = p % 2 == q % 2 == 0
        round_ = odd_factorial(p - 1) * odd_factorial(q - 1) * even
        truth = (
            4.0
            * np.pi
            * round_
            * odd_factorial(r - 1)
            * (r % 2 == 0)
            / (odd_factorial(p + q + r + 1) * (p + q + r + 3))
        )
        assert abs(ball[p, q, r] - truth) <= 1e-14
        disk = (
            2.0
            * np.pi
            * round_
            / (2 ** ((p + q) // 2) * prod(range(1, (p + q) // 2 + 1)) * (p + q + 2))
        )
        assert abs(rod[p, q, r] - disk * (r % 2 == 0) * 2.0 / (r + 1)) <= 1e-13
        truth = prod(
            (high ** (n + 1) - a ** (n + 1)) / (n + 1)
            for n, a, high in zip(powers, low, low + [1, 2, 3])
        )
        assert block[p, q, r] == pytest.approx(truth, rel=1e-12)


def test_inverted_patch_is_turned_and_reported():
    found = measure_patches([sphere().reverse_orientation()])
    assert found.method == "reoriented" and found.health.inverted_components == 1
    assert only(found) == Finding("inverted_patch_components", {"count": 1, "total": 1})
    assert abs(found.volume.total / BALL - 1.0) <= 1e-14


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_open_cylinder_has_no_vector_area_and_is_still_open(size):
    found = measure_patches([tube().transform(np.diag([size, size, size, 1.0]))])
    assert found.method == "capped" and not found.health.closed and found.health.boundary_edges == 2
    truth = np.pi * size**3 * np.array([2.0, 2.0 / 3.0 * size**2, 0.5 * size**2])
    volume = found.volume
    assert close([volume.total, volume[0, 0, 2], volume[2, 0, 0]], truth, rel=1e-14)
    assert abs(found.health.cap_area_share - 0.5) <= 1e-6
    assert found.area.total == pytest.approx(4.0 * np.pi * size**2, rel=1e-12)


@pytest.mark.parametrize("far", [0.0, 1e4])
def test_volume_of_a_capped_patch_is_independent_of_position(far):
    rng = np.random.default_rng(4)
    space = clamped_space(4, (0.3, 0.6))
    bowl = np.stack(np.meshgrid(np.arange(6.0), np.arange(6.0), indexing="ij"), axis=-1)
    points = np.concatenate([bowl, rng.uniform(0.0, 2.0, (6, 6, 1))], axis=2)
    here, there = (measure_patches([Patch((space, space), points + shift)]) for shift in (0.0, far))
    assert here.method == there.method == "capped"
    assert codes(here)[-1] == "patch_holes_capped" and here.findings[-1].values["curved"] == 1
    assert abs(there.volume.total / here.volume.total - 1.0) <= 1e-9


def test_the_cap_of_a_flat_rim_is_exact_whatever_the_rims_shape():
    """An L-shaped prism's walls: the centroid is not even in the flat region's kernel."""
    outline = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4), (0, 0)]
    space = SplineSpace((0.0, *map(float, range(7)), 6.0), 2, 7)
    points = np.array([[(x, y, z) for z in (2.0, 5.0)] for x, y in outline])
    found = measure_patches([Patch((space, clamped_space(2)), points)])
    finding = only(found)
    assert (
        found.method == "capped"
        and finding.code == "patch_holes_capped"
        and finding.values["flat"] == 2
    )
    assert abs(found.volume.total - 7.0 * 3.0) <= 1e-13
    center = (2.0 * 4.0 + 0.5 * 3.0) / 7.0
    assert np.abs(found.volume.center - [center, (0.5 * 4.0 + 2.5 * 3.0) / 7.0, 3.5]).max() <= 1e-14
    assert abs(found.health.cap_area_share - 14.0 / (16.0 * 3.0)) <= 1e-12


@pytest.mark.parametrize("shift", [0.0, 0.1])
@pytest.mark.parametrize("crossing", [True, False])
def test_self_crossing_rims_are_reported(crossing, shift):
    """A prism over a lying eight that crosses itself in a corner or beside it, and over two
    touching lobes.
    """
    t = np.linspace(0.0, 2.0 * np.pi, 33) + shift
    x = np.sin(t) * (1.0 + 0.5 * (np.sin(t) > 0.0))
    y = np.sin(t) * np.cos(t) if crossing else np.abs(np.sin(t)) * np.cos(t)
    space = SplineSpace((0.0, *map(float, range(33)), 32.0), 2, 33)
    points = np.stack([np.stack([x, y, np.full(33, z)], axis=1) for z in (0.0, 1.0)], axis=1)
    found = measure_patches([Patch((space, clamped_space(2)), points)])
    assert (Finding("patch_boundary_crosses_itself", {"count": 2}) in found.findings) == crossing
    assert found.method == "capped"
    bent = points + np.stack([0.0 * x, 0.0 * x, 0.3 * np.sin(2.0 * t) * np.cos(t)], axis=1)[:, None]
    assert "patch_boundary_crosses_itself" not in codes(
        measure_patches([Patch((space, clamped_space(2)), bent)])
    )


def test_rim_crossing_itself_without_area_is_closed():
    """A tube from a circle to a lying eight with two lobes that cancel each other."""
    t = np.linspace(0.0, 2.0 * np.pi, 33)
    space = SplineSpace((0.0, *map(float, range(33)), 32.0), 2, 33)
    rims = [
        np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1),
        np.stack([np.sin(t), np.sin(2.0 * t), 1.0 + 0.0 * t], 1),
    ]
    found = measure_patches([Patch((space, clamped_space(2)), np.stack(rims, axis=1))])
    assert only(found).code == "patch_holes_capped" and only(found).values["flat"] == 1


@pytest.mark.parametrize("turn", [1, -1])
def test_holes_of_other_parts_are_found_beside_incomplete_loops(turn):
    """Holes of a Möbius band; both begin at one corner and end at the other."""
    found = find_topology(
        [band_of_one_side(), tube().transform(np.diag([0.5, 0.5, 0.5, 1.0]))][::turn], 1e-6
    )
    assert found.open_sides == 4 and len(found.loops) == 2
    assert found.unclosable.tolist() == [True, False][::turn]


def test_six_patches_of_different_resolution_make_a_box():
    orders = ((2, 2), (3, 4), (2, 3), (5, 2), (4, 4), (2, 2))
    inner = (
        ((), ()),
        ((0.5,), ()),
        ((0.25, 0.5), ()),
        ((), (0.5,)),
        ((0.1,), (0.9,)),
        ((0.5,), (0.5,)),
    )
    found = measure_patches(box(orders=orders, inner=inner))
    assert (found.method, found.findings, found.health.components) == ("exact", (), 1)
    assert abs(found.volume.total - 6.0) <= 1e-13
    assert np.abs(found.volume.center - [5.5, -2.0, 3.5]).max() <= 1e-13


def test_sides_coincide_whatever_their_parameters_are():
    patches = box()
    space = SplineSpace((0.0, 0.0, 0.1, 1.0, 1.0), 2, 3)  # its parameters run slowly first
    points = patches[0].points
    between = points[:1] * 0.7 + points[1:] * 0.3
    patches[0] = Patch(
        (space, patches[0].spaces[1]), np.concatenate([points[:1], between, points[1:]])
    )
    found = measure_patches(patches)
    assert (found.method, found.findings) == ("exact", ())
    assert abs(found.volume.total - 6.0) <= 1e-13


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, np.pi / 4.0, 3.0])
def test_round_sides_coincide_wherever_they_begin(turn):
    """A tube with conical lids that begin and end elsewhere around it."""
    wall = tube()
    out = np.array([wall.points[:, k, :2] for k in range(2)])
    c, s = np.cos(turn), np.sin(turn)
    lids = []
    for end, top in ((0, -2.0), (1, 2.0)):
        around = np.concatenate(
            [out[end] @ [[c, s], [-s, c]], np.full((8, 1), wall.points[0, end, 2])], axis=1
        )
        lids.append(
            Patch(
                wall.spaces,
                np.stack([around, np.broadcast_to([0.0, 0.0, top], (8, 3))], axis=1),
                wall.weights,
            )
        )
    found = measure_patches([wall, lids[0].reverse_orientation(), lids[1]])
    assert (found.method, found.findings, found.health.components) == ("exact", (), 1)
    assert abs(found.volume.total / (2.0 * np.pi + 2.0 * np.pi / 3.0) - 1.0) <= 1e-13
    assert measure_patches([wall, *lids]).health.inconsistent_edges == 1
    both = [*found.patches, *(shifted(patch, 9.0, 0.0, 0.0) for patch in found.patches)]
    for seed in range(4):
        order = np.random.default_rng(seed).permutation(6)
        again = measure_patches([both[k] for k in order], order=0)
        assert (again.method, again.findings, again.health.components) == ("exact", (), 2)


@pytest.mark.parametrize(
    ("turned", "sides"), [((1, 4), 6), ((0,), 4), ((0, 1), 8)]
)  # 0 and 1 lie opposite
def test_patches_facing_against_the_rest_are_turned_and_counted(turned, sides):
    found = measure_patches(
        [patch.reverse_orientation() if k in turned else patch for k, patch in enumerate(box())]
    )
    assert found.method == "reoriented"
    assert only(found) == Finding("flipped_patches", {"count": len(turned)})
    assert found.health.inconsistent_edges == sides and found.health.inverted_components == 0
    assert abs(found.volume.total - 6.0) <= 1e-13


@pytest.mark.parametrize("turned", range(6))
def test_a_part_faces_as_most_of_its_patches_do(turned):
    """A cavity stays one if any of its patches faces outward."""
    cavity = [patch.reverse_orientation() for patch in box((0.5, 0.25, 0.125), (5.25, -2.5, 2.75))]
    cavity[turned] = cavity[turned].reverse_orientation()
    found = measure_patches([*box(), *cavity])
    assert codes(found) == ["flipped_patches", "cavities_subtracted"]
    assert abs(found.volume.total / (6.0 - 0.5 * 0.25 * 0.125) - 1.0) <= 1e-13


@pytest.mark.parametrize(("side", "slight"), [(1e-3, {"slight": True}), (0.1, {})])
def test_negligible_finding_is_a_note(side, slight):
    """Beside a box of 1 by 2 by 3, a small one that is inside out, or has a patch that faces
    against the others.
    """
    small = box((side, side, side), (7.0, -3.0, 2.0))
    inverted = [patch.reverse_orientation() for patch in small]
    misoriented = [small[0], small[1].reverse_orientation(), *small[2:]]
    for patches, finding in (
        (inverted, Finding("inverted_patch_components", {"count": 1, "total": 2, **slight})),
        (misoriented, Finding("flipped_patches", {"count": 1, **slight})),
    ):
        found = measure_patches([*box(), *patches])
        assert only(found) == finding and found.method == "reoriented"
        assert abs(found.volume.total / (6.0 + side**3) - 1.0) <= 1e-13


def test_a_box_without_a_face_is_capped_exactly():
    found = measure_patches(box()[:5])
    assert found.method == "capped" and found.health.boundary_edges == 4
    assert abs(found.volume.total - 6.0) <= 1e-13


def test_short_sides_along_a_long_one_leave_no_hole():
    """A T-junction between patches: the open sides run there and back."""
    patches = box(size=(1.0, 1.0, 1.0), offset=(3.0, 1.0, 0.0))
    a, b, c, d = (
        patches[0].points[0, 0],
        patches[0].points[1, 0],
        patches[0].points[1, 1],
        patches[0].points[0, 1],
    )
    halves = [flat([a, b, (b + c) / 2, (a + d) / 2]), flat([(a + d) / 2, (b + c) / 2, c, d])]
    found = measure_patches([*halves, *patches[1:]])
    assert (found.method, found.findings) == ("exact", ())
    assert abs(found.volume.total - 1.0) <= 1e-13


def cube(*corner):
    return box((1.0, 1.0, 1.0), corner)


def turned(patches):
    return [patch.reverse_orientation() for patch in patches]


TOUCHING = {
    "face to face": (cube(0, 0, 0) + cube(1, 0, 0), "exact"),
    "at an edge": (cube(0, 0, 0) + cube(1, 1, 0), "exact"),
    "one inside out": (cube(0, 0, 0) + turned(cube(1, 0, 0)), "reoriented"),
    "at an edge, one inside out": (cube(0, 0, 0) + turned(cube(1, 1, 0)), "reoriented"),
    "with one wall": (cube(0, 0, 0) + cube(1, 0, 0)[1:], "capped"),
    "eight": (sum([cube(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], []), "exact"),
}


@holds(6)
@given(seed=seeds)
@pytest.mark.parametrize("name", TOUCHING)
def test_touching_bodies_are_measured_in_any_order_of_patches(name, seed):
    """More than two sides meet there; joined as they came, they made bodies that were flat or
    open.
    """
    patches, method = TOUCHING[name]
    order = np.random.default_rng(seed).permutation(len(patches))
    found = measure_patches([patches[k] for k in order], order=0)
    assert found.method == method and found.health.non_manifold_edges > 0
    assert abs(found.volume.total - len(patches) // 6 - (name == "with one wall")) <= 1e-13
    assert bool(found.findings) == (method != "exact")


@pytest.mark.parametrize("name", ["face to face", "at an edge", "one inside out"])
def test_touching_bodies_are_told_apart_for_any_facing(name):
    rng, patches = np.random.default_rng(1), TOUCHING[name][0]
    for _ in range(5):
        found = measure_patches(
            [
                patches[k].reverse_orientation() if rng.random() < 0.5 else patches[k]
                for k in rng.permutation(len(patches))
            ],
            order=0,
        )
        assert found.method == "reoriented" and abs(found.volume.total - 2.0) <= 1e-13
        assert "ambiguous_patch_sides" in codes(found)


def band_of_one_side():
    """A Möbius band closes upon itself the wrong way round."""
    turns = np.linspace(0.0, 2.0 * np.pi, 17)
    arm = np.stack(
        [np.cos(turns) * np.cos(turns / 2), np.sin(turns) * np.cos(turns / 2), np.sin(turns / 2)],
        axis=1,
    )
    middle = np.stack([3.0 * np.cos(turns), 3.0 * np.sin(turns), 0.0 * turns], axis=1)
    space = SplineSpace((0.0, *map(float, range(17)), 16.0), 2, 17)
    return Patch((space, clamped_space(2)), np.stack([middle - arm, middle + arm], axis=1))


def test_cavities_larger_than_the_body_leave_no_negative_volume():
    """Two bodies of the largest possible overlap, as for meshes."""
    holes = [turned(box((9.0, 9.0, 9.0), (at, at, at))) for at in (0.25, 0.5)]
    found = measure_patches(box((10.0, 10.0, 10.0), (0.0, 0.0, 0.0)) + sum(holes, []))
    assert codes(found) == ["cavities_subtracted", "components_overlap"]
    assert abs(found.volume.total / (2.0 * 9.0**3 - 10.0**3) - 1.0) <= 1e-13
    assert found.signs.tolist() == [-1.0] * 18
    facing = volume_moments(found.patches, 3, found.volume.about)[0]
    assert np.abs(facing.raw - found.volume.raw).max() <= 1e-12 * np.abs(found.volume.raw).max()


def bottle_of_one_side():
    """A Klein bottle has no boundary: a figure of eight that turns by half on its way."""
    u, v = np.linspace(0.0, 2.0 * np.pi, 17)[:, None], np.linspace(0.0, 2.0 * np.pi, 17)
    along, across = np.sin(v), np.sin(2.0 * v)
    away = 3.0 + np.cos(u / 2.0) * along - np.sin(u / 2.0) * across
    height = np.sin(u / 2.0) * along + np.cos(u / 2.0) * across
    space = SplineSpace((0.0, *map(float, range(17)), 16.0), 2, 17)
    return Patch((space, space), np.stack([away * np.cos(u), away * np.sin(u), height], axis=-1))


@pytest.mark.parametrize(
    "patch", [band_of_one_side(), bottle_of_one_side()], ids=["band", "bottle"]
)
def test_a_patch_of_one_side_only_is_open(patch):
    found = measure_patches([patch])
    assert found.method == "open" and not found.health.closed
    assert codes(found) == ["open_patch_sides"]


def test_a_cavity_is_subtracted_and_a_nested_ball_counted_twice():
    small = sphere().transform(np.diag([0.5, 0.5, 0.5, 1.0]))
    hollow = measure_patches([sphere(), small.reverse_orientation()])
    assert (hollow.method, hollow.health.cavities) == ("exact", 1)
    assert abs(hollow.volume.total / (BALL * 0.875) - 1.0) <= 1e-14
    nested = measure_patches([sphere(), small])
    assert nested.health.nested_components == 1 and only(nested) == Finding(
        "components_nested", {"count": 1}
    )
    assert abs(nested.volume.total / (BALL * 1.125) - 1.0) <= 1e-14


@pytest.mark.parametrize("gap", [0.02, 0.005, 1e-4])
def test_cavity_near_the_surface_is_found_despite_samples(gap):
    turn, _ = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))
    inner = np.eye(4)
    inner[:3, :3] = turn * np.sign(np.linalg.det(turn)) * (1.0 - gap)
    hollow = measure_patches([sphere(), sphere().transform(inner).reverse_orientation()])
    assert (hollow.method, hollow.health.cavities) == ("exact", 1)
    assert hollow.findings == (Finding("cavities_subtracted", {"count": 1}),)
    assert abs(hollow.volume.total / (BALL * (1.0 - (1.0 - gap) ** 3)) - 1.0) <= 1e-11


def shifted(patch, *by):
    move = np.eye(4)
    move[:3, 3] = by
    return patch.transform(move)


def test_part_thinner_than_its_sampling_error_keeps_its_facing():
    """A crescent between two parabolas, the outer one in a single span, beside a box."""
    line, outer, inner = (
        clamped_space(2),
        clamped_space(3),
        clamped_space(3, tuple(np.arange(1, 16) / 16.0)),
    )
    sides = []
    for space, height in ((outer, 0.5), (inner, 0.499)):
        ends = [space.knots[i + 1 : i + 3] for i in range(space.count)]
        # the blossom of h (1 - x²), with x from -1 to 1
        arc = [(a + b - 1.0, height * (1.0 - (2.0 * a - 1.0) * (2.0 * b - 1.0))) for a, b in ends]
        sides.append(Patch((space, line), [[(x, y, z) for z in (0.0, 1.0)] for x, y in arc]))
    for patches in (
        [sides[0].reverse_orientation(), sides[1]],
        [sides[0], sides[1].reverse_orientation()],
    ):
        alone = measure_patches(patches)
        found = measure_patches([*patches, *box(offset=(0.0, 5.0, 0.0))])
        assert abs(alone.volume.total / (0.001 * 4.0 / 3.0) - 1.0) <= 1e-9
        assert abs(found.volume.total - 6.0 - 0.001 * 4.0 / 3.0) <= 1e-11
        assert found.health.inverted_components == alone.health.inverted_components


@pytest.mark.parametrize("apart, crossing", [(0.0, 2), (1.0, 2), (1.98, 2), (2.001, 0)])
def test_balls_overlapping_by_a_hundredth_are_reported(apart, crossing):
    for direction in [np.array([1.0, 0.0, 0.0]), *np.random.default_rng(3).normal(size=(5, 3))]:
        move = np.eye(4)
        move[:3, 3] = apart * direction / np.linalg.norm(direction)
        found = measure_patches([sphere(), sphere().transform(move)])
        assert found.health.overlapping_components == crossing
        assert bool(found.findings) == (crossing > 0)


def test_a_flat_patch_encloses_nothing_and_says_so():
    found = measure_patches([flat([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], (3, 3))])
    assert found.method == "open" and abs(found.volume.total) <= 1e-14
    assert codes(found) == ["flat_surface"]


def test_float32_storage_is_in_the_volume_bound():
    ball = sphere().transform(np.diag([1.0, 2.0, 3.0, 1.0]))
    stored = 2.0**-24 * 6.0
    exact = measure_patches([ball], stored=stored).volume
    rng = np.random.default_rng(0)
    for _ in range(5):
        move = rng.uniform(-1, 1, ball.points.shape)
        move *= stored / np.linalg.norm(move, axis=2, keepdims=True)
        move[:, 0], move[:, -1] = move[0, 0], move[0, -1]
        moved = measure_patches(
            [Patch(ball.spaces, ball.points + move, ball.weights)]
        ).volume.about_point(exact.about)
        assert (
            np.abs(moved.raw - exact.raw)
            <= exact.input_error + exact.rounding_error + moved.rounding_error
        ).all()


def test_float32_bound_holds_for_caps_larger_than_the_body():
    disc, stored = tube(1.0, 0.0005), 1e-7
    exact = measure_patches([disc], stored=stored).volume
    points = disc.points + stored * np.array([[0, 0, -1], [0, 0, 1]])
    moved = measure_patches([Patch(disc.spaces, points, disc.weights)]).volume
    assert (
        1e-7
        <= abs(moved.total - exact.total)
        <= exact.input_error[0] + exact.rounding_error[0] + moved.rounding_error[0]
    )


@pytest.mark.parametrize(
    "patch",
    [
        flat([(5, 0, 0), (6, 0, 0), (6, 1, 0), (5, 1, 0)], (3, 4), ((0.5,), ())),
        sphere(),
        torus(),
        tube(),
    ],
)
def test_float32_storage_is_in_the_area_bound(patch):
    stored = 1e-6
    exact = measure_patches([patch], stored=stored).area
    arms = patch.points - patch.points.mean(axis=(0, 1))
    for move in (arms, np.sign(np.random.default_rng(0).uniform(-1, 1, arms.shape))):
        points = patch.points + stored * move / np.linalg.norm(move, axis=2, keepdims=True).clip(
            1e-9
        )
        moved = measure_patches([Patch(patch.spaces, points, patch.weights)]).area
        assert (
            abs(moved.total - exact.total)
            <= exact.input_error[0] + exact.rounding_error[0] + moved.rounding_error[0]
        )
    assert exact.input_error[0] <= 20.0 * stored * patch.points.shape[0]  # so it tells something


@pytest.mark.parametrize(
    "patches, degrees",
    [
        ([sphere()], 0.0),
        ([torus()], 0.0),
        ([tube()], 0.0),
        (box(), 90.0),
        ([patch.reverse_orientation() if k % 2 else patch for k, patch in enumerate(box())], 90.0),
        ([flat([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], (2, 3), ((0.5,), (0.5,)))], 0.0),
        (
            [
                flat([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]),
                flat([(1, 0, 0), (2, 0, 0.1), (2, 1, 0.1), (1, 1, 0)]),
            ],
            np.degrees(np.arctan(0.1)),
        ),
        (
            [
                Patch(
                    (SplineSpace((0.0, 0.0, 1.0, 2.0, 2.0), 2, 3), clamped_space(2)),
                    [[(x, y, z) for z in (0, 1)] for x, y in ((1, 0), (0, 0), (0, 1))],
                )
            ],
            90.0,
        ),
    ],
)
def test_creases_within_patches_and_between_them_are_found(patches, degrees):
    for move in (np.eye(4), np.diag([-1e-4, 1e-4, 1e-4, 1.0])):
        own = [patch.transform(move) for patch in patches]
        assert np.degrees(sharpest_crease(own, find_topology(own, 1e-12))) == pytest.approx(
            degrees, abs=1e-6
        )


def test_flat_part_beside_a_body_is_left_out_and_reported():
    found = measure_patches([sphere(), flat([(5, 0, 0), (6, 0, 0), (6, 1, 0), (5, 1, 0)])])
    assert abs(found.volume.total / BALL - 1.0) <= 1e-14
    assert only(found) == Finding("flat_components", {"count": 1, "total": 2})


def test_all_points_in_one_place_are_refused():
    with refused("no_extent"):
        measure_patches([Patch((clamped_space(2), clamped_space(2)), np.ones((2, 2, 3)))])


def test_tearing_knots_are_refused():
    """Two strips of one patch, apart: their inner sides are no sides of the patch, and would not be
    seen to be open.
    """
    space = SplineSpace((0.0, 0.0, 1.0, 1.0, 2.0, 2.0), 2, 4)
    with refused("discontinuous_patch"):
        measure_patches(
            [
                Patch(
                    (space, clamped_space(2)),
                    np.random.default_rng(0).uniform(-1.0, 1.0, (4, 2, 3)),
                )
            ]
        )
    with refused("curves_bound_nothing"):
        planar_region([Curve(space, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0)])])
    assert not SplineSpace((0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0), 3, 5).is_discontinuous


def test_float32_storage_error_comes_near_its_bound():
    """All control points moved outward: the volume grows by the skin times that, the area as it
    does on any ball.
    """
    patches, stored = [sphere()], 1e-6
    given = measure_patches(patches, stored=stored)
    farthest = max(float(np.linalg.norm(patch.points, axis=2).max()) for patch in patches)
    grown = measure_patches(
        [patch.transform(np.diag([*[1.0 + stored / farthest] * 3, 1.0])) for patch in patches]
    )
    for moments, larger, least in (
        (given.volume, grown.volume, 0.2),
        (given.area, grown.area, 1.0 / 20.0),
    ):
        change = (larger.total - moments.total) / moments.input_error[0]
        assert least <= change <= 1.0, change


@pytest.mark.parametrize("size", [2.0**-10, 1.0, 2.0**10])
@pytest.mark.parametrize("depth", [1e-3, 0.05])
def test_cavity_breaking_through_counts_as_given(depth, size):
    """A box of 0.8 by 0.8 by 0.9 that reaches this far out of a unit box."""
    cavity = turned(
        box((0.8 * size, 0.8 * size, 0.9 * size), (0.1 * size, 0.1 * size, -depth * size))
    )
    found = measure_patches([*box((size, size, size), (0.0, 0.0, 0.0)), *cavity])
    finding = only(found)
    assert (found.method, finding.code, finding.values["count"]) == (
        "exact",
        "cavities_break_through",
        1,
    )
    assert close(finding.values["share"], depth / np.linalg.norm([1.0, 1.0, 1.0 + depth]), rel=1e-6)
    assert close(found.volume.total, 0.424 * size**3, rel=1e-12) and found.health.cavities == 1


@pytest.mark.parametrize("size", [1.0, 1000.0])
def test_gaps_along_seams_are_in_the_bound(size):
    """A box with one side lifted by a millionth of its size, within the touching tolerance."""
    patches, gap = box((size, size, size), (0.0, 0.0, 0.0)), 1e-6 * size
    lift = np.eye(4)
    lift[2, 3] = gap
    top = next(k for k, patch in enumerate(patches) if (patch.points[..., 2] == size).all())
    patches[top] = patches[top].transform(lift)
    found = measure_patches(patches)
    bound = found.volume.input_error[0]
    assert found.method == "exact"
    # four gaps of this area, a third of the diagonal away
    assert close(bound, 4.0 * gap * size * np.sqrt(3.0) * size / 3.0, rel=1e-5)
    assert bound / 10.0 < abs(found.volume.total - size**3) <= bound


def test_closed_part_beside_an_open_one_needs_no_more_volume():
    plate = box((1.0, 1.0, 9e-6), (5.0, 0.0, 0.0))
    assert measure_patches(plate).method == "exact"
    found = measure_patches([tube(), *plate])
    assert codes(found) == ["patch_holes_capped"] and found.signs.tolist() == [1.0] * 7
