# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Link Copies: equal objects come to share one mesh."""

from bpy.props import EnumProperty, FloatProperty
from bpy.types import Context, Event, Operator

from ...blender import read, scale, scene, session, write
from .. import selection

MAX_LISTED = 10  # groups that the dialog lists
NOTHING = "There are no copies."


class OBJECT_OT_body_moments_link_copies(selection.InObjectMode, Operator):
    """Let equal meshes, moved, turned, mirrored or scaled, share one mesh; nothing moves"""

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
        description="What the copies may have of their own; the shared mesh has that of the first "
        "one",
        items=(
            ("UV", "UV Maps", "Copies get the UV maps of the shared mesh"),
            (
                "ATTRIBUTES",
                "Attributes",
                "Copies get colors, normals and other attributes of the shared mesh",
            ),
            (
                "MATERIALS",
                "Materials",
                "Copies keep their materials, linked to the object",
            ),
            (
                "GROUPS",
                "Vertex Groups",
                "Copies get the vertex groups of the shared mesh",
            ),
            (
                "PROPERTIES",
                "Custom Properties",
                "Copies get the custom properties of the shared mesh",
            ),
        ),
        options={"ENUM_FLAG"},
    )
    _objects = None  # the objects selected when the dialog opened, while it is open
    _search_key: tuple | None = None  # the settings of the last search, until the copies are linked
    _kinds: list = []  # the kinds of meshes that it found

    def _find_kinds(self, context: Context) -> list["scene.copies.Copies"]:
        """Return the kinds of meshes among the selected objects, or all visible ones if none is
        selected; search only if a setting has changed.
        """
        key = self.tolerance, frozenset(self.may_differ)
        if self._search_key != key:
            candidates = self._objects or context.selected_objects or context.visible_objects
            objects = [obj for obj in candidates if obj.type == "MESH"]
            with write.reports.progress(len(objects)) as step:
                self._kinds = scene.copies.find_copies(
                    objects, self.tolerance, set(self.may_differ), step
                )
            self._search_key = key
        return self._kinds

    def invoke(self, context: Context, _event: Event) -> set[str]:
        self._objects = [*context.selected_objects]
        self._find_kinds(context)  # for `draw`
        return context.window_manager.invoke_props_dialog(self, width=420)

    def check(self, context: Context) -> bool:
        self._find_kinds(context)
        return True  # Blender shall draw the dialog again

    def draw(self, context: Context) -> None:
        column = selection.draw_properties(self, "tolerance", "may_differ")
        if self._search_key is None:  # the redo panel
            return
        kinds = sorted(
            (kind for kind in self._kinds if kind.members), key=lambda kind: -len(kind.members)
        )
        count = sum(len(kind.members) for kind in kinds)
        size = _size(sum(kind.saved_bytes for kind in kinds))
        summary = write.reports.phrase(
            "Groups: {groups}. Objects to link: {count}", groups=len(kinds), count=count
        )
        column.label(text="{:s}. {:s}".format(summary, size), icon="LINKED", translate=False)
        for kind in kinds[:MAX_LISTED]:
            row = self.layout.row(align=True)
            members = [*kind.objects, *(obj for obj, *_ in kind.members)]
            text = write.reports.phrase(
                "{count} objects as {object}", count=len(members), object=kind.data.mesh.name
            )
            row.label(text="{:s}, {:s}".format(text, _size(kind.saved_bytes)), translate=False)
            button = row.operator(
                "object.body_moments_select_found", text="", icon="RESTRICT_SELECT_OFF"
            )
            button.name = "\n".join(obj.name_full for obj in members)
        if len(kinds) > MAX_LISTED:
            self.layout.label(
                text=write.reports.phrase("And {count} more", count=len(kinds) - MAX_LISTED),
                translate=False,
            )

    def execute(self, context: Context) -> set[str]:
        kinds = self._find_kinds(context)
        self._search_key = None
        self._kinds = []  # They hold the arrays of removed meshes.
        self._objects = None
        keeps_materials = "MATERIALS" in self.may_differ
        with session.stored.assembly.kept_up_to_date(context):
            with (
                read.tracking.tracking_paused(),
                write.reports.progress(sum(len(kind.members) for kind in kinds)) as step,
            ):
                linked = scene.linking.link_copies(
                    context, kinds, self.tolerance, keeps_materials, step
                )
            session.remeasure(context, linked.objects)
        session.tracking.staleness.mark_axes_changed(linked.objects)
        left_out = [write.reports.failure(obj.name_full, reason) for obj, reason in linked.left_out]
        summary = write.reports.phrase(
            "{count} object linked, {size} saved, vertices moved by up to {maximum:length}",
            "{count} objects linked, {size} saved, vertices moved by up to {maximum:length}",
            count=len(linked.objects),
            size=_size(linked.saved),
            maximum=linked.farthest * scale.meters_per_unit(context.scene),
        )
        total = len(linked.objects) + len(left_out)
        return selection.summarize(
            self, len(linked.objects), total, summary, left_out, nothing=NOTHING
        )


def _size(byte_count: int) -> str:
    if byte_count >= 1e6:
        return "{:.3g} MB".format(byte_count / 1e6)
    return "{:.3g} kB".format(byte_count / 1e3)
