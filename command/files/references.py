# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Missing references of files, and scripts that did not run.

Blender opens the rest, and reports them on the standard error at most.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator

import bpy

from ...core.verdict.finding import Finding, finding
from ..findings import DRIVER_BLOCKED, MISSING_LINKS, SCRIPT_BLOCKED

# An error of composing a stage, by stage.cpp: "… -- In </A>: Could not open asset @file@ for reference …".
_REPORT = re.compile(r"_ReportErrors at line \d+ of \S*stage\.cpp -- (.*)")
_ASSET = re.compile(r"@([^@]+)@(<[^>]*>)?")


def unresolved_references(import_file: Callable[[], object]) -> list[str]:
    """Import a file, and return the names of the layers, references and payloads that were not found.

    Output to the standard error meanwhile appears there afterwards.
    """
    sys.stderr.flush()
    try:
        standard_error = os.dup(2)
    except OSError:  # it is closed
        import_file()
        return []
    with tempfile.TemporaryFile() as printed:
        os.dup2(printed.fileno(), 2)
        try:
            import_file()
        finally:
            sys.stderr.flush()
            os.dup2(standard_error, 2)
            os.close(standard_error)
            printed.seek(0)
            text = printed.read()
            with open(2, "wb", closefd=False) as again:
                again.write(text)
    return names_in(text.decode("utf-8", "replace"))


def names_in(printed: str) -> list[str]:
    """Return the subjects of USD's reports, each once: a file, with the path of a prim that is missing in it."""
    names = {}
    for report in _REPORT.findall(printed):
        asset = _ASSET.search(report)
        names["".join(part or "" for part in asset.groups()) if asset else report] = None
    return sorted(names)


def missing_links() -> Iterator[Finding]:
    """Yield a finding if Blender replaced missing links of the file by empty data, or lacks caches of modifiers."""
    data = bpy.data
    groups = (data.objects, data.meshes, data.curves, data.metaballs, data.collections)
    missing = {item.name_full for group in (*groups, data.node_groups) for item in group if item.is_missing}
    missing |= {path for path in _cache_paths() if not os.path.exists(path)}
    if missing:
        yield finding(MISSING_LINKS, names=sorted(missing))


def _cache_paths() -> Iterator[str]:
    """Yield the files that modifiers of the scene's objects read their points from."""
    for obj in bpy.context.scene.objects:
        for modifier in obj.modifiers:
            if not modifier.show_viewport:
                continue
            if modifier.type == "MESH_CACHE" and modifier.filepath:
                yield bpy.path.abspath(modifier.filepath, library=obj.library)
            elif modifier.type == "MESH_SEQUENCE_CACHE" and modifier.cache_file and not modifier.cache_file.is_sequence:
                yield bpy.path.abspath(modifier.cache_file.filepath, library=modifier.cache_file.library)


def blocked_scripts() -> Iterator[Finding]:
    """Yield a finding if scripts of the open file did not run: drivers leave the saved value, or 0."""
    if not bpy.app.autoexec_fail:
        return
    blocked = sorted({driver.expression for driver in _drivers() if not driver.is_valid and driver.type == "SCRIPTED"})
    if blocked:
        yield finding(DRIVER_BLOCKED, drivers=blocked)
    else:
        yield finding(SCRIPT_BLOCKED, script=bpy.app.autoexec_fail_message)


def _drivers() -> Iterator[bpy.types.Driver]:
    """Yield the drivers of all data-blocks, except of embedded data such as nodes of materials."""
    for prop in bpy.data.bl_rna.properties:
        if prop.type == "COLLECTION":
            for item in getattr(bpy.data, prop.identifier):
                for curve in getattr(getattr(item, "animation_data", None), "drivers", ()):
                    yield curve.driver
