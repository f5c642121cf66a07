# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opening of a user's file as the scene, which raises FileError with the reason if it fails.

Every file starts from an empty scene of factory settings. Scripts inside .blend files never run.
Files that Blender's importers accept silently are refused: a FIFO (it would block for ever), a file
without objects.
"""

import gzip
import os
import re
import sys
import zlib
from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import takewhile

import bpy

from ...core.files import FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...core.verdict import FileError, Finding, finding, system_reason
from ..findings import FILE_NEWER_VERSION, FILE_VERSION_UNSUPPORTED
from ..supervisor.listing import BLEND, USD
from . import finite, placing, suffixes
from .import_fbx import import_fbx
from .import_gltf import import_gltf
from .import_usd import import_usd
from .importers import import_3mf, import_cad, import_mesh, import_obj
from .references import Opened

_OLDEST = (2, 50)  # Reading files of older versions can damage their content.
_KNOWN_FORMAT = 1  # version of the .blend format
_TRACEBACK = "Traceback (most recent call last)"
_BLEND_WORD = re.compile(r"\.blend\d*$", re.IGNORECASE)

_ANIMATED: dict[str, Callable[[str, float | None], Opened]] = {
    ".fbx": import_fbx,
    ".glb": import_gltf,
    ".gltf": import_gltf,
} | dict.fromkeys(USD, import_usd)
_IMPORTERS: dict[str, Callable[[str], object]] = {
    ".stl": import_mesh,
    ".ply": import_mesh,
    ".obj": import_obj,
    ".3mf": import_3mf,
    ".igs": import_cad,
    ".iges": import_cad,
    ".step": import_cad,
    ".stp": import_cad,
}


def open_file(path: str | None, frame: float | None = None) -> Opened:
    """Open a file, or take the open one without a path, as the scene at a frame, by default the
    first of an imported file, and return the findings about it. Raises FileError.
    """
    if path is None and open_name() and not bpy.data.filepath:
        raise FileError(FILE_UNREADABLE, error="it is missing or incomplete")
    kind = BLEND if path is None else suffixes.file_suffix(path)
    try:
        if path is not None:
            suffixes.check_file(path)
            finite.check_numbers(path, kind)
        if kind != BLEND:
            return _imported(os.path.abspath(path or ""), kind, frame)
        if path is not None:  # it replaces the open scene
            _open_blend(os.path.abspath(path))
        return Opened() if frame is None else Opened(notes=placing.measure_at(frame))
    except (OSError, RuntimeError) as error:  # such as from a failing disk
        raise FileError(FILE_UNREADABLE, error=reason(error)) from error


def _imported(path: str, kind: str, frame: float | None) -> Opened:
    """Import a file into an empty scene, and return the findings about it; objects that it does not
    show are not rendered. Raises FileError, OSError and RuntimeError.
    """
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    try:
        findings = _ANIMATED[kind](path, frame) if kind in _ANIMATED else _IMPORTERS[kind](path)
    except AttributeError as error:  # `bpy.ops` has no such operator.
        fault = "it has no importer for {} files".format(kind)
        raise FileError(FILE_UNREADABLE, error=fault) from error
    opened = findings if isinstance(findings, Opened) else Opened()
    for name in opened.hidden:
        bpy.data.objects[name].hide_render = True
    if not bpy.context.scene.objects:
        raise FileError(
            opened.errors[0] if opened.errors else finding(FILE_WITHOUT_OBJECTS, content="objects")
        )
    return opened


def _open_blend(path: str) -> None:
    try:
        # With the interface, so that saving the file again keeps its windows and workspaces.
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=True, use_scripts=False)
    except RuntimeError as error:
        version = _saved_by(path)
        if version is None or _OLDEST <= version <= tuple(bpy.app.version[:2]):
            raise
        values = {
            "blender": bpy.app.version_string,
            "version": "{}.{}".format(*version) if version > (0, 0) else "-",
        }
        raise FileError(FILE_VERSION_UNSUPPORTED, **values) from error


def _saved_by(path: str) -> tuple[int, int] | None:
    """Return the version of Blender in the header of a .blend file not compressed with zstd.

    Return (0, 0) for big-endian numbers, (99, 0) for a file format of the future, and None if there
    is no such header.
    """
    with open(path, "rb") as file:
        head = file.read(20)
    if head.startswith(b"\x1f\x8b"):
        with suppress(OSError, EOFError, zlib.error), gzip.open(path) as unpacked:
            head = unpacked.read(20)
    old = re.match(rb"BLENDER[-_]([vV])(\d)(\d\d)", head)
    new = re.match(rb"BLENDER\d\d-(\d\d)v(\d\d)(\d\d)", head)
    if old:
        return (0, 0) if old[1] == b"V" else (int(old[2]), int(old[3]))
    if new:
        return (99, 0) if int(new[1]) > _KNOWN_FORMAT else (int(new[2]), int(new[3]))
    return None


def newer_version() -> Iterator[Finding]:
    """Yield a finding if a newer Blender saved the open file."""
    version = tuple(bpy.data.version[:2])
    if version > tuple(bpy.app.version[:2]):
        yield finding(
            FILE_NEWER_VERSION, version="{}.{}".format(*version), blender=bpy.app.version_string
        )


def reason(error: Exception) -> str:
    """Return an error of the system or of Blender as one line.

    The line is the first of a report, or the exception of a traceback, which Blender may follow
    with its location.
    """
    if isinstance(error, OSError):
        return system_reason(error)
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if not lines:
        return type(error).__name__
    # In a traceback, the exception's line follows the indented lines of its frames.
    if any(_TRACEBACK in line for line in lines):
        lines = [line.rstrip() for line in str(error).splitlines()]
        last = max(
            number
            for number, line in enumerate(lines)
            if _TRACEBACK in line or line.startswith("  ")
        )
        lines = lines[last + 1 :] or [type(error).__name__]
        return "its importer failed, {}".format(lines[0].rstrip("."))
    return lines[0].removeprefix("Error: ").removeprefix("Python: ").rstrip(".")


def open_name() -> str | None:
    """Return the name of the open file, else of the .blend file that Blender was started with, None
    if there is none.

    Blender runs a command on its start-up scene if it cannot open the file.
    """
    blender_words = takewhile(lambda word: word not in ("-c", "--command", "--"), sys.argv[1:])
    blend_files = (
        word for word in blender_words if _BLEND_WORD.search(word) and not word.startswith("-")
    )
    return bpy.data.filepath or next(blend_files, None)
