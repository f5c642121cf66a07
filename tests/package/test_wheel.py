# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel in an environment that has numpy alone, once the oldest numpy that it states and once
the newest.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from tests.core.mesh_files import ply, stl

ROOT = Path(__file__).resolve().parent.parent.parent
# 1.26 is made for no newer Python
NUMPY = "numpy==1.26.0" if sys.version_info < (3, 12) else "numpy"

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
quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
quads = np.array(quads)
triangles = np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
assert 'Moments' in dir(body_moments)
body = body_moments.mass_properties(points, triangles, density=2.0)
assert abs(body.mass_properties.mass - 2.0) < 1e-14
"""

POINTS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
QUADS = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
)
TRIANGLES = np.vstack([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])


def run(
    command: list, variables: Mapping[str, str] | None = None, **options
) -> subprocess.CompletedProcess:
    """Run a command that sees neither the project nor the packages of this Python."""
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith("PYTHON")
    }
    environment |= variables or {}
    return subprocess.run(
        command, capture_output=True, encoding="utf-8", env=environment, **options
    )


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
    assert (
        max(abs(np.ptp(found["principal_moments"])), abs(found["inertia"][0][0] - 1000.0 / 6.0))
        < 1e-9
    )


def test_the_command_tells_what_needs_blender(scripts, tmp_path):
    (tmp_path / "scene.blend").write_bytes(b"BLENDER")
    done = run([scripts / "body-moments", "measure", "scene.blend"], cwd=tmp_path)
    assert done.returncode == 2
    assert "--blender" in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="the action's shell is bash")
def test_action_fails_for_an_impossible_robot(scripts, tmp_path):
    """Its commands as a runner starts them: in the workspace, with its variables and the defaults
    of the inputs.
    """
    action = (ROOT / "action.yml").read_text(encoding="utf-8")
    inputs = dict(
        re.findall(r"^  ([\w-]+):\n    description: .*\n    default: (.*)$", action, re.MULTILINE)
    )
    variables = re.findall(r"^ +(\w+): \$\{\{ inputs\.([\w-]+) \}\}$", action, re.MULTILINE)
    environment = {name: inputs.pop(source).strip('"') for name, source in variables}
    assert environment["PATHS"] == "." and not inputs
    workspace, step = tmp_path / "workspace", tmp_path / "step.sh"
    for name, path in (
        ("ACTION_PATH", ROOT),
        ("WORKSPACE", workspace),
        ("OUTPUT", tmp_path / "output"),
    ):
        environment["GITHUB_" + name] = str(path)
    environment["PATH"] = "{}:/usr/bin:/bin".format(scripts)
    workspace.mkdir()
    (workspace / "cube.urdf").write_text(URDF, encoding="utf-8")
    results = []
    for command in re.findall(r"^ +run: (.*)$", action, re.MULTILINE):
        for level in ("error", "never"):
            step.write_text(command, encoding="utf-8")
            bash = ["bash", "--noprofile", "--norc", "-eo", "pipefail", step]
            results.append(run(bash, {**environment, "FAIL_ON": level}, cwd=workspace))
    assert [done.returncode for done in results] == [0, 0, 1, 0], [done.stderr for done in results]
    assert "::error file=cube.urdf,line=3,col=5," in results[2].stdout


def test_pre_commit_refuses_an_impossible_robot(scripts, tmp_path):
    """pre-commit itself installs the hook from this repository, and runs it on files that are
    added.
    """
    run([scripts / "python", "-m", "pip", "install", "pre-commit"], check=True)
    run(["git", "init", "-q", tmp_path], check=True)
    for text, code in (
        (URDF, 1),
        (URDF.replace("1000", "5333.333").replace("9000", "5333.333"), 0),
    ):
        (tmp_path / "cube.urdf").write_text(text, encoding="utf-8")
        run(["git", "add", "cube.urdf"], cwd=tmp_path, check=True)
        hook = [scripts / "pre-commit", "try-repo", ROOT, "body-moments-audit"]
        done = run(hook, {"PRE_COMMIT_HOME": str(tmp_path / "hooks")}, cwd=tmp_path)
        assert done.returncode == code and ("cube.urdf:3:5: error" in done.stdout) == bool(code), (
            done.stdout
        )
