# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual that the extension brings: *Online Manual* of its buttons and settings, and an entry in *Help*.

It is HTML beside the add-on's code, which the build makes of docs/; without it, in a checkout, there is neither.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path

import bpy
from bpy.types import Context, Menu

_PACKAGE = __package__.rpartition(".")[0]
_OBJECT, _SCENE = "bpy.types.bodymomentsobjectsettings.", "bpy.types.bodymomentsscenesettings."
_OPERATOR = "bpy.ops.object.body_moments_"

# The first pattern that fits a button or a setting, in lower case, and its page.
PAGES = (
    *((_OBJECT + name + "*", "walls.html") for name in ("wall", "thickness")),
    *(
        (_OBJECT + name + "*", "volumes-and-scans.html")
        for name in ("grid", "values_from", "value_", "transfer", "spline")
    ),
    *((_OBJECT + name + "*", "densities.html") for name in ("density", "material", "mass")),
    ("bpy.types.bodymomentsmaterialsettings*", "densities.html"),
    (_SCENE + "moments*", "moments.html"),
    *((_OPERATOR + name + "*", "moments.html") for name in ("compute_moments", "copy_moments")),
    *((_OPERATOR + name + "*", "sections.html") for name in ("measure_section", "copy_section")),
    *((_OPERATOR + name + "*", "shape.html") for name in ("find", "match", "select_found")),
    *((_OPERATOR + name + "*", "densities.html") for name in ("set_material", "preset")),
    ("bpy.ops.material.body_moments*", "densities.html"),
    (_OPERATOR + "fourier*", "fourier.html"),
    (_OPERATOR + "import_scan*", "volumes-and-scans.html"),
    *((_OPERATOR + name + "*", "reading-the-numbers.html") for name in ("measure", "clear", "copy", "select_faults")),
    ("bpy.ops.*.body_moments_*", "actions.html"),
    ("bpy.types.bodymoments*", "reading-the-numbers.html"),
)


def folder() -> Path:
    """Return the folder of the manual, which need not exist."""
    return Path(sys.modules[_PACKAGE].__path__[0]) / "manual"


def _map() -> tuple[str, tuple[tuple[str, str], ...]]:
    return folder().as_uri() + "/", PAGES


def _help_entry(self: Menu, _context: Context) -> None:
    page = folder() / "index.html"
    self.layout.separator()
    self.layout.operator("wm.url_open", text="Body Moments Manual", icon="HELP").url = page.as_uri()


def register() -> None:
    if folder().is_dir():
        bpy.utils.register_manual_map(_map)
        bpy.types.TOPBAR_MT_help.append(_help_entry)


def unregister() -> None:
    with suppress(ValueError):  # there was no manual
        bpy.utils.unregister_manual_map(_map)
        bpy.types.TOPBAR_MT_help.remove(_help_entry)
