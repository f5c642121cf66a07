# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat faces with curved boundaries: their moments, and the bodies that they bound with patches."""

import numpy as np
import pytest
from body_moments.core.moments.raw import monomials
from body_moments.core.numerics.bspline import clamped_space
from body_moments.core.nurbs import Curve, FlatFace, Patch, measure_patches, planar_region
from body_moments.core.nurbs.patch_moments import area_moments, sheet_moments, volume_moments
from body_moments.core.verdict import MeasureError

from tests.close import close
from tests.core.polygons import arcs, polygon

Z = np.array([0.0, 0.0, 1.0])
TURN = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [-0.3, 1.0, 2.0], [1.0, -1.0, 0.7]]))[0]
TURN *= np.sign(np.linalg.det(TURN))


def wall(low, high, inward=False):
    """Patches between curves at two heights."""
    made = []
    for below, above in zip(low, high):
        weights = (
            None if below.weights is None else np.stack([below.weights, above.weights], axis=1)
        )
        patch = Patch(
            (below.space, clamped_space(2)), np.stack([below.points, above.points], axis=1), weights
        )
        made.append(patch.reverse_orientation() if inward else patch)
    return made


def pipe(outer=2.0, inner=1.0, height=3.0):
    ends = [
        FlatFace.within([arcs(outer, z), arcs(inner, z)], (0.0, 0.0, way))
        for z, way in ((0.0, -1), (height, 1))
    ]
    walls = (
        wall(arcs(outer), arcs(outer, height)),
        wall(arcs(inner), arcs(inner, height), inward=True),
    )
    return [*walls[0], *walls[1], *ends]


@pytest.mark.parametrize("about", [(0.0, 0.0, 0.0), (3.0, -1.0, 2.0)])
def test_moments_of_a_ring(about):
    face = FlatFace.within([arcs(1.0), arcs(2.0)], Z)
    found = area_moments([face], 3, np.array(about))[0].about_point(np.zeros(3))
    truth = dict.fromkeys(map(tuple, monomials(3).tolist()), 0.0)
    truth |= {(0, 0, 0): 3.0 * np.pi, (2, 0, 0): 15.0 * np.pi / 4.0, (0, 2, 0): 15.0 * np.pi / 4.0}
    assert (np.abs(found.raw - list(truth.values())) <= found.rounding_error).all()
    assert found.rounding_error.max() <= 1e-9
    assert volume_moments([face], 0, np.array([0.0, 0.0, -6.0]))[0].total == pytest.approx(
        6.0 * np.pi, rel=1e-14
    )


def test_loop_off_its_plane_by_rounding_bounds_a_face():
    shift = np.eye(4)
    shift[2, 3] = 1e-3
    first, *rest = arcs(2.0)
    loop = [first.transform(shift), *rest]
    with pytest.raises(MeasureError):
        FlatFace.within([loop], Z)
    face = FlatFace.within([loop], Z, 1e-3)
    area = face.area_moments(0, face.center).total
    assert area == pytest.approx(4.0 * np.pi, abs=4.0 * np.pi * 1e-3)


def test_a_pipe_turned_and_far_away():
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = TURN, (1e3, -2e3, 3e3)
    for faces in (
        pipe(),
        [face.transform(matrix) for face in pipe()],
        [face.reverse_orientation() for face in pipe()],
    ):
        body = measure_patches(faces, area_order=3)
        assert (
            body.method in ("exact", "reoriented")
            and body.health.closed
            and body.health.components == 1
        )
        assert close(body.volume.total, 9.0 * np.pi, 1e-12) and close(
            body.area.total, 24.0 * np.pi, 1e-12
        )
        second = np.sort(np.linalg.eigvalsh(body.volume.about_center().second()))
        assert close(second, np.array([6.75, 11.25, 11.25]) * np.pi, 1e-11)
    assert [str(found) for found in body.findings][1:] == []


def test_side_along_two_others_is_cut():
    upper, lower = arcs(1.0, 2.0, count=4)[:2], arcs(1.0, 2.0, count=4)[2:]
    line = Curve(clamped_space(2), np.array([lower[-1].points[-1], upper[-1].points[-1]]))
    halves = [
        FlatFace.within([[*upper, line.reverse()], [*lower, line]][k : k + 1], Z) for k in (0, 1)
    ]
    body = measure_patches(
        [
            *wall(arcs(1.0, count=3), arcs(1.0, 2.0, count=3)),
            FlatFace.within([arcs(1.0)], -Z),
            *halves,
        ]
    )
    assert body.method == "exact" and close(body.volume.total, 2.0 * np.pi, 1e-13)


def test_slab_upon_a_face():
    face = FlatFace.within([arcs(2.0), arcs(1.0)], Z).transform(np.diag([1.0, -1.0, 1.0, 1.0]))
    sheet, converged = sheet_moments([face], -0.5, 1.0, 2, np.zeros(3))
    assert converged and close(sheet.total, 4.5 * np.pi, 1e-13)
    assert close(sheet.center[2], -0.25, 1e-13)  # a mirrored face looks down


def test_pin_in_a_hole_overlaps_nothing():
    pin = [*wall(arcs(0.9, -1.0), arcs(0.9, 5.0)), FlatFace.within([arcs(0.9, -1.0)], -Z)]
    pin.append(FlatFace.within([arcs(0.9, 5.0)], Z))
    body = measure_patches([*pipe(), *pin])
    assert body.findings == () and close(body.volume.total, (9.0 + 0.81 * 6.0) * np.pi, 1e-13)


def test_rows_of_trapezoids_fill_a_face():
    face = FlatFace.within(
        [polygon((0, 0), (4, 0), (4, 3), (2, 1), (0, 3)), polygon((1, 0.2), (2, 0.2), (1.5, 0.7))],
        Z,
    )
    a, b, c, d = np.moveaxis(face.quads(3), 1, 0)
    area = np.cross(c - a, d - b) / 2.0
    assert (area[:, 2] >= 0.0).all() and close(area.sum(axis=0)[2], 8.0 - 0.25, 1e-12)


def test_lopsided_curve_in_a_tilted_plane_bounds_a_region():
    points = np.array([(0, 0, 0), (5, 0, 0), (1, 2, 0), (0, 0, 0)], np.float64) @ TURN.T
    _, normal = planar_region([Curve(clamped_space(2, (0.25, 0.5)), points)])
    assert np.abs(np.abs(normal) - np.abs(TURN[:, 2])).max() <= 1e-14
