# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing in the 3D Viewport: a few batches for all bodies, remade only after a change.

Lines and discs are drawn twice, to show how deep they lie: first through everything, lines faint
and discs without their white quadrants, then in full if nothing is in front of them. The nearest
discs come last. The drawing depends on the session's generation and the settings, discs also on the
view: as long as these stay, a redraw makes no array.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

import blf
import bpy
import gpu
import numpy as np
from bpy.types import Context
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from ...blender.scale import meters_per_unit
from ...blender.session import memory
from ...blender.settings.scene import BodyMomentsOverlaySettings
from ...core.numerics import Array, NDArray
from . import appearance as look
from . import discs, draw
from .bodies import Bodies, Entry, body_lines, collect
from .details import Colored, list_details

MAX_REGIONS = 8  # number of regions with cached batches
SETTINGS = tuple(name for name in BodyMomentsOverlaySettings.__annotations__ if name != "show")

Batch = gpu.types.GPUBatch


@dataclass(eq=False)
class _Drawn:
    """The batches of a region; `key`: all that they depend on besides the view.

    The key begins with the generation. `segments`: (n, k, 2, 3) lines of the bodies, `entries` as
    arrays. While these are the same, their rows stay. `active`: the row with labels, or -1.
    """

    key: tuple
    entries: list[Entry]
    active: int
    bodies: Bodies
    segments: Array
    lines: tuple[Batch, ...]  # faint, full
    fills: tuple[Batch, ...]
    texts: tuple[tuple[Array, str, NDArray], ...]
    discs: tuple[Batch, ...] = ()  # hidden, seen
    view_key: tuple = ()  # view of these discs


_regions: dict[int, _Drawn] = {}  # by the region's pointer


def draw_region(context: Context) -> None:
    """Draw the overlay into a region, with current batches."""
    pointer = context.region.as_pointer()
    settings = context.scene.body_moments.overlay
    key = (
        memory.state.generation,
        context.scene.session_uid,
        context.view_layer.name,
        context.space_data.local_view is not None,
        tuple(bone.name for bone in context.selected_pose_bones or ()),
        tuple(active and active.name for active in (context.object, context.active_pose_bone)),
        _axis_colors(),
        *(getattr(settings, name) for name in SETTINGS),
        _scale(),
    )
    region_batches = _regions.get(pointer)
    if region_batches is None or region_batches.key != key:
        if region_batches is None and len(_regions) == MAX_REGIONS:
            del _regions[next(iter(_regions))]
        region_batches = _regions[pointer] = _rebuild(context, key, region_batches)
    if not (region_batches.lines or region_batches.fills or len(region_batches.bodies.centers)):
        return
    view_key = (
        gpu.matrix.get_model_view_matrix(),
        gpu.matrix.get_projection_matrix(),
        gpu.state.viewport_get()[2:],  # width and height
    )
    if region_batches.view_key != view_key:
        region_batches.discs = _discs(region_batches.bodies, discs.View(*map(np.array, view_key)))
        region_batches.view_key = view_key
    with _restored_state():
        _draw_batches(region_batches, view_key[2])


def _rebuild(context: Context, key: tuple, before: _Drawn | None) -> _Drawn:
    """Return current batches; rows of bodies that are the same as before are not computed again.

    The arrays of `before` are changed and taken over if most rows stay.
    """
    scene = context.scene
    settings = context.scene.body_moments.overlay
    objects = draw.drawn_objects(context, settings.show_all)
    entries, active = collect(context, objects)
    details = list_details(context, objects)
    changed = list(range(len(entries)))
    # if only the generation, the first of the key, has changed
    if before is not None and before.key[1:] == key[1:] and len(before.entries) == len(entries):
        changed = [row for row in changed if entries[row] is not before.entries[row]]
    bodies = Bodies.of([entries[row] for row in changed], meters_per_unit(scene))
    segments = body_lines(bodies, settings)
    if before is not None and len(changed) < len(entries):
        before.bodies.put(changed, bodies)
        before.segments[changed] = segments
        bodies, segments = before.bodies, before.segments
    colors = look.COLORS[bodies.verdicts][:, None].repeat(segments.shape[1], axis=1)
    if settings.show_axes:
        colors[:, :3, :3] = _axis_colors()  # RGB of the first three segments, the axes
    parts = [
        (segments.reshape(-1, 2, 3), colors.reshape(-1, 4)),
        *(detail.segments for detail in details),
    ]
    vertices = _joined([detail.triangles for detail in details])
    fills = (
        (batch_for_shader(gpu.shader.from_builtin("FLAT_COLOR"), "TRIS", vertices),)
        if vertices
        else ()
    )
    texts = tuple(text for detail in details for text in detail.texts)
    return _Drawn(key, entries, active, bodies, segments, _line_batches(parts), fills, texts)


def draw_texts(context: Context) -> None:
    """Draw the texts of the details into a region, beside their places, and the numbers of the
    active body's axes.
    """
    region_batches = _regions.get(context.region.as_pointer())
    scale = _scale()
    if region_batches is None:
        return
    project = partial(location_3d_to_region_2d, context.region, context.space_data.region_3d)
    beside = scale * Vector((look.FRAME, -look.TEXT))
    texts = [
        (place + beside, text, color)
        for at, text, color in region_batches.texts
        if (place := project(at)) is not None
    ]
    blf.size(0, look.TEXT * scale)
    if region_batches.active >= 0 and context.scene.body_moments.overlay.show_axes:
        ends = [
            project(at)
            for at in (
                region_batches.bodies.centers[region_batches.active],
                *region_batches.segments[region_batches.active, :3, 1],
            )
        ]
        texts += _axis_numbers(*ends, scale=scale) if None not in ends else ()
    blf.enable(0, blf.SHADOW)
    blf.shadow(0, 6, *look.DARK)
    for place, text, color in texts:
        blf.color(0, *color)
        blf.position(0, *place, 0.0)
        blf.draw(0, text)
    blf.disable(0, blf.SHADOW)


def _axis_numbers(center: Vector, *tips: Vector, scale: float) -> list[tuple[Vector, str, NDArray]]:
    """Return the numbers of axes with their places in pixels: beyond the ends, and off the disc."""
    arms = [tip - center for tip in tips]
    if max(arm.length for arm in arms) < scale * look.MIN_NAMED:
        return []
    placed = []
    for number, arm in enumerate(arms, 1):
        away = max(arm.length, scale * look.FRAME) + scale * look.TEXT / 2.0
        # An axis that points at the eye has no arm: its number is to the lower left, 1e-3 pixels
        # off, which turn no other arm visibly.
        toward = (arm + Vector((-1e-3, -3e-4))).normalized()
        size = blf.dimensions(0, str(number))
        placed.append((center + away * toward - Vector(size) / 2.0, str(number), look.WHITE))
    return placed


def forget_regions() -> None:
    """Free the batches."""
    _regions.clear()


def _scale() -> float:
    return bpy.context.preferences.system.ui_scale


def _axis_colors() -> tuple[tuple[float, float, float], ...]:
    """Return the theme's colors of X, Y and Z, which the principal axes 1, 2 and 3 have."""
    theme = bpy.context.preferences.themes[0].user_interface
    return tuple(tuple(color) for color in (theme.axis_x, theme.axis_y, theme.axis_z))


def _joined(parts: list[Colored]) -> dict[str, NDArray[np.float32]]:
    """Return the vertices of parts: (k, c, 3) points of shapes with c corners, and (k, 4) colors;
    {} without any.
    """
    parts = [(shapes, colors) for shapes, colors in parts if len(shapes)]
    if not parts:
        return {}
    points = np.concatenate([shapes for shapes, _ in parts]).astype(np.float32)
    colors = np.concatenate([colors for _, colors in parts]).astype(np.float32)
    return {"pos": points.reshape(-1, 3), "color": colors.repeat(points.shape[1], axis=0)}


def _line_batches(parts: list[Colored]) -> tuple[Batch, ...]:
    """Return the batches of segments: faint and full."""
    vertices = _joined(parts)
    if not vertices:
        return ()
    faint = vertices["color"] * np.float32((1.0, 1.0, 1.0, look.BEHIND))
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    return tuple(
        batch_for_shader(shader, "LINES", content)
        for content in (vertices | {"color": faint}, vertices)
    )


def _discs(bodies: Bodies, view: discs.View) -> tuple[Batch, ...]:
    # the batches for discs behind surfaces and in front; none if no body is in view
    arrays = discs.disc_triangles(bodies, view, _scale())
    if arrays is None:
        return ()
    points, colors, triangles = arrays
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    return tuple(
        batch_for_shader(shader, "TRIS", {"pos": points, "color": tints}, indices=triangles)
        for tints in colors
    )


# ---------------------------------------------------------------- Drawing


@contextmanager
def _restored_state() -> Iterator[None]:
    """Set the GPU's state for drawing, and restore it after the block, even after an error."""
    state = gpu.state
    blend = state.blend_get()
    depth = state.depth_test_get()
    mask = state.depth_mask_get()
    try:
        state.blend_set("ALPHA")
        state.depth_mask_set(False)
        yield
    finally:
        state.blend_set(blend)
        state.depth_test_set(depth)
        state.depth_mask_set(mask)


def _draw_batches(region_batches: _Drawn, size: tuple[int, int]) -> None:
    # size: of the region, in pixels
    scale = _scale()
    flat = gpu.shader.from_builtin("FLAT_COLOR")
    gpu.state.depth_test_set("NONE")
    for batch in region_batches.fills:
        batch.draw(flat)
    uniform = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    colored = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    for batch, depth, opacity in zip(
        region_batches.lines, ("NONE", "LESS_EQUAL"), (look.BEHIND, 1.0)
    ):
        gpu.state.depth_test_set(depth)
        for shader, width in ((uniform, look.LINE + 2.0 * look.OUTLINE), (colored, look.LINE)):
            shader.bind()
            shader.uniform_float("viewportSize", size)
            shader.uniform_float("lineWidth", scale * width)
            if shader is uniform:
                shader.uniform_float("color", (*look.DARK[:3], 0.6 * opacity))
            batch.draw(shader)
    for batch, depth in zip(region_batches.discs, ("NONE", "LESS_EQUAL")):
        gpu.state.depth_test_set(depth)
        batch.draw(flat)
