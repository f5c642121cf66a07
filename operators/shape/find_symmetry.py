# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Find Symmetry: the rotation axes and mirror planes of the selected objects.

They are found by the moments and confirmed on the surfaces, and kept with each object, in its own
axes, for the panel.
"""

from collections.abc import Iterator

from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
)
from bpy.types import Context, Object, Operator, PropertyGroup

from ... import core
from ...blender import bodies, scene, session, write
from ...blender.session.tracking import staleness, stamps
from ...core.verdict import Finding
from .. import modal, selection


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

    group: StringProperty(
        name="Symmetry",
        description="Schoenflies symbol of the symmetry that the surface confirms",
    )
    compatible: StringProperty(
        name="By Moments", description="Schoenflies symbol of the symmetry that the moments allow"
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description="Largest distance of the surface from its images, relative to the radius of "
        "gyration",
    )
    of_display_mesh: BoolProperty(
        name="Of Display Mesh", description="The display mesh of a NURBS surface was compared"
    )
    fingerprint: StringProperty()
    elements: CollectionProperty(type=BodyMomentsElement)


class OBJECT_OT_body_moments_find_symmetry(modal.ModalSteps, selection.OnSelection, Operator):
    """Find the rotation axes and mirror planes through the center of mass of the selected objects
    that moments allow and the surface, or of flat shapes the outline, confirms
    """

    bl_label = "Find Symmetry"
    PROGRESS = "Finding symmetry: {share:.0%}. Esc to cancel"
    CANCELED = "Search canceled; nothing was changed"

    tolerance: FloatProperty(
        name="Tolerance",
        default=1e-3,
        min=1e-6,
        max=0.1,
        precision=6,
        description="Largest allowed distance of the surface from its images, relative to the "
        "radius of gyration",
    )

    def _begin(self, context: Context) -> int:
        self._objects = selection.selected_measurable(context)
        # an object, its shape, the symmetry of the surface, and that of the moments
        self._results: list[
            tuple[
                Object,
                bodies.Shape | bodies.FlatShape,
                core.shape.Symmetry,
                core.shape.Symmetry,
            ]
        ] = []
        self._failures: list[Finding] = []

        def find(obj: Object) -> Iterator[float]:
            scene.changes.require_storable_data(obj)
            shape = bodies.comparable_shape_of(obj, context.evaluated_depsgraph_get())
            yield 0.3  # share of the time, estimated
            self._results.append((obj, shape, *shape.find_symmetries(self.tolerance)))

        self._steps = selection.iterate_objects(self._objects, find, self._failures)
        return len(self._objects)

    def _finish(self, context: Context) -> set[str]:
        """Store the symmetries of all objects at the end, so that a canceled search leaves none
        behind.
        """
        for obj, shape, found_symmetry, allowed in self._results:
            session.stored.results.store_symmetry(
                obj, shape, found_symmetry, allowed, self.tolerance
            )
        # Blender reports the stored symmetry as a change of the object.
        staleness.mark_stored(context, [obj for obj, *_ in self._results], stamps.Kind.SYMMETRY)
        texts = (
            "{object}: {group}, {description}",
            "{object}: {group}, {description}, of the display mesh",
        )
        symmetries = [
            write.reports.phrase(
                texts[1] if shape.is_display_mesh else texts[0],
                object=obj.name,
                group=symmetry.group,
                description=", ".join(describe(symmetry)),
            )
            for obj, shape, symmetry, _ in self._results
        ]
        selection.redraw(context)
        if self._failures or not symmetries:
            count = len(symmetries)
            summary = write.reports.phrase(
                "Searched {count} object", "Searched {count} objects", count=count
            )
            return selection.summarize(
                self, count, len(self._objects), summary, self._failures, symmetries
            )
        return write.reports.report(self, *write.reports.first(symmetries))


def describe(symmetry: "core.shape.Symmetry") -> list[str]:
    """Return translated descriptions of the elements of a symmetry."""
    phrase = write.reports.phrase
    if len(symmetry.revolution_axes) == 3:  # any axis is one; three stand for all
        return [phrase("sphere")]
    if len(symmetry.revolution_axes) == 1:
        reversible = symmetry.group == "D∞h"
        return [
            phrase(
                "body of revolution, symmetric end to end" if reversible else "body of revolution"
            )
        ]
    clauses = []
    if symmetry.axes:
        texts = ("{count} rotation axis, {order}-fold", "{count} rotation axes, up to {order}-fold")
        _direction, order = symmetry.axes[0]  # the highest order comes first
        clauses.append(phrase(*texts, count=len(symmetry.axes), order=order))
    if symmetry.planes:
        clauses.append(
            phrase("{count} mirror plane", "{count} mirror planes", count=len(symmetry.planes))
        )
    if symmetry.has_center and not clauses:
        clauses.append(phrase("center of inversion"))
    return clauses or [phrase("no symmetry")]


POINTERS = {(Object, "body_moments_symmetry"): BodyMomentsSymmetry}
