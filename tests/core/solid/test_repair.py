# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages of measuring a solid, each on what the one before hands on, and the steps of a repair."""

import pickle
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
from body_moments.core.mesh.surface import Surface
from body_moments.core.moments.moments import Moments
from body_moments.core.nurbs.solid import PatchIntegrals
from body_moments.core.solid.closedness import check_surface, integrate_and_prove, prove_closed
from body_moments.core.solid.measure import measure_solid
from body_moments.core.solid.orientation import orient_components
from body_moments.core.solid.repair import STEPS, repair_surface
from body_moments.core.solid.self_intersection import SelfIntersection
from body_moments.core.solid.solid_verdict import SolidIntegrals, judge
from body_moments.core.solid.weld_open_parts import split_into_triangles
from body_moments.core.verdict.health import Intersection
from body_moments.core.verdict.method import Verdict

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
    soup,
    surface,
    torus,
    welded,
    with_flipped,
    without,
)
from tests.core.findings import codes

CUBE = box()
OUTER, INNER = box((-2, -2, -2), (2, 2, 2)), box((-1, -1, -1), (1, 1, 1))


def cracked():
    """A cube whose top has vertices of its own, off by rounding."""
    top = CUBE[0], CUBE[1][list(TOP)]
    return joined(without(CUBE, *TOP), moved(top, offset=(1e-8, -1e-8, 1e-8)))


def doubled():
    points, triangles = CUBE
    return points, np.concatenate([triangles, triangles[3:4]])


BROKEN = {
    "closed": CUBE,
    "soup": soup(torus()),
    "cracked": cracked(),
    "holes": joined(without(CUBE, *TOP), moved(without(CUBE, 0), offset=(5, 0, 0))),
    "flipped": with_flipped(CUBE, 2),
    "doubled": doubled(),
    "nested": joined(OUTER, INNER),
    "inverted": inverted(CUBE),
    "one-sided": moebius(),
    "collapsed": (CUBE[0], np.concatenate([CUBE[1], [[0, 0, 1]]])),
    "nothing": (CUBE[0][:3], np.array([[0, 0, 1], [1, 2, 2]])),
}


def arrays(value, place=""):
    """Every array that plain data holds, with its place."""
    if isinstance(value, np.ndarray):
        yield place, value
    elif is_dataclass(value):
        for field in fields(value):
            yield from arrays(getattr(value, field.name), place + "." + field.name)
    elif isinstance(value, tuple):
        for number, item in enumerate(value):
            yield from arrays(item, "{}[{}]".format(place, number))


def staged(part, dtype=np.float64):
    """A body as the stages hand it on: checked, given, repaired, oriented."""
    checked = check_surface(surface(part, dtype))
    given = integrate_and_prove(checked, False, 1)
    body = given.proven or repair_surface(checked.surface, checked.tolerance)
    return checked, given, body, orient_components(checked, given, body, 1)


@pytest.mark.parametrize("name", BROKEN)
def test_no_step_changes_the_mesh_it_is_given_and_each_keeps_what_was_found_before(name):
    checked = check_surface(surface(BROKEN[name]))
    body = split_into_triangles(checked.surface)
    for step in STEPS:
        if not len(body.triangles):
            break
        before = {place: (array.copy(), array) for place, array in arrays(body)}
        findings, report = list(body.findings), body.report.as_record()
        for _, array in before.values():
            array.flags.writeable = False
        result = step(body, checked.tolerance)
        assert all(np.array_equal(kept, now) for kept, now in before.values())
        assert list(result.findings[: len(findings)]) == findings == list(body.findings)
        assert body.report.as_record() == report
        assert len(result.triangles) == len(result.face) == len(result.flipped) == len(result.component)
        body = result
    whole = repair_surface(checked.surface, checked.tolerance)
    assert whole.state is None and whole.findings == body.findings
    assert whole.report.as_record() == body.report.as_record()
    np.testing.assert_array_equal(whole.triangles, body.triangles)


def after(part, last, skip=()):
    """The mesh after the named step."""
    checked = check_surface(surface(part))
    body = split_into_triangles(checked.surface)
    for step in STEPS:
        if step.__name__ not in skip:
            body = step(body, checked.tolerance)
        if step.__name__ == last:
            return body
    raise AssertionError(last)


def test_welding_takes_equal_positions_first_and_near_ones_only_along_what_is_still_open():
    body = after(soup(CUBE), "weld_equal_positions")
    assert body.state.open_parts is None and len(np.unique(body.triangles)) == 8
    assert body.report.welded and body.max_displacement == 0.0 and not body.topology_changed
    body = after(cracked(), "weld_equal_positions")
    assert not body.report.welded and len(body.state.open_parts.vertices) == 8
    body = after(cracked(), "weld_near_positions")
    assert body.report.welded and body.topology_changed and len(np.unique(body.triangles)) == 8
    assert close(body.max_displacement, 3**0.5 * 1e-8, rel=1e-6)
    checked = check_surface(surface(CUBE))
    closed = split_into_triangles(checked.surface)
    assert STEPS[0](closed, 1.0) is closed and STEPS[1](closed, 1.0) is closed


def test_where_nothing_but_edges_is_left_nothing_is_closed():
    result = measure_solid(surface(BROKEN["nothing"]))
    assert not result.health.closed and result.health.components == 0 and not result.health.welded
    assert codes(result) == ["flat_surface"] and not result.oriented.mesh.open.any()


def test_without_welding_near_positions_a_crack_is_two_holes():
    checked = check_surface(surface(cracked()))
    body = repair_surface(checked.surface, checked.tolerance, weld_near=False)
    assert not body.report.welded and body.max_displacement == 0.0 and body.report.boundary_edges == 8


def test_a_hole_is_capped_by_the_last_steps_and_the_faces_are_turned_after_that():
    part = with_flipped(without(CUBE, *TOP), 2)
    body = after(part, "close_gaps")
    assert len(body.state.uncapped_sides) == 4 == body.report.boundary_edges and not body.caps.any()
    capped = after(part, "cap_holes")
    np.testing.assert_allclose(capped.caps, [[1.0, 0.0, 1.0]], rtol=1e-15)
    assert len(capped.capped_edges) == 4 == np.count_nonzero(capped.face < 0)
    assert capped.triangles[2].tolist() == part[1][2].tolist() and capped.flipped.tolist().index(True) == 2
    turned = after(part, "turn_faces")
    assert turned.triangles[2].tolist() == part[1][2].tolist()[::-1]
    assert not turned.report.closed and repair_surface(surface(CUBE), 1e-6).report.closed


def test_only_what_a_meshs_own_edges_prove_is_left_as_it_is():
    quads = SIDES.tolist()
    proven = prove_closed(mesh(CUBE[0], quads))
    assert proven.number == 1 and proven.report.closed and not len(proven.triangles)
    assert (
        prove_closed(mesh(CUBE[0], quads[1:])) is None
        and prove_closed(mesh(CUBE[0], [quads[0][::-1], *quads[1:]])) is None
    )
    two = prove_closed(mesh(np.concatenate([CUBE[0], CUBE[0] + 3.0]), quads + (SIDES + 8).tolist()))
    assert two.number == 2 and len(two.triangles) == 24 and np.bincount(two.component).tolist() == [12, 12]


@pytest.mark.parametrize("is_open", [False, True])
def test_a_quad_s_diagonal_along_an_edge_of_other_faces_is_none_of_a_mesh_that_names_its_edges(is_open):
    """Two tents on one floor, whose ridge is its diagonal, perhaps without a wall."""
    points = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1.5, 0.5, 1], [0.5, 1.5, 1]], float)
    faces = [[0, 3, 2, 1], [1, 2, 4], [2, 0, 4], [2, 3, 5], [3, 0, 5], [0, 2, 5], [0, 1, 4]]
    tents = mesh(points, faces[: len(faces) - is_open])
    assert {(0, 3, 2), (0, 2, 1)} <= set(map(tuple, tents.all_triangles()[0].tolist()))
    result = measure_solid(tents)
    assert result.method == ("capped" if is_open else "exact") and close(result.volume.total, 4.0 / 3.0, rel=1e-14)
    assert result.health.components == 1 and not result.health.non_manifold_edges
    assert result.health.boundary_edges == 3 * is_open


@pytest.mark.parametrize("place", [0, 3, 6])
def test_a_face_that_names_a_vertex_twice_hides_no_crack_of_a_mesh_that_names_its_edges(place):
    points = np.concatenate([CUBE[0], CUBE[0][SIDES[0]] + 1e-8])
    cube = [[8, 9, 10, 11], *SIDES[1:].tolist()]
    cube.insert(place, [0, 0, 1])
    result = measure_solid(mesh(points, cube))
    assert result.health.welded and result.method == "exact" and not result.health.boundary_edges
    assert result.health.degenerate_faces == 1 and close(result.volume.total, 1.0, rel=1e-6)


@pytest.mark.parametrize("of", ["triangles", "quads"])
def test_faces_of_one_kind_without_edges_prove_themselves_closed(of):
    """In arrays, from no mesh: their sides have to be found first."""
    faces = CUBE[1] if of == "triangles" else SIDES
    points = np.concatenate([CUBE[0], CUBE[0] + 3.0])
    for number in (1, 2):
        given = np.concatenate([faces, faces + 8])[: number * len(faces)]
        proven = prove_closed(Surface(points[: 8 * number], **{of: given}))
        assert proven.number == number and proven.report.components == number and proven.report.closed
        assert np.bincount(proven.component, minlength=1).tolist() == ([12, 12] if number == 2 else [0])
    turned = np.concatenate([faces[:1, ::-1], faces[1:]])
    assert prove_closed(Surface(CUBE[0], **{of: faces[1:]})) is prove_closed(Surface(CUBE[0], **{of: turned})) is None
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
def test_what_is_inside_out_is_turned_and_its_volume_is_positive(part, turned, against, number):
    *_, oriented = staged(part)
    assert oriented.turned.tolist() == turned and oriented.reversed.tolist() == against
    assert (oriented.comparison is None) == (number == 1)
    parts = oriented.closed_parts()
    a, b, c = (parts.points[parts.triangles[:, k]] for k in range(3))
    volume = np.linalg.det(np.stack([a, b, c], axis=1)).sum() / 6.0
    assert close(oriented.volume.total, volume, rel=1e-14) and volume > 0.0


def test_closed_parts_are_those_that_hang_together():
    sizes = [1.0, 2.0, 3.0]
    cubes = [(CUBE[0] * size + 10.0 * number, CUBE[1]) for number, size in enumerate(sizes)]
    for count in (1, 2, 3):
        *_, oriented = staged(joined(*cubes[:count]))
        parts = oriented.closed_parts()
        a, b, c = (parts.points[parts.triangles[:, k]] for k in range(3))
        volumes = np.bincount(parts.part, np.linalg.det(np.stack([a, b, c], axis=1))) / 6.0
        assert parts.number == count and close(np.sort(volumes), np.array(sizes[:count]) ** 3, 1e-12)
        assert close(np.bincount(parts.part, parts.areas()), 6.0 * np.cbrt(volumes) ** 2, 1e-12)
        assert close(parts.areas(2.0 * np.eye(3)), 4.0 * parts.areas(), 1e-12)


def test_of_quads_too():
    """Two cubes of them, of which the mesh names the faces as it likes."""
    both = mesh(np.concatenate([CUBE[0], 2.0 * CUBE[0] + 3.0]), [*SIDES.tolist(), *(SIDES + 8).tolist()])
    order = np.random.default_rng(0).permutation(12)
    numbers = np.argsort(order)
    corners, edges = (each.reshape(12, 4)[order].ravel() for each in (both.corner_vertices, both.corner_edges))
    for given in (both, replace(both, quad_faces=numbers, corner_vertices=corners, corner_edges=edges)):
        checked = check_surface(given)
        integrals = integrate_and_prove(checked, False, 1)
        assert integrals.proven is not None
        parts = orient_components(checked, integrals, integrals.proven, 1).closed_parts()
        expected = np.repeat(given.quad_faces, 2)
        assert parts.face.tolist() == expected.tolist() and parts.part.shape == (24,)
        second = parts.triangles.min(axis=1) >= 8
        assert set(zip(parts.part.tolist(), second.tolist())) in ({(0, False), (1, True)}, {(1, False), (0, True)})


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
def test_what_encloses_nothing_is_no_closed_part_unless_all_is_so(given, included):
    *_, oriented = staged(joined(*given))
    faces = np.repeat(included, [len(part[1]) for part in given])
    parts = oriented.closed_parts()
    assert sorted(parts.face[parts.face >= 0].tolist()) == np.flatnonzero(faces).tolist()


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_open_counts_positive_and_is_not_called_inside_out(count):
    """Two boxes with one wall between them, once or twice."""
    points, triangles = welded(joined(CUBE, box((1, 0, 0), (2, 1, 1))))
    triangles = triangles[np.sort(np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)[1])]
    walls = joined(*(moved((points, triangles), offset=(0.5, 3.0 * k, 7.0 * k)) for k in range(count)))
    totals = []
    for part in (walls, inverted(walls)):
        *_, oriented = staged(part)
        assert not oriented.turned.any()
        parts = oriented.closed_parts()
        about = np.stack([parts.points[parts.triangles[:, k]] - oriented.volume.about for k in range(3)], axis=1)
        assert close(np.linalg.det(about).sum() / 6.0, oriented.volume.total, rel=1e-12)
        totals.append(oriented.volume.total)
        assert codes(measure_solid(surface(part))) == ["non_manifold_components"]
    assert totals[0] > 0.1 and close(totals[1], totals[0], rel=1e-12)


@pytest.mark.parametrize("count", [1, 2])
def test_open_components_are_flat_only_where_all_of_their_faces_are(count):
    """Three triangles on an edge, some way apart or in a plane."""
    pages = np.array([[0, 0, 0], [0, 2, 0], [1, 1, 0], [2, 1, 1.5], [-1, 1, -0.5]], float)
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    for height, flat in ((1.0, []), (0.0, ["flat_surface"])):
        books = joined(*(((pages + [4.0 * k, 0, 0]) * [1, 1, height], faces) for k in range(count)))
        assert codes(measure_solid(surface(books))) == ["non_manifold_components", *flat]


def test_what_closes_without_a_proof_is_measured_as_it_stands():
    """Triangles and quads of which no mesh says which face is which."""
    mixed = Surface(CUBE[0], CUBE[1][:2], SIDES[1:])
    result = measure_solid(mixed)
    assert prove_closed(mixed) is None and result.method is Verdict.EXACT
    assert result.repaired_surface is result.given_surface is mixed


@pytest.mark.parametrize("height, is_solid", [(1e-3, True), (1e-9, True), (1e-12, True), (2e-13, True), (1e-15, False)])
def test_a_closed_plate_is_a_solid_unless_rounding_alone_can_have_left_its_volume(height, is_solid):
    *_, oriented = staged((CUBE[0] * [1.0, 1.0, height], CUBE[1]))
    assert oriented.is_solid == is_solid
    assert not is_solid or close(oriented.volume.total, height, 1e-3)


PROVED = SelfIntersection(Intersection.EXCLUDED)


def test_the_verdict_follows_from_what_the_stages_hand_on():
    checked, given, body, oriented = staged(CUBE)
    assert judge(checked, given, oriented, PROVED).method is Verdict.EXACT
    capped = replace(oriented, mesh=replace(body, caps=np.array([[1.0, 0.0, 0.5]])))
    result = judge(checked, given, capped, PROVED)
    assert result.method is Verdict.CAPPED and close(result.health.cap_area_share, 0.5 / 6.0, rel=1e-14)
    turned = replace(oriented, turned=np.ones(1, bool))
    assert judge(checked, given, turned, PROVED).method is Verdict.REORIENTED
    unclosed = replace(oriented, mesh=replace(body, open=np.ones(1, bool)))
    assert judge(checked, given, unclosed, PROVED).method is Verdict.OPEN
    about = oriented.volume.about
    outside = oriented.volume.about_point(about - [0.6, 0.0, 0.0]).raw  # the center would be outside of the box
    negative = oriented.volume.raw * np.where(np.arange(20) == 4, -1.0, 1.0)
    for raw in (outside, negative):
        impossible = judge(checked, given, replace(oriented, volume=Moments(raw, about)), PROVED)
        assert impossible.method is Verdict.OPEN
        assert [item.code for item in impossible.findings] == ["self_intersecting"]
    flat = judge(checked, given, replace(oriented, is_solid=False, solid=np.zeros(1, bool)), PROVED)
    assert flat.method is Verdict.OPEN and not flat.volume.raw.any() and flat.volume.rounding_error[0] >= 1.0
    assert [item.code for item in flat.findings] == ["flat_surface"]


@pytest.mark.parametrize("name", ["closed", "holes", "nested"])
def test_results_are_plain_data(name):
    result = measure_solid(surface(BROKEN[name]))
    copy = pickle.loads(pickle.dumps(result))
    assert type(copy.method) is Verdict and copy.method == str(result.method)
    parts, same = result.parts(), copy.parts()
    np.testing.assert_array_equal(parts.triangles, same.triangles)
    np.testing.assert_array_equal(parts.part, same.part)
    for kind in (SolidIntegrals, PatchIntegrals):
        assert not [field.name for field in fields(kind) if "Callable" in str(field.type)]
