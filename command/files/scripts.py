# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts of a file that Blender opened before this program was called. Files that are opened here never run theirs."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import bpy

from ...core.verdict.finding import Finding, finding
from ..findings import SCRIPTS_ALLOWED

_ALLOW = {"-y": True, "--enable-autoexec": True, "-Y": False, "--disable-autoexec": False}


def scripts_of_open_file() -> Iterator[Finding]:
    """Yield a finding if Blender was allowed to run scripts and the open file has some."""
    if bpy.data.filepath and _allowed(sys.argv):
        names = [*dict.fromkeys((*_texts(), *_drivers()))]
        if names:
            yield finding(SCRIPTS_ALLOWED, names=names)


def _allowed(words: Sequence[str]) -> bool:
    """Return whether Blender's last command-line switch for scripts, or else its preferences, let files run scripts."""
    own = words[: words.index("--")] if "--" in words else words
    said = [_ALLOW[word] for word in own if word in _ALLOW]
    return said[-1] if said else bpy.context.preferences.filepaths.use_scripts_auto_execute


def _texts() -> list[str]:
    return [text.name for text in bpy.data.texts if text.use_module and text.name.endswith(".py")]


def _drivers() -> Iterator[str]:
    """Yield the names of data with drivers beyond simple arithmetic, which Blender evaluates without Python."""
    groups = [getattr(bpy.data, one.identifier) for one in bpy.data.bl_rna.properties if one.type == "COLLECTION"]
    for item in (item for group in groups for item in group):
        for animated in (item, getattr(item, "node_tree", None)):
            found = getattr(animated, "animation_data", None)
            drivers = (curve.driver for curve in found.drivers) if found else ()
            if any(driver.type == "SCRIPTED" and not driver.is_simple_expression for driver in drivers):
                yield item.name_full
                break
