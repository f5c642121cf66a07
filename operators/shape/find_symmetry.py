# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Symmetry: the rotation axes and mirror planes of the selected objects.

They are found by the moments and confirmed on the surfaces, and kept with each object, in its own axes, for the panel.
"""

from __future__ import annotations

from collections.abc import Iterator

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

from ...blender.bodies.flat.flat_shape import FlatShape, comparable_shape_of, distance_from
from ...blender.bodies.shape.shape import Shape
from ...blender.read.fingerprint import scale_hash
from ...blender.scene.transforms import require_storable_data
from ...blender.session.tracking import staleness, stamps
from ...blender.write import reports
from ...core.shape.symmetries import Symmetry
from ...core.verdict.finding import Finding, finding
from .. import selection
from ..findings import (
    LIBRARY_OVERRIDE_SYMMETRY,
    NOTHING_MEASURABLE,
    SYMMETRY_AXES,
    SYMMETRY_FOUND,
    SYMMETRY_FOUND_OF_DISPLAY_MESH,
    SYMMETRY_INVERSION,
    SYMMETRY_NONE,
    SYMMETRY_PLANES,
    SYMMETRY_REVOLUTION,
    SYMMETRY_REVOLUTION_REVERSIBLE,
    SYMMETRY_SEARCHED,
    SYMMETRY_SPHERE,
)
from ..modal import ModalSteps, redraw

MAX_STORED_ELEMENTS = 32  # elements of a symmetry that are stored; of a ball's or a fine prism's nobody reads more


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


class OBJECT_OT_body_moments_find_symmetry(ModalSteps, Operator):
    """Find the rotation axes and mirror planes of the selected objects."""

    bl_idname = "object.body_moments_find_symmetry"
    bl_label = "Find Symmetry"
    bl_description = (
        "Find the rotation axes and mirror planes through the center of mass of the selected objects that moments "
        "allow and the surface, or of flat shapes the outline, confirms"
    )
    bl_options = {"REGISTER", "UNDO"}
    PROGRESS = "Finding symmetry: {share:.0%}. Esc to cancel"
    CANCELED = "Search canceled; nothing was changed"

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
        return selection.poll_selection(cls, context, any_mode=True)

    def execute(self, context: Context) -> set[str]:
        self._begin(context)
        return self.run_all_steps(context, len(self._objects))

    def invoke(self, context: Context, _event: Event) -> set[str]:
        self._begin(context)
        if context.window is None:
            return self.run_all_steps(context, len(self._objects))
        return self.start_modal(context, len(self._objects))

    def _begin(self, context: Context) -> None:
        self._objects = selection.selected_measurable(context)
        self._results: list[tuple[Object, Shape | FlatShape, Symmetry, Symmetry]] = []
        self._failures: list[Finding] = []

        def find(obj: Object) -> Iterator[float]:
            require_storable_data(obj, LIBRARY_OVERRIDE_SYMMETRY)
            shape = comparable_shape_of(obj, context.evaluated_depsgraph_get())
            yield 0.3
            skin = distance_from(shape)
            yield from (0.4 + 0.5 * share for share in skin.build())
            self._results.append((obj, shape, *shape.find_symmetries(skin, self.tolerance)))

        self._steps = selection.iterate_objects(self._objects, find, self._failures)

    def _finish(self, context: Context) -> set[str]:
        """Nothing is kept before all are looked at, so that a canceled search leaves nothing behind."""
        for obj, shape, found_symmetry, allowed in self._results:
            _store_symmetry(obj, shape, found_symmetry, allowed, self.tolerance)
        # Blender reports what was written as a change of the object.
        staleness.mark_stamps(
            context, [(obj, stamp) for obj, *_ in self._results if (stamp := stamps.of_symmetry(obj))]
        )
        symmetries = [
            finding(
                SYMMETRY_FOUND_OF_DISPLAY_MESH if shape.is_display_mesh else SYMMETRY_FOUND,
                object=obj.name,
                group=found_symmetry.group,
                description=[clause.as_record() for clause in describe(found_symmetry)],
            )
            for obj, shape, found_symmetry, _ in self._results
        ]
        redraw(context)
        if self._failures or not symmetries:
            count = len(symmetries)
            done = finding(SYMMETRY_SEARCHED, count=count) if self._objects else finding(NOTHING_MEASURABLE)
            return selection.summarize(self, count, len(self._objects), done, self._failures, symmetries)
        reports.report(self, *reports.first(symmetries))
        return {"FINISHED"}


def _store_symmetry(
    obj: Object, shape: Shape | FlatShape, confirmed: Symmetry, allowed: Symmetry, tolerance: float
) -> None:
    stored = obj.body_moments_symmetry
    stored.group, stored.compatible, stored.tolerance = confirmed.group, allowed.group, tolerance
    stored.of_display_mesh = shape.is_display_mesh
    stored.fingerprint = stamps.Stamp.parse(shape.fingerprint)._replace(transform=scale_hash(obj)).text
    stored.elements.clear()
    turn = shape.rotation.T
    for kind, order, direction in _elements(confirmed)[:MAX_STORED_ELEMENTS]:
        element = stored.elements.add()
        element.kind, element.order, element.direction = kind, order, turn @ _canonical_direction(turn, direction)


def _canonical_direction(turn: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Return the direction of a line whose largest component, in the object's axes, is positive."""
    local = turn @ direction
    return direction if local[np.argmax(np.abs(local))] > 0.0 else -direction


def _elements(found_symmetry: Symmetry) -> list[tuple[str, int, np.ndarray]]:
    if len(found_symmetry.revolution_axes) == 1:
        return [("ROUND", 0, found_symmetry.revolution_axes[0])] + [
            ("PLANE", 0, normal) for normal in found_symmetry.planes
        ]
    return [("AXIS", order, axis) for axis, order in found_symmetry.axes] + [
        ("PLANE", 0, normal) for normal in found_symmetry.planes
    ]


def describe(found_symmetry: Symmetry) -> list[Finding]:
    """Describe the elements of a symmetry."""
    if len(found_symmetry.revolution_axes) == 3:
        return [finding(SYMMETRY_SPHERE)]
    if len(found_symmetry.revolution_axes) == 1:
        reversible = found_symmetry.group == "D∞h"
        return [finding(SYMMETRY_REVOLUTION_REVERSIBLE if reversible else SYMMETRY_REVOLUTION)]
    clauses = []
    if found_symmetry.axes:
        clauses.append(finding(SYMMETRY_AXES, count=len(found_symmetry.axes), order=found_symmetry.axes[0][1]))
    if found_symmetry.planes:
        clauses.append(finding(SYMMETRY_PLANES, count=len(found_symmetry.planes)))
    if found_symmetry.has_center and not clauses:
        clauses.append(finding(SYMMETRY_INVERSION))
    return clauses or [finding(SYMMETRY_NONE)]


CLASSES = (BodyMomentsElement, BodyMomentsSymmetry, OBJECT_OT_body_moments_find_symmetry)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    Object.body_moments_symmetry = PointerProperty(name="Symmetry", type=BodyMomentsSymmetry)


def unregister() -> None:
    del Object.body_moments_symmetry
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
