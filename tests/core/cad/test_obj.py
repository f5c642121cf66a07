# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Free-form surfaces of .obj files: B-splines, Bézier patches and refusals."""

import random
import time

import numpy as np
import pytest
from body_moments.core.cad.surface_file import SUFFIXES, read_surfaces
from body_moments.core.files import NOT_REGULAR
from body_moments.core.numerics.bspline import SplineSpace, clamped_space
from body_moments.core.nurbs import Patch, bezier_patches, measure_patches
from body_moments.core.verdict import FileError, finding
from body_moments.tests.close import close
from body_moments.tests.core.exact_splines import sphere, torus
from body_moments.tests.core.iges_files import obj_text, unrolled

BALL = 4.0 / 3.0 * np.pi
DONUT = 2.0 * np.pi**2 * 0.75 * 0.25**2


def read(tmp_path, text):
    path = tmp_path / "a.obj"
    path.write_text(text)
    return read_surfaces(path)


def cause(tmp_path, text):
    with pytest.raises(FileError) as caught:
        read(tmp_path, text)
    assert caught.value.reason.endswith(".")
    causes = caught.value.finding.values.get("causes")
    return causes[0]["code"] if causes else caught.value.finding.code


def volume(body):
    return measure_patches(body.patches).volume


@pytest.mark.parametrize("kind", ["bspline", "bezier"])
def test_round_bodies_are_objects_of_their_own_and_upright(tmp_path, kind):
    lifted = np.eye(4)
    lifted[2, 3] = 3.0
    first, second = unrolled(sphere()).transform(lifted), unrolled(torus())
    if kind == "bezier":
        first, second = (bezier_patches(patch, (None, None))[0] for patch in (first, second))
    found = read(tmp_path, obj_text([first], kind, "Ball") + obj_text([], kind) + "\n")
    assert [body.name for body in found.bodies] == ["Ball"] and found.unit is None
    assert close(volume(found.bodies[0]).total, BALL, 1e-14)
    assert np.abs(volume(found.bodies[0]).center - (0, 0, 3)).max() <= 1e-14
    path = tmp_path / "b.obj"
    path.write_text(obj_text([second], kind))
    (body,) = read_surfaces(path).bodies
    assert body.name == "b" and close(volume(body).total, DONUT, 1e-14)


def test_negative_numbers_textures_comments_and_faces_between(tmp_path):
    patch = unrolled(sphere())
    text = obj_text([patch])
    count = patch.weights.size
    lines = text.replace(" \\\n", " ").splitlines()
    at = next(number for number, line in enumerate(lines) if line.startswith("surf"))
    words = lines[at].split()
    words[5:] = ["{}/1/2".format(number - count - 1) for number in range(1, count + 1)]
    lines[at] = "  " + "\t".join(words) + "  # the ball"
    lines.insert(at, "f 1 2 3\nvn 0 0 1\nvp 0 0\nstech cparma 1 1")
    assert close(volume(read(tmp_path, "\n".join(lines)).bodies[0]).total, BALL, 1e-14)


def test_weights_without_rat_are_ignored(tmp_path):
    patch = unrolled(sphere())
    found = read(tmp_path, obj_text([patch]).replace("rat ", ""))
    plain = measure_patches(bezier_patches(Patch(patch.spaces, patch.points), (None, None))).volume
    assert close(volume(found.bodies[0]).total, plain.total, 1e-14)


def test_a_part_of_the_domain(tmp_path):
    s, t = clamped_space(4, (0.5,)), SplineSpace((0.0, 1.0, 2.0, 3.0, 5.0, 6.0), 3, 3)
    patch = Patch((s, t), np.random.default_rng(3).uniform(-1, 1, (5, 3, 3)))
    text = obj_text([patch]).replace("surf 0.0 1.0 2.0 3.0", "surf 0.25 0.75 2.5 3.0")
    (found,) = read(tmp_path, text).bodies[0].patches
    corners = patch.evaluate_grid([0.25, 0.75], [2.5, 3.0])
    assert (
        np.abs(found.evaluate_grid(found.spaces[0].domain, found.spaces[1].domain) - corners).max()
        <= 1e-14
    )


@pytest.mark.parametrize("is_rational", [True, False])
def test_a_vertex_may_lack_its_weight_or_have_a_color(tmp_path, is_rational):
    """Coordinates, with one weight; with six numbers and more three are a color, and there is no
    weight.
    """
    points = np.random.default_rng(6).uniform(-1.0, 1.0, (2, 2, 3))
    more = ["", " 0.5", " 0.5 9", " 0.25 0.5 0.75"]
    weights = np.array([[1.0, 0.5], [0.5, 1.0]])
    spaces = clamped_space(2), clamped_space(2)
    lines = [
        "v {!r} {!r} {!r}{}".format(x, z, -y, last)
        for (x, y, z), last in zip(points.reshape(-1, 3).tolist(), more)
    ]
    lines += ["cstype {}bezier".format("rat " * is_rational), "deg 1 1", "surf 0 1 0 1 1 3 2 4"]
    (found,) = (
        read(tmp_path, "\n".join([*lines, "parm u 0 1", "parm v 0 1", "end"])).bodies[0].patches
    )
    truth = Patch(spaces, points, weights if is_rational else None)
    at = [0.0, 0.25, 0.75, 1.0]
    assert np.abs(found.evaluate_grid(at, at) - truth.evaluate_grid(at, at)).max() <= 1e-14


BALL_TEXT = obj_text([unrolled(sphere())])


@pytest.mark.parametrize(
    "old, new, code",
    [
        ("end\n", "trim 0 1 1\nend\n", "surface_trimmed"),
        ("end\n", "hole 0 1 1\nend\n", "surface_trimmed"),
        ("rat bspline", "rat cardinal", "surface_unsupported"),
        ("rat bspline", "bmatrix", "surface_unsupported"),
        ("deg 2 2", "deg 2", "surface_damaged"),
        ("deg 2 2", "deg 2 3", "surface_damaged"),
        ("deg 2 2", "deg 2 2 2", "surface_damaged"),
        ("deg 2 2", "deg 0 2", "surface_damaged"),
        ("parm u", "parm w", "surface_damaged"),
        ("parm u 0.0", "parm u 2.0", "surface_damaged"),
        ("\n2 \\\n", "\n200 \\\n", "surface_damaged"),
        ("\n2 \\\n", "\n0 \\\n", "surface_damaged"),
        ("\n2 \\\n", "\nx \\\n", "surface_damaged"),
        ("v 9 9 9", "call other.obj", "file_unreadable"),
        ("\nsurf ", "\nsurface ", "file_without_objects"),
    ],
)
def test_unsupported_statement_is_refused(tmp_path, old, new, code):
    assert old in BALL_TEXT
    assert cause(tmp_path, BALL_TEXT.replace(old, new, 1)) == code


def test_order_above_six_and_nonpositive_weights_are_refused(tmp_path):
    seventh = Patch(
        (clamped_space(7), clamped_space(2)), np.random.default_rng(1).uniform(size=(7, 2, 3))
    )
    assert cause(tmp_path, obj_text([seventh])) == "surface_beyond_limit"
    bad = [
        line.rsplit(" ", 1)[0] + " -1" if line.startswith("v ") else line
        for line in BALL_TEXT.splitlines()
    ]
    assert cause(tmp_path, "\n".join(bad)) == "surface_points"
    assert cause(tmp_path, BALL_TEXT.replace("v 1.0", "v inf")) == "surface_points"


def test_surfaces_are_counted_and_refused_one_by_one(tmp_path):
    first, second, third, fourth = obj_text([unrolled(sphere())] * 4).split("cstype")[1:]
    vertices = obj_text([unrolled(sphere())] * 4).partition("cstype")[0]
    second, third = second.replace("deg 2 2", "deg 2 9"), third.replace("bspline", "taylor")
    found = read(tmp_path, "cstype".join([vertices, first, second, third, fourth]))
    assert len(found.bodies[0].patches) == 2 and found.notes == ()
    assert found.refused == (
        finding(
            "surface_beyond_limit",
            kind="surf",
            count=1,
            names=["surf 2"],
            quantity="order",
            value=10,
            limit=6,
        ),
        finding("surface_unsupported", kind="surf", count=1, names=["surf 3"], base="taylor"),
    )


@pytest.mark.parametrize("kind", ["bspline", "bezier", "rat bspline"])
@pytest.mark.parametrize("count", range(6))
@pytest.mark.parametrize(
    "u_knots, v_knots", [(2, 4), (3, 4), (2, 2), (1, 3), (0, 1), (6, 1), (4, 2)]
)
def test_knots_not_fitting_the_control_points_are_damage(tmp_path, kind, count, u_knots, v_knots):
    text = (
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ncstype {}\ndeg 1 1\nsurf 0 1 0 1 {}\nparm u {}\nparm "
        "v {}\nend\n"
    )
    words = (
        " ".join("1234123"[:count]),
        " ".join("0011223"[:u_knots]),
        " ".join("0011223"[:v_knots]),
    )
    if (kind, count, u_knots, v_knots) != ("bezier", 4, 2, 2):
        assert cause(tmp_path, text.format(kind, *words)) == "surface_damaged"


def test_damaged_files_are_refused_or_read_and_nothing_else(tmp_path):
    path, generator = tmp_path / "a.obj", random.Random(9)
    for _ in range(400):
        damaged = list(BALL_TEXT)
        for _ in range(generator.choice((1, 1, 3, 30))):
            damaged[generator.randrange(len(damaged))] = generator.choice(
                "0123456789.-+ evpsurf\n\0\\/#\xe4"
            )
        if generator.random() < 0.2:
            del damaged[generator.randrange(len(damaged)) :]
        path.write_text("".join(damaged))
        try:
            found = read_surfaces(path)
        except FileError as error:
            assert error.reason
        else:
            assert all(
                np.isfinite(patch.points).all() for body in found.bodies for patch in body.patches
            )


@pytest.mark.parametrize("kind", ["bezier", "bspline"])
def test_a_degree_beyond_all_memory_is_refused(tmp_path, kind):
    text = "v 0 0 0\ncstype {}\ndeg 1000000000000 1\nsurf 0 1 0 1 1\n".format(kind)
    text += "parm u 0 1\nparm v 0 1\nend\n"
    assert cause(tmp_path, text) == "surface_beyond_limit"


def test_a_statement_of_many_lines_is_read_in_time(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text(BALL_TEXT.replace("parm u", "parm u " + "\\\n" * 400_000, 1))
    start = time.process_time()
    assert read_surfaces(path).bodies
    assert time.process_time() - start < 2.0  # it took five and more, with the square of the number


@pytest.mark.parametrize("place", [2.9e38, -2.9e38, 3.1e38, -3.1e38])
def test_coordinates_up_to_the_float32_limit_are_kept(tmp_path, place):
    text = "v 0 0 0\nv {!r} 0 0\nv 0 1 0\nv 1 1 0\n".format(place)
    text += "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\n"
    text += "parm u 0 1\nparm v 0 1\nend\n"
    if abs(place) < 3e38:
        assert read(tmp_path, text).bodies[0].patches[0].points[1, 0, 0] == place
    else:
        assert cause(tmp_path, text) == "surface_points"


def test_file_without_surfaces_is_refused(tmp_path):
    folder = tmp_path / "folder.obj"
    folder.mkdir()
    for name, expected in (
        ("a.stl", finding("file_type", suffixes=" ".join(SUFFIXES))),
        ("none.obj", finding("file_missing")),
        ("folder.obj", finding("file_unreadable", error=NOT_REGULAR)),
    ):
        with pytest.raises(FileError) as caught:
            read_surfaces(tmp_path / name)
        assert caught.value.finding == expected


@pytest.mark.parametrize("words", ["trim 0 1 1", "hole 0 1 1", "parm u 0 1"])
def test_surface_statement_outside_a_surface_is_ignored(tmp_path, words):
    text = obj_text([unrolled(sphere())])
    for whole in (words + "\n" + text, text + "\n" + words + "\n"):
        assert close(volume(read(tmp_path, whole).bodies[0]).total, BALL, 1e-14)
