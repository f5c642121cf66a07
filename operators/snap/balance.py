# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance: move chosen vertices least so that the center of mass comes over a point. Make It Stand:
change infill, walls or a pocket of ballast of a print least.

The vertices are the selected ones in Edit Mode, or a vertex group in Object Mode, as freely as
their weights say; without groups the whole body leans.
"""

from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, StringProperty
from bpy.types import Context, Object, Operator

from ...blender import scene, session, write
from ...blender.scale import meters_per_unit
from .. import selection


class OBJECT_OT_body_moments_sculpt_balance(selection.OnSubject, Operator):
    """Make it stand: move the selected vertices (in Object Mode those of a vertex group) as little
    as possible, or lean an object without vertex groups, to bring the center of mass over a point
    """

    bl_label = "Balance"
    NEEDED = "Make a mesh object active"

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
    def suits(cls, obj: Object) -> bool:
        return obj.type == "MESH"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return super().poll(context) and (
            context.mode in {"OBJECT", "EDIT_MESH"}
            or write.reports.unavailable(
                cls, "Switch to Edit Mode and select the vertices that may move"
            )
        )

    def draw(self, context: Context) -> None:
        point = ("point",) if self.target == "POINT" else ()
        column = selection.draw_properties(self, "target", *point, "axes", "limit")
        if context.mode == "OBJECT":
            column.prop_search(self, "group", session.selected.subject(context), "vertex_groups")

    def _change(self, context: Context, obj: Object) -> set[str]:
        target = context.scene.cursor.location if self.target == "CURSOR" else self.point
        balanced = scene.balance_mesh(context, obj, self.group, target[:], self.axes, self.limit)
        session.remeasure(context, [obj])
        if obj in session.memory.hulls:
            session.check_stability(context, obj, [])
        texts = [
            write.reports.phrase(
                "Moved {count} vertex by at most {distance:length}; the center of mass went from "
                "{start:point} to "
                "{end:point}",
                "Moved {count} vertices by at most {distance:length}; the center of mass went from "
                "{start:point} to "
                "{end:point}",
                **vars(balanced),
            )
        ]
        if obj.data.users - obj.data.use_fake_user > 1:  # a fake user counts as a user
            texts.append(write.reports.phrase("Other objects use this mesh and changed too."))
        if any(
            other_object.type == "MESH"
            and other_object.data.is_editmode
            and other_object.data != obj.data
            for other_object in context.view_layer.objects
        ):
            texts.append(
                write.reports.phrase(
                    "Only “{object}” was balanced; the other meshes in Edit Mode are unchanged.",
                    object=obj.name,
                )
            )
        return write.reports.report(self, *texts)


class OBJECT_OT_body_moments_make_it_stand(selection.OnSubject, Operator):
    """Change the infill of a print as little as possible, and the walls if it does not suffice, or
    a pocket of ballast, so that it stands, hangs level from the 3D cursor, or has its center on the
    plumb line through it. The outside stays
    """

    bl_label = "Make It Stand"
    NEEDED = "Make an object of Kind: Printed active"

    target: EnumProperty(
        name="Target",
        description="Where to bring the center of mass",
        items=(
            ("BASE", "Base", "Over the base, farther from its edges than the margin"),
            ("CURSOR", "3D Cursor", "Above or below the 3D cursor, within the margin"),
        ),
    )
    change: EnumProperty(
        name="Change",
        description="What to change of the print",
        items=(
            ("INFILL", "Infill", "The infill; the walls stay"),
            ("WALLS", "Walls", "The infill, and the number of walls if it does not suffice"),
            ("BALLAST", "Ballast", "A closed pocket in the core, filled with ballast"),
        ),
        default="WALLS",
    )
    ballast: FloatProperty(
        name="Ballast",
        description="Density of what fills the pocket, in kg/m³",
        default=7820.0,
        min=0.0,
        soft_max=25000.0,
    )
    margin: FloatProperty(
        name="Margin",
        description=(
            "Least distance from the edges of the base, or largest from the plumb line. 1 mm if "
            "not given"
        ),
        min=0.0,
        options={"SKIP_SAVE"},
        unit="LENGTH",
        precision=4,
    )

    @classmethod
    def suits(cls, obj: Object) -> bool:
        return obj.body_moments.kind == "PRINTED"

    def _change(self, context: Context, obj: Object) -> set[str]:
        settings = obj.body_moments
        scale = meters_per_unit(context.scene)
        if not self.properties.is_property_set("margin"):
            self.margin = 1e-3 / scale  # 1 mm in Blender's units
        session.check_stability(context, obj, [])  # computes the hull, which `support` reads
        support = session.stored.stability.support(obj, context.scene)
        point = context.scene.cursor.location[:] if self.target == "CURSOR" else None
        corners = None if support is None else support.polygon
        balance = session.print_balance.balance_print(
            context, obj, corners, self.margin, point, self.change, self.ballast
        )
        if balance is None:
            text = "It touches the ground along an edge or at a corner. Lay it on a face first."
            return selection.refuse(self, write.reports.phrase(text))
        values = {
            "walls": balance.walls,
            "infill": round(balance.infill, 2),  # in percent
            "margin": balance.margin * scale,
            "radius": balance.pocket.radius if balance.pocket else 0.0,
        }
        is_ballast = self.change == "BALLAST"
        if not balance.suffices:
            text = (
                "A pocket cannot do it: the margin is at best {margin:length}, with a radius of "
                "{radius:length}. Choose another margin, infill or denser ballast"
                if is_ballast
                else "Walls and infill cannot do it: the margin is at best {margin:length}, with "
                "{walls} walls and {infill} % infill. Choose another margin, or use Balance"
            )
            return selection.refuse(self, write.reports.phrase(text, **values))
        if is_ballast:
            settings.pocket_radius = 1e3 * values["radius"]  # in mm
            if balance.pocket:
                settings.pocket_center = balance.pocket.center
                settings.pocket_density = self.ballast
        else:
            settings.print_walls = balance.walls
            settings.print_infill = balance.infill
        session.remeasure(context, [obj])
        session.check_stability(context, obj, [])
        text = "Set to {walls} walls and {infill} % infill"
        if is_ballast:
            text = "It has a pocket with a radius of {radius:length}"
            text = text if balance.pocket else "It needs no pocket"
        return write.reports.report(self, write.reports.phrase(text, **values))
