# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, computed by a button, and copied to the clipboard."""

from __future__ import annotations

from dataclasses import replace

from bpy.types import Context, Object, Operator

from ....core.moments.moments import Measure
from ...bodies.measure_object import THREADS, measure_object
from ...read import Unreadable, measurable
from ...read.fingerprint import matrix_hash, settings_hash
from ...session import staleness
from ...session.moments import Computed, as_csv, found, keep
from ...settings.options import MeasureOptions
from ...write.alarms import alarms
from ...write.text import one_line
from .copy import to_clipboard

NO_WIRE = (
    "{:s}: It is a wire, which has neither volume nor surface; measure it as a solid or a shell. The command line "
    "tells the moments of its length."
)


def _active(cls: type[Operator], context: Context) -> Object | None:
    obj = context.object
    if obj is None or not measurable(obj):
        cls.poll_message_set("Make an object active that can be measured")
        return None
    return obj


class OBJECT_OT_body_moments_compute_moments(Operator):
    """Compute all moments of the active object to the chosen order"""

    bl_idname = "object.body_moments_compute_moments"
    bl_label = "Compute Moments"
    bl_description = (
        "Compute all moments of the active object to the chosen order, of its volume and of its surface. Time grows "
        "with the third power of the order: a million triangles take a second to order 4 and some twenty to order 20"
    )
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        return _active(cls, context) is not None

    def execute(self, context: Context) -> set[str]:
        obj, scene = context.object, context.scene
        options = MeasureOptions(order=scene.body_moments.moments_order, surface=True, threads=THREADS)
        depsgraph = context.evaluated_depsgraph_get()
        try:
            one = measure_object(obj, depsgraph, options)
        except Unreadable as error:
            self.report({"WARNING"}, str(error))
            return {"CANCELLED"}
        if one.length is not None:
            self.report({"WARNING"}, NO_WIRE.format(obj.name))
            return {"CANCELLED"}
        area = one.area_moments.truncated(options.order)
        volume = (one.volume_moments or replace(area * one.thickness, of=Measure.VOLUME)).truncated(options.order)
        key = (matrix_hash(obj), settings_hash(obj, scene), staleness.geometry_changes(obj))
        keep(obj, Computed(obj.name, volume, area, one.rotation, one.location, key))
        told = "Computed {:d} moments of {:s}".format(len(volume.raw), obj.name)
        self.report({"WARNING"} if alarms(one.warnings) else {"INFO"}, one_line([told, *one.warnings]))
        return {"FINISHED"}


class OBJECT_OT_body_moments_copy_moments(Operator):
    """Copy all computed moments, with their error bounds, to the clipboard as CSV"""

    bl_idname = "object.body_moments_copy_moments"
    bl_label = "Copy All as CSV"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        obj = _active(cls, context)
        if obj is not None and found(obj) is None:
            cls.poll_message_set("Compute the moments first")
        return obj is not None and found(obj) is not None

    def execute(self, context: Context) -> set[str]:
        settings, computed = context.scene.body_moments, found(context.object)
        try:
            text = as_csv(computed, settings.moments_of, settings.moments_about, settings.frame)
        except ValueError as error:
            self.report({"WARNING"}, str(error))
            return {"CANCELLED"}
        to_clipboard(self, context, text, "Copied {:d} moments".format(len(computed.volume.raw)))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_body_moments_compute_moments, OBJECT_OT_body_moments_copy_moments)
