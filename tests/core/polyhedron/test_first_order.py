# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The light pass gives the volume and the center that the full one gives."""

import numpy as np
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron.integration import volume_and_center

from tests.close import close


def torus(count, noise, seed=0):
    """Quads that are not flat; some of them are cut the other way."""
    i, j = np.meshgrid(np.arange(count), np.arange(count), indexing="ij")
    u, v = 2.0 * np.pi * i / count, 2.0 * np.pi * j / count
    points = np.stack(
        [(2.0 + np.cos(v)) * np.cos(u), (2.0 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1
    )
    points = points.reshape(-1, 3) + noise * np.random.default_rng(seed).normal(
        size=(count * count, 3)
    )
    up, across = (i + 1) % count, (j + 1) % count
    quads = [i * count + j, up * count + j, up * count + across, i * count + across]
    return points, np.stack(quads, axis=-1).reshape(-1, 4)


def test_inverted_body_is_negative_and_flat_body_has_no_center():
    points, quads = torus(12, 0.0)
    volume, center = volume_and_center(Surface(points, quads=quads))
    turned, same = volume_and_center(Surface(points, quads=quads[:, ::-1]))
    assert close(turned, -volume, 1e-13) and np.abs(same - center).max() < 1e-13
    assert not np.isfinite(
        volume_and_center(Surface(points * [1.0, 1.0, 0.0], quads=quads))[1]
    ).all()
