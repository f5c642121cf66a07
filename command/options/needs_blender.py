# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and options that need Blender, and their refusal in a Python without it. Standard library only."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from ...core.robots.formats import FORMATS as ROBOT_FORMATS
from ...core.scans.suffixes import scan_suffix
from ..supervisor.processes import has_blender
from .arguments import fail, words

NEEDS_BLENDER = "{} Blender: add --blender PATH, or install the bpy module"
MESHES = (".stl", ".ply", ".obj")  # formats that are measured without an import
_OF_OBJECTS = ("polynomial", "density_from", "fourier", "flat", "pose", "signature")


def options_of_blender(options: Namespace, is_scan: bool) -> list[str]:
    """Return the given options for which a mesh, or a scan, has to be an object in Blender."""
    robot = ["format"] * (options.format in ROBOT_FORMATS)
    if is_scan:
        return robot
    return [*(name for name in _OF_OBJECTS if getattr(options, name)), *boolean_and_wire(options), *robot]


def boolean_and_wire(options: Namespace) -> list[str]:
    """Return the given ones of the options --overlap union and --kind wire."""
    return ["overlap"] * (options.overlap == "union") + ["kind"] * (options.kind == "wire")


def check(options: Namespace, paths: Sequence[str]) -> None:
    """End with a message if a file or an option needs Blender, and there is none."""
    if has_blender():
        return
    for path in paths:
        is_scan = bool(scan_suffix(path))
        given = words(options_of_blender(options, is_scan))
        if given or not (is_scan or Path(path).suffix.lower() in MESHES):
            what = ", ".join(given) if given else "“{}”".format(path)
            fail(NEEDS_BLENDER.format(what + (" need" if len(given) > 1 else " needs")))
