# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`audit`: comparison of the inertials in robot descriptions with the links' own geometry."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

from ..blender.write.findings import FILE_NOT_WRITTEN
from ..core.files.whole_file import whole_file
from ..core.measurement.plain_text import counted, print_message
from ..core.robots.audit import Audit, Auditor
from ..core.robots.read.descriptions import read_description
from ..core.robots.read.paths import Roots
from ..core.robots.repair import repaired_copy
from ..core.robots.write import audit_report
from ..core.verdict import internal_error
from ..core.verdict.finding import FileError, MeasureError, system_reason
from .options import targets
from .parser import COMMANDS, Parser

_EPILOG = """\
FILE is URDF, SDF, MJCF, or USD as text (.usda). A link that is off is listed with the one change that makes it agree
with its geometry. Meshes (.stl .obj .glb .dae) are read from the folder of FILE, from that of the package that it is
in, and from each --root; nothing is loaded from a network.
exit code: 0 nothing but notes, 1 warnings or errors, or a file that cannot be read, 2 wrong usage, 3 interrupted,
70 a fault of the program"""


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options of `audit`. Raises SystemExit(2), or HelpRequested."""
    parser = Parser(
        prog="body_moments",
        usage="body_moments audit [options] FILE ...",
        description=COMMANDS["audit"],
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("command", metavar="audit")
    add("files", nargs="+", type=Path, metavar="FILE")
    add("--root", action="append", type=Path, default=[], metavar="FOLDER", help="meshes may be in it; repeatable")
    add("--allow-outside", action="store_true", help="meshes may be anywhere (refused)")
    add("--repair", type=Path, metavar="FOLDER", help="write repaired copies there, of what has a repair")
    formats = "{" + ",".join(audit_report.FORMATS) + "}"
    add("--format", choices=tuple(audit_report.FORMATS), default="json", metavar=formats, help="(json)")
    add("--output", type=Path, metavar="PATH", help="(standard output)")
    add("--force", action="store_true", help="replace any file at --output and in --repair (only results)")
    options = parser.parse_intermixed_args(argv)
    if options.repair is not None:
        if not options.repair.is_dir():
            parser.error("--repair: {} is no folder".format(options.repair))
        here = os.path.realpath(options.repair)
        if any(os.path.realpath(path.parent) == here for path in options.files):
            parser.error("--repair: {} is the folder of a file that is read. Choose another one".format(options.repair))
        if len({path.name for path in options.files}) < len(options.files):
            parser.error("--repair: two files have one name. Audit them one at a time, or choose other folders")
    targets.check_targets(options, options.files, parser.error)
    return options


def answer(options: argparse.Namespace) -> tuple[list[str], int]:
    """Return the report, and the exit code: 1 after warnings, errors or unread files, 70 after an internal error."""
    documents, faults, internal = [], 0, 0
    for path in options.files:
        try:
            documents.append(_document(path, options))
        except MeasureError as error:
            documents.append(audit_report.failed_document(str(path), error.finding))
        except Exception as error:
            reason = internal_error.finding_of(error)
            internal += reason.code == internal_error.CODE
            documents.append(audit_report.failed_document(str(path), reason))
        for reason in documents[-1]["errors"]:
            print_message(path, reason["message"])
        faults += documents[-1]["status"] != "ok"
    return [audit_report.FORMATS[options.format](documents)], 70 if internal else 1 if faults else 0


def _document(path: Path, options: argparse.Namespace) -> dict[str, Any]:
    roots = Roots.for_file(path, options.root, options.allow_outside)
    audit = Auditor(roots).audit(read_description(path, roots))
    repaired = _write_copy(path, audit, options)
    document = audit_report.document(str(path), audit, repaired)
    counts = audit_report.count_findings(document)
    print_message(path, ", ".join(counted(count, name.removesuffix("s")) for name, count in counts.items()))
    return document


def _write_copy(path: Path, audit: Audit, options: argparse.Namespace) -> str | None:
    repairs, folder = audit.repairs(), options.repair
    if folder is None or not repairs:
        return None
    target = folder / path.name
    try:
        copy = repaired_copy(audit.description, repairs)
        if target.is_file() and not options.force and target.read_bytes() not in (b"", copy):
            raise FileExistsError("it is another file. Choose another folder, or --force")
        with whole_file(target) as file:
            file.write(copy)
    except OSError as error:
        raise FileError(FILE_NOT_WRITTEN, file=str(target), error=system_reason(error)) from error
    return str(target)
