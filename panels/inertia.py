# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The sub-panels of the inertia: principal moments and axes, radii of gyration, tensor; and about
any reference.
"""

from __future__ import annotations

from bpy.types import Context

from ..blender import read, session, write
from ..blender.session.displayed import displayed, shown_objects, total
from ..core import inertia, verdict
from . import places, rows, texts

# By Weyl, each principal moment is off by at most the norm of the tensor's error, which is at most
# 3 times the largest error of its 9 entries; a difference of two moments by twice as much.
ERROR_OF_A_DIFFERENCE = 6.0
EQUAL_MOMENTS = {  # keys: are moments 1 and 2 equal, and moments 2 and 3?
    (True, True): "All principal moments are equal",
    (True, False): "Principal moments 1 and 2 are equal",
    (False, True): "Principal moments 2 and 3 are equal",
}


class InertiaPanel:
    """Principal moments and axes, radii of gyration and inertia tensor"""

    bl_label = "Inertia"

    def draw(self, context: Context) -> None:
        layout = self.layout
        row = layout.row()
        row.enabled = not _are_several(context)
        row.prop(context.scene.body_moments, "frame", expand=True)
        numbers = _shown(context)
        moments = None if numbers is None else numbers.moments
        rows.group(layout, "Principal Moments", rows.PRINCIPAL_LABELS, "inertia", moments)
        column = layout.column(align=True)
        rows.heading(column, "Principal Axes", "", None if numbers is None else numbers.axes)
        for place, label in enumerate(rows.PRINCIPAL_LABELS):
            rows.direction(column, label, None if numbers is None else numbers.axes[place])
        texts.state(
            column, "" if numbers is None else write.translations.localized(_equal_moments(numbers))
        )
        gyration = None if numbers is None else numbers.gyration
        rows.group(layout, "Radii of Gyration", rows.PRINCIPAL_LABELS, "length", gyration)
        body = rows.fold(layout, "body_moments_tensor", "Inertia Tensor", closed=False)
        if body is not None:
            rows.group(
                body,
                "About the center of mass, Ixy = −∫xy dm",
                rows.TENSOR_LABELS,
                "inertia",
                None if numbers is None else numbers.inertia,
            )


def _equal_moments(body: inertia.PlainBody) -> str:
    # The moments ascend.
    error = body.error_bound["inertia"] + body.error_bound["input"]["inertia"]
    pairs = zip(body.moments, body.moments[1:])
    equal = tuple(larger - less <= ERROR_OF_A_DIFFERENCE * error for less, larger in pairs)
    return EQUAL_MOMENTS.get(equal, "")


def _are_several(context: Context) -> bool:
    # A posed armature counts as one object.
    obj = session.selected.subject(context)
    is_posed = obj is not None and session.tracking.armatures.stands_for_meshes(obj)
    return not is_posed and len(shown_objects(context)) > 1


def _shown(context: Context) -> inertia.PlainBody | None:
    if _are_several(context):
        return total(context).numbers
    obj = session.selected.subject(context)
    current = None if obj is None else displayed(obj, context.scene)
    return None if current is None else current.in_frame(context.scene.body_moments.frame)


class ReferencePanel:
    """Inertia about a point, a frame or an axis"""

    bl_label = "Inertia about Reference"

    def draw(self, context: Context) -> None:
        layout, scene = self.layout, context.scene
        settings = scene.body_moments_reference
        obj = session.selected.subject(context)
        column = layout.column()
        rows.settings(column, settings, "about")
        if settings.about == "OBJECT":
            rows.settings(column, settings, "object")
        elif settings.about == "AXIS":
            rows.settings(column, settings, "first", "second")
            rows.button(
                layout,
                "object.body_moments_axis_from_selection",
                "EYEDROPPER",
                short="From Selection",
            )
        row = layout.row(align=True)
        rows.button(row, "object.body_moments_store_reference", "FILE_TICK", short="Store")
        rows.button(row, "object.body_moments_copy", "COPYDOWN").what = "REFERENCE"
        result = (
            session.stored.reference.referred(obj, scene)
            if obj is not None and "body_mass" in obj
            else None
        )
        if result is None:
            return
        if isinstance(result, verdict.Finding):
            texts.message(layout, result)
            return
        if settings.about == "AXIS":
            column = layout.column(align=True)
            rows.quantities(column, [("About Axis", "inertia", result.about_z)])
            rows.values(
                column,
                ("Radius of Gyration", "Distance of Center"),
                "length",
                (result.radius_about_z, result.distance_from_z),
            )
        rows.group(
            layout,
            "Center of Mass from There",
            rows.AXIS_LABELS,
            "length",
            result.center,
            max(map(abs, result.center)),
        )
        rows.group(layout, "Inertia, Ixy = −∫xy dm", rows.TENSOR_LABELS, "inertia", result.inertia)
        sources = (
            ("Rounding, at Most", result.rounding_error),
            ("Float32 Coordinates, at Most", result.input_error),
        )
        size = max(map(abs, result.inertia))
        rows.error_bounds(layout, sources, [("Inertia", "inertia", "inertia", size)])


CLASSES = (
    *places.in_both_places(
        InertiaPanel,
        "inertia",
        shown_for=lambda obj: read.visibility.measurable(obj) or obj.type in ("EMPTY", "ARMATURE"),
        for_any=True,
    ),
    *places.in_both_places(ReferencePanel, "reference", parent="inertia"),
)
