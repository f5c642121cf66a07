# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files written by OpenCascade (`tools/make_iges.py`), against its own mass properties."""

import gzip
import json
import re
from pathlib import Path

import numpy as np
import pytest
from body_moments.core.cad.surface_file import read_surfaces
from body_moments.core.nurbs.solid import measure_patches
from body_moments.core.verdict import FileError

from tests.close import close

FOLDER = Path(__file__).parent / "kernel"
GPROP = json.loads((FOLDER / "gprop.json").read_text())
GPROP_RTOL = 4e-9  # It stops at this accuracy; its inertia of a torus has 2e-6.
BALL, RING = 4000.0 / 3.0 * np.pi, 1000.0 * np.pi**2
EXACT = {
    "box": 8000.0,
    "cylinder": 3000.0 * np.pi,
    "cone": 1560.0 * np.pi,
    "drilled": 8000.0 - 160.0 * np.pi,
}
EXACT |= {"sphere": BALL, "torus": RING, "sphere_solid": BALL, "drilled_solid": EXACT["drilled"]}
EXACT["apex_solid"] = 1000.0 * np.pi
SWEPT = {
    "cylinder": 500.0 * np.pi,
    "cone": 520.0 / 3.0 * np.pi,
    "apex": 120.0 * np.pi,
    "sphere": 500.0 / 3.0 * np.pi,
    "torus": 180.0 * np.pi**2,
    "tube": 3600.0 * np.pi,
    "wedge": 325.0,
    "nearly_round": 1525.0,
    "drilled": 8000.0 - 320.0 * np.pi,
    "fillet": 5880.0 + 30.0 * np.pi,
    # 3600 π - ∫ 4 √(9 - y²) (√(100 - y²) - √(25 - y²)) dy from -3 to 3, by mpmath
    "cap": 108.0 * np.pi,
    "cross": 11020.05259343911728728761,
    "touching": 6000.0 * np.pi - 16000.0 / 3.0,  # at two points
    "viviani": 144.0 * np.pi + 192.0,
    "hyperbola": 356.2395357501925,  # sections of a cone, by Gauss' rule
    "parabola": 239.9329818007843,
}


def kernel_file(name, tmp_path):
    path = tmp_path / (Path(name).name + ".igs")
    path.write_bytes(gzip.decompress((FOLDER / (name + ".igs.gz")).read_bytes()))
    return path


@pytest.mark.parametrize("name", GPROP)
def test_body_of_a_kernel_has_its_mass_properties(tmp_path, name):
    volume, area, center, inertia = GPROP[name]
    read = read_surfaces(kernel_file(name, tmp_path), for_blender=False)
    assert read.refused == () and read.unit == 1e-3
    body = measure_patches(read.bodies[0].patches, stored=read.bodies[0].rounding)
    assert body.method == "exact" and body.findings == () and body.health.components == 1
    assert close(body.volume.total, volume, GPROP_RTOL) and close(body.area.total, area, GPROP_RTOL)
    assert np.abs(body.volume.center - center).max() <= 1e-7
    second = body.volume.about_center().second()
    assert np.allclose(
        np.eye(3) * np.trace(second) - second, inertia, rtol=0.0, atol=4e-6 * np.max(inertia)
    )
    if name in EXACT:
        bound = body.volume.rounding_error[0] + body.volume.input_error[0]
        assert abs(body.volume.total - EXACT[name]) <= bound <= 1e-7 * volume


def is_within_bound(path, truth):
    read = read_surfaces(path, for_blender=False)
    assert read.refused == () and len(read.bodies) == 1
    body = measure_patches(read.bodies[0].patches, stored=read.bodies[0].rounding)
    assert body.method == "exact" and body.findings == ()
    bound = body.volume.rounding_error[0] + body.volume.input_error[0]
    return abs(body.volume.total - truth) <= bound <= 3e-8 * truth


@pytest.mark.parametrize("mode", ["faces", "solid"])
@pytest.mark.parametrize("name", SWEPT)
def test_swept_part_of_a_default_writer_is_within_bound(tmp_path, name, mode):
    path = kernel_file("swept/{}_{}".format(name, mode), tmp_path)
    assert is_within_bound(path, SWEPT[name])


def test_edges_in_parameters_alone_are_exact_or_refused(tmp_path):
    paths = [kernel_file("swept/touching_" + mode, tmp_path) for mode in ("solid", "faces")]
    for path in paths:  # The curves on the surface are left: those of a cylinder are in degrees.
        path.write_text(re.sub(r"(?m)^( *)104(?=,| .*D)", r"\g<1>112", path.read_text()))
    assert is_within_bound(paths[0], SWEPT["touching"])
    with pytest.raises(FileError, match="5 of the kind Trimmed Surface"):
        read_surfaces(paths[1], for_blender=False)
