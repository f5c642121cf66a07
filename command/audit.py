# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""`audit`: comparison of the inertials in robot descriptions with the links' own geometry."""

import argparse
import os
import re
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from ..blender.write.findings import FILE_NOT_WRITTEN
from ..core.density import POUND
from ..core.files import FILE_WITHOUT_OBJECTS, XML_ENTITIES
from ..core.files.whole_file import whole_file
from ..core.measurement import counted, print_message
from ..core.robots import (
    AUDITED_SUFFIXES,
    DESCRIPTION_UNKNOWN,
    Audit,
    Auditor,
    Expectation,
    Roots,
    audit_report,
    read_description,
    repaired_copy,
)
from ..core.verdict import FileError, MeasureError, declared, internal_error, system_reason
from . import audit_gate
from .files import output
from .options import option_types
from .parser import COMMANDS, Parser, UsageError, choice, flag, value
from .supervisor.progress import Progress

NO_DESCRIPTION = "there is no robot description in {}"
OTHER_FILES = {DESCRIPTION_UNKNOWN, FILE_WITHOUT_OBJECTS, XML_ENTITIES}
MASS_UNITS = {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": POUND}
_EPILOG = """\
FILE is URDF, SDF, MJCF, USD or xacro; of a folder, all such files but xacro and .usdc are audited.
USD that is binary or refers to other files needs the Python module usd-core, and xacro the module
xacro. A link that is off is listed with the one change that makes it agree with its geometry.
Meshes (.stl .obj .glb .dae .msh) and included files are read from the nearest folder above FILE
that holds a package.xml, else from the folder above that of FILE, from a named folder, and from
each --package-path and ROS_PACKAGE_PATH; nothing is loaded from a network.
exit code: 0 nothing that --fail-on names, 1 findings, or a file that cannot be read,
2 wrong usage, 3 interrupted, 70 a fault of the program"""


def parse(argv: list[str]) -> argparse.Namespace:
    """Return the options of `audit`. Raises SystemExit(2), or HelpRequested."""
    parser = Parser(
        prog="body_moments",
        usage="body_moments audit [options] FILE_OR_FOLDER ...",
        description=COMMANDS["audit"],
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("command", metavar="audit")
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_options(
        {
            "--package-path": value(
                Path,
                "FOLDER",
                "packages and meshes may be in it; repeatable",
                dest="root",
                action="append",
                default=[],
            ),
            "--root": value(Path, "FOLDER", argparse.SUPPRESS, action="append", default=[]),
            "--allow-outside": flag("meshes may be anywhere (refused)"),
            "--repair": value(Path, "FOLDER", "write repaired copies there, of what has a repair"),
            "--format": choice([*audit_report.FORMATS], "(json)", default="json"),
            "--output": value(Path, "PATH", "(standard output)"),
            "--fail-on": choice(
                [*audit_gate.FAILING],
                "findings that give exit code 1 (warning)",
                default="warning",
            ),
            "--ignore": value(
                str,
                "CODE",
                "leave out findings of this code; repeatable",
                action="append",
                default=[],
            ),
            "--light-links": value(
                option_types.positive,
                "KG",
                "findings of links of this mass or less are notes (0)",
                default=0.0,
            ),
            "--baseline": value(Path, "FILE", "only findings that are not in this file count"),
            "--write-baseline": value(Path, "FILE", "write the present findings, for --baseline"),
            "--joint": value(
                _joint_value,
                "NAME=VALUE",
                "position of a joint for the totals, radians or meters (0; MJCF: ref); repeatable",
                action="append",
                default=[],
            ),
            "--expect-mass": value(_mass, "KG", "total mass; kg, or with the unit g, lb, t"),
            "--expect-center": value(
                option_types.triple, "X,Y,Z", "center of mass of the whole model, m"
            ),
            "--within": value(
                _part,
                "PERCENT",
                "tolerance of both, the center's per radius of gyration (1%%)",
                default=0.01,
            ),
            "--jobs": value(
                option_types.count, "N", "files that are audited at a time (1)", default=1
            ),
            "--force": flag("replace any file at --output and in --repair (only results)"),
        }
    )
    options = parser.parse_intermixed_args(argv)
    for code in options.ignore:
        try:
            declared(code)
        except KeyError:
            parser.error("--ignore: no finding has the code {}".format(code))
    options.names = dict(_find_files(options.files))
    options.root = [*options.root, *(path for path in options.files if path.is_dir())]
    if not options.names:
        parser.error(NO_DESCRIPTION.format(", ".join(map(str, options.files))))
    options.known = None
    if options.baseline is not None:
        try:
            options.known = audit_gate.read_baseline(options.baseline)
        except (OSError, ValueError) as error:
            parser.error("--baseline: {} cannot be read: {}".format(options.baseline, error))
    if len(dict(options.joint)) < len(options.joint):
        parser.error("--joint: one joint has two positions")
    if options.repair is not None:
        _check_repair(options, parser)
    output.check_targets(options, [*options.names], parser.error)
    return options


def _joint_value(text: str) -> tuple[str, float]:
    """Return the name and the position of a joint."""
    name, _, position = text.rpartition("=")
    if not name:
        raise argparse.ArgumentTypeError("{!r} is not NAME=VALUE".format(text))
    return name, option_types.number(position)


def _mass(text: str) -> float:
    """Return a positive mass in kg."""
    match = re.fullmatch(r"(.*?)\s*({})?".format("|".join(MASS_UNITS)), text.strip())
    if match is None or not match[1]:
        raise argparse.ArgumentTypeError("{!r} is not a mass".format(text))
    return option_types.positive(match[1]) * MASS_UNITS[match[2] or "kg"]


def _part(text: str) -> float:
    """Return a positive percentage as a fraction."""
    if not text.endswith("%"):
        raise argparse.ArgumentTypeError("{!r} is not a percentage, such as 1%".format(text))
    return option_types.positive(text[:-1]) / 100.0


def _check_repair(options: argparse.Namespace, parser: Parser) -> None:
    """End with a message if --repair is no folder, or a copy in it would replace a file that is
    read, or another copy.
    """
    if not options.repair.is_dir():
        parser.error("--repair: {} is no folder".format(options.repair))
    here = os.path.realpath(options.repair)
    if any(os.path.realpath(path.parent) == here for path in options.names):
        parser.error(
            "--repair: {} is the folder of a file that is read. Choose another one".format(
                options.repair
            )
        )
    if len({*options.names.values()}) < len(options.names):
        parser.error(
            "--repair {}: two files have one name. Audit them one at a time, or choose other "
            "folders".format(options.repair)
        )


def _find_files(paths: list[Path]) -> Iterator[tuple[Path, Path]]:
    """Yield the named files and the robot descriptions in named folders, each with the path of its
    repaired copy in the folder of --repair.
    """
    for path in paths:
        if not path.is_dir():
            yield path, Path(path.name)
            continue
        for folder, folders, names in os.walk(path):
            folders[:] = sorted(name for name in folders if not name.startswith("."))
            for name in sorted(names):
                if name.lower().endswith(AUDITED_SUFFIXES):
                    file = Path(folder, name)
                    yield file, file.relative_to(path)


def answer(options: argparse.Namespace) -> tuple[list[str], int]:
    """Return the report, and the exit code: 1 after findings or unread files, 70 after an internal
    error. UsageError if no file in the folders is a robot description.
    """
    documents = []
    internal = False
    named_files = {path for path in options.files if not path.is_dir()}
    progress = Progress(len(options.names))
    for path, document in zip(options.names, _documents(options)):
        codes = {reason["code"] for reason in document["errors"]}
        internal |= internal_error.CODE in codes
        ignored_codes = OTHER_FILES if path.suffix == ".xml" else OTHER_FILES - {XML_ENTITIES}
        is_empty = not codes and not document["links"]
        if path not in named_files and (is_empty or codes & ignored_codes):
            continue  # A folder holds other files of these types, too.
        documents.append(document)
        for reason in document["errors"]:
            print_message(path, reason["message"])
        if not document["errors"]:
            counts = audit_report.count_findings(document)
            print_message(
                path,
                ", ".join(counted(count, name.removesuffix("s")) for name, count in counts.items()),
            )
        progress.count_file(document["status"])
        progress.show()
    progress.finish()
    if not documents:
        raise UsageError(NO_DESCRIPTION.format(", ".join(map(str, options.files))))
    if options.write_baseline is not None:
        try:
            audit_gate.write_baseline(options.write_baseline, documents)
        except OSError as error:
            file = str(options.write_baseline)
            raise FileError(FILE_NOT_WRITTEN, file=file, error=system_reason(error)) from error
    code = 70 if internal else int(audit_gate.fails(documents, options.fail_on))
    return [audit_report.FORMATS[options.format](documents)], code


def _documents(options: argparse.Namespace) -> Iterator[dict[str, Any]]:
    """Yield the report document of each file, in order; several threads make them on request."""
    meshes: dict[tuple, Any] = {}  # Files of a folder share many.
    tasks = [(path, name, options, meshes) for path, name in options.names.items()]
    if options.jobs == 1:
        yield from map(_audit_file, tasks)
        return
    with ThreadPoolExecutor(min(options.jobs, len(tasks))) as pool:
        yield from pool.map(_audit_file, tasks)


def _audit_file(task: tuple[Path, Path, argparse.Namespace, dict]) -> dict[str, Any]:
    """Return the report document of one file; of its failure if it cannot be audited."""
    path, name, options, meshes = task
    try:
        roots = Roots.for_file(path, options.root, options.allow_outside)
        expected = Expectation(options.expect_mass, options.expect_center, options.within)
        auditor = Auditor(roots, dict(options.joint), expected, meshes)
        audit = auditor.audit(read_description(path, roots))
        document = audit_report.document(str(path), audit, _write_copy(name, audit, options))
    except MeasureError as error:
        return audit_report.failed_document(str(path), error.finding)
    except Exception as error:
        return audit_report.failed_document(str(path), internal_error.finding_of(error))
    return audit_gate.apply(document, options)


def _write_copy(name: Path, audit: Audit, options: argparse.Namespace) -> str | None:
    """Write a repaired copy of an audited file, and return its path; None if there are no repairs,
    or they are not requested. name: its path in the folder of --repair. Raises FileError.
    """
    repairs = audit.repairs()
    folder = options.repair
    if folder is None or not repairs:
        return None
    target = folder / name
    try:
        copy = repaired_copy(audit.description, repairs)
        if target.is_file() and not options.force and target.read_bytes() not in (b"", copy):
            raise FileExistsError("it is another file. Choose another folder, or --force")
        target.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(target) as file:
            file.write(copy)
    except OSError as error:
        raise FileError(FILE_NOT_WRITTEN, file=str(target), error=system_reason(error)) from error
    return str(target)
