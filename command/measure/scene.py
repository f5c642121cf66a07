# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A .blend file, or a file that Blender imports, as the open scene: measurement of its objects,
storage of results.
"""

import os
from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import bpy

from ...blender import read, session, write
from ...blender.bodies import cuts, overlaps, stack
from ...blender.bodies.flat.region import NO_BODY
from ...blender.bodies.measure_body import measure_body
from ...blender.session.stored import floating
from ...blender.session.tracking.staleness import mark_up_to_date
from ...blender.settings import density, given
from ...blender.settings import properties as settings
from ...blender.settings.options import MeasureOptions
from ...blender.write.properties import store
from ...core import bodies, cad, mesh, verdict
from ...core.cuts import CutFill
from ...core.floating import Flotation
from ...core.measurement import Measurement, record
from ...core.verdict import FileError, Finding, MeasureError, QueryError, finding, system_reason
from ..files import references, saving, suffixes
from ..files.opening import newer_version, open_file, open_name
from ..findings import (
    FOURIER_OBJECT_COUNT,
    MEASURED_AS_SHELL,
    NEEDS_BLEND,
    PART_UNAVAILABLE,
    RESULTS_NOT_STORED,
    SOLID_OPERAND_MEASURED,
)
from ..options.checks import body_findings, density_of, file_findings, is_unitless
from ..supervisor.listing import BLEND
from . import combined, robots
from .entries import Contents, cut_entries, failure, floating_entry, is_open_sheet
from .measuring import (
    measure_shape,
    measured_together,
    objects_to_measure,
    other_scenes,
    record_of_flat,
    set_density,
    thumbnail_of,
    why_nothing,
    write_transform,
)


def measure_options(options: Namespace, threads: int) -> MeasureOptions:
    """Return the options of a command line that override the settings of objects."""
    return MeasureOptions(
        **{
            name: getattr(options, name)
            for name in ("kind", "mass", "thickness", "overlap", "wall")
        },
        density=density_of(options),
        printed=options.print or (),
        order=options.order,
        surface=options.surface_moments,
        threads=threads,
    )


class Scene:
    """The file at a path, once it is open, or the open file if there is no path.

    has_saved: whether the file was saved in place. opened: the files that Blender has read with it.
    """

    def __init__(self, path: str | None, options: Namespace, threads: int) -> None:
        self._path, self.options = path, options
        self._wanted = measure_options(options, threads)
        self._combined = combined.Combined()
        # The objects of each floating body, by the first of them that is measured.
        self._afloat: dict[bpy.types.Object, list[bpy.types.Object]] = {}
        self._is_open = self.has_saved = False
        self.opened: Sequence[str] = ()

    def measure(self, contents: Contents) -> None:
        """Open the file and measure its objects. Raises MeasureError."""
        path, options = self._path, self.options
        self._place = self._place_of_results()
        opened = open_file(path, options.at_frame)
        self._is_open = True
        self.opened = bpy.utils.blend_paths(absolute=True, packed=False)
        # Not set in the scene, whose unit scale is a float32 with limits.
        self._wanted = replace(
            self._wanted, unit_scale=(options.unit_scale or 1.0) if is_unitless(path) else None
        )
        labeled_objects, contents.left_out, contents.errors = objects_to_measure(
            options.object, options.all, opened.hidden
        )
        contents.errors += [
            failure(None, reason) for reason in (*opened.errors, *references.missing_links())
        ]
        self._measure_each(labeled_objects, opened, contents)
        contents.caveats += references.scripts_of_open_file() if path is None else ()
        contents.caveats += verdict.open_body_caveats(
            (label, measurement.method) for label, _, measurement in contents.measured
        )
        if options.object is None:  # A user who names objects knows what their total means.
            objects = [obj for _, obj, _ in contents.measured]
            depsgraph = bpy.context.evaluated_depsgraph_get()
            contents.caveats += (
                *read.assembly.total_caveats(objects, bpy.context.view_layer),
                *overlaps.overlap_caveats(objects, depsgraph),
                *other_scenes(bpy.context.scene),
            )
            self._combined = combined.measure_combined(
                self._wanted, contents, options.asset_metadata is not None
            )
            if options.float:
                self._float_assemblies(contents)
        if options.fourier:
            contents.errors.extend(self._fourier(labeled_objects, contents))
        if not contents.objects and not contents.flats and not contents.errors:
            contents.errors.append(failure(None, why_nothing(len(contents.left_out))))

    def store(self, contents: Contents) -> None:
        """Save results and the metadata of assets, if they are requested. Raises MeasureError."""
        path, options = self._path, self.options
        if options.write:
            self._store(contents)
            self._combined.store(contents)
        is_changed = options.write
        if options.asset_metadata and path is not None and suffixes.file_suffix(path) == BLEND:
            object_measurements = {obj: measurement for _, obj, measurement in contents.measured}
            in_file, asset_findings = saving.write_assets(
                object_measurements | self._combined.measurements(), path, options.asset_metadata
            )
            is_changed = is_changed or in_file
            contents.caveats += asset_findings
        if is_changed:
            if self._place is None:
                raise FileError(
                    write.findings.FILE_NOT_WRITTEN, file=path or open_name(), error="it is gone"
                )
            self._place.save()
            self.has_saved = True

    def complete(self, document: dict[str, Any], contents: Contents) -> dict[str, Any]:
        """Return a document with the scene's assemblies, bones and flat shapes, and its text as a
        robot.
        """
        document |= self._combined.records(self.options.frame)
        document |= {"flat": contents.flats} if self.options.flat else {}
        return robots.complete(
            document, contents.measured, self.options, self._wanted, is_opened=self._is_open
        )

    def _place_of_results(self) -> saving.Place | None:
        """Return the .blend file in which results will be saved, None if there is none.

        Raises FileError.
        """
        is_saved = self.options.write or self.options.asset_metadata == "file"
        is_blend = self._path is None or suffixes.file_suffix(self._path) == BLEND
        target = self._path or bpy.data.filepath
        return (
            saving.Place.of_file(target)
            if is_saved and is_blend and os.path.isfile(target)
            else None
        )

    def _measure_each(
        self,
        labeled_objects: list[tuple[str, bpy.types.Object]],
        opened: references.Opened,
        contents: Contents,
    ) -> None:
        """Add the measurements of the objects, or errors about them, with findings about the file
        and the object.
        """
        file_notes = (
            *opened.notes,
            *file_findings(self._path, self.options),
            *references.blocked_scripts(),
            *newer_version(),
        )
        operands = (
            read.assembly.operands_of(bpy.context.scene.objects)
            if self.options.object is None
            else {}
        )
        left_out = {entry["name"] for entry in contents.left_out}
        objects = [obj for _, obj in labeled_objects]
        for body in floating.bodies_of(objects, False) if self.options.float else ():
            members = [obj for obj in body if obj.name not in left_out]
            first = next(obj for obj in members if obj in objects)
            self._afloat[first] = members
        in_turn = measured_together([obj for _, obj in labeled_objects], self.options, self._wanted)
        for label, obj in labeled_objects:
            user = operands.get(obj)
            cut = [] if user is None else [finding(SOLID_OPERAND_MEASURED, object=user.name)]
            with contents.attempt(label):
                about = (*opened.by_object.get(obj.name, ()), *file_notes, *cut)
                self._measure_object(label, obj, in_turn, about, contents)
        contents.flats.sort(key=lambda entry: entry["name"])

    def _measure_object(
        self,
        label: str,
        obj: bpy.types.Object,
        in_turn: Callable[[bpy.types.Object], stack.Measured] | None,
        findings: tuple[Finding, ...],
        contents: Contents,
    ) -> None:
        """Add an object's measurement and its record, or the record of a flat shape.

        in_turn: measures the objects together; None if each has to be measured by itself. findings:
        about the object's file.
        """
        set_density(obj, self.options)
        measured = self._measure_or_less(label, obj, in_turn, findings, contents)
        if measured is None:
            return
        measurement, extra_entries, shape_findings, measure_options = measured
        order = measure_options.order
        surface = (
            measurement.area_moments if self.options.surface_moments and order is not None else None
        )
        findings = (
            *(*measurement.findings, *shape_findings, *findings),
            *(*self._default_density(obj, measurement), *body_findings(self.options, measurement)),
        )
        place_error = read.places.place_error(obj) * self._wanted.meters_per_unit(bpy.context.scene)
        labeled = replace(measurement, name=label, findings=findings, place_error=place_error)
        if given.COLLIDERS in obj:
            colliders = session.colliders.collider_record(obj, measurement, bpy.context)
            extra_entries |= {} if colliders is None else {"colliders": colliders}
        entries, body_notes = self._body_entries(obj, labeled, measure_options, contents)
        extra_entries |= entries
        labeled = replace(labeled, findings=(*labeled.findings, *body_notes))
        if self.options.thumbnails:
            unit = self._wanted.meters_per_unit(bpy.context.scene)
            extra_entries["thumbnail"] = thumbnail_of(obj, measurement, unit)
        entry = record.record(
            labeled, self.options.frame, order, surface, extra_entries, self.options.about
        )
        contents.objects.append(entry)
        contents.measured.append((label, obj, measurement))

    def _measure_or_less(
        self,
        label: str,
        obj: bpy.types.Object,
        in_turn: Callable[[bpy.types.Object], stack.Measured] | None,
        findings: tuple[Finding, ...],
        contents: Contents,
    ) -> tuple[Measurement, dict[str, Any], tuple[Finding, ...], MeasureOptions] | None:
        """Return an object's measurement, entries of its record, findings, and the options that
        were possible: an open sheet becomes a shell, and moments of a high order may be left out.

        Return None for a flat shape, whose record is added, and for a body whose faces are missing
        in the file. Raises MeasureError.
        """
        measure_options = self._wanted
        try:
            if in_turn:
                return in_turn(obj).measurement, {}, (), measure_options
            return *measure_shape(obj, self.options, measure_options), measure_options
        except MeasureError as refusal:
            has_no_body = refusal.finding.code in NO_BODY
            if self.options.flat and has_no_body:
                contents.flats.append(
                    record_of_flat(
                        label, obj, self.options, measure_options.unit_scale, refusal, findings
                    )
                )
                return None
            if is_open_sheet(refusal, self.options):
                shell = replace(measure_options, kind="shell")
                measurement, entries, notes = measure_shape(obj, self.options, shell)
                return measurement, entries, (*notes, finding(MEASURED_AS_SHELL)), shell
            if has_no_body and any(note.code == cad.FACES_NOT_READ for note in findings):
                return None  # The file's errors name the faces that are missing.
            if measure_options.order is None:
                raise
            without_moments = replace(measure_options, order=None)
            measured = measure_shape(obj, self.options, without_moments)
            contents.errors.append(failure(label, _unavailable("moments of this order", refusal)))
            return *measured, without_moments

    def _body_entries(
        self,
        obj: bpy.types.Object,
        measurement: Measurement,
        measure_options: MeasureOptions,
        contents: Contents,
    ) -> tuple[dict[str, Any], tuple[Finding, ...]]:
        """Return the entries of cuts and of floating, if requested, and findings about them."""
        scene = bpy.context.scene
        depsgraph = bpy.context.evaluated_depsgraph_get()
        entries: dict[str, Any] = {}
        findings: tuple[Finding, ...] = ()

        def against_object(name: str, surface: mesh.Surface) -> CutFill:
            other_object = scene.objects.get(name)
            if other_object is None:
                raise QueryError(session.findings.NO_SUCH_NAME, kind="object", name=name)
            return cuts.cut_fill_against(
                other_object, surface, depsgraph, measure_options.meters_per_unit(scene)
            )

        if self.options.below is not None or self.options.against is not None:
            body = measure_body(obj, depsgraph, measure_options).body
            entries, findings = cut_entries(
                measurement, body, self.options, contents, against_object
            )
        if obj in self._afloat:
            entry, floating_findings = self._floating(self._afloat[obj], measurement, contents)
            return entries | entry, (*findings, *floating_findings)
        return entries, findings

    def _float_assemblies(self, contents: Contents) -> None:
        """Add where each assembly floats as one body to its record."""
        left_out = {entry["name"] for entry in contents.left_out}
        for assembly in self._combined.assemblies:
            root = assembly.root.member.data
            objects = [root, *root.children_recursive]
            if isinstance(root, bpy.types.Collection):
                objects = root.all_objects
            members = [
                obj
                for obj in objects
                if read.visibility.measurable(obj) and obj.name not in left_out
            ]
            self._combined.more[root] = self._floating(members, assembly.measurement, contents)[0]

    def _floating(
        self, members: Sequence[bpy.types.Object], measurement: Measurement, contents: Contents
    ) -> tuple[dict[str, Any], tuple[Finding, ...]]:
        """Return the entry of objects that float as one body, and findings about it."""
        measure_options = replace(self._wanted, order=None, surface=False)

        def settle() -> Flotation:
            for member in members:
                set_density(member, self.options)
            depsgraph = bpy.context.evaluated_depsgraph_get()
            return floating.read(depsgraph, members, measure_options, self.options.float).rest

        entry, findings = floating_entry(settle, measurement, self.options, contents)
        if entry["floating"] and len(members) > 1:
            entry["floating"]["parts"] = [member.name for member in members]
        return entry, findings

    def _default_density(
        self, obj: bpy.types.Object, measurement: Measurement
    ) -> Iterator[Finding]:
        """Yield a finding if neither an option nor the object sets the density."""
        if (
            self.options.density is not None
            or self.options.mass is not None
            or self.options.material is not None
        ):
            return
        unset = density.unset_density(obj, measurement, bpy.context.scene)
        if unset is not None:
            default = "1 kg/m" if unset == "linear_density" else "1000 kg/m³"
            yield finding(bodies.DENSITY_DEFAULTED, density=default)

    def _fourier(
        self, labeled_objects: list[tuple[str, bpy.types.Object]], contents: Contents
    ) -> Iterator[dict[str, Any]]:
        """Write the Fourier transform of the one measured object, and add the findings to its
        record.
        """
        if len(labeled_objects) != 1:
            yield failure(None, finding(FOURIER_OBJECT_COUNT, count=len(labeled_objects)))
            return
        if not (contents.objects or contents.flats):
            return  # the reason is among the errors already
        (label, obj) = labeled_objects[0]
        (entry,) = (*contents.objects, *contents.flats)
        try:
            record.add_findings(entry, write_transform(obj, self.options, self._wanted))
        except MeasureError as refusal:
            yield failure(label, _unavailable("Fourier transform", refusal))
        except OSError as error:
            file = str(self.options.fourier)
            missing_transform = finding(
                write.findings.FILE_NOT_WRITTEN, file=file, error=system_reason(error)
            )
            yield failure(label, missing_transform)
        except Exception as error:
            yield contents.internal(label, error)

    def _store(self, contents: Contents) -> None:
        """Store the results of all objects.

        It follows all measurements, as drivers may read results. Given settings are stored too, so
        that results fit.
        """
        if (
            not bpy.data.filepath
            or self._path is not None
            and suffixes.file_suffix(self._path) != BLEND
        ):
            raise FileError(RESULTS_NOT_STORED, cause=NEEDS_BLEND)
        for label, obj, measurement in contents.measured:
            with contents.attempt(label):
                store(obj, measurement)
                with (
                    read.tracking.tracking_paused()
                ):  # the stored results already belong to these settings
                    settings.apply_options(obj.body_moments, self._wanted, bpy.context.scene)
        mark_up_to_date(bpy.context, [obj for _, obj, _ in contents.measured])


def _unavailable(part: str, refusal: MeasureError) -> Finding:
    return finding(PART_UNAVAILABLE, part=part, cause=refusal.finding.as_record())
