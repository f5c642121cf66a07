# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's file becomes the open scene, or a sentence that says why it cannot.

Every file starts from an empty scene of factory settings, so that nothing of the one before it, or
of a person's own start-up file, is measured with it. Scripts inside .blend files never run. What
Blender's importers let through without a word is refused here: a FIFO (it would block for ever), an
STL cut short (read as an empty mesh, or as half of one), a file in which no object is found.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from pathlib import Path

import addon_utils
import bpy

from ...core.scans import formats as scans

BLEND = ".blend"
UNITLESS = (".stl", ".obj", ".ply")

# Invisible prims are imported hidden, and a hidden object is reported; left out, it would be
# missing without a word. Bone shapes are objects of the importer's own making.
_IMPORTERS: dict[str, Callable[[str], object]] = {
    ".stl": lambda path: bpy.ops.wm.stl_import(filepath=path),
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_import(filepath=path),
    ".fbx": lambda path: bpy.ops.wm.fbx_import(filepath=path),
    **dict.fromkeys(
        (".glb", ".gltf"),
        lambda path: bpy.ops.import_scene.gltf(filepath=path, disable_bone_shape=True),
    ),
    **dict.fromkeys(
        (".usd", ".usda", ".usdc", ".usdz"),
        lambda path: bpy.ops.wm.usd_import(filepath=path, import_visible_only=False),
    ),
}


class Unusable(Exception):
    """A file that cannot be opened or saved. Its text is a sentence for the person who gave it."""


def suffix(path: str) -> str:
    """What the file's name ends with, in lower case."""
    return scans.suffix(path) or Path(path.lower()).suffix


def open_file(path: str) -> None:
    """Make a file the open scene. Raises Unusable."""
    kind = suffix(path)
    _check(path, kind)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    absolute = os.path.abspath(path)
    try:
        if kind == BLEND:
            # With the interface, so that saving the file again keeps its windows and workspaces.
            bpy.ops.wm.open_mainfile(filepath=absolute, load_ui=True, use_scripts=False)
            return
        if kind in (".glb", ".gltf"):
            # An add-on that comes with Blender, and may be switched off.
            addon_utils.enable("io_scene_gltf2")
        _IMPORTERS[kind](absolute)
    except AttributeError as error:
        raise Unusable("This Blender was built without an importer of {} files.".format(kind)) from error
    except RuntimeError as error:
        raise Unusable("Blender cannot read the file: {}.".format(reason(error))) from error
    if not bpy.context.scene.objects:
        raise Unusable("Blender finds no object in the file; check that it really is {}.".format(kind))


def _check(path: str, kind: str) -> None:
    if os.path.isdir(path):
        raise Unusable("This is a folder; name the files in it.")
    if kind != BLEND and kind not in _IMPORTERS:
        known = " ".join((BLEND, *_IMPORTERS, *scans.SUFFIXES))
        raise Unusable("Files of this kind cannot be measured; these can: {}.".format(known))
    if not os.path.exists(path):
        raise Unusable("There is no such file.")
    if not os.path.isfile(path):
        raise Unusable("This is not a regular file.")
    try:
        with open(path, "rb") as file:
            head = file.read(84)
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - 1024))
            tail = file.read()
    except OSError as error:
        raise Unusable("The file cannot be read: {}.".format(error.strerror)) from error
    if not size:
        raise Unusable("The file is empty.")
    if kind == ".stl":
        _check_stl(head, tail, size)


def _check_stl(head: bytes, tail: bytes, size: int) -> None:
    """Blender takes a file of exactly the promised size as binary, any other as text, and says
    nothing of what is lost.
    """
    if len(head) == 84 and size == 84 + 50 * struct.unpack_from("<I", head, 80)[0]:
        return
    if not head.lstrip().lower().startswith(b"solid"):
        raise Unusable(
            "The STL file is cut short or damaged: its size does not fit the number of triangles that it promises."
        )
    if b"endsolid" not in tail.lower():
        raise Unusable('The STL file is cut short: its last line, "endsolid", is missing.')


def reason(error: Exception) -> str:
    """What Blender said, as one line: the first line of a report, the last of a traceback."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if not lines:
        return type(error).__name__
    line = lines[-1] if any(line.startswith("Traceback") for line in lines) else lines[0]
    return line.removeprefix("Error: ").removeprefix("Python: ").rstrip(".")
