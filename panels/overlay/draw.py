# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing in the 3D Viewport: a few batches for all bodies, remade only after a change.

Lines and discs are drawn twice, to show how deep they lie: through everything, lines faint and discs without their
white quadrants, and then in full if nothing is in front of them. The nearest come last. The drawing depends on the
session's generation and the settings, and with discs also on the view: as long as these stay, a redraw makes no array.
While some bodies move, the batches of all others stay.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import bpy
import gpu
import numpy as np
from bpy.types import Context, SpaceView3D
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix
from numpy.typing import NDArray

from ...blender.session.tracking import handlers
from ...blender.settings.overlay import BodyMomentsOverlaySettings
from . import appearance as look
from . import lines
from .bodies import Bodies, Collected, collect, collect_moved
from .details import Detail, objects_details
from .view import View

MAX_REGIONS = 8  # number of regions with cached batches
SETTINGS = tuple(name for name in BodyMomentsOverlaySettings.__annotations__ if name != "show")

Batch = gpu.types.GPUBatch


@dataclass(eq=False)
class _Layer:
    """The batches of some of the bodies."""

    bodies: Bodies
    lines: tuple[Batch, ...] = ()  # faint, full
    fills: tuple[Batch, ...] = ()
    discs: tuple[Batch, ...] = ()  # hidden, seen
    view_key: tuple = ()  # view of these discs

    @property
    def is_empty(self) -> bool:
        return not (self.lines or self.fills or len(self.bodies))


@dataclass(frozen=True, eq=False)
class _Drawn:
    """The cached batches of a region and their key."""

    generation: int
    key: tuple
    collected: Collected
    moving: NDArray[np.bool_]  # mask of bodies in the second layer
    layers: tuple[_Layer, _Layer]  # resting bodies; moving bodies, and details of single objects


@dataclass(eq=False)
class _State:
    handle: object = None
    regions: dict[int, _Drawn] = field(default_factory=dict)


_state = _State()


def draw() -> None:
    """Draw the overlay into the region that Blender is drawing."""
    context = bpy.context
    space, scene = context.space_data, context.scene
    if space is None or scene is None or not space.overlay.show_overlays:
        return
    settings = scene.body_moments.overlay
    if not settings.show:
        return
    layers = [layer for layer in _drawn(context).layers if not layer.is_empty]
    if not layers:
        return
    view_key = gpu.matrix.get_model_view_matrix(), gpu.matrix.get_projection_matrix(), gpu.state.viewport_get()[2:]
    for layer in layers:
        if layer.view_key != view_key:
            layer.discs = _discs(layer.bodies, _view(*view_key), settings.show_axes)
            layer.view_key = view_key
    with _restored_state():
        _draw_batches(layers, view_key[2])


def _drawn(context: Context) -> _Drawn:
    """Return current batches of the region that Blender is drawing, remade if outdated."""
    pointer, key, generation = context.region.as_pointer(), _key(context), handlers.generation()
    drawn = _state.regions.get(pointer)
    if drawn is None or drawn.key != key or drawn.generation != generation:
        if drawn is None and len(_state.regions) == MAX_REGIONS:
            del _state.regions[next(iter(_state.regions))]
        before = None if drawn is None or drawn.key != key else drawn
        drawn = _state.regions[pointer] = _rebuild(before, context, key, generation)
    return drawn


def _key(context: Context) -> tuple:
    """Return everything that the drawing depends on, besides the view and the session's generation."""
    settings = context.scene.body_moments.overlay
    return (
        context.scene.session_uid,
        context.view_layer.name,
        context.space_data.local_view is not None,
        tuple(bone.name for bone in context.selected_pose_bones or ()),
        *(getattr(settings, name) for name in SETTINGS),
        _scale(),
    )


def _scale() -> float:
    return bpy.context.preferences.system.ui_scale


def _view(view: Matrix, projection: Matrix, size: tuple[int, int]) -> View:
    return View(np.array(view, np.float64), np.array(projection, np.float64), np.array(size, np.float64))


# ---------------------------------------------------------------- What is drawn


def _rebuild(before: _Drawn | None, context: Context, key: tuple, generation: int) -> _Drawn:
    """Rebuild the batches that changed, or all of them if the key is new.

    Moving bodies are in their own layer, so that the others' batches stay.
    """
    settings, collected, resting = context.scene.body_moments.overlay, None, None
    if before is not None and not settings.show_sum:
        moved = handlers.moved_since(before.generation)
        collected = None if moved is None else collect_moved(context, before.collected, moved)
    collected = collected or collect(context)
    bodies = collected.bodies
    moving = np.zeros(len(bodies), bool)
    if before is not None and len(before.moving) == len(bodies):
        changed = bodies.differ_from(before.collected.bodies)
        if (changed & ~before.moving).any():
            moving = changed
        else:
            moving, resting = before.moving, before.layers[0]
    if resting is None:
        resting = _layer(bodies.chosen(~moving), settings, [])
    details = list(objects_details(context, settings))
    return _Drawn(generation, key, collected, moving, (resting, _layer(bodies.chosen(moving), settings, details)))


def _layer(bodies: Bodies, settings: BodyMomentsOverlaySettings, details: list[Detail]) -> _Layer:
    segments = [*lines.body_lines(bodies, settings), *(detail.segments for detail in details)]
    return _Layer(bodies, _line_batches(segments), _fill_batches([detail.triangles for detail in details]))


def _fill_batches(parts: list[tuple[NDArray, NDArray]]) -> tuple[Batch, ...]:
    """Return the batches of parts: (k, 3, 3) triangles and (k, 4) colors."""
    parts = [(triangles, colors) for triangles, colors in parts if len(triangles)]
    if not parts:
        return ()
    points = np.concatenate([triangles for triangles, _ in parts]).reshape(-1, 3).astype(np.float32)
    colors = np.concatenate([colors for _, colors in parts]).astype(np.float32).repeat(3, axis=0)
    return (batch_for_shader(gpu.shader.from_builtin("FLAT_COLOR"), "TRIS", {"pos": points, "color": colors}),)


def _line_batches(parts: list[tuple[NDArray, NDArray]]) -> tuple[Batch, ...]:
    """Return the batches of parts: (k, 2, 3) segments and (k, 4) colors."""
    parts = [(segments, colors) for segments, colors in parts if len(segments)]
    if not parts:
        return ()
    points = np.concatenate([segments for segments, _ in parts]).reshape(-1, 3).astype(np.float32)
    colors = np.concatenate([colors for _, colors in parts]).astype(np.float32).repeat(2, axis=0)
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    faint = colors.copy()
    faint[:, 3] *= look.BEHIND
    return tuple(batch_for_shader(shader, "LINES", {"pos": points, "color": tint}) for tint in (faint, colors))


def _discs(bodies: Bodies, view: View, with_digits: bool) -> tuple[Batch, ...]:
    if not len(bodies):
        return ()
    points, colors, triangles = lines.disc_triangles(bodies, view, _scale(), with_digits)
    if not len(points):
        return ()
    shader = gpu.shader.from_builtin("FLAT_COLOR")
    return tuple(
        batch_for_shader(shader, "TRIS", {"pos": points, "color": tints}, indices=triangles) for tints in colors
    )


# ---------------------------------------------------------------- Drawing it


@contextmanager
def _restored_state() -> Iterator[None]:
    """Put the GPU's state back, whatever happens in here."""
    state = gpu.state
    blend, depth, mask = state.blend_get(), state.depth_test_get(), state.depth_mask_get()
    try:
        state.blend_set("ALPHA")
        state.depth_mask_set(False)
        yield
    finally:
        state.blend_set(blend)
        state.depth_test_set(depth)
        state.depth_mask_set(mask)


def _draw_batches(layers: list[_Layer], size: tuple[int, int]) -> None:
    scale = _scale()
    flat = gpu.shader.from_builtin("FLAT_COLOR")
    gpu.state.depth_test_set("NONE")
    for layer in layers:
        for batch in layer.fills:
            _draw_batch(batch, flat)
    uniform = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    colored = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    both = [layer.lines for layer in layers if layer.lines]
    for batches, depth, opacity in zip(zip(*both), ("NONE", "LESS_EQUAL"), (look.BEHIND, 1.0)):
        gpu.state.depth_test_set(depth)
        for shader, width in ((uniform, look.LINE + 2.0 * look.OUTLINE), (colored, look.LINE)):
            shader.bind()
            shader.uniform_float("viewportSize", size)
            shader.uniform_float("lineWidth", scale * width)
            if shader is uniform:
                shader.uniform_float("color", (*look.DARK[:3], 0.6 * opacity))
            for batch in batches:
                _draw_batch(batch, shader)
    both = [layer.discs for layer in layers if layer.discs]
    for batches, depth in zip(zip(*both), ("NONE", "LESS_EQUAL")):
        gpu.state.depth_test_set(depth)
        for batch in batches:
            _draw_batch(batch, flat)


def _draw_batch(batch: Batch, shader: gpu.types.GPUShader) -> None:
    batch.draw(shader)


# ---------------------------------------------------------------- Switching it on


def register() -> None:
    """Draw from now on, if there are windows."""
    if not bpy.app.background:
        _state.handle = SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")
        _redraw()


def unregister() -> None:
    """Draw no more, and free the batches."""
    if _state.handle is not None:
        SpaceView3D.draw_handler_remove(_state.handle, "WINDOW")
        _state.handle = None
        _redraw()
    _state.regions.clear()


def _redraw() -> None:
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
