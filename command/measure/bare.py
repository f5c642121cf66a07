# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are measured without Blender, whether it is there or not: arrays and scans, and
meshes.

An array, a scan, and a mesh that is read in blocks are one body, named after the file. An .obj file
may have several.
"""

import os
from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import chain, count
from typing import Any, TypeVar

from ...blender.session.findings import NO_SUCH_NAME
from ...core import cad, floating, robots, streams, verdict
from ...core.bodies import (
    DENSITY_DEFAULTED,
    SHAPE_OF_GRID,
    ArrayOptions,
    Reading,
    about_file,
    body_of_mesh,
    measure_array,
    measure_faces,
    measure_labels,
    measure_mesh_file,
    measure_reading,
    read_mesh,
)
from ...core.files import FILE_UNREADABLE, FILE_WITHOUT_OBJECTS
from ...core.measurement import Measurement, PrintSettings, Settings, record
from ...core.scans import LABEL_ABSENT, UNIT_ASSUMED, Label, read_label_table
from ...core.scans import formats as scans
from ...core.verdict import FileError, Finding, MeasureError, QueryError, finding, system_reason
from .. import measure
from ..files.suffixes import STREAMED, check_file, file_suffix
from ..findings import (
    FOURIER_OBJECT_COUNT,
    MEASURED_AS_SHELL,
    NEEDS_BLEND,
    OPTIONS_UNUSED,
    RESULTS_NOT_STORED,
    STREAM_OPTIONS,
)
from ..options import arguments, checks
from ..supervisor import listing, processes
from .entries import Contents, cut_entries, failure, floating_entry, is_open_sheet, picture

BYTES_PER_FACE = 500  # approximate memory for reading and measuring a mesh
# Least bytes for each face, so that a file's size limits its faces: in .stl a binary record, in
# .ply a counter of 1 byte, three indices of 4, and half a vertex of 12.
BYTES_OF_FILE = {".stl": 50, ".ply": 19}
UP = (0.0, 0.0, 1.0)
DEFAULT_DENSITY = 1000.0  # kg/m³
DEFAULT_THICKNESS = 0.001  # m, as of an object
_NOT_OF_STREAMS = (
    *("wall", "print", "polynomial", "density_from", "fourier"),
    *("below", "against", "float"),
)


Named = TypeVar("Named", streams.FileMesh, cad.SurfaceBody)
T = TypeVar("T")


class BareFile:
    """A file that is measured without Blender.

    options: those of the command line. memory: bytes that measuring it may take, None for any.
    progress: returns a counter of the samples or faces read from a file.
    """

    has_saved = False
    opened = ()

    def __init__(
        self,
        path: str,
        options: Namespace,
        threads: int,
        memory: int | None,
        progress: Callable[[str, str], Callable[[int], None]],
    ) -> None:
        self._path = path
        self.options = options
        self._threads = threads
        self._memory = memory
        self._progress = progress
        self._is_scan = bool(scans.scan_suffix(path))

    def measure(self, contents: Contents) -> None:
        """Measure the bodies in the file. Raises MeasureError."""
        if self._is_scan or is_streamed(self._path, self.options, self._memory):
            self._measure_whole(contents)
        elif file_suffix(self._path) in listing.CAD:
            check_file(self._path)
            self._measure_cad(contents)
        else:
            check_file(self._path)
            self._measure_meshes(contents)
        contents.caveats += verdict.open_body_caveats(
            (label, measurement.method) for label, _, measurement in contents.measured
        )

    def store(self, contents: Contents) -> None:
        if self.options.write:
            raise FileError(RESULTS_NOT_STORED, cause=NEEDS_BLEND)

    def complete(self, document: dict[str, Any], contents: Contents) -> dict[str, Any]:
        """Return a document with its text as a robot, if one is requested, which needs Blender."""
        if self.options.format not in robots.FORMATS:
            return document
        measure_options = measure.scene.measure_options(self.options, self._threads)
        return measure.robots.complete(
            document, contents.measured, self.options, measure_options, is_opened=False
        )

    def _settings(self) -> Settings:
        options = self.options
        return Settings(
            kind=options.kind or "solid",
            density=checks.density_of(options),
            mass=options.mass,
            thickness=options.thickness or 0.0,
            wall=options.wall or "thin",
            printed=PrintSettings()._replace(**dict(options.print or ())),
            order=options.order,
            surface=options.surface_moments,
            threads=self._threads,
        )

    def _mesh_settings(self) -> tuple[Settings, list[Finding]]:
        """Return the settings with the unit of a mesh file and a density, and findings about
        these.
        """
        settings = replace(self._settings(), unit=self.options.unit_scale or 1.0)
        findings = [*checks.file_findings(self._path, self.options)]
        if settings.density is None and settings.mass is None:
            settings = replace(settings, density=DEFAULT_DENSITY)
            findings.append(finding(DENSITY_DEFAULTED, density="1000 kg/m³"))
        return settings, findings

    def _chosen(self, bodies: dict[str, T], contents: Contents) -> Iterator[tuple[str, T]]:
        """Return the requested bodies and their names; each name that none has is an error."""
        requested_names = dict.fromkeys(
            bodies if self.options.object is None else self.options.object
        )
        contents.errors += [
            failure(missing_name, finding(NO_SUCH_NAME, kind="object", name=missing_name))
            for missing_name in requested_names
            if missing_name not in bodies
        ]
        return ((name, body) for name, body in bodies.items() if name in requested_names)

    def _measure_whole(self, contents: Contents) -> None:
        """Measure a scan, or a mesh that is read in blocks, as one body; a scan with --label as a
        body for each label.
        """
        is_scan = self._is_scan
        name = os.path.basename(self._path)[: -len(file_suffix(self._path))]
        if is_scan and self.options.label is not None:
            self._measure_labels(name, contents)
            return
        chosen_names = [*self._chosen({name: None}, contents)]
        if is_scan and self.options.fourier:
            contents.errors.append(failure(None, finding(FOURIER_OBJECT_COUNT, count=0)))
        if not chosen_names:
            return
        progress = self._progress(self._path, "samples" if is_scan else "faces")
        measurement = (
            measure_array(self._path, name, self._array_options(), self._settings(), progress)
            if is_scan
            else self._measure_stream(name, progress)
        )
        # These entries of the record need a surface in memory, and are None.
        shape_options = [name for name in ("pose", "signature") if getattr(self.options, name)]
        entries: dict[str, Any] = dict.fromkeys(shape_options)
        if self.options.thumbnails:
            entries["thumbnail"] = None
        findings = [finding(SHAPE_OF_GRID)] * bool(is_scan and shape_options)
        findings += checks.unused([] if is_scan else shape_options)
        if self.options.float:
            entries["floating"] = None
            findings += checks.unused(["float"])
        self._add(contents, measurement, findings, entries)

    def _measure_labels(self, name: str, contents: Contents) -> None:
        """Measure the labels of a scan, each as a body. name: of the file. Raises MeasureError."""
        options = self.options
        settings, findings = self._mesh_settings()
        table = {}
        if options.label_table is not None:
            table_name = options.label_table.name
            with contents.attempt(table_name), about_file(table_name):
                table = read_label_table(options.label_table, options.limits)
            if not table:  # The contents have the error.
                return
        requested_labels = None if options.label == "all" else [options.label]
        array = self._array_options()  # It has the unit, so that the settings' unit is meters.
        measured = measure_labels(
            self._path, name, array, replace(settings, unit=1.0), requested_labels, table
        )
        measured_labels = [entries["label"]["value"] for _, entries in measured]
        absent = [label for label in measured_labels if label not in table]
        if options.label_table is not None and absent:
            values = {"labels": absent, "others": sorted(table), "remedy": "--label-table"}
            raise FileError(LABEL_ABSENT, file=options.label_table.name, **values)
        # The unit of a scan, and its options, are not those of a mesh file.
        findings = [
            file_finding
            for file_finding in findings
            if file_finding.code not in (UNIT_ASSUMED, OPTIONS_UNUSED)
        ]
        requested = ("spline_order", "density_scale", "pose", "signature", "fourier")
        findings += checks.unused(name for name in requested if getattr(options, name))
        for _, (measurement, entries) in self._chosen(
            {pair[0].name: pair for pair in measured}, contents
        ):
            density = table.get(entries["label"]["value"], Label()).density
            own_findings = [
                file_finding
                for file_finding in findings
                if density is None or file_finding.code != DENSITY_DEFAULTED
            ]
            self._add(contents, measurement, own_findings, entries)

    def _array_options(self) -> ArrayOptions:
        values = {
            name: getattr(self.options, name)
            for name in (*checks.OF_ARRAYS, "unit_scale", "limits", "threshold")
        }
        values["positions"] = dict(self.options.positions or ())
        return ArrayOptions(**{name: value for name, value in values.items() if value is not None})

    def _measure_stream(self, name: str, progress: Callable[[int], None]) -> Measurement:
        """Measure a mesh that is read in blocks. Raises MeasureError, also for options that need
        all of it in memory.
        """
        check_file(self._path)
        options = self.options
        refused_options = [
            *(
                option
                for option in _NOT_OF_STREAMS
                if getattr(options, option) not in (None, "thin", "value")
            ),
            *arguments.boolean_and_wire(options),
            *["kind"] * (options.kind == "printed"),
        ]
        if refused_options:
            raise QueryError(STREAM_OPTIONS, options=arguments.words(refused_options))
        settings, findings = self._mesh_settings()
        return measure_mesh_file(self._path, name, settings, tuple(findings), progress)

    def _measure_cad(self, contents: Contents) -> None:
        """Measure the bodies of a CAD file, each with a name of its own."""
        try:
            file = cad.read_surfaces(self._path, self.options.limits, for_blender=False)
        except OSError as error:
            raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
        contents.errors += [failure(None, refused) for refused in file.refused]
        settings, findings = self._mesh_settings()
        settings = replace(settings, unit=file.unit or settings.unit)
        findings += [finding(cad.FACES_NOT_READ, count=file.unread)] * bool(file.unread)
        for name, body in self._chosen(_with_own_names(file.bodies), contents):
            with contents.attempt(name):
                measured = measure_faces(name, body.patches, body.rounding, settings)
                self._add(contents, measured, (*findings, *file.notes), {})

    def _measure_meshes(self, contents: Contents) -> None:
        try:
            if file_suffix(self._path) == ".obj" and cad.has_surfaces(self._path):
                raise FileError(
                    FILE_UNREADABLE, error=arguments.NEEDS_BLENDER.format("its surfaces need")
                )
            meshes, upright = cad.read_meshes(self._path)
        except OSError as error:
            raise FileError(FILE_UNREADABLE, error=system_reason(error)) from error
        if not meshes:
            raise FileError(FILE_WITHOUT_OBJECTS, content="objects")
        settings, findings = self._mesh_settings()
        for name, mesh in self._chosen(_with_own_names(meshes), contents):
            with contents.attempt(name):
                self._measure_mesh(read_mesh(mesh, upright), settings, findings, contents)

    def _measure_mesh(
        self, reading: Reading, settings: Settings, findings: list[Finding], contents: Contents
    ) -> None:
        """Add the measurement of one mesh, of an open sheet as a shell, and the requested entries
        of its record. findings: about its file. Raises MeasureError.
        """
        sheet_findings = []
        try:
            body = body_of_mesh(reading, settings)
            measurement = measure_reading(reading, body, settings)
        except MeasureError as refusal:
            if not is_open_sheet(refusal, self.options):
                raise
            thickness = self.options.thickness or DEFAULT_THICKNESS
            shell = replace(settings, kind="shell", thickness=thickness)
            body = body_of_mesh(reading, shell)
            measurement = measure_reading(reading, body, shell)
            sheet_findings = [finding(MEASURED_AS_SHELL)]
        extra_entries, floating_findings = {}, ()
        if self.options.float:
            mass_properties = measurement.mass_properties
            settle = partial(
                floating.settle,
                [body],
                mass_properties.mass,
                mass_properties.center,
                self.options.float,
                UP,
                center_error=measurement.center_bounds,
            )
            extra_entries, floating_findings = floating_entry(
                settle, measurement, self.options, contents
            )
        if self.options.thumbnails:
            extra_entries["thumbnail"] = picture(reading.join(), measurement, settings.unit)
        cuts, cut_findings = cut_entries(measurement, body, self.options, contents)
        self._add(
            contents,
            measurement,
            (*findings, *sheet_findings, *floating_findings, *cut_findings),
            extra_entries | cuts,
        )

    def _add(
        self,
        contents: Contents,
        measurement: Measurement,
        findings: Iterable[Finding],
        extra_entries: dict[str, Any],
    ) -> None:
        """Add a measurement and its record. findings: about its file. extra_entries: of the
        record.
        """
        options = self.options
        findings = (*measurement.findings, *findings, *checks.body_findings(options, measurement))
        measurement = replace(measurement, findings=findings)
        surface = measurement.area_moments if options.surface_moments else None
        contents.objects.append(
            record.record(
                measurement, options.frame, options.order, surface, extra_entries, options.about
            )
        )
        contents.measured.append((measurement.name, None, measurement))


def _with_own_names(meshes: Iterable[Named]) -> dict[str, Named]:
    """Return meshes or bodies by name. If several have one name, later ones get numbers behind it,
    as in Blender.
    """
    by_name: dict[str, Named] = {}
    for mesh in meshes:
        numbered = ("{}.{:03d}".format(mesh.name, number) for number in count(1))
        own_name = next(name for name in chain([mesh.name], numbered) if name not in by_name)
        by_name[own_name] = replace(mesh, name=own_name)
    return by_name


def is_bare(path: str, options: Namespace, memory: int | None) -> bool:
    """Return whether a file is measured without Blender. memory: bytes that measuring it may take,
    None for any.
    """
    if scans.scan_suffix(path) or not processes.has_blender():
        return True
    suffix = file_suffix(path)
    if suffix in (".step", ".stp"):
        return not arguments.options_of_polygons(options)
    if suffix not in listing.UNITLESS:
        return False
    if is_streamed(path, options, memory):
        return True
    if arguments.options_of_blender(options, False):
        return False
    with suppress(OSError, ValueError):  # Reading reports the error.
        return suffix != ".obj" or not cad.has_surfaces(path)
    return True


def is_streamed(path: str, options: Namespace, memory: int | None) -> bool:
    """Return whether the faces of a file are read in blocks: if requested, or if all at once might
    take more than `memory` bytes, None for any.
    """
    suffix = file_suffix(path)
    if suffix not in STREAMED or options.stream != "auto":
        return suffix in STREAMED and options.stream == "always"
    with suppress(OSError, ValueError):  # Reading reports the error.
        return (
            memory is not None
            and os.path.getsize(path) / BYTES_OF_FILE[suffix] * BYTES_PER_FACE > memory
        )
    return False
