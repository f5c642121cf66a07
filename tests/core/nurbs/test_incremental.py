# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Control points that move: tables against measuring anew, and the paper's Φ against both."""

import numpy as np
import pytest
from body_moments.core.numerics.bspline import clamped_space
from body_moments.core.nurbs import (
    Patch,
    area_moments,
    blender_space,
    measure_patches,
    volume_moments,
)
from body_moments.core.nurbs.tracked_solid import IncrementalPatchMoments, TrackedSolid
from body_moments.core.papers.soldea_elber_rivlin_2002_phi import phi, phi_moments

from tests.close import close
from tests.core import exact
from tests.core.exact_splines import flux_moment, sphere, torus, tube
from tests.core.findings import codes

ABOUT = np.array([0.25, -0.5, 0.125])
SPACES = [
    (clamped_space(4, (0.2, 0.4, 0.6, 0.8)), clamped_space(4, (0.2, 0.4, 0.6, 0.8))),
    (blender_space(11, 4, True, False, False), blender_space(9, 3, False, False, True)),
    (blender_space(20, 3, True, False, True), blender_space(25, 2, False, False, False)),
    (blender_space(4, 4, True, False, False), blender_space(3, 3, True, False, False)),
]


@pytest.mark.parametrize("order", [0, 1, 2, 3])
@pytest.mark.parametrize("spaces", SPACES)
def test_tables_give_the_moments_of_measuring_anew(spaces, order):
    rng = np.random.default_rng(order)
    points = rng.uniform(-1, 1, (spaces[0].count, spaces[1].count, 3))
    evaluator = IncrementalPatchMoments(Patch(spaces, points), order, ABOUT)
    for _ in range(3):
        points = points + rng.uniform(-0.2, 0.2, points.shape)
        anew, _ = volume_moments([Patch(spaces, points)], order, ABOUT)
        assert (np.abs(evaluator.moments(points).raw - anew.raw) <= anew.rounding_error).all()


@pytest.mark.parametrize("rational", [False, True])
@pytest.mark.parametrize("spaces", SPACES)
def test_one_moved_point_matches_a_full_measurement(spaces, rational):
    rng = np.random.default_rng(1)
    shape = (spaces[0].count, spaces[1].count)
    points = rng.uniform(-1, 1, (*shape, 3))
    weights = rng.uniform(0.5, 2.0, shape) if rational else None
    evaluator = IncrementalPatchMoments(Patch(spaces, points, weights), 2, ABOUT)
    evaluator.moments(points)
    fresh = IncrementalPatchMoments(Patch(spaces, points, weights), 2, ABOUT)
    for _ in range(30):
        i, j = (int(rng.integers(count)) for count in shape)
        points[i, j] += rng.uniform(-0.5, 0.5, 3)
        moved = evaluator.moments(points)
    anew = fresh.moments(points)
    assert np.abs(moved.raw - anew.raw).max() <= 1e-13
    assert close(evaluator.area, fresh.area, rel=1e-13)


@pytest.mark.parametrize(
    "spaces",
    [
        (clamped_space(3), clamped_space(3)),
        (clamped_space(2), clamped_space(3)),
        (clamped_space(3), clamped_space(2, (0.25,))),
        (blender_space(3, 3, True, False, False), clamped_space(3)),
        (blender_space(3, 3, True, False, False),) * 2,
    ],
)
def test_the_papers_tensors_give_the_exact_moments(spaces):
    rng = np.random.default_rng(5)
    points = rng.integers(-8, 9, (spaces[0].count, spaces[1].count, 3)) / 8.0
    found = phi_moments(points, tuple(phi(spaces, order) for order in range(3)))
    assert len(found) == 10
    for exponents, value in found.items():
        assert abs(value - float(flux_moment(Patch(spaces, points), exponents))) <= 1e-14


@pytest.mark.parametrize("patch", [torus(), sphere(), tube()])
def test_followed_body_matches_a_new_measurement(patch):
    rng = np.random.default_rng(7)
    body = TrackedSolid([patch])
    points = patch.points.copy()
    kept = 0
    for step in range(12):
        points = points.copy()
        if step % 3 == 2:
            points *= rng.uniform(0.9, 1.1, 3)
        elif patch.points.shape[1] == 5:  # not a pole, nor off the seam
            points[3, 2] += rng.uniform(-0.2, 0.2, 3)
        else:
            points[3, 1] += rng.uniform(-0.05, 0.05, 3)
        now = Patch(patch.spaces, points, patch.weights)
        kept += body.update([now])
        anew = measure_patches([now])
        assert body.measure.method == anew.method
        assert (
            np.abs(body.measure.volume.about_point(anew.volume.about).raw - anew.volume.raw).max()
            <= 1e-12
        )
        assert body.measure.area.total == pytest.approx(area_moments([now])[0].total, rel=1e-3)
    assert kept >= 8


def test_opening_followed_body_is_capped():
    ball = sphere()
    body = TrackedSolid([ball])
    points = ball.points.copy()
    points[:, -1] += 0.1 * (points[:, 1] - [0.0, 0.0, -1.0])  # the pole becomes a rim
    now = [Patch(ball.spaces, points, ball.weights)]
    body.update(now)
    assert body.measure.method == "capped"
    assert_same(body, measure_patches(now))


def assert_same(body, anew):
    """Compare a followed body and its findings with a new measurement."""
    found = body.measure
    assert (found.method, codes(found)) == (anew.method, codes(anew))
    for name in (
        "closed",
        "boundary_edges",
        "inverted_components",
        "nested_components",
        "cavities",
        "overlapping_components",
    ):
        assert getattr(found.health, name) == getattr(anew.health, name)
    there = anew.volume.about_point(found.volume.about)
    assert (
        np.abs(found.volume.raw - there.raw) <= found.volume.rounding_error + there.rounding_error
    ).all()
    assert found.volume.rounding_error[0] <= 1e-10 * found.volume.total  # so it tells something


def moved(patch, scale=1.0, by=(0.0, 0.0, 0.0)):
    matrix = np.diag([scale, scale, scale, 1.0])
    matrix[:3, 3] = by
    return patch.transform(matrix)


def bent(patch):
    """A tube with a second rim that leaves its plane."""
    points = patch.points.copy()
    points[::2, 1, 2] += 0.3
    return Patch(patch.spaces, points, patch.weights)


@pytest.mark.parametrize(
    "before, after",
    [
        (
            [sphere(), moved(sphere(), 0.4).reverse_orientation()],
            [sphere(), moved(sphere(), 0.4, (3.0, 0.0, 0.0)).reverse_orientation()],
        ),
        (
            [sphere(), moved(sphere(), 1.0, (3.0, 0.0, 0.0))],
            [sphere(), moved(sphere(), 1.0, (1.0, 0.0, 0.0))],
        ),
        (
            [sphere(), moved(sphere(), 0.5, (3.0, 0.0, 0.0))],
            [
                sphere(),
                moved(sphere().transform(np.diag([0.5, 0.5, -0.5, 1.0])), 1.0, (3.0, 0.0, 0.0)),
            ],
        ),
        ([tube()], [bent(tube())]),
    ],
    ids=["a cavity leaves", "parts meet", "a part turns inside out", "a rim bends"],
)
def test_decision_about_a_followed_body_does_not_outlive_it(before, after):
    body = TrackedSolid(before)
    assert body.update(after)
    assert_same(body, measure_patches(after))


@pytest.mark.parametrize(
    "scale, far", [(1.0, 1e3), (1.0, 1e6), (1e3, 0.0), (1e-6, 0.0), (1e-3, 1e4)]
)
def test_a_followed_body_may_go_far_away_grow_and_shrink(scale, far):
    body = TrackedSolid([torus()])
    now = [moved(torus(), scale, (far, -far, 0.0))]
    body.update(now)
    assert_same(body, measure_patches(now))
    central, anew = (one.volume.about_center() for one in (body.measure, measure_patches(now)))
    squares = [4, 7, 9]
    assert np.abs(central.raw[squares] / anew.raw[squares] - 1.0).max() <= 1e-9


def test_a_followed_body_does_not_drift():
    """Every control point far away and back again, one after the other, in a thousand steps."""
    rng, ring = np.random.default_rng(0), torus()
    body, points = TrackedSolid([ring]), ring.points.copy()
    for step in range(1000):
        i, j = rng.integers(8, size=2)
        points = points.copy()
        points[i, j] = ring.points[i, j] + rng.uniform(-0.2, 0.2, 3) * (step < 900)
        body.update([Patch(ring.spaces, points, ring.weights)])
    assert_same(body, measure_patches([Patch(ring.spaces, points, ring.weights)]))
    body.update([ring])
    assert np.abs(body.measure.volume.raw - measure_patches([ring]).volume.raw).max() <= 1e-14


def box_nets(*size):
    corners = np.array(exact.box((0.0, 0.0, 0.0), size))[exact.BOX_QUADS]
    return [np.array([[a, d], [b, c]]) for a, b, c, d in corners]


def plates(weights=None):
    """A box of six sides; one side faces against the others."""
    spaces = clamped_space(2), clamped_space(2)
    sides = [Patch(spaces, net, weights) for net in box_nets(1.0, 2.0, 3.0)]
    return [*sides[:5], sides[5].reverse_orientation()]


@pytest.mark.parametrize(
    "before, after",
    [
        ([torus()], [torus(), moved(sphere(), 1.0, (5.0, 0.0, 0.0))]),
        ([torus(), moved(sphere(), 1.0, (2.0, 0.0, 0.0))], [torus()]),
        (plates(), plates([[1.0, 2.0], [2.0, 1.0]])),
        (plates([[1.0, 2.0], [2.0, 1.0]]), plates()),
        ([torus()], [Patch(torus().spaces, torus().points)]),
    ],
    ids=["one more", "one fewer", "weights", "no weights", "no weights on a ring"],
)
def test_changed_patches_are_measured_anew_and_followed(before, after):
    body = TrackedSolid(before)
    assert not body.update(after)
    assert_same(body, measure_patches(after))
    assert body.update(after)


@pytest.mark.parametrize("stored", [0.0, 1e-4])
def test_followed_storage_bound_matches_a_new_measurement(stored):
    """Sides that touch but for that do so; one of them faces against the others."""
    before, gap = plates(), np.eye(4)
    gap[:3, 3] = 5e-5
    after = [moved(patch, 1.5) for patch in before]
    after[0] = after[0].transform(gap)
    body = TrackedSolid(before, stored)
    assert close(
        body.measure.area.input_error,
        measure_patches(before, stored=stored).area.input_error,
        rel=1e-12,
    )
    for patches in (before, after):
        assert body.update(patches, stored)
        anew = measure_patches(patches, stored=stored)
        assert body.measure.method == anew.method and codes(body.measure) == codes(anew)
        assert close(body.measure.volume.input_error[0], anew.volume.input_error[0], rel=1e-9)
        assert (body.measure.area.input_error[0] > 0.0) == (stored > 0.0)
    assert body.measure.health.closed == (stored > 0.0)


def test_changed_weights_are_measured_anew():
    ring = torus()
    body = TrackedSolid([ring])
    weights = ring.weights.copy()
    weights[3, 3], weights[4, 4] = 1e3, 1e-3
    points = ring.points.copy()
    for _ in range(2):
        points[5, 1] += 0.1
        now = Patch(ring.spaces, points, weights)
        assert not body.update([now])
        anew = measure_patches([now]).volume
        found = body.measure.volume
        assert (
            np.abs(found.raw - anew.about_point(found.about).raw)
            <= found.rounding_error + anew.rounding_error
        ).all()


@pytest.mark.parametrize("spread", [0.3, 0.7, 1.0])
def test_the_estimate_of_a_followed_rational_body_holds(spread):
    rng = np.random.default_rng(9)
    ring, kept = torus(), 0
    for _ in range(10):
        weights = 10.0 ** rng.uniform(-spread, spread, ring.weights.shape)
        body = TrackedSolid([Patch(ring.spaces, ring.points, weights)])
        points = ring.points + rng.uniform(-0.05, 0.05, ring.points.shape)
        now = Patch(ring.spaces, points, weights)
        kept += body.update([now])
        anew = measure_patches([now]).volume.about_point(body.measure.volume.about)
        assert (
            np.abs(body.measure.volume.raw - anew.raw)
            <= body.measure.volume.rounding_error + anew.rounding_error
        ).all()
    assert kept or spread > 0.5


def test_rewritten_input_arrays_change_no_patch():
    """Else the body that is followed would see no difference, and a patch whose weights were steady
    would stay so.
    """
    spaces = clamped_space(2), clamped_space(2)
    nets = box_nets(1.0, 1.0, 1.0)
    body = TrackedSolid([Patch(spaces, net) for net in nets])
    for net in nets:
        net[..., 0] *= 2.0
    assert body.update([Patch(spaces, net) for net in nets])
    assert close(body.measure.volume.total, 2.0, rel=1e-14)
    weights = np.array([[1.0, 2.0], [1.0, 2.0]])
    patch = Patch(spaces, nets[0], weights)
    assert patch.constant_weights == (True, False)
    weights[0, 0] = 5.0
    assert patch.weights[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        patch.points[0, 0, 0] = 7.0
