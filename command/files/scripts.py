# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings about scripts of files: blocked scripts, and scripts that Blender may have run before this program."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import bpy

from ...core.verdict.finding import Finding, finding
from ..findings import DRIVER_BLOCKED, SCRIPT_BLOCKED, SCRIPTS_ALLOWED

_ALLOW = {"-y": True, "--enable-autoexec": True, "-Y": False, "--disable-autoexec": False}


def blocked_scripts() -> Iterator[Finding]:
    """Yield a finding if scripts of the open file did not run: drivers leave the saved value, or 0."""
    if not bpy.app.autoexec_fail:
        return
    drivers = [driver for _, driver in _drivers() if not driver.is_valid and driver.type == "SCRIPTED"]
    if drivers:
        yield finding(DRIVER_BLOCKED, drivers=sorted({driver.expression for driver in drivers}))
    else:
        yield finding(SCRIPT_BLOCKED, script=bpy.app.autoexec_fail_message)


def scripts_of_open_file() -> Iterator[Finding]:
    """Yield a finding if Blender was allowed to run scripts and the open file has some."""
    if bpy.data.filepath and _are_allowed(sys.argv):
        texts = [text.name for text in bpy.data.texts if text.use_module and text.name.endswith(".py")]
        # Blender evaluates simple arithmetic without Python.
        scripted = [
            name
            for name, driver in _drivers(embedded=True)
            if driver.type == "SCRIPTED" and not driver.is_simple_expression
        ]
        if texts or scripted:
            yield finding(SCRIPTS_ALLOWED, names=[*dict.fromkeys((*texts, *scripted))])


def _are_allowed(words: Sequence[str]) -> bool:
    """Return whether Blender's last command-line switch for scripts, or else its preferences, let files run scripts."""
    own = words[: words.index("--")] if "--" in words else words
    switches = [_ALLOW[word] for word in own if word in _ALLOW]
    return switches[-1] if switches else bpy.context.preferences.filepaths.use_scripts_auto_execute


def _drivers(embedded: bool = False) -> Iterator[tuple[str, bpy.types.Driver]]:
    """Yield the drivers of all data-blocks with their owners' names, also of embedded node trees if requested."""
    for prop in bpy.data.bl_rna.properties:
        if prop.type != "COLLECTION":
            continue
        for item in getattr(bpy.data, prop.identifier):
            for owner in (item, getattr(item, "node_tree", None) if embedded else None):
                for curve in getattr(getattr(owner, "animation_data", None), "drivers", ()):
                    yield item.name_full, curve.driver
