# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""F-curves of objects: the keys of slotted actions, sections of keys, and additive layers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import bpy
import numpy as np
from bpy.types import FCurve, Object
from numpy.typing import NDArray

# values of an F-curve's interpolation
CONSTANT = 0
LINEAR = 1
Channel = tuple[str, int]  # data path and index


def ensure_curves(obj: Object):
    """Return the F-curves of an object's action, which is created if there is none, and copied if
    it is linked.
    """
    animation = obj.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(obj.name)
    elif animation.action.library is not None:
        slot = animation.action_slot.identifier
        animation.action = animation.action.copy()
        animation.action_slot = animation.action.slots[slot]
    action = animation.action
    if animation.action_slot is None:
        animation.action_slot = action.slots.new("OBJECT", obj.name)
    return _bag(action, animation.action_slot)


def _bag(action: bpy.types.Action, slot: bpy.types.ActionSlot):
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new()
    return strip.channelbag(slot, ensure=True).fcurves


def existing_curves(obj: Object) -> list[FCurve]:
    """Return the F-curves of an object's action, none without one."""
    return [] if obj.animation_data is None else [*_curves_of(obj.animation_data)]


def all_curves(obj: Object) -> Iterator[FCurve]:
    """Yield the F-curves of an object's action and of the strips of its NLA."""
    animation = obj.animation_data
    if animation is not None:
        for keyed in (
            animation,
            *(strip for track in animation.nla_tracks for strip in track.strips),
        ):
            yield from _curves_of(keyed)


def _curves_of(keyed: bpy.types.AnimData | bpy.types.NlaStrip) -> Iterator[FCurve]:
    """Yield the F-curves of the action and the slot that an object or a strip has."""
    if keyed.action is not None and keyed.action_slot is not None:
        for strip in (strip for layer in keyed.action.layers for strip in layer.strips):
            bag = strip.channelbag(keyed.action_slot)
            yield from () if bag is None else bag.fcurves


def is_shared(obj: Object) -> bool:
    """Return whether the keys of an object's action, which is not linked, also animate other
    objects.
    """
    animation = obj.animation_data
    if animation.action.library is not None:
        return False
    # ActionSlot.users() can crash Blender 5.2.
    slot = animation.action_slot
    users = bpy.data.user_map(subset=[animation.action])[animation.action]
    owners = (getattr(user, "animation_data", None) for user in users)
    return sum(owner is not None and owner.action_slot == slot for owner in owners) > 1


def has_strips(obj: Object) -> bool:
    """Return whether the NLA animates an object."""
    animation = obj.animation_data
    return animation is not None and any(
        len(track.strips) and not track.mute for track in animation.nla_tracks
    )


def is_keyed(obj: Object, path: str, count: int) -> bool:
    """Return whether all components of a property have keys, in the action or in strips of the
    NLA.
    """
    return len({curve.array_index for curve in all_curves(obj) if curve.data_path == path}) == count


def find(curves: Iterable[FCurve], channel: Channel) -> FCurve | None:
    """Return the curve of a channel, None if there is none."""
    return next(
        (curve for curve in curves if (curve.data_path, curve.array_index) == channel), None
    )


def keys(curve: FCurve) -> NDArray[np.float64]:
    """Return the (k, 2) frames and values of a curve's keys."""
    points = np.empty(2 * len(curve.keyframe_points), np.float32)
    curve.keyframe_points.foreach_get("co", points)
    return points.reshape(-1, 2).astype(np.float64)


def write_keys(
    curves, channel: Channel, frames: NDArray, values: NDArray, interpolation: int = LINEAR
) -> None:
    """Put keys on a channel, in place of all earlier ones; without keys, remove its curve."""
    curve = find(curves, channel)
    if curve is not None:
        curves.remove(curve)
    if not len(frames):
        return
    curve = curves.new(channel[0], index=channel[1])
    curve.keyframe_points.add(len(frames))
    points = np.stack([frames, values], axis=1).astype(np.float32).ravel()
    curve.keyframe_points.foreach_set("co", points)
    curve.keyframe_points.foreach_set(
        "interpolation", np.full(len(frames), interpolation, np.int32)
    )
    curve.update()


def replace_section(curve: FCurve, first: int, last: int, values: NDArray) -> None:
    """Replace the keys from one frame to another by (n,) values, one a frame; later keys move if n
    exceeds the frames.

    The frames before and after, up to the next keys, get a key each, so that they stay as they are.
    """
    frames = keys(curve)[:, 0]
    before = frames[frames <= first].max(initial=-np.inf)
    after = frames[frames >= last].min(initial=np.inf)
    shift = first + len(values) - 1 - last
    # Beyond all keys, one more keeps a linear extrapolation.
    around = [*range(int(np.ceil(before)) if np.isfinite(before) else first - 1, first)]
    around += range(last + 1, int(np.floor(after)) + 1 if np.isfinite(after) else last + 2)
    kept = {frame + (shift if frame > last else 0): curve.evaluate(frame) for frame in around}
    points = curve.keyframe_points
    for point in reversed(points):
        if before < point.co.x < after:
            points.remove(point, fast=True)
        elif point.co.x >= after and shift:
            point.co.x += shift
            point.handle_left.x += shift
            point.handle_right.x += shift
    kept.update(zip(range(first, first + len(values)), values.tolist()))
    for frame, value in kept.items():
        points.insert(frame, value, options={"FAST"}).interpolation = "LINEAR"
    curve.update()


def add_layer(obj: Object, name: str, frames: NDArray, channels: Mapping[Channel, NDArray]) -> None:
    """Add a strip of keys that is combined with the animation below; the action becomes a strip,
    too.
    """
    animation = obj.animation_data_create()
    action = animation.action
    if action is not None:
        is_combined = has_strips(
            obj
        )  # without strips below, Blender ignores how the action is combined
        strip = animation.nla_tracks.new().strips.new(
            action.name, int(action.frame_range[0]), action
        )
        strip.action_slot = animation.action_slot
        if is_combined:
            strip.blend_type = animation.action_blend_type
            strip.influence = animation.action_influence
            strip.use_animated_influence = True
            strip.extrapolation = animation.action_extrapolation
        # Cycles and keys outside a manual frame range go on.
        scene = bpy.context.scene
        (start, end) = action.curve_frame_range
        strip.action_frame_start = min(start, scene.frame_start)
        strip.action_frame_end = max(end, scene.frame_end)
        strip.frame_start_ui = strip.action_frame_start
        animation.action = None
    layer = bpy.data.actions.new(name)
    slot = layer.slots.new("OBJECT", obj.name)
    curves = _bag(layer, slot)
    for channel, values in channels.items():
        write_keys(curves, channel, frames, values)
    track = animation.nla_tracks.new()
    track.name = name
    strip = track.strips.new(name, int(frames[0]), layer)
    strip.action_slot = slot
    strip.blend_type = "COMBINE"
    strip.extrapolation = "NOTHING"
