# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Robot Description for Audit: a text with its errors, and on request a repaired copy."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Menu, Operator
from bpy_extras.io_utils import ImportHelper

from ...blender.write import reports
from ...core.files.whole_file import whole_file
from ...core.robots.audit import Audit, Auditor
from ...core.robots.read.descriptions import SUFFIXES, read_description
from ...core.robots.read.paths import Roots
from ...core.robots.repair import repaired_copy
from ...core.robots.write import audit_report
from ...core.verdict.finding import FileError, Finding, MeasureError, Severity, finding, system_reason
from .. import selection
from ..findings import AUDIT_DONE, AUDIT_TEXT, FILE_EXISTS, FILE_NOT_WRITTEN


class IMPORT_SCENE_OT_body_moments_audit(Operator, ImportHelper):
    """Check mass, center and inertia in a robot description against its meshes. What is found becomes a text"""

    bl_idname = "import_scene.body_moments_audit"
    bl_label = "Audit Robot Description"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=";".join("*" + end for end in SUFFIXES), options={"HIDDEN"})
    root: StringProperty(
        name="Mesh Folder",
        description="A folder that meshes may be in, besides that of the file and of its package",
        subtype="DIR_PATH",
    )
    allow_outside: BoolProperty(name="Meshes Anywhere", description="Read meshes wherever they are", default=False)
    write_copy: BoolProperty(
        name="Write Repaired Copy", description="Write a copy with _repaired in its name beside the file", default=False
    )
    write_page: BoolProperty(name="Write HTML", description="Write the report as a page beside the file", default=False)

    def execute(self, _context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        try:
            findings = self._audit(path)
        except MeasureError as error:
            selection.report(self, reports.refusal(error.about(path.name)))
            return {"CANCELLED"}
        selection.report(self, *findings)
        return {"FINISHED"}

    def _audit(self, path: Path) -> list[Finding]:
        roots = Roots.for_file(path, [Path(bpy.path.abspath(self.root))] if self.root else [], self.allow_outside)
        audit = Auditor(roots).audit(read_description(path, roots))
        copy = self._write_copy(path, audit) if self.write_copy else None
        links = [
            audit_report.link_entry(found.link, found.findings, found.repaired, found.density) for found in audit.links
        ]
        document = audit_report.document(str(path), audit.description, links, copy)
        if self.write_page:
            _write(path.with_name(path.name + ".audit.html"), audit_report.to_html([document]).encode("utf-8"))
        text = bpy.data.texts.new("Audit of {}".format(path.name))
        text.write(audit_report.to_text(document))
        text.cursor_set(0)
        levels = [found["severity"] for link in links for found in link["findings"]]
        counts = {str(level) + "s": levels.count(level) for level in Severity}
        return [finding(AUDIT_DONE, links=len(links), **counts), finding(AUDIT_TEXT, text=text.name)]

    def _write_copy(self, path: Path, audit: Audit) -> str | None:
        repairs = [(found.link, found.repaired) for found in audit.links if found.repaired is not None]
        if not repairs:
            return None
        target = path.with_name("{}_repaired{}".format(path.stem, path.suffix))
        if target.exists():
            raise FileError(FILE_EXISTS, file=target.name)
        _write(target, repaired_copy(audit.description, repairs))
        return str(target)


def _write(path: Path, data: bytes) -> None:
    try:
        with whole_file(path) as file:
            file.write(data)
    except OSError as error:
        raise FileError(FILE_NOT_WRITTEN, error=system_reason(error)) from error


def _menu(menu: Menu, _context: Context) -> None:
    text = "Robot Description for Audit (.urdf/.sdf/.xml/.usda)"
    menu.layout.operator(IMPORT_SCENE_OT_body_moments_audit.bl_idname, text=text)


def register() -> None:
    bpy.utils.register_class(IMPORT_SCENE_OT_body_moments_audit)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    bpy.utils.unregister_class(IMPORT_SCENE_OT_body_moments_audit)
