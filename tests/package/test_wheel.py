# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel in an environment that has numpy alone, once the oldest numpy that it states and once the newest."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.core.mesh_files import ply, stl

ROOT = Path(__file__).resolve().parent.parent.parent
NUMPY = "numpy==1.26.0" if sys.version_info < (3, 12) else "numpy"  # 1.26 is made for no newer Python

# No body has an inertia about z that exceeds the sum of the other two.
URDF = """\
<robot name="cube">
  <link name="base">
    <inertial>
      <mass value="8000"/>
      <inertia ixx="1000" iyy="1000" izz="9000" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision><geometry><box size="2 2 2"/></geometry></collision>
  </link>
</robot>
"""
USED = """\
import sys
import body_moments
assert not {"numpy", "bpy"} & set(sys.modules)
import numpy as np
points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
assert 'Moments' in dir(body_moments)
assert abs(body_moments.mass_properties(points, triangles, density=2.0).mass_properties.mass - 2.0) < 1e-14
"""

POINTS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
QUADS = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
TRIANGLES = np.vstack([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])


def run(command: list, **options) -> subprocess.CompletedProcess:
    """Run a command that sees neither the project nor the packages of this Python."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(command, capture_output=True, encoding="utf-8", env=environment, **options)


@pytest.fixture(scope="module")
def scripts(tmp_path_factory) -> Path:
    """The folder of commands of an environment with the wheel and numpy."""
    folder = tmp_path_factory.mktemp("wheel")
    made = run([sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", folder, ROOT])
    assert made.returncode == 0, made.stderr
    (wheel,) = folder.glob("body_moments-*-py3-none-any.whl")
    assert wheel.stat().st_size < 2e6
    run([sys.executable, "-m", "venv", folder / "empty"], check=True)
    scripts = folder / "empty" / ("Scripts" if os.name == "nt" else "bin")
    installed = run([scripts / "python", "-m", "pip", "install", "--prefer-binary", wheel, NUMPY])
    assert installed.returncode == 0, installed.stderr
    return scripts


def test_arrays_are_measured_with_numpy_alone(scripts, tmp_path):
    done = run([scripts / "python", "-c", USED], cwd=tmp_path)
    assert done.returncode == 0, done.stderr


def test_a_robot_is_audited_without_blender(scripts, tmp_path):
    (tmp_path / "cube.urdf").write_text(URDF, encoding="utf-8")
    done = run([scripts / "body-moments", "audit", "cube.urdf"], cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert "base" in done.stdout


@pytest.mark.parametrize("name", ["cube.stl", "cube.ply", "cube.obj", "cube.npy"])
def test_a_file_is_measured_without_blender(scripts, tmp_path, name):
    files = {"cube.stl": stl((POINTS, TRIANGLES)), "cube.ply": ply(POINTS, TRIANGLES)}
    rows = [("v {} {} {}\n", POINTS.tolist()), ("f {} {} {}\n", (TRIANGLES + 1).tolist())]
    files["cube.obj"] = "".join(form.format(*row) for form, part in rows for row in part).encode()
    for each, data in files.items():
        (tmp_path / each).write_bytes(data)
    np.save(tmp_path / "cube.npy", np.full((2, 2, 2), 1000.0))
    words = ["--density", "1000"] if name != "cube.npy" else ["--spacing", "0.5,0.5,0.5"]
    done = run([scripts / "body-moments", "measure", name, *words], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    (found,) = document["objects"]
    assert document["blender"] is None and abs(found["mass"] - 1000.0) < 1e-9
    assert max(abs(np.ptp(found["principal_moments"])), abs(found["inertia"][0][0] - 1000.0 / 6.0)) < 1e-9


def test_the_command_tells_what_needs_blender(scripts, tmp_path):
    (tmp_path / "scene.blend").write_bytes(b"BLENDER")
    done = run([scripts / "body-moments", "measure", "scene.blend"], cwd=tmp_path)
    assert done.returncode == 2
    assert "--blender" in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="the action's shell is bash")
def test_the_action_and_the_hook_fail_for_an_impossible_robot(scripts, tmp_path):
    """Their command lines, as they stand in the files, in the environment that both install."""
    (tmp_path / "cube.urdf").write_text(URDF, encoding="utf-8")
    action, hook = ((ROOT / name).read_text(encoding="utf-8") for name in ("action.yml", ".pre-commit-hooks.yaml"))
    inputs = {"PATHS": ".", "FAIL_ON": "error", "OPTIONS": "", "PATH": "{}:/usr/bin:/bin".format(scripts)}
    step = action.rpartition("run: ")[2]
    done = subprocess.run(["bash", "-e", "-c", step], env=inputs, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1 and "::error file=cube.urdf" in done.stdout, done.stdout + done.stderr
    done = subprocess.run(["bash", "-c", step], env={**inputs, "FAIL_ON": "never"}, cwd=tmp_path, capture_output=True)
    assert done.returncode == 0
    (entry,) = [line.partition("entry: ")[2] for line in hook.splitlines() if "entry: " in line]
    command, *options = entry.split()
    done = run([scripts / command, *options, "cube.urdf"], cwd=tmp_path)
    assert done.returncode == 1 and "cube.urdf" in done.stdout
