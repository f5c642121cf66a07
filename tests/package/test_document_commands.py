# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands and Python examples printed in the documents, run as printed on small files."""

import doctest
import json
import os
import re
import shutil
import stat
import subprocess
import sys
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

from tests.package.parsed import parsed

bpy = pytest.importorskip("bpy")

ROOT = Path(__file__).resolve().parent.parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
PROGRAM = re.compile(r"^(\$ |… |blender -|python3? |mkdir |\.envs/)")
# Beginnings of commands that are not run, and the reason.
NOT_RUN = {
    "python3 tests/project.py": "sets up environments from the network; its words are parsed "
    "instead",
    "python3 -m venv": "makes an environment for the commands below",
    ".envs/mutants/bin/": "fetches packages from the network, and runs tests for a quarter of an "
    "hour",
}
USAGE = "[options]"
# The module of Blender in the place of Blender: it takes the same words behind `-c body_moments`,
# or behind `--`.
BLENDER = """\
#!/bin/sh
if [ "$1 $2 $3" = "-b -c body_moments" ]; then shift 3; exec "{python}" "{batch}" "$@"; fi
while [ "$1" != "--" ]; do
    if [ "$1" = "--python" ]; then script=$2; fi
    shift
done
shift
exec "{python}" "$script" "$@"
"""
CUBE_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
URDF = """<robot name="arm"><link name="base">
<inertial><mass value="8000"/>
<inertia ixx="5333.333333" iyy="5333.333333" izz="5333.333333" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="2 2 2"/></geometry></collision></link></robot>"""
MJCF = """<mujoco><worldbody><body name="finger"><freejoint/>
<inertial pos="0 0 0" mass="8000" diaginertia="5333.333333 5333.333333 5333.333333"/>
<geom type="box" size="1 1 1"/></body></worldbody></mujoco>"""


def commands_of(document: Path) -> list[str]:
    """The commands in indented blocks, without remarks, in their order; `…` stands for a measuring
    Blender.
    """
    commands, fenced = [], False
    for line in document.read_text(encoding="utf-8").splitlines():
        fenced ^= line.startswith("```")
        text = line.strip()
        if fenced or not line.startswith("    ") or not PROGRAM.match(text):
            continue
        text = re.split(r"\s{2,}|\s#\s", text.removeprefix("$ "))[0]
        commands.append(re.sub("^…", "blender -b -c body_moments", text))
    return commands


def runnable_of(document: Path) -> list[str]:
    return [
        text
        for text in commands_of(document)
        if USAGE not in text and not text.startswith(tuple(NOT_RUN))
    ]


def blocks_of(document: str, language: str = "python") -> list[str]:
    return re.findall(
        r"```{}\n(.*?)```".format(language),
        (ROOT / "docs" / document).read_text(encoding="utf-8"),
        re.S,
    )


def write_script(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def write_cube(path: Path, size: float = 1.0) -> None:
    """A cube in ASCII .stl."""
    corners = [(x, y, z) for x in (0.0, size) for y in (0.0, size) for z in (0.0, size)]
    lines = [f"solid {path.stem}"]
    for a, b, c, d in CUBE_FACES:
        for triangle in ((a, b, c), (a, c, d)):
            rows = "\n".join("vertex {} {} {}".format(*corners[i]) for i in triangle)
            lines.append(f"facet normal 0 0 0\nouter loop\n{rows}\nendloop\nendfacet")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([*lines, f"endsolid {path.stem}\n"]), encoding="utf-8")


def save_cube(path: Path, name: str) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    bpy.context.active_object.name = name
    path.parent.mkdir(parents=True, exist_ok=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)


def run(command: str, folder: Path) -> subprocess.CompletedProcess:
    paths = os.pathsep.join([str(folder / "bin"), os.environ["PATH"]])
    environment = {**os.environ, "PATH": paths, "HOME": str(folder / "home")}
    return subprocess.run(
        ["sh", "-c", command],
        cwd=folder,
        env=environment,
        capture_output=True,
        encoding="utf-8",
        timeout=300,
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder like a checkout, with the files that the documents name."""
    folder = tmp_path_factory.mktemp("documents")
    (folder / "operators").symlink_to(ROOT / "operators")
    python = f'#!/bin/sh\nexec "{sys.executable}" "$@"\n'
    for name in ("bin/python3", ".envs/blender-5.2/bin/python"):
        write_script(folder / name, python)
    write_script(
        folder / "bin/blender",
        BLENDER.format(python=sys.executable, batch=ROOT / "operators" / "batch.py"),
    )
    (folder / "home/ros/src").mkdir(parents=True)
    for name, size in (
        ("part", 40.0),
        ("boat", 2.0),
        ("parts/Bracket", 1.0),
        ("parts/Plate", 2.0),
        ("new/Rod", 3.0),
    ):
        write_cube(folder / f"{name}.stl", size)
    save_cube(folder / "part.blend", "Part")
    save_cube(folder / "demo/bracket.blend", "Bracket")
    header = (
        "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nendian: "
        "little\nspacings: 1 1 1\n\n"
    )
    (folder / "scan.nrrd").write_bytes(header.encode() + np.ones(64, "<f4").tobytes())
    (folder / "swing.py").write_text(blocks_of("tutorial-arm.md")[0])
    (folder / "arm.urdf").write_text(URDF)
    (folder / "gripper.xml").write_text(MJCF)
    done = run(
        "blender -b -c body_moments measure parts/ --format jsonl --output old.jsonl", folder
    )
    assert done.returncode == 0, done.stderr
    for name in ("part-1.jsonl", "part-2.jsonl", "new.jsonl"):
        shutil.copy(folder / "old.jsonl", folder / name)
    shutil.copy(folder / "old.jsonl.journal", folder / "all.jsonl.journal")
    return folder


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of POSIX")
@pytest.mark.parametrize(
    "document", [path for path in DOCUMENTS if runnable_of(path)], ids=lambda path: path.name
)
def test_commands_of_document_run_as_printed(document, made, tmp_path):
    """The commands of a page run in their order, in one folder: later ones use the files of earlier
    ones.
    """
    folder = tmp_path / "checkout"
    shutil.copytree(made, folder, symlinks=True)
    for command in runnable_of(document):
        done = run(command, folder)
        assert done.returncode == 0, f"{command}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
        if output := re.search(r"--output (\S+)", command):
            assert (folder / output[1]).stat().st_size, command


def test_commands_of_all_pages_are_found():
    """The pattern for commands must not go blind: the pages for pipelines have at least these
    many.
    """
    counts = {path.name: len(runnable_of(path)) for path in DOCUMENTS}
    least = {
        "README.md": 1,
        "agents.md": 2,
        "batch.md": 9,
        "command-line.md": 2,
        "robots.md": 2,
        "shape.md": 2,
        "tutorial-library.md": 4,
    }
    assert all(counts[name] >= count for name, count in least.items())


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_project_commands_have_known_words(document):
    for command in commands_of(document):
        if command.startswith("python3 tests/project.py "):
            assert parsed(*command.split()[2:]), command


@pytest.mark.parametrize(
    "workflow", sorted((ROOT / ".github" / "workflows").glob("*.yml")), ids=lambda path: path.name
)
def test_project_commands_of_workflow_have_known_words(workflow):
    for words in re.findall(
        r"python3? tests/project\.py (.*)", workflow.read_text(encoding="utf-8")
    ):
        assert parsed(*words.split()), words


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of POSIX")
def test_corner_of_the_hypercube_has_the_printed_moments(made, tmp_path):
    folder = tmp_path / "checkout"
    shutil.copytree(made, folder, symlinks=True)
    *_, record = [
        run(command, folder).stdout for command in runnable_of(ROOT / "docs" / "command-line.md")
    ]
    moments = json.loads(record)["moments"]
    assert moments["0,0,0,0"] == pytest.approx(1 / 24, rel=1e-14)
    assert moments["1,0,0,0"] == pytest.approx(1 / 120, rel=1e-14)


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of POSIX")
@pytest.mark.parametrize("simulator", ["mujoco", "pybullet", "newton"])
def test_arm_of_the_tutorial_falls_as_printed(made, tmp_path, simulator):
    """Pythons with simulators: this one, that of the tests of robots, and those that
    BODY_MOMENTS_SIMULATORS names.
    """
    named = os.environ.get("BODY_MOMENTS_SIMULATORS", "").split(os.pathsep)
    pythons = [
        sys.executable,
        str(ROOT / ".envs" / "robots" / "bin" / "python"),
        *filter(None, named),
    ]
    finds = "import importlib.util, sys; sys.exit(importlib.util.find_spec('{}') is None)".format(
        simulator
    )
    able = [
        one
        for one in pythons
        if Path(one).exists() and not subprocess.run([one, "-c", finds]).returncode
    ]
    if not able:
        pytest.skip("needs a simulator: " + simulator)
    folder = tmp_path / "checkout"
    shutil.copytree(made, folder, symlinks=True)
    for command in runnable_of(ROOT / "docs" / "tutorial-arm.md"):
        assert run(command, folder).returncode == 0, command
    (code,) = [
        block for block in blocks_of("tutorial-arm.md") if "import {}\n".format(simulator) in block
    ]
    done = subprocess.run([able[0], "-c", code], cwd=folder, capture_output=True, encoding="utf-8")
    (printed,) = blocks_of("tutorial-arm.md", "text")
    assert done.returncode == 0 and done.stdout.splitlines()[-1].endswith(": " + printed.strip()), (
        done
    )


def test_python_for_blender_prints_the_cubes_moments(registered, capsys):
    """The example of docs/python.md that needs Blender, under the name that the add-on has in the
    tests.
    """
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    text = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    (example,) = [
        block for block in re.findall(r"```python\n(.*?)```", text, re.S) if "bpy" in block
    ]
    exec(
        compile(
            example.replace("bl_ext.user_default.body_moments", "body_moments"), "python.md", "exec"
        ),
        {},
    )
    mass, numbers = capsys.readouterr().out.strip().splitlines()[-2:]
    assert float(mass) == pytest.approx(8000.0)
    assert numbers.startswith("exact") and float(numbers.split()[-2]) == pytest.approx((2 / 5) ** 3)


def test_notebook_example_prints_and_draws_a_part(registered, capsys, tmp_path, monkeypatch):
    """A stand-in for matplotlib takes the lines; the numbers are those of a cube of 40 mm."""
    write_cube(tmp_path / "part.stl", 40.0)
    monkeypatch.chdir(tmp_path)
    plt = MagicMock()
    for name in ("matplotlib", "matplotlib.pyplot"):
        monkeypatch.setitem(sys.modules, name, plt)
    plt.pyplot = plt
    examples = [
        block for block in blocks_of("python.md") if "part.stl" in block or "matplotlib" in block
    ]
    exec(compile("\n".join(examples), "python.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "exact []" and lines[1].startswith("mass 0.1728 kg, center [0.02 0.02 0.02]")
    drawn = plt.figure.return_value.add_subplot.return_value.plot.call_args_list
    assert len(drawn) == 3 and np.ptp(np.transpose(drawn[0].args), axis=0).max() < 0.04


def test_agents_get_the_printed_answer(registered, capsys):
    """The Python of docs/agents.md, and the text that it says is printed."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    text = (ROOT / "docs" / "agents.md").read_text(encoding="utf-8")
    code = "\n".join(re.findall(r"```python\n(.*?)```", text, re.S))
    exec(
        compile(
            code.replace("bl_ext.user_default.body_moments", "body_moments"), "agents.md", "exec"
        ),
        {},
    )
    (printed,) = re.findall(r"```text\n(.*?)```", text, re.S)
    assert capsys.readouterr().out.endswith(printed)
    assert "body_mass" not in bpy.data.objects["Cube"]


@pytest.mark.usefixtures("registered")
def test_examples_for_users_of_other_libraries_run_as_printed():
    text = (ROOT / "docs" / "coming-from.md").read_text(encoding="utf-8")
    examples = "\n".join(re.findall(r"```python\n(.*?)```", text, re.S))
    test = doctest.DocTestParser().get_doctest(examples, {}, "coming-from.md", None, 0)
    failed, attempted = doctest.DocTestRunner().run(test)
    assert not failed and attempted > 20
