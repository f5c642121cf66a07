# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""IGES files, and .obj files with surfaces, on the command line."""

import tarfile

import numpy as np
import pytest

from tests.blender.batch_files import document, measured
from tests.close import close
from tests.core.exact_splines import sphere, torus
from tests.core.iges_files import IgesFile, obj_text, unrolled

pytestmark = pytest.mark.usefixtures("scene")
BALL = 4.0 / 3.0 * np.pi
DONUT = 2.0 * np.pi**2 * 0.75 * 0.25**2


@pytest.mark.parametrize("end", [".igs", ".iges", ".IGS"])
def test_an_iges_body_in_its_own_unit(tmp_path, end):
    file = IgesFile(2)
    file.surface(unrolled(sphere()))
    entry = measured(file.write(tmp_path / ("ball" + end)), "--density", "1")
    assert (entry["name"], entry["method"]) == ("ball", "NURBS exact")
    assert close(entry["volume"], BALL * 1e-9, 1e-14)
    assert not {"surfaces_rounded", "unit_assumed", "faces_not_read"} & {
        found["code"] for found in entry["findings"]
    }


def test_refused_entity_is_an_error_beside_other_records(tmp_path):
    file = IgesFile()
    file.surface(unrolled(sphere()))
    file.add(114, [1, 3, 0.0, 1.0], label="VASE")
    found = document(file.write(tmp_path / "a.igs"), "--density", "1")
    assert [entry["name"] for entry in found["objects"]] == ["a"]
    (error,) = found["errors"]
    assert "VASE" in error["reason"] and "Parametric Spline Surface (114)" in error["reason"]
    assert [
        found["values"]["count"]
        for found in found["objects"][0]["findings"]
        if found["code"] == "faces_not_read"
    ] == [1]


def test_refused_faces_of_a_body_are_the_only_error(tmp_path):
    file = IgesFile()
    line = file.add(110, [1.0, 0.0, 0.0, 1.0, 0.0, 2.0])
    file.add(122, [line, 2.0, 0.0, 0.0])
    file.add(114, [1, 3, 0.0, 1.0], label="VASE")
    found = document(file.write(tmp_path / "a.igs"), "--density", "1")
    (error,) = found["errors"]
    assert not found["objects"] and "VASE" in error["reason"]


CUBE = "o Cube\n" + "".join(
    "v {} {} {}\n".format(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)
)
FACES = "f -8 -7 -5 -6\nf -4 -2 -1 -3\nf -8 -4 -3 -7\nf -6 -5 -1 -2\nf -8 -6 -2 -4\nf -7 -3 -1 -5\n"


def test_faces_and_surfaces_of_one_file(tmp_path):
    path = tmp_path / "both.obj"
    path.write_text(obj_text([unrolled(torus())], name="Ring") + CUBE + FACES)
    found = document(path, "--density", "1")
    volumes = {entry["name"]: entry["volume"] for entry in found["objects"]}
    assert set(volumes) == {"Ring", "Cube"}
    assert close(volumes["Ring"], DONUT, 4e-7) and close(volumes["Cube"], 1.0, 1e-7)
    path.write_text(
        obj_text([unrolled(torus())]).replace("end\n", "trim 0 1 1\nend\n") + CUBE + FACES
    )
    found = document(path, "--density", "1")
    assert [entry["name"] for entry in found["objects"]] == ["Cube"] and "trimmed" in found[
        "errors"
    ][0]["reason"]


def test_damaged_step_solid_is_the_only_error_beside_a_record(tmp_path):
    with tarfile.open("tests/core/cad/kernel/step.tar.xz") as archive:
        text = archive.extractfile("assembly_inch.step").read()
    path = tmp_path / "parts.stp"
    path.write_bytes(text.replace(b"CYLINDRICAL_SURFACE", b"BOUNDED_SURFACE"))
    for options in ([], ["--pose"]):
        found = document(path, "--density", "1", *options)
        (error,) = found["errors"]
        assert "ADVANCED_FACE" in error["reason"] and "BOUNDED_SURFACE" in error["reason"]
        assert [entry["name"] for entry in found["objects"]] == ["Plätte"]
        assert close(found["objects"][0]["volume"], 2.4e-6, 1e-11)
