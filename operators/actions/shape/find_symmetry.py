# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Symmetry: the rotation axes and mirror planes of the selected objects, by their moments and confirmed on their
surfaces. What was found is kept with each object, in its own axes, for the panel."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, Event, Object, Operator, PropertyGroup

from ....core.inertia.canonical_frame import NOISE
from ....core.measurement import Measurement
from ....core.shape.symmetry import Symmetry, confirmed, symmetry
from ....core.verdict.finding import Finding, finding
from ...bodies.shape import Shape, Skin, displayed, surface_shape_of
from ...read.fingerprint import scale_hash
from ...scene.transforms import require_own
from ...session import staleness
from ...write import reports
from .. import selection
from ..modal import Stepwise

KEPT = 32  # elements of a symmetry that are stored; of a ball's or a fine prism's nobody reads more


class BodyMomentsElement(PropertyGroup):
    """One element of a symmetry, in the object's axes."""

    kind: EnumProperty(
        items=(
            ("AXIS", "Axis", "Rotation axis"),
            ("PLANE", "Plane", "Mirror plane, given by its normal"),
            ("ROUND", "Round", "Axis of revolution"),
        )
    )
    order: IntProperty(name="Order")
    direction: FloatVectorProperty(name="Direction", subtype="XYZ")


class BodyMomentsSymmetry(PropertyGroup):
    """The symmetry that was found of an object."""

    group: StringProperty(name="Symmetry", description="Schoenflies symbol of the symmetry that the surface confirms")
    compatible: StringProperty(
        name="By Moments", description="Schoenflies symbol of the symmetry that the moments allow"
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Largest distance of the surface from its images, relative to the radius of gyration",
    )
    of_display_mesh: BoolProperty(
        name="Of Display Mesh", description="The display mesh of a NURBS surface was compared"
    )
    fingerprint: StringProperty()
    elements: CollectionProperty(type=BodyMomentsElement)


class OBJECT_OT_body_moments_find_symmetry(Stepwise, Operator):
    """Find the rotation axes and mirror planes of the selected objects"""

    bl_idname = "object.body_moments_find_symmetry"
    bl_label = "Find Symmetry"
    bl_description = (
        "Find the rotation axes and mirror planes through the center of mass of the selected objects that moments to "
        "order 6 allow and the surface confirms"
    )
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = finding("progress_symmetry")
    CANCELED = finding("canceled_search")

    tolerance: FloatProperty(
        name="Tolerance",
        default=1e-3,
        min=1e-6,
        max=0.1,
        precision=6,
        description="Largest allowed distance of the surface from its images, relative to the radius of gyration",
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        return selection.poll_selected(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        self._begin(context)
        return self.all_at_once(context, len(self._objects))

    def invoke(self, context: Context, _event: Event) -> set[str]:
        self._begin(context)
        if context.window is None:
            return self.all_at_once(context, len(self._objects))
        return self.begin_modal(context, len(self._objects))

    def _begin(self, context: Context) -> None:
        self._objects = selection.selected(context)
        self._found: list[tuple[Object, Measurement, Symmetry, Symmetry]] = []
        self._failures: list[Finding] = []

        def find(obj: Object) -> Iterator[float]:
            require_own(obj, "library_override_symmetry")
            shape = surface_shape_of(obj, context.evaluated_depsgraph_get())
            yield 0.3
            skin = Skin(shape)
            yield from (0.4 + 0.5 * share for share in skin.grow())
            self._found.append((obj, shape.measurement, *_symmetries(shape, skin, self.tolerance)))

        self._steps = selection.one_by_one(self._objects, find, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Nothing is kept before all are looked at, so that a canceled search leaves nothing behind."""
        for obj, measurement, found, allowed in self._found:
            _keep(obj, measurement, found, allowed, self.tolerance)
        # Blender reports what was written as a change of the object.
        staleness.settle_marks(context, [(obj, obj.body_moments_symmetry.fingerprint) for obj, *_ in self._found])
        symmetries = [
            finding(
                "symmetry_found_of_display_mesh" if displayed(measurement) else "symmetry_found",
                object=obj.name,
                group=found.group,
                description=[clause.as_record() for clause in described(found)],
            )
            for obj, measurement, found, _ in self._found
        ]
        selection.redraw(context)
        if self._failures or not symmetries:
            count = len(symmetries)
            done = finding("symmetry_searched", count=count) if self._objects else finding("nothing_measurable")
            return selection.summarize(self, count, len(self._objects), done, self._failures, symmetries)
        reports.report(self, *reports.first(symmetries))
        return {"FINISHED"}


def _symmetries(shape: Shape, skin: Skin, tolerance: float) -> tuple[Symmetry, Symmetry]:
    """What the surface confirms, and what the moments allow."""
    moments = shape.of_pieces()
    # Moments are looked at as loosely as the surface.
    allowed = symmetry(moments, max(NOISE, tolerance))
    near = tolerance * shape.size
    return confirmed(allowed, moments.about, skin.points, partial(skin.distance, within=near), near), allowed


def _keep(obj: Object, measurement: Measurement, found: Symmetry, allowed: Symmetry, tolerance: float) -> None:
    kept = obj.body_moments_symmetry
    kept.group, kept.compatible, kept.tolerance = found.group, allowed.group, tolerance
    kept.of_display_mesh = displayed(measurement)
    version, geometry, _, settings = measurement.fingerprint.split(":")
    kept.fingerprint = ":".join([version, geometry, scale_hash(obj), settings])
    kept.elements.clear()
    turn = measurement.rotation.T
    for kind, order, direction in _elements(found)[:KEPT]:
        element = kept.elements.add()
        element.kind, element.order, element.direction = kind, order, turn @ _upward(turn, direction)


def _upward(turn: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Of the two directions of a line the one whose largest component, in the object's axes, is positive."""
    local = turn @ direction
    return direction if local[np.argmax(np.abs(local))] > 0.0 else -direction


def _elements(found: Symmetry) -> list[tuple[str, int, np.ndarray]]:
    if len(found.round_about) == 1:
        return [("ROUND", 0, found.round_about[0])] + [("PLANE", 0, normal) for normal in found.planes]
    return [("AXIS", order, axis) for axis, order in found.axes] + [("PLANE", 0, normal) for normal in found.planes]


def described(found: Symmetry) -> list[Finding]:
    """What a symmetry consists of."""
    if len(found.round_about) == 3:
        return [finding("symmetry_sphere")]
    if len(found.round_about) == 1:
        reversible = found.group == "D∞h"
        return [finding("symmetry_revolution_reversible" if reversible else "symmetry_revolution")]
    clauses = []
    if found.axes:
        clauses.append(finding("symmetry_axes", count=len(found.axes), order=found.axes[0][1]))
    if found.planes:
        clauses.append(finding("symmetry_planes", count=len(found.planes)))
    if found.has_center and not clauses:
        clauses.append(finding("symmetry_inversion"))
    return clauses or [finding("symmetry_none")]


CLASSES = (BodyMomentsElement, BodyMomentsSymmetry, OBJECT_OT_body_moments_find_symmetry)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Object.body_moments_symmetry = PointerProperty(name="Symmetry", type=BodyMomentsSymmetry)


def unregister() -> None:
    del Object.body_moments_symmetry
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
