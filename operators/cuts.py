# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of liquids in vessels, and cut and fill of surfaces."""

from bpy.props import EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Event, Object, Operator

from ..blender import scale, write
from ..blender.session import memory, stored
from . import selection


class OnSubjectInObjectMode(selection.OnSubject):
    """Base of operators on the object that the panel is about, in Object Mode."""

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_object_mode(cls, context) and super().poll(context)


class WithDialog(OnSubjectInObjectMode):
    """Base of operators on the object that the panel is about, after a dialog."""

    NEEDED = "Select a mesh"

    def invoke(self, context: Context, _event: Event) -> set[str]:
        if context.window is None:
            return self.execute(context)
        return context.window_manager.invoke_props_dialog(self)


class OBJECT_OT_body_moments_level(WithDialog, Operator):
    """Compute the level of a volume or mass of liquid in the active vessel, or its contents up to a
    level. The vessel may have a cavity, be open upward, or be one surface with a rim
    """

    bl_label = "Level"

    by: EnumProperty(
        name="Given",
        description="Given quantity",
        items=(
            ("VOLUME", "Volume", "Volume of the liquid"),
            ("MASS", "Mass", "Mass of the liquid"),
            ("LEVEL", "Level", "Height of its surface, against gravity from the world origin"),
        ),
        default="VOLUME",
    )
    volume: FloatProperty(
        name="Volume",
        description="Volume of the liquid",
        default=0.00025,
        min=0.0,
        precision=6,
        unit="VOLUME",
    )
    mass: FloatProperty(
        name="Mass", description="Mass of the liquid, in kg", default=0.25, min=0.0, precision=4
    )
    level: FloatProperty(
        name="Level",
        description="Height of its surface, against gravity from the world origin",
        unit="LENGTH",
        precision=4,
    )
    density: FloatProperty(
        name="Liquid Density",
        description="Density of the liquid, in kg/m³",
        default=998.207,
        min=0.001,
        precision=3,
    )

    def draw(self, _context: Context) -> None:
        selection.draw_properties(self, "by", self.by.lower(), "density")

    def _change(self, context: Context, obj: Object) -> set[str]:
        unit = scale.meters_per_unit(context.scene)
        amounts = {
            "VOLUME": self.volume * unit**3,
            "MASS": self.mass,
            "LEVEL": self.level * unit,
        }
        stored.cuts.fill_vessel(context, obj, self.by, amounts[self.by], self.density)
        return selection.report(self, write.reports.phrase("Filled “{object}”", object=obj.name))


class OBJECT_OT_body_moments_show_level(OnSubjectInObjectMode, Operator):
    """Add the liquid's surface, or the curve of volume and level, as a mesh object"""

    bl_label = "Show Level"

    what: EnumProperty(
        name="Mesh",
        description="What is added",
        items=(
            ("SURFACE", "Surface", "The surface of the liquid"),
            ("TABLE", "Table", "The share of the volume along X, and of the height along Z"),
        ),
    )

    NEEDED = "Compute a level first"

    @classmethod
    def suits(cls, obj: Object) -> bool:
        return obj in memory.levels

    def _change(self, context: Context, obj: Object) -> set[str]:
        level = stored.cuts.level_of(obj, context.scene)
        if level is None:
            return selection.refuse(self, "“{object}” has changed. Press Level", object=obj.name)
        if self.what == "SURFACE" and not len(level.triangles):
            return selection.refuse(
                self, "“{object}” is full to its top. Choose a lower level", object=obj.name
            )
        add = stored.cuts.add_surface if self.what == "SURFACE" else stored.cuts.add_table
        added: Object = add(context, obj, level)
        return selection.report(self, write.reports.phrase("Added “{object}”", object=added.name))


class OBJECT_OT_body_moments_cut_fill(WithDialog, Operator):
    """Measure the volumes of the active open surface above and below a height, the plane through
    its rim, or another object's plane or surface
    """

    bl_label = "Cut and Fill"

    against: EnumProperty(
        name="Against",
        description="What the surface is compared with",
        items=(
            ("HEIGHT", "Height", "A level plane"),
            ("RIM", "Rim", "The plane fitted to the surface's longest open edge"),
            ("OBJECT", "Object", "The plane of a flat object or an empty, else its surface"),
        ),
    )
    height: FloatProperty(
        name="Height", description="World Z of the plane", unit="LENGTH", precision=4
    )
    other: StringProperty(name="Object", description="Name of the object to compare with")

    def draw(self, context: Context) -> None:
        height = ("height",) if self.against == "HEIGHT" else ()
        column = selection.draw_properties(self, "against", *height)
        if self.against == "OBJECT":
            column.prop_search(self, "other", context.scene, "objects")

    def _change(self, context: Context, obj: Object) -> set[str]:
        height = self.height * scale.meters_per_unit(context.scene)
        cut_fill = stored.cuts.measure_cut_fill(context, obj, self.against, height, self.other)
        text = write.reports.phrase("Compared “{object}”", object=obj.name)
        return selection.report(self, text, *cut_fill.findings)
