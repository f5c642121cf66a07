# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Similar: the objects of the scene, or the bodies of a library, nearest in shape to the active one.

Matches are kept with the scene, for the panel; objects are not changed except, on request, their selection.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Generator, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import bpy
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, PointerProperty, StringProperty
from bpy.types import Context, Event, Object, Operator, PropertyGroup, Scene

from ...blender.bodies.flat.flat_shape import FlatShape, body_or_flat, comparable_shape_of, distance_from
from ...blender.bodies.shape.shape import register_surfaces, surface_shape_of
from ...blender.bodies.shape.stack_signature import signed_in_turn
from ...blender.read.visibility import measurable_objects
from ...blender.session.stored import outcome
from ...blender.write import reports
from ...core.shape.library import UNDECIDED_HANDEDNESS, Entry, Similarity, classify, rank, read_library
from ...core.shape.registration import MAX_FIT_RTOL, RigidMatch
from ...core.shape.signatures import Likeness, Signature, similarity
from ...core.verdict.finding import FileError, Finding, MeasureError, finding, system_reason
from .. import selection
from ..findings import (
    LIBRARY_FILE_UNREADABLE,
    OBJECT_NOT_IN_VIEW_LAYER,
    RECORDS_LEFT_OUT,
)
from ..modal import ModalSteps, redraw

DESCRIPTOR_ORDER = 12  # ample to separate parts, in a fourth of the time of order 20
MAX_LISTED_BODIES = 20
MIRRORED = BoolProperty(name="Ignore Mirroring", default=False, description="Rank mirror images like copies")
SCALED = BoolProperty(name="Ignore Size", default=False, description="Rank scaled copies like copies")


class BodyMomentsSimilar(PropertyGroup):
    """One shape that was found."""

    name: StringProperty(name="Name")
    file: StringProperty(name="File")
    verdict: StringProperty(name="Similarity", description="Relation to the object that was searched for")
    distance: FloatProperty(name="Distance", description="Difference of the signatures, 0 for a copy")
    scale: FloatProperty(name="Size", description="Size relative to the object that was searched for")


class BodyMomentsSearch(PropertyGroup):
    """The last search."""

    wanted: StringProperty(name="Object")
    looked_at: StringProperty(name="Library")
    found: CollectionProperty(type=BodyMomentsSimilar)


COUNTS = {  # texts of the report, by similarity
    Similarity.COPY: ("{count} copy", "{count} copies"),
    Similarity.SCALED_COPY: ("{count} scaled copy", "{count} scaled copies"),
    Similarity.MIRROR: ("{count} mirror image", "{count} mirror images"),
    Similarity.SCALED_MIRROR: ("{count} scaled mirror image", "{count} scaled mirror images"),
    Similarity.COPY_OR_MIRROR: ("{count} copy or mirror image", "{count} copies or mirror images"),
    Similarity.SCALED_COPY_OR_MIRROR: (
        "{count} scaled copy or mirror image",
        "{count} scaled copies or mirror images",
    ),
    Similarity.SIMILAR: ("{count} similar", None),
}


class _SearchMixin:
    """The common part of both searches."""

    bl_label: str
    bl_options = {"REGISTER", "UNDO"}
    mirrored: bool
    scaled: bool

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.mode != "OBJECT":
            return reports.unavailable(cls, "Switch to Object Mode")
        if context.object is None:
            return reports.unavailable(cls, "Make an object active to compare with")
        return True

    def measure_active(self, context: Context) -> Iterator[float]:
        """Measure the active object: `shape`, and `wanted`, its signature.

        `wanted` stays None with a report if there is no signature.
        """
        self.wanted: Signature | None = None
        try:
            self.shape = comparable_shape_of(context.object, context.evaluated_depsgraph_get())
            yield 0.0
            self.wanted = self.shape.signature(DESCRIPTOR_ORDER)
        except MeasureError as error:
            reports.report(self, reports.refusal(error.about(context.object.name)))

    def store_results(self, context: Context, ranked: list[tuple[Entry, Likeness]], looked_at: str) -> None:
        search = context.scene.body_moments_search
        search.wanted, search.looked_at = context.object.name, looked_at
        search.found.clear()
        for entry, likeness in ranked[:MAX_LISTED_BODIES]:
            row = search.found.add()
            row.name, row.file, row.verdict = entry.name, entry.file, classify(likeness).value
            row.distance = likeness.distance(self.scaled, self.mirrored)
            row.scale = likeness.scale

    def report_found(self, rows: list[tuple[Entry, Likeness]], failures: list[Finding]) -> set[str]:
        counts = Counter(classify(likeness) for _, likeness in rows)
        alike = [reports.phrase(*COUNTS[kind], count=counts[kind]) for kind in COUNTS if counts[kind]]
        found = ", ".join(alike) if alike else reports.phrase("none is similar")
        done = [reports.phrase("Compared {count} shape", "Compared {count} shapes", count=len(rows)), found]
        if rows:
            entry, likeness = rows[0]
            distance = likeness.distance(self.scaled, self.mirrored)
            done.append(reports.phrase("nearest is {object}, at {distance:.2e}", object=entry.name, distance=distance))
        outcome.remember(self.bl_label, failures)
        reports.report(self, *done, *reports.first(failures))
        return {"FINISHED"}


class OBJECT_OT_body_moments_find_similar(ModalSteps, _SearchMixin, Operator):
    """Find the visible objects most similar in shape to the active object."""

    bl_idname = "object.body_moments_find_similar"
    bl_label = "Find Similar"
    bl_description = (
        "Compare the shapes of all visible objects with the active object, in any pose, size and triangulation, and "
        "list copies, mirror images and similar shapes"
    )
    PROGRESS = "Comparing: {share:.0%}. Esc to cancel"
    CANCELED = "Search canceled; nothing was changed"

    select: BoolProperty(
        name="Select Copies",
        default=True,
        description="Select the copies of the active object, and deselect everything else",
    )
    mirrored: MIRRORED
    scaled: SCALED

    def execute(self, context: Context) -> set[str]:
        self._begin(context)
        return self.run_all_steps(context, len(self._others))

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        self._begin(context)
        return self.start_modal(context, len(self._others))

    def _begin(self, context: Context) -> None:
        self._others = [
            obj for obj in measurable_objects(context.view_layer) if obj != context.object and obj.visible_get()
        ]
        self._objects: dict[Entry, Object] = {}
        self._mirror_images: dict[Entry, bool | None] = {}  # only if the signatures leave it open
        self._failures: list[Finding] = []
        self._steps = self._compare(context)

    def _compare(self, context: Context) -> Generator[float, None, None]:
        yield from self.measure_active(context)
        wanted = self.wanted
        if wanted is None:
            return
        active_shape, skin, depsgraph = self.shape, None, context.evaluated_depsgraph_get()
        flat = isinstance(active_shape, FlatShape)
        of_body = (
            partial(surface_shape_of, depsgraph=depsgraph)
            if flat
            else signed_in_turn(self._others, depsgraph, DESCRIPTOR_ORDER)
        )

        def compare(obj: Object) -> Iterator[float]:
            nonlocal skin
            shape = body_or_flat(obj, depsgraph, of_body, flat)
            yield 0.3
            signature = shape if isinstance(shape, Signature) else shape.signature(DESCRIPTOR_ORDER)
            entry = Entry(obj.name_full, "", signature)
            likeness = similarity(wanted, entry.signature)
            if classify(likeness) in UNDECIDED_HANDEDNESS:
                yield 0.6
                if skin is None:
                    skin = distance_from(active_shape)
                    for _ in skin.build():
                        yield 0.6
                if isinstance(shape, Signature):
                    shape = surface_shape_of(obj, depsgraph)
                skin_compared = distance_from(shape)
                yield from (0.6 + 0.3 * share for share in skin_compared.build())
                self._mirror_images[entry] = _is_mirror_image(
                    register_surfaces(shape, active_shape, skin_compared, skin, 1.0 / likeness.scale), active_shape.size
                )
            self._objects[entry] = obj

        yield from selection.iterate_objects(self._others, compare, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Nothing is kept or selected before everything is compared, so that a canceled search leaves nothing."""
        if self.wanted is None:
            return {"CANCELLED"}
        ranked = [
            (entry, replace(likeness, is_mirror_image=self._mirror_images.get(entry, likeness.is_mirror_image)))
            for entry, likeness in rank(self.wanted, self._objects, self.scaled, self.mirrored)
        ]
        self.store_results(context, ranked, "")
        if self.select:
            chosen = {
                Similarity.COPY: True,
                Similarity.MIRROR: self.mirrored,
                Similarity.SCALED_COPY: self.scaled,
                Similarity.SCALED_MIRROR: self.mirrored and self.scaled,
            }
            picked = [self._objects[entry] for entry, likeness in ranked if chosen.get(classify(likeness))]
            for obj in context.view_layer.objects:
                obj.select_set(obj in picked or obj == context.object)
        redraw(context)
        return self.report_found(ranked, self._failures)


class OBJECT_OT_body_moments_find_in_library(_SearchMixin, Operator):
    """Find the bodies of a library most similar in shape to the active object."""

    bl_idname = "object.body_moments_find_in_library"
    bl_label = "Find in Library"
    bl_description = (
        "Compare the shape of the active object with those of a library, written by the command line with "
        "--signature --format jsonl"
    )

    mirrored: MIRRORED
    scaled: SCALED
    filepath: StringProperty(name="Library", description="File of the library", subtype="FILE_PATH")
    filter_glob: StringProperty(default="*.jsonl", options={"HIDDEN"})

    def invoke(self, context: Context, _event: Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        try:
            entries, missing = _read(path)
        except FileError as error:
            reports.report(self, error.finding)
            return {"CANCELLED"}
        for _ in self.measure_active(context):
            pass
        if self.wanted is None:
            return {"CANCELLED"}
        ranked = rank(self.wanted, entries, self.scaled, self.mirrored)
        self.store_results(context, ranked, path.name)
        causes = [without.as_record() for without in reports.first(missing)]
        return self.report_found(ranked, [finding(RECORDS_LEFT_OUT, causes=causes)] if missing else [])


class OBJECT_OT_body_moments_select_found(Operator):
    """Make this object active and select it"""

    bl_idname = "object.body_moments_select_found"
    bl_label = "Select Similar Object"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", description="Object to select")

    def execute(self, context: Context) -> set[str]:
        obj = next((candidate for candidate in context.view_layer.objects if candidate.name_full == self.name), None)
        if obj is None:
            reports.report(self, finding(OBJECT_NOT_IN_VIEW_LAYER, object=self.name))
            return {"CANCELLED"}
        for candidate in context.view_layer.objects:
            candidate.select_set(candidate == obj)
        context.view_layer.objects.active = obj
        return {"FINISHED"}


def _read(path: Path) -> tuple[list[Entry], list[Finding]]:
    try:
        return read_library(path)
    except OSError as error:
        raise FileError(LIBRARY_FILE_UNREADABLE, file=path.name, error=system_reason(error)) from error


def _is_mirror_image(match: RigidMatch, size: float) -> bool | None:
    """Return whether the match is a mirror image by the surfaces, or None if they do not decide it."""
    return False if match.max_distance <= MAX_FIT_RTOL * size else True if match.is_mirror_image else None


CLASSES = (
    BodyMomentsSimilar,
    BodyMomentsSearch,
    OBJECT_OT_body_moments_find_similar,
    OBJECT_OT_body_moments_find_in_library,
    OBJECT_OT_body_moments_select_found,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Scene.body_moments_search = PointerProperty(name="Similar Shapes", type=BodyMomentsSearch)


def unregister() -> None:
    del Scene.body_moments_search
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
