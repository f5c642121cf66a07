# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Center of Mass as a node group of geometry nodes."""

from bpy.props import BoolProperty
from bpy.types import Context, Operator

from ...blender import scene
from ...blender.read.visibility import measurable
from ...blender.write import reports
from .. import selection


class OBJECT_OT_body_moments_add_nodes(selection.InObjectMode, Operator):
    """Add a node group that computes the center of mass in geometry nodes."""

    bl_idname = "object.body_moments_add_nodes"
    bl_label = "Center of Mass Node Group"
    bl_description = (
        "Add the node group “Center of Mass” to the file, marked as an asset: it computes center, volume and mass in "
        "geometry nodes, follows modifiers and animation, and works without the add-on"
    )

    marker: BoolProperty(
        name="Add Marker",
        description="Add an object that shows the center of mass of the active object at every frame",
        default=True,
    )

    def execute(self, context: Context) -> set[str]:
        group, obj = scene.center_of_mass_group(), context.object
        if not self.marker or obj is None or not measurable(obj):
            reports.report(self, reports.phrase("Added the node group “{group}”", group=group.name))
            return {"FINISHED"}
        marker = scene.add_marker(context, obj, group)
        text = "Added the node group “{group}” and the marker “{object}”"
        texts = [reports.phrase(text, group=group.name, object=marker.name)]
        settings = obj.body_moments
        if (settings.kind, settings.mass_from, settings.density_from) != ("SOLID", "DENSITY", "VALUE"):
            texts.append(reports.phrase("nodes take the object as a solid of one density"))
        reports.report(self, *texts)
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_add_nodes,)
