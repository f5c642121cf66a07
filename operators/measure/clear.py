# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear: remove the stored results from objects. Settings stay."""

from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ...blender.scene.transforms import require_editable
from ...blender.session.tracking import staleness, stamps
from ...blender.write import properties, section
from ...core.verdict.finding import finding
from .. import selection
from ..findings import NO_RESULTS_TO_REMOVE, RESULTS_REMOVED


class OBJECT_OT_body_moments_clear(Operator):
    """Remove the stored results from the selected objects. Settings are kept"""

    bl_idname = "object.body_moments_clear"
    bl_label = "Clear Results"
    bl_options = {"REGISTER", "UNDO"}

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

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selection(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        objects = [
            obj
            for obj in context.view_layer.objects.selected
            if any(key in obj for key in (*properties.DESCRIPTIONS, section.KEY)) or stamps.of_symmetry(obj)
        ]

        def remove(obj: Object) -> bool:
            require_editable(obj)
            staleness.note_edits(obj)
            removed = "MASS" in self.kinds and properties.clear(obj)
            removed |= "SECTION" in self.kinds and section.clear(obj)
            if "SYMMETRY" in self.kinds and stamps.of_symmetry(obj):
                obj.property_unset("body_moments_symmetry")
                removed = True
            return removed

        cleared, failures = selection.apply_to_all(objects, remove)
        staleness.mark_up_to_date(context, objects)
        done = finding(RESULTS_REMOVED, count=len(cleared)) if objects else finding(NO_RESULTS_TO_REMOVE)
        return selection.summarize(self, len(cleared), len(objects), done, failures)


CLASSES = (OBJECT_OT_body_moments_clear,)
