# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Make Rigid Bodies: the result of Calculate Mass is shown beside the exact mass."""

from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Operator

from ...blender import session
from ...blender.write import reports
from ...blender.write.translations import localized
from ...blender.write.units import Units
from ...core.numerics.float32 import shortest_decimal
from .. import selection
from ..snap.rigid_body import display_scaled

if TYPE_CHECKING:
    from ...blender.session.rigid_bodies import RigidBodies

SHOWN = 12  # bodies in the redo panel


class OBJECT_OT_body_moments_rigid_bodies(selection.OnSelectionInObjectMode, Operator):
    """Make the selected objects rigid bodies with their exact mass, center of mass and principal axes."""

    bl_idname = "object.body_moments_rigid_bodies"
    bl_label = "Make Rigid Bodies"
    bl_description = (
        "Make the selected objects rigid bodies: mass from density and true volume, origin at the center of mass, axes "
        "along the principal axes. Nothing visible moves, and joints stay where they are"
    )

    type: EnumProperty(
        name="Type",
        description="Type of new rigid bodies",
        items=(("ACTIVE", "Active", "Moved by the simulation"), ("PASSIVE", "Passive", "Moved by animation alone")),
    )
    shape: EnumProperty(
        name="Shape",
        description="Collision shape",
        items=(
            ("KEEP", "Keep", "Leave the shape of rigid bodies as it is; new ones get a convex hull"),
            ("CONVEX_HULL", "Convex Hull", "The convex hull of the object"),
            ("MESH", "Mesh", "The mesh itself, slow"),
            ("BOX", "Box", "The bounding box along the object's axes"),
        ),
    )
    frame: EnumProperty(
        name="Frame",
        description="What the physics engine takes as center of mass and principal axes",
        items=(
            ("AXES", "Principal Axes", "Origin at the center of mass, axes along the principal axes, unit scale"),
            ("ORIGIN", "Origin", "Origin at the center of mass; the axes stay"),
            ("KEEP", "Keep", "Leave origin and axes as they are"),
        ),
    )
    use_density: BoolProperty(name="Set Density", description="Give all objects one density first")
    density: FloatProperty(
        name="Density",
        description="Density in kg/m³, independent of the scene units",
        default=1000.0,
        min=1e-6,
        soft_max=25000.0,
        precision=3,
    )
    compounds: BoolProperty(
        name="Compound Parents",
        description="Make an object and the selected objects that are parented to it one body with their total mass",
        default=True,
    )
    comparison: StringProperty(options={"HIDDEN", "SKIP_SAVE"})

    def draw(self, _context: Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("type", "shape", "frame", "compounds", "use_density"):
            layout.prop(self, name)
        if self.use_density:
            layout.prop(self, "density")
        column = layout.column(align=True)
        for line in self.comparison.splitlines():
            column.label(text=line, translate=False)

    def execute(self, context: Context) -> set[str]:
        objects = selection.selected_measurable(context)
        if self.use_density:
            for obj in objects:
                if obj.is_editable:
                    obj.body_moments.mass_from, obj.body_moments.density_from = "DENSITY", "VALUE"
                    obj.body_moments.density = self.density
        made = session.make_rigid_bodies(context, objects, self.type, self.shape, self.frame, self.compounds)
        self.comparison = _compare_masses(context, made)
        texts = (
            "{count} rigid body of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
            "{count} rigid bodies of {mass:.7g} kg; Calculate Mass would say {calculated:.7g} kg",
        )
        count, mass = len(made.measured), float(sum(one.target.mass for one in made.measured.values()))
        done = reports.phrase(*texts, count=count, mass=mass, calculated=float(sum(made.calculated.values())))
        findings = [
            one.target.finding.of_sources([obj.name])
            for obj, one in made.measured.items()
            if one.target.finding is not None and self.frame == "AXES"
        ]
        unit = shortest_decimal(context.scene.unit_settings.scale_length)
        if count and unit != 1.0 and context.scene.unit_settings.system != "NONE":
            findings.insert(0, display_scaled(unit))
        return selection.summarize(self, count, count + len(made.failures), done, made.failures, findings)


def _compare_masses(context: Context, made: "RigidBodies") -> str:
    """Return a line for each of the first bodies: its exact mass, and its mass by Calculate Mass."""
    units = Units.from_settings(context.scene.unit_settings)
    lines = []
    for obj, one in list(made.measured.items())[:SHOWN]:
        template = localized("{:s}: {:s}; Calculate Mass: {:s}")
        masses = (units.text("mass", one.target.mass), units.text("mass", made.calculated[obj]))
        lines.append(template.format(obj.name, *masses))
    if len(made.measured) > SHOWN:
        lines.append(localized("And {:d} more").format(len(made.measured) - SHOWN))
    return "\n".join(lines)


CLASSES = (OBJECT_OT_body_moments_rigid_bodies,)
MENUS = ((bpy.types.VIEW3D_MT_object_rigid_body, selection.menu_entry(*CLASSES, icon="RIGID_BODY")),)
