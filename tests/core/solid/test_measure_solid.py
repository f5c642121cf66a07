# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdicts and measures of bodies with answers in closed form."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.solid.measure import measure_solid
from body_moments.core.verdict import TOO_LARGE, TOO_SMALL, Finding, MeasureError

from tests.close import close
from tests.core.bodies import (
    CORNERS,
    SIDES,
    TOP,
    box,
    grid,
    grid_torus,
    inertia,
    inverted,
    joined,
    mesh,
    moebius,
    moved,
    ring,
    rotation,
    soup,
    sphere,
    split,
    surface,
    torus,
    volume,
    welded,
    with_flipped,
    without,
)
from tests.core.exact import volume_moments
from tests.core.findings import codes, only, refused

CUBE = box()
FAR_CUBE = box((1, 1, 1), (2, 2, 2))  # no face's plane contains the origin
OUTER, INNER = box((-2, -2, -2), (2, 2, 2)), box((-1, -1, -1), (1, 1, 1))


def verdict(part, dtype=np.float64, **options):
    return measure_solid(surface(part, dtype), **options)


def check_unit_cube(result, centre, method):
    assert result.method == method
    assert close(result.volume.total, 1.0, rel=2e-15)
    np.testing.assert_allclose(result.volume.center, centre, rtol=1e-14)
    np.testing.assert_allclose(inertia(result.volume), 1.0 / 6.0, rtol=5e-15)


def marked(health):
    """Return the entries that are not zero, without the faults and the self-intersection."""
    return {
        key: value
        for key, value in health.as_record().items()
        if value and key not in ("flipped_faces", "self_intersection")
    }


@pytest.mark.parametrize(
    "part, centre, method, flipped, health, findings",
    [
        (CUBE, 0.5, "exact", [], {}, []),
        (
            inverted(CUBE),
            0.5,
            "reoriented",
            [],
            {"inverted_components": 1},
            [Finding("inverted_components", {"count": 1, "total": 1})],
        ),
        *[
            (
                with_flipped(FAR_CUBE, *flipped),
                1.5,
                "reoriented",
                flipped,
                {"inconsistent_edges": edges},
                [Finding("flipped_faces", {"count": len(flipped)}, flipped)],
            )
            for flipped, edges in (*[([face], 3) for face in range(12)], ([*range(2, 12)], 4))
        ],
    ],
)
def test_inward_faces_of_a_cube_are_named_and_turned(
    part, centre, method, flipped, health, findings
):
    result = verdict(part)
    check_unit_cube(result, [centre] * 3, method)
    assert result.health.defective_elements.flipped_faces.tolist() == flipped
    assert result.health.as_record().get("flipped_faces", []) == flipped
    assert marked(result.health) == {"closed": True, "components": 1, **health}
    assert list(result.findings) == findings
    assert [list(found.elements) for found in result.findings] == [flipped] * len(findings)


@pytest.mark.parametrize("spin", [None, 1])
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_cube_without_its_top_is_capped_flat_at_any_place(spin, dtype):
    part = moved(without(CUBE, *TOP), None if spin is None else rotation(spin), (10, 20, 30))
    result = verdict(part, dtype)
    assert result.method == "capped" and not result.health.closed
    tolerance = 1e-14 if spin is None or dtype == np.float64 else 1e-5
    assert close(result.volume.total, 1.0, rel=tolerance)
    np.testing.assert_allclose(inertia(result.volume), 1.0 / 6.0, rtol=10 * tolerance)
    assert close(result.area.total, 5.0, rel=1e-6)
    assert result.health.boundary_edges == 4
    assert close(result.health.cap_area_share, 0.2, rel=1e-5)
    finding = only(result)
    share = finding.values["share"]
    assert finding == Finding("holes_capped", {"count": 1, "flat": 1, "curved": 0, "share": share})
    assert close(share, 0.2, rel=1e-5)
    top = {tuple(sorted(edge)) for edge in ((4, 5), (5, 7), (7, 6), (6, 4))}
    assert set(map(tuple, result.health.defective_elements.boundary_edges.tolist())) == top
    assert set(map(tuple, finding.elements.tolist())) == top


@pytest.mark.parametrize("turn", [1, -1])
def test_a_doubled_triangle_counts_once(turn):
    points, triangles = FAR_CUBE
    result = verdict((points, np.concatenate([triangles, triangles[2:3, ::turn]])))
    check_unit_cube(result, [1.5] * 3, "exact")
    assert (
        result.health.duplicate_faces == 1
        and result.health.defective_elements.duplicate_faces.tolist() == [12]
    )
    assert (
        result.health.non_manifold_edges
        == 3
        == len(result.health.defective_elements.non_manifold_edges)
    )
    finding = only(result)
    assert finding == Finding(
        "duplicate_faces_ignored", {"count": 1}
    ) and finding.elements.tolist() == [12]
    assert close(result.area.total, 6.0, rel=1e-14) and close(
        result.moments(2, 2)[1].total, 6.0, rel=1e-14
    )


@pytest.mark.parametrize("turn", [1, -1])
def test_doubled_triangles_of_an_unwelded_cube_count_once(turn):
    points, triangles = soup(FAR_CUBE)
    result = verdict((points, np.concatenate([triangles, triangles[[2, 7], ::turn]])))
    check_unit_cube(result, [1.5] * 3, "exact")
    assert result.health.components == 1 and result.health.welded
    assert result.health.defective_elements.duplicate_faces.tolist() == [12, 13]


@pytest.mark.parametrize("layers", [(1, -1), (-1, 1), (1, 1, -1), (1, -1, -1, 1)])
@pytest.mark.parametrize("apart", [False, True])
def test_a_two_sided_body_is_the_body_and_does_not_cancel_itself(layers, apart):
    points, triangles = CUBE
    doubled = points, np.concatenate([triangles[:, ::way] for way in layers])
    result = verdict(soup(doubled) if apart else doubled)
    assert close(result.volume.total, 1.0, rel=1e-14) and close(result.area.total, 6.0, rel=1e-14)
    assert result.method == ("exact" if layers[0] > 0 else "reoriented")
    assert (
        result.health.duplicate_faces == 12 * (len(layers) - 1)
        and codes(result)[0] == "duplicate_faces_ignored"
    )
    assert (
        verdict((points, np.concatenate([triangles[:10], triangles[:10, ::-1]]))).method == "open"
    )


@pytest.mark.parametrize(
    "parts, volume, moment, cavities, nested, inverted_parts",
    [
        ([OUTER, inverted(INNER)], 56.0, 496.0 / 3.0, 1, 0, 0),
        ([OUTER, INNER], 72.0, 176.0, 0, 1, 0),
        ([inverted(OUTER), INNER], 56.0, 496.0 / 3.0, 1, 0, 2),
        ([inverted(OUTER), inverted(INNER)], 56.0, 496.0 / 3.0, 1, 0, 1),
        (
            [box((-4, -4, -4), (4, 4, 4)), inverted(OUTER), INNER],
            456.0,
            8.0**5 / 6.0 - 496.0 / 3.0,
            1,
            0,
            0,
        ),
    ],
)
def test_nested_boxes_count_as_given(parts, volume, moment, cavities, nested, inverted_parts):
    result = verdict(joined(*parts))
    assert close(result.volume.total, volume, rel=1e-14)
    np.testing.assert_allclose(inertia(result.volume), moment, rtol=1e-13)
    assert result.method == ("reoriented" if inverted_parts else "exact")
    counts = {
        "cavities": cavities,
        "nested_components": nested,
        "inverted_components": inverted_parts,
    }
    expected = {name: count for name, count in counts.items() if count}
    assert marked(result.health) == {"closed": True, "components": len(parts), **expected}
    found = ["cavities_subtracted"] * bool(cavities) + ["components_nested"] * bool(nested)
    assert codes(result) == ["inverted_components"] * bool(inverted_parts) + found


@pytest.mark.parametrize("spin", [None, 1, 2])
@pytest.mark.parametrize(
    "parts, volume, overlapping",
    [
        ([CUBE, box((0.5, 0, 0), (1.5, 1, 1))], 2.0, 2),
        ([CUBE, box((0.3, 0.1, 0.1), (1.1, 0.9, 0.9))], 1.512, 2),
        ([box((-3, -1, -1), (3, 1, 1)), box((-1, -3, -0.9), (1, 3, 0.9))], 45.6, 2),
        ([CUBE, CUBE], 2.0, 2),
        ([CUBE, CUBE, box((5, 5, 5), (6, 6, 6))], 3.0, 2),
        ([CUBE, box((1, 0, 0), (2, 1, 1))], 2.0, 0),
        ([CUBE, box((1, 1, 0), (2, 2, 1))], 2.0, 0),
    ],
)
def test_overlap_counts_twice_with_a_finding_but_touching_not(parts, volume, overlapping, spin):
    part = joined(*parts) if spin is None else moved(joined(*parts), rotation(spin), (7, 8, 9))
    result = verdict(part, np.float32)
    assert result.method == "exact"
    assert close(result.volume.total, volume, rel=1e-5)
    assert result.health.overlapping_components == overlapping
    if overlapping:
        finding = only(result)
        assert finding == Finding(
            "components_overlap", {"count": 2}
        ) and finding.elements.tolist() == list(range(24))
    else:
        assert not result.findings


def test_boxes_welded_along_a_face_or_an_edge_are_closed():
    wall = verdict(welded(joined(CUBE, box((1, 0, 0), (2, 1, 1)))))
    assert close(wall.volume.total, 2.0, rel=1e-14)
    assert wall.method == "exact" and not wall.findings and wall.health.closed
    assert wall.health.non_manifold_edges == 5
    edge = joined(CUBE, box((1, 1, 0), (2, 2, 1)))
    for part, method in (
        (edge, "exact"),
        (joined(CUBE, inverted(box((1, 1, 0), (2, 2, 1)))), "reoriented"),
    ):
        result = verdict(welded(part))
        assert close(result.volume.total, 2.0, rel=1e-14) and result.method == method
        assert (
            result.health.components == 2
            and result.health.non_manifold_edges == 1
            and result.health.closed
        )


@pytest.mark.parametrize(
    "others, is_left_out",
    [
        ((1, 0, 0), True),
        ((2, 0, 0), False),
        ((1, 2, 0), False),
        ((1, 1, 2), True),
        ((1, 2, 2), False),
        ((3, 2, 1), True),
        ((0, 4, 3), False),
    ],
)
@pytest.mark.parametrize("turn", range(3))
def test_copied_face_with_mostly_odd_edges_is_left_out(others, is_left_out, turn):
    """Other faces stand on its edges like the pages of a book; without any, the copy does not
    matter.
    """
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    points, faces = [*corners], [[0, 1, 2]]
    for edge, count in enumerate(np.roll(others, turn)):
        for page in range(count):
            faces.append([edge, (edge + 1) % 3, len(points)])
            points.append(corners[edge] + [0.1 * page, 0.2 * page, 1.0 + page])
    found = codes(verdict((np.array(points), np.array([*faces, faces[0]]))))
    assert ("duplicate_faces_ignored" in found, "duplicate_faces_counted" in found) == (
        is_left_out,
        not is_left_out,
    )


@pytest.mark.parametrize("numbered", [False, True])
def test_two_sided_sheet_has_no_copies_except_for_its_area(numbered):
    points, faces = CORNERS[:3], np.array([[0, 1, 2], [0, 2, 1]])
    pillow = Surface(points, faces, triangle_faces=np.arange(2) if numbered else None)
    for shell in (False, True):
        result = measure_solid(pillow, shell=shell)
        assert result.health.duplicate_faces == int(shell) and codes(result) == ["flat_surface"]
        assert result.health.defective_elements.duplicate_faces.tolist() == [1] * shell


@pytest.mark.parametrize("turn", [lambda part: part, inverted])
def test_copied_faces_are_named_without_the_walls_of_two_bodies(turn):
    """Two boxes welded along a face, perhaps one of them inverted, and a fin on an edge, twice."""
    points, triangles = welded(joined(CUBE, turn(box((1, 0, 0), (2, 1, 1)))))
    low, high = (int(np.flatnonzero((points == [0.0, 0.0, z]).all(axis=1))[0]) for z in (0.0, 1.0))
    fin = [[low, high, len(points)]]
    result = verdict(
        (np.concatenate([points, [[-1.0, -1.0, 0.5]]]), np.concatenate([triangles, fin, fin]))
    )
    (copies,) = [found for found in result.findings if found.code.startswith("duplicate_faces")]
    assert copies == Finding(
        "duplicate_faces_counted", {"count": 1}
    ) and copies.elements.tolist() == [25]


def test_an_inner_wall_makes_a_box_open():
    points, triangles = welded(joined(CUBE, box((1, 0, 0), (2, 1, 1))))
    triangles = triangles[
        np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])
    ]
    result = verdict((points, triangles))
    assert result.method == "open" and not result.health.closed
    assert result.health.non_manifold_edges == 4 and only(result) == Finding(
        "non_manifold_components", {"count": 1, "total": 1}
    )


def test_a_fin_on_an_edge_adds_nothing():
    points, triangles = FAR_CUBE
    points = np.concatenate([points, [[3.0, 0.5, 0.5]]])
    result = verdict((points, np.concatenate([triangles, [[0, 1, 8]]])))
    check_unit_cube(result, [1.5] * 3, "exact")
    assert result.health.non_manifold_edges == 1 and not result.health.closed
    assert only(result) == Finding("flat_components", {"count": 1, "total": 2})


@pytest.mark.parametrize("rung", [0, 7, 39])
def test_strip_closed_only_by_an_edge_of_another_body_is_open(rung):
    points, triangles = moebius()
    low, high = points[[rung, 40 + rung]]
    apexes = (low + high) / 2.0 + [[0.0, 0.0, 5.0], [0.5, 0.5, 5.0]]
    beside = np.array([low, high, *apexes]), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    result = verdict(welded(joined((points, triangles), beside)))
    assert result.method == "open" and result.health.components == 2
    assert Finding("non_manifold_components", {"count": 1, "total": 2}) in result.findings


def klein():
    points, quads = ring(40, 20, twist=True)
    return points, split(quads)


@pytest.mark.parametrize("part", [moebius(), klein()])
def test_a_one_sided_surface_is_open(part):
    result = verdict(part)
    assert result.method == "open" and not result.health.closed
    assert only(result) == Finding("one_sided_components", {"count": 1, "total": 1})
    beside = verdict(joined(part, box((5, 5, 5), (6, 6, 6))))
    assert beside.method == "open" and only(beside).values == {"count": 1, "total": 2}


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize(
    "part",
    [
        grid(20),
        moved(grid(20), rotation(3), (5, 6, 7)),
        joined(grid(3), moved(grid(3), None, (0, 0, 1))),
        (grid(9)[0], np.concatenate([grid(9)[1], grid(9)[1][:, ::-1]])),
        (np.zeros((3, 3)), np.array([[0, 1, 2]])),
        (CUBE[0], CUBE[1][:1]),
        (np.array([[0.0, 0, 0], [1, 0, 0]]), np.array([[0, 1, 1]])),
    ],
)
def test_flat_mesh_encloses_nothing(part, dtype):
    result = verdict(part, dtype)
    assert (
        result.method == "open"
        and not result.volume.raw.any()
        and result.health.cap_area_share == 0.0
    )
    assert codes(result)[-1] == "flat_surface" and "flat_components" not in codes(result)


@pytest.mark.parametrize("corners", [3, 4, 5, 8])
def test_two_sided_polygon_turned_in_float32_is_flat(corners):
    """Front and back are cut along different diagonals; alone, and beside a box as another
    component.
    """
    angle, turns = 2.0 * np.pi * np.arange(corners) / corners, np.arange(1, corners - 1)
    front = np.stack([0 * turns, turns, turns + 1], axis=1)
    polygon = (
        np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1),
        np.concatenate([front, (front[:, ::-1] - 1) % corners]),
    )
    for seed in range(10):
        turned = moved(polygon, rotation(seed), (1.0, 2.0, -3.0))
        assert codes(verdict(turned, np.float32))[-1:] == ["flat_surface"]
        beside = verdict(joined(FAR_CUBE, moved(turned, None, (9.0, 9.0, 9.0))), np.float32)
        assert only(beside) == Finding("flat_components", {"count": 1, "total": 2})


def test_copies_left_out_count_in_no_number():
    points, faces = CORNERS + np.eye(8)[:, 7:] * (0.1, 0.2, 0.3), SIDES.tolist()
    once, thrice = (
        measure_solid(mesh(points, [*faces, *copies])) for copies in ([], [*faces, *faces])
    )
    for one, other in (
        (once.area.total, thrice.area.total),
        (once.volume.total, thrice.volume.total),
    ):
        assert close(one, other, rel=1e-15)
    assert once.health.volume_spread == thrice.health.volume_spread > 0.01
    assert (
        once.health.non_planar_faces == thrice.health.non_planar_faces
        and thrice.health.duplicate_faces == 12
    )


@pytest.mark.parametrize("turned", [False, True])
def test_plate_flat_to_rounding_is_not_called_inverted(turned):
    for size in (1e-9, 1.0, 1e9):
        plate = size * CUBE[0] * [1.0, 1.0, 1e-15], CUBE[1]
        result = verdict(inverted(plate) if turned else plate)
        assert codes(result) == ["flat_surface"] and result.health.inverted_components == 0
        thicker = size * CUBE[0] * [1.0, 1.0, 1e-12], CUBE[1]
        assert (
            verdict(inverted(thicker) if turned else thicker).health.inverted_components == turned
        )


@pytest.mark.parametrize("spin", [None, 5])
def test_a_tube_is_capped_at_both_ends(spin):
    n = 32
    angle = np.arange(n) * 2 * np.pi / n
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    quads = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    part = moved(
        (np.concatenate([circle, circle + [0, 0, 3]]), split(quads)),
        spin and rotation(spin),
        (0, 50, 0),
    )
    result = verdict(part)
    end = n / 2 * np.sin(2 * np.pi / n)
    assert result.method == "capped"
    assert close(result.volume.total, 3 * end, rel=1e-13)
    assert close(result.health.cap_area_share, 2 * end / result.area.total, rel=1e-12)
    values = only(result).values
    assert (values["count"], values["flat"], values["curved"]) == (2, 2, 0)
    assert len(only(result).elements) == 2 * n


def test_bowl_is_closed_by_its_rim_and_curved_hole_by_a_cone():
    points, triangles = sphere(3)
    lower = np.flatnonzero(points[triangles][:, :, 2].mean(axis=1) < 0)
    result = verdict((points, triangles[lower]))
    assert result.method == "capped" and only(result).values["flat"] == 1
    assert close(result.volume.total, volume((points, triangles)) / 2.0, rel=1e-13)
    # A triangular prism's side with one corner bent out: the cone to the loop's centroid.
    bent = CORNERS.copy()
    bent[7] = [1, 1, 1.5]
    result = verdict((bent, without(CUBE, *TOP)[1]))
    rim = bent[[4, 5, 7, 6]]
    length = np.linalg.norm(np.roll(rim, -1, axis=0) - rim, axis=1)
    apex = ((rim + np.roll(rim, -1, axis=0)) / 2 * length[:, None]).sum(axis=0) / length.sum()
    cone = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]
    expected = volume(
        (np.concatenate([bent, [apex]]), np.concatenate([without(CUBE, *TOP)[1], cone]))
    )
    assert result.findings[0].values["curved"] == 1
    assert close(result.volume.total, expected, rel=1e-14)


@pytest.mark.parametrize(
    "cells", [((1, 1), (1, 2), (2, 1)), ((1, 1), (2, 2))], ids=["concave", "meeting in a vertex"]
)
def test_holes_have_their_true_share_of_the_area(cells):
    points, triangles = moved(grid(4), None, (0, 0, 1))
    holes = [2 * (4 * i + j) + k for i, j in cells for k in (0, 1)]
    result = verdict(joined(without(CUBE, *TOP), (points, np.delete(triangles, holes, axis=0))))
    check_unit_cube(result, [0.5] * 3, "capped")
    share = len(cells) / 16
    assert close(result.health.cap_area_share, share / (6 - share), rel=1e-12)


@pytest.mark.parametrize(
    "spin, dtype, rel", [(None, np.float64, 1e-14), (7, np.float64, 1e-13), (7, np.float32, 1e-6)]
)
@pytest.mark.parametrize("flip", [False, True])
def test_a_box_with_one_side_subdivided_is_closed_in_space(spin, dtype, rel, flip):
    top = moved(grid(5), None, (0, 0, 1))
    part = joined(without(CUBE, *TOP), inverted(top) if flip else top)
    result = verdict(moved(part, spin and rotation(spin), (3, 4, 5)), dtype)
    assert close(result.volume.total, 1.0, rel=rel)
    np.testing.assert_allclose(inertia(result.volume), 1.0 / 6.0, rtol=100 * rel)
    assert (
        result.health.closed and result.health.boundary_edges == 0 and result.health.components == 1
    )
    assert result.method == ("reoriented" if flip else "exact")
    assert result.findings[0] == Finding("t_junctions", {"count": 4})
    # gaps are closed between their own vertices
    assert len(result.repaired_surface.points) == len(part[0])
    assert result.health.defective_elements.flipped_faces.tolist() == (
        list(range(10, 60)) if flip else []
    )


def test_the_sides_of_a_box_may_all_be_cut_differently():
    """Each side is a grid of its own: along every edge two rows of vertices meet that have only the
    ends in common.
    """
    turns = [
        np.eye(3),
        [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
        [[1, 0, 0], [0, 0, -1], [0, 1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
    ]
    centred = [
        moved(moved(grid(n), None, (-0.5, -0.5, 0.5)), turn)
        for n, turn in zip((2, 3, 5, 7, 4, 1), turns)
    ]
    result = verdict(joined(*centred))
    assert result.method == "exact" and result.health.closed
    assert close(result.volume.total, 1.0, rel=1e-14)


@pytest.mark.parametrize("offset", [(0, 0, 0), (1000, -2000, 500)])
@pytest.mark.parametrize("scale", [1.0, 1e-3])
@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("inward", [False, True])
def test_patch_on_a_closed_body_counts_once(offset, scale, first, inward):
    """A fifth of a torus lies on it once more, with vertices of its own, a little moved."""
    part = moved(torus(20, 12), scale * rotation(3), np.multiply(offset, scale))
    points, faces = part
    patch = points + 1e-9 * scale * np.random.default_rng(1).uniform(-1, 1, points.shape)
    copied = patch, faces[: len(faces) // 5, :: -1 if inward else 1]
    result = verdict(joined(*((copied, part) if first else (part, copied))))
    assert codes(result)[:2] == ["vertices_welded", "duplicate_faces_ignored"]
    assert result.findings[1].values["count"] == len(faces) // 5
    assert result.method in ("exact", "reoriented")
    assert close(result.volume.total, volume(part), rel=1e-9)


def test_patch_beside_its_body_or_larger_is_capped():
    points, faces = part = torus(20, 12)
    apart = points * 1.01, faces[: len(faces) // 5]
    assert "holes_capped" in codes(verdict(joined(part, apart)))


def test_float32_triangle_soup_far_away_is_welded_and_closed():
    part = moved(torus(60, 30), rotation(2), (1000, -2000, 500))
    apart = soup(part)
    result = verdict(apart, np.float32)
    assert result.method == "exact" and not result.findings
    assert result.health.welded and result.health.closed and result.health.components == 1
    points = part[0].astype(np.float32)
    assert close(result.volume.total, volume((points, part[1])), rel=1e-12)


def test_nearly_equal_positions_are_welded_along_open_edges_only():
    part = soup(moved(sphere(3), None, (3, 4, 5)))
    noise = np.random.default_rng(5).uniform(-1, 1, size=part[0].shape) * 3e-7
    result = verdict((part[0] + noise, part[1]))
    assert result.method == "exact" and result.health.closed and result.health.welded
    welded = result.findings[0]
    assert (
        welded.code == "vertices_welded"
        and welded.values["slight"]
        and 0.0 < welded.values["share"] < 1e-6
    )
    assert close(result.volume.total, volume(sphere(3)), rel=1e-6)


def test_a_small_open_part_is_not_welded_away():
    small = moved(without(CUBE, *TOP), 1e-5 * np.eye(3))
    result = verdict(joined(small, box((10, 10, 10), (11, 11, 11))))
    assert result.method == "capped" and result.health.components == 2
    assert close(result.volume.total, 1.0 + 1e-15, rel=1e-14)
    small = verdict(
        joined(
            moved(without(sphere(2), 0), 1e-6 * np.eye(3)), box((10, 10, 10), (10.1, 10.1, 10.1))
        )
    )
    assert small.health.boundary_edges == 3


@pytest.mark.parametrize("share, is_welded", [(0.99e-3, True), (1.01e-3, False)])
def test_crack_of_a_small_part_is_welded_within_its_triangles(share, is_welded):
    lid = moved((CUBE[0], CUBE[1][list(TOP)]), None, (share * np.sqrt(2.0), 0, 0))
    small = moved(joined(without(CUBE, *TOP), lid), 1e-3 * np.eye(3))
    result = verdict(joined(small, box((10, 10, 10), (11, 11, 11))))
    assert result.health.welded is is_welded and result.health.boundary_edges == (
        0 if is_welded else 8
    )


@pytest.mark.parametrize("scale", [2.0**-100, 1e-9, 1e-3, 1e5, 2.0**100])
@pytest.mark.parametrize(
    "part",
    [
        without(CUBE, *TOP),
        with_flipped(FAR_CUBE, 2),
        joined(OUTER, INNER),
        joined(OUTER, inverted(INNER)),
        moebius(),
        grid(3),
        joined(without(CUBE, *TOP), moved(grid(3), None, (0, 0, 1))),
        soup(torus()),
        (
            CORNERS * [1.0, 1.0, 1.5] - [[0.0, 0.0, 0.5 * (0 < k < 7)] for k in range(8)],
            without(CUBE, *TOP)[1],
        ),
        joined(CUBE, inverted(box((0.5, 0.5, 0.25), (0.75, 0.75, 1.25)))),
        welded(joined(CUBE, inverted(box((1, 0, 0), (2, 1, 1))))),
        (
            np.concatenate([CUBE[0], [[0.5, -0.5, -0.5]]]),
            np.concatenate([CUBE[1], [[0, 1, 8], [0, 1, 8]]]),
        ),
    ],
)
def test_the_verdict_does_not_depend_on_the_size(part, scale):
    for dtype in (np.float32, np.float64):
        plain, scaled = verdict(part, dtype), verdict((part[0] * scale, part[1]), dtype)
        assert scaled.method == plain.method and codes(scaled) == codes(plain)
        assert close(scaled.volume.total, plain.volume.total * scale**3, rel=1e-6)
        assert close(scaled.health.cap_area_share, plain.health.cap_area_share, rel=1e-5)
        before, after = (
            replace(result.health, cap_area_share=0).as_record() for result in (plain, scaled)
        )
        assert before == after


@pytest.mark.parametrize(
    "points, faces, spread",
    [
        (CORNERS, SIDES.tolist(), 0.0),
        (CORNERS + np.array([[0, 0, 0.5 * (k == 7)] for k in range(8)]), SIDES.tolist(), 0.5 / 6.0),
    ],
)
def test_spread_matches_the_extremes_of_the_diagonals(points, faces, spread):
    result = measure_solid(mesh(points, faces))
    assert close(result.health.volume_spread, spread, rel=1e-14)
    assert result.health.non_planar_faces == (1 if spread else 0)
    low, high = 1 + 0.5 / 6, 1 + 0.5 / 3
    assert (
        not spread or min(abs(result.volume.total - low), abs(result.volume.total - high)) < 1e-14
    )
    assert codes(result) == ["non_planar_faces"] * bool(spread)


def prism(heights):
    n = len(heights)
    angle = np.arange(n) * 2 * np.pi / n
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.c_[circle, np.zeros(n)], np.c_[circle, heights]])
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return points, [list(range(n))[::-1], list(range(n, 2 * n)), *sides]


def test_spread_of_polygons_is_reported():
    assert measure_solid(mesh(*prism([1.0] * 6))).health.volume_spread == 0.0
    raised = measure_solid(mesh(*prism([1, 1, 1, 1.3, 1, 1])))
    assert raised.health.non_planar_faces == 1
    # The raised corner is in two of the tetrahedra between the fans, over the triangles 0, 1, 2 and
    # 0, 1, 4.
    assert close(
        raised.health.volume_spread, 0.3 * (np.sqrt(3) / 4 + np.sqrt(3) / 2) / 3, rel=1e-14
    )
    points, faces = prism([1, 1, 1, 1.3, 1, 1])
    beside = mesh(
        np.concatenate([[[9.0, 9.0, 9.0]], points]),
        [[corner + 1 for corner in face] for face in faces],
    )
    # a vertex of no face is left out
    assert measure_solid(beside).health.as_record() == raised.health.as_record()
    far = mesh(moved(CUBE, rotation(1), (300, 200, 100))[0], SIDES.tolist(), np.float32)
    assert measure_solid(far).health.non_planar_faces == 0  # bending by float32 does not count


def test_loose_vertices_and_edges_change_nothing():
    points, quads = ring(12, 8)
    plain = mesh(points, quads.tolist())
    result = measure_solid(plain)
    loose = replace(
        plain,
        points=np.concatenate([[[1e6, np.nan, np.inf]], points, [[-1e5, 0, 0]]]),
        quads=plain.quads + 1,
        corner_vertices=plain.corner_vertices + 1,
        corner_edges=plain.corner_edges + 1,
    )
    other = measure_solid(loose)
    assert (np.abs(other.volume.raw - result.volume.raw) <= result.volume.rounding_error).all()
    assert other.health.as_record() == result.health.as_record() and not other.findings
    hole = replace(loose, quads=loose.quads[1:], quad_faces=None, corner_edges=None)
    rim = measure_solid(hole).health.defective_elements.boundary_edges
    assert {tuple(edge) for edge in rim.tolist()} == {
        tuple(sorted(edge))
        for edge in zip(loose.quads[0].tolist(), np.roll(loose.quads[0], -1).tolist())
    }


@pytest.mark.parametrize(
    "part", [CUBE, without(CUBE, *TOP), with_flipped(CUBE, 2), joined(OUTER, INNER), soup(torus())]
)
def test_the_surface_is_only_read(part):
    for order in "CF":
        given = Surface(np.array(part[0], np.float32, order=order), np.array(part[1], order=order))
        points, triangles = given.points.copy(), given.triangles.copy()
        measure_solid(given, threads=2)
        np.testing.assert_array_equal(given.points, points)
        np.testing.assert_array_equal(given.triangles, triangles)


def test_unmeasurable_mesh_is_refused_with_a_remedy():
    with refused("no_faces"):
        measure_solid(Surface(np.zeros((3, 3))))
    for bad in (np.nan, np.inf):
        points = CORNERS.copy()
        points[5, 1] = bad
        with pytest.raises(MeasureError) as caught:
            verdict((points, CUBE[1]))
        finding = caught.value.finding
        assert finding == Finding(
            "non_finite_vertices", {"count": 1, "total": 8}
        ) and finding.elements.tolist() == [5]
    with refused("invalid_faces"):
        verdict((CORNERS[:7], CUBE[1]))
    points[:, 1] = np.inf  # so that their box has no extent
    with refused("non_finite_vertices"):
        verdict((points, CUBE[1]))
    for points in (CORNERS * 1e60, (2.0 * CORNERS - 1.0) * 1e308):
        with refused("object_size", fault=TOO_LARGE):
            verdict((points, CUBE[1]))


def test_shell_has_area_moments_to_third_order_without_caps():
    result = verdict(without(CUBE, *TOP), shell=True)
    assert result.area.order == 3 and result.area.measure == "area"
    np.testing.assert_allclose(result.area.center, [0.5, 0.5, 0.4], rtol=1e-14)
    assert verdict(CUBE).area.order == 0


BREAKAGES = [
    "holes",
    "flips",
    "copies",
    "turned copies",
    "no area",
    "loose",
    "fin",
    "soup",
    "random faces",
    "part",
    "inverted",
]


def broken(seed):
    """A convex body, broken in a few ways: (points, triangles), its true volume, and what was
    done.
    """
    rng = np.random.default_rng(seed)
    points, triangles = sphere(int(rng.integers(0, 4))) if rng.random() < 0.7 else CUBE
    points = (points * rng.uniform(0.3, 2, 3)) @ rotation(seed).T * 10.0 ** rng.integers(-6, 6)
    size = np.linalg.norm(np.ptp(points, axis=0))
    points = points + rng.normal(size=3) * 10 ** rng.uniform(-2, 2) * size
    points = points.astype(np.float32 if rng.random() < 0.7 else np.float64)
    whole, true = (points, triangles), volume((points, triangles))
    done = set(rng.choice(BREAKAGES, size=rng.integers(1, 4), replace=False).tolist())
    count = len(triangles)
    if "holes" in done:
        triangles = np.delete(
            triangles, rng.integers(0, count, size=rng.integers(1, count // 20 + 2)), axis=0
        )
    if "flips" in done:
        triangles = with_flipped(
            (points, triangles), *rng.integers(0, len(triangles), size=count // 6 + 1)
        )[1]
    for name, turn in (("copies", 1), ("turned copies", -1)):
        if name in done:
            again = triangles[rng.integers(0, len(triangles), size=rng.integers(1, 4))]
            triangles = np.concatenate([triangles, again[:, ::turn]])
    if "no area" in done:
        ends = rng.integers(0, len(points), size=(3, 2))
        triangles = np.concatenate([triangles, ends[:, [0, 1, 0]]])
    if "fin" in done:
        points = np.concatenate(
            [points, 2 * points[triangles[:1, 0]] - points.mean(axis=0)]
        ).astype(points.dtype)
        triangles = np.concatenate([triangles, [[*triangles[0, :2], len(points) - 1]]])
    if "loose" in done:
        points = np.concatenate([points, points[:1] + np.array([[1e3 * size, 0, 0]], points.dtype)])
    if "soup" in done:
        points, triangles = soup((points, triangles))
    if "random faces" in done:
        triangles = np.concatenate(
            [triangles, rng.integers(0, len(points), size=(rng.integers(1, 10), 3))]
        )
    if "part" in done:
        other = (whole[0] + np.array([3 * size, 0, 0], points.dtype)).astype(points.dtype), whole[1]
        points, triangles = joined((points, triangles), other)
        true += volume(other)
    if "inverted" in done:
        triangles = triangles[:, ::-1]
    return (points, triangles[rng.permutation(len(triangles))]), true, done


@pytest.mark.parametrize("block", range(20))
def test_broken_meshes_give_no_unlabeled_wrong_volume(block):
    for seed in range(50 * block, 50 * block + 50):
        (points, triangles), true, done = broken(seed)
        result = measure_solid(Surface(points, triangles))
        assert (
            np.isfinite(result.volume.raw).all() and np.isfinite(result.volume.rounding_error).all()
        ), seed
        assert result.volume.total >= 0.0, seed
        json.dumps(result.health.as_record(), allow_nan=False)
        # Closing rounding gaps may move a vertex by a millionth of the size.
        allowed = 1e-5 * true + result.volume.input_error[0] + result.volume.rounding_error[0]
        wrong = abs(result.volume.total - true) > allowed
        if result.method == "exact" and not result.findings:
            assert not wrong, (seed, done)
        if not done & {"holes", "random faces"} and result.method != "open":
            assert not wrong, (seed, done)
        if not done & {"holes", "random faces", "fin"}:
            assert result.method in ("exact", "reoriented"), (seed, done)
        if done == {"holes"} and len(triangles) > 400:
            assert result.method == "capped" and abs(result.volume.total - true) < 0.1 * true, seed


@pytest.mark.parametrize("block", range(4))
def test_arbitrary_faces_over_arbitrary_points_are_survived(block):
    for seed in range(50 * block, 50 * block + 50):
        rng = np.random.default_rng(seed)
        n, m = int(rng.integers(3, 60)), int(rng.integers(1, 200))
        points = (
            rng.normal(size=(n, 3)) if seed % 2 else rng.integers(0, 4, size=(n, 3)).astype(float)
        )
        points[:, 2] *= rng.random() < 0.7
        points = (points * 10.0 ** rng.integers(-30, 30)).astype(
            np.float32 if seed % 3 else np.float64
        )
        quads = rng.integers(0, n, size=(int(rng.integers(0, 40)), 4))
        result = measure_solid(
            Surface(
                points,
                rng.integers(0, n, size=(m, 3)),
                quads,
                triangle_faces=np.arange(m),
                quad_faces=np.arange(m, m + len(quads)),
            )
        )
        assert np.isfinite(result.volume.raw).all() and result.volume.total >= 0.0, seed
        assert result.method == "open" or result.findings, seed


@pytest.mark.parametrize("exponent", [-200, -100, 133, 160])
def test_a_body_of_any_size_is_as_possible_as_another(exponent):
    points, quads = grid_torus(8, 6)
    points[points[:, 0] > 0.0] *= 1.5  # so that its center is not that of its box
    one, other = (measure_solid(Surface(np.ldexp(points, k), quads=quads)) for k in (0, exponent))
    assert one.method == other.method == "exact"
    assert close(other.volume.total, np.ldexp(one.volume.total, 3 * exponent), rel=1e-14)


def test_vanishing_and_overflowing_moments_are_refused_alike():
    for scale, fault in ((1e-61, TOO_SMALL), (1e51, TOO_LARGE)):
        with refused("object_size", fault=fault):
            verdict((CUBE[0] * scale, CUBE[1]))


@pytest.mark.parametrize("seed", range(5))
def test_change_by_welding_is_bounded(seed):
    """The target of welding depends on the order of the vertices only."""
    rng = np.random.default_rng(seed)
    points, triangles = soup(moved(sphere(2), rotation(seed), (1, 2, 3)))
    points = points + rng.uniform(-3e-7, 3e-7, points.shape)
    order = rng.permutation(len(points))
    one, other = (
        verdict((points, triangles)),
        verdict((points[order], np.argsort(order)[triangles])),
    )
    assert one.method == other.method == "exact"
    assert (
        1e-12
        < abs(one.volume.total - other.volume.total)
        < one.volume.input_error[0]
        < 1e-4 * one.volume.total
    )
    assert verdict(soup(sphere(2))).volume.input_error[0] == 0.0


@pytest.mark.parametrize("faces", [(4, 5), (4, 5, 6, 7), (4,)])
@pytest.mark.parametrize(
    "dtype, thick", [(np.float64, 1e-7), (np.float64, 5e-6), (np.float32, 1e-6), (np.float32, 5e-6)]
)
def test_an_open_foil_is_not_welded_into_a_wedge(thick, faces, dtype):
    result = verdict(without(box((0, 0, 0), (1, 1, thick)), *faces), dtype)
    assert close(result.volume.total, thick, rel=1e-6) and result.method in ("capped", "exact")
    assert result.volume.input_error[0] < 1e-6 and result.health.components == 1


def test_tiny_body_beside_a_large_sheet_does_not_self_intersect():
    """Its center is not known there, and its second moments may come out negative."""
    sheet = grid(2)[0] * [1e8, 1e8, 1.0], grid(2)[1]
    for seed in range(10):
        part = moved(CUBE, 0.3 * rotation(seed), (3e7, 1e7, 0.4))
        assert "self_intersecting" not in codes(verdict(joined(part, sheet)))


@pytest.mark.parametrize("kind", [">i4", ">i8", "<u2", ">u2", "i1"])
def test_indices_in_any_byte_order_name_their_points(kind):
    body = measure_solid(Surface.from_triangles(CUBE[0].astype(">f4"), CUBE[1].astype(kind)))
    assert body.method == "exact" and body.volume.total == 1.0
    with pytest.raises(ValueError, match="no such point"):
        Surface.from_triangles(CUBE[0], CUBE[1].astype(kind) + np.array(1, kind))


def test_complex_coordinates_are_refused():
    with pytest.raises(ValueError, match="points must be .* real numbers, not .* complex128"):
        Surface.from_triangles(CUBE[0].astype(complex), CUBE[1])


# runs past its fourth point and back
OUTLINE = np.array([[-2, 0], [0, -1], [0, 1], [0, 0], [2, 0], [1, 3]], float)
REGION = np.array([[0, 1, 3], [3, 2, 0], [2, 3, 4], [4, 5, 2], [0, 2, 5]])


def letter(outline, height=0.5):
    """An extruded outline as Blender makes it of a glyph: walls along the outline, caps over the
    region.
    """
    count = len(outline)
    points = np.concatenate(
        [np.c_[outline, np.zeros(count)], np.c_[outline, np.full(count, height)]]
    )
    i = np.arange(count)
    j = (i + 1) % count
    walls = np.concatenate(
        [np.stack([i, j, j + count], axis=1), np.stack([i, j + count, i + count], axis=1)]
    )
    return points, np.concatenate([REGION[:, ::-1], REGION + count, walls])


@pytest.mark.parametrize("apart", [False, True])
def test_outline_turning_back_on_itself_closes(apart):
    part = letter(OUTLINE)
    if apart:  # walls with vertices of their own, welded at the same places
        points, triangles = part
        part = (
            np.concatenate([points, points]),
            np.concatenate([triangles[:10], triangles[10:] + len(points)]),
        )
    for offset in (0.0, 4096.0):
        order = np.random.default_rng(int(offset)).permutation(len(part[0]))
        part = part[0][order], np.argsort(order)[part[1]]
        result = measure_solid(surface(moved(part, offset=(offset, offset, 0.0))))
        assert (
            result.method == "exact" and result.health.closed and result.health.boundary_edges == 0
        )
        assert result.health.non_manifold_edges == 2
        assert only(result) == Finding("t_junctions", {"count": 2})
        exact = volume_moments(
            result.repaired_surface.points, result.repaired_surface.triangles, result.volume.about
        )
        assert abs(result.volume.total - 3.5) <= result.volume.rounding_error[0] and exact[
            0
        ] == Fraction(7, 2)
    wide = OUTLINE.copy()
    wide[1, 0] = 0.5  # the remaining faces have an area
    assert measure_solid(surface(letter(wide))).method == "open"
    beside = joined(letter(OUTLINE), moved(letter(wide), offset=(9, 0, 0)))
    result = measure_solid(surface(beside))
    assert (
        result.method == "open"
        and Finding("non_manifold_components", {"count": 1, "total": 2}) in result.findings
    )


def bent(height):
    """A cube with one corner moved."""
    return measure_solid(
        mesh(CORNERS + np.array([[0, 0, height * (k == 7)] for k in range(8)]), SIDES.tolist())
    )


@pytest.mark.parametrize("count, total", [(7, 0.25), (8, 0.0), (9, 0.25)])
def test_more_cavities_than_material_make_no_body(count, total):
    """A box of volume 2 less so many times the same cavity of a quarter."""
    holes = [inverted(box((0.5, 0.25, 0.25), (1.5, 0.75, 0.75)))] * count
    result = verdict(joined(box((0, 0, 0), (2, 1, 1)), *holes))
    assert result.method == ("open" if count > 8 else "exact") and result.volume.total == total
    assert codes(result) == ["cavities_subtracted", "components_overlap"] + [
        "self_intersecting"
    ] * (count > 8)
