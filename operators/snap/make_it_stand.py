# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make It Stand: change infill, walls or a pocket of ballast of a print least."""

from bpy.props import EnumProperty, FloatProperty
from bpy.types import Context, Operator

from ...blender import session
from ...blender.scale import meters_per_unit
from ...blender.write import reports
from ...core.verdict import MeasureError
from .. import selection


class OBJECT_OT_body_moments_make_it_stand(Operator):
    """Change infill, walls or ballast of a print as little as possible, so that it stands."""

    bl_idname = "object.body_moments_make_it_stand"
    bl_label = "Make It Stand"
    bl_description = (
        "Change the infill of a print as little as possible, and the walls if it does not suffice, "
        "or a pocket of ballast, so that it stands, hangs level from the 3D cursor, or has its "
        "center on the plumb line through it. The outside stays"
    )
    bl_options = {"REGISTER", "UNDO"}

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
    def poll(cls, context: Context) -> bool:
        obj = session.selected.subject(context)
        if obj is None or obj.body_moments.kind != "PRINTED":
            return reports.unavailable(cls, "Make an object of Kind: Printed active")
        return True

    def execute(self, context: Context) -> set[str]:
        obj = session.selected.require_subject(context)
        settings = obj.body_moments
        scale = meters_per_unit(context.scene)
        if not self.properties.is_property_set("margin"):
            self.margin = 1e-3 / scale
        try:
            session.check_stability(context, obj, [])
            support = session.stored.stability.support(obj, context.scene)
            point = context.scene.cursor.location[:] if self.target == "CURSOR" else None
            corners = None if support is None else support.polygon
            found = session.print_balance.balance_print(
                context, obj, corners, self.margin, point, self.change, self.ballast
            )
        except MeasureError as error:
            return selection.refuse(self, reports.failure(obj.name_full, error))
        if found is None:
            text = "It touches the ground along an edge or at a corner. Lay it on a face first."
            return selection.refuse(self, reports.phrase(text))
        values = {
            "walls": found.walls,
            "infill": round(found.infill, 2),
            "margin": found.margin * scale,
            "radius": found.pocket.radius if found.pocket else 0.0,
        }
        is_ballast = self.change == "BALLAST"
        if not found.suffices:
            text = (
                "A pocket cannot do it: the margin is at best {margin:length}, with a radius of "
                "{radius:length}. Choose another margin, infill or denser ballast"
                if is_ballast
                else "Walls and infill cannot do it: the margin is at best {margin:length}, with "
                "{walls} walls and {infill} % infill. Choose another margin, or use Balance"
            )
            return selection.refuse(self, reports.phrase(text, **values))
        if is_ballast:
            settings.pocket_radius = 1e3 * values["radius"]
            if found.pocket:
                settings.pocket_center = found.pocket.center
                settings.pocket_density = self.ballast
        else:
            settings.print_walls = found.walls
            settings.print_infill = found.infill
        session.remeasure(context, [obj])
        session.check_stability(context, obj, [])
        text = "Set to {walls} walls and {infill} % infill"
        if is_ballast:
            text = "It has a pocket with a radius of {radius:length}"
            text = text if found.pocket else "It needs no pocket"
        return reports.report(self, reports.phrase(text, **values))


CLASSES = (OBJECT_OT_body_moments_make_it_stand,)
