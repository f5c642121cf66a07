# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stages of measuring a solid and steps of its repair."""

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.closedness import check_surface, integrate_and_prove, prove_closed
from body_moments.core.solid.measure import measure_solid, repair_surface
from body_moments.core.solid.orientation import orient_components

from tests.close import close
from tests.core.bodies import (
    SIDES,
    TOP,
    box,
    grid,
    inverted,
    joined,
    mesh,
    moebius,
    moved,
    surface,
    welded,
    without,
)
from tests.core.findings import codes

CUBE = box()
OUTER, INNER = box((-2, -2, -2), (2, 2, 2)), box((-1, -1, -1), (1, 1, 1))


def staged(part, dtype=np.float64):
    """A body as the stages hand it on: checked, given, repaired, oriented."""
    checked = check_surface(surface(part, dtype))
    given = integrate_and_prove(checked, False, 1)
    body = given.proven or repair_surface(checked.surface, checked.tolerance)
    return checked, given, body, orient_components(checked, given, body, 1)


@pytest.mark.parametrize("is_open", [False, True])
def test_diagonal_along_an_edge_is_no_edge_of_a_mesh_with_edges(is_open):
    """Two tents on one floor with its diagonal as their ridge, perhaps without a wall."""
    points = np.array(
        [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1.5, 0.5, 1], [0.5, 1.5, 1]], float
    )
    faces = [[0, 3, 2, 1], [1, 2, 4], [2, 0, 4], [2, 3, 5], [3, 0, 5], [0, 2, 5], [0, 1, 4]]
    tents = mesh(points, faces[: len(faces) - is_open])
    assert {(0, 3, 2), (0, 2, 1)} <= set(map(tuple, tents.all_triangles()[0].tolist()))
    result = measure_solid(tents)
    assert result.method == ("capped" if is_open else "exact") and close(
        result.volume.total, 4.0 / 3.0, rel=1e-14
    )
    assert result.health.components == 1 and not result.health.non_manifold_edges
    assert result.health.boundary_edges == 3 * is_open


@pytest.mark.parametrize("place", [0, 3, 6])
def test_face_naming_a_vertex_twice_hides_no_crack(place):
    points = np.concatenate([CUBE[0], CUBE[0][SIDES[0]] + 1e-8])
    cube = [[8, 9, 10, 11], *SIDES[1:].tolist()]
    cube.insert(place, [0, 0, 1])
    result = measure_solid(mesh(points, cube))
    assert result.health.welded and result.method == "exact" and not result.health.boundary_edges
    assert result.health.degenerate_faces == 1 and close(result.volume.total, 1.0, rel=1e-6)


@pytest.mark.parametrize("of", ["triangles", "quads"])
def test_faces_of_one_kind_without_edges_prove_themselves_closed(of):
    """Bare arrays: their sides have to be found first."""
    faces = CUBE[1] if of == "triangles" else SIDES
    points = np.concatenate([CUBE[0], CUBE[0] + 3.0])
    for number in (1, 2):
        given = np.concatenate([faces, faces + 8])[: number * len(faces)]
        proven = prove_closed(Surface(points[: 8 * number], **{of: given}))
        assert (
            proven.number == number and proven.report.components == number and proven.report.closed
        )
        assert np.bincount(proven.component, minlength=1).tolist() == (
            [12, 12] if number == 2 else [0]
        )
    turned = np.concatenate([faces[:1, ::-1], faces[1:]])
    assert (
        prove_closed(Surface(CUBE[0], **{of: faces[1:]}))
        is prove_closed(Surface(CUBE[0], **{of: turned}))
        is None
    )
    of_polygons = {of[:-1] + "_faces": np.arange(len(faces))}
    assert prove_closed(Surface(CUBE[0], **{of: faces}, **of_polygons)) is None
    mixed = Surface(CUBE[0], CUBE[1][:2], SIDES[1:])
    assert prove_closed(mixed) is None


@pytest.mark.parametrize(
    "part, turned, against, number",
    [
        (CUBE, [False], [False], 1),
        (inverted(CUBE), [True], [True], 1),
        (joined(OUTER, inverted(INNER)), [False] * 2, [False] * 2, 2),
        (inverted(joined(OUTER, inverted(INNER))), [True, True], [True, True], 2),
    ],
)
def test_inverted_part_is_turned_to_positive_volume(part, turned, against, number):
    *_, oriented = staged(part)
    assert oriented.turned.tolist() == turned and oriented.reversed.tolist() == against
    assert (oriented.comparison is None) == (number == 1)
    parts = oriented.closed_parts()
    a, b, c = (parts.points[parts.triangles[:, k]] for k in range(3))
    volume = np.linalg.det(np.stack([a, b, c], axis=1)).sum() / 6.0
    assert close(oriented.volume.total, volume, rel=1e-14) and volume > 0.0


PLATE, STRIP = box((9, 0, 0), (10, 1, 0)), moved(moebius(), offset=(5, 0, 0))


@pytest.mark.parametrize(
    "given, included",
    [
        ([without(CUBE, *TOP), PLATE], [True, False]),
        ([PLATE, STRIP], [False, True]),
        ([STRIP, PLATE, without(CUBE, *TOP)], [True, False, True]),
        ([grid(2), moved(grid(3), offset=(5, 0, 0))], [True, True]),
    ],
)
def test_closed_parts_omit_flat_ones_unless_all_are_flat(given, included):
    *_, oriented = staged(joined(*given))
    faces = np.repeat(included, [len(part[1]) for part in given])
    parts = oriented.closed_parts()
    assert sorted(parts.face[parts.face >= 0].tolist()) == np.flatnonzero(faces).tolist()


@pytest.mark.parametrize("count", [1, 2])
def test_open_part_counts_positive_and_is_not_called_inverted(count):
    """Two boxes with one wall between them, once or twice."""
    points, triangles = welded(joined(CUBE, box((1, 0, 0), (2, 1, 1))))
    triangles = triangles[
        np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])
    ]
    walls = joined(
        *(moved((points, triangles), offset=(0.5, 3.0 * k, 7.0 * k)) for k in range(count))
    )
    totals = []
    for part in (walls, inverted(walls)):
        *_, oriented = staged(part)
        assert not oriented.turned.any()
        parts = oriented.closed_parts()
        about = np.stack(
            [parts.points[parts.triangles[:, k]] - oriented.volume.about for k in range(3)], axis=1
        )
        assert close(np.linalg.det(about).sum() / 6.0, oriented.volume.total, rel=1e-12)
        totals.append(oriented.volume.total)
        assert codes(measure_solid(surface(part))) == ["non_manifold_components"]
    assert totals[0] > 0.1 and close(totals[1], totals[0], rel=1e-12)


@pytest.mark.parametrize(
    "height, is_solid", [(1e-3, True), (1e-9, True), (1e-12, True), (2e-13, True), (1e-15, False)]
)
def test_closed_plate_is_a_solid_unless_explained_by_rounding(height, is_solid):
    *_, oriented = staged((CUBE[0] * [1.0, 1.0, height], CUBE[1]))
    assert oriented.is_solid == is_solid
    assert not is_solid or close(oriented.volume.total, height, 1e-3)
