# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""IGES files of bodies with closed forms: units, transformations, subfigures and trims; refusals by
name; damaged files.
"""

import random

import numpy as np
import pytest
from body_moments.core.cad.iges_entities import UNIT_NAMES, UNITS
from body_moments.core.cad.surface_file import read_surfaces
from body_moments.core.files.limits import Limits
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import Patch, area_moments, measure_patches
from body_moments.core.verdict import FileError
from body_moments.tests.close import close
from body_moments.tests.core.exact_splines import flux_moment, sphere, torus
from body_moments.tests.core.iges_files import IgesFile, labels, surface_fields, unrolled

from tests.core.polygons import arcs, polygon

BALL = 4.0 / 3.0 * np.pi
DONUT = 2.0 * np.pi**2 * 0.75 * 0.25**2
TURN = np.array(
    [[0.0, -1.0, 0.0, 5.0], [0.0, 0.0, -1.0, -3.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 0.0, 1.0]]
)


def volume(file, number=0):
    return measure_patches(file.bodies[number].patches).volume


def refused(file):
    return {found.code: labels(found.values) for found in file.refused}


def refusal(path, **limits):
    with pytest.raises(FileError) as caught:
        read_surfaces(path, Limits(**limits))
    assert caught.value.reason.endswith(".")
    return caught.value.finding


def bicubic_body():
    """A closed polynomial body: a bicubic sheet over a square, its mirror image, and flat walls are
    not needed, for both have the same boundary.
    """
    s, t = clamped_space(4, (0.25, 0.5)), clamped_space(3, (0.75,))
    rng = np.random.default_rng(8)
    points = np.zeros((s.count, t.count, 3))
    points[..., 0], points[..., 1] = np.linspace(0, 2, s.count)[:, None], np.linspace(0, 1, t.count)
    points[1:-1, 1:-1, 2] = rng.uniform(0.5, 1.0, (s.count - 2, t.count - 2))
    below = points * (1.0, 1.0, -0.5)
    return Patch((s, t), points), Patch((s, t), below).reverse_orientation()


@pytest.mark.parametrize("patch, truth", [(sphere(), BALL), (torus(), DONUT)])
def test_round_bodies_have_their_volumes(tmp_path, patch, truth):
    file = IgesFile()
    file.surface(unrolled(patch))
    read = read_surfaces(file.write(tmp_path / "body.igs"))
    assert read.unit == 1.0 and read.refused == () and read.bodies[0].name == "body"
    assert close(volume(read).total, truth, 1e-14)
    assert all(space.order <= 6 for patch in read.bodies[0].patches for space in patch.spaces)


def test_a_polynomial_body_to_the_last_digit(tmp_path):
    patches = bicubic_body()
    file = IgesFile()
    for patch in patches:
        file.surface(patch)
    found = volume(read_surfaces(file.write(tmp_path / "a.iges")))
    for index, exponents in enumerate([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (2, 0, 0)]):
        truth = float(sum(flux_moment(patch, exponents) for patch in patches))
        moved = found.about_point(np.zeros(3))
        assert abs(moved.raw[index] - truth) <= 1e-14 * abs(
            float(flux_moment(patches[0], (0, 0, 0)))
        )


@pytest.mark.parametrize(
    "flag, name", [*((flag, "") for flag in UNITS), *((3, name) for name in UNIT_NAMES), (None, "")]
)
def test_units_and_the_model_scale(tmp_path, flag, name):
    file = IgesFile(flag, name, scale=0.125)  # a unit of the model is eight of these
    file.surface(unrolled(sphere()))
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert read.unit == 8.0 * (UNIT_NAMES[name] if flag == 3 else UNITS[flag or 1])


def test_transformations_of_transformations_mirrors_and_shears(tmp_path):
    shear = np.array(
        [[1.0, 0.5, 0.0, 1.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, -3.0, 0.0], [0, 0, 0, 1.0]]
    )
    file = IgesFile()
    outer = file.transformation(TURN)
    inner = file.transformation(shear, matrix=outer)
    file.surface(unrolled(sphere()), matrix=inner)
    found = volume(read_surfaces(file.write(tmp_path / "a.igs")))
    assert close(found.total, 6.0 * BALL, 1e-14)
    assert np.abs(found.center - (TURN @ shear)[:3, 3]).max() <= 1e-14


def test_subfigures_place_surfaces_many_times(tmp_path):
    file = IgesFile()
    ball = file.surface(unrolled(sphere()), status="00010000")
    small = file.add(308, [0, "5HSmall", 1, ball], status="00000200")
    pair = [file.add(408, [small, float(x), 0.0, 0.0, 0.5], status="00010000") for x in (-4, 4)]
    both = file.add(308, [1, "3HTwo", 2, *pair], status="00000200")
    file.add(408, [both, 0.0, 0.0, 10.0], matrix=file.transformation(TURN))
    file.add(408, [both, 0.0, 0.0, -10.0])
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert len(read.bodies[0].patches) == 4
    found = volume(read)
    assert close(found.total, 4.0 * BALL / 8.0, 1e-13)
    truth = (TURN @ (0, 0, 10, 1) + (0, 0, -10, 1))[:3] / 2
    assert np.abs(found.center - truth).max() <= 1e-13


def trimmed(file, curves, patch=None, outer=1, holes=()):
    patch = patch or unrolled(sphere())
    base = file.surface(patch, status="00010000")
    pieces = [file.add(kind, fields, status="00010500") for kind, fields in curves]
    curve = (
        pieces[0] if len(pieces) == 1 else file.add(102, [len(pieces), *pieces], status="00010500")
    )
    boundary = file.add(142, [0, base, curve, 0, 1], status="00010000")
    return file.add(144, [base, outer, len(holes), boundary if outer else 0, *holes], label="TRIM")


def line(a, b):
    return 110, [float(a[0]), float(a[1]), 0.0, float(b[0]), float(b[1]), 0.0]


def polyline(*corners, degree=1):
    knots = (
        [0.0] * degree
        + [float(i) for i in range(len(corners) - degree + 1)]
        + [float(len(corners) - degree)] * degree
    )
    points = [value for x, y in corners for value in (float(x), float(y), 0.0)]
    head = [len(corners) - 1, degree, 1, 0, 1, 0]
    return 126, [*head, *knots, *[1.0] * len(corners), *points, knots[0], knots[-1], 0, 0, 1]


SPACE_S, SPACE_T = unrolled(sphere()).spaces
S0, S1 = SPACE_S.domain
T0, T1 = SPACE_T.domain
A, B, C, D = (S0, T0), (S1, T0), (S1, T1), (S0, T1)
MIDDLE = ((S0 + S1) / 2, T0)


@pytest.mark.parametrize(
    "curves",
    [
        [line(A, B), line(B, C), line(C, D), line(D, A)],
        [line(D, C), line(C, B), line(B, A), line(A, D)],
        [polyline(A, B, C, D, A)],
        [polyline(A, B, A, B, C, D, A)],  # there and back
        [polyline(A, B, C, D, A, B, C, D, A)],  # twice around
        [polyline(MIDDLE, B, C, D, A, MIDDLE)],
        [polyline(A, MIDDLE, B, degree=2), line(B, C), polyline(C, D, degree=1), line(D, A)],
    ],
)
def test_untrimming_boundary_is_ignored(tmp_path, curves):
    file = IgesFile()
    trimmed(file, curves)
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert read.refused == () and close(volume(read).total, BALL, 1e-14)


def test_a_trimmed_surface_without_boundaries(tmp_path):
    file = IgesFile()
    trimmed(file, [line(A, B)], outer=0)
    assert close(volume(read_surfaces(file.write(tmp_path / "a.igs"))).total, BALL, 1e-14)


INNER = ((S0 + S1) / 2, (T0 + T1) / 2)
NEAR = (S1 - 1e-5 * (S1 - S0), T0)


@pytest.mark.parametrize(
    "curves, code",
    [
        ([line(A, B), line(B, C), line(C, A)], "surface_trimmed"),
        ([line(A, B), line(B, C), line(C, D)], "surface_damaged"),  # open
        ([polyline(A, B, INNER, D, A)], "surface_trimmed"),
        ([polyline(A, NEAR, (NEAR[0], T1), D, A)], "surface_trimmed"),
        ([line(A, B), line(C, B), line(C, D), line(D, A)], "surface_damaged"),
        ([(100, [0.0, *INNER, *A, *A])], "surface_trimmed"),
    ],
)
def test_trimming_boundary_is_refused_by_name(tmp_path, curves, code):
    file = IgesFile()
    trimmed(file, curves)
    cause = refusal(file.write(tmp_path / "a.igs")).values["causes"][0]
    assert cause["code"] == code and labels(cause["values"]) == ["TRIM"]
    file.surface(unrolled(torus()).transform(np.diag([1, 1, 1, 1]) + np.eye(4, k=3) * 9))
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert refused(read) == {code: ["TRIM"]} and close(volume(read).total, DONUT, 1e-14)


PLATE = Patch(
    (clamped_space(2, (), -3.0, 3.0),) * 2,
    np.array([[(x, y, 0.0) for y in (-3, 3)] for x in (-3, 3)], float),
)


def chain(file, curves):
    """A composite curve, in space or in the parameters of PLATE, which are x and y."""
    ids = []
    for curve in curves:
        weights = np.ones(len(curve.points)) if curve.weights is None else curve.weights
        numbers = *curve.space.knots, *weights, *curve.points.ravel(), *curve.space.domain
        fields = [
            len(curve.points) - 1,
            curve.space.order - 1,
            1,
            0,
            0,
            0,
            *map(float, numbers),
            0.0,
            0.0,
            1.0,
        ]
        ids.append(file.add(126, fields, status="00010000"))
    return file.add(102, [len(ids), *ids], status="00010000")


def plate_with(file, loops, outer=1, space=True, flat=True, preferred=3):
    base = file.surface(PLATE, status="00010000")
    pointers = []
    for loop in loops:
        curves = chain(file, loop) if flat else 0, chain(file, loop) if space else 0
        pointers.append(file.add(142, [0, base, *curves, preferred], status="00010000"))
    return file.add(
        144, [base, outer, len(loops) - outer, *[0] * (1 - outer), *pointers], label="PLATE"
    )


def backward(loop):
    return [curve.reverse() for curve in reversed(loop)]


@pytest.mark.parametrize("given", [(True, True), (True, False), (False, True)])
@pytest.mark.parametrize("way", [list, backward])
def test_plane_within_curves_is_a_face(tmp_path, given, way):
    file, hole = IgesFile(1), arcs(0.5, center=(1.0, 1.0))
    plate_with(file, [way(arcs(2.0)), hole], 1, *given)
    plate_with(file, [hole], 0, *given)
    read = read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    found = [area_moments([face], 0)[0].total for face in read.bodies[0].patches]
    assert read.refused == () and close(found, np.array([3.75 * np.pi, 36.0 - 0.25 * np.pi]), 1e-14)


@pytest.mark.parametrize(
    "loop",
    [arcs(1.0)[:3], polygon((0, 0), (2, 2), (2, 0), (0, 2)), [*arcs(1.0)[:3], *arcs(1.0, 0.2)[3:]]],
)
def test_curves_that_bound_no_region_are_refused(tmp_path, loop):
    file = IgesFile()
    plate_with(file, [loop], flat=False)
    file.surface(unrolled(sphere()))
    read = read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    assert refused(read) == {"surface_damaged": ["PLATE"]} and read.unread == 1
    assert "cross" in str(read.refused[0])


def test_a_hole_is_refused(tmp_path):
    file, ball = IgesFile(), Patch(unrolled(sphere()).spaces, unrolled(sphere()).points)
    trimmed(file, [line(A, B), line(B, C), line(C, D), line(D, A)], holes=(1,))
    around = [curve if ahead else curve.reverse() for curve, ahead in ball.sides]
    base = file.surface(ball, status="00010000")
    outer = file.add(142, [0, base, 0, chain(file, around), 3], status="00010000")
    file.add(144, [base, 1, 1, outer, 1])
    causes = refusal(file.write(tmp_path / "a.igs")).values["causes"]
    assert [(cause["code"], len(cause["values"]["names"])) for cause in causes] == [
        ("surface_trimmed", 2)
    ]
    file.add(144, [base, 1, 0, outer])
    assert len(read_surfaces(file.write(tmp_path / "a.igs")).bodies[0].patches) == 1


def test_part_of_the_domain_and_unclamped_knots_are_read(tmp_path):
    s = SplineSpace((-1.0, 0.0, 0.5, 1.5, 2.0, 4.0, 5.0), 3, 4)
    t = clamped_space(6, (0.5,), 0.0, 2.0)
    patch = Patch((s, t), np.random.default_rng(2).uniform(-1, 1, (4, 7, 3)))
    file = IgesFile()
    file.surface(patch, ((0.75, 2.0), (0.25, 2.0)))
    (found,) = read_surfaces(file.write(tmp_path / "a.igs")).bodies[0].patches
    corners = found.evaluate_grid(found.spaces[0].domain, found.spaces[1].domain)
    assert np.abs(corners - patch.evaluate_grid([0.75, 2.0], [0.25, 2.0])).max() <= 1e-14


def test_other_surface_types_are_refused_and_curves_left_out(tmp_path):
    file = IgesFile()
    file.surface(unrolled(sphere()))
    file.surface(unrolled(torus()), status="01000000")
    file.add(114, [1, 3, 0.0, 6.28], label="VASE")
    file.add(186, [1, 1, 0])
    file.add(514, [1, 1, 1], status="00010000")
    file.add(110, [0.0] * 6)
    file.add(314, [0.0, 0.0, 0.0], status="00000200")
    bad = surface_fields(Patch((clamped_space(2), clamped_space(2)), np.zeros((2, 2, 3))))
    file.add(128, bad[:-20], label="SHORT")
    weights = bad.copy()
    weights[9 + 8] = -1.0
    file.add(128, weights, label="MINUS")
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert close(volume(read).total, BALL, 1e-14)
    assert {note.code: note.values["count"] for note in read.notes} == {
        "surfaces_hidden": 1,
        "curves_left_out": 1,
    }
    names = [(found.code, found.values["kind"], labels(found.values)[0]) for found in read.refused]
    assert names == [
        ("surface_unsupported", "Parametric Spline Surface (114)", "VASE"),
        ("surface_damaged", "Manifold Solid B-Rep (186)", "D7"),
        ("surface_damaged", "Rational B-Spline Surface (128)", "SHORT"),
        ("surface_points", "Rational B-Spline Surface (128)", "MINUS"),
    ]
    assert all(str(found).endswith(".") for found in read.refused)


def test_pointers_in_circles_end(tmp_path):
    file = IgesFile()
    file.add(124, [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0], matrix=3)
    file.add(124, [1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0], matrix=1)
    file.surface(unrolled(sphere()), matrix=1)
    file.add(308, [0, "1HA", 1, 9], status="00000200")
    file.add(408, [7, 0.0, 0.0, 0.0], status="00010000")
    file.add(408, [7, 0.0, 0.0, 0.0])
    file.add(102, [1, 13])
    causes = refusal(file.write(tmp_path / "a.igs")).values["causes"]
    assert {cause["code"] for cause in causes} == {"surface_damaged"}


def test_multiplying_subfigures_end(tmp_path):
    file = IgesFile()
    below = file.surface(unrolled(sphere()), status="00010000")
    for _ in range(40):
        parts = below, file.add(308, [0, "1HA", 1, below], status="00000200")
        copies = [file.add(408, [parts[1], 0.0, 0.0, 0.0], status="00010000") for _ in range(2)]
        group = file.add(308, [0, "1HB", 2, *copies], status="00000200")
        below = file.add(408, [group, 0.0, 0.0, 0.0], status="00010000")
    file.add(408, [group, 0.0, 0.0, 0.0])
    assert refusal(file.write(tmp_path / "a.igs")).code in ("file_too_large", "no_surface_kept")


@pytest.mark.parametrize("depth, kept", [(50, True), (51, False)])
def test_subfigures_in_each_other_end(tmp_path, depth, kept):
    file = IgesFile()
    below = file.surface(unrolled(sphere()), status="00010000")
    for level in range(depth):
        group = file.add(308, [0, "1HA", 1, below], status="00000200")
        status = "00010000" if level < depth - 1 else "00000000"
        below = file.add(408, [group, 0.0, 0.0, 0.0], status=status)
    path = file.write(tmp_path / "a.igs")
    if kept:
        assert close(volume(read_surfaces(path)).total, BALL, 1e-14)
    else:
        assert refusal(path).values["causes"][0]["code"] == "surface_damaged"


@pytest.mark.parametrize("depth, kept", [(50, True), (51, False)])
def test_transformations_of_each_other_end(tmp_path, depth, kept):
    file = IgesFile()
    step, matrix = np.eye(4), 0
    step[0, 3] = 0.5
    for _ in range(depth):
        matrix = file.transformation(step, matrix=matrix)
    file.surface(unrolled(sphere()), matrix=matrix)
    path = file.write(tmp_path / "a.igs")
    if kept:
        assert np.abs(volume(read_surfaces(path)).center - (depth / 2.0, 0.0, 0.0)).max() <= 1e-12
    else:
        assert refusal(path).values["causes"][0]["code"] == "surface_damaged"


@pytest.mark.parametrize("count, kept", [(9999, True), (10_000, False)])
def test_a_boundary_has_up_to_ten_thousand_pieces(tmp_path, count, kept):
    """The curve is a boundary itself; all but four stay in place."""
    file = IgesFile()
    here, *sides = (
        file.add(*line(*ends), status="00010500")
        for ends in ((A, A), (A, B), (B, C), (C, D), (D, A))
    )
    curve = file.add(102, [count, *[here] * (count - 4), *sides], status="00010500")
    assert is_kept(file, curve, tmp_path) == kept


def is_kept(file, curve, tmp_path):
    """Return True if the surface bounded by this curve is kept."""
    base = file.surface(unrolled(sphere()), status="00010000")
    file.add(
        144, [base, 1, 0, file.add(142, [0, base, curve, 0, 1], status="00010000")], label="TRIM"
    )
    beside = unrolled(torus())
    file.surface(beside)
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert refused(read) in ({}, {"surface_trimmed": ["TRIM"]})
    return read.refused == ()


def test_member_in_nested_groups_is_placed_from_inside_outward(tmp_path):
    """The surface's own transformation, the subfigure's, the place and scale of its instance, and
    the instance's own transformation.
    """
    patch = Patch(
        (clamped_space(2), clamped_space(2)), np.random.default_rng(4).uniform(-1.0, 1.0, (2, 2, 3))
    )
    own, inner, outer, last, first = np.tile(np.eye(4), (5, 1, 1))
    for seed, matrix in enumerate((own, inner, outer, last, first)):
        matrix[:3] += np.random.default_rng(seed).uniform(-0.5, 0.5, (3, 4))
    file = IgesFile()
    member = file.surface(patch, matrix=file.transformation(own), status="00010000")
    one = file.add(308, [0, "1HA", 1, member], matrix=file.transformation(inner), status="00000200")
    place = file.add(
        408, [one, 1.0, 2.0, -3.0, 0.5], matrix=file.transformation(outer), status="00010000"
    )
    two = file.add(308, [1, "1HB", 1, place], matrix=file.transformation(last), status="00000200")
    file.add(408, [two, -4.0, 0.0, 1.0, 3.0], matrix=file.transformation(first))
    near, far = np.diag([0.5, 0.5, 0.5, 1.0]), np.diag([3.0, 3.0, 3.0, 1.0])
    near[:3, 3], far[:3, 3] = (1.0, 2.0, -3.0), (-4.0, 0.0, 1.0)
    (found,) = read_surfaces(file.write(tmp_path / "a.igs")).bodies[0].patches
    truth = patch.transform(first @ far @ last @ outer @ near @ inner @ own)
    assert np.abs(found.points - truth.points).max() <= 1e-13


def test_curves_and_hidden_subfigure_members_are_left_out(tmp_path):
    file = IgesFile()
    ball = file.surface(unrolled(sphere()), status="00010000")
    hidden = file.surface(unrolled(torus()), status="01010000")
    curve = file.add(*line(A, B), status="00010000")
    file.add(
        408, [file.add(308, [0, "1HA", 3, curve, hidden, ball], status="00000200"), 0.0, 0.0, 0.0]
    )
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert read.refused == () and close(volume(read).total, BALL, 1e-14)


def test_a_boundary_s_curve_with_a_transformation_trims(tmp_path):
    file = IgesFile()
    matrix = file.transformation(np.eye(4))
    kind, fields = polyline(A, B, C, D, A)
    assert not is_kept(file, file.add(kind, fields, matrix=matrix), tmp_path)


@pytest.mark.parametrize("first, count", [(0, 1), (-2, 3), (3, 0), (3, -1), (1, 1), (3, 99)])
def test_parameters_outside_their_directory_lines_are_damage(tmp_path, first, count):
    """The first lines belong to an entity of another type; from the last, and from none, nothing is
    counted.
    """
    file = IgesFile()
    file.add(110, [0.0] * 6)
    file.surface(unrolled(sphere()), label="FAR")
    file.surface(unrolled(sphere()))
    path = file.write(tmp_path / "a.igs")
    lines = path.read_text().split("\n")
    at = [number for number, text in enumerate(lines) if text[72:73] == "D"][2:4]
    lines[at[0]] = lines[at[0]][:8] + "{:>8}".format(first) + lines[at[0]][16:]
    lines[at[1]] = lines[at[1]][:24] + "{:>8}".format(count) + lines[at[1]][32:]
    path.write_text("\n".join(lines))
    read = read_surfaces(path)
    assert refused(read) == {"surface_damaged": ["FAR"]} and len(read.bodies[0].patches) == 1


def test_other_delimiters_and_line_ends_are_read(tmp_path):
    file = IgesFile(2)
    file.delimiter, file.end = "/", "#"
    file.surface(unrolled(sphere()))
    text = file.text()
    for number, written in enumerate(
        (text, text.replace("\n", "\r\n"), text.replace("\n", ""), text.replace("e-", "D-"))
    ):
        path = tmp_path / "a{}.igs".format(number)
        path.write_bytes(written.encode("latin-1"))
        assert close(volume(read_surfaces(path)).total, BALL, 1e-14)


@pytest.mark.parametrize(
    "text, code",
    [
        ("", "file_unrecognized"),
        ("solid\n", "file_unrecognized"),
        ("{:<72}B{:>7}\n".format("", 1), "file_unreadable"),
        ("{:<72}C{:>7}\n".format("", 1), "file_unreadable"),
        ("\0" * 1000, "file_unrecognized"),
    ],
)
def test_foreign_file_is_refused_as_no_iges_file(tmp_path, text, code):
    path = tmp_path / "a.igs"
    path.write_text(text)
    assert refusal(path).code == code


def test_an_unknown_unit_and_a_limit(tmp_path):
    file = IgesFile(3, "CUBIT")
    file.surface(unrolled(sphere()))
    assert refusal(file.write(tmp_path / "a.igs")).values["text"] == "CUBIT"
    assert refusal(tmp_path / "a.igs", text_bytes=1000).code == "file_exceeds_limit"


def test_damaged_files_are_refused_or_read_and_nothing_else(tmp_path):
    file = IgesFile()
    ball = file.surface(unrolled(sphere()), matrix=file.transformation(TURN), status="00010000")
    file.add(408, [file.add(308, [0, "1HA", 1, ball], status="00000200"), 1.0, 2.0, 3.0])
    trimmed(file, [polyline(A, B, C, D, A)])
    text = file.text()
    path, generator = tmp_path / "a.igs", random.Random(7)
    for _ in range(600):
        damaged = list(text)
        for _ in range(generator.choice((1, 1, 3, 30))):
            at = generator.randrange(len(damaged))
            damaged[at] = generator.choice("0123456789.,;-+ EDH\n\0SGPT\xe4")
        if generator.random() < 0.2:
            del damaged[generator.randrange(len(damaged)) :]
        path.write_text("".join(damaged), encoding="latin-1")
        try:
            read = read_surfaces(path)
        except FileError as error:
            assert error.reason
        else:
            assert all(
                np.isfinite(patch.points).all() for body in read.bodies for patch in body.patches
            )


def test_a_negative_number_of_members_is_damage(tmp_path):
    file = IgesFile()
    ball = file.surface(unrolled(sphere()), status="00010000")
    two = file.add(308, [0, "3HTwo", -1, ball, ball], status="00000200")
    file.add(408, [two, 0.0, 0.0, 0.0, 1.0])
    file.surface(unrolled(sphere()))
    assert "surface_damaged" in refused(read_surfaces(file.write(tmp_path / "a.igs")))


def test_all_surfaces_of_the_specification_are_refused_by_name(tmp_path):
    """The numbers and names of IGES 5.3, section 4."""
    names = (
        "108 Plane|114 Parametric Spline Surface|118 Ruled Surface|120 Surface of Revolution|"
        "122 Tabulated Cylinder|140 Offset Surface|143 Bounded Surface|150 Block|152 Wedge|"
        "154 Cylinder|156 Cone Frustum|158 Sphere|160 Torus|162 Solid of Revolution|"
        "164 Solid of Linear Extrusion|168 Ellipsoid|180 Boolean Tree|184 Solid Assembly|"
        "186 Manifold Solid B-Rep|190 Plane Surface|192 Cylindrical Surface|194 Conical Surface|"
        "196 Spherical Surface|198 Toroidal Surface|412 Rectangular Array|414 Circular Array|"
        "416 External Reference|430 Solid Instance|510 Face|514 Shell"
    )
    file = IgesFile()
    file.surface(unrolled(sphere()))
    kinds = []
    for number, _, name in (entry.partition(" ") for entry in names.split("|")):
        file.add(int(number), [0] * 12)
        kinds.append("{} ({})".format(name, number))
    refused = read_surfaces(file.write(tmp_path / "a.igs")).refused
    assert [found.values["kind"] for found in refused] == kinds
    assert {found.code for found in refused} == {"surface_unsupported", "surface_damaged"}


def test_dangling_pointer_is_damage(tmp_path):
    """A subfigure, its member, a trimmed surface and a transformation that are not there, or
    something else.
    """
    file = IgesFile()
    ball = file.surface(unrolled(sphere()))
    far = file.add(308, [0, "1HA", 1, 99], status="00000200")
    for fields in ([99, 0.0, 0.0, 0.0], [far, 0.0, 0.0, 0.0], [ball, 0.0, 0.0, 0.0]):
        file.add(408, fields, label="PLACE")
    file.add(144, [99, 0, 0, 0], label="TRIM")
    file.surface(unrolled(sphere()), matrix=99, label="FAR")
    file.surface(unrolled(sphere()), matrix=ball, label="OTHER")
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert {one.code for one in read.refused} == {"surface_damaged"}
    is_missing = {
        tuple(labels(one.values)): "not in" in one.values["fault"] for one in read.refused
    }
    missing = ("PLACE", "PLACE"), ("TRIM",), ("FAR",)
    others = ("PLACE",), ("OTHER",)
    assert is_missing == dict.fromkeys(missing, True) | dict.fromkeys(others, False)
    assert len(read.bodies[0].patches) == 1


@pytest.mark.parametrize(
    "old, new, said",
    [
        ("1H,,1H;,", "1H,,1H,,", "global"),
        ("1H,,1H;,", "1H,x1H;,", "global"),
        ("1H,,1H;,", "1H,,1H;x", "global"),
        ("1H,,1H;,", "1H;,1H;,", "global"),
        ("1H,,1H;,", "1H,,1H!,", "global"),
        (",1.0,6,", ",one,6,", "global"),
        (",1.0,6,", ",-1.0,6,", "global"),
        (",1.0,6,", ",1e-320,6,", "global"),
        (",1.0,6,", ",1e400,6,", "global"),
        (",1.0,6,", ",1.0,6.5,", "global"),
        (",1.0,6,", ",1.0,1_0,", "global"),
        (",1.0,6,", ",1.0,12,", "unit"),
        ("4Htest", "", 1.0),
        ("4Htest", "5Ha,b;c", 1.0),
        (",1.0,6,", ",0.0,6,", 1.0),
        (",1.0,6,", ",,,", 0.0254),
        (",1.0,6,", ",1.0,0,", 0.0254),
        ("1H,,1H;,", ",,", 1.0),
        ("1H,,1H;,", "1H,,,", 1.0),
        ("     128       1", "     12x       1", "directory"),
    ],
)
def test_a_global_section_or_directory_is_read_or_refused(tmp_path, old, new, said):
    file = IgesFile()
    file.surface(unrolled(sphere()))
    lines, path = file.text().splitlines(), tmp_path / "a.igs"
    section = "D" if said == "directory" else "G"
    text = "".join(line[:72] for line in lines if line[72] == section)
    assert text.count(old) == 1
    text = text.replace(old, new)
    changed = [
        "{:<72}{}{:>7}".format(text[at : at + 72], section, 1) for at in range(0, len(text), 72)
    ]
    first = next(number for number, line in enumerate(lines) if line[72] == section)
    rest = [line for line in lines if line[72] != section]
    path.write_text("\n".join([*rest[:first], *changed, *rest[first:]]))
    if isinstance(said, float):
        assert read_surfaces(path).unit == said
        return
    found = refusal(path)
    if said == "unit":
        assert (found.code, found.values["text"]) == ("header_field", "M")
    else:
        assert (found.code, found.values["section"][: len(said)]) == ("iges_damaged", said)


def test_units_match_the_specification():
    sizes = [0.0254, 1e-3, 0.3048, 1609.344, 1.0, 1e3, 2.54e-5, 1e-6, 1e-2, 2.54e-8]
    assert {1: sizes[0], **dict(zip((2, 4, 5, 6, 7, 8, 9, 10, 11), sizes[1:]))} == UNITS
    assert (
        dict(zip(("IN", "MM", "FT", "MI", "M", "KM", "MIL", "UM", "CM", "UIN"), sizes))
        | {"INCH": 0.0254}
        == UNIT_NAMES
    )


def test_parameters_without_an_end_are_damage(tmp_path):
    file = IgesFile()
    file.surface(unrolled(sphere()))
    for label, more in (("PLAIN", []), ("TEXT", ["4Htext"])):
        file.add(128, [*surface_fields(unrolled(sphere())), *more], label=label)
        file._parameters[-1] = file._parameters[-1].replace(";", " ")
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert close(volume(read).total, BALL, 1e-14) and refused(read) == {
        "surface_damaged": ["PLAIN", "TEXT"]
    }


def test_boundary_with_a_nonpositive_weight_trims(tmp_path):
    kind, fields = polyline(A, B, C, D, A)
    assert fields[13:18] == [1.0] * 5
    for weight in (1.0, 0.0, -1.0):
        file = IgesFile()
        trimmed(file, [(kind, [*fields[:14], weight, *fields[15:]])])
        path = file.write(tmp_path / "a.igs")
        if weight > 0.0:
            assert close(volume(read_surfaces(path)).total, BALL, 1e-14)
        else:
            assert refusal(path).values["causes"][0]["code"] == "surface_trimmed"


def test_transformation_or_surface_lacking_numbers_is_damage(tmp_path):
    fields = surface_fields(unrolled(sphere()))
    file = IgesFile()
    file.surface(unrolled(sphere()), matrix=file.add(124, [1.0] * 11), label="SHORT")
    file.add(128, [1, *fields[1:]], label="FEW")
    file.add(128, [*fields[:3], 0, *fields[4:]], label="STEPS")
    file.surface(unrolled(sphere()))
    assert refused(read_surfaces(file.write(tmp_path / "a.igs"))) == {
        "surface_damaged": ["SHORT", "FEW", "STEPS"]
    }


def test_a_subfigure_in_itself_is_placed_once(tmp_path):
    file = IgesFile()
    ball = file.surface(unrolled(sphere()), status="00010000")
    file.add(308, [0, "1HA", 2, ball, 5], status="00000200")
    file.add(408, [3, 1.0, 0.0, 0.0], status="00010000", label="WITHIN")
    file.add(408, [3, 0.0, 0.0, 0.0])
    read = read_surfaces(file.write(tmp_path / "a.igs"))
    assert len(read.bodies[0].patches) == 1 and close(volume(read).total, BALL, 1e-14)
    assert refused(read) == {"surface_damaged": ["WITHIN"]}


@pytest.mark.parametrize("last, degree", [(2, 0), (2, 3), (3, 1)])
def test_a_boundary_s_curve_that_lacks_numbers_is_damage(tmp_path, last, degree):
    kind, fields = polyline(A, MIDDLE, B)
    file = IgesFile()
    trimmed(file, [(kind, [last, degree, *fields[2:]]), line(B, C), line(C, D), line(D, A)])
    assert refusal(file.write(tmp_path / "a.igs")).values["causes"][0]["code"] == "surface_damaged"


def bounded_can(file, top=140):
    """A cylinder of radius 2 and height 3 of bounded surfaces (143) with boundaries in space (141),
    its upper end an offset plane (140) or another entity.
    """
    inner = {"status": "00010000"}
    place, up = file.add(116, [0.0, 0.0, 0.0, 0], **inner), file.add(123, [0.0, 0.0, 1.0], **inner)
    low, high = (file.add(100, [z, 0.0, 0.0, 2.0, 0.0, 2.0, 0.0], **inner) for z in (0.0, 3.0))
    down = file.add(123, [0.0, 0.0, -1.0], **inner)
    plane, bottom = (file.add(190, [place, way], **inner) for way in (up, down))
    wall = file.add(192, [place, up, 2.0], **inner)
    end = file.add(top, [0.0, 0.0, 1.0, 3.0, plane], **inner)
    for base, circles in ((wall, (low, high)), (bottom, (low,)), (end, (high,))):
        loops = [file.add(141, [0, 0, base, 1, one, 1, 0], **inner) for one in circles]
        file.add(143, [0, base, len(loops), *loops])


def test_bounded_surfaces_and_an_offset_plane_close_a_body(tmp_path):
    file = IgesFile()
    bounded_can(file)
    read = read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    body = measure_patches(read.bodies[0].patches)
    assert read.refused == () and body.method == "exact"
    assert abs(body.volume.total - 12.0 * np.pi) <= body.volume.rounding_error[0] <= 1e-10


def test_body_with_a_refused_face_is_left_out_whole(tmp_path):
    file = IgesFile()
    bounded_can(file, 114)
    with pytest.raises(FileError) as caught:
        read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    (cause,) = caught.value.finding.values["causes"]
    assert cause["code"] == "surface_unsupported" and "D" in cause["values"]["names"][0]
    file.surface(unrolled(torus()))
    read = read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    assert len(read.refused) == 1 and close(volume(read).total, DONUT, 1e-14)


@pytest.mark.parametrize("angle", [1e-10, 1.0])
def test_surface_of_any_angle_of_revolution_is_read(tmp_path, angle):
    file = IgesFile()
    inner = {"status": "00010000"}
    axis = file.add(110, [0.0, 0.0, 0.0, 0.0, 0.0, 1.0], **inner)
    profile = file.add(110, [2.0, 0.0, 0.0, 2.0, 0.0, 3.0], **inner)
    file.add(120, [axis, profile, 0.0, angle])
    read = read_surfaces(file.write(tmp_path / "a.igs"), for_blender=False)
    assert close(area_moments(read.bodies[0].patches, 0, np.zeros(3))[0].total, 6.0 * angle, 1e-7)
