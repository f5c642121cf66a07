# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the zip as a person does, uses it, and takes it away again.

    python installed.py ARCHIVE USER_FOLDER

Run in a process of its own: it needs a Blender that has never seen the add-on. The process ends
with `os._exit`, because bpy 4.5 can crash while the interpreter shuts down.
"""

import importlib.util
import json
import os
import sys
import tempfile
import traceback
from pathlib import Path

MODULE = "bl_ext.user_default.body_moments"
CUBE = {"body_volume": 8.0, "body_mass": 8000.0, "body_area": 24.0}


def enabled() -> bool:
    import bpy

    return MODULE in bpy.context.preferences.addons


def measure_a_cube() -> None:
    """The stored numbers of a cube with edges of 2 m and the density of water."""
    import bpy

    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(1.0, 2.0, 3.0))
    cube = bpy.context.active_object
    assert bpy.ops.object.body_moments_measure() == {"FINISHED"}
    for key, value in CUBE.items():
        assert abs(cube[key] / value - 1.0) < 1e-12, (key, cube[key])
    assert cube["body_method"] == "exact"
    bpy.data.objects.remove(cube)


def note_commands() -> dict:
    """Return the commands registered for `blender -c NAME` from now on, by name: the module cannot
    be started so.
    """
    import bpy

    noted, register = {}, bpy.utils.register_cli_command

    def register_and_note(name: str, execute):
        noted[name] = execute
        return register(name, execute)

    bpy.utils.register_cli_command = register_and_note
    return noted


def measure_files(command) -> None:
    """Call the command as Blender does, with a file that its children can measure and one that they
    cannot.
    """
    import bpy

    with tempfile.TemporaryDirectory() as folder:
        good, out = Path(folder, "cube.blend"), Path(folder, "out.json")
        bpy.ops.mesh.primitive_cube_add(size=2.0)
        bpy.ops.wm.save_as_mainfile(filepath=str(good), copy=True)
        bpy.data.objects.remove(bpy.context.active_object)
        bad = Path(folder, "bad.blend")
        bad.write_bytes(b"BLENDER garbage")
        assert command(["measure", str(good), str(bad), "--jobs", "1", "--output", str(out)]) == 1
        measured, refused = json.loads(out.read_text(encoding="utf-8"))
        assert (
            measured["status"] == "ok" and abs(measured["objects"][0]["volume"] / 8.0 - 1.0) < 1e-12
        )
        assert refused["status"] == "error" and measured["blender"] == ".".join(
            map(str, bpy.app.version)
        )
        assert command(["measure", "--kind", "gas", str(good)]) == 2


def use(archive: str) -> None:
    import bpy

    commands = note_commands()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    outcome = bpy.ops.extensions.package_install_files(
        filepath=archive, repo="user_default", enable_on_install=True
    )
    assert outcome == {"FINISHED"}
    assert enabled()
    assert MODULE in sys.modules
    assert "body_moments" not in sys.modules, "the repository's own files were imported"
    measure_a_cube()
    measure_files(commands["body_moments"])

    bpy.ops.preferences.addon_disable(module=MODULE)
    assert not enabled()
    assert not hasattr(bpy.types, "OBJECT_OT_body_moments_measure")
    assert not hasattr(bpy.types.Object, "body_moments")

    bpy.ops.preferences.addon_enable(module=MODULE)
    assert enabled()
    measure_a_cube()

    # a new file keeps the add-on, and what it needs while a file is loaded
    bpy.ops.wm.read_homefile(use_empty=True)
    assert enabled()
    measure_a_cube()

    # installing over itself is how an update arrives
    outcome = bpy.ops.extensions.package_install_files(
        filepath=archive, repo="user_default", enable_on_install=True, overwrite=True
    )
    assert outcome == {"FINISHED"}
    measure_a_cube()

    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.module == "user_default")
    installed = Path(repos[index].directory) / "body_moments"
    assert (installed / "blender_manifest.toml").is_file()
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="body_moments")
    assert not installed.exists()
    assert not enabled()
    assert not hasattr(bpy.types, "OBJECT_OT_body_moments_measure")


def main() -> int:
    archive, user = sys.argv[1:]
    Path(user).mkdir(parents=True)
    os.environ["BLENDER_USER_RESOURCES"] = user
    assert importlib.util.find_spec("body_moments") is None
    try:
        use(archive)
    except Exception:
        traceback.print_exc()
        return 1
    print("all steps passed")
    return 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
