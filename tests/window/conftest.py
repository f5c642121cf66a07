# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Blender into which the built zip is installed; without one the tests are skipped."""

import os
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.window import harness
from tools import extension

ROOT = Path(__file__).resolve().parent.parent.parent
CUBE = """\
import bpy, sys
bpy.ops.wm.read_homefile(use_factory_startup=True)
cube = bpy.data.objects["Cube"]
cube.location = (1.0, 2.0, 3.0)
bpy.ops.wm.save_as_mainfile(filepath=sys.argv[-1])
"""
# The armature `rig` of a human figure, active and selected, and its mesh `body`, alone in the
# scene.
FIGURE = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from tests.blender.figure import figure
for obj in list(bpy.data.objects):
    bpy.data.objects.remove(obj)
rig, body = figure()
rig.data.display_type = "STICK"
view = area.spaces.active.region_3d
"""
# A person opens them with a click on their headers; here they are registered anew, as panels that
# start open.
OPEN = """
import bpy
panels = bpy.types.Panel.__subclasses__()
for cls in [cls for cls in panels if cls.__name__.startswith("VIEW3D_PT_body_moments_")]:
    if "DEFAULT_CLOSED" in getattr(cls, "bl_options", set()):
        bpy.utils.unregister_class(cls)
        cls.bl_options = cls.bl_options - {"DEFAULT_CLOSED"}
        bpy.utils.register_class(cls)
"""


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(items):
    """A file is one session of a person: of a test that is selected, those before it in its file
    run too.
    """
    everything = list(items)
    yield
    selected = {item.path: item for item in items}  # the last one of each file
    ahead, done = set(), set()
    for item in everything:
        if (
            item.path.is_relative_to(ROOT / "tests" / "window")
            and item.path in selected
            and item.path not in done
        ):
            ahead.add(item)
            done |= {item.path} if item is selected[item.path] else set()
    kept = ahead.union(items)
    items[:] = [item for item in everything if item in kept]


@pytest.fixture(scope="session")
def blender() -> str:
    """The command of a real Blender."""
    command = os.environ.get("BLENDER") or shutil.which("blender")
    if command is None:
        pytest.skip(
            "needs a real Blender: put one on the PATH or name it with the variable BLENDER"
        )
    return command


@pytest.fixture(scope="session")
def run_blender(blender, tmp_path_factory):
    """Runs Blender without a window, in a user folder into which the built zip was installed."""
    user = tmp_path_factory.mktemp("user")

    def run(*arguments, check: bool = True) -> subprocess.CompletedProcess:
        done = subprocess.run(
            [blender, *map(str, arguments)],
            env={**os.environ, "BLENDER_USER_RESOURCES": str(user)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=1200,
        )
        assert not check or done.returncode == 0, f"{done.stdout}\n{done.stderr}"
        return done

    archive = extension.build(ROOT, tmp_path_factory.mktemp("dist"))
    install = ("--command", "extension", "install-file", "--repo", "user_default", "--enable")
    run("--background", *install, archive)
    run.blender, run.user = blender, user
    return run


@pytest.fixture(scope="session")
def cube_file(run_blender, tmp_path_factory) -> Path:
    """A file with Blender's cube, edges of 2 m, away from the origin."""
    folder = tmp_path_factory.mktemp("files")
    script, file = folder / "cube.py", folder / "cube.blend"
    script.write_text(CUBE, encoding="utf-8")
    run_blender("--background", "--python-exit-code", "1", "--python", script, "--", file)
    return file


@contextmanager
def open_window(run_blender, file: Path, folder: Path, **more):
    """Blender's window with a file in it; skips where there is no screen to show it on."""
    if missing := [tool for tool in harness.TOOLS if shutil.which(tool) is None]:
        pytest.skip("needs {}".format(", ".join(missing)))
    artefacts = ROOT / "tests" / "window" / "artefacts"
    artefacts.mkdir(exist_ok=True)
    log = folder / "blender.log"
    with harness.Window(
        run_blender.blender, run_blender.user, file, log, artefacts, **more
    ) as opened:
        yield opened
        assert "Traceback" not in opened.output()


@pytest.fixture(scope="module")
def window(run_blender, cube_file, tmp_path_factory):
    """Blender's window with the cube in it."""
    with open_window(run_blender, cube_file, tmp_path_factory.mktemp("log")) as opened:
        yield opened
