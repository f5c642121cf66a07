# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Production of a file's document: opening, measurement of objects, and storage of results if requested.

Every failure is an entry in `errors` and stops nothing else: a file that cannot be opened, an object that cannot be
measured, a file that cannot be saved. An unexpected failure is such an entry too, with its traceback on the
standard error.
"""

from __future__ import annotations

import os
from argparse import Namespace
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from ...blender.bodies.measure_object import THREADS, Measured
from ...blender.bodies.stacks.stack import Stacked
from ...blender.read.total_caveats import open_body_caveats, operands_of, total_caveats
from ...blender.read.tracking import tracking_paused
from ...blender.session.findings import DENSITY_DEFAULTED
from ...blender.session.tracking.staleness import mark_up_to_date
from ...blender.settings import properties as settings
from ...blender.settings.density import unset_density
from ...blender.settings.options import MeasureOptions
from ...blender.write.findings import FILE_NOT_WRITTEN
from ...blender.write.properties import store
from ...core.measurement import record
from ...core.measurement.documents import document
from ...core.measurement.measurement import Measurement
from ...core.measurement.plain_text import print_message
from ...core.scans.findings import FILE_MISSING
from ...core.streams.findings import FILE_UNREADABLE
from ...core.verdict import internal_error
from ...core.verdict.finding import FileError, Finding, MeasureError, finding, system_reason
from ..files.bare_files import BareFile, is_bare
from ..files.files import BLEND, file_suffix, newer_version, open_file, requested_file
from ..files.references import Opened, missing_links
from ..files.saving import Place
from ..files.scripts import blocked_scripts, scripts_of_open_file
from ..findings import (
    FILE_VERSION_UNSUPPORTED,
    FOURIER_OBJECT_COUNT,
    PART_UNAVAILABLE,
    RESULTS_NEED_BLEND,
    SOLID_OPERAND_MEASURED,
)
from ..interruption import Progress, check_interruption
from ..options import density as density_options
from ..options.arguments import run_of
from ..options.file import body_findings, file_findings, is_unitless
from . import assets, flat, fourier, robots
from .combined import Combined, measure_combined
from .measuring import measure_shape, measured_together, thumbnail_of
from .objects import failure, objects_to_measure, other_scenes, said_once, why_nothing

_STATUSES: dict[str, str] = {FILE_MISSING: "missing", FILE_VERSION_UNSUPPORTED: "unsupported_version"}


@dataclass
class Run:
    """The execution of a command line in this process.

    threads: count for a measurement. memory: bytes that one file may take, None for any. progress: returns a counter
    of the samples or faces read from a file. documents: one for each file, in order. internal_errors: count of the
    errors that are faults of the program. has_opened, has_saved: whether the last file has become the open scene, and
    whether it was saved in place.
    """

    options: Namespace
    threads: int = THREADS
    memory: int | None = None
    progress: Callable[[str, str], Callable[[int], None]] = Progress
    documents: list[dict[str, Any]] = field(default_factory=list)
    internal_errors: int = 0
    has_opened: bool = field(init=False)
    has_saved: bool = field(init=False)

    def __post_init__(self) -> None:
        self._status: str | None = None  # Of the current document; None if its errors determine it.
        measure_options = {
            name: getattr(self.options, name) for name in ("kind", "mass", "thickness", "overlap", "wall")
        }
        self._measure_options = MeasureOptions(
            **measure_options,
            density=density_options.density_of(self.options),
            order=self.options.order,
            surface=self.options.surface_moments,
            threads=self.threads,
        )

    def measure(self) -> None:
        """Measure every named file, or else the open file, and add their documents."""
        options = self.options
        is_open_file_meant = not options.files and options.manifest is None and options.range is None
        for path in [None] if is_open_file_meant else options.files:
            self.documents.append(self.document(path))

    @property
    def errors(self) -> int:
        """The number of entries under `errors` in all documents."""
        return sum(len(document["errors"]) for document in self.documents)

    def document(self, path: str | None) -> dict[str, Any]:
        """Measure one file, or the open scene, and return its document."""
        file = path or bpy.data.filepath or requested_file()
        self.has_opened = self.has_saved = False
        found = self._measured(path, file)
        check_interruption()
        return found

    def _place(self, path: str | None) -> Place | None:
        """Return the .blend file in which results will be saved, None if there is none. Raises FileError."""
        is_saved = self.options.write or self.options.asset_metadata == "file"
        is_blend = path is None or file_suffix(path) == BLEND
        target = path or bpy.data.filepath
        return Place.of_file(target) if is_saved and is_blend and os.path.isfile(target) else None

    def _measured(self, path: str | None, file: str | None) -> dict[str, Any]:
        measured: list[tuple[str, bpy.types.Object, Measurement]] = []
        objects, flats, errors, caveats, left_out, combined = [], [], [], [], [], Combined()
        self._status, wanted, is_opened = None, self._measure_options, False
        try:
            place = self._place(path)
            if path is not None and is_bare(path, self.options, self.memory):
                bare = BareFile(path, self.options)
                bare.measure(wanted, self.progress)
                objects, measured, errors = bare.objects, bare.measured, bare.errors
                self._status = _STATUSES.get(bare.refusal.finding.code) if bare.refusal else None
                caveats += open_body_caveats((label, one.method) for label, _, one in measured)
            else:
                opened = self._open(path, file)
                is_opened = True
                # Not set in the scene, whose unit scale is a float32 with limits.
                unit = (self.options.unit_scale or 1.0) if is_unitless(path) else None
                wanted = replace(wanted, unit_scale=unit)
                chosen, left_out, errors = objects_to_measure(self.options.object, self.options.all, opened.hidden)
                errors += [failure(None, reason) for reason in (*opened.errors, *missing_links())]
                of_file = (
                    *opened.notes,
                    *file_findings(path, self.options),
                    *blocked_scripts(),
                    *newer_version(),
                )
                objects, measured, flats = self._measure_each(chosen, wanted, of_file, opened, errors)
                caveats += scripts_of_open_file() if path is None else ()
                caveats += open_body_caveats((label, one.method) for label, _, one in measured)
                if self.options.object is None:  # A user who names objects knows what their total means.
                    caveats += total_caveats([obj for _, obj, _ in measured], bpy.context.view_layer)
                    caveats += other_scenes(bpy.context.scene)
                    combined = measure_combined(wanted, self._internal_error, self.options.asset_metadata is not None)
                    errors += combined.errors
                if self.options.fourier:
                    errors.extend(self._fourier(chosen, wanted, [*objects, *flats]))
                if not objects and not flats and not errors:
                    errors.append(failure(None, why_nothing(len(left_out))))
            caveats += said_once(objects, DENSITY_DEFAULTED)
            if self.options.write:
                errors.extend(self._store(path, measured, wanted))
                errors.extend(combined.store(self._internal_error))
            is_changed = self.options.write
            if self.options.asset_metadata and path is not None and file_suffix(path) == BLEND:
                of_objects = {obj: one for _, obj, one in measured}
                in_file, told = assets.write(of_objects | combined.measurements(), path, self.options.asset_metadata)
                is_changed, caveats = is_changed or in_file, [*caveats, *told]
            if is_changed:
                if place is None:
                    raise FileError(FILE_NOT_WRITTEN, file=file, error="it is gone")
                place.save()
                self.has_saved = True
        except MeasureError as refusal:
            errors.append(failure(None, refusal.finding))
            self._status = _STATUSES.get(refusal.finding.code)
        except Exception as error:
            errors.append(self._internal_error(None, error))
        for one in errors:
            where = [text for text in (file, one["name"]) if text]
            print_message(*where, one["reason"])
        made = document(
            objects,
            record.total([one for _, _, one in measured], caveats),
            errors,
            left_out,
            file=file,
            blender=".".join(map(str, bpy.app.version)),
            frame=self.options.frame,
            status=self._status,
            run=run_of(self.options),
        )
        made |= combined.records(self.options.frame) | ({"flat": flats} if self.options.flat else {})
        return robots.complete(made, measured, self.options, wanted, is_opened=is_opened)

    def _measure_each(
        self,
        chosen: list[tuple[str, bpy.types.Object]],
        wanted: MeasureOptions,
        of_file: tuple[Finding, ...],
        opened: Opened,
        errors: list[dict[str, Any]],
    ) -> tuple[list[dict[str, Any]], list[tuple[str, bpy.types.Object, Measurement]], list[dict[str, Any]]]:
        """Return the records and measurements of bodies, and the records of flat shapes.

        Failures are added to `errors`. of_file: findings about the file.
        """
        objects, measured, flats = [], [], []
        operands = operands_of(bpy.context.scene.objects) if self.options.object is None else {}
        in_turn = measured_together([obj for _, obj in chosen], self.options, wanted)
        for label, obj in chosen:
            user = operands.get(obj)
            cut = [] if user is None else [finding(SOLID_OPERAND_MEASURED, object=user.name)]
            try:
                about = (*opened.by_object.get(obj.name, ()), *of_file, *cut)
                one, entry = self._measure_record(label, obj, wanted, in_turn, about, errors)
            except MeasureError as refusal:
                errors.append(failure(label, refusal.finding))
            except Exception as error:
                errors.append(self._internal_error(label, error))
            else:
                if one is None:
                    flats.append(entry)
                else:
                    objects.append(entry)
                    measured.append((label, obj, one))
        return objects, measured, sorted(flats, key=lambda entry: entry["name"])

    def _measure_record(
        self,
        label: str,
        obj: bpy.types.Object,
        measure_options: MeasureOptions,
        in_turn: Callable[[bpy.types.Object], Measured | Stacked] | None,
        findings: tuple[Finding, ...],
        errors: list[dict[str, Any]],
    ) -> tuple[Measurement | None, dict[str, Any]]:
        """Return an object's measurement and its record, or None and the record of a flat shape.

        A body with a mass but without moments of the requested order gets a record without them, and an error is added.
        in_turn: measures the objects together; None if each has to be measured by itself. findings: about the object's
        file.
        """
        order = self.options.order
        density_options.apply(obj, self.options)
        try:
            measurement, more, of_shape = (
                (in_turn(obj).measurement, {}, ()) if in_turn else measure_shape(obj, self.options, measure_options)
            )
        except MeasureError as refusal:
            if flat.is_meant(self.options, refusal):
                return None, flat.record_of(label, obj, self.options, measure_options.unit_scale, refusal, findings)
            if order is None:
                raise
            lower = replace(measure_options, order=None)
            measurement, more, of_shape = measure_shape(obj, self.options, lower)
            errors.append(failure(label, _unavailable("moments of this order", refusal)))
            order = None
        surface = measurement.area_moments if self.options.surface_moments and order is not None else None
        findings = (
            *(*measurement.findings, *of_shape, *findings),
            *(*self._default_density(obj, measurement), *body_findings(self.options, measurement)),
        )
        named = replace(measurement, name=label, findings=findings)
        if self.options.thumbnails:
            more["thumbnail"] = thumbnail_of(obj, measurement, measure_options.unit_scale)
        return measurement, record.record(named, self.options.frame, order, surface, more, self.options.about)

    def _default_density(self, obj: bpy.types.Object, measurement: Measurement) -> Iterator[Finding]:
        """Yield a finding if neither an option nor the object sets the density."""
        if self.options.density is not None or self.options.mass is not None or self.options.material is not None:
            return
        unset = unset_density(obj, measurement, bpy.context.scene)
        if unset is not None:
            yield finding(DENSITY_DEFAULTED, density="1 kg/m" if unset == "linear_density" else "1000 kg/m³")

    def _open(self, path: str | None, file: str | None) -> Opened:
        """Open `path`, if given, and return what was found. FileError if there is none and `file` is not loaded."""
        if path is not None:
            unresolved = open_file(path)
            self.has_opened = True
            return unresolved
        if file and not bpy.data.filepath:
            raise FileError(FILE_UNREADABLE, error="it is missing or incomplete")
        return Opened()

    def _fourier(
        self,
        chosen: list[tuple[str, bpy.types.Object]],
        measure_options: MeasureOptions,
        objects: list[dict[str, Any]],
    ) -> Iterator[dict[str, Any]]:
        """Write the Fourier transform of the one measured object, and add the findings to its record."""
        if len(chosen) != 1:
            yield failure(None, finding(FOURIER_OBJECT_COUNT, count=len(chosen)))
            return
        if not objects:
            return  # the reason is among the errors already
        (label, obj), (entry,) = chosen[0], objects
        try:
            record.add_findings(entry, fourier.write(obj, self.options, measure_options))
        except MeasureError as refusal:
            yield failure(label, _unavailable("Fourier transform", refusal))
        except OSError as error:
            file = str(self.options.fourier)
            yield failure(label, finding(FILE_NOT_WRITTEN, file=file, error=system_reason(error)))
        except Exception as error:
            yield self._internal_error(label, error)

    def _internal_error(self, name: str | None, error: Exception) -> dict[str, Any]:
        reason = internal_error.finding_of(error)
        self.internal_errors += reason.code == internal_error.CODE
        return failure(name, reason)

    def _store(
        self,
        path: str | None,
        measured: list[tuple[str, bpy.types.Object, Measurement]],
        wanted: MeasureOptions,
    ) -> Iterator[dict[str, Any]]:
        """Store the results of all objects, and yield the entries about failures.

        It follows all measurements, as drivers may read results. Given settings are stored too, so that results fit.
        """
        if not bpy.data.filepath or path is not None and file_suffix(path) != BLEND:
            raise FileError(RESULTS_NEED_BLEND)
        for label, obj, one in measured:
            try:
                store(obj, one)
                with tracking_paused():  # the stored results already belong to these settings
                    settings.apply_options(obj.body_moments, wanted, bpy.context.scene)
            except MeasureError as refusal:
                yield failure(label, refusal.finding)
            except Exception as error:
                yield self._internal_error(label, error)
        mark_up_to_date(bpy.context, [obj for _, obj, _ in measured])


def _unavailable(part: str, refusal: MeasureError) -> Finding:
    """Return the finding that a part of a record is missing, with the cause."""
    return finding(PART_UNAVAILABLE, part=part, cause=refusal.finding.as_record())
