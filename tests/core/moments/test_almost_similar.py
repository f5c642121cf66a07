# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Areas under maps that are similarities up to float32: each face has its own factor, within the
bound.
"""

import numpy as np
import pytest
from body_moments.core import moments, polyhedron
from body_moments.core.density import parse_polynomial, polynomial_mass_of_images
from body_moments.core.mesh.surface import Surface

# No symmetry: the faces on one side are stretched more than those on the other, and the center
# moves.
POINTS = np.array([[1, 0, 0], [-0.5, 0.8, 0], [-0.5, -0.9, 0], [0.2, 0.1, 1.5]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def almost_rotations(count, seed=3, off=3e-7):
    random = np.random.default_rng(seed)
    maps = np.tile(np.eye(4), (count, 1, 1))
    maps[:, :3, :3] = np.linalg.qr(random.normal(size=(count, 3, 3)))[0] + off * random.normal(
        size=(count, 3, 3)
    )
    maps[:, :3, 3] = random.normal(size=(count, 3))
    return maps


def area_of(points, order, about=None) -> moments.Moments:
    found = polyhedron.polyhedron_moments(Surface(points, FACES), 0, area_order=order, about=about)[
        1
    ]
    return found.about_center() if about is None else found


def images(matrices):
    return [POINTS @ matrix[:3, :3].T + matrix[:3, 3] for matrix in matrices]


def shares(found: moments.Moments, truths) -> np.ndarray:
    """Return the used share of each bound."""
    off = np.abs(found.raw - sum(truth.raw for truth in truths))
    return off / (
        found.input_error + found.rounding_error + sum(truth.rounding_error for truth in truths)
    )


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e6])
@pytest.mark.parametrize("order", [2, 3, 4])
def test_an_image_is_within_its_bound_and_uses_it(order, scale):
    matrices = almost_rotations(60)
    matrices[:, :3] *= scale
    used = np.array(
        [
            shares(found, [area_of(image, order, found.about)])
            for matrix, image in zip(matrices, images(matrices), strict=True)
            for found in [area_of(POINTS, order).transform(matrix)]
        ]
    )
    assert used.max() <= 1.0
    for degree in range(1, 3):
        assert used[:, moments.monomials(order).sum(axis=1) == degree].max() > 0.01
    assert used[:, 0].max() > 0.03 and used[:, 1:4].max() > 0.05


@pytest.mark.parametrize("order", [2, 3])
def test_the_sum_of_images_is_within_its_bound(order):
    used = []
    for seed in range(20):
        matrices = almost_rotations(3, seed)
        found = moments.sum_of_images(area_of(POINTS, order), matrices)
        used.append(
            shares(found, [area_of(image, order, found.about) for image in images(matrices)])
        )
    assert 0.02 < np.max(used) <= 1.0


def test_the_mass_of_images_is_within_its_bound():
    density = parse_polynomial("2 + x/2")
    used = []
    for seed in range(20):
        matrices = almost_rotations(2, seed)
        found = polynomial_mass_of_images(area_of(POINTS, 4), density, matrices)
        truths = [
            polynomial_mass_of_images(
                area_of(image, 4, found.about), density, np.eye(4)[None], about=found.about
            )
            for image in images(matrices)
        ]
        used.append(shares(found, truths))
    assert 0.02 < np.max(used) <= 1.0
