# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The light pass gives the volume and the center that the full one gives."""

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface, flipped_quads
from body_moments.core.polyhedron import first_order, polyhedron_moments
from body_moments.core.polyhedron.first_order import volume_and_center

from tests.close import close


def torus(count, noise, seed=0):
    """Of quads that are not flat, some of which are cut the other way."""
    i, j = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    u, v = 2.0 * np.pi * i / count, 2.0 * np.pi * j / count
    points = np.stack([(2.0 + np.cos(v)) * np.cos(u), (2.0 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)
    points = points.reshape(-1, 3) + noise * np.random.default_rng(seed).normal(size=(count * count, 3))
    up, across = (i + 1) % count, (j + 1) % count
    quads = [i * count + j, up * count + j, up * count + across, i * count + across]
    return points, np.stack(quads, axis=-1).reshape(-1, 4)


@pytest.mark.parametrize("noise", [0.0, 0.05, 0.4])
@pytest.mark.parametrize("block", [first_order.FACES_PER_BLOCK, 7])
def test_it_is_that_of_the_full_pass_wherever_the_body_is(noise, block, monkeypatch):
    monkeypatch.setattr(first_order, "FACES_PER_BLOCK", block)
    points, quads = torus(20, noise)
    assert flipped_quads(points, quads).any() == (noise == 0.4)
    for scale, place in ((1.0, (0.0, 0.0, 0.0)), (1e-9, (0.0, 0.0, 0.0)), (1e5, (2e6, 0.0, -1e6))):
        for surface in (
            Surface(scale * points + place, quads=quads),
            Surface(scale * points + place, triangles=Surface(points, quads=quads).all_triangles()[0]),
            Surface(scale * points + place, *_mixed(points, quads)),
        ):
            volume, center = volume_and_center(surface)
            truth = polyhedron_moments(surface)[0]
            assert close(volume, truth.total, 1e-11)
            assert np.linalg.norm(center - truth.center) <= 1e-11 * (scale + np.linalg.norm(place))


def _mixed(points, quads):
    """Triangles and quads of one surface."""
    half = len(quads) // 2
    return Surface(points, quads=quads[:half]).all_triangles()[0], quads[half:]


def test_what_is_inside_out_is_negative_and_what_is_flat_has_no_center():
    points, quads = torus(12, 0.0)
    volume, center = volume_and_center(Surface(points, quads=quads))
    turned, same = volume_and_center(Surface(points, quads=quads[:, ::-1]))
    assert close(turned, -volume, 1e-13) and np.abs(same - center).max() < 1e-13
    assert not np.isfinite(volume_and_center(Surface(points * [1.0, 1.0, 0.0], quads=quads))[1]).all()
