# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Check for finite coordinates in a file, before Blender imports it.

Blender's importers of .stl, .obj, .ply, .glb, .gltf and .fbx silently replace a coordinate that is NaN, infinite, too
large for float32, or (in a text) no number, by 0 or the vertex before: a wrong body would be measured as exact. Files
are mapped and checked in blocks. Numbers that place no point (normals, colors, weights) may be NaN and infinite. Files
with other damage are left to Blender, which reports it.
"""

from __future__ import annotations

from collections.abc import Callable

from ....core.cad.obj_text import check_obj_text
from ....core.streams.misread import Data, map_file
from .fbx import check_fbx
from .gltf import Buffers, check_gltf, unquote

__all__ = ["Buffers", "check_numbers", "unquote"]


def check_numbers(path: str, kind: str) -> None:
    """Raise FileError if a coordinate in the file is not a finite number. kind: the file's suffix. Raises OSError."""
    check = _CHECKS.get(kind)
    if check is not None:
        check(map_file(path), path)


_CHECKS: dict[str, Callable[[Data, str], None]] = {
    ".obj": lambda data, _path: check_obj_text(data),
    **dict.fromkeys((".glb", ".gltf"), check_gltf),
    ".fbx": check_fbx,
}
