# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sums show of the faces, against each face looked at by itself."""

from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from body_moments.core.mesh.planarity import PLANAR_RTOL, ZERO_AREA_RTOL, PlanarityAccumulator, stack_planarity
from body_moments.core.mesh.surface import Surface
from body_moments.core.mesh.surface_stack import SurfaceStack
from body_moments.core.polyhedron import integration
from body_moments.core.polyhedron import third_order as polyhedron
from body_moments.core.solid.measure import measure_solid

from tests.close import close
from tests.core.bodies import CORNERS, SIDES, mesh, ring, rotation

polyhedron_moments = partial(integration.polyhedron_moments, allow_open=True)  # of faces as they are


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
        first, second = (span(c, a), span(corners[3], b)) if len(corners) == 4 else (span(b, a), span(c, a))
        normal = cross(first, second)
        square, longest = float(dot(normal, normal)), float(max(dot(first, first), dot(second, second)))
        volume = abs(dot(span(b, a), normal)) if len(corners) == 4 else 0
        if square <= longest * (error**2 + ZERO_AREA_RTOL**2 * longest):
            bare.append(face)
        elif volume > square**0.5 * (8.0 * error + PLANAR_RTOL * square**0.25):
            bent, spread = bent + 1, spread + volume / 6
    return bent, float(spread), bare


def quads(kind, dtype):
    """A torus of 1800 quads: flat but for rounding, bent, some of them bent or folded, or without area."""
    points, faces = ring(60, 30)
    rng = np.random.default_rng(3)
    loose = points[faces].reshape(-1, 3)  # each quad with corners of its own, so that they can be bent one by one
    faces = np.arange(len(loose)).reshape(-1, 4)
    a, b, _, d = (loose[k::4].copy() for k in range(4))
    scale = np.exp(rng.uniform(-4.0, 0.0, (len(faces), 1))) if kind != "folded" else 0.5
    b, d = a + (b - a) * scale, a + (d - a) * scale
    c = b + d - a  # flat
    normal = np.cross(b - a, d - a)
    if kind == "bent":
        c += normal * rng.uniform(-5.0, 5.0, (len(c), 1))
    if kind == "folded":  # two triangles that nearly make up for each other, bent by about their own limit
        size = np.linalg.norm(normal, axis=1)[:, None]
        c[::5] = (a + 1.5 * (b - a) - 1.45 * (d - a) + 1e-5 * normal / size)[::5]
    if kind == "bare":  # but for a trace of an area, on one side
        b[::17] = a[::17] + 3e-7 * ((b - a) / np.linalg.norm(b - a, axis=1)[:, None])[::17]
        c[::17] = b[::17] + (d - a)[::17]
    if kind in ("some", "all sorts"):
        c[::7] += (normal * rng.uniform(-5.0, 5.0, (len(c), 1)))[::7]
        c[1::7] += (normal * 1e-6 * rng.uniform(-200.0, 200.0, (len(c), 1)))[1::7]  # about the limit
    if kind == "all sorts":
        c[::5] = a[::5] - 0.3 * (c - a)[::5]  # folded
        d[::11] = b[::11]  # two triangles on each other
        c[::13] = b[::13] + (b - a)[::13]
        d[::13] = a[::13] - (b - a)[::13]  # no area
        b[::17] = a[::17]
        d[::17] = a[::17]
    points = np.stack([a, b, c, d], axis=1).reshape(-1, 3)
    return Surface((points @ rotation(3).T + [0.1, 0.2, 0.3]).astype(dtype), quads=faces.astype(np.int32))


def told(surface, seen, threads=1):
    error = float(np.linalg.norm(surface.coordinate_error))
    witness = PlanarityAccumulator(surface, error)
    if seen:
        polyhedron_moments(surface, area_order=0, threads=threads, planarity=witness)
        assert sum(block.count for block in witness.quads.values()) == len(surface.quads)
        assert sum(block.count for block in witness.triangles.values()) == len(surface.triangles)
    found = witness.planarity()
    return found.non_planar_count, found.volume_spread, found.degenerate_faces.tolist(), error


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", ["flat", "bent", "some", "all sorts"])
def test_what_the_sums_show_is_what_looking_at_each_face_gives(kind, dtype, monkeypatch):
    monkeypatch.setattr(polyhedron, "MIN_TRIANGLES_PER_THREAD", 64)
    monkeypatch.setattr(polyhedron, "MAX_TRIANGLES_PER_BLOCK", 512)
    surface = quads(kind, dtype)
    for seen, threads in ((False, 1), (True, 1), (True, 3)):
        *found, error = told(surface, seen, threads)
        bent, spread, bare = one_by_one(surface, error)
        assert (found[0], found[2]) == (bent, bare)
        assert close(found[1], spread, rel=1e-11)
    assert (bent > 0) == (kind != "flat") and (len(bare) > 200) == (kind == "all sorts")


@pytest.mark.parametrize("kind", ["folded", "bare"])
def test_faces_that_are_folded_or_have_no_area_are_looked_at_where_all_others_are_flat(kind):
    surface = quads(kind, np.float64)
    witness = PlanarityAccumulator(surface, 1e-6)
    a, b, c, d = (surface.points[surface.quads[:, k]] for k in range(4))
    normals = np.cross(b - a, c - a), np.cross(c - a, d - a)
    lengths, folded = np.linalg.norm(normals, axis=2), np.flatnonzero((normals[0] * normals[1]).sum(axis=1) <= 0.0)
    assert len(folded) == (360 if kind == "folded" else 0) and (lengths.sum(axis=0).min() < 1e-8) == (kind == "bare")
    witness.add_quads(0, lengths, ((b - a) * np.cross(c - a, d - b)).sum(axis=1), folded, np.empty((2, len(a))))
    assert len(witness.quads[0].undecided) < 500
    found, (bent, spread, bare) = witness.planarity(), one_by_one(surface, 1e-6)
    assert (found.non_planar_count, found.degenerate_faces.tolist()) == (bent, bare)
    assert close(found.volume_spread, spread, rel=1e-9)
    assert (bent == 360, len(bare)) == ((True, 0) if kind == "folded" else (False, 106))


@pytest.mark.parametrize("error", [0.0, 1e-7, 1e-5])
@pytest.mark.parametrize("start", [0, 4096])
def test_only_what_lies_between_the_bounds_of_the_limit_is_looked_at(error, start):
    """A quad's normal is between 0.7 of its triangles' together and all of that, and the size of each between the least
    and the largest one."""
    sides = np.array([[0.01, 0.03], [3.0, 1.0], [0.0, 25.0], [1.0, 0.5]])
    sums = sides.sum(axis=1)
    low = 0.7 * sums * (8.0 * error + PLANAR_RTOL * np.sqrt(0.7 * sums.min()))
    high = sums * (8.0 * error + PLANAR_RTOL * np.sqrt(sums.max()))
    volumes = np.stack([0.999 * low, 1.001 * low, 0.999 * high, 1.001 * high], axis=1) * [1.0, -1.0, 1.0, -1.0]
    witness = PlanarityAccumulator(quads("flat", np.float64), error)
    lengths = np.repeat(sides.T, 4, axis=1)
    witness.add_quads(start, lengths, volumes.ravel().copy(), np.arange(0), np.empty((2, 16)))
    found = witness.quads[start]
    assert (found.count, found.non_planar_count) == (16, 4)
    assert found.undecided.tolist() == [start + 4 * face + k for face in range(4) for k in (1, 2)]
    assert close(found.volume_spread, np.abs(volumes[:, 3]).sum(), rel=1e-14)


@pytest.mark.parametrize("size", [1.0, 2.0**-30, 2.0**30])
@pytest.mark.parametrize(
    "dtype, height, is_bent",
    [(np.float64, 2.7, False), (np.float64, 3.0, True), (np.float32, 3.2, False), (np.float32, 4.8, True)],
)
def test_a_quad_is_bent_from_a_millionth_of_its_size_and_eight_times_what_storing_moves_it_by_on(
    size, dtype, height, is_bent
):
    """Of a unit square with one corner raised the diagonals span 2, so that it is flat up to 2 √2 millionths, and as
    float32 up to 8 √3 / 2^24 · 2 more, half a step of the coordinates by axis."""
    points = np.array(CORNERS, float)
    points[(points == 1.0).all(axis=1), 2] += 1e-6 * height
    surface = mesh(size * points, SIDES.tolist(), dtype)
    error = float(np.linalg.norm(surface.coordinate_error))
    stack = stack_planarity(
        SurfaceStack.of([mesh(CORNERS, SIDES.tolist(), np.float32), mesh(size * points, SIDES.tolist(), np.float32)])
    )
    found = PlanarityAccumulator(surface, error).planarity()
    assert found.non_planar_count == is_bent and (found.volume_spread > 0.0) == is_bent
    if dtype is np.float32:
        assert stack.non_planar_counts.tolist() == [0, int(is_bent)]
        assert stack.volume_spread.tolist() == [0.0, found.volume_spread]


def test_a_sliver_of_a_quad_has_an_area_where_its_halves_have_none():
    """Each half is less high than storing may have moved it, both together are higher: in a stack as by itself."""
    points = np.concatenate([CORNERS, [[0.0, 0.0, 0.0], [0.5, -7e-8, 0.0], [1.0, 0.0, 0.0], [0.5, 7e-8, 0.0]]])
    sliver = mesh(points, [*SIDES.tolist(), [8, 9, 10, 11], [0, 1, 2]], np.float32)
    error = float(np.linalg.norm(sliver.coordinate_error))
    assert 7e-8 < error < 1.4e-7
    found = PlanarityAccumulator(sliver, error).planarity()
    stack = stack_planarity(SurfaceStack.of([sliver, mesh(CORNERS, SIDES.tolist(), np.float32)]))
    assert not len(found.degenerate_faces) and not stack.has_degenerate.any()
    flat = replace(sliver, points=sliver.points * np.array([1.0, 0.0, 1.0], np.float32))
    assert stack_planarity(SurfaceStack.of([sliver, flat])).has_degenerate.tolist() == [False, True]


@pytest.mark.parametrize("scale", [2.0**-10, 2.0**5])
def test_what_the_sums_show_of_large_and_small_faces_is_what_looking_at_each_gives(scale):
    surface = quads("all sorts", np.float64)
    surface = replace(surface, points=surface.points * scale)
    *found, error = told(surface, True)
    bent, spread, bare = one_by_one(surface, error)
    assert (found[0], found[2]) == (bent, bare) and close(found[1], spread, rel=1e-11)


@pytest.mark.parametrize("order", ["pairs", "halves", "loose"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_triangles_without_area_are_found_wherever_they_stand(order, dtype):
    surface = quads("all sorts", dtype)
    halves = surface.quads[:, [0, 1, 2]], surface.quads[:, [0, 2, 3]]
    triangles = np.stack(halves, axis=1).reshape(-1, 3) if order == "pairs" else np.concatenate(halves)
    if order == "loose":
        triangles = triangles[np.random.default_rng(0).permutation(len(triangles))]
    surface = Surface(surface.points, triangles)
    for seen in (False, True):
        *found, error = told(surface, seen)
        bent, spread, bare = one_by_one(surface, error)
        assert found == [0, 0.0, bare] and len(bare) > 300


def test_in_a_large_mesh_a_face_without_area_has_its_own_number_and_polygons_their_spread():
    points, faces = ring(60, 30)
    faces = faces.tolist()
    points = np.concatenate([points, [points[faces[700][1]], points[faces[700][2]]]])
    a, b, c, d = faces[700]
    faces[700:701] = [[a, b, c], [a, c, d]]
    e, f, g, h = faces[-1]
    faces[-1:] = [[e, f, g, h, len(points)]]
    points = np.concatenate([points, [(points[h] + points[e]) / 2.0]])
    surface = mesh(points, faces)
    error = 0.0
    plain = PlanarityAccumulator(surface, error).planarity()
    found = measure_solid(surface).health
    assert (found.non_planar_faces, found.defective_elements.degenerate_faces.tolist()) == (plain.non_planar_count, [])
    assert close(found.volume_spread, plain.volume_spread, rel=1e-13)
    flat = points.copy()
    flat[d] = points[a]
    assert measure_solid(replace(surface, points=flat)).health.defective_elements.degenerate_faces.tolist() == [701]


@pytest.mark.parametrize("row", range(6))
def test_a_quad_given_as_two_triangles_of_one_face_has_its_spread_as_well(row):
    points = CORNERS + [[0.0, 0.0, 0.25 * (k == 7)] for k in range(8)]
    surface = mesh(points, SIDES.tolist())
    corners, face = surface.quads[row], surface.quad_faces[row]
    given = replace(
        surface,
        quads=np.delete(surface.quads, row, axis=0),
        quad_faces=np.delete(surface.quad_faces, row),
        triangles=np.concatenate([surface.triangles, corners[[[0, 1, 2], [0, 2, 3]]]]),
        triangle_faces=np.concatenate([surface.triangle_faces, [face, face]]),
    )
    for each in (surface, given):
        found = PlanarityAccumulator(each, 0.0).planarity()
        assert found.non_planar_count == 1 and close(found.volume_spread, 0.25 / 6.0, rel=1e-14)


@pytest.mark.parametrize("gap", [None, 0, 4, 9])
@pytest.mark.parametrize("first", ["bent", "tetrahedron"])
def test_polygons_among_other_faces_have_their_spread_where_their_corners_are_known(first, gap):
    """A pentagon with a raised corner, beside quads and triangles; numbers of faces may be missing."""
    floor = [[0, 0, 0], [2, 0, 0], [3, 1, 0], [1, 2, 0], [0, 1, 0]]
    roof = [[x, y, 1.0 + 0.25 * (number == 3)] for number, (x, y, _) in enumerate(floor)]
    sides = [[k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k] for k in range(5)]
    bent = np.array([*floor, *roof]), [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *sides]
    tetrahedron = 5.0 + np.eye(4, 3, -1), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    parts = (bent, tetrahedron) if first == "bent" else (tetrahedron, bent)
    faces = [*parts[0][1], *([corner + len(parts[0][0]) for corner in face] for face in parts[1][1])]
    surface = mesh(np.concatenate([parts[0][0], parts[1][0]]), faces)
    if gap is not None:
        numbers = {name: getattr(surface, name) for name in ("triangle_faces", "quad_faces")}
        surface = replace(surface, **{name: number + (number >= gap) for name, number in numbers.items()})
    found = PlanarityAccumulator(surface, 0.0).planarity()
    assert found.non_planar_count == 1 and not len(found.degenerate_faces)
    # over the triangles 0, 1, 2 and 0, 1, 4, which have an area of 1
    assert close(found.volume_spread, 2.0 * 0.25 / 3.0, rel=1e-14)
    for corners in (None, surface.corner_vertices[:-1]):
        unknown = PlanarityAccumulator(replace(surface, corner_vertices=corners), 0.0).planarity()
        assert (unknown.non_planar_count, unknown.volume_spread) == (0, 0.0)


@pytest.mark.parametrize("scale", [2.0**-120, 2.0**120])
def test_sizes_beyond_the_range_of_the_sums_do_not_matter(scale):
    surface = quads("some", np.float64)
    plain, scaled = (PlanarityAccumulator(replace(surface, points=surface.points * s), 0.0) for s in (1.0, scale))
    for witness in (plain, scaled):
        polyhedron_moments(witness.surface, area_order=0, planarity=witness)
    plain, scaled = plain.planarity(), scaled.planarity()
    assert scaled.non_planar_count == plain.non_planar_count > 200
    assert close(scaled.volume_spread, plain.volume_spread * scale**3, rel=1e-12)
