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
from bpy.types import FCurve, Object
from numpy.typing import NDArray

from ....core.statics.support import Support
from ...write.properties import BALANCE_GROUP
from ..tracking import handlers
from ..tracking.cache import SessionCache

INSIDE = "body_balance_inside"  # 1 if the center is over the support polygon, else 0
CONSTANT, LINEAR = 0, 1  # values of an F-curve's interpolation


@dataclass(frozen=True, eq=False)
class Path:
    """Path of a center of mass over f frames.

    frames: (f,). centers: (f, 3), in Blender's units and the world.
    inside: (f,), True for a center over the support polygon; None without a polygon.
    """

    frames: NDArray[np.float64]
    centers: NDArray[np.float64]
    inside: NDArray[np.bool_] | None


_supports: SessionCache[Mapping[int, Support]] = SessionCache()


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


def store(empty: Object, path: Path, supports: Sequence[Support | None]) -> None:
    """Replace the keys of the empty by the path, and cache the support polygons."""
    curves = _curves(empty)
    for axis in range(3):
        _write_keys(curves, "location", axis, path.frames, path.centers[:, axis], LINEAR)
    if path.inside is not None:
        empty[INSIDE] = 0
        empty.id_properties_ui(INSIDE).update(
            min=0, max=1, description="Whether the center is over the support polygon"
        )
        _write_keys(curves, '["{:s}"]'.format(INSIDE), 0, path.frames, path.inside, CONSTANT)
    elif INSIDE in empty:
        _remove(curves, '["{:s}"]'.format(INSIDE), 0)
        del empty[INSIDE]
    _supports[empty] = {
        round(float(frame)): support for frame, support in zip(path.frames, supports) if support is not None
    }
    handlers.count_change(empty)


def path(empty: Object) -> Path | None:
    """Return the path in an empty's keys, None if there are none."""
    curves = _existing_curves(empty)
    keys = [keys for axis in range(3) if (keys := _keys(curves, "location", axis)) is not None]
    if len(keys) < 3 or len({len(axis_keys) for axis_keys in keys}) != 1:
        return None
    centers = np.stack([axis_keys[:, 1] for axis_keys in keys], axis=1)
    signal = _keys(curves, '["{:s}"]'.format(INSIDE), 0)
    inside = None if signal is None or len(signal) != len(centers) else signal[:, 1] > 0.5
    return Path(keys[0][:, 0], centers, inside)


def support(empty: Object, frame: int) -> Support | None:
    """Return the support polygon of a group at a frame, or None if none is cached."""
    return (_supports.get(empty) or {}).get(frame)


def _curves(empty: Object):
    """Return the F-curves of the empty's action, which is created if there is none."""
    animation = empty.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(empty.name)
    action = animation.action
    if animation.action_slot is None:
        animation.action_slot = action.slots.new("OBJECT", empty.name)
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new()
    return strip.channelbag(animation.action_slot, ensure=True).fcurves


def _existing_curves(empty: Object) -> Iterable[FCurve]:
    animation = empty.animation_data
    if animation is None or animation.action_slot is None:
        return ()
    for layer in animation.action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(animation.action_slot)
            if bag is not None:
                return bag.fcurves
    return ()


def _keys(curves: Iterable[FCurve], data_path: str, index: int) -> NDArray[np.float64] | None:
    """Return the (k, 2) frames and values of a curve's keys, or None if there is no such curve."""
    for curve in curves:
        if curve.data_path == data_path and curve.array_index == index:
            points = np.empty(2 * len(curve.keyframe_points), np.float32)
            curve.keyframe_points.foreach_get("co", points)
            return points.reshape(-1, 2).astype(np.float64)
    return None


def _remove(curves, data_path: str, index: int) -> None:
    for curve in list(curves):
        if curve.data_path == data_path and curve.array_index == index:
            curves.remove(curve)


def _write_keys(curves, data_path: str, index: int, frames: NDArray, values: NDArray, interpolation: int) -> None:
    _remove(curves, data_path, index)
    curve = curves.new(data_path, index=index)
    count = len(frames)
    curve.keyframe_points.add(count)
    points = np.stack([frames, values], axis=1).astype(np.float32).ravel()
    curve.keyframe_points.foreach_set("co", points)
    curve.keyframe_points.foreach_set("interpolation", np.full(count, interpolation, np.int32))
    curve.update()
