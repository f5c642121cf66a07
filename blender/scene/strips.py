# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Additive layers of keys, as strips of the NLA."""

from collections.abc import Mapping
from math import ceil, floor

import bpy
from bpy.types import Object

from ...core.numerics import NDArray
from . import fcurves


def add_layer(
    obj: Object, name: str, times: NDArray, channels: Mapping[fcurves.Channel, NDArray]
) -> None:
    """Add a strip of sections that is combined with the animation below; the action becomes a
    strip, too.
    """
    scene = bpy.context.scene
    scale = fcurves.time_scale(scene)
    # stretched times are single precision, so their last one may be later
    beyond = int(scale != 1.0)
    animation = obj.animation_data_create()
    action = animation.action
    if action is not None:
        # Without strips below, Blender ignores how the action is combined.
        is_combined = fcurves.has_strips(obj)
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
        start, end = action.curve_frame_range
        _span(
            strip, min(start, scale * scene.frame_start), max(end, scale * scene.frame_end), beyond
        )
        animation.action = None
    layer = bpy.data.actions.new(name)
    slot = layer.slots.new("OBJECT", obj.name)
    curves = fcurves.slot_curves(layer, slot)
    for channel, values in channels.items():
        fcurves.write(curves.new(channel[0], index=channel[1]), fcurves.section_keys(times, values))
    track = animation.nla_tracks.new()
    track.name = name
    strip = track.strips.new(name, int(times[0]), layer)
    strip.action_slot = slot
    _span(strip, times[0], times[-1], beyond)
    strip.blend_type = "COMBINE"
    strip.extrapolation = "NOTHING"


def _span(strip: bpy.types.NlaStrip, start: float, end: float, beyond: int) -> None:
    """Let a strip show its action from a time to another, and some whole frames beyond."""
    strip.action_frame_start = floor(start) - beyond
    strip.action_frame_end = ceil(end) + beyond
    strip.frame_start_ui = strip.action_frame_start
