# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons that measure the selected objects, let their numbers follow changes, and remove
stored results.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import bpy
from bpy.props import EnumProperty
from bpy.types import Context, Object, Operator

from ...blender import bodies, read, scene, session, write
from ...blender.session import character, displayed, live, memory
from ...blender.session.tracking import armatures, staleness
from ...blender.settings.preferences import MATERIAL_ITEMS, copy_defaults
from ...core import density, verdict
from .. import findings, modal, selection

AS_SET = "AS_SET"


class OBJECT_OT_body_moments_measure(modal.ModalSteps, selection.OnSelection, Operator):
    """Compute exact mass properties of the selected objects and store them as custom properties"""

    bl_label = "Measure"
    MAX_AT_ONCE = selection.MAX_OBJECTS_WITHOUT_REDRAW

    # Settings for the redo panel; by default the objects keep their own settings.
    material: EnumProperty(
        name="Material",
        description="Material to give the objects before they are measured",
        items=[(AS_SET, "As Set", "The density that each object's settings say"), *MATERIAL_ITEMS],
        default=AS_SET,
        options={"SKIP_SAVE"},
    )
    kind: EnumProperty(
        name="Kind",
        description="What the geometry of the objects represents",
        items=(
            (AS_SET, "As Set", "As each object's settings say"),
            ("SOLID", "Solid", "The surface bounds a volume filled with material"),
            ("SHELL", "Shell", "The surface is a sheet or wall of the given thickness"),
        ),
        default=AS_SET,
        options={"SKIP_SAVE"},
    )
    overlap: EnumProperty(
        name="Overlaps",
        description="How overlapping or nested components of an object count",
        items=(
            (AS_SET, "As Set", "As each object's settings say"),
            ("SIGNED", "Count Each Shell", "Every component counts fully"),
            ("UNION", "Count as Union", "Components are united first"),
        ),
        default=AS_SET,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        may_have_mass = any(
            read.visibility.has_shape(obj)
            or read.visibility.measurable(obj)
            or armatures.stands_for_meshes(obj)
            for obj in context.selected_objects
        )
        return may_have_mass or write.reports.unavailable(cls, "Nothing selected can be measured")

    def _begin(self, context: bpy.types.Context) -> int:
        """Apply the settings of the redo panel and prepare the steps; return the number of selected
        objects.
        """
        copy_defaults(context.scene)
        if not (subjects := armatures.subjects(context.selected_objects)):
            raise write.reports.Refused("Nothing selected can be measured")
        self._objects = objects = [
            obj for obj in subjects if read.visibility.has_shape(obj)
        ] or subjects
        for obj in objects:
            self._change_settings(obj)
        self._results: list[tuple[bpy.types.Object, Any]] = []
        self._refusals: dict[bpy.types.Object, verdict.Finding] = {}
        self._steps = self._measure(objects, context.evaluated_depsgraph_get())
        return len(objects)

    def _change_settings(self, obj: bpy.types.Object) -> None:
        """Apply the settings of the redo panel; library overrides and linked objects keep
        theirs.
        """
        if not obj.is_editable or obj.override_library is not None:
            return
        settings = obj.body_moments
        if self.kind != AS_SET:
            settings.kind = self.kind
        if self.overlap != AS_SET:
            settings.overlap = self.overlap
        if self.material != AS_SET:
            settings.mass_from = "DENSITY"
            settings.density_from = "VALUE"
            settings.density = density.BY_NAME[self.material].density
            settings.material = self.material

    def _measure(
        self, objects: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph
    ) -> Generator[int, None, None]:
        completed = 0
        for together in bodies.measure_many(objects, depsgraph):
            for obj, outcome in together:
                if isinstance(outcome, Exception):
                    self._refusals[obj] = verdict.internal_error.finding_of(outcome)
                else:
                    self._results.append((obj, outcome))
            completed += len(together)
            yield completed

    def _finish(self, context: bpy.types.Context) -> set[str]:
        """Store the results of all objects at the end, so that a canceled run leaves none
        behind.
        """
        failed = session.store_measured(context, self._results)
        for armature in filter(armatures.stands_for_meshes, context.selected_objects):
            character.weight.store_rest(context, armature)
        refusals = self._refusals | failed
        self._failures = [
            write.reports.failure(obj.name_full, refusals[obj])
            for obj in self._objects
            if obj in refusals
        ]
        measured = [obj for obj, _ in self._results if obj not in failed]
        shared = bodies.overlap_caveats(
            measured, context.evaluated_depsgraph_get(), dict(self._results)
        )
        memory.overlaps[context.scene] = displayed.places(measured), shared
        return self._report(len(measured), shared)

    def _report(self, count: int, notes: list[verdict.Finding]) -> set[str]:
        # count: of the measured objects. notes: about several objects together
        warnings = [
            verdict.finding(
                findings.OBJECT_WARNINGS,
                object=obj.name_full,
                causes=[cause.as_record() for cause in causes],
            )
            for obj, measured in self._results
            if (
                causes := verdict.of_severity(
                    measured.findings, verdict.Severity.WARNING, verdict.Severity.ERROR
                )
            )
        ]
        tried = count + len(self._failures)
        names = [warning.values["object"] for warning in warnings]
        if tried == count == 1:  # so there is one result
            text = "Measured {object}, with warnings" if warnings else "Measured {object}"
            summary = [write.reports.phrase(text, object=self._results[0][0].name)]
        else:
            text = write.reports.phrase(
                "Measured {count} of {total} objects", count=count, total=tried
            )
            summary = [*([text] if tried > 1 else []), *selection.name_warned(names)]
        level = verdict.Severity.WARNING if warnings else verdict.Severity.NOTE
        return selection.finish(
            self, summary, self._failures, notes, level=level, is_changed=bool(count)
        )


class OBJECT_OT_body_moments_live(Operator):
    """Update the numbers of the selected objects while they are edited, sculpted, posed or
    animated, until the file is closed. In Pose Mode, those of the meshes that the armature deforms.
    Press Measure to store them
    """

    bl_label = "Live"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return bool(_subjects(context)) or write.reports.unavailable(cls, "Select objects")

    def execute(self, context: Context) -> set[str]:
        objects = _subjects(context)
        was_live = any(obj in memory.followed for obj in objects)
        depsgraph = context.evaluated_depsgraph_get()
        refusals = []
        for obj in objects:
            if was_live:
                live.measuring.stop(obj)
            elif (refusal := live.measuring.start(obj, depsgraph).refusal) is not None:
                refusals.append(write.reports.failure(obj.name, refusal))
        if refusals:
            return selection.report(self, *refusals)
        selection.redraw(context)
        return {"FINISHED"}


def _subjects(context: Context) -> list[Object]:
    """Return the measurable objects that the panel is about."""
    return [obj for obj in displayed.shown_objects(context) if read.visibility.measurable(obj)]


class OBJECT_OT_body_moments_clear(selection.OnSelection, Operator):
    """Remove the stored results from the selected objects. Settings are kept"""

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
        # Measure stores results on the meshes of a posed armature, too: `subjects` returns them.
        selected = context.view_layer.objects.selected
        objects = [
            obj
            for obj in dict.fromkeys((*selected, *armatures.subjects(selected)))
            if any(key in obj for key in (*write.properties.DESCRIPTIONS, write.section.KEY))
            or obj.is_property_set("body_moments_symmetry")
        ]

        def remove(obj: Object) -> bool:
            scene.changes.require_editable(obj)
            staleness.note_edits(obj)
            clear = (
                session.stored.results.clear_rig
                if obj.type == "ARMATURE"
                else write.properties.clear
            )
            removed = "MASS" in self.kinds and clear(obj)
            removed |= "SECTION" in self.kinds and write.section.clear(obj)
            if "SYMMETRY" in self.kinds and obj.is_property_set("body_moments_symmetry"):
                obj.property_unset("body_moments_symmetry")
                removed = True
            return removed

        texts = ("Removed the results of {count} object", "Removed the results of {count} objects")
        return selection.change_all(
            self,
            objects,
            remove,
            texts,
            nothing=selection.NO_RESULTS,
            then=lambda _cleared: staleness.mark_up_to_date(context, objects),
        )
