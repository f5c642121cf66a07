# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Similar: the objects of the scene, or the bodies of a library, nearest in shape to the active one; Link Copies.

Matches are kept with the scene, for the panel; objects are not changed except, on request, their selection. Link Copies
lets equal objects share one mesh.
"""

from collections import Counter
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Event, Operator, PropertyGroup, Scene

from ...blender import scene, session
from ...blender.read.tracking import tracking_paused
from ...blender.read.visibility import measurable_objects
from ...blender.write import reports
from ...core.verdict.finding import Finding, MeasureError, system_reason
from .. import selection
from ..modal import ModalSteps

if TYPE_CHECKING:
    from ...blender.scene.copies import Copies
    from ...blender.session.similar import Match

MAX_LISTED_BODIES = 20
MIRRORED = BoolProperty(name="Ignore Mirroring", description="Rank mirror images like copies")
SCALED = BoolProperty(name="Ignore Size", description="Rank scaled copies like copies")


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
    """The common part of both searches."""

    bl_label: str
    bl_options = {"REGISTER", "UNDO"}
    mirrored: bool
    scaled: bool

    @classmethod
    def poll(cls, context: Context) -> bool:
        if context.object is None:
            return reports.unavailable(cls, "Make an object active to compare with")
        return selection.poll_object_mode(cls, context)

    def store_and_report(
        self, context: Context, matches: list["Match"], looked_at: str, failures: list[Finding]
    ) -> set[str]:
        """Keep the nearest matches with the scene, and report the number of matches by similarity."""
        search = context.scene.body_moments_search
        search.wanted, search.looked_at = context.object.name, looked_at
        search.found.clear()
        for match in matches[:MAX_LISTED_BODIES]:
            row = search.found.add()
            for name in ("name", "file", "verdict", "distance", "scale"):
                setattr(row, name, getattr(match, name))
        counts = Counter(match.verdict for match in matches)
        alike = [reports.phrase(*COUNTS[kind], count=counts[kind]) for kind in COUNTS if counts[kind]]
        found = ", ".join(alike) if alike else reports.phrase("none is similar")
        done = [reports.phrase("Compared {count} shape", "Compared {count} shapes", count=len(matches)), found]
        if matches:
            text = "nearest is {object}, at {distance:.2e}"
            done.append(reports.phrase(text, object=matches[0].name, distance=matches[0].distance))
        return selection.finish(self, done, failures)


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

    def _begin(self, context: Context) -> int:
        self._others = [
            obj for obj in measurable_objects(context.view_layer) if obj != context.object and obj.visible_get()
        ]
        self._failures: list[Finding] = []
        self._search = session.SimilarSearch(context.object, context.evaluated_depsgraph_get())
        self._steps = self._compare(context.object.name)
        return len(self._others)

    def _compare(self, name: str) -> Generator[float, None, None]:
        try:
            yield from self._search.measure()
        except MeasureError as error:
            error.about(name)
            raise
        yield from selection.iterate_objects(self._others, self._search.comparison(self._others), self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Keep and select the matches at the end, so that a canceled search changes nothing."""
        matches = self._search.find_nearest(self.scaled, self.mirrored)
        if self.select:
            chosen = {
                "copy": True,
                "mirror": self.mirrored,
                "scaled_copy": self.scaled,
                "scaled_mirror": self.mirrored and self.scaled,
            }
            picked = {match.obj for match in matches if chosen.get(match.verdict)}
            selection.select_only(context, {*picked, context.object}, context.object)
        return self.store_and_report(context, matches, "", self._failures)


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
        search = session.SimilarSearch(context.object, context.evaluated_depsgraph_get())
        try:
            matches, missing = search.find_in_library(path, self.scaled, self.mirrored)
        except OSError as error:
            text = "{file} cannot be read: {error}"
            return selection.refuse(self, text, file=path.name, error=system_reason(error))
        except MeasureError as error:
            return selection.refuse(self, error.about(context.object.name))
        return self.store_and_report(context, matches, path.name, missing)


class OBJECT_OT_body_moments_select_found(Operator):
    """Select these objects and make the first one active"""

    bl_idname = "object.body_moments_select_found"
    bl_label = "Select Similar Object"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", description="Objects to select, one a line")

    def execute(self, context: Context) -> set[str]:
        names = set(self.name.split("\n"))
        objects = [candidate for candidate in context.view_layer.objects if candidate.name_full in names]
        if not objects:
            return selection.refuse(self, "No object {object} in the view layer", object=self.name)
        selection.select_only(context, objects, objects[0])
        return {"FINISHED"}


POINTERS = {(Scene, "body_moments_search"): BodyMomentsSearch}


MAX_LISTED = 10  # groups that the dialog lists
NOTHING = "There are no copies."


class OBJECT_OT_body_moments_link_copies(selection.InObjectMode, Operator):
    """Let equal meshes, moved, turned, mirrored or scaled, become one mesh that objects share; nothing moves"""

    bl_idname = "object.body_moments_link_copies"
    bl_label = "Link Copies"

    tolerance: FloatProperty(
        name="Tolerance",
        description="Largest distance between equal vertices, relative to the size of the mesh",
        default=1e-5,
        min=1e-6,
        max=1e-2,
        precision=6,
    )
    may_differ: EnumProperty(
        name="May Differ",
        description="What the copies may have of their own; the shared mesh has that of the first one",
        items=(
            ("UV", "UV Maps", "Copies get the UV maps of the shared mesh"),
            ("ATTRIBUTES", "Attributes", "Copies get colors, normals and other attributes of the shared mesh"),
            ("MATERIALS", "Materials", "Copies keep their materials, linked to the object"),
            ("GROUPS", "Vertex Groups", "Copies get the vertex groups of the shared mesh"),
            ("PROPERTIES", "Custom Properties", "Copies get the custom properties of the shared mesh"),
        ),
        options={"ENUM_FLAG"},
    )
    _objects = None  # the dialog's, while it is open
    _found: tuple | None = None  # the settings of the last search, and its kinds of meshes

    def _kinds(self, context: Context) -> list["Copies"]:
        """Return the kinds of meshes among the selected objects, or all visible ones if none is selected."""
        key = self.tolerance, frozenset(self.may_differ)
        if self._found is None or self._found[0] != key:
            chosen = self._objects or context.selected_objects or context.visible_objects
            objects = [obj for obj in chosen if obj.type == "MESH"]
            with reports.progress(len(objects)) as step:
                self._found = key, scene.copies.find_copies(objects, self.tolerance, set(key[1]), step)
        return self._found[1]

    def invoke(self, context: Context, _event: Event) -> set[str]:
        self._objects = [*context.selected_objects]
        self._kinds(context)
        return context.window_manager.invoke_props_dialog(self, width=420)

    def check(self, context: Context) -> bool:
        self._kinds(context)
        return True

    def draw(self, context: Context) -> None:
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "tolerance")
        column.prop(self, "may_differ")
        if self._found is None:  # the redo panel
            return
        kinds = sorted((kind for kind in self._found[1] if kind.members), key=lambda kind: -len(kind.members))
        count, size = sum(len(kind.members) for kind in kinds), _size(sum(kind.saved_bytes for kind in kinds))
        summary = reports.phrase("Groups: {groups}. Objects to link: {count}", groups=len(kinds), count=count)
        column.label(text="{:s}. {:s}".format(summary, size), icon="LINKED", translate=False)
        for kind in kinds[:MAX_LISTED]:
            row = self.layout.row(align=True)
            members = [*kind.objects, *(obj for obj, *_ in kind.members)]
            text = reports.phrase("{count} objects as {object}", count=len(members), object=kind.data.mesh.name)
            row.label(text="{:s}, {:s}".format(text, _size(kind.saved_bytes)), translate=False)
            button = row.operator("object.body_moments_select_found", text="", icon="RESTRICT_SELECT_OFF")
            button.name = "\n".join(obj.name_full for obj in members)
        if len(kinds) > MAX_LISTED:
            self.layout.label(text=reports.phrase("And {count} more", count=len(kinds) - MAX_LISTED), translate=False)

    def execute(self, context: Context) -> set[str]:
        kinds, self._found, self._objects = self._kinds(context), None, None
        keeps_materials = "MATERIALS" in self.may_differ
        with session.stored.assembly.kept_up_to_date(context):
            with tracking_paused(), reports.progress(sum(len(kind.members) for kind in kinds)) as step:
                linked = scene.copies.link_copies(context, kinds, self.tolerance, keeps_materials, step)
            session.remeasure(context, linked.objects)
        session.tracking.staleness.mark_axes_changed(linked.objects)
        left_out = [reports.failure(obj.name_full, reason) for obj, reason in linked.left_out]
        done = reports.phrase(
            "{count} object linked, {size} saved, vertices moved by up to {maximum:length}",
            "{count} objects linked, {size} saved, vertices moved by up to {maximum:length}",
            count=len(linked.objects),
            size=_size(linked.saved),
            maximum=linked.farthest * context.scene.unit_settings.scale_length,
        )
        total = len(linked.objects) + len(left_out)
        return selection.summarize(self, len(linked.objects), total, done, left_out, nothing=NOTHING)


def _size(size: int) -> str:
    return "{:.3g} MB".format(size / 1e6) if size >= 1e6 else "{:.3g} kB".format(size / 1e3)


CLASSES = (
    BodyMomentsSimilar,
    BodyMomentsSearch,
    OBJECT_OT_body_moments_find_similar,
    OBJECT_OT_body_moments_find_in_library,
    OBJECT_OT_body_moments_select_found,
    OBJECT_OT_body_moments_link_copies,
)
