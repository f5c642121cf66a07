# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Degenerate and uneven faces, found by sums and compared with single faces."""

from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from body_moments.core.mesh.planarity import PLANAR_RTOL, ZERO_AREA_RTOL, PlanarityAccumulator
from body_moments.core.mesh.surface import Surface
from body_moments.core.polyhedron import integration

from tests.close import close
from tests.core.bodies import ring, rotation

# open faces count as given
polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)


def one_by_one(surface, error):
    """The number of bent quads, their spread and the faces without area, by the definition."""
    points = [[Fraction(float(x)) for x in point] for point in surface.points]

    def span(i, j):
        return [x - y for x, y in zip(points[i], points[j])]

    def cross(u, v):
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

    def dot(u, v):
        return sum(x * y for x, y in zip(u, v))

    bent, spread, bare = 0, Fraction(0), []
    for face, corners in enumerate([*surface.quads.tolist(), *surface.triangles.tolist()]):
        a, b, c = corners[:3]
        first, second = (
            (span(c, a), span(corners[3], b)) if len(corners) == 4 else (span(b, a), span(c, a))
        )
        normal = cross(first, second)
        square, longest = (
            float(dot(normal, normal)),
            float(max(dot(first, first), dot(second, second))),
        )
        volume = abs(dot(span(b, a), normal)) if len(corners) == 4 else 0
        if square <= longest * (error**2 + ZERO_AREA_RTOL**2 * longest):
            bare.append(face)
        elif volume > square**0.5 * (8.0 * error + PLANAR_RTOL * square**0.25):
            bent, spread = bent + 1, spread + volume / 6
    return bent, float(spread), bare


def quads(kind, dtype):
    """A torus of 1800 quads: flat but for rounding, bent, some of them bent or folded, or without
    area.
    """
    points, faces = ring(60, 30)
    rng = np.random.default_rng(3)
    # each quad with corners of its own, so that they can be bent one by one
    loose = points[faces].reshape(-1, 3)
    faces = np.arange(len(loose)).reshape(-1, 4)
    a, b, _, d = (loose[k::4].copy() for k in range(4))
    scale = np.exp(rng.uniform(-4.0, 0.0, (len(faces), 1))) if kind != "folded" else 0.5
    b, d = a + (b - a) * scale, a + (d - a) * scale
    c = b + d - a  # flat
    normal = np.cross(b - a, d - a)
    if kind == "bent":
        c += normal * rng.uniform(-5.0, 5.0, (len(c), 1))
    # two triangles that nearly make up for each other, bent by about their own limit
    if kind == "folded":
        size = np.linalg.norm(normal, axis=1)[:, None]
        c[::5] = (a + 1.5 * (b - a) - 1.45 * (d - a) + 1e-5 * normal / size)[::5]
    if kind == "bare":  # but for a trace of an area, on one side
        b[::17] = a[::17] + 3e-7 * ((b - a) / np.linalg.norm(b - a, axis=1)[:, None])[::17]
        c[::17] = b[::17] + (d - a)[::17]
    if kind in ("some", "all sorts"):
        c[::7] += (normal * rng.uniform(-5.0, 5.0, (len(c), 1)))[::7]
        # about the limit
        c[1::7] += (normal * 1e-6 * rng.uniform(-200.0, 200.0, (len(c), 1)))[1::7]
    if kind == "all sorts":
        c[::5] = a[::5] - 0.3 * (c - a)[::5]  # folded
        d[::11] = b[::11]  # two triangles on each other
        c[::13] = b[::13] + (b - a)[::13]
        d[::13] = a[::13] - (b - a)[::13]  # no area
        b[::17] = a[::17]
        d[::17] = a[::17]
    points = np.stack([a, b, c, d], axis=1).reshape(-1, 3)
    return Surface(
        (points @ rotation(3).T + [0.1, 0.2, 0.3]).astype(dtype), quads=faces.astype(np.int32)
    )


def told(surface, seen, threads=1):
    error = float(np.linalg.norm(surface.coordinate_error))
    witness = PlanarityAccumulator(surface, error)
    if seen:
        polyhedron_moments(surface, area_order=0, threads=threads, planarity=witness)
        assert sum(block.count for block in witness.quads.values()) == len(surface.quads)
        assert sum(block.count for block in witness.triangles.values()) == len(surface.triangles)
    found = witness.planarity()
    return found.non_planar_count, found.volume_spread, found.degenerate_faces.tolist(), error


@pytest.mark.parametrize("order", ["pairs", "halves", "loose"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_triangles_without_area_are_found_wherever_they_stand(order, dtype):
    surface = quads("all sorts", dtype)
    halves = surface.quads[:, [0, 1, 2]], surface.quads[:, [0, 2, 3]]
    triangles = (
        np.stack(halves, axis=1).reshape(-1, 3) if order == "pairs" else np.concatenate(halves)
    )
    if order == "loose":
        triangles = triangles[np.random.default_rng(0).permutation(len(triangles))]
    surface = Surface(surface.points, triangles)
    for seen in (False, True):
        *found, error = told(surface, seen)
        bent, spread, bare = one_by_one(surface, error)
        assert found == [0, 0.0, bare] and len(bare) > 300


@pytest.mark.parametrize("scale", [2.0**-120, 2.0**120])
def test_sizes_beyond_the_range_of_the_sums_do_not_matter(scale):
    surface = quads("some", np.float64)
    plain, scaled = (
        PlanarityAccumulator(replace(surface, points=surface.points * s), 0.0) for s in (1.0, scale)
    )
    for witness in (plain, scaled):
        polyhedron_moments(witness.surface, area_order=0, planarity=witness)
    plain, scaled = plain.planarity(), scaled.planarity()
    assert scaled.non_planar_count == plain.non_planar_count > 200
    assert close(scaled.volume_spread, plain.volume_spread * scale**3, rel=1e-12)
