# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Robot Description for Audit: a text with its findings, on request a page and a
repaired copy.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Operator
from bpy_extras.io_utils import ImportHelper

from ...blender.write import reports
from ...core import robots, verdict
from ...core.robots import AUDITED_SUFFIXES, write
from .. import findings, selection

if TYPE_CHECKING:
    from ...core.robots import Audit


class IMPORT_SCENE_OT_body_moments_audit(Operator, ImportHelper):
    """Check mass, center and inertia in a robot description against its meshes; write a text"""

    bl_label = "Audit Robot Description"

    filter_glob: StringProperty(
        default=";".join("*" + end for end in AUDITED_SUFFIXES), options={"HIDDEN"}
    )
    root: StringProperty(
        name="Mesh Folder",
        description="A folder that meshes may be in, besides that of the file and of its package",
        subtype="DIR_PATH",
    )
    allow_outside: BoolProperty(name="Meshes Anywhere", description="Read meshes wherever they are")
    write_copy: BoolProperty(
        name="Write Repaired Copy",
        description="Write a copy with _repaired in its name beside the file",
    )
    write_page: BoolProperty(
        name="Write HTML", description="Write the report as a page beside the file"
    )

    @selection.report_refusals
    def execute(self, _context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        try:
            document, text = self._audit(path)
        except verdict.MeasureError as error:
            raise error.about(path.name) from error
        counts = write.audit_report.count_findings(document)
        summary = reports.phrase(
            "{links} links: {errors} errors, {warnings} warnings, {notes} notes", **counts
        )
        selection.report(
            self, summary, reports.phrase("See the text “{text}” in the Text Editor", text=text)
        )
        return {"FINISHED"}

    def _audit(self, path: Path) -> tuple[dict[str, Any], str]:
        """Return the report of a file, and the name of its text."""
        folders = [Path(bpy.path.abspath(self.root))] if self.root else []
        roots = robots.Roots.for_file(path, folders, self.allow_outside)
        audit = robots.Auditor(roots).audit(robots.read_description(path, roots))
        copy = self._write_copy(path, audit) if self.write_copy else None
        document = write.audit_report.document(str(path), audit, copy)
        if self.write_page:
            page = path.with_name(path.name + ".audit.html")
            selection.write_file(page, [write.audit_report.to_html([document])])
        text = bpy.data.texts.new("Audit of {}".format(path.name))
        text.write(write.audit_report.to_text([document]))
        text.cursor_set(0)
        return document, text.name

    def _write_copy(self, path: Path, audit: "Audit") -> str | None:
        repairs = audit.repairs()
        if not repairs:
            return None
        target = path.with_name("{}_repaired{}".format(path.stem, path.suffix))
        if target.exists():
            raise verdict.FileError(findings.FILE_EXISTS, file=target.name)
        selection.write_file(target, [robots.audit.repaired_copy(audit.description, repairs)])
        return str(target)
