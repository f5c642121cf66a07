# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The displayed bodies, as arrays in Blender's units and world axes, and their lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from bpy.types import Collection, Context, Object

from ...blender.session.displayed import ASSEMBLY, Displayed, all_drawn, drawn_bone, total
from ...blender.session.tracking.staleness import stale_reason
from ...blender.settings.assembly import active_assembly, settings_of
from ...blender.settings.scene import BodyMomentsOverlaySettings
from ...blender.write import properties
from ...core import inertia, numerics
from ...core.verdict import Verdict
from . import appearance as look

Entry = Displayed | inertia.PlainBody  # one body, or several as one
# Larger assemblies are not drawn: to know whether one is out of date takes 40 µs a member.
MAX_MEMBERS = 250
MANY = 20  # from this number of bodies on, their sum is drawn, and only doubtful ones beside it

# angles in radians: 48 and 16 sides of a closed circle
CIRCLE = 2.0 * np.pi / 48.0 * np.arange(49)
RING = CIRCLE[::3]
DASHES = 12  # dashes of a drop line
# radius of the ring at the foot of a drop line, relative to the largest radius of gyration; chosen
RING_RADIUS = 0.15
# The corner i of a cube has +1 along the axes of its set bits; an edge sets one more bit.
EDGES = np.array([[i, i | 1 << axis] for i in range(8) for axis in range(3) if not i & 1 << axis])
CORNERS = np.array([[(i >> axis & 1) * 2.0 - 1.0 for axis in range(3)] for i in range(8)])


@dataclass(frozen=True, eq=False)
class Bodies:
    """Displayed bodies: (n, 3) centers of mass, and (n, 3, 3) principal axes as columns.

    `gyration`: (n, 3) radii of gyration about the axes. `verdicts`: (n,) indices into
    `appearance.VERDICTS`.
    `shows_axes`, `shows_drop`: (n,) masks of the bodies with these lines.
    """

    centers: numerics.Array
    axes: numerics.Array
    gyration: numerics.Array
    verdicts: numerics.Index
    shows_axes: numerics.Mask
    shows_drop: numerics.Mask

    @classmethod
    def of(cls, entries: Sequence[Entry], unit: float) -> Bodies:
        """Return the bodies as arrays; unit: meters per Blender unit."""
        bodies = [
            (entry.world, entry.verdict) if isinstance(entry, Displayed) else (entry, "sum")
            for entry in entries
        ]
        return cls(
            np.array([numbers.center for numbers, _ in bodies]).reshape(-1, 3) / unit,
            np.array([numbers.axes for numbers, _ in bodies]).reshape(-1, 3, 3).transpose(0, 2, 1),
            np.array([numbers.gyration for numbers, _ in bodies]).reshape(-1, 3) / unit,
            np.array([look.VERDICTS.index(verdict) for _, verdict in bodies], np.intp),
            np.array([getattr(entry, "shows_axes", True) for entry in entries], bool),
            np.array([not getattr(entry, "is_plumbed", False) for entry in entries], bool),
        )

    def put(self, indices: list[int], bodies: Bodies) -> None:
        """Replace the bodies in these rows."""
        for name, values in vars(bodies).items():
            getattr(self, name)[indices] = values


def collect(context: Context, objects: list[Object]) -> tuple[list[Entry], int]:
    """Return the drawn bodies, and the index of the active one, or -1.

    They are those of the objects, of selected pose bones, of the active object's collection and, if
    enabled, the whole selection as one body. Of many objects, only the active one, the doubtful
    ones and the sum are drawn.
    """
    scene = context.scene
    # A character whose weight is shown has one mark.
    bones = [
        bone
        for bone in context.selected_pose_bones or ()
        if not bone.id_data.body_moments_weight.show
    ]
    displayed_pairs = list(
        zip(
            [*objects, *bones],
            [*all_drawn(objects, scene), *(drawn_bone(bone, scene) for bone in bones)],
        )
    )
    bodies = [(subject, body) for subject, body in displayed_pairs if body is not None]
    actives = (context.object, context.active_pose_bone)
    settings = scene.body_moments.overlay
    are_many = len(bodies) >= MANY
    selection_body = None
    if are_many and settings.show_all:
        # an assembly or a character is made of bodies that are drawn by themselves
        parts = [
            body.world for obj, body in bodies if body.method != ASSEMBLY and obj.type != "ARMATURE"
        ]
        selection_body = inertia.add_bodies(parts)
    elif are_many or settings.show_sum:
        selected = total(context)
        selection_body = selected.numbers if selected.count > 1 else None
    if are_many:
        bodies = [
            (obj, body)
            for obj, body in bodies
            if obj in actives or body.verdict == Verdict.DOUBTFUL
        ]
    entries: list[Entry] = [body for _, body in bodies]
    active = next((row for row, (subject, _) in enumerate(bodies) if subject in actives), -1)
    root = active_assembly(context)  # an empty with its children is drawn as an object
    assembly = properties.stored(root) if isinstance(root, Collection) else None
    if assembly is not None and (
        len(settings_of(root).rows) > MAX_MEMBERS or stale_reason(root, scene)
    ):
        assembly = None
    return entries + [entry for entry in (selection_body, assembly) if entry is not None], active


def body_lines(bodies: Bodies, settings: BodyMomentsOverlaySettings) -> numerics.Array:
    """Return the (n, k, 2, 3) segments of the enabled drawings, in the world."""
    place = bodies.centers, bodies.axes, bodies.gyration
    drawings = [np.empty((len(bodies.centers), 0, 2, 3))]
    if settings.show_axes:
        axes = axis_lines(*place)
        drawings.append(np.where(_each(bodies.shows_axes), axes, axes.mean(axis=2, keepdims=True)))
    if settings.show_drop_line:
        drops = drop_lines(bodies.centers, bodies.gyration)
        drawings.append(np.where(_each(bodies.shows_drop), drops, bodies.centers[:, None, None]))
    if settings.equivalent == "BOX":
        drawings.append(box_lines(*place))
    elif settings.equivalent == "ELLIPSOID":
        drawings.append(ellipsoid_lines(*place))
    return np.concatenate(drawings, axis=1)


def _each(mask: numerics.NDArray) -> numerics.Mask:
    """Return an (n,) mask for (n, k, 2, 3) segments."""
    return mask[:, None, None, None]


def axis_lines(
    centers: numerics.NDArray, axes: numerics.NDArray, gyration: numerics.NDArray
) -> numerics.Array:
    """Return (n, 3, 2, 3) segments of the axes through each center, to both sides the largest
    radius of gyration.
    """
    arms = axes.transpose(0, 2, 1) * gyration.max(axis=1)[:, None, None]
    return np.stack([centers[:, None] - arms, centers[:, None] + arms], axis=2)


def drop_lines(centers: numerics.NDArray, gyration: numerics.NDArray) -> numerics.Array:
    """Return (n, k, 2, 3) segments of a dashed line from each center to the floor, Z = 0, and of a
    ring at its foot.
    """
    feet = centers.copy()
    feet[:, 2] = 0.0
    # Dashes, and gaps of the same length between them: 2 DASHES − 1 parts.
    steps = np.arange(2 * DASHES).reshape(-1, 2) / (2.0 * DASHES - 1.0)
    dashes = feet[:, None, None] + steps[None, :, :, None] * (centers - feet)[:, None, None]
    points = np.stack([np.cos(RING), np.sin(RING), np.zeros_like(RING)], axis=1)
    ring = np.stack([points[:-1], points[1:]], axis=1)
    radii = RING_RADIUS * gyration.max(axis=1)[:, None, None, None]
    return np.concatenate([dashes, feet[:, None, None] + radii * ring], axis=1)


def _spread(gyration: numerics.NDArray) -> numerics.Array:
    """Return (n, 3) values (I_j + I_k - I_i) / m from (n, 3) radii of gyration.

    The values are twice the mean square distance along axis i. Rounding leaves none below 0.
    """
    squares = gyration**2
    return np.maximum(squares.sum(axis=1, keepdims=True) - 2.0 * squares, 0.0)


def box_lines(
    centers: numerics.NDArray, axes: numerics.NDArray, gyration: numerics.NDArray
) -> numerics.Array:
    """Return the edges of the box with the same mass and inertia: sides s_i² = 6 (I_j + I_k - I_i)
    / m.
    """
    half = np.sqrt(6.0 * _spread(gyration)) / 2.0
    return (centers[:, None] + np.einsum("nij,kj,nj->nki", axes, CORNERS, half))[:, EDGES]


def ellipsoid_lines(
    centers: numerics.NDArray, axes: numerics.NDArray, gyration: numerics.NDArray
) -> numerics.Array:
    """Return the ellipsoid with the same mass and inertia as three ellipses.

    Its semi-axes are a_i² = 5 (I_j + I_k - I_i) / (2 m).
    """
    half = np.sqrt(2.5 * _spread(gyration))
    circles = np.zeros((3, len(CIRCLE), 3))
    for axis in range(3):  # in the plane of the two other axes
        circles[axis, :, axis - 1] = np.cos(CIRCLE)
        circles[axis, :, axis - 2] = np.sin(CIRCLE)
    points = centers[:, None, None] + np.einsum("nij,ckj,nj->ncki", axes, circles, half)
    return np.stack([points[:, :, :-1], points[:, :, 1:]], axis=3).reshape(
        len(centers), 3 * (len(CIRCLE) - 1), 2, 3
    )
