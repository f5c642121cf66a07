# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance: move chosen vertices least so that the center of mass comes over a point, "make
it stand".

The vertices are the selected ones in Edit Mode, or a vertex group in Object Mode, as freely as
their weights say; without groups the whole body leans.
"""

from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, StringProperty
from bpy.types import Context, Operator

from ...blender import scene, session
from ...blender.write import reports
from ...core.verdict import MeasureError
from .. import selection


class OBJECT_OT_body_moments_sculpt_balance(Operator):
    """Move vertices as little as possible to bring the center of mass over a point."""

    bl_idname = "object.body_moments_sculpt_balance"
    bl_label = "Balance"
    bl_description = (
        "Make it stand: move the selected vertices (in Object Mode those of a vertex group) as "
        "little as "
        "possible, or lean an object without vertex groups, to bring the center of mass over a "
        "point"
    )
    bl_options = {"REGISTER", "UNDO"}

    target: EnumProperty(
        name="Target",
        description="Where to bring the center of mass",
        items=(
            ("CURSOR", "3D Cursor", "The 3D cursor"),
            ("POINT", "Point", "The point below, in world coordinates"),
        ),
    )
    point: FloatVectorProperty(
        name="Point",
        description="Target point in world coordinates",
        subtype="TRANSLATION",
    )
    axes: EnumProperty(
        name="Align",
        description="In which directions the center of mass is brought to the target",
        items=(
            (
                "ALONG_GRAVITY",
                "Along Gravity",
                "Onto the line through the target along gravity, at any height",
            ),
            ("ALL", "All Axes", "Onto the target itself"),
        ),
    )
    limit: FloatProperty(
        name="Max Distance",
        description="Longest move of a vertex. 0 for the size of the mesh",
        min=0.0,
        unit="LENGTH",
        precision=4,
    )
    group: StringProperty(
        name="Vertex Group",
        description=(
            "Vertices that may move in Object Mode, in proportion to their weights. If empty, the "
            "active group; "
            "an object without groups leans as a whole"
        ),
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = session.selected.subject(context)
        if obj is None or obj.type != "MESH":
            return reports.unavailable(cls, "Make a mesh object active")
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            return reports.unavailable(
                cls, "Switch to Edit Mode and select the vertices that may move"
            )
        return True

    def draw(self, context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "target")
        if self.target == "POINT":
            layout.prop(self, "point")
        layout.prop(self, "axes")
        layout.prop(self, "limit")
        if context.mode == "OBJECT":
            layout.prop_search(
                self, "group", session.selected.require_subject(context), "vertex_groups"
            )

    def execute(self, context: Context) -> set[str]:
        obj = session.selected.require_subject(context)
        target = context.scene.cursor.location if self.target == "CURSOR" else self.point
        try:
            balanced = scene.balance_mesh(
                context, obj, self.group, target[:], self.axes, self.limit
            )
        except MeasureError as error:
            return selection.refuse(self, reports.failure(obj.name_full, error))
        session.remeasure(context, [obj])
        if obj in session.memory.hulls:
            session.check_stability(context, obj, [])
        texts = [
            reports.phrase(
                "Moved {count} vertex by at most {distance:length}; the center of mass went from "
                "{start:point} to "
                "{end:point}",
                "Moved {count} vertices by at most {distance:length}; the center of mass went from "
                "{start:point} to "
                "{end:point}",
                **vars(balanced),
            )
        ]
        if obj.data.users - obj.data.use_fake_user > 1:
            texts.append(reports.phrase("Other objects use this mesh and changed too."))
        if any(
            other.type == "MESH" and other.data.is_editmode and other.data != obj.data
            for other in context.view_layer.objects
        ):
            texts.append(
                reports.phrase(
                    "Only “{object}” was balanced; the other meshes in Edit Mode are unchanged.",
                    object=obj.name,
                )
            )
        return reports.report(self, *texts)


CLASSES = (OBJECT_OT_body_moments_sculpt_balance,)
