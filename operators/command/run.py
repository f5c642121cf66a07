# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""From a file to its document: open it, measure its objects, store the results on them where that
is asked for.

Whatever fails is an entry in `errors` and stops nothing else: a file that cannot be opened, an
object that cannot be measured, a file that cannot be saved. A failure that nobody foresaw is one
too, with its traceback on the standard error.
"""

from __future__ import annotations

import os
import re
import sys
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from ...core.measurement import Measurement
from ...core.scans import formats as scans
from ...core.verdict import internal_error
from ..bodies.array import ArrayOptions, measure_array
from ..bodies.measure_object import THREADS, measure_object
from ..bodies.shape import DISPLAY_MESH, OF_SHAPES, POLYGONS, NoShape, shape_of
from ..read import Unreadable, measurable, measurable_objects
from ..session.staleness import settle
from ..session.total_caveats import LISTED, doubts, unfounded
from ..settings import properties as settings
from ..settings.options import MeasureOptions
from ..write import record
from ..write.properties import store
from ..write.text import listed
from . import fourier
from .files import BLEND, UNITLESS, Unusable, open_file, suffix
from .saving import Place, reserved

_OF_ARRAYS = ("spacing", "origin", "spline_order", "density_scale")
_BLEND_WORD = re.compile(r"\.blend\d*$", re.IGNORECASE)


@dataclass
class Run:
    """One command line at work.

    documents: one for each file, in order. faults: how many of their errors are our own.
    """

    options: Namespace
    documents: list[dict[str, Any]] = field(default_factory=list)
    faults: int = 0

    def __post_init__(self) -> None:
        wanted = {name: getattr(self.options, name) for name in ("kind", "density", "mass", "thickness", "overlap")}
        self._wanted = MeasureOptions(
            **wanted,
            order=self.options.order,
            surface=self.options.surface_moments,
            threads=THREADS,
        )

    def measure(self) -> None:
        """Measure every file that was named, or else the one that is open."""
        for path in self.options.files or [None]:
            self.documents.append(self._document(path))

    @property
    def errors(self) -> int:
        """How many entries the documents have under `errors`."""
        return sum(len(document["errors"]) for document in self.documents)

    def _document(self, path: str | None) -> dict[str, Any]:
        file = path or bpy.data.filepath or _asked_for()
        with self._place(path) as place:
            return self._measured(path, file, place)

    def _place(self, path: str | None) -> AbstractContextManager[Place | None]:
        """Where --write is going to store the results."""
        target = path or bpy.data.filepath
        if not self.options.write or path is not None and suffix(path) != BLEND or not os.path.isfile(target):
            return nullcontext()
        asked = _asked_for() if path is None else None
        at_start = asked is not None and os.path.realpath(asked) == os.path.realpath(target)
        return reserved(target, path is None, at_start)

    def _measured(self, path: str | None, file: str | None, place: Place | None) -> dict[str, Any]:
        measured: list[tuple[str, bpy.types.Object, Measurement]] = []
        objects, errors, doubtful = [], [], []
        try:
            if path is not None and scans.suffix(path):
                objects, measured, errors = self._array(path)
                wanted = self._wanted
            else:
                self._open(path, file)
                note = (*_unit_note(path, self.options.unit_scale), *_array_notes(self.options))
                # Not by way of the scene, whose unit scale is a float32 with limits.
                unit = (self.options.unit_scale or 1.0) if _unitless(path) else None
                wanted = replace(self._wanted, unit_scale=unit)
                chosen, errors = _chosen(self.options.object)
                errors.extend(_missing_links())
                for label, obj in chosen:
                    try:
                        one, told = self._recorded(label, obj, wanted, note, errors)
                    except Unreadable as refusal:
                        errors.append(_error(label, refusal.reason))
                    except Exception as error:
                        errors.append(self._fault(label, error))
                    else:
                        objects.append(told)
                        measured.append((label, obj, one))
                doubtful = unfounded((label, one.method) for label, _, one in measured)
                if self.options.object is None:  # else whoever named them knows what they count
                    doubtful += doubts([obj for _, obj, _ in measured], bpy.context.view_layer)
                    doubtful += _other_scenes(bpy.context.scene)
                if self.options.fourier:
                    errors.extend(self._fourier(chosen, wanted, objects))
            if self.options.write:
                errors.extend(self._store(path, measured, wanted))
                doubtful += _save(place, file)
        except Unusable as refusal:
            errors.append(_error(None, refusal))
        except Exception as error:
            errors.append(self._fault(None, error))
        for one in errors:
            where = [text for text in ("body_moments", file, one["name"]) if text]
            sys.stderr.write("{}: {}\n".format(": ".join(where), one["reason"]))
        return record.document(
            objects,
            record.total([one for _, _, one in measured], doubtful),
            errors,
            file=file,
            blender=".".join(map(str, bpy.app.version)),
            frame=self.options.frame,
        )

    def _recorded(
        self,
        label: str,
        obj: bpy.types.Object,
        wanted: MeasureOptions,
        notes: tuple[str, ...],
        errors: list[dict[str, Any]],
    ) -> tuple[Measurement, dict[str, Any]]:
        """An object's measurement and its record. What has no moments of the order that was asked for may have a mass:
        then the record goes without them, and an error is added that says so.
        """
        order = self.options.order
        try:
            one, more = self._measure(obj, wanted)
        except Unreadable as refusal:
            if order is None:
                raise
            one, more = self._measure(obj, replace(wanted, order=None, surface=False))
            errors.append(_error(label, "It has no such moments: " + refusal.reason))
            order = None
        surface = one.area_moments if self.options.surface_moments and order is not None else None
        told = replace(one, name=label, warnings=(*one.warnings, *notes, *self._unused(one)))
        return one, record.record(told, self.options.frame, order, surface, more)

    def _unused(self, one: Measurement) -> Iterator[str]:
        if self.options.thickness is not None and one.kind != "shell":
            yield "Only a shell has a thickness; --thickness was not used here (see --kind)."

    def _array(self, path: str) -> tuple[list, list, list]:
        """The records, measurements and errors of a scan or an array, which is one body, called like
        its file.
        """
        name = os.path.basename(path)[: -len(scans.suffix(path))]
        names = [name] if self.options.object is None else self.options.object
        errors = [_error(one, "The file has no object of this name.") for one in names if one != name]
        if self.options.fourier:
            errors.append(_error(None, "Of an array of densities no Fourier transform is computed."))
        if name not in names:
            return [], [], errors
        taken = {one: getattr(self.options, one) for one in (*_OF_ARRAYS, "unit_scale")}
        array = ArrayOptions(**{one: value for one, value in taken.items() if value is not None})
        try:
            one = measure_array(path, name, array, self._wanted)
        except Unreadable as refusal:
            return [], [], [*errors, _error(None, refusal.reason)]
        asked = [more for more in ("pose", "signature") if getattr(self.options, more)]
        surface = one.area_moments if self.options.surface_moments else None
        one = replace(one, warnings=(*one.warnings, *self._unused(one), *([OF_SHAPES] if asked else ())))
        told = record.record(one, self.options.frame, self.options.order, surface, dict.fromkeys(asked))
        return [told], [(name, None, one)], errors

    def _open(self, path: str | None, file: str | None) -> None:
        if path is not None:
            open_file(path)
        elif file and not bpy.data.filepath:
            raise Unusable("Blender could not open the file; check that it is there, and whole.")

    def _fourier(
        self,
        chosen: list[tuple[str, bpy.types.Object]],
        wanted: MeasureOptions,
        objects: list[dict[str, Any]],
    ) -> Iterator[dict[str, Any]]:
        """Write the Fourier transform of the one object that was measured, and tell what was decided on the way in
        its record.
        """
        if len(chosen) != 1:
            reason = "A Fourier transform takes one object, and there are {}; name it with --object."
            yield _error(None, reason.format(len(chosen)))
            return
        if not objects:
            return  # the reason is told already
        (label, obj), (told,) = chosen[0], objects
        try:
            notes = fourier.write(obj, self.options, wanted)
            told["warnings"] += [note for note in notes if note not in told["warnings"]]
        except Unreadable as refusal:
            yield _error(label, "It has no Fourier transform: {}".format(refusal.reason))
        except OSError as error:
            yield _error(label, "Its Fourier transform cannot be written: {}.".format(error.strerror or error))
        except Exception as error:
            yield self._fault(label, error)

    def _measure(self, obj: bpy.types.Object, wanted: MeasureOptions) -> tuple[Measurement, dict[str, Any]]:
        """The object's measurement, and its pose and signature where they are asked for: None of
        what has no shape of its own, which is measured all the same.
        """
        depsgraph = bpy.context.evaluated_depsgraph_get()
        asked = [name for name in ("pose", "signature") if getattr(self.options, name)]
        if not asked:
            return measure_object(obj, depsgraph, wanted), {}
        try:
            shape = shape_of(obj, depsgraph, wanted)
        except NoShape as refusal:
            one = refusal.measurement
            told = replace(one, warnings=(*one.warnings, refusal.reason))
            return told, dict.fromkeys(asked)
        more = {"pose": shape.pose()} if self.options.pose else {}
        one = shape.measurement
        if self.options.signature and shape.has_surface:
            more["signature"] = shape.signature().as_record()
            if one.method.startswith("NURBS"):
                one = replace(one, warnings=(*one.warnings, DISPLAY_MESH))
        elif self.options.signature:
            more["signature"] = None
            one = replace(one, warnings=(*one.warnings, POLYGONS))
        return one, more

    def _fault(self, name: str | None, error: Exception) -> dict[str, Any]:
        self.faults += 1
        return _error(name, internal_error.reason(error))

    def _store(
        self,
        path: str | None,
        measured: list[tuple[str, bpy.types.Object, Measurement]],
        wanted: MeasureOptions,
    ) -> Iterator[dict[str, Any]]:
        """Store the results, once all of them are there: drivers may read them and change what is
        measured next. The settings that were given go with them, or the results would be out of date.
        """
        if path is not None and suffix(path) != BLEND:
            raise Unusable("Only a .blend file can keep the results; --write did nothing here.")
        if not bpy.data.filepath:
            raise Unusable("The scene has never been saved, so --write has no file to save.")
        for label, obj, one in measured:
            try:
                store(obj, one)
                settings.keep(obj.body_moments, wanted, bpy.context.scene)
            except Exception as error:
                if internal_error.is_refusal(error, (RuntimeError,)):
                    yield _error(label, error)
                else:
                    yield self._fault(label, error)
        settle(bpy.context, [obj for _, obj, _ in measured])


def _error(name: str | None, reason: object) -> dict[str, Any]:
    return {"name": name, "reason": str(reason)}


def _chosen(
    names: list[str] | None,
) -> tuple[list[tuple[str, bpy.types.Object]], list[dict[str, Any]]]:
    """The objects to measure, each under a name of its own, and an error for each name of none.

    What the view layer excludes is among them: reading it tells why it cannot be measured.
    """
    scene, layer = bpy.context.scene, bpy.context.view_layer
    same = Counter(obj.name for obj in scene.objects)
    # A linked object may have a local one's name; the full name tells the library too.
    labels = {obj: obj.name if same[obj.name] == 1 else obj.name_full for obj in scene.objects}
    if names is None:
        wanted = {*measurable_objects(layer), *_excluded(scene, layer)}
        return [(label, obj) for obj, label in labels.items() if obj in wanted], []
    chosen, errors = [], []
    for name in names:
        found = [(label, obj) for obj, label in labels.items() if label == name]
        found = found or [(label, obj) for obj, label in labels.items() if obj.name == name]
        chosen += [pair for pair in found if pair not in chosen]
        if not found:
            errors.append(_error(name, "The scene has no object of this name."))
    return chosen, errors


def _missing_links() -> Iterator[dict[str, Any]]:
    """An error where Blender opened a file but not what it links to. It puts empty data there."""
    data = bpy.data
    groups = (data.objects, data.meshes, data.curves, data.metaballs, data.collections)
    missing = [item.name_full for group in (*groups, data.node_groups) for item in group if item.is_missing]
    if missing:
        reason = "Linked data is missing; put the linked files back, or make the data local: {}."
        yield _error(None, reason.format(", ".join(sorted(missing))))


def _excluded(scene: bpy.types.Scene, layer: bpy.types.ViewLayer) -> set[bpy.types.Object]:
    """The scene's measurable objects outside of its view layer, but for the members of instanced
    collections, which the instancers' records hold.
    """
    instancers = [obj for obj in scene.objects if obj.instance_type == "COLLECTION"]
    instanced = {obj.instance_collection for obj in instancers} - {None}
    members = {member for collection in instanced for member in collection.all_objects}
    return {obj for obj in {*scene.objects} - {*layer.objects} - members if measurable(obj)}


def _other_scenes(scene: bpy.types.Scene) -> Iterator[str]:
    """That a file holds more than its open scene, where it does."""
    here = {*scene.objects}
    others = [one for one in bpy.data.scenes if any(measurable(obj) for obj in {*one.objects} - here)]
    if others:
        names = listed(("“{}”".format(one.name) for one in others), LISTED)
        yield "Only the scene “{}” was measured; objects of others were not: {}.".format(scene.name, ", ".join(names))


def _asked_for() -> str | None:
    """The .blend file that Blender was started with. It runs a command on its start-up scene when
    it cannot open it.
    """
    for word in sys.argv[1:]:
        if word in ("-c", "--command", "--"):
            return None
        if _BLEND_WORD.search(word) and not word.startswith("-"):
            return word
    return None


def _unitless(path: str | None) -> bool:
    return path is not None and suffix(path) in UNITLESS


def _unit_note(path: str | None, scale: float | None) -> tuple[str, ...]:
    """The decision about the file's unit, where there was one."""
    unitless = _unitless(path)
    if unitless and scale is None:
        return ("The file carries no unit; 1 unit is taken as 1 m (set --unit-scale).",)
    if not unitless and scale is not None:
        return ("The file carries its own unit; --unit-scale was not used.",)
    return ()


def _array_notes(options: Namespace) -> Iterator[str]:
    """What was asked of arrays only, of a file that is none."""
    given = [name for name in _OF_ARRAYS if getattr(options, name) is not None]
    if given:
        words = ", ".join("--" + name.replace("_", "-") for name in given)
        yield "Only arrays and scans take {}; it was not used here.".format(words)


def _save(place: Place | None, file: str | None) -> tuple[str, ...]:
    """Save the file that was opened. Returns warnings, which are on the standard error too."""
    if place is None:
        raise Unusable("The file cannot be saved: it is no longer there.")
    warnings = place.save()
    for warning in warnings:
        sys.stderr.write("body_moments: {}: {}\n".format(file, warning))
    return warnings
