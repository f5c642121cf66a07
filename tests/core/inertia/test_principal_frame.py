# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The principal frame is right-handed, ordered, and the same however the body lies; what a symmetry
leaves free is taken nearest to the preferred axes and said.
"""

import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from body_moments.core.inertia.principal_frames import PrincipalFrame, principal_frame
from body_moments.core.moments.raw import Moments, monomials, sum_moments

from tests.close import close
from tests.core.findings import refused


def box(low, high):
    """Moments to order 3 of a box, about the origin."""
    raw = [
        np.prod([(high[i] ** (n + 1) - low[i] ** (n + 1)) / (n + 1) for i, n in enumerate(row)])
        for row in monomials(3).tolist()
    ]
    return Moments(np.array(raw), np.zeros(3))


def random_motion(rng, mirrored=False):
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if (np.linalg.det(rotation) < 0) != mirrored:
        rotation[:, 0] *= -1
    matrix = np.eye(4)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = rng.normal(size=3) * 10
    return matrix


def tetrahedron():
    """A generic tetrahedron: the unit simplex under a shear, all products of inertia different
    (Tonon 2004's kind).
    """
    import math

    f = math.factorial
    raw = [f(p) * f(q) * f(r) / f(p + q + r + 3) for p, q, r in monomials(3).tolist()]
    shear = [[1, 0.3, -0.2, 0], [0.1, 2, 0.5, 0], [0.4, 0, 3, 0], [0, 0, 0, 1]]
    return Moments(np.array(raw), np.zeros(3)).transform(shear)


UNIQUE = {
    "tetrahedron": tetrahedron(),
    "three boxes": sum_moments(
        [box((0, 0, 0), (4, 1, 1)), box((0, 1, 0), (1, 3, 1)), box((0, 0, 1), (1, 1, 2.5))]
    ),
    "unequal L prism": sum_moments([box((0, 0, 0), (3, 1, 1)), box((0, 1, 0), (1, 4, 1))]),
}


@pytest.mark.parametrize("name", UNIQUE)
def test_the_frame_turns_with_the_body(name):
    body = UNIQUE[name]
    rng = np.random.default_rng(3)
    first = principal_frame(body)
    assert first.is_unique and first.finding is None and first.symmetry == "asymmetric"
    for _ in range(100):
        motion = random_motion(rng)
        frame = principal_frame(body.transform(motion), preferred_axes=random_motion(rng)[:3, :3])
        assert np.allclose(motion[:3, :3].T @ frame.axes, first.axes, atol=1e-9)
        assert close(frame.moments, first.moments, rel=1e-12)


@pytest.mark.parametrize("place", [4, 7, 9])
@pytest.mark.parametrize("size, code", [(1e-300, "negative_inertia"), (1e-310, "object_size")])
def test_underflowing_second_moments_are_refused_as_too_small(place, size, code):
    """The rule holds for any axes and any third moments."""
    raw = np.zeros(20)
    raw[[0, 10, 13, 19]], raw[place] = 1e-250, -size
    with refused(code):
        principal_frame(Moments(raw, np.zeros(3), "volume"))


@pytest.mark.parametrize("far", [[1, 0, 0], [0, 0, 1], [1, 2, 3]])
def test_impossible_moments_are_refused(far):
    """Distant mass counts with the opposite sign: along one axis, or along all of them."""
    far = 20.0 * np.array(far)
    parts = [
        box((-1, -1, -1), (1, 1, 1)),
        *(box(side * far - 0.5, side * far + 0.5) * -1.0 for side in (-1, 1)),
    ]
    with refused("negative_inertia"):
        principal_frame(sum_moments(parts))


def test_frame_is_right_handed_ascending_and_diagonal():
    rng = np.random.default_rng(4)
    for body in UNIQUE.values():
        image = body.transform(random_motion(rng, mirrored=True))
        frame = principal_frame(image)
        assert np.linalg.det(frame.axes) == pytest.approx(1.0, abs=1e-12)
        assert (np.diff(frame.moments) > 0).all()
        central = image.about_center().second()
        tensor = np.trace(central) * np.eye(3) - central
        assert np.allclose(
            frame.axes.T @ tensor @ frame.axes,
            np.diag(frame.moments),
            atol=1e-12 * frame.moments.max(),
        )


def test_mirror_images_have_right_handed_mirrored_frames():
    body = UNIQUE["tetrahedron"]
    frame, mirrored = (
        principal_frame(body),
        principal_frame(body.transform(np.diag([-1.0, 1.0, 1.0, 1.0]))),
    )
    reflected = np.diag([-1.0, 1.0, 1.0]) @ frame.axes
    same = [np.allclose(mirrored.axes[:, i], reflected[:, i], atol=1e-9) for i in range(3)]
    assert sum(same) == 2  # the weakest axis gives way to handedness


def test_the_two_clearest_axes_have_positive_third_moments():
    for body in UNIQUE.values():
        frame = principal_frame(body)
        central = body.about_center()
        third = np.einsum("abc,ai,bi,ci->i", central.third(), *[frame.axes] * 3)
        spread = np.diag(frame.axes.T @ central.second() @ frame.axes) / body.total
        scores = third / (body.total * spread**1.5)
        clearest = np.argsort(np.abs(scores))[1:]
        assert (scores[clearest] > 0).all() or np.abs(scores[clearest]).min() < 1e-6


def test_a_cube_takes_the_preferred_axes():
    rng = np.random.default_rng(0)
    prefer = random_motion(rng)[:3, :3]
    frame = principal_frame(box((0, 0, 0), (1, 1, 1)), prefer)
    assert (
        frame.symmetry == "isotropic" and not frame.is_unique and frame.finding.code == "axes_free"
    )
    assert np.allclose(frame.axes, prefer)
    assert np.allclose(frame.moments, 1 / 6)


@pytest.mark.parametrize(
    "size, symmetry, distinct", [((1, 1, 2), "prolate", 0), ((2, 2, 1), "oblate", 2)]
)
def test_free_axes_stay_nearest_to_the_preferred_ones(size, symmetry, distinct):
    rng = np.random.default_rng(0)
    for _ in range(20):
        prefer = random_motion(rng)[:3, :3]
        frame = principal_frame(box((0, 0, 0), size), prefer)
        assert frame.symmetry == symmetry and not frame.is_unique
        assert abs(frame.axes[2, distinct]) == pytest.approx(1.0, abs=1e-12)
        nearest = np.trace(prefer.T @ frame.axes)
        for angle in rng.uniform(0, 2 * np.pi, 50):  # no other allowed frame is nearer
            c, s = np.cos(angle), np.sin(angle)
            turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            for flip in (np.eye(3), np.diag([1.0, -1.0, -1.0])):
                assert np.trace(prefer.T @ turn @ flip @ frame.axes) <= nearest + 1e-9


def test_a_box_has_four_equal_poses_and_takes_the_nearest():
    body = box((0, 0, 0), (3, 2, 1))
    frame = principal_frame(body)
    assert (
        frame.symmetry == "asymmetric"
        and not frame.is_unique
        and frame.finding.code == "axes_ambiguous"
    )
    assert np.allclose(frame.axes, np.eye(3))
    turned = principal_frame(body, preferred_axes=np.diag([-1.0, -1.0, 1.0]))
    assert np.allclose(turned.axes, np.diag([-1.0, -1.0, 1.0]))


def test_noise_does_not_flip_the_frame_of_a_symmetric_body():
    rng = np.random.default_rng(0)
    body = box((0, 0, 0), (1, 2, 3))  # the long axis is z: no candidate is nearest by trace alone
    first = principal_frame(body).axes
    for _ in range(50):
        noisy = Moments(body.raw * (1 + rng.normal(size=20) * 1e-13), body.about)
        assert np.allclose(principal_frame(noisy).axes, first, atol=1e-6)


def test_a_thin_needle_keeps_its_cross_section_apart():
    assert principal_frame(box((0, 0, 0), (1, 1e-3, 2e-3))).symmetry == "asymmetric"
    assert principal_frame(box((0, 0, 0), (1, 1e-3, 1e-3))).symmetry == "prolate"


def test_a_lamina_keeps_the_triangle_inequality():
    frame = principal_frame(box((0, 0, 0), (1, 2, 1e-12)))
    a, b, c = frame.moments
    assert a + b >= c > 0


def test_threads_may_ask_for_axes_at_once():
    known = PrincipalFrame(np.ones(3), np.eye(3), "isotropic", False, None)

    def find():
        time.sleep(0.05)
        return known

    frame = PrincipalFrame.on_demand(known.moments, find)
    with ThreadPoolExecutor(4) as pool:
        assert all(axes is known.axes for axes in pool.map(lambda _: frame.axes, range(4)))


def test_failure_to_find_axes_is_raised_each_time():
    def find():
        raise MemoryError

    frame = PrincipalFrame.on_demand(np.ones(3), find)
    for _ in range(2):
        with pytest.raises(MemoryError):
            _ = frame.axes


def test_later_change_of_preferred_axes_has_no_effect():
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    preferred = turn.copy()
    frame = principal_frame(box((-1, -1, -1), (1, 1, 1)), preferred)
    preferred[:] = np.eye(3)
    assert close(frame.axes, turn, 1e-12)
