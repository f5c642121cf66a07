# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The displayed bodies, as arrays in Blender's units and world axes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object
from numpy.typing import NDArray

from ...blender.session.live import live
from ...blender.session.stored import results
from ...blender.session.stored.shown import changes_alone, shown_body, shown_bone
from ...blender.session.tracking import posed
from ...core.numerics.float32 import shortest_decimal
from . import appearance as look


@dataclass(frozen=True, eq=False)
class Bodies:
    """Displayed bodies: (n, 3) centers of mass, and (n, 3, 3) principal axes as columns.

    `gyration`: (n, 3) radii of gyration about the axes. `verdicts`: (n,) indices into `appearance.VERDICTS`.
    """

    centers: NDArray[np.float64]
    axes: NDArray[np.float64]
    gyration: NDArray[np.float64]
    verdicts: NDArray[np.intp]

    def __len__(self) -> int:
        return len(self.centers)

    def chosen(self, mask: NDArray[np.bool_]) -> Bodies:
        """Return the bodies selected by a mask."""
        return Bodies(self.centers[mask], self.axes[mask], self.gyration[mask], self.verdicts[mask])

    def differ_from(self, others: Bodies) -> NDArray[np.bool_]:
        """Return a mask of the bodies that differ from `others`, compared index by index."""
        changed = self.verdicts != others.verdicts
        for own, other in ((self.centers, others.centers), (self.axes, others.axes), (self.gyration, others.gyration)):
            changed |= (own != other).reshape(len(self), own[0].size if len(self) else 1).any(axis=1)
        return changed


@dataclass(frozen=True, eq=False)
class Collected:
    """The displayed bodies and their objects.

    `objects`: session uids and names of the bodies' objects; empty if some bodies belong to something else.
    `alone`: places of the objects whose numbers change with no move of another object, by session uid.
    """

    bodies: Bodies
    objects: list[tuple[int, str]]
    alone: dict[int, int]


NO_BODIES = Bodies(np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros(0, np.intp))
NOTHING = Collected(NO_BODIES, [], {})


def drawn_objects(context: Context, show_all: bool) -> Iterator[Object]:
    """Yield the objects with numbers to draw in a view: visible and, if not all, selected.

    In Pose Mode an armature represents its meshes.
    """
    layer, space = context.view_layer, context.space_data
    for obj in layer.objects if show_all else layer.objects.selected:
        has_numbers = "body_mass" in obj or live.is_live(obj) or posed.stands_for_meshes(obj)
        if has_numbers and obj.visible_in_viewport_get(space):
            yield obj


def collect(context: Context) -> Collected:
    """Gather the displayed bodies: of objects, of selected pose bones, and if enabled of the selection as one."""
    scene = context.scene
    settings = scene.body_moments.overlay
    bodies, objects, alone = [], [], {}
    for obj in drawn_objects(context, settings.show_all):
        body = shown_body(obj, scene)
        if body is not None:
            if changes_alone(obj):
                alone[obj.session_uid] = len(bodies)
            objects.append((obj.session_uid, obj.name))
            bodies.append((body.center, body.axes, body.gyration, look.VERDICTS.index(body.verdict)))
    for bone in context.selected_pose_bones or ():
        body = shown_bone(bone, scene)
        if body is not None:
            bodies.append((body.center, body.axes, body.gyration, look.VERDICTS.index(body.verdict)))
    if settings.show_sum:
        total = results.total(context)
        if total.count > 1 and total.body is not None:
            unit = shortest_decimal(scene.unit_settings.scale_length)
            body = total.body
            bodies.append(
                (body.center / unit, body.principal.axes, body.radii_of_gyration / unit, look.VERDICTS.index("sum"))
            )
    if not bodies:
        return NOTHING
    is_of_objects = len(objects) == len(bodies)
    collected = Bodies(*(np.array(values) for values in zip(*bodies)))
    return Collected(collected, objects if is_of_objects else [], alone)


def collect_moved(context: Context, before: Collected, moved: set[int]) -> Collected | None:
    """Gather the displayed bodies after some objects have moved, or return None if that takes a full `collect`."""
    if not before.objects:
        return None
    places = {before.alone[uid] for uid in moved if uid in before.alone}
    places.update(set(range(len(before.objects))).difference(before.alone.values()))
    old = before.bodies
    bodies = Bodies(old.centers.copy(), old.axes.copy(), old.gyration.copy(), old.verdicts.copy())
    for place in places:
        uid, name = before.objects[place]
        obj = context.view_layer.objects.get(name)  # or another one that is linked under the same name
        body = None if obj is None or obj.session_uid != uid else shown_body(obj, context.scene)
        if body is None:
            return None
        bodies.centers[place], bodies.axes[place], bodies.gyration[place] = body.center, body.axes, body.gyration
        bodies.verdicts[place] = look.VERDICTS.index(body.verdict)
    return Collected(bodies, before.objects, before.alone)
