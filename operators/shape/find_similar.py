# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Similar: the objects of the scene, or the bodies of a library, nearest in shape to the
active one.

Matches are kept with the scene, for the panel; objects are not changed except, on request, their
selection.
"""

from collections import Counter
from collections.abc import Generator
from pathlib import Path

import bpy
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, StringProperty
from bpy.types import Context, Operator, PropertyGroup, Scene
from bpy_extras.io_utils import ImportHelper

from ...blender import read, session, write
from ...blender.session.selected import require_subject, subject
from ...core.verdict import Finding, MeasureError, system_reason
from .. import modal, selection

MAX_LISTED_BODIES = 20
MIRRORED = BoolProperty(name="Ignore Mirroring", description="Rank mirror images like copies")
SCALED = BoolProperty(name="Ignore Size", description="Rank scaled copies like copies")


class BodyMomentsSimilar(PropertyGroup):
    """One shape that was found."""

    name: StringProperty(name="Name")
    file: StringProperty(name="File")
    verdict: StringProperty(
        name="Similarity", description="Relation to the object that was searched for"
    )
    distance: FloatProperty(
        name="Distance", description="Difference of the signatures, 0 for a copy"
    )
    scale: FloatProperty(
        name="Size", description="Size relative to the object that was searched for"
    )


class BodyMomentsSearch(PropertyGroup):
    """The last search."""

    wanted: StringProperty(name="Object")
    looked_at: StringProperty(name="Library")
    found: CollectionProperty(type=BodyMomentsSimilar)


COUNTS = {  # texts of the report, by similarity
    "copy": ("{count} copy", "{count} copies"),
    "scaled_copy": ("{count} scaled copy", "{count} scaled copies"),
    "mirror": ("{count} mirror image", "{count} mirror images"),
    "scaled_mirror": ("{count} scaled mirror image", "{count} scaled mirror images"),
    "copy_or_mirror": ("{count} copy or mirror image", "{count} copies or mirror images"),
    "scaled_copy_or_mirror": (
        "{count} scaled copy or mirror image",
        "{count} scaled copies or mirror images",
    ),
    "similar": ("{count} similar", None),
}


class _SearchMixin:
    """Base of operators that search for shapes similar to the active object's."""

    bl_label: str
    mirrored: bool
    scaled: bool

    @classmethod
    def poll(cls, context: Context) -> bool:
        if subject(context) is None:
            return write.reports.unavailable(cls, "Make an object active to compare with")
        return selection.poll_object_mode(cls, context)

    def store_and_report(
        self,
        context: Context,
        matches: list["session.similar.Match"],
        looked_at: str,
        failures: list[Finding],
    ) -> set[str]:
        """Keep the nearest matches with the scene, and report the number of matches by
        similarity.

        matches: the nearest first. looked_at: name of the library's file, "" for the scene.
        """
        search = context.scene.body_moments_search
        search.wanted = require_subject(context).name
        search.looked_at = looked_at
        search.found.clear()
        for match in matches[:MAX_LISTED_BODIES]:
            row = search.found.add()
            for name in ("name", "file", "verdict", "distance", "scale"):
                setattr(row, name, getattr(match, name))
        counts = Counter(match.verdict for match in matches)
        alike = [
            write.reports.phrase(*COUNTS[kind], count=counts[kind])
            for kind in COUNTS
            if counts[kind]
        ]
        matches_text = ", ".join(alike) if alike else write.reports.phrase("none is similar")
        summary = [
            write.reports.phrase(
                "Compared {count} shape", "Compared {count} shapes", count=len(matches)
            ),
            matches_text,
        ]
        if matches:
            summary.append(
                write.reports.phrase(
                    "nearest is {object}, at {distance:.2e}",
                    object=matches[0].name,
                    distance=matches[0].distance,
                )
            )
        return selection.finish(self, summary, failures)


class OBJECT_OT_body_moments_find_similar(modal.ModalSteps, _SearchMixin, Operator):
    """Compare the shapes of all visible objects with the active object, in any pose, size and
    triangulation, and list copies, mirror images and similar shapes
    """

    bl_label = "Find Similar"
    PROGRESS = "Comparing: {share:.0%}. Esc to cancel"
    CANCELED = "Search canceled; nothing was changed"

    select: BoolProperty(
        name="Select Copies",
        default=True,
        description="Select the copies of the active object, and deselect everything else",
    )
    mirrored: MIRRORED
    scaled: SCALED

    def _begin(self, context: Context) -> int:
        subject = require_subject(context)
        self._others = [
            obj
            for obj in read.visibility.measurable_objects(context.view_layer)
            if obj != subject and obj.visible_get()
        ]
        self._failures: list[Finding] = []
        self._search = session.SimilarSearch(subject, context.evaluated_depsgraph_get())
        self._steps = self._compare(subject.name)
        return len(self._others)

    def _compare(self, name: str) -> Generator[float, None, None]:
        # name: of the active object, which is measured first
        try:
            yield from self._search.measure()
        except MeasureError as error:
            error.about(name)
            raise
        yield from selection.iterate_objects(
            self._others, self._search.comparison(self._others), self._failures
        )

    def _finish(self, context: Context) -> set[str]:
        """Keep and select the matches at the end, so that a canceled search changes nothing."""
        matches = self._search.find_nearest(self.scaled, self.mirrored)
        if self.select:
            # A mirror image or scaled copy counts as a copy if the search ignores the difference.
            is_selected = {
                "copy": True,
                "mirror": self.mirrored,
                "scaled_copy": self.scaled,
                "scaled_mirror": self.mirrored and self.scaled,
            }
            picked = {match.obj for match in matches if is_selected.get(match.verdict)}
            subject = require_subject(context)
            selection.select_only(context, {*picked, subject}, subject)
        return self.store_and_report(context, matches, "", self._failures)


class OBJECT_OT_body_moments_find_in_library(_SearchMixin, Operator, ImportHelper):
    """Compare the shape of the active object with those of a library, written by the command line
    with --signature --format jsonl
    """

    bl_label = "Find in Library"

    mirrored: MIRRORED
    scaled: SCALED
    filter_glob: StringProperty(default="*.jsonl", options={"HIDDEN"})

    def execute(self, context: Context) -> set[str]:
        path = Path(bpy.path.abspath(self.filepath))
        search = session.SimilarSearch(require_subject(context), context.evaluated_depsgraph_get())
        try:
            matches, missing = search.find_in_library(path, self.scaled, self.mirrored)
        except OSError as error:
            return selection.refuse(
                self, "{file} cannot be read: {error}", file=path.name, error=system_reason(error)
            )
        except MeasureError as error:
            return selection.refuse(self, error.about(require_subject(context).name))
        return self.store_and_report(context, matches, path.name, missing)


class OBJECT_OT_body_moments_select_found(Operator):
    """Select these objects and make the first one active"""

    bl_label = "Select Similar Object"

    name: StringProperty(name="Name", description="Objects to select, one a line")

    def execute(self, context: Context) -> set[str]:
        names = set(self.name.split("\n"))
        objects = [
            candidate for candidate in context.view_layer.objects if candidate.name_full in names
        ]
        if not objects:
            return selection.refuse(self, "No object {object} in the view layer", object=self.name)
        selection.select_only(context, objects, objects[0])
        return {"FINISHED"}


POINTERS = {(Scene, "body_moments_search"): BodyMomentsSearch}
