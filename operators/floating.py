# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating objects: where they rest in a liquid, all such positions, and righting arms."""

from collections.abc import Callable

from bpy.props import BoolProperty, FloatProperty, IntProperty
from bpy.types import Context, Object, Operator

from ..blender import session
from ..core.verdict import Finding
from . import selection


class OnFloating(selection.OnSelectionInObjectMode):
    """Base of operators on floating bodies: each selected object, with its children."""

    as_one: BoolProperty(
        name="As One Body",
        description="All selected objects are one body. Otherwise each floats by itself, with its "
        "children",
    )

    def for_each_body(
        self,
        context: Context,
        act: Callable[[tuple[Object, ...], list[Finding]], bool],
        summary_texts: tuple[str, str],
    ) -> set[str]:
        """Run `act` for each body, and report how many it returned True for.

        act: gets the objects of a body, and the list for its findings. summary_texts: the English
        report, for one body and for `count` bodies.
        """
        # by the first object of each body, whose name a refusal is reported with
        bodies = {
            body[0]: body
            for body in session.stored.floating.bodies_of(
                context.view_layer.objects.selected, self.as_one
            )
        }
        notes: list[Finding] = []
        return selection.change_all(
            self,
            [*bodies],
            lambda root: act(bodies[root], notes),
            summary_texts,
            "already at rest",
            notes,
            "Nothing selected floats",
        )


class OBJECT_OT_body_moments_float(OnFloating, Operator):
    """Move and turn the selected objects, with their children, to where they come to rest in the
    scene's liquid, from where they are
    """

    bl_label = "Float"

    position: IntProperty(
        name="Position",
        description="Position of rest, the one with the lowest energy first. 0 for the one that it "
        "settles in from where it is",
        default=0,
        min=0,
        soft_max=12,
    )

    def execute(self, context: Context) -> set[str]:
        def settle(members: tuple[Object, ...], notes: list[Finding]) -> bool:
            return session.stored.floating.float_body(context, members, self.position, notes)

        return self.for_each_body(
            context, settle, ("Set {count} body afloat", "Set {count} bodies afloat")
        )


class OBJECT_OT_body_moments_float_positions(OnFloating, Operator):
    """Find the positions in which the selected objects rest in the scene's liquid, from 26 starts,
    and list them. Nothing moves
    """

    bl_label = "Find Positions"

    def execute(self, context: Context) -> set[str]:
        def find(members: tuple[Object, ...], _notes: list[Finding]) -> bool:
            return bool(session.stored.floating.find_positions(context, members).rests)

        return self.for_each_body(
            context,
            find,
            ("Found the positions of {count} body", "Found the positions of {count} bodies"),
        )


class OBJECT_OT_body_moments_righting_arms(OnFloating, Operator):
    """Compute the righting arms GZ of the selected objects over angles of heel from where they
    rest, and the range of stability. Nothing moves
    """

    bl_label = "Righting Arms"

    last: FloatProperty(
        name="Largest Heel",
        description="Largest angle of heel, to both sides",
        default=3.14159265,
        min=0.01745,
        max=3.14159265,
        subtype="ANGLE",
    )
    step: FloatProperty(
        name="Step",
        description="Angle from one righting arm to the next",
        default=0.0872664626,
        min=0.0087,
        max=0.5236,
        subtype="ANGLE",
    )
    free_trim: BoolProperty(
        name="Free Trim",
        description="At each angle the body pitches until no moment is left. Otherwise the trim "
        "stays as at rest",
        default=True,
    )
    add_curve: BoolProperty(
        name="Add F-Curve",
        description="Add an empty with an F-curve of the righting arms in meters, with a frame for "
        "each degree of heel",
    )

    def execute(self, context: Context) -> set[str]:
        # The range is divided evenly, by steps next to the given one; 0 is one of the angles.
        count = round(self.last / self.step)
        angles = [self.last * i / count for i in range(-count, count + 1)]

        def heel(members: tuple[Object, ...], _notes: list[Finding]) -> bool:
            afloat = session.stored.floating.heel(context, members, angles, self.free_trim)
            if self.add_curve:
                session.stored.floating.add_curve(context, afloat)
            return True

        return self.for_each_body(
            context,
            heel,
            (
                "Computed righting arms of {count} body",
                "Computed righting arms of {count} bodies",
            ),
        )
