# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear: remove the stored results from objects. Settings stay."""

from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ...blender import write
from ...blender.scene.changes import require_editable
from ...blender.session.tracking import staleness, stamps
from ...blender.write import properties, reports
from .. import selection


class OBJECT_OT_body_moments_clear(selection.OnSelection, Operator):
    """Remove the stored results from the selected objects. Settings are kept"""

    bl_idname = "object.body_moments_clear"
    bl_label = "Clear Results"

    kinds: EnumProperty(
        name="Results",
        description="Results that are removed",
        options={"ENUM_FLAG"},
        items=(
            ("MASS", "Mass Properties", "Mass, center, inertia and findings"),
            ("SECTION", "Section", "Section properties"),
            ("SYMMETRY", "Symmetry", "The symmetry that was found"),
        ),
        default={"MASS", "SECTION", "SYMMETRY"},
    )

    def execute(self, context: Context) -> set[str]:
        objects = [
            obj
            for obj in context.view_layer.objects.selected
            if any(key in obj for key in (*properties.DESCRIPTIONS, write.section.KEY)) or stamps.of_symmetry(obj)
        ]

        def remove(obj: Object) -> bool:
            require_editable(obj)
            staleness.note_edits(obj)
            removed = "MASS" in self.kinds and properties.clear(obj)
            removed |= "SECTION" in self.kinds and write.section.clear(obj)
            if "SYMMETRY" in self.kinds and stamps.of_symmetry(obj):
                obj.property_unset("body_moments_symmetry")
                removed = True
            return removed

        cleared, failures = selection.apply_to_all(objects, remove)
        staleness.mark_up_to_date(context, objects)
        texts = ("Removed the results of {count} object", "Removed the results of {count} objects")
        done, nothing = reports.phrase(*texts, count=len(cleared)), "The selected objects have no results"
        return selection.summarize(self, len(cleared), len(objects), done, failures, nothing=nothing)


CLASSES = (OBJECT_OT_body_moments_clear,)
