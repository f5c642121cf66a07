# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blank, full, missing and misplaced fields of IGES files, and meaningless fields of .obj files."""

import numpy as np
import pytest
from body_moments.core.cad.surface_file import read_surfaces
from body_moments.core.nurbs.solid import measure_patches
from body_moments.core.verdict import FileError

from tests.close import close
from tests.core.exact_splines import sphere, torus
from tests.core.iges_files import IgesFile, labels, obj_text, surface_fields, unrolled

BALL = 4.0 / 3.0 * np.pi
DONUT = 2.0 * np.pi**2 * 0.75 * 0.25**2


def ball_lines() -> list[str]:
    """The lines of a file with a ball."""
    file = IgesFile()
    file.surface(unrolled(sphere()))
    return file.text().splitlines()


def read(tmp_path, lines):
    path = tmp_path / "a.igs"
    path.write_text("\n".join(lines) + "\n")
    return read_surfaces(path)


def torus_beside():
    """A file with a torus, and the fields of a ball to change and add."""
    file = IgesFile()
    file.surface(unrolled(torus()))
    return file, surface_fields(unrolled(sphere()))


def total(file):
    return measure_patches(file.bodies[0].patches).volume.total


def refusal(tmp_path, lines):
    with pytest.raises(FileError) as caught:
        read(tmp_path, lines)
    return caught.value.finding


@pytest.mark.parametrize("section", "GDP")
def test_file_without_a_section_is_refused(tmp_path, section):
    assert (
        refusal(tmp_path, [line for line in ball_lines() if line[72] != section]).code
        == "file_unrecognized"
    )


@pytest.mark.parametrize("letter", "BCX")
def test_letter_of_no_section_keeps_the_form_of_a_begun_file(tmp_path, letter):
    first, *rest = ball_lines()
    assert first[72] == "S"
    assert (
        refusal(tmp_path, [first, first[:72] + letter + first[73:], *rest]).code
        == "file_unrecognized"
    )
    assert close(total(read(tmp_path, [first, first, *rest])), BALL, 1e-14)


def test_parameters_of_another_entity_are_damage_despite_fit(tmp_path):
    file = IgesFile()
    file.surface(unrolled(sphere()), label="OTHER")
    file.surface(unrolled(torus()))
    lines = file.text().splitlines()
    at = next(number for number, line in enumerate(lines) if line[72] == "P")
    assert lines[at].startswith("128,")
    lines[at] = "126," + lines[at][4:]
    found = read(tmp_path, lines)
    assert [(one.code, labels(one.values)) for one in found.refused] == [
        ("surface_damaged", ["OTHER"])
    ]
    assert close(total(found), DONUT, 1e-14)


def test_blank_fields_of_the_directory_are_zero(tmp_path):
    """All fields except for the type and the place of the parameters."""
    lines = ball_lines()
    first, second = (number for number, line in enumerate(lines) if line[72] == "D")
    lines[first] = lines[first][:16].ljust(72) + lines[first][72:]
    lines[second] = lines[second][24:32].rjust(32).ljust(72) + lines[second][72:]
    assert close(total(read(tmp_path, lines)), BALL, 1e-14)


PYTHON_ONLY = ["1_0.0", "1_0", "nan", "inf", "\xb2", "0x1", "one"]


@pytest.mark.parametrize(
    "place, words, code",
    [
        *((-5, [word], "damaged") for word in [*PYTHON_ONLY, "1e400"]),
        (-5, ["1e38"], None),
        (-5, ["1e39"], "points"),
        *((2, degrees, "damaged") for degrees in [(0, 2), (2, 0), (-1, 2), (2, 3), (9, 9)]),
        *((place, [last], "damaged") for place in (0, 1) for last in (-1, -2, -9, 0)),
        *((0, [last, last], "damaged") for last in (-1, -2, -9, 0)),
    ],
)
def test_wrong_field_of_a_surface_is_refused_by_name(tmp_path, place, words, code):
    file, fields = torus_beside()
    for k, word in enumerate(words):
        fields[place + k] = word
    file.add(128, fields, label="WRONG")
    (tmp_path / "a.igs").write_bytes(file.text().encode("latin-1"))
    found = read_surfaces(tmp_path / "a.igs").refused
    wanted = [] if code is None else [("surface_" + code, ["WRONG"])]
    assert [(one.code, labels(one.values)) for one in found] == wanted


def test_a_boundary_of_no_curves_trims(tmp_path):
    file = IgesFile()
    base = file.surface(unrolled(sphere()), status="00010000")
    file.add(
        144, [base, 1, 0, file.add(142, [0, base, file.add(102, [0]), 0, 1], status="00010000")]
    )
    cause = refusal(tmp_path, file.text().splitlines()).values["causes"][0]
    assert cause["code"] == "surface_trimmed"


def obj(tmp_path, text):
    path = tmp_path / "a.obj"
    path.write_text(text)
    return read_surfaces(path)


@pytest.mark.parametrize("line", ["cstype", "", "cstype rat"])
def test_a_surface_of_no_stated_type_is_refused_as_such(tmp_path, line):
    text = obj_text([unrolled(sphere())])
    assert "cstype rat bspline" in text
    with pytest.raises(FileError) as caught:
        obj(tmp_path, text.replace("cstype rat bspline", line))
    (cause,) = caught.value.finding.values["causes"]
    base = "rat" if line.endswith("rat") else "cstype"
    assert (cause["code"], cause["values"]["base"]) == ("surface_unsupported", base)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("share, is_kept", [(1e-29, True), (1e-31, False)])
def test_weights_are_uneven_by_their_shares_of_the_largest(tmp_path, scale, share, is_kept):
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]
    lines = [
        "v {} {} {} {!r}".format(*corner, scale * w)
        for corner, w in zip(corners, (1.0, 0.5, share, 1.0))
    ]
    lines += [
        "cstype rat bezier",
        "deg 1 1",
        "surf 0 1 0 1 1 2 3 4",
        "parm u 0 1",
        "parm v 0 1",
        "end",
        "",
    ]
    if is_kept:
        assert obj(tmp_path, "\n".join(lines)).refused == ()
        return
    with pytest.raises(FileError) as caught:
        obj(tmp_path, "\n".join(lines))
    (cause,) = caught.value.finding.values["causes"]
    assert cause["code"] == "surface_points"
    assert cause["values"]["cause"]["code"] == "control_points_invalid"


@pytest.mark.parametrize("number", ["1", "4", "-4", "-1", "0", "5", "-5"])
def test_vertex_number_counts_only_earlier_vertices(tmp_path, number):
    lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 1 1 0", "cstype bezier", "deg 1 1"]
    lines += ["surf 0 1 0 1 1 2 3 " + number, "parm u 0 1", "parm v 0 1", "end", "v 7 7 7", ""]
    if number in ("0", "5", "-5"):
        with pytest.raises(FileError) as caught:
            obj(tmp_path, "\n".join(lines))
        assert caught.value.finding.values["causes"][0]["code"] == "surface_damaged"
        return
    (patch,) = obj(tmp_path, "\n".join(lines)).bodies[0].patches
    last = [(0.0, 0.0, 0.0), (1.0, 0.0, 1.0)][number in ("4", "-1")]
    assert close(patch.points[1, 1], last, 1e-14)
