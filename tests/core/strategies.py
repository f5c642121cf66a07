# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Random inputs of properties: the essential parts are drawn and shown on failure, the rest comes
from a seed.
"""

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

SHAPES = {
    "round": (1.0, 1.0, 1.0),
    "flat": (1.0, 1.0, 1e-9),
    "needle": (1.0, 1e-7, 1e-7),
    "sheet": (1e3, 1.0, 1e-6),
}
PLACES = {"centred": 0.0, "near": 1.0, "far": 1e4, "very far": 1e8}
SIZES = (1.0, 1e-9, 1e12)

seeds = st.integers(0, 2**32 - 1)


def holds(examples):
    """So many examples, the same at every run, however long they take; fixtures choose the way, not
    the example.
    """
    return settings(
        max_examples=examples,
        deadline=None,
        derandomize=True,
        database=None,
        suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
    )


@st.composite
def random_meshes(draw, max_faces, extreme):
    """Points and triangles between them, at random. extreme: the smallest size."""
    shape, place, size = (
        draw(st.sampled_from(each)) for each in (sorted(SHAPES), sorted(PLACES), (*SIZES, extreme))
    )
    turned, single, rng = (
        draw(st.booleans()),
        draw(st.booleans()),
        np.random.default_rng(draw(seeds)),
    )
    count = draw(st.integers(4, 13))
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0] if turned else np.eye(3)
    points = (rng.standard_normal((count, 3)) * SHAPES[shape]) @ turn + PLACES[
        place
    ] * rng.standard_normal(3)
    points *= size
    if single and size > 1e-20:
        points = points.astype(np.float32)
    return points, rng.integers(0, count, (draw(st.integers(1, max_faces)), 3))


@st.composite
def rotations(draw):
    """Rotation matrices, right-handed: half turns about the axes among them."""
    if draw(st.booleans()):
        x, y = draw(st.sampled_from([(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]))
        return np.diag([x, y, x * y])
    matrix = np.linalg.qr(np.random.default_rng(draw(seeds)).standard_normal((3, 3)))[0]
    return matrix * np.sign(np.linalg.det(matrix))
