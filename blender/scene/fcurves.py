# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""F-curves of objects: the keys of slotted actions, and sections of keys.

Keys are structured arrays with all that Blender keeps of them, so that the keys outside a section
stay to the last bit. Times are those of F-curves, which a scene stretches from its frames.
"""

from collections.abc import Callable, Iterable, Iterator

import bpy
import numpy as np
from bpy.types import FCurve, Object, Scene

from ...core.numerics import NDArray
from ...core.rig import handle_values
from ...core.verdict import EditRefusedError
from .findings import INTERPOLATION_UNCUT

# values of an F-curve's interpolation
CONSTANT = 0
LINEAR = 1
BEZIER = 2
FREE = 0  # a type of handles
KEY = np.dtype(
    [
        *((name, np.float32, 2) for name in ("co", "handle_left", "handle_right")),
        *((name, np.float32) for name in ("amplitude", "back", "period")),
        *((name, np.int32) for name in ("handle_left_type", "handle_right_type")),
        *((name, np.int32) for name in ("interpolation", "easing", "type")),
        *((name, np.bool_) for name in ("select_control_point", "select_left_handle")),
        ("select_right_handle", np.bool_),
    ]
)
FIELDS = KEY.names or ()
HANDLES = ("handle_left", "handle_right")
SAME_TIME = 1e-3  # frames; Blender itself takes closer keys for one
SAME_VALUE = 1e-4  # in the unit of a channel, mostly radians: smaller jumps are rounding
MOVED = 1e-3  # relative to a curve's range: a smaller move of a handle does not matter
JUMP = 1.0 / 80.0  # the least time between keys: Blender merges those within 0.01
Channel = tuple[str, int]  # data path and index


def time_scale(scene: Scene) -> float:
    """Return the time of F-curves that passes in a frame: 1 unless the scene stretches time."""
    return scene.render.frame_map_old / scene.render.frame_map_new


def ensure_curves(obj: Object, alone: bool = False):
    """Return the F-curves of an object's action, which is created if there is none, and copied if
    it is linked, or animates others, too, but shall not.
    """
    animation = obj.animation_data_create()
    if animation.action is None:
        animation.action = bpy.data.actions.new(obj.name)
    elif animation.action.library is not None or alone and sharing(obj):
        slot = animation.action_slot.identifier
        animation.action = animation.action.copy()
        animation.action_slot = animation.action.slots[slot]
    if animation.action_slot is None:
        animation.action_slot = animation.action.slots.new("OBJECT", obj.name)
    return slot_curves(animation.action, animation.action_slot)


def slot_curves(action: bpy.types.Action, slot: bpy.types.ActionSlot):
    """Return the F-curves of a slot in the first strip of an action, which is created if
    necessary.
    """
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new()
    return strip.channelbag(slot, ensure=True).fcurves


def existing_curves(obj: Object) -> list[FCurve]:
    """Return the F-curves of an object's action, none without one."""
    return [] if obj.animation_data is None else [*_curves_of(obj.animation_data)]


def all_curves(obj: Object) -> Iterator[FCurve]:
    """Yield the F-curves of an object's action and of the strips of its NLA."""
    if obj.animation_data is not None:
        for keyed in _keyed(obj.animation_data):
            yield from _curves_of(keyed)


def _keyed(animation: bpy.types.AnimData) -> Iterator[bpy.types.AnimData | bpy.types.NlaStrip]:
    """Yield all that has an action and a slot: the animation itself, and its strips."""
    yield animation
    for track in animation.nla_tracks:
        yield from track.strips


def _curves_of(keyed: bpy.types.AnimData | bpy.types.NlaStrip) -> Iterator[FCurve]:
    """Yield the F-curves of the action and the slot that an object or a strip has."""
    if keyed.action is not None and keyed.action_slot is not None:
        for strip in (strip for layer in keyed.action.layers for strip in layer.strips):
            bag = strip.channelbag(keyed.action_slot)
            yield from () if bag is None else bag.fcurves


def sharing(obj: Object) -> list[str]:
    """Return the names of other data that the keys of an object's action, which is not linked, also
    animate.
    """
    animation = obj.animation_data
    if animation is None or animation.action is None or animation.action.library is not None:
        return []
    # ActionSlot.users() can crash Blender 5.2.
    action_and_slot = animation.action, animation.action_slot
    return sorted(
        user.name
        for user in bpy.data.user_map(subset=[animation.action])[animation.action]
        if user != obj
        and (other := getattr(user, "animation_data", None)) is not None
        and any((keyed.action, keyed.action_slot) == action_and_slot for keyed in _keyed(other))
    )


def has_strips(obj: Object) -> bool:
    """Return whether the NLA animates an object."""
    animation = obj.animation_data
    return animation is not None and any(
        len(track.strips) and not track.mute for track in animation.nla_tracks
    )


def ensure_keyed(obj: Object, path: str, values: NDArray, time: float, in_strips: bool) -> None:
    """Key the components of a property that have no keys, neither in the action nor, if these
    count, in strips.
    """
    curves = all_curves(obj) if in_strips else existing_curves(obj)
    keyed = {curve.array_index for curve in curves if curve.data_path == path}
    for axis, value in enumerate(values):
        if axis not in keyed:
            write_keys(ensure_curves(obj), (path, axis), np.array([time]), np.array([value]))


def find(curves: Iterable[FCurve], channel: Channel) -> FCurve | None:
    """Return the curve of a channel, None if there is none."""
    return next(
        (curve for curve in curves if (curve.data_path, curve.array_index) == channel), None
    )


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


def read(curve: FCurve) -> NDArray:
    """Return the (k,) keys of a curve, as `KEY`."""
    keys = np.zeros(len(curve.keyframe_points), KEY)
    for name in FIELDS:
        values = np.ascontiguousarray(keys[name])
        curve.keyframe_points.foreach_get(name, values.ravel())
        keys[name] = values
    return keys


def write(curve: FCurve, keys: NDArray) -> None:
    """Put keys on a curve in place of all earlier ones, with the handles as they are.

    Automatic handles become free if Blender would move them, and the curve, at its next edit.
    """
    points = curve.keyframe_points
    points.clear()
    points.add(len(keys))
    keys = keys.copy()
    tolerance = MOVED * max(float(np.ptp(keys["co"][:, 1])), np.finfo(np.float32).tiny)
    # A handle bends the curve if the segment on its side is a Bézier one.
    is_bezier = np.concatenate([[False], keys["interpolation"] == BEZIER])
    while True:  # until no handle moves: a freed one may move others, but each is freed once
        _put(points, keys, FIELDS)
        curve.update()
        has_freed = False
        for name, bends in zip(HANDLES, (is_bezier[:-1], is_bezier[1:])):
            moved = np.abs(read(curve)[name] - keys[name])[:, 1] > tolerance
            rows = moved & bends & (keys[name + "_type"] != FREE)
            keys[name + "_type"][rows] = FREE
            has_freed |= bool(rows.any())
        if not has_freed:
            _put(points, keys, HANDLES)
            curve.id_data.update_tag()
            return


def _put(points: bpy.types.FCurveKeyframePoints, keys: NDArray, names: Iterable[str]) -> None:
    for name in names:
        points.foreach_set(name, np.ascontiguousarray(keys[name]).ravel())


def backup(obj: Object) -> Callable[[], None]:
    """Return a function that takes back all that is keyed on an object from now on."""
    animation = obj.animation_data
    if animation is None:
        return obj.animation_data_clear
    action, slot = animation.action, animation.action_slot
    saved = {(curve.data_path, curve.array_index): read(curve) for curve in _curves_of(animation)}
    track_count = len(animation.nla_tracks)

    def restore() -> None:
        for track in reversed(animation.nla_tracks[track_count:]):
            animation.nla_tracks.remove(track)
        animation.action = action
        if slot is not None:
            animation.action_slot = slot
            curves = slot_curves(action, slot)
            for curve in [*curves]:
                keys = saved.get((curve.data_path, curve.array_index))
                if keys is None:
                    curves.remove(curve)
                elif len(keys):
                    write(curve, keys)

    return restore


def section_keys(times: NDArray, values: NDArray) -> NDArray:
    """Return keys at (f + 1,) times, and between them cubics through a curve's values at the nodes
    of f frames.
    """
    keys = np.zeros(len(times), KEY)
    keys["interpolation"] = BEZIER
    nodes_per_frame = (len(values) - 1) // (len(times) - 1)
    keys["co"] = np.stack([times, values[::nodes_per_frame]], axis=1)
    thirds = np.diff(times) / 3.0
    right, left = handle_values(values)
    keys["handle_left"] = keys["handle_right"] = keys["co"]
    keys["handle_right"][:-1] = np.stack([times[:-1] + thirds, right], axis=1)
    keys["handle_left"][1:] = np.stack([times[1:] - thirds, left], axis=1)
    keys["handle_left"][0] -= (thirds[0], 0.0)
    keys["handle_right"][-1] += (thirds[-1], 0.0)
    return keys


def replace_section(curve: FCurve, times: NDArray, values: NDArray) -> None:
    """Replace the keys between two times by those of a section; the keys at its ends keep their
    values.
    """
    old = read(curve)
    keys = cut(curve, cut(curve, old.copy(), times[0]), times[-1])
    new = section_keys(times, values)
    before = keys[keys["co"][:, 0] <= times[0] + SAME_TIME]
    after = keys[keys["co"][:, 0] >= times[-1] - SAME_TIME]
    start, end = before[-1:], after[:1]  # views: the ends of the section
    _hold_slopes(curve, keys, start, end)
    slope = np.diff(old["co"][-2:], axis=0)
    is_line = curve.extrapolation == "LINEAR" and keys["interpolation"][-1] == LINEAR
    if is_line and len(after) == 2 and len(slope) and end["co"][0, 0] not in old["co"][:, 0]:
        # The line beyond the last key goes on from the key before it, which is a new one.
        after["handle_right"][-1] = after["co"][-1] + slope[0]
        after["handle_right_type"][-1] = FREE
        after["interpolation"][-1] = BEZIER
    start_jump = _jump_keys(start, new[:1], JUMP)
    end_jump = _jump_keys(end, new[-1:], -JUMP)
    start["interpolation"] = CONSTANT if len(start_jump) else BEZIER
    start["handle_right"] = new["handle_right"][0]
    start["handle_left_type"] = start["handle_right_type"] = FREE
    end["handle_left"] = new["handle_left"][-1]
    end["handle_left_type"] = end["handle_right_type"] = FREE
    end_jump["interpolation"] = CONSTANT
    write(curve, np.concatenate([before, start_jump, new[1:-1], end_jump, after]))


def _jump_keys(outside: NDArray, inside: NDArray, inward: float) -> NDArray:
    """Return the key of a section's end, moved inward, if it differs from the curve's own key there
    as another turn of the same rotation; otherwise no key.
    """
    if abs(float(outside["co"][0, 1] - inside["co"][0, 1])) <= SAME_VALUE:
        return np.zeros(0, KEY)
    moved = inside.copy()
    for name in ("co", *HANDLES):
        moved[name][:, 0] += inward
    return moved


def _hold_slopes(curve: FCurve, keys: NDArray, start: NDArray, end: NDArray) -> None:
    """Keep the slope beyond the first or last key, if that key ends a section, which becomes a
    Bézier key: linear extrapolation then follows its outward handle, which is set in place.
    """
    if curve.extrapolation != "LINEAR":
        return
    for key, row, neighbor, handle, outward in (
        (start, 0, 1, "handle_left", -1.0),
        (end, -1, -2, "handle_right", 1.0),
    ):
        if key["co"][0, 0] != keys["co"][row, 0]:
            continue
        interpolation = key["interpolation"][0]
        if interpolation == LINEAR and len(keys) > 1:
            key[handle] = 2.0 * key["co"][0] - keys["co"][neighbor]
        elif interpolation <= LINEAR:
            key[handle] = key["co"][0] + (outward, 0.0)
        key["interpolation"] = BEZIER


def cut(curve: FCurve, keys: NDArray, time: float) -> NDArray:
    """Return keys with one at a time that leaves the curve as it is, or raise EditRefusedError if
    that is impossible.
    """
    times = keys["co"][:, 0].astype(np.float64)
    if (np.abs(times - time) <= SAME_TIME).any():
        return keys
    row = int(np.searchsorted(times, time))
    new = keys[[min(row, len(keys) - 1)]]
    new["co"] = time, curve.evaluate(time)
    if row in (0, len(keys)):  # beyond all keys
        for name, shift in zip(HANDLES, (-1.0, 1.0)):
            new[name] = time + shift, curve.evaluate(time + shift)
        new["handle_left_type"] = new["handle_right_type"] = FREE
        if curve.extrapolation == "CONSTANT":
            new["interpolation"] = CONSTANT
        elif new["interpolation"][0] > BEZIER:
            new["interpolation"] = BEZIER
        if row:  # nothing followed the last key
            keys["interpolation"][-1] = new["interpolation"][0]
    else:
        previous, following = keys[row - 1 : row], keys[row : row + 1]
        interpolation = previous["interpolation"][0]
        if interpolation > BEZIER:
            raise EditRefusedError(
                INTERPOLATION_UNCUT,
                curve=curve.data_path,
                frame=time,
                start=float(times[row - 1]),
                end=float(times[row]),
            )
        new["interpolation"] = interpolation
        if interpolation == BEZIER:
            _split(previous, new, following, time)
    return np.concatenate([keys[:row], new, keys[row:]])


def _split(previous: NDArray, new: NDArray, following: NDArray, time: float) -> None:
    """Set the handles of a key that divides a Bézier segment, and of its neighbors, by de
    Casteljau's rule.
    """
    points = [previous["co"], previous["handle_right"], following["handle_left"], following["co"]]
    points = np.concatenate(points).astype(np.float64)
    lengths = np.abs(points[[0, 3], 0] - points[[1, 2], 0])
    span = points[3, 0] - points[0, 0]
    shares = np.minimum(1.0, span / np.maximum(lengths, SAME_TIME))  # Blender shortens long handles
    points[[1, 2]] = points[[0, 3]] + shares[:, None] * (points[[1, 2]] - points[[0, 3]])
    low, high = 0.0, 1.0
    levels = [points]
    # Bisection by the time of the point on the curve; 60 halvings are finer than float64. The last
    # one leaves its levels: of 4, 3, 2 and 1 points, of which the single one is on the curve.
    for _ in range(60):
        share = (low + high) / 2.0
        levels = [points]
        while len(levels[-1]) > 1:
            levels.append(levels[-1][:-1] + share * np.diff(levels[-1], axis=0))
        low, high = (share, high) if levels[3][0, 0] < time else (low, share)
    previous["handle_right"] = levels[1][0]
    new["handle_left"] = levels[2][0]
    new["handle_right"] = levels[2][1]
    following["handle_left"] = levels[1][2]
    for key, sides in ((previous, HANDLES[1:]), (new, HANDLES), (following, HANDLES[:1])):
        for side in sides:
            key[side + "_type"] = FREE


def stretch(curve: FCurve, first: float, last: float, shift: float) -> None:
    """Move the keys after `last` by a shift, and stretch those from `first` to `last` to the place
    between.
    """
    keys = read(curve)
    times = keys["co"][:, 0]
    for time in (first, last):
        if curve.extrapolation == "LINEAR" or times[0] < time < times[-1]:
            keys = cut(curve, keys, time)
    factor = (last + shift - first) / (last - first)
    times = keys["co"][:, 0].astype(np.float64)
    # The segment after a key is stretched with the key, the one before it with the key's left
    # handle.
    starts_inside = (times >= first - SAME_TIME) & (times < last - SAME_TIME)
    ends_inside = (times > first + SAME_TIME) & (times <= last + SAME_TIME)
    for name, is_stretched in (
        ("co", starts_inside),
        ("handle_right", starts_inside),
        ("handle_left", ends_inside),
    ):
        old = keys[name][:, 0].astype(np.float64)
        is_shifted = ~is_stretched & (times >= last - SAME_TIME)
        keys[name][:, 0] = np.where(
            is_stretched, first + factor * (old - first), np.where(is_shifted, old + shift, old)
        )
    keys["period"][starts_inside] *= factor
    write(curve, keys)
