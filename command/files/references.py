# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Findings about an opened file and its missing references, which Blender does not report or only
prints.
"""

import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import bpy

from ...core.files import MISSING_REFERENCES
from ...core.verdict import Finding, finding
from ..findings import DRIVER_BLOCKED, SCRIPT_BLOCKED, SCRIPTS_ALLOWED

# An error of composing a stage, by stage.cpp: "… -- In </A>: Could not open asset @file@ for
# reference …".
_REPORT = re.compile(r"_ReportErrors at line \d+ of \S*stage\.cpp -- (.*)")
_ASSET = re.compile(r"@([^@]+)@(<[^>]*>)?")
_ALLOW = {"-y": True, "--enable-autoexec": True, "-Y": False, "--disable-autoexec": False}


@dataclass(frozen=True)
class Opened:
    """Findings about an opened file.

    errors: parts of the file, or references, that are missing now. notes: about the whole file.
    by_object: about one object, by its name. hidden: the reasons why the file does not show
    objects, by their names.
    """

    errors: tuple[Finding, ...] = ()
    notes: tuple[Finding, ...] = ()
    by_object: Mapping[str, tuple[Finding, ...]] = field(default_factory=dict)
    hidden: Mapping[str, Finding] = field(default_factory=dict)


def reported_references(import_file: Callable[[], object]) -> tuple[Finding, ...]:
    """Run an import, and return an error about layers, references and payloads that USD reports as
    missing.

    Output to the standard error meanwhile appears there afterwards.
    """
    sys.stderr.flush()
    try:
        standard_error = os.dup(2)
    except OSError:  # it is closed
        import_file()
        return ()
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
    # Each report is about a file, with the path of a prim if that is missing in it.
    reports = {
        "".join(asset.groups("")) if asset else report
        for report in _REPORT.findall(text.decode("utf-8", "replace"))
        for asset in [_ASSET.search(report)]
    }
    return (finding(MISSING_REFERENCES, names=sorted(reports)),) if reports else ()


def missing_links() -> Iterator[Finding]:
    """Yield a finding if Blender replaced missing links of the file by empty data, or lacks caches
    of modifiers.
    """
    data = bpy.data
    groups = (data.objects, data.meshes, data.curves, data.metaballs, data.collections)
    missing = {
        item.name_full for group in (*groups, data.node_groups) for item in group if item.is_missing
    }
    missing |= {path for path in _cache_paths() if not os.path.exists(path)}
    if missing:
        yield finding(MISSING_REFERENCES, names=sorted(missing))


def _cache_paths() -> Iterator[str]:
    """Yield the files that modifiers of the scene's objects read their points from."""
    for obj in bpy.context.scene.objects:
        for modifier in obj.modifiers:
            cache = getattr(modifier, "cache_file", None)
            if modifier.show_viewport and modifier.type == "MESH_CACHE" and modifier.filepath:
                yield bpy.path.abspath(modifier.filepath, library=obj.library)
            elif modifier.show_viewport and cache and not cache.is_sequence:
                yield bpy.path.abspath(cache.filepath, library=cache.library)


def blocked_scripts() -> Iterator[Finding]:
    """Yield a finding if scripts of the open file did not run: drivers leave the saved value,
    or 0.
    """
    if not bpy.app.autoexec_fail:
        return
    drivers = {
        driver.expression
        for _, driver in _drivers()
        if not driver.is_valid and driver.type == "SCRIPTED"
    }
    yield (
        finding(DRIVER_BLOCKED, drivers=sorted(drivers))
        if drivers
        else finding(SCRIPT_BLOCKED, script=bpy.app.autoexec_fail_message)
    )


def scripts_of_open_file() -> Iterator[Finding]:
    """Yield a finding if Blender was allowed to run scripts and the open file has some."""
    if bpy.data.filepath and _are_allowed(sys.argv):
        texts = [
            text.name for text in bpy.data.texts if text.use_module and text.name.endswith(".py")
        ]
        # Blender evaluates simple arithmetic without Python.
        scripted = [
            name
            for name, driver in _drivers(embedded=True)
            if driver.type == "SCRIPTED" and not driver.is_simple_expression
        ]
        if texts or scripted:
            yield finding(SCRIPTS_ALLOWED, names=[*dict.fromkeys((*texts, *scripted))])


def _are_allowed(words: Sequence[str]) -> bool:
    """Return whether Blender's last command-line switch for scripts, or else its preferences, let
    files run scripts.
    """
    blender_words = words[: words.index("--")] if "--" in words else words
    switches = [_ALLOW[word] for word in blender_words if word in _ALLOW]
    return switches[-1] if switches else bpy.context.preferences.filepaths.use_scripts_auto_execute


def _drivers(embedded: bool = False) -> Iterator[tuple[str, bpy.types.Driver]]:
    """Yield the drivers of all data-blocks with their owners' names, also of embedded node trees if
    requested.
    """
    kinds = [prop.identifier for prop in bpy.data.bl_rna.properties if prop.type == "COLLECTION"]
    for item in (item for kind in kinds for item in getattr(bpy.data, kind)):
        for owner in (item, getattr(item, "node_tree", None) if embedded else None):
            for curve in getattr(getattr(owner, "animation_data", None), "drivers", ()):
                yield item.name_full, curve.driver
