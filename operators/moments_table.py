# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Moments to a chosen order, computed by a button and kept in memory, and what a panel and the clipboard show of them.

Nothing is written to the object: a thousand numbers would burden the file, and no undo step is needed. The last few
objects' moments are kept until Blender ends; they know what they were computed from, and so when they are out of date.
"""

from __future__ import annotations

import csv
import io
from collections import OrderedDict
from dataclasses import dataclass, replace
from functools import lru_cache

import bpy
import numpy as np
from bpy.types import Context, Object, Operator, Scene
from numpy.typing import NDArray

from ..core.moments import Moments, monomial_count, monomials
from . import staleness
from .alarms import alarms
from .clipboard import to_clipboard
from .fingerprint import matrix_hash, settings_hash
from .measure import THREADS, MeasureOptions, measure_object
from .read import Unreadable, measurable
from .selection import one_line
from .units import number

NO_WIRE = (
    "{:s}: It is a wire, which has neither volume nor surface; measure it as a solid or a shell. The command line "
    "tells the moments of its length."
)
SHOWN = 4  # the highest order whose moments a panel shows one by one
KEPT = 16  # objects
NOISE = 1e-12  # of the largest moment of a degree: shown as 0
POWERS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, eq=False)
class Computed:
    """One object's moments, SI, world axes. volume: of a shell those of its thin volume. rotation, location: the object
    frame. key: what they were computed from."""

    name: str
    volume: Moments
    area: Moments
    rotation: NDArray[np.float64]
    location: NDArray[np.float64]
    key: tuple[str, str, int]

    @property
    def order(self) -> int:
        return self.volume.order


@dataclass(frozen=True)
class Degree:
    """The moments of one degree as a panel shows them: (label, text, exact) each, and their unit."""

    degree: int
    unit: str
    rows: tuple[tuple[str, str, str], ...]


_kept: OrderedDict[int, Computed] = OrderedDict()


def found(obj: Object) -> Computed | None:
    """What was computed for an object; None where nothing was."""
    return _kept.get(obj.session_uid)


def outdated(obj: Object, scene: Scene) -> str:
    """Why what was computed does not hold any more; "" where it does, or there is nothing."""
    computed = found(obj)
    if computed is None:
        return ""
    matrix, settings, geometry = computed.key
    if settings != settings_hash(obj, scene):
        return "Settings Changed"
    if geometry != staleness.geometry_changes(obj):
        return "Geometry Changed"
    return "Transform Changed" if matrix != matrix_hash(obj) else ""


def shown(obj: Object, scene: Scene) -> tuple[tuple[Degree, ...], str]:
    """The moments to order SHOWN as the scene's settings want them, and why there are none."""
    settings = scene.body_moments
    return _shown(found(obj), settings.moments_of, settings.moments_about, settings.frame)


@lru_cache(maxsize=32)
def _shown(computed: Computed, of: str, about: str, frame: str) -> tuple[tuple[Degree, ...], str]:
    try:
        moments = placed(computed, of, about, frame, min(computed.order, SHOWN))
    except ValueError as error:
        return (), str(error)
    degrees = []
    for degree in range(moments.order + 1):
        part = slice(monomial_count(degree - 1), monomial_count(degree))
        values = moments.raw[part]
        noise = np.maximum(moments.error[part], NOISE * np.abs(values).max())
        texts = [number(0.0 if abs(value) <= least else float(value)) for value, least in zip(values, noise)]
        rows = zip(map(label, monomials(degree)[part].tolist()), texts, (repr(float(value)) for value in values))
        degrees.append(Degree(degree, unit(of, about, degree), tuple(rows)))
    return tuple(degrees), ""


def placed(computed: Computed, of: str, about: str, frame: str, order: int) -> Moments:
    """The moments along the axes of the frame, "WORLD" or "OBJECT", about its "ORIGIN" or the body's "CENTER"; or
    "NORMALIZED", as `Moments.normalized` by size. ValueError where that cannot be, or leaves the range of numbers."""
    with np.errstate(over="ignore", invalid="ignore"):
        moments = _placed(computed, of, about, frame, order)
    if not np.isfinite([moments.raw, moments.error, moments.input]).all():
        raise ValueError("So far from there, moments of order {:d} are beyond the range of numbers; show them about "
                         "the center.".format(order))
    return moments


def _placed(computed: Computed, of: str, about: str, frame: str, order: int) -> Moments:
    moments = (computed.volume if of == "VOLUME" else computed.area).truncated(order)
    rotation = np.eye(3) if frame == "WORLD" else computed.rotation
    origin = moments.center if about != "ORIGIN" else np.zeros(3) if frame == "WORLD" else computed.location
    if frame == "OBJECT":
        moments = moments.in_frame(rotation, origin)
    if about == "NORMALIZED":
        return moments.normalized()
    return moments if frame == "OBJECT" else moments.shifted(origin)


def label(powers: list[int]) -> str:
    """x²z, or 1."""
    factors = [axis + str(power).translate(POWERS) * (power > 1) for axis, power in zip("xyz", powers) if power]
    return "".join(factors) or "1"


def unit(of: str, about: str, degree: int) -> str:
    """m⁵, or nothing for normalized ones."""
    if about == "NORMALIZED":
        return ""
    return "m" + str(degree + (3 if of == "VOLUME" else 2)).translate(POWERS)


def as_csv(computed: Computed, of: str, about: str, frame: str) -> str:
    """All of them: a comment that says what they are, and a row for each with its bounds."""
    moments = placed(computed, of, about, frame, computed.order)
    text = io.StringIO()
    text.write("# {:s}: {:s} moments, {:s} frame, {:s}\n".format(
        computed.name, of.lower(), frame.lower(), {
            "ORIGIN": "about the frame's origin, in SI units", "CENTER": "about the center, in SI units",
            "NORMALIZED": "central, of the body scaled to a {:s} of 1".format(of.lower())}[about]))
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["p", "q", "r", "moment", "rounding", "float32"])
    rows = zip(monomials(computed.order).tolist(), moments.raw.tolist(), moments.error.tolist(), moments.input.tolist())
    table.writerows([*powers, *values] for powers, *values in rows)
    return text.getvalue()


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
        volume = (one.volume_moments or replace(area * one.thickness, of="volume")).truncated(options.order)
        key = (matrix_hash(obj), settings_hash(obj, scene), staleness.geometry_changes(obj))
        _kept.pop(obj.session_uid, None)
        _kept[obj.session_uid] = Computed(obj.name, volume, area, one.rotation, one.location, key)
        while len(_kept) > KEPT:
            _kept.popitem(last=False)
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


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    _kept.clear()
    _shown.cache_clear()
