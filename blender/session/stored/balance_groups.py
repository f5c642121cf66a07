# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Balance groups: objects whose center of mass was followed over frames, as keys of an empty.

The path is drawn from these keys. The support polygons are remembered while the file is open.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Object

from ....core import numerics, statics
from ...scene import fcurves
from ...write.properties import BALANCE_GROUP, BALANCE_SPANS
from .. import memory, tracking

INSIDE = "body_balance_inside"
CONTACT = "body_balance_contact"
UNEXPLAINED = "body_balance_unexplained"
DESCRIPTIONS = {  # custom properties with F-curves
    INSIDE: "Whether the center is over the support polygon",
    CONTACT: "Whether anything touches the ground",
    UNEXPLAINED: "Whether the momentum changes without a contact",
    "body_balance_velocity": "Velocity of the center of mass, m/s",
    "body_balance_momentum": "Linear momentum, kg·m/s",
    "body_balance_angular_momentum": "Angular momentum about the center of mass, kg·m²/s",
    "body_balance_kinetic_energy": "Kinetic energy, J",
    "body_balance_margin": "Distance of the center from the edge of the support polygon, m; "
    "negative outside",
    "body_balance_zero_moment_point": "Point of the ground at which contact forces have no moment "
    "along it",
}


@dataclass(frozen=True, eq=False)
class Path:
    """Path of a center of mass over f frames.

    frames: (f,) times of the keys. centers: (f, 3), in Blender's units and the world. inside: (f,),
    True for a center over the support polygon; None without a polygon. contact, unexplained: (f,),
    whether anything touches the ground, and whether momentum changes without that; None for groups.
    """

    frames: numerics.Array
    centers: numerics.Array
    inside: numerics.Mask | None
    contact: numerics.Mask | None = None
    unexplained: numerics.Mask | None = None


def groups(scene: bpy.types.Scene) -> Iterator[Object]:
    """Yield the empties of a scene that hold balance groups."""
    for obj in scene.objects:
        if obj.type == "EMPTY" and BALANCE_GROUP in obj:
            yield obj


def find(scene: bpy.types.Scene, objects: Iterable[Object]) -> Object | None:
    """Return the empty of these objects' balance group, None if there is none."""
    text = group_text(objects)
    return next((empty for empty in groups(scene) if empty[BALANCE_GROUP] == text), None)


def group_text(objects: Iterable[Object]) -> str:
    """Return the stored text of a group's objects."""
    return "\n".join(sorted(obj.name_full for obj in objects))


def store(
    empty: Object,
    frames: numerics.NDArray,
    scale: float,
    centers: numerics.NDArray,
    signals: Mapping[str, numerics.NDArray],
    supports: Sequence[statics.Support | None],
    spans: Sequence[tuple[float, float, float, float]],
) -> None:
    """Put a path and (f,) or (f, 3) signals on the empty as keys, in place of earlier ones, and
    remember the supports.

    frames: (f,). scale: the time of F-curves that passes in a frame. signals: by their keys in
    DESCRIPTIONS, those of other keys are removed; truth values are keyed as 0 and 1, and frames
    without a value, which is NaN, get no key. spans: the first and last frame of a change of
    momenta without a cause, and its linear and angular momentum in SI units.
    """
    if spans:
        empty[BALANCE_SPANS] = [float(value) for span in spans for value in span]
    else:
        empty.pop(BALANCE_SPANS, None)
    curves = fcurves.ensure_curves(empty, alone=True)
    times = scale * frames
    for axis in range(3):
        fcurves.write_keys(curves, ("location", axis), times, centers[:, axis])
    for name, description in DESCRIPTIONS.items():
        path = '["{:s}"]'.format(name)
        values = signals.get(name)
        # Without keys, the earlier curves are removed: they may have had more axes.
        for axis in range(3):
            fcurves.write_keys(curves, (path, axis), times[:0], times[:0])
        if values is None:
            empty.pop(name, None)
            continue
        is_truth = values.dtype == bool
        empty[name] = np.zeros_like(values[0], int if is_truth else float).tolist()
        empty.id_properties_ui(name).update(
            description=description, **({"min": 0, "max": 1} if is_truth else {})
        )
        for axis, column in enumerate(values.reshape(len(frames), -1).T):
            has_value = ~np.isnan(column)
            fcurves.write_keys(
                curves,
                (path, axis),
                times[has_value],
                column[has_value],
                fcurves.CONSTANT if is_truth else fcurves.LINEAR,
            )
    memory.supports[empty] = {
        round(float(frame)): support
        for frame, support in zip(frames, supports)
        if support is not None
    }
    tracking.handlers.count_change(empty)


def path(empty: Object) -> Path | None:
    """Return the path in an empty's keys, None if there are none."""
    curves = fcurves.existing_curves(empty)
    by_axis = [_keys(curves, ("location", axis)) for axis in range(3)]
    keys = [axis_keys for axis_keys in by_axis if axis_keys is not None]
    # Someone may have deleted keys of one axis.
    if len(keys) < 3 or len({len(axis_keys) for axis_keys in keys}) != 1:
        return None
    centers = np.stack([axis_keys[:, 1] for axis_keys in keys], axis=1)
    signals = [
        _keys(curves, ('["{:s}"]'.format(name), 0)) for name in (INSIDE, CONTACT, UNEXPLAINED)
    ]
    truths = (
        None if signal is None or len(signal) != len(centers) else signal[:, 1] > 0.5
        for signal in signals
    )
    return Path(keys[0][:, 0], centers, *truths)


def support(empty: Object, frame: int) -> statics.Support | None:
    """Return the support polygon of a group at a frame, or None if none is cached."""
    return (memory.supports.get(empty) or {}).get(frame)


def _keys(curves: Iterable[bpy.types.FCurve], channel: fcurves.Channel) -> numerics.Array | None:
    """Return the (k, 2) times and values of a channel's keys, None without a curve."""
    curve = fcurves.find(curves, channel)
    return None if curve is None else fcurves.read(curve)["co"].astype(np.float64)
